"""The nominal model beside the measured modes: what every diagnosis starts from."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from modefront._typing import Floats
from modefront.data.modal import ModalData
from modefront.diagnosis.measured import Measured, measured
from modefront.errors import ModelError
from modefront.models.base import full_of, matrices_at
from modefront.models.matrices import MatrixModel
from modefront.pairing.match import Pairs, match, modes_needed
from modefront.residuals.problem import UpdatingProblem

MORE = 8
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
    least = modes_needed(problem.pairing, problem.data, problem.model.size)
    full = full_of(problem.model)
    matrices = matrices_at(full, problem.start)
    modes = None
    with suppress(ModelError):  # there may not be so many
        count = min(full.size, least + MORE)
        modes = (matrices or full).modes(problem.start, count, derivatives=False)
    modes = modes or (matrices or full).modes(problem.start, least, derivatives=False)
    pairs = match(problem.pairing, problem.data, modes.frequency[:least], modes.phi[:, :least])
    return Comparison(problem, modes.frequency, modes.phi, least, pairs, matrices)


def of_few_sets(comparison: Comparison) -> Comparison:
    """Return the comparison with so many data sets, chosen evenly, that all of them are compared.

    A mode that none of these has is of the first data set that has it.
    """
    data = comparison.data
    if len(data.sets) <= COMPARED:
        return comparison
    even = np.linspace(0, len(data.sets) - 1, COMPARED).astype(np.intp)
    known = np.isfinite(data.frequency), np.isfinite(data.shape).any(axis=2)
    chosen = np.unique(np.concatenate([even, *(seen.argmax(axis=0) for seen in known)]))
    few = data.of_sets(chosen, tuple(data.sets[k] for k in chosen.tolist()))
    return compare(replace(comparison.problem, data=few))
