r"""The quadratic programme of one step.

.. math:: \min_s\; g^T s + \tfrac12 s^T B s \quad\text{subject to}\quad A s = b,\; lo \le s \le hi

with :math:`lo \le 0 \le hi`, as in Lawson and Hanson (*Solving Least Squares Problems*, 1974,
chapter 23): the equalities are eliminated, and what remains is a least-distance problem, solved by
non-negative least squares. Where the equalities cannot be met within the box they are met as
nearly as possible; where B has negative curvature on their null space, its absolute value is used.

========  ================================================================
symbol    meaning
========  ================================================================
s_n       normal step, meets the equalities
Z         basis of the null space of A
T         step s = s_n + T (q - h): the objective is then |q|**2 / 2
========  ================================================================
"""

from __future__ import annotations

import numpy as np
import scipy.optimize

from modefront._typing import Floats

FLAT = 1e-10
"""Curvature, over the greatest one, below which a direction counts as flat."""

FAR = 1e-4
"""Inverse of the greatest step aimed at, in widths of the box: bounds what a flat B leads to."""

NORMAL = 0.8
"""Share of the box that the normal step may use, so that something is left to descend."""


def solve_qp(B: Floats, g: Floats, A: Floats, b: Floats, lo: Floats, hi: Floats) -> Floats:
    """Return the step s, shape (p,), for B (p, p), A (k, p) and a box around the origin."""
    s_n, Z = _normal_step(A, b, lo, hi)
    if Z.shape[1] == 0:
        return s_n
    curvature, V = np.linalg.eigh(Z.T @ B @ Z)
    curvature = np.abs(curvature)
    slope = np.abs(g).max() / (hi - lo).max()
    floor = max(FLAT * curvature.max(), FAR * slope, np.finfo(float).tiny ** 0.5)
    curvature = np.maximum(curvature, floor)
    T = Z @ (V / np.sqrt(curvature))
    h = T.T @ (g + B @ s_n)
    s = s_n - T @ h
    if (s >= lo).all() and (s <= hi).all():
        return s
    q = _least_distance(T, s, lo, hi)
    return np.clip(s if q is None else s + T @ q, lo, hi)


def _normal_step(A: Floats, b: Floats, lo: Floats, hi: Floats) -> tuple[Floats, Floats]:
    """Return a step that meets the equalities and a basis of their null space, (p, p - rank)."""
    p = lo.size
    if len(A) == 0:
        return np.zeros(p), np.eye(p)
    U, sigma, Vt = np.linalg.svd(A)
    rank = int((sigma > FLAT * sigma[0]).sum()) if sigma.size else 0
    s_n: Floats = Vt[:rank].T @ ((U.T @ b)[:rank] / sigma[:rank])
    if (s_n < NORMAL * lo).any() or (s_n > NORMAL * hi).any():
        free = hi - lo > 0
        s_n = np.zeros(p)
        bounds = (NORMAL * lo[free], NORMAL * hi[free])
        s_n[free] = scipy.optimize.lsq_linear(A[:, free], b, bounds, method="bvls").x
    return s_n, Vt[rank:].T


def _least_distance(T: Floats, offset: Floats, lo: Floats, hi: Floats) -> Floats | None:
    """Return the shortest q with lo <= offset + T q <= hi; None where rounding leaves none."""
    G = np.vstack([T, -T])
    h = np.concatenate([lo - offset, offset - hi])
    scale = np.maximum(np.linalg.norm(G, axis=1), np.finfo(float).tiny)
    E = np.vstack([(G / scale[:, None]).T, h / scale])
    f = np.zeros(len(E))
    f[-1] = 1.0
    u, _ = scipy.optimize.nnls(E, f)
    residual = E @ u - f
    if residual[-1] > -np.finfo(float).eps:
        return None
    return -residual[:-1] / residual[-1]
