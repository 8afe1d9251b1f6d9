"""Random ambient tests of 3 to 12 modes in 1 to 5 setups, and how many modes are found.

``python benchmarks/identification_ambient.py FIRST LAST [GENERATOR [SETUPS]]`` prints for the seeds
FIRST to LAST of `ambient_in_time`, or of the GENERATOR `ambient_by_newmark`, the modes found,
missed and false, harmonics that were told apart, the share of errors within 90 % intervals, and the
processor time.
"""

from __future__ import annotations

import sys
import time
from importlib import import_module
from typing import Any

import numpy as np
from ambient_in_time import BAND
from scipy.optimize import linear_sum_assignment

from modefront.data.modal_test import Records
from modefront.identification.methods.ambient import identify


def paired(test: dict[str, Any], frequency: Any, shapes: Any, places: Any) -> list[tuple[int, int]]:
    """Return pairs of true and identified modes, by frequency and MAC at the sensors."""
    true = test["phi"][:, places]
    true = true / np.linalg.norm(true, axis=1)[:, None]
    mac = np.abs(true @ shapes.T) ** 2
    width = np.maximum(3 * test["zeta"] * test["f0"], 0.005 * test["f0"])
    distance = np.abs(test["f0"][:, None] - frequency) / width[:, None] + 1 - mac
    rows, columns = linear_sum_assignment(np.minimum(distance, 10.0))
    return [(r, c) for r, c in zip(rows, columns, strict=True) if distance[r, c] < 1.5]


def scored(test: dict[str, Any], result: Any) -> tuple[int, int, list[list[float]]]:
    """Return numbers of modes found and false, and errors over standard deviations."""
    places = np.array([int(name) for name in result.responses])
    shapes = np.array([mode.shape.shape for mode in result.modes]).reshape(-1, len(places))
    pairs = paired(test, np.array([mode.frequency for mode in result.modes]), shapes, places)
    errors: list[list[float]] = [[], [], []]
    for r, c in pairs:
        mode, known = result.modes[c], np.isfinite(result.modes[c].shape_std)
        true = np.where(known, test["phi"][r, places], 0.0)
        true *= np.sign(true @ mode.shape.shape) / np.linalg.norm(true)
        errors[0].append((mode.frequency - test["f0"][r]) / mode.frequency_std)
        errors[1].append((mode.damping - test["zeta"][r]) / mode.damping_std)
        errors[2].extend(((mode.shape.shape - true) / mode.shape_std)[known])
    return len(pairs), len(result.modes) - len(pairs), errors


def main(first: int, last: int, generator: str, setups: int | None) -> None:
    total, errors = np.zeros(5), [np.zeros(0) for _ in range(3)]
    print("seed modes setups minutes  noise  found false harmonic  CPU s")
    for seed in range(first, last + 1):
        test = import_module(generator).ambient_test(seed, setups)
        records = [
            Records(str(k + 1), tuple(map(str, places)), test["rate"], y)
            for k, (places, y) in enumerate(zip(test["layout"], test["records"], strict=True))
        ]
        before = time.process_time()
        result = identify(records, BAND)
        spent = time.process_time() - before
        found, false, parts = scored(test, result)
        machine = test["machine"]
        near = [abs(pole.frequency - (machine or 0)) < 0.02 for pole in result.rejected]
        told = "" if machine is None else "told" if any(near) else "not found"
        total += (len(test["f0"]), found, false, told == "told", spent)
        errors = [np.append(a, b) for a, b in zip(errors, parts, strict=True)]
        print(
            f"{seed:4} {len(test['f0']):5} {len(records):6} {test['minutes']:7.0f} "
            f"{test['level']:6.1%} {found:6} {false:5} {told:>8} {spent:6.1f}",
            flush=True,
        )
    held = [f"{np.mean(np.abs(z) < 1.645):.1%} ({np.std(z):.2f})" for z in errors]
    share = f"{total[1]:.0f} of {total[0]:.0f} ({total[1] / total[0]:.1%})"
    print(
        f"found {share}, false {total[2]:.0f}; 90 % intervals of frequency, damping, shapes hold "
        f"{', '.join(held)}; {total[4]:.0f} s"
    )


if __name__ == "__main__":
    generator = sys.argv[3] if len(sys.argv) > 3 else "ambient_in_time"
    setups = int(sys.argv[4]) if len(sys.argv) > 4 else None
    main(int(sys.argv[1]), int(sys.argv[2]), generator, setups)
