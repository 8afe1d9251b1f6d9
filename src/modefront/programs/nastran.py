"""Nastran: matrices of OUTPUT4 (``.op4``) or DMIG entries (``.pch``), and its bulk data.

OUTPUT4 has no numbers of nodes: the deck beside it tells which degrees of freedom are in the a-set.
What it tells is accepted only if the matrices agree: there are as many rows, and a translation of
the whole strains nothing but elements that are held somewhere.

The a-set is what is left of all components of all nodes when supports (SPC, SPC1, the nodes' own),
followers (MPC, RBE2, RBE3, RBAR) and OMIT are taken away, and those components that no element
makes stiff, which AUTOSPC holds: the rotation about the normal of a flat shell, for example.
"""

import re
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path

import numpy as np
import scipy.sparse
from scipy.linalg import null_space

from modefront._typing import Bools, Floats, Ints
from modefront.errors import refusing
from modefront.inputs import fortran, wrong
from modefront.models.dofs import DofTable
from modefront.programs import base
from modefront.programs.nastran_files import read_dmig, read_op4

DECKS = (".dat", ".bdf", ".nas", ".inp")
MATRICES = (".op4", ".pch")

SETS = ("AA", "AAX", "LL", "XX", "HH", "GG", "JJ", "2GG", "")  # behind K and M, the first of these

ADVICE = "OUTPUT4 KAA,MAA,,,//-1/21 writes an .op4 file, EXTSEOUT or PARAM,EXTOUT,DMIGPCH a .pch"

_ELEMENTS = {  # field where nodes begin, number of nodes, cell, what it makes stiff
    **dict.fromkeys(("CQUAD4", "CQUADR", "CSHEAR"), (3, 4, "quad", "shell")),
    **dict.fromkeys(("CTRIA3", "CTRIAR"), (3, 3, "triangle", "shell")),
    "CQUAD8": (3, 8, "quad", "shell"),
    "CTRIA6": (3, 6, "triangle", "shell"),
    **dict.fromkeys(("CBAR", "CBEAM", "CBUSH"), (3, 2, "line", "all")),
    **dict.fromkeys(("CROD", "CTUBE"), (3, 2, "line", "rod")),
    "CONROD": (2, 2, "line", "rod"),
    "CHEXA": (3, 20, "hexahedron", "solid"),
    "CPENTA": (3, 15, "wedge", "solid"),
    "CTETRA": (3, 10, "tetra", "solid"),
    "CPYRAM": (3, 13, "pyramid", "solid"),
}

EMPTY = [""] * 8
Dof = tuple[int, int]


def read(path: Path, options: base.JobOptions) -> base.Listed:
    """Return the matrices of a job, given by its .op4 or .pch file, or without suffix.

    A file with another suffix that is no deck, such as that of a Fortran unit, is one of OUTPUT4.
    """
    deck = path.suffix.lower() in DECKS
    file = path
    if not (path.suffix.lower() in MATRICES or (path.is_file() and not deck)):
        job = path.with_suffix("") if deck else path
        files = [job.with_name(job.name + suffix) for suffix in MATRICES]
        file = next((each for each in files if each.is_file()), files[0])
    file = base.existing(file, "matrices of Nastran", ADVICE)
    return (_from_dmig if file.suffix.lower() == ".pch" else _from_op4)(file, options)


def _pair(path: Path, names: Iterable[str], options: base.JobOptions) -> tuple[str, str]:
    known = list(names)
    if options.stiffness or options.mass:
        pair = (options.stiffness or "").upper(), (options.mass or "").upper()
    else:
        pairs = [(f"K{name}", f"M{name}") for name in SETS]
        pairs += [(x, "M" + x[1:]) for x in known if x.startswith("K")]
        pair = next((x for x in pairs if x[0] in known and x[1] in known), ("KAA", "MAA"))
    for name in pair:
        if name not in known:
            expected = f"a matrix '{name}'" if name else "--stiffness-name with --mass-name"
            raise wrong(path, expected, f"matrices {', '.join(known) or 'none'}")
    return pair


