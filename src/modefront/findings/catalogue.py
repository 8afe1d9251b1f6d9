"""All sentences by their kinds: of findings, the most important first, and of the verdict.

They are on the pages ``findings.md`` and ``verdicts.md``: below the name of a kind there are its
sentence in a comment, an example, what it means and what to do. A heading is how severe the
findings below it are. In sentences, ``{name}`` is a value, and ``{it|them}`` has the words for one
and several subjects. Those of mistakes say what is wrong before the first semicolon, and what mends
it behind.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from enum import Enum
from pathlib import Path


class Severity(Enum):
    """How severe a finding is, by the question that it answers."""

    MISTAKE = "What is wrong with model or data"
    FAILURE = "What was not done"
    FIT = "How well the models do"
    CAUTION = "What to beware of"
    OPEN = "What the data leave open"
    DETAIL = "How it was found"


def page(name: str) -> str:
    """Return the text of a page of sentences."""
    return Path(__file__).with_name(name).read_text(encoding="utf-8")


def _kinds(name: str) -> Iterator[tuple[str, str, str]]:
    """Yield heading, kind and sentence of each kind on a page."""
    heading = ""
    for match in re.finditer(r"^## (.*)|^### (.*)\n<!-- (.*) -->", page(name), re.MULTILINE):
        heading = match[1] or heading
        if match[2]:
            yield heading, match[2], match[3]


CATALOGUE: Mapping[str, tuple[Severity, str]] = {
    kind: (Severity(heading), sentence) for heading, kind, sentence in _kinds("findings.md")
}
"""Severity and sentence of each kind of findings, by its name."""

VERDICT: Mapping[str, str] = {kind: sentence for _, kind, sentence in _kinds("verdicts.md")}
"""Sentences of the first answer, and reasons of a refusal, by their names."""

UNITS: Sequence[tuple[float, str, str]] = [
    (float(factor), looks, mend)
    for factor, looks, mend in re.findall(
        r"^\| ([\d.e+-]+) \| (.*) \| (.*) \|$", page("findings.md"), re.MULTILINE
    )
]
"""Measured frequencies over the model's, what makes them so, and what mends it."""
