r"""The lexicographic minimum below a start: least in one objective, then least in the others.

The minimiser of :math:`J_i` need not be unique. Where parameters outnumber data, a manifold of
models fits some measurements exactly; mode shapes do not change when all stiffnesses are scaled.
Of these models, the one that is best in the others is the limit of the minimisers of

.. math:: J_i / c_i + \varepsilon \sum_{j \ne i} J_j / c_j, \qquad \varepsilon \to 0

(Ehrgott, *Multicriteria Optimization*, 2005, section 5.1). They form a smooth path, on which
each is found from the one before by a few steps of Newton's method, as the second derivatives are
exact however narrow the valley is: near the manifold, with residuals
:math:`r_i = \varepsilon \mu / 2`, these of :math:`J_i / \varepsilon` hold the curvature
:math:`\sum_k \mu_k \nabla^2 r_k` of the manifold itself. The limit is extrapolated
from the last two: their distance from it is proportional to :math:`\varepsilon`.

========  =======  =================================
symbol    shape    meaning
========  =======  =================================
c         (n,)     typical sizes of the objectives
========  =======  =================================
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from modefront._typing import Floats
from modefront.optim.problem import Evaluation, Problem
from modefront.optim.scalarisation import Linear, weighted
from modefront.optim.sqp import Options, Solution, solve

EXACT = 1e-10
"""An objective below this share of its typical size is fitted exactly: residuals of 1e-5 of their
typical size, far below the errors of any measurement and above what solutions leave of them."""

TIE = 1e-6
"""Minima of an objective that differ by less than this share of it, or of `EXACT`, are equal.
What solutions leave is less: steps of 1e-7 to 1e-8 change a smooth objective by the square."""

RANK = 1e-7
"""Singular value of the residuals' derivatives, over the greatest, that counts as none: the
tolerance of the parameters."""

FIRST, LAST, RATIO = 1e-1, 1e-10, 10
"""Values of epsilon at which the path begins, and beyond which it is not followed; ratio of one to
the next."""

ARRIVED = 1e-6
"""Distance of two limits, over the ranges of the parameters, below which they are the same: ten
times the tolerance of a step."""


@dataclass(frozen=True)
class Lexicographic:
    """The search for the least in one objective, then the least in the others.

    ``sizes`` (n,) are typical sizes of the objectives.
    """

    objective: int
    sizes: Floats

    @property
    def others(self) -> Floats:
        """Weights (n,) of the other objectives; zero for the first one."""
        w = 1 / self.sizes
        w[self.objective] = 0.0
        return w

    def margin(self, least: float) -> float:
        """Return the difference from the least value within which values are equal."""
        return max(TIE * least, EXACT * float(self.sizes[self.objective]))

    def ties(self, J: Floats, other: Floats) -> bool:
        """Return whether the first objective is as good in both."""
        i = self.objective
        return bool(abs(J[i] - other[i]) <= self.margin(float(min(J[i], other[i]))))

    def is_open(self, problem: Problem, evaluation: Evaluation) -> bool:
        """Return whether some change of parameters may leave the first objective at its minimum."""
        if not evaluation.residuals:
            return True
        dr = evaluation.residuals[self.objective].dr * (problem.upper - problem.lower)
        sigma = np.linalg.svd(dr, compute_uv=False)
        rank = int((sigma > RANK * sigma.max(initial=np.finfo(float).tiny)).sum())
        return rank < evaluation.theta.size

    def solve(self, problem: Problem, start: Solution, options: Options) -> Solution:
        """Return the lexicographic minimum below a start."""
        best = self.first(problem, start, options)
        if not best.feasible or self.sizes.size == 1 or not self.is_open(problem, best.evaluation):
            return best
        spent = best.evaluations
        for first, begins in ((FIRST, start), (FIRST / 1000, best)):
            end = self._end(problem, first, begins, best, options)
            spent += end.evaluations
            if end.feasible and self._reaches(end.J, best.J):
                return replace(end, evaluations=spent)
        return replace(best, evaluations=spent)  # the path leads to another basin

    # 6 arguments: a path from a start, and the minimum that it is to reach.
    def _end(
        self, problem: Problem, epsilon: float, start: Solution, best: Solution, options: Options
    ) -> Solution:
        """Return the limit to which a path of minimisers leads, from the first epsilon on."""
        coarse = _solved(problem, self._with(epsilon), replace(start, evaluations=0), options)
        last, span = coarse.theta, problem.upper - problem.lower
        while True:
            epsilon /= RATIO
            fine = _solved(problem, self._with(epsilon), coarse, options)
            theta = fine.theta + (fine.theta - coarse.theta) / (RATIO - 1)
            limit = problem.evaluate(np.clip(theta, problem.lower, problem.upper), second=True)
            fine = replace(fine, evaluations=fine.evaluations + 1)
            moved = float(np.abs((limit.theta - last) / span).max())
            arrived = limit.feasible and moved <= ARRIVED and self._reaches(limit.J, best.J)
            if arrived or epsilon <= LAST:
                closer = limit.feasible and limit.J[self.objective] <= fine.J[self.objective]
                return replace(fine, evaluation=limit if closer else fine.evaluation)
            coarse, last = fine, limit.theta

    def _reaches(self, J: Floats, best: Floats) -> bool:
        """Return whether the first objective is no greater than the best one."""
        return bool(J[self.objective] <= best[self.objective] or self.ties(J, best))

    def first(self, problem: Problem, start: Solution, options: Options) -> Solution:
        """Return the minimum of the first objective alone below a start."""
        return _solved(problem, self._with(0.0), start, options)

    def _with(self, epsilon: float) -> Linear:
        return weighted(
            np.eye(self.sizes.size)[self.objective] / self.sizes + epsilon * self.others
        )


def _solved(problem: Problem, programme: Linear, start: Solution, options: Options) -> Solution:
    """Return the minimum below a start, with the evaluations of both."""
    solution = solve(problem, programme, start, options)
    return replace(solution, evaluations=start.evaluations + solution.evaluations)
