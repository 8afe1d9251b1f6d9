"""Text that comes from files, other programs and users, made fit for terminals and file names."""

from __future__ import annotations

import codecs
import re
from collections.abc import Iterable, Mapping

NAME, FILE_NAME = 80, 60
"""Characters of a name that messages show, and of a file name made from one, without its ending."""

RESERVED = frozenset(
    ("con", "prn", "aux", "nul", *(f"{port}{n}" for port in ("com", "lpt") for n in range(10)))
)
"""Names that are devices on Windows, whatever their ending."""

_SPELLED = (
    "± +-,× x,÷ /,… ...,– -,— -,− -,² ^2,³ ^3,⁺ +,· *,√ sqrt,≤ <=,≥ >=,≈ ~,°  deg,→ ->,"
    "‘ ',’ ',“ \",” \",─ -,━ -,│ |,• *,█ #,θ theta,φ phi,λ lambda,σ sigma,ζ zeta"
)
SPELLED: Mapping[str, str] = dict(row.split(" ", 1) for row in _SPELLED.split(","))
"""Replacements for characters of the program that an encoding lacks."""

SPELL = "modefront-spell"
"""Name of the error handler of encodings that spells what they lack, see `SPELLED`."""


def clean(text: object, most: int | None = None) -> str:
    r"""Return a text in which all that is not printable is escaped, with ``most`` characters.

    A longer text loses its middle.

    >>> clean("a\x1b[31mb\nc")
    'a\\x1b[31mb\\nc'
    >>> clean("x" * 50 + "end", 13)
    'xxxxxxxx … nd'
    """
    given = str(text)
    if most is not None and len(given) > most:
        # All that is left out could be escaped; only what is shown is looked at.
        given = shortened(given, most)
    if given.isprintable():
        return given
    escaped = "".join(c if c.isprintable() else _escape(c) for c in given)
    return escaped if most is None else shortened(escaped, most)


def shortened(text: str, most: int) -> str:
    """Return a text with ``most`` characters: of a longer one, the beginning and some of the end.

    >>> shortened("abcdefghijklmnopqrstuvwxyz", 12)
    'abcdefg … yz'
    """
    if len(text) <= most:
        return text
    tail = (most - 3) // 4
    return f"{text[: most - 3 - tail]} … {text[len(text) - tail :]}"


def one_line(text: object, most: int | None = None) -> str:
    r"""Return the output of another program on one line, clean.

    >>> one_line("cannot be read:\n   line 3")
    'cannot be read: line 3'
    """
    given = str(text)
    if most is not None:
        given = given[: 20 * most]
    return clean(" ".join(given.split()), most)


def file_name(name: str, taken: Iterable[str] = ()) -> str:
    """Return a file name, without ending, that is made from a name and not yet taken.

    Letters of all scripts, digits, ``-`` and ``_`` are kept. Names that differ in case only are
    the same on some drives, so such a one gets a number.

    >>> file_name("frf ../roof", ["FRF-roof"])
    'frf-roof-2'
    """
    kept = re.sub(r"[^\w-]+", "-", name[:FILE_NAME]) or "-"
    if kept.casefold() in RESERVED:
        kept = f"{kept}-"
    used = {each.casefold() for each in taken}
    out, number = kept, 1
    while out.casefold() in used:
        number += 1
        out = f"{kept}-{number}"
    return out


def _escape(character: str) -> str:
    return character.encode("unicode_escape").decode("ascii")


def _spell(error: UnicodeError) -> tuple[str, int]:
    """Return the replacement of characters that an encoding lacks, and the position behind them."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    lacking = error.object[error.start : error.end]
    return "".join(SPELLED.get(c) or _escape(c) for c in lacking), error.end


codecs.register_error(SPELL, _spell)
