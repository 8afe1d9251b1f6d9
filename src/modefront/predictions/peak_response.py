"""The greatest peak of a frequency response function within a band.

docs/methods/first-passage.md has the receptance by modal superposition with a static correction,
α(ω) = Σ_r A_r / d_r(ω) + R with A_r = Y_r Γ_r and d_r(ω) = ω_r² - ω² + 2iζ_r ω_r ω (Ewins, *Modal
Testing*, 2nd ed., eq. 2.65). All quantities are T(ω) = (iω)^s α(ω) + D: receptance, mobility and
accelerance have s = 0, 1, 2 and D = 0; of base motion, the absolute accelerance has s = 2 and
D = Y_b. T is analytic in ω, so its derivatives are exact as well. The peaks of |T(ω)| are zeros of

    g(ω) = d|T|²/dω = 2 Re(T* T'),   where   g'(ω) = 2 (|T'|² + Re(T* T'')) < 0,

eigenvalues of the colleague matrices of Chebyshev series: the band is halved until the last
coefficients vanish. Newton's method brings each to rounding, which is bounded by the same sums with
every term taken by its absolute value.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Annotated, Any, ClassVar, Self

import numpy as np
from numpy.polynomial import chebyshev
from numpy.random import SeedSequence

from modefront import options as opt
from modefront._typing import Arrays, Complexes, Floats
from modefront.data.modal import ModalData
from modefront.errors import Fault, refuse, wrong
from modefront.models.base import Model
from modefront.predictions import system as modal
from modefront.predictions.base import PredictionKind, ResultVariable, Setting
from modefront.residuals.problem import UpdatingProblem

ORDERS = {"receptance": 0, "mobility": 1, "accelerance": 2, "absolute accelerance": 2}
"""The power s of iω, by the response that is set against the load."""


def derivatives(
    system: modal.ModalSystem, omega: Complexes, quantity: str
) -> tuple[Complexes, Complexes, Complexes]:
    """Return T, dT/dω and d²T/dω², each (n, n_outputs, n_inputs), at (n,) frequencies in rad/s.

    Raises InputError at the frequency of an undamped mode.
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
    terms = (1 / d, -d1 / d**2, 2 * d1**2 / d**3 + 2 / d**2)
    alpha, alpha1, alpha2 = (
        np.einsum("or,nr,ri->noi", system.output, term, system.input) for term in terms
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


def slope(pair: modal.ModalSystem, quantity: str, omega: Floats) -> tuple[Floats, Floats]:
    """Return g and g' between the one output and the one input of a structure."""
    s = omega.astype(np.complex128)
    t, t1, t2 = (value[:, 0, 0] for value in derivatives(pair, s, quantity))
    return 2 * (t.conj() * t1).real, 2 * (abs(t1) ** 2 + (t.conj() * t2).real)


def rounding(pair: modal.ModalSystem, quantity: str, omega: Floats, g1: Floats) -> Floats:
    """Return the bound of the error of g by rounding of ω and of T's terms, which may cancel."""
    load = np.concatenate([abs(pair.input), abs(pair.residual_flexibility())])[:, 0]
    shape = np.append(abs(pair.output[0]), 1.0)
    w = omega[:, None]
    d = (pair.omega - w) * (pair.omega + w) + 2j * pair.zeta * pair.omega * w
    inverse = np.hstack([1 / abs(d), np.ones_like(w)])
    inverse1 = np.hstack([2 * (w + pair.zeta * pair.omega) / abs(d) ** 2, np.zeros_like(w)])
    alpha, alpha1 = inverse @ (shape * load), inverse1 @ (shape * load)
    s, rigid = ORDERS[quantity], 0.0 if pair.rigid is None else abs(pair.rigid[0, 0])
    t = omega**s * alpha + rigid
    t1 = omega**s * alpha1 + s * omega ** max(s - 1, 0) * alpha
    return 8 * np.finfo(float).eps * (t * t1 + omega * abs(g1))


DEGREE = 24  # degree of the series; twice as many intervals with half of it cost about the same
NODES = chebyshev.chebpts1(DEGREE + 1)  # of the interpolation, of the first kind
SUMS = (2 / (DEGREE + 1)) * chebyshev.chebvander(NODES, DEGREE).T  # discrete orthogonal sums

RESOLVED = 1e-12  # last coefficients of a series that is done, over its largest one
SETTLED = 1e-8  # last step of Newton's method at a zero, over it; elsewhere steps stay long
TWICE = 1e-10  # relative distance of two zeros up to which they are the same, found twice

NEWTON_STEPS = 6  # two or three do; more than enough even for merging peaks


def peaks(
    system: modal.ModalSystem, quantity: str, output: int, band: tuple[float, float]
) -> tuple[Floats, Floats]:
    """Return where |T| has its local maxima, by rising frequency, and |T| there.

    The structure has one input, ``quantity`` is one of `ORDERS`, ``output`` is counted from 0, and
    the band is in rad/s; its ends are no peaks, however large |T| is there. Raises InputError for
    undamped modes in the band, as their peaks are infinite.
    """
    (low, high), one = band, slice(output, output + 1)
    whole = {name: getattr(system, name) for name in ("output", "static", "rigid")}
    parts: Any = {name: None if x is None else x[one] for name, x in whole.items()}
    pair = replace(system, **parts)
    infinite = (pair.zeta * pair.omega == 0) & (pair.omega >= low) & (pair.omega <= high)
    if np.any(infinite):
        mode = int(np.argmax(infinite))
        expected = "damped modes above 0 Hz in the band, as others have infinite peaks"
        undamped = f"omega[{mode}] = {pair.omega[mode]}, zeta[{mode}] = {pair.zeta[mode]}"
        raise wrong("zeta", expected, undamped)
    # The modes are natural breaks: with one at the end of an interval, its width is soon found.
    inside = pair.omega[(pair.omega > low) & (pair.omega < high)]
    breaks = np.unique(np.concatenate([[low], inside, [high]]))
    roots = np.concatenate([_zeros(pair, quantity, *x) for x in pairwise(breaks.tolist())])
    # A pair of complex zeros next to the axis passes for real ones until here. Newton's method
    # finds no rest there, or at another zero, which is found a second time.
    zeros, step = roots, np.zeros_like(roots)
    for _ in range(NEWTON_STEPS):
        g, g1 = slope(pair, quantity, zeros)
        with np.errstate(divide="ignore", invalid="ignore"):
            moved = np.clip(zeros - g / g1, low, high)
        zeros, step = moved, moved - zeros
    settled = (zeros > low) & (zeros < high) & (abs(step) < SETTLED * zeros)
    zeros = np.sort(zeros[settled])
    zeros = zeros[np.diff(zeros, prepend=-np.inf) > TWICE * zeros]
    at_peak = zeros[slope(pair, quantity, zeros)[1] < 0]
    values = derivatives(pair, at_peak.astype(np.complex128), quantity)[0][:, 0, 0]
    return at_peak, np.abs(values)


def _zeros(pair: modal.ModalSystem, quantity: str, a: float, b: float) -> Floats:
    """Return the zeros of g in [a, b], to about the accuracy of the series."""
    middle, half = (a + b) / 2, (b - a) / 2
    omega = middle + half * NODES
    g, g1 = slope(pair, quantity, omega)
    series = SUMS @ g
    series[0] /= 2
    enough = max(RESOLVED * abs(g).max(), rounding(pair, quantity, omega, g1).max())
    if abs(series[-2:]).max() > enough:
        halves = (a, middle), (middle, b)
        return np.concatenate([_zeros(pair, quantity, *x) for x in halves])
    trimmed = chebyshev.chebtrim(series, enough)
    if trimmed.size == 1:
        return np.empty(0)
    roots = chebyshev.chebroots(trimmed)
    # Rounding parts a double zero by the root of its size, and as far beyond the ends may be a zero
    # on a break, which must not fall between two intervals.
    touch = math.sqrt(RESOLVED)
    real = (abs(roots.imag) < touch) & (abs(roots.real) < 1 + touch)
    return middle + half * roots.real[real]


BAND = opt.numbers(
    "[lowest, highest] frequency in Hz, 0 <= lowest < highest",
    opt.array(opt.NOT_NEGATIVE, 2, 2),
    opt.rising,
)


@dataclass(frozen=True)
class PeakResponse(modal.ModalPrediction):
    """Peaks of the frequency response of several outputs to one input.

    Raises InputError for values that are not possible, alone or together.

    Attributes
    ----------
    name : name of the prediction
    response : a sensor or output, a list of them, or weighted sums of them by their names
    force : where a force acts: a sensor or output, or weights of them; this or ``base``
    base : direction in which the base accelerates
    quantity : response over load: ``"receptance"``, ``"mobility"``, ``"accelerance"`` or, with a
        base that moves, ``"absolute accelerance"``
    band : lowest and highest frequency in Hz; None for up to 1.1 times the highest measured one
    static : whether the static response of the modes left out is added
    modes : number of modes superposed; None for as many as reach 1.5 times the end of the band
    damping : a ratio, a list of ratios, one a mode, or ``"measured"``
    """

    name: modal.Name
    response: modal.Response
    force: modal.Force | None = None
    base: modal.Base | None = None
    quantity: Annotated[str, opt.one_of(*ORDERS)] = "receptance"
    band: Annotated[tuple[float, float], BAND] | None = None
    static: Annotated[bool, opt.TRUE_OR_FALSE] = True
    modes: modal.ModeCount | None = None
    damping: modal.Damping = modal.MEASURED

    kind: ClassVar = PredictionKind(
        "frf",
        "frf",
        (
            ResultVariable("frf_peak", "peak", "greatest peak of |T| in the band"),
            ResultVariable("frf_peak_frequency", "frequency", "frequency of that peak", "Hz"),
        ),
        (
            Setting("frf_quantity", "response over load", "text"),
            Setting("frf_band", "band in which peaks are sought", unit="Hz", dimensions=("bound",)),
            Setting("frf_load", "load case", "text"),
            Setting("frf_damping", "damping ratios", "text"),
            Setting("frf_modes", "modes superposed", "count"),
        ),
        absent="have no peak",
        undefined="have no such peak",
    )

    def contradictions(self) -> Iterator[Fault]:
        """Yield options that contradict one another."""
        yield from super().contradictions()
        if self.quantity == "absolute accelerance" and self.base is None:
            yield Fault("", "quantity", "another one where forces act", f"'{self.quantity}'")

    @property
    def heading(self) -> str:
        """Name, load case and options in a sentence."""
        low, high = modal.filled(self.band, "band")
        return (
            f"{self.name}: {self.load}; {self.quantity}, greatest peak from {low:g} to {high:g} "
            f"Hz, {self.modes} modes, damping {self.damped}"
        )

    def faults(self, model: Model, data: ModalData) -> Iterator[Fault]:
        """Yield the requirements that the model or the data do not meet."""
        yield from super().faults(model, data)
        if self.band is None and modal.highest_frequency(data) is None:
            yield Fault("", "band", BAND.expected, "nothing")

    def complete(self, problem: UpdatingProblem) -> Self:
        """Return the prediction with band and modes that follow from data and nominal model.

        Raises InputError with what this model cannot predict.
        """
        refuse(self.faults(problem.model, problem.data))
        highest = modal.highest_frequency(problem.data)
        low, top = self.band or (0.0, modal.ABOVE * modal.filled(highest, "band"))
        out = replace(self, band=(low, top), modes=self.complete_modes(problem, top))
        omega, faults = out.nominal(problem).omega, []
        known = np.append(omega / (2 * math.pi), problem.data.mean_frequency)
        if not ((low <= known) & (known <= top)).any():
            expected = "a band with a frequency of the nominal model, or a measured one"
            faults.append(Fault("", "band", expected, f"{low:g} to {top:g} Hz"))
        last, count = float(omega[-1]) / (2 * math.pi), omega.size
        reached = problem.model, problem.start, top, count
        more = modal.modes_reaching(*reached) if last < top else count
        if more > count:
            key = "modes" if self.modes is not None else "damping"
            expected = f"{key} of all modes up to the end of the band, {top:g} Hz: {more}"
            faults.append(Fault("", key, expected, f"{count}, up to {last:.4g} Hz"))
        if omega[0] == 0 and self.static:
            expected = "false, as a model with rigid-body modes has no static response"
            faults.append(Fault("", "static", expected, "true"))
        if omega[0] == 0 and low == 0:
            expected = "a lowest frequency above 0, as rigid-body modes have no bounds there"
            faults.append(Fault("", "band", expected, "0"))
        refuse(faults)
        return out

    def evaluate(self, problem: UpdatingProblem, theta: Floats, _: SeedSequence) -> Arrays:
        """Return the height of the greatest peak and its frequency in Hz, each (responses,).

        NaN where there is no local maximum within the band. Raises ModelError where the model
        cannot be evaluated at ``theta``.
        """
        system = self.system(problem, theta)
        low, high = (2 * np.pi * f for f in modal.filled(self.band, "band"))
        out = np.full((2, len(self.response)), np.nan)
        for o in range(len(self.response)):
            omega, height = peaks(system, self.quantity, o, (low, high))
            if height.size:
                k = int(np.argmax(height))
                out[:, o] = height[k], omega[k] / (2 * np.pi)
        return {"peak": out[0], "frequency": out[1]}

    def check(self, _problem: UpdatingProblem, _theta: Floats, _seed: SeedSequence) -> Arrays:
        """Return nothing: peaks are exact."""
        return {}
