"""Methods that find the points of a front, by their name in ``[pareto] method``."""

from collections.abc import Callable
from dataclasses import dataclass
from importlib.util import find_spec
from typing import Any, Literal

from modefront.families import Family
from modefront.text import Shown


@dataclass(frozen=True, repr=False)
class Method(Shown):
    """A method that finds the points of a front.

    Attributes
    ----------
    name : in ``[pareto] method``, and first part of the labels of its points
    title : in sentences
    programme : that a point solves: of the simplex between edges, of its weights, or none
    algorithm : of a method without one, returns an algorithm with the interface of pymoo's
        (``setup``, ``ask``, ``tell``, ``pop``) for so many models in a generation
    package, extra : that it needs besides, and the extra of modefront that brings it
    """

    name: str
    title: str
    programme: Literal["boundary", "weights"] | None = None
    algorithm: Callable[[int], Any] | None = None
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


def _spea2(population: int) -> Any:
    from pymoo.algorithms.moo.spea2 import SPEA2, SPEA2Survival

    # The default survival is one object for all runs and remembers the ranges of the last one.
    return SPEA2(pop_size=population, survival=SPEA2Survival(normalize=True))


def _nsga2(population: int) -> Any:
    from pymoo.algorithms.moo.nsga2 import NSGA2

    return NSGA2(pop_size=population)


METHODS: Family[Method] = Family(
    "modefront.methods",
    "a Method of fronts",
    lambda method: isinstance(method, Method),
    lambda method: method.name,
    (
        Method("nbi", "normal-boundary intersection", "boundary"),
        Method("weights", "a sweep of the weights", "weights"),
        Method("spea2", "SPEA2", None, _spea2, "pymoo", "evolutionary"),
        Method("nsga2", "NSGA-II", None, _nsga2, "pymoo", "evolutionary"),
    ),
)
"""All methods by their names."""
