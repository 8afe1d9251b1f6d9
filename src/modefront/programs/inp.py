"""Decks in the keyword language of Abaqus and CalculiX: nodes, elements, supports."""

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from itertools import product
from pathlib import Path

import numpy as np

from modefront._typing import Floats
from modefront.errors import reason, refusing
from modefront.inputs import ended, fortran, wrong
from modefront.programs.base import ProgramMesh, mesh_of, refuse_unknown_nodes

DEEPEST = 20  # decks that include each other, one in the other, at most

_TYPES = (  # beginnings of the names of element types, and the cells that they are
    (r"C3D(8|20|27)|SC8|F3D8|DC3D(8|20)", "hexahedron"),
    (r"C3D(4|10)|F3D4|DC3D(4|10)", "tetra"),
    (r"C3D(6|15)|SC6|F3D6|DC3D(6|15)", "wedge"),
    (r"(S|STRI|M3D|CPS|CPE|CAX|DS)(3|6|65)(?!\d)", "triangle"),
    (r"(S|M3D|CPS|CPE|CAX|DS)[489]", "quad"),
    (r"B[23][123]|PIPE|T[23]D|SPRINGA|SPRING2|DASHPOT[A2]|GAP|CONN[23]D2|D$|DCOUP|ITS", "line"),
    (r"MASS|ROTARYI|SPRING1|DASHPOT1", "vertex"),
)


# 11 fields: one for each kind of entry of a deck.
@dataclass
class Deck:
    """Nodes, elements and constraints of a deck, as they are collected while it is read."""

    nodes: dict[int, Floats] = field(default_factory=dict)  # coordinates by number
    cells: list[tuple[str, list[int]]] = field(default_factory=list)  # types and nodes of elements
    sets: dict[str, list[int]] = field(default_factory=dict)  # nodes by the name of their set
    # node or set, first and last direction, from 1
    supports: list[tuple[str, int, int]] = field(default_factory=list)
    elements: set[int] = field(default_factory=set)  # numbers
    expanded: set[int] = field(default_factory=set)  # nodes of what CalculiX makes solids of
    others: set[int] = field(default_factory=set)  # nodes of all other elements
    bodies: list[str] = field(default_factory=list)  # nodes of rigid bodies, or their sets
    guides: list[str] = field(default_factory=list)  # reference nodes of bodies and couplings
    turned: list[str] = field(default_factory=list)  # sets of nodes with systems of their own
    parts: bool = False  # whether nodes are numbered in parts: numbers of matrices are others

    @cached_property
    def mesh(self) -> ProgramMesh:
        """Nodes and elements."""
        return mesh_of(self.nodes, self.cells)

    @cached_property
    def held(self) -> set[tuple[int, int]]:
        """Node and direction, from 1, of every support along axes that are not turned."""
        turned = set(self.nodes_of(self.turned))
        ranges = ((self.nodes_of([name]), range(a, b + 1)) for name, a, b in self.supports)
        return {pair for each in ranges for pair in product(*each) if pair[0] not in turned}

    def nodes_of(self, names: Iterable[str]) -> Iterator[int]:
        """Yield nodes that are named, and those of sets, as far as they are listed."""
        for name in names:
            yield from [int(name)] if name.isdigit() else self.sets.get(name.upper(), [])


def read_deck(path: Path) -> Deck:
    """Return the model of a deck; raises OSError, and InputError for lines that are wrong."""
    if not path.is_file():
        raise FileNotFoundError(f"no file {path.name}")
    ended(path)
    deck, more = Deck(), False  # whether other lines make nodes, or these may be in another file
    for keyword, options, rows in _blocks(path):
        more |= "INPUT" in options or keyword in ("NGEN", "NFILL", "NCOPY", "NMAP")
        if keyword == "TRANSFORM":
            deck.turned.append(options.get("NSET", ""))
        if deck.parts or keyword in ("PART", "INSTANCE"):
            deck.parts = True
        elif take := _TAKEN.get(keyword):
            expected = f"lines of *{keyword} with all of their numbers"
            with refusing(path, expected, ValueError, place=f"*{keyword}"):
                take(deck, options, rows)
        elif keyword in ("RIGID BODY", "COUPLING"):
            deck.bodies.append(options.get("NSET", ""))
            deck.guides += [options.get(name, "") for name in ("REF NODE", "ROT NODE")]
    if not deck.parts and not more:
        if not deck.nodes:
            raise wrong(path, "nodes (*NODE)", "none")
        refuse_unknown_nodes(path, deck.nodes, deck.expanded | deck.others)
    return deck


def deck_of(path: Path, notes: list[str], missing: str = "") -> Deck | None:
    """Return the deck of a job; None with a note of what is ``missing`` where it is not there."""
    try:
        return read_deck(path)
    except OSError as error:
        notes.append(f"without the deck ({reason(error)}) there are no coordinates{missing}")
        return None