def _deck(path: Path, options: base.JobOptions, notes: list[str]) -> "Bulk | None":
    deck = options.deck or next((x for x in map(path.with_suffix, DECKS) if x.is_file()), None)
    if deck is None:
        notes.append(f"there is no deck ({path.stem}.dat or .bdf), and so there are no coordinates")
        return None
    with refusing(deck, "a deck that can be read", OSError):
        bulk = read_bulk(deck)
    notes += base.turned(sorted(bulk.turned))
    return bulk


def _from_op4(path: Path, options: base.JobOptions) -> base.Listed:
    matrices = read_op4(path)
    (K, digits), (M, others) = (matrices[name] for name in _pair(path, matrices, options))
    deck, size = _deck(path, options, notes := list[str]()), K.shape[0]
    dofs, precision = base.given_table(options, size), max(digits, others)
    listed = base.Listed((path, path), (K, M), dofs, precision, notes=notes)
    if deck is None or options.dofs:
        return listed
    choices = deck.dofs()
    fitting = [dofs for dofs in choices.values() if len(dofs) == size]
    if not fitting:
        counts = ", ".join(f"{len(dofs)} for {name}" for name, dofs in choices.items())
        expected = f"{size} degrees of freedom, as the matrices have, in the deck (or --dofs FILE)"
        raise wrong(path, expected, counts)
    node, direction = np.array(fitting[0], dtype=np.intp).reshape(-1, 2).T
    dofs, gone = DofTable(node, direction, np.ones(size)), deck.held | deck.followers
    unheld = np.array([dof not in gone for dof in fitting[0]])

    def free(K: base.Matrix, M: base.Matrix) -> Bools:
        rows: Bools = unheld & (K.diagonal() + M.diagonal() != 0)
        _check_labels(path, deck, K, dofs, rows)
        return rows

    return replace(listed, dofs=dofs, free=free, mesh=_drawn(deck, notes))


def _drawn(deck: "Bulk", notes: list[str]) -> base.ProgramMesh | None:
    if np.isfinite(deck.mesh.coordinates).all():
        return deck.mesh
    notes.append("nodes in coordinate systems of their own (CP): coordinates are left out")
    return None


def _check_labels(path: Path, deck: "Bulk", K: base.Matrix, dofs: DofTable, free: Bools) -> None:
    moving = set(zip(dofs.node[free].tolist(), dofs.direction[free].tolist(), strict=True))
    held = {n for n in deck.mesh.number.tolist() if any((n, c) not in moving for c in (1, 2, 3))}
    held |= deck.turned | {n for n, _ in deck.followers} | set(deck.scalar)
    joined = [*deck.links, *(tuple(nodes) for _, nodes in deck.elements.values())]
    for _ in range(2 if deck.followers else 1):  # followers join elements of their masters
        held |= {n for link in joined if held.intersection(link) for n in link}
    held |= {n for link in joined if len(link) == 1 for n in link}  # springs to the ground
    strained = free & ~np.isin(dofs.node, list(held))
    for direction in (1, 2, 3):
        r = (free & (dofs.direction == direction)).astype(float)
        force, size = K @ r, abs(K) @ r
        bad = (np.abs(force) > 1e-6 * size) & (size > 0) & strained  # less is rounding
        if bad.any():
            place = dofs.label(int(np.argmax(np.abs(force) * bad)))
            expected = "a stiffness matrix that fits the nodes of the deck; --dofs FILE says which "
            expected += "degrees of freedom its rows are"
            raise wrong(path, expected, f"a force at {place} in a translation of the whole")


def _from_dmig(path: Path, options: base.JobOptions) -> base.Listed:
    matrices = read_dmig(path)
    K, M = (matrices[name] for name in _pair(path, matrices, options))
    table = np.unique(np.concatenate([K[0].reshape(-1, 2), M[0].reshape(-1, 2)]), axis=0)
    keys = table @ [10, 1]

    def numbered(labels: Ints, value: Floats, _: float) -> scipy.sparse.coo_array:
        row, column = np.searchsorted(keys, labels.reshape(-1, 2, 2) @ [10, 1]).T
        return base.entries_of(row, column, value, keys.size)

    deck = _deck(path, options, notes := list[str]())
    dofs = DofTable(table[:, 0], table[:, 1], np.ones(len(table)))
    mesh = _drawn(deck, notes) if deck else None
    known = (path, path), (numbered(*K), numbered(*M)), dofs, K[2]
    return base.Listed(*known, counted=False, mesh=mesh, notes=notes)


