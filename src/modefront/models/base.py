"""Interface of models."""

from __future__ import annotations

from typing import Any, Protocol

from modefront._typing import Floats
from modefront.models.load_case import LoadCase, Transfer
from modefront.modes.result import Modes


class Model(Protocol):
    """A class of models: the modes at sensors as a function of parameters."""

    @property
    def parameters(self) -> tuple[str, ...]:
        """Names of the parameters, in the order of ``theta``."""

    @property
    def sensors(self) -> tuple[str, ...]:
        """Names of the sensors, in the order of the rows of the mode shapes."""

    @property
    def size(self) -> int:
        """Number of degrees of freedom, an upper bound of the number of modes."""

    @property
    def unused(self) -> tuple[str, ...]:
        """Names of parameters on which nothing depends."""

    def modes(self, theta: Floats, count: int, *, derivatives: bool = True) -> Modes:
        """Return the ``count`` lowest modes at ``theta``, shape (parameters,).

        Raises ModelError where the model has no such modes at ``theta``.
        """

    @property
    def places(self) -> tuple[str, ...]:
        """Names of the sensors, and of what else can be loaded or looked at in predictions."""

    @property
    def directions(self) -> tuple[str, ...]:
        """Names of the directions in which the base can move."""

    def transfer(self, theta: Floats, count: int, load_case: LoadCase) -> Transfer:
        """Return loads and outputs in the ``count`` lowest modes at ``theta``.

        Raises ModelError where the model has no such modes, KeyError for unknown sensors, outputs
        or directions.
        """


def passed_on(inner: str, name: str) -> Any:
    """Return the property of a class of models that is one of the model that it keeps as inner."""
    return property(
        lambda model: getattr(getattr(model, inner), name), doc=getattr(Model, name).__doc__
    )


def full_of(model: Model) -> Model:
    """Return the model that is solved in full: itself, unless it has another as ``full``."""
    return getattr(model, "full", model)


def is_reduced(model: Model) -> bool:
    """Return whether a model stands for another one that is solved in full."""
    return full_of(model) is not model
