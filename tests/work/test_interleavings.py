"""Two runs never both work in a folder, in whatever order they come, go and are killed."""

from __future__ import annotations

import gc
import shutil
import tempfile
import warnings
from pathlib import Path
from typing import Any

import filelock
import pytest
from hypothesis import HealthCheck, Phase, settings
from hypothesis import strategies as st
from hypothesis.stateful import (
    RuleBasedStateMachine,
    invariant,
    precondition,
    rule,
    run_state_machine_as_test,
)
from interleavings import Machine

from modefront.work.store import FILE, FOLDER

MOST = 5
"""Runs in one folder."""


class Interleavings(RuleBasedStateMachine):
    """Runs that begin, go on by some calls, are killed and end."""

    has_locks = True

    def __init__(self) -> None:
        super().__init__()
        self.folder = Path(tempfile.mkdtemp(prefix="interleavings-"))
        (self.folder / FOLDER).mkdir()
        self.machine = Machine(self.folder, self.has_locks)

    @precondition(lambda self: len(self.machine.runs) < MOST)
    @rule()
    def begin(self) -> None:
        """Begin a run."""
        self.machine.begin()

    @precondition(lambda self: self.machine.runs)
    @rule(which=st.integers(0, MOST - 1), calls=st.integers(1, 30))
    def step(self, which: int, calls: int) -> None:
        """Let a run go on by some calls."""
        run = self.machine.runs[which % len(self.machine.runs)]
        for _ in range(calls):
            run.step()
            self.at_most_one_works()

    @precondition(lambda self: self.machine.runs)
    @rule(which=st.integers(0, MOST - 1), meant=st.integers(0, 5))
    def kill(self, which: int, meant: int) -> None:
        """Kill a run, now and then."""
        if not meant:
            self.machine.runs[which % len(self.machine.runs)].kill()

    @invariant()
    def at_most_one_works(self) -> None:
        """Compare the number of runs that work."""
        assert len(self.machine.working) <= 1
        failed = [run.error for run in self.machine.runs if run.outcome == "failed"]
        assert not failed, failed[0]

    def teardown(self) -> None:
        """Let all runs end, and another one come."""
        try:
            for run in self.machine.runs:
                while run.lives:
                    run.step()
                    self.at_most_one_works()
            marker = self.folder / FOLDER / FILE
            torn = not self.has_locks and marker.exists()
            last = self.machine.begin()
            last.finish()
            assert last.outcome == "ended" or (torn and str(marker) in last.error)
        finally:
            self.machine.close()
            shutil.rmtree(self.folder)


class WithoutLocks(Interleavings):
    """The same on a drive that has no locks."""

    has_locks = False


def play(kind: type[Interleavings], examples: int, **options: Any) -> None:
    """Play so many interleavings; raises AssertionError where two runs work."""
    chosen = settings(
        max_examples=examples,
        stateful_step_count=40,
        phases=[Phase.generate],
        suppress_health_check=list(HealthCheck),
        database=None,
        **options,
    )
    gc.freeze()  # so that there is little to collect after each
    with warnings.catch_warnings(action="ignore"):
        run_state_machine_as_test(kind, settings=chosen)


@pytest.mark.parametrize("kind", [Interleavings, WithoutLocks])
def test_at_most_one_run_works(kind: type[Interleavings]) -> None:
    play(kind, 30)


def test_a_rule_that_takes_locks_of_living_runs_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    if not hasattr(filelock._soft, "owner_is_stale"):
        pytest.skip("this version of filelock has its rule elsewhere")
    monkeypatch.setattr("filelock._soft.owner_is_stale", lambda *_: True)
    with pytest.raises(AssertionError):
        play(WithoutLocks, 60)
