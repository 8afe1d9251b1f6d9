"""Weights that the user gives."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated

import numpy as np

from modefront import options as opt
from modefront._typing import Floats
from modefront.errors import Fault, refuse, suggestion
from modefront.text import Shown

WEIGHT = opt.number("a weight above 0", above=0)

WEIGHTS = opt.Requirement(
    "a table of weights, group = weight above 0", opt.TABLE, entries=opt.table_of(opt.ABOVE_ZERO)
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

    name: Annotated[str, opt.text("a label for the model found with these weights")]
    weights: Annotated[Mapping[str, float], WEIGHTS]

    def __post_init__(self) -> None:
        opt.check_fields(self)
        refuse(
            Fault("", f"weights {group}", WEIGHT.expected, opt.shown(weight))
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
