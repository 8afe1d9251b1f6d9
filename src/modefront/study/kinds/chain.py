"""``kind = "chain"``: lumped masses and springs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any

from modefront.errors import suggestion
from modefront.models.base import Model
from modefront.models.chain import chain
from modefront.options import (
    ABOVE_ZERO,
    NOT_NEGATIVE,
    Checked,
    Requirement,
    Table,
    array,
    entries,
    numbers,
    table_of,
)
from modefront.study.kinds.sensors import WEIGHTED, ModelKind, read_places

MASSES = numbers("a list of masses above 0", array(ABOVE_ZERO, 1))
STIFFNESSES = numbers(
    "a list of spring stiffnesses of 0 or more, as many as masses, or one more for a spring from "
    "the top to the ground",
    array(NOT_NEGATIVE, 1),
)
ADDED = numbers("a list of masses of 0 or more, as many as masses", array(NOT_NEGATIVE))
_NAMES = array({"type": "string"})
OF_SPRINGS = Requirement(
    "a list of names of parameters, as many as springs, '' where none scales", _NAMES, tuple
)
OF_MASSES = Requirement(
    "a list of names of parameters, as many as masses, '' where none scales", _NAMES, tuple
)
PLACES = entries("a table, name = degree of freedom", table_of(WEIGHTED))


@dataclass(frozen=True)
class Chain(Checked):
    """Lumped masses joined by springs, the first one to the ground; SI or any consistent units.

    Attributes
    ----------
    masses : from the ground up
    stiffnesses : of the springs: ground to mass 1, mass 1 to mass 2, ...; one more joins the last
        mass to the ground
    added_masses : masses that are added to these and never scaled; None for none
    stiffness_parameters : for each spring the parameter that scales it; None for none
    mass_parameters : likewise for each mass; None for none
    sensors : degrees of freedom, counted from 0, or weights of them, `[[dof, weight], ...]`; None
        for every mass, `floor1`, `floor2`, ...
    outputs : likewise, places besides the sensors for predictions; None for none
    """

    masses: Annotated[Sequence[float], MASSES]
    stiffnesses: Annotated[Sequence[float], STIFFNESSES]
    added_masses: Annotated[Sequence[float], ADDED] | None = None
    stiffness_parameters: Annotated[Sequence[str], OF_SPRINGS] | None = None
    mass_parameters: Annotated[Sequence[str], OF_MASSES] | None = None
    sensors: Annotated[Mapping[str, Any], PLACES] | None = None
    outputs: Annotated[Mapping[str, Any], PLACES] | None = None


def read_chain(table: Table, parameters: Sequence[str]) -> Model | None:
    """Return the chain that a ``[model]`` table describes, or None where it has faults."""
    before = len(table.faults)
    read, masses = table.record(Chain), table.values.get("masses")
    n = len(masses) if isinstance(masses, list) and MASSES.holds(masses) else None
    members: dict[str, Any] = {}
    for key in ("stiffness_parameters", "mass_parameters"):
        names = (getattr(read, key) if read else None) or ()
        for name in names:
            if name and name not in parameters:
                table.fault(key, "names of parameters", suggestion(name, parameters))
        members[key] = [name or None for name in names] or None
    sensors = read_places(table, "sensors", n)
    floors = sensors or [f"floor{i + 1}" for i in range(n or 0)]
    outputs = read_places(table, "outputs", n, taken=floors)
    if read is not None and len(table.faults) == before:
        members |= {"added_masses": read.added_masses, "sensors": sensors, "outputs": outputs}
        with table.noting():
            return chain(parameters, read.masses, read.stiffnesses, **members)
    return None


CHAIN = ModelKind("chain", read_chain, is_reducible=False, table=Chain)
