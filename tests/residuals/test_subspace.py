"""Distances from spans of close modes: independent of a basis, with exact derivatives."""

import numpy as np
import pytest

import modefront as mf
from modefront._typing import Floats
from modefront.modes.result import Modes
from modefront.optim.scalarisation import weighted
from modefront.optim.sqp import begin, solve
from modefront.residuals.base import Scale
from modefront.residuals.groups import KINDS, Group
from modefront.residuals.shape import ShapeResiduals

NAMES = ("a", "b", "c")


def plate(theta: Floats, *, sets: int = 1, scale: Scale = "measured") -> mf.UpdatingProblem:
    """Return two equal branches on a base, of which modes come in close pairs, with errors."""
    K = [np.zeros((5, 5)) for _ in NAMES]
    for i, j, part in ((0, 1, 0), (1, 2, 1), (0, 3, 0), (3, 4, 2)):
        v = np.zeros(5)
        v[i], v[j] = 1.0, -1.0
        K[part] += 1e4 * np.outer(v, v)
    base = 3e4 * np.diag(np.eye(5)[0])
    places = {f"s{i}": i for i in range(5)}
    model = mf.matrices(
        NAMES, {"base": base, **dict(zip(NAMES, K, strict=True))}, {"base": np.eye(5)}, places
    )
    true = model.modes(theta, 4)
    rng = np.random.default_rng(3)
    shape = true.phi.T + 0.02 * rng.normal(size=(sets, 4, 5))
    std = np.full(shape.shape, 0.02) if scale == "std" else None
    data = mf.modal_data(np.tile(true.frequency, (sets, 1)), shape, model.sensors, shape_std=std)
    groups = [Group("pairs", subspace=[1, 2], scale=scale), Group("f", frequency="all")]
    parameters = [mf.Parameter(x, nominal=1.0, bounds=(0.3, 3.0)) for x in NAMES]
    return mf.updating_problem(model, data, groups, parameters=parameters)


@pytest.mark.parametrize("scale", ["measured", "std"])
def test_derivatives_are_those_of_differences(scale: Scale) -> None:
    problem = plate(np.array([1.0, 1.1, 0.9]), sets=2, scale=scale)
    theta = np.array([1.2, 0.9, 1.3])
    found, h = problem.evaluate(theta, second=True), 1e-5
    assert found.exact
    for j in range(3):
        step = h * np.eye(3)[j]
        ahead, behind = (problem.evaluate(theta + s * step, second=True) for s in (1, -1))
        slope = (ahead.J - behind.J) / (2 * h)
        assert found.dJ[:, j] == pytest.approx(slope, rel=1e-7, abs=1e-8 * found.J.max())
        bent = (ahead.dJ - behind.dJ) / (2 * h)
        assert found.H[:, j] == pytest.approx(bent, rel=1e-5, abs=1e-6 * np.abs(found.H).max())
        rows = (ahead.residuals[0].r - behind.residuals[0].r) / (2 * h)
        assert found.residuals[0].dr[:, j] == pytest.approx(rows, rel=1e-6, abs=1e-7)


def test_the_residuals_are_those_of_any_basis() -> None:
    problem = plate(np.array([1.0, 1.1, 0.9]))
    modes, pairs = problem.modes(np.array([1.2, 0.9, 1.3]), derivatives=False)
    turned = modes.phi.copy()
    c, s = np.cos(0.7), np.sin(0.7)
    turned[:, pairs.index[:2]] = turned[:, pairs.index[:2]] @ np.array([[c, -s], [s, c]])
    stack = KINDS["subspace"].stack(problem.data, (0, 1), "measured")
    r = stack.r(modes, pairs)
    assert stack.r(Modes(modes.lam, turned), pairs) == pytest.approx(r, abs=1e-13)
    for shape, part in zip(problem.data.shape[0], np.split(r, 2), strict=False):
        weight = np.sqrt(shape.size) / np.linalg.norm(shape)
        psi, X = weight * shape, weight * modes.phi[:, pairs.index[:2]]
        assert X.T @ part == pytest.approx(np.zeros(2), abs=1e-12)
        assert part @ part == pytest.approx(np.linalg.lstsq(X, psi)[1][0])


def test_a_span_of_one_mode_is_a_shape() -> None:
    problem = plate(np.array([1.0, 1.1, 0.9]))
    modes, pairs = problem.modes(np.array([1.2, 0.9, 1.3]))
    (one,) = Group("x", subspace=[1]).stacks(problem.data)
    (shape,) = Group("x", shape=[1]).stacks(problem.data)
    for a, b in zip(one.with_slopes(modes, pairs), shape.with_slopes(modes, pairs), strict=True):
        assert a == pytest.approx(b, abs=1e-12)


def test_models_of_repeated_modes_are_found() -> None:
    """A tower that sways alike in x and y has repeated modes, whose shapes are any basis."""
    K = {name: np.zeros((6, 6)) for name in NAMES}
    for axis, first in ((0, "a"), (3, "b")):
        K[first][axis, axis] = 1e4
        for i in (axis + 1, axis + 2):
            v = np.zeros(6)
            v[i], v[i - 1] = 1.0, -1.0
            K["c"] += 1e4 * np.outer(v, v)
    places = {f"s{i}": i for i in range(6)}
    model = mf.matrices(NAMES, K, {"base": np.eye(6)}, places)
    truth = np.array([0.8, 0.8, 1.2])
    modes = model.modes(truth, 4)
    turn = np.array([[np.cos(0.6), np.sin(0.6)], [-np.sin(0.6), np.cos(0.6)]])
    shape = np.kron(np.eye(2), turn) @ modes.phi.T
    groups = [
        Group("first", subspace=[1, 2]),
        Group("second", subspace=[3, 4]),
        Group("f", frequency="all"),
    ]
    problem = mf.updating_problem(
        model,
        mf.modal_data(modes.frequency, shape, model.sensors),
        groups,
        parameters=[mf.Parameter(x, nominal=1.0, bounds=(0.3, 3.0)) for x in NAMES],
    )
    assert problem.evaluate(truth).J == pytest.approx(np.zeros(3), abs=1e-16)
    start = begin(problem.evaluate(np.array([1.1, 0.9, 1.0]), second=True))
    found = solve(problem, weighted(np.ones(3)), start)
    assert found.theta == pytest.approx(truth, abs=1e-4)
    assert found.evaluations < 25


def test_as_many_sensors_as_modes_fit_any_model() -> None:
    data = mf.modal_data(np.ones(2), np.ones((2, 2)), ("x", "y"))
    assert "2 sensors for as many modes" in ShapeResiduals(data, [0], "measured", (0, 1)).remark
    assert ShapeResiduals(data, [0], "measured").remark == ""
