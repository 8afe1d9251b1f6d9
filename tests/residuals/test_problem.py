"""Equation (1), its derivatives, its counts and its invariances."""

from dataclasses import replace
from itertools import permutations
from typing import Literal

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from modefront._typing import Floats
from modefront.data.modal import ModalData, modal_data
from modefront.models.chain import chain
from modefront.models.function import function_model
from modefront.models.matrices import matrices
from modefront.models.parameters import Parameter
from modefront.models.reduced.options import Reduction
from modefront.optim.scalarisation import LogSum
from modefront.pairing.match import Pairing, Pairs
from modefront.residuals.base import Scale
from modefront.residuals.groups import Group
from modefront.residuals.problem import UpdatingProblem, updating_problem
from modefront.residuals.shape import without_negligible
from modefront.work.task import Costs

FREQUENCY = np.array([4.646, 13.81, 19.48])
SHAPE = np.array([[0.4561, 0.8069, 1.0], [1.0, 0.3009, -0.9026], [-0.7801, 1.0, -0.6448]])
FLOORS = ("floor1", "floor2", "floor3")
NAMES = ("k1", "k2", "k3", "m1")
ALL = (Group("frequencies", frequency="all"), Group("shapes", shape="all"))


def problem_of(data: ModalData, groups: tuple[Group, ...] = ALL) -> UpdatingProblem:
    model = chain(
        NAMES,
        [22.6, 22.6, 17.176],
        [84763.8] * 3,
        stiffness_parameters=NAMES[:3],
        mass_parameters=["m1", None, None],
    )
    bounds = dict.fromkeys(NAMES, (0.2, 5.0))
    return updating_problem(model, data, groups, bounds, dict.fromkeys(NAMES, 1.0))


def precise_objectives(theta: list[mp.mpf]) -> list[mp.mpf]:
    """Return J of frequencies and of shapes as equation (1) states them, mode by mode."""
    k = [mp.mpf("84763.8") * x for x in theta[:3]]
    m = [mp.mpf("22.6") * theta[3], mp.mpf("22.6"), mp.mpf("17.176")]
    K = mp.matrix([[k[0] + k[1], -k[1], 0], [-k[1], k[1] + k[2], -k[2]], [0, -k[2], k[2]]])
    root = mp.diag([1 / mp.sqrt(x) for x in m])
    lam, Q = mp.eigsy(root * K * root)
    phi = root * Q
    J = [mp.mpf(0), mp.mpf(0)]
    for r in range(3):
        measured = mp.mpf(float(FREQUENCY[r]))
        J[0] += (mp.sqrt(lam[r]) / (2 * mp.pi) - measured) ** 2 / measured**2
        psi = [mp.mpf(float(x)) for x in SHAPE[r]]
        chosen = [phi[i, r] for i in range(3)]
        beta = mp.fdot(psi, chosen) / mp.fdot(chosen, chosen)
        misfit = [beta * a - b for a, b in zip(chosen, psi, strict=True)]
        J[1] += mp.fdot(misfit, misfit) / (mp.fdot(psi, psi) / 3)
    return J


@settings(max_examples=10, deadline=None)
@given(st.lists(st.floats(0.5, 2.0), min_size=4, max_size=4))
def test_objectives_and_gradients_agree_with_50_digit_arithmetic(values: list[float]) -> None:
    theta = np.array(values)
    problem = problem_of(modal_data(FREQUENCY, SHAPE, FLOORS))
    result = problem.evaluate(theta)
    if (result.quantities["paired_mode"] != [1, 2, 3]).any():
        return
    with mp.workdps(50):
        expected = precise_objectives([mp.mpf(x) for x in values])
        assert result.J == pytest.approx([float(x) for x in expected], rel=1e-10)
        h = mp.mpf(10) ** -18
        for i in range(4):
            ahead, behind = ([mp.mpf(x) for x in values] for _ in "ab")
            ahead[i] += h
            behind[i] -= h
            pair = zip(precise_objectives(ahead), precise_objectives(behind), strict=True)
            slope = np.array([float((a - b) / (2 * h)) for a, b in pair])
            scale = np.abs(result.dJ).max(axis=1)
            assert (np.abs(result.dJ[:, i] - slope) <= 1e-8 * scale).all()


