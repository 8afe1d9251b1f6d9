"""Measured modal data of one or several data sets."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from modefront._typing import Floats, Ints
from modefront.errors import Fault, refuse, suggestion, wrong
from modefront.text import Shown

MEASURED = ("frequency", "damping", "shape", "frequency_std", "shape_std", "shape_covariance")
"""Arrays of modal data, of which data sets are the first axis."""

SAME, ROUNDED, LEAST = 0.05, 1e-5, 1e-8
"""Relative difference of standard deviations, and difference of covariances over these, up to which
they are one, rounded; eigenvalue of correlations that is more than the rounding of nine digits."""

Pairs = tuple[tuple[int, int], ...]  # numbers of modes of one frequency, two by two


@dataclass(frozen=True, repr=False)
class ModalData(Shown):
    """Frequencies, damping ratios and mode shapes; NaN is what was not measured.

    Attributes
    ----------
    sets : names of the data sets
    modes : numbers of the measured modes, ascending
    sensors : names of the sensors
    frequency : (sets, modes) natural frequencies in Hz
    damping : (sets, modes) damping ratios
    shape : (sets, modes, sensors) mode shape components, in any scale and with any sign
    frequency_std, shape_std : standard deviations, of the shape of ``frequency`` and ``shape``
    pairs : numbers of modes of one frequency, whose shapes are some basis of a plane
    shape_covariance : (sets, modes, sensors, sensors) of the components of each shape, in any
        normalisation; NaN, or None as a whole, where only ``shape_std`` is known
    """

    sets: tuple[str, ...]
    modes: tuple[int, ...]
    sensors: tuple[str, ...]
    frequency: Floats
    damping: Floats
    shape: Floats
    frequency_std: Floats
    shape_std: Floats
    pairs: Pairs = ()
    shape_covariance: Floats | None = None

    @cached_property
    def mean_frequency(self) -> Floats:
        """Mean of the measured frequencies of each mode in Hz, shape (modes,); NaN where none."""
        return _mean(self.frequency)

    @cached_property
    def mean_damping(self) -> Floats:
        """Mean of the measured damping ratios of each mode, shape (modes,); NaN where none."""
        return _mean(self.damping)

    def at(self, sensors: tuple[str, ...]) -> "ModalData":
        """Return the data at all of these sensors: what is not among the present ones is NaN.

        Raises ValueError where a present sensor is not among them.
        """
        if sensors == self.sensors:
            return self
        for name in self.sensors:
            if name not in sensors:
                known = f"expected data at sensors of the model ({', '.join(sensors)})"
                raise ValueError(f"{known}, found {suggestion(name, sensors)}")
        if len(set(self.sensors)) < len(self.sensors):
            raise ValueError(f"expected data at each sensor once, found {', '.join(self.sensors)}")
        places = [self.sensors.index(name) if name in self.sensors else -1 for name in sensors]
        more = [(0, 0), (0, 0), (0, 1)]  # a sensor that measured nothing, at the end
        padded = (np.pad(x, more, constant_values=np.nan) for x in (self.shape, self.shape_std))
        (phi, phi_std), C = (x[..., places] for x in padded), self.shape_covariance
        if C is not None:
            C = np.pad(C, [*more, (0, 1)], constant_values=np.nan)[..., places, :][..., places]
        return replace(self, sensors=sensors, shape=phi, shape_std=phi_std, shape_covariance=C)

    def of_sets(self, chosen: Ints, names: tuple[str, ...]) -> "ModalData":
        """Return the data of some sets, by their positions, under new names."""
        parts = {name: x[chosen] for name in MEASURED if (x := getattr(self, name)) is not None}
        return replace(self, sets=names, **parts)

    def with_covariance(self, covariance: Floats) -> "ModalData":
        """Return the data with covariances of shapes, NaN where none is known.

        They are (sets, modes, sensors, sensors), and give the standard deviations that the data
        lack. Raises InputError for what is no covariance of these shapes.
        """
        C = _like("shape_covariance", covariance, (*self.shape.shape, len(self.sensors)))
        variance = np.einsum("krss->krs", C)
        known = (self.shape_std > 0) | np.isnan(variance)
        std = np.where(known, self.shape_std, np.sqrt(np.maximum(variance, 0.0)))
        out = replace(self, shape_std=std, shape_covariance=C)
        refuse(
            Fault("", f"covariance of mode {self.modes[r]} in set {self.sets[k]!r}", *said)
            for k, r in np.argwhere(np.isfinite(C).any(axis=(2, 3))).tolist()
            if (said := out.covariance_fault(k, r))
        )
        return out

    def covariance_fault(self, k: int, r: int) -> tuple[str, str] | None:
        """Return what is wrong with the covariance of a shape: the expected and the found."""
        sensors = np.flatnonzero(np.isfinite(self.shape[k, r]))
        names, std = [self.sensors[i] for i in sensors], self.shape_std[k, r, sensors]
        assert self.shape_covariance is not None, "no covariance is known"
        C = self.shape_covariance[k, r][np.ix_(sensors, sensors)]
        for i, j in np.argwhere(~np.isfinite(C)).tolist():
            return "the covariances of all measured components", f"none of {names[i]}, {names[j]}"
        for i, j in np.argwhere(np.abs(C - C.T) > ROUNDED * np.outer(std, std)).tolist():
            two = f"one covariance of {names[i]} and {names[j]}, a symmetric matrix"
            return two, f"{C[i, j]:.9g} and {C[j, i]:.9g}"
        for (i,) in np.argwhere(np.abs(C.diagonal() - std**2) > 2 * SAME * std**2).tolist():
            known = f"{std[i] ** 2:.6g}, the square of its deviation," if std[i] else "0 or more"
            return f"{known} as the variance of {names[i]}", f"{C[i, i]:.6g}"
        A = self.covariance_of(k, r, sensors)
        if A is None:
            return None
        size = np.sqrt(np.maximum(A.diagonal(), np.finfo(float).tiny))
        least = float(np.linalg.eigvalsh(A / np.outer(size, size))[0])
        expected = "positive eigenvalues of the correlations, but for that along the shape"
        return None if least > LEAST else (expected, f"{least:.2g}")

    def covariance_of(self, k: int, r: int, sensors: Ints) -> Floats | None:
        """Return the covariance of components of a shape, positive definite; None for none.

        Errors along the shape are those of its factor, which is fitted: they change no result, and
        a norm leaves them out. They get the median variance; so do those along the other of a pair.
        Where a shape has no other direction, nothing is known.
        """
        if self.shape_covariance is None:
            return None
        C = self.shape_covariance[k, r][np.ix_(sensors, sensors)]
        if not (np.isfinite(C).all() and C.any()):
            return None
        mode = self.modes[r]
        same = [r, *(self.modes.index(a + b - mode) for a, b in self.pairs if mode in (a, b))]
        U = np.nan_to_num(self.shape[k, same][:, sensors])
        U = U / np.maximum(np.linalg.norm(U, axis=1), np.finfo(float).tiny)[:, None]
        return np.asarray((C + C.T) / 2 + np.median(C.diagonal()) * U.T @ U)

    @cached_property
    def measured_shapes(self) -> tuple[Floats, Floats, Floats, Floats]:
        """Arrays for sums over what was measured.

        Shapes with 0 where nothing was measured, and 1 where something was, (sets, modes, sensors);
        sums of squares (sets, modes, 1); data sets with the shape of each mode (modes, 1), or NaN.
        """
        measured = np.isfinite(self.shape)
        shape = np.where(measured, self.shape, 0.0)
        sets = measured.any(axis=2).sum(axis=0)[:, None]
        squares = (shape**2).sum(axis=2)[:, :, None]
        return shape, measured.astype(float), squares, np.where(sets > 0, sets, np.nan)


def _mean(values: Floats) -> Floats:
    count = np.isfinite(values).sum(axis=0)
    return np.where(count > 0, np.nansum(values, axis=0) / np.maximum(count, 1), np.nan)


def _like(name: str, value: Floats | None, shape: tuple[int, ...]) -> Floats:
    """Return an array of a shape, of which one set may lack the first axis; NaN for None."""
    if value is None:
        return np.full(shape, np.nan)
    if np.iscomplexobj(value):
        raise wrong(name, "real numbers: turn shapes to be as real as they can be", "complex ones")
    array = np.asarray(value, float)
    if array.shape not in (shape, shape[shape[0] == 1 :]):
        of = list(zip(shape, ("sets", "modes", "sensors", "sensors"), strict=False))
        expected = " x ".join(f"{count} {axis}" for count, axis in of[shape[0] == 1 :])
        raise wrong(name, expected, " x ".join(map(str, array.shape)))
    return array.reshape(shape)


# 8 arguments: the parts of modal data, the optional ones by keyword.
def modal_data(
    frequency: Floats,
    shape: Floats,
    sensors: tuple[str, ...],
    *,
    sets: tuple[str, ...] | None = None,
    damping: Floats | None = None,
    frequency_std: Floats | None = None,
    shape_std: Floats | None = None,
    shape_covariance: Floats | None = None,
) -> ModalData:
    """Return the data of modes 1, 2, ... from arrays, in which NaN is not measured.

    Parameters
    ----------
    frequency
        Natural frequencies in Hz, (modes,), or (sets, modes) for several data sets.
    shape
        Mode shapes at the sensors, (modes, sensors) or (sets, modes, sensors), in any scale and
        with any sign.
    sensors
        Names of the sensors, of which the model may have others too.
    sets
        Names of the data sets; ``"1"``, ``"2"`` and so on unless given.
    damping
        Damping ratios, like ``frequency``; not measured unless given.
    frequency_std, shape_std
        Standard deviations, like ``frequency`` and ``shape``; not known unless given.
    shape_covariance
        Covariances of each shape, (modes, sensors, sensors) or (sets, modes, sensors, sensors).

    Raises
    ------
    InputError
        If the arrays do not fit together, are complex, or have a frequency that is not above 0 or
        a shape of zeros, and for what is no covariance.
    """
    f = np.atleast_2d(np.asarray(frequency, float))
    phi = _like("shape", shape, (*f.shape, len(sensors)))
    zeta = _like("damping", damping, f.shape)
    f_std = _like("frequency_std", frequency_std, f.shape)
    phi_std = _like("shape_std", shape_std, phi.shape)
    names = sets if sets is not None else tuple(str(k + 1) for k in range(len(f)))
    silent = np.isfinite(phi).any(axis=2) & ~np.nan_to_num(phi).any(axis=2)
    checks = (
        ("frequency", f <= 0, "a frequency above 0 Hz", "0 or less"),
        ("shape", silent, "a mode shape that is not zero at all sensors", "only zeros"),
    )
    count = [Fault("", "sets", f"{len(f)} names", str(len(names)))] * (len(names) != len(f))
    of_modes = (
        Fault("", f"{key} of mode {r + 1} in set {k + 1}", *said)
        for key, mask, *said in checks
        for k, r in np.argwhere(mask).tolist()
    )
    refuse([*count, *of_modes])
    modes = tuple(range(1, f.shape[1] + 1))
    data = ModalData(names, modes, tuple(sensors), f, zeta, phi, f_std, phi_std)
    return data if shape_covariance is None else data.with_covariance(shape_covariance)
