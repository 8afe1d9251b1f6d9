"""Estimate of the time that a study takes, as a range, with advice on how to shorten it.

A few searches are timed, and each prediction once, with few samples: all times are those of the
processor, whatever else it does. Random starts of an edge end by the rule of the search
(`modefront.front.proposers.starts`), after as many as confirm one minimum, or those of a box that
has as many as starts cover together. All else takes searches from known models, which take from
`NEAR` of one from anywhere. ``benchmarks/honest_time.py`` measures how often the time of a run is
within the range.
"""

import time
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from threadpoolctl import threadpool_limits

from modefront.errors import InputError, ModelError
from modefront.front.search import EDGES, USUAL
from modefront.front.simplex import default_points, size
from modefront.front.subproblems import Least
from modefront.identifiability.combinations import LEAST
from modefront.models.base import full_of, is_reduced
from modefront.models.matrices import MatrixModel
from modefront.models.reduced.options import stand_in
from modefront.optim.problem import Evaluation
from modefront.optim.sqp import Solution, begin
from modefront.pairing.match import modes_needed
from modefront.predictions import Passage, Prediction
from modefront.residuals.problem import UpdatingProblem
from modefront.study.definition import Study
from modefront.uncertainty.inference import STARTS as MAXIMA
from modefront.uncertainty.sampling import DRAWS, extent
from modefront.work.progress import Span, together
from modefront.work.task import seed_sequence, uncounted

NEAR = 0.4, 2.0  # time of a search from a known model over that of one from anywhere, from and to
SHORT = 30.0  # seconds up to which no advice on a shorter run is given
STEP = 3.0, 7.0  # evaluations of a step from one draw of the posterior to the next, from and to

ENDS = 20
"""Steps to the end of a range at a model, with a slack: each takes derivatives by differences."""

TIMED, WITHIN = 8, 0.4
"""Searches that are timed at most, and seconds that usual ones may take together."""

SAMPLES = 100  # samples with which a prediction is timed, and three times as many


@dataclass(frozen=True)
class Estimate:
    """The time that a study will probably take."""

    search: float  # seconds of a search
    searches: Mapping[str, Span]  # searches of each stage that is made of them
    plan: Mapping[str, Span]  # seconds of each stage
    start: Span = (0.0, 0.0)  # seconds of the program itself, which starts, reads and writes
    advice: tuple[str, ...] = ()  # on shorter runs, on the longest part first; none for short ones

    @property
    def range(self) -> Span:
        """Seconds in all, by one process."""
        return together([together(self.plan.values()), self.start])

    @property
    def text(self) -> str:
        """The estimate in a sentence."""
        counts = (sum(ends) for ends in zip(*self.searches.values(), strict=True))
        few, many = (max(int(float(f"{count:.0e}")), 1) for count in counts)
        longest = self.plan.get("predict", (0.0, 0.0))
        times = [" to ".join(map(duration, span)) for span in (self.range, longest)]
        share = f", {times[1]} for predictions" if longest[1] > self.range[1] / 10 else ""
        return (
            f"a run takes {times[0]} of a processor: the number of minima decides "
            f"({few:,} to {many:,} searches of {duration(self.search)} each{share})"
        )


