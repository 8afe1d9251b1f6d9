"""Options that check themselves, with the same words in Python and in a file, and their schema.

An option is a field of a frozen dataclass. Its annotation has its requirement: a ``Literal``, or
``Annotated`` with a `Requirement`, or with a function that returns one when it is needed; ``None``
besides, where the annotation has it. `check_fields`, called from ``__post_init__``, as that of
`Checked` does, compares all fields with their requirements and brings their values into plain
Python: the same record is made from TOML, from literals and from numpy scalars. A `Table` of a TOML
file reads its keys by the same requirements, which are JSON Schemas (draft 7) as far as these go.
"""

import inspect
import math
import operator
import re
import tomllib
import types
import typing
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from enum import Enum
from functools import cache
from itertools import pairwise, repeat, starmap
from pathlib import Path
from typing import Annotated, Any, Literal, TypeVar, get_args, get_origin, get_type_hints

import numpy as np

from modefront.errors import Fault, InputError, refuse, refusing, suggestion
from modefront.inputs import MOST_TABLES, read_text_bytes
from modefront.rounding import LARGEST
from modefront.text import NAME as LENGTH
from modefront.text import Shown, clean

Schema = Mapping[str, Any]

WHOLE = 10**9  # largest whole number that a count or a place is

NUMBER: Schema = {"type": "number", "minimum": -LARGEST, "maximum": LARGEST}
ABOVE_ZERO: Schema = {"type": "number", "exclusiveMinimum": 0, "maximum": LARGEST}
NOT_NEGATIVE: Schema = {"type": "number", "minimum": 0, "maximum": LARGEST}
BELOW_ZERO: Schema = {"type": "number", "minimum": -LARGEST, "exclusiveMaximum": 0}
NAME: Schema = {"type": "string", "pattern": r"\S"}
TABLE: Schema = {"type": "object"}
OPEN: Schema = {"additionalProperties": True}
"""What a part of a schema says that leaves keys to others: some editors take them for unknown."""

TYPES: Mapping[str, Any] = {
    "string": str,
    "boolean": bool,
    "integer": int,
    "number": (int, float),
    "array": list,
    "object": dict,
}


def array(
    items: Schema | list[Schema], least: int = 0, most: int | None = None, *, once: bool = False
) -> Schema:
    """Return the schema of a list of ``least`` to ``most`` items: alike, or one after another."""
    ends = {"minItems": least} | ({} if most is None else {"maxItems": most})
    return {"type": "array", "items": items} | ends | ({"uniqueItems": True} if once else {})


def table_of(entries: Schema, least: int = 0) -> Schema:
    """Return the schema of a table of any names with entries that are alike."""
    return {"type": "object", "additionalProperties": entries, "minProperties": least}


def any_of(*schemas: Schema) -> Schema:
    """Return the schema of what meets one of several."""
    return {"anyOf": list(schemas)}


def closed(properties: Mapping[str, Schema], required: list[str]) -> Schema:
    """Return the schema of a table that has no other keys."""
    known = {"type": "object", "properties": dict(properties), "additionalProperties": False}
    return known | ({"required": required} if required else {})


def file_name(endings: Iterable[str], *, any_case: bool = False) -> Schema:
    """Return the schema of the name of a file, by its endings, in capitals or not."""
    known = ["".join(f"[{x}{x.upper()}]" if any_case else f"[{x}]" for x in y) for y in endings]
    return {"type": "string", "pattern": f"({'|'.join(known)})$"}


def chosen(key: str, schemas: Mapping[str, Schema]) -> Schema:
    """Return the schema of a table of which one key says which schema it meets besides.

    The keys of all of them are listed, for editors, and what is wrong is said of single keys.
    """
    known, cases = dict[str, Schema](), []
    for name, schema in schemas.items():
        of = schema.get("properties", {})
        said = {x: each.get("description") for x, each in of.items()}
        known |= {x: {"description": text, **OPEN} for x, text in said.items() if text}
        own: Schema = {"properties": {key: {"enum": [name]}}, "required": [key]}
        needed = {
            "properties": own["properties"] | of,
            "required": [key, *schema.get("required", [])],
        }
        cases.append({"if": {**own, **OPEN}, "then": {**schema, **needed}})
    listed = {key: {"enum": [*schemas]}, **known}
    return {"type": "object", "properties": listed, "required": [key], "allOf": cases}


