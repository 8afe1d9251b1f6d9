"""The scale of changes and the sentences in it: the same in every form of the same problem.

Every sentence is compared with what finite differences of the residuals, or the residuals
themselves at models along the claimed combination, say without this code.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import scipy.linalg
import scipy.sparse

import modefront as mf
from modefront import Pairing
from modefront._typing import Floats
from modefront.findings.knowledge import alike, free_in_words, summaries
from modefront.identifiability.combinations import (
    Determination,
    combinations,
    unchanged_groups,
    without_effect,
)
from modefront.identifiability.scale import Scale, scale_at
from modefront.linalg.affine import SparseAffine
from modefront.models.matrices import MatrixModel
from modefront.study.check import determined, refuse_unchanged_groups

K0 = 3e3
GROUPS = (mf.Group("frequencies", frequency="all"), mf.Group("shapes", shape="all"))
FORMS = ("k", "alpha", "N/m")


def spring(n: int, i: int) -> Floats:
    """Unit spring i of a chain of n masses: from the ground, or from mass i - 1, to mass i."""
    ends = np.zeros(n + 2)
    ends[i : i + 2] = -1.0, 1.0
    return np.outer(ends[1:-1], ends[1:-1])


def in_form(form: str, k: Floats) -> Floats:
    """Return multiples of the nominal stiffness in a form of the parameters."""
    return {"k": k, "alpha": k - 1, "N/m": K0 * k}[form]


def problem_of(
    form: str,
    n: int = 4,
    *,
    springs: Sequence[Floats] | None = None,
    masses: Sequence[float] | None = None,
    lower: float = 0.2,
    upper: float = 5.0,
    sensors: Sequence[int] | None = None,
    noise: float = 0.02,
    modes: int | None = None,
) -> mf.UpdatingProblem:
    """A chain whose springs are parameters, as multiples, as changes, or in N/m."""
    springs = [spring(n, i) for i in range(n)] if springs is None else springs
    names = [f"k{i + 1}" for i in range(len(springs))]
    unit = 1.0 if form == "N/m" else K0
    K = {name: unit * spring for name, spring in zip(names, springs, strict=True)}
    if form == "alpha":
        K = {"base": sum(K.values(), np.zeros((n, n))), **K}
    M = {"base": np.diag([2.0] * n if masses is None else masses)}
    places = {f"floor{i + 1}": i for i in (range(n) if sensors is None else sensors)}
    model = mf.matrices(names, K, M, places)
    rng = np.random.default_rng(5)
    true = in_form(form, rng.uniform(0.8, 1.2, len(names)))
    count = modes or sum(np.diag(M["base"]) > 0)
    position = model.modes(true, int(count))
    f = position.frequency * (1 + noise * rng.normal(size=position.frequency.shape))
    phi = position.phi.T * (1 + noise * rng.normal(size=position.phi.T.shape))
    f = np.where(f > 1e-6 * f.max(), f, np.nan)  # none of motions as a rigid body
    data = mf.modal_data(f, phi, model.sensors)
    ends = in_form(form, np.array([lower, upper]))
    bounds = dict.fromkeys(names, (float(ends[0]), float(ends[1])))
    nominal = dict.fromkeys(names, float(in_form(form, np.array(1.0))))
    return mf.updating_problem(model, data, GROUPS, bounds, nominal, Pairing("order"))


def residuals(problem: mf.UpdatingProblem, theta: Floats, group: int) -> Floats:
    return problem.residuals(theta)[group].r


def by_differences(problem: mf.UpdatingProblem, theta: Floats, group: int) -> Floats:
    """The Jacobian of a group's residuals by central differences, in multiples of the units."""
    unit = scale_at(problem, theta).unit
    columns = []
    for step in np.diag(1e-5 * unit):
        ahead = residuals(problem, theta + step, group)
        columns.append((ahead - residuals(problem, theta - step, group)) / 2e-5)
    return np.array(columns).T


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("k", [np.ones(4), np.array([0.3, 1.7, 0.9, 2.4])])
def test_the_unit_of_a_spring_is_what_it_is(form: str, k: Floats) -> None:
    problem = problem_of(form)
    theta = in_form(form, k)
    result = scale_at(problem, theta)
    expected = K0 * k if form == "N/m" else k
    assert result.unit == pytest.approx(expected, rel=1e-9)
    assert list(result.scalings) == ["stiffness matrix"]
    assert result.scalings["stiffness matrix"] == pytest.approx(expected, rel=1e-7)


