"""Pairs of modes far apart in frequency, and measured modes that the model does not have."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from modefront.diagnosis.comparison import Comparison
from modefront.diagnosis.measured import Measured

FAR = float(np.log(2.0))
"""Logarithm of the ratio of the frequencies of a pair from which on they are far apart."""

BEYOND = 1.5
"""Ratio of a measured frequency to the highest of the model from which on it is outside."""

POOR, GOOD = 0.5, 0.8
"""MAC below which a pair is poor, and from which on a mode is found."""


@dataclass(frozen=True)
class DistantPair:
    """A measured mode is paired with a model mode of another frequency.

    Attributes
    ----------
    mode, model_mode : the pair, from 1
    frequency, model_frequency : in Hz
    mac : of the pair; NaN without a shape
    nearest, nearest_frequency : model mode of the nearest frequency, from 1, and that in Hz
    """

    mode: int
    model_mode: int
    frequency: float
    model_frequency: float
    mac: float
    nearest: int
    nearest_frequency: float


@dataclass(frozen=True)
class OutsideModel:
    """A measured mode lies above all modes that the model has.

    Attributes
    ----------
    mode : measured mode
    frequency : in Hz
    highest : highest frequency of the model in Hz
    modes : number of modes of the model that were computed
    all_modes : whether these are all that it has
    """

    mode: int
    frequency: float
    highest: float
    modes: int
    all_modes: bool


@dataclass(frozen=True)
class BeyondCandidates:
    """A measured mode resembles a model mode that is not among the candidates for pairing.

    Attributes
    ----------
    mode, model_mode : the modes, from 1
    model_frequency : in Hz
    mac : of both
    best : the best MAC among the candidates
    spare : option with which it is one of them
    """

    mode: int
    model_mode: int
    model_frequency: float
    mac: float
    best: float
    spare: int


@dataclass(frozen=True)
class UnseenMode:
    """A measured mode resembles none of the model.

    Attributes
    ----------
    mode : measured mode
    best : its best MAC
    """

    mode: int
    best: float


PairFinding = DistantPair | OutsideModel | BeyondCandidates | UnseenMode


def without_outside(comparison: Comparison, view: Measured) -> Measured:
    """Return the measured modes without those above all modes of the model, if they are few.

    Where most modes are above, it is their unit that is wrong.
    """
    highest = float(comparison.log_frequency.max()) + np.log(BEYOND)
    above = np.nan_to_num(view.log_frequency, nan=-np.inf) > highest
    if not above.any() or 2 * above.sum() >= above.size:
        return view
    psi, seen = view.psi.copy(), view.seen.copy()
    psi[:, above], seen[:, above] = 0.0, False
    return replace(
        view, psi=psi, seen=seen, log_frequency=np.where(above, np.nan, view.log_frequency)
    )


def pair_findings(comparison: Comparison, view: Measured, shift: float) -> list[PairFinding]:
    """Return the findings on the pairs of the nominal model.

    ``shift`` is the logarithm of a factor on all frequencies that is known already.
    """
    out: list[PairFinding] = []
    of_model, f = comparison.log_frequency, comparison.frequency
    highest = float(of_model.max())
    lowest = comparison.candidates
    for r, mode in enumerate(comparison.data.modes):
        log = float(view.log_frequency[r]) - shift
        q, mac = int(comparison.pairs.index[r]), float(comparison.pairs.mac[r])
        measured = float(np.exp(view.log_frequency[r]))
        if log > highest + np.log(BEYOND):
            out.append(
                OutsideModel(mode, measured, float(f.max()), f.size, comparison.has_all_modes)
            )
            continue
        values = comparison.mac[r]
        best = float(values[:lowest].max())
        later = int(np.argmax(values))
        if best < POOR and later >= lowest and values[later] > GOOD:
            spare = later + 1 - len(comparison.data.modes)
            out.append(
                BeyondCandidates(
                    mode, later + 1, float(f[later]), float(values[later]), best, spare
                )
            )
        elif best < POOR:
            out.append(UnseenMode(mode, best))
        elif abs(log - of_model[q]) > FAR:
            near = int(np.argmin(np.abs(log - of_model)))
            out.append(
                DistantPair(mode, q + 1, measured, float(f[q]), mac, near + 1, float(f[near]))
            )
    return out
