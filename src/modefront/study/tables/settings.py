"""``[pareto]``, ``[pairing]`` and ``[search]``: how the work is done."""

from __future__ import annotations

from dataclasses import dataclass

from modefront.pairing.match import Pairing
from modefront.solvers.advance import size
from modefront.solvers.evolutionary import EVOLUTIONARY, available
from modefront.solvers.explore import Search
from modefront.toml import Table

METHODS = ("nbi", "weights", *EVOLUTIONARY)
"""Methods that ``[pareto] method`` may name."""

MOST = 10_000
"""Points of a front at most."""


@dataclass(frozen=True)
class Pareto:
    """How the front is found.

    Attributes
    ----------
    method : one of METHODS
    points : along each edge of the simplex of objectives; None leaves it to their number
    population, evaluations : size of a generation and budget of an evolutionary method
    tolerance : share by which an edge may exceed the least value of its group
    """

    method: str = METHODS[0]
    points: int | None = None
    tolerance: float = 0.0
    population: int = 100
    evaluations: int = 10_000


def read_pareto(root: Table) -> Pareto:
    """Return how the front is to be found."""
    table = root.table("pareto", default=None)
    if table is None:
        return Pareto()
    method = table.choice("method", METHODS, default=Pareto.method)
    if method in EVOLUTIONARY and not available():
        expected = f"the package pymoo for '{method}': pip install modefront[evolutionary]"
        table.fault("method", expected, "none installed")
    points = table.integer("points", 2, MOST, default=Pareto.points)
    population = table.integer("population", 4, 10**6, default=Pareto.population)
    evaluations = table.integer("evaluations", 4, 10**9, default=Pareto.evaluations)
    if evaluations < population:
        table.fault("evaluations", f"at least the population, {population}", str(evaluations))
    tolerance = table.number("tolerance", "a share from 0 to 1", lambda x: 0 <= x <= 1, default=0.0)
    table.close()
    return Pareto(method, points, tolerance, population, evaluations)


def check_size(root: Table, pareto: Pareto, groups: int) -> None:
    """Note a simplex with more points than anybody can wait for."""
    if pareto.points and groups > 1 and size(groups, pareto.points) > MOST:
        expected = f"a number with at most {MOST} points on the simplex of {groups} groups"
        found = f"{pareto.points}, which are {size(groups, pareto.points)}"
        root.fault("[pareto] points", expected, found)


def read_pairing(root: Table) -> Pairing:
    """Return how measured and model modes are matched."""
    table = root.table("pairing", default=None)
    if table is None:
        return Pairing()
    method = table.choice("method", ("mac", "order"), default="mac")
    window = table.number("window", "a ratio of frequencies above 1", lambda x: x > 1, default=None)
    spare = table.integer("spare", 0, 1000, default=Pairing.spare)
    table.close()
    return Pairing(method, window, spare)


def read_search(root: Table) -> Search:
    """Return how global minima are looked for."""
    table = root.table("search", default=None)
    if table is None:
        return Search()
    before = len(root.faults)
    starts = table.integer("starts", 1, 10**6, default=Search.starts)
    limit = table.integer("limit", 1, 10**6, default=max(Search.limit, starts))
    evolutions = table.integer("evolutions", 0, 10**6, default=Search.evolutions)
    if limit < starts and len(root.faults) == before:
        table.fault("limit", f"at least starts, {starts}", str(limit))
    table.close()
    return Search(starts, limit, evolutions)
