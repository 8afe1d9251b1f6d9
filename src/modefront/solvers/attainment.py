r"""Normal-boundary intersection of three and more objectives: the whole front, and only the front.

Where a point :math:`\Phi \beta` of the simplex is projected along the normal onto a part of the
boundary that is not optimal, some weight is negative; and with fewer parameters than objectives
there may be nothing on the normal at all. So the equations are relaxed to bounds (Pascoletti &
Serafini 1984, doi:10.1007/BF00934564), the greatest of which is minimised:

.. math:: \min_\theta\; \max_i c_i + \rho \sum_i c_i, \qquad c_i = (y_i - (\Phi \beta)_i) / r_i .

Where all bounds are active, :math:`c_i = \max c`, this is the point on the normal; else it is a
point of the border of the front, the front of those objectives whose bounds are active. The small
share :math:`\rho` of all objectives keeps every weight positive (Wierzbicki 1980,
doi:10.1007/978-3-642-48782-8_32): no solution is weakly optimal only.

Every point of the front is the solution for some :math:`\beta` with :math:`\sum \beta_i = 1`, its
own projection onto the plane of the simplex, but not all of these lie in the simplex. Therefore
the lattice goes on beyond it: to the neighbours of every point that is the nearest one to the
projection of its solution, and no farther, since there the front ends. Where the simplex is narrow
beside the front, points beyond it that lie closer together than a step of the ranges are left out
(`modefront.solvers.continuation.APART`).

The weights are :math:`w_i = (\kappa_i + \rho) / (r_i\, scale_i)`, with multipliers
:math:`\kappa_i \ge 0` of the bounds, of sum 1: which bounds are active is seen from them.

========  ========  ==========================================================
symbol    shape     meaning
========  ========  ==========================================================
y         (n,)      objectives, :math:`(J - J^*) / scale`
Phi       (n, n)    pay-off matrix, one column an edge, in units of the scale
beta      (n,)      coordinates of a point of the plane of the simplex, of sum 1
r         (n,)      :math:`-\hat n = \Phi e`, the normal towards greater objectives
c         (n,)      excess of the objectives over the point, along the normal
rho       ()        share of all objectives in what is minimised
========  ========  ==========================================================
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from modefront._typing import Bools, Floats
from modefront.solvers.payoff import Payoff
from modefront.solvers.problem import Problem
from modefront.solvers.scalarisation import Linear, achievement
from modefront.solvers.sqp import Options, Solution, Status, begin, solve

SHARE = 1e-6
"""rho: as small as a weight can be and not be taken for rounding, since a tolerance of 1e-7 of the
parameters leaves about as much of the multipliers."""

SAME = 1e-6
"""Distance over the range of the parameters below which two models are the same, in units of the
tolerance of the parameters ten; likewise of objectives over their ranges."""


_BEYOND = Options(iterations=30)
"""Half of the iterations that a programme beyond the simplex may take: nine of ten that converge
take less."""


def active_bounds(shares: Floats) -> Bools:
    """Return which bounds are active, from the weights times the normal (n,): the others have rho.

    >>> active_bounds(np.array([0.3, SHARE, 0.7])).tolist()
    [True, False, True]
    """
    active: Bools = shares > 2 * SHARE
    return active


@dataclass(frozen=True)
class Attainment:
    """The programmes of three and more objectives.

    ``thetas`` (n, p) are the corners of the simplex; below ``floor`` (n,), if there is one, no more
    is wanted.
    """

    target: Payoff
    thetas: Floats
    floor: Floats | None = None
    label: str = "nbi"

    @property
    def scale(self) -> Floats:
        """Range of each objective, shape (n,)."""
        return self.target.scale

    @cached_property
    def r(self) -> Floats:
        """The normal, towards greater objectives, shape (n,)."""
        return np.asarray(self.target.Phi.sum(axis=1))

    def goes_on(self, J: Floats) -> bool:
        """Return whether no objective is below its floor."""
        return self.floor is None or bool((self.floor <= J).all())

    def distance(self, beta: Floats, other: Floats) -> Floats:
        """Return the distances (...) of a point (n,) and others (..., n), over the ranges."""
        return self.target.distance(beta, other)

    def place(self, _: int, J: Floats) -> Floats:
        """Return the coordinates (n,) of the point of the plane that is projected onto J."""
        return self.target.place(J)

    def subproblem(self, beta: Floats) -> Linear:
        """Return the programme of the point at beta."""
        unit = self.scale * self.r
        point = (self.target.utopia / self.scale + self.target.Phi @ beta) / self.r
        return achievement(SHARE / unit, np.diag(1 / unit), point)

    def excess(self, beta: Floats, J: Floats) -> Floats:
        """Return c, shape (n,)."""
        return self.target.excess(beta, J)

    def is_better(self, beta: Floats, J: Floats, known: Floats) -> bool:
        """Return whether objectives (n,) solve the programme at beta better than known ones."""
        return self.target.is_better(beta, J, known)

    def solve(self, problem: Problem, beta: Floats, start: Solution) -> Solution:
        """Return the solution at beta, from a start.

        From an edge, where derivatives often vanish, it is sought from between the edges too.
        Where the start is weakly optimal, the front ends and nothing is evaluated.
        """
        if self.is_weak(beta, start.J):
            return replace(start, status=Status.STALLED, evaluations=0, beta=beta)
        solution = self._solve(problem, beta, start)
        span = problem.upper - problem.lower
        if (np.abs(self.thetas - start.theta) > SAME * span).any(axis=1).all():
            return solution
        share = np.maximum(beta, 0.0) / np.maximum(beta, 0.0).sum()
        theta = np.clip(share @ self.thetas, problem.lower, problem.upper)
        other = self._solve(problem, beta, begin(problem.evaluate(theta)))
        evaluations = solution.evaluations + other.evaluations + 1
        better = (
            self.is_better(beta, other.J, solution.J)
            if other.converged == solution.converged
            else other.converged
        )
        return replace(other if better else solution, evaluations=evaluations)

    solve_again = solve

    def _solve(self, problem: Problem, beta: Floats, start: Solution) -> Solution:
        """Return the solution from a start; stalled where it is weakly optimal.

        Of three objectives, the share of the others in what is minimised decides between these,
        where it is quick; most searches beyond the simplex that are slow are on their way nowhere.
        """
        programme = self.subproblem(beta)
        if beta.min() >= 0:
            return replace(solve(problem, programme, start), beta=beta)
        solution = replace(solve(problem, programme, start, _BEYOND), beta=beta)
        slow = solution.status is Status.EXHAUSTED
        if self.is_weak(beta, solution.J) and (slow or beta.size > 3):
            return replace(solution, status=Status.STALLED)
        if not slow:
            return solution
        again = solve(problem, programme, solution, _BEYOND)
        return replace(again, evaluations=solution.evaluations + again.evaluations, beta=beta)

    def is_weak(self, beta: Floats, J: Floats) -> bool:
        """Return whether, beyond the simplex, an objective that is least holds the bound.

        No model has a lower greatest excess, and all other objectives may be anything.
        """
        if beta.min() >= 0 or not np.isfinite(J).all():
            return False
        c, y = self.excess(beta, J), (J - self.target.utopia) / self.scale
        return bool(((c >= c.max() - SAME) & (y <= SAME)).any())
