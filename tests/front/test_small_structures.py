"""The random structures of the benchmark of failure rates are what it says of them."""

from __future__ import annotations

import numpy as np
import pytest
from independent import Equation, agreement
from small_structures import CLASSES, make

SEEDS = range(2 * len(CLASSES))


@pytest.mark.parametrize("seed", SEEDS)
def test_both_evaluations_agree(seed: int) -> None:
    equation = Equation(make(seed).case)
    assert agreement(equation, np.random.default_rng(seed)) < 1e-9


@pytest.mark.parametrize("seed", SEEDS)
def test_the_true_model_fits_exact_data(seed: int) -> None:
    case = make(seed, exact=True).case
    assert Equation(case).J(case.true) == pytest.approx(0.0, abs=1e-18)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_seed_is_all_that_makes_a_problem(seed: int) -> None:
    one, other = make(seed), make(seed)
    theta = one.case.problem.start
    assert Equation(one.case).J(theta).tolist() == Equation(other.case).J(theta).tolist()


def test_half_of_the_problems_of_each_class_are_of_a_wrong_one() -> None:
    problems = list(map(make, SEEDS))
    for kind in CLASSES:
        wrong = [bool(x.wrong) for x in problems if x.kind == kind]
        assert sum(wrong) * 2 == len(wrong)
