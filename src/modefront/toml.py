"""Typed access to the tables of a TOML file, which collects the faults."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from modefront.errors import Fault, suggestion
from modefront.rounding import LARGEST
from modefront.text import NAME, clean

SUGGESTED = 20
"""Unknown keys of a table for which a known one is sought."""

SHORT = 6
"""Longest list that a message shows item by item."""


def describe(value: object) -> str:
    """Return a value and its kind as a message shows them."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return f"the text {value!r}"
    if isinstance(value, dict):
        return "a table"
    if isinstance(value, list):
        short = len(value) <= SHORT and not any(isinstance(x, dict) for x in value)
        return f"[{', '.join(map(_item, value))}]" if short else f"a list of {len(value)}"
    if isinstance(value, int | float) and LARGEST < abs(value) < math.inf:
        return f"a number beyond {LARGEST:g}"
    return str(value)


def _item(value: object) -> str:
    return repr(value) if isinstance(value, str) else describe(value)


@dataclass
class Table:
    """One table of a TOML file.

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
        shown = key if key.isprintable() else repr(key)
        place = f"{self.place} {shown}".strip() or "top level"
        self.faults.append(Fault(self.file, place, expected, found))

    def path(self, name: str) -> Path:
        """Return the path of a file that a table names, relative to the TOML file, and note it.

        What a file is read for depends on all files noted in ``files``.
        """
        path = Path(self.file).parent / name
        if path not in self.files:
            self.files.append(path)
        return path

    def take(self, key: str, expected: str, test: Callable[[Any], bool], default: Any) -> Any:
        """Return a value that passes a test, or the default, with a fault where it does not.

        A default of ``...`` says that the key is required; None is returned in its place.
        """
        self.requested.append(key)
        if key not in self.values:
            if default is ...:
                self.fault(key, expected, "nothing")
                return None
            return default
        value = self.values[key]
        if not test(value):
            self.fault(key, expected, describe(value))
            return None if default is ... else default
        return value

    def text(self, key: str, expected: str = "a text", default: Any = ...) -> str | None:
        """Return a text of printable characters that is not empty."""
        value = self.take(key, expected, is_name, default)
        return None if value is None else str(value)

    def choice(self, key: str, options: Sequence[str], default: Any = ...) -> Any:
        """Return one of the options."""
        expected = "one of " + ", ".join(f"'{x}'" for x in options)
        return self.take(key, expected, lambda x: x in options, default)

    def number(
        self, key: str, expected: str, test: Callable[[float], bool], default: Any = ...
    ) -> Any:
        """Return a finite number that passes a test."""
        value = self.take(key, expected, lambda x: is_number(x) and test(x), default)
        return float(value) if is_number(value) else value

    def integer(self, key: str, least: int, most: int, default: Any = ...) -> Any:
        """Return a whole number within limits."""
        return self.take(
            key,
            f"a whole number from {least} to {most}",
            lambda x: isinstance(x, int) and not isinstance(x, bool) and least <= x <= most,
            default,
        )

    def numbers(
        self, key: str, expected: str, test: Callable[[list[float]], bool], default: Any = ...
    ) -> list[float] | None:
        """Return a list of finite numbers that passes a test."""
        value = self.take(
            key,
            expected,
            lambda x: isinstance(x, list) and all(map(is_number, x)) and test(x),
            default,
        )
        return None if value is None else [float(x) for x in value]

    def table(self, key: str, expected: str = "a table", default: Any = ...) -> Table | None:
        """Return a table within this one."""
        value = self.take(key, expected, lambda x: isinstance(x, dict), default)
        if value is None:
            return None
        place = f"{self.place} {key}".strip() if self.place else f"[{key}]"
        return Table(self.file, place, value, self.faults, files=self.files, notes=self.notes)

    def names(self, key: str) -> dict[str, str]:
        """Return a table of names for names, such as those of columns; an empty one without it."""
        table = self.table(key, "a table, name in the file = name here", None)
        found = {name: table.text(name) for name in table.values} if table is not None else {}
        return {name: text for name, text in found.items() if text is not None}

    def tables(self, key: str, required: bool) -> list[Table]:
        """Return the tables of a list, such as ``[[parameter]]``."""
        path = f"{self.place[1:-1]}.{key}" if self.place else key
        value = self.take(
            key,
            f"at least one table [[{path}]]" if required else f"tables [[{path}]]",
            lambda x: isinstance(x, list) and bool(x) and all(isinstance(y, dict) for y in x),
            ... if required else [],
        )
        path = f"{self.place.strip('[]')}.{key}" if self.place else key
        return [
            Table(
                *(self.file, f"[[{path}]] {i + 1}{_named(item)}", item, self.faults),
                files=self.files,
                notes=self.notes,
            )
            for i, item in enumerate(value or [])
        ]

    def close(self) -> None:
        """Note every unknown key."""
        known = set(self.requested)
        for number, key in enumerate(key for key in self.values if key not in known):
            found = (
                suggestion(key, self.requested) if number < SUGGESTED else repr(clean(key, NAME))
            )
            self.fault("", "a known key", found)


def is_number(value: object) -> bool:
    """Return whether a value is a finite number of which products are finite as well."""
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) <= LARGEST


def is_name(value: object) -> bool:
    """Return whether a value is a text that can be printed and is not blank."""
    return isinstance(value, str) and bool(value.strip()) and value.isprintable()


def repeated(names: Iterable[str | None]) -> list[str]:
    """Return the names that occur more than once."""
    seen: list[str] = []
    twice: list[str] = []
    for name in names:
        if name is not None and name in seen and name not in twice:
            twice.append(name)
        seen.append(name or "")
    return twice


def _named(item: dict[str, Any]) -> str:
    name = item.get("name")
    return f" ({name!r})" if isinstance(name, str) else ""


def has_name(table: Table) -> bool:
    """Return whether a table holds a text called ``name``."""
    return isinstance(table.values.get("name"), str)
