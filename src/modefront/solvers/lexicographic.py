r"""The lexicographic minimum below a start: least in one objective, then least in the others.

The minimiser of :math:`J_i = \|r_i\|^2` need not be unique. Where parameters outnumber data, a
manifold of models fits some measurements exactly; mode shapes do not change when all stiffnesses
are scaled. On the manifold :math:`r_i` is constant, so the search has two steps:

1. minimise :math:`J_i` to the end, which gives :math:`r_i^*`;
2. minimise :math:`\sum_{j \ne i} J_j / c_j` subject to :math:`r_i(\theta) = r_i^*`.

The constraints are the residuals themselves, not their sum of squares: the gradient of
:math:`J_i` vanishes on the manifold, those of the residuals do not, and
:mod:`modefront.solvers.sqp` moves along their null space and back to the manifold in the same step.
A weight of 1e-5 on the other objectives in place of the constraints needs hundreds of iterations,
as every step is as short as the manifold is curved.

Residuals may be redundant (more rows than rank). With :math:`\partial r_i = U \Sigma V^T` at the
start, the rows are combined to :math:`Q^T r_i`, Q being the columns of U that belong to singular
values above `RANK`. Along a manifold Q turns, unless it combines all rows; both steps are repeated
until nothing is gained.

Where the objectives are no sums of squares, step 2 is the limit of the minimisers of

.. math:: J_i / c_i + \varepsilon \sum_{j \ne i} J_j / c_j, \qquad \varepsilon \to 0

(Ehrgott, *Multicriteria Optimization*, 2005, section 5.1), extrapolated from two of them: their
distance from the limit is proportional to :math:`\varepsilon`.

========  =========  ===================================================
symbol    shape      meaning
========  =========  ===================================================
c         (n,)       typical sizes of the objectives
Q         (rows, k)  combinations of the residuals that parameters change
========  =========  ===================================================
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from modefront._typing import Bools, Floats
from modefront.solvers.problem import (
    Evaluation,
    ObjectiveDerivatives,
    Problem,
    Residual,
    Wrapped,
    infeasible,
)
from modefront.solvers.scalarisation import Linear, constrained, weighted
from modefront.solvers.sqp import Options, Solution, Status, begin, solve

EXACT = 1e-10
"""An objective below this share of its typical size is fitted exactly: residuals of 1e-5 of their
typical size, far below the errors of any measurement and above what solutions leave of them."""

TIE = 1e-6
"""Minima of an objective that differ by less than this share of it, or of `EXACT`, are equal.
What solutions leave is less: steps of 1e-7 to 1e-8 change a smooth objective by the square."""

CLEAR = 1e-3
"""Gain in the other objectives, over them, that is more than a tie in the first one allows."""

RANK = 1e-7
"""Singular value of the residuals' derivatives, over the greatest, that counts as none: the
tolerance of the parameters."""

REPEATS = 4
"""Repetitions of both steps at most; they end earlier where nothing is gained."""

EXPLORE, COARSE, FINE = 1e-5, 1e-6, 1e-7
"""Values of epsilon: for the value of a model, and the two from which a limit is extrapolated."""

_TIGHT = Options(step=1e-8, reduction=1e-24)

KNOWN = 30
"""Iterations with the known second derivatives alone: what is learned is not exact enough where an
objective does not change at all."""


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

    def value(self, J: Floats) -> float:
        """Return a number that nearly orders models as the search does."""
        return float(J[self.objective] / self.sizes[self.objective] + EXPLORE * (self.others @ J))

    def margin(self, least: float) -> float:
        """Return the difference from the least value within which values are equal."""
        return max(TIE * least, EXACT * float(self.sizes[self.objective]))

    def better(self, J: Floats, other: Floats) -> bool:
        """Return whether objectives come before others in the order of the search."""
        i = self.objective
        margin = self.margin(float(min(J[i], other[i])))
        if abs(J[i] - other[i]) > margin:
            return bool(J[i] < other[i])
        rest, before = float(self.others @ J), float(self.others @ other)
        return before - rest > max(TIE * before, EXACT)

    def equal(self, J: Floats, other: Floats) -> bool:
        """Return whether neither objectives nor others come first."""
        return not (self.better(J, other) or self.better(other, J))

    def is_open(self, problem: Problem, evaluation: Evaluation) -> bool:
        """Return whether some change of parameters leaves all residuals of the first objective."""
        return (
            bool(evaluation.residuals)
            and self._changing(problem, evaluation).shape[1] < evaluation.theta.size
        )

    def _holds_all(self, problem: Problem, evaluation: Evaluation) -> bool:
        """Return whether Q combines all residuals of the first objective, so that it turns not."""
        rows, k = self._changing(problem, evaluation).shape
        return rows == k

    def _changing(self, problem: Problem, evaluation: Evaluation) -> Floats:
        """Return Q."""
        dr = evaluation.residuals[self.objective].dr * (problem.upper - problem.lower)
        U, sigma, _ = np.linalg.svd(dr, full_matrices=False)
        return np.asarray(U[:, sigma > RANK * sigma.max(initial=np.finfo(float).tiny)])

    def clearly_better(self, J: Floats, other: Floats) -> bool:
        """Return whether objectives come before others by more than a tie among exact fits does.

        Next to an exact fit, the others fall with the root of the first objective.
        """
        i = self.objective
        margin = self.margin(float(min(J[i], other[i])))
        if abs(J[i] - other[i]) > margin:
            return bool(J[i] < other[i])
        rest, before = float(self.others @ J), float(self.others @ other)
        return before - rest > max(CLEAR * before, EXACT)

    def solve(self, problem: Problem, start: Solution, options: Options) -> Solution:
        """Return the lexicographic minimum below a start.

        The tolerance of ``options`` for steps is kept; the rest is the search's own. A step of the
        search that does not converge keeps what it reached and says so in the status.
        """
        rough = options.step > _TIGHT.step
        tight = replace(_TIGHT, step=options.step, reduction=1e-14) if rough else _TIGHT
        if not start.evaluation.residuals:
            solution = solve(problem, self._with(EXPLORE), start, tight)
            return solution if rough or not solution.feasible else self._limit(problem, solution)
        best = _least(problem, self._alone(), start, tight)
        if not best.feasible or self.sizes.size == 1:
            return best
        for _ in range(1 if rough else REPEATS):
            solution = self._along(problem, best, tight)
            if solution is best:
                break
            least = _least(problem, self._alone(), solution, tight)
            kept = solution if self._accepts(solution.J, least.J) else least
            if not self._accepts(kept.J, best.J):
                return replace(best, evaluations=least.evaluations)
            again = not (solution.converged and self._holds_all(problem, solution.evaluation))
            gained = again and self.better(kept.J, best.J)
            best = replace(kept, status=solution.status, evaluations=least.evaluations)
            if not gained:
                break
        return best

    def _alone(self) -> Linear:
        return weighted(np.eye(self.sizes.size)[self.objective] / self.sizes)

    def _accepts(self, J: Floats, before: Floats) -> bool:
        """Return whether the first objective is as good as before."""
        i = self.objective
        return bool(J[i] <= before[i] + self.margin(float(before[i])))

    def _along(self, problem: Problem, start: Solution, options: Options) -> Solution:
        """Return the best in the others on the manifold of minima; the start where it is none."""
        i, n = self.objective, self.sizes.size
        if not self.is_open(problem, start.evaluation):
            return start
        exact = start.J[i] <= EXACT * self.sizes[i]
        tight = replace(options, constraint=max(1e-9, 1e-2 * options.step), reduction=1e-16)
        aim = start.evaluation.residuals[i].r * (0.0 if exact else 1.0)
        held = np.zeros(n, dtype=np.bool_)
        return self.lowered(problem, start, self.others, held, aim, tight)[0]

    def lowered(
        self,
        problem: Problem,
        start: Solution,
        w: Floats,
        held: Bools,
        aim: Floats,
        options: Options,
    ) -> tuple[Solution, Floats]:
        """Return the least w^T J (n,) where the first objective has the residuals ``aim`` (rows,).

        Those of the other objectives that are ``held`` (n,) keep their values. The multipliers of
        the residuals (rows,) follow: what is least falls as ``aim`` moves along them. The arguments
        are those of a programme and of its solution.
        """
        i, n = self.objective, self.sizes.size
        Q = self._changing(problem, start.evaluation)
        reduced, others = Held(i, Q), np.arange(n) != i
        k, root = Q.shape[1], float(np.sqrt(self.sizes[i]))
        first = begin(reduced.of(start.evaluation))
        learned = first.learned.copy()
        learned[k:] = start.learned[others]
        rows = np.eye(k + n - 1)[np.concatenate([np.ones(k, dtype=np.bool_), held[others]])]
        unit = np.concatenate([np.full(k, root), self.sizes[others]])
        values = np.concatenate([Q.T @ aim, start.J[others]])
        programme = constrained(
            np.concatenate([np.zeros(k), w[others]]), rows / unit, rows @ (values / unit)
        )
        solution = solve(
            reduced.problem(problem), programme, replace(first, learned=learned), options
        )
        known = start.learned.copy()
        known[others] = solution.learned[k:]
        end = replace(
            start,
            evaluation=problem.evaluate(solution.theta),
            learned=known,
            status=solution.status,
            violation=solution.violation,
            evaluations=start.evaluations + solution.evaluations + 1,
        )
        return end, Q @ solution.weights[:k]

    def _limit(self, problem: Problem, start: Solution) -> Solution:
        """Return the limit of the minimisers for epsilon to 0, by Richardson's extrapolation."""
        coarse = _least(problem, self._with(COARSE), start, _TIGHT)
        fine = _least(problem, self._with(FINE), coarse, _TIGHT)
        theta = fine.theta + (fine.theta - coarse.theta) * FINE / (COARSE - FINE)
        limit = problem.evaluate(np.clip(theta, problem.lower, problem.upper))
        i = self.objective
        better = limit.feasible and limit.J[i] <= fine.J[i]
        return replace(
            fine, evaluation=limit if better else fine.evaluation, evaluations=fine.evaluations + 1
        )

    def _with(self, epsilon: float) -> Linear:
        return weighted(
            np.eye(self.sizes.size)[self.objective] / self.sizes + epsilon * self.others
        )


