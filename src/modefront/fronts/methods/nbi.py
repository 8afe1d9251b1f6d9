"""The front by normal-boundary intersection, explored between its edges, refined, with its gaps."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

import numpy as np

from modefront.fronts.methods.base import Along, Setting
from modefront.solvers.basins import explore_between, resumed
from modefront.solvers.border import without_slack
from modefront.solvers.competition import (
    from_neighbours,
    from_points_beside,
    from_visited,
    polished,
)
from modefront.solvers.continuation import Simplex
from modefront.solvers.dominance import nondominated
from modefront.solvers.flat import same
from modefront.solvers.gaps import gaps
from modefront.solvers.nbi import nbi
from modefront.solvers.payoff import Payoff
from modefront.solvers.refine import refine
from modefront.solvers.sqp import Solution
from modefront.work.task import Within, seed_sequence

if TYPE_CHECKING:
    from modefront.fronts.options import Pareto

TURNS = 3
"""Refinements of a front at most, each with the gaps that the one before has shown; and comparisons
of its points with those beside them, each with the points that the one before has lowered."""

COPY = 1e-5
"""Distance of two points, over the ranges of the objectives, below which they are copies."""


@dataclass(frozen=True)
class NormalBoundaryIntersection:
    """The front by normal-boundary intersection (Das & Dennis 1998)."""

    name: str = "nbi"
    title: str = "normal-boundary intersection"
    refines: bool = True
    programme: Literal["boundary"] = "boundary"

    @property
    def missing(self) -> None:
        """None: nothing else has to be installed."""

    def extent(self, _: Pareto, lattice: Simplex) -> int:
        """Return the number of lattice points."""
        return len(lattice.counts)

    def along(self, setting: Setting) -> Along:
        """Return the points, each once; of two objectives with the gaps between them.

        A front that is resumed was explored, and has competed with models in other basins, before.
        """
        problem, target, lattice = setting.problem, setting.target, setting.lattice
        before, beside = list(setting.before), list[Solution]()
        if setting.resumed:
            beside = [x for x in before if x.beta is None or not lattice.has(x.beta)]
            before = [x for x in before if x.beta is not None and lattice.has(x.beta)]
        solved = nbi(
            problem,
            setting.edges,
            target,
            lattice,
            setting.work,
            () if setting.resumed else setting.corners,
            before=before,
            resumed=setting.resumed,
        )
        along = explore_between(
            problem,
            target,
            [*solved, *resumed(problem, target, beside, setting.work)],
            setting.minima,
            lattice,
            np.random.default_rng(seed_sequence(setting.seed, "between")),
            setting.search,
            setting.work,
            setting.archive,
        )
        if len(setting.edges) > 2:
            along = _settled(setting, target, along)
        elif not setting.resumed:
            along = from_visited(problem, target, lattice, along, setting.archive, setting.work)
            if len(along) > len(solved):
                along = from_neighbours(problem, target, lattice, along, setting.work)
        elif beside:
            along = sorted(along, key=lambda point: -float(target.place(point.J)[0]))
        front = without_copies(lattice, solved, along, target)
        return _branches(setting, front) if len(setting.edges) == 2 else front


def _settled(setting: Setting, target: Payoff, points: Sequence[Solution]) -> list[Solution]:
    """Return the points, compared with models beside them and lowered at the border.

    What is lowered may have left the best branch, or lead to a better one.
    """
    problem, lattice = setting.problem, setting.lattice
    visited = None if setting.resumed else setting.archive
    compared: list[Solution] = []
    lowered = list(points)
    for turn in range(TURNS):
        part = Within(setting.work, turn=("turn", turn + 1))
        compared = from_points_beside(problem, target, lattice, lowered, part, compared, visited)
        if turn and all(map(same, compared, lowered)):
            break
        lowered = without_slack(problem, target, compared, part, lowered if turn else ())
    return polished(problem, target, lowered, setting.work)


def without_copies(
    lattice: Simplex, solved: Sequence[Solution], along: Sequence[Solution], target: Payoff
) -> Along:
    """Return the points of a front, each once, with the lattice points that led to them.

    ``solved`` are the solutions of the lattice points in their order, others after them; ``along``
    are the points of the front, of which some have taken the places of these.
    """
    kept: list[Solution] = []
    J = np.full((len(along), target.scale.size), np.inf)
    position = []
    for point in along:
        with np.errstate(invalid="ignore"):  # models that cannot be evaluated have infinite J
            copies = (np.abs(J[: len(kept)] - point.J) <= COPY * target.scale).all(axis=1)
        k = int(copies.argmax()) if copies.any() else len(kept)
        position.append(k)
        if k == len(kept):
            kept.append(point)
        elif point.converged and not kept[k].converged:
            kept[k] = point
        J[k] = kept[k].J
    places = []
    for first in solved[: len(lattice.counts)]:
        same = (k for k, point in enumerate(along) if point is first or _of_place(point, first))
        k = next(same, -1)
        places.append(position[k] if k >= 0 else -1)
    return Along(kept, (), lattice.beta, np.array(places, dtype=np.intp))


def _of_place(point: Solution, other: Solution) -> bool:
    """Return whether two solutions are of the same point of the simplex."""
    if point.beta is None or other.beta is None:
        return False
    return np.array_equal(point.beta, other.beta)


def _branches(setting: Setting, front: Along) -> Along:
    """Return a front of two objectives, refined where wanted, with its gaps."""
    problem, target, refined = setting.problem, setting.target, setting.options.refined
    along = front.points
    optimal = nondominated(np.array([point.J for point in along]))
    known = setting.archive.J
    breaks = gaps(problem, along, optimal, target.scale, setting.work, known=known)
    if refined is None:
        return replace(front, gaps=breaks)
    for turn in range(TURNS):
        work = Within(setting.work, turn=("turn", turn + 1))
        along, jumps = refine(problem, target, along, optimal, breaks, refined, work)
        optimal = nondominated(np.array([point.J for point in along]))
        before = len(breaks)
        breaks = gaps(problem, along, optimal, target.scale, work, jumps, known)
        if len(breaks) == before:
            break
    places = [
        -1 if i < 0 else next(k for k, point in enumerate(along) if point is front.points[i])
        for i in front.places
    ]
    return replace(front, points=along, gaps=breaks, places=np.array(places, dtype=np.intp))
