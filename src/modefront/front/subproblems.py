"""Subproblems: an order on the objectives J, a programme that a local solver minimises.

Each orders all models by J alone, so that whatever model one of them meets competes for the place
of the best in all others. `docs/methods/nbi.md` has the edges and the points of the lattice.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from modefront._typing import Bools, Floats
from modefront.front.simplex import Payoff
from modefront.optim.lexicographic import EXACT, TIE, TIGHTEST, Lexicographic
from modefront.optim.problem import Problem
from modefront.optim.scalarisation import STEEP, Scalarisation, achievement, below, weighted
from modefront.optim.sqp import Options, Solution, Status, solve
from modefront.work.task import Key

RHO = 1e-4  # share of all objectives in what a point of the lattice minimises

LOOSE = 10 * RHO
"""Distance of a point from its normal, over the ranges, above which the front ends there: the share
of all objectives in what it minimises moves it by less."""


def active_bounds(shares: Floats) -> Bools:
    """Return which bounds are active, from the weights times the normal (n,): the others have rho.

    >>> active_bounds(np.array([0.3, RHO, 0.7])).tolist()
    [True, False, True]
    """
    return np.asarray(shares > 2 * RHO)


SAMPLE = 16  # random models of which typical sizes are medians


@dataclass(frozen=True)
class Order:
    r"""Orders of models by J: least :math:`g \max_i c_i + s \sum_i c_i`, c = J / unit - offset.

    ``unit`` and ``offset`` (..., n), ``greatest`` g and ``share`` s (...) are of one order, or of
    many.
    """

    unit: Floats
    offset: Floats
    greatest: Floats | float
    share: Floats | float

    def excess(self, J: Floats) -> Floats:
        """Return c (..., n) of objectives J (..., n)."""
        return J / self.unit - self.offset

    def value(self, J: Floats) -> Floats:
        """Return the numbers (...) by which models with objectives J (..., n) are ordered."""
        c = self.excess(J)
        return np.asarray(self.greatest * c.max(axis=-1) + self.share * c.sum(axis=-1))

    def spread(self, J: Floats) -> Floats:
        """Return how far J (..., n) lies from the normal of a point, over that; else 0."""
        return np.asarray(self.greatest * np.ptp(self.excess(J), axis=-1))


@dataclass(frozen=True)
class Least(Lexicographic):
    """The lexicographic minimum of one objective, and the name of that."""

    name: str

    @property
    def key(self) -> Key:
        """Name among all subproblems."""
        return ("edge", self.name)

    @cached_property
    def order(self) -> Order:
        """Nearly what orders models; among equals in J_i, the others decide."""
        w = self.programme(TIE).w
        return Order(1 / w, np.zeros(w.size), 0.0, 1.0)

    def gain(self, J: Floats, known: Solution) -> float:
        """Return the share by which J_i falls, or where that is tied, the others, if any do."""
        i, before, others = self.objective, known.J, self.others
        if not self.ties(J, before):
            return 1 - self.level(J[i]) / self.level(before[i])
        gain = float(others @ (before - J)) / max(float(others @ before), EXACT)
        # Beside an edge, a tie hides what the others cost: the end of the path has to agree.
        end = self.programme(EXACT)
        return gain if gain * (end.value(before) - end.value(J)) > 0 else 0.0


@dataclass(frozen=True)
class Weights:
    """The minimum of w^T J; values below ``negligible`` differ in nothing."""

    w: Floats
    key: Key
    negligible: float

    @cached_property
    def order(self) -> Order:
        """By w^T J."""
        return Order(1 / self.w, np.zeros(self.w.size), 0.0, 1.0)

    def gain(self, J: Floats, known: Solution) -> float:
        """Return the share by which w^T J falls."""
        before = float(self.w @ known.J)
        return float(before - self.w @ J) / max(before, self.negligible)

    def solve(self, problem: Problem, start: Solution, known: Solution | None = None) -> Solution:
        """Return the minimum below a start, or a known one to which it leads."""
        options = Options(negligible=TIGHTEST.negligible / EXACT * self.negligible)
        return solve(problem, weighted(self.w), start, options, known)


@dataclass(frozen=True)
class LatticePoint:
    r"""The point of the lattice at ``beta`` (n,).

    With ``equations``, those of Das & Dennis are solved, which may lead to dominated models: all
    excesses c_i are equal, and as small as possible (1998, doi:10.1137/S1052623496307510). With n
    of them and the slope :math:`\nu` of a penalty, what is minimised is
    :math:`\bar c + \nu (\max_i c_i - \bar c)`.
    """

    beta: Floats
    place: tuple[int, ...]
    target: Payoff
    equations: bool = False

    @property
    def key(self) -> Key:
        """Name among all subproblems."""
        return ("point", *self.place)

    @cached_property
    def order(self) -> Order:
        """By the greatest excess with its share of all."""
        greatest, share = (STEEP, (1 - STEEP) / self.beta.size) if self.equations else (1.0, RHO)
        at = self.target
        offset = (at.utopia / at.scale + at.Phi @ self.beta) / at.r
        return Order(at.unit, offset, greatest, share)

    def met(self, solution: Solution) -> bool:
        """Return whether a solution lies on the normal, as it does if it meets equations."""
        apart = float(np.ptp(self.order.excess(solution.J) * self.target.r))
        return solution.converged and apart <= LOOSE

    def gain(self, J: Floats, known: Solution) -> float:
        """Return the fall of the excess, over the objectives along the normal or their ranges."""
        order, w = self.order, known.weights
        if not w.any():  # of a model that is no solution, those of its greatest excess
            c = order.excess(known.J)
            w = (order.greatest * (c == c.max()) + order.share) / order.unit
        fall = float(order.value(known.J) - order.value(J))
        return fall / min(max(float(w @ known.J), EXACT), 1.0)

    def solve(self, problem: Problem, start: Solution, _: Solution | None = None) -> Solution:
        """Return the point that a start leads to."""
        found = replace(solve(problem, self.programme, start), beta=self.beta)
        missed = self.equations and found.converged and not self.met(found)
        return replace(found, status=Status.STALLED) if missed else found

    @property
    def programme(self) -> Scalarisation:
        """What is minimised."""
        order = self.order
        share, rows = order.share / order.unit, np.diag(1 / order.unit)
        return achievement(share, rows, order.offset, float(order.greatest))


Subproblem = Least | Weights | LatticePoint
"""An order on J: ``gain`` tells how much better objectives (n,) are than a known model. ``solve``
minimises its programme from a start, in full if that may beat a known model."""


def sample(problem: Problem, *, rng: np.random.Generator) -> Floats:
    """Return the typical size of each objective, of random models; empty without any."""
    span = problem.upper - problem.lower
    thetas = problem.lower + span * rng.uniform(size=(SAMPLE, span.size))
    J = np.array([problem.evaluate(theta, derivatives=False).J for theta in thetas])
    J = J[np.isfinite(J).all(axis=1)]
    return np.maximum(np.median(J, axis=0), np.finfo(float).tiny) if len(J) else np.zeros(0)


def near_best(
    problem: Problem,
    best: Solution,
    objective: int,
    tolerance: float,
    sizes: Floats,
    known: Sequence[Solution],
) -> Solution:
    """Return, of the models within a tolerance of the best in an objective, the best in the others.

    Where an objective hardly changes along a valley, the end of the valley says nothing, and the
    front there is flat; this is the point from which it is not. It is solved from those of the
    ``known`` solutions that are closest in the objective, one after another. An objective that is
    fitted exactly keeps its edge, and so does one for which the programme does not converge.
    """
    least = best.J[objective]
    if least <= EXACT * sizes[objective]:
        return best
    value = (1 + tolerance) * least
    others = np.where(np.arange(sizes.size) != objective, 1 / sizes, 0.0)
    unit = np.eye(sizes.size)[objective] / value
    closest = sorted(known, key=lambda solution: abs(np.log(solution.J[objective] / value)))
    for start in closest[: sizes.size]:
        solved = solve(problem, below(others, unit, 1.0), start)
        if solved.converged and solved.J[objective] <= (1 + TIE) * value:
            return solved
    return best
