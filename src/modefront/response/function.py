"""Frequency response functions by modal superposition with a static correction.

docs/methods/first-passage.md has the receptance (Ewins, *Modal Testing*, 2nd ed., eq. 2.65),

    α(ω) = Σ_r A_r / d_r(ω) + R,    A_r = Y_r Γ_r,    d_r(ω) = ω_r² - ω² + 2iζ_r ω_r ω,
                                    R = Y_s - Σ_r A_r / ω_r².

All quantities are T(ω) = (iω)^s α(ω) + D: receptance, mobility and accelerance have s = 0, 1, 2 and
D = 0; of base motion, the absolute accelerance has s = 2 and D = Y_b.

T is analytic in ω, so its derivatives are exact as well. The peaks of |T(ω)| are the zeros of

    g(ω) = d|T|²/dω = 2 Re(T* T'),   where   g'(ω) = 2 (|T'|² + Re(T* T'')) < 0,

eigenvalues of the colleague matrices of Chebyshev series (J. P. Boyd, SIAM J. Numer. Anal. 40
(2002) 1666-1682, doi:10.1137/S0036142901398325): the band is halved until the last coefficients
vanish. Newton's method brings each to rounding, which is bounded by the same sums with every term
taken by its absolute value.
"""

from dataclasses import dataclass, replace
from enum import Enum
from itertools import pairwise

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import ArrayLike, NDArray

from modefront.errors import wrong
from modefront.response.system import FloatArray, ModalSystem, no_negative, real_array

ComplexArray = NDArray[np.complex128]


class ResponseQuantity(Enum):
    """The response that is set against the load."""

    RECEPTANCE = "receptance"
    MOBILITY = "mobility"
    ACCELERANCE = "accelerance"
    ABSOLUTE_ACCELERANCE = "absolute accelerance"

    @property
    def order(self) -> int:
        """The power s of iω: number of differentiations of the displacement in time."""
        return {"receptance": 0, "mobility": 1}.get(self.value, 2)


def frequency_response(
    system: ModalSystem, omega: ArrayLike, quantity: ResponseQuantity = ResponseQuantity.RECEPTANCE
) -> ComplexArray:
    """Return T(ω) at the circular frequencies `omega`.

    Parameters
    ----------
    system : the structure, with m modes, n_inputs loads and n_outputs responses
    omega : (n,) circular frequencies in rad/s, none negative
    quantity : what is set against the load

    Returns
    -------
    (n, n_outputs, n_inputs) complex response, in units of output per unit load.

    Raises
    ------
    InputError
        For frequencies that are negative, or meet an undamped mode; for absolute acceleration of
        a system that does not say how its outputs move with the base.
    """
    lines = no_negative("omega", real_array("omega", omega, (None,), "frequencies"), "frequency")
    return derivatives(system, lines.astype(np.complex128), quantity)[0]


def derivatives(
    system: ModalSystem, omega: ComplexArray, quantity: ResponseQuantity
) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
    """Return T, dT/dω and d²T/dω², each (n, n_outputs, n_inputs), at (n,) frequencies."""
    w = omega[:, None]
    # ω_r² - ω² as a product: exact to rounding next to the mode, where the difference is small.
    d = (system.omega - w) * (system.omega + w) + 2j * system.zeta * system.omega * w
    if np.any(d == 0):
        line, mode = (int(i) for i in np.argwhere(d == 0)[0])
        expected = "no frequency on that of an undamped mode, where the response is unbounded"
        found = f"{omega[line].real} rad/s with zeta[{mode}] = {system.zeta[mode]}"
        raise wrong("omega", expected, found)
    d1 = -2 * w + 2j * system.zeta * system.omega
    modal = (1 / d, -d1 / d**2, 2 * d1**2 / d**3 + 2 / d**2)
    alpha, alpha1, alpha2 = (
        np.einsum("or,nr,ri->noi", system.output, term, system.input) for term in modal
    )
    alpha = alpha + system.residual_flexibility()

    # Leibniz' rule on (iω)^s α.
    s, w = quantity.order, omega[:, None, None]
    power = (1j) ** s * w**s
    power1 = (1j) ** s * s * w ** max(s - 1, 0)
    power2 = (1j) ** s * s * (s - 1)
    response = power * alpha + _rigid(system, quantity)
    first = power1 * alpha + power * alpha1
    second = power2 * alpha + 2 * power1 * alpha1 + power * alpha2
    return response, first, second


