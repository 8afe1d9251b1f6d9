"""Weighted residuals with optimal weights, equation (8) (`docs/methods/weighted.md`).

A minimum is accepted if it is regular itself, whatever is known of other models: no objective
vanishes at it, and the second derivatives are positive in all directions in which residuals change
and no bound holds it.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from modefront._typing import Floats
from modefront.optim.lexicographic import EXACT
from modefront.optim.problem import AT_BOUND, Evaluation, Problem
from modefront.optim.scalarisation import LogSum, weighted
from modefront.optim.sqp import Options, Solution, Status, solve

UNCHANGED = 1e-12  # eigenvalue over the greatest one below which a direction changes no residual


def regular(J: Floats, sizes: Floats) -> bool:
    """Return whether no objective is fitted exactly, compared with its typical size."""
    return bool((EXACT * sizes < J).all())


def accepted(
    problem: Problem, minima: Sequence[Solution], a: Floats, sizes: Floats
) -> list[Solution]:
    """Return the minima of I that are regular, best first; see the module."""
    out = [x for x in minima if regular(x.J, sizes) and is_minimum(problem, x.evaluation, a)]
    return sorted(out, key=lambda minimum: LogSum(a).value(minimum.J))


def is_minimum(problem: Problem, evaluation: Evaluation, a: Floats) -> bool:
    """Return whether I has positive second derivatives in all directions that residuals determine.

    ``evaluation`` has second derivatives; where only a part of these is known, that is not tested.
    """
    if not evaluation.exact:
        return True
    span = problem.upper - problem.lower
    u = (evaluation.theta - problem.lower) / span
    within = np.diag(span)[:, (u > AT_BOUND) & (u < 1 - AT_BOUND)]
    w = a / evaluation.J
    lam, V = np.linalg.eigh(within.T @ np.tensordot(w, evaluation.gauss_newton, axes=1) @ within)
    Q = within @ V[:, lam > UNCHANGED * lam.max(initial=0.0)]
    second = np.tensordot(w, evaluation.H, axes=1) - evaluation.dJ.T @ (
        (a / evaluation.J**2)[:, None] * evaluation.dJ
    )
    return bool((np.linalg.eigvalsh(Q.T @ second @ Q) > 0).all())


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

    The status says whether successive models agree to the tolerance of the parameters.
    """
    options = Options()
    evaluations, status = 0, Status.EXHAUSTED
    for _ in range(limit):
        if not regular(start.J, sizes):
            return None
        w = a / start.J
        solution = solve(problem, weighted(w / w.sum()), start, options)
        evaluations += solution.evaluations
        moved = (solution.theta - start.theta) / (problem.upper - problem.lower)
        start = replace(solution, weights=w)
        if np.abs(moved).max() <= options.step:
            status = solution.status
            break
    return replace(start, status=status, evaluations=evaluations)
