"""The types of the public functions reject what the functions reject."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

import modefront

HERE = Path(__file__).parent
MARK = "# rejected"


@pytest.mark.slow(15)
@pytest.mark.skipif(find_spec("mypy") is None, reason="needs mypy")
def test_mypy_rejects_every_marked_line_and_no_other() -> None:
    file = HERE / "rejected.py"
    lines = file.read_text(encoding="utf-8").splitlines()
    marked = {n for n, line in enumerate(lines, start=1) if MARK in line}
    source = Path(modefront.__file__).parents[1]
    command = [sys.executable, "-m", "mypy", "--no-error-summary", "--no-pretty", str(file)]
    done = subprocess.run(
        command,
        cwd=HERE.parents[1],
        env={**os.environ, "MYPYPATH": str(source)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 1, done.stdout + done.stderr
    reported = re.findall(r"^(.*?):(\d+): error: (.*)$", done.stdout, re.MULTILINE)
    assert {Path(name).name for name, _, _ in reported} == {file.name}, done.stdout
    rejected = {int(line) for _, line, _ in reported}
    assert len(marked) > 40
    assert {n: lines[n - 1] for n in marked - rejected} == {}
    assert [text for _, line, text in reported if int(line) not in marked] == []
