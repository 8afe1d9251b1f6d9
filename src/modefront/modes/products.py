"""Products with tall matrices that do not depend on the number of threads.

BLAS shares a large product between threads, which changes its rounding with their number, and its
waiting threads slow down everything else on a busy machine. In blocks of rows that are too small
to be shared, the same products are as fast on one core and always the same.
"""

from __future__ import annotations

import numpy as np

from modefront._typing import Floats

WORK = 2**17
"""Multiplications a block; OpenBLAS shares products from 2**18 on."""


def gram(X: Floats, Y: Floats) -> Floats:
    """Return X^T Y for X of shape (N, a) and Y of shape (N, b)."""
    whole, rows = _blocks(X, Y.shape[1])
    out: Floats = X[whole:].T @ Y[whole:]
    if whole:
        left = X[:whole].reshape(whole // rows, rows, X.shape[1])
        right = Y[:whole].reshape(whole // rows, rows, Y.shape[1])
        out += np.matmul(left.transpose(0, 2, 1), right).sum(axis=0)
    return out


def combine(X: Floats, C: Floats) -> Floats:
    """Return X C for X of shape (N, a) and C of shape (a, b)."""
    whole, rows = _blocks(X, C.shape[1])
    out = np.empty((X.shape[0], C.shape[1]))
    np.matmul(X[whole:], C, out=out[whole:])
    if whole:
        blocks = X[:whole].reshape(whole // rows, rows, X.shape[1])
        np.matmul(blocks, C, out=out[:whole].reshape(whole // rows, rows, C.shape[1]))
    return out


def _blocks(X: Floats, columns: int) -> tuple[int, int]:
    """Return how many rows of X are in whole blocks, and the rows of a block."""
    rows = max(1, WORK // max(1, X.shape[1] * columns))
    return X.shape[0] // rows * rows, rows
