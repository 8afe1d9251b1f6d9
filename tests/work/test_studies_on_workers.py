"""Studies have the same digits on one process, on several, and on a cluster."""

from __future__ import annotations

import gc
import multiprocessing
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, nullcontext, suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.io
import scipy.sparse
import xarray as xr
from test_tasks_of_runs import everything, plain, study
from two_masses import write_study

import modefront as mf
from modefront.errors import InputError, UnfinishedError
from modefront.study import session
from modefront.work import workers as module
from modefront.work.progress import Progress, State
from modefront.work.store import locked
from modefront.work.workers import Cluster, LocalPool, Pool, Workers

# A scheduler that is gone leaves half-open connections, which Dask closes as they are collected.
pytestmark = pytest.mark.filterwarnings("ignore:unclosed <socket:ResourceWarning")


@pytest.fixture(autouse=True)
def connections() -> Iterator[None]:
    """Collect connections within the test that opened them, and not in a later one."""
    yield
    gc.collect()


EVOLUTION = "points = 3", 'points = 3\nmethod = "spea2"\npopulation = 6\nevaluations = 18'


def evolution(folder: Path) -> mf.Study:
    return study(folder, EVOLUTION)


def reduced(folder: Path) -> mf.Study:
    """Return a study of a chain of 200 masses in a reduced basis, without a posterior."""
    n, rng = 200, np.random.default_rng(1)
    names = ("k1", "k2")
    for name, chosen in zip(names, np.split(np.arange(n), 2), strict=True):
        K = scipy.sparse.lil_array((n, n))
        for i in chosen:  # the spring below the mass
            K[i, i] += 1e4
            if i:
                K[i - 1, i - 1] += 1e4
                K[i, i - 1] -= 1e4
                K[i - 1, i] -= 1e4
        scipy.io.mmwrite(folder / f"{name}.mtx", K.tocoo())
    scipy.io.mmwrite(folder / "M.mtx", scipy.sparse.coo_array(scipy.sparse.eye_array(n)))
    sensors = [20, 60, 110, 170]
    x = np.arange(1, n + 1) / (n + 0.5)
    lines = ["set,mode,frequency,damping," + ",".join(f"s{s}" for s in sensors)]
    for r in (1, 2):
        angle = (r - 0.5) * np.pi
        frequency = 100 / np.pi * np.sin(angle / (2 * n + 1)) * (1 + 0.01 * rng.normal())
        shape = np.sin(angle * x[sensors]) * (1 + 0.05 * rng.normal(size=4))
        lines.append(f"1,{r},{frequency},0.01," + ",".join(map(str, shape)))
    (folder / "modes.csv").write_text("\n".join(lines) + "\n")
    text = """[study]
name = "reduced"

[data]
file = "modes.csv"

[model]
kind = "matrices"
reduction = 1e-8
stiffness = { k1 = "k1.mtx", k2 = "k2.mtx" }
mass = { base = "M.mtx" }
sensors = { s20 = 20, s60 = 60, s110 = 110, s170 = 170 }

[pareto]
points = 4

[search]
doubt = 0.5

[noise]
weight = 0
"""
    for name in names:
        text += f'\n[[parameter]]\nname = "{name}"\nnominal = 1.0\nbounds = [0.5, 2.0]\n'
    for name, what in (("frequencies", "frequency"), ("shapes", "shape")):
        text += f'\n[[group]]\nname = "{name}"\n{what} = "all"\n'
    (folder / "study.toml").write_text(text)
    return mf.load(folder / "study.toml")


@pytest.fixture(autouse=True)
def _nothing_is_too_small(monkeypatch: pytest.MonkeyPatch) -> None:
    """Send all tasks to the processes, also the small ones of these studies."""
    monkeypatch.setattr(module, "TINY", 0.0)
    monkeypatch.setattr(LocalPool, "ready", True)


@pytest.fixture(scope="module")
def pools() -> Iterator[dict[str, Workers]]:
    """Return processes that all studies share: two, three, and a cluster of two workers."""
    distributed: Any = pytest.importorskip("distributed")
    with ExitStack() as stack:
        cluster = distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, dashboard_address=":0", silence_logs=50
        )
        address = stack.enter_context(cluster).scheduler_address
        every: dict[str, Pool] = {
            "2": LocalPool(2),
            "3": LocalPool(3),
            "cluster": Cluster(address),
        }
        yield {name: stack.enter_context(Workers(pool)) for name, pool in every.items()}


