r"""Equivalent models: manifolds of minima, followed and sampled to their ends.

The tangent space of the minimisers of f(J) is the null space of their second derivatives B within
the variables that no bound holds; what changes residuals a little is weakly determined and no
tangent. A step along the tangents is corrected across them, by Newton's method on a basis Q of
their complement,

.. math:: s = -Q\, (Q^T B Q)^{-1} Q^T g, \qquad g = \partial f / \partial J\, \partial J ;

where residuals vanish, with Gauss-Newton's G, which is B on the manifold and leads farther. Of a
model without exact second derivatives B is G.

The manifold (`docs/identifiability.md`) is followed by its dimension d.

* Curves and surfaces (d = 1, 2) are covered. New points grow from points by steps of length h until
  every step from every point arrives next to a known one (a packing, as in Henderson 2002,
  International Journal of Bifurcation and Chaos 12, 451-476). A step that would leave the bounds
  ends on them, and one that starts at a bound and would cross it goes along it. A surface has half
  of the models that are wanted; if they do not cover it, it is treated like what follows.
* Of more dimensions, it is found how far each parameter can go, from the best point that is known,
  by steps that are best on the tangents: linear programmes, each step corrected.

Another minimum is not followed where a walk along a manifold that is known arrives there. Not found
are other pieces of the set of minima, and what branches off with another dimension. Lengths are
those of :math:`u = (\theta - lower) / (upper - lower)`.
"""

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum

import numpy as np
import scipy.linalg
from scipy.linalg import null_space

from modefront._typing import Bools, Floats
from modefront.front.weights import UNCHANGED
from modefront.optim.lexicographic import EXACT, TIE
from modefront.optim.problem import AT_BOUND, DISTINCT, Evaluation, Problem, SpentError, Wrapped
from modefront.optim.qp import HALVINGS
from modefront.optim.scalarisation import Scalarisation
from modefront.optim.sqp import GOOD, SADDLE, Options
from modefront.work.codec import record
from modefront.work.progress import note

NEAR = 0.7
"""Distance over the length of a step, below which a point counts as one that is known: below 1, as
corrected steps do not end where they were to, and above 1/2, or points lie twice as dense."""

SHORT = 1 - NEAR
"""Share below which a step leads nowhere: of h or of what it is to gain, and the cosine of a turn
(73 degrees)."""

FAR = 0.25  # longest step h of a walk over the ranges of the parameters

GAIN = 1e-2
"""Share of its range by which a parameter has to go on, lest it counts as at its end: what is
reported of a range has two digits."""

SPEND = 10  # evaluations for the manifolds of a programme, over the number of models of one of them

FLAT = 1e-5
"""Eigenvalue of B over the greatest one, below which a direction may be flat: more than what the
distance from the manifold leaves."""

ARRIVED = Options().step  # correction in u below which a point lies on the manifold


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
    """A connected set of equivalent models."""

    dimension: int  # its dimension at the start
    # evaluations on it; those of a curve in their order along it, those of a manifold of more than
    # two dimensions where parameters go the farthest
    models: Sequence[Evaluation]
    extent: Extent  # how far it was followed
    evaluations: int = 0  # what that took
    twin: int | None = None  # position of the same one among those known before, if it is there


@dataclass(frozen=True)
class TangentPoint:
    """A point on the manifold with its tangents (p, d)."""

    evaluation: Evaluation
    u: Floats
    T: Floats


