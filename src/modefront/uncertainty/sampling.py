r"""Models drawn from the posterior: randomise then optimise, made exact by Metropolis' rule.

docs/uncertainty.md has the equations and the sources. The parameters are functions of standard
normal variables z. About a peak a model of normal variables :math:`\xi` and of variances s of the
errors solves :math:`F(z) = L \xi`. Such models are proposals, independent of where a chain is. F
jumps where measured modes are paired with other modes of the model, and is as invertible there.
Steps of the stochastic Newton method go between, of a length that the warm-up finds. Chains go on
until they agree and the effective sample is large enough. They end at half of their length at most
where none of their halves is worth more than one draw.

Where modes are those of a reduced basis, chains are those of a smaller one, and draws are weighted
by what the whole one says of them: a poor one leaves fewer of them, and these no less exact.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.special import chdtri, gammainc, gammaln, ndtr, ndtri, softmax

from modefront._typing import Floats
from modefront.linalg.affine import first_axis
from modefront.models.reduced.model import ReducedModel
from modefront.optim.problem import Evaluation
from modefront.optim.scalarisation import LogSum
from modefront.optim.sqp import begin, solve
from modefront.residuals.problem import UpdatingProblem
from modefront.rounding import ACCUMULATED
from modefront.uncertainty.prior import FARTHEST, NoiseModel, Standardised
from modefront.work.codec import record
from modefront.work.task import Executor, Task, seed_sequence

DRAWS = 200  # effective draws for intervals: the 5 % quantile is known to 0.15 standard deviations

QUANTILES = (0.05, 0.5, 0.95)  # quantiles of the parameters: a 90 % interval and the median

CHAINS, ROUND, LONGEST = 4, 50, 12  # chains, steps of a round, and of all chains over the draws
AGREE = 1.05  # deviation of all chains over that within them, from which they do not agree
ACCEPTED = 0.35  # share of steps nearby that are taken, below which they become shorter
APART = 1.0  # distance of two models, in standard deviations, below which one leads to the other
FAINT = 1e-3  # probability of a peak over that of the greatest one, below which it is left out
LINEAR = 100, 60  # Gibbs chains of the linear model, and their steps

WIDE = 4.0
"""Proposals that one draw of the linear model takes, from which on there are as many with heavier
tails beside: of variances whose degrees of freedom are divided by this number."""

SMALL, SNAPSHOTS = 100, 40  # columns of a basis that is made smaller, and models that span that
NEAR = 3e-3
"""Length of a direction that the smaller space may lack, root mean square over these models: a
tenth of a usual error of shapes."""

SOLVED, STEPS = 1e-2, 12  # error of the normal variables behind a model, and models to it at most
BENT = 0.5  # length of differences for second derivatives, in standard deviations


def _definite(squares: Floats) -> Floats:
    """Return 1 plus sums of squares (..., p, p), with as much more as rounding may have taken.

    Where modes nearly meet, derivatives of shapes are beyond all bounds.
    """
    more = 1 + ACCUMULATED * np.trace(squares, axis1=-2, axis2=-1)
    return np.asarray(squares + more[..., None, None] * np.eye(squares.shape[-1]))


@dataclass(frozen=True)
class Model:
    """A model, evaluated in the standardised problem, with variances s (n,) of its errors."""

    found: Evaluation
    s: Floats

    @property
    def z(self) -> Floats:
        """Standardised parameters (p,)."""
        return self.found.theta

    @cached_property
    def over(self) -> Floats:
        """One over the variance of each residual, (rows,)."""
        return np.repeat(1 / self.s, [x.r.size for x in self.found.residuals[:-1]])

    @cached_property
    def r(self) -> Floats:
        """Residuals (rows,)."""
        return np.concatenate([x.r for x in self.found.residuals[:-1]])

    @cached_property
    def dr(self) -> Floats:
        """Their derivatives (rows, p)."""
        return np.vstack([x.dr for x in self.found.residuals[:-1]])

    def log_posterior(self, logs: LogSum) -> float:
        """Return ln p of the model and its variances."""
        of_s = (logs.a / 2 + 1) * np.log(self.s) + (self.found.J[:-1] + logs.floor) / (2 * self.s)
        return float(-of_s.sum() - self.found.J[-1] / 2)

    def newton(self, b: float) -> tuple[Floats, Floats]:
        """Return mean (p,) and precision (p, p) of proposals nearby, which leave a Gaussian be."""
        A = _definite(self.dr.T @ (self.over[:, None] * self.dr))
        slope = self.z + self.dr.T @ (self.over * self.r)
        return self.z - (1 - np.sqrt(1 - b**2)) * np.linalg.solve(A, slope), A / b**2


@dataclass(frozen=True)
class Peak:
    """A peak of the posterior, about which models are proposed."""

    at: Evaluation  # the evaluation of the standardised problem there
    logs: LogSum  # -2 ln p of the squares of the residuals, with the variances integrated out
    curved: Floats  # (n, p, p, p) derivatives times second ones of the residuals of each group
    wide: float = 1.0  # what the degrees of freedom of proposed variances are divided by

    @cached_property
    def top(self) -> Model:
        """The model at the peak."""
        return Model(self.at, self.expected)

    @cached_property
    def squares(self) -> Floats:
        """Squares of the derivatives of each group, (n, p, p)."""
        return np.array([x.dr.T @ x.dr for x in self.at.residuals[:-1]])

    @property
    def expected(self) -> Floats:
        """Variances (n,) at the peak."""
        return (self.at.J[:-1] + self.logs.floor) / self.logs.a

    @cached_property
    def free(self) -> Floats:
        """Degrees of freedom (n,) of the variances where parameters are least squares."""
        inverse = np.linalg.inv(self.precision(self.expected))
        q = np.einsum("jk,ikj->i", inverse, self.squares) / self.expected
        return np.maximum(self.logs.a - q, 1.0)

    @cached_property
    def dof(self) -> Floats:
        """Degrees of freedom (n,) of the proposed variances."""
        return np.maximum(self.free / self.wide, 1.0)

    @cached_property
    def scale(self) -> Floats:
        """Scale (n,) of the proposed variances, which are scale / chi-square of `dof`."""
        return self.expected * self.logs.a * self.dof / self.free

    def precision(self, s: Floats) -> Floats:
        """Return A (p, p)."""
        return _definite(first_axis(1 / s[None], self.squares)[0])

    def narrow(self, rng: np.random.Generator) -> bool:
        """Return whether proposals are worth less than 1 / WIDE draws of the linear model each.

        Along a trade-off of two groups the variance of one grows where that of the other shrinks.
        Proposed ones are independent, and hardly ever there: a chain that is there stays for long.
        `weights` are ln p / q, of draws from p by Gibbs' method.
        """
        chains, steps = LINEAR
        V = np.linalg.qr(self.top.dr.T)[0]  # directions that data see
        z, squares = self.at.theta @ V, V.T @ self.squares @ V
        g = np.array([x.dr.T @ x.r for x in self.at.residuals[:-1]]) @ V
        weights: list[Floats] = []
        s = np.tile(self.expected, (chains, 1))
        for _ in range(steps):
            L = np.linalg.cholesky(_definite(first_axis(1 / s, squares)))
            b = np.linalg.solve(L, -(z + 1 / s @ g)[..., None])
            size = np.log(np.diagonal(L, axis1=1, axis2=2)).sum(axis=1)
            size += np.log(s) @ (self.logs.a - self.free) / 2
            weights.append((b**2).sum(axis=(1, 2)) / 2 - size)
            noisy = b + rng.normal(size=b.shape)
            step = np.linalg.solve(L.swapaxes(1, 2), noisy)[..., 0]
            bent = np.einsum("mj,ijk,mk->mi", step, squares, step)
            J = self.at.J[:-1] + 2 * step @ g.T + bent
            s = (J + self.logs.floor) / rng.chisquare(self.logs.a, J.shape)
        above = np.ravel(weights) - np.median(weights)
        return bool(np.logaddexp.reduce(above) > np.log(WIDE * above.size))

    def forward(self, model: Model) -> tuple[Floats, Floats]:
        """Return F (p,) of a model and its derivative (p, p)."""
        G = self.top.dr.T * model.over
        return model.z + G @ model.r, np.eye(len(G)) + G @ model.dr

    def behind(self, model: Model) -> Floats:
        """Return the normal variables (p + n,) behind a model."""
        xi = np.linalg.solve(np.linalg.cholesky(self.precision(model.s)), self.forward(model)[0])
        return np.append(xi, ndtri(gammainc(self.dof / 2, self.scale / model.s / 2)))

    def log_density(self, model: Model) -> float:
        """Return ln q of a model and its variances."""
        F, slope = self.forward(model)
        L, s, half = np.linalg.cholesky(self.precision(model.s)), model.s, self.dof / 2
        xi, size = np.linalg.solve(L, F), np.linalg.slogdet(slope)[1]
        size -= np.log(L.diagonal()).sum() + xi @ xi / 2
        of_s = half * np.log(self.scale / 2) - gammaln(half) - (half + 1) * np.log(s)
        return float(size + (of_s - self.scale / (2 * s)).sum())

    def reaches(self, target: Standardised, model: Model) -> bool:
        """Return whether the normal variables behind a model lead to it, and to no other one."""
        here = Model(self.at, model.s)
        _, step, bend = self.first(here, self.forward(model)[0] - self.forward(here)[0])
        # Newton's method is only asked where its first step does not end near the model.
        away = here.z + step + bend - model.z
        if np.abs(step).max() <= 1 and away @ self.precision(model.s) @ away < APART**2:
            return True
        found = self.model(target, self.behind(model))
        return found is not None and np.abs(found.z - model.z).max() < np.sqrt(SOLVED)

    def first(self, here: Model, missing: Floats) -> tuple[Floats, Floats, Floats]:
        """Return the inverse (p, p) of F's derivative at the peak, a step (p,), and its bend."""
        inverse = np.asarray(np.linalg.inv(self.forward(here)[1]), dtype=float)
        step = inverse @ missing
        curved = 1 / here.s @ (self.curved @ step @ step)
        return inverse, step, inverse @ curved / -2

    def model(self, target: Standardised, u: Floats) -> Model | None:
        """Return the model of normal variables (p + n,) by Newton's method; None without one.

        Steps become shorter until the next one does (Deuflhard's natural monotonicity). The first
        one is bent as second derivatives say.
        """
        p = self.at.theta.size
        below = ndtr(np.clip(-u[p:], -FARTHEST, FARTHEST))
        here = Model(self.at, self.scale / chdtri(self.dof, below))
        L = np.linalg.cholesky(self.precision(here.s))
        inverse, step, bend = self.first(here, L @ u[:p] - self.forward(here)[0])
        share = 1 / max(1.0, np.abs(step).max())
        for _ in range(STEPS):
            there = Model(target.evaluate(here.z + share * step + share**2 * bend), here.s)
            if there.found.feasible:
                F, slope = self.forward(there)
                missing = L @ u[:p] - F
                if np.linalg.norm(np.linalg.solve(L, missing)) < SOLVED:
                    return there
                if np.linalg.norm(inverse @ missing) <= (1 - share / 4) * np.linalg.norm(step):
                    inverse = np.asarray(np.linalg.inv(slope), dtype=float)
                    here, step, bend = there, inverse @ missing, np.zeros(p)
                    share = 1 / max(1.0, np.abs(step).max())
                    continue
            share /= 4
        return None


