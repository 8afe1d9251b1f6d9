"""Options of the Pareto front, and weights that the user gives."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, TypedDict

import numpy as np

from modefront._typing import Floats
from modefront.errors import Fault, refuse, suggestion
from modefront.front.methods import METHODS
from modefront.front.simplex import size
from modefront.options import (
    ABOVE_ZERO,
    TABLE,
    Requirement,
    check_fields,
    number,
    one_of,
    shown,
    table_of,
    text,
    whole,
)
from modefront.text import Shown

MOST = 10_000  # points of a front at most

DISTANCE = number("a distance from 0.001 to 1", least=1e-3, most=1)


@dataclass(frozen=True)
class Pareto(Shown):
    """Method, resolution and refinement of the Pareto front.

    Raises InputError for values that are not possible, alone or together.

    Attributes
    ----------
    method : ``"nbi"``, normal-boundary intersection; ``"weights"``, a sweep of the weights;
        ``"spea2"`` or ``"nsga2"``, which need pymoo
    points : number of points along each edge of the simplex of objectives, 2 at least; None for 20,
        or as many as make 300 points in all
    programme : ``"bounds"``, whose points are Pareto optimal; ``"equations"``, those of
        normal-boundary intersection as published, which also lead to dominated points
    tolerance : share from 0 to 1 by which an edge may exceed the least value of its group
    population : models in a generation of an evolutionary method, 4 at least
    evaluations : models in all generations together, as many as ``population`` at least
    refined : distance of neighbours on the front of two groups, over the ranges of the objectives,
        above which points are added between them, from 0.001 to 1; None for no refinement
    """

    method: Annotated[str, lambda: one_of(*METHODS)] = "nbi"
    points: Annotated[int, whole(2, MOST)] | None = None
    programme: Annotated[str, one_of("bounds", "equations")] = "bounds"
    tolerance: Annotated[float, number("a share from 0 to 1", least=0, most=1)] = 0.0
    population: Annotated[int, whole(4, 10**6)] = 100
    evaluations: Annotated[int, whole(4, 10**9)] = 10_000
    refined: Annotated[float, DISTANCE] | None = None

    def __post_init__(self) -> None:
        check_fields(self)
        faults = []
        if missing := METHODS[self.method].missing:
            package, _, how = missing.partition(": ")
            expected = f"the package {package} for '{self.method}': {how}"
            faults.append(Fault("", "method", expected, "none installed"))
        if self.evaluations < self.population:
            least = f"at least the population, {self.population}"
            faults.append(Fault("", "evaluations", least, str(self.evaluations)))
        refuse(faults)

    def faults(self, groups: int) -> Iterator[Fault]:
        """Yield what is wrong with these options for a number of groups."""
        if self.refined is not None and (groups != 2 or not METHODS[self.method].refines):
            refining = " or ".join(f"'{name}'" for name, x in METHODS.items() if x.refines)
            found = f"{groups} group{'s' * (groups > 1)}, method '{self.method}'"
            yield Fault("", "refined", f"two groups and method {refining}", found)
        if self.points and groups > 1 and size(groups, self.points) > MOST:
            expected = f"a number with at most {MOST} points on the simplex of {groups} groups"
            found = f"{self.points}, which are {size(groups, self.points)}"
            yield Fault("", "points", expected, found)


class ParetoOptions(TypedDict, total=False):
    """The fields of `Pareto` as keywords of a function."""

    method: str
    points: int | None
    programme: str
    tolerance: float
    population: int
    evaluations: int
    refined: float | None


WEIGHT = number("a weight above 0", above=0)

WEIGHTS = Requirement(
    "a table of weights, group = weight above 0", TABLE, entries=table_of(ABOVE_ZERO)
)


@dataclass(frozen=True)
class Weighted(Shown):
    """Given weights of the objectives, which lead to a model of the results.

    Raises InputError for weights that are not numbers above 0.

    Attributes
    ----------
    name : label of the model that minimises sum w_i J_i
    weights : w_i, above 0, by the name of each group
    """

    name: Annotated[str, text("a label for the model found with these weights")]
    weights: Annotated[Mapping[str, float], WEIGHTS]

    def __post_init__(self) -> None:
        check_fields(self)
        refuse(
            Fault("", f"weights {group}", WEIGHT.expected, shown(weight))
            for group, weight in self.weights.items()
            if not WEIGHT.holds(weight)
        )

    def faults(self, groups: Sequence[str]) -> Iterator[Fault]:
        """Yield names of groups that there are not, and groups without a weight."""
        for group in self.weights:
            if group not in groups:
                found = suggestion(group, groups)
                yield Fault("", f"weights {group}", "the name of a group", found)
        for group in groups:
            if group not in self.weights:
                yield Fault("", f"weights {group}", WEIGHT.expected, "nothing")

    def of(self, groups: Sequence[str]) -> Floats:
        """Return the weights in the order of the groups, shape (groups,)."""
        return np.array([self.weights[group] for group in groups], dtype=float)
