"""Options of the uncertainty of models and predictions."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Literal

from modefront.data.modal import ModalData
from modefront.errors import Fault, refuse, wrong
from modefront.options import check_fields, whole
from modefront.uncertainty.noise import Source, available

NEEDED = {
    "std": "standard deviations above 0 in the data for 'std'",
    "sets": "a mode measured in two data sets for 'sets'",
}
"""Requirements of each source on the data."""


@dataclass(frozen=True)
class Uncertainty:
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
        if self.source in NEEDED and self.source not in known:
            yield Fault("", "source", NEEDED[self.source], "none")
        if self.bootstrap and self.source == "auto" and not known:
            needed = "0, or data with standard deviations or a mode measured in two data sets"
            yield Fault("", "bootstrap", needed, str(self.bootstrap))

    def of(self, data: ModalData) -> Source | None:
        """Return the source that is used with these data, None where there is none.

        Raises InputError where the data do not meet its requirements.
        """
        refuse(self.faults(data))
        if self.source == "none":
            return None
        if self.source == "auto":
            return next(iter(available(data)), None)
        return self.source
