"""Conditions on the values of results, without which these have no meaning.

`modefront.results.schema` says which variables there are, of which types and dimensions; this is
about values of files that were damaged or made by another program.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import xarray as xr

from modefront.front.point import REFERENCES, Kind, preferred
from modefront.results.schema import ATTRIBUTES, DIMENSIONS, variables_in
from modefront.text import NAME, clean

FINITE = (
    *("theta", "objective", "error", "frequency", "bounds", "properties"),
    *("minimum_theta", "minimum_objective", "lattice", "equal_theta", "equal_objective"),
    *("combination_direction", "combination_share"),
    *("node", "shape_basis", "sensor_direction"),
)
"""Variables of numbers that are known wherever there are any."""

UNIQUE = ("label", "parameter", "group", "mode")
"""Variables and coordinates whose values do not repeat."""

SIZES = {
    "bound": 2,
    "range": 3,
    "statistic": 5,
    "quantile": 3,
    "line_end": 2,
    "corner": 4,
    "axis": 3,
}
"""Sizes of dimensions that are always the same."""

LARGEST = 1e9
"""Greatest count."""

Fault = tuple[str, str, str]


def unsound(data: xr.Dataset) -> Iterator[Fault]:
    """Yield place, expected and found of all values that cannot be those of results.

    Variables, coordinates and attributes have to have the types and dimensions of the schema.
    """
    yield from _sizes(data)
    yield from _texts(data)
    yield from _numbers(data)
    yield from _geometry(data)
    yield from _attributes(data)


def _sizes(data: xr.Dataset) -> Iterator[Fault]:
    for name in ("point", "parameter", "group", "mode"):
        if not data.sizes.get(name):
            yield f"dimension '{name}'", f"at least one: {DIMENSIONS[name]}", "none"
    for name, size in SIZES.items():
        if name in data.sizes and data.sizes[name] != size:
            yield f"dimension '{name}'", f"{size}: {DIMENSIONS[name]}", str(data.sizes[name])
    if data.sizes.get("end", 0) % 2:
        yield "dimension 'end'", "an end and a start for each gap", str(data.sizes["end"])
    for name in ("parameter", "group"):
        other = f"{name}_other"
        if other in data.sizes and data.sizes[other] != data.sizes[name]:
            yield f"dimension '{other}'", f"{data.sizes[name]}, as '{name}'", str(data.sizes[other])


def _texts(data: xr.Dataset) -> Iterator[Fault]:
    for name, variable in data.variables.items():
        if variable.dtype.kind in "OST":
            wrong = [value for value in variable.values.ravel() if not isinstance(value, str)]
            if wrong:
                yield _variable(data, name), "texts", repr(wrong[0])
                return
    for name in UNIQUE:
        values = data[name].values.tolist()
        if len(set(values)) < len(values):
            repeated = next(value for value in values if values.count(value) > 1)
            yield _variable(data, name), "each value once", f"{clean(repeated, NAME)!r} again"
    known = [kind.value for kind in Kind]
    unknown = [str(kind) for kind in data["kind"].values if kind not in known]
    if unknown:
        yield "variable 'kind'", f"any of {', '.join(known)}", clean(repr(unknown[0]), NAME)
    best = [kind.value for kind in REFERENCES]
    for kind in best:
        if (data["kind"].values == kind).sum() > 1:
            yield "variable 'kind'", f"'{kind}' once", "more"


def _numbers(data: xr.Dataset) -> Iterator[Fault]:
    variables = variables_in(data)
    for name in ("mode", *variables):
        if name not in data or data[name].dtype.kind not in "fiub":
            continue
        place, values = _variable(data, name), data[name].values
        kind = variables[name].values if name in variables else "count"
        if kind == "truth" and not np.isin(values, (0, 1)).all():
            yield place, "truth values, 0 or 1", _first(values, ~np.isin(values, (0, 1)))
        elif kind == "count":
            wrong = ~((np.abs(values) <= LARGEST) & (values == np.round(values)))
            if wrong.any():
                yield place, "whole numbers", _first(values, wrong)
        elif name in FINITE and not np.isfinite(values).all():
            yield place, "finite numbers", _first(values, ~np.isfinite(values))
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


def _geometry(data: xr.Dataset) -> Iterator[Fault]:
    """Yield what lines, faces and sensors name that is no node."""
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


def _attributes(data: xr.Dataset) -> Iterator[Fault]:
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
        expected = "the label of a point"
        yield "attribute 'reference'", expected, clean(repr(str(data.attrs["reference"])), NAME)


COUNTS = frozenset(
    (
        *("seed", "front_is_a_point", "model_evaluations", "front_evaluations", "nbi_evaluations"),
        *("full_eigensolutions", "reduced_solutions", "prediction_eigensolutions"),
        *("corrected_eigensolutions", "factorisations", "shape_eigensolutions", "format"),
    )
)
"""Attributes that count something."""


def _variable(data: xr.Dataset, name: object) -> str:
    return f"{'coordinate' if name in data.coords else 'variable'} '{name}'"


def _first(values: np.ndarray, wrong: np.ndarray) -> str:
    """Return the first value that is wrong."""
    return f"{values[wrong].ravel()[0] if values.ndim else values[()]}"
