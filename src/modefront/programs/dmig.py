"""DMIG entries of Nastran in large fields, as punch files hold them.

Each column has a line ``DMIG*  NAME  node  component``, followed by a line
``*  node  component  value`` for every row, in fields of 16 characters behind one of 8; the line
``DMIG  NAME  0  form …`` before them tells whether only one triangle is listed. A component of 0
is a scalar point.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from modefront._typing import Floats, Ints
from modefront.errors import reason
from modefront.inputs import ended, fortran, wrong

COMPLEX = (3, 4)
"""Types of complex numbers in the header."""


@dataclass(frozen=True, eq=False)
class DmigMatrix:
    """A matrix by nodes and components.

    Attributes
    ----------
    row, column : (entries, 2) node and component
    value : (entries,)
    precision : relative error of its numbers
    """

    row: Ints
    column: Ints
    value: Floats
    precision: float


def read_dmig(path: Path) -> Mapping[str, DmigMatrix]:
    """Return all matrices of a punch file by their names.

    Raises InputError for a file without any, with complex numbers, or cut off.
    """
    ended(path)
    rows: dict[str, list[tuple[int, int, int, int]]] = {}
    texts: dict[str, list[str]] = {}
    header: str | None = None
    column: tuple[int, int] | None = None
    name = ""
    with path.open(encoding="latin-1") as stream:
        for number, line in enumerate(stream, start=1):
            place = f"line {number}"
            if line.startswith("DMIG "):
                header, column = line[8:16].strip(), None
                if header.upper() in rows:
                    expected = f"the header 'DMIG {header}' once, before its columns"
                    raise wrong(path, expected, "one after them", place)
                kind = line[32:40].strip()
                if kind.isdigit() and int(kind) in COMPLEX:
                    raise wrong(path, "real numbers", f"type {int(kind)} (complex)", place)
            elif line.startswith("DMIG*"):
                name = line[8:24].strip()
                if header not in (None, name):
                    expected = f"a header 'DMIG {name}' before its columns"
                    raise wrong(path, expected, repr(header), place)
                column = _label(path, place, line[24:40], line[40:56])
                rows.setdefault(name.upper(), [])
                texts.setdefault(name.upper(), [])
            elif line.startswith("*") and line.strip() != "*" and (rows or header is not None):
                if column is None:
                    raise wrong(path, "a column ('DMIG*') before its entries", "none", place)
                label = _label(path, place, line[8:24], line[24:40])
                rows[name.upper()].append((*label, *column))
                texts[name.upper()].append(line[40:56])
    if not rows:
        raise wrong(path, "DMIG entries in large fields ('DMIG*')", "none")
    out: dict[str, DmigMatrix] = {}
    known = (x.strip().lstrip("+-").upper() for each in texts.values() for x in each[: 10**4])
    behind = (re.split("[DE+-]", text)[0].partition(".")[2] for text in known)
    precision = 10.0 ** -max(map(len, behind), default=15)
    for each, labels in rows.items():
        try:
            values = np.array([fortran(text) for text in texts[each]])
        except ValueError as error:
            raise wrong(path, "numbers in the fourth field", reason(error)) from None
        table = np.array(labels, dtype=np.intp).reshape(-1, 4)
        out[each] = DmigMatrix(table[:, :2], table[:, 2:], values, precision)
    return out


def _label(path: Path, place: str, node: str, component: str) -> tuple[int, int]:
    try:
        return int(node), int(component)
    except ValueError as error:
        raise wrong(path, "nodes and components in fields of 16", reason(error), place) from None
