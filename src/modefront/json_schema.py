"""JSON Schema (draft 7) of single values, and the test whether a value in plain Python meets it."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from typing import Any

from modefront.rounding import LARGEST

Schema = Mapping[str, Any]

WHOLE = 10**9
"""Largest whole number that a count or a place is."""

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


def whole_number(least: int, most: int) -> Schema:
    """Return the schema of a whole number within limits."""
    return {"type": "integer", "minimum": least, "maximum": most}


def array(items: Schema, least: int = 0, most: int | None = None, *, once: bool = False) -> Schema:
    """Return the schema of a list of a number of items from ``least`` to ``most``."""
    ends = {"minItems": least} | ({} if most is None else {"maxItems": most})
    return {"type": "array", "items": items} | ends | ({"uniqueItems": True} if once else {})


def pair(first: Schema, second: Schema) -> Schema:
    """Return the schema of a list of two."""
    return {"type": "array", "items": [first, second], "minItems": 2, "maxItems": 2}


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


def either(*keys: str) -> Schema:
    """Return what a schema says in addition of a table that has one of several keys, not more."""
    return {"oneOf": [{"required": [key]} for key in keys]}


def chosen(key: str, schemas: Mapping[str, Schema]) -> Schema:
    """Return the schema of a table of which one key says which schema it meets besides.

    The keys of all of them are listed, for editors, and what is wrong is said of single keys.
    """
    known: dict[str, Schema] = {}
    for schema in schemas.values():
        said = {
            name: each.get("description") for name, each in schema.get("properties", {}).items()
        }
        known |= {name: {"description": text, **OPEN} for name, text in said.items() if text}
    cases = []
    for name, schema in schemas.items():
        own: Schema = {"properties": {key: {"enum": [name]}}, "required": [key]}
        properties = own["properties"] | schema.get("properties", {})
        then = {**schema, "properties": properties, "required": [key, *schema.get("required", [])]}
        cases.append({"if": {**own, **OPEN}, "then": then})
    listed = {key: {"enum": [*schemas]}, **known}
    return {"type": "object", "properties": listed, "required": [key], "allOf": cases}


def fits(value: Any, schema: Schema) -> bool:
    """Return whether a value in plain Python meets a schema."""
    if "anyOf" in schema:
        return any(fits(value, each) for each in schema["anyOf"])
    if "enum" in schema:
        return isinstance(value, str) and value in schema["enum"]
    kind = schema.get("type")
    if kind and (
        not isinstance(value, TYPES[kind]) or isinstance(value, bool) != (kind == "boolean")
    ):
        return False
    if kind == "string":
        return bool(re.search(schema.get("pattern", ""), value))
    if kind in ("integer", "number"):
        return (
            schema.get("minimum", value) <= value <= schema.get("maximum", value)
            and ("exclusiveMinimum" not in schema or value > schema["exclusiveMinimum"])
            and ("exclusiveMaximum" not in schema or value < schema["exclusiveMaximum"])
        )
    if kind == "array":
        return _is_array(value, schema)
    if kind == "object" and "additionalProperties" in schema:
        entries = schema["additionalProperties"]
        return len(value) >= schema["minProperties"] and all(
            fits(x, entries) for x in value.values()
        )
    return True


def _is_array(value: list[Any], schema: Schema) -> bool:
    """Return whether number and items of a list are those of a schema; ``items`` may be a list."""
    items = schema.get("items", {})
    each = items if isinstance(items, list) else [items] * len(value)
    return (
        schema.get("minItems", 0) <= len(value) <= schema.get("maxItems", len(value))
        and all(map(fits, value, each))
        and not (schema.get("uniqueItems") and any(x in value[:i] for i, x in enumerate(value)))
    )