def test_the_unit_is_that_of_the_generalised_eigenproblem_for_sparse_matrices_too() -> None:
    """200 masses, each with a spring to the ground; every parameter has a third of the others."""
    n = 200
    parts = [sum(spring(n, i) for i in range(j, n, 3)) for j in range(3)]
    extra = np.diag(np.linspace(1.0, 2.0, n))  # springs to the ground: no member is alone
    names = ("a", "b", "c")
    K = {name: scipy.sparse.csr_array(K0 * A) for name, A in zip(names, parts, strict=True)}
    K["base"] = scipy.sparse.csr_array(K0 * extra)
    model = mf.matrices(names, K, {"base": scipy.sparse.eye_array(n).tocsr()}, {"top": n - 1})
    assert isinstance(model.stiffness, SparseAffine)
    modes = model.modes(np.ones(3), 2)
    data = mf.modal_data(modes.frequency, modes.phi.T, model.sensors)
    groups = [mf.Group("frequencies", frequency="all")]
    bounds = dict.fromkeys(names, (0.01, 100.0))
    problem = mf.updating_problem(model, data, groups, bounds, dict.fromkeys(names, 1.0))
    theta = np.array([1.0, 0.6, 3.0])
    whole = K0 * (extra + sum(t * A for t, A in zip(theta, parts, strict=True)))
    for unit, A in zip(scale_at(problem, theta).unit, parts, strict=True):
        top = scipy.linalg.eigh(K0 * A, whole, eigvals_only=True)[-1]
        assert unit == pytest.approx(1 / top, rel=0.1)


def test_a_free_structure_has_units_too() -> None:
    problem = problem_of("k", springs=[spring(4, i) for i in (1, 2, 3)], modes=4)
    assert scale_at(problem, np.array([1.0, 2.0, 0.5])).unit == pytest.approx(
        [1.0, 2.0, 0.5], rel=1e-2
    )


def test_the_unit_of_a_mass_is_what_its_degree_of_freedom_weighs() -> None:
    names = ("k", "m")
    model = mf.chain(
        names,
        [2.0, 1.0],
        [K0, K0],
        added_masses=[3.0, 0.0],
        stiffness_parameters=["k", "k"],
        mass_parameters=["m", None],
    )
    modes = model.modes(np.ones(2), 2)
    data = mf.modal_data(modes.frequency, modes.phi.T, model.sensors)
    wide = dict.fromkeys(names, (0.1, 50.0))
    problem = mf.updating_problem(model, data, GROUPS, wide, dict.fromkeys(names, 1.0))
    assert scale_at(problem, np.array([1.0, 2.0])).unit == pytest.approx([1.0, (2 * 2 + 3) / 2])


def test_a_weak_member_beside_a_strong_one_is_measured_by_its_range() -> None:
    """A strut to the top with 1e-4 of the stiffness of a storey, as a multiple from 0.2 to 5."""
    strong = [spring(3, i) for i in range(3)]
    weak = np.diag([0.0, 0.0, 1e-4])
    for form in FORMS:
        problem = problem_of(form, 3, springs=[*strong, weak])
        result = combinations(problem, problem.evaluate(problem.start), weights=np.ones(2))
        assert 1e-5 < result[-1].share < 1e-2, "hardly determined"
        assert abs(result[-1].direction[3]) > 0.9


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("upper", [3.0, 30.0])
@pytest.mark.parametrize("k", [np.ones(4), np.array([0.9, 1.2, 0.8, 1.1])])
def test_shapes_leave_the_scale_of_the_stiffness_in_every_form(
    form: str, upper: float, k: Floats
) -> None:
    problem = problem_of(form, upper=upper)
    theta = in_form(form, k)
    scale = scale_at(problem, theta)
    result = combinations(problem, problem.evaluate(theta), 1, scale=scale)
    assert [combination.share > 1e-3 for combination in result] == [True, True, True, False]
    jacobian = by_differences(problem, theta, 1)
    sigma = np.linalg.svd(jacobian, compute_uv=False)
    assert [combination.sensitivity for combination in result] == pytest.approx(
        sigma, abs=1e-6 * sigma[0]
    )
    (message,) = free_in_words(result, problem.model.parameters, scale, ())
    if form != "alpha":
        assert message == "k1, k2, k3 and k4 can be scaled together"
    else:
        assert message == "k1, k2, k3 and k4 can scale the stiffness matrix as a whole"
        amounts = result[-1].direction * scale.unit
        assert amounts / amounts.max() == pytest.approx(k / k.max(), rel=1e-2)
    # What is claimed holds far away, in both directions.
    for factor in (0.7, 1.5):
        other = in_form(form, factor * k)
        assert residuals(problem, other, 1) == pytest.approx(residuals(problem, theta, 1), abs=1e-9)


