"""The first models of results, the nominal one beside the updated ones, in a table of one screen.

Tables are tried from the fullest to the shortest: standard deviations of all models or of the
reference only, MAC beside the errors of frequencies or in rows of their own. Where none is short
enough, the parameters that change least and the modes that fit best are left to the full list.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from modefront._typing import Floats, Ints
from modefront.cli.layout import BLANK, KEY, Line, Screen
from modefront.front.point import Kind, preferred

FEWEST = 3
"""Parameters and modes that a table keeps, however long it is."""

EDGES = 6
"""Parameters and modes that columns of the edges are worth."""

FULL = "modefront show --models"
"""Option of ``show`` that prints all parameters and modes of these models."""


@dataclass(frozen=True)
class Form:
    """Contents of the table of the first models.

    Attributes
    ----------
    every_std : standard deviations of all models, not only of the reference
    beside : MAC beside the errors of frequencies, not in rows of their own
    edges : whether edges have columns, not a line each
    part : greatest part of the width that names of rows take
    """

    every_std: bool = True
    beside: bool = True
    edges: bool = True
    part: float = KEY


NARROW = 0.28
"""Part of the width for names that are broken over lines rather than the table into blocks."""

FORMS = (
    Form(),
    Form(every_std=False),
    Form(every_std=False, part=NARROW),
    Form(every_std=False, beside=False),
    Form(every_std=False, beside=False, part=NARROW),
    Form(every_std=False, edges=False),
)
"""Forms from the fullest to the shortest."""


def first_models(data: xr.Dataset, *, edges: bool = True) -> list[int]:
    """Return the positions of the nominal model, the reference and the ``edges``."""
    kinds, labels = data["kind"].values, data["label"].values
    chosen = [
        *np.flatnonzero(kinds == Kind.NOMINAL.value).tolist(),
        *np.flatnonzero(labels == preferred(data.attrs)).tolist(),
        *(np.flatnonzero(kinds == Kind.EDGE.value).tolist() if edges else []),
    ]
    return list(dict.fromkeys(chosen))


def print_models(screen: Screen, data: xr.Dataset) -> None:
    """Print parameters, errors of frequencies, MAC and errors of groups of the first models."""
    table = _Table(data, Form(), np.arange(data.sizes["parameter"]), np.arange(data.sizes["mode"]))
    screen.show([BLANK, *table.lines(screen)])


def models_in(screen: Screen, data: xr.Dataset, most: int) -> list[Line]:
    """Return the lines of the first models, ``most`` or fewer where that is possible."""
    parameters, modes = _by_change(data), _by_error(data)

    def table(form: Form, p: int, m: int) -> _Table:
        return _Table(data, form, np.sort(parameters[:p]), np.sort(modes[:m]))

    whole = [table(form, parameters.size, modes.size) for form in FORMS]
    at_once = [each for each in whole if each.blocks(screen) == 1]
    for each in (each for some in (at_once, whole) for each in some if each.form.edges):
        lines = each.lines(screen)
        if len(lines) <= most:
            return lines
    # The table that shows most parameters and modes; columns of the edges are worth a few of them.
    best, out = -1, table(FORMS[-1], FEWEST, FEWEST).lines(screen)
    for each in at_once or whole:
        p, m = parameters.size, modes.size
        lines = each.lines(screen)
        while len(lines) > most and (p > FEWEST or m > FEWEST):
            # Each row that is left out saves a line at least, and names or blocks save more.
            fewer = max((len(lines) - most) // 6, 1)
            if p > FEWEST and (p >= m or m <= FEWEST):
                p = max(p - fewer, FEWEST)
            else:
                m = max(m - fewer, FEWEST)
            lines = table(each.form, p, m).lines(screen)
        worth = p + m + EDGES * each.form.edges
        if len(lines) <= most and worth > best:
            best, out = worth, lines
    return out


class _Table:
    """A table of the first models with some of the parameters and modes."""

    def __init__(self, data: xr.Dataset, form: Form, parameters: Ints, modes: Ints) -> None:
        self.data, self.form = data, form
        self.parameters, self.modes = parameters.tolist(), modes.tolist()
        self.models = first_models(data, edges=form.edges)
        self.std, self.explained = standard_deviations(data)
        self.bound = _bounds(data)
        labels = data["label"].values
        self.reference = int(np.flatnonzero(labels == preferred(data.attrs))[0])

    @property
    def columns(self) -> list[str]:
        return ["", *(str(self.data["label"].values[i]) for i in self.models)]

    def lines(self, screen: Screen) -> list[Line]:
        """Return the table and what explains it."""
        out = screen.grid("", self.columns, self.rows, part=self.form.part)
        if not self.form.edges:
            out += [BLANK, *self._edges(screen)]
        for text in self.notes:
            out += screen.sentence(text)
        return out

    def blocks(self, screen: Screen) -> int:
        """Return the number of blocks of the table, each of which has one line below its titles."""
        whole = screen.grid("", self.columns, self.rows, part=self.form.part)
        return 1 + sum(line == BLANK for line in whole)

    @property
    def rows(self) -> list[list[str]]:
        """Cells, with headings."""
        data, rows = self.data, [["parameters"]]
        names = data["parameter"].values
        rows += [
            [f"  {names[j]}", *(self._value(i, j) for i in self.models)] for j in self.parameters
        ]
        beside = ", and MAC" if self.form.beside else ""
        rows.append([f"modes: error of the frequency in %{beside}"])
        rows += [[self._mode(r), *(self._error(i, r) for i in self.models)] for r in self.modes]
        if not self.form.beside:
            rows.append(["modes: MAC"])
            mac = data["mac"].values
            rows += [
                [f"  {data['mode'].values[r]}", *(_number(mac[i, r], ".3f") for i in self.models)]
                for r in self.modes
            ]
        rows.append(["errors of the groups, root mean square"])
        error = data["error"].values
        rows += [
            [f"  {group}", *(_number(error[i, g], ".3g") for i in self.models)]
            for g, group in enumerate(data["group"].values)
        ]
        return rows

    def _value(self, i: int, j: int) -> str:
        std = self.std[i, j] if self.form.every_std or i == self.reference else np.nan
        shown = _number(self.data["theta"].values[i, j], "#.4g").removesuffix(".")
        if not np.isnan(std):
            shown += f" ± {std:.2g}"
        return shown + {-1: " min", 1: " max"}.get(int(self.bound[i, j]), "")

    def _mode(self, r: int) -> str:
        mode, f = self.data["mode"].values[r], self.data["measured_frequency"].values[r]
        return f"  {mode}: {f:.4g} Hz" if np.isfinite(f) else f"  {mode}"

    def _error(self, i: int, r: int) -> str:
        f, mac = self.data["frequency"].values[i, r], self.data["mac"].values[i, r]
        if np.isnan(f):
            return "none"
        error = 100 * (f / self.data["measured_frequency"].values[r] - 1)
        first = f"{f:.4g} Hz" if np.isnan(error) else f"{round(error, 2) + 0.0:+.2f}"
        return f"{first}  {_number(mac, '.3f')}" if self.form.beside else first

    def _edges(self, screen: Screen) -> list[Line]:
        """Return a table with a line for each edge."""
        data, rows = self.data, []
        for i in np.flatnonzero(data["kind"].values == Kind.EDGE.value).tolist():
            error = 100 * np.abs(
                data["frequency"].values[i] / data["measured_frequency"].values - 1
            )
            worst = np.nanmax(error, initial=-np.inf)
            least = np.nanmin(data["mac"].values[i], initial=np.inf)
            rows.append(
                [
                    str(data["label"].values[i]),
                    f"{worst:.2f}" if np.isfinite(worst) else "none",
                    f"{least:.3f}" if np.isfinite(least) else "none",
                ]
            )
        title = "edges, each the best model for one group: worst error of a frequency, least MAC"
        return screen.grid(title, ["", "error %", "MAC"], rows)

    @property
    def notes(self) -> Iterator[str]:
        """Legend of the table, with the number of rows that it leaves out."""
        p = self.data.sizes["parameter"] - len(self.parameters)
        m = self.data.sizes["mode"] - len(self.modes)
        left = [
            *([f"{_count(p, 'parameter')} that change{'s' * (p == 1)} less"] if p else []),
            *(
                [f"{_count(m, 'mode')} whose frequenc{'y fits' if m == 1 else 'ies fit'} better"]
                * (m > 0)
            ),
            *([] if self.form.edges else ["the parameters of the edges"]),
        ]
        if left:
            yield f"and {' and '.join(left)}: {FULL}"
        yield from self.explained
        if self.bound[np.ix_(self.models, self.parameters)].any():
            yield "min, max: the parameter is at this bound"


def _by_change(data: xr.Dataset) -> Ints:
    """Return the positions of the parameters, those that the reference changes most first."""
    first, best = (
        first_models(data, edges=False)[0],
        data["label"].values == preferred(data.attrs),
    )
    bounds, theta = data["bounds"].values, data["theta"].values
    change = np.abs(theta[best][0] - theta[first]) / np.ptp(bounds, axis=1)
    order: Ints = np.argsort(-np.nan_to_num(change), kind="stable")
    return order


def _by_error(data: xr.Dataset) -> Ints:
    """Return the positions of the modes, those whose frequency the reference misses most first."""
    best = data["label"].values == preferred(data.attrs)
    error = np.abs(data["frequency"].values[best][0] / data["measured_frequency"].values - 1)
    order: Ints = np.argsort(-np.nan_to_num(error), kind="stable")
    return order


def standard_deviations(data: xr.Dataset) -> tuple[Floats, list[str]]:
    """Return standard deviations of the parameters (points, p), NaN for none, and what they are."""
    std = np.full(data["theta"].shape, np.nan)
    explained = []
    if "theta_std" in data:
        std = np.array(data["theta_std"].values)
        explained.append("±: one standard deviation by the errors of the data")
    if "posterior_std" in data and ("sample_theta" in data or not explained):
        label = preferred(data.attrs)
        std[data["label"].values == label] = data["posterior_std"].values
        explained.append(f"± of {label}: standard deviation of the posterior")
    if np.isinf(std).any():
        explained.append("± inf: the data do not determine the parameter")
    if not explained:
        explained.append("no standard deviations: the results hold no errors of the data")
    return std, explained


def _bounds(data: xr.Dataset) -> Floats:
    if "at_bound" in data:
        return np.asarray(data["at_bound"].values)
    return np.zeros(data["theta"].shape)


def _count(number: int, noun: str) -> str:
    return f"{number} more {noun}{'s' * (number > 1)}"


def _number(value: float, form: str) -> str:
    return "none" if np.isnan(value) else format(float(value), form)


def predictions_in(
    screen: Screen, columns: Sequence[str], rows: Sequence[Sequence[str]], most: int
) -> list[Line]:
    """Return the lines of the first predictions, ``most`` of them, and how many more there are."""
    title = "predictions, with their range over all Pareto-optimal models"
    out = screen.grid(title, columns, rows[:most])
    rest = len(rows) - most
    if rest > 0:
        more = f"and {rest} more prediction{'s' * (rest > 1)}: modefront show --predictions"
        out += screen.sentence(more)
    return out
