"""Options that check themselves, with the same words in Python and in a file.

An option is a field of a frozen dataclass. Its annotation has its requirement: a ``Literal``, or
``Annotated`` with a `Requirement`, or with a function that returns one when it is needed; ``None``
besides, where the annotation has it. `check_fields`, called from ``__post_init__``, compares all
fields with their requirements and brings their values into plain Python: the same record is made
from TOML (`modefront.toml.Table`), from literals and from numpy scalars.
"""

from __future__ import annotations

import inspect
import math
import re
import types
import typing
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import MISSING, dataclass, field, fields
from enum import Enum
from itertools import pairwise
from typing import Annotated, Any, Literal, get_args, get_origin, get_type_hints

import numpy as np

from modefront.errors import Fault, refuse
from modefront.json_schema import NAME, NUMBER, TABLE, Schema, array, closed, fits, whole_number
from modefront.rounding import LARGEST

WITHOUT = "Without it: "
"""What a description says before the default of a key, where that is no single value."""

SHORT = 6
"""Longest list that a message shows item by item."""


@dataclass(frozen=True, eq=False)
class Requirement:
    """Requirement on the value of an option.

    Attributes
    ----------
    expected : the same in words
    schema : of such a value; empty where `entries` are read by a reader of their own
    convert : brings such a value into the form that is kept
    further : whether a value of this schema meets what no schema says
    record : the class of a nested record, read from a table within the table; None for a value
    entries : schema of a table with its entries, where these are read one by one and what is wrong
        is said of each; empty where ``schema`` says all
    read : reads such a table, given the `modefront.toml.Table` with it and its key
    """

    expected: str
    schema: Schema
    convert: Callable[[Any], Any] = lambda value: value
    further: Callable[[Any], bool] = lambda _: True
    record: type | None = None
    entries: Schema = field(default_factory=dict)
    read: Callable[[Any, str], Any] | None = None

    def holds(self, value: Any) -> bool:
        """Return whether a value in plain Python is so."""
        if self.record:
            return isinstance(value, self.record)
        return fits(value, self.schema) and self.further(value)

    def fault(self, place: str, value: object) -> Fault | None:
        """Return the fault of a value, None where it has none."""
        return None if self.holds(plain(value)) else Fault("", place, self.expected, shown(value))

    @property
    def described(self) -> Schema:
        """Schema of a value in a file, with all that is within it, and its requirement in words."""
        schema = schema_of(self.record) if self.record else self.entries or self.schema
        return {"description": self.expected, **schema}


def one_of(*choices: str) -> Requirement:
    """Return the requirement of one of several texts."""
    expected = "one of " + ", ".join(f"'{choice}'" for choice in choices)
    return Requirement(expected, {"enum": list(choices)})


def whole(least: int, most: int) -> Requirement:
    """Return the requirement of a whole number within limits."""
    return Requirement(f"a whole number from {least} to {most}", whole_number(least, most))


def number(
    expected: str,
    *,
    least: float = -LARGEST,
    most: float = LARGEST,
    above: float | None = None,
    below: float | None = None,
) -> Requirement:
    """Return the requirement of a finite number within limits."""
    open_ends = {"exclusiveMinimum": above, "exclusiveMaximum": below}
    limits = {key: end for key, end in open_ends.items() if end is not None}
    schema = {"type": "number", "minimum": least, "maximum": most} | limits
    return Requirement(expected, schema, float)


def numbers(
    expected: str, schema: Schema, further: Callable[[list[float]], bool] = lambda _: True
) -> Requirement:
    """Return the requirement of a list of finite numbers."""
    return Requirement(expected, schema, lambda value: tuple(map(float, value)), further)


def text(expected: str) -> Requirement:
    """Return the requirement of a text of printable characters that is not blank."""
    return Requirement(expected, NAME, further=is_name)


def nested(expected: str, record: type) -> Requirement:
    """Return the requirement of another record of options."""
    return Requirement(expected, TABLE, record=record)


def entries(expected: str, schema: Schema) -> Requirement:
    """Return the requirement of a table which a reader of its own reads, entry by entry."""
    return Requirement(expected, {}, entries=schema)


PAIR = array(NUMBER, 2, 2)
"""Schema of two numbers."""


def rising(values: Sequence[float]) -> bool:
    """Return whether each number is greater than the one before it."""
    return all(a < b for a, b in pairwise(values))


TRUE_OR_FALSE = Requirement("true or false", {"type": "boolean"})


