"""Gain of several processes over one, in one run.

    python benchmarks/workers.py [--workers 2] [--studies building footbridge] [--plain]

Studies of a building (576 degrees of freedom, all solved in full) and of a footbridge (2,000, in a
reduced basis where the cost model takes one) are done by one process and then by several, with a
bootstrap, posterior draws and predictions, or without (``--plain``). Printed are the elapsed
seconds of both and their ratio, for each stage of the work that takes a second at least and for the
whole, with the start of the processes while the study is made or read, but without that of the
program; and what a task costs that does nothing, in milliseconds. Results are compared to the last
digit.

Where other programs use the cores, elapsed seconds say nothing. So printed are processor seconds as
well: of one process alone, and of the first process and each other one where there are several;
and the ratio as it would be if the first and the busiest other one never worked at the same time.
"""

from __future__ import annotations

import argparse
import multiprocessing
import os
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any, Literal

import numpy as np
from study_tables import PUSHED, uncertainty
from threadpoolctl import threadpool_limits

import modefront as mf
import modefront.__main__
from modefront import fem
from modefront.models.mesh import mesh_model
from modefront.study import session
from modefront.study.examples import write_example
from modefront.work.store import Run
from modefront.work.task import R, Task
from modefront.work.workers import backend

STEEL = fem.Material(E=210e9, nu=0.3, rho=7850.0)
MORE = uncertainty(draws=24, bootstrap=12, source="sets") + PUSHED


@dataclass
class Timed(Run):
    """A run that adds up the time of its stages."""

    seconds: dict[str, float] = field(default_factory=dict)

    def run(self, tasks: Sequence[Task[R]], /) -> list[R]:
        """Return the results of the tasks."""
        started = time.perf_counter()
        results = super().run(tasks)
        if tasks:
            stage = tasks[0].stage
            passed = time.perf_counter() - started
            self.seconds[stage] = self.seconds.get(stage, 0.0) + passed
        return results


def building(folder: Path) -> mf.Study:
    """Return the three-story building, with a second data set."""
    write_example("three-story-fe-c0", folder)
    data = (folder / "modes.csv").read_text().splitlines()
    rows = [line.split(",") for line in data[1:] if line.strip()]
    again = [["2", r[1], str(float(r[2]) * 1.003), *r[3:]] for r in rows if r[0] == rows[0][0]]
    (folder / "modes.csv").write_text("\n".join([*data, *map(",".join, again)]) + "\n")
    path = folder / "study.toml"
    text = path.read_text().replace('kind = "mesh"', 'kind = "mesh"\nreduction = "off"')
    path.write_text(text + MORE)
    return mf.load(path)


def footbridge(_: Path) -> mf.Study:
    """Return a footbridge of shells of 2,000 degrees of freedom, 5 parameters and 6 modes."""
    return mf.Study(
        footbridge_problem(),
        pareto=mf.Pareto(points=20),
        seed=1,
        uncertainty=mf.Uncertainty(source="sets", bootstrap=12, draws=24),
        predictions=[mf.PeakResponse("walked", ["s20"], force="s20", damping=0.01)],
    )


