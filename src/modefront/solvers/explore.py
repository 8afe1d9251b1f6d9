r"""Global minima: many starts and an evolution strategy explore, a gradient method finishes.

Starts on a Latin hypercube are followed to their minima by `modefront.solvers.sqp`, a few
evaluations with derivatives each, until the minima found leave less than half a minimum to be
expected (Boender & Rinnooy Kan 1987, doi:10.1007/BF02591684): with w minima of different values
after N starts,

.. math:: \frac{w (N - 1)}{N - w - 2} \le w + \tfrac12 .

Where the objectives are too rugged for that within the limit of starts, CMA-ES (Hansen,
arXiv:1604.00772) finds basins that no start fell into: it is run from a random start until it has
found a basin, the gradient method goes to the bottom, and as long as a run finds a new minimum
another one follows. Where nearly every start leads to a minimum of its own and the estimate on the
left is more than twice the limit, more starts are of no use: CMA-ES follows at once, and goes on
only as long as each minimum is better than all before. All distinct minima are kept, and so is what
a search reached that ended without its tolerances met, where it is better than all minima.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Annotated, Protocol, TypeAlias, cast

import numpy as np

from modefront._typing import Floats
from modefront.errors import wrong
from modefront.options import check_fields, number, plain, whole
from modefront.solvers.problem import Problem
from modefront.solvers.scalarisation import Scalarisation
from modefront.solvers.sqp import Options, Solution, Status, begin, solve
from modefront.work.steps import note
from modefront.work.task import IMMEDIATE, Executor, Task, Within

DISTINCT = 1e-3
"""Distance of two minima, over the ranges of the parameters, above which they are two."""

ENOUGH, AGREED = 30, 10
"""Starts after which the search ends where so many have arrived at the best minimum, however many
worse minima there are."""

EQUAL = 1e-6
"""Difference of the values of two minima, over them, below which they are as good."""

ESTIMATED, MANY = 15, 2
"""Starts from which on an estimate of more minima than so many times their limit ends them."""

NEAR = 2e-2
"""Distance of a half-finished search from a minimum below which it is on its way there."""

PASSES = 2
"""Half-finished searches within that distance of each other that are finished; others from there
lead to the same minimum, however far away it is."""

LIMIT = 60
"""Default limit of local searches, unless the least number requested is greater."""

MOST = 10**6
"""Local searches, runs and generations that may be asked for."""

NO_STARTS = (0, 0, 0)
"""Starts, limit and evolutions of a search from known models only."""

SPREAD = number("a share of the ranges above 0", lambda x: x > 0)


@dataclass(frozen=True)
class Search:
    """Numbers of local searches and runs of an evolution strategy that seek global minima.

    Raises InputError for values that are not possible, alone or together.

    Attributes
    ----------
    starts : local searches at least, 1 or more, where no starts are known
    limit : local searches at most, as many as ``starts`` or more; unless given, 60 or ``starts``
    evolutions : runs of the evolution strategy at most, where the limit did not suffice; 0 for none
    generations : generations of one run at most, 1 or more
    spread : standard deviation, over the range of the parameters, at which a run ends and its best
        model starts a local search; above 0
    """

    starts: Annotated[int, whole(1, MOST)] = 12
    limit: Annotated[int, whole(1, MOST)] = cast("int", None)  # filled in on construction
    evolutions: Annotated[int, whole(0, MOST)] = 4
    generations: Annotated[int, whole(1, MOST)] = 30
    spread: Annotated[float, SPREAD] = 0.05

    def __post_init__(self) -> None:
        if (self.starts, self.limit, self.evolutions) == NO_STARTS:
            return
        if self.limit is None:
            starts = plain(self.starts)
            usual = max(LIMIT, min(starts, MOST)) if isinstance(starts, int) else LIMIT
            object.__setattr__(self, "limit", usual)
        check_fields(self)
        if self.limit < self.starts:
            raise wrong("limit", f"at least starts, {self.starts}", self.limit)

    @classmethod
    def none(cls) -> Search:
        """Return the search that starts from known models only."""
        return cls(*NO_STARTS)

    @property
    def is_none(self) -> bool:
        """Whether it starts from known models only."""
        return self.limit == 0


class LocalSearch(Protocol):
    """Local search from a start to the minimum below it."""

    def value(self, J: Floats, /) -> float:
        """Return the number by which models are ordered."""

    def equal(self, J: Floats, other: Floats, /) -> bool:
        """Return whether two minima with these objectives are as good as each other."""

    def solve(self, problem: Problem, start: Solution, options: Options, /) -> Solution:
        """Return the minimum below a start."""


@dataclass(frozen=True)
class Descent:
    """The search for a minimum of an unconstrained programme.

    Values below ``negligible`` differ in nothing.
    """

    programme: Scalarisation
    negligible: float = 0.0

    def value(self, J: Floats) -> float:
        """Return the value of the programme."""
        return self.programme.value(J)

    def equal(self, J: Floats, other: Floats) -> bool:
        """Return whether two values differ by rounding only."""
        value, compared = self.value(J), self.value(other)
        allowed = max(EQUAL * max(abs(value), abs(compared)), self.negligible)
        return abs(value - compared) <= allowed

    def solve(self, problem: Problem, start: Solution, options: Options) -> Solution:
        """Return the minimum below a start.

        Where many parameters are held by few residuals, learned second derivatives may lead
        astray: a search that they exhaust goes on without them.
        """
        solution = solve(problem, self.programme, start, options)
        if solution.status is not Status.EXHAUSTED:
            return solution
        again = solve(
            problem, self.programme, begin(solution.evaluation), replace(options, learn=False)
        )
        return replace(again, evaluations=solution.evaluations + again.evaluations)


# 7 arguments: the problem and one search, its parts by keyword.
def explore(
    problem: Problem,
    local: LocalSearch,
    search: Search,
    starts: Sequence[Solution] = (),
    options: Options | None = None,
    *,
    rng: np.random.Generator,
    work: Executor = IMMEDIATE,
) -> list[Solution]:
    """Return the distinct minima that a local search leads to, best first.

    ``starts`` that are known to be good are solved from first, then the problem's own start, then
    others until the rule is met; nothing but known starts where the search allows no others.
    Solutions that did not converge are among them where they are better than all minima. Empty
    where the problem is defined at no start. The arguments are more than six because each is
    independent of the others.
    """
    run = _Exploration(problem, local, options or Options(), work)
    known: list[Start] = [*starts]
    if not (starts and search.is_none):
        known.append(problem.start)
    for k, start in enumerate(known):
        run.follow(start, known[k + 1 :])
    fewest = 0 if starts else search.starts
    rugged, hopeless = True, False
    for attempts, (theta, ahead) in enumerate(latin_hypercube(problem, rng, search.limit)):
        N, w = attempts + len(starts), _different(run.minima, local)
        note(f"search {attempts + 1} of at most {search.limit}")
        few_left = attempts >= fewest and w * (N - 1) <= (w + 0.5) * (N - w - 2)
        if few_left or (attempts >= ENOUGH and run.agreed()):
            rugged = False
            break
        hopeless = attempts >= ESTIMATED and w * (N - 1) > MANY * search.limit * (N - w - 2)
        if hopeless:
            break
        run.follow(theta, ahead)
    for _ in range(search.evolutions if rugged else 0):
        before = run.least
        theta = evolve(problem, local, rng, search, run.parts)
        new = run.follow(theta)
        if not new or (hopeless and run.least >= before):
            break
    better = [x for x in run.unfinished if local.value(x.J) < run.least]
    return sorted([*run.minima, *better], key=lambda x: local.value(x.J))


Start: TypeAlias = Solution | Floats
"""A solution to start from, or parameters (p,)."""


@dataclass
class _Exploration:
    """Searches for minima from many starts.

    A search from a start depends on no other one until it comes near to a minimum, so that the next
    ones may be computed at the same time.

    Attributes
    ----------
    minima : distinct minima so far
    unfinished : ends of searches that did not converge
    arrived : ends of searches at any minimum, half-finished ones included
    finished : half-finished searches that were finished
    count : starts so far
    """

    problem: Problem
    local: LocalSearch
    options: Options
    work: Executor
    minima: list[Solution] = field(default_factory=list)
    unfinished: list[Solution] = field(default_factory=list)
    arrived: list[Solution] = field(default_factory=list)
    finished: list[Solution] = field(default_factory=list)
    count: int = 0

    @property
    def least(self) -> float:
        """Least value of all minima; infinite without any."""
        return min((self.local.value(x.J) for x in self.minima), default=np.inf)

    @property
    def parts(self) -> Executor:
        """Executor of the parts that belong to the last start."""
        return Within(self.work, turn=("start", self.count))

    def follow(self, start: Start, ahead: Sequence[Start] = ()) -> bool:
        """Go to the minima below a start; return whether one is new.

        Starts ``ahead`` will probably be followed next.
        """
        tasks = [self._descent(x, self.count + k) for k, x in enumerate([start, *ahead])]
        self.count += 1
        new = False
        for k, rough in enumerate(self.work.run(tasks[:1], tasks[1:])[0]):
            new |= self._finish(rough, k, tasks[1:])
        return new

    def agreed(self) -> bool:
        """Return whether enough searches have arrived at the best minimum."""
        best = min(self.minima, key=lambda x: self.local.value(x.J), default=None)
        close = [x for x in self.arrived if best and not distinct([best], x, self.problem, NEAR)]
        return len(close) >= AGREED

    def _descent(self, start: Start, number: int) -> Task[list[Solution]]:
        near = replace(self.options, step=NEAR / 4)
        arguments = (self.problem, self.local, start, near)
        return Task(("descent", number), descended, arguments)

    def _finish(self, rough: Solution, number: int, ahead: Sequence[Task[list[Solution]]]) -> bool:
        """Go on to the minimum near a half-finished search; return whether it is a new one."""
        if not distinct(self.minima, rough, self.problem, NEAR):
            self.arrived.append(rough)
            return False
        if sum(not distinct([x], rough, self.problem, NEAR) for x in self.finished) >= PASSES:
            return False
        self.finished.append(rough)
        arguments = (self.problem, self.local, rough, self.options)
        (end,) = self.work.run([Task(("end", self.count, number), _solved, arguments)], ahead)
        if not end.feasible or not np.isfinite(self.local.value(end.J)):
            return False
        if not end.converged:
            self.unfinished.append(end)
            return False
        self.arrived.append(end)
        new = distinct(self.minima, end, self.problem)
        if new:
            self.minima.append(end)
        return new


def descended(problem: Problem, local: LocalSearch, start: Start, near: Options) -> list[Solution]:
    """Return the half-finished searches from a start, up to the tolerance of the options ``near``.

    Where the way down leaves the smooth piece of the objectives on which it began, the minimum
    of that piece is another start.
    """
    if not isinstance(start, Solution):
        start = begin(problem.evaluate(start))
    elif start.evaluation.derivatives is None:
        start = begin(problem.evaluate(start.theta))
    rough = local.solve(problem, start, near)
    if rough.evaluation.branch == start.evaluation.branch:
        return [rough]
    on_branch = local.solve(problem.on_branch(start.evaluation.branch), start, near)
    again = begin(problem.evaluate(on_branch.theta))
    return [rough, local.solve(problem, again, near)]


def _solved(problem: Problem, local: LocalSearch, start: Solution, options: Options) -> Solution:
    return local.solve(problem, start, options)


def _different(minima: Sequence[Solution], local: LocalSearch) -> int:
    """Return how many minima there are, those that are as good as each other counted once.

    Where parameters outnumber data, equal minima form a manifold, of which every start finds
    another one.
    """
    kept: list[Solution] = []
    for solution in minima:
        if not any(local.equal(solution.J, other.J) for other in kept):
            kept.append(solution)
    return len(kept)


def latin_hypercube(
    problem: Problem, rng: np.random.Generator, limit: int
) -> Iterator[tuple[Floats, list[Floats]]]:
    """Yield parameters within the bounds, block by block spread evenly over each range.

    With each come those that follow in its block.
    """
    span = problem.upper - problem.lower
    block = 10
    for done in range(0, limit, block):
        cells = rng.permuted(np.tile(np.arange(block), (span.size, 1)), axis=1).T
        thetas = problem.lower + span * (cells + rng.uniform(size=cells.shape)) / block
        rest = list(thetas[: limit - done])
        while rest:
            yield rest.pop(0), list(rest)


def evolve(
    problem: Problem,
    local: LocalSearch,
    rng: np.random.Generator,
    search: Search,
    work: Executor = IMMEDIATE,
) -> Floats:
    """Return the best parameters that one run of CMA-ES found, from a random start."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # it warns of optional packages for plots
        import cma

    span = problem.upper - problem.lower
    strategy = cma.CMAEvolutionStrategy(
        rng.uniform(size=span.size),
        0.3,
        {
            "bounds": [0, 1],
            "seed": np.nan,
            "randn": lambda *shape: rng.standard_normal(shape),
            "verbose": -9,
            "verb_log": 0,
            "maxiter": search.generations,
        },
    )
    best, theta, generation = np.inf, problem.lower + span * strategy.x0, 0
    while (
        not strategy.stop() and np.max(strategy.sigma * strategy.sm.variances**0.5) > search.spread
    ):
        note(f"generation {strategy.countiter + 1} of at most {search.generations}")
        proposals = strategy.ask()
        candidates = [problem.lower + span * np.clip(u, 0, 1) for u in proposals]
        tasks = [
            Task(("member", generation, k), objectives, (problem, candidate))
            for k, candidate in enumerate(candidates)
        ]
        values = []
        for candidate, J in zip(candidates, work.run(tasks), strict=True):
            value = local.value(J) if np.isfinite(J).all() else np.inf
            values.append(value)
            if value < best:
                best, theta = value, candidate
        strategy.tell(proposals, values)
        generation += 1
    return theta


def objectives(problem: Problem, theta: Floats) -> Floats:
    """Return the objectives (n,) at some parameters."""
    return problem.evaluate(theta, derivatives=False).J


def distinct(
    minima: Sequence[Solution], solution: Solution, problem: Problem, distance: float = DISTINCT
) -> bool:
    """Return whether a solution is farther than ``distance`` from all minima, in the ranges."""
    span = problem.upper - problem.lower
    return all(np.abs((solution.theta - known.theta) / span).max() > distance for known in minima)
