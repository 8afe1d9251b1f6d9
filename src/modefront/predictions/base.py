"""The interface of predictions: records of options for which models are evaluated.

A prediction is a frozen dataclass whose fields are the keys of its table in a study file
(`modefront.options`), and that says itself how its values are reported: the `PredictionKind` of its
class is written into the results, where all that show them read it. `modefront.register` makes a
class from anywhere known to study files.
"""

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, is_dataclass
from functools import cache
from operator import attrgetter
from typing import Annotated, Any, ClassVar, Literal, Protocol, Self

import numpy as np
from numpy.random import SeedSequence

from modefront._typing import Arrays, Floats
from modefront.data.modal import ModalData
from modefront.datasets import Dataset
from modefront.errors import Fault, refuse
from modefront.families import Family
from modefront.models.base import Model
from modefront.options import TRUE_OR_FALSE, Checked, Requirement, check_fields, each_once, text
from modefront.residuals.problem import UpdatingProblem
from modefront.text import NAME, Shown, clean

Contents = Literal["number", "count", "truth", "text"]  # types of values of a variable


@dataclass(frozen=True)
class Variable:
    """A variable of the results; its unit is empty for none, or for that of the model."""

    name: str
    dimensions: tuple[str, ...]
    meaning: str
    values: Contents = "number"
    unit: str = ""
    required: bool = False

    @property
    def attributes(self) -> dict[str, str]:
        """Attributes of the variable in a file (CF conventions)."""
        return {"long_name": self.meaning} | ({"units": self.unit} if self.unit else {})


IDENTIFIER = Requirement(
    "a name of small letters, digits and _, a letter first",
    {"type": "string", "pattern": "^[a-z][a-z0-9_]*$"},
)
WORDS = text("words in one line")
ANY_WORDS = Requirement("words in one line, or none", {"type": "string"}, further=str.isprintable)


def _all_of(record: type, words: str) -> Requirement:
    return Requirement(
        f"a tuple of {words}",
        {"type": "array"},
        tuple,
        lambda value: all(isinstance(x, record) for x in value),
    )


