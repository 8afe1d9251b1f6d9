"""Sentences and tables that fit the terminal: wrapped at words, split into blocks, never cut."""

import re
from collections.abc import Iterable, Sequence
from itertools import zip_longest

import numpy as np
from rich.cells import cell_len, chop_cells
from rich.console import Console
from rich.text import Text

from modefront.text import SPELL, clean

GAP, LEAST, KEY = 2, 8, 0.45
"""Spaces between columns; width of one down to which long words are broken; greatest part of the
whole width that the names of the rows take."""

PART = re.compile(r"[^\s_/.-]*[-_/.]|[^\s_/.-]+")
"""Part of a title that is not broken: a word, or what a hyphen or the like ends."""

Row = Sequence[str]

Line = tuple[str, str]  # a line with its style

BLANK: Line = ("", "")


def number(value: float, form: str, none: str = "none") -> str:
    """Return a number in a format; ``none`` for NaN."""
    return none if np.isnan(value) else format(float(value), form)


def plural(count: int, noun: str) -> str:
    """Return a count with its noun.

    >>> plural(1, "model"), plural(2, "model")
    ('1 model', '2 models')
    """
    return f"{count} {noun}{'s' * (count != 1)}"


class Screen(Console):
    """A terminal, or a file of the width that ``COLUMNS`` says, 80 unless given."""

    def on_broken_pipe(self) -> None:
        """Raise BrokenPipeError: its caller is to know that nobody reads any more."""
        raise BrokenPipeError

    @property
    def room(self) -> int:
        """Characters a line."""
        return max(self.width, 20)

    def shown(self, text: object) -> str:
        """Return a text as the terminal can show it."""
        return clean(text).encode(self.encoding, errors=SPELL).decode(self.encoding)

    def say(self, text: object, start: str = "", style: str = "") -> None:
        """Print a sentence, wrapped at words; further lines are indented as far as its start."""
        self.show(self.sentence(text, start, style))

    def sentence(self, text: object, start: str = "", style: str = "") -> list[Line]:
        """Return the lines of a sentence."""
        start = self.shown(start)
        room = max(self.room - cell_len(start), LEAST)
        # Long words, such as paths and commands, are left whole, to be copied.
        lines = _wrapped(self.shown(text), room, whole=True)
        indent = " " * cell_len(start)
        return [(f"{indent if i else start}{line}", style) for i, line in enumerate(lines)]

    def table(self, title: str, columns: Row, rows: Sequence[Row], keys: int = 1) -> None:
        """Print a table after an empty line, as `grid` returns it; none without rows."""
        self.show([BLANK, *self.grid(title, columns, rows, keys)] if rows else [])

    def grid(self, title: str, columns: Row, rows: Sequence[Row], keys: int = 1) -> list[Line]:
        """Return the lines of a table, in blocks where it is too wide.

        The first ``keys`` columns are names of the rows, which every block repeats, within a
        part `KEY` of the width. A row of one cell is a heading within the table.
        """
        titles, *cells = [[self.shown(x) for x in row] for row in (columns, *rows)]
        widths = [max([1, *map(cell_len, PART.findall(title))]) for title in titles]
        for row in (row for row in cells if len(row) > 1):
            widths = [max(width, cell_len(x)) for width, x in zip(widths, row, strict=True)]
        most = max(int(KEY * self.room) // keys, LEAST)
        widths[:keys] = [min(width, most) for width in widths[:keys]]
        room = self.room - sum(widths[:keys]) - GAP * keys
        widths[keys:] = [min(width, room) for width in widths[keys:]]
        blocks: list[list[int]] = [[]]
        for j in range(keys, len(titles)):
            used = sum(widths[i] + GAP for i in blocks[-1])
            if used and used + widths[j] > room:
                blocks.append([])
            blocks[-1].append(j)
        out = self.sentence(title, style="bold") if title else []
        for k, block in enumerate(blocks):
            chosen = [*range(keys), *block]
            of = [widths[j] for j in chosen]
            heads = [_wrapped(titles[j], widths[j], parts=True)[::-1] for j in chosen]
            lines = [_joined(x, of, keys) for x in zip_longest(*heads, fillvalue="")][::-1]
            out += [BLANK] * (k > 0) + [(line, "bold") for line in lines if line.strip()]
            out.append((_joined(["─" * width for width in of], of, keys), "dim"))
            for row in cells:
                if len(row) == 1:
                    out += [(line, "italic") for line in _broken(row[0], self.room)]
                    continue
                parts = [_broken(row[j], widths[j]) for j in chosen]
                out += [(_joined(x, of, keys), "") for x in zip_longest(*parts, fillvalue="")]
        return out

    def show(self, lines: Iterable[Line]) -> None:
        """Print lines."""
        for text, style in lines:
            # Rich wraps lines that have no spans of its own accord.
            self.print(Text(self.shown(text.rstrip()), style=style), soft_wrap=True)


def _joined(cells: Sequence[str], widths: Sequence[int], keys: int) -> str:
    """Return a line; names of rows are at the left of their columns, numbers at the right."""
    pairs = [(x, " " * (width - cell_len(x))) for x, width in zip(cells, widths, strict=True)]
    parts = [x + space for x, space in pairs[:keys]] + [space + x for x, space in pairs[keys:]]
    return (" " * GAP).join(parts)


def _wrapped(text: str, width: int, *, whole: bool = False, parts: bool = False) -> list[str]:
    """Return lines of at most this width; longer words are broken, or left ``whole``.

    Titles are broken behind hyphens and the like, too: words have ``parts``.
    """
    lines = [""]
    for word in text.split():
        for k, part in enumerate(PART.findall(word) if parts else [word]):
            joined = f"{lines[-1]} {part}" if lines[-1] and not k else f"{lines[-1]}{part}"
            if cell_len(joined) <= width:
                lines[-1] = joined
                continue
            fits = whole or cell_len(part) <= width
            if lines[-1]:
                lines.append("")
            lines[-1:] = [part] if fits else chop_cells(part, width)
    return lines


def _broken(text: str, width: int) -> list[str]:
    """Return a text as it is where it fits, else over lines."""
    return [text] if cell_len(text) <= width else _wrapped(text, width)
