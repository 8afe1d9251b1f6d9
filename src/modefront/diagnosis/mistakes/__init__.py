"""The mistakes that are looked for; a new one is one more function in this list."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from modefront.diagnosis.mistakes import sensors, sets, values
from modefront.diagnosis.mistakes.record import Mistake, Setting

MISTAKES: Sequence[Callable[[Setting], Iterator[Mistake]]] = (
    values.frequency_factor,
    values.other_quantity,
    sets.set_factor,
    sets.other_numbers,
    sensors.reversed_sensor,
    sensors.exchanged_sensors,
    sensors.copied_sensor,
    sensors.wrong_factor,
    sensors.shifted_values,
    sensors.counted_from_one,
    sensors.wrong_direction,
    sensors.wrong_place,
    values.wrong_nominal_value,
    values.excluding_bound,
    sets.odd_frequency,
    sets.odd_shape,
    values.wrong_frequency,
    values.damping_in_percent,
    sets.foreign_mode,
    sets.later_mode,
)
"""All of them; where two explain the data equally well, the first one is tried first."""
