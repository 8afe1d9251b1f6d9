"""Findings, and the catalogue of all sentences: of findings and of the verdict.

The sentences are on the pages ``findings.md``, the most important first, and ``verdicts.md``: below
the name of a kind there are its sentence in a comment, an example, what it means and what to do. A
heading is how severe the findings below it are. In sentences, ``{name}`` is a value, and
``{it|them}`` has the words for one and several subjects. Those of mistakes say what is wrong before
the first semicolon, and what mends it behind.
"""

import json
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from textwrap import dedent
from typing import Any, NamedTuple

from modefront.text import Shown


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
        said = [x for x in parts if x and not x.startswith("|")]
        plain = [re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", " ".join(x.split())) for x in said]
        return [x if x.startswith("```") else y for x, y in zip(said, plain, strict=True)]


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

NUMBER = re.compile(r"\{([^{}|]*)\|([^{}|]*)\}")
"""Words of a sentence on one subject, and on several."""


@dataclass(frozen=True, repr=False)
class Finding(Shown):
    """What was found."""

    kind: str  # its name in the catalogue
    subject: str  # what it is about: parameters, groups, modes or models
    numbers: Mapping[str, Any]  # further values of its sentence, by name
    many: bool = False  # whether the sentence is on several subjects
    others: "tuple[Finding, ...]" = ()  # what may be wrong instead, where the data cannot tell
    evidence: str = ""  # what else shows it, in brackets
    # logarithm of the odds against the best explanation without it; NaN where none was sought
    gain: float = float("nan")

    @property
    def severity(self) -> Severity:
        """How severe it is."""
        return Severity(CATALOGUE[self.kind].heading)

    def __repr__(self) -> str:
        """Return the kind and the sentence."""
        return f"{self.kind}: {self}"

    def __str__(self) -> str:
        """Return the sentence: with a small letter first, and without a full stop."""
        (wrong, remedy), evidence = self._halves, self.evidence
        if self.others:
            said = "".join(f", or {other._halves[0]}" for other in self.others)
            evidence = f"{said} (the data cannot tell){evidence}"
        return f"{wrong}{evidence}; {remedy}" if remedy else f"{wrong}{evidence}"

    @property
    def _halves(self) -> tuple[str, str]:
        """What is before the first semicolon of the sentence, and what is behind it."""
        text = NUMBER.sub(lambda words: words[1 + self.many], CATALOGUE[self.kind].sentence)
        wrong, _, remedy = text.partition("; ")
        values = {"subject": self.subject, **self.numbers}
        return wrong.format(**values), remedy.format(**values)

    @property
    def meaning(self) -> list[str]:
        """What it means and what to do, in paragraphs; none of a kind that says so itself."""
        return CATALOGUE[self.kind].meaning

    def as_plain(self) -> dict[str, Any]:
        """Return the finding as JSON has it."""
        named = {"kind": self.kind, "severity": self.severity.name.lower(), "subject": self.subject}
        parts: dict[str, dict[str, Any]] = {"numbers": {}, "words": {}}
        for name, value in self.numbers.items():
            parts["words" if isinstance(value, str) else "numbers"][name] = value
        return named | parts | {"text": str(self)}


def found(kind: str, subject: str = "", *, many: bool = False, **numbers: Any) -> Finding:
    """Return a finding of a kind; other keywords are the numbers of its sentence."""
    return Finding(kind, subject, numbers, many)


def meaning_of(sentence: str) -> list[str]:
    """Return what a sentence of the verdict means and what to do, in paragraphs."""
    kinds = {**VERDICT, "bound": CATALOGUE["bound"]}
    return [text for x in kinds.values() if re.search(x.pattern, sentence) for text in x.meaning]


def in_order(findings: Iterable[Finding]) -> list[Finding]:
    """Return findings in the order of the catalogue, those of a kind as they are given."""
    order = {kind: k for k, kind in enumerate(CATALOGUE)}
    return sorted(findings, key=lambda finding: order[finding.kind])


def as_text(finding: Finding) -> str:
    """Return kind, subject and numbers as a file keeps them."""
    return json.dumps([finding.kind, finding.subject, dict(finding.numbers), finding.many])


def from_text(text: str, sentence: str) -> Finding:
    """Return the finding that a file keeps; of another version of the catalogue, its sentence."""
    try:
        kind, subject, numbers, many = json.loads(text)
        finding = found(str(kind), str(subject), many=bool(many), **numbers)
        if str(finding) == sentence:
            return finding
    except (ValueError, TypeError, KeyError, IndexError):
        pass
    return found("other", sentence)
