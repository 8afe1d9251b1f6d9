"""Ambient tests in time by integrating equations of motion; nothing of the package is used here.

A random network of masses, springs and dashpots is shaken at all masses by coloured noise that is
partly common to them, and in every third test by a machine. Its equations are discretised exactly,
mode by mode, for forces that are linear between samples. Accelerations have white noise.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.linalg as la
import scipy.signal as signal

MASSES, RATE, FINE = 20, 32.0, 4
"""Masses of the network, of which more vibrate than modes are in the band; samples a second, and
how many times more in the integration: records are filtered before samples are left out."""

BAND = 0.3, 12.0
"""Hz."""


def network(frequency: Any, zeta: Any, rng: np.random.Generator) -> tuple[Any, Any]:
    """Return circular frequencies and mass-normalised shapes of a random network."""
    n = len(frequency)
    chain = np.diff(np.eye(n), axis=0)
    K = np.eye(n) + chain.T @ (rng.uniform(1, 30, n - 1)[:, None] * chain)
    for _ in range(n):
        a, b = rng.choice(n, 2, replace=False)
        e = np.eye(n)[a] - np.eye(n)[b]
        K += rng.uniform(0, 10) * np.outer(e, e)
    shapes = la.eigh(K)[1]
    return 2 * np.pi * frequency, shapes / np.sqrt(rng.uniform(0.5, 2.0, n))[:, None]


def frequencies(modes: int, rng: np.random.Generator) -> Any:
    """Return frequencies in Hz, (masses,): so many in the band, a pair of them close or not."""
    while True:
        f = np.sort(np.exp(rng.uniform(np.log(0.6), np.log(10.5), modes)))
        if modes < 2 or np.diff(np.log(f)).min() > 0.03:
            break
    if rng.uniform() < 0.5:
        pair = int(rng.integers(modes - 1))
        f[pair + 1] = f[pair] * (1 + rng.uniform(0.005, 0.03))
    return np.append(np.sort(f), np.sort(rng.uniform(14, 40, MASSES - modes)))


def ambient_test(seed: int, setups: int | None = None) -> dict[str, Any]:
    """Return the records of all setups, and the true modes, of one random test."""
    rng = np.random.default_rng([seed, 4021])
    modes = int(rng.integers(3, 13))
    f = frequencies(modes, rng)
    zeta = np.exp(rng.uniform(np.log(0.004), np.log(0.025), MASSES))
    omega, phi = network(f, zeta, rng)
    count = setups or int(rng.choice([1, 1, 2, 3, 4, 5]))
    minutes = float(np.exp(rng.uniform(np.log(10), np.log(60))))
    fine = FINE * RATE
    n = int(60 * minutes * fine)
    places = rng.permutation(MASSES)
    if count == 1:
        layout = [np.sort(places[: rng.integers(4, 16)])]
    else:
        references, roving = np.split(places, [int(rng.integers(2, 4))])
        layout = [np.append(references, part) for part in np.array_split(roving[:15], count)]
    corner, share = rng.uniform(0.5, 8.0, 2), rng.uniform(0, 0.5)
    strength = rng.uniform(0.5, 2.0, MASSES)
    machine = rng.uniform(1.0, 9.0) if rng.uniform() < 1 / 3 else None
    mount, power = int(rng.integers(MASSES)), np.exp(rng.uniform(np.log(0.1), np.log(3)))
    level = np.exp(rng.uniform(np.log(0.003), np.log(0.1)))
    gain = rng.uniform(0.7, 1.4, MASSES)
    systems = [
        signal.cont2discrete(([1.0, 0.0, 0.0], [1.0, 2 * z * w, w * w]), 1 / fine, "foh")
        for w, z in zip(omega, zeta, strict=True)
    ]
    mixing = strength[:, None] * np.column_stack(
        [np.sqrt(1 - share) * np.eye(MASSES), np.sqrt(share) * np.ones(MASSES)]
    )
    records = []
    skipped = int(60 * fine)
    for sensors in layout:
        white = rng.standard_normal((MASSES + 1, n + skipped))
        colour = [np.exp(-2 * np.pi * c / fine) for c in corner]
        forces = [signal.lfilter([1 - a], [1, -a], white) for a in colour]
        force = mixing @ (forces[0] + 0.5 * forces[1])
        if machine is not None:
            t = np.arange(n + skipped) / fine
            force[mount] += power * force[mount].std() * np.sin(2 * np.pi * machine * t)
        modal = phi.T @ force
        q = [signal.lfilter(b[0], a, p) for (b, a, _), p in zip(systems, modal, strict=True)]
        y = signal.decimate(phi[sensors] @ np.array(q)[:, skipped:], FINE, ftype="fir")
        noise = level * y.std() * gain[sensors, None] * rng.standard_normal(y.shape)
        records.append(y + noise)
    return {
        "records": records,
        "layout": layout,
        "rate": RATE,
        "f0": f[:modes],
        "zeta": zeta[:modes],
        "phi": phi.T[:modes],
        "machine": machine,
        "minutes": minutes,
        "level": level,
        "forces": (mixing, corner, strength),
        "all": (f, zeta, phi),
        "gain": gain,
    }
