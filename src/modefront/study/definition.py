"""A study: an updating problem and the options of its solution, analysis and predictions."""

import hashlib
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Annotated

from modefront.errors import Fault, noted, refuse
from modefront.findings.record import Finding
from modefront.front.methods import METHODS
from modefront.front.options import Pareto, ParetoOptions, Weighted
from modefront.front.point import Kind, label
from modefront.front.search import Search
from modefront.identifiability.combinations import Identifiability
from modefront.models.parameters import Parameter, parameters_of
from modefront.options import check_fields, each_once, text, whole
from modefront.predictions import Prediction
from modefront.predictions.ranges import SLACK
from modefront.residuals.problem import UpdatingProblem
from modefront.results.schema import variables_of
from modefront.text import Shown
from modefront.uncertainty.noise import Uncertainty
from modefront.uncertainty.prior import NoisePrior


@dataclass(frozen=True)
class Origin:
    """Files from which a study was read."""

    file: Path  # the study file
    digest: str  # hash of this file and of all files that it names
    work: str  # hash of the inputs of the problem
    problem: UpdatingProblem  # that was read; a study of another one has another origin
    remark: str = ""  # reason why a requested option is not in use
    notes: tuple[Finding, ...] = ()  # mistakes that were found when it was read


# 12 fields: the problem, where it was read, and each table of options.
@dataclass(frozen=True)
class Study(Shown):
    """A problem with the options of its solution.

    Raises InputError with all options that contradict the problem or one another.

    Attributes
    ----------
    problem : model, data, groups and parameters; `updating_problem` makes it
    name : title of the study in results and reports
    seed : of all random numbers, 0 or more; the same seed gives the same digits
    pareto : method and resolution of the front
    weighted : given weights of models, besides equal and optimal weights
    search : extent of the search for global minima
    identifiability : limits of flat parts and of manifolds of equivalent models
    uncertainty : source of the errors of the data, and samples
    predictions : predictions of all models
    noise : what is expected of the errors of the data and the model
    slack : share by which objectives of models may be greater that count in ranges of predictions
    origin : where the study was read; None for one that was made in Python
    """

    problem: UpdatingProblem
    name: Annotated[str, text("a text of printable characters")] = "study"
    seed: Annotated[int, whole(0, 2**63 - 1)] = 0
    pareto: Pareto = field(default_factory=Pareto)
    weighted: Sequence[Weighted] = ()
    search: Search = field(default_factory=Search)
    identifiability: Identifiability = field(default_factory=Identifiability)
    uncertainty: Uncertainty = field(default_factory=Uncertainty)
    predictions: Sequence[Prediction] = ()
    noise: NoisePrior = field(default_factory=NoisePrior)
    slack: Annotated[float, SLACK] = 0.0
    origin: Origin | None = None

    def __post_init__(self) -> None:
        check_fields(self)
        object.__setattr__(self, "weighted", tuple(self.weighted))
        object.__setattr__(self, "predictions", tuple(self.predictions))
        faults = list[Fault]()
        with noted(faults):
            _ = self.parameters
        with noted(faults):
            variables_of(dict.fromkeys(prediction.kind for prediction in self.predictions))
        groups = self.problem.objectives
        faults += [*each_once("groups", groups), *self.pareto.faults(len(groups))]
        for weighted in self.weighted:
            with noted(faults, f"weighted '{weighted.name}'"):
                refuse((*weighted.faults(groups), *label_faults(weighted.name, groups)))
        faults += each_once("weighted", [weighted.name for weighted in self.weighted])
        faults += self.uncertainty.faults(self.problem.data)
        faults += undrawn(self.uncertainty, len(self.predictions))
        faults += each_once("predictions", [prediction.name for prediction in self.predictions])
        refuse(faults)

    def __repr__(self) -> str:
        """Return a line with the sizes of the problem."""
        return f"Study({self.name!r}, {self.problem}, method={self.pareto.method!r})"

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """The parameters that are updated."""
        problem, names = self.problem, self.problem.model.parameters
        bounds = zip(problem.lower.tolist(), problem.upper.tolist(), strict=True)
        nominal = dict(zip(names, problem.start.tolist(), strict=True))
        return tuple(parameters_of(dict(zip(names, bounds, strict=True)), nominal))

    @property
    def file(self) -> Path:
        """The study file; named like the study where there is none."""
        return self.origin.file if self.origin else Path(self.name)

    @property
    def work(self) -> str:
        """Hash of all that the front depends on; empty where the problem is not read from a file.

        Refinement is left out: it adds to a front that is there.
        """
        if self.origin is None or self.origin.problem is not self.problem:
            return ""
        pareto, uncertainty = replace(self.pareto, refined=None), replace(self.uncertainty, draws=0)
        options = self.seed, pareto, self.weighted, self.search, self.identifiability, uncertainty
        return _hash(self.origin.work, *options, self.noise)

    @property
    def digest(self) -> str:
        """Hash of all inputs; empty where the problem is not read from a file."""
        if self.origin is None or not self.work:
            return ""
        options = self.name, self.uncertainty.draws, self.predictions, self.slack
        return _hash(self.origin.digest, self.work, *options)

    def completed(self) -> "Study":
        """Return the study with what its predictions take from the nominal model.

        Raises InputError with what this model cannot predict.
        """
        out, faults = [], list[Fault]()
        for prediction in self.predictions:
            with noted(faults, f"prediction '{prediction.name}'"):
                out.append(prediction.complete(self.problem))
        refuse(faults)
        return replace(self, predictions=tuple(out))


class StudyOptions(ParetoOptions, total=False):
    """The fields of `Study` and of its `Pareto` as keywords of a function."""

    pareto: Pareto | None
    weighted: Sequence[Weighted]
    seed: int
    search: Search | None
    identifiability: Identifiability | None
    uncertainty: Uncertainty | None
    predictions: Sequence[Prediction]
    noise: NoisePrior | None
    slack: float


def _hash(*parts: object) -> str:
    return hashlib.sha256(repr(parts).encode()).hexdigest()


def undrawn(uncertainty: Uncertainty, predictions: int) -> Iterator[Fault]:
    """Yield what is wrong with draws where there is nothing to predict."""
    if uncertainty.draws and not predictions:
        yield Fault("", "draws", "0 without predictions", str(uncertainty.draws))


def label_faults(name: str, groups: Sequence[str]) -> Iterator[Fault]:
    """Yield the fault of given weights named like another model that a study of groups may have.

    Points of the front, and of its identifiable part, have a number behind a beginning; how many
    there are is not known beforehand.
    """
    labels = {"iterated-weights", *map(label, Kind)}
    labels |= {label(x, of) for x in (Kind.EDGE, Kind.IDENTIFIABLE_EDGE) for of in groups}
    points = {*(label(Kind.FRONT, method) for method in METHODS), label(Kind.IDENTIFIABLE)}
    if name in labels or re.sub("[0-9]+$", "0", name) in points:
        yield Fault("", "name", "another name than the labels of a study's models", f"'{name}'")
