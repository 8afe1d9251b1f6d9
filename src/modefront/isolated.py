"""Readers of other packages in a process of their own, with limits on time and memory.

A reader that ends its process, runs without an end, or takes all memory takes only this process
with it. What it has read comes back as plain arrays and texts in a file that is not unpickled.
"""

from __future__ import annotations

import importlib
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from modefront.errors import reason
from modefront.text import one_line

MOST_OUTPUT = 20_000
"""Characters of what a process prints that are looked at."""

ARRAYS, TEXTS = "arrays.npz", "texts.json"

Read = tuple[dict[str, np.ndarray[Any, Any]], Any]
"""Arrays by name, and texts and numbers as JSON has them."""


class IsolatedError(RuntimeError):
    """A reader failed, took too long, or ended its process; the message says which."""


def isolated(function: str, path: Path, seconds: float, memory: int) -> Read:
    """Return what a function reads from a file, called in another process.

    Parameters
    ----------
    function
        ``module:name`` of a function that takes the path and returns `Read`.
    path
        The file.
    seconds, memory
        Limits; that of memory, in bytes, holds where the system has such limits.

    Raises
    ------
    IsolatedError
        Where nothing was read.
    """
    with tempfile.TemporaryDirectory(prefix="modefront-") as folder:
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
        environment |= {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "PYTHONUTF8": "1"}
        command = [sys.executable, "-c", "from modefront.isolated import main; main()"]
        with (Path(folder) / "output").open("w+b") as output:
            try:
                done = subprocess.run(
                    [*command, function, str(path.absolute()), folder, str(memory)],
                    env=environment,
                    stdin=subprocess.DEVNULL,
                    stdout=output,
                    stderr=subprocess.STDOUT,
                    timeout=seconds,
                    check=False,
                )
            except subprocess.TimeoutExpired:
                text = f"nothing within {seconds:.0f} s, after which reading was given up"
                raise IsolatedError(text) from None
            output.seek(0)
            said = output.read(MOST_OUTPUT).decode("utf-8", "replace")
        if done.returncode < 0:
            raise IsolatedError(f"a file that ends its reader (signal {-done.returncode})")
        if done.returncode:
            raise IsolatedError(one_line(said, 400) or f"status {done.returncode} of the reader")
        try:
            with np.load(Path(folder) / ARRAYS, allow_pickle=False) as file:
                arrays = {name: file[name] for name in file.files}
            return arrays, json.loads((Path(folder) / TEXTS).read_text(encoding="ascii"))
        except (OSError, ValueError) as error:
            raise IsolatedError(f"nothing that can be used: {reason(error)}") from None


def main() -> None:
    """Read one file for `isolated`, which has started this process."""
    function, path, folder, memory = sys.argv[1:]
    limit(int(memory))
    module, name = function.split(":")
    read = getattr(importlib.import_module(module), name)
    try:
        arrays, texts = read(Path(path))
        named: Mapping[str, Any] = arrays
        np.savez(Path(folder) / ARRAYS, allow_pickle=False, **named)
        (Path(folder) / TEXTS).write_text(json.dumps(texts), encoding="ascii")
    except MemoryError:
        sys.exit(f"a file that takes more than {int(memory) / 1e9:.2g} GB to be read")
    except (Exception, SystemExit) as error:  # what readers raise is not documented
        sys.exit(one_line(error, 400) or type(error).__name__)


def limit(memory: int) -> None:
    """Limit the memory of this process, where the system can, and write no core file."""
    try:
        import resource
    except ImportError:  # Windows
        return
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    if sys.platform == "linux":  # others count memory that is not taken
        resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
