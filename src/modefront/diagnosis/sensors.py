r"""Sensors that are reversed or exchanged, in one data set or in all.

Changes are sought one after the other, each the one that helps most. Between data sets, no
model is needed: the same mode has the same shape. Against the model, the frequencies keep a mode
with a reversed sensor from being taken for another one; `modefront.diagnosis.explain` proves what
is found.

Changes of sensors that explain the measured shapes: a reversed sign, two sensors exchanged.

With cross products :math:`x = \psi^T \varphi` of a measured and a model mode, reversing sensor s
makes :math:`x - 2 \psi_s \varphi_s` of it, and exchanging s and t
:math:`x + (\psi_t - \psi_s)(\varphi_s - \varphi_t)`; neither changes the lengths. So all changes
are tried at the cost of a few products.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from modefront._typing import Floats
from modefront.diagnosis.comparison import Comparison
from modefront.diagnosis.measured import Measured, assigned, mac_values, pair_costs

MOST_EXCHANGED = 60
"""Sensors among which all pairs are tried; of more, those that resemble the model least."""


@dataclass(frozen=True)
class Change:
    """A sensor reversed, or two of them exchanged.

    Attributes
    ----------
    sensors : one sensor, which is reversed, or two, which are exchanged; positions from 0
    """

    sensors: tuple[int, ...]

    @property
    def is_reversal(self) -> bool:
        """Whether the sign of one sensor changes."""
        return len(self.sensors) == 1

    def of(self, values: Floats) -> Floats:
        """Return values (..., sensors) with the change made."""
        out = values.copy()
        if self.is_reversal:
            out[..., self.sensors[0]] *= -1
        else:
            out[..., list(self.sensors)] = values[..., list(self.sensors[::-1])]
        return out


def applied(changes: Sequence[Change], view: Measured, sets: Sequence[int]) -> Measured:
    """Return measured modes with changes made in some data sets."""
    psi, seen = view.psi.copy(), view.seen.copy()
    chosen = list(sets)
    for change in changes:
        psi[chosen] = change.of(psi[chosen])
        if not change.is_reversal:
            seen[chosen] = change.of(seen[chosen].astype(float)) > 0
    return replace(view, psi=psi, seen=seen)


def changes_with_macs(
    view: Measured, phi: Floats, among: Sequence[int]
) -> Iterator[tuple[Change, Floats]]:
    """Yield every change with the MAC values (modes, model modes) that it leads to.

    All sensors are reversed in turn; pairs ``among`` some are exchanged, gaps and all.
    """
    usable = view.seen.sum(axis=2) > 1
    count = np.maximum(usable.sum(axis=0), 1)[:, None]
    missing = ~usable.any(axis=0)
    x, square = view.psi @ phi, phi**2
    seen = view.seen.astype(float)
    length = (view.psi**2).sum(axis=2)[:, :, None] * usable[:, :, None]
    model_length = seen @ square

    def mean(x: Floats, norm: Floats) -> Floats:
        ratio = np.divide(length * x**2, norm, out=np.zeros(norm.shape), where=norm > 0)
        values = np.asarray(ratio.sum(axis=0) / count)
        values[missing] = np.nan
        return values

    measured = np.flatnonzero(view.psi.any(axis=(0, 1))).tolist()
    for s in measured:
        yield Change((s,)), mean(x - 2 * view.psi[:, :, s, None] * phi[s], model_length)
    for i, s in enumerate(among):
        for t in among[i + 1 :]:
            difference = (view.psi[:, :, t] - view.psi[:, :, s])[:, :, None]
            gaps = (seen[:, :, t] - seen[:, :, s])[:, :, None]
            norm = model_length + gaps * (square[s] - square[t])
            yield Change((s, t)), mean(x + difference * (phi[s] - phi[t]), norm)


def best_change(
    view: Measured, phi: Floats, cost: Callable[[Floats], float], among: Sequence[int]
) -> tuple[Change, float] | None:
    """Return the change with the least cost of its MAC values; None where there is no change."""
    candidates = [(cost(mac), change) for change, mac in changes_with_macs(view, phi, among)]
    if not candidates:
        return None
    value, change = min(candidates, key=lambda pair: pair[0])
    return change, value


def comac(view: Measured, phi: Floats) -> Floats:
    r"""Return the COMAC of each sensor over paired modes, (sensors,); NaN where not measured.

    .. math:: \frac{(\sum_r |\psi_{rs} \varphi_{rs}|)^2}{\sum_r \psi_{rs}^2 \sum_r \varphi_{rs}^2}

    (Lieven & Ewins, 6th International Modal Analysis Conference, 1988). ``phi`` (sensors, modes)
    are the model modes that belong to the measured ones.
    """
    phi = np.where(view.seen, phi.T[None], 0.0)
    size = np.linalg.norm(phi, axis=2, keepdims=True)
    phi = np.divide(phi, size, out=np.zeros(phi.shape), where=size > 0)
    cross = np.abs(view.psi * phi).sum(axis=(0, 1)) ** 2
    norm = (view.psi**2).sum(axis=(0, 1)) * (phi**2).sum(axis=(0, 1))
    return np.divide(cross, norm, out=np.full(norm.shape, np.nan), where=norm > 0)


def suspects(view: Measured, phi: Floats) -> list[int]:
    """Return the sensors between which exchanges are tried, those of the least COMAC.

    ``phi`` (sensors, modes) are the model modes that belong to the measured ones.
    """
    values = comac(view, phi)
    known = np.flatnonzero(np.isfinite(values))
    return sorted(known[np.argsort(values[known], kind="stable")][:MOST_EXCHANGED].tolist())


MOST = 8
"""Changes that are sought at most."""

HELPS = 0.25
"""Share of the unexplained part of the shapes that a change has to remove to be tried further."""

LEAST = 0.02
"""Decrease of 1 - MAC, mean over the modes, below which a change is not worth its name."""


@dataclass(frozen=True)
class WrongSensors:
    """Changes of sensors that explain the measured shapes.

    Attributes
    ----------
    changes : names of the sensors of each change: one is reversed, two are exchanged
    sets : data sets in which they are; empty for all of them
    mode : measured mode that gains most
    before, after : MAC of this mode, with the model or with the other data sets
    against : "model", or "sets" where the data sets contradict each other
    other : sensors of which the opposite change does the same
    """

    changes: tuple[tuple[str, ...], ...]
    sets: tuple[str, ...]
    mode: int
    before: float
    after: float
    against: str
    other: tuple[str, ...] = ()


def between_sets(comparison: Comparison, view: Measured) -> tuple[list[WrongSensors], Measured]:
    """Return the changes in single data sets that others contradict, and the data without them."""
    out: list[WrongSensors] = []
    sets, count = comparison.data.sets, len(comparison.data.sets)
    for _ in range(MOST if count > 1 else 0):
        best: tuple[float, int, Change, Floats, Floats] | None = None
        for k in range(count):
            before = _with_others(view, view, k)
            total = float(np.nansum(1 - before))
            if np.isnan(before).all() or total < LEAST * np.isfinite(before).sum():
                continue
            for change in _changes_between(view, k):
                after = _with_others(applied([change], view, [k]), view, k)
                gain = total - float(np.nansum(1 - after))
                if best is None or gain > best[0] * 1.0001:
                    best = gain, k, change, before, after
        if best is None or not _is_clear(best[3], best[4]):
            break
        gain, k, change, before, after = best
        k = _culprit(comparison, view, k, change)
        view = applied([change], view, [k])
        out.append(wrong_sensors([change], comparison, before, after, (sets[k],), "sets"))
    return _merged(out), view


def _with_others(changed: Measured, view: Measured, k: int) -> Floats:
    """Return the mean MAC of each mode of data set k with the other sets, (modes,)."""
    total, pairs = np.zeros(view.psi.shape[1]), np.zeros(view.psi.shape[1])
    for other in range(view.psi.shape[0]):
        if other == k:
            continue
        common = changed.seen[k] & view.seen[other]
        a, b = np.where(common, changed.psi[k], 0.0), np.where(common, view.psi[other], 0.0)
        norm = (a**2).sum(axis=1) * (b**2).sum(axis=1)
        usable = (common.sum(axis=1) > 2) & (norm > 0)
        total += np.where(usable, (a * b).sum(axis=1) ** 2 / np.where(norm > 0, norm, 1.0), 0.0)
        pairs += usable
    return np.divide(total, pairs, out=np.full(total.shape, np.nan), where=pairs > 0)


def _changes_between(view: Measured, k: int) -> list[Change]:
    measured = np.flatnonzero(view.seen[k].any(axis=0)).tolist()
    pairs = [(s, t) for i, s in enumerate(measured[:60]) for t in measured[i + 1 : 60]]
    return [*(Change((s,)) for s in measured), *map(Change, pairs)]


def _is_clear(before: Floats, after: Floats) -> bool:
    """Return whether MAC values after a change are clearly above those before."""
    missing, left = np.nansum(1 - before), np.nansum(1 - after)
    count = int(np.isfinite(before).sum())
    return bool(missing - left > max(LEAST * count, 0.6 * missing))


def _culprit(comparison: Comparison, view: Measured, k: int, change: Change) -> int:
    """Return the set in which a change is: of two sets that contradict each other, the model says.

    Where there are three and more, the others agree on it.
    """
    if view.psi.shape[0] > 2:
        return k
    costs = []
    for position in range(2):
        changed = applied([change], view, [position])
        mac = mac_values(changed.psi, changed.seen, comparison.phi)
        cost = pair_costs(mac, view.log_frequency, comparison.log_frequency, 0.0)
        costs.append(assigned(cost)[1])
    return int(np.argmin(costs))


def searched(comparison: Comparison, view: Measured, shift: float) -> list[Change]:
    """Return the changes in all data sets that help, one after the other, by the nominal model.

    ``shift`` is the logarithm of the factor by which all measured frequencies are too great.
    """
    phi, logs, of_model = comparison.phi, view.log_frequency, comparison.log_frequency
    count = int(view.has_shape.sum())

    def cost(mac: Floats) -> float:
        return assigned(pair_costs(mac, logs, of_model, shift))[1]

    mac = mac_values(view.psi, view.seen, phi)
    changes: list[Change] = []
    total, changed = cost(mac), view
    for _ in range(MOST if count else 0):
        index, _ = assigned(pair_costs(mac, logs, of_model, shift))
        change = best_change(changed, phi, cost, suspects(changed, phi[:, index]))
        if change is None or total - change[1] < max(LEAST * count, HELPS * total):
            break
        changes.append(change[0])
        total, changed = change[1], applied(changes, view, range(view.psi.shape[0]))
        mac = mac_values(changed.psi, changed.seen, phi)
    return changes


def wrong_sensors(
    changes: Sequence[Change],
    comparison: Comparison,
    before: Floats,
    after: Floats,
    sets: tuple[str, ...],
    against: str,
) -> WrongSensors:
    """Return the finding of changes with the MAC (modes,) ``before`` and ``after`` them."""
    names = comparison.data.sensors
    r = int(np.nanargmax(after - before))
    other: tuple[str, ...] = ()
    measured = np.flatnonzero(comparison.view.seen.any(axis=(0, 1))).tolist()
    if len(changes) == 1 and changes[0].is_reversal and len(measured) == 2:
        other = (names[next(s for s in measured if s != changes[0].sensors[0])],)
    return WrongSensors(
        tuple(tuple(names[s] for s in change.sensors) for change in changes),
        sets,
        comparison.data.modes[r],
        float(before[r]),
        float(after[r]),
        against,
        other,
    )


def by_sets(
    in_sets: Sequence[WrongSensors], in_all: WrongSensors, sets: Sequence[str]
) -> list[WrongSensors]:
    """Return the findings with a change in some sets and again in all as one in the other sets."""
    twice = {c for c in in_all.changes if any(c in finding.changes for finding in in_sets)}
    out = [
        replace(finding, changes=tuple(c for c in finding.changes if c not in twice))
        for finding in (*in_sets, in_all)
    ]
    for change in in_all.changes:
        if change in twice:
            right = {
                name for finding in in_sets if change in finding.changes for name in finding.sets
            }
            wrong = tuple(name for name in sets if name not in right)
            out.append(replace(in_all, changes=(change,), sets=wrong))
    return [finding for finding in out if finding.changes]


def _merged(findings: Sequence[WrongSensors]) -> list[WrongSensors]:
    """Return the findings with those of one data set joined."""
    out: dict[tuple[str, ...], WrongSensors] = {}
    for finding in findings:
        known = out.get(finding.sets)
        if known is not None:
            best = max(known, finding, key=lambda each: each.after - each.before)
            changes = (*known.changes, *finding.changes)
            finding = replace(best, changes=changes, other=finding.other)
        out[finding.sets] = finding
    return list(out.values())
