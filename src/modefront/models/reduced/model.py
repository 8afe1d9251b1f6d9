"""A model that solves a sparse one a few times, and a small one in their place after that."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from modefront._typing import Floats, Ints
from modefront.errors import ModelError
from modefront.models.base import Counts
from modefront.models.matrices import MatrixModel
from modefront.models.reduced import window
from modefront.models.reduced.basis import Basis, extended, first, snapshot
from modefront.models.reduced.certificate import STEPS, Certificate, estimate
from modefront.modes import dense
from modefront.modes.factorisation import SingularMatrixError
from modefront.modes.products import combine
from modefront.modes.result import Modes
from modefront.modes.spectrum import Shifted

SHORTEST = 0.1
"""Length of the shortest direction of the basis, over the square root of the tolerance."""

SPARE = 2
"""Modes in the basis beyond those that are used, without derivatives: they may enter later."""


@dataclass(frozen=True)
class _Taken:
    """A snapshot in the basis: where, up to which eigenvalue all modes are known, what it cost."""

    theta: Floats
    beyond: float
    cost: Counts


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
    memory : bytes that the basis may take
    """

    full: MatrixModel
    count: int
    nominal: Floats
    lower: Floats
    upper: Floats
    tolerance: float = 1e-8
    memory: float = 4 * 2.0**30
    counts: Counts = field(default_factory=Counts)
    _wanted: list[Floats] = field(default_factory=list)
    _taken: list[_Taken] = field(default_factory=list)
    _basis: Basis | None = None
    _below: Shifted | None = None

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
    def unused(self) -> tuple[str, ...]:
        """Names of parameters on which neither matrix depends."""
        return self.full.unused

    @property
    def capacity(self) -> int:
        """Columns that the basis may have."""
        return int(self.memory // (8 * self.size))

    @property
    def is_full(self) -> bool:
        """Whether the memory leaves no room for another mode."""
        return self._basis is not None and self._basis.columns >= self.capacity

    @property
    def snapshots(self) -> tuple[Floats, ...]:
        """Parameters of the snapshots."""
        return tuple(self._wanted)

    def resume(self, snapshots: Sequence[Floats]) -> None:
        """Use these snapshots, which were paid for before; they are computed when needed."""
        self._wanted = list(snapshots)

    def take(self, theta: Floats) -> None:
        """Add a snapshot. Raises ModelError where the model has no modes there."""
        self._wanted.append(theta)
        try:
            self._build()
        except ModelError:
            self._wanted.pop()
            raise
        cost = self._taken[-1].cost
        self.counts.eigenproblems += cost.eigenproblems
        self.counts.factorisations += cost.factorisations

    def modes(self, theta: Floats, count: int, *, derivatives: bool = True) -> Modes:
        """Return the ``count`` lowest modes at ``theta``; see `modefront.models.base.Model`."""
        if count > self.count:
            return self._in_full(theta, count, derivatives)
        basis = self._ready()
        started = time.perf_counter()
        self.counts.reduced += 1
        found = dense.modes(basis.K, basis.M, self._sensed, theta, count, derivatives)
        self.counts.reduced_time += time.perf_counter() - started
        return found

    def certify(self, theta: Floats, wanted: Ints, *, quick: bool = False) -> Certificate:
        """Return how wrong the ``wanted`` modes are, counted from 0; see `Certificate`.

        Their errors are infinite where a mode below them is missing. That is looked for by a
        factorisation where it is in doubt. A ``quick`` certificate does not look for missing
        modes, and takes only the first term of the estimate.
        """
        basis = self._ready()
        started = time.perf_counter()
        ritz = dense.decompose(basis.K.at(theta), basis.M.at(theta))
        lam = ritz.lam
        low = min(lam.size, self.count + SPARE)
        K, M = self.full.pencil.K.at(theta), self.full.pencil.M.at(theta)
        if not quick and self._misses(theta, lam, int(wanted.max())):
            nothing = np.full(wanted.size, np.inf)
            return Certificate(nothing, np.ones(wanted.size))
        Phi = combine(basis.V, ritz.Phi[:, :low])
        found = estimate(K, M, lam[:low], Phi, wanted, self._below, 1 if quick else STEPS)
        self.counts.certificates += 1
        self.counts.certificate_time += time.perf_counter() - started
        return found

    def _misses(self, theta: Floats, lam: Floats, last: int) -> bool:
        """Return whether modes below the Ritz value of the ``last`` one wanted are missing."""
        K, M = self._ready().K, self._ready().M
        if window.semidefinite(K) and window.semidefinite(M):
            for one in self._taken:
                if window.lower_bound(K, M, theta, one.theta) * one.beyond > lam[last]:
                    return False
        below, sigma = window.gap_above(lam, last)
        pencil = self.full.pencil
        before = self.full.counts.factorisations
        try:
            factor = pencil.factor(pencil.K.at(theta).data, pencil.M.at(theta).data, sigma)
        except SingularMatrixError:
            return True
        self.counts.factorisations += self.full.counts.factorisations - before
        return factor.negative != below

    def _in_full(self, theta: Floats, count: int, derivatives: bool) -> Modes:
        before = self.full.counts.factorisations
        found = self.full.modes(theta, count, derivatives=derivatives)
        self.counts.eigenproblems += 1
        self.counts.factorisations += self.full.counts.factorisations - before
        return found

    def _ready(self) -> Basis:
        if not self._wanted:
            self.take(self.nominal)
        return self._build()

    def _build(self) -> Basis:
        """Return the basis of the snapshots wanted; only those not yet in it are computed."""
        held = [one.theta for one in self._taken]
        same = len(held) <= len(self._wanted)
        same &= all(np.array_equal(a, b) for a, b in zip(held, self._wanted, strict=False))
        if not same:
            self._basis, self._below, self._taken = None, None, []
        shortest = SHORTEST * np.sqrt(self.tolerance)
        for theta in self._wanted[len(self._taken) :]:
            self._below = None  # the factors of the new snapshot take its place
            started, before = time.perf_counter(), self.full.counts.factorisations
            half = (self.upper - self.lower) / 2
            one = snapshot(self.full.pencil, theta, min(self.count, self.size), SPARE, half)
            if self._basis is None:
                self._basis = first(self.full.pencil, one, shortest, self.capacity)
            else:
                self._basis = extended(
                    self.full.pencil, self._basis, one.vectors, shortest, self.capacity
                )
            self._below = one.below
            self._sensed = np.asarray(self.full.selection @ self._basis.V)
            cost = Counts(1, self.full.counts.factorisations - before)
            self._taken.append(_Taken(theta, one.beyond, cost))
            self.counts.full_time += time.perf_counter() - started
        if self._basis is None:
            raise RuntimeError("a reduced model has at least one snapshot")
        return self._basis
