"""The report of an identification: one HTML file to look at, and to choose poles in."""

from pathlib import Path
from typing import Any

import numpy as np

from modefront._typing import Floats
from modefront._version import __version__
from modefront.identification.modal_test import IdentifiedTest
from modefront.identification.record import Identification
from modefront.identification.stabilisation import complex_indicators, multivariate_indicators
from modefront.linalg.small import mac
from modefront.reports.page import packed, page_of, write_html
from modefront.text import json_of

MOST_LINES, MOST_FUNCTIONS = 600, 40
"""Lines of a curve: more are not seen; functions of a data set, the greatest residuals first."""


def write_identification(test: IdentifiedTest, path: Path) -> Path:
    """Write the page of an identification; raises InputError where that cannot be done."""
    given = test.test
    report = {
        "title": given.name,
        "version": __version__,
        "warnings": test.warnings,
        "chosen": {"keep": given.keep, "drop": given.drop, "seed": given.seeds},
        "sets": [{"name": name} | _set(test, k) for k, name in enumerate(test.names)],
    }
    data = packed(json_of(report).encode())
    write_html(page_of(given.name, data, "identification.js"), path)
    return path


def _set(test: IdentifiedTest, k: int) -> dict[str, Any]:
    each, seeds = test.identified[k], test.test.seeds
    data, diagram = each.data, each.diagram
    # Lines evenly over the band, and those at modes.
    even = np.linspace(0, len(data.frequency) - 1, min(len(data.frequency), MOST_LINES)).astype(int)
    nearest = [int(np.abs(data.frequency - mode.frequency).argmin()) for mode in each.modes]
    kept = np.unique([*even, *nearest])
    inside = (diagram.frequency >= each.band[0]) & (diagram.frequency <= each.band[1])
    has_phase = bool(np.any(np.nan_to_num(data.H).imag))
    multivariate = multivariate_indicators(data)[:, kept] if has_phase else np.zeros((0, 0))
    places = test.test.places
    placed = all(name in places for name in each.responses)
    # In a row where they are not given.
    at = [places[x] if placed else ((i, 0, 0), (0, 0, 1)) for i, x in enumerate(each.responses)]
    positions, directions = np.array(at, dtype=float).transpose(1, 0, 2)
    shapes = np.array([mode.shape.complex_shape for mode in each.modes]).T
    return {
        "band": each.band,
        "quantity": data.quantity,
        "modes": [
            {
                "number": number or None,
                "seed": min(seeds, key=lambda f: abs(f - mode.frequency)) if not number else None,
                "frequency": mode.frequency,
                "frequencyStd": mode.frequency_std,
                "damping": mode.damping,
                "dampingStd": mode.damping_std,
                "evidence": mode.gain,
                "orders": mode.support,
                "seen": mode.visibility,
                "collinearity": mode.shape.collinearity,
                "flags": mode.flags,
                "shape": _rounded(mode.shape.shape),
            }
            for mode, number in zip(each.modes, test.numbers[k], strict=True)
        ],
        "poles": {
            "frequency": _rounded(diagram.frequency[inside], 7),
            "damping": _rounded(diagram.damping[inside]),
            "order": diagram.order[inside],
            "stable": diagram.stable[inside].astype(int),
        },
        "lines": _rounded(data.frequency[kept], 7),
        "complexIndicators": [_logarithms(row[kept]) for row in complex_indicators(data)],
        "multivariateIndicators": [_rounded(row) for row in multivariate],
        "functions": _functions(each, kept),
        "mac": [_rounded(row, 3) for row in mac(shapes, shapes)] if each.modes else [],
        "sensors": each.responses,
        "placed": placed,
        "positions": positions,
        "directions": directions,
    }


def _functions(each: Identification, kept: Any) -> list[dict[str, Any]]:
    share = each.residuals.share
    listed = np.argsort(-share, axis=None)[: int(np.isfinite(share).sum())]
    return [
        {
            "name": f"{each.data.references[j]} to {each.data.responses[i]}",
            "residual": float(share[j, i]),
            "measured": _logarithms(np.abs(each.data.H[j, i, kept]) ** 2),
            "synthesised": _logarithms(np.abs(each.synthesised[j, i, kept]) ** 2),
        }
        for j, i in np.transpose(np.unravel_index(listed[:MOST_FUNCTIONS], share.shape))
    ]


def _logarithms(power: Floats) -> list[int | None]:
    """Return hundredths of dB; None where there is nothing."""
    with np.errstate(divide="ignore", invalid="ignore"):
        level = np.round(1000 * np.log10(power))
    return [int(x) if np.isfinite(x) else None for x in level]


def _rounded(values: Floats, digits: int = 4) -> list[float]:
    return [float(f"{x:.{digits}g}") for x in values.tolist()]
