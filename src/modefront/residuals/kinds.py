"""The kinds of residuals: one of the package is named here, and nowhere else."""

from __future__ import annotations

from modefront.families import Family
from modefront.residuals.base import ResidualKind
from modefront.residuals.frequency import FrequencyKind
from modefront.residuals.shape import ShapeKind
from modefront.residuals.subspace import SubspaceKind

NEEDED = ("name", "plural", "usable_std", "measured", "has_usable_std", "members", "stack")
"""What a kind has, see `ResidualKind`."""

KINDS: Family[ResidualKind] = Family(
    "modefront.residuals",
    "a kind of residual, with what modefront.residuals.base.ResidualKind has",
    lambda kind: not isinstance(kind, type) and all(hasattr(kind, name) for name in NEEDED),
    lambda kind: kind.name,
    (FrequencyKind(), ShapeKind(), SubspaceKind()),
)
"""All kinds, in the order in which their residuals are stacked."""
