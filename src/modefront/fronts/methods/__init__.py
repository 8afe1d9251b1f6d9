"""Methods that find the points of a front, one a module; `METHODS` is the one list of them."""

from __future__ import annotations

from modefront.fronts.methods.base import FrontMethod
from modefront.fronts.methods.evolutionary import Evolutionary
from modefront.fronts.methods.nbi import NormalBoundaryIntersection
from modefront.fronts.methods.weights import WeightSweep

_ALL: tuple[FrontMethod, ...] = (
    NormalBoundaryIntersection(),
    WeightSweep(),
    Evolutionary("spea2", "SPEA2"),
    Evolutionary("nsga2", "NSGA-II"),
)

METHODS = {method.name: method for method in _ALL}
"""Methods by their name in ``[pareto] method``."""