@pytest.mark.parametrize("theta", [[1.1, 0.9, 1.2, 1.0], [0.7, 1.6, 1.3, 0.6]])
def test_second_derivatives_agree_with_50_digit_arithmetic(theta: list[float]) -> None:
    problem = problem_of(modal_data(FREQUENCY, SHAPE, FLOORS))
    result = problem.evaluate(np.array(theta), second=True)
    assert result.exact
    with mp.workdps(50):
        h = mp.mpf(10) ** -12

        def J(i: int, k: int, a: int, b: int) -> list[mp.mpf]:
            moved = [mp.mpf(x) for x in theta]
            moved[i] += a * h
            moved[k] += b * h
            return precise_objectives(moved)

        for i in range(4):
            for k in range(i + 1):
                corners = (J(i, k, 1, 1), J(i, k, -1, -1), J(i, k, 1, -1), J(i, k, -1, 1))
                for n, (a, b, c, d) in enumerate(zip(*corners, strict=True)):
                    both = np.array([result.H[n, i, k], result.H[n, k, i]])
                    error = np.abs(both - float((a + b - c - d) / (4 * h**2))).max()
                    assert error <= 1e-8 * np.abs(result.H[n]).max()


def test_counts_are_of_what_was_measured() -> None:
    data = modal_data(FREQUENCY, SHAPE, FLOORS)
    assert problem_of(data).properties.tolist() == [3, 9]
    single = (
        Group("f1 and shape 3", frequency=[1], shape=[3]),
        Group("f2", frequency=[2]),
        Group("again", frequency=[1, 2]),
    )
    assert problem_of(data, tuple(single)).properties.tolist() == [4, 1, 2]


def test_what_is_not_measured_drops_out() -> None:
    frequency, shape = FREQUENCY.copy(), SHAPE.copy()
    frequency[1] = np.nan
    shape[0, 1] = np.nan
    shape[2] = np.nan
    problem = problem_of(modal_data(frequency, shape, FLOORS))
    assert problem.properties.tolist() == [2, 5]
    theta = np.array([1.1, 0.9, 1.2, 1.0])
    rf, rphi = problem.residuals(theta)
    assert rf.r.size == 2
    assert rphi.r.size == 5
    full = problem_of(modal_data(FREQUENCY, SHAPE, FLOORS)).residuals(theta)[0]
    assert rf.r == pytest.approx(full.r[[0, 2]])


def test_residuals_of_several_modes_are_those_of_each_one_after_the_other() -> None:
    frequency, shape = np.array([FREQUENCY, 1.01 * FREQUENCY]), np.array([SHAPE, SHAPE + 0.05])
    frequency[1, 0] = shape[0, 1, 2] = shape[1, 2, :2] = np.nan  # 3, 3, 2, 3, 3 and 1 components
    data = modal_data(frequency, shape, FLOORS)
    theta = np.array([1.1, 0.9, 1.2, 1.0])
    together = problem_of(data, (Group("all", frequency="all", shape="all"),)).residuals(theta)[0]
    single = [Group(f"f{r}", frequency=[r]) for r in (1, 2, 3)]
    single += [Group(f"s{r}", shape=[r]) for r in (1, 2, 3)]
    parts = problem_of(data, tuple(single)).residuals(theta)
    assert [part.r.size for part in parts] == [1, 2, 2, 6, 5, 4]
    np.testing.assert_array_equal(together.r, np.concatenate([part.r for part in parts]))
    np.testing.assert_array_equal(together.dr, np.concatenate([part.dr for part in parts]))


