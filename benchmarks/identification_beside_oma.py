"""Ambient identification beside pyOMA2, which is given the right frequencies, on the same records.

``python benchmarks/identification_beside_oma.py FIRST LAST``, with `pyoma-2` installed.
Both get the records of one setup of the tests FIRST to LAST of `ambient_in_time`. This package
finds modes by itself; pyOMA2 (covariance-driven stochastic subspace identification) takes the poles
nearest to the true frequencies at a fixed order.

Errors are over the modes that both find: of frequencies and damping ratios over the true ones,
and of components of shapes of unit norm. Seconds are CPU time of a test.
"""

from __future__ import annotations

import logging
import sys
import time
from collections.abc import Iterable
from importlib.metadata import version
from typing import Any, NamedTuple

import numpy as np
from ambient_in_time import BAND, ambient_test
from identification_ambient import paired
from pyoma2.algorithms import SSI
from pyoma2.setup import SingleSetup

from modefront._typing import Floats
from modefront.data.modal_test import Records
from modefront.identification.methods.ambient import identify

ORDERS = 40, 60, 80
"""Orders of the models of pyOMA2."""

BLOCK_ROWS = 40
"""Of its Hankel matrix: with 4 sensors and more, more than the greatest order."""

NEAR = 0.02
"""Relative distance within which its poles count as those of a true mode."""

Modes = tuple[Floats, Floats, Floats]
"""Frequencies in Hz, damping ratios and shapes (modes, sensors)."""


class Compared(NamedTuple):
    """What a program finds: how many modes, errors of those that all find (3,), and CPU seconds."""

    found: int
    errors: Floats
    seconds: float


def by_modefront(test: dict[str, Any]) -> Modes:
    """Return the modes that this package finds."""
    names = tuple(map(str, test["layout"][0]))
    found = identify([Records("1", names, test["rate"], test["records"][0])], BAND).modes
    return (
        np.array([mode.frequency for mode in found]),
        np.array([mode.damping for mode in found]),
        np.array([mode.shape.shape for mode in found]).reshape(-1, len(names)),
    )


def by_oma(test: dict[str, Any]) -> dict[int, Modes]:
    """Return the modes of pyOMA2 next to the true frequencies, for each order."""
    logging.disable(logging.WARNING)
    setup = SingleSetup(test["records"][0].T, fs=test["rate"])
    method = SSI(name="SSI", method="cov", br=BLOCK_ROWS, ordmax=max(ORDERS), step=ORDERS[0] // 2)
    setup.add_algorithms(method)
    setup.run_by_name("SSI")
    out = {}
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
        shapes = method.result.Phi_poles[chosen, column]
        turned = shapes * np.exp(-0.5j * np.angle(np.sum(shapes**2, axis=1, keepdims=True)))
        real = turned.real / np.linalg.norm(turned.real, axis=1, keepdims=True)
        out[order] = f[chosen], method.result.Xi_poles[chosen, column], real
    return out


def compare(seeds: Iterable[int]) -> dict[str, Compared]:
    """Return what the programs find in tests of one setup, by their names."""
    results: dict[str, list[tuple[Modes, float]]] = {}
    tests = [ambient_test(seed, 1) for seed in seeds]
    for test in tests:
        before = time.process_time()
        ours = by_modefront(test)
        between = time.process_time()
        others = by_oma(test)
        spent = time.process_time() - between
        results.setdefault("modefront", []).append((ours, between - before))
        for order, modes in others.items():
            name = f"pyOMA2 {version('pyoma-2')}, order {order}"
            results.setdefault(name, []).append((modes, spent))
    pairs = {
        name: [
            dict(paired(test, modes[0], modes[2], test["layout"][0]))
            for test, (modes, _) in zip(tests, found, strict=True)
        ]
        for name, found in results.items()
    }
    out = {}
    for name, found in results.items():
        squares = []
        for k, test in enumerate(tests):
            for r in set.intersection(*(set(each[k]) for each in pairs.values())):
                squares.append(errors(test, r, found[k][0], pairs[name][k][r]))
        seconds = sum(each[1] for each in found)
        mean = np.sqrt(np.mean(squares, axis=0))
        out[name] = Compared(sum(map(len, pairs[name])), mean, seconds)
    return out


def errors(test: dict[str, Any], r: int, modes: Modes, c: int) -> Floats:
    """Return squares of the errors of mode c, which is true mode r: frequency, damping, shape."""
    f, zeta, phi = modes[0][c], modes[1][c], modes[2][c]
    true = test["phi"][r, test["layout"][0]]
    true = true / np.linalg.norm(true)
    shape = np.mean((phi * np.sign(phi @ true) - true) ** 2)
    return np.array([(f / test["f0"][r] - 1) ** 2, (zeta / test["zeta"][r] - 1) ** 2, shape])


def main(first: int, last: int) -> None:
    """Print what both find."""
    seeds = range(first, last + 1)
    total = sum(ambient_test(seed, 1)["f0"].size for seed in seeds)
    print(f"{len(seeds)} tests of {total} modes; errors of the modes that all find")
    print("program                found  frequency   damping    shapes   CPU s")
    for name, each in compare(seeds).items():
        f, zeta, phi = each.errors
        print(
            f"{name:<22} {each.found:5}  {f:9.1e} {zeta:9.1e} {phi:9.1e} {each.seconds:7.1f}",
            flush=True,
        )


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]))