def footbridge_problem(reduction: float | Literal["auto", "off"] = "auto") -> mf.UpdatingProblem:
    """Return the problem of fitting two data sets of a footbridge."""
    X, cells = fem.grids.plate(20.0, 2.5, 54, 5)
    X[:, 2] = 0.4 * np.sin(np.pi * X[:, 0] / 20.0)
    part = np.minimum((X[cells].mean(axis=1)[:, 0] / 4.0).astype(int), 4)
    names = [f"E{j + 1}" for j in range(5)]
    ends = np.flatnonzero((X[:, 0] == 0) | (X[:, 0] == X[:, 0].max()))
    places = np.linspace(0, len(X) - 1, 42).astype(int)[1:-1]
    structure = fem.Structure(
        X,
        [fem.Shells(name, cells[part == j], STEEL, 0.12) for j, name in enumerate(names)],
        [fem.Support(ends, ("x", "y", "z"))],
        sensors=[fem.Sensor(f"s{i}", int(node), "z") for i, node in enumerate(places)],
        parameters=[fem.Parameter(name, "E", (name,)) for name in names],
    )
    model = mesh_model(structure, names)
    rng = np.random.default_rng(0)
    modes = model.modes(rng.uniform(0.7, 1.4, 5), 6, derivatives=False)
    frequency = modes.frequency * (1 + 0.005 * rng.standard_normal((2, 6)))
    phi = modes.phi.T * (1 + 0.03 * rng.standard_normal((2, *modes.phi.T.shape)))
    data = mf.modal_data(frequency, phi, model.sensors)
    groups = [mf.Group("frequencies", frequency="all"), mf.Group("shapes", shape="all")]
    bounds = dict.fromkeys(names, (0.4, 2.5))
    nominal = dict.fromkeys(names, 1.0)
    return mf.updating_problem(
        model, data, groups, bounds, nominal, reduction=mf.Reduction(reduction)
    )


STUDIES = {"building": building, "footbridge": footbridge}


def study(name: str, folder: Path, plain: bool) -> mf.Study:
    """Return a study, without bootstrap, draws and predictions if it is to be plain."""
    out = STUDIES[name](folder)
    if not plain:
        return out
    return replace(out, uncertainty=mf.Uncertainty(source="sets"), predictions=())


def done(make: Callable[[], mf.Study], workers: int) -> tuple[Any, dict[str, float], list[float]]:
    """Return the results of a study, and the elapsed seconds of its stages and of the whole.

    Returned as well are the processor seconds of the first process and of each other one. The study
    is made while processes start, as the command does.
    """
    before = set(multiprocessing.active_children())
    started, first = time.perf_counter(), time.process_time()
    with backend(workers) as carrier, threadpool_limits(1, user_api="blas"):
        work = Timed(backend=carrier)
        data = session.worked(make().completed(), work)
        others = set(multiprocessing.active_children()) - before
        busy = [time.process_time() - first, *(processor_seconds(each.pid) for each in others)]
    return data, work.seconds | {"whole study": time.perf_counter() - started}, busy


def processor_seconds(process: int | None) -> float:
    """Return the processor time that a process has taken so far, 0 where that is not known."""
    try:
        fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return 0.0
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def overhead(workers: int) -> float:
    """Return the seconds that a task costs that does nothing."""
    with backend(workers) as carrier:
        assert carrier.pool is not None
        while not carrier.pool.ready:
            time.sleep(0.01)
        tasks = [Task(("nothing", k), time.sleep, (0.02,)) for k in range(100)]
        started = time.perf_counter()
        Run(backend=carrier).run(tasks)
        return (time.perf_counter() - started) / 100 - 0.02 / workers


def main() -> None:
    """Print a table a study."""
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--workers", type=int, default=2)
    options.add_argument("--studies", nargs="+", choices=STUDIES, default=list(STUDIES))
    options.add_argument("--plain", action="store_true")
    given = options.parse_args()
    sys.modules["__main__"] = modefront.__main__  # what processes of the command import
    print(f"a task: {1e3 * overhead(given.workers):.2f} ms")
    for name in given.studies:
        with tempfile.TemporaryDirectory() as folder:
            make = partial(study, name, plain=given.plain)
            serial, alone, (whole,) = done(partial(make, Path(folder) / "one"), 1)
            several = partial(make, Path(folder) / "several")
            many, shared, (first, *others) = done(several, given.workers)
        print(f"{name}: same digits {serial.identical(many)}")
        each = " ".join(f"{seconds:.2f}" for seconds in others)
        print(
            f"  processor seconds {whole:.2f}; {first:.2f} in the first process and {each} in "
            f"others; bound {whole / (first + max(others)):.2f}"
        )
        for stage, seconds in alone.items():
            if seconds >= 1:
                print(
                    f"  {stage:20s} {seconds:7.2f} s {shared[stage]:7.2f} s"
                    f"  ratio {seconds / shared[stage]:.2f}",
                    flush=True,
                )


if __name__ == "__main__":
    main()
