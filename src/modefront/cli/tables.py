"""Tables in the terminal."""

from __future__ import annotations

from collections.abc import Sequence

from rich import box
from rich.table import Table

from modefront.text import NAME, clean


def table(title: str, columns: Sequence[str]) -> Table:
    """Return an empty table; all columns but the first one hold numbers."""
    out = Table(title=title, box=box.SIMPLE_HEAD, title_justify="left", pad_edge=False)
    for i, column in enumerate(columns):
        out.add_column(column, justify="left" if i == 0 else "right", no_wrap=True)
    return out


def safe(text: object, most: int | None = NAME) -> str:
    """Return a text that the terminal takes neither for markup nor for orders to itself."""
    return clean(text, most).replace("[", "\\[")
