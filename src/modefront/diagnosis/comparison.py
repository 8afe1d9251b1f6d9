"""The nominal model beside the measured modes: what every diagnosis starts from."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from modefront._typing import Floats
from modefront.data.modal import MEASURED, ModalData
from modefront.diagnosis.fit import Updating
from modefront.diagnosis.measured import Measured, log_frequencies, mac_values, measured
from modefront.errors import ModelError
from modefront.models.base import Model, full_of
from modefront.models.local import matrices_at
from modefront.models.matrices import MatrixModel
from modefront.pairing.match import Pairs, match, modes_needed
from modefront.residuals.problem import UpdatingProblem

MORE = 12
"""Model modes that are looked at beyond those among which measured modes are paired."""

COMPARED = 60
"""Data sets in which mistakes are sought, at most: each is compared with every other one."""


@dataclass(frozen=True, eq=False)
class Comparison:
    """A model at its nominal parameters and the measured modes.

    Attributes
    ----------
    problem : the updating problem
    frequency : (model modes,) frequencies of the model in Hz
    phi : (sensors, model modes) its shapes
    candidates : number of the lowest model modes among which the study pairs
    pairs : model modes of the measured ones by the rule of the study, and their MAC
    matrices : the model with its matrices; None where it has none
    Phi : (N, model modes) shapes at all degrees of freedom; None where the model has no matrices
    """

    problem: UpdatingProblem
    frequency: Floats
    phi: Floats
    candidates: int
    pairs: Pairs
    matrices: MatrixModel | None
    Phi: Floats | None

    @property
    def data(self) -> ModalData:
        """The measured modes."""
        return self.problem.data

    @cached_property
    def view(self) -> Measured:
        """The measured modes as arrays."""
        return measured(self.data)

    @cached_property
    def log_frequency(self) -> Floats:
        """Logarithms of the model's frequencies, (model modes,)."""
        return log_frequencies(self.frequency)

    @cached_property
    def mac(self) -> Floats:
        """MAC of measured and model modes, (modes, model modes); NaN without a shape."""
        return mac_values(self.view.psi, self.view.seen, self.phi)

    @property
    def has_all_modes(self) -> bool:
        """Whether the model has no more modes than are looked at."""
        return self.frequency.size < self.candidates + MORE

    def updating(self, shift: float, model: Model | None = None) -> Updating:
        """Return the model, or one with other sensors in its place, to be fitted."""
        problem = self.problem
        return Updating(
            model or problem.model,
            self.candidates,
            *(problem.lower, problem.upper, problem.start),
            shift,
        )


def compare(problem: UpdatingProblem) -> Comparison:
    """Return the comparison of the nominal model with the measured modes.

    Raises ModelError where the model has no modes at its nominal parameters.
    """
    count = modes_needed(problem.pairing, problem.data, problem.model.size)
    theta = problem.start
    full = full_of(problem.model)
    matrices = matrices_at(full, theta)
    modes = min(problem.model.size, count + MORE)
    frequency, phi, Phi = _modes(full, matrices, theta, count, modes)
    known = slice(0, count)
    pairs = match(problem.pairing, problem.data, frequency[known], phi[:, known])
    return Comparison(problem, frequency, phi, count, pairs, matrices, Phi)


def with_data(comparison: Comparison, data: ModalData) -> Comparison:
    """Return the comparison of the same model with other data, paired anew."""
    problem, low = comparison.problem, slice(0, comparison.candidates)
    frequency, phi = comparison.frequency[low], comparison.phi[:, low]
    return replace(
        comparison,
        problem=replace(problem, data=data),
        pairs=match(problem.pairing, data, frequency, phi),
    )


def of_few_sets(comparison: Comparison) -> Comparison:
    """Return the comparison with so many data sets, chosen evenly, that all of them are compared.

    A mode that none of these has is of the first data set that has it.
    """
    data = comparison.data
    if len(data.sets) <= COMPARED:
        return comparison
    even = np.linspace(0, len(data.sets) - 1, COMPARED).astype(np.intp)
    first = [
        seen.argmax(axis=0)
        for seen in (np.isfinite(data.frequency), np.isfinite(data.shape).any(axis=2))
    ]
    chosen = np.unique(np.concatenate([even, *first]))
    few = {name: getattr(data, name)[chosen] for name in MEASURED}
    sets = tuple(data.sets[k] for k in chosen.tolist())
    return with_data(comparison, replace(data, sets=sets, **few))


def _modes(
    model: Model, matrices: MatrixModel | None, theta: Floats, least: int, most: int
) -> tuple[Floats, Floats, Floats | None]:
    """Return frequencies and shapes of as many modes as there are, ``least`` at least."""
    for count in dict.fromkeys((most, least)):
        try:
            if isinstance(model, MatrixModel) and matrices is not None:
                modes = model.full_modes(theta, count)
                f = np.sqrt(np.maximum(modes.lam, 0.0)) / (2 * np.pi)
                return f, model.selection @ modes.Phi, modes.Phi
            solution = model.modes(theta, count, derivatives=False)
        except ModelError:
            if count == least:
                raise
            continue
        return solution.frequency, solution.phi, None
    raise ModelError("no modes")
