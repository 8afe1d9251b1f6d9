"""Second derivatives of objectives of finite-element models, against differences of gradients."""

from __future__ import annotations

from typing import NoReturn

import numpy as np
import pytest

from modefront import fem
from modefront._typing import Floats
from modefront.data.modal import ModalData, modal_data
from modefront.errors import ModelError
from modefront.linalg.affine import SparseAffine
from modefront.models.base import Model
from modefront.models.matrices import MatrixModel
from modefront.models.mesh import mesh_model
from modefront.models.reduced.model import ReducedModel
from modefront.models.reduced.options import Reduction
from modefront.modes import derivatives
from modefront.residuals.groups import Group
from modefront.residuals.problem import UpdatingProblem, updating_problem

GROUPS = (
    Group("frequencies", frequency="all"),
    Group("shapes", shape="all", scale="std"),
    Group("low modes", frequency=[1, 2], shape=[1, 3], scale="std"),
    Group("high modes", frequency=[3, 4], shape=[2, 4]),
)


def plate(n: int) -> MatrixModel:
    """Return a clamped plate whose thickness, modulus, density and spring are parameters."""
    X, cells = fem.grids.plate(3.0, 1.7, 2 * n, n)
    half = X[cells].mean(axis=1)[:, 0] > 1.5
    steel = fem.Material(E=210e9, nu=0.3, rho=7850.0)
    corner = int(np.argmax(X @ [1.0, 1.0, 0.0]))
    nodes = np.argsort(np.abs(X @ [1.0, 0.3, 0.0] - 2.0))[:5]
    structure = fem.Structure(
        X,
        [fem.Shells(name, cells[half == j], steel, 0.03) for j, name in enumerate("ab")],
        [fem.Support(np.flatnonzero(X[:, 0] == 0))],
        springs=[fem.Spring("k", [corner], 1e5, "z")],
        sensors=[fem.Sensor(f"s{i}", int(node), "z") for i, node in enumerate(nodes)],
        parameters=[
            fem.Parameter("E", "E", ("a",)),
            fem.Parameter("t", "thickness", ("b",)),
            fem.Parameter("rho", "density", ("a", "b")),
            fem.Parameter("k", "spring", ("k",)),
        ],
    )
    return mesh_model(structure, ["E", "t", "rho", "k"])


def measured(model: Model) -> ModalData:
    """Return two data sets with noise and gaps."""
    rng = np.random.default_rng(5)
    modes = model.modes(rng.uniform(0.85, 1.2, 4), 4, derivatives=False)
    f = modes.frequency * (1 + 0.02 * rng.normal(size=(2, 4)))
    shape = modes.phi.T / np.abs(modes.phi).max() + 0.03 * rng.normal(size=(2, 4, 5))
    f[0, 1] = shape[0, 2] = shape[1, 0, 3] = shape[1, 3, :2] = np.nan
    shape_std = np.where(np.isnan(shape), np.nan, 0.05)
    return modal_data(f, shape, model.sensors, frequency_std=0.01 * f, shape_std=shape_std)


def problem_with(model: Model) -> UpdatingProblem:
    names = model.parameters
    bounds, nominal = dict.fromkeys(names, (0.4, 2.5)), dict.fromkeys(names, 1.0)
    data, off = measured(model), Reduction("off")
    return updating_problem(model, data, GROUPS, bounds, nominal, reduction=off)


def differences(problem: UpdatingProblem, theta: Floats, h: float = 4e-3) -> Floats:
    """Return central differences of the gradients, extrapolated twice."""
    columns = []
    for step in np.eye(theta.size):

        def rate(size: float, step: Floats = step) -> Floats:
            ahead, behind = (problem.evaluate(theta + s * size * step) for s in (1, -1))
            assert (ahead.quantities["paired_mode"] == behind.quantities["paired_mode"]).all()
            return (ahead.dJ - behind.dJ) / (2 * size)

        columns.append((64 * rate(h / 4) - 20 * rate(h / 2) + rate(h)) / 45)
    return np.stack(columns, axis=2)


@pytest.mark.parametrize("kind", ["dense", "few modes", "sparse", "reduced", "reduced, few modes"])
def test_finite_element_models_agree_with_differences_of_gradients(kind: str) -> None:
    model: Model = plate({"dense": 2, "few modes": 3}.get(kind, 5))
    assert isinstance(model, MatrixModel)
    assert isinstance(model.stiffness, SparseAffine) == (kind not in ("dense", "few modes"))
    if kind.startswith("reduced"):
        wide = "few" in kind
        lower, upper = np.full(4, 0.4), np.full(4, 2.5)
        model = ReducedModel(model, 24 if wide else 10, np.ones(4), lower, upper)
        assert (model.columns >= 100) == wide
    problem = problem_with(model)
    theta = np.array([1.1, 0.92, 1.05, 0.8])
    plain, result = problem.evaluate(theta), problem.evaluate(theta, second=True)
    assert result.exact
    expected = differences(problem, theta)
    scale = np.abs(expected).max(axis=(1, 2))
    assert (np.abs(result.H - expected).max(axis=(1, 2)) <= 1e-6 * scale).all()
    assert (np.abs(plain.H - expected).max(axis=(1, 2)) > 1e-3 * scale).all()
    np.testing.assert_allclose(result.H, result.H.transpose(0, 2, 1), atol=1e-12 * scale.max())
    np.testing.assert_array_equal(result.dJ, plain.dJ)


def test_an_iteration_that_fails_leaves_those_of_gauss_newton(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def fail(*_: object) -> NoReturn:
        raise ModelError("the derivatives do not converge")

    problem = problem_with(plate(5))
    plain = problem.evaluate(problem.start)
    monkeypatch.setattr(derivatives, "everywhere", fail)
    result = problem.evaluate(problem.start, second=True)
    assert not result.exact
    np.testing.assert_array_equal(result.H, plain.H)