KEYWORDS: Mapping[str, Callable[[Any, Any], bool]] = {
    "anyOf": lambda value, schemas: any(fits(value, each) for each in schemas),
    "enum": lambda value, known: isinstance(value, str) and value in known,
    "pattern": lambda value, pattern: bool(re.search(pattern, value)),
    "minimum": operator.ge,
    "maximum": operator.le,
    "exclusiveMinimum": operator.gt,
    "exclusiveMaximum": operator.lt,
    "items": lambda value, of: all(map(fits, value, of if isinstance(of, list) else repeat(of))),
    "minItems": lambda value, least: len(value) >= least,
    "maxItems": lambda value, most: len(value) <= most,
    "uniqueItems": lambda value, _: not any(x in value[:i] for i, x in enumerate(value)),
    "additionalProperties": lambda value, each: all(fits(x, each) for x in value.values()),
    "minProperties": lambda value, least: len(value) >= least,
}
"""Whether a value meets what a schema says under a keyword; others say nothing of single values."""


def fits(value: Any, schema: Schema) -> bool:
    """Return whether a value in plain Python meets a schema."""
    kind = TYPES.get(schema.get("type", ""), object)
    if not isinstance(value, kind) or (isinstance(value, bool) and kind not in (bool, object)):
        return False
    return all(KEYWORDS[key](value, said) for key, said in schema.items() if key in KEYWORDS)


T = TypeVar("T")

WITHOUT = "Without it: "
"""What a description says before the default of a key, where that is no single value."""

SHORT = 6  # longest list that a message shows item by item


@dataclass(frozen=True, eq=False)
class Requirement:
    """Requirement on the value of an option."""

    expected: str  # the same in words
    schema: Schema  # of such a value
    convert: Callable[[Any], Any] = lambda value: value  # into the form that is kept
    further: Callable[[Any], bool] = lambda _: True  # whether it meets what no schema says
    # reads the table of a key within another one, and says what is wrong with each of its entries;
    # None for values
    read: "Callable[[Table, str], Any] | None" = None
    entries: Schema = field(default_factory=dict)  # schema of a table that is read so

    def holds(self, value: Any) -> bool:
        """Return whether a value in plain Python is so."""
        return fits(value, self.schema) and self.further(value)

    @property
    def described(self) -> Schema:
        """Schema of a value in a file, with all that is within it, and its requirement in words."""
        return {"description": self.expected, **(self.entries or self.schema)}


def one_of(*choices: str) -> Requirement:
    """Return the requirement of one of several texts."""
    expected = "one of " + ", ".join(f"'{choice}'" for choice in choices)
    return Requirement(expected, {"enum": list(choices)})


def whole(least: int, most: int) -> Requirement:
    """Return the requirement of a whole number within limits."""
    schema = {"type": "integer", "minimum": least, "maximum": most}
    return Requirement(f"a whole number from {least} to {most}", schema)


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

    def read(outer: Table, key: str) -> Any:
        table = outer.table(key, expected)
        return table and table.record(record)

    return Requirement(
        expected, {}, further=lambda x: isinstance(x, record), read=read, entries=schema_of(record)
    )


def entries(expected: str, schema: Schema) -> Requirement:
    """Return the requirement of a table that is read later, entry by entry."""
    return Requirement(expected, {}, read=lambda table, key: table.values.get(key), entries=schema)


def mapping(expected: str, each: Requirement) -> Requirement:
    """Return the requirement of a table of any names, of which each value meets another one."""

    def read(outer: Table, key: str) -> dict[str, Any]:
        table = outer.table(key, expected)
        values = {name: table.value(name, each) for name in table.values} if table else {}
        return {name: value for name, value in values.items() if value is not None}

    return Requirement(expected, TABLE, entries=table_of(each.schema), read=read)


PAIR = array(NUMBER, 2, 2)  # schema of two numbers


def rising(values: Sequence[float]) -> bool:
    """Return whether each number is greater than the one before it."""
    return all(a < b for a, b in pairwise(values))


TRUE_OR_FALSE = Requirement("true or false", {"type": "boolean"})


@dataclass(frozen=True)
class Option:
    """A key of a table, and the field of that name where a record of options is made of it."""

    name: str  # of the field, and of the key of a table
    requirement: Requirement  # what its value has to be
    optional: bool = False  # whether None is right as well
    required: bool = False  # whether it has no default
    # the default in plain Python; None where it has none, or follows from other values
    default: Any = None
    meaning: str = ""  # of the field, from the docstring of the record

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


