r"""Normal-boundary intersection of three and more objectives: the whole front, and only the front.

Where a point :math:`\Phi \beta` of the simplex is projected along the normal onto a part of the
boundary that is not optimal, some weight is negative; and with fewer parameters than objectives
there may be nothing on the normal at all. So the equations are relaxed to bounds (Pascoletti &
Serafini 1984, doi:10.1007/BF00934564): with :math:`y = (J - J^*) / scale` and
:math:`r = -\hat n = \Phi e`,

.. math:: \min_\theta\; \max_i c_i + \rho \sum_i c_i, \qquad c_i = (y_i - (\Phi \beta)_i) / r_i .

Where all bounds are active this is the point on the normal; else it is a point of the border of
the front, the front of those objectives whose bounds are active. The small share :math:`\rho` of
all objectives keeps every weight positive (Wierzbicki 1980): no solution is weakly optimal only.

Every point of the front is the solution for some :math:`\beta` with :math:`\sum \beta_i = 1`, its
own projection onto the plane of the simplex, but not all of these lie in the simplex. Therefore
the lattice goes on beyond it: to the neighbours of every point that is the nearest one to the
projection of its solution, and no farther, since there the front ends.

The active set is that of the quadratic programme

.. math:: \min_{s, \tau}\; \tau + \rho \sum_i \nabla c_i^T s + \tfrac12 s^T B s
    \quad\text{subject to}\quad c_i + \nabla c_i^T s \le \tau,\; lo \le s \le hi

at the start. `modefront.solvers.sqp` then solves the programme with these bounds as equations.
Where that leaves a negative weight or a violated bound, steps of the quadratic programme within a
trust region go down until the active set stays the same, and the equations are tried again.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy.optimize

from modefront._typing import Bools, Floats
from modefront.solvers.payoff import Payoff
from modefront.solvers.problem import Problem
from modefront.solvers.scalarisation import Linear, boundary
from modefront.solvers.sqp import Options, Solution, State, Status, begin, solve

SHARE = 1e-6
"""rho."""

SETS = 6
"""Active sets that are tried at most."""

STEPS = 30
"""Steps to find one at most."""

ENOUGH = 1e-2
"""Share of the promised gain from which a step is taken."""

EDGE = 1e-6
"""Distance over the range of the parameters below which two models are the same."""

MET = 1e-6
"""Violation of a bound, and negative weight, that count as none."""

FLAT = 1e-6
"""Curvature, over the greatest one, below which a direction counts as flat."""

LINEAR = 1e-6
"""Curvature that tau gets, so that the quadratic programme is strictly convex."""

REACH = 0.3
"""Greatest step of a parameter, over its range, in the quadratic programme."""


_GUESS = Options(iterations=12)
"""A wrong active set may have no solution: it is not tried for long."""


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

    def place(self, _: int, J: Floats) -> Floats:
        """Return the coordinates (n,) of the point of the plane that is projected onto J."""
        return self.target.place(J)

    def excess(self, beta: Floats, J: Floats) -> Floats:
        """Return c, shape (n,)."""
        y = (J - self.target.utopia) / self.scale
        out: Floats = (y - self.target.Phi @ beta) / self.r
        return out

    def value(self, beta: Floats, J: Floats) -> float:
        """Return max c + rho sum c."""
        c = self.excess(beta, J)
        return float(c.max() + SHARE * c.sum())

    def subproblem(self, beta: Floats, active: Bools) -> Linear:
        """Return the programme in which the active bounds are equations."""
        target = self.target
        point = target.Phi @ beta
        return boundary(point, -self.r, target.utopia, self.scale, active, SHARE)

    def solve(self, problem: Problem, beta: Floats, start: Solution) -> Solution:
        """Return the solution at beta, from a start.

        From an edge, where derivatives often vanish, it is sought from between the edges too.
        Where the start is weakly optimal, the front ends and nothing is evaluated.
        """
        if self.is_weak(beta, start.at.J):
            return replace(start, status=Status.STALLED, evaluations=0, beta=beta)
        found = replace(self._checked(self._solve(problem, beta, start), beta), beta=beta)
        span = problem.upper - problem.lower
        if (np.abs(self.thetas - start.at.theta) > EDGE * span).any(axis=1).all():
            return found
        share = np.maximum(beta, 0.0) / np.maximum(beta, 0.0).sum()
        theta = np.clip(share @ self.thetas, problem.lower, problem.upper)
        other = self._checked(self._solve(problem, beta, begin(problem.evaluate(theta))), beta)
        evaluations = found.evaluations + other.evaluations + 1
        key = (not found.converged, self.value(beta, found.at.J))
        better = (not other.converged, self.value(beta, other.at.J)) < key
        return replace(other if better else found, beta=beta, evaluations=evaluations)

    solve_again = solve

    def _checked(self, found: Solution, beta: Floats) -> Solution:
        """Return a solution; stalled where it is weakly optimal.

        Of three objectives, the share of the others in what is minimised decides between these.
        """
        weak = beta.size > 3 and self.is_weak(beta, found.at.J)
        return replace(found, status=Status.STALLED) if weak else found

    def is_weak(self, beta: Floats, J: Floats) -> bool:
        """Return whether, beyond the simplex, an objective that is least holds the bound.

        No model has a lower greatest excess, and all other objectives may be anything.
        """
        if beta.min() >= 0 or not np.isfinite(J).all():
            return False
        c, y = self.excess(beta, J), (J - self.target.utopia) / self.scale
        return bool(((c >= c.max() - MET) & (y <= MET)).any())

    def _solve(self, problem: Problem, beta: Floats, start: Solution) -> Solution:
        if not start.at.feasible:
            return start
        active = self._step(problem, beta, start, REACH).active
        first = self._equations(problem, beta, start, active)
        evaluations = first.evaluations
        if first.converged and self.value(beta, first.at.J) <= self.value(beta, start.at.J):
            return first
        best = start
        if self.is_weak(beta, first.at.J):
            return replace(first, status=Status.STALLED)
        for _ in range(SETS):
            near, active = self._descend(problem, beta, best)
            if self.is_weak(beta, near.at.J):
                best, evaluations = near, evaluations + near.evaluations
                break
            found = self._equations(problem, beta, near, active)
            evaluations += near.evaluations + found.evaluations
            if found.converged:
                return replace(found, evaluations=evaluations)
            if near.at is best.at:
                break
            best = near
        return replace(best, status=Status.STALLED, evaluations=evaluations)

    def _equations(
        self, problem: Problem, beta: Floats, start: Solution, active: Bools
    ) -> Solution:
        """Return the solution with the active bounds as equations; stalled if it is none."""
        found = solve(problem, self.subproblem(beta, active), start, _GUESS)
        c = self.excess(beta, found.at.J)
        weights = found.weights * self.scale * self.r
        good = (weights >= -MET).all() and (c <= c[active].max() + MET).all()
        return found if good else replace(found, status=Status.STALLED)

    def _descend(self, problem: Problem, beta: Floats, start: Solution) -> tuple[Solution, Bools]:
        """Go down by steps within a trust region until the active set stays; return both."""
        span = problem.upper - problem.lower
        state, radius, before = State(start.at, start.learned), REACH, None
        weights, evaluations = start.weights, 0
        while evaluations < STEPS and radius > EDGE:
            at = replace(start, at=state.at, learned=state.learned, weights=weights)
            step = self._step(problem, beta, at, radius)
            value = self.value(beta, state.at.J)
            small = np.abs(step.s).max() < radius / 2
            if before is not None and small and (step.active == before).all():
                break
            before = step.active
            theta = np.clip(state.at.theta + step.s * span, problem.lower, problem.upper)
            new = problem.evaluate(theta)
            evaluations += 1
            gain = value - self.value(beta, new.J) if new.feasible else -np.inf
            better = gain > ENOUGH * step.gain
            if new.feasible:
                state = state.learn(new)
            if better:
                state = replace(state, at=new)
                weights = step.weights
            radius = (
                min(2 * radius, REACH) if gain > step.gain / 2 else radius / (1 if better else 4)
            )
        at = replace(start, at=state.at, learned=state.learned, weights=weights)
        active = self._step(problem, beta, at, radius).active
        return replace(at, evaluations=evaluations), active

    def _step(self, problem: Problem, beta: Floats, at: Solution, radius: float) -> _Step:
        """Return the solution of the quadratic programme."""
        span = problem.upper - problem.lower
        theta = at.at.theta
        lo = np.maximum((problem.lower - theta) / span, -radius)
        hi = np.minimum((problem.upper - theta) / span, radius)
        unit = self.scale * self.r
        c, dc = self.excess(beta, at.at.J), at.at.dJ * span / unit[:, None]
        known = np.maximum(np.nan_to_num(at.weights), 0.0)
        w = known if known.any() else 1 / unit
        B = np.tensordot(w / (w @ unit), at.at.H + at.learned, axes=1) * np.outer(span, span)
        curvature, V = np.linalg.eigh(B)
        curvature = np.maximum(np.abs(curvature), FLAT * max(1.0, np.abs(curvature).max()))
        T = V / np.sqrt(curvature)
        g = SHARE * dc.sum(axis=0)
        # q = (T^-1 s + T^T g, sqrt(LINEAR) tau + 1 / sqrt(LINEAR)) has the least length.
        offset, root = T @ (T.T @ g), np.sqrt(LINEAR)
        rows = np.vstack([-dc @ T, T, -T])
        last = np.concatenate([np.ones(c.size), np.zeros(2 * theta.size)]) / root
        h = np.concatenate([c - dc @ offset + 1 / LINEAR, lo + offset, -hi - offset])
        q, multipliers = _least_distance(np.column_stack([rows, last]), h)
        s = np.clip(T @ q[:-1] - offset, lo, hi)
        mu = multipliers[: c.size]
        active = mu > MET * mu.max() if mu.any() else np.asarray(c == c.max())
        bend = 0.5 * ((V.T @ s) ** 2 @ curvature)
        gain = c.max() - (c + dc @ s).max() - g @ s - bend
        return _Step(s, active, (mu + SHARE) / unit, float(gain))


@dataclass(frozen=True)
class _Step:
    """A step s (p,), the active set (n,), the weights (n,) there, and what it promises to gain."""

    s: Floats
    active: Bools
    weights: Floats
    gain: float


def _least_distance(G: Floats, h: Floats) -> tuple[Floats, Floats]:
    """Return the shortest q with G q >= h, and its multipliers: q = G^T multipliers.

    Lawson and Hanson, *Solving Least Squares Problems*, 1974, chapter 23.
    """
    scale = np.maximum(np.linalg.norm(G, axis=1), np.finfo(float).tiny)
    E = np.vstack([(G / scale[:, None]).T, h / scale])
    f = np.zeros(len(E))
    f[-1] = 1.0
    u, _ = scipy.optimize.nnls(E, f)
    residual = E @ u - f
    return -residual[:-1] / residual[-1], -u / (scale * residual[-1])
