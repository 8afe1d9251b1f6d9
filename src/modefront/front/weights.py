"""Weighted residuals with optimal weights, equation (8) (`docs/methods/weighted.md`).

What is minimised is I, minus infinity where an objective is fitted exactly, compared with its
typical size. A minimum is accepted if it is regular itself, whatever is known of other models: I is
finite, and its second derivatives are positive in all directions in which residuals change and no
bound holds it.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from modefront.optim.problem import Evaluation, Problem, at_bounds
from modefront.optim.scalarisation import LogSum, weighted
from modefront.optim.sqp import Options, Solution, Status, solve

UNCHANGED = 1e-12  # eigenvalue over the greatest one below which a direction changes no residual


def accepted(problem: Problem, minima: Sequence[Solution], programme: LogSum) -> list[Solution]:
    """Return the minima of I that are regular, best first; see the module."""
    finite = [x for x in minima if np.isfinite(programme.value(x.J))]
    out = [x for x in finite if is_minimum(problem, x.evaluation, programme)]
    return sorted(out, key=lambda minimum: programme.value(minimum.J))


def is_minimum(problem: Problem, evaluation: Evaluation, programme: LogSum) -> bool:
    """Return whether I has positive second derivatives in all directions that residuals determine.

    ``evaluation`` has second derivatives; where only a part of these is known, that is not tested.
    """
    if not evaluation.exact:
        return True
    inside = at_bounds(evaluation.theta, problem.lower, problem.upper) == 0
    within = np.diag(problem.upper - problem.lower)[:, inside]
    J, dJ = evaluation.J, evaluation.dJ
    w = programme.gradient(J)
    lam, V = np.linalg.eigh(within.T @ np.tensordot(w, evaluation.gauss_newton, axes=1) @ within)
    Q = within @ V[:, lam > UNCHANGED * lam.max(initial=0.0)]
    second = np.tensordot(w, evaluation.H, axes=1) + dJ.T @ programme.hessian(J) @ dJ
    return bool((np.linalg.eigvalsh(Q.T @ second @ Q) > 0).all())


def least_along(points: Sequence[Solution], programme: LogSum) -> list[Solution]:
    """Return the points of a front in their order next to which I is greater, or not finite."""
    values = np.array([np.inf, *(programme.value(x.J) for x in points), np.inf])
    values[~np.isfinite(values)] = np.inf
    least = np.isfinite(values[1:-1]) & (values[1:-1] <= np.minimum(values[:-2], values[2:]))
    return [points[k] for k in np.flatnonzero(least).tolist()]


def iterate_weights(
    problem: Problem, programme: LogSum, start: Solution, limit: int = 200
) -> Solution | None:
    """Return the fixed point of w = a / J, from a start; None where an objective vanishes.

    The status says whether successive models agree to the tolerance of the parameters.
    """
    evaluations, status = 0, Status.EXHAUSTED
    for _ in range(limit):
        if not np.isfinite(programme.value(start.J)):
            return None
        w = programme.gradient(start.J)
        solution = solve(problem, weighted(w / w.sum()), start)
        evaluations += solution.evaluations
        moved = (solution.theta - start.theta) / (problem.upper - problem.lower)
        start = replace(solution, weights=w)
        if np.abs(moved).max() <= Options().step:
            status = solution.status
            break
    return replace(start, status=status, evaluations=evaluations)
