"""``[uncertainty]``: what is known of the errors of the data, and what is done with it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from modefront.data.modal import ModalData
from modefront.toml import Table
from modefront.uncertainty.noise import Source, available

SOURCES = ("auto", "std", "sets", "none")
"""What ``source`` may be."""


@dataclass(frozen=True)
class Uncertainty:
    """How errors of the data are carried to models and fronts.

    Attributes
    ----------
    source : standard deviations, the scatter of several data sets, neither, or, with ``"auto"``,
        the first of these that the data have
    bootstrap : how often the data are drawn again and all points solved with them
    draws : models drawn from the posterior that predictions are made with
    """

    source: Literal["auto", "std", "sets", "none"] = "auto"
    bootstrap: int = 0
    draws: int = 0

    def of(self, data: ModalData) -> Source | None:
        """Return the source that is used with these data.

        Raises ValueError where the data do not have what is asked for.
        """
        there = available(data)
        if self.source == "auto":
            return next(iter(there), None)
        if self.source == "none":
            return None
        if self.source not in there:
            raise ValueError(f"expected one of {there} as the source, found '{self.source}'")
        return self.source


def read_uncertainty(root: Table, data: ModalData | None) -> Uncertainty:
    """Return how errors of the data are carried; the data have to have what is asked for."""
    table = root.table("uncertainty", default=None)
    if table is None:
        return Uncertainty()
    source = table.choice("source", SOURCES, default=Uncertainty.source)
    bootstrap = table.integer("bootstrap", 0, 10**6, default=Uncertainty.bootstrap)
    draws = table.integer("draws", 0, 10**6, default=Uncertainty.draws)
    table.close()
    if draws and not root.values.get("predict"):
        table.fault("draws", "0 without predictions", str(draws))
    found = Uncertainty(source, bootstrap, draws)
    if data is None:
        return found
    there = available(data)
    if source == "std" and "std" not in there:
        table.fault("source", "standard deviations above 0 in the data for 'std'", "none")
    if source == "sets" and "sets" not in there:
        table.fault("source", "a mode measured in two data sets for 'sets'", "none")
    if bootstrap and source == "none":
        table.fault("bootstrap", "0 with source = 'none'", str(bootstrap))
    if bootstrap and source == "auto" and not there:
        wanted = "0, or data with standard deviations or a mode measured in two data sets"
        table.fault("bootstrap", wanted, str(bootstrap))
    return found
