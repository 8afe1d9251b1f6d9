"""DMIG entries of Nastran in large fields, as punch files hold them.

Each column has a line ``DMIG*  NAME  node  component``, followed by a line
``*  node  component  value`` for every row, in fields of 16 characters behind one of 8; the line
``DMIG  NAME  0  form …`` before them tells whether only one triangle is listed. A component of 0
is a scalar point.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import TypeAlias

import numpy as np

from modefront._typing import Floats, Ints
from modefront.errors import reason
from modefront.inputs import ended, fortran, wrong

DmigMatrix: TypeAlias = tuple[Ints, Floats, float]
"""Labels (entries, 4) of rows and columns, each a node and a component; values (entries,); and the
relative error of these."""


def read_dmig(path: Path) -> Mapping[str, DmigMatrix]:
    """Return all matrices of a punch file by their names.

    Raises InputError for a file without any, with complex numbers, or cut off.
    """
    ended(path)
    entries: dict[str, list[tuple[list[int], str]]] = {}
    header, column, name = None, list[int](), ""
    with path.open(encoding="latin-1") as stream:
        for number, line in enumerate(stream, start=1):
            place = f"line {number}"
            if line.startswith("DMIG "):
                header, column = line[8:16].strip(), []
                if header.upper() in entries:
                    expected = f"the header 'DMIG {header}' once, before its columns"
                    raise wrong(path, expected, "one after them", place)
                kind = line[32:40].strip()
                if kind.isdigit() and int(kind) in (3, 4):
                    raise wrong(path, "real numbers", f"type {int(kind)} (complex)", place)
            elif line.startswith("DMIG*"):
                name = line[8:24].strip()
                if header not in (None, name):
                    expected = f"a header 'DMIG {name}' before its columns"
                    raise wrong(path, expected, repr(header), place)
                column = _label(path, place, line[24:40], line[40:56])
                entries.setdefault(name.upper(), [])
            elif line.startswith("*") and line.strip() != "*" and (entries or header is not None):
                if not column:
                    raise wrong(path, "a column ('DMIG*') before its entries", "none", place)
                label = _label(path, place, line[8:24], line[24:40])
                entries[name.upper()].append(([*label, *column], line[40:56]))
    if not entries:
        raise wrong(path, "DMIG entries in large fields ('DMIG*')", "none")
    known = (text.strip().lstrip("+-").upper() for x in entries.values() for _, text in x[: 10**4])
    behind = (re.split("[DE+-]", text)[0].partition(".")[2] for text in known)
    precision = 10.0 ** -max(map(len, behind), default=15)
    try:
        return {
            each: (
                np.array([labels for labels, _ in rows], dtype=np.intp).reshape(-1, 4),
                np.array([fortran(text) for _, text in rows]),
                precision,
            )
            for each, rows in entries.items()
        }
    except ValueError as error:
        raise wrong(path, "numbers in the fourth field", reason(error)) from None


def _label(path: Path, place: str, *fields: str) -> list[int]:
    try:
        return [int(field) for field in fields]
    except ValueError as error:
        raise wrong(path, "nodes and components in fields of 16", reason(error), place) from None
