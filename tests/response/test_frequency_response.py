"""Modal superposition against the direct solution, and the peaks against brute force."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import eigh

from modefront.predictions import peak_response
from modefront.predictions.peak_response import ORDERS, derivatives
from modefront.predictions.system import ModalSystem

M = np.diag([22.6, 22.6, 0.76 * 22.6])
K = 84763.8 * np.array([[2.0, -1.0, 0.0], [-1.0, 2.0, -1.0], [0.0, -1.0, 1.0]])
DRIFTS = np.array([[1.0, 0.0, 0.0], [-1.0, 1.0, 0.0], [0.0, -1.0, 1.0]])
R = np.ones((3, 1))
ZETA = np.array([0.02, 0.03, 0.05])
OMEGA = np.linspace(0.0, 160.0, 97)


class Peak(NamedTuple):
    omega: float
    amplitude: float


def peaks(system, quantity="receptance", output=0, band=None):
    band = band or (0.0, 2 * system.omega.max())
    return tuple(map(Peak, *peak_response.peaks(system, quantity, output, band)))


def frequency_response(system, omega, quantity="receptance"):
    return derivatives(system, np.array(omega, dtype=complex), quantity)[0]


def chain(load, output, modes=3, rigid=None):
    """Return the chain of three stories with its first modes, and its damping matrix."""
    lam, phi = eigh(K, M)
    omega = np.sqrt(lam)
    damping = M @ phi @ np.diag(2 * ZETA * omega) @ phi.T @ M
    system = ModalSystem(
        omega=omega[:modes],
        zeta=ZETA[:modes],
        input=phi[:, :modes].T @ load,
        output=output @ phi[:, :modes],
        static=output @ np.linalg.solve(K, load),
        rigid=rigid,
    )
    return system, damping


def direct(load, output, damping, omega):
    return np.array(
        [output @ np.linalg.solve(K - w**2 * M + 1j * w * damping, load) for w in omega]
    )


@pytest.mark.parametrize(
    ("quantity", "factor"),
    [
        ("receptance", np.ones_like(OMEGA)),
        ("mobility", 1j * OMEGA),
        ("accelerance", -(OMEGA**2)),
    ],
    ids=["receptance", "mobility", "accelerance"],
)
@pytest.mark.parametrize("load", [np.eye(3), -M @ R], ids=["forces", "base"])
def test_superposition_is_the_direct_solution(quantity, factor, load):
    system, damping = chain(load, DRIFTS)
    exact = factor[:, None, None] * direct(load, DRIFTS, damping, OMEGA)
    result = frequency_response(system, OMEGA, quantity)
    assert result.shape == (97, 3, load.shape[1])
    np.testing.assert_allclose(result, exact, rtol=1e-11, atol=1e-13 * abs(exact).max())


def test_absolute_acceleration_follows_from_newtons_law():
    system, damping = chain(-M @ R, np.eye(3), rigid=R)
    relative = direct(-M @ R, np.eye(3), damping, OMEGA)
    exact = 1 - OMEGA[:, None, None] ** 2 * relative
    result = frequency_response(system, OMEGA, "absolute accelerance")
    np.testing.assert_allclose(result, exact, rtol=1e-10, atol=1e-12)
    np.testing.assert_allclose(result[0], R, rtol=1e-14)


def test_static_correction_makes_the_error_fourth_order():
    """Modes cut off leave ω²A/ω_r⁴ and 2iζωA/ω_r³; the correction leaves nothing at ω = 0."""
    load = np.eye(3)
    full, damping = chain(load, np.eye(3))
    cut, _ = chain(load, np.eye(3), modes=1)
    bare = ModalSystem(cut.omega, cut.zeta, cut.input, cut.output)
    exact = direct(load, np.eye(3), damping, OMEGA[:30])
    with_it = abs(frequency_response(cut, OMEGA[:30]) - exact).max(axis=(1, 2))
    without = abs(frequency_response(bare, OMEGA[:30]) - exact).max(axis=(1, 2))
    assert with_it[0] < 1e-12 * abs(exact[0]).max()
    assert np.all(with_it < 0.5 * without)
    assert np.all(full.residual_flexibility() < 1e-12 * abs(exact[0]).max())


@pytest.mark.parametrize("quantity", ORDERS)
def test_derivatives_against_a_contour_integral(quantity):
    """T is analytic in ω: by Cauchy's formula a ring of values gives its derivatives."""
    system, _ = chain(-M @ R, DRIFTS, modes=2, rigid=DRIFTS @ R)
    omega, radius = np.array([3.0, 29.0, 81.0, 140.0]), 0.2
    _, *result = derivatives(system, omega.astype(complex), quantity)
    turns = np.exp(2j * np.pi * np.arange(64) / 64)
    ring = np.array([derivatives(system, omega + radius * turn, quantity)[0] for turn in turns])
    for order, derivative in enumerate(result, start=1):
        cauchy = order * (ring * turns[:, None, None, None] ** -order).mean(axis=0) / radius**order
        np.testing.assert_allclose(derivative, cauchy, rtol=1e-9, atol=1e-9 * abs(cauchy).max())


