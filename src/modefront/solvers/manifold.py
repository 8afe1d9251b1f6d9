r"""Equivalent models: manifolds of minima, followed and sampled to their ends.

Where data do not determine all parameters, the minimisers of a scalarisation f(J) form a manifold
(Katafygiotis & Lam 2002, Earthquake Engineering and Structural Dynamics 31, 791-812). Its tangents
and the corrections that lead back to it are those of `modefront.solvers.tangents`. How far it is
followed depends on its dimension d.

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

========  =======  =================================================================
symbol    shape    meaning
========  =======  =================================================================
d         ()       dimension of the manifold; 0 is an isolated minimum
h, H      ()       distance of neighbouring points, and longest step of a walk, in u
T         (p, d)   orthonormal basis of the tangent space, in u
========  =======  =================================================================
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum

import numpy as np
import scipy.linalg

from modefront._typing import Bools, Floats
from modefront.solvers.problem import Evaluation, Problem, Wrapped
from modefront.solvers.scalarisation import Scalarisation
from modefront.solvers.tangents import (
    ARRIVED,
    AT_BOUND,
    Context,
    TangentPoint,
    context_of,
    steps_to_bounds,
)
from modefront.work.codec import record
from modefront.work.steps import note

NEAR = 0.7
"""Distance over the length of a step, below which a point counts as one that is known: below 1, as
corrected steps do not end where they were to, and above 1/2, or points lie twice as dense."""

SHORT = 0.3
"""Step over h, below which it is not worth making to a bound, but at the ends of a curve: an
evaluation or more for a model like the last one."""

SAME_MINIMUM = 1e-5
"""Distance in u below which two isolated minima are the same: a hundred times the tolerance of a
step (`modefront.solvers.sqp.Options`), which minima that are nearly flat miss by as much."""

HALVINGS = 4
"""Halvings of a step that finds no point, at most: with shorter ones, the models that are
wanted do not lead far."""

COVERED = 2
"""Dimensions up to which a manifold is covered: with a distance of 0.1, three take a thousand
models."""

FAR = 0.25
"""H: longest step of a walk over the ranges of the parameters; a trade-off between the number of
steps and of corrections for each."""

GAIN = 1e-2
"""Share of its range by which a parameter has to go on, lest it counts as at its end: what is
reported of a range has two digits."""

FAITHFUL = 0.8
"""Gain of a step over that along the tangents, above which the next one is longer: the
manifold is straight over its length."""

WALK = 16
"""Steps of a walk at most: of the longest ones, four times across the range of a parameter."""

SPEND = 10
"""Evaluations for the manifolds of a programme, over the number of models of one of them: a model
takes about three, some of them lost."""

AHEAD = 0.5
"""Least cosine between tangents at the two ends of a step, and between a step and where it is to
lead: 60 degrees."""


@record
class Extent(Enum):
    """Extent to which a manifold was followed; the value describes it."""

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
    """A connected set of equivalent models.

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


class _SpentError(Exception):
    """The evaluations that were allowed are spent."""


@dataclass
class _Meter:
    """Counts evaluations, of which no more than ``left`` are made."""

    left: int
    spent: int = 0

    def evaluation(self, problem: Problem, theta: Floats, derivatives: bool) -> Evaluation:
        """Return an evaluation; raises _SpentError where none is left."""
        if self.left <= 0:
            raise _SpentError
        self.left -= 1
        self.spent += 1
        note(f"model {self.spent} of at most {self.left + self.spent}")
        return problem.evaluate(theta, derivatives=derivatives)


