"""One run a folder: a second one leaves, and one that was killed keeps nobody out."""

from __future__ import annotations

import errno
import fcntl
import os
import shutil
import socket
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import pytest
from refusals import command

import modefront as mf
from modefront.work.store import FILE, FOLDER, HOLDER, locked

HOLD = """
import sys
from pathlib import Path
from modefront.work.store import locked
with locked(Path(sys.argv[1])):
    print("held", flush=True)
    sys.stdin.read()
"""

CHANGED = """
import os, time
real = time.time
time.time = lambda: real() - 360
os.getpid = lambda: 4_000_000
"""
"""A process whose number is none of this machine, and whose clock is six minutes behind."""


@pytest.fixture
def results(tmp_path: Path) -> Path:
    (tmp_path / "results" / FOLDER).mkdir(parents=True)
    return tmp_path / "results"


@contextmanager
def holding(
    results: Path, before: str = "", command: Sequence[str] = ()
) -> Iterator[subprocess.Popen[str]]:
    """Have another process hold the lock."""
    process = subprocess.Popen(
        [*command, sys.executable, "-c", before + HOLD, str(results)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None
    assert process.stdout.readline() == "held\n"
    try:
        yield process
    finally:
        process.kill()
        process.communicate()


def refused(results: Path) -> str:
    with (
        pytest.raises(mf.InputError, match="expected no other run in it") as error,
        locked(results),
    ):
        pass
    return str(error.value)


def test_a_second_run_leaves_before_it_has_done_anything(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    results = folder / "results"
    (results / FOLDER).mkdir(parents=True)
    with locked(results):
        before = sorted(results.rglob("*"))
        assert command("run", folder / "chain.toml", "-o", results) == 2
        err = capsys.readouterr().err
        assert f"{results}: folder: expected no other run in it, found the run of process" in err
        assert f"{os.getpid()} on {socket.gethostname()}: wait until it has ended" in err
        assert sorted(results.rglob("*")) == before
    assert [path.name for path in results.rglob("*")] == [FOLDER, FILE]


@pytest.mark.parametrize("before", ["", CHANGED])
def test_a_lock_that_lives_is_not_taken_over(before: str, results: Path) -> None:
    with holding(results, before) as process:
        for age in (0, 360, 10**8):
            for name in (FILE, HOLDER):
                old = time.time() - age
                os.utime(results / FOLDER / name, (old, old))
            assert f"process {4_000_000 if before else process.pid} on " in refused(results)
        assert process.poll() is None


@pytest.mark.slow(4)
def test_a_process_that_is_killed_leaves_no_lock(results: Path) -> None:
    for _ in range(3):
        with holding(results) as process:
            refused(results)
            process.kill()
            process.wait()
            with locked(results):
                refused(results)


@pytest.mark.slow(4)
def test_of_many_processes_one_works_at_a_time(results: Path) -> None:
    """Each adds to a number that it has read before, and some are killed while they do."""
    count = results / "count"
    count.write_text("0")
    code = """
import sys, time
from pathlib import Path
from modefront.errors import InputError
from modefront.work.store import locked
results, count, own = map(Path, sys.argv[1:])
for _ in range(20):
    try:
        with locked(results):
            number = int(count.read_text())
            time.sleep(0.005)
            count.write_text(str(number + 1))
            own.write_text(str(int(own.read_text()) + 1))
    except InputError:
        pass
"""
    own = [results / f"own-{k}" for k in range(4)]
    for path in own:
        path.write_text("0")
    running = [
        subprocess.Popen([sys.executable, "-c", code, str(results), str(count), str(path)])
        for path in own
    ]
    for process in running:
        assert process.wait() == 0
    done = [int(path.read_text()) for path in own]
    assert int(count.read_text()) == sum(done)
    assert sum(done) >= 20


@pytest.mark.parametrize("kind", ["link", "pipe", "long", "none", "terminal"])
def test_the_holder_is_only_words(kind: str, results: Path) -> None:
    with locked(results):
        holder = results / FOLDER / HOLDER
        holder.unlink()
        if kind == "link":
            holder.symlink_to(holder)
        elif kind == "pipe":
            os.mkfifo(holder)
        elif kind == "long":
            holder.write_bytes(b"\xff" * 10**7)
        elif kind == "terminal":
            holder.write_text("process \x1b[31m")
        message = refused(results)
    assert "\x1b" not in message
    assert len(message) < 500


def test_a_lock_that_is_a_link_is_not_followed(results: Path, tmp_path: Path) -> None:
    (results / FOLDER / FILE).symlink_to(tmp_path / "precious")
    with pytest.raises(mf.InputError, match="a folder that can be written to"), locked(results):
        pass
    assert not (tmp_path / "precious").exists()


def test_a_folder_that_is_taken_away(results: Path, tmp_path: Path) -> None:
    with locked(results):
        results.rename(tmp_path / "elsewhere")
    with locked(tmp_path / "elsewhere"):
        pass


def test_a_holder_that_cannot_be_written(results: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object, **__: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr("modefront.work.store.write_text", full)
        with pytest.raises(mf.InputError, match="no space left"), locked(results):
            pass
    with locked(results):
        pass


@pytest.mark.parametrize("code", [errno.ENOLCK, errno.EOPNOTSUPP])
def test_a_drive_whose_locks_fail_is_refused(
    code: int, results: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise OSError(code, os.strerror(code))

    monkeypatch.setattr("fcntl.flock", fail)
    with pytest.raises(mf.InputError, match="a folder that can be written to"), locked(results):
        pass


WITHOUT = """
import errno, fcntl, os
def flock(*_):
    raise OSError(errno.ENOSYS, os.strerror(errno.ENOSYS))
fcntl.flock = flock
"""
"""A drive without locks."""


@pytest.fixture
def without(monkeypatch: pytest.MonkeyPatch) -> None:
    """Have this process see a drive without locks."""
    monkeypatch.setattr("fcntl.flock", fcntl.flock)  # it is put back in the end
    exec(WITHOUT, {})


@pytest.mark.usefixtures("without")
def test_drives_without_locks(results: Path) -> None:
    with holding(results, WITHOUT) as process:
        old = time.time() - 10**6
        os.utime(results / FOLDER / FILE, (old, old))
        message = refused(results)
        assert str(process.pid) in message
        assert f"if it was killed, remove '{results / FOLDER / FILE}'" in message
        process.kill()
        process.wait()
        with locked(results):
            refused(results)
    assert not list((results / FOLDER).iterdir())


@pytest.mark.usefixtures("without")
def test_a_run_on_another_machine_is_not_judged(results: Path) -> None:
    elsewhere = "import socket; socket.gethostname = lambda: 'far'\n"
    with holding(results, WITHOUT + elsewhere) as process:
        assert "on far" in refused(results)
        process.kill()
        process.wait()
        assert f"if it was killed, remove '{results / FOLDER / FILE}'" in refused(results)


@pytest.mark.usefixtures("without")
def test_a_run_in_another_namespace_is_not_judged(results: Path) -> None:
    """Its number is that of no process here."""
    unshare = ["unshare", "--pid", "--fork", "--mount-proc"]
    if not shutil.which("unshare") or subprocess.run([*unshare, "true"], check=False).returncode:
        pytest.skip("no namespaces of processes here")
    with holding(results, WITHOUT, unshare):
        refused(results)
    with holding(results, "", unshare):
        refused(results)
