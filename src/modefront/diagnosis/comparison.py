"""The nominal model beside the measured modes: what every diagnosis starts from."""

from dataclasses import dataclass, replace

import numpy as np

from modefront._typing import Floats
from modefront.data.modal import ModalData
from modefront.diagnosis.state import ratio
from modefront.errors import ModelError
from modefront.models.base import full_of, matrices_at
from modefront.models.matrices import MatrixModel
from modefront.pairing.match import Pairs, match, modes_needed
from modefront.residuals.problem import UpdatingProblem

MORE = 8  # model modes that are looked at beyond those among which measured modes are paired

COMPARED = 60  # data sets in which mistakes are sought, at most: each is compared with all others


@dataclass(frozen=True, eq=False)
class Comparison:
    """A model at its nominal parameters and the measured modes."""

    problem: UpdatingProblem  # the updating problem
    frequency: Floats  # (model modes,) frequencies of the model in Hz
    phi: Floats  # (sensors, model modes) its shapes
    candidates: int  # number of the lowest model modes among which the study pairs
    pairs: Pairs  # model modes of the measured ones by the rule of the study, and their MAC
    matrices: MatrixModel | None  # the model with its matrices; None where it has none

    @property
    def data(self) -> ModalData:
        """The measured modes."""
        return self.problem.data

    @property
    def comac(self) -> Floats:
        r"""COMAC of each sensor over the pairs, (sensors,); NaN where not measured.

        .. math::
            \frac{(\sum_r |\psi_{rs} \varphi_{rs}|)^2}{\sum_r \psi_{rs}^2 \sum_r \varphi_{rs}^2}

        (Lieven & Ewins, 6th International Modal Analysis Conference, 1988).
        """
        shape, known, *_ = self.data.measured_shapes
        both = shape, known * self.phi[:, self.pairs.index].T
        psi, phi = (ratio(x, np.linalg.norm(x, axis=2, keepdims=True)) for x in both)
        norm = (psi**2).sum(axis=(0, 1)) * (phi**2).sum(axis=(0, 1))
        cross = np.abs(psi * phi).sum(axis=(0, 1)) ** 2
        return np.where(norm > 0, ratio(cross, norm), np.nan)


def compare(problem: UpdatingProblem) -> Comparison:
    """Return the nominal model beside the data; raise ModelError where it has no modes."""
    least = modes_needed(problem.pairing, problem.data, problem.model.size)
    matrices = matrices_at(problem.model, problem.start)
    model = matrices or full_of(problem.model)
    try:
        count = min(model.size, least + MORE)
        modes = model.modes(problem.start, count, derivatives=False)
    except ModelError:  # there are not so many
        modes = model.modes(problem.start, least, derivatives=False)
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
