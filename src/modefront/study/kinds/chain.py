"""``kind = "chain"``: lumped masses and springs."""

from __future__ import annotations

from collections.abc import Sequence

from modefront.errors import suggestion
from modefront.models.base import Model
from modefront.models.chain import chain
from modefront.study.kinds.sensors import ModelKind, read_outputs, read_sensors
from modefront.toml import Table


def read_chain(table: Table, parameters: Sequence[str]) -> Model | None:
    """Return the chain that a ``[model]`` table describes, or None where it has faults."""
    before = len(table.faults)
    masses = table.numbers("masses", "a list of masses above 0", lambda x: bool(x) and min(x) > 0)
    n = len(masses) if masses else 0
    stiffnesses = table.numbers(
        "stiffnesses",
        f"a list of {n or 'as many'} spring stiffnesses of 0 or more, or one more for a spring "
        "from the top to the ground",
        lambda x: (len(x) in (n, n + 1) if n else bool(x)) and min(x) >= 0,
    )
    added = table.numbers(
        "added_masses",
        f"a list of {n or 'as many'} masses of 0 or more",
        lambda x: (len(x) == n if n else True) and all(m >= 0 for m in x),
        default=[0.0] * n,
    )
    springs = len(stiffnesses) if stiffnesses else 0
    stiffness_names = _scales(table, "stiffness_parameters", springs, parameters)
    mass_names = _scales(table, "mass_parameters", n, parameters)
    sensors = read_sensors(table, n or None, default=None)
    outputs = read_outputs(table, n or None, sensors or [f"floor{i + 1}" for i in range(n)])
    if len(table.faults) > before or masses is None or stiffnesses is None:
        return None
    return chain(
        parameters,
        masses,
        stiffnesses,
        added_masses=added,
        stiffness_parameters=stiffness_names,
        mass_parameters=mass_names,
        sensors=sensors,
        outputs=outputs,
    )


def _scales(
    table: Table, key: str, count: int, parameters: Sequence[str]
) -> list[str | None] | None:
    """Return the parameter that scales each member; an empty text means that none does."""
    names = table.take(
        key,
        f"a list of {count or 'as many'} names of parameters, '' where none scales",
        lambda x: (
            isinstance(x, list)
            and (len(x) == count or not count)
            and all(isinstance(name, str) for name in x)
        ),
        [],
    )
    for name in names:
        if name and name not in parameters:
            table.fault(key, "names of parameters", suggestion(name, parameters))
    return [name or None for name in names] or None


CHAIN = ModelKind("chain", read_chain, is_reducible=False)
