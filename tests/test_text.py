"""Texts that come from elsewhere are printed, and made into file names, without harm."""

from __future__ import annotations

import errno
import io
import os
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest
from refusals import command

import modefront as mf
from modefront.cli.terminal import prepare
from modefront.errors import MOST_CHARACTERS, MOST_LINES, Fault, reason
from modefront.text import FILE_NAME, SPELLED, Shown, clean, file_name, one_line

HOSTILE = "a\x1b]0;title\x07\x9b31m\r\n\u202e\u2028\udc80b"


def test_orders_to_a_terminal_are_escaped() -> None:
    shown = clean(HOSTILE)
    assert shown.isprintable()
    assert shown == r"a\x1b]0;title\x07\x9b31m\r\n\u202e\u2028\udc80b"
    assert one_line(f" {HOSTILE}\n\nmore ", 300).isprintable()
    assert clean("Grüße, 漢字, naïve ±") == "Grüße, 漢字, naïve ±"


@pytest.mark.parametrize("most", [20, 80, 500])
def test_long_texts_keep_their_ends(most: int) -> None:
    shown = clean("begin" + "\x1b" * 10**6 + "end", most)
    assert len(shown) == most
    assert shown.startswith("begin")
    assert shown.endswith("end")


def test_file_names() -> None:
    taken: list[str] = []
    for name in ("Roof", "roof", "ROOF", "../roof", "x" * 5000, "x" * 4999, "nul", "", HOSTILE):
        taken.append(file_name(name, taken))
    assert len({each.casefold() for each in taken}) == len(taken)
    assert max(map(len, taken)) <= FILE_NAME + 2
    for each in taken:
        assert all(c.isalnum() or c in "-_" for c in each)
    assert "nul" not in taken


@pytest.mark.parametrize("encoding", ["ascii", "latin-1", "cp1252", "utf-8"])
def test_terminals_of_any_encoding(encoding: str, monkeypatch: pytest.MonkeyPatch) -> None:
    raw = io.BytesIO()
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(raw, encoding=encoding))
    prepare()
    print("".join(SPELLED), "漢\udc80")
    sys.stdout.flush()
    written = raw.getvalue().decode(encoding)
    assert r"\udc80" in written
    if encoding == "ascii":
        assert written.startswith("+-x/...")
        assert r"\u6f22" in written


def test_messages_have_a_limit() -> None:
    fault = Fault("f" * 5000, "p" * 5000, "e" * 5000, HOSTILE * 1000)
    many = mf.InputError(fault for _ in range(100_000))
    assert len(str(fault)) < MOST_CHARACTERS
    assert str(fault).isprintable()
    for text in (str(many), str(mf.InputError([Fault("a", "b", "c", "d")] * 1000))):
        assert len(text) <= MOST_CHARACTERS
        assert len(text.splitlines()) <= MOST_LINES
        assert text.splitlines()[-1].endswith("more that are wrong")
    assert len(many.faults) == 100_000


def test_errors_of_the_system_are_in_words() -> None:
    for number in errno.errorcode:
        text = reason(OSError(number, os.strerror(number), "file"))
        assert text
        assert "Errno" not in text
    assert reason(MemoryError()).startswith("more than fits")
    assert reason(ValueError()) == "ValueError"
    with pytest.raises(UnicodeEncodeError) as error:
        "ä".encode("ascii")
    assert reason(error.value) == "characters that ascii lacks"


@pytest.mark.parametrize("arguments", [("check", f"{HOSTILE}.toml"), (f"--{HOSTILE}",), (HOSTILE,)])
def test_arguments_are_not_orders_to_the_terminal(
    arguments: tuple[str, ...], capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    assert command(*arguments) == 2
    out, err = capsys.readouterr()
    assert not out
    assert all(line.isprintable() for line in err.split("\n"))


def test_a_record_is_shown_in_short_lines() -> None:
    @dataclass(repr=False)
    class Two(Shown):
        files: tuple[Path, ...]
        ratios: tuple[float, ...]

    shown = Two((Path("a/<b>.csv"), Path("c.csv")), (1 / 3, 2.0))
    assert repr(shown) == f"Two\n  files   {Path('a/<b>.csv')}, c.csv\n  ratios  0.333333, 2"
    assert "&lt;b&gt;" in shown._repr_html_()