@pytest.mark.slow(10)
@pytest.mark.parametrize(
    ("of", "names"),
    [(everything, ["2", "3"]), (reduced, ["3", "cluster"]), (evolution, ["2", "cluster"])],
)
def test_results_do_not_depend_on_who_does_the_work(
    of: Callable[[Path], mf.Study],
    names: list[str],
    tmp_path: Path,
    pools: dict[str, Workers],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    expected = mf.run(of(tmp_path), tmp_path / "one").dataset
    files = sorted(x.name for x in (tmp_path / "one").rglob("*.npz"))
    for name in names:
        with monkeypatch.context() as patch:
            patch.setattr(session, "backend", lambda *_, x=pools[name]: nullcontext(x))
            result = mf.run(of(tmp_path), tmp_path / name).dataset
        xr.testing.assert_identical(result, expected)
        assert sorted(x.name for x in (tmp_path / name).rglob("*.npz")) == files


@pytest.mark.slow(5)
def test_a_process_that_is_killed_during_a_certificate_is_replaced(tmp_path: Path) -> None:
    expected = mf.run(reduced(tmp_path), tmp_path / "whole").dataset
    killed: list[Any] = []
    others = set(multiprocessing.active_children())

    def report(state: State) -> None:
        if state.stage == "certificate" and state.running and not killed:
            killed.extend(set(multiprocessing.active_children()) - others)
            killed[0].kill()

    folder, progress = tmp_path / "killed", Progress(report)
    result = mf.run(reduced(tmp_path), folder, workers=2, progress=progress).dataset
    xr.testing.assert_identical(result, expected)
    assert len(killed) == 2
    assert set(multiprocessing.active_children()) <= others


@pytest.mark.slow(8)
def test_a_run_whose_scheduler_is_gone_ends_and_a_later_one_goes_on(tmp_path: Path) -> None:
    distributed: Any = pytest.importorskip("distributed")
    expected = mf.run(plain(tmp_path), tmp_path / "whole").dataset
    cluster = distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, dashboard_address=":0", silence_logs=50
    )

    def report(state: State) -> None:
        if state.done == 4:
            cluster.close()

    folder = tmp_path / "results"
    progress = Progress(report)
    with pytest.raises(UnfinishedError, match="the Dask scheduler is gone; what was done is kept"):
        mf.run(everything(tmp_path), folder, scheduler=cluster.scheduler_address, progress=progress)
    xr.testing.assert_identical(mf.run(plain(tmp_path), folder).dataset, expected)


