"""Writes tables of two pages from what the program knows: python docs/make_tables.py.

These are the variables of predictions in results.md, and those of study-file.md, from the
requirements by which study files are read. A page has a pair of comments for each table,
``<!-- table: NAME -->`` and ``<!-- end -->``. What is between them is made, everything else is
written by hand.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from modefront.options import WITHOUT, Schema
from modefront.predictions import Passage, PeakResponse
from modefront.study.file import study_schema

DOCS = Path(__file__).parent

TABLE = re.compile(r"(<!-- table: (?P<name>[^>]+?) -->\n).*?(<!-- end -->)", re.DOTALL)


def of_results() -> dict[str, str]:
    """Return the table of the variables of predictions."""
    cells = [
        [
            f"`{x.name}`",
            ", ".join(x.dimensions),
            " ".join(filter(None, [x.values.replace("number", ""), x.unit])) or "–",
            x.meaning,
        ]
        for kind in (PeakResponse.kind, Passage.kind)
        for x in kind.schema
    ]
    header = ["variable", "dimensions", "unit or type", "meaning"]
    return {"Predictions": "".join(rows(header, cells))}


def of_study_file() -> dict[str, str]:
    """Return the tables by name: all options, predictions, and each kind of models."""
    known = study_schema()["properties"]
    model, predict = known.pop("model"), known.pop("predict")
    kinds = cases(model, "kind")
    of_predictions = {"[predict]": {"properties": {"slack": predict["properties"].pop("slack")}}}
    of_predictions |= {f"predict.{key}": each for key, each in predict["properties"].items()}
    named = {key if "items" in each else f"[{key}]": each for key, each in known.items()}
    out = {"Options": key_table(named), "Predictions": key_table(of_predictions)}
    out |= {f'kind = "{name}"': key_table({"[model]": each}) for name, each in kinds.items()}
    members = {
        f"model.{key}": each
        for key, each in kinds["mesh"]["properties"].items()
        if each.get("type") == "array"
    }
    groups = cases(members.pop("model.group")["items"], "elements")
    out["Members"] = key_table(members)
    out["Groups"] = key_table(groups)
    sections = cases(groups["beam"]["properties"]["section"], "shape")
    out["Sections"] = key_table(sections)
    return out


def cases(schema: Schema, key: str) -> dict[str, Schema]:
    """Return the schemas of a table by the value of the key that chooses among them."""
    return {x["if"]["properties"][key]["enum"][0]: x["then"] for x in schema["allOf"]}


def key_table(tables: Mapping[str, Schema]) -> str:
    """Return a table of the keys of tables, with what the lines of a description say of each."""
    cells = []
    for name, table in tables.items():
        several = table.get("type") == "array"
        keys = table["items"] if several else table
        first = f"`[[{name}]]`" if several else f"`{name}`"
        for of_key in key_cells(keys):
            cells.append([first, *of_key])
            first = ""
    return "".join(rows(["table", "key", "value", "meaning", "default"], cells))


def key_cells(keys: Schema, outer: str = "") -> Iterator[list[str]]:
    """Yield the cells of each key of a table, and of those of a table in it."""
    for key, schema in keys["properties"].items():
        lines = schema.get("description", "").split("\n")
        default = "none"
        if lines[-1].startswith(WITHOUT):
            default = lines.pop().removeprefix(WITHOUT)
        elif key in keys.get("required", ()):
            default = "required"
        elif "default" in schema:
            default = value(schema["default"])
        meaning, expected = lines if len(lines) == 2 else ("", lines[0])
        chosen = "enum" in schema and len(schema["enum"]) == 1
        if not chosen:
            yield [f"`{outer}{key}`", expected, meaning, default]
            if "properties" in schema and "allOf" not in schema:
                yield from key_cells(schema, f"{outer}{key}.")


def value(default: Any) -> str:
    """Return a default as a study file has it."""
    if isinstance(default, bool | str | list):
        return f"`{json.dumps(default)}`"
    return f"{default:,}"


def rows(header: Sequence[str], cells: Iterable[Sequence[str]]) -> Iterator[str]:
    """Yield the lines of a table of Markdown."""
    yield line(header)
    yield line(["---"] * len(header))
    yield from map(line, cells)


def line(cells: Sequence[str]) -> str:
    """Return a line of a table of Markdown."""
    return f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in cells)} |\n"


PAGES: Mapping[Path, Callable[[], dict[str, str]]] = {
    DOCS.parent / "src" / "modefront" / "results" / "results.md": of_results,
    DOCS / "study-file.md": of_study_file,
}


def page(path: Path, text: str) -> str:
    """Return the text of a page with its tables made anew.

    Raises ValueError where a table is missing on the page, or is none of the schema.
    """
    made = PAGES[path]()
    other = [match["name"] for match in TABLE.finditer(text)]
    if sorted(other) != sorted(made):
        raise ValueError(f"expected one table each of {sorted(made)}, found {sorted(other)}")
    return TABLE.sub(lambda match: f"{match[1]}{made[match['name']]}{match[3]}", text)


def main() -> None:
    """Write the pages."""
    for path in PAGES:
        path.write_text(page(path, path.read_text(encoding="utf-8")), encoding="utf-8")


if __name__ == "__main__":
    main()
