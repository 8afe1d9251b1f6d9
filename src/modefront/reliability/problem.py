"""The first-passage problem; docs/methods/first-passage.md states it.

Densities are per rad/s. The noise may be modulated, q(t_k + Δt/2) w_k, and may then pass a
Kanai-Tajimi filter, the absolute acceleration of a damped oscillator (the soil) on a base
accelerated by it.
"""

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum

import numpy as np

from modefront.errors import Fault, InputError, wrong
from modefront.response.system import FloatArray, ModalSystem, positive, real_array
from modefront.rounding import ACCUMULATED

WHOLE = 1e-6
"""Difference from a whole number of time steps that passes for the digits of their length."""

LARGEST_ANGLE = np.pi / 2
"""Largest ω Δt: a quarter of a period. Beyond it the times t_j miss the peaks of the response."""


class StepError(InputError):
    """A time step is too long for the highest circular frequency; ``limit`` is the longest one."""

    def __init__(self, time_step: float, omega: float) -> None:
        self.limit = LARGEST_ANGLE / omega
        of = f"a quarter of the period of the highest frequency ({omega:.6g} rad/s)"
        super().__init__(
            Fault("", "time_step", f"at most {self.limit:.6g} s, {of}", f"{time_step} s")
        )


class Sided(Enum):
    """Whether a spectral density is meant over all ω (two-sided) or over ω ≥ 0 (one-sided)."""

    ONE = "one-sided"
    TWO = "two-sided"


@dataclass(frozen=True)
class WhiteNoise:
    """Gaussian white noise, independent at each input and of the same density.

    Inputs of different strengths are told apart by the columns of the system's `input`.

    Attributes
    ----------
    density : spectral density in (unit of load)²/(rad/s), positive
    sided : one- or two-sided
    """

    density: float
    sided: Sided

    def __post_init__(self) -> None:
        """Check the density."""
        positive("density", self.density, "spectral density, (unit of load)²/(rad/s)")

    def intensity(self) -> float:
        """Return 2πS, the area of the covariance function."""
        two_sided = self.density if self.sided is Sided.TWO else self.density / 2
        return 2 * np.pi * two_sided


@dataclass(frozen=True)
class KanaiTajimi:
    """The filter (ω_g² + 2iζ_g ω_g ω) / (ω_g² - ω² + 2iζ_g ω_g ω) of Kanai and Tajimi.

    H. Tajimi, Proc. 2nd World Conf. Earthquake Eng. (1960) 781-797.

    Attributes
    ----------
    omega : ω_g, circular frequency of the soil in rad/s, positive
    zeta : ζ_g, its damping ratio, positive
    """

    omega: float
    zeta: float

    def __post_init__(self) -> None:
        """Check both numbers."""
        positive("omega", self.omega, "rad/s")
        positive("zeta", self.zeta, "damping ratio of the filter")


@dataclass(frozen=True)
class FirstPassage:
    """A linear structure at rest, its Gaussian load, and the times at which it is looked at.

    The responses are displacements at the outputs of `system`, of its modes alone: white noise
    has no quasi-static response, so `system.static` is not used. Responses with barriers of their
    own are brought to a common one by scaling the rows of the system's `output`.

    Attributes
    ----------
    system : the structure, with n_inputs loads and n_outputs responses
    noise : the white noise at its inputs
    duration : T in s, a whole number of time steps
    time_step : δt in s, at most a quarter of the shortest period of a mode or of the filter
    filter : what the noise passes on its way to every input, or None
    modulation : q, mapping an (n,) array of times in s to (n,) factors; None for a constant 1

    Raises
    ------
    InputError
        For durations or steps that are not positive, do not fit, or are too long.
    """

    system: ModalSystem
    noise: WhiteNoise
    duration: float
    time_step: float
    filter: KanaiTajimi | None = None
    modulation: Callable[[FloatArray], FloatArray] | None = None

    def __post_init__(self) -> None:
        """Check the times against each other and against the frequencies."""
        positive("duration", self.duration, "s")
        positive("time_step", self.time_step, "s")
        if self.time_step > LARGEST_ANGLE / self.highest_omega() * (1 + ACCUMULATED):
            raise StepError(self.time_step, self.highest_omega())
        steps = self.duration / self.time_step
        if steps < 0.5 or abs(steps - round(steps)) > WHOLE:
            expected = f"a whole number of time steps of {self.time_step} s"
            found = f"{self.duration} s, which is {steps:.6g} of them"
            raise wrong("duration", expected, found)

    def highest_omega(self) -> float:
        """Return the highest circular frequency of the modes and of the filter, rad/s."""
        soil = 0.0 if self.filter is None else self.filter.omega
        return max(float(self.system.omega.max()), soil, np.finfo(float).tiny)

    def steps(self) -> int:
        """Return n, the number of time steps."""
        return round(self.duration / self.time_step)

    def modulation_factors(self) -> FloatArray:
        """Return q at the middle of each step, (n,)."""
        middle = np.asarray((np.arange(self.steps()) + 0.5) * self.time_step, dtype=np.float64)
        if self.modulation is None:
            return np.ones_like(middle)
        return real_array("modulation", self.modulation(middle), (self.steps(),), "time steps")
