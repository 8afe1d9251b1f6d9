"""Sections of docstrings as Sphinx reads them: ``name : meaning`` names no type."""

from __future__ import annotations

import re
from typing import Any

from sphinx.application import Sphinx

RULE = re.compile(r"-{3,}$")
FIELD = re.compile(r"(?P<name>[^\s:>][^:]*?) : (?P<meaning>.*)$")


def process(*arguments: Any) -> None:
    """Put each meaning on a line of its own, and examples into a section of their own.

    The last of the arguments of the event are the lines of a docstring.
    """
    lines: list[str] = arguments[-1]
    result: list[str] = []
    section = False
    for line in lines:
        if RULE.fullmatch(line):
            section = result[-1] != "Examples"
        found = FIELD.fullmatch(line) if section else None
        if found:
            result += [found["name"], f"    {found['meaning']}"]
            continue
        if section and line.startswith(">>>"):
            result += ["Examples", "--------"]
            section = False
        result.append(line)
    lines[:] = result


def setup(app: Sphinx) -> dict[str, bool]:
    """Read docstrings before napoleon does."""
    app.connect("autodoc-process-docstring", process, priority=400)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
