"""Matrices in files: Matrix Market, SciPy's sparse .npz and NumPy's .npy."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import scipy.io
import scipy.sparse

from modefront._typing import Floats

ENDINGS = (".mtx", ".npz", ".npy")

SYMMETRY = 1e-8
"""Greatest difference of A and its transpose, over the greatest entry, that passes for rounding."""


def read_matrix(path: Path) -> Floats:
    """Return a real symmetric matrix, exactly symmetrised.

    Nothing is unpickled. Raises ValueError that says what is wrong with the matrix and OSError
    where the file cannot be opened.
    """
    if path.suffix == ".mtx":
        found = scipy.io.mmread(path)
    elif path.suffix == ".npz":
        found = scipy.sparse.load_npz(path)
    elif path.suffix == ".npy":
        found = np.load(path, allow_pickle=False)
    else:
        raise ValueError(f"a file that ends in {', '.join(ENDINGS)}")
    A = np.asarray(found.toarray() if scipy.sparse.issparse(found) else found)
    if A.ndim != 2 or A.shape[0] != A.shape[1] or A.shape[0] == 0:
        raise ValueError(f"a square matrix, but it is {' x '.join(map(str, A.shape))}")
    if A.dtype.kind not in "biuf":
        raise ValueError(f"real numbers, but they are {A.dtype}")
    A = A.astype(float)
    if not np.isfinite(A).all():
        i, j = np.argwhere(~np.isfinite(A))[0]
        raise ValueError(f"finite numbers, but row {i}, column {j} (from 0) is {A[i, j]}")
    difference = np.abs(A - A.T)
    if difference.max() > SYMMETRY * np.abs(A).max():
        i, j = np.unravel_index(np.argmax(difference), A.shape)
        raise ValueError(
            f"a symmetric matrix, but rows and columns {i} and {j} (from 0) hold "
            f"{A[i, j]:.6g} and {A[j, i]:.6g}"
        )
    out: Floats = (A + A.T) / 2
    return out
