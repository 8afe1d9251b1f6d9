r"""Modes and their exact derivatives for large models, with sparse matrices.

1. A = K + s M is made positive definite: s = 0, or, where K is singular (rigid-body modes), of the
   size of the eigenvalues asked for. Its factor drives a block Lanczos iteration.
2. B = K - sigma M is factored for a sigma in a gap above the last mode asked for. Its number of
   negative eigenvalues is the number of modes below sigma (Sylvester), however many were found:
   this proves that none is missing. It needs a positive semidefinite M.
   Where the basis has lost modes, as those far above the lowest are small beside rounding, all are
   solved for with dense matrices, or the iteration is begun again with a greater s.
3. One step of subspace iteration with B (some in thin shells, where rounding leaves more of unknown
   modes) makes the modes exact to rounding, purges the null space of M from them, and its size
   shows that they have converged.

Source: Ericsson & Ruhe 1980, doi:10.1090/S0025-5718-1980-0583502-2.
"""

from contextlib import suppress
from functools import partial

import numpy as np
import scipy.linalg
from scipy.sparse import csr_array

from modefront._typing import Floats
from modefront.errors import ModelError
from modefront.linalg.factorisation import Factorisation, Pencil, SingularMatrixError
from modefront.linalg.products import combine, gram, times
from modefront.modes import dense
from modefront.modes import derivatives as exact
from modefront.modes.derivatives import Spectrum
from modefront.modes.lanczos import greatest
from modefront.modes.result import FullModes, ModeDerivatives, Modes, SecondDerivatives

BLOCK = 8  # columns of a block: greatest multiplicity of an eigenvalue that is found at once
# Modes beyond those asked for, half of their number or more: sigma is sought in a gap among them.
LEAST = 2
ATTEMPTS = 4  # runs, each with more modes and a larger block, before missing modes are an error
SINGULAR = 1e-13  # x^T A x / x^T diag(A) x below which A is singular to working precision
GAP = 1e-2  # relative gap of eigenvalues that is wide enough for sigma; else the widest is taken
NARROW = 1e-6  # relative gap that is too narrow for sigma: more modes are sought
RESTART = 1e-2  # s over the greatest known eigenvalue, where the iteration is begun again
ALL_AT_ONCE = 3000  # degrees of freedom up to which all modes are solved for where some are lost
BEYOND = 1e3  # eigenvalue up to which modes are counted, over the greatest known one
CONVERGED = 1e-8  # change of a mode in an iteration, after which the next is exact to rounding
# Subspace iterations, after which more modes are sought instead: from an error of 1 to `CONVERGED`
# at 1/3 a step, the factor of the lowest modes at rho = -1.
REFINEMENTS = 17


def modes(
    pencil: Pencil, sensors: csr_array, theta: Floats, count: int, derivatives: bool
) -> Modes:
    """Return the ``count`` lowest modes at the sensors, shape (sensors, N), in ascending order.

    Raises ModelError where K or M is indefinite, where both are singular together, where there
    are fewer modes with a finite frequency than asked for, or where it cannot be proved that none
    was missed.
    """
    spectrum = lowest(pencil, theta, count)
    lam, phi = spectrum.lam[:count], sensors @ spectrum.Phi[:, :count]
    if not derivatives:
        return Modes(lam, phi)
    dlam, dphi, coincident = exact.at_sensors(sensors, spectrum, count)
    solve = partial(exact.everywhere, sensors, spectrum, count)
    # Mode by mode, to bound the memory.
    second = SecondDerivatives(pencil.K, pencil.M, theta, solve, 1)
    return Modes(lam, phi, ModeDerivatives(dlam, dphi, coincident, second))


def full_modes(pencil: Pencil, theta: Floats, count: int, loads: Floats) -> FullModes:
    """Return the ``count`` lowest modes and static responses to loads (N, loads); see `modes`."""
    known, static = lowest(pencil, theta, count), None
    lam = dense.without_rounding(pencil.K.at(theta).diagonal(), known.lam, known.Phi)
    below = known.factors[0]
    if below.sigma == 0 and lam[0] > 0:  # factors take one right-hand side at least
        static = below.solve(np.ascontiguousarray(loads)) if loads.size else loads
    return FullModes(lam[:count], known.Phi[:, :count], static)


