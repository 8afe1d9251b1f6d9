r"""What is expected of the errors of the data and the model, before the data are fitted.

The residuals of group i over their expected standard deviations are Gaussian with an unknown
variance of scaled inverse chi-square prior: :math:`\nu` degrees of freedom, about :math:`m_i`. It
is integrated out (docs/uncertainty.md), and the most probable model has the bounded weights
:math:`w_i = (a_i + \nu) / (J_i' - S_i + \nu m_i)`.

Expected standard deviations are those of the data, else those that are assumed. The scatter S of
the data sets about their mean, of d degrees of freedom, corrects these to :math:`m_i = (\nu + S_i)
/ (\nu + d_i)`. Repeated data sets count once in :math:`a_i`: errors of the model are the same in
all of them.

The prior of the parameters is uniform within their bounds, and where neither data nor bounds say
anything a parameter is nearest to its nominal value: :math:`-2 \ln p` has the further term
:math:`\varepsilon \sum_j (\theta_j - \theta_{0 j})^2 / range_j^2`. For a parameter of normal prior
that term is :math:`(\theta_j - \theta_{0 j})^2 / \sigma_j^2`, and of lognormal prior
:math:`\ln^2 (\theta_j / \theta_{0 j}) / \sigma_j^2`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np

from modefront._typing import Floats
from modefront.data.modal import ModalData
from modefront.optim.problem import Evaluation, ObjectiveDerivatives, Problem, Residual, Wrapped
from modefront.optim.scalarisation import LogSum, Rows, no_rows
from modefront.options import check_fields, number
from modefront.residuals.base import NEGLIGIBLE
from modefront.residuals.groups import Group
from modefront.residuals.problem import UpdatingProblem
from modefront.residuals.shape import without_negligible
from modefront.uncertainty.noise import Source

PULL = 1e-6
"""Weight of the distance from the nominal model: a normal prior of a thousand ranges."""


NINETY = 1.6449
"""Half the 90 % interval of a normal distribution, over its standard deviation."""


@dataclass(frozen=True)
class NoisePrior:
    """What is expected of the errors of measurement and model together.

    Raises InputError for values that are not possible.

    Attributes
    ----------
    frequency : relative standard deviation of a frequency, where the data have none
    shape : of a component of a shape, over the greatest one, on average over the shapes
    weight : how many data this expectation is worth; 0 for none, and optimal weights
    """

    frequency: Annotated[float, number("a number above 0", above=0)] = 0.005
    shape: Annotated[float, number("a number above 0", above=0)] = 0.03
    weight: Annotated[float, number("a number of 0 or more", least=0)] = 4.0

    def __post_init__(self) -> None:
        check_fields(self)

    def of(self, problem: UpdatingProblem, source: Source | None) -> NoiseModel | None:
        """Return the model of the errors of a problem; None without weight.

        ``source`` says where errors are taken from; assumed ones where it is None or silent.
        """
        if self.weight == 0:
            return None
        data, assumed = expected(problem.data, self, source)
        groups = tuple(
            Group(each.name, scale="std", **dict(each.chosen)) for each in problem.groups
        )
        scaled = replace(problem, data=data, groups=groups)
        parts = [[member.independent() for member in row] for row in scaled.members]
        a, S, d = np.array([np.sum(row, axis=0) for row in parts]).T
        level = np.ones(a.size)
        if source == "sets":
            level = (self.weight + S) / (self.weight + d)
        sizes = {"frequency": f"frequencies known to {100 * self.frequency:g} %"}
        sizes["shape"] = f"shapes to {100 * self.shape:g} %"
        words = ", ".join(sizes[kind] for kind in assumed)
        logs = LogSum(a + self.weight, self.weight * level - S)
        return NoiseModel(replace(scaled, likelihood=logs), a, S, level, self.weight, words)


@dataclass(frozen=True)
class NoiseModel:
    """Residuals in units of their expected standard deviations, and the prior of their variances.

    Attributes
    ----------
    problem : with these residuals, summed over the data sets
    a : (n,) counts of independent errors
    S : (n,) the part of J' that no model explains
    level : (n,) expected variance m
    weight : degrees of freedom nu of the prior
    assumed : in words, which errors are assumed; empty for none
    """

    problem: UpdatingProblem
    a: Floats
    S: Floats
    level: Floats
    weight: float
    assumed: str

    @property
    def programme(self) -> NegativeLogPosterior:
        """What the most probable model minimises: -2 ln p as a function of J'."""
        return NegativeLogPosterior(LogSum(self.a + self.weight, self.weight * self.level - self.S))

    @property
    def target(self) -> Problem:
        """The problem with the distance from the nominal model as a further objective."""
        names = (*self.problem.objectives, "distance from the nominal model")
        distance = Distance(self.problem, self.problem.start, PULL)
        return Wrapped(self.problem, distance.evaluation, names)

    def over_expected(self, J: Floats) -> Floats:
        """Return the root mean square errors (n,) of J' (n,) over those expected."""
        return np.sqrt(np.maximum(J - self.S, 0.0) / (np.maximum(self.a, 1.0) * self.level))


