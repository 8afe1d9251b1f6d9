"""Methods that find the points of a front, by their name in ``[pareto] method``.

Evolutionary ones, to be compared with, are those of pymoo (the extra ``evolutionary``). A
generation's evaluations are a task: a run that is continued is played again, with the same seed,
with those that are kept.
"""

import zlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from typing import Any, Literal

import numpy as np

from modefront.families import Family
from modefront.front.dominance import nondominated
from modefront.front.search import evaluated_all
from modefront.optim.problem import Evaluation, Problem
from modefront.optim.sqp import Solution, Status
from modefront.text import Shown
from modefront.work.task import IMMEDIATE, Task


@dataclass(frozen=True, repr=False)
class Method(Shown):
    """A method that finds the points of a front.

    Attributes
    ----------
    name : in ``[pareto] method``, and first part of the labels of its points
    title : in sentences
    programme : that a point solves: of the simplex between edges, of its weights, or none
    algorithm : of a method without one, returns an algorithm with the interface of pymoo's
        (``setup``, ``ask``, ``tell``, ``pop``) for so many models in a generation
    package, extra : that it needs besides, and the extra of modefront that brings it
    """

    name: str
    title: str
    programme: Literal["boundary", "weights"] | None = None
    algorithm: Callable[[int], Any] | None = None
    package: str = ""
    extra: str = ""

    @property
    def refines(self) -> bool:
        """Whether it adds points where neighbours are far apart (``[pareto] refined``)."""
        return self.programme == "boundary"

    @property
    def missing(self) -> str | None:
        """The package that the method needs and that is not installed, and how to install it."""
        if not self.package or find_spec(self.package):
            return None
        return f"{self.package}: pip install modefront[{self.extra}]"


def _spea2(population: int) -> Any:
    from pymoo.algorithms.moo.spea2 import SPEA2, SPEA2Survival

    # The default survival is one object for all runs and remembers the ranges of the last one.
    return SPEA2(pop_size=population, survival=SPEA2Survival(normalize=True))


def _nsga2(population: int) -> Any:
    from pymoo.algorithms.moo.nsga2 import NSGA2

    return NSGA2(pop_size=population)


METHODS: Family[Method] = Family(
    "modefront.methods",
    "a Method of fronts",
    Method,
    (
        Method("nbi", "normal-boundary intersection", "boundary"),
        Method("weights", "a sweep of the weights", "weights"),
        Method("spea2", "SPEA2", None, _spea2, "pymoo", "evolutionary"),
        Method("nsga2", "NSGA-II", None, _nsga2, "pymoo", "evolutionary"),
    ),
)
"""All methods by their names."""


def evolve_front(
    problem: Problem,
    method: str,
    population: int,
    evaluations: int,
    rng: np.random.Generator,
    run: Callable[[Sequence[Task[Any]]], list[Any]] = IMMEDIATE.run,
) -> list[Solution]:
    """Return the non-dominated models of the last population, ascending in the first objective.

    ``evaluations`` is the budget; whole generations of size ``population`` are spent of it.
    ``run`` carries out tasks.
    """
    from pymoo.core.evaluator import Evaluator
    from pymoo.core.problem import Problem as Described
    from pymoo.problems.static import StaticProblem

    undefined = float(np.finfo(np.float32).max)  # of models without modes: pymoo takes no infinity
    n, p = len(problem.objectives), problem.lower.size
    described = Described(n_var=p, n_obj=n, xl=problem.lower, xu=problem.upper)
    make = METHODS[method].algorithm
    assert make is not None, method
    algorithm = make(population)
    algorithm.setup(
        described,
        termination=("n_gen", max(evaluations // population, 1)),
        seed=int(rng.integers(2**31)),
        verbose=False,
    )
    spent, known = 0, dict[bytes, Evaluation]()
    while spent == 0 or spent + population <= evaluations:
        proposals = algorithm.ask()
        thetas = proposals.get("X")
        # Another version of pymoo may ask for other models.
        key = ("front", method, spent, f"{zlib.crc32(thetas.tobytes()):x}")
        inside = np.clip(thetas, problem.lower, problem.upper)
        (members,) = run([Task(key, evaluated_all, (problem, inside))])
        known |= {theta.tobytes(): x for theta, x in zip(thetas, members, strict=True)}
        spent += len(proposals)
        F = np.nan_to_num(np.array([x.J for x in members]), posinf=undefined)
        Evaluator().eval(StaticProblem(described, F=F), proposals)
        algorithm.tell(infills=proposals)
    F = algorithm.pop.get("F")
    chosen = nondominated(F) & (undefined > F).all(axis=1)
    last = algorithm.pop.get("X")[chosen][np.lexsort(F[chosen].T[::-1])]
    found = (known[theta.tobytes()] for theta in last)
    return [Solution(x, np.full(n, np.nan), Status.SAMPLED, 0) for x in found]
