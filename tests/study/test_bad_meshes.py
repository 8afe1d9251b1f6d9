"""All faults of a mesh, and of a study on it, are in one message."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from refusals import Check, command, edited, refuses

from modefront import fem

meshio = pytest.importorskip("meshio")

STUDY = """\
[study]
name = "plate on a beam"

[data]
file = "modes.csv"

[model]
kind = "mesh"
file = "mesh.msh"

[model.material]
steel = { E = 210e9, nu = 0.3, rho = 7850.0 }

[[model.group]]
name = "plate"
elements = "shell"
material = "steel"
thickness = 0.01

[[model.group]]
name = "edge"
elements = "beam"
material = "steel"
section = { shape = "rectangle", b_y = 0.02, b_z = 0.04 }
orientation = [0.0, 0.0, 1.0]

[[model.support]]
nodes = "edge"

[[model.spring]]
name = "prop"
nodes = 24
stiffness = 1e5
direction = "z"

[[model.mass]]
name = "tip"
nodes = [20]
mass = 0.5

[[model.link]]
master = 22
slaves = [21, 23]

[model.sensors]
left = { node = 20, direction = "z" }
right = { at = [1.0, 1.0, 0.0], direction = "z" }

[model.scale]
E = { quantity = "E", of = ["plate"] }
m = { quantity = "mass", of = ["tip"] }

[[parameter]]
name = "E"
nominal = 1.0
bounds = [0.5, 2.0]

[[parameter]]
name = "m"
nominal = 1.0
bounds = [0.5, 2.0]

[[group]]
name = "all"
frequency = "all"
shape = "all"
"""

DATA = "set,mode,frequency,damping,left,right\na,1,8,,1,1\na,2,20,,1,-1\n"

X, QUADS = fem.grids.plate(1.0, 1.0, 4, 4)
EDGE = np.array([[0, 1], [1, 2], [2, 3], [3, 4]])


def write_mesh(path: Path, nodes: np.ndarray = X, quads: np.ndarray = QUADS) -> None:
    """Write the plate with its edge, cells named as in the study."""
    tags = [np.full(len(EDGE), 1), np.full(len(quads), 2)]
    meshio.Mesh(
        nodes,
        [("line", EDGE), ("quad", quads)],
        cell_data={"gmsh:physical": tags, "gmsh:geometrical": tags},
        field_data={"edge": np.array([1, 1]), "plate": np.array([2, 2])},
    ).write(path, file_format="gmsh22", binary=False)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with a study of a mesh in which nothing is wrong."""
    (tmp_path / "study.toml").write_text(STUDY)
    (tmp_path / "modes.csv").write_text(DATA)
    write_mesh(tmp_path / "mesh.msh")
    return tmp_path


