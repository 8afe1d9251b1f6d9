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

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from threadpoolctl import threadpool_limits

from modefront._typing import Floats
from modefront.brief import as_html
from modefront.diagnosis.comparison import COMPARED, Comparison, compare
from modefront.diagnosis.search import Found, diagnose
from modefront.diagnosis.sensitivity import Sensitivities, sensitivities
from modefront.errors import Fault, ModelError, refuse
from modefront.findings.knowledge import (
    SHOWN,
    alike,
    in_words,
    measured_noun,
    no_effect,
    summary,
)
from modefront.findings.record import Finding
from modefront.identifiability.combinations import (
    NONE,
    WEAK,
    combinations,
    gram,
    optimal_weights,
    unchanged_groups,
    without_effect,
)
from modefront.identifiability.scale import Scale, scale_at
from modefront.inputs import available_memory
from modefront.models.base import full_of
from modefront.models.matrices import MatrixModel
from modefront.optim.problem import Evaluation
from modefront.pairing.match import Pairs
from modefront.residuals.problem import UpdatingProblem
from modefront.rounding import TINY
from modefront.study.definition import Study

AGREEMENT = 1e-5
"""Greatest relative error of derivatives that finite differences explain."""

STEP = 2e-3
"""Change of a residual in its own unit, root mean square, that a finite difference makes."""

SHARE = 0.02
"""Share of a parameter, or of its range where it is zero, that a step takes at most."""

MOST = 60
"""Directions in which derivatives are compared, at most."""

MANY = 100
"""Parameters from which on a run is said to take long."""

KEPT = 500
"""Models that a search keeps with their second derivatives, some."""


HARMLESS = {
    "damping",
    "unused-group",
    "distant-pair",
    "far-from-model",
    "beyond-candidates",
    "foreign-mode",
}
"""Mistakes that leave the residuals as they are, or that need not be mistakes."""

Mistake = Found | Finding
"""What looks wrong: a record with a kind and a subject, and a sentence as its text."""


@dataclass(frozen=True)
class Findings:
    """The outcome of a check.

    Attributes
    ----------
    derivative_error : greatest difference of exact derivatives of the residuals of a group from
        central differences near the nominal parameters, over the greatest of their derivatives;
        NaN where the model is not defined around them
    derivative_cause : which parameter and mode they differ for, and why; empty where they agree
    determined : which combinations of parameters each group and all of them determine
    warnings : what a user should know before relying on the results; `mistakes` in words first
    mistakes : what looks wrong in the model or the data, with its numbers
    beside : the nominal model beside the measured modes
    sensitivities : of the modes to the parameters
    """

    derivative_error: float
    derivative_cause: str
    determined: tuple[str, ...]
    warnings: tuple[str, ...]
    mistakes: tuple[Mistake, ...]
    beside: Comparison
    sensitivities: Sensitivities

    def __repr__(self) -> str:
        """Return the first warnings, one a line."""
        agree = "agree with" if self.sound else "DIFFER FROM"
        count = len(self.warnings)
        more = [f"and {count - SHOWN} more: see warnings"] * (count > SHOWN)
        first = f"Findings: derivatives {agree} finite differences; {count or 'no'} warnings"
        return "\n".join([first, *self.warnings[:SHOWN], *more])

    _repr_html_ = as_html

    @property
    def sound(self) -> bool:
        """Whether the derivatives agree with finite differences."""
        return self.derivative_error <= AGREEMENT


def check(study: Study) -> Findings:
    """Return the error of the derivatives of a study, and warnings before it is run.

    Parameters
    ----------
    study
        The study; a few models are evaluated, and none is sought.

    Raises
    ------
    InputError
        If no parameter changes a group.
    """
    with threadpool_limits(1, user_api="blas"):  # threads wait for each other on small matrices
        return _checked(study)


def _checked(study: Study) -> Findings:
    problem = study.problem
    refuse_unchanged_groups(problem, str(study.file), unchanged_groups(problem))
    nominal = problem.evaluate(problem.start)
    scale = scale_at(problem, problem.start)
    beside = compare(problem)
    mistakes = (*diagnose(beside), *(study.origin.notes if study.origin else ()))
    warnings = [
        *map(str, mistakes),
        *_undetermined(problem, nominal, scale, parameters_only=spoils(mistakes)),
        *_of_model(problem, nominal),
    ]
    agreement = compared(problem)
    cause = "" if agreement.error <= AGREEMENT else cause_of(problem, agreement)
    return Findings(
        agreement.error,
        cause,
        determined(problem),
        tuple(warnings),
        mistakes,
        beside,
        sensitivities(problem),
    )


def spoils(mistakes: Sequence[Mistake]) -> bool:
    """Return whether mistakes change the residuals, and with them what the data determine."""
    return any(each.kind not in HARMLESS for each in mistakes)