# 12 fields: one for each kind of entry of a deck.
@dataclass
class Bulk:
    """Nodes, elements and constraints of a deck, as they are collected while it is read."""

    nodes: dict[int, Floats] = field(default_factory=dict)  # coordinates; NaN in other systems
    scalar: set[int] = field(default_factory=set)  # scalar points
    elements: dict[int, tuple[str, list[int]]] = field(default_factory=dict)  # name and nodes
    springs: list[Dof] = field(default_factory=list)  # nodes and components that springs hold
    links: list[tuple[int, ...]] = field(default_factory=list)  # what springs, constraints join
    held: set[Dof] = field(default_factory=set)  # supports that the case control chooses
    # sets, added: sets of SPC and MPC by kind and number, and the sets of which others are
    sets: dict[tuple[str, int], set[Dof]] = field(default_factory=dict)
    added: dict[tuple[str, int], list[int]] = field(default_factory=dict)
    followers: set[Dof] = field(default_factory=set)  # dependent degrees of freedom
    omitted: set[Dof] = field(default_factory=set)  # OMIT; kept : ASET, empty for all
    kept: set[Dof] = field(default_factory=set)
    turned: set[int] = field(default_factory=set)  # nodes with directions of their own

    @cached_property
    def mesh(self) -> base.ProgramMesh:
        """Nodes and elements."""
        elements = self.elements.values()
        return base.mesh_of(self.nodes, ((_ELEMENTS[name][2], nodes) for name, nodes in elements))

    def dofs(self) -> dict[str, list[Dof]]:
        """Return nodes and components in the order of matrices, by what these may be of."""
        points = [(n, c) for n in self.nodes for c in range(1, 7)]
        every = sorted([*points, *((n, 0) for n in self.scalar)])
        gone = self.held | self.followers | self.omitted
        left = [dof for dof in every if dof not in gone and (not self.kept or dof in self.kept)]
        singular = self._singular()
        return {
            "all nodes": every,
            "its free degrees of freedom": left,
            "its free degrees of freedom that are stiff": [x for x in left if x not in singular],
        }

    def chosen(self, kind: str, control: str) -> set[Dof]:
        """Return the set of a kind that the case control chooses; else the only one, if any."""
        known = {number: dofs for (name, number), dofs in self.sets.items() if name == kind}
        match = re.search(rf"^\s*{kind}\s*=\s*(\d+)", control, re.MULTILINE | re.IGNORECASE)
        number = int(match[1]) if match else next(iter(known), 0) if len(known) == 1 else 0
        numbers = (number, *self.added.get((kind, number), []))
        return set().union(*(known.get(each, set()) for each in numbers))

    def _singular(self) -> set[Dof]:
        """Return the components that no element makes stiff, as AUTOSPC finds them."""
        stiff = {n: np.zeros((2, 3, 3)) for n in self.nodes}  # translations, rotations
        for name, nodes in self.elements.values():
            added = self._stiffness(name, nodes)
            for n in stiff.keys() & set(nodes):
                stiff[n] += added
        for n, component in (each for each in self.springs if each[0] in stiff):
            part, axis = divmod(component - 1, 3)
            stiff[n][part, axis, axis] += 1.0
        out: set[Dof] = set()
        for n, blocks in stiff.items():
            for part, block in enumerate(blocks):
                values, vectors = np.linalg.eigh(block)
                soft = vectors[:, values <= 1e-8 * max(values[-1], 1.0)]
                for _ in range(soft.shape[1]):  # the component closest to what is soft, one by one
                    component = int(np.argmax((soft**2).sum(axis=1)))
                    out.add((n, 3 * part + component + 1))
                    soft = soft @ null_space(soft[[component]])
        return out

    def _stiffness(self, name: str, nodes: list[int]) -> Floats:
        """Return which translations and rotations (2, 3, 3) of its nodes an element makes stiff."""
        _, _, cell, kind = _ELEMENTS[name]
        points = [self.nodes[n] for n in nodes[: base.CORNERS[cell]] if n in self.nodes]
        known = [x for x in points if np.isfinite(x).all()]
        one, none = np.eye(3), np.zeros((3, 3))
        if kind == "rod":
            axis = known[1] - known[0] if len(known) == 2 else np.zeros(3)
            axis = axis / (np.linalg.norm(axis) or 1.0)
            return np.array([np.outer(axis, axis)] * 2)
        if kind == "shell" and len(known) > 2:
            normal = np.cross(known[2] - known[0], known[-1] - known[1])
            normal /= np.linalg.norm(normal) or 1.0
            return np.array([one, one - np.outer(normal, normal)])
        return np.array([one, none if kind == "solid" else one])


