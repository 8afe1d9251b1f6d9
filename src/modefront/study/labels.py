"""Labels that results give to models; names of weights have to be others."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from modefront.solvers.pareto import METHODS
from modefront.study.knowledge import PART
from modefront.study.run import BOUNDED, EQUAL, OPTIMAL

ITERATED, NOMINAL = "iterated-weights", "nominal"
"""Labels of the model at which the iteration of the weights arrives, and of the nominal one."""


@dataclass(frozen=True)
class Labels:
    """All labels that a study of these groups may give to its models.

    Points of the front, and of its identifiable part, have a number behind a beginning; how many
    there are is not known beforehand.
    """

    single: frozenset[str]
    numbered: frozenset[str]

    def __contains__(self, name: object) -> bool:
        """Return whether a name is such a label."""
        beginning, _, end = str(name).rpartition("-")
        is_number = end.isascii() and end.isdigit()
        return name in self.single or (is_number and f"{beginning}-" in self.numbered)


def labels_of(groups: Sequence[str]) -> Labels:
    """Return the labels that a study may give besides the names of weights."""
    edges = [f"edge-{group}" for group in groups]
    return Labels(
        frozenset([OPTIMAL, BOUNDED, EQUAL, ITERATED, NOMINAL, *edges, *(PART + e for e in edges)]),
        frozenset([PART, *(f"{method}-" for method in METHODS)]),
    )
