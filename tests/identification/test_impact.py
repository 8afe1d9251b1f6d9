"""Functions from impacts in time: exact ones, windows, bad blows."""

import numpy as np
import pytest

from modefront._typing import Floats
from modefront.data.impact import Estimator, impact_responses
from modefront.identification.identify import identify

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
    y = np.array([np.convolve(one, h)[:SAMPLES] for one in x])[:, None]
    return x, y


@pytest.mark.parametrize("estimator", ["H1", "H2", "Hv"])
def test_all_estimators_are_the_transfer_function_without_noise(estimator: Estimator) -> None:
    x, y = _records(3)
    found = impact_responses(x, y, RATE, "receptance", estimator=estimator, exponential=np.inf)
    s = 2j * np.pi * found.data.frequency
    omega, zeta = 2 * np.pi * 10.0, 0.02
    exact = 1 / (s**2 + 2 * zeta * omega * s + omega**2)
    band = (found.data.frequency > 5) & (found.data.frequency < 15)
    assert np.abs(found.data.H[0, 0] - exact)[band].max() < 0.01 * np.abs(exact).max()
    assert found.coherence[0, band] == pytest.approx(1)


def test_the_damping_of_the_exponential_window_is_taken_off() -> None:
    x, y = _records(3)
    found = impact_responses(x, y, RATE, "receptance", exponential=1.0)
    modes = identify(found.data, (5, 15)).modes
    assert len(modes) == 1
    assert modes[0].frequency == pytest.approx(10.0, rel=1e-3)
    assert modes[0].damping == pytest.approx(0.02, rel=0.01)


def test_double_hits_and_overloads_are_left_out() -> None:
    x, y = _records(4)
    x[1, 60:64] = 3.0
    y[2] = np.clip(y[2], -0.5 * y[2].max(), 0.5 * y[2].max())
    found = impact_responses(x, y, RATE, "receptance")
    assert [bool(why) for why in found.left_out] == [False, True, True, False]
    assert "second hit" in found.left_out[1]
    assert "overloaded" in found.left_out[2]


def test_filters_that_ring_and_coarse_digits_are_no_faults() -> None:
    x, y = _records(2)
    x[:, 16] = -0.2 * x.max(axis=1)
    y = np.round(y / y.max() * 200)
    assert impact_responses(x, y, RATE, "receptance").left_out == ("", "")


def test_no_good_blow_is_an_error() -> None:
    x, y = _records(2)
    with pytest.raises(ValueError, match="at least one good blow"):
        impact_responses(0 * x, y, RATE)
