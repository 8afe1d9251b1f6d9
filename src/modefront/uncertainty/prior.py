r"""What is expected of parameters and errors before the data are fitted, and the posterior.

docs/uncertainty.md defines :math:`a_i, S_i, d_i, m_i` and :math:`\nu`, and -2 ln p as a function of
the residuals over their expected standard deviations. Where neither data nor bounds say anything, a
parameter is nearest to its nominal value by the further term :math:`\varepsilon \sum_j (\theta_j -
\theta_{0 j})^2 / range_j^2`; for a parameter of normal or lognormal prior that is its own.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np
from scipy.special import log_ndtr, ndtr, ndtri, ndtri_exp

from modefront._typing import Floats
from modefront.data.modal import ModalData
from modefront.optim.problem import Evaluation, Problem, Residual, Wrapped
from modefront.optim.scalarisation import LogSum
from modefront.options import Checked, number
from modefront.residuals.base import NEGLIGIBLE
from modefront.residuals.groups import Group, faults
from modefront.residuals.problem import UpdatingProblem
from modefront.residuals.shape import without_negligible
from modefront.rounding import TINY
from modefront.uncertainty.noise import Source

PULL = 1e-3  # weight of the distance from the nominal model: a normal prior of thirty ranges

USUAL = {"frequency": 0.005, "shape": 0.03}
"""Standard deviations of errors that are assumed, and said, where no one else says any."""

FREQUENCY = number("a share above 0 and below 0.2, such as 0.005 for 0.5 %", above=0, below=0.2)
SHAPE = number("a share above 0 and below 1, such as 0.03 for 3 %", above=0, below=1)

NINETY = 1.6449  # half the 90 % interval of a normal distribution, over its standard deviation

FARTHEST = 7.0  # distance from the median of a uniform prior, or from bounds of others, at most


@dataclass(frozen=True)
class NoisePrior(Checked):
    """What is expected of the errors of measurement and model together.

    Raises InputError for values that are not possible.

    Attributes
    ----------
    frequency : relative standard deviation of a frequency, where the data have none; None for 0.005
    shape : of a component of a shape, over the greatest one, on average over the shapes; None for
        0.03
    weight : how many data this expectation is worth; 0 for none, and optimal weights
    """

    frequency: Annotated[float, FREQUENCY] | None = None
    shape: Annotated[float, SHAPE] | None = None
    weight: Annotated[float, number("a number of 0 or more", least=0)] = 4.0

    def of(self, problem: UpdatingProblem, source: Source | None) -> "NoiseModel | None":
        """Return the model of the errors of a problem.

        None without weight, and where a residual knows no standard deviation of its errors.
        ``source`` says where errors are taken from; assumed ones where it is None or silent.
        """
        if self.weight == 0:
            return None
        unsaid = {kind: size for kind, size in USUAL.items() if getattr(self, kind) is None}
        sizes = {kind: unsaid.get(kind) or getattr(self, kind) for kind in USUAL}
        groups = tuple(Group(x.name, scale="std", **dict(x.chosen)) for x in problem.groups)

        def data_of(sizes: Mapping[str, float]) -> ModalData | None:
            data = expected(problem.data, sizes, source)
            return None if any(True for x in groups for _ in faults(x, data)) else data

        if (data := data_of(sizes)) is None:
            return None
        said = [
            f"{plural} to {100 * unsaid[kind]:g} %"
            for kind, plural in (("frequency", "frequencies"), ("shape", "shapes"))
            if kind in unsaid and data_of(sizes | {kind: np.nan}) is None  # some group needs it
        ]
        scaled = replace(problem, data=data, groups=groups)
        parts = [[member.independent() for member in row] for row in scaled.members]
        a, S, d = np.array([np.sum(row, axis=0) for row in parts]).T
        least = NEGLIGIBLE * scaled.margins(*np.full((2, len(data.modes)), 2.0))
        d = np.where(least**2 < S, d, 0.0)  # copies of a data set say nothing of errors
        level = (self.weight + S) / (self.weight + d) if source == "sets" else np.ones(a.size)
        words = ", ".join(said).replace(" to", " known to", 1)
        logs = LogSum(a + self.weight, self.weight * level - S)
        return NoiseModel(replace(scaled, likelihood=logs), a, S, d, level, self.weight, words)

    def weighed(
        self, problem: UpdatingProblem, source: Source | None
    ) -> tuple[UpdatingProblem, Floats | None]:
        """Return a problem, and weights (n,) of its groups by expected errors whatever these weigh.

        None where nothing can be expected of some residuals.
        """
        noise = replace(self, weight=self.weight or 1.0).of(problem, source)
        return (problem, None) if noise is None else (noise.problem, 1 / noise.level)


@dataclass(frozen=True)
class NoiseModel:
    """Residuals over their expected standard deviations, and the prior of their variances."""

    problem: UpdatingProblem  # with these residuals, summed over the data sets
    a: Floats  # (n,) counts of independent errors
    S: Floats  # S, d: (n,) the part of J' that no model explains, and its degrees of freedom
    d: Floats
    level: Floats  # (n,) expected variance m
    weight: float  # degrees of freedom nu of the prior
    assumed: str  # in words, which errors neither the data nor the user say; empty for none

    @property
    def logs(self) -> LogSum:
        """-2 ln p of J', without the prior of the parameters."""
        return LogSum(self.a + self.weight, self.weight * self.level - self.S)

    @property
    def programme(self) -> LogSum:
        """What the most probable model minimises, with the distance from the nominal model."""
        logs, alone = self.logs, np.eye(self.a.size + 1)[-1]
        return LogSum(np.append(logs.a, 0.0), np.append(logs.floor, 1.0), linear=alone)

    @property
    def target(self) -> Problem:
        """The problem with the distance from the nominal model as a further objective."""
        names = (*self.problem.objectives, "distance from the nominal model")
        return Wrapped(self.problem, Distance(self.problem, PULL).evaluation, names)

    def precision(self, evaluation: Evaluation, weight: float = 12.0) -> Floats:
        """Return Gauss-Newton's matrix (p, p) of -ln p, with the variance of a uniform prior."""
        w = self.logs.gradient(evaluation.J)
        dr = Distance(self.problem, weight).residuals(evaluation.theta)[1]
        return np.tensordot(w, evaluation.gauss_newton, axes=1) / 2 + np.diag(dr**2)

    def over_expected(self, J: Floats) -> Floats:
        """Return the root mean square errors (n,) of J' (n,) over those expected."""
        return np.sqrt(np.maximum(J - self.S, 0.0) / (np.maximum(self.a, 1.0) * self.level))


