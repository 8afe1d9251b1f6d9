"""The MAC and the pairs that it leads to."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from modefront._typing import Floats
from modefront.data.modal import modal_data
from modefront.linalg.small import mac
from modefront.optim.scalarisation import LogSum
from modefront.pairing.match import Pairing, mac_slopes, match, mean_mac, modes_needed


@given(st.integers(0, 2**31), st.booleans())
def test_mac_is_between_0_and_1_and_free_of_scale(seed: int, is_complex: bool) -> None:
    rng = np.random.default_rng(seed)
    phi, psi = (rng.normal(size=(4, 3)) + 1j * is_complex * rng.normal(size=(4, 3)) for _ in "ab")
    values = mac(phi, psi)
    assert (values >= 0).all()
    assert (values <= 1 + 1e-12).all()
    scales = rng.normal(size=3) + 1j * rng.normal(size=3)
    assert mac(phi * scales, psi) == pytest.approx(values, rel=1e-9)
    assert np.diag(mac(phi, phi)) == pytest.approx(1)
    assert mac(psi, phi) == pytest.approx(values.T, rel=1e-9)


def test_mac_of_a_shape_that_vanishes_is_0() -> None:
    assert mac(np.zeros((2, 1)), np.ones((2, 1))) == 0


SENSORS = ("a", "b", "c")


def test_modes_are_paired_by_shape_whatever_their_order() -> None:
    data = modal_data(np.array([1.0, 2.0, 3.0]), np.eye(3), SENSORS)
    model = np.eye(3)[:, [1, 2, 0]]
    pairs = match(Pairing(), data, np.array([1.0, 2.0, 3.0]), model)
    assert pairs.index.tolist() == [2, 0, 1]
    assert pairs.mac == pytest.approx(1)


def test_two_measured_modes_never_share_a_model_mode() -> None:
    data = modal_data(np.array([1.0, 2.0]), np.array([[1, 0.1, 0], [1, -0.1, 0]]), SENSORS)
    pairs = match(Pairing(), data, np.array([1.0, 2.0]), np.array([[1.0, 0], [0, 1], [0, 0]]))
    assert sorted(pairs.index) == [0, 1]


def test_a_frequency_without_shape_takes_the_nearest_mode() -> None:
    shapes = np.array([[1.0, 0, 0], [np.nan, np.nan, np.nan]])
    data = modal_data(np.array([5.0, 2.0]), shapes, SENSORS)
    pairs = match(Pairing(), data, np.array([1.9, 5.0, 9.0]), np.eye(3)[:, [1, 0, 2]])
    assert pairs.index.tolist() == [1, 0]
    assert pairs.mac[0] == pytest.approx(1)
    assert np.isnan(pairs.mac[1])


def test_a_shape_without_frequency_is_paired_by_likelihood_too() -> None:
    data = modal_data(np.array([1.0, np.nan]), np.eye(3)[:2], SENSORS)
    squares = np.array([[[0.0, 4.0, 4.0], [4.0, 4.0, 0.0]]])  # of one group
    one = np.ones(1)
    f, phi = np.array([1.0, 2.0, 3.0]), np.eye(3)[:, [0, 2, 1]]
    for window in (None, 1.5):
        pairs = match(Pairing(window=window), data, f, phi, squares, LogSum(one, one))
        assert pairs.index.tolist() == [0, 2]


def test_the_window_keeps_distant_frequencies_out() -> None:
    data = modal_data(np.array([1.0]), np.array([[1.0, 0.2, 0]]), SENSORS)
    f, phi = np.array([1.1, 10.0]), np.array([[0.9, 1], [0.5, 0.2], [0, 0]])
    assert match(Pairing(), data, f, phi).index.tolist() == [1]
    assert match(Pairing(window=2.0), data, f, phi).index.tolist() == [0]


def test_order_on_request() -> None:
    data = modal_data(np.array([1.0, 2.0]), np.eye(3)[:2], SENSORS)
    pairs = match(Pairing("order"), data, np.array([1.0, 2.0]), np.eye(3)[:, [1, 0]])
    assert pairs.index.tolist() == [0, 1]
    assert pairs.mac == pytest.approx(0)
    assert modes_needed(Pairing("order"), data, 100) == 2
    assert modes_needed(Pairing(spare=3), data, 100) == 5
    assert modes_needed(Pairing(spare=3), data, 4) == 4


def test_values_are_means_over_data_sets_at_the_sensors_that_measured() -> None:
    nan = np.nan
    shapes = np.array([[[1.0, 0, nan]], [[1.0, nan, 1.0]]])
    data = modal_data(np.array([[1.0], [1.0]]), shapes, SENSORS)
    pairs = match(Pairing(), data, np.array([1.0]), np.array([[1.0], [0.0], [0.0]]))
    assert pairs.mac == pytest.approx((1 + 0.5) / 2)


def test_slopes_of_the_mac_are_those_of_differences() -> None:
    """Of two data sets, one of which lacks a component; no mode is normalised."""
    rng = np.random.default_rng(4)
    shape = rng.normal(size=(2, 2, 4))
    shape[1, 0, 3] = np.nan
    f = np.array([[1.0, 2.0]] * 2)
    data = modal_data(f, shape, ("a", "b", "c", "d"))
    phi, dphi = rng.normal(size=(4, 3)), rng.normal(size=(4, 3, 2))
    pairs = match(Pairing(), data, np.array([1.0, 2.0, 3.0]), phi)

    def values(step: list[float]) -> Floats:
        return mean_mac(data, phi + dphi @ step)[np.arange(2), pairs.index]

    h = 1e-6
    expected = [
        (values(step) - values([-x for x in step])) / (2 * h) for step in ([h, 0.0], [0.0, h])
    ]
    assert mac_slopes(data, pairs, phi, dphi) == pytest.approx(np.transpose(expected), rel=1e-6)
