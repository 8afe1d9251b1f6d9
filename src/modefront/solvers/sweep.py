r"""The weight sweep: weighted sums with weights in uniform steps.

.. math:: \min_\theta \sum_i w_i J_i, \qquad w \text{ on the lattice of the simplex}

It is here to be compared with. Every solution is Pareto optimal, but only points at which the
front is convex are solutions, whatever the weights, and uniform steps of the weights give points
that crowd where the front is curved (Das & Dennis 1997, doi:10.1007/BF01197559).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from modefront._typing import Floats
from modefront.solvers.continuation import Simplex, continuation
from modefront.solvers.payoff import BETTER
from modefront.solvers.problem import Problem
from modefront.solvers.scalarisation import weighted
from modefront.solvers.sqp import Solution, solve
from modefront.work.task import IMMEDIATE, Executor

LEAST = 1e-6
"""Least weight: without any, the minimum of the others would not be unique."""


@dataclass(frozen=True)
class WeightedSums:
    """The programmes of the sweep, whose weights are the points of the lattice.

    ``scale`` (n,) is the range of each objective.
    """

    scale: Floats
    label: str = "weights"

    def goes_on(self, _: Floats) -> bool:
        """Return False: there are no weights beyond the simplex."""
        return False

    def distance(self, beta: Floats, other: Floats) -> Floats:
        """Return the greatest differences (...) of a point (n,) and others (..., n)."""
        return np.asarray(np.abs(beta - other).max(axis=-1))

    def place(self, edge: int, _: Floats) -> Floats:
        """Return the corner of the simplex at which an edge is the solution."""
        return np.eye(self.scale.size)[edge]

    def weights(self, beta: Floats) -> Floats:
        """Return the weights of the objectives at a point of the simplex, shape (n,)."""
        return np.maximum(beta, LEAST)

    def solve(self, problem: Problem, beta: Floats, start: Solution) -> Solution:
        """Return the minimum of the weighted sum, from a start."""
        return solve(problem, weighted(self.weights(beta)), start)

    solve_again = solve

    def is_better(self, beta: Floats, J: Floats, known: Floats) -> bool:
        """Return whether the weighted sum is less than a known one."""
        w = self.weights(beta)
        return float(w @ (known - J)) > BETTER * float(w @ self.scale)


def weight_sweep(
    problem: Problem,
    edges: Sequence[Solution],
    scale: Floats,
    lattice: Simplex,
    work: Executor = IMMEDIATE,
) -> list[Solution]:
    """Return the minimum of a weighted sum for each point of the lattice, in its order.

    Each is sought from its neighbours on all sides; the best one is kept.
    """
    return continuation(problem, WeightedSums(scale), edges, lattice, work)
