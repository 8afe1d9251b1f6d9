r"""Ambient tests: from the records of all setups to modes, by the likelihood of their transforms.

Half spectra of each setup give poles to start from; modes that overlap share a band, in which the
likelihood is maximised (`spectral_density`). A mode is accepted where it gains more than noise
makes somewhere in the band; in other setups, where the pole is known, it needs less. What none of
these has is no mode of the structure.
Harmonics of machines are taken off as sines; those that drift are too steady (`harmonics`).
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
import scipy.linalg as la
from scipy.special import chdtri, ndtri

from modefront._typing import Bools, Floats
from modefront.data.modal_test import Records
from modefront.data.responses import FrequencyResponses
from modefront.identification import harmonics, selection, spectra, spectral_density, stabilisation
from modefront.identification.record import Identification, ModeEstimate, Rejected, Residuals
from modefront.identification.selection import FALSE
from modefront.identification.sets import LEAST_MAC, merged_shape, mode_groups
from modefront.identification.shapes import real_shape
from modefront.identification.spectra import Transforms
from modefront.identification.spectral_density import Band, Density, Fit
from modefront.identification.stabilisation import StabilisationDiagram

REACH = 4.0, 20.0
"""Half bandwidths on either side of a mode that its band has: the first while its neighbours are
rough, the last with their forces. Of a mode alone, standard deviations of frequency and damping are
then 1.20 and 1.52, and 1.03 and 1.08, of those with all lines (Au, Mech. Syst. Signal Process. 48
(2014) 15-33, doi:10.1016/j.ymssp.2013.07.004)."""

WIDEST = 0.15
"""Half the width of a band over the frequency of its mode, at most, beyond the first reach: over it
flanks of modes outside are linear."""

BEYOND = 2 * WIDEST  # share of the highest frequency up to which what moves above it is told apart
OVERLAP = 4.0, 8.0  # distance over the sum of half bandwidths of modes fitted at once: first, last
LEAST_LINES = 40  # lines of a band, at least
MOST_TOGETHER = 5  # modes that are fitted at once, at most

BESIDE = 4
"""Modes on either side of a band whose forces the last fit has, at most: as many as sensors tell
apart. With one only, what forces of their own do to the others shifts frequencies and shapes."""

DAMPING = 0.002, 0.05  # limits of damping ratios to start from

TRIAL_STEPS = 8  # to the maximum without a mode, which tell what it gains before it is reached
HARMONIC = 1e-3  # share of the modes that would be taken for harmonics by chance
CYCLES = 10  # periods of the lowest frequency in a record, at least, by default

HIGHEST = 0.8  # highest frequency over the greatest of records, by default: beyond are filters
LINES_SHOWN = 400  # blocks of lines of the densities that are shown


@dataclass(frozen=True)
class Local:
    """A mode in one setup."""

    omega: float  # omega, zeta: rad/s, damping ratio
    zeta: float
    phi: Floats  # (sensors,) of unit norm
    gain: float = np.inf  # 2 Delta J of the fit with the mode
    freedom: float = 0.0  # parameters that this fit has more
    covariance: Floats = field(default_factory=lambda: np.zeros((0, 0)))  # ln omega, ln zeta, phi
    share: float = np.nan  # its greatest share in the density of a sensor, at its frequency
    kurtosis: tuple[float, float] = (2.0, 1.0)  # kappa, and its standard deviation for a mode
    held: bool = False  # whether it stays whatever its gain
    explained: bool = True  # whether its band holds no more than the modes that are fitted there

    @property
    def half(self) -> float:
        """Half bandwidth in rad/s."""
        return self.zeta * self.omega

    @property
    def estimate(self) -> ModeEstimate:
        """The mode with its standard deviations, in physical units."""
        stds = np.sqrt(np.diag(self.covariance))
        return ModeEstimate(
            complex(-self.half, self.omega * np.sqrt(1 - self.zeta**2)),
            float(stds[0]) * self.omega / (2 * np.pi),
            float(stds[1]) * self.zeta,
            real_shape(np.nan_to_num(self.phi).astype(complex)),
            stds[2:],
            np.zeros(0, complex),
            shape_covariance=self.covariance[2:, 2:],
        )


@dataclass(frozen=True)
class _Setup:
    """A setup with its transforms, diagram and modes."""

    records: Records
    lines: Transforms
    diagram: StabilisationDiagram
    modes: tuple[Local, ...]
    above: tuple[Local, ...] = ()  # what moves above the band, for its flank

    @property
    def spacing(self) -> float:
        """Distance of lines in rad/s."""
        return 2 * np.pi / self.records.duration


def identify(
    setups: Sequence[Records],
    band: tuple[float, float] | None = None,
    modes: int | None = None,
    seeds: Sequence[float] = (),
) -> Identification:
    """Return the modes of the structure within a band in Hz, from the records of all setups.

    ``modes`` is their number where it is known; ``seeds`` are frequencies in Hz at which a mode is
    kept whatever its evidence. Sensors of the same name in several setups are the references. The
    band has `LEAST_LINES` of each.
    """
    low, high = band or default_band(setups)
    identified = [_of_setup(records, low, high, seeds) for records in setups]
    groups = _groups(identified, LEAST_MAC)
    identified = [_completed(k, identified, groups) for k in range(len(setups))]
    return _combined(identified, _groups(identified), (low, high), modes)


def default_band(setups: Sequence[Records]) -> tuple[float, float]:
    """Return the frequencies in Hz that all records hold."""
    low = max(CYCLES / records.duration for records in setups)
    return low, min(HIGHEST * records.rate / 2 for records in setups)


def _of_setup(records: Records, low: float, high: float, seeds: Sequence[float]) -> _Setup:
    """Return the setup; poles are looked for again where machines may have hidden some."""
    all_lines = lines = spectra.transforms(records, low, high)
    chance = FALSE / len(lines.omega)  # the poles that lines tell apart are as many as lines
    while True:
        data = spectra.with_lines(records, all_lines.omega, lines.F - all_lines.F)
        diagram, modes = _starts(data, low, high)
        for omega in 2 * np.pi * np.array(seeds):
            apart = np.array([abs(mode.omega - omega) for mode in modes])
            if not (apart < [max(mode.half, DAMPING[0] * omega) for mode in modes]).any():
                modes, apart = [*modes, _seeded(lines, omega)], np.append(apart, 0.0)
            modes[apart.argmin()] = replace(modes[apart.argmin()], held=True)
        setup = _fitted(_Setup(records, lines, diagram, ()), modes, chance)
        if setup.lines.sines == lines.sines:
            setup = replace(setup, above=_above(records, high))
            return _fitted(setup, setup.modes, chance, last=True)
        lines = setup.lines


def _above(records: Records, high: float) -> tuple[Local, ...]:
    """Return what moves above a frequency in Hz, the most first, as modes of principal shapes.

    In bands below, the flanks of such modes need their shapes and, roughly, their frequencies. A
    background alone does not bend as they do, and damping ratios are then too small.
    """
    lines = spectra.transforms(records, high, min((1 + BEYOND) * high, records.rate / 2))
    if len(lines.omega) < LEAST_LINES:
        return ()
    shapes = np.linalg.eigh((lines.F @ lines.F.conj().T).real)[1].T[::-1][:BESIDE]
    omega, zeta = lines.omega[np.abs(shapes @ lines.F).argmax(axis=1)], np.sqrt(np.prod(DAMPING))
    return tuple(Local(float(w), float(zeta), phi) for w, phi in zip(omega, shapes, strict=True))


def _starts(records: Records, low: float, high: float) -> tuple[StabilisationDiagram, list[Local]]:
    """Return the diagram of half spectra and its clusters within the band as modes."""
    data, variance = spectra.half_spectra(records, low, high)
    diagram = stabilisation.diagram_of(data, variance)
    f = diagram.frequency[diagram.clusters]
    inside = diagram.clusters[(f >= low) & (f <= high)]
    lam, s = diagram.pole[inside], np.asarray(2j * np.pi * data.frequency + data.decay)
    psi = stabilisation.shapes_of(lam, diagram.participation[inside], data.H, s, 0)
    psi = psi * records.values.std(axis=1)
    zeta = np.clip(-lam.real / np.abs(lam), *DAMPING)
    rows = zip(np.abs(lam).tolist(), zeta.tolist(), psi, strict=True)
    return diagram, [Local(omega, z, real_shape(shape).shape) for omega, z, shape in rows]


def _seeded(lines: Transforms, omega: float, phi: Floats | None = None) -> Local:
    """Return a mode at a frequency, with the shape of what the records hold there.

    ``phi`` has what is known of the shape, 0 elsewhere.
    """
    half = max(DAMPING[0] * omega, 2 * (lines.omega[1] - lines.omega[0]))
    near = np.abs(lines.omega - omega) <= max(half, np.abs(lines.omega - omega).min())
    power = (lines.F[:, near] @ lines.F[:, near].conj().T).real
    if phi is None or not phi.any():
        phi = np.linalg.eigh(power)[1][:, -1]
    shape = power @ phi
    return Local(omega, half / omega, shape / np.linalg.norm(shape))


def _fitted(
    setup: _Setup, modes: Sequence[Local], chance: float, *, last: bool = False, first: int = 0
) -> _Setup:
    """Return the setup with the modes that data need, each fitted with those that it overlaps.

    The ``last`` fit has the background that their forces move. Modes that overlap none from number
    ``first`` on stay as they are.
    """
    found: list[Local] = []
    for group in _overlapping(modes, OVERLAP[last]):
        chosen = [modes[k] for k in group]
        if max(group) >= first:
            others = [mode for k, mode in enumerate(modes) if k not in group]
            setup, chosen = _together(setup, chosen, others, chance, last)
        found += chosen
    return replace(setup, modes=tuple(found))


def _together(
    setup: _Setup, chosen: Sequence[Local], others: Sequence[Local], chance: float, last: bool
) -> tuple[_Setup, list[Local]]:
    """Return the setup and those of the chosen modes that data need, fitted at once.

    Where some go in the ``last`` fit, those that stay are fitted again, in the bands of their own.
    """
    omega, half = np.array([[mode.omega, mode.half] for mode in chosen]).T
    reach = np.minimum(REACH[last] * half, np.maximum(REACH[0] * half, WIDEST * omega))
    reach = np.maximum(reach, LEAST_LINES / 2 * setup.spacing)
    low, high = float(np.min(omega - reach)), float(np.max(omega + reach))
    rest = sorted(others, key=lambda mode: mode.omega)
    start, end = np.searchsorted([mode.omega for mode in rest], [low, high])
    told = max((len(setup.records.sensors) - len(chosen)) // 2, 1)
    nearest = min(told, BESIDE) if last else 1
    beside = [
        *rest[max(start - nearest, 0) : end + nearest],
        *setup.above[: max(end + nearest - len(rest), 0)],
    ]
    inside = [*chosen, *rest[start:end]]
    limits = low, high, np.array([[mode.omega, mode.half] for mode in inside]).T
    lines, found = _of_group(setup, limits, chosen, beside, chance, last)
    setup = replace(setup, lines=lines)
    if not last or len(found) in (0, len(chosen)):
        return setup, found
    again: list[Local] = []
    for group in _overlapping(found, OVERLAP[last]):
        apart = [mode for k, mode in enumerate(found) if k not in group]
        setup, kept = _together(setup, [found[k] for k in group], [*others, *apart], chance, last)
        again += kept
    return setup, again


def _overlapping(modes: Sequence[Local], reach: float) -> list[list[int]]:
    """Return the numbers of modes that overlap, a list each, by frequency.

    The closest ones join first, so that what more than `MOST_TOGETHER` overlap are parted between
    those that do least.
    """
    omega, half = (np.array([[mode.omega, mode.half] for mode in modes]).reshape(-1, 2)).T
    distance = np.abs(omega[:, None] - omega) / (half[:, None] + half)
    pairs = np.argwhere(np.triu(distance < reach, 1))
    group = [[k] for k in range(len(modes))]
    for i, j in pairs[distance[tuple(pairs.T)].argsort()].tolist():
        if group[i] is not group[j] and len(group[i]) + len(group[j]) <= MOST_TOGETHER:
            group[i].extend(group[j])
            for k in group[j]:
                group[k] = group[i]
    apart = {id(each): sorted(each, key=lambda k: float(omega[k])) for each in group}
    return sorted(apart.values(), key=lambda each: float(omega[each[0]]))


def _of_group(
    setup: _Setup,
    limits: tuple[float, float, Floats],
    modes: Sequence[Local],
    beside: Sequence[Local],
    chance: float,
    last: bool,
) -> tuple[Transforms, list[Local]]:
    """Return the lines of a setup without sines in a band, and its modes.

    Without those that gain less than noise makes by ``chance``, the weakest first: a mode goes from
    a fit that has reached its maximum only, and stays in the ``last`` one where that without it
    has, too.
    """
    band, tried = setup.lines.part(*limits), False
    steps = spectral_density.MOST_STEPS if last else TRIAL_STEPS
    start = _first(band, [*modes, *beside], len(modes))
    lines, band, fit, held = _without_sines(setup.lines, limits, start, [x.held for x in modes])
    if lines is not setup.lines and not last:
        return lines, []  # poles are looked for again
    if last:
        fit = spectral_density.maximise(band, fit.model.with_coherent(band))
    while fit.model.free:
        models = [fit.model.without(r, band) for r in range(fit.model.free)]
        without = [spectral_density.maximise(band, model, steps) for model in models]
        gain = 2 * (np.array([each.cost for each in without]) - fit.cost)
        freedom = fit.freedom - np.array([each.freedom for each in without])
        model = fit.model
        omega, zeta, phi = (x[..., : len(held)] for x in (model.omega, model.zeta, model.phi))
        low, high = band.omega[[0, -1]]
        least = chdtri(np.maximum(freedom, len(phi) + 2), chance)
        # a mode that left the band, is narrower than a line, doubles a stronger one, or is as flat
        # as the last band, or as any in which flanks are linear, explains nothing
        astray = (omega < low) | (omega > high)
        flat = (high - low) / 4 if last else np.maximum((high - low) / 2, WIDEST * omega)
        astray |= zeta * omega > flat
        astray |= 2 * zeta * omega < setup.spacing
        astray |= selection.doubles(omega * (1j - zeta), phi.T.astype(complex), gain)
        worth = np.where(held, np.inf, np.where(astray, 0.0, gain))
        weakest = int((worth / least).argmin())
        enough = worth[weakest] >= least[weakest]
        if not (tried or fit.converged) and (last or not enough):
            fit, tried = spectral_density.maximise(band, fit.model), True
            continue
        if enough:
            break
        fit, held, tried = without[weakest], np.delete(held, weakest), False
    else:
        return lines, []
    model, visible = fit.model, _shares(band, fit.model)
    least = chdtri(len(model.phi) + 2, chance)
    explained = bool(not last or spectral_density.excess(band, model) < least)
    return lines, [
        Local(
            float(model.omega[r]),
            float(model.zeta[r]),
            model.phi[:, r],
            float(gain[r]),
            float(freedom[r]),
            fit.covariance(r),
            float(visible[r]),
            harmonics.kurtosis(lines, model, r, REACH[0]),
            bool(held[r]),
            explained,
        )
        for r in range(model.free)
    ]


def _without_sines(
    lines: Transforms, limits: tuple[float, float, Floats], model: Density, held: Sequence[bool]
) -> tuple[Transforms, Band, Fit, Bools]:
    """Return lines and band without sines, the fit, and which of its modes are held."""
    kept = np.array(held)
    while True:
        band = lines.part(*limits)
        fit = spectral_density.maximise(band, model, TRIAL_STEPS)
        taken = harmonics.without_sine(lines, band, fit.model, kept, FALSE)
        if taken is None:
            return lines, band, fit, kept
        (lines, place), model = taken, fit.model
        if place is not None:
            model, kept = model.without(place, band), np.delete(kept, place)


def _first(band: Band, modes: Sequence[Local], free: int) -> Density:
    """Return a model to start from, with the forces that the shapes make of the power."""
    omega, zeta = np.array([[mode.omega, mode.zeta] for mode in modes]).T
    phi, root = np.array([mode.phi for mode in modes]).T, np.eye(len(modes), dtype=complex)
    background, middle = band.total / band.weight, float(band.omega[[0, -1]].mean())
    model = Density(omega, zeta, phi, root, background, free, np.zeros((len(phi), 0)), middle)
    h2 = np.abs(model.response(band.omega, band.order)) ** 2
    inverse = np.linalg.pinv(phi, rcond=0.1)
    filtered = np.einsum("ri,kij,rj->rk", inverse, band.power, inverse, optimize=True).real
    level = np.sum(filtered * h2, axis=1) / np.sum(h2**2, axis=1)
    return replace(model, root=np.diag(np.sqrt(level)).astype(complex))


def _shares(band: Band, model: Density) -> Floats:
    """Return the greatest share of each mode in the density of a sensor, at its frequency."""
    h = model.response(model.omega, band.order)[:, : model.free]
    own = model.phi[:, : model.free] ** 2 * model.force.diagonal().real[: model.free]
    all_modes = np.sum(np.abs(np.einsum("jr,rk,rs->jks", model.phi, h, model.root)) ** 2, axis=2)
    shares: Floats = own / (all_modes + np.diag(model.background)[:, None])
    return np.minimum(shares.max(axis=0), 1.0)


def _groups(setups: Sequence[_Setup], least: float = 0.0) -> list[dict[int, int]]:
    """Return which mode of each setup every mode of the structure is."""
    local = [(x.records.sensors, [mode.estimate for mode in x.modes]) for x in setups]
    return mode_groups(local, least)


def _completed(k: int, setups: Sequence[_Setup], groups: Sequence[dict[int, int]]) -> _Setup:
    """Return a setup in which all modes of the structure were tried.

    With the pole known, a mode needs less. Neighbours that were fitted without it are fitted again.
    """
    own, modes = setups[k], list(setups[k].modes)
    for group in (group for group in groups if k not in group):
        known = [(setups[j], setups[j].modes[number]) for j, number in group.items()]
        omega = float(np.mean([mode.omega for _, mode in known]))
        first, mode = known[0]
        shape = dict(zip(first.records.sensors, mode.phi, strict=True))
        phi = np.array([shape.get(name, 0.0) for name in own.records.sensors])
        modes.append(replace(_seeded(own.lines, omega, phi), zeta=mode.zeta))
    first_new = len(own.modes)
    return _fitted(own, modes, FALSE, last=True, first=first_new) if modes[first_new:] else own


def _combined(
    setups: Sequence[_Setup],
    groups: Sequence[dict[int, int]],
    band: tuple[float, float],
    count: int | None,
) -> Identification:
    """Return the modes of the structure, and what is none."""
    sensors = tuple(dict.fromkeys(x for each in setups for x in each.records.sensors))
    found = list[tuple[ModeEstimate, bool]]()
    sines = np.sort([omega for x in setups for omega in x.lines.sines]) / (2 * np.pi)
    apart = np.diff(sines, prepend=-np.inf) > max(1 / x.records.duration for x in setups)
    text = "a harmonic: its lines are those of a sine"
    rejected = [Rejected(f, 0.0, text) for f in sines[apart].tolist()]
    lines = max(len(each.lines.omega) for each in setups)
    for group in groups:
        having = [(setups[k], setups[k].modes[r]) for k, r in group.items()]
        (mode, misfit), why = _of_structure(having, sensors), ""
        freedom = sum(local.freedom for _, local in having)
        gain = sum(local.gain for _, local in having) - misfit
        gain /= float(chdtri(freedom, FALSE / lines))
        mode = _judged(having, mode, len(setups), gain)
        held = any(local.held for _, local in having)
        if not held:
            why = _harmonic(having)
            if len(having) == 1 < len(setups):
                why = "none of the other setups has it, where its pole was tried"
            elif mode.gain < 1:
                why = "noise alone may explain as much in all setups"
        if why:
            rejected.append(Rejected(mode.frequency, mode.damping, why))
        else:
            found.append((mode, held))
    modes, text = list[ModeEstimate](), "weaker than the modes asked for"
    for k, (mode, held) in enumerate(sorted(found, key=lambda each: -each[0].gain)):
        if held or k < (count or len(found)):
            modes.append(mode)
        else:
            rejected.append(Rejected(mode.frequency, mode.damping, text))
    accepted = tuple(sorted(modes, key=lambda mode: mode.frequency))
    others = tuple(sorted(rejected, key=lambda pole: pole.frequency))
    first, data = max(setups, key=lambda x: len(x.records.sensors)), _densities(setups, sensors)
    unknown = np.full(data.H.shape, np.nan, complex)
    left = Residuals(1.0, np.ones(1, complex), np.zeros(1), np.full(data.H.shape[:2], np.nan))
    return Identification(sensors, band, accepted, others, first.diagram, data, unknown, left)


def _of_structure(
    having: Sequence[tuple[_Setup, Local]], sensors: tuple[str, ...]
) -> tuple[ModeEstimate, float]:
    """Return one mode from the setups that have it, and what it loses to one in each of them.

    Variances of ln zeta go as 1 / zeta, those of ln omega as zeta (Au, Mech. Syst. Signal Process.
    48 (2014) 15-33): all are those at one damping ratio, or setups that find too little of it
    would have more weight, and smaller deviations, than others.
    """
    logs = np.log([[mode.omega, mode.zeta] for _, mode in having])
    power = np.array([-1, 1])
    own = np.array([mode.covariance.diagonal()[:2] for _, mode in having])
    of_unit = own * np.exp(logs[:, 1:] * power)
    common = np.average(logs[:, 1], weights=1 / of_unit[:, 1])
    variance = of_unit * np.exp(-common * power)
    means = np.average(logs, axis=0, weights=1 / variance)
    misfit = np.sum((logs - means) ** 2 / variance, axis=0)
    widening = np.maximum(misfit / max(len(logs) - 1, 1), 1.0)
    of_pole = np.diag(widening / np.sum(1 / variance, axis=0))
    places = [np.array([sensors.index(x) for x in setup.records.sensors]) for setup, _ in having]
    covariances = [mode.covariance[2:, 2:] for _, mode in having]
    shapes = [mode.phi for _, mode in having]
    phi, C, of_shapes = merged_shape(places, shapes, covariances, len(sensors))
    omega, zeta = np.exp(means).tolist()
    merged = Local(omega, zeta, phi, covariance=la.block_diag(of_pole, C))
    return merged.estimate, float(misfit.sum() + of_shapes)


def _judged(
    having: Sequence[tuple[_Setup, Local]], mode: ModeEstimate, setups: int, gain: float
) -> ModeEstimate:
    """Return a mode with what speaks for it."""
    pole, one = np.array([mode.pole]), np.ones(1)
    share = max(float(stabilisation.support(x.diagram, pole, one)[0]) for x, _ in having)
    flags = []
    if gain < 1:
        flags.append("kept by hand: noise alone may explain as much")
    if len(having) < setups:
        flags.append(f"found in {len(having)} of {setups} setups: sensors of the others are empty")
    if not all(local.explained for _, local in having):
        flags.append("its band holds more than its modes: errors may be greater than they seem")
    if mode.damping_std > mode.damping / 2:
        flags.append("damping hardly determined: the record is short")
    visible = max(local.share for _, local in having)
    return replace(mode, gain=gain, support=share, visibility=visible, flags=tuple(flags))


def _harmonic(having: Sequence[tuple[_Setup, Local]]) -> str:
    """Return why a mode is the harmonic of a machine; empty where it is none."""
    z = np.array([(mode.kurtosis[0] - 2) / mode.kurtosis[1] for _, mode in having])
    if z.sum() / np.sqrt(len(z)) < ndtri(HARMONIC):
        mean = np.mean([mode.kurtosis[0] for _, mode in having])
        return (
            f"a harmonic: its amplitude is steady (kurtosis {mean:.2f}; 2 for a mode, 1 for a sine)"
        )
    return ""


def _densities(setups: Sequence[_Setup], sensors: tuple[str, ...]) -> FrequencyResponses:
    """Return the spectral densities of all sensors, each from the first setup that has it."""
    lines = setups[0].lines
    edges = np.linspace(lines.omega[0], lines.omega[-1], min(LINES_SHOWN, len(lines.omega)) + 1)
    density = np.full((1, len(sensors), len(edges) - 1), np.nan, complex)
    for setup in reversed(setups):
        count = np.histogram(setup.lines.omega, edges)[0]
        for name, F in zip(setup.records.sensors, setup.lines.F, strict=True):
            power = np.histogram(setup.lines.omega, edges, weights=np.abs(F) ** 2)[0]
            density[0, sensors.index(name)] = power / np.maximum(count, 1)
    f = (edges[1:] + edges[:-1]) / (4 * np.pi)
    return FrequencyResponses(f, density, "receptance", ("spectral density",), sensors)
