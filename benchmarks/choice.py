"""Whether a reduced basis is worth its price, and whether the cost model says so.

    python benchmarks/choice.py [--names shell-600-2 ...] [--both]

Ten models from 100 to 20,000 degrees of freedom with 2 to 17 parameters. For each, the work of a
study (edges by global search, weighted models, 10 points of the front) is done in a reduced basis.
Printed are, in processor time:

- ``full``: seconds of one full eigensolution with derivatives, ``reduced``: of one in the basis,
  with ``columns``;
- ``evaluations`` of the work, and ``setup``: seconds of snapshots and certificates;
- ``gain``: the time with full solutions over that with the basis, both without what the solvers
  take on top, which is the same: evaluations * full over setup + evaluations * reduced;
- what operation counts say of it (`modefront.models.reduced.options`), and ``loss``: the time
  of the choice that it makes over that of the better one.

With ``--both`` the work is done with full solutions too, and ``measured`` is the ratio of both.
"""

from __future__ import annotations

import argparse
import time
from unittest import mock

import numpy as np
import scipy.sparse
from reduced import MODES, shell, solid, timed

import modefront as mf
from modefront.identifiability.combinations import Identifiability
from modefront.linalg.affine import Monomials, sparse_affine
from modefront.models.matrices import MatrixModel
from modefront.models.reduced.model import ReducedModel
from modefront.models.reduced.options import share
from modefront.work.task import counted

BOUNDS = 0.4, 2.5


def chain(size: int, members: int) -> MatrixModel:
    """Return a chain of masses, fixed at one end, of members one after the other."""
    terms = []
    for chosen in np.array_split(np.arange(size), members):
        K = scipy.sparse.lil_array((size, size))
        for i in chosen:
            K[i, i] += size**2
            if i:
                K[i - 1, i - 1] += size**2
                K[i, i - 1] -= size**2
                K[i - 1, i] -= size**2
        terms.append(K.tocoo())
    places = np.linspace(0.05, 0.99, 12) * size
    selection = scipy.sparse.csr_array(
        (np.ones(12), (np.arange(12), places.astype(int))), shape=(12, size)
    )
    return MatrixModel(
        tuple(f"k{j + 1}" for j in range(members)),
        tuple(f"s{i + 1}" for i in range(12)),
        selection,
        sparse_affine(terms, Monomials(np.eye(members)), size),
        sparse_affine([scipy.sparse.eye_array(size)], Monomials(np.zeros((1, members))), size),
    ).compact()


MODELS = {
    "chain-100-2": (chain, 100, 2),
    "chain-200-10": (chain, 200, 10),
    "shell-300-2": (shell, 300, 2),
    "shell-600-3": (shell, 600, 3),
    "chain-150-5": (chain, 150, 5),
    "chain-1000-17": (chain, 1000, 17),
    "solid-1500-4": (solid, 1500, 4),
    "shell-2000-5": (shell, 2000, 5),
    "shell-5400-12": (shell, 5400, 12),
    "solid-20000-6": (solid, 20000, 6),
}


def problem_of(full: MatrixModel, basis: bool) -> mf.UpdatingProblem:
    """Return the problem of fitting modes of other stiffnesses with noise."""
    rng = np.random.default_rng(0)
    p = len(full.parameters)
    modes = full.modes(rng.uniform(0.7, 1.5, p), MODES, derivatives=False)
    phi = modes.phi.T * (1 + 0.05 * rng.standard_normal(modes.phi.T.shape))
    frequency = modes.frequency * (1 + 0.01 * rng.standard_normal(MODES))
    data = mf.modal_data(frequency, phi, full.sensors)
    groups = [mf.Group("frequencies", frequency="all"), mf.Group("shapes", shape="all")]
    names = full.parameters
    return mf.updating_problem(
        full,
        data,
        groups,
        dict.fromkeys(names, BOUNDS),
        dict.fromkeys(names, 1.0),
        reduction=mf.Reduction(1e-8 if basis else "off"),
    )


def work(problem: mf.UpdatingProblem) -> None:
    mf.solve(problem, points=10, identifiability=Identifiability(flat=0, models=0))


def line(name: str, both: bool) -> dict[str, float]:
    """Return the measurements of one model."""
    kind, size, p = MODELS[name]
    full = kind(size, p)
    problem = problem_of(full, basis=True)
    model = problem.model
    assert isinstance(model, ReducedModel)
    theta = np.full(p, 1.1)
    full.modes(theta, model.count)
    out: dict[str, float] = {"size": full.size, "parameters": p}
    out["full"] = min(timed(lambda: full.modes(theta, model.count))[0] for _ in range(3))
    with counted() as costs:
        spent, _ = timed(lambda: work(problem))
    out["reduced"] = min(timed(lambda: model.modes(theta, model.count))[0] for _ in range(9))
    out["columns"] = model.columns
    out["evaluations"] = costs.reduced
    out["setup"] = costs.full_time + costs.corrected_time + costs.certificate_time
    with_basis = out["setup"] + costs.reduced_time
    out["gain"] = costs.reduced * out["full"] / with_basis
    out["work"], out["estimated_gain"] = spent, 1 / share(full, model.count)
    without = spent - with_basis + costs.reduced * out["full"]
    out["loss"] = (spent if out["estimated_gain"] >= 1 else without) / min(spent, without)
    if both:
        other = problem_of(full, basis=False)
        out["measured"] = timed(lambda: work(other))[0] / spent
    return out


def main() -> None:
    """Print a line a model."""
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--names", nargs="+", choices=MODELS, default=list(MODELS))
    options.add_argument("--both", action="store_true")
    given = options.parse_args()
    for name in given.names:
        # Costs then do not depend on what else the machine does.
        with mock.patch("time.perf_counter", time.process_time):
            row = line(name, given.both)
        print(name, " ".join(f"{key}={value:.4g}" for key, value in row.items()), flush=True)


if __name__ == "__main__":
    main()
