r"""Effects of errors of measurement on the objectives and their derivatives, to first order.

They are sums over independent sources of standard deviation one. From standard deviations, each
value is a source, and one without counts as exact; from a covariance, each column of its root. From
several data sets, each set is a source, by the infinitesimal jackknife (Efron 1982,
doi:10.1137/1.9781611970319, chapter 6); nothing is assumed of how errors within a set depend on
each other.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np

from modefront._typing import Floats
from modefront.data.modal import ModalData
from modefront.errors import Fault, refuse, wrong
from modefront.modes.result import Modes
from modefront.options import check_fields, whole
from modefront.pairing.match import Pairs
from modefront.residuals.problem import UpdatingProblem
from modefront.text import Shown
from modefront.work.codec import record

Source = Literal["std", "sets"]  # sources of the uncertainty of the data


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


@dataclass(frozen=True)
class Uncertainty(Shown):
    """Source of the errors of the data, and samples of data and models.

    Raises InputError for values that are not possible, alone or together.

    Attributes
    ----------
    source : errors of the data: ``"std"``, their standard deviations; ``"sets"``, the scatter of
        several data sets; ``"none"``; ``"auto"``, the first of these that the data have
    bootstrap : number of bootstrap samples of the data, with each of which all points are solved;
        0 for none, and with the source ``"none"``
    draws : number of models drawn from the posterior for predictions; 0 for none
    """

    source: Literal["auto", "std", "sets", "none"] = "auto"
    bootstrap: Annotated[int, whole(0, 10**6)] = 0
    draws: Annotated[int, whole(0, 10**6)] = 0

    def __post_init__(self) -> None:
        check_fields(self)
        if self.bootstrap and self.source == "none":
            raise wrong("bootstrap", "0 with source = 'none'", self.bootstrap)

    def faults(self, data: ModalData) -> Iterator[Fault]:
        """Yield the requirements that the data do not meet."""
        known = available(data)
        if self.source == "std" and self.source not in known:
            yield Fault("", "source", "standard deviations above 0 in the data for 'std'", "none")
        if self.source == "sets" and self.source not in known:
            yield Fault("", "source", "a mode measured in two data sets for 'sets'", "none")
        if self.bootstrap and self.source == "auto" and not known:
            needed = "0, or data with standard deviations or a mode measured in two data sets"
            yield Fault("", "bootstrap", needed, str(self.bootstrap))

    def of(self, data: ModalData) -> Source | None:
        """Return the source that is used with these data, None where there is none.

        Raises InputError where the data do not meet its requirements.
        """
        refuse(self.faults(data))
        if self.source == "auto":
            return next(iter(available(data)), None)
        return None if self.source == "none" else self.source


def noise(problem: UpdatingProblem, modes: Modes, pairs: Pairs, source: Source) -> Noise:
    """Return the effects of errors of the data at paired modes with derivatives."""
    K, R, S = problem.data.shape.shape
    n, sources = len(problem.groups), K if source == "sets" else K * R * (1 + S)
    J, dJ = np.zeros((sources, n)), np.zeros((sources, n, len(problem.model.parameters)))
    if source == "std":
        for i, row in enumerate(problem.members):
            for change in (x for member in row for x in member.sensitivities(modes, pairs)):
                J[change.values, i] += change.J
                dJ[change.values, i] += change.dJ
        used = J.any(axis=1) | dJ.any(axis=(1, 2))
        return Noise(J[used], dJ[used])
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
