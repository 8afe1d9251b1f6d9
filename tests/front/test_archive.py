"""The archive of evaluated models: nondominated ones by comparison of all, and after a break."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from interruptions import interrupt_after
from problems import box, circles, disconnected

from modefront._typing import Floats
from modefront.front.dominance import Archive
from modefront.front.front import Front
from modefront.front.options import Pareto
from modefront.front.pareto import pareto_front
from modefront.front.search import State, recorded
from modefront.optim.problem import Evaluation, Problem
from modefront.work.store import Run, Store
from modefront.work.task import IMMEDIATE, Costs, Executor, Task


def dominated(J: Floats, others: Floats) -> bool:
    """Return whether one of the others is nowhere greater than J and somewhere less."""
    return any((other <= J).all() and (other < J).any() for other in others)


@pytest.mark.parametrize("n", [2, 3, 4])
def test_it_holds_the_nondominated_models_of_all(n: int) -> None:
    rng = np.random.default_rng(n)
    J = rng.integers(0, 12, size=(300, n)).astype(float)
    J[7, 0] = np.inf
    theta = rng.uniform(size=(300, 2))
    archive = Archive(n)
    for chosen, value in zip(theta, J, strict=True):
        archive.add(value, chosen)
    finite = J[np.isfinite(J).all(axis=1)]
    expected = {tuple(row) for row in finite.tolist() if not dominated(np.array(row), finite)}
    assert len(archive.J) == len(expected), "models with the same objectives are kept once"
    assert {tuple(row) for row in archive.J.tolist()} == expected
    known = {chosen.tobytes(): value for chosen, value in zip(theta, J, strict=True)}
    for chosen, value in zip(archive.models, archive.J, strict=True):
        assert (known[chosen.tobytes()] == value).all(), "each with its own parameters"
    for row in finite[:50]:
        beaten = (archive.J <= row).all(axis=1) & (archive.J < row).any(axis=1)
        assert beaten.any() == dominated(row, finite)


def visited(problem: Problem, *thetas: list[float]) -> None:
    for theta in thetas:
        problem.evaluate(np.array(theta), derivatives=False)


def test_of_a_problem_that_is_recorded_all_evaluations_are_counted_and_the_best_kept(
    costs: Costs,
) -> None:
    problem = box(circles, [-1, -1], [2, 2])
    outcome = recorded(visited, None, problem, [0.5, 1.0], [0.5, 0.5], [0.0, 0.0])
    assert outcome.theta.tolist() == [[0.5, 0.5], [0.0, 0.0]]
    assert outcome.evaluations == costs.eigenproblems == 3


def middle(problem: Problem, share: float) -> Evaluation:
    problem.evaluate(problem.upper)
    return problem.evaluate(problem.lower + share * (problem.upper - problem.lower))


def test_a_task_brings_its_result_with_the_models_that_it_evaluated() -> None:
    outcome = recorded(middle, None, box(circles, [-1, -1], [2, 2]), 0.5)
    assert outcome.result.theta.tolist() == [0.5, 0.5]
    assert outcome.theta.tolist() == [[0.5, 0.5]], "the other one is dominated"
    assert outcome.J.tolist() == [[0.5, 0.5]]
    assert outcome.evaluations == 2


def test_a_task_ends_where_its_evaluations_are_spent_and_its_models_are_known() -> None:
    problem = box(circles, [-1, -1], [2, 2])
    cut = recorded(middle, 1, problem, 0.5)
    assert cut.result is None
    assert cut.spent
    assert (cut.evaluations, cut.theta.tolist()) == (1, [[2.0, 2.0]])
    whole = recorded(middle, 2, problem, 0.5)
    assert not whole.spent
    assert whole.evaluations == 2


def test_tasks_share_what_is_left_of_the_budget() -> None:
    problem = box(circles, [-1, -1], [2, 2])
    state = State(problem)
    tasks = [Task(("test", k), middle, (problem, share)) for k, share in enumerate((0.3, 0.6))]
    assert not any(x.spent for x in state.run(tasks, 7))
    assert state.evaluations == 4
    assert [x.result for x in state.run(tasks, 3)] == [None, None], "three are left, one for each"
    assert state.evaluations == 6
    assert not any(x.spent for x in state.run(tasks)), "what has to be done is done"
    assert state.evaluations == 10


def computed_front(work: Executor) -> Front:
    problem = box(disconnected, [0, -1], [1, 1])
    options = Pareto(points=5)
    return pareto_front(problem, np.ones(2), options, work=work)


@cache
def whole_front() -> Front:
    return computed_front(IMMEDIATE)


@pytest.mark.parametrize("tasks", [2, 40])
def test_a_run_that_is_continued_knows_the_same_models(
    tasks: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = whole_front()
    interrupt_after(tasks, monkeypatch)
    with pytest.raises(KeyboardInterrupt):
        computed_front(Run(Store(tmp_path)))
    again = computed_front(Run(Store(tmp_path)))
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
