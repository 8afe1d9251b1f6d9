"""How often 90 % intervals of parameters hold the truth, in random simulated tests.

    python benchmarks/calibration.py --seeds 1000:1100 [--draws 200] [--wrong] [--few] [--bricks]
                                     [--quiet]
    python benchmarks/calibration.py --seeds 1000:1100 --prior [--quiet]
    python benchmarks/calibration.py --seeds 1000:1030 --setups

Seeds 1000 to 1999 are for development. Seeds from 9000 on are for judgement: nobody tunes
anything on them, and ``--quiet`` prints their rates only.

Each seed is a chain with springs to the ground, a sway frame or a lattice, of 2 to 20 stiffness
parameters, with 2 to 8 modes at 2 to 12 sensors in 1 to 4 data sets; frequencies have errors of 0.2
to 3 %, shapes of 1 to 5 % of their greatest component. The errors that are expected are the true
ones, twice or half of these, in columns ``_std`` or in ``[noise]``. With ``--wrong`` the members of
a parameter vary by 5 to 10 % about its true value, or springs are missing in the model. With
``--few`` there are two or three sensors, which hardly tell modes apart. With ``--bricks`` it is a
plate or a block of solid elements, clamped at one end. With ``--prior`` the truth and the variances
of the errors are drawn from their priors, and the ranks of the truth among the draws are counted:
they are uniform where draws are from the posterior (simulation-based calibration, Talts et al.
2018, arXiv:1804.06788). No test is left out then. With ``--setups`` the modes are those that are
identified of simulated ambient tests of chains of 4 to 6 springs, each a parameter, in 2 or 3
setups with one or two references; studies take the covariances of shapes, or the deviations alone,
and the widths of intervals are compared.

``held`` is the share of parameters of which the interval holds the truth, ``old`` that of Laplace's
approximation about optimal weights, where these exist. ``next f`` are the frequencies of the first
mode that is not measured, which the draws predict; they are in no other rate. ``far`` are the
parameters that are called determined and are off by more than 5 standard deviations, ``worst`` is
the farthest of these. Tests of which the verdict says that no model is to be used are counted, and
are in no rate.
"""

from __future__ import annotations

import argparse
import itertools
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.signal
import scipy.stats

import modefront as mf
from modefront._typing import Floats
from modefront.data.modal_test import Records
from modefront.front.weights import accepted
from modefront.identification.methods import ambient
from modefront.identification.sets import combine
from modefront.optim.lexicographic import EXACT
from modefront.optim.problem import with_second_order
from modefront.optim.scalarisation import LogSum
from modefront.optim.sqp import TIGHT, begin, solve
from modefront.results.assemble import DETERMINED
from modefront.uncertainty.inference import CHANCE, chances, most_probable, refused
from modefront.uncertainty.prior import NoisePrior
from modefront.uncertainty.sampling import DRAWS, draw_models
from modefront.uncertainty.scatter import laplace
from modefront.work.task import IMMEDIATE

BOUNDS = (0.3, 3.0)
STARTS = 6
BINS = 10
WEIGHT = NoisePrior().weight


@dataclass(frozen=True)
class Verdict:
    """What is known of a parameter: its classes, and how far its truth is."""

    classes: tuple[str, ...]
    held: bool
    old: bool | None
    away: float
    determined: bool
    width: float


def spring(N: int, i: int, j: int = -1) -> Floats:
    """Return the stiffness of a spring of 1 between degrees of freedom, or to the ground."""
    v = np.zeros(N)
    v[i] = 1.0
    if j >= 0:
        v[j] = -1.0
    return np.outer(v, v)


def members(kind: str, rng: np.random.Generator) -> tuple[int, list[Floats]]:
    """Return the degrees of freedom of a structure and its members, those near each other first."""
    if kind == "chain":
        N = int(rng.integers(6, 25))
        out = [spring(N, i, i - 1) for i in range(N)]
        return N, [K * rng.uniform(0.7, 1.4) for K in out] + [0.1 * spring(N, N - 1)]
    if kind == "frame":  # stories of two columns and a floor with a rotation each
        n = int(rng.integers(3, 9))
        N = 2 * n
        out = []
        for k in range(n):
            for side in (0.8, 1.2):
                v = np.zeros((2, N))
                v[0, 2 * k], v[0, 2 * k + 1] = 1.0, 0.5
                v[1, 2 * k + 1] = 1.0
                if k:
                    v[0, 2 * k - 2], v[0, 2 * k - 1] = -1.0, 0.5
                    v[1, 2 * k - 1] = -1.0
                out.append(side * (12 * np.outer(v[0], v[0]) + np.outer(v[1], v[1])))
            out.append(3 * spring(N, 2 * k + 1))
        return N, out
    a, b = (int(x) for x in rng.integers(3, 6, 2))
    N = a * b
    out = []
    for i in range(a):
        for j in range(b):
            here = i * b + j
            out += [spring(N, here, here + 1)] if j + 1 < b else [spring(N, here)]
            out += [1.5 * spring(N, here, here + b)] if i + 1 < a else [0.7 * spring(N, here)]
    return N, out


