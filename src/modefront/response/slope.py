"""The slope of |T(ω)|², whose zeros are the peaks, and its accuracy.

    g = d|T|²/dω = 2 Re(T* T'),        g' = 2 (|T'|² + Re(T* T'')),

with T of `modefront.response.function`. What rounding leaves uncertain of g is bounded by the
same sums with every term taken by its absolute value, and by g' times the spacing of floats at ω.
"""

from dataclasses import dataclass

import numpy as np

from modefront.response.checks import FloatArray
from modefront.response.function import ResponseQuantity, derivatives
from modefront.response.system import ModalSystem


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
