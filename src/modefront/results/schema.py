"""The schema of results: every variable and attribute with dimensions, unit and meaning.

It is the tables of the page ``results.md``. A row has a name, with ``*`` where every file has it;
dimensions; what it holds, where that is not numbers, and its unit; and its meaning.
"""

import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import get_args

import numpy as np

from modefront.datasets import Array
from modefront.errors import wrong
from modefront.predictions.base import Contents, PredictionKind, Variable

FORMAT = 4
"""Version of the schema: raised when a variable changes its meaning, or a required one is added."""

_PAGE = Path(__file__).with_name("results.md").read_text(encoding="utf-8")
_TABLES = re.sub("<!-- table: .*?<!-- end -->", "", _PAGE, flags=re.DOTALL)  # of predictions


def _rows(of: str) -> dict[str, Variable]:
    """Return the rows of all tables of variables, attributes or dimensions by their names."""
    out = {}
    for table in re.findall(rf"^\| {of} \|.*\n.*\n((?:\|.*\n)+)", _TABLES, re.MULTILINE):
        for row in re.finditer(r"^\| `(\w+)`( \*)? \| (.*) \|$", table, re.MULTILINE):
            cells = row[3].replace("–", "").split(" | ")
            named, holds = cells[:-2], "".join(cells[-2:-1])
            values: Contents = next((x for x in get_args(Contents) if x in holds.split()), "number")
            dimensions = tuple("".join(named).replace(",", "").split())
            unit = holds.replace(values, "").strip()
            out[row[1]] = Variable(row[1], dimensions, cells[-1], values, unit, bool(row[2]))
    return out


DIMENSIONS = {name: row.meaning for name, row in _rows("dimension").items()}
"""Meanings of the dimensions, by name."""

VARIABLES, ATTRIBUTES = _rows("variable"), _rows("attribute")
"""Variables by name, without those of predictions, and attributes, numbers or texts."""

Values = dict[str, object]  # values of variables by name


def variables_of(kinds: Iterable[PredictionKind]) -> dict[str, Variable]:
    """Return all variables by name, with those of kinds of predictions.

    Raises InputError where a kind has a variable or dimension that others have.
    """
    out, dimensions = dict(VARIABLES), list(DIMENSIONS)
    for kind in kinds:
        own = {x.name: x for x in kind.schema}
        taken = [("a dimension", x) for x in dimensions if x == kind.dimension]
        taken += [("variables", x) for x in own if x in out]
        for what, name in taken:
            expected = f"{what} that nothing else of the results has"
            raise wrong(f"predictions of the kind '{kind.table}'", expected, f"'{name}'")
        dimensions.append(kind.dimension)
        out |= own
    return out


EMPTY = {"text": str, "truth": bool, "count": int, "number": float}
"""Types of variables without values."""


def described(
    values: Mapping[str, object],
    kinds: Iterable[PredictionKind] = (),
    sizes: Mapping[str, int] | None = None,
) -> dict[str, Array]:
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
        out[name] = Array(variable.dimensions, array, variable.attributes)
    return out
