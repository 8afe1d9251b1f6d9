"""The updating problem: objectives that are sums of squares of the residuals of their members.

Second derivatives are those of Gauss and Newton, or all of them.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np

from modefront._typing import Floats, Ints
from modefront.data.modal import ModalData
from modefront.errors import ModelError
from modefront.models.base import Model, passed_on
from modefront.models.matrices import MatrixModel, of_free
from modefront.models.parameters import Parameter, Prior, in_order, parameters_of
from modefront.models.reduced.model import ReducedModel
from modefront.models.reduced.options import Reduction
from modefront.modes.result import Modes
from modefront.optim.problem import Evaluation, Residual, infeasible
from modefront.optim.scalarisation import LogSum
from modefront.pairing.match import (
    FEWEST,
    MOST,
    REACH,
    Pairing,
    Pairs,
    mac_slopes,
    match,
    mean_mac,
    modes_needed,
)
from modefront.residuals.base import Member, ModeErrors, Stack
from modefront.residuals.groups import Group
from modefront.text import Shown
from modefront.work.transfer import shared


# 11 fields: model and data, limits of the parameters, and how both are compared.
@shared
@dataclass(frozen=True)
class UpdatingProblem(Shown):
    """Objectives of a model, measured data and groups; `updating_problem` makes it.

    What the solvers see of it is `modefront.optim.problem.Problem`. Raises ValueError for a group
    whose members the data lack.

    Attributes
    ----------
    model : gives the modes at the sensors as a function of the parameters
    data : the measured modes
    groups : the measured properties of each objective
    lower, upper, start : (parameters,) bounds and nominal values
    pairing : how measured modes and model modes are paired
    priors : what is expected of each parameter; none of any unless given
    whole : the model as a function of its fixed and tied parameters too, and all of these; None
        where all are free
    likelihood : function of the objectives that is least with the pairs, instead of those that the
        MAC says; None for these
    """

    model: Model
    data: ModalData
    groups: tuple[Group, ...]
    lower: Floats
    upper: Floats
    start: Floats
    pairing: Pairing = field(default_factory=Pairing)
    priors: tuple[Prior | None, ...] = ()
    likelihood: LogSum | None = None
    whole: tuple[Model, tuple[Parameter, ...]] | None = field(
        default=None, repr=False, compare=False
    )
    members: tuple[tuple[Member, ...], ...] = field(init=False, repr=False, compare=False)
    """The members of each group."""

    def __post_init__(self) -> None:
        members = tuple(tuple(group.members(self.data)) for group in self.groups)
        object.__setattr__(self, "members", members)

    def __repr__(self) -> str:
        """Return a line with the sizes of model and data."""
        data, p = self.data, len(self.model.parameters)
        sets = f"{len(data.sets)} data set{'s' * (len(data.sets) > 1)}"
        return (
            f"UpdatingProblem({p} parameters, {len(data.modes)} modes at {len(data.sensors)} "
            f"sensors in {sets}, groups {', '.join(self.objectives)})"
        )

    def __getstate__(self) -> dict[str, Any]:
        """Return the state without the whole model, which no other process needs."""
        return vars(self) | {"whole": None}

    def with_free(self, names: Sequence[str]) -> "UpdatingProblem":
        """Return the problem with more parameters: those of its fixed ones that are named.

        A reduced model has a basis of its own, in which there is nothing so far.
        """
        assert self.whole is not None, "no parameter is fixed"
        given = tuple(replace(x, fixed=x.fixed and x.name not in names) for x in self.whole[1])
        model, chosen = of_free(self.whole[0], given)
        if isinstance(self.model, ReducedModel):
            reduction = Reduction(self.model.tolerance, self.model.memory)
            model = reduction.of(model, self.data, self.pairing, chosen)
        return replace(self, model=model, **_limits(chosen))

    @cached_property
    def _stacks(self) -> tuple[tuple[Stack, ...], ...]:
        """The members of each group, those of a kind together."""
        return tuple(tuple(group.stacks(self.data)) for group in self.groups)

    # those of the model, where it has them: see `modefront.work.transfer.shared`
    version = passed_on("model", "version")
    footprint = passed_on("model", "footprint")

    @property
    def objectives(self) -> tuple[str, ...]:
        """Names of the groups."""
        return tuple(group.name for group in self.groups)

    @cached_property
    def properties(self) -> Floats:
        """Counts a_i of the measured properties of each group, shape (groups,)."""
        return np.array([sum(member.count for member in row) for row in self.members])

    @cached_property
    def least(self) -> Floats:
        """Values of the objectives that no model falls below, as data sets differ, (groups,)."""
        parts = [[member.independent() for member in row] for row in self.members]
        return np.array([sum(scatter for _, scatter, _ in row) for row in parts])

    def evaluate(
        self, theta: Floats, *, derivatives: bool = True, second: bool = False
    ) -> Evaluation:
        """Return the objectives at ``theta``, with frequencies, MAC values and pairs kept.

        ``second`` requests exact second derivatives besides the first ones.
        """
        try:
            modes, pairs = self.modes(theta, derivatives=derivatives)
        except ModelError:
            return infeasible(theta, len(self.groups))
        return self.evaluated(theta, modes, pairs, derivatives=derivatives, second=second)

    def evaluated(
        self, theta: Floats, modes: Modes, pairs: Pairs, *, derivatives: bool, second: bool
    ) -> Evaluation:
        """Return the objectives at ``theta`` of its modes, which are paired as given."""
        quantities = {
            "frequency": modes.frequency[pairs.index],
            "mac": pairs.mac,
            "paired_mode": pairs.index + 1.0,
            "coincident": modes.coincident[pairs.index].astype(float),
        }
        if not derivatives:
            J = np.array([r @ r for r in self.vectors(modes, pairs)])
            return Evaluation(theta, J, quantities=quantities)
        if second:
            residuals, rest = self._with_curvature(modes, pairs)
        else:
            residuals, rest = self.residuals_at(modes, pairs), None
        J = np.array([x.r @ x.r for x in residuals])
        dJ = np.array([2 * x.r @ x.dr for x in residuals])
        H = np.array([2 * x.dr.T @ x.dr for x in residuals])
        if rest is not None:
            H += rest
        return Evaluation(theta, J, dJ, H, rest is not None, quantities, residuals)

    def continued(self, inside: Evaluation, beyond: Evaluation) -> "Continued | None":
        """Return the problem with the pairs of one model beyond where MAC values change them.

        None where the pairs of both models are the same, or those that are least in something: no
        objectives jump then because of them.
        """
        known = Continued(self, paired(inside)[None])
        return known.continued(inside, beyond) if self.likelihood is None else None

    def modes(self, theta: Floats, *, derivatives: bool = True) -> tuple[Modes, Pairs]:
        """Return the model's modes at ``theta`` and which of them belong to the measured ones."""
        count = modes_needed(self.pairing, self.data, self.model.size)
        modes = self.model.modes(theta, count, derivatives=derivatives)
        squares, m = None, len(self.data.modes)
        if self.likelihood is not None and self.pairing.method == "mac":
            squares = np.array([sum(x.squares(modes, m) for x in row) for row in self._stacks])
        seen = modes.frequency, modes.phi
        return modes, match(self.pairing, self.data, *seen, squares, self.likelihood)

    def residuals(self, theta: Floats) -> tuple[Residual, ...]:
        """Return the residual vector of each group, with derivatives.

        Raises ModelError where the model has no modes at ``theta``.
        """
        return self.residuals_at(*self.modes(theta))

    def residuals_at(self, modes: Modes, pairs: Pairs) -> tuple[Residual, ...]:
        """Return the residual vector of each group at paired modes with derivatives."""
        of_all = [[stack.with_slopes(modes, pairs) for stack in row] for row in self._stacks]
        return tuple(Residual(*map(np.concatenate, zip(*x, strict=True))) for x in of_all)

    def slopes_at(self, modes: Modes, pairs: Pairs) -> dict[str, Floats]:
        """Return the derivatives (measured modes, p) of paired frequencies and MAC values."""
        return {
            "frequency": modes.dfrequency[pairs.index],
            "mac": mac_slopes(self.data, pairs, modes.phi, modes.dphi),
        }

    def _with_curvature(
        self, modes: Modes, pairs: Pairs
    ) -> tuple[tuple[Residual, ...], Floats | None]:
        """Return these, and second derivatives of J beyond Gauss-Newton's where they are known."""
        residuals, curvatures = [], []
        for row in self._stacks:
            r, dr, parts = zip(*(x.with_curvature(modes, pairs) for x in row), strict=True)
            residuals.append(Residual(np.concatenate(r), np.concatenate(dr)))
            curvatures.append([sum(getattr(x, name) for x in parts) for name in ("w", "v", "own")])
        w, v, own = map(np.array, zip(*curvatures, strict=True))
        try:
            of_modes = modes.second_derivatives(w, v)
        except ModelError:  # an iteration fails that first derivatives do not need
            of_modes = None
        return tuple(residuals), None if of_modes is None else own + of_modes

    def vectors(self, modes: Modes, pairs: Pairs) -> list[Floats]:
        """Return the residual vector of each group without derivatives."""
        return [np.concatenate([stack.r(modes, pairs) for stack in row]) for row in self._stacks]

    def margins(self, eigenvalue: Floats, shape: Floats) -> Floats:
        """Return how far the root of each objective may be off, (groups,).

        ``eigenvalue`` and ``shape`` (measured modes,) are relative errors of the paired modes.
        """
        errors = ModeErrors(eigenvalue, shape)
        squares = [sum(member.margin(errors) for member in row) for row in self.members]
        return np.sqrt(np.array(squares))