def estimate(study: Study, started: float = 0.0) -> Estimate | None:
    """Return the time that a study takes; None where the nominal model cannot be evaluated.

    ``started`` are the seconds of the processor until the study was read: a run spends them as
    well, and up to as many again on what it imports and writes.
    """
    problem = study.problem
    with uncounted(), threadpool_limits(1, user_api="blas"):
        timed = _search(study)
        if timed is None:
            return None
        search, evaluations = timed
        each, parts = search / evaluations, _parts(study, evaluations)
        advice = [(span[1] * search, text) for span, text in parts.values()]
        searches = {stage: span for stage, (span, _) in parts.items()}
        plan: dict[str, Span] = {x: (a * search, b * search) for x, (a, b) in searches.items()}
        if study.noise.of(problem, study.uncertainty.of(problem.data)) is not None:
            few, many = extent(max(DRAWS, study.uncertainty.draws))
            plan["sample-posterior"] = STEP[0] * few * each, STEP[1] * many * each
        if is_reduced(problem.model):  # snapshots of the basis, and their certificates
            began = time.process_time()
            full_of(problem.model).modes(problem.start, len(problem.data.modes))
            alone, p = time.process_time() - began, len(problem.start)
            plan["snapshot"] = alone * p, 2 * alone * (3 * p + 5)
        along = _points(study) + len(problem.groups) + len(study.weighted)
        models = along + 3 + (study.uncertainty.draws or 1 + 2 * len(problem.start))
        for prediction in study.predictions:
            try:
                spent = max(_seconds_of(prediction, problem) - each, each)
            except (ModelError, InputError):
                continue
            ends = 2 * len(prediction.kind.ranged) * len(prediction.places) * along
            steps = ENDS * ends if study.slack else 0
            spent *= models + steps * (1 + 2 * len(problem.start))
            least, most = plan.get("predict", (0.0, 0.0))
            plan["predict"] = least + spent / 2, most + 2 * spent
            text = f"prediction '{prediction.name}': fewer samples, fewer draws or fewer points"
            advice.append((2 * spent, text + ", or no slack" * (study.slack > 0)))
    out = Estimate(search, searches, plan, (started, 2 * started))
    most = together(plan.values())[1]
    if most <= SHORT:
        return out
    advice.sort(key=lambda part: -part[0])
    said = [text for seconds, text in advice if seconds > most / 4 and text]
    if problem.model.size >= 2000 and not is_reduced(problem.model):
        said.insert(0, 'a reduced basis ([model] reduction = "auto")')
    return replace(out, advice=(*said, "--workers N with as many as there are cores"))


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

    It is one for the edge of a group, from a model within the bounds.
    """
    problem = replace(study.problem, model=full_of(study.problem.model))
    n, p = len(problem.objectives), problem.start.size
    each, nominal = _seconds(problem)
    if not nominal.feasible:
        return None
    sizes = np.maximum(nominal.J, LEAST**2 * problem.properties)
    rng = np.random.default_rng(seed_sequence(study.seed, "estimate"))
    seconds, average = (USUAL + p) * each, float(USUAL + p)
    found: list[tuple[float, int]] = []
    ends: list[Solution] = []
    # How many are timed does not depend on what they take: else the last one is often the longest.
    for k in range(int(WITHIN / max(seconds, WITHIN / TIMED))):
        edge = Least(k % n, sizes, "")
        theta = rng.uniform(problem.lower, problem.upper)
        began = time.process_time()
        start = begin(problem.evaluate(theta, second=True))
        if start.feasible:
            known = min(ends, key=lambda x: float(x.J[k % n]), default=None)
            ends.append(edge.solve(problem, start, known))
            found.append((time.process_time() - began, 1 + ends[-1].evaluations))
    if found:  # by the median of an evaluation: modules are imported in some of the first ones
        spent, counts = np.array(found).T
        # One of the starts of an edge knows no model that is better, and takes longest.
        later = counts[1:].mean() if len(counts) > 1 else counts[0]
        average = float(later + study.search.doubt * (counts[0] - later))
        seconds = average * float(np.median(spent / counts))
    model = problem.model
    if is_reduced(study.problem.model) and isinstance(model, MatrixModel):
        count = modes_needed(problem.pairing, problem.data, model.size)
        seconds = average * _seconds(replace(problem, model=stand_in(model, count)))[0]
    return seconds, average


def _seconds(problem: UpdatingProblem) -> tuple[float, Evaluation]:
    """Return the seconds of an evaluation of the nominal model, and that."""
    problem.evaluate(problem.start, second=True)  # makes what others share
    began = time.process_time()
    nominal = problem.evaluate(problem.start, second=True)
    return time.process_time() - began, nominal


def _parts(study: Study, evaluations: float) -> dict[str, tuple[Span, str]]:
    """Return the searches, of so many evaluations, of each stage, and what would shorten it."""

    def near(count: float, text: str = "") -> tuple[Span, str]:
        return (count * NEAR[0], count * NEAR[1]), text

    n, pareto, points = len(study.problem.groups), study.pareto, _points(study)
    edges, budget = n + len(study.weighted) + 1, EDGES * study.search.evaluations / evaluations
    # The starts after which the rate of gains is the doubt, where none has gained, and where two.
    few, many = (max((gains + 1) / study.search.doubt - 2, 1.0) for gains in (0, 2))
    text = f"fewer evaluations of the search ([search] evaluations, now {study.search.evaluations})"
    out = {"edges": ((float(min(few * edges, budget)), float(min(many * edges, budget))), text)}
    if pareto.method in ("nbi", "weights"):
        out["front"] = near(points, f"fewer points of the front ([pareto] points), now {points}")
    else:
        count = pareto.evaluations / evaluations
        text = f"fewer evaluations ([pareto] evaluations, now {pareto.evaluations})"
        out["front"] = (count, count), text
    out["optimal-weights"] = near(edges)
    if n > 1:  # of points, where some of the front is flat
        out["identifiable"] = (0.0, points * NEAR[1]), ""
    if study.noise.weight:
        out["most-probable"] = (1.0, float(MAXIMA)), ""
    equivalent = 8 * study.identifiability.models * n / evaluations
    out["manifold"] = (0.0, equivalent), "fewer equivalent models ([identifiability] models)"
    if samples := study.uncertainty.bootstrap:
        text = f"fewer bootstrap samples ([uncertainty] bootstrap, now {samples})"
        out["bootstrap"] = near(samples * points, text)
    return out


def _points(study: Study) -> int:
    """Return how many points the front will probably have."""
    n, pareto = len(study.problem.groups), study.pareto
    if n > 1 and pareto.method not in ("nbi", "weights"):
        return pareto.population
    return size(n, pareto.points or default_points(n)) if n > 1 else 1


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
