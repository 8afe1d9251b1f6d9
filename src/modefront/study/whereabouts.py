"""Place of the study of results, which runs note beside their results."""

from __future__ import annotations

import os
import tomllib
from collections.abc import Iterator
from pathlib import Path

from modefront.errors import Fault, InputError
from modefront.inputs import MOST_TABLES
from modefront.outputs import write_text
from modefront.study.definition import Study
from modefront.study.file import load
from modefront.work.store import FOLDER

NOTE = "study"
"""File among the results of tasks, with the path of the study file from the results."""

LONGEST = 4096
"""Bytes of a path that is believed."""

ABOVE = 3
"""Folders above the results in which a study is sought."""


def note_study(folder: Path, tasks: Path, file: Path) -> None:
    """Note where the study of results in a folder lies, among its ``tasks``.

    Not where it has no relative path.
    """
    try:
        path = os.path.relpath(file.absolute(), folder.absolute())
        write_text(tasks / NOTE, Path(path).as_posix() + "\n")
    except (ValueError, OSError):  # another drive; a note that cannot be written is no loss
        return


def find_study(results: Path, name: str, digest: str) -> Study:
    """Return the study of results: where the run says, beside them, above them or here.

    Parameters
    ----------
    results
        Folder of the results.
    name, digest
        Name of the study and hash of its inputs, as in the results.

    Raises InputError where there is none with these inputs, with the files that were found, or
    what is wrong with the only one.
    """
    changed: list[Path] = []
    broken: InputError | None = None
    for file in dict.fromkeys(_candidates(results)):
        if not _is_named(file, name):
            continue
        try:
            study = load(file)
        except InputError as error:
            broken = broken or error
            continue
        if study.digest == digest:
            return study
        changed.append(file)
    if broken and not changed:
        raise broken
    place = str(results)
    if changed:
        files = " and ".join(f"'{file}'" for file in changed[:3])
        found = f"{files} with other inputs than those of the results: changed since the run"
        expected = f"the study '{name}' as it was run (pass --study FILE, or run it again)"
    else:
        expected = f"the study '{name}' where it was run, beside the results or in this folder"
        found = "none: pass --study FILE"
    raise InputError(Fault(place, "study", expected, found))


def given_study(results: Path, file: Path, digest: str) -> Study:
    """Return the study in a file, which has to be that of results.

    Raises InputError where its inputs are others.
    """
    study = load(file)
    if study.digest != digest:
        expected = f"the study of the results in '{results}'"
        raise InputError(Fault(str(file), "study", expected, "other inputs: run it again"))
    return study


def _candidates(results: Path) -> Iterator[Path]:
    """Yield the files that may be the study, the likeliest first."""
    for file in sorted((results / FOLDER).glob(f"*/{NOTE}")):
        note = _text(file).strip()
        if note.isprintable() and note.endswith(".toml"):
            yield Path(os.path.normpath(results / note))
    absolute = results.absolute()
    for folder in (results, *absolute.parents[:ABOVE], Path.cwd()):
        yield from sorted(folder.glob("*.toml"))
    yield from sorted(absolute.parent.glob("*/*.toml"))


def _text(file: Path) -> str:
    """Return a note, empty where it cannot be read."""
    try:
        if not file.is_file() or file.stat().st_size > LONGEST:
            return ""
        return file.read_text("utf-8")
    except (OSError, UnicodeDecodeError):
        return ""


def _is_named(file: Path, name: str) -> bool:
    try:
        if not file.is_file() or file.stat().st_size > MOST_TABLES:
            return False
        return bool(tomllib.loads(file.read_text("utf-8-sig"))["study"]["name"] == name)
    except (OSError, ValueError, KeyError, TypeError):
        return False
