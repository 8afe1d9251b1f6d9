"""The nominal model beside the measured modes: what every diagnosis starts from."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from modefront._typing import Floats
from modefront.data.modal import MEASURED, ModalData
from modefront.diagnosis.measured import Measured, measured
from modefront.errors import ModelError
from modefront.models.base import Model, full_of, matrices_at
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
    """

    problem: UpdatingProblem
    frequency: Floats
    phi: Floats
    candidates: int
    pairs: Pairs
    matrices: MatrixModel | None

    @property
    def data(self) -> ModalData:
        """The measured modes."""
        return self.problem.data

    @cached_property
    def view(self) -> Measured:
        """The measured modes as arrays."""
        return measured(self.data)


def compare(problem: UpdatingProblem) -> Comparison:
    """Return the comparison of the nominal model with the measured modes.

    Raises ModelError where the model has no modes at its nominal parameters.
    """
    count = modes_needed(problem.pairing, problem.data, problem.model.size)
    full = full_of(problem.model)
    matrices = matrices_at(full, problem.start)
    frequency, phi = _modes(matrices or full, problem.start, count)
    low = slice(0, count)
    pairs = match(problem.pairing, problem.data, frequency[low], phi[:, low])
    return Comparison(problem, frequency, phi, count, pairs, matrices)


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


def _modes(model: Model, theta: Floats, least: int) -> tuple[Floats, Floats]:
    """Return frequencies and shapes of as many modes as there are, ``least`` at least."""
    for count in dict.fromkeys((min(model.size, least + MORE), least)):
        try:
            solution = model.modes(theta, count, derivatives=False)
            return solution.frequency, solution.phi
        except ModelError:
            if count == least:
                raise
    raise ModelError("no modes")
