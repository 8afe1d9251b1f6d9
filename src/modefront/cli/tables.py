"""Tables in the terminal."""

from __future__ import annotations

from collections.abc import Sequence

from rich import box
from rich.console import Console
from rich.table import Table

from modefront.text import NAME, clean

_WIDTH = 1100
"""Characters of a line where output is no terminal: no table is cut."""


def console() -> Console:
    """Return a console that does not cut tables where output is no terminal."""
    screen = Console(highlight=False)
    return screen if screen.is_terminal else Console(highlight=False, width=_WIDTH)


def table(title: str, columns: Sequence[str]) -> Table:
    """Return an empty table; all columns but the first one hold numbers."""
    out = Table(title=title, box=box.SIMPLE_HEAD, title_justify="left", pad_edge=False)
    for i, column in enumerate(columns):
        out.add_column(column, justify="left" if i == 0 else "right", no_wrap=True)
    return out


def safe(text: object, most: int | None = NAME) -> str:
    """Return a text that the terminal takes neither for markup nor for orders to itself."""
    return clean(text, most).replace("[", "\\[")