def one_mode(omega, zeta, **other):
    return ModalSystem(np.array([omega]), np.array([zeta]), np.eye(1), np.eye(1), **other)


@pytest.mark.parametrize(
    ("quantity", "position"),
    [
        ("receptance", lambda z: np.sqrt(1 - 2 * z**2)),
        ("mobility", lambda z: 1.0),
        ("accelerance", lambda z: 1 / np.sqrt(1 - 2 * z**2)),
    ],
)
@pytest.mark.parametrize("zeta", [1e-5, 0.02, 0.3])
def test_peak_of_one_mode_is_where_the_textbook_has_it(quantity, position, zeta):
    (peak,) = peaks(one_mode(29.2, zeta), quantity)
    assert peak.omega == pytest.approx(29.2 * position(zeta), rel=1e-12)
    if quantity == "receptance":
        exact = 1 / (2 * zeta * np.sqrt(1 - zeta**2) * 29.2**2)
        assert peak.amplitude == pytest.approx(exact, rel=1e-10)


def test_heavily_damped_mode_has_no_peak():
    assert peaks(one_mode(10.0, 0.8)) == ()


@pytest.mark.parametrize(("split", "count"), [(1e-4, 1), (0.01, 1), (0.03, 2), (0.1, 2), (0.3, 2)])
def test_close_modes_have_one_peak_or_two(split, count):
    omega = 10 * np.array([1 - split / 2, 1 + split / 2])
    system = ModalSystem(omega, np.full(2, 0.02), np.ones((2, 1)), np.array([[1.0, -1.0]]))
    in_phase = ModalSystem(omega, np.full(2, 0.02), np.ones((2, 1)), np.array([[1.0, 1.0]]))
    assert len(peaks(in_phase)) == count
    assert all(abs(p.omega / 10 - 1) < split + 0.01 for p in peaks(system))


def test_peak_close_to_an_antiresonance():
    """A mode hardly seen at the sensor: a peak and a dip within a bandwidth."""
    omega, zeta = np.array([10.0, 20.0]), np.array([0.02, 1e-4])
    system = ModalSystem(omega, zeta, np.ones((2, 1)), np.array([[1.0, 1e-4]]))
    first, second = peaks(system)
    assert first.omega == pytest.approx(10, rel=1e-2)
    assert second.omega == pytest.approx(20, rel=1e-3)
    near = np.linspace(second.omega - 1e-4, second.omega + 1e-4, 201)
    assert abs(frequency_response(system, near)).max() <= second.amplitude * (1 + 1e-15)


@pytest.mark.slow(3)
@settings(max_examples=60, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), m=st.integers(1, 8), quantity=st.sampled_from([*ORDERS]))
def test_no_peak_is_missed(seed, m, quantity):
    rng = np.random.default_rng(seed)
    omega = np.sort(rng.uniform(1, 30, m))
    zeta = 10 ** rng.uniform(-2.5, -0.7, m)
    system = ModalSystem(
        omega, zeta, rng.normal(size=(m, 1)), rng.normal(size=(1, m)), rigid=np.ones((1, 1))
    )
    result = np.array([p.omega for p in peaks(system, quantity)])
    grid = np.linspace(0, 2 * omega[-1], 20001)
    size = abs(frequency_response(system, grid, quantity))[:, 0, 0]
    top = (size[1:-1] > size[:-2]) & (size[1:-1] > size[2:])
    expected = grid[1:-1][top]
    # The grid cannot see peaks closer than itself, but each that it sees is there.
    assert all(np.min(abs(result - w)) <= grid[1] for w in expected)
    slope = derivatives(system, result.astype(complex), quantity)
    g = 2 * (slope[0].conj() * slope[1]).real[:, 0, 0]
    bend = 2 * (abs(slope[1]) ** 2 + (slope[0].conj() * slope[2]).real)[:, 0, 0]
    assert np.all(bend < 0)
    assert np.all(abs(g / bend) <= 1e-9 * result)
    assert len(result) <= len(expected) + 2


