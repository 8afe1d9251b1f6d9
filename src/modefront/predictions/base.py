"""The interface of predictions: records of options for which models are evaluated.

A kind of predictions is a frozen dataclass whose fields are the keys of its table in a study file
(`modefront.options`), and that says itself how its values are reported. A new kind is a file beside
this one, and a line in `modefront.predictions`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Protocol, Self

import numpy as np

from modefront._typing import Floats
from modefront.data.modal import ModalData
from modefront.errors import Fault
from modefront.models.base import Model
from modefront.residuals.problem import UpdatingProblem
from modefront.variables import Values, Variable


@dataclass(frozen=True)
class ResultVariable:
    """A variable of the results that a prediction has one value of for each model and place.

    Attributes
    ----------
    name : of the variable
    key : under which an evaluation returns it
    meaning : in words
    unit : of the values; empty where it is that of the model or there is none
    ranged : whether its range over the Pareto-optimal models is reported, and its posterior
    symbol : what stands for it in formulas; given for a probability, which varies by orders of
        magnitude: its logarithm is what is linearised
    mean : what its mean over the posterior is called; empty for no name of its own
    """

    name: str
    key: str
    meaning: str
    unit: str = ""
    ranged: bool = True
    symbol: str = ""
    mean: str = ""

    @property
    def logarithmic(self) -> bool:
        """Whether its logarithm is linearised."""
        return bool(self.symbol)


@dataclass(frozen=True)
class NumericalCheck:
    """A comparison with finer numerics, made at the reference model.

    Attributes
    ----------
    name : of its tasks
    variables : the results of the comparison
    label : the variable that holds the label of the model
    """

    name: str
    variables: tuple[ResultVariable, ...]
    label: ResultVariable


@dataclass(frozen=True)
class Setting:
    """An option of predictions, as a variable of the results.

    Attributes
    ----------
    name : of the variable
    meaning : in words
    values : what it holds
    unit : of the values
    dimensions : of a single value; none for a number or text
    """

    name: str
    meaning: str
    values: Values = "number"
    unit: str = ""
    dimensions: tuple[str, ...] = ()


@dataclass(frozen=True)
class Kind:
    """Table, result variables and wording of all predictions of a kind.

    Attributes
    ----------
    table : name of its tables in a study file, ``[[predict.<table>]]``
    dimension : of its result variables, one place a value of each prediction
    variables : of the results, one value a model and place; the first is missing where all are
    settings : options that the results repeat, one value a place
    absent : wording for models that can be solved and have no value
    undefined : why there may be no standard deviation, besides models that cannot be solved
    check : a comparison with finer numerics; None where there is none
    heading : returns a prediction's options in a sentence, from its name and the values of its
        settings by their variables; None for the settings with their meanings
    """

    table: str
    dimension: str
    variables: tuple[ResultVariable, ...]
    settings: tuple[Setting, ...] = ()
    absent: str = "have no value"
    undefined: str = "have no such value"
    check: NumericalCheck | None = None
    heading: Callable[[str, Mapping[str, Any]], str] | None = None

    @property
    def ranged(self) -> tuple[ResultVariable, ...]:
        """The variables whose range and posterior are reported."""
        return tuple(variable for variable in self.variables if variable.ranged)

    @property
    def schema(self) -> Iterator[Variable]:
        """All variables that results have of predictions of this kind."""
        for variable in self._of_points():
            yield replace(variable, together=f"{self.dimension} at points")
        for ranged in self.ranged:
            for variable in self._linearised(ranged):
                yield replace(variable, together=f"{self.dimension} to first order")
            for variable in self._drawn(ranged):
                yield replace(variable, together=f"{self.dimension} of draws")

    def _of_points(self) -> Iterator[Variable]:
        """Yield the variables of the models of the results."""
        dimension = (self.dimension,)
        for x in self.variables:
            yield Variable(x.name, ("point", *dimension), x.meaning, unit=x.unit)
        for x in self.ranged:
            over = f"of {x.name} over the Pareto-optimal models"
            yield Variable(f"{x.name}_range", ("range", *dimension), over, unit=x.unit)
        for setting in self.settings:
            dimensions = (*dimension, *setting.dimensions)
            yield Variable(
                setting.name, dimensions, setting.meaning, setting.values, unit=setting.unit
            )
        if self.check:
            for x in self.check.variables:
                yield Variable(x.name, dimension, x.meaning, unit=x.unit)
            yield Variable(self.check.label.name, dimension, self.check.label.meaning, "text")

    def _linearised(self, variable: ResultVariable) -> Iterator[Variable]:
        """Yield the variables of the posterior of one of them, to first order."""
        dimension, both = (self.dimension,), (self.dimension, f"{self.dimension}_other")
        name, unit, by = variable.name, variable.unit, "by the posterior, to first order"
        if variable.logarithmic:
            P, start = variable.symbol, f"posterior_{self.dimension}_log"
            yield Variable(f"{start}_std", dimension, f"standard deviation of ln {P} {by}")
            yield Variable(f"{start}_covariance", both, f"covariance of ln {P} {by}")
            meaning = (
                f"standard deviation of {name} that follows where ln {P} is Gaussian, of standard "
                f"deviation s: {P} sqrt(e^(s^2) (e^(s^2) - 1)), {P} that of the reference"
            )
            yield Variable(f"posterior_{name}_std", dimension, meaning)
        else:
            meaning = f"standard deviation of {name} {by}"
            yield Variable(f"posterior_{name}_std", dimension, meaning, unit=unit)
            squared = f"{unit}2" if unit else ""
            meaning = f"covariance of {name} {by}"
            yield Variable(f"posterior_{name}_covariance", both, meaning, unit=squared)

    def _drawn(self, variable: ResultVariable) -> Iterator[Variable]:
        """Yield the variables of models drawn from the posterior."""
        dimension, name, unit = (self.dimension,), variable.name, variable.unit
        drawn = f"{name} of each model drawn from the posterior; NaN where there is none"
        yield Variable(f"draw_{name}", ("draw", *dimension), drawn, unit=unit)
        over = f"{name} over the models drawn from the posterior"
        over += f"; its mean is {variable.mean}" if variable.mean else ""
        yield Variable(f"posterior_{name}", ("statistic", *dimension), over, unit=unit)


class Prediction(Protocol):
    """A quantity or probability that models predict."""

    kind: ClassVar[Kind]

    @property
    def name(self) -> str:
        """Name of the prediction."""

    @property
    def places(self) -> tuple[str, ...]:
        """Names of its values, the coordinates of its dimension."""

    @property
    def settings(self) -> Mapping[str, Sequence[Any]]:
        """Values of the kind's settings, one a place, by the name of the variable."""

    def faults(self, model: Model, data: ModalData, /) -> Iterator[Fault]:
        """Yield the requirements that model or data do not meet; no model is evaluated for that."""

    def complete(self, problem: UpdatingProblem, /) -> Self:
        """Return the prediction with defaults that follow from the nominal model.

        Raises InputError with what this model cannot predict.
        """

    def evaluate(
        self, problem: UpdatingProblem, theta: Floats, seed: np.random.SeedSequence, /
    ) -> Mapping[str, Floats]:
        """Return the values of a model, (places,) under each variable's key; NaN where none.

        Raises ModelError where the model cannot be evaluated at ``theta``, InputError where the
        options of a prediction do not suit it there.
        """

    def check(
        self, problem: UpdatingProblem, theta: Floats, seed: np.random.SeedSequence, /
    ) -> Mapping[str, Floats]:
        """Return the result of the kind's check at a model, (places,) each; empty without one."""
