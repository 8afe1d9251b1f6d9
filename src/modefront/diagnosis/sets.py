"""Data sets that disagree by more than their scatter: frequencies, and shapes by their cross-MAC.

The scatter of frequencies is their standard deviation where it is known, else what the other modes
show between the same data sets.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

import numpy as np

from modefront._typing import Bools, Floats, Ints
from modefront.data.modal import MEASURED, ModalData
from modefront.diagnosis.measured import Measured, assigned, measured
from modefront.diagnosis.units import cause_of

KNOWN, LEAST_KNOWN = 5.0, 0.005
"""Differences over their standard deviation, and relative ones, beyond which sets disagree."""

UNKNOWN, LEAST_UNKNOWN = 6.0, 0.03
"""The same where the scatter is that of the other modes."""

NORMAL, ALONE = 1.4826, 0.02
"""Standard deviation of a normal distribution over the median of absolute values; and the scatter
that is assumed where no other mode shows any."""

SHIFTED = 0.03, 0.25
"""Relative difference of all frequencies, and their spread over it, for a common shift."""

FACTOR = float(np.log(1.5))
"""Logarithm of a factor between all frequencies of two sets from which on it is one of units."""

RENUMBERED = 0.3
"""Cost that another numbering has to save for each mode, of 2 at most."""

ODD = 2.0
"""Distance of the farthest set from the others, over that of the next, to be the odd one."""

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
    set : a data set; of three and more, the one that all others contradict, if there is one
    others : the data set that it disagrees with, or all others
    frequency, other_frequency : in Hz; of several others, their median
    scatter : relative scatter that was expected
    """

    mode: int
    set: str
    others: tuple[str, ...]
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
    set : a data set; of three and more, the one that all others contradict, if there is one
    others : the data set that it disagrees with, or all others
    mac : their cross-MAC; of several others, the best
    resembles : mode of the other set that it resembles instead; 0 for none
    other_mac : cross-MAC with that one
    """

    mode: int
    set: str
    others: tuple[str, ...]
    mac: float
    resembles: int
    other_mac: float


Distance: TypeAlias = Callable[[Floats], float]
"""Function that returns the distance of frequencies (modes,) in Hz from those of the model."""


def factor_findings(data: ModalData, distance: Distance) -> tuple[list[SetFactor], ModalData]:
    """Return data sets in another unit than the others, and the data in the same unit.

    Which of two sets it is, the ``distance`` from the model says.
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
        closest = [(distance(f[k]), k, value) for size, k, value in far if size > 0.9 * worst]
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


def frequency_findings(data: ModalData) -> list[SetFactor | SetFrequency]:
    """Return the data sets of which all frequencies are shifted, and single ones that disagree."""
    shifts, data = _shifts(data)
    worst: dict[int, tuple[float, SetFrequency]] = {}
    for k in range(len(data.sets)):
        for j in range(k):
            for size, finding in _between(data, j, k):
                if finding.mode not in worst or size > worst[finding.mode][0]:
                    worst[finding.mode] = size, finding
    return [*shifts, *(_odd_frequency(data, finding) for _, (_, finding) in sorted(worst.items()))]


def _shifts(data: ModalData) -> tuple[list[SetFactor], ModalData]:
    """Return the sets of which all frequencies are shifted, the most first, and data without."""
    out: list[SetFactor] = []
    f, count = data.frequency.copy(), len(data.sets)
    for _ in range(count - 1):
        # Of two sets nobody can say which of them is shifted.
        shifted = [(_shift(data, f, k), k) for k in range(1 if count == 2 else 0, count)]
        value, k = max(shifted, key=lambda each: abs(each[0]))
        if value == 0:
            break
        others = [name for i, name in enumerate(data.sets) if i != k]
        out.append(SetFactor(data.sets[k], " and ".join(others[:2]), float(np.exp(value)), ""))
        f[k] /= np.exp(value)
    return out, replace(data, frequency=f) if out else data


def _shift(data: ModalData, f: Floats, k: int) -> float:
    """Return the logarithm of the common shift of frequencies f of set k; 0 for none."""
    difference = _ratio_to_others(f, k)
    if difference.size < 3:
        return 0.0
    middle = float(np.median(difference))
    spread = float(np.median(np.abs(difference - middle)))
    relative = np.nan_to_num(data.frequency_std / f)
    known = np.isfinite(f)
    sigma = float(np.sqrt(2) * np.median(relative[known])) if known.any() else 0.0
    least, share = SHIFTED
    is_shifted = abs(middle) > max(least, KNOWN * sigma) and spread < share * abs(middle)
    return middle if is_shifted else 0.0


