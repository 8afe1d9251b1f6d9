r"""Residuals of natural frequencies (``docs/methods/residuals.md``).

An error of a measured frequency y changes :math:`J = (f - y)^2 / u^2` of its data set by

.. math:: \frac{\partial J}{\partial y} = -\frac{2 (f - y)}{u^2} q, \qquad
    \frac{\partial}{\partial y} \partial J = -\frac{2 \partial f}{u^2} (2 q - 1),

where q = 1 for a unit that is given, and q = f / y for the unit y, which changes with it.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from modefront._typing import Bools, Floats, Ints
from modefront.data.modal import ModalData
from modefront.modes.result import Modes
from modefront.pairing.match import Pairs
from modefront.residuals import base


@dataclass(frozen=True, eq=False)
class FrequencyResiduals:
    """Residuals of the frequencies of the measured modes at some positions of the data.

    Those of one mode are a member of a group, those of several a stack of them.
    """

    data: ModalData
    modes: Sequence[int]
    scale: base.Scale
    remark: str = ""

    @cached_property
    def rows(self) -> tuple[Ints, Ints, Floats, Floats, Floats]:
        """Of each residual data set, mode, measured frequency in Hz, unit u, and weight, (rows,).

        They come mode after mode; the weight is the factor of an error.
        """
        place, sets = np.nonzero(np.isfinite(self.data.frequency[:, self.modes].T))
        mode = np.asarray(self.modes)[place]
        measured = self.data.frequency[sets, mode]
        unit = measured if self.scale == "measured" else self.data.frequency_std[sets, mode]
        return sets, mode, measured, unit, 1 / (unit * np.sqrt(np.bincount(mode)[mode]))

    @property
    def sets(self) -> Ints:
        """Data set of each residual."""
        return self.rows[0]

    @property
    def count(self) -> float:
        """Number of frequencies."""
        return float(len(self.modes))

    def margin(self, errors: base.ModeErrors) -> float:
        """Return the square of the greatest change of r by errors of the paired modes."""
        _, _, measured, _, weight = self.rows
        size = weight * measured
        return float((errors.eigenvalue[self.modes[0]] / 2) ** 2 * (size @ size))

    def sensitivities(self, modes: Modes, pairs: Pairs) -> Iterator[base.Sensitivity]:
        """Yield the change of J by one standard deviation of each measured frequency."""
        q, (sets, mode, measured, unit, _) = pairs.index[self.modes[0]], self.rows
        f, df = modes.frequency[q], modes.dfrequency[q]
        std = self.data.frequency_std[sets, mode]
        step = np.where(std > 0, std, 0.0) / sets.size
        for k, y, u, h in zip(sets, measured, unit, step, strict=True):
            ratio = f / y if self.scale == "measured" else 1.0
            J = -2 * (f - y) / u**2 * ratio
            dJ = -2 * df / u**2 * (2 * ratio - 1)
            number = base.value_numbers(self.data, k, self.modes[0])[:1]
            yield base.Sensitivity(number, np.array([J * h]), (dJ * h)[None])

    def independent(self) -> tuple[float, float, float]:
        """Return counts and scatter: all sets have one frequency, at best their weighted mean."""
        _, _, f, _, weight = self.rows
        w = weight**2
        mean = (w @ f) / w.sum()
        return 1.0, float(w @ (f - mean) ** 2), float(f.size - 1)

    def squares(self, modes: Modes, count: int) -> Floats:
        """Return the sums of squares with each model mode, (measured modes, modes)."""
        out, (_, mode, measured, _, weight) = np.zeros((count, modes.frequency.size)), self.rows
        r = (modes.frequency - measured[:, None]) * weight[:, None]
        np.add.at(out, mode, r**2)
        return out

    def r(self, modes: Modes, pairs: Pairs) -> Floats:
        """Return the residuals, shape (rows,)."""
        _, mode, measured, _, weight = self.rows
        return (modes.frequency[pairs.index[mode]] - measured) * weight

    def with_slopes(self, modes: Modes, pairs: Pairs) -> tuple[Floats, Floats]:
        """Return the residuals and their derivatives, shape (rows, p)."""
        _, mode, _, _, weight = self.rows
        return self.r(modes, pairs), weight[:, None] * modes.dfrequency[pairs.index[mode]]

    def with_curvature(self, modes: Modes, pairs: Pairs) -> tuple[Floats, Floats, base.Curvature]:
        """Return these and what is needed of second derivatives; d2f/dlam2 is -f' f' / f."""
        (r, dr), f, df = self.with_slopes(modes, pairs), modes.frequency, modes.dfrequency
        slope = np.bincount(pairs.index[self.rows[1]], 2 * self.rows[4] * r, f.size)
        own = df.T @ (-np.divide(slope, f, out=np.zeros(f.size), where=f > 0)[:, None] * df)
        return r, dr, base.Curvature(slope * modes.frequency_by_lam, np.zeros(modes.phi.shape), own)


class FrequencyKind:
    """Natural frequencies; see `modefront.residuals.base.ResidualKind`."""

    name = "frequency"
    plural = "frequencies"
    usable_std = f"standard deviations above {base.NEGLIGIBLE:g} of all measured frequencies"

    def measured(self, data: ModalData) -> Bools:
        """Return which modes have a frequency in any data set."""
        return np.asarray(np.isfinite(data.frequency).any(axis=0))

    def has_usable_std(self, data: ModalData, r: int) -> bool:
        """Return whether all frequencies of a mode have standard deviations above rounding."""
        k = np.isfinite(data.frequency[:, r])
        return bool((data.frequency_std[k, r] > base.NEGLIGIBLE * data.frequency[k, r]).all())

    def members(
        self, data: ModalData, modes: Sequence[int], scale: base.Scale
    ) -> list[base.Member]:
        """Return the residuals of the frequency of each mode."""
        return [FrequencyResiduals(data, [r], scale) for r in modes]

    def stack(self, data: ModalData, modes: Sequence[int], scale: base.Scale) -> FrequencyResiduals:
        """Return the residuals of the frequencies of some modes."""
        return FrequencyResiduals(data, modes, scale)
