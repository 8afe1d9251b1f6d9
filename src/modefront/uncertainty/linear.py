"""The scatter of all points of a front, each by its own conditions of optimality."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from modefront._typing import Floats
from modefront.solvers.curvature import SecondOrder
from modefront.solvers.problem import Problem
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
from modefront.uncertainty.points import Kind, Role, SolvedPoint, edge_weights, in_order
from modefront.uncertainty.scatter import Scatter, scatter

Local = tuple[SecondOrder, Noise]

Differentiate = Callable[[Sequence[tuple[SolvedPoint, Floats | None]]], list[Local | None]]
"""Returns the second derivatives and the noise at each point; None where they are not defined.

A point with weights (n,) is solved with these first.
"""

DEPENDENT: tuple[tuple[Kind, ...], ...] = (
    ("edge", "minimum"),
    ("level",),
    ("weights", "optimal", "boundary"),
)
"""Kinds of programmes, each after those on whose scatter its own depends."""


def front_scatter(
    problem: Problem,
    points: Sequence[SolvedPoint],
    a: Floats,
    sizes: Floats,
    differentiate: Differentiate,
) -> dict[str, Scatter]:
    """Return the scatter of the points for which it is defined, by label."""
    level_of: dict[int, Floats] = {}  # changes of the least value of each objective
    ends: dict[str, tuple[Floats, Floats]] = {}
    out: dict[str, Scatter] = {}
    for kinds in DEPENDENT:
        chosen = [
            point
            for point in in_order(points)
            if point.role.kind in kinds and _is_defined(point, ends, level_of)
        ]
        weights = [
            edge_weights(point.role.objective, sizes) if kinds == DEPENDENT[0] else None
            for point in chosen
        ]
        derivatives = differentiate(list(zip(chosen, weights, strict=True)))
        for solved, local, w in zip(chosen, derivatives, weights, strict=True):
            if local is None:
                continue
            point, noise = local
            role, text = solved.role, solved.label
            if w is None:
                w = a / point.evaluation.J if role.kind == "optimal" else solved.solution.weights
            if role.kind in ("edge", "minimum", "weights"):
                conditions = given_weights(noise)
            elif role.kind == "optimal":
                conditions = optimal_weights(point, a, noise)
            elif role.kind == "level":
                dv = (1 + role.tolerance) * level_of[role.objective]
                conditions = level(point, role.objective, dv, noise)
            elif (beta := solved.solution.beta) is not None:
                w, conditions = boundary(point, w, _target(role, ends), beta, noise)
            out[text] = scatter(problem, point, w, conditions, noise)
            if role.kind in ("edge", "minimum", "level"):
                ends[text] = point.evaluation.J, out[text].J
            if role.kind == "edge":
                level_of[role.objective] = out[text].J[:, role.objective]
    for end in points:
        if end.role.kind == "end" and end.role.ends[0] in out:
            out[end.label] = out[end.role.ends[0]]
    return out


def _is_defined(
    point: SolvedPoint, ends: Mapping[str, object], level_of: Mapping[int, object]
) -> bool:
    """Return whether all is known on which the scatter of a point depends."""
    role = point.role
    if role.kind == "boundary":
        return point.solution.beta is not None and {*role.ends, *role.worst} <= set(ends)
    return role.kind != "level" or role.objective in level_of


def _target(role: Role, ends: Mapping[str, tuple[Floats, Floats]]) -> Target:
    """Return the simplex of a point of NBI, from the objectives of labelled points."""
    E = np.array([ends[label][0] for label in role.ends]).T
    dE = np.stack([ends[label][1] for label in role.ends], axis=2)
    if not role.worst:
        return between(E, dE)
    top = np.array([ends[label][0][i] for i, label in enumerate(role.worst)])
    dtop = np.stack([ends[label][1][:, i] for i, label in enumerate(role.worst)], axis=1)
    return over_ranges(E, dE, top, dtop)
