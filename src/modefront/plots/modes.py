"""Mode shapes of a model: a chain from the side, a mesh in space, components at sensors alone."""

from collections.abc import Iterable
from typing import Any, TypeAlias

import numpy as np
from matplotlib.axes import Axes
from mpl_toolkits.mplot3d import Axes3D
from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection

from modefront._typing import Floats, Ints
from modefront.datasets import Dataset
from modefront.front.point import position
from modefront.plots.canvas import COLOURS, COLUMNS, Picture, names_of, panels, picture, short

REACH, NAMES = 0.15, 14
"""Greatest displacement over the diagonal of the model; sensors up to which each is named."""

_Shape: TypeAlias = tuple[str, Floats, Floats, Floats]
"""One mode: title; (sensors,) of the model; (sets, sensors) as measured, in the same scale; and
displacements (nodes, 3), of no nodes without geometry."""


def modes(data: Dataset, point: str | int | None = None) -> Picture:
    """Return the mode shapes of a model, the measured ones over them.

    ``point`` is a label or a position from 0, the reference unless given. Raises KeyError for
    an unknown label.
    """
    i = position(data, point)
    shapes = [_shape(data, i, r) for r in range(data.sizes["mode"])]
    in_space = "node" in data and data.attrs.get("geometry") != "chain"
    if in_space:
        figure = _in_space(data, shapes)
    else:
        figure, grid = panels(len(shapes))
        for axes, (title, computed, measured, moved) in zip(grid, shapes, strict=True):
            if "node" in data:
                _from_the_side(axes, data, measured, moved)
            else:
                _at_sensors(axes, data, computed, measured)
            axes.set_title(title, loc="left")
        figure.legend(*grid[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    figure.suptitle(short(data["label"].values[i]), x=0.01, ha="left")
    return figure


def _shape(data: Dataset, i: int, r: int) -> _Shape:
    computed = data["shape"].values[i, r]
    measured = data["measured_shape"].values[:, r]
    product, square = np.nansum(measured * computed, axis=1), np.nansum(measured**2, axis=1)
    factor = np.divide(product, square, out=np.zeros(square.shape), where=square > 0)
    f, mac = data["frequency"].values[i, r], data["mac"].values[i, r]
    title = f"mode {data['mode'].values[r]}: {f:.4g} Hz, MAC {mac:.3f}"
    moved = np.empty((0, 3))
    if "shape_basis" in data:
        c, B = data["shape_coefficient"].values[i, r], data["shape_basis"].values
        moved = np.einsum("b,bnk->nk", c, B)
    return title, computed, measured * factor[:, None], moved


def _from_the_side(axes: Axes, data: Dataset, measured: Floats, moved: Floats) -> None:
    """Draw displacements of a chain over its heights."""
    nodes, sensor_nodes = data["node"].values, data["sensor_node"].values
    x, height = moved[:, 0], nodes[:, 2]
    axes.axvline(0, color="0.6", lw=0.8)
    for line in data["line_nodes"].values:
        axes.plot(x[line], height[line], "-", color=COLOURS[0], lw=1.6)
    axes.plot(x, height, "s", color=COLOURS[0], ms=5, label="model")
    sign = data["sensor_direction"].values[:, 0]
    _rings(axes, [(row * sign, height[sensor_nodes]) for row in measured], mew=1.4, ms=8)
    axes.set_xlim(-1.15, 1.15)
    axes.set_yticks(height[sensor_nodes], names_of(data, "sensor", 18))


def _at_sensors(axes: Axes, data: Dataset, computed: Floats, measured: Floats) -> None:
    x = np.arange(data.sizes["sensor"])
    axes.axhline(0, color="0.6", lw=0.8)
    axes.plot(x, computed, "s-", color=COLOURS[0], ms=4, lw=1.2, label="model")
    _rings(axes, [(x, row) for row in measured], mew=1.2, ms=7)
    if x.size <= NAMES:
        axes.set_xticks(x, names_of(data, "sensor", 12), rotation=60)
    else:
        axes.set_xlabel("sensor")


def _rings(axes: Axes, sets: Iterable[tuple[Any, Any]], **size: Any) -> None:
    for k, (x, y) in enumerate(sets):
        label = None if k else "measured"
        axes.plot(x, y, "o", mfc="none", mec=COLOURS[1], label=label, **size)


def _in_space(data: Dataset, shapes: list[_Shape]) -> Picture:
    nodes, directions = data["node"].values, data["sensor_direction"].values
    places = nodes[data["sensor_node"].values]
    cells = data["line_nodes"].values, data["face_nodes"].values
    reach = REACH * (float(np.linalg.norm(np.ptp(nodes, axis=0))) or 1.0)
    columns = min(COLUMNS, len(shapes))
    rows = -(-len(shapes) // columns)
    figure = picture(3.1 * columns, 3.3 * rows + 0.4)
    for k, (title, computed, measured, moved) in enumerate(shapes):
        axes = figure.add_subplot(rows, columns, k + 1, projection="3d")
        assert isinstance(axes, Axes3D)
        deformed = nodes + reach * moved
        _mesh(axes, nodes, *cells, "0.75", 0.0)
        _mesh(axes, deformed, *cells, COLOURS[0], 0.25)
        for values, colour in ((computed[None], COLOURS[0]), (measured, COLOURS[1])):
            for row in values:
                length = reach * np.nan_to_num(row)[:, None] * directions
                axes.quiver(*places.T, *length.T, color=colour, lw=1.4)
        low, high = (of(np.vstack([nodes, deformed]), axis=0) for of in (np.min, np.max))
        span = np.maximum(high - low, 0.15 * (high - low).max() or 1.0)  # one scale along all axes
        for name, middle, size in zip("xyz", (low + high) / 2, span, strict=True):
            axes.set(**{f"{name}lim": (middle - size / 2, middle + size / 2)})
        axes.set_box_aspect(tuple(span.tolist()))
        axes.set_title(title, loc="left")
        axes.set_axis_off()
    for colour, name in ((COLOURS[0], "model"), (COLOURS[1], "measured, at the sensors")):
        figure.axes[0].plot([], [], "-", color=colour, label=name)
    figure.legend(*figure.axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure


def _mesh(axes: Axes3D, X: Floats, lines: Ints, faces: Ints, colour: str, alpha: float) -> None:
    if len(lines):
        axes.add_collection3d(Line3DCollection(list(X[lines]), colors=colour, linewidths=0.9))
    if len(faces):
        corners = [X[face[face >= 0]] for face in faces]
        marks = {"facecolors": (colour, alpha), "edgecolors": colour, "linewidths": 0.3}
        axes.add_collection3d(Poly3DCollection(corners, **marks))
