"""Files are written whole or not at all, by one function, and never through a link."""

from __future__ import annotations

import ast
import os
import re
import stat
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from faultless import PREDICTIONS, STUDY
from refusals import command, edited

import modefront
from modefront.outputs import output, output_by_name, remove_unfinished, write_table, write_text
from modefront.work.store import Store
from modefront.work.task import Costs, Task

pytestmark = pytest.mark.usefixtures("short_chains")

SOURCE = Path(modefront.__file__).parent

METHODS = {"write_text", "write_bytes", "touch", "symlink_to", "hardlink_to", "tofile", "truncate"}
"""Methods of paths and arrays that write to a file, or make one."""

FUNCTIONS = re.compile(
    r".+\.(savefig|save|savez\w*|save_npz|savetxt|savemat|mmwrite|to_(netcdf|zarr|csv|hdf|pickle)"
    r"|write_sets)|meshio\.write|tempfile\.(mkstemp|\w*File)|shutil\.copy\w*|os\.(link|mkfifo|symlink)"
)
"""Functions that write to a file that they are passed."""

READING = {"r", "rb", "rt"}

ALLOWED = {
    ("outputs.py", "unfinished.open"): "the one function",
    ("work/isolated.py", "os.open"): "what a reader prints, in a folder of its own",
    ("hdf5.py", "h5py.File"): "a stream of `output`",
    ("cli/main.py", "os.open"): "the null device, where the terminal has gone",
}
"""Places that open files for writing."""

STREAMS = {"stream", "text", "content"}
"""Names of streams in memory or of `output`, to which functions may write."""

NAMED = re.compile(r"\bcopy\b")
"""The name that `output_by_name` yields."""


def calls(file: Path) -> Iterator[tuple[str, ast.Call]]:
    """Yield the calls of a file, with the dotted name of the function as far as it has one."""
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Call):
            yield ast.unparse(node.func), node


def writes(name: str, call: ast.Call) -> bool:
    """Return whether a call writes to a file by its name."""
    last = name.rpartition(".")[2]
    if last in ("open", "fdopen", "File"):
        if name == "os.open":
            return True
        given = {each.arg: each.value for each in call.keywords}
        is_method = last == "open" and name not in ("open", "io.open")
        positions = call.args[0 if is_method else 1 :]
        mode = given.get("mode", positions[0] if positions else None)
        if mode is None:
            return name == "h5py.File"  # its default may change
        return not (isinstance(mode, ast.Constant) and mode.value in READING)
    if last in METHODS:
        return "." in name
    if not FUNCTIONS.fullmatch(name):
        return False
    target = ast.unparse(call.args[0]) if call.args else ""
    return target not in STREAMS and not NAMED.search(f"{name} {target}")


FILES = sorted(SOURCE.rglob("*.py"))


def test_nothing_else_opens_a_file_for_writing() -> None:
    found = {
        (file.relative_to(SOURCE).as_posix(), name)
        for file in FILES
        for name, call in calls(file)
        if writes(name, call)
    }
    assert found == set(ALLOWED)


@pytest.mark.parametrize(
    "text",
    [
        'path.open("w")',
        'path.open(mode="ab")',
        "path.open(mode)",
        'open(path, "x")',
        'io.open(path, "r+")',
        "os.open(path, flags)",
        "path.write_text(text)",
        "folder.joinpath(name).write_bytes(b)",
        "figure.savefig(path)",
        "np.save(path, A)",
        "np.savez(folder / 'x', **named)",
        "np.savez_compressed(path)",
        "scipy.sparse.save_npz(path, A)",
        "scipy.io.mmwrite(path, A)",
        "data.to_netcdf(path)",
        'h5py.File(path, "w")',
        "h5py.File(path)",
        'h5netcdf.File(path, "a")',
        "meshio.write(path, mesh)",
        "shutil.copyfile(a, b)",
        'zipfile.ZipFile(path).open(name, "w")',
        "path.touch()",
    ],
)
def test_what_counts_as_writing(text: str) -> None:
    (call,) = [node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.Call)][:1]
    assert writes(ast.unparse(call.func), call)


def test_permissions_are_those_of_any_new_file(tmp_path: Path) -> None:
    with (tmp_path / "usual").open("w"):
        pass
    write_text(tmp_path / "new", "text")
    assert (tmp_path / "new").stat().st_mode == (tmp_path / "usual").stat().st_mode
    for mode in (0o600, 0o640, 0o666, 0o755):
        (tmp_path / "new").chmod(mode)
        write_text(tmp_path / "new", "other text")
        assert stat.S_IMODE((tmp_path / "new").stat().st_mode) == mode
    assert (tmp_path / "new").read_text() == "other text"


@pytest.mark.parametrize("error", [KeyboardInterrupt, OSError, ValueError])
def test_what_was_there_stays_until_all_is_written(
    error: type[BaseException], tmp_path: Path
) -> None:
    path = tmp_path / "file"
    path.write_text("before")

    def begin() -> None:
        with output(path) as stream:
            stream.write(b"half")
            raise error

    def begin_by_name() -> None:
        with output_by_name(path) as copy:
            copy.write_bytes(b"half")
            raise error

    for function in (begin, begin_by_name):
        with pytest.raises(error):
            function()
        assert path.read_text() == "before"
    assert list(tmp_path.iterdir()) == [path]


