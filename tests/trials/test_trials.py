"""The trials of `tasks.py spoil`, in a short form."""

from __future__ import annotations

from pathlib import Path

import pytest
from sources import READING, RUNS, right_files

from trials import damaged, failing, fuzz, killed


@pytest.mark.slow(25)
def test_inputs_that_are_spoilt_by_chance(tmp_path: Path) -> None:
    cases = right_files(tmp_path)
    outcome = fuzz(tmp_path, cases, 2 * len(cases), seed=20)
    assert not outcome.wrong
    assert sum(outcome.ends.values()) == 2 * len(cases)


@pytest.mark.slow(25)
def test_results_that_are_damaged(tmp_path: Path) -> None:
    right_files(tmp_path)
    assert not damaged(tmp_path, READING, 70, seed=20).wrong


@pytest.mark.slow(20)
def test_runs_that_are_killed_and_drives_that_fail(tmp_path: Path) -> None:
    right_files(tmp_path)
    assert not killed(tmp_path, RUNS[0], 2, seed=20).wrong
    assert not failing(tmp_path, RUNS[0], 3, seed=20).wrong
