"""The snippet of docs/programs.md, run by OpenSees where its package is installed."""

from __future__ import annotations

import importlib.metadata
import re
import subprocess
import sys
from pathlib import Path

import pytest

from modefront.programs.importing import import_model

PAGE = Path(__file__).parents[2] / "docs" / "programs.md"

MODEL = """
import openseespy.opensees as ops

for job, E, k in (("base", 1, 1), ("E", 2, 1), ("k", 1, 2), ("check", 0.7, 3)):
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    for i in range(6):
        ops.node(i + 1, 0.0, 0.0, float(i))
    ops.fix(1, 1, 1, 1, 1, 1, 1)
    ops.geomTransf("Linear", 1, 0, 1, 0)
    for i in range(5):
        section = (1e-3, 2e11 * E, 8e10, 1e-6, 1.5e-6, 2e-6)
        ops.element("elasticBeamColumn", i + 1, i + 1, i + 2, *section, 1, "-mass", 7.8, "-cMass")
    ops.node(100, 0.0, 0.0, 5.0)
    ops.fix(100, 1, 1, 1, 1, 1, 1)
    ops.uniaxialMaterial("Elastic", 1, 5e3 * k)
    ops.element("zeroLength", 99, 6, 100, "-mat", 1, "-dir", 1)
    if job == "base":
        print(*[lam**0.5 / 6.283185307179586 for lam in ops.eigen(4)])
    write_matrices(ops, job)
"""


def snippet() -> str:
    (code,) = re.findall(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    return str(code)


def test_the_snippet_is_python() -> None:
    compile(snippet(), str(PAGE), "exec")


def reason() -> str:
    """Return why OpenSees cannot be run here, empty where it can."""
    try:
        version = importlib.metadata.version("openseespy")
    except importlib.metadata.PackageNotFoundError:
        return "openseespy is not installed"
    old = tuple(map(int, version.split(".")[:2])) < (3, 8)
    return f"openseespy {version} has no PythonSparse (3.8 has it, for Python 3.12)" if old else ""


@pytest.mark.skipif(bool(reason()), reason=reason())
def test_opensees_hands_over_its_matrices(tmp_path: Path) -> None:
    (tmp_path / "model.py").write_text(snippet() + MODEL)
    command = [sys.executable, "model.py"]
    done = subprocess.run(command, cwd=tmp_path, check=True, capture_output=True, text=True)
    frequencies = [float(x) for x in done.stdout.split()[:4]]
    runs = {"E": tmp_path / "E", "k": tmp_path / "k"}
    checks = [(tmp_path / "check", {"E": 0.7, "k": 3.0})]
    result = import_model("opensees", tmp_path / "base", runs, checks=checks)
    assert result.frequencies is not None
    assert result.frequencies[:4] == pytest.approx(frequencies, rel=1e-8)
    assert result.errors[0] < 1e-14
    assert result.terms.dofs.sensor(6, "x") == [(24, 1.0)]
