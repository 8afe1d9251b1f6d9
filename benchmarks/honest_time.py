r"""Whether the time that is foretold of a run, before it and during it, is the time that it takes.

    python benchmarks/honest_time.py --seeds 0:20 --save TIMES.jsonl [--limit 600]
    python benchmarks/honest_time.py --judge TIMES.jsonl

Seeds below 1000 are for development; those from 1000 on are for judgement, and run once. A seed
makes a small study: two of three are those of `small_structures` with 2 or 3 groups and at most 12
parameters (trusses, towers, grillages, buildings, beams, chains), the others lattices of 64 to 324
degrees of freedom, half of which may be solved in a reduced basis. Points of the front, the budget
of the search, predictions and samples of the bootstrap are drawn as well.

Every study has a process of its own, as the command has, whose start counts: `check` and `run` know
how long it took until the study was read. Times are those of the processor, whatever else the
machine does: all clocks of the process are. A line a study has

- the range that ``check`` foretells, the time that the run took, and whether that is in the range;
- ``shown``: how many of the times that progress shows after the first tenth of the run are right,
  where those of the last second are left out. They are read after every task and just before the
  next one, as in a terminal. A range is right if it contains the true time;
- ``silent``: the share of the run after its first tenth in which progress shows no time.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import signal
import time
from pathlib import Path
from typing import Any

import numpy as np
from small_structures import make

import modefront as mf
from modefront.study.estimate import estimate
from modefront.work.progress import Progress, Span, State

FIRST, LAST = 0.1, 1.0
"""Share of a run, and seconds before its end, in which the time that is shown is not judged."""


def lattice(seed: int, rng: np.random.Generator) -> mf.UpdatingProblem:
    """Return the problem of a net of springs, held along one side, with noise in its data."""
    nx, ny = rng.integers(8, 19 if seed % 2 else 13, 2)
    p, count, N = int(rng.integers(2, 13)), int(rng.integers(3, 7)), int(nx * ny)
    number = np.arange(N).reshape(nx, ny)
    pairs = np.concatenate(
        [np.stack([number[:-1], number[1:]], -1).reshape(-1, 2),
         np.stack([number[:, :-1], number[:, 1:]], -1).reshape(-1, 2)]
    )  # fmt: skip
    region = np.minimum(pairs.mean(axis=1) * p / N, p - 1).astype(int)
    terms = {"base": np.zeros((N, N))}
    for j in range(p):
        K = np.zeros((N, N))
        for a, b in pairs[region == j]:
            K[np.ix_([a, b], [a, b])] += 1e3 * np.array([[1.0, -1.0], [-1.0, 1.0]])
        terms[f"k{j + 1}"] = K
    terms["base"][number[0], number[0]] = 1e4
    names = tuple(f"k{j + 1}" for j in range(p))
    seen = rng.choice(N, int(rng.integers(6, 13)), replace=False)
    places = {f"s{i + 1}": int(n) for i, n in enumerate(seen)}
    model = mf.matrices(names, terms, {"base": np.eye(N)}, places)
    true = np.exp(0.25 * rng.normal(size=p))
    modes = model.modes(true, count, derivatives=False)
    f = modes.frequency[:count] * (1 + 0.005 * rng.normal(size=count))
    shapes = modes.phi[:, :count].T
    shapes = shapes * (1 + 0.03 * rng.normal(size=shapes.shape))
    groups = [mf.Group("frequencies", frequency="all"), mf.Group("shapes", shape="all")]
    data = mf.modal_data(f, shapes, model.sensors)
    parameters = [mf.Parameter(name, 1.0, (0.3, 3.0)) for name in names]
    reduction = mf.Reduction("auto" if seed % 2 else "off")
    return mf.updating_problem(model, data, groups, parameters=parameters, reduction=reduction)


def drawn(seed: int) -> mf.Study:
    """Return the study of a seed."""
    rng = np.random.default_rng([2036, seed])
    if seed % 3 == 2:
        problem = lattice(seed // 3, rng)
    else:
        numbers = iter(range(40_000 + 100 * seed, 10**9))
        problem = next(
            x.case.problem
            for x in map(make, numbers)
            if x.groups < 4 and 2 <= x.case.true.size <= 12
        )
    known = mf.Uncertainty().of(problem.data) is not None
    bootstrap = 20 if known and rng.random() < 0.3 else 0
    force = problem.data.sensors[0]
    peak = mf.PeakResponse(name="push", force=force, response=[force], damping=0.02)
    return mf.Study(
        problem,
        seed=seed,
        name=f"study {seed}",
        pareto=mf.Pareto(points=int(rng.integers(4, 16 if len(problem.groups) < 3 else 6))),
        search=mf.Search(evaluations=int(rng.choice([1000, 3000, 8000]))),
        uncertainty=mf.Uncertainty(bootstrap=bootstrap),
        predictions=[peak] if seed % 3 == 2 and rng.random() < 0.5 else [],
    )


def measured(seed: int, limit: int) -> dict[str, Any]:
    """Return what is foretold of a study and what it takes."""
    time.perf_counter = time.process_time  # tasks, and searches that are timed
    study = drawn(seed)
    problem = study.problem
    row: dict[str, Any] = {
        "seed": seed, "size": problem.model.size, "p": len(problem.start),
        "n": len(problem.groups), "budget": study.search.evaluations, "failure": "",
    }  # fmt: skip
    started = time.process_time()
    expected = estimate(study, started)
    assert expected is not None
    row |= {"range": [*expected.range], "text": expected.text}
    notes: list[tuple[float, str, Span | None, int]] = []

    def note(state: State) -> None:
        solved = progress.spent.model_evaluations
        notes.append((time.process_time(), state.stage, state.left, solved))

    signal.signal(signal.SIGVTALRM, signal.default_int_handler)
    signal.setitimer(signal.ITIMER_VIRTUAL, limit)
    progress = Progress(note, plan=expected.plan)
    began = time.process_time()
    try:
        mf.run(study, progress=progress)
    except KeyboardInterrupt:
        row["failure"] = f"more than {limit} s"
    except (mf.InputError, mf.UnfinishedError) as error:
        row["failure"] = str(error)
    signal.setitimer(signal.ITIMER_VIRTUAL, 0)
    row["seconds"] = time.process_time() - began + started
    row["solved"] = progress.spent.model_evaluations
    row["notes"] = [(at - began + started, *rest) for at, *rest in notes]
    return row


def shown(row: dict[str, Any]) -> tuple[int, int, float]:
    """Return how many shown times are right, of how many, and the share of silence."""
    total, notes = row["seconds"], row["notes"]
    right = count = 0
    silent = 0.0
    ends = [*(at for at, *_ in notes[1:]), total][: len(notes)]
    for (at, _, left, _), end in zip(notes, ends, strict=True):
        if end < FIRST * total:
            continue
        if left is None:
            silent += end - max(at, FIRST * total)
            continue
        low, high = left
        for moment in {at, end}:
            true = total - moment
            if moment >= FIRST * total and true > LAST:
                since = moment - at
                count += 1
                right += max(low - since, 0) <= true <= max(high - since, 0)
    return right, count, silent / ((1 - FIRST) * total or 1.0)


def say(row: dict[str, Any]) -> None:
    """Print the line of a study."""
    low, high = row["range"]
    right, count, silent = shown(row)
    kept = "kept" if low <= row["seconds"] <= high else "BROKEN"
    print(
        f"{row['seed']:5d} N={row['size']:4d} p={row['p']:2d} n={row['n']} "
        f"budget={row['budget']:5d} {row['solved']:6d} solved {row['seconds']:6.1f} s, "
        f"foretold {low:6.1f} to {high:6.1f} ({high / low:4.1f}) {kept:6s} "
        f"shown {right}/{count}, silent {silent:.2f} {row['failure']}",
        flush=True,
    )


def summary(rows: list[dict[str, Any]]) -> None:
    """Print how many studies keep to what is foretold."""
    done = [row for row in rows if not row["failure"]]
    kept = sum(row["range"][0] <= row["seconds"] <= row["range"][1] for row in done)
    ratio = np.median([row["range"][1] / row["range"][0] for row in done])
    counts = np.array([shown(row)[:2] for row in done])
    share = np.array([a / b for a, b in counts if b])
    print(f"{kept} of {len(done)} ranges are kept; they span a factor of {ratio:.1f} (median)")
    print(
        f"{counts[:, 0].sum()} of {counts[:, 1].sum()} times shown are right; in "
        f"{(share >= 0.9).sum()} of {share.size} studies nine of ten are"
    )


def main() -> None:
    """Measure studies, or judge what was measured."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", default="0:20")
    parser.add_argument("--save", type=Path)
    parser.add_argument("--limit", type=int, default=600)
    parser.add_argument("--judge", type=Path)
    given = parser.parse_args()
    rows: list[dict[str, Any]] = []
    if given.judge:
        rows = [json.loads(line) for line in given.judge.read_text().splitlines()]
        for row in rows:
            say(row)
    else:
        spawn = multiprocessing.get_context("spawn")
        for seed in range(*map(int, given.seeds.split(":"))):
            with spawn.Pool(1) as pool:
                rows.append(pool.apply(measured, (seed, given.limit)))
            say(rows[-1])
            if given.save:
                with given.save.open("a") as file:
                    file.write(json.dumps(rows[-1]) + "\n")
    summary(rows)


if __name__ == "__main__":
    main()
