"""Ranges of predictions over equivalent models, beside an independent optimiser.

    python benchmarks/ranges.py --seeds 0:20 [--quiet]

Seeds below 1000 are for development; seeds from 9000 on are for judgement.

Each seed is a chain, sway frame or lattice of ``calibration.py`` of a wrong class, of which models
fit equally well for one reason or several: stiffnesses and masses can be scaled together, two
parameters act on the same members, one parameter acts on nothing measured. Both predictions, the
greatest accelerance or receptance between two sensors and a rational function of the parameters
with its least value within the bounds, are minimised and maximised over the front, by SLSQP (SciPy)
at levels of the first objective between its points, and over the equivalent models of each, which
are known in closed form here: by random models and SLSQP from the best of them. A range is wrong
where an end differs by more than 2 % of the greater one; the cost is the number of eigenproblems of
the predictions over those of the search.
"""

from __future__ import annotations

import argparse
import itertools
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import scipy.optimize
from calibration import BOUNDS, members

import modefront as mf
from modefront._typing import Floats
from modefront.errors import Fault
from modefront.predictions import ResultVariable

SAMPLES, POLISHED = 30, 1
LEVELS = 4
SCALE = 1e4
WRONG = 0.02


@dataclass(frozen=True)
class Expense:
    """A cost that grows with some parameters and falls with others."""

    name: str
    grows: tuple[float, ...]
    falls: tuple[float, ...]

    kind: ClassVar = mf.PredictionKind(
        table="expense",
        dimension="expense",
        variables=(ResultVariable("expense_cost", "cost", "cost", ""),),
    )

    places: ClassVar = ("cost",)
    heading: ClassVar = "cost"
    settings: ClassVar[Mapping[str, Sequence[Any]]] = {}

    def faults(self, model: object, data: object) -> Iterator[Fault]:
        """Return what model and data lack: nothing."""
        del model, data
        return iter(())

    def complete(self, problem: object) -> Expense:
        """Return it."""
        del problem
        return self

    def value(self, theta: Floats) -> float:
        """Return the cost of a model (p,)."""
        return float(np.array(self.grows) @ theta**2 + np.array(self.falls) @ (1 / theta))

    def evaluate(self, problem: object, theta: Floats, seed: object) -> dict[str, Floats]:
        """Return the cost of a model (p,)."""
        del problem, seed
        return {"cost": np.array([self.value(theta)])}

    def check(self, problem: object, theta: Floats, seed: object) -> dict[str, Floats]:
        """Return nothing: the cost is exact."""
        del problem, theta, seed
        return {}


@dataclass(frozen=True)
class Case:
    """A problem, and which models of it are equivalent.

    Attributes
    ----------
    problem : the problem
    scaled : (p,) parameters that can be scaled together; all False where they cannot
    share : the first parameter's share of its members, which the second one has too; 0 for none
    idle : whether the last parameter acts on nothing measured
    """

    problem: mf.UpdatingProblem
    scaled: Floats
    share: float
    idle: bool

    @property
    def open(self) -> int:
        """Number of combinations that are open."""
        return int(self.scaled.any()) + (self.share > 0) + self.idle

    def model(self, theta: Floats, u: Floats) -> Floats:
        """Return the model equivalent to theta (p,) with coordinates u (open,) from 0 to 1."""
        low, high = BOUNDS
        out, rest = theta.copy(), list(u)
        if self.scaled.any():
            own = theta[self.scaled]
            if self.share:  # of both the sum counts
                own = np.append(own[2:], self.share * own[0] + (1 - self.share) * own[1])
            out[self.scaled] *= low / own.min() + rest.pop() * (high / own.max() - low / own.min())
        if self.share:
            a = self.share
            total = a * out[0] + (1 - a) * out[1]
            ends = np.array([(total - (1 - a) * x) / a for x in (low, high)])
            least, most = max(low, ends.min()), min(high, ends.max())
            out[0] = least + rest.pop() * (most - least)
            out[1] = (total - a * out[0]) / (1 - a)
        if self.idle:
            out[-1] = low + rest.pop() * (high - low)
        return out


