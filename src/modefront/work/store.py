"""Results of tasks in a folder, one small file a task, so that an interrupted run loses only one.

A file is written under another name and then renamed, so that it is there whole or not at all;
arrays are stored exactly, so that a run that is continued gives the same results to the last digit
as one that was not interrupted.
"""

from __future__ import annotations

import hashlib
import json
import os
import zipfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from modefront._typing import Floats
from modefront.work.codec import decode, encode
from modefront.work.costs import Costs
from modefront.work.task import Task

FOLDER = "tasks"
"""Folder of the kept results, within that of the results of a run."""

LONGEST = 60
"""Characters of a key at most in a file name, which ends in a hash."""

_DAMAGED = (OSError, EOFError, ValueError, KeyError, TypeError, RuntimeError, zipfile.BadZipFile)
"""Errors of damaged files; RuntimeError where their bytes ask for decryption or for
another compression."""


@dataclass(frozen=True)
class Store:
    """Keeps results of tasks in a folder."""

    folder: Path

    def read(self, task: Task[Any]) -> tuple[Any, Costs] | None:
        """Return the result of a task and what it cost; None where no whole one is kept."""
        path = self._path(task)
        if not path.is_file():  # a pipe in its place would be waited for
            return None
        try:
            with path.open("rb") as stream, np.load(stream, allow_pickle=False) as file:
                arrays = {key: file[key] for key in file.files}
            head = json.loads(arrays.pop("head").tobytes())
            if head["key"] != _identity(task):
                return None
            return decode(head["result"], arrays), Costs(**head["costs"])
        except _DAMAGED:
            return None

    def has(self, task: Task[Any]) -> bool:
        """Return whether there is a file of a task, whole or damaged."""
        return self._path(task).is_file()

    def remove(self, task: Task[Any]) -> None:
        """Remove the result of a task, if there is one."""
        self._path(task).unlink(missing_ok=True)

    def write(self, task: Task[Any], result: Any, costs: Costs) -> None:
        """Keep the result of a task, whole or not at all."""
        arrays: dict[str, Floats] = {}
        content = encode(result, arrays)
        head = json.dumps({"key": _identity(task), "costs": vars(costs), "result": content})
        path = self._path(task)
        path.parent.mkdir(parents=True, exist_ok=True)
        temporary = path.with_suffix(".tmp")
        named: dict[str, Any] = dict(arrays)
        try:
            with temporary.open("wb") as stream:
                np.savez(stream, head=np.frombuffer(head.encode(), np.uint8), **named)
                stream.flush()
                os.fsync(stream.fileno())
            temporary.replace(path)
        except BaseException:  # a full disk or an interrupt
            temporary.unlink(missing_ok=True)
            raise

    def _path(self, task: Task[Any]) -> Path:
        return self.folder / f"{_file_name(task)}.npz"


def _identity(task: Task[Any]) -> str:
    """Return the identity of a task as text: its parts, which may hold any characters."""
    return repr((task.key, task.turn))


def _file_name(task: Task[Any]) -> str:
    """Return a file name that no other task has, whatever the characters of its key and case."""
    safe = "".join(c if c.isascii() and (c.isalnum() or c in "-_") else "." for c in task.name)
    return f"{safe[:LONGEST]}-{hash_text(_identity(task))[:8]}"


def hash_text(text: str) -> str:
    """Return a short hash that does not change between runs."""
    return hashlib.sha256(text.encode()).hexdigest()[:16]
