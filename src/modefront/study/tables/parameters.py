"""``[[parameter]]``: names, nominal values and bounds."""

from __future__ import annotations

from modefront.models.parameters import Parameter
from modefront.options import each_once
from modefront.study.tables.options import note, read_record
from modefront.toml import Table, has_name


def read_parameters(root: Table) -> tuple[list[str], tuple[Parameter, ...]]:
    """Return the names that tables give to parameters, and the parameters in which all is right."""
    tables = root.tables("parameter", required=True)
    out = []
    for table in tables:
        if table.values.get("name") == "base":
            table.fault("name", "another name: 'base' is the constant term", "'base'")
        out.append(read_record(table, Parameter))
    names = [table.values["name"] for table in tables if has_name(table)]
    note(root, each_once("[[parameter]]", names))
    known = tuple(parameter for parameter in out if parameter is not None)
    free = {parameter.name for parameter in known if parameter.free}
    for parameter in known:
        if parameter.tie and parameter.tie not in free:
            expected = "the name of a parameter that is neither fixed nor tied"
            root.fault(f"[[parameter]] '{parameter.name}' tie", expected, f"'{parameter.tie}'")
    if known and not free:
        root.fault("[[parameter]]", "one that is neither fixed nor tied", "none")
    return names, known
