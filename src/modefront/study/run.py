"""The work of a study: edges, weighted models, front and gaps, piece by piece."""

from __future__ import annotations

import zlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from modefront._typing import Floats
from modefront.errors import UnfinishedError
from modefront.solvers.advance import default_points, simplex
from modefront.solvers.basins import explore_between
from modefront.solvers.checkpoint import Checkpoint, Solutions, compute_always
from modefront.solvers.dominance import nondominated
from modefront.solvers.edges import EXACT, Edge, edge, near_best, sample, typical_sizes
from modefront.solvers.evolutionary import EVOLUTIONARY, evolve_front
from modefront.solvers.explore import Search, distinct, explore
from modefront.solvers.nbi import nbi
from modefront.solvers.payoff import Payoff, corners, payoff
from modefront.solvers.pieces import Gap, gaps
from modefront.solvers.problem import Problem
from modefront.solvers.refine import refine
from modefront.solvers.scalarisation import weighted
from modefront.solvers.sqp import Solution
from modefront.solvers.sweep import weight_sweep
from modefront.solvers.weights import iterate_weights, optimal_minima, regular

Labelled = Sequence[tuple[str, Solution]]
"""Solutions with what they are called."""


MOVED = 0.1
"""Distance of two edges, over the ranges of the parameters, above which their fronts differ."""

TURNS = 3
"""Refinements of a front at most, each with the gaps that were found by the one before."""


@dataclass(frozen=True)
class Front:
    """Everything that was found.

    Attributes
    ----------
    method : by which the front was found
    points : (label, solution) of the points along the front, then of the edges and weighted models
    edges : the edge of each objective with its other minima
    optimal : all regular minima of the optimally weighted residuals, best first
    iterated : where the iteration of the weights arrived; None where it ran into a singularity
    exact : (n,) which objectives some model fits exactly
    target : utopia point and ranges over the edges, or None where the front is one point
    gaps : gaps between the pieces of a front of two objectives
    """

    method: str
    points: Labelled
    edges: Sequence[Edge]
    optimal: Sequence[Solution]
    iterated: Solution | None
    exact: tuple[bool, ...]
    target: Payoff | None
    gaps: Sequence[Gap]

    @property
    def scale(self) -> Floats | None:
        """Range of each objective over the edges, shape (n,)."""
        return self.target.scale if self.target else None


def ignore(_: object) -> None:
    """Do nothing with what one is told."""


def generator(seed: int, name: str) -> np.random.Generator:
    """Return the random numbers of one piece of work, whatever was done before it."""
    return np.random.default_rng(sequence(seed, name))


def sequence(seed: int, name: str) -> np.random.SeedSequence:
    """Return what the random numbers of one piece of work grow from."""
    return np.random.SeedSequence([seed, zlib.crc32(name.encode())])