def test_objectives_are_means_over_data_sets() -> None:
    theta = np.array([1.1, 0.9, 1.2, 1.0])
    other_f, other_shape = 1.01 * FREQUENCY, SHAPE + 0.05
    both = modal_data(np.array([FREQUENCY, other_f]), np.array([SHAPE, other_shape]), FLOORS)
    J = [
        problem_of(modal_data(f, shape, FLOORS)).evaluate(theta).J
        for f, shape in ((FREQUENCY, SHAPE), (other_f, other_shape))
    ]
    result = problem_of(both)
    assert result.evaluate(theta).J == pytest.approx((J[0] + J[1]) / 2, rel=1e-12)
    assert result.properties.tolist() == [3, 9]


@settings(max_examples=20)
@given(st.lists(st.floats(-10, 10).filter(lambda x: abs(x) > 1e-3), min_size=3, max_size=3))
def test_measured_shapes_have_no_scale_and_no_sign(scales: list[float]) -> None:
    theta = np.array([1.1, 0.9, 1.2, 1.0])
    scaled: Floats = SHAPE * np.array(scales)[:, None]
    problems = [problem_of(modal_data(FREQUENCY, x, FLOORS)) for x in (SHAPE, scaled)]
    J = [problem.evaluate(theta, derivatives=False).J for problem in problems]
    assert J[1] == pytest.approx(J[0], rel=1e-10)


def test_shapes_do_not_change_when_all_stiffnesses_are_scaled() -> None:
    problem = problem_of(modal_data(FREQUENCY, SHAPE, FLOORS))
    theta = np.array([1.1, 0.9, 1.2, 1.0])
    residual = problem.residuals(theta)[1]
    direction = np.array([*theta[:3], 0.0])
    assert residual.dr @ direction == pytest.approx(0, abs=1e-12)


@given(st.lists(st.floats(-0.02, 0.02), min_size=4, max_size=4))
@settings(max_examples=20, deadline=None)
def test_errors_of_modes_bound_those_of_objectives(step: list[float]) -> None:
    std = np.linspace(0.01, 0.05, 9).reshape(3, 3)
    data = modal_data(FREQUENCY, SHAPE, FLOORS, frequency_std=0.02 * FREQUENCY, shape_std=std)
    groups = (*ALL, Group("weighted", frequency="all", shape=(2,), scale="std"))
    problem = problem_of(data, groups)
    theta = np.array([1.1, 0.9, 1.2, 1.0])
    other = theta + np.array(step)
    (first, pairs), (two, _) = problem.modes(theta), problem.modes(other)
    assert pairs.index.tolist() == [0, 1, 2]
    away = two.phi * (np.einsum("sr,sr->r", two.phi, first.phi) / (two.phi**2).sum(axis=0))
    shape = np.sqrt(((away - first.phi) ** 2).sum(axis=0) / (first.phi**2).sum(axis=0))
    margins = problem.margins(
        2 * np.abs(two.frequency / FREQUENCY - first.frequency / FREQUENCY), shape
    )
    moved = np.abs(np.sqrt(problem.evaluate(other).J) - np.sqrt(problem.evaluate(theta).J))
    assert (moved[:1] <= margins[:1] * (1 + 1e-9) + 1e-12).all()
    assert (moved <= 1.2 * margins + 1e-12).all()


