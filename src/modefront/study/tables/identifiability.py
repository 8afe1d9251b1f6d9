"""``[identifiability]``: what is done about parameters that the data do not determine."""

from __future__ import annotations

from dataclasses import dataclass

from modefront.toml import Table


@dataclass(frozen=True)
class Identifiability:
    """What is looked for.

    Attributes
    ----------
    flat : share by which an objective may exceed its least value in a flat part of the front; 0
        looks for none
    models : at most so many on each manifold of equally good ones; 0 follows none
    step : distance of neighbours among them, over the ranges of the parameters
    """

    flat: float = 0.01
    models: int = 100
    step: float = 0.05


def read_identifiability(root: Table) -> Identifiability:
    """Return what is done about parameters that the data do not determine."""
    table = root.table("identifiability", default=None)
    if table is None:
        return Identifiability()
    default = Identifiability()
    flat = table.number("flat", "a share from 0 to 1", lambda x: 0 <= x <= 1, default.flat)
    models = table.integer("models", 0, 10**6, default.models)
    step = table.number(
        "step", "a share of the ranges from 0.001 to 0.5", lambda x: 1e-3 <= x <= 0.5, default.step
    )
    table.close()
    return Identifiability(flat, models, step)
