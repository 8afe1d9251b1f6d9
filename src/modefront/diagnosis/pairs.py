"""What the rule of a study pairs otherwise than it should, where nothing is wrong with the data."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from modefront.diagnosis.comparison import Comparison
from modefront.diagnosis.measured import log_frequencies, mac_values
from modefront.findings.record import Finding, found

FAR, NEAR = np.log(2.0), np.log(1.5)
"""Logarithms of ratios of frequencies: pairs are far apart, and a window of a study is usual."""

POOR, GOOD = 0.5, 0.8
"""MAC below which a pair is poor, and from which on a mode is found."""


def bad_pairs(comparison: Comparison) -> Iterator[Finding]:
    """Yield the measured modes that the nominal model pairs badly, or does not have."""
    view, f, low = comparison.view, comparison.frequency, comparison.candidates
    logs, modes = log_frequencies(f), comparison.data.modes
    mac = mac_values(view.mean, view.known, comparison.phi)
    for r, (mode, log) in enumerate(zip(modes, view.logs, strict=True)):
        q, later = int(comparison.pairs.index[r]), int(np.argmax(mac[r]))
        measured = float(np.exp(log))
        if log > logs.max() + NEAR:
            whole = f.size == comparison.problem.model.size
            end = f"{f.size} modes" if whole else f"{f.size} lowest modes"
            yield found(
                "outside-model", str(mode), measured=measured, modes=end, highest=float(f.max())
            )
        elif later >= low and mac[r, later] > GOOD and mac[r, :low].max() < POOR:
            yield found(
                "beyond-candidates",
                str(mode),
                later=later + 1,
                f=float(f[later]),
                mac=float(mac[r, later]),
                best=float(mac[r, :low].max()),
                spare=later + 1 - len(modes),
            )
        elif abs(log - logs[q]) > FAR:
            value, apart = comparison.pairs.mac[r], np.abs(log - logs[:low])
            fits = (apart < NEAR) & ~(mac[r, :low] < POOR)
            near = int(np.argmin(np.where(fits, apart, np.inf)))
            yield found(
                "distant-pair" if fits.any() else "far-from-model",
                str(mode),
                measured=measured,
                model=q + 1,
                f=float(f[q]),
                alike="" if np.isnan(value) else f" (MAC {value:.2f})",
                near=near + 1,
                there=float(f[near]),
            )
