r"""Units of frequencies: a factor on all of them, periods or eigenvalues in their place.

The factor is the one that makes the cost of pairing least (`modefront.diagnosis.measured`), tried
at all ratios of a measured and a low model frequency. Modes of the model that are passed over cost
a little, so that a factor is not explained away by pairing low measured modes with high ones.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from modefront._typing import Bools, Floats
from modefront.data.modal import ModalData
from modefront.diagnosis.comparison import Comparison
from modefront.diagnosis.measured import RIGID, Measured, assigned, mac_values, pair_costs

RAD = 2 * np.pi
"""Factor between circular frequencies and Hz."""

OFF = float(np.log(2.0))
"""Logarithm of a factor on all frequencies beyond which something is wrong. Chosen: a factor of
four on stiffness over mass."""

SKIPPED = 0.02
"""Cost of a model mode that is passed over."""

FROM_ONE = 0.05
"""Cost of a factor e on all frequencies, for each mode: where in doubt, there is none."""

IN_ORDER = 0.35
"""Share of the logarithm of a factor by which that of modes in their order may differ from it."""

CLEARLY = 0.35
"""Cost over that without a change below which data of another quantity are recognised."""

NAMED: tuple[tuple[float, str], ...] = (
    (RAD, "rad/s"),
    (1 / RAD, "model in rad/s"),
    (60.0, "rpm"),
    (float(np.sqrt(9.81)), "weight"),
    (float(1 / np.sqrt(9.81)), "weight in stiffness"),
)
"""Factors with a cause of their own; other ones are powers of the root of 1000."""


@dataclass(frozen=True)
class FrequencyFactor:
    """All measured frequencies are off the model's by about the same factor.

    Attributes
    ----------
    factor : median of measured over model frequencies
    least, greatest : their range
    cause : one of those of `NAMED`, or empty
    modes : number of measured modes
    """

    factor: float
    least: float
    greatest: float
    cause: str
    modes: int


@dataclass(frozen=True)
class OtherQuantity:
    """The measured values resemble another quantity than frequencies in Hz.

    Attributes
    ----------
    quantity : "periods in s" or "eigenvalues in (rad/s)²"
    mode : a measured mode
    given, model : what is given for it, and the frequency of the model in Hz
    """

    quantity: str
    mode: int
    given: float
    model: float


def shifts_to_try(comparison: Comparison, view: Measured) -> list[float]:
    """Return the logarithms of factors on all frequencies that may explain the data; 0 is first.

    Others are tried only where pairing alone makes one of them likely.
    """
    logs = view.log_frequency
    known = np.flatnonzero(np.isfinite(logs))
    if not known.size:
        return [0.0]
    shift, _, _ = best_shift(comparison, view, logs)
    if abs(shift) < OFF:
        return [0.0]
    elastic = comparison.log_frequency[_elastic(comparison)]
    low = np.minimum(np.arange(known.size), elastic.size - 1)
    in_order = float(np.median(logs[known] - elastic[low])) if elastic.size else shift
    shifts = (shift, in_order, float(np.log(RAD)), -float(np.log(RAD)))
    # Modes in their order show a factor as well, if not as sharply as shapes do.
    likely = [s for s in shifts if abs(s) > OFF and abs(s - in_order) < max(0.8, IN_ORDER * abs(s))]
    return [0.0, *likely]


def unit_finding(
    comparison: Comparison, view: Measured, phi: Floats, shift: float
) -> FrequencyFactor | OtherQuantity | None:
    """Return the mistake in the unit of all frequencies, where a factor explains them best.

    ``view`` and ``phi`` are measured and model shapes in which wrong sensors are put right.
    """
    if abs(shift) < OFF:
        return None
    logs = view.log_frequency
    known = np.isfinite(logs)
    _, cost, ratio = _at(comparison, view, phi, logs, shift)
    median = float(np.median(ratio))
    if abs(median) < OFF:
        return None
    for quantity, changed in (
        ("periods in s", -logs),
        ("eigenvalues in (rad/s)²", logs / 2 - np.log(RAD)),
    ):
        _, least, _ = _at(comparison, view, phi, changed, 0.0)
        if known.sum() > 1 and least < CLEARLY * cost:
            r = int(np.flatnonzero(known)[0])
            given, model = float(np.exp(logs[r])), float(np.exp(changed[r]))
            return OtherQuantity(quantity, comparison.data.modes[r], given, model)
    return FrequencyFactor(
        float(np.exp(median)),
        float(np.exp(ratio.min())),
        float(np.exp(ratio.max())),
        cause_of(float(np.exp(median))),
        int(known.sum()),
    )


def distance(comparison: Comparison, frequency: Floats) -> float:
    """Return the cost of pairing frequencies (modes,) in Hz of one data set, by all shapes."""
    view = comparison.view
    return _at(comparison, view, comparison.phi, np.log(frequency), 0.0)[1]


def cause_of(factor: float) -> str:
    """Return the cause that a factor on frequencies has by its size, empty where it has none.

    >>> cause_of(6.1), cause_of(1.2e3), cause_of(2.3)
    ('rad/s', '', '')
    """
    nearest, cause = min(NAMED, key=lambda candidate: abs(np.log(factor / candidate[0])))
    off = abs(float(np.log(factor / nearest)))
    return cause if off < (0.4 if "rad" in cause else 0.25) else ""


def best_shift(comparison: Comparison, view: Measured, logs: Floats) -> tuple[float, float, Floats]:
    """Return the logarithm of the best factor, its cost, and that of each known mode's ratio."""
    of_model = comparison.log_frequency
    known = np.flatnonzero(np.isfinite(logs))
    low = np.flatnonzero(_elastic(comparison))[: known.size + 6]
    candidates = np.unique(np.round((logs[known][:, None] - of_model[low]).ravel(), 3))
    solved = (_at(comparison, view, comparison.phi, logs, float(s)) for s in (0.0, *candidates))
    return min(solved, key=lambda solution: solution[1])


def _at(
    comparison: Comparison, view: Measured, phi: Floats, logs: Floats, shift: float
) -> tuple[float, float, Floats]:
    """Return the shift, its cost, and logarithms of measured over model frequencies."""
    of_model = comparison.log_frequency
    known = np.flatnonzero(np.isfinite(logs))
    skipped = SKIPPED * np.arange(of_model.size)
    mac = mac_values(view.psi, view.seen, phi)
    index, cost = assigned(pair_costs(mac, logs, of_model, shift) + skipped)
    ratio = logs[known] - of_model[index[known]]
    return shift, cost + FROM_ONE * known.size * abs(shift), ratio


def _elastic(comparison: Comparison) -> Bools:
    """Return which modes of the model are none of a rigid body."""
    return np.asarray(comparison.frequency > RIGID * comparison.frequency.max())


MEDIAN, GREATEST = 0.15, 0.4
"""Median and greatest damping ratio beyond which percent must be meant."""


@dataclass(frozen=True)
class DampingInPercent:
    """Damping ratios so great that percent must be meant.

    Attributes
    ----------
    least, greatest : range of the damping ratios
    """

    least: float
    greatest: float


def damping_findings(data: ModalData) -> list[DampingInPercent]:
    """Return whether damping looks like percent."""
    known = data.damping[np.isfinite(data.damping) & (data.damping > 0)]
    if not known.size or (np.median(known) <= MEDIAN and known.max() <= GREATEST):
        return []
    return [DampingInPercent(float(known.min()), float(known.max()))]