@dataclass(frozen=True)
class NegativeLogPosterior:
    """-2 ln p of J' (n,) and of the distance from the nominal model; see the module."""

    logs: LogSum

    @property
    def constraints(self) -> Rows:
        """No constraints."""
        return no_rows(self.logs.a.size + 1)

    @property
    def maximised(self) -> Rows:
        """No maximum."""
        return no_rows(self.logs.a.size + 1)

    def value(self, J: Floats) -> float:
        """Return -2 ln p."""
        return self.logs.value(J[:-1]) + float(J[-1])

    def gradient(self, J: Floats) -> Floats:
        """Return its derivatives with respect to the objectives."""
        return np.append(self.logs.gradient(J[:-1]), 1.0)

    def hessian(self, J: Floats) -> Floats:
        """Return its second derivatives."""
        out = np.zeros((J.size, J.size))
        out[:-1, :-1] = self.logs.hessian(J[:-1])
        return out


@dataclass(frozen=True)
class Distance:
    """Distance of parameters from others, in the units of their priors.

    Attributes
    ----------
    problem : with bounds and priors
    centre : (p,) parameters from which it is
    weight : of a distance of one range, for parameters of uniform prior
    """

    problem: UpdatingProblem
    centre: Floats
    weight: float

    def residuals(self, theta: Floats) -> tuple[Floats, Floats, Floats]:
        """Return the distances (p,) and their first and second derivatives."""
        unit = np.sqrt(self.weight) / (self.problem.upper - self.problem.lower)
        r, dr, d2r = unit * (theta - self.centre), unit.copy(), np.zeros(unit.size)
        for j, prior in enumerate(self.problem.priors):
            if prior and prior.kind == "normal":
                r[j], dr[j] = (theta[j] - self.centre[j]) / prior.std, 1 / prior.std
            elif prior:
                r[j] = np.log(theta[j] / self.centre[j]) / prior.std
                dr[j], d2r[j] = 1 / (theta[j] * prior.std), -1 / (theta[j] ** 2 * prior.std)
        return r, dr, d2r

    def evaluation(
        self, problem: Problem, theta: Floats, derivatives: bool, second: bool
    ) -> Evaluation:
        """Return the evaluation of a problem with the square of the distance as last objective."""
        found = problem.evaluate(theta, derivatives=derivatives, second=second)
        r, dr, d2r = self.residuals(theta)
        J = np.append(found.J, r @ r if found.feasible else np.inf)
        if found.derivatives is None:
            return replace(found, J=J)
        curved = dr**2 + r * d2r if found.exact else dr**2
        slopes = ObjectiveDerivatives(
            np.vstack([found.dJ, 2 * r * dr]),
            np.concatenate([found.H, 2 * np.diag(curved)[None]]),
            found.exact,
        )
        residuals = (*found.residuals, Residual(r, np.diag(dr)))
        return replace(found, J=J, derivatives=slopes, residuals=residuals)


def drawn_prior(problem: UpdatingProblem, rng: np.random.Generator) -> Floats:
    """Return parameters (p,) drawn from their prior; those beyond the bounds lie at them."""
    theta = rng.uniform(problem.lower, problem.upper)
    for j, prior in enumerate(problem.priors):
        if prior:
            z = prior.std * rng.normal()
            nominal = problem.start[j]
            theta[j] = nominal + z if prior.kind == "normal" else nominal * np.exp(z)
    return np.clip(theta, problem.lower, problem.upper)


def prior_widths(problem: UpdatingProblem) -> Floats:
    """Return the widths (p,) of the 90 % intervals of the priors."""
    out = 0.9 * (problem.upper - problem.lower)
    for j, prior in enumerate(problem.priors):
        if prior:
            far = NINETY * prior.std
            nominal = problem.start[j]
            width = far if prior.kind == "normal" else abs(nominal) * np.sinh(far)
            out[j] = min(out[j], 2 * width)
    return out


def expected(
    data: ModalData, prior: NoisePrior, source: Source | None
) -> tuple[ModalData, tuple[str, ...]]:
    """Return data with expected standard deviations, and the kinds of which some are assumed.

    They are such that means over the data sets become sums.
    """
    known = source == "std"
    there = np.asarray(np.isfinite(data.frequency))
    std = data.frequency_std if known else np.full(data.frequency.shape, np.nan)
    given = np.asarray(std > NEGLIGIBLE * np.where(there, data.frequency, 1.0))
    sets = np.maximum(there.sum(axis=0), 1)
    frequency = np.where(given, std, prior.frequency * data.frequency) / np.sqrt(sets)
    assumed = ["frequency"] if (there & ~given).any() else []

    measured = np.asarray(np.isfinite(data.shape).any(axis=2))
    ratios = [
        np.abs(x).max() / np.sqrt((x**2).mean())
        for k, r in np.argwhere(measured)
        if (x := _components(data.shape[k, r])).any()
    ]
    ratio = float(np.sqrt(np.mean(np.square(ratios)))) if ratios else 1.0
    shape = np.full(data.shape.shape, np.nan)
    for k, r in np.argwhere(measured):
        here = np.isfinite(data.shape[k, r])
        std = np.where(data.shape_std[k, r, here] > 0, data.shape_std[k, r, here], 0.0)
        if known and std.any():
            size = without_negligible(std)
        else:
            assumed += ["shape"]
            rms = np.sqrt((data.shape[k, r, here] ** 2).mean())
            size = np.full(here.sum(), prior.shape * ratio * rms)
        shape[k, r, here] = size / np.sqrt(measured[:, r].sum())
    changed = replace(data, frequency_std=frequency, shape_std=shape)
    return changed, tuple(dict.fromkeys(assumed))


def _components(shape: Floats) -> Floats:
    out: Floats = shape[np.isfinite(shape)]
    return out
