"""The three-story building: fronts of M0 and M1 beside the numbers published for them.

Christodoulou, Ntotsios, Papadimitriou & Panetsos (2008), doi:10.1016/j.cma.2008.04.010.
Runs the two studies that ``modefront init`` writes, in the folder named on the command line.
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import xarray as xr
from rich import box
from rich.console import Console
from rich.table import Table

import modefront as mf

PUBLISHED: dict[str, dict[str, Sequence[float]]] = {
    "M0": {
        "greatest frequency error, %": [6.0, 2.7, 4.9],
        "least MAC": [0.990, 0.863, 0.851],
        "dominated points": [6, 7],
    },
    "M1": {
        "greatest frequency error, %": [5.1, 2.3, 3.1],
        "least MAC": [0.997, 0.895, 0.884],
        "dominated points": [],
    },
}


def front(folder: Path) -> dict[str, Sequence[float]]:
    """Return the numbers that the paper prints of a front, from results."""
    data = mf.read_results(folder).dataset
    nbi = data.isel(point=data["kind"].values == "front")
    error = 100 * np.abs(nbi["frequency"].values / nbi["measured_frequency"].values - 1)
    return {
        "greatest frequency error, %": error.max(axis=0).tolist(),
        "least MAC": nbi["mac"].min("point").values.tolist(),
        "dominated points": (np.flatnonzero(nbi["dominated_among_front"].values) + 1).tolist(),
        "optimal weights lie next to point": [nearest(data, nbi) + 1],
    }


def nearest(data: xr.Dataset, nbi: xr.Dataset) -> int:
    """Return the position of the front point that is closest to the optimally weighted model."""
    (optimal,) = data["theta"].values[data["kind"].values == "optimal-weights"]
    return int(np.argmin(((nbi["theta"].values - optimal) ** 2).sum(axis=1)))


def main(folder: Path) -> None:
    """Run both studies and print the comparison."""
    table = Table(title="Pareto fronts, 20 points", box=box.SIMPLE_HEAD, title_justify="left")
    for heading in ("", "published", "found"):
        table.add_column(heading)
    for configuration, model in (("c0", "M0"), ("c1", "M1")):
        place = folder / configuration
        if not (place / "study.toml").exists():
            command("init", str(place), "--example", f"three-story-{configuration}")
        command("run", str(place / "study.toml"), "-o", str(place / "results"))
        result = front(place / "results")
        for name, values in result.items():
            published = PUBLISHED[model].get(name, [20])
            table.add_row(f"{model}: {name}", text(published), text(values))
    Console(width=100).print(table)


def command(*arguments: str) -> None:
    """Run the command ``modefront``; leave with its status where that is not 0."""
    status = subprocess.run([sys.executable, "-m", "modefront", *arguments], check=False).returncode
    if status:
        sys.exit(status)


def text(values: Sequence[float]) -> str:
    """Return numbers as the table shows them."""
    shown = [f"{x:.3f}" if 0 < x < 1 else f"{x:.2f}".rstrip("0").rstrip(".") for x in values]
    return ", ".join(shown) or "none"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "demo"))
