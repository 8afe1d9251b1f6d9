r"""The greatest eigenvalues of :math:`T = A^{-1} M` by block Lanczos iteration.

A is positive definite and M is symmetric, so T is self-adjoint in the inner product of A, which,
unlike that of M, sees the null space of M (massless degrees of freedom): nothing can grow there
unseen. One step with the block Q of the basis V is

.. math::
    H &= V^T M Q \\
    W &= A^{-1} M Q - V H = Q_+ R, \qquad Q_+^T A Q_+ = I

which keeps :math:`T V = V H + Q_+ R E^T`, E the last columns. The Ritz pairs of H then have the
residual :math:`\lVert R y \rVert` with y the last rows of its eigenvectors. A full basis is
replaced by its leading Ritz vectors (thick restart), which keeps that relation.

Source: Wu & Simon 2000, doi:10.1137/S0895479898334605 (thick restart); Grimes, Lewis & Simon 1994,
doi:10.1137/S0895479888151111 (blocks, singular M).
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from modefront._typing import Floats
from modefront.errors import ModelError
from modefront.linalg.products import combine, gram, times
from modefront.modes.dense import FINITE, INDEFINITE_MASS

TOLERANCE = 1e-7  # residual of a Ritz pair over its mu; modes are usually refined once more
NEW = 1e-8  # share of a random block outside the basis, below which there are no more modes
STEPS = 500  # steps after which the iteration is given up

Solve = Callable[[Floats], Floats]


@dataclass(frozen=True)
class Ritz:
    """Ritz pairs of T, mu descending."""

    mu: Floats  # (k,) Ritz values
    X: Floats  # (N, k) Ritz vectors, orthonormal in A
    converged: int  # how many of the leading pairs have converged
    complete: bool  # whether there are no eigenvalues but these


def greatest(
    solve: Solve, A: csr_array, M: csr_array, start: Floats, needed: int, steps: int = STEPS
) -> Ritz:
    """Return Ritz pairs of T with the ``needed`` greatest mu, or as many as ``steps`` allow.

    ``start`` (N, b) is the first block; of an eigenvalue repeated more often than b times, some
    may be missed. Raises ModelError where M is indefinite.
    """
    n, b = start.shape
    capacity = min(n, max(3 * needed, 40) + 4 * b)
    V, AV, H = np.empty((n, capacity)), np.empty((n, capacity)), np.zeros((capacity, capacity))
    d, complete = 0, False

    def outside(W: Floats) -> Floats:
        """Return the part of W that is orthogonal to the basis in A."""
        return W - combine(V[:, :d], gram(AV[:, :d], W))

    Q, AQ, R = _orthonormal(start, A, 0.0)
    for step in range(1, steps + 1):
        if d + Q.shape[1] > capacity:  # the leading Ritz vectors take the place of the basis
            keep = min(capacity - Q.shape[1], needed + 2 * b)
            mu, Y = np.linalg.eigh(H[:d, :d])
            Y = Y[:, ::-1][:, :keep]
            V[:, :keep], AV[:, :keep] = combine(V[:, :d], Y), combine(AV[:, :d], Y)
            H[:] = 0.0
            H[:keep, :keep] = np.diag(mu[::-1][:keep])
            d = keep
        new = slice(d, d + Q.shape[1])
        V[:, new], AV[:, new] = Q, AQ
        d = new.stop
        MQ = times(M, Q)
        H[:d, new] = gram(V[:, :d], MQ)
        H[new, :d] = H[:d, new].T
        W = outside(solve(MQ) - combine(V[:, :d], H[:d, new]))
        scale = np.abs(np.diagonal(H[:d, :d])).max()
        Q, AQ, R = _orthonormal(W, A, FINITE * scale, n - d)
        if R.size and np.abs(R).max() < 1e-4 * scale:
            Q, AQ, again = _orthonormal(outside(Q), A, 0.0)
            R = again @ R
        if d < needed and Q.size and step < steps:
            continue
        mu, Y = np.linalg.eigh(H[:d, :d])
        mu, Y = mu[::-1], Y[:, ::-1]
        if mu[-1] < -INDEFINITE_MASS * mu[0]:
            raise ModelError("the mass matrix is indefinite")
        good = np.linalg.norm(R @ Y[new], axis=0) <= np.maximum(TOLERANCE * mu, FINITE * mu[0])
        leading = d if good.all() else int(np.argmin(good))
        if leading >= needed and mu[needed - 1] > FINITE * mu[0]:
            break
        if leading == d:
            # All modes that the block contains are found; a random one may contain others.
            W = solve(M @ np.random.default_rng(step).standard_normal((n, b)))
            size = np.sqrt(np.einsum("nc,nc->c", W, A @ W).max())
            W = outside(outside(W))
            Q, _, _ = _orthonormal(W, A, NEW * size, n - d)
            Q, AQ, _ = _orthonormal(outside(Q), A, 0.0)
            R = np.zeros((Q.shape[1], new.stop - new.start))
            complete = not Q.size
            if complete:
                break
    keep = min(d, max(leading, needed) + 1)
    complete = complete or d == n
    return Ritz(mu[:keep], combine(V[:, :d], Y[:, :keep]), min(leading, keep), complete)


def _orthonormal(
    W: Floats, A: csr_array, least: float, most: int | None = None
) -> tuple[Floats, Floats, Floats]:
    """Return Q, A Q and R with W = Q R and Q orthonormal in A.

    Directions shorter than ``least``, and the shortest ones beyond ``most``, are dropped.
    """
    AW = times(A, W)
    squares, U = np.linalg.eigh(gram(W, AW))
    large = squares > max(least**2, 1e-28 * squares.max(initial=0.0))
    large[: squares.size - min(squares.size, squares.size if most is None else most)] = False
    size = np.sqrt(squares[large])
    U = U[:, large]
    return combine(W, U / size), combine(AW, U / size), size[:, None] * U.T
