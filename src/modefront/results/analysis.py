"""The analysis of a front as values of results."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from modefront._typing import Bools, Floats
from modefront.analysis.front import FrontAnalysis
from modefront.front.front import Front
from modefront.front.methods import METHODS
from modefront.front.point import Kind, Point, of_kind
from modefront.identifiability.collinearity import cosines, index
from modefront.identifiability.combinations import (
    Combination,
    combinations_at,
    gram,
    optimal_weights,
    without_effect,
)
from modefront.identifiability.scale import Scale, scale_at
from modefront.optim.sqp import Solution
from modefront.residuals.problem import UpdatingProblem
from modefront.rounding import TINY
from modefront.uncertainty.prediction import linear
from modefront.uncertainty.validity import std

Values = dict[str, object]
"""Values of variables by name; `modefront.results.schema` describes them."""

PART = 1e-9
"""Component of a direction over the greatest that is rounding of its basis."""

ALL = "all data"
"""Name of all groups together."""


@dataclass(frozen=True)
class Determination:
    """Combinations of parameters that the data determine at a point.

    Attributes
    ----------
    point : the point
    scale : units of the parameters there
    idle : positions of parameters without effect
    combinations : of each group, then of all data, by name
    effects : (p, p) products of the effects of the parameters on all weighted residuals
    """

    point: Point
    scale: Scale
    idle: list[int]
    combinations: Sequence[tuple[str, Sequence[Combination]]]
    effects: Floats


def determinations(problem: UpdatingProblem, front: Front) -> list[Determination]:
    """Return the determined combinations of parameters at the reference, then at each edge."""
    groups = problem.groups
    out = []
    for point in [front.reference, *of_kind(front.points, Kind.EDGE)]:
        evaluation = point.solution.evaluation
        weights = optimal_weights(problem.properties, evaluation.J)
        scale = scale_at(problem, evaluation.theta)
        idle = without_effect(problem, evaluation, scale)
        combinations = [
            (group.name, combinations_at(problem, evaluation, i, weights, scale))
            for i, group in enumerate(groups)
        ]
        if len(groups) > 1:
            combinations.append((ALL, combinations_at(problem, evaluation, None, weights, scale)))
        effects = gram(evaluation, weights, scale)
        effects[idle] = effects[:, idle] = 0.0
        out.append(Determination(point, scale, idle, combinations, effects))
    return out


def analysis_values(
    problem: UpdatingProblem,
    front: Front,
    analysis: FrontAnalysis,
    determined: Sequence[Determination],
) -> Values:
    """Return the values; ``front`` holds all points, those of ``analysis`` too."""
    return {
        **_identifiability(determined),
        **_flat(problem, front, analysis),
        **_equivalent(problem, analysis),
        **_scatter(problem, front, analysis),
        **_posterior(front, analysis),
        **_replicates(problem, front, analysis),
    }


def _identifiability(determined: Sequence[Determination]) -> Values:
    rows = [
        (each.point.label, name, combination, each.scale.unit)
        for each in determined
        for name, combinations in each.combinations
        for combination in combinations
    ]
    effects = determined[0].effects
    active = [j for j in range(len(effects)) if effects[j, j] > 0]
    return {
        "combination_at": [row[0] for row in rows],
        "combination_of": [row[1] for row in rows],
        "combination_direction": np.array([row[2].direction for row in rows]),
        "combination_unit": np.array([row[3] for row in rows]),
        "combination_sensitivity": [row[2].sensitivity for row in rows],
        "combination_share": [row[2].share for row in rows],
        "collinearity": cosines(effects),
        "collinearity_index": index(effects, active) if active else np.nan,
    }


def _flat(problem: UpdatingProblem, front: Front, analysis: FrontAnalysis) -> Values:
    boundary = METHODS[front.method].programme == "boundary"
    parts = {Kind.FRONT: "whole" if boundary else ""}
    parts |= dict.fromkeys((Kind.IDENTIFIABLE, Kind.IDENTIFIABLE_EDGE), "identifiable")
    part = analysis.identifiable
    return {
        "front_part": [parts.get(point.kind, "") for point in front.points],
        "flat": part.flat if part else np.zeros(len(problem.objectives), dtype=int),
    }


def _equivalent(problem: UpdatingProblem, analysis: FrontAnalysis) -> Values:
    rows = [
        (name, number, manifold, model)
        for name, manifolds in analysis.manifolds
        for number, manifold in enumerate(manifolds, start=1)
        for model in manifold.models
    ]
    p, n = len(problem.model.parameters), len(problem.objectives)
    return {
        "equal_of": [row[0] for row in rows],
        "equal_manifold": np.array([row[1] for row in rows], dtype=int),
        "equal_dimension": np.array([row[2].dimension for row in rows], dtype=int),
        "equal_extent": [row[2].extent.name.lower() for row in rows],
        "equal_theta": np.array([row[3].theta for row in rows]).reshape(-1, p),
        "equal_objective": np.array([row[3].J for row in rows]).reshape(-1, n),
    }


def _scatter(problem: UpdatingProblem, front: Front, analysis: FrontAnalysis) -> Values:
    if analysis.source is None:
        return {}
    labels = [point.label for point in front.points]
    m, n, p = len(labels), len(problem.objectives), len(problem.model.parameters)
    r = len(problem.data.modes)
    theta, J = np.full((m, p, p), np.nan), np.full((m, n, n), np.nan)
    theta_std = np.full((m, p), np.nan)
    predicted = {name: np.full((m, r), np.nan) for name in ("frequency", "mac")}
    warned = [""] * m
    for i, name in enumerate(labels):
        scatter = analysis.scatter.get(name)
        if scatter is None:
            continue
        theta[i], J[i] = scatter.covariance, scatter.J.T @ scatter.J
        theta_std[i] = _std(scatter.covariance, scatter.free)
        warned[i] = ", ".join(warning.name.lower() for warning in scatter.warnings)
        slopes = analysis.slopes.get(name)
        if slopes is not None:
            for quantity, values in predicted.items():
                values[i] = std(scatter.theta @ slopes[quantity].T)
    return {
        "theta_std": theta_std,
        "theta_covariance": theta,
        "objective_std": np.sqrt(np.einsum("mii->mi", J)),
        "objective_covariance": J,
        "frequency_std": predicted["frequency"],
        "mac_std": predicted["mac"],
        "scatter_doubt": warned,
    }


def _std(covariance: Floats, free: Floats) -> Floats:
    """Return standard deviations, infinite for parameters that have a part in what is free."""
    return np.where(left_open(free), np.inf, np.sqrt(np.diag(covariance)))


def left_open(free: Floats) -> Bools:
    """Return the parameters that have a part in directions (p, d)."""
    out: Bools = (np.abs(free) > PART * np.abs(free).max(initial=TINY)).any(axis=1)
    return out


def _posterior(front: Front, analysis: FrontAnalysis) -> Values:
    posterior = analysis.posterior
    if posterior is None:
        return {}
    slopes = analysis.slopes[front.reference.label]
    return {
        "posterior_std": _std(posterior.covariance, posterior.free),
        "posterior_covariance": posterior.covariance,
        "posterior_frequency_std": _roots(linear(posterior.covariance, slopes["frequency"])),
        "posterior_mac_std": _roots(linear(posterior.covariance, slopes["mac"])),
    }


def _roots(covariance: Floats) -> Floats:
    """Return standard deviations; rounding may leave a variance below 0."""
    return np.sqrt(np.maximum(np.diag(covariance), 0.0))


def _replicates(problem: UpdatingProblem, front: Front, analysis: FrontAnalysis) -> Values:
    if not analysis.replicates:
        return {}
    p, n = len(problem.model.parameters), len(problem.objectives)
    solutions = [[each.get(x.label) for x in front.points] for each in analysis.replicates]
    theta = _stacked(solutions, p, lambda solution: solution.theta)
    J = _stacked(solutions, n, lambda solution: solution.J)
    return {
        "bootstrap_theta": theta,
        "bootstrap_objective": J,
        "bootstrap_theta_std": _spread(theta),
        "bootstrap_objective_std": _spread(J),
    }


def _stacked(
    rows: Sequence[Sequence[Solution | None]], width: int, of: Callable[[Solution], Floats]
) -> Floats:
    """Return values (replicates, points, width), NaN where a solution did not converge."""
    nothing = np.full(width, np.nan)
    return np.array([[of(x) if x and x.converged else nothing for x in row] for row in rows])


def _spread(values: Floats) -> Floats:
    """Return the standard deviation over the first dimension of what is there; NaN below two."""
    known = np.isfinite(values)
    count = known.sum(axis=0)
    mean = np.where(known, values, 0.0).sum(axis=0) / np.maximum(count, 1)
    square = np.where(known, (values - mean) ** 2, 0.0).sum(axis=0)
    return np.where(count > 1, np.sqrt(square / np.maximum(count - 1, 1)), np.nan)