@pytest.mark.parametrize("form", FORMS)
def test_frequencies_and_all_data_determine_all_in_every_form(form: str) -> None:
    problem = problem_of(form)
    text = [str(each) for each in determined(problem, problem.evaluate(problem.start))[0]]
    assert text[0] == "group frequencies determines 4 of 4 combinations of parameters"
    assert text[2] == "all data determine 4 of 4 combinations of parameters"


@pytest.mark.parametrize("form", FORMS)
def test_two_springs_in_series_are_said_as_a_pair(form: str) -> None:
    """A joint without mass between springs 1 and 2: only 1/k1 + 1/k2 matters."""
    problem = problem_of(form, masses=[0.0, 2.0, 2.0, 2.0], sensors=[1, 2, 3])
    theta = in_form(form, np.array([2.0, 0.8, 1.0, 1.1]))
    scale = scale_at(problem, theta)
    for group in (0, 1, None):
        result = combinations(problem, problem.evaluate(theta), group, scale=scale)
        message = free_in_words(result, problem.model.parameters, scale, ())
        assert "k1 and k2 cannot be told apart" in message
    for k1 in (1.6, 2.5):
        other = in_form(form, np.array([k1, 1 / (1 / 2.0 + 1 / 0.8 - 1 / k1), 1.0, 1.1]))
        for group in (0, 1):
            assert residuals(problem, other, group) == pytest.approx(
                residuals(problem, theta, group), abs=1e-9
            )


@pytest.mark.parametrize("form", FORMS)
def test_null_directions_of_few_data_hold_in_both_directions(form: str) -> None:
    """12 storeys, 4 modes at every second one: frequencies leave 8 combinations, and say 3."""
    n = 12
    problem = problem_of(form, n, sensors=range(1, n, 2), modes=4, lower=0.5, upper=2.0)
    theta = in_form(form, np.random.default_rng(2).uniform(0.8, 1.3, n))
    scale = scale_at(problem, theta)
    result = combinations(problem, problem.evaluate(theta), 0, scale=scale)
    free = np.array([combination.direction for combination in result if combination.share <= 1e-7])
    assert len(free) == 8
    sigma = np.linalg.svd(by_differences(problem, theta, 0), compute_uv=False)
    assert [combination.sensitivity for combination in result[:4]] == pytest.approx(sigma, rel=1e-5)
    here = residuals(problem, theta, 0)
    for v in free:
        for h in (1e-3, -1e-3):
            other = residuals(problem, theta + h * scale.unit * v, 0)
            assert np.abs(other - here).max() < 10 * h**2, "to first order"
    of = Determination(scale, [], [("frequencies", result)], np.eye(n))
    text = str(next(summaries(problem, of)))
    assert text.startswith("group frequencies determines 4 of 12 combinations of parameters; ")
    assert text.endswith("; and 5 more: no frequency changes")
    assert "any value" not in text


def idle_problem() -> mf.UpdatingProblem:
    """Three masses, and a fourth one far away with a spring of its own that no sensor sees."""
    springs = [np.zeros((4, 4)) for _ in range(4)]
    for i in range(3):
        springs[i][:3, :3] = spring(3, i)
    springs[3][3, 3] = 1e4
    return problem_of("k", springs=springs, sensors=range(3), modes=3)


def test_a_parameter_without_effect_is_said_once_and_is_like_no_other() -> None:
    problem = idle_problem()
    evaluation = problem.evaluate(problem.start)
    scale = scale_at(problem, problem.start)
    assert without_effect(problem, evaluation, scale) == [3]
    for k4 in (0.3, 4.0):
        other = np.array([1.0, 1.0, 1.0, k4])
        for group in (0, 1):
            assert (
                residuals(problem, other, group) == residuals(problem, evaluation.theta, group)
            ).all()
    text = tuple(map(str, determined(problem, evaluation)[0]))
    assert text == (
        "group frequencies determines 3 of 3 combinations of parameters that have an effect",
        "group shapes determines 2 of 3 combinations of parameters that have an effect; "
        "k1, k2 and k3 can be scaled together: no shape changes",
        "all data determine 3 of 3 combinations of parameters that have an effect",
    )
    H = evaluation.H.sum(axis=0) / 2
    noise = 1e-30 * np.ones((4, 4))
    assert alike(H + noise, problem.model.parameters, [3]) == []