class Context:
    """Quantities that are the same everywhere on a manifold.

    Variables that the slope presses against a bound are held there, unless residuals vanish, and
    those that are ``idle`` (p,), without effect, where they are.
    """

    def __init__(
        self, problem: Problem, programme: Scalarisation, minimum: Evaluation, idle: Bools
    ) -> None:
        self.problem, self.programme, self.idle = problem, programme, idle
        self.span = span = problem.upper - problem.lower
        if not minimum.exact:
            minimum = problem.evaluate(minimum.theta, second=True)
        w, value = programme.gradient(minimum.J), programme.value(minimum.J)
        u, g = (minimum.theta - problem.lower) / span, w @ minimum.dJ * span
        size, B = float(np.abs(w) @ np.abs(minimum.J)), self.second(minimum)
        self.top = top = float(np.abs(np.linalg.eigvalsh(B)).max())
        self.most = value + TIE * size + top * TIE**2  # the greatest f that is as good
        self.fits = size <= EXACT * top  # whether residuals vanish on the manifold
        pressed = (np.abs(g) > TIE * np.sqrt(top * size) + ARRIVED * top) & (not self.fits)
        self.held = idle | (pressed & np.where(g > 0, u <= 0, u >= 1))
        self.first = TangentPoint(minimum, u, self.tangents(minimum))
        self.dimension = self.first.T.shape[1]

    def offset(self, point: TangentPoint, evaluation: Evaluation) -> Floats:
        """Return the difference of an evaluation from a point, but for idle variables."""
        goal = (evaluation.theta - self.problem.lower) / self.span
        return np.where(self.idle, 0.0, goal - point.u)

    def distance(self, point: TangentPoint, evaluation: Evaluation) -> float:
        """Return the length of that."""
        return float(np.linalg.norm(self.offset(point, evaluation)))

    def equivalent(self, evaluation: Evaluation) -> bool:
        """Return whether a model is as good as the start."""
        return self.programme.value(evaluation.J) <= self.most

    def second(self, evaluation: Evaluation) -> Floats:
        """Return B."""
        J, dJ = evaluation.J, evaluation.dJ * self.span
        B = self._weighted(evaluation, evaluation.H)
        return B + dJ.T @ self.programme.hessian(J) @ dJ if evaluation.exact else B

    def tangents(self, evaluation: Evaluation) -> Floats:
        """Return a basis (p, .) of the null space of B, without what is weakly determined.

        There residuals do not change in it, or turn clearly: their slopes are roots of those of G.
        """
        N = np.eye(self.held.size)[:, ~self.held]
        lam, V = np.linalg.eigh(N.T @ self._across(evaluation) @ N)
        N = N @ V[:, np.abs(lam) <= FLAT * self.top]
        G = self._weighted(evaluation, evaluation.gauss_newton)
        gamma, V = np.linalg.eigh(N.T @ G @ N)
        return N @ V[:, (gamma <= UNCHANGED * self.top) | (gamma >= SADDLE * self.top)]

    def corrected(self, start: TangentPoint, u: Floats, held: Bools) -> TangentPoint | None:
        """Return the point of the manifold next to u, to which a step from ``start`` led, or None.

        Each variable that is held at a bound takes a dimension away from what is left to move on;
        one that leaves its bounds on the way is held there. Corrections that do not become shorter
        lead nowhere.
        """
        before = np.inf
        while True:
            evaluation = self.problem.evaluate(self.problem.lower + u * self.span, second=True)
            if not evaluation.feasible or (held & ~self.held).sum() > self.dimension:
                return None
            T = start.T @ null_space(start.T[held])
            Q = null_space(np.vstack([T.T, np.eye(u.size)[held]]))
            try:
                factor = scipy.linalg.cho_factor(Q.T @ self._across(evaluation) @ Q)
            except np.linalg.LinAlgError:
                return None
            g = self.programme.gradient(evaluation.J) @ evaluation.dJ * self.span
            s = -Q @ scipy.linalg.cho_solve(factor, Q.T @ g)
            size = float(np.abs(s).max(initial=0.0))
            if size <= ARRIVED:
                point = TangentPoint(evaluation, u, self.tangents(evaluation))
                on = self.equivalent(evaluation) and point.T.shape[1] == self.dimension
                return point if on else None
            if size >= before:
                return None
            before, u = size, u + s
            held = held | (u < 0) | (u > 1)
            u = np.clip(u, 0, 1)

    def landed(self, start: TangentPoint, u: Floats, held: Bools) -> TangentPoint | None:
        """Return the point next to u, likewise, on the bounds that u is at if there is one.

        ``held`` (p,) variables stay where they are.
        """
        at_bound = ~held & ((u <= AT_BOUND) | (u >= 1 - AT_BOUND))
        point = None
        if at_bound.any() and (at_bound | held & ~self.held).sum() <= self.dimension:
            point = self.corrected(start, np.where(at_bound, np.round(u), u), held | at_bound)
        return self.corrected(start, np.clip(u, 0, 1), held) if point is None else point

    def _across(self, evaluation: Evaluation) -> Floats:
        """Return the second derivatives across the manifold: G is B where residuals vanish."""
        if self.fits:
            return self._weighted(evaluation, evaluation.gauss_newton)
        return self.second(evaluation)

    def _weighted(self, evaluation: Evaluation, H: Floats) -> Floats:
        w = self.programme.gradient(evaluation.J)
        return np.asarray(np.tensordot(w, H, axes=1) * np.outer(self.span, self.span))


