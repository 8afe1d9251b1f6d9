r"""The border of a front of three and more objectives, where some bounds hold nothing.

There the achievement function of `modefront.solvers.attainment` leaves the objectives whose bounds
are not active to their share :math:`\rho`. Where parameters outnumber the data, these objectives
fall along flat valleys on which the greatest excess is the same, and a share so small does not lead
to their end. So with the active bounds held, their sum is minimised for itself, a lexicographic
optimum (Steuer & Choo 1983, doi:10.1007/BF02591870), and the point is solved again from there:

.. math:: \min_\theta \sum_{i \notin A} y_i \quad\text{subject to}\quad y_i = y_i^*,\; i \in A .
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from modefront._typing import Bools, Floats
from modefront.solvers.attainment import SAME, Attainment, active_bounds
from modefront.solvers.lexicographic import Lexicographic
from modefront.solvers.payoff import Payoff
from modefront.solvers.problem import Problem
from modefront.solvers.scalarisation import constrained
from modefront.solvers.sqp import Options, Solution, begin, solve
from modefront.work.task import IMMEDIATE, Executor, Task

GAIN = 1e-5
"""Fall of an objective, over itself, that is worth another model."""

VANISHING = 1e-5
"""An objective below this share of its range nearly vanishes: residuals of 3e-3 of theirs."""

SMALL = 1e-3
"""An objective below this share of its range may be curved so much that no step keeps it: where its
value cannot be held, its residuals are."""

_FEW, _MORE = Options(iterations=60), Options(iterations=120)


def without_slack(
    problem: Problem,
    target: Payoff,
    points: Sequence[Solution],
    work: Executor = IMMEDIATE,
    before: Sequence[Solution] = (),
) -> list[Solution]:
    """Return the points, those of the border with all other objectives as small as they can be.

    Points that were so ``before`` are left as they are.
    """
    known = {point.theta.tobytes() for point in before}
    doubtful = [
        k
        for k, point in enumerate(points)
        if point.theta.tobytes() not in known and _lowerable(target, point)
    ]
    tasks = [
        Task(("front", "nbi", "border", k + 1), _tightened, (problem, target, points[k]))
        for k in doubtful
    ]
    out = list(points)
    for k, point in zip(doubtful, work.run(tasks), strict=True):
        out[k] = point
    return out


def _free(target: Payoff, point: Solution) -> Bools:
    """Return which objectives (n,) no bound holds; none of a point that solves no programme."""
    if point.beta is None or not point.converged:
        return np.zeros(target.scale.size, dtype=np.bool_)
    active = active_bounds(point.weights * target.scale * target.Phi.sum(axis=1))
    return ~active if active.any() else np.zeros_like(active)


def _lowerable(target: Payoff, point: Solution) -> list[Bools]:
    """Return sets of objectives (n,) that may be lower at the same values of the others.

    These are the objectives that no bound holds, all and each; and each of the others beside one
    that nearly vanishes, which may hold the bound without any effect.
    """
    n = target.scale.size
    free = _free(target, point)
    sets = [free] if free.any() else []
    vanishing = VANISHING * target.scale >= point.J
    weak = point.beta is not None and point.feasible and vanishing.any()
    alone = free if free.sum() > 1 else np.zeros_like(free)
    if weak:
        alone = ~vanishing & ~free if free.sum() == 1 else ~vanishing
    return [*sets, *(np.arange(n) == i for i in np.flatnonzero(alone))]


def _tightened(problem: Problem, target: Payoff, point: Solution) -> Solution:
    """Return a point of the border with the objectives that no bound holds at their least."""
    J = point.J
    start = end = begin(problem.evaluate(point.theta))
    evaluations = point.evaluations + 1
    free, settled = _free(target, point), False  # where their sum is least, each of them is
    for lowered in _lowerable(target, point):
        if settled and np.array_equal(lowered & free, lowered):
            continue
        lower = _lowered(problem, target, replace(end, evaluations=0), lowered)
        evaluations += lower.evaluations
        settled |= (
            lower.converged
            and np.array_equal(lowered, free)
            and not _trades(target, lower.J, end.J)
        )
        if _is_better(target, lower.J, end.J):
            end = lower
    if end is start or not _is_better(target, end.J, J):
        return replace(point, evaluations=evaluations)
    beta = target.place(J) if point.beta is None else point.beta
    attainment = Attainment(target, np.zeros((0, J.size)))
    again = solve(problem, attainment.subproblem(beta), begin(end.evaluation))
    evaluations += again.evaluations
    best = again if again.converged and _is_better(target, again.J, end.J) else end
    weights = again.weights if best is again else point.weights
    status = point.status if best.converged else best.status
    return replace(best, weights=weights, status=status, evaluations=evaluations, beta=beta)


def _lowered(problem: Problem, target: Payoff, start: Solution, lowered: Bools) -> Solution:
    """Return the least sum of some objectives, the others held at their values.

    Where one of the others nearly vanishes, its slope says nothing of how to keep it: its residuals
    are held in its place (`modefront.solvers.lexicographic`). So they are where one is small and
    cannot be held otherwise.
    """
    J, scale = start.J, target.scale
    least = int(np.where(lowered, np.inf, J / scale).argmin())
    order = Lexicographic(least, scale)
    if start.evaluation.residuals and J[least] <= VANISHING * scale[least]:
        return (
            _around(problem, order, start, lowered, _FEW)
            if order.is_open(problem, start.evaluation)
            else start
        )
    held = np.eye(J.size)[~lowered] / scale
    programme = constrained(np.where(lowered, 1 / scale, 0.0), held, held @ J)
    end = solve(problem, programme, start, _FEW)
    small = J[least] <= SMALL * scale[least]
    if end.converged or not (small and order.is_open(problem, start.evaluation)):
        return end
    around = _around(problem, order, start, lowered, _MORE)
    return replace(around, evaluations=end.evaluations + around.evaluations)


def _around(
    problem: Problem, order: Lexicographic, start: Solution, lowered: Bools, options: Options
) -> Solution:
    """Return the least sum of some objectives around an exact fit of another one.

    At a given sum of squares, residuals along their multipliers are the best.
    """
    w, r = np.where(lowered, 1 / order.sizes, 0.0), start.evaluation.residuals[order.objective].r
    end, mu = order.lowered(problem, start, w, ~lowered, r, options)
    if not (end.converged and mu.any()):
        return end
    aim = mu * float(np.linalg.norm(r) / np.linalg.norm(mu))
    turned, _ = order.lowered(problem, end, w, ~lowered, aim, options)
    J, known = turned.J, end.J
    kept = J[~lowered] <= known[~lowered] + VANISHING * SAME * order.sizes[~lowered]
    better = turned.feasible and kept.all() and w @ J < w @ known
    return turned if better else replace(end, evaluations=turned.evaluations)


def _trades(target: Payoff, J: Floats, known: Floats) -> bool:
    """Return whether some objective is greater than a known one."""
    return bool((J - known > SAME * target.scale).any())


def _is_better(target: Payoff, J: Floats, known: Floats) -> bool:
    """Return whether objectives are nowhere greater than known ones and somewhere clearly less."""
    if not np.isfinite(J).all():
        return False
    unit = np.maximum(np.abs(known), np.finfo(float).tiny)
    loss, gain = ((J - known) / target.scale).max(), ((known - J) / unit).max()
    worth = ((known - J) / target.scale).max() > SAME
    return bool(loss <= SAME and gain > GAIN and worth)
