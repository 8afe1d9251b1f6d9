r"""The quadratic programme of one step.

.. math:: \min_s\; g^T s + \tfrac12 s^T B s \quad\text{subject to}\quad A s = b,\; lo \le s \le hi

with :math:`lo \le 0 \le hi`, by a primal active-set method (Nocedal & Wright, *Numerical
Optimization*, 2006, section 16.5): the equalities are met first, as nearly as the box allows, and
then kept; variables are held at the box one by one as steps meet it, and let go as their
multipliers have the wrong sign. Where B has negative curvature among the variables that are free,
its absolute value is used: variables that are held have no say in it.

========  ================================================================
symbol    meaning
========  ================================================================
Z         basis of the null space of A among the free variables
mu        multipliers of the box, g + B s + A^T lambda
========  ================================================================
"""

from __future__ import annotations

import numpy as np
import scipy.optimize

from modefront._typing import Bools, Floats

FLAT = 1e-10
"""Curvature, over the greatest one, below which a direction counts as flat."""

FAR = 1e-4
"""Inverse of the greatest step aimed at, in widths of the box: bounds what a flat B leads to."""

NORMAL = 0.8
"""Share of the box that the normal step may use, so that something is left to descend."""

WRONG = 1e-9
"""Multiplier of the wrong sign, over the greatest gradient, below which it is rounding."""


def solve_qp(B: Floats, g: Floats, A: Floats, b: Floats, lo: Floats, hi: Floats) -> Floats:
    """Return the step s, shape (p,), for B (p, p), A (k, p) and a box around the origin."""
    s = _normal_step(A, b, lo, hi)
    free = (s > lo) & (s < hi)
    width = float((hi - lo).max())
    for _ in range(4 * s.size):
        gradient = g + B @ s
        d = _descent(B, gradient, A, free, width)
        share = np.full(s.size, np.inf)
        np.divide(hi - s, d, out=share, where=d > 0)
        np.divide(lo - s, d, out=share, where=d < 0)
        stop = int(np.argmin(share))
        if share[stop] < 1:
            s = np.clip(s + share[stop] * d, lo, hi)
            s[stop] = (hi if d[stop] > 0 else lo)[stop]
            free[stop] = False
            continue
        s = np.clip(s + d, lo, hi)
        if free.all():
            break
        wrong = _wrong(g + B @ s, A, free, s <= lo, s >= hi)
        if wrong is None:
            break
        free[wrong] = True
    return s


def _descent(B: Floats, gradient: Floats, A: Floats, free: Bools, width: float) -> Floats:
    """Return the step of the free variables to their minimum that leaves A s as it is."""
    d = np.zeros(free.size)
    Z = _null_space(A[:, free])
    if Z.shape[1]:
        curvature, V = np.linalg.eigh(Z.T @ B[np.ix_(free, free)] @ Z)
        curvature = np.abs(curvature)
        T = Z @ V
        slope = T.T @ gradient[free]
        steepest = float(np.abs(slope).max()) / width
        floor = max(FLAT * curvature.max(), FAR * steepest, np.finfo(float).tiny ** 0.5)
        d[free] = -T @ (slope / np.maximum(curvature, floor))
    return d


def _wrong(gradient: Floats, A: Floats, free: Bools, low: Bools, high: Bools) -> int | None:
    """Return the held variable that gains most by leaving the box's side; None where none does."""
    of_A = np.linalg.lstsq(A[:, free].T, -gradient[free], rcond=None)[0] if len(A) else np.zeros(0)
    mu = gradient + A.T @ of_A
    gain = np.where(free | (low & high), 0.0, np.where(low, -mu, mu))
    best = int(np.argmax(gain))
    return best if gain[best] > WRONG * np.abs(gradient).max() else None


def _normal_step(A: Floats, b: Floats, lo: Floats, hi: Floats) -> Floats:
    """Return a step that meets the equalities as nearly as a part of the box allows."""
    s = np.zeros(lo.size)
    if len(A) == 0:
        return s
    U, sigma, Vt = np.linalg.svd(A, full_matrices=False)
    rank = _rank(sigma)
    s = Vt[:rank].T @ ((U.T @ b)[:rank] / sigma[:rank])
    if (s < NORMAL * lo).any() or (s > NORMAL * hi).any():
        inside = hi - lo > 0
        s = np.zeros(lo.size)
        bounds = (NORMAL * lo[inside], NORMAL * hi[inside])
        s[inside] = scipy.optimize.lsq_linear(A[:, inside], b, bounds, method="bvls").x
    return s


def _null_space(A: Floats) -> Floats:
    """Return an orthonormal basis of the null space, shape (p, p - rank)."""
    if 0 in A.shape:
        return np.eye(A.shape[1])
    _, sigma, Vt = np.linalg.svd(A)
    return np.asarray(Vt[_rank(sigma) :].T)


def _rank(sigma: Floats) -> int:
    return int((sigma > FLAT * sigma[0]).sum())
