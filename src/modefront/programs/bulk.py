"""Bulk data of Nastran: nodes, elements, and which degrees of freedom are in the a-set.

The a-set is what is left of all components of all nodes when supports (SPC, SPC1, the nodes' own),
followers (MPC, RBE2, RBE3, RBAR) and OMIT are taken away, and those components that no element
makes stiff, which AUTOSPC holds: the rotation about the normal of a flat shell, for example.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from itertools import chain
from pathlib import Path

import numpy as np
from scipy.linalg import null_space

from modefront._typing import Floats
from modefront.errors import reason
from modefront.programs.base import wrong
from modefront.programs.dmig import real
from modefront.programs.mesh import ProgramMesh, mesh_of, refuse_unknown_nodes

_ELEMENTS = {  # nodes begin at this field, as many of them are corners, of this kind
    "CQUAD4": (3, 4, "quad"),
    "CQUADR": (3, 4, "quad"),
    "CQUAD8": (3, 4, "quad"),
    "CTRIA3": (3, 3, "triangle"),
    "CTRIAR": (3, 3, "triangle"),
    "CTRIA6": (3, 3, "triangle"),
    "CSHEAR": (3, 4, "quad"),
    "CBAR": (3, 2, "line"),
    "CBEAM": (3, 2, "line"),
    "CROD": (3, 2, "line"),
    "CTUBE": (3, 2, "line"),
    "CONROD": (2, 2, "line"),
    "CBUSH": (3, 2, "line"),
    "CHEXA": (3, 8, "hexahedron"),
    "CPENTA": (3, 6, "wedge"),
    "CTETRA": (3, 4, "tetra"),
    "CPYRAM": (3, 5, "pyramid"),
}
_FULL = {"CBAR", "CBEAM", "CBUSH"}
_RODS = {"CROD", "CTUBE", "CONROD"}
_SOLIDS = {"CHEXA", "CPENTA", "CTETRA", "CPYRAM"}
_SHELL_EXTRA = {"CQUAD8": 4, "CTRIA6": 3}
_SOLID_NODES = {"CHEXA": 20, "CPENTA": 15, "CTETRA": 10, "CPYRAM": 13}

FLAT = 1e-8
"""Stiffness of a direction, over the greatest at its node, below which AUTOSPC holds it."""

Dof = tuple[int, int]


# 17 fields: one for each kind of entry of a deck.
@dataclass
class Bulk:
    """Nodes, elements and constraints of a deck, as they are collected while it is read.

    Attributes
    ----------
    nodes : coordinates by number; NaN for those in another than the basic system
    scalar : scalar points
    cells : corners of elements by the type of the cell; ``elements``, ``shells`` and ``rods`` nodes
    stiff : stiffness of the translations and rotations of nodes, but for shells and rods
    held : supports that the case control chooses, node and component
    supports, constraints, added : sets of SPC and MPC by number, and the sets of which others are
    followers : dependent degrees of freedom
    omitted : OMIT; kept : ASET, empty for all
    singular : components that no element makes stiff
    turned : nodes whose directions are those of a system of their own
    links : nodes that an element or a spring joins
    """

    nodes: dict[int, Floats] = field(default_factory=dict)
    scalar: set[int] = field(default_factory=set)
    cells: dict[str, list[list[int]]] = field(default_factory=dict)
    elements: dict[int, list[int]] = field(default_factory=dict)
    stiff: dict[int, Floats] = field(default_factory=dict)
    held: set[Dof] = field(default_factory=set)
    supports: dict[int, set[Dof]] = field(default_factory=dict)
    added: dict[int, list[int]] = field(default_factory=dict)
    constraints: dict[int, set[Dof]] = field(default_factory=dict)
    followers: set[Dof] = field(default_factory=set)
    omitted: set[Dof] = field(default_factory=set)
    kept: set[Dof] = field(default_factory=set)
    turned: set[int] = field(default_factory=set)
    links: list[tuple[int, ...]] = field(default_factory=list)
    shells: list[tuple[str, list[int]]] = field(default_factory=list)
    rods: list[list[int]] = field(default_factory=list)
    singular: set[Dof] = field(default_factory=set)

    @cached_property
    def mesh(self) -> ProgramMesh:
        """Nodes and elements."""
        return mesh_of(self.nodes, self.cells)

    def dofs(self, *, reduced: bool, singular: bool) -> list[Dof]:
        """Return nodes and components in the order of matrices: of the a-set, or of all nodes.

        ``singular`` says whether components that nothing makes stiff are among them.
        """
        points = [(n, c) for n in self.nodes for c in range(1, 7)]
        every = sorted([*points, *((n, 0) for n in self.scalar)])
        if not reduced:
            return every
        gone = self.held | self.followers | self.omitted
        gone |= set() if singular else self.singular
        return [dof for dof in every if dof not in gone and (not self.kept or dof in self.kept)]


def read_bulk(path: Path) -> Bulk:
    """Return the model of a deck.

    Raises OSError where it cannot be read, and InputError for entries of nodes, elements and
    supports that cannot be understood.
    """
    if not path.is_file():
        raise FileNotFoundError(f"no file {path.name}")
    text = path.read_text(encoding="utf-8", errors="replace")
    control, bulk = _parted(text)
    content = Bulk()
    default = ["", "", "", ""]
    if bulk != text and not re.search(r"^\s*ENDDATA", bulk, re.MULTILINE | re.IGNORECASE):
        raise wrong(path, "a line ENDDATA at the end", "none: is the file cut off?")
    first = text.count("\n", 0, len(text) - len(bulk)) + 1
    cards = list(_cards(bulk, first))
    for _, card in cards:
        if card[0] == "GRDSET":
            default = [_at(card, 2), _at(card, 6), _at(card, 7), _at(card, 8)]
    for line, card in cards:
        try:
            _take(content, card, default)
        except (ValueError, IndexError) as error:
            expected = f"an entry {card[0]} with all of its fields"
            raise wrong(path, expected, reason(error), f"line {line}") from None
    if not any(card[0] == "INCLUDE" for _, card in cards):
        if not content.nodes and not content.scalar:
            raise wrong(path, "entries GRID of nodes", "none")
        known = content.nodes.keys() | content.scalar
        refuse_unknown_nodes(path, known, chain.from_iterable(content.elements.values()))
    content.held |= _sets(content.supports, content.added, _chosen(control, "SPC"))
    content.followers |= _sets(content.constraints, content.added, _chosen(control, "MPC"))
    content.singular = _singular(content)
    return content


def _parted(text: str) -> tuple[str, str]:
    """Return case control and bulk data."""
    match = re.search(r"^\s*BEGIN\s+(BULK|SUPER).*$", text, re.MULTILINE | re.IGNORECASE)
    return ("", text) if match is None else (text[: match.start()], text[match.end() :])


def _chosen(control: str, key: str) -> int | None:
    match = re.search(rf"^\s*{key}\s*=\s*(\d+)", control, re.MULTILINE | re.IGNORECASE)
    return int(match[1]) if match else None


def _cards(text: str, first: int) -> Iterator[tuple[int, list[str]]]:
    """Yield line and fields of every entry, those of lines that continue it behind them.

    The text begins in the line ``first``.
    """
    card: list[str] = []
    begins = first
    for number, raw in enumerate(text.splitlines(), start=first):
        line = raw.partition("$")[0].rstrip()
        if not line.strip():
            continue
        if line.lstrip().upper().startswith("ENDDATA"):
            break
        name, fields = _fields(line)
        if name in ("", "+", "*") or name[0] in "+*":
            card += fields
            continue
        if card:
            yield begins, card
        begins, card = number, [name.rstrip("*").upper(), *fields]
    if card:
        yield begins, card


def _fields(line: str) -> tuple[str, list[str]]:
    """Return the name of a line and its 8 (in large fields 4) data fields."""
    if "," in line:
        name, *fields = (part.strip() for part in line.split(","))
        count = 4 if name.endswith("*") or name.startswith("*") else 8
        return name, (fields + [""] * count)[:count]
    line = line.expandtabs(8)
    name = line[:8].strip()
    width = 16 if name.endswith("*") or name.startswith("*") else 8
    return name, [line[k : k + width].strip() for k in range(8, 72, width)]


def _at(card: list[str], k: int) -> str:
    return card[k] if k < len(card) else ""


def _whole(text: str) -> int:
    return int(text) if text else 0


def _components(text: str) -> list[int]:
    return [int(c) for c in text if c in "0123456"]


def _listed(fields: Iterable[str]) -> list[int]:
    """Return the numbers of a list in which ``a THRU b`` may stand."""
    items = [x for x in fields if x]
    out: list[int] = []
    k = 0
    while k < len(items):
        if items[k].upper() == "THRU":
            out += range(out[-1] + 1, int(items[k + 1]) + 1)
            k += 2
            continue
        out.append(int(items[k]))
        k += 1
    return out


def _take(content: Bulk, card: list[str], default: list[str]) -> None:
    """Take one entry."""
    name = card[0]
    if name.startswith("="):
        raise ValueError("a replication, which is not read: write its entries out")
    if name == "GRID":
        _grid(content, card, default)
    elif name == "SPOINT":
        content.scalar.update(_listed(card[1:]))
    elif name in _ELEMENTS:
        _element(content, card)
    elif name.startswith("CELAS") or name.startswith("CDAMP"):
        _spring(content, card)
    elif name.startswith("RBE") or name == "RBAR":
        _rigid(content, card)
    elif name in ("SPC1", "SPC", "SPCADD", "MPCADD", "MPC"):
        _support(content, card)
    elif name in ("ASET1", "OMIT1", "ASET", "OMIT"):
        target = content.kept if name.startswith("ASET") else content.omitted
        if name.endswith("1"):
            nodes = _listed(card[2:])
            target.update((n, c) for n in nodes for c in _components(card[1] or "0"))
        else:
            for k in range(1, len(card) - 1, 2):
                if card[k]:
                    target.update((int(card[k]), c) for c in _components(card[k + 1] or "0"))


def _grid(content: Bulk, card: list[str], default: list[str]) -> None:
    number = int(card[1])
    if number in content.nodes:
        raise ValueError(f"node {number} again")
    held = _at(card, 8) or default[2]
    content.held.update((number, c) for c in _components(held))
    if _whole(_at(card, 7) or default[1]):
        content.turned.add(number)
    point = [real(x) if x else 0.0 for x in (_at(card, 3), _at(card, 4), _at(card, 5))]
    if not np.isfinite(point).all():
        raise ValueError(f"coordinates {', '.join(card[3:6])}")
    system = _whole(_at(card, 2) or default[0])
    content.nodes[number] = np.array(point if system == 0 else [np.nan] * 3)


def _element(content: Bulk, card: list[str]) -> None:
    name = card[0]
    first, corners, kind = _ELEMENTS[name]
    count = _SOLID_NODES.get(name, corners + _SHELL_EXTRA.get(name, 0))
    nodes = [n for n in map(_whole, card[first : first + count]) if n]
    if int(card[1]) in content.elements:
        raise ValueError(f"element {card[1]} again")
    content.elements[int(card[1])] = nodes
    if len(nodes) < corners and name != "CBUSH":  # one end of it may be the ground
        raise ValueError(f"{len(nodes)} nodes of {corners}")
    if len(nodes) >= corners:
        content.cells.setdefault(kind, []).append(nodes[:corners])
    content.links.append(tuple(nodes))
    if name in _FULL:
        for n in nodes:
            _stiffen(content, n, np.eye(3), np.eye(3))
    elif name in _RODS:
        content.rods.append(nodes)
    elif name in _SOLIDS:
        for n in nodes:
            _stiffen(content, n, np.eye(3), np.zeros((3, 3)))
    else:
        content.shells.append((name, nodes))


def _stiffen(content: Bulk, node: int, u: Floats, r: Floats) -> None:
    block = content.stiff.setdefault(node, np.zeros((2, 3, 3)))
    block += np.array([u, r])


def _spring(content: Bulk, card: list[str]) -> None:
    """Take CELAS1 to CELAS4: ends are a node and a component, or scalar points."""
    if card[0].endswith(("3", "4")):
        ends = [(_whole(_at(card, 3)), 0), (_whole(_at(card, 4)), 0)]
        content.scalar.update(n for n, _ in ends if n)
    else:
        ends = [(_whole(_at(card, k)), _whole(_at(card, k + 1))) for k in (3, 5)]
    content.links.append(tuple(n for n, _ in ends if n))
    if card[0].startswith("CDAMP"):
        return
    for node, component in ends:
        if node and component:
            blocks = np.zeros((2, 3, 3))
            axis = component - 1
            blocks[axis // 3, axis % 3, axis % 3] = 1.0
            _stiffen(content, node, blocks[0], blocks[1])


def _rigid(content: Bulk, card: list[str]) -> None:
    """Take RBE2, RBE3 and RBAR: which degrees of freedom follow others."""
    if card[0] == "RBE2":
        nodes = _listed(x for x in card[4:] if "." not in x)
        content.followers.update((n, c) for n in nodes for c in _components(card[3]))
        content.links.append((int(card[2]), *nodes))
    elif card[0] == "RBE3":
        content.followers.update((int(card[3]), c) for c in _components(card[4]))
        nodes = [int(x) for x in card[5:] if x.isdigit()]
        content.links.append((int(card[3]), *nodes))
    elif card[0] == "RBAR":
        ends = int(card[2]), int(card[3])
        content.links.append(ends)
        dependent = [_components(_at(card, k)) for k in (6, 7)]
        if not any(dependent):  # what is not independent, as the manual says
            independent = [_components(_at(card, k)) for k in (4, 5)]
            dependent = [[c for c in range(1, 7) if c not in some] for some in independent]
        for node, some in zip(ends, dependent, strict=True):
            content.followers.update((node, c) for c in some)


def _support(content: Bulk, card: list[str]) -> None:
    number = int(card[1])
    if card[0] in ("SPCADD", "MPCADD"):
        content.added.setdefault(number, []).extend(_listed(card[2:]))
    elif card[0] == "SPC1":
        held = content.supports.setdefault(number, set())
        held.update((n, c) for n in _listed(card[3:]) for c in _components(card[2] or "0"))
    elif card[0] == "SPC":
        held = content.supports.setdefault(number, set())
        for k in (2, 5):
            if _at(card, k):
                held.update((int(card[k]), c) for c in _components(_at(card, k + 1) or "0"))
    else:
        dependent = int(card[2]), _whole(_at(card, 3))
        content.constraints.setdefault(number, set()).add(dependent)
        nodes = [int(card[k]) for k in range(2, len(card), 3) if _at(card, k).isdigit()]
        content.links.append(tuple(nodes))


def _sets(table: dict[int, set[Dof]], added: dict[int, list[int]], chosen: int | None) -> set[Dof]:
    """Return the members of a chosen set; of all, where there is only one and none is chosen."""
    if chosen is None:
        return set().union(*table.values()) if len(table) == 1 else set()
    names = [chosen, *added.get(chosen, [])]
    return set().union(*(table.get(name, set()) for name in names))


def _singular(content: Bulk) -> set[Dof]:
    """Return the components that no element makes stiff, as AUTOSPC finds them."""
    for _, nodes in content.shells:
        corners = [content.nodes.get(n) for n in nodes[:4]]
        known = [x for x in corners if x is not None and np.isfinite(x).all()]
        normal = np.zeros(3)
        if len(known) >= 3:
            far = known[3] - known[1] if len(known) == 4 else known[2] - known[1]
            normal = np.cross(known[2] - known[0], far)
            normal /= np.linalg.norm(normal) or 1.0
        for n in nodes:
            _stiffen(content, n, np.eye(3), np.eye(3) - np.outer(normal, normal))
    for nodes in content.rods:
        ends = [content.nodes.get(n) for n in nodes]
        known = [x for x in ends if x is not None and np.isfinite(x).all()]
        if len(known) == 2:
            axis = known[1] - known[0]
            axis = axis / (np.linalg.norm(axis) or 1.0)
            for n in nodes:
                _stiffen(content, n, np.outer(axis, axis), np.outer(axis, axis))
    out: set[Dof] = set()
    for n in content.nodes:
        blocks = content.stiff.get(n, np.zeros((2, 3, 3)))
        for part, block in enumerate(blocks):
            values, vectors = np.linalg.eigh(block)
            soft = vectors[:, values <= FLAT * max(values[-1], 1.0)]
            for _ in range(soft.shape[1]):  # the component closest to what is soft, one by one
                component = int(np.argmax((soft**2).sum(axis=1)))
                out.add((n, 3 * part + component + 1))
                soft = soft @ null_space(soft[[component]])
    return out
