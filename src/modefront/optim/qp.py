r"""The quadratic programme of one step.

.. math:: \min_s\; g^T s + \tfrac12 s^T B s + \max_i\,(c + C s)_i
    \quad\text{subject to}\quad A s = b,\; lo \le s \le hi

with :math:`lo \le 0 \le hi`, by a primal active-set method (Nocedal & Wright, *Numerical
Optimization*, 2006, section 16.5). The equalities are met first, as nearly as the box allows, and
then kept. The maximum is the linear function of one of the functions that attain it, the base, and
the others of the active set are equalities :math:`(C_i - C_a)\, s = c_a - c_i`; E are all of these
slopes. Variables are held at the box, and functions join the active set, one by one as steps meet
them; they are let go as their multipliers mu (of equalities) and kappa (of functions, of sum 1)
have the wrong sign. Where B has negative curvature in the null space of the working set, its
absolute value is used.

Hundreds of variables may end at the box, and each change of the working set takes a decomposition:
without functions and equalities, they are held and let go many at once, as long as what is
minimised falls (Moré & Toraldo 1991, doi:10.1137/0801008).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from modefront._typing import Bools, Floats
from modefront.linalg.small import eigh, lstsq, svd

FLAT = 1e-10
"""Curvature, singular value, slope or multiplier, over the greatest one, below which it counts as
none: well above rounding, 1e-16 times the condition of matrices of some thousands."""

NORMAL = 0.8
"""Share of the box that the normal step may use, so that something is left to descend (Nocedal &
Wright, equation 18.46)."""

HALVINGS = 8
"""Halvings at most of a step until its projection on the box falls."""

PASSES = 4
"""Changes of the working set, over the number of variables and functions, after which the method
ends: from two on, something was let go that is met again."""


@dataclass(frozen=True)
class QuadraticProgramme:
    """The programme of one step; see the module for the symbols."""

    B: Floats
    g: Floats
    A: Floats
    b: Floats
    lo: Floats
    hi: Floats
    C: Floats
    c: Floats

    def ties(self, active: list[int]) -> Floats:
        """Return E (., p), the equalities' slopes and those that keep active functions equal."""
        if len(active) < 2:
            return self.A
        return np.vstack([self.A, self.C[active[1:]] - self.C[active[:1]]])

    def slope(self, s: Floats, active: list[int]) -> Floats:
        """Return the slope (p,) of what is minimised, with the base for the maximum."""
        slope = self.g + self.B @ s
        return slope + self.C[active[0]] if active else slope

    def multipliers(self, s: Floats, active: list[int], free: Bools) -> tuple[Floats, Floats]:
        """Return mu (k,) and kappa (m,), with which least is left of the slope of free variables.

        Where equalities hardly depend on these, mu is of any size.
        """
        E = self.ties(active)
        both = np.zeros(0)
        if len(E):
            left = -self.slope(s, active)[free]
            both = lstsq(E[:, free].T, left)
        mu, others = both[: len(self.A)], both[len(self.A) :]
        kappa = np.zeros(len(self.C))
        if active:
            kappa[active[0]] = 1 - others.sum()
            kappa[active[1:]] = others
        return mu, kappa


@dataclass(frozen=True)
class QuadraticStep:
    """A step s (p,) and the active functions, the base first."""

    s: Floats
    active: list[int]


def solve_qp(qp: QuadraticProgramme) -> QuadraticStep:
    """Return the solution; near it, where the equalities cannot be met or B is not convex."""
    lo, hi = qp.lo, qp.hi
    s = _normal_step(qp.A, qp.b, lo, hi)
    free = (s > lo) & (s < hi)
    active = [int(np.argmax(qp.c + qp.C @ s))] if len(qp.C) else []
    for _ in range(PASSES * (s.size + len(qp.C))):
        d = _descent(qp.B, qp.slope(s, active), qp.ties(active), free)
        bound = np.where(d > 0, hi, lo)
        share = np.divide(bound - s, d, out=np.full(s.size, np.inf), where=d != 0)
        within, (joining, met) = float(share.min()), _met(qp, s, d, active)
        if met < min(within, 1):
            s, active = _clipped(s + met * d, lo, hi), [*active, joining]
            continue
        if within < 1:
            new = None if len(qp.A) or len(qp.C) else _projected(qp, s, d)
            held = share <= within if new is None else free & ((new <= lo) | (new >= hi))
            s = np.where(held, bound, _clipped(s + within * d, lo, hi)) if new is None else new
            free = free & ~held
            continue
        s = _clipped(s + d, lo, hi)
        if free.all() and len(active) < 2:
            break
        mu, kappa = qp.multipliers(s, active, free)
        if kappa.min(initial=0.0) < -FLAT:
            active = [i for i in active if i != int(np.argmin(kappa))]
            continue
        slope = qp.g + qp.B @ s + qp.C.T @ kappa
        scale = max(float(np.abs(slope).max()), float(np.abs(qp.g).max()))
        slope = slope + qp.A.T @ mu
        low, high = s <= lo, s >= hi
        gain = np.where(free | (low & high), 0.0, np.where(low, -slope, slope))  # on leaving a side
        wrong = gain > FLAT * scale
        if not wrong.any():
            break
        free = free | wrong
    return QuadraticStep(s, active)


