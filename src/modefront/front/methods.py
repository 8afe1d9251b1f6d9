"""Methods that find the points of a front, by their name in ``[pareto] method``."""

from __future__ import annotations

from dataclasses import dataclass
from importlib.util import find_spec
from typing import Literal


@dataclass(frozen=True)
class Method:
    """A method that finds the points of a front.

    Attributes
    ----------
    name : in ``[pareto] method``, and first part of the labels of its points
    title : in sentences
    programme : that a point solves: of the simplex between edges, of its weights, or none
    package, extra : that it needs besides, and the extra of modefront that brings it
    """

    name: str
    title: str
    programme: Literal["boundary", "weights"] | None = None
    package: str = ""
    extra: str = ""

    @property
    def refines(self) -> bool:
        """Whether it adds points where neighbours are far apart (``[pareto] refined``)."""
        return self.programme == "boundary"

    @property
    def missing(self) -> str | None:
        """The package that the method needs and that is not installed, and how to install it."""
        if not self.package or find_spec(self.package):
            return None
        return f"{self.package}: pip install modefront[{self.extra}]"


_ALL = (
    Method("nbi", "normal-boundary intersection", "boundary"),
    Method("weights", "a sweep of the weights", "weights"),
    Method("spea2", "SPEA2", package="pymoo", extra="evolutionary"),
    Method("nsga2", "NSGA-II", package="pymoo", extra="evolutionary"),
)

METHODS = {method.name: method for method in _ALL}
