"""Ambient identification beside pyOMA2 on the same records.

``python benchmarks/identification_beside_oma.py FIRST LAST [GENERATOR]``, with `pyoma-2` installed;
without it, it says so. All get the records of one setup of the tests FIRST to LAST of
`ambient_in_time`, or of the GENERATOR `ambient_by_newmark`. This package finds modes by itself, and
so does pyOMA2 (covariance-driven stochastic subspace identification with its standard deviations)
by clusters of its poles; at a fixed order, it takes the poles nearest to the true frequencies.

Errors are over the modes that all find: of frequencies and damping ratios over the true ones, and
of components of shapes of unit norm. Shares of 90 % intervals that hold the truth, of frequencies
and damping ratios, are over the modes that each finds. Seconds are CPU time. Ratios are those of
the errors and seconds of pyOMA2 to ours.
"""

from __future__ import annotations

import logging
import sys
import time
import warnings
from collections.abc import Iterable
from importlib import import_module
from importlib.metadata import version
from typing import Any, NamedTuple

import numpy as np
from ambient_in_time import BAND
from identification_ambient import paired

from modefront._typing import Floats
from modefront.data.modal_test import Records
from modefront.identification.methods.ambient import identify

try:
    from pyoma2.algorithms import SSI
    from pyoma2.algorithms.data.run_params import Clustering
    from pyoma2.setup import SingleSetup
except ImportError:
    if __name__ == "__main__":
        sys.exit(
            "pyOMA2 is not installed (`pip install pyoma-2`): there is nothing to compare with"
        )
    raise

ORDERS = 40, 60, 80
"""Orders of the models of pyOMA2."""

BLOCK_ROWS = 40
"""Of its Hankel matrix: with 4 sensors and more, more than the greatest order."""

CLUSTERS, CLUSTERED, OF_CLUSTERS = "Dederichs", 60, 30
"""How its poles are clustered: that of its ways which finds most; up to which order, and rows of
the Hankel matrix, of which its standard deviations need the Jacobian."""

NEAR = 0.02
"""Relative distance within which its poles count as those of a true mode."""


class Modes(NamedTuple):
    """Frequencies in Hz, damping ratios, shapes (modes, sensors), and deviations, if known."""

    f: Floats
    zeta: Floats
    phi: Floats
    deviations: Floats | None = None


class Compared(NamedTuple):
    """What a program finds.

    Modes found and false, errors of those that all find (3,), shares of intervals of frequency and
    damping that hold (2,), and CPU seconds.
    """

    found: int
    false: int
    errors: Floats
    held: Floats
    seconds: float


def by_modefront(test: dict[str, Any]) -> Modes:
    """Return the modes that this package finds."""
    names = tuple(map(str, test["layout"][0]))
    found = identify([Records("1", names, test["rate"], test["records"][0])], BAND).modes
    return Modes(
        np.array([mode.frequency for mode in found]),
        np.array([mode.damping for mode in found]),
        np.array([mode.shape.shape for mode in found]).reshape(-1, len(names)),
        np.array([[mode.frequency_std, mode.damping_std] for mode in found]).reshape(-1, 2).T,
    )


def run(test: dict[str, Any], **options: Any) -> Any:
    """Return pyOMA2's method after it ran."""
    logging.disable(logging.WARNING)
    setup = SingleSetup(test["records"][0].T, fs=test["rate"])
    method = SSI(name="SSI", method="cov", **options)
    setup.add_algorithms(method)
    setup.run_by_name("SSI")
    return method


def real(shapes: Any) -> Floats:
    """Return real shapes of unit norm, (modes, sensors)."""
    turned = shapes * np.exp(-0.5j * np.angle(np.sum(shapes**2, axis=1, keepdims=True)))
    out: Floats = turned.real / np.linalg.norm(turned.real, axis=1, keepdims=True)
    return out


def by_clusters(test: dict[str, Any]) -> Modes:
    """Return the modes that pyOMA2 finds by itself."""
    method = run(test, br=OF_CLUSTERS, ordmax=CLUSTERED, step=2, calc_unc=True)
    method.add_clustering(Clustering(name="all", quick=CLUSTERS, freqlim=BAND))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        method.run_clustering("all")
    found = method.result.clustering_results["all"]
    return Modes(found.Fn, found.Xi, real(found.Phi.T), np.array([found.Fn_std, found.Xi_std]))


