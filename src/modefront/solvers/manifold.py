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

A step along the tangents is corrected back to the manifold across them,

.. math:: s = -B^+ g, \qquad g = w^T \partial J ,

with the inverse on the complement of the null space, until s vanishes: quadratically where
residuals vanish, linearly elsewhere; in the place of :math:`B_0`, B is that of the point where the
step began. How far a manifold is followed depends on its dimension d.

* Curves and surfaces (d = 1, 2) are covered. New points grow from points by steps of length h until
  every step from every point arrives next to a known one (a packing, as in Henderson 2002,
  International Journal of Bifurcation and Chaos 12, 451-476). A step that would leave the bounds
  ends on them, and one that starts at a bound and would cross it goes along it. A surface has half
  of the models that are wanted, and h is no less than these allow; if they do not cover it, it is
  treated like what follows, from all of its points.
* A covering of more dimensions takes a number of points that grows like :math:`h^{-d}`. What is
  wanted of them is how far each parameter can go: :math:`\max \pm u_j` on the manifold, from the
  best point that is known, by steps that are best on the tangents,

  .. math:: \max_y \pm (T y)_j \quad\text{subject to}\quad 0 \le u + T y \le 1, \quad
      \|T y\|_\infty \le H ,

  linear programmes, each step corrected. What is reached is a local maximum: a parameter goes so
  far at least. No evaluation is spent on a parameter that is known to reach its bound.

So found are all minima that one can get to from the start. Another minimum lies on a manifold that
is known if a walk along that one, towards it, arrives there. Then it is not followed again, nor
where it is the minimum of another programme that is as good on all of the manifold. Not found are
other pieces of the set of minima, which need starts of their own, and what branches off with
another dimension. Sheets nearer to one another than h are not told apart. The evaluations of all
manifolds of a programme are bounded; where they are spent, what is known until then is returned.

Variables are :math:`u = (\theta - lower) / (upper - lower)`.

========  ==========================================================
symbol    meaning
========  ==========================================================
d         dimension of the manifold; 0 is an isolated minimum
h, H      distance of neighbouring points, and longest step of a walk, in u
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
import scipy.optimize

from modefront._typing import Bools, Floats
from modefront.solvers.curvature import ERROR, second_order
from modefront.solvers.problem import Evaluation, Problem
from modefront.solvers.scalarisation import Scalarisation
from modefront.work.codec import record

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

SAME_MINIMUM = 1e-5
"""Distance in u below which two isolated minima are the same."""

SAME_PLACE = 1e-9
"""Distance in u below which a variable is at its bound, or does not move."""

CORRECTIONS, HALVINGS = 12, 4
"""Corrections after which a step is given up and halved, and how often it is."""

COVERED = 2
"""Dimensions up to which a manifold is covered."""

FAR = 0.25
"""H: longest step of a walk over the ranges of the parameters."""

GAIN = 1e-2
"""Share of its range by which a parameter has to go on, lest it counts as at its end."""

FAITHFUL = 0.8
"""What a step gains over what it gains along the tangents, above which the next one is longer."""

WALK = 16
"""Steps of a walk at most."""

SPEND = 10
"""Evaluations for the manifolds of a programme, over the number of models of one of them."""

AHEAD = 0.5
"""Least cosine between tangents at the two ends of a step."""


@record
class Extent(Enum):
    """How far a manifold was followed; the value says what it means."""

    ISOLATED = "an isolated minimum"
    CLOSED = "followed until it closed, within the bounds"
    BOUNDED = "followed until it closed or met the bounds"
    CUT = "followed until there were as many models as wanted; it goes on"
    LOST = "followed as far as steps could be made; it may go on"
    SPANNED = "followed along each parameter as far as it goes"
    SPENT = "followed until the eigenproblems allowed for it were spent; it may go on"


