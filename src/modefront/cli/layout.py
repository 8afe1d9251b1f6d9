"""Sentences and tables that fit the terminal: wrapped at words, split into blocks, never cut.

A table that is too wide is printed as several blocks, one below the other, which repeat the names
of the rows. Names that do not fit are broken over lines. All text is cleaned (`modefront.text`),
and characters that the terminal's encoding lacks are spelled.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from rich.cells import cell_len, chop_cells
from rich.console import Console
from rich.text import Text

from modefront.text import SPELL, clean

GAP = 2
"""Spaces between columns."""

LEAST = 8
"""Width of a column down to which long words are broken."""

KEY = 0.45
"""Greatest part of the width that the names of the rows take."""

Row = Sequence[str]

Line = tuple[str, str]
"""A line with its style."""

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


class _Output(Console):
    """A console that lets its caller know that nobody reads any more; rich leaves the program."""

    def on_broken_pipe(self) -> None:
        """Raise BrokenPipeError."""
        raise BrokenPipeError


@dataclass(frozen=True)
class Screen:
    """A terminal, or a file of the width that ``COLUMNS`` says, 80 unless given."""

    console: Console

    @classmethod
    def of_output(cls) -> Screen:
        """Return the screen of standard output."""
        return cls(_Output(highlight=False))

    @property
    def width(self) -> int:
        """Characters a line."""
        return max(self.console.width, 20)

    def shown(self, text: object) -> str:
        """Return a text as the terminal can show it."""
        out = clean(text)
        encoding = self.console.encoding
        return out.encode(encoding, errors=SPELL).decode(encoding)

    def say(self, text: object, start: str = "", style: str = "") -> None:
        """Print a sentence, wrapped at words; further lines are indented as far as its start."""
        self.show(self.sentence(text, start, style))

    def sentence(self, text: object, start: str = "", style: str = "") -> list[Line]:
        """Return the lines of a sentence."""
        start = self.shown(start)
        room = max(self.width - cell_len(start), LEAST)
        # Long words, such as paths and commands, are left whole, to be copied.
        lines = _wrapped(self.shown(text), room, whole=True)
        indent = " " * cell_len(start)
        return [(f"{indent if i else start}{line}", style) for i, line in enumerate(lines)]

    def blank(self) -> None:
        """Print an empty line."""
        self.show([BLANK])

    def table(self, title: str, columns: Row, rows: Sequence[Row], keys: int = 1) -> None:
        """Print a table after an empty line, as `grid` returns it; none without rows."""
        self.show([BLANK, *self.grid(title, columns, rows, keys)] if rows else [])

    def grid(
        self,
        title: str,
        columns: Row,
        rows: Sequence[Row],
        keys: int = 1,
        part: float = KEY,
    ) -> list[Line]:
        """Return the lines of a table, in blocks where it is too wide; none without rows.

        Parameters
        ----------
        title
            Sentence above the table.
        columns
            Titles, those of the names of the rows first.
        rows
            Cells; a row of one cell is a heading within the table.
        keys
            Number of columns with names of the rows, which every block repeats.
        part
            Greatest part of the width that these take; longer names are broken over lines.
        """
        if not rows:
            return []
        out = self.sentence(title, style="bold") if title else []
        cells = [[self.shown(x) for x in row] for row in rows]
        grid = _Grid([self.shown(x) for x in columns], cells, keys, part)
        for number, block in enumerate(grid.blocks(self.width)):
            out += [BLANK] * (number > 0) + block
        return out

    def show(self, lines: Iterable[Line]) -> None:
        """Print lines."""
        for text, style in lines:
            # Rich wraps lines that have no spans of its own accord.
            self.console.print(Text(self.shown(text.rstrip()), style=style), soft_wrap=True)


@dataclass(frozen=True)
class _Grid:
    columns: list[str]
    rows: list[list[str]]
    keys: int
    part: float

    def blocks(self, width: int) -> Iterator[list[Line]]:
        """Yield the lines of each block, with their styles."""
        most = max(int(self.part * width) // self.keys, LEAST)
        keys = [min(self._width(j), most) for j in range(self.keys)]
        room = width - sum(keys) - GAP * self.keys
        widths = {j: min(self._width(j), room) for j in range(self.keys, len(self.columns))}
        block: list[int] = []
        for j, needed in widths.items():
            if block and sum(widths[i] + GAP for i in block) + needed > room:
                yield self._block([*keys, *(widths[i] for i in block)], block, width)
                block = []
            block.append(j)
        yield self._block([*keys, *(widths[i] for i in block)], block, width)

    def _width(self, j: int) -> int:
        """Return the width of a column: that of its cells and of the words of its title."""
        cells = [cell_len(row[j]) for row in self.rows if len(row) > 1]
        return max([*cells, *map(cell_len, _parts(self.columns[j])), 1])

    def _block(self, widths: list[int], chosen: list[int], whole: int) -> list[Line]:
        """Return the lines of the chosen columns, with their styles."""
        order = [*range(self.keys), *chosen]
        titles = [_titled(self.columns[j], width) for j, width in zip(order, widths, strict=True)]
        depth = max(map(len, titles))
        titles = [[""] * (depth - len(title)) + title for title in titles]
        out = [(self._joined(parts, widths), "bold") for parts in zip(*titles, strict=True)]
        out = [line for line in out if line[0].strip()]
        out.append((self._joined(["─" * width for width in widths], widths), "dim"))
        for row in self.rows:
            if len(row) == 1:
                out += [(line, "italic") for line in _broken(row[0], whole)]
                continue
            cells = [_broken(row[j], width) for j, width in zip(order, widths, strict=True)]
            depth = max(map(len, cells))
            cells = [cell + [""] * (depth - len(cell)) for cell in cells]
            out += [(self._joined(parts, widths), "") for parts in zip(*cells, strict=True)]
        return out

    def _joined(self, cells: Sequence[str], widths: Sequence[int]) -> str:
        """Return a line; names of rows are at the left of their columns, numbers at the right."""
        parts = []
        for j, (cell, width) in enumerate(zip(cells, widths, strict=True)):
            space = " " * (width - cell_len(cell))
            parts.append(cell + space if j < self.keys else space + cell)
        return (" " * GAP).join(parts)


def _parts(title: str) -> list[str]:
    """Return the parts of a title that are not broken: words, and what hyphens join."""
    return [part for part in re.split(r"\s+|(?<=[-_/.])", title) if part]


def _titled(title: str, width: int) -> list[str]:
    """Return a title over lines."""
    if cell_len(title) <= width:
        return [title]
    lines = [""]
    for word in title.split():
        for k, part in enumerate(_parts(word)):
            joined = lines[-1] + (" " if k == 0 and lines[-1] else "") + part
            if cell_len(joined) <= width or not lines[-1]:
                lines[-1] = joined
            else:
                lines.append(part)
    return [piece for line in lines for piece in _broken(line, width)]


def _broken(text: str, width: int) -> list[str]:
    """Return a text over lines: at words where that is possible."""
    if cell_len(text) <= width:
        return [text]
    return _wrapped(text, width)


def _wrapped(text: str, width: int, *, whole: bool = False) -> list[str]:
    """Return lines of at most this width; longer words are broken, or left ``whole``."""
    lines = [""]
    for word in text.split():
        joined = f"{lines[-1]} {word}" if lines[-1] else word
        if cell_len(joined) <= width:
            lines[-1] = joined
            continue
        pieces = [word] if whole or cell_len(word) <= width else chop_cells(word, width)
        if lines[-1]:
            lines.append("")
        lines[-1] = pieces[0]
        lines += pieces[1:]
    return lines
