"""From the weights of samples to an estimate of P, the same on one worker as on many.

Every method returns, for each sample and level, a weight whose mean is P. Samples are drawn in
chunks; each chunk has a generator of its own, spawned from the seed by the chunk's number, and
the chunk's size follows from the problem alone, so who computes it changes nothing.
"""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from queue import SimpleQueue

import numpy as np

from modefront.reliability.gaussian import Convolution, GaussianResponse, gaussian_response
from modefront.reliability.problem import FirstPassage
from modefront.response.system import FloatArray

LARGEST_CHUNK = 32
"""Samples in a chunk: enough for the loops in C, few enough for the cache."""

LARGEST_BLOCK = 2**20
"""Normal numbers in a chunk, 8 MB: bounds the memory of a worker to some 100 MB."""

Weigh = Callable[[Convolution, np.random.Generator, int], FloatArray]
"""(a worker's convolution, generator, samples) → weights, (n_levels, samples)."""

Prepare = Callable[[GaussianResponse, FloatArray], Weigh]
"""(response, levels) → what weighs samples at these levels."""


def spawn(seed: np.random.SeedSequence, number: int) -> np.random.SeedSequence:
    """Return the child of that number; unlike `seed.spawn`, the same one whenever asked for."""
    key = (*seed.spawn_key, number)
    return np.random.SeedSequence(seed.entropy, spawn_key=key, pool_size=seed.pool_size)


# 6 arguments: the method, what is asked of it, and how.
def estimate(
    prepare: Prepare,
    problem: FirstPassage,
    levels: FloatArray,
    samples: int,
    seed: np.random.SeedSequence,
    workers: int = 1,
) -> tuple[FloatArray, FloatArray]:
    """Return P and the coefficient of variation of its estimate at barriers, (n_levels,) each.

    ``prepare`` is one of `modefront.reliability.methods.METHODS`. Where no sample failed, P is zero
    and the coefficient infinite.
    """
    response = gaussian_response(problem)
    weigh = prepare(response, levels)
    largest = LARGEST_BLOCK // (response.n_inputs * response.n_steps)
    chunk = min(max(largest, 1), LARGEST_CHUNK)
    free: SimpleQueue[Convolution] = SimpleQueue()
    for _ in range(workers):
        free.put(Convolution(response, chunk))

    def weights_of(number: int) -> FloatArray:
        count = min(chunk, samples - number * chunk)
        convolution = free.get()
        try:
            return weigh(convolution, np.random.default_rng(spawn(seed, number)), count)
        finally:
            free.put(convolution)

    with ThreadPoolExecutor(workers) as pool:
        chunks = pool.map(weights_of, range(-(-samples // chunk)))
        weights = np.concatenate(list(chunks), axis=1)
    P = weights.mean(axis=1)
    unit = np.full(P.size, np.inf)
    np.divide(weights.std(axis=1, ddof=1), P, out=unit, where=P > 0)
    return P, unit / np.sqrt(samples)


def step_effect(
    prepare: Prepare,
    problem: FirstPassage,
    levels: FloatArray,
    samples: int,
    seed: np.random.SeedSequence,
    workers: int = 1,
) -> tuple[FloatArray, FloatArray]:
    """Return P with half the time step over P, and its standard error, (n_levels,) each.

    Looked at on a finer grid, a response is seen to leave [-b, b] more often, and the noise is held
    constant for a shorter time: the ratio shows how much of P is owed to the step. The estimates
    are of independent samples, and the error is to first order in theirs. NaN where P is zero.
    """
    finer = replace(problem, time_step=problem.time_step / 2)
    (P, own), (halved, other) = (
        estimate(prepare, each, levels, samples, spawn(seed, k), workers)
        for k, each in enumerate((problem, finer))
    )
    ratio = np.divide(halved, P, out=np.full(P.size, np.nan), where=P > 0)
    return ratio, ratio * np.hypot(own, other)
