"""Wrong structures: each is refused with a message that says where, and what was expected."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from typing import Any, cast

import numpy as np
import pytest
from structures import BOX, STEEL

from modefront import fem
from modefront.errors import InputError

ROUND = fem.circle(0.1)
X, LINE = fem.grids.line(np.zeros(3), np.array([1.0, 0, 0]), 4)
BEAM = fem.Structure(X, (fem.Beams("beam", LINE, STEEL, ROUND),), (fem.Support(0),))
PLATE_X, QUADS = fem.grids.plate(1.0, 1.0, 3, 3)
PLATE = fem.Structure(
    PLATE_X, (fem.Shells("plate", QUADS, STEEL, 0.01),), (fem.Support([0, 1, 2]),)
)
SWAPPED = QUADS.copy()
SWAPPED[4] = SWAPPED[4][[0, 2, 1, 3]]
BRICK = fem.Structure(
    BOX, (fem.Solids("block", np.arange(8)[None], STEEL),), (fem.Support([0, 1, 2, 3]),)
)
TETS_X, TETS = fem.grids.tetrahedra(BOX, np.arange(8)[None])


def _with_group(structure: fem.Structure, **changes: Any) -> fem.Structure:
    return replace(structure, groups=(replace(structure.groups[0], **changes),))


WRONG: dict[str, tuple[fem.Structure, str]] = {
    "no nodes": (replace(BEAM, nodes=np.zeros((0, 3))), r"nodes: expected the shape \(nodes, 3\)"),
    "nan": (replace(BEAM, nodes=X * np.nan), r"coordinates of node 0, found \[nan"),
    "cell of too many nodes": (_with_group(BEAM, cells=QUADS), r"group 'beam': expected cells"),
    "cell without node": (
        _with_group(BEAM, cells=LINE + 1),
        r"group 'beam': expected nodes from 0 to 4, found 5",
    ),
    "beam of no length": (
        _with_group(BEAM, cells=np.array([[0, 1], [2, 2]])),
        r"element 1 \(nodes 2, 2\): expected length > 0 .*, found zero length",
    ),
    "parallel orientation": (
        _with_group(BEAM, section=fem.rectangle(0.1, 0.2), orientation=(2.0, 0, 0)),
        r"orientation: expected a vector not parallel .* element 0",
    ),
    "no orientation": (
        _with_group(BEAM, section=fem.rectangle(0.1, 0.2)),
        r"group 'beam' orientation: expected a vector .*, found nothing",
    ),
    "no orientation of a shear centre": (
        _with_group(BEAM, section=fem.Section(1e-2, 1e-6, 1e-6, 1e-6, shear_centre=(0.02, 0.0))),
        r"group 'beam' orientation: expected a vector .*, found nothing",
    ),
    "bow-tie": (
        _with_group(PLATE, cells=SWAPPED),
        r"group 'plate' element 4 \(nodes 5, 10, 9, 6\): .* found (zero|negative) area",
    ),
    "inside out brick": (
        _with_group(BRICK, cells=np.array([[4, 5, 6, 7, 0, 1, 2, 3]])),
        r"group 'block' element 0 .* found negative volume",
    ),
    "inside out tetrahedron": (
        replace(BRICK, nodes=TETS_X, groups=(
            fem.Solids("block", TETS[:, [0, 2, 1, 3, 6, 5, 4, 7, 9, 8]], STEEL),)),
        r"negative volume; so 6 of 6",
    ),
    "linear tetrahedron": (
        _with_group(BRICK, cells=TETS[:, :4]),
        r"second-order .* 4 nodes, which are far too stiff",
    ),
    "missing group": (
        replace(PLATE, parameters=(fem.Parameter("t", "thickness", ("plat",)),)),
        r"parameter 't': .* has thickness: plate, found 'plat' \(did you mean 'plate'",
    ),
    "thickness of a beam": (
        replace(BEAM, parameters=(fem.Parameter("t", "thickness", ("beam",)),)),
        r"has thickness: none has, found 'beam'",
    ),
    "same name": (
        replace(BEAM, masses=(fem.Mass("beam", [1], 1.0),)),
        r"member 'beam': expected a name used once",
    ),
    "sensor far from nodes": (
        replace(BEAM, sensors=(fem.Sensor("tip", (1.0, 0.25, 0), "y"),)),
        r"sensor 'tip': expected a node within .* nearest is node 4 at \(1.0, .*, 0.25 away",
    ),
    "sensor at a support": (
        replace(BEAM, sensors=(fem.Sensor("foot", 0, "y"),)),
        r"sensor 'foot': expected a direction that can move",
    ),
    "sensor on a rotation of a solid": (
        replace(BRICK, sensors=(fem.Sensor("s", 6, "rx"),)),
        r"sensor 's': expected a direction that can move",
    ),
    "inertia": (
        replace(BEAM, masses=(fem.Mass("m", [1], 1.0, np.tri(3)),)),
        r"mass 'm' inertia: expected a symmetric matrix",
    ),
    "slave twice": (
        replace(BEAM, links=(fem.Link(1, [3]), fem.Link(2, [3]))),
        r"slave at node 3, x: expected one link, coupling .*, found another",
    ),
    "slave held": (replace(BEAM, links=(fem.Link(1, [0]),)), r"node 0, x: .* held by a support"),
    "circle of links": (
        replace(BEAM, links=(fem.Link(1, [2]), fem.Link(2, [3]), fem.Link(3, [1]))),
        r"slave at node \d, x: expected a master that does not follow it",
    ),
    "no support": (replace(BEAM, supports=()), r"mechanism: .* 5 nodes .*\(6 independent"),
    "hinge": (
        replace(BEAM, supports=(fem.Support(0, ("x", "y", "z")),)),
        r"mechanism: .* 5 nodes .* can move freely in .*3 independent motions",
    ),
    "spins": (
        replace(BEAM, supports=(fem.Support([0, 4], ("x", "y", "z")),)),
        r"freely in rx \(1 independent",
    ),
    "unmerged nodes": (
        replace(BEAM, nodes=np.concatenate([X, X[2:3]]), groups=(
            fem.Beams("beam", np.array([[0, 1], [1, 2], [5, 3], [3, 4]]), STEEL, ROUND),)),
        r"mechanism: .* 3 nodes \(3, 4, 5\).*2 parts.*same place.*merge",
    ),
    "mass in the air": (
        replace(BEAM, nodes=np.concatenate([X, [[5.0, 5, 5]]]), masses=(
            fem.Mass("m", [5], 1.0),)),
        r"mechanism: .* 1 nodes \(5\).* in x, y, z \(3 independent",
    ),
    "beam on a solid": (
        fem.Structure(
            np.concatenate([BOX, [[1.0, 1, 2]]]),
            (*BRICK.groups, fem.Beams("mast", np.array([[6, 8]]), STEEL, ROUND)),
            BRICK.supports,
        ),
        r"mechanism: .* 2 nodes \(6, 8\).*\(3 independent",
    ),
    "solids joined at an edge": (
        fem.Structure(
            np.concatenate([BOX, BOX[[1, 2, 5, 6]] + [1, 0, 1], [[1, 0, 2], [1, 1, 2]]]),
            (fem.Solids("s", np.array([[0, 1, 2, 3, 4, 5, 6, 7], [5, 8, 9, 6, 12, 10, 11, 13]]),
                        STEEL),),
            BRICK.supports,
        ),
        r"\(1 independent",
    ),
    "all held": (replace(BEAM, supports=(fem.Support(np.arange(5)),)), r"that is free, found none"),
}  # fmt: skip


@pytest.mark.parametrize("name", list(WRONG))
def test_refused_with_a_message(name: str) -> None:
    structure, message = WRONG[name]
    with pytest.raises(InputError) as caught:
        fem.assemble(structure)
    assert re.search(message, str(caught.value)), str(caught.value)


def test_the_models_that_were_broken_above_are_right() -> None:
    for structure in (BEAM, PLATE, BRICK):
        fem.assemble(structure)
    fem.assemble(replace(BRICK, nodes=TETS_X, groups=(fem.Solids("block", TETS, STEEL),)))


def test_floating_allows_the_motion_of_the_whole_only() -> None:
    fem.assemble(replace(BEAM, supports=()), floating=True)
    fem.assemble(replace(BRICK, supports=()), floating=True)
    fem.assemble(BEAM, floating=True)
    two = fem.Structure(
        np.concatenate([X, X + np.array([0, 1, 0])]),
        (fem.Beams("beam", np.concatenate([LINE, LINE + 5]), STEEL, ROUND),),
    )
    with pytest.raises(InputError, match="falls into 2 parts"):
        fem.assemble(two, floating=True)
    joined = replace(two, springs=(fem.Spring("k", [0], 1.0, to=[5]),))
    with pytest.raises(InputError, match="mechanism"):
        fem.assemble(joined, floating=True)
    bushing = tuple(fem.Spring(f"k{d}", [2], 1.0, d, to=[7]) for d in ("y", "rx", "ry", "rz"))
    rails = (fem.Link(2, [7], ("x", "z")),)
    fem.assemble(replace(two, springs=bushing, links=rails), floating=True)


def test_partly_held_floating_structure_keeps_its_free_motion() -> None:
    spinning = replace(BEAM, supports=(fem.Support([0, 4], ("x", "y", "z")),))
    model = fem.assemble(spinning, floating=True)
    assert len(model.dofs.free) == 24


BRACES = np.array([[0, 2], [1, 3], [2, 4], [3, 5], [0, 5]])


@pytest.mark.parametrize(
    "inner",
    [
        {"groups": (fem.Trusses("braces", BRACES, STEEL, 1e-4),)},
        {"springs": (fem.Spring("k", [1, 2], 1e4, to=[4, 5]),)},
        {"links": (fem.Link(1, [4]),)},
    ],
)
@pytest.mark.parametrize("supports", [(), (fem.Support(0, ("x", "y", "z", "rx", "ry")),)])
def test_what_strains_nothing_within_a_rigid_body_holds_nothing(
    supports: tuple[fem.Support, ...], inner: dict[str, Any]
) -> None:
    nodes = np.random.default_rng(1).normal(size=(6, 3))
    frame = fem.Beams("frame", np.column_stack([np.arange(5), np.arange(1, 6)]), STEEL, ROUND)
    known = {"groups": (), **inner}
    known["groups"] = (frame, *known["groups"])
    free = 6 if not supports else 1
    with pytest.raises(InputError, match=rf"mechanism: .*\({free} independent motions\)"):
        fem.assemble(fem.Structure(nodes, supports=supports, **known))


def test_a_large_mesh_of_unmerged_elements_is_refused() -> None:
    nodes, quads = fem.grids.plate(1.0, 1.0, 60, 60)
    apart = nodes[quads].reshape(-1, 3)
    cells = np.arange(len(apart)).reshape(-1, 4)
    with pytest.raises(InputError, match="merge them"):
        fem.assemble(
            fem.Structure(
                apart, (fem.Shells("p", cells, STEEL, 0.01),), (fem.Support([0, 1, 2, 3]),)
            )
        )


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: fem.Material(-1.0, 0.3, 1.0), "E: expected Young's modulus above 0, found -1"),
        (lambda: fem.Material(1.0, 0.5, 1.0), "nu: expected Poisson's ratio between"),
        (lambda: fem.Material(1.0, 0.3, float("nan")), "rho: expected a density of 0 or more"),
        (lambda: fem.Section(1.0, 1.0, 0.0, 1.0), "I_z: expected a number above 0, found 0"),
        (lambda: fem.hollow_rectangle(0.1, 0.1, 0.05), "wall: expected less than"),
        (lambda: fem.tube(0.1, 0.06), "wall: expected between"),
        (lambda: _with_group(PLATE, thickness=0.0), "thickness: expected a thickness above 0"),
        (
            lambda: fem.Parameter("t", cast(Any, "width"), ("beam",)),
            "quantity: expected one of 'E'",
        ),
        (lambda: fem.Parameter("t", "E", "beam"), "of: expected a list .*, found 'beam'"),
        (lambda: fem.Support(0, ("w",)), r"directions: expected a list of x, .*, found \['w'\]"),
        (lambda: fem.Sensor("s", 0, "w"), "direction: expected one of x, -x, .*, found 'w'"),
        (lambda: fem.Spring("k", [1], -1.0, "x"), "stiffness: expected a stiffness above 0"),
        (lambda: fem.Mass("m", [1], -1.0), "mass: expected a mass of 0 or more"),
    ],
)
def test_properties_out_of_range(make: Callable[[], object], message: str) -> None:
    with pytest.raises(InputError, match=message):
        make()


def test_sections_against_known_constants() -> None:
    # Saint-Venant: J = 0.1406 a^4 for a square, 0.2287 a b^3 for 2 : 1.
    assert fem.rectangle(1.0, 1.0).J == pytest.approx(0.14058, rel=1e-4)
    assert fem.rectangle(2.0, 1.0).J == pytest.approx(2 * 0.22868, rel=1e-4)
    assert fem.rectangle(1.0, 2.0).J == fem.rectangle(2.0, 1.0).J
    assert fem.rectangle(0.2, 0.1).I_z == pytest.approx(0.1 * 0.2**3 / 12)
    assert fem.tube(0.2, 0.01).A == pytest.approx(np.pi * 0.19 * 0.01)
    assert fem.circle(2.0).J == pytest.approx(np.pi / 2)
    box = fem.hollow_rectangle(0.2, 0.1, 0.001)
    assert box.A == pytest.approx(2 * 0.001 * (0.199 + 0.099))
    assert box.J == pytest.approx(4 * (0.199 * 0.099) ** 2 / (2 * (0.199 + 0.099) / 0.001))
