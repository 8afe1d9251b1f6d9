"""How often the verdict says what was planted in simulated tests.

    python benchmarks/verdicts.py --seeds 0:5 [--cases good bound …] [--quiet]

Seeds below 1000 are for development; seeds from 9000 on are for judgement.

Each case is a chain of five to seven stories with a stiffness parameter each, four modes at all
floors and errors as they are expected, 0.5 % of frequencies and 3 % of shapes, but for what is
planted:

==========  ============================================  ==========================================
case        planted                                       right
==========  ============================================  ==========================================
good        nothing                                       use; no bound, no warning
bound       one stiffness is 0.2 beyond its bound         use; widen the bounds of this one only
spring      a spring to the ground that the model lacks   do not use
sensor      one sensor has the wrong sign                 do not use
idle        a parameter that changes no measured mode     not determined; fix it
twins       two parameters of the same spring             neither is determined; tie them
fixed       a fixed parameter is wrong by a third or so   free this one
kept        a fixed parameter is right                    use; no warning
few         one mode                                      nothing determined is 5 deviations off
overfit     three modes at three sensors                  nothing determined is 5 deviations off
==========  ============================================  ==========================================
"""

from __future__ import annotations

import argparse

import numpy as np

import modefront as mf
from modefront._typing import Floats

SCALE = 1e4


def solved(case: str, seed: int) -> tuple[mf.Results, dict[str, float], str]:
    """Return the results of a case, the true parameters, and the name of the planted one."""
    rng = np.random.default_rng([seed, sorted(CASES).index(case)])
    n = int(rng.integers(5, 8))
    parts = {}
    for i in range(n):
        v = np.zeros(n)
        v[i], v[i - 1] = 1.0, -1.0 if i else 1.0
        parts[f"k{i + 1}"] = SCALE * (np.outer(v, v) if i else np.diag(np.eye(n)[0]))
    truth = dict(zip(parts, rng.uniform(0.75, 1.3, n), strict=True))
    planted = f"k{rng.integers(1, n + 1)}"
    bounds = dict.fromkeys(parts, (0.3, 3.0))
    if case == "bound":
        truth[planted] = rng.uniform(1.4, 1.8)
        bounds[planted] = (0.3, truth[planted] - 0.2)
    fixed = {planted} if case in ("fixed", "kept") else set()
    if case == "kept":
        truth[planted] = 1.0
    if case == "fixed":
        right = str(rng.choice([name for name in parts if name != planted]))
        truth[planted], truth[right] = float(rng.choice([0.65, 1.5])), 1.0
        fixed.add(right)
    K = sum((truth[name] * part for name, part in parts.items()), np.zeros((n, n)))
    if case == "spring":
        K[-1, -1] += rng.uniform(0.5, 1.0) * SCALE
    mass, places = np.diag(rng.uniform(0.8, 1.2, n)), {f"s{i}": i for i in range(n)}
    if case == "idle":
        planted, parts["extra"] = "extra", np.zeros((n, n))
        truth["extra"], bounds["extra"] = 1.0, (0.3, 3.0)
        parts = {name: np.pad(part, (0, 1)) for name, part in parts.items()}
        parts["extra"][-1, -1] = 1e3 * SCALE
        mass, K = np.pad(mass, (0, 1)), np.pad(K, (0, 1))
        mass[-1, -1], K[-1, -1] = 1.0, 1e3 * SCALE
    if case == "twins":
        parts["twin"], bounds["twin"] = parts[planted].copy(), (0.3, 3.0)
        truth["twin"] = 0.9
        K = K + 0.9 * parts[planted]
    if case == "overfit":
        places = {f"s{i}": int(i) for i in rng.choice(n, 3, replace=False)}
    model = mf.matrices(list(parts), parts, {"base": mass}, places)
    modes = {"few": 1, "overfit": 3}.get(case, 4)
    true = mf.matrices(["x"], {"x": K}, {"base": mass}, places).modes(np.ones(1), modes)
    f = true.frequency * (1 + 0.005 * rng.normal(size=modes))
    shape = true.phi.T
    top = np.abs(shape).max(axis=1)[:, None]
    shape = shape + 0.03 * top * rng.normal(size=shape.shape)
    if case == "sensor":
        shape[:, rng.integers(n // 2, n)] *= -1
    problem = mf.updating_problem(
        model,
        mf.modal_data(f, shape, model.sensors),
        [mf.Group("frequencies", frequency="all"), mf.Group("shapes", shape="all")],
        parameters=[
            mf.Parameter(name, nominal=1.0, bounds=bounds[name], fixed=name in fixed)
            for name in parts
        ],
    )
    options = mf.Identifiability(models=0)
    return mf.solve(problem, points=3, identifiability=options, seed=seed), truth, planted


def far(results: mf.Results, truth: dict[str, float]) -> bool:
    """Return whether a determined parameter is five standard deviations off."""
    values: Floats = np.array([truth[name] for name in results.parameter.values])
    low, middle, high = results.interval.values.T
    away = np.abs(values - middle) > 5 * (high - low) / (2 * 1.645)
    return bool((away & (results.trust.values == "determined")).any())


def is_right(case: str, results: mf.Results, truth: dict[str, float], planted: str) -> bool:
    """Return whether the verdict says what was planted, and nothing else."""
    text = "\n".join(results.verdict)
    refused = text.startswith("Do not use")
    alarm = refused or any(
        x in text for x in (" bound ", "larger than noise", "do not tell", "is fixed")
    )
    trust = dict(zip(results.parameter.values.tolist(), results.trust.values.tolist(), strict=True))
    match case:
        case "good" | "kept":
            return not alarm
        case "fixed":
            return f"With {planted} = " in text and "which is fixed" in text
        case "bound":
            named = text.partition("With ")[2].partition(", errors")[0]
            return f"{planted} = " in named and named.count(" = ") == 1
        case "spring" | "sensor":
            return refused
        case "idle":
            return trust[planted] == "not determined" and f"{planted}: fixed = true" in text
        case "twins":
            tied = f'twin: tie = "{planted}"' in text or f'{planted}: tie = "twin"' in text
            return "determined" not in (trust[planted], trust["twin"]) and tied
        case _:
            return not refused and not far(results, truth)


CASES = ("good", "bound", "spring", "sensor", "idle", "twins", "few", "overfit", "fixed", "kept")


def main() -> None:
    """Print how many verdicts are right, case by case."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", default="0:5")
    parser.add_argument("--cases", nargs="+", default=CASES)
    parser.add_argument("--quiet", action="store_true")
    options = parser.parse_args()
    seeds = range(*map(int, options.seeds.split(":")))
    for case in options.cases:
        right = 0
        for seed in seeds:
            results, truth, planted = solved(case, seed)
            found = is_right(case, results, truth, planted)
            right += found
            if not found and not options.quiet:
                print(f"{case} {seed}, planted {planted}:", *results.verdict, sep="\n  ")
        print(f"{case:8} {right} of {len(seeds)}", flush=True)


if __name__ == "__main__":
    main()
