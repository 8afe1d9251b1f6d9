"""Modes of several sets: which are the same, where data turn the shapes of close ones."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from modefront._typing import Floats
from modefront.identification.record import ModeEstimate
from modefront.identification.sets import combine, mode_groups
from modefront.identification.shapes import real_shape

SENSORS = tuple("abcd")


def _set(
    frequencies: list[float], shapes: Floats, damping: tuple[float, float] = (0.01, 0.01)
) -> tuple[tuple[str, ...], list[ModeEstimate]]:
    """Return sensors and modes of a set."""
    return SENSORS, [
        ModeEstimate(
            2 * np.pi * f * (1j * np.sqrt(1 - zeta**2) - zeta),
            0.001,
            0.001,
            real_shape(phi + 0j),
            phi,
            np.zeros(0, complex),
        )
        for f, phi, zeta in zip(frequencies, shapes, damping, strict=False)
    ]


def _turned(shapes: Floats, degrees: float) -> Floats:
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    out: Floats = np.array([[c, s], [-s, c]]) @ shapes
    return out


def test_close_modes_that_a_set_turns_in_their_plane_keep_one_number_each() -> None:
    rng = np.random.default_rng(0)
    for degrees in range(0, 180, 15):
        plane = np.linalg.qr(rng.standard_normal((4, 2)))[0].T
        sets = [
            _set([5.0, 5.05], plane),
            _set([5.01, 5.06], _turned(plane, degrees)),
            _set([5.02], _turned(plane, degrees / 2)[1:]),
        ]
        groups = mode_groups(sets)
        assert len(groups) == 2
        assert sorted(len(group) for group in groups) == [2, 3]


def test_shapes_choose_among_close_modes() -> None:
    plane = np.linalg.qr(np.random.default_rng(1).standard_normal((4, 2)))[0].T
    sets = [_set([5.0, 5.05], plane), _set([5.02, 5.03], plane[::-1])]
    assert mode_groups(sets) == [{0: 0, 1: 1}, {0: 1, 1: 0}]


def test_damping_chooses_among_close_modes_of_turned_shapes() -> None:
    plane = np.linalg.qr(np.random.default_rng(1).standard_normal((4, 2)))[0].T
    sets = [_set([5, 5], plane, (0.025, 0.006)), _set([5, 5], _turned(plane, 40), (0.006, 0.025))]
    assert sorted(mode_groups(sets), key=lambda x: x[0]) == [{0: 0, 1: 1}, {0: 1, 1: 0}]


@pytest.mark.parametrize(("std", "groups"), [(0.01, 2), (0.4, 1)])
def test_shapes_that_data_do_not_tell_apart_are_of_one_mode(std: float, groups: int) -> None:
    basis = np.linalg.qr(np.random.default_rng(3).standard_normal((4, 4)))[0].T
    sets = []
    for phi in (basis[:1], 0.6 * basis[:1] + 0.8 * basis[1:2]):
        names, (mode,) = _set([5.0], phi)
        C = std**2 * (np.eye(4) - np.outer(phi, phi))
        sets.append((names, [replace(mode, shape_covariance=C)]))
    assert len(mode_groups(sets)) == groups


def test_shapes_outside_the_plane_and_modes_apart_are_others() -> None:
    basis = np.linalg.qr(np.random.default_rng(2).standard_normal((4, 4)))[0].T
    sets = [_set([5.0, 5.05], basis[:2]), _set([5.0, 5.5], basis[[2, 0]])]
    assert len(mode_groups(sets)) == 4


@pytest.mark.parametrize("order", ["ab bc cd", "ab cd bc", "cd ab bc"])
def test_sets_that_others_join_to_the_first_one_have_its_sign_and_no_spread(order: str) -> None:
    shape, sets = dict(zip(SENSORS, [1.0, -3.0, 2.0, 0.5], strict=True)), list[Any]()
    for names in order.split():
        phi = np.array([shape[name] for name in names])
        C = 1e-6 * np.eye(2)
        _, (mode,) = _set([5.0], (phi / np.linalg.norm(phi))[None])
        mode = replace(mode, shape_std=np.full(2, 1e-3), shape_covariance=C)
        sets.append(SimpleNamespace(responses=tuple(names), modes=(mode,), pairs=()))
    data = combine(order.split(), sets).data
    assert data.modes == (1,)
    np.testing.assert_allclose(data.shape_std[np.isfinite(data.shape)], 1e-3, rtol=1e-6)
    at = data.shape[:, 0] * np.sign(data.shape[0, 0][np.isfinite(data.shape[0, 0])][0])
    ratio = at / [shape[name] for name in data.sensors]
    assert len({*np.sign(ratio[np.isfinite(ratio)]).tolist()}) == 1
