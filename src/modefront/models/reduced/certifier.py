"""Certificates of the models of a basis: with the factor at hand, or with one of their own."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from modefront._typing import Floats, Ints
from modefront.errors import ModelError
from modefront.linalg.factorisation import Factorisation, SingularMatrixError
from modefront.models.matrices import MatrixModel
from modefront.models.reduced import completeness
from modefront.models.reduced.basis import Basis
from modefront.models.reduced.certificate import (
    Certificate,
    CertificateRequest,
    estimates,
    missing,
    own_estimate,
)
from modefront.models.reduced.corrections import Factor, together
from modefront.modes import dense
from modefront.modes.derivatives import Shifted
from modefront.work.costs import Costs, spend, uncounted
from modefront.work.transfer import shared


@dataclass(frozen=True)
class InertiaProof:
    """The proof that at ``theta`` as many modes as ``count`` are below an eigenvalue."""

    theta: Floats
    beyond: float
    count: int


@shared
@dataclass(eq=False)
class Certifier:
    """Judges the modes of a basis.

    Attributes
    ----------
    full : the model with sparse matrices
    basis : with the model in it
    proofs : what is known of modes that are missing in the basis
    theta, sigma : of the factor of K(theta) - sigma M(theta)
    small : error of a shape that need not be known better, if it is proved to be no greater
    """

    full: MatrixModel
    basis: Basis
    proofs: tuple[InertiaProof, ...]
    theta: Floats
    sigma: float
    small: float = 0.0
    _factor: Factorisation | None = None

    def __getstate__(self) -> dict[str, Any]:
        """Return the state without the factor, which another process computes again."""
        return {**vars(self), "_factor": None}

    @property
    def version(self) -> int:
        """Always the same: nothing in it changes."""
        return 0

    @property
    def footprint(self) -> float:
        """Bytes that the basis takes, and an eigensolution of the full model."""
        return self.full.footprint + sum(block.nbytes for block in self.basis.blocks)

    @property
    def parts(self) -> tuple[MatrixModel]:
        """The full model, which is sent to other processes on its own."""
        return (self.full,)

    @property
    def factor(self) -> Factor:
        """The factor at hand."""
        if self._factor is None:
            pencil = self.full.pencil
            with uncounted():  # it was counted where it was computed first
                K, M = pencil.K.at(self.theta), pencil.M.at(self.theta)
                self._factor = pencil.factor(K.data, M.data, self.sigma)
        return Factor(self.theta, Shifted(self.sigma, self._factor))

    def certify(
        self, requests: Sequence[tuple[Floats, Ints]], lowest: int = 0
    ) -> list[Certificate]:
        """Return the estimated errors of modes at some parameters; see `Certificate`.

        ``requests`` are theta (p,) and the modes in question, counted from 0. Their errors are
        infinite where one of the ``lowest`` modes, or a mode below the requested ones, is missing.
        That is decided by a factorisation where it is in doubt, and what it proves speaks for
        the other models nearby.
        """
        started = time.perf_counter()
        proofs = list(self.proofs)
        counts = [max(lowest, int(indices.max()) + 1) for _, indices in requests]
        width = max(1, together(self.full.size) // (max(counts, default=1) + 1))
        certificates: list[Certificate] = []
        for first in range(0, len(requests), width):
            some = range(first, min(first + width, len(requests)))
            certificates += self._certified([(*requests[k], counts[k]) for k in some], proofs)
        spend(Costs(certificates=len(requests), certificate_time=time.perf_counter() - started))
        return certificates

    def _certified(
        self, some: Sequence[tuple[Floats, Ints, int]], proofs: list[InertiaProof]
    ) -> list[Certificate]:
        """Return the certificates of some models, with the factor at hand where that will do."""
        pencil, sensors = self.full.pencil, self.full.selection
        certificates: dict[int, Certificate] = {}
        shared: dict[int, CertificateRequest] = {}
        for k, (theta, indices, count) in enumerate(some):
            near = _near(self, theta, indices, count, proofs)
            if near is None:
                certificates[k] = self._certified_alone(theta, indices, count, proofs)
            else:
                shared[k] = near
        known = estimates(pencil, sensors, self.basis, self.factor, list(shared.values()))
        for k, entry in zip(shared, known, strict=True):
            certificates[k] = entry or self._certified_alone(*some[k], proofs)
        return [certificates[k] for k in range(len(some))]

    def _certified_alone(
        self, theta: Floats, indices: Ints, count: int, proofs: list[InertiaProof]
    ) -> Certificate:
        """Return the certificate of a model with its own factor, which proves modes complete."""
        basis, pencil = self.basis, self.full.pencil
        try:
            ritz = dense.lowest(basis.K.at(theta), basis.M.at(theta), count + completeness.LATER)
        except ModelError:
            return missing(indices.size)
        gap = completeness.level(ritz.lam, count, basis.sigma, np.inf)
        if gap is None:
            return missing(indices.size)
        below, sigma = gap
        try:
            factor = pencil.factor(pencil.K.at(theta).data, pencil.M.at(theta).data, sigma)
        except SingularMatrixError:
            return missing(indices.size)
        if factor.negative != below:
            return missing(indices.size)
        proofs.append(InertiaProof(theta, sigma, below))
        lam, Y = ritz.lam[:below], ritz.Phi[:, :below]
        request = CertificateRequest(theta, indices, lam, Y, below, sigma, small=self.small)
        return own_estimate(pencil, self.full.selection, basis, request, Shifted(sigma, factor))


def reach_of(basis: Basis, proof: InertiaProof, theta: Floats) -> float:
    """Return the level at ``theta`` below which a proof says that no modes are missing."""
    return completeness.lower_bound(basis.K, basis.M, theta, proof.theta) * proof.beyond


def knows(basis: Basis, proofs: Sequence[InertiaProof], theta: Floats, lam: float) -> bool:
    """Return whether proofs rule out that modes below ``lam`` are missing in the basis."""
    return basis.semidefinite and any(reach_of(basis, proof, theta) > lam for proof in proofs)


def _near(
    by: Certifier, theta: Floats, indices: Ints, count: int, proofs: Sequence[InertiaProof]
) -> CertificateRequest | None:
    """Return the request that the factor at hand can judge; None where modes may be missing."""
    basis = by.basis
    if not basis.semidefinite:
        return None
    try:
        ritz = dense.lowest(basis.K.at(theta), basis.M.at(theta), count + completeness.LATER)
    except ModelError:
        return None
    K, M, shift = basis.K, basis.M, by.sigma
    bounds = completeness.bounds(K, M, theta, by.theta, shift)
    request: CertificateRequest | None = None
    for proof in proofs:
        most = reach_of(basis, proof, theta)
        gap = completeness.level(ritz.lam, count, shift, most)
        proved = int((ritz.lam < most).sum()) == proof.count
        if gap and (request is None or (proved, gap[1]) > (request.proved, request.sigma)):
            below, sigma = gap
            some = below + int(not proved)
            lam, Y = ritz.lam[:some], ritz.Phi[:, :some]
            request = CertificateRequest(
                theta, indices, lam, Y, below, sigma, bounds, proved, by.small
            )
    return request
