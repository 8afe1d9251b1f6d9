"""Frequency response functions from the records of impacts.

The estimators and the windows are those of docs/methods/deviations.md. A record that stays at its
greatest value, and gets there by more than the resolution of its numbers, is overloaded. A second
hit is a push beyond `SECOND` of the peak after the first impact has ended.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Literal, TypeAlias

import numpy as np
import scipy

from modefront._typing import Complexes, Floats
from modefront.data.responses import (
    EXPECTED,
    FORCE,
    Channel,
    ForceNoise,
    FrequencyResponses,
    frequency_responses,
)
from modefront.errors import Fault, InputError, refuse
from modefront.options import Checked, Requirement, any_of, number
from modefront.rounding import ACCUMULATED, LARGEST

Estimator = Literal["H1", "H2", "Hv"]
EXPONENTIAL = Requirement(
    "a time constant in s above zero, or 'none'",
    any_of({"type": "number", "exclusiveMinimum": 0}, {"enum": ["none"]}),
    lambda value: np.inf if value == "none" else float(value),
)

EVEN = 1e-3  # relative difference within which rates and durations are equal: files hold few digits
ROUNDED = 0.3  # of a step by which digits may move a sample in time
SECOND = 0.1  # force of a second hit over that of the first
SAME = 1e-9  # difference of two samples, over the greatest, that is none: converters have 24 bits
TAPER = 0.1  # share of the force window over which it falls to zero


@dataclass(frozen=True)
class Windows(Checked):
    """Estimator and windows that make functions of records."""

    estimator: Estimator = "H1"
    # seconds after the peak beyond which the force is set to zero
    force_window: Annotated[float, number("a time in s above zero", above=0)] | None = None
    # time constant in seconds, by default a quarter of the record; infinity is no window
    exponential: Annotated[float, EXPONENTIAL] | None = None


@dataclass(frozen=True)
class ImpactResponses:
    """Functions from impacts."""

    data: FrequencyResponses  # with the variance of their mean from the scatter of the blows
    coherence: Floats  # (responses, lines)
    left_out: tuple[str, ...]  # (blows,) why each blow is not in the mean; empty where it is
    remaining: Floats  # (responses,) rms at the end of the windowed records over the greatest


def impact_responses(
    force: Floats,
    response: Floats,
    rate: float,
    quantity: str = "accelerance",
    windows: Windows | None = None,
    responses: tuple[str, ...] | None = None,
) -> ImpactResponses:
    """Return the functions of one reference from several blows.

    These are a ``force`` (blows, samples) and a ``response`` (blows, responses, samples), with
    ``rate`` samples per second; ``quantity`` is what responses over force are.

    Double hits and overloads are left out and said. What the exponential window adds to all decay
    rates is noted in the data, and `identify` takes it off. Raises ValueError where no blow is
    left, or where the arrays do not fit.
    """
    windows = windows or Windows()
    force, response = np.asarray(force, float), np.asarray(response, float)
    if force.ndim != 2 or response.ndim != 3 or response.shape[::2] != force.shape:
        expected = "force (blows, samples) and response (blows, responses, samples)"
        raise ValueError(f"expected {expected}, found {force.shape} and {response.shape}")
    blows = zip(force, response, strict=True)
    reasons = tuple(_reason(x, y, rate, windows.force_window) for x, y in blows)
    if all(reasons):
        faults = "; ".join(f"blow {b}: {why}" for b, why in enumerate(reasons, start=1))
        raise ValueError(f"expected at least one good blow, found none: {faults}")
    used = np.array([not why for why in reasons])
    force, response = force[used], response[used]
    t = np.arange(force.shape[1]) / rate
    decay = 1 / (len(t) * t[1] / 4 if windows.exponential is None else windows.exponential)
    window = np.broadcast_to(np.exp(-decay * t), force.shape)
    if (length := windows.force_window) is not None:
        peaks = t[np.abs(force).argmax(axis=1)][:, None]
        past = (t - peaks - length * (1 - TAPER)) / (length * TAPER)
        window = (0.5 + 0.5 * np.cos(np.pi * np.clip(past, 0, 1))) * window
    y = response * np.exp(-decay * t)
    X, Y = scipy.fft.rfft(force * window), scipy.fft.rfft(y)
    S_xx, S_yy = (np.sum(np.abs(x) ** 2, axis=0) for x in (X, Y))
    S_yx = np.sum(Y * X[:, None].conj(), axis=0)
    size = np.abs(S_yx)
    coherence = _over(size, S_xx).real * _over(size, S_yy).real
    H = {
        "H1": _over(S_yx, S_xx),
        "H2": _over(S_yy, S_yx.conj()),
        "Hv": _over(S_yx, size) * np.sqrt(_over(S_yy, S_xx).real),
    }[windows.estimator]
    variance = _variance(H, X, Y)[None] if len(X) > 1 else None
    f = scipy.fft.rfftfreq(force.shape[1], 1 / rate)
    data = frequency_responses(f, H, quantity, responses=responses, variance=variance)
    data = replace(data, decay=decay, force_noise=(_force_noise(force, window, X, t),))
    part = max(y.shape[-1] // 20, 1)
    parts = y[..., : y.shape[-1] // part * part].reshape(*y.shape[:2], -1, part)
    rms = np.sqrt(np.mean(parts**2, axis=(0, 3)))
    remaining = rms[:, -1] / np.maximum(rms.max(axis=1), np.finfo(float).tiny)
    return ImpactResponses(data, coherence, reasons, remaining)


def _variance(H: Complexes, X: Complexes, Y: Complexes) -> Floats:
    r"""Return the variance of the functions from the scatter of the blows, (responses, lines).

    With :math:`e_b = Y_b - H X_b` and :math:`h_b = |X_b|^2 / S_{xx}`, it is
    :math:`\sum_b |X_b e_b|^2 / (1 - h_b) / S_{xx}^2`, also where hard blows have more noise than
    soft ones (MacKinnon & White, J. Econom. 29 (1985) 305-325, doi:10.1016/0304-4076(85)90158-7:
    HC2); coherence knows one level of noise only.
    """
    power = np.abs(X) ** 2
    share = _over(power, np.sum(power, axis=0)).real[:, None]
    e = np.abs(Y - H * X[:, None]) ** 2
    left = np.maximum(1 - share, np.finfo(float).eps)
    return np.asarray(_over(np.sum(share * e / left, axis=0), np.sum(power, axis=0)).real)


def _force_noise(force: Floats, window: Floats, X: Complexes, t: Floats) -> ForceNoise:
    """Return the effect of noise of the force, from the second half of records, on functions."""
    quiet = force[:, force.shape[1] // 2 :]
    level = np.mean((quiet - quiet.mean(axis=1, keepdims=True)) ** 2, axis=1)
    energy = window**2
    power = np.abs(X) ** 2
    of_blows = (level * energy.sum(axis=1))[:, None]
    variance = _over(np.sum(power * of_blows, axis=0), np.sum(power, axis=0) ** 2).real
    kept = energy[0] > 1e-4 * energy[0].max()
    times = t[kept] - t[np.abs(force[0]).argmax()]
    share = energy[0, kept] / energy[0, kept].sum()
    return ForceNoise(np.sqrt(np.nan_to_num(variance)), times, share)


def _over(a: Complexes | Floats, b: Complexes | Floats) -> Complexes:
    """Return a / b, NaN where the power b is no more than rounding of its greatest value."""
    good = np.abs(b) > ACCUMULATED**2 * np.abs(b).max(initial=0.0)
    return np.asarray(np.where(good, a / np.where(good, b, 1.0), np.nan).astype(complex))


def _reason(x: Floats, y: Floats, rate: float, force_window: float | None) -> str:
    if not (np.isfinite(x).all() and np.isfinite(y).all()):
        return "not all samples are numbers"
    if not np.any(x):
        return "there is no force"
    size = np.abs(x)
    peak = int(size.argmax())
    if _clipped(x):
        return "the force is overloaded"
    for i, channel in enumerate(y, start=1):
        if _clipped(channel):
            return f"response {i} is overloaded"
    after = np.flatnonzero(size[peak:] < SECOND / 2 * size[peak])
    end = peak + int(after[0]) if len(after) else len(x)
    if force_window is not None:
        end = max(end, peak + int(force_window * rate))
    push = x[end:] * np.sign(x[peak])  # a filter that rings after the impact pulls first
    again = np.flatnonzero(push > SECOND * size[peak])
    if len(again):
        return f"a second hit {(end + again[0] - peak) / rate:.3g} s after the first"
    return ""


def _clipped(x: Floats) -> bool:
    """Return whether a record stays at its greatest value, and gets there in a leap.

    Digits of a coarse converter stay at the top of a smooth wave too, one step above the next.
    """
    size = np.abs(x)
    top = (size >= size.max() * (1 - SAME)) & np.any(x)
    steps = np.pad(np.abs(np.diff(x)), 1)  # to each sample, and away from it
    least = steps[steps > SAME * size.max()].min(initial=np.inf)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], top, [False]]).astype(int)))
    start, end = edges[::2], edges[1::2]
    leaps = np.maximum(steps[start], steps[end])
    return bool(((end - start >= 3) & (leaps > 2 * least)).any())


Blow: TypeAlias = Mapping[str, Channel]  # records of one impact by name, and that of the force


def blows_of(records: Iterable[Channel]) -> list[Blow]:
    """Return the records of impacts: one ends where a channel comes again, or another force."""
    groups: list[dict[str, Channel]] = [{}]
    for record in records:
        key = FORCE if record.quantity == FORCE else record.response
        groups += [{}] if key in groups[-1] else []
        groups[-1][key] = record
    return [group for group in groups if FORCE in group and len(group) > 1]


def unevenness(time: Floats) -> str:
    """Return in words how a time axis is not even but for its digits; empty where it is."""
    count, length = len(time) - 1, float(time[-1] - time[0])
    if count < 2 or not length > 0:  # nor where the column is empty
        return "others"
    off = np.abs(time - time[0] - np.arange(count + 1) * (length / count)).max()
    if off <= ROUNDED * length / count:
        return ""
    return f"times off by up to {off:.3g} s, steps of {length / count:.3g} s"


def averaged(blows: Sequence[Blow], windows: Windows) -> tuple[list[Channel], list[str], float]:
    """Return the functions of all references, warnings, and the decay of the window in 1/s.

    Raises InputError where records do not fit, or no blow of a reference is left.
    """
    time, faults = blows[0][FORCE].frequency, list[Fault]()
    groups: dict[tuple[str, ...], list[Blow]] = {}
    for blow in blows:
        force, t = blow[FORCE], blow[FORCE].frequency
        responses = [name for name in blow if name != FORCE]
        groups.setdefault((force.reference, *responses), []).append(blow)
        quantities = {blow[name].quantity for name in responses}
        short = [record for record in blow.values() if len(record.H) != len(force.H)]
        if short:
            expected = f"{len(force.H)} samples, as the force of {force.place}"
            faults.append(short[0].fault(expected, str(len(short[0].H))))
        elif len(quantities) > 1:
            found = ", ".join(sorted(each or "others" for each in quantities))
            faults.append(force.fault("responses of one quantity", found))
        elif uneven := unevenness(t):
            faults.append(force.fault("a time axis of even steps", uneven))
        elif len(t) != len(time) or abs(np.ptp(t) / np.ptp(time) - 1) > EVEN:
            here, there = (f"{len(x)} samples over {np.ptp(x):.6g} s" for x in (t, time))
            expected = f"records of {there}, as in {blows[0][FORCE].file}"
            faults.append(force.fault(expected, here))
        elif not all((np.abs(record.H) <= LARGEST).all() for record in blow.values()):
            faults.append(force.fault(EXPECTED, "others"))
    refuse(faults[:5])
    channels, warnings = list[Channel](), list[str]()
    for (reference, *names), group in groups.items():
        first, place = group[0][FORCE], f"blows at {reference!r}"
        forces = np.array([blow[FORCE].H for blow in group])
        records = np.array([[blow[name].H for name in names] for blow in group])
        moving = np.ptp(records, axis=2).any(axis=0)
        if not moving.any():
            raise InputError(Fault(first.file, place, "a response that moves", "none"))
        rate = (len(time) - 1) / float(np.ptp(first.frequency))
        try:
            result = impact_responses(
                forces, records * moving[:, None], rate, windows=windows, responses=tuple(names)
            )
        except ValueError as error:
            expected, _, found = str(error).removeprefix("expected ").partition(", found none: ")
            raise InputError(Fault(first.file, place, expected, found)) from None
        data, (noise,) = result.data, result.data.force_noise
        for k, name in enumerate(names):
            variance = None if data.variance is None else data.variance[0, k]
            known = first.file, f"response {name!r}", reference, name
            H = np.where(moving[k], data.H[0, k], 0)  # of a response that is still
            values = data.frequency, H, group[0][name].quantity
            channels.append(Channel(*known, *values, variance=variance, noise=noise))
        warnings += [
            f"{blow[FORCE].file}: {blow[FORCE].place}: the blow is left out: {why}"
            for blow, why in zip(group, result.left_out, strict=True)
            if why
        ]
        if (worst := result.remaining.max()) > 0.05:  # more leaks
            left = f"responses still have {worst:.0%} of their size at the end of the record"
            advice = "[impact] exponential takes a shorter time constant"
            warnings.append(f"{first.file}: {left}: expect errors of leakage; {advice}")
    return channels, warnings, result.data.decay