def test_links_and_pipes_are_replaced_and_not_followed(tmp_path: Path) -> None:
    precious, link, pipe = (tmp_path / name for name in ("precious", "link", "pipe"))
    precious.write_text("precious")
    link.symlink_to(precious)
    os.mkfifo(pipe)
    for path in (link, pipe):
        write_text(path, "text")
        assert path.read_text() == "text"
        assert stat.S_ISREG(path.lstat().st_mode)
    assert precious.read_text() == "precious"


def test_a_file_of_a_long_name_and_a_table(tmp_path: Path) -> None:
    path = tmp_path / ("é" * 120 + ".csv")
    write_table(path, [["a", "b,c"], [1, None]])
    assert path.read_bytes() == b'a,"b,c"\n1,\n'


def test_what_killed_processes_leave_is_removed(tmp_path: Path) -> None:
    names = [".results.nc-x1.tmp", ".other-x1.tmp", "of-the-user.tmp", ".hidden"]
    for name in names:
        (tmp_path / name).touch()
    remove_unfinished(tmp_path, "results.nc")
    assert {path.name for path in tmp_path.iterdir()} == set(names[1:])
    remove_unfinished(tmp_path)
    assert {path.name for path in tmp_path.iterdir()} == set(names[2:])


def plant(path: Path, kind: str, precious: Path) -> None:
    """Put a link to a file, or a pipe, where a file is written under a name that can be guessed."""
    if kind == "link":
        path.symlink_to(precious)
    else:
        os.mkfifo(path)


@pytest.fixture
def quick(folder: Path) -> Path:
    """A study in it without predictions."""
    path = folder / "chain.toml"
    path.write_text(edited(STUDY, (PREDICTIONS, ""), ("draws = 3", "")))
    return path


@pytest.mark.slow(4)
@pytest.mark.parametrize("kind", ["link", "pipe"])
def test_names_that_can_be_guessed_lead_nowhere(kind: str, folder: Path, quick: Path) -> None:
    precious, results = folder / "precious", folder / "results"
    precious.write_text("precious")
    results.mkdir()
    for name in ("results.nc.tmp", "report.html.tmp", "running.lock"):
        plant(results / name, kind, precious)
    assert command("run", quick, "-o", results) == 0
    (tasks,) = (path for path in (results / "tasks").iterdir() if path.is_dir())
    for name in ("study", *(f"{path.stem}.tmp" for path in tasks.glob("*.npz"))):
        (tasks / name).unlink(missing_ok=True)
        plant(tasks / name, kind, precious)
    for path in [results / "results.nc", *list(tasks.glob("*.npz"))[:2]]:
        path.unlink()
        plant(path, kind, precious)
    assert command("run", quick, "-o", results) == 0
    assert command("report", results, "-o", results / "report.html") == 0
    assert precious.read_text() == "precious"


@pytest.mark.slow(3)
@pytest.mark.parametrize("deep", [False, True])
def test_linked_folders_of_tasks_are_refused(
    deep: bool, folder: Path, quick: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    results, elsewhere = folder / "results", folder / "elsewhere"
    assert command("run", quick, "-o", results) == 0
    place = results / "tasks"
    if deep:
        (place,) = (path for path in place.iterdir() if path.is_dir())
    place.rename(elsewhere)
    (elsewhere / ".x-1.tmp").write_text("precious")
    place.symlink_to(elsewhere)
    before = {path: path.stat().st_mtime_ns for path in elsewhere.rglob("*")}
    capsys.readouterr()
    assert command("run", quick, "-o", results) == 2
    err = capsys.readouterr().err
    assert f"{place}: folder: expected a folder of its own, found a link to {elsewhere}" in err
    assert {path: path.stat().st_mtime_ns for path in elsewhere.rglob("*")} == before


def test_a_folder_of_results_may_be_a_link(folder: Path, quick: Path) -> None:
    (folder / "elsewhere").mkdir()
    (folder / "results").symlink_to(folder / "elsewhere")
    assert command("run", quick, "-o", folder / "results") == 0
    assert (folder / "elsewhere" / "results.nc").is_file()


def test_a_file_of_a_user_is_not_lost(tmp_path: Path) -> None:
    mine = tmp_path / "modes.csv.part"
    mine.write_text("mine")
    data = modefront.modal_data(np.array([1.0]), np.ones((1, 1)), ("a",))
    from modefront.data.csv import write_csv

    write_csv(tmp_path / "modes.csv", data)
    assert mine.read_text() == "mine"


def test_what_lasts_is_on_the_drive_before_it_takes_its_place(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    order: list[str] = []

    def noted(name: str, call: Callable[..., None]) -> Callable[..., None]:
        def inner(*arguments: object) -> None:
            order.append(name)
            call(*arguments)

        return inner

    monkeypatch.setattr(os, "fsync", noted("fsync", os.fsync))
    monkeypatch.setattr(Path, "replace", noted("replace", Path.replace))
    Store(tmp_path).write(Task(("x",), len), 1, Costs())
    assert order == ["fsync", "replace"]
