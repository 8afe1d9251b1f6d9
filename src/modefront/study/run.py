"""The work of a study: edges, weighted models, front and gaps, piece by piece."""

from __future__ import annotations

import zlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from modefront._typing import Floats, Ints
from modefront.errors import UnfinishedError
from modefront.solvers.advance import Simplex, default_points, simplex
from modefront.solvers.archive import Archive
from modefront.solvers.basins import explore_between
from modefront.solvers.checkpoint import Checkpoint, Solutions, compute_always
from modefront.solvers.dominance import nondominated
from modefront.solvers.edges import (
    Edge,
    edge,
    near_best,
    ordered,
    refined_from,
    sample,
    typical_sizes,
)
from modefront.solvers.evolutionary import EVOLUTIONARY, evolve_front
from modefront.solvers.explore import Descent, Search, distinct, explore
from modefront.solvers.lexicographic import EXACT, Lexicographic
from modefront.solvers.nbi import nbi
from modefront.solvers.payoff import Payoff, corners, payoff
from modefront.solvers.pieces import Gap, gaps
from modefront.solvers.problem import Problem
from modefront.solvers.refine import refine
from modefront.solvers.scalarisation import weighted
from modefront.solvers.sqp import Options, Solution, begin
from modefront.solvers.sweep import weight_sweep
from modefront.solvers.weights import (
    accepted,
    iterate_weights,
    least_along,
    optimal_minima,
)

Labelled = Sequence[tuple[str, Solution]]
"""Solutions with what they are called."""


MOVED = 0.1
"""Distance of two edges, over the ranges of the parameters, above which their fronts differ."""

TURNS = 3
"""Refinements of a front at most, each with the gaps that were found by the one before."""

AGAIN = 2
"""Searches of the front at most, each with edges that are better than those of the one before."""

COPY = 1e-5
"""Distance of two points, over the ranges of the objectives, below which they are copies."""

OPTIMAL, BOUNDED, EQUAL = "optimal-weights", "bounded-weights", "equal-weights"
"""Labels of the models by optimal, bounded and equal weights."""


