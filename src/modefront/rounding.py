"""Sizes of rounding in double precision that several packages use."""

TINY = 1e-300
"""Least divisor, in place of zero: below the sizes of all quantities, and no quotient overflows."""

WRITTEN = 1e-6
"""Relative size of rounding of coordinates and directions in files, which hold seven digits."""

COMPUTED = 1e-9
"""Relative size of rounding of numbers that were computed, and written with all of their digits."""

ACCUMULATED = 1e-12
"""Relative size of rounding that has added up: some thousand times that of one operation, 2.2e-16.
Quotients and eigenvalues of well scaled matrices of a thousand rows have less."""

LARGEST = 1e100  # greatest number in a file: products of three such numbers do not overflow

SYMMETRY = 1e-8
"""Greatest difference of a matrix and its transpose, over the greatest entry, that passes for
rounding. Chosen: above that of sums in double precision, below that of numbers in single."""
