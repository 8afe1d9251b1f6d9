"""Records as bytes, and back to the last digit; nothing that is read is executed.

Fields hold records, arrays, numbers, texts, None, and tuples, lists and dictionaries of these.
"""

import json
from collections.abc import Mapping
from enum import Enum
from typing import IO, Any, TypeVar

import numpy as np

from modefront._typing import Floats

C = TypeVar("C", bound=type)

_REGISTERED: dict[str, type] = {}


def record(kind: C) -> C:
    """Register a frozen dataclass or an enumeration as one that is kept."""
    _REGISTERED[kind.__name__] = kind
    return kind


def dump(value: Any, stream: IO[bytes]) -> None:
    """Write a value; raises TypeError for an object of a class that is not registered."""
    arrays: dict[str, Any] = {}
    head = json.dumps(encode(value, arrays)).encode()
    np.savez(stream, allow_pickle=False, head=np.frombuffer(head, np.uint8), **arrays)


def load(stream: IO[bytes]) -> Any:
    """Return the value that `dump` has written."""
    with np.load(stream, allow_pickle=False) as file:
        arrays = {key: file[key] for key in file.files}
    return decode(json.loads(arrays.pop("head").tobytes()), arrays)


def encode(value: Any, arrays: dict[str, Floats]) -> Any:
    """Return a value as JSON has it, with its arrays put into ``arrays``.

    Raises TypeError for an object of a class that is not registered.
    """
    if isinstance(value, np.ndarray):
        name = str(len(arrays))
        arrays[name] = value
        return {"array": name}
    if isinstance(value, np.generic):
        return value.item()
    if value is None or isinstance(value, bool | int | float | str):
        return value
    if isinstance(value, tuple | list):
        parts = [encode(part, arrays) for part in value]
        return {"tuple": parts} if isinstance(value, tuple) else parts
    if isinstance(value, Mapping):
        return {"map": [[encode(k, arrays), encode(x, arrays)] for k, x in value.items()]}
    name = type(value).__name__
    if _REGISTERED.get(name) is not type(value):
        raise TypeError(f"expected a registered record, found {type(value)}")
    if isinstance(value, Enum):
        return {"enum": name, "member": value.name}
    named = {x: encode(getattr(value, x), arrays) for x in vars(value)}
    return {"record": name, "fields": named}


def decode(value: Any, arrays: Mapping[str, Floats]) -> Any:
    """Return the value that `encode` has made this of.

    Raises ValueError, KeyError or TypeError for what `encode` does not make.
    """
    if isinstance(value, list):
        return [decode(part, arrays) for part in value]
    if not isinstance(value, dict):
        return value
    if "array" in value:
        return arrays[value["array"]]
    if "tuple" in value:
        return tuple(decode(part, arrays) for part in value["tuple"])
    if "map" in value:
        return {decode(k, arrays): decode(x, arrays) for k, x in value["map"]}
    kind: Any = _REGISTERED[value.get("enum") or value["record"]]
    if "enum" in value:
        return kind[value["member"]]
    return kind(**{name: decode(part, arrays) for name, part in dict(value["fields"]).items()})