# 8 arguments: the minima, and limits by keyword.
def equivalent_models(
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
    one model. What is by keyword are independent limits and knowledge, hence their number.
    """
    meter = _Meter(SPEND * limit if evaluations is None else evaluations)
    metered = Wrapped(problem, meter.evaluation)
    still = np.zeros(problem.lower.size, dtype=bool) if idle is None else idle
    span = np.where(still, np.inf, problem.upper - problem.lower)
    out: list[Manifold] = []
    plain: int | None = None
    waiting = list(minima)
    while waiting:
        evaluation, before = waiting.pop(0), meter.spent
        near = [
            k
            for k, manifold in enumerate(out)
            if _distance(manifold, evaluation, span) <= (h if manifold.dimension else SAME_MINIMUM)
        ]
        if near:
            out[near[0]] = replace(out[near[0]], minima=out[near[0]].minima + 1)
            continue
        try:
            context, first = context_of(metered, programme, evaluation, still, plain)
        except _SpentError:
            out.append(Manifold(0, [evaluation], Extent.SPENT, meter.spent - before))
            continue
        plain = plain if context.exact else context.dimension
        k = _position(context, first, out, h)
        if k is not None:
            spent = out[k].evaluations + meter.spent - before
            out[k] = replace(out[k], minima=out[k].minima + 1, evaluations=spent)
            continue
        twin = _position(context, first, known, h)
        others = waiting
        if twin is None and context.dimension > COVERED:  # a covered one comes next to its minima
            waiting = [other for other in others if not _joined(context, first, other, h)]
        manifold = _follow(context, first, h, limit) if twin is None else known[twin]
        count, spent = 1 + len(others) - len(waiting), meter.spent - before
        out.append(replace(manifold, evaluations=spent, minima=count, twin=twin))
    return out


def follow(
    problem: Problem, programme: Scalarisation, start: Evaluation, *, h: float, limit: int
) -> Manifold:
    """Return the manifold of minima through one of them; see `equivalent_models`."""
    return equivalent_models(problem, programme, [start], h=h, limit=limit)[0]


def _distance(manifold: Manifold, evaluation: Evaluation, span: Floats) -> float:
    """Return the distance of the nearest model of a manifold, over the ranges."""
    return min(float(np.linalg.norm((evaluation.theta - x.theta) / span)) for x in manifold.models)


def _joined(context: Context, first: TangentPoint, evaluation: Evaluation, h: float) -> bool:
    """Return whether a walk from a point of a manifold leads to another minimum."""
    try:
        return context.equivalent(evaluation) and _reaches(context, first, evaluation, h)
    except _SpentError:
        return False


def _position(
    context: Context, first: TangentPoint, manifolds: Sequence[Manifold], h: float
) -> int | None:
    """Return the position of the manifold to which a walk from a minimum leads; None if to none.

    It has the same dimension, and all of its models are as good.
    """
    for k, manifold in enumerate(manifolds):
        if not manifold.dimension or manifold.dimension != context.dimension:
            continue
        distances = [float(np.linalg.norm(context.offset(first.u, x))) for x in manifold.models]
        try:
            if all(map(context.equivalent, manifold.models)) and _reaches(
                context, first, manifold.models[int(np.argmin(distances))], h
            ):
                return k
        except _SpentError:
            return None
    return None


def _follow(context: Context, first: TangentPoint, h: float, limit: int) -> Manifold:
    """Return the manifold of minima through one of them, as far as evaluations are left."""
    if context.dimension == 0:
        return Manifold(0, [first.evaluation], Extent.ISOLATED)
    if context.dimension > COVERED:
        points, extent = _span(context, [first], limit)
    else:
        surface = context.dimension == COVERED
        covering = max(limit // 2, 1) if surface else limit
        points, extent = _cover(
            context, first, max(h, covering ** (-1 / 2)) if surface else h, covering
        )
        if surface and extent is Extent.CUT:
            points, extent = _span(context, points, limit)
    if len(points) == 1 and extent not in (Extent.CUT, Extent.SPENT):
        # Flat to second order only, or held by bounds.
        return Manifold(0, [first.evaluation], Extent.ISOLATED)
    return Manifold(context.dimension, [point.evaluation for point in points], extent)


def _cover(
    context: Context, first: TangentPoint, h: float, limit: int
) -> tuple[list[TangentPoint], Extent]:
    """Return points all over a curve or a surface."""
    points, position = [first], [0]
    queue = deque([0])
    cut = lost = bounded = spent = False
    while queue and not spent:
        i = queue.popleft()
        for side, t in zip((1, -1), (points[i].T, -points[i].T), strict=True):
            for direction in t.T:
                if len(points) == limit:
                    cut = True
                    break
                try:
                    new, outcome = _advance(context, points, i, direction, h)
                except _SpentError:
                    spent = True
                    break
                bounded |= outcome is _Outcome.BOUND
                lost |= outcome is _Outcome.FAILED
                if new is not None:
                    points.append(new)
                    position.append(position[i] + (int(np.sign(position[i])) or side))
                    queue.append(len(points) - 1)
    if context.dimension == 1:
        points = [points[k] for k in np.argsort(position, kind="stable")]
    extent = Extent.BOUNDED if bounded else Extent.CLOSED
    extent = Extent.LOST if lost else extent
    return points, Extent.SPENT if spent else Extent.CUT if cut else extent


def _span(
    context: Context, known: list[TangentPoint], limit: int
) -> tuple[list[TangentPoint], Extent]:
    """Return known points of a manifold and, after them, those where parameters go the farthest.

    As far as there may be more, they are points that were passed on the way.
    """
    points, passed = list(known), list[TangentPoint]()
    ends: dict[tuple[int, float], TangentPoint] = {}
    aims = [(j, sign) for j in np.flatnonzero(~context.held).tolist() for sign in (1.0, -1.0)]
    for j, sign in [*aims, *aims]:  # what other parameters led to may go on
        if len(points) >= limit:
            return points, Extent.CUT
        start = max(points, key=lambda point: sign * point.u[j])
        if start is ends.get((j, sign)):
            continue
        walk, spent = _walk(context, start, j, sign)
        ends[j, sign] = [start, *walk][-1]
        points += walk[-1:]
        passed += walk[:-1]
        if spent:
            return [*points, *passed][:limit], Extent.SPENT
    return [*points, *passed][:limit], Extent.SPANNED


def _walk(
    context: Context, point: TangentPoint, j: int, sign: float
) -> tuple[list[TangentPoint], bool]:
    """Return the points after ``point`` on a walk that increases sign * u_j as far as it can.

    Also whether the evaluations were spent before.
    """
    aim = np.zeros(point.u.size)
    aim[j] = sign
    length, walk = FAR, list[TangentPoint]()
    for _ in range(WALK):
        step = _best_step(point, aim, length)
        gain = float(aim @ step)
        to_bound = (1 - sign) / 2 + sign * point.u[j] + gain >= 1 - AT_BOUND
        if gain <= AT_BOUND or (gain < min(GAIN, length / 2) and not to_bound):
            break
        try:
            landed = context.landed(point, point.u + step)
        except _SpentError:
            return walk, True
        share = 0.0 if landed is None else float(aim @ (landed.u - point.u)) / gain
        if landed is not None and share >= AHEAD:
            point = landed
            walk.append(landed)
            length = min(2 * length, FAR) if share > FAITHFUL else length
        elif length > FAR / 2**HALVINGS:
            length /= 2
        else:
            break
    return walk, False


def _best_step(point: TangentPoint, aim: Floats, length: float) -> Floats:
    """Return the tangent step, no longer than ``length`` and within the bounds, best for an aim."""
    import scipy.optimize

    T, u = point.T, point.u
    limits = np.maximum(np.concatenate([np.minimum(length, 1 - u), np.minimum(length, u)]), 0.0)
    best = scipy.optimize.linprog(
        -aim @ T, np.vstack([T, -T]), limits, bounds=(None, None), method="highs"
    )
    return T @ best.x if best.status == 0 else np.zeros(u.size)


def _reaches(context: Context, point: TangentPoint, evaluation: Evaluation, h: float) -> bool:
    """Return whether a walk along the manifold from a point arrives next to a point on it."""
    for _ in range(WALK):
        offset = context.offset(point.u, evaluation)
        distance = float(np.linalg.norm(offset))
        if distance <= h:
            return True
        step = point.T @ (point.T.T @ offset)
        size = float(np.linalg.norm(step))
        if size < AHEAD * distance:
            return False
        landed = context.landed(point, np.clip(point.u + step * min(1.0, FAR / size), 0, 1))
        if landed is None or np.linalg.norm(context.offset(landed.u, evaluation)) >= distance:
            return False
        point = landed
    return False


class _Outcome(Enum):
    INSIDE = "a point within the bounds, or none as it is known"
    BOUND = "the bounds are met"
    FAILED = "no step could be made"


def _advance(
    context: Context, points: Sequence[TangentPoint], i: int, t: Floats, h: float
) -> tuple[TangentPoint | None, _Outcome]:
    """Return the point at the end of a step along a tangent t from point i, if it is a new one."""
    point = points[i]
    steps = steps_to_bounds(point.u, t)
    least = ARRIVED if context.dimension == 1 else SHORT * h
    base = context.held
    while steps.min() < least:  # go along the bounds that are in the way
        base = base | (steps < least)
        along = point.T @ scipy.linalg.null_space(point.T[base])
        t = along @ (along.T @ t)
        size = float(np.linalg.norm(t))
        if size < SHORT:
            return None, _Outcome.BOUND
        t = np.where(base, 0.0, t / size)
        steps = steps_to_bounds(point.u, t)
    to_bound = float(steps.min())
    length = min(h, to_bound)
    for _ in range(HALVINGS + 1):
        at_bound = length >= to_bound
        ahead = np.clip(point.u + length * t, 0, 1)
        if _known(ahead, points, NEAR * length):
            return None, _Outcome.INSIDE
        held = base | (steps <= length) if at_bound else base
        corrected = context.corrected(point, ahead, held)
        if corrected is not None and _continues(point, corrected, length):
            radius = NEAR * min(length, float(np.linalg.norm(corrected.u - point.u)))
            new = None if _known(corrected.u, points, radius) else corrected
            bound = bool((~context.held & ((corrected.u == 0) | (corrected.u == 1))).any())
            return new, _Outcome.BOUND if bound else _Outcome.INSIDE
        length /= 2
    return None, _Outcome.FAILED


def _continues(point: TangentPoint, new: TangentPoint, length: float) -> bool:
    """Return whether a new point carries on from another: not back, and in a like direction."""
    if np.linalg.norm(new.u - point.u) < SHORT * length:
        return False
    return bool(np.linalg.svd(point.T.T @ new.T, compute_uv=False)[-1] >= AHEAD)


def _known(u: Floats, points: Sequence[TangentPoint], radius: float) -> bool:
    """Return whether u is within a radius of one of the points."""
    return any(float(np.linalg.norm(u - point.u)) < radius for point in points)
