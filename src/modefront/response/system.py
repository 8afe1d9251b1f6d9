"""A linear structure in modal coordinates, of mass-normalised mode shapes and classical damping.

The modal equations are in docs/methods/first-passage.md.

==========  =================================================  ===========
symbol      meaning                                            field
==========  =================================================  ===========
ω_r         natural circular frequency, rad/s                  ``omega``
ζ_r         damping ratio                                      ``zeta``
Γ           φᵀf for a force pattern f;  -φᵀM r for the         ``input``
            acceleration of the base, r its rigid-body motion
Y           mode shapes at the outputs: a sensor, or any       ``output``
            weighted sum of DOFs, such as a story drift
Y_s         full static response, output · K⁻¹ · load,         ``static``
            load = f or -M r
Y_b         motion of the outputs with the base, output · r    ``rigid``
==========  =================================================  ===========
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from modefront.errors import wrong

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class ModalSystem:
    """A linear structure by its modes, between m modes, n_inputs loads and n_outputs responses.

    Attributes
    ----------
    omega : (m,) natural circular frequencies in rad/s; zero for a rigid-body mode
    zeta : (m,) damping ratios, none negative
    input : (m, n_inputs) modal loads: φᵀf for forces, -φᵀM r for base acceleration
    output : (n_outputs, m) mode shapes at the outputs
    static : (n_outputs, n_inputs) full static response to the loads, or None where the modes are
        all there is: its excess over the static response of the modes given is the correction for
        those cut off. With rigid-body modes there is no static response.
    rigid : (n_outputs, n_inputs) displacement of the outputs for a unit displacement of the base,
        or None where the load is a force; needed for absolute acceleration only

    Raises InputError for a static response of a structure with a rigid-body mode.
    """

    omega: FloatArray
    zeta: FloatArray
    input: FloatArray
    output: FloatArray
    static: FloatArray | None = None
    rigid: FloatArray | None = None

    def __post_init__(self) -> None:
        if self.static is not None and np.any(self.omega == 0):
            first = int(np.argmax(self.omega == 0))
            expected = "None, as a structure with a rigid-body mode has no static response"
            raise wrong("static", expected, f"an array with omega[{first}] = 0")

    def residual_flexibility(self) -> FloatArray:
        """Return static - Σ_r Y_r Γ_r / ω_r², (n_outputs, n_inputs); zero without `static`."""
        if self.static is None:
            return np.zeros((self.output.shape[0], self.input.shape[1]))
        retained: FloatArray = (self.output / self.omega**2) @ self.input
        return self.static - retained
