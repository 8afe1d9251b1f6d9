"""Calls that a type checker must reject: each line with the mark, and no other.

Nothing here is run; `test_typing.py` reads what mypy says of it.
"""

from __future__ import annotations

import numpy as np
import xarray as xr
from numpy.typing import NDArray

import modefront as mf


def options(problem: mf.UpdatingProblem) -> None:
    """Options of the wrong type."""
    mf.Pareto(method="weights", points=10)
    mf.Pareto(method=1)  # rejected
    mf.Pareto(points="20")  # rejected
    mf.Pareto(points=2.5)  # rejected
    mf.Pareto(point=20)  # rejected
    mf.Search(evaluations="many")  # rejected
    mf.Search(doubt=None)  # rejected
    mf.Pairing(method="order", window=1.5)
    mf.Pairing(method="MAC")  # rejected
    mf.Pairing(window="wide")  # rejected
    mf.Identifiability(flat="none")  # rejected
    mf.Uncertainty(source="std", draws=100)
    mf.Uncertainty(source="guess")  # rejected
    mf.Uncertainty(bootstrap=1.5)  # rejected
    mf.Reduction(1e-6)
    mf.Reduction(reduction=None)  # rejected
    mf.Parameter("k", 1.0, (0.2, 5.0))
    mf.Parameter("k", "1.0", (0.2, 5.0))  # rejected
    mf.Parameter("k", 1.0, (0.2, 1.0, 5.0))  # rejected
    mf.Parameter("k", 1.0)  # rejected
    mf.Weighted("mine", {"frequencies": 1.0})
    mf.Weighted("mine", [1.0, 2.0])  # rejected
    mf.Study(problem, pareto=mf.Pareto(), weighted=(mf.Weighted("mine", {"shapes": 1.0}),))
    mf.Study(problem, pareto={"points": 20})  # rejected
    mf.Study(problem, seed="0")  # rejected
    mf.Study(problem, search=mf.Pareto())  # rejected


def groups() -> None:
    """Groups of what are no modes."""
    mf.Group("low", frequency=[1, 2], shape="all")
    mf.Group("low", frequency=3.5)  # rejected
    mf.Group("low", frequency="every")  # rejected
    mf.Group("low", scale="std", frequency="all")
    mf.Group("low", scale="stds", frequency="all")  # rejected
    mf.Group(frequency="all")  # rejected


def predictions() -> None:
    """Predictions that miss something."""
    mf.PeakResponse("peak", ["floor3"], force="floor1", band=(0.0, 30.0))
    mf.PeakResponse("peak")  # rejected
    mf.PeakResponse("peak", 3)  # rejected
    mf.PeakResponse("peak", ["floor3"], band=30.0)  # rejected
    mf.Passage("drift", ["floor3"], 0.001, "two", [0.1], 10.0, filter=mf.SoilFilter(2.0, 0.6))
    mf.Passage("drift", ["floor3"], 0.001, "both", [0.1], 10.0)  # rejected
    mf.Passage("drift", ["floor3"], 0.001, "two", [0.1], 10.0, filter=2.0)  # rejected


def matrices(theta: NDArray[np.float64]) -> tuple[object, object]:
    """Return matrices of one degree of freedom."""
    return [[theta[0]]], [[1.0]]


def models(data: mf.ModalData) -> None:
    """Models from arguments of the wrong type."""
    k = mf.Parameter("k", 1.0, (0.5, 2.0))
    model = mf.function_model([k], {"one": 0}, matrices)
    mf.function_model(["k"], {"one": 0}, matrices)  # rejected
    mf.function_model([k], ["one"], matrices)  # rejected
    mf.function_model([k], {"one": 0}, lambda theta: [[theta[0]]])  # rejected
    mf.chain(["k"], [1.0], [1.0], stiffness_parameters=["k"])
    mf.chain(["k"], 1.0, [1.0])  # rejected
    mf.matrices(["k"], [np.eye(1)], {"base": np.eye(1)}, {"one": 0})  # rejected
    mf.mesh_model(mf.fem.Beams, ["k"])  # rejected
    mf.updating_problem(model, data, [mf.Group("low", frequency="all")], parameters=[k])
    mf.updating_problem(model, data, ["frequency"], parameters=[k])  # rejected
    mf.updating_problem(data, model, [mf.Group("low", frequency="all")])  # rejected


def results(problem: mf.UpdatingProblem) -> xr.DataArray:
    """Results are looked at, and not written to."""
    result = mf.solve(problem, method="weights", points=10, seed=1)
    mf.solve(problem, methods="weights")  # rejected
    mf.solve(problem, points="10")  # rejected
    mf.solve(problem, pareto="nbi")  # rejected
    mf.solve(problem, predictions=["peak"])  # rejected
    result["theta"] = result["objective"]  # rejected
    dict(result.optimal.theta)  # rejected
    result.model(1.5)  # rejected
    result.table(3)  # rejected
    result.nominal.theta["k"] = 2.0  # rejected
    mf.run(problem, "results")
    mf.run(1, "results")  # rejected
    return result["theta"]
