"""A basis of what is not determined, of directions that are short in words."""

from collections.abc import Callable, Sequence

import numpy as np
import scipy.linalg

from modefront._typing import Floats

SAME = 1e-3
"""Difference of two parts of a direction, over its greatest part, below which they are equal."""


def sparse_basis(N: Floats, whole: Sequence[Floats], holds: Callable[[Floats], bool]) -> Floats:
    """Return a basis of the span of the columns of N (p, d) of directions that are short in words.

    First single parameters; then those of the directions ``whole`` (p,) that are in the span; then
    pairs of parameters; the rest has as many zeros as elimination makes. ``holds`` tells whether a
    simple direction is not determined indeed.
    """
    p, d = N.shape
    Q = np.linalg.qr(N)[0]
    outside = np.eye(p) - Q @ Q.T
    alone = [j for j in range(p) if outside[j, j] <= SAME**2 and holds(np.eye(p)[j])]
    basis = [np.eye(p)[j] for j in alone]
    for direction in whole:
        others = direction.copy()
        others[alone] = 0.0
        size = float(np.linalg.norm(others))
        if size > 0 and np.linalg.norm(outside @ others) <= SAME * size and holds(others):
            basis = _longer(basis, others / size)
    for v in _pairs_within(outside, alone):
        if len(basis) < d and holds(v):
            basis = _longer(basis, v)
    pivots = scipy.linalg.qr(Q.T, mode="r", pivoting=True)[1][:d]
    eliminated = np.linalg.solve(Q[pivots].T, Q.T)
    for row in sorted(eliminated, key=lambda row: int((np.abs(row) > SAME).sum())):
        basis = _longer(basis, row / np.linalg.norm(row)) if len(basis) < d else basis
    return np.array(basis).T


def _longer(basis: list[Floats], v: Floats) -> list[Floats]:
    """Return a basis with another direction of length 1, if that does not depend on it."""
    longer = [*basis, v]
    return longer if np.linalg.matrix_rank(np.array(longer), tol=SAME) == len(longer) else basis


def _pairs_within(outside: Floats, alone: Sequence[int]) -> list[Floats]:
    """Return the directions of two parameters that a projector (p, p) takes to nothing."""
    p, out = len(outside), []
    d = np.diag(outside)
    # The lesser eigenvalue of two rows and columns, but for rounding, rules most pairs out at once.
    mean, half = np.add.outer(d, d) / 2, np.subtract.outer(d, d) / 2
    possible = np.triu(mean - np.hypot(half, outside) <= 2 * SAME**2, 1)
    possible[list(alone)] = possible[:, list(alone)] = False
    for i, j in np.argwhere(possible).tolist():
        lam, V = np.linalg.eigh(outside[np.ix_([i, j], [i, j])])
        if lam[0] <= SAME**2:
            v = np.zeros(p)
            v[[i, j]] = V[:, 0] * np.sign(V[np.argmax(np.abs(V[:, 0])), 0])
            out.append(v)
    return out
