"""Combinations of parameters with known answers: the chain, and Jacobians made by hand."""

from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import modefront as mf
from modefront.findings.knowledge import direction_in_words, summaries
from modefront.identifiability.combinations import (
    NONE,
    WEAK,
    Combination,
    Determination,
    combinations,
    cosines,
    decompose,
    determination,
    index,
    optimal_weights,
    pairs,
    sensitivities,
    sparse_basis,
)
from modefront.identifiability.scale import Scale
from modefront.work.task import counted

NAMES = ("k1", "k2", "k3")


def relative(p: int) -> Scale:
    """Return the scale of changes that are relative to positive parameters."""
    return Scale(np.ones(p), np.ones(p), np.ones(p, dtype=bool))


def said(group: mf.Group, determined: Sequence[Combination], names: Sequence[str]) -> str:
    """Return what is said of a group that determines these combinations."""
    problem: Any = SimpleNamespace(model=SimpleNamespace(parameters=names), groups=(group,))
    p = len(names)
    of = Determination(relative(p), [], [(group.name, determined)], np.eye(p))
    return str(next(summaries(problem, of)))


def chain() -> mf.UpdatingProblem:
    model = mf.chain(NAMES, [2.0, 1.5, 1.0], [3e3, 2e3, 4e3], stiffness_parameters=NAMES)
    modes = model.modes(np.array([1.2, 0.8, 1.1]), 3)
    data = mf.modal_data(modes.frequency * [1.01, 0.98, 1.02], modes.phi.T, model.sensors)
    groups = [mf.Group("frequencies", frequency="all"), mf.Group("shapes", shape="all")]
    return mf.updating_problem(
        model, data, groups, dict.fromkeys(NAMES, (0.1, 9.0)), dict.fromkeys(NAMES, 1.0)
    )


def test_shapes_leave_the_scale_of_all_stiffnesses() -> None:
    problem = chain()
    theta = np.array([1.3, 0.7, 2.0])
    result = combinations(problem, problem.evaluate(theta), 1)
    assert [combination.share > NONE for combination in result] == [True, True, False]
    assert result[-1].direction == pytest.approx(np.ones(3) / np.sqrt(3), abs=1e-9)
    text = said(problem.groups[1], result, NAMES)
    assert text.endswith("; k1, k2 and k3 can be scaled together: no shape changes")
    assert text.startswith("group shapes determines 2 of 3 combinations of parameters")


def test_an_evaluation_tells_the_same_without_another_one() -> None:
    problem = chain()
    evaluation = problem.evaluate(np.array([1.3, 0.7, 2.0]))
    weights = optimal_weights(problem.properties, evaluation.J)
    with counted() as costs:
        result = combinations(problem, evaluation, weights=weights)
    assert costs.eigenproblems == 0
    expected = combinations(problem, problem.evaluate(evaluation.theta), weights=weights)
    for first, other in zip(result, expected, strict=True):
        assert first.sensitivity == pytest.approx(other.sensitivity, rel=1e-7)
        assert abs(first.direction @ other.direction) == pytest.approx(1, abs=1e-7)
    shapes = combinations(problem, evaluation, 1)
    assert [shape.share > NONE for shape in shapes] == [True, True, False]


def test_weights_of_groups_move_what_is_determined_best() -> None:
    problem = chain()
    theta = problem.start
    heavy = combinations(problem, problem.evaluate(theta), weights=np.array([1e12, 1.0]))
    alone = combinations(problem, problem.evaluate(theta), 0)
    assert abs(heavy[0].direction @ alone[0].direction) == pytest.approx(1, abs=1e-9)


def test_nominal_modes_that_are_close_leave_other_combinations_determined() -> None:
    names, D = ("left", "right"), np.diag([1.0, 0.0])
    weak = np.array([[1e-3, -1e-3], [-1e-3, 1.1e-3]])  # between two equal oscillators
    K = {"base": weak, "left": D, "right": np.eye(2) - D}
    model = mf.matrices(names, K, {"base": np.eye(2)}, {"a": 0, "b": 1})
    true = model.modes(np.array([0.9, 1.2]), 2)
    data = mf.modal_data(true.frequency, true.phi.T, model.sensors)
    groups = [mf.Group("frequencies", frequency="all"), mf.Group("shapes", shape="all")]
    bounds, nominal = dict.fromkeys(names, (0.5, 2.0)), dict.fromkeys(names, 1.0)
    problem = mf.updating_problem(model, data, groups, bounds, nominal)
    assert max(x.sensitivity for x in decompose(problem.residuals(problem.start)[1].dr)) > 100
    found = determination(problem, problem.evaluate(problem.start))
    assert all(x.share > WEAK for x in found.combinations[-1][1])
    assert pairs(found.effects) == []
    assert sensitivities(problem).superfluous == ()


