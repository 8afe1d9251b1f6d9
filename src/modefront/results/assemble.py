"""A front and its analysis as one dataset."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from modefront._typing import Bools, Floats
from modefront.analysis.certified import certificate_values
from modefront.analysis.front import FrontAnalysis
from modefront.datasets import ArrayDataset
from modefront.front.dominance import nondominated, undominated
from modefront.front.front import Front
from modefront.front.gaps import branch_numbers
from modefront.front.methods import METHODS
from modefront.front.point import WEIGHTED, Kind, label
from modefront.optim.problem import at_bounds
from modefront.residuals.problem import UpdatingProblem
from modefront.results.analysis import Values, analysis_values, determinations
from modefront.results.findings import as_values, findings
from modefront.results.schema import FORMAT, described

ITERATED = "iterated-weights"
"""Name of the fixed point of the iteration of the weights, among the minima."""


def dataset(problem: UpdatingProblem, front: Front, analysis: FrontAnalysis) -> ArrayDataset:
    """Return a front and its analysis as a dataset with names, units and meanings."""
    front = replace(front, points=[*front.points, *analysis.points])
    determined = determinations(problem, front)
    values = _points(problem, front, analysis) | _minima(problem, front)
    values |= _branches(problem, front) | lattice_values(front)
    values |= analysis_values(problem, front, analysis, determined)
    values |= as_values(findings(problem, front, analysis, determined))
    values["measured_frequency"] = problem.data.mean_frequency
    values["properties"], values["exact"] = problem.properties, list(front.exact)
    values["bounds"] = np.column_stack([problem.lower, problem.upper])
    groups, parameters = list(problem.objectives), list(problem.model.parameters)
    coordinates: dict[str, Any] = {
        "parameter": parameters,
        "group": groups,
        "mode": list(problem.data.modes),
        "bound": ["lower", "upper"],
        "parameter_other": parameters,
        "group_other": groups,
    }
    sizes = {name: len(of) for name, of in coordinates.items()}
    attributes = {"format": FORMAT, "reference": front.reference.label}
    return ArrayDataset(described(values, sizes=sizes), attributes).assign_coords(coordinates)


def _points(problem: UpdatingProblem, front: Front, analysis: FrontAnalysis) -> Values:
    points, a = front.points, problem.properties
    solutions = [point.solution for point in points]
    theta, J = np.array([x.theta for x in solutions]), np.array([x.J for x in solutions])
    unknown = np.full(len(problem.data.modes), np.nan)
    on = np.array([x.kind is Kind.FRONT for x in points])
    dominated = np.zeros(len(J), dtype=bool)
    if on.any():
        dominated[on] = ~nondominated(J[on], scale=front.scale)
    # Weights times the ranges of J, with sum 1.
    weights = np.array([x.weights for x in solutions], dtype=float).reshape(J.shape)
    weights = weights * (1.0 if front.scale is None else front.scale)
    total = weights.sum(axis=1, keepdims=True)
    shares = np.divide(weights, total, out=np.full(weights.shape, np.nan), where=total != 0)
    return {
        "label": [point.label for point in points],
        "kind": [point.kind.value for point in points],
        "pareto": _pareto(front, analysis, J),
        "dominated_among_front": dominated,
        "theta": theta,
        "objective": J,
        "error": np.sqrt(J / a),
        "weight": _weights(front, J, a),
        "stationary_weight": shares,
        "converged": [x.converged for x in solutions],
        "status": [x.status.name.lower() for x in solutions],
        "evaluations": [x.evaluations for x in solutions],
        "at_bound": at_bounds(theta, problem.lower, problem.upper),
        **{
            name: np.array([x.evaluation.quantities.get(name, unknown) for x in solutions], float)
            for name in ("frequency", "mac", "paired_mode", "coincident")
        },
        **certificate_values(problem, solutions),
    }


def _minima(problem: UpdatingProblem, front: Front) -> Values:
    """Return all distinct minima of single objectives and of the optimally weighted residuals."""
    names = [*problem.objectives, label(Kind.OPTIMAL), ITERATED]
    minima = [*(edge.minima for edge in front.edges), front.optimal]
    minima.append([front.iterated] if front.iterated else [])
    solutions = [minimum for each in minima for minimum in each]
    return {
        "minimum_of": np.repeat(names, list(map(len, minima))),
        "minimum_theta": [x.theta for x in solutions],
        "minimum_objective": [x.J for x in solutions],
        "minimum_converged": [x.converged for x in solutions],
        **certificate_values(problem, solutions, "minimum_"),
    }


def _branches(problem: UpdatingProblem, front: Front) -> Values:
    if len(front.edges) != 2 or METHODS[front.method].programme != "boundary":
        return {}
    J = np.array([point.solution.J for point in front.points])
    ends = [end for gap in front.gaps for end in (gap.end, gap.start)]
    unknown = np.full(len(problem.model.parameters), np.nan), np.full(2, np.nan)
    return {
        "piece": branch_numbers(J, nondominated(J), front.gaps),
        "end_label": [
            f"{x}-{i}"
            for i in range(1, len(front.gaps) + 1)
            for x, i in (("end", i), ("start", i + 1))
        ],
        "end_theta": [x.theta if x else unknown[0] for x in ends],
        "end_objective": [x.J if x else unknown[1] for x in ends],
        "end_converged": [x is not None for x in ends],
    }


def lattice_values(front: Front) -> Values:
    """Return the lattice of normal-boundary intersection and the point that each place led to."""
    if not len(front.places):
        return {}
    labels = ["" if k < 0 else front.points[k].label for k in front.places]
    return {"lattice": front.lattice, "lattice_label": labels}


def _pareto(front: Front, analysis: FrontAnalysis, J: Floats) -> Bools:
    """Return which points (points, n) no known model dominates.

    All evaluated models are known, minima, ends of branches and equivalent models too. An end that
    another branch dominates at the same level counts for the points next to it only.
    """
    minima = [x.J for edge in front.edges for x in edge.minima]
    minima += [x.J for gap in front.gaps for x in gap.ends]
    minima += [x.J for x in front.optimal]
    equal = [x.J for _, manifolds in analysis.manifolds for each in manifolds for x in each.models]
    known = np.vstack([J, front.known.reshape(-1, J.shape[1]), *minima, *equal])
    # Of a front that is a point, the ranges over models as good as each other are rounding.
    return undominated(J, known, front.sizes if front.scale is None else front.scale)


def _weights(front: Front, J: Floats, a: Floats) -> Floats:
    """Return the weights (points, n) that weighted methods used; NaN at other points."""
    out = np.full(J.shape, np.nan)
    swept = METHODS[front.method].programme == "weights"
    for i, point in enumerate(front.points):
        if point.kind is Kind.OPTIMAL:
            out[i] = a / J[i]
        elif point.kind in WEIGHTED or (point.kind is Kind.FRONT and swept):
            out[i] = point.solution.weights
    return out
