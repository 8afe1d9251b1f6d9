"""Terms from runs: exact, sparse, of low rank, checked, whatever the order of the rows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from program_files import (
    Array,
    dense,
    frequencies,
    labels,
    structure,
    write_abaqus,
    write_calculix,
    write_op4,
    write_opensees,
)

from modefront.errors import InputError
from modefront.programs.base import Quantity
from modefront.study.importing import Imported, import_model, model_of


def jobs(folder: Path, runs: Mapping[str, Mapping[str, float]]) -> None:
    for name, values in runs.items():
        write_opensees(folder / name, *structure(**values), labels())


def imported(
    folder: Path,
    runs: Sequence[tuple[str, str]],
    *,
    program: str = "opensees",
    factors: Sequence[tuple[str, float]] = (),
    functions: Mapping[str, Sequence[str]] | None = None,
    checks: Sequence[tuple[str, Mapping[str, float]]] = (),
) -> Imported:
    parameters: dict[str, list[Path]] = {}
    for name, run in runs:
        parameters.setdefault(name, []).append(folder / run)
    given: dict[str, list[float]] = {}
    for name, factor in factors:
        given.setdefault(name, []).append(factor)
    return import_model(
        program,
        folder / "base",
        parameters,
        factors=given,
        functions=functions,
        checks=[(folder / run, values) for run, values in checks],
    )


def matrix_of(result: Imported, quantity: Quantity, theta: Sequence[float]) -> Array:
    """Return a matrix of the imported terms at theta."""
    model = model_of(result.terms)
    matrix = model.stiffness if quantity == "stiffness" else model.mass
    A = matrix.at(np.array(theta, dtype=float))
    return A if isinstance(A, np.ndarray) else A.toarray()


THREE = {"base": {}, "E": {"E": 2.0}, "k": {"k": 2.0}, "rho": {"rho": 3.0}}


def test_terms_give_the_matrices_at_other_values(tmp_path: Path) -> None:
    jobs(tmp_path, THREE | {"check": {"E": 0.7, "k": 1.9, "rho": 0.4}})
    result = imported(
        tmp_path,
        [("E", "E"), ("k", "k"), ("rho", "rho")],
        factors=[("rho", 3.0)],
        checks=[("check", {"E": 0.7, "k": 1.9, "rho": 0.4})],
    )
    assert result.errors[0] < 1e-14
    K, M = structure(E=1.3, k=0.6, rho=1.7)
    assert np.abs(matrix_of(result, "stiffness", [1.3, 0.6, 1.7]) - K).max() < 1e-12 * K.max()
    assert np.abs(matrix_of(result, "mass", [1.3, 0.6, 1.7]) - M).max() < 1e-12 * M.max()
    assert result.frequencies == pytest.approx(frequencies(*structure())[:6])
    assert result.terms.matrices["stiffness"].keys() - {"base"} == {"E", "k"}
    assert result.terms.matrices["mass"].keys() - {"base"} == {"rho"}
    assert result.terms.ranks["k"] == (2, 1), "a spring has the rank 1"
    assert result.terms.ranks["E"] == (9, 3)
    assert result.terms.ranks["rho"] == (3, 3)


def test_orders_of_rows_are_matched_by_node_and_direction(tmp_path: Path) -> None:
    jobs(tmp_path, THREE)
    order = np.random.default_rng(1).permutation(15)
    K, M = structure(E=2.0)
    names = [labels()[k] for k in order]
    write_opensees(tmp_path / "E", K[np.ix_(order, order)], M[np.ix_(order, order)], names)
    result = imported(tmp_path, [("E", "E")])
    right = structure(E=0.5)[0]
    assert np.abs(matrix_of(result, "stiffness", [0.5]) - right).max() < 1e-12 * right.max()
    names[3] = (99, 2)
    write_opensees(tmp_path / "E", K, M, names)
    with pytest.raises(InputError, match=r"expected the degrees of freedom of .*, found none at"):
        imported(tmp_path, [("E", "E")])
    write_opensees(tmp_path / "E", K[:14, :14], M[:14, :14], labels()[:14])
    with pytest.raises(InputError, match="found none at node 5 z"):
        imported(tmp_path, [("E", "E")])


def test_the_parameter_that_is_not_affine_is_named(tmp_path: Path) -> None:
    jobs(tmp_path, {"base": {"t": 1.0}, "t": {"t": 2.0}, "k": {"t": 1.0, "k": 2.0}})
    jobs(tmp_path, {"check": {"t": 1.5, "k": 0.6}, "other": {"t": 1.5, "k": 0.6, "E": 1.2}})
    runs = [("t", "t"), ("k", "k")]
    values = {"t": 1.5, "k": 0.6}
    with pytest.raises(InputError, match=r"check: expected matrices that are affine in 't' to"):
        imported(tmp_path, runs, checks=[("check", values)])
    jobs(tmp_path, {"three": {"t": 3.0}})
    result = imported(
        tmp_path,
        [("t", "t"), ("t", "three"), ("k", "k")],
        factors=[("t", 2.0), ("t", 3.0)],
        functions={"t": ["t", "t^3"]},
        checks=[("check", values)],
    )
    assert [*result.terms.ranks] == ["t", "t^3", "k"]
    K = structure(t=0.8)[0]
    assert np.abs(matrix_of(result, "stiffness", [0.8, 1.0]) - K).max() < 1e-12 * K.max()
    with pytest.raises(InputError, match=r"only t, k to differ from .*other changes of the stiff"):
        imported(
            tmp_path,
            [("t", "t"), ("t", "three"), ("k", "k")],
            factors=[("t", 2.0), ("t", 3.0)],
            functions={"t": ["t", "t^3"]},
            checks=[("other", values)],
        )


def test_quotients_and_products_can_be_declared(tmp_path: Path) -> None:
    K, M = structure()
    part = structure(E=2.0)[0] - K

    def write(name: str, L: float, E: float) -> None:
        write_opensees(tmp_path / name, K + E / L * part + part / L**3, M, labels())

    for name, L, E in (("base", 1, 1), ("L", 2, 1), ("E", 1, 2), ("check", 1.3, 0.6)):
        write(name, L, E)
    functions = {"L": ["E/L", "1/L^3"], "E": ["E/L"]}
    result = imported(
        tmp_path,
        [("L", "L"), ("E", "E")],
        functions=functions,
        checks=[("check", {"L": 1.3, "E": 0.6})],
    )
    right = K + 3 / 0.7 * part + part / 0.7**3
    assert np.abs(matrix_of(result, "stiffness", [0.7, 3.0]) - right).max() < 1e-11 * right.max()
    model = model_of(result.terms)
    assert model.above_zero == ("L",)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"runs": [("E", "base")]}, "other matrices than those .* E = 2, found the same: did"),
        ({"runs": [("E", "E"), ("E", "k")]}, "--factor E: expected 2 factors, .*found 0"),
        ({"runs": [("E", "E")], "factors": [("E", 1.0)]}, "above 0, and not 1, found 1"),
        ({"runs": [("E", "E")], "factors": [("F", 2.0)]}, "expected a parameter, found 'F'"),
        (
            {"runs": [("E", "E")], "functions": {"E": ["E", "E^3"]}},
            "at least 2 runs with other values for the terms E, E.3, found 1",
        ),
        ({"runs": [("E", "E")], "functions": {"E": ["t^3"]}}, "product of powers .*found 't.3'"),
        ({"runs": [("E", "E"), ("k", "k")], "functions": {"E": ["k"]}}, "terms with 'E'"),
        ({"runs": [("E", "E")], "functions": {"F": ["F"]}}, "--function: expected a parameter"),
        ({"runs": [("E", "E")], "checks": [("k", {"F": 2.0})]}, "--check: expected a parameter"),
        ({"runs": [("E", "none")]}, "none_dofs.csv: file: .*no such file"),
    ],
)
def test_what_is_wrong_with_runs(tmp_path: Path, arguments: dict[str, Any], message: str) -> None:
    jobs(tmp_path, THREE)
    with pytest.raises(InputError, match=message):
        imported(tmp_path, **arguments)


def test_noise_is_dropped_and_hides_nothing_soft(tmp_path: Path) -> None:
    noise = np.random.default_rng(2).standard_normal((15, 15)) * 1e-14
    noise += noise.T
    for name, k in (("base", 1.0), ("k", 2.0)):
        K, M = structure(k=k)
        K[3, 3] += 1e16  # a penalty, as programs hold supports
        K += (noise * K.max() * 1e-16) if name == "k" else 0.0
        write_op4(tmp_path / f"{name}.op4", {"KAA": K, "MAA": M}, "dense")
    result = imported(tmp_path, [("k", "k.op4")], program="nastran")
    assert [*result.terms.ranks.values()] == [(2, 1)]
    block = dense(result.terms.matrices["stiffness"]["k"])[np.ix_([2, 11], [2, 11])]
    assert block == pytest.approx(300 * np.array([[1, -1], [-1, 1]]), rel=1e-9)


def test_text_of_14_digits_gives_terms_without_noise(tmp_path: Path) -> None:
    for name, values in THREE.items():
        write_calculix(tmp_path / name, *structure(**values), labels())
    write_calculix(tmp_path / "check", *structure(E=0.3, k=4.0), labels())
    result = imported(
        tmp_path,
        [("E", "E"), ("k", "k")],
        program="calculix",
        checks=[("check", {"E": 0.3, "k": 4.0})],
    )
    assert [rank for _, rank in result.terms.ranks.values()] == [3, 1]
    assert result.errors[0] < 1e-12


# Degrees of freedom that the program makes


def with_internal(E: float = 1.0, k: float = 1.0, mass: float = 0.0) -> tuple[Array, Array]:
    """Return the structure with four internal degrees of freedom, in two groups."""
    K, M = structure(k=k)
    rng = np.random.default_rng(3)
    big, heavy = np.zeros((19, 19)), np.zeros((19, 19))
    big[:15, :15], heavy[:15, :15] = K, M
    for first, nodes, scale in ((15, slice(0, 6), E), (17, slice(9, 15), 1.0)):
        B = rng.standard_normal((8, 8))
        part = scale * (B @ B.T)
        places = [*range(15)[nodes], first, first + 1]
        big[np.ix_(places, places)] += part
    heavy[17, 17] = heavy[18, 18] = mass
    return big, heavy


INTERNAL = [*labels(), (-1, 1), (-1, 2), (-7, 1), (-7, 2)]


@pytest.mark.parametrize("mass", [0.0, 0.3])
def test_internal_degrees_of_freedom_are_never_dropped(tmp_path: Path, mass: float) -> None:
    for name, E, k in (("base", 1.0, 1.0), ("E", 2.0, 1.0), ("k", 1.0, 2.0)):
        write_abaqus(tmp_path / name, *with_internal(E, k, mass), INTERNAL)
    result = imported(tmp_path, [("E", "E"), ("k", "k")], program="abaqus")
    assert result.terms.dofs.size == (15 if mass == 0 else 17)
    theta = np.array([0.6, 1.7])
    K, M = with_internal(0.6, 1.7, mass)
    live = np.flatnonzero(M.diagonal() > 0)
    dead = np.flatnonzero(M.diagonal() == 0)
    S = K[np.ix_(live, live)] - K[np.ix_(live, dead)] @ np.linalg.solve(
        K[np.ix_(dead, dead)], K[np.ix_(dead, live)]
    )
    right = frequencies(S, M[np.ix_(live, live)])[:8]
    lam = model_of(result.terms).full_modes(theta, 8).lam
    assert np.sqrt(lam) / (2 * np.pi) == pytest.approx(right, rel=1e-10)


def test_what_several_parameters_act_on_is_kept(tmp_path: Path) -> None:
    for name, E in (("base", 1.0), ("E", 2.0)):
        K, M = with_internal(E)
        K[16, 16] += 1.0  # does not scale with E
        write_abaqus(tmp_path / name, K, M, INTERNAL)
    result = imported(tmp_path, [("E", "E")], program="abaqus")
    assert result.terms.dofs.size == 17
    assert any("2 degrees of freedom of the program are kept" in note for note in result.notes)


def test_constraints_with_multipliers_are_refused(tmp_path: Path) -> None:
    for name, k in (("base", 1.0), ("k", 2.0)):
        K, M = structure(k=k)
        big, heavy = np.zeros((16, 16)), np.zeros((16, 16))
        big[:15, :15], heavy[:15, :15] = K, M
        big[15, 0] = big[0, 15] = 1.0
        big[15, 4] = big[4, 15] = -1.0
        write_abaqus(tmp_path / name, big, heavy, [*labels(), (-1, 1)])
    with pytest.raises(InputError, match="constraints with Lagrange multipliers"):
        imported(tmp_path, [("k", "k")], program="abaqus")


def test_rigid_bodies_and_massless_degrees_of_freedom_are_said(tmp_path: Path) -> None:
    K = np.array([[1.0, -1.0, 0.0], [-1.0, 2.0, -1.0], [0.0, -1.0, 1.0]])
    names = [(1, 1), (2, 1), (3, 1)]
    for name, factor in (("base", 1.0), ("k", 2.0)):
        write_opensees(tmp_path / name, factor * K, np.diag([1.0, 0.0, 1.0]), names)
    result = imported(tmp_path, [("k", "k")])
    assert result.floating
    assert result.frequencies == pytest.approx([0.0, np.sqrt(1.0) / (2 * np.pi)], abs=1e-9)
    assert result.terms.matrices["stiffness"].keys() == {"k"}
    assert any("1 degrees of freedom have no mass" in note for note in result.notes)
