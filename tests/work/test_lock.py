"""Two runs in one folder, and locks that a run left."""

from __future__ import annotations

import json
import os
import socket
import subprocess
import sys
import time
from pathlib import Path

import pytest
from refusals import command

import modefront as mf
from modefront.work import lock
from modefront.work.lock import FILE, Owner, locked, this_process


def leave(folder: Path, **changes: object) -> None:
    """Leave a lock of another run."""
    (folder / FILE).write_text(json.dumps({**vars(this_process()), **changes}))


def ended() -> int:
    """Return the number of a process that has ended."""
    process = subprocess.Popen([sys.executable, "-c", ""])
    process.wait()
    return process.pid


def test_a_second_run_leaves_before_it_has_done_anything(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    results = folder / "results"
    results.mkdir()
    with locked(results):
        before = sorted(results.rglob("*"))
        assert command("run", folder / "chain.toml", "-o", results) == 2
        err = capsys.readouterr().err
        assert f"{results}: folder: expected no other run in it, found the run of process" in err
        assert str(os.getpid()) in err
        assert sorted(results.rglob("*")) == before
    assert not list(results.iterdir())


@pytest.mark.parametrize("kind", ["dead", "another's", "nobody's", "torn", "far", "reused"])
def test_a_lock_that_was_left(kind: str, tmp_path: Path) -> None:
    if kind == "dead":
        leave(tmp_path, process=ended())
    elif kind == "reused":
        leave(tmp_path, process=os.getpid(), began="another time")
    elif kind == "another's":
        leave(tmp_path, process=ended(), began="")
    elif kind == "nobody's":
        leave(tmp_path, process=-1, began="")
    else:
        leave(tmp_path, host="another machine")
        if kind == "torn":
            (tmp_path / FILE).write_text('{"host')
        old = time.time() - 2 * lock.STALE
        os.utime(tmp_path / FILE, (old, old))
    with locked(tmp_path):
        assert (tmp_path / FILE).is_file()
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("kind", ["far", "torn", "here"])
def test_a_lock_that_is_held(kind: str, tmp_path: Path) -> None:
    leave(tmp_path, **({"host": "far\x1b[31m"} if kind == "far" else {}))
    if kind == "torn":
        (tmp_path / FILE).write_text("")
    before = (tmp_path / FILE).read_bytes()
    with (
        pytest.raises(mf.InputError, match="expected no other run in it") as error,
        locked(tmp_path),
    ):
        pass
    assert "\x1b" not in str(error.value)
    assert (tmp_path / FILE).read_bytes() == before


def test_a_lock_that_another_run_has_taken_is_not_removed(tmp_path: Path) -> None:
    with locked(tmp_path):
        leave(tmp_path, token="other")
    assert (tmp_path / FILE).is_file()


def test_a_folder_that_is_taken_away(tmp_path: Path) -> None:
    folder = tmp_path / "results"
    folder.mkdir()
    with locked(folder):
        folder.rename(tmp_path / "elsewhere")


def test_drives_without_hard_links(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise OSError(1, "Operation not permitted")

    monkeypatch.setattr(os, "link", refuse)
    with locked(tmp_path):
        with pytest.raises(mf.InputError, match="no other run"), locked(tmp_path):
            pass
        assert (tmp_path / FILE).is_file()
    assert not list(tmp_path.iterdir())


def test_the_owner_is_this_process() -> None:
    owner = this_process()
    assert (owner.host, owner.process) == (socket.gethostname(), os.getpid())
    assert isinstance(owner, Owner)
