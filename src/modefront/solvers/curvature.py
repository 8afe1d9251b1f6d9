r"""Second derivatives, from differences of the exact first ones.

What is known with the first derivatives is only a part of the second ones (Gauss-Newton's). The
whole is

.. math:: H_{jk} = \frac{\partial}{\partial u_k} \frac{\partial J}{\partial u_j} \approx
    \frac{\partial J / \partial u_j (u + \eta e_k) - \partial J / \partial u_j (u - \eta e_k)}
         {2 \eta},

central differences, exact to :math:`O(\eta^2)`; next to a bound, of two points on the inner side,
to the same order. The quantities that come with evaluations are differentiated likewise, for
nothing.

========  =======  =======================================================
symbol    shape    meaning
========  =======  =======================================================
u         (p,)     parameters over their ranges
eta       ()       step of the differences, in u
e_k       (p,)     unit vector of the k-th parameter
========  =======  =======================================================
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from modefront._typing import Floats
from modefront.solvers.problem import Evaluation, Problem
from modefront.work.codec import record

STEP = 3e-4
"""Step of the differences, over the range of a parameter: balances their errors, eta**2 = 1e-7 and
1e-11 / eta = 3e-8 with the relative error of the derivatives of a large eigenproblem."""

ERROR = 1e-5
"""Second derivative over the greatest one below which it is the error of differences: a hundred
times that of `STEP`, as higher derivatives are greater than the second ones."""


@record
@dataclass(frozen=True)
class SecondOrder:
    """A point with all derivatives up to the second ones.

    Attributes
    ----------
    at : the evaluation, whose H is the known part
    H : (n, p, p) second derivatives of the objectives, symmetric
    slopes : derivatives (..., p) of the quantities of the evaluation
    """

    evaluation: Evaluation
    H: Floats
    slopes: Mapping[str, Floats]


def second_order(problem: Problem, evaluation: Evaluation) -> SecondOrder | None:
    """Return all second derivatives at an evaluation with first ones, by 2 p evaluations.

    None where the objectives are not defined around the point.
    """
    span = problem.upper - problem.lower
    columns, slopes = [], []
    for k, unit in enumerate(np.diag(span)):
        steps, weights = _stencil((evaluation.theta[k] - problem.lower[k]) / span[k])
        thetas = [np.clip(evaluation.theta + s * unit, problem.lower, problem.upper) for s in steps]
        around = [problem.evaluate(theta) for theta in thetas]
        if not all(neighbour.feasible for neighbour in around):
            return None
        points = [evaluation, *around]
        # Errors of a reduced basis, say, are known at the point alone.
        names = [name for name in evaluation.quantities if name in around[0].quantities]
        columns.append(sum(w * x.dJ for w, x in zip(weights, points, strict=True)) / span[k])
        slopes.append(
            {
                name: sum(w * x.quantities[name] for w, x in zip(weights, points, strict=True))
                / span[k]
                for name in names
            }
        )
    H = np.stack(columns, axis=2)
    named = {name: np.stack([slope[name] for slope in slopes], axis=-1) for name in names}
    return SecondOrder(evaluation, (H + H.transpose(0, 2, 1)) / 2, named)


def _stencil(u: float) -> tuple[list[float], list[float]]:
    """Return steps within the bounds and the weights of the point and of them."""
    if STEP <= u <= 1 - STEP:
        return [STEP, -STEP], [0.0, 1 / (2 * STEP), -1 / (2 * STEP)]
    inward = STEP if u < STEP else -STEP
    return [inward, 2 * inward], [-3 / (2 * inward), 2 / inward, -1 / (2 * inward)]
