"""The examples that ``init`` writes."""

from pathlib import Path

import pytest

from modefront.errors import InputError
from modefront.study.check import check
from modefront.study.examples import names, write_example
from modefront.study.file import load


def test_the_promised_examples_are_there() -> None:
    assert {"three-story-c0", "three-story-c1"} <= set(names())


@pytest.mark.parametrize("name", names())
def test_each_example_is_written_whole_and_is_sound(name: str, tmp_path: Path) -> None:
    written = write_example(name, tmp_path / "new" / "folder")
    assert sorted(written) == sorted((tmp_path / "new" / "folder").iterdir())
    study = load(tmp_path / "new" / "folder" / "study.toml")
    assert check(study).sound


def test_nothing_is_overwritten(tmp_path: Path) -> None:
    (tmp_path / "modes.csv").write_text("mine")
    with pytest.raises(InputError, match="nothing is overwritten, found an existing one"):
        write_example("three-story-c0", tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["modes.csv"]
    assert (tmp_path / "modes.csv").read_text() == "mine"


def test_every_file_in_the_way_is_named_links_to_nothing_too(tmp_path: Path) -> None:
    (tmp_path / "modes.csv").write_text("mine")
    (tmp_path / "study.toml").symlink_to(tmp_path / "elsewhere")
    with pytest.raises(InputError) as caught:
        write_example("three-story-c0", tmp_path)
    assert len(caught.value.faults) == 2
    assert not (tmp_path / "elsewhere").exists()


def test_an_unknown_example_is_answered_with_the_known_ones(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"expected one of ambient-test, calculix, .*did you mean"):
        write_example("three-story", tmp_path / "new")
    assert not (tmp_path / "new").exists()
