"""The modal model: its derivatives, and exact data."""

import numpy as np
import pytest
import scipy.linalg as la
from simulation import THREE_STORY, THREE_STORY_DAMPING, accelerance, circular, three_story_shapes

from modefront._typing import Complexes, Floats
from modefront.data.responses import frequency_responses
from modefront.identification.lscf import ARC, moments, poles
from modefront.identification.modal_model import Fit, maximise, thinned
from modefront.identification.problem import Problem, gram, primitives, problem
from modefront.identification.statistics import correlated_gram, windowed_correlation


def _task(level: float = 0.01) -> tuple[Problem, float, float]:
    f = np.arange(0.1, 30, 0.1)
    H = accelerance(f, THREE_STORY, THREE_STORY_DAMPING, three_story_shapes(), [0, 2])
    rng = np.random.default_rng(1)
    noise = level * np.abs(H).std() * circular(rng, H.shape)
    data = frequency_responses(f, H + noise).within(1, 30)
    return problem(data, np.full(data.H.shape, (level * np.abs(H).std()) ** 2))


def _somewhere(omega: float) -> tuple[Complexes, Complexes]:
    lam: Complexes = np.asarray(2 * np.pi / omega * 1.004 * THREE_STORY * (1j - 0.015), complex)
    return lam, circular(np.random.default_rng(2), (3, 2))


def _costs(fit: Fit, step: Floats) -> tuple[float, float]:
    """Return the cost a step of alpha away, there and back."""
    out = []
    for sign in (1, -1):
        lam, L = fit.lam.copy(), fit.L.copy()
        for k, r, v in fit.alphas:
            z = sign * complex(*step[2 * k : 2 * k + 2])
            if v is None:
                lam[r] += z
            else:
                L[r] += z * v
        out.append(Fit(fit.task, lam, L, fit.pairs).cost)
    return out[0], out[1]


@pytest.mark.parametrize("pairs", [(), ((0, 2),)])
def test_the_gradient_is_that_of_the_projected_cost(pairs: tuple[tuple[int, int], ...]) -> None:
    task, omega, _ = _task()
    lam, L = _somewhere(omega)
    for pair in map(list, pairs):
        lam[pair] = lam[pair].mean()
    fit = Fit(task, lam, L, pairs)
    assert len(fit.gradient) == (4 + 2 if pairs else 6 + 6)
    for k in range(len(fit.gradient)):
        h = 1e-6 * (abs(lam[k // 2]) if k < 6 else 1.0)
        there, back = _costs(fit, h * np.eye(len(fit.gradient))[k])
        assert (there - back) / (4 * h) == pytest.approx(fit.gradient[k], rel=2e-5)


def test_gram_matrices_are_those_of_the_stacked_columns() -> None:
    task, omega, _ = _task()
    E = primitives(task, _somewhere(omega)[0])
    columns = np.sqrt(task.weight[1, 2]) * E
    stacked = np.hstack([columns.real, columns.imag])
    assert gram(task, E)[1, 2] == pytest.approx(stacked @ stacked.T, rel=1e-10)


def test_means_of_residuals_have_nearly_the_maximum_of_all_lines() -> None:
    f = np.arange(1.0, 30.0, 0.02)
    H = accelerance(f, THREE_STORY, THREE_STORY_DAMPING, three_story_shapes(), [0, 2])
    noise = 1e-3 * np.abs(H).std() * circular(np.random.default_rng(1), H.shape)
    data = frequency_responses(f, H + noise)
    task, omega, _ = problem(data, np.full(H.shape, (1e-3 * np.abs(H).std()) ** 2))
    fit = maximise(task, *_somewhere(omega))
    few = thinned(fit, fit.lam)
    assert 3 * len(few.s) < len(task.s)
    again = maximise(few, 1.0005 * fit.lam, fit.L)
    moved = again.lam - fit.lam
    deviation = np.sqrt(fit.inverted(fit.information).diagonal()[:6] / 2)
    assert (np.abs(moved.view(float)) < 0.3 * deviation).all()


def test_exact_data_give_exact_modes() -> None:
    f = np.arange(0.1, 30, 0.1)
    H = accelerance(f, THREE_STORY, THREE_STORY_DAMPING, three_story_shapes(), [0, 2])
    data = frequency_responses(f, H).within(1, 30)
    task, omega, size = problem(data, np.full(data.H.shape, 1e-18))
    fit = maximise(task, *_somewhere(omega))
    assert fit.converged
    result = fit.lam * omega / (2 * np.pi)
    assert np.abs(result) == pytest.approx(THREE_STORY, rel=1e-8)
    assert -result.real / np.abs(result) == pytest.approx(THREE_STORY_DAMPING, rel=1e-7)
    assert np.abs(fit.functions * size - data.H).max() < 1e-8 * np.abs(data.H).max()


def test_a_pole_on_the_imaginary_axis_does_not_hold_up_the_others() -> None:
    task, omega, _ = _task()
    lam, L = _somewhere(omega)
    alone = maximise(task, lam, L)
    undamped = np.append(lam, 1.02j - 1e-12)
    fit = maximise(task, undamped, np.vstack([L, L[:1]]))
    assert fit.cost < alone.cost * (1 + 1e-6)
    assert fit.lam[:3] == pytest.approx(alone.lam, rel=1e-3)


@pytest.mark.parametrize("references", [[0], [0, 2]])
def test_lscf_finds_the_poles_of_exact_data_at_the_first_order_that_holds_them(
    references: list[int],
) -> None:
    f = np.arange(1, 30, 0.1)
    H = accelerance(f, THREE_STORY, THREE_STORY_DAMPING, three_story_shapes(), references)
    omega = 2 * np.pi * f
    rate = 2 * np.pi * ARC / (omega[-1] - omega[0])
    z = np.exp(1j * rate * (omega - omega[0]))
    sums = moments(H, np.ones(len(f)), z, 16)
    result, _ = poles(sums, 16, omega[0], rate)
    for f0, zeta in zip(THREE_STORY, THREE_STORY_DAMPING, strict=True):
        true = 2 * np.pi * f0 * (-zeta + 1j * np.sqrt(1 - zeta**2))
        assert np.abs(result - true).min() < 1e-4 * abs(true)


def test_correlated_lines_have_the_gram_matrix_of_their_covariance() -> None:
    task, omega, _ = _task()
    E = primitives(task, _somewhere(omega)[0])
    rho = windowed_correlation(3.0, len(task.s))
    covariance = la.toeplitz(rho, rho.conj())
    a = np.sqrt(task.weight[1, 2]) * E
    expected = (a.conj() @ covariance @ a.T).real
    result = correlated_gram(task, E, rho)[1, 2]
    size = np.sqrt(np.outer(expected.diagonal(), expected.diagonal()))
    assert (np.abs(result - expected) < 1e-10 * size).all()
