r"""The structure that a prediction is asked of: a model's modes between ports, with damping.

Where damping is that of the measurements, a model mode has the mean damping ratio, over the data
sets, of the measured mode that is paired with it; modes without a partner, or whose partner's
damping was not measured, have the mean of all that was.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from modefront._typing import Floats
from modefront.data.modal import ModalData
from modefront.errors import ModelError
from modefront.models.base import Model
from modefront.models.ports import Pattern, Ports, Transfer
from modefront.pairing.match import match, modes_needed
from modefront.residuals.problem import UpdatingProblem
from modefront.response.system import ModalSystem


@dataclass(frozen=True)
class Structure:
    """What of a model enters a prediction.

    Attributes
    ----------
    ports : where it is loaded and what is looked at
    modes : how many of the lowest modes are superposed
    damping : ratio of all modes, or of each; None takes those of the measurements
    static : whether the static response of the modes left out is added
    """

    ports: Ports
    modes: int
    damping: float | tuple[float, ...] | None
    static: bool = True

    @property
    def load(self) -> str:
        """What loads the structure, in words."""
        if self.ports.base is not None:
            return f"base along {self.ports.base}"
        return "force at " + ", and at ".join(map(_in_words, self.ports.forces))

    @property
    def damped(self) -> str:
        """The damping ratios, in words."""
        if self.damping is None:
            return "as measured"
        ratios = self.damping if isinstance(self.damping, tuple) else (self.damping,)
        return ", ".join(f"{ratio:g}" for ratio in ratios)

    def system(self, problem: UpdatingProblem, theta: Floats) -> ModalSystem:
        """Return the structure in modal coordinates at ``theta``.

        Raises ModelError where the model has no such modes there.
        """
        count = self.modes
        if self.damping is None:
            count = max(count, modes_needed(problem.pairing, problem.data, problem.model.size))
        found = problem.model.transfer(theta, count, self.ports)
        m = self.modes
        return ModalSystem(
            omega=np.sqrt(found.modes.lam[:m]),
            zeta=self._damping(problem, found)[:m],
            input=found.input[:m],
            output=found.output[:, :m],
            static=found.static if self.static else None,
            rigid=found.rigid,
        )

    def _damping(self, problem: UpdatingProblem, found: Transfer) -> Floats:
        count = found.modes.lam.size
        if self.damping is not None:
            return np.broadcast_to(np.asarray(self.damping, dtype=float), count)
        measured = measured_damping(problem.data)
        known = np.isfinite(measured)
        zeta = np.full(count, measured[known].mean())
        # The same candidates as in updating, or other modes might be paired.
        n = modes_needed(problem.pairing, problem.data, problem.model.size)
        frequency, phi = found.modes.frequency[:n], found.modes.phi[:, :n]
        pairs = match(problem.pairing, problem.data, frequency, phi)
        zeta[pairs.index[known]] = measured[known]
        return zeta


def measured_damping(data: ModalData) -> Floats:
    """Return the mean damping ratio of each measured mode, shape (modes,); NaN where none."""
    known = np.isfinite(data.damping)
    total = np.where(known, data.damping, 0.0).sum(axis=0)
    count = known.sum(axis=0)
    out: Floats = np.where(count > 0, total / np.maximum(count, 1), np.nan)
    return out


def modes_reaching(model: Model, theta: Floats, frequency: float, known: int) -> int:
    """Return how many modes at ``theta`` are below a frequency in Hz, and one more if there is.

    ``known`` is a number of modes that the model is known to have.
    """
    found = model.modes(theta, known, derivatives=False).frequency
    while not (found >= frequency).any():
        more = _more(model, theta, found)
        if more.size == found.size:
            return found.size
        found = more
    return int(np.argmax(found >= frequency)) + 1


def _more(model: Model, theta: Floats, found: Floats) -> Floats:
    """Return the frequencies of up to twice as many modes, as far as there are finite ones."""
    upper = min(2 * found.size, model.size)
    while upper > found.size:
        try:
            return model.modes(theta, upper, derivatives=False).frequency
        except ModelError:
            upper = (found.size + upper) // 2
    return found


def _in_words(pattern: Pattern) -> str:
    """Return the places of a pattern, with weights that are not 1."""
    return " + ".join(
        name if weight == 1 else f"{weight:g} {name}" for name, weight in pattern.items()
    )
