"""Simulated tests: all modes, no others, and intervals that hold the truth."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from simulation import (
    THREE_STORY,
    THREE_STORY_DAMPING,
    accelerance,
    blows,
    circular,
    three_story_shapes,
)

from modefront._typing import Complexes, Floats
from modefront.data.modal_test import ModalTest, Records
from modefront.data.responses import Channel, assemble, frequency_responses
from modefront.data.uff import read_uff55
from modefront.identification import statistics
from modefront.identification.methods.hammer import identify
from modefront.identification.modal_model import maximise
from modefront.identification.modal_test import IdentifiedTest
from modefront.identification.problem import problem
from modefront.identification.scan import scan
from modefront.identification.sets import combine

F = np.arange(0.1, 30.05, 0.1)


def _scores(level: float, known: bool, force: float, runs: int) -> Floats:
    """Return errors over standard deviations of all quantities, one row a run."""
    phi = three_story_shapes()
    H = accelerance(F, THREE_STORY, THREE_STORY_DAMPING, phi, [0, 1, 2])
    out = []
    for seed in range(runs):
        measured = blows(H, level, np.random.default_rng(seed), force=force)
        data = frequency_responses(F, measured if known else measured.mean(axis=0))
        result = identify(data, (1, 30))
        assert [round(mode.frequency, 1) for mode in result.modes] == [4.6, 12.8, 17.9]
        row = []
        for r, mode in enumerate(result.modes):
            true = phi[r] / np.linalg.norm(phi[r])
            true = true * np.sign(true @ mode.shape.shape)
            row.append((mode.frequency - THREE_STORY[r]) / mode.frequency_std)
            row.append((mode.damping - THREE_STORY_DAMPING[r]) / mode.damping_std)
            row.extend((mode.shape.shape - true) / mode.shape_std)
        out.append(row)
    return np.array(out)


@pytest.mark.slow(5)
@pytest.mark.parametrize(
    ("level", "known", "force"), [(0.01, True, 0.0), (0.05, False, 0.0), (0.05, True, 0.05)]
)
def test_intervals_hold_the_truth(level: float, known: bool, force: float) -> None:
    scores = _scores(level, known, force, 12)
    assert 0.88 < np.mean(np.abs(scores) < 1.96) < 0.99
    assert 0.8 < scores.std() < 1.2


@pytest.mark.slow(2)
def test_variances_of_many_responses_are_the_diagonal_of_covariances(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    H = accelerance(F, THREE_STORY, THREE_STORY_DAMPING, three_story_shapes(), [0, 1, 2])
    data = frequency_responses(F, blows(H, 0.02, np.random.default_rng(0), force=0.02))
    whole = identify(data, (1, 30))
    monkeypatch.setattr(statistics, "MOST_COVARIED", 2)
    for one, mode in zip(identify(data, (1, 30)).modes, whole.modes, strict=True):
        assert one.shape_covariance is None
        assert mode.shape_covariance is not None
        np.testing.assert_allclose(one.shape_std, mode.shape_std, rtol=1e-9)
        size = np.linalg.norm(mode.shape_covariance)
        assert np.linalg.norm(mode.shape_covariance @ mode.shape.shape) < 1e-9 * size
        assert np.linalg.eigvalsh(mode.shape_covariance)[1] > 1e-4 * size


def _eight() -> tuple[Floats, Floats, Floats]:
    rng = np.random.default_rng(5)
    phi = np.linalg.qr(rng.standard_normal((10, 10)))[0][:8]
    phi[4] = 0  # a local mode: two sensors see it
    phi[4, [2, 7]] = 0.4, -0.3
    f0 = np.array([5.0, 9.0, 9.09, 14.0, 18.0, 21.0, 25.0, 29.0])
    zeta = np.array([0.01, 0.01, 0.01, 0.015, 0.01, 0.08, 0.01, 0.012])
    return f0, zeta, phi


@pytest.mark.parametrize("high", [29.5, pytest.param(30.0, marks=pytest.mark.slow(2))])
def test_close_local_heavily_damped_and_edge_modes_are_found(high: float) -> None:
    f0, zeta, phi = _eight()
    f = np.arange(0.05, 30.05, 0.05)
    H = accelerance(f, f0, zeta, phi, [0, 2, 9])
    data = frequency_responses(f, blows(H, 0.05, np.random.default_rng(0)))
    result = identify(data, (2, high))
    assert len(result.modes) == 8
    assert [mode.frequency for mode in result.modes] == pytest.approx(f0, rel=0.005)
    assert result.modes[5].damping == pytest.approx(0.08, rel=0.05)
    assert result.converged


def test_coherence_weights_and_tells_the_variance() -> None:
    phi = three_story_shapes()
    H = accelerance(F, THREE_STORY, THREE_STORY_DAMPING, phi, [2])
    rng = np.random.default_rng(3)
    measured = blows(H, 0.03, rng, count=10)
    deviation = 0.03**2 * np.mean(np.abs(H) ** 2, axis=-1, keepdims=True)
    coherence = np.abs(H) ** 2 / (np.abs(H) ** 2 + deviation)
    data = frequency_responses(F, measured.mean(axis=0), coherence=coherence, blows=10)
    result = identify(data, (1, 30))
    assert len(result.modes) == 3
    assert result.residuals.chi2 == pytest.approx(1, abs=0.15)


def test_a_dead_channel_and_gaps_are_left_out() -> None:
    phi = three_story_shapes()
    H = accelerance(F, THREE_STORY, THREE_STORY_DAMPING, phi, [1, 2])
    measured = blows(H, 0.01, np.random.default_rng(0)).mean(axis=0)
    measured[:, 1] = np.nan
    result = identify(frequency_responses(F, measured), (1, 30))
    assert len(result.modes) == 3
    assert np.isnan(result.modes[0].shape_std[1])
    assert np.isfinite(result.modes[0].shape_std[[0, 2]]).all()


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("size", [0.0, 0.002])
def test_a_channel_of_zeros_or_noise_is_left_empty_and_named(size: float, tmp_path: Path) -> None:
    phi = three_story_shapes()
    H = accelerance(F, THREE_STORY, THREE_STORY_DAMPING, phi, [1, 2])
    rng = np.random.default_rng(2)
    measured = blows(H, 0.01, rng)
    measured[:, :, 0] = size * circular(rng, measured[:, :, 0].shape)
    names = ("2", "3"), ("1", "2", "3")
    channels = [
        Channel("t", f"{b}", names[0][j], names[1][i], F, measured[b, j, i])
        for b, j, i in np.ndindex(measured.shape[:3])
    ]
    data_set = assemble(channels, "accelerance", "1", turned=False)
    result = identify(data_set.data, (1, 30))
    test = ModalTest("t", None, None, (data_set,))
    done = IdentifiedTest(test, (result,), combine(["1"], [result]), ())
    assert np.isnan(done.data.shape[0, :, 0]).all()
    assert np.isfinite(done.data.shape[0, :, 1:]).all()
    done.write(tmp_path / "modes.uff")
    assert len(read_uff55(tmp_path / "modes.uff").measured) == 2, "0 is not measured"
    expected = "1: nothing but noise at any mode" if size else "only zeros; the channel is left out"
    assert any(expected in text for text in done.warnings)
    for minutes in (30, 40):
        record = Records("1", ("1",), 1.0, np.zeros((1, 60 * minutes)))
        ambient = replace(done, test=replace(test, sets=(), setups=(record,)))
        assert any("records of more" in x for x in ambient.warnings) is (minutes > 35)


def test_a_mode_that_drifts_from_blow_to_blow_stays_one_mode() -> None:
    phi = three_story_shapes()
    drift = 1 + 0.002 * np.linspace(-1, 1, 5)
    H = np.mean(
        [accelerance(F, d * THREE_STORY, THREE_STORY_DAMPING, phi, [1, 2]) for d in drift], axis=0
    )
    measured = blows(H, 0.002, np.random.default_rng(0)).mean(axis=0)
    result = identify(frequency_responses(F, measured), (1, 30))
    assert [mode.frequency for mode in result.modes] == pytest.approx(THREE_STORY, rel=2e-4)
    assert all(mode.shape.collinearity > 0.99 for mode in result.modes)


def test_noise_alone_has_no_modes() -> None:
    rng = np.random.default_rng(0)
    H = rng.standard_normal((1, 3, 300)) + 1j * rng.standard_normal((1, 3, 300))
    result = identify(frequency_responses(np.arange(1, 301.0), H))
    assert result.modes == ()


def test_what_poles_explain_of_residuals_is_that_of_sums_over_lines() -> None:
    phi = three_story_shapes()
    f = np.delete(F, slice(40, 60))
    H = accelerance(f, THREE_STORY, THREE_STORY_DAMPING, phi, [1, 2])
    data = frequency_responses(f, blows(H, 0.05, np.random.default_rng(0)))
    assert data.variance is not None
    task, _, _ = problem(data, data.variance)
    r, nothing = task.H, np.zeros((0, len(task.s)), complex)
    found = scan(task, r, 1.0, nothing, np.zeros((2, 0, 0)))
    for k in range(0, len(found.lam), 37):
        e = task.s**2 / (task.s - found.lam[k])
        products = np.sum(task.weight * r * e.conj(), axis=2)
        z = products / np.sqrt(np.sum(task.weight * np.abs(e) ** 2, axis=2))
        explained = 2 * np.linalg.norm(z, 2) ** 2
        assert found.gain[k] * found.noise[k] == pytest.approx(explained, rel=1e-6)


def test_what_a_pole_explains_beside_a_close_one_is_what_a_fit_gains_by_it() -> None:
    phi = np.random.default_rng(1).standard_normal((3, 8))
    f0, zeta = np.array([10.0, 10.02, 16.0]), np.array([0.02, 0.022, 0.02])
    lam: Complexes = 2 * np.pi * f0 * (1j * np.sqrt(1 - zeta**2) - zeta)
    f = np.arange(0.05, 30.05, 0.05)
    H = accelerance(f, f0, zeta, phi, [0])
    data = frequency_responses(f, blows(H, 0.05, np.random.default_rng(0)))
    assert data.variance is not None
    task, omega, _ = problem(data, data.variance)
    one = maximise(task, lam[[0, 2]] / omega, np.ones((2, 1), complex))
    gain = one.found.gain * one.found.noise
    start: Complexes = np.append(one.lam, one.found.lam[gain.argmax()])
    gained = 2 * (one.cost - maximise(task, start, np.ones((3, 1), complex)).cost)
    assert gained > 100
    assert 0.8 * gained < gain.max() < 1.05 * gained
