"""The archive of evaluated models: nondominated ones by comparison of all, and after a break."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from interruptions import interrupt_after
from problems import Derivatives, box, circles, disconnected

from modefront._typing import Floats
from modefront.fronts.driver import pareto_front
from modefront.fronts.front import Front
from modefront.fronts.methods import METHODS
from modefront.fronts.methods.base import Along, Setting
from modefront.fronts.methods.nbi import NormalBoundaryIntersection
from modefront.fronts.options import Pareto
from modefront.fronts.point import Kind, of_kind
from modefront.solvers.archive import Archive
from modefront.solvers.explore import Search
from modefront.work.costs import Costs
from modefront.work.run import Run
from modefront.work.store import Store


def dominated(J: Floats, others: Floats) -> bool:
    """Return whether one of the others is nowhere greater than J and somewhere less."""
    return any((other <= J).all() and (other < J).any() for other in others)


@pytest.mark.parametrize("n", [2, 3, 4])
def test_it_holds_the_nondominated_models_of_all(n: int) -> None:
    rng = np.random.default_rng(n)
    J = rng.integers(0, 12, size=(300, n)).astype(float)
    J[7, 0] = np.inf
    theta = rng.uniform(size=(300, 2))
    archive = Archive(box(circles, [0, 0], [1, 1], n))
    for chosen, value in zip(theta, J, strict=True):
        archive.add(chosen, value)
    finite = J[np.isfinite(J).all(axis=1)]
    expected = {tuple(row) for row in finite.tolist() if not dominated(np.array(row), finite)}
    assert len(archive.J) == len(expected), "models with the same objectives are kept once"
    assert {tuple(row) for row in archive.J.tolist()} == expected
    known = {chosen.tobytes(): value for chosen, value in zip(theta, J, strict=True)}
    for chosen, value in zip(archive.theta, archive.J, strict=True):
        assert (known[chosen.tobytes()] == value).all(), "each with its own parameters"
    for row in finite[:50]:
        beaten = (archive.J <= row).all(axis=1) & (archive.J < row).any(axis=1)
        assert beaten.any() == dominated(row, finite)


def test_models_are_remembered_that_are_evaluated_but_not_those_of_a_branch(costs: Costs) -> None:
    problem = box(circles, [-1, -1], [2, 2])
    archive = Archive(problem)
    archive.on_branch(()).evaluate(np.array([0.5, 0.0]))
    assert len(archive.J) == 0
    for theta in ([0.5, 1.0], [0.5, 0.5], [0.0, 0.0]):
        archive.evaluate(np.array(theta), derivatives=False)
    assert archive.theta.tolist() == [[0.5, 0.5], [0.0, 0.0]]
    assert costs.eigenproblems == 4


def computed_front(folder: Path) -> Front:
    problem = box(disconnected, [0, -1], [1, 1])
    search = Search(starts=2, limit=2, evolutions=0)
    options = Pareto(points=7, refined=0.2)
    return pareto_front(problem, np.ones(2), options, search=search, work=Run(Store(folder)))


@pytest.mark.parametrize("tasks", [2, 9, 14])
def test_a_run_that_is_continued_knows_the_same_models(
    tasks: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = computed_front(tmp_path / "whole")
    interrupt_after(tasks, monkeypatch)
    with pytest.raises(KeyboardInterrupt):
        computed_front(tmp_path / "broken")
    again = computed_front(tmp_path / "broken")
    assert len(whole.known) > 20
    assert again.known.tobytes() == whole.known.tobytes()
    assert again.places.tolist() == whole.places.tolist()
    assert [x.label for x in again.points] == [x.label for x in whole.points]
    for point, other_point in zip(again.points, whole.points, strict=True):
        first, other = point.solution, other_point.solution
        assert first.theta.tobytes() == other.theta.tobytes()
        assert first.J.tobytes() == other.J.tobytes()
        assert first.status is other.status
    for gap, other_gap in zip(again.gaps, whole.gaps, strict=True):
        for end, other_end in zip(gap.ends, other_gap.ends, strict=True):
            assert end.J.tobytes() == other_end.J.tobytes()


def narrow(depth: float) -> Callable[[Floats], Derivatives]:
    """Return two distances of x, the second one with a well at z = 0.7 that no search leads to."""

    def function(theta: Floats) -> Derivatives:
        x, z = theta
        e = np.exp(-(((z - 0.7) / 0.02) ** 2))
        J = np.array([x**2, (x - 1) ** 2 + depth * (1 - e)])
        dJ = np.array([[2 * x, 0.0], [2 * x - 2, depth * e * 2 * (z - 0.7) / 0.02**2]])
        return J, dJ, np.array([np.diag([2.0, 0.0])] * 2)

    return function


@pytest.mark.parametrize(("depth", "times"), [(0.005, 1), (0.5, 2)])
def test_a_front_is_sought_again_only_where_an_edge_has_become_much_better(
    depth: float, times: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    sought: list[Along] = []

    class Meeting(NormalBoundaryIntersection):
        def along(self, setting: Setting) -> Along:
            """Return the front, on the way to which a model in the well is evaluated."""
            setting.archive.evaluate(np.array([1.0, 0.701]))
            sought.append(super().along(setting))
            return sought[-1]

    monkeypatch.setitem(METHODS, "nbi", Meeting())
    problem = box(narrow(depth), [-0.5, -1.0], [1.5, 1.0])
    search = Search(starts=1, limit=1, evolutions=0)
    front = pareto_front(problem, np.ones(2), Pareto(points=5), search=search)
    assert len(sought) == times
    assert front.edges[1].best.theta == pytest.approx([1.0, 0.7], abs=1e-4)
    along = [point.solution for point in of_kind(front.points, Kind.FRONT)]
    assert along[-1].J == pytest.approx(front.edges[1].best.J, abs=1e-9), "the edge ends the front"