def pareto_front(
    problem: Problem,
    a: Floats,
    *,
    method: str = "nbi",
    points: int | None = None,
    refined: float | None = None,
    population: int = 100,
    evaluations: int = 10_000,
    seed: int = 0,
    search: Search | None = None,
    tolerance: float = 0.0,
    given: Sequence[tuple[str, Floats]] = (),
    checkpoint: Checkpoint = compute_always,
    expect: Callable[[int], None] = ignore,
    known: Front | None = None,
) -> Front:
    """Find the edges, the weighted models, the front by a method, and its gaps.

    ``a`` (n,) counts the measured properties of each objective; ``points`` lie along each edge of
    the simplex of objectives (None: as `default_points` says); ``refined`` is the distance of
    neighbours above which NBI puts more points between them, two objectives only;
    ``population`` and ``evaluations`` are those of an evolutionary method; an edge may exceed the
    least value of its objective by the share ``tolerance``; ``given`` are labelled weights (n,).
    ``expect`` is told how many pieces of work there are. Minima are looked for near those of a
    front that is ``known``, of nearly the same problem, and nowhere else. Raises UnfinishedError
    where no edge can be found.
    """
    search = (search or Search()) if known is None else Search(0, 0, 0)
    n = len(problem.objectives)
    lattice = simplex(n, (points or default_points(n)) - 1) if n > 1 else None
    subproblems = len(lattice.counts) if lattice else 1
    if lattice and method in EVOLUTIONARY:
        subproblems = max(evaluations // population, 1)
    starts_again = 3 + n + len(given) if known else 0
    expect(4 + 2 * n + len(given) + subproblems + starts_again)

    def again(name: str, solutions: Sequence[Solution]) -> Sequence[Solution]:
        """Return known solutions as starts, with the objectives that they have now."""
        return checkpoint(
            f"known-{name}",
            lambda: [replace(one, at=problem.evaluate(one.at.theta)) for one in solutions],
        )

    sizes = typical_sizes(checkpoint("sample", lambda: sample(problem, generator(seed, "sample"))))
    if sizes is None:
        raise UnfinishedError(
            "the model cannot be evaluated at any of the parameters tried within the bounds"
        )
    edges = []
    for i, name in enumerate(problem.objectives):
        rng = generator(seed, f"edge-{name}")
        near = again(f"edge-{name}", known.edges[i].minima) if known else ()
        found = edge(problem, i, sizes, rng, search, checkpoint, near)
        if found is None:
            raise UnfinishedError(f"no minimum of group '{name}' was found from any start")
        edges.append(found)
    bests = [one.best for one in edges]
    minima_of_one = [one for each in edges for one in each.minima]
    least = np.array([one.best.at.J[i] for i, one in enumerate(edges)])

    models: list[tuple[str, Solution]] = []
    for label, w in [*given, ("equal-weights", np.ones(n))]:
        rng = generator(seed, label)
        before = [one for name, one in known.points if name == label] if known else []
        near = again(label, before) if known else bests
        search_from = partial(explore, problem, weighted(w), rng, search, starts=near)
        models += [(label, one) for one in checkpoint(label, search_from)[:1]]
    starts = [*(one for _, one in models), *bests]
    near = again("optimal-weights", known.optimal) if known else starts
    rng = generator(seed, "optimal-weights")
    minima = checkpoint(
        "optimal-weights", lambda: optimal_minima(problem, a, sizes, rng, search, near)
    )
    optimal = [one for one in minima if regular(one.at.J, sizes)]
    models += [("optimal-weights", one) for one in optimal[:1]]
    if known and known.iterated:
        (first,) = again("iterated-weights", [known.iterated])
    else:
        first = starts[0]
    iterated = checkpoint(
        "iterated-weights",
        lambda: [one for one in [iterate_weights(problem, a, sizes, first)] if one],
    )

    if tolerance > 0:
        found_before = [*optimal, *starts]
        ends = [
            checkpoint(
                f"near-{name}", partial(near_best, problem, one, i, tolerance, sizes, found_before)
            )
            for i, (name, one) in enumerate(zip(problem.objectives, bests, strict=True))
        ]
        bests = [found[0] for found in ends]
    if n > 2:
        minima_of_one += corners(problem, bests, sizes, minima_of_one, checkpoint)
    target = payoff(bests, sizes, minima_of_one) if n > 1 else None
    along: Sequence[Solution] = []
    breaks: list[Gap] = []
    if target is not None and lattice is not None:
        if method in EVOLUTIONARY:
            rng = generator(seed, method)
            along = evolve_front(problem, method, population, evaluations, rng, checkpoint)
        elif method == "weights":
            along = weight_sweep(problem, bests, target.scale, lattice, checkpoint)
        else:
            before = _before(problem, known, bests) if known else []
            along = nbi(problem, bests, target, lattice, checkpoint, minima_of_one, before=before)
            rng = generator(seed, "between")
            found_by = [*(one.minima for one in edges), optimal, [one for _, one in models]]
            along = explore_between(
                problem, target, along, found_by, lattice, rng, search, checkpoint
            )
            if n == 2:
                along, breaks = _pieces(problem, target, along, refined, checkpoint)
    labelled = [(f"{method}-{i + 1}", one) for i, one in enumerate(along)]
    labelled += [(f"edge-{name}", one) for name, one in zip(problem.objectives, bests, strict=True)]
    return Front(
        method,
        labelled + models,
        edges,
        optimal,
        iterated[0] if iterated else None,
        tuple(bool(x) for x in least <= EXACT * sizes),
        target,
        breaks,
    )


def _before(problem: Problem, known: Front, bests: Sequence[Solution]) -> list[Solution]:
    """Return the points of a known front, none where it had other edges."""
    edges = [[edge.best] for edge in known.edges]
    if any(distinct(was, best, problem, MOVED) for was, best in zip(edges, bests, strict=True)):
        return []
    return [one for _, one in known.points if one.beta is not None]


def _pieces(
    problem: Problem,
    target: Payoff,
    along: Sequence[Solution],
    refined: float | None,
    checkpoint: Checkpoint,
) -> tuple[Sequence[Solution], list[Gap]]:
    """Return the points of a front of two objectives, refined where wanted, and its gaps."""
    optimal = nondominated(np.array([one.at.J for one in along]))
    breaks = gaps(problem, along, optimal, target.scale, checkpoint)
    if refined is None:
        return along, breaks
    for turn in range(TURNS):
        again = partial(_renamed, checkpoint, f"-turn-{turn + 1}")
        along, jumps = refine(problem, target, along, optimal, breaks, refined, again)
        optimal = nondominated(np.array([one.at.J for one in along]))
        before, breaks = len(breaks), gaps(problem, along, optimal, target.scale, again, jumps)
        if len(breaks) == before:
            break
    return along, breaks


def _renamed(
    checkpoint: Checkpoint, suffix: str, name: str, compute: Callable[[], Solutions]
) -> Solutions:
    return checkpoint(name + suffix, compute)
