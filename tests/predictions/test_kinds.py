"""Predictions check themselves, with the same words in Python and in a study file."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from two_masses import FRF, PASSAGE, write_study

import modefront as mf
from modefront.predictions import CLASSES, Prediction

PEAK: dict[str, Any] = {"name": "peak", "response": ["high"], "force": "high", "damping": 0.02}
DRIFT: dict[str, Any] = {
    **{"name": "drift", "response": "low", "density": 0.5, "sided": "two", "levels": [0.1]},
    **{"duration": 4.0, "base": "x", "damping": 0.02},
}
SEED = np.random.SeedSequence(0)


@pytest.fixture
def problem(tmp_path: Path) -> mf.UpdatingProblem:
    return mf.load(write_study(tmp_path, "")).problem


@pytest.mark.parametrize(
    ("kind", "values", "says"),
    [
        (mf.PeakResponse, PEAK | {"damping": "mesured"}, "damping: expected 'measured', or a rat"),
        (mf.PeakResponse, PEAK | {"band": (5.0, 1.0)}, "band: expected [lowest, highest] frequen"),
        (mf.PeakResponse, PEAK | {"base": "x"}, "expected either force or base, found both"),
        (mf.PeakResponse, PEAK | {"force": None}, "expected either force or base, found neither"),
        (mf.PeakResponse, PEAK | {"force": ["high"]}, "force: expected the name of a sensor or"),
        (mf.PeakResponse, PEAK | {"force": {"high": 0}}, "force: expected the name of a sensor or"),
        (mf.PeakResponse, PEAK | {"static": 1}, "static: expected true or false, found 1"),
        (mf.PeakResponse, PEAK | {"quantity": "force"}, "quantity: expected one of 'receptance'"),
        (
            mf.PeakResponse,
            PEAK | {"quantity": "absolute accelerance"},
            "quantity: expected another one where forces act, found 'absolute accelerance'",
        ),
        (
            mf.PeakResponse,
            PEAK | {"modes": 2, "damping": [0.02]},
            "damping: expected a list of 2, one a mode, found 1 of them",
        ),
        (mf.Passage, DRIFT | {"sided": "One"}, "sided: expected one of 'one', 'two', found 'One'"),
        (mf.Passage, DRIFT | {"levels": [0.1, 0.1]}, "levels: expected a list of different lev"),
        (mf.Passage, DRIFT | {"step": 0.03}, "step: expected a whole number of steps of 0.03 s in"),
        (mf.Passage, DRIFT | {"filter": 2.5}, "filter: expected a table { frequency, damping }"),
        (mf.Passage, DRIFT | {"modulation": [[1, 0]]}, "modulation: expected a list of [time in"),
        (mf.Passage, DRIFT | {"method": "subset"}, "method: expected one of 'importance', 'direc"),
    ],
)
def test_what_is_not_possible_is_refused(kind: Any, values: dict[str, Any], says: str) -> None:
    with pytest.raises(mf.InputError) as caught:
        kind(**values)
    assert str(caught.value).startswith(says)


@pytest.mark.parametrize(
    ("prediction", "says"),
    [
        (
            mf.PeakResponse(**PEAK | {"force": "hihg"}),
            "'peak' force: expected the name of a sensor",
        ),
        (mf.PeakResponse(**PEAK | {"modes": 3}), "'peak' modes: expected a whole number from 1 to"),
        (
            mf.PeakResponse(**PEAK | {"damping": [0.1] * 3}),
            "'peak' damping: expected at most 2 rat",
        ),
        (
            mf.Passage(**DRIFT | {"base": "y"}),
            "'drift' base: expected one of the directions of the",
        ),
        (mf.Passage(**DRIFT | {"step": 0.1}), "'drift' step: expected at most 0.0"),
        (mf.Passage(**DRIFT | {"duration": 1e7}), "'drift' step: expected at most 1000000 time st"),
    ],
)
def test_what_the_model_cannot_predict_is_refused_before_any_work(
    prediction: Any, says: str, problem: mf.UpdatingProblem
) -> None:
    with pytest.raises(mf.InputError, match=f"^prediction {says}"):
        mf.solve(problem, predictions=[prediction])


def test_names_are_given_once(problem: mf.UpdatingProblem) -> None:
    peak = mf.PeakResponse(**PEAK)
    with pytest.raises(mf.InputError, match="predictions: expected each name once, found 'peak'"):
        mf.solve(problem, predictions=[peak, peak])


def test_python_and_the_study_file_make_the_same_predictions(tmp_path: Path) -> None:
    study = mf.load(write_study(tmp_path, FRF + PASSAGE))
    drift = {"high": 1.0, "low": -1.0}
    made: list[Prediction] = [
        mf.PeakResponse(
            "pushed",
            {"low": "low", "drift": drift},
            force={"high": 2},
            band=(0, 20),
            damping=[0.02, 0.03],
            quantity="mobility",
        ),
        mf.PeakResponse("shaken", ["low", "middle"], base="x", quantity="accelerance"),
        mf.PeakResponse(
            "as if shaken",
            ["low", "middle"],
            force={"low": -2, "high": -1},
            quantity="accelerance",
        ),
        mf.PeakResponse("ridden", "high", base="x", damping=0.02, quantity="absolute accelerance"),
        mf.PeakResponse("overdamped", "low", force="low", band=(0.1, 20), modes=2, damping=0.8),
        mf.Passage(
            "drifts",
            {"lower": "low", "upper": drift},
            *(0.05, "one", (0.02, 0.025), 6.0),
            base="x",
            filter=mf.SoilFilter(4.0, 0.6),
            modulation=((0, 0), (2, 1), (4, 0.5)),
            step=0.01,
            samples=1500,
            damping=0.02,
        ),
    ]
    assert [each.complete(study.problem) for each in made] == list(study.predictions)


def test_defaults_follow_from_data_and_nominal_model(problem: mf.UpdatingProblem) -> None:
    peak = mf.PeakResponse(**PEAK).complete(problem)
    assert peak.band == pytest.approx((0.0, 1.1 * 10.5))
    assert peak.modes == 2
    drift = mf.Passage(**DRIFT).complete(problem)
    highest = problem.modes(problem.start, derivatives=False)[0].frequency[1]
    assert drift.step is not None
    assert drift.step <= 1 / (20 * highest) < 1.01 * drift.step
    assert drift.duration / drift.step == pytest.approx(round(drift.duration / drift.step))
    for prediction in (peak, drift):
        assert prediction.complete(problem) == prediction


def test_what_is_not_complete_is_not_evaluated(problem: mf.UpdatingProblem) -> None:
    for prediction, name in ((mf.PeakResponse(**PEAK), "modes"), (mf.Passage(**DRIFT), "step")):
        with pytest.raises(mf.InputError, match=f"{name}: expected a value, which complete"):
            prediction.evaluate(problem, problem.start, SEED)


def test_every_kind_returns_what_it_says_it_does(problem: mf.UpdatingProblem) -> None:
    given: list[Prediction] = [mf.PeakResponse(**PEAK), mf.Passage(**DRIFT | {"samples": 10})]
    own = [each for each in CLASSES.values() if each.__module__.startswith("modefront.")]
    assert [type(each) for each in given] == own, "a new kind belongs into this test"
    for prediction in given:
        ready = prediction.complete(problem)
        n = len(ready.places)
        result = ready.evaluate(problem, problem.start, SEED)
        assert set(result) == {variable.key for variable in ready.kind.variables}
        checked = ready.check(problem, problem.start, SEED)
        expected = ready.kind.check.variables if ready.kind.check else ()
        assert set(checked) == {variable.key for variable in expected}
        assert all(values.shape == (n,) for values in [*result.values(), *checked.values()])
        assert all(len(values) == n for values in ready.settings.values())
        assert set(ready.settings) == {setting.name for setting in ready.kind.settings}
        names = [variable.name for variable in (*ready.kind.variables, *expected)]
        assert all(x.startswith(f"{ready.kind.dimension}_") for x in [*names, *ready.settings])


def test_a_prediction_may_take_another_name(problem: mf.UpdatingProblem) -> None:
    peak = mf.PeakResponse(**PEAK)
    assert replace(peak, name="other").places == ("other: high",)
