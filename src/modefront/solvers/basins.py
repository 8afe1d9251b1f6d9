r"""Fronts with many basins: an evolution between the edges, polished by the gradient programmes.

Normal-boundary intersection goes from neighbour to neighbour and keeps to the basins of the models
that it starts from. Where the objectives have many basins, the best ones between the edges are
others. That this is so shows in the minima that the search for the edges has found without coming
to an end, in points that did not converge, and in a few probes: programmes of the simplex solved
from random starts, of which none may end in front of a point that is known.

Then a population of models evolves (Deb et al. 2002, doi:10.1109/4235.996017: simulated binary
crossover, polynomial mutation, ranks of dominance and crowding), which begins with all models that
are known, and of which in every generation some are followed along the normal, as one point of
normal-boundary intersection, to the bottom of their basin (a memetic algorithm). It ends as soon
as the front hardly moves. Its progress is measured on the points :math:`\Phi \beta_k` of a lattice
by

.. math:: t_k = \min_{\theta \text{ known}} \max_i \frac{y_i(\theta) - (\Phi \beta_k)_i}{r_i},

the place on the normal from which on all points are dominated by a known model. A point of the
front that is so dominated is solved again from the model that dominates it, and from its
neighbours; models that lead to no point of the lattice and dominate one, or lie between points,
are points of the front of their own.

========  ========  ==========================================================
symbol    shape     meaning
========  ========  ==========================================================
y         (n,)      :math:`(J - J^*) / scale`
Phi       (n, n)    pay-off matrix, one column an edge, in units of the scale
r         (n,)      :math:`\Phi e`, the normal towards greater objectives
beta_k    (n,)      point of the lattice on the simplex between the edges
t_k       ()        least excess over the simplex of all known models
========  ========  ==========================================================
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from modefront._typing import Bools, Floats, Ints
from modefront.solvers.archive import Archive
from modefront.solvers.attainment import Attainment
from modefront.solvers.continuation import JUMP, Simplex, simplex
from modefront.solvers.dominance import nondominated
from modefront.solvers.explore import NEAR, Search
from modefront.solvers.nbi import Projection
from modefront.solvers.payoff import Payoff
from modefront.solvers.problem import Problem
from modefront.solvers.scalarisation import weighted
from modefront.solvers.sqp import Options, Solution, Status, begin, solve
from modefront.work.codec import record
from modefront.work.task import IMMEDIATE, Executor, Key, Task

MINIMA = 5
"""Minima of one programme with different objectives, from which on the search is known not to have
found them all."""

DOUBTFUL = 2
"""Points that did not converge, from which on the objectives count as rugged."""

PROBES = 3
"""Points between the edges that are solved again from random starts, to see where these end."""

AHEAD = 1e-3
"""Lead of a model over a point, in units of the ranges, that is worth a search from there."""

FINER = 4
"""Steps of the lattice on which progress is measured for one step along the front, of two
objectives; one of more."""

POPULATION = 60
"""Models that survive a generation, besides the best one of each point of the lattice."""

OFFSPRING, JUMPS, FOLLOWED = 40, 4, 3
"""Models of a generation: children of two others; models that jump from a survivor and then are
followed to the bottom of their basin; survivors that are so followed. From the least of each
objective one more jumps, and is followed to the minimum of that objective."""

QUIET, PROGRESS = 15, 5e-4
"""Generations over which the mean excess has to fall by so much for the evolution to go on."""

EFFORT = 100
"""Evaluations of the evolution at most, for each local search that a programme is allowed."""

CROSSOVER, MUTATION = 15.0, 20.0
"""Indices of the distributions of simulated binary crossover and of polynomial mutation."""

ROUNDS = 4
"""Times at most that all models compete for all points."""

SPACING = 0.125
"""Distance of points of the front besides the lattice, in its steps, at least."""

CROWD = 6
"""Points besides the lattice at most, for one step of it."""

WIDE = 0.15
"""Distance of neighbours on a rugged front of two objectives, in steps of the lattice, over which a
point is sought between them."""

OTHERS = 1e-2
"""Weight of the other objectives, in units of the ranges, where the least of one is sought."""

_ROUGH, _SHORT = Options(step=NEAR / 4, iterations=8), Options(iterations=60)


@record
@dataclass(frozen=True)
class Models:
    """Models theta (m, p) with their objectives J (m, n), and which need not be followed (m,)."""

    theta: Floats
    J: Floats
    followed: Bools

    def __getitem__(self, rows: Ints | Bools) -> Models:
        return Models(self.theta[rows], self.J[rows], self.followed[rows])

    def joined(self, other: Models) -> Models:
        """Return these models and others, each only once."""
        theta = np.concatenate([self.theta, other.theta])
        J = np.concatenate([self.J, other.J])
        followed = np.concatenate([self.followed, other.followed])
        _, first = np.unique(theta, axis=0, return_index=True)
        first = np.sort(first[np.isfinite(J[first]).all(axis=1)])
        return Models(theta[first], J[first], followed[first])


def models_of(solutions: Sequence[Solution]) -> Models:
    """Return the models of solutions."""
    theta = np.array([solution.theta for solution in solutions])
    J = np.array([solution.J for solution in solutions])
    followed = np.array([solution.status is not Status.EXHAUSTED for solution in solutions])
    return Models(theta, J, followed)


def place_on_normals(target: Payoff, beta: Floats, J: Floats) -> Floats:
    """Return the excess of each row of J (m, n) over each point beta (k, n), shape (m, k)."""
    y = (J - target.utopia) / target.scale
    r = target.Phi.sum(axis=1)
    out: Floats = ((y[:, None] - beta @ target.Phi.T) / r).max(axis=2)
    return out


def ranks(J: Floats) -> Ints:
    """Return the rank of dominance of each row of J (m, n): 0 where no other dominates it."""
    rank = np.full(len(J), -1)
    left, level = np.arange(len(J)), 0
    while left.size:
        best = nondominated(J[left], 0.0)
        if not best.any():
            best[:] = True
        rank[left[best]] = level
        left, level = left[~best], level + 1
    return rank


def crowding(J: Floats) -> Floats:
    """Return the distance of the neighbours of each row of J (m, n), summed over objectives."""
    out = np.zeros(len(J))
    span = np.maximum(np.ptp(J, axis=0), np.finfo(float).tiny)
    for i in range(J.shape[1]):
        order = np.argsort(J[:, i], kind="stable")
        padded = np.concatenate([[-np.inf], J[order, i], [np.inf]])
        out[order] += (padded[2:] - padded[:-2]) / span[i]
    return out


def survivors(models: Models, excess: Floats) -> Ints:
    """Return which models survive: by rank and crowding, and the best of each point."""
    rank = ranks(models.J)
    distance = np.zeros(len(rank))
    for k in range(int(rank.max()) + 1):
        distance[rank == k] = crowding(models.J[rank == k])
    order = np.lexsort((-distance, rank))
    return np.unique(np.concatenate([order[:POPULATION], excess.argmin(axis=0)]))


def crossed(u: Floats, v: Floats, rng: np.random.Generator) -> Floats:
    """Return one child (m, p) of each pair of parents by simulated binary crossover."""
    share, half = rng.uniform(size=u.shape), 1 / (CROSSOVER + 1)
    spread = np.where(share <= 0.5, (2 * share) ** half, (2 - 2 * share) ** -half)
    spread = np.where(rng.uniform(size=u.shape) < 0.5, spread, 1.0)
    swapped = rng.uniform(size=u.shape) < 0.5
    return ((u + v) + np.where(swapped, -spread, spread) * (u - v)) / 2


def mutated(u: Floats, rng: np.random.Generator) -> Floats:
    """Return models by polynomial mutation of one parameter each, in the mean."""
    share, half = rng.uniform(size=u.shape), 1 / (MUTATION + 1)
    step = np.where(share < 0.5, (2 * share) ** half - 1, 1 - (2 - 2 * share) ** half)
    return u + np.where(rng.uniform(size=u.shape) < 1 / u.shape[1], step, 0.0)


def jumped(u: Floats, rng: np.random.Generator) -> Floats:
    """Return models of which a few parameters, one at least, have gone anywhere near or far."""
    m, p = u.shape
    on = rng.uniform(size=u.shape) < 1 / p
    on[np.arange(m), rng.integers(p, size=m)] = True
    width = 10.0 ** rng.uniform(-1.5, 0, size=(m, 1))
    return u + np.where(on, width * rng.uniform(-1, 1, size=u.shape), 0.0)


def chosen(models: Models, count: int, rng: np.random.Generator) -> Ints:
    """Return parents, each the better of two by rank and crowding."""
    rank, distance = ranks(models.J), crowding(models.J)
    pairs = rng.integers(len(rank), size=(2, count))
    better = np.lexsort((-distance[pairs], rank[pairs]), axis=0)[0]
    return np.asarray(pairs[better, np.arange(count)])


# 9 arguments: the front of `nbi`, and the models known beside it.
def explore_between(
    problem: Problem,
    target: Payoff,
    points: Sequence[Solution],
    minima: Sequence[Sequence[Solution]],
    lattice: Simplex,
    rng: np.random.Generator,
    search: Search,
    work: Executor = IMMEDIATE,
    visited: Archive | None = None,
) -> list[Solution]:
    """Return the points of a front by `nbi`, better ones in their places, and others besides.

    ``minima`` are what each programme solved so far has found, ``visited`` are all models that
    were evaluated: points that one of these is ahead of are solved again from it. Where nothing
    tells of other basins, nothing else is done, at the price of a few evaluations; nor where the
    search allows no starts. Of two objectives, the points are in their order along the
    front, and models that are ahead of some point or lie between points are points as well.
    """
    if len(points) < len(target.scale):
        return list(points)
    between = _Between(problem, target, lattice, work)
    points = between.competed(points, _models_in(visited))
    if search.is_none:
        return points
    known = [*points, *(solution for solved in minima for solution in solved)]
    many = max((_different(solved, target.scale) for solved in minima), default=0) >= MINIMA
    doubtful = sum(not solution.converged for solution in points) >= DOUBTFUL
    if not (many or doubtful):
        probes = between.probes(points, rng)
        if not between.ahead(probes, models_of(known)):
            return points
        known += probes
    everything, more = models_of(known), _models_in(visited)
    everything = everything if more is None else everything.joined(more)
    models = between.evolved(everything, rng, EFFORT * search.limit)
    models = models if more is None else models.joined(more)
    better = between.competed(points, models, "evolved")
    return between.with_others(better, models)


def resumed(
    problem: Problem, target: Payoff, points: Sequence[Solution], work: Executor
) -> list[Solution]:
    """Return points besides the lattice of a front of nearly the same problem, solved again.

    Each is projected from where it lies: the edges may have moved.
    """
    tasks = [
        Task(("front", "nbi", "beside", k + 1), _resumed, (problem, target, point))
        for k, point in enumerate(points)
    ]
    return work.run(tasks)


def _models_in(visited: Archive | None) -> Models | None:
    """Return the models of an archive, of which none is followed."""
    if visited is None:
        return None
    return Models(visited.theta, visited.J, np.zeros(len(visited.J), dtype=np.bool_))


def _different(solved: Sequence[Solution], scale: Floats) -> int:
    """Return how many minima differ in their objectives: those of one valley do not."""
    kept: list[Floats] = []
    for solution in solved:
        y = solution.J / scale
        if all(np.abs(y - other).max() > AHEAD for other in kept):
            kept.append(y)
    return len(kept)


@dataclass(frozen=True)
class _Between:
    """The work on one front."""

    problem: Problem
    target: Payoff
    lattice: Simplex
    work: Executor

    def excess(self, solution: Solution, J: Floats) -> Floats:
        """Return the excess of models J (m, n) on the normal of a point of the front, (m,)."""
        return place_on_normals(self.target, place_of(self.target, solution)[None], J)[:, 0]

    def is_near(self, solution: Solution, J: Floats) -> Bools:
        """Return which models J (m, n) are projected from next to the place of a point.

        Others that dominate it, as in a gap of the front, lie on no way to its normal.
        """
        away = np.abs(self.target.place(J) - place_of(self.target, solution)).max(axis=1)
        return np.asarray(away <= 1 / self.lattice.divisions)

    def ahead(self, probes: Sequence[Solution], known: Models) -> bool:
        """Return whether a probe is ahead of all known models where it was to come to."""
        for solution in probes:
            excess = self.excess(solution, solution.J[None]).min()
            if self.excess(solution, known.J).min() > excess + AHEAD:
                return True
        return False

    def progress(self, models: Models, excess: Floats) -> float:
        """Return the mean excess of the best models plus that of the least of each objective."""
        least = (models.J.min(axis=0) - self.target.utopia) / self.target.scale
        return float(excess.min(axis=0).mean() + least.mean())

    def probes(self, points: Sequence[Solution], rng: np.random.Generator) -> Sequence[Solution]:
        """Return where programmes between the edges end from random starts."""
        span = self.problem.upper - self.problem.lower
        thetas = self.problem.lower + span * rng.uniform(size=(PROBES, span.size))
        chosen = np.linspace(0, len(points) - 1, PROBES + 2)[1:-1].astype(int)
        betas = [place_of(self.target, points[k]) for k in chosen.tolist()]
        solved = self.work.run(
            [
                Task(("probe", k + 1), _probe, (self.problem, self.target, theta, beta))
                for k, (theta, beta) in enumerate(zip(thetas, betas, strict=True))
            ]
        )
        return [solution for solution in solved if solution.feasible]

    def evolved(self, models: Models, rng: np.random.Generator, evaluations: int) -> Models:
        """Return the population in which the evolution ends, with all that was followed."""
        lower, span = self.problem.lower, self.problem.upper - self.problem.lower
        n = self.target.utopia.size
        finer = simplex(n, self.lattice.divisions * (FINER if n == 2 else 1))
        excess = partial(place_on_normals, self.target, finer.beta)
        models = models.joined(models)
        models = models[survivors(models, excess(models.J))]
        progress, spent, generation = [self.progress(models, excess(models.J))], 0, 0
        while spent < evaluations:
            generation += 1
            u = (models.theta - lower) / span
            mothers, fathers = (u[chosen(models, OFFSPRING, rng)] for _ in range(2))
            crossover = crossed(mothers, fathers, rng)
            whole = np.where(rng.uniform(size=mothers.shape) < 0.5, mothers, fathers)
            crossover[::4] = whole[::4]
            thetas = lower + span * np.clip(mutated(crossover, rng), 0, 1)
            key = ("front", "nbi", "between", generation)
            (children,) = self.work.run([Task(key, _evaluated, (self.problem, thetas))])
            models = models.joined(children)
            models = models[survivors(models, excess(models.J))]
            best = np.unique(excess(models.J).argmin(axis=0))
            u = (models.theta - lower) / span
            bases, others = (u[rng.choice(best, JUMPS)] for _ in range(2))
            mixed = np.where(rng.uniform(size=bases.shape) < 0.5, bases, others)
            bases = np.where(rng.uniform(size=(JUMPS, 1)) < 0.5, bases, mixed)
            least = u[models.J.argmin(axis=0)]
            jumps = lower + span * np.clip(jumped(np.concatenate([bases, least]), rng), 0, 1)
            rest = np.flatnonzero(~models.followed)
            rest = np.concatenate([np.intersect1d(rest, best), np.setdiff1d(rest, best)])
            along = [*jumps[:JUMPS], *models.theta[rest[:FOLLOWED]]]
            starts: list[tuple[Floats, int | None]] = [(theta, None) for theta in along]
            starts += [(theta, i) for i, theta in enumerate(jumps[JUMPS:])]
            models.followed[rest[:FOLLOWED]] = True
            ends = self.work.run(
                [
                    Task((*key, "followed", k + 1), _follow, (self.problem, self.target, *start))
                    for k, start in enumerate(starts)
                ]
            )
            models = models.joined(models_of([solution for solution in ends if solution.feasible]))
            models = models[survivors(models, excess(models.J))]
            spent += len(thetas) + sum(solution.evaluations for solution in ends)
            progress.append(self.progress(models, excess(models.J)))
            if generation > QUIET and progress[-1 - QUIET] - progress[-1] < PROGRESS:
                break
        return models

    def competed(
        self, points: Sequence[Solution], models: Models | None, name: str = "nbi"
    ) -> list[Solution]:
        """Return the points, each solved again from a model that is ahead of it, if any is."""
        current = list(points)
        attempts: set[tuple[int, bytes]] = set()
        for turn in range(ROUNDS):
            everything = models_of([solution for solution in current if solution.feasible])
            everything = everything if models is None else models.joined(everything)
            starts = {}
            for k, solution in enumerate(current):
                if solution.beta is None:
                    continue
                excess = np.where(
                    self.is_near(solution, everything.J),
                    self.excess(solution, everything.J),
                    np.inf,
                )
                best = int(excess.argmin())
                current_excess = (
                    self.excess(solution, solution.J[None])[0] if solution.feasible else np.inf
                )
                key = (k, everything.theta[best].tobytes())
                if (
                    excess[best] < current_excess - AHEAD / 10 or not solution.converged
                ) and key not in attempts:
                    attempts.add(key)
                    starts[k] = everything.theta[best]
            if not starts:
                break
            task_key: Key = ("front", "nbi", "compete", name, turn + 1)
            solved = self.work.run(
                [
                    Task((*task_key, k + 1), _again, (self.problem, self.target, current[k], theta))
                    for k, theta in starts.items()
                ]
            )
            for k, solution in zip(starts, solved, strict=True):
                if _is_better(self.target, solution, current[k]):
                    current[k] = solution
        return current

    def with_others(self, points: Sequence[Solution], models: Models) -> list[Solution]:
        """Return the points and, of two objectives in their order, optimal models besides them."""
        arguments = (self.problem, self.target, self.lattice, list(points), models)
        (others,) = self.work.run([Task(("front", "nbi", "others"), _others, arguments)])
        out = [*points, *others]
        if self.target.utopia.size > 2:
            return out
        out.sort(key=lambda solution: -float(self.target.place(solution.J)[0]))
        task = Task(("front", "nbi", "along"), _continued, (self.problem, self.target, out))
        (along,) = self.work.run([task])
        along.extend(self._between_neighbours(along))
        return sorted(along, key=lambda solution: -float(self.target.place(solution.J)[0]))

    def _between_neighbours(self, points: Sequence[Solution]) -> list[Solution]:
        """Return points of two objectives half-way between optimal neighbours that lie apart."""
        J = np.array([solution.J for solution in points])
        optimal = np.flatnonzero(nondominated(J))
        optimal = optimal[np.argsort(J[optimal, 0], kind="stable")]
        steps = np.abs(np.diff(J[optimal], axis=0) / self.target.scale).max(axis=1)
        wide = np.flatnonzero(steps > WIDE / self.lattice.divisions)
        tasks = [
            Task(
                ("front", "nbi", "half-way", int(k) + 1),
                _half_way,
                (self.problem, self.target, points[optimal[k]], points[optimal[k + 1]]),
            )
            for k in wide
        ]
        return [x for x in self.work.run(tasks) if x.converged]


def programmes_of(problem: Problem, target: Payoff) -> Projection | Attainment:
    """Return the programmes of the points of the simplex."""
    if target.utopia.size == 2:
        return Projection(target)
    return Attainment(target, np.zeros((0, problem.lower.size)))


def place_of(target: Payoff, point: Solution) -> Floats:
    """Return the coordinates (n,) of the plane that a point of the front belongs to."""
    return target.place(point.J) if point.beta is None else point.beta


def _probe(problem: Problem, target: Payoff, theta: Floats, beta: Floats) -> Solution:
    """Return where the programme of a point of the simplex ends from some parameters."""
    start = begin(problem.evaluate(theta))
    return replace(solve(problem, target.subproblem(beta), start, _ROUGH), beta=beta)


def _follow(problem: Problem, target: Payoff, theta: Floats, objective: int | None) -> Solution:
    """Return the end of the programme through a model, or of that of one objective."""
    evaluation = problem.evaluate(theta)
    start = begin(evaluation)
    if not evaluation.feasible:
        return start
    if objective is None:
        beta = np.maximum(target.place(evaluation.J), 0.0)
        programme = target.subproblem(np.asarray(beta / beta.sum()))
    else:
        chosen = np.arange(evaluation.J.size) == objective
        programme = weighted(np.where(chosen, 1.0, OTHERS) / target.scale)
    end = solve(problem, programme, start, _ROUGH)
    return replace(end, evaluations=end.evaluations + 1)


def _again(problem: Problem, target: Payoff, point: Solution, theta: Floats) -> Solution:
    """Return the programme of a point of the front solved from another model."""
    start = begin(problem.evaluate(theta))
    return programmes_of(problem, target).solve_again(problem, place_of(target, point), start)


def _resumed(problem: Problem, target: Payoff, point: Solution) -> Solution:
    """Return the programme through a point, solved from it."""
    start = replace(point, evaluation=problem.evaluate(point.theta))
    beta = target.place(start.J)
    return programmes_of(problem, target).solve_again(problem, beta, start)


def _others(
    problem: Problem,
    target: Payoff,
    lattice: Simplex,
    points: Sequence[Solution],
    models: Models,
) -> list[Solution]:
    """Return optimal models that lie apart from the points, the farthest first.

    Models that are weakly optimal only are left out.
    """
    spacing = SPACING / lattice.divisions
    optimal = nondominated(np.concatenate([models.J, [solution.J for solution in points]]))
    left = models[optimal[: len(models.J)]]
    programmes = programmes_of(problem, target)
    if isinstance(programmes, Attainment):
        # Where the least objective holds the bound, no programme chooses among the models.
        places = zip(target.place(left.J), left.J, strict=True)
        left = left[~np.array([programmes.is_weak(beta, J) for beta, J in places], dtype=np.bool_)]
    y = left.J / target.scale
    away = np.full(len(y), np.inf)
    for point in points:
        if point.feasible:
            away = np.minimum(away, np.abs(y - point.J / target.scale).max(axis=1))
    out: list[Solution] = []
    while len(y) and len(out) < CROWD * lattice.divisions:
        farthest = int(away.argmax())
        if away[farthest] < spacing:
            break
        out.append(_bottom(problem, target, left.theta[farthest]))
        for J in (left.J[farthest], out[-1].J):
            away = np.minimum(away, np.abs(y - J / target.scale).max(axis=1))
    return out


def _bottom(problem: Problem, target: Payoff, theta: Floats) -> Solution:
    """Return the solution of the programme through a model, or the model if it is no better."""
    start = begin(problem.evaluate(theta))
    beta = target.place(start.J)
    end = programmes_of(problem, target).solve_again(problem, beta, start)
    if target.is_better(beta, start.J, end.J):
        return replace(start, status=Status.STALLED, beta=beta)
    return end


def _continued(problem: Problem, target: Payoff, points: Sequence[Solution]) -> list[Solution]:
    """Return points in their order along a front, each branch continued as far as it is best.

    A point of which a neighbour lies far away or on another smooth piece of the objectives is
    solved again from that one, and on its piece.
    """
    out, span = list(points), problem.upper - problem.lower
    programmes = programmes_of(problem, target)
    for order in (range(1, len(out)), range(len(out) - 2, -1, -1)):
        for k in order:
            near = out[k - order.step]
            far = bool((np.abs(out[k].theta - near.theta) > JUMP * span).any())
            other = out[k].evaluation.branch != near.evaluation.branch
            if not (near.feasible and (far or other)):
                continue
            piece = problem.on_branch(near.evaluation.branch) if other else problem
            beta = place_of(target, out[k])
            solution = programmes.solve_again(piece, beta, near)
            if other:
                start = begin(problem.evaluate(solution.theta))
                solution = programmes.solve_again(problem, beta, start)
            if _is_better(target, solution, out[k]):
                out[k] = solution
    return out


def _half_way(problem: Problem, target: Payoff, first: Solution, second: Solution) -> Solution:
    """Return the point of the front half-way between two others, from the first or the second."""
    beta = (target.place(first.J) + target.place(second.J)) / 2
    programme = programmes_of(problem, target).subproblem(beta)
    known = np.array([first.J, second.J])
    evaluations = 0
    for start in (first, second):
        end = replace(solve(problem, programme, start, _SHORT), beta=beta)
        evaluations += end.evaluations
        if end.converged and not (known <= end.J).all(axis=1).any():
            return replace(end, evaluations=evaluations)
    return replace(end, status=Status.STALLED, evaluations=evaluations)


def _is_better(target: Payoff, solution: Solution, known: Solution) -> bool:
    """Return whether a solution is better than a known one of the same point of the front."""
    if solution.converged != known.converged:
        return solution.converged
    return target.is_better(place_of(target, known), solution.J, known.J)


def _evaluated(problem: Problem, thetas: Floats) -> Models:
    """Return models theta (m, p), which may be followed."""
    J = [problem.evaluate(theta, derivatives=False).J for theta in thetas]
    return Models(thetas, np.array(J), np.zeros(len(thetas), dtype=np.bool_))