def case(seed: int) -> Case:
    """Return a problem with open combinations."""
    rng = np.random.default_rng([seed, 7])
    N, parts = members(str(rng.choice(["chain", "frame", "lattice"])), rng)
    groups = min(int(rng.integers(2, 6)), len(parts))
    owner = np.sort(np.append(np.arange(groups), rng.integers(0, groups, len(parts) - groups)))
    scaled, twins, idle = rng.random(3) < (0.6, 0.4, 0.4)
    scaled = scaled or not (twins or idle)
    truth = rng.uniform(0.7, 1.5, groups)
    factors = truth[owner] * (1 + 0.08 * rng.normal(size=owner.size))
    stiffness = {
        f"k{j}": SCALE * sum(part for part, o in zip(parts, owner, strict=True) if o == j)
        for j in range(groups)
    }
    K = SCALE * sum(f * part for f, part in zip(factors, parts, strict=True))
    M = np.diag(rng.uniform(0.8, 1.2, N))
    share = 0.0
    if twins:
        share = rng.uniform(0.3, 0.7)
        whole = stiffness.pop("k0")
        stiffness = {"k0a": share * whole, "k0b": (1 - share) * whole, **stiffness}
    sensors = rng.choice(N, min(int(rng.integers(3, 7)), N), replace=False)
    if idle:
        stiffness = {name: np.pad(part, (0, 1)) for name, part in stiffness.items()}
        K, M = np.pad(K, (0, 1)), np.pad(M, (0, 1))
        M[-1, -1] = 1.0
        K[-1, -1] = 1e3 * np.abs(K).max()
        extra = np.zeros(K.shape)
        extra[-1, -1] = K[-1, -1]
        stiffness["extra"] = extra
    names = list(stiffness)
    mass = {"m": M} if scaled else {"base": M}
    names += ["m"] * bool(scaled)
    if idle:
        names.append(names.pop(names.index("extra")))
    places = {f"s{i}": int(i) for i in np.sort(sensors)}
    model = mf.matrices(names, stiffness, mass, places)
    modes = int(rng.integers(3, 6))
    true = mf.matrices(["x"], {"x": K}, {"base": M}, places).modes(np.ones(1), modes)
    f = true.frequency * (1 + 0.005 * rng.normal(size=modes))
    phi = true.phi.T
    phi = phi + 0.02 * np.abs(phi).max(axis=1)[:, None] * rng.normal(size=phi.shape)
    problem = mf.updating_problem(
        model,
        mf.modal_data(f, phi, model.sensors),
        [mf.Group("frequencies", frequency="all"), mf.Group("shapes", shape="all")],
        parameters=[mf.Parameter(name, nominal=1.0, bounds=BOUNDS) for name in names],
    )
    together = np.array([bool(scaled) and not (idle and name == "extra") for name in names])
    return Case(problem, together, share, bool(idle))


def ends(each: Case, theta: Floats, q: Callable[[Floats], float]) -> Floats:
    """Return the least and greatest prediction (2,) of models equivalent to theta (p,)."""
    U = np.random.default_rng(0).random((SAMPLES * each.open, each.open))
    values = np.array([q(each.model(theta, u)) for u in U])
    out = []
    for sign in (1.0, -1.0):
        best = float((sign * values).min())
        for i in np.argsort(sign * values)[:POLISHED]:
            found = scipy.optimize.minimize(
                lambda u, sign=sign: sign * q(each.model(theta, np.clip(u, 0.0, 1.0))),
                U[i],
                bounds=[(0.0, 1.0)] * each.open,
                method="SLSQP",
            )
            best = min(best, float(found.fun))
        out.append(sign * best)
    return np.array(out)


