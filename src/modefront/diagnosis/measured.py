r"""Measured modes as arrays, what several data sets have in common, and pairs with model modes.

Mode r of the data and mode q of a model are as far apart as

.. math:: c_{rq} = 1 - \mathrm{MAC}_{rq} + \kappa \min(|\ln f_q - \ln \hat f_r|, d).

Shapes alone cannot tell a mode with a reversed sensor from another mode, nor frequencies alone
which of two close modes is which.

Residuals :math:`r_k` of a kind have Student's distribution with a scale :math:`\sigma` that is
expected near :math:`\sigma_0`. The negative logarithm of their probability, less a constant, is

.. math:: C = \min_\sigma \sum_k w_k \Big[\ln \sigma
   + \tfrac{\nu + 1}{2} \ln\Big(1 + \frac{r_k^2}{\nu \sigma^2}\Big)\Big]
   + \frac{1}{2 s^2} \ln^2 \frac{\sigma}{\sigma_0}.

So where all are large, a single large one is nothing special (Lange, Little & Taylor, J. Am. Stat.
Assoc. 84, 1989, doi:10.1080/01621459.1989.10478852).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from modefront._typing import Bools, Floats
from modefront.data.modal import ModalData
from modefront.rounding import ACCUMULATED, TINY

RIGID = 1e-6
"""Frequency over the greatest one below which a mode is one of a rigid body: rounding leaves the
root of 1e-13."""

KAPPA, FARTHEST = 0.4, 2.5
"""Cost of a factor e between frequencies, in units of a MAC value, up to the logarithm d."""

NU, FREQUENCY, SHAPE = 100.0, 0.005, 0.03
"""Degrees of freedom nu of noise, and its scales in frequencies and shapes where not known."""

OF_MODEL = 0.08
"""Scale that is expected of what no parameter describes, in shapes of mean square 1."""

DAMPING = float(np.log(0.01))
"""Logarithm of the damping ratio that is expected, with a scale of 1."""

ROUNDS = 8
"""Rounds of the iteration for the shape that data sets have in common."""


SCALES, SPREAD = np.linspace(-4.0, 4.0, 33), 0.5
"""Logarithms of the scales that are tried, over the one that is expected, and their spread."""

NOTHING = 0.5
"""Cost of a value of which nothing is known: of one from a normal distribution of size 1."""


def loss(r: Floats, nu: float) -> Floats:
    """Return the cost of residuals over their scale."""
    return np.asarray((nu + 1) / 2 * np.log1p(r**2 / nu))


def scaled(
    r: Floats, expected: float, nu: float, weight: Floats | float = 1.0
) -> tuple[float, float]:
    """Return C of residuals r, each with a weight, and the scale sigma with which it is least."""
    if not r.size:
        return 0.0, expected
    scales, weight = expected * np.exp(SCALES), np.broadcast_to(weight, r.shape)
    costs = loss(r / scales[:, None], nu) @ weight + weight.sum() * np.log(scales)
    costs = costs + (SCALES / SPREAD) ** 2 / 2
    k = min(max(int(np.argmin(costs)), 1), SCALES.size - 2)
    a, b, c = costs[k - 1 : k + 2]
    shift = float(np.clip((a - c) / (2 * (a - 2 * b + c) + ACCUMULATED), -0.5, 0.5))
    least = float(b - (a - c) * shift / 4)
    return least, float(scales[k] * np.exp(shift * (SCALES[1] - SCALES[0])))


@dataclass(frozen=True, eq=False)
class Measured:
    """Measured modes; NaN is what was not measured.

    Attributes
    ----------
    frequency, damping : (sets, modes) frequencies in Hz and damping ratios
    shape : (sets, modes, sensors) components
    std : (sets, modes) relative standard deviations of frequencies; NaN where not known
    left_out : cost of the values that are left out
    """

    frequency: Floats
    damping: Floats
    shape: Floats
    std: Floats
    left_out: float = 0.0

    @cached_property
    def seen(self) -> Bools:
        """Whether each component was measured, (sets, modes, sensors)."""
        return np.isfinite(self.shape)

    @cached_property
    def size(self) -> Floats:
        """Roots of the mean squares of shapes, (sets, modes); NaN of those without components."""
        square = (np.where(self.seen, self.shape, 0.0) ** 2).sum(axis=2)
        return np.sqrt(np.where(square > 0, square, np.nan) / np.maximum(self.seen.sum(axis=2), 1))

    @cached_property
    def psi(self) -> Floats:
        """The shapes with a mean square of 1, and 0 where nothing was measured."""
        return np.nan_to_num(self.shape / self.size[:, :, None])

    @cached_property
    def mean(self) -> Floats:
        """Shapes that the data sets have in common, (modes, sensors), of mean square 1, or 0.

        The best product of a factor a set and a shape, by alternating least squares.
        """
        psi = self.psi
        first = self.seen.sum(axis=2).argmax(axis=0)
        c = psi[first, np.arange(psi.shape[1])]
        if psi.shape[0] == 1:
            return c
        for _ in range(ROUNDS):
            a = self.factors(c)
            square = (a**2 * self.seen).sum(axis=0)
            c = np.divide((a * psi).sum(axis=0), square, out=np.zeros(c.shape), where=square > 0)
            size = np.sqrt((c**2).sum(axis=1) / np.maximum(self.known.sum(axis=1), 1))[:, None]
            c = np.divide(c, size, out=np.zeros(c.shape), where=size > 0)
        return c

    def factors(self, c: Floats) -> Floats:
        """Return by which factors shapes c (modes, sensors) become those measured.

        They are least squares at the measured components, (sets, modes, 1).
        """
        square = (self.seen * c**2).sum(axis=2, keepdims=True)
        along = (self.psi * c).sum(axis=2, keepdims=True)
        return np.divide(along, square, out=np.zeros(along.shape), where=square > 0)

    @cached_property
    def motion(self) -> Floats:
        """Scale of the differences from a model at each sensor, (sensors,), 1 at a typical one.

        Noise is the same everywhere, and what no parameter describes is a share of the motion.
        """
        square = (self.mean**2).sum(axis=0) / np.maximum(self.known.sum(axis=0), 1)
        least = (SHAPE / OF_MODEL) ** 2
        return np.sqrt((least + square) / (least + 1))

    @cached_property
    def known(self) -> Bools:
        """Which components any data set has, (modes, sensors)."""
        return np.asarray(self.seen.any(axis=0))

    @cached_property
    def logs(self) -> Floats:
        """Medians of the logarithms of frequencies, (modes,); NaN where none."""
        return median(np.log(self.frequency))

    @cached_property
    def noise(self) -> float:
        """Cost of the differences between data sets, and of damping ratios.

        Of n values that are compared with their mean, n - 1 are free: each has the weight
        (n - 1) / n, and its difference is greater by the root of the inverse.
        """
        zeta = median(np.where(self.damping > 0, self.damping, np.nan))
        damping = np.log(zeta[np.isfinite(zeta)]) - DAMPING
        total = float(loss(damping, NU).sum()) + self.left_out
        std = np.where(np.isfinite(self.std), self.std, FREQUENCY)
        frequencies = (np.log(self.frequency) - self.logs) / std
        shapes = self.psi - self.factors(self.mean) * self.mean
        for r, known, expected, unit in (
            (shapes, self.seen, SHAPE, np.ones(shapes.shape)),
            (frequencies, np.isfinite(frequencies), 1.0, std),
        ):
            free = 1 - 1 / np.maximum(known.sum(axis=0), 1)
            several = known & (free > 0)
            weight = np.broadcast_to(free, r.shape)[several]
            total += scaled(r[several] / np.sqrt(weight), expected, NU, weight)[0]
            total += float(np.log(unit[several]) @ weight)
        return total


def measured(data: ModalData) -> Measured:
    """Return the modes of ``data`` as arrays."""
    with np.errstate(divide="ignore", invalid="ignore"):
        std = data.frequency_std / data.frequency
    return Measured(data.frequency, data.damping, data.shape, np.where(std > 0, std, np.nan))


def median(values: Floats) -> Floats:
    """Return the median of each column over what is finite; NaN where nothing is."""
    ascending = np.sort(values, axis=0)
    count = np.isfinite(values).sum(axis=0)[None]
    low, high = np.maximum(count - 1, 0) // 2, np.minimum(count // 2, len(values) - 1)
    below, above = (np.take_along_axis(ascending, k, axis=0)[0] for k in (low, high))
    return np.asarray((below + above) / 2)


def mac_values(psi: Floats, known: Bools, phi: Floats) -> Floats:
    """Return the MAC of shapes (modes, sensors) and those of a model, (modes, model modes).

    ``phi`` is (sensors, model modes). It is NaN with fewer than two known components.
    """
    cross = (psi @ phi) ** 2
    norm = (psi**2).sum(axis=1)[:, None] * (known @ phi**2)
    values = np.divide(cross, norm, out=np.zeros(norm.shape), where=norm > 0)
    values[known.sum(axis=1) < 2] = np.nan
    return values


def pair_costs(mac: Floats, logs: Floats, of_model: Floats) -> Floats:
    """Return c, shape (modes, model modes), from logarithms of frequencies; see the module."""
    distance = np.abs(of_model - logs[:, None])
    distance = np.where(np.isnan(distance), 0.0, np.minimum(distance, FARTHEST))
    return np.where(np.isnan(mac), 0.0, 1 - mac) + KAPPA * distance


def log_frequencies(frequency: Floats) -> Floats:
    """Return logarithms of a model's frequencies; those of rigid-body modes are far below all."""
    least = RIGID * float(frequency.max(initial=0.0))
    return np.log(np.maximum(frequency, max(least, TINY)))


def comac(view: Measured, phi: Floats) -> Floats:
    r"""Return the COMAC of each sensor over paired modes, (sensors,); NaN where not measured.

    .. math:: \frac{(\sum_r |\psi_{rs} \varphi_{rs}|)^2}{\sum_r \psi_{rs}^2 \sum_r \varphi_{rs}^2}

    (Lieven & Ewins, 6th International Modal Analysis Conference, 1988). ``phi`` (sensors, modes)
    are the model modes that belong to the measured ones.
    """
    phi = np.where(view.seen, phi.T[None], 0.0)
    phi, psi = (
        np.divide(x, size, out=np.zeros(x.shape), where=size > 0)
        for x in (phi, view.psi)
        for size in [np.linalg.norm(x, axis=2, keepdims=True)]
    )
    cross = np.abs(psi * phi).sum(axis=(0, 1)) ** 2
    norm = (psi**2).sum(axis=(0, 1)) * (phi**2).sum(axis=(0, 1))
    return np.divide(cross, norm, out=np.full(norm.shape, np.nan), where=norm > 0)