@dataclass(frozen=True)
class Distance:
    """Distance of parameters from the nominal ones, in the units of their priors."""

    problem: UpdatingProblem
    weight: float  # of a distance of one range, for parameters of uniform prior

    def residuals(self, theta: Floats) -> tuple[Floats, Floats, Floats]:
        """Return the distances (p,) and their first and second derivatives."""
        centre, span = self.problem.start, self.problem.upper - self.problem.lower
        unit = np.sqrt(self.weight) / span
        r, dr, d2r = unit * (theta - centre), unit.copy(), np.zeros(unit.size)
        for j, prior in enumerate(self.problem.priors):
            if prior and prior.kind == "normal":
                r[j], dr[j] = (theta[j] - centre[j]) / prior.std, 1 / prior.std
            elif prior:
                r[j] = np.log(theta[j] / centre[j]) / prior.std
                dr[j], d2r[j] = 1 / (theta[j] * prior.std), -1 / (theta[j] ** 2 * prior.std)
        return r, dr, d2r

    def evaluation(
        self, problem: Problem, theta: Floats, derivatives: bool, second: bool
    ) -> Evaluation:
        """Return the evaluation of a problem with the square of the distance as last objective."""
        found = problem.evaluate(theta, derivatives=derivatives, second=second)
        r, dr, d2r = self.residuals(theta)
        J = np.append(found.J, r @ r if found.feasible else np.inf)
        if not found.derivatives:
            return replace(found, J=J)
        curved = dr**2 + r * d2r if found.exact else dr**2
        dJ = np.vstack([found.dJ, 2 * r * dr])
        H = np.concatenate([found.H, 2 * np.diag(curved)[None]])
        residuals = (*found.residuals, Residual(r, np.diag(dr)))
        return replace(found, J=J, dJ=dJ, H=H, residuals=residuals)


