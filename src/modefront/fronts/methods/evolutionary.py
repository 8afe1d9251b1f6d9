"""Fronts of evolutionary methods, to compare with."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from modefront.fronts.methods.base import Along, Setting
from modefront.solvers.continuation import Simplex
from modefront.solvers.evolutionary import available, evolve_front
from modefront.work.task import seed_sequence

if TYPE_CHECKING:
    from modefront.fronts.options import Pareto


@dataclass(frozen=True)
class Evolutionary:
    """The front as the last population of an evolutionary method; its points solve nothing."""

    name: str
    title: str
    refines: bool = False
    programme: None = None

    @property
    def missing(self) -> str | None:
        """Pymoo, where it is not installed."""
        return None if available() else "pymoo: pip install modefront[evolutionary]"

    def extent(self, options: Pareto, _: Simplex) -> int:
        """Return the number of generations."""
        return max(options.evaluations // options.population, 1)

    def along(self, setting: Setting) -> Along:
        """Return the nondominated models of the last population."""
        rng = np.random.default_rng(seed_sequence(setting.seed, self.name))
        options = setting.options
        population, evaluations = options.population, options.evaluations
        return Along(
            evolve_front(setting.problem, self.name, population, evaluations, rng, setting.work)
        )
