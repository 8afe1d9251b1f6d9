"""Evolutionary methods, from pymoo (the extra ``evolutionary``), to be compared with.

A generation's evaluations are a task: a run that is continued is played again, with the same seed,
with those that are kept.
"""

import zlib
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from modefront._typing import Floats
from modefront.front.dominance import nondominated
from modefront.front.methods import METHODS
from modefront.optim.problem import Evaluation, Problem
from modefront.optim.sqp import Solution, Status
from modefront.work.task import IMMEDIATE, Task

UNDEFINED = float(np.finfo(np.float32).max)
"""Value of an objective where the model cannot be evaluated; pymoo takes no infinity."""


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
        (members,) = run([Task(key, _members, (problem, thetas))])
        known |= {theta.tobytes(): x for theta, x in zip(thetas, members, strict=True)}
        spent += len(proposals)
        F = np.nan_to_num(np.array([x.J for x in members]), posinf=UNDEFINED)
        Evaluator().eval(StaticProblem(described, F=F), proposals)
        algorithm.tell(infills=proposals)
    F = algorithm.pop.get("F")
    chosen = nondominated(F) & (UNDEFINED > F).all(axis=1)
    last = algorithm.pop.get("X")[chosen][np.lexsort(F[chosen].T[::-1])]
    found = (known[theta.tobytes()] for theta in last)
    return [Solution(x, np.full(n, np.nan), Status.SAMPLED, 0) for x in found]


def _members(problem: Problem, thetas: Floats) -> list[Evaluation]:
    """Return the evaluations of models (members, p), moved into the bounds."""
    inside = np.clip(thetas, problem.lower, problem.upper)
    return [problem.evaluate(theta, derivatives=False) for theta in inside]
