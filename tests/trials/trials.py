"""Trials: inputs that are spoilt by chance, and runs that are killed.

    python tests/trials/trials.py --inputs 10000 --kills 100 --seed 1

prints how many inputs ended in which way, and what did not end as it should, with its seed.
"""

from __future__ import annotations

import argparse
import json
import os
import select
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import xarray as xr
from mutations import mutated, right_files, run_study

SECONDS = 120.0
"""Time that a command may take."""

LINES, CHARACTERS = 20, 2000
"""Length of a message, at most."""


@dataclass
class Outcome:
    """How commands ended, by status, and what was wrong, with the number of the input."""

    ends: Counter[str] = field(default_factory=Counter)
    wrong: list[str] = field(default_factory=list)


class Worker:
    """A process that runs commands in a folder; it is started again where it has ended."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.process: subprocess.Popen[str] | None = None

    def ask(self, arguments: tuple[str, ...]) -> tuple[int, str, str, int] | str:
        """Return status, output, message and length of the message, or how the process ended."""
        if self.process is None or self.process.poll() is not None:
            command = [sys.executable, str(Path(__file__).with_name("worker.py"))]
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


def fault(answer: tuple[int, str, str, int] | str) -> str:
    """Return what is wrong with the end of a command; nothing where it is as it should be."""
    if isinstance(answer, str):
        return answer
    status, out, err, length = answer
    if status not in (0, 1, 2):
        return f"status {status}"
    if status and not err:
        return f"status {status} without a message"
    if "error of the program itself" in err or "Traceback" in err:
        return err
    message = [line for line in err.split("\n") if not line.startswith("warning")]
    if status and (length > CHARACTERS + 100 or len(message) > LINES + 1):
        return f"a message of {length} characters"
    if not all(line.isprintable() for line in (out + err).split("\n")):
        return "orders to the terminal"
    return "" if "Errno" not in err else err


def fuzz(folder: Path, inputs: int, seed: int) -> Outcome:
    """Spoil files of every format in turn, and run the command that reads each of them."""
    cases = [*right_files(folder), *run_study(folder)]
    outcome, worker = Outcome(), Worker(folder)
    for number in range(inputs):
        name, arguments = cases[number % len(cases)]
        path = folder / name
        content = path.read_bytes()
        path.write_bytes(mutated(content, np.random.default_rng([seed, number])))
        answer = worker.ask(arguments)
        if text := fault(answer):
            outcome.wrong.append(f"seed {seed}, input {number}, {name}: {text[:300]}")
        outcome.ends[text[:40] or f"exit {answer[0]}"] += 1
        path.unlink(missing_ok=True)
        path.write_bytes(content)
    worker.stop()
    return outcome


def killed(folder: Path, kills: int, seed: int) -> Outcome:
    """Kill runs at random moments, let each be finished, and compare the digits."""
    right_files(folder)
    study, outcome = folder / "K-npy.toml", Outcome()

    def run(results: Path) -> subprocess.Popen[bytes]:
        command = [sys.executable, "-m", "modefront", "run", str(study), "-o", str(results)]
        quiet = subprocess.DEVNULL
        return subprocess.Popen(command, stdout=quiet, stderr=subprocess.PIPE)

    began = time.monotonic()
    whole_run = run(folder / "whole")
    whole_run.communicate()
    assert whole_run.returncode == 0
    whole, duration = _digits(folder / "whole"), time.monotonic() - began
    rng = np.random.default_rng(seed)
    left, number = kills, 0
    while left > 0:
        results = folder / f"killed-{number}"
        for _ in range(3):
            process = run(results)
            try:
                process.communicate(timeout=float(rng.uniform(0.2, 1.1)) * duration)
                break
            except subprocess.TimeoutExpired:
                process.send_signal(signal.SIGKILL)
                process.communicate()
                left -= 1
                outcome.ends["killed"] += 1
        process = run(results)
        _, err = process.communicate()
        if process.returncode or _digits(results) != whole:
            outcome.wrong.append(f"seed {seed}, run {number}: {err.decode()[:300]}")
        outcome.ends["finished with the same digits"] += not process.returncode
        shutil.rmtree(results)
        number += 1
    return outcome


def _digits(folder: Path) -> dict[str, bytes]:
    """Return all values of results, bit by bit."""
    with xr.open_dataset(folder / "results.nc", engine="h5netcdf") as data:
        return {
            str(name): value.values.tobytes()
            for name, value in data.variables.items()
            if value.dtype.kind in "fiub"
        }


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
    parser.add_argument("--kills", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    chosen = parser.parse_args()
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    wrong = 0
    with tempfile.TemporaryDirectory(prefix="trials-") as name:
        for title, what, count in (
            ("inputs", fuzz, chosen.inputs),
            ("kills", killed, chosen.kills),
        ):
            folder = Path(name) / title
            folder.mkdir()
            outcome = what(folder, count, chosen.seed)
            wrong += len(outcome.wrong)
            print("\n".join(report(f"{count} {title}, seed {chosen.seed}", outcome)), flush=True)
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
