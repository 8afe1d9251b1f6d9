"""A front and its analysis as one dataset."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import xarray as xr

from modefront._typing import Bools, Floats
from modefront.analysis.certified import certificate_values
from modefront.analysis.front import FrontAnalysis
from modefront.front.dominance import nondominated, undominated
from modefront.front.front import Front
from modefront.front.gaps import branch_numbers
from modefront.front.methods import METHODS
from modefront.front.point import WEIGHTED, Kind, label
from modefront.optim.problem import at_bounds
from modefront.optim.sqp import Solution
from modefront.residuals.problem import UpdatingProblem
from modefront.results.analysis import Values, analysis_values, determinations
from modefront.results.findings import as_values, findings
from modefront.results.schema import FORMAT, described

ITERATED = "iterated-weights"
"""Name of the fixed point of the iteration of the weights, among the minima."""


def dataset(problem: UpdatingProblem, front: Front, analysis: FrontAnalysis) -> xr.Dataset:
    """Return a front and its analysis as a dataset with names, units and meanings."""
    front = replace(front, points=[*front.points, *analysis.points])
    values = _points(problem, front, analysis) | _minima(problem, front)
    values |= _branches(problem, front) | lattice_values(front)
    values["measured_frequency"] = problem.data.mean_frequency
    values["properties"], values["exact"] = problem.properties, list(front.exact)
    values["bounds"] = np.column_stack([problem.lower, problem.upper])
    determined = determinations(problem, front)
    values |= analysis_values(problem, front, analysis, determined)
    values |= as_values(findings(problem, front, analysis, determined))
    groups, parameters = list(problem.objectives), list(problem.model.parameters)
    return xr.Dataset(
        described(values),
        attrs={"format": FORMAT, "reference": front.reference.label},
        coords={
            "parameter": parameters,
            "group": groups,
            "mode": list(problem.data.modes),
            "bound": ["lower", "upper"],
            "parameter_other": parameters,
            "group_other": groups,
        },
    )


def _points(problem: UpdatingProblem, front: Front, analysis: FrontAnalysis) -> Values:
    points, n, modes = front.points, len(problem.objectives), len(problem.data.modes)
    solutions = [point.solution for point in points]
    theta, J = _theta_and_J(problem, solutions)
    a = problem.properties
    known = [x.J for _, manifolds in analysis.manifolds for each in manifolds for x in each.models]
    unknown = np.full(modes, np.nan)
    on = np.array([x.kind is Kind.FRONT for x in points])
    dominated = np.zeros(len(J), dtype=bool)
    if on.any():
        dominated[on] = ~nondominated(J[on], scale=front.scale)
    weights = _stack([x.weights for x in solutions], n)  # times the ranges of J, with sum 1
    weights = weights * (1.0 if front.scale is None else front.scale)
    total = weights.sum(axis=1, keepdims=True)
    shares = np.divide(weights, total, out=np.full(weights.shape, np.nan), where=total != 0)
    names = ("frequency", "mac", "paired_mode", "coincident")
    return {
        "label": [point.label for point in points],
        "kind": [point.kind.value for point in points],
        "pareto": _pareto(front, J, _stack(known, n)),
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
            name: _stack([x.evaluation.quantities.get(name, unknown) for x in solutions], modes)
            for name in names
        },
        **certificate_values(problem, solutions),
    }


def _minima(problem: UpdatingProblem, front: Front) -> Values:
    """Return all distinct minima of single objectives and of the optimally weighted residuals."""
    names = [*problem.objectives, label(Kind.OPTIMAL), ITERATED]
    minima = [*(edge.minima for edge in front.edges), front.optimal]
    minima.append([front.iterated] if front.iterated else [])
    solutions = [minimum for each in minima for minimum in each]
    theta, J = _theta_and_J(problem, solutions)
    return {
        "minimum_of": np.repeat(names, list(map(len, minima))),
        "minimum_theta": theta,
        "minimum_objective": J,
        "minimum_converged": [x.converged for x in solutions],
        **certificate_values(problem, solutions, "minimum_"),
    }


def _branches(problem: UpdatingProblem, front: Front) -> Values:
    if len(front.edges) != 2 or METHODS[front.method].programme != "boundary":
        return {}
    J = _theta_and_J(problem, [point.solution for point in front.points])[1]
    ends = [end for gap in front.gaps for end in (gap.end, gap.start)]
    theta, J_ends = _theta_and_J(problem, ends)
    names = [name for i in range(len(front.gaps)) for name in (f"end-{i + 1}", f"start-{i + 2}")]
    return {
        "piece": branch_numbers(J, nondominated(J), front.gaps),
        "end_label": names,
        "end_theta": theta,
        "end_objective": J_ends,
        "end_converged": np.array([x is not None for x in ends], dtype=bool),
    }


def lattice_values(front: Front) -> Values:
    """Return the lattice of normal-boundary intersection and the point that each place led to."""
    if not len(front.places):
        return {}
    labels = ["" if k < 0 else front.points[k].label for k in front.places]
    return {"lattice": front.lattice, "lattice_label": labels}


def _pareto(front: Front, J: Floats, others: Floats) -> Bools:
    """Return which points (points, n) no known model dominates; ``others`` (models, n) are known.

    All evaluated models are known, minima and ends of branches too. An end that another branch
    dominates at the same level counts for the points next to it only.
    """
    n = J.shape[1]
    minima = [solution.J for edge in front.edges for solution in edge.minima]
    minima += [solution.J for gap in front.gaps for solution in gap.ends]
    minima += [solution.J for solution in front.optimal]
    known = np.vstack([J, front.known.reshape(-1, n), _stack(minima, n), others])
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


def _stack(rows: Sequence[Floats], width: int) -> Floats:
    return np.array(rows, dtype=float).reshape(len(rows), width)


def _theta_and_J(
    problem: UpdatingProblem, solutions: Sequence[Solution | None]
) -> tuple[Floats, Floats]:
    """Return parameters (solutions, p) and objectives (solutions, n), NaN where there is none."""
    p, n = len(problem.model.parameters), len(problem.objectives)
    theta = [np.full(p, np.nan) if x is None else x.theta for x in solutions]
    J = [np.full(n, np.nan) if x is None else x.J for x in solutions]
    return _stack(theta, p), _stack(J, n)
