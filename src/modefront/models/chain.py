r"""Chains of lumped masses and springs, such as shear buildings.

Spring i joins mass i-1 and mass i; the first one joins the ground and mass 1. A spring more than
there are masses joins the last mass and the ground. Each spring and each mass may be scaled by a
parameter, :math:`k_i = \theta_j k_{0i}`.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Annotated

import numpy as np
from scipy.sparse import dia_array, diags_array

from modefront import options
from modefront._typing import Floats
from modefront.errors import Fault, refuse, suggestion, wrong
from modefront.models.geometry import chain_geometry
from modefront.models.matrices import WEIGHTED, MatrixModel, SensorSpec, matrices
from modefront.models.parameters import BASE

MASSES = options.numbers("a list of masses above 0", options.array(options.ABOVE_ZERO, 1))
STIFFNESSES = options.numbers(
    "a list of spring stiffnesses of 0 or more, as many as masses, or one more for a spring from "
    "the top to the ground",
    options.array(options.NOT_NEGATIVE, 1),
)
ADDED = options.numbers(
    "a list of masses of 0 or more, as many as masses", options.array(options.NOT_NEGATIVE)
)
_NAMES = options.array({"type": "string"})
OF_SPRINGS = options.Requirement(
    "a list of names of parameters, as many as springs, '' where none scales", _NAMES, tuple
)
OF_MASSES = options.Requirement(
    "a list of names of parameters, as many as masses, '' where none scales", _NAMES, tuple
)
PLACES = options.entries("a table, name = degree of freedom", options.table_of(WEIGHTED))

Numbers = Sequence[float] | Floats
Names = Sequence[str | None]
Places = Mapping[str, SensorSpec]


# 8 arguments: the members of a chain and their parameters, by keyword.
def chain(
    parameters: Sequence[str],
    masses: Annotated[Numbers, MASSES],
    stiffnesses: Annotated[Numbers, STIFFNESSES],
    *,
    added_masses: Annotated[Numbers, ADDED] | None = None,
    stiffness_parameters: Annotated[Names, OF_SPRINGS] | None = None,
    mass_parameters: Annotated[Names, OF_MASSES] | None = None,
    sensors: Annotated[Places, PLACES] | None = None,
    outputs: Annotated[Places, PLACES] | None = None,
) -> MatrixModel:
    """Return a chain of masses and springs, such as a shear building.

    The ground can move along the chain, ``"x"``.

    Parameters
    ----------
    parameters
        Names of the parameters, in the order of theta.
    masses
        N masses from the ground up, kg or in another consistent unit.
    stiffnesses
        N or N + 1 springs, N/m: from the ground to mass 1, from mass 1 to mass 2 and so on; one
        more joins the last mass to the ground.
    added_masses
        N masses that are attached to the others and that no parameter scales; None for none.
    stiffness_parameters, mass_parameters
        The parameter that scales each spring, or mass, ``""`` or None for one that is fixed; None
        for none.
    sensors
        For the name of each sensor, in the order of the measured shapes, a mass counted from 0, or
        pairs (mass, weight) that are summed; None for every mass, ``floor1``, ``floor2`` and so on.
    outputs
        Places besides the sensors that predictions may name, in the form of ``sensors``; None for
        none.

    Raises
    ------
    InputError
        For lists of different lengths, parameters without a name in ``parameters``, and sensors
        that there are not.
    """
    n = len(masses)
    stiffness_scales = stiffness_parameters or [None] * len(stiffnesses)
    mass_scales = mass_parameters or [None] * n
    added = [0.0] * n if added_masses is None else added_masses
    if not n:
        raise wrong("masses", "at least one", "none")
    refuse(
        Fault("", place, expected, str(len(values)))
        for place, expected, values, lengths in (
            ("stiffnesses", f"{n} or {n + 1}, as there are {n} masses", stiffnesses, (n, n + 1)),
            ("stiffness_parameters", "one a spring", stiffness_scales, (len(stiffnesses),)),
            ("mass_parameters", "one a mass", mass_scales, (n,)),
            ("added_masses", "one a mass", added, (n,)),
        )
        if len(values) not in lengths
    )
    scales = {"stiffness_parameters": stiffness_scales, "mass_parameters": mass_scales}
    refuse(
        Fault("", place, "names of parameters", suggestion(name, parameters))
        for place, names in scales.items()
        for name in names
        if name and name not in parameters
    )
    K = {name: _springs(k, n) for name, k in _shares(stiffnesses, stiffness_scales).items()}
    of_masses = _shares(masses, mass_scales)
    of_masses[BASE] = np.asarray(added, dtype=float) + of_masses[BASE]
    M = {name: diags_array(m) for name, m in of_masses.items()}
    if sensors is None:
        sensors = {f"floor{i + 1}": i for i in range(n)}
    base = {"x": [(i, 1.0) for i in range(n)]}
    model = matrices(parameters, K, M, sensors, outputs=outputs, base=base)
    return replace(model, geometry=chain_geometry(n, model.selection))


def _shares(values: Numbers, scales: Names) -> dict[str, Floats]:
    """Return the values by the names of their scales, each with zeros in place of the others."""
    names = np.array([name or BASE for name in scales])
    every = dict.fromkeys([BASE, *names.tolist()])
    return {name: np.where(names == name, values, 0.0) for name in every}


def _springs(k: Floats, n: int) -> dia_array:
    """Return the stiffness matrix of n masses, of n or n + 1 springs."""
    below, above = k[:n], np.append(k, 0.0)[1 : n + 1]
    return dia_array((np.array([below + above, -above, -below]), (0, -1, 1)), shape=(n, n))