@dataclass(frozen=True)
class ResultVariable(Checked):
    """A variable of the results that a prediction has one value of for each model and place.

    Raises InputError for values that are not possible.

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

    name: Annotated[str, IDENTIFIER]
    key: Annotated[str, WORDS]
    meaning: Annotated[str, WORDS]
    unit: Annotated[str, ANY_WORDS] = ""
    ranged: Annotated[bool, TRUE_OR_FALSE] = True
    symbol: Annotated[str, ANY_WORDS] = ""
    mean: Annotated[str, ANY_WORDS] = ""

    @property
    def logarithmic(self) -> bool:
        """Whether its logarithm is linearised."""
        return bool(self.symbol)

    @property
    def title(self) -> str:
        """What its values are called in a table, with their unit."""
        return f"{self.key}, {self.unit}" if self.unit else self.key


@dataclass(frozen=True)
class Setting(Checked):
    """An option of predictions, as a variable of the results.

    Raises InputError for values that are not possible.

    Attributes
    ----------
    name : of the variable
    meaning : in words
    values : what it holds
    unit : of the values
    dimensions : of a single value; none for a number or text
    """

    name: Annotated[str, IDENTIFIER]
    meaning: Annotated[str, WORDS]
    values: Contents = "number"
    unit: Annotated[str, ANY_WORDS] = ""
    dimensions: Annotated[tuple[str, ...], _all_of(str, "names of dimensions")] = ()


VARIABLES = _all_of(ResultVariable, "ResultVariable")


@dataclass(frozen=True)
class NumericalCheck(Checked):
    """A comparison with finer numerics, made at the reference model.

    Raises InputError for values that are not possible.

    Attributes
    ----------
    name : of its tasks
    variables : the results of the comparison
    label : the variable that holds the label of the model
    """

    name: Annotated[str, WORDS]
    variables: Annotated[tuple[ResultVariable, ...], VARIABLES]
    label: ResultVariable


@dataclass(frozen=True, repr=False)
class PredictionKind(Shown):
    """Table, result variables and wording of all predictions of a class.

    Raises InputError for values that are not possible, alone or together.

    Attributes
    ----------
    table : name of its tables in a study file, ``[[predict.<table>]]``
    dimension : of its result variables, one place a value of each prediction; their names and those
        of settings begin with it and ``_``
    variables : of the results, one value a model and place; the first is missing where all are
    settings : options that the results repeat, one value a place; pictures name that of
        ``<dimension>_load``, if there is one
    absent : wording for models that can be solved and have no value
    undefined : why there may be no standard deviation, besides models that cannot be solved
    check : a comparison with finer numerics; None where there is none
    """

    table: Annotated[str, IDENTIFIER]
    dimension: Annotated[str, IDENTIFIER]
    variables: Annotated[tuple[ResultVariable, ...], VARIABLES]
    settings: Annotated[tuple[Setting, ...], _all_of(Setting, "Setting")] = ()
    absent: Annotated[str, WORDS] = "have no value"
    undefined: Annotated[str, WORDS] = "have no such value"
    check: NumericalCheck | None = None

    def __post_init__(self) -> None:
        check_fields(self)
        checked = (*self.check.variables, self.check.label) if self.check else ()
        names = [*(x.name for x in (*self.variables, *checked)), *(x.name for x in self.settings)]
        start = f"{self.dimension}_"
        faults = each_once("variables", [*names, f"{start}name", f"{start}heading"])
        faults += [Fault("", "variables", "at least one", "none")] * (not self.variables)
        strange = [name for name in names if not name.startswith(start)]
        refuse([*faults, *(Fault("", "name", f"one that begins with {start}", x) for x in strange)])

    @property
    def ranged(self) -> tuple[ResultVariable, ...]:
        """The variables whose range and posterior are reported."""
        return tuple(variable for variable in self.variables if variable.ranged)

    @property
    def schema(self) -> Iterator[Variable]:
        """All variables that results have of predictions of this kind."""
        own, both = (self.dimension,), (self.dimension, f"{self.dimension}_other")
        for x in self.variables:
            yield Variable(x.name, ("point", *own), x.meaning, unit=x.unit)
        for x in self.ranged:
            over = f"of {x.name} over the Pareto-optimal models"
            yield Variable(f"{x.name}_range", ("range", *own), over, unit=x.unit)
        yield Variable(f"{self.dimension}_name", own, "name of the prediction", "text")
        yield Variable(f"{self.dimension}_heading", own, "its options in a sentence", "text")
        for each in self.settings:
            dimensions = (*own, *each.dimensions)
            yield Variable(each.name, dimensions, each.meaning, each.values, each.unit)
        if self.check:
            for x in self.check.variables:
                yield Variable(x.name, own, x.meaning, unit=x.unit)
            yield Variable(self.check.label.name, own, self.check.label.meaning, "text")
        by, start = "by the posterior, to first order", f"posterior_{self.dimension}_log"
        for x in self.ranged:
            name, P, unit = f"posterior_{x.name}", x.symbol, "" if x.symbol else x.unit
            first, of = (start, f"ln {P}") if P else (name, x.name)
            squared = unit and f"{unit}2"
            yield Variable(f"{first}_std", own, f"standard deviation of {of} {by}", unit=unit)
            yield Variable(f"{first}_covariance", both, f"covariance of {of} {by}", unit=squared)
            if P:
                meaning = (
                    f"standard deviation of {x.name} that follows where ln {P} is Gaussian, of "
                    f"standard deviation s: {P} sqrt(e^(s^2) (e^(s^2) - 1)), {P} that of the "
                    "reference"
                )
                yield Variable(f"{name}_std", own, meaning)
            drawn = f"{x.name} of each model drawn from the posterior; NaN where there is none"
            yield Variable(f"draw_{x.name}", ("draw", *own), drawn, unit=x.unit)
            over = f"{x.name} over the models drawn from the posterior"
            over += f"; its mean is {x.mean}" if x.mean else ""
            yield Variable(name, ("statistic", *own), over, unit=x.unit)


class Prediction(Protocol):
    """A quantity or probability that models predict: `PeakResponse`, `Passage` or one of a user.

    A prediction is a frozen dataclass with these properties and methods.

    Attributes
    ----------
    kind : variables of the results and wording, the same for all predictions of the class
    """

    kind: ClassVar[PredictionKind]

    @property
    def name(self) -> str:
        """Name of the prediction."""

    @property
    def places(self) -> tuple[str, ...]:
        """Names of its values, the coordinates of its dimension."""

    @property
    def heading(self) -> str:
        """The name with load case and options, in a sentence."""

    @property
    def settings(self) -> Mapping[str, Sequence[Any]]:
        """Values of the kind's settings, one a place, by the name of the variable."""

    def faults(self, model: Model, data: ModalData, /) -> Iterator[Fault]:
        """Yield the requirements that model or data do not meet; no model is evaluated for that."""

    def complete(self, problem: UpdatingProblem, /) -> Self:
        """Return the prediction with defaults that follow from the nominal model.

        Raises InputError with what this model cannot predict.
        """

    def evaluate(self, problem: UpdatingProblem, theta: Floats, seed: SeedSequence, /) -> Arrays:
        """Return the values of a model, (places,) under each variable's key; NaN where none.

        Raises ModelError where the model cannot be evaluated at ``theta``, InputError where the
        options of a prediction do not suit it there.
        """

    def check(self, problem: UpdatingProblem, theta: Floats, seed: SeedSequence, /) -> Arrays:
        """Return the result of the kind's check at a model, (places,) each; empty without one."""


ATTRIBUTE = "prediction_kinds"  # of results, with the kinds of their predictions in JSON


