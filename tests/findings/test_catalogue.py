"""Every kind of finding is on the page of findings, with an example that its sentence makes."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from modefront.findings import record
from modefront.findings.record import (
    CATALOGUE,
    NUMBER,
    Severity,
    as_text,
    found,
    from_text,
    in_order,
)

TEXT = Path(record.__file__).with_name("findings.md").read_text(encoding="utf-8")
EXAMPLES = dict(re.findall(r"^### (\S+)\n<!-- .+ -->\n> (.+)$", TEXT, re.MULTILINE))


def pattern(sentence: str, many: bool) -> str:
    """Return the regular expression of what a sentence can say."""
    words = NUMBER.sub(lambda match: match[1 + many], sentence)
    parts = re.split(r"\{[a-z]+(?::[^{}]*)?\}", words)
    return "(?s:.*)".join(map(re.escape, parts))


def test_the_page_has_a_sentence_and_an_example_of_every_kind() -> None:
    assert list(EXAMPLES) == list(CATALOGUE) == re.findall(r"^### (\S+)$", TEXT, re.MULTILINE)
    assert [*dict.fromkeys(x.heading for x in CATALOGUE.values())] == [x.value for x in Severity]


@pytest.mark.parametrize("kind", CATALOGUE)
def test_the_example_on_the_page_is_what_the_kind_says(kind: str) -> None:
    sentence = CATALOGUE[kind].sentence
    assert any(re.fullmatch(pattern(sentence, many), EXAMPLES[kind]) for many in (False, True))
    assert found(kind).severity is Severity.DETAIL or not re.search(
        rf"^### {kind}\n<!-- .* -->\n> .*\n\n#", TEXT, re.MULTILINE
    ), "what it means, and what to do"


def test_a_page_of_another_form_is_an_error_and_no_kind_or_unit_less() -> None:
    assert len(record.UNITS) == TEXT.count("\n|") - 2
    for text in ("no table", "| a | b | c |\n|---|---|---|", "| a |\n|---|\n| six | a | b |"):
        with pytest.raises(ValueError, match=r"unpack|convert"):
            record._units(text)


def test_a_finding_says_what_it_means_without_marks_of_a_page() -> None:
    (text,) = found("group-data", "shapes").meaning
    assert text.startswith("What one group alone determines.")
    for kind in CATALOGUE:
        assert not any(x in text for text in found(kind).meaning for x in ("](", "#"))


def test_a_record_is_kept_whole_and_one_that_is_not_known_as_its_sentence() -> None:
    alike = found("alike", "a, b, c and {d}", many=True, where="at nbi-1: ")
    assert str(alike).endswith("{d} have nearly the same effect on all residuals: fix or tie all "
                               "but one")  # fmt: skip
    assert repr(from_text(as_text(alike), str(alike))) == repr(alike)
    for kept in ("", "[]", '["alike", "a", {}, true]', '["else", "a", {}, true]'):
        assert str(from_text(kept, "as it was")) == "as it was"
    assert alike.as_plain()["severity"] == "open"
    spent = found("effort", spent=30, front=9, why="; by chance").as_plain()
    assert spent["numbers"] == {"spent": 30, "front": 9}
    assert spent["words"] == {"why": "; by chance"}
    assert in_order([alike, found("one-model")])[0].kind == "one-model"
