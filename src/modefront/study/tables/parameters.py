"""``[[parameter]]``: names, nominal values and bounds."""

from __future__ import annotations

import math
from dataclasses import dataclass

from modefront.toml import Table, has_name, repeated


@dataclass(frozen=True)
class Parameter:
    """A parameter of the model: nominal value and bounds."""

    name: str
    nominal: float
    lower: float
    upper: float


def read_parameters(root: Table) -> tuple[Parameter, ...]:
    """Return the parameters that a study names."""
    out = []
    tables = root.tables("parameter", required=True)
    for table in tables:
        name = table.text("name", "the name of the parameter")
        bounds = table.numbers(
            "bounds",
            "[lower, upper], two finite numbers with lower < upper",
            lambda x: len(x) == 2 and x[0] < x[1],
        )
        nominal = table.number("nominal", "a finite number", math.isfinite)
        if bounds is not None and nominal is not None and not bounds[0] <= nominal <= bounds[1]:
            inside = f"a value within its bounds, {bounds[0]:g} to {bounds[1]:g}"
            table.fault("nominal", inside, f"{nominal:g}")
        if name == "base":
            table.fault("name", "another name: 'base' is the constant term", "'base'")
        table.close()
        lower, upper = bounds or (0.0, 1.0)
        out.append(Parameter(name or "", 0.0 if nominal is None else nominal, lower, upper))
    for name in repeated(table.values.get("name") for table in tables if has_name(table)):
        root.fault("[[parameter]]", "each name once", f"'{name}' twice")
    return tuple(out)