@record
@dataclass(frozen=True)
class Manifold:
    """A connected set of models that are equally good.

    Attributes
    ----------
    dimension : its dimension at the start
    models : evaluations on it; those of a curve in their order along it, those of a manifold of
        more than two dimensions where parameters go the farthest
    extent : how far it was followed
    evaluations : what that took
    minima : how many of the minima lie on it
    twin : position, among the manifolds that were known before, of the same one; None where it
        was not known
    """

    dimension: int
    models: Sequence[Evaluation]
    extent: Extent
    evaluations: int = 0
    minima: int = 1
    twin: int | None = None


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

    ``top`` is the greatest eigenvalue of B_0; ``held`` are variables that stay at a bound, or that
    are ``idle``; ``exact`` says that B is taken and not B_0.
    """

    problem: Problem
    programme: Scalarisation
    value: float
    size: float
    top: float
    held: Bools
    idle: Bools
    dimension: int
    exact: bool

    def away(self, u: Floats, at: Evaluation) -> Floats:
        """Return the way from u to another point, but for idle variables."""
        goal = (at.theta - self.problem.lower) / (self.problem.upper - self.problem.lower)
        return np.where(self.idle, 0.0, goal - u)

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
        return V[:, lam <= FLAT * max(self.top, lam.max(initial=0.0))]

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


class _SpentError(Exception):
    """The evaluations that were allowed are spent."""


@dataclass
class _Metered:
    """A problem of which no more than ``left`` evaluations are made."""

    problem: Problem
    left: int
    spent: int = 0

    @property
    def objectives(self) -> tuple[str, ...]:
        return self.problem.objectives

    @property
    def lower(self) -> Floats:
        return self.problem.lower

    @property
    def upper(self) -> Floats:
        return self.problem.upper

    @property
    def start(self) -> Floats:
        return self.problem.start

    def evaluate(self, theta: Floats, *, derivatives: bool = True) -> Evaluation:
        if self.left <= 0:
            raise _SpentError
        self.left -= 1
        self.spent += 1
        return self.problem.evaluate(theta, derivatives=derivatives)

    def on_branch(self, branch: tuple[int, ...]) -> Problem:
        return self.problem.on_branch(branch)


def equally_good(
    problem: Problem,
    programme: Scalarisation,
    minima: Sequence[Evaluation],
    *,
    h: float = 0.05,
    limit: int = 100,
    evaluations: int | None = None,
    known: Sequence[Manifold] = (),
    idle: Bools | None = None,
) -> list[Manifold]:
    """Return the manifolds through minima of a programme without constraints.

    ``minima`` are evaluations with derivatives; one that lies on a manifold found before adds
    none. ``h`` is the distance of neighbouring models over the ranges of the parameters,
    ``limit`` the number of models of one manifold at most, and ``evaluations`` how many are made
    in all, ten times as many where nothing is said. One that is among the ``known`` manifolds, of
    other programmes, is not followed again. Parameters that are ``idle`` (p,), without effect on
    any objective, are left where they are. Minima for which no evaluation is left are manifolds of
    one model.
    """
    meter = _Metered(problem, SPEND * limit if evaluations is None else evaluations)
    still = np.zeros(problem.lower.size, dtype=bool) if idle is None else idle
    span = np.where(still, np.inf, problem.upper - problem.lower)
    out: list[Manifold] = []
    plain: int | None = None
    waiting = list(minima)
    while waiting:
        at, before = waiting.pop(0), meter.spent
        own = [
            k
            for k, one in enumerate(out)
            if _distance(one, at, span) <= (h if one.dimension else SAME_MINIMUM)
        ]
        if own:
            out[own[0]] = replace(out[own[0]], minima=out[own[0]].minima + 1)
            continue
        try:
            ground, first = _begin(meter, programme, at, still, plain)
        except _SpentError:
            out.append(Manifold(0, [at], Extent.SPENT, meter.spent - before))
            continue
        plain = plain if ground.exact else ground.dimension
        on = _on_one_of(ground, first, out, h)
        if on is not None:
            spent = out[on].evaluations + meter.spent - before
            out[on] = replace(out[on], minima=out[on].minima + 1, evaluations=spent)
            continue
        twin = _on_one_of(ground, first, known, h)
        others = waiting
        if twin is None and ground.dimension > COVERED:  # a covered one comes next to its minima
            waiting = [one for one in others if not _joined(ground, first, one, h)]
        found = _follow(ground, first, h, limit) if twin is None else known[twin]
        count, spent = 1 + len(others) - len(waiting), meter.spent - before
        out.append(replace(found, evaluations=spent, minima=count, twin=twin))
    return out


def follow(
    problem: Problem, programme: Scalarisation, start: Evaluation, *, h: float, limit: int
) -> Manifold:
    """Return the manifold of minima through one of them; see `equally_good`."""
    return equally_good(problem, programme, [start], h=h, limit=limit)[0]


def _distance(manifold: Manifold, at: Evaluation, span: Floats) -> float:
    """Return the distance of the nearest model of a manifold, over the ranges."""
    return min(float(np.linalg.norm((at.theta - one.theta) / span)) for one in manifold.models)


def _joined(ground: _Ground, first: _Chart, at: Evaluation, h: float) -> bool:
    """Return whether a walk from a point of a manifold leads to another minimum."""
    try:
        return ground.as_good(at) and _reaches(ground, first, at, h)
    except _SpentError:
        return False


def _on_one_of(
    ground: _Ground, first: _Chart, manifolds: Sequence[Manifold], h: float
) -> int | None:
    """Return the position of the manifold to which a walk from a minimum leads; None if to none.

    It has the same dimension, and all of its models are as good.
    """
    for k, one in enumerate(manifolds):
        if not one.dimension or one.dimension != ground.dimension:
            continue
        away = [float(np.linalg.norm(ground.away(first.u, x))) for x in one.models]
        try:
            if all(map(ground.as_good, one.models)) and _reaches(
                ground, first, one.models[int(np.argmin(away))], h
            ):
                return k
        except _SpentError:
            return None
    return None


def _follow(ground: _Ground, first: _Chart, h: float, limit: int) -> Manifold:
    """Return the manifold of minima through one of them, as far as evaluations are left."""
    if ground.dimension == 0:
        return Manifold(0, [first.at], Extent.ISOLATED)
    if ground.dimension > COVERED:
        charts, extent = _span(ground, [first], limit)
    else:
        surface = ground.dimension == COVERED
        covering = max(limit // 2, 1) if surface else limit
        charts, extent = _cover(
            ground, first, max(h, covering ** (-1 / 2)) if surface else h, covering
        )
        if surface and extent is Extent.CUT:
            charts, extent = _span(ground, charts, limit)
    if len(charts) == 1 and extent not in (Extent.CUT, Extent.SPENT):
        return Manifold(0, [first.at], Extent.ISOLATED)  # flat to second order, or held by bounds
    return Manifold(ground.dimension, [chart.at for chart in charts], extent)


def _cover(ground: _Ground, first: _Chart, h: float, limit: int) -> tuple[list[_Chart], Extent]:
    """Return points all over a curve or a surface."""
    charts, position = [first], [0]
    queue = deque([0])
    cut = lost = bounded = spent = False
    while queue and not spent:
        i = queue.popleft()
        for side, t in zip((1, -1), (charts[i].T, -charts[i].T), strict=True):
            for direction in t.T:
                if len(charts) == limit:
                    cut = True
                    break
                try:
                    found, outcome = _advance(ground, charts, i, direction, h)
                except _SpentError:
                    spent = True
                    break
                bounded |= outcome is _Outcome.BOUND
                lost |= outcome is _Outcome.FAILED
                if found is not None:
                    charts.append(found)
                    position.append(position[i] + (int(np.sign(position[i])) or side))
                    queue.append(len(charts) - 1)
    if ground.dimension == 1:
        charts = [charts[k] for k in np.argsort(position, kind="stable")]
    extent = Extent.BOUNDED if bounded else Extent.CLOSED
    extent = Extent.LOST if lost else extent
    return charts, Extent.SPENT if spent else Extent.CUT if cut else extent


def _span(ground: _Ground, known: list[_Chart], limit: int) -> tuple[list[_Chart], Extent]:
    """Return known points of a manifold and, after them, those where parameters go the farthest.

    As far as there may be more, they are points that were passed on the way.
    """
    charts, passed = list(known), list[_Chart]()
    ends: dict[tuple[int, float], _Chart] = {}
    ways = [(j, sign) for j in np.flatnonzero(~ground.held).tolist() for sign in (1.0, -1.0)]
    for j, sign in [*ways, *ways]:  # what other parameters led to may go on
        if len(charts) >= limit:
            return charts, Extent.CUT
        start = max(charts, key=lambda one: sign * one.u[j])
        if start is ends.get((j, sign)):
            continue
        walk, spent = _walk(ground, start, j, sign)
        ends[j, sign] = [start, *walk][-1]
        charts += walk[-1:]
        passed += walk[:-1]
        if spent:
            return [*charts, *passed][:limit], Extent.SPENT
    return [*charts, *passed][:limit], Extent.SPANNED


def _walk(ground: _Ground, chart: _Chart, j: int, sign: float) -> tuple[list[_Chart], bool]:
    """Return the points after ``chart`` on a walk that increases sign * u_j as far as it can.

    Also whether the evaluations were spent before.
    """
    aim = np.zeros(chart.u.size)
    aim[j] = sign
    length, walk = FAR, list[_Chart]()
    for _ in range(WALK):
        step = _best_step(chart, aim, length)
        gain = float(aim @ step)
        to_bound = (1 - sign) / 2 + sign * chart.u[j] + gain >= 1 - SAME_PLACE
        if gain <= SAME_PLACE or (gain < min(GAIN, length / 2) and not to_bound):
            break
        try:
            found = _land(ground, chart, chart.u + step)
        except _SpentError:
            return walk, True
        share = 0.0 if found is None else float(aim @ (found.u - chart.u)) / gain
        if found is not None and share >= AHEAD:
            chart = found
            walk.append(found)
            length = min(2 * length, FAR) if share > FAITHFUL else length
        elif length > FAR / 2**HALVINGS:
            length /= 2
        else:
            break
    return walk, False


def _best_step(chart: _Chart, aim: Floats, length: float) -> Floats:
    """Return the tangent step, no longer than ``length`` and within the bounds, best for an aim."""
    T, u = chart.T, chart.u
    room = np.minimum(length, 1 - u), np.minimum(length, u)
    limits = np.concatenate(room)
    found = scipy.optimize.linprog(
        -aim @ T, np.vstack([T, -T]), np.maximum(limits, 0.0), bounds=(None, None), method="highs"
    )
    return T @ found.x if found.status == 0 else np.zeros(u.size)


def _land(ground: _Ground, chart: _Chart, u: Floats) -> _Chart | None:
    """Return the point of the manifold next to u, which keeps to the bounds that u is at."""
    at_bound = ~ground.held & ((u <= SAME_PLACE) | (u >= 1 - SAME_PLACE))
    u = np.clip(u, 0, 1)
    found = None
    if at_bound.sum() <= ground.dimension:
        found = _correct(ground, chart, np.where(at_bound, np.round(u), u), ground.held | at_bound)
    return _correct(ground, chart, u, ground.held) if found is None else found


def _reaches(ground: _Ground, chart: _Chart, at: Evaluation, h: float) -> bool:
    """Return whether a walk along the manifold from a chart arrives next to a point on it."""
    for _ in range(WALK):
        away = ground.away(chart.u, at)
        distance = float(np.linalg.norm(away))
        if distance <= h:
            return True
        step = chart.T @ (chart.T.T @ away)
        size = float(np.linalg.norm(step))
        if size < AHEAD * distance:
            return False
        found = _land(ground, chart, np.clip(chart.u + step * min(1.0, FAR / size), 0, 1))
        if found is None or np.linalg.norm(ground.away(found.u, at)) >= distance:
            return False
        chart = found
    return False


class _Outcome(Enum):
    INSIDE = "a point within the bounds, or none as it is known"
    BOUND = "the bounds are met"
    FAILED = "no step could be made"


def _begin(
    problem: Problem, programme: Scalarisation, at: Evaluation, idle: Bools, plain: int | None
) -> tuple[_Ground, _Chart]:
    """Return the ground of the manifold through a minimum, and the minimum as a chart.

    Variables that the slope presses against a bound are held there, and those that are ``idle``
    where they are. B is not looked at where B_0 has a null space of the dimension ``plain``, for
    which it was that of B at another minimum.
    """
    w = programme.gradient(at.J)
    size = float(np.abs(w) @ np.abs(at.J))
    u = (at.theta - problem.lower) / (problem.upper - problem.lower)
    none = np.zeros(u.size, dtype=bool)
    value = programme.value(at.J)
    ground = _Ground(problem, programme, value, size, 0.0, none, idle, 0, exact=False)
    top = float(np.linalg.eigvalsh(ground.known(at))[-1])
    slope = ground.slope(at)
    pressed = np.abs(slope) > EQUAL * np.sqrt(top * size) + ARRIVED * top
    held = idle | (pressed & np.where(slope > 0, u <= 0, u >= 1))
    ground = replace(ground, top=top, held=held)
    still = ground.unchanging(at)
    B = None if still.shape[1] == plain else ground.whole(at)
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
        if (across <= FLAT * max(ground.top, across.max(initial=0.0))).any():
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