# 7 arguments: the minima, and limits by keyword.
def equivalent_models(
    problem: Problem,
    programme: Scalarisation,
    minima: Sequence[Evaluation],
    *,
    h: float = 0.05,
    limit: int = 100,
    known: Sequence[Manifold] = (),
    idle: Bools | None = None,
) -> list[Manifold]:
    """Return the manifolds through minima of a programme without constraints.

    ``minima`` are evaluations with derivatives; one that lies on a manifold found before adds
    none. ``h`` is the distance of neighbouring models over the ranges of the parameters,
    ``limit`` the number of models of one manifold at most. One that is among the ``known``
    manifolds, of other programmes, is not followed again. Parameters that are ``idle`` (p,),
    without effect on any objective, are left where they are. Minima for which no evaluation is left
    are manifolds of one model.
    """
    most = SPEND * limit

    def evaluation(of: Problem, theta: Floats, derivatives: bool, second: bool) -> Evaluation:
        note(f"model {metered.count} of at most {most}")
        return of.evaluate(theta, derivatives=derivatives, second=second)

    metered = Wrapped(problem, evaluation, most=most)
    still = np.zeros(problem.lower.size, dtype=bool) if idle is None else idle
    span = np.where(still, np.inf, problem.upper - problem.lower)
    out: list[Manifold] = []
    for minimum in minima:
        before, every = metered.count, [*out, *known]
        k = next((k for k, x in enumerate(out) if _is_on(x, minimum, span, h)), None)
        try:
            if k is None:
                context = Context(metered, programme, minimum, still)
                k = _position(context, every, h)
            manifold = every[k] if k is not None else _follow(context, h, limit)
        except SpentError:
            manifold = Manifold(0, [minimum], Extent.SPENT)
        took = metered.count - before
        if k is None:
            out.append(replace(manifold, evaluations=took))
        elif k < len(out):
            out[k] = replace(manifold, evaluations=manifold.evaluations + took)
        else:
            out.append(replace(manifold, evaluations=took, twin=k - len(out)))
    return out


def _is_on(manifold: Manifold, minimum: Evaluation, span: Floats, h: float) -> bool:
    """Return whether a minimum is next to a model of a manifold."""
    theta = np.array([model.theta for model in manifold.models])
    near = float(np.linalg.norm((theta - minimum.theta) / span, axis=1).min())
    return near <= (h if manifold.dimension else DISTINCT)


def _position(context: Context, manifolds: Sequence[Manifold], h: float) -> int | None:
    """Return the position of the manifold to which a walk from a minimum leads; None if to none.

    It has the same dimension, and all of its models are as good.
    """
    for k, manifold in enumerate(manifolds):
        alike = manifold.dimension == context.dimension > 0
        if alike and all(map(context.equivalent, manifold.models)):
            distances = [context.distance(context.first, x) for x in manifold.models]
            if _reaches(context, manifold.models[int(np.argmin(distances))], h):
                return k
    return None


def _reaches(context: Context, evaluation: Evaluation, h: float) -> bool:
    """Return whether a walk along the manifold arrives next to a point on it."""
    point = context.first
    while True:
        distance = context.distance(point, evaluation)
        if distance <= h:
            return True
        step = point.T @ (point.T.T @ context.offset(point, evaluation))
        size = float(np.linalg.norm(step))
        if size < SHORT * distance:
            return False
        u = np.clip(point.u + step * min(1.0, FAR / size), 0, 1)
        landed = context.landed(point, u, context.held)
        if landed is None or context.distance(landed, evaluation) >= distance:
            return False
        point = landed


