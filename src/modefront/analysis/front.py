"""Front analysis: the identifiable part of a front, equivalent models, uncertainty."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from modefront._typing import Floats
from modefront.analysis.neighbours import with_neighbours
from modefront.errors import ModelError
from modefront.fronts.front import Front
from modefront.fronts.methods import METHODS
from modefront.fronts.options import Pareto
from modefront.fronts.point import Kind, Point, label, of_kind
from modefront.identifiability.combinations import without_effect
from modefront.identifiability.options import Identifiability
from modefront.identifiability.scale import scale_at
from modefront.residuals.problem import UpdatingProblem
from modefront.solvers.continuation import default_points
from modefront.solvers.curvature import second_order
from modefront.solvers.flat import Identifiable, identifiable_part, same
from modefront.solvers.lexicographic import EXACT, TIE
from modefront.solvers.manifold import Manifold, equivalent_models
from modefront.solvers.payoff import Payoff
from modefront.solvers.problem import Evaluation
from modefront.solvers.scalarisation import LogSum, Scalarisation, weighted
from modefront.solvers.sqp import Solution, begin, solve
from modefront.uncertainty.bootstrap import redraw
from modefront.uncertainty.laplace import Posterior, laplace
from modefront.uncertainty.linear import DEPENDENT, Local, front_scatter
from modefront.uncertainty.noise import Noise, Source, noise
from modefront.uncertainty.options import Uncertainty
from modefront.uncertainty.points import Role, SolvedPoint, solve_again
from modefront.uncertainty.scatter import Scatter
from modefront.work.task import Executor, Task, seed_sequence


@dataclass(frozen=True)
class FrontAnalysis:
    """Identifiable part, equivalent models and uncertainty of a front.

    Attributes
    ----------
    points : of the identifiable part of the front, and its ends
    identifiable : that part; None where nothing is flat
    tolerance : the share within which objectives count as the same in a flat part
    manifolds : of equivalent models, by group or method; ``twin`` of one is a position in what
        `followed` returns
    source : where the uncertainty of the data is taken from; None where it is not known
    scatter : of the points by that uncertainty, by label
    slopes : derivatives of predicted quantities at points, by label and quantity
    posterior : of the parameters around the reference model; None where there is none
    replicates : the points solved again with data drawn again, by label
    """

    points: Sequence[Point]
    identifiable: Identifiable | None
    tolerance: float
    manifolds: Sequence[tuple[str, Sequence[Manifold]]]
    source: Source | None
    scatter: Mapping[str, Scatter]
    slopes: Mapping[str, Mapping[str, Floats]]
    posterior: Posterior | None
    replicates: Sequence[Mapping[str, Solution]]


@dataclass(frozen=True)
class AnalysisOptions:
    """Options of the front analysis.

    Attributes
    ----------
    pareto : options with which the front was found
    identifiability, uncertainty : of the study
    seed : of the run
    """

    pareto: Pareto
    identifiability: Identifiability
    uncertainty: Uncertainty
    seed: int


def analyse_front(
    problem: UpdatingProblem, front: Front, options: AnalysisOptions, work: Executor
) -> FrontAnalysis:
    """Return the analysis of a front."""
    a, uncertainty = problem.properties, options.uncertainty
    source = uncertainty.of(problem.data)
    work.expect(_extent(front, options, source))
    part = _identifiable_part(problem, front, options, work)
    points = _points(problem, front, part)
    solved = _solved_points(problem, front, points, part, options)
    derivatives = _Derivatives(problem, source, work, {})
    if source is not None and front.scale is not None:
        derivatives.expect(solved)
    manifolds = _manifolds(problem, front, options.identifiability, work, derivatives.ahead)
    scatter: Mapping[str, Scatter] = {}
    replicates: list[Mapping[str, Solution]] = []
    if source is not None and front.scale is not None:
        alone = front_scatter(problem, solved, a, front.scale, derivatives)
        scatter = with_neighbours(front, solved, alone, a, front.scale)
    posterior = None
    reference = front.reference
    if reference.kind in (Kind.OPTIMAL, Kind.BOUNDED):
        at_reference = SolvedPoint(reference.label, reference.solution, Role("optimal"))
        (local,) = derivatives([(at_reference, None)])
        floor = 0.0 if front.floor is None else front.floor
        posterior = laplace(problem, local[0], a, floor) if local else None
    if source is not None and front.scale is not None:
        replicates = _replicates(problem, solved, front.scale, source, options, work)
    return FrontAnalysis(
        points,
        part,
        options.identifiability.flat,
        manifolds,
        source,
        scatter,
        {name: local[0].slopes for name, local in derivatives.known.items() if local},
        posterior,
        replicates,
    )


def _extent(front: Front, options: AnalysisOptions, source: Source | None) -> dict[str, int]:
    """Return the expected number of tasks of each stage."""
    points = len(front.points) if source is not None and front.scale is not None else 1
    manifolds = len(front.edges) + 1 if options.identifiability.models else 0
    return {
        "manifold": manifolds,
        "second-derivatives": points,
        "bootstrap": options.uncertainty.bootstrap,
    }


def _identifiable_part(
    problem: UpdatingProblem, front: Front, options: AnalysisOptions, work: Executor
) -> Identifiable | None:
    """Return the part of the front that is not flat; None where nothing is flat."""
    along = [point.solution for point in of_kind(front.points, Kind.FRONT)]
    flat = options.identifiability.flat
    boundary = METHODS[front.method].programme == "boundary"
    if flat == 0 or len(along) < 2 or not boundary:
        return None
    n = len(problem.objectives)
    edges = [point.solution for point in of_kind(front.points, Kind.EDGE)]
    known = [point.solution for point in front.points]
    sizes = np.ones(n) if front.scale is None else front.scale
    divisions = (options.pareto.points or default_points(n)) - 1
    return identifiable_part(problem, along, edges, known, flat, sizes, divisions, work)


def _points(problem: UpdatingProblem, front: Front, part: Identifiable | None) -> list[Point]:
    """Return the points of the identifiable part, and its ends where they are no edges."""
    if part is None:
        return []
    out = [Point(Kind.IDENTIFIABLE, x, index=i + 1) for i, x in enumerate(part.points)]
    edges = [point.solution for point in of_kind(front.points, Kind.EDGE)]
    ends = zip(problem.objectives, part.ends, edges, strict=True)
    return out + [
        Point(Kind.IDENTIFIABLE_EDGE, x, name) for name, x, edge in ends if not same(x, edge)
    ]


def _manifolds(
    problem: UpdatingProblem,
    front: Front,
    options: Identifiability,
    work: Executor,
    ahead: Sequence[Task[Any]],
) -> list[tuple[str, Sequence[Manifold]]]:
    """Return the manifolds of equivalent models of each group and of the optimal weights.

    One follows after another; tasks ``ahead`` are asked for when all of them are known.
    """
    out: list[tuple[str, Sequence[Manifold]]] = []
    if options.models == 0:
        return out
    for i, (name, programme, minima) in enumerate(_equivalent_minima(problem, front)):
        before = [manifold for _, manifold in followed(out)]
        arguments = (problem, programme, minima, options, before)
        (manifolds,) = work.run([Task(("manifold", i + 1, name), _equivalent, arguments)], ahead)
        out.append((name, manifolds))
    return out


def _equivalent_minima(
    problem: UpdatingProblem, front: Front
) -> list[tuple[str, Scalarisation, list[Evaluation]]]:
    """Return each group, and the optimal weights, with its programme and all its best minima."""
    out: list[tuple[str, Scalarisation, list[Evaluation]]] = []
    a = problem.properties
    sizes = np.ones(a.size) if front.scale is None else front.scale
    for i, (name, edge) in enumerate(zip(problem.objectives, front.edges, strict=True)):
        level = (1 + TIE) * edge.best.J[i] + EXACT * sizes[i]
        minima = [x.evaluation for x in edge.minima if x.J[i] <= level]
        out.append((name, weighted(np.eye(a.size)[i] / sizes), minima))
    if front.optimal:
        programme = LogSum(a)
        level = programme.value(front.optimal[0].J) + TIE * a.sum()
        minima = [x.evaluation for x in front.optimal if programme.value(x.J) <= level]
        out.append((label(Kind.OPTIMAL), programme, minima))
    return out


def _equivalent(
    problem: UpdatingProblem,
    programme: Scalarisation,
    minima: Sequence[Evaluation],
    options: Identifiability,
    known: Sequence[Manifold],
) -> list[Manifold]:
    """Return the manifolds of models that are as good as some minima."""
    p = problem.start.size
    idle = np.ones(p, dtype=bool)
    for minimum in minima:
        scale = scale_at(problem, minimum.theta)
        idle &= np.isin(np.arange(p), without_effect(problem, minimum, scale))
    return equivalent_models(
        problem, programme, minima, h=options.step, limit=options.models, known=known, idle=idle
    )


def followed(
    manifolds: Sequence[tuple[str, Sequence[Manifold]]],
) -> list[tuple[str, Manifold]]:
    """Return the manifolds that are not the same as one before, with their group or method."""
    return [(name, x) for name, some in manifolds for x in some if x.twin is None]


def _solved_points(
    problem: UpdatingProblem,
    front: Front,
    extra: Sequence[Point],
    part: Identifiable | None,
    options: AnalysisOptions,
) -> list[SolvedPoint]:
    """Return the points with what each of them solves, as far as that is a programme.

    Points of weights follow from their weights, points of normal-boundary intersection from their
    edges, or from the models up to which the ranges of the objectives reach.
    """
    names = problem.objectives
    tolerance, flat = options.pareto.tolerance, options.identifiability.flat
    edges = {point.name: point for point in of_kind(front.points, Kind.EDGE)}
    cuts = {point.name: point for point in of_kind(extra, Kind.IDENTIFIABLE_EDGE)}
    whole = tuple(edges[name].label for name in names)
    ends = tuple(cuts.get(name, edges[name]).label for name in names)
    cut = list(zip(ends, part.ends, strict=True)) if part else []
    minima = [
        SolvedPoint(f"minimum-{k + 1}-{name}", x, Role("minimum", objective=i))
        for i, (name, edge) in enumerate(zip(names, front.edges, strict=True))
        for k, x in enumerate(edge.minima)
    ]
    known = [(point.label, point.solution) for point in edges.values()]
    known += [(point.label, point.solution) for point in minima]
    worst = _labels_of(front.target, known)
    reach = _labels_of(part.target if part else None, cut)
    out = [point for point in minima if worst and point.label in worst]
    for i, (name, edge) in enumerate(zip(names, front.edges, strict=True)):
        solution, text = edges[name].solution, edges[name].label
        if tolerance > 0 and not same(solution, edge.best):
            out.append(SolvedPoint(f"{text}-best", edge.best, Role("edge", objective=i)))
            level = Role("level", objective=i, tolerance=tolerance)
            out.append(SolvedPoint(text, solution, level))
        else:
            out.append(SolvedPoint(text, edge.best, Role("edge", objective=i)))
    along = METHODS[front.method].programme
    for point in [*front.points, *extra]:
        role: Role | None = None
        match point.kind:
            case Kind.OPTIMAL:
                role = Role("optimal")
            case Kind.GIVEN | Kind.EQUAL | Kind.BOUNDED:
                role = Role("weights")
            case Kind.FRONT if along == "boundary":
                role = _between(point.solution, whole, worst, known)
            case Kind.FRONT if along == "weights":
                role = Role("weights")
            case Kind.IDENTIFIABLE:
                role = _between(point.solution, ends, reach, cut)
            case Kind.IDENTIFIABLE_EDGE:
                role = Role("level", objective=names.index(point.name), tolerance=flat)
        if role:
            out.append(SolvedPoint(point.label, point.solution, role))
    return out


def _between(
    solution: Solution,
    ends: tuple[str, ...],
    worst: tuple[str, ...] | None,
    known: Sequence[tuple[str, Solution]],
) -> Role | None:
    """Return the role of a point of NBI between labelled ends, or of one of these ends.

    None where the ranges of its simplex follow from no programme.
    """
    labels = [text for text, end in known if text in ends and same(solution, end)]
    if labels:
        return Role("end", (labels[0],))
    return None if worst is None else Role("boundary", ends, worst)


def _labels_of(
    target: Payoff | None, known: Sequence[tuple[str, Solution]]
) -> tuple[str, ...] | None:
    """Return the labels of the models up to which ranges reach that a simplex is made of.

    None where one of them is a corner (`modefront.solvers.payoff.corners`), which solves nothing
    that data determine.
    """
    worst = target.worst if target else ()
    labels = [next((text for text, x in known if same(x, end)), "") for end in worst]
    return tuple(labels) if all(labels) else None


@dataclass(frozen=True)
class _Derivatives:
    """Second derivatives and noise at points, each computed once."""

    problem: UpdatingProblem
    source: Source | None
    work: Executor
    known: dict[str, Local | None]
    ahead: list[Task[Local | None]] = field(default_factory=list)

    def expect(self, points: Sequence[SolvedPoint]) -> None:
        """Note the points that are asked for last, as far as they need no weights."""
        chosen = [point for point in points if point.role.kind in DEPENDENT[-1]]
        self.ahead.extend(self._task(point, None) for point in chosen)

    def __call__(self, points: Sequence[tuple[SolvedPoint, Floats | None]]) -> list[Local | None]:
        """Return derivatives and noise of each point, solved with weights (n,) where given."""
        new = [(point, w) for point, w in points if point.label not in self.known]
        tasks = [self._task(point, w) for point, w in new]
        chosen = {task.key for task in tasks}
        ahead = [task for task in self.ahead if task.key not in chosen]
        for (point, _), local in zip(new, self.work.run(tasks, ahead), strict=True):
            self.known[point.label] = local
        return [self.known[point.label] for point, _ in points]

    def _task(self, point: SolvedPoint, w: Floats | None) -> Task[Local | None]:
        key = ("second-derivatives", point.label)
        return Task(key, _differentiate, (self.problem, point.solution, w, self.source))


def _differentiate(
    problem: UpdatingProblem, start: Solution, w: Floats | None, source: Source | None
) -> Local | None:
    """Return second derivatives and noise at a point; None where the model is not defined."""
    evaluation = start.evaluation
    if w is not None:
        evaluation = solve(problem, weighted(w), begin(evaluation)).evaluation
    point = second_order(problem, evaluation)
    if point is None:
        return None
    n, p = evaluation.dJ.shape
    if source is None:
        return point, Noise(np.zeros((0, n)), np.zeros((0, n, p)))
    try:
        return point, noise(problem, evaluation.theta, source)
    except ModelError:
        return None


def _replicates(
    problem: UpdatingProblem,
    points: Sequence[SolvedPoint],
    sizes: Floats,
    source: Source,
    options: AnalysisOptions,
    work: Executor,
) -> list[Mapping[str, Solution]]:
    """Return the points solved again with data drawn again, by label."""
    count = range(1, options.uncertainty.bootstrap + 1)
    arguments = (problem, points, sizes, source)
    tasks = [
        Task(("bootstrap", b), _replicate, arguments, seed_sequence(options.seed, "bootstrap", b))
        for b in count
    ]
    return [
        {point.label: solution for point, solution in zip(points, solved, strict=True)}
        for solved in work.run(tasks)
    ]


def _replicate(
    problem: UpdatingProblem,
    points: Sequence[SolvedPoint],
    sizes: Floats,
    source: Source,
    *,
    rng: np.random.Generator,
) -> list[Solution]:
    again = replace(problem, data=redraw(problem.data, source, rng))
    return solve_again(again, points, problem.properties, sizes)
