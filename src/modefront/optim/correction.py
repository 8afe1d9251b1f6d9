r"""Second-order corrections: a second step that undoes how residuals bend along the first one.

Where parameters outnumber data, minima lie in valleys that bend, and a step along the valley ends
on its slope: residuals change by :math:`\tfrac12 s^T \partial^2 r\, s`, which no step of any length
worth making survives. With the derivatives at the end of the step, the shortest second step brings
the residuals to what the first one had predicted,

.. math:: \partial r(\theta + s)\, s_2 = r(\theta) + \partial r(\theta)\, s - r(\theta + s) ,

in the least-squares sense: the residuals of each objective times the root of its weight, and with
them the rows E J that are to be met, times the root of their penalty (Nocedal & Wright, *Numerical
Optimization*, 2006, section 15.6, where it is for constraints alone).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from modefront._typing import Floats
from modefront.optim.merit import Merit
from modefront.optim.problem import Evaluation, Problem, Residual

CUT = 1e-4
"""Least singular value of the rows, over the greatest, along which is corrected: a row that hardly
depends on the parameters would ask for a long step."""


@dataclass(frozen=True)
class Correction:
    """The correction of steps that one merit judges.

    The rows E (k, n), combinations of objectives, are to be met beside the residuals.
    """

    merit: Merit
    E: Floats

    def evaluated(
        self, problem: Problem, evaluation: Evaluation, s: Floats, new: Evaluation
    ) -> Evaluation | None:
        """Return the end of the step with its correction; None where it is no better.

        ``new`` is the end of the step s (p,) from ``at``, which is over the ranges of the
        parameters.
        """
        theta = self.corrected(problem, evaluation, s, new)
        corrected = None if theta is None else problem.evaluate(theta, second=True)
        return corrected if corrected and self.merit.at(corrected) < self.merit.at(new) else None

    def corrected(
        self, problem: Problem, evaluation: Evaluation, s: Floats, new: Evaluation
    ) -> Floats | None:
        """Return parameters within the bounds, at which the rows are as predicted for the step.

        The correction is the shortest one; None where it is longer than the step, of which nothing
        follows then.
        """
        span = problem.upper - problem.lower
        w = self.merit.multipliers.weights(self.merit.programme, evaluation.J)
        before, after = self._rows(w, evaluation, span), self._rows(w, new, span)
        miss = after.r - (before.r + before.dr @ s)
        taken = (new.theta - evaluation.theta) / span
        free = (new.theta > problem.lower) & (new.theta < problem.upper)
        free |= np.abs(s) == 0
        step = np.zeros(s.size)
        step[free] = np.linalg.lstsq(after.dr[:, free], -miss, rcond=CUT)[0]
        if not miss.size or np.abs(step).max() > np.abs(taken).max():
            return None
        return np.clip(new.theta + step * span, problem.lower, problem.upper)

    def _rows(self, w: Floats, evaluation: Evaluation, span: Floats) -> Residual:
        """Return the residuals and the rows to be met, with their slopes in u."""
        roots, hold = np.sqrt(np.maximum(w, 0.0)).tolist(), np.sqrt(self.merit.penalty)
        pairs = list(zip(roots, evaluation.residuals, strict=False))  # none of other objectives
        return Residual(
            np.concatenate([*(x * of.r for x, of in pairs), hold * (self.E @ evaluation.J)]),
            np.vstack([*(x * of.dr for x, of in pairs), hold * (self.E @ evaluation.dJ)]) * span,
        )