@cache
def _arguments(record: Callable[..., Any]) -> list[tuple[inspect.Parameter, Any, str]]:
    """Return the arguments of a class or function with their annotations and meanings."""
    hints = get_type_hints(record, include_extras=True)
    _, _, section = (inspect.getdoc(record) or "").partition("\n----------\n")
    form = r"^([\w, ]+)(?: : |\n    )(.*(?:\n    .*)*)"  # of Attributes, or of Parameters
    meanings = {
        name: " ".join(text.split()).replace("``", "`").rstrip(".")
        for names, text in re.findall(form, section, re.MULTILINE)
        for name in names.split(", ")
    }
    arguments = inspect.signature(record).parameters.items()
    return [(x, hints[name], meanings.get(name, "")) for name, x in arguments]


def _option(argument: inspect.Parameter, hint: Any, meaning: str) -> Option | None:
    if not (requirement := _requirement(hint)):
        return None
    required, optional = argument.default is argument.empty, types.NoneType in get_args(hint)
    default = None if required else plain(argument.default)
    if default in ("", []) or not fits(default, requirement.schema):
        default = None
    return Option(argument.name, requirement, optional, required, default, meaning)


def options(record: Callable[..., Any]) -> tuple[Option, ...]:
    """Return the fields of a class of records, or arguments of a function, with requirements."""
    return tuple(filter(None, starmap(_option, _arguments(record))))


def schema_of(record: Callable[..., Any]) -> Schema:
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
    origin, parts = get_origin(hint), get_args(hint)
    if origin is Literal:
        return one_of(*parts)
    known: Iterable[Any] = ()
    if origin is Annotated:
        known = (each() if callable(each) else each for each in parts[1:])
    elif origin in (types.UnionType, typing.Union):
        known = map(_requirement, parts)
    return next((each for each in known if isinstance(each, Requirement)), None)


def check_fields(record: Any) -> None:
    """Bring the fields of a record into plain Python.

    Raises InputError with everything that is wrong with single fields.
    """
    given = [(each, getattr(record, each.name)) for each in options(type(record))]
    given = [(each, value) for each, value in given if not (each.optional and value is None)]
    refuse(
        Fault("", each.name, each.requirement.expected, shown(value))
        for each, value in given
        if not each.requirement.holds(plain(value))
    )
    for each, value in given:
        # The record is frozen for everybody else; it is not finished before this.
        object.__setattr__(record, each.name, each.requirement.convert(plain(value)))


class Checked(Shown):
    """What frozen dataclasses of options are: they raise InputError for wrong fields."""

    def __post_init__(self) -> None:
        """Bring the fields into plain Python, see `check_fields`."""
        check_fields(self)


def each_once(place: str, names: Iterable[str]) -> list[Fault]:
    """Return the faults of names that repeat."""
    return [Fault("", place, "each name once", f"'{name}' twice") for name in repeated(names)]


def repeated(names: Iterable[str]) -> list[str]:
    """Return the names that occur more than once."""
    return [name for name, count in Counter(names).items() if count > 1]


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
    return "nothing" if known is None else str(known)


