"""Results as one dataset, in memory and in a netCDF file."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import xarray as xr

from modefront._typing import Bools, Floats, Ints
from modefront.analysis.certified import certificate_variables
from modefront.analysis.front import FrontAnalysis
from modefront.errors import Fault, InputError
from modefront.fronts.front import Front
from modefront.fronts.methods import METHODS
from modefront.fronts.point import WEIGHTED, Kind, label
from modefront.residuals.problem import UpdatingProblem
from modefront.solvers.dominance import nondominated, undominated
from modefront.solvers.pieces import piece_numbers
from modefront.solvers.sqp import Solution
from modefront.study.analysis_variables import Variables, analysis_variables

FILE = "results.nc"

VARIABLES = (
    *(
        "label",
        "kind",
        "pareto",
        "theta",
        "objective",
        "error",
        "weight",
        "frequency",
        "mac",
        "converged",
    ),
    *("status", "stationary_weight", "paired_mode", "measured_frequency", "exact", "bounds"),
    *("minimum_of", "minimum_theta", "minimum_objective", "parameter", "group", "mode", "finding"),
)
ATTRIBUTES = (
    *("version", "seed", "method", "model_evaluations", "front_evaluations", "front_is_a_point"),
    *("hypervolume", "igd_plus", "largest_gap", "reference"),
)
"""What every file of results holds."""


def dataset(problem: UpdatingProblem, front: Front, analysis: FrontAnalysis) -> xr.Dataset:
    """Return everything that was found with names and units; see the page on results."""
    front = replace(front, points=[*front.points, *analysis.points])
    points = front.points
    labels = [x.label for x in points]
    solutions = [x.solution for x in points]
    groups, n = list(problem.objectives), len(problem.objectives)
    J = _stack([one.at.J for one in solutions], n)
    manifolds = [at.J for _, found in analysis.manifolds for one in found for at in one.models]
    optimal = _pareto(front, J, _stack(manifolds, n))
    a = problem.properties
    weights = _weights(front, J, a)
    point, mode = ("point", "mode"), ("point", "group")
    variables: Variables = {
        "label": (("point",), labels, "name of the point"),
        "kind": (("point",), [x.kind.value for x in points], "why the model is reported"),
        "pareto": (
            ("point",),
            optimal,
            "no model that is known to the run dominates this one, equation (4)",
        ),
        "dominated_among_front": (
            ("point",),
            _dominated_among_front(front, J),
            "another point of the front dominates this one",
        ),
        "theta": (("point", "parameter"), _thetas(solutions, problem), "parameter values"),
        "objective": (mode, J, "J_i"),
        "error": (mode, np.sqrt(J / a), "sqrt(J_i / a_i)"),
        "weight": (mode, weights, "weights that a weighted method used"),
        "stationary_weight": (
            mode,
            _shares(
                _stack([one.weights for one in solutions], n),
                front.scale,
            ),
            "weights at which the point is stationary, over the range of each objective, sum 1; "
            "a negative one tells that the point is no local Pareto optimum",
        ),
        "converged": (("point",), [one.converged for one in solutions], "tolerances were met"),
        "status": (("point",), [one.status.name.lower() for one in solutions], "how it ended"),
        "evaluations": (
            ("point",),
            [one.evaluations for one in solutions],
            "evaluations of the last solution that led here",
        ),
    }
    meanings = {
        "frequency": "frequency in Hz of the model mode paired with the measured mode",
        "mac": "MAC of the pair, mean over the data sets",
        "paired_mode": "number of the model mode paired with the measured mode",
        "coincident": "1 where the mode is so close to another one that it is not defined alone",
    }
    for name, meaning in meanings.items():
        unknown = np.full(len(problem.data.modes), np.nan)
        rows = [one.at.quantities.get(name, unknown) for one in solutions]
        variables[name] = (point, _stack(rows, len(problem.data.modes)), meaning)
    variables |= certificate_variables(problem, solutions)
    variables["measured_frequency"] = (
        ("mode",),
        problem.data.mean_frequency,
        "mean of the measured frequencies in Hz",
    )
    variables["properties"] = (("group",), a, "count a_i of measured properties")
    variables["exact"] = (("group",), list(front.exact), "some model fits the group exactly")
    lower, upper = problem.lower, problem.upper
    variables["bounds"] = (("parameter", "bound"), np.column_stack([lower, upper]), "bounds")
    variables |= _minima(problem, front)
    variables |= _ends(problem, front, J, nondominated(J)) | _lattice(front)
    variables |= analysis_variables(problem, front, analysis)
    return xr.Dataset(
        {
            name: (dims, np.asarray(values), {"long_name": meaning})
            for name, (dims, values, meaning) in variables.items()
        },
        attrs={"reference": front.reference.label},
        coords={
            "parameter": list(problem.model.parameters),
            "group": groups,
            "mode": list(problem.data.modes),
            "bound": ["lower", "upper"],
            "parameter_other": list(problem.model.parameters),
            "group_other": groups,
        },
    )


def _minima(problem: UpdatingProblem, front: Front) -> Variables:
    """Return all distinct minima of single objectives and of the optimally weighted residuals."""
    of = [
        name
        for name, edge in zip(problem.objectives, front.edges, strict=True)
        for _ in edge.minima
    ]
    found = [one for edge in front.edges for one in edge.minima]
    of += [label(Kind.OPTIMAL)] * len(front.optimal)
    found += front.optimal
    if front.iterated:
        of.append("iterated-weights")
        found.append(front.iterated)
    n = len(problem.objectives)
    return {
        "minimum_of": (("minimum",), of, "group or method of which this is a minimum"),
        "minimum_theta": (("minimum", "parameter"), _thetas(found, problem), "parameter values"),
        "minimum_objective": (("minimum", "group"), _stack([x.at.J for x in found], n), "J_i"),
        "minimum_converged": (
            ("minimum",),
            [one.converged for one in found],
            "tolerances were met",
        ),
        **certificate_variables(problem, found, "minimum"),
    }


def _ends(problem: UpdatingProblem, front: Front, J: Floats, optimal: np.ndarray) -> Variables:
    """Return where the pieces of a front of two objectives end, and on which one points lie."""
    if J.shape[1] != 2 or front.method != "nbi":
        return {}
    found = [one for gap in front.gaps for one in (gap.end, gap.start)]
    p = len(problem.model.parameters)
    unknown, nowhere = np.full(2, np.nan), np.full(p, np.nan)
    thetas = [nowhere if one is None else one.at.theta for one in found]
    objectives = [unknown if one is None else one.at.J for one in found]
    labels = [text for i in range(len(front.gaps)) for text in (f"end-{i + 1}", f"start-{i + 2}")]
    return {
        "piece": (
            ("point",),
            piece_numbers(J, optimal, front.gaps),
            "piece of the front, from 1; 0 for points that lie in a gap",
        ),
        "end_label": (("end",), np.array(labels, dtype=str), "end or start of a piece at a gap"),
        "end_theta": (
            ("end", "parameter"),
            _stack(thetas, p),
            "parameter values; NaN where the end is not known",
        ),
        "end_objective": (
            ("end", "group"),
            _stack(objectives, 2),
            "J_i; NaN where the end is not known",
        ),
        "end_converged": (
            ("end",),
            np.array([one is not None for one in found], dtype=bool),
            "the end is known: tolerances were met, and no known model dominates it",
        ),
    }


def _pareto(front: Front, J: Floats, others: Floats) -> Bools:
    """Return which points (points, n) no known model dominates; ``others`` (models, n) are known.

    All evaluated models are known, minima and ends of branches too. An end that another branch
    dominates at the same level counts for the points next to it only.
    """
    minima = [one.at.J for edge in front.edges for one in edge.minima]
    minima += [one.at.J for gap in front.gaps for one in gap.ends]
    minima += [one.at.J for one in front.optimal]
    n = J.shape[1]
    known = np.vstack([J, front.known.reshape(-1, n), _stack(minima, n), others])
    # Of a front that is a point, the ranges over models as good as each other are rounding.
    scale = front.sizes if front.scale is None else front.scale
    return undominated(J, known, scale)


def _dominated_among_front(front: Front, J: Floats) -> Bools:
    """Return which points (points, n) another point of the front dominates; others do not count."""
    on = np.array([x.kind is Kind.FRONT for x in front.points])
    out = np.zeros(len(J), dtype=bool)
    if on.any():
        out[on] = ~nondominated(J[on], scale=front.scale)
    return out


def _weights(front: Front, J: Floats, a: Floats) -> Floats:
    """Return the weights (points, n) that weighted methods used; NaN at other points."""
    out = np.full(J.shape, np.nan)
    swept = METHODS[front.method].programme == "weights"
    for i, point in enumerate(front.points):
        if point.kind is Kind.OPTIMAL:
            out[i] = a / J[i]
        elif point.kind is Kind.BOUNDED and front.floor is not None:
            out[i] = a / (J[i] + front.floor)
        elif point.kind in WEIGHTED or (point.kind is Kind.FRONT and swept):
            out[i] = point.solution.weights
    return out


def _lattice(front: Front) -> Variables:
    """Return the lattice of normal-boundary intersection and the point that each place led to."""
    if not len(front.places):
        return {}
    return {
        "lattice": (
            ("place", "group"),
            front.lattice,
            "points of the simplex between the edges from which the front is projected",
        ),
        "lattice_label": (
            ("place",),
            np.array(["" if k < 0 else front.points[k].label for k in front.places], dtype=str),
            "label of the point that this place led to, empty for none; places of the same model "
            "share one",
        ),
    }


def _stack(rows: Sequence[Floats], width: int) -> Floats:
    return np.array(rows, dtype=float).reshape(len(rows), width)


def _thetas(solutions: Sequence[Solution], problem: UpdatingProblem) -> Floats:
    return _stack([one.at.theta for one in solutions], len(problem.model.parameters))


def _shares(weights: Floats, scale: Floats | None) -> Floats:
    """Return weights times the range of their objective, with sum 1."""
    scaled = weights * (1.0 if scale is None else scale)
    total = scaled.sum(axis=1, keepdims=True)
    return np.divide(scaled, total, out=np.full(scaled.shape, np.nan), where=total != 0)


def front_points(data: xr.Dataset) -> Ints:
    """Return the positions of the points of the front, in their order along it."""
    return np.flatnonzero(data["kind"].values == Kind.FRONT.value)


def not_converged(data: xr.Dataset) -> list[str]:
    """Return the labels of points that should have converged and did not."""
    tried = data["status"].values != "sampled"
    return data["label"].values[~data["converged"].values & tried].tolist()


def write(data: xr.Dataset, path: Path) -> None:
    """Write a dataset whole or not at all."""
    temporary = path.with_name(path.name + ".tmp")
    data.to_netcdf(temporary, engine="h5netcdf")
    with temporary.open("rb") as stream:
        os.fsync(stream.fileno())
    temporary.replace(path)


def read(folder: Path) -> xr.Dataset:
    """Return the results in a folder. Raises InputError where there are none to be read."""
    path = folder / FILE
    if not path.is_file():
        raise InputError(Fault(str(path), "file", "results of a finished run", "no such file"))
    try:
        with xr.open_dataset(path, engine="h5netcdf") as data:
            data.load()
    except Exception as error:  # what is raised for a damaged file is not documented
        raise InputError(Fault(str(path), "file", "results in netCDF", str(error))) from None
    missing = [name for name in VARIABLES if name not in data]
    missing += [name for name in ATTRIBUTES if name not in data.attrs]
    if missing:
        found = f"none called {', '.join(missing)}"
        raise InputError(Fault(str(path), "variables", "results of modefront", found))
    return data
