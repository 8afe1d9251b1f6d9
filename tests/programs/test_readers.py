"""Each format is read as its writer has written it, and faulty files are refused in words."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import scipy.io
from program_files import (
    Array,
    dense,
    labels,
    structure,
    write_abaqus,
    write_ansys,
    write_calculix,
    write_dmig,
    write_op4,
    write_op4_text,
    write_opensees,
)

from modefront.errors import InputError
from modefront.models.dofs import DofTable, write_dofs
from modefront.programs import PROGRAMS
from modefront.programs.base import Job, JobOptions, read_job
from modefront.programs.nastran import read_bulk

K, M = structure()


def read(program: str, path: Path, options: JobOptions | None = None) -> Job:
    return read_job(program, path, options or JobOptions())


def assert_same(job: Job, tolerance: float = 1e-13, K: Array = K, M: Array = M) -> None:
    """The job has the matrices of the structure, whatever the order of its rows."""
    order = np.arange(job.dofs.size)
    if (job.dofs.node > 0).any():
        rows = list(zip(job.dofs.node.tolist(), job.dofs.direction.tolist(), strict=True))
        order = np.array([rows.index(label) for label in labels()])
    for result, right in ((job.stiffness, K), (job.mass, M)):
        A = dense(result)[np.ix_(order, order)]
        assert np.abs(A - right).max() <= tolerance * np.abs(right).max()


def refused(program: str, path: Path, message: str) -> None:
    with pytest.raises(InputError, match=message):
        read(program, path)


# Nastran


@pytest.mark.parametrize("form", ["dense", "sparse", "bigmat"])
@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("long", [False, True])
def test_binary_output4(tmp_path: Path, form: str, order: str, long: bool) -> None:
    write_op4(tmp_path / "a.op4", {"KAA": K, "MAA": M}, form, order=order, long=long)
    job = read("nastran", tmp_path / "a.op4")
    assert_same(job)
    assert not (job.dofs.node > 0).any()
    assert any("sensors can be given by degrees of freedom only" in note for note in job.notes)


@pytest.mark.parametrize("form", ["dense", "sparse", "bigmat"])
def test_single_precision_is_known_as_such(tmp_path: Path, form: str) -> None:
    write_op4(tmp_path / "a.op4", {"KAA": K, "MAA": M}, form, single=True)
    job = read("nastran", tmp_path / "a")
    assert_same(job, 1e-7)
    assert job.precision > 1e-8


@pytest.mark.parametrize("form", ["dense", "sparse", "bigmat"])
@pytest.mark.parametrize(("digits", "end"), [(16, "\n"), (9, "\n"), (16, "\r\n")])
def test_output4_as_text(tmp_path: Path, form: str, digits: int, end: str) -> None:
    write_op4_text(tmp_path / "a.op4", {"KAA": K, "MAA": M}, form, digits=digits, end=end)
    job = read("nastran", tmp_path / "a.op4")
    assert_same(job, 2 * 10.0**-digits + 1e-15)
    assert job.precision >= 10.0**-digits


def test_exponents_of_three_digits_have_no_letter_in_text(tmp_path: Path) -> None:
    small = K.copy()
    small[0, 1] = small[1, 0] = 1.5e-105
    small[3, 4] = small[4, 3] = -2.5e-123
    write_op4_text(tmp_path / "a.op4", {"KAA": small, "MAA": M}, "bigmat")
    assert "1.5000000000000000-105" in (tmp_path / "a.op4").read_text()
    result = dense(read("nastran", tmp_path / "a.op4").stiffness)
    assert (result[0, 1], result[3, 4]) == (1.5e-105, -2.5e-123)


def test_matrices_are_chosen_by_name(tmp_path: Path) -> None:
    write_op4(tmp_path / "a.op4", {"K2": K, "MX": M, "KAA": 2 * K, "MAA": M}, "dense")
    assert_same(read("nastran", tmp_path / "a.op4", JobOptions("k2", "MX")))
    assert_same(read("nastran", tmp_path / "a.op4"), K=2 * K)
    write_op4(tmp_path / "a.op4", {"KAA": K, "PHI": M}, "dense")
    refused("nastran", tmp_path / "a.op4", "a matrix 'MAA', found matrices KAA, PHI")


@pytest.mark.parametrize("cut", [1, 30, 200, 1000])
@pytest.mark.parametrize("text", [False, True])
def test_output4_that_is_cut_off(tmp_path: Path, cut: int, text: bool) -> None:
    path = tmp_path / "a.op4"
    (write_op4_text if text else write_op4)(path, {"KAA": K, "MAA": M}, "bigmat")
    path.write_bytes(path.read_bytes()[: -cut - 40])
    refused("nastran", path, "cut off|expected")


def test_nodes_of_output4_may_come_from_a_table(tmp_path: Path) -> None:
    write_op4(tmp_path / "a.op4", {"KAA": K, "MAA": M}, "sparse")
    nodes, directions = np.array(labels()).T
    write_dofs(tmp_path / "dofs.csv", DofTable(nodes, directions, np.ones(nodes.size)))
    job = read("nastran", tmp_path / "a.op4", JobOptions(dofs=tmp_path / "dofs.csv"))
    assert_same(job)
    assert job.dofs.sensor(40, "-z") == [(11, -1.0)]
    (tmp_path / "short.csv").write_text("node,direction\n3,x\n")
    with pytest.raises(
        InputError, match=r"short\.csv: file: expected 15 rows, one a row of the matrices, found 1"
    ):
        read("nastran", tmp_path / "a.op4", JobOptions(dofs=tmp_path / "short.csv"))


def test_dmig(tmp_path: Path) -> None:
    write_dmig(tmp_path / "a.pch", {"KAAX": K, "MAAX": M}, labels())
    job = read("nastran", tmp_path / "a.pch")
    assert_same(job, 2e-9)
    assert job.precision == pytest.approx(1e-9)
    assert (job.dofs.node > 0).any()
    path = tmp_path / "a.pch"
    path.write_bytes(path.read_bytes()[:-7])
    refused("nastran", path, "cut off")


# CalculiX


def test_calculix(tmp_path: Path) -> None:
    write_calculix(tmp_path / "a", K, M, labels())
    for name in ("a", "a.inp", "a.sti"):
        assert_same(read("calculix", tmp_path / name), 1e-13)


@pytest.mark.parametrize("suffix", [".sti", ".mas", ".dof"])
def test_calculix_that_failed_or_was_cut_off(tmp_path: Path, suffix: str) -> None:
    write_calculix(tmp_path / "a", K, M, labels())
    path = tmp_path / f"a{suffix}"
    whole = path.read_text().splitlines(keepends=True)
    path.write_text("".join(whole[:-2]))
    refused("calculix", tmp_path / "a", "cut off|rows and columns from 1")
    path.write_text("".join(whole)[:-3])
    refused("calculix", tmp_path / "a", "cut off|numbers in every line|rows and columns|entries")
    path.write_text("".join(whole).replace("1", "x"))
    refused("calculix", tmp_path / "a", "expected")
    path.write_text("")
    refused("calculix", tmp_path / "a", "an empty file")
    path.unlink()
    refused("calculix", tmp_path / "a", "MATRIXSTORAGE.*status 0.*no such file")


def test_a_line_of_calculix_that_is_no_row_is_shown(tmp_path: Path) -> None:
    write_calculix(tmp_path / "a", K, M, labels())
    (tmp_path / "a.inp").write_text("*STEP\n")
    refused("calculix", tmp_path / "a", r"a\.inp: file: expected nodes \(\*NODE\), found none")
    (tmp_path / "a.inp").write_text("*NODE, INPUT=nodes.inp\n")
    assert read("calculix", tmp_path / "a").mesh is not None
    file = tmp_path / "a.sti"
    lines = file.read_text().splitlines()
    for wrong in ("5 x 1.0", "5 6", "5 6 1.0 1.0", "5 6 1.0e"):
        file.write_text("\n".join([*lines[:4], wrong, *lines[5:]]) + "\n")
        refused("calculix", tmp_path / "a", rf"line 5: expected 3 numbers.*, found '{wrong}'$")


def test_supports_of_calculix_along_turned_axes_hold_none_of_the_model(tmp_path: Path) -> None:
    write_calculix(tmp_path / "a", K, M, labels())
    nodes = "".join(f"{node}, {node}., 0., 0.\n" for node in {node for node, _ in labels()})
    support = "*NSET, NSET=RING\n3\n*BOUNDARY\nRING, 1, 1\n"
    (tmp_path / "a.inp").write_text(f"*NODE\n{nodes}{support}")
    with pytest.raises(LookupError, match=r"node 3 can move .y, z."):
        read("calculix", tmp_path / "a").dofs.sensor(3, "x")
    turned = "*TRANSFORM, NSET=RING, TYPE=C\n0., 0., 0., 0., 0., 1.\n"
    (tmp_path / "a.inp").write_text(f"*NODE\n{nodes}{support}{turned}")
    read("calculix", tmp_path / "a").dofs.sensor(3, "x")


def test_nodes_that_calculix_expands_are_means(tmp_path: Path) -> None:
    names = [(9, 3), (5, 1), (5, 3), (5, 1), (5, 3), (9, 3), (9, 3), (11, 1), (11, 3), (11, 3)]
    A = np.diag(np.arange(1.0, 11.0))
    write_calculix(tmp_path / "a", A, A, names)
    (tmp_path / "a.inp").write_text(
        "*NODE, NSET=N\n5,0.,0.,0.\n7,1.,0.,0.\n9,2.,0.,0.\n11,3.,0.,0.\n"
        "*ELEMENT, TYPE=S4\n1, 5,7,9,11\n*ELEMENT, TYPE=MASS, ELSET=M\n2, 9\n"
        "*BOUNDARY\n5, 3\n7, ENCASTRE\n"
    )
    dofs = read("calculix", tmp_path / "a").dofs
    assert dofs.sensor(5, "x") == [(1, 0.5), (3, 0.5)]
    assert dofs.sensor(9, "z") == [(0, 1.0)], "the node itself is the mean already"
    assert dofs.sensor(11, "z") == [(8, 0.5), (9, 0.5)]
    for node, direction, message in (
        (5, "z", "in which node 5 can move .x."),  # held, though degrees of freedom are left
        (7, "x", "a node with degrees of freedom"),
        (11, "x", "in which node 11 can move .z."),  # one of two was eliminated: the mean is held
    ):
        with pytest.raises(LookupError, match=message):
            dofs.sensor(node, direction)


# Ansys


def test_full_files_of_ansys(tmp_path: Path) -> None:
    write_ansys(tmp_path / "a.full", K, M, labels())
    assert_same(read("ansys", tmp_path / "a.full"))
    assert_same(read("ansys", tmp_path / "a"))


def test_held_rows_of_ansys_are_left_out(tmp_path: Path) -> None:
    write_ansys(tmp_path / "a.full", K, M, labels(), held=[0, 4])
    job = read("ansys", tmp_path / "a.full")
    free = [k for k in range(15) if k not in (0, 4)]
    assert np.array_equal(dense(job.stiffness), K[np.ix_(free, free)])
    assert list(zip(job.dofs.node, job.dofs.direction, strict=True))[:2] == [(12, 2), (12, 3)]
    assert "2 degrees of freedom that are held are left out" in job.notes


@pytest.mark.parametrize(
    ("items", "message"),
    [
        ({14: 1}, "an assembled matrix .*found unsymmetric matrices"),
        ({21: 3}, "found 3 constraint equations .*EXPORT applies them"),
        ({34: 0}, "found no mass matrix .ANTYPE,MODAL writes one"),
        ({19: 10**6}, "whole records of an assembled matrix of Ansys"),
        ({1: 4}, "an assembled matrix of Ansys"),
    ],
)
def test_other_files_of_ansys(tmp_path: Path, items: dict[int, int], message: str) -> None:
    write_ansys(tmp_path / "a.full", K, M, labels(), items=items)
    refused("ansys", tmp_path / "a.full", message)


def test_exported_matrices_of_ansys(tmp_path: Path) -> None:
    for letter, A in (("K", K), ("M", M)):
        scipy.io.mmwrite(tmp_path / f"a_{letter}.mtx", scipy.sparse.coo_array(A))
        (tmp_path / f"a_{letter}.mtx").rename(tmp_path / f"a_{letter}.mmf")
    assert not (read("ansys", tmp_path / "a").dofs.node > 0).any()
    names = ("UX", "UY", "UZ")
    lines = [f"  {k}  {n}  {names[d - 1]}" for k, (n, d) in enumerate(labels(), 1)]
    (tmp_path / "a.mapping").write_text("\n".join(["  Matrix Eqn  Node  DOF", *lines]) + "\n")
    job = read("ansys", tmp_path / "a")
    assert (job.dofs.node > 0).any()
    assert_same(job)


# Abaqus


def test_matrix_input_of_abaqus(tmp_path: Path) -> None:
    write_abaqus(tmp_path / "a", K, M, labels())
    for name in ("a", "a.inp", "a_STIF1.mtx"):
        assert_same(read("abaqus", tmp_path / name))
    write_abaqus(tmp_path / "a", K, M, labels(), step=2)
    refused("abaqus", tmp_path / "a", "one step.*a_STIF1.mtx, a_STIF2.mtx")


def test_numbers_of_nodes_with_great_gaps(tmp_path: Path) -> None:
    far = [(node + 900_000_000, direction) for node, direction in labels()]
    size = len(far) + 1
    stiffness, mass = np.eye(size), np.zeros((size, size))
    stiffness[:-1, :-1], mass[:-1, :-1] = K, M
    write_abaqus(tmp_path / "a", stiffness, mass, [*far, (-4, 1)])
    job = read("abaqus", tmp_path / "a")
    order = [
        far.index(place) if place in far else size - 1
        for place in zip(job.dofs.node.tolist(), job.dofs.direction.tolist(), strict=True)
    ]
    assert order[-1] == size - 1
    assert dense(job.stiffness) == pytest.approx(stiffness[np.ix_(order, order)])


@pytest.mark.parametrize("program", ["abaqus", "nastran"])
def test_text_that_is_cut_off_at_the_end_of_a_line(tmp_path: Path, program: str) -> None:
    order = np.argsort([node for node, _ in labels()], kind="stable")
    names = [labels()[k] for k in order]
    A, B = K[np.ix_(order, order)], M[np.ix_(order, order)]
    if program == "abaqus":
        write_abaqus(tmp_path / "a", A, B, names)
        file = tmp_path / "a_STIF1.mtx"
        file.write_text("".join(file.read_text().splitlines(keepends=True)[:-20]))
    else:
        A[:, 12:] = A[12:, :] = 0.0
        write_dmig(tmp_path / "a.pch", {"KAA": A, "MAA": B}, names)
    refused(
        program, tmp_path / "a", r"stiffness at all .* found none at \d of them, the first node 40"
    )


def test_coordinate_format_of_abaqus(tmp_path: Path) -> None:
    for kind, A in (("STIF", K), ("MASS", M)):
        rows = [f"{i + 1} {j + 1} {A[i, j]:.15e}" for i, j in zip(*np.nonzero(A), strict=True)]
        (tmp_path / f"a_{kind}1.mtx").write_text("\n".join(rows) + "\n")
    job = read("abaqus", tmp_path / "a")
    assert_same(job)
    assert not (job.dofs.node > 0).any()


def test_supports_of_abaqus_are_left_out(tmp_path: Path) -> None:
    held = K.copy()
    held[4, :] = held[:, 4] = 0.0
    held[4, 4] = 1e36
    write_abaqus(tmp_path / "a", held, M, labels())
    job = read("abaqus", tmp_path / "a")
    assert job.dofs.size == 14
    with pytest.raises(LookupError, match=r"node 3 can move .x, z."):
        job.dofs.sensor(3, "y")


def test_sets_of_abaqus_may_be_those_of_elements(tmp_path: Path) -> None:
    write_abaqus(tmp_path / "a", K, M, labels())
    nodes = "".join(f"{node}, {node}., 0., 0.\n" for node in {node for node, _ in labels()})
    sets = "*NSET, NSET=ENDS, ELSET=BEAM\n*NSET, NSET=OTHERS, INPUT=others.inp\n"
    (tmp_path / "a.inp").write_text(f"*NODE\n{nodes}{sets}")
    assert read("abaqus", tmp_path / "a").mesh is not None
    (tmp_path / "a.inp").write_text(f"*NODE\n{nodes}*NSET, NSET=ENDS\n")
    refused("abaqus", tmp_path / "a", "no nodes in it")


def test_a_deck_of_abaqus_as_its_manual_has_it(tmp_path: Path) -> None:
    write_abaqus(tmp_path / "a", K, M, labels())
    nodes = "".join(f"{node}, {node}.D0, 0., 1-3\n" for node in {node for node, _ in labels()})
    (tmp_path / "a.inp").write_text(f"*NODE,\nNSET=ALL\n{nodes}")
    mesh = read("abaqus", tmp_path / "a").mesh
    assert mesh is not None
    assert mesh.coordinates[:, 2].tolist() == [1e-3] * len(mesh.number)
    assert mesh.coordinates[:, 0].tolist() == mesh.number.tolist()
    spring = "*ELEMENT, TYPE=SPRINGA, ELSET=S\n1, Part-1-1.5, Part-2-1.9\n"
    turned = "*TRANSFORM, NSET=RING, TYPE=C\n0., 0., 0., 0., 0., 1.\n"
    deck = f"*PART, NAME=P\n*NODE\n{nodes}*END PART\n{spring}{turned}"
    (tmp_path / "a.inp").write_text(deck)
    job = read("abaqus", tmp_path / "a")
    assert job.mesh is None
    assert any(note.endswith("the nodes' own systems at node RING") for note in job.notes)
    assert "the deck numbers nodes in parts: coordinates are left out" in job.notes


# OpenSees


def test_opensees(tmp_path: Path) -> None:
    write_opensees(tmp_path / "a", K, M, labels())
    (tmp_path / "a_nodes.csv").write_text("12,0,0,0\n3,1,0,0\n7,1,1,0\n40,0,1,0\n5,2,0,1\n")
    (tmp_path / "a_elements.csv").write_text("1,12,3\n2,12,3,7,40\n")
    job = read("opensees", tmp_path / "a")
    assert_same(job)
    assert job.mesh is not None
    assert {kind: len(table) for kind, table in job.mesh.cells.items()} == {"line": 1, "quad": 1}


@pytest.mark.parametrize(
    ("name", "text", "says"),
    [
        (
            "nodes",
            "node,x\n12,0,0\n3,1\n",
            r"line 3: expected rows node,x,y,z, found 1 coordinates",
        ),
        ("nodes", "12,0,0,0,9\n", "line 1: expected rows node,x,y,z, found 4 coordinates"),
        ("nodes", "12,0,0\n12,1,0\n", "line 2: expected rows node,x,y,z, found 12 again"),
        ("nodes", "12,0,nan\n", "line 1: .* found numbers that are not finite"),
        ("elements", "1,12,x\n", "line 1: expected rows element,node,…, found .*'x'"),
        ("elements", "1,12,3\n2,12", "last line: expected whole lines to the end"),
        ("elements", "1,12,99\n", "nodes: expected all nodes of its elements, found no node 99"),
    ],
)
def test_rows_of_opensees_that_are_wrong(tmp_path: Path, name: str, text: str, says: str) -> None:
    write_opensees(tmp_path / "a", K, M, labels())
    (tmp_path / "a_nodes.csv").write_text("12,0,0,0\n3,1,0,0\n")
    (tmp_path / f"a_{name}.csv").write_text(text)
    refused("opensees", tmp_path / "a", rf"a_{name}\.csv: {says}")


# All


WRITERS: dict[str, tuple[Callable[[Path, Array, Array], None], str]] = {
    "nastran": (lambda p, K, M: write_op4(p, {"KAA": K, "MAA": M}, "sparse"), "a.op4"),
    "abaqus": (lambda p, K, M: _both_triangles(p, K, M), "a"),
    "opensees": (lambda p, K, M: write_opensees(p, K, M, labels()), "a"),
}


def _both_triangles(job: Path, K: Array, M: Array) -> None:
    for kind, A in (("STIF", K), ("MASS", M)):
        names = labels()
        rows = [
            f"{names[i][0]},{names[i][1]},{names[j][0]},{names[j][1]},{A[i, j]:.15e}"
            for i, j in zip(*np.nonzero(A), strict=True)
        ]
        (job.parent / f"{job.name}_{kind}1.mtx").write_text("\n".join(rows) + "\n")


@pytest.mark.parametrize("program", WRITERS)
def test_unsymmetric_matrices_are_refused(tmp_path: Path, program: str) -> None:
    writer, name = WRITERS[program]
    writer(tmp_path / name, K, M)
    assert_same(read(program, tmp_path / name))
    skew = K.copy()
    skew[0, 3] *= 1.5
    writer(tmp_path / name, skew, M)
    refused(program, tmp_path / name, "a symmetric matrix, found .*damping, contact")


@pytest.mark.parametrize("program", WRITERS)
def test_entries_that_are_no_numbers_are_refused(tmp_path: Path, program: str) -> None:
    writer, name = WRITERS[program]
    wrong = K.copy()
    wrong[3, 3] = np.nan
    writer(tmp_path / name, wrong, M)
    refused(program, tmp_path / name, "expected (finite numbers|numbers|5 numbers)")


@pytest.mark.parametrize("program", PROGRAMS)
@pytest.mark.parametrize("content", [None, b"", b"\0" * 4096, b"hello\nworld\n", bytes(range(256))])
def test_no_file_raises_anything_else(tmp_path: Path, program: str, content: bytes | None) -> None:
    suffixes = ".op4 .pch .full _K.npz _M.npz _dofs.csv _STIF1.mtx _MASS1.mtx .sti .mas .dof .dat"
    for suffix in f"{suffixes} .inp _K.mmf _M.mmf".split() if content is not None else ():
        (tmp_path / f"a{suffix}").write_bytes(content or b"")
    (tmp_path / "folder.op4").mkdir()
    for name in ("a", "a.full", "a.op4", "a.pch", "none/a", "folder.op4", "folder"):
        with pytest.raises(InputError):
            read(program, tmp_path / name)


@pytest.mark.parametrize("spring", ["CELAS2,2,50.,1,1", "CELAS2,2,50.,,,1,1", "CBUSH,2,8,1"])
def test_springs_of_nastran_to_the_ground_strain_in_a_translation(
    tmp_path: Path, spring: str
) -> None:
    k = np.diag([100.0, 100, 100, 10, 10, 10])
    stiffness = np.block([[k, -k], [-k, k]])
    stiffness[0, 0] += 50.0
    write_op4(tmp_path / "a.op4", {"KAA": stiffness, "MAA": np.eye(12)}, "sparse")
    lines = ["BEGIN BULK", "GRID,1,,0.,0.,0.", "GRID,2,,0.,0.,0.", "CBUSH,1,7,1,2"]
    (tmp_path / "a.bdf").write_text("\n".join([*lines, spring, "ENDDATA", ""]))
    assert read("nastran", tmp_path / "a.op4").dofs.sensor(2, "y") == [(7, 1.0)]
    (tmp_path / "a.bdf").write_text("\n".join([*lines, "ENDDATA", ""]))
    refused("nastran", tmp_path / "a.op4", "a force at node 1 x in a translation of the whole")


@pytest.mark.parametrize("default", [False, True])
def test_a_node_of_nastran_says_what_holds_it_and_its_directions(
    tmp_path: Path, default: bool
) -> None:
    write_op4(tmp_path / "a.op4", {"KAA": K[:1, :1], "MAA": M[:1, :1]}, "sparse")
    lines = ["GRDSET,,,,,,7,23456", "GRID,2,,1.,0.,0."] if default else []
    lines = lines or ["GRID,2,,1.,0.,0.,7,23456"]
    rod = "\n".join(
        ["BEGIN BULK", *lines, "GRID,1,,0.,0.,0.,,123456", "CROD,1,1,1,2", "ENDDATA", ""]
    )
    (tmp_path / "a.bdf").write_text(rod)
    job = read("nastran", tmp_path / "a.op4")
    assert [job.dofs.label(k) for k in range(job.dofs.size)] == ["node 2 x"]
    assert any("nodes' own systems at node " in note and "2" in note for note in job.notes)


def test_a_constraint_of_nastran_joins_the_nodes_of_all_its_lines(tmp_path: Path) -> None:
    grids = "".join(f"GRID,{n},,{n}.,0.,0.\n" for n in (1, 2, 3, 4))
    lines = "MPC,8,1,2,1.,2,3,-1.\n,,3,1,-2.,4,2,7\nENDDATA\n"
    (tmp_path / "a.bdf").write_text(f"MPC = 8\nBEGIN BULK\n{grids}{lines}")
    content = read_bulk(tmp_path / "a.bdf")
    assert [sorted(nodes) for nodes in content.links] == [[1, 2, 3, 4]]
    assert content.followers == {(1, 2)}


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("GRID,7,,2.,0.,1.", "GRID,7,,nan", "line 4: expected an entry GRID .* coordinates nan"),
        ("GRID,7,,2.,0.,1.", "GRID,3,,2.,0.,1.", "line 4: .* node 3 again"),
        ("GRID,7,,2.,0.,1.\n", "", "expected all nodes of its elements, found no node 7"),
        ("CTETRA,1,1,12,3,7,40", "CTETRA,1,1,12,3,7", "line 7: .* 3 nodes of 4"),
        ("ENDDATA\n", "", "expected a line ENDDATA at the end"),
    ],
)
def test_decks_of_nastran_that_are_not_whole(tmp_path: Path, old: str, new: str, says: str) -> None:
    write_dmig(tmp_path / "a.pch", {"KAAX": K, "MAAX": M}, labels())
    turned = {5: ",9"}  # its own system of displacements
    places = enumerate((12, 3, 7, 40, 5))
    grids = "".join(f"GRID,{n},,{k}.,0.,1.{turned.get(n, '')}\n" for k, n in places)
    deck = f"BEGIN BULK\n{grids}CTETRA,1,1,12,3,7,40\nENDDATA\n"
    (tmp_path / "a.bdf").write_text(deck)
    job = read("nastran", tmp_path / "a.pch")
    assert job.mesh is not None
    assert any(note.endswith("the nodes' own systems at node 5") for note in job.notes)
    (tmp_path / "a.bdf").write_text(deck.replace(old, new))
    with pytest.raises(InputError, match=says):
        read("nastran", tmp_path / "a.pch")