@pytest.mark.parametrize("scale", ["measured", "std"])
def test_sensitivities_to_measured_values_are_those_of_differences(scale: Scale) -> None:
    f_std, shape_std = 0.01 * FREQUENCY, 0.02 + 0.01 * SHAPE**2
    groups = (
        Group("frequencies", frequency="all", scale=scale),
        Group("shapes", shape="all", scale=scale),
    )
    theta, h = np.array([1.2, 0.9, 1.1, 1.05]), 1e-5

    def problem(step: Floats) -> UpdatingProblem:
        """Return the problem of data that are so many standard deviations away."""
        f, shape = FREQUENCY + step[:, 0] * f_std, SHAPE + step[:, 1:] * shape_std
        data = modal_data(f, shape, FLOORS, frequency_std=f_std, shape_std=shape_std)
        return problem_of(data, groups)

    plain = problem(np.zeros((3, 4)))
    modes, pairs = plain.modes(theta)
    for i, row in enumerate(plain.members):
        for change in (x for member in row for x in member.sensitivities(modes, pairs)):
            for number, dJ, ddJ in zip(change.values, change.J, change.dJ, strict=True):
                step = np.zeros(12)
                step[number] = h
                after, before = (problem(s * step.reshape(3, 4)).evaluate(theta) for s in (1, -1))
                assert dJ == pytest.approx((after.J - before.J)[i] / (2 * h), rel=1e-4, abs=1e-8)
                expected = (after.dJ - before.dJ)[i] / (2 * h)
                assert ddJ == pytest.approx(expected, rel=1e-4, abs=1e-6)


def test_scatter_is_what_no_model_fits() -> None:
    """Of one frequency and one shape for all sets: a weighted mean, the first singular vector."""
    rng = np.random.default_rng(2)
    f = FREQUENCY * (1 + 0.01 * rng.standard_normal((3, 3)))
    shape = SHAPE + 0.05 * rng.standard_normal((3, 3, 3))
    std = 0.01 * f * [[1], [2], [1]]
    data = modal_data(f, shape, FLOORS, frequency_std=std, shape_std=np.full(shape.shape, 0.02))
    groups = Group("f", frequency="all", scale="std"), Group("s", shape="all", scale="std")
    frequencies, shapes = problem_of(data, groups).members
    for r in range(3):
        mean = np.average(f[:, r], weights=std[:, r] ** -2)
        scatter = (((f[:, r] - mean) / std[:, r]) ** 2).mean()
        assert frequencies[r].independent() == pytest.approx((1, scatter, 2))
        others = np.linalg.svd(shape[:, r] / 0.02, compute_uv=False)[1:]
        assert shapes[r].independent() == pytest.approx((2, others @ others / 3, 4))


def test_each_evaluation_is_counted_once(costs: Costs) -> None:
    problem = problem_of(modal_data(FREQUENCY, SHAPE, FLOORS))
    for derivatives in (True, False):
        problem.evaluate(problem.start, derivatives=derivatives)
    problem.evaluate(problem.start, second=True)
    assert replace(costs, full_time=0.0) == Costs(eigenproblems=3)


def test_models_without_second_derivatives_keep_those_of_gauss_newton() -> None:
    data = modal_data(FREQUENCY, SHAPE, FLOORS)
    known = problem_of(data)

    def function(theta: Floats) -> tuple[Floats, Floats]:
        k1, k2, k3 = 84763.8 * theta[:3] ** 2
        K = np.array([[k1 + k2, -k2, 0], [-k2, k2 + k3, -k3], [0, -k3, k3]])
        return K, np.diag([22.6, 22.6, 17.176])

    parameters = [Parameter(name, nominal=1.0, bounds=(0.2, 5.0)) for name in NAMES[:3]]
    model = function_model(parameters, dict(zip(FLOORS, range(3), strict=True)), function)
    problem = updating_problem(model, data, known.groups, parameters=parameters)
    plain, result = (problem.evaluate(problem.start, second=second) for second in (False, True))
    assert not result.exact
    np.testing.assert_array_equal(result.H, plain.H)
    infeasible = known.evaluate(np.array([1.0, -5.0, 1.0, 1.0]), second=True)
    assert not infeasible.derivatives
    assert not known.evaluate(known.start, derivatives=False, second=True).derivatives


