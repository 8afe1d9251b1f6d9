"""The schema of results: every variable and attribute with dimensions, unit and meaning.

The attributes in ``results.nc``, checks of files and docs/results.md are made from these tables. A
row has a name, with ``*`` where every file has it; dimensions; what it holds, where that is not
numbers, and its unit; and its meaning. Headings name the section of the documentation, and
variables of which a file has all or none.
"""

from __future__ import annotations

import re
from collections.abc import Hashable, Iterable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, get_args

import numpy as np

from modefront.errors import wrong
from modefront.predictions.base import PredictionKind, Values, Variable, kinds_in

if TYPE_CHECKING:
    import xarray as xr

FORMAT = 3
"""Version of the schema: raised when a variable changes its meaning, or a required one is added."""

_DIMENSIONS = """\
point | models, in the order of `label`
parameter | parameters, by name
group | groups, by name
mode | measured modes, counted from 1
bound | `lower`, `upper`
minimum | minima of each group, then of the optimally weighted residuals
end | ends and starts of branches at the gaps of the front, two groups only
place | points of the simplex between the edges
combination | combinations of parameters
equal | equivalent models
replicate | data sets drawn again
finding | findings, the most important first
parameter_other | parameters again
group_other | groups again
range | `minimum`, `maximum`, `spread` over the Pareto-optimal models; the spread is the ratio of
    greatest to least
draw | models drawn from the posterior, for predictions
sample | models drawn from the posterior
candidate | further measurements that could be made
quantile | 0.05, 0.5, 0.95
set | data sets, by name
sensor | sensors, by name
model_mode | modes of the model, from the lowest
drawn_node | nodes that are drawn: those of lines and faces
axis | `x`, `y`, `z`
line | lines of the model: beams, and springs of a chain
line_end | the two ends of a line
face | faces of the model: shells, and the surface of solids
corner | the corners of a face
basis | columns of the common basis of all mode shapes
statistic | `mean`, `standard deviation`, `5 %`, `50 %`, `95 %`
"""

