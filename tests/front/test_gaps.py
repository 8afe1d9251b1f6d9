"""Ends of the branches of disconnected fronts, where closed forms say they are."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from problems import Derivatives, Known, box, disconnected
from scipy.optimize import brentq

from modefront._typing import Bools, Floats
from modefront.front.dominance import nondominated
from modefront.front.gaps import Gap, branch_numbers, gaps
from modefront.front.simplex import Payoff
from modefront.front.subproblems import LatticePoint
from modefront.optim.sqp import Solution, begin


def f(x: float) -> float:
    return float(disconnected(np.array([x, 0.0]))[0][1])


LEFT = float(np.arccos(-1 / np.pi)) / (4 * np.pi)
RIGHT = float(brentq(lambda x: f(x) - f(LEFT), 0.4, 0.55))


def mirrored(theta: Floats) -> tuple[Floats, Floats, Floats]:
    """The same front with its objectives exchanged: the branch behind the gap starts by itself."""
    J, dJ, H = disconnected(theta)
    return J[::-1], dJ[::-1], H[::-1]


def front(problem: Known, equations: bool) -> tuple[list[Solution], Payoff]:
    """Points of a lattice between the ends at x = 0 and 0.651, and the simplex between these."""
    edges = [problem.evaluate(np.array([x, 0.0])).J for x in (0.0, 0.651)]
    if edges[0][0] > edges[1][0]:
        edges = edges[::-1]
    E = np.array(edges).T
    utopia = np.diag(E)
    scale = (E - utopia[:, None]).max(axis=1)
    target = Payoff(utopia, scale, (E - utopia[:, None]) / scale[:, None])
    points: list[Solution] = []
    for s in np.linspace(0.08, 0.92, 13):
        point = LatticePoint(np.array([1 - s, s]), (), target, equations)
        starts = [begin(problem.evaluate(np.array([x, 0.1]))) for x in np.linspace(0.05, 0.6, 8)]
        found = [x for x in (point.solve(problem, start) for start in starts) if x.converged]
        best = min(found, key=lambda x: float(point.order.value(x.J)))
        if not any(np.abs(best.J - x.J).max() < 1e-5 for x in points):
            points.append(best)
    return points, target


def one_gap(problem: Known, equations: bool) -> tuple[Gap, list[Solution], Bools]:
    points, target = front(problem, equations)
    (gap,) = gaps(problem, points, target, not equations)
    return gap, points, nondominated(np.array([x.J for x in points]))


@pytest.mark.parametrize(
    ("function", "equations"),
    [
        (disconnected, True),
        (mirrored, False),
        pytest.param(disconnected, False, marks=pytest.mark.slow(2)),
        pytest.param(mirrored, True, marks=pytest.mark.slow(2)),
    ],
)
def test_branches_end_where_the_front_jumps(
    function: Callable[[Floats], Derivatives], equations: bool
) -> None:
    problem = box(function, [0, -1], [0.651, 1])
    gap, points, optimal = one_gap(problem, equations)
    x = sorted(float(end.theta[0]) for end in gap.ends)
    assert x == pytest.approx([LEFT, RIGHT], abs=1e-6)
    assert gap.end is not None
    assert gap.start is not None
    assert gap.end.J[0] < gap.start.J[0]
    J = np.array([point.J for point in points])
    assert optimal.all() != equations, "equations lead into the gap"
    branches = branch_numbers(J, optimal, [gap])
    inside = branches > 0
    assert set(branches[inside].tolist()) == {1, 2}
    assert ((branches == 1) == (J[:, 0] < gap.middle))[inside].all()


def test_a_front_without_slack_has_no_gap() -> None:
    problem = box(disconnected, [0, -1], [0.651, 1])
    points, target = front(problem, equations=False)
    assert gaps(problem, [x for x in points if x.theta[0] < LEFT - 1e-3], target, True) == []
