r"""Sensors that move against the model in all modes, and too little to show in any MAC value.

Among many sensors, one that moves little may be reversed without a trace in the MAC, and the COMAC
takes magnitudes. With the sign kept,

.. math:: c_s = \frac{\sum_r \psi_{rs} \beta_r \varphi_{rs}}
   {\sqrt{\sum_r \psi_{rs}^2 \sum_r (\beta_r \varphi_{rs})^2}}

is near 1 at a sensor that fits and near -1 at one that is reversed; :math:`\beta_r` scales the
paired model mode to the measured one at all other sensors. Two sensors that move nearly alike and
are exchanged show likewise in their difference, :math:`\psi_{rs} - \psi_{rt}`. A reversal lowers
the squares of the residuals by :math:`-4 \sum_r \psi_{rs} \beta_r \varphi_{rs}`, an exchange by
half of that of the difference.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from modefront._typing import Bools, Floats, Ints
from modefront.diagnosis.measured import Measured
from modefront.rounding import ACCUMULATED

OPPOSED, AGREES = -0.95, 0.8
"""Value of a reversed sensor, and that which the median sensor has to reach."""

FITS = 0.85
"""MAC from which on a mode takes part."""

MOST_SENSORS = 1000
"""Sensors among which all pairs are looked at."""

LEAST_MODES, LEAST_SENSORS = 3, 6
"""Modes that have to take part, and sensors, for signs to mean anything."""

CLEAR, SPREAD = 1.5, 2.0
"""Gain over the median residual of the sensors, and modes over which it has to be spread."""

GREAT, NEARLY = 6.0, -0.9
"""The same gain, beyond which it may come from a single mode, and the value that does then."""


@dataclass(frozen=True)
class OpposedSensor:
    """A sensor moves against the model in all modes, or the difference of two does.

    Attributes
    ----------
    sensors : its name; of two that are exchanged, both
    agreement : c, -1 for exactly the opposite
    usual : that of the median sensor
    modes : number of modes that took part
    """

    sensors: tuple[str, ...]
    agreement: float
    usual: float
    modes: int


def opposed_findings(sensors: Sequence[str], view: Measured, phi: Floats) -> list[OpposedSensor]:
    """Return the sensors that move against a model that fits at the others, then pairs of them.

    ``phi`` (sensors, modes) are the model modes that belong to the measured ones.
    """
    setting = _Setting.of(view, phi)
    single, unit = setting.single()
    known = np.isfinite(single.agreement)
    if known.sum() < LEAST_SENSORS:
        return []
    usual = float(np.median(single.agreement[known]))
    if usual < AGREES:
        return []
    strongest: dict[tuple[int, ...], tuple[Evidence, int]] = {
        (s,): (single, s) for s in np.flatnonzero(single.is_opposed).tolist()
    }
    pairs: list[tuple[float, int, int, Evidence, int]] = []
    for s in range(min(len(sensors), MOST_SENSORS) - 1):
        others = np.arange(s + 1, min(len(sensors), MOST_SENSORS))
        pair = setting.pairs(s, others, unit)
        opposed = np.flatnonzero(pair.is_opposed).tolist()
        pairs += [(float(pair.gain[k]), s, int(others[k]), pair, k) for k in opposed]
    taken = {s for key in strongest for s in key}
    for _, s, t, pair, k in sorted(pairs, key=lambda each: -each[0]):
        if not {s, t} & taken:
            strongest[s, t] = pair, k
            taken |= {s, t}
    return [
        OpposedSensor(
            tuple(sensors[s] for s in key),
            float(evidence.agreement[k]),
            usual,
            int(evidence.modes[k]),
        )
        for key, (evidence, k) in strongest.items()
    ]


@dataclass(frozen=True, eq=False)
class Evidence:
    """Motion of sensors, or differences of them, beside a model scaled to all other sensors.

    Attributes
    ----------
    agreement : (places,) c; NaN where too few modes fit
    gain : (places,) decrease of the squared residuals by a reversal, over the median sensor's
    spread : (places,) number of modes over which this is spread
    modes : (places,) number of modes that take part
    """

    agreement: Floats
    gain: Floats
    spread: Floats
    modes: Ints

    @property
    def is_opposed(self) -> Bools:
        """Which places are reversed."""
        c = self.agreement
        is_clear = (c < OPPOSED) & (self.gain > CLEAR) & (self.spread > SPREAD)
        return np.asarray(is_clear | ((c < NEARLY) & (self.gain > GREAT)))


@dataclass(frozen=True, eq=False)
class _Setting:
    """Measured and model shapes, (sets, modes, sensors), 0 where not measured, and their products.

    A mode takes part at a place where it fits at all other sensors: a reversed one must not hide
    itself.
    """

    seen: Bools
    psi: Floats
    model: Floats

    @staticmethod
    def of(view: Measured, phi: Floats) -> _Setting:
        return _Setting(view.seen, view.psi, np.where(view.seen, phi.T[None], 0.0))

    def single(self) -> tuple[Evidence, float]:
        """Return the evidence on each sensor, and the square of the median sensor's residuals."""
        psi, model, modes = self._scaled([np.arange(self.psi.shape[2])])
        known = modes >= LEAST_MODES
        residual = ((psi[0] - model[0]) ** 2).sum(axis=(0, 1))[known]
        unit = float(np.median(residual)) if residual.size else 0.0
        return _evidence(psi[0], model[0], modes, 4.0, unit), unit

    def pairs(self, s: int, others: Ints, unit: float) -> Evidence:
        """Return the evidence on the differences of a sensor and others."""
        psi, model, modes = self._scaled([np.array([s]), others])
        return _evidence(psi[0] - psi[1], model[0] - model[1], modes, 2.0, unit)

    def _scaled(self, places: Sequence[Ints]) -> tuple[list[Floats], list[Floats], Ints]:
        """Return measured and scaled model shapes at places (sets, modes, places), and modes."""
        psi, model = self.psi, self.model
        parts = [(psi[:, :, k], model[:, :, k]) for k in places]
        x = (psi * model).sum(axis=2, keepdims=True) - sum([p * m for p, m in parts])
        a = (psi**2).sum(axis=2, keepdims=True) - sum([p**2 for p, _ in parts])
        b = (model**2).sum(axis=2, keepdims=True) - sum([m**2 for _, m in parts])
        norm = a * b
        mac = np.divide(x**2, norm, out=np.zeros(norm.shape), where=norm > ACCUMULATED)
        fits = (mac >= FITS) & np.logical_and.reduce(
            np.broadcast_arrays(*(self.seen[:, :, k] for k in places), mac >= FITS)
        )
        beta = np.divide(x, b, out=np.zeros(b.shape), where=fits)
        modes = np.asarray(fits.any(axis=0).sum(axis=0))
        return [np.where(fits, p, 0.0) for p, _ in parts], [beta * m for _, m in parts], modes


def _evidence(psi: Floats, model: Floats, modes: Ints, factor: float, unit: float) -> Evidence:
    """Return the evidence of shapes (sets, modes, places); ``factor`` makes gains of products."""
    along = (psi * model).sum(axis=(0, 1))
    size = np.sqrt((psi**2).sum(axis=(0, 1)) * (model**2).sum(axis=(0, 1)))
    known = (size > 0) & (modes >= LEAST_MODES)
    agreement = np.divide(along, size, out=np.full(along.shape, np.nan), where=known)
    gain = -factor * along / unit if unit > 0 else np.where(along < 0, np.inf, 0.0)
    return Evidence(
        agreement, np.where(known, gain, 0.0), _spread((psi * model).sum(axis=0)), modes
    )


def _spread(share: Floats) -> Floats:
    """Return over how many modes the products (modes, places) are spread, (places,)."""
    square = (share**2).sum(axis=0)
    total = np.abs(share).sum(axis=0) ** 2
    return np.divide(total, square, out=np.zeros(total.shape), where=square > 0)
