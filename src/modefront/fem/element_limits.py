"""What the elements of a structure cannot do, as a model keeps it; `modefront.fem.limits` finds it.

A model has these records in every process, and processes start sooner without the elements.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

THICK = 0.02
"""Relative error of eigenvalues by shear from which on it is warned of."""


@dataclass(frozen=True)
class Thickness:
    """Thickness of a group of shells beside its span.

    Attributes
    ----------
    group : name
    ratio : thickness over the span
    span : lesser of the two extents of the group
    shear : error of the eigenvalue over the square of the wave number
    bending : square of the wave number over the circular frequency
    """

    group: str
    ratio: float
    span: float
    shear: float
    bending: float

    def warning(self, frequency: float) -> str:
        """Return the warning for modes up to a frequency in Hz; nothing where there is no need."""
        k2 = max((np.pi / self.span) ** 2, 2 * np.pi * frequency * self.bending)
        error = self.shear * k2
        if error < THICK:
            return ""
        return (
            f"shells of group '{self.group}' are {self.ratio:.2g} of their span thick, and waves "
            f"are {2 * np.pi / np.sqrt(k2):.3g} long at {frequency:.4g} Hz: without shear, "
            f"their stiffness is some {100 * error:.0f} % too great (frequencies "
            f"{50 * error:.0f} %), three times that where edges are clamped; use bricks, or "
            "expect that in E"
        )


@dataclass(frozen=True)
class Limits:
    """Limits of the elements of a structure.

    Attributes
    ----------
    thickness : of groups of shells
    shapes : warnings on the shapes of elements
    """

    thickness: tuple[Thickness, ...] = ()
    shapes: tuple[str, ...] = ()

    def warnings(self, frequency: float) -> list[str]:
        """Return the warnings for modes up to a frequency in Hz."""
        out = [each.warning(frequency) for each in self.thickness]
        return [*filter(None, out), *self.shapes]
