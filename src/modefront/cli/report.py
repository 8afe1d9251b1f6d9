"""The command ``report``."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from modefront.cli.terminal import say
from modefront.errors import Fault, InputError
from modefront.plots import paper_figures
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
    say(f"wrote {path} ({path.stat().st_size / 1e6:.2f} MB): open it in a browser")


def run_paper_figures(directories: Sequence[Path], folder: Path) -> None:
    """Write figures 2 to 7 of the paper for the results in folders, and say where they are.

    Raises InputError for results that cannot be drawn together, and without matplotlib.
    """
    studies = [
        (str(data.attrs.get("study") or name), data) for name, data in read_together(directories)
    ]
    paths = paper_figures(studies, folder)
    for path in paths:
        say(f"wrote {path}")
    for number, what in ((6, "peaks of the frequency response"), (7, "probabilities of failure")):
        if f"figure-{number}" not in [path.stem for path in paths]:
            say(f"figure {number} is left out: no study predicts {what}")