def test_a_group_that_is_fitted_exactly_has_a_bounded_weight() -> None:
    assert optimal_weights(np.array([3.0, 9.0]), np.array([2.0, 4.5])).tolist() == [1.5, 2.0]
    assert optimal_weights(np.array([3.0, 9.0]), np.array([0.0, 4.5])).tolist() == [1e6, 2.0]


@given(st.integers(0, 2**31), st.integers(2, 6), st.integers(1, 4))
def test_directions_not_determined_span_the_null_space(seed: int, p: int, d: int) -> None:
    d = min(d, p - 1)
    rng = np.random.default_rng(seed)
    N = np.linalg.qr(rng.normal(size=(p, d)))[0]
    G = rng.normal(size=(p + 2, p)) @ (np.eye(p) - N @ N.T)
    result = decompose(G)
    free = np.array(
        [combination.direction for combination in result if combination.share <= NONE]
    ).T
    assert free.shape == (p, d)
    basis = sparse_basis(free, [np.ones(len(free))], lambda _: True)
    assert basis.shape == (p, d)
    assert np.linalg.matrix_rank(basis) == d
    assert np.abs(basis - N @ (N.T @ basis)).max() < 2e-3 * np.abs(basis).max()


def test_a_basis_is_made_of_what_can_be_said() -> None:
    e = np.eye(5)
    known = np.column_stack([e[4], e[0] + e[1] + e[2] + e[3], e[0] + 2 * e[1]])
    mixed = np.linalg.qr(known)[0] @ np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]
    basis = sparse_basis(mixed, [np.ones(len(mixed))], lambda _: True)
    names = ("a", "b", "c", "d", "m")
    messages = [direction_in_words(v, names, relative(5)) for v in basis.T]
    assert messages[:2] == ["m can have any value", "a, b, c and d can be scaled together"]
    assert len(messages) == 3


def test_long_lists_are_cut() -> None:
    names = tuple(f"k{i}" for i in range(6))
    both = mf.Group("data", frequency="all", shape="all")
    text = said(both, decompose(np.eye(6)[:1]), names)
    assert text == (
        "group data determines 1 of 6 combinations of parameters; k1 can have any value; "
        "k2 can have any value; k3 can have any value; and 2 more: no residual changes"
    )


def test_what_is_hardly_determined_is_said() -> None:
    text = said(mf.Group("data", shape="all"), decompose(np.diag([1.0, 1e-3])), "ab")
    assert text == "group data determines 2 of 2 combinations of parameters, but hardly b"


def test_the_collinearity_index_of_known_angles() -> None:
    c = np.cos(0.05)
    gram = np.array([[1.0, 3 * c, 0.0], [3 * c, 9.0, 0.0], [0.0, 0.0, 4.0]])
    assert cosines(gram)[0, 1] == pytest.approx(c)
    assert index(gram) == pytest.approx(1 / np.sqrt(1 - c))
    assert index(gram[::2, ::2]) == 1.0
    assert [pair[:2] for pair in pairs(gram)] == [(0, 1)]
    parallel = np.ones((2, 2))
    assert index(parallel) == np.inf
    assert cosines(np.diag([1.0, 0.0])).tolist() == [[1.0, 0.0], [0.0, 0.0]]


def test_a_percent_of_a_negative_parameter_is_one_as_of_a_positive_one() -> None:
    K, found = np.array([[2.0, -1.0], [-1.0, 1.0]]), list[mf.UpdatingProblem]()
    for sign in (1.0, -1.0):
        model = mf.matrices(
            ["t"], {"base": K, "t": sign * K}, {"base": np.eye(2)}, {"a": 0, "b": 1}
        )
        f = model.modes(np.array([sign]), 2, derivatives=False).frequency
        data = mf.modal_data(f, np.full((2, 2), np.nan), model.sensors)
        low, high = sorted((0.9 * sign, 1.1 * sign))
        groups = [mf.Group("f", frequency="all")]
        found.append(mf.updating_problem(model, data, groups, {"t": (low, high)}, {"t": sign}))
    positive, negative = (sensitivities(x).frequency for x in found)
    assert positive == pytest.approx(np.full((1, 2), 0.25))  # f goes with the root of 1 + t
    assert negative == pytest.approx(positive)
