"""Writes the tables of docs/results.md from the schema of results: python docs/make_results.py.

The page has a pair of comments for each table, ``<!-- table: NAME -->`` and ``<!-- end -->``. What
is between them is made, everything else is written by hand.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from modefront.predictions import Passage, PeakResponse
from modefront.results.schema import ATTRIBUTES, DIMENSIONS, FORMAT, variables_of
from modefront.variables import Variable

PAGE = Path(__file__).with_name("results.md")

TABLE = re.compile(r"(<!-- table: (?P<name>[^>]+?) -->\n).*?(<!-- end -->)", re.DOTALL)


def tables() -> dict[str, str]:
    """Return the tables by name: one for each section of the schema, dimensions and attributes."""
    sections: dict[str, list[Variable]] = {}
    for variable in variables_of((PeakResponse.kind, Passage.kind)).values():
        sections.setdefault(variable.section, []).append(variable)
    out = {name: variable_table(variables) for name, variables in sections.items()}
    dimensions = [[f"`{name}`", meaning] for name, meaning in DIMENSIONS.items()]
    attributes = [[f"`{x.name}`", x.values, str(x.since), x.meaning] for x in ATTRIBUTES.values()]
    return out | {
        "Dimensions": "".join(rows(["dimension", "meaning"], dimensions)),
        "Attributes": "".join(rows(["attribute", "type", "since", "meaning"], attributes)),
    }


def variable_table(variables: Sequence[Variable]) -> str:
    """Return the table of the variables of a section."""
    cells = [
        [
            f"`{x.name}`" + (" *" if x.required else ""),
            ", ".join(x.dimensions) or "–",
            x.unit or "–",
            str(x.since),
            x.meaning,
        ]
        for x in variables
    ]
    return "".join(rows(["variable", "dimensions", "unit", "since", "meaning"], cells))


def rows(header: Sequence[str], cells: Iterable[Sequence[str]]) -> Iterator[str]:
    """Yield the lines of a table of Markdown."""
    yield line(header)
    yield line(["---"] * len(header))
    yield from map(line, cells)


def line(cells: Sequence[str]) -> str:
    """Return a line of a table of Markdown."""
    return f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in cells)} |\n"


def page(text: str) -> str:
    """Return the text of the page with its tables made anew.

    Raises ValueError where a table is missing on the page, or is none of the schema.
    """
    made = tables()
    other = [match["name"] for match in TABLE.finditer(text)]
    if sorted(other) != sorted(made):
        raise ValueError(f"expected one table each of {sorted(made)}, found {sorted(other)}")
    text = TABLE.sub(lambda match: f"{match[1]}{made[match['name']]}{match[3]}", text)
    return re.sub(r"(<!-- format -->)\d+", rf"\g<1>{FORMAT}", text)


def main() -> None:
    """Write the page."""
    PAGE.write_text(page(PAGE.read_text(encoding="utf-8")), encoding="utf-8")


if __name__ == "__main__":
    main()
