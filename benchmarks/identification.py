"""Simulated hammer tests: all modes and no others, and intervals that hold the truth.

``python benchmarks/identification.py [RUNS [CASES]]`` prints, for every case, in how many runs the
modes are exactly those of the structure, and the share of the errors of frequencies, damping ratios
and shape components (of unit norm) within 1.96 standard deviations. Five blows, three references,
the number of modes not given.

===========  ==================================================================================
structure    modes
===========  ==================================================================================
three-story  the laboratory building, 4.6, 12.8 and 17.9 Hz; damping 1.0, 1.2 and 0.8 %
eight        random shapes at ten sensors; 9.00 and 9.09 Hz with 1 % damping, one mode that two
             sensors see, one with 8 % damping; "edge": the band ends 0.5 Hz above the last mode
===========  ==================================================================================

Noise: ``white``, the same at all lines, in parts of the rms of each function; ``coloured``, growing
sevenfold over the band; ``relative``, in parts of the function itself; ``force``, white and as much
again in the force, common to all responses. ``blows``: the method is given all of them;
``mean``: their mean only, so that the variance comes from the residuals; ``coherence``: mean and
coherence, but not the number of blows, as CSV files have them. White noise makes the coherence drop
at antiresonances. ``records``: white noise in the records of force and responses in time, of 20 s,
which end before the vibration does; H1, force window, exponential window.
"""

from __future__ import annotations

import sys
import time
from dataclasses import dataclass, replace

import numpy as np

from modefront._typing import Complexes, Floats
from modefront.data.impact import Windows, impact_responses
from modefront.data.responses import FrequencyResponses, frequency_responses
from modefront.identification.methods.hammer import identify
from modefront.identification.record import Identification

F = np.arange(0.05, 30.05, 0.05)
BLOWS = 5


@dataclass(frozen=True)
class Structure:
    """Modes of a structure, the references, and the band."""

    frequency: Floats
    damping: Floats
    shape: Floats
    references: tuple[int, ...]
    band: tuple[float, float]

    def accelerances(self, f: Floats) -> Complexes:
        """Return exact accelerances at f in Hz, (references, responses, lines)."""
        s = 2j * np.pi * f
        omega = 2 * np.pi * self.frequency[:, None]
        G = s**2 / (s**2 + 2 * self.damping[:, None] * omega * s + omega**2)
        out: Complexes = np.einsum(
            "rj,ri,rk->jik", self.shape[:, list(self.references)], self.shape, G
        )
        return out


def three_story() -> Structure:
    M = 22.6 * np.array([1, 1, 0.76])
    K = 84763.8 * np.array([[2.0, -1, 0], [-1, 2, -1], [0, -1, 1]])
    squared, vectors = np.linalg.eigh(K / np.sqrt(np.outer(M, M)))
    damping = np.array([0.010, 0.012, 0.008])
    return Structure(
        np.sqrt(squared) / (2 * np.pi), damping, (vectors.T / np.sqrt(M)), (0, 1, 2), (1.0, 30.0)
    )


def eight(high: float = 30.0) -> Structure:
    shape = np.linalg.qr(np.random.default_rng(3).standard_normal((10, 10)))[0][:8]
    shape[4] = 0
    shape[4, [2, 7]] = 0.4, -0.3
    frequency = np.array([5.0, 9.0, 9.09, 14.0, 18.0, 21.0, 25.0, 29.0])
    damping = np.array([0.01, 0.01, 0.01, 0.015, 0.01, 0.08, 0.01, 0.012])
    return Structure(frequency, damping, shape, (0, 2, 9), (2.0, high))


def noisy(H: Complexes, kind: str, level: float, rng: np.random.Generator) -> Complexes:
    """Return the functions of all blows, (blows, references, responses, lines)."""

    def circular(*shape: int) -> Complexes:
        out: Complexes = rng.standard_normal(shape) + 1j * rng.standard_normal(shape)
        return out / np.sqrt(2)

    deviation = level * np.sqrt(np.mean(np.abs(H) ** 2, axis=-1, keepdims=True))
    if kind == "coloured":
        deviation = deviation * (0.3 + 2 * (F / F[-1]) ** 2)
    if kind == "relative":
        deviation = level * np.abs(H)
    measured = H + deviation * circular(BLOWS, *H.shape)
    if kind == "force":
        measured = measured * (1 + level * circular(BLOWS, H.shape[0], 1, H.shape[2]))
    return measured


RATE, DURATION, PULSE = 256.0, 20.0, 4
"""Samples per second, seconds of a record, samples of an impact."""