def lowest(pencil: Pencil, theta: Floats, count: int) -> Spectrum:
    """Return at least the ``count`` lowest modes, with the factors that found them."""
    K, M = pencil.K.at(theta), pencil.M.at(theta)
    needed, block, least, lost = count + max(LEAST, count // 2), BLOCK, 0.0, False
    for attempt in range(ATTEMPTS):
        needed, block = min(needed, pencil.size), min(block, pencil.size)
        right = np.random.default_rng(attempt).standard_normal((pencil.size, block))
        below, A, start = _positive_definite(pencil, K, M, needed, right, least)
        ritz = greatest(below.solve, A, M, start, needed)
        finite = int(np.sum(ritz.mu > SINGULAR * ritz.mu[0]))
        known = min(ritz.converged, finite)
        lam, X = 1 / ritz.mu[:finite] + below.sigma, ritz.X[:, :known] / np.sqrt(ritz.mu[:known])
        refines = True
        if ritz.complete and (known < count or attempt):
            if known < count and _finite(pencil, K, M, lam) <= known:
                dense.refuse_fewer(known, count)
            # The basis has lost some, whose mu is too small beside the greatest.
            if pencil.size > ALL_AT_ONCE and not lost:
                least, lost = RESTART * float(lam[known - 1]), True
                continue
            if pencil.size > ALL_AT_ONCE:
                break
            everything = dense.decompose(K.toarray(), M.toarray(), count)
            lam, X = everything.lam, everything.Phi
            known, finite, refines = lam.size, lam.size, False
            dense.refuse_fewer(known, count)
        if lam[0] < 1e-2 * below.sigma:
            raise ModelError("the stiffness matrix is indefinite")
        gap = _gap(lam, known, count, -below.sigma, ritz.complete) if known >= count else None
        if gap is not None:
            lower, sigma = gap
            above = pencil.factor(K.data, M.data, sigma)
            if above.negative == lower:
                refined = (
                    _refined(above, M, lam[:known], X, lower) if refines else (lam, X, times(M, X))
                )
                if refined is not None:
                    beyond = lam[refined[0].size] if finite > refined[0].size else np.inf
                    noise = np.asarray(np.finfo(float).eps * (K.diagonal() @ refined[1] ** 2))
                    factors = below, above
                    return Spectrum(pencil, theta, *refined, M, noise, beyond, lower, factors)
        needed, block = 2 * needed, 2 * block
    if lost:
        raise ModelError(
            f"{count} modes asked for, but the eigensolver has lost some of them, after a restart "
            "too, since their frequencies are too far apart: ask for fewer modes"
        )
    raise ModelError(
        f"the lowest {count} modes could not be told from the next ones, or some were missed: "
        "stiffnesses may be too far apart (are lengths, sections and E in one set of units?)"
    )


def _finite(pencil: Pencil, K: csr_array, M: csr_array, lam: Floats) -> int:
    """Return how many modes have a finite frequency, up to far beyond known eigenvalues.

    All have one where M is positive definite; else those below a shift are counted (Sylvester).
    """
    with suppress(SingularMatrixError):
        zeros, positive = np.zeros_like(K.data), M.diagonal().min() > 0
        if positive and pencil.factor(zeros, M.data, -1.0).negative == 0:
            return pencil.size
    try:
        factor = pencil.factor(K.data, M.data, BEYOND * float(lam[-1]))
    except SingularMatrixError:
        return lam.size
    return lam.size if factor.negative is None else factor.negative


def regular_factor(pencil: Pencil, theta: Floats) -> Factorisation | None:
    """Return the factor of a positive definite K(theta); None where it is singular, or indefinite.

    Motions that strain nothing leave an energy of rounding, over that of the diagonal; the softest
    motion of a slender structure of many elements comes near to it, but not that near.
    """
    K, right = pencil.K.at(theta), np.random.default_rng(0).standard_normal((pencil.size, BLOCK))
    return _regular(pencil, K, pencil.M.at(theta), 0.0, right, float(np.finfo(float).eps))[0]


def _gap(lam: Floats, known: int, count: int, s: float, complete: bool) -> tuple[int, float] | None:
    """Return how many modes are below a gap after the first ``count`` ones, and a sigma in it.

    None where there is none; ``complete`` says that there are no modes but the known ones. Gaps
    are relative to lam + s, which is not small for rigid-body modes either.
    """
    if known > count:
        gap = lam[count:known] - lam[count - 1 : known - 1]
        relative = gap / (np.abs(lam[count:known]) + s)
        wide = np.flatnonzero(relative > GAP)
        widest = int(wide[0] if wide.size else np.argmax(relative))
        if relative[widest] > NARROW:
            return count + widest, lam[count - 1 + widest] + 0.2 * gap[widest]
    return (known, lam[known - 1] + max(abs(lam[known - 1]), s)) if complete else None


def _positive_definite(
    pencil: Pencil, K: csr_array, M: csr_array, needed: int, right: Floats, least: float
) -> tuple[Factorisation, csr_array, Floats]:
    """Return the factor of A = K + s M, A, and A^-1 right to begin the Lanczos iteration with.

    s is ``least``, or greater where that leaves A singular.
    """
    factor, start = _regular(pencil, K, M, least, right)
    if factor is not None:
        return factor, K + least * M if least else K, start
    s = dense.SHIFT * K.trace() / M.trace()  # at first: no greater than the eigenvalues at last
    while True:
        factor, start = _regular(pencil, K, M, s, right)
        A = K + s * M
        if factor is None:
            if not start.size:
                raise ModelError("the stiffness matrix is indefinite")
            dof = int(np.argmax(np.abs(start).max(axis=1)))
            raise ModelError(
                "the stiffness and the mass matrix are singular together: "
                f"degree of freedom {dof} (from 0) moves with neither stiffness nor mass"
            )
        ritz = greatest(factor.solve, A, M, start, needed, steps=6)
        finite = ritz.mu > SINGULAR * ritz.mu[0]
        mu, X = ritz.mu[finite], ritz.X[:, finite]
        noise = 1e3 * SINGULAR * (K.diagonal() @ X**2 / mu).max()
        elastic = np.maximum(1 / mu - s, noise)[min(needed, mu.size) - 1 :]
        target = elastic[int(np.argmax(elastic > noise))]
        if target > 0.1 * s:
            return factor, A, start
        s = target


# 6 arguments: the matrices, the right-hand sides and the tolerance.
def _regular(
    pencil: Pencil, K: csr_array, M: csr_array, s: float, right: Floats, singular: float = SINGULAR
) -> tuple[Factorisation | None, Floats]:
    """Return the factor of A = K + s M and A^-1 right, or None unless A is positive definite.

    The solution then shows where A is singular; it is empty where A is indefinite. ``singular`` is
    x^T A x over x^T diag(A) x, below which A counts as singular.
    """
    diagonal = K.diagonal() + s * M.diagonal()
    try:
        factor = pencil.factor(K.data, M.data, -s)
    except SingularMatrixError:
        return None, (diagonal <= diagonal.min())[:, None].astype(float)
    if factor.negative != 0:
        return None, np.zeros((0, right.shape[1]))
    X = factor.solve(right)
    if (np.einsum("nb,nb->b", X, right) < singular * (diagonal @ X**2)).any():
        return None, X
    return factor, X


def _refined(
    above: Factorisation, M: csr_array, lam: Floats, Phi: Floats, needed: int
) -> tuple[Floats, Floats, Floats] | None:
    r"""Return eigenvalues, modes and M times the modes after subspace iteration with B.

    Of the modes beyond the ``needed`` ones, those are left out that would take longer; None where
    the needed ones do not converge.

    A step multiplies the part of an unknown mode u in a mode r by :math:`\rho =
    (\lambda_r - \sigma) / (\lambda_u - \sigma)`. For the modes below :math:`\sigma` that is
    negative, and about -1 or less for the lowest ones: with :math:`\rho \ge 2 t`, all steps but the
    last one are shortened, so that it becomes :math:`(\rho - t) / (1 - t)`, which is between -1 and
    1. The last one is whole, and leaves nothing of the null space of M.
    """
    MPhi = times(M, Phi)
    for _ in range(REFINEMENTS):
        distance = lam - above.sigma
        Y = above.solve(MPhi) * distance
        MY = times(M, Y)
        error = np.sqrt(np.abs(np.einsum("nr,nr->r", Y - Phi, MY - MPhi)))
        B = gram(Y, MPhi) * distance
        distance, Z = scipy.linalg.eigh((B + B.T) / 2, gram(Y, MY))
        lam, X, MX = above.sigma + distance, combine(Y, Z), combine(MY, Z)
        good = error < CONVERGED
        if good[:needed].all():
            keep = lam.size if good.all() else int(np.argmin(good))
            return lam[:keep], X[:, :keep], MX[:, :keep]
        t = np.minimum(distance / distance[-1], 0.0) / 2 if distance[-1] > 0 else 0.0 * distance
        before, Mbefore, length = combine(Phi, Z), combine(MPhi, Z), t / (1 - t)
        known = gram(MX, before)  # the rest of the modes before is what the step took from them
        Phi = X - length * (before - combine(X, known))
        MPhi = MX - length * (Mbefore - combine(MX, known))
    return None
