"""The kinds of residuals: a new one is named here, and nowhere else."""

from __future__ import annotations

from modefront.residuals.base import ResidualKind
from modefront.residuals.frequency import FrequencyKind
from modefront.residuals.shape import ShapeKind
from modefront.residuals.subspace import SubspaceKind

KINDS: tuple[ResidualKind, ...] = (FrequencyKind(), ShapeKind(), SubspaceKind())
"""All kinds, in the order in which their residuals are stacked."""


def kind_named(name: str) -> ResidualKind:
    """Return the kind of this name; raises KeyError where there is none."""
    return {kind.name: kind for kind in KINDS}[name]