def _faults(prediction: Any) -> Iterator[Fault]:
    place = f"prediction class {getattr(prediction, '__qualname__', prediction)!s}"
    if not (isinstance(prediction, type) and is_dataclass(prediction)):
        yield Fault("", place, "a frozen dataclass", clean(repr(prediction), NAME))
        return
    kind = getattr(prediction, "kind", None)
    if not isinstance(kind, PredictionKind):
        yield Fault("", place, "an attribute kind, a PredictionKind", clean(repr(kind), NAME))
        return
    methods = ("places", "heading", "settings", "faults", "complete", "evaluate", "check")
    missing = [name for name in methods if not hasattr(prediction, name)]
    missing += ["name"] * ("name" not in prediction.__dataclass_fields__)
    if missing:
        yield Fault("", place, "what modefront.Prediction has", f"no {', '.join(missing)}")
    other: Any = CLASSES.added.get(kind.table)
    names = [(x.__module__, x.__qualname__) for x in (other or prediction, prediction)]
    if names[0] != names[1]:
        yield Fault("", place, "a table of its own", f"'{kind.table}', of {other.__qualname__}")


CLASSES: Family[type[Prediction]] = Family(
    "modefront.predictions",
    "a class of predictions",
    type,
    name=attrgetter("kind.table"),
    faults=_faults,
)
"""Classes of predictions by the names of their tables in study files."""


def as_text(kinds: Iterable[PredictionKind]) -> str:
    """Return kinds in JSON."""
    return json.dumps([asdict(kind) for kind in kinds])


def kinds_in(data: Dataset) -> tuple[PredictionKind, ...]:
    """Return the kinds of which sound results have predictions."""
    return _kinds(str(data.attrs.get(ATTRIBUTE, "[]")))


@cache
def _kinds(text: str) -> tuple[PredictionKind, ...]:
    """Return kinds from JSON, as `as_text` makes it."""
    records: Sequence[Any] = (ResultVariable, Setting, NumericalCheck, PredictionKind)
    known = {frozenset(x.__dataclass_fields__): x for x in records}  # told by names of fields
    return tuple(json.loads(text, object_hook=lambda values: known[frozenset(values)](**values)))


@dataclass(frozen=True)
class Quantity:
    """A number that models predict, as results hold it: one variable at one place."""

    variable: ResultVariable  # what it is
    place: str  # where, without the name of the prediction
    label: str  # of the place, with that name
    values: Floats  # (points,) of all models
    extent: Floats  # least, greatest and their ratio over the Pareto-optimal models; NaN for none
    # standard deviation by the posterior, of the logarithm where that is linearised, as a factor
    # then; None where it is not known to the results
    std: float | None
    drawn: Mapping[str, float]  # statistics over draws from the posterior, by name; none without


def quantity(data: Dataset, variable: ResultVariable, i: int, of: str = "") -> Quantity:
    """Return the i-th column of a variable of results, ``of`` a prediction."""
    name, values = variable.name, data[variable.name]
    dimension = values.dims[1]
    label = str(data[dimension].values[i])
    scattered = f"{dimension}_log" if variable.logarithmic else name
    extent, std, drawn = np.full(3, np.nan), None, {}
    if variable.ranged:
        extent = data[f"{name}_range"].values[:, i]
        if (deviations := data.variables.get(f"posterior_{scattered}_std")) is not None:
            std = float(deviations.values[i])
        if (statistics := data.variables.get(f"posterior_{name}")) is not None:
            of_draws = zip(data["statistic"].values, statistics.values[:, i], strict=True)
            drawn = {str(statistic): float(value) for statistic, value in of_draws}
    place = label.removeprefix(f"{of}: ")
    return Quantity(variable, place, label, values.values[:, i], extent, std, drawn)


@dataclass(frozen=True)
class RecordedPrediction:
    """A prediction in results."""

    kind: PredictionKind  # what it is
    name: str  # of the prediction
    heading: str  # its load case and options
    load: str  # its load; empty where the kind has no such setting
    positions: tuple[int, ...]  # of its values along the dimension of the kind
    quantities: tuple[Quantity, ...]  # of each place in turn, one a variable


def predictions_in(data: Dataset) -> Iterator[RecordedPrediction]:
    """Yield the predictions of sound results."""
    for kind in kinds_in(data):
        start = kind.dimension
        names, load = data[f"{start}_name"].values.tolist(), data.variables.get(f"{start}_load")
        for name in dict.fromkeys(names):
            positions = tuple(i for i, each in enumerate(names) if each == name)
            values = tuple(quantity(data, x, i, name) for i in positions for x in kind.variables)
            heading = str(data[f"{start}_heading"].values[positions[0]])
            loaded = "" if load is None else str(load.values[positions[0]])
            yield RecordedPrediction(kind, str(name), heading, loaded, positions, values)
