"""The command ``modefront identify``: files in, modal data and a summary out."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from modefront.cli.tables import console, safe, table
from modefront.data.csv import is_reserved, write_csv
from modefront.data.modal_test import ModalTest, read_test
from modefront.data.uff import write_uff55
from modefront.errors import Fault, InputError, UnfinishedError
from modefront.identification.methods.hammer import LEAST_LINES, identify
from modefront.identification.record import Identification
from modefront.identification.sets import CombinedModes, combine, modal_data_of
from modefront.outputs import write_text

POOR_FIT = 0.5
"""Residual of a function over its norm from which on it is pointed out."""


def run_identify(
    path: Path, output: Path, band: tuple[float, float] | None, figures: Path | None
) -> None:
    """Identify the modes of a test and write them; print what was found.

    Raises InputError where the input is wrong, and UnfinishedError where no mode was found.
    """
    if output.suffix.lower() not in (".csv", ".uff"):
        expected = "a file that ends in .csv, or in .uff for dataset 55"
        raise InputError(Fault("modefront identify", "-o", expected, str(output)))
    if not output.parent.is_dir():
        raise InputError(Fault(str(output.parent), "folder", "a folder", "none"))
    test = read_test(path)
    band = band or test.band
    _check_band(path, test, band)
    screen, errors = console(), _error_console()
    identified = []
    for part in test.sets:
        for text in part.assembled.warnings:
            errors.print(f"warning: {safe(text, None)}")
        identified.append(identify(part.assembled.data, band, test.modes))
    names = [identification.name for identification in test.sets]
    combined = (
        combine(names, identified)
        if any(identification.modes for identification in identified)
        else None
    )
    written = [] if combined is None else _write(output, test, combined, identified)
    if figures is not None:
        from modefront.cli.identify_figures import write_figures

        written += write_figures(names, identified, figures)
    for name, identification in zip(names, identified, strict=True):
        _print_rejected(screen, name, identification)
        for text in findings(identification):
            errors.print(f"warning: set {safe(repr(name))}: {safe(text, None)}")
    if combined is not None:
        _print_modes(screen, combined, identified)
        _print_residuals(screen, names, identified)
    for file in written:
        screen.print(f"wrote {safe(file, None)}")
    if combined is None:
        raise UnfinishedError("no mode was found in the band; what was rejected is listed above")


def _error_console() -> Any:
    from rich.console import Console

    return Console(stderr=True, highlight=False, soft_wrap=True)


def _check_band(path: Path, test: ModalTest, band: tuple[float, float] | None) -> None:
    for data_set in test.sets:
        f = data_set.assembled.data.frequency
        low, high = band or (0.0, np.inf)
        count = int(np.count_nonzero((f >= low) & (f <= high) & (f > 0)))
        if count < LEAST_LINES:
            expected = f"at least {LEAST_LINES} lines of set {data_set.name!r} within it"
            reach = f"{count}: the files reach from {f[0]:g} to {f[-1]:g} Hz"
            raise InputError(Fault(str(path), "band", expected, reach))
        inside = data_set.assembled.data.within(low, high)
        if not np.any(np.abs(np.nan_to_num(inside.H)) > 0):
            expected = "functions that are not zero"
            raise InputError(Fault(str(path), "band", expected, f"zeros in set {data_set.name!r}"))


def findings(identification: Identification) -> list[str]:
    """Return the warnings on one identification."""
    out = []
    data, residuals = identification.functions.data, identification.functions.residuals
    if not identification.converged:
        out.append("the maximum of the likelihood was not reached within its tolerance")
    if residuals.chi2 > 1.5:
        out.append(
            f"the model leaves {residuals.chi2:.1f} times the variance that the data have: "
            "standard deviations are widened accordingly; nonlinearity, leakage or missing modes"
        )
    if residuals.widening > 1.5:
        out.append(
            "neighbouring lines are correlated: standard deviations are "
            f"{residuals.widening**0.5:.1f} times those of independent lines; windows, zero "
            "padding or drifting modes"
        )
    for (j, i), share in np.ndenumerate(residuals.share):
        if share > POOR_FIT:
            pair = f"{data.references[j]} to {data.responses[i]}"
            out.append(f"the function from {pair} is poorly fitted: residual {share:.0%}")
    return out


def _print_modes(screen: Any, modes: CombinedModes, identified: Sequence[Identification]) -> None:
    out = table(
        "modes",
        ["set", "mode", "frequency Hz", "std", "damping %", "std", "MPC", "real shape loses"],
    )
    for k, name in enumerate(modes.sets):
        for r in range(modes.frequency.shape[1]):
            number = modes.index[k][r]
            if number < 0:
                out.add_row(safe(name), str(r + 1), "not found", *[""] * 5)
                continue
            shape = identified[k].modes[number].shape
            out.add_row(
                safe(name),
                str(r + 1),
                f"{modes.frequency[k, r]:.6g}",
                f"{modes.frequency_std[k, r]:.2g}",
                f"{100 * modes.damping[k, r]:.4g}",
                f"{100 * modes.damping_std[k, r]:.2g}",
                f"{shape.collinearity:.4f}",
                f"{shape.loss:.2%}",
            )
    screen.print(out)
    for r, (f, zeta) in enumerate(modes.spread):
        if f or zeta:
            screen.print(
                f"mode {r + 1}: the sets differ by more than their own standard deviations: "
                f"{f:.2g} Hz, damping {100 * zeta:.2g} % between sets are included"
            )


def _print_rejected(screen: Any, name: str, identification: Identification) -> None:
    if identification.rejected:
        out = table(f"rejected, set {safe(name)}", ["why", "frequency Hz", "damping %"])
        for pole in identification.rejected:
            out.add_row(safe(pole.reason), f"{pole.frequency:.6g}", f"{100 * pole.damping:.3g}")
        screen.print(out)


def _print_residuals(
    screen: Any, names: Sequence[str], identified: Sequence[Identification]
) -> None:
    out = table(
        "residual of each function over its norm", ["set", "reference", "response", "residual"]
    )
    for name, identification in zip(names, identified, strict=True):
        for (j, i), share in np.ndenumerate(identification.functions.residuals.share):
            shown = f"{share:.2%}" if np.isfinite(share) else "not measured"
            out.add_row(
                safe(name),
                safe(identification.functions.data.references[j]),
                safe(identification.responses[i]),
                shown,
            )
    screen.print(out)


def _write(
    output: Path, test: ModalTest, modes: CombinedModes, identified: Sequence[Identification]
) -> list[Path]:
    """Write modal data, and beside it all else that was identified; return the paths."""
    report = output.with_name(output.stem + "-identification.json")
    text = json.dumps(as_report(test, modes.sets, identified), indent=1, allow_nan=False)
    write_text(report, text + "\n")
    if output.suffix.lower() == ".uff":
        listed = [
            [
                (mode.pole, _complex_at(mode.shape.complex_shape, k, modes.sensors))
                for mode in k.modes
            ]
            for k in identified
        ]
        write_uff55(output, modes.sets, listed, modes.sensors)
        return [output, report]
    clashing = [name for name in modes.sensors if is_reserved(name, modes.sensors)]
    if clashing:
        expected = "names of sensors that are no columns of modal data"
        raise InputError(Fault("sensors", repr(clashing[0]), expected, "a reserved name"))
    write_csv(output, modal_data_of(modes), modes.damping_std)
    return [output, report]


def _complex_at(phi: Any, identification: Identification, sensors: Sequence[str]) -> Any:
    where = dict(zip(identification.responses, phi, strict=True))
    return np.array([where.get(name, 0j) for name in sensors])


def _pairs(values: Any) -> list[list[float | None]]:
    return [[_number(float(x.real)), _number(float(x.imag))] for x in np.asarray(values, complex)]


def _number(value: float) -> float | None:
    return value if np.isfinite(value) else None


def as_report(
    test: ModalTest, names: Sequence[str], identified: Sequence[Identification]
) -> dict[str, Any]:
    """Return all that was identified as plain data; complex numbers are [real, imaginary]."""
    sets = []
    for name, identification in zip(names, identified, strict=True):
        sets.append(
            {
                "name": name,
                "references": list(identification.functions.data.references),
                "responses": list(identification.responses),
                "band": list(identification.band),
                "chi2": identification.functions.residuals.chi2,
                "correlation_factor": identification.functions.residuals.widening,
                "force_noise": [
                    float(np.sqrt(b)) for b in identification.functions.residuals.force
                ],
                "residual": [
                    [_number(float(x)) for x in row]
                    for row in identification.functions.residuals.share
                ],
                "residual_terms": identification.functions.residual_terms,
                "evaluations": identification.evaluations,
                "converged": identification.converged,
                "modes": [
                    {
                        "frequency": mode.frequency,
                        "frequency_std": mode.frequency_std,
                        "damping": mode.damping,
                        "damping_std": mode.damping_std,
                        "pole": [mode.pole.real, mode.pole.imag],
                        "shape": _pairs(mode.shape.complex_shape),
                        "real_shape_std": [_number(float(x)) for x in mode.shape_std],
                        "phase_collinearity": mode.shape.collinearity,
                        "loss": mode.shape.loss,
                        "participation": _pairs(mode.participation),
                    }
                    for mode in identification.modes
                ],
                "rejected": [
                    {"frequency": x.frequency, "damping": x.damping, "reason": x.reason}
                    for x in identification.rejected
                ],
            }
        )
    return {"test": test.name, "sets": sets}
