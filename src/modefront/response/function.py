r"""Frequency response functions by modal superposition with a static correction.

With p(t) = e^{iωt} in the equations of `modefront.response.system`, the receptance between an
output and an input is (Ewins, *Modal Testing*, 2nd ed., eq. 2.65; the last term, for the modes
above those given, is its residual, sec. 2.9 — here exact at ω = 0)

    α(ω) = Σ_r A_r / d_r(ω) + R,    A_r = Y_r Γ_r,    d_r(ω) = ω_r² - ω² + 2iζ_r ω_r ω,
                                    R = Y_s - Σ_r A_r / ω_r².

All quantities are one form, T(ω) = (iω)^s α(ω) + D:

=====================  ==  ====  ===========================================================
quantity               s   D     for base motion, p the acceleration of the base
=====================  ==  ====  ===========================================================
receptance             0   0     relative displacement
mobility               1   0     relative velocity
accelerance            2   0     relative acceleration
absolute accelerance   2   Y_b   absolute acceleration (the transmissibility); base motion only
=====================  ==  ====  ===========================================================

T is analytic in ω, so its derivatives are exact as well; the peaks rest on them.

The slope of |T(ω)|², whose zeros are the peaks, and its accuracy.

    g = d|T|²/dω = 2 Re(T* T'),        g' = 2 (|T'|² + Re(T* T'')),

with T of `modefront.response.function`. What rounding leaves uncertain of g is bounded by the
same sums with every term taken by its absolute value, and by g' times the spacing of floats at ω.
"""

from dataclasses import dataclass
from enum import Enum

import numpy as np
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
