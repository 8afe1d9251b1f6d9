"""Reduced models: exact in their basis, and as wrong in the full one as they say."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg
import scipy.sparse

from modefront import fem
from modefront._typing import Floats, Ints
from modefront.errors import ModelError
from modefront.linalg.affine import Monomials, sparse_affine
from modefront.linalg.factorisation import SingularMatrixError
from modefront.models.matrices import MatrixModel, matrices
from modefront.models.mesh import mesh_model
from modefront.models.reduced.basis import certificate_of
from modefront.models.reduced.model import ReducedModel, SnapshotRequest
from modefront.modes import derivatives as exact
from modefront.modes.sparse import lowest
from modefront.work.task import Costs, counted, uncounted

STEEL = fem.Material(E=210e9, nu=0.3, rho=7850.0)
NAMES = ("k1", "k2", "k3")
COUNT = 4
LOWER, UPPER = np.full(3, 0.4), np.full(3, 2.5)


def plate(*, floating: bool = False, n: int = 6) -> MatrixModel:
    """Return a plate with three stiffnesses, clamped at an edge or free, without double modes."""
    X, cells = fem.grids.plate(3.0, 1.7, 2 * n, n)
    region = np.minimum((X[cells].mean(axis=1)[:, 0]).astype(int), 2)
    sensors = [fem.Sensor(f"s{i}", int(node), "z") for i, node in enumerate((9, 40, 63, 90))]
    structure = fem.Structure(
        X,
        [fem.Shells(name, cells[region == j], STEEL, 0.03) for j, name in enumerate(NAMES)],
        [] if floating else [fem.Support(np.flatnonzero(X[:, 0] == 0))],
        sensors=sensors,
        parameters=[fem.Parameter(name, "E", (name,)) for name in NAMES],
    )
    return mesh_model(structure, NAMES, floating=floating)


def massless(full: MatrixModel) -> MatrixModel:
    """Return the model without the inertia of every second degree of freedom."""
    keep = scipy.sparse.dia_array(
        ((np.arange(full.size) % 2 == 0).astype(float)[None], 0), shape=(full.size, full.size)
    )
    mass = (keep @ full.pencil.M.at(np.ones(3)) @ keep).tocoo()
    constant = Monomials(np.zeros((1, 3)))
    return replace(full, mass=sparse_affine([mass], constant, full.size))


MODELS: dict[str, Callable[[], MatrixModel]] = {
    "clamped": plate,
    "rigid-body modes": lambda: plate(floating=True),
    "massless": lambda: massless(plate()),
}


@pytest.fixture(scope="module", params=MODELS)
def full(request: pytest.FixtureRequest) -> MatrixModel:
    return MODELS[str(request.param)]()


def reduced(full: MatrixModel, *, tolerance: float = 1e-8, memory: float = 1.0) -> ReducedModel:
    return ReducedModel(full, 10, np.ones(3), LOWER, UPPER, tolerance, memory)


def elastic(lam: Floats) -> Ints:
    """Return the positions of some modes that are no rigid-body modes."""
    return np.flatnonzero(lam > 1e-6 * lam[-1])[:COUNT]


def test_derivatives_everywhere_are_those_at_the_sensors(full: MatrixModel) -> None:
    theta = np.array([1.1, 0.9, 1.3])
    result = lowest(full.pencil, theta, 8)
    everywhere = scipy.sparse.eye_array(full.size, format="csr")
    _, dPhi, _ = exact.at_sensors(everywhere, result, 8)
    expected = full.modes(theta, 8)
    at_sensors = np.tensordot(full.selection.toarray(), dPhi, axes=1)
    assert at_sensors == pytest.approx(expected.dphi, abs=1e-8 * np.abs(expected.dphi).max())


def test_the_basis_is_orthonormal_in_energy_and_grows_without_change(full: MatrixModel) -> None:
    model = reduced(full)
    model.modes(np.ones(3), 8)
    before = model.basis
    model.take(SnapshotRequest(np.array([0.6, 1.5, 2.0]), 10))
    basis = model.basis
    n = before.columns
    assert basis.columns > n
    assert all(map(np.array_equal, basis.blocks, before.blocks))
    assert np.array_equal(basis.K.terms[:, :n, :n], before.K.terms)
    V = np.hstack(basis.blocks)
    A = full.pencil.K.at(basis.theta) - basis.sigma * full.pencil.M.at(basis.theta)
    assert V.T @ (A @ V) == pytest.approx(np.eye(basis.columns), abs=1e-8)
    theta = np.array([0.8, 0.7, 2.2])
    for matrix, projected in ((full.pencil.K, basis.K), (full.pencil.M, basis.M)):
        expected = V.T @ (matrix.at(theta) @ V)
        assert projected.at(theta) == pytest.approx(expected, abs=1e-9 * np.abs(expected).max())


def test_a_snapshot_is_exact_with_its_derivatives(full: MatrixModel) -> None:
    model, theta = reduced(full), np.array([0.7, 1.4, 2.1])
    model.take(SnapshotRequest(theta, 10))
    result, expected = model.modes(theta, 8), full.modes(theta, 8)
    r = elastic(expected.lam)
    assert result.lam[r] == pytest.approx(expected.lam[r], rel=1e-9)
    assert result.dlam[r] == pytest.approx(
        expected.dlam[r], rel=1e-6, abs=1e-8 * expected.lam[r[-1]]
    )
    sign = np.sign((result.phi * expected.phi).sum(axis=0))[r]
    scale = np.abs(expected.phi[:, r]).max()
    assert result.phi[:, r] * sign == pytest.approx(expected.phi[:, r], abs=1e-6 * scale)
    error = np.abs(result.dphi[:, r] * sign[:, None] - expected.dphi[:, r]).max()
    assert error <= 0.1 * np.abs(expected.dphi[:, r]).max()


def test_a_space_of_modes_has_these_and_is_smaller(full: MatrixModel) -> None:
    model, thetas = reduced(full), np.random.default_rng(4).uniform(0.5, 2.3, (6, 3))
    model.take(SnapshotRequest(np.array([1.4, 0.7, 2.1]), 10))
    V = model.space(thetas, 8, 3e-3)
    assert V.shape[0] == model.columns
    assert V.shape[1] < 0.8 * model.columns
    alike = model.space(np.tile(thetas[0], (2, 1)), 8, 3e-3)
    assert alike.shape[1] == model.count, "modes that are the same span all that are asked for"
    sent = pickle.loads(pickle.dumps(model.within(V)))
    for theta in thetas:
        result, expected = sent.modes(theta, 8), model.modes(theta, 8)
        r = elastic(expected.lam)
        assert result.lam[r] == pytest.approx(expected.lam[r], rel=1e-4)
        size = np.abs(expected.phi[:, r]).max()
        assert np.abs(result.phi[:, r]) == pytest.approx(
            np.abs(expected.phi[:, r]), abs=0.02 * size
        )


def test_derivatives_are_those_of_the_reduced_problem(full: MatrixModel) -> None:
    model, theta, h = reduced(full), np.array([0.7, 1.4, 2.1]), 1e-3
    result = model.modes(theta, 8)
    r = elastic(result.lam)
    for i, step in enumerate(h * np.eye(3)):
        near = {k: model.modes(theta + k * step, 8, derivatives=False).lam for k in (-2, -1, 1, 2)}
        slope = (8 * (near[1] - near[-1]) - near[2] + near[-2]) / (12 * h)
        assert result.dlam[r, i] == pytest.approx(slope[r], rel=1e-7, abs=1e-9 * result.lam[r[-1]])


@pytest.mark.parametrize("snapshots", [1, 3])
def test_errors_are_what_the_certificate_says(full: MatrixModel, snapshots: int) -> None:
    rng = np.random.default_rng(5)
    model = reduced(full)
    model.modes(np.ones(3), 8)
    for _ in range(snapshots - 1):
        model.take(SnapshotRequest(rng.uniform(0.5, 2.3, 3), 10))
    for theta in rng.uniform(0.5, 2.3, (3, 3)):
        exact_modes, result = lowest(full.pencil, theta, 8), model.modes(theta, 8)
        r = elastic(result.lam)
        certificate = certificate_of(model.basis, theta, r)
        shift = model.basis.sigma
        noise = 1e2 * exact_modes.noise[r] / exact_modes.lam[r]
        truth = (result.lam[r] - exact_modes.lam[r]) / (result.lam[r] - shift)
        sure = truth > 10 * noise
        assert (certificate.eigenvalue[sure] <= 2 * truth[sure]).all()
        assert (certificate.eigenvalue[sure] >= truth[sure] / 2).all()

        basis = model.basis
        K, M = basis.K.at(theta), basis.M.at(theta)
        vectors = basis.combine(scipy.linalg.eigh(M, K + 1e-3 * M)[1][:, ::-1][:, r])
        MPhi = exact_modes.MPhi[:, r]
        size = np.einsum("nr,nr->r", vectors, full.pencil.M.at(theta) @ vectors)
        cosine = np.einsum("nr,nr->r", vectors, MPhi) ** 2 / size
        shape = np.sqrt(np.maximum(1 / cosine - 1, 0))
        sure = shape > 1e-6
        assert (certificate.shape[sure] <= 2 * shape[sure]).all()
        assert (certificate.shape[sure] >= shape[sure] / 2).all()


def test_costs_are_counted_once(costs: Costs) -> None:
    model = reduced(plate())

    def cost() -> tuple[int, ...]:
        return costs.eigenproblems, costs.factorisations, costs.corrected, costs.reduced

    for _ in range(3):
        model.modes(np.ones(3), 8)
    assert cost() == (1, 2, 6, 3), "one solution in full, and one at each bound with its factor"
    model.take(SnapshotRequest(np.array([0.5, 1.0, 2.0]), 10))
    assert cost() == (1, 3, 7, 3), "a factor tells that the basis misses none of ten modes"
    model.take(SnapshotRequest(np.array([0.95, 1.0, 1.05]), 6))
    assert cost() == (1, 4, 8, 3)
    model.take(SnapshotRequest(np.array([2.2, 0.5, 0.7]), 6, 1e-12))
    assert cost() == (1, 4, 9, 3), "the first factor is enough where modes may be missing"
    model.modes(np.ones(3), 11)
    assert cost() == (2, 6, 9, 3)
    model.snapshots = (SnapshotRequest(np.ones(3), 10),)
    model.modes(np.ones(3), 8)
    assert cost() == (2, 6, 9, 4)
    model.snapshots = ()
    assert cost() == (2, 6, 9, 4)
    model.modes(np.ones(3), 8)
    assert cost() == (3, 8, 15, 5), "what the basis of the first snapshot has cost is counted again"


def truth(model: ReducedModel, thetas: Floats) -> Floats:
    """Return the greatest relative error of six eigenvalues at each of some parameters."""
    with uncounted():
        pairs = [(model.modes(x, 6).lam, model.full.modes(x, 6).lam) for x in thetas]
    return np.array([np.max(result / expected - 1) for result, expected in pairs])


def test_a_snapshot_of_several_models_is_exact_at_each(costs: Costs) -> None:
    full = plate()
    model, thetas = reduced(full), np.array([[0.5, 1.0, 2.0], [2.4, 0.5, 0.6], [2.4, 2.0, 1.0]])
    model.modes(np.ones(3), 8)
    before = costs.corrected
    errors, off = truth(model, thetas), []
    model.take(SnapshotRequest(thetas, 6))
    assert costs.corrected == before + 3
    assert costs.eigenproblems == 1
    for theta in thetas:
        result, expected = model.modes(theta, 6), full.modes(theta, 6)
        assert result.lam == pytest.approx(expected.lam, rel=1e-9)
        sign = np.sign((result.phi * expected.phi).sum(axis=0))
        off.append(np.abs(result.dphi * sign[:, None] - expected.dphi).max())
        off[-1] /= np.abs(expected.dphi).max()
    assert np.argmin(off) == np.argmax(errors), "the worst one has its derivatives"
    assert min(off) < 1e-3
    assert max(off) < 0.2


def test_a_snapshot_leaves_models_as_they_are_that_are_good_enough(costs: Costs) -> None:
    full = plate()
    model, thetas = reduced(full), np.array([[0.5, 1.0, 2.0], [1.25, 0.85, 1.0], [2.4, 2.0, 1.0]])
    model.modes(np.ones(3), 8)
    errors = truth(model, thetas)
    assert 1e-9 < errors[1] < 0.2 * errors[[0, 2]].min()
    middle = float(np.sqrt(errors[1] * errors[[0, 2]].min()))
    corrected, columns = costs.corrected, model.columns
    result = model.take(SnapshotRequest(thetas, 6, middle))
    assert 0.5 * errors.max() <= result <= errors.max() * (1 + 1e-6)
    assert costs.corrected == corrected + 2
    after = truth(model, thetas)
    assert after[[0, 2]].max() < 1e-9
    assert after[1] > 1e-10
    assert model.columns > columns
    columns = model.columns
    assert 0.5 * after.max() <= model.take(SnapshotRequest(thetas, 6, 2 * after[1])) < 2 * after[1]
    assert (costs.corrected, model.columns) == (corrected + 2, columns)


def test_models_too_far_for_the_factor_are_solved_in_full_and_the_others_are_not(
    costs: Costs,
) -> None:
    full = plate()
    bounds = np.full(3, 0.01), np.full(3, 2.5)
    model = ReducedModel(full, 10, np.ones(3), *bounds)
    model.modes(np.ones(3), 8)
    corrected, far = costs.corrected, np.array([0.015, 2.0, 2.0])
    before = model.modes(far, 6).lam
    error = model.take(SnapshotRequest(np.array([far, [0.9, 1.1, 1.0]]), 6))
    assert costs.eigenproblems == 2
    assert costs.corrected == corrected + 1
    exact = full.modes(far, 6).lam
    assert error == pytest.approx(((before - exact) / (exact - model.basis.sigma)).max(), rel=1e-3)
    assert error > 1e-6, "of a model that is solved in full, it is known"
    for theta in ([0.015, 2.0, 2.0], [0.9, 1.1, 1.0]):
        point = np.array(theta)
        assert model.modes(point, 6).lam == pytest.approx(full.modes(point, 6).lam, rel=1e-8)


def test_what_takes_too_many_steps_is_solved_in_full_where_it_must_be_exact(
    monkeypatch: pytest.MonkeyPatch,
    costs: Costs,
) -> None:
    monkeypatch.setattr("modefront.models.reduced.basis.STEPS", 1)
    full, corner = plate(), np.array([0.4, 2.5, 0.4])
    model = reduced(full)
    model.modes(np.ones(3), 8)
    assert costs.eigenproblems == 1, "modes at the bounds are kept as far as they came"
    assert model.columns > 12 + 3 * 10
    model.take(SnapshotRequest(corner, 8))
    assert costs.eigenproblems == 2
    assert model.modes(corner, 8).lam == pytest.approx(full.modes(corner, 8).lam, rel=1e-9)


def test_the_order_of_computing_snapshots_changes_no_digit(costs: Costs) -> None:
    full, thetas = plate(), [np.ones(3), np.array([0.5, 1.0, 2.0])]
    first, other = reduced(full), reduced(plate())
    with uncounted():
        for theta in thetas:
            first.take(SnapshotRequest(theta, 10))
    other.snapshots = tuple(SnapshotRequest(theta, 10) for theta in thetas)
    point = np.array([0.9, 0.6, 1.4])
    assert first.modes(point, 8).lam.tolist() == other.modes(point, 8).lam.tolist()
    assert costs.eigenproblems == 0, "what was counted before is not counted again"


def test_the_basis_keeps_within_its_memory() -> None:
    full = plate()
    model = reduced(full, memory=20 * 8 * full.size / 2**30)
    assert model.capacity == 20
    model.modes(np.ones(3), 8)
    assert model.columns == 20
    model.take(SnapshotRequest(np.array([0.5, 1.0, 2.0]), 10))
    assert model.columns == 20


def test_a_single_mode_is_a_basis_where_there_is_no_room_for_more() -> None:
    model = ReducedModel(plate(), 1, np.ones(3), LOWER, UPPER, memory=1e-9)
    model.take(SnapshotRequest(np.ones(3), 1))
    model.take(SnapshotRequest(np.array([0.9, 1.0, 1.1]), 1))
    assert model.columns == 1
    result, expected = model.modes(np.ones(3), 1), model.full.modes(np.ones(3), 1)
    assert result.lam == pytest.approx(expected.lam, rel=1e-9)


def test_a_snapshot_that_fails_leaves_the_model_as_it_was(costs: Costs) -> None:
    model = reduced(plate())
    before = model.modes(np.ones(3), 8).lam
    with pytest.raises(ModelError):
        model.take(SnapshotRequest(np.array([1.0, 1.0, -1.0]), 10))
    assert model.modes(np.ones(3), 8).lam.tolist() == before.tolist()
    assert costs.eigenproblems == 1


def two_structures() -> MatrixModel:
    """Return two chains that nothing joins: as k1 falls, modes of the first enter from above."""
    size = 400
    half = size // 2
    chain = 2 * np.eye(half) - np.eye(half, k=1) - np.eye(half, k=-1)
    K = [np.zeros((size, size)) for _ in range(2)]
    K[0][:half, :half] = 400 * chain
    K[1][half:, half:] = chain + 0.01 * np.diag(np.linspace(0, 1, half))
    selection = scipy.sparse.csr_array(np.eye(size)[[20, 250]])
    return MatrixModel(
        ("k1", "k2"),
        ("a", "b"),
        selection,
        sparse_affine(list(map(scipy.sparse.coo_array, K)), Monomials(np.eye(2)), size),
        sparse_affine([scipy.sparse.eye_array(size)], Monomials(np.zeros((1, 2))), size),
    ).compact()


def test_a_mode_that_the_basis_misses_is_found_by_inertia(costs: Costs) -> None:
    full = two_structures()
    bounds = np.full(2, 1e-4), np.full(2, 2.0)
    model = ReducedModel(full, 4, np.ones(2), *bounds)
    near = certificate_of(model.basis, np.array([0.99, 1.0]), np.arange(3))
    assert near.eigenvalue.max() < 1e-3
    assert costs.factorisations == 3, "one tells how many modes there are, and their errors"
    theta = np.array([1e-4, 1.0])
    with uncounted():
        assert model.modes(theta, 4).lam[0] > 1.5 * full.modes(theta, 4).lam[0]
    first, other = (certificate_of(model.basis, x, np.arange(3)) for x in (np.ones(2), theta))
    assert np.isfinite(first.eigenvalue).all()
    assert np.isinf(other.eigenvalue).all()
    assert costs.factorisations == 5
    alone = certificate_of(model.basis, theta, np.arange(3))
    assert np.isinf(alone.eigenvalue).all()
    model.take(SnapshotRequest(theta, 10))
    known = certificate_of(model.basis, theta, np.arange(3))
    assert known.eigenvalue.max() < 1e-8


def test_a_certificate_is_an_upper_bound_and_infinite_where_nothing_is_proved(
    monkeypatch: pytest.MonkeyPatch,
    costs: Costs,
) -> None:
    full = plate()
    bounds = np.full(3, 0.05), np.full(3, 2.5)
    model = ReducedModel(full, 10, np.ones(3), *bounds)
    theta, requested = np.array([1.0, 0.2, 2.4]), np.arange(6)
    lam, exact = model.modes(theta, 6).lam, full.modes(theta, 6).lam
    factorisations = costs.factorisations
    certificate = certificate_of(model.basis, theta, requested)
    assert costs.factorisations == factorisations + 1
    truth = lam / exact - 1
    assert truth.max() > 1e-6
    assert (certificate.eigenvalue >= truth * (1 - 1e-6)).all()
    assert (certificate.eigenvalue <= 2 * truth).all()
    better = certificate.lam[requested]
    assert (np.abs(better / exact - 1) <= truth).all()

    def singular(*_: object) -> None:
        raise SingularMatrixError("pivot of zero")

    monkeypatch.setattr("modefront.linalg.factorisation.Pencil.factor", singular)
    unknown = certificate_of(model.basis, theta, requested)
    assert np.isinf(unknown.eigenvalue).all(), "no number is better than a wrong one"


def square(power: float) -> MatrixModel:
    """Return a square grid of springs with pairs of close modes, stiffnesses k1 and k2^power."""
    n = 15
    D = np.eye(n) - np.eye(n, k=-1)
    line, unit = D.T @ D, np.eye(n)
    terms = [
        scipy.sparse.coo_array(np.kron(line, unit)),
        scipy.sparse.coo_array(np.kron(unit, line)),
    ]
    return MatrixModel(
        ("k1", "k2"),
        ("s",),
        scipy.sparse.csr_array(np.eye(1, n * n)),
        sparse_affine(terms, Monomials(np.diag([1.0, power])), n * n),
        sparse_affine([scipy.sparse.eye_array(n * n)], Monomials(np.zeros((1, 2))), n * n),
    ).compact()


@pytest.mark.parametrize("power", [1.0, 3.0, -1.0])
def test_certificates_hold_for_close_modes_and_powers(power: float) -> None:
    full = square(power)
    model = ReducedModel(full, 8, np.ones(2), np.full(2, 0.5), np.full(2, 2.0), spare=3)
    reported = 0
    for theta in ([1.0, 1.0], [1.0, 1.0 + 1e-7], [1.0, 1.001], [0.7, 1.3], [1.8, 0.6]):
        certificate = certificate_of(model.basis, np.array(theta), np.arange(5))
        exact = full.modes(np.array(theta), 5, derivatives=False).lam
        truth = model.modes(np.array(theta), 5, derivatives=False).lam / exact - 1
        assert (certificate.eigenvalue >= truth * (1 - 1e-6) - 1e-13).all()
        reported += int(np.isfinite(certificate.eigenvalue).sum())
    assert reported >= 20


def extended_quotients(K: Floats, M: Floats, X: Floats) -> Floats:
    """Return the Rayleigh quotient of each column of X, in extended precision."""
    k, m, x = (A.astype(np.longdouble) for A in (K, M, X))
    return np.asarray((x * (k @ x)).sum(axis=0) / (x * (m @ x)).sum(axis=0))


def chain(members: int, seed: int) -> MatrixModel:
    """Return a chain of 200 springs in some members, one after the other."""
    rng, size = np.random.default_rng(seed), 200
    cuts = np.sort(rng.choice(np.arange(10, 190), members - 1, replace=False))
    member, k = np.searchsorted(cuts, np.arange(size), side="right"), np.exp(rng.normal(size=size))
    D = np.eye(size) - np.eye(size, k=-1)
    terms = [scipy.sparse.coo_array(D.T @ np.diag(k * (member == j)) @ D) for j in range(members)]
    mass = scipy.sparse.dia_array((np.exp(rng.normal(size=size))[None], 0), shape=(size, size))
    return MatrixModel(
        tuple(f"k{j}" for j in range(members)),
        ("s",),
        scipy.sparse.csr_array(np.eye(1, size)),
        sparse_affine(terms, Monomials(np.eye(members)), size),
        sparse_affine([mass], Monomials(np.zeros((1, members))), size),
    ).compact()


@pytest.mark.parametrize("bounds", [(0.1, 10.0), (0.01, 100.0), (1e-9, 1e-2)])
def test_a_third_of_every_error_is_found_over_many_decades(bounds: tuple[float, float]) -> None:
    requested, reported = np.arange(5), 0
    for members, seed in ((2, 0), (5, 1), (5, 2)):
        full, rng = chain(members, seed), np.random.default_rng(seed)
        lower, upper = (np.full(members, bound) for bound in bounds)
        model = ReducedModel(full, 8, np.sqrt(lower * upper), lower, upper, spare=3)
        thetas = np.exp(rng.uniform(np.log(lower), np.log(upper), (5, members)))
        thetas[-1] = np.where(rng.uniform(size=members) < 0.5, lower, upper)
        for theta in thetas:
            certificate = certificate_of(model.basis, theta, requested)
            K, M = full.pencil.K.at(theta).toarray(), full.pencil.M.at(theta).toarray()
            X = scipy.linalg.eigh(M, K)[1][:, ::-1][:, requested]
            exact = extended_quotients(K, M, X)
            truth = np.abs(model.modes(theta, 5, derivatives=False).lam / exact - 1)
            rounding = np.finfo(float).eps * (np.abs(K) @ np.abs(X) * np.abs(X)).sum(axis=0)
            sure = np.isfinite(certificate.eigenvalue) & (truth > 100 * rounding)
            assert (certificate.eigenvalue[sure] >= truth[sure] / 3).all()
            reported += int(sure.sum())
    assert reported > 5


def test_a_mode_that_enters_where_two_stiffnesses_drop_is_looked_for() -> None:
    size = 220
    D = np.eye(size) - np.eye(size, k=-1)
    D[200:] = 0.0
    springs = np.zeros((2, size, size))
    springs[:, 200, 200] = 2e-3, 3e-3
    tail = np.zeros((size, size))
    for i in range(200, size - 1):
        tail[i : i + 2, i : i + 2] += np.array([[1.0, -1.0], [-1.0, 1.0]])
    main = D.T @ D
    names = ("k1", "k2", "k3")
    full = MatrixModel(
        tuple(names),
        ("s",),
        scipy.sparse.csr_array(np.eye(1, size)),
        sparse_affine(
            [scipy.sparse.coo_array(A) for A in (main, *springs, tail)],
            Monomials(np.vstack([np.eye(3), np.zeros((1, 3))])),
            size,
        ),
        sparse_affine([scipy.sparse.eye_array(size)], Monomials(np.zeros((1, 3))), size),
    ).compact()
    scale = 1e3
    lower, nominal = np.array([0.5, 1e-3, 1e-3]), np.array([1.0, scale, scale])
    model = ReducedModel(full, 3, nominal, lower, np.array([2.0, scale, scale]), spare=1)
    (other,) = model.lacking(3)
    assert other.tolist() == [1.0, 1e-3, 1e-3]
    expected = full.modes(other, 3, derivatives=False).lam
    assert model.modes(other, 3, derivatives=False).lam[0] > 2 * expected[0]
    model.take(SnapshotRequest(other, 3))
    assert model.modes(other, 3, derivatives=False).lam == pytest.approx(expected, rel=1e-8)
    assert not model.lacking(3)


def indefinite() -> tuple[MatrixModel, ReducedModel]:
    """Return K0 + a1 K1 + a2 K2 within bounds where it is indefinite, and a basis of it."""
    size = 220
    D = np.eye(size) - np.eye(size, k=-1)
    half = np.arange(size) < size // 2
    parts = [scipy.sparse.csr_array(D.T @ np.diag(1.0 * some) @ D) for some in (half, ~half)]
    full = matrices(
        ["a1", "a2"],
        {"base": parts[0] + parts[1], "a1": parts[0], "a2": parts[1]},
        {"base": scipy.sparse.eye_array(size)},
        {"s": 100},
        floating=False,
    )
    lower, upper = np.full(2, -1.2), np.full(2, 1.0)
    return full, ReducedModel(full, 6, np.zeros(2), lower, upper, spare=2)


def test_a_model_without_modes_ends_nothing() -> None:
    full, model = indefinite()
    good, bad = np.array([-0.5, 0.5]), np.array([0.5, -1.1])
    with pytest.raises(ModelError):
        full.modes(bad, 3)
    here, other = (certificate_of(model.basis, x, np.arange(3)) for x in (good, bad))
    assert np.isfinite(here.eigenvalue).all()
    assert np.isinf(other.eigenvalue).all()
    model.take(SnapshotRequest(np.array([good, bad]), 4))
    assert model.modes(good, 3).lam == pytest.approx(full.modes(good, 3).lam, rel=1e-8)
    model.take(SnapshotRequest(bad, 0))
    with pytest.raises(ModelError):
        model.modes(bad, 3)
    assert model.modes(good, 3).lam == pytest.approx(full.modes(good, 3).lam, rel=1e-8)


def test_models_survive_pickle_without_their_factors(full: MatrixModel) -> None:
    theta = np.array([0.8, 1.2, 1.5])
    expected = full.modes(theta, COUNT)
    again = pickle.loads(pickle.dumps(full)).modes(theta, COUNT)
    assert again.lam.tolist() == expected.lam.tolist()
    assert again.phi.tolist() == expected.phi.tolist()
    model = reduced(full)
    model.take(model.first)
    model.take(SnapshotRequest(theta, COUNT))
    other = pickle.loads(pickle.dumps(model))
    with counted() as costs:
        result = other.modes(theta, COUNT)
    assert costs.eigenproblems == 0, "snapshots were counted when they were taken"
    assert result.lam.tolist() == model.modes(theta, COUNT).lam.tolist()