def test_the_study_that_the_rest_is_made_from_is_right(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert command("check", folder / "study.toml") == 0, capsys.readouterr().err
    assert capsys.readouterr().err == ""


STEEL = "steel = { E = 210e9, nu = 0.3, rho = 7850.0 }"
SHELL = 'elements = "shell"'
SECTION = 'section = { shape = "rectangle", b_y = 0.02, b_z = 0.04 }'
SUPPORT = '[[model.support]]\nnodes = "edge"\n'
LEFT = 'left = { node = 20, direction = "z" }'
RIGHT = 'right = { at = [1.0, 1.0, 0.0], direction = "z" }'
SCALE = 'E = { quantity = "E", of = ["plate"] }'

WRONG = [
    ('file = "mesh.msh"', "", "[model] file: expected the name of a mesh file, found nothing"),
    ('"mesh.msh"', '"no.msh"', "no.msh: file: expected a mesh, found no such file"),
    ('"mesh.msh"', '"modes.csv"', "modes.csv: file: expected a mesh that meshio can read, found "),
    ('"mesh.msh"', '"mesh.msh"\nfloating = 1', "[model] floating: expected true or false, found 1"),
    ('"mesh.msh"', '"mesh.msh"\nflotin = true', "expected a known key, found 'flotin' (did you me"),
    (STEEL, "", "[model] material: expected at least one material, found none"),
    (STEEL, "steel = 1", "steel: expected a table E, nu, rho, found 1"),
    ("E = 210e9", "E = 0", "steel E: expected Young's modulus above 0, found 0"),
    ("nu = 0.3", "nu = 0.5", "steel nu: expected Poisson's ratio between -1 and 0.5, found 0.5"),
    ("E = 210e9, nu = 0.3", "E = [1, 1, 1], nu = [0, 0, 0]", "steel G: expected three values of G"),
    (
        "E = 210e9, nu = 0.3",
        "E = [1, 1, 1], nu = [2, 0, 0], G = [1, 1, 1]",
        "steel nu: expected ratios that leave the elasticity positive definite, found ",
    ),
    (
        "E = 210e9, nu = 0.3",
        "E = [1, 1, 1], nu = [0, 0, 0], G = [1, 1, 1]",
        "group 'plate' direction: expected that along which axis 1 of the material is, found no",
    ),
    ("rho = 7850.0", "rho = -1", "steel rho: expected a density of 0 or more, found -1"),
    ("rho = 7850.0", "roh = 7850", "steel: expected a known key, found 'roh' (did you mean 'rho'?"),
    (
        'name = "plate"',
        'name = "plat"',
        "name: expected a group of the mesh (edge, plate), found 'plat'",
    ),
    ('name = "plate"', "name = 1", "name: expected the name of a group of cells, found 1"),
    (
        SHELL,
        'elements = "shel"',
        "elements: expected one of 'beam', 'truss', 'shell', 'solid', found",
    ),
    (
        SHELL,
        'elements = "solid"',
        "name: expected a group of the mesh with ... for a solid, found 'plate' with cells of",
    ),
    (
        '"steel"\nthickness',
        '"iron"\nthickness',
        "material: expected one of 'steel', found 'iron'",
    ),
    (
        "thickness = 0.01",
        "thickness = -0.01",
        "thickness: expected a thickness above 0, found -0.0",
    ),
    ("thickness = 0.01", "", "thickness: expected a thickness above 0, found nothing"),
    (
        "thickness = 0.01",
        "thickness = 0.01\noffset = nan",
        "offset: expected a distance, found nan",
    ),
    (SECTION, "", "section: expected a table with shape = rectangle,  ... found nothing"),
    ('"rectangle"', '"square"', "section shape: expected one of 'rectangle' ... found 'square'"),
    ("b_y = 0.02", "b_y = 0", "section b_y: expected a number above 0, found 0"),
    ("b_y = 0.02, ", "", "section b_y: expected a number above 0, found nothing"),
    (
        '"rectangle", b_y = 0.02, b_z = 0.04',
        '"hollow_rectangle", b_y = 0.02, b_z = 0.04, wall = 0.02',
        "section wall: expected less than 0.01, found 0.02",
    ),
    (
        "[0.0, 0.0, 1.0]",
        "[0.0, 1.0]",
        "orientation: expected a vector of 3 numbers, not all of them 0, found [0.0, 1.",
    ),
    (
        "[0.0, 0.0, 1.0]",
        "[0.0, 1.0, 0.0]",
        "orientation: expected a vector not parallel to the axis of element 0 ... found ",
    ),
    (
        "orientation = [0.0, 0.0, 1.0]\n",
        "",
        "group 'edge' orientation: expected a vector in the plane ... found nothing, and the s",
    ),
    (
        'nodes = "edge"',
        'nodes = "egde"',
        "nodes: expected a group or node set of the mesh (edge, plate), found",
    ),
    (
        'nodes = "edge"',
        "nodes = []",
        "nodes: expected a node counted from 0, the name of a group or",
    ),
    ('nodes = "edge"', "nodes = 25", "nodes: expected nodes from 0 to 24 ... , found 25"),
    ('nodes = "edge"', 'nodes = "edge"\ndirections = ["w"]', "directions: expected a list of x, y"),
    ("stiffness = 1e5", "stiffness = 0", "('prop') stiffness: expected a stiffness above 0, or 6"),
    ("stiffness = 1e5", "stiffness = [1, 2]", "expected a stiffness above 0, or 6 of 0 or more, "),
    (
        'direction = "z"\n\n[[model.mass]]',
        'direction = "q"\n\n[[model.mass]]',
        "expected one of x,",
    ),
    ("mass = 0.5", "mass = -0.5", "('tip') mass: expected a mass of 0 or more, or 3"),
    (SECTION, f'{SECTION}\nreleases = ["rz"]', "releases: expected a list for either end, of x, y"),
    (SECTION, f"{SECTION}\noffsets = [0, 0, 1]", "offsets: expected a vector of 3 numbers for ei"),
    (SECTION, f'{SECTION}\nforce = "x"', "force: expected an axial force, found 'x'"),
    ('elements = "beam"', 'elements = "truss"', "area: expected an area above 0, found nothing"),
    (SUPPORT, f"{SUPPORT}axes = [[1, 0, 0], [1, 0, 0]]\n", "axes: expected two vectors [[...], "),
    ("[[model.link]]", "[[model.coupling]]", "node: expected a node counted from 0, the name of"),
    (
        "[[model.link]]\nmaster = 22\nslaves = [21, 23]",
        "[[model.coupling]]\nnode = 22\nof = [21, 23]\nweights = [1]",
        "coupling 0: expected other nodes than 22, with a weight above 0 for each",
    ),
    (
        "[[model.link]]",
        '[[model.load]]\nname = "P"\nnodes = 20\n[[model.link]]',
        "load 'P': expected nodes and a force on them, found one without the other",
    ),
    (
        "[[model.link]]",
        '[[model.load]]\nname = "P"\nstrains = { edge = "hot" }\n[[model.link]]',
        "('P') strains edge: expected a strain, found 'hot'",
    ),
    ("mass = 0.5", "mass = 0.5\ninertia = [1.0]", "inertia: expected 3 moments of inertia of 0 or"),
    ("mass = 0.5", "mass = 0.5\noffset = 1.0", "offset: expected a vector of 3 numbers, found 1.0"),
    ("master = 22", "master = [22, 20]", "master: expected one node, found 2 nodes"),
    ("master = 22", "master = 99", "master: expected nodes from 0 to 24, found 99"),
    ("slaves = [21, 23]", "", "slaves: expected a node counted from 0,  ... found nothing"),
    (
        LEFT,
        "left = 20",
        "[model] sensors left: expected a table node or at, and direction, found 20",
    ),
    (LEFT, 'left = { direction = "z" }', "sensors left: expected either node or at, found neither"),
    (
        LEFT,
        "left = { node = 20 }",
        "sensors left direction: expected one of x, -x ... found nothing",
    ),
    (
        LEFT,
        'left = { node = 99, direction = "z" }',
        "sensor 'left': ... nodes from 0 to 24, found 99",
    ),
    (RIGHT, 'right = { at = [9.0, 9.0, 9.0], direction = "z" }', "sensor 'right': ... "),
    (
        RIGHT,
        'right = { at = [1.0, 1.0], direction = "z" }',
        "right at: expected 3 coordinates, foun",
    ),
    (
        SCALE,
        'E = { quantity = "e", of = ["plate"] }',
        "E quantity: expected one of 'E', 'density',",
    ),
    (
        SCALE,
        'E = { quantity = "E", of = ["plat"] }',
        "parameter 'E': expected the name of what has E: edge, plate, found 'plat' (did you mean",
    ),
    (
        SCALE,
        'E = { quantity = "E", of = [] }',
        "E of: expected a list of groups, springs, masses or loads",
    ),
    (SCALE, 'F = { quantity = "E", of = ["plate"] }', "F: expected the name of a parameter, found"),
    (SCALE, "", "[[parameter]] 'E': expected a parameter that the model uses, found no use of it"),
]


test_a_study_of_a_mesh_with_something_wrong = refuses(*WRONG, study=STUDY)


def test_a_structure_that_can_move_is_refused_with_its_motion(folder: Path, refused: Check) -> None:
    (folder / "wrong.toml").write_text(
        edited(STUDY, (SUPPORT, '[[model.support]]\nnodes = 0\ndirections = ["x", "y", "z"]\n'))
    )
    refused(
        folder / "wrong.toml",
        "[model] mechanism: expected every part to be held by supports, springs or links, found ",
    )


def test_cells_that_share_no_nodes_are_named(folder: Path, refused: Check) -> None:
    far = np.concatenate([X, X + np.array([5.0, 0, 0])])
    write_mesh(folder / "mesh.msh", far, np.concatenate([QUADS, QUADS + len(X)]))
    refused(
        folder / "study.toml",
        "[model] mechanism: ... 25 nodes (25, 26, ... 2 parts that nothing connects",
    )


def test_elements_turned_inside_out_are_named(folder: Path, refused: Check) -> None:
    quads = QUADS.copy()
    quads[3] = quads[3][[0, 2, 1, 3]]
    write_mesh(folder / "mesh.msh", quads=quads)
    refused(folder / "study.toml", "group 'plate' element 3 ")


@pytest.mark.parametrize(
    "content", [b"", b"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n", b"\xff\xfe\x00"]
)
def test_files_that_are_no_mesh(content: bytes, folder: Path, refused: Check) -> None:
    (folder / "mesh.msh").write_bytes(content)
    refused(folder / "study.toml", "mesh.msh: file: expected ... found ")
