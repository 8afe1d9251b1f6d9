"""Ambient tests: the likelihood and its derivatives, shapes of setups, modes and harmonics."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import scipy.signal as signal

from modefront._typing import Complexes, Floats
from modefront.data.modal_test import Records
from modefront.identification import spectral_density
from modefront.identification.harmonics import without_sine
from modefront.identification.methods.ambient import (
    Local,
    _above,
    _fitted,
    _harmonic,
    _overlapping,
    _Setup,
    _starts,
    identify,
)
from modefront.identification.sets import merged_shape
from modefront.identification.spectra import Transforms, transforms
from modefront.identification.spectral_density import Band, Density

SENSORS, LINES = 4, 30


def _model(rng: np.random.Generator) -> Density:
    phi = rng.standard_normal((SENSORS, 3))
    root = np.tril(_circular(rng, 3, 3)) + 2 * np.eye(3)
    half = rng.standard_normal((SENSORS, SENSORS))
    background = half @ half.T / 50 + 0.02 * np.eye(SENSORS)
    poles = np.array([10.0, 10.3, 12.0]), np.array([0.01, 0.02, 0.015])
    return Density(
        *poles, phi / np.linalg.norm(phi, axis=0), root, background, 2, np.zeros((SENSORS, 0)), 10.0
    )


def _circular(rng: np.random.Generator, *shape: int) -> Complexes:
    out: Complexes = rng.standard_normal(shape) + 1j * rng.standard_normal(shape)
    return out


def _band(rng: np.random.Generator) -> Band:
    F = _circular(rng, LINES, 2, SENSORS)
    power = np.einsum("kbi,kbj->kij", F, F.conj()) / 2
    return Band(np.linspace(9, 11, LINES), np.full(LINES, 2.0), power, 2, np.full(SENSORS, 0.1))


def _density(band: Band, model: Density) -> Complexes:
    """Return E at all lines as its definition has it."""
    h = model.response(band.omega, band.order)
    a = np.einsum("jr,rk->kjr", model.phi, h)
    y = band.omega / model.middle - 1
    for term in range(model.coherent.shape[1] // 2):
        part = model.coherent[:, 2 * term : 2 * term + 2]
        a[:, :, :2] += y[:, None, None] ** term * part
    out: Complexes = a @ model.force @ a.conj().swapaxes(1, 2) + model.background
    return out


def _moved(model: Density, parameter: int, step: float) -> Density:
    constants = model.coherent.size
    change = np.zeros(2 * SENSORS + constants + 4 + 9)
    change[parameter] = step
    parts = np.cumsum([2 * SENSORS, constants, 2, 2])
    shapes, constant, omega, zeta, root = np.split(change, parts)
    coherent = model.coherent + constant.reshape(-1, SENSORS).T
    phi, L = model.phi.copy(), model.root.copy()
    phi[:, :2] += shapes.reshape(2, SENSORS).T
    lower = [(0, 0, 1), (1, 0, 1), (1, 0, 1j), (1, 1, 1), (2, 0, 1), (2, 0, 1j)]
    lower += [(2, 1, 1), (2, 1, 1j), (2, 2, 1)]
    for value, (i, j, unit) in zip(root, lower, strict=True):
        L[i, j] += unit * value
    new_omega = model.omega * np.exp(np.append(omega, 0))
    new_zeta = model.zeta * np.exp(np.append(zeta, 0))
    return replace(model, omega=new_omega, zeta=new_zeta, phi=phi, root=L, coherent=coherent)


@pytest.mark.parametrize("coherent", [0, 4])
def test_cost_and_derivatives_are_those_of_the_whole_density(coherent: int) -> None:
    rng = np.random.default_rng(0)
    model, band = _model(rng), _band(rng)
    R, precision = 0.3 * rng.standard_normal((SENSORS, coherent)), np.arange(1.0, coherent + 1)
    model = replace(model, coherent=R, middle=9.5, precision=precision)
    fit = spectral_density.Fit(band, model)

    def cost(model: Density) -> float:
        E, B = _density(band, model), model.background
        single = np.linalg.slogdet(E)[1] + np.einsum("kii->k", np.linalg.solve(E, band.power)).real
        prior = np.linalg.slogdet(B)[1] + np.linalg.inv(B).diagonal() @ band.floor
        prior = (spectral_density.PRIOR + SENSORS) * prior
        return float(band.count @ single + prior + precision @ (model.coherent**2).sum(axis=0) / 2)

    count, step = len(fit.gradient), 1e-6
    pairs = [(_moved(model, k, step), _moved(model, k, -step)) for k in range(count)]
    assert fit.cost == pytest.approx(cost(model), rel=1e-12)
    slopes = [(cost(a) - cost(b)) / (2 * step) for a, b in pairs]
    np.testing.assert_allclose(fit.gradient, slopes, atol=1e-7 * np.abs(slopes).max())
    inverse = np.linalg.inv(_density(band, model))
    dE = [inverse @ (_density(band, a) - _density(band, b)) / (2 * step) for a, b in pairs]
    expected = np.array([[np.einsum("k,kij,kji", band.count, a, b).real for b in dE] for a in dE])
    constants = np.arange(2 * SENSORS, (2 + coherent) * SENSORS)
    expected[constants, constants] += precision.repeat(SENSORS)
    np.testing.assert_allclose(fit.information, expected, atol=1e-7 * np.abs(expected).max())
    # shapes of unit norm, poles and forces; then what a prior leaves of R
    alone = 2 * (SENSORS - 1) + 4 + 9
    assert alone - 1e-6 < fit.freedom < alone + coherent * SENSORS + 1e-6
    known = replace(model, precision=1e9 * precision)
    assert spectral_density.Fit(band, known).freedom == pytest.approx(alone, abs=0.1)


def test_every_fit_ends_at_a_minimum_of_shapes_poles_forces_and_background() -> None:
    rng = np.random.default_rng(1)
    model = replace(_model(rng), omega=np.array([9.6, 10.4, 12.0]))
    band = _band(rng)
    E = _density(band, model)
    F = np.einsum("kij,kbj->kbi", np.linalg.cholesky(E), _circular(rng, LINES, 40, SENSORS))
    power = np.einsum("kbi,kbj->kij", F, F.conj()) / 80
    band = replace(band, power=power, count=np.full(LINES, 40.0))
    fit = spectral_density.maximise(band, model)
    assert fit.converged
    A, scale = fit.scaled()
    left = scale * fit.gradient
    assert left @ np.linalg.solve(A, left) < 0.1
    for change in (0.99, 1.01):
        other = replace(fit.model, background=change * fit.model.background)
        assert spectral_density.Fit(band, other).cost > fit.cost - 0.01


def test_a_background_that_starts_far_too_high_is_left_in_a_few_steps() -> None:
    rng = np.random.default_rng(8)
    model = replace(_model(rng), background=1e-5 * np.eye(SENSORS))
    band = replace(_band(rng), count=np.full(LINES, 40.0), floor=np.full(SENSORS, 1e-5))
    root = np.linalg.cholesky(_density(band, model))
    F = np.einsum("kij,kbj->kbi", root, _circular(rng, LINES, 40, SENSORS))
    band = replace(band, power=np.einsum("kbi,kbj->kij", F, F.conj()) / 80)
    fit = spectral_density.maximise(band, replace(model, background=0.1 * np.eye(SENSORS)), 30)
    assert fit.converged
    assert np.trace(fit.model.background) < 1e-4


def test_bending_is_the_second_change_of_the_cost_where_forces_vanish() -> None:
    rng = np.random.default_rng(6)
    model, band = _model(rng), _band(rng)
    model = replace(model, root=0 * model.root)
    band = replace(band, power=band.power / 1e4)
    fit, step = spectral_density.Fit(band, model), 1e-4
    first = 2 * SENSORS + 4
    for k, expected in enumerate(fit.bending.diagonal()):
        pair = [_moved(model, first + k, s).root for s in (step, -step)]
        costs = [spectral_density.Fit(band, replace(model, root=L)).cost for L in pair]
        assert (sum(costs) - 2 * fit.cost) / step**2 == pytest.approx(expected, rel=1e-3)


def test_shapes_of_setups_that_differ_have_greater_deviations() -> None:
    shapes = [np.array([0.6, 0.64, 0.48]), np.array([0.48, 0.6, 0.64])]
    covariances = [1e-6 * (np.eye(3) - np.outer(u, u)) for u in shapes]
    places = [np.array([0, 1, 2]), np.array([0, 1, 3])]
    phi, C, misfit = merged_shape(places, shapes, covariances, 4)
    assert np.sqrt(C[0, 0]) > 0.01  # either setup says 0.001
    for u, i in zip(shapes, places, strict=True):
        assert (u @ phi[i]) ** 2 > 0.99 * float(phi[i] @ phi[i])
    _, same, agrees = merged_shape(places[:1] * 2, shapes[:1] * 2, covariances[:1] * 2, 4)
    assert misfit > 100 > 1e-6 > agrees
    assert np.sqrt(np.diag(same)[:3]).max() < 0.001


def test_shapes_of_setups_meet_at_shared_sensors() -> None:
    rng = np.random.default_rng(2)
    phi = rng.standard_normal(7)
    phi /= np.linalg.norm(phi)
    places = [np.array([0, 1, 2, 3]), np.array([4, 0, 1]), np.array([1, 5])]
    std, errors = 0.01, []
    for _ in range(300):
        shapes, covariances = [], []
        for i in places:
            u = phi[i] / np.linalg.norm(phi[i])
            u = u + std * rng.standard_normal(len(i))
            u *= rng.choice([-1, 1]) / np.linalg.norm(u)
            shapes.append(u)
            covariances.append(std**2 * (np.eye(len(i)) - np.outer(u, u)))
        merged, C, _ = merged_shape(places, shapes, covariances, 7)
        assert np.isnan(merged[6])
        true = phi[:6] / np.linalg.norm(phi[:6])
        sign = np.sign(merged[:6] @ true)
        errors.append((sign * merged[:6] - true) / np.sqrt(np.diag(C)[:6]))
    assert np.std(errors, axis=0) == pytest.approx(np.ones(6), abs=0.2)


F0, ZETA, RATE = np.array([2.0, 2.05, 5.0]), np.array([0.01, 0.008, 0.012]), 16.0


def _records(
    rng: np.random.Generator, minutes: float, machine: float = 0.0
) -> tuple[Floats, Floats]:
    """Return shapes (modes, 5) and records of five sensors, forces linear between samples."""
    phi = np.linalg.qr(rng.standard_normal((5, 5)))[0][:3]
    count, fine = int(60 * minutes * RATE), 4
    force = rng.standard_normal((5, (count + 500) * fine))
    force[0] += machine * np.sin(2 * np.pi * 3.4 * np.arange(force.shape[1]) / (fine * RATE))
    q = []
    for f, zeta, p in zip(F0, ZETA, phi @ force, strict=True):
        omega = 2 * np.pi * f
        system = [1.0, 0.0, 0.0], [1.0, 2 * zeta * omega, omega**2]
        b, a, _ = signal.cont2discrete(system, 1 / (fine * RATE), "foh")
        q.append(signal.lfilter(b[0], a, p))
    y = signal.decimate(phi.T @ np.array(q), fine, ftype="fir")[:, 500:]
    return phi, y + 0.02 * y.std() * rng.standard_normal(y.shape)


@pytest.mark.slow(3)
def test_close_modes_are_found_and_a_machine_is_none() -> None:
    phi, y = _records(np.random.default_rng(3), 15, machine=1.0)
    result = identify([Records("all", tuple("abcde"), RATE, y)], (1, 7))
    assert [mode.frequency for mode in result.modes] == pytest.approx(F0, rel=0.005)
    for mode, shape, f, zeta in zip(result.modes, phi, F0, ZETA, strict=True):
        assert (mode.shape.shape @ shape) ** 2 > 0.98
        assert abs(mode.frequency - f) < 4 * mode.frequency_std
        assert abs(mode.damping - zeta) < 4 * mode.damping_std
    # with all lines, damping has this deviation (Au 2014), and 1.52 times it with those within
    # four half bandwidths
    last = result.modes[2]
    best = np.sqrt(last.damping / (2 * np.pi * last.frequency * 15 * 60))
    assert 0.9 * best < last.damping_std < 1.4 * best
    assert [pole.frequency for pole in result.rejected] == pytest.approx([3.4], abs=0.002)
    assert result.rejected[0].reason == "a harmonic: its lines are those of a sine"


@pytest.mark.slow(4)
def test_setups_make_one_set_of_shapes_at_all_sensors() -> None:
    rng = np.random.default_rng(4)
    _, first = _records(rng, 10)
    rng = np.random.default_rng(4)
    phi, second = _records(rng, 12)
    setups = [
        Records("1", ("a", "b", "c"), RATE, first[:3]),
        Records("2", ("c", "d", "a", "e"), RATE, -second[[2, 3, 0, 4]]),
    ]
    result = identify(setups, (1, 7))
    assert result.responses == tuple("abcde")
    for mode, shape in zip(result.modes, phi, strict=True):
        assert (mode.shape.shape @ shape) ** 2 > 0.97
        assert (mode.shape_std > 0).all()


def test_a_strong_mode_above_the_band_leaves_damping_as_it_is() -> None:
    errors = np.array([_errors_of_damping(seed) for seed in range(1, 4)])
    assert (np.abs(errors[:, 0]) < 2.5).all()
    assert abs(errors[:, 0].mean()) < 1
    assert errors[:, 1].mean() < -2  # without them, the background bends


def _errors_of_damping(seed: int) -> list[float]:
    """Return errors over deviations, with what moves above the band told from it and without."""
    rng, rate, high = np.random.default_rng(seed), 16.0, 5.9
    f = np.fft.rfftfreq(int(1800 * rate), 1 / rate)
    phi = np.linalg.qr(rng.standard_normal((3, 2)))[0].T
    phi[1] = (phi[1] + phi[0] / 2) / np.sqrt(1.25)
    x = f / np.array([[5.0], [6.2]])
    h = x**2 / (1 - x**2 + 2j * np.array([[0.03], [0.01]]) * x)
    y = np.fft.irfft(phi.T @ (h * np.array([[1], [4]]) * _circular(rng, *x.shape)), axis=1)
    y += 0.01 * y.std() * rng.standard_normal(y.shape)
    records = Records("all", tuple("abc"), rate, y)
    above = _above(records, high)
    assert abs(phi[1] @ above[0].phi) > 0.999
    assert above[0].omega / (2 * np.pi) == pytest.approx(6.2, rel=0.02)
    assert _above(records, rate / 2) == ()
    none: Any = None
    setup = _Setup(records, transforms(records, 3.0, high), none, (), above)
    errors = list[float]()
    for each in (setup, replace(setup, above=())):
        (mode,) = _fitted(each, [Local(10 * np.pi, 0.03, phi[0])], 1e-4, last=True).modes
        errors.append(float(np.log(mode.zeta / 0.03) / np.sqrt(mode.covariance[1, 1])))
    return errors


@pytest.mark.parametrize("seed", [2, *(pytest.param(x, marks=pytest.mark.slow(2)) for x in (1, 3))])
def test_modes_are_flagged_where_their_band_holds_another_one(seed: int) -> None:
    rng, rate, f0, zeta = np.random.default_rng(seed), 16.0, [5.0, 5.2], [0.012, 0.02]
    f = np.fft.rfftfreq(int(1800 * rate), 1 / rate)
    phi = np.linalg.qr(rng.standard_normal((4, 2)))[0].T
    phi[1] = (phi[1] + phi[0] / 2) / np.sqrt(1.25)
    x = f / np.array(f0)[:, None]
    h = x**2 / (1 - x**2 + 2j * np.array(zeta)[:, None] * x)
    y = np.fft.irfft(phi.T @ (h * _circular(rng, *x.shape)), axis=1)
    y += 0.02 * y.std() * rng.standard_normal(y.shape)
    none: Any = None
    records = Records("all", tuple("abcd"), rate, y)
    starts = [Local(2 * np.pi * f, z, shape) for f, z, shape in zip(f0, zeta, phi, strict=True)]
    setup = _Setup(records, transforms(records, 3.0, 7.0), none, ())
    (one,) = _fitted(setup, starts[:1], 1e-4, last=True).modes
    both = _fitted(setup, starts, 1e-4, last=True).modes
    assert not one.explained
    assert [mode.explained for mode in both] == [True, True]


def test_a_mode_whose_damping_starts_far_too_small_is_not_lost() -> None:
    rng, rate, zeta = np.random.default_rng(1), 16.0, 0.012
    f = np.fft.rfftfreq(int(1800 * rate), 1 / rate)
    phi = np.array([0.6, 0.8])
    x = f / 5.0
    h = x**2 / (1 - x**2 + 2j * zeta * x)
    y = np.fft.irfft(phi[:, None] * (h * _circular(rng, len(f))), axis=1)
    y += 0.02 * y.std() * rng.standard_normal(y.shape)
    records = Records("all", ("a", "b"), rate, y)
    none: Any = None
    setup = _Setup(records, transforms(records, 3.0, 7.0), none, ())
    rough = _fitted(setup, [Local(10 * np.pi, zeta / 5, phi)], 1e-4)
    (mode,) = _fitted(rough, rough.modes, 1e-4, last=True).modes
    assert abs(np.log(mode.zeta / zeta)) < 3 * np.sqrt(mode.covariance[1, 1])


@pytest.mark.slow(2)
def test_a_seed_is_kept_beside_as_many_modes_as_are_asked_for() -> None:
    rng, f = np.random.default_rng(1), np.fft.rfftfreq(4800, 1 / 16)
    h = (f / 5) ** 2 / (1 - (f / 5) ** 2 + 0.024j * f / 5)
    y = np.fft.irfft(np.array([[0.6], [0.8]]) * (h * _circular(rng, len(f))), axis=1)
    y += 0.05 * y.std() * rng.standard_normal(y.shape)
    records = Records("all", ("a", "b"), 16.0, y)
    modes = identify([records], (4.0, 6.0), 1, [4.4]).modes
    assert [mode.frequency for mode in modes] == pytest.approx([4.4, 5.0], rel=0.03)


def _beside(
    seed: int, f0: list[float], zeta: list[float], size: list[float]
) -> tuple[_Setup, list[Local]]:
    """Return a setup whose modes have orthogonal shapes, and these modes."""
    rng, rate = np.random.default_rng(seed), 16.0
    f = np.fft.rfftfreq(int(1800 * rate), 1 / rate)
    phi = np.linalg.qr(rng.standard_normal((4, len(f0))))[0].T
    x = f / np.array(f0)[:, None]
    h = x**2 / (1 - x**2 + 2j * np.array(zeta)[:, None] * x) * np.array(size)[:, None]
    y = np.fft.irfft(phi.T @ (h * _circular(rng, *x.shape)), axis=1)
    records = Records("all", tuple("abcd"), rate, y + 0.02 * y.std() * rng.normal(size=y.shape))
    none: Any = None
    modes = [Local(2 * np.pi * f, z, shape) for f, z, shape in zip(f0, zeta, phi, strict=True)]
    return _Setup(records, transforms(records, 3.0, 7.0), none, ()), modes


def test_a_flat_mode_that_goes_leaves_others_the_bands_of_their_own() -> None:
    """It reaches over all of them, up to the flank of a strong mode beyond the band."""
    setup, (*modes, strong) = _beside(1, [4.0, 4.6, 7.2], [0.007, 0.016, 0.02], [1, 1, 6])
    flat = Local(2 * np.pi * 6.5, 0.15, strong.phi)
    found = _fitted(setup, [*modes, flat], 1e-4, last=True).modes
    alone = _fitted(setup, modes, 1e-4, last=True).modes
    for mode, other, true in zip(found, alone, modes, strict=True):
        std = float(np.sqrt(mode.covariance[1, 1]))
        assert np.log(mode.zeta / other.zeta) == pytest.approx(0, abs=0.25 * std)
        assert abs(np.log(mode.zeta / true.zeta)) < 3 * std


def test_what_is_flatter_than_any_band_of_a_mode_is_none() -> None:
    setup, modes = _beside(1, [5.0, 5.2], [0.02, 0.5], [1, 2])
    (mode,) = _fitted(setup, [modes[0], replace(modes[1], zeta=0.05)], 1e-4).modes
    assert mode.zeta == pytest.approx(0.02, rel=0.15)


@pytest.mark.parametrize("seed", [3, *(pytest.param(x, marks=pytest.mark.slow(1)) for x in (1, 2))])
def test_close_modes_have_one_start_each(seed: int) -> None:
    rng, rate, f0 = np.random.default_rng(seed), 16.0, np.array([4.6, 4.8, 5.0, 5.2, 5.4, 5.6])
    f = np.fft.rfftfreq(int(1800 * rate), 1 / rate)
    phi = rng.standard_normal((len(f0), 8))
    phi /= np.linalg.norm(phi, axis=1)[:, None]
    x = f / f0[:, None]
    y = np.fft.irfft(phi.T @ (_circular(rng, *x.shape) / (1 - x**2 + 0.06j * x)), axis=1)
    y += 0.02 * y.std() * rng.standard_normal(y.shape)
    _, starts = _starts(Records("all", tuple("abcdefgh"), rate, y), 3.0, 7.0)
    near = abs(f0[:, None] - [start.omega / (2 * np.pi) for start in starts]) < 0.1
    likeness = (phi @ np.array([start.phi for start in starts]).T) ** 2
    assert (np.where(near, likeness, 0.0).max(axis=1) > 0.96).all()
    assert len(starts) <= len(f0) + 1


def test_blocks_are_fine_at_poles_and_coarse_far_from_them() -> None:
    omega: Floats = np.arange(10.0, 20.0, 0.005)
    F = _circular(np.random.default_rng(11), 2, len(omega))
    lines = Transforms(omega, F, 2, np.ones(len(omega)))
    band = lines.part(11.0, 19.0, np.array([[14.0, 14.5], [0.1, 0.02]]))
    size = band.count * 0.005
    distance = np.min([abs(band.omega - 14.0), abs(band.omega - 14.5)], axis=0)
    near = abs(band.omega - 14.5) < 0.02
    assert band.count[near] == pytest.approx(1.0)
    assert (size <= 0.1 * np.maximum(distance, 0.1) + 0.011).all()
    assert size[0] > 0.2
    inside = (omega >= 11.0) & (omega <= 19.0)
    assert band.count.sum() == np.count_nonzero(inside)
    whole = np.tensordot(band.count, band.power, 1)
    np.testing.assert_allclose(whole, F[:, inside] @ F[:, inside].conj().T)


def test_what_overlaps_too_much_is_parted_between_the_modes_that_do_least() -> None:
    frequency = np.array([1.0, 1.001, 1.03, 1.031, 1.07, 1.071])
    modes = [Local(omega, 0.01, np.ones(1)) for omega in frequency[[3, 0, 5, 1, 4, 2]]]
    groups = [frequency[[3, 0, 5, 1, 4, 2]][group].tolist() for group in _overlapping(modes, 8.0)]
    assert groups == [[1.0, 1.001, 1.03, 1.031], [1.07, 1.071]]
    assert sorted(len(group) for group in _overlapping(modes, 1.0)) == [2, 2, 2]


@pytest.mark.slow(4)
def test_noise_alone_has_no_modes() -> None:
    rng = np.random.default_rng(5)
    records = Records("noise", ("a", "b", "c"), 10.0, rng.standard_normal((3, 4000)))
    assert identify([records]).modes == ()


@pytest.mark.parametrize("place", [60.0, 60.37])
def test_a_sine_is_taken_off_with_one_line_and_a_mode_is_left(place: float) -> None:
    rng, k = np.random.default_rng(7), np.arange(120)
    model = replace(_model(rng), omega=np.array([9.8, 10.4, 12.0]))
    omega, d = np.linspace(9, 11, len(k)), np.sinc(k - place) * (-1.0) ** k
    band = replace(_band(rng), omega=omega)
    root = np.linalg.cholesky(_density(band, model))
    F = np.einsum("kij,kj->ik", root, _circular(rng, len(k), SENSORS)) / np.sqrt(2)
    alone = Transforms(omega, F, 2, np.ones(len(k)))
    lines = replace(alone, F=F + np.outer(100 * np.array([1, 1j, -1, 0.5]), d))
    assert without_sine(alone, band, model, np.zeros(2, bool), 1e-3) is None
    taken = without_sine(lines, band, model, np.zeros(2, bool), 1e-3)
    assert taken is not None
    left, mode = taken
    assert mode is None
    assert left.sines == pytest.approx([9 + 2 * place / 119], abs=0.01 * 2 / 119)
    assert left.share.sum() == pytest.approx(len(k) - 1)
    assert np.abs(left.F - F).max() < 3 * np.abs(F[:, 55:66]).max()
    assert without_sine(left, band, model, np.zeros(2, bool), 1e-3) is None
    # a narrow mode in its place is none
    narrow = replace(model, omega=np.array([9.8, left.sines[0], 12.0]), zeta=model.zeta / 1e4)
    taken = without_sine(lines, band, narrow, np.array([True, False]), 1e-3)
    assert taken is not None
    assert taken[1] == 1


@pytest.mark.parametrize(("kurtosis", "says"), [(1.0, "its amplitude is steady"), (2.0, "")])
def test_a_machine_that_drifts_is_steady(kurtosis: float, says: str) -> None:
    mode = SimpleNamespace(held=False, kurtosis=(kurtosis, 0.1))
    having: Any = [(SimpleNamespace(), mode)] * 3
    reason = _harmonic(having)
    assert says in reason
    assert bool(says) == bool(reason)
