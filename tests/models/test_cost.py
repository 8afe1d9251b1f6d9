"""Whether a reduced basis is used is decided by operation counts."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import scipy.sparse

import modefront as mf
from modefront.linalg.affine import SparseAffine
from modefront.models.base import full_of, is_reduced
from modefront.models.matrices import MatrixModel
from modefront.models.reduced.model import ReducedModel
from modefront.models.reduced.options import SMALLEST, columns, share, stand_in
from modefront.work.task import Task
from modefront.work.transfer import Sender


def chain(size: int, members: int) -> MatrixModel:
    """Return a chain of springs of members one after the other."""
    ends = np.arange(size)
    terms = {}
    for j, chosen in enumerate(np.array_split(ends, members)):
        B = scipy.sparse.csr_array((np.ones(chosen.size), (chosen, chosen)), shape=(size, size))
        below = chosen[chosen > 0]
        B -= scipy.sparse.csr_array((np.ones(below.size), (below, below - 1)), shape=(size, size))
        terms[f"k{j + 1}"] = size**2 * (B.T @ B)
    mass = {"base": scipy.sparse.eye_array(size)}
    sensors = {"middle": size // 2, "top": size - 1}
    return mf.matrices(list(terms), terms, mass, sensors)


def problem(model: MatrixModel, reduction: mf.Reduction | None) -> mf.UpdatingProblem:
    theta = np.ones(len(model.parameters))
    modes = model.modes(theta, 3, derivatives=False)
    data = mf.modal_data(modes.frequency, modes.phi.T, model.sensors)
    groups = [mf.Group("all", frequency="all", shape="all")]
    names = model.parameters
    bounds, nominal = dict.fromkeys(names, (0.5, 2.0)), dict.fromkeys(names, 1.0)
    return mf.updating_problem(model, data, groups, bounds, nominal, reduction=reduction)


@pytest.mark.parametrize(
    ("size", "members", "reduced"),
    [
        (SMALLEST - 1, 2, False),
        (100, 2, True),
        (120, 17, False),
        (400, 60, False),
        (400, 2, True),
        (400, 17, True),
        (3000, 5, True),
    ],
)
def test_a_basis_is_taken_where_it_pays(size: int, members: int, reduced: bool) -> None:
    for unless_given in (None, mf.Reduction()):
        model = problem(chain(size, members), unless_given).model
        assert isinstance(model, ReducedModel) == reduced
    assert isinstance(problem(chain(size, members), mf.Reduction("off")).model, MatrixModel)


def test_a_task_on_a_reduced_model_takes_the_memory_of_its_small_matrices() -> None:
    full, reduced = (problem(chain(400, 2), mf.Reduction(x)) for x in ("off", 1e-8))
    assert reduced.footprint == full.footprint, "the first process solves the full model"
    reduced.evaluate(reduced.start)
    memory = [
        Sender().message([Task(("nominal",), of.evaluate, (of.start,))]).memory
        for of in (full, reduced)
    ]
    assert memory == [full.footprint, reduced.footprint]
    assert 0 < reduced.footprint < full.footprint / 2


def test_every_model_says_which_one_is_solved_in_full_even_one_that_does_not_know() -> None:
    full = chain(120, 2)
    assert full_of(full) is full
    reduced = problem(full, mf.Reduction(1e-8)).model
    assert is_reduced(reduced)
    assert isinstance(full_of(reduced), MatrixModel)

    class Own:
        """A model of a user, written before models said so."""

        parameters, sensors, size, unused, places, directions = (), (), 1, (), (), ()

    own: Any = Own()
    assert full_of(own) is own
    assert not is_reduced(own)


def test_the_time_of_an_evaluation_in_a_basis_is_that_of_a_model_of_its_size() -> None:
    model = chain(3000, 5)
    in_full = problem(model, mf.Reduction("off"))
    timed = replace(in_full, model=stand_in(model, 3))
    assert timed.model.size == int(columns(model, 3))
    assert timed.model.parameters == model.parameters
    found = timed.evaluate(in_full.start, second=True)
    assert found.feasible
    assert found.J.shape == (1,)


def test_larger_models_gain_more() -> None:
    shares = [share(chain(size, 3), 6) for size in (200, 2000, 20000)]
    assert shares == sorted(shares, reverse=True)
    assert share(chain(400, 2), 6) < share(chain(400, 12), 6)


def test_functions_of_a_parameter_take_columns_as_parameters_do() -> None:
    A, sensors = scipy.sparse.eye_array(200), {"top": 0}
    mass = {"base": A, "t": A}
    assert columns(mf.matrices(["t"], {"t": A}, mass, sensors), 4) == 4 * (1 + 1.5)
    assert columns(mf.matrices(["t"], {"t": A, "t^3": A}, mass, sensors), 4) == 4 * (1 + 2 * 1.5)


def test_a_basis_of_a_dense_model_has_its_modes() -> None:
    model = chain(150, 3)
    assert not isinstance(model.stiffness, SparseAffine)
    reduced = problem(model, mf.Reduction(1e-8)).model
    assert isinstance(reduced, ReducedModel)
    theta = np.array([1.3, 0.7, 1.1])
    first, other = model.modes(theta, 3), reduced.modes(theta, 3)
    np.testing.assert_allclose(other.lam, first.lam, rtol=1e-3)
    assert (other.lam >= first.lam * (1 - 1e-9)).all(), "of Rayleigh and Ritz"
    assert isinstance(model.sparse().sparse().stiffness, SparseAffine)
