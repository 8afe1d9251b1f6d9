"""Data that are drawn again."""

from dataclasses import replace

import numpy as np
import pytest

import modefront as mf
from modefront.errors import UnfinishedError
from modefront.optim.sqp import given
from modefront.plots.quantities import parameter_std
from modefront.uncertainty.points import Role, SolvedPoint, edge_weights, redraw, solve_again

OPEN = mf.Identifiability(models=0)


def data_of(sets: int) -> mf.ModalData:
    rng = np.random.default_rng(0)
    f, phi = rng.uniform(1, 2, (sets, 2)), rng.uniform(1, 2, (sets, 2, 3))
    names = ("a", "b", "c")
    return mf.modal_data(f, phi, names, frequency_std=0.1 * f, shape_std=0.2 * phi)


def test_sets_are_drawn_whole_and_with_replacement() -> None:
    data, rng = data_of(6), np.random.default_rng(1)
    seen = np.zeros(6)
    for _ in range(100):
        drawn = redraw(data, "sets", rng)
        assert drawn.frequency.shape == (6, 2)
        assert len(set(drawn.sets)) == 6
        index = [data.frequency[:, 0].tolist().index(x) for x in drawn.frequency[:, 0]]
        assert (drawn.shape == data.shape[index]).all()
        assert (drawn.frequency_std == data.frequency_std[index]).all()
        seen += np.bincount(index, minlength=6)
    # 600 drawings of six: 100 each, with a standard deviation of 9.
    assert (np.abs(seen - 100) < 40).all()


def test_what_was_measured_is_in_every_drawing() -> None:
    data, rng = data_of(3), np.random.default_rng(1)
    data.frequency[:2, 1] = np.nan
    for _ in range(30):
        assert np.isfinite(redraw(data, "sets", rng).frequency[:, 1]).any()


def test_drawings_that_hardly_ever_hold_everything_are_given_up() -> None:
    data = data_of(40)
    wide = mf.modal_data(
        np.where(np.eye(40) > 0, 1.0, np.nan), np.full((40, 40, 3), np.nan), data.sensors
    )
    with pytest.raises(UnfinishedError, match="none of 1000 drawings of the data sets"):
        redraw(wide, "sets", np.random.default_rng(0))


def test_values_are_drawn_with_their_standard_deviations() -> None:
    data, rng = data_of(1), np.random.default_rng(1)
    data.shape_std[0, 0, 0], data.shape_std[0, 0, 1] = np.nan, 0.0
    drawn = [redraw(data, "std", rng) for _ in range(2000)]
    f = np.array([sample.frequency for sample in drawn])
    assert f.mean(axis=0) == pytest.approx(data.frequency, rel=0.01)
    assert f.std(axis=0) == pytest.approx(data.frequency_std, rel=0.06)
    phi = np.array([sample.shape for sample in drawn])
    assert (phi[:, 0, 0, :2] == data.shape[0, 0, :2]).all(), "without one, it is exact"
    assert phi[:, 0, 1].std(axis=0) == pytest.approx(data.shape_std[0, 1], rel=0.06)


def test_a_source_that_the_data_do_not_have_is_refused() -> None:
    with pytest.raises(mf.InputError, match="source: expected a mode measured in two data sets"):
        mf.Uncertainty("sets").of(data_of(1))


def test_a_level_that_does_not_hold_its_objective_is_solved_again_without_a_warning() -> None:
    names, one = ("a", "b"), [1.0, 1.0]
    model = mf.chain(names, one, [100.0, 100.0], stiffness_parameters=names)
    modes = model.modes(np.ones(2), 2, derivatives=False)
    f, phi = 1.02 * modes.frequency, modes.phi.T + np.diag([0.1, 0.05])
    data = mf.modal_data(f, phi, model.sensors, frequency_std=0.01 * f, shape_std=0 * phi + 0.02)
    groups = mf.Group("f", frequency="all"), mf.Group("s", shape="all")
    bounds = dict.fromkeys(names, (0.5, 2.0))
    problem = mf.updating_problem(model, data, groups, bounds, dict.fromkeys(names, 1.0))
    start = given(problem.evaluate(problem.start))
    role = Role("level", objective=1, tolerance=0.05)
    point = SolvedPoint("end", replace(start, weights=np.array([1.0, 0.0])), role)
    solved = solve_again(problem, [point], np.ones(2), "std", rng=np.random.default_rng(0))
    assert solved["end"].converged


