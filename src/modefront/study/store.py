"""Pieces of work in files, one small file a piece, so that an interrupted run loses only one.

A piece is a list of solutions, or named arrays. Its file is written under another name and then
renamed, so that it is there whole or not at all; arrays are stored exactly, so that a run that is
continued gives the same results to the last digit as one that was not interrupted.
"""

from __future__ import annotations

import hashlib
import json
import os
import zipfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from modefront._typing import Floats
from modefront.solvers.checkpoint import Solutions
from modefront.solvers.problem import Evaluation, ObjectiveDerivatives, Residual
from modefront.solvers.sqp import Solution, Status

PIECES = "pieces"

Arrays = Mapping[str, Floats]

T = TypeVar("T")


@dataclass
class Store:
    """Keeps pieces in a folder, or in none, and counts what they cost.

    ``counter`` tells what has been spent so far; ``done`` is called with the name of every piece.
    """

    folder: Path | None
    counter: Callable[[], Mapping[str, int]]
    done: Callable[[str], None]
    costs: dict[str, dict[str, int]]

    def __call__(self, name: str, compute: Callable[[], Solutions]) -> Solutions:
        """Return the solutions of a piece that is there, or compute and keep it."""
        return self._kept(name, compute, _packed, _unpacked)

    def arrays(self, name: str, compute: Callable[[], Arrays]) -> Arrays:
        """Return the named arrays of a piece that is there, or compute and keep it."""
        return self._kept(name, compute, lambda arrays: (None, arrays), lambda _, arrays: arrays)

    def _kept(
        self,
        name: str,
        compute: Callable[[], T],
        packed: Callable[[T], tuple[Any, Arrays]],
        unpacked: Callable[[Any, Arrays], T],
    ) -> T:
        path = self.folder / f"{_file_name(name)}.npz" if self.folder else None
        found = read_piece(path) if path else None
        if found is None:
            before = dict(self.counter())
            result = compute()
            cost = {key: n - before[key] for key, n in self.counter().items()}
            if path:
                write_piece(path, *packed(result), cost)
        else:
            head, arrays, cost = found
            result = unpacked(head, arrays)
        self.costs[name] = cost
        self.done(name)
        return result

    def total(self, prefix: str = "") -> dict[str, int]:
        """Return what all pieces cost whose names begin so."""
        chosen = [cost for name, cost in self.costs.items() if name.startswith(prefix)]
        return {key: sum(cost.get(key, 0) for cost in chosen) for key in self.counter()}


def _file_name(name: str) -> str:
    """Return a name without characters that file systems treat specially."""
    safe = "".join(c if c.isalnum() or c in "-_" else f"%{ord(c):x}" for c in name)
    return safe if len(safe) < 100 else f"{safe[:60]}-{hash_text(name)}"


def hash_text(text: str) -> str:
    """Return a short hash that does not change between runs."""
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def write_piece(path: Path, content: Any, arrays: Arrays, cost: Mapping[str, int]) -> None:
    """Write a piece whole or not at all: what JSON holds, named arrays, and what they cost."""
    head = json.dumps({"cost": dict(cost), "content": content})
    named: dict[str, Any] = dict(arrays)
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_suffix(".tmp")
    with temporary.open("wb") as stream:
        np.savez(stream, head=np.frombuffer(head.encode(), np.uint8), **named)
        stream.flush()
        os.fsync(stream.fileno())
    temporary.replace(path)


def read_piece(path: Path) -> tuple[Any, Arrays, dict[str, int]] | None:
    """Return what a piece holds and its cost; None where there is no whole one."""
    try:
        with path.open("rb") as stream, np.load(stream, allow_pickle=False) as file:
            arrays = {key: file[key] for key in file.files}
        head = json.loads(arrays.pop("head").tobytes())
    except (OSError, EOFError, ValueError, KeyError, zipfile.BadZipFile):
        return None
    return head["content"], arrays, head["cost"]


def _packed(solutions: Solutions) -> tuple[Any, Arrays]:
    """Return solutions as what JSON holds and arrays."""
    arrays: dict[str, Floats] = {}
    heads = []
    for i, one in enumerate(solutions):
        at = one.at
        parts = {"theta": at.theta, "J": at.J}
        parts |= {"dJ": at.dJ, "H": at.H} if at.derivatives else {}
        parts |= {"learned": one.learned, "weights": one.weights}
        parts |= {} if one.beta is None else {"beta": one.beta}
        parts |= {f"quantity:{key}": value for key, value in at.quantities.items()}
        parts |= {f"r:{k}": residual.r for k, residual in enumerate(at.residuals)}
        parts |= {f"dr:{k}": residual.dr for k, residual in enumerate(at.residuals)}
        arrays |= {f"{i}:{key}": value for key, value in parts.items()}
        heads.append([one.violation, one.status.name, one.evaluations, list(at.branch)])
    return heads, arrays


def _unpacked(heads: Any, arrays: Arrays) -> Solutions:
    solutions = []
    for i, (violation, status, evaluations, branch) in enumerate(heads):
        own = {key.split(":", 1)[1]: a for key, a in arrays.items() if key.startswith(f"{i}:")}
        kept = {key[9:]: value for key, value in own.items() if key.startswith("quantity:")}
        rows = range(sum(key.startswith("r:") for key in own))
        residuals = [Residual(own[f"r:{k}"], own[f"dr:{k}"]) for k in rows]
        slopes = ObjectiveDerivatives(own["dJ"], own["H"]) if "dJ" in own else None
        at = Evaluation(own["theta"], own["J"], slopes, kept, residuals, tuple(branch))
        ended = (violation, Status[status], evaluations)
        solutions.append(Solution(at, own["learned"], own["weights"], *ended, own.get("beta")))
    return solutions
