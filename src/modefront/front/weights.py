r"""Weighted residuals, with weights that are given, equal, or optimal.

Optimal weights minimise :math:`I(\theta) = \sum_i a_i \ln J_i(\theta)`, equation (8), where
:math:`a_i` counts the measured properties of a group; the model then minimises
:math:`\sum_i w_i J_i` with :math:`w_i = a_i / J_i`. Where a group can be fitted exactly, I falls to
minus infinity there, which says nothing about the model: the minimum that is meant is the regular
one, at which every :math:`J_i` is positive. There may be none worth the name. A minimum is accepted
only if

* no objective vanishes at it,
* no known model dominates it, and
* I is nowhere less among the known regular models, which lie on the front or minimise the equally
  weighted residuals.

With more parameters than data, I often falls all the way along the front to the edge at which a
group is fitted exactly. Noise puts an end to that: a group cannot be known better than its data.
With :math:`b_i`, the objective that the errors of the data alone would cause, **bounded weights**
minimise

.. math:: \sum_i a_i \ln (J_i + b_i), \qquad w_i = \frac{a_i}{J_i + b_i} \le \frac{a_i}{b_i} .

The iteration :math:`w_i \leftarrow a_i / J_i(\arg\min \sum w_i J_i)` has the same stationary points
as I and serves as a check.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from modefront._typing import Floats
from modefront.front.dominance import undominated
from modefront.optim.lexicographic import EXACT, TIE
from modefront.optim.problem import Problem
from modefront.optim.scalarisation import LogSum, weighted
from modefront.optim.sqp import Options, Solution, Status, solve

WITHIN = 0.1
"""Tolerance of a model of the iteration of weights, over the length of the step before it."""

_TIGHT = Options(reduction=1e-17)
"""Steps end at the tolerance of the parameters, whatever f: a sum of logarithms has any size."""


def regular(J: Floats, sizes: Floats) -> bool:
    """Return whether no objective is fitted exactly, compared with its typical size."""
    return bool((EXACT * sizes < J).all())


def optimal_minimum(
    problem: Problem, a: Floats, sizes: Floats, floor: Floats | float, start: Solution
) -> Solution:
    """Return the minimum of I below a start, or where an objective vanishes on the way.

    ``a`` (n,) counts the measured properties of each group, ``sizes`` (n,) are typical sizes of
    the objectives. With a ``floor`` b (n,) the weights are bounded.
    """
    bounded = bool(np.any(np.asarray(floor) > 0))
    return solve(problem, LogSum(a, floor, 0.0 if bounded else EXACT * sizes), start, _TIGHT)


def accepted(
    minima: Sequence[Solution],
    a: Floats,
    sizes: Floats,
    rivals: Sequence[Solution],
    known: Floats,
    scale: Floats,
) -> list[Solution]:
    """Return the minima of I that are regular and worth the name, best first; see the module.

    ``rivals`` are models of the front and of weighted residuals, ``known`` (models, n) objectives
    of all models that were evaluated, ``scale`` (n,) the ranges of the objectives.
    """
    programme = LogSum(a)
    values = [programme.value(rival.J) for rival in rivals if regular(rival.J, sizes)]
    least = min(values, default=np.inf)
    out = [
        minimum
        for minimum in minima
        if regular(minimum.J, sizes)
        and programme.value(minimum.J) <= least + TIE * a.sum()
        and undominated(minimum.J[None], known, scale)[0]
    ]
    return sorted(out, key=lambda minimum: programme.value(minimum.J))


def least_along(points: Sequence[Solution], a: Floats, sizes: Floats) -> list[Solution]:
    """Return the points of a front in their order next to which I is greater, or not regular."""
    programme = LogSum(a)
    J = [point.J for point in points]
    values = [programme.value(row) if regular(row, sizes) else np.inf for row in J]
    padded = [np.inf, *values, np.inf]
    return [
        point
        for k, point in enumerate(points)
        if np.isfinite(values[k]) and values[k] <= min(padded[k], padded[k + 2])
    ]


def iterate_weights(
    problem: Problem, a: Floats, sizes: Floats, start: Solution, limit: int = 200
) -> Solution | None:
    """Return the fixed point of w = a / J, from a start; None where an objective vanishes.

    The status says whether successive models agree to the tolerance of the parameters. Each is
    solved for to a share of the step before it: the next weights move it by more than that.
    """
    options = Options()
    tolerance = WITHIN * options.radius
    span = problem.upper - problem.lower
    evaluations = 0
    status = Status.EXHAUSTED
    for _ in range(limit):
        if not regular(start.J, sizes):
            return None
        w = a / start.J
        solution = solve(problem, weighted(w / w.sum()), start, replace(options, step=tolerance))
        evaluations += solution.evaluations
        moved = float(np.abs((solution.theta - start.theta) / span).max())
        start = replace(solution, weights=w)
        if moved <= options.step and tolerance == options.step:
            status = solution.status
            break
        tolerance = max(options.step, WITHIN * (moved or tolerance))
    return replace(start, status=status, evaluations=evaluations)
