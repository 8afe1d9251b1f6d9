"""Estimate of the time that a study takes, with advice on how to shorten it.

One model is evaluated a few times, and each prediction once, with few samples. How many models a
run evaluates is counted in `_parts` from averages over studies with 1 to 17 parameters: a local
search takes 8 evaluations and one more for every second parameter, a point of the front 4 and half
as many. Searches for global minima go on for as long as they find new ones, so that the estimate
may be wrong by a factor of three.
"""

from __future__ import annotations

import math
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from modefront.errors import InputError, ModelError
from modefront.front.simplex import default_points, size
from modefront.models.base import full_of, is_reduced
from modefront.predictions import Passage, Prediction
from modefront.residuals.problem import UpdatingProblem
from modefront.results.predictions import extent
from modefront.study.definition import Study
from modefront.uncertainty.most_probable import STARTS as MAXIMA
from modefront.uncertainty.sampling import BATCH, DRAWS
from modefront.work.costs import uncounted

STARTS = 12
"""Searches that an edge usually takes."""

WITHIN = 3.0
"""Factor within which the estimate is right where searches end before their budget."""

SHORT = 30.0
"""Seconds up to which no advice on a shorter run is given."""

SHARE = 0.25
"""Share of the time from which a part of the work is worth to be made shorter."""

REDUCED = 0.05
"""Share of a solution in full that one in a reduced basis takes, for models that have one."""


SAMPLES = 100
"""Samples with which a prediction is timed, and three times as many."""

PROGRAMME = 4e-9
"""Seconds of the quadratic programme of a step over the third power of the number of parameters:
that of some ten decompositions."""

LARGE = 2000
"""Degrees of freedom from which a reduced basis is worth a try."""


@dataclass(frozen=True)
class Part:
    """A part of the work.

    Attributes
    ----------
    stage : of the run in which it is done
    seconds : that it will probably take
    advice : what would make it shorter; empty for nothing
    """

    stage: str
    seconds: float
    advice: str = ""


@dataclass(frozen=True)
class Estimate:
    """The time that a study will probably take.

    Attributes
    ----------
    seconds : in all, by one process
    evaluations : models that are evaluated, about
    each : seconds for one of them
    steps : seconds for the quadratic programmes of all steps
    advice : what would make the run shorter, that of the longest part first; none for short runs
    stages : seconds of a task of the stages of a run
    budget : seconds of a search that spends all of its evaluations
    """

    seconds: float
    evaluations: int
    each: float
    steps: float
    advice: tuple[str, ...]
    stages: Mapping[str, float]
    budget: float = 0.0

    @property
    def text(self) -> str:
        """The estimate in a sentence."""
        predicted = self.seconds - self.evaluations * self.each - self.steps
        share = f", {duration(predicted)} for predictions" if predicted > self.seconds / 10 else ""
        if self.steps > self.seconds / 10:
            share += f", {duration(self.steps)} for steps in so many parameters"
        least, most = self.seconds / WITHIN, max(WITHIN * self.seconds, self.budget)
        return (
            f"a run takes {duration(least)} to {duration(most)}: the number of minima decides "
            f"(roughly {_round(self.evaluations)} models at {duration(self.each)} each{share})"
        )


def estimate(study: Study) -> Estimate | None:
    """Return the time that a study takes; None where the nominal model cannot be evaluated."""
    problem = study.problem
    with uncounted():
        each = _seconds(problem)
        if each is None:
            return None
        step = PROGRAMME * len(problem.start) ** 3
        parts = [*_parts(study, each, step), *_predictions(study, each)]
    seconds = sum(part.seconds for part in parts)
    solving = sum(part.seconds for part in parts if part.stage != "predict")
    steps = solving - sum(part.seconds for part in _parts(study, each, 0.0))
    evaluations = round((solving - steps) / each) if each else 0
    long = [part for part in parts if part.seconds > SHARE * seconds and part.advice]
    advice = [part.advice for part in sorted(long, key=lambda part: -part.seconds)]
    if study.problem.model.size >= LARGE and not is_reduced(study.problem.model):
        advice.insert(0, 'a reduced basis ([model] reduction = "auto")')
    if seconds > SHORT:
        advice.append("--workers N with as many as there are cores")
    stages: dict[str, float] = {}
    tasks = expected_tasks(study)
    for part in parts:
        share = part.seconds / max(tasks.get(part.stage, 1), 1)
        stages[part.stage] = stages.get(part.stage, 0.0) + share
    budget = seconds + (each + step) * study.search.evaluations
    long_enough = tuple(advice) if seconds > SHORT else ()
    return Estimate(seconds, evaluations, each, steps, long_enough, stages, budget)