def paired(evaluation: Evaluation) -> Ints:
    """Return the modes that the rule of the problem pairs with measured ones, counted from 0."""
    of = evaluation.quantities
    return of.get("mac_mode", of["paired_mode"]).astype(np.intp) - 1


@dataclass(eq=False)
class Continued:
    r"""A problem in which the pairs on one side of jumps hold on their other sides too.

    Its last objectives are the sums of the MAC values of the pairs beyond each jump, less that of
    those inside: the jumps are where they are 0.
    """

    problem: UpdatingProblem
    pairs: Ints  # (1 + jumps, measured modes) paired model modes inside and beyond each, from 0

    def __post_init__(self) -> None:
        self.objectives = (*self.problem.objectives, *["beyond"] * (len(self.pairs) - 1))
        self.lower, self.upper = self.problem.lower, self.problem.upper
        self.start = self.problem.start

    def continued(self, _: Evaluation, beyond: Evaluation) -> "Continued | None":
        """Return the problem that goes on beyond one more jump; None where it does already."""
        is_known = (paired(beyond) == self.pairs).all(axis=1).any()
        return None if is_known else replace(self, pairs=np.vstack([self.pairs, paired(beyond)]))

    def evaluate(
        self, theta: Floats, *, derivatives: bool = True, second: bool = False
    ) -> Evaluation:
        """Return the objectives at ``theta``; second derivatives of the last are left out."""
        problem = self.problem
        try:
            modes, pairs = problem.modes(theta, derivatives=derivatives)
        except ModelError:
            return infeasible(theta, len(self.objectives))
        values, rows = mean_mac(problem.data, modes.phi), np.arange(self.pairs.shape[1])
        inside, *beyond = (Pairs(q, values[rows, q]) for q in self.pairs)
        if (pairs.index == self.pairs).all(axis=1).any():
            pairs = inside
        known = problem.evaluated(theta, modes, pairs, derivatives=derivatives, second=second)
        J = np.append(known.J, [np.nansum(x.mac - inside.mac) for x in beyond])
        if not derivatives:
            return replace(known, J=J)
        slopes = [mac_slopes(problem.data, x, modes.phi, modes.dphi) for x in (inside, *beyond)]
        dJ = np.vstack([known.dJ, *(np.nansum(x - slopes[0], axis=0) for x in slopes[1:])])
        H = np.pad(known.H, ((0, len(beyond)), (0, 0), (0, 0)))
        return replace(known, J=J, dJ=dJ, H=H, exact=False, residuals=())