_VARIABLES = """\
# Models
label* | point | text | name of the point
kind* | point | text | why the model is reported: front, edge, given-weights, equal-weights,
    optimal-weights, most-probable, identifiable-part, identifiable-edge or nominal
pareto* | point | truth | no model that is known to the run dominates this one, equation (4)
dominated_among_front* | point | truth | another point of the front dominates this one, whatever
    else is known
theta* | point parameter | | parameter values
objective* | point group | 1 | J_i
error* | point group | 1 | sqrt(J_i / a_i)
weight* | point group | | weights that a weighted method used; NaN elsewhere
stationary_weight* | point group | | weights at which the point is stationary, over the range of
    each objective, sum 1; a negative one tells that the point is no local Pareto optimum
converged* | point | truth | the solver met its tolerances; true for the nominal model, which is
    not solved for
status* | point | text | how the solver ended
evaluations | point | count | evaluations of the last solution that led to the point
frequency* | point mode | Hz | frequency of the model mode paired with the measured mode
mac* | point mode | 1 | MAC of the pair, mean over the data sets
paired_mode* | point mode | count | number of the model mode paired with the measured mode
coincident | point mode | count | 1 where the mode is so close to another one that it is not
    defined alone
at_bound | point parameter | count | -1 at the lower bound, 1 at the upper one, 0 between them
# The front / branches
piece | point | count | branch of the front, from 1; 0 for points that lie in a gap
end_label | end | text | end or start of a branch at a gap
end_theta | end parameter | | parameter values; NaN where the end is not known
end_objective | end group | 1 | J_i; NaN where the end is not known
end_converged | end | truth | the end is known: tolerances were met, and no known model dominates
    it
# The front / lattice
lattice | place group | | points of the simplex between the edges from which the front is
    projected
lattice_label | place | text | label of the point that this place led to, empty for none; places of
    the same model share one
# The front
front_part | point | text | whole: the front between the edges; identifiable: the front without
    flat parts
flat | group | count | points in the flat part at the edge of the group, besides it
# Minima
minimum_of* | minimum | text | group or method of which this is a minimum; iterated-weights is the
    fixed point of w = a / J
minimum_theta* | minimum parameter | | parameter values
minimum_objective* | minimum group | 1 | J_i
minimum_converged | minimum | truth | tolerances were met
# Data and parameters
measured_frequency* | mode | Hz | mean of the measured frequencies over the data sets
properties | group | | count a_i of measured properties
exact* | group | truth | a model fits the group exactly
bounds* | parameter bound | | bounds of the parameters
finding* | finding | text | what is not determined, in words, the most important first
finding_record | finding | text | kind, subject, numbers of each finding and whether it is on
    several subjects, as JSON
# Reduced models / errors of points
eigenvalue_error | point mode | 1 | estimated relative error of the eigenvalue; infinite where a
    mode is missing
shape_error | point mode | 1 | estimated error of the mode shape over its length, in the norm of
    the mass matrix
certified | point | truth | all eigenvalues are within the tolerance
# Reduced models / errors of minima
minimum_eigenvalue_error | minimum mode | 1 | estimated relative error of the eigenvalue; infinite
    where a mode is missing
minimum_shape_error | minimum mode | 1 | estimated error of the mode shape over its length, in the
    norm of the mass matrix
minimum_certified | minimum | truth | all eigenvalues are within the tolerance
# What the data do not determine
combination_at | combination | text | point at which the combination is taken
combination_of | combination | text | group, or all data
combination_direction | combination parameter | | combination of parameters: changes in units of
    combination_unit, length 1
combination_unit | combination parameter | | change of each parameter by which some stiffness or
    mass is lost to first order, or its range, if that is less
combination_sensitivity | combination | | singular value: change of the weighted residuals for a
    unit change along it
combination_share | combination | | that over the greatest one of the same data; 0 where it is
    rounding
collinearity | parameter parameter_other | | cosines between the effects of parameters on all
    weighted residuals at the reference; 0 for parameters without effect
collinearity_index | | | 1 / root of the least eigenvalue of these, of the parameters that have
    an effect; infinite where some effects depend
# What the data do not determine / equivalent models
equal_of | equal | text | group or method that these models fit equally well
equal_manifold | equal | count | number of the connected set to which the model belongs, from 1
equal_dimension | equal | count | dimension of that set; 0 is an isolated model
equal_extent | equal | text | how far the set was followed: isolated, closed, bounded, cut, lost,
    spanned or spent
equal_theta | equal parameter | | parameter values
equal_objective | equal group | 1 | J_i
# Errors of the data / scatter
theta_std | point parameter | | standard deviation of theta by errors of the data, linearised;
    infinite where no data determine it
theta_covariance | point parameter parameter_other | | covariance of theta by errors of the data,
    linearised, without directions that no data determine
objective_std | point group | 1 | standard deviation of J by errors of the data, linearised
objective_covariance | point group group_other | 1 | covariance of J by errors of the data,
    linearised
frequency_std | point mode | Hz | standard deviation of the predicted frequency by errors of the
    data, linearised
mac_std | point mode | 1 | standard deviation of the MAC with the data as they are by errors of the
    data, linearised
scatter_doubt | point | text | why the linearised scatter is approximate: any of saddle, meets,
    leaves, switches, ends, rival, unsolved; empty where nothing says so
# Errors of the data / posterior
posterior_std | parameter | | standard deviation of theta around the reference, with the variance
    of the errors of each group unknown; infinite where no data determine it
posterior_covariance | parameter parameter_other | | covariance of theta likewise, without
    directions that no data determine
posterior_frequency_std | mode | Hz | standard deviation of the predicted frequency likewise
posterior_mac_std | mode | 1 | standard deviation of the MAC likewise
# Errors of the data / samples
interval | parameter quantile | | quantiles of theta by the posterior, of models drawn from it
trust | parameter | text | determined, partly or not determined: width of the 90 % interval of the
    posterior beside that of the prior, below a third, between, above 0.8
sample_theta | sample parameter | | models drawn from the posterior
prior_width | parameter | | width of the 90 % interval of the prior
misfit | group | 1 | root mean square error of the most probable model over the one that is expected
nominal_misfit | group | 1 | that of the nominal model likewise
likely_mode | mode | count | number of the model mode that is most likely to be the measured one, by
    frequencies and shapes together, at the most probable model; by the MAC alone it is
    `paired_mode`
# Errors of the data / further measurements
candidate_frequency | candidate | Hz | of a further model mode, measured at all sensors; 0 for a
    further sensor
candidate_sensor | candidate | text | further sensor, at which all measured modes are; empty for a
    further mode
candidate_gain | candidate parameter | | share by which that measurement makes the standard
    deviation of a parameter less, linearised
# Errors of the data / wider bounds
freed_theta | parameter | | theta of the most probable model where the bounds that hold it are
    widened
freed_misfit | group | 1 | misfit of the most probable model where the bounds that hold it are
    widened
# Errors of the data / a fixed parameter
unfixed_misfit | group | 1 | misfit of the most probable model where `fixed_parameter` is free
# Errors of the data / bootstrap
bootstrap_theta | replicate point parameter | | theta with the data drawn again; NaN where it did
    not converge
bootstrap_objective | replicate point group | 1 | J with the data drawn again; NaN where it did not
    converge
bootstrap_theta_std | point parameter | | standard deviation of theta over the data drawn again
bootstrap_objective_std | point group | 1 | standard deviation of J over the data drawn again
# Predictions
frequency_range | range mode | Hz | of the frequencies over the Pareto-optimal models
draw_theta | draw parameter | | parameters of models drawn from the posterior, within the bounds
# Modes / modes of points
set_frequency | set mode | Hz | measured frequency of each data set; NaN where it was not
    measured
set_frequency_std | set mode | Hz | its standard deviation; NaN where none is given
measured_shape | set mode sensor | | measured mode shape, in the scale of the data; NaN where it
    was not measured
model_frequency | point model_mode | Hz | frequency of the model mode
mac_matrix | point mode model_mode | 1 | MAC of the measured mode with the model mode, mean over
    the data sets
shape | point mode sensor | | shape of the paired model mode at the sensors, with the sign of
    the measured one; its greatest displacement at a node, or at a sensor where there is no
    geometry, is 1
# Modes / geometry
node | drawn_node axis | | coordinates of the nodes
line_nodes | line line_end | count | nodes of each line, counted from 0
face_nodes | face corner | count | nodes round each face, counted from 0; the fourth one of a
    triangle is -1
sensor_node | sensor | count | node of each sensor, counted from 0
sensor_direction | sensor axis | 1 | unit vector that the sensor measures; zero for a rotation
shape_basis | basis drawn_node axis | | displacements of the nodes of which all mode shapes are
    sums, to 0.1 % of their length
shape_coefficient | point mode basis | | how much of each the paired model mode has, in the
    scale of `shape`
"""

