r"""What a model promises a subproblem, by its own derivatives.

A step of the local solver from a model, which minimises the quadratic model of the subproblem's
programme within a trust region, leads to

.. math:: J + \partial J\, s + \tfrac12 s^T H s ,

and residuals change to :math:`r + \partial r\, s`. The greater of both is what the model promises:
how good that is in the order of the subproblem is known without any evaluation.
"""

from __future__ import annotations

import numpy as np

from modefront._typing import Floats
from modefront.front.subproblems import Subproblem
from modefront.linalg.small import lstsq
from modefront.optim.linearised import linearised
from modefront.optim.problem import Evaluation, Problem

REACH = 0.3
"""Trust region of a prediction, over the ranges of the parameters."""


def promised(problem: Problem, subproblem: Subproblem, evaluation: Evaluation) -> Floats:
    """Return the objectives (n,) that one step from a model leads to, or its own if better."""
    local = linearised(problem, subproblem.programme, evaluation)
    _, step, _ = local.step(evaluation.H, REACH, None)
    change = step.s * local.span
    J = evaluation.J + evaluation.dJ @ change + 0.5 * (evaluation.H @ change @ change)
    squares = [np.sum((each.r + each.dr @ change) ** 2) for each in evaluation.residuals]
    J = np.maximum(J, squares or 0.0)
    return J if subproblem.value(J) < subproblem.value(evaluation.J) else evaluation.J


def is_hopeless(evaluation: Evaluation, w: Floats, level: float) -> bool:
    """Return whether w^T J of residuals that change linearly is above a level wherever it goes."""
    if not evaluation.residuals or (w < 0).any():
        return False
    roots = np.sqrt(w)
    r = np.concatenate([root * x.r for root, x in zip(roots, evaluation.residuals, strict=True)])
    dr = np.vstack([root * x.dr for root, x in zip(roots, evaluation.residuals, strict=True)])
    least = r - dr @ lstsq(dr, r)
    return bool(least @ least > level)
