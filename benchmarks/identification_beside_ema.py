"""Identification beside `sdypy-EMA`, which is given the right frequencies, in one run.

``python benchmarks/identification_beside_ema.py [RUNS]``, with `sdypy-EMA` installed. Both get the
mean functions of five blows of `benchmarks/identification.py`; this package gets the blows too. It
finds modes by itself; `sdypy-EMA` (least-squares complex frequency-domain method up to the
polynomial order given, stable poles nearest to the true frequencies, least squares for the modal
constants) cannot go without the true frequencies.

Errors are root mean squares over modes and runs: of frequencies and damping ratios over the true
ones, and of shape components of unit norm. Seconds are CPU time per run.

Its selection of poles averages over at least 2 Hz on either side: frequencies are given to it
`SCALE` times as high, which changes nothing else, so that close modes stay apart.

Then, where `../shared/data` is, the measured beam and the three points of a casting, of which the
truth is not known: the frequencies that both find, and the time.
"""

from __future__ import annotations

import contextlib
import io
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from sdypy import EMA

from identification import F, Structure, eight, noisy, three_story
from modefront._typing import Complexes, Floats
from modefront.data.responses import frequency_responses
from modefront.identification.methods.hammer import identify
from modefront.identification.shapes import real_shape

SCALE = 200.0
ORDERS = 30, 60, 100
"""Polynomial orders; 100 is the default of `sdypy-EMA`."""

Modes = tuple[Floats, Floats, Floats]


def by_modefront(measured: Complexes, structure: Structure) -> Modes:
    """Return frequencies, damping ratios and shapes that are found."""
    result = identify(frequency_responses(F, measured), structure.band).modes
    return (
        np.array([mode.frequency for mode in result]),
        np.array([mode.damping for mode in result]),
        np.array([mode.shape.shape for mode in result]),
    )


def by_ema(order: int) -> Callable[[Complexes, Structure], Modes]:
    """Return a function that identifies by `sdypy-EMA` with a highest order."""

    def identified(measured: Complexes, structure: Structure) -> Modes:
        H = measured.mean(axis=0)
        model = fitted_by_ema(
            H.reshape(-1, H.shape[2]),
            SCALE * F,
            SCALE * structure.frequency,
            SCALE * structure.band[0],
            order,
        )
        A = model.A.reshape(*H.shape[:2], -1)
        strongest = np.abs(A).sum(axis=1).argmax(axis=0)
        shapes = [real_shape(A[j, :, r]).shape for r, j in enumerate(strongest)]
        return np.array(model.nat_freq) / SCALE, np.array(model.nat_xi), np.array(shapes)

    return identified


def fitted_by_ema(H: Complexes, f: Floats, known: Floats, low: float, order: int) -> EMA.Model:
    """Return the model of functions (functions, lines) with poles nearest to known frequencies."""
    with contextlib.redirect_stderr(io.StringIO()):  # progress bars
        model = EMA.Model(
            H,
            f,
            lower=low,
            upper=f[-1],
            pol_order_high=order,
            frf_form="accelerance",
        )
        model.get_poles(method="lscf", show_progress=False)
        model.select_closest_poles(list(known), f_window=5)
        model.get_constants(method="lsfd")
    return model


def errors(result: Modes, structure: Structure) -> Floats:
    """Return the mean square errors of frequencies, damping ratios and shapes."""
    f, zeta, phi = result
    if len(f) != len(structure.frequency):
        return np.full(3, np.nan)
    true = structure.shape / np.linalg.norm(structure.shape, axis=1, keepdims=True)
    phi = phi * np.sign(np.sum(phi * true, axis=1, keepdims=True))
    return np.array(
        [
            np.mean((f / structure.frequency - 1) ** 2),
            np.mean((zeta / structure.damping - 1) ** 2),
            np.mean((phi - true) ** 2),
        ]
    )


def real_data() -> list[tuple[str, Floats, Complexes, Floats, float]]:
    """Return name, lines, functions, frequencies at the peaks and lower end of the band."""
    folder = Path(__file__).parents[2] / "shared" / "data"
    if not folder.is_dir():
        return []
    with np.load(folder / "frf" / "roving_hammer_beam.npz") as arrays:
        beam = arrays["f"], arrays["H"].astype(complex)
    points = [
        np.array([complex(line) for line in path.read_text().split()])
        for path in sorted((folder / "uff").glob("meas_point_*.txt"))
    ]
    return [
        ("beam", *beam, np.array([112.0, 306.9, 596.4, 974.1]), 50.0),
        (
            "casting",
            np.arange(len(points[0]), dtype=float),
            np.array(points),
            np.array([51.5, 142.2, 278.7, 460.4, 687.2, 958.5]),
            5.0,
        ),
    ]


def main(runs: int) -> None:
    """Print the errors and the time of both programs on both structures."""
    methods = {"modefront": by_modefront} | {f"sdypy-EMA {n}": by_ema(n) for n in ORDERS}
    print(f"{runs} runs a case; root mean squares of errors, CPU seconds a run")
    print("structure    noise  program         frequency   damping    shapes  CPU s")
    for name, structure in (("three-story", three_story()), ("eight", eight())):
        H = structure.accelerances(F)
        for level in (0.01, 0.05):
            for program, identified in methods.items():
                squares, spent = [], 0.0
                for seed in range(runs):
                    measured = noisy(H, "white", level, np.random.default_rng([seed, 18]))
                    before = time.process_time()
                    computed = identified(measured, structure)
                    spent += time.process_time() - before
                    squares.append(errors(computed, structure))
                f, zeta, phi = np.sqrt(np.mean(squares, axis=0))
                print(
                    f"{name:<12} {level:<6} {program:<15} {f:9.1e} {zeta:9.1e} {phi:9.1e} "
                    f"{spent / runs:6.2f}",
                    flush=True,
                )
    for name, f, H, known, low in real_data():
        before = time.process_time()
        result = identify(frequency_responses(f, H), (low, float(f[-1])))
        spent = time.process_time() - before
        listed = ", ".join(f"{mode.frequency:.2f}" for mode in result.modes)
        print(f"{name}: modefront, {spent:.1f} s: {listed} Hz")
        for order in ORDERS:
            before = time.process_time()
            model = fitted_by_ema(H, f, known, low, order)
            spent = time.process_time() - before
            listed = ", ".join(f"{value:.2f}" for value in model.nat_freq)
            print(f"{name}: sdypy-EMA {order}, {spent:.1f} s: {listed} Hz", flush=True)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 50)
