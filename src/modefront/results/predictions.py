"""Predictions of all models of a study, and their scatter by the posterior, as values of results.

There is a task for each model. Every one gets the same random numbers (common random numbers), so
that predictions differ by the models alone. To first order the scatter needs two models along each
axis of the posterior; with draws, the models drawn.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import chain, compress
from pathlib import Path
from typing import Any, Literal, TypeVar

import numpy as np

from modefront._typing import Bools, Floats
from modefront.datasets import ArrayDataset, Dataset
from modefront.errors import Fault, InputError, ModelError, UnfinishedError
from modefront.findings.knowledge import enumeration
from modefront.findings.record import Finding, found, from_text
from modefront.front.point import position, preferred
from modefront.identifiability.combinations import ALL
from modefront.models.base import full_of, is_reduced
from modefront.optim.lexicographic import RANK
from modefront.predictions import Prediction, PredictionKind, ResultVariable
from modefront.predictions.base import ATTRIBUTE, as_text, kinds_in
from modefront.predictions.ranges import Sampled, extreme
from modefront.residuals.problem import UpdatingProblem
from modefront.results.assemble import left_open
from modefront.results.findings import as_values
from modefront.results.schema import Values, described
from modefront.uncertainty import prediction as spread
from modefront.uncertainty.scatter import Posterior
from modefront.work.codec import record
from modefront.work.store import hash_text
from modefront.work.task import Executor, Part, Task, seed_sequence

Arrays = Mapping[str, Floats]

T = TypeVar("T")

STEP, ROUGH = 1e-4, 1e-2
"""Steps of differences of a prediction over the ranges of the parameters: of smooth ones, and of
those that are estimated from samples."""


@record
@dataclass(frozen=True)
class Predicted:
    """A prediction of a model."""

    values: Arrays  # arrays (places,) by key; NaN where the model cannot be solved
    solved: bool = True  # whether it can


@dataclass(frozen=True)
class PredictionRunner:
    """Runs the predictions of a study."""

    problem: UpdatingProblem
    predictions: Sequence[Prediction]
    seed: int
    work: Executor
    file: Path  # of the study, named in messages

    def at_models(
        self,
        prediction: Prediction,
        thetas: Sequence[Floats] | Floats,
        name: str,
        labels: Sequence[str] = (),
        method: Literal["evaluate", "check"] = "evaluate",
    ) -> list[Predicted]:
        """Return a prediction at models (m, p), or the kind's comparison with finer numerics.

        Models with ``labels`` raise InputError where an option does not suit them, and
        UnfinishedError where they have not the modes that are needed; others have NaN then.
        """
        parts: list[tuple[Part, ...]] = [(name, label) for label in labels]
        if not labels:
            marks = (hash_text(f"{theta.tolist()}")[:8] for theta in thetas)
            parts = [(name, i, mark) for i, mark in enumerate(marks, start=1)]
        file = str(self.file) if labels else ""
        tasks = [
            self._task(prediction, part, _predicted, (theta, method, file, part[-1]))
            for part, theta in zip(parts, thetas, strict=True)
        ]
        return self.work.run(tasks)

    def extremes(self, prediction: Prediction, front: Sampled, values: Arrays) -> dict[str, Floats]:
        """Return least and greatest values over a front, and over all models that are equivalent.

        ``values`` (m, places) are those of its m models by key. The ends have the shape
        (2, places), by the key of each variable of which the range is reported.
        """
        mark = hash_text(f"{front.theta.tolist()} {front.is_open} {front.slack}")[:8]
        ends: list[End] = [
            (variable, i, sign)
            for variable in prediction.kind.ranged
            for sign in (1.0, -1.0)
            for i in range(len(prediction.places))
        ]
        # Ends share what is solved between points; over equivalent models each is work of its own.
        parts = [[end] for end in ends] if front.is_open else [ends]
        tasks = [
            self._task(prediction, ("ends", k + 1, mark), _ends, (front, values, part))
            for k, part in enumerate(parts)
        ]
        found = np.concatenate(self.work.run(tasks))
        shape = (len(prediction.kind.ranged), 2, len(prediction.places))
        keys = (variable.key for variable in prediction.kind.ranged)
        return dict(zip(keys, found.reshape(shape), strict=True))

    def _task(
        self,
        prediction: Prediction,
        part: tuple[Part, ...],
        function: Callable[..., T],
        arguments: tuple[Any, ...],
    ) -> Task[T]:
        """Return a task whose key tells apart all that the prediction depends on."""
        mark = hash_text(f"{prediction!r} {self.seed}")[:8]
        numbers = seed_sequence(self.seed, "predict", prediction.name)
        key = ("predict", prediction.name, *part, mark)
        full = full_of(self.problem.model)
        return Task(
            key,
            function,
            (self.problem, prediction, numbers, *arguments),
            # Responses are those of the full model.
            memory=getattr(full, "footprint", 0.0) if is_reduced(self.problem.model) else 0.0,
        )


# 7 arguments: the problem and the prediction, and the model with its label.
def _predicted(
    problem: UpdatingProblem,
    prediction: Prediction,
    numbers: np.random.SeedSequence,
    theta: Floats,
    method: Literal["evaluate", "check"] = "evaluate",
    file: str = "",
    label: str = "",
) -> Predicted:
    """Return a prediction at a model; without a file, NaN where it cannot be solved."""
    try:
        return Predicted(getattr(prediction, method)(problem, theta, numbers))
    except (InputError, ModelError) as error:
        if not file:
            unknown = np.full(len(prediction.places), np.nan)
            return Predicted({x.key: unknown for x in prediction.kind.variables}, solved=False)
        if isinstance(error, ModelError):
            text = f"no prediction '{prediction.name}' of '{label}': {error}"
            raise UnfinishedError(text) from None
        place = f"[[predict.{prediction.kind.table}]] ({prediction.name!r})"
        raise InputError(
            Fault(file, f"{place} {fault.place}", f"{fault.expected} of '{label}'", fault.found)
            for fault in error.faults
        ) from None


End = tuple[ResultVariable, int, float]
"""A variable at a place, and whether its least (1) or its greatest value (-1) is sought."""


def _ends(
    problem: UpdatingProblem,
    prediction: Prediction,
    numbers: np.random.SeedSequence,
    front: Sampled,
    values: Arrays,
    ends: Sequence[End],
) -> Floats:
    """Return the ends of ranges over a front of which the predictions are known."""
    known: dict[bytes, Arrays] = {}
    # The same work, whatever was done before in this process.
    front, out = replace(front, between={}), list[float]()

    def scaled(values: Arrays, variable: ResultVariable, place: int) -> Floats:
        own = values[variable.key][..., place]
        if not variable.logarithmic:
            return own
        return np.log(own, out=np.full(own.shape, np.nan), where=own > 0)

    def at(theta: Floats, variable: ResultVariable, place: int) -> float:
        key = theta.tobytes()
        if key not in known:
            known[key] = _predicted(problem, prediction, numbers, theta).values
        return float(scaled(known[key], variable, place))

    for variable, place, sign in ends:
        step, own = ROUGH if variable.logarithmic else STEP, scaled(values, variable, place)
        value = partial(at, variable=variable, place=place)
        found = extreme(problem, front, own, value, sign, step)
        out.append(float(np.exp(found)) if variable.logarithmic else found)
    return np.array(out)


def _by_kind(
    predictions: Sequence[Prediction],
) -> Iterator[tuple[PredictionKind, list[Prediction]]]:
    for kind in dict.fromkeys(each.kind for each in predictions):
        yield kind, [each for each in predictions if each.kind == kind]


# 6 arguments: the results and their predictions, and models drawn from the posterior.
def with_predictions(
    data: ArrayDataset,
    runner: PredictionRunner,
    slack: float,
    posterior: Posterior | None,
    draws: int,
    drawn: Floats | None = None,
) -> ArrayDataset:
    """Return results with the predictions of every point, and their scatter by the posterior.

    ``slack`` is the share by which objectives of models may be greater that count in ranges.
    ``drawn`` (draws or more, p) are models of the posterior; so many are drawn around the reference
    where it is None. Raises what `PredictionRunner.at_models` raises.
    """
    if not runner.predictions:
        return data
    problem, limits = runner.problem, list[Finding]()
    samples = np.empty((0, problem.start.size)) if drawn is None else drawn[:draws]
    differences = None
    if posterior is None:
        limits += [found("no-posterior")] if draws and not len(samples) else []
    else:
        theta, best = data["theta"].values[position(data)], preferred(data.attrs)
        if names := list(compress(problem.model.parameters, left_open(posterior.free))):
            limits.append(found("open-in-posterior", enumeration(names), reference=best))
        bounds = problem.lower, problem.upper
        differences = spread.stencil(theta, posterior.axes, *bounds)
        if differences is None:
            limits.append(found("no-room", str(best)))
        if draws and not len(samples):
            rng = np.random.default_rng(seed_sequence(runner.seed, "posterior"))
            try:
                samples = spread.draw(theta, posterior.axes, rng, draws, bounds)
            except spread.TruncationError as error:
                limits.append(found("no-draws", str(error)))
    models = data.sizes["point"] + 2 * len(differences.theta if differences else ()) + len(samples)
    count = sum(models + 1 + (each.kind.check is not None) for each in runner.predictions)
    runner.work.expect({"predict": (count, count)})
    data = _at_points(data, runner, slack)
    values: Values = {}
    coordinates: dict[str, object] = {}
    for kind, predictions in _by_kind(runner.predictions):
        if differences is not None:
            values |= _to_first_order(data, runner, differences, predictions, limits)
            coordinates[f"{kind.dimension}_other"] = data[kind.dimension].values
        if len(samples):
            values |= _of_samples(data, runner, samples, predictions, limits)
    if len(samples):
        values["draw_theta"] = samples
        coordinates["statistic"] = np.array(spread.SUMMARY)
    kept = zip(data["finding"].values.tolist(), data["finding_record"].values, strict=True)
    values |= as_values([*(from_text(str(text), each) for each, text in kept), *limits])
    return data.assign(described(values, kinds_in(data))).assign_coords(coordinates)


def _at_points(data: ArrayDataset, runner: PredictionRunner, slack: float) -> ArrayDataset:
    optimal = data["pareto"].values
    values: Values = {"frequency_range": _range(data["frequency"].values, optimal)}
    coordinates = {"range": ["minimum", "maximum", "spread"]}
    labels, thetas = list(map(str, data["label"].values)), data["theta"].values
    reference = [preferred(data.attrs)]
    theta, J = (data[name].values[optimal] for name in ("theta", "objective"))
    together = ALL if data.sizes["group"] > 1 else data["group"].values[0]
    of = data["combination_of"].values == together
    here = of & (data["combination_at"].values == reference[0])
    is_open = (data["combination_share"].values[here] <= RANK).any()
    is_open |= (np.diag(data["collinearity"].values) == 0).any()
    front = Sampled(theta, J, slack > 0 or bool(is_open), slack)
    kinds = []
    for kind, predictions in _by_kind(runner.predictions):
        rows = [
            [x.values for x in runner.at_models(each, thetas, "point", labels)]
            for each in predictions
        ]
        best = [list(compress(row, optimal)) for row in rows]
        ends = [
            runner.extremes(each, front, {key: np.array([x[key] for x in row]) for key in row[0]})
            for each, row in zip(predictions, best, strict=True)
        ]
        of_points = _stacked(kind, rows)
        for variable in kind.variables:
            values[variable.name] = of_points[variable.key]
        for variable in kind.ranged:
            # Over the optimal points, and between and beside these over all that are equivalent.
            more = np.hstack([x[variable.key] for x in ends])
            known = np.append(optimal, np.ones(len(more), dtype=np.bool_))
            over = np.vstack([of_points[variable.key], more])
            values[f"{variable.name}_range"] = _range(over, known)
        for setting in kind.settings:
            every = (prediction.settings[setting.name] for prediction in predictions)
            values[setting.name] = list(chain.from_iterable(every))
        for name in ("name", "heading"):
            every = ([getattr(each, name)] * len(each.places) for each in predictions)
            values[f"{kind.dimension}_{name}"] = list(chain.from_iterable(every))
        coordinates[kind.dimension] = list(chain.from_iterable(x.places for x in predictions))
        if kind.check:
            here, name = thetas[[position(data)]], kind.check.name
            checks = [
                runner.at_models(each, here, name, reference, "check")[0] for each in predictions
            ]
            for variable in kind.check.variables:
                values[variable.name] = np.concatenate([x.values[variable.key] for x in checks])
            values[kind.check.label.name] = reference * len(coordinates[kind.dimension])
        kinds.append(kind)
    out = data.assign(described(values, kinds)).assign_coords(coordinates)
    return out.assign_attrs({ATTRIBUTE: as_text(kinds)})


def _range(values: Floats, optimal: Bools) -> Floats:
    """Return least, greatest and their ratio over the optimal rows, (3, columns); NaN for none."""
    known = optimal[:, None] & np.isfinite(values)
    least = np.where(known, values, np.inf).min(axis=0)
    greatest = np.where(known, values, -np.inf).max(axis=0)
    none = ~known.any(axis=0)
    least[none] = greatest[none] = np.nan
    ratio = np.divide(greatest, least, out=np.full(least.shape, np.nan), where=least > 0)
    return np.array([least, greatest, ratio])


def _stacked(
    kind: PredictionKind, rows: Sequence[Sequence[Mapping[str, Floats]]]
) -> dict[str, Floats]:
    """Return values of predictions at models by their keys, each (models, places)."""
    return {
        x.key: np.hstack([np.array([values[x.key] for values in row]) for row in rows])
        for x in kind.variables
    }


def _to_first_order(
    data: Dataset,
    runner: PredictionRunner,
    differences: spread.Stencil,
    predictions: Sequence[Prediction],
    limits: list[Finding],
) -> Values:
    """Return standard deviations and covariances, of the logarithms where these are linearised.

    What limits them is added to ``limits``.
    """
    kind = predictions[0].kind
    m, _, p = differences.theta.shape
    thetas = differences.theta.reshape(2 * m, p)
    rows = [runner.at_models(each, thetas, "axis") for each in predictions]
    values = _stacked(kind, [[x.values for x in row] for row in rows])
    out: Values = {}
    unknown = np.zeros(data.sizes[kind.dimension], dtype=np.bool_)
    for variable in kind.ranged:
        middle = data[variable.name].values[position(data)]
        beside = values[variable.key].reshape(m, 2, -1)
        with np.errstate(divide="ignore", invalid="ignore"):
            change = (np.log(middle), np.log(beside)) if variable.logarithmic else (middle, beside)
            S = differences.slopes(*change)
        S[~np.isfinite(S).all(axis=1)] = np.nan
        C = S @ S.T
        std, name = np.sqrt(np.diag(C)), f"posterior_{variable.name}"
        unknown |= np.isfinite(middle) & np.isnan(std)
        if variable.logarithmic:
            start = f"posterior_{kind.dimension}_log"
            out |= {f"{start}_std": std, f"{start}_covariance": C}
            out[f"{name}_std"] = spread.lognormal_std(middle, std)
        else:
            out |= {f"{name}_std": std, f"{name}_covariance": C}
    best = preferred(data.attrs)
    limits += [
        found("no-deviation", str(name), reference=best, undefined=kind.undefined)
        for name in data[kind.dimension].values[unknown]
    ]
    return out


def _of_samples(
    data: Dataset,
    runner: PredictionRunner,
    samples: Floats,
    predictions: Sequence[Prediction],
    limits: list[Finding],
) -> Values:
    """Return values at draws and their statistics; what limits them is added to ``limits``."""
    kind, n = predictions[0].kind, len(samples)
    rows = [runner.at_models(each, samples, "draw") for each in predictions]
    values = _stacked(kind, [[x.values for x in row] for row in rows])
    out: Values = {}
    for variable in kind.ranged:
        out[f"draw_{variable.name}"] = values[variable.key]
        out[f"posterior_{variable.name}"] = spread.summary(values[variable.key])
    failed = [sum(not x.solved for x in row) for row in rows]
    limits += [
        found("unsolved-draws", each.name, count=count, drawn=n, what="cannot be solved")
        for each, count in zip(predictions, failed, strict=True)
        if count
    ]
    first = kind.variables[0]
    missing = np.isnan(values[first.key]).sum(axis=0)
    missing -= np.repeat(failed, [len(each.places) for each in predictions])
    missing[np.isnan(data[first.name].values[position(data)])] = 0
    limits += [
        found("unsolved-draws", str(name), count=int(count), drawn=n, what=kind.absent)
        for name, count in zip(data[kind.dimension].values, missing, strict=True)
        if count > 0
    ]
    return out