def read_bulk(path: Path) -> Bulk:
    """Return the model of a deck; raises OSError, and InputError for entries that are wrong."""
    text = path.read_text(encoding="utf-8", errors="replace")
    parted = re.search(r"^\s*BEGIN\s+(BULK|SUPER).*$", text, re.MULTILINE | re.IGNORECASE)
    control, bulk = (text[: parted.start()], text[parted.end() :]) if parted else ("", text)
    if parted and not re.search(r"^\s*ENDDATA", bulk, re.MULTILINE | re.IGNORECASE):
        raise wrong(path, "a line ENDDATA at the end", "none: is the file cut off?")
    content, cards = Bulk(), _cards(bulk, text.count("\n", 0, len(text) - len(bulk)) + 1)
    default = next((card for _, card in cards if card[0] == "GRDSET"), 2 * EMPTY)
    for line, card in cards:
        expected = f"an entry {card[0]} with all of its fields"
        with refusing(path, expected, ValueError, IndexError, place=f"line {line}"):
            _take(content, card, default)
    if not any(card[0] == "INCLUDE" for _, card in cards):
        if not content.nodes and not content.scalar:
            raise wrong(path, "entries GRID of nodes", "none")
        known = content.nodes.keys() | content.scalar
        used = (node for _, nodes in content.elements.values() for node in nodes)
        base.refuse_unknown_nodes(path, known, used)
    content.held |= content.chosen("SPC", control)
    content.followers |= content.chosen("MPC", control)
    return content


def _cards(text: str, first: int) -> list[tuple[int, list[str]]]:
    """Return the line where each entry begins, and its fields with empty ones behind the last."""
    cards: list[tuple[int, list[str]]] = []
    for number, raw in enumerate(text.splitlines(), start=first):
        line = raw.partition("$")[0].rstrip()
        if not line.strip():
            continue
        if line.lstrip().upper().startswith("ENDDATA"):
            break
        if "," in line:
            name, *fields = (part.strip() for part in line.split(","))
        else:
            line = line.expandtabs(8)
            name = line[:8].strip()
            width = 16 if "*" in name[:1] + name[-1:] else 8
            fields = [line[k : k + width].strip() for k in range(8, 72, width)]
        count = 4 if "*" in name[:1] + name[-1:] else 8  # of large fields, and of others
        fields = (fields + [""] * count)[:count]
        if name[:1] in ("", "+", "*"):
            if cards:
                cards[-1][1].extend(fields)
        else:
            cards.append((number, [name.rstrip("*").upper(), *fields]))
    return [(number, card + EMPTY) for number, card in cards]


def _components(text: str) -> list[int]:
    return [int(c) for c in text if c in "0123456"]


def _listed(fields: Iterable[str]) -> list[int]:
    """Return the numbers of a list in which ``a THRU b`` may stand."""
    items, out = iter([x for x in fields if x]), list[int]()
    for item in items:
        if item.upper() == "THRU":
            out += range(out[-1] + 1, int(next(items, "")) + 1)
        else:
            out.append(int(item))
    return out


def _all_of(components: str, fields: Iterable[str]) -> set[Dof]:
    return {(n, c) for n in _listed(fields) for c in _components(components or "0")}


def _pairs(card: list[str], first: int, step: int) -> set[Dof]:
    places = (k for k in range(first, len(card) - 1, step) if card[k])
    return {(int(card[k]), c) for k in places for c in _components(card[k + 1] or "0")}


