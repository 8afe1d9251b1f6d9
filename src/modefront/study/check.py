"""What can be said of a study before it is run."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from modefront._typing import Floats
from modefront.errors import ModelError
from modefront.identifiability import NONE, WEAK, combinations, in_words
from modefront.residuals.problem import UpdatingProblem
from modefront.study.file import Study

AGREEMENT = 1e-5
"""Greatest relative error of derivatives that finite differences explain."""


@dataclass(frozen=True)
class Findings:
    """The outcome of a check.

    Attributes
    ----------
    derivative_error : greatest difference of exact derivatives of the objectives from central
        differences at the nominal parameters, over the greatest derivative of the objective
    warnings : what a user should know before relying on the results
    """

    derivative_error: float
    warnings: tuple[str, ...]

    @property
    def sound(self) -> bool:
        """Whether the derivatives are as they should be."""
        return self.derivative_error <= AGREEMENT


def check(study: Study) -> Findings:
    """Compare derivatives with finite differences and look for what the data cannot determine."""
    problem = study.problem
    names = problem.model.parameters
    warnings = []
    for combination in combinations(problem, problem.start):
        if combination.share < WEAK:
            degree = "do not determine" if combination.share < NONE else "hardly determine"
            warnings.append(
                f"the data {degree} this combination of relative changes "
                f"({combination.share:.0e} of the best one): {in_words(combination, names)}"
            )
    at = problem.evaluate(problem.start)
    for r, coincident in zip(problem.data.modes, at.quantities["coincident"], strict=True):
        if coincident:
            warnings.append(
                f"mode {r} of the nominal model coincides with another one: "
                "its derivatives are not defined"
            )
    for r, value in zip(problem.data.modes, at.quantities["mac"], strict=True):
        if value < 0.5:
            warnings.append(
                f"measured mode {r} resembles no mode of the nominal model (best MAC {value:.2f})"
            )
    warnings += _corners(problem)
    return Findings(derivative_error(problem), tuple(warnings))


def derivative_error(problem: UpdatingProblem) -> float:
    """Return the greatest relative error of dJ against extrapolated central differences."""
    span = problem.upper - problem.lower
    theta = np.clip(problem.start, problem.lower + 0.01 * span, problem.upper - 0.01 * span)
    exact = problem.evaluate(theta).dJ

    def central(h: float) -> Floats:
        columns = []
        for step in np.diag(h * span):
            ahead = problem.evaluate(theta + step, derivatives=False).J
            behind = problem.evaluate(theta - step, derivatives=False).J
            columns.append((ahead - behind) / (2 * step.sum()))
        return np.array(columns).T

    h = 1e-3
    estimate = (4 * central(h / 2) - central(h)) / 3
    scale = np.abs(exact * span).max(axis=1, keepdims=True)
    error = np.abs((estimate - exact) * span) / np.where(scale > 0, scale, 1.0)
    return float(np.nanmax(error))


def _corners(problem: UpdatingProblem) -> list[str]:
    """Warn where the model has no modes at the bounds of all parameters at once."""
    out = []
    for name, theta in (("lower", problem.lower), ("upper", problem.upper)):
        try:
            problem.modes(theta, derivatives=False)
        except ModelError as error:
            out.append(f"at the {name} bounds of all parameters: {error}")
    return out