@dataclass(frozen=True)
class Draws:
    """Models drawn from the posterior, with what they predict."""

    theta: Floats  # (draws, p) parameters
    frequency: Floats  # frequency, mac: (draws, modes) of the most likely pairs of measured modes
    mac: Floats
    r_hat: Floats  # r_hat, effective: (p,) R-hat of the chains, and the effective number of draws
    effective: Floats
    settled: bool = True  # whether the chains agree, and are long enough for intervals


@record
@dataclass(frozen=True)
class Chain:
    """A round of a chain."""

    z: Floats  # (steps, p) standardised parameters
    s: Floats  # (n,) variances at its end
    length: float  # b of proposals nearby


def extent(count: int) -> tuple[int, int]:
    """Return how many steps all chains take for so many effective draws, from and to."""
    return 2 * CHAINS * ROUND, CHAINS * ROUND + LONGEST * count


# 6 arguments: what is drawn from, how many, and how.
def draw_models(
    noise: NoiseModel,
    maxima: Sequence[Floats],
    count: int,
    seed: int,
    work: Executor,
    rounds: int | None = None,
) -> Draws:
    """Return models drawn from the posterior, of which all known ``maxima`` (p,) are given.

    They are as many as asked for, and as the chains have steps at most. Chains have ``rounds`` at
    most; None for as many as so many effective draws may take.
    """
    stage = "sample-posterior"
    tasks = [Task(("peaks", k + 1), find_peak, (noise, x)) for k, x in enumerate(maxima)]
    peaks = mixture(noise, work.run(tasks))
    chains: Sequence[Chain | None] = [None] * CHAINS
    kept: list[Floats] = []
    rng = np.random.default_rng(seed_sequence(seed, stage, "wide"))
    peaks += [replace(x, wide=WIDE) for x in peaks if x.narrow(rng)]
    rng = np.random.default_rng(seed_sequence(seed, stage, "near"))
    around = [peaks[k].top.newton(1.0) for k in rng.choice(len(peaks), SNAPSHOTS)]
    near = _nearer(noise, np.array([_drawn(mean, A, rng) for mean, A in around]), 0, work)
    settled = False
    rounds = rounds or -(-LONGEST * count // (CHAINS * ROUND))
    work.expect({stage: (2 * CHAINS, (1 + rounds) * CHAINS)})
    for turn in range(1 + rounds):
        steps = []
        for k, chain in enumerate(chains):
            key, of = (stage, k + 1, turn + 1), (near, peaks, chain)
            steps.append(Task(key, _advanced, of, seed_sequence(seed, *key)))
        chains = found = work.run(steps)
        if turn == 0:  # the warm-up
            if near is not noise:
                some = np.vstack([x.z[:: CHAINS * ROUND // SNAPSHOTS] for x in found])
                near = _nearer(noise, some, 1, work)
            continue
        kept.append(np.array([x.z for x in found]))
        r_hat, sizes = agreement(np.concatenate(kept, axis=1))
        size = float(sizes.min())
        settled = bool(r_hat.max() < AGREE) and size >= count / 2
        stuck = 2 * len(kept) >= rounds and size <= 2 * CHAINS
        if stuck or len(kept) == rounds or (settled and size >= count):
            break
        more_rounds = np.ceil(len(kept) * max(count / size - 1, 0.0))  # effective draws add up
        # To expect half as many again is as wrong as the size may be of few rounds.
        most = int(np.clip(2 * more_rounds, 1, rounds - len(kept)))
        work.expect({stage: (CHAINS, CHAINS * most)})
    z = np.concatenate(kept, axis=1).reshape(-1, near.problem.start.size)
    rng = np.random.default_rng(seed_sequence(seed, stage, "order"))
    order = np.linspace(0, len(z) - 1, min(count, len(z))).round().astype(int)
    z = rng.permutation(z[order])
    theta, frequency, mac, share = _counted(noise, near, z, work)
    effective = np.minimum(sizes, count) * share
    settled = settled and bool(effective.min() >= count / 2)
    return Draws(theta, frequency, mac, r_hat, effective, settled)


def _counted(
    noise: NoiseModel, near: NoiseModel, z: Floats, work: Executor
) -> tuple[Floats, Floats, Floats, float]:
    """Return theta, frequency and MAC of draws z (n, p), and the share that counts.

    They are from the posterior ``near`` this one: each is there as often as its weight says.
    """
    some = enumerate(np.array_split(z, CHAINS))
    key = "draws", len(z)
    parts = work.run([Task((*key, k + 1), _weighed, (noise, near, x)) for k, x in some])
    theta, frequency, mac, weight = (np.concatenate(x) for x in zip(*parts, strict=True))
    w = softmax(weight)
    # of equal weights, each draw once
    chosen = np.searchsorted(np.cumsum(w), (np.arange(len(z)) + 0.5) / len(z))
    return theta[chosen], frequency[chosen], mac[chosen], float(1 / (w @ w) / len(z))


def _weighed(noise: NoiseModel, near: NoiseModel, z: Floats) -> tuple[Floats, ...]:
    """Return parameters (n, p), paired frequencies and MAC values, and weights (n,) of draws z.

    A weight is the logarithm of this posterior over the one ``near`` it.
    """
    theta = np.array([Standardised(noise.problem).theta(x)[0] for x in z])
    there = [near.problem.evaluate(x, derivatives=False) for x in theta]
    same = near is noise
    here = there if same else [noise.problem.evaluate(x, derivatives=False) for x in theta]
    pairs = list(zip(there, here, strict=True))
    frequency, mac = (
        np.array([(y.quantities or x.quantities).get(name, ()) for x, y in pairs])
        for name in ("frequency", "mac")
    )
    weight = [(noise.logs.value(x.J) - noise.logs.value(y.J)) / 2 for x, y in pairs]
    return theta, frequency, mac, np.array(weight)


def _nearer(noise: NoiseModel, z: Floats, number: int, work: Executor) -> NoiseModel:
    """Return the posterior in the space of the modes at standardised parameters z (models, p).

    Modes above all those that are paired are left out. The same where the model is not a reduced
    one, its basis is small, or this space not much less.
    """
    problem = noise.problem
    if not isinstance(problem.model, ReducedModel):
        return noise
    theta = np.array([Standardised(problem).theta(x)[0] for x in z])
    (V,) = work.run([Task(("space", number), _space, (problem, theta))])
    if len(V) < SMALL or 2 * V.shape[1] > len(V):
        return noise
    return replace(noise, problem=replace(problem, model=problem.model.within(V)))


def _space(problem: UpdatingProblem, theta: Floats) -> Floats:
    """Return the coordinates of that space in the basis, see `ReducedModel.space`."""
    model = problem.model
    assert isinstance(model, ReducedModel)
    found = [problem.evaluate(x, derivatives=False).quantities for x in theta]
    used = max((int(np.max(x["paired_mode"])) for x in found if x), default=model.count)
    return model.space(theta, used, NEAR)


def find_peak(noise: NoiseModel, theta: Floats) -> tuple[Evaluation, Floats]:
    """Return the peak of the posterior of standardised parameters below a model theta (p,).

    With it comes `Peak.curved`, by differences along its axes; 0 along those without any.
    """
    target = Standardised(noise.problem)
    start = target.evaluate(np.clip(target.z(theta), -2.0, 2.0))
    at = solve(target, noise.programme, begin(start)).evaluation
    peak = Peak(at, noise.logs, np.zeros(0))
    L = np.linalg.cholesky(peak.precision(peak.expected))
    changes = np.zeros((at.theta.size, *peak.squares.shape))  # axes, n, p, p
    for change, axis in zip(changes, np.linalg.inv(L), strict=True):
        found = target.evaluate(at.theta + BENT * axis)
        if found.feasible:
            pairs = zip(at.residuals[:-1], found.residuals[:-1], strict=True)
            change[:] = [x.dr.T @ (y.dr - x.dr) / BENT for x, y in pairs]
    return at, np.tensordot(changes, L.T, axes=(0, 0))


def mixture(noise: NoiseModel, found: Sequence[tuple[Evaluation, Floats]]) -> list[Peak]:
    """Return the peaks that count, each once."""
    peaks: list[Peak] = []
    for at, curved in sorted(found, key=lambda x: noise.programme.value(x[0].J)):
        new = Peak(at, noise.logs, curved)
        others = [Model(y.at, new.expected) for y in peaks]
        ways = [new.behind(y) - new.behind(new.top) for y in others]
        near = [y for y, way in zip(others, ways, strict=True) if np.linalg.norm(way) <= APART]
        if not any(new.reaches(Standardised(noise.problem), y) for y in near):
            peaks.append(new)
    value = [noise.programme.value(x.at.J) for x in peaks]
    size = [np.linalg.slogdet(x.precision(x.expected))[1] for x in peaks]
    share = softmax(-(np.array(value) + np.array(size)) / 2)
    return [x for x, v in zip(peaks, share.tolist(), strict=True) if v > FAINT * share.max()]


def _advanced(
    noise: NoiseModel, peaks: Sequence[Peak], chain: Chain | None, *, rng: np.random.Generator
) -> Chain:
    """Return the next round of a chain; the first one adapts the lengths of steps."""
    target = Standardised(noise.problem)
    of, out = Sampler(target, noise.logs, peaks), []
    if chain is None:
        top = peaks[rng.choice(len(peaks))].top
        z, s, length = top.z, top.s, 1.0
    else:
        z, s, length = chain.z[-1], chain.s, chain.length
    here = Model(target.evaluate(z), s)
    for t in range(ROUND):
        here = of.across(here, rng)
        # The variances are drawn between both kinds of steps.
        s = (here.found.J[:-1] + noise.logs.floor) / rng.chisquare(noise.logs.a)
        here, chance = of.nearby(Model(here.found, s), length, rng)
        out.append(here.z)
        if chain is None:
            length = min(length * float(np.exp((chance - ACCEPTED) / np.sqrt(1 + t / 4))), 1.0)
    return Chain(np.array(out), here.s, length)


@dataclass(frozen=True)
class Sampler:
    """Transitions that leave the posterior as it is."""

    target: Standardised
    logs: LogSum
    peaks: Sequence[Peak]

    def across(self, here: Model, rng: np.random.Generator) -> Model:
        """Return the model after a step to one that is independent of it."""
        k = int(rng.choice(len(self.peaks)))
        new = self.peaks[k].model(self.target, rng.normal(size=here.z.size + here.s.size))
        if new is None:
            return here
        ahead, aback = (np.array([x.log_density(y) for x in self.peaks]) for y in (new, here))
        gain = new.log_posterior(self.logs) - here.log_posterior(self.logs) - np.log(rng.random())
        # Whether peaks lead to a model is only asked where it may decide.
        if gain + np.logaddexp.reduce(aback) <= ahead[k]:
            return here
        gain += self.log_density(here, aback)
        taken = np.isfinite(gain) and gain > self.log_density(new, ahead, k)
        return new if taken else here

    def log_density(self, model: Model, each: Floats, by: int = -1) -> float:
        """Return the logarithm of the sum of what peaks propose, ``by`` one of them or not.

        ``each`` (peaks,) is what each says. It is minus infinity where none leads to the model.
        """
        out, least = -np.inf, each.max() + np.log(FAINT)
        for k, (q, peak) in enumerate(zip(each.tolist(), self.peaks, strict=True)):
            if k == by or (q > least and peak.reaches(self.target, model)):
                out = np.logaddexp(out, q)
        return float(out)

    def nearby(self, here: Model, b: float, rng: np.random.Generator) -> tuple[Model, float]:
        """Return the model after a step of the stochastic Newton method, and its probability."""
        mean, precision = here.newton(b)
        z = _drawn(mean, precision, rng)
        new = Model(self.target.evaluate(z), here.s)
        if not new.found.feasible:
            return here, 0.0
        back, behind = new.newton(b)
        ahead, aback = z - mean, here.z - back
        ratio = np.linalg.slogdet(behind)[1] - np.linalg.slogdet(precision)[1]
        ratio += ahead @ precision @ ahead - aback @ behind @ aback
        change = new.log_posterior(self.logs) - here.log_posterior(self.logs) + float(ratio) / 2
        chance = float(np.exp(min(change, 0.0)))
        return (new if rng.random() < chance else here), chance


def _drawn(mean: Floats, precision: Floats, rng: np.random.Generator) -> Floats:
    """Return a draw (p,) from a Gaussian."""
    return mean + np.linalg.solve(np.linalg.cholesky(precision).T, rng.normal(size=mean.size))


def agreement(x: Floats) -> tuple[Floats, Floats]:
    """Return R-hat and the effective size of chains (chains, steps, p), both (p,).

    R-hat is that of ranks, or of ranks of the distance from the median, whichever is worse; the
    size is that of ranks, or for one of the ends of an interval, whichever is least. Each chain
    counts as two halves.
    """
    half = x.shape[1] // 2
    halves = np.concatenate([x[:, :half], x[:, -half:]])
    halves = halves.reshape(len(halves), half, -1)
    both = np.concatenate([halves, np.abs(halves - np.median(halves, axis=(0, 1)))], axis=2)
    each = both.reshape(-1, both.shape[2]).T
    places = [np.searchsorted(np.sort(x), [x, np.nextafter(x, np.inf)]) for x in each]
    ranks = (np.sum(places, axis=1).T + 1) / 2  # the mean one of those that are the same
    y = ndtri((ranks - 0.375) / (len(ranks) + 0.25)).reshape(both.shape)
    below = [halves <= end for end in np.quantile(halves, QUANTILES[::2], axis=(0, 1))]
    y = np.concatenate([y, *below], axis=2)
    within = y.var(axis=1, ddof=1).mean(axis=0)
    total = within * (half - 1) / half + y.mean(axis=1).var(axis=0, ddof=1)
    centred = y - y.mean(axis=1, keepdims=True)
    spectrum = np.abs(np.fft.rfft(centred, 2 * half, axis=1)) ** 2
    covariance = np.fft.irfft(spectrum, axis=1)[:, :half].mean(axis=0) / half
    rho = 1 - (within - covariance) / np.maximum(total, 1e-300)
    rho[0] = 1.0
    pairs = rho[: half // 2 * 2].reshape(half // 2, 2, -1).sum(axis=1)
    pairs = np.minimum.accumulate(np.where(np.cumprod(pairs > 0, axis=0), pairs, 0.0), axis=0)
    tau = np.maximum(2 * pairs.sum(axis=0) - 1, 1 / np.log10(len(ranks)))
    ratio = np.sqrt(total / np.maximum(within, 1e-300))
    of_ranks, _, *of_ends = (len(ranks) / tau).reshape(4, -1)
    return ratio.reshape(4, -1)[:2].max(axis=0), np.minimum(of_ranks, np.min(of_ends, axis=0))
