"""Predictions as tables: range over the Pareto-optimal models, posterior, and labelled models."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import xarray as xr

Row = tuple[str, ...]

DRAWN = ("mean", "5 %", "95 %")
"""Statistics of models drawn from the posterior that are shown."""


def prediction_tables(data: xr.Dataset) -> Iterator[tuple[str, list[str], list[Row], list[str]]]:
    """Yield title, columns, rows and remarks of each prediction; nothing where there are none."""
    if "range" not in data.sizes:
        return
    named = np.flatnonzero(data["kind"].values != "front").tolist()
    posterior = _Posterior(data)
    labels = list(map(str, data["label"].values[named]))
    columns = ["minimum", "maximum", "spread", *posterior.columns, *labels]

    def row(head: Sequence[str], name: str, i: int, form: str) -> Row:
        least, greatest, spread = data[f"{name}_range"].values[:, i]
        return (
            *head,
            _number(least, form),
            _number(greatest, form),
            _number(spread, ".4g"),
            *posterior.row(name, i, form),
            *(_number(x, form) for x in data[name].values[named, i]),
        )

    frequencies = [
        row([f"f{r}, Hz"], "frequency", i, ".5g") for i, r in enumerate(data["mode"].values)
    ]
    title = "range over the Pareto-optimal models; spread is greatest over least"
    yield f"frequencies: {title}", ["", *columns], frequencies, posterior.explained
    for name, positions in _groups(data, "frf"):
        rows = []
        for i in positions:
            response = _behind(data["frf"].values[i], name)
            rows.append(row([response, "peak"], "frf_peak", i, ".5g"))
            rows.append(row(["", "at Hz"], "frf_peak_frequency", i, ".5g"))
        low, high = data["frf_band"].values[positions[0]]
        load, quantity, modes, damping = (
            data[f"frf_{key}"].values[positions[0]]
            for key in ("load", "quantity", "modes", "damping")
        )
        heading = (
            f"{name}: {load}; {quantity}, greatest peak from {low:g} to {high:g} Hz, {modes} "
            f"modes, damping {damping}"
        )
        yield heading, ["response", "", *columns], rows, []
    for name, positions in _groups(data, "failure"):
        rows = []
        for i in positions:
            level = f"{data['failure_level'].values[i]:g}"
            rows.append(row([level, "P"], "failure_probability", i, ".3e"))
            variation = data["failure_variation"].values[:, i]
            shown = (_number(x, ".2g") for x in variation[named])
            blank = [""] * len(posterior.columns)
            rows.append(("", "c.o.v.", "", _number(variation.max(), ".2g"), "", *blank, *shown))
        yield (
            _passage(data, name, positions[0]),
            ["level", "", *columns],
            rows,
            _step_effect(data, positions),
        )


class _Posterior:
    """Scatter of predictions by the posterior, and models drawn from it, as columns."""

    def __init__(self, data: xr.Dataset) -> None:
        self.data = data
        self.known = "posterior_frequency_std" in data
        statistics = data["statistic"].values.tolist() if "statistic" in data.sizes else []
        self.drawn = [statistics.index(x) for x in DRAWN if x in statistics]

    @property
    def columns(self) -> list[str]:
        """Titles."""
        return ["posterior"] * self.known + [f"drawn {x}" for x in DRAWN[: len(self.drawn)]]

    @property
    def explained(self) -> list[str]:
        """Headings of the columns."""
        out = []
        if self.known:
            out.append(
                f"posterior: standard deviation around {self.data.attrs['reference']}; of P as a "
                "factor, e to that of ln P"
            )
        if self.drawn:
            out.append(
                f"drawn: over {self.data.sizes['draw']} models drawn from the posterior; the mean "
                "of P is the robust failure probability"
            )
        return out

    def row(self, name: str, i: int, form: str) -> list[str]:
        """Return the entries of one prediction."""
        of_p = name == "failure_probability"
        out = [""] * len(self.columns)
        std = self.data.get(f"posterior_{'failure_log' if of_p else name}_std")
        if std is not None:
            x = std.values[i]
            shown = np.exp(x) if of_p else x
            out[0] = (
                _number(shown, ".3g") if np.isnan(x) else f"{'×÷' if of_p else '±'} {shown:.3g}"
            )
        drawn = self.data.get(f"posterior_{name}")
        if drawn is not None:
            out[self.known :] = [_number(x, form) for x in drawn.values[self.drawn, i]]
        return out


def _passage(data: xr.Dataset, name: str, i: int) -> str:
    def of(what: str) -> object:
        return data[f"failure_{what}"].values[i]

    return (
        f"{name}: {of('load')}; probability that any response leaves [-level, level] (two-sided "
        f"barrier) within {of('duration'):g} s, at rest at first; {of('sided')} spectral density "
        f"{of('density'):g}, time step {of('step'):g} s, {of('samples')} samples "
        f"({of('method')}), {of('modes')} modes, damping {of('damping')}"
    )


def _step_effect(data: xr.Dataset, positions: Sequence[int]) -> list[str]:
    label = data["failure_halved_at"].values[positions[0]]
    ratios = ", ".join(
        f"{_number(data['failure_halved'].values[i], '.3f')} ± "
        f"{_number(data['failure_halved_error'].values[i], '.3f')} "
        f"(level {data['failure_level'].values[i]:g})"
        for i in positions
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
