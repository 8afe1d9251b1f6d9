"""Misuse of the command line, and results that are none."""

import subprocess
import sys
from pathlib import Path

import pytest
from faultless import STUDY
from refusals import command, edited

from modefront.results.schema import FORMAT

COMMANDS = [
    (["--colour"], "No such option"),
    (["check"], "Missing argument 'STUDY'"),
    (["check", "{}"], "file: expected a study file, found a folder with chain.toml, "),
    (["chekc", "{}/chain.toml"], "No such command 'chekc'"),
    (["check", "--fast", "{}/chain.toml"], "No such option"),
    (["check", "{}/chain.toml", "more"], "Got unexpected extra argument (more)"),
    (["run", "{}/chain.toml", "-o"], "Option '-o' requires an argument"),
    (["show", "{}", "--format", "xml"], "'xml' is not one of 'table', 'json'"),
    (["show", "{}/absent"], "absent/results.nc: file: expected results of a finished run, found"),
    (["show", "{}"], "results.nc: file: expected results of a finished run, found no such file"),
    (["show", "{}/chain.toml"], "results.nc: file: expected results of a finished run, found no"),
    (["run", "{}/chain.toml", "--refine", "2"], "2.0 is not in the range"),
    (["run", "{}/three.toml", "--refine", "0.1"], "--refine: expected two groups and method 'nbi'"),
    (["compare"], "Missing argument 'DIRECTORIES...'"),
    (["compare", "{}", "{}/absent"], "absent/results.nc: file: expected results of a finished run"),
    (
        ["init", "{}/new", "--example", "x"],
        "--example: expected one of ambient-test, calculix",
    ),
    (["init", "{}/new", "--example", "three-story-c2"], "(did you mean 'three-story-c"),
    (
        ["init", "{}/new", "--example", "../examples"],
        "--example: expected one of ambient-test, calculix",
    ),
    (
        ["init", "{}/new", "--example", ""],
        "--example: expected one of ambient-test, calculix",
    ),
    (["init", "{}/chain.toml"], "chain.toml: folder: expected a folder that can be written to"),
    (
        ["init", "{}"],
        "modes.csv: file: expected a new file, as nothing is overwritten, found an existing one",
    ),
    (["run", "{}/chain.toml", "-o", "{}/modes.csv"], "modes.csv: folder: expected a folder that"),
    (["run", "{}/chain.toml", "-o", "{}/modes.csv/x"], "x: folder: expected a folder that can be"),
]


@pytest.mark.parametrize(("arguments", "says"), COMMANDS)
def test_misuse_of_the_command_line(
    arguments: list[str], says: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    third = ('[[group]]\nname = "mode 1"\nfrequency = [1]\n\n[[weighted]]', "[[weighted]]")
    three = edited(STUDY, third[::-1], ("shapes = 2.0 }", 'shapes = 2.0, "mode 1" = 1.0 }'))
    (folder / "three.toml").write_text(three)
    before = {path: path.read_bytes() for path in folder.iterdir() if path.is_file()}
    status = command(*(argument.format(folder) for argument in arguments))
    out, err = capsys.readouterr()
    assert status == 2, err
    assert out == ""
    assert says in err
    assert {path: path.read_bytes() for path in folder.iterdir() if path.is_file()} == before
    assert not (folder / "new").exists()


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (b"", "results.nc: file: expected results of a finished run, found an empty file"),
        (b"no netCDF", "results.nc: file: expected results in netCDF, found "),
        (b"\x89HDF\r\n\x1a\n" + b"\x00" * 500, "results.nc: file: expected results in netCDF, fou"),
    ],
)
def test_results_that_are_none(
    content: bytes, says: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "results.nc").write_bytes(content)
    for form in ("table", "json"):
        assert command("show", tmp_path, "--format", form) == 2
        out, err = capsys.readouterr()
        assert out == ""
        assert says in err


def test_results_of_another_program(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    import xarray as xr

    other = xr.Dataset({"label": ("point", ["a"])}, attrs={"format": FORMAT - 1})
    other.to_netcdf(tmp_path / "results.nc", engine="h5netcdf")
    assert command("show", tmp_path) == 2
    err = capsys.readouterr().err
    says = f"expected results of format {FORMAT}, found format {FORMAT - 1}, of another version of"
    assert says in err

    other.attrs["format"] = FORMAT
    other.to_netcdf(tmp_path / "results.nc", engine="h5netcdf")
    assert command("show", tmp_path) == 2
    says = "results.nc: attribute 'checksum': expected the checksums of a run, in JSON, found none"
    assert says in capsys.readouterr().err


def test_a_folder_that_cannot_be_written_to(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(self: Path, *_: object, **__: object) -> None:
        raise PermissionError(13, "Permission denied", str(self))

    # Permissions do not bind the administrator, as whom containers often run their tests.
    monkeypatch.setattr(Path, "mkdir", refuse)
    for arguments in (["run", folder / "chain.toml", "-o", folder / "x"], ["init", folder / "x"]):
        assert command(*arguments) == 2
        err = capsys.readouterr().err
        assert "x: folder: expected a folder that can be written to, found" in err
        assert "no permission" in err


def test_the_module_is_the_command(folder: Path) -> None:
    def run(*arguments: str) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, "-m", "modefront", *arguments]
        return subprocess.run(command, capture_output=True, text=True, check=False)

    (folder / "wrong.toml").write_text(edited(STUDY, ("seed = 1", "seed = -1")))
    done = run("run", str(folder / "wrong.toml"))
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr.startswith(f"{folder}/wrong.toml: [study] seed: expected a whole number")
    assert done.stderr.count("\n") == 1
    assert not (folder / "wrong-results").exists()
    assert run("--help").returncode == 0