def _follow(context: Context, h: float, limit: int) -> Manifold:
    """Return the manifold of minima through one of them, as far as evaluations are left."""
    d, points, extent = context.dimension, [context.first], Extent.ISOLATED
    try:
        if d == 1:
            extent = _cover(context, points, h, limit)
        elif d == 2:
            covering = max(limit // 2, 1)
            extent = _cover(context, points, max(h, covering ** (-1 / 2)), covering)
        if d > 2 or (d == 2 and extent is Extent.CUT):
            extent = _span(context, points, limit)
    except SpentError:
        extent = Extent.SPENT
    if len(points) == 1 and extent not in (Extent.CUT, Extent.SPENT):
        d, extent = 0, Extent.ISOLATED  # flat to second order only, or held by bounds
    return Manifold(d, [point.evaluation for point in points], extent)


def _cover(context: Context, points: list[TangentPoint], h: float, limit: int) -> Extent:
    """Add points all over a curve or a surface, those of a curve in their order along it."""
    extents = [Extent.CLOSED]
    queue = deque((points[0], side * t, side) for t in points[0].T.T for side in (1, -1))
    while queue:
        point, t, side = queue.popleft()
        if len(points) == limit:
            return Extent.CUT
        new, extent = _advance(context, points, point, t, h)
        extents.append(extent)
        if new is not None:
            points.insert(len(points) if side > 0 or context.dimension > 1 else 0, new)
            queue.extend((new, s * t, side) for t in new.T.T for s in (1, -1))
    return next((x for x in (Extent.LOST, Extent.BOUNDED) if x in extents), Extent.CLOSED)


def _advance(
    context: Context, points: Sequence[TangentPoint], point: TangentPoint, t: Floats, h: float
) -> tuple[TangentPoint | None, Extent]:
    """Return the point at the end of a step along a tangent t, if it is new, and what it met."""
    least = ARRIVED if context.dimension == 1 else SHORT * h
    held, room = context.held, _room(point.u, t)
    while room.min() < least:  # go along the bounds that are in the way
        held = held | (room < least)
        along = point.T @ null_space(point.T[held])
        t = along @ (along.T @ t)
        size = float(np.linalg.norm(t))
        if size < SHORT:
            return None, Extent.BOUNDED
        t = np.where(held, 0.0, t / size)
        room = _room(point.u, t)
    length = min(h, float(room.min()))
    for _ in range(HALVINGS + 1):
        ahead = point.u + length * t
        if _known(ahead, points, NEAR * length):
            return None, Extent.CLOSED
        new = context.landed(point, ahead, held)
        if new is not None and _continues(point, new, length):
            radius = NEAR * min(length, float(np.linalg.norm(new.u - point.u)))
            bound = bool((~context.held & ((new.u == 0) | (new.u == 1))).any())
            extent = Extent.BOUNDED if bound else Extent.CLOSED
            return None if _known(new.u, points, radius) else new, extent
        length /= 2
    return None, Extent.LOST


def _room(u: Floats, t: Floats) -> Floats:
    """Return the length of a step along t after which each variable meets its bound, (p,)."""
    moving = np.abs(t) > np.finfo(float).eps
    return np.divide((t > 0) - u, t, out=np.full(t.size, np.inf), where=moving)


def _continues(point: TangentPoint, new: TangentPoint, length: float) -> bool:
    """Return whether a new point carries on from another: not back, and in a like direction."""
    forward = np.linalg.norm(new.u - point.u) >= SHORT * length
    return bool(forward and np.linalg.svd(point.T.T @ new.T, compute_uv=False)[-1] >= SHORT)


def _known(u: Floats, points: Sequence[TangentPoint], radius: float) -> bool:
    """Return whether u is within a radius of one of the points."""
    return any(float(np.linalg.norm(u - point.u)) < radius for point in points)


def _span(context: Context, points: list[TangentPoint], limit: int) -> Extent:
    """Add points of a manifold where parameters go the farthest, then those passed on the way."""
    passed: list[TangentPoint] = []
    ends: dict[tuple[int, int], TangentPoint] = {}
    aims = [(j, sign) for j in np.flatnonzero(~context.held).tolist() for sign in (1, -1)]
    try:
        for j, sign in [*aims, *aims]:  # what other parameters led to may go on
            if len(points) >= limit:
                return Extent.CUT
            walk = [max(points, key=lambda point: sign * point.u[j])]
            if walk[0] is not ends.get((j, sign)):
                try:
                    _walk(context, walk, j, sign)
                finally:
                    ends[j, sign] = walk[-1]
                    points += walk[1:][-1:]
                    passed += walk[1:-1]
    finally:
        points += passed[: limit - len(points)]
    return Extent.SPANNED


def _walk(context: Context, walk: list[TangentPoint], j: int, sign: int) -> None:
    """Add the points of a walk that increases sign * u_j as far as it can."""
    length = FAR
    while True:
        point = walk[-1]
        step = _best_step(point, j, sign, length)
        gain = float(sign * step[j])
        to_bound = not AT_BOUND < point.u[j] + step[j] < 1 - AT_BOUND
        if gain <= AT_BOUND or (gain < min(GAIN, length / 2) and not to_bound):
            return
        landed = context.landed(point, point.u + step, context.held)
        share = 0.0 if landed is None else float(sign * (landed.u[j] - point.u[j])) / gain
        if landed is not None and share >= SHORT:
            walk.append(landed)
            length = min(2 * length, FAR) if share > GOOD else length
        elif length > FAR / 2**HALVINGS:
            length /= 2
        else:
            return


def _best_step(point: TangentPoint, j: int, sign: int, length: float) -> Floats:
    """Return the tangent step within the bounds that increases sign * u_j the most.

    No variable moves by more than ``length``.
    """
    import scipy.optimize

    T, u = point.T, point.u
    limits = np.maximum(np.concatenate([np.minimum(length, 1 - u), np.minimum(length, u)]), 0.0)
    A = np.vstack([T, -T])
    best = scipy.optimize.linprog(-sign * T[j], A, limits, bounds=(None, None), method="highs")
    return T @ best.x if best.status == 0 else np.zeros(u.size)