def by_oma(test: dict[str, Any]) -> dict[int, Modes]:
    """Return the modes of pyOMA2 next to the true frequencies, for each order."""
    method, out = run(test, br=BLOCK_ROWS, ordmax=max(ORDERS), step=ORDERS[0] // 2), {}
    for order in ORDERS:
        column = order // (ORDERS[0] // 2)
        f = method.result.Fn_poles[:, column]
        known = np.flatnonzero(np.isfinite(f))
        chosen = []
        for true in test["f0"]:
            distance = np.abs(f[known] / true - 1)
            if distance.size and distance.min() < NEAR:
                chosen.append(known[int(distance.argmin())])
        chosen = sorted(set(chosen))
        shapes = real(method.result.Phi_poles[chosen, column])
        out[order] = Modes(f[chosen], method.result.Xi_poles[chosen, column], shapes)
    return out


def compare(seeds: Iterable[int], generator: str = "ambient_in_time") -> dict[str, Compared]:
    """Return what the programs find in tests of one setup, by their names."""
    results: dict[str, list[tuple[Modes, float]]] = {}
    tests = [import_module(generator).ambient_test(seed, 1) for seed in seeds]
    peer = f"pyOMA2 {version('pyoma-2')}"
    for test in tests:
        times = [time.process_time()]
        found = {"modefront": by_modefront(test)}
        times.append(time.process_time())
        found[f"{peer}, clusters"] = by_clusters(test)
        times.append(time.process_time())
        found |= {f"{peer}, order {order}": modes for order, modes in by_oma(test).items()}
        times.append(time.process_time())
        spent = np.append(np.diff(times), [times[-1] - times[-2]] * (len(found) - 3))
        for (name, modes), seconds in zip(found.items(), spent.tolist(), strict=True):
            results.setdefault(name, []).append((modes, seconds))
    pairs = {
        name: [
            dict(paired(test, modes.f, modes.phi, test["layout"][0]))
            for test, (modes, _) in zip(tests, each, strict=True)
        ]
        for name, each in results.items()
    }
    out = {}
    for name, of_tests in results.items():
        squares, z, count = [], [np.zeros((2, 0))], 0
        for k, test in enumerate(tests):
            modes, own = of_tests[k][0], pairs[name][k]
            for r in set.intersection(*(set(each[k]) for each in pairs.values())):
                squares.append(errors(test, r, modes, own[r]))
            if modes.deviations is not None:
                true, place = np.array([*own], int), np.array([*own.values()], int)
                f, zeta = test["f0"][true], test["zeta"][true]
                error = np.array([modes.f[place] - f, modes.zeta[place] - zeta])
                z.append(error / modes.deviations[:, place])
                count += len(modes.f) - len(own)
        held = np.mean(np.abs(np.hstack(z)) < 1.645, axis=1) if len(z) > 1 else np.full(2, np.nan)
        total, seconds = sum(map(len, pairs[name])), sum(each[1] for each in of_tests)
        mean = np.sqrt(np.mean(squares, axis=0))
        out[name] = Compared(total, count, mean, np.asarray(held), seconds)
    return out


def errors(test: dict[str, Any], r: int, modes: Modes, c: int) -> Floats:
    """Return squares of the errors of mode c, which is true mode r: frequency, damping, shape."""
    f, zeta, phi = modes.f[c], modes.zeta[c], modes.phi[c]
    true = test["phi"][r, test["layout"][0]]
    true = true / np.linalg.norm(true)
    shape = np.mean((phi * np.sign(phi @ true) - true) ** 2)
    return np.array([(f / test["f0"][r] - 1) ** 2, (zeta / test["zeta"][r] - 1) ** 2, shape])


def main(first: int, last: int, generator: str) -> None:
    """Print what both find, and the ratios of pyOMA2 to ours."""
    seeds = range(first, last + 1)
    total = sum(import_module(generator).ambient_test(seed, 1)["f0"].size for seed in seeds)
    print(f"{len(seeds)} tests of {total} modes; errors of the modes that all find")
    print("program                 found false  frequency   damping    shapes  held         CPU s")
    results = compare(seeds, generator)
    for name, each in results.items():
        f, zeta, phi = each.errors
        held = "" if np.isnan(each.held).any() else "{:.0%} {:.0%}".format(*each.held)
        print(
            f"{name:<23} {each.found:5} {each.false:5}  {f:9.1e} {zeta:9.1e} {phi:9.1e}  "
            f"{held:<10} {each.seconds:7.1f}"
        )
    ours = results.pop("modefront")
    for name, each in results.items():
        ratios = " ".join(f"{x:9.2f}" for x in each.errors / ours.errors)
        print(f"{name:<23} over ours: {ratios}  {'':<10} {each.seconds / ours.seconds:7.2f}")


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]), (sys.argv[3:] or ["ambient_in_time"])[0])
