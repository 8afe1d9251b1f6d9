"""Which model mode belongs to which measured mode (``docs/methods/residuals.md``).

Candidates whose frequency lies outside the window cost more than any within. On request modes are
paired in their order: measured mode r is model mode r.
"""

from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np

from modefront._typing import Floats, Ints
from modefront.data.modal import ModalData
from modefront.optim.scalarisation import LogSum
from modefront.options import Checked, number, whole
from modefront.rounding import TINY

POOR = 0.5  # MAC below which a pair is poor
OUTSIDE = 1e3  # cost of a candidate outside the window of frequencies
UNSEEN = 1e-6  # component of a mode at the sensors, over that of all, below which it is noise
# Candidates, unless a number is given: the nominal model's modes up to this frequency, over the
# highest measured one; beyond the measured ones, so many at least and at most.
REACH, FEWEST, MOST = 1.3, 3, 40

WINDOW = number("a ratio of frequencies above 1", above=1)


@dataclass(frozen=True)
class Pairing(Checked):
    """Rule by which measured modes and model modes are paired.

    Raises InputError for values that are not possible.

    Attributes
    ----------
    method : ``"mac"``, one to one with the greatest sum of MAC values; ``"order"``, measured mode r
        is model mode r
    window : greatest ratio of frequencies of a pair, above 1, where others are left; None for no
        limit
    spare : number of model modes, 0 or more, that are candidates beyond the number of measured
        ones; None for those of the nominal model up to 1.3 times the highest measured frequency, 3
        at least and 40 at most
    """

    method: Literal["mac", "order"] = "mac"
    window: Annotated[float, WINDOW] | None = None
    spare: Annotated[int, whole(0, 1000)] | None = None


@dataclass(frozen=True)
class Pairs:
    """Model mode of each measured mode, and how well they match."""

    index: Ints  # (measured modes,) model modes, counted from 0
    mac: Floats  # (measured modes,) mean MAC over the data sets; NaN where no shape was measured


def modes_needed(pairing: Pairing, data: ModalData, size: int) -> int:
    """Return how many model modes are looked at; ``size`` is the number that there are at most."""
    if pairing.method == "order":
        return max(data.modes)
    spare = FEWEST if pairing.spare is None else pairing.spare
    return min(size, max(max(data.modes), len(data.modes) + spare))


# 6 arguments: the measured modes and the model's, and what is least with the pairs.
def match(
    pairing: Pairing,
    data: ModalData,
    frequency: Floats,
    phi: Floats,
    squares: Floats | None = None,
    likelihood: LogSum | None = None,
) -> Pairs:
    """Pair every measured mode with a model mode.

    ``frequency`` (modes,) in Hz and ``phi`` (sensors, modes) are the model's. With the squares of
    the residuals of each pair (groups, measured modes, modes), ``likelihood``, a concave function
    of their sums over the pairs, is least: its linearisation lies above it, and is a sum over
    pairs, so that the assignment that is best for it lowers the function, until none does. It
    begins at the pairs by MAC and by frequency. Raises ValueError where there are fewer model modes
    than measured ones.
    """
    m, q = len(data.modes), frequency.size
    values = mean_mac(data, phi)
    if pairing.method == "order":
        index = np.array(data.modes, dtype=np.intp) - 1
        return Pairs(index, values[np.arange(m), index])
    if q < m:
        raise ValueError(f"{m} measured modes cannot be paired with {q} model modes")
    with np.errstate(divide="ignore"):
        ratio = np.maximum(frequency, TINY) / data.mean_frequency[:, None]
        distance, outside = np.abs(np.log(ratio)), np.zeros((m, q))
    if pairing.window is not None:
        outside = np.where(distance > np.log(pairing.window), OUTSIDE, 0.0)
    cost = np.nan_to_num(np.where(np.isnan(values), distance, 1 - values))
    index = assigned(cost + outside)
    if squares is not None and likelihood is not None:
        silent, flat = np.asarray(~squares.any(axis=(0, 2)))[:, None], squares.reshape(-1, m * q)
        rest = np.where(silent, cost, 0.0)
        nearest = np.where(np.isnan(distance), cost, distance)
        found, starts = [], [index, assigned(nearest + outside)]
        for index in starts[: 1 + (starts[0] != starts[1]).any()]:
            value = np.inf
            while True:
                J = squares[:, np.arange(m), index].sum(axis=1)
                if (now := likelihood.value(J)) >= value:
                    break
                value, kept = now, index
                total = (likelihood.gradient(J) @ flat).reshape(m, q) + rest
                index = assigned(total + total.max() * outside)
            found.append((value, kept))
        index = min(found, key=lambda x: x[0])[1]
    return Pairs(index, values[np.arange(m), index])


def assigned(cost: Floats) -> Ints:
    """Return the column of each row, one to one, with the least sum of costs (rows, columns)."""
    index = cost.argmin(axis=1)
    if len(set(index.tolist())) < len(cost):
        from scipy.optimize import linear_sum_assignment

        index = np.asarray(linear_sum_assignment(cost)[1])
    return index


def mean_mac(data: ModalData, phi: Floats) -> Floats:
    """Return the MAC of measured and model modes, (measured modes, modes), mean over data sets.

    It is 0 for modes that the sensors do not see, whose components there are rounding.
    """
    size = np.abs(phi).max(axis=0, initial=0.0)
    phi = np.where(size > UNSEEN * size.max(initial=0.0), phi, 0.0)
    shape, measured, squares, sets = data.measured_shapes
    # The MAC of each pair at the sensors that measured its mode in its data set.
    cross = (shape @ phi) ** 2
    norm = squares * (measured @ phi**2)
    values = np.divide(cross, norm, out=np.zeros(norm.shape), where=norm > 0)
    return np.asarray(values.sum(axis=0) / sets)


def mac_slopes(data: ModalData, pairs: Pairs, phi: Floats, dphi: Floats) -> Floats:
    """Return the derivatives (measured modes, p) of the mean MAC of pairs.

    ``phi`` (sensors, modes) are the model's modes and ``dphi`` (sensors, modes, p) their
    derivatives.
    """
    shape, measured, squares, sets = data.measured_shapes
    phi, dphi = phi[:, pairs.index], dphi[:, pairs.index]
    c = np.einsum("krs,sr->kr", shape, phi)[:, :, None]
    b = np.einsum("krs,sr->kr", measured, phi**2)[:, :, None]
    dc = np.einsum("krs,srp->krp", shape, dphi)
    half = np.einsum("krs,sr,srp->krp", measured, phi, dphi)  # of the derivative of b
    norm = squares * b**2
    out = np.divide(2 * c * (b * dc - c * half), norm, out=np.zeros(dc.shape), where=norm > 0)
    return np.asarray(out.sum(axis=0) / sets)
