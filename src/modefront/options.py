"""Options that check themselves, with the same words in Python and in a file.

An option is a field of a frozen dataclass. Its annotation has its requirement: a ``Literal``, or
``Annotated`` with a `Requirement`, or with a function that returns one when it is needed; ``None``
besides, where the annotation has it. `check_fields`, called from ``__post_init__``, compares all
fields with their requirements and brings their values into plain Python: the same record is made
from TOML (`modefront.toml.Table`), from literals and from numpy scalars.
"""

from __future__ import annotations

import math
import types
import typing
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import MISSING, dataclass, fields
from enum import Enum
from typing import Annotated, Any, Literal, get_args, get_origin, get_type_hints

import numpy as np

from modefront.errors import Fault, refuse
from modefront.rounding import LARGEST

SHORT = 6
"""Longest list that a message shows item by item."""


@dataclass(frozen=True)
class Requirement:
    """Requirement on the value of an option.

    Attributes
    ----------
    expected : the same in words
    holds : whether a value in plain Python is so
    convert : brings such a value into the form that is kept
    record : the class of a nested record, read from a table within the table; None for a value
    """

    expected: str
    holds: Callable[[Any], bool]
    convert: Callable[[Any], Any] = lambda value: value
    record: type | None = None

    def fault(self, place: str, value: object) -> Fault | None:
        """Return the fault of a value, None where it has none."""
        return None if self.holds(plain(value)) else Fault("", place, self.expected, shown(value))


def one_of(*choices: str) -> Requirement:
    """Return the requirement of one of several texts."""
    expected = "one of " + ", ".join(f"'{choice}'" for choice in choices)
    return Requirement(expected, lambda value: isinstance(value, str) and value in choices)


def whole(least: int, most: int) -> Requirement:
    """Return the requirement of a whole number within limits."""
    return Requirement(
        f"a whole number from {least} to {most}",
        lambda value: (
            isinstance(value, int) and not isinstance(value, bool) and least <= value <= most
        ),
    )


def number(expected: str, holds: Callable[[float], bool] = math.isfinite) -> Requirement:
    """Return the requirement of a finite number that passes a test."""
    return Requirement(expected, lambda value: is_number(value) and holds(value), float)


def numbers(expected: str, holds: Callable[[list[float]], bool]) -> Requirement:
    """Return the requirement of a list of finite numbers that passes a test."""
    return Requirement(
        expected,
        lambda value: isinstance(value, list) and all(map(is_number, value)) and holds(value),
        lambda value: tuple(map(float, value)),
    )


def text(expected: str) -> Requirement:
    """Return the requirement of a text of printable characters that is not blank."""
    return Requirement(expected, is_name)


def nested(expected: str, record: type) -> Requirement:
    """Return the requirement of another record of options."""
    return Requirement(expected, lambda value: isinstance(value, record), record=record)


TRUE_OR_FALSE = Requirement("true or false", lambda value: isinstance(value, bool))


@dataclass(frozen=True)
class Option:
    """A field of a record of options.

    Attributes
    ----------
    name : of the field, and of the key of a table
    requirement : what its value has to be
    optional : whether None is right as well
    required : whether it has no default
    """

    name: str
    requirement: Requirement
    optional: bool
    required: bool


def options(record: type) -> tuple[Option, ...]:
    """Return the fields of a class of records that have requirements."""
    hints = get_type_hints(record, include_extras=True)
    out = []
    for field in fields(record):
        requirement = _requirement(hints[field.name])
        if requirement is not None:
            required = field.default is MISSING and field.default_factory is MISSING
            optional = types.NoneType in get_args(hints[field.name])
            out.append(Option(field.name, requirement, optional, required))
    return tuple(out)


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
