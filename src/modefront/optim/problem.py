r"""Interface of problems to the solvers: objectives J(theta) with derivatives, within bounds.

========  =========  ==================================================================
symbol    shape      meaning
========  =========  ==================================================================
theta     (p,)       parameters
J         (n,)       objectives, to be made small
dJ        (n, p)     their derivatives, exact
H         (n, p, p)  their second derivatives, exact; or, unless these are requested, a
                     part that is known with the first ones, such as Gauss-Newton's
                     :math:`2 \partial r^T \partial r`
========  =========  ==================================================================
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import isfinite
from typing import Protocol

import numpy as np

from modefront._typing import Floats, Ints
from modefront.work.codec import record

AT_BOUND = 1e-9
"""Distance over the range of a parameter below which it is at its bound: a hundredth of the
tolerance of a step (`modefront.optim.sqp.Options`)."""

DISTINCT = 1e-3
"""Distance of two models, over the ranges of the parameters, above which they are two."""

STEP = 3e-4
"""Step of the differences, over the range of a parameter: balances their errors, 1e-7 by higher
derivatives and 3e-8 by an error of 1e-11 of the derivatives of a large eigenproblem."""


def at_bounds(theta: Floats, lower: Floats, upper: Floats) -> Ints:
    """Return -1 and 1 where parameters (..., p) are at their lower and upper bounds, else 0."""
    margin = AT_BOUND * (upper - lower)
    return np.where(theta <= lower + margin, -1, np.where(theta >= upper - margin, 1, 0))


def room(theta: Floats, step: Floats, lower: Floats, upper: Floats) -> float:
    """Return the number of steps (p,) from theta (p,) that stay within the bounds."""
    moved = step != 0
    to = np.where(step > 0, upper, lower)
    return float(((to - theta)[moved] / step[moved]).min(initial=np.inf))


@record
@dataclass(frozen=True)
class Residual:
    """A vector r (rows,) with its derivatives (rows, p)."""

    r: Floats
    dr: Floats


@record
@dataclass(frozen=True)
class Evaluation:
    r"""The objectives at one point, with derivatives where these are requested and defined.

    ``quantities`` are what the problem wants kept with it; ``residuals`` are the vectors r_i, one
    an objective, of objectives that are sums of squares, :math:`J_i = \|r_i\|^2`. They are empty
    where the objectives are no such sums, or no derivatives were asked for.
    """

    theta: Floats
    J: Floats
    dJ: Floats = field(default_factory=lambda: np.zeros((0, 0)))  # (n, p), or empty
    H: Floats = field(default_factory=lambda: np.zeros((0, 0, 0)))  # (n, p, p), or empty
    exact: bool = False  # whether H are the second derivatives, and not only a part of them
    quantities: Mapping[str, Floats] = field(default_factory=dict)
    residuals: Sequence[Residual] = ()

    @property
    def feasible(self) -> bool:
        """Whether the objectives are defined here."""
        return all(map(isfinite, self.J.tolist()))

    @property
    def derivatives(self) -> bool:
        """Whether it has derivatives."""
        return len(self.dJ) > 0

    @property
    def gauss_newton(self) -> Floats:
        """Second derivatives without those of the residuals, (n, p, p); `H` of no residuals."""
        if not self.residuals:
            return self.H
        return np.array([2 * each.dr.T @ each.dr for each in self.residuals])


def infeasible(theta: Floats, objectives: int) -> Evaluation:
    """Return the evaluation of a point at which the objectives are not defined."""
    return Evaluation(theta, np.full(objectives, np.inf))


class SpentError(Exception):
    """The evaluations that were allowed are spent."""


class Problem(Protocol):
    """A vector of objectives over a box."""

    @property
    def objectives(self) -> tuple[str, ...]:
        """Names of the objectives."""

    @property
    def lower(self) -> Floats:
        """Lower bounds, shape (p,), finite."""

    @property
    def upper(self) -> Floats:
        """Upper bounds, shape (p,), finite."""

    @property
    def start(self) -> Floats:
        """A first guess within the bounds, shape (p,)."""

    def evaluate(
        self, theta: Floats, *, derivatives: bool = True, second: bool = False
    ) -> Evaluation:
        """Return the objectives at ``theta``; infinite ones where they are not defined.

        ``second`` requests exact second derivatives too, where the problem has them.
        """


@dataclass(eq=False)
class Wrapped:
    """A problem that is evaluated in another way, and is the same in everything else."""

    problem: Problem  # the problem that is evaluated
    # returns the evaluation of a problem at theta (p,), with derivatives or without, and with
    # second ones or without
    evaluation: Callable[[Problem, Floats, bool, bool], Evaluation]
    names: tuple[str, ...] | None = None  # of the objectives, where the problem has others
    most: int | None = None  # evaluations at most, after which SpentError is raised; None for any
    count: int = 0  # evaluations so far

    def __post_init__(self) -> None:
        self.objectives = self.problem.objectives if self.names is None else self.names
        self.lower, self.upper = self.problem.lower, self.problem.upper
        self.start = self.problem.start

    def evaluate(
        self, theta: Floats, *, derivatives: bool = True, second: bool = False
    ) -> Evaluation:
        """Return the objectives at ``theta``."""
        return self._counted(self.problem, theta, derivatives, second)

    def continued(self, inside: Evaluation, beyond: Evaluation) -> Problem | None:
        """Return the problem without a jump, see `without_jump`; None with other objectives."""
        smooth = None if self.names else without_jump(self.problem, inside, beyond)
        return smooth and Wrapped(smooth, self._counted)

    def _counted(
        self, problem: Problem, theta: Floats, derivatives: bool, second: bool
    ) -> Evaluation:
        if self.count == self.most:
            raise SpentError
        self.count += 1
        return self.evaluation(problem, theta, derivatives, second)


def without_jump(problem: Problem, inside: Evaluation, beyond: Evaluation) -> Problem | None:
    """Return a problem whose objectives go on smoothly where they jump between two models.

    One objective more is negative where the others are those of the ``inside`` model's side, and
    positive beyond. None where the problem does not know why they jump: it has no ``continued``.
    """
    continued = getattr(problem, "continued", None)
    return continued and continued(inside, beyond)


def with_second_order(problem: Problem, evaluation: Evaluation) -> Evaluation | None:
    """Return an evaluation with all second derivatives; None where differences are not defined.

    It takes no evaluation where these are known, one where the problem has them, and 2 p more where
    it has not.
    """
    if not evaluation.exact:
        known = problem.evaluate(evaluation.theta, second=True)
        evaluation = replace(known, quantities=evaluation.quantities)
    if evaluation.exact or not evaluation.feasible:
        return evaluation if evaluation.feasible else None
    step = STEP * (problem.upper - problem.lower)
    middle = np.clip(evaluation.theta, problem.lower + step, problem.upper - step)
    columns = []
    for h in np.diag(step):
        ahead, behind = (problem.evaluate(middle + side * h) for side in (1, -1))
        if not (ahead.feasible and behind.feasible):
            return None
        columns.append((ahead.dJ - behind.dJ) / (2 * h.sum()))
    H = np.stack(columns, axis=2)
    return replace(evaluation, H=(H + H.transpose(0, 2, 1)) / 2, exact=True)
