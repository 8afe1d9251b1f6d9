"""Examples, made once a process: that of a hammer test is simulated and identified."""

from __future__ import annotations

import tempfile
from functools import cache
from pathlib import Path

from modefront.study.examples import write_example


@cache
def contents(name: str) -> dict[str, bytes]:
    """Return the files of an example."""
    with tempfile.TemporaryDirectory() as folder:
        return {path.name: path.read_bytes() for path in write_example(name, Path(folder))}


def write(name: str, folder: Path) -> None:
    """Write an example into a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    for file, content in contents(name).items():
        (folder / file).write_bytes(content)
