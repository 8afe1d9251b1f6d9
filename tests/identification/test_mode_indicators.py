"""Mode indicator functions peak and dip at modes."""

import numpy as np
from simulation import accelerance

from modefront.data.responses import FrequencyResponses, frequency_responses
from modefront.identification.stabilisation import complex_indicators, multivariate_indicators

F = np.arange(1.0, 40.0, 0.05)


def repeated() -> FrequencyResponses:
    phi = np.linalg.qr(np.random.default_rng(4).standard_normal((8, 8)))[0][:4]
    H = accelerance(F, np.array([7.0, 15.0, 15.0, 31.0]), np.full(4, 0.01), phi, (0, 5))
    return frequency_responses(F, H)


def test_complex_indicators_peak_twice_where_a_mode_is_repeated() -> None:
    first, second = complex_indicators(repeated())
    for f in (7.0, 15.0, 31.0):
        near = np.abs(F - f) < 1.0
        assert abs(F[near][first[near].argmax()] - f) < 0.1
    near = np.abs(F - 15.0) < 1.0
    assert abs(F[near][second[near].argmax()] - 15.0) < 0.1
    assert second[near].max() > 20 * np.median(second[(F > 20) & (F < 28)])


def test_multivariate_indicators_dip_at_modes() -> None:
    first, second = multivariate_indicators(repeated())
    at = [np.abs(F - f).argmin() for f in (7.0, 15.0, 31.0)]
    assert (first[at] < 0.1).all()
    assert second[at[1]] < 0.1 < 0.5 < second[at[0]]
    assert np.median(first) > 0.9