_ATTRIBUTES = """\
format* | count | version of this schema
version* | text | version of modefront
study | text | name of the study
inputs | text | hash of the study file and of all files that it names
checksum | text | BLAKE2b hash of all variables and attributes, in hexadecimal digits
assumed | text | which errors of the data are assumed, and how great
settled | number | 1 where the chains that draw from the posterior agree
fixed_parameter | text | fixed parameter that lowers errors beyond chance when it is free
fixed_value | number | its value at the most probable model then
verdict | text | sentences of the first screen, one a line
remark | text | why a requested option is not in use
seed* | count | seed of all random numbers
method* | text | method by which the front was found
reference* | text | label of the model to use, around which the posterior lies; empty where none is
prediction_kinds | text | kinds of the predictions, in JSON
front_is_a_point* | count | 1 where one model is the best in every group
model_evaluations* | count | eigenproblems solved
full_eigensolutions | count | those solved in full
reduced_solutions | count | those solved in a reduced basis
shape_eigensolutions | count | those for mode shapes at all nodes, besides `model_evaluations`
geometry | text | chain or mesh: what the nodes are of
front_evaluations* | count | those for points of the front
prediction_eigensolutions | count | those for predictions, which are always full
corrected_eigensolutions | count | those of a reduced basis without a factor of their own
factorisations | count | factorisations of sparse matrices
eigenvalue_tolerance | number | tolerance of a reduced model
refined | number | distance of neighbours above which points were added
hypervolume* | number | volume dominated by the front, up to 1.1 in each objective, in units of the
    ranges over the edges; NaN where the front is one point
igd_plus* | number | mean distance by which the front is behind all nondominated models of the
    results, in the same units
largest_gap* | number | greatest distance of neighbours on a branch, in the same units
"""


