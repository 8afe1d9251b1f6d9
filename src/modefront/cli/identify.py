"""``modefront identify``: tables and warnings of an identification."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from modefront.cli.layout import Screen
from modefront.cli.terminal import say
from modefront.errors import UnfinishedError
from modefront.identification.modal_test import IdentifiedTest, identify, writable
from modefront.identification.sets import CombinedModes

WORST = 10
"""Functions whose residuals are listed: those that are fitted worst; a file beside holds all."""


def run_identify(
    path: Path, output: Path, band: tuple[float, float] | None, figures: Path | None
) -> None:
    """Identify the modes of a test and write them; print what was found.

    Raises InputError where the input is wrong, and UnfinishedError where no mode was found.
    """
    writable(output)
    test = identify(path, band)
    screen = Screen.of_output()
    written = [] if test.modes is None else test.write(output)
    if figures is not None:
        from modefront.plots.identification import write_figures

        written += write_figures(test.names, test.identified, figures)
    for text in test.warnings:
        say(f"warning: {text}", err=True)
    for name, identification in zip(test.names, test.identified, strict=True):
        rejected = [
            [pole.reason, f"{pole.frequency:.6g}", f"{100 * pole.damping:.3g}"]
            for pole in identification.rejected
        ]
        screen.table(f"rejected, set {name}", ["why", "frequency Hz", "damping %"], rejected)
    if test.modes is not None:
        _print_modes(screen, test, test.modes)
        _print_residuals(screen, test)
    for file in written:
        say(f"wrote {file}")
    if test.modes is None:
        raise UnfinishedError("no mode was found in the band; what was rejected is listed above")


def _print_modes(screen: Screen, test: IdentifiedTest, modes: CombinedModes) -> None:
    rows = []
    for k, name in enumerate(test.names):
        for r, number in enumerate(modes.index[k]):
            if number < 0:
                rows.append([name, str(r + 1), "not found", *[""] * 5])
                continue
            shape = test.identified[k].modes[number].shape
            rows.append(
                [
                    name,
                    str(r + 1),
                    f"{modes.frequency[k, r]:.6g}",
                    f"{modes.frequency_std[k, r]:.2g}",
                    f"{100 * modes.damping[k, r]:.4g}",
                    f"{100 * modes.damping_std[k, r]:.2g}",
                    f"{shape.collinearity:.4f}",
                    f"{shape.loss:.2%}",
                ]
            )
    columns = ["frequency Hz", "std", "damping %", "std", "MPC", "real shape loses"]
    screen.table("modes", ["set", "mode", *columns], rows, keys=2)
    for r, (f, zeta) in enumerate(modes.spread):
        if f or zeta:
            screen.say(
                f"mode {r + 1}: the sets differ by more than their own standard deviations: "
                f"{f:.2g} Hz, damping {100 * zeta:.2g} % between sets are included"
            )


def _print_residuals(screen: Screen, test: IdentifiedTest) -> None:
    listed = []
    for name, each in zip(test.names, test.identified, strict=True):
        for (j, i), share in np.ndenumerate(each.functions.residuals.share):
            shown = f"{share:.2%}" if np.isfinite(share) else "not measured"
            functions = [name, each.functions.data.references[j], each.responses[i], shown]
            listed.append((float(np.nan_to_num(share)), functions))
    listed.sort(key=lambda row: -row[0])
    title = "residual of each function over its norm, the greatest first"
    columns = ["set", "reference", "response", "residual"]
    screen.table(title, columns, [row for _, row in listed[:WORST]], keys=3)
    rest = len(listed) - WORST
    if rest > 0:
        screen.say(f"and {rest} smaller ones: all are in the file …-identification.json")
