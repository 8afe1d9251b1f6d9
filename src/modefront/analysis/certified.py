"""The work of a study on a reduced model, until every reported model holds in the full one.

A round does all of the work in the basis at hand. Then snapshots are taken of those models of which
the basis lacks most, among them minima that may be the best ones, and the next round starts from
what is known. Where nothing is lacking, every model that is reported gets its certificate; where
one is above the tolerance, a snapshot is taken there. A poor basis may mislead the search, which is
repeated after a single snapshot then. Snapshots are tasks: an interrupted run has the same digits.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np

from modefront._typing import Floats
from modefront.errors import ModelError, UnfinishedError
from modefront.front.front import Front, best_minima
from modefront.front.search import Search
from modefront.models.reduced.basis import Basis, certificate_of
from modefront.models.reduced.model import WORST, ReducedModel, SnapshotRequest
from modefront.optim.scalarisation import LogSum
from modefront.optim.sqp import Solution
from modefront.pairing.match import match, modes_needed
from modefront.residuals.problem import UpdatingProblem, paired
from modefront.work.codec import record
from modefront.work.task import Executor, Task, Within

POOR = Search().tolerance
"""Relative error of an eigenvalue at a reported model above which the search is not trusted: it is
more than the gains that count."""

ROUNDS = 8  # rounds, after which the tolerance is given up
AHEAD = 5  # snapshots between two rounds at most, each of one or more models

AIM = 0.1
"""Error, over the tolerance, below which models need no snapshot after the first round: derivatives
of modes, and with them the parameters, are less exact than eigenvalues."""

CLOSE = 1e-2
"""Relative excess of a minimum over the best one, up to which errors of the basis may have
exchanged them."""


@record
@dataclass(frozen=True)
class SnapshotTaken:
    """Outcome of a snapshot."""

    error: float  # greatest relative error of an eigenvalue before it
    columns: int  # of the basis with it
    added: int  # columns that it added
    modes: int  # that it is of; 0 where the basis has learned an indefinite stiffness


def certified_front(
    problem: UpdatingProblem, search: Callable[..., Front], work: Executor
) -> Front:
    """Return the front that a search, called with ``work`` and a ``known`` front, leads to.

    A reduced model keeps the estimated errors of the solutions. They are above the tolerance where
    it could not be met: for want of memory, or because the model has no modes where a snapshot is
    to be taken. Any other model needs no certificate.
    """
    model = _reduced(problem)
    if model is None:
        return search(work=work, known=None)
    model.snapshots = ()
    last = _take(model, "first", 1, model.first, work)
    if last is None:
        raise UnfinishedError("the model cannot be solved at the nominal parameters")
    if last.columns < model.capacity:
        lowest = _lowest(problem)
        probe = Task(("probe-basis",), model.lacking, (lowest,), in_process=True)
        (lacking,) = work.run([probe])
        if lacking:
            request = SnapshotRequest(np.array(lacking[:WORST]), lowest, derivatives=False)
            last = _take(model, "probes", 1, request, work) or last
    known: Front | None = None
    for number in range(1, ROUNDS + 1):
        here = Within(work, turn=("round", number))
        front = search(work=here, known=known)
        best = best_minima(front, problem.properties, CLOSE)
        candidates = _models(front, (x for *_, some in best for x in some))
        enough = model.tolerance if known else AIM * model.tolerance
        is_last = number == ROUNDS or last.columns >= model.capacity
        taken = None if is_last else _improve(model, candidates, enough, here)
        if taken is None:
            front = replace(front, known=np.zeros((0, len(problem.objectives))))  # of the basis
            minima = [x for edge in front.edges for x in edge.minima]
            certify(problem, _models(front, [*minima, *front.optimal]), here, "front")
            needed = _models(front, _rivals(problem, model, front))
            taken = None if is_last else _mended(problem, model, needed, here)
            if taken is None:
                break
        last, known = taken, front if taken.error <= POOR else None
    return front


def certified_best(
    problem: UpdatingProblem,
    find: Callable[[Sequence[Floats], Executor], list[Solution]],
    known: Sequence[Floats],
    work: Executor,
) -> list[Solution]:
    """Return the solutions to which known models (p,) lead, the first of them as `certified_front`.

    ``find`` returns them, the best one first.
    """
    for number in range(1, ROUNDS + 1):
        here = Within(work, turn=("best", number))
        found = find(known, here)
        model = _reduced(problem)
        if model is None:
            break
        certify(problem, found[:1], here)
        if number == ROUNDS or _mended(problem, model, found[:1], here) is None:
            break
        known = [solution.theta for solution in found]
    return found


def certify(
    problem: UpdatingProblem, solutions: Sequence[Solution], work: Executor, name: str = "others"
) -> None:
    """Let a reduced model keep the estimated errors of solutions."""
    model = _reduced(problem)
    if model is None or not solutions:
        return
    tasks = [
        Task(("certificate", name, k + 1), _errors, (problem, model.basis, solution))
        for k, solution in enumerate(solutions)
    ]
    found = zip(solutions, work.run(tasks), strict=True)
    model.errors.update({solution.theta.tobytes(): errors for solution, errors in found})


def certificate_attributes(problem: UpdatingProblem) -> dict[str, str | int | float]:
    """Return the tolerance of the certificates, if there are any."""
    model = _reduced(problem)
    return {"eigenvalue_tolerance": model.tolerance} if model else {}


def certificate_values(
    problem: UpdatingProblem, solutions: Sequence[Solution], prefix: str = ""
) -> dict[str, object]:
    """Return the errors of solutions as values of results, if the model is a reduced one."""
    model = _reduced(problem)
    if model is None:
        return {}
    errors = np.array([model.errors[x.theta.tobytes()] for x in solutions])  # (solutions, 2, modes)
    eigenvalue, shape = errors[:, 0], errors[:, 1]
    return {
        f"{prefix}eigenvalue_error": eigenvalue,
        f"{prefix}shape_error": shape,
        f"{prefix}certified": (eigenvalue <= model.tolerance).all(axis=1),
    }


def _reduced(problem: UpdatingProblem) -> ReducedModel | None:
    """Return the model whose solutions need certificates; None where it is solved in full."""
    return problem.model if isinstance(problem.model, ReducedModel) else None


def _improve(
    model: ReducedModel, candidates: Sequence[Solution], enough: float, work: Executor
) -> SnapshotTaken | None:
    """Take snapshots of what the basis knows least, as long as they add something.

    Return the last one, or the first one before which the basis was poor.
    """
    last = None
    for count in range(AHEAD):
        taken = _take(model, "ahead", count + 1, _snapshot(candidates, enough), work)
        last = taken or last
        if taken is None or taken.error > POOR or taken.columns >= model.capacity:
            break
    return last


def _mended(
    problem: UpdatingProblem, model: ReducedModel, needed: Sequence[Solution], work: Executor
) -> SnapshotTaken | None:
    """Take a snapshot of the solutions with the greatest errors above the tolerance, if any."""
    error = [float(model.errors[x.theta.tobytes()][0].max()) for x in needed]
    ranked = sorted(range(len(needed)), key=lambda k: -error[k])
    wrong = [needed[k] for k in ranked if error[k] > model.tolerance][:WORST]
    if not wrong:
        return None
    worst = _snapshot(wrong, 0.0)
    if not np.isfinite(max(error)):
        worst = replace(worst, modes=max(worst.modes, _lowest(problem)))
    return _take(model, "worst", 1, worst, work)


def _take(
    model: ReducedModel, name: str, number: int, request: SnapshotRequest, work: Executor
) -> SnapshotTaken | None:
    """Take a snapshot in a task of its own; None where it adds nothing to the basis."""
    before = model.snapshots
    task = Task(("snapshot", name, number), _taken, (model, request), in_process=True)
    (taken,) = work.run([task])
    if taken is None:
        return None
    model.snapshots = (*before, replace(request, modes=taken.modes))
    return taken if taken.added else None


def _taken(model: ReducedModel, request: SnapshotRequest) -> SnapshotTaken | None:
    """Take a snapshot, which changes the basis of the model.

    Where none of its models can be solved, the basis learns that, so that it is not searched there
    again; None is returned where that fails too.
    """
    before = model.columns if model.snapshots else 0
    for modes in (request.modes, 0) if before else (request.modes,):
        with suppress(ModelError):
            error = model.take(replace(request, modes=modes))
            return SnapshotTaken(float(error), model.columns, model.columns - before, modes)
    return None


def _snapshot(solutions: Sequence[Solution], enough: float) -> SnapshotRequest:
    """Return the snapshot of some models, of modes up to the last one that is paired."""
    modes = max(int(paired(solution.evaluation).max()) + 1 for solution in solutions)
    return SnapshotRequest(np.array([solution.theta for solution in solutions]), modes, enough)


def _lowest(problem: UpdatingProblem) -> int:
    """Return the number of lowest modes that may be paired with measured ones."""
    return modes_needed(problem.pairing, problem.data, problem.model.size)


def _errors(problem: UpdatingProblem, basis: Basis, solution: Solution) -> tuple[Floats, Floats]:
    """Return the errors of the modes that are paired with measured ones, and of their shapes.

    They are infinite where the full model may pair other modes: where one of those that are looked
    at is missing, or where better known modes would be paired differently.
    """
    modes, place = np.unique(paired(solution.evaluation), return_inverse=True)
    count = _lowest(problem)
    certificate = certificate_of(basis, solution.theta, modes, count)
    if np.isfinite(certificate.eigenvalue).all():
        frequency = np.sqrt(np.maximum(certificate.lam[:count], 0.0)) / (2 * np.pi)
        pairs = match(problem.pairing, problem.data, frequency, certificate.phi[:, :count])
        if not np.array_equal(pairs.index, paired(solution.evaluation)):
            return np.full(place.shape, np.inf), np.ones(place.shape)
    return certificate.eigenvalue[place], certificate.shape[place]


def _models(front: Front, others: Iterable[Solution]) -> list[Solution]:
    """Return the models that are reported, but for minima, and others, each once."""
    every = [point.solution for point in front.points] + [edge.best for edge in front.edges]
    every += [*front.optimal[:1], *([front.iterated] if front.iterated else [])]
    every += [*(end for gap in front.gaps for end in gap.ends), *others]
    return list({solution.theta.tobytes(): solution for solution in every}.values())


def _rivals(problem: UpdatingProblem, model: ReducedModel, front: Front) -> Iterator[Solution]:
    """Return the minima that might be the best ones, for all that is known of their errors.

    Where a search has ended at a jump is no minimum: the basis and the full model may pair modes
    differently there, however small errors are.
    """

    def roots(solution: Solution) -> tuple[Floats, Floats]:
        margin = problem.margins(*model.errors[solution.theta.tobytes()])
        return np.maximum(np.sqrt(solution.J) - margin, 0.0), np.sqrt(solution.J) + margin

    for i, edge in enumerate(front.edges):
        most = roots(edge.best)[1][i]
        yield from (x for x in edge.minima if x.converged and roots(x)[0][i] <= most)
    value = LogSum(problem.properties).value
    for solution in front.optimal[1:]:
        least, most = roots(solution)[0], roots(front.optimal[0])[1]
        if not least.all() or value(least**2) <= value(most**2):
            yield solution
