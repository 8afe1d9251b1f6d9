"""Sources of error: derivatives with respect to data, and the variance of means over data sets."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import modefront as mf
from modefront.data.modal import ModalData
from modefront.optim.problem import Evaluation
from modefront.residuals.base import Scale
from modefront.uncertainty.noise import available, noise

NAMES = ("k1", "k2", "k3")
THETA = np.array([1.1, 0.9, 1.2])
MODEL = mf.chain(NAMES, [2.0, 1.5, 1.0], [3e3, 2e3, 4e3], stiffness_parameters=NAMES)


def measured(sets: int, seed: int = 0) -> ModalData:
    """Data of some sets around a model, with gaps, and shapes in any scale and sign."""
    rng = np.random.default_rng(seed)
    modes = MODEL.modes(np.ones(3), 3)
    f = modes.frequency * (1 + 0.02 * rng.normal(size=(sets, 3)))
    scale = rng.uniform(0.5, 2, (sets, 3, 1)) * rng.choice([-1, 1], (sets, 3, 1))
    phi = scale * (modes.phi.T + 0.05 * rng.normal(size=(sets, 3, 3)))
    f_std, phi_std = 0.01 * f, rng.uniform(0.01, 0.05, phi.shape)
    f[0, 2], phi[-1, 1, 2], phi_std[0, 0, 1] = np.nan, np.nan, 0.0
    return mf.modal_data(f, phi, MODEL.sensors, frequency_std=f_std, shape_std=phi_std)


def problem_of(data: ModalData, scale: Scale) -> mf.UpdatingProblem:
    groups = [
        mf.Group("frequencies", frequency="all", scale=scale),
        mf.Group("shapes", shape="all", scale=scale),
        mf.Group("first", frequency=[1], shape=[1], scale=scale),
    ]
    return mf.updating_problem(
        MODEL, data, groups, dict.fromkeys(NAMES, (0.1, 9.0)), dict.fromkeys(NAMES, 1.0)
    )


def test_where_the_uncertainty_comes_from() -> None:
    data = measured(2)
    assert available(data) == ("std", "sets")
    bare = replace(data, frequency_std=np.nan * data.frequency, shape_std=np.nan * data.shape)
    assert available(bare) == ("sets",)
    f, phi = bare.frequency[:1], bare.shape[:1]
    assert available(mf.modal_data(f, phi, MODEL.sensors)) == ()
    part = np.where(np.arange(3) < 2, bare.shape, np.nan)  # shapes alone, at two sensors
    unknown = replace(bare, frequency=np.nan * bare.frequency, shape=part)
    assert available(unknown) == ("sets",)
    assert available(replace(unknown, shape_std=0.1 * np.abs(part))) == ("std", "sets")
    shifted = part.copy()
    shifted[0, :2], shifted[1, 2] = np.nan, np.nan  # no mode in both sets
    assert available(replace(unknown, shape=shifted)) == ()
    assert mf.Uncertainty().of(data) == "std"
    assert mf.Uncertainty("sets").of(data) == "sets"
    assert mf.Uncertainty("none").of(data) is None
    assert mf.Uncertainty().of(replace(unknown, shape=shifted)) is None


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"bootstrap": -1}, "bootstrap"),
        ({"draws": 10**6 + 1}, "draws"),
        ({"source": "both"}, "source"),
        ({"source": "none", "bootstrap": 5}, "bootstrap: expected 0 with source = 'none', found 5"),
    ],
)
def test_samples_of_no_source_and_of_no_size_are_refused(
    options: dict[str, Any], message: str
) -> None:
    with pytest.raises(mf.InputError, match=message):
        mf.Uncertainty(**options)


def test_what_data_do_not_have_is_a_fault() -> None:
    bare = mf.modal_data(np.array([1.0]), np.ones((1, 3)), MODEL.sensors)
    for options, expected in (
        ({"source": "std"}, "source: expected standard deviations above 0"),
        ({"source": "sets"}, "source: expected a mode measured in two data sets"),
        ({"bootstrap": 3}, "bootstrap: expected 0, or data with standard deviations"),
    ):
        asked: Any = mf.Uncertainty(**options)
        with pytest.raises(mf.InputError, match=expected):
            asked.of(bare)
    assert [*mf.Uncertainty().faults(bare)] == []


@pytest.mark.parametrize("scale", ["measured", "std"])
def test_standard_deviations_are_carried_by_exact_derivatives(scale: Scale) -> None:
    data = measured(2)
    if scale == "std":
        data.shape_std[0, 0, 1] = 0.02  # a zero would be replaced by what others have
    problem, step = problem_of(data, scale), 1e-4
    result = noise(problem, *problem.modes(THETA), "std")

    def moved(k: int, r: int, s: int, by: float) -> Evaluation:
        f, phi = data.frequency.copy(), data.shape.copy()
        if s < 0:
            f[k, r] += by * data.frequency_std[k, r]
        else:
            phi[k, r, s] += by * data.shape_std[k, r, s]
        return replace(problem, data=replace(data, frequency=f, shape=phi)).evaluate(THETA)

    uncertain = np.dstack([data.frequency_std[..., None] > 0, data.shape_std > 0])
    uncertain &= np.isfinite(np.dstack([data.frequency[..., None], data.shape]))
    sources = np.argwhere(uncertain).tolist()
    assert len(result.J) == len(sources)
    for J, dJ, (k, r, s) in zip(result.J, result.dJ, sources, strict=True):
        first, other = (moved(k, r, s - 1, sign * step) for sign in (1, -1))
        assert J == pytest.approx((first.J - other.J) / (2 * step), rel=1e-5, abs=1e-9)
        assert dJ == pytest.approx((first.dJ - other.dJ) / (2 * step), rel=1e-5, abs=1e-8)


@pytest.mark.parametrize("sets", [2, 5])
def test_data_sets_scatter_as_the_mean_of_their_objectives(sets: int) -> None:
    """Without gaps, J is the mean of the objectives of single sets: so is its variance."""
    data = measured(sets)
    data.frequency[0, 2], data.shape[-1, 1, 2] = 20.0, 0.1
    problem = problem_of(data, "measured")
    result = noise(problem, *problem.modes(THETA), "sets")
    single = []
    for k in range(sets):
        changed = replace(
            data,
            **{
                name: getattr(data, name)[k : k + 1]
                for name in ("frequency", "damping", "shape", "frequency_std", "shape_std")
            },
            sets=data.sets[k : k + 1],
        )
        single.append(problem_of(changed, "measured").evaluate(THETA))
    J = np.array([evaluation.J for evaluation in single])
    assert J.mean(axis=0) == pytest.approx(problem.evaluate(THETA).J)
    assert result.J.T @ result.J == pytest.approx(np.cov(J.T) / sets)
    slopes = np.array([evaluation.dJ.ravel() for evaluation in single])
    flat = result.dJ.reshape(sets, -1)
    assert flat.T @ flat == pytest.approx(np.cov(slopes.T) / sets, rel=1e-9, abs=1e-15)


def test_a_mode_measured_once_counts_as_exact() -> None:
    data = measured(2)
    assert np.isfinite(data.frequency[:, 2]).sum() == 1
    alone = replace(problem_of(data, "measured"), groups=(mf.Group("third", frequency=[3]),))
    assert not noise(alone, *alone.modes(THETA), "sets").J.any()


def drawn(rng: np.random.Generator, sets: int) -> ModalData:
    """Data with errors of known size around the modes of the nominal model, in any scale."""
    modes = MODEL.modes(np.ones(3), 3)
    share = np.array([[0.01, 0.02, 0.03]] * 3)
    f_std = np.array([0.002, 0.004, 0.003]) * modes.frequency
    f = modes.frequency + f_std * rng.normal(size=(sets, 3))
    phi = modes.phi.T + share * rng.normal(size=(sets, 3, 3))
    scale = rng.uniform(0.5, 2, (sets, 3, 1)) * rng.choice([-1, 1], (sets, 3, 1))
    return mf.modal_data(
        *(f, scale * phi, MODEL.sensors),
        frequency_std=np.broadcast_to(f_std, f.shape),
        shape_std=np.abs(scale) * share,
    )
