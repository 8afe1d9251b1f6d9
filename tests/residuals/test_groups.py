"""Groups of measured properties, and their errors."""

import pickle
from typing import Any

import numpy as np
import pytest

from modefront.data.modal import modal_data
from modefront.residuals.groups import KINDS, Group, faults


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (
            {"frequency": "al"},
            "group 'f': frequency: expected 'all' or a list of measured modes, counted from 1, "
            "each once, found 'al'",
        ),
        ({"shape": [0]}, "shape: expected 'all' or a list .* found \\[0\\]"),
        ({"shape": [1, 1]}, "shape: expected 'all' or a list .* each once, found \\[1, 1\\]"),
        ({"shape": [True]}, "shape: expected 'all' or a list .* found \\[True\\]"),
        ({"frequency": 1}, "frequency: expected 'all' or a list .* found 1"),
        ({"frequncy": "all"}, "expected one of frequency, shape, .*did you mean 'frequency'"),
        ({"scale": "sdt"}, "scale: expected 'measured' or 'std', found 'sdt'"),
    ],
)
def test_a_group_refuses_what_is_no_member(arguments: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        Group("f", **arguments)


def test_equal_groups_are_equal_however_they_are_written() -> None:
    group = Group("g", shape="all", frequency=[1, 2])
    assert group == Group("g", frequency=(1, 2), shape="all")
    assert group == Group("g", frequency=range(1, 3), shape="all")
    assert hash(group) == hash(Group("g", frequency=(1, 2), shape="all"))
    assert pickle.loads(pickle.dumps(group)) == group
    assert Group("f", frequency="all", shape=()) == Group("f", frequency="all")
    assert group.modes_of("frequency") == (1, 2)
    assert Group("s", shape="all").modes_of("frequency") == ()


def test_kinds_may_be_given_by_position() -> None:
    assert Group("f", "all") == Group("f", frequency="all")
    assert Group("s", (), [2, 1]) == Group("s", shape=[2, 1])
    whole = Group("w", [1], [2], [1, 3])
    assert whole == Group("w", frequency=[1], shape=[2], subspace=[1, 3])
    with pytest.raises(ValueError, match=r"each of frequency, shape.* once at most"):
        Group("f", "all", frequency="all")
    with pytest.raises(ValueError, match=r"each of frequency, shape.* once at most"):
        Group("f", "all", (), (), ())


def test_kinds_have_names_of_their_own() -> None:
    assert not {"name", "scale"} & set(KINDS)


def test_faults_name_the_first_mode_of_each_kind_that_is_not_measured() -> None:
    data = modal_data(
        np.array([1.0, np.nan, 3.0]), np.ones((3, 2)) * [[1], [1], [np.nan]], ("a", "b")
    )
    wrong = Group("w", frequency=[1, 2, 9], shape=[3, 2])
    assert list(faults(wrong, data)) == [
        ("frequency", "one of the measured modes [1, 3]", "2"),
        ("shape", "one of the measured modes [1, 2]", "3"),
    ]
    assert list(faults(wrong, None)) == []
    assert [found for *_, found in faults(Group("e"), None)] == ["nothing"]
    none = modal_data(np.full(3, np.nan), np.ones((3, 2)), ("a", "b"))
    (fault,) = faults(Group("f", frequency="all"), none)
    assert fault == ("", "at least one measured property", "none in the data")
    std = Group("s", frequency=[1, 3], shape=[2], scale="std")
    assert [key for key, *_ in faults(std, data)] == ["scale"] * 3
    known = modal_data(
        np.array([1.0, 2.0, 3.0]),
        np.ones((3, 2)),
        ("a", "b"),
        frequency_std=np.array([1e-3, 1e-10, 1e-8]),
    )
    (fault,) = faults(Group("s", frequency="all", scale="std"), known)
    assert fault[2] == "others for the frequency of mode 2"
