r"""Weighted residuals, with weights that are given, equal, or optimal.

Optimal weights minimise :math:`I(\theta) = \sum_i a_i \ln J_i(\theta)`, equation (8), where
:math:`a_i` counts the measured properties of a group; the model then minimises
:math:`\sum_i w_i J_i` with :math:`w_i = a_i / J_i`. Where a group can be fitted exactly, I falls to
minus infinity there, which says nothing about the model: the minimum that is meant is the regular
one, at which every :math:`J_i` is positive.

The iteration :math:`w_i \leftarrow a_i / J_i(\arg\min \sum w_i J_i)` has the same stationary points
and serves as a check.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from modefront._typing import Floats
from modefront.solvers.explore import Descent, Search, explore
from modefront.solvers.lexicographic import EXACT
from modefront.solvers.problem import Problem
from modefront.solvers.scalarisation import LogSum, weighted
from modefront.solvers.sqp import Options, Solution, Status, solve

_TIGHT = Options(reduction=1e-17)


def regular(J: Floats, sizes: Floats) -> bool:
    """Return whether no objective is fitted exactly, compared with its typical size."""
    return bool((EXACT * sizes < J).all())


def optimal_minima(
    problem: Problem,
    a: Floats,
    sizes: Floats,
    rng: np.random.Generator,
    search: Search,
    starts: Sequence[Solution],
) -> list[Solution]:
    """Return minima of I: regular ones, best first, then those at which an objective vanishes.

    ``a`` (n,) counts the measured properties of each group, ``sizes`` (n,) are typical sizes of
    the objectives; ``starts`` are solved from first.
    """
    found = explore(problem, Descent(LogSum(a)), rng, search, starts=starts, options=_TIGHT)
    return sorted(found, key=lambda one: not regular(one.at.J, sizes))


def iterate_weights(
    problem: Problem, a: Floats, sizes: Floats, start: Solution, limit: int = 200
) -> Solution | None:
    """Return the fixed point of w = a / J, from a start; None where an objective vanishes.

    The status says whether successive models agree to the tolerance of the parameters.
    """
    options = Options()
    span = problem.upper - problem.lower
    evaluations = 0
    status = Status.EXHAUSTED
    for _ in range(limit):
        if not regular(start.at.J, sizes):
            return None
        w = a / start.at.J
        found = solve(problem, weighted(w / w.sum()), start, options)
        evaluations += found.evaluations
        moved = float(np.abs((found.at.theta - start.at.theta) / span).max())
        start = replace(found, weights=w)
        if moved <= options.step:
            status = found.status
            break
    return replace(start, status=status, evaluations=evaluations)
