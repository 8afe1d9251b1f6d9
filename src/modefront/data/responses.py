r"""Measured frequency response functions as arrays.

A test is a table of frequency response functions :math:`H_{ji}(\omega_k)` between *references*
*j* and *responses* *i* at common lines :math:`f_k`. In a hammer test one side stays and the other
roves; by Maxwell's reciprocity, :math:`H_{ji} = H_{ij}`, either side can be called the
responses: mode shapes are identified at the side called so. What was not measured is NaN.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from typing import TypeAlias

import numpy as np

from modefront._typing import Bools, Complexes, Floats
from modefront.errors import Fault, refuse
from modefront.rounding import LARGEST

EXPECTED = f"finite numbers up to {LARGEST:g}"  # what values of functions and records are
STRAY = 300.0  # ratio of sizes from which on two channels seem to have different units
UNEQUAL = 1.3  # ratio of reciprocal functions of other units: calibrations, masses leave less
ORDERS = {"receptance": 0, "mobility": 1, "accelerance": 2}  # differentiations of displacement


@dataclass(frozen=True, eq=False)
class ForceNoise:
    r"""Noise of the force channel, the same for all responses of a reference.

    Its functions are multiplied by :math:`1 - \varepsilon(f)` with

    .. math:: E[\varepsilon(f)\,\varepsilon^*(f')] = \sigma(f)\,\sigma(f')
              \sum_m p_m e^{-2\pi\mathrm{i}(f - f') t_m},\qquad \sum_m p_m = 1:

    where a force window is short, the errors are smooth over frequency.
    """

    deviation: Floats  # (lines,) sigma
    times: Floats  # (samples,) t in s from the impact
    share: Floats  # (samples,) p


@dataclass(frozen=True)
class FrequencyResponses:
    """Frequency response functions of one data set."""

    frequency: Floats  # (lines,) in Hz, ascending
    H: Complexes  # (references, responses, lines) complex, NaN where not measured
    quantity: str  # ``"receptance"``, ``"mobility"`` or ``"accelerance"``
    references: tuple[str, ...]  # references, responses: names
    responses: tuple[str, ...]
    variance: Floats | None = None  # (references, responses, lines), E|H - E H|², or None
    scaled: bool = False  # whether the variance of each function is known up to a factor only
    decay: float = 0.0  # what an exponential window added to the decay rate of every pole, in 1/s
    force_noise: tuple[ForceNoise, ...] = ()  # at each reference, where all are known

    @property
    def measured(self) -> Bools:
        """Which lines of which functions were measured, of the shape of ``H``."""
        return np.isfinite(self.H)

    def within(self, low: float, high: float) -> "FrequencyResponses":
        """Return the lines of a band in Hz, its limits included, without the line at zero."""
        f = self.frequency
        kept = (f >= low) & (f <= high) & (f > 0)
        variance = None if self.variance is None else self.variance[..., kept]
        noise = tuple(replace(x, deviation=x.deviation[kept]) for x in self.force_noise)
        H = self.H[..., kept]
        return replace(self, frequency=f[kept], H=H, variance=variance, force_noise=noise)


# 8 arguments: the parts of measured functions, the optional ones by keyword.
def frequency_responses(
    frequency: Floats,
    H: Complexes,
    quantity: str = "accelerance",
    *,
    references: tuple[str, ...] | None = None,
    responses: tuple[str, ...] | None = None,
    coherence: Floats | None = None,
    blows: int | None = None,
    variance: Floats | None = None,
) -> FrequencyResponses:
    r"""Return frequency response functions from arrays.

    ``H`` is (references, responses, lines), or (responses, lines) with one reference; or, with one
    axis more in front, the same of several blows. The ``variance`` of the mean, of the shape of one
    ``H``, follows from ordinary ``coherence`` where it is not known,

    .. math:: \operatorname{var} H = |H|^2 \frac{1 - \gamma^2}{\gamma^2 n}

    (Bendat & Piersol, *Random Data*, 4th ed., 2010, eq. 9.90, doi:10.1002/9781118032428), where n
    is the number of ``blows``; without it, up to a factor. Raises ValueError for other shapes.
    """
    H, scaled = np.asarray(H, complex), False
    H = H[None] if H.ndim == 2 else H
    if H.ndim == 4:
        count = np.isfinite(H).sum(axis=0)
        several = np.maximum(count, 1)
        mean = np.where(count > 0, np.nansum(H, axis=0) / several, np.nan)
        spread = np.nansum(np.abs(H - mean) ** 2, axis=0)
        if variance is None and len(H) > 1:
            variance = np.where(count > 1, spread / np.maximum(count - 1, 1) / several, np.nan)
        H = mean
    if coherence is not None and variance is None:
        gamma = np.clip(np.asarray(coherence, float).reshape(H.shape), 1e-6, 1.0)
        variance = np.abs(H) ** 2 * (1 - gamma) / gamma / (blows or 1)
        scaled = blows is None
    f = np.asarray(frequency, float)
    references = references or tuple(str(j + 1) for j in range(H.shape[0]))
    responses = responses or tuple(str(i + 1) for i in range(H.shape[1]))
    variance = None if variance is None else np.asarray(variance, float).reshape(H.shape)
    return FrequencyResponses(f, H, quantity, references, responses, variance, scaled)


FRF, COHERENCE, TIME = 4, 6, 1  # kinds of channels, as dataset 58 of universal files has them
FORCE = "force"  # quantity of the record of a hammer, which other records have not


# 11 fields: where a channel is from, what it is of, its values, and what is known of their noise.
@dataclass(frozen=True)
class Channel:
    """One measured function of frequency, or one record in time."""

    file: str  # file, place: where it was read
    place: str
    reference: str  # reference, response: names; the reference is empty where the file does not say
    response: str
    frequency: Floats  # (lines,) in Hz; of a record, time in s
    H: Complexes | Floats  # (lines,) complex; real where it is no function
    quantity: str = ""  # what it is; empty where the file does not say
    kind: int = FRF
    coherence: Floats | None = None  # (lines,), or None
    variance: Floats | None = None  # (lines,) of the mean, where it is known, or None
    noise: ForceNoise | None = None  # of the force of the blows, where it is known

    def fault(self, expected: str, found: str) -> Fault:
        """Return the fault of the function."""
        return Fault(self.file, self.place, expected, found)


_Groups: TypeAlias = dict[tuple[int, int], list[Channel]]  # by positions of reference and response


@dataclass(frozen=True)
class DataSet:
    """A data set of a test: its name, its functions, and warnings about them."""

    name: str
    data: FrequencyResponses
    warnings: tuple[str, ...]


def assemble(
    channels: Sequence[Channel], quantity: str, name: str, turned: bool, decay: float = 0.0
) -> DataSet:
    """Return one data set from its channels; raises InputError with everything that is wrong.

    ``quantity`` is what the test file says, or empty; ``turned`` makes the points of the hammer
    the responses, by reciprocity; ``decay`` is that of an exponential window.
    """
    quantity = _quantity(channels, quantity)
    if turned:
        channels = [replace(x, reference=x.response, response=x.reference) for x in channels]
    references = tuple(dict.fromkeys(channel.reference for channel in channels))
    responses = tuple(dict.fromkeys(channel.response for channel in channels))
    groups: _Groups = {}
    for channel in channels:
        key = references.index(channel.reference), responses.index(channel.response)
        groups.setdefault(key, []).append(channel)
    blows = max(map(len, groups.values()))
    f = channels[0].frequency
    H = np.full((blows, len(references), len(responses), len(f)), np.nan, complex)
    known = np.full((2, *H.shape[1:]), np.nan)  # coherence, and variance
    for (j, i), group in groups.items():
        for b, channel in enumerate(group):
            H[b, j, i] = channel.H
            for part, values in zip(known, (channel.coherence, channel.variance), strict=True):
                part[j, i] = part[j, i] if values is None else values
    coherence, variance = (x if blows == 1 and np.isfinite(x).any() else None for x in known)
    dead = (np.nan_to_num(H) == np.nan_to_num(H[..., :1])).all(axis=(0, 3))
    H[:, dead] = np.nan
    # Where they are turned, each point of the hammer, now a response, has noise of its own, as has
    # each measurement of a reference that was hit for several ones.
    noises = [{x.noise for x in channels if x.reference == each} for each in references]
    noise = tuple(x for each in noises for x in each if x and len(each) == 1 and not turned)
    noise, H = noise if len(noise) == len(references) else (), H if blows > 1 else H[0]
    data = frequency_responses(
        f,
        H,
        quantity,
        references=references,
        responses=responses,
        coherence=coherence,
        variance=variance,
    )
    data = replace(data, decay=decay, force_noise=noise)
    warnings = *_units(name, data, groups, dead), *_reciprocity(name, data, turned)
    return DataSet(name, data, (*warnings, *_driving_points(data, groups)))


def _quantity(channels: Sequence[Channel], declared: str) -> str:
    """Return what all channels are; raises InputError with what is wrong with any of them."""
    first, known, faults = channels[0], declared, list[Fault]()
    for channel in channels:
        f, bad = channel.frequency, np.flatnonzero(~(np.abs(channel.H) <= LARGEST))
        if not (np.isfinite(f).all() and (np.diff(f) > 0).all() and (f >= 0).all()):
            expected = "frequencies in Hz that ascend from zero or above"
            faults.append(channel.fault(expected, "others"))
        elif len(f) != len(first.frequency):
            expected = f"{len(first.frequency)} lines, as in {first.file}"
            faults.append(channel.fault(expected, f"{len(f)} lines"))
        elif np.abs(f - first.frequency).max() > 1e-6 * first.frequency[-1]:
            here, there = (f"{x[0]:g} to {x[-1]:g} Hz" for x in (f, first.frequency))
            faults.append(channel.fault(f"the frequency axis of {first.file}, {there}", here))
        if not channel.quantity and not declared:
            expected = "quantity = 'receptance', 'mobility' or 'accelerance' in [test]"
            faults.append(channel.fault(expected, "a file that does not say it"))
        elif channel.quantity and known and channel.quantity != known:
            faults.append(channel.fault(f"{known}, as in the others", channel.quantity))
        if len(bad):
            found = f"{channel.H[bad[0]].real:g} at {f[bad[0]]:g} Hz"
            found += f" and {len(bad) - 1} more" * (len(bad) > 1)
            faults.append(channel.fault(EXPECTED, found))
        known = known or channel.quantity
    if all(not np.any(channel.H[0] != channel.H) for channel in channels) and not faults:
        found = "one number" if np.any(first.H) else "only zeros"
        faults.append(first.fault("functions that are not the same at all lines", found))
    refuse(faults[:5])
    return known


def _units(name: str, data: FrequencyResponses, groups: _Groups, dead: Bools) -> Iterator[str]:
    """Warn of an axis in rad/s, dead (references, responses), and functions of other sizes."""
    if looks_like_circular(data.frequency):
        yield (
            f"set {name!r}: the frequency axis looks like rad/s: its lines are "
            f"{np.diff(data.frequency)[0]:.6g} apart, 2π times a round number; expected Hz"
        )
    size = np.sqrt(np.mean(np.abs(np.where(data.measured, data.H, 0)) ** 2, axis=2))
    living = size[~dead & (size > 0)]
    middle = float(np.median(living)) if len(living) else 0.0
    stray, gone = list[str](), dict[tuple[str, str], list[str]]()
    for (j, i), (first, *_) in groups.items():
        ratio, place = size[j, i] / middle if middle else 1.0, f"{first.file}: {first.place}"
        if dead[j, i]:
            what = "one number at all lines" if first.H.any() else "empty or only zeros"
            gone.setdefault((first.response, what), []).append(place)
        elif size[j, i] > 0 and not 1 / STRAY < ratio < STRAY:
            great = f"{ratio:.3g} times as great as the other functions are"
            stray.append(f"{place}: {great}: check its unit")
    for (_, what), (place, *others) in gone.items():
        more = f" and {len(others)} more" * bool(others)
        yield f"{place}{more}: {what}; the channel is left out"
    yield from stray


def _driving_points(data: FrequencyResponses, groups: _Groups) -> Iterator[str]:
    """Yield where a driving point gives energy back: its mobility has a negative real part."""
    lines = data.frequency > 0
    to_mobility = (2j * np.pi * data.frequency[lines]) ** (1 - ORDERS[data.quantity])
    for (j, i), (first, *_) in groups.items():
        power = (data.H[j, i, lines] * to_mobility).real
        driven = first.reference == first.response and np.isfinite(power).all()
        if driven and power.sum() < -0.5 * np.abs(power).sum():
            yield (
                f"{first.file}: {first.place}: the driving point has the wrong sign: check the "
                "directions of hammer and sensor, and the quantity"
            )


def _reciprocity(name: str, data: FrequencyResponses, turned: bool) -> Iterator[str]:
    """Yield where H_ji and H_ij differ by a sign, and which sensors differ from all others."""
    factors: dict[str, dict[str, float]] = {}  # size of each sensor over that of others
    places = {response: i for i, response in enumerate(data.responses)}
    points = [(j, x) for j, x in enumerate(data.references) if x in places]
    for (j, first), (k, second) in combinations(points, 2):
        a, b = data.H[j, places[second]], data.H[k, places[first]]
        if not (np.isfinite(a).all() and np.isfinite(b).all() and np.any(a) and np.any(b)):
            continue
        ratio = float(np.linalg.norm(a) / np.linalg.norm(b))
        inner = np.vdot(b, a) / (np.linalg.norm(a) * np.linalg.norm(b))
        if inner.real < -0.5:
            yield (
                f"set {name!r}: the functions {first}-{second} and {second}-{first} have opposite "
                "signs: check the direction of a sensor"
            )
        if abs(inner) > 0.9:  # else noise may change the ratio
            # The first was measured by the sensor at the second point, or turned.
            sensor, other = (first, second) if turned else (second, first)
            factors.setdefault(sensor, {})[other] = ratio
            factors.setdefault(other, {})[sensor] = 1 / ratio
    # Of two sensors alone, either may be the wrong one: that with the smaller numbers comes first.
    for sensor, others in sorted(factors.items(), key=lambda x: min(x[1].values())):
        if any(1 / UNEQUAL < factor < UNEQUAL for factor in others.values()):
            continue
        partner, factor = sorted(others.items(), key=lambda x: x[1])[len(others) // 2]
        alone = len(others) == len(factors[partner]) == 1
        if alone and factor > 1:
            continue
        says = f"set {name!r}: the channel {sensor} is {factor:.3g} times as great as reciprocity "
        says += f"with {', '.join(others)} says"
        if alone:
            says += f", or {partner} is {1 / factor:.3g} times"
        if abs(abs(np.log(factor)) - np.log(9.80665)) < np.log(1.05):
            says += "; 9.81 is between g and m/s²"
        yield says + ": check its unit and calibration"


def looks_like_circular(frequency: Floats) -> bool:
    """Return whether the distance of lines is 2 pi times a round number, and not round itself.

    >>> looks_like_circular(2 * np.pi * np.arange(0, 100, 0.25))
    True
    >>> looks_like_circular(np.arange(0, 100, 0.25))
    False
    """
    if len(frequency) < 3:
        return False
    step = float(frequency[-1] - frequency[0]) / (len(frequency) - 1)

    def is_round(x: float) -> bool:
        digits = x / 10 ** np.floor(np.log10(x))
        return bool(
            abs(digits * 1e3 - round(digits * 1e3)) < 1e-3
            or any(abs(1 / x - round(1 / x, k)) < 1e-6 / x for k in (0, 1))
            or any(abs(x * 2**k - round(x * 2**k)) < 1e-6 * x * 2**k for k in range(14))
        )

    return is_round(step / (2 * np.pi)) and not is_round(step)
