"""What a check says of studies in which something is known to be wrong or hard."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from modefront.residuals.groups import Group
from modefront.study.check import check
from modefront.study.definition import Study
from modefront.study.derivatives import derivative_error
from modefront.study.examples import write_example
from modefront.study.file import load


@pytest.fixture
def study(tmp_path: Path) -> Study:
    write_example("three-story-c0", tmp_path)
    return load(tmp_path / "study.toml")


@pytest.mark.parametrize("width", [1e-12, 1e-9, 1e-6, 1e-3, 1.0 - 1e-6])
def test_derivatives_are_proved_however_narrow_the_bounds(width: float, study: Study) -> None:
    problem = study.problem
    one = np.ones(3)
    narrow = replace(problem, lower=(1 - width) * one, upper=(1 + width) * one, start=one)
    assert derivative_error(narrow) < 1e-9


def test_derivatives_are_proved_however_wide_the_bounds(study: Study) -> None:
    problem = study.problem
    wide = replace(problem, lower=np.full(3, 1e-6), upper=np.full(3, 1e6))
    assert derivative_error(wide) < 1e-9


def test_what_the_data_determine_is_said(study: Study) -> None:
    names = "theta1, theta2 and theta3"
    assert check(study).determined == (
        "frequencies determine 3 of 3 combinations of parameters",
        f"shapes determine 2 of 3 combinations of parameters; {names} can be scaled together: "
        "no shape changes",
        "all data together determine 3 of 3 combinations of parameters",
    )


def test_a_nominal_value_at_a_bound_and_parameters_alike_are_warned_of(study: Study) -> None:
    problem = study.problem
    at_bound = replace(study, problem=replace(problem, lower=problem.start))
    assert "the nominal value of theta1 is one of its bounds, 1" in check(at_bound).warnings
    first = replace(problem, groups=(Group("first", frequency=[1]),))
    warnings = check(replace(study, problem=first)).warnings
    assert sum("do not determine" in text for text in warnings) == 2
    assert sum("act nearly alike" in text for text in warnings) == 3