def brick(size: Floats) -> Floats:
    """Return the stiffness (24, 24) of a solid element with eight nodes, Young's modulus 1."""
    nu = 0.3
    D = np.diag([1 - 2 * nu] * 3 + [0.5 - nu] * 3)
    D[:3, :3] += nu
    D /= (1 + nu) * (1 - 2 * nu)
    corners = np.array(list(itertools.product((-1, 1), repeat=3)))
    K = np.zeros((24, 24))
    for at in corners / np.sqrt(3):
        factors = 1 + corners * at
        slopes = [corners[:, k] * np.delete(factors, k, 1).prod(axis=1) / 8 for k in range(3)]
        x, y, z = 2 / size[:, None] * slopes
        B, no = np.zeros((6, 8, 3)), np.zeros(8)
        B[:3, :, :] = np.array([[x, no, no], [no, y, no], [no, no, z]]).transpose(0, 2, 1)
        B[3:, :, :] = np.array([[y, x, no], [no, z, y], [z, no, x]]).transpose(0, 2, 1)
        flat = B.reshape(6, 24)
        K += flat.T @ D @ flat * size.prod() / 8
    return K


def bricks(kind: str, rng: np.random.Generator) -> tuple[int, list[Floats]]:
    """Return the degrees of freedom of a plate or a block clamped at one end, and its elements."""
    least, most = ((3, 3, 1), (6, 5, 1)) if kind == "plate" else ((3, 1, 1), (6, 2, 2))
    count = rng.integers(least, most, endpoint=True)
    size = rng.uniform(0.7, 1.4, 3) * (1, 1, 0.15 if kind == "plate" else 0.7)
    number = np.arange(np.prod(count + 1)).reshape(count + 1)
    clamped = number[0].size
    N, K, out = 3 * (number.size - clamped), brick(size), list[Floats]()
    for place in itertools.product(*map(range, count)):
        nodes = number[tuple(slice(k, k + 2) for k in place)].ravel() - clamped
        dofs = (3 * nodes[:, None] + np.arange(3)).ravel()
        free = dofs >= 0
        own = np.zeros((N, N))
        own[np.ix_(dofs[free], dofs[free])] = K[np.ix_(free, free)]
        out.append(own)
    return N, out