def _odd_frequency(data: ModalData, finding: SetFrequency) -> SetFrequency:
    """Return the finding with the one set that all others contradict, where there is one."""
    r = data.modes.index(finding.mode)
    known = np.flatnonzero(np.isfinite(data.frequency[:, r]))
    if known.size < 3:
        return finding
    logs = np.log(data.frequency[known, r])
    away = np.abs(logs - np.median(logs))
    order = np.argsort(away)
    if away[order[-1]] < ODD * away[order[-2]]:
        return finding
    k = int(known[order[-1]])
    others = [int(j) for j in known if j != k]
    return replace(
        finding,
        set=data.sets[k],
        others=tuple(data.sets[j] for j in others),
        frequency=float(data.frequency[k, r]),
        other_frequency=float(np.median(data.frequency[others, r])),
    )


def _between(data: ModalData, j: int, k: int) -> list[tuple[float, SetFrequency]]:
    """Return the modes in which two sets disagree, with the difference over its limit."""
    f, std = data.frequency, np.nan_to_num(data.frequency_std)
    known = np.isfinite(f[j]) & np.isfinite(f[k])
    rows = np.flatnonzero(known)
    difference = np.log(f[k, rows] / f[j, rows])
    sigma = np.hypot(std[k, rows] / f[k, rows], std[j, rows] / f[j, rows])
    findings = []
    for i, r in enumerate(rows.tolist()):
        if sigma[i] > 0:
            scatter, limit = float(sigma[i]), max(KNOWN * float(sigma[i]), LEAST_KNOWN)
        else:
            others = np.delete(np.abs(difference), i)
            scatter = NORMAL * float(np.median(others)) if others.size else ALONE
            limit = max(UNKNOWN * scatter, LEAST_UNKNOWN)
        if abs(difference[i]) > limit:
            finding = SetFrequency(
                *(data.modes[r], data.sets[k], (data.sets[j],)),
                *(float(f[k, r]), float(f[j, r]), scatter),
            )
            findings.append((abs(float(difference[i])) / limit, finding))
    return findings


def numbering_findings(data: ModalData, of_model: Floats) -> tuple[list[SetNumbers], ModalData]:
    """Return data sets that number their modes differently, and the data numbered alike.

    ``of_model`` (modes,) are the frequencies in Hz of the paired modes of the model, which say
    which of two sets it is.
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
            rank = round(gain, 9), _median_distance(data.frequency[k], of_model)
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


def _median_distance(f: Floats, of_model: Floats) -> float:
    known = np.isfinite(f) & (of_model > 0)
    return float(np.median(np.abs(np.log(f[known] / of_model[known])))) if known.any() else 0.0


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

    changed: dict[str, Any] = {name: moved(getattr(data, name)) for name in MEASURED}
    return replace(data, **changed)


def shape_findings(data: ModalData, view: Measured) -> list[SetShape]:
    """Return the modes of which the shapes of two data sets disagree; of a mode, the worst pair.

    Of three sets and more, the one that all others contradict comes first.
    """
    worst: dict[int, SetShape] = {}
    count = len(data.sets)
    away = np.full((len(data.modes), count, count), np.nan)
    for k, j, mac in _cross(view):
        away[:, k, j] = away[:, j, k] = 1 - np.diag(mac)
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
                *(mode, data.sets[k], (data.sets[j],), float(value)),
                *(data.modes[best] if is_other else 0, float(elsewhere[best])),
            )
            if mode not in worst or value < worst[mode].mac:
                worst[mode] = finding
    return [_odd_shape(data, away[data.modes.index(m)], worst[m]) for m in sorted(worst)]


def _odd_shape(data: ModalData, away: Floats, finding: SetShape) -> SetShape:
    """Return the finding with the one set that all others contradict, where there is one.

    ``away`` (sets, sets) is 1 - MAC. The odd set is far from the nearest of the others.
    """
    known = np.flatnonzero(np.isfinite(away).any(axis=1))
    if known.size < 3:
        return finding
    nearest = np.nanmin(away[np.ix_(known, known)], axis=1)
    order = np.argsort(nearest)
    k = int(known[order[-1]])
    others = tuple(data.sets[j] for j in known if np.isfinite(away[k, j]))
    if nearest[order[-1]] < ODD * nearest[order[-2]] or len(others) < 2:
        return finding
    odd, mac = data.sets[k], float(np.nanmax(1 - away[k]))
    if odd == finding.set:
        return replace(finding, others=others, mac=mac)
    return replace(finding, set=odd, others=others, mac=mac, resembles=0)


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
