"""The scatter of all points of a front, each by its own conditions of optimality."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from modefront._typing import Floats
from modefront.front.front import Front
from modefront.optim.problem import Evaluation, Problem
from modefront.optim.scalarisation import LogSum, Scalarisation, weighted
from modefront.optim.sqp import Solution
from modefront.uncertainty.conditions import (
    Conditions,
    LinearisationWarning,
    Target,
    between,
    boundary,
    given_weights,
    has_rival,
    level,
    near_an_end,
    optimal_weights,
    over_ranges,
)
from modefront.uncertainty.noise import Noise
from modefront.uncertainty.points import Role, SolvedPoint, edge_weights, in_order
from modefront.uncertainty.scatter import Scatter, scatter
from modefront.work.codec import record


@record
@dataclass(frozen=True)
class Local:
    """What the scatter of a point follows from.

    Attributes
    ----------
    evaluation : with second derivatives
    noise : of its objectives
    slopes : derivatives (modes, p) of predicted quantities
    """

    evaluation: Evaluation
    noise: Noise
    slopes: Mapping[str, Floats]


def front_scatter(
    problem: Problem,
    points: Sequence[SolvedPoint],
    known: Mapping[str, Local],
    a: Floats,
    sizes: Floats,
) -> dict[str, Scatter]:
    """Return the scatter of the points for which it is defined, by label.

    A point of which the solver knows no weights has none, as where the objectives jump, or where a
    search ended before it was solved.
    """
    level_of: dict[int, Floats] = {}  # changes of the least value of each objective
    ends: dict[str, tuple[Floats, Floats]] = {}
    out: dict[str, Scatter] = {}
    conditions: Conditions
    for solved in in_order(points):
        role, text, w = solved.role, solved.label, solved.solution.weights
        beta = solved.solution.beta
        if role.kind == "end" and role.ends[0] in out:
            out[text] = out[role.ends[0]]
        if text not in known:
            continue
        point, noise = known[text].evaluation, known[text].noise
        match role.kind:
            case "edge":
                w, conditions = edge_weights(role.objective, sizes), given_weights(noise)
            case "weights" if w.any():
                conditions = given_weights(noise)
            case "optimal":
                w, conditions = a / point.J, optimal_weights(point, a, noise)
            case "level" if role.objective in level_of:
                dv = (1 + role.tolerance) * level_of[role.objective]
                conditions = level(point, role.objective, dv, noise)
            case "boundary" if beta is not None and w.any() and {*role.ends} <= set(ends):
                target = _target(role, ends)
                w, conditions = boundary(point, w, target, beta, noise, role.equations)
            case _:
                continue
        out[text] = scatter(problem, point, w, conditions, noise)
        ends[text] = point.J, out[text].J
        if role.kind == "edge":
            level_of[role.objective] = out[text].J[:, role.objective]
    return out


def _target(role: Role, ends: Mapping[str, tuple[Floats, Floats]]) -> Target:
    """Return the simplex of a point of NBI, from the objectives of labelled points."""
    E = np.array([ends[label][0] for label in role.ends]).T
    dE = np.stack([ends[label][1] for label in role.ends], axis=2)
    if not role.worst:
        return between(E, dE)
    return over_ranges(E, dE, np.array([x.J[i] for i, x in enumerate(role.worst)]))


def with_neighbours(
    front: Front,
    points: Sequence[SolvedPoint],
    scatter: Mapping[str, Scatter],
    a: Floats,
    sizes: Floats,
) -> dict[str, Scatter]:
    """Return the scatter of points with the warnings that their neighbours raise."""
    ends = [end.J for gap in front.gaps for end in gap.ends]
    out: dict[str, Scatter] = {}
    for point in in_order(points):
        kind, known = point.role.kind, scatter.get(point.label)
        if kind == "end" and known:
            out[point.label] = out[point.role.ends[0]]
        elif known:
            near = kind == "boundary" and near_an_end(point.solution.J, known.J, ends)
            reasons = {
                LinearisationWarning.ENDS: near,
                LinearisationWarning.RIVAL: _has_rival(front, point, known, a, sizes),
                LinearisationWarning.UNSOLVED: not point.solution.converged,
            }
            warnings = (*known.warnings, *(warning for warning in reasons if reasons[warning]))
            out[point.label] = replace(known, warnings=warnings)
    return out


def _has_rival(
    front: Front, point: SolvedPoint, scatter: Scatter, a: Floats, sizes: Floats
) -> bool:
    """Return whether another minimum of what an edge or the optimal weights minimise is as good."""
    programme: Scalarisation
    others: Sequence[Solution]
    if point.role.kind == "edge":
        i = point.role.objective
        programme, others = weighted(edge_weights(i, sizes)), front.edges[i].minima[1:]
    elif point.role.kind == "optimal":
        programme, others = LogSum(a), front.optimal[1:]
    else:
        return False
    J = point.solution.J
    changes = scatter.J @ programme.gradient(J)
    return has_rival(programme.value(J), changes, [programme.value(x.J) for x in others])
