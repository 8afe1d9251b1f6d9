"""The command ``report``."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import click

from modefront.errors import Fault, InputError
from modefront.report.page import write_page
from modefront.results.compare import read_together

SUFFIXES = (".html", ".htm")


def run_report(directories: Sequence[Path], output: Path | None) -> None:
    """Write the page of the results in folders, and say where it is and how large.

    Raises InputError for results that are not sound, and a file that cannot be written.
    """
    path = output or directories[0] / "report.html"
    if path.suffix.lower() not in SUFFIXES:
        raise InputError(Fault(str(path), "-o", "a file that ends in .html", f"'{path.name}'"))
    write_page(read_together(directories), path)
    click.echo(f"wrote {path} ({path.stat().st_size / 1e6:.2f} MB): open it in a browser")
