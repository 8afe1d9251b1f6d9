"""Estimate of the time that a study takes, as a range, with advice on how to shorten it.

A few searches are timed, and each prediction once, with few samples: all times are those of the
processor, whatever else it does. Each stage of a run takes from and to so many searches. Where a
search takes too long to be timed, its evaluations are 10, and one more for each parameter.
``benchmarks/honest_time.py`` measures how often the time of a run is within the range.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, replace

import numpy as np
from threadpoolctl import threadpool_limits

from modefront._typing import Floats
from modefront.errors import InputError, ModelError
from modefront.front.simplex import default_points, size
from modefront.models.base import full_of, is_reduced
from modefront.models.matrices import MatrixModel
from modefront.models.reduced.options import estimate as reduced_cost
from modefront.optim.scalarisation import weighted
from modefront.optim.sqp import Options, begin, solve
from modefront.predictions import Passage, Prediction
from modefront.residuals.problem import UpdatingProblem
from modefront.study.definition import Study
from modefront.uncertainty.most_probable import STARTS as MAXIMA
from modefront.uncertainty.sampling import DRAWS
from modefront.work.costs import uncounted
from modefront.work.progress import Plan, Span
from modefront.work.task import seed_sequence

EDGE = 10.0, 60.0
"""Searches for the best model of a group or of given weights, from and to."""

DRAW = 0.2, 2.5
"""Time of a draw of the posterior over that of a search, from and to."""

SHORT = 30.0
"""Seconds up to which no advice on a shorter run is given."""

TIMED, STEPS, WITHIN = 8, 3, 0.4
"""Searches that are timed, after a few steps that tell whether there is time for them; seconds
within which another one is begun."""

SAMPLES = 100
"""Samples with which a prediction is timed, and three times as many."""


@dataclass(frozen=True)
class Estimate:
    """The time that a study will probably take.

    Attributes
    ----------
    plan : what each stage of the run takes
    advice : what would make the run shorter, that of the longest part first; none for short runs
    """

    plan: Plan
    advice: tuple[str, ...] = ()

    @property
    def range(self) -> Span:
        """Seconds in all, by one process."""
        return self.plan.seconds

    @property
    def text(self) -> str:
        """The estimate in a sentence."""
        counts = (sum(ends) for ends in zip(*self.plan.searches.values(), strict=True))
        few, many = (max(int(float(f"{count:.0e}")), 1) for count in counts)
        longest = max(self.plan.other.values(), key=lambda span: span[1], default=(0.0, 0.0))
        times = [" to ".join(map(duration, span)) for span in (self.range, longest)]
        share = f", {times[1]} for predictions" if longest[1] > self.range[1] / 10 else ""
        return (
            f"a run takes {times[0]} of a processor: the number of minima decides "
            f"({few:,} to {many:,} searches of {duration(self.plan.search)} each{share})"
        )


def estimate(study: Study) -> Estimate | None:
    """Return the time that a study takes; None where the nominal model cannot be evaluated."""
    problem = study.problem
    with uncounted(), threadpool_limits(1, user_api="blas"):
        timed = _search(study)
        if timed is None:
            return None
        search, evaluations = timed
        parts = _parts(study, evaluations)
        advice = [(span[1] * search, text) for span, text in parts.values()]
        other: dict[str, Span] = {}
        if is_reduced(problem.model):  # snapshots of the basis, and their certificates
            began = time.process_time()
            full_of(problem.model).modes(problem.start, len(problem.data.modes))
            alone, p = time.process_time() - began, len(problem.start)
            other["snapshot"] = alone * p, 2 * alone * (3 * p + 5)
        models = _points(study) + len(problem.groups) + len(study.weighted) + 3
        models += study.uncertainty.draws or 1 + 2 * len(problem.start)
        for prediction in study.predictions:
            try:
                spent = _seconds_of(prediction, problem)
            except (ModelError, InputError):
                continue
            each = search / evaluations
            spent = models * max(spent - each, each)
            least, most = other.get("predict", (0.0, 0.0))
            other["predict"] = least + spent / 2, most + 2 * spent
            text = f"prediction '{prediction.name}': fewer samples, fewer draws or fewer points"
            advice.append((2 * spent, text))
    # What is known is kept and compared, and results are made: 1.4 times the searches.
    plan = Plan(1.4 * search, {stage: span for stage, (span, _) in parts.items()}, other)
    most = plan.seconds[1]
    if most <= SHORT:
        return Estimate(plan)
    advice.sort(key=lambda part: -part[0])
    said = [text for seconds, text in advice if seconds > most / 4 and text]
    if problem.model.size >= 2000 and not is_reduced(problem.model):
        said.insert(0, 'a reduced basis ([model] reduction = "auto")')
    return Estimate(plan, (*said, "--workers N with as many as there are cores"))


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


def _search(study: Study) -> tuple[float, float] | None:
    """Return the seconds and the evaluations of a search; None where there is no nominal model.

    It is one for the best model of a group, from a model within the bounds.
    """
    problem = replace(study.problem, model=full_of(study.problem.model))
    rng = np.random.default_rng(seed_sequence(study.seed, "estimate"))
    for _ in range(2):  # the first time also makes what others share
        each, count = _timed(problem, 0, problem.start, Options(iterations=STEPS))
        if not count:
            return None
    average = 10.0 + problem.start.size
    seconds = average * each / count
    found: list[tuple[float, int]] = []
    if seconds < WITHIN:
        for k in range(TIMED):
            if sum(x[0] for x in found) < WITHIN:
                found.append(_timed(problem, k, rng.uniform(problem.lower, problem.upper)))
        found = [x for x in found if x[1]]
    if found:
        seconds, average = (float(np.mean(x)) for x in zip(*found, strict=True))
    if is_reduced(study.problem.model) and isinstance(problem.model, MatrixModel):
        seconds *= reduced_cost(problem.model, len(problem.data.modes)).share
    return seconds, average


def _timed(
    problem: UpdatingProblem, group: int, theta: Floats, options: Options | None = None
) -> tuple[float, int]:
    """Return the seconds and the evaluations of a search from theta (p,); no evaluation: none."""
    began, i = time.process_time(), group % len(problem.objectives)
    try:
        start = problem.evaluate(theta, second=True)
        unit = np.eye(len(problem.objectives))[i] / (start.J[i] or 1.0)
        found = solve(problem, weighted(unit), begin(start), options)
    except ModelError:
        return 0.0, 0
    return time.process_time() - began, (1 + found.evaluations) * start.feasible


def _parts(study: Study, evaluations: float) -> dict[str, tuple[Span, str]]:
    """Return the searches, of so many evaluations, of each stage, and what would shorten it."""
    n, pareto, points = len(study.problem.groups), study.pareto, _points(study)
    edges, budget = n + len(study.weighted) + 1, study.search.evaluations / evaluations
    samples = study.uncertainty.bootstrap
    out = {
        "edges": (
            (min(EDGE[0] * edges, budget), min(EDGE[1] * edges, budget)),
            f"fewer evaluations of the search ([search] evaluations, now "
            f"{study.search.evaluations})",
        )
    }
    if pareto.method in ("nbi", "weights"):
        text = f"fewer points of the front ([pareto] points), now {points}"
        out["front"] = (points / 5, 2.0 * points), text
    else:
        text = f"fewer evaluations ([pareto] evaluations, now {pareto.evaluations})"
        out["front"] = (pareto.evaluations / evaluations, pareto.evaluations / evaluations), text
    out["optimal-weights"] = (0.0, 3.0 * edges), ""
    if study.noise.weight:
        out["most-probable"] = (1.0, float(MAXIMA)), ""
        out["sample-posterior"] = (DRAW[0] * DRAWS, DRAW[1] * DRAWS), ""
    equivalent = 8 * study.identifiability.models * n / evaluations
    out["manifold"] = (0.0, equivalent), "fewer equivalent models ([identifiability] models)"
    if samples:
        text = f"fewer bootstrap samples ([uncertainty] bootstrap, now {samples})"
        out["bootstrap"] = (samples * points / 5, float(samples * points)), text
    return out


def _points(study: Study) -> int:
    """Return how many points the front will probably have."""
    n = len(study.problem.groups)
    if n == 1:
        return 1
    if study.pareto.method not in ("nbi", "weights"):
        return study.pareto.population
    return size(n, study.pareto.points or default_points(n))


def _seconds_of(prediction: Prediction, problem: UpdatingProblem) -> float:
    """Return the seconds of a prediction of one model; of many samples, by the time of a few."""

    def timed(each: Prediction) -> float:
        complete = each.complete(problem)
        began = time.process_time()
        complete.evaluate(problem, problem.start, np.random.SeedSequence(0))
        return time.process_time() - began

    if not isinstance(prediction, Passage) or prediction.samples <= 3 * SAMPLES:
        return timed(prediction)
    # The first one imports and sets up what the others share.
    _, few, more = (timed(replace(prediction, samples=k * SAMPLES)) for k in (1, 1, 3))
    return few + max(more - few, 0.1 * few) / (2 * SAMPLES) * (prediction.samples - SAMPLES)
