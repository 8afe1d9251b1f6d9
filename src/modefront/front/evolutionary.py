"""Evolutionary methods, from pymoo (the extra ``evolutionary``): SPEA2 and NSGA-II.

They are here to be compared with. They use no derivatives and stop when their evaluations are
spent, with no test of how far their points are from the front: none of them counts as converged.
(Zitzler, Laumanns & Thiele 2001, doi:10.3929/ethz-a-004284029; Deb et al. 2002,
doi:10.1109/4235.996017.)

With a seed, pymoo asks for the same models in the same order as long as it is told the same
objectives. So a generation's evaluations are a task, and a run that is continued is played
again with those that are kept, without solving anything, up to where it stopped.
"""

from __future__ import annotations

import zlib
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from modefront._typing import Floats
from modefront.front.dominance import nondominated
from modefront.front.methods import METHODS
from modefront.optim.problem import Evaluation, Problem, infeasible
from modefront.optim.sqp import Solution, Status
from modefront.work.codec import record
from modefront.work.task import IMMEDIATE, Executor, Task

UNDEFINED = 1e20
"""Value of an objective where the model cannot be evaluated; pymoo takes no infinity."""


def evolve_front(
    problem: Problem,
    method: str,
    population: int,
    evaluations: int,
    rng: np.random.Generator,
    work: Executor = IMMEDIATE,
) -> list[Solution]:
    """Return the non-dominated models of the last population, ascending in the first objective.

    ``evaluations`` is the budget; whole generations of size ``population`` are spent of it.
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
    known: dict[bytes, Evaluation] = {}
    spent = 0
    while spent == 0 or spent + population <= evaluations:
        proposals = algorithm.ask()
        thetas = proposals.get("X")
        # Another version of pymoo may ask for other models.
        key = ("front", method, spent, f"{zlib.crc32(thetas.tobytes()):x}")
        (generation,) = work.run([Task(key, _generation, (problem, thetas))])
        members = _members(generation, n)
        spent += len(proposals)
        known |= {
            theta.tobytes(): evaluation for theta, evaluation in zip(thetas, members, strict=True)
        }
        J = np.array([evaluation.J for evaluation in members])
        F = np.nan_to_num(J, posinf=UNDEFINED)
        Evaluator().eval(StaticProblem(described, F=F), proposals)
        algorithm.tell(infills=proposals)
        alive = {theta.tobytes() for theta in algorithm.pop.get("X")}
        known = {key: evaluation for key, evaluation in known.items() if key in alive}
    last = [evaluation for evaluation in known.values() if evaluation.feasible]
    optimal = nondominated(_objectives(last, n))
    chosen = [evaluation for evaluation, kept in zip(last, optimal, strict=True) if kept]
    return [
        _sampled(evaluation)
        for evaluation in sorted(chosen, key=lambda evaluation: tuple(evaluation.J))
    ]


@record
@dataclass(frozen=True)
class Generation:
    """Evaluations of a generation.

    Attributes
    ----------
    theta, J : (members, p) and (members, n)
    quantities : of the feasible members, their first dimension
    """

    theta: Floats
    J: Floats
    quantities: Mapping[str, Floats]


def _generation(problem: Problem, thetas: Floats) -> Generation:
    """Return the evaluations of models (members, p), moved into the bounds."""
    inside = np.clip(thetas, problem.lower, problem.upper)
    evaluations = [problem.evaluate(theta, derivatives=False) for theta in inside]
    kept = [evaluation.quantities for evaluation in evaluations if evaluation.feasible]
    names = kept[0] if kept else {}
    quantities = {name: np.array([member[name] for member in kept]) for name in names}
    return Generation(inside, np.array([evaluation.J for evaluation in evaluations]), quantities)


def _members(generation: Generation, n: int) -> list[Evaluation]:
    """Return the evaluations of a generation."""
    count = iter(range(len(generation.theta)))
    out = []
    for theta, J in zip(generation.theta, generation.J, strict=True):
        member = infeasible(theta, n)
        if np.isfinite(J).all():
            k = next(count)
            quantities = {name: values[k] for name, values in generation.quantities.items()}
            member = replace(member, J=J, quantities=quantities)
        out.append(member)
    return out


def _objectives(evaluations: list[Evaluation], n: int) -> Floats:
    return np.array([evaluation.J for evaluation in evaluations]).reshape(-1, n)


def _sampled(evaluation: Evaluation) -> Solution:
    return Solution(evaluation, np.full(evaluation.J.size, np.nan), 0.0, Status.SAMPLED, 0)
