"""Shapes with covariances: whitened residuals, exact derivatives, and what the scale leaves out."""

from dataclasses import replace
from typing import Literal

import numpy as np
import pytest

import modefront as mf
from modefront._typing import Floats
from modefront.data.modal import ModalData
from modefront.residuals.base import Scale
from modefront.residuals.groups import ModeNumbers
from modefront.uncertainty.noise import noise
from modefront.uncertainty.points import redraw
from modefront.uncertainty.prior import NoisePrior

NAMES = ("k1", "k2", "k3", "k4", "k5")
MODEL = mf.chain(NAMES, [1.0] * 5, [3e3] * 5, stiffness_parameters=NAMES)
THETA = np.array([1.1, 0.9, 1.2, 1.0, 0.95])


def covariances(phi: Floats, rng: np.random.Generator, size: float = 0.02) -> Floats:
    """Return covariances of shapes of unit norm, singular along them."""
    n = phi.shape[-1]
    half = size * rng.normal(size=(*phi.shape, n))
    u = phi / np.linalg.norm(phi, axis=-1, keepdims=True)
    half -= u[..., None] * (u[..., None, :] @ half)
    out: Floats = half @ half.swapaxes(-1, -2)
    return out


def measured(sets: int = 2, modes: int = 3) -> ModalData:
    """Data of some sets with a gap; the last shape of the last set has deviations alone."""
    rng = np.random.default_rng(1)
    true = MODEL.modes(np.ones(5), modes)
    phi = true.phi.T / np.linalg.norm(true.phi, axis=0)[:, None]
    phi = phi + 0.02 * rng.normal(size=(sets, modes, 5))
    C = covariances(phi, rng)
    std = np.sqrt(np.einsum("krss->krs", C))
    phi[0, 1, 4], C[-1, -1] = np.nan, np.nan
    f = np.tile(true.frequency, (sets, 1))
    data = mf.modal_data(f, phi, MODEL.sensors, frequency_std=0.01 * f, shape_std=std)
    return data.with_covariance(C)


def problem_of(
    data: ModalData, scale: Scale, kind: Literal["shape", "subspace"] = "shape"
) -> mf.UpdatingProblem:
    shapes: dict[str, ModeNumbers] = {kind: "all"}
    groups = [
        mf.Group("frequencies", frequency="all"),
        mf.Group("shapes", scale=scale, **shapes),
    ]
    bounds, nominal = dict.fromkeys(NAMES, (0.3, 3.0)), dict.fromkeys(NAMES, 1.0)
    return mf.updating_problem(MODEL, data, groups, bounds, nominal)


@pytest.mark.parametrize("kind", ["shape", "subspace"])
def test_derivatives_of_whitened_residuals_are_exact(kind: Literal["shape", "subspace"]) -> None:
    problem, h = problem_of(measured(), "std", kind), 1e-4
    found = problem.evaluate(THETA, second=True)
    assert found.exact
    for j, step in enumerate(np.eye(5)):
        ahead, behind, far, back = (
            problem.evaluate(THETA + s * h * step, second=True) for s in (1, -1, 2, -2)
        )
        dJ = (8 * (ahead.J - behind.J) - (far.J - back.J)) / (12 * h)
        H = (8 * (ahead.dJ - behind.dJ) - (far.dJ - back.dJ)) / (12 * h)
        np.testing.assert_allclose(found.dJ[:, j], dJ, rtol=1e-8, atol=1e-7)
        np.testing.assert_allclose(found.H[:, j], H, rtol=1e-7, atol=1e-6)


def test_residuals_at_the_truth_are_independent_with_a_variance_of_one() -> None:
    rng, true, K = np.random.default_rng(2), MODEL.modes(THETA, 3), 500
    u = true.phi.T / np.linalg.norm(true.phi, axis=0)[:, None]
    C = covariances(u, rng, 1e-3)
    size, axes = np.linalg.eigh(C)
    errors = np.sqrt(np.maximum(size, 0)) * rng.normal(size=(K, 3, 5))
    phi = u + np.einsum("rij,krj->kri", axes, errors)
    phi /= np.linalg.norm(phi, axis=2, keepdims=True)
    f, every = np.tile(true.frequency, (K, 1)), np.tile(C, (K, 1, 1, 1))
    problem = problem_of(mf.modal_data(f, phi, MODEL.sensors, shape_covariance=every), "std")
    r = problem.residuals(THETA)[1].r.reshape(3, K, 5) * np.sqrt(K)  # one unit a data set
    J = (r**2).sum(axis=2).ravel()
    assert np.mean(J) == pytest.approx(4.0, abs=4 * np.sqrt(8 / J.size))
    assert np.var(J) == pytest.approx(8.0, rel=0.25)
    assert problem.members[1][0].independent() == (4.0 * K, 0.0, 0.0)


def test_deviations_are_the_covariance_that_is_diagonal_and_normalisations_say_the_same() -> None:
    true, rng = MODEL.modes(THETA, 3), np.random.default_rng(3)
    phi = true.phi.T + 1e-4 * rng.normal(size=(3, 5))
    std = rng.uniform(0.5e-4, 2e-4, phi.shape)
    C = std[:, :, None] ** 2 * np.eye(5)
    # the greatest component is one: x = phi / phi_m, without errors at m
    m, rows = np.abs(phi).argmax(axis=1), np.arange(3)
    top = phi[rows, m]
    D = (np.eye(5) - (phi / top[:, None])[:, :, None] * np.eye(5)[m][:, None]) / top[:, None, None]
    x = phi / top[:, None]
    single = mf.modal_data(true.frequency, phi, MODEL.sensors, shape_std=std)
    whole = mf.modal_data(true.frequency, phi, MODEL.sensors, shape_covariance=C)
    scaled = D @ C @ D.swapaxes(1, 2)
    turned = mf.modal_data(true.frequency, -x, MODEL.sensors, shape_covariance=scaled)
    for r in range(1, 4):
        J = [
            replace(problem_of(data, "std"), groups=(mf.Group("one", shape=[r], scale="std"),))
            .evaluate(THETA, derivatives=False)
            .J[0]
            for data in (single, whole, turned)
        ]
        assert J[0] > 0.1
        np.testing.assert_allclose(J, J[0], rtol=1e-3)


