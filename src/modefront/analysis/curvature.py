"""Second derivatives of the objectives at a model, whatever the model knows of them.

The models of this package give them exactly. For a model that is a function of the user they are
differences of exact first derivatives, around the model or, next to a bound, as far within as the
step is long.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from modefront.optim.problem import Evaluation, ObjectiveDerivatives, Problem

STEP = 3e-4
"""Step of the differences, over the range of a parameter: balances their errors, 1e-7 by higher
derivatives and 3e-8 by an error of 1e-11 of the derivatives of a large eigenproblem."""


def with_second_order(problem: Problem, evaluation: Evaluation) -> Evaluation | None:
    """Return an evaluation with all second derivatives; None where differences are not defined.

    It takes no evaluation where these are known, one where the problem has them, and 2 p more where
    it has not.
    """
    if not evaluation.exact:
        known = problem.evaluate(evaluation.theta, second=True)
        evaluation = replace(known, quantities=evaluation.quantities)
    if evaluation.exact or not evaluation.feasible:
        return evaluation if evaluation.feasible else None
    step = STEP * (problem.upper - problem.lower)
    middle = np.clip(evaluation.theta, problem.lower + step, problem.upper - step)
    columns = []
    for h in np.diag(step):
        ahead, behind = (problem.evaluate(middle + side * h) for side in (1, -1))
        if not (ahead.feasible and behind.feasible):
            return None
        columns.append((ahead.dJ - behind.dJ) / (2 * h.sum()))
    H = np.stack(columns, axis=2)
    H = (H + H.transpose(0, 2, 1)) / 2
    return replace(evaluation, derivatives=ObjectiveDerivatives(evaluation.dJ, H, exact=True))