def _blocks(path: Path, depth: int = 0) -> Iterator[tuple[str, dict[str, str], list[list[str]]]]:
    """Yield keyword, options and lines of numbers of every block, those of included files too."""
    keyword, options, rows, head = "", dict[str, str](), list[list[str]](), ""
    if not path.is_file():  # what a deck includes may be elsewhere
        return
    with path.open(encoding="utf-8", errors="replace") as file:
        for line in file:
            text = line.strip()
            if text.startswith("**") or not text:
                continue
            if head.endswith(",") and text[0].isalpha():  # a keyword that goes on
                head += text
                keyword, options = keyword_of(head)
                continue
            head = text if text.startswith("*") else ""
            if not head:
                rows.append([item.strip() for item in text.split(",")])
                continue
            if keyword:
                yield keyword, options, rows
            elif rows and rows[0][0].isdigit():
                raise wrong(path, "a keyword before lines of numbers", ", ".join(rows[0]))
            keyword, options, rows = *keyword_of(text), []
            if keyword == "INCLUDE" and options.get("INPUT") and depth < DEEPEST:
                other = path.parent / options["INPUT"]
                if other.resolve().is_relative_to(path.parent.resolve()):  # nothing from elsewhere
                    yield from _blocks(other, depth + 1)
    if keyword:
        yield keyword, options, rows


def keyword_of(text: str) -> tuple[str, dict[str, str]]:
    """Return the keyword of a line with a star, and its options."""
    name, *parts = text[1:].split(",")
    pairs = (part.partition("=") for part in parts)
    options = {key.strip().upper(): value.strip().strip('"') for key, _, value in pairs}
    return name.strip().upper(), options


def _nodes(deck: Deck, options: dict[str, str], rows: list[list[str]]) -> None:
    for row in rows:
        number = int(row[0])
        point = [fortran(x or "0") for x in (*row[1:4], "", "", "")[:3]]
        if not np.isfinite(point).all():
            raise ValueError(f"{', '.join(row)!r}")
        deck.nodes[number] = np.array(point)
        if "NSET" in options:
            deck.sets.setdefault(options["NSET"].upper(), []).append(number)


def _elements(deck: Deck, options: dict[str, str], rows: list[list[str]]) -> None:
    if not (name := options.get("TYPE", "").upper()):
        raise ValueError("no TYPE of the elements")
    cell = next((cell for pattern, cell in _TYPES if re.match(pattern, name)), None)
    # Names of these say how many nodes there are.
    counted = re.match(r"(?:D?C3D|SC|S|M3D|CPS|CPE|CAX)(?!27)([0-9]+)", name)
    count = int(counted[1]) if counted else 0
    joined, more = list[list[int]](), False
    for row in rows:  # elements of many nodes go on in the next line after a comma at the end
        joined += [] if more else [[]]
        joined[-1] += [int(x) for x in row if x]
        more = row[-1] == "" and (not count or len(joined[-1]) <= count)
    expanded = re.match(r"S[3468]|M3D|CPS|CPE|CAX|B[23][123]|PIPE|T[23]D", name)
    target = deck.expanded if expanded else deck.others
    for number, *nodes in (each[: count + 1] if count else each for each in joined):
        if (count and len(nodes) != count) or number in deck.elements:
            raise ValueError(f"{len(nodes)} nodes of element {number}, or that element again")
        deck.elements.add(number)
        target.update(n for n in nodes if n)  # ends of networks are 0
        if re.match(r"B[23]2|T[23]D3|PIPE[23]2", name) and len(nodes) == 3:
            nodes = [nodes[0], nodes[2]]  # that in the middle is listed between the ends
        if cell:
            deck.cells.append((cell, nodes))


def _add_set(deck: Deck, options: dict[str, str], rows: list[list[str]]) -> None:
    if not options.get("NSET") or not (rows or options.keys() & {"ELSET", "INPUT"}):
        raise ValueError("no name NSET of the set, or no nodes in it")
    chosen = deck.sets.setdefault(options["NSET"].upper(), [])
    for row in rows:
        items = [x for x in row if x]
        if "GENERATE" in options and all(x.isdigit() for x in items) and len(items) > 1:
            first, last, step = (*map(int, items), 1)[:3]
            items = list(map(str, range(first, last + 1, max(step, 1))))
        for item in items:
            if not (item.isdigit() or item[0].isalpha() or item[0] in '_"'):
                raise ValueError(f"{item!r} in place of a node or the name of a set")
            chosen += [int(item)] if item.isdigit() else deck.sets.get(item.upper(), [])


def _boundary(deck: Deck, _: dict[str, str], rows: list[list[str]]) -> None:
    named = {"ENCASTRE": (1, 6), "PINNED": (1, 3)}
    for row in rows:
        name, first, last, value = (*row, "", "", "")[:4]
        if not (first.isdigit() or first[:1].isalpha()):
            raise ValueError(f"{', '.join(row)!r}")
        last = last or first
        if first.upper() in named:
            deck.supports.append((name, *named[first.upper()]))
        elif first.isdigit() and last.isdigit() and not value.strip("0.+-eE "):
            deck.supports.append((name, int(first), min(int(last), 6)))


_TAKEN = {"NODE": _nodes, "ELEMENT": _elements, "NSET": _add_set, "BOUNDARY": _boundary}
"""What takes the lines of a keyword."""
