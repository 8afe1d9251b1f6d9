"""Conditions on results: variables of the schema that belong together, values with a meaning."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np
import xarray as xr

from modefront.front.point import REFERENCES, Kind, preferred
from modefront.predictions.base import ATTRIBUTE, Values, Variable, kinds_from
from modefront.results.schema import ATTRIBUTES, DIMENSIONS, VARIABLES, variables_in, variables_of
from modefront.text import NAME, clean

DTYPES: Mapping[Values, str] = {"number": "fiu", "count": "iuf", "truth": "biu", "text": "UOST"}
"""Kinds of NumPy types that each of these may have in a file."""

COORDINATES: Mapping[str, Variable] = {
    "parameter": Variable(
        "parameter", ("parameter",), DIMENSIONS["parameter"], "text", required=True
    ),
    "group": Variable("group", ("group",), DIMENSIONS["group"], "text", required=True),
    "mode": Variable("mode", ("mode",), DIMENSIONS["mode"], "count", required=True),
}
"""Coordinates that all results have."""

FINITE = (
    *("theta", "objective", "error", "frequency", "bounds", "properties"),
    *("minimum_theta", "minimum_objective", "lattice", "equal_theta", "equal_objective"),
    *("combination_direction", "combination_share"),
    *("node", "shape_basis", "sensor_direction"),
)
"""Variables of numbers that are known wherever there are any."""

UNIQUE = ("label", "parameter", "group", "mode")
"""Variables and coordinates whose values do not repeat."""

SIZES: Mapping[str, int] = {
    **{"bound": 2, "range": 3, "statistic": 5, "quantile": 3},
    **{"line_end": 2, "corner": 4, "axis": 3},
}
"""Sizes of dimensions that are always the same."""

LARGEST = 1e9
"""Greatest count."""

Wrong = tuple[str, str, str]
"""Place, expected, found."""


def faults(data: xr.Dataset) -> list[Wrong]:
    """Return place, expected and found of what is wrong with a dataset.

    Values are looked at where all variables are there, of their types and dimensions.
    """
    return list(_structure(data)) or [*_texts(data), *_numbers(data), *_of_file(data)]


def _structure(data: xr.Dataset) -> Iterator[Wrong]:
    """Yield what is missing, also beside what is there, or of another type, dimensions or size."""
    for name, attribute in ATTRIBUTES.items():
        place = f"attribute '{name}'"
        if name not in data.attrs:
            yield from [(place, attribute.meaning, "nothing")] * attribute.required
        elif isinstance(data.attrs[name], str) != (attribute.values == "text"):
            yield place, f"a {attribute.values}", repr(data.attrs[name])
    try:
        kinds = kinds_from(str(data.attrs.get(ATTRIBUTE, "")))
        variables = {**COORDINATES, **variables_of(kinds)}
    except ValueError as error:
        yield f"attribute '{ATTRIBUTE}'", "kinds of predictions in JSON", str(error)
        return
    there = {variables[name].together: name for name in variables if name in data.variables}
    for name, variable in variables.items():
        beside, known = there.get(variable.together), data.variables.get(name)
        if known is None:
            expected = f"it, as there is '{beside}'" if variable.together else variable.meaning
            is_missing = variable.required or (beside and variable.together)
            yield from [(_place(name), expected, "nothing")] * bool(is_missing)
        elif known.dims != variable.dimensions:
            dimensions = (", ".join(map(str, x)) for x in (variable.dimensions, known.dims))
            expected, found = (x or "none" for x in dimensions)
            yield _place(name), f"dimensions {expected}", found
        elif known.dtype.kind not in DTYPES[variable.values]:
            yield _place(name), f"values of type {variable.values}", str(known.dtype)
    predicted = [kind.dimension for kind in kinds] + ["range"] * bool(kinds)
    shown = [x for x in ("range", "statistic", "quantile", "set", "sensor") if x in data.dims]
    for name in dict.fromkeys([*shown, *predicted]):
        if name not in data.coords:
            yield f"coordinate '{name}'", DIMENSIONS.get(name, "names of its places"), "nothing"
    if kinds and "frequency_range" not in data:
        yield "variable 'frequency_range'", "it, as there are predictions", "nothing"
    for name in ("point", "parameter", "group", "mode"):
        if not data.sizes.get(name):
            yield f"dimension '{name}'", f"at least one: {DIMENSIONS[name]}", "none"
    others = {f"{name}_other": data.sizes.get(name, 0) for name in ("parameter", "group")}
    for name, size in {**SIZES, **others}.items():
        if data.sizes.get(name, size) != size:
            yield f"dimension '{name}'", f"{size}: {DIMENSIONS[name]}", str(data.sizes[name])
    if data.sizes.get("end", 0) % 2:
        yield "dimension 'end'", "an end and a start for each gap", str(data.sizes["end"])


def _texts(data: xr.Dataset) -> Iterator[Wrong]:
    for name, variable in data.variables.items():
        wrong = [x for x in variable.values.ravel() if not isinstance(x, str)]
        if variable.dtype.kind in "OST" and wrong:
            yield _place(name), "texts", repr(wrong[0])
            return
    for name in UNIQUE:
        values = data[name].values.tolist()
        if len(set(values)) < len(values):
            repeated = next(value for value in values if values.count(value) > 1)
            yield _place(name), "each value once", f"{clean(repeated, NAME)!r} again"
    kinds, known = data["kind"].values.tolist(), [kind.value for kind in Kind]
    for kind in [str(kind) for kind in kinds if kind not in known][:1]:
        yield "variable 'kind'", f"any of {', '.join(known)}", clean(repr(kind), NAME)
    for reference in REFERENCES:
        if kinds.count(reference.value) > 1:
            yield "variable 'kind'", f"'{reference.value}' once", "more"


def _numbers(data: xr.Dataset) -> Iterator[Wrong]:
    """Yield the first value of each variable that is none that it can have."""
    for name, variable in {**COORDINATES, **variables_in(data)}.items():
        if name not in data or variable.values == "text":
            continue
        x = data[name].values
        if variable.values == "truth":
            yield from _first(name, "truth values, 0 or 1", x, np.isin(x, (0, 1)))
        elif variable.values == "count":
            whole = (np.abs(x) <= LARGEST) & (x == np.round(x))
            yield from _first(name, "whole numbers", x, whole)
        elif name in FINITE:
            yield from _first(name, "finite numbers", x, np.isfinite(x))
    for name in ("objective", "error", "minimum_objective"):
        yield from _first(name, "numbers of 0 or more", x := data[name].values, ~(x < 0))
    lower, upper = data["bounds"].values.T
    yield from _first("bounds", "lower bounds below upper ones", lower, lower < upper)
    f = data["measured_frequency"].values
    known = np.isnan(f) | ((f > 0) & np.isfinite(f))
    yield from _first("measured_frequency", "frequencies above 0", f, known)
    count = data.sizes.get("drawn_node", 0)
    for name, least in (("line_nodes", 0), ("face_nodes", -1), ("sensor_node", 0)):
        if name in data:
            x = data[name].values
            expected = f"nodes from {least} to {count - 1}"
            yield from _first(name, expected, x, (x >= least) & (x < count))
    if "face_nodes" in data:
        corners = data["face_nodes"].values[:, :3]
        yield from _first("face_nodes", "three corners at least", corners, corners >= 0)


def _of_file(data: xr.Dataset) -> Iterator[Wrong]:
    for name, attribute in ATTRIBUTES.items():
        if name not in data.attrs or attribute.values == "text":
            continue
        value = np.asarray(data.attrs[name])
        if value.ndim or value.dtype.kind not in "fiub":
            yield f"attribute '{name}'", "a number", clean(repr(data.attrs[name]), NAME)
        elif attribute.values == "count" and not (0 <= value < 2**63 and value == np.round(value)):
            yield f"attribute '{name}'", "a whole number of 0 or more", str(value)
    if "certified" in data and "eigenvalue_tolerance" not in data.attrs:
        yield "attribute 'eigenvalue_tolerance'", "it, as there is 'certified'", "nothing"
    if preferred(data.attrs) not in data["label"].values:
        found = clean(repr(str(data.attrs["reference"])), NAME)
        yield "attribute 'reference'", "the label of a point", found


def _place(name: object) -> str:
    is_label = name in DIMENSIONS and name not in VARIABLES
    return f"{'coordinate' if is_label else 'variable'} '{name}'"


def _first(name: str, expected: str, values: np.ndarray, right: np.ndarray) -> Iterator[Wrong]:
    """Yield the first value of a variable that is not ``right``, if there is one."""
    if not right.all():
        yield _place(name), expected, str(values[~np.asarray(right)].ravel()[0])
