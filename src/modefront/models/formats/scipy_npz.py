"""Sparse matrices of SciPy, as `scipy.sparse.save_npz` writes them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import scipy.sparse

from modefront.models.formats.base import MatrixFormat, check_square


def read(path: Path, _: str | None) -> Any:
    """Return the matrix of a file; see `MatrixFormat`."""
    with path.open("rb") as stream:  # NumPy would leave a damaged file open
        A = scipy.sparse.load_npz(stream)
    check_square(path, A.shape)
    if A.format in ("csr", "csc", "bsr"):
        A.check_format(full_check=True)  # wrong indices would be followed out of the array
    return A


SCIPY_NPZ = MatrixFormat(".npz", read)
