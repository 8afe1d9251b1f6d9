"""The schema of results: every variable and attribute with dimensions, unit and meaning.

`VARIABLES` and `ATTRIBUTES` are the one place where results are described. The attributes of the
variables in ``results.nc``, the checks when a file is read and the tables of ``docs/results.md``
are made from them. Kinds of predictions describe their own variables (`modefront.predictions`), and
results hold these descriptions.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from modefront._typing import Ints
from modefront.errors import Fault, InputError
from modefront.optim.problem import at_bounds
from modefront.predictions.base import PredictionKind
from modefront.predictions.registry import ATTRIBUTE, kinds_from, kinds_in
from modefront.variables import Values, Variable

if TYPE_CHECKING:
    import xarray as xr

FORMAT = 3
"""Version of the schema: raised when a variable changes its meaning, or a required one is added."""

DTYPES: Mapping[Values, str] = {"number": "fiu", "count": "iuf", "truth": "biu", "text": "UOST"}
"""Kinds of NumPy types that each of these may have in a file."""


@dataclass(frozen=True)
class Attribute:
    """An attribute of the results."""

    name: str
    meaning: str
    values: Literal["number", "text"] = "number"
    required: bool = False
    since: int = 1


MODELS = "Models"
FRONTS = "The front"
MINIMA = "Minima"
DATA = "Data and parameters"
REDUCED = "Reduced models"
OPEN = "What the data do not determine"
ERRORS = "Errors of the data"
PREDICTIONS = "Predictions"
SHAPES = "Modes"

DIMENSIONS: Mapping[str, str] = {
    "point": "models, in the order of `label`",
    "parameter": "parameters, by name",
    "group": "groups, by name",
    "mode": "measured modes, counted from 1",
    "bound": "`lower`, `upper`",
    "minimum": "minima of each group, then of the optimally weighted residuals",
    "end": "ends and starts of branches at the gaps of the front, two groups only",
    "place": "points of the simplex between the edges",
    "combination": "combinations of parameters",
    "equal": "equivalent models",
    "replicate": "data sets drawn again",
    "finding": "findings, the most important first",
    "parameter_other": "parameters again",
    "group_other": "groups again",
    "range": "`minimum`, `maximum`, `spread` over the Pareto-optimal models; the spread is the "
    "ratio of greatest to least",
    "draw": "models drawn from the posterior, for predictions",
    "sample": "models drawn from the posterior",
    "candidate": "further measurements that could be made",
    "quantile": "0.05, 0.5, 0.95",
    "set": "data sets, by name",
    "sensor": "sensors, by name",
    "model_mode": "modes of the model, from the lowest",
    "drawn_node": "nodes that are drawn: those of lines and faces",
    "axis": "`x`, `y`, `z`",
    "line": "lines of the model: beams, and springs of a chain",
    "line_end": "the two ends of a line",
    "face": "faces of the model: shells, and the surface of solids",
    "corner": "the corners of a face",
    "basis": "columns of the common basis of all mode shapes",
    "statistic": "`mean`, `standard deviation`, `5 %`, `50 %`, `95 %`",
}
"""Dimensions of the variables."""


def _at_bound(values: Mapping[str, Any]) -> Ints:
    return at_bounds(values["theta"], *np.asarray(values["bounds"]).T)


# 87 lines: a table, one entry a variable.
def _models() -> Iterator[Variable]:
    yield Variable("label", ("point",), "name of the point", "text", required=True)
    yield Variable(
        "kind",
        ("point",),
        "why the model is reported: front, edge, given-weights, equal-weights, optimal-weights, "
        "most-probable, identifiable-part, identifiable-edge or nominal",
        "text",
        required=True,
        since=2,
    )
    yield Variable(
        "pareto",
        ("point",),
        "no model that is known to the run dominates this one, equation (4)",
        "truth",
        required=True,
    )
    yield Variable(
        "dominated_among_front",
        ("point",),
        "another point of the front dominates this one, whatever else is known",
        "truth",
        required=True,
    )
    yield Variable("theta", ("point", "parameter"), "parameter values", required=True)
    yield Variable("objective", ("point", "group"), "J_i", unit="1", required=True)
    yield Variable(
        "error",
        ("point", "group"),
        "sqrt(J_i / a_i)",
        unit="1",
        required=True,
        value=lambda values: np.sqrt(values["objective"] / values["properties"]),
    )
    yield Variable(
        "weight",
        ("point", "group"),
        "weights that a weighted method used; NaN elsewhere",
        required=True,
    )
    yield Variable(
        "stationary_weight",
        ("point", "group"),
        "weights at which the point is stationary, over the range of each objective, sum 1; a "
        "negative one tells that the point is no local Pareto optimum",
        required=True,
    )
    yield Variable(
        "converged",
        ("point",),
        "the solver met its tolerances; true for the nominal model, which is not solved for",
        "truth",
        required=True,
    )
    yield Variable("status", ("point",), "how the solver ended", "text", required=True)
    yield Variable(
        "evaluations", ("point",), "evaluations of the last solution that led to the point", "count"
    )
    mode = ("point", "mode")
    yield Variable(
        "frequency",
        mode,
        "frequency of the model mode paired with the measured mode",
        unit="Hz",
        required=True,
    )
    yield Variable("mac", mode, "MAC of the pair, mean over the data sets", unit="1", required=True)
    yield Variable(
        "paired_mode",
        mode,
        "number of the model mode paired with the measured mode",
        "count",
        required=True,
    )
    yield Variable(
        "coincident",
        mode,
        "1 where the mode is so close to another one that it is not defined alone",
        "count",
    )
    yield Variable(
        "at_bound",
        ("point", "parameter"),
        "-1 at the lower bound, 1 at the upper one, 0 between them",
        "count",
        value=_at_bound,
    )


def _fronts() -> Iterator[Variable]:
    yield Variable(
        "piece", ("point",), "branch of the front, from 1; 0 for points that lie in a gap", "count"
    )
    yield Variable("end_label", ("end",), "end or start of a branch at a gap", "text")
    yield Variable(
        "end_theta", ("end", "parameter"), "parameter values; NaN where the end is not known"
    )
    yield Variable(
        "end_objective", ("end", "group"), "J_i; NaN where the end is not known", unit="1"
    )
    yield Variable(
        "end_converged",
        ("end",),
        "the end is known: tolerances were met, and no known model dominates it",
        "truth",
    )
    yield Variable(
        "lattice",
        ("place", "group"),
        "points of the simplex between the edges from which the front is projected",
    )
    yield Variable(
        "lattice_label",
        ("place",),
        "label of the point that this place led to, empty for none; places of the same model share "
        "one",
        "text",
    )
    yield Variable(
        "front_part",
        ("point",),
        "whole: the front between the edges; identifiable: the front without flat parts",
        "text",
    )
    yield Variable(
        "flat", ("group",), "points in the flat part at the edge of the group, besides it", "count"
    )


def _minima() -> Iterator[Variable]:
    yield Variable(
        "minimum_of",
        ("minimum",),
        "group or method of which this is a minimum; iterated-weights is the fixed point of "
        "w = a / J",
        "text",
        required=True,
    )
    yield Variable("minimum_theta", ("minimum", "parameter"), "parameter values", required=True)
    yield Variable("minimum_objective", ("minimum", "group"), "J_i", unit="1", required=True)
    yield Variable("minimum_converged", ("minimum",), "tolerances were met", "truth")


def _data() -> Iterator[Variable]:
    yield Variable(
        "measured_frequency",
        ("mode",),
        "mean of the measured frequencies over the data sets",
        unit="Hz",
        required=True,
    )
    yield Variable("properties", ("group",), "count a_i of measured properties")
    yield Variable("exact", ("group",), "a model fits the group exactly", "truth", required=True)
    yield Variable("bounds", ("parameter", "bound"), "bounds of the parameters", required=True)
    yield Variable(
        "finding",
        ("finding",),
        "what is not determined, in words, the most important first",
        "text",
        required=True,
    )
    yield Variable(
        "finding_record",
        ("finding",),
        "kind, subject, numbers of each finding and whether it is on several subjects, as JSON",
        "text",
    )


def _reduced() -> Iterator[Variable]:
    for dimension, prefix in (("point", ""), ("minimum", "minimum_")):
        yield Variable(
            f"{prefix}eigenvalue_error",
            (dimension, "mode"),
            "estimated relative error of the eigenvalue; infinite where a mode is missing",
            unit="1",
        )
        yield Variable(
            f"{prefix}shape_error",
            (dimension, "mode"),
            "estimated error of the mode shape over its length, in the norm of the mass matrix",
            unit="1",
        )
        yield Variable(
            f"{prefix}certified",
            (dimension,),
            "all eigenvalues are within the tolerance",
            "truth",
        )


def _open() -> Iterator[Variable]:
    combination = ("combination", "parameter")
    yield Variable(
        "combination_at", ("combination",), "point at which the combination is taken", "text"
    )
    yield Variable("combination_of", ("combination",), "group, or all data", "text")
    yield Variable(
        "combination_direction",
        combination,
        "combination of parameters: changes in units of combination_unit, length 1",
    )
    yield Variable(
        "combination_unit",
        combination,
        "change of each parameter by which some stiffness or mass is lost to first order, or its "
        "range, if that is less",
    )
    yield Variable(
        "combination_sensitivity",
        ("combination",),
        "singular value: change of the weighted residuals for a unit change along it",
    )
    yield Variable(
        "combination_share",
        ("combination",),
        "that over the greatest one of the same data; 0 where it is rounding",
    )
    yield Variable(
        "collinearity",
        ("parameter", "parameter_other"),
        "cosines between the effects of parameters on all weighted residuals at the reference; 0 "
        "for parameters without effect",
    )
    yield Variable(
        "collinearity_index",
        (),
        "1 / root of the least eigenvalue of these, of the parameters that have an effect; "
        "infinite where some effects depend",
    )
    yield Variable(
        "equal_of", ("equal",), "group or method that these models fit equally well", "text"
    )
    yield Variable(
        "equal_manifold",
        ("equal",),
        "number of the connected set to which the model belongs, from 1",
        "count",
    )
    yield Variable(
        "equal_dimension", ("equal",), "dimension of that set; 0 is an isolated model", "count"
    )
    yield Variable(
        "equal_extent",
        ("equal",),
        "how far the set was followed: isolated, closed, bounded, cut, lost, spanned or spent",
        "text",
    )
    yield Variable("equal_theta", ("equal", "parameter"), "parameter values")
    yield Variable("equal_objective", ("equal", "group"), "J_i", unit="1")


# 84 lines: a table, one entry a variable.
def _errors() -> Iterator[Variable]:
    by = "by errors of the data, linearised"
    yield Variable(
        "theta_std",
        ("point", "parameter"),
        f"standard deviation of theta {by}; infinite where no data determine it",
    )
    yield Variable(
        "theta_covariance",
        ("point", "parameter", "parameter_other"),
        f"covariance of theta {by}, without directions that no data determine",
    )
    yield Variable("objective_std", ("point", "group"), f"standard deviation of J {by}", unit="1")
    yield Variable(
        "objective_covariance", ("point", "group", "group_other"), f"covariance of J {by}", unit="1"
    )
    yield Variable(
        "frequency_std",
        ("point", "mode"),
        f"standard deviation of the predicted frequency {by}",
        unit="Hz",
    )
    yield Variable(
        "mac_std",
        ("point", "mode"),
        f"standard deviation of the MAC with the data as they are {by}",
        unit="1",
    )
    yield Variable(
        "scatter_doubt",
        ("point",),
        "why the linearised scatter is approximate: any of saddle, meets, leaves, switches, "
        "ends, rival, unsolved; empty where nothing says so",
        "text",
    )
    yield Variable(
        "posterior_std",
        ("parameter",),
        "standard deviation of theta around the reference, with the variance of the errors of each "
        "group unknown; infinite where no data determine it",
    )
    yield Variable(
        "posterior_covariance",
        ("parameter", "parameter_other"),
        "covariance of theta likewise, without directions that no data determine",
    )
    yield Variable(
        "posterior_frequency_std",
        ("mode",),
        "standard deviation of the predicted frequency likewise",
        unit="Hz",
    )
    yield Variable(
        "posterior_mac_std", ("mode",), "standard deviation of the MAC likewise", unit="1"
    )
    yield Variable(
        "interval",
        ("parameter", "quantile"),
        "quantiles of theta by the posterior, of models drawn from it",
    )
    yield Variable(
        "trust",
        ("parameter",),
        "determined, partly or not determined: width of the 90 % interval of the posterior beside "
        "that of the prior, below a third, between, above 0.8",
        "text",
    )
    yield Variable("sample_theta", ("sample", "parameter"), "models drawn from the posterior")
    yield Variable("nominal_misfit", ("group",), "that of the nominal model likewise", unit="1")
    yield Variable("prior_width", ("parameter",), "width of the 90 % interval of the prior")
    yield Variable(
        "likely_mode",
        ("mode",),
        "number of the model mode that is most likely to be the measured one, by frequencies and "
        "shapes together, at the most probable model; by the MAC alone it is `paired_mode`",
        "count",
    )
    yield Variable(
        "candidate_frequency",
        ("candidate",),
        "of a further model mode, measured at all sensors; 0 for a further sensor",
        unit="Hz",
    )
    yield Variable(
        "candidate_sensor",
        ("candidate",),
        "further sensor, at which all measured modes are; empty for a further mode",
        "text",
    )
    yield Variable(
        "candidate_gain",
        ("candidate", "parameter"),
        "share by which that measurement makes the standard deviation of a parameter less, "
        "linearised",
    )
    yield Variable(
        "misfit",
        ("group",),
        "root mean square error of the reference over the one that is expected",
        unit="1",
    )
    freed = "the most probable model where the bounds that hold it are widened"
    yield Variable("freed_theta", ("parameter",), f"theta of {freed}")
    yield Variable("freed_misfit", ("group",), f"misfit of {freed}", unit="1")
    again = "with the data drawn again; NaN where it did not converge"
    over = "over the data drawn again"
    yield Variable("bootstrap_theta", ("replicate", "point", "parameter"), f"theta {again}")
    yield Variable("bootstrap_objective", ("replicate", "point", "group"), f"J {again}", unit="1")
    yield Variable(
        "bootstrap_theta_std", ("point", "parameter"), f"standard deviation of theta {over}"
    )
    yield Variable(
        "bootstrap_objective_std", ("point", "group"), f"standard deviation of J {over}", unit="1"
    )


# 75 lines: a table, one entry a variable.
def _shapes() -> Iterator[Variable]:
    yield Variable(
        "set_frequency",
        ("set", "mode"),
        "measured frequency of each data set; NaN where it was not measured",
        unit="Hz",
        since=2,
    )
    yield Variable(
        "set_frequency_std",
        ("set", "mode"),
        "its standard deviation; NaN where none is given",
        unit="Hz",
        since=2,
    )
    yield Variable(
        "measured_shape",
        ("set", "mode", "sensor"),
        "measured mode shape, in the scale of the data; NaN where it was not measured",
        since=2,
    )
    yield Variable(
        "model_frequency",
        ("point", "model_mode"),
        "frequency of the model mode",
        unit="Hz",
        since=2,
    )
    yield Variable(
        "mac_matrix",
        ("point", "mode", "model_mode"),
        "MAC of the measured mode with the model mode, mean over the data sets",
        unit="1",
        since=2,
    )
    yield Variable(
        "shape",
        ("point", "mode", "sensor"),
        "shape of the paired model mode at the sensors, with the sign of the measured one; its "
        "greatest displacement at a node, or at a sensor where there is no geometry, is 1",
        since=2,
    )
    yield Variable("node", ("drawn_node", "axis"), "coordinates of the nodes", since=2)
    yield Variable(
        "line_nodes", ("line", "line_end"), "nodes of each line, counted from 0", "count", since=2
    )
    yield Variable(
        "face_nodes",
        ("face", "corner"),
        "nodes round each face, counted from 0; the fourth one of a triangle is -1",
        "count",
        since=2,
    )
    yield Variable(
        "sensor_node", ("sensor",), "node of each sensor, counted from 0", "count", since=2
    )
    yield Variable(
        "sensor_direction",
        ("sensor", "axis"),
        "unit vector that the sensor measures; zero for a rotation",
        unit="1",
        since=2,
    )
    yield Variable(
        "shape_basis",
        ("basis", "drawn_node", "axis"),
        "displacements of the nodes of which all mode shapes are sums, to 0.1 % of their length",
        since=2,
    )
    yield Variable(
        "shape_coefficient",
        ("point", "mode", "basis"),
        "how much of each the paired model mode has, in the scale of `shape`",
        since=2,
    )


def _in(section: str, variables: Iterable[Variable]) -> Iterator[Variable]:
    for variable in variables:
        together = _SET_OF.get(variable.name, variable.together)
        yield replace(variable, section=section, together=together)


def _predictions() -> Iterator[Variable]:
    yield Variable(
        "frequency_range",
        ("range", "mode"),
        "of the frequencies over the Pareto-optimal models",
        unit="Hz",
    )
    yield Variable(
        "draw_theta",
        ("draw", "parameter"),
        "parameters of models drawn from the posterior, within the bounds",
    )


TOGETHER: Mapping[str, tuple[str, ...]] = {
    "branches": ("piece", "end_label", "end_theta", "end_objective", "end_converged"),
    "lattice": ("lattice", "lattice_label"),
    "errors of points": ("eigenvalue_error", "shape_error", "certified"),
    "errors of minima": (
        "minimum_eigenvalue_error",
        "minimum_shape_error",
        "minimum_certified",
    ),
    "scatter": (
        "theta_std",
        "theta_covariance",
        "objective_std",
        "objective_covariance",
        "frequency_std",
        "mac_std",
        "scatter_doubt",
    ),
    "posterior": (
        "posterior_std",
        "posterior_covariance",
        "posterior_frequency_std",
        "posterior_mac_std",
    ),
    "samples": (
        "interval",
        "trust",
        "sample_theta",
        "prior_width",
        "misfit",
        "nominal_misfit",
        "likely_mode",
    ),
    "further measurements": ("candidate_frequency", "candidate_sensor", "candidate_gain"),
    "wider bounds": ("freed_theta", "freed_misfit"),
    "modes of points": (
        "set_frequency",
        "set_frequency_std",
        "measured_shape",
        "model_frequency",
        "mac_matrix",
        "shape",
    ),
    "geometry": (
        "node",
        "line_nodes",
        "face_nodes",
        "sensor_node",
        "sensor_direction",
        "shape_basis",
        "shape_coefficient",
    ),
    "equivalent models": (
        "equal_of",
        "equal_manifold",
        "equal_dimension",
        "equal_extent",
        "equal_theta",
        "equal_objective",
    ),
    "bootstrap": (
        "bootstrap_theta",
        "bootstrap_objective",
        "bootstrap_theta_std",
        "bootstrap_objective_std",
    ),
}
"""Variables of which a file has all or none, beside those of predictions."""

_SET_OF = {name: together for together, names in TOGETHER.items() for name in names}

VARIABLES: Mapping[str, Variable] = {
    variable.name: variable
    for section, variables in (
        (MODELS, _models()),
        (FRONTS, _fronts()),
        (MINIMA, _minima()),
        (DATA, _data()),
        (REDUCED, _reduced()),
        (OPEN, _open()),
        (ERRORS, _errors()),
        (PREDICTIONS, _predictions()),
        (SHAPES, _shapes()),
    )
    for variable in _in(section, variables)
}
"""Variables by name, without those of predictions."""

ATTRIBUTES: Mapping[str, Attribute] = {
    attribute.name: attribute
    for attribute in (
        Attribute("format", "version of this schema", required=True, since=2),
        Attribute("version", "version of modefront", "text", required=True),
        Attribute("study", "name of the study", "text"),
        Attribute("inputs", "hash of the study file and of all files that it names", "text"),
        Attribute(
            "checksum",
            "BLAKE2b hash of all variables and attributes, in hexadecimal digits",
            "text",
            since=2,
        ),
        Attribute("assumed", "which errors of the data are assumed, and how great", "text"),
        Attribute("verdict", "sentences of the first screen, one a line", "text"),
        Attribute("remark", "why a requested option is not in use", "text"),
        Attribute("seed", "seed of all random numbers", required=True),
        Attribute("method", "method by which the front was found", "text", required=True),
        Attribute(
            "reference",
            "label of the model to use, around which the posterior lies; empty where none is",
            "text",
            required=True,
        ),
        Attribute(ATTRIBUTE, "kinds of the predictions, in JSON", "text", since=3),
        Attribute(
            "front_is_a_point", "1 where one model is the best in every group", required=True
        ),
        Attribute("model_evaluations", "eigenproblems solved", required=True),
        Attribute("full_eigensolutions", "those solved in full"),
        Attribute("reduced_solutions", "those solved in a reduced basis"),
        Attribute(
            "shape_eigensolutions",
            "those for mode shapes at all nodes, besides `model_evaluations`",
            since=2,
        ),
        Attribute("geometry", "chain or mesh: what the nodes are of", "text", since=2),
        Attribute("front_evaluations", "those for points of the front", required=True),
        Attribute("nbi_evaluations", "likewise; 0 for other methods"),
        Attribute("prediction_eigensolutions", "those for predictions, which are always full"),
        Attribute(
            "corrected_eigensolutions", "those of a reduced basis without a factor of their own"
        ),
        Attribute("factorisations", "factorisations of sparse matrices"),
        Attribute("eigenvalue_tolerance", "tolerance of a reduced model"),
        Attribute("refined", "distance of neighbours above which points were added"),
        Attribute(
            "hypervolume",
            "volume dominated by the front, up to 1.1 in each objective, in units of the ranges "
            "over the edges; NaN where the front is one point",
            required=True,
        ),
        Attribute(
            "igd_plus",
            "mean distance by which the front is behind all nondominated models of the results, in "
            "the same units",
            required=True,
        ),
        Attribute(
            "largest_gap",
            "greatest distance of neighbours on a branch, in the same units",
            required=True,
        ),
    )
}
"""Attributes by name."""


def derived(values: Mapping[str, Any]) -> dict[str, object]:
    """Return the values of the variables that follow from others."""
    return {x.name: x.value(values) for x in VARIABLES.values() if x.value is not None}


def variables_of(kinds: Iterable[PredictionKind]) -> dict[str, Variable]:
    """Return all variables by name, with those of kinds of predictions.

    Raises InputError where a kind has a variable or dimension that others have.
    """
    out, dimensions = dict(VARIABLES), set(DIMENSIONS)
    for kind in kinds:
        place = f"predictions of the kind '{kind.table}'"
        if kind.dimension in dimensions:
            expected = "a dimension that nothing else of the results has"
            raise InputError(Fault("", place, expected, f"'{kind.dimension}'"))
        dimensions.add(kind.dimension)
        for variable in _in(PREDICTIONS, kind.schema):
            if variable.name in out:
                expected = "variables that nothing else of the results has"
                raise InputError(Fault("", place, expected, f"'{variable.name}'"))
            out[variable.name] = variable
    return out


def variables_in(data: xr.Dataset) -> dict[str, Variable]:
    """Return the variables that sound results may have, by name."""
    return variables_of(kinds_in(data))


def described(
    values: Mapping[str, object], kinds: Iterable[PredictionKind] = ()
) -> dict[str, tuple[tuple[str, ...], np.ndarray, dict[str, str]]]:
    """Return values as variables of a dataset, with the attributes of the schema.

    Variables of predictions are those of their ``kinds``. Raises KeyError for a variable that the
    schema does not know.
    """
    out, known = {}, variables_of(kinds)
    for name, value in values.items():
        variable = known[name]
        kind = str if variable.values == "text" else None
        out[name] = (variable.dimensions, np.asarray(value, dtype=kind), variable.attributes)
    return out


def faults(data: xr.Dataset) -> Iterator[tuple[str, str, str]]:
    """Yield place, expected and found of all that is wrong with a dataset."""
    for name, attribute in ATTRIBUTES.items():
        if name not in data.attrs:
            if attribute.required:
                yield f"attribute '{name}'", attribute.meaning, "nothing"
        elif isinstance(data.attrs[name], str) != (attribute.values == "text"):
            yield f"attribute '{name}'", f"a {attribute.values}", f"{data.attrs[name]!r}"
    for name, kinds in (("parameter", "UOST"), ("group", "UOST"), ("mode", "fiu")):
        if name not in data.coords:
            yield f"coordinate '{name}'", DIMENSIONS[name], "nothing"
            continue
        names = data[name]
        if names.dims != (name,) or names.dtype.kind not in kinds:
            found = f"{names.dtype} of the dimensions {', '.join(map(str, names.dims))}"
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
            continue
        array = data[name]
        if array.dims != variable.dimensions:
            dimensions = ", ".join(variable.dimensions) or "none"
            found = ", ".join(map(str, array.dims)) or "none"
            yield f"variable '{name}'", f"dimensions {dimensions}", found
        elif array.dtype.kind not in DTYPES[variable.values]:
            yield f"variable '{name}'", f"values of type {variable.values}", str(array.dtype)
    if not data.sizes.get("point") or not data.sizes.get("mode"):
        yield "dimensions 'point' and 'mode'", "at least one each", "none"


def missing(data: xr.Dataset) -> Iterator[tuple[str, str, str]]:
    """Yield variables and coordinates without which others of a dataset cannot be shown."""
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
    if any(name in data.dims for name in kinds):
        for name in ("range", "frequency_range"):
            if name not in data:
                yield f"variable '{name}'", "it, as there are predictions", "nothing"
