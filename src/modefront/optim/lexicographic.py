"""The lexicographic minimum below a start: least in one objective, then least in the others.

It is the limit of a path of minimisers (`docs/methods/nbi.md`), extrapolated from the last two:
their distance from it is proportional to epsilon.
"""

from dataclasses import dataclass, replace

import numpy as np

from modefront._typing import Floats
from modefront.optim.problem import DISTINCT, Evaluation, Problem
from modefront.optim.scalarisation import Linear, weighted
from modefront.optim.sqp import Options, Solution, Status, solve

EXACT = 1e-10
"""An objective below this share of its typical size is fitted exactly: residuals of 1e-5 of their
typical size, far below the errors of any measurement and above what solutions leave of them."""

TIE = 1e-6
"""Minima of an objective that differ by less than this share are equal, and so are exact fits. What
solutions leave is less: steps of 1e-7 to 1e-8 change a smooth objective by the square."""

RANK = Options().step
"""Singular value of the residuals' derivatives, over the greatest, that counts as none: the
tolerance of the parameters."""

RATIO = 10  # ratio of epsilon, which begins at 1 / RATIO and ends at `EXACT`, to the next one

SHARE = 0.01 * TIE
"""Change of the others, over themselves, below which a minimiser on the path is exact enough."""

TIGHTEST = Options(step=1e-8, reduction=1e-24, negligible=1e-16)
"""Over the typical size of an objective: residuals of the tolerance of steps end a search."""


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

    def level(self, value: float) -> float:
        """Return a value of the first objective, or if it is fitted exactly what counts as that."""
        return max(value, EXACT * float(self.sizes[self.objective]))

    def ties(self, J: Floats, other: Floats) -> bool:
        """Return whether the first objective is as good in both."""
        one, two = self.level(J[self.objective]), self.level(other[self.objective])
        return abs(one - two) <= TIE * min(one, two)

    def is_open(self, problem: Problem, evaluation: Evaluation) -> bool:
        """Return whether some change of parameters may leave the first objective at its minimum."""
        if not evaluation.residuals:
            return True
        dr = evaluation.residuals[self.objective].dr * (problem.upper - problem.lower)
        sigma = np.linalg.svd(dr, compute_uv=False)
        rank = int((sigma > RANK * sigma.max()).sum())
        return rank < evaluation.theta.size

    def solve(self, problem: Problem, start: Solution, known: Solution | None = None) -> Solution:
        """Return the lexicographic minimum below a start.

        A minimum of the first objective that exceeds that of a ``known`` model is left where it is,
        and so is a model on the way to one, at the limit of iterations. Where a path meets the one
        that led to the known model, it is not followed further.
        """
        i = self.objective
        best = solve(problem, self.programme(0.0), start, TIGHTEST, known)
        if known and best.evaluation is known.evaluation:
            return best
        least = np.inf if known is None else self.level(known.J[i])
        if not best.feasible or best.status is Status.EXHAUSTED or self.sizes.size == 1:
            return best
        if self.level(best.J[i]) > (1 + TIE) * least or not self.is_open(problem, best.evaluation):
            return best
        spent, rival = best.evaluations, known if known and self.ties(known.J, best.J) else None
        for epsilon, begins in ((1 / RATIO, start), (1 / RATIO**4, best)):
            end = self._end(problem, epsilon, begins, rival)
            spent += end.evaluations
            isolated, tied = self._equal(end.J, best.J), self.ties(end.J, best.J)
            worse = self.others @ end.J > self.others @ best.J if tied else end.J[i] > best.J[i]
            if end.feasible and (isolated or not worse):
                return replace(best if isolated else end, evaluations=spent, path=end.path)
        return replace(best, evaluations=spent)  # the paths lead to other basins

    def _end(
        self, problem: Problem, epsilon: float, start: Solution, rival: Solution | None
    ) -> Solution:
        """Return the limit of the path of minimisers from an epsilon on.

        Each but the first ones is solved for from the limit that those before it tell, as exactly
        as the share of the others asks for. The others grow along a path: where they exceed those
        of a ``rival``, it ends at its start.
        """
        spent, ahead, path, limits = 0, start, list[Floats](), list[Evaluation]()
        coarse: Solution | None = None
        passed = np.zeros((0, 3)) if rival is None or rival.path is None else rival.path
        while True:
            enough = replace(TIGHTEST, step=Options().step, reduction=SHARE * epsilon)
            fine = solve(problem, self.programme(epsilon), ahead, enough)
            spent += fine.evaluations
            # what is minimised is exact to its own tolerance, the others in it to the root of that
            rest = self.others @ fine.J
            path.append(np.array([epsilon, self.programme(epsilon).value(fine.J), rest]))
            apart = np.abs(passed - path[-1]) / np.maximum(path[-1], np.finfo(float).tiny)
            if rival and (apart <= [TIE, TIE, DISTINCT]).all(axis=1).any():
                return replace(rival, evaluations=spent)
            if rival and rest > (1 + TIE) * (self.others @ rival.J):
                return replace(start, evaluations=spent)
            if coarse is None:
                ahead = fine
            else:
                theta = fine.theta + (fine.theta - coarse.theta) / (RATIO - 1)
                limit = problem.evaluate(np.clip(theta, problem.lower, problem.upper), second=True)
                spent += 1
                limits.append(limit)
                if not limit.feasible or epsilon <= EXACT or self._equal(limit.J, ahead.J):
                    # of the last ones rounding may leave less than of those before them
                    ends = (x for x in (*limits, fine.evaluation) if x.feasible)
                    best = min(ends, key=lambda x: float(x.J[self.objective]))
                    return replace(fine, evaluation=best, evaluations=spent, path=np.array(path))
                ahead = replace(fine, evaluation=limit)
            coarse, epsilon = fine, epsilon / RATIO

    def _equal(self, J: Floats, other: Floats) -> bool:
        """Return whether the first objective is as good in both, and so are the others."""
        one, two = float(self.others @ J), float(self.others @ other)
        return self.ties(J, other) and abs(one - two) <= TIE * max(one, two)

    def programme(self, epsilon: float) -> Linear:
        """Return the objective with a share of the others, over their sizes."""
        own = np.eye(self.sizes.size)[self.objective]
        return weighted(own / self.sizes + epsilon * self.others)