@dataclass
class Table:
    """One table of a TOML file.

    Readers of values return a default where there is no value, and note a fault and return None
    where there is none either (a default of ``...``); a value that is wrong is a fault, too.
    """

    file: str  # the TOML file
    place: str  # where the table is in it, for messages; empty for the top level
    values: dict[str, Any]  # what the table holds
    faults: list[Fault]  # all that is wrong with the file, shared by its tables
    requested: list[str] = field(default_factory=list)  # keys that were read or are known
    files: list[Path] = field(default_factory=list)  # that the tables name, shared; see `path`
    notes: list[object] = field(default_factory=list)  # of what was found beside faults, shared

    def fault(self, key: str, expected: str, found: str) -> None:
        """Note that something is wrong; an empty key means the table itself."""
        known = key if key.isprintable() else repr(key)
        place = f"{self.place} {known}".strip() or "top level"
        self.faults.append(Fault(self.file, place, expected, found))

    def note(self, faults: Iterable[Fault]) -> None:
        """Note faults whose places are keys of the table."""
        for fault in faults:
            self.fault(fault.place, fault.expected, fault.found)

    @contextmanager
    def noting(self, key: str = "") -> Iterator[None]:
        """Note the faults of options, in keys of the table, and of files, both behind a ``key``."""
        try:
            yield
        except InputError as error:
            before = f"{self.place} {key}, " if key else ""
            for fault in error.faults:
                if fault.file:
                    self.faults.append(replace(fault, place=before + fault.place))
                else:
                    self.fault(f"{key} {fault.place}".strip(), fault.expected, fault.found)

    def path(self, name: str) -> Path:
        """Return the path of a file that a table names, relative to the TOML file, and note it."""
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
        if requirement.read:
            return requirement.read(self, key)
        if value is not None and requirement.holds(value):
            return requirement.convert(value)
        self.fault(key, requirement.expected, shown(value))
        return None if default is ... else default

    def text(self, key: str, expected: str = "a text", default: Any = ...) -> Any:
        """Return a text of printable characters that is not empty."""
        return self.value(key, text(expected), default)

    def read(self, known: Iterable[Option]) -> dict[str, Any] | None:
        """Return the values of keys that are given, None where anything is wrong with the table."""
        before = len(self.faults)
        values: dict[str, Any] = {}
        for option in known:
            if option.required or option.name in self.values:
                values[option.name] = self.value(option.name, option.requirement)
            self.requested.append(option.name)
        self.close()
        return values if len(self.faults) == before else None

    def record(self, record: Callable[..., T]) -> T | None:
        """Return the record of options whose fields are the keys; None where something is wrong."""
        values = self.read(options(record))
        with self.noting():
            return None if values is None else record(**values)
        return None

    def table(self, key: str, expected: str = "a table", default: Any = ...) -> "Table | None":
        """Return a table within this one."""
        value = self.value(key, Requirement(expected, TABLE), default)
        if value is None:
            return None
        place = f"{self.place} {key}".strip() if self.place else f"[{key}]"
        return replace(self, place=place, values=value, requested=[])

    def entries(
        self, key: str, each: str, *, required: bool = True
    ) -> "Iterator[tuple[str, Table]]":
        """Yield the tables within a table by their names; ``each`` says in words what one holds."""
        what = key.removesuffix("s")
        table = self.table(key, f"a table of {what}s", ... if required else None)
        if table and required and not table.values:
            table.fault("", f"at least one {what}", "none")
        for name in table.values if table else ():
            if table and (entry := table.table(name, each)):
                yield name, entry

    def content(self, key: str, read: Callable[[Path], T]) -> T | None:
        """Return what is read from a file, None without its name; note what is wrong with it."""
        name: Any = self.values.get(key)
        with self.noting():
            return read(self.path(name)) if is_name(name) else None
        return None

    def tables(self, key: str, required: bool) -> "list[Table]":
        """Return the tables of a list, such as ``[[parameter]]``."""
        path = f"{self.place.strip('[]')}.{key}".lstrip(".")
        expected = f"at least one table [[{path}]]" if required else f"tables [[{path}]]"
        value = self.value(key, Requirement(expected, array(TABLE, 1)), ... if required else [])
        out = []
        for k, item in enumerate(value or [], start=1):
            named = f" ({item['name']!r})" if isinstance(item.get("name"), str) else ""
            place = f"[[{path}]] {k}{named}"
            out.append(replace(self, place=place, values=item, requested=[]))
        return out

    def close(self) -> None:
        """Note every unknown key, once."""
        for k, key in enumerate(key for key in self.values if key not in set(self.requested)):
            found = suggestion(key, self.requested) if k < 20 else repr(clean(key, LENGTH))
            self.fault("", "a known key", found)
        self.requested += self.values


def read_toml(path: Path, expected: str) -> tuple[Table, bytes]:
    """Return the top level of a TOML file, and its content.

    Raises InputError where it cannot be read; ``expected`` says what it should be.
    """
    content = read_text_bytes(path, expected, MOST_TABLES)
    with refusing(path, "TOML in UTF-8", ValueError, RecursionError):
        values = tomllib.loads(content.decode("utf-8-sig"))
    return Table(str(path), "", values, []), content


def names_of(tables: Iterable[Table]) -> list[str]:
    """Return what tables of a list say as their names."""
    return [name for table in tables if isinstance(name := table.values.get("name"), str)]
