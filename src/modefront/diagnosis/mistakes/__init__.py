"""The mistakes that are looked for; a new one is one more function in this list."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from modefront.diagnosis.mistakes.record import Mistake, Setting
from modefront.diagnosis.mistakes.sensors import (
    counted_from_one,
    exchanged_sensors,
    reversed_sensor,
    wrong_direction,
    wrong_place,
)
from modefront.diagnosis.mistakes.sets import (
    foreign_mode,
    odd_frequency,
    odd_shape,
    other_numbers,
    set_factor,
)
from modefront.diagnosis.mistakes.values import (
    damping_in_percent,
    excluding_bound,
    frequency_factor,
    other_quantity,
    wrong_nominal_value,
)

MISTAKES: Sequence[Callable[[Setting], Iterator[Mistake]]] = (
    *(frequency_factor, other_quantity, set_factor, other_numbers, reversed_sensor),
    *(exchanged_sensors, counted_from_one, wrong_direction, wrong_place, wrong_nominal_value),
    *(excluding_bound, odd_frequency, odd_shape, damping_in_percent, foreign_mode),
)
"""All of them; where two explain the data equally well, the first one is tried first."""
