"""From the weights of samples to an estimate of P, the same on one worker as on many.

Every method returns, for each sample and level, a weight whose mean is P. Samples are drawn in
chunks; each chunk has a generator of its own, spawned from the seed by the chunk's number, and
the chunk's size follows from the problem alone, so who computes it changes nothing.
"""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from queue import SimpleQueue

import numpy as np
from numpy.typing import ArrayLike

from modefront.errors import wrong
from modefront.reliability.gaussian import Convolution, GaussianResponse, gaussian_response
from modefront.reliability.problem import FirstPassage
from modefront.response.system import FloatArray, positive_count, real_array

LARGEST_CHUNK = 32
"""Samples in a chunk: enough for the loops in C, few enough for the cache."""

LARGEST_BLOCK = 2**20
"""Normal numbers in a chunk, 8 MB: bounds the memory of a worker to some 100 MB."""

Weigh = Callable[[Convolution, np.random.Generator, int], FloatArray]
"""(a worker's convolution, generator, samples) → weights, (n_levels, samples)."""

Prepare = Callable[[GaussianResponse, FloatArray], Weigh]
"""(response, levels) → what weighs samples at these levels."""


@dataclass(frozen=True)
class Estimate:
    """A first-passage probability.

    Attributes
    ----------
    probability : estimate of P
    unit_coefficient_of_variation : δ, standard deviation of one sample's weight over P; inf if no
        sample failed
    samples : number of samples N; each takes one evaluation of the response
    method : name of the method
    level : barrier b; failure is |x| > b for any response
    """

    probability: float
    unit_coefficient_of_variation: float
    samples: int
    method: str
    level: float

    @property
    def coefficient_of_variation(self) -> float:
        """Return δ/√N, the coefficient of variation of the estimate."""
        return float(self.unit_coefficient_of_variation / np.sqrt(self.samples))

    @property
    def standard_error(self) -> float:
        """Return the standard deviation of the estimate; nan if no sample failed."""
        return self.probability * self.coefficient_of_variation if self.probability else np.nan


def spawn(seed: np.random.SeedSequence, number: int) -> np.random.SeedSequence:
    """Return the child of that number; unlike `seed.spawn`, the same one whenever asked for."""
    key = (*seed.spawn_key, number)
    return np.random.SeedSequence(seed.entropy, spawn_key=key, pool_size=seed.pool_size)


@dataclass(frozen=True)
class Estimator:
    """A method: called, it estimates the probability at each of (n_levels,) barriers.

    Attributes
    ----------
    method : its name
    prepare : returns what weighs samples
    """

    method: str
    prepare: Prepare

    def __call__(
        self,
        problem: FirstPassage,
        levels: ArrayLike,
        samples: int,
        seed: np.random.SeedSequence,
        workers: int = 1,
    ) -> tuple[Estimate, ...]:
        """Return the mean weight at each level, from `samples` samples drawn and weighed.

        Raises
        ------
        InputError
            For levels that are not positive, or fewer than two samples or one worker.
        """
        b = real_array("levels", levels, (None,), "barriers")
        if np.any(b <= 0):
            first = int(np.argmax(b <= 0))
            raise wrong("levels", "positive numbers", f"{b[first]} at index {first}")
        if positive_count("samples", samples) < 2:
            raise wrong("samples", "at least 2, for a coefficient of variation", samples)
        positive_count("workers", workers)
        response = gaussian_response(problem)
        weigh = self.prepare(response, b)
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
        mean = weights.mean(axis=1)
        spread = weights.std(axis=1, ddof=1)
        return tuple(
            Estimate(
                float(p), float(s / p) if p > 0 else np.inf, samples, self.method, float(level)
            )
            for p, s, level in zip(mean, spread, b, strict=True)
        )


@dataclass(frozen=True)
class StepEffect:
    """Two estimates of the same probability, with the time step given and with half of it.

    Looked at on a finer grid, a response is seen to leave [-b, b] more often, and the noise is held
    constant for a shorter time: the ratio shows how much of P is owed to the step.

    Attributes
    ----------
    given, halved : the two estimates, from independent samples
    """

    given: Estimate
    halved: Estimate

    @property
    def ratio(self) -> float:
        """Return P with the halved step over P with the given one; nan if that is zero."""
        given = self.given.probability
        return self.halved.probability / given if given > 0 else np.nan

    @property
    def standard_error(self) -> float:
        """Return the standard error of the ratio, to first order in those of the estimates."""
        pair = (self.given.coefficient_of_variation, self.halved.coefficient_of_variation)
        return float(self.ratio * np.hypot(*pair))


def step_effect(
    estimator: Estimator,
    problem: FirstPassage,
    levels: ArrayLike,
    samples: int,
    seed: np.random.SeedSequence,
    workers: int = 1,
) -> tuple[StepEffect, ...]:
    """Estimate the probability at each level with the time step given and with half of it."""
    finer = replace(problem, time_step=problem.time_step / 2)
    given = estimator(problem, levels, samples, spawn(seed, 0), workers)
    halved = estimator(finer, levels, samples, spawn(seed, 1), workers)
    return tuple(StepEffect(*pair) for pair in zip(given, halved, strict=True))
