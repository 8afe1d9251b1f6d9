r"""The Pareto front by normal-boundary intersection (Das & Dennis 1998).

With the edges :math:`\theta_i^*`, the utopia point :math:`J^*` and the pay-off matrix
:math:`\Phi = [J(\theta_1^*) - J^*, \ldots]`, every point :math:`\Phi \beta` of the simplex between
the edges is projected along the quasi-normal :math:`\hat n = -\Phi e` onto the boundary of what
can be attained (doi:10.1137/S1052623496307510). Even steps of :math:`\beta` give even points.

For two objectives these are the points of the front. For more, the simplex covers neither all of
the front nor nothing but the front: `modefront.solvers.attainment` says what is done then.

========  ==========================================================
symbol    meaning
========  ==========================================================
beta      (n,) barycentric coordinates of a point of the simplex
Phi       (n, n) pay-off matrix, one column an edge
scale     (n,) range of each objective over the edges
========  ==========================================================
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from modefront._typing import Floats
from modefront.solvers.attainment import Attainment
from modefront.solvers.continuation import Simplex, continuation
from modefront.solvers.dominance import nondominated
from modefront.solvers.payoff import Payoff
from modefront.solvers.problem import Problem
from modefront.solvers.scalarisation import Linear
from modefront.solvers.sqp import Solution, solve
from modefront.work.task import IMMEDIATE, Executor

HALVINGS = 2
"""Halvings of a step along the front, at most."""


@dataclass(frozen=True)
class Projection:
    """The programmes of two objectives."""

    target: Payoff
    label: str = "nbi"

    @property
    def scale(self) -> Floats:
        """Range of each objective over the edges, shape (n,)."""
        return self.target.scale

    def goes_on(self, _: Floats) -> bool:
        """Return False: of two objectives, the front ends at the edges."""
        return False

    def distance(self, beta: Floats, other: Floats) -> Floats:
        """Return the distances (...) of a point (n,) and others (..., n), over the ranges."""
        return self.target.distance(beta, other)

    def place(self, _: int, J: Floats) -> Floats:
        """Return the coordinates (n,) of the point that is projected onto J."""
        return self.target.place(J)

    def solve(self, problem: Problem, beta: Floats, start: Solution) -> Solution:
        """Return the farthest point along the normal, from a start.

        A step along the front that is too wide for the solver is halved.
        """
        return replace(self._solve(problem, beta, start, HALVINGS), beta=beta)

    def solve_again(self, problem: Problem, beta: Floats, start: Solution) -> Solution:
        """Return the farthest point along the normal, from another start, by a single step."""
        return replace(self._solve(problem, beta, start, 0), beta=beta)

    def _solve(self, problem: Problem, beta: Floats, start: Solution, halvings: int) -> Solution:
        solution = solve(problem, self.subproblem(beta), start)
        if solution.converged or not halvings or not start.feasible:
            return solution
        between = (beta + self.place(0, start.J)) / 2
        near = self._solve(problem, between, start, halvings - 1)
        evaluations = solution.evaluations + near.evaluations
        if near.converged:
            again = solve(problem, self.subproblem(beta), near)
            evaluations += again.evaluations
            solution = again if again.converged else solution
        return replace(solution, evaluations=evaluations)

    def subproblem(self, beta: Floats) -> Linear:
        """Return the programme of the point at beta."""
        return self.target.subproblem(beta)

    def is_better(self, beta: Floats, J: Floats, known: Floats) -> bool:
        """Return whether objectives (n,) lie farther along the normal at beta than known ones."""
        return self.target.is_better(beta, J, known)


def programmes(
    target: Payoff, edges: Sequence[Solution], floor: Floats | None = None
) -> Projection | Attainment:
    """Return the programmes of the points of a simplex between edges; see `nbi`."""
    if len(edges) == 2:
        return Projection(target)
    corners = target.worst or edges
    return Attainment(target, np.array([corner.theta for corner in corners]), floor)


# 9 arguments: the simplex, and what is known of the front from before.
def nbi(
    problem: Problem,
    edges: Sequence[Solution],
    target: Payoff,
    lattice: Simplex,
    work: Executor = IMMEDIATE,
    minima: Sequence[Solution] = (),
    floor: Floats | None = None,
    before: Sequence[Solution] = (),
    resumed: bool = False,
) -> list[Solution]:
    """Return one solution a point of the lattice, in its order, then those beyond the simplex.

    Other ``minima`` of single objectives are started from as well: each may lie on a part of the
    front of its own. Of two objectives these are minima between the edges only. Of three and more
    objectives, the lattice goes on beyond the simplex as long as no objective is below its
    ``floor`` (n,). ``before`` are points of a front of nearly the same problem, which is
    ``resumed`` where its edges are nearly the same as well. Solutions may be dominated, and those
    that did not converge say so in their status.
    """
    solved = programmes(target, edges, floor)
    known = [
        *edges,
        *(solution for solution in minima if all(solution is not edge for edge in edges)),
    ]
    optimal = nondominated(np.array([solution.J for solution in known]))
    others = [known[i] for i in np.flatnonzero(optimal) if i >= len(edges)]
    if len(edges) == 2:
        others = [solution for solution in others if target.place(solution.J).min() >= 0]
    return continuation(problem, solved, [*edges, *others], lattice, work, before, resumed)
