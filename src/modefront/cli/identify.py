"""``modefront identify``: the table of modes, what to look at, and the next command."""

from pathlib import Path
from typing import Any

import click

from modefront.cli.layout import Screen
from modefront.cli.terminal import say, say_next
from modefront.errors import UnfinishedError
from modefront.identification.modal_test import IdentifiedTest, identify, writable
from modefront.results.remarks import digest

MOST_FINDINGS = 8  # sentences on what to look at; a file beside holds all


def run_identify(
    path: Path,
    output: Path,
    band: tuple[float, float] | None,
    figures: Path | None,
    report: Path | None,
    **by_hand: Any,
) -> None:
    """Identify the modes of a test, write them and print what was found.

    ``by_hand`` are the numbers to keep and to drop, and seeds. Raises UnfinishedError for no modes.
    """
    if band and band[0] >= band[1]:
        raise click.UsageError(f"--band: expected LOW below HIGH, found {band[0]:g} {band[1]:g}")
    writable(output)
    chosen = {key: by_hand[key] or () for key in ("keep", "drop", "seeds")}
    test = identify(path, band, **chosen)
    screen = Screen()
    found = bool(test.modes.data.modes)
    written = test.write(output) if found else []
    if figures is not None:
        from modefront.plots import pictures, write_figures

        named = pictures("identification", test.names, test.identified)
        written += write_figures(named, figures)
    if report is not None:
        from modefront.reports.identification import write_identification

        written.append(write_identification(test, report))
    if found:
        _print_modes(screen, test)
    where = '"warnings" in …-identification.json'
    for text in digest([f"warning: {text}" for text in test.warnings], where, MOST_FINDINGS):
        say(text, err=True)
    for file in written:
        say(f"wrote {file}")
    if not found:
        why = "no mode was found in the band: is it right? --seed places modes"
        raise UnfinishedError("--drop left no mode" if chosen["drop"] else why)
    if report is None and figures is None:
        said = ["--band", *(f"{x:.15g}" for x in band)] if band else []
        for key, numbers in chosen.items():
            option = f"--{key.removesuffix('s')}"
            said += [option, ",".join(f"{x:.15g}" for x in numbers)] if numbers else []
        say_next("identify", path, *said, "-o", output, "--report", "test.html")
    else:
        say(f'next: [data] file = "{output}" in study.toml, then modefront check study.toml')


def _print_modes(screen: Screen, test: IdentifiedTest) -> None:
    rows, modes = [], test.modes
    for k, name in enumerate(test.names):
        for r, number in enumerate(modes.index[k]):
            if number < 0:
                rows.append([name, str(r + 1), "not found", *[""] * 7])
                continue
            mode = test.identified[k].modes[number]
            cells = (
                f"{modes.data.frequency[k, r]:.6g}",
                f"{modes.data.frequency_std[k, r]:.2g}",
                f"{100 * modes.data.damping[k, r]:.4g}",
                f"{100 * modes.damping_std[k, r]:.2g}",
                f"{mode.gain:.1f}" if mode.gain < 10 else f"{mode.gain:.0f}",
                *(f"{mode.support:.0%}", f"{mode.visibility:.0%}"),
                f"{mode.shape.collinearity:.2f}",
            )
            rows.append([name, str(r + 1) + " !" * bool(mode.flags), *cells])
    columns = ["frequency Hz", "std", "damping %", "std", "evidence", "orders", "seen", "MPC"]
    screen.table("modes", ["set", "mode", *columns], rows, keys=2)
