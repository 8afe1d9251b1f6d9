"""What the rule of a study pairs otherwise than it should, where nothing is wrong with the data."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from modefront.diagnosis.comparison import Comparison
from modefront.diagnosis.measured import log_frequencies, mac_values

FAR = float(np.log(2.0))
"""Logarithm of the ratio of the frequencies of a pair from which on they are far apart."""

BEYOND = float(np.log(1.5))
"""Logarithm of a measured frequency over the model's highest from which on it is outside."""

POOR, GOOD = 0.5, 0.8
"""MAC below which a pair is poor, and from which on a mode is found."""


@dataclass(frozen=True)
class PairRemark:
    """A measured mode that the nominal model pairs badly, or does not have.

    Attributes
    ----------
    kind : "distant-pair", "beyond-candidates" or "outside-model"
    subject : the measured mode
    text : what is wrong and what mends it
    """

    kind: str
    subject: tuple[str, ...]
    text: str

    def __str__(self) -> str:
        """Return the text."""
        return self.text


def pair_remarks(comparison: Comparison) -> Iterator[PairRemark]:
    """Yield the remarks on the pairs of the nominal model with data without mistakes."""
    view, f, low = comparison.view, comparison.frequency, comparison.candidates
    logs = log_frequencies(f)
    mac = mac_values(view.mean, view.known, comparison.phi)
    for r, mode in enumerate(comparison.data.modes):
        subject, log, measured = (str(mode),), view.logs[r], float(np.exp(view.logs[r]))
        q, later = int(comparison.pairs.index[r]), int(np.argmax(mac[r]))
        if log > logs.max() + BEYOND:
            whole = f.size == comparison.problem.model.size
            end = f"{f.size} modes end" if whole else f"{f.size} lowest modes end"
            yield PairRemark(
                "outside-model",
                subject,
                f"measured mode {mode} at {measured:.4g} Hz is outside what the model has: its "
                f"{end} at {f.max():.4g} Hz; refine the model, or leave the mode out of all groups",
            )
        elif later >= low and mac[r, later] > GOOD and mac[r, :low].max() < POOR:
            yield PairRemark(
                "beyond-candidates",
                subject,
                f"measured mode {mode} resembles model mode {later + 1} at {f[later]:.4g} Hz (MAC "
                f"{mac[r, later]:.2f}), which is not looked at; the best of those that are has MAC "
                f"{mac[r, :low].max():.2f}; set spare = {later + 1 - len(comparison.data.modes)} "
                "in [pairing]",
            )
        elif abs(log - logs[q]) > FAR:
            value = comparison.pairs.mac[r]
            alike = "" if np.isnan(value) else f" (MAC {value:.2f})"
            near = int(np.argmin(np.abs(log - logs)))
            yield PairRemark(
                "distant-pair",
                subject,
                f"measured mode {mode} at {measured:.4g} Hz is paired with model mode {q + 1} at "
                f"{f[q]:.4g} Hz{alike}; set window = 1.5 in [pairing]; the nearest is model mode "
                f"{near + 1} at {f[near]:.4g} Hz",
            )