@dataclass(frozen=True)
class Option:
    """A key of a table, and the field of that name where a record of options is made of it.

    Attributes
    ----------
    name : of the field, and of the key of a table
    requirement : what its value has to be
    optional : whether None is right as well
    required : whether it has no default
    default : the default in plain Python; None where it has none, or follows from other values
    meaning : of the field, from the docstring of the record
    """

    name: str
    requirement: Requirement
    optional: bool = False
    required: bool = False
    default: Any = None
    meaning: str = ""

    @property
    def schema(self) -> Schema:
        """Schema of the key: lines say its meaning, its requirement and what holds without it."""
        meaning, _, without = self.meaning.partition("; None for ")
        lines = [meaning, self.requirement.expected, without and WITHOUT + without]
        said = {"description": "\n".join(filter(None, lines))}
        known = {} if self.default is None else {"default": self.default}
        return {**self.requirement.described, **said, **known}


def keys(required: Sequence[str], **known: Requirement) -> tuple[Option, ...]:
    """Return the keys of a table that is no record of options."""
    return tuple(Option(name, each, required=name in required) for name, each in known.items())


def options(record: type) -> tuple[Option, ...]:
    """Return the fields of a class of records that have requirements."""
    hints = get_type_hints(record, include_extras=True)
    _, _, section = (inspect.getdoc(record) or "").partition("Attributes\n----------\n")
    said = re.findall(r"^(\w+) : (.*(?:\n    .*)*)", section, re.MULTILINE)
    meanings = {name: " ".join(text.split()).replace("``", "`") for name, text in said}
    out = []
    for each in fields(record):
        requirement = _requirement(hints[each.name])
        if requirement is not None:
            required = each.default is MISSING and each.default_factory is MISSING
            optional = types.NoneType in get_args(hints[each.name])
            default = None if required else plain(each.default)
            if default in ("", []) or not fits(default, requirement.schema):
                default = None
            meaning = meanings.get(each.name, "")
            out.append(Option(each.name, requirement, optional, required, default, meaning))
    return tuple(out)


def schema_of(record: type) -> Schema:
    """Return the schema of a table whose keys are the fields of a record.

    A class that needs one of several fields, and no more, names them by its attribute ``either``.
    """
    return {**of_options(options(record)), **getattr(record, "either", {})}


def of_options(known: Iterable[Option]) -> Schema:
    """Return the schema of a table whose keys are options."""
    known = tuple(known)
    required = [each.name for each in known if each.required]
    return closed({each.name: each.schema for each in known}, required)


def _requirement(hint: Any) -> Requirement | None:
    """Return the requirement in an annotation, None where it has none."""
    if get_origin(hint) is Literal:
        return one_of(*get_args(hint))
    if get_origin(hint) is Annotated:
        given = (each() if callable(each) else each for each in get_args(hint)[1:])
        return next((each for each in given if isinstance(each, Requirement)), None)
    if get_origin(hint) in (types.UnionType, typing.Union):
        known = (_requirement(part) for part in get_args(hint))
        return next((each for each in known if each is not None), None)
    return None


def check_fields(record: Any) -> None:
    """Bring the fields of a record into plain Python.

    Raises InputError with everything that is wrong with single fields.
    """
    given = [(each, getattr(record, each.name)) for each in options(type(record))]
    given = [(each, value) for each, value in given if not (each.optional and value is None)]
    refuse(x for each, value in given if (x := each.requirement.fault(each.name, value)))
    for each, value in given:
        # The record is frozen for everybody else; it is not finished before this.
        object.__setattr__(record, each.name, each.requirement.convert(plain(value)))


def each_once(place: str, names: Iterable[str]) -> list[Fault]:
    """Return the faults of names that repeat."""
    return [Fault("", place, "each name once", f"'{name}' twice") for name in repeated(names)]


def repeated(names: Iterable[str]) -> list[str]:
    """Return the names that occur more than once."""
    return [name for name, count in Counter(names).items() if count > 1]


def is_number(value: object) -> bool:
    """Return whether a value is a finite number of which products are finite as well."""
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) <= LARGEST


def is_name(value: object) -> bool:
    """Return whether a value is a text that can be printed and is not blank."""
    return isinstance(value, str) and bool(value.strip()) and value.isprintable()


def plain(value: Any) -> Any:
    """Return numpy scalars and arrays, tuples and enumerations in the types that TOML knows."""
    if isinstance(value, np.generic | np.ndarray):
        return value.tolist()
    if isinstance(value, Enum):
        return value.value
    if isinstance(value, Mapping):
        return {key: plain(each) for key, each in value.items()}
    if isinstance(value, Sequence) and not isinstance(value, str | bytes):
        return [plain(each) for each in value]
    return value


def shown(value: object) -> str:
    """Return a value as a message shows it."""
    known = plain(value)
    if isinstance(known, bool):
        return str(known).lower()
    if isinstance(known, str):
        return repr(known)
    if isinstance(known, dict):
        return "a table"
    if isinstance(known, list):
        short = len(known) <= SHORT and not any(isinstance(x, dict) for x in known)
        return f"[{', '.join(map(shown, known))}]" if short else f"a list of {len(known)}"
    if isinstance(known, int | float) and LARGEST < abs(known) < math.inf:
        return f"a number beyond {LARGEST:g}"
    return str(known)
