"""The response to a pulse one time step long, exact for a load held constant over a step.

A mode under the load p, and p the filtered noise w or w itself, are a linear system ṡ = A s + B w
with the state s = (q, q̇[, f, ḟ]),

    q̈ = -2ζω q̇ - ω² q + p,      p = w    or    p = ω_g² f + 2ζ_g ω_g ḟ,
                                f̈ = -2ζ_g ω_g ḟ - ω_g² f + w.

With w constant over a step, s(t + Δt) = Φ s(t) + Θ w exactly, where

    exp( [A B; 0 0] Δt ) = [Φ Θ; 0 1],

so a pulse w = 1 on [0, Δt) leaves s(t_j) = Φ^{j-1} Θ. The powers are had by doubling:
Φ^K times the first K columns are the next K.
"""

import numpy as np
from scipy.linalg import expm

from modefront.reliability.problem import FirstPassage, KanaiTajimi
from modefront.response.system import FloatArray, ModalSystem


def pulse_response(problem: FirstPassage) -> FloatArray:
    """Return the outputs at t_1 … t_n after a unit pulse on [0, Δt) at one input.

    The array is (n_outputs, n_inputs, n), in units of output per unit load.
    """
    generator = _generator(problem.system, problem.filter)
    step = np.asarray(expm(generator * problem.time_step))
    power, states = step[:, :-1, :-1], step[:, :-1, -1:]
    while states.shape[-1] < problem.steps():
        # Not `@`: sums of two to four terms need no BLAS, whose threads may change the last digit.
        states = np.concatenate([states, np.einsum("mij,mjk->mik", power, states)], axis=-1)
        power = np.einsum("mij,mjk->mik", power, power)
    modal = states[:, 0, : problem.steps()]
    shapes = problem.system
    outputs: FloatArray = np.einsum("om,mi,mk->oik", shapes.output, shapes.input, modal)
    return outputs


def _generator(system: ModalSystem, soil: KanaiTajimi | None) -> FloatArray:
    """Return [A B; 0 0] of each mode, (m, 3, 3), or (m, 5, 5) with a filter."""
    size = 3 if soil is None else 5
    generator = np.zeros((system.omega.size, size, size))
    generator[:, 0, 1] = 1
    generator[:, 1, 0] = -(system.omega**2)
    generator[:, 1, 1] = -2 * system.zeta * system.omega
    if soil is None:
        generator[:, 1, 2] = 1
    else:
        generator[:, 1, 2:4] = soil.omega**2, 2 * soil.zeta * soil.omega
        generator[:, 2, 3] = 1
        generator[:, 3, 2:] = -(soil.omega**2), -2 * soil.zeta * soil.omega, 1
    return generator
