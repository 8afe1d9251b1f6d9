"""Examples that ``modefront init`` writes: one folder each, and what is simulated for it."""

from __future__ import annotations

from importlib import import_module, resources
from pathlib import Path

from modefront.errors import Fault, InputError, reason, suggestion
from modefront.outputs import write_bytes

SIMULATED = {"hammer-test": "hammer_test", "ambient-test": "ambient_test"}
"""Modules of examples of which tests are simulated where written."""


def names() -> list[str]:
    """Return the names of the examples."""
    folder = resources.files(__package__)
    return sorted(item.name for item in folder.iterdir() if item.joinpath("study.toml").is_file())


def write_example(name: str, directory: Path) -> list[Path]:
    """Write the files of an example into a folder and return their paths.

    Raises InputError for an unknown example, and where a file is already there: nothing is
    overwritten.
    """
    if name not in names():
        expected = "one of " + ", ".join(names())
        raise InputError(Fault("modefront init", "--example", expected, suggestion(name, names())))
    sources = sorted(
        (item for item in resources.files(__package__).joinpath(name).iterdir()),
        key=lambda item: item.name,
    )
    targets = [directory / source.name for source in sources]
    module = import_module(f"{__package__}.{SIMULATED[name]}") if name in SIMULATED else None
    simulated = [directory / file for file in module.files()] if module else []
    try:
        directory.mkdir(parents=True, exist_ok=True)
        existing = [path for path in (*targets, *simulated) if path.exists() or path.is_symlink()]
        if existing:
            expected = "a new file, as nothing is overwritten"
            raise InputError(
                Fault(str(path), "file", expected, "an existing one") for path in existing
            )
        for source, path in zip(sources, targets, strict=True):
            write_bytes(path, source.read_bytes())
        if module:
            module.write(directory)
    except OSError as error:
        expected = "a folder that can be written to"
        raise InputError(Fault(str(directory), "folder", expected, reason(error))) from None
    return sorted([*targets, *simulated])
