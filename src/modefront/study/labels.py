"""Labels that results give to models; names of weights have to be others."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from modefront.front.methods import METHODS
from modefront.front.point import Kind, label

ITERATED = "iterated-weights"
"""Name of the model at which the iteration of the weights arrives."""

NAMED = (Kind.EDGE, Kind.IDENTIFIABLE_EDGE)
"""Kinds of models with the name of a group."""


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
    numbered = {Kind.FRONT, Kind.IDENTIFIABLE}
    alone = [label(kind) for kind in Kind if kind not in {*NAMED, *numbered, Kind.GIVEN}]
    named = [label(kind, group) for kind in NAMED for group in groups]
    beginnings = [label(Kind.FRONT, method).rpartition("-")[0] + "-" for method in METHODS]
    part = label(Kind.IDENTIFIABLE).rpartition("-")[0] + "-"
    return Labels(frozenset([ITERATED, *alone, *named]), frozenset([part, *beginnings]))
