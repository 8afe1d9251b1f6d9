"""Products with tall matrices, shared among all processors, that do not depend on their number.

BLAS shares a large product between threads, which changes its rounding with their number, and its
waiting threads slow down everything else on a busy machine. In blocks of rows that are too small
to be shared by it, the same products are as fast on one core and always the same, and blocks may
be computed by several threads of our own.
"""

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from itertools import pairwise

import numpy as np
from scipy.sparse import csr_array

from modefront._typing import Floats

WORK = 2**17  # multiplications a block; OpenBLAS shares products from 2**18 on
CHUNK = 2**12  # rows that are combined at once, which stay in the cache
GROUP = 16  # blocks of which products are added up together
TILE = 64  # rows and columns of X^T Y that are computed together, which stay in the cache too
SHARED = 2**22  # multiplications from which on a product is shared among threads
WIDE = 2  # columns from which on that pays for a sparse matrix
THREADS = "RAYON_NUM_THREADS"  # limits the threads of products, and of factors by rslab

PARTS = 16  # parts of the rows at most, of which products X^T Y are added up
PART = 2**22  # multiplications of a part at least


def gram(X: Floats, Y: Floats) -> Floats:
    """Return X^T Y for X of shape (N, a) and Y of shape (N, b)."""
    (N, a), b = X.shape, Y.shape[1]
    wide = max(1, min(b, max(TILE, TILE**2 // max(a, 1))))
    high = max(1, min(a, TILE**2 // wide))
    parts = min(PARTS, 1 + N * a * b // PART)
    sums = np.empty((parts, a, b))

    def fill(first: int, last: int) -> None:
        for part in range(first, last):
            x, y = (A[N * part // parts : N * (part + 1) // parts] for A in (X, Y))
            for i in range(0, a, high):
                for j in range(0, b, wide):
                    rows, columns = slice(i, i + high), slice(j, j + wide)
                    sums[part, rows, columns] = _gram(x[:, rows], y[:, columns])

    _share(fill, parts, N * a * b)
    return sums[0] if parts == 1 else sums.sum(axis=0)


def _gram(X: Floats, Y: Floats) -> Floats:
    """Return X^T Y, some blocks of rows after the others."""
    (a, b), (whole, rows) = (X.shape[1], Y.shape[1]), _blocks(X, Y.shape[1])
    out: Floats = X[whole:].T @ Y[whole:]
    left = X[:whole].reshape(-1, rows, a).transpose(0, 2, 1)
    right = Y[:whole].reshape(-1, rows, b)
    for k in range(0, len(left), GROUP):
        out += np.matmul(left[k : k + GROUP], right[k : k + GROUP]).sum(axis=0)
    return out


def combine(X: Floats, C: Floats) -> Floats:
    """Return X C for X of shape (N, a) and C of shape (a, b)."""
    N, b = X.shape[0], C.shape[1]
    out = np.empty((N, b))

    def multiply(first: int, last: int) -> None:
        for k in range(first * CHUNK, min(last * CHUNK, N), CHUNK):
            x, part = (A[k : min(k + CHUNK, N)] for A in (X, out))
            whole, rows = _blocks(x, b)
            np.matmul(x[whole:], C, out=part[whole:])
            if whole:
                blocks = whole // rows, rows
                np.matmul(x[:whole].reshape(*blocks, -1), C, out=part[:whole].reshape(*blocks, b))

    _share(multiply, -(-N // CHUNK), N * C.size)
    return out


def times(A: csr_array, X: Floats) -> Floats:
    """Return A X for a sparse A of shape (M, N) and X of shape (N, b)."""
    M, N = A.shape
    if X.shape[1] < WIDE:
        return A @ X
    out = np.empty((M, X.shape[1]))
    X = np.ascontiguousarray(X)

    def multiply(first: int, last: int) -> None:
        begin, end = A.indptr[first], A.indptr[last]
        entries = A.data[begin:end], A.indices[begin:end], A.indptr[first : last + 1] - begin
        part = csr_array(entries, shape=(last - first, N))  # of views, not copies
        out[first:last] = part @ X

    _share(multiply, M, A.nnz * X.shape[1])
    return out


def _share(work: Callable[[int, int], None], count: int, multiplications: int) -> None:
    """Do some work on all of ``count`` pieces, from a first one to before a last one at a time."""
    pool, shares = shared_pool()
    shares = min(shares, count)
    if multiplications < SHARED or shares <= 1:
        work(0, count)
        return
    ends = [count * k // shares for k in range(shares + 1)]
    for done in [pool.submit(work, *part) for part in pairwise(ends)]:
        done.result()


def threads() -> int:
    """Return the threads that the environment allows, else the processors of this process."""
    given = os.environ.get(THREADS, "")
    if given.isdecimal() and int(given) > 0:
        return int(given)
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@cache
def shared_pool() -> tuple[ThreadPoolExecutor, int]:
    """Return the threads that products are shared among, and their number."""
    count = threads()
    return ThreadPoolExecutor(count, "products"), count


def _blocks(X: Floats, columns: int) -> tuple[int, int]:
    """Return how many rows of X are in whole blocks, and the rows of a block."""
    rows = max(1, WORK // max(1, X.shape[1] * columns))
    return X.shape[0] // rows * rows, rows
