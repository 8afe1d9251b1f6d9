"""Data sets that disagree by more than their scatter: frequencies, and shapes by their cross-MAC.

The scatter of frequencies is their standard deviation where it is known, else what the other modes
show between the same data sets.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from modefront._typing import Bools, Floats, Ints
from modefront.data.modal import ModalData
from modefront.diagnosis.measured import Measured, assigned, measured
from modefront.diagnosis.units import cause_of

KNOWN, LEAST_KNOWN = 5.0, 0.005
"""Differences over their standard deviation, and relative ones, beyond which sets disagree."""

UNKNOWN, LEAST_UNKNOWN = 6.0, 0.03
"""The same where the scatter is that of the other modes."""

SHIFTED = 0.03, 0.25
"""Relative difference of all frequencies, and their spread over it, for a common shift."""

FACTOR = float(np.log(1.5))
"""Logarithm of a factor between all frequencies of two sets from which on it is one of units."""

RENUMBERED = 0.3
"""Cost that another numbering has to save for each mode, of 2 at most."""

CROSS_MAC, SCATTER = 0.85, 6.0
"""Cross-MAC below which shapes disagree, and 1 - MAC over that of the other modes."""


@dataclass(frozen=True)
class SetFactor:
    """All frequencies of a data set are off those of the others by about the same factor.

    Attributes
    ----------
    set, other : the data set, and the one or the ones that it is compared with
    factor : median of the ratio of its frequencies
    cause : a cause of `modefront.diagnosis.units.NAMED`, or empty
    """

    set: str
    other: str
    factor: float
    cause: str


@dataclass(frozen=True)
class SetFrequency:
    """The frequency of a mode in one data set disagrees with that in another.

    Attributes
    ----------
    mode : measured mode
    set, other : the data sets
    frequency, other_frequency : in Hz
    scatter : relative scatter that was expected
    """

    mode: int
    set: str
    other: str
    frequency: float
    other_frequency: float
    scatter: float


@dataclass(frozen=True)
class SetNumbers:
    """A data set numbers its modes differently than the others.

    Attributes
    ----------
    set, other : the data set, and those that it is compared with
    modes : numbers of its modes
    of : numbers that these have in the other sets
    """

    set: str
    other: str
    modes: tuple[int, ...]
    of: tuple[int, ...]


@dataclass(frozen=True)
class SetShape:
    """The shapes of a mode in two data sets do not resemble each other.

    Attributes
    ----------
    mode : measured mode
    set, other : the data sets
    mac : their cross-MAC
    resembles : mode of the other set that it resembles instead; 0 for none
    other_mac : cross-MAC with that one
    """

    mode: int
    set: str
    other: str
    mac: float
    resembles: int
    other_mac: float


def factor_findings(data: ModalData, of_model: Floats) -> tuple[list[SetFactor], ModalData]:
    """Return data sets in another unit than the others, and the data in the same unit.

    ``of_model`` (modes,) are frequencies in Hz of the model, which says which of two sets it is.
    """
    out: list[SetFactor] = []
    f = data.frequency.copy()
    for _ in range(len(data.sets) - 1):
        ratios = [
            (float(np.median(known)), k)
            for k in range(len(f))
            for known in [_ratio_to_others(f, k)]
            if known.size
        ]
        far = [(abs(value), k, value) for value, k in ratios if abs(value) > FACTOR]
        if not far:
            break
        worst = max(far)[0]
        closest = [
            (_distance(f[k], of_model), k, value) for size, k, value in far if size > 0.9 * worst
        ]
        _, k, value = max(closest)
        others = [name for i, name in enumerate(data.sets) if i != k]
        factor = float(np.exp(value))
        out.append(SetFactor(data.sets[k], " and ".join(others[:2]), factor, cause_of(factor)))
        f[k] /= factor
    return out, replace(data, frequency=f) if out else data


def _ratio_to_others(f: Floats, k: int) -> Floats:
    """Return the logarithms of the ratios of frequencies of set k to the median of the others."""
    others = np.delete(f, k, axis=0)
    known = np.isfinite(f[k]) & np.isfinite(others).any(axis=0)
    if not known.any():
        return np.zeros(0)
    return np.asarray(np.log(f[k, known] / np.nanmedian(others[:, known], axis=0)))


def _distance(f: Floats, of_model: Floats) -> float:
    known = np.isfinite(f) & (of_model > 0)
    return float(np.median(np.abs(np.log(f[known] / of_model[known])))) if known.any() else 0.0


def frequency_findings(data: ModalData) -> list[SetFactor | SetFrequency]:
    """Return the frequencies in which pairs of data sets disagree; of a mode, the worst pair."""
    worst: dict[int, tuple[float, SetFrequency]] = {}
    out: list[SetFactor | SetFrequency] = []
    for k, first in enumerate(data.sets):
        for j in range(k):
            shift, found = _between(data, j, k)
            if shift:
                out.append(SetFactor(first, data.sets[j], float(np.exp(shift)), ""))
            for size, finding in found:
                if finding.mode not in worst or size > worst[finding.mode][0]:
                    worst[finding.mode] = size, finding
    return [*out, *(finding for _, (_, finding) in sorted(worst.items()))]


def _between(data: ModalData, j: int, k: int) -> tuple[float, list[tuple[float, SetFrequency]]]:
    """Return the common shift of two sets, 0 for none, and the modes in which they disagree."""
    f, std = data.frequency, np.nan_to_num(data.frequency_std)
    known = np.isfinite(f[j]) & np.isfinite(f[k])
    rows = np.flatnonzero(known)
    difference = np.log(f[k, rows] / f[j, rows])
    sigma = np.hypot(std[k, rows] / f[k, rows], std[j, rows] / f[j, rows])
    middle = float(np.median(difference)) if rows.size else 0.0
    spread = float(np.median(np.abs(difference - middle))) if rows.size else 0.0
    least, share = SHIFTED
    shifted = (
        rows.size > 2
        and abs(middle) > max(least, KNOWN * float(np.median(sigma)))
        and spread < share * abs(middle)
    )
    difference = difference - middle if shifted else difference
    found = []
    for i, r in enumerate(rows.tolist()):
        if sigma[i] > 0:
            scatter, limit = float(sigma[i]), max(KNOWN * float(sigma[i]), LEAST_KNOWN)
        else:
            others = np.delete(np.abs(difference), i)
            scatter = 1.4826 * float(np.median(others)) if others.size else 0.02
            limit = max(UNKNOWN * scatter, LEAST_UNKNOWN)
        if abs(difference[i]) > limit:
            finding = SetFrequency(
                *(data.modes[r], data.sets[k], data.sets[j]),
                *(float(f[k, r]), float(f[j, r]), scatter),
            )
            found.append((abs(float(difference[i])) / limit, finding))
    return middle if shifted else 0.0, found


def numbering_findings(data: ModalData, of_model: Floats) -> tuple[list[SetNumbers], ModalData]:
    """Return data sets that number their modes differently, and the data numbered alike.

    ``of_model`` (modes,) are frequencies in Hz of the model, which says which of two sets it is.
    """
    out: list[SetNumbers] = []
    for _ in range(len(data.sets) - 1):
        best: tuple[float, float, int, Ints, Floats] | None = None
        for k in range(len(data.sets)):
            cost = _renumbering_cost(data, k)
            m = np.arange(len(cost))
            index, least = assigned(cost)
            gain = float(np.trace(cost)) - least
            changed = int((index != m).sum())
            if not changed or gain < max(RENUMBERED * changed, 0.5 * float(np.trace(cost))):
                continue
            rank = round(gain, 9), _distance(data.frequency[k], of_model)
            if best is None or rank > best[:2]:
                best = *rank, k, index, cost
        if best is None:
            break
        _, _, k, index, cost = best
        rows = np.flatnonzero(index != np.arange(index.size))
        out.append(
            SetNumbers(
                data.sets[k],
                " and ".join([name for i, name in enumerate(data.sets) if i != k][:2]),
                tuple(data.modes[r] for r in rows),
                tuple(data.modes[index[r]] for r in rows),
            )
        )
        data = _renumbered(data, k, index)
    return out, data


def _renumbering_cost(data: ModalData, k: int) -> Floats:
    """Return how far mode r of set k is from mode t of the other sets, (modes, modes), their mean.

    Modes without anything in common keep their numbers.
    """
    view, logs = measured(data), np.log(data.frequency)
    total, count = np.zeros((len(data.modes),) * 2), np.zeros((len(data.modes),) * 2)
    for j in range(len(data.sets)):
        if j == k:
            continue
        mac = _cross_mac(view.psi[k], view.seen[k], view.psi[j], view.seen[j])
        distance = np.abs(logs[k][:, None] - logs[j][None, :])
        known = np.isfinite(mac) | np.isfinite(distance)
        total += np.nan_to_num(1 - mac) + np.minimum(np.nan_to_num(4 * distance), 1.0)
        count += known
    keep = 1.0 - np.eye(len(data.modes))
    return np.where(count > 0, total / np.maximum(count, 1), keep)


def _renumbered(data: ModalData, k: int, index: Ints) -> ModalData:
    """Return the data with mode r of set k called as mode index[r]."""

    def moved(values: Floats) -> Floats:
        out = values.copy()
        out[k, index] = values[k]
        return out

    return replace(
        data,
        frequency=moved(data.frequency),
        damping=moved(data.damping),
        shape=moved(data.shape),
        frequency_std=moved(data.frequency_std),
        shape_std=moved(data.shape_std),
    )


def shape_findings(data: ModalData, view: Measured) -> list[SetShape]:
    """Return the modes of which the shapes of two data sets disagree; of a mode, the worst pair."""
    worst: dict[int, SetShape] = {}
    for k, j, mac in _cross(view):
        for r, mode in enumerate(data.modes):
            value = mac[r, r]
            others = np.delete(np.diag(mac), r)
            others = others[np.isfinite(others)]
            scatter = float(np.median(1 - others)) if others.size else 0.0
            if np.isnan(value) or 1 - value <= max(1 - CROSS_MAC, SCATTER * scatter):
                continue
            elsewhere = np.where(np.arange(len(mac)) == r, -1.0, np.nan_to_num(mac[r], nan=-1.0))
            best = int(np.argmax(elsewhere))
            is_other = elsewhere[best] > 0.8
            finding = SetShape(
                *(mode, data.sets[k], data.sets[j], float(value)),
                *(data.modes[best] if is_other else 0, float(elsewhere[best])),
            )
            if mode not in worst or value < worst[mode].mac:
                worst[mode] = finding
    return [worst[mode] for mode in sorted(worst)]


def _cross(view: Measured) -> Iterator[tuple[int, int, Floats]]:
    """Yield pairs of data sets with the cross-MAC of their modes; NaN with too few sensors."""
    for k in range(view.psi.shape[0]):
        for j in range(k):
            yield k, j, _cross_mac(view.psi[k], view.seen[k], view.psi[j], view.seen[j])


def _cross_mac(a: Floats, seen_a: Bools, b: Floats, seen_b: Bools) -> Floats:
    """Return the MAC of modes (modes, sensors) of two sets at the sensors that both have."""
    cross = (a @ b.T) ** 2
    norm = (a**2 @ seen_b.T) * (seen_a @ (b**2).T)
    common = seen_a.astype(float) @ seen_b.T.astype(float)
    out = np.full(cross.shape, np.nan)
    return np.divide(cross, norm, out=out, where=(common > 2) & (norm > 0))