@pytest.mark.parametrize("scale", ["measured", "std"])
def test_covariances_are_carried_to_objectives_by_their_roots(
    scale: Scale, monkeypatch: pytest.MonkeyPatch
) -> None:
    data = measured()
    places = {(k, r): np.flatnonzero(np.isfinite(data.shape[k, r])) for k, r in np.ndindex(2, 3)}
    known = {key: data.covariance_of(*key, sensors) for key, sensors in places.items()}
    monkeypatch.setattr(ModalData, "covariance_of", lambda _, k, r, __: known[k, r])  # a given unit
    problem, h = problem_of(data, scale), 1e-6
    found, changes = noise(problem, *problem.modes(THETA), "std"), []
    for (k, r), C in known.items():
        std = data.shape_std[k, r, places[k, r]]
        for column in (np.diag(std) if C is None else np.linalg.cholesky(C)).T:
            pair = []
            for sign in (h, -h):
                phi = data.shape.copy()
                phi[k, r, places[k, r]] += sign * column
                moved = replace(problem, data=replace(data, shape=phi))
                pair.append(moved.evaluate(THETA, derivatives=False).J[1])
            changes.append((pair[0] - pair[1]) / (2 * h))
    assert sum(C is None for C in known.values()) == 1
    own = found.J[found.J[:, 1] != 0, 1]  # after those of frequencies in each mode
    np.testing.assert_allclose(own, changes, rtol=1e-6, atol=1e-8)


@pytest.mark.parametrize("factor", [1.0, 30.0])
def test_errors_of_shapes_bound_those_of_whitened_objectives(factor: float) -> None:
    data = measured()
    assert data.shape_covariance is not None
    data = replace(
        data,
        shape=factor * data.shape,
        shape_std=factor * data.shape_std,
        shape_covariance=factor**2 * data.shape_covariance,
    )
    problem, worst = problem_of(data, "std"), np.zeros(3)
    for step in np.random.default_rng(7).normal(scale=1e-3, size=(20, 5)):
        (first, pairs), (two, _) = problem.modes(THETA), problem.modes(THETA + step)
        assert pairs.index.tolist() == [0, 1, 2]
        beta = np.einsum("sr,sr->r", two.phi, first.phi) / (two.phi**2).sum(axis=0)
        away = np.linalg.norm(two.phi * beta - first.phi, axis=0)
        shape = away / np.linalg.norm(first.phi, axis=0)
        for k in range(3):  # one shape a group: a margin is that of the shape whose error it is
            alone = replace(problem, groups=(mf.Group("one", shape=[k + 1], scale="std"),))
            (margin,) = alone.margins(np.zeros(3), shape)
            J = [alone.evaluate(x, derivatives=False).J[0] for x in (THETA, THETA + step)]
            worst[k] = max(worst[k], abs(np.sqrt(J[1]) - np.sqrt(J[0])) / margin)
    assert (worst < 1.05).all(), "of first order in the errors"
    assert (worst > 0.01).all(), "and no more than the greatest whitening"


def test_data_drawn_again_scatter_as_the_covariance_says() -> None:
    data, rng = measured(), np.random.default_rng(4)
    again = np.array([redraw(data, "std", rng).shape for _ in range(400)])
    for k, r, sensors in ((1, 0, np.arange(5)), (0, 1, np.arange(4))):
        C = data.covariance_of(k, r, sensors)
        assert C is not None
        np.testing.assert_allclose(np.cov(again[:, k, r, sensors].T), C, atol=0.25 * C.max())


def test_the_posterior_takes_covariances_of_deviations_only() -> None:
    problem = problem_of(measured(), "measured")
    noise = NoisePrior().of(problem, "std")
    assert noise is not None
    C = noise.problem.data.shape_covariance
    before = problem.data.shape_covariance
    assert C is not None
    assert before is not None
    np.testing.assert_allclose(C, before / 2)  # means become sums
    assert noise.a[1] == 3 + 5 * 4  # one less than the components of every shape
    other = NoisePrior().of(problem, "sets")
    assert other is not None
    assert other.problem.data.shape_covariance is None


def test_a_pair_may_turn_in_its_plane() -> None:
    data = replace(measured(1, 2), pairs=((1, 2),))
    rng = np.random.default_rng(5)
    plane = np.linalg.qr(data.shape[0, :, :4].T)[0]
    half = rng.normal(size=(4, 4))
    half -= plane @ (plane.T @ half)
    C = np.full((1, 2, 5, 5), np.nan)
    C[0, :, :4, :4] = 1e-4 * half @ half.T
    data.shape[:, :, 4] = np.nan
    bare = replace(data, shape_std=np.nan * data.shape_std)
    assert bare.with_covariance(C).shape_std[0, 0, 0] == pytest.approx(np.sqrt(C[0, 0, 0, 0]))
    with pytest.raises(mf.InputError, match="mode 1 in set '1': expected positive eigenvalues"):
        replace(bare, pairs=()).with_covariance(C)
