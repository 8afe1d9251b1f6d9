"""Runs of the command that are to be refused."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from faultless import STUDY

from modefront.cli.main import main

Check = Callable[..., None]


def command(*arguments: object) -> int:
    """Run the command in this process and return its exit status."""
    before = sys.argv
    sys.argv = ["modefront", *map(str, arguments)]
    try:
        with pytest.raises(SystemExit) as left:
            main()
    finally:
        sys.argv = before
    assert isinstance(left.value.code, int)
    return left.value.code


def edited(text: str, *edits: tuple[str, str]) -> str:
    """Return a text with each old part, which has to be there, replaced by a new one."""
    for old, new in edits:
        assert old in text, old
        text = text.replace(old, new, 1)
    return text


def refuses(*rows: tuple[str, str, str], study: str = STUDY) -> Callable[..., None]:
    """Return a test that a study with a new part for an old one is refused, and what is said."""

    @pytest.mark.parametrize(("old", "new", "says"), rows)
    def test(old: str, new: str, says: str, folder: Path, refused: Check) -> None:
        (folder / "wrong.toml").write_text(edited(study, (old, new)))
        refused(folder / "wrong.toml", says)

    return test