def test_a_cluster_that_is_none_is_refused_in_words(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("distributed")
    monkeypatch.setattr("modefront.work.workers.ANSWER", 0.3)
    ignored: list[object] = []
    monkeypatch.setattr(sys, "unraisablehook", ignored.append)
    for address in ("nonsense:////", "tls://127.0.0.1:9"):  # no such scheme, no certificates
        with pytest.raises(InputError, match="--scheduler: expected an address like tcp"):
            Cluster(address)
    gc.collect()
    assert not ignored, "a client that was never open is closed in silence, and at once"
    with pytest.raises(UnfinishedError, match=r"no Dask scheduler answers at tcp://127.0.0.1:9"):
        Cluster("tcp://127.0.0.1:9")


def running(group: int) -> list[str]:
    """Return the processes of a group that have not ended."""
    result = []
    for path in Path("/proc").glob("[0-9]*/stat"):
        with suppress(OSError):
            state, _, chosen = path.read_text().rpartition(")")[2].split()[:3]
            if int(chosen) == group and state != "Z":
                result.append(path.parent.name)
    return result


def ends(group: int) -> bool:
    """Wait for the processes of a group; return whether all have ended within ten seconds."""
    for _ in range(500):
        if not running(group):
            return True
        time.sleep(0.02)
    return False


@pytest.mark.skipif(not Path("/proc").is_dir(), reason="processes are found in /proc")
def test_processes_of_a_pool_never_see_interrupts_of_the_terminal() -> None:
    code = """if __name__ == "__main__":
    import multiprocessing, pathlib, re, signal
    from modefront.work.workers import LocalPool
    pool = LocalPool(2)
    for process in multiprocessing.active_children():
        text = pathlib.Path(f"/proc/{process.pid}/status").read_text()
        print(int(re.search(r"SigBlk:\\s*(\\w+)", text)[1], 16) >> signal.SIGINT - 1 & 1)
    pool.close()
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "1\n1\n"


@pytest.mark.slow(3)
@pytest.mark.skipif(not Path("/proc").is_dir(), reason="processes are found in /proc")
@pytest.mark.parametrize("name", ["SIGTERM", "SIGHUP", "SIGINT"])
def test_signals_interrupt_a_run_and_end_its_processes(name: str, tmp_path: Path) -> None:
    path = write_study(tmp_path, "")
    path.write_text(path.read_text().replace("points = 3", "points = 3000"))
    # What has started the tests may ignore signals, such as nohup, and what it starts would too.
    heard = "signal.signal(signal.SIGINT, signal.default_int_handler)"
    heard += "; signal.signal(signal.SIGHUP, signal.SIG_DFL)"
    code = f"import signal; {heard}; from modefront.cli.main import main; main()"
    folder = tmp_path / "results"
    arguments = ["run", path, "-o", folder, "--workers", "2"]
    with subprocess.Popen(
        [sys.executable, "-c", code, *map(str, arguments)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    ) as process:
        while process.poll() is None and len(list(folder.rglob("*.npz"))) < 5:
            time.sleep(0.01)
        os.killpg(process.pid, getattr(signal, name))
        out, err = process.communicate(timeout=60)
    assert process.returncode == 130, err
    assert out == ""
    assert err.splitlines()[-1].startswith("modefront: interrupted; what was done is kept")
    assert "Traceback" not in err
    assert not list(folder.rglob("*.tmp"))
    for _ in range(500):  # what multiprocessing has started to clean up ends after the others
        if not running(process.pid):
            break
        time.sleep(0.02)
    assert not running(process.pid)


FAULTY = Path(__file__).parents[1] / "trials" / "faulty.py"


@pytest.mark.slow(3)
@pytest.mark.skipif(not Path("/proc").is_dir(), reason="processes are found in /proc")
@pytest.mark.parametrize("kind", ["full", "read-only"])
def test_a_drive_that_fails_ends_a_run_and_its_processes(kind: str, tmp_path: Path) -> None:
    path, folder = write_study(tmp_path, ""), tmp_path / "results"
    arguments = ["run", path, "-o", folder, "--workers", "2"]
    command = [sys.executable, str(FAULTY), kind, "30", str(folder), *map(str, arguments)]
    with subprocess.Popen(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    ) as process:
        _, err = process.communicate(timeout=60)
    assert process.returncode == 1, err
    words = {"full": "no space left on the drive", "read-only": "a drive that is read-only"}
    assert words[kind] in err.splitlines()[-1]
    assert err.splitlines()[-1].endswith("what was done is kept")
    assert ends(process.pid)
    assert list(folder.rglob("*.npz"))


@pytest.mark.slow(5)
@pytest.mark.skipif(not Path("/proc").is_dir(), reason="processes are found in /proc")
def test_a_run_whose_output_nobody_reads_is_done_and_says_so_once(tmp_path: Path) -> None:
    path, folder = write_study(tmp_path, ""), tmp_path / "results"
    expected = mf.run(mf.load(path), tmp_path / "whole").dataset
    code = "from modefront.cli.main import main; main()"
    arguments = ["run", path, "-o", folder, "--workers", "2"]
    with subprocess.Popen(
        [sys.executable, "-c", code, *map(str, arguments)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    ) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        process.stdout.close()
        lines = process.stderr.read().splitlines()
    assert process.returncode == 0
    said = f"modefront: nobody reads the summary; the results are in {folder}"
    assert [line for line in lines if "tasks done" not in line] == [said]
    assert mf.read_results(folder).dataset.identical(expected)
    assert ends(process.pid)


def test_a_second_run_with_workers_leaves_the_folder_to_the_first(tmp_path: Path) -> None:
    path, folder = write_study(tmp_path, ""), tmp_path / "results"
    (folder / "tasks").mkdir(parents=True)
    with locked(folder), pytest.raises(InputError, match="no other run in it"):
        mf.run(mf.load(path), folder, workers=2)
    assert not list(folder.rglob("*.npz"))
