"""Uncertainty in the results, as tables."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from rich.console import Console

from modefront.cli.tables import safe, table


def print_knowledge(console: Console, data: xr.Dataset) -> None:
    """Print how far models and objectives scatter, and the posterior, where they are known."""
    names = [safe(name) for name in data["parameter"].values]
    groups = [safe(name) for name in data["group"].values]
    for kind, title in (
        ("", "scatter by errors of the data: standard deviations, linearised"),
        ("bootstrap_", "scatter over data drawn again: standard deviations"),
    ):
        if f"{kind}theta_std" in data:
            doubts = data.get("scatter_doubt") if kind == "" else None
            more = [] if doubts is None else ["doubtful"]
            rows = table(title, ["model", *(f"J {g}" for g in groups), *names, *more])
            J, theta = data[f"{kind}objective_std"].values, data[f"{kind}theta_std"].values
            for i, label in enumerate(data["label"].values):
                rows.add_row(safe(label), *_row([*J[i], *theta[i]]), *_of(doubts, i))
            console.print(rows)
    if "posterior_std" in data:
        modes = data["mode"].values
        rows = table(
            f"posterior around {safe(data.attrs['reference'])}: standard deviations, variances of "
            "errors unknown",
            ["", *names, *(f"f{r} Hz" for r in modes), *(f"MAC {r}" for r in modes)],
        )
        values = [data[f"posterior_{name}std"].values for name in ("", "frequency_", "mac_")]
        rows.add_row("", *_row(np.concatenate(values)))
        console.print(rows)


def _of(texts: xr.DataArray | None, i: int) -> list[str]:
    return [] if texts is None else [safe(texts.values[i])]


def _row(values: Sequence[float] | np.ndarray[Any, Any]) -> list[str]:
    return ["" if np.isnan(x) else f"{x:.3g}" for x in values]