def _of_model(problem: UpdatingProblem, nominal: Evaluation) -> Iterator[str]:
    """Warn of modes that coincide, of bounds, of elements, and of so much that a run takes long."""
    for r, coincident in zip(problem.data.modes, nominal.quantities["coincident"], strict=True):
        if coincident:
            yield (
                f"mode {r} of the nominal model coincides with another one: its derivatives are "
                "not defined"
            )
    ends = {"lower": problem.lower, "upper": problem.upper}
    for name, value, *bounds in zip(
        problem.model.parameters, problem.start, *ends.values(), strict=True
    ):
        if value in bounds:
            yield f"the nominal value of {name} is one of its bounds, {value:g}"
    full = full_of(problem.model)  # a basis may not hold what makes a matrix indefinite
    for name, theta in ends.items():
        try:
            replace(problem, model=full).modes(theta, derivatives=False)
        except ModelError as error:
            yield f"at the {name} bounds of all parameters: {error}"
    yield from full.limits if isinstance(full, MatrixModel) else ()
    p, sets = len(problem.model.parameters), len(problem.data.sets)
    if sets > COMPARED:
        yield f"{sets} data sets are many: mistakes are sought in {COMPARED} of them, chosen evenly"
    if p > MANY:
        yield (
            f"{p} parameters are many: a run takes some {memory_of(problem) / 1e9:.2g} GB and "
            "long, as every step solves for all of them; let one parameter scale several parts, "
            "or keep those at their nominal values that the data do not determine"
        )


def memory_of(problem: UpdatingProblem) -> float:
    """Return the bytes that second derivatives of the models take that a search keeps."""
    p = len(problem.model.parameters)
    return 8.0 * KEPT * len(problem.groups) * p**2


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
    """Raise InputError where no parameter changes a group: its minimum would be made of rounding.

    ``unchanged`` are the positions of these groups.
    """
    faults = []
    for i in unchanged:
        remarks = [member.remark for member in problem.members[i]]
        found = (
            "none: no parameter changes them within its bounds, so there is nothing to update; "
            "remove the group, or give it other members or the model other parameters"
        )
        if all(remarks):  # any model fits it
            found += f" ({'; '.join(dict.fromkeys(remarks))})"
        place = f"[[group]] '{problem.objectives[i]}'"
        faults.append(Fault(file, place, "residuals that a parameter changes", found))
    refuse(faults)


def determined(problem: UpdatingProblem) -> tuple[str, ...]:
    """Return the sentences on the combinations that each group, and all, determine."""
    names, groups = problem.model.parameters, problem.groups
    nominal, scale = problem.evaluate(problem.start), scale_at(problem, problem.start)
    idle = without_effect(problem, nominal, scale)
    out = []
    for i, group in enumerate(groups):
        of_group = combinations(problem, problem.start, i, scale=scale)
        out.append(str(summary(group.name, measured_noun([group]), of_group, names, scale, idle)))
    if len(groups) > 1:
        weights = optimal_weights(problem.properties, nominal.J)
        of_all = combinations(problem, problem.start, weights=weights, scale=scale)
        noun = measured_noun(groups)
        out.append(str(summary("all data together", noun, of_all, names, scale, idle)))
    return tuple(out)


def _undetermined(
    problem: UpdatingProblem, nominal: Evaluation, scale: Scale, *, parameters_only: bool
) -> list[str]:
    """Warn of parameters without effect, of what all data leave open, and of parameters alike.

    Mistakes change what the residuals determine: then ``parameters_only`` without effect are named.
    """
    names = problem.model.parameters
    idle = without_effect(problem, nominal, scale)
    out = [str(finding) for finding in no_effect(idle, names)]
    if parameters_only:
        return out
    weights = optimal_weights(problem.properties, nominal.J)
    weak = [
        each
        for each in combinations(problem, problem.start, weights=weights, scale=scale)
        if each.share < WEAK and np.linalg.norm(each.direction[list(idle)]) <= np.sqrt(0.5)
    ]
    for degree, chosen in (
        ("do not determine", [each for each in weak if each.share <= NONE]),
        ("hardly determine", [each for each in weak if each.share > NONE]),
    ):
        if len(chosen) > SHOWN:
            out.append(
                f"the data {degree} {len(chosen)} of {len(names) - len(idle)} combinations of "
                "parameters: take fewer parameters, or measure more"
            )
            continue
        out += [
            f"the data {degree} {in_words(each, names)}: fix or tie one, or measure more"
            for each in chosen
        ]
    return [*out, *map(str, alike(gram(nominal, weights, scale), names, idle))]


