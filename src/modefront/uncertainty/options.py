"""What is known of the errors of the data, and what is done with it."""

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
"""What the data have to have for each source."""


@dataclass(frozen=True)
class Uncertainty:
    """How errors of the data are carried to models and fronts.

    Raises InputError for values that are not possible, alone or together.

    Attributes
    ----------
    source : standard deviations, the scatter of several data sets, neither, or, with ``"auto"``,
        the first of these that the data have
    bootstrap : how often the data are drawn again and all points solved with them
    draws : models drawn from the posterior that predictions are made with
    """

    source: Literal["auto", "std", "sets", "none"] = "auto"
    bootstrap: Annotated[int, whole(0, 10**6)] = 0
    draws: Annotated[int, whole(0, 10**6)] = 0

    def __post_init__(self) -> None:
        check_fields(self)
        if self.bootstrap and self.source == "none":
            raise wrong("bootstrap", "0 with source = 'none'", self.bootstrap)

    def faults(self, data: ModalData) -> Iterator[Fault]:
        """Yield what is asked for that the data do not have."""
        known = available(data)
        if self.source in NEEDED and self.source not in known:
            yield Fault("", "source", NEEDED[self.source], "none")
        if self.bootstrap and self.source == "auto" and not known:
            needed = "0, or data with standard deviations or a mode measured in two data sets"
            yield Fault("", "bootstrap", needed, str(self.bootstrap))

    def of(self, data: ModalData) -> Source | None:
        """Return the source that is used with these data, None where there is none.

        Raises InputError where the data do not have what is asked for.
        """
        refuse(self.faults(data))
        if self.source == "none":
            return None
        if self.source == "auto":
            return next(iter(available(data)), None)
        return self.source
