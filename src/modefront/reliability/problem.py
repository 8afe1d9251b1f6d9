"""The first-passage problem; docs/methods/first-passage.md states it.

Densities are per rad/s. The noise may be modulated, q(t_k + Δt/2) w_k, and may then pass the filter
(ω_g² + 2iζ_g ω_g ω) / (ω_g² - ω² + 2iζ_g ω_g ω) of a soil, the absolute acceleration of a damped
oscillator on a base accelerated by it (H. Tajimi, Proc. 2nd World Conf. Earthquake Eng. (1960)
781-797).
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from modefront.response.system import FloatArray, ModalSystem

LARGEST_ANGLE = np.pi / 2
"""Largest ω Δt: a quarter of a period. Beyond it the times t_j miss the peaks of the response."""


@dataclass(frozen=True)
class FirstPassage:
    """A linear structure at rest, its Gaussian load, and the times at which it is looked at.

    The responses are displacements at the outputs of `system`, of its modes alone: white noise
    has no quasi-static response, so `system.static` is not used. Responses with barriers of their
    own are brought to a common one by scaling the rows of the system's `output`.

    Attributes
    ----------
    system : the structure, with n_inputs loads and n_outputs responses
    intensity : 2πS of the white noise, independent at each input, with its two-sided spectral
        density S in (unit of load)²/(rad/s)
    duration : T in s, a whole number of time steps
    time_step : δt in s, at most a quarter of the shortest period of a mode or of the filter
    soil : ω_g in rad/s and ζ_g of the filter that the noise passes, or None
    modulation : q, mapping an (n,) array of times in s to (n,) factors; None for a constant 1
    """

    system: ModalSystem
    intensity: float
    duration: float
    time_step: float
    soil: tuple[float, float] | None = None
    modulation: Callable[[FloatArray], FloatArray] | None = None

    @property
    def steps(self) -> int:
        """The number n of time steps."""
        return round(self.duration / self.time_step)
