"""Trials: inputs that are spoilt by chance, results that are damaged, runs that are disturbed.

    python tests/trials/trials.py --inputs 10000 --kills 100 --faults 100 --seed 1 \
        --interleavings 10000

prints how each of them ended, and what did not end as it should, with its seed.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import select
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import h5py
import numpy as np
import xarray as xr

if TYPE_CHECKING:
    from sources import Case

HERE = Path(__file__).resolve().parent

SECONDS = 180.0
"""Time that a command may take."""

LINES, CHARACTERS = 20, 2000
"""Length of a message, at most."""

OFTEN = 100
"""Inputs after which is said how many were tried."""

Answer = tuple[int, str, str, int] | str
"""Status, output, message and length of the message, or how the process ended."""


@dataclass
class Outcome:
    """How commands ended, by status, and what was wrong, with the number of the input."""

    ends: Counter[str] = field(default_factory=Counter)
    wrong: list[str] = field(default_factory=list)

    def take(self, what: str, answer: Answer) -> None:
        """Count the end of a command, and what is wrong with it."""
        if text := fault(answer):
            self.wrong.append(f"{what}: {text[:600]}")
        self.ends[f"exit {answer[0]}" if not isinstance(answer, str) else "no answer"] += 1


class Worker:
    """A process that runs commands in a folder; it is started again where it has ended."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.process: subprocess.Popen[str] | None = None

    def ask(self, arguments: Sequence[str]) -> Answer:
        """Return how a command ended."""
        if self.process is None or self.process.poll() is not None:
            command = [sys.executable, str(HERE / "worker.py")]
            self.process = subprocess.Popen(
                command, cwd=self.folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
            )
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        self.process.stdin.write(json.dumps(arguments) + "\n")
        self.process.stdin.flush()
        if not select.select([self.process.stdout], [], [], SECONDS)[0]:
            self.stop()
            return f"no answer within {SECONDS:g} s"
        line = self.process.stdout.readline()
        if not line:
            return f"the process ended with {self.process.wait()}"
        status, out, err, length = json.loads(line)
        return status, out, err, length

    def stop(self) -> None:
        """End the process."""
        if self.process is not None:
            self.process.kill()
            self.process.communicate()


def fault(answer: Answer) -> str:
    """Return what is wrong with the end of a command; nothing where it is as it should be."""
    if isinstance(answer, str):
        return answer
    status, out, err, length = answer
    if status not in (0, 1, 2):
        return f"status {status}: {err}"
    if status and not err:
        return f"status {status} without a message"
    if "error of the program itself" in err or "Traceback" in err:
        return err
    message = [line for line in err.split("\n") if not line.startswith("warning")]
    if status and (length > CHARACTERS + 100 or len(message) > LINES + 1):
        return f"a message of {length} characters, {len(message)} lines: {err}"
    if not all(line.isprintable() for line in (out + err).split("\n")):
        return "orders to the terminal"
    return "" if "Errno" not in err else err


def fuzz(folder: Path, cases: Sequence[Case], inputs: int, seed: int) -> Outcome:
    """Spoil files of every format in turn, and run the command that reads each of them."""
    from mutations import mutated

    outcome, worker = Outcome(), Worker(folder)
    results = folder / "results"
    shutil.copytree(results, folder / "kept")
    for number in range(inputs):
        case = cases[number % len(cases)]
        path = folder / case.file
        content = path.read_bytes()
        path.write_bytes(mutated(content, np.random.default_rng([seed, number])))
        outcome.take(f"seed {seed}, input {number}, {case.file}", worker.ask(case.command))
        path.unlink(missing_ok=True)
        path.write_bytes(content)
        if case.written:
            _remove(folder / case.written)
        if case.command[0] == "run":
            _remove(results)
            shutil.copytree(folder / "kept", results)
        if (number + 1) % OFTEN == 0:
            print(f"{number + 1} inputs, {len(outcome.wrong)} wrong", file=sys.stderr, flush=True)
    worker.stop()
    return outcome


