"""Models of a function of theta: the digits of known models, derivatives, and what is refused."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from typing import Any

import mpmath
import numpy as np
import pytest
import scipy.linalg
import scipy.sparse
from numpy.typing import NDArray

import modefront as mf
from modefront import fem
from modefront._typing import Floats
from modefront.errors import ModelError
from modefront.linalg.affine import SparseAffine
from modefront.models.matrices import DENSE, MatrixModel

K_NAMES = ("k1", "k2", "k3")
MASSES = np.array([22.6, 22.6, 17.176])
STIFFNESS = 84763.8
SENSORS = {f"floor{i + 1}": i for i in range(3)}
SPRINGS = np.array(
    [
        [[1, 0, 0], [0, 0, 0], [0, 0, 0]],
        [[1, -1, 0], [-1, 1, 0], [0, 0, 0]],
        [[0, 0, 0], [0, 1, -1], [0, -1, 1]],
    ],
    dtype=float,
)
CHAIN = mf.chain(K_NAMES, MASSES, [STIFFNESS] * 3, stiffness_parameters=K_NAMES)
PARAMETERS = [mf.Parameter(name, 1.0, (0.2, 5.0)) for name in K_NAMES]
THETA = np.array([0.9, 1.7, 0.4])


def building(theta: NDArray[Any]) -> tuple[Any, Any]:
    """Return the matrices of a chain of three masses."""
    return STIFFNESS * np.tensordot(theta, SPRINGS, axes=1), np.diag(MASSES)


def with_derivatives(theta: NDArray[Any]) -> tuple[Any, Any, Any, Any]:
    assert theta.dtype == float
    return *building(theta), list(STIFFNESS * SPRINGS), [None] * 3


def sparse(theta: NDArray[Any]) -> tuple[Any, Any]:
    K, M = building(theta)
    return scipy.sparse.csc_array(K), scipy.sparse.dia_matrix(M)


@pytest.mark.parametrize("function", [building, with_derivatives, sparse])
def test_a_chain_has_the_same_modes_and_derivatives(function: Callable[..., Any]) -> None:
    model = mf.function_model(PARAMETERS, SENSORS, function)
    assert model.parameters == K_NAMES
    assert model.sensors == CHAIN.sensors
    assert model.size == 3
    modes, known = model.modes(THETA, 3), CHAIN.modes(THETA, 3)
    sign = np.sign(modes.phi[0] * known.phi[0])
    assert modes.lam == pytest.approx(known.lam, rel=1e-12)
    assert modes.phi * sign == pytest.approx(known.phi, rel=1e-12)
    assert modes.dlam == pytest.approx(known.dlam, rel=1e-12)
    scale = np.abs(known.dphi).max()
    assert modes.dphi * sign[:, None] == pytest.approx(known.dphi, abs=1e-12 * scale)
    assert model.modes(THETA, 2, derivatives=False).derivatives is None


def beam(theta: NDArray[Any]) -> tuple[Any, Any]:
    """Return a cantilever of a length L and a depth h: K has h^3 / L^3, M has h L."""
    L, h = theta
    K = np.array([[12, -6 * L], [-6 * L, 4 * L**2]]) * (2e3 * h**3 / L**3)
    M = np.array([[156, -22 * L], [-22 * L, 4 * L**2]]) * (5.0 * h * L / 420)
    return K, M


def eigenvalues(L: mpmath.mpf, h: mpmath.mpf) -> list[mpmath.mpf]:
    """Return the eigenvalues of the beam to 50 digits."""
    k, m = 2000 * h**3 / L**3, 5 * h * L / 420
    K = mpmath.matrix([[12, -6 * L], [-6 * L, 4 * L**2]]) * k
    M = mpmath.matrix([[156, -22 * L], [-22 * L, 4 * L**2]]) * m
    lam, _ = mpmath.eig(M**-1 * K)
    return sorted(mpmath.re(x) for x in lam)


def test_derivatives_of_a_dependence_that_is_not_affine_are_exact() -> None:
    parameters = [mf.Parameter("L", 1.5, (0.5, 4.0)), mf.Parameter("h", 0.2, (0.05, 0.5))]
    model = mf.function_model(parameters, {"tip": 0, "slope": 1}, beam)
    L, h = 1.7, 0.11
    modes = model.modes(np.array([L, h]), 2)
    with mpmath.workdps(50):
        for i, lam in enumerate(eigenvalues(mpmath.mpf(L), mpmath.mpf(h))):
            by_L = mpmath.diff(lambda x, i=i: eigenvalues(x, mpmath.mpf(h))[i], mpmath.mpf(L))
            by_h = mpmath.diff(lambda x, i=i: eigenvalues(mpmath.mpf(L), x)[i], mpmath.mpf(h))
            assert modes.lam[i] == pytest.approx(float(lam), rel=1e-12)
            assert modes.dlam[i] == pytest.approx([float(by_L), float(by_h)], rel=1e-10)


def plate(divisions: int) -> tuple[MatrixModel, Callable[[NDArray[Any]], Any]]:
    """Return a plate of which the thickness is a parameter, and its matrices as a function."""
    X, cells = fem.grids.plate(1.0, 0.7, divisions, divisions)
    edge = np.flatnonzero(X[:, 0] == 0)
    steel = fem.Material(E=210e9, nu=0.3, rho=7850.0)
    structure = fem.Structure(
        nodes=X,
        groups=[fem.Shells("plate", cells, steel, 0.01)],
        supports=[fem.Support(edge)],
        sensors=[fem.Sensor("corner", len(X) - 1, "z")],
        parameters=[fem.Parameter("t", "thickness", ["plate"])],
    )
    model = mf.mesh_model(structure, ["t"])

    def function(theta: NDArray[Any]) -> Any:
        return model.stiffness.at(theta), model.mass.at(theta)

    return model, function


@pytest.mark.parametrize("divisions", [4, 8])
def test_a_shell_of_variable_thickness_is_the_same_dense_and_sparse(divisions: int) -> None:
    known, function = plate(divisions)
    corner = int(known.selection.indices[0])
    model = mf.function_model([mf.Parameter("t", 1.0, (0.5, 2.0))], {"corner": corner}, function)
    sparse = isinstance(model.nominal.stiffness, SparseAffine)
    assert sparse == (model.size > DENSE) == (divisions == 8)
    theta = np.array([1.3])
    modes, expected = model.modes(theta, 4), known.modes(theta, 4)
    assert modes.lam == pytest.approx(expected.lam, rel=1e-9)
    assert modes.dlam == pytest.approx(expected.dlam, rel=1e-8)
    sign = np.sign(modes.phi * expected.phi)
    assert modes.phi * sign == pytest.approx(expected.phi, rel=1e-8)
    assert modes.dphi[:, :, 0] * sign == pytest.approx(expected.dphi[:, :, 0], rel=1e-6)


def test_the_pattern_of_sparse_matrices_is_analysed_once() -> None:
    _, function = plate(8)
    model = mf.function_model([mf.Parameter("t", 1.0, (0.5, 2.0))], {"corner": 3}, function)
    known = model.nominal.pencil.analysis
    assert model.at(np.array([1.3])).pencil.analysis is known
    assert model.at(np.array([0.6]), derivatives=False).pencil.analysis is known


@pytest.mark.slow(4)
def test_a_study_of_a_function_finds_the_front_of_the_chain() -> None:
    frequency = np.array([4.646, 13.81, 19.48])
    shape = np.array([[0.4561, 0.8069, 1.0], [1.0, 0.3009, -0.9026], [-0.7801, 1.0, -0.6448]])
    data = mf.modal_data(frequency, shape, CHAIN.sensors)
    groups = [mf.Group("frequencies", frequency="all"), mf.Group("shapes", shape="all")]
    peak = mf.PeakResponse("peak", ["floor3"], base="x", damping=0.02)
    function = mf.function_model(
        PARAMETERS, SENSORS, building, base={"x": [(i, 1.0) for i in range(3)]}
    )
    few = mf.Search(doubt=0.5)
    results = [
        mf.updating_problem(model, data, groups, parameters=PARAMETERS)
        for model in (CHAIN, function)
    ]
    chain, chosen = (
        mf.solve(x, points=5, search=few, predictions=[peak], noise=mf.NoisePrior(weight=0))
        for x in results
    )
    assert chosen["label"].values.tolist() == chain["label"].values.tolist()
    for name in ("objective", "theta", "frequency", "frf_peak", "combination_unit"):
        assert chosen[name].values == pytest.approx(chain[name].values, rel=1e-5, abs=1e-9), name
    optimal, known = chosen.optimal, chain.optimal
    assert optimal is not None
    assert known is not None
    K, M = building(np.array(list(optimal.theta.values())))
    assert optimal.stiffness.toarray() == pytest.approx(K, rel=1e-15)
    assert optimal.mass.toarray() == pytest.approx(M, rel=1e-15)
    exact = np.sqrt(scipy.linalg.eigvalsh(K, M)) / (2 * np.pi)
    assert optimal.modes().frequency == pytest.approx(exact, rel=1e-12)
    assert known.modes().frequency == pytest.approx(exact, rel=1e-5)
    assert mf.check(mf.Study(results[1])).sound


def spring(K: Any) -> Callable[[NDArray[Any]], Any]:
    """Return a function that returns K and a unit mass matrix of two degrees of freedom."""
    return lambda _: (K, np.eye(2))


def raising(theta: NDArray[Any]) -> Any:
    raise ZeroDivisionError("division by zero")


def filled(theta: NDArray[Any]) -> Any:
    K = np.zeros((2, 2))
    K[0, 0] = theta[0]
    return K, np.eye(2)


def filled_by_rows(theta: NDArray[Any]) -> Any:
    K = np.zeros((2, 2))
    K[:] = theta[0] * np.eye(2)
    return K, np.eye(2)


def modulus(theta: NDArray[Any]) -> Any:
    return abs(theta[0]) * np.eye(2), np.eye(2)


def derivatives(
    dK: Any, dM: Sequence[Any] = (None,)
) -> Callable[[NDArray[Any]], tuple[Any, Any, Any, Any]]:
    return lambda theta: (theta[0] * np.eye(2), np.eye(2), dK, dM)


EXPECTED = "K and M, or K, M and lists of their derivatives dK and dM"
WRONG: list[tuple[Callable[..., Any], str]] = [
    (raising, f"expected {EXPECTED}, found ZeroDivisionError: division by zero"),
    (lambda _: np.eye(2), f"expected {EXPECTED}, found ndarray"),
    (lambda _: (np.eye(2),) * 3, f"expected {EXPECTED}, found 3 values"),
    (spring(np.eye(3)), "M: expected a matrix 3 x 3, found 2 x 2"),
    (spring(np.zeros((2, 3))), "K: expected a matrix N x N, found 2 x 3"),
    (spring(3.0), "K: expected a matrix N x N, found a single number"),
    (spring([[1.0, 2.0], [3.0]]), "K: expected a matrix, found list"),
    (spring([["a", "b"], ["b", "a"]]), "K: expected numbers, found <U1"),
    (spring(1j * np.eye(2)), "K: expected real numbers for real parameters, found complex"),
    (
        spring([[1.0, np.nan], [np.nan, 1.0]]),
        "K, row 0, column 1 (from 0): expected finite numbers up to 1e+100, found nan",
    ),
    (
        spring(scipy.sparse.csr_array([[1.0, 0.0], [0.0, np.inf]])),
        "K, row 1, column 1 (from 0): expected finite numbers up to 1e+100, found inf",
    ),
    (
        spring([[1.0, 2.0], [0.0, 1.0]]),
        "K, row 0, column 1 (from 0): expected a symmetric matrix, found 2, and 0 across",
    ),
    (filled, "complex k: expected a function that takes complex parameters, or that returns"),
    (filled_by_rows, "complex k: expected a function that takes complex parameters, or that"),
    (modulus, "derivative of K with respect to k: expected derivatives of the matrices"),
    (
        derivatives([np.eye(2)] * 2),
        "dK: expected a list of 1 derivatives, one a parameter, found 2",
    ),
    (derivatives(3.0), "dK: expected a list of 1 derivatives, one a parameter, found float"),
    (derivatives([np.eye(3)]), "dK of k: expected a matrix 2 x 2, found 3 x 3"),
    (derivatives([2 * np.eye(2)]), "found 2 in row 0, column 0 (from 0) where the difference of"),
    (derivatives([np.eye(2)], [np.eye(2)]), "derivative of M with respect to k: expected"),
]


@pytest.mark.parametrize(("function", "message"), WRONG, ids=[text[:60] for _, text in WRONG])
def test_what_a_function_must_not_do_is_named(function: Callable[..., Any], message: str) -> None:
    parameter = mf.Parameter("k", 3.0, (1.0, 5.0))
    with pytest.raises(mf.InputError) as error:
        mf.function_model([parameter], {"one": 0}, function)
    assert str(error.value).startswith("matrices(k = 3)")
    assert message in str(error.value)


def test_a_function_that_fails_later_ends_the_search_and_names_theta() -> None:
    def function(theta: NDArray[Any]) -> Any:
        return (theta[0] if theta[0].real < 4 else np.nan) * np.eye(2), np.eye(2)

    model = mf.function_model([mf.Parameter("k", 3.0, (1.0, 5.0))], {"one": 0}, function)
    says = r"matrices\(k = 4.5\): K, row .*: expected finite numbers"
    with pytest.raises(mf.InputError, match=says):
        model.modes(np.array([4.5]), 1)


def test_a_model_error_of_the_function_says_that_there_is_no_model() -> None:
    def function(theta: NDArray[Any]) -> Any:
        if theta[0].real > 4:
            raise ModelError("too stiff")
        return theta[0] * np.diag([1.0, 4.0]), np.eye(2)

    parameter = mf.Parameter("k", 3.0, (1.0, 5.0))
    model = mf.function_model([parameter], {"one": 0, "two": 1}, function)
    data = mf.modal_data(np.array([0.3]), np.array([[1.0, 0.0]]), model.sensors)
    groups = [mf.Group("frequencies", frequency="all")]
    problem = mf.updating_problem(model, data, groups, parameters=[parameter])
    assert not problem.evaluate(np.array([4.5])).feasible
    assert problem.evaluate(np.array([3.5])).feasible


def test_parameters_and_degrees_of_freedom_are_checked() -> None:
    parameter = mf.Parameter("k", 3.0, (1.0, 5.0))

    def function(theta: NDArray[Any]) -> Any:
        return theta[0] * np.eye(2), np.eye(2)

    with pytest.raises(mf.InputError, match="sensors 'one': expected a degree of freedom from 0"):
        mf.function_model([parameter], {"one": 2}, function)
    with pytest.raises(mf.InputError, match="base 'x': expected a degree of freedom from 0 to 1"):
        mf.function_model([parameter], {"one": 0}, function, base={"x": [(5, 1.0)]})
    with pytest.raises(mf.InputError, match="parameters: expected at least one, found none"):
        mf.function_model([], {"one": 0}, function)
    with pytest.raises(mf.InputError, match="parameters: expected each name once, found 'k' twice"):
        mf.function_model([parameter, parameter], {"one": 0}, function)


def test_complex_steps_are_exact_whatever_the_size_of_a_parameter() -> None:
    def function(theta: NDArray[Any]) -> Any:
        E, L = theta
        return [[E / L**3]], [[1.0]]

    parameters = [mf.Parameter("E", 210e9, (1e9, 1e12)), mf.Parameter("L", 1e-9, (1e-10, 1e-8))]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        model = mf.function_model(parameters, {"tip": 0}, function)
    theta = np.array([70e9, 3e-9])
    known: Floats = np.array([1 / theta[1] ** 3, -3 * theta[0] / theta[1] ** 4])
    assert model.modes(theta, 1).dlam[0] == pytest.approx(known, rel=1e-14)