# 62 lines: one choice after the other.
def case(
    seed: int, wrong: bool = False, few: bool = False, prior: bool = False, solid: bool = False
) -> tuple[mf.UpdatingProblem, NoisePrior, Floats, tuple[str, ...]]:
    """Return a simulated test, what is expected of its errors, the truth and its classes."""
    rng = np.random.default_rng(seed)
    kind = str(rng.choice(["plate", "block"] if solid else ["chain", "frame", "lattice"]))
    N, parts = (bricks if solid else members)(kind, rng)
    p = min(int(rng.integers(2, 21)), len(parts))
    owner = np.sort(np.append(np.arange(p), rng.integers(0, p, len(parts) - p)))
    names = tuple(f"k{j}" for j in range(p))
    truth = rng.uniform(*BOUNDS, p) if prior else rng.uniform(0.6, 1.6, p)
    factors = truth[owner]
    if wrong and rng.random() < 0.7:
        share = rng.uniform(0.05, 0.1)
        for j in range(p):
            own = owner == j
            vary = rng.normal(size=own.sum())
            factors[own] *= 1 + share * (vary - vary.mean())
    scale, mass = 1e4, rng.uniform(0.8, 1.2, N)
    K = scale * sum(f * part for f, part in zip(factors, parts, strict=True))
    if wrong and rng.random() < 0.4:
        K = K + 0.03 * scale * spring(N, int(rng.integers(N)))
    stiffness = {
        name: scale * sum(part for part, o in zip(parts, owner, strict=True) if o == j)
        for j, name in enumerate(names)
    }
    count = int(rng.integers(2, 13))
    sensors = rng.choice(N, 2 + count % 2 if few else min(count, N), replace=False)
    places = {f"s{i}": int(i) for i in np.sort(sensors)}
    model = mf.matrices(names, stiffness, {"base": np.diag(mass)}, places)
    modes = min(int(rng.integers(2, 9)), N - 1)
    true = mf.matrices(["x"], {"x": K}, {"base": np.diag(mass)}, places).modes(np.ones(1), modes)
    sets = int(rng.integers(1, 5))
    sf, ss = np.exp(rng.uniform(np.log(0.002), np.log(0.03))), rng.uniform(0.01, 0.05)
    spread = np.sqrt(WEIGHT / rng.chisquare(WEIGHT, 2)) if prior else np.ones(2)
    f = true.frequency * (1 + spread[0] * sf * rng.normal(size=(sets, modes)))
    clean = true.phi.T
    top = np.abs(clean).max(axis=1)[:, None]
    phi = clean + spread[1] * ss * top * rng.normal(size=(sets, *clean.shape))
    factor = 1.0 if prior else float(rng.choice([0.5, 1.0, 2.0]))
    std = bool(rng.random() < 0.5)
    data = mf.modal_data(
        f,
        phi,
        model.sensors,
        frequency_std=factor * sf * f if std else None,
        shape_std=np.broadcast_to(factor * ss * top, phi.shape) if std else None,
    )
    groups = [mf.Group("frequencies", frequency="all"), mf.Group("shapes", shape="all")]
    parameters = [mf.Parameter(name, nominal=1.0, bounds=BOUNDS) for name in names]
    problem = mf.updating_problem(model, data, groups, parameters=parameters)
    expected = NoisePrior() if std else NoisePrior(frequency=factor * sf, shape=factor * ss)
    count = modes * len(places)
    size = "p < modes" if p < modes else "p < data" if p < count else "p >= data"
    classes = (
        *("all", kind, size, f"{sets} set{'s' * (sets > 1)}", "std" if std else "no std"),
        f"expected x {factor:g}",
        "2, 3 sensors" if len(places) < 4 else "4+ sensors",
    )
    return problem, expected, truth, classes


def setups(seed: int) -> tuple[mf.UpdatingProblem, Floats]:
    """Return a problem with the modes of a simulated ambient test, and the truth."""
    rng = np.random.default_rng([seed, 2])
    N, minutes, noise = int(rng.integers(4, 7)), rng.uniform(4, 8), rng.uniform(0.02, 0.2)
    truth, mass = rng.uniform(0.7, 1.4, N), rng.uniform(0.8, 1.2, N)
    names = tuple(f"k{j}" for j in range(N))
    places = {f"s{i}": i for i in range(N)}
    unit = (2 * np.pi / (2 * np.sin(np.pi / (4 * N + 2)))) ** 2  # the first mode at 1 Hz or so
    model = mf.chain(names, mass.tolist(), [unit] * N, stiffness_parameters=names, sensors=places)
    modes = model.modes(truth, N, derivatives=False)
    rate, zeta = 4 * float(modes.frequency[-1]), rng.uniform(0.008, 0.02, N)
    systems = [
        scipy.signal.cont2discrete(([1.0, 0, 0], [1.0, 2 * z * w, w * w]), 1 / rate, "foh")
        for w, z in zip(2 * np.pi * modes.frequency, zeta, strict=True)
    ]
    references, roving = np.split(rng.permutation(N), [int(rng.integers(1, 3))])
    records = list[Records]()
    for part in np.array_split(roving, int(rng.integers(2, 4))):
        sensors = np.append(references, part)
        force = modes.phi.T @ rng.standard_normal((N, int(60 * minutes * rate)))
        q = [scipy.signal.lfilter(b[0], a, f) for (b, a, _), f in zip(systems, force, strict=True)]
        y = modes.phi[sensors] @ np.array(q)
        y += noise * y.std() * rng.standard_normal(y.shape)
        records.append(Records(f"{len(records) + 1}", tuple(f"s{i}" for i in sensors), rate, y))
    top = 0.5 * float(modes.frequency[2] + modes.frequency[3])
    data = combine(["1"], [ambient.identify(records, (0.4 * float(modes.frequency[0]), top))]).data
    groups = [mf.Group("frequencies", frequency="all"), mf.Group("shapes", shape="all")]
    parameters = [mf.Parameter(name, nominal=1.0, bounds=BOUNDS) for name in names]
    return mf.updating_problem(model, data, groups, parameters=parameters), truth


