"""What is reported of ends that are not known, of copies, and of flat parts that are not cut."""

import json
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pytest
import xarray as xr

import modefront as mf
from modefront._typing import Floats
from modefront.analysis import front as analysis
from modefront.cli.show import as_json, print_results
from modefront.fronts.driver import pareto_front
from modefront.fronts.methods import nbi
from modefront.fronts.options import Pareto
from modefront.fronts.point import Kind, of_kind
from modefront.identifiability.options import Identifiability
from modefront.results.assemble import _lattice
from modefront.results.remarks import remarks
from modefront.solvers.continuation import Simplex, simplex
from modefront.solvers.explore import Search
from modefront.solvers.flat import Identifiable
from modefront.solvers.gaps import Gap
from modefront.solvers.payoff import Payoff
from modefront.solvers.problem import Evaluation, ObjectiveDerivatives
from modefront.solvers.sqp import Solution, Status, begin
from modefront.study.examples import write_example


def on_a_line(theta: Floats) -> tuple[Floats, Floats, Floats]:
    """Squared distances from (0, 0), (1, 0) and (2, 0): the front is a curve, not a surface."""
    r = theta - np.array([[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]])
    return (r**2).sum(axis=1), 2 * r, np.array([2 * np.eye(2)] * 3)


@dataclass(frozen=True)
class Bowls:
    """Squared distances from three points on a line, as a problem."""

    lower: Floats
    upper: Floats
    start: Floats
    objectives: tuple[str, ...] = ("left", "middle", "right")

    def evaluate(self, theta: Floats, *, derivatives: bool = True) -> Evaluation:
        del derivatives
        J, dJ, H = on_a_line(theta)
        return Evaluation(theta, J, ObjectiveDerivatives(dJ, H))

    def on_branch(self, branch: tuple[int, ...]) -> "Bowls":
        del branch
        return self


SEARCH = Search(starts=3, limit=4, evolutions=0)


def c0() -> mf.UpdatingProblem:
    with TemporaryDirectory() as folder:
        write_example("three-story-c0", Path(folder))
        return mf.load(Path(folder) / "study.toml").problem


def solved(**more: Any) -> xr.Dataset:
    how = Identifiability(models=0)
    return mf.solve(c0(), points=8, search=SEARCH, seed=1, identifiability=how, **more).dataset


def test_an_end_that_is_not_known_is_said_and_is_no_number(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def unknown(_: object, points: list[Solution], *__: object, **___: object) -> list[Gap]:
        return [Gap(points[2], points[3], None, points[3])]

    monkeypatch.setattr(nbi, "gaps", unknown)
    data = solved()
    assert data["end_label"].values.tolist() == ["end-1", "start-2"]
    assert np.isnan(data["end_objective"].values[0]).all()
    assert np.isnan(data["end_theta"].values[0]).all()
    assert data["end_converged"].values.tolist() == [False, True]
    messages = [text for text in remarks(data) if "the front has a gap" in text]
    assert messages == ["the front has a gap: where branch 1 ends is not known"]
    J, piece = data["objective"].values, data["piece"].values
    middle = (J[2, 0] + J[3, 0]) / 2
    on = piece > 0
    assert (piece[on] == 1 + (J[on, 0] > middle)).all()

    reported = json.loads(as_json(data), parse_constant=pytest.fail)
    ends = reported["variables"]["end_objective"]["values"]
    assert ends[0] == [None, None]
    assert ends[1] == data["end_objective"].values[1].tolist()
    assert messages[0] in reported["remarks"]
    print_results(data, ["findings"])
    shown = capsys.readouterr().out
    assert messages[0] in " ".join(shown.split())
    assert "nan" not in shown


def test_a_flat_part_that_is_not_cut_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    part = Identifiable(np.array([0, 0]), np.array([0, 3]), [], None, [])

    def uncut(_: object, __: object, edges: list[Solution], *___: object) -> object:
        return replace(part, ends=edges)

    monkeypatch.setattr(analysis, "identifiable_part", uncut)
    data = solved()
    (message,) = [text for text in data["finding"].values.tolist() if "flat" in text]
    assert message == (
        "the front is flat at edge-shapes: 3 of 8 points are within 1 % of the least J of shapes; "
        "where that part ends was not found, so it is not cut"
    )
    assert data["flat"].values.tolist() == [0, 0]


def test_no_point_of_three_groups_comes_twice_and_places_tell_where_they_led() -> None:
    problem = Bowls(np.array([-1.0, -1.0]), np.array([3.0, 1.0]), np.array([0.2, 0.4]))
    front = pareto_front(problem, np.ones(3), Pareto(points=4), search=SEARCH)
    assert front.scale is not None
    along = [point.solution for point in of_kind(front.points, Kind.FRONT)]
    J = np.array([point.J for point in along]) / front.scale
    apart = np.abs(J[:, None] - J).max(axis=2) + np.eye(len(J))
    assert (apart > 1e-5).all()
    lattice = _lattice(front)
    beta, labels = np.asarray(lattice["lattice"]), np.asarray(lattice["lattice_label"]).tolist()
    assert beta.shape == (10, 3)
    assert set(labels) <= {f"nbi-{k + 1}" for k in range(len(along))}
    assert len(set(labels)) < 10, "several places lead to one point"
    # Each edge lies where the others have no part.
    thetas = {point.label: point.solution.theta for point in front.points}
    for i in (0, 1, 2):
        label = labels[np.flatnonzero(beta[:, i] == 1)[0]]
        assert thetas[label] == pytest.approx([i, 0.0], abs=1e-4)


def point(J: Floats, beta: Floats | None, *, converged: bool = True) -> Solution:
    position = Evaluation(J, J)
    status = Status.CONVERGED if converged else Status.STALLED
    return replace(begin(position), status=status, beta=beta)


def test_copies_are_merged_and_their_places_kept() -> None:
    lattice: Simplex = simplex(3, 2)
    target = Payoff(np.zeros(3), np.ones(3), 1 - np.eye(3))
    position = [point(1 - beta, beta) for beta in lattice.beta]
    position[2] = point(position[1].J + 5e-6, lattice.beta[2])
    position[3] = point(position[4].J + 2e-5, lattice.beta[3])
    position[0] = replace(position[0], status=Status.STALLED)
    better = point(position[0].J - 1e-6, None)
    along = [*position[:5], better]
    result = nbi._without_copies(lattice, position, along, target)
    # The third is a copy of the second, what came last is the first, but converged; the sixth
    # place led to nothing that is left.
    assert [point.J.tolist() for point in result.points] == [
        solution.J.tolist() for solution in (better, position[1], position[3], position[4])
    ]
    assert result.places.tolist() == [0, 1, 1, 2, 3, -1]