def along(problem: mf.UpdatingProblem, front: Floats) -> Floats:
    """Return models (m, p) of a front of two objectives, with those between the ones given."""
    front = front[np.argsort([problem.evaluate(theta).J[0] for theta in front])]
    J = np.array([problem.evaluate(theta).J for theta in front])
    unit, out = np.maximum(np.ptp(J, axis=0), 1e-12), list(front)
    bounds = list(zip(problem.lower, problem.upper, strict=True))
    for k, share in itertools.product(range(len(front) - 1), np.arange(1, LEVELS) / LEVELS):
        level = (1 - share) * J[k, 0] + share * J[k + 1, 0]
        found = scipy.optimize.minimize(
            lambda theta: problem.evaluate(theta).J[1] / unit[1],
            (1 - share) * front[k] + share * front[k + 1],
            jac=lambda theta: problem.evaluate(theta).dJ[1] / unit[1],
            bounds=bounds,
            constraints={
                "type": "ineq",
                "fun": lambda theta, level=level: (level - problem.evaluate(theta).J[0]) / unit[0],
                "jac": lambda theta: -problem.evaluate(theta).dJ[0] / unit[0],
            },
            method="SLSQP",
        )
        if found.success and J[k + 1, 1] <= found.fun * unit[1] <= J[k, 1]:
            out.append(found.x)
    return np.array(out)


def compared(seed: int) -> tuple[Floats, float, str]:
    """Return how much narrower the ends (2, 2) of the ranges are, the cost, and words."""
    began, each = time.process_time(), case(seed)
    problem, rng = each.problem, np.random.default_rng([seed, 8])
    p = problem.start.size
    first, last = problem.data.sensors[0], problem.data.sensors[-1]
    quantity = str(rng.choice(["receptance", "accelerance"]))
    peak = mf.PeakResponse("peak", last, force=first, quantity=quantity, damping=0.02)
    expense = Expense("cost", *(tuple(rng.uniform(0.1, 1.0, p).tolist()) for _ in range(2)))
    results = mf.solve(
        problem,
        points=3,
        predictions=[peak, expense],
        identifiability=mf.Identifiability(models=0),
    )
    data = results.dataset
    front = along(problem, data["theta"].values[data["pareto"].values])
    whole = peak.complete(problem)

    def response(theta: Floats) -> float:
        return float(whole.evaluate(problem, theta, np.random.SeedSequence(0))["peak"][0])

    out, said = [], []
    for name, q in (("frf_peak", response), ("expense_cost", expense.value)):
        ours = data[f"{name}_range"].values[:2, 0]
        found = np.array([ends(each, theta, q) for theta in front])
        theirs = np.array([found[:, 0].min(), found[:, 1].max()])
        out.append(np.array([1, -1]) * (ours - theirs) / np.abs(theirs).max())
        said.append(f"{name} {ours[0]:.4g} to {ours[1]:.4g}, narrower by {out[-1].max():.1e}")
        said[-1] += f", wider by {-out[-1].min():.1e}"
    cost = float(data.attrs["prediction_eigensolutions"] / data.attrs["model_evaluations"])
    spent = time.process_time() - began
    text = f"{seed}: p = {p}, {each.open} open, {spent:.0f} s, cost {cost:.2f}: "
    return np.array(out), cost, text + "; ".join(said)


def main() -> None:
    """Print the ranges that are wrong, and the costs."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", default="0:20")
    parser.add_argument("--quiet", action="store_true")
    options = parser.parse_args()
    found, costs = [], []
    for seed in range(*map(int, options.seeds.split(":"))):
        narrower, cost, text = compared(seed)
        found.append(narrower)
        costs.append(cost)
        if not options.quiet:
            print(text, flush=True)
    narrower = np.array(found)
    for what, wrong in (("narrower", narrower > WRONG), ("wider", narrower < -WRONG)):
        print(f"ends {what} by more than {WRONG:.0%}: {wrong.sum()} of {wrong.size}")
    median = np.median(costs)
    print(f"eigenproblems over those of the search: median {median:.2f}, most {max(costs):.2f}")


if __name__ == "__main__":
    main()
