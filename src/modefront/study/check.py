"""Check of a study before it is run: mistakes, derivatives, undetermined parameters."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from threadpoolctl import threadpool_limits

from modefront.brief import as_html
from modefront.diagnosis.comparison import COMPARED, Comparison, compare
from modefront.diagnosis.search import Found, diagnose
from modefront.diagnosis.sensitivity import Sensitivities, sensitivities
from modefront.errors import Fault, InputError, ModelError
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
    Combination,
    combinations,
    gram,
    optimal_weights,
    unchanged_groups,
    without_effect,
)
from modefront.identifiability.scale import Scale, scale_at
from modefront.inputs import available_memory
from modefront.models.base import Model, full_of
from modefront.models.matrices import MatrixModel
from modefront.optim.problem import Evaluation
from modefront.residuals.problem import UpdatingProblem
from modefront.study.definition import Study
from modefront.study.derivatives import AGREEMENT, cause_of, compared

MANY = 100
"""Parameters from which on a run is said to take long."""

KEPT = 500
"""Models that a search keeps with their second derivatives, some."""


HARMLESS = (
    *("damping", "unused-group", "distant-pair", "far-from-model"),
    *("beyond-candidates", "foreign-mode"),
)
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
        *_coincident(problem, nominal),
        *_at_bounds(problem),
        *_infeasible_bounds(problem),
        *_of_elements(problem.model),
        *_many(problem),
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


def _coincident(problem: UpdatingProblem, nominal: Evaluation) -> list[str]:
    """Warn of modes that coincide with others."""
    return [
        f"mode {r} of the nominal model coincides with another one: its derivatives are not defined"
        for r, coincident in zip(problem.data.modes, nominal.quantities["coincident"], strict=True)
        if coincident
    ]


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
        raise InputError(Fault(file, "[[parameter]]", expected, found))


def _many(problem: UpdatingProblem) -> list[str]:
    """Warn of so many parameters that a run takes long, and data sets that are not looked at."""
    p, sets = len(problem.model.parameters), len(problem.data.sets)
    out = []
    if sets > COMPARED:
        out.append(
            f"{sets} data sets are many: mistakes are sought in {COMPARED} of them, chosen evenly"
        )
    if p <= MANY:
        return out
    return [
        *out,
        f"{p} parameters are many: a run takes some {memory_of(problem) / 1e9:.2g} GB and long, as "
        "every step solves for all of them; let one parameter scale several parts, or keep those "
        "at their nominal values that the data do not determine",
    ]


def _of_elements(model: Model) -> Sequence[str]:
    """Warn of elements that are too coarse, small or distorted."""
    full = full_of(model)
    return full.limits if isinstance(full, MatrixModel) else ()


def _at_bounds(problem: UpdatingProblem) -> list[str]:
    """Warn of nominal values that are bounds."""
    values = zip(problem.model.parameters, problem.start, problem.lower, problem.upper, strict=True)
    return [
        f"the nominal value of {name} is one of its bounds, {value:g}"
        for name, value, *bounds in values
        if value in bounds
    ]


def refuse_unchanged_groups(problem: UpdatingProblem, file: str, unchanged: Sequence[int]) -> None:
    """Raise InputError where no parameter changes a group: its minimum would be made of rounding.

    ``unchanged`` are the positions of these groups.
    """
    faults = [
        Fault(
            file,
            f"[[group]] '{problem.objectives[i]}'",
            "residuals that a parameter changes",
            "none: no parameter changes them within its bounds, so there is nothing to update; "
            "remove the group, or give it other members or the model other parameters"
            + _fitted_by_any(problem, i),
        )
        for i in unchanged
    ]
    if faults:
        raise InputError(faults)


def _fitted_by_any(problem: UpdatingProblem, i: int) -> str:
    """Return why any model fits a group, where that is so of all of its members."""
    remarks = [member.remark for member in problem.members[i]]
    return f" ({'; '.join(dict.fromkeys(remarks))})" if all(remarks) else ""


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
    weights = optimal_weights(problem.properties, nominal.J)
    idle = without_effect(problem, nominal, scale)
    if parameters_only:
        return [str(finding) for finding in no_effect(idle, names)]
    known = combinations(problem, problem.start, weights=weights, scale=scale)
    weak = [each for each in known if each.share < WEAK and not _is_of(idle, each)]
    out = [str(finding) for finding in no_effect(idle, names)]
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


def _is_of(idle: Sequence[int], combination: Combination) -> bool:
    """Return whether a combination is one of parameters without effect."""
    return bool(np.linalg.norm(combination.direction[list(idle)]) > np.sqrt(0.5))


def _infeasible_bounds(problem: UpdatingProblem) -> list[str]:
    """Warn where the model has no modes at the bounds of all parameters at once.

    The full model is evaluated: a basis may not hold what makes a matrix indefinite.
    """
    problem = replace(problem, model=full_of(problem.model))
    out = []
    for name, theta in (("lower", problem.lower), ("upper", problem.upper)):
        try:
            problem.modes(theta, derivatives=False)
        except ModelError as error:
            out.append(f"at the {name} bounds of all parameters: {error}")
    return out