def test_an_evaluation_without_derivatives_has_none() -> None:
    problem = problem_of(modal_data(FREQUENCY, SHAPE, FLOORS))
    for result in (
        problem.evaluate(problem.start, derivatives=False),
        problem.evaluate(np.array([1.0, -5.0, 1.0, 1.0])),
    ):
        assert not result.derivatives
        assert not result.residuals
        assert result.dJ.size == result.H.size == 0
    assert result.J.tolist() == [np.inf, np.inf]
    known, plain = (problem.evaluate(problem.start, derivatives=x) for x in (True, False))
    assert plain.J.tolist() == known.J.tolist()
    assert {*plain.quantities} == {*known.quantities}
    for name, value in plain.quantities.items():
        np.testing.assert_array_equal(value, known.quantities[name])
    assert problem.modes(problem.start, derivatives=False)[0].derivatives is None


def test_a_model_without_modes_is_infeasible_not_an_error() -> None:
    problem = problem_of(modal_data(FREQUENCY, SHAPE, FLOORS))
    result = problem.evaluate(np.array([1.0, -5.0, 1.0, 1.0]))
    assert not result.feasible


@pytest.mark.parametrize(
    ("group", "message"),
    [
        (
            Group("empty"),
            "group 'empty': expected frequency or shape .* one measured mode, found nothing",
        ),
        (Group("f9", frequency=[9]), "found 9"),
    ],
)
def test_wrong_groups_are_refused(group: Group, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        problem_of(modal_data(FREQUENCY, SHAPE, FLOORS), (group,))


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 2**31))
def test_likely_pairs_are_those_of_all_permutations(seed: int) -> None:
    """Two sensors hardly tell three modes apart: no pairs have a lower sum of logarithms."""
    rng = np.random.default_rng(seed)
    shape = np.where([True, False, True], SHAPE + 0.3 * rng.normal(size=(2, 3, 3)), np.nan)
    frequency = FREQUENCY * (1 + 0.02 * rng.normal(size=(2, 3)))
    plain = problem_of(modal_data(frequency, shape, FLOORS))
    likelihood = LogSum(np.array([3.0, 3.0]), np.array([1e-3, 1e-2]))
    problem = replace(plain, likelihood=likelihood)
    theta = rng.uniform(0.6, 1.6, 4)
    modes, pairs = problem.modes(theta)

    def value(index: tuple[int, ...]) -> float:
        r = plain.vectors(modes, Pairs(np.array(index), pairs.mac))
        return likelihood.value(np.array([x @ x for x in r]))

    least = min(map(value, permutations(range(3))))
    assert value(tuple(pairs.index.tolist())) == pytest.approx(least, rel=1e-12)
    assert (problem.evaluate(theta).J == plain.evaluate(theta).J).all() or (
        likelihood.value(problem.evaluate(theta).J) < likelihood.value(plain.evaluate(theta).J)
    )


def test_pairs_go_on_beyond_where_mac_values_change_them() -> None:
    problem = problem_of(modal_data(FREQUENCY[None], SHAPE[None, :, 1:], sensors=FLOORS[1:]))
    rng = np.random.default_rng(1)
    thetas = rng.uniform(0.3, 4.0, size=(200, 4))
    seen = [problem.evaluate(theta) for theta in thetas]
    inside = seen[0]
    here = inside.quantities["paired_mode"]
    beyond = next(x for x in seen if (x.quantities["paired_mode"] != here).any())
    there = beyond.quantities["paired_mode"]
    smooth = problem.continued(inside, beyond)
    assert smooth is not None
    assert smooth.start.tolist() == problem.start.tolist()
    assert smooth.objectives == ("frequencies", "shapes", "beyond")
    assert problem.continued(inside, inside) is None
    assert replace(problem, likelihood=LogSum(np.ones(2))).continued(inside, beyond) is None
    for x in seen:
        found, pairs = smooth.evaluate(x.theta), x.quantities["paired_mode"]
        if (pairs == there).all():
            assert found.J[-1] > 0
            assert (found.quantities["paired_mode"] == here).all()
        else:
            np.testing.assert_array_equal(found.J[:-1], x.J)
            assert found.J[-1] < 0 or (pairs != here).any()
        np.testing.assert_array_equal(found.J, smooth.evaluate(x.theta, derivatives=False).J)
    both = smooth.continued(inside, replace(inside, quantities={"paired_mode": here[::-1]}))
    assert smooth.continued(inside, beyond) is None
    assert both is not None
    middle, h = both.evaluate(beyond.theta), 1e-6
    np.testing.assert_array_equal(middle.J[:-1], smooth.evaluate(beyond.theta).J)
    assert middle.J[-1] < 0 < middle.J[-2]
    second, own = both.evaluate(inside.theta, second=True), problem.evaluate(inside.theta)
    assert not second.exact
    assert not second.residuals
    np.testing.assert_array_equal(both.evaluate(inside.theta).H[:2], own.H)
    assert not second.H[2:].any()
    for j, step in enumerate(h * np.eye(4)):
        ahead, behind = (both.evaluate(beyond.theta + x).J for x in (step, -step))
        np.testing.assert_allclose((ahead - behind) / (2 * h), middle.dJ[:, j], atol=1e-6)


