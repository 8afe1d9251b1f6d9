"""The peaks of |T(ω)|: all of them in a band, and not on a grid.

A peak is a zero of

    g(ω) = d|T|²/dω = 2 Re(T* T'),   where   g'(ω) = 2 (|T'|² + Re(T* T'')) < 0.

g is analytic on the real axis (its nearest poles are those of the modes, ζ_r ω_r away), so on a
short enough interval it *is*, to rounding, a Chebyshev series of low degree, all of whose zeros
are eigenvalues of its colleague matrix (J. P. Boyd, SIAM J. Numer. Anal. 40 (2002) 1666-1682,
doi:10.1137/S0036142901398325). The band is halved until the series' last coefficients vanish;
how fine that is follows from the modes, not from a grid, and neither close modes, which may have
one peak or two, nor a peak beside an antiresonance, need be told apart beforehand. Newton's
method with the exact g, g' then brings each zero to rounding.

======  ==========================================================
symbol  meaning
======  ==========================================================
T       frequency response, `modefront.response.function`
g       slope of |T|² over ω
x       place in an interval of the band, -1 to 1
======  ==========================================================
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.polynomial import chebyshev

from modefront.errors import wrong
from modefront.response.function import ResponseQuantity, Slope, derivatives
from modefront.response.system import FloatArray, ModalSystem

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
    return ModalSystem(
        omega=system.omega,
        zeta=system.zeta,
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