def test_points_of_all_kinds_are_solved_again_after_those_that_they_depend_on() -> None:
    """Of data without errors what is found again is what was found, from a start far away."""
    names = ("a", "b")
    model = mf.chain(names, [1.0] * 3, [100.0] * 3, stiffness_parameters=["a", "b", "b"])
    modes = model.modes(np.array([1.1, 0.9]), 3, derivatives=False)
    f, phi = modes.frequency * [1.03, 0.97, 1.02], modes.phi.T + np.diag([0.1, 0.05, -0.1])
    data = mf.modal_data(f, phi, model.sensors)
    groups = mf.Group("f", frequency="all"), mf.Group("s", shape="all")
    bounds = dict.fromkeys(names, (0.1, 10.0))
    problem = mf.updating_problem(model, data, groups, bounds, dict.fromkeys(names, 1.0))
    sizes, start = np.array([0.01, 2.0]), given(problem.evaluate(np.array([1.6, 0.7])))
    w, beta = np.array([3.0, 0.5]), np.array([0.4, 0.6])
    roles = {
        "nbi": Role("boundary", ("f", "s")),
        "das": Role("boundary", ("f", "s"), equations=True),
        "end": Role("end", ("s",)),
        "optimal": Role("optimal"),
        "sum": Role("weights"),
        "level": Role("level", objective=1, tolerance=0.02),
        "f": Role("edge", objective=0),
        "s": Role("edge", objective=1),
    }
    at = replace(start, weights=w, beta=beta)
    points = [SolvedPoint(name, at, role) for name, role in roles.items()]
    for source in ("std", "sets"):
        rng = np.random.default_rng(0)
        found = solve_again(problem, points, sizes, source, rng=rng)
        assert [*found][-1] in ("nbi", "das", "end")
        assert found["end"] is found["s"]
        assert all(x.converged for name, x in found.items())
        of = {
            "f": edge_weights(0, sizes),
            "s": edge_weights(1, sizes),
            "sum": w,
            "optimal": problem.properties / found["optimal"].J,
        }
        for name, weights in of.items():
            slope, before = (weights @ x.evaluation.dJ for x in (found[name], start))
            assert np.abs(slope).max() < 1e-4 * np.abs(before).max()
        best, level = found["s"], found["level"]
        assert level.J[1] == pytest.approx(1.02 * best.J[1], rel=1e-4)
        assert level.J[0] < best.J[0]
        edges = np.array([found["f"].J, found["s"].J])
        least, most = np.diag(edges), np.diag(edges[::-1])
        for name in ("nbi", "das"):
            excess = (found[name].J - least) / (most - least) - beta[::-1]
            assert np.ptp(excess) == pytest.approx(0, abs=1e-4)
    assert edge_weights(0, sizes) == pytest.approx([1 / 0.01, 1e-4 / 2.0])
    flat = [points[-1], SolvedPoint("same", at, Role("boundary", ("s", "s")))]
    none = solve_again(problem, flat, sizes, "std", rng=np.random.default_rng(0))["same"]
    assert none.theta.tolist() == start.theta.tolist()
    assert not none.converged


@pytest.mark.slow(3)
@pytest.mark.usefixtures("short_chains")
def test_the_most_probable_model_has_its_posterior_and_is_not_solved_again_by_weights() -> None:
    """Least is not what the groups sum: of two frequencies, the data know one thirty times better.

    Solved again with weights of groups, it left for where both count the same.
    """
    model = mf.chain(["k"], [1.0] * 3, [100.0] * 3, stiffness_parameters=["k"] * 3)
    f = model.modes(np.ones(1), 3, derivatives=False).frequency * [1.03, 0.97, 1.02]
    unknown = np.full((3, 3), np.nan)
    data = mf.modal_data(f, unknown, model.sensors, frequency_std=f * [0.001, 0.03, 0.001])
    groups = mf.Group("two", frequency=[1, 2]), mf.Group("one", frequency=[3])
    problem = mf.updating_problem(model, data, groups, {"k": (0.3, 3.0)}, {"k": 1.0})
    again, search = mf.Uncertainty(bootstrap=2), mf.Search(doubt=0.5)
    found = mf.solve(problem, points=3, search=search, uncertainty=again, identifiability=OPEN)
    best = found["label"].values == "most-probable"
    for known in (found["theta_std"].values, found["bootstrap_theta_std"].values):
        assert np.isnan(known[best]).all()
        assert np.isfinite(known[~best][:3]).all()
    assert parameter_std(found.data)[best] == pytest.approx(found["posterior_std"].values[None])
    change = np.ptp(found["front_misfit"].values[found["kind"].values == "front"], axis=0)
    assert f"change by {change.max():.2g} times those expected" in " ".join(found.verdict)
    assert "no-scatter" not in [x.kind for x in found.findings]
