"""The sparse engine against the dense one, Nelson's method and the things that can go wrong."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import scipy.linalg
import scipy.sparse
import scipy.sparse.linalg
from hypothesis import given, settings
from hypothesis import strategies as st

from modefront import fem
from modefront._typing import Floats
from modefront.errors import ModelError
from modefront.linalg.affine import DenseAffine, Monomials, SparseAffine, sparse_affine
from modefront.linalg.factorisation import Pencil, pencil
from modefront.models.matrices import MatrixModel, matrices
from modefront.models.mesh import mesh_model
from modefront.modes import dense, derivatives, sparse
from modefront.modes.lanczos import Ritz, greatest
from modefront.modes.result import ModeDerivatives, Modes
from modefront.work.task import Costs, counted


def springs(size: int, ends: Floats, k: Floats) -> scipy.sparse.coo_array:
    """Return the stiffness of springs between degrees of freedom (or the ground, -1)."""
    A = np.zeros((size + 1, size + 1))
    for (a, b), value in zip(ends.astype(int), k, strict=True):
        A[[a, b, a, b], [a, b, b, a]] += [value, value, -value, -value]
    return scipy.sparse.coo_array(A[:-1, :-1])


def network(size: int, seed: int, *, massless: float, free: bool) -> tuple[SparseAffine, ...]:
    """Return K and M of a random network of springs with three stiffness and two mass regions."""
    rng = np.random.default_rng(seed)
    chain = np.column_stack([np.arange(size), np.arange(-1, size - 1)])[free:]
    extra = rng.integers(0, size, (size // 2, 2))
    ends = np.concatenate([chain, extra[extra[:, 0] != extra[:, 1]]])
    k = rng.uniform(0.5, 2.0, len(ends))
    region = rng.integers(0, 3, len(ends))
    K = [springs(size, ends[region == j], k[region == j]) for j in range(3)]
    m = np.where(rng.random(size) < massless, 0.0, rng.uniform(0.5, 2.0, size))
    m[[0, size // 2, size - 1]] = 1.0
    half = np.arange(size) < size // 2
    M = [scipy.sparse.coo_array(np.diag(m * part)) for part in (half, ~half)]
    exponents = np.zeros((3, 5)), np.zeros((2, 5))
    exponents[0][[0, 1, 2], [0, 1, 2]] = [1.0, 1.0, 3.0]
    exponents[1][[0, 1], [3, 4]] = 1.0
    return (
        sparse_affine(K, Monomials(exponents[0]), size),
        sparse_affine(M, Monomials(exponents[1]), size),
    )


def lattice(
    nx: int, ny: int, nz: int, *, clamped: bool = True
) -> tuple[SparseAffine, SparseAffine]:
    """Return K and M of a bar of springs with diagonals, three regions along its length."""
    node = np.arange(nx * ny * nz).reshape(nx, ny, nz)
    size = 3 * node.size
    entries: list[tuple[Floats, Floats, Floats, int]] = []
    for step in np.ndindex(2, 2, 2):
        for sign in ((1, 1, 1), (1, -1, 1), (1, 1, -1)):
            d = np.array(step) * sign
            if not d.any() or any(s < 0 and not e for s, e in zip(sign, step, strict=True)):
                continue
            sides = list(zip(d, node.shape, strict=True))
            a = node[tuple(slice(max(0, -v), n - max(0, v)) for v, n in sides)].ravel()
            b = node[tuple(slice(max(0, v), n + min(0, v)) for v, n in sides)].ravel()
            e = d / np.linalg.norm(d)
            for first, second, s in ((a, a, 1), (b, b, 1), (a, b, -1), (b, a, -1)):
                for i, j in np.ndindex(3, 3):
                    for region in range(3):
                        part = a // (ny * nz) * 3 // nx == region
                        row, column = 3 * first[part] + i, 3 * second[part] + j
                        entries.append((row, column, np.full(row.size, s * e[i] * e[j]), region))
    held = 3 * ny * nz * clamped
    K = []
    for region in range(3):
        row, column, value = (
            np.concatenate([entry[k] for entry in entries if entry[3] == region]) for k in range(3)
        )
        inner = (row >= held) & (column >= held)
        parts = value[inner], (row[inner] - held, column[inner] - held)
        K.append(scipy.sparse.coo_array(parts, shape=(size - held, size - held)))
    M = [scipy.sparse.coo_array(scipy.sparse.eye_array(size - held))]
    return (
        sparse_affine(K, Monomials(np.eye(3)), size - held),
        sparse_affine(M, Monomials(np.zeros((1, 3))), size - held),
    )


def both(
    K: SparseAffine, M: SparseAffine, theta: Floats, count: int, sensors: Floats | None = None
) -> tuple[Modes, Modes]:
    """Return the modes of the sparse and of the dense engine, with the same signs."""
    S = np.eye(K.size) if sensors is None else sensors
    result = sparse.modes(pencil(K, M), scipy.sparse.csr_array(S), theta, count, True)
    expected = dense.modes(K.dense(), M.dense(), S, theta, count, True)
    sign = np.where(np.sum(result.phi * expected.phi, axis=0) < 0, -1.0, 1.0)
    slopes = ModeDerivatives(result.dlam, result.dphi * sign[:, None], result.coincident)
    return Modes(result.lam, result.phi * sign, slopes), expected


def agree(result: Modes, expected: Modes, tolerance: float = 1e-8) -> None:
    """Check all that is defined: single modes, and subspaces of coinciding ones."""
    scale = np.abs(expected.lam).max()
    assert result.lam == pytest.approx(expected.lam, rel=1e-11, abs=1e-11 * scale)
    assert result.coincident.tolist() == expected.coincident.tolist()
    assert result.dlam == pytest.approx(expected.dlam, abs=tolerance * np.abs(expected.dlam).max())
    distinct = ~expected.coincident
    for r in np.flatnonzero(distinct):
        size = np.abs(expected.dphi[:, r]).max() + np.abs(expected.phi[:, r]).max()
        assert result.phi[:, r] == pytest.approx(expected.phi[:, r], abs=tolerance)
        assert result.dphi[:, r] == pytest.approx(expected.dphi[:, r], abs=tolerance * size)


@given(
    st.integers(6, 40),
    st.integers(0, 10**6),
    st.sampled_from([0.0, 0.4]),
    st.booleans(),
    st.sampled_from([1, 2, 30]),
)
def test_same_as_dense(size: int, seed: int, massless: float, free: bool, sensors: int) -> None:
    K, M = network(size, seed, massless=massless, free=free)
    rng = np.random.default_rng(seed)
    theta = rng.uniform(0.7, 1.5, 5)
    agree(*both(K, M, theta, 3, rng.standard_normal((sensors, size))))


@pytest.mark.slow(2)
@given(st.integers(8, 40), st.integers(0, 10**6), st.sampled_from([0.0, 0.4]), st.booleans())
def test_second_derivatives_are_those_of_all_modes(
    size: int, seed: int, massless: float, free: bool
) -> None:
    K, M = network(size, seed, massless=massless, free=free)
    rng = np.random.default_rng(seed)
    theta, S = rng.uniform(0.7, 1.5, 5), rng.standard_normal((4, size))
    w, v = rng.standard_normal((2, 3)), rng.standard_normal((2, 4, 3))
    w[1], v[1, :, 0] = 0, 0
    result = sparse.modes(pencil(K, M), scipy.sparse.csr_array(S), theta, 3, True)
    expected = dense.modes(K.dense(), M.dense(), S, theta, 3, True)
    lam = dense.decompose(K.dense().at(theta), M.dense().at(theta)).lam[:4]
    gap = (np.diff(lam) / lam[1:]).min()
    sign = np.sign(np.sum(result.phi * expected.phi, axis=0))
    found, known = result.second_derivatives(w, v * sign), expected.second_derivatives(w, v)
    assert (found is None) == (known is None)
    if found is not None and known is not None:
        tolerance = max(1e-8, 1e-12 / gap**2)
        assert np.abs(found - known).max() <= tolerance * np.abs(known).max()


@pytest.mark.parametrize(("clamped", "split"), [(True, 1e-4), (False, 1e-2)])
def test_many_second_derivatives_take_a_factor_a_mode(clamped: bool, split: float) -> None:
    """It costs more than some solutions with the factors at hand, and less than hundreds."""
    one, theta, made = lattice(8, 4, 3, clamped=clamped), np.array([1.0, 1.3, 0.8]), list[int]()
    K, M = (
        sparse_affine(
            [scipy.sparse.block_diag((T, factor * T)).tocoo() for T in _terms(A)],
            A.coefficients,
            2 * A.size,
        )
        for A, factor in zip(one, (1 + split, 1.0), strict=True)
    )
    first = 0 if clamped else 12  # rigid-body modes
    rng = np.random.default_rng(0)
    S, v = rng.standard_normal((5, K.size)), rng.standard_normal((60, 5, first + 4))
    v[:, :, :first] = 0
    w = np.where(v.any(axis=1), rng.standard_normal((60, 1)), 0)
    engine = pencil(K, M, lambda: made.append(1))
    modes = sparse.modes(engine, scipy.sparse.csr_array(S), theta, first + 4, True)
    expected = dense.modes(K.dense(), M.dense(), S, theta, first + 4, True)
    sign = np.sign(np.sum(modes.phi * expected.phi, axis=0))
    before = len(made)
    few, known = modes.second_derivatives(w[:1], v[:1]), expected.second_derivatives(w, v * sign)
    assert len(made) == before
    many = modes.second_derivatives(w, v)
    assert len(made) == before + 4
    assert few is not None
    assert many is not None
    assert known is not None
    scale = np.abs(known).max()
    assert np.abs(many[:1] - few).max() <= 1e-10 * scale
    assert np.abs(many - known).max() <= 1e-8 * scale


@pytest.mark.parametrize("split", [1e-2, 1e-4, 0.0])
def test_close_and_repeated_modes(split: float) -> None:
    K, M = network(20, 1, massless=0.3, free=False)
    two = scipy.sparse.block_diag
    scaled = [(1 + split) * A for A in _terms(K)]
    K2 = sparse_affine(
        [two((A, B)).tocoo() for A, B in zip(_terms(K), scaled, strict=True)], K.coefficients, 40
    )
    M2 = sparse_affine([two((A, A)).tocoo() for A in _terms(M)], M.coefficients, 40)
    result, expected = both(K2, M2, np.ones(5), 3)
    assert result.coincident.all() == (split == 0.0)
    agree(result, expected, 1e-7 if split else 1e-8)
    if split == 0.0:
        outer = [np.einsum("srp,tr->stp", m.dphi[:, :2], m.phi[:, :2]) for m in (result, expected)]
        assert outer[0] == pytest.approx(outer[1], abs=1e-8)


def _terms(A: SparseAffine) -> list[scipy.sparse.csr_array]:
    return [scipy.sparse.csr_array(term) for term in A.dense().terms]


@settings(max_examples=20)
@given(st.integers(0, 10**6))
def test_derivatives_do_not_depend_on_the_side_from_which_they_are_found(seed: int) -> None:
    K, M = network(40, seed, massless=0.3, free=False)
    rng = np.random.default_rng(seed)
    S = rng.standard_normal((12, 40))
    engine = pencil(K, M)
    direct = sparse.modes(engine, S, np.ones(5), 3, True)
    for sensor in (0, 7):
        adjoint = sparse.modes(engine, S[sensor : sensor + 1], np.ones(5), 3, True)
        scale = np.abs(direct.dphi).max()
        assert adjoint.dphi[0] == pytest.approx(direct.dphi[sensor], abs=1e-9 * scale)


def nelson(K: SparseAffine, M: SparseAffine, theta: Floats, lam: float, phi: Floats) -> Floats:
    """Return dphi (N, p) of a single mode with one factorisation of K - lam M (Nelson 1976)."""
    Kt, Mt = K.at(theta), M.at(theta)
    dK = K.derivatives_times(theta, phi[:, None])[:, 0]
    dM = M.derivatives_times(theta, phi[:, None])[:, 0]
    force = dK - lam * dM
    right = np.outer(Mt @ phi, phi @ force) - force
    fixed = int(np.argmax(np.abs(phi * (Mt @ phi))))
    keep = scipy.sparse.diags_array((np.arange(phi.size) != fixed).astype(float))
    distinct = scipy.sparse.diags_array((np.arange(phi.size) == fixed).astype(float))
    right[fixed] = 0.0
    A = (keep @ (Kt - lam * Mt) @ keep + distinct).tocsc()
    factor = scipy.sparse.linalg.splu(A)
    v = factor.solve(right)
    v += factor.solve(right - A @ v)
    chosen = -(Mt @ phi) @ v - 0.5 * phi @ dM
    out: Floats = v + np.outer(phi, chosen)
    return out


def test_nelson() -> None:
    K, M = lattice(9, 4, 3)
    theta = np.array([1.0, 1.3, 0.8])
    engine = pencil(K, M)
    result = sparse.modes(engine, np.eye(K.size), theta, 4, True)
    for r in range(4):
        expected = nelson(K, M, theta, result.lam[r], result.phi[:, r])
        scale = np.abs(expected).max()
        assert result.dphi[:, r] == pytest.approx(expected, abs=1e-8 * scale)


def test_large_enough_to_restart_and_to_be_shared_between_threads() -> None:
    K, M = lattice(24, 4, 4)
    theta = np.array([1.0, 1.3, 0.8])
    result = sparse.lowest(pencil(K, M), theta, 12)
    expected = scipy.sparse.linalg.eigsh(
        K.at(theta), 12, M.at(theta), 0.0, return_eigenvectors=False
    )
    assert result.lam[:12] == pytest.approx(np.sort(expected), rel=1e-10)


def model(K: Floats, M: Floats) -> MatrixModel:
    """Return a sparse model, however small, with two parameters that scale K and M."""
    size = len(K)
    terms = [scipy.sparse.coo_array(A) for A in (K, M)]
    stiffness, mass = (
        sparse_affine([A], Monomials(np.eye(2)[[j]]), size) for j, A in enumerate(terms)
    )
    names = tuple(map(str, range(size)))
    selection = scipy.sparse.csr_array(np.eye(size))
    return MatrixModel(("k", "m"), names, selection, stiffness, mass)


def test_two_factorisations_an_evaluation(costs: Costs) -> None:
    result = model(np.diag(np.arange(1.0, 41.0)), np.eye(40))
    for evaluation in range(1, 4):
        assert result.modes(np.ones(2), 3).lam == pytest.approx([1, 2, 3])
        assert costs.eigenproblems == evaluation
        assert costs.factorisations == 2 * evaluation


@pytest.mark.parametrize(
    ("thickness", "count"),
    [(2e-3, 9), *(pytest.param(2e-4, n, marks=pytest.mark.slow(3)) for n in (18, 30))],
)
def test_two_factorisations_of_a_thin_shell(thickness: float, count: int, costs: Costs) -> None:
    """Rounding leaves much of unknown modes in the lowest ones, which lie far from sigma."""
    X, cells = fem.grids.plate(3.0, 2.0, 18, 12)
    X[:, 2] = 0.1 * X[:, 0] * X[:, 1]
    sheet = fem.Shells("sheet", cells, fem.Material(210e9, 0.3, 7850.0), thickness)
    sensor, support = (
        fem.Sensor("corner", len(X) - 1, "z"),
        fem.Support(np.flatnonzero(X[:, 0] == 0)),
    )
    pencil = mesh_model(fem.Structure(X, (sheet,), (support,), sensors=(sensor,)), ()).pencil
    modes = sparse.lowest(pencil, np.zeros(0), count)
    assert costs.factorisations == 2
    assert modes.proved >= count
    gram = modes.Phi.T @ (pencil.M.at(np.zeros(0)) @ modes.Phi)
    assert np.abs(gram - np.eye(len(gram))).max() < 1e-12
    # Rayleigh quotients of more digits, whose errors are the squares of those of the modes; with
    # sigma far above them, the lowest modes themselves have more of rounding.
    Phi = modes.Phi.astype(np.longdouble)
    energy, inertia = (
        (Phi * (A.at(np.zeros(0)).toarray().astype(np.longdouble) @ Phi)).sum(0)
        for A in (pencil.K, pencil.M)
    )
    assert (np.abs(modes.lam - energy / inertia) < 2 * modes.noise).all()
    more = sparse.lowest(pencil, np.zeros(0), 60)
    assert (np.abs(modes.lam - more.lam[: modes.lam.size]) < 100 * modes.noise).all()


def test_eigenvalues_repeated_more_often_than_a_block_is_wide() -> None:
    result = model(np.diag([1.0] * 9 + [2.0] * 30), np.eye(39)).modes(np.ones(2), 9)
    assert result.lam == pytest.approx(np.ones(9))
    assert result.coincident.all()
    assert result.dlam == pytest.approx(np.tile([1.0, -1.0], (9, 1)))


def blind(calls: int) -> Callable[..., Ritz]:
    """Return a Lanczos iteration that overlooks the second mode in its first ``calls`` runs."""
    left = [calls]

    def run(*args: Any, **keywords: Any) -> Ritz:
        ritz = greatest(*args, **keywords)
        left[0] -= 1
        if left[0] < 0:
            return ritz
        return replace(
            ritz,
            mu=np.delete(ritz.mu, 1),
            X=np.delete(ritz.X, 1, axis=1),
            converged=ritz.converged - 1,
        )

    return run


def test_a_missed_mode_is_found(monkeypatch: pytest.MonkeyPatch, costs: Costs) -> None:
    monkeypatch.setattr(sparse, "greatest", blind(1))
    result = model(np.diag(np.arange(1.0, 41.0)), np.eye(40))
    assert result.modes(np.ones(2), 3).lam == pytest.approx([1, 2, 3])
    assert costs.factorisations == 4


def test_a_missed_mode_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sparse, "greatest", blind(100))
    found = model(np.diag(np.arange(1.0, 41.0)), np.eye(40))
    assert found.modes(np.ones(2), 3).lam == pytest.approx([1, 2, 3]), "all are solved for at once"
    monkeypatch.setattr(sparse, "ALL_AT_ONCE", 39)
    with pytest.raises(ModelError, match="has lost some of them"):
        found.modes(np.ones(2), 3)


def test_rigid_body_modes_only() -> None:
    K = np.zeros((12, 12))
    K[:3, :3] = [[1.0, -1.0, 0.0], [-1.0, 2.0, -1.0], [0.0, -1.0, 1.0]]
    K[3:, 3:] = np.diag(np.arange(2.0, 11.0))
    K[3:5, 3:5] = [[1.0, -1.0], [-1.0, 1.0]]
    result = model(K, np.eye(12)).modes(np.ones(2), 2)
    assert result.lam == pytest.approx([0.0, 0.0], abs=1e-12)
    assert result.dlam == pytest.approx(np.zeros((2, 2)), abs=1e-12)


@pytest.mark.parametrize("count", [1, 3, 6, 8])
def test_six_rigid_body_modes(count: int) -> None:
    K, M = lattice(6, 3, 3, clamped=False)
    theta = np.array([1.0, 1.3, 0.8])
    result = sparse.modes(pencil(K, M), np.eye(K.size), theta, count, True)
    expected = dense.decompose(K.at(theta).toarray(), M.at(theta).toarray()).lam[:count]
    assert result.lam == pytest.approx(expected, rel=1e-10, abs=1e-12)
    assert result.dlam[:6] == pytest.approx(np.zeros((min(count, 6), 3)), abs=1e-12)


@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
@pytest.mark.parametrize("free", [True, False])
def test_units_do_not_matter(scale: float, free: bool) -> None:
    K, M = (A.at(np.ones(5)).toarray() for A in network(40, 3, massless=0.4, free=free))
    expected, result = (model(s * K, M).modes(np.ones(2), 4) for s in (1.0, scale))
    top = expected.lam[-1]
    assert result.lam / scale == pytest.approx(expected.lam, rel=1e-10, abs=1e-12 * top)


BROKEN = {
    "nothing holds DOF 5": (np.r_[1:6, 0, 7:13], np.r_[1:6, 0, 7:13] > 0, "degree of freedom 5"),
    "indefinite K": (np.r_[-3.0, 1:12], np.ones(12), "stiffness matrix is indefinite"),
    "massless and unstable": (np.r_[-3.0, 1:12], np.r_[0.0, np.ones(11)], "indefinite"),
    "indefinite M": (np.ones(12), np.r_[-1.0, 1:12], "mass matrix is indefinite"),
    "few masses": (np.arange(1.0, 13), np.r_[1.0, 2.0, np.zeros(10)], "only 2 have a finite"),
}


@pytest.mark.parametrize(("K", "M", "message"), BROKEN.values(), ids=BROKEN)
def test_broken_models(K: Floats, M: Floats, message: str) -> None:
    with pytest.raises(ModelError, match=message):
        model(np.diag(K.astype(float)), np.diag(M.astype(float))).modes(np.ones(2), 3)


def test_modes_without_derivatives_are_the_same() -> None:
    result = model(np.diag(np.arange(1.0, 41.0)), np.eye(40))
    with_, without = (result.modes(np.ones(2), 3, derivatives=d) for d in (True, False))
    assert np.array_equal(with_.lam, without.lam)
    assert np.array_equal(with_.phi, without.phi)
    assert without.derivatives is None
    for name in ("dlam", "dphi", "dfrequency"):
        with pytest.raises(ValueError, match="modes with derivatives, found modes without"):
            getattr(without, name)


def test_small_models_are_dense_and_large_ones_sparse() -> None:
    for size, expected in ((20, True), (400, False)):
        K = scipy.sparse.diags_array(np.arange(1.0, size + 1))
        M = scipy.sparse.eye_array(size)
        result = matrices(["k"], {"k": K}, {"base": M}, {"a": 0, "b": [(1, 0.5), (2, 0.5)]})
        with counted() as costs:
            assert result.modes(np.ones(1), 2).lam == pytest.approx([1, 2])
        assert costs.factorisations == (0 if expected else 2)


def test_a_solution_that_does_not_converge_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(derivatives, "STEPS", 1)
    K, M = lattice(5, 3, 3)
    with pytest.raises(ModelError, match="derivatives do not converge"):
        sparse.modes(pencil(K, M), np.eye(K.size), np.array([1.0, 1.3, 0.8]), 3, True)


def test_the_factor_is_of_the_pencil() -> None:
    K, M = network(15, 4, massless=0.3, free=False)
    engine: Pencil = pencil(K, M)
    theta = np.ones(5)
    Kt, Mt = K.at(theta), M.at(theta)
    shifted = engine.factor(Kt.data, Mt.data, 0.3)
    X = np.random.default_rng(0).standard_normal((15, 2))
    assert shifted.solve((Kt - 0.3 * Mt) @ X) == pytest.approx(X, abs=1e-9)


@pytest.mark.parametrize("held", [True, False])
@pytest.mark.parametrize("cells", [3, 60, 5000])
def test_singular_stiffness_is_told_from_a_held_one(cells: int, held: bool) -> None:
    """Few cells give dense matrices, many give sparse ones, and a line of them is soft."""
    X, beams = fem.grids.line(np.zeros(3), np.array([30.0, 0, 0]), cells)
    support = (fem.Support(0),) if held else ()
    structure = fem.Structure(
        X,
        (fem.Beams("beam", beams, fem.Material(210e9, 0.3, 7850.0), fem.circle(0.02)),),
        support,
        sensors=(fem.Sensor("tip", cells, "z"),),
    )
    model = mesh_model(structure, (), floating=not held)
    assert isinstance(model.stiffness, DenseAffine) == (cells == 3)
    assert model.is_singular(np.zeros(0)) is not held


def test_modes_that_the_iteration_loses_are_solved_for_at_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    size = 240
    K = scipy.sparse.diags_array(np.linspace(1, 9, size), format="csr")
    K = K + scipy.sparse.diags_array([np.full(size - 1, 0.1)] * 2, offsets=[-1, 1])
    model = matrices(["k"], {"k": K}, {"base": scipy.sparse.eye_array(size)}, {"low": 0})

    def loses(*arguments: Any, **options: Any) -> Ritz:
        ritz = greatest(*arguments, **options)
        return replace(ritz, mu=ritz.mu[:5], X=ritz.X[:, :5], converged=5, complete=True)

    monkeypatch.setattr(sparse, "greatest", loses)
    expected = 2 * np.linalg.eigvalsh(K.toarray())[:20]
    np.testing.assert_allclose(model.modes(np.array([2.0]), 20).lam, expected, rtol=1e-12)
    monkeypatch.setattr(sparse, "ALL_AT_ONCE", 100)
    with pytest.raises(ModelError, match="20 modes asked for, but the eigensolver has lost some"):
        model.modes(np.array([2.0]), 20)


def wide(size: int, decades: float, copies: int) -> tuple[MatrixModel, Floats]:
    """Return a model in which all DOFs have mass, and its eigenvalues, each so many times."""
    lam = np.repeat(10 ** np.linspace(0, decades, size // copies), copies)
    turn = scipy.linalg.block_diag(*[[[0.8, -0.6], [0.6, 0.8]]] * (size // 2))
    turn = turn @ np.roll(np.roll(turn, 1, axis=0), 1, axis=1)
    K = turn @ np.diag(lam) @ turn.T
    root = np.sqrt(np.random.default_rng(1).uniform(0.1, 10.0, size))
    K = scipy.sparse.csr_array(np.outer(root, root) * (K + K.T) / 2)
    M = scipy.sparse.diags_array(root**2, format="csr")
    return matrices(["k"], {"k": K}, {"base": M}, {"low": 0}), lam


@pytest.mark.parametrize("copies", [1, 3])
@pytest.mark.parametrize("decades", [0.5, 10, 13])
@pytest.mark.parametrize(("size", "count"), [(150, 150), (300, 120), (300, 240)])
def test_all_modes_are_there_where_all_degrees_of_freedom_have_mass(
    size: int, count: int, decades: float, copies: int
) -> None:
    model, lam = wide(size, decades, copies)
    found = model.modes(np.array([1.0]), count, derivatives=False).lam
    np.testing.assert_allclose(found, lam[:count], rtol=1e-7, atol=1e-13 * lam[-1])


def test_lost_modes_are_found_after_a_restart(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sparse, "ALL_AT_ONCE", 100)
    low, high = 10 ** np.linspace(0, 10, 120), 10 ** np.linspace(10.1, 11, 480)
    lam = np.concatenate([low, high])
    turn = scipy.sparse.block_diag(
        [scipy.sparse.coo_array([[0.8, -0.6], [0.6, 0.8]])] * 300, format="csr"
    )
    K = turn @ scipy.sparse.diags_array(lam, format="csr") @ turn.T
    M = scipy.sparse.eye_array(600, format="csr")
    model = matrices(["k"], {"k": (K + K.T) / 2}, {"base": M}, {"low": 0})
    found = model.modes(np.array([1.0]), 100, derivatives=False).lam
    np.testing.assert_allclose(found, lam[:100], rtol=1e-4, atol=1e-16 * lam[-1])