def damaged(folder: Path, commands: Sequence[Sequence[str]], every: int, seed: int) -> Outcome:
    """Damage results in every way, each ``every``-th of them, and run commands on them in turn."""
    from damage import damages

    outcome, worker = Outcome(), Worker(folder)
    path = folder / "results" / "results.nc"
    with xr.open_dataset(path, engine="h5netcdf") as data:
        whole = data.load()
    for number, (what, changed) in enumerate(damages(whole)):
        if (number + seed) % every:
            continue
        path.unlink(missing_ok=True)
        changed().to_netcdf(path, engine="h5netcdf")
        for command in commands:
            outcome.take(f"{what}, {' '.join(command)}", worker.ask(command))
        if (number + 1) % OFTEN == 0:
            print(f"{number + 1} damages, {len(outcome.wrong)} wrong", file=sys.stderr, flush=True)
    worker.stop()
    path.unlink(missing_ok=True)
    whole.to_netcdf(path, engine="h5netcdf")
    return outcome


def killed(folder: Path, study: str, kills: int, seed: int) -> Outcome:
    """Kill runs at random moments, let each be finished, and compare the digits."""
    outcome, rng = Outcome(), np.random.default_rng(seed)
    began = time.monotonic()
    whole, duration = _whole(folder, study), time.monotonic() - began
    left, number = kills, 0
    while left > 0:
        results = folder / f"killed-{number}"
        for _ in range(min(left, 3)):
            process = _run(folder, study, results)
            try:
                process.communicate(timeout=float(rng.uniform(0.2, 1.0)) * duration)
                break
            except subprocess.TimeoutExpired:
                process.send_signal(signal.SIGKILL)
                process.communicate()
                left -= 1
                outcome.ends["killed"] += 1
        _finish(folder, study, results, whole, outcome, f"{study}, seed {seed}, run {number}")
        number += 1
    return outcome


def failing(folder: Path, study: str, faults: int, seed: int) -> Outcome:
    """Let the drive fail at random moments of runs, let each be finished, compare the digits."""
    kinds = ("full", "read-only", "denied", "broken", "lost", "taken", "long")
    outcome, rng = Outcome(), np.random.default_rng(seed)
    whole = _whole(folder, study)
    for number in range(faults):
        results = folder / f"failing-{number}"
        kind = kinds[number % len(kinds)]
        when = int(rng.integers(1, 60)) if kind != "long" else int(rng.choice([0, 300, 2000, 9000]))
        what = f"{study}, {kind} at {when}"
        command = [sys.executable, str(HERE / "faulty.py"), kind, str(when), str(results)]
        done = subprocess.run(
            [*command, "run", study, "-o", str(results)],
            cwd=folder,
            capture_output=True,
            timeout=SECONDS,
            check=False,
        )
        err = _messages(done.stderr)
        outcome.take(what, (done.returncode, "", err, len(err)))
        taken = Path(f"{results}.taken")
        if taken.is_dir():
            _remove(results)
            taken.rename(results)
        _finish(folder, study, results, whole, outcome, what)
    return outcome


def interleaved(count: int, seed: int) -> Outcome:
    """Have runs in one folder take turns at every call, on drives with and without locks."""
    import hypothesis
    from test_interleavings import Interleavings, WithoutLocks, play

    outcome = Outcome()
    for kind in (Interleavings, WithoutLocks):
        try:
            play(hypothesis.seed(seed)(kind), count, derandomize=False)
            outcome.ends["at most one run at a time"] += count
        except AssertionError as error:
            outcome.wrong.append(f"{kind.__name__}, seed {seed}: {error}")
    return outcome


def _messages(err: bytes) -> str:
    """Return what a run has printed on standard error but for its progress."""
    lines = err.decode().split("\n")
    return "\n".join(x for x in lines if not re.match(r"[^:]*: \d+/\d+ ", x))


def _whole(folder: Path, study: str) -> dict[str, bytes]:
    """Return the digits of a run that is not disturbed."""
    results = folder / f"whole-{study}"
    process = _run(folder, study, results)
    _, err = process.communicate()
    assert process.returncode == 0, err
    return _digits(results)


