"""Terms that are products of powers of parameters."""

import numpy as np
import pytest

import modefront as mf
from modefront.models.parameters import exponents_of

NAMES = ("E", "t", "a*b", "k 1", "1/x")


@pytest.mark.parametrize(
    ("term", "exponents"),
    [
        ("base", [0, 0, 0, 0, 0]),
        ("E", [1, 0, 0, 0, 0]),
        ("t^3", [0, 3, 0, 0, 0]),
        ("t**3", [0, 3, 0, 0, 0]),
        ("1/t", [0, -1, 0, 0, 0]),
        ("1/t^3", [0, -3, 0, 0, 0]),
        ("t^-0.5", [0, -0.5, 0, 0, 0]),
        ("E*t^3", [1, 3, 0, 0, 0]),
        ("E * t / k 1 ^ 2", [1, 1, 0, -2, 0]),
        ("E*E", [2, 0, 0, 0, 0]),
        ("a*b", [0, 0, 1, 0, 0]),
        ("1/x", [0, 0, 0, 0, 1]),
        ("t/t", None),
        ("1", None),
        ("x", None),
        ("t^", None),
        ("t^x", None),
        ("", None),
        ("2*t", None),
    ],
)
def test_names_of_terms(term: str, exponents: list[float] | None) -> None:
    result = exponents_of(term, NAMES)
    assert (None if result is None else result.tolist()) == exponents


def test_a_model_with_functions_of_its_parameters_and_its_derivatives() -> None:
    rng = np.random.default_rng(1)
    A, B, C = (x @ x.T for x in rng.standard_normal((3, 4, 4)))
    model = mf.matrices(
        ["E", "t"],
        {"base": A, "E*t": B, "E*t^3": C, "1/t": A},
        {"base": np.eye(4), "t": np.eye(4)},
        {"a": 0, "b": 2},
    )
    theta, step = np.array([1.3, 0.8]), 1e-6
    E, t = theta
    lam = np.linalg.eigvalsh(A + E * t * B + E * t**3 * C + A / t) / (1 + t)
    modes = model.modes(theta, 4)
    assert modes.lam == pytest.approx(lam)
    assert modes.dlam is not None
    for i in range(2):
        shift = step * np.eye(2)[i]
        ends = [model.modes(theta + s * shift, 4).lam for s in (1, -1)]
        assert modes.dlam[:, i] == pytest.approx((ends[0] - ends[1]) / (2 * step), rel=1e-6)
    assert model.above_zero == ("t",)


def test_a_term_that_is_none_is_named() -> None:
    identity = np.eye(2)
    with pytest.raises(mf.InputError, match=r"a product of powers of parameters, found 'q.2'"):
        mf.matrices(["k"], {"q^2": identity}, {"base": identity}, {"a": 0})


def test_no_parameter_has_the_name_of_the_constant_term() -> None:
    with pytest.raises(mf.InputError, match="parameters: expected names other than 'base'"):
        mf.chain(["base", "k"], [1.0, 1.0], [4.0, 4.0], stiffness_parameters=["base", "k"])
    with pytest.raises(mf.InputError, match="--parameter base: expected another name"):
        mf.import_model("opensees", "nominal", {"base": "run"})
