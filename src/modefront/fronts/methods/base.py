"""The interface of methods that find the points of a front."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal, Protocol

import numpy as np

from modefront._typing import Floats, Ints
from modefront.solvers.archive import Archive
from modefront.solvers.continuation import Simplex
from modefront.solvers.explore import Search
from modefront.solvers.gaps import Gap
from modefront.solvers.payoff import Payoff
from modefront.solvers.problem import Problem
from modefront.solvers.sqp import Solution
from modefront.work.task import Executor

if TYPE_CHECKING:
    from modefront.fronts.options import Pareto


# 12 fields: a method is passed all that any of the methods needs.
@dataclass(frozen=True)
class Setting:
    """Problem, edges and options from which a method starts.

    Attributes
    ----------
    options : of the study
    edges : the edge of each objective
    minima : of each programme solved so far: one objective each, then weighted sums
    corners : models between which the simplex is spanned, with all minima of single objectives
    target : utopia point and ranges over the edges
    lattice : points of the simplex
    before : points of a front of nearly the same problem
    seed : of the run
    search : extent of the search for global minima
    archive : models evaluated so far
    work : carries out the tasks
    """

    problem: Problem
    options: Pareto
    edges: Sequence[Solution]
    minima: Sequence[Sequence[Solution]]
    corners: Sequence[Solution]
    target: Payoff
    lattice: Simplex
    before: Sequence[Solution]
    seed: int
    search: Search
    archive: Archive
    work: Executor

    @property
    def resumed(self) -> bool:
        """Whether the front goes on from one that was explored, of nearly the same problem."""
        return self.search.is_none and len(self.before) > 0


@dataclass(frozen=True)
class Along:
    """The points along a front; see `modefront.fronts.front.Front`."""

    points: Sequence[Solution]
    gaps: Sequence[Gap] = ()
    lattice: Floats = field(default_factory=lambda: np.zeros((0, 0)))
    places: Ints = field(default_factory=lambda: np.zeros(0, dtype=np.intp))


class FrontMethod(Protocol):
    """A method that finds the points of a front."""

    @property
    def name(self) -> str:
        """Name in ``[pareto] method``, and first part of the labels of its points."""

    @property
    def title(self) -> str:
        """Name of the method in sentences."""

    @property
    def refines(self) -> bool:
        """Whether it adds points where neighbours are far apart (``[pareto] refined``)."""

    @property
    def programme(self) -> Literal["boundary", "weights"] | None:
        """Programme that a point solves: of the simplex between edges, of its weights, or none."""

    @property
    def missing(self) -> str | None:
        """The package that the method needs and that is not installed, and how to install it."""

    def extent(self, options: Pareto, lattice: Simplex) -> int:
        """Return the expected number of tasks."""

    def along(self, setting: Setting) -> Along:
        """Return the points along the front."""
