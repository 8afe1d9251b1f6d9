"""The search for a Pareto front: edges and weighted models first, then the points between them."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import chain, count, pairwise
from typing import Any

import numpy as np

from modefront._typing import Floats
from modefront.errors import UnfinishedError
from modefront.front.dominance import distinct_points
from modefront.front.front import Edge, Front
from modefront.front.gaps import Gap, gaps
from modefront.front.methods import METHODS, evolve_front
from modefront.front.options import MOST, Pareto
from modefront.front.point import Kind, Point, label
from modefront.front.proposers.evolution import Evolution
from modefront.front.proposers.polish import Polish
from modefront.front.proposers.starts import SURE, Starts
from modefront.front.search import EDGES, POINTS, Place, Proposer, Search, State, at, evaluated
from modefront.front.simplex import Payoff, default_points, is_flat, lattice, nearest, payoff
from modefront.front.subproblems import LOOSE, LatticePoint, Least, Weights, near_best, sample
from modefront.front.weights import accepted, iterate_weights, least_along
from modefront.optim.lexicographic import EXACT, TIE
from modefront.optim.problem import DISTINCT, Problem
from modefront.optim.scalarisation import LogSum
from modefront.optim.sqp import TIGHT, Solution, solve
from modefront.work.task import IMMEDIATE, Executor, Key, Task, Within, seed_sequence

ANCHORS = ("edge", "weights", "others")  # kinds of subproblems that are no points between edges


# 9 arguments: the problem and what is known of it, and each group of options of a search.
def pareto_front(
    problem: Problem,
    a: Floats,
    options: Pareto | None = None,
    *,
    seed: int = 0,
    search: Search | None = None,
    given: Sequence[tuple[str, Floats]] = (),
    work: Executor = IMMEDIATE,
    known: Front | None = None,
    least: Floats | None = None,
) -> Front:
    """Return the edges, the weighted models, the front by a method, and its gaps.

    ``a`` (n,) counts the measured properties of each objective; ``given`` are named weights (n,).
    With a ``known`` front of nearly the same problem, its models and the minima of its edges are
    solved for again, and nothing else is sought. Where no objectives fall below ``least`` (n,), a
    minimum that is as low is not sought again. Raises UnfinishedError where no edge can be found.
    """
    state = State(problem, search or Search(), work, least)
    return _Run(problem, a, options or Pareto(), seed, given, known, state).front()


@dataclass
class _Run:
    """A search for a front; see `pareto_front`."""

    problem: Problem
    a: Floats
    options: Pareto
    seed: int
    given: Sequence[tuple[str, Floats]]
    known: Front | None
    state: State
    cut: bool = False

    def __post_init__(self) -> None:
        self.n, self.sizes = len(self.problem.objectives), np.zeros(0)
        named = [(Kind.GIVEN, name, w) for name, w in self.given]
        self.weighted = [*named, (Kind.EQUAL, "", np.ones(self.n))]
        rng = np.random.default_rng(seed_sequence(self.seed, "search"))
        self.children = np.random.default_rng(seed_sequence(self.seed, "evolution"))
        names, edges = self.problem.objectives, self.known.edges if self.known else ()
        pairs = zip(names, edges, strict=False)
        again: dict[Key, Sequence[Solution]] = {("edge", x): edge.minima for x, edge in pairs}
        self.starts = Starts(rng, again if self.known else None)

    def front(self) -> Front:
        """Return all that is found."""
        sizes = self.sizes = self._sizes()
        models = [point.solution for point in self.known.points] if self.known else []
        self._evaluated(("known",), [at(x.theta) for x in self.state.distinct(models)])
        self.state.add([Least(i, sizes, x) for i, x in enumerate(self.problem.objectives)])
        keys = [(("weights", kind.value, name), w) for kind, name, w in self.weighted]
        self.state.add([Weights(w, key, EXACT * float(w @ sizes)) for key, w in keys])
        self._search("edges", EDGES, self.starts)
        for place in self.state.places:
            if not place.incumbent.feasible:
                name = " ".join(str(part) for part in place.subproblem.key if part)
                raise UnfinishedError(
                    f"no model was found for {name}: is the model defined between the bounds?"
                )
        target = self._between()
        options, evolved = self.options, None
        if METHODS[options.method].programme is None and target is not None:
            rng = np.random.default_rng(seed_sequence(self.seed, options.method))
            extent = (options.population, options.evaluations)
            evolved = evolve_front(self.problem, options.method, *extent, rng, self._needed)
        bests = self._reported("last")
        programme = LogSum(self.a, vanishing=EXACT * sizes)
        optimal = self._optimal(programme, bests, evolved or self._points(target, bests)[0])
        arguments = (self.problem, programme, self._weighted()[-1].solution)
        (iterated,) = self._run([Task(("iterated-weights",), iterate_weights, arguments)])
        if not all(x.closed for x in self.state.places):
            self.state.search("rest", (Polish(),), (1 + POINTS) / 2)
        # At the budget, no search has started from some incumbents.
        rest = [x for x in self.state.places if not x.incumbent.evaluation.derivatives]
        begun = {x.incumbent.theta.tobytes(): x.incumbent for x in rest}
        begun = dict(zip(begun, self._evaluated(("front",), begun.values()), strict=True))
        for place in rest:
            place.incumbent = begun[place.incumbent.theta.tobytes()]
        bests = self._reported("end")
        points, places, beta = self._points(target, bests)
        edges, weighted = self._edges(), self._weighted()
        weighted += [Point(Kind.OPTIMAL, x) for x in optimal[:1]]
        ends = zip(self.problem.objectives, bests, strict=True)
        method, between = options.method, list[Gap]()
        along = [Point(Kind.FRONT, x, method, i + 1) for i, x in enumerate(evolved or points)]
        if self.n == 2 and target is not None and len(points) > 1 and method == "nbi":
            bounded = options.programme == "bounds"
            between = gaps(self.problem, points, target, bounded, self._run)
        return Front(
            method,
            [*along, *(Point(Kind.EDGE, x, name) for name, x in ends), *weighted],
            edges,
            optimal,
            iterated,
            tuple(edge.best.J[i] <= EXACT * sizes[i] for i, edge in enumerate(edges)),
            target,
            between,
            beta,
            places,
            self.state.archive.J,
            sizes,
            self._open(),
        )

    def _search(self, stage: str, share: float, *more: Proposer) -> None:
        """Search for all places up to a share of the budget, with what is proposed always and more.

        What proposers have gained so far says nothing of places that are new, so they start anew.
        What is better at the end of it is solved in half of what is left.
        """
        evolution = () if self.known else (Evolution(self.children, self.starts.unseen, not more),)
        polish = Polish()
        self.state.search(stage, (polish, *more, *evolution), share)
        self.state.search(stage, (polish,), (1 + share) / 2)

    def _open(self) -> tuple[str, ...]:
        """Return what the search had not finished at its budget, as labels; once for all points."""
        names: dict[Key, str] = {("edge", x): label(Kind.EDGE, x) for x in self.problem.objectives}
        names |= {("weights", k.value, x): label(k, x) for k, x, _ in self.weighted}
        left = self.state.open | {x.subproblem.key for x in self.state.places if not x.closed}
        more = ("points between the edges",) * bool(left - names.keys())
        more += ("what follows from the points",) * self.cut
        return (*(text for key, text in names.items() if key in left), *more)

    def _run(self, tasks: Sequence[Task[Any]]) -> list[Any]:
        """Return the results of tasks, None where the evaluations of one were spent."""
        return self._needed(tasks, self.state.limits.evaluations - self.state.evaluations)

    def _needed(self, tasks: Sequence[Task[Any]], most: int | None = None) -> list[Any]:
        """Return the results of tasks, whatever they cost unless there are ``most`` evaluations.

        Their models compete; no search has started from those that take a place, which is open.
        """
        outcomes = self.state.run(tasks, most)
        for outcome in outcomes:
            self.cut |= outcome.spent
            self.state.tell(None, None, outcome)
        return [outcome.result for outcome in outcomes]

    def _sizes(self) -> Floats:
        """Return the typical size of each objective, (n,), of random models, unless it is known."""
        seed = seed_sequence(0 if self.known else 1, "sample")
        (sizes,) = self._needed([Task(("sample",), sample, (self.problem,), seed)])
        if self.known:
            return self.known.sizes
        if not sizes.size:
            raise UnfinishedError(
                "the model cannot be evaluated at any of the parameters tried within the bounds"
            )
        return np.asarray(sizes)

    def _between(self) -> Payoff | None:
        """Search the points between the edges, until these stay where they are."""
        if self.n == 1:
            return None
        divisions = (self.options.points or default_points(self.n)) - 1
        counts = list(map(tuple, lattice(self.n, divisions).tolist()))
        target: Payoff | None = None
        for turn in count():
            bests = self._reported(turn)
            new = payoff(bests, self.sizes, self._worst(bests))
            if new is None:
                self.state.places = self._of(*ANCHORS)
                return target
            if target is not None:
                utopia = np.abs((new.utopia - target.utopia) / new.scale).max()
                if max(utopia, np.abs(new.scale / target.scale - 1).max()) < DISTINCT:
                    break
            target = new
            if METHODS[self.options.method].programme is None:
                break  # its points are the models of a population
            self.state.places = self._of(*ANCHORS)
            more = (self._apart(target, len(counts), 1 / divisions), self._halfway(target))
            for new_points in chain([counts], *more):
                self.state.add([self._subproblem(target, row) for row in new_points])
                self._search("front", POINTS)
        return target

    def _worst(self, bests: Sequence[Solution]) -> list[Solution]:
        """Return the model worst in each objective, where the simplex between the edges is flat.

        It is one of the edges and of the best models without regard to one objective each.
        """
        if not is_flat(bests, self.sizes):
            return []
        if not self._of("others"):
            weights = np.where(np.eye(self.n, dtype=bool), TIE, 1.0) / self.sizes
            named = zip(self.problem.objectives, weights, strict=True)
            self.state.add([Weights(w, ("others", name), EXACT * self.n) for name, w in named])
            self._search("ranges", POINTS, self.starts)
        models = [*bests, *(x.incumbent for x in self._of("others"))]
        return [max(models, key=lambda x: float(x.J[i])) for i in range(self.n)]

    def _subproblem(self, target: Payoff, row: tuple[int, ...]) -> Weights | LatticePoint:
        """Return the point of the front at a point of the lattice."""
        beta = np.array(row) / sum(row)
        if self.options.method == "weights":
            w = np.maximum(beta, TIE)
            return Weights(w, ("sweep", *row), EXACT * float(w @ target.scale))
        return LatticePoint(beta, row, target, self.options.programme == "equations")

    def _of(self, *kinds: str) -> list[Place]:
        """Return the places of some kinds of subproblems."""
        return [x for x in self.state.places if x.subproblem.key[0] in kinds]

    def _apart(self, target: Payoff, asked: int, step: float) -> Iterator[list[tuple[int, ...]]]:
        """Yield points at models that all points are far from, until as many as asked are distinct.

        The simplex between the edges of more than two objectives does not cover the whole front:
        where a model is farther than a step of the lattice, up to twice as many are sought. It is
        as far from a point as that is behind it in some objective, over the ranges (the additive
        epsilon indicator; Zitzler et al. 2003, doi:10.1109/TEVC.2003.810758).
        """
        known = 0
        while self.n > 2:
            solutions = [x.incumbent for x in self._of("point")]
            points = np.array([x.J for x in distinct_points(solutions, target.scale)])
            if len(points) <= known:
                break
            known = count = len(points)
            J = self.state.archive.J / target.scale
            behind = (points / target.scale - J[:, None]).max(axis=2).min(axis=1)
            added: set[tuple[int, ...]] = set()
            while count < 2 * asked and behind.max() > (LOOSE if count < asked else step):
                k = int(behind.argmax())
                added.add(nearest(target.place(J[k] * target.scale), MOST))
                behind, count = np.minimum(behind, (J[k] - J).max(axis=1)), count + 1
            yield sorted(added)

    def _halfway(self, target: Payoff) -> Iterator[list[tuple[int, ...]]]:
        """Yield points half-way between neighbours of two objectives that are too far apart."""
        size, work = self.options.refined, self.state.work
        for _ in range(int(np.ceil(-np.log2(size))) if size else 0):
            pairs = [(x.incumbent, x.subproblem) for x in self.state.places]
            here = [(x, point) for x, point in pairs if isinstance(point, LatticePoint)]
            new = []
            for (x, one), (y, other) in pairwise(sorted(here, key=lambda pair: -pair[1].beta[0])):
                apart = np.linalg.norm((x.J - y.J) / target.scale)
                if size and apart > size and one.met(x) and other.met(y):
                    middle = np.array(one.place) * sum(other.place)
                    middle += np.array(other.place) * sum(one.place)
                    new.append(tuple((middle // np.gcd.reduce(middle)).tolist()))
            if not new:
                break
            # What follows is another repetition of what an earlier run may have kept without it.
            self.state.work = Within(work, ("refined", repr(size)))
            yield new

    def _weighted(self) -> list[Point]:
        """Return the models of given and of equal weights."""
        pairs = zip(self.weighted, self.state.places[self.n :], strict=False)
        return [Point(kind, place.incumbent, name) for (kind, name, _), place in pairs]

    def _evaluated(self, key: Key, models: Iterable[Solution]) -> list[Solution]:
        """Return starts at models, with derivatives."""
        tasks = [Task((*key, k + 1), evaluated, (self.problem, x)) for k, x in enumerate(models)]
        return self._needed(tasks)

    def _edges(self) -> list[Edge]:
        """Return the edge of each objective with its other minima."""
        out = []
        for k, place in enumerate(self.state.places[: self.n]):
            known = self.starts.of(place)
            ends = sorted(known.ends, key=lambda x: float(x.J[k]))
            minima = self.state.distinct([place.incumbent, *ends])
            if self.known:
                out.append(replace(self.known.edges[k], best=place.incumbent, minima=minima))
                continue
            limits, is_open = self.state.limits, not self.state.is_settled(place)
            rare = is_open and known.hits(place, limits.tolerance) < SURE
            doubtful = rare and known.unseen() >= limits.doubt
            out.append(Edge(place.incumbent, minima, known.tries, len(known.ends), doubtful))
        return out

    def _points(
        self, target: Payoff | None, bests: Sequence[Solution]
    ) -> tuple[list[Solution], np.ndarray, Floats]:
        """Return the points of the front, each once, and which lattice point led to which.

        The corners of the simplex between the edges are the edges that are reported.
        """
        if target is None:
            return [], np.zeros(0, dtype=np.intp), np.zeros((0, self.n))
        places = self._of("point", "sweep")
        rows = np.array([x.subproblem.key[1:] for x in places], dtype=float).reshape(-1, self.n)
        beta = rows / rows.sum(axis=1, keepdims=True)
        order, solutions = np.lexsort(-beta.T[::-1]), []
        for k in order.tolist():
            corner = beta[k].min() >= 0 and beta[k].max() == 1 and not target.worst
            is_edge = corner and places[k].subproblem.key[0] == "point"
            best = bests[int(beta[k].argmax())] if is_edge else places[k].incumbent
            solutions.append(replace(best, beta=beta[k]))
        kept = distinct_points(solutions, target.scale)
        J = np.array([x.J for x in kept])
        apart = [(np.abs(J - x.J) / target.scale).max(axis=1).argmin() for x in solutions]
        return kept, np.array(apart, dtype=np.intp), beta[order]

    def _reported(self, turn: int | str) -> list[Solution]:
        """Return the edges, those within the tolerance that are best in the others if wanted."""
        bests = [place.incumbent for place in self.state.places[: self.n]]
        if self.options.tolerance == 0:
            return bests
        starts = [place.incumbent for place in self.state.places]
        tasks = []
        for i, name in enumerate(self.problem.objectives):
            arguments = (self.problem, bests[i], i, self.options.tolerance, self.sizes, starts)
            tasks.append(Task(("near", name), near_best, arguments, turn=("near", turn)))
        return [x or best for x, best in zip(self._run(tasks), bests, strict=True)]

    def _optimal(
        self, programme: LogSum, bests: Sequence[Solution], points: Sequence[Solution]
    ) -> list[Solution]:
        """Return the regular minima of the optimally weighted residuals, each once, best first."""
        starts = [x.solution for x in self._weighted()] + [*bests, *least_along(points, programme)]
        tasks = [
            Task(("optimal-weights", k), solve, (self.problem, programme, x, TIGHT))
            for k, x in enumerate(starts, 1)
        ]
        minima = self.state.distinct(x for x in self._run(tasks) if x and x.converged)
        return accepted(self.problem, minima, programme)
