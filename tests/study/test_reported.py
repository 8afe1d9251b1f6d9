"""Reports of unknown ends, of copies, and of flat parts that are not cut."""

import json
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
import xarray as xr

import modefront as mf
from modefront._typing import Floats
from modefront.analysis import front as analysis
from modefront.analysis.front import Identifiable
from modefront.cli.show import as_json, print_results
from modefront.front import pareto
from modefront.front.dominance import distinct_points
from modefront.front.gaps import Gap
from modefront.front.options import Pareto
from modefront.front.pareto import pareto_front
from modefront.front.point import Kind, of_kind
from modefront.front.search import Search
from modefront.identifiability.combinations import Identifiability
from modefront.optim.problem import Evaluation
from modefront.optim.sqp import Solution, Status, begin
from modefront.results.assemble import lattice_values
from modefront.results.remarks import findings_of
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

    def evaluate(
        self, theta: Floats, *, derivatives: bool = True, second: bool = False
    ) -> Evaluation:
        del derivatives
        J, dJ, H = on_a_line(theta)
        return Evaluation(theta, J, dJ, H)


SEARCH = Search(doubt=0.5)


def c0() -> mf.UpdatingProblem:
    with TemporaryDirectory() as folder:
        write_example("three-story-c0", Path(folder))
        return mf.load(Path(folder) / "study.toml").problem


def solved() -> xr.Dataset:
    how = Identifiability(models=0)
    return mf.solve(
        c0(),
        points=8,
        programme="equations",
        search=SEARCH,
        seed=1,
        identifiability=how,
        noise=mf.NoisePrior(weight=0),
    ).dataset


def test_an_end_that_is_not_known_is_said_and_is_no_number(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def unknown(_: object, points: list[Solution], *__: object, **___: object) -> list[Gap]:
        return [Gap((points[2].J[0] + points[3].J[0]) / 2, None, points[3])]

    monkeypatch.setattr(pareto, "gaps", unknown)
    data = solved()
    assert data["end_label"].values.tolist() == ["end-1", "start-2"]
    assert np.isnan(data["end_objective"].values[0]).all()
    assert np.isnan(data["end_theta"].values[0]).all()
    assert data["end_converged"].values.tolist() == [False, True]
    messages = [
        text
        for text in list(map(str, findings_of(data, full=True)))
        if "the front has a gap" in text
    ]
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
    part = Identifiable(np.array([0, 0]), np.array([0, 3]))
    monkeypatch.setattr(analysis, "identifiable_part", lambda *_: part)
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
    lattice = lattice_values(front)
    beta, labels = np.asarray(lattice["lattice"]), np.asarray(lattice["lattice_label"]).tolist()
    assert len(beta) > len(along) == 10, "several places lead to one point, and others are added"
    assert set(labels) == {f"nbi-{k + 1}" for k in range(len(along))}
    # Each edge lies where the others have no part.
    thetas = {point.label: point.solution.theta for point in front.points}
    for i in (0, 1, 2):
        label = labels[np.flatnonzero(beta[:, i] == 1)[0]]
        assert thetas[label] == pytest.approx([i, 0.0], abs=1e-3)


def point(J: Floats) -> Solution:
    return replace(begin(Evaluation(J, J)), status=Status.CONVERGED)


def test_copies_are_merged_and_converged_ones_kept() -> None:
    J = np.array([[1.0, 0.0], [0.5, 0.5], [0.0, 1.0]])
    first, second, third = (point(x) for x in J)
    stalled = replace(first, status=Status.STALLED)
    copy, apart = point(J[1] + 5e-6), point(J[2] + 2e-5)
    points = [stalled, second, copy, third, apart, point(J[0] - 1e-6)]
    kept = distinct_points(points, np.ones(2))
    assert [x.J.tolist() for x in kept] == [x.J.tolist() for x in (points[5], second, third, apart)]
    assert all(x.converged for x in kept)
    # over a greater range, more of them are copies
    assert len(distinct_points(points, np.full(2, 10.0))) == 3
