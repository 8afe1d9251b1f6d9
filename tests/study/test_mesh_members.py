"""Members of a study file are those of Python, and their parameters have exact derivatives."""

from __future__ import annotations

import tomllib
from pathlib import Path

import numpy as np
import pytest

import modefront as mf
from modefront import fem
from modefront.options import Table
from modefront.study.kinds.mesh import read_mesh_model

meshio = pytest.importorskip("meshio")

MAST = """\
file = "mast.msh"

[material]
steel = { E = 210e9, nu = 0.3, rho = 7850.0 }

[[group]]
name = "mast"
elements = "beam"
material = "steel"
orientation = [0.0, 1.0, 0.0]
offsets = [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]
releases = [["ry"], []]

[group.section]
shape = "constants"
A = 2e-3
I_y = 4e-6
I_z = 3e-6
J = 1e-6
kappa_y = 0.5
kappa_z = 0.4
shear_centre = [0.01, -0.02]

[[group]]
name = "upper"
elements = "beam"
material = "steel"
section = { shape = "tube", diameter = 0.1, wall = 0.01 }

[[group]]
name = "guys"
elements = "truss"
material = "steel"
area = 5e-5
force = 4e3

[[support]]
nodes = [3, 4]

[[support]]
nodes = 5
axes = [[1.0, 1.0, 0.0], [0.0, 0.0, 1.0]]

[[spring]]
name = "foot"
nodes = 0
stiffness = [1e7, 1e7, 1e8, 1e5, 2e5, 1e5]
axes = [[1.0, 0.5, 0.0], [0.0, 1.0, 0.0]]

[[spring]]
name = "stays"
nodes = [3, 4]
to = [1, 1]
stiffness = 1e5

[[mass]]
name = "ice"
nodes = 2
mass = [3.0, 3.0, 5.0]

[[mass]]
name = "lamp"
nodes = 6
mass = 2.0

[[coupling]]
node = 6
of = [1, 2]
weights = [1.0, 2.0]
directions = ["x", "y", "z"]

[[load]]
name = "weight"
nodes = 2
force = [0.0, 0.0, -500.0]
acceleration = [0.0, 0.0, -9.81]
strains = { guys = -1e-4 }

[sensors]
top = { node = 2, direction = "x" }

[scale]
tension = { quantity = "prestress", of = ["guys"] }
snow = { quantity = "prestress", of = ["weight"] }
foot = { quantity = "spring", of = ["foot"] }
ice = { quantity = "mass", of = ["ice"] }
E = { quantity = "E", of = ["mast", "upper"] }
rho = { quantity = "density", of = ["guys"] }
"""

NODES = np.array(
    [[0, 0, 0], [0, 0, 2], [0, 0, 4], [3, 0, 0], [-2, 3, 0], [-2, -3, 0], [0, 0, 3]], dtype=float
)
BEAMS, GUYS = np.array([[0, 1], [1, 2]]), np.array([[3, 2], [4, 2], [5, 2]])
NAMES = ("tension", "snow", "foot", "ice", "E", "rho")

STEEL = fem.Material(E=210e9, nu=0.3, rho=7850.0)
SECTION = fem.Section(2e-3, 4e-6, 3e-6, 1e-6, 0.5, 0.4, (0.01, -0.02))
IN_PYTHON = fem.Structure(
    NODES,
    groups=(
        fem.Beams("mast", BEAMS[:1], STEEL, SECTION, (0, 1, 0), releases=(("ry",), ())),
        fem.Beams("upper", BEAMS[1:], STEEL, fem.tube(0.1, 0.01)),
        fem.Trusses("guys", GUYS, STEEL, 5e-5, force=4e3),
    ),
    supports=(fem.Support([3, 4]), fem.Support(5, axes=((1, 1, 0), (0, 0, 1)))),
    springs=(
        fem.Spring("foot", 0, (1e7, 1e7, 1e8, 1e5, 2e5, 1e5), axes=((1, 0.5, 0), (0, 1, 0))),
        fem.Spring("stays", [3, 4], 1e5, to=[1, 1]),
    ),
    masses=(fem.Mass("ice", 2, (3.0, 3.0, 5.0)), fem.Mass("lamp", 6, 2.0)),
    couplings=(fem.Coupling(6, [1, 2], [1.0, 2.0], ("x", "y", "z")),),
    loads=(fem.Load("weight", 2, (0, 0, -500.0), (0, 0, -9.81), {"guys": -1e-4}),),
    sensors=(fem.Sensor("top", 2, "x"),),
    parameters=(
        fem.Parameter("tension", "prestress", ("guys",)),
        fem.Parameter("snow", "prestress", ("weight",)),
        fem.Parameter("foot", "spring", ("foot",)),
        fem.Parameter("ice", "mass", ("ice",)),
        fem.Parameter("E", "E", ("mast", "upper")),
        fem.Parameter("rho", "density", ("guys",)),
    ),
)


def test_members_of_a_file_are_those_of_python(tmp_path: Path) -> None:
    tags = np.array([1, 2, 3, 3, 3])
    meshio.Mesh(
        NODES,
        [("line", np.concatenate([BEAMS, GUYS]))],
        cell_data={"gmsh:physical": [tags], "gmsh:geometrical": [tags]},
        field_data={name: np.array([n, 1]) for n, name in enumerate(("mast", "upper", "guys"), 1)},
    ).write(tmp_path / "mast.msh", file_format="gmsh22", binary=False)
    faults: list[mf.errors.Fault] = []
    table = Table(str(tmp_path / "study.toml"), "[model]", tomllib.loads(MAST), faults)
    model = read_mesh_model(table, NAMES)
    table.close()
    assert faults == []
    assert model is not None
    expected = mf.mesh_model(IN_PYTHON, NAMES)
    theta = np.array([0.8, 1.3, 1.1, 0.9, 1.05, 1.2])
    found = [each.modes(theta, 4) for each in (model, expected)]
    assert found[0].frequency == pytest.approx(found[1].frequency, rel=1e-10)


def test_derivatives_by_all_quantities_are_exact() -> None:
    model = mf.mesh_model(IN_PYTHON, NAMES)
    theta = np.array([0.8, 1.3, 1.1, 0.9, 1.05, 1.2])
    modes = model.modes(theta, 4)
    for n in range(len(NAMES)):
        step = np.zeros(len(theta))
        step[n] = 1e-4
        up, down = (model.modes(theta + sign * step, 4).frequency for sign in (1, -1))
        slope = (up - down) / 2e-4
        scale = abs(modes.dfrequency).max()
        assert modes.dfrequency[:, n] == pytest.approx(slope, rel=1e-6, abs=1e-8 * scale)
        assert abs(slope).max() > 0
