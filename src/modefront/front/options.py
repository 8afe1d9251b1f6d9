"""Options of the Pareto front."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, TypedDict

from modefront.errors import Fault, refuse
from modefront.front.methods import METHODS
from modefront.front.simplex import size
from modefront.options import Requirement, check_fields, number, one_of, whole
from modefront.text import Shown

MOST = 10_000  # points of a front at most


def _one_of_the_methods() -> Requirement:
    return one_of(*METHODS)  # those that are registered by now


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

    method: Annotated[str, _one_of_the_methods] = "nbi"
    points: Annotated[int, whole(2, MOST)] | None = None
    programme: Annotated[str, one_of("bounds", "equations")] = "bounds"
    tolerance: Annotated[float, number("a share from 0 to 1", least=0, most=1)] = 0.0
    population: Annotated[int, whole(4, 10**6)] = 100
    evaluations: Annotated[int, whole(4, 10**9)] = 10_000
    refined: Annotated[float, number("a distance from 0.001 to 1", least=1e-3, most=1)] | None = (
        None
    )

    def __post_init__(self) -> None:
        check_fields(self)
        refuse(self._contradictions())

    def _contradictions(self) -> Iterator[Fault]:
        if missing := METHODS[self.method].missing:
            package, _, how = missing.partition(": ")
            expected = f"the package {package} for '{self.method}': {how}"
            yield Fault("", "method", expected, "none installed")
        if self.evaluations < self.population:
            least = f"at least the population, {self.population}"
            yield Fault("", "evaluations", least, str(self.evaluations))

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
