"""A model that solves a sparse one a few times, and a small one in its place after that."""

from __future__ import annotations

import time
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np

from modefront._typing import Floats
from modefront.errors import ModelError
from modefront.linalg.affine import DenseAffine
from modefront.linalg.factorisation import SingularMatrixError
from modefront.models.load_case import LoadCase, Transfer
from modefront.models.matrices import MatrixModel
from modefront.models.reduced import completeness
from modefront.models.reduced.basis import Basis, Snapshot, empty, extended, snapshot
from modefront.models.reduced.certifier import Certifier, InertiaProof, knows, reach_of
from modefront.models.reduced.corrections import (
    CorrectionRequest,
    Factor,
    with_derivatives,
    with_modes,
)
from modefront.models.reduced.instability import unstable
from modefront.modes import dense
from modefront.modes.derivatives import Shifted
from modefront.modes.eigensolvers import FullModes
from modefront.modes.result import Modes
from modefront.work.costs import Costs, counted, spend, uncounted
from modefront.work.transfer import shared

SHORTEST = 0.1
"""Length of the shortest direction of the basis, over the square root of the tolerance."""

SPARE = 2
"""Modes in the basis beyond those that are used, without derivatives: they may enter later."""

WIDE = 2
"""Modes of the first snapshot over those that are used."""

PROBES = 24
"""Factorisations at most that seek modes which enter where two parameters drop together."""

COARSE = 3e-3
"""Length of the shortest direction of the basis that stands for the bounds."""

SHARE = 0.1
"""Remainder of a correction over all of it, where it need not be exact."""

FAR = 30.0
"""Condition of K over that of the factor up to which a snapshot has no factor of its own."""

HALVINGS = 4
"""Number of times that a bound is moved halfway to the model."""

TOLERANCE = 1e-8
"""Default relative error of eigenvalues."""

MEMORY = 4.0
"""Default limit of the memory of a basis in GiB."""


@dataclass(frozen=True)
class SnapshotRequest:
    """One model, or several together, at which a snapshot is requested.

    Derivatives are those of the model of which the basis knows the least.

    Attributes
    ----------
    theta : (p,) parameters of the model, or (models, p)
    modes : number of modes; 0 where the stiffness matrix is indefinite, and the basis is
        to know that
    enough : relative error of eigenvalues below which a model is left as it is
    """

    theta: Floats
    modes: int
    enough: float = 0.0

    @property
    def models(self) -> list[Floats]:
        """The parameters of each model."""
        return list(np.atleast_2d(self.theta))

    def same(self, other: SnapshotRequest) -> bool:
        """Return whether it is the same snapshot."""
        alike = self.modes == other.modes and self.enough == other.enough
        return alike and np.array_equal(self.theta, other.theta)


@dataclass(frozen=True)
class _TakenSnapshot:
    """A snapshot, what it took, and the error that it found."""

    what: SnapshotRequest
    costs: Costs
    error: float


@dataclass(frozen=True)
class _Space:
    """A basis, the last factor, and what is known of modes that are missing."""

    basis: Basis
    factor: Factor
    proofs: tuple[InertiaProof, ...]


@dataclass(frozen=True)
class _State:
    """The space of some snapshots, and the basis as the sensors see it."""

    taken: tuple[_TakenSnapshot, ...]
    space: _Space
    sensed: Floats


@dataclass(frozen=True)
class _Projected:
    """The matrices in the basis of some snapshots, and the basis as the sensors see it."""

    snapshots: tuple[SnapshotRequest, ...]
    K: DenseAffine
    M: DenseAffine
    sensed: Floats


