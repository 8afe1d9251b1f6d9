"""``kind = "chain"``: lumped masses and springs."""

from collections.abc import Sequence

from modefront.models.base import Model
from modefront.models.chain import MASSES, chain
from modefront.options import Table, options
from modefront.study.kinds.sensors import ModelKind, read_places


def read_chain(table: Table, parameters: Sequence[str]) -> Model | None:
    """Return the chain that a ``[model]`` table describes, or None where it has faults."""
    before = len(table.faults)
    values, masses = table.read(options(chain)), table.values.get("masses")
    n = len(masses) if isinstance(masses, list) and MASSES.holds(masses) else None
    sensors = read_places(table, "sensors", n)
    floors = sensors or [f"floor{i + 1}" for i in range(n or 0)]
    outputs = read_places(table, "outputs", n, taken=floors)
    if values is not None and len(table.faults) == before:
        with table.noting():
            return chain(parameters, **values | {"sensors": sensors, "outputs": outputs})
    return None


CHAIN = ModelKind("chain", read_chain, is_reducible=False, table=chain)