@dataclass(frozen=True)
class Held:
    """Combined residuals Q^T r_i in the place of one objective, followed by the other J."""

    objective: int
    Q: Floats

    def problem(self, problem: Problem) -> Wrapped:
        """Return a problem with these objectives; its evaluations always have derivatives."""
        names, i = problem.objectives, self.objective
        rows = [f"{names[i]} {k + 1}" for k in range(self.Q.shape[1])]
        others = (name for j, name in enumerate(names) if j != i)
        return Wrapped(problem, lambda of, theta, _: self.of(of.evaluate(theta)), (*rows, *others))

    def of(self, evaluation: Evaluation) -> Evaluation:
        """Return the residuals and the other objectives from an evaluation of the problem."""
        i, k, p = self.objective, self.Q.shape[1], evaluation.theta.size
        if not evaluation.feasible:
            return infeasible(evaluation.theta, k + evaluation.J.size - 1)
        residual, nothing = evaluation.residuals[i], Residual(np.zeros(0), np.zeros((0, p)))
        others = np.arange(evaluation.J.size) != i
        return Evaluation(
            evaluation.theta,
            np.concatenate([self.Q.T @ residual.r, evaluation.J[others]]),
            ObjectiveDerivatives(
                np.concatenate([self.Q.T @ residual.dr, evaluation.dJ[others]]),
                np.concatenate([np.zeros((k, p, p)), evaluation.H[others]]),
            ),
            residuals=[*[nothing] * k, *(x for j, x in enumerate(evaluation.residuals) if j != i)],
            branch=evaluation.branch,
        )


def _least(problem: Problem, programme: Linear, start: Solution, options: Options) -> Solution:
    """Return the minimum with the known second derivatives if these suffice, else with learned."""
    spent = start.evaluations
    best = start
    if start.evaluation.H.any():
        best = solve(problem, programme, start, replace(options, learn=False, iterations=KNOWN))
        spent += best.evaluations
    if best is start or (not best.converged and best.status is not Status.INFEASIBLE):
        solution = solve(problem, programme, best, options)
        spent += solution.evaluations
        best = solution
    learned = best.learned if best.learned.any() else start.learned
    return replace(best, learned=learned, evaluations=spent)