def _finish(
    folder: Path, study: str, results: Path, whole: dict[str, bytes], outcome: Outcome, what: str
) -> None:
    """Let a run be finished, compare its digits, and remove it."""
    process = _run(folder, study, results)
    _, err = process.communicate()
    same = process.returncode == 0 and _digits(results) == whole
    if not same:
        outcome.wrong.append(f"{what}: {err.decode()[-600:] or 'other digits'}")
    outcome.ends["finished with the same digits"] += same
    _remove(results)


def _run(folder: Path, study: str, results: Path) -> subprocess.Popen[bytes]:
    command = [sys.executable, "-m", "modefront", "run", study, "-o", str(results)]
    quiet = subprocess.DEVNULL
    return subprocess.Popen(command, cwd=folder, stdout=quiet, stderr=subprocess.PIPE)


def _remove(path: Path) -> None:
    if path.is_dir():
        shutil.rmtree(path)
    else:
        path.unlink(missing_ok=True)


def _digits(folder: Path) -> dict[str, bytes]:
    """Return all values of results, bit by bit."""
    with h5py.File(folder / "results.nc", "r") as data:
        return {name: value[()].tobytes() for name, value in data.items() if _is_number(value)}


def _is_number(value: h5py.Dataset | h5py.Group) -> bool:
    return isinstance(value, h5py.Dataset) and value.dtype.kind in "fiub"


def rows_of_every_format(examples: int) -> int:
    """Spoil so many rows of files of every format; return 1 where a reader has not noticed one."""
    environment = {**os.environ, "MODEFRONT_EXAMPLES": str(examples)}
    command = [sys.executable, "-m", "pytest", "-q", str(HERE / "test_rows.py")]
    done = subprocess.run(command, env=environment, cwd=HERE.parents[1], check=False)
    return min(done.returncode, 1)


def report(title: str, outcome: Outcome) -> Iterator[str]:
    """Yield what came out, in lines."""
    yield title
    for end, count in sorted(outcome.ends.items()):
        yield f"  {count:6d}  {end}"
    yield f"  {len(outcome.wrong):6d}  not as they should be"
    yield from (f"    {text}" for text in outcome.wrong)


def main() -> None:
    """Do the trials and print what came out; end with status 1 where something was wrong."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--inputs", type=int, default=10_000)
    parser.add_argument("--every", type=int, default=1, help="each of so many damages of results")
    parser.add_argument("--kills", type=int, default=100)
    parser.add_argument("--faults", type=int, default=100)
    parser.add_argument("--interleavings", type=int, default=10_000)
    parser.add_argument("--rows", type=int, default=5000, help="spoilt rows of each format")
    parser.add_argument("--seed", type=int, default=1)
    chosen = parser.parse_args()
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    sys.path += [
        str(HERE.parent / name) for name in ("study", "programs", "identification", "work")
    ]
    from sources import READING, RUNS, right_files

    wrong = rows_of_every_format(chosen.rows) if chosen.rows else 0
    with tempfile.TemporaryDirectory(prefix="trials-") as name:
        folder = Path(name)
        cases = right_files(folder)

        def show(title: str, outcome: Outcome) -> None:
            nonlocal wrong
            wrong += len(outcome.wrong)
            print("\n".join(report(f"{title}, seed {chosen.seed}", outcome)), flush=True)

        if chosen.inputs:
            show(f"{chosen.inputs} inputs", fuzz(folder, cases, chosen.inputs, chosen.seed))
        if count := chosen.interleavings:
            show(f"2 x {count} interleavings", interleaved(count, chosen.seed))
        if chosen.every:
            show("damaged results", damaged(folder, READING, chosen.every, chosen.seed))
        for study in RUNS:
            kills, faults = chosen.kills // len(RUNS), chosen.faults // len(RUNS)
            if kills:
                show(f"{kills} kills, {study}", killed(folder, study, kills, chosen.seed))
            if faults:
                show(f"{faults} faults, {study}", failing(folder, study, faults, chosen.seed))
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
