r"""Edges, weighted models and points of fronts beside those of an independent optimiser.

python benchmarks/edges.py --cache FILE [--kinds chain,frame] [--seeds 0:20] [--starts N]
                           [--points N] [--data FOLDER] [--details FILE] [--study] [--only-cache]

Prints a line for every random problem of `updating_problems`:

==========  ======================================================================================
column      meaning
==========  ======================================================================================
edges       worst relative excess of an edge: of J_i over the least J_i known, and where it is as
            small or an exact fit, of the sum of the others (over their typical sizes) over the
            least known at no greater J_i, but for what a tie of J_i is worth in a minimum so flat
weighted    worst relative excess of sum w J of a weighted model; optimal weights: of the mean
            exp(sum a ln J / sum a) over the best regular minimum known, or share by which a known
            model dominates them; missing where a regular minimum is known at which the mean is
            not above that of equal weights and of the front, and none is reported
front       worst relative excess of the last J_k of a point over the least at no greater others
dominated   points called Pareto optimal that a known model dominates by more than 0.2 %
solved      eigenproblems that modefront solved
==========  ======================================================================================

and then how many problems are worse by more than 0.2 %, failures, and the eigenproblems.
``--study`` adds the whole study of a chain of 18 storeys with 4 modes. The models of the
independent optimiser are kept in the cache: only the first run of a problem is slow.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from types import FrameType

import numpy as np
import xarray as xr
from independent import (
    SEED,
    Equation,
    Known,
    Reference,
    agreement,
    better,
    dominance,
    reference,
    strict_gain,
    worth,
)
from smu import FOLDER
from updating_problems import KINDS, Case, available, chain_case, make

import modefront as mf
from modefront._typing import Floats

WORSE = 0.002
"""Relative excess of an objective above which a result is worse."""

AGREE = 1e-10
"""Difference of the two evaluations of equation (1) up to which they agree."""


@dataclass
class Line:
    """Comparison of the results of a problem; an excess is NaN where nothing is compared."""

    case: Case
    edges: dict[str, float] = field(default_factory=dict)
    weighted: dict[str, float] = field(default_factory=dict)
    front: dict[str, float] = field(default_factory=dict)
    dominated: dict[str, float] = field(default_factory=dict)
    better: list[tuple[str, float, Known]] = field(default_factory=list)
    behind: dict[str, float] = field(default_factory=dict)
    solved: int = 0
    seconds: float = 0.0
    failure: str = ""

    def worst(self, what: str) -> float:
        """Return the worst excess of a kind."""
        return max(getattr(self, what).values(), default=0.0)

    def __str__(self) -> str:
        problem = self.case.problem
        head = (
            f"{self.case.name:12s} {self.case.text:58s} p={problem.lower.size:2d} "
            f"a={'+'.join(f'{a:g}' for a in problem.properties):9s} "
        )
        if self.failure:
            return f"{head} FAILED: {self.failure}"
        numbers = " ".join(
            f"{what} {_share(self.worst(what))}" for what in ("edges", "weighted", "front")
        )
        bad = [
            f"{name}: {_share(x).strip()}"
            for what in (self.edges, self.weighted, self.front, self.dominated)
            for name, x in what.items()
            if not x <= WORSE
        ]
        return (
            f"{head} {numbers} dominated {len(self.dominated):2d} solved {self.solved:6d} "
            f"{self.seconds:5.1f} s {'; '.join(bad)}"
        )


def _share(x: float) -> str:
    return f"{x:9.1e}" if x > WORSE / 2 else "        -"


# ---- comparison ------------------------------------------------------------------------------


def compare(case: Case, data: xr.Dataset, best_known: Reference, equation: Equation) -> Line:
    """Return how much worse the results of modefront are than the best of either."""
    line = Line(case, solved=int(data.attrs["model_evaluations"]))
    labels = [str(label) for label in data["label"].values]
    theta, J = data["theta"].values, data["objective"].values
    pareto = data["pareto"].values
    computed = [
        Known(x, y, f"modefront {label}") for x, y, label in zip(theta, J, labels, strict=True)
    ]
    known = Reference([*best_known.known, *computed], best_known.sizes, best_known.a)
    for i, name in enumerate(case.problem.objectives):
        if f"edge-{name}" in labels:
            k = labels.index(f"edge-{name}")
            compare_edge(line, i, name, theta[k], J[k], known, equation)
        else:
            line.edges[f"edge-{name} missing"] = np.inf
    compare_weighted(line, labels, least_regular(data, known), J, known)
    line.behind = behind(case, dict(zip(labels, J, strict=True)), best_known)
    polished: list[Known] = []
    points = np.flatnonzero((data["kind"].values == "front") & pareto).tolist()
    for k in points:
        share, models = better(equation, J[k], theta[k], best_known.known, best_known.floor)
        polished += models
        line.front[labels[k]] = share
        if share > WORSE:
            of_range = (J[k, -1] - models[0].J[-1]) / np.ptp(J[pareto][:, -1])
            line.better.append((f"{labels[k]} ({of_range:.0e} of the range)", share, models[0]))
    everything = [*best_known.known, *polished]
    JJ = np.array([known.J for known in everything])
    for k in map(int, np.flatnonzero(pareto)):
        beaten = dominance(JJ, J[k], best_known.floor)
        if beaten.max() > WORSE:
            model = everything[int(beaten.argmax())]
            i = int(((J[k] - model.J) / np.maximum(J[k], best_known.floor)).argmax())
            share = strict_gain(equation, J[k], model, i, best_known.floor)
            if share > WORSE:
                line.dominated[f"{labels[k]}*"] = share
                line.better.append((f"{labels[k]}*", share, model))
    line.front = {name: x for name, x in line.front.items() if x > WORSE / 2}
    return line


def behind(case: Case, J: dict[str, Floats], best_known: Reference) -> dict[str, float]:
    """Return where the independent optimiser is worse than modefront by more than 0.2 %."""
    out = {}
    for i, name in enumerate(case.problem.objectives):
        chosen = J.get(f"edge-{name}")
        if chosen is not None:
            least = best_known.least(i)
            value = max(chosen[i], least)
            more = (least - chosen[i]) / max(chosen[i], best_known.floor[i])
            if value <= best_known.floor[i] or more <= WORSE:
                others = float(best_known.others(i, chosen))
                second = (
                    best_known.edge(i, max(value * (1 + WORSE), best_known.floor[i]))[0] - others
                )
                more = second / max(others, float(best_known.others(i, best_known.floor)))
            out[f"edge-{name}"] = more
    if "equal-weights" in J:
        own_sum = float(J["equal-weights"].sum())
        least = best_known.weighted(np.ones(best_known.sizes.size))[0]
        out["equal-weights"] = (least - own_sum) / max(own_sum, float(best_known.floor.max()))
    return {name: x for name, x in out.items() if x > WORSE}


def compare_edge(
    line: Line,
    i: int,
    name: str,
    theta: Floats,
    J: Floats,
    known: Reference,
    equation: Equation,
) -> None:
    """Add the excess of an edge to a line: of J_i, or of the others where that is as small."""
    label, least = f"edge-{name}", known.least(i)
    excess = (J[i] - least) / max(least, known.floor[i])
    if J[i] <= known.floor[i]:
        excess = 0.0
    if excess > WORSE:
        best = known.known[int(np.argmin(known.J[:, i]))]
        line.better.append((label, excess, best))
    others, model = known.edge(i, float(J[i]))
    chosen = float(known.others(i, J))
    floor = known.others(i, known.floor)
    second = (chosen - others) / max(others, float(floor))
    if second > WORSE:
        allowed = worth(equation, i, theta, float(model.J[i] - J[i]))
        second = max(chosen - others - allowed, 0.0) / max(others, float(floor))
    if second > WORSE:
        line.better.append((f"{label} (others)", second, model))
    line.edges[label] = max(excess, second)


def compare_weighted(
    line: Line, labels: list[str], along: float, J: Floats, known: Reference
) -> None:
    """Add the excess of each weighted model to a line; ``along`` is that of `least_regular`."""
    w = np.ones(known.sizes.size)
    if "equal-weights" in labels:
        least, model = known.weighted(w)
        value = float(J[labels.index("equal-weights")].sum())
        floor = float(known.floor.max())
        excess = (value - least) / max(least, floor)
        line.weighted["equal-weights"] = excess
        if excess > WORSE:
            line.better.append(("equal-weights", excess, model))
    else:
        line.weighted["equal-weights missing"] = np.inf
    regular = known.regular()
    if "optimal-weights" in labels:
        chosen = J[labels.index("optimal-weights")]
        share = dominance(known.J, chosen, known.floor)
        excess, model = float(share.max()), known.known[int(share.argmax())]
        value = float(known.a @ np.log(np.maximum(chosen, known.floor)))
        least = min(along, np.inf if regular is None else regular[0])
        more = float(np.expm1((value - least) / known.a.sum()))
        if more > excess:
            excess, model = more, model if regular is None else regular[1]
        line.weighted["optimal-weights"] = excess
        if excess > WORSE:
            line.better.append(("optimal-weights", excess, model))
    elif regular is not None and regular[0] <= along + 1e-6 * known.a.sum():
        line.weighted["optimal-weights missing"] = np.inf
        line.better.append(("optimal-weights missing", np.inf, regular[1]))


def least_regular(data: xr.Dataset, known: Reference) -> float:
    """Return the least sum a ln J of equal weights and of the front, if it is bounded there.

    A minimum of that sum above it is none worth the name. Toward an exact fit of a group the sum
    falls without bound; what counts there is whether a minimum is regular itself.
    """
    if (known.floor >= known.J).any():
        return np.inf
    values = [
        float(known.a @ np.log(row))
        for kind, row in zip(data["kind"].values, data["objective"].values, strict=True)
        if kind in ("front", "equal-weights") and (known.floor < row).all()
    ]
    return min(values, default=np.inf)


# ---- cache -----------------------------------------------------------------------------------


def key(case: Case, starts: int) -> str:
    """Return a digest of everything that a reference depends on."""
    data = case.problem.data
    parts = [case.stiffness.terms, case.mass.terms, data.frequency, data.shape]
    parts += [case.problem.lower, case.problem.upper]
    digest = hashlib.sha256(repr((starts, case.problem.groups)).encode())
    for part in parts:
        digest.update(
            np.ascontiguousarray(
                np.round(part / max(np.abs(part).max(), 1e-300), 6) + 0.0
            ).tobytes()
        )
    return digest.hexdigest()[:16]


@dataclass(frozen=True)
class Cache:
    """References in a file of JSON lines."""

    path: Path

    def read(self, name: str) -> Reference | None:
        """Return the reference of a digest, or None."""
        if self.path.is_file():
            for text in self.path.read_text().splitlines():
                entry = json.loads(text)
                if entry["key"] == name:
                    known = [
                        Known(np.array(known["theta"]), np.array(known["J"]), known["label"])
                        for known in entry["known"]
                    ]
                    return Reference(known, np.array(entry["sizes"]), np.array(entry["a"]))
        return None

    def write(self, name: str, case: Case, best_known: Reference) -> None:
        """Add the models of a reference that no other one dominates, and its regular minima."""
        entry = {
            "key": name,
            "case": case.name,
            "sizes": best_known.sizes.tolist(),
            "a": best_known.a.tolist(),
            "known": [
                {
                    "theta": known_point.theta.tolist(),
                    "J": known_point.J.tolist(),
                    "label": known_point.label,
                }
                for known_point in worth_keeping(best_known)
            ],
        }
        with self.path.open("a") as file:
            file.write(json.dumps(entry) + "\n")


def worth_keeping(best_known: Reference) -> list[Known]:
    """Return models that none dominates in earnest, and the logarithmic minima."""
    J, out = best_known.J, []
    seen: list[Floats] = []
    for known_point in best_known.known:
        beaten = dominance(J, known_point.J, best_known.floor).max() > 1e-7
        ratio = [
            np.abs(np.log((known_point.J + best_known.floor) / (x + best_known.floor))).max()
            for x in seen
        ]
        if known_point.label == "logarithmic" or (not beaten and min(ratio, default=1.0) > 1e-7):
            out.append(known_point)
            seen.append(known_point.J)
    return out


# ---- runs ------------------------------------------------------------------------------------


class OutOfTimeError(Exception):
    """A run takes longer than it may."""


@contextmanager
def limited(seconds: int) -> Iterator[None]:
    """Raise OutOfTimeError after some time of the processor."""

    def stop(number: int, frame: FrameType | None) -> None:
        raise OutOfTimeError(f"not done after {seconds} s")

    before = signal.signal(signal.SIGVTALRM, stop)
    signal.setitimer(signal.ITIMER_VIRTUAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
        signal.signal(signal.SIGVTALRM, before)


def measured(case: Case, best_known: Reference, points: int, limit: int) -> Line:
    """Run modefront on a problem and compare; any exception is a failure."""
    began = time.process_time()
    try:
        with limited(limit):
            data = mf.solve(
                case.problem,
                points=points,
                seed=SEED,
                identifiability=mf.Identifiability(flat=0.0, models=0),
            ).dataset
    except Exception as error:
        text = str(error).replace("\n", " ")
        return Line(case, failure=f"{type(error).__name__}: {text}")
    seconds = time.process_time() - began
    line = compare(case, data, best_known, Equation(case))
    line.seconds = seconds
    return line


def referenced(case: Case, cache: Cache, starts: int) -> Reference:
    """Return the reference of a problem, from the cache if it is there."""
    name = key(case, starts)
    best_known = cache.read(name)
    if best_known is None:
        equation = Equation(case)
        difference = agreement(equation, np.random.default_rng(1))
        if difference > AGREE:
            print(f"{case.name}: evaluations of equation (1) differ by {difference:.1e}")
        best_known = reference(equation, starts)
        cache.write(name, case, best_known)
        best_known = Reference(worth_keeping(best_known), best_known.sizes, best_known.a)
    return best_known


def study(cache: Cache, starts: int) -> str:
    """Return the costs of the whole study of 18 storeys with 4 modes, and its errors."""
    case = chain_case(18, 4, 0)
    best_known = referenced(case, cache, starts)
    began = time.process_time()
    try:
        data = mf.solve(case.problem, points=20, seed=SEED).dataset
    except mf.UnfinishedError as error:
        return f"18 storeys, 4 modes: {error}"
    line = compare(case, data, best_known, Equation(case))
    line.seconds = time.process_time() - began
    return f"{line}\n18 storeys, 4 modes: {line.solved} eigenproblems in all (limit 20000)"


def summary(lines: list[Line]) -> str:
    """Return the numbers of results that were worse or missing, and the eigenproblems."""
    done = [line for line in lines if not line.failure]
    rows = [f"{len(lines)} problems, {len(lines) - len(done)} failures"]
    for what in ("edges", "weighted", "front"):
        bad = [line.case.name for line in done if not line.worst(what) <= WORSE]
        rows.append(f"{what} worse by more than 0.2 %: {len(bad)} of {len(done)}: {' '.join(bad)}")
    behind = [f"{line.case.name}:{name}" for line in done for name in line.behind]
    rows.append(
        f"independent optimiser worse by more than 0.2 %: {len(behind)}: {' '.join(behind)}"
    )
    count = sum(len(line.dominated) for line in done)
    rows.append(f"points called Pareto optimal that are dominated by more than 0.2 %: {count}")
    if done:
        solved = [line.solved for line in done]
        rows.append(f"eigenproblems: median {np.median(solved):.0f}, greatest {max(solved)}")
    return "\n".join(rows)


def details(line: Line) -> str:
    """Return a line with the models that are better, as JSON."""
    entry = {
        "case": line.case.name,
        "failure": line.failure,
        "edges": line.edges,
        "weighted": line.weighted,
        "front": line.front,
        "dominated": line.dominated,
        "behind": line.behind,
        "solved": line.solved,
        "better": [
            {
                "than": than,
                "by": by,
                "J": point.J.tolist(),
                "theta": point.theta.tolist(),
                "from": point.label,
            }
            for than, by, point in line.better
        ],
    }
    return json.dumps(entry)


def main() -> None:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--kinds", default="chain,frame,story18,bridge,concrete")
    parser.add_argument("--seeds", default="0:20", help="first and past the last")
    parser.add_argument("--starts", type=int, default=4, help="random starts of the reference")
    parser.add_argument("--points", type=int, default=11, help="points of a front")
    parser.add_argument("--limit", type=int, default=300, help="seconds of a run of modefront")
    parser.add_argument("--data", type=Path, default=FOLDER, help="folder of published models")
    parser.add_argument("--cache", type=Path, required=True, help="file of known references")
    parser.add_argument("--details", type=Path, help="file of JSON lines to add better models to")
    parser.add_argument("--study", action="store_true", help="also the study of 18 storeys")
    parser.add_argument("--only-cache", action="store_true", help="references, not modefront")
    arguments = parser.parse_args()
    first, _, last = arguments.seeds.partition(":")
    seeds = range(int(first), int(last) if last else int(first) + 1)
    cache, lines = Cache(arguments.cache), []
    for kind in arguments.kinds.split(","):
        if kind not in KINDS:
            parser.error(f"--kinds: expected some of {', '.join(KINDS)}, found '{kind}'")
        if not available(kind, arguments.data):
            print(f"{kind}: skipped, there is no such model in {arguments.data}")
            continue
        for seed in seeds:
            case = make(kind, seed, arguments.data)
            began = time.process_time()
            best_known = referenced(case, cache, arguments.starts)
            if arguments.only_cache:
                seconds = time.process_time() - began
                print(f"{case.name}: {len(best_known.known)} models, {seconds:.1f} s", flush=True)
                continue
            lines.append(measured(case, best_known, arguments.points, arguments.limit))
            print(lines[-1], flush=True)
            if arguments.details:
                with arguments.details.open("a") as file:
                    file.write(details(lines[-1]) + "\n")
    if lines:
        print(summary(lines))
    if arguments.study:
        print(study(cache, arguments.starts))


if __name__ == "__main__":
    main()
