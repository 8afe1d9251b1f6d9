"""Runs that are killed, at random moments and after each write, go on to the same digits.

    python benchmarks/kills.py [--moments 100] [--writes 1000] [--processes 100] [--workers 1 2]
                               [--studies chain ...]

Six studies (a chain, a mesh, a reduced basis, three groups, predictions, an evolutionary front) are
run once without interruption. Then runs of them, with and without workers, are killed (SIGKILL): at
``--moments`` random moments in all, each in a new folder, and after each write of a task's result,
up to ``--writes`` of each study, one run after another in the same folder. Every killed run is
continued; what is compared is

- the results: all variables, to the last digit;
- the files of the tasks that were done before: none is written again;
- processes of the killed run after it: none;
- unfinished files after the run that continues: none.

At ``--processes`` random moments, one of the processes of a run with two or three of them is killed
instead. Nobody continues that run: it has to end with the same digits on its own.

Printed is a line a study with the numbers of kills, and every difference. The exit status is 1
where there is one.
"""

from __future__ import annotations

import argparse
import os
import re
import signal
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import xarray as xr
from study_tables import PUSHED, uncertainty

import modefront.__main__
import modefront.cli.progress
import modefront.cli.show
import modefront.study.check
import modefront.study.file
import modefront.study.session
from modefront.cli.main import main as modefront_main
from modefront.study.examples import write_example

FEW = "\n[search]\ndoubt = 0.5\n"
GROUPS = re.compile(r"(?s)\[\[group\]\].*?(?=\n\[pareto\])")
THREE = """[[group]]
name = "frequencies"
frequency = "all"

[[group]]
name = "low"
shape = [1]

[[group]]
name = "high"
shape = [2, 3]
"""
PREDICTIONS = uncertainty(draws=4) + PUSHED
EVOLUTION = '[pareto]\nmethod = "nsga2"\npopulation = 20\nevaluations = 120\n'


def pareto(text: str, table: str) -> str:
    """Return a study with another table of the front."""
    return re.sub(r"\n\[pareto\][^\[]*", f"\n{table}\n", text)


STUDIES: dict[str, tuple[str, Callable[[str], str]]] = {
    "chain": ("three-story-c0", lambda text: pareto(text, "[pareto]\npoints = 5\n")),
    "mesh": ("three-story-fe-c0", lambda text: pareto(text, "[pareto]\npoints = 4\n") + FEW),
    "reduced": (
        "three-story-fe-c0",
        lambda text: (
            pareto(
                text.replace('kind = "mesh"', 'kind = "mesh"\nreduction = 1e-8'),
                "[pareto]\npoints = 4\n",
            )
            + FEW
        ),
    ),
    "three": (
        "three-story-c0",
        lambda text: pareto(GROUPS.sub(THREE, text), "[pareto]\npoints = 3\n"),
    ),
    "predictions": (
        "three-story-c0",
        lambda text: pareto(text, "[pareto]\npoints = 3\n") + PREDICTIONS,
    ),
    "evolutionary": ("three-story-c0", lambda text: pareto(text, EVOLUTION)),
}


class Forked:
    """A run of ``modefront`` in a fork of this process, which has imported all that it needs.

    A new interpreter would take longer than most of the studies here. Its processes are spawned
    by the run itself, as always.

    Attributes
    ----------
    pid : of the run, and of the group of its processes
    messages : what it has printed on standard error
    """

    def __init__(self, command: list[str], messages: Path) -> None:
        self.messages = messages
        self.status: int | None = None
        self.pid = os.fork()
        if self.pid:
            return
        os.setsid()
        for stream, path in ((1, Path(os.devnull)), (2, messages)):
            os.dup2(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600), stream)
        sys.argv = ["modefront", *command]
        sys.modules["__main__"] = modefront.__main__  # what spawned processes import
        status = 1
        try:
            modefront_main()
        except SystemExit as left:
            status = left.code if isinstance(left.code, int) else 1
        finally:  # nothing of what this process would do at its end
            os._exit(status)

    def poll(self) -> int | None:
        """Return the status, negative where a signal has ended the run; None while it goes on."""
        if self.status is None:
            pid, code = os.waitpid(self.pid, os.WNOHANG)
            self.status = os.waitstatus_to_exitcode(code) if pid else None
        return self.status

    def wait(self) -> int:
        """Return the status, when the run has ended."""
        while (status := self.poll()) is None:
            time.sleep(0.002)
        return status

    def kill(self) -> None:
        """Kill the run."""
        if self.poll() is None:
            os.kill(self.pid, signal.SIGKILL)
            self.wait()


