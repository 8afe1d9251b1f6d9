r"""The quadratic programme of one step.

.. math:: \min_s\; g^T s + \tfrac12 s^T B s + \max_i\,(c + C s)_i
    \quad\text{subject to}\quad lo \le s \le hi

with :math:`lo \le 0 \le hi`, by a primal active-set method (Nocedal & Wright, *Numerical
Optimization*, 2006, section 16.5). The maximum is the linear function of one of the functions that
attain it, the base, and the others of the active set are equalities
:math:`(C_i - C_a)\, s = c_a - c_i`; E are all of these slopes. Variables are held at the box, and
functions join the active set, one by one as steps meet them; they are let go as their multipliers
kappa, of sum 1, have the wrong sign. Where B has negative curvature in the null space of the
working set, its absolute value is used.

Hundreds of variables may end at the box, and each change of the working set takes a decomposition:
without functions, they are held and let go many at once, as long as what is
minimised falls (Moré & Toraldo 1991, doi:10.1137/0801008).
"""

from dataclasses import dataclass

import numpy as np

from modefront._typing import Bools, Floats
from modefront.linalg.small import eigh, lstsq, svd

FLAT = 1e-10
"""Curvature, singular value, slope or multiplier, over the greatest one, below which it counts as
none: well above rounding, 1e-16 times the condition of matrices of some thousands."""

HALVINGS = 8  # halvings at most of a step until its projection on the box falls

PASSES = 4
"""Changes of the working set, over the number of variables and functions, after which the method
ends: from two on, something was let go that is met again."""


@dataclass(frozen=True)
class QuadraticProgramme:
    """The programme of one step; see the module for the symbols."""

    B: Floats
    g: Floats
    lo: Floats
    hi: Floats
    C: Floats
    c: Floats

    def ties(self, active: list[int]) -> Floats:
        """Return E (., p), the slopes that keep active functions equal."""
        return self.C[active[1:]] - self.C[active[:1]]

    def slope(self, s: Floats, active: list[int]) -> Floats:
        """Return the slope (p,) of what is minimised, with the base for the maximum."""
        slope = self.g + self.B @ s
        return slope + self.C[active[0]] if active else slope

    def multipliers(self, s: Floats, active: list[int], free: Bools) -> Floats:
        """Return kappa (m,), with which least is left of the slope of free variables."""
        kappa = np.zeros(len(self.C))
        if len(active) > 1:
            others = lstsq(self.ties(active)[:, free].T, -self.slope(s, active)[free])
            kappa[active[1:]] = others
        kappa[active[:1]] = 1 - kappa.sum()
        return kappa


def solve_qp(qp: QuadraticProgramme) -> tuple[Floats, list[int]]:
    """Return the solution s (p,), near it where B is not convex, and the active functions.

    The base is the first of them.
    """
    lo, hi = qp.lo, qp.hi
    s = np.zeros(lo.size)
    free = (s > lo) & (s < hi)
    active = [int(np.argmax(qp.c))] if len(qp.C) else []
    for _ in range(PASSES * (s.size + len(qp.C))):
        d = _descent(qp.B, qp.slope(s, active), qp.ties(active), free)
        bound = np.where(d > 0, hi, lo)
        share = np.divide(bound - s, d, out=np.full(s.size, np.inf), where=d != 0)
        within, (joining, met) = float(share.min()), _met(qp, s, d, active)
        if met < min(within, 1):
            s, active = np.clip(s + met * d, lo, hi), [*active, joining]
            continue
        if within < 1:
            new = None if len(qp.C) else _projected(qp, s, d)
            held = share <= within if new is None else free & ((new <= lo) | (new >= hi))
            s = np.where(held, bound, np.clip(s + within * d, lo, hi)) if new is None else new
            free = free & ~held
            continue
        s = np.clip(s + d, lo, hi)
        if free.all() and len(active) < 2:
            break
        kappa = qp.multipliers(s, active, free)
        if kappa.min(initial=0.0) < -FLAT:
            active = [i for i in active if i != int(np.argmin(kappa))]
            continue
        slope = qp.g + qp.B @ s + qp.C.T @ kappa
        scale = max(float(np.abs(slope).max()), float(np.abs(qp.g).max()))
        low, high = s <= lo, s >= hi
        gain = np.where(free | (low & high), 0.0, np.where(low, -slope, slope))  # on leaving a side
        wrong = gain > FLAT * scale
        if not wrong.any():
            break
        free = free | wrong
    return s, active


def _projected(qp: QuadraticProgramme, s: Floats, d: Floats) -> Floats | None:
    """Return where a step d, or its half and so on, ends on the box; None where nothing falls."""
    slope = qp.g + qp.B @ s
    for halvings in range(HALVINGS):
        new = np.clip(s + 0.5**halvings * d, qp.lo, qp.hi)
        change = new - s
        if slope @ change + 0.5 * change @ qp.B @ change < 0:
            return new
    return None


def _descent(B: Floats, gradient: Floats, E: Floats, free: Bools) -> Floats:
    """Return the step of the free variables to their minimum that leaves E s as it is."""
    d, inside = np.zeros(free.size), free.nonzero()[0]
    if not inside.size:
        return d
    if inside.size < free.size:
        B, gradient, E = B.take(inside, 0).take(inside, 1), gradient[inside], E.take(inside, 1)
    Z = None
    if len(E):
        _, sigma, Vt = svd(E)
        Z = Vt[int((sigma > FLAT * sigma[0]).sum()) :].T
    if Z is None or Z.shape[1]:
        curvature, V = eigh(B if Z is None else Z.T @ B @ Z)
        curvature = np.abs(curvature)
        T = V if Z is None else Z @ V
        slope = T.T @ gradient
        floor = max(FLAT * curvature.max(), np.finfo(float).tiny ** 0.5)  # no overflow
        d[inside] = -T @ (slope / np.maximum(curvature, floor))
    return d


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
