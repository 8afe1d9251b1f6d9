r"""Data and model as arrays, what several data sets have in common, and the cost of residuals.

Residuals :math:`r_k` of a kind have Student's distribution with a scale :math:`\sigma` that is
expected near :math:`\sigma_0`. The negative logarithm of their probability, less a constant, is

.. math:: C = \min_\sigma \sum_k w_k \Big[\ln \sigma
   + \tfrac{\nu + 1}{2} \ln\Big(1 + \frac{r_k^2}{\nu \sigma^2}\Big)\Big]
   + \frac{1}{2 s^2} \ln^2 \frac{\sigma}{\sigma_0}.

So where all are large, a single large one is nothing special (Lange, Little & Taylor, J. Am. Stat.
Assoc. 84, 1989, doi:10.1080/01621459.1989.10478852). C is convex in :math:`\ln \sigma`.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property

import numpy as np

from modefront._typing import Bools, Floats, Ints

NU = 100.0  # degrees of freedom of noise
FREQUENCY, SHAPE = 0.005, 0.03  # its scales where they are not known
OF_MODEL = 0.08  # scale that is expected of what no parameter describes, in shapes of mean square 1
DAMPING = float(np.log(0.01))  # logarithm of the damping ratio that is expected, with a scale of 1
ROUNDS = 8  # rounds of the iterations for the shape that data sets have in common and for a scale
SETTLED = 1e-7  # change of the logarithm of a scale after which the next one is rounding
SPREAD = 0.5  # spread s of logarithms of scales

NOTHING = 0.5  # cost of an unknown value: of one from a normal distribution of size 1


def ratio(a: Floats, b: Floats) -> Floats:
    """Return a / b, and 0 where b is 0."""
    a, b = np.broadcast_arrays(a, b)
    return np.asarray(np.divide(a, b, out=np.zeros(a.shape), where=b != 0))


def loss(r: Floats, nu: float) -> Floats:
    """Return the cost of residuals over their scale."""
    return np.asarray((nu + 1) / 2 * np.log1p(r**2 / nu))


def scaled(
    r: Floats, expected: float, nu: float, weight: Floats, near: Floats | None = None
) -> tuple[Floats, Floats]:
    """Return C of residuals r (..., n) with weights, and the scale sigma with which it is least."""
    square, total, log = r**2, weight.sum(axis=-1), np.zeros(r.shape[:-1])
    log += 0.0 if near is None else np.log(near / expected)
    for _ in range(ROUNDS):
        q = square / (nu * (expected * np.exp(log[..., None])) ** 2 + square)
        slope = total - (nu + 1) * np.einsum("...n,...n->...", weight, q) + log / SPREAD**2
        q -= q**2
        curvature = 2 * (nu + 1) * np.einsum("...n,...n->...", weight, q) + 1 / SPREAD**2
        change = np.clip(slope / curvature, -1.0, 1.0)
        log -= change
        if np.abs(change).max(initial=0.0) < SETTLED:
            break
    sigma = expected * np.exp(log)
    of_residuals = (weight * loss(r / sigma[..., None], nu)).sum(axis=-1)
    return of_residuals + total * np.log(sigma) + (log / SPREAD) ** 2 / 2, sigma


@dataclass(frozen=True, eq=False)
class State:
    """Data and model under an explanation, or under each of several, as further axes in front.

    It is what a mistake may change. What was not measured, or is left out, is NaN.
    """

    frequency: Floats  # frequency, damping: (..., sets, modes) frequencies in Hz and damping ratios
    damping: Floats
    shape: Floats  # (..., sets, modes, sensors) components
    std: Floats  # (..., sets, modes) relative deviations of frequencies; NaN where not known
    left_out: Floats  # (...) cost of the values that are left out
    candidates: Ints  # (...) number of the lowest model modes among which pairs are sought
    nodes: Ints  # (..., sensors) node of each sensor; -1 for one that stands still
    along: Floats  # (..., sensors, 3) direction that each measures
    part: Ints  # (...) number of the part of the model that is scaled, from 1; 0 for none
    start: Floats  # (..., parameters) nominal values; the last is the factor on a part, if any

    def of(self, chosen: Ints) -> "State":
        """Return some of several states, with what is known of them."""
        new = replace(self)
        vars(new).update({k: x[chosen] for k, x in vars(self).items()})
        return new

    @cached_property
    def seen(self) -> Bools:
        """Whether each component was measured, (..., sets, modes, sensors)."""
        return np.isfinite(self.shape)

    @cached_property
    def size(self) -> Floats:
        """Roots of the mean squares of shapes, (..., sets, modes); NaN without components."""
        square = (np.where(self.seen, self.shape, 0.0) ** 2).sum(axis=-1)
        return np.sqrt(np.where(square > 0, square, np.nan) / np.maximum(self.seen.sum(axis=-1), 1))

    @cached_property
    def psi(self) -> Floats:
        """The shapes with a mean square of 1, and 0 where nothing was measured."""
        return np.nan_to_num(self.shape / self.size[..., None])

    @cached_property
    def mean(self) -> Floats:
        """Shapes that sets have in common, of mean square 1, or 0, by alternating least squares."""
        first = self.seen.sum(axis=-1).argmax(axis=-2)[..., None, :, None]
        c = np.take_along_axis(self.psi, first, axis=-3)[..., 0, :, :]
        for _ in range(ROUNDS if self.psi.shape[-3] > 1 else 0):
            a = self.factors(c)
            c = ratio((a * self.psi).sum(axis=-3), (a**2 * self.seen).sum(axis=-3))
            count = np.maximum(self.known.sum(axis=-1, keepdims=True), 1)
            c = ratio(c, np.sqrt((c**2).sum(axis=-1, keepdims=True) / count))
        return np.asarray(c)

    def factors(self, c: Floats) -> Floats:
        """Return factors (..., sets, modes, 1) from c (..., modes, sensors) to measured shapes."""
        c = c[..., None, :, :]
        square = (self.seen * c**2).sum(axis=-1, keepdims=True)
        return ratio((self.psi * c).sum(axis=-1, keepdims=True), square)

    @cached_property
    def motion(self) -> Floats:
        """Scale of the differences from a model at each sensor, (..., sensors), typically 1.

        Noise is the same everywhere, and what no parameter describes is a share of the motion.
        """
        square = (self.mean**2).sum(axis=-2) / np.maximum(self.known.sum(axis=-2), 1)
        least = (SHAPE / OF_MODEL) ** 2
        return np.sqrt((least + square) / (least + 1))

    @cached_property
    def known(self) -> Bools:
        """Which components any data set has, (..., modes, sensors)."""
        return np.asarray(self.seen.any(axis=-3))

    @cached_property
    def logs(self) -> Floats:
        """Medians of the logarithms of frequencies, (..., modes); NaN where none."""
        return median(np.log(self.frequency))

    @cached_property
    def noise(self) -> Floats:
        """Cost of the differences between data sets, and of damping ratios, (...).

        Of n values that are compared with their mean, n - 1 are free: each has the weight
        (n - 1) / n, and its difference is greater by the root of the inverse.
        """
        zeta = median(np.where(self.damping > 0, self.damping, np.nan))
        total = loss(np.nan_to_num(np.log(zeta) - DAMPING), NU).sum(axis=-1) + self.left_out
        std = np.where(np.isfinite(self.std), self.std, FREQUENCY)
        frequencies = (np.log(self.frequency) - self.logs[..., None, :]) / std
        shapes = self.psi - self.factors(self.mean) * self.mean[..., None, :, :]
        for r, known, expected, unit in (
            (shapes, self.seen, SHAPE, 1.0),
            (frequencies[..., None], np.isfinite(frequencies)[..., None], 1.0, std[..., None]),
        ):
            free = 1 - 1 / np.maximum(known.sum(axis=-3, keepdims=True), 1)
            weight, r = known * free, ratio(np.where(known, r, 0.0), np.sqrt(free))
            total = total + (weight * np.log(unit)).sum(axis=(-3, -2, -1))
            several = (*r.shape[:-3], -1)
            total = total + scaled(r.reshape(several), expected, NU, weight.reshape(several))[0]
        return np.asarray(total)


def stacked(states: Sequence[State]) -> State:
    """Return several states as one."""
    return State(*(np.stack([getattr(x, each.name) for x in states]) for each in fields(State)))


def median(values: Floats) -> Floats:
    """Return the median of each column (..., rows, columns) over what is finite, or NaN."""
    ascending, count = np.sort(values, axis=-2), np.isfinite(values).sum(axis=-2, keepdims=True)
    middle = np.maximum(count - 1, 0) // 2, np.minimum(count // 2, values.shape[-2] - 1)
    both = [np.take_along_axis(ascending, k, axis=-2)[..., 0, :] for k in middle]
    return np.asarray(np.mean(both, axis=0))
