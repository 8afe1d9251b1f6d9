"""The points of a front with what each of them solves, so that they can be solved again.

With data drawn again they tell how far models and fronts scatter: data sets with replacement (the
bootstrap), values from a Gaussian of their standard deviation.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal, get_args

import numpy as np

from modefront._typing import Bools, Floats
from modefront.data.modal import ModalData
from modefront.errors import UnfinishedError
from modefront.front.simplex import payoff
from modefront.front.subproblems import LatticePoint, near_best
from modefront.optim.problem import Problem
from modefront.optim.scalarisation import LogSum, weighted
from modefront.optim.sqp import Solution, begin, solve
from modefront.residuals.problem import UpdatingProblem
from modefront.uncertainty.noise import Source

Kind = Literal["edge", "level", "weights", "optimal", "end", "boundary"]
"""Kinds of programmes of points; each kind depends only on those before it."""

SMALL = 1e-4
"""Weight of the other objectives, over that of an edge's own, that keeps second derivatives of an
edge in a flat valley regular. Its scatter differs from that of the limit by about as much."""


ATTEMPTS = 1000  # drawings of data sets until all that is measured is in one, at most


@dataclass(frozen=True)
class Role:
    """Programme that a point solves."""

    # an edge; the best of the others at a level of an objective; weights that are given or optimal;
    # one of the ends; a point of NBI
    kind: Kind
    ends: tuple[str, ...] = ()  # labels of the ends of a point of NBI, one an objective; or the end
    # models, which stay, up to which ranges of objectives reach where these span the simplex
    worst: Sequence[Solution] = ()
    equations: bool = False  # whether a point of NBI solves the equations of Das & Dennis
    objective: int = -1  # of an edge or a level
    tolerance: float = 0.0  # share by which a level exceeds the least value of its objective


@dataclass(frozen=True)
class SolvedPoint:
    """A labelled solution and what it solves."""

    label: str
    solution: Solution
    role: Role


def edge_weights(objective: int, sizes: Floats) -> Floats:
    """Return the weights (n,) of an edge that is kept regular."""
    w = np.full(sizes.size, SMALL)
    w[objective] = 1.0
    return w / sizes


def in_order(points: Sequence[SolvedPoint]) -> list[SolvedPoint]:
    """Return the points, each after those that it depends on."""
    return sorted(points, key=lambda point: get_args(Kind).index(point.role.kind))


def solve_again(
    problem: UpdatingProblem,
    points: Sequence[SolvedPoint],
    sizes: Floats,
    source: Source,
    *,
    rng: np.random.Generator,
) -> Mapping[str, Solution]:
    """Return the points with data drawn again, by label, each solved from where it was.

    ``sizes`` (n,) are typical ones of the objectives. A point without a simplex is infeasible.
    """
    again = replace(problem, data=redraw(problem.data, source, rng))
    solved: dict[str, Solution] = {}
    for point in in_order(points):
        solved[point.label] = _again(again, point, solved, problem.properties, sizes)
    return solved


def _again(
    problem: Problem, point: SolvedPoint, solved: Mapping[str, Solution], a: Floats, sizes: Floats
) -> Solution:
    role = point.role
    if role.kind == "end":
        return solved[role.ends[0]]
    start = begin(problem.evaluate(point.solution.theta))
    if role.kind == "optimal":
        return solve(problem, LogSum(a), start)
    if role.kind == "weights":
        return solve(problem, weighted(point.solution.weights), start)
    if role.kind in ("edge", "level"):
        best = solve(problem, weighted(edge_weights(role.objective, sizes)), start)
        if role.kind != "level" or not best.feasible:
            return best
        others = np.arange(sizes.size) != role.objective  # as it was solved with
        sizes = np.divide(1, point.solution.weights, out=sizes.copy(), where=others)
        return near_best(problem, best, role.objective, role.tolerance, sizes, [start])
    target = payoff([solved[label] for label in role.ends], sizes, role.worst)
    beta = point.solution.beta
    if target is None or beta is None:
        return start
    return LatticePoint(beta, (), target, role.equations).solve(problem, start)


def redraw(data: ModalData, source: Source, rng: np.random.Generator) -> ModalData:
    """Return data as they might have been measured.

    Raises UnfinishedError where drawings of data sets hardly ever have all that was measured.
    """
    if source == "std":
        f_std, phi_std = (np.nan_to_num(x) for x in (data.frequency_std, data.shape_std))
        frequency = data.frequency + f_std * rng.standard_normal(f_std.shape)
        z = rng.standard_normal(phi_std.shape)
        errors = phi_std * z
        for k, r in np.argwhere(np.isfinite(data.shape).any(axis=2)).tolist():
            sensors = np.flatnonzero(np.isfinite(data.shape[k, r]))
            if (C := data.covariance_of(k, r, sensors)) is not None:
                errors[k, r, sensors] = np.linalg.cholesky(C) @ z[k, r, sensors]
        return replace(data, frequency=frequency, shape=data.shape + errors)
    measured = _measured(data)
    for _ in range(ATTEMPTS):
        drawn = rng.integers(len(data.sets), size=len(data.sets))
        names = tuple(f"{data.sets[k]} ({i + 1})" for i, k in enumerate(drawn.tolist()))
        again = data.of_sets(drawn, names)
        if (_measured(again) == measured).all():
            return again
    raise UnfinishedError(
        f"none of {ATTEMPTS} drawings of the data sets has everything in it that was measured: "
        "too much is measured in few sets; without bootstrap, the scatter is linearised"
    )


def _measured(data: ModalData) -> Bools:
    """Return which frequencies and shapes are measured in any set, (2, modes)."""
    return np.array(
        [np.isfinite(data.frequency).any(axis=0), np.isfinite(data.shape).any(axis=(0, 2))]
    )
