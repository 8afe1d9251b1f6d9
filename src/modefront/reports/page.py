"""The page of a report: one file, whose content-security policy lets no request leave it."""

from __future__ import annotations

import base64
import hashlib
import html
from collections.abc import Sequence
from importlib.resources import files
from pathlib import Path

import xarray as xr

from modefront.errors import Fault, InputError, writing
from modefront.outputs import write_text
from modefront.reports.payload import payload
from modefront.results.compare import read_together

SUFFIXES = (".html", ".htm")

PAGE = """\
<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{policy}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="generator" content="modefront">
<title>{title}</title>
<style>{style}</style>
</head>
<body>
<noscript><p>This report is drawn by a script: please allow scripts for this file.</p></noscript>
<script type="text/plain" id="data">{data}</script>
<script>{script}</script>
</body>
</html>
"""


def page(results: Sequence[tuple[str, xr.Dataset]]) -> str:
    """Return the page of sound results, given with the names of their folders."""
    return page_of(*payload(results), "report.js")


def page_of(title: str, data: str, name: str) -> str:
    """Return the page with a title, data in base64, and the script of a name."""
    folder = files("modefront.reports")
    script = (folder / name).read_text(encoding="utf-8")
    style = (folder / "style.css").read_text(encoding="utf-8")
    policy = (
        f"default-src 'none'; script-src '{_digest(script)}'; style-src '{_digest(style)}'; "
        "base-uri 'none'; form-action 'none'"
    )
    shown = "".join(c if c.isprintable() else " " for c in title)
    return PAGE.format(
        policy=policy, title=html.escape(shown), style=style, data=data, script=script
    )


def report(folders: Path | str | Sequence[Path | str], output: Path | str | None = None) -> Path:
    """Write the results in folders as one HTML file, and return its path.

    Parameters
    ----------
    folders
        Folder of results, or several of studies with the same groups.
    output
        File to write; ``report.html`` in the first folder unless given.

    Raises
    ------
    InputError
        For results that are not sound, and a file that cannot be written.
    """
    results = read_together(folders)
    path = Path(output) if output else Path(results[0][0]) / "report.html"
    write_html(page(results), path)
    return path


def write_html(text: str, path: Path) -> None:
    """Write a page whole or not at all; raises InputError where the file cannot be written."""
    if path.suffix.lower() not in SUFFIXES:
        raise InputError(Fault(str(path), "-o", "a file that ends in .html", f"'{path.name}'"))
    with writing(path, "-o"):
        write_text(path, text, lasting=True)


def _digest(text: str) -> str:
    """Return what a content-security policy calls a text."""
    digest = hashlib.sha256(text.encode()).digest()
    return f"sha256-{base64.b64encode(digest).decode('ascii')}"
