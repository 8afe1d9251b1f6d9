"""A model that solves a sparse one a few times, and a small one in its place after that."""

import time
from collections.abc import Hashable
from contextlib import suppress
from dataclasses import dataclass, field, replace
from itertools import combinations, islice
from typing import Any, TypeAlias

import numpy as np
import scipy.sparse.linalg

from modefront._typing import Floats
from modefront.errors import ModelError
from modefront.linalg.affine import DenseAffine
from modefront.models.base import passed_on
from modefront.models.matrices import MatrixModel
from modefront.models.reduced import basis as bases
from modefront.modes import dense
from modefront.modes.result import FullModes, Modes
from modefront.modes.sparse import lowest
from modefront.text import Shown, brief_model
from modefront.work.task import Costs, counted, spend, uncounted
from modefront.work.transfer import shared

SPARE = 2  # modes in the basis beyond those in use, without derivatives: they may enter later
SHARE = 0.1  # remainder of a correction over all of it, where it need not be exact
FAR = 30.0  # condition of K over that of the factor up to which a snapshot has no factor of its own
WORST = 6  # models of a snapshot that are corrected at once, the worst ones

TOLERANCE = 1e-8  # default relative error of eigenvalues
MEMORY = 4.0  # default limit of the memory of a basis in GiB


@dataclass(frozen=True)
class SnapshotRequest:
    """One model, or several together, at which a snapshot is requested.

    Derivatives are those of models that are solved in full, and of the one among the others that
    the basis knows the least.
    """

    theta: Floats  # (p,) parameters of the model, or (models, p)
    modes: int  # their number; 0 where the stiffness is indefinite, and the basis is to know that
    # relative error of eigenvalues below which a model is left as it is, and so is one that is not
    # among the worst; 0 where all models have to be exact, and no mode may be missing
    enough: float = 0.0
    derivatives: bool = True  # whether the basis is to have some

    @property
    def models(self) -> list[Floats]:
        """The parameters of each model."""
        return list(np.atleast_2d(self.theta))

    @property
    def key(self) -> Hashable:
        """What tells the snapshot from others."""
        return self.theta.tobytes(), self.modes, self.enough, self.derivatives


_Projected: TypeAlias = tuple[tuple[SnapshotRequest, ...], DenseAffine, DenseAffine, Floats]
"""Some snapshots, K and M in their basis, and the basis as the sensors see it."""


