"""The map from normal numbers to responses, against independent integrators and spectra."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.signal import StateSpace, lsim

from modefront.predictions.reliability import (
    Convolution,
    FirstPassage,
    gaussian_response,
    pulse_response,
)
from modefront.predictions.system import ModalSystem

SYSTEM = ModalSystem(
    omega=np.array([0.0, 6.0, 9.0]),
    zeta=np.array([0.0, 0.02, 1.4]),
    input=np.array([[1.0, 0.3], [-0.5, 2.0], [1.5, 1.0]]),
    output=np.array([[0.1, 1.0, 0.5], [0.0, -2.0, 0.7], [0.2, 0.3, 0.0]]),
)
SOIL = (15.0, 0.6)
NOISE = 2 * np.pi * 0.7


def state_space(system, soil):
    """Return the whole structure, behind one filter an input, as ẋ = A x + B w, y = C x."""
    m, k = system.input.shape
    structure = np.zeros((2 * m, 2 * m))
    structure[:m, m:] = np.eye(m)
    structure[m:, :m] = -np.diag(system.omega**2)
    structure[m:, m:] = -np.diag(2 * system.zeta * system.omega)
    load = np.vstack([np.zeros((m, k)), system.input])
    c = np.hstack([system.output, np.zeros_like(system.output)])
    if soil is None:
        return structure, load, c
    w, z = soil
    filters = np.kron(np.eye(k), [[0.0, 1.0], [-(w**2), -2 * z * w]])
    drive = np.kron(np.eye(k), [[0.0], [1.0]])
    read = np.kron(np.eye(k), [[w**2, 2 * z * w]])
    a = np.block([[structure, load @ read], [np.zeros((2 * k, 2 * m)), filters]])
    return (
        a,
        np.vstack([np.zeros((2 * m, k)), drive]),
        np.hstack([c, np.zeros((len(c), 2 * k))]),
    )


@pytest.mark.parametrize("soil", [None, SOIL], ids=["white", "filtered"])
@pytest.mark.parametrize("modulation", [None, lambda t: t * np.exp(-t)], ids=["", "modulated"])
def test_responses_are_those_of_the_whole_structure_integrated(soil, modulation):
    problem = FirstPassage(SYSTEM, NOISE, 8.0, 0.05, soil=soil, modulation=modulation)
    z = np.random.default_rng(3).standard_normal((2, 2, 160))
    result = np.array([x.copy() for x in Convolution(gaussian_response(problem), 5).magnitudes(z)])
    a, b, c = state_space(SYSTEM, soil)
    middle = (np.arange(160) + 0.5) * 0.05
    q = np.ones(160) if modulation is None else modulation(middle)
    w = np.sqrt(2 * np.pi * 0.7 / 0.05) * q * z
    for sample in range(2):
        held = np.vstack([w[sample].T, np.zeros((1, 2))])
        plant = StateSpace(a, b, c, np.zeros((3, 2)))
        _, y, _ = lsim(plant, held, np.arange(161) * 0.05, interp=False)
        np.testing.assert_allclose(result[:, sample], abs(y[1:].T), rtol=1e-9, atol=1e-11)


@pytest.mark.parametrize("soil", [None, SOIL], ids=["white", "filtered"])
def test_design_excitations_give_the_response_and_its_deviation(soil):
    problem = FirstPassage(SYSTEM, NOISE, 2.0, 0.05, soil=soil, modulation=np.cos)
    response = gaussian_response(problem)
    output, step = (grid.ravel() for grid in np.indices((3, 40)))
    a = response.design_excitation(output, step)
    z = np.random.default_rng(1).standard_normal((1, 2, 40))
    x = np.array([x[0].copy() for x in Convolution(response, 1).magnitudes(z)])
    scale = response.deviation.max()
    projected = abs(np.einsum("eik,ik->e", a, z[0]))
    np.testing.assert_allclose(projected.reshape(3, 40), x, atol=1e-13 * scale)
    length = np.sqrt(np.einsum("eik,eik->e", a, a)).reshape(3, 40)
    np.testing.assert_allclose(length, response.deviation, atol=1e-7 * scale, rtol=1e-9)


def oscillator(omega, zeta):
    return ModalSystem(np.array([omega]), np.array([zeta]), np.eye(1), np.eye(1))


def deviation_at_the_end(problem):
    return gaussian_response(problem).deviation[0, -1]


def test_stationary_deviation_under_white_noise():
    """σ² = πS/(2ζω³) as Δt → 0, with an error that falls as Δt²."""
    exact = np.sqrt(np.pi * 1.3 / (2 * 0.05 * 7.85**3))
    problem = FirstPassage(oscillator(7.85, 0.05), 2 * np.pi * 1.3, 40.0, 0.04)
    coarse = deviation_at_the_end(problem) / exact - 1
    fine = deviation_at_the_end(replace(problem, time_step=0.02)) / exact - 1
    assert abs(fine) < 3e-3
    assert coarse / fine == pytest.approx(4, rel=0.02)


def test_stationary_deviation_behind_the_filter():
    """σ² = S ∫ |F|² |H|² dω."""
    problem = FirstPassage(oscillator(7.85, 0.05), NOISE, 40.0, 0.005, soil=SOIL)

    def density(w):
        soil = (15**2 + 2j * 0.6 * 15 * w) / (15**2 - w**2 + 2j * 0.6 * 15 * w)
        return 0.7 * abs(soil / (7.85**2 - w**2 + 2j * 0.05 * 7.85 * w)) ** 2

    variance = 2 * quad(density, 0, 300, points=[7.85, 15.0], limit=200)[0]
    assert deviation_at_the_end(problem) == pytest.approx(np.sqrt(variance), rel=1e-3)


def test_modulation_is_taken_at_the_middle_of_a_step():
    """Noise that stops halfway leaves free vibration: the deviation of an earlier end, decayed."""
    system = oscillator(7.85, 0.02)
    whole = FirstPassage(system, NOISE, 10.0, 0.02, modulation=lambda t: (t < 5.0).astype(float))
    half = FirstPassage(system, NOISE, 5.0, 0.02)
    early = gaussian_response(half).deviation[0]
    both = gaussian_response(whole).deviation[0]
    np.testing.assert_allclose(both[:250], early, rtol=1e-7)
    envelope = early[-1] * np.exp(-0.02 * 7.85 * (np.arange(1, 251) * 0.02))
    np.testing.assert_allclose(both[250:], envelope, rtol=0.06)


def test_pulse_response_does_not_depend_on_how_many_steps_are_asked_for():
    short = pulse_response(FirstPassage(SYSTEM, NOISE, 0.65, 0.05))
    long = pulse_response(FirstPassage(SYSTEM, NOISE, 6.5, 0.05))
    assert short.shape == (3, 2, 13)
    np.testing.assert_array_equal(long[..., :13], short)
