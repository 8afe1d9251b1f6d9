"""Parameters that are fixed, tied to another one, or expected about their nominal value."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import modefront as mf
from modefront._typing import Floats
from modefront.errors import InputError
from modefront.uncertainty.prior import Distance

NAMES = ["k1", "k2", "k3"]
MODEL = mf.chain(NAMES, [1.0] * 3, [900.0, 800.0, 700.0], stiffness_parameters=NAMES)
TRUE = np.array([1.2, 0.9, 1.1])
GROUPS = [mf.Group("frequencies", frequency="all"), mf.Group("shapes", shape="all")]
BOUNDS = (0.3, 3.0)
SEARCH = mf.Search(doubt=0.5)

pytestmark = pytest.mark.usefixtures("short_chains")


def data(theta: Floats, modes: int) -> mf.ModalData:
    known = MODEL.modes(theta, modes)
    return mf.modal_data(known.frequency, known.phi.T, MODEL.sensors)


def solved(modes: int, *parameters: mf.Parameter, weight: float = 4) -> mf.Results:
    problem = mf.updating_problem(MODEL, data(TRUE, modes), GROUPS, parameters=parameters)
    without = mf.Identifiability(models=0)
    noise = mf.NoisePrior(weight=weight)
    return mf.solve(problem, points=3, seed=1, search=SEARCH, identifiability=without, noise=noise)


def parameter(
    name: str, nominal: float = 1.0, prior: mf.Prior | None = None, tie: str = ""
) -> mf.Parameter:
    return mf.Parameter(name, nominal, BOUNDS, prior, tie=tie)


@pytest.mark.parametrize("sparse", [False, True])
def test_a_model_with_held_parameters_is_the_model_with_these_values(sparse: bool) -> None:
    E = np.array([[2.0, -1.0], [-1.0, 2.0]])
    terms = {"base": np.eye(2), "E*t": E, "t^3": np.diag([1.0, 3.0]), "s": np.diag([2.0, 0.0])}
    mass = {"base": np.eye(2), "t": np.diag([0.1, 0.2])}
    model = mf.matrices(["E", "t", "s"], terms, mass, {"a": 0, "b": 1})
    whole = model.sparse() if sparse else model
    held = whole.held({"E": 1.7}, {"s": "t"})
    assert held.parameters == ("t",)
    for t in (0.6, 1.4):
        one = held.modes(np.array([t]), 2)
        other = whole.modes(np.array([1.7, t, t]), 2)
        np.testing.assert_allclose(one.lam, other.lam, rtol=1e-12)
        slope = other.dfrequency[:, 1] + other.dfrequency[:, 2]
        np.testing.assert_allclose(one.dfrequency[:, 0], slope, rtol=1e-9)


def test_others_are_found_where_one_is_fixed_and_one_tied() -> None:
    fixed = mf.Parameter("k2", 0.9, BOUNDS, fixed=True)
    results = solved(3, parameter("k1"), fixed, parameter("k3"))
    assert results.dataset["parameter"].values.tolist() == ["k1", "k3"]
    assert results.reference.theta == pytest.approx({"k1": 1.2, "k3": 1.1}, abs=1e-3)
    assert results.reference.parameters == {**results.reference.theta, "k2": 0.9}
    tied = solved(3, parameter("k1"), parameter("k2", tie="k1"), parameter("k3"), weight=0)
    assert tied.dataset["parameter"].values.tolist() == ["k1", "k3"]
    values = tied.reference.parameters
    assert values == {**tied.reference.theta, "k2": values["k1"]}


@pytest.mark.slow(3)
@pytest.mark.parametrize("prior", [mf.Prior("normal", 0.01), mf.Prior("lognormal", 0.01)])
def test_what_data_leave_open_a_prior_decides(prior: mf.Prior) -> None:
    """One mode of three storeys: a narrow prior holds a parameter, and the others follow."""
    with_it = solved(1, parameter("k1", 1.2, prior=prior), parameter("k2"), parameter("k3")).dataset
    assert with_it["interval"].sel(parameter="k1").values == pytest.approx(
        [1.18, 1.2, 1.22], abs=0.015
    )
    assert str(with_it["trust"].sel(parameter="k1").values) == "not determined"
    low, _, high = solved(1, *map(parameter, NAMES)).dataset["interval"].sel(parameter="k1").values
    assert high - low > 0.1


def test_the_distance_of_a_prior_has_the_derivatives_of_differences() -> None:
    chosen = [
        parameter("k1", prior=mf.Prior("normal", 0.2)),
        parameter("k2", prior=mf.Prior("lognormal", 0.3)),
        parameter("k3"),
    ]
    problem = mf.updating_problem(MODEL, data(TRUE, 2), GROUPS, parameters=chosen)
    distance = Distance(problem, 1e-2)
    theta, h = np.array([0.7, 1.6, 2.0]), 1e-5
    r, dr, d2r = distance.residuals(theta)
    expected = [-0.3 / 0.2, np.log(1.6) / 0.3, 0.1 / (BOUNDS[1] - BOUNDS[0])]
    assert r == pytest.approx(expected)
    ahead, behind = distance.residuals(theta + h), distance.residuals(theta - h)
    assert dr == pytest.approx((ahead[0] - behind[0]) / (2 * h), rel=1e-7)
    assert d2r == pytest.approx((ahead[1] - behind[1]) / (2 * h), rel=1e-7, abs=1e-12)


STUDY = """
[study]
name = "held"
[data]
file = "modes.csv"
[model]
kind = "chain"
masses = [1.0, 1.0]
stiffnesses = [900.0, 800.0]
stiffness_parameters = ["k1", "k2"]
sensors = {{ a = 0, b = 1 }}
[[parameter]]
name = "k1"
nominal = 1.0
bounds = [0.3, 3.0]
[[parameter]]
name = "k2"
nominal = 1.0
bounds = [0.3, 3.0]
{more}
[[group]]
name = "frequencies"
frequency = "all"
[[group]]
name = "shapes"
shape = "all"
"""


@pytest.mark.parametrize(
    ("more", "says"),
    [
        ('tie = "k3"', "'k2' tie: expected the name of a parameter that is neither fixed nor tied"),
        ('tie = "k2"', "'k2' tie: expected the name of a parameter that is neither fixed nor tied"),
        ('tie = "k1"\nprior = { std = 0.1 }', "prior: expected none beside the tie to 'k1'"),
        ('tie = "k1"\nfixed = true', "expected no 'tie' of a parameter that is fixed"),
        ("fixed = 1", "fixed: expected true or false"),
        ('prior = { kind = "gamma" }', "expected one of 'normal', 'lognormal'"),
        ("prior = { std = 0 }", "std: expected a number above 0"),
    ],
)
def test_what_contradicts_is_refused(more: str, says: str, tmp_path: Path) -> None:
    (tmp_path / "modes.csv").write_text("set,mode,frequency,damping,a,b\n1,1,3.0,,0.6,1.0\n")
    (tmp_path / "study.toml").write_text(STUDY.format(more=more))
    with pytest.raises(InputError) as raised:
        mf.load(tmp_path / "study.toml")
    assert says in str(raised.value)


def test_a_parameter_begins_where_the_one_does_to_which_it_is_tied(tmp_path: Path) -> None:
    (tmp_path / "modes.csv").write_text("set,mode,frequency,damping,a,b\n1,1,3.0,,0.6,1.0\n")
    text = STUDY.format(more='tie = "k1"').replace("nominal = 1.0", "nominal = 1.5", 1)
    (tmp_path / "study.toml").write_text(text)
    with pytest.raises(InputError) as raised:
        mf.load(tmp_path / "study.toml")
    says = "[[parameter]] 'k2' nominal: expected 1.5 as of 'k1', to which it is tied, found 1"
    assert str(raised.value).endswith(says)


@pytest.mark.parametrize(
    ("ties", "says"),
    [
        (("", "k9", ""), "parameters 'k2' tie: expected the name of a parameter that is neither"),
        (("", "k2", ""), "parameters 'k2' tie: expected the name of a parameter that is neither"),
        (("", "k3", "k1"), "parameters 'k2' tie: expected the name of a parameter that is neither"),
        (("k2", "k3", "k1"), "parameters: expected one that is neither fixed nor tied, found none"),
    ],
)
def test_python_refuses_the_ties_that_a_study_file_may_not_have(
    ties: tuple[str, str, str], says: str
) -> None:
    known = [parameter(f"k{k}", tie=tie) for k, tie in enumerate(ties, 1)]
    with pytest.raises(InputError) as raised:
        mf.updating_problem(MODEL, data(TRUE, 3), GROUPS, parameters=known)
    assert says in str(raised.value)


def test_a_study_file_says_what_is_held_and_expected(tmp_path: Path) -> None:
    (tmp_path / "modes.csv").write_text("set,mode,frequency,damping,a,b\n1,1,3.0,,0.6,1.0\n")
    (tmp_path / "study.toml").write_text(STUDY.format(more='tie = "k1"'))
    assert mf.load(tmp_path / "study.toml").problem.model.parameters == ("k1",)
    (tmp_path / "study.toml").write_text(STUDY.format(more='prior = { kind = "lognormal" }'))
    assert mf.load(tmp_path / "study.toml").problem.priors == (None, mf.Prior("lognormal", 0.2))