def expected_tasks(study: Study) -> dict[str, int]:
    """Return the tasks that a run of a study will probably have, by their stages."""
    n, pareto = len(study.problem.groups), study.pareto
    models = study.identifiability.models
    known = study.uncertainty.of(study.problem.data) is not None
    out = {
        "check-groups": 1,
        "sample": 1,
        "edges": (n + len(study.weighted) + 1) * STARTS,
        "optimal-weights": n + 2,
        "iterated-weights": 1,
        "manifold": n + 1 if models else 0,
        "second-derivatives": _models(study) if known else 1,
        "bootstrap": study.uncertainty.bootstrap,
        "nominal": 1,
        "shapes": 1,
    }
    if study.noise.weight:
        out |= {"most-probable": MAXIMA, "sample-posterior": DRAWS // BATCH, "posterior": 1}
    if n > 1:
        generations = max(pareto.evaluations // pareto.population, 1)
        searched = 2 * (_points(study) + STARTS)
        out["front"] = searched if pareto.method in ("nbi", "weights") else generations
    predicted = _models(study) + (study.uncertainty.draws or 1 + 2 * len(study.problem.start))
    return out | extent(study.predictions, predicted)


def duration(seconds: float) -> str:
    """Return a time in the unit that suits it.

    >>> duration(0.0004), duration(8.2), duration(400.0), duration(9000.0)
    ('0.4 ms', '8.2 s', '7 min', '2.5 h')
    """
    if seconds < 0.1:
        return f"{1e3 * seconds:.2g} ms"
    if seconds < 10:
        return f"{seconds:.2g} s"
    if seconds < 90:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 5400 else f"{seconds / 3600:.1f} h"


def _round(count: int) -> int:
    """Return a number with one leading digit.

    >>> _round(847)
    800
    """
    power = 10 ** max(len(str(count)) - 1, 0)
    return max(round(count / power), 1) * power


def _seconds(problem: UpdatingProblem) -> float | None:
    """Return the seconds of an evaluation; the first one makes what others share."""
    model = full_of(problem.model)
    count = len(problem.data.modes)
    try:
        model.modes(problem.start, count)
        best = math.inf
        for _ in range(2):
            began = time.perf_counter()
            model.modes(problem.start, count)
            best = min(best, time.perf_counter() - began)
    except ModelError:
        return None
    return best * (REDUCED if is_reduced(problem.model) else 1.0)


def _parts(study: Study, each: float, step: float) -> Iterator[Part]:
    """Yield the parts of the work, predictions apart: seconds of a model and of a step besides."""
    p, n = len(study.problem.start), len(study.problem.groups)
    search, pareto = study.search, study.pareto
    both = each + step
    yield Part("optimal-weights", both * 6 * (8 + p / 2))
    yield Part(
        "edges",
        both * min((n + 1) * STARTS * (8 + p / 2), search.evaluations),
        f"fewer evaluations of the search ([search] evaluations, now {search.evaluations})",
    )
    if study.noise.weight:
        yield Part("most-probable", both * MAXIMA * (8 + p / 2))
        yield Part("sample-posterior", both * DRAWS * (8 + p / 2))
    points = _points(study)
    point = 4 + p / 2
    if pareto.method in ("nbi", "weights"):
        along = points * point
        yield Part(
            "front", both * along, f"fewer points of the front ([pareto] points), now {points}"
        )
    else:
        evaluations = pareto.evaluations
        advice = f"fewer evaluations ([pareto] evaluations, now {evaluations})"
        yield Part("front", each * evaluations, advice)
    manifolds = min(study.identifiability.models, 40) * n
    yield Part(
        "manifold", each * 3 * manifolds, "fewer equivalent models ([identifiability] models)"
    )
    yield Part("second-derivatives", each * points)
    samples = study.uncertainty.bootstrap
    if samples:
        yield Part(
            "bootstrap",
            both * samples * points * point,
            f"fewer bootstrap samples ([uncertainty] bootstrap, now {samples})",
        )
    if is_reduced(study.problem.model):
        yield Part("snapshot", each / REDUCED * (3 * p + 5))


def _points(study: Study) -> int:
    """Return how many points the front will probably have."""
    n = len(study.problem.groups)
    if n == 1:
        return 1
    if study.pareto.method not in ("nbi", "weights"):
        return study.pareto.population
    return size(n, study.pareto.points or default_points(n))


def _models(study: Study) -> int:
    """Return how many models results will probably hold, those beside the front too."""
    return _points(study) + len(study.problem.groups) + len(study.weighted) + 3


def _predictions(study: Study, each: float) -> Sequence[Part]:
    """Return the time of the predictions."""
    out = []
    models = expected_tasks(study)["predict"] / max(len(study.predictions), 1)
    for prediction in study.predictions:
        try:
            spent = max(_seconds_of(prediction, study.problem) - each, each)
        except (ModelError, InputError):
            continue
        advice = f"prediction '{prediction.name}': fewer samples, fewer draws or fewer points"
        out.append(Part("predict", models * spent, advice))
    return out


def _seconds_of(prediction: Prediction, problem: UpdatingProblem) -> float:
    """Return the seconds of a prediction of one model; of many samples, by the time of a few."""

    def timed(each: Prediction) -> float:
        complete = each.complete(problem)
        began = time.perf_counter()
        complete.evaluate(problem, problem.start, np.random.SeedSequence(0))
        return time.perf_counter() - began

    if not isinstance(prediction, Passage) or prediction.samples <= 3 * SAMPLES:
        return timed(prediction)
    # The first one imports and sets up what the others share.
    _, few, more = (timed(replace(prediction, samples=k * SAMPLES)) for k in (1, 1, 3))
    return few + max(more - few, 0.1 * few) / (2 * SAMPLES) * (prediction.samples - SAMPLES)
