"""Hammer tests in time by integrating equations of motion; nothing of the package is used here.

A random network of masses, springs and dashpots is hit with smooth pulses. Its state space model is
discretised exactly for forces that are linear between samples, and integrated until the motion has
died out; functions are quotients of spectra, blow by blow. Displacements have white noise.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.linalg as la
import scipy.signal as signal


def network(modes: int, rng: np.random.Generator) -> tuple[Any, Any, Any]:
    """Return mass, damping and stiffness of a random network with frequencies from 12 to 90 Hz."""
    wished = 2 * np.pi * np.sort(rng.uniform(12, 90, modes))
    chain = np.diff(np.eye(modes), axis=0)
    K = np.eye(modes) + chain.T @ (rng.uniform(1, 30, modes - 1)[:, None] * chain)
    for _ in range(modes):
        a, b = rng.choice(modes, 2, replace=False)
        e = np.eye(modes)[a] - np.eye(modes)[b]
        K += rng.uniform(0, 10) * np.outer(e, e)
    shapes = la.eigh(K)[1]
    root = np.sqrt(rng.uniform(0.5, 2.0, modes))
    zeta = rng.uniform(0.006, 0.02, modes)
    K = root[:, None] * (shapes * wished**2) @ shapes.T * root
    C = root[:, None] * (shapes * (2 * zeta * wished)) @ shapes.T * root
    return np.diag(root**2), C, K


def hammer_test(seed: int) -> dict[str, Any]:
    """Return frequencies, functions of all blows, and the true modes of one random test."""
    rng = np.random.default_rng([seed, 977])
    modes = int(rng.integers(3, 41))
    M, C, K = network(modes, rng)
    sensors = np.sort(rng.choice(modes, int(rng.integers(min(modes, 4), modes + 1)), False))
    points = rng.choice(sensors, min(len(sensors), int(rng.integers(2, 4))), False)
    omega2, phi = la.eigh(K, M)
    zeta = np.einsum("ir,ij,jr->r", phi, C, phi) / (2 * np.sqrt(omega2))
    rate, duration = 512.0, 20.0
    n = int(rate * duration)
    A = np.block([[np.zeros((modes, modes)), np.eye(modes)], [-la.solve(M, K), -la.solve(M, C)]])
    B = np.vstack([np.zeros((modes, len(points))), la.solve(M, np.eye(modes)[:, points])])
    out = np.hstack([np.eye(modes)[sensors], np.zeros((len(sensors), modes))])
    system = (A, B, out, np.zeros((len(sensors), len(points))))
    Ad, Bd, Cd, Dd, _ = signal.cont2discrete(system, 1 / rate, "foh")
    pulse = np.zeros(n)
    pulse[8:13] = np.sin(np.pi * np.arange(1, 6) / 6) ** 2
    y = np.empty((n, len(sensors), len(points)))
    x = np.zeros((2 * modes, len(points)))
    for k in range(n):
        y[k] = Cd @ x + Dd * pulse[k]
        x = Ad @ x + Bd * pulse[k]
    level = np.exp(rng.uniform(np.log(0.001), np.log(0.02)))
    y = y.transpose(2, 1, 0)
    rms = np.sqrt(np.mean(y**2, axis=-1, keepdims=True))
    noisy = y + level * rms * rng.standard_normal((5, *y.shape))
    f = np.fft.rfftfreq(n, 1 / rate)
    kept = (f >= 6) & (f <= 100)
    force = (np.fft.rfft(pulse) * np.sinc(f / rate) ** 2)[kept]  # of the line between samples
    return {
        "frequency": f[kept],
        "H": np.fft.rfft(noisy, axis=-1)[..., kept] / force,
        "quantity": "receptance",
        "f0": np.sqrt(omega2) / (2 * np.pi),
        "zeta": zeta,
        "phi": phi.T[:, sensors],
        "factors": phi.T[:, points],
    }
