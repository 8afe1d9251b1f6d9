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
from itertools import pairwise

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from modefront.errors import wrong
from modefront.response.system import FloatArray, ModalSystem

ComplexArray = NDArray[np.complex128]


ORDERS = {"receptance": 0, "mobility": 1, "accelerance": 2, "absolute accelerance": 2}
"""The power s of iω, by the response that is set against the load."""


def derivatives(
    system: ModalSystem, omega: ComplexArray, quantity: str
) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
    """Return T, dT/dω and d²T/dω², each (n, n_outputs, n_inputs), at (n,) frequencies.

    These are in rad/s, and the response in units of output per unit load. Raises InputError at the
    frequency of an undamped mode.
    """
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
    s, w = ORDERS[quantity], omega[:, None, None]
    power = (1j) ** s * w**s
    power1 = (1j) ** s * s * w ** max(s - 1, 0)
    power2 = (1j) ** s * s * (s - 1)
    response = power * alpha
    if quantity == "absolute accelerance":
        assert system.rigid is not None, "the load is no motion of the base"
        response = response + system.rigid
    first = power1 * alpha + power * alpha1
    second = power2 * alpha + 2 * power1 * alpha1 + power * alpha2
    return response, first, second


@dataclass(frozen=True, eq=False)
class Slope:
    """g between the one output and the one input of `pair`, and the error by rounding."""

    pair: ModalSystem
    quantity: str

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
        s = ORDERS[self.quantity]
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


def peaks(
    system: ModalSystem, quantity: str, output: int, band: tuple[float, float]
) -> tuple[FloatArray, FloatArray]:
    """Return where |T| has its local maxima, by rising frequency, and |T| there.

    Parameters
    ----------
    system : the structure, with one input; every mode in the band damped and above 0 Hz
    quantity : what is set against the load, one of `ORDERS`
    output : which response, counted from 0
    band : lowest and highest circular frequency, rad/s. The ends are no peaks, however large |T| is
        there.

    Raises InputError for undamped modes in the band, as their peaks are infinite.
    """
    one, (low, high) = slice(output, output + 1), band
    pair = replace(
        system,
        output=system.output[one],
        static=None if system.static is None else system.static[one],
        rigid=None if system.rigid is None else system.rigid[one],
    )
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
    return at_peak, np.abs(values)


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