# 13 fields: eight describe the basis, five are its state.
@shared
@dataclass(eq=False, repr=False)
class ReducedModel(Shown):
    """A sparse model in the basis of its modes and their derivatives at some parameters.

    It is a model like any other (`modefront.models.base.Model`). The first snapshot is taken at
    the nominal parameters when it is first needed, others by `take`. The factor of the first one
    serves for all that are near enough.
    """

    full: MatrixModel  # the model with sparse matrices
    count: int  # modes that are asked for; more than these are solved in full
    nominal: Floats  # nominal, lower, upper: (p,) parameters
    lower: Floats
    upper: Floats
    tolerance: float = TOLERANCE  # relative error of eigenvalues that is aimed at
    memory: float = MEMORY  # GiB that the basis may take; one mode is always allowed
    spare: int = 0  # how many of the modes are only there to tell the others from them
    # those in use; others may be set, which are computed when needed, and not counted
    snapshots: tuple[SnapshotRequest, ...] = ()
    # relative ones of eigenvalues, and those of shapes, at models by the bytes of theta
    errors: dict[bytes, tuple[Floats, Floats]] = field(default_factory=dict)
    _taken: tuple[tuple[Hashable, Costs, float], ...] = ()  # of the basis
    _basis: bases.Basis | None = None
    _small: _Projected | None = None

    __repr__ = brief_model

    def __getstate__(self) -> dict[str, Any]:
        """Return the state with the projected matrices, and without basis and factor.

        Modes need no more; for anything else, snapshots are taken again when needed.
        """
        small = self._projected() if self._is_at_hand else None
        lost: dict[str, Any] = {"errors": {}, "_taken": (), "_basis": None, "_small": small}
        return {**vars(self), **lost}

    @property
    def version(self) -> tuple[Hashable, ...]:
        """Snapshots in use."""
        return tuple(what.key for what in self.snapshots)

    @property
    def footprint(self) -> float:
        """Bytes that the projected matrices take, which are all that is needed once they are."""
        if not self._is_at_hand:
            return self.full.footprint
        return 8.0 * 8 * self._projected()[1].size ** 2

    parameters = passed_on("full", "parameters")
    sensors = passed_on("full", "sensors")
    size = passed_on("full", "size")
    places = passed_on("full", "places")
    directions = passed_on("full", "directions")
    transfer = passed_on("full", "transfer")
    unused = passed_on("full", "unused")
    selection = passed_on("full", "selection")
    columns = passed_on("basis", "columns")  # that the basis has

    @property
    def capacity(self) -> int:
        """Columns that the basis may have: as many modes as are asked for, at least."""
        return max(self.count, int(self.memory * 2**30 // (8 * self.size)))

    @property
    def first(self) -> SnapshotRequest:
        """The first snapshot, unless another one is taken before it."""
        return SnapshotRequest(self.nominal, self.count - self.spare)

    def take(self, what: SnapshotRequest) -> float:
        """Add a snapshot and return the greatest relative error of an eigenvalue before it.

        The error is infinite where there was no basis, or one without so many modes. Raises
        ModelError where the model has no modes there.
        """
        before = self.snapshots
        self.snapshots = (*before, what)
        try:
            self._compute()
        except ModelError:
            self.snapshots = before
            raise
        _, costs, error = self._taken[len(before)]
        spend(costs)
        return error

    def modes(self, theta: Floats, count: int, *, derivatives: bool = True) -> Modes:
        """Return the ``count`` lowest modes at ``theta``; see `modefront.models.base.Model`."""
        if count > self.count:
            return self.full.modes(theta, count, derivatives=derivatives)
        _, K, M, sensed = self._projected()
        started = time.perf_counter()
        every = derivatives or M.coefficients.varies
        alone = None if every else dense.lowest(K.at(theta), M.at(theta), count)
        if alone:
            modes = Modes(alone[0], sensed @ alone[1])
        else:
            modes = dense.modes(K, M, sensed, theta, count, derivatives)
        spend(Costs(reduced=1, reduced_time=time.perf_counter() - started))
        return modes

    def full_modes(self, theta: Floats, count: int) -> FullModes:
        """Return the ``count`` lowest modes at all degrees of freedom; see `MatrixModel`."""
        if count > self.count:
            return self.full.full_modes(theta, count)
        basis = self.basis
        started = time.perf_counter()
        pairs = basis.lowest(theta, count)
        dense.refuse_fewer(pairs.lam.size, count)
        Phi = basis.combine(np.ascontiguousarray(pairs.Phi[:, :count]))
        spend(Costs(reduced=1, reduced_time=time.perf_counter() - started))
        return FullModes(pairs.lam[:count], Phi, None)

    def space(self, thetas: Floats, used: int, lacking: float) -> Floats:
        """Return coordinates (columns, n) in the basis that span ``used`` modes at parameters.

        Directions in which modes of unit energy have less than ``lacking``, root mean square, are
        left out, but for as many as there are modes.
        """
        _, K, M, _ = self._projected()
        X = [dense.decompose(K.at(x), M.at(x), used).X[:, :used] for x in thetas]
        U, sizes, _ = np.linalg.svd(np.hstack(X), full_matrices=False)
        spend(Costs(reduced=len(thetas)))
        kept = np.count_nonzero(sizes > lacking * np.sqrt(len(thetas)))
        return np.asarray(U[:, : max(kept, self.count)])

    def within(self, V: Floats) -> "ReducedModel":
        """Return the model in the space of coordinates (columns, n) in its basis."""
        what, *matrices, sensed = self._projected()
        K, M = (replace(A, terms=V.T @ A.terms @ V) for A in matrices)
        return replace(self, _small=(what, K, M, sensed @ V))

    def lacking(self, count: int) -> list[Floats]:
        """Return models with two parameters at their lower bounds where modes are missing.

        The modes at the bounds of single parameters are in the basis from the first. A mode of a
        part that is held by several others may enter only where two of these drop together, and
        no search in the basis would ever see that. A factorisation tells whether one of the
        ``count`` lowest does so, of the models where the basis has the stiffest modes.
        """
        basis, doubtful = self.basis, []
        for pair in combinations(range(self.nominal.size), 2):
            theta = self.nominal.copy()
            theta[list(pair)] = self.lower[list(pair)]
            lam = basis.ritz_values(theta, count + bases.LATER)
            if lam.size > count:
                doubtful.append((-lam[count - 1], pair, theta, lam))
        chosen = sorted(doubtful, key=lambda entry: entry[:2])[:24]  # each takes a factorisation
        return [x for *_, x, lam in chosen if bases.level(basis, x, lam, count) is None]

    @property
    def basis(self) -> bases.Basis:
        """The basis of the snapshots in use; the nominal one is taken where there is none."""
        if not self.snapshots:
            self.take(self.first)
        self._compute()
        assert self._basis is not None, "there is a snapshot"
        return self._basis

    @property
    def _is_at_hand(self) -> bool:
        """Whether nothing has to be solved in full for the snapshots in use."""
        small = self._small is not None and self._small[0] is self.snapshots
        return small or 0 < len(self.snapshots) == self._known

    @property
    def _known(self) -> int:
        """How many of the snapshots in use the basis has; 0 where it has others."""
        taken = tuple(key for key, *_ in self._taken)
        return len(taken) if self.version[: len(taken)] == taken else 0

    def _projected(self) -> _Projected:
        if self._small is None or self._small[0] is not self.snapshots:
            basis = self.basis
            sensed = np.hstack([self.full.selection @ block for block in basis.blocks])
            self._small = self.snapshots, basis.K, basis.M, sensed
        return self._small

    def _compute(self) -> None:
        """Make the basis that of the requested snapshots; only those not in it are computed."""
        if not self._known:
            self._taken, self._basis = (), None
        with uncounted():  # `take` counts a snapshot, once
            for what in self.snapshots[self._known :]:
                with counted() as costs:
                    self._basis, error = self._added(what)
                self._taken = (*self._taken, (what.key, costs, error))

    def _added(self, what: SnapshotRequest) -> tuple[bases.Basis, float]:
        """Return the basis with a snapshot, and the error that it found.

        Models near enough are corrected with the factor at hand, others solved in full. Those that
        have no modes are left out; raises ModelError where all of them have none.
        """
        basis, models, n, error, failed = self._basis, what.models, what.modes, 0.0, 0
        if basis is None:
            basis, error = self._solved(None, models.pop(0), what), np.inf
        elif n == 0:
            return self._excluding(basis, models), np.inf
        elif what.enough:
            known = [theta for theta in models if basis.ritz_values(theta, n).size >= n]
            lengths = bases.lacking_lengths(basis, known, n) if known else np.zeros(0)
            ranked = np.argsort(-lengths, kind="stable")
            worst = [known[k] for k in ranked if lengths[k] >= what.enough]
            if known and not worst:
                return basis, float(lengths.max())
            models = (worst or models)[:WORST]
        near = [  # models for which the factor at hand is of use, and no mode is missing
            theta
            for theta in models
            if (lam := basis.ritz_values(theta, n + bases.LATER)).size > n
            and _condition(basis, theta) <= FAR
            and (what.enough > 0 or bases.level(basis, theta, lam, n) is not None)
        ]
        if near and (corrected := self._corrected(basis, near, what)):
            basis, error = corrected[0], max(error, corrected[1])
            models = [theta for theta in models if not any(theta is other for other in near)]
        for theta in models:
            try:
                larger = self._solved(basis, theta, what)
            except ModelError:
                failed += 1
                continue
            lam, lacked = larger.lowest(theta, n).lam[:n], np.inf
            before = basis.ritz_values(theta, n)[:n]
            if before.size == lam.size:
                lacked = float(((before - lam) / (lam - larger.sigma)).max())
            basis, error = larger, max(error, lacked)
        if models and failed == len(what.models):
            raise ModelError("none of the models of a snapshot has modes")
        return basis, error

    def _corrected(
        self, basis: bases.Basis, near: list[Floats], what: SnapshotRequest
    ) -> tuple[bases.Basis, float] | None:
        """Return the basis with the modes of some models, and its error before.

        None where the models need factors of their own.
        """
        started = time.perf_counter()
        try:
            basis, errors = bases.with_modes(basis, near, what.modes, 0.0, what.enough)
        except ModelError:
            return None
        count = int((errors >= what.enough).sum())
        if count and what.derivatives:
            worst, half_range = near[int(errors.argmax())], (self.upper - self.lower) / 2
            basis = bases.with_derivatives(basis, worst, what.modes, half_range, SHARE)
        spend(Costs(corrected=count, corrected_time=time.perf_counter() - started))
        return basis, float(errors.max())

    def _solved(
        self, known: bases.Basis | None, theta: Floats, what: SnapshotRequest
    ) -> bases.Basis:
        """Return the basis with the modes of a model and, where they are wanted, derivatives."""
        started, modes, pencil = time.perf_counter(), what.modes, self.full.pencil
        count, spectrum = min(modes + SPARE, self.size), None
        if known is None:  # as many more as there are
            count = min(max(count, self.count), self.size)
            with suppress(ModelError):
                # Certificates need a level above the modes in question, and below the next one.
                spectrum = lowest(pencil, theta, min(2 * count, self.size))
        spectrum = spectrum or lowest(pencil, theta, count)
        below = spectrum.factors[0]
        # Of directions of equal length, the lowest ones.
        vectors = (spectrum.Phi / np.sqrt(spectrum.lam - below.sigma))[:, : self.capacity]
        del spectrum  # the other factor
        shortest = 0.1 * float(np.sqrt(self.tolerance))  # an error is the square of what is lacking
        basis = known or bases.empty(self.full, below, theta, shortest, self.capacity)
        basis = bases.extended(basis, vectors)
        solved = time.perf_counter()
        spend(Costs(eigenproblems=1, full_time=solved - started))
        if what.derivatives:  # of which the model's own factor knows more
            own, half_range = replace(basis, factor=below), (self.upper - self.lower) / 2
            own = bases.with_derivatives(own, theta, modes, half_range, SHARE)
            basis = replace(own, factor=basis.factor)
        if known is None:
            basis = self._at_bounds(basis, theta)
        spend(Costs(corrected_time=time.perf_counter() - solved))
        return basis

    def _excluding(self, basis: bases.Basis, models: list[Floats]) -> bases.Basis:
        """Return the basis with directions in which the stiffness of some models is negative.

        Raises ModelError where none is found.
        """
        pencil = self.full.pencil
        A = pencil.K.at(basis.theta) - basis.sigma * pencil.M.at(basis.theta)
        inverse = scipy.sparse.linalg.LinearOperator(
            A.shape, matvec=lambda x: basis.factor.solve(x.reshape(-1, 1))[:, 0], dtype=float
        )
        found = []
        for theta in models:
            start = np.random.default_rng(0).standard_normal(self.size)
            options = {"which": "SA", "v0": start, "tol": SHARE**2, "Minv": inverse}
            nu, X = scipy.sparse.linalg.eigsh(pencil.K.at(theta), 3, A, **options)
            found.append(X[:, nu < -1e-8])  # less is rounding
        vectors = np.hstack(found)
        if not vectors.shape[1]:
            raise ModelError("no direction of negative stiffness is found")
        return bases.extended(basis, vectors)

    def _at_bounds(self, basis: bases.Basis, theta: Floats) -> bases.Basis:
        """Return the basis with the modes where one parameter is at a bound, or nearer to theta.

        They are for the global search, and take no more than half of what is left of the memory.
        """
        bounds, unit = list[Floats](), np.eye(theta.size)
        for i, ends in enumerate(zip(self.lower, self.upper, strict=True)):
            for end in ends:
                nearby = (theta + unit[i] * ((end - theta[i]) / 2**k) for k in range(5))
                bounds += islice((x for x in nearby if _condition(basis, x) <= FAR), 1)
        count = min(self.first.modes, basis.columns - SPARE)
        if not bounds or count < 1:
            return basis
        small = replace(basis, shortest=3e-3, capacity=(basis.columns + self.capacity) // 2)
        for some in (bounds, *([theta] for theta in bounds)):
            # A larger space may see that a matrix is indefinite at one of them: then each alone.
            with suppress(ModelError):
                small, _ = bases.with_modes(small, some, count, SHARE)
                spend(Costs(corrected=len(some)))
                if some is bounds:
                    break
        return replace(small, shortest=basis.shortest, capacity=basis.capacity)


def _condition(basis: bases.Basis, theta: Floats) -> float:
    """Return the condition of K - sigma M over A in the basis; infinite where it is indefinite."""
    values = np.linalg.eigvalsh(basis.K.at(theta) - basis.sigma * basis.M.at(theta))
    return float(values[-1] / values[0]) if values[0] > 0 else np.inf
