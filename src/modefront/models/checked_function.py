r"""A user's function that returns matrices: its calls, its derivatives and what can be wrong.

Derivatives that the function does not return are complex steps of it,

.. math:: K_i' = \operatorname{Im} K(\theta + \mathrm{i} h e_i) / h,

in which nothing cancels: h is so small that they are exact to rounding. A function that loses the
imaginary part on its way (``abs``, an array of real numbers that is filled) returns wrong
derivatives and says nothing. Those at the nominal values, the user's own as well, are therefore
compared with differences.

Source: Squire & Trapp 1998, doi:10.1137/S003614459631241X.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import scipy.sparse
from numpy.exceptions import ComplexWarning
from numpy.typing import NDArray

from modefront._typing import Floats
from modefront.errors import InputError, ModelError, wrong
from modefront.models.matrices import DENSE
from modefront.rounding import LARGEST, SYMMETRY

Matrix: TypeAlias = Any
"""A matrix (N, N): an array, nested lists of numbers, or a sparse matrix of scipy."""

MatrixFunction: TypeAlias = Callable[
    [NDArray[Any]],
    tuple[Matrix, Matrix] | tuple[Matrix, Matrix, Sequence[Matrix], Sequence[Matrix]],
]
"""A function of theta (parameters,) that returns K and M, or K, M and lists of dK and dM."""

Tangent: TypeAlias = tuple[Any, tuple[Any, ...]]
"""A matrix (N, N) at one theta, an array of a small model, else a sparse one, and its derivatives:
one a parameter, None for one without effect."""

STEP = 2.0**-70
"""Complex step over the parameter: its square drowns in rounding, and division by it is exact."""

DIFFERENCE = 1e-6
"""Step of the differences that derivatives are compared with, over the range of the parameter."""

RELATIVE = 0.05
"""Error of an entry, over it, above which a derivative is wrong: tells errors, not digits."""

NEGLIGIBLE = 1e-3
"""Change of an entry over the range of a parameter, over the roots of the entries on the diagonal,
below which differences show its curvature rather than its derivative."""

SHOWN = 6
"""Parameters that a message repeats."""

RETURNED = "K and M, or K, M and lists of their derivatives dK and dM"


@dataclass(frozen=True)
class CheckedFunction:
    """A user's function of theta that returns matrices.

    Attributes
    ----------
    function : returns K and M, or K, M and lists of their derivatives
    names : names of the parameters
    """

    function: MatrixFunction
    names: tuple[str, ...]

    def at(
        self, theta: Floats, size: int | None, *, derivatives: bool = True
    ) -> tuple[Tangent, Tangent]:
        """Return K and M at ``theta``, of ``size`` N where that is known, with derivatives.

        Raises InputError where the function does not return such matrices.
        """
        place = self._place(theta)
        returned = self._call(theta.copy(), place, RETURNED)
        K = _real(returned[0], f"{place}: K", size)
        M = _real(returned[1], f"{place}: M", K.shape[0])
        if not derivatives:
            return (K, ()), (M, ())
        if len(returned) == 4:
            slopes = [
                self._listed(each, f"{place}: {what}", K.shape[0])
                for what, each in zip(("dK", "dM"), returned[2:], strict=True)
            ]
        else:
            steps = [self._complex_step(theta, i, K.shape[0]) for i in range(theta.size)]
            slopes = [tuple(step[0] for step in steps), tuple(step[1] for step in steps)]
        return (K, slopes[0]), (M, slopes[1])

    def check_derivatives(
        self, theta: Floats, lower: Floats, upper: Floats, known: tuple[Tangent, Tangent]
    ) -> None:
        """Raise InputError where derivatives at ``theta`` differ from differences by far.

        Steps stay within the bounds ``lower`` and ``upper``.
        """
        span = upper - lower
        for i, name in enumerate(self.names):
            h = DIFFERENCE * span[i] * (1 if theta[i] + DIFFERENCE * span[i] <= upper[i] else -1)
            ahead = theta.copy()
            ahead[i] += h
            moved = self.at(ahead, known[0][0].shape[0], derivatives=False)
            for what, (shifted, _), (nominal, slopes) in zip("KM", moved, known, strict=True):
                difference = (shifted - nominal) / (ahead[i] - theta[i])
                wrong_entry = _wrong_entry(nominal, slopes[i], difference, span[i])
                if wrong_entry:
                    expected = (
                        f"derivatives of the matrices that {what} has, or, where none are "
                        "returned, a function that keeps the imaginary part of complex parameters"
                    )
                    place = f"{self._place(theta)}: derivative of {what} with respect to {name}"
                    raise wrong(place, expected, wrong_entry)

    def _complex_step(self, theta: Floats, i: int, size: int) -> tuple[Any, Any]:
        """Return the derivatives of K and M with respect to parameter i."""
        scale = float(np.frexp(theta[i])[1])
        h = STEP * 2.0**scale
        moved = theta.astype(complex)
        moved[i] += 1j * h
        place = f"{self._place(theta)}, complex {self.names[i]}"
        expected = "a function that takes complex parameters, or that returns K, M, dK and dM"
        with warnings.catch_warnings():
            warnings.simplefilter("error", ComplexWarning)
            returned = self._call(moved, place, expected)
        K, M = (
            _checked(A, f"{place}: {what}", size)
            for what, A in zip("KM", returned[:2], strict=True)
        )
        return _imaginary(K, h), _imaginary(M, h)

    def _listed(self, slopes: Any, place: str, size: int) -> tuple[Any, ...]:
        expected = f"a list of {len(self.names)} derivatives, one a parameter"
        if not isinstance(slopes, Sequence | np.ndarray):
            raise wrong(place, expected, type(slopes).__name__)
        if len(slopes) != len(self.names):
            raise wrong(place, expected, f"{len(slopes)}")
        return tuple(
            None if slope is None else _real(slope, f"{place} of {name}", size)
            for name, slope in zip(self.names, slopes, strict=True)
        )

    def _call(self, theta: NDArray[Any], place: str, expected: str) -> Any:
        """Return K and M, with their derivatives where the function returns these."""
        try:
            returned = self.function(theta)
        except (ModelError, InputError):
            raise
        except Exception as error:  # a user's function may raise anything
            found = f"{type(error).__name__}: {error}"
            raise wrong(place, expected, found) from error
        if not isinstance(returned, tuple | list):
            raise wrong(place, RETURNED, type(returned).__name__)
        if len(returned) not in (2, 4):
            raise wrong(place, RETURNED, f"{len(returned)} values")
        return returned

    def _place(self, theta: Floats) -> str:
        pairs = zip(self.names[:SHOWN], theta, strict=False)
        shown = [f"{name} = {value:g}" for name, value in pairs]
        more = ["..."] if len(self.names) > SHOWN else []
        return f"matrices({', '.join(shown + more)})"


def _real(value: Matrix, place: str, size: int | None) -> Any:
    """Return a real symmetric matrix, symmetrised; raises InputError where it is not one."""
    A = _checked(value, place, size)
    if A.dtype.kind == "c":
        raise wrong(place, "real numbers for real parameters", "complex numbers")
    return A


def _checked(value: Matrix, place: str, size: int | None) -> Any:
    """Return a symmetric matrix, an array up to `DENSE` degrees of freedom, else a sparse one.

    Rounding in its symmetry is taken out. Raises InputError where it is not such a matrix.
    """
    try:
        A: Any = value if scipy.sparse.issparse(value) else np.asarray(value)
    except ValueError:  # lists of different lengths
        raise wrong(place, "a matrix", type(value).__name__) from None
    n = "N" if size is None else size
    square = A.ndim == 2 and A.shape[0] == A.shape[1] > 0
    if not square or (size is not None and A.shape[0] != size):
        found = " x ".join(map(str, A.shape)) or "a single number"
        raise wrong(place, f"a matrix {n} x {n}", found)
    if A.dtype.kind not in "biufc":
        raise wrong(place, "numbers", str(A.dtype))
    A = A.astype(complex if A.dtype.kind == "c" else float)
    if A.shape[0] <= DENSE:
        A = A.toarray() if scipy.sparse.issparse(A) else A
        entries = A
    else:
        A = scipy.sparse.csr_array(A)
        entries = A.data
    if not np.isfinite(entries).all() or np.abs(entries).max(initial=0.0) > LARGEST:
        B = scipy.sparse.coo_array(A)
        k = int(np.argmax(~(np.abs(B.data) <= LARGEST)))
        found = f"{B.data[k]:g} in row {B.row[k]}, column {B.col[k]} (from 0)"
        raise wrong(place, f"finite numbers up to {LARGEST:g}", found)
    asymmetry = abs(A - A.T)
    if asymmetry.max() > SYMMETRY * abs(A).max():
        i, j = divmod(int(asymmetry.argmax()), A.shape[0])
        found = f"{A[i, j]:g} in row {i}, column {j} (from 0), and {A[j, i]:g} across the diagonal"
        raise wrong(place, "a symmetric matrix", found)
    return (A + A.T) / 2


def _imaginary(A: Any, h: float) -> Any:
    """Return the imaginary part over the step h; None where there is none."""
    slope = A.imag / h
    return slope if abs(slope).max() > 0 else None


def _wrong_entry(A: Any, slope: Any, difference: Any, span: float) -> str:
    """Return the entry of a derivative that differs from a difference most, or nothing.

    ``span`` is the range of the parameter.
    """
    slope = 0 * A if slope is None else slope
    off = scipy.sparse.coo_array(difference - slope)
    if not off.nnz:
        return ""
    rows, columns = off.row, off.col
    given, expected = (np.asarray(x[rows, columns]).ravel() for x in (slope, difference))
    diagonal = np.sqrt(np.abs(A.diagonal()))
    allowed = RELATIVE * np.maximum(np.abs(given), np.abs(expected))
    allowed += NEGLIGIBLE * diagonal[rows] * diagonal[columns] / span
    k = int(np.argmax(np.abs(off.data) - allowed))
    if abs(off.data[k]) <= allowed[k]:
        return ""
    return (
        f"{given[k]:.6g} in row {rows[k]}, column {columns[k]} (from 0) where the difference of "
        f"two matrices is {expected[k]:.6g}"
    )
