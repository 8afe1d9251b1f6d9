"""``[data]``: the measured modes."""

from __future__ import annotations

from modefront.data.csv import read_csv
from modefront.data.modal import ModalData
from modefront.errors import InputError
from modefront.models.base import Model
from modefront.toml import Table


def read_data(root: Table, model: Model | None) -> ModalData | None:
    """Return the measured modes, None where they have faults."""
    table = root.table("data", "a table [data]")
    if table is None:
        return None
    name = table.text("file", "the name of a file of modal data")
    table.close()
    if name is None:
        return None
    if not name.lower().endswith(".csv"):
        table.fault("file", "a file that ends in .csv", f"'{name}'")
        return None
    try:
        # Without a model all columns may be sensors: what else is wrong is found nevertheless.
        data = read_csv(table.path(name), model.sensors if model else None)
    except InputError as error:
        root.faults.extend(error.faults)
        return None
    if model and len(data.modes) > model.size:
        found = f"{len(data.modes)} in '{name}'"
        root.fault("[data] file", f"at most {model.size} modes, as the model has", found)
    return data