def _take(content: Bulk, card: list[str], default: list[str]) -> None:
    name = card[0]
    if name.startswith("="):
        raise ValueError("a replication, which is not read: write its entries out")
    if name == "GRID":
        _grid(content, card, default)
    elif name == "SPOINT":
        content.scalar.update(_listed(card[1:]))
    elif name in _ELEMENTS:
        number, (first, most, cell, _) = int(card[1]), _ELEMENTS[name]
        nodes = [n for n in (int(x or 0) for x in card[first : first + most]) if n]
        if number in content.elements:
            raise ValueError(f"element {number} again")
        if len(nodes) < base.CORNERS[cell] and name != "CBUSH":  # one end of it may be the ground
            raise ValueError(f"{len(nodes)} nodes of {base.CORNERS[cell]}")
        content.elements[number] = name, nodes
    elif name.startswith(("CELAS", "CDAMP")):
        ends = [(int(card[k] or 0), int(card[k + 1] or 0)) for k in (3, 5)]
        if name.endswith(("3", "4")):  # between scalar points
            ends = [(int(card[k] or 0), 0) for k in (3, 4)]
            content.scalar.update(n for n, _ in ends if n)
        content.links.append(tuple(n for n, _ in ends if n))
        if not name.startswith("CDAMP"):
            content.springs += [(node, component) for node, component in ends if node and component]
    elif name in ("RBE2", "RBE3", "RBAR"):
        _rigid(content, card)
    elif name in ("SPCADD", "MPCADD"):
        content.added.setdefault((name[:3], int(card[1])), []).extend(_listed(card[2:]))
    elif name in ("SPC", "SPC1"):
        held = _all_of(card[2], card[3:]) if name == "SPC1" else _pairs(card[:8], 2, 3)
        content.sets.setdefault(("SPC", int(card[1])), set()).update(held)
    elif name == "MPC":
        terms = (*card[2::8], *card[5::8])  # two in a line of 8 fields: G, C, A, G, C, A
        content.links.append(tuple(int(x) for x in terms if x.isdigit()))
        follower = int(card[2]), int(card[3] or 0)
        content.sets.setdefault(("MPC", int(card[1])), set()).add(follower)
    elif name in ("ASET1", "OMIT1", "ASET", "OMIT"):
        target = content.kept if name.startswith("ASET") else content.omitted
        target |= _all_of(card[1], card[2:]) if name.endswith("1") else _pairs(card, 1, 2)


def _grid(content: Bulk, card: list[str], default: list[str]) -> None:
    number = int(card[1])
    if number in content.nodes:
        raise ValueError(f"node {number} again")
    content.held.update((number, c) for c in _components(card[7] or default[7]))
    if int(card[6] or default[6] or 0):
        content.turned.add(number)
    point = [fortran(x) if x else 0.0 for x in (card[3], card[4], card[5])]
    if not np.isfinite(point).all():
        raise ValueError(f"coordinates {', '.join(card[3:6])}")
    system = int(card[2] or default[2] or 0)
    content.nodes[number] = np.array(point if system == 0 else [np.nan] * 3)


def _rigid(content: Bulk, card: list[str]) -> None:
    if card[0] == "RBE2":
        nodes = _listed(x for x in card[4:] if "." not in x)
        content.followers.update((n, c) for n in nodes for c in _components(card[3]))
        content.links.append((int(card[2]), *nodes))
    elif card[0] == "RBE3":
        content.followers.update((int(card[3]), c) for c in _components(card[4]))
        content.links.append((int(card[3]), *(int(x) for x in card[5:] if x.isdigit())))
    else:
        ends = int(card[2]), int(card[3])
        content.links.append(ends)
        dependent = [_components(card[k]) for k in (6, 7)]
        if not any(dependent):  # what is not independent, as the manual says
            independent = [_components(card[k]) for k in (4, 5)]
            dependent = [[c for c in range(1, 7) if c not in some] for some in independent]
        for node, some in zip(ends, dependent, strict=True):
            content.followers.update((node, c) for c in some)
