"""The snippet of docs/programs.md, run by OpenSees where its package is installed."""

from __future__ import annotations

import importlib.metadata
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.linalg
import scipy.sparse

from modefront.study.importing import import_model

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


class StandIn:
    """What the snippet calls of OpenSees, for two masses between springs along x.

    Node 11 follows node 9 in x: its own directions come first in the answer of OpenSees, then those
    of node 9.
    """

    def __init__(self, k: float) -> None:
        self.K = scipy.sparse.csr_array([[3.0 + k, -k], [-k, k]])
        self.M = scipy.sparse.csr_array(np.diag([2.0, 1.0]))

    def __getattr__(self, name: str) -> Callable[..., None]:
        assert name in ("wipeAnalysis", "constraints", "numberer", "test", "algorithm", "analysis")
        return lambda *_: None

    def system(self, _: str, options: dict[str, Any]) -> None:
        self.solver = options["solver"]

    def integrator(self, _: str, m: float, c: float, k: float) -> None:
        assert c == 0
        self.matrix = m * self.M + k * self.K

    def analyze(self, *_: object) -> None:
        A = scipy.sparse.csr_array(self.matrix)
        index_ptr, indices = (x.astype(np.int32).tobytes() for x in (A.indptr, A.indices))
        self.solver.solve(index_ptr, indices, A.data.tobytes(), A.shape[0], rhs=None)

    def getNodeTags(self) -> list[int]:
        return [4, 7, 9, 11]

    def nodeCoord(self, node: int) -> list[float]:
        return [float(node), 0.0]

    def nodeDOFs(self, node: int) -> list[int]:
        return {4: [-1, -1], 7: [1, -1], 9: [0, -1], 11: [-1, 0]}[node]

    def getConstrainedDOFs(self, node: int) -> list[int]:
        return [1] if node == 11 else []

    def nodeDisp(self, _: int) -> list[float]:
        return [0.0, 0.0]

    def getEleTags(self) -> list[int]:
        return [1, 2]

    def eleNodes(self, element: int) -> list[int]:
        return [[4, 7], [7, 9]][element - 1]


def test_the_snippet_writes_what_is_imported(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    exec(compile(snippet(), str(PAGE), "exec"), names)
    for job, k in (("base", 5.0), ("k", 10.0)):
        names["write_matrices"](StandIn(k), job)
    result = import_model("opensees", tmp_path / "base", {"k": tmp_path / "k"})
    assert result.terms.dofs.sensor(9, "x") == [(0, 1.0)]
    assert result.terms.dofs.sensor(7, "x") == [(1, 1.0)]
    lam = scipy.linalg.eigvalsh(StandIn(5.0).K.toarray(), StandIn(5.0).M.toarray())
    assert result.frequencies == pytest.approx(np.sqrt(lam) / (2 * np.pi))


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
