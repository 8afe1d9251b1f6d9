"""Edges beside those of SciPy's optimisers, on random chains that are like no example.

Three regimes of the objective whose edge is sought: one minimum; a valley, in which the
objective is small but not zero and hardly changes; a manifold of models that fit exactly.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from independent import Equation, Reference, agreement, edge_reference
from updating_problems import chain_case, make

import modefront as mf
from modefront.front.front import Front
from modefront.front.options import Pareto
from modefront.front.pareto import pareto_front
from modefront.optim.sqp import Solution

WORSE = 0.002
"""Relative excess of an objective above which an edge is worse."""

Key = tuple[int, int, int, str]
"""Storeys, modes, seed and groups of a chain."""


@cache
def equation(key: Key) -> Equation:
    storeys, modes, seed, grouping = key
    return Equation(chain_case(storeys, modes, seed, grouping=grouping))


@cache
def reference(key: Key, i: int) -> Reference:
    return edge_reference(equation(key), i)


@cache
def computed_front(key: Key) -> Front:
    n = len(equation(key).case.problem.objectives)
    return pareto_front(equation(key).case.problem, np.ones(n), Pareto(points=2), seed=1)


def computed_edge(key: Key, i: int) -> Solution:
    return computed_front(key).edges[i].best


def regime(key: Key, i: int) -> tuple[bool, float]:
    """Return whether the group is fitted exactly, and how flat it is at its minimum.

    This is the least over the greatest singular value of the residuals' derivatives with respect
    to the parameters that are not at a bound; 0 where these outnumber the residuals.
    """
    known = reference(key, i)
    _, best = known.edge(i, known.least(i))
    position = equation(key)
    parts = position.parts(best.theta)
    assert parts is not None
    z = (best.theta - position.lower) / position.span
    dr = (parts[i].dr * position.span)[:, (z > 1e-6) & (z < 1 - 1e-6)]
    s = np.linalg.svd(dr, compute_uv=False)
    flatness = float(s[-1] / s[0]) if dr.shape[0] >= dr.shape[1] else 0.0
    return bool(best.J[i] <= known.floor[i]), flatness


def assert_as_good(key: Key, i: int) -> None:
    """Assert that no model of the independent optimiser is better in the order of the edge."""
    best, known = computed_edge(key, i).evaluation, reference(key, i)
    least = known.least(i)
    assert best.J[i] <= max(least * (1 + WORSE), known.floor[i])
    chosen = float(known.others(i, best.J))
    others, _ = known.edge(i, max(best.J[i], least))
    assert chosen <= others * (1 + WORSE) + float(known.others(i, known.floor))
    np.testing.assert_allclose(best.J, equation(key).J(best.theta), rtol=1e-6, atol=1e-16)


def test_both_evaluate_the_same_equation() -> None:
    for key in [(8, 6, 0, "modes"), (10, 3, 0, "kinds"), (8, 4, 1, "three")]:
        assert agreement(equation(key), np.random.default_rng(0)) < 1e-10


UNIQUE = [
    ((6, 5, 0, "modes"), 1),
    pytest.param((8, 4, 5, "modes"), 0, marks=pytest.mark.slow(3)),
]


@pytest.mark.parametrize(("key", "i"), UNIQUE)
def test_a_unique_minimum(key: Key, i: int) -> None:
    exact, flatness = regime(key, i)
    assert not exact
    assert flatness > 0.01
    assert_as_good(key, i)


VALLEYS = [
    ((6, 4, 2, "modes"), 0),
    ((10, 2, 3, "kinds"), 1),
    ((8, 4, 0, "kinds"), 1),
    ((10, 5, 1, "kinds"), 1),
]


@pytest.mark.slow(3)
@pytest.mark.parametrize(("key", "i"), VALLEYS)
def test_a_valley(key: Key, i: int) -> None:
    exact, flatness = regime(key, i)
    assert not exact
    assert flatness < 0.01
    assert_as_good(key, i)


MANIFOLDS = [
    ((10, 3, 0, "kinds"), 0),
    ((12, 4, 1, "kinds"), 0),
    ((8, 4, 2, "three"), 1),
    ((8, 4, 4, "three"), 2),
]


@pytest.mark.slow(3)
@pytest.mark.parametrize(("key", "i"), MANIFOLDS)
def test_a_manifold_of_exact_fits(key: Key, i: int) -> None:
    exact, flatness = regime(key, i)
    assert exact
    assert flatness < 1e-9
    assert_as_good(key, i)


@pytest.mark.slow(4)
def test_a_front_on_which_other_modes_are_paired() -> None:
    """Of this frame, SLSQP finds models between the points of two pairings, on the second one."""
    problem = make("frame", 29).problem
    without = mf.Identifiability(flat=0.0, models=0)
    data = mf.solve(
        problem, points=11, seed=1, identifiability=without, noise=mf.NoisePrior(weight=0)
    )
    J = data["objective"].values[data["pareto"].values]
    for known in ([0.0022630944, 0.0363256539], [0.0024306762, 0.0311083138]):
        worse = (np.array(known) * (1 + WORSE) <= J).all(axis=1)
        assert not worse.any()