# 12 fields: eight describe the basis, four are its state.
@shared
@dataclass(eq=False)
class ReducedModel:
    """A sparse model in the basis of its modes and their derivatives at some parameters.

    It is a model like any other (`modefront.models.base.Model`). The first snapshot is taken at
    the nominal parameters when it is first needed, others by `take`.

    Attributes
    ----------
    full : the model with sparse matrices
    count : modes that are asked for; more than these are solved in full
    nominal, lower, upper : (p,) parameters
    tolerance : relative error of eigenvalues that is aimed at
    memory : GiB that the basis may take; one mode is always allowed
    spare : how many of the modes are only there to tell the others from them
    """

    full: MatrixModel
    count: int
    nominal: Floats
    lower: Floats
    upper: Floats
    tolerance: float = TOLERANCE
    memory: float = MEMORY
    spare: int = 0
    _requested: tuple[SnapshotRequest, ...] = ()
    _state: _State | None = None
    _sent: _Projected | None = None
    _certifier: Certifier | None = None

    def __getstate__(self) -> dict[str, Any]:
        """Return the state with the projected matrices, and without basis and factor.

        Modes need no more; for anything else, snapshots are taken again when needed.
        """
        return {**vars(self), "_state": None, "_sent": self._at_hand(), "_certifier": None}

    @property
    def version(self) -> tuple[tuple[bytes, int, float], ...]:
        """Snapshots in use."""
        return tuple((x.theta.tobytes(), x.modes, x.enough) for x in self._requested)

    @property
    def parts(self) -> tuple[MatrixModel]:
        """The full model, which is sent to other processes on its own."""
        return (self.full,)

    @property
    def footprint(self) -> float:
        """Bytes that the projected matrices take; nothing else is needed for modes."""
        known = self._at_hand()
        return 0.0 if known is None else 8.0 * 8 * known.K.size**2

    @property
    def parameters(self) -> tuple[str, ...]:
        """Names of the parameters."""
        return self.full.parameters

    @property
    def sensors(self) -> tuple[str, ...]:
        """Names of the sensors."""
        return self.full.sensors

    @property
    def size(self) -> int:
        """Number of degrees of freedom of the full model."""
        return self.full.size

    @property
    def places(self) -> tuple[str, ...]:
        """Names of the sensors and of the other outputs."""
        return self.full.places

    @property
    def directions(self) -> tuple[str, ...]:
        """Names of the directions in which the base can move."""
        return self.full.directions

    def transfer(self, theta: Floats, count: int, load_case: LoadCase) -> Transfer:
        """Return the full model in a load case; see `modefront.models.base.Model`."""
        return self.full.transfer(theta, count, load_case)

    @property
    def unused(self) -> tuple[str, ...]:
        """Names of parameters on which neither matrix depends."""
        return self.full.unused

    @property
    def capacity(self) -> int:
        """Columns that the basis may have: as many modes as are asked for, at least."""
        return max(self.count, int(self.memory * 2**30 // (8 * self.size)))

    @property
    def columns(self) -> int:
        """Columns that the basis has."""
        return self.ready().space.basis.columns

    @property
    def first(self) -> SnapshotRequest:
        """The first snapshot, unless another one is taken before it."""
        return SnapshotRequest(self.nominal, self.count - self.spare)

    @property
    def snapshots(self) -> tuple[SnapshotRequest, ...]:
        """The snapshots in use."""
        return self._requested

    def restart(self) -> None:
        """Use no snapshots. Those at hand are not computed again, but count when taken again."""
        self._requested = ()

    def resume(self, snapshots: Sequence[SnapshotRequest]) -> None:
        """Use these snapshots, which were counted before; they are computed when needed."""
        self._requested = tuple(snapshots)

    def take(self, what: SnapshotRequest) -> float:
        """Add a snapshot and return the greatest relative error of an eigenvalue before it.

        The error is an estimate, and infinite where the model had to be solved in full. Raises
        ModelError where the model has no modes there.
        """
        before = self._requested
        self._requested = (*before, what)
        try:
            last = self.ready().taken[-1]
        except ModelError:
            self._requested = before
            raise
        spend(last.costs)
        return last.error

    def modes(self, theta: Floats, count: int, *, derivatives: bool = True) -> Modes:
        """Return the ``count`` lowest modes at ``theta``; see `modefront.models.base.Model`."""
        if count > self.count:
            return self.full.modes(theta, count, derivatives=derivatives)
        small = self._at_hand() or self._projected(self.ready())
        started = time.perf_counter()
        modes = dense.modes(small.K, small.M, small.sensed, theta, count, derivatives)
        spend(Costs(reduced=1, reduced_time=time.perf_counter() - started))
        return modes

    def full_modes(self, theta: Floats, count: int) -> FullModes:
        """Return the ``count`` lowest modes at all degrees of freedom, by the basis.

        Raises ModelError where the model has no such modes.
        """
        if count > self.count:
            return self.full.full_modes(theta, count)
        basis = self.ready().space.basis
        started = time.perf_counter()
        pairs = dense.lowest(basis.K.at(theta), basis.M.at(theta), count)
        if pairs.lam.size < count:
            raise ModelError(
                f"{count} modes asked for, but only {pairs.lam.size} have a finite frequency"
            )
        Phi = basis.combine(np.ascontiguousarray(pairs.Phi[:, :count]))
        spend(Costs(reduced=1, reduced_time=time.perf_counter() - started))
        return FullModes(pairs.lam[:count], Phi, None)

    def distance(self, theta: Floats) -> float:
        """Return how far the nearest snapshot is, over the ranges of the parameters."""
        span = self.upper - self.lower
        thetas = [nearby for snap in self._requested if snap.modes for nearby in snap.models]
        return float(min(np.linalg.norm((theta - nearby) / span) for nearby in thetas))

    def certifier(self) -> Certifier:
        """Return what judges modes of the basis."""
        space = self.ready().space
        if self._certifier is None or self._certifier.basis is not space.basis:
            theta, below = space.factor.theta, space.factor.below
            self._certifier = Certifier(
                self.full,
                space.basis,
                space.proofs,
                theta,
                below.sigma,
                float(np.sqrt(self.tolerance)),
                below.factor,
            )
        return self._certifier

    def lacking(self, lowest: int) -> list[Floats]:
        """Return models with two parameters at their lower bounds where modes are missing.

        The modes at the bounds of single parameters are in the basis from the first. A mode of a
        part that is held by several others may enter only where two of these drop together, and
        no search in the basis would ever see that. Where it is not proved that none of the
        ``lowest`` modes does so, a factorisation tells, of the most doubtful models.
        """
        space = self.ready().space
        basis, proofs, doubtful = space.basis, list(space.proofs), []
        for pair in combinations(range(self.nominal.size), 2):
            theta = self.nominal.copy()
            theta[list(pair)] = self.lower[list(pair)]
            try:
                ritz = dense.lowest(basis.K.at(theta), basis.M.at(theta), lowest)
            except ModelError:
                continue
            last = min(lowest, ritz.lam.size - 1) - 1
            if last >= 0 and not knows(basis, proofs, theta, ritz.lam[last]):
                reach = max(reach_of(basis, proof, theta) for proof in proofs) / ritz.lam[last]
                doubtful.append((reach, pair, theta, ritz.lam, last))
        return [
            theta
            for _, _, theta, lam, last in sorted(doubtful, key=lambda entry: entry[:2])[:PROBES]
            if self._misses(basis, theta, lam, last, proofs)
        ]

    def _misses(
        self, basis: Basis, theta: Floats, lam: Floats, last: int, proofs: list[InertiaProof]
    ) -> bool:
        """Return whether modes below the Ritz value of the ``last`` one requested are missing.

        Where that is in doubt, a factor tells, and a proof of the contrary joins the others.
        """
        if knows(basis, proofs, theta, lam[last]):
            return False
        pencil = self.full.pencil
        below, sigma = completeness.gap_above(lam, last)
        try:
            factor = pencil.factor(pencil.K.at(theta).data, pencil.M.at(theta).data, sigma)
        except SingularMatrixError:
            return True
        if factor.negative != below:
            return True
        proofs.append(InertiaProof(theta, sigma, below))
        return False

    def _at_hand(self) -> _Projected | None:
        """Return the matrices in the basis of the requested snapshots, if they are at hand."""
        sent, state = self._sent, self._state
        if sent is not None and sent.snapshots is self._requested:
            return sent
        if state is None or len(state.taken) != len(self._requested) or not self._requested:
            return None
        return self._projected(state) if _begins(self._requested, state.taken) else None

    def _projected(self, state: _State) -> _Projected:
        basis = state.space.basis
        return _Projected(self._requested, basis.K, basis.M, state.sensed)

    def ready(self) -> _State:
        """Return the basis of the requested snapshots; only those not yet in it are computed."""
        if not self._requested:
            self.take(self.first)
        if self._state is not None and not _begins(self._requested, self._state.taken):
            self._state = None
        with uncounted():  # `take` counts a snapshot, once
            while self._state is None or len(self._state.taken) < len(self._requested):
                what = self._requested[len(self._state.taken) if self._state else 0]
                with counted() as costs:
                    taken, space, error = self._added(what)
                last = _TakenSnapshot(what, costs, error)
                self._state = self._sensed((*taken, last), space)
        return self._state

    def _added(self, what: SnapshotRequest) -> tuple[tuple[_TakenSnapshot, ...], _Space, float]:
        """Return the snapshots before another one, the space with it, and the error that it found.

        It is computed with the factor at hand, or with factors of its own. Models that have no
        modes are left out. Raises ModelError where all of them have none.
        """
        taken = self._state.taken if self._state else ()
        rest, solved, corrected, error = what.models, 0, 0, 0.0
        space = self._state.space if self._state else None
        if not space:
            space, corrected = self._solved(None, (), rest.pop(0), what.modes)
            solved, error = 1, np.inf
        elif what.modes == 0:
            space, rest, error = self._excluding(space, rest), [], np.inf
        failed = 0
        while rest:
            correction = self._corrected(space, rest, what)
            if correction:
                space, errors, rest = correction
                corrected += int((errors >= what.enough).sum())
                error = max(error, float(errors.max()))
                continue
            known, proofs = space.basis, space.proofs
            del space
            self._state = self._certifier = None  # its factor makes room for those of the snapshot
            try:
                space, _ = self._solved(known, proofs, rest.pop(0), what.modes)
                solved, error = solved + 1, np.inf
            except ModelError:
                space, failed = self._refactored(known, proofs), failed + 1
                if failed == len(what.models):
                    self._state = self._sensed(taken, space)
                    raise
        spend(Costs(eigenproblems=solved, corrected=corrected))
        return taken, space, error

    def _sensed(self, taken: tuple[_TakenSnapshot, ...], space: _Space) -> _State:
        sensed = np.hstack([self.full.selection @ block for block in space.basis.blocks])
        return _State(taken, space, sensed)

    def _refactored(self, basis: Basis, proofs: tuple[InertiaProof, ...]) -> _Space:
        """Return the space with the factor in whose norm the basis is orthonormal."""
        pencil = self.full.pencil
        K, M = pencil.K.at(basis.theta), pencil.M.at(basis.theta)
        below = Shifted(basis.sigma, pencil.factor(K.data, M.data, basis.sigma))
        return _Space(basis, Factor(basis.theta, below), proofs)

    def _excluding(self, space: _Space, models: list[Floats]) -> _Space:
        """Return the space with directions in which the stiffness of some models is negative.

        Raises ModelError where none is found.
        """
        basis, pencil = space.basis, self.full.pencil
        directions = [unstable(pencil, basis, space.factor, theta) for theta in models]
        some = [X for X in directions if X.shape[1]]
        if not some:
            raise ModelError("no direction of negative stiffness is found")
        basis = extended(pencil, basis, np.hstack(some), self._shortest, self.capacity)
        return _Space(basis, space.factor, space.proofs)

    def _solved(
        self,
        known: Basis | None,
        proofs: tuple[InertiaProof, ...],
        theta: Floats,
        modes: int,
    ) -> tuple[_Space, int]:
        """Return the space with the modes of a full solution, and how many others came with it."""
        started = time.perf_counter()
        pencil, count = self.full.pencil, modes + SPARE
        taken = (
            snapshot(pencil, theta, min(count, self.size)) if known else self._wide(theta, count)
        )
        lowest = taken.modes[:, : self.capacity]  # of directions of equal length, the lowest ones
        basis = extended(
            pencil, known or empty(pencil, taken), lowest, self._shortest, self.capacity
        )
        solved = time.perf_counter()
        spend(Costs(full_time=solved - started))
        factor = Factor(theta, taken.below)
        basis = self._with_derivatives(basis, factor, theta, modes)
        bounds = [] if known else self._bounds(basis, theta, taken.below.sigma)
        basis = self._at_bounds(basis, factor, bounds)
        spend(Costs(corrected_time=time.perf_counter() - solved))
        return _Space(
            basis, factor, (*proofs, InertiaProof(theta, taken.beyond, taken.proved))
        ), len(bounds)

    def _wide(self, theta: Floats, count: int) -> Snapshot:
        """Return the first snapshot, with more modes than are used.

        They may enter from above where several parameters drop, and as long as they do not, they
        spare factorisations: none is missing up to the lowest level to which they may fall.
        """
        count, pencil = max(count, self.count), self.full.pencil
        try:
            return snapshot(pencil, theta, min(WIDE * count, self.size))
        except ModelError:
            return snapshot(pencil, theta, min(count, self.size))

    def _corrected(
        self, space: _Space, models: list[Floats], what: SnapshotRequest
    ) -> tuple[_Space, Floats, list[Floats]] | None:
        """Return the space with modes that need no factor of their own, and the models that do.

        Returned as well are the errors that the models of these modes had. None where all models
        need factors of their own.
        """
        started = time.perf_counter()
        basis, factor, proofs = space.basis, space.factor, list(space.proofs)
        near = [self._is_near(basis, factor, theta, what.modes, proofs) for theta in models]
        here = [theta for theta, is_near in zip(models, near, strict=True) if is_near]
        others = [theta for theta, is_near in zip(models, near, strict=True) if not is_near]
        if not here:
            return None
        new = tuple(proofs[len(space.proofs) :])
        count = what.modes + SPARE if new else what.modes  # all modes that a proof is of
        request = CorrectionRequest(0.0, self._shortest, self.capacity, what.enough)
        try:
            augmented = with_modes(self.full.pencil, basis, factor, here, count, request)
        except ModelError:
            return None  # a larger space sees that a matrix is indefinite
        if augmented is None:
            return None
        basis, errors = augmented
        if errors.max() >= what.enough:
            worst = here[int(errors.argmax())]
            basis = self._with_derivatives(basis, factor, worst, what.modes)
        spend(Costs(corrected_time=time.perf_counter() - started))
        return _Space(basis, factor, (*space.proofs, *new)), errors, others

    def _is_near(
        self, basis: Basis, factor: Factor, theta: Floats, modes: int, proofs: list[InertiaProof]
    ) -> bool:
        """Return whether the factor at hand is of use for a snapshot, and no mode is missing."""
        try:
            ritz = dense.lowest(basis.K.at(theta), basis.M.at(theta), modes)
        except ModelError:
            return False
        return (
            ritz.lam.size >= modes + 2 * SPARE
            and completeness.condition_within(basis.K, basis.M, theta, factor.below.sigma) <= FAR
            and not self._misses(basis, theta, ritz.lam, modes - 1, proofs)
        )

    def _with_derivatives(self, basis: Basis, factor: Factor, theta: Floats, modes: int) -> Basis:
        """Return the basis of some modes with their derivatives."""
        count, half = min(modes, basis.columns - 1), (self.upper - self.lower) / 2
        request = CorrectionRequest(SHARE, self._shortest, self.capacity)
        if count < 1:
            return basis
        return with_derivatives(self.full.pencil, basis, factor, theta, count, half, request)

    def _bounds(self, basis: Basis, theta: Floats, sigma: float) -> list[Floats]:
        """Return the parameters with one of them at a bound, or nearer to ``theta``."""
        out = []
        for i, ends in enumerate(zip(self.lower, self.upper, strict=True)):
            for end in ends:
                for halving in range(HALVINGS + 1):
                    nearby = theta.copy()
                    nearby[i] += (end - theta[i]) / 2**halving
                    if completeness.condition_within(basis.K, basis.M, nearby, sigma) <= FAR:
                        out.append(nearby)
                        break
        return out

    def _at_bounds(self, basis: Basis, factor: Factor, bounds: list[Floats]) -> Basis:
        """Return the basis with the modes at some parameters, for the global search.

        They take no more than half of what is left of the memory.
        """
        capacity = (basis.columns + self.capacity) // 2
        count = min(self.first.modes, basis.columns - SPARE)
        if not bounds or count < 1:
            return basis
        request = CorrectionRequest(SHARE, COARSE, capacity)
        try:
            augmented = with_modes(self.full.pencil, basis, factor, bounds, count, request)
            return augmented[0] if augmented else basis
        except ModelError:  # a larger space sees that a matrix is indefinite at one of them
            for theta in bounds:
                with suppress(ModelError):
                    augmented = with_modes(self.full.pencil, basis, factor, [theta], count, request)
                    basis = augmented[0] if augmented else basis
            return basis

    @property
    def _shortest(self) -> float:
        return SHORTEST * float(np.sqrt(self.tolerance))


def _begins(requests: Sequence[SnapshotRequest], taken: Sequence[_TakenSnapshot]) -> bool:
    """Return whether the requested snapshots begin with those that were taken."""
    return len(taken) <= len(requests) and all(
        entry.what.same(other) for entry, other in zip(taken, requests, strict=False)
    )