def _rows(table: str) -> list[str]:
    return re.sub(r"\n {4}", " ", table).splitlines()


def _variables(table: str) -> dict[str, Variable]:
    """Return the variables of a table by name; attributes have no column of dimensions."""
    out, section, together = {}, "", ""
    for row in _rows(table):
        if row.startswith("# "):
            section, _, together = row[2:].partition(" / ")
            continue
        name, *dimensions, holds, meaning = (cell.strip() for cell in row.split("|"))
        values: Values = next((x for x in get_args(Values) if x in holds.split()), "number")
        unit, key = holds.replace(values, "").strip(), name.rstrip("*")
        of = tuple(" ".join(dimensions).split())
        out[key] = Variable(key, of, meaning, values, unit, section, key != name, together)
    return out


DIMENSIONS: Mapping[str, str] = dict(row.split(" | ") for row in _rows(_DIMENSIONS))
"""Meanings of the dimensions, by name."""

VARIABLES: Mapping[str, Variable] = _variables(_VARIABLES)
"""Variables by name, without those of predictions."""

ATTRIBUTES: Mapping[str, Variable] = _variables(_ATTRIBUTES)
"""Attributes by name, numbers or texts."""


def variables_of(kinds: Iterable[PredictionKind]) -> dict[str, Variable]:
    """Return all variables by name, with those of kinds of predictions.

    Raises InputError where a kind has a variable or dimension that others have.
    """
    out, dimensions = dict(VARIABLES), list(DIMENSIONS)
    for kind in kinds:
        own = {x.name: replace(x, section="Predictions") for x in kind.schema}
        taken = [("a dimension", x) for x in dimensions if x == kind.dimension]
        taken += [("variables", x) for x in own if x in out]
        for what, name in taken:
            expected = f"{what} that nothing else of the results has"
            raise wrong(f"predictions of the kind '{kind.table}'", expected, f"'{name}'")
        dimensions.append(kind.dimension)
        out |= own
    return out


def variables_in(data: xr.Dataset) -> dict[str, Variable]:
    """Return the variables that sound results may have, by name."""
    return variables_of(kinds_in(data))


EMPTY = {"text": str, "truth": bool, "count": int, "number": float}
"""Types of variables without values."""


def described(
    values: Mapping[str, object],
    kinds: Iterable[PredictionKind] = (),
    sizes: Mapping[Hashable, int] | None = None,
) -> dict[str, tuple[tuple[str, ...], np.ndarray, dict[str, str]]]:
    """Return values as variables of a dataset, with the attributes of the schema.

    Variables of predictions are those of their ``kinds``; of an empty list ``sizes`` gives the
    sizes of its dimensions, 0 unless given. Raises KeyError for a variable that the schema
    does not know.
    """
    out, known = {}, variables_of(kinds)
    for name, value in values.items():
        variable = known[name]
        array = np.asarray(value, dtype=str if variable.values == "text" else None)
        if isinstance(value, list) and not value:
            shape = [(sizes or {}).get(x, 0) for x in variable.dimensions]
            array = np.zeros(shape, EMPTY[variable.values])
        out[name] = (variable.dimensions, array, variable.attributes)
    return out