def _rigid(system: ModalSystem, quantity: ResponseQuantity) -> NDArray[np.float64] | float:
    if quantity is not ResponseQuantity.ABSOLUTE_ACCELERANCE:
        return 0.0
    if system.rigid is None:
        expected = "the motion of the outputs with the base for absolute accelerance"
        raise wrong("rigid", expected, None)
    return system.rigid


@dataclass(frozen=True, eq=False)
class Slope:
    """g between the one output and the one input of `pair`, and the error by rounding."""

    pair: ModalSystem
    quantity: ResponseQuantity

    def both(self, omega: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return g and g'."""
        s = omega.astype(np.complex128)
        t, t1, t2 = (value[:, 0, 0] for value in derivatives(self.pair, s, self.quantity))
        return 2 * (t.conj() * t1).real, 2 * (abs(t1) ** 2 + (t.conj() * t2).real)

    def rounding(self, omega: FloatArray, g1: FloatArray) -> FloatArray:
        """Return the bound of the error of g by rounding of the terms of T and of ω.

        Modes that cancel leave a small T that is no more accurate than they are.
        """
        pair = self.pair
        load = np.concatenate([abs(pair.input), abs(pair.residual_flexibility())])[:, 0]
        shape = np.append(abs(pair.output[0]), 1.0)
        w = omega[:, None]
        d = (pair.omega - w) * (pair.omega + w) + 2j * pair.zeta * pair.omega * w
        inverse = np.hstack([1 / abs(d), np.ones_like(w)])
        inverse1 = np.hstack([2 * (w + pair.zeta * pair.omega) / abs(d) ** 2, np.zeros_like(w)])
        alpha, alpha1 = inverse @ (shape * load), inverse1 @ (shape * load)
        s = self.quantity.order
        rigid = 0.0 if pair.rigid is None else abs(pair.rigid[0, 0])
        t = omega**s * alpha + rigid
        t1 = omega**s * alpha1 + s * omega ** max(s - 1, 0) * alpha
        size: FloatArray = 8 * np.finfo(float).eps * (t * t1 + omega * abs(g1))
        return size


DEGREE = 24
"""Degree of the series; twice as many intervals with half of it cost about the same."""

RESOLVED = 1e-12
"""The series is done when its last coefficients are below this, relative to its largest."""

TOUCH = 1e-6
"""Distance of a root from the interval, over its half length, up to which it may be a zero in it:
the root of `RESOLVED`, by which rounding parts a double zero."""

SETTLED = 1e-8
"""Relative length of the last step of Newton's method at a zero; elsewhere steps stay long."""

TWICE = 1e-10
"""Relative distance of two zeros up to which they are the same, found twice."""

NEWTON_STEPS = 6
"""From the accuracy of the series, two or three do; more than enough even for merging peaks."""


@dataclass(frozen=True)
class Peak:
    """A local maximum of |T|.

    Attributes
    ----------
    omega : where it is, rad/s
    amplitude : |T| there, in units of output per unit load
    phase : arg T there, rad
    """

    omega: float
    amplitude: float
    phase: float

    @property
    def frequency(self) -> float:
        """Frequency of the peak in Hz."""
        return self.omega / (2 * np.pi)


def peaks(
    system: ModalSystem,
    quantity: ResponseQuantity = ResponseQuantity.RECEPTANCE,
    *,
    output: int = 0,
    input: int = 0,
    band: tuple[float, float] | None = None,
) -> tuple[Peak, ...]:
    """Return all local maxima of |T| between one output and one input, by rising frequency.

    Parameters
    ----------
    system : the structure; every mode in the band damped and above 0 Hz
    quantity : what is set against the load
    output, input : which response and which load, counted from 0
    band : lowest and highest circular frequency, rad/s; None for 0 to twice the highest mode's. The
        ends are no peaks, however large |T| is there.

    Raises
    ------
    InputError
        For undamped modes in the band (their peaks are infinite), an unknown output or input, an
        empty band.
    """
    pair = _pair(system, output, input)
    low, high = (0.0, 2 * float(pair.omega.max())) if band is None else band
    if not (0 <= low < high < np.inf):
        raise wrong("band", "0 <= lowest < highest (rad/s)", (low, high))
    infinite = (pair.zeta * pair.omega == 0) & (pair.omega >= low) & (pair.omega <= high)
    if np.any(infinite):
        mode = int(np.argmax(infinite))
        expected = "damped modes above 0 Hz in the band, as others have infinite peaks"
        undamped = f"omega[{mode}] = {pair.omega[mode]}, zeta[{mode}] = {pair.zeta[mode]}"
        raise wrong("zeta", expected, undamped)
    slope = Slope(pair, quantity)
    # The modes are natural breaks: with one at the end of an interval, its width is soon found.
    inside = pair.omega[(pair.omega > low) & (pair.omega < high)]
    breaks = np.unique(np.concatenate([[low], inside, [high]]))
    roots = np.concatenate([_zeros(slope, a, b) for a, b in pairwise(breaks.tolist())])
    zeros = _polish(slope, roots, low, high)
    at_peak = zeros[slope.both(zeros)[1] < 0]
    values = derivatives(pair, at_peak.astype(np.complex128), quantity)[0][:, 0, 0]
    return tuple(
        Peak(float(w), float(abs(t)), float(np.angle(t)))
        for w, t in zip(at_peak, values, strict=True)
    )


def _pair(system: ModalSystem, output: int, input: int) -> ModalSystem:
    """Return the part of `system` between one output and one input."""
    for name, index, size in (
        ("output", output, system.output.shape[0]),
        ("input", input, system.input.shape[1]),
    ):
        if not 0 <= index < size:
            raise wrong(name, f"a number from 0 to {size - 1}", index)
    o, i = slice(output, output + 1), slice(input, input + 1)
    return replace(
        system,
        input=system.input[:, i],
        output=system.output[o],
        static=None if system.static is None else system.static[o, i],
        rigid=None if system.rigid is None else system.rigid[o, i],
    )


def _zeros(slope: Slope, a: float, b: float) -> FloatArray:
    """Return the zeros of g in [a, b], to about the accuracy of the series."""
    middle, half = (a + b) / 2, (b - a) / 2
    x = chebyshev.chebpts1(DEGREE + 1)
    g, g1 = slope.both(middle + half * x)
    # Interpolation at the Chebyshev points of the first kind is a discrete orthogonal sum.
    series = (2 / (DEGREE + 1)) * chebyshev.chebvander(x, DEGREE).T @ g
    series[0] /= 2
    enough = max(RESOLVED * abs(g).max(), slope.rounding(middle + half * x, g1).max())
    if abs(series[-2:]).max() > enough:
        return np.concatenate([_zeros(slope, a, middle), _zeros(slope, middle, b)])
    trimmed = chebyshev.chebtrim(series, enough)
    if trimmed.size == 1:
        return np.empty(0)
    roots = chebyshev.chebroots(trimmed)
    # A touch beyond the ends: a zero on a break must not fall between two intervals.
    real = (abs(roots.imag) < TOUCH) & (abs(roots.real) < 1 + TOUCH)
    zeros: FloatArray = middle + half * roots.real[real]
    return zeros


def _polish(slope: Slope, omega: FloatArray, low: float, high: float) -> FloatArray:
    """Return the zeros of g between `low` and `high` by rising frequency, each once."""
    # A pair of complex zeros next to the axis passes for real ones until here. Newton's method
    # finds no rest there, or at another zero, which is found a second time.
    step = np.zeros_like(omega)
    for _ in range(NEWTON_STEPS):
        g, g1 = slope.both(omega)
        with np.errstate(divide="ignore", invalid="ignore"):
            moved = np.clip(omega - g / g1, low, high)
        omega, step = moved, moved - omega
    inside = (omega > low) & (omega < high) & (abs(step) < SETTLED * omega)
    omega = np.sort(omega[inside])
    return omega[np.diff(omega, prepend=-np.inf) > TWICE * omega]
