"""Ambient tests of towers by Newmark's integration; shares no code with `ambient_in_time`.

Floors of a random tower move along x and y and turn; centres of mass lie beside those of stiffness,
so that bending along x and y and torsion come in close groups. Wind along x and y has von Karman
spectra of its own and is related over the height; a machine has a second harmonic. The equations of
all floors are integrated by constant average acceleration. Its poles are known: it replaces s by
2 / dt (z - 1) / (z + 1). Accelerations at two corners of each floor have white noise.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.linalg as la
import scipy.signal as signal

FLOORS, RATE, FINE = 9, 32.0, 2
"""Floors; samples a second, and how many times more in the integration."""

GAP = 11.0, 14.5
"""Hz; no mode lies between them, nor near the end of the band."""


def tower(modes: int, rng: np.random.Generator) -> tuple[Any, Any, Any]:
    """Return M, K and the map to the corners of a tower with so many modes below the gap."""
    while True:
        offset = rng.uniform(-0.08, 0.08, 2)
        beside = np.array([[1.0, 0, -offset[1]], [0, 1.0, offset[0]], [0, 0, 1.0]])
        inertia = np.diag([1.0, 1.0, rng.uniform(0.15, 0.5)])
        floor = np.diag([1.0, rng.uniform(0.9, 1.3), rng.uniform(0.3, 1.2)])
        chain = np.eye(FLOORS) - np.eye(FLOORS, k=-1)
        shear = chain.T @ (rng.uniform(0.5, 2.0, FLOORS)[:, None] * chain)
        M = np.kron(np.diag(rng.uniform(0.7, 1.4, FLOORS)), beside.T @ inertia @ beside)
        K = np.kron(shear, floor)
        omega = np.sqrt(la.eigh(K, M, eigvals_only=True))
        if omega[modes] / omega[modes - 1] > GAP[1] / GAP[0]:
            break
    K *= (2 * np.pi * GAP[0] * rng.uniform(0.97, 1.0) / omega[modes - 1]) ** 2
    corners = np.array([[1, 0, -0.5], [0, 1, 0.7], [1, 0, 0.5], [0, 1, -0.7]])
    return M, K, np.kron(np.eye(FLOORS), corners)


def wind(shape: tuple[int, ...], rng: np.random.Generator) -> Any:
    """Return forces (floors, 3, setups, samples): each direction with a spectrum of its own."""
    f = np.fft.rfftfreq(shape[-1], 1 / (RATE * FINE))
    height = np.arange(FLOORS)
    length, corner = rng.uniform(0.5, 8.0), rng.uniform(0.2, 4.0, 3)
    related = np.exp(-np.abs(height[:, None] - height) / length)
    size = rng.uniform(0.5, 1.5, 3) * np.array([1.0, 1.0, 0.4])
    out = np.empty(shape)
    for axis in range(3):
        colour = size[axis] * (1 + 70.8 * (f / corner[axis] / 8) ** 2) ** (-5 / 12)
        for setup in range(shape[2]):
            white = la.cholesky(related, lower=True) @ rng.standard_normal((FLOORS, shape[-1]))
            spectrum = np.fft.rfft(white, axis=1) * colour
            out[:, axis, setup] = np.fft.irfft(spectrum, shape[-1], axis=1)
    return out


def integrated(M: Any, C: Any, K: Any, force: Any, dt: float) -> Any:
    """Return accelerations of (steps, DOFs, setups) forces by constant average acceleration.

    It is the trapezoidal rule for displacements and velocities.
    """
    n = len(M)
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-la.solve(M, K), -la.solve(M, C)]])
    inverse = la.inv(np.eye(2 * n) - dt / 2 * A)
    step = inverse @ (np.eye(2 * n) + dt / 2 * A)
    own = la.solve(M, np.eye(n)) @ force
    load = inverse[:, n:] @ (dt / 2 * (own[1:] + own[:-1]))
    state, x = np.zeros((len(force), 2 * n, force.shape[2])), np.zeros((2 * n, force.shape[2]))
    for k, each in enumerate(load, 1):
        x = step @ x
        x += each
        state[k] = x
    return own + A[n:] @ state


def ambient_test(seed: int, setups: int | None = None) -> dict[str, Any]:
    """Return the records of all setups, and the true modes, of one random tower."""
    rng = np.random.default_rng([seed, 1959])
    modes, dt = int(rng.integers(3, 13)), 1 / (RATE * FINE)
    M, K, corners = tower(modes, rng)
    values, phi = la.eigh(K, M)
    omega = np.sqrt(values)
    zeta = np.exp(rng.uniform(np.log(0.004), np.log(0.03), len(omega)))
    C = M @ phi @ np.diag(2 * zeta * omega) @ phi.T @ M
    count = setups or int(rng.integers(1, 6))
    minutes = float(rng.uniform(10, 60))
    places = rng.permutation(len(corners))
    references = places[: int(rng.integers(3, 5))]
    roving = np.array_split(places[len(references) : len(references) + 6 * count], count)
    layout = [np.append(references, part) for part in roving]
    skipped = int(60 / dt)
    force = wind((FLOORS, 3, count, int(60 * minutes / dt) + skipped), rng)
    machine = rng.uniform(1.0, 5.5) if rng.uniform() < 0.4 else None
    if machine is not None:
        t, place = np.arange(force.shape[-1]) * dt, int(rng.integers(FLOORS))
        size = rng.uniform(0.2, 2.0) * force[place, 0].std() * np.array([1.0, 0.5])
        for harmonic in (1, 2):
            turning = 2 * np.pi * harmonic * machine * t + rng.uniform(0, 2 * np.pi)
            force[place, :2] += size[harmonic - 1] * np.sin(turning)
    force = np.ascontiguousarray(force.reshape(3 * FLOORS, count, -1).transpose(2, 0, 1))
    a = integrated(M, C, K, force, dt)[skipped:]
    level = np.exp(rng.uniform(np.log(0.003), np.log(0.1)))
    gain = rng.uniform(0.6, 1.6, len(corners))
    records = []
    for k, sensors in enumerate(layout):
        y = signal.decimate(corners[sensors] @ a[:, :, k].T, FINE, ftype="fir")
        records.append(y + level * y.std() * gain[sensors, None] * rng.standard_normal(y.shape))
    pole = omega * (-zeta + 1j * np.sqrt(1 - zeta**2)) * dt / 2
    pole = np.log((1 + pole) / (1 - pole))[:modes] / dt
    return {
        "records": records,
        "layout": layout,
        "rate": RATE,
        "f0": np.abs(pole) / (2 * np.pi),
        "zeta": -pole.real / np.abs(pole),
        "phi": (corners @ phi).T[:modes],
        "machine": machine,
        "minutes": minutes,
        "level": level,
    }
