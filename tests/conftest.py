"""Settings and fixtures of all tests."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import settings
from refusals import Check, command

from modefront.work.costs import Costs, counted

settings.register_profile("modefront", deadline=None, derandomize=True, print_blob=False)
settings.load_profile("modefront")


@pytest.fixture
def costs() -> Iterator[Costs]:
    """Count what the test spends."""
    with counted() as spent:
        yield spent


@pytest.fixture
def refused(capsys: pytest.CaptureFixture[str]) -> Check:
    """Assert that a run refuses a study, say these things, and write nothing.

    What is said is given as ``place: expected ... found ...`` with " ... " for any text between.
    """

    def refuse(study: Path, *says: str) -> None:
        output = study.parent / "output"
        status = command("run", study, "-o", output)
        out, err = capsys.readouterr()
        assert status == 2, err
        assert out == ""
        lines = err.splitlines()
        for line in lines:
            assert re.fullmatch(r"\S.*: .+: expected .+, found .+", line), line
            assert line.startswith(str(study.parent)), "the file is named"
        for text in says:
            pattern = ".*".join(map(re.escape, text.split(" ... ")))
            assert any(re.search(pattern, line) for line in lines), (text, err)
        assert not output.exists()
        assert not list(study.parent.glob("*-results"))

    return refuse
