"""Validity of the linearised scatter of points, as far as it depends on their neighbours."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from modefront._typing import Floats
from modefront.fronts.front import Front
from modefront.solvers.scalarisation import LogSum, Scalarisation, weighted
from modefront.solvers.sqp import Solution
from modefront.uncertainty.points import SolvedPoint, edge_weights, in_order
from modefront.uncertainty.scatter import Scatter
from modefront.uncertainty.validity import LinearisationWarning, has_rival, near_an_end


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
        label, evaluation = point.label, point.solution.evaluation
        if label not in scatter:
            continue
        if point.role.kind == "end":
            out[label] = out[point.role.ends[0]]
            continue
        linearised = scatter[label]
        reasons = [
            (
                LinearisationWarning.ENDS,
                point.role.kind == "boundary" and near_an_end(evaluation.J, linearised.J, ends),
            ),
            (LinearisationWarning.RIVAL, _has_rival(front, point, linearised, a, sizes)),
            (LinearisationWarning.UNSOLVED, not point.solution.converged),
        ]
        warnings = (*linearised.warnings, *(warning for warning, holds in reasons if holds))
        out[label] = replace(linearised, warnings=warnings)
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