@pytest.mark.parametrize("apart", [0.0, 1e-15, 1e-12, 1e-6])
def test_modes_that_cancel_leave_nothing_to_search(apart):
    """Opposite modes at one frequency: what rounding leaves of T has no peaks of its own."""
    omega = 10 * np.array([1.0, 1 + apart])
    system = ModalSystem(omega, np.full(2, 0.02), np.ones((2, 1)), np.array([[1.0, -1.0]]))
    result = peaks(system)
    assert len(result) <= 1
    assert all(abs(p.omega - 10) < 0.01 for p in result)


def test_a_response_at_a_node_has_no_peaks():
    assert peaks(ModalSystem(np.ones(1), np.full(1, 0.02), np.ones((1, 1)), np.zeros((1, 1)))) == ()


def test_fifty_modes():
    omega = np.linspace(5, 250, 50)
    shape = np.random.default_rng(0).normal(size=(1, 50))
    system = ModalSystem(omega, np.full(50, 1e-3), shape.T, shape, static=np.eye(1))
    result = np.array([p.omega for p in peaks(system)])
    assert all(np.min(abs(result - w)) < 0.02 * w for w in omega[abs(shape[0]) > 0.1])


def test_peaks_of_one_output_and_input_of_many():
    system, _ = chain(np.eye(3), np.eye(3))
    alone, _ = chain(np.eye(3)[:, 2:], np.eye(3)[:1])
    last = replace(system, input=system.input[:, 2:], static=system.static[:, 2:])
    assert peaks(last) == peaks(alone)
    first = replace(system, input=system.input[:, :1], static=system.static[:, :1])
    assert len(peaks(first)) == 3
    low, *_ = peaks(first)
    assert peaks(first, band=(20.0, 40.0)) == (low,)


def test_a_rigid_body_has_no_static_response():
    omega, one = np.array([0.0, 2.0]), np.ones((1, 1))
    with pytest.raises(ValueError, match="rigid-body mode"):
        ModalSystem(omega, np.full(2, 0.02), np.ones((2, 1)), np.ones((1, 2)), static=one)


def test_undamped_modes():
    with pytest.raises(ValueError, match="undamped mode"):
        frequency_response(one_mode(3.0, 0.0), [3.0])
    with pytest.raises(ValueError, match="zeta: expected damped modes"):
        peaks(one_mode(3.0, 0.0))


def test_peaks_above_a_rigid_body_mode():
    """Two free masses on a spring: 1/((m1 + m2) ω²) and the elastic mode, on a fine grid."""
    m, k = np.diag([2.0, 1.0]), 500.0 * np.array([[1.0, -1.0], [-1.0, 1.0]])
    omega = np.sqrt(500.0 * 1.5)
    phi = np.array([[1.0, 1.0], [1.0, -2.0]]) / np.sqrt([3.0, 6.0])
    system = ModalSystem(np.array([0.0, omega]), np.array([0.0, 0.03]), phi.T[:, :1], phi[:1])
    damping = m @ phi @ np.diag([0.0, 2 * 0.03 * omega]) @ phi.T @ m
    with pytest.raises(ValueError, match=r"zeta: .* found omega\[0\] = 0.0"):
        peaks(system)
    (result,) = peaks(system, band=(1.0, 50.0))
    w = result.omega + np.linspace(-1e-3, 1e-3, 201)
    exact = [abs(np.linalg.solve(k - x**2 * m + 1j * x * damping, [1, 0])[0]) for x in w]
    assert np.argmax(exact) == 100
    assert result.amplitude == pytest.approx(exact[100], rel=1e-12)
