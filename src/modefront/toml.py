"""Typed access to the tables of a TOML file, which collects the faults."""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, TypeVar

from modefront.errors import Fault, InputError, reason, suggestion
from modefront.inputs import MOST_TABLES, read_text_bytes
from modefront.options import (
    Option,
    Requirement,
    is_name,
    number,
    one_of,
    options,
    shown,
    text,
)
from modefront.text import NAME, clean

R = TypeVar("R")
T = TypeVar("T")


@dataclass
class Table:
    """One table of a TOML file.

    Readers of values return a default where there is no value, and note a fault and return None
    where there is none either (a default of ``...``); a value that is wrong is a fault, too.

    Attributes
    ----------
    file : the TOML file
    place : where the table is in it, for messages; empty for the top level
    values : what the table holds
    faults : all that is wrong with the file, shared by its tables
    requested : keys that were read or are known
    files : paths of the files that the tables name, shared by them; see `path`
    notes : records of what was found beside faults, shared by the tables
    """

    file: str
    place: str
    values: dict[str, Any]
    faults: list[Fault]
    requested: list[str] = field(default_factory=list)
    files: list[Path] = field(default_factory=list)
    notes: list[object] = field(default_factory=list)

    def fault(self, key: str, expected: str, found: str) -> None:
        """Note that something is wrong; an empty key means the table itself."""
        known = key if key.isprintable() else repr(key)
        place = f"{self.place} {known}".strip() or "top level"
        self.faults.append(Fault(self.file, place, expected, found))

    def note(self, faults: Iterable[Fault]) -> None:
        """Note faults whose places are keys of the table."""
        for fault in faults:
            self.fault(fault.place, fault.expected, fault.found)

    def path(self, name: str) -> Path:
        """Return the path of a file that a table names, relative to the TOML file, and note it.

        What a file is read for depends on all files noted in ``files``.
        """
        path = Path(self.file).parent / name
        if path not in self.files:
            self.files.append(path)
        return path

    def value(self, key: str, requirement: Requirement, default: Any = ...) -> Any:
        """Return a value that meets a requirement."""
        self.requested.append(key)
        value = self.values.get(key)
        if value is None and default is not ...:
            return default
        if value is not None and requirement.holds(value):
            return requirement.read(self, key) if requirement.read else requirement.convert(value)
        self.fault(key, requirement.expected, "nothing" if value is None else shown(value))
        return None if default is ... else default

    def take(self, key: str, expected: str, test: Callable[[Any], bool], default: Any) -> Any:
        """Return a value that passes a test."""
        return self.value(key, Requirement(expected, {}, further=test), default)

    def text(self, key: str, expected: str = "a text", default: Any = ...) -> Any:
        """Return a text of printable characters that is not empty."""
        return self.value(key, text(expected), default)

    def choice(self, key: str, choices: Sequence[str], default: Any = ...) -> Any:
        """Return one of some texts."""
        return self.value(key, one_of(*choices), default)

    def number(self, key: str, expected: str, default: Any = ..., **limits: float) -> Any:
        """Return a finite number within limits, those of `modefront.options.number`."""
        return self.value(key, number(expected, **limits), default)

    def read(self, known: Iterable[Option]) -> dict[str, Any] | None:
        """Return the values of keys that are given, None where anything is wrong with the table."""
        before = len(self.faults)
        values: dict[str, Any] = {}
        for option in known:
            name, requirement = option.name, option.requirement
            given = self.values.get(name)
            if given is None and not option.required:
                self.requested.append(name)
            elif requirement.record and isinstance(given, dict):
                inner = self.table(name)
                values[name] = inner and inner.record(requirement.record)
            elif not requirement.schema:
                self.requested.append(name)  # a reader of its own says what is wrong with it
                values[name] = given
            else:
                values[name] = self.value(name, requirement)
        self.close()
        return values if len(self.faults) == before else None

    def record(self, record: type[T]) -> T | None:
        """Return the record of options that the table describes, None where something is wrong.

        Keys are its fields. Everything that is wrong is noted: single values first, and where these
        are right, what contradicts another.
        """
        values = self.read(options(record))
        try:
            return None if values is None else record(**values)
        except InputError as error:
            self.note(error.faults)
            return None

    def table(self, key: str, expected: str = "a table", default: Any = ...) -> Table | None:
        """Return a table within this one."""
        value = self.take(key, expected, lambda x: isinstance(x, dict), default)
        if value is None:
            return None
        place = f"{self.place} {key}".strip() if self.place else f"[{key}]"
        return replace(self, place=place, values=value, requested=[])

    def entries(
        self, key: str, each: str, least: str = "", *, required: bool = True
    ) -> Iterator[tuple[str, Table]]:
        """Yield the tables within a table by their names; ``each`` says in words what one holds.

        ``least`` is what one of them is called where there has to be one.
        """
        table = self.table(key, f"a table of {key.removesuffix('s')}s", ... if required else None)
        if table and least and not table.values:
            table.fault("", f"at least one {least}", "none")
        for name in table.values if table else ():
            if table and (entry := table.table(name, each)):
                yield name, entry

    def content(self, key: str, read: Callable[[Path], R]) -> R | None:
        """Return what is read from a file, None without its name; note what is wrong with it."""
        name: Any = self.values.get(key)
        try:
            return read(self.path(name)) if is_name(name) else None
        except InputError as error:
            self.faults.extend(error.faults)
            return None

    def names(self, key: str) -> dict[str, str]:
        """Return a table of names for names, such as those of columns; an empty one without it."""
        table = self.table(key, "a table, name in the file = name here", None)
        found = {name: table.text(name) for name in table.values} if table is not None else {}
        return {name: text for name, text in found.items() if text is not None}

    def tables(self, key: str, required: bool) -> list[Table]:
        """Return the tables of a list, such as ``[[parameter]]``."""
        path = f"{self.place.strip('[]')}.{key}" if self.place else key
        value = self.take(
            key,
            f"at least one table [[{path}]]" if required else f"tables [[{path}]]",
            lambda x: isinstance(x, list) and bool(x) and all(isinstance(y, dict) for y in x),
            ... if required else [],
        )
        out = []
        for k, item in enumerate(value or [], start=1):
            named = f" ({item['name']!r})" if isinstance(item.get("name"), str) else ""
            place = f"[[{path}]] {k}{named}"
            out.append(replace(self, place=place, values=item, requested=[]))
        return out

    def close(self) -> None:
        """Note every unknown key, once."""
        known = set(self.requested)
        for k, key in enumerate(key for key in self.values if key not in known):
            found = suggestion(key, self.requested) if k < 20 else repr(clean(key, NAME))
            self.fault("", "a known key", found)
        self.requested += self.values


def read_toml(path: Path, expected: str) -> tuple[Table, bytes]:
    """Return the top level of a TOML file, and its content.

    Raises InputError where it cannot be read; ``expected`` says what it should be.
    """
    content = read_text_bytes(path, expected, MOST_TABLES)
    try:
        return Table(str(path), "", tomllib.loads(content.decode("utf-8-sig")), []), content
    except (ValueError, RecursionError) as error:
        raise InputError(Fault(str(path), "file", "TOML in UTF-8", reason(error))) from None


def names_of(tables: Iterable[Table]) -> list[str]:
    """Return what tables of a list say as their names."""
    return [name for table in tables if isinstance(name := table.values.get("name"), str)]
