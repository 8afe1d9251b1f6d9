r"""Sensors that move against the model in all modes, and too little to show in any MAC value.

Among many sensors, one that moves little may be reversed without a trace in the MAC, and the COMAC
takes magnitudes. With the sign kept,

.. math:: c_s = \frac{\sum_r \psi_{rs} \beta_r \varphi_{rs}}
   {\sqrt{\sum_r \psi_{rs}^2 \sum_r (\beta_r \varphi_{rs})^2}}

is near 1 at a sensor that fits and near -1 at one that is reversed; :math:`\beta_r` scales the
paired model mode to the measured one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from modefront._typing import Floats, Ints
from modefront.diagnosis.comparison import Comparison
from modefront.diagnosis.measured import Measured

OPPOSED, AGREES = -0.95, 0.8
"""Value of a reversed sensor, and that which the median sensor has to reach."""

FITS = 0.85
"""MAC from which on a mode takes part."""

LEAST_MODES, LEAST_SENSORS = 3, 6
"""Modes that have to take part, and sensors, for signs to mean anything."""

CLEAR, SPREAD = 2.0, 2.0
"""Gain over the median residual of the sensors, and modes over which it has to be spread."""

GREAT, NEARLY = 15.0, -0.9
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


def opposed_findings(comparison: Comparison, view: Measured) -> list[OpposedSensor]:
    """Return the sensors that move against a model that fits at the others."""
    phi = comparison.phi[:, comparison.pairs.index]
    mac = comparison.mac[np.arange(phi.shape[1]), comparison.pairs.index]
    fits = np.flatnonzero(np.nan_to_num(mac) >= FITS)
    if fits.size < LEAST_MODES:
        return []
    psi, model = _scaled(view, phi, fits)
    along = (psi * model).sum(axis=0)
    size = np.sqrt((psi**2).sum(axis=0) * (model**2).sum(axis=0))
    known = size > 0
    if known.sum() < LEAST_SENSORS:
        return []
    agreement = np.divide(along, size, out=np.full(along.shape, np.nan), where=known)
    usual = float(np.median(agreement[known]))
    residual = float(np.median(((psi - model) ** 2).sum(axis=0)[known]))
    share = _by_mode(psi * model, len(fits))
    is_clear = (-4 * along > CLEAR * residual) & (_spread(share) > SPREAD)
    is_great = -4 * along > GREAT * residual
    found = ((agreement < OPPOSED) & is_clear) | ((agreement < NEARLY) & is_great)
    if usual < AGREES:
        return []
    names = comparison.data.sensors
    return [
        OpposedSensor(names[s], float(agreement[s]), usual, int(fits.size))
        for s in np.flatnonzero(found).tolist()
    ]


def _scaled(view: Measured, phi: Floats, fits: Ints) -> tuple[Floats, Floats]:
    """Return measured shapes and model shapes scaled to them, both (sets × modes, sensors)."""
    seen = view.seen[:, fits]
    model = np.where(seen, phi[:, fits].T[None], 0.0)
    psi = view.psi[:, fits]
    square = (model**2).sum(axis=2, keepdims=True)
    along = (psi * model).sum(axis=2, keepdims=True)
    model = model * np.divide(along, square, out=np.zeros(square.shape), where=square > 0)
    return psi.reshape(-1, psi.shape[2]), model.reshape(-1, psi.shape[2])


def _by_mode(values: Floats, modes: int) -> Floats:
    """Return the sum over the data sets, (modes, sensors)."""
    return np.asarray(values.reshape(-1, modes, values.shape[1]).sum(axis=0))


def _spread(share: Floats) -> Floats:
    """Return over how many modes the products (modes, sensors) are spread, (sensors,)."""
    square = (share**2).sum(axis=0)
    total = np.abs(share).sum(axis=0) ** 2
    return np.divide(total, square, out=np.zeros(total.shape), where=square > 0)
