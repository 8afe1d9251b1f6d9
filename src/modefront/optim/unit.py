r"""The coordinates of the local solver: parameters as u in the unit box.

A parameter of which the first guess lies nearer to the geometric mean of its bounds than to their
arithmetic one is a factor, and its logarithm is what is moved: eigenvalues and what follows from
them are homogeneous functions of factors of stiffness and mass. With
:math:`L = \ln(upper / lower)`

.. math:: \theta = lower\, e^{L u} \quad\text{or}\quad lower + (upper - lower)\, u .
"""

from dataclasses import dataclass, replace

import numpy as np

from modefront._typing import Floats
from modefront.optim.problem import Evaluation, Problem, Residual


@dataclass
class UnitBox:
    """A problem in u; see the module."""

    problem: Problem

    def __post_init__(self) -> None:
        lower, upper = self.problem.lower, self.problem.upper
        self.span = upper - lower
        means = np.sqrt(np.maximum(lower * upper, 0.0)) + (lower + upper) / 2
        self.factor = (lower > 0) & (2 * self.problem.start < means)
        self.L = np.log(np.divide(upper, lower, out=np.ones(lower.size), where=self.factor))

    def inside(self, evaluation: Evaluation) -> Evaluation:
        """Return an evaluation with derivatives with respect to u."""
        theta, lower, factor = evaluation.theta, self.problem.lower, self.factor
        u = (theta - lower) / self.span
        u[factor] = np.log(theta[factor] / lower[factor]) / self.L[factor]
        slope = np.where(factor, self.L * theta, self.span)
        H = evaluation.H * (slope[:, None] * slope)
        rows = np.arange(theta.size)
        H[:, rows, rows] += evaluation.dJ * (self.L * slope)
        residuals = [Residual(x.r, x.dr * slope) for x in evaluation.residuals]
        return replace(evaluation, theta=u, dJ=evaluation.dJ * slope, H=H, residuals=residuals)

    def after(self, theta: Floats, s: Floats) -> Floats:
        """Return the parameters after a step s in u, within the bounds."""
        new = np.where(self.factor, theta * np.exp(self.L * s), theta + self.span * s)
        return np.minimum(np.maximum(new, self.problem.lower), self.problem.upper)
