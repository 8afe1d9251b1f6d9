"""Findings of checks of studies with known mistakes and difficulties."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from own_residuals import OneSet

import modefront as mf
from modefront._typing import Bools, Floats
from modefront.data.modal import ModalData, modal_data
from modefront.diagnosis.comparison import COMPARED, compare, of_few_sets
from modefront.errors import InputError
from modefront.models.chain import chain
from modefront.models.matrices import matrices
from modefront.modes.result import Modes
from modefront.pairing.match import Pairs
from modefront.residuals.base import ModeErrors, Scale
from modefront.residuals.groups import KINDS, Group
from modefront.residuals.problem import UpdatingProblem, updating_problem
from modefront.study.check import cause_of, check, compared
from modefront.study.definition import Study
from modefront.study.examples import write_example
from modefront.study.file import load
from modefront.study.session import run


@pytest.fixture
def study(tmp_path: Path) -> Study:
    write_example("three-story-c0", tmp_path)
    return load(tmp_path / "study.toml")


@pytest.mark.parametrize("width", [1e-12, 1e-9, 1e-6, 1e-3, 1.0 - 1e-6])
def test_derivatives_are_proved_however_narrow_the_bounds(width: float, study: Study) -> None:
    problem = study.problem
    unit = np.ones(3)
    narrow = replace(problem, lower=(1 - width) * unit, upper=(1 + width) * unit, start=unit)
    assert compared(narrow).error < 1e-9


def test_derivatives_are_proved_however_wide_the_bounds(study: Study) -> None:
    problem = study.problem
    wide = replace(problem, lower=np.full(3, 1e-6), upper=np.full(3, 1e6))
    assert compared(wide).error < 1e-9


def test_what_the_data_determine_is_said(study: Study) -> None:
    names = "theta1, theta2 and theta3"
    assert tuple(map(str, check(study).determined)) == (
        "group frequencies determines 3 of 3 combinations of parameters",
        f"group shapes determines 2 of 3 combinations of parameters; {names} can be scaled "
        "together: no shape changes",
        "all data determine 3 of 3 combinations of parameters",
    )


def test_a_nominal_value_at_a_bound_and_parameters_alike_are_warned_of(study: Study) -> None:
    problem = study.problem
    at_bound = replace(study, problem=replace(problem, lower=problem.start))
    assert "the nominal value of theta1 is one of its bounds, 1" in check(at_bound).warnings
    first = replace(problem, groups=(Group("first", frequency=[1]),))
    warnings = check(replace(study, problem=first)).warnings
    assert sum("do not determine" in text for text in warnings) == 2
    assert sum("nearly the same effect" in text for text in warnings) == 3


def test_more_parameters_than_the_memory_holds(
    study: Study, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("modefront.study.check.MANY", 1)
    assert any("parameters are many" in text for text in check(study).warnings)
    monkeypatch.setattr("modefront.study.check.available_memory", lambda: 10_000)
    with pytest.raises(InputError, match="as many parameters as fit into the 1e-05 GB"):
        run(study, tmp_path / "results")


def test_derivatives_that_are_wrong_are_told_by_parameter_and_mode(study: Study) -> None:
    agreement = compared(study.problem)
    text = str(cause_of(study.problem, agreement))
    (k,) = np.flatnonzero(agreement.step)
    assert f"for {study.problem.model.parameters[k]}, mostly by measured mode" in text
    low = replace(agreement, theta=-study.problem.start)
    assert "a small change leads to no model" in str(cause_of(study.problem, low))


def test_derivatives_are_proved_for_many_residuals_near_a_minimum() -> None:
    n, count = 2000, 12
    k = ("k1", "k2")
    springs = [k[i * 2 // n] for i in range(n)]
    model = chain(k, [1.0] * n, [1e6] * n, stiffness_parameters=springs)
    rng = np.random.default_rng(3)
    modes = model.modes(np.array([1.001, 0.999]), count, derivatives=False)
    shape = modes.phi.T * (1 + 0.01 * rng.standard_normal(modes.phi.T.shape))
    data = modal_data(modes.frequency, shape, model.sensors)
    groups = [Group("frequencies", frequency="all"), Group("shapes", shape="all")]
    bounds = dict.fromkeys(k, (0.2, 5.0))
    problem = updating_problem(model, data, groups, bounds, dict.fromkeys(k, 1.0))
    assert compared(problem).error < 1e-6


@pytest.mark.slow(8)
def test_of_many_data_sets_some_are_searched_for_mistakes(study: Study) -> None:
    problem = study.problem
    data = problem.data
    few, many = COMPARED, 5 * COMPARED + 1
    assert of_few_sets(compare(with_sets(problem, few))).data.sets == tuple(map(str, range(few)))
    lonely = with_sets(problem, many)
    lonely.data.frequency[:, 2] = np.nan
    lonely.data.shape[:, 2] = np.nan
    lonely.data.frequency[7, 2] = data.frequency[0, 2]
    lonely.data.shape[7, 2] = data.shape[0, 2]
    chosen = of_few_sets(compare(lonely)).data
    assert len(chosen.sets) == COMPARED + 1
    assert {"0", "7", str(many - 1)} <= set(chosen.sets)
    warnings = check(replace(study, problem=with_sets(problem, many))).warnings
    assert f"{many} data sets are many: mistakes are sought in {COMPARED} of them" in warnings[-1]


def with_sets(problem: UpdatingProblem, count: int) -> UpdatingProblem:
    """Return the problem with the same data again and again."""
    data = problem.data
    parts = ("frequency", "damping", "shape", "frequency_std", "shape_std")
    again: dict[str, Any] = {name: np.concatenate([getattr(data, name)] * count) for name in parts}
    sets = tuple(map(str, range(count)))
    return replace(problem, data=replace(data, sets=sets, **again))


@pytest.mark.parametrize(
    ("shapes", "known"),
    [
        (
            Group("shapes", shape="all"),
            [
                "modes 1, 2 of the nominal model coincide with others: their shapes are not "
                "defined; write subspace in place of shape in [[group]]"
            ],
        ),
        (Group("shapes", subspace="all"), []),
    ],
)
def test_shapes_of_modes_that_coincide_are_compared_by_their_subspace(
    shapes: Group, known: list[str]
) -> None:
    found = check(two_planes(shapes))
    assert not found.mistakes
    assert [x for x in found.warnings if "coincide" in x] == known


def two_planes(shapes: Group) -> UpdatingProblem:
    """Return two masses that move along x and y alike: two pairs of modes."""
    low, high = np.diag([1e4, 0.0]), np.array([[1e4, -1e4], [-1e4, 1e4]])
    stiffness = {"low": np.kron(np.eye(2), low), "high": np.kron(np.eye(2), high)}
    sensors = {"x1": 0, "x2": 1, "y1": 2, "y2": 3}
    model = matrices(["low", "high"], stiffness, {"base": np.eye(4)}, sensors)
    shape = np.array([[0.5, 0.9, -0.3, -0.5], [0.3, 0.5, 0.5, 0.9]])
    data = modal_data(np.array([9.9, 10.1]), shape, model.sensors)
    groups = [Group("frequencies", frequency="all"), shapes]
    bounds = {"low": (0.3, 3.0), "high": (0.3, 3.0)}
    return updating_problem(model, data, groups, bounds, {"low": 1.0, "high": 1.0})


class Share(OneSet):
    """Share of the first component of a shape in its square."""

    def margin(self, errors: ModeErrors) -> float:
        return float(errors.shape[self.mode[0]] ** 2)

    def r(self, modes: Modes, pairs: Pairs) -> Floats:
        square = modes.phi[:, pairs.index[self.mode]] ** 2
        return np.asarray(square[0] / square.sum(axis=0))

    def with_slopes(self, modes: Modes, pairs: Pairs) -> tuple[Floats, Floats]:
        phi, dphi = (x[:, pairs.index[self.mode]] for x in (modes.phi, modes.dphi))
        r, whole = self.r(modes, pairs), 2 * np.einsum("sm,smp->mp", phi, dphi)
        own = 2 * phi[0][:, None] * dphi[0]
        return r, (own - r[:, None] * whole) / (phi**2).sum(axis=0)[:, None]


class ShareKind:
    """Shares of first components."""

    name = "share"
    plural = "shares"
    usable_std = "none"

    def measured(self, data: ModalData) -> Bools:
        return np.ones(len(data.modes), dtype=np.bool_)

    def has_usable_std(self, data: ModalData, r: int) -> bool:
        return False

    def members(self, data: ModalData, modes: Sequence[int], scale: Scale) -> list[Any]:
        return [self.stack(data, [r], scale) for r in modes]

    def stack(self, data: ModalData, modes: Sequence[int], scale: Scale) -> Any:
        return Share(np.asarray(modes))


def test_residuals_of_shapes_that_users_add_are_warned_of_as_well() -> None:
    """A sum of two modes that coincide has another share."""
    known = dict(KINDS.added)
    try:
        mf.register(ShareKind())
        warnings = check(two_planes(Group("own", share="all"))).warnings
    finally:
        KINDS.added = known
    assert any("modes 1, 2 of the nominal model coincide with others" in x for x in warnings)
