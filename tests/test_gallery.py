"""The gallery: eight pages, each with a study that ``init`` writes, and what is signed."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from modefront.study.examples import names

GALLERY = Path(__file__).parents[1] / "docs" / "gallery"
PAGES = sorted(path.stem for path in GALLERY.glob("*.md") if path.stem != "index")
INDEX = (GALLERY / "index.md").read_text(encoding="utf-8")


def test_the_index_lists_every_page_with_an_example_that_there_is() -> None:
    listed = re.findall(r"^\| \[[^]]+\]\(([a-z-]+)\.md\): `([a-z0-9-]+)` \|", INDEX, re.MULTILINE)
    assert len(listed) == 8
    assert sorted(page for page, _ in listed) == PAGES
    for page, example in listed:
        assert example in names()
        assert f"--example {example} " in (GALLERY / f"{page}.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("page", PAGES)
def test_a_page_is_short_and_ends_with_what_is_signed(page: str) -> None:
    text = (GALLERY / f"{page}.md").read_text(encoding="utf-8")
    assert len(text.split()) <= 1500
    signed = text.partition("## What an engineer concludes and signs\n")[2]
    said, _, checks = signed.partition("```{code-cell}\n:tags: [remove-cell]\n")
    assert 3 <= len(re.findall(r"[.?!](?=\s|\*)", said)) <= 6
    assert "assert" in checks, "numbers of the text are compared with the run"