def test_many_parameters_alike_are_said_at_once() -> None:
    names = tuple("abcdef")
    gram = np.ones((6, 6))
    gram[5, :5] = gram[:5, 5] = 0.0
    (message,) = alike(gram, names)
    assert str(message).startswith("a, b, c, d and e have nearly the same effect on all residuals")
    assert len(alike(gram[:4, :4][1:, 1:], names)) == 3


def test_a_group_that_no_parameter_changes_is_refused() -> None:
    """All springs of one parameter: shapes do not change; one sensor: a shape says nothing."""
    springs = [sum((spring(3, i) for i in range(3)), np.zeros((3, 3)))]
    single = problem_of("k", 3, springs=springs)
    assert unchanged_groups(single) == [1]
    with pytest.raises(mf.InputError, match=r"'shapes'.*no parameter changes them") as caught:
        refuse_unchanged_groups(single, "study.toml", unchanged_groups(single))
    assert "single sensor" not in str(caught.value)
    one_sensor = problem_of("k", 3, sensors=[2])
    assert unchanged_groups(one_sensor) == [1]
    with pytest.raises(mf.InputError, match="a single sensor fits any model"):
        mf.solve(one_sensor)
    assert unchanged_groups(problem_of("alpha", 3)) == []


def test_a_derivative_that_vanishes_for_symmetry_is_no_reason_to_refuse() -> None:
    """A beam of two equal springs around its middle: the shape's slope is even in k1 - k2."""
    A = np.array([[2.0, -1.0], [-1.0, 2.0]])
    tilt = np.diag([1.0, -1.0])
    model = mf.matrices(["x"], {"base": A, "x": tilt}, {"base": np.eye(2)}, {"a": 0, "b": 1})
    modes = model.modes(np.zeros(1), 2)
    data = mf.modal_data(modes.frequency, modes.phi.T, model.sensors)
    groups = [mf.Group("frequencies", frequency="all")]
    problem = mf.updating_problem(model, data, groups, {"x": (-0.5, 0.5)}, {"x": 0.0})
    assert np.abs(problem.evaluate(problem.start).H).max() < 1e-20
    assert unchanged_groups(problem) == []


def test_rounding_determines_nothing() -> None:
    springs = [sum((spring(3, i) for i in range(3)), np.zeros((3, 3)))]
    problem = problem_of("k", 3, springs=springs)
    evaluation = problem.evaluate(problem.start)
    for result in (
        combinations(problem, problem.evaluate(problem.start), 1),
        combinations(problem, evaluation, 1),
    ):
        assert [combination.share for combination in result] == [0.0]


def test_a_base_that_stays_leaves_no_scaling_of_the_stiffness() -> None:
    problem = problem_of("k")
    model = problem.model
    assert isinstance(model, MatrixModel)
    fixed = mf.matrices(
        ["k1"], {"base": spring(2, 0), "k1": spring(2, 1)}, {"base": np.eye(2)}, {"f": 0}
    )
    assert Scale(np.ones(1), np.ones(1), np.ones(1, dtype=bool), fixed).scalings == {}
    both = mf.chain(
        ("k", "m"),
        [1.0, 2.0],
        [1.0, 1.0],
        stiffness_parameters=["k"] * 2,
        mass_parameters=["m"] * 2,
    )
    theta = np.array([2.0, 3.0])
    result = Scale(theta, np.ones(2), np.ones(2, dtype=bool), both).scalings
    whole = "stiffness matrix and the mass matrix"
    assert list(result) == ["stiffness matrix", "mass matrix", whole]
    assert result[whole] == pytest.approx([2.0, 3.0])


def test_without_matrices_changes_are_over_the_range() -> None:
    class Opaque:
        """A model of which nothing but modes is known."""

        def __init__(self, model: MatrixModel) -> None:
            self._model = model

        def __getattr__(self, name: str) -> object:
            return self if name == "full" else getattr(self._model, name)

    problem = problem_of("alpha")
    assert isinstance(problem.model, MatrixModel)
    model: Any = Opaque(problem.model)
    opaque = replace(problem, model=model)
    scale = scale_at(opaque, opaque.start)
    assert scale.unit == pytest.approx(problem.upper - problem.lower)
    assert scale.scalings == {}
    result = combinations(opaque, opaque.evaluate(opaque.start), 1)
    text = free_in_words(result, problem.model.parameters, scale, ())
    assert text == ["k1, k2, k3 and k4 cannot be told apart"]
