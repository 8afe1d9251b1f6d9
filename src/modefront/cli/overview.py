"""The nominal model beside the updated ones: parameters, modes and errors of the groups in a table.

The first screen has the models that fit into the width, and the rows that fit into its lines:
parameters that change most, and modes that fit worst.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import xarray as xr

from modefront._typing import Floats, Ints
from modefront.cli.layout import BLANK, Line, Screen, number, plural
from modefront.front.point import Kind
from modefront.results.selection import reference

FEWEST = 3
"""Parameters and modes that a table keeps, however long it is."""

BOUND = {-1: " min", 1: " max"}


def first_models(data: xr.Dataset) -> list[int]:
    """Return the positions of the nominal model, the reference and the edges."""
    kinds = data["kind"].values
    chosen = [
        *np.flatnonzero(kinds == Kind.NOMINAL.value).tolist(),
        reference(data),
        *np.flatnonzero(kinds == Kind.EDGE.value).tolist(),
    ]
    return list(dict.fromkeys(chosen))


def print_models(screen: Screen, data: xr.Dataset) -> None:
    """Print all parameters, modes and errors of the first models."""
    table = _Table(data, np.arange(data.sizes["parameter"]), np.arange(data.sizes["mode"]))
    screen.show([BLANK, *table.lines(screen, first_models(data))])


def models_in(screen: Screen, data: xr.Dataset, most: int, full: str) -> list[Line]:
    """Return the lines of the first models, ``most`` or fewer where that is possible.

    ``full`` is the command that prints what is left out.
    """
    first, best = first_models(data)[0], reference(data)
    theta, f = data["theta"].values, data["frequency"].values
    change = np.abs(theta[best] - theta[first]) / np.ptp(data["bounds"].values, axis=1)
    error = np.abs(f[best] / data["measured_frequency"].values - 1)
    parameters, modes = (np.argsort(-np.nan_to_num(x), kind="stable") for x in (change, error))
    p, m = parameters.size, modes.size
    while True:
        table = _Table(data, np.sort(parameters[:p]), np.sort(modes[:m]))
        lines = table.that_fit(screen, full)
        if len(lines) <= most or (p <= FEWEST and m <= FEWEST):
            return lines
        # Each row that is left out saves a line at least, and names or blocks save more.
        fewer = max((len(lines) - most) // 6, 1)
        if p > FEWEST and (p >= m or m <= FEWEST):
            p = max(p - fewer, FEWEST)
        else:
            m = max(m - fewer, FEWEST)


@dataclass(frozen=True)
class _Table:
    """A table with some of the parameters and modes."""

    data: xr.Dataset
    parameters: Ints
    modes: Ints

    def that_fit(self, screen: Screen, full: str) -> list[Line]:
        """Return the lines of the models that fit side by side, and what is left out."""
        models = every = first_models(self.data)
        while len(models) > 2 and BLANK in self.lines(screen, models):
            models = models[:-1]
        p = self.data.sizes["parameter"] - self.parameters.size
        m = self.data.sizes["mode"] - self.modes.size
        e = len(every) - len(models)
        left = [
            *([f"{plural(p, 'more parameter')} that change{'s' * (p == 1)} less"] * (p > 0)),
            *([f"{plural(m, 'more mode')} that fit{'s' * (m == 1)} better"] * (m > 0)),
            *([plural(e, "edge")] * (e > 0)),
        ]
        said = screen.sentence(f"and {', '.join(left)}: {full}") if left else []
        return [*self.lines(screen, models), *said]

    def lines(self, screen: Screen, models: list[int]) -> list[Line]:
        """Return the table of some models, and what explains it."""
        columns = ["", *(str(self.data["label"].values[i]) for i in models)]
        out = screen.grid("", columns, list(self._rows(models)))
        std, explained = deviations(self.data)
        notes = [f"±: {explained}"] * bool(np.isfinite(std[self.parameters]).any())
        if self._bound[models][:, self.parameters].any():
            notes.append("min, max: at its lower or upper bound")
        return [*out, *screen.sentence("; ".join(notes))] if notes else out

    @property
    def _bound(self) -> Ints:
        given = self.data.get("at_bound")
        return np.zeros(self.data["theta"].shape, int) if given is None else given.values

    def _rows(self, models: list[int]) -> Iterator[list[str]]:
        """Yield the cells, with headings."""
        data, f = self.data, self.data["frequency"].values
        std, best = deviations(data)[0], reference(data)
        yield ["parameters"]
        for j in self.parameters:
            row = [f"  {data['parameter'].values[j]}"]
            for i in models:
                bound = BOUND.get(int(self._bound[i, j]), "")
                scatter = f" ± {std[j]:.2g}" * (i == best and np.isfinite(std[j]) and not bound)
                value = number(data["theta"].values[i, j], "#.4g").removesuffix(".")
                row.append(f"{value}{scatter}{bound}")
            yield row
        yield ["modes: error of the frequency in %, and MAC"]
        for r in self.modes:
            measured = data["measured_frequency"].values[r]
            row = [f"  {data['mode'].values[r]}"]
            row[0] += f": {measured:.4g} Hz" * bool(np.isfinite(measured))
            for i in models:
                error = 100 * (f[i, r] / measured - 1)
                first = f"{f[i, r]:.4g} Hz" if np.isnan(error) else f"{round(error, 2) + 0.0:+.2f}"
                mac = number(data["mac"].values[i, r], ".3f")
                row.append("none" if np.isnan(f[i, r]) else f"{first}  {mac}")
            yield row
        yield ["errors of the groups, root mean square"]
        for g, group in enumerate(data["group"].values):
            yield [f"  {group}", *(number(data["error"].values[i, g], ".3g") for i in models)]


def deviations(data: xr.Dataset) -> tuple[Floats, str]:
    """Return standard deviations (p,) of the parameters of the reference, and what they are."""
    if "sample_theta" in data:
        std = data["sample_theta"].values.std(axis=0, ddof=1)
        return std, "standard deviation of the posterior"
    if "theta_std" in data:
        return data["theta_std"].values[reference(data)], "standard deviation by errors of the data"
    if "posterior_std" in data:
        return data["posterior_std"].values, "standard deviation of the posterior"
    return np.full(data.sizes["parameter"], np.nan), ""
