r"""Second derivatives of objectives of which a problem does not give them.

Those of a model that is a function of the user are differences of exact first derivatives
(`with_second_order`), or are learned along the steps of a search (`learned_from`). Of
:math:`\partial^2 J = H + S`, with H known (Gauss-Newton's), a step s tells that

.. math:: S s = y, \qquad y = \partial J(\theta + s) - \partial J(\theta) - H(\theta + s)\, s .

The least symmetric change makes it so (Powell's; Dennis & Schnabel, *Numerical Methods for
Unconstrained Optimization*, 1983, section 9.2). Before, S is sized, as it vanishes with the
residuals (Dennis, Gay & Welsch 1981, doi:10.1145/355958.355965), unless H knows nothing.
"""

from dataclasses import replace

import numpy as np

from modefront._typing import Floats
from modefront.optim.problem import Evaluation, Problem

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
    return replace(evaluation, H=(H + H.transpose(0, 2, 1)) / 2, exact=True)


def learned_from(S: Floats, before: Evaluation, after: Evaluation) -> Floats:
    """Return S (n, p, p) with what the difference of two evaluations tells of it."""
    s = after.theta - before.theta
    if not s.any():
        return S
    y = after.dJ - before.dJ - after.H @ s
    claimed = np.abs(S @ s @ s)
    size = np.minimum(np.abs(y @ s), claimed) / np.where(claimed > 0, claimed, 1.0)
    size[~after.H.any(axis=(1, 2))] = 1.0
    S = size[:, None, None] * S
    v, u = y - S @ s, s / (s @ s)
    vu = v[:, :, None] * u
    return np.asarray(S + vu + vu.transpose(0, 2, 1) - (v @ s)[:, None, None] * np.outer(u, u))