@dataclass(frozen=True)
class Front:
    """Everything that was found.

    Attributes
    ----------
    method : by which the front was found
    points : (label, solution) of the points along the front, then of the edges and weighted models
    edges : the edge of each objective with its other minima
    optimal : all minima of the optimally weighted residuals that are accepted, best first
    iterated : where the iteration of the weights arrived; None where it ran into a singularity
    exact : (n,) which objectives some model fits exactly
    target : utopia point and ranges over the edges, or None where the front is one point
    gaps : gaps between the branches of a front of two objectives
    lattice : (places, n) lattice points of normal-boundary intersection
    places : (places,) the point of the front, from 0, to which each of them led; -1 for none
    known : (models, n) objectives of evaluated models that no evaluated model dominates
    floor : (n,) bounds b of J in the bounded weights; None where there is no such model
    sizes : (n,) typical sizes of the objectives, of random models; empty where not known
    """

    method: str
    points: Labelled
    edges: Sequence[Edge]
    optimal: Sequence[Solution]
    iterated: Solution | None
    exact: tuple[bool, ...]
    target: Payoff | None
    gaps: Sequence[Gap]
    lattice: Floats = field(default_factory=lambda: np.zeros((0, 0)))
    places: Ints = field(default_factory=lambda: np.zeros(0, dtype=np.intp))
    known: Floats = field(default_factory=lambda: np.zeros((0, 0)))
    floor: Floats | None = None
    sizes: Floats = field(default_factory=lambda: np.zeros(0))

    @property
    def reference(self) -> str:
        """Label of the model that the data prefer: by optimal, else bounded, else equal weights."""
        labels = [label for label, _ in self.points]
        return next(label for label in (OPTIMAL, BOUNDED, EQUAL) if label in labels)

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
    floor: Floats | None = None,
    checkpoint: Checkpoint = compute_always,
    expect: Callable[[int], None] = ignore,
    known: Front | None = None,
) -> Front:
    """Find the edges, the weighted models, the front by a method, and its gaps.

    ``a`` (n,) counts the measured properties of each objective; ``points`` lie along each edge of
    the simplex of objectives (None: as `default_points` says); ``refined`` is the distance of
    neighbours above which NBI puts more points between them, two objectives only;
    ``population`` and ``evaluations`` are those of an evolutionary method; an edge may exceed the
    least value of its objective by the share ``tolerance``; ``given`` are labelled weights (n,);
    ``floor`` (n,) is what errors of the data alone make of the objectives, for bounded weights.
    ``expect`` is told how many pieces of work there are. Minima are looked for near those of a
    front that is ``known``, of nearly the same problem, and nowhere else. Raises UnfinishedError
    where no edge can be found.
    """
    search = (search or Search()) if known is None else Search.none()
    archive = Archive(problem)
    problem, checkpoint = archive, archive.keeping(checkpoint)
    n = len(problem.objectives)
    lattice = simplex(n, (points or default_points(n)) - 1) if n > 1 else None
    subproblems = len(lattice.counts) if lattice else 1
    if lattice and method in EVOLUTIONARY:
        subproblems = max(evaluations // population, 1)
    starts_again = 3 + n + len(given) if known else 0
    expect(4 + 3 * n + len(given) + subproblems + starts_again)

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

    models: list[tuple[str, Solution]] = []
    for label, w in [*given, (EQUAL, np.ones(n))]:
        rng = generator(seed, label)
        before = [one for name, one in known.points if name == label] if known else []
        near = again(label, before) if known else [one.best for one in edges]
        search_from = partial(
            explore,
            problem,
            Descent(weighted(w), EXACT * float(w @ sizes)),
            rng,
            search,
            starts=near,
        )
        models += [(label, one) for one in checkpoint(f"weighted-{label}", search_from)[:1]]
    edges = _from_models(archive, edges, sizes, [one for _, one in models], checkpoint)

    front = _Along([], [], None, np.zeros((0, n)), np.zeros(0, dtype=np.intp))
    for turn in range(AGAIN):
        named = partial(_renamed, checkpoint, f"-again-{turn}" if turn else "")
        bests = [one.best for one in edges]
        if tolerance > 0:
            starts = [*(one for _, one in models), *bests]
            bests = [
                named(
                    f"near-{name}", partial(near_best, problem, one, i, tolerance, sizes, starts)
                )[0]
                for i, (name, one) in enumerate(zip(problem.objectives, bests, strict=True))
            ]
        minima_of_one = [one for each in edges for one in each.minima]
        if n > 2:
            minima_of_one += corners(problem, bests, sizes, minima_of_one, named)
        target = payoff(bests, sizes, minima_of_one) if n > 1 else None
        if target is None or lattice is None:
            break
        if method in EVOLUTIONARY:
            rng = generator(seed, method)
            along = evolve_front(problem, method, population, evaluations, rng, named)
            front = replace(front, target=target, points=along)
        elif method == "weights":
            along = weight_sweep(problem, bests, target.scale, lattice, named)
            front = replace(front, target=target, points=along)
        else:
            before = _before(problem, known, bests) if known else []
            before = [one for one in front.points if one.beta is not None] or before
            solved = nbi(problem, bests, target, lattice, named, minima_of_one, before=before)
            rng = generator(seed, "between")
            found_by = [*(one.minima for one in edges), [one for _, one in models]]
            along = explore_between(
                problem, target, solved, found_by, lattice, rng, search, named, archive
            )
            front = _without_copies(lattice, solved, along, target)
            if n == 2:
                front = _branches(archive, front, target, refined, named)
        better = _from_archive(archive, edges, sizes, named)
        if all(one is other for one, other in zip(better, edges, strict=True)):
            break
        edges = better
    target = front.target if front.target is not None else target
    if tolerance == 0:
        bests = [one.best for one in edges]
    models = _weighted_from_archive(
        archive, models, [*given, (EQUAL, np.ones(n))], sizes, checkpoint
    )

    rivals = [*(one for _, one in models), *front.points]
    near = [*(one for _, one in models), *bests, *least_along(front.points, a, sizes)]
    if known and known.optimal:
        near = list(again(OPTIMAL, known.optimal))
    rng = generator(seed, OPTIMAL)
    minima = checkpoint(OPTIMAL, lambda: optimal_minima(problem, a, sizes, rng, search, near))
    scale = target.scale if target else sizes
    optimal = accepted(minima, a, sizes, rivals, archive.J, scale)
    models += [(OPTIMAL, one) for one in optimal[:1]]
    if not optimal and floor is not None:
        rng = generator(seed, BOUNDED)
        bounded = checkpoint(
            BOUNDED, lambda: optimal_minima(problem, a, sizes, rng, search, near, floor)
        )
        models += [(BOUNDED, one) for one in bounded[:1]]
    if known and known.iterated:
        (first,) = again("iterated-weights", [known.iterated])
    else:
        first = next((one for label, one in models if label == EQUAL), bests[0])
    iterated = checkpoint(
        "iterated-weights",
        lambda: [one for one in [iterate_weights(problem, a, sizes, first)] if one],
    )
    labelled = [(f"{method}-{i + 1}", one) for i, one in enumerate(front.points)]
    labelled += [(f"edge-{name}", one) for name, one in zip(problem.objectives, bests, strict=True)]
    least = np.array([one.best.at.J[i] for i, one in enumerate(edges)])
    return Front(
        method,
        labelled + models,
        edges,
        optimal,
        iterated[0] if iterated else None,
        tuple(bool(x) for x in least <= EXACT * sizes),
        target,
        front.gaps,
        front.lattice,
        front.places,
        archive.J,
        floor if any(label == BOUNDED for label, _ in models) else None,
        sizes,
    )


@dataclass(frozen=True)
class _Along:
    """The points of a front, its gaps, and the lattice points that led to them; see `Front`."""

    points: Sequence[Solution]
    gaps: Sequence[Gap]
    target: Payoff | None
    lattice: Floats
    places: Ints


def _from_models(
    archive: Archive,
    edges: Sequence[Edge],
    sizes: Floats,
    models: Sequence[Solution],
    checkpoint: Checkpoint,
) -> list[Edge]:
    """Return the edges, with the minima to which weighted models lead among the others.

    These are sought where the minima of an objective form a manifold, of which others are only met.
    """
    out = []
    for i, (name, known) in enumerate(zip(archive.objectives, edges, strict=True)):
        if not Lexicographic(i, sizes).is_open(archive, known.best.at):
            out.append(known)
            continue
        search = partial(refined_from, archive, i, sizes, models)
        found = ordered(
            archive, i, sizes, [*known.minima, *checkpoint(f"edge-{name}-from", search)]
        )
        out.append(found or known)
    return out


def _from_archive(
    archive: Archive, edges: Sequence[Edge], sizes: Floats, checkpoint: Checkpoint
) -> list[Edge]:
    """Return the edges, searched again from evaluated models that come before them."""
    out = []
    for i, (name, known) in enumerate(zip(archive.objectives, edges, strict=True)):
        order = Lexicographic(i, sizes)
        before = [k for k, J in enumerate(archive.J) if order.clearly_better(J, known.best.at.J)]
        if not before:
            out.append(known)
            continue
        first = min(before, key=lambda k: order.value(archive.J[k]))
        start = partial(_begin, archive, archive.theta[first])
        search = partial(_refined_again, archive, i, sizes, start)
        found = ordered(
            archive, i, sizes, [*known.minima, *checkpoint(f"edge-{name}-known", search)]
        )
        better = found and order.better(found.best.at.J, known.best.at.J)
        out.append(found if found and better else known)
    return out


def _weighted_from_archive(
    archive: Archive,
    models: Labelled,
    weights: Sequence[tuple[str, Floats]],
    sizes: Floats,
    checkpoint: Checkpoint,
) -> list[tuple[str, Solution]]:
    """Return the weighted models, searched again from an evaluated model that is better."""
    out = []
    for label, known in models:
        w = dict(weights)[label]
        descent = Descent(weighted(w), EXACT * float(w @ sizes))
        first = int((archive.J @ w).argmin())
        best = known
        if archive.J[first] @ w < known.at.J @ w and not descent.equal(
            archive.J[first], known.at.J
        ):
            search = partial(_descended, archive, descent, archive.theta[first])
            (found,) = checkpoint(f"improved-{label}", search)
            if descent.value(found.at.J) < descent.value(known.at.J):
                best = found
        out.append((label, best))
    return out


def _descended(problem: Problem, descent: Descent, theta: Floats) -> list[Solution]:
    return [descent.solve(problem, _begin(problem, theta), Options())]


def _begin(problem: Problem, theta: Floats) -> Solution:
    return begin(problem.evaluate(theta))


def _refined_again(
    problem: Problem, objective: int, sizes: Floats, start: Callable[[], Solution]
) -> list[Solution]:
    return refined_from(problem, objective, sizes, [start()])


def _without_copies(
    lattice: Simplex, solved: Sequence[Solution], along: Sequence[Solution], target: Payoff
) -> _Along:
    """Return the points of a front, each once, with the lattice points that led to them.

    ``solved`` are the solutions of the lattice points in their order, others after them; ``along``
    are the points of the front, of which some have taken the places of these.
    """
    kept: list[Solution] = []
    position = []
    for one in along:
        copies = (k for k, other in enumerate(kept) if _copies(one, other, target.scale))
        k = next(copies, len(kept))
        position.append(k)
        if k == len(kept):
            kept.append(one)
        elif one.converged and not kept[k].converged:
            kept[k] = one
    places = []
    for before in solved[: len(lattice.counts)]:
        same = (k for k, one in enumerate(along) if one is before or _of_place(one, before))
        k = next(same, -1)
        places.append(position[k] if k >= 0 else -1)
    return _Along(kept, [], target, lattice.beta, np.array(places, dtype=np.intp))


def _of_place(one: Solution, other: Solution) -> bool:
    """Return whether two solutions are of the same point of the simplex."""
    if one.beta is None or other.beta is None:
        return False
    return np.array_equal(one.beta, other.beta)


def _copies(one: Solution, other: Solution, scale: Floats) -> bool:
    return bool((np.abs(one.at.J - other.at.J) <= COPY * scale).all())


def _before(problem: Problem, known: Front, bests: Sequence[Solution]) -> list[Solution]:
    """Return the points of a known front, none where it had other edges."""
    edges = [[edge.best] for edge in known.edges]
    if any(distinct(was, best, problem, MOVED) for was, best in zip(edges, bests, strict=True)):
        return []
    return [one for _, one in known.points if one.beta is not None]


def _branches(
    archive: Archive,
    front: _Along,
    target: Payoff,
    refined: float | None,
    checkpoint: Checkpoint,
) -> _Along:
    """Return a front of two objectives, refined where wanted, with its gaps."""
    along = front.points
    optimal = nondominated(np.array([one.at.J for one in along]))
    known = archive.J.copy()
    breaks = gaps(archive, along, optimal, target.scale, checkpoint, known=known)
    if refined is None:
        return replace(front, gaps=breaks)
    for turn in range(TURNS):
        again = partial(_renamed, checkpoint, f"-turn-{turn + 1}")
        along, jumps = refine(archive, target, along, optimal, breaks, refined, again)
        optimal = nondominated(np.array([one.at.J for one in along]))
        before = len(breaks)
        breaks = gaps(archive, along, optimal, target.scale, again, jumps, known)
        if len(breaks) == before:
            break
    places = [
        -1 if i < 0 else next(k for k, one in enumerate(along) if one is front.points[i])
        for i in front.places
    ]
    return replace(front, points=along, gaps=breaks, places=np.array(places, dtype=np.intp))


def _renamed(
    checkpoint: Checkpoint, suffix: str, name: str, compute: Callable[[], Solutions]
) -> Solutions:
    return checkpoint(name + suffix, compute)