@dataclass(eq=False)
class Standardised:
    """Residuals, and last the square of z, as functions of standard normal z, by the priors."""

    problem: UpdatingProblem

    def __post_init__(self) -> None:
        problem = self.problem
        self.objectives = (*problem.objectives, "prior")
        self.start = np.zeros(problem.start.size)
        known = [(j, prior) for j, prior in enumerate(problem.priors) if prior]
        self.known = np.array([j for j, _ in known], dtype=int)
        self.std = np.array([prior.std for _, prior in known])
        self.log = np.array([prior.kind == "lognormal" for _, prior in known], dtype=bool)
        self.below, self.above = (self._units(x) for x in (problem.lower, problem.upper))
        self.share = ndtr(self.above) - ndtr(self.below)
        self.lower, self.upper = self.start - FARTHEST, self.start + FARTHEST
        self.lower[self.known] += np.minimum(self.below, 0.0)
        self.upper[self.known] += np.maximum(self.above, 0.0)

    def theta(self, z: Floats) -> tuple[Floats, Floats]:
        """Return the parameters (p,) of z (p,) and their derivatives."""
        lower, upper, known = self.problem.lower, self.problem.upper, self.known
        span, density = upper - lower, np.exp(-(z**2) / 2) / np.sqrt(2 * np.pi)
        theta = np.where(z < 0, lower + span * ndtr(z), upper - span * ndtr(-z))
        slope = span * density
        if known.size:
            ends = ((self.below, z[known]), (-self.above, -z[known]))
            tails = [np.logaddexp(log_ndtr(a), np.log(self.share) + log_ndtr(b)) for a, b in ends]
            x = np.where(tails[0] < tails[1], ndtri_exp(tails[0]), -ndtri_exp(tails[1]))
            nominal, away = self.problem.start[known], self.std * x
            grown = np.exp(np.where(self.log, away, 0.0))  # not of a deviation in any unit
            theta[known] = np.where(self.log, nominal * grown, nominal + away)
            scale = self.std * np.where(self.log, theta[known], 1.0)
            slope[known] = scale * self.share * np.exp((x**2 - z[known] ** 2) / 2)
        return np.clip(theta, lower, upper), slope

    def z(self, theta: Floats) -> Floats:
        """Return z (p,) of parameters (p,), infinite where these are at their bounds."""
        lower, upper, x = self.problem.lower, self.problem.upper, self._units(theta)
        left, right = ((y / (upper - lower)) for y in (theta - lower, upper - theta))
        left[self.known] = (ndtr(x) - ndtr(self.below)) / self.share
        right[self.known] = (ndtr(-x) - ndtr(-self.above)) / self.share
        return np.where(left < right, ndtri(left), -ndtri(right))

    def _units(self, theta: Floats) -> Floats:
        """Return distances from nominal values, or of their logarithms, over deviations."""
        theta, nominal = theta[self.known], self.problem.start[self.known]
        ratio = np.divide(theta, nominal, out=np.ones(theta.size), where=self.log)
        return np.where(self.log, np.log(np.maximum(ratio, TINY)), theta - nominal) / self.std

    def evaluate(
        self, theta: Floats, *, derivatives: bool = True, second: bool = False
    ) -> Evaluation:
        """Return the objectives at z (p,) within the bounds, with derivatives of residuals."""
        del second
        theta = np.clip(theta, self.lower, self.upper)
        parameters, slope = self.theta(theta)
        found = self.problem.evaluate(parameters, derivatives=derivatives)
        J = np.append(found.J, theta @ theta)
        if not (derivatives and found.feasible):
            return replace(found, theta=theta, J=J)
        own = Residual(theta, np.eye(theta.size))
        residuals = (*(Residual(x.r, x.dr * slope) for x in found.residuals), own)
        dJ = np.array([2 * x.r @ x.dr for x in residuals])
        H = np.array([2 * x.dr.T @ x.dr for x in residuals])
        return Evaluation(theta, J, dJ, H, False, found.quantities, residuals)


def prior_widths(problem: UpdatingProblem) -> Floats:
    """Return the widths (p,) of the 90 % intervals of the priors."""
    of, z = Standardised(problem), np.full(problem.start.size, NINETY)
    return of.theta(z)[0] - of.theta(-z)[0]


def expected(data: ModalData, sizes: Mapping[str, float], source: Source | None) -> ModalData:
    """Return data with expected deviations, those of ``sizes`` where they have none.

    They are such that means over the data sets become sums.
    """
    known = source == "std"
    there = np.asarray(np.isfinite(data.frequency))
    std = data.frequency_std if known else np.full(data.frequency.shape, np.nan)
    given = np.asarray(std > NEGLIGIBLE * np.where(there, data.frequency, 1.0))
    sets = np.maximum(there.sum(axis=0), 1)
    frequency = np.where(given, std, sizes["frequency"] * data.frequency) / np.sqrt(sets)

    measured = np.asarray(np.isfinite(data.shape).any(axis=2))
    ratios = [
        np.abs(x).max() / np.sqrt((x**2).mean())
        for k, r in np.argwhere(measured)
        if (x := data.shape[k, r][np.isfinite(data.shape[k, r])]).any()
    ]
    ratio = float(np.sqrt(np.mean(np.square(ratios)))) if ratios else 1.0
    shape = np.full(data.shape.shape, np.nan)
    for k, r in np.argwhere(measured):
        here = np.isfinite(data.shape[k, r])
        std = np.where(data.shape_std[k, r, here] > 0, data.shape_std[k, r, here], 0.0)
        if known and std.any():
            size = without_negligible(std)
        else:
            rms = np.sqrt((data.shape[k, r, here] ** 2).mean())
            size = np.full(here.sum(), sizes["shape"] * ratio * rms)
        shape[k, r, here] = size / np.sqrt(measured[:, r].sum())
    C = data.shape_covariance if known else None
    if C is not None:
        C = C / np.maximum(measured.sum(axis=0), 1)[:, None, None]
    return replace(data, frequency_std=frequency, shape_std=shape, shape_covariance=C)