def _projected(qp: QuadraticProgramme, s: Floats, d: Floats) -> Floats | None:
    """Return where a step d, or its half and so on, ends on the box; None where nothing falls."""
    slope = qp.g + qp.B @ s
    for halvings in range(HALVINGS):
        new = _clipped(s + 0.5**halvings * d, qp.lo, qp.hi)
        change = new - s
        if slope @ change + 0.5 * change @ qp.B @ change < 0:
            return new
    return None


def _descent(B: Floats, gradient: Floats, E: Floats, free: Bools) -> Floats:
    """Return the step of the free variables to their minimum that leaves E s as it is."""
    d, inside = np.zeros(free.size), free.nonzero()[0]
    if inside.size < free.size:
        B, gradient, E = B.take(inside, 0).take(inside, 1), gradient[inside], E.take(inside, 1)
    Z = _null_space(E) if len(E) else None
    if inside.size if Z is None else Z.shape[1]:
        curvature, V = eigh(B if Z is None else Z.T @ B @ Z)
        curvature = np.abs(curvature)
        T = V if Z is None else Z @ V
        slope = T.T @ gradient
        floor = max(FLAT * curvature.max(), np.finfo(float).tiny ** 0.5)  # no overflow
        d[inside] = -T @ (slope / np.maximum(curvature, floor))
    return d


def _clipped(s: Floats, lo: Floats, hi: Floats) -> Floats:
    """Return the point of the box next to s."""
    return np.minimum(np.maximum(s, lo), hi)


def _met(qp: QuadraticProgramme, s: Floats, d: Floats, active: list[int]) -> tuple[int, float]:
    """Return the function that a step d from s meets first, and the share of d until then.

    A function whose slope along d is that of the active ones but for rounding is not met.
    """
    if len(qp.C) == len(active):
        return -1, np.inf
    rise = qp.C - qp.C[active[0]]
    rate = rise @ d
    rounding = FLAT * np.abs(rise) @ np.abs(d)
    rate[active] = 0.0
    value = qp.c + qp.C @ s
    share = np.full(len(rate), np.inf)
    below = np.maximum(value[active[0]] - value, 0.0)
    np.divide(below, rate, out=share, where=rate > rounding)
    return int(np.argmin(share)), float(share.min())


def _normal_step(A: Floats, b: Floats, lo: Floats, hi: Floats) -> Floats:
    """Return a step that meets the equalities as nearly as a part of the box allows."""
    s = np.zeros(lo.size)
    if len(A) == 0:
        return s
    U, sigma, Vt = svd(A, full=False)
    rank = _rank(sigma)
    s = Vt[:rank].T @ ((U.T @ b)[:rank] / sigma[:rank])
    if (s < NORMAL * lo).any() or (s > NORMAL * hi).any():
        import scipy.optimize

        inside = hi - lo > 0
        s = np.zeros(lo.size)
        bounds = (NORMAL * lo[inside], NORMAL * hi[inside])
        s[inside] = scipy.optimize.lsq_linear(A[:, inside], b, bounds, method="bvls").x
    return s


def _null_space(A: Floats) -> Floats:
    """Return an orthonormal basis of the null space, shape (p, p - rank)."""
    if 0 in A.shape:
        return np.eye(A.shape[1])
    _, sigma, Vt = svd(A)
    return np.asarray(Vt[_rank(sigma) :].T)


def _rank(sigma: Floats) -> int:
    return int((sigma > FLAT * sigma[0]).sum())
