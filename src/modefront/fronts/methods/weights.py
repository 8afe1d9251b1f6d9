"""Minima of weighted sums, for weights on the lattice of the simplex, to compare with."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from modefront.fronts.methods.base import Along, Setting
from modefront.solvers.continuation import Simplex
from modefront.solvers.sweep import weight_sweep

if TYPE_CHECKING:
    from modefront.fronts.options import Pareto


@dataclass(frozen=True)
class WeightSweep:
    """The front as the minima of weighted sums."""

    name: str = "weights"
    title: str = "a sweep of the weights"
    refines: bool = False
    programme: Literal["weights"] = "weights"

    @property
    def missing(self) -> None:
        """None: nothing else has to be installed."""

    def extent(self, _: Pareto, lattice: Simplex) -> int:
        """Return the number of lattice points."""
        return len(lattice.counts)

    def along(self, setting: Setting) -> Along:
        """Return the minimum of each weighted sum."""
        scale, lattice = setting.target.scale, setting.lattice
        return Along(weight_sweep(setting.problem, setting.edges, scale, lattice, setting.work))
