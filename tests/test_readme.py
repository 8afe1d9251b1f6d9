"""The README's Python does what it says."""

import re
from pathlib import Path

import numpy as np
import pytest
from scipy import linalg

import modefront

pytestmark = pytest.mark.usefixtures("short_chains")

README = Path(__file__).parents[1] / "README.md"


def test_the_python_example_runs(capsys: pytest.CaptureFixture[str]) -> None:
    (code,) = re.findall(r"```python\n(.*?)```", README.read_text(encoding="utf-8"), re.DOTALL)
    assert len(code.strip().splitlines()) <= 14
    names: dict[str, object] = {}
    exec(code, names)
    printed = capsys.readouterr().out
    assert "most-probable" in printed
    results = names["results"]
    assert isinstance(results, modefront.Results)
    labels = results.dataset.label.values.tolist()
    edge = results.dataset.theta.values[labels.index("edge-frequencies")]
    k1, k2, k3 = 84763.8 * edge
    K = np.array([[k1 + k2, -k2, 0], [-k2, k2 + k3, -k3], [0, -k3, k3]])
    lam = linalg.eigh(K, np.diag([22.6, 22.6, 17.176]), eigvals_only=True)
    assert np.sqrt(lam) / (2 * np.pi) == pytest.approx([4.646, 13.81, 19.48], rel=1e-6)