@pytest.mark.parametrize(
    ("N", "reduction"), [(12, "off"), (12, "auto"), (240, "off"), (240, "auto")]
)
@pytest.mark.parametrize("floating", [False, True])
def test_modes_are_candidates_up_to_beyond_the_highest_measured_frequency(
    N: int, reduction: Literal["off", "auto"], floating: bool
) -> None:
    """Most of the modes of a chain, which may float, are not measured."""
    k = np.array([0.0 if floating else 5e4, *[5e4] * (N - 1)])
    K = np.diag(k) + np.diag([*k[1:], 0.0]) - np.diag(k[1:], 1) - np.diag(k[1:], -1)
    sensors = {f"s{i}": i for i in range(0, N, max(N // 12, 1))}
    model = matrices(["k"], {"k": K}, {"base": 20 * np.eye(N)}, sensors, floating=floating)
    there = model.modes(np.ones(1), 10, derivatives=False)
    f, shapes = there.frequency[[1, 3, 8]], there.phi.T[[1, 3, 8]]
    given = {"k": (0.5, 2.0)}, {"k": 1.0}
    problem = updating_problem(
        model, modal_data(f, shapes, model.sensors), ALL, *given, reduction=Reduction(reduction)
    )
    below = model.modes(np.ones(1), min(N, 20), derivatives=False).frequency < 1.3 * f[-1]
    assert problem.pairing.spare == below.sum() - 3
    found = problem.evaluate(np.ones(1))
    assert found.quantities["paired_mode"].tolist() == [2, 4, 9]
    assert found.J == pytest.approx(0, abs=1e-12)
    few = Pairing(spare=2)
    assert updating_problem(model, problem.data, ALL, *given, few).pairing is few
    shapes_alone = modal_data(np.full(3, np.nan), shapes, model.sensors)
    assert updating_problem(model, shapes_alone, ALL[1:], *given).pairing == Pairing(spare=3)


def test_a_problem_says_how_large_it_is() -> None:
    data = modal_data(np.array([FREQUENCY, FREQUENCY]), np.array([SHAPE, SHAPE]), FLOORS)
    assert repr(problem_of(data)) == (
        "UpdatingProblem(4 parameters, 3 modes at 3 sensors in 2 data sets, groups frequencies, "
        "shapes)"
    )
    assert " in 1 data set, " in repr(problem_of(modal_data(FREQUENCY, SHAPE, FLOORS)))


def test_deviations_that_are_rounding_become_the_median_of_the_others() -> None:
    std = np.array([3.0, 0.0, 1e-12, 1.0, 2.5])
    assert without_negligible(std).tolist() == [3.0, 2.5, 2.5, 1.0, 2.5]
    assert without_negligible(1e-3 * std).tolist() == (1e-3 * without_negligible(std)).tolist()
