"""Pictures of an identification: poles, mode indicators, synthesised functions, auto-MAC."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from matplotlib.figure import Figure

from modefront.identification.indicators import complex_indicators, multivariate_indicators
from modefront.identification.record import Identification
from modefront.identification.shapes import auto_mac
from modefront.plots.canvas import COLOURS, plain

MOST_PANELS = 12
"""Functions in a picture, at most: more are too small to read."""

SHORT = 40
"""Characters of the name of a data set in those of its files."""


def figures(
    names: Sequence[str], identified: Sequence[Identification]
) -> Iterator[tuple[str, Figure]]:
    """Yield names and four pictures of every data set."""
    kinds = {
        "stabilisation": _stabilisation,
        "indicators": _indicators,
        "functions": _functions,
        "auto-mac": _auto_mac,
    }
    for name, identification in zip(names, identified, strict=True):
        for kind, draw in kinds.items():
            figure = Figure(layout="constrained")
            draw(figure, identification)
            yield f"{name[:SHORT]}-{kind}", figure


def _stabilisation(figure: Figure, identification: Identification) -> None:
    figure.set_size_inches(7.0, 4.0)
    axes = figure.add_subplot()
    diagram = identification.diagram
    for stable, marker, colour, label in (
        (False, "x", "0.7", "unstable"),
        (True, "o", COLOURS[0], "stable"),
    ):
        chosen = diagram.stable == stable
        axes.plot(
            *(diagram.frequency[chosen], diagram.order[chosen], marker),
            color=colour,
            markersize=3,
            label=label,
        )
    for k, mode in enumerate(identification.modes):
        axes.axvline(
            mode.frequency, color=COLOURS[2], linewidth=0.8, label="" if k else "accepted mode"
        )
    axes.set(xlabel="frequency in Hz", ylabel="order", title="stabilisation diagram")
    axes.set_xlim(*identification.band)
    behind = axes.twinx()
    with np.errstate(divide="ignore"):
        level = 10 * np.log10(np.nanmean(np.abs(identification.functions.data.H) ** 2, axis=(0, 1)))
    behind.plot(identification.functions.data.frequency, level, color="0.6", linewidth=0.6)
    behind.set_ylabel(f"mean {identification.functions.data.quantity} in dB")
    axes.legend(loc="upper right")


def _indicators(figure: Figure, identification: Identification) -> None:
    """Draw the complex mode indicator functions, and the multivariate ones of hammer tests."""
    data = identification.functions.data
    curves = [("CMIF", "log", complex_indicators(data))]
    if np.any(np.nan_to_num(data.H).imag):  # spectral densities of ambient tests have no phase
        curves.append(("multivariate MIF", "linear", multivariate_indicators(data)))
    figure.set_size_inches(7.0, 1.0 + 2.2 * len(curves))
    panels = figure.subplots(len(curves), 1, sharex=True, squeeze=False)[:, 0]
    for axes, (label, scale, values) in zip(panels, curves, strict=True):
        for k, row in enumerate(values):
            axes.plot(data.frequency, row, color=COLOURS[k % len(COLOURS)], linewidth=0.8)
        for mode in identification.modes:
            axes.axvline(mode.frequency, color="0.7", linewidth=0.6, zorder=0)
        axes.set(ylabel=label, yscale=scale)
    panels[0].set_title("mode indicator functions")
    panels[-1].set_xlabel("frequency in Hz")
    panels[-1].set_xlim(*identification.band)


def _functions(figure: Figure, identification: Identification) -> None:
    """Draw synthesised over measured functions, those with the greatest residuals first."""
    fitted = identification.functions
    share = np.where(np.isfinite(fitted.residuals.share), fitted.residuals.share, -1.0)
    listed = [position for position in np.argsort(-share.ravel()) if share.ravel()[position] >= 0][
        :MOST_PANELS
    ]
    columns = min(3, max(len(listed), 1))
    rows = -(-max(len(listed), 1) // columns)
    figure.set_size_inches(3.0 * columns, 2.2 * rows)
    for panel, position in enumerate(listed):
        j, i = np.unravel_index(position, share.shape)
        axes = figure.add_subplot(rows, columns, panel + 1)
        f = fitted.data.frequency
        axes.semilogy(f, np.abs(fitted.data.H[j, i]), color="0.6", linewidth=0.8, label="measured")
        axes.semilogy(
            f,
            np.abs(fitted.synthesised[j, i]),
            color=COLOURS[1],
            linewidth=0.8,
            label="synthesised",
        )
        pair = f"{fitted.data.references[j]} to {fitted.data.responses[i]}"
        axes.set_title(f"{plain(pair)}: residual {share[j, i]:.1%}")
        axes.set_xlabel("frequency in Hz")
        if not panel:
            axes.legend()


def _auto_mac(figure: Figure, identification: Identification) -> None:
    figure.set_size_inches(3.6, 3.2)
    axes = figure.add_subplot()
    mac = auto_mac(np.array([mode.shape.complex_shape for mode in identification.modes]))
    ticks = [f"{mode.frequency:.4g}" for mode in identification.modes]
    image = axes.imshow(mac, vmin=0, vmax=1, cmap="Blues")
    axes.grid(False)
    axes.set_xticks(range(len(ticks)), ticks, rotation=90)
    axes.set_yticks(range(len(ticks)), ticks)
    for (r, s), value in np.ndenumerate(mac):
        colour = "white" if value > 0.5 else "black"  # legible on the dark end of the scale
        axes.text(s, r, f"{value:.2f}", ha="center", va="center", fontsize=6, color=colour)
    axes.set(title="auto-MAC", xlabel="frequency in Hz", ylabel="frequency in Hz")
    figure.colorbar(image)
