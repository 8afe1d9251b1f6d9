r"""Failure rates of results on random small structures, half of them of a wrong class of models.

    python benchmarks/random_structures.py --seeds 1000:1060 --cache FILE --save RESULTS.jsonl
           [--limit 120] [--again 3] [--known OTHER.jsonl ...] [--only-cache] [--quiet]
    python benchmarks/random_structures.py --cache FILE --compare OLD.jsonl NEW.jsonl
    python benchmarks/random_structures.py --seeds 0:40 --exact

Seeds 1000 to 1999 are for development. Seeds from 9000 on are for judgement: nobody tunes
anything on them, and ``--quiet`` prints their rates only. `small_structures` makes the problems.

Results are compared with the models of an independent optimiser (`independent`, from many random
starts), with those of all points that it improves, with all models of the same results, and of
those of ``--known``. Counted are, with a tolerance of 0.2 %,

=========  =======================================================================================
edge       edges whose J_i is worse than the least known, or the others at no greater J_i
weighted   weighted models that are worse in their own scalarisation, or missing
point      Pareto-optimal points of the front that a known model dominates
claimed    points called Pareto optimal that a model of the same results dominates
seed       edges that are worse than those of another seed, or better
=========  =======================================================================================

over all edges, models and points of the problems that ended within the limit of processor seconds.
``any`` are problems with one of these failures, or that did not end; ``switch`` are edges and
weighted models that are worse than a model at which pairs of modes change: the objectives are not
continuous there, and their least value may not be attained; ``behind`` are problems in which the
independent optimiser is worse. Medians and greatest values are those of the eigenproblems, the
processor seconds, the points of the front, and the share of the hypervolume of all known models
that the Pareto-optimal ones lack. ``--compare`` judges files of results by the models of all.
``--exact`` tells how often the independent optimiser finds the true models of exact data.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

import moocore
import numpy as np
import xarray as xr
from edges import (
    AGREE,
    WORSE,
    Cache,
    Line,
    behind,
    compare_edge,
    compare_weighted,
    least_regular,
    limited,
    worth_keeping,
)
from independent import (
    EXACT,
    SEED,
    Equation,
    Known,
    Reference,
    agreement,
    bounded,
    dominance,
    reference,
    strict_gain,
)
from many_starts import STARTS, at_switch, many_starts
from small_structures import Problem, make

import modefront as mf
from modefront._typing import Floats

POINTS = {2: 11, 3: 5, 4: 4, 5: 3}
"""Points along an edge of the simplex, by the number of groups."""

IMPROVED = 16
"""Points of a front, at most, that the independent optimiser tries to improve."""

COUNTED = ("edge", "weighted", "point", "claimed", "seed")
"""Failures that are counted."""


# ---- reference -------------------------------------------------------------------------------


def key(problem: Problem, equation: Equation) -> str:
    """Return a digest of the objectives at some parameters, which is one of the whole problem."""
    rng = np.random.default_rng(0)
    thetas = equation.lower + equation.span * rng.random((3, equation.span.size))
    values = [f"{x:.5e}" for theta in thetas for x in equation.J(theta)]
    return hashlib.sha256(repr((problem.case.name, STARTS, values)).encode()).hexdigest()[:16]


def referenced(problem: Problem, equation: Equation, cache: Cache) -> Reference:
    """Return the models of the independent optimiser, from the cache if they are there."""
    name = key(problem, equation)
    known = cache.read(name)
    if known is None:
        difference = agreement(equation, np.random.default_rng(1))
        if difference > 10 * AGREE:
            print(f"{problem.case.name}: evaluations of equation (1) differ by {difference:.1e}")
        known = reference(equation, given=many_starts(equation))
        cache.write(name, problem.case, known)
    return Reference(worth_keeping(known), known.sizes, known.a)


# ---- results ---------------------------------------------------------------------------------


def solved(problem: Problem, seed: int, limit: int) -> dict[str, Any]:
    """Return the results of a run as plain lists; any exception is a failure."""
    case, began = problem.case, time.process_time()
    row: dict[str, Any] = {"case": case.name, "seed": case.seed, "failure": ""}
    try:
        with limited(limit):
            data = mf.solve(case.problem, points=POINTS[problem.groups], seed=seed).dataset
    except Exception as error:
        row["failure"] = f"{type(error).__name__}: {error}".replace("\n", " ")
    row["seconds"] = time.process_time() - began
    if not row["failure"]:
        row["solved"] = int(data.attrs["model_evaluations"])
        for name in ("label", "kind", "pareto", "theta", "objective", "weight"):
            row[name] = data[name].values.tolist()
    return row


def improved(data: xr.Dataset, known: Reference, equation: Equation) -> list[Known]:
    """Return models that the independent optimiser finds from points, which dominate these."""
    of_front = (data["kind"].values == "front") & data["pareto"].values
    points = np.flatnonzero(of_front)
    points = points[np.linspace(0, points.size - 1, min(points.size, IMPROVED)).astype(int)]
    J, theta, out = data["objective"].values, data["theta"].values, []
    for k in points:
        far = np.abs(np.log((known.J + known.floor) / (J[k] + known.floor))).max(axis=1)
        for start in (theta[k], known.known[int(far.argmin())].theta):
            for last in (J.shape[1] - 1, 0):
                found = bounded(equation, last, np.maximum(J[k], known.floor), start, 40)
                value = equation.J(found)
                if np.isfinite(value).all():
                    out.append(Known(found, value, "bounded"))
    everything = Reference(out, known.sizes, known.a)
    return [x for x in worth_keeping(everything) if x.label == "bounded"] if out else []


def dataset(row: dict[str, Any]) -> xr.Dataset:
    """Return results as a dataset of the variables that are compared."""
    return xr.Dataset(
        {
            "label": ("point", np.array(row["label"])),
            "kind": ("point", np.array(row["kind"])),
            "pareto": ("point", np.array(row["pareto"], bool)),
            "theta": (("point", "parameter"), np.array(row["theta"])),
            "objective": (("point", "group"), np.array(row["objective"])),
        }
    )


def models(row: dict[str, Any], text: str) -> list[Known]:
    """Return the models of results, and those that were found from them."""
    if row["failure"]:
        return []
    of_results = zip(row["theta"], row["objective"], strict=True)
    out = [Known(np.array(theta), np.array(J), text) for theta, J in of_results]
    more = row.get("improved", ())
    return [*out, *(Known(np.array(theta), np.array(J), "bounded") for theta, J in more)]


# ---- judgement -------------------------------------------------------------------------------


@dataclass
class Verdict:
    """What is wrong with the results of a problem.

    Attributes
    ----------
    problem, row : the problem, and its results
    excess : by which share each edge, model or point is worse, for each of `COUNTED`
    behind : whether the independent optimiser is worse
    lost : share of the hypervolume of all known models that the Pareto-optimal ones lack
    switches : edges and weighted models that are worse than one at which pairs of modes change
    """

    problem: Problem
    row: dict[str, Any]
    excess: dict[str, dict[str, float]] = field(default_factory=dict)
    behind: bool = False
    lost: float = 0.0
    switches: set[str] = field(default_factory=set)

    def failed(self, what: str) -> int:
        """Return how many are worse."""
        return sum(not x <= WORSE for x in self.excess.get(what, {}).values())

    @property
    def any(self) -> bool:
        """Whether there is any failure."""
        return bool(self.row["failure"]) or any(self.failed(what) for what in COUNTED)

    def __str__(self) -> str:
        case = self.problem.case
        head = f"{case.name:16s} {case.text}, {self.problem.wrong or 'right'}"
        head = f"{head:110s} p={case.true.size:2d} n={self.problem.groups}"
        if self.row["failure"]:
            return f"{head} FAILED: {self.row['failure']}"
        bad = [
            f"{what} {name}: {x:.1e}{' (switch)' * (name in self.switches)}"
            for what in COUNTED
            for name, x in self.excess.get(what, {}).items()
            if not x <= WORSE
        ]
        count = self.row["kind"].count("front")
        numbers = f"{count:3d} points {self.row['solved']:6d} solved {self.row['seconds']:5.1f} s"
        return f"{head} {numbers} {'(behind) ' * self.behind}{'; '.join(bad)}"


def judge(
    problem: Problem, row: dict[str, Any], best: Reference, others: Sequence[Known] = ()
) -> Verdict:
    """Return what is wrong with results, by a reference, all models of theirs, and others."""
    out, equation = Verdict(problem, row), Equation(problem.case)
    if row["failure"]:
        return out
    data, names = dataset(row), problem.case.problem.objectives
    known = Reference([*best.known, *models(row, "results"), *others], best.sizes, best.a)
    labels, J, theta = list(row["label"]), data["objective"].values, data["theta"].values
    line = Line(problem.case)
    for i, name in enumerate(names):
        label = f"edge-{name}"
        if label in labels:
            k = labels.index(label)
            compare_edge(line, i, name, theta[k], J[k], known, equation)
        else:
            line.edges[f"{label} missing"] = np.inf
    compare_weighted(line, labels, least_regular(data, known), J, known)
    out.excess |= {"edge": line.edges, "weighted": line.weighted}
    for label, _, model in line.better:
        w = 1 / best.sizes
        if label.startswith("edge-"):
            w = (
                w
                * np.eye(w.size)[names.index(label.removeprefix("edge-").removesuffix(" (others)"))]
            )
        if at_switch(equation, w, model.theta):
            out.switches.add(label.removesuffix(" (others)"))
    out.behind = bool(behind(problem.case, dict(zip(labels, J, strict=True)), best))
    own = [Known(x, y, "results") for x, y in zip(theta, J, strict=True)]
    optimal = np.flatnonzero(data["pareto"].values)
    of_front = [int(k) for k in optimal if row["kind"][k] == "front"]
    out.excess["point"] = {
        labels[k]: _dominated(J[k], known.known, known.floor, equation) for k in of_front
    }
    out.excess["claimed"] = {
        labels[k]: _dominated(J[k], own, known.floor, equation) for k in map(int, optimal)
    }
    out.lost = _lost(J[optimal], known.J)
    if row.get("again") and not row["again"]["failure"]:
        out.excess["seed"] = _seeds(problem, row, row["again"], best, equation)
    return out


def _dominated(J: Floats, known: Sequence[Known], floor: Floats, equation: Equation) -> float:
    """Return by which share a known model is better in an objective and worse in none."""
    beaten = dominance(np.array([x.J for x in known]), J, floor)
    if beaten.max() <= WORSE:
        return float(beaten.max())
    model = known[int(beaten.argmax())]
    k = int(((J - model.J) / np.maximum(J, floor)).argmax())
    return strict_gain(equation, J, model, k, floor)


def _lost(J: Floats, known: Floats) -> float:
    """Return the share of the hypervolume of known models that points lack.

    Its corner is 1.1 times the greatest objectives of those that none dominates.
    """
    best = known[moocore.is_nondominated(known)]
    corner = 1.1 * np.maximum(best.max(axis=0), np.finfo(float).tiny)
    whole = moocore.hypervolume(known / corner, ref=np.ones(corner.size))
    return float(1 - moocore.hypervolume(J / corner, ref=np.ones(corner.size)) / whole)


def _seeds(
    problem: Problem, row: dict[str, Any], other: dict[str, Any], best: Reference, eq: Equation
) -> dict[str, float]:
    """Return by how much edges of two seeds differ: the excess of each over the better one.

    Of three groups or more, what the best in the others is depends on their typical sizes, which
    may be drawn anew with a seed: there, an edge is worse than one that dominates it.
    """
    out = {}
    for i, name in enumerate(problem.case.problem.objectives):
        label = f"edge-{name}"
        if label not in row["label"] or label not in other["label"]:
            out[label] = np.inf
            continue
        pair = []
        for each in (row, other):
            k = each["label"].index(label)
            pair.append(Known(np.array(each["theta"][k]), np.array(each["objective"][k]), label))
        known, excess = Reference(pair, best.sizes, best.a), []
        for mine in pair:
            if best.sizes.size == 2:
                line = Line(problem.case)
                compare_edge(line, i, name, mine.theta, mine.J, known, eq)
                excess.append(line.edges[label])
            else:
                value, floor = max(mine.J[i], known.floor[i]), max(known.least(i), known.floor[i])
                excess.append(value / floor - 1)
                excess.append(_dominated(mine.J, pair, known.floor, eq))
        out[label] = max(excess)
    return out


# ---- rates -----------------------------------------------------------------------------------


def _is_of(kind: str, verdict: Verdict) -> bool:
    return verdict.problem.kind == kind


def table(runs: dict[str, list[Verdict]]) -> str:
    """Return the rates of failures by class and in total, one line a run; then the costs."""
    first = next(iter(runs.values()))
    head = f"{'':14s} {'':8s} {'problems':>8s} {'not done':>8s} {'any':>5s}"
    rows = [head + "".join(f"{what:>15s}" for what in COUNTED) + f"{'switch':>8s}{'behind':>8s}"]
    chosen: list[tuple[str, Callable[[Verdict], bool]]] = [
        (kind, partial(_is_of, kind)) for kind in dict.fromkeys(v.problem.kind for v in first)
    ]
    chosen += [
        ("right class", lambda v: not v.problem.wrong),
        ("wrong class", lambda v: bool(v.problem.wrong)),
        ("all", lambda v: v.problem.groups > 0),
    ]
    for name, condition in chosen:
        for label, verdicts in runs.items():
            rows.append(f"{name:14s} {label:8s} " + _rates([v for v in verdicts if condition(v)]))
    rows.append("medians and greatest")
    for n in sorted({v.problem.groups for v in first}):
        for label, verdicts in runs.items():
            of_n = [v for v in verdicts if v.problem.groups == n]
            rows.append(f"{n} groups       {label:8s} " + _costs(of_n))
    return "\n".join(rows)


def _rates(verdicts: Sequence[Verdict]) -> str:
    done = [v for v in verdicts if not v.row["failure"]]
    out = f"{len(verdicts):8d} {len(verdicts) - len(done):8d} {sum(v.any for v in verdicts):5d}"
    for what in COUNTED:
        count = sum(len(v.excess.get(what, {})) for v in done)
        bad = sum(v.failed(what) for v in done)
        text = f"{bad}/{count} {100 * bad / count:.1f}%" if count else "-"
        out += f"{text:>15s}"
    return out + f"{sum(len(v.switches) for v in done):8d}{sum(v.behind for v in done):8d}"


def _costs(verdicts: Sequence[Verdict]) -> str:
    done = [v for v in verdicts if not v.row["failure"]]
    out = f"{len(done)} of {len(verdicts)} done"
    if done:
        for name, values in (
            ("evaluations", [v.row["solved"] for v in done]),
            ("seconds", [v.row["seconds"] for v in done]),
            ("points", [v.row["kind"].count("front") for v in done]),
            ("hypervolume lost %", [100 * v.lost for v in done]),
        ):
            out += f", {name} {np.median(values):.4g} / {max(values):.4g}"
    return out


# ---- the benchmark ---------------------------------------------------------------------------


def read(path: Path) -> dict[int, dict[str, Any]]:
    """Return the results in a file of JSON lines, by the seed of their problem."""
    rows = [json.loads(text) for text in path.read_text().splitlines()] if path.is_file() else []
    return {row["seed"]: row for row in rows}


def compared(paths: Sequence[Path], cache: Cache, quiet: bool) -> str:
    """Return the rates of several files of results, each judged by the models of all.

    Problems that are not in all files are left out. Prints the failures unless ``quiet``.
    """
    files = [read(path) for path in paths]
    runs: dict[str, list[Verdict]] = {path.stem[:8]: [] for path in paths}
    for seed in sorted(set.intersection(*(set(file) for file in files))):
        problem = make(seed)
        best = referenced(problem, Equation(problem.case), cache)
        everything = [known for file in files for known in models(file[seed], "results")]
        for label, file in zip(runs, files, strict=True):
            runs[label].append(judge(problem, file[seed], best, everything))
            if runs[label][-1].any and not quiet:
                print(f"{label:8s} {runs[label][-1]}", flush=True)
    return table(runs)


def measured(problem: Problem, best: Reference, limit: int, again: bool) -> dict[str, Any]:
    """Return the results of a problem, and those of another seed where they are wanted."""
    row = solved(problem, SEED, limit)
    if not row["failure"]:
        found = improved(dataset(row), best, Equation(problem.case))
        row["improved"] = [(x.theta.tolist(), x.J.tolist()) for x in found]
        if again:
            row["again"] = solved(problem, SEED + 1, limit)
    return row


def exact(seeds: range) -> str:
    """Return how often the independent optimiser finds true models; it is not told what they are.

    Also counted are the groups of which no model fits exactly.
    """
    found = missed = 0
    for seed in seeds:
        problem, began = make(seed, exact=True), time.process_time()
        equation = Equation(problem.case)
        floor = EXACT * equation.sizes
        if (equation.J(problem.case.true) > floor).any():
            print(f"{problem.case.name}: the true model does not fit exact data")
        J = np.array([equation.J(theta) for theta in many_starts(equation)])
        all_fit = bool((floor >= J).all(axis=1).any())
        each = int((floor >= J.min(axis=0)).sum())
        found, missed = found + all_fit, missed + J.shape[1] - each
        seconds = time.process_time() - began
        text = f"{problem.case.name:16s} all groups {all_fit!s:5s} edges {each}/{J.shape[1]}"
        print(f"{text} {equation.evaluations} evaluations {seconds:.1f} s", flush=True)
    return f"{found} of {len(seeds)} truths found, {missed} edges that do not fit exactly"


def main() -> None:
    """Run the benchmark, or compare results."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--seeds", default="1000:1060", help="first and past the last")
    parser.add_argument("--cache", type=Path, default=Path("random-structures.cache"))
    parser.add_argument("--save", type=Path, help="file of JSON lines; what is there is not redone")
    parser.add_argument("--limit", type=int, default=120, help="processor seconds of a run")
    parser.add_argument("--again", type=int, default=3, help="every n-th with another seed, too")
    parser.add_argument("--known", type=Path, nargs="*", default=[], help="other results")
    parser.add_argument("--quiet", action="store_true", help="rates only")
    parser.add_argument("--only-cache", action="store_true", help="references only")
    parser.add_argument("--compare", type=Path, nargs="+", help="files of results to compare")
    parser.add_argument("--exact", action="store_true", help="check the independent optimiser")
    given = parser.parse_args()
    cache, seeds = Cache(given.cache), range(*map(int, given.seeds.split(":")))
    if given.compare:
        print(compared(given.compare, cache, given.quiet))
        return
    if given.exact:
        print(exact(seeds))
        return
    done = read(given.save) if given.save else {}
    others = [read(path) for path in given.known]
    verdicts = []
    for seed in seeds:
        problem, began = make(seed), time.process_time()
        best = referenced(problem, Equation(problem.case), cache)
        if given.only_cache:
            spent = time.process_time() - began
            print(f"{problem.case.name:16s} {len(best.known):4d} models {spent:5.1f} s", flush=True)
            continue
        row = done.get(seed)
        if row is None:
            again = given.again > 0 and seed % given.again == 0
            row = measured(problem, best, given.limit, again)
            if given.save:
                with given.save.open("a") as file:
                    file.write(json.dumps(row) + "\n")
        more = [x for file in others if seed in file for x in models(file[seed], "results")]
        verdicts.append(judge(problem, row, best, more))
        if not given.quiet:
            print(verdicts[-1], flush=True)
    if verdicts:
        print(table({given.save.stem[:8] if given.save else "": verdicts}))


if __name__ == "__main__":
    main()
