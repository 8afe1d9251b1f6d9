"""Dominance, indicators of coverage, and the lattice of the simplex."""

import moocore
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from modefront.front.dominance import nondominated, undominated
from modefront.front.indicators import hypervolume, igd_plus, largest_gap
from modefront.front.simplex import is_flat, lattice, payoff, size
from modefront.front.subproblems import LatticePoint
from modefront.optim.problem import Evaluation
from modefront.optim.sqp import Solution, begin

# ---- dominance -------------------------------------------------------------------------------


@given(st.integers(0, 2**31), st.integers(1, 4))
def test_dominance_is_that_of_equation_4(seed: int, n: int) -> None:
    J = np.random.default_rng(seed).integers(0, 4, size=(12, n)).astype(float)
    expected = [not any((other <= row).all() and (other < row).any() for other in J) for row in J]
    assert nondominated(J).tolist() == expected
    assert nondominated(1e-9 * J + 5e-9).tolist() == expected


def test_rounding_dominates_nothing() -> None:
    J = np.array([[1.0, 2.0], [1.0 + 1e-14, 2.0], [0.0, 3.0], [np.inf, 0.0]])
    assert nondominated(J).tolist() == [True, True, True, False]


@given(st.integers(0, 2**31), st.integers(1, 4))
def test_models_are_dominated_by_the_known_ones_as_among_themselves(seed: int, n: int) -> None:
    rng = np.random.default_rng(seed)
    J, known = rng.integers(0, 4, size=(2, 12, n)).astype(float)
    among = nondominated(np.vstack([J, known]), scale=np.ones(n))[:12]
    assert undominated(J, np.vstack([J, known]), np.ones(n)).tolist() == among.tolist()


# ---- indicators ------------------------------------------------------------------------------


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 2**31), st.integers(2, 4))
def test_indicators_are_those_of_moocore(seed: int, n: int) -> None:
    rng = np.random.default_rng(seed)
    Y, R = rng.uniform(0, 1.3, size=(9, n)), rng.uniform(size=(20, n))
    assert igd_plus(Y, R) == pytest.approx(float(moocore.igd_plus(Y, ref=R)))
    assert hypervolume(Y) == pytest.approx(float(moocore.hypervolume(Y, ref=np.full(n, 1.1))))


def test_the_largest_gap_is_that_between_neighbours() -> None:
    x = np.array([0.0, 0.1, 0.15, 0.6, 0.7])
    Y = np.column_stack([x, 1 - x])
    order = np.random.default_rng(0).permutation(5)
    assert largest_gap(Y[order]) == pytest.approx(0.45 * np.sqrt(2))
    assert largest_gap(np.vstack([Y, Y])) == pytest.approx(0.45 * np.sqrt(2))
    assert largest_gap(Y[:1]) == 0


# ---- the simplex -----------------------------------------------------------------------------


@given(st.integers(1, 5), st.integers(1, 6))
def test_the_lattice_is_the_simplex(n: int, divisions: int) -> None:
    counts = lattice(n, divisions)
    assert (counts.sum(axis=1) == divisions).all()
    assert (counts >= 0).all()
    assert len({tuple(row) for row in counts.tolist()}) == len(counts) == size(n, divisions + 1)
    assert counts[0, 0] == divisions
    assert counts[-1, -1] == divisions


def solution_at(*J: float) -> Solution:
    """Return a solution of which only the objectives count."""
    return begin(Evaluation(np.zeros(1), np.array(J)))


@given(st.integers(0, 2**31), st.integers(2, 5))
def test_a_point_of_the_plane_is_where_its_normal_meets_it(seed: int, n: int) -> None:
    rng = np.random.default_rng(seed)
    P = rng.uniform(0.3, 1, (n, n)) * (1 - np.eye(n))
    edges = [solution_at(*(rng.uniform(0, 1e-3) + column)) for column in P.T]
    target = payoff(edges, np.ones(n))
    assert target is not None
    beta = rng.dirichlet(np.ones(n))
    tau = float(rng.normal())
    J = target.utopia + target.scale * (target.Phi @ beta + tau * target.r)
    assert LatticePoint(beta, (), target).order.excess(J) == pytest.approx(np.full(n, tau))
    projected = target.place(J)
    assert projected.sum() == pytest.approx(1)


def test_edges_that_are_one_model_span_nothing_and_flat_ones_the_ranges() -> None:
    same = solution_at(1.0, 2.0)
    assert payoff([same, same], np.ones(2)) is None
    corner = solution_at(0.0, 0.0, 1.0)
    worst = [solution_at(1.0, 0.0, 0.0), solution_at(0.0, 1.0, 0.0), corner]
    edges = [corner, corner, worst[0]]
    assert is_flat(edges, np.ones(3))
    assert not is_flat([corner, corner, corner], np.ones(3)), "one model is the best in everything"
    target = payoff(edges, np.ones(3), worst)
    assert target is not None
    assert target.Phi.tolist() == np.eye(3).tolist()
    assert target.scale == pytest.approx(np.ones(3))
    assert len(target.worst) == 3
