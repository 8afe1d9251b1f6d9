"""Functions from impacts in time: exact ones, windows, bad blows."""

import numpy as np
import pytest

from modefront._typing import Floats
from modefront.data.impact import Estimator, Windows, impact_responses
from modefront.identification.methods.hammer import identify

RATE, SAMPLES = 256.0, 2048


def _records(blows: int) -> tuple[Floats, Floats]:
    """Return force and displacement of one oscillator, 10 Hz and 2 %, hit by half sines."""
    t = np.arange(SAMPLES) / RATE
    omega, zeta = 2 * np.pi * 10.0, 0.02
    damped = omega * np.sqrt(1 - zeta**2)
    h = np.exp(-zeta * omega * t) * np.sin(damped * t) / damped / RATE
    rng = np.random.default_rng(0)
    x = np.zeros((blows, SAMPLES))
    x[:, 10:16] = np.sin(np.pi * np.arange(1, 7) / 7) * rng.uniform(5, 9, (blows, 1))
    y = np.array([np.convolve(row, h)[:SAMPLES] for row in x])[:, None]
    return x, y


@pytest.mark.parametrize("estimator", ["H1", "H2", "Hv"])
def test_all_estimators_are_the_transfer_function_without_noise(estimator: Estimator) -> None:
    x, y = _records(3)
    result = impact_responses(x, y, RATE, "receptance", Windows(estimator, exponential=np.inf))
    s = 2j * np.pi * result.data.frequency
    omega, zeta = 2 * np.pi * 10.0, 0.02
    exact = 1 / (s**2 + 2 * zeta * omega * s + omega**2)
    band = (result.data.frequency > 5) & (result.data.frequency < 15)
    assert np.abs(result.data.H[0, 0] - exact)[band].max() < 0.01 * np.abs(exact).max()
    assert result.coherence[0, band] == pytest.approx(1)


def test_the_damping_of_the_exponential_window_is_taken_off() -> None:
    x, y = _records(3)
    result = impact_responses(x, y, RATE, "receptance", Windows(exponential=1.0))
    modes = identify(result.data, (5, 15)).modes
    assert len(modes) == 1
    assert modes[0].frequency == pytest.approx(10.0, rel=1e-3)
    assert modes[0].damping == pytest.approx(0.02, rel=0.01)


def test_double_hits_and_overloads_are_left_out() -> None:
    x, y = _records(4)
    x[1, 60:64] = 3.0
    y[2] = np.clip(y[2], -0.5 * y[2].max(), 0.5 * y[2].max())
    result = impact_responses(x, y, RATE, "receptance")
    assert [bool(why) for why in result.left_out] == [False, True, True, False]
    assert "second hit" in result.left_out[1]
    assert "overloaded" in result.left_out[2]


def test_filters_that_ring_and_coarse_digits_are_no_faults() -> None:
    x, y = _records(2)
    x[:, 16] = -0.2 * x.max(axis=1)
    y = np.round(y / y.max() * 200)
    assert impact_responses(x, y, RATE, "receptance").left_out == ("", "")


def test_no_good_blow_is_an_error() -> None:
    x, y = _records(2)
    with pytest.raises(ValueError, match="at least one good blow"):
        impact_responses(0 * x, y, RATE)


def test_the_variance_is_that_of_the_mean_also_where_hard_blows_are_noisy() -> None:
    rng = np.random.default_rng(1)
    size = np.array([0.5, 1.0, 1.0, 1.5])
    x = np.zeros((4, 64))
    x[:, 0] = size
    y = np.zeros((300, 4, 1, 64))
    y[..., 0] = size[:, None]
    y += 0.01 * size[:, None, None] * rng.standard_normal(y.shape)
    parts = [impact_responses(x, row, 64.0, windows=Windows(exponential=np.inf)) for row in y]
    known = [part.data.variance for part in parts if part.data.variance is not None]
    given = np.mean([np.mean(variance[0, 0, 1:-1]) for variance in known])
    true = np.mean([np.mean(np.abs(part.data.H[0, 0, 1:-1] - 1) ** 2) for part in parts])
    assert given == pytest.approx(true, rel=0.2)


def test_the_noise_of_the_force_is_measured_after_the_impact() -> None:
    rng = np.random.default_rng(1)
    x, y = np.zeros((200, 256)), np.zeros((200, 1, 256))
    x[:, 4], y[:, 0, 4] = 1.0, 1.0
    x += 1e-3 * rng.standard_normal(x.shape)
    windows = Windows(force_window=0.25, exponential=np.inf)
    parts = [
        impact_responses(x[b : b + 4], y[b : b + 4], 64.0, windows=windows)
        for b in range(0, 200, 4)
    ]
    errors = np.array([part.data.H[0, 0, 1:-1] - 1 for part in parts])
    (noise,) = parts[0].data.force_noise
    assert np.mean(np.abs(errors) ** 2) == pytest.approx(np.mean(noise.deviation**2), rel=0.2)
    assert noise.times[[0, -1]] == pytest.approx([-4 / 64, 0.25], abs=2 / 64)
    step = 64 / 256
    rho = np.sum(noise.share * np.exp(-2j * np.pi * step * noise.times))
    near = np.mean(errors[:, 1:] * errors[:, :-1].conj()) / np.mean(np.abs(errors) ** 2)
    assert abs(near - rho) < 0.05
