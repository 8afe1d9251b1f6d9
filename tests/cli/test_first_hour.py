"""The first hour: every command ends with the next one, which works when it is pasted."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest
from refusals import command

README = Path(__file__).parents[2] / "README.md"


@pytest.mark.slow(9)
def test_each_command_names_the_next_until_the_report(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    words = ["init", "my study"]
    done: list[str] = []
    while words and len(done) < 6:
        assert command(*words) == 0
        done.append(words[0])
        out = capsys.readouterr().out
        if done[-1] == "show":
            assert 20 <= len(out.splitlines()) <= 30
        lines = re.findall(r"^next: modefront (.+)$", out, re.MULTILINE)
        assert len(lines) <= 1
        words = shlex.split(lines[0]) if lines else []
    assert done == ["init", "check", "run", "show", "report", "export"]
    assert (tmp_path / "my study" / "study-results" / "report.html").stat().st_size < 1e6


@pytest.mark.usefixtures("short_chains")
@pytest.mark.slow(4)
def test_the_commands_of_the_readme_run_one_after_another(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    text = README.read_text(encoding="utf-8")
    lines = re.findall(r"^modefront (.+?) +#.*$", text, re.MULTILINE)
    assert [line.split()[0] for line in lines] == [
        *("init", "check", "run", "show", "report"),
        *("init", "run", "compare"),
    ]
    for line in lines:
        assert command(*shlex.split(line)) == 0, line
    assert (tmp_path / "report.html").is_file()
