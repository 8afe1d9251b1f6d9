"""Predictions as tables: range over the Pareto-optimal models, and values at labelled ones."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import xarray as xr

Row = tuple[str, ...]


def prediction_tables(data: xr.Dataset) -> Iterator[tuple[str, list[str], list[Row], list[str]]]:
    """Yield title, columns, rows and remarks of each prediction; nothing where there are none."""
    if "range" not in data.sizes:
        return
    named = [i for i, x in enumerate(data["label"].values) if not str(x).startswith("nbi-")]
    columns = ["minimum", "maximum", "spread", *map(str, data["label"].values[named])]

    def row(head: Sequence[str], name: str, i: int, form: str) -> Row:
        least, greatest, spread = data[f"{name}_range"].values[:, i]
        values = data[name].values[named, i]
        shown = (_number(x, form) for x in (least, greatest, *values))
        first, second, *others = shown
        return (*head, first, second, _number(spread, ".4g"), *others)

    frequencies = [
        row([f"f{r}, Hz"], "frequency", i, ".5g") for i, r in enumerate(data["mode"].values)
    ]
    title = "range over the Pareto-optimal models; spread is greatest over least"
    yield f"frequencies: {title}", ["", *columns], frequencies, []
    for name, at in _groups(data, "frf"):
        rows = []
        for i in at:
            response = _behind(data["frf"].values[i], name)
            rows.append(row([response, "peak"], "frf_peak", i, ".5g"))
            rows.append(row(["", "at Hz"], "frf_peak_frequency", i, ".5g"))
        low, high = data["frf_band"].values[at[0]]
        load, quantity, modes, damping = (
            data[f"frf_{key}"].values[at[0]] for key in ("load", "quantity", "modes", "damping")
        )
        said = (
            f"{name}: {load}; {quantity}, greatest peak from {low:g} to {high:g} Hz, {modes} "
            f"modes, damping {damping}"
        )
        yield said, ["response", "", *columns], rows, []
    for name, at in _groups(data, "failure"):
        rows = []
        for i in at:
            level = f"{data['failure_level'].values[i]:g}"
            rows.append(row([level, "P"], "failure_probability", i, ".3e"))
            variation = data["failure_variation"].values[:, i]
            shown = (_number(x, ".2g") for x in variation[named])
            rows.append(("", "c.o.v.", "", _number(variation.max(), ".2g"), "", *shown))
        yield _passage(data, name, at[0]), ["level", "", *columns], rows, _step_effect(data, at)


def _passage(data: xr.Dataset, name: str, i: int) -> str:
    def of(what: str) -> object:
        return data[f"failure_{what}"].values[i]

    return (
        f"{name}: {of('load')}; probability that any response leaves [-level, level] (two-sided "
        f"barrier) within {of('duration'):g} s, at rest at first; {of('sided')} spectral density "
        f"{of('density'):g}, time step {of('step'):g} s, {of('samples')} samples "
        f"({of('method')}), {of('modes')} modes, damping {of('damping')}"
    )


def _step_effect(data: xr.Dataset, at: Sequence[int]) -> list[str]:
    label = data["failure_halved_at"].values[at[0]]
    ratios = ", ".join(
        f"{_number(data['failure_halved'].values[i], '.3f')} ± "
        f"{_number(data['failure_halved_error'].values[i], '.3f')} "
        f"(level {data['failure_level'].values[i]:g})"
        for i in at
    )
    return [f"half the time step multiplies P at {label} by {ratios}"]


def _groups(data: xr.Dataset, dimension: str) -> list[tuple[str, list[int]]]:
    """Return the predictions along a dimension, each with its positions."""
    out: dict[str, list[int]] = {}
    for i, name in enumerate(data[f"{dimension}_name"].values if dimension in data.sizes else ()):
        out.setdefault(str(name), []).append(i)
    return list(out.items())


def _behind(text: object, name: str) -> str:
    return str(text).removeprefix(f"{name}: ")


def _number(value: float, form: str) -> str:
    return "none" if np.isnan(value) else format(float(value), form)