@dataclass
class Trials:
    """Kills of the runs of one study.

    Attributes
    ----------
    study : its file
    workers : numbers of processes, in turn
    expected : results of a run that was not interrupted
    seconds, writes : that this run took, and had at its end
    kills : so far
    differences : what was not as it should be
    """

    study: Path
    workers: list[int]
    expected: xr.Dataset = field(init=False)
    seconds: float = field(init=False)
    writes: int = field(init=False)
    kills: int = 0
    differences: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        started = time.monotonic()
        folder = self.study.with_name("whole")
        self.start(folder, 1).wait()
        self.seconds = time.monotonic() - started
        self.writes = len(written(folder))
        self.expected = results(folder)

    def start(self, folder: Path, workers: int) -> Forked:
        """Start a run in a group of processes of its own."""
        command = ["run", str(self.study), "-o", str(folder), "--workers", str(workers)]
        return Forked(command, folder.with_name("messages.txt"))

    def at_a_moment(self, rng: np.random.Generator, number: int) -> None:
        """Kill a run at a random moment, and continue it."""
        folder, moment = self.study.with_name(f"moment{number}"), rng.uniform(0, self.seconds)
        workers = self.workers[number % len(self.workers)]
        process = self.start(folder, workers)
        time.sleep(moment)
        self.kill(process)
        before = written(folder)
        self.finish(folder, workers, before, f"killed after {moment:.2f} s")

    def after_writes(self, most: int) -> None:
        """Kill runs after each write, one after another in the same folder, and finish."""
        folder, count = self.study.with_name("writes"), 0
        for number in range(most):
            before = written(folder)
            workers = self.workers[number % len(self.workers)]
            process = self.start(folder, workers)
            while process.poll() is None and len(written(folder)) <= count:
                time.sleep(0.001)
            ended = process.poll() is not None
            self.kill(process)
            self.compare(folder, before, f"killed after write {count + 1}")
            count = len(written(folder))
            if ended:
                break
        self.finish(folder, self.workers[-1], written(folder), "after all writes")

    def a_process(self, rng: np.random.Generator, number: int) -> None:
        """Kill one of the processes of a run at a random moment; the run has to end well."""
        folder, moment = self.study.with_name(f"process{number}"), rng.uniform(0, self.seconds)
        process = self.start(folder, 2 + number % 2)
        time.sleep(moment)
        if computing := [pid for pid in running(process.pid) if is_spawned(pid)]:
            os.kill(int(rng.choice(computing)), signal.SIGKILL)
            self.kills += 1
        self.end(process, folder, {}, f"a process killed after {moment:.2f} s")
        self.wait_for_all(process)

    def kill(self, process: Forked) -> None:
        """Kill the process that was started, and wait for those that it has started."""
        process.kill()
        self.kills += 1
        self.wait_for_all(process)

    def wait_for_all(self, process: Forked) -> None:
        """Wait for the processes that one has started, and end those that stay."""
        for _ in range(2000):
            if not list(running(process.pid)):
                return
            time.sleep(0.01)
        self.differences.append(f"processes that were left: {list(running(process.pid))}")
        os.killpg(process.pid, signal.SIGKILL)

    def finish(self, folder: Path, workers: int, before: dict[Path, int], name: str) -> None:
        """Continue a run to its end, and compare it."""
        self.end(self.start(folder, workers), folder, before, name)

    def end(self, process: Forked, folder: Path, before: dict[Path, int], name: str) -> None:
        """Wait for the end of a run, and compare it."""
        if status := process.wait():
            self.differences.append(f"{name}: status {status}, {process.messages.read_text()}")
            return
        if not results(folder).identical(self.expected):
            self.differences.append(f"{name}: other digits")
        self.compare(folder, before, name)
        left = [str(path) for path in folder.rglob("*.tmp")]
        if left:
            self.differences.append(f"{name}: left over {left}")

    def compare(self, folder: Path, before: dict[Path, int], name: str) -> None:
        """Compare the files that were written before with those that are there."""
        now = written(folder)
        again = [
            path.name for path, position in before.items() if now.get(path, position) != position
        ]
        if again:
            self.differences.append(f"{name}: done again {again}")


def written(folder: Path) -> dict[Path, int]:
    """Return the files of tasks that are done, with the times at which they were written."""
    out = {}
    for path in folder.rglob("*.npz"):
        with suppress(OSError):
            out[path] = path.stat().st_mtime_ns
    return out


def results(folder: Path) -> xr.Dataset:
    return xr.load_dataset(folder / "results.nc", engine="h5netcdf")


def running(group: int) -> Iterator[int]:
    """Yield the processes of a group that have not ended."""
    for path in Path("/proc").glob("[0-9]*/stat"):
        with suppress(OSError):
            state, _, chosen = path.read_text().rpartition(")")[2].split()[:3]
            if int(chosen) == group and state != "Z":
                yield int(path.parent.name)


def is_spawned(pid: int) -> bool:
    """Return whether a process is one of those that compute tasks."""
    with suppress(OSError):
        return b"spawn_main" in Path(f"/proc/{pid}/cmdline").read_bytes()
    return False


def study(name: str, folder: Path) -> Path:
    """Write a study, and return its file."""
    example, edit = STUDIES[name]
    write_example(example, folder)
    path = folder / "study.toml"
    path.write_text(edit(path.read_text()))
    return path


def main() -> None:
    """Print a line a study."""
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--moments", type=int, default=100)
    options.add_argument("--writes", type=int, default=1000)
    options.add_argument("--processes", type=int, default=100)
    options.add_argument("--workers", type=int, nargs="+", default=[1, 2])
    options.add_argument("--studies", nargs="+", choices=STUDIES, default=list(STUDIES))
    options.add_argument("--seed", type=int, default=0)
    given = options.parse_args()
    rng, bad = np.random.default_rng(given.seed), False
    for i, name in enumerate(given.studies):
        with tempfile.TemporaryDirectory() as folder:
            trials = Trials(study(name, Path(folder) / name), given.workers)
            for number in range(i, given.moments, len(given.studies)):
                trials.at_a_moment(rng, number // len(given.studies))
            for number in range(i, given.processes, len(given.studies)):
                trials.a_process(rng, number // len(given.studies))
            if given.writes:
                trials.after_writes(given.writes)
        print(f"{name}: {trials.kills} kills", *trials.differences, sep="\n    ", flush=True)
        bad |= bool(trials.differences)
    sys.exit(bad)


if __name__ == "__main__":
    main()
