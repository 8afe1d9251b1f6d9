"""What is released holds what it must and nothing else."""

from __future__ import annotations

import os
import re
import sys
import tarfile
import tomllib
import zipfile
from pathlib import Path

import pytest
from flit_core import buildapi

import modefront

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "src" / "modefront"


def sources() -> set[str]:
    """Return the files of the package, named as in a wheel."""
    files = (path for path in PACKAGE.rglob("*") if path.is_file())
    return {
        f"modefront/{path.relative_to(PACKAGE).as_posix()}"
        for path in files
        if "__pycache__" not in path.parts
    }


@pytest.fixture
def at_root(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")


@pytest.mark.usefixtures("at_root")
def test_a_wheel_holds_the_package_and_its_licence_and_nothing_else(tmp_path: Path) -> None:
    name = buildapi.build_wheel(os.fspath(tmp_path))
    with zipfile.ZipFile(tmp_path / name) as wheel:
        names = set(wheel.namelist())
        information = f"modefront-{modefront.__version__}.dist-info"
        described = wheel.read(f"{information}/METADATA").decode()
    rest = {"METADATA", "RECORD", "WHEEL", "entry_points.txt", "licenses/LICENSE"}
    assert names == sources() | {f"{information}/{each}" for each in rest}
    for extra in ("mesh", "metrics", "evolutionary", "figures", "cluster"):
        assert f"Provides-Extra: {extra}" in described


@pytest.mark.usefixtures("at_root")
def test_an_sdist_builds_the_same_package(tmp_path: Path) -> None:
    name = buildapi.build_sdist(os.fspath(tmp_path))
    with tarfile.open(tmp_path / name) as archive:
        names = {each.name.split("/", 1)[1] for each in archive.getmembers() if each.isfile()}
    assert {f"src/{each}" for each in sources()} < names
    rest = {each for each in names if not each.startswith("src/")}
    assert rest == {"LICENSE", "README.md", "pyproject.toml", "PKG-INFO"}


def test_the_version_and_the_needs_are_the_same_everywhere() -> None:
    with (ROOT / "pyproject.toml").open("rb") as file:
        project = tomllib.load(file)["project"]
    recipe = (ROOT / "packaging" / "recipe.yaml").read_text(encoding="utf-8")
    run = recipe.split("  run:\n")[1].split("\n\n")[0]
    needed = {re.sub(r"\s", "", line.strip("- ")) for line in run.splitlines()[1:]}
    assert needed == set(project["dependencies"])
    version = modefront.__version__
    assert f'version: "{version}"' in recipe
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert f"version: {version}" in citation
    changes = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    assert f"## {version}" in changes
    assert all(len(each.strip().splitlines()) <= 12 for each in changes.split("## ")[1:])
    assert sys.version_info >= tuple(map(int, project["requires-python"].strip(">=").split(".")))
