r"""Sensors that move against the model in all modes, and too little to show in any MAC value.

Among many sensors, one that moves little may be reversed without a trace in the MAC, and the COMAC
takes magnitudes. With the sign kept,

.. math:: c_s = \frac{\sum_r \psi_{rs} \beta_r \varphi_{rs}}
   {\sqrt{\sum_r \psi_{rs}^2 \sum_r (\beta_r \varphi_{rs})^2}}

is near 1 at a sensor that fits and near -1 at one that is reversed; :math:`\beta_r` scales the
paired model mode to the measured one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from modefront._typing import Bools, Floats, Ints
from modefront.diagnosis.measured import Measured

OPPOSED, AGREES = -0.95, 0.8
"""Value of a reversed sensor, and that which the median sensor has to reach."""

FITS = 0.85
"""MAC from which on a mode takes part."""

LEAST_MODES, LEAST_SENSORS = 3, 6
"""Modes that have to take part, and sensors, for signs to mean anything."""

CLEAR, SPREAD = 2.0, 2.0
"""Gain over the median residual of the sensors, and modes over which it has to be spread."""

GREAT, NEARLY = 6.0, -0.9
"""The same gain, beyond which it may come from a single mode, and the value that does then."""


@dataclass(frozen=True)
class OpposedSensor:
    """A sensor moves against the model in all modes.

    Attributes
    ----------
    sensor : its name
    agreement : c, -1 for exactly the opposite
    usual : median of the other sensors
    modes : number of modes that took part
    """

    sensor: str
    agreement: float
    usual: float
    modes: int


def opposed_findings(sensors: Sequence[str], view: Measured, phi: Floats) -> list[OpposedSensor]:
    """Return the sensors that move against a model that fits at the others.

    ``phi`` (sensors, modes) are the model modes that belong to the measured ones.
    """
    evidence = evidence_of(view, phi)
    known = np.isfinite(evidence.agreement)
    if known.sum() < LEAST_SENSORS:
        return []
    usual = float(np.median(evidence.agreement[known]))
    if usual < AGREES:
        return []
    return [
        OpposedSensor(sensors[s], float(evidence.agreement[s]), usual, int(evidence.modes[s]))
        for s in np.flatnonzero(evidence.is_opposed).tolist()
    ]


@dataclass(frozen=True, eq=False)
class Evidence:
    """How each sensor moves beside a model that is scaled to all other sensors.

    Attributes
    ----------
    agreement : (sensors,) c; NaN where too few modes fit
    gain : (sensors,) decrease of the squared residuals by a reversal, over the median sensor's
    spread : (sensors,) number of modes over which this is spread
    modes : (sensors,) number of modes that take part
    """

    agreement: Floats
    gain: Floats
    spread: Floats
    modes: Ints

    @property
    def is_opposed(self) -> Bools:
        """Which sensors are reversed."""
        c = self.agreement
        is_clear = (c < OPPOSED) & (self.gain > CLEAR) & (self.spread > SPREAD)
        return np.asarray(is_clear | ((c < NEARLY) & (self.gain > GREAT)))


def evidence_of(view: Measured, phi: Floats) -> Evidence:
    """Return the evidence for and against a reversal of each sensor.

    ``phi`` (sensors, modes) are the model modes that belong to the measured ones. A mode takes part
    where it fits at all other sensors: a reversed one must not hide itself.
    """
    seen = view.seen
    model = np.where(seen, phi.T[None], 0.0)
    own = view.psi * model
    x = own.sum(axis=2, keepdims=True) - own
    b = (model**2).sum(axis=2, keepdims=True) - model**2
    a = (view.psi**2).sum(axis=2, keepdims=True) - view.psi**2
    norm = a * b
    mac = np.divide(x**2, norm, out=np.zeros(norm.shape), where=norm > 1e-12)
    fits = seen & (mac >= FITS)
    beta = np.divide(x, b, out=np.zeros(b.shape), where=fits)
    psi, model = np.where(fits, view.psi, 0.0), beta * model
    along = (psi * model).sum(axis=(0, 1))
    size = np.sqrt((psi**2).sum(axis=(0, 1)) * (model**2).sum(axis=(0, 1)))
    modes = fits.any(axis=0).sum(axis=0)
    known = (size > 0) & (modes >= LEAST_MODES)
    agreement = np.divide(along, size, out=np.full(along.shape, np.nan), where=known)
    residual = ((psi - model) ** 2).sum(axis=(0, 1))[known]
    unit = float(np.median(residual)) if residual.size else 0.0
    gain = -4 * along / unit if unit > 0 else np.where(along < 0, np.inf, 0.0)
    share = (psi * model).sum(axis=0)
    return Evidence(agreement, np.where(known, gain, 0.0), _spread(share), modes)


def _spread(share: Floats) -> Floats:
    """Return over how many modes the products (modes, sensors) are spread, (sensors,)."""
    square = (share**2).sum(axis=0)
    total = np.abs(share).sum(axis=0) ** 2
    return np.divide(total, square, out=np.zeros(total.shape), where=square > 0)
