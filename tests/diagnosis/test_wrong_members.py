"""Models that are wrong at one place: what is said of a member, and not of an innocent sensor."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from modefront import fem
from modefront._typing import Floats
from modefront.data.modal import modal_data
from modefront.diagnosis.comparison import Comparison, compare
from modefront.diagnosis.evidence import Fits
from modefront.diagnosis.members import pairs, parts_of, with_factors
from modefront.diagnosis.search import diagnose
from modefront.diagnosis.state import stacked
from modefront.findings.record import Finding
from modefront.linalg.affine import Members
from modefront.models.chain import chain
from modefront.models.matrices import MatrixModel, matrices
from modefront.models.mesh import mesh_model
from modefront.residuals.groups import Group
from modefront.residuals.problem import UpdatingProblem

STEEL = fem.Material(E=210e9, nu=0.3, rho=7850.0)


def compared(model: MatrixModel, structure: MatrixModel, count: int) -> Comparison:
    """Return a model beside the modes of a structure with a little noise."""
    rng, unit = np.random.default_rng(3), np.ones(len(model.parameters))
    modes = structure.modes(unit, count, derivatives=False)
    shape = modes.phi.T * (1 + 0.02 * rng.standard_normal(modes.phi.T.shape))
    data = modal_data(modes.frequency, shape, model.sensors)
    groups = (Group("f", frequency="all"),)
    return compare(UpdatingProblem(model, data, groups, unit / 5, 5 * unit, unit))


def mistakes(model: MatrixModel, structure: MatrixModel, count: int) -> list[Finding]:
    """Return what is found of a model and the modes of a structure."""
    return diagnose(compared(model, structure, count))


def tower(springs: Floats) -> MatrixModel:
    names = ["k1"] * 4 + ["k2"] * 4
    return chain(["k1", "k2"], [1.0] * 8, 2000.0 * springs, stiffness_parameters=names)


@pytest.mark.slow(2)
@pytest.mark.parametrize(("factor", "size"), [(4.0, "greater"), (0.25, "smaller")])
def test_a_spring_that_differs_is_named_and_no_sensor(factor: float, size: str) -> None:
    springs = np.ones(8)
    springs[3] = factor
    (found,) = mistakes(tower(np.ones(8)), tower(springs), 5)
    assert found.kind == "wrong-member"
    text = f"the stiffness at degrees of freedom 2 and 3 is several times {size} than in the model"
    assert text in str(found)


def two_towers(first: float) -> MatrixModel:
    """Return two equal towers of three floors, hardly joined; a factor is on one spring."""
    K = np.zeros((6, 6))
    for k, (a, b) in enumerate([(0, -1), (1, 0), (2, 1), (3, -1), (4, 3), (5, 4), (2, 5)]):
        s = np.zeros(6)
        s[[a, b]] = (1.0, -1.0) if b >= 0 else (1.0, s[b])
        K += {0: first, 6: 0.01}.get(k, 1.0) * 1000.0 * np.outer(s, s)
    return matrices(["k"], {"k": K}, {"base": np.eye(6)}, {f"s{i}": i for i in range(6)})


def test_close_modes_that_a_member_of_usual_scatter_mixes_are_blamed_on_nobody() -> None:
    """One spring is 15 % stiffer: modes of both towers become modes of one each."""
    model, structure = two_towers(1.0), two_towers(1.15)
    phi, psi = (x.modes(np.ones(1), 1, derivatives=False).phi[:, 0] for x in (model, structure))
    assert (phi @ psi) ** 2 / (phi @ phi) / (psi @ psi) < 0.8
    assert mistakes(model, structure, 6) == []


def frame(slab: float) -> fem.Structure:
    """Return a frame in the plane of x and z with two storeys, and masses on its beams."""
    X = np.array([(3.0 * i, 0.0, 3.0 * s) for s in range(3) for i in range(2)])
    columns, beams = [(0, 2), (1, 3), (2, 4), (3, 5)], [(2, 3), (4, 5)]
    side, above = fem.rectangle(0.1, 0.1), [2, 3, 4, 5]
    return fem.Structure(
        X,
        [
            fem.Beams("columns", columns, STEEL, side),
            fem.Beams("beams", beams, STEEL, side),
        ],
        [fem.Support([0, 1]), fem.Support(above, ("y", "rx", "rz"))],
        springs=[fem.Spring("brace", [2], 1e5, "x")],
        masses=[fem.Mass("slabs", above, slab)],
        sensors=[fem.Sensor(f"{axis}{n}", n, axis) for n in above for axis in "xz"],
        parameters=[
            fem.Parameter("E", "E", ("columns",)),
            fem.Parameter("m", "density", ("beams",)),
        ],
    )


@pytest.mark.slow(2)
def test_a_group_without_parameter_in_another_unit_is_named() -> None:
    names = ["E", "m"]
    model, structure = (mesh_model(frame(slab), names) for slab in (2e6, 2e3))
    (found,) = mistakes(model, structure, 5)
    assert "the mass of all slabs is 1000 times what the data say" in str(found)


def total(of_all: list[Members], of: str, term: int, size: int) -> Floats:
    """Return the sum of what members add to a term of a matrix."""
    out = np.zeros((size, size))
    for x in (x for x in of_all if x.of == of):
        R = x.rows.toarray().reshape(len(x.nodes), -1, size)
        for terms, A in x.shares:
            out += (R.swapaxes(1, 2) @ A @ R)[terms == term].sum(axis=0)
    return out


def shell() -> fem.Structure:
    X, cells = fem.grids.plate(1.0, 1.0, 2, 2)
    return fem.Structure(
        X,
        [fem.Shells("plate", cells, STEEL, 0.01)],
        [fem.Support(np.flatnonzero(X[:, 0] == 0))],
        sensors=[fem.Sensor("tip", 8, "z")],
        parameters=[
            fem.Parameter("t", "thickness", ("plate",)),
            fem.Parameter("E", "E", ("plate",)),
        ],
    )


@pytest.mark.parametrize(
    "model",
    [mesh_model(shell(), ["E", "t"]), mesh_model(frame(1e3), ["E", "m"]).held({"E": 2.0}, {})],
    ids=["powers of thickness", "a fixed parameter"],
)
def test_members_of_a_mesh_add_up_to_all_terms(model: MatrixModel) -> None:
    assert model.members is not None
    of_all, sparse = list(model.members()), model.sparse()
    for of in ("stiffness", "mass"):
        terms = getattr(sparse, of).dense().terms
        for j, A in enumerate(terms):
            np.testing.assert_allclose(
                total(of_all, of, j, model.size), A, atol=1e-12 * np.abs(A).max()
            )


def test_what_joins_masses_in_plain_matrices_adds_up_to_all_terms() -> None:
    model = tower(np.linspace(1.0, 2.0, 8))
    of_all, sparse = list(pairs(model)), model.sparse()
    assert [len(x.nodes) for x in of_all] == [8, 8]
    for of in ("stiffness", "mass"):
        for j, A in enumerate(getattr(sparse, of).dense().terms):
            np.testing.assert_allclose(total(of_all, of, j, 8), A, atol=1e-9)


def test_a_member_with_a_parameter_of_its_own_is_no_part() -> None:
    names = ["k1", "k2", "k2"]
    model = chain(["k1", "k2"], [1.0] * 3, [1.0] * 3, stiffness_parameters=names)
    places = [x.place for x in parts_of(model, np.eye(3)) if x.of == "stiffness"]
    assert places == ["at degrees of freedom 0 and 1", "at degrees of freedom 1 and 2"]


def test_a_factor_on_a_member_is_a_further_parameter() -> None:
    springs = np.ones(8)
    model, theta = tower(springs), np.array([1.3, 0.8])
    spring = next(x for x in parts_of(model, np.eye(8)) if "freedom 4 and 5" in x.place)
    springs[5] = 3.0
    scaled = with_factors(model, [spring])
    np.testing.assert_allclose(
        scaled.stiffness.at(np.append(theta, 3.0)), tower(springs).stiffness.at(theta), atol=1e-9
    )
    with_none = with_factors(model, []).stiffness.at(np.append(theta, 3.0))
    np.testing.assert_array_equal(with_none, model.stiffness.at(theta))
    modes = scaled.modes(np.append(theta, 3.0), 4)
    higher, lower = (
        replace(scaled).modes(np.append(theta, 3.0 + h), 4, derivatives=False).lam
        for h in (1e-5, -1e-5)
    )
    np.testing.assert_allclose(modes.dlam[:, 2], (higher - lower) / 2e-5, rtol=1e-6, atol=1e-6)


def test_one_model_tells_what_a_step_of_each_factor_gains() -> None:
    """Its costs ahead are those of the models with one factor each."""
    springs = np.linspace(1.0, 1.3, 8)
    fits = Fits(compared(tower(np.ones(8)), tower(springs), 5))
    x = np.array([0.1, -0.1, 0.0])
    ahead, dx = fits.by_parts(fits.plain, x)
    some = [replace(fits.plain, part=np.array(k + 1)) for k in range(len(fits.parts))]
    each = fits.at(stacked(some), np.tile(x, (len(some), 1)))
    np.testing.assert_allclose(ahead, each.ahead, rtol=1e-9)
    assert (np.sign(dx) * each.g[:, -1] < 0).sum() > len(some) / 2, "mostly downhill"
