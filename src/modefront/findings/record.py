"""Findings: kind, subject, and the numbers and names of their sentences."""

import json
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from modefront.findings.catalogue import CATALOGUE, VERDICT, Severity
from modefront.text import Shown

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