# 8 arguments: the parts of a problem, the optional ones by keyword.
def updating_problem(
    model: Model,
    data: ModalData,
    groups: Sequence[Group],
    bounds: Mapping[str, tuple[float, float]] | None = None,
    nominal: Mapping[str, float] | None = None,
    pairing: Pairing | None = None,
    *,
    parameters: Sequence[Parameter] = (),
    reduction: Reduction | None = None,
) -> UpdatingProblem:
    """Return the problem of updating a model.

    Parameters
    ----------
    model
        The model: `chain`, `matrices`, `mesh_model` or `function_model` makes one.
    data
        Measured modes at sensors of the model, at all or some of them; at the others, nothing is
        measured.
    groups
        The objectives, one a group of measured properties.
    bounds, nominal
        Bounds (lower, upper) and nominal value of each parameter, by its name; these or
        ``parameters``.
    pairing
        How measured modes and model modes are paired; by their MAC unless given.
    parameters
        The parameters with bounds and nominal values, in any order.
    reduction
        When a reduced basis takes the place of the model: where it pays, unless given, as in a
        study file; ``Reduction("off")`` solves in full.

    Raises
    ------
    ValueError
        If a parameter is not given once, has bounds of no width or a nominal value beyond them
        (`InputError`), if a group has no members, or if data have a sensor that the model has not.
    """
    data = data.at(model.sensors)
    given = in_order(parameters or parameters_of(bounds or {}, nominal or {}), model.parameters)
    whole = None if all(each.free for each in given) else (model, tuple(given))
    model, chosen = of_free(model, given)
    limits, pairing = _limits(chosen), pairing or Pairing()
    if pairing.spare is None and pairing.method != "order" and isinstance(model, MatrixModel):
        highest = float(np.nanmax(data.mean_frequency, initial=0.0))
        below = model.modes_below(limits["start"], REACH * highest)
        pairing = replace(pairing, spare=int(np.clip(below - len(data.modes), FEWEST, MOST)))
    model = (reduction or Reduction()).of(model, data, pairing, chosen)
    return UpdatingProblem(model, data, tuple(groups), pairing=pairing, whole=whole, **limits)


def _limits(parameters: Sequence[Parameter]) -> dict[str, Any]:
    """Return the fields of a problem that are those of its parameters."""
    return {
        "lower": np.array([each.lower for each in parameters]),
        "upper": np.array([each.upper for each in parameters]),
        "start": np.array([each.nominal for each in parameters]),
        "priors": tuple(each.prior for each in parameters),
    }
