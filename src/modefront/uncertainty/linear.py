"""The scatter of all points of a front, each by its own conditions of optimality."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from modefront._typing import Floats
from modefront.solvers.curvature import SecondOrder
from modefront.solvers.problem import Problem
from modefront.solvers.sqp import Solution
from modefront.uncertainty.conditions import (
    Target,
    between,
    boundary,
    given_weights,
    level,
    optimal_weights,
    over_ranges,
)
from modefront.uncertainty.noise import Noise
from modefront.uncertainty.points import Point, Role, edge_weights, in_order
from modefront.uncertainty.scatter import Scatter, scatter

Local = tuple[SecondOrder, Noise]

Differentiate = Callable[[str, Solution, Floats | None], Local | None]
"""Returns the second derivatives and the noise at a point of this label.

With weights (n,), the point is solved with them first. None where they are not defined.
"""


def front_scatter(
    problem: Problem,
    points: Sequence[Point],
    a: Floats,
    sizes: Floats,
    differentiate: Differentiate,
) -> dict[str, Scatter]:
    """Return the scatter of the points for which it is defined, by label."""
    level_of: dict[int, Floats] = {}  # changes of the least value of each objective
    ends: dict[str, tuple[Floats, Floats]] = {}
    out: dict[str, Scatter] = {}
    for one in in_order(points):
        role = one.role
        if role.kind in ("edge", "minimum"):
            w = edge_weights(role.objective, sizes)
            local = differentiate(one.label, one.solution, w)
            if local is None:
                continue
            point, noise = local
            out[one.label] = scatter(problem, point, w, given_weights(noise), noise)
            ends[one.label] = point.at.J, out[one.label].J
            if role.kind == "edge":
                level_of[role.objective] = out[one.label].J[:, role.objective]
            continue
        if role.kind == "end":
            if role.ends[0] in out:
                out[one.label] = out[role.ends[0]]
            continue
        beta = one.solution.beta
        if role.kind == "boundary" and (beta is None or not {*role.ends, *role.worst} <= set(ends)):
            continue
        if role.kind == "level" and role.objective not in level_of:
            continue
        local = differentiate(one.label, one.solution, None)
        if local is None:
            continue
        point, noise = local
        w = one.solution.weights
        if role.kind == "weights":
            conditions = given_weights(noise)
        elif role.kind == "optimal":
            w = a / point.at.J
            conditions = optimal_weights(point, a, noise)
        elif role.kind == "level":
            dv = (1 + role.tolerance) * level_of[role.objective]
            conditions = level(point, role.objective, dv, noise)
        elif beta is not None:
            w, conditions = boundary(point, w, _target(role, ends), beta, noise)
        out[one.label] = scatter(problem, point, w, conditions, noise)
        if role.kind == "level":
            ends[one.label] = point.at.J, out[one.label].J
    return out


def _target(role: Role, ends: Mapping[str, tuple[Floats, Floats]]) -> Target:
    """Return the simplex of a point of NBI, from the objectives of labelled points."""
    E = np.array([ends[label][0] for label in role.ends]).T
    dE = np.stack([ends[label][1] for label in role.ends], axis=2)
    if not role.worst:
        return between(E, dE)
    top = np.array([ends[label][0][i] for i, label in enumerate(role.worst)])
    dtop = np.stack([ends[label][1][:, i] for i, label in enumerate(role.worst)], axis=1)
    return over_ranges(E, dE, top, dtop)
