"""Matrices from files of any format: real, symmetric and without entries that overflow."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import scipy.sparse

from modefront._typing import Bools
from modefront.errors import InputError, reason
from modefront.models.formats import FORMATS
from modefront.models.formats.base import check_square, wrong

LARGEST = 1e100
"""Entries above it overflow in products."""

SYMMETRY = 1e-8
"""Greatest difference of A and its transpose, over the greatest entry, that passes for rounding."""


def read_matrix(path: Path | str, name: str | None = None) -> scipy.sparse.coo_array:
    """Return a real symmetric matrix from a file, exactly symmetrised and without zeros.

    Parameters
    ----------
    path
        Matrix Market ``.mtx``, SciPy sparse ``.npz``, NumPy ``.npy`` or MATLAB ``.mat``. Nothing is
        unpickled.
    name
        Name of the matrix in a ``.mat`` file; None for the only one.

    Raises
    ------
    InputError
        If the file cannot be read, or the matrix is not square, finite, real and symmetric.
    """
    path = Path(path)
    kind = {each.suffix: each for each in FORMATS}.get(path.suffix)
    if kind is None:
        suffixes = ", ".join(each.suffix for each in FORMATS)
        raise wrong(path, f"a name that ends in {suffixes}", f"'{path.name}'")
    if name is not None and not kind.has_names:
        named = " or ".join(each.suffix for each in FORMATS if each.has_names)
        raise wrong(
            path, f"a {named} file, as only these have names for matrices", f"'{path.name}'"
        )
    try:
        with path.open("rb"):
            pass  # for the system's own words about what cannot be opened
        matrix = kind.read(path, name)
    except InputError:
        raise
    except FileNotFoundError:
        raise wrong(path, "a matrix", "no such file") from None
    except Exception as error:  # what the readers raise for a damaged file is not documented
        raise wrong(path, "a readable matrix", reason(error)) from None
    check_square(path, matrix.shape)
    if matrix.dtype.kind not in "biuf":
        raise wrong(path, "real numbers", f"{matrix.dtype}")
    A = scipy.sparse.coo_array(matrix).astype(float)
    A.sum_duplicates()
    _check_entries(path, A, ~np.isfinite(A.data), "finite numbers")
    _check_entries(path, A, np.abs(A.data) > LARGEST, f"numbers up to {LARGEST:g}")
    difference = scipy.sparse.coo_array(A - A.T)
    if np.abs(difference.data).max(initial=0) > SYMMETRY * np.abs(A.data).max(initial=0):
        worst = int(np.argmax(np.abs(difference.data)))
        i, j = int(difference.row[worst]), int(difference.col[worst])
        rows = A.tocsr()
        raise wrong(
            path,
            "a symmetric matrix",
            f"{rows[i, j]:.6g}, and {rows[j, i]:.6g} across the diagonal",
            f"row {i}, column {j} (from 0)",
        )
    symmetric = scipy.sparse.coo_array((A + A.T) / 2)
    symmetric.eliminate_zeros()
    return symmetric


def _check_entries(path: Path, A: scipy.sparse.coo_array, refused: Bools, expected: str) -> None:
    """Refuse a matrix of which some entries are refused, naming the first of them."""
    if refused.any():
        first = int(np.argmax(refused))
        place = f"row {A.row[first]}, column {A.col[first]} (from 0)"
        raise wrong(path, expected, f"{A.data[first]:g}", place)