def beside_deviations(seed: int, draws: int) -> list[tuple[Verdict, Verdict]]:
    """Return the verdicts on each parameter of a test with setups, without covariances and with."""
    problem, truth = setups(seed)
    alone = replace(problem, data=replace(problem.data, shape_covariance=None))
    both = [judged(seed, draws, (x, NoisePrior(), truth, ("all",))) for x in (alone, problem)]
    return list(zip(*both, strict=False))


def ranks(seed: int, draws: int, few: bool) -> list[int]:
    """Return how many of ``draws`` draws are below the truth, for each parameter."""
    problem, prior, truth, _ = case(seed, few=few, prior=True)
    noise = prior.of(problem, mf.Uncertainty().of(problem.data))
    assert noise is not None
    known = list(np.random.default_rng([seed, 1]).uniform(*BOUNDS, (STARTS, truth.size)))
    maxima = [x.theta for x in most_probable(problem, noise, known, IMMEDIATE)]
    samples = draw_models(noise, maxima, draws, seed, IMMEDIATE).theta
    return [int(x) for x in (samples < truth).sum(axis=0)]


def histogram(found: Sequence[int], draws: int) -> str:
    """Return the ranks in bins, and how probable it is that uniform ones are farther from even."""
    counts = np.histogram(found, BINS, (0, draws + 1))[0]
    return (
        f"ranks of {len(found)} parameters in {BINS} bins: {counts.tolist()}, "
        f"probability if uniform {scipy.stats.chisquare(counts).pvalue:.2g}"
    )


Test = tuple[mf.UpdatingProblem, NoisePrior, Floats, tuple[str, ...]]
"""A problem, what is expected of its errors, the truth and its classes."""


def judged(seed: int, draws: int, test: Test, predict: bool = False) -> list[Verdict]:
    """Return the verdicts of a test; none where no model is to be used.

    With ``predict`` the last one is that of the next frequency, where there is one.
    """
    problem, prior, truth, classes = test
    source = mf.Uncertainty().of(problem.data)
    noise = prior.of(problem, source)
    assert noise is not None
    rng = np.random.default_rng([seed, 1])
    known = list(rng.uniform(0.6, 1.6, (STARTS, truth.size)))
    maxima = most_probable(problem, noise, known, IMMEDIATE)
    best = maxima[0]
    found = noise.problem.evaluate(best.theta)
    misfit, nominal = (
        noise.over_expected(x.J) for x in (found, noise.problem.evaluate(problem.start))
    )
    if np.any(refused(misfit, nominal)):
        return []
    right = not (chances(noise, found)[0] < CHANCE).any()
    drawn = draw_models(noise, [x.theta for x in maxima], draws, seed, IMMEDIATE)
    samples = drawn.theta
    low, middle, high = np.quantile(samples, (0.05, 0.5, 0.95), axis=0, method="weibull")
    std = np.maximum((high - low) / (2 * 1.645), 1e-12)
    determined = high - low < DETERMINED * 0.9 * (BOUNDS[1] - BOUNDS[0])
    old = jeffreys(problem, [problem.start, best.theta, *known])
    out = [
        Verdict(
            classes,
            bool(low[j] - 1e-9 <= truth[j] <= high[j] + 1e-9),
            None if old is None else bool(abs(truth[j] - old[0][j]) <= 1.645 * old[1][j]),
            float(abs(truth[j] - middle[j]) / std[j]),
            bool(determined[j]) and drawn.settled and right,
            float(high[j] - low[j]),
        )
        for j in range(truth.size)
    ]
    count = len(problem.data.modes) + 1
    if predict and problem.model.modes(truth, count, derivatives=False).frequency.size == count:
        true, *predicted = (
            problem.model.modes(x, count, derivatives=False).frequency[-1]
            for x in (truth, *samples)
        )
        low, middle, high = np.quantile(predicted, (0.05, 0.5, 0.95), method="weibull")
        away, held = abs(true - middle) / ((high - low) / (2 * 1.645)), low <= true <= high
        out.append(Verdict(("next f",), bool(held), None, float(away), False, high - low))
    return out


