"""Pictures of an identification: poles, mode indicators, synthesised functions, auto-MAC."""

from collections.abc import Iterator, Sequence

import numpy as np

from modefront.identification.record import Identification
from modefront.identification.stabilisation import complex_indicators, multivariate_indicators
from modefront.linalg.small import mac
from modefront.plots.canvas import COLOURS, Picture, draw_matrix, panels, picture, short, single

MOST_PANELS, SHORT = 12, 40
"""Functions in a picture: more are too small to read; characters of a data set in file names."""


def figures(
    names: Sequence[str], identified: Sequence[Identification]
) -> Iterator[tuple[str, Picture]]:
    """Yield names and four pictures of every data set."""
    for name, identification in zip(names, identified, strict=True):
        for draw in (_stabilisation, _indicators, _functions, _auto_mac):
            kind = draw.__name__[1:].replace("_", "-")
            yield f"{name[:SHORT]}-{kind}", draw(identification)


def _stabilisation(identification: Identification) -> Picture:
    (figure, axes), diagram = single(7.0, 4.0), identification.diagram
    measured = identification.data
    for stable, marker, colour, label in (
        (False, "x", "0.7", "unstable"),
        (True, "o", COLOURS[0], "stable"),
    ):
        chosen = diagram.stable == stable
        x, y = diagram.frequency[chosen], diagram.order[chosen]
        axes.plot(x, y, marker, color=colour, ms=3, label=label)
    for k, mode in enumerate(identification.modes):
        label = "" if k else "accepted mode"
        axes.axvline(mode.frequency, color=COLOURS[2], lw=0.8, label=label)
    axes.set(xlabel="frequency in Hz", ylabel="order", title="stabilisation diagram")
    axes.set_xlim(*identification.band)
    behind = axes.twinx()
    with np.errstate(divide="ignore"):
        level = 10 * np.log10(np.nanmean(np.abs(measured.H) ** 2, axis=(0, 1)))
    behind.plot(measured.frequency, level, color="0.6", lw=0.6)
    behind.set_ylabel(f"mean {measured.quantity} in dB")
    axes.legend(loc="upper right")
    return figure


def _indicators(identification: Identification) -> Picture:
    """Draw the complex mode indicator functions, and the multivariate ones of hammer tests."""
    data = identification.data
    curves = [("CMIF", "log", complex_indicators(data))]
    if np.any(np.nan_to_num(data.H).imag):  # spectral densities of ambient tests have no phase
        curves.append(("multivariate MIF", "linear", multivariate_indicators(data)))
    figure = picture(7.0, 1.0 + 2.2 * len(curves))
    rows = figure.subplots(len(curves), 1, sharex=True, squeeze=False)[:, 0]
    for axes, (label, scale, values) in zip(rows, curves, strict=True):
        for k, row in enumerate(values):
            axes.plot(data.frequency, row, color=COLOURS[k % len(COLOURS)], linewidth=0.8)
        for mode in identification.modes:
            axes.axvline(mode.frequency, color="0.7", linewidth=0.6, zorder=0)
        axes.set(ylabel=label, yscale=scale)
    rows[0].set_title("mode indicator functions")
    rows[-1].set_xlabel("frequency in Hz")
    rows[-1].set_xlim(*identification.band)
    return figure


def _functions(identification: Identification) -> Picture:
    """Draw synthesised over measured functions, those with the greatest residuals first."""
    data, share = identification.data, identification.residuals.share
    listed = np.argsort(-share, axis=None)[: int(np.isfinite(share).sum())][:MOST_PANELS]
    figure, grid = panels(listed.size)
    for axes, position in zip(grid, listed, strict=True):
        j, i = np.unravel_index(position, share.shape)
        measured = (data.H, "0.6", "measured")
        for H, colour, label in (measured, (identification.synthesised, COLOURS[1], "synthesised")):
            axes.semilogy(data.frequency, np.abs(H[j, i]), color=colour, lw=0.8, label=label)
        pair = f"{data.references[j]} to {data.responses[i]}"
        axes.set_title(f"{short(pair)}: residual {share[j, i]:.1%}")
        axes.set_xlabel("frequency in Hz")
        if axes is grid[0]:
            axes.legend()
    return figure


def _auto_mac(identification: Identification) -> Picture:
    figure, axes = single(3.6, 3.2)
    shapes = np.array([mode.shape.complex_shape for mode in identification.modes]).T
    values = mac(shapes, shapes)
    ticks = [f"{mode.frequency:.4g}" for mode in identification.modes]
    figure.colorbar(draw_matrix(axes, values, ticks, 0, "Blues"))
    axes.set(title="auto-MAC", xlabel="frequency in Hz", ylabel="frequency in Hz")
    return figure
