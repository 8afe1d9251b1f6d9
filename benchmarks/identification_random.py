"""Random hammer tests of 3 to 40 modes, by two generators, and how many modes are found.

``python benchmarks/identification_random.py FIRST LAST [GENERATOR]`` prints for the seeds FIRST to
LAST the modes found, missed and false, pairs, the share of errors within 90 % intervals, and the
processor time. ``modal`` makes functions from random modes; ``time`` is `identification_in_time`;
``dense`` has 25 modes, 50 sensors and 2 references, ``wide`` 20 and 200 sensors, and ``repeated``
five modes, two of them of one pole. Modes that the data cannot show are counted apart: what
all others leave of them at the noise of the mean is below what noise alone gives in the band.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Any

import identification_in_time
import numpy as np
from scipy.optimize import linear_sum_assignment

from modefront._typing import Floats
from modefront.data.responses import frequency_responses
from modefront.identification.methods.hammer import identify
from modefront.identification.modal_model import maximise
from modefront.identification.problem import problem


def modal(seed: int, size: tuple[int, int, int] | None = None) -> dict[str, Any]:
    """Return frequencies, functions of five blows and the modes of a random test."""
    rng = np.random.default_rng([seed, 37])
    modes, sensors, references = size or (
        int(rng.integers(3, 41)),
        int(rng.integers(4, 51)),
        int(rng.integers(1, 4)),
    )
    f = np.arange(5.0, 105.0, 0.0625)
    f0, zeta = np.sort(rng.uniform(8, 100, modes)), np.exp(rng.uniform(-5.3, -3.9, modes))
    phi = rng.standard_normal((modes, sensors))
    phi /= np.linalg.norm(phi, axis=1)[:, None]
    points = rng.choice(sensors, references, False)
    level = np.exp(rng.uniform(np.log(0.005), np.log(0.2)))
    return blows(f, f0, zeta, phi, points, level, rng)


# 7 arguments: what makes the functions.
def blows(
    f: Floats,
    f0: Floats,
    zeta: Floats,
    phi: Floats,
    points: Any,
    level: float,
    rng: np.random.Generator,
) -> dict[str, Any]:
    """Return a test with noise in parts of the rms of each function."""
    s, omega = 2j * np.pi * f, 2 * np.pi * f0[:, None]
    G = s**2 / (s**2 + 2 * zeta[:, None] * omega * s + omega**2)
    H = np.einsum("rj,ri,rk->jik", phi[:, points], phi, G, optimize=True)
    rms = np.sqrt(np.mean(np.abs(H) ** 2, axis=-1, keepdims=True))
    shape = (5, *H.shape)
    noise = rng.standard_normal(shape) + 1j * rng.standard_normal(shape)
    return {
        "frequency": f,
        "H": H + level * rms * noise / np.sqrt(2),
        "quantity": "accelerance",
        "f0": f0,
        "zeta": zeta,
        "phi": phi,
        "factors": phi[:, points],
    }


def repeated(seed: int) -> dict[str, Any]:
    """Return a random test of five modes, of which two have one pole."""
    rng = np.random.default_rng([seed, 3])
    f0, zeta = np.sort(rng.uniform(6, 55, 4)), rng.uniform(0.006, 0.015, 4)
    f0, zeta = np.insert(f0, 2, f0[1]), np.insert(zeta, 2, zeta[1])
    sensors = int(rng.integers(6, 13))
    phi = np.linalg.qr(rng.standard_normal((sensors, sensors)))[0][:5]
    points = rng.choice(sensors, int(rng.integers(2, 4)), False)
    f = np.arange(1.0, 60.0, 0.05)
    level = np.exp(rng.uniform(np.log(0.003), np.log(0.05)))
    return blows(f, f0, zeta, phi, points, level, rng)


GENERATORS: dict[str, Callable[[int], dict[str, Any]]] = {
    "modal": modal,
    "time": identification_in_time.hammer_test,
    "dense": lambda seed: modal(seed, (25, 50, 2)),
    "wide": lambda seed: modal(seed, (20, 200, 2)),
    "repeated": repeated,
}


def energy(test: dict[str, Any], mode: int) -> float:
    """Return what is left of exact functions, over the variance of the mean, without a mode.

    All others are fitted again, and residual terms with them.
    """
    order = {"receptance": 0, "accelerance": 2}[test["quantity"]]
    s, omega = 2j * np.pi * test["frequency"], 2 * np.pi * test["f0"][:, None]
    zeta = test["zeta"][:, None]
    G = s**order / (s**2 + 2 * zeta * omega * s + omega**2)
    H = np.einsum("rj,ri,rk->jik", test["factors"], test["phi"], G, optimize=True)
    v = test["H"].var(axis=0, ddof=1).mean(axis=-1, keepdims=True) / len(test["H"])
    data = frequency_responses(test["frequency"], H, test["quantity"])
    task, unit, _ = problem(data, np.broadcast_to(v, H.shape))
    pole = (omega * (-zeta + 1j * np.sqrt(1 - zeta**2)))[:, 0] / unit
    others = np.delete(np.arange(len(pole)), mode)
    return maximise(task, pole[others], test["factors"][others].astype(complex)).cost


def scored(test: dict[str, Any], modes: Any) -> tuple[list[int], list[int], list[list[float]]]:
    """Return true modes that were missed, false modes, and errors over standard deviations."""
    f, true = np.array([mode.frequency for mode in modes]), test["f0"]
    unit = test["phi"] / np.linalg.norm(test["phi"], axis=1)[:, None]
    u = np.array([mode.shape.shape for mode in modes]).reshape(len(f), unit.shape[1])
    # shapes of one frequency are any basis of their plane
    nearest = np.array([u @ (Q := np.linalg.qr(unit[true == x].T)[0]) @ Q.T for x in true])
    mac = np.sum(nearest**2, axis=2)
    width = np.maximum(2 * test["zeta"] * true, 0.005 * true)
    distance = np.abs(true[:, None] - f) / width[:, None] + 1 - mac
    rows, columns = linear_sum_assignment(np.minimum(distance, 10.0))
    pairs = [(r, c) for r, c in zip(rows, columns, strict=True) if distance[r, c] < 1.8]
    errors: list[list[float]] = [[], [], []]
    for r, c in pairs:
        mode, single = modes[c], np.count_nonzero(true == true[r]) == 1
        shape = np.sign(unit[r] @ u[c]) * unit[r] if single else nearest[r, c]
        errors[0].append((mode.frequency - true[r]) / mode.frequency_std)
        errors[1].append((mode.damping - test["zeta"][r]) / mode.damping_std)
        errors[2].extend((u[c] - shape) / mode.shape_std)
    missed = sorted(set(range(len(true))) - {r for r, _ in pairs})
    return missed, sorted(set(range(len(f))) - {c for _, c in pairs}), errors


def main(first: int, last: int, generator: str) -> None:
    total, errors = np.zeros(6), [np.zeros(0) for _ in range(3)]
    print("seed modes sensors refs  found missed hidden false  CPU s  what")
    for seed in range(first, last + 1):
        test = GENERATORS[generator](seed)
        data = frequency_responses(test["frequency"], test["H"], test["quantity"])
        before = time.process_time()
        result = identify(data)
        spent, modes = time.process_time() - before, result.modes
        missed, false, parts = scored(test, modes)
        n_in, n_out = test["H"].shape[1:3]
        # noise alone: the greatest singular value of a residue, over the band
        least = (np.sqrt(n_in) + np.sqrt(n_out)) ** 2 + 2 * np.log(len(test["frequency"]))
        gains = {r: energy(test, r) for r in missed}
        hidden = [r for r in missed if gains[r] < 2 * least]
        missed = [r for r in missed if r not in hidden]
        n = len(test["f0"])
        counts = (n - len(hidden), n - len(missed) - len(hidden), len(missed), len(hidden))
        total += (*counts, len(false), spent)
        errors = [np.append(a, b) for a, b in zip(errors, parts, strict=True)]
        what = [f"missed {test['f0'][r]:.2f} ({gains[r]:.0f}/{least:.0f})" for r in missed]
        what += [f"false {modes[c].frequency:.2f}" for c in false]
        what += [f"pair at {modes[k].frequency:.2f}" for k, _ in result.pairs]
        print(
            f"{seed:4} {n:5} {n_out:7} {n_in:4} {counts[1]:6} {counts[2]:6} {counts[3]:6} "
            f"{len(false):5} {spent:6.1f}  {'; '.join(what)}",
            flush=True,
        )
    held = [f"{np.mean(np.abs(z) < 1.645):.1%} ({np.std(z):.2f})" for z in errors]
    print(
        f"{generator}: found {total[1]:.0f} of {total[0]:.0f} ({total[1] / total[0]:.1%}), "
        f"{total[3]:.0f} more hidden, false {total[4]:.0f}; 90 % intervals of frequency, damping, "
        f"shapes hold {', '.join(held)}; {total[5]:.0f} s"
    )


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]), sys.argv[3] if len(sys.argv) > 3 else "modal")
