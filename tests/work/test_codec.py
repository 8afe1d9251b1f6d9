"""Records that are kept come back as they were, and nothing else comes back at all."""

from __future__ import annotations

import io
import json
from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays

from modefront.work.codec import dump, load, record


@record
class Colour(Enum):
    """An enumeration of which members have equal beginnings."""

    RED = "red"
    REDDISH = "reddish"


@record
@dataclass(frozen=True)
class Leaf:
    """A record that holds anything."""

    value: Any
    name: str = ""


@dataclass(frozen=True)
class Unknown:
    """A record that is not registered."""

    value: int = 0


numbers = (
    st.floats(allow_nan=True, allow_infinity=True)
    | st.sampled_from([-0.0, 5e-324, 1.7976931348623157e308, 0.1 + 0.2])
    | st.integers(-(2**70), 2**70)
)
texts = st.text() | st.sampled_from(["record", "array", "tuple", "map", "enum", "\ud800", "\0"])
plain = st.none() | st.booleans() | numbers | texts | st.sampled_from(Colour)
floats = arrays(np.float64, array_shapes(min_dims=0, max_dims=3, min_side=0, max_side=3))
integers = arrays(np.int64, array_shapes(min_side=0, max_side=3))
flags = arrays(np.bool_, array_shapes(min_side=0, max_side=3))
keys = texts | st.integers() | st.tuples(st.integers(), texts)
values = st.recursive(
    plain | floats | integers | flags,
    lambda part: (
        st.lists(part, max_size=3)
        | st.lists(part, max_size=3).map(tuple)
        | st.dictionaries(keys, part, max_size=3)
        | st.builds(Leaf, part, texts)
    ),
    max_leaves=12,
)


def through(value: Any) -> Any:
    """Return a value after it was written and read."""
    dump(value, stream := io.BytesIO())
    stream.seek(0)
    return load(stream)


def alike(first: Any, other: Any) -> bool:
    """Return whether two values have the same types, keys, order and bits."""
    if type(first) is not type(other):
        return False
    if isinstance(first, np.ndarray):
        same = first.shape == other.shape and first.dtype == other.dtype
        return same and first.tobytes() == other.tobytes()
    if isinstance(first, list | tuple):
        return len(first) == len(other) and all(map(alike, first, other))
    if isinstance(first, dict):
        return alike(list(first), list(other)) and alike(list(first.values()), list(other.values()))
    if isinstance(first, Leaf):
        return alike(vars(first), vars(other))
    if isinstance(first, float):
        return np.float64(first).tobytes() == np.float64(other).tobytes() or (
            first != first != other
        )
    return bool(first == other)


@given(values)
def test_nested_records_come_back_to_the_last_bit(value: Any) -> None:
    assert alike(through(value), value)


def test_what_is_easily_mistaken_is_told_apart() -> None:
    value = Leaf((-0.0, [1, 1.0, True, "1", None], {"tuple": (1,), "record": []}), "enum")
    assert alike(through(value), value)
    assert str(through(-0.0)) == "-0.0"
    assert alike(through(np.zeros((0, 3))), np.zeros((0, 3)))
    assert through(Colour.REDDISH) is Colour.REDDISH


@pytest.mark.parametrize("number", [np.float64(0.1), np.int64(3), np.bool_(True)])
def test_numbers_of_numpy_become_plain_ones(number: Any) -> None:
    assert alike(through(number), number.item())


@pytest.mark.parametrize(
    "value",
    [Unknown(), Leaf(Unknown()), [Unknown()], {"x": Unknown()}, Path("x"), {1, 2}, 1j, b"x"],
)
def test_other_classes_are_refused(value: Any) -> None:
    with pytest.raises(TypeError, match="expected a registered record, found"):
        dump(value, io.BytesIO())


def test_a_class_of_the_same_name_is_refused() -> None:
    other: Any = dataclass(frozen=True)(type("Leaf", (), {"__annotations__": {"value": Any}}))
    with pytest.raises(TypeError, match="expected a registered record"):
        dump(other(1), io.BytesIO())


@pytest.mark.parametrize(
    "text",
    [
        '{"record": "Unknown", "fields": []}',
        '{"record": "Leaf", "fields": [1, 2, 3]}',
        '{"record": "Leaf", "fields": 1}',
        '{"record": "Leaf"}',
        '{"record": "Colour", "fields": []}',
        '{"record": "Colour", "fields": ["green"]}',
        '{"record": "Path", "fields": []}',
        '{"array": "7"}',
        '{"array": []}',
        '{"map": [[1, 2, 3]]}',
        '{"map": [[[], 1]]}',
        '{"tuple": 1}',
        "{}",
    ],
)
def test_what_was_not_encoded_is_an_error_that_readers_expect(text: str) -> None:
    np.savez(stream := io.BytesIO(), head=np.frombuffer(text.encode(), np.uint8))
    stream.seek(0)
    with pytest.raises((ValueError, KeyError, TypeError)):
        load(stream)


def test_arrays_are_kept_once_each_and_not_as_text() -> None:
    array = np.array([np.nan, -0.0, np.inf])
    dump([Leaf(array), Leaf(array[:1])], stream := io.BytesIO())
    stream.seek(0)
    with np.load(stream) as file:
        assert len(file.files) == 3
        assert "nan" not in json.dumps(json.loads(file["head"].tobytes())).lower()
    assert alike(through([Leaf(array), Leaf(array[:1])]), [Leaf(array), Leaf(array[:1])])
