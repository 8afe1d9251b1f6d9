"""Predictions of all models of a study, and their scatter by the posterior, as values of results.

There is a task for each model. Every one gets the same random numbers (common random numbers), so
that predictions differ by the models alone. To first order the scatter needs two models along each
axis of the posterior; with draws, the models drawn.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import compress, product
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from modefront._typing import Arrays, Floats
from modefront.datasets import ArrayDataset, Dataset
from modefront.errors import Fault, InputError, ModelError, UnfinishedError
from modefront.findings.knowledge import enumeration
from modefront.findings.record import Finding, found
from modefront.front.point import position, preferred
from modefront.identifiability.combinations import ALL
from modefront.models.base import full_of, is_reduced
from modefront.optim.lexicographic import RANK
from modefront.predictions import NumericalCheck, Prediction, PredictionKind, ResultVariable
from modefront.predictions.base import ATTRIBUTE, as_text, kinds_in
from modefront.predictions.ranges import Sampled, extreme
from modefront.residuals.problem import UpdatingProblem
from modefront.results.assemble import left_open
from modefront.results.findings import as_values
from modefront.results.schema import Values, described
from modefront.uncertainty import prediction as spread
from modefront.uncertainty.scatter import Posterior
from modefront.work.store import hash_text
from modefront.work.task import Executor, Key, Task, seed_sequence

T = TypeVar("T")

STEP, ROUGH = 1e-4, 1e-2
"""Steps of differences of a prediction over the ranges of the parameters: of smooth ones, and of
those that are estimated from samples."""


@dataclass(frozen=True)
class PredictionRunner:
    """Runs the predictions of a study."""

    problem: UpdatingProblem
    predictions: Sequence[Prediction]
    seed: int
    work: Executor
    file: Path  # of the study, named in messages

    @property
    def kinds(self) -> dict[PredictionKind, list[tuple[Prediction, slice]]]:
        """The predictions of each kind, with the places of each along its dimension."""
        out: dict[PredictionKind, list[tuple[Prediction, slice]]] = {}
        for each in self.predictions:
            known = out.setdefault(each.kind, [])
            first = sum(len(x.places) for x, _ in known)
            known.append((each, slice(first, first + len(each.places))))
        return out

    def at_models(
        self,
        kind: PredictionKind,
        thetas: Floats,
        name: str,
        labels: Sequence[str] = (),
        check: NumericalCheck | None = None,
    ) -> tuple[dict[str, Floats], list[int]]:
        """Return the predictions of a kind at models (m, p), or their check with finer numerics.

        Values are (m, places) by key. Models with ``labels`` raise InputError where an option does
        not suit them, and UnfinishedError where they have not the modes that are needed; others
        have NaN then, and are counted for each prediction.
        """
        parts: list[Key] = [(name, label) for label in labels] or [
            (name, i, hash_text(f"{theta.tolist()}")[:8]) for i, theta in enumerate(thetas, start=1)
        ]
        file, predictions = str(self.file) if labels else "", self.kinds[kind]
        method, failed = "check" if check else "evaluate", []
        shape = len(thetas), predictions[-1][1].stop
        values = {x.key: np.full(shape, np.nan) for x in (check or kind).variables}
        for each, own in predictions:
            tasks = [
                self._task(each, part, _predicted, theta, method, file, part[-1])
                for part, theta in zip(parts, thetas, strict=True)
            ]
            rows = self.work.run(tasks)
            for i, row in enumerate(rows):
                for key in values:
                    values[key][i, own] = np.nan if row is None else row[key]
            failed.append(sum(row is None for row in rows))
        return values, failed

    def extremes(self, kind: PredictionKind, front: Sampled, values: Arrays) -> dict[str, Floats]:
        """Return least and greatest values over a front, and over all models that are equivalent.

        ``values`` (m, places) are those of its m models by key. The ends have the shape
        (2, places), by the key of each variable of which the range is reported.
        """
        mark = hash_text(f"{front.theta.tolist()} {front.is_open} {front.slack}")[:8]
        out = {x.key: np.empty((2, values[x.key].shape[1])) for x in kind.ranged}
        for each, own in self.kinds[kind]:
            of_models = {key: x[:, own] for key, x in values.items()}
            ends: list[End] = list(product(kind.ranged, (1.0, -1.0), range(len(each.places))))
            # Ends share what is solved between points; over equivalent models each is a task.
            parts = [[end] for end in ends] if front.is_open else [ends]
            tasks = [
                self._task(each, ("ends", k, mark), _ends, front, of_models, part)
                for k, part in enumerate(parts, start=1)
            ]
            found = np.array([end for each in self.work.run(tasks) for end in each])
            rows = found.reshape(len(kind.ranged), 2, len(each.places))
            for variable, row in zip(kind.ranged, rows, strict=True):
                out[variable.key][:, own] = row
        return out

    def at_points(self, data: ArrayDataset, slack: float) -> ArrayDataset:
        """Return results with the predictions of every point."""
        optimal, best = data["pareto"].values, position(data)
        values: Values = {"frequency_range": _range(data["frequency"].values[optimal])}
        coordinates = {"range": ["minimum", "maximum", "spread"]}
        labels, thetas = list(map(str, data["label"].values)), data["theta"].values
        together = ALL if data.sizes["group"] > 1 else data["group"].values[0]
        of = data["combination_of"].values == together
        here = of & (data["combination_at"].values == labels[best])
        is_open = (data["combination_share"].values[here] <= RANK).any()
        is_open |= (np.diag(data["collinearity"].values) == 0).any()
        J, others = data["objective"].values[optimal], data["equal_theta"].values
        known = (others, data["equal_objective"].values) if others.size else None
        front = Sampled(thetas[optimal], J, slack > 0 or bool(is_open), slack, known)
        for kind, predictions in self.kinds.items():
            of_points, _ = self.at_models(kind, thetas, "point", labels)
            values |= {x.name: of_points[x.key] for x in kind.variables}
            of_optimal = {key: x[optimal] for key, x in of_points.items()}
            of_ends = self.extremes(kind, front, of_optimal)
            for x in kind.ranged:
                # Over the optimal points, and between and beside these over all equivalent ones.
                values[f"{x.name}_range"] = _range(np.vstack([of_optimal[x.key], of_ends[x.key]]))
            for setting in kind.settings:
                values[setting.name] = [x for y, _ in predictions for x in y.settings[setting.name]]
            for name in ("name", "heading"):
                texts = [getattr(each, name) for each, _ in predictions for _ in each.places]
                values[f"{kind.dimension}_{name}"] = texts
            places = [place for each, _ in predictions for place in each.places]
            coordinates[kind.dimension] = places
            if check := kind.check:
                at = thetas[[best]], check.name, [labels[best]]
                checked, _ = self.at_models(kind, *at, check)
                values |= {x.name: checked[x.key][0] for x in check.variables}
                values[check.label.name] = [labels[best]] * len(places)
        out = data.assign(described(values, self.kinds)).assign_coords(coordinates)
        return out.assign_attrs({ATTRIBUTE: as_text(self.kinds)})

    def to_first_order(
        self, data: Dataset, kind: PredictionKind, stencil: spread.Stencil, limits: list[Finding]
    ) -> Values:
        """Return standard deviations and covariances, of the logarithms where these are linearised.

        What limits them is added to ``limits``.
        """
        m, _, p = stencil.theta.shape
        values, _ = self.at_models(kind, stencil.theta.reshape(2 * m, p), "axis")
        out: Values = {}
        unknown = np.zeros(data.sizes[kind.dimension], dtype=np.bool_)
        for variable in kind.ranged:
            middle = data[variable.name].values[position(data)]
            beside = _scaled(values[variable.key].reshape(m, 2, middle.size), variable)
            S = stencil.slopes(_scaled(middle, variable), beside)
            S[~np.isfinite(S).all(axis=1)] = np.nan
            C = S @ S.T
            std, name = np.sqrt(np.diag(C)), f"posterior_{variable.name}"
            unknown |= np.isfinite(middle) & np.isnan(std)
            of = f"posterior_{kind.dimension}_log" if variable.logarithmic else name
            out |= {f"{of}_std": std, f"{of}_covariance": C}
            if variable.logarithmic:
                out[f"{name}_std"] = spread.lognormal_std(middle, std)
        best = preferred(data.attrs)
        limits += [
            found("no-deviation", str(name), reference=best, undefined=kind.undefined)
            for name in data[kind.dimension].values[unknown]
        ]
        return out

    def of_samples(
        self, data: Dataset, kind: PredictionKind, samples: Floats, limits: list[Finding]
    ) -> Values:
        """Return values at draws and their statistics; what limits them is added to ``limits``."""
        first, predictions = kind.variables[0], self.kinds[kind]
        values, failed = self.at_models(kind, samples, "draw")
        out: Values = {}
        for variable in kind.ranged:
            out[f"draw_{variable.name}"] = values[variable.key]
            out[f"posterior_{variable.name}"] = spread.summary(values[variable.key])
        missing = np.isnan(values[first.key]).sum(axis=0)
        lacking = []
        for (each, own), n in zip(predictions, failed, strict=True):
            missing[own] -= n
            lacking.append((each.name, n, "cannot be solved"))
        missing[np.isnan(data[first.name].values[position(data)])] = 0
        lacking += [
            (str(name), n, kind.absent)
            for name, n in zip(data[kind.dimension].values, missing.tolist(), strict=True)
        ]
        limits += [
            found("unsolved-draws", name, count=n, drawn=len(samples), what=what)
            for name, n, what in lacking
            if n > 0
        ]
        return out

    def _task(
        self, prediction: Prediction, part: Key, function: Callable[..., T], *arguments: Any
    ) -> Task[T]:
        """Return a task whose key tells apart all that the prediction depends on."""
        mark = hash_text(f"{prediction!r} {self.seed}")[:8]
        numbers = seed_sequence(self.seed, "predict", prediction.name)
        full = full_of(self.problem.model)
        return Task(
            ("predict", prediction.name, *part, mark),
            function,
            (self.problem, prediction, numbers, *arguments),
            # Responses are those of the full model.
            memory=getattr(full, "footprint", 0.0) if is_reduced(self.problem.model) else 0.0,
        )


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
    data = runner.at_points(data, slack)
    values: Values = {}
    coordinates: dict[str, object] = {}
    for kind in runner.kinds:
        if differences is not None:
            values |= runner.to_first_order(data, kind, differences, limits)
            coordinates[f"{kind.dimension}_other"] = data[kind.dimension].values
        if len(samples):
            values |= runner.of_samples(data, kind, samples, limits)
    if len(samples):
        values["draw_theta"] = samples
        coordinates["statistic"] = np.array(spread.SUMMARY)
    for name, more in as_values(limits).items():
        values[name] = [*data[name].values.tolist(), *more]
    return data.assign(described(values, kinds_in(data))).assign_coords(coordinates)


# 7 arguments: the problem and the prediction, and the model with its label.
def _predicted(
    problem: UpdatingProblem,
    prediction: Prediction,
    numbers: np.random.SeedSequence,
    theta: Floats,
    method: str = "evaluate",
    file: str = "",
    label: str = "",
) -> Arrays | None:
    """Return a prediction at a model by key; without a file, None where it cannot be solved."""
    try:
        return getattr(prediction, method)(problem, theta, numbers)
    except (InputError, ModelError) as error:
        if not file:
            return None
        if isinstance(error, ModelError):
            text = f"no prediction '{prediction.name}' of '{label}': {error}"
            raise UnfinishedError(text) from None
        place = f"[[predict.{prediction.kind.table}]] ({prediction.name!r})"
        raise InputError(
            Fault(file, f"{place} {fault.place}", f"{fault.expected} of '{label}'", fault.found)
            for fault in error.faults
        ) from None


End = tuple[ResultVariable, float, int]
"""A variable, whether its least (1) or its greatest value (-1) is sought, and at which place."""


def _ends(
    problem: UpdatingProblem,
    prediction: Prediction,
    numbers: np.random.SeedSequence,
    front: Sampled,
    values: Arrays,
    ends: Sequence[End],
) -> Floats:
    """Return the ends of ranges over a front of which the predictions are known."""
    known: dict[bytes, Arrays | None] = {}
    # The same work, whatever was done before in this process.
    front, out = replace(front, between={}), list[float]()

    def at(theta: Floats, variable: ResultVariable, place: int) -> float:
        key = theta.tobytes()
        if key not in known:
            known[key] = _predicted(problem, prediction, numbers, theta)
        found = known[key]
        return np.nan if found is None else float(_scaled(found[variable.key], variable)[place])

    for variable, sign, place in ends:
        step, own = ROUGH if variable.logarithmic else STEP, _scaled(values[variable.key], variable)
        value = partial(at, variable=variable, place=place)
        found = extreme(problem, front, own[:, place], value, sign, step)
        out.append(float(np.exp(found)) if variable.logarithmic else found)
    return np.array(out)


def _scaled(values: Floats, variable: ResultVariable) -> Floats:
    """Return values as they are linearised, NaN for no logarithm."""
    if not variable.logarithmic:
        return values
    return np.log(values, out=np.full(values.shape, np.nan), where=values > 0)


def _range(values: Floats) -> Floats:
    """Return least, greatest and their ratio over rows, (3, columns); NaN for none."""
    known = np.where(np.isfinite(values), values, np.nan)
    least, greatest = (of.reduce(known, axis=0, initial=np.nan) for of in (np.fmin, np.fmax))
    ratio = np.divide(greatest, least, out=np.full(least.shape, np.nan), where=least > 0)
    return np.array([least, greatest, ratio])
