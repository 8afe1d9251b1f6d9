r"""Check of a study before it is run: mistakes, derivatives, undetermined parameters.

Derivatives are compared with central differences along directions d, with two steps, extrapolated:

.. math:: \frac{4\,\Delta(h/2) - \Delta(h)}{3}, \qquad
    \Delta(h) = \frac{r(\theta + h d) - r(\theta - h d)}{2 h} .

A direction is one parameter; of many parameters, several are changed together. The residuals are
compared, and not the objectives, whose derivatives cancel near a minimum; modes keep their pairs. A
step changes the residuals by a given small amount, root mean square: steps that follow narrow
bounds, or the length of many residuals together, would drown in rounding, and those that follow
wide ones see no tangent.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from modefront._typing import Floats, Ints
from modefront.diagnosis.comparison import COMPARED, Comparison, compare
from modefront.diagnosis.search import diagnose
from modefront.errors import Fault, ModelError, refuse
from modefront.findings import knowledge
from modefront.findings.record import Finding, Severity, found
from modefront.identifiability import combinations
from modefront.inputs import available_memory
from modefront.models.base import full_of
from modefront.models.matrices import MatrixModel
from modefront.modes.result import Modes
from modefront.optim.problem import Evaluation, at_bounds
from modefront.pairing.match import Pairs
from modefront.residuals.problem import UpdatingProblem
from modefront.results.remarks import digest
from modefront.rounding import COMPUTED, TINY
from modefront.study.definition import Study
from modefront.study.file import as_study
from modefront.text import Shown
from modefront.uncertainty.inference import freed, maximum

AGREEMENT = 1e-5  # greatest relative error of derivatives that finite differences explain
STEP = 2e-3  # change of a residual in its own unit, root mean square, by a finite difference
SHARE = 0.02  # share of a parameter, or of its range where it is zero, that a step takes at most
MOST = 60  # directions in which derivatives are compared, at most
MANY = 100  # parameters from which on a run is said to take long
KEPT = 500  # models that a search keeps with their second derivatives, some

HARMLESS = {
    "damping",
    "unused-group",
    "distant-pair",
    "far-from-model",
    "beyond-candidates",
    "foreign-mode",
    "poor-pair",
}
"""Mistakes that leave the residuals as they are, or that need not be mistakes."""


@dataclass(frozen=True)
class Findings(Shown):
    """The outcome of a check, as records that have a sentence as their text.

    Attributes
    ----------
    derivatives : greatest difference of exact derivatives of the residuals of a group from central
        differences near the nominal parameters, over the greatest of their derivatives; NaN where
        the model is not defined around them
    cause : which parameter and mode they differ for, and why; None where they agree
    determined : which combinations of parameters each group and all of them determine
    mistakes : what looks wrong in the model or the data
    cautions : what else a user should know before relying on the results
    beside : the nominal model beside the measured modes
    sensitivities : of the modes to the parameters
    spoilt : whether mistakes change the residuals, and with them what the data determine
    """

    derivatives: Finding
    cause: Finding | None
    determined: tuple[Finding, ...]
    mistakes: tuple[Finding, ...]
    cautions: tuple[Finding, ...]
    beside: Comparison
    sensitivities: combinations.Sensitivities
    spoilt: bool

    def __repr__(self) -> str:
        """Return the first warnings, one a line."""
        agree, count = "agree with" if self.sound else "DIFFER FROM", len(self.warnings) or "no"
        first = f"Findings: derivatives {agree} finite differences; {count} warnings"
        return "\n".join([first, *digest(self.warnings, "see warnings", knowledge.SHOWN)])

    @property
    def warnings(self) -> tuple[str, ...]:
        """Sentences on mistakes and cautions, in this order."""
        return tuple(map(str, (*self.mistakes, *self.cautions)))

    @property
    def sound(self) -> bool:
        """Whether the derivatives agree with finite differences."""
        return self.cause is None


def check(study: Study | UpdatingProblem | Path | str) -> Findings:
    """Return the error of the derivatives of a study, and warnings before it is run.

    Parameters
    ----------
    study
        The study, the path of its file, or a problem; a few models are evaluated, and none is
        sought.

    Raises
    ------
    InputError
        If no parameter changes a group.
    """
    study = as_study(study)
    problem = study.problem
    with threadpool_limits(1, user_api="blas"):  # threads wait for each other on small matrices
        refuse_unchanged_groups(problem, str(study.file), combinations.unchanged_groups(problem))
        nominal, beside = problem.evaluate(problem.start), compare(problem)
        mistakes = (*diagnose(beside), *(study.origin.notes if study.origin else ()))
        spoilt = any(each.kind not in HARMLESS for each in mistakes)
        bounds = () if spoilt else excluding_bounds(study)
        mistakes += tuple(each for each in bounds if each.severity is Severity.MISTAKE)
        agreement = compared(problem)
        agrees = agreement.error <= AGREEMENT
        of, weights = study.noise.weighed(problem, study.uncertainty.of(problem.data))
        start = of.evaluate(of.start)
        known, left_open = determined(of, start, weights)
        fixed = combinations.superfluous(of, start, weights)
        if spoilt:
            left_open = [each for each in left_open if each.kind == "no-effect"]
        derivatives = found(
            "derivatives",
            verdict="agree with" if agrees else "DIFFER FROM",
            doubt=" at a model with these warnings" * bool(mistakes and not agrees),
            error=agreement.error,
        )
        return Findings(
            derivatives,
            None if agrees else cause_of(problem, agreement),
            tuple(known),
            mistakes,
            (*(x for x in bounds if x not in mistakes), *left_open, *_of_model(beside, nominal)),
            beside,
            combinations.sensitivities(problem, fixed),
            spoilt,
        )


def excluding_bounds(study: Study) -> tuple[Finding, ...]:
    """Return the bounds that exclude what fits the data, if any, as the verdict of a run does.

    The most probable model is the one to which the nominal one leads. Where nothing is expected of
    the errors of some residuals, that is said instead.
    """
    problem = study.problem
    noise = study.noise.of(problem, study.uncertainty.of(problem.data))
    if noise is None:
        return (found("not-expected"),) if study.noise.weight else ()
    best = maximum(noise, problem.start)
    if not best.converged or (free := freed(noise, best.theta)) is None:
        return ()
    sides = at_bounds(best.theta, problem.lower, problem.upper)
    of = problem.model.parameters, problem.objectives
    wrong = knowledge.bound(*of, sides, best.theta, noise.over_expected(best.J[:-1]), free)
    return () if wrong is None else (wrong,)


def _of_model(beside: Comparison, nominal: Evaluation) -> Iterator[Finding]:
    """Warn of modes that coincide, of bounds, of elements, and of so much that a run takes long."""
    problem = beside.problem
    if same := turning(beside, np.flatnonzero(nominal.quantities["coincident"])):
        modes = ", ".join(str(problem.data.modes[r]) for r in same)
        yield found("coincident", modes, many=len(same) > 1)
    names, full = problem.model.parameters, full_of(problem.model)
    for j in np.flatnonzero((problem.start == problem.lower) | (problem.start == problem.upper)):
        yield found("nominal-at-bound", names[j], bound=float(problem.start[j]))
    # A basis may not hold what makes a matrix indefinite.
    for name, theta in (("lower", problem.lower), ("upper", problem.upper)):
        try:
            replace(problem, model=full).modes(theta, derivatives=False)
        except ModelError as error:
            yield found("no-model-at-bounds", name, why=str(error))
    for text in full.limits if isinstance(full, MatrixModel) else ():
        yield found("elements", text)
    if len(problem.data.sets) > COMPARED:
        yield found("many-sets", str(len(problem.data.sets)), searched=COMPARED)
    if len(names) > MANY:
        yield found("many-parameters", str(len(names)), size=memory_of(problem) / 1e9)


def turning(beside: Comparison, coincident: Ints) -> list[int]:
    """Return which of some measured modes have residuals that change with the shape of each alone.

    ``coincident`` are positions of modes whose model modes have the frequency of others. A sum of
    such modes is a mode as well, so that a residual that changes with it is not defined.
    """
    problem, pairs, out = beside.problem, beside.pairs, list[int]()
    modes = Modes((2 * np.pi * beside.frequency) ** 2, beside.phi)
    given = np.concatenate(problem.vectors(modes, pairs))
    for r in coincident.tolist():
        q, phi = pairs.index[r], modes.phi.copy()
        phi[:, q] += phi[:, np.argsort(np.abs(modes.lam - modes.lam[q]), kind="stable")[:2]].sum(1)
        turned = np.concatenate(problem.vectors(replace(modes, phi=phi), pairs))
        out += [r] * (not np.allclose(turned, given, rtol=0, atol=np.sqrt(COMPUTED)))
    return out


def memory_of(problem: UpdatingProblem) -> float:
    """Return the bytes that second derivatives of the models take that a search keeps."""
    return 8.0 * KEPT * len(problem.groups) * len(problem.model.parameters) ** 2


def refuse_too_many(problem: UpdatingProblem, file: str) -> None:
    """Raise InputError where models with so many parameters do not fit into the memory."""
    need, free = memory_of(problem), available_memory()
    if need > free:
        p = len(problem.model.parameters)
        expected = f"as many parameters as fit into the {free / 1e9:.3g} GB of memory that are free"
        found = (
            f"{p}, for which each model keeps {len(problem.groups)} matrices of {p} x {p}, and a "
            f"search some {KEPT} models, {need / 1e9:.3g} GB: let one parameter scale several "
            "parts, or keep those at their nominal values that the data do not determine"
        )
        refuse([Fault(file, "[[parameter]]", expected, found)])


def refuse_unchanged_groups(problem: UpdatingProblem, file: str, unchanged: Sequence[int]) -> None:
    """Raise InputError where no parameter changes a group, whose minimum were one of rounding."""
    faults = []
    for i in unchanged:
        remarks = dict.fromkeys(member.remark for member in problem.members[i])
        found = (
            "none: no parameter changes them within its bounds, so there is nothing to update; "
            "remove the group, or give it other members or the model other parameters"
        )
        found += f" ({'; '.join(remarks)})" * all(remarks)  # any model fits it
        place = f"[[group]] '{problem.objectives[i]}'"
        faults.append(Fault(file, place, "residuals that a parameter changes", found))
    refuse(faults)


def determined(
    problem: UpdatingProblem, nominal: Evaluation, weights: Floats | None = None
) -> tuple[list[Finding], list[Finding]]:
    """Return which combinations each group, and all, determine near the nominal parameters.

    ``weights`` (n,) of the groups are those of expected errors. Beside these are the parameters
    without effect, what all data leave open, and those alike.
    """
    names, of = problem.model.parameters, combinations.determination(problem, nominal, weights)
    left_open = knowledge.no_effect(of.idle, names)
    degrees: dict[str, list[str]] = {"do not determine": [], "hardly determine": []}
    for each in of.combinations[-1][1]:
        if each.share < combinations.WEAK and np.linalg.norm(each.direction[of.idle]) <= 0.5**0.5:
            degree = "do not determine" if each.share <= combinations.NONE else "hardly determine"
            degrees[degree].append(knowledge.in_words(each, names))
    for degree, texts in degrees.items():
        if len(texts) > knowledge.SHOWN:
            several, every = len(texts), len(names) - len(of.idle)
            many = found("undetermined-many", degree=degree, several=several, every=every)
            left_open.append(many)
        else:
            left_open += [found("undetermined", text, degree=degree) for text in texts]
    known = list(knowledge.summaries(problem, of))
    return known, [*left_open, *knowledge.alike(of.effects, names, of.idle)]


@dataclass(frozen=True)
class Agreement:
    """Agreement of derivatives with finite differences.

    The ``error`` is the greatest difference over the greatest derivative of the residuals of a
    group, NaN where the model is not defined around the point ``theta``; it is that of a group, of
    the number ``objective``, and of a ``step`` (p,) of the parameters.
    """

    error: float
    theta: Floats
    objective: int
    step: Floats


def compared(problem: UpdatingProblem) -> Agreement:
    """Return the agreement of the derivatives of the residuals near the nominal parameters.

    Where bounds leave no room for a step, it leaves them.
    """
    span = problem.upper - problem.lower
    squares = np.einsum("ijj->ij", problem.evaluate(problem.start).H) / 2
    size = np.sqrt((squares / problem.properties[:, None]).max(axis=0))
    most = SHARE / STEP * np.where(problem.start != 0, np.abs(problem.start), span)
    unit = np.minimum(np.divide(1.0, size, out=span.copy(), where=size > 0), most)
    room = np.minimum(STEP * unit, span / 2)
    theta = np.clip(problem.start, problem.lower + room, problem.upper - room)
    # One parameter a direction, or several together, with signs by chance.
    numbers = np.arange(unit.size)
    place = numbers % MOST
    together = np.bincount(place)[place]
    directions = np.zeros((min(unit.size, MOST), unit.size))
    signs = np.random.default_rng(0).choice((-1.0, 1.0), unit.size)
    directions[place, numbers] = unit * np.where(together > 1, signs / np.sqrt(together), 1)
    evaluation = problem.evaluate(theta)
    if not evaluation.feasible:
        return Agreement(float("nan"), theta, 0, STEP * directions[0])
    _, pairs = problem.modes(theta, derivatives=False)
    exact = [residual.dr @ directions.T for residual in evaluation.residuals]
    scale = [float(np.linalg.norm(x, axis=0).max()) or 1.0 for x in exact]
    error = np.empty((len(exact), len(directions)))
    for column, d in enumerate(directions):
        slopes = _slopes(problem, pairs, theta, d)
        for row, slope in enumerate(slopes):
            error[row, column] = np.linalg.norm(slope - exact[row][:, column]) / scale[row]
    i, k = np.unravel_index(int(np.argmax(error)), error.shape)  # the first NaN, if there is any
    return Agreement(float(error[i, k]), theta, int(i), STEP * directions[k])


def _slopes(problem: UpdatingProblem, pairs: Pairs, theta: Floats, d: Floats) -> list[Floats]:
    """Return the slopes of the residuals of pairs along d, with shorter steps where need be.

    NaN where the model is not defined with the shortest.
    """
    for h in (STEP, STEP / 8, STEP / 64):
        points = [theta + x * d for x in (h / 2, -h / 2, h, -h)]
        try:
            modes = [problem.modes(x, derivatives=False)[0] for x in points]
            vectors = [problem.vectors(each, pairs) for each in modes]
        except ModelError:
            continue
        each_group = zip(*vectors, strict=True)
        return [(4 * (a - b) / h - (e - f) / (2 * h)) / 3 for a, b, e, f in each_group]
    return [np.full(1, np.nan) for _ in problem.groups]


def cause_of(problem: UpdatingProblem, agreement: Agreement) -> Finding:
    """Return which parameter and mode derivatives are wrong for, and the likely cause."""
    names = [problem.model.parameters[j] for j in np.flatnonzero(agreement.step)]
    of, theta, step = knowledge.enumeration(names, knowledge.SHOWN), agreement.theta, agreement.step
    for point in (theta, theta + step, theta - step):
        try:
            problem.modes(point, derivatives=False)
        except ModelError as error:
            return found("no-model-near", of, why=str(error))
    points = [problem.evaluate(theta + k * step, derivatives=False) for k in (-1, -0.5, 0, 0.5, 1)]
    values = np.array([[x.quantities[name] for x in points] for name in ("frequency", "mac")])
    # Fourth differences: what is left of a smooth curve is close to nothing.
    fourth = np.array([1, -4, 6, -4, 1]) @ values
    bend = np.abs(np.nan_to_num(fourth / np.abs(values[:, 2]).clip(TINY)))
    r = int(np.argmax(bend.max(axis=0)))
    where: dict[str, Any] = {
        "group": problem.objectives[agreement.objective],
        "mode": problem.data.modes[r],
        "error": agreement.error,
    }
    frequency = np.sort(problem.modes(theta, derivatives=False)[0].frequency)
    k = int(points[2].quantities["paired_mode"][r]) - 1
    near = [abs(frequency[i] / frequency[k] - 1) for i in (k - 1, k + 1) if 0 <= i < len(frequency)]
    if frequency[k] > 0 and near and min(near) < 1e-3:
        return found("close-modes", of, model=k + 1, apart=float(100 * min(near)), **where)
    effects = np.sqrt(np.einsum("ijj->j", problem.evaluate(theta).H) / 2) * np.abs(theta)
    known = effects[effects > 0]
    if known.size and known.max() > 1e12 * known.min():
        return found("unlike-effects", of, ratio=float(known.max() / known.min()), **where)
    little = (np.abs(step) > np.abs(theta) + TINY).any()
    return found("little-effect" if little else "not-smooth", of, **where)
