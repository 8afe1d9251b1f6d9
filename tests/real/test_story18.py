"""Combinations that data of an 18-story frame determine: 3 modes at 6 floors, 18 stiffnesses.

The data lie beside the project (origin and licence: see the README there) and are not part of it.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import scipy.sparse

import modefront as mf
from modefront.identifiability.combinations import NONE, combinations
from modefront.study.check import compared, determined

FILE = Path(__file__).parents[3] / "shared" / "data" / "smu" / "story18_exp.npz"
STORIES = 18
NAMES = tuple(f"k{i + 1}" for i in range(STORIES))


@pytest.fixture(scope="module")
def frame() -> mf.UpdatingProblem:
    """The frame with story stiffnesses relative to nominal, within 30 %."""
    if not FILE.is_file():
        pytest.skip(f"no {FILE}: measured data lie beside the project and are not part of it")
    with np.load(FILE, allow_pickle=False) as file:
        result = {name: file[name] for name in file.files}

    def matrix(name: str) -> scipy.sparse.csr_array:
        entries = result[f"{name}_val"], (result[f"{name}_row"], result[f"{name}_col"])
        return scipy.sparse.csr_array(entries, shape=(STORIES, STORIES))

    stiffness = {name: matrix(f"K{i}") for i, name in enumerate(NAMES)}
    sensors = {f"floor{dof + 1}": int(dof) for dof in result["meas_dofs0"]}
    model = mf.matrices(NAMES, stiffness, {"base": matrix("M")}, sensors)
    frequencies = np.sqrt(result["lambda_exp"]) / (2 * np.pi)
    data = mf.modal_data(frequencies, result["psi_exp"].T, tuple(sensors))
    groups = [mf.Group("frequencies", frequency="all"), mf.Group("shapes", shape="all")]
    bounds = dict.fromkeys(NAMES, (0.7, 1.3))
    return mf.updating_problem(model, data, groups, bounds, dict.fromkeys(NAMES, 1.0))


def first_two(frame: mf.UpdatingProblem) -> mf.UpdatingProblem:
    """The two modes that the authors of the data use."""
    return replace(
        frame, groups=(mf.Group("frequencies", frequency=[1, 2]), mf.Group("shapes", shape=[1, 2]))
    )


def ranks(frame: mf.UpdatingProblem) -> list[int]:
    result = [combinations(frame, frame.evaluate(frame.start), group) for group in (0, 1, None)]
    return [sum(row.share > NONE for row in rows) for rows in result]


def test_each_measured_number_determines_one_combination(frame: mf.UpdatingProblem) -> None:
    """A frequency determines one combination, and a shape one a floor but for its scale."""
    assert ranks(frame) == [3, 3 * 5, 18]
    assert ranks(first_two(frame)) == [2, 2 * 5, 12]
    scaled = combinations(frame, frame.evaluate(frame.start), 1)
    free = np.array([combination.direction for combination in scaled if combination.share <= NONE])
    together = np.ones(STORIES) / np.sqrt(STORIES)
    assert np.linalg.norm(free @ together) == pytest.approx(1, abs=1e-9)


def test_the_check_says_so_in_words(frame: mf.UpdatingProblem) -> None:
    problem = first_two(frame)
    known, _ = determined(problem, problem.evaluate(problem.start))
    frequencies, shapes, together = map(str, known)
    assert frequencies.startswith(
        "group frequencies determines 2 of 18 combinations of parameters; "
    )
    assert frequencies.endswith("; and 13 more: no frequency changes")
    assert shapes.startswith("group shapes determines 10 of 18 combinations of parameters")
    assert "; all 18 parameters can be scaled together; " in shapes
    assert shapes.endswith("; and 5 more: no shape changes")
    assert together.startswith("all data determine 12 of 18 combinations of parameters")
    assert "; and 3 more: no residual changes" in together
    assert compared(frame).error < 1e-5


@pytest.mark.slow(5)
def test_the_results_say_so_too(frame: mf.UpdatingProblem) -> None:
    search = mf.Search(doubt=0.5)
    data = mf.solve(
        first_two(frame), points=2, search=search, identifiability=mf.Identifiability(models=10)
    ).dataset
    share = data["combination_share"].values
    position, of = data["combination_at"].values, data["combination_of"].values
    for place in ("most-probable", "edge-shapes"):
        counts = [
            int((share[(position == place) & (of == name)] > NONE).sum())
            for name in ("frequencies", "shapes", "all data")
        ]
        assert counts == [2, 10, 12]
    assert any(
        text.startswith("at most-probable: all data determine 12 of 18 combinations")
        for text in data["finding"].values
    )
    # What the data leave open the bounds decide: at least six parameters lie at one.
    labels = data["label"].values.tolist()
    assert np.abs(data["at_bound"].values[labels.index("optimal-weights")]).sum() >= 6
    low, _, high = data["interval"].values.T
    lower, upper = data["bounds"].values.T
    assert ((lower <= low) & (low < high) & (high <= upper)).all(), "draws lie within the bounds"
    of = data["equal_of"].values
    dimensions = data["equal_dimension"].values[of == "frequencies"]
    assert dimensions.size >= 10
    assert (dimensions == 16).all()
    J = data["equal_objective"].values[of == "frequencies", 0]
    assert J == pytest.approx(J[0], abs=1e-9)
