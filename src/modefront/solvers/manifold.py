r"""Models that are equally good: manifolds of minima, followed and sampled to their ends.

Where data do not determine all parameters, the minimisers of a scalarisation f(J) form a manifold
(Katafygiotis & Lam 2002, Earthquake Engineering and Structural Dynamics 31, 791-812). Its tangent
space at a minimum is the null space of the second derivatives

.. math:: B = \sum_i w_i \, \partial^2 J_i + \partial J^T f'' \partial J, \qquad
    w = \partial f / \partial J .

With :math:`J_i = \|r_i\|^2`, their known part (Gauss-Newton's) is
:math:`B_0 = 2 \sum_i w_i\, \partial r_i^T \partial r_i`, and the rest is
:math:`2 \sum_i w_i\, r_i^T \partial^2 r_i`. The directions in which no residual changes to first
order are the null space of :math:`B_0`, exactly and for nothing. It is that of B as well, unless

* residuals bend where they do not change, and such a direction is no tangent; or
* residuals turn, :math:`r^T \partial^2 r = - \|\partial r\|^2`, while the sum of their squares
  stays.

All of B, by differences (`modefront.solvers.curvature`), tells at the first minimum whether it is
so; if it is, B is taken in place of :math:`B_0` at every point.

From a point, steps of length h are made along tangents and corrected back to the manifold across
them,

.. math:: s = -B^+ g, \qquad g = w^T \partial J ,

with the inverse on the complement of the null space, until s vanishes: quadratically where
residuals vanish, linearly elsewhere; in the place of :math:`B_0`, B is that of the point where the
step began. New points grow from points until every step from every point arrives next to a known
one (a packing, as in Henderson 2002, International Journal of Bifurcation and Chaos 12, 451-476); a
curve is the case of dimension 1. A step that would leave the bounds ends on them, and one that
starts at a bound and would cross it goes along it.

So found are all minima that one can get to from the start. Not found are other pieces of the set
of minima, which need starts of their own, and what branches off with another dimension. Sheets
nearer to one another than h are not told apart.

Variables are :math:`u = (\theta - lower) / (upper - lower)`.

========  ==========================================================
symbol    meaning
========  ==========================================================
d         dimension of the manifold; 0 is an isolated minimum
h         distance of neighbouring points, in u
T         (p, d) orthonormal basis of the tangent space, in u
========  ==========================================================
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum

import numpy as np
import scipy.linalg

from modefront._typing import Bools, Floats
from modefront.solvers.curvature import ERROR, second_order
from modefront.solvers.problem import Evaluation, Problem
from modefront.solvers.scalarisation import Scalarisation

FLAT = 1e-12
"""Eigenvalue of B_0 over the greatest one, below which no residual changes in a direction."""

TURNING = 1e-3
"""Eigenvalue of B_0 over the greatest one, from which a direction in the null space of B is one in
which residuals turn: their parts of B cancel to 1 %, and not by the errors of differences."""

NEAR = 0.7
"""Distance over the length of a step, below which a point counts as one that is known."""

SHORT = 0.3
"""Step over h, below which it is not worth making to a bound, but at the ends of a curve."""

EQUAL = 1e-6
"""Increase of f, over the size of its parts, up to which a model is as good."""

ARRIVED = 1e-8
"""Correction in u below which a point lies on the manifold."""

CORRECTIONS, HALVINGS = 12, 4
"""Corrections after which a step is given up and halved, and how often it is."""

AHEAD = 0.5
"""Least cosine between tangents at the two ends of a step."""


class Extent(Enum):
    """How far a manifold was followed; the value says what it means."""

    ISOLATED = "an isolated minimum"
    CLOSED = "followed until it closed, within the bounds"
    BOUNDED = "followed until it closed or met the bounds"
    CUT = "followed until there were as many models as wanted; it goes on"
    LOST = "followed as far as steps could be made; it may go on"


@dataclass(frozen=True)
class Manifold:
    """A connected set of models that are equally good.

    Attributes
    ----------
    dimension : its dimension at the start
    models : evaluations on it; those of a curve in their order along it
    extent : how far it was followed
    """

    dimension: int
    models: Sequence[Evaluation]
    extent: Extent


@dataclass(frozen=True)
class _Chart:
    """A point on the manifold, its tangents (p, d) and second derivatives (p, p) there."""

    at: Evaluation
    u: Floats
    T: Floats
    B: Floats


@dataclass(frozen=True)
class _Ground:
    """What is the same everywhere on a manifold.

    ``top`` is the greatest eigenvalue of B_0; ``held`` are variables that stay at a bound;
    ``exact`` says that B is taken and not B_0.
    """

    problem: Problem
    programme: Scalarisation
    value: float
    size: float
    top: float
    held: Bools
    dimension: int
    exact: bool

    def slope(self, at: Evaluation) -> Floats:
        """Return g."""
        return self.programme.gradient(at.J) @ at.dJ * (self.problem.upper - self.problem.lower)

    def known(self, at: Evaluation) -> Floats:
        """Return B_0."""
        span = self.problem.upper - self.problem.lower
        return np.tensordot(self.programme.gradient(at.J), at.H, axes=1) * np.outer(span, span)

    def whole(self, at: Evaluation) -> Floats | None:
        """Return B; None where the model is not defined around the point."""
        point = second_order(self.problem, at)
        if point is None:
            return None
        span = self.problem.upper - self.problem.lower
        B = np.tensordot(self.programme.gradient(at.J), point.H, axes=1)
        B = B + at.dJ.T @ self.programme.hessian(at.J) @ at.dJ
        return np.asarray(B * np.outer(span, span))

    def unchanging(self, at: Evaluation) -> Floats:
        """Return a basis (p, .) of the directions in which no residual changes."""
        lam, V = _spectrum(self.known(at), ~self.held)
        return V[:, lam <= FLAT * self.top]

    def chart(self, at: Evaluation, u: Floats) -> _Chart | None:
        """Return a point with its tangents; None where they cannot be told."""
        if not self.exact:
            return _Chart(at, u, self.unchanging(at), self.known(at))
        B = self.whole(at)
        return None if B is None else _Chart(at, u, self.tangents(at, B), B)

    def tangents(self, at: Evaluation, B: Floats) -> Floats:
        """Return a basis (p, .) of the null space of B, see the top of the module."""
        flat = ERROR * max(self.top, float(np.abs(B).max()))
        still = self.unchanging(at)
        mu, U = np.linalg.eigh(still.T @ B @ still)
        still = still @ U[:, np.abs(mu) <= flat]
        others = scipy.linalg.null_space(np.vstack([still.T, np.eye(self.held.size)[self.held]]))
        lam, V = np.linalg.eigh(others.T @ B @ others)
        null = others @ V[:, np.abs(lam) <= flat]
        gamma, U = np.linalg.eigh(null.T @ self.known(at) @ null)
        return np.hstack([still, null @ U[:, gamma >= TURNING * self.top]])

    def as_good(self, at: Evaluation) -> bool:
        """Return whether a point is as good as the start."""
        allowed = EQUAL * self.size + self.top * EQUAL**2
        return self.programme.value(at.J) <= self.value + allowed


def _spectrum(B: Floats, free: Bools) -> tuple[Floats, Floats]:
    """Return eigenvalues, ascending, and eigenvectors (p, .) of B within the free variables."""
    lam, V = np.linalg.eigh(B[np.ix_(free, free)])
    full = np.zeros((free.size, lam.size))
    full[free] = V
    return lam, full


def equally_good(
    problem: Problem,
    programme: Scalarisation,
    minima: Sequence[Evaluation],
    *,
    h: float = 0.05,
    limit: int = 100,
) -> list[Manifold]:
    """Return the manifolds through minima of a programme without constraints.

    ``minima`` are evaluations with derivatives; one that lies on a manifold found before adds
    none. ``h`` is the distance of neighbouring models over the ranges of the parameters, and
    ``limit`` the number of models of one manifold at most.
    """
    out: list[Manifold] = []
    span = problem.upper - problem.lower
    for at in minima:
        sampled = [one.theta for found in out if found.dimension for one in found.models]
        if all(np.linalg.norm((at.theta - theta) / span) > h for theta in sampled):
            out.append(follow(problem, programme, at, h=h, limit=limit))
    return out


def follow(
    problem: Problem, programme: Scalarisation, start: Evaluation, *, h: float, limit: int
) -> Manifold:
    """Return the manifold of minima through one of them; see `equally_good`."""
    ground, first = _begin(problem, programme, start)
    if ground.dimension == 0:
        return Manifold(0, [start], Extent.ISOLATED)
    charts, position = [first], [0]
    queue = deque([0])
    cut = lost = bounded = False
    while queue:
        i = queue.popleft()
        for side, t in zip((1, -1), (charts[i].T, -charts[i].T), strict=True):
            for direction in t.T:
                if len(charts) == limit:
                    cut = True
                    break
                found, outcome = _advance(ground, charts, i, direction, h)
                bounded |= outcome is _Outcome.BOUND
                lost |= outcome is _Outcome.FAILED
                if found is not None:
                    charts.append(found)
                    position.append(position[i] + (int(np.sign(position[i])) or side))
                    queue.append(len(charts) - 1)
    if ground.dimension == 1:
        charts = [charts[k] for k in np.argsort(position, kind="stable")]
    if len(charts) == 1 and lost and not bounded:
        return Manifold(0, [start], Extent.ISOLATED)  # flat to second order only
    extent = Extent.BOUNDED if bounded else Extent.CLOSED
    extent = Extent.CUT if cut else Extent.LOST if lost else extent
    return Manifold(ground.dimension, [chart.at for chart in charts], extent)


class _Outcome(Enum):
    INSIDE = "a point within the bounds, or none as it is known"
    BOUND = "the bounds are met"
    FAILED = "no step could be made"


def _begin(problem: Problem, programme: Scalarisation, at: Evaluation) -> tuple[_Ground, _Chart]:
    """Return the ground of the manifold through a minimum, and the minimum as a chart.

    Variables that the slope presses against a bound are held there.
    """
    w = programme.gradient(at.J)
    size = float(np.abs(w) @ np.abs(at.J))
    u = (at.theta - problem.lower) / (problem.upper - problem.lower)
    none = np.zeros(u.size, dtype=bool)
    ground = _Ground(problem, programme, programme.value(at.J), size, 0.0, none, 0, exact=False)
    top = float(np.linalg.eigvalsh(ground.known(at))[-1])
    slope = ground.slope(at)
    pressed = np.abs(slope) > EQUAL * np.sqrt(top * size) + ARRIVED * top
    held = pressed & np.where(slope > 0, u <= 0, u >= 1)
    ground = replace(ground, top=top, held=held)
    still, B = ground.unchanging(at), ground.whole(at)
    T = still if B is None else ground.tangents(at, B)
    as_known = (
        T.shape == still.shape and np.abs(T - still @ (still.T @ T)).max(initial=0) <= TURNING
    )
    ground = replace(ground, dimension=T.shape[1], exact=not as_known)
    if B is None or as_known:
        return ground, _Chart(at, u, still, ground.known(at))
    return ground, _Chart(at, u, T, B)


def _advance(
    ground: _Ground, charts: Sequence[_Chart], i: int, t: Floats, h: float
) -> tuple[_Chart | None, _Outcome]:
    """Return the point at the end of a step along a tangent t from chart i, if it is a new one."""
    chart = charts[i]
    room = _room(chart.u, t)
    least = ARRIVED if ground.dimension == 1 else SHORT * h
    base = ground.held
    while room.min() < least:  # go along the bounds that are in the way
        base = base | (room < least)
        along = chart.T @ scipy.linalg.null_space(chart.T[base])
        t = along @ (along.T @ t)
        size = float(np.linalg.norm(t))
        if size < SHORT:
            return None, _Outcome.BOUND
        t = np.where(base, 0.0, t / size)
        room = _room(chart.u, t)
    to_bound = float(room.min())
    length = min(h, to_bound)
    for _ in range(HALVINGS + 1):
        at_bound = length >= to_bound
        ahead = np.clip(chart.u + length * t, 0, 1)
        if _known(ahead, charts, NEAR * length):
            return None, _Outcome.INSIDE
        held = base | (room <= length) if at_bound else base
        found = _correct(ground, chart, ahead, held)
        if found is not None and _continues(chart, found, length):
            radius = NEAR * min(length, float(np.linalg.norm(found.u - chart.u)))
            new = None if _known(found.u, charts, radius) else found
            bound = bool((~ground.held & ((found.u == 0) | (found.u == 1))).any())
            return new, _Outcome.BOUND if bound else _Outcome.INSIDE
        length /= 2
    return None, _Outcome.FAILED


def _room(u: Floats, t: Floats) -> Floats:
    """Return the length of a step along t after which each variable meets its bound, (p,)."""
    moving = np.abs(t) > np.finfo(float).eps
    room = np.full(t.size, np.inf)
    room[moving] = ((t > 0) - u)[moving] / t[moving]
    return room


def _continues(chart: _Chart, found: _Chart, length: float) -> bool:
    """Return whether a point carries on from a chart: not back, and in a like direction."""
    if np.linalg.norm(found.u - chart.u) < SHORT * length:
        return False
    return bool(np.linalg.svd(chart.T.T @ found.T, compute_uv=False)[-1] >= AHEAD)


def _correct(ground: _Ground, chart: _Chart, u: Floats, held: Bools) -> _Chart | None:
    """Return the point of the manifold next to u, to which a step led from a chart, or None.

    Each variable that is held at a bound takes a dimension away from what is left to move on; one
    that leaves its bounds on the way is held there.
    """
    problem = ground.problem
    for _ in range(CORRECTIONS):
        at = problem.evaluate(problem.lower + u * (problem.upper - problem.lower))
        d = ground.dimension - int((held & ~ground.held).sum())
        if not at.feasible or d < 0:
            return None
        lam, V = _spectrum(chart.B if ground.exact else ground.known(at), ~held)
        across, V = lam[d:], V[:, d:]
        if (across <= FLAT * ground.top).any():
            return None
        s = -V @ ((V.T @ ground.slope(at)) / across)
        if np.abs(s).max(initial=0.0) <= ARRIVED:
            found = ground.chart(at, u) if ground.as_good(at) else None
            there = found is not None and found.T.shape[1] == ground.dimension
            return found if there else None
        u = u + s
        held = held | (u < 0) | (u > 1)
        u = np.clip(u, 0, 1)
    return None


def _known(u: Floats, charts: Sequence[_Chart], radius: float) -> bool:
    return any(float(np.linalg.norm(u - chart.u)) < radius for chart in charts)
