r"""The work of a study on a reduced model, until every reported model holds in the full one.

A round does all of the work in the basis at hand. Then snapshots are taken of those models that are
the farthest from all others, as long as they lack more than a tenth of the tolerance (half of it
after later rounds), and the next round starts from what is known. Minima that may be the best ones
are among them, and so are models that a later round has moved. Where nothing is lacking, every
model that is reported gets its certificate, and where one is above the tolerance, a snapshot is
taken there. Minima that cannot be the best ones, whatever their errors are, are exempt from the
tolerance. A poor basis may mislead the search, which is repeated after a single snapshot then.

The tasks of every round have a turn of their own, and its snapshots are among them, so that an
interrupted run goes on with the same digits.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from modefront._typing import Floats, Ints
from modefront.errors import ModelError, UnfinishedError
from modefront.front.front import Front
from modefront.front.point import Point
from modefront.models.reduced.certificate import FOUND, Certificate
from modefront.models.reduced.certifier import Certifier
from modefront.models.reduced.model import ReducedModel, SnapshotRequest
from modefront.optim.lexicographic import EXACT
from modefront.optim.scalarisation import LogSum
from modefront.optim.sqp import Solution
from modefront.pairing.match import match, modes_needed
from modefront.residuals.problem import UpdatingProblem
from modefront.work.codec import record
from modefront.work.task import Executor, Task, Within

POOR = 1e-3
"""Relative error of an eigenvalue at a reported model above which the search is not trusted."""

ROUNDS = 8
"""Rounds, after which the tolerance is given up."""

AHEAD = 5
"""Snapshots between two rounds at most, each of one or more models."""

MODELS = 6
"""Models of which a snapshot is taken together, at most."""

TOGETHER = 4
"""Models that get their certificates together, unless a model is large. Of 2,000 DOFs, 26 models in
shares of 26, 4 and 1 take 0.33, 0.27 and 0.38 s."""

LARGE = 20_000
"""Degrees of freedom above which a model is large."""

AIM, LATER = 0.1, 0.5
"""Error, over the tolerance, below which models need no snapshot after the first round: derivatives
of modes, and with them the parameters, are less exact than eigenvalues. And after later ones, where
a few models have moved, and a snapshot costs another round."""

ELSEWHERE = 0.05
"""Distance over the ranges from all models of the round before, from which on the errors of a model
are looked at before certificates."""

CLOSE = 1e-2
"""Relative excess of a minimum over the best one, up to which errors of the basis may have
exchanged them."""

ERRORS = ("eigenvalue_error", "shape_error")
"""Names under which the estimates are kept with a solution."""


class Search(Protocol):
    """The search for a front, see `modefront.front.pareto.pareto_front`."""

    def __call__(self, *, work: Executor, known: Front | None) -> Front:
        """Return the front."""


@record
@dataclass(frozen=True)
class SnapshotTaken:
    """Outcome of a snapshot.

    Attributes
    ----------
    error : greatest relative error of an eigenvalue before it
    columns : of the basis with it
    added : columns that it added
    modes : that it is of; 0 where the basis has learned an indefinite stiffness
    """

    error: float
    columns: int
    added: int
    modes: int


def certified_front(problem: UpdatingProblem, search: Search, work: Executor) -> Front:
    """Return the front that a search leads to.

    On a reduced model, the estimated errors are among the quantities of the solutions. They are
    above the tolerance where it could not be met: for want of memory, or because the model has no
    modes where a snapshot is to be taken. Any other model needs no certificate.
    """
    model = _reduced(problem)
    if model is None:
        return search(work=work, known=None)
    model.restart()
    front: Front | None = None
    taken = _take_some(model, "first", model.first, [], work)
    if taken.added and not taken.full:
        (lacking,) = work.run([Task(("probe-basis",), _lacking, (problem, model), in_process=True)])
        if lacking:
            request = SnapshotRequest(np.array(lacking), _lowest(problem))
            _take_some(model, "probes", request, [], work)
    for number in range(1, ROUNDS + 1):
        if not taken.added:
            break
        here = Within(work, turn=("round", number))
        work.expect({"snapshot": 1, "certificate": 1})
        known = front if taken.error <= POOR else None
        before, front = front, search(work=here, known=known)
        if taken.full:
            break
        candidates = _candidates(problem, front)
        if not taken.enough or _has_moved(problem, before, front):
            enough = (LATER if known else AIM) * model.tolerance
            request = _farthest(model, candidates, enough)
            taken = _take_some(model, "ahead", request, candidates, here)
            if not taken.enough or taken.added:
                continue
        front = _with_errors(problem, model, front, here)
        needed = {
            _key(solution): solution
            for solution in [*_of_the_front(front), *_rivals(problem, front)]
        }
        wrong = [solution for solution in needed.values() if _error(solution) > model.tolerance]
        if not wrong:
            return front
        worst = _snap(sorted(wrong, key=_error, reverse=True)[:MODELS], 0.0)
        if not all(map(np.isfinite, map(_error, wrong))):
            worst = replace(worst, modes=max(worst.modes, _lowest(problem)))
        taken = _take_some(model, "worst", worst, candidates, here)
    if front is None:
        raise UnfinishedError("the model cannot be solved at the nominal parameters")
    return _with_errors(problem, model, front, work)


def certified_points(
    problem: UpdatingProblem, points: Sequence[Point], work: Executor
) -> list[Point]:
    """Return points with the estimated errors of a reduced model, if it is one."""
    model = _reduced(problem)
    if model is None or not points:
        return list(points)
    kept = _certified(problem, model, [point.solution for point in points], "others", work)
    return [replace(point, solution=x) for point, x in zip(points, kept, strict=True)]


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
    eigenvalue, shape = (
        np.array([x.evaluation.quantities[name] for x in solutions]).reshape(len(solutions), -1)
        for name in ERRORS
    )
    return {
        prefix + ERRORS[0]: eigenvalue,
        prefix + ERRORS[1]: shape,
        f"{prefix}certified": (eigenvalue <= model.tolerance).all(axis=1),
    }


def _reduced(problem: UpdatingProblem) -> ReducedModel | None:
    """Return the model whose solutions need certificates; None where it is solved in full."""
    return problem.model if isinstance(problem.model, ReducedModel) else None


@dataclass(frozen=True)
class _Taken:
    """Outcome of all snapshots.

    Attributes
    ----------
    error : the greatest relative error of an eigenvalue that the first of them found
    added : whether they added anything to the basis
    enough : whether the last one found nothing to add
    full : whether there is no room for more
    """

    error: float
    added: bool
    enough: bool
    full: bool


def _take_some(
    model: ReducedModel,
    name: str,
    request: SnapshotRequest,
    candidates: Sequence[Solution],
    work: Executor,
) -> _Taken:
    """Take a snapshot, and others that the candidates for the next round would need next."""
    error, added = np.inf, False
    for count in range(AHEAD):
        before = model.snapshots
        task = Task(("snapshot", name, count + 1), _take, (model, request), in_process=True)
        (taken,) = work.run([task])
        if taken is None:
            return _Taken(error, added, enough=False, full=False)
        model.resume([*before, replace(request, modes=taken.modes)])
        error = taken.error if count == 0 else error
        if taken.error < request.enough:
            return _Taken(error, added, enough=True, full=False)
        added = added or taken.added > 0
        full = taken.columns >= model.capacity
        if not candidates or full or error > POOR or not taken.added:
            return _Taken(error, added, enough=False, full=full)
        request = _farthest(model, candidates, request.enough or AIM * model.tolerance)
    return _Taken(error, added, enough=False, full=False)


def _take(model: ReducedModel, request: SnapshotRequest) -> SnapshotTaken | None:
    """Take a snapshot, which changes the basis of the model.

    Where none of its models can be solved, the basis learns that, so that it is not searched there
    again; None is returned where that fails too.
    """
    before, modes = model.columns if model.snapshots else 0, request.modes
    try:
        error = model.take(request)
    except ModelError:
        if not before:
            return None
        try:
            modes, error = 0, model.take(replace(request, modes=0))
        except ModelError:
            return None
    columns = model.columns
    return SnapshotTaken(float(error), columns, columns - before, modes)


def _snap(solutions: Sequence[Solution], enough: float) -> SnapshotRequest:
    """Return the snapshot of some models, of modes up to the last one that is paired."""
    modes = max(int(_paired(solution).max()) + 1 for solution in solutions)
    return SnapshotRequest(np.array([solution.theta for solution in solutions]), modes, enough)


def _candidates(problem: UpdatingProblem, front: Front) -> list[Solution]:
    """Return the models that are reported, and minima that may be the best ones, each once."""
    models = list(_of_the_front(front))
    for i, edge in enumerate(front.edges):
        most = (1 + CLOSE) * edge.best.J[i] + EXACT * front.sizes[i]
        models += [solution for solution in edge.minima if solution.J[i] <= most]
    if front.optimal:
        programme = LogSum(problem.properties)
        most = programme.value(front.optimal[0].J) + CLOSE * problem.properties.sum()
        models += [solution for solution in front.optimal if programme.value(solution.J) <= most]
    return list({_key(solution): solution for solution in models}.values())


def _farthest(
    model: ReducedModel, candidates: Sequence[Solution], enough: float
) -> SnapshotRequest:
    """Return the snapshot of the models that are the farthest from all others, unless it is enough.

    It is where their eigenvalues have relative errors below ``enough``.
    """
    ranked = sorted(candidates, key=lambda solution: model.distance(solution.theta), reverse=True)
    return _snap(ranked[:MODELS], enough)


def _has_moved(problem: UpdatingProblem, before: Front | None, front: Front) -> bool:
    """Return whether some model of a front lies elsewhere than all models of the one before."""
    span = problem.upper - problem.lower
    known = np.array([x.theta for x in _reported(before)]) if before else np.zeros((0, span.size))
    return any(
        (np.linalg.norm((known - solution.theta) / span, axis=1) > ELSEWHERE).all()
        for solution in _of_the_front(front)
    )


def _lacking(problem: UpdatingProblem, model: ReducedModel) -> list[Floats]:
    """Return models where the basis lacks modes that measured ones might be paired with."""
    return model.lacking(_lowest(problem))[:MODELS]


def _lowest(problem: UpdatingProblem) -> int:
    """Return the number of lowest modes that may be paired with measured ones."""
    return modes_needed(problem.pairing, problem.data, problem.model.size)


def _with_errors(
    problem: UpdatingProblem, model: ReducedModel, front: Front, work: Executor
) -> Front:
    """Return the front with the estimated errors of all its models."""
    kept = _certified(problem, model, _distinct(front), "front", work)
    errors = {
        _key(solution): {name: solution.evaluation.quantities[name] for name in ERRORS}
        for solution in kept
    }

    def known(solution: Solution) -> Solution:
        quantities = {**solution.evaluation.quantities, **errors[_key(solution)]}
        return replace(solution, evaluation=replace(solution.evaluation, quantities=quantities))

    return replace(
        front,
        points=[replace(point, solution=known(point.solution)) for point in front.points],
        edges=[
            replace(edge, best=known(edge.best), minima=list(map(known, edge.minima)))
            for edge in front.edges
        ],
        optimal=list(map(known, front.optimal)),
        iterated=known(front.iterated) if front.iterated else None,
        gaps=[
            replace(
                gap,
                end=known(gap.end) if gap.end else None,
                start=known(gap.start) if gap.start else None,
            )
            for gap in front.gaps
        ],
        known=np.zeros((0, front.known.shape[1])),  # what the search saw holds in its basis only
    )


def _certified(
    problem: UpdatingProblem,
    model: ReducedModel,
    solutions: Sequence[Solution],
    name: str,
    work: Executor,
) -> list[Solution]:
    """Return solutions with the errors of the modes that are paired with measured ones.

    They are computed in shares, which do not depend on how many processes there are. A large model
    has one share only, which is computed in this process: no other one holds a factor of it.
    """
    count = len(solutions) if model.size > LARGE else TOGETHER
    certifier = model.certifier()
    memory = 8.0 * model.size * TOGETHER * _lowest(problem)
    tasks = [
        Task(
            ("certificate", name, first // count + 1),
            _with_certificates,
            (problem, certifier, list(solutions[first : first + count])),
            in_process=model.size > LARGE,
            memory=memory,
        )
        for first in range(0, len(solutions), count)
    ]
    return [solution for share in work.run(tasks) for solution in share]


def _with_certificates(
    problem: UpdatingProblem, certifier: Certifier, solutions: Sequence[Solution]
) -> list[Solution]:
    """Return solutions with the errors of the modes that are paired with measured ones.

    They are infinite where the full model may pair other modes: where one of those that are looked
    at is missing, or where better known modes would be paired differently.
    """
    paired = [np.unique(_paired(solution), return_inverse=True) for solution in solutions]
    requests = [
        (solution.theta, modes) for solution, (modes, _) in zip(solutions, paired, strict=True)
    ]
    certificates = certifier.certify(requests, _lowest(problem))
    out = []
    for solution, certificate, (_, place) in zip(solutions, certificates, paired, strict=True):
        errors = (certificate.eigenvalue[place], certificate.shape[place])
        if certificate.known and not _pairs_alike(problem, solution, certificate):
            errors = (np.full(place.shape, np.inf), np.ones(place.shape))
        quantities = {**solution.evaluation.quantities, **dict(zip(ERRORS, errors, strict=True))}
        out.append(
            replace(solution, evaluation=replace(solution.evaluation, quantities=quantities))
        )
    return out


def _pairs_alike(problem: UpdatingProblem, solution: Solution, certificate: Certificate) -> bool:
    """Return whether modes that are known better are paired as those of the basis are.

    So have modes to be that are farther away by twice as much again, since a third of the errors
    is known for sure.
    """
    count = _lowest(problem)
    modes = problem.model.modes(solution.theta, count, derivatives=False)
    lam, phi = certificate.lam[:count], certificate.phi[:, :count]
    phi = phi * np.where((phi * modes.phi).sum(axis=0) < 0, -1.0, 1.0)
    beyond = 1 / FOUND - 1
    candidates = (
        (lam, phi),
        (lam + beyond * (lam - modes.lam), phi + beyond * (phi - modes.phi)),
    )
    for values, shapes in candidates:
        frequency = np.sqrt(np.maximum(values, 0.0)) / (2 * np.pi)
        pairs = match(problem.pairing, problem.data, frequency, shapes)
        if not np.array_equal(pairs.index, _paired(solution)):
            return False
    return True


def _of_the_front(front: Front) -> Iterator[Solution]:
    """Return the models that are reported, but for minima that are not the best ones."""
    yield from (point.solution for point in front.points)
    yield from (edge.best for edge in front.edges)
    yield from front.optimal[:1]
    if front.iterated:
        yield front.iterated
    for gap in front.gaps:
        yield from gap.ends


def _rivals(problem: UpdatingProblem, front: Front) -> Iterator[Solution]:
    """Return the minima that might be the best ones, for all that is known of their errors."""

    def roots(solution: Solution) -> tuple[Floats, Floats]:
        margin = problem.margins(*(solution.evaluation.quantities[name] for name in ERRORS))
        return np.maximum(np.sqrt(solution.J) - margin, 0.0), np.sqrt(solution.J) + margin

    for i, edge in enumerate(front.edges):
        most = roots(edge.best)[1][i]
        yield from (solution for solution in edge.minima if roots(solution)[0][i] <= most)
    programme = LogSum(problem.properties)
    for solution in front.optimal[1:]:
        least, most = roots(solution)[0], roots(front.optimal[0])[1]
        if not least.all() or programme.value(least**2) <= programme.value(most**2):
            yield solution


def _reported(front: Front) -> Iterator[Solution]:
    yield from _of_the_front(front)
    for edge in front.edges:
        yield from edge.minima
    yield from front.optimal


def _distinct(front: Front) -> list[Solution]:
    """Return the reported models, each once."""
    return list({_key(solution): solution for solution in _reported(front)}.values())


def _paired(solution: Solution) -> Ints:
    """Return the modes that are paired with measured ones, counted from 0."""
    return solution.evaluation.quantities["paired_mode"].astype(int) - 1


def _key(solution: Solution) -> bytes:
    return solution.theta.tobytes()


def _error(solution: Solution) -> float:
    """Return the greatest error of an eigenvalue."""
    return float(solution.evaluation.quantities[ERRORS[0]].max())
