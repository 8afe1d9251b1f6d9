"""The scatter of all points of a front, each by its own conditions of optimality."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from modefront._typing import Floats
from modefront.solvers.curvature import SecondOrder
from modefront.solvers.flat import same
from modefront.solvers.problem import Problem
from modefront.solvers.sqp import Solution
from modefront.uncertainty.noise import Noise
from modefront.uncertainty.points import Point, edge_weights
from modefront.uncertainty.scatter import (
    Scatter,
    boundary,
    given_weights,
    level,
    optimal_weights,
    scatter,
)

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
    n = a.size
    edges: dict[int, tuple[Floats, Scatter]] = {}
    for i in range(n):
        (own,) = (p for p in points if p.role.kind == "edge" and p.role.objective == i)
        w = edge_weights(i, sizes)
        local = differentiate(own.label, own.solution, w)
        if local is not None:
            point, noise = local
            found = scatter(problem, point, w, given_weights(noise), noise)
            edges[i] = point.at.J, found
    ends: dict[str, tuple[Floats, Floats]] = {}
    out: dict[str, Scatter] = {}
    for one in sorted(points, key=lambda one: one.role.kind == "boundary"):
        role = one.role
        if role.kind == "edge":
            if role.objective in edges:
                J, out[one.label] = edges[role.objective]
                ends[one.label] = J, out[one.label].J
            continue
        twin = next((x for x in role.ends if _is_end(x, one, points)), None)
        if twin is not None:
            if twin in out:
                out[one.label] = out[twin]
            continue
        if not set(role.ends) <= set(ends) or (
            role.kind == "level" and role.objective not in edges
        ):
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
            dv = (1 + role.tolerance) * edges[role.objective][1].J[:, role.objective]
            conditions = level(point, role.objective, dv, noise)
        else:
            E = np.array([ends[label][0] for label in role.ends]).T
            dE = np.stack([ends[label][1] for label in role.ends], axis=2)
            try:
                w, conditions = boundary(point, w, E, dE, noise)
            except np.linalg.LinAlgError:
                continue
        out[one.label] = scatter(problem, point, w, conditions, noise)
        if role.kind == "level":
            ends[one.label] = point.at.J, out[one.label].J
    return out


def _is_end(label: str, one: Point, points: Sequence[Point]) -> bool:
    """Return whether a point is the end of this label itself."""
    (end,) = (point for point in points if point.label == label)
    return same(end.solution, one.solution)
