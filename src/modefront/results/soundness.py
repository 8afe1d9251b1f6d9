"""Conditions on results: variables of the schema that belong together, values with a meaning."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np
import xarray as xr

from modefront.front.point import REFERENCES, Kind, preferred
from modefront.predictions.registry import ATTRIBUTE, kinds_from, kinds_in
from modefront.results.schema import ATTRIBUTES, DIMENSIONS, variables_in, variables_of
from modefront.text import NAME, clean
from modefront.variables import Values

DTYPES: Mapping[Values, str] = {"number": "fiu", "count": "iuf", "truth": "biu", "text": "UOST"}
"""Kinds of NumPy types that each of these may have in a file."""

COORDINATES: Mapping[str, str] = {"parameter": "UOST", "group": "UOST", "mode": "fiu"}
"""Coordinates that all results have, with their types."""

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


def faults(data: xr.Dataset, *, whole: bool = True) -> list[Wrong]:
    """Return place, expected and found of what is wrong with a dataset.

    Values are looked at where all variables are there, of their types and dimensions. A ``whole``
    dataset has all variables that belong together.
    """
    out = list(_structure(data)) or list(_together(data) if whole else ())
    return out or [*_sizes(data), *_texts(data), *_numbers(data), *_geometry(data), *_of_file(data)]


def _structure(data: xr.Dataset) -> Iterator[Wrong]:
    """Yield what is missing, or of another type or other dimensions."""
    for name, attribute in ATTRIBUTES.items():
        place = f"attribute '{name}'"
        if name not in data.attrs:
            yield from [(place, attribute.meaning, "nothing")] * attribute.required
        elif isinstance(data.attrs[name], str) != (attribute.values == "text"):
            yield place, f"a {attribute.values}", repr(data.attrs[name])
    for name, kinds in COORDINATES.items():
        place, known = f"coordinate '{name}'", data.coords.get(name)
        if known is None:
            yield place, DIMENSIONS[name], "nothing"
        elif known.dims != (name,) or known.dtype.kind not in kinds:
            found = f"{known.dtype} of the dimensions {', '.join(map(str, known.dims))}"
            yield place, DIMENSIONS[name], found
    try:
        variables = variables_of(kinds_from(str(data.attrs.get(ATTRIBUTE, ""))))
    except ValueError as error:
        yield f"attribute '{ATTRIBUTE}'", "kinds of predictions in JSON", str(error)
        return
    for name, variable in variables.items():
        place = f"variable '{name}'"
        if name not in data:
            yield from [(place, variable.meaning, "nothing")] * variable.required
        elif (dims := data[name].dims) != variable.dimensions:
            expected, found = (
                ", ".join(map(str, x)) or "none" for x in (variable.dimensions, dims)
            )
            yield place, f"dimensions {expected}", found
        elif data[name].dtype.kind not in DTYPES[variable.values]:
            yield place, f"values of type {variable.values}", str(data[name].dtype)
    if not data.sizes.get("point") or not data.sizes.get("mode"):
        yield "dimensions 'point' and 'mode'", "at least one each", "none"


def _together(data: xr.Dataset) -> Iterator[Wrong]:
    """Yield variables and coordinates without which others cannot be shown."""
    first: dict[str, str] = {}
    variables = [(x.together, name) for name, x in variables_in(data).items() if x.together]
    for together, name in variables:
        if name in data:
            first.setdefault(together, name)
    for together, name in variables:
        if together in first and name not in data:
            yield f"variable '{name}'", f"it, as there is '{first[together]}'", "nothing"
    kinds = [kind.dimension for kind in kinds_in(data)]
    for name in kinds:
        if name not in data.dims:
            yield f"dimension '{name}'", f"it, as '{ATTRIBUTE}' has it", "nothing"
    for name in ("range", "statistic", "quantile", "set", "sensor", *kinds):
        if name in data.dims and name not in data.coords:
            yield f"coordinate '{name}'", DIMENSIONS.get(name, "names of its places"), "nothing"
    for name in ("range", "frequency_range"):
        if name not in data and any(kind in data.dims for kind in kinds):
            yield f"variable '{name}'", "it, as there are predictions", "nothing"


def _sizes(data: xr.Dataset) -> Iterator[Wrong]:
    for name in ("point", "parameter", "group", "mode"):
        if not data.sizes.get(name):
            yield f"dimension '{name}'", f"at least one: {DIMENSIONS[name]}", "none"
    others = {f"{name}_other": data.sizes[name] for name in ("parameter", "group")}
    for name, size in {**SIZES, **others}.items():
        if data.sizes.get(name, size) != size:
            yield f"dimension '{name}'", f"{size}: {DIMENSIONS[name]}", str(data.sizes[name])
    if data.sizes.get("end", 0) % 2:
        yield "dimension 'end'", "an end and a start for each gap", str(data.sizes["end"])


def _texts(data: xr.Dataset) -> Iterator[Wrong]:
    for name, variable in data.variables.items():
        wrong = [x for x in variable.values.ravel() if not isinstance(x, str)]
        if variable.dtype.kind in "OST" and wrong:
            yield _place(data, name), "texts", repr(wrong[0])
            return
    for name in UNIQUE:
        values = data[name].values.tolist()
        if len(set(values)) < len(values):
            repeated = next(value for value in values if values.count(value) > 1)
            yield _place(data, name), "each value once", f"{clean(repeated, NAME)!r} again"
    kinds, known = data["kind"].values.tolist(), [kind.value for kind in Kind]
    for kind in [str(kind) for kind in kinds if kind not in known][:1]:
        yield "variable 'kind'", f"any of {', '.join(known)}", clean(repr(kind), NAME)
    for reference in REFERENCES:
        if kinds.count(reference.value) > 1:
            yield "variable 'kind'", f"'{reference.value}' once", "more"


def _numbers(data: xr.Dataset) -> Iterator[Wrong]:
    variables = variables_in(data)
    for name in ("mode", *variables):
        if name not in data or data[name].dtype.kind not in "fiub":
            continue
        values = data[name].values
        kind = variables[name].values if name in variables else "count"
        if kind == "truth":
            yield from _all(data, name, "truth values, 0 or 1", np.isin(values, (0, 1)))
        elif kind == "count":
            whole = (np.abs(values) <= LARGEST) & (values == np.round(values))
            yield from _all(data, name, "whole numbers", whole)
        elif name in FINITE:
            yield from _all(data, name, "finite numbers", np.isfinite(values))
    for name in ("objective", "error", "minimum_objective"):
        yield from _all(data, name, "numbers of 0 or more", ~(data[name].values < 0))
    bounds = data["bounds"].values
    if bounds.shape[1] == 2 and not (bounds[:, 0] < bounds[:, 1]).all():
        yield "variable 'bounds'", "lower bounds below upper ones", str(bounds[0].tolist())
    f = data["measured_frequency"].values
    known = np.isnan(f) | ((f > 0) & np.isfinite(f))
    yield from _all(data, "measured_frequency", "frequencies above 0", known)


def _geometry(data: xr.Dataset) -> Iterator[Wrong]:
    count = data.sizes.get("drawn_node", 0)
    for name, least in (("line_nodes", 0), ("face_nodes", -1), ("sensor_node", 0)):
        if name in data:
            right = (data[name].values >= least) & (data[name].values < count)
            yield from _all(data, name, f"nodes from {least} to {count - 1}", right)
    if "face_nodes" in data and (data["face_nodes"].values[:, :3] < 0).any():
        yield "variable 'face_nodes'", "three corners at least", "-1 among the first three"


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


def _place(data: xr.Dataset, name: object) -> str:
    return f"{'coordinate' if name in data.coords else 'variable'} '{name}'"


def _all(data: xr.Dataset, name: str, expected: str, right: np.ndarray) -> Iterator[Wrong]:
    """Yield the first value of a variable that is not ``right``."""
    if not right.all():
        yield _place(data, name), expected, str(data[name].values[~np.asarray(right)].ravel()[0])
