"""The search for a Pareto front: edges, weighted models, the front and its gaps, task by task."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from modefront._typing import Floats
from modefront.errors import UnfinishedError
from modefront.fronts.front import Front
from modefront.fronts.methods import METHODS
from modefront.fronts.methods.base import Along, Setting
from modefront.fronts.options import Pareto
from modefront.fronts.point import Kind, Point, label, of_kind
from modefront.solvers.archive import Archive, Archiving
from modefront.solvers.continuation import Simplex, default_points, simplex
from modefront.solvers.edges import (
    Edge,
    edge_of_each,
    edge_options,
    near_best,
    ordered,
    refined_from,
    sample,
    typical_sizes,
)
from modefront.solvers.explore import Descent, Search, distinct, explore
from modefront.solvers.flat import same
from modefront.solvers.lexicographic import EXACT, Lexicographic
from modefront.solvers.payoff import Payoff, corners, payoff
from modefront.solvers.problem import Problem
from modefront.solvers.scalarisation import weighted
from modefront.solvers.sqp import Options, Solution, begin
from modefront.solvers.weights import accepted, iterate_weights, least_along, optimal_minima
from modefront.work.task import IMMEDIATE, Executor, Key, Task, Within, seed_sequence

MOVED = 0.1
"""Distance of two edges, over the ranges of the parameters, above which their fronts differ."""

ALIKE = 1e-2
"""Change of the edges, over the ranges, that leaves the simplex. Of fronts of two objectives, that
of 50 parameters (`benchmarks/growth.py`) had an edge improved by 6e-4, which leaves it, two others
(`benchmarks/edges.py`) by 0.35 and 0.86."""

AGAIN = 2
"""Searches of the front at most, each with edges that are better than those of the one before."""


# 9 arguments: the problem, and each group of options of a search.
def pareto_front(
    problem: Problem,
    a: Floats,
    options: Pareto | None = None,
    *,
    seed: int = 0,
    search: Search | None = None,
    given: Sequence[tuple[str, Floats]] = (),
    floor: Floats | None = None,
    work: Executor = IMMEDIATE,
    known: Front | None = None,
) -> Front:
    """Return the edges, the weighted models, the front by a method, and its gaps.

    ``a`` (n,) counts the measured properties of each objective; ``given`` are named weights (n,);
    ``floor`` (n,) is the part of each objective that errors of the data alone explain, for bounded
    weights. With a ``known`` front of nearly the same problem, minima are sought near its own and
    nowhere else. The arguments are more than six because each is an option of a study. Raises
    UnfinishedError where no edge can be found.
    """
    archive = Archive(problem)
    run = _Run(
        problem,
        a,
        options or Pareto(),
        seed,
        (search or Search()) if known is None else Search.none(),
        tuple(given),
        floor,
        archive,
        Archiving(work, archive),
        known,
    )
    return run.front()


@dataclass(frozen=True)
class _Run:
    """A search for a front; see `pareto_front`. Its ten fields are the arguments of that."""

    problem: Problem
    a: Floats
    options: Pareto
    seed: int
    search: Search
    given: tuple[tuple[str, Floats], ...]
    floor: Floats | None
    archive: Archive
    work: Executor
    known: Front | None

    @property
    def n(self) -> int:
        """Number of objectives."""
        return len(self.problem.objectives)

    @property
    def lattice(self) -> Simplex | None:
        """Points of the simplex of objectives; None of a single one."""
        if self.n == 1:
            return None
        return simplex(self.n, (self.options.points or default_points(self.n)) - 1)

    @property
    def weights(self) -> list[tuple[Kind, str, Floats]]:
        """Kind and name of the models of given and of equal weights, with these weights."""
        named = [(Kind.GIVEN, name, w) for name, w in self.given]
        return [*named, (Kind.EQUAL, "", np.ones(self.n))]

    def front(self) -> Front:
        """Return all that is found."""
        self.work.expect(self._extent())
        sizes = self._sizes()
        edges = self._edges(sizes)
        models = self._weighted(edges, sizes)
        edges = self._from_models(edges, sizes, [model.solution for model in models])
        edges, bests, target, along = self._along(edges, models, sizes)
        models = self._weighted_from_archive(models, sizes)
        optimal, more = self._optimal(models, bests, along, target, sizes)
        models += more
        iterated = self._iterated(models, bests, sizes)
        method = self.options.method
        points = [Point(Kind.FRONT, x, method, i + 1) for i, x in enumerate(along.points)]
        points += [
            Point(Kind.EDGE, x, name)
            for name, x in zip(self.problem.objectives, bests, strict=True)
        ]
        least = np.array([edge.best.J[i] for i, edge in enumerate(edges)])
        return Front(
            method,
            points + models,
            edges,
            optimal,
            iterated,
            tuple(bool(x) for x in least <= EXACT * sizes),
            target,
            along.gaps,
            along.lattice,
            along.places,
            self.archive.J,
            self.floor if of_kind(models, Kind.BOUNDED) else None,
            sizes,
        )

    def _extent(self) -> dict[str, int]:
        """Return the expected number of tasks of each stage."""
        n, lattice = self.n, self.lattice
        out = {
            "sample": 0 if self.known else 1,
            "known": 0,
            "edge": n,
            "weights": len(self.given) + 1,
        }
        if self.known:
            out["known"] = n + len(self.given) + 3
        if lattice:
            out["front"] = METHODS[self.options.method].extent(self.options, lattice)
        return out | {"optimal-weights": 1, "iterated-weights": 1}

    def _again(self, key: Key, solutions: Sequence[Solution]) -> list[Solution]:
        """Return known solutions as starts, with the objectives that they have now."""
        arguments = (self.problem, list(solutions))
        return self.work.run([Task(("known", *key), _evaluated_again, arguments)])[0]

    def _sizes(self) -> Floats:
        """Return the typical size of each objective, (n,), of random models, unless it is known."""
        if self.known:
            return self.known.sizes
        seed = seed_sequence(self.seed, "sample")
        (points,) = self.work.run([Task(("sample",), sample, (self.problem,), seed)])
        sizes = typical_sizes(points)
        if sizes is None:
            raise UnfinishedError(
                "the model cannot be evaluated at any of the parameters tried within the bounds"
            )
        return sizes

    def _edges(self, sizes: Floats) -> list[Edge]:
        """Return the edge of each objective."""
        names = self.problem.objectives
        near = []
        if self.known:
            pairs = zip(names, self.known.edges, strict=True)
            near = [self._again(("edge", name), before.minima) for name, before in pairs]
        seeds = [seed_sequence(self.seed, "edge", name) for name in names]
        out = []
        found = edge_of_each(self.problem, sizes, seeds, self.search, self.work, near)
        for name, best in zip(names, found, strict=True):
            if best is None:
                raise UnfinishedError(f"no minimum of group '{name}' was found from any start")
            out.append(best)
        return out

    def _weighted(self, edges: Sequence[Edge], sizes: Floats) -> list[Point]:
        """Return the models of given and of equal weights, as far as there are any."""
        tasks = []
        for kind, name, w in self.weights:
            near = [edge.best for edge in edges]
            if self.known:
                before = [x for x in of_kind(self.known.points, kind) if x.name == name]
                near = self._again(("weights", kind.value, name), [x.solution for x in before])
            arguments = (self.problem, _descent(w, sizes), self.search, near)
            seed = seed_sequence(self.seed, label(kind, name))
            key = ("weights", kind.value, name)
            tasks.append(Task(key, explore, arguments, seed, has_parts=True))
        minima = self.work.run(tasks)
        return [
            Point(kind, solutions[0], name)
            for (kind, name, _), solutions in zip(self.weights, minima, strict=True)
            if solutions
        ]

    def _from_models(
        self, edges: Sequence[Edge], sizes: Floats, models: Sequence[Solution]
    ) -> list[Edge]:
        """Return the edges, with the minima to which weighted models lead among the others.

        These are sought where the minima of an objective form a manifold, of which a search only
        meets some. Those of a known front have them already.
        """
        if self.known:
            return list(edges)
        names, out = self.problem.objectives, list(edges)
        some = [
            i
            for i, known in enumerate(edges)
            if Lexicographic(i, sizes).is_open(self.problem, known.best.evaluation)
        ]
        rest = (sizes, list(models), edge_options(self.search))
        tasks = [
            Task(("edge", names[i], "from"), refined_from, (self.problem, i, *rest)) for i in some
        ]
        for i, minima in zip(some, self.work.run(tasks), strict=True):
            known = edges[i]
            out[i] = ordered(self.problem, i, sizes, [*known.minima, *minima]) or known
        return out

    def _along(
        self, edges: list[Edge], models: Sequence[Point], sizes: Floats
    ) -> tuple[list[Edge], list[Solution], Payoff | None, Along]:
        """Return edges, their models as reported, the ranges between them, and the front.

        A front whose search meets a model that comes before an edge is sought again, unless the
        edge hardly changes: then only the edge takes the place of the one before.
        """
        along, target, lattice = Along([]), None, self.lattice
        spanned: Payoff | None = None
        for turn in range(AGAIN):
            work = Within(self.work, turn=("again", turn)) if turn else self.work
            bests = self._reported(edges, models, sizes, work)
            minima = [x for edge in edges for x in edge.minima]
            if self.n > 2:
                minima += corners(self.problem, bests, sizes, minima, work)
            target = payoff(bests, sizes, minima) if self.n > 1 else None
            if target is None or lattice is None:
                break
            before = self._before(bests)
            before = [x for x in along.points if x.beta is not None] or before
            setting = Setting(
                self.problem,
                self.options,
                bests,
                [*(edge.minima for edge in edges), [model.solution for model in models]],
                minima,
                target,
                lattice,
                before,
                self.seed,
                self.search,
                self.archive,
                work,
            )
            along, spanned = METHODS[self.options.method].along(setting), target
            better = self._from_archive(edges, sizes, work)
            if all(x is other for x, other in zip(better, edges, strict=True)):
                break
            edges = better
            if _are_near(bests, [edge.best for edge in edges], target):
                near = self._reported(edges, models, sizes, Within(work, turn=("near", turn)))
                along = replace(along, points=_replaced(along.points, bests, near))
                bests = near
                break
        if self.options.tolerance == 0:
            bests = [edge.best for edge in edges]
        return edges, bests, spanned or target, along

    def _reported(
        self, edges: Sequence[Edge], models: Sequence[Point], sizes: Floats, work: Executor
    ) -> list[Solution]:
        """Return the edges, those within the tolerance that are best in the others if wanted."""
        bests = [edge.best for edge in edges]
        tolerance = self.options.tolerance
        if tolerance == 0:
            return bests
        starts = [*(model.solution for model in models), *bests]
        names = self.problem.objectives
        return work.run(
            [
                Task(("near", name), near_best, (self.problem, best, i, tolerance, sizes, starts))
                for i, (name, best) in enumerate(zip(names, bests, strict=True))
            ]
        )

    def _before(self, bests: Sequence[Solution]) -> list[Solution]:
        """Return the points of the known front, none where it had other edges."""
        if not self.known:
            return []
        for before, best in zip(self.known.edges, bests, strict=True):
            if distinct([before.best], best, self.problem, MOVED):
                return []
        points = [point.solution for point in self.known.points]
        return [x for x in points if x.beta is not None]

    def _from_archive(self, edges: Sequence[Edge], sizes: Floats, work: Executor) -> list[Edge]:
        """Return the edges, searched again from evaluated models that come before them."""
        out = []
        archive = self.archive
        for i, (name, known) in enumerate(zip(self.problem.objectives, edges, strict=True)):
            order = Lexicographic(i, sizes)
            J = archive.J
            ahead = [k for k, row in enumerate(J) if order.clearly_better(row, known.best.J)]
            if not ahead:
                out.append(known)
                continue
            first = min(ahead, key=lambda k: order.value(J[k]))
            options = edge_options(self.search)
            arguments = (self.problem, i, sizes, archive.theta[first], options)
            (minima,) = work.run([Task(("edge", name, "archive"), _refined_again, arguments)])
            refined = ordered(self.problem, i, sizes, [*known.minima, *minima])
            better = refined and order.better(refined.best.J, known.best.J)
            out.append(refined if refined and better else known)
        return out

    def _weighted_from_archive(self, models: Sequence[Point], sizes: Floats) -> list[Point]:
        """Return the weighted models, searched again from an evaluated model that is better."""
        out = []
        weights = {(kind, name): w for kind, name, w in self.weights}
        archive = self.archive
        for model in models:
            w = weights[model.kind, model.name]
            descent, known = _descent(w, sizes), model.solution
            J = archive.J
            first = int((J @ w).argmin())
            if J[first] @ w < known.J @ w and not descent.equal(J[first], known.J):
                key = ("weights", model.kind.value, model.name, "archive")
                arguments = (self.problem, descent, archive.theta[first])
                (descended,) = self.work.run([Task(key, _descended, arguments)])
                if descent.value(descended.J) < descent.value(known.J):
                    model = replace(model, solution=descended)
            out.append(model)
        return out

    def _optimal(
        self,
        models: Sequence[Point],
        bests: Sequence[Solution],
        along: Along,
        target: Payoff | None,
        sizes: Floats,
    ) -> tuple[list[Solution], list[Point]]:
        """Return accepted minima of the optimally weighted residuals, and the model to report.

        Bounded weights take the place of optimal ones where no minimum is accepted.
        """
        weighted_models = [model.solution for model in models]
        rivals = [*weighted_models, *along.points]
        near = least_along(along.points, self.a, sizes)
        if self.known:
            bounded = [point.solution for point in of_kind(self.known.points, Kind.BOUNDED)]
            before = self._again(("optimal-weights",), self.known.optimal or bounded)
            near = before if self.known.optimal else [*before, *near]
        else:
            near = [*weighted_models, *bests, *near]
        arguments = (self.problem, self.a, sizes, self.search, near)
        seed = seed_sequence(self.seed, "optimal-weights")
        task = Task(("optimal-weights",), optimal_minima, arguments, seed, has_parts=True)
        (minima,) = self.work.run([task])
        scale = target.scale if target else sizes
        optimal = accepted(minima, self.a, sizes, rivals, self.archive.J, scale)
        if optimal:
            return optimal, [Point(Kind.OPTIMAL, optimal[0])]
        if self.floor is None:
            return [], []
        seed = seed_sequence(self.seed, "bounded-weights")
        with_floor = (*arguments, self.floor)
        task = Task(("bounded-weights",), optimal_minima, with_floor, seed, has_parts=True)
        (bounded,) = self.work.run([task])
        return [], [Point(Kind.BOUNDED, x) for x in bounded[:1]]

    def _iterated(
        self, models: Sequence[Point], bests: Sequence[Solution], sizes: Floats
    ) -> Solution | None:
        """Return the fixed point of the iteration of the weights."""
        if self.known and self.known.iterated:
            (first,) = self._again(("iterated-weights",), [self.known.iterated])
        else:
            equal = of_kind(models, Kind.EQUAL)
            first = equal[0].solution if equal else bests[0]
        arguments = (self.problem, self.a, sizes, first)
        return self.work.run([Task(("iterated-weights",), iterate_weights, arguments)])[0]


def _are_near(edges: Sequence[Solution], others: Sequence[Solution], target: Payoff) -> bool:
    """Return whether a front between edges is that between others."""
    pairs = zip(edges, others, strict=True)
    moved = [np.abs(x.J - other.J) / target.scale for x, other in pairs]
    return bool(np.max(moved) < ALIKE)


def _replaced(
    points: Sequence[Solution], edges: Sequence[Solution], others: Sequence[Solution]
) -> list[Solution]:
    """Return points, of which those that are edges are replaced by others."""
    out = list(points)
    for edge, other in zip(edges, others, strict=True):
        out = [replace(other, beta=x.beta) if same(x, edge) else x for x in out]
    return out


def _descent(w: Floats, sizes: Floats) -> Descent:
    return Descent(weighted(w), EXACT * float(w @ sizes))


def _evaluated_again(problem: Problem, solutions: Sequence[Solution]) -> list[Solution]:
    return [replace(x, evaluation=problem.evaluate(x.theta)) for x in solutions]


def _descended(problem: Problem, descent: Descent, theta: Floats) -> Solution:
    return descent.solve(problem, begin(problem.evaluate(theta)), Options())


def _refined_again(
    problem: Problem, objective: int, sizes: Floats, theta: Floats, options: Options
) -> list[Solution]:
    return refined_from(problem, objective, sizes, [begin(problem.evaluate(theta))], options)
