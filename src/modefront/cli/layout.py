"""Sentences and tables that fit the terminal: wrapped at words, split into blocks, never cut."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
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
    ) -> list[Line]:
        """Return the lines of a table, in blocks where it is too wide; none without rows.

        The first ``keys`` columns are names of the rows, which every block repeats, within a
        part `KEY` of the width. A row of one cell is a heading within the table.
        """
        if not rows:
            return []
        out = self.sentence(title, style="bold") if title else []
        cells = [[self.shown(x) for x in row] for row in rows]
        grid = _Grid([self.shown(x) for x in columns], cells, keys)
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

    def blocks(self, width: int) -> Iterator[list[Line]]:
        """Yield the lines of each block, with their styles."""
        most = max(int(KEY * width) // self.keys, LEAST)
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
        return max([*cells, *map(cell_len, PART.findall(self.columns[j])), 1])

    def _block(self, widths: list[int], chosen: list[int], whole: int) -> list[Line]:
        """Return the lines of the chosen columns, with their styles."""
        order = [*range(self.keys), *chosen]
        titles = [
            _broken(self.columns[j], width, parts=True)[::-1]
            for j, width in zip(order, widths, strict=True)
        ]
        rows = [self._joined(parts, widths) for parts in zip_longest(*titles, fillvalue="")]
        out = [(row, "bold") for row in rows[::-1] if row.strip()]
        out.append((self._joined(["─" * width for width in widths], widths), "dim"))
        for row in self.rows:
            if len(row) == 1:
                out += [(line, "italic") for line in _broken(row[0], whole)]
                continue
            cells = [_broken(row[j], width) for j, width in zip(order, widths, strict=True)]
            out += [(self._joined(x, widths), "") for x in zip_longest(*cells, fillvalue="")]
        return out

    def _joined(self, cells: Sequence[str], widths: Sequence[int]) -> str:
        """Return a line; names of rows are at the left of their columns, numbers at the right."""
        parts = []
        for j, (cell, width) in enumerate(zip(cells, widths, strict=True)):
            space = " " * (width - cell_len(cell))
            parts.append(cell + space if j < self.keys else space + cell)
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


def _broken(text: str, width: int, *, parts: bool = False) -> list[str]:
    """Return a text as it is where it fits, else over lines."""
    return [text] if cell_len(text) <= width else _wrapped(text, width, parts=parts)