@dataclass(frozen=True)
class Agreement:
    """Agreement of derivatives with finite differences.

    Attributes
    ----------
    error : greatest difference over the greatest derivative of the residuals of a group; NaN where
        the model is not defined around the point
    theta : the point
    objective : number of the group with this difference
    step : (p,) change of the parameters for a difference, in the direction with this difference
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
    evaluation = problem.evaluate(theta)
    directions = _directions(unit)
    if not evaluation.feasible:
        return Agreement(float("nan"), theta, 0, STEP * directions[0])
    _, pairs = problem.modes(theta, derivatives=False)
    exact = [residual.dr @ directions.T for residual in evaluation.residuals]
    scale = [float(np.linalg.norm(x, axis=0).max()) or 1.0 for x in exact]
    error = np.empty((len(exact), len(directions)))
    for column, d in enumerate(directions):
        slopes = _slopes(problem, pairs, theta, d)
        error[:, column] = [
            np.linalg.norm(slope - x[:, column]) / size
            for slope, x, size in zip(slopes, exact, scale, strict=True)
        ]
    i, k = np.unravel_index(int(np.argmax(error)), error.shape)  # the first NaN, if there is any
    return Agreement(float(error[i, k]), theta, int(i), STEP * directions[k])


def _directions(unit: Floats) -> Floats:
    """Return directions (k, p), one a parameter, or several parameters together."""
    count = min(len(unit), MOST)
    out = np.zeros((count, len(unit)))
    signs = np.random.default_rng(0).choice((-1.0, 1.0), len(unit))
    place = np.arange(len(unit)) % count
    together = np.bincount(place)[place]
    out[place, np.arange(len(unit))] = unit * np.where(together > 1, signs / np.sqrt(together), 1)
    return out


def _slopes(
    problem: UpdatingProblem, pairs: Pairs, theta: Floats, direction: Floats
) -> list[Floats]:
    """Return the slopes of the residuals of pairs, with a shorter step where the model needs one.

    NaN where the model is not defined with the shortest.
    """

    def changed(h: float) -> list[Floats]:
        modes, _ = problem.modes(theta + h * direction, derivatives=False)
        return problem.vectors(modes, pairs)

    for h in (STEP, STEP / 8, STEP / 64):
        try:
            half, whole = (
                [(a - b) / (2 * k) for a, b in zip(changed(k), changed(-k), strict=True)]
                for k in (h / 2, h)
            )
            return [(4 * x - y) / 3 for x, y in zip(half, whole, strict=True)]
        except ModelError:
            continue
    return [np.full(1, np.nan) for _ in problem.groups]


def cause_of(problem: UpdatingProblem, agreement: Agreement) -> str:
    """Return which parameter and mode derivatives are wrong for, and the likely cause."""
    names = [problem.model.parameters[j] for j in np.flatnonzero(agreement.step)]
    of = ", ".join(names[:3]) + (f" and {len(names) - 3} more" if len(names) > 3 else "")
    theta, step = agreement.theta, agreement.step
    for point in (theta, theta + step, theta - step):
        try:
            problem.modes(point, derivatives=False)
        except ModelError as error:
            return f"for {of}: a small change leads to no model: {error}; check its value and units"
    group = problem.objectives[agreement.objective]
    mode, why = _mode_and_cause(problem, theta, step)
    return (
        f"of group '{group}' for {of}, mostly by measured mode {mode} "
        f"(relative {agreement.error:.1e}): {why}"
    )


def _mode_and_cause(problem: UpdatingProblem, theta: Floats, step: Floats) -> tuple[int, str]:
    """Return the measured mode that changes least smoothly, and what that is likely due to."""
    points = [problem.evaluate(theta + k * step, derivatives=False) for k in (-1, -0.5, 0, 0.5, 1)]
    values = {name: np.array([x.quantities[name] for x in points]) for name in ("frequency", "mac")}
    bend = np.zeros(len(problem.data.modes))
    for of in values.values():
        # Fourth differences: what is left of a smooth curve is close to nothing.
        fourth = of[0] - 4 * of[1] + 6 * of[2] - 4 * of[3] + of[4]
        bend = np.maximum(bend, np.abs(np.nan_to_num(fourth / np.abs(of[2]).clip(TINY))))
    r = int(np.argmax(bend))
    mode = problem.data.modes[r]
    frequency = np.sort(problem.modes(theta, derivatives=False)[0].frequency)
    k = int(points[2].quantities["paired_mode"][r]) - 1
    near = [abs(frequency[i] / frequency[k] - 1) for i in (k - 1, k + 1) if 0 <= i < len(frequency)]
    if frequency[k] > 0 and near and min(near) < 1e-3:
        return mode, (
            f"model mode {k + 1} and its neighbour are {100 * min(near):.2g} % apart, and close "
            "modes turn into each other within a small change of the parameter"
        )
    effects = np.sqrt(np.einsum("ijj->j", problem.evaluate(theta).H) / 2) * np.abs(theta)
    known = effects[effects > 0]
    if known.size and known.max() > 1e12 * known.min():
        return mode, (
            f"parameters differ by {known.max() / known.min():.0e} in their effect: check units "
            "of the matrices, and whether a stiffness vanishes"
        )
    if (np.abs(step) > np.abs(theta) + TINY).any():
        return mode, (
            "the parameter has so little effect that a step beyond its own size is needed to see "
            "any: check its value, its units, and whether a stiffness vanishes"
        )
    return mode, (
        "the model does not change smoothly there, or digits are lost in it: check its units, and "
        "whether a stiffness or mass vanishes; derivatives of a Python model have to be those of "
        "its matrices"
    )
