"""Writes the mesh of the examples three-story-fe-c0 and three-story-fe-c1.

A reconstruction: the paper describes the structure but prints no section sizes. What is chosen
here, and why, is in docs/three-story-fe.md. Needs meshio.
"""

from __future__ import annotations

from pathlib import Path

import meshio
import numpy as np

from modefront._typing import Floats, Ints

EXAMPLES = Path(__file__).parents[1] / "src" / "modefront" / "study" / "examples"

STORY, STIFF_END, SPAN, WIDTH = 0.8, 0.05, 0.5, 0.0965  # m
ROWS, ACROSS = 6, 2  # plates along and across a column in a story


def levels() -> Floats:
    """Return the heights of the rows of nodes."""
    inner = STIFF_END + (STORY - 2 * STIFF_END) * np.arange(1, ROWS - 1) / (ROWS - 2)
    column = np.array([STIFF_END, *inner, STORY])
    return np.concatenate([[0.0], *(story * STORY + column for story in range(3))])


def building() -> tuple[meshio.Mesh, Ints]:
    """Return the mesh and the nodes (column, level, place across)."""
    x, y = np.array([0.0, SPAN]), np.linspace(-WIDTH / 2, WIDTH / 2, ACROSS + 1)
    z = levels()
    grid = np.stack(np.meshgrid(x, z, y, indexing="ij"), axis=-1)  # x, z, y
    nodes = grid[..., [0, 2, 1]].reshape(-1, 3)
    position = np.arange(len(nodes)).reshape(2, len(z), ACROSS + 1)
    quads, tags = [], []
    for column in range(2):
        for row in range(3 * ROWS):
            story, place = divmod(row, ROWS)
            joint = place in (0, ROWS - 1)
            for j in range(ACROSS):
                low, high = position[column, row], position[column, row + 1]
                quads.append([low[j], low[j + 1], high[j + 1], high[j]])
                tags.append(4 if joint else story + 1)
    middle = ACROSS // 2
    floors = [position[:, ROWS * (story + 1), middle] for story in range(3)]
    physical = [np.array(tags), np.full(3, 5), np.full(2 * (ACROSS + 1), 6)]
    return meshio.Mesh(
        nodes,
        [
            ("quad", np.array(quads)),
            ("line", np.array(floors)),
            ("vertex", position[:, 0].reshape(-1, 1)),
        ],
        cell_data={"gmsh:physical": physical, "gmsh:geometrical": physical},
        field_data={
            **{f"story{i + 1}": np.array([i + 1, 2]) for i in range(3)},
            "joints": np.array([4, 2]),
            "floors": np.array([5, 1]),
            "base": np.array([6, 0]),
        },
    ), position


def main() -> None:
    """Write the mesh into both examples and print the nodes at the ends of the floors."""
    mesh, position = building()
    for configuration in ("c0", "c1"):
        path = EXAMPLES / f"three-story-fe-{configuration}" / "building.msh"
        path.parent.mkdir(exist_ok=True)
        meshio.write(path, mesh, file_format="gmsh22", binary=False)
    for story in range(3):
        print(
            f"floor {story + 1}: nodes of the two joints {position[:, ROWS * (story + 1)].tolist()}"
        )


if __name__ == "__main__":
    main()
