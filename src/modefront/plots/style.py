"""Colours, marks and settings that all pictures share."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from modefront.text import NAME, clean

COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00")
"""Told apart by the colour-blind (Okabe and Ito)."""

MAP = "cividis"
"""Colours of values, told apart by the colour-blind too."""

PANEL = (2.6, 2.1)
"""Width and height of a panel in inches."""

COLUMNS = 3
"""Panels side by side."""

STYLE: Mapping[Any, Any] = {
    "font.size": 8.5,
    "figure.titlesize": 9.0,
    "axes.titlesize": 8.5,
    "axes.labelsize": 8.5,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "0.9",
    "grid.linewidth": 0.6,
    "axes.axisbelow": True,
    "legend.frameon": False,
    "svg.hashsalt": "modefront",
    "svg.fonttype": "path",
}


def plain(text: object) -> str:
    """Return a text that is not taken for mathematics."""
    return clean(text, NAME).replace("$", r"\$")


def short(text: object, most: int = 18) -> str:
    """Return a text that fits beside a tick."""
    return clean(text, most).replace("$", r"\$")
