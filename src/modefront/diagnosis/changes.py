r"""Changes of sensors that explain the measured shapes: a reversed sign, two sensors exchanged.

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
from modefront.diagnosis.measured import Measured

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
