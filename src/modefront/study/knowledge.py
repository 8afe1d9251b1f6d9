"""What is known beyond the points of a front: its flat parts, equally good models, scatter."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from modefront._typing import Floats
from modefront.errors import ModelError
from modefront.identifiability.combinations import without_effect
from modefront.identifiability.options import Identifiability
from modefront.identifiability.scale import scale_at
from modefront.residuals.problem import UpdatingProblem
from modefront.solvers.advance import default_points
from modefront.solvers.checkpoint import Checkpoint
from modefront.solvers.curvature import SecondOrder, second_order
from modefront.solvers.evolutionary import EVOLUTIONARY
from modefront.solvers.flat import Identifiable, identifiable_part, same
from modefront.solvers.lexicographic import EXACT, TIE
from modefront.solvers.manifold import Extent, Manifold, equally_good
from modefront.solvers.payoff import Payoff
from modefront.solvers.problem import Evaluation
from modefront.solvers.scalarisation import LogSum, Scalarisation, weighted
from modefront.solvers.sqp import Solution, begin, solve
from modefront.study.doubtful import with_neighbours
from modefront.study.run import BOUNDED, OPTIMAL, Front, Labelled, generator
from modefront.uncertainty.bootstrap import redraw
from modefront.uncertainty.laplace import Posterior, laplace
from modefront.uncertainty.linear import Local, front_scatter
from modefront.uncertainty.noise import Noise, Source, noise
from modefront.uncertainty.options import Uncertainty
from modefront.uncertainty.points import Point, Role, solve_again
from modefront.uncertainty.scatter import Scatter

PART = "identifiable-"
"""Beginning of the labels of points of the identifiable part of the front."""


@dataclass(frozen=True)
class Knowledge:
    """What is known beyond the points of a front.

    Attributes
    ----------
    points : labelled points of the identifiable part of the front and its ends
    identifiable : that part; None where nothing is flat
    tolerance : the share within which objectives count as the same in a flat part
    manifolds : of equally good models, by group or method; ``twin`` of one is a position in what
        `followed` returns
    source : where the uncertainty of the data is taken from; None where it is not known
    scatter : of the points by that uncertainty, by label
    slopes : derivatives of predicted quantities at points, by label and quantity
    posterior : of the parameters around the optimally weighted model; None where there is none
    replicates : the points solved again with data drawn again, by label
    """

    points: Labelled
    identifiable: Identifiable | None
    tolerance: float
    manifolds: Sequence[tuple[str, Sequence[Manifold]]]
    source: Source | None
    scatter: Mapping[str, Scatter]
    slopes: Mapping[str, Mapping[str, Floats]]
    posterior: Posterior | None
    replicates: Sequence[Mapping[str, Solution]]


SOLVING_NONE = tuple(f"{method}-" for method in EVOLUTIONARY)
"""Beginnings of the labels of points of which the scatter is not known."""


def learn(
    problem: UpdatingProblem,
    front: Front,
    *,
    points: int | None,
    tolerance: float,
    seed: int,
    identifiability: Identifiability,
    uncertainty: Uncertainty,
    checkpoint: Checkpoint,
    expect: Callable[[int], None],
) -> Knowledge:
    """Find out what a front leaves open.

    ``points`` and ``tolerance`` are those that it was found with; ``expect`` is told
    about how many more pieces of work there are.
    """
    a = problem.properties
    sizes = np.ones(a.size) if front.scale is None else front.scale
    source = uncertainty.of(problem.data)
    expect(len(front.points) * (source is not None) + a.size + 2 + uncertainty.bootstrap)

    labels = dict(front.points)
    bests = [labels[f"edge-{name}"] for name in problem.objectives]
    along = [one for label, one in front.points if label.startswith("nbi-")]
    part = None
    if identifiability.flat > 0 and len(along) > 1:
        part = identifiable_part(
            *(problem, along, bests, [one for _, one in front.points]),
            *(identifiability.flat, sizes, (points or default_points(a.size)) - 1, checkpoint),
        )
    extra = _labelled(problem, part, bests)

    manifolds: list[tuple[str, Sequence[Manifold]]] = []
    if identifiability.models > 0:
        for i, (name, programme, minima) in enumerate(_equal_minima(problem, front, a, sizes)):
            before = [one for _, one in followed(manifolds)]
            sample = partial(_manifolds, problem, programme, minima, identifiability, before)
            packed = checkpoint(f"manifold-{i + 1}-{name}", sample)
            manifolds.append((name, _unpack_manifolds(packed)))

    known = _roles(problem, front, extra, part, tolerance, identifiability.flat)
    slopes: dict[str, Mapping[str, Floats]] = {}
    done: dict[str, Local | None] = {}

    def differentiate(label: str, start: Solution, w: Floats | None) -> Local | None:
        if label not in done:
            name = f"second-{label}"
            found = checkpoint(name, lambda: _differentiate(problem, start, w, source))
            done[label] = local = _unpack_local(found[0], a.size) if found else None
            if local:
                slopes[label] = local[0].slopes
        return done[label]

    scatter: Mapping[str, Scatter] = {}
    if source is not None and front.scale is not None:
        alone = front_scatter(problem, known, a, sizes, differentiate)
        scatter = with_neighbours(front, known, alone, a, sizes)
    posterior = None
    if front.reference in (OPTIMAL, BOUNDED):
        local = differentiate(front.reference, labels[front.reference], None)
        floor = 0.0 if front.floor is None else front.floor
        posterior = laplace(problem, local[0], a, floor) if local else None
    replicates = []
    if source is not None and front.scale is not None:
        for b in range(uncertainty.bootstrap):
            name = f"bootstrap-{b + 1}"
            again = partial(_replicate, problem, known, a, sizes, source, seed, name)
            solved = zip(known, checkpoint(name, again), strict=True)
            replicates.append({point.label: one for point, one in solved})
    return Knowledge(
        extra,
        part,
        identifiability.flat,
        manifolds,
        source,
        scatter,
        slopes,
        posterior,
        replicates,
    )


def _labelled(
    problem: UpdatingProblem, part: Identifiable | None, edges: Sequence[Solution]
) -> Labelled:
    if part is None:
        return []
    out = [(f"{PART}{i + 1}", one) for i, one in enumerate(part.points)]
    ends = zip(problem.objectives, part.ends, edges, strict=True)
    return out + [(f"{PART}edge-{name}", one) for name, one, edge in ends if not same(one, edge)]


def _equal_minima(
    problem: UpdatingProblem, front: Front, a: Floats, sizes: Floats
) -> list[tuple[str, Scalarisation, list[Evaluation]]]:
    """Return each group, and the optimal weights, with its programme and all its best minima."""
    out: list[tuple[str, Scalarisation, list[Evaluation]]] = []
    for i, (name, edge) in enumerate(zip(problem.objectives, front.edges, strict=True)):
        level = (1 + TIE) * edge.best.at.J[i] + EXACT * sizes[i]
        minima = [one.at for one in edge.minima if one.at.J[i] <= level]
        out.append((name, weighted(np.eye(a.size)[i] / sizes), minima))
    if front.optimal:
        programme = LogSum(a)
        level = programme.value(front.optimal[0].at.J) + TIE * a.sum()
        minima = [one.at for one in front.optimal if programme.value(one.at.J) <= level]
        out.append((OPTIMAL, programme, minima))
    return out


def _roles(
    problem: UpdatingProblem,
    front: Front,
    extra: Labelled,
    part: Identifiable | None,
    tolerance: float,
    flat: float,
) -> list[Point]:
    """Return the points with what each of them solves, as far as that is a programme.

    Points of weights follow from their weights, points of NBI from their edges, or from the models
    up to which the ranges of the objectives reach; evolved points solve none.
    """
    names = problem.objectives
    labels = dict(front.points)
    whole = tuple(f"edge-{name}" for name in names)
    added = {label for label, _ in extra}
    ends = tuple(PART + label if PART + label in added else label for label in whole)
    cut = list(zip(ends, part.ends, strict=True)) if part else []
    minima = [
        Point(f"minimum-{k + 1}-{name}", one, Role("minimum", objective=i))
        for i, (name, edge) in enumerate(zip(names, front.edges, strict=True))
        for k, one in enumerate(edge.minima)
    ]
    known = [*((label, labels[label]) for label in whole), *((x.label, x.solution) for x in minima)]
    worst = _labels_of(front.target, known)
    out = [point for point in minima if point.label in worst]
    for i, (label, edge) in enumerate(zip(whole, front.edges, strict=True)):
        solution = labels[label]
        if tolerance > 0 and not same(solution, edge.best):
            out.append(Point(f"{label}-best", edge.best, Role("edge", objective=i)))
            out.append(Point(label, solution, Role("level", objective=i, tolerance=tolerance)))
        else:
            out.append(Point(label, edge.best, Role("edge", objective=i)))
    reach = _labels_of(part.target if part else None, cut)
    for label, solution in [*front.points, *extra]:
        if label in whole:
            continue
        if label == OPTIMAL:
            role = Role("optimal")
        elif label.startswith("nbi-"):
            role = _between(solution, whole, worst, known)
        elif label.startswith(SOLVING_NONE):
            continue
        elif label.startswith(f"{PART}edge-"):
            i = names.index(label.removeprefix(f"{PART}edge-"))
            role = Role("level", objective=i, tolerance=flat)
        elif label.startswith(PART):
            role = _between(solution, ends, reach, cut)
        else:
            role = Role("weights")
        out.append(Point(label, solution, role))
    return out


def _between(one: Solution, ends: tuple[str, ...], worst: tuple[str, ...], known: Labelled) -> Role:
    """Return the role of a point of NBI between labelled ends, or of one of these ends."""
    own = [label for label, end in known if label in ends and same(one, end)]
    return Role("end", (own[0],)) if own else Role("boundary", ends, worst)


def _labels_of(target: Payoff | None, known: Labelled) -> tuple[str, ...]:
    """Return the labels of the models up to which ranges reach that a simplex is made of."""
    worst = target.worst if target else ()
    return tuple(next(label for label, one in known if same(one, end)) for end in worst)


def _differentiate(
    problem: UpdatingProblem, start: Solution, w: Floats | None, source: Source | None
) -> list[Solution]:
    """Return a point with second derivatives and noise, packed, or nothing where it has none."""
    at = start.at
    if w is not None:
        at = solve(problem, weighted(w), begin(at)).at
    point = second_order(problem, at)
    if point is None:
        return []
    quantities = {**at.quantities, **{f"slope {name}": x for name, x in point.slopes.items()}}
    if source is not None:
        try:
            own = noise(problem, at.theta, source)
        except ModelError:
            return []
        quantities |= {"noise J": own.J, "noise dJ": own.dJ}
    return [replace(start, at=replace(at, quantities=quantities), learned=point.H - at.H)]


def _unpack_local(packed: Solution, n: int) -> Local:
    at, p = packed.at, packed.at.theta.size
    slopes = {
        name.removeprefix("slope "): value
        for name, value in at.quantities.items()
        if name.startswith("slope ")
    }
    own = Noise(
        at.quantities.get("noise J", np.zeros((0, n))),
        at.quantities.get("noise dJ", np.zeros((0, n, p))),
    )
    return SecondOrder(at, at.H + packed.learned, slopes), own


def followed(
    manifolds: Sequence[tuple[str, Sequence[Manifold]]],
) -> list[tuple[str, Manifold]]:
    """Return the manifolds that are not the same as one before, with their group or method."""
    return [(name, one) for name, some in manifolds for one in some if one.twin is None]


def _manifolds(
    problem: UpdatingProblem,
    programme: Scalarisation,
    minima: Sequence[Evaluation],
    how: Identifiability,
    known: Sequence[Manifold],
) -> list[Solution]:
    """Return equally good models as solutions, with what is known of their manifold."""
    out = []
    p = problem.start.size
    idle = np.ones(p, dtype=bool)
    for at in minima:
        idle &= np.isin(np.arange(p), without_effect(problem, at, scale_at(problem, at.theta)))
    found = equally_good(
        *(problem, programme, minima), h=how.step, limit=how.models, known=known, idle=idle
    )
    for number, one in enumerate(found):
        kind = [number, one.dimension, list(Extent).index(one.extent), one.evaluations, one.minima]
        kind.append(-1 if one.twin is None else one.twin)
        for at in one.models:
            kept = {**at.quantities, "manifold": np.array(kind, dtype=float)}
            out.append(begin(replace(at, quantities=kept)))
    return out


def _unpack_manifolds(packed: Sequence[Solution]) -> list[Manifold]:
    kinds = [one.at.quantities["manifold"].astype(int).tolist() for one in packed]
    out = []
    for number in sorted({kind[0] for kind in kinds}):
        own = [i for i, kind in enumerate(kinds) if kind[0] == number]
        _, dimension, extent, evaluations, minima, twin = kinds[own[0]]
        models = [packed[i].at for i in own]
        known = None if twin < 0 else twin
        kind = list(Extent)[extent]
        out.append(Manifold(dimension, models, kind, evaluations, minima, known))
    return out


def _replicate(
    problem: UpdatingProblem,
    known: Sequence[Point],
    a: Floats,
    sizes: Floats,
    source: Source,
    seed: int,
    name: str,
) -> list[Solution]:
    data = redraw(problem.data, source, generator(seed, name))
    return solve_again(replace(problem, data=data), known, a, sizes)