def jeffreys(problem: mf.UpdatingProblem, starts: Sequence[Floats]) -> tuple[Floats, Floats] | None:
    """Return the model of optimal weights and standard deviations about it; None without one."""
    a, sizes = problem.properties, problem.evaluate(problem.start).J
    programme = LogSum(a, vanishing=EXACT * sizes)
    minima = [
        solve(problem, programme, begin(problem.evaluate(theta, second=True)), TIGHT)
        for theta in starts
    ]
    for minimum in accepted(problem, [x for x in minima if x.converged], programme):
        point = with_second_order(problem, minimum.evaluation)
        found = None if point is None else laplace(problem, point, a)
        if found is not None:
            return minimum.theta, np.sqrt(np.diag(found.covariance))
    return None


def table(verdicts: Sequence[Verdict]) -> str:
    """Return rates by class."""
    names = dict.fromkeys(name for verdict in verdicts for name in verdict.classes)
    order = ["all", *sorted(name for name in names if name != "all")]
    lines = [
        f"{'class':14} {'parameters':>10} {'held':>6} {'old':>6} {'determined':>10} {'worst':>6}"
    ]
    for name in order:
        own = [x for x in verdicts if name in x.classes]
        old = [x.old for x in own if x.old is not None]
        sure = [x.away for x in own if x.determined]
        lines.append(
            f"{name:14} {len(own):10d} {100 * np.mean([x.held for x in own]):5.0f} % "
            + (f"{100 * np.mean(old):4.0f} %" if old else f"{'none':>6}")
            + f" {len(sure):10d} {max(sure, default=0):6.1f}"
        )
    far = sum(x.determined and x.away > 5 for x in verdicts)
    return "\n".join([*lines, f"determined and off by more than 5 standard deviations: {far}"])


def main() -> None:
    """Print the rates over some seeds."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", default="1000:1040")
    parser.add_argument("--draws", type=int, default=DRAWS)
    parser.add_argument("--wrong", action="store_true")
    parser.add_argument("--quiet", action="store_true")
    parser.add_argument("--few", action="store_true")
    parser.add_argument("--bricks", action="store_true")
    parser.add_argument("--prior", action="store_true")
    parser.add_argument("--setups", action="store_true")
    options = parser.parse_args()
    seeds = range(*map(int, options.seeds.split(":")))
    if options.setups:
        pairs = list[tuple[Verdict, Verdict]]()
        for seed in seeds:
            pairs += (own := beside_deviations(seed, options.draws))
            rates = [sum(x[k].held for x in own) for k in (0, 1)]
            ratio = np.exp(np.mean([np.log(b.width / a.width) for a, b in own] or [np.nan]))
            if not options.quiet:
                print(f"{seed}: {rates[0]} and {rates[1]} of {len(own)}, {ratio:.2f}", flush=True)
        ratio = np.exp(np.mean([np.log(b.width / a.width) for a, b in pairs]))
        share = [100 * np.mean([x[k].held for x in pairs]) for k in (0, 1)]
        print(
            f"{len(pairs)} parameters: intervals hold {share[0]:.0f} % with deviations, "
            f"{share[1]:.0f} % with covariances, which are {ratio:.2f} times as wide"
        )
        return
    if options.prior:
        of = {seed: ranks(seed, options.draws, options.few) for seed in seeds}
        if not options.quiet:
            print(*(f"{seed}: {found}" for seed, found in of.items()), sep="\n")
        print(histogram([x for found in of.values() for x in found], options.draws))
        return
    verdicts, refused = [], 0
    for seed in seeds:
        began = time.process_time()
        test = case(seed, options.wrong, options.few, solid=options.bricks)
        found = judged(seed, options.draws, test, predict=not options.wrong)
        verdicts += found
        refused += not found
        if not options.quiet and not found:
            print(f"{seed}: no model is to be used")
        elif not options.quiet:
            held = sum(x.held for x in found)
            away = max(x.away for x in found)
            spent = time.process_time() - began
            text = ", ".join(found[0].classes[1:])
            print(f"{seed}: {held} of {len(found)}, worst {away:.1f}, {spent:.1f} s: {text}")
    print(table(verdicts))
    print(f"tests in which no model is to be used: {refused}")


if __name__ == "__main__":
    main()
