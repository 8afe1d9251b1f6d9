r"""Effects of errors of measurement on the objectives and their derivatives, to first order.

They are sums over independent sources of standard deviation one. From standard deviations, each
value is a source, and one without counts as exact. From several data sets, each set is a source, by
the infinitesimal jackknife (Efron 1982, doi:10.1137/1.9781611970319, chapter 6); nothing is assumed
of how errors within a set depend on each other.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from modefront._typing import Floats
from modefront.data.modal import ModalData
from modefront.modes.result import Modes
from modefront.pairing.match import Pairs
from modefront.residuals.problem import UpdatingProblem
from modefront.work.codec import record

Source = Literal["std", "sets"]
"""Sources of the uncertainty of the data."""


@record
@dataclass(frozen=True)
class Noise:
    """Changes of the objectives, (sources, n), and of their derivatives, (sources, n, p)."""

    J: Floats
    dJ: Floats


def available(data: ModalData) -> tuple[Source, ...]:
    """Return the sources of the uncertainty that data have."""
    std = (data.frequency_std > 0).any() or (data.shape_std > 0).any()
    frequencies = np.isfinite(data.frequency).sum(axis=0)
    shapes = np.isfinite(data.shape).any(axis=2).sum(axis=0)
    sets = max(frequencies.max(), shapes.max()) > 1
    return (*(("std",) if std else ()), *(("sets",) if sets else ()))


def noise(problem: UpdatingProblem, modes: Modes, pairs: Pairs, source: Source) -> Noise:
    """Return the effects of errors of the data at paired modes with derivatives."""
    return (_from_std if source == "std" else _from_sets)(problem, modes, pairs)


def _from_std(problem: UpdatingProblem, modes: Modes, pairs: Pairs) -> Noise:
    K, R, S = problem.data.shape.shape
    n, p = len(problem.groups), len(problem.model.parameters)
    J, dJ = np.zeros((K * R * (1 + S), n)), np.zeros((K * R * (1 + S), n, p))
    for i, row in enumerate(problem.members):
        for member in row:
            for change in member.sensitivities(modes, pairs):
                J[change.values, i] += change.J
                dJ[change.values, i] += change.dJ
    used = J.any(axis=1) | dJ.any(axis=(1, 2))
    return Noise(J[used], dJ[used])


def _from_sets(problem: UpdatingProblem, modes: Modes, pairs: Pairs) -> Noise:
    n, p = len(problem.groups), len(problem.model.parameters)
    J, dJ = np.zeros((len(problem.data.sets), n)), np.zeros((len(problem.data.sets), n, p))
    for i, residual in enumerate(problem.residuals_at(modes, pairs)):
        end = 0
        for member in problem.members[i]:
            sets, rows = np.unique(member.sets), slice(end, end + member.sets.size)
            K, end = sets.size, rows.stop
            if K < 2:
                continue
            r, dr = residual.r[rows], residual.dr[rows]
            terms = np.array([K * float(r[member.sets == k] @ r[member.sets == k]) for k in sets])
            slopes = np.array([2 * K * r[member.sets == k] @ dr[member.sets == k] for k in sets])
            J[sets, i] += (terms - terms.mean()) / np.sqrt(K * (K - 1))
            dJ[sets, i] += (slopes - slopes.mean(axis=0)) / np.sqrt(K * (K - 1))
    return Noise(J, dJ)
