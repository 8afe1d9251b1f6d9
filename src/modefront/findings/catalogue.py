"""All sentences by their kinds: of findings, the most important first, and of the verdict.

They are on the pages ``findings.md`` and ``verdicts.md``: below the name of a kind there are its
sentence in a comment, an example, what it means and what to do. A heading is how severe the
findings below it are. In sentences, ``{name}`` is a value, and ``{it|them}`` has the words for one
and several subjects. Those of mistakes say what is wrong before the first semicolon, and what mends
it behind. A page of another form is an error when the program starts.
"""

import re
from collections.abc import Mapping, Sequence
from enum import Enum
from pathlib import Path
from textwrap import dedent
from typing import NamedTuple


class Severity(Enum):
    """How severe a finding is, by the question that it answers."""

    MISTAKE = "What is wrong with model or data"
    FAILURE = "What was not done"
    FIT = "How well the models do"
    CAUTION = "What to beware of"
    OPEN = "What the data leave open"
    DETAIL = "How it was found"


class Said(NamedTuple):
    """What a page says of a kind; the text of what it means and what to do is Markdown."""

    heading: str
    sentence: str
    text: str

    @property
    def pattern(self) -> str:
        """The regular expression of what the sentence can say."""
        return ".+".join(map(re.escape, re.split(r"\{[a-z]+(?::[^{}]*)?\}", self.sentence)))

    @property
    def meaning(self) -> list[str]:
        """What it means and what to do, in paragraphs without links; lines of a study as such."""
        parts = [dedent(x).strip() for x in self.text.split("\n\n")]
        return [
            x
            if x.startswith("```")
            else re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", " ".join(x.split()))
            for x in parts
            if x and not x.startswith("|")
        ]


def _kinds(name: str) -> dict[str, Said]:
    """Return what a page says of each of its kinds; raises ValueError for one without sentence."""
    out, page = {}, Path(__file__).with_name(name).read_text(encoding="utf-8")
    for part in page.split("\n## ")[1:]:
        heading, *kinds = part.split("\n### ")
        for each in kinds:
            kind, comment, _, text = f"{each}\n\n".split("\n", 3)
            (sentence,) = re.findall(r"^<!-- (.*) -->$", comment)
            out[kind] = Said(heading.partition("\n")[0], sentence, text)
    return out


CATALOGUE: Mapping[str, Said] = _kinds("findings.md")
"""What is said of each kind of findings, by its name."""

VERDICT: Mapping[str, Said] = _kinds("verdicts.md")
"""What is said in the first answer, and of reasons of a refusal, by their names."""


def _units(text: str) -> list[tuple[float, str, str]]:
    """Return the rows of a table of units; raises ValueError where there are none."""
    _, _, first, *rows = [line for line in text.splitlines() if line.startswith("|")]
    cells = [row.strip("| ").split(" | ") for row in (first, *rows)]
    return [(float(factor), looks, mend) for factor, looks, mend in cells]


UNITS: Sequence[tuple[float, str, str]] = _units(CATALOGUE["frequency-factor"].text)
"""Measured frequencies over the model's, what makes them so, and what mends it."""