def recorded(structure: Structure, level: float, rng: np.random.Generator) -> FrequencyResponses:
    """Return the functions of records of impacts: force and responses with white noise."""
    samples = int(RATE * DURATION)
    H = structure.accelerances(np.arange(4 * samples + 1) * RATE / (8 * samples))
    parts = []
    for j in range(len(H)):
        force, response = np.zeros((BLOWS, samples)), np.zeros((BLOWS, H.shape[1], samples))
        for b in range(BLOWS):
            force[b, 20 : 20 + PULSE] = np.sin(np.pi * np.arange(1, PULSE + 1) / (PULSE + 1))
            force[b] *= rng.uniform(0.5, 1.5)
            spectrum = np.fft.rfft(force[b], 8 * samples)
            response[b] = np.fft.irfft(H[j] * spectrum, 8 * samples)[:, :samples]
        for x in (force, response):
            rms = np.sqrt(np.mean(x**2, axis=-1, keepdims=True))
            x += level * rms * rng.standard_normal(x.shape)
        averaged = impact_responses(force, response, RATE, windows=Windows(force_window=0.1))
        parts.append(averaged.data)
    return replace(
        parts[0],
        H=np.concatenate([part.H for part in parts]),
        variance=np.concatenate([part.variance for part in parts if part.variance is not None]),
        references=tuple(map(str, structure.references)),
        force_noise=tuple(noise for part in parts for noise in part.force_noise),
    )


def measured_functions(
    structure: Structure, kind: str, level: float, data: str, rng: np.random.Generator
) -> FrequencyResponses:
    """Return the data of one simulated test of one case."""
    if kind == "records":
        return recorded(structure, level, rng)
    blows = noisy(structure.accelerances(F), kind, level, rng)
    if data == "blows":
        return frequency_responses(F, blows)
    mean = blows.mean(axis=0)
    if data == "mean":
        return frequency_responses(F, mean)
    coherence = np.abs(mean) ** 2 / np.mean(np.abs(blows) ** 2, axis=0)
    return frequency_responses(F, mean, coherence=coherence)


def is_right(result: Identification, structure: Structure) -> bool:
    """Return whether the modes are exactly those of the structure."""
    f = np.array([mode.frequency for mode in result.modes])
    true = structure.frequency
    return len(f) == len(true) and bool((np.abs(f - true) < 0.02 * true).all())


def scores(result: Identification, structure: Structure) -> tuple[list[float], ...]:
    """Return errors over standard deviations of frequencies, damping ratios and shapes."""
    f: list[float] = []
    zeta: list[float] = []
    phi: list[float] = []
    for r, mode in enumerate(result.modes):
        true = structure.shape[r] / np.linalg.norm(structure.shape[r])
        true = true * np.sign(true @ mode.shape.shape)
        f.append((mode.frequency - structure.frequency[r]) / mode.frequency_std)
        zeta.append((mode.damping - structure.damping[r]) / mode.damping_std)
        phi.extend((mode.shape.shape - true) / mode.shape_std)
    return f, zeta, phi


CASES = [
    *(
        (name, "white", level, data)
        for name in ("three-story", "eight")
        for level in (0.01, 0.05)
        for data in ("blows", "mean", "coherence")
    ),
    *(
        (name, kind, 0.05, "blows")
        for name in ("three-story", "eight", "edge")
        for kind in ("coloured", "relative", "force")
    ),
    *(
        (name, "records", level, "blows")
        for name in ("three-story", "eight")
        for level in (0.01, 0.05)
    ),
]


def main(runs: int, only: str = "") -> None:
    structures = {"three-story": three_story(), "eight": eight(), "edge": eight(29.5)}
    print(f"{runs} runs a case; parts within 1.96 standard deviations, their errors' deviation")
    print(
        "structure    noise      level data      right    frequency"
        "    damping      shapes     CPU s"
    )
    for name, kind, level, data in CASES:
        if only not in f"{name} {kind} {data}":
            continue
        structure = structures[name]
        errors: list[list[float]] = [[], [], []]
        right, spent = 0, 0.0
        for seed in range(runs):
            rng = np.random.default_rng([seed, 18])
            given = measured_functions(structure, kind, level, data, rng)
            before = time.process_time()
            result = identify(given, structure.band)
            spent += time.process_time() - before
            if is_right(result, structure):
                right += 1
                for total, part in zip(errors, scores(result, structure), strict=True):
                    total.extend(part)
        held = [f"{np.mean(np.abs(z) < 1.96):.1%} ({np.std(z):.2f})" for z in map(np.array, errors)]
        print(
            f"{name:<12} {kind:<10} {level:<5} {data:<9} {right:>3}/{runs:<4}"
            + "".join(f" {text:>12}" for text in held)
            + f" {spent / runs:8.2f}",
            flush=True,
        )


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 200, *sys.argv[2:3])
