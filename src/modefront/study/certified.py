r"""The work of a study on a reduced model, until every reported model holds in the full one.

A round does all of the work in the basis at hand and estimates the errors of the modes of those
models that are the farthest from all snapshots. Where an estimate exceeds the tolerance, a snapshot
is taken there, and another one where the known models would need it next, before the next round
starts from what is known; otherwise every model that is reported gets its certificate. Minima that
cannot be the best ones, whatever their errors are, need not hold. As long as an estimate is poor,
a basis that bad may have led astray: after a single snapshot the global search is repeated.

Every round's pieces of work have names of their own, and its snapshots are among them, so that an
interrupted run goes on with the same digits.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Protocol

import numpy as np

from modefront._typing import Floats, Ints
from modefront.errors import ModelError, UnfinishedError
from modefront.models.reduced.model import ReducedModel, Snap
from modefront.residuals.problem import UpdatingProblem
from modefront.solvers.checkpoint import Checkpoint, Solutions
from modefront.solvers.edges import Edge
from modefront.solvers.pieces import Gap
from modefront.solvers.problem import infeasible
from modefront.solvers.scalarisation import LogSum
from modefront.solvers.sqp import Solution, begin
from modefront.study.run import Front, Labelled

POOR = 1e-3
"""Relative error of an eigenvalue at a reported model above which the search is not trusted."""

ROUNDS = 8
"""Rounds, after which the tolerance is given up."""

AHEAD = 4
"""Snapshots between two rounds at most, each of one or more models."""

PROBED = 3
"""Models of which the errors are estimated on the way, those farthest from all snapshots; and of
which a snapshot is taken at most."""

ERRORS = ("eigenvalue_error", "shape_error")
"""Names under which the estimates are kept with a solution."""


class Work(Protocol):
    """All the work of a study but for the certificates, see `modefront.study.run.pareto_front`."""

    def __call__(
        self, *, checkpoint: Checkpoint, expect: Callable[[int], None], known: Front | None
    ) -> Front:
        """Return everything that was found."""


@dataclass(frozen=True)
class _Round:
    """Names the pieces of work of one round."""

    checkpoint: Checkpoint
    number: int

    def __call__(self, name: str, compute: Callable[[], Solutions]) -> Solutions:
        return self.checkpoint(f"{name}.round-{self.number}", compute)


def certified_front(
    problem: UpdatingProblem, work: Work, checkpoint: Checkpoint, expect: Callable[[int], None]
) -> Front:
    """Return what the work finds.

    On a reduced model, the estimated errors are among the quantities of the solutions. They are
    above the tolerance where it could not be met: for want of memory, or because the model has no
    modes where a snapshot is to be taken. Any other model needs no certificate.
    """
    model = problem.model
    if not isinstance(model, ReducedModel):
        return work(checkpoint=checkpoint, expect=expect, known=None)
    model.restart()
    front: Front | None = None
    expected, at, error = 0, model.first, np.inf
    for number in range(1, ROUNDS + 1):
        here = _Round(checkpoint, number)
        known = front if error <= POOR else None
        snapshots = _take_some(problem, model, at, known, here)
        if not snapshots.count:
            break
        base = expected + 2 * AHEAD

        def more(pieces: int, base: int = base) -> None:
            nonlocal expected
            expected = base + pieces
            expect(expected)

        front = work(checkpoint=here, expect=more, known=known)
        probed = here("probe", partial(_probe, model, front))
        if _error(probed[0]) <= model.tolerance:
            front = _with_errors(model, front, here)
            needed = {_key(one): one for one in [*_of_the_front(front), *_rivals(problem, front)]}
            probed = sorted(needed.values(), key=_error, reverse=True)[:PROBED]
            if _error(probed[0]) <= model.tolerance:
                return front
        error, wanted = _error(probed[0]), _snap(model, probed)
        if snapshots.full or not wanted:
            break
        at = wanted
    if front is None:
        raise UnfinishedError("the model cannot be solved at the nominal parameters")
    return _with_errors(model, front, checkpoint)


def certified_points(
    problem: UpdatingProblem, points: Labelled, checkpoint: Checkpoint
) -> Labelled:
    """Return labelled solutions with the estimated errors of a reduced model, if it is one."""
    model = problem.model
    if not isinstance(model, ReducedModel) or not points:
        return points
    found = [one for _, one in points]
    kept = checkpoint("certificates-of-others", lambda: _certified(model, found))
    return [(label, one) for (label, _), one in zip(points, kept, strict=True)]


def certificate_attributes(problem: UpdatingProblem) -> dict[str, str | int | float]:
    """Return the tolerance of the certificates, if there are any."""
    model = problem.model
    return {"eigenvalue_tolerance": model.tolerance} if isinstance(model, ReducedModel) else {}


def certificate_variables(
    problem: UpdatingProblem, solutions: Sequence[Solution], dimension: str = "point"
) -> dict[str, tuple[tuple[str, ...], object, str]]:
    """Return the errors of solutions as variables of the results, if the model is a reduced one.

    Their names begin with the dimension unless that is ``point``.
    """
    model = problem.model
    if not isinstance(model, ReducedModel):
        return {}
    eigenvalue, shape = (
        np.array([one.at.quantities[name] for one in solutions]).reshape(len(solutions), -1)
        for name in ERRORS
    )
    held = (eigenvalue <= model.tolerance).all(axis=1)
    prefix = "" if dimension == "point" else f"{dimension}_"
    meanings = (
        "estimated relative error of the eigenvalue; infinite where a mode is missing",
        "estimated error of the mode shape over its length, in the norm of the mass matrix",
    )
    return {
        prefix + ERRORS[0]: ((dimension, "mode"), eigenvalue, meanings[0]),
        prefix + ERRORS[1]: ((dimension, "mode"), shape, meanings[1]),
        f"{prefix}certified": ((dimension,), held, "all eigenvalues are within the tolerance"),
    }


@dataclass(frozen=True)
class _Taken:
    """What taking snapshots has led to.

    ``count`` of them were taken; ``full`` says that there is no room for more.
    """

    count: int
    full: bool = False


def _take_some(
    problem: UpdatingProblem, model: ReducedModel, at: Snap, front: Front | None, here: Checkpoint
) -> _Taken:
    """Take a snapshot, and others where a front from which it goes on would need them next."""
    for count in range(AHEAD):
        before = model.snapshots
        taken = here(f"snapshot-{count + 1}", partial(_take, problem, model, at))
        if not taken:
            return _Taken(count)
        model.resume([*before, at])
        full = int(taken[0].at.quantities["columns"][0]) >= model.capacity
        if front is None or full:
            return _Taken(count + 1, full)
        probed = here(f"ahead-{count + 1}", partial(_probe, model, front))
        wanted = _snap(model, probed)
        if not wanted:
            return _Taken(count + 1)
        at = wanted
    return _Taken(AHEAD)


def _take(problem: UpdatingProblem, model: ReducedModel, at: Snap) -> list[Solution]:
    """Take a snapshot and keep its theta and the columns that the basis then has.

    Nothing is returned where the model cannot be solved there.
    """
    try:
        model.take(at)
    except ModelError:
        return []
    kept = {"columns": np.array([model.columns])}
    theta = at.models[0][0]
    return [begin(replace(infeasible(theta, len(problem.objectives)), quantities=kept))]


def _snap(model: ReducedModel, probed: Sequence[Solution]) -> Snap | None:
    """Return the snapshot that some models want, the worst ones first, of modes up to the last one.

    None where all are within the tolerance, or where there are snapshots already.
    """
    there = {theta.tobytes() for one in model.snapshots for theta, _ in one.models}
    wanted = [one for one in probed if _error(one) > model.tolerance and _key(one) not in there]
    if not wanted:
        return None
    modes = max(int(_paired(one).max()) + 1 for one in wanted)
    return Snap(np.array([one.at.theta for one in wanted]), modes)


def _probe(model: ReducedModel, front: Front) -> list[Solution]:
    """Return the models that are the farthest from all snapshots, the worst ones first."""
    distinct = list({_key(one): one for one in _of_the_front(front)}.values())
    ranked = sorted(distinct, key=lambda one: model.distance(one.at.theta), reverse=True)
    return sorted(_certified(model, ranked[:PROBED], quick=True), key=_error, reverse=True)


def _with_errors(model: ReducedModel, front: Front, checkpoint: Checkpoint) -> Front:
    """Return the front with the estimated errors of all its models."""
    kept = checkpoint("certificates", lambda: _certified(model, _distinct(front)))
    errors = {_key(one): {name: one.at.quantities[name] for name in ERRORS} for one in kept}

    def known(one: Solution) -> Solution:
        quantities = {**one.at.quantities, **errors[_key(one)]}
        return replace(one, at=replace(one.at, quantities=quantities))

    return replace(
        front,
        points=[(label, known(one)) for label, one in front.points],
        edges=[Edge(known(edge.best), list(map(known, edge.minima))) for edge in front.edges],
        optimal=list(map(known, front.optimal)),
        iterated=known(front.iterated) if front.iterated else None,
        gaps=[Gap(known(gap.end), known(gap.start)) for gap in front.gaps],
    )


def _certified(
    model: ReducedModel, solutions: Sequence[Solution], *, quick: bool = False
) -> list[Solution]:
    """Return solutions with the errors of the modes that are paired with measured ones.

    None of these is missing unnoticed, unless the certificates are ``quick``.
    """
    paired = [np.unique(_paired(one), return_inverse=True) for one in solutions]
    asked = [(one.at.theta, wanted) for one, (wanted, _) in zip(solutions, paired, strict=True)]
    certificates = model.certify(asked, quick=quick)
    found = []
    for one, certificate, (_, place) in zip(solutions, certificates, paired, strict=True):
        errors = (certificate.eigenvalue[place], certificate.shape[place])
        quantities = {**one.at.quantities, **dict(zip(ERRORS, errors, strict=True))}
        found.append(replace(one, at=replace(one.at, quantities=quantities)))
    return found


def _of_the_front(front: Front) -> Iterator[Solution]:
    """Return the models that are reported, but for minima that are not the best ones."""
    yield from (one for _, one in front.points)
    yield from (edge.best for edge in front.edges)
    yield from front.optimal[:1]
    if front.iterated:
        yield front.iterated
    for gap in front.gaps:
        yield from (gap.end, gap.start)


def _rivals(problem: UpdatingProblem, front: Front) -> Iterator[Solution]:
    """Return the minima that might be the best ones, for all that is known of their errors."""

    def roots(one: Solution) -> tuple[Floats, Floats]:
        margin = problem.margins(*(one.at.quantities[name] for name in ERRORS))
        return np.maximum(np.sqrt(one.at.J) - margin, 0.0), np.sqrt(one.at.J) + margin

    for i, edge in enumerate(front.edges):
        most = roots(edge.best)[1][i]
        yield from (one for one in edge.minima if roots(one)[0][i] <= most)
    programme = LogSum(problem.properties)
    for one in front.optimal[1:]:
        least, most = roots(one)[0], roots(front.optimal[0])[1]
        if not least.all() or programme.value(least**2) <= programme.value(most**2):
            yield one


def _reported(front: Front) -> Iterator[Solution]:
    yield from _of_the_front(front)
    for edge in front.edges:
        yield from edge.minima
    yield from front.optimal


def _distinct(front: Front) -> list[Solution]:
    """Return the reported models, each once."""
    return list({_key(one): one for one in _reported(front)}.values())


def _paired(one: Solution) -> Ints:
    """Return the modes that are paired with measured ones, counted from 0."""
    return one.at.quantities["paired_mode"].astype(int) - 1


def _key(one: Solution) -> bytes:
    return one.at.theta.tobytes()


def _error(one: Solution) -> float:
    """Return the greatest error of an eigenvalue."""
    return float(one.at.quantities[ERRORS[0]].max())
