"""Conditions on results: variables of the schema that belong together, values with a meaning.

Files may be damaged, or made by other programs.
"""

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

COUNTS = (
    *("seed", "front_is_a_point", "model_evaluations", "front_evaluations", "nbi_evaluations"),
    *("full_eigensolutions", "reduced_solutions", "prediction_eigensolutions"),
    *("corrected_eigensolutions", "factorisations", "shape_eigensolutions", "format"),
)
"""Attributes that count something."""

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
        if name not in data.attrs:
            if attribute.required:
                yield f"attribute '{name}'", attribute.meaning, "nothing"
        elif isinstance(data.attrs[name], str) != (attribute.values == "text"):
            yield f"attribute '{name}'", f"a {attribute.values}", f"{data.attrs[name]!r}"
    for name, kinds in COORDINATES.items():
        if name not in data.coords:
            yield f"coordinate '{name}'", DIMENSIONS[name], "nothing"
        elif data[name].dims != (name,) or data[name].dtype.kind not in kinds:
            found = f"{data[name].dtype} of the dimensions {', '.join(map(str, data[name].dims))}"
            yield f"coordinate '{name}'", DIMENSIONS[name], found
    try:
        variables = variables_of(kinds_from(str(data.attrs.get(ATTRIBUTE, ""))))
    except ValueError as error:
        yield f"attribute '{ATTRIBUTE}'", "kinds of predictions in JSON", str(error)
        return
    for name, variable in variables.items():
        if name not in data:
            if variable.required:
                yield f"variable '{name}'", variable.meaning, "nothing"
        elif data[name].dims != variable.dimensions:
            dimensions = ", ".join(variable.dimensions) or "none"
            found = ", ".join(map(str, data[name].dims)) or "none"
            yield f"variable '{name}'", f"dimensions {dimensions}", found
        elif data[name].dtype.kind not in DTYPES[variable.values]:
            yield f"variable '{name}'", f"values of type {variable.values}", str(data[name].dtype)
    if not data.sizes.get("point") or not data.sizes.get("mode"):
        yield "dimensions 'point' and 'mode'", "at least one each", "none"


def _together(data: xr.Dataset) -> Iterator[Wrong]:
    """Yield variables and coordinates without which others cannot be shown."""
    sets: dict[str, list[str]] = {}
    for name, variable in variables_in(data).items():
        if variable.together:
            sets.setdefault(variable.together, []).append(name)
    for names in sets.values():
        present = [name for name in names if name in data]
        missing = [name for name in names if name not in data]
        if present and missing:
            yield f"variable '{missing[0]}'", f"it, as there is '{present[0]}'", "nothing"
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
    for name, size in SIZES.items():
        if data.sizes.get(name, size) != size:
            yield f"dimension '{name}'", f"{size}: {DIMENSIONS[name]}", str(data.sizes[name])
    if data.sizes.get("end", 0) % 2:
        yield "dimension 'end'", "an end and a start for each gap", str(data.sizes["end"])
    for name in ("parameter", "group"):
        size = data.sizes[name]
        if data.sizes.get(f"{name}_other", size) != size:
            found = str(data.sizes[f"{name}_other"])
            yield f"dimension '{name}_other'", f"{size}, as '{name}'", found


def _texts(data: xr.Dataset) -> Iterator[Wrong]:
    for name, variable in data.variables.items():
        if variable.dtype.kind in "OST":
            wrong = [value for value in variable.values.ravel() if not isinstance(value, str)]
            if wrong:
                yield _place(data, name), "texts", repr(wrong[0])
                return
    for name in UNIQUE:
        values = data[name].values.tolist()
        if len(set(values)) < len(values):
            repeated = next(value for value in values if values.count(value) > 1)
            yield _place(data, name), "each value once", f"{clean(repeated, NAME)!r} again"
    kinds, known = data["kind"].values.tolist(), [kind.value for kind in Kind]
    unknown = [str(kind) for kind in kinds if kind not in known]
    if unknown:
        yield "variable 'kind'", f"any of {', '.join(known)}", clean(repr(unknown[0]), NAME)
    for kind in REFERENCES:
        if kinds.count(kind.value) > 1:
            yield "variable 'kind'", f"'{kind.value}' once", "more"


def _numbers(data: xr.Dataset) -> Iterator[Wrong]:
    variables = variables_in(data)
    for name in ("mode", *variables):
        if name not in data or data[name].dtype.kind not in "fiub":
            continue
        values = data[name].values
        kind = variables[name].values if name in variables else "count"
        expected, wrong = "", np.zeros(values.shape, dtype=bool)
        if kind == "truth":
            expected, wrong = "truth values, 0 or 1", ~np.isin(values, (0, 1))
        elif kind == "count":
            wrong = ~((np.abs(values) <= LARGEST) & (values == np.round(values)))
            expected = "whole numbers"
        elif name in FINITE:
            expected, wrong = "finite numbers", ~np.isfinite(values)
        if wrong.any():
            yield _place(data, name), expected, _first(values, wrong)
    for name in ("objective", "error", "minimum_objective"):
        values = data[name].values
        if (values < 0).any():
            yield f"variable '{name}'", "numbers of 0 or more", _first(values, values < 0)
    bounds = data["bounds"].values
    if bounds.shape[1] == 2 and not (bounds[:, 0] < bounds[:, 1]).all():
        yield "variable 'bounds'", "lower bounds below upper ones", str(bounds[0].tolist())
    measured = data["measured_frequency"].values
    if not (np.isnan(measured) | ((measured > 0) & np.isfinite(measured))).all():
        yield "variable 'measured_frequency'", "frequencies above 0", str(measured.min())


def _geometry(data: xr.Dataset) -> Iterator[Wrong]:
    count = data.sizes.get("drawn_node", 0)
    for name, least in (("line_nodes", 0), ("face_nodes", -1), ("sensor_node", 0)):
        if name in data:
            values = data[name].values
            wrong = ~((values >= least) & (values < count))
            if wrong.any():
                expected = f"nodes from {least} to {count - 1}"
                yield f"variable '{name}'", expected, _first(values, wrong)
    if "face_nodes" in data and (data["face_nodes"].values[:, :3] < 0).any():
        yield "variable 'face_nodes'", "three corners at least", "-1 among the first three"


def _of_file(data: xr.Dataset) -> Iterator[Wrong]:
    for name, attribute in ATTRIBUTES.items():
        if name not in data.attrs or attribute.values == "text":
            continue
        value = np.asarray(data.attrs[name])
        if value.ndim or value.dtype.kind not in "fiub":
            yield f"attribute '{name}'", "a number", clean(repr(data.attrs[name]), NAME)
        elif name in COUNTS and not (0 <= value < 2**63 and value == np.round(value)):
            yield f"attribute '{name}'", "a whole number of 0 or more", str(value)
    if "certified" in data and "eigenvalue_tolerance" not in data.attrs:
        yield "attribute 'eigenvalue_tolerance'", "it, as there is 'certified'", "nothing"
    if preferred(data.attrs) not in data["label"].values:
        found = clean(repr(str(data.attrs["reference"])), NAME)
        yield "attribute 'reference'", "the label of a point", found


def _place(data: xr.Dataset, name: object) -> str:
    return f"{'coordinate' if name in data.coords else 'variable'} '{name}'"


def _first(values: np.ndarray, wrong: np.ndarray) -> str:
    return f"{values[wrong].ravel()[0] if values.ndim else values[()]}"
