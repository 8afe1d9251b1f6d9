"""Every sentence of the verdict is on its page, with an example, its meaning and what to do."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest

from modefront.findings.catalogue import VERDICT

DOCS = Path(__file__).parents[2] / "docs"
TEXT = (DOCS / "verdicts.md").read_text(encoding="utf-8")
SECTIONS = dict(re.findall(r"^### ([^\n]+)\n(.+?)(?=^##|\Z)", TEXT, re.MULTILINE | re.DOTALL))
HOW_TO = ("verdicts", "choose", "read-a-front", "modes-swap", "undetermined", "large-models")


def test_the_page_has_every_sentence_and_no_other() -> None:
    assert list(SECTIONS) == list(VERDICT)


@pytest.mark.parametrize("kind", VERDICT)
def test_the_example_is_what_the_sentence_says_and_advice_follows(kind: str) -> None:
    example, _, advice = SECTIONS[kind].partition("\n")
    parts = re.split(r"\{[a-z]+(?::[^{}]*)?\}", VERDICT[kind])
    assert re.fullmatch(".+".join(map(re.escape, parts)), example.removeprefix("> "))
    assert len(advice.split()) > 5


@pytest.mark.parametrize("name", HOW_TO)
def test_lines_to_paste_are_toml(name: str) -> None:
    text = (DOCS / f"{name}.md").read_text(encoding="utf-8")
    lines = re.findall(r"^ *```toml\n(.*?)```", text, re.MULTILINE | re.DOTALL)
    assert lines or name == "read-a-front"
    for each in lines:
        assert tomllib.loads(each)
