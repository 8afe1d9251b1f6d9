"""Simulated hammer tests with known modes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from modefront._typing import Complexes, Floats

THREE_STORY = np.array([4.64600069, 12.77689009, 17.89378185])  # Hz
THREE_STORY_DAMPING = np.array([0.01, 0.012, 0.008])


def three_story_shapes() -> Floats:
    """Return mass-normalised shapes of the three-story building, one row a mode."""
    M = 22.6 * np.array([1, 1, 0.76])
    K = 84763.8 * np.array([[2.0, -1, 0], [-1, 2, -1], [0, -1, 1]])
    root = 1 / np.sqrt(M)
    out: Floats = np.linalg.eigh(K * np.outer(root, root))[1].T * root
    return out


def accelerance(
    f: Floats, f0: Floats, zeta: Floats, phi: Floats, references: Sequence[int]
) -> Complexes:
    """Return exact accelerances, (references, responses, lines)."""
    s = 2j * np.pi * f
    omega = 2 * np.pi * np.asarray(f0)[:, None]
    G = s**2 / (s**2 + 2 * np.asarray(zeta)[:, None] * omega * s + omega**2)
    out: Complexes = np.einsum("rj,ri,rk->jik", phi[:, references], phi, G)
    return out


def circular(rng: np.random.Generator, shape: tuple[int, ...]) -> Complexes:
    """Return complex normal numbers of unit variance."""
    out: Complexes = (rng.standard_normal(shape) + 1j * rng.standard_normal(shape)) / np.sqrt(2)
    return out


def blows(
    H: Complexes, level: float, rng: np.random.Generator, count: int = 5, force: float = 0.0
) -> Complexes:
    """Return repeated measurements with errors of the responses and of the force."""
    rms = np.sqrt(np.mean(np.abs(H) ** 2, axis=-1, keepdims=True))
    noisy = H + level * rms * circular(rng, (count, *H.shape))
    out: Complexes = noisy * (1 + force * circular(rng, (count, H.shape[0], 1, H.shape[2])))
    return out


def impact_records(
    f0: Floats, zeta: Floats, phi: Floats, reference: int, rng: np.random.Generator, level: float
) -> tuple[Floats, Floats, Floats]:
    """Return time, force and accelerations of one blow, with noise, before they have died out."""
    rate, samples, periods = 128.0, 1280, 8
    f = np.arange(periods * samples // 2 + 1) * rate / (periods * samples)
    H = accelerance(f, f0, zeta, phi, [reference])[0]
    force = np.zeros(samples)
    force[20:23] = rng.uniform(1, 2) * np.array([0.7, 1.0, 0.7])
    y = np.fft.irfft(H * np.fft.rfft(force, periods * samples), periods * samples)[:, :samples]
    y = y + level * y.std(axis=1, keepdims=True) * rng.standard_normal(y.shape)
    return np.arange(samples) / rate, force + level * 0.01 * rng.standard_normal(samples), y
