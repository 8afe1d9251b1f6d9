"""Records as bytes, and back to the last digit; nothing that is read is executed.

Fields hold records, arrays, numbers, texts, None, and tuples, lists and dictionaries of these.
"""

import json
from collections.abc import Mapping
from enum import Enum
from functools import partial
from typing import IO, Any, TypeVar

import numpy as np

C = TypeVar("C", bound=type)

_REGISTERED: dict[str, type] = {}


def record(kind: C) -> C:
    """Register a frozen dataclass or an enumeration as one that is kept."""
    _REGISTERED[kind.__name__] = kind
    return kind


def dump(value: Any, stream: IO[bytes]) -> None:
    """Write a value; raises TypeError for an object of a class that is not registered."""
    arrays: dict[str, Any] = {}
    head = json.dumps(_encoded(value, arrays)).encode()
    np.savez(stream, allow_pickle=False, head=np.frombuffer(head, np.uint8), **arrays)


def load(stream: IO[bytes]) -> Any:
    """Return the value that `dump` has written.

    Raises ValueError, LookupError or TypeError for what it does not write.
    """
    with np.load(stream, allow_pickle=False) as file:
        arrays = {key: file[key] for key in file.files}
    head = arrays.pop("head").tobytes()
    return json.loads(head, object_hook=partial(_decoded, arrays=arrays))


def _encoded(value: Any, arrays: dict[str, Any]) -> Any:
    """Return a value as JSON has it, with its arrays put into ``arrays``."""
    if isinstance(value, np.ndarray):
        name = str(len(arrays))
        arrays[name] = value
        return {"array": name}
    if isinstance(value, np.generic):
        return value.item()
    if value is None or isinstance(value, bool | int | float | str):
        return value
    if isinstance(value, tuple | list):
        parts = [_encoded(part, arrays) for part in value]
        return {"tuple": parts} if isinstance(value, tuple) else parts
    if isinstance(value, Mapping):
        return {"map": [[_encoded(k, arrays), _encoded(x, arrays)] for k, x in value.items()]}
    name = type(value).__name__
    if _REGISTERED.get(name) is not type(value):
        raise TypeError(f"expected a registered record, found {type(value)}")
    fields = [value.value] if isinstance(value, Enum) else vars(value).values()
    return {"record": name, "fields": [_encoded(x, arrays) for x in fields]}


def _decoded(value: dict[str, Any], arrays: Mapping[str, Any]) -> Any:
    """Return what an object of JSON stands for, of which the parts are decoded."""
    if "array" in value:
        return arrays[value["array"]]
    if "tuple" in value:
        return tuple(value["tuple"])
    if "map" in value:
        return dict(value["map"])
    return _REGISTERED[value["record"]](*value["fields"])
