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

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from modefront.errors import wrong

FloatArray = NDArray[np.float64]


def real_array(
    name: str, value: ArrayLike, shape: Sequence[int | None], meaning: str
) -> FloatArray:
    """Return `value` as a read-only array of finite floats of the given shape.

    `shape` has one entry a dimension, None where any size of at least one is right; `meaning`
    says in words what the dimensions are.
    """
    array = np.array(value, dtype=np.float64)
    fits = array.ndim == len(shape) and all(
        size == required or (required is None and size > 0)
        for size, required in zip(array.shape, shape, strict=True)
    )
    if not fits:
        sizes = ", ".join("n" if size is None else str(size) for size in shape)
        raise wrong(name, f"shape ({sizes}) ({meaning})", array.shape)
    if not np.all(np.isfinite(array)):
        index = tuple(int(i) for i in np.argwhere(~np.isfinite(array))[0])
        raise wrong(name, "finite numbers", f"{array[index]} at index {index}")
    array.setflags(write=False)
    return array


def positive(name: str, value: float, unit: str) -> float:
    """Return `value` if it is a finite number above zero."""
    if not (np.isfinite(value) and value > 0):
        raise wrong(name, f"a positive number ({unit})", value)
    return float(value)


def positive_count(name: str, value: int) -> int:
    """Return `value` if it is a whole number above zero."""
    if not (np.isfinite(value) and value >= 1 and int(value) == value):
        raise wrong(name, "a whole number of at least 1", value)
    return int(value)


def no_negative(name: str, array: FloatArray, meaning: str) -> FloatArray:
    """Return `array` if none of its elements is below zero."""
    if np.any(array < 0):
        index = tuple(int(i) for i in np.argwhere(array < 0)[0])
        raise wrong(name, f"no negative {meaning}", f"{array[index]} at index {index}")
    return array


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

    Raises
    ------
    InputError
        For wrong shapes, numbers that are not finite, negative frequencies or damping.
    """

    omega: FloatArray
    zeta: FloatArray
    input: FloatArray
    output: FloatArray
    static: FloatArray | None = None
    rigid: FloatArray | None = None

    def __post_init__(self) -> None:
        """Check the arrays against one another and keep read-only copies."""
        omega = real_array("omega", self.omega, (None,), "modes")
        m = omega.size
        zeta = real_array("zeta", self.zeta, (m,), "modes")
        load = real_array("input", self.input, (m, None), "modes, inputs")
        output = real_array("output", self.output, (None, m), "outputs, modes")
        no_negative("omega", omega, "frequency")
        no_negative("zeta", zeta, "damping ratio")
        pair = (output.shape[0], load.shape[1])
        for name, value in (("static", self.static), ("rigid", self.rigid)):
            if value is not None:
                checked = real_array(name, value, pair, "outputs, inputs")
                object.__setattr__(self, name, checked)
        if self.static is not None and np.any(omega == 0):
            first = int(np.argmax(omega == 0))
            expected = "None, as a structure with a rigid-body mode has no static response"
            raise wrong("static", expected, f"an array with omega[{first}] = 0")
        object.__setattr__(self, "omega", omega)
        object.__setattr__(self, "zeta", zeta)
        object.__setattr__(self, "input", load)
        object.__setattr__(self, "output", output)

    def residual_flexibility(self) -> FloatArray:
        """Return static - Σ_r Y_r Γ_r / ω_r², (n_outputs, n_inputs); zero without `static`."""
        if self.static is None:
            return np.zeros((self.output.shape[0], self.input.shape[1]))
        retained: FloatArray = (self.output / self.omega**2) @ self.input
        return self.static - retained
