"""The trials of `tasks.py trials`, in a short form."""

from __future__ import annotations

from pathlib import Path

import pytest

from trials import fuzz, killed


@pytest.mark.slow
def test_inputs_that_are_spoilt_by_chance(tmp_path: Path) -> None:
    outcome = fuzz(tmp_path, 45, seed=20)
    assert not outcome.wrong
    assert sum(outcome.ends.values()) == 45


@pytest.mark.slow
def test_runs_that_are_killed(tmp_path: Path) -> None:
    outcome = killed(tmp_path, 2, seed=20)
    assert not outcome.wrong
