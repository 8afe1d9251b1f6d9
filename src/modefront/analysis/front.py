"""Front analysis: the identifiable part of a front, equivalent models, uncertainty.

A front is flat where one objective hardly changes while others do (`docs/identifiability.md`). Of
three and more objectives, points of the new simplex that come to lie in the flat patch are left
out.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from modefront._typing import Floats, Ints
from modefront.analysis.manifold import Manifold, equivalent_models
from modefront.front.dominance import distinct_points
from modefront.front.front import Front, best_minima
from modefront.front.methods import METHODS
from modefront.front.options import Pareto
from modefront.front.point import Kind, Point, of_kind
from modefront.front.proposers.polish import Polish
from modefront.front.search import State
from modefront.front.simplex import Payoff, default_points, lattice, payoff
from modefront.front.subproblems import LatticePoint, near_best
from modefront.identifiability.combinations import Identifiability, without_effect
from modefront.identifiability.scale import scale_at
from modefront.optim.lexicographic import EXACT, TIE
from modefront.optim.problem import Evaluation, Problem, with_second_order
from modefront.optim.scalarisation import Scalarisation, weighted
from modefront.optim.sqp import Solution, begin, solve
from modefront.residuals.problem import UpdatingProblem
from modefront.uncertainty.noise import Noise, Source, Uncertainty, noise
from modefront.uncertainty.points import Role, SolvedPoint, edge_weights, solve_again
from modefront.uncertainty.scatter import Local, Posterior, Scatter, front_scatter, laplace
from modefront.work.task import IMMEDIATE, Executor, Task, seed_sequence

SPREAD = 0.2  # share of the range of another objective over which a flat part extends at least


@dataclass(frozen=True)
class Identifiable:
    """The part of a front that is not flat, where there is one that is."""

    # (n,) how many points of the whole front lie in the flat part at each edge, besides it
    flat: Ints
    uncut: Ints  # (n,) likewise, where the end of the part was not found, so that it is not cut
    points: Sequence[Point] = ()  # along it, unless it is one point; its ends that are no edges
    target: Payoff | None = None  # the simplex between its ends; None where the part is one point


def flat_points(J: Floats, least: Floats, tolerance: float, sizes: Floats) -> Ints:
    """Return how many rows of J (points, n) lie in the flat part at each edge, besides the edge.

    ``least`` (n,) are the least values; an objective that is fitted exactly, compared with
    ``sizes`` (n,), has no flat part. Fewer than two points make none, nor do such as spread over
    less than a fifth of the range of every other objective: neighbours of a minimum.

    >>> J = np.array([[1.0, 3.0], [1.001, 2.0], [1.002, 1.0], [1.5, 0.5], [2.0, 0.4]])
    >>> flat_points(J, np.array([1.0, 0.4]), 0.01, np.ones(2)).tolist()
    [2, 0]
    """
    within = (1 + tolerance) * least >= J
    count = within.sum(axis=0) - 1
    scaled = J / np.maximum(np.ptp(J, axis=0), np.finfo(float).tiny)
    spread = [np.ptp(scaled[chosen], axis=0).max() if chosen.any() else 0.0 for chosen in within.T]
    enough = (count >= 2) & (np.array(spread) >= SPREAD) & (least > EXACT * sizes)
    return np.where(enough, count, 0)


def same(solution: Solution, other: Solution) -> bool:
    """Return whether two solutions are of the same parameters."""
    return bool(np.array_equal(solution.theta, other.theta))


def identifiable_part(
    problem: Problem, front: Front, tolerance: float, divisions: int, work: Executor = IMMEDIATE
) -> Identifiable:
    """Return the part of a front that is not flat.

    A flat part of which the end is not found is not cut, and counted. ``divisions`` are the steps
    along each edge of the simplex.
    """
    known = [point.solution for point in front.points]
    along = [point.solution for point in of_kind(front.points, Kind.FRONT)]
    edges = [point.solution for point in of_kind(front.points, Kind.EDGE)]
    flat = np.zeros(len(edges), dtype=int)
    if not along or front.scale is None:
        return Identifiable(flat, flat)
    least = np.array([solution.J[i] for i, solution in enumerate(edges)])
    J, sizes = np.array([solution.J for solution in along]), front.scale
    flat = flat_points(J, least, tolerance, sizes)
    if not flat.any():
        return Identifiable(flat, flat)
    ends = list(edges)
    for i in np.flatnonzero(flat).tolist():
        arguments = (problem, edges[i], i, tolerance, sizes, known)
        key = ("identifiable", "edge", problem.objectives[i])
        (ends[i],) = work.run([Task(key, near_best, arguments)])
    moved = [not same(solution, edge) for solution, edge in zip(ends, edges, strict=True)]
    flat, uncut = np.where(moved, flat, 0), np.where(moved, 0, flat)
    target = payoff(ends, sizes) if flat.any() else None
    places = zip(problem.objectives, ends, flat.tolist(), strict=True)
    cuts = [Point(Kind.IDENTIFIABLE_EDGE, x, name) for name, x, cut in places if cut]
    if target is None:
        return Identifiable(flat, uncut, cuts)
    state = State(problem, work=work)
    for solution in [*ends, *known, *along]:
        state.archive.add(solution.J, solution)
    counts = lattice(len(edges), divisions)
    state.add([LatticePoint(row / divisions, tuple(row.tolist()), target) for row in counts])
    state.search("identifiable", [Polish()])
    along = distinct_points([place.incumbent for place in state.places], target.scale)
    floor = np.where(flat > 0, (1 - TIE) * target.utopia, 0.0)
    along = [x for x in along if (floor <= x.J).all()]
    points = [Point(Kind.IDENTIFIABLE, x, index=i) for i, x in enumerate(along, 1)]
    return Identifiable(flat, uncut, [*points, *cuts], target)


@dataclass(frozen=True)
class FrontAnalysis:
    """Identifiable part, equivalent models and uncertainty of a front."""

    identifiable: Identifiable
    tolerance: float  # the share within which objectives count as the same in a flat part
    # of equivalent models, by group or method; ``twin`` is a position in what `followed` returns
    manifolds: Sequence[tuple[str, Sequence[Manifold]]]
    source: Source | None  # of the uncertainty of the data; None where that is not known
    scatter: Mapping[str, Scatter]  # of the points by that uncertainty, by label
    # derivatives of predicted quantities at points, by label and quantity
    slopes: Mapping[str, Mapping[str, Floats]]
    # of the parameters around the optimally weighted model, where that is the reference
    posterior: Posterior | None
    # the points solved again with data drawn again, by label
    replicates: Sequence[Mapping[str, Solution]]


# 7 arguments: the front, the options of the study, and who does the work.
def analyse_front(
    problem: UpdatingProblem,
    front: Front,
    pareto: Pareto,
    identifiability: Identifiability,
    uncertainty: Uncertainty,
    seed: int,
    work: Executor,
) -> FrontAnalysis:
    """Return the analysis of a front, which was found with the ``pareto`` options."""
    a, source = problem.properties, uncertainty.of(problem.data)
    sizes = front.scale if source is not None else None
    samples = uncertainty.bootstrap
    solutions = 1 if sizes is None else len(front.points)
    work.expect({"second-derivatives": (solutions,) * 2, "bootstrap": (samples, samples)})
    none = np.zeros(len(problem.objectives), dtype=int)
    part = Identifiable(none, none)
    if identifiability.flat > 0 and METHODS[front.method].programme == "boundary":
        divisions = (pareto.points or default_points(len(problem.objectives))) - 1
        part = identifiable_part(problem, front, identifiability.flat, divisions, work)
    manifolds = _manifolds(problem, front, identifiability, work)
    reference = front.reference
    solved = [SolvedPoint(reference.label, reference.solution, Role("optimal"))]
    if sizes is not None:
        solved = _solved_points(problem, front, part, pareto, identifiability.flat)
    own = {x.label: x for x in solved if x.role.kind != "end"}
    tasks = [
        Task(("second-derivatives", text), _local, (problem, x, sizes, source))
        for text, x in own.items()
    ]
    found = zip(own, work.run(tasks), strict=True)
    # what the scatter of points follows from, where it is defined
    known = {text: local for text, local in found if local is not None}
    posterior = None
    if reference.kind is Kind.OPTIMAL and reference.label in known:
        posterior = laplace(problem, known[reference.label].evaluation, a)
    scatter: Mapping[str, Scatter] = {}
    replicates: list[Mapping[str, Solution]] = []
    if source is not None and sizes is not None:
        scatter = front_scatter(problem, front, solved, known, a, sizes)
        seeds = [(b, seed_sequence(seed, "bootstrap", b)) for b in range(1, samples + 1)]
        again = (problem, solved, sizes, source)
        replicates = work.run([Task(("bootstrap", b), solve_again, again, x) for b, x in seeds])
    flat, slopes = identifiability.flat, {name: local.slopes for name, local in known.items()}
    return FrontAnalysis(part, flat, manifolds, source, scatter, slopes, posterior, replicates)


def _manifolds(
    problem: UpdatingProblem, front: Front, options: Identifiability, work: Executor
) -> list[tuple[str, Sequence[Manifold]]]:
    """Return the manifolds of each group, and of the optimal weights, one after another."""
    out: list[tuple[str, Sequence[Manifold]]] = []
    found = best_minima(front, problem.properties, TIE) if options.models else []
    for i, (name, programme, best) in enumerate(found):
        minima = [x.evaluation for x in best]
        before = [manifold for _, manifold in followed(out)]
        arguments = (problem, programme, minima, options, before)
        (manifolds,) = work.run([Task(("manifold", i + 1, name), _equivalent, arguments)])
        out.append((name, manifolds))
    return out


def _equivalent(
    problem: UpdatingProblem,
    programme: Scalarisation,
    minima: Sequence[Evaluation],
    options: Identifiability,
    known: Sequence[Manifold],
) -> list[Manifold]:
    """Return the manifolds of models that are as good as some minima."""
    effects = [without_effect(problem, x, scale_at(problem, x.theta)) for x in minima]
    idle = np.array([all(j in each for each in effects) for j in range(problem.start.size)])
    return equivalent_models(
        problem, programme, minima, h=options.step, limit=options.models, known=known, idle=idle
    )


def followed(
    manifolds: Sequence[tuple[str, Sequence[Manifold]]],
) -> list[tuple[str, Manifold]]:
    """Return the manifolds that are not the same as one before, with their group or method."""
    return [(name, x) for name, some in manifolds for x in some if x.twin is None]


def _solved_points(
    problem: Problem, front: Front, part: Identifiable, pareto: Pareto, flat: float
) -> list[SolvedPoint]:
    """Return the points with what each of them solves, as far as that is a programme.

    Points of weights follow from their weights, points of normal-boundary intersection from their
    edges; those of the identifiable part solve bounds. The most probable model is none of them:
    its residuals have other units, and priors hold it, too. It has its posterior.
    """
    edges, out = of_kind(front.points, Kind.EDGE), list[SolvedPoint]()
    for i, (point, edge) in enumerate(zip(edges, front.edges, strict=True)):
        moved = pareto.tolerance > 0 and not same(point.solution, edge.best)
        text = f"{point.label}-best" if moved else point.label
        out.append(SolvedPoint(text, edge.best, Role("edge", objective=i)))
        if moved:
            level = Role("level", objective=i, tolerance=pareto.tolerance)
            out.append(SolvedPoint(point.label, point.solution, level))

    def between(x: Solution, ends: Mapping[str, Solution], target: Payoff | None) -> Role:
        """Return the role of a point of NBI between labelled ends, or of one of these ends."""
        at = [text for text, end in ends.items() if same(x, end)]
        worst = target.worst if target else ()
        return Role("end", (at[0],)) if at else Role("boundary", tuple(ends), worst)

    cuts = {point.name: point for point in of_kind(part.points, Kind.IDENTIFIABLE_EDGE)}
    whole = {edge.label: edge.solution for edge in edges}
    ends = {x.label: x.solution for x in (cuts.get(edge.name, edge) for edge in edges)}
    along = METHODS[front.method].programme
    for point in [*front.points, *part.points]:
        role, kind = None, point.kind
        if kind is Kind.OPTIMAL:
            role = Role("optimal")
        elif kind in (Kind.GIVEN, Kind.EQUAL) or (kind is Kind.FRONT and along == "weights"):
            role = Role("weights")
        elif kind is Kind.FRONT and along == "boundary":
            role = between(point.solution, whole, front.target)
            role = replace(role, equations=pareto.programme == "equations")
        elif kind is Kind.IDENTIFIABLE:
            role = between(point.solution, ends, part.target)
        elif kind is Kind.IDENTIFIABLE_EDGE:
            objective = problem.objectives.index(point.name)
            role = Role("level", objective=objective, tolerance=flat)
        if role:
            out.append(SolvedPoint(point.label, point.solution, role))
    return out


def _local(
    problem: UpdatingProblem, of: SolvedPoint, sizes: Floats | None, source: Source | None
) -> Local | None:
    """Return what the scatter of a point follows from, of an edge that is kept regular, if any."""
    evaluation = of.solution.evaluation
    if sizes is not None and of.role.kind == "edge":
        w = edge_weights(of.role.objective, sizes)
        evaluation = solve(problem, weighted(w), begin(evaluation)).evaluation
    point = with_second_order(problem, evaluation)
    if point is None:
        return None
    n, p = evaluation.dJ.shape
    modes, pairs = problem.modes(evaluation.theta)
    errors = Noise(np.zeros((0, n)), np.zeros((0, n, p)))
    if source is not None:
        errors = noise(problem, modes, pairs, source)
    return Local(point, errors, problem.slopes_at(modes, pairs))
