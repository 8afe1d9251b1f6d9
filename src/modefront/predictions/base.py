"""What a prediction is to a study: a record of options that a model is evaluated for.

A kind of predictions is a frozen dataclass whose fields are the keys of its table in a study file
(`modefront.options`), and that says itself how its values are reported. A new kind is a file beside
this one, and a line in `modefront.predictions`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Protocol, Self

import numpy as np

from modefront._typing import Floats
from modefront.data.modal import ModalData
from modefront.errors import Fault
from modefront.models.base import Model
from modefront.residuals.problem import UpdatingProblem


@dataclass(frozen=True)
class ResultVariable:
    """A variable of the results that a prediction has one value of for each model and place.

    Attributes
    ----------
    name : of the variable
    key : under which an evaluation returns it
    meaning : in words, without the unit
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
    def long_name(self) -> str:
        """Meaning and unit."""
        return f"{self.meaning} in {self.unit}" if self.unit else self.meaning

    @property
    def logarithmic(self) -> bool:
        """Whether its logarithm is linearised."""
        return bool(self.symbol)


@dataclass(frozen=True)
class NumericalCheck:
    """A comparison with finer numerics, made at the reference model.

    Attributes
    ----------
    piece : what the piece of work is called
    variables : the results of the comparison
    label : name of the variable that holds the label of the model
    label_meaning : what that is, in words
    """

    piece: str
    variables: tuple[ResultVariable, ...]
    label: str
    label_meaning: str


@dataclass(frozen=True)
class Kind:
    """What all predictions of a kind have in common.

    Attributes
    ----------
    table : name of its tables in a study file, ``[[predict.<table>]]``
    dimension : of its result variables, one place a value of each prediction
    variables : of the results, one value a model and place; the first is missing where all are
    absent : what is said of models that can be solved, and have no value
    undefined : why there may be no standard deviation, besides models that cannot be solved
    check : a comparison with finer numerics; None where there is none
    """

    table: str
    dimension: str
    variables: tuple[ResultVariable, ...]
    absent: str = "have no value"
    undefined: str = "have no such value"
    check: NumericalCheck | None = None

    @property
    def ranged(self) -> tuple[ResultVariable, ...]:
        """The variables whose range and posterior are reported."""
        return tuple(variable for variable in self.variables if variable.ranged)


@dataclass(frozen=True)
class Setting:
    """Something that was asked for, as a variable of the results.

    Attributes
    ----------
    values : one for each place of the prediction
    meaning : in words
    dimensions : of a single value; none for a number or text
    """

    values: tuple[Any, ...]
    meaning: str
    dimensions: tuple[str, ...] = ()


class Prediction(Protocol):
    """Something that models are to predict."""

    kind: ClassVar[Kind]

    @property
    def name(self) -> str:
        """What the prediction is called."""

    @property
    def places(self) -> tuple[str, ...]:
        """Names of its values, the coordinates of its dimension."""

    @property
    def settings(self) -> Mapping[str, Setting]:
        """What was asked for, by the name of a variable."""

    def faults(self, model: Model, data: ModalData, /) -> Iterator[Fault]:
        """Yield what the model or the data do not have; no model is evaluated for that."""

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
        """Return what the kind's check finds at a model, (places,) each; empty without one."""
