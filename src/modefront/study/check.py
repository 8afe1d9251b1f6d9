"""What can be said of a study before it is run."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from modefront._typing import Floats
from modefront.errors import ModelError
from modefront.identifiability.collinearity import pairs
from modefront.identifiability.combinations import (
    NONE,
    WEAK,
    combinations,
    optimal_weights,
    relative_unit,
)
from modefront.identifiability.words import in_words, measured_thing, summary
from modefront.models.reduced.model import ReducedModel
from modefront.residuals.problem import UpdatingProblem
from modefront.study.file import Study

AGREEMENT = 1e-5
"""Greatest relative error of derivatives that finite differences explain."""

STEP = 4e-3
"""Change of the residuals, in their own units, that a finite difference makes."""


@dataclass(frozen=True)
class Findings:
    """The outcome of a check.

    Attributes
    ----------
    derivative_error : greatest difference of exact derivatives of the objectives from central
        differences near the nominal parameters, over the greatest derivative of the objective;
        NaN where the model is not defined around them
    determined : which combinations of parameters each group and all of them determine
    warnings : what a user should know before relying on the results
    """

    derivative_error: float
    determined: tuple[str, ...]
    warnings: tuple[str, ...]

    @property
    def sound(self) -> bool:
        """Whether the derivatives are as they should be."""
        return self.derivative_error <= AGREEMENT


def check(study: Study) -> Findings:
    """Compare derivatives with finite differences and look for what the data cannot determine."""
    problem = study.problem
    at = problem.evaluate(problem.start)
    warnings = _undetermined(problem, optimal_weights(problem.properties, at.J))
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
    for name, value, *bounds in zip(
        problem.model.parameters, problem.start, problem.lower, problem.upper, strict=True
    ):
        if value in bounds:
            warnings.append(f"the nominal value of {name} is one of its bounds, {value:g}")
    warnings += _corners(problem)
    return Findings(derivative_error(problem), determined(problem), tuple(warnings))


def determined(problem: UpdatingProblem) -> tuple[str, ...]:
    """Return what each group, and all together, determine at the nominal parameters."""
    names, groups = problem.model.parameters, problem.groups
    J = problem.evaluate(problem.start).J
    out = [
        summary(group.name, measured_thing([group]), combinations(problem, problem.start, i), names)
        for i, group in enumerate(groups)
    ]
    if len(groups) > 1:
        weights = optimal_weights(problem.properties, J)
        found = combinations(problem, problem.start, weights=weights)
        out.append(summary("all data together", measured_thing(groups), found, names))
    return tuple(out)


def _undetermined(problem: UpdatingProblem, weights: Floats) -> list[str]:
    """Warn of combinations that all data together do not determine, and of parameters alike."""
    names = problem.model.parameters
    out = []
    for combination in combinations(problem, problem.start, weights=weights):
        if combination.share < WEAK:
            degree = "do not determine" if combination.share <= NONE else "hardly determine"
            out.append(
                f"the data {degree} this combination of relative changes "
                f"({combination.share:.0e} of the best one): {in_words(combination, names)}"
            )
    H = np.tensordot(weights, problem.evaluate(problem.start).H, axes=1) / 2
    unit = relative_unit(problem, problem.start)
    for i, j, index in pairs(H * np.outer(unit, unit)):
        out.append(
            f"{names[i]} and {names[j]} act nearly alike on the residuals "
            f"(collinearity index {index:.2g})"
        )
    return out


def derivative_error(problem: UpdatingProblem) -> float:
    """Return the greatest relative error of dJ against extrapolated central differences.

    A step changes the residuals by a given small amount, whatever the bounds are: steps that
    follow narrow bounds would drown in rounding, and those that follow wide ones see no tangent.
    Where bounds leave no room for a step, it leaves them.
    """
    span = problem.upper - problem.lower
    size = np.sqrt(np.einsum("ijj->j", problem.evaluate(problem.start).H) / 2)
    unit = np.divide(1.0, size, out=span.copy(), where=size > 0)
    room = np.minimum(STEP * unit, span / 2)
    theta = np.clip(problem.start, problem.lower + room, problem.upper - room)
    exact = problem.evaluate(theta).dJ

    def central(h: float) -> Floats:
        columns = []
        for step in np.diag(h * unit):
            ahead = problem.evaluate(theta + step, derivatives=False).J
            behind = problem.evaluate(theta - step, derivatives=False).J
            columns.append((ahead - behind) / (2 * step.sum()))
        return np.array(columns).T

    estimate = (4 * central(STEP / 2) - central(STEP)) / 3
    scale = np.abs(exact * unit).max(axis=1, keepdims=True)
    error = np.abs((estimate - exact) * unit) / np.where(scale > 0, scale, 1.0)
    return float(error.max())


def _corners(problem: UpdatingProblem) -> list[str]:
    """Warn where the model has no modes at the bounds of all parameters at once.

    It is the full model that is asked: a basis may not hold what makes a matrix indefinite.
    """
    if isinstance(problem.model, ReducedModel):
        problem = replace(problem, model=problem.model.full)
    out = []
    for name, theta in (("lower", problem.lower), ("upper", problem.upper)):
        try:
            problem.modes(theta, derivatives=False)
        except ModelError as error:
            out.append(f"at the {name} bounds of all parameters: {error}")
    return out
