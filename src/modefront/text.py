"""Text from files, other programs and users, made fit for terminals and file names, and records."""

import codecs
import html
import json
import re
import sys
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import fields
from itertools import chain, count
from operator import methodcaller
from pathlib import Path
from typing import Any

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


def clean(text: object, most: int = sys.maxsize) -> str:
    r"""Return a text in which all that is not printable is escaped, with ``most`` characters.

    A longer text loses its middle.

    >>> clean("a\x1b[31mb\nc")
    'a\\x1b[31mb\\nc'
    >>> clean("x" * 50 + "end", 13)
    'xxxxxxxx … nd'
    """
    given = shortened(str(text), most)  # only what is shown is looked at, not all that is given
    if given.isprintable():
        return given
    return shortened("".join(c if c.isprintable() else _escape(c) for c in given), most)


def shortened(text: str, most: int) -> str:
    """Return a text with ``most`` characters: of a longer one, the beginning and some of the end.

    >>> shortened("abcdefghijklmnopqrstuvwxyz", 12)
    'abcdefg … yz'
    """
    if len(text) <= most:
        return text
    tail = (most - 3) // 4
    return f"{text[: most - 3 - tail]} … {text[len(text) - tail :]}"


def one_line(text: object, most: int) -> str:
    r"""Return the output of another program on one line, clean, with ``most`` characters.

    >>> one_line("cannot be read:\n   line 3", 80)
    'cannot be read: line 3'
    """
    return clean(" ".join(str(text)[: 20 * most].split()), most)


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
    names = chain([kept], (f"{kept}-{number}" for number in count(2)))
    return next(name for name in names if name.casefold() not in used)


def _escape(character: str) -> str:
    return character.encode("unicode_escape").decode("ascii")


def _spell(error: UnicodeError) -> tuple[str, int]:
    """Return the replacement of characters that an encoding lacks, and the position behind them."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    lacking = error.object[error.start : error.end]
    return "".join(SPELLED.get(c) or _escape(c) for c in lacking), error.end


codecs.register_error(SPELL, _spell)


def json_of(values: Any, constants: Mapping[str, Any] | None = None, **form: Any) -> str:
    """Return JSON: of arrays lists, and null for what is no number, or what ``constants`` has."""
    text = json.dumps(values, default=methodcaller("tolist"))
    known = json.loads(text, parse_constant=(constants or {}).get)
    return json.dumps(known, allow_nan=False, **form)


LINE, MOST = 96, 18  # characters of a line, and lines of fields


class Shown:
    """A record that is shown in a few lines, in a terminal and in a notebook."""

    def __repr__(self) -> str:
        """Return the class and a line for each field."""
        record: Any = self
        shown = [field.name for field in fields(record) if field.repr]
        width = max(map(len, shown), default=0)
        lines = [f"  {name:{width}}  {_short(getattr(self, name))}"[:LINE] for name in shown]
        more = [f"  and {len(lines) - MOST} more"] * (len(lines) > MOST)
        return "\n".join([type(self).__name__, *lines[:MOST], *more])

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(repr(self))}</pre>"


def brief_model(model: Any) -> str:
    """Return the class of a model and its sizes, as its ``__repr__``."""
    p, k = len(model.parameters), len(model.sensors)
    return (
        f"{type(model).__name__}({p} parameter{'s' * (p != 1)}, {model.size} degrees of freedom, "
        f"{k} sensor{'s' * (k != 1)})"
    )


def _short(value: Any) -> str:
    """Return a value in a line: numbers and texts, or how many and of what."""
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, str | bytes | int | type(None)):
        return repr(value)
    shape = getattr(value, "shape", None)
    if shape is not None:
        if getattr(value, "ndim", 2) == 1 and shape[0] <= 6:
            return " ".join(f"{x:.5g}" for x in value)
        return f"{' x '.join(map(str, shape))} numbers"
    if isinstance(value, Mapping):
        return ", ".join(f"{key} {_short(item)}" for key, item in value.items())
    if isinstance(value, Sequence):
        if all(isinstance(item, str | int | float | Path) for item in value):
            return ", ".join(f"{x:.6g}" if isinstance(x, float) else str(x) for x in value)
        return f"{len(value)} of {type(value[0]).__name__}"
    return str(value) if isinstance(value, Path) else repr(value).splitlines()[0]
