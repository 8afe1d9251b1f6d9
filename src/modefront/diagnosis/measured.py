r"""Measured modes as arrays that the diagnosis compares with a model, or with one another.

Mode r of the data and mode q of the model are as far apart as

.. math:: c_{rq} = 1 - \mathrm{MAC}_{rq} + \kappa \min(|\ln f_q - \ln \hat f_r + s|, d)

where s is the logarithm of a factor on all measured frequencies. Shapes alone cannot tell a mode
with a reversed sensor from another mode, nor frequencies alone which of two close modes is which.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from modefront._typing import Bools, Floats, Ints
from modefront.data.modal import ModalData
from modefront.rounding import TINY

RIGID = 1e-6
"""Frequency over the greatest one below which a mode is one of a rigid body: rounding leaves the
root of 1e-13."""

KAPPA = 0.4
"""Cost of a factor e between frequencies, in units of a MAC value."""

FARTHEST = 2.5
"""Logarithm of the ratio of frequencies beyond which the cost grows no more."""


@dataclass(frozen=True, eq=False)
class Measured:
    """Shapes of length 1 and logarithms of frequencies; what was not measured is 0 and masked.

    Attributes
    ----------
    psi : (sets, modes, sensors) shapes
    seen : (sets, modes, sensors) whether the component was measured
    log_frequency : (modes,) mean logarithm of the frequencies in Hz; NaN where none
    """

    psi: Floats
    seen: Bools
    log_frequency: Floats

    @property
    def has_shape(self) -> Bools:
        """Which modes have a shape at two sensors at least, shape (modes,)."""
        return np.asarray((self.seen.sum(axis=2) > 1).any(axis=0))


def measured(data: ModalData) -> Measured:
    """Return the modes of ``data`` as arrays."""
    seen = np.isfinite(data.shape)
    psi = np.where(seen, data.shape, 0.0)
    size = np.linalg.norm(psi, axis=2, keepdims=True)
    psi = np.divide(psi, size, out=np.zeros(psi.shape), where=size > 0)
    return Measured(psi, seen, _mean_log(data.frequency))


def _mean_log(frequency: Floats) -> Floats:
    known = np.isfinite(frequency)
    logs = np.log(np.where(known, frequency, 1.0)).sum(axis=0)
    count = known.sum(axis=0)
    return np.divide(logs, count, out=np.full(logs.shape, np.nan), where=count > 0)


def mac_values(psi: Floats, seen: Bools, phi: Floats) -> Floats:
    """Return the MAC of measured and model modes, (modes, model modes); NaN without a shape.

    ``psi`` and ``seen`` are (sets, modes, sensors), ``phi`` (sensors, model modes); the mean over
    the data sets that have the shape at two sensors at least.
    """
    cross = (psi @ phi) ** 2
    norm = (psi**2).sum(axis=2)[:, :, None] * (seen @ phi**2)
    values = np.divide(cross, norm, out=np.zeros(norm.shape), where=norm > 0)
    usable = seen.sum(axis=2) > 1
    count = usable.sum(axis=0)[:, None]
    total = np.where(usable[:, :, None], values, 0.0).sum(axis=0)
    return np.divide(total, count, out=np.full(total.shape, np.nan), where=count > 0)


def pair_costs(mac: Floats, log_frequency: Floats, of_model: Floats, shift: float) -> Floats:
    """Return c, shape (modes, model modes); see the module.

    ``of_model`` (model modes,) are logarithms of frequencies, ``shift`` is s.
    """
    distance = np.abs(of_model - (log_frequency[:, None] - shift))
    distance = np.where(np.isnan(distance), 0.0, np.minimum(distance, FARTHEST))
    return np.where(np.isnan(mac), 0.0, 1 - mac) + KAPPA * distance


def assigned(cost: Floats) -> tuple[Ints, float]:
    """Return the model mode of each measured mode, each taken once at most, and the whole cost."""
    index = np.argmin(cost, axis=1)
    if np.unique(index).size < index.size <= cost.shape[1]:
        from scipy.optimize import linear_sum_assignment

        index = np.asarray(linear_sum_assignment(cost)[1])
    return index, float(cost[np.arange(index.size), index].sum())


def log_frequencies(frequency: Floats) -> Floats:
    """Return logarithms of a model's frequencies; those of rigid-body modes are far below all."""
    least = RIGID * float(frequency.max(initial=0.0))
    return np.log(np.maximum(frequency, max(least, TINY)))
