"""Measured modal data of one or several data sets."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from modefront._typing import Floats
from modefront.errors import suggestion
from modefront.text import brief

MEASURED = ("frequency", "damping", "shape", "frequency_std", "shape_std")
"""Arrays of modal data, of which data sets are the first axis."""


Pairs = tuple[tuple[int, int], ...]
"""Numbers of modes of one frequency, two by two."""


@dataclass(frozen=True, eq=False)
class MeasuredShapes:
    """Shapes with zeros where nothing was measured.

    Attributes
    ----------
    measured : (sets, modes, sensors) 1 for components that were measured, or 0
    shape : (sets, modes, sensors) components, or 0
    squares : (sets, modes, 1) sum of their squares
    sets : (modes, 1) number of data sets with the shape of each mode; NaN where there is none
    """

    measured: Floats
    shape: Floats
    squares: Floats
    sets: Floats

    @cached_property
    def complete(self) -> bool:
        """Whether every mode has a shape in some data set."""
        return bool(np.isfinite(self.sets).all())


@dataclass(frozen=True, repr=False)
class ModalData:
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

    __repr__ = brief

    @cached_property
    def mean_frequency(self) -> Floats:
        """Mean of the measured frequencies of each mode in Hz, shape (modes,); NaN where none."""
        return _mean(self.frequency)

    @cached_property
    def mean_damping(self) -> Floats:
        """Mean of the measured damping ratios of each mode, shape (modes,); NaN where none."""
        return _mean(self.damping)

    def at(self, sensors: tuple[str, ...]) -> ModalData:
        """Return the data at all of these sensors: what is not among the present ones is NaN.

        Raises ValueError where a present sensor is not among them.
        """
        if sensors == self.sensors:
            return self
        for name in self.sensors:
            if name not in sensors:
                known = f"expected data at sensors of the model ({', '.join(sensors)})"
                raise ValueError(f"{known}, found {suggestion(name, sensors)}")
        places = [sensors.index(name) for name in self.sensors]
        if len(set(places)) < len(places):
            raise ValueError(f"expected data at each sensor once, found {', '.join(self.sensors)}")
        phi, phi_std = np.full((2, *self.shape.shape[:2], len(sensors)), np.nan)
        phi[:, :, places], phi_std[:, :, places] = self.shape, self.shape_std
        return replace(self, sensors=sensors, shape=phi, shape_std=phi_std)

    @cached_property
    def measured_shapes(self) -> MeasuredShapes:
        """The shapes with zeros where nothing was measured."""
        measured = np.isfinite(self.shape)
        shape = np.where(measured, self.shape, 0.0)
        squares = (shape**2).sum(axis=2)[:, :, None]
        sets = measured.any(axis=2).sum(axis=0)[:, None]
        return MeasuredShapes(
            measured.astype(float), shape, squares, np.where(sets > 0, sets, np.nan)
        )


def _mean(values: Floats) -> Floats:
    count = np.isfinite(values).sum(axis=0)
    return np.where(count > 0, np.nansum(values, axis=0) / np.maximum(count, 1), np.nan)


# 7 arguments: the parts of modal data, the optional ones by keyword.
def modal_data(
    frequency: Floats,
    shape: Floats,
    sensors: tuple[str, ...],
    *,
    sets: tuple[str, ...] | None = None,
    damping: Floats | None = None,
    frequency_std: Floats | None = None,
    shape_std: Floats | None = None,
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

    Raises
    ------
    ValueError
        If the arrays do not fit together.
    """
    f = np.atleast_2d(np.asarray(frequency, float))
    phi = np.asarray(shape, float).reshape(*f.shape, -1)
    if phi.shape[2] != len(sensors):
        raise ValueError(f"expected shapes at {len(sensors)} sensors, found {phi.shape[2]}")

    def like(value: Floats | None, reference: Floats) -> Floats:
        if value is None:
            return np.full(reference.shape, np.nan)
        return np.asarray(value, float).reshape(reference.shape)

    names = sets if sets is not None else tuple(str(k + 1) for k in range(len(f)))
    modes, stds = tuple(range(1, f.shape[1] + 1)), (like(frequency_std, f), like(shape_std, phi))
    return ModalData(names, modes, tuple(sensors), f, like(damping, f), phi, *stds)
