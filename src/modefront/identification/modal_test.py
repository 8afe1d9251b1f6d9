"""From the file of a modal test to its modes, and these as files."""

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from itertools import compress
from pathlib import Path
from typing import Any

import numpy as np
from scipy.optimize import linear_sum_assignment
from threadpoolctl import threadpool_limits

from modefront._typing import Complexes
from modefront.data.csv import is_reserved, write_covariance, write_csv
from modefront.data.modal import ModalData
from modefront.data.modal_test import ModalTest, read_test
from modefront.data.uff import write_uff55
from modefront.errors import Fault, InputError, UnfinishedError
from modefront.identification.methods import ambient, hammer
from modefront.identification.record import Identification, Rejected
from modefront.identification.sets import CombinedModes, combine
from modefront.inputs import wrong
from modefront.outputs import write_text
from modefront.text import Shown, json_of

POOR_FIT = 0.5  # residual of a function over its norm from which on it is pointed out
NAMED = 3  # functions that are fitted poorly, modes and warnings that are named
LONG = 35  # minutes of records of ambient tests; modes of longer ones have a warning


@dataclass(frozen=True, repr=False)
class IdentifiedTest(Shown):
    """Modes of a modal test.

    Attributes
    ----------
    test : its functions and options
    identified : modes of each data set
    modes : of all sets under common numbers
    numbers : of the modes of each set in the table without choices by hand; 0 for those that only
        seeds have
    """

    test: ModalTest
    identified: tuple[Identification, ...]
    modes: CombinedModes
    numbers: tuple[tuple[int, ...], ...]

    @property
    def names(self) -> list[str]:
        """Names of the data sets; an ambient test is one."""
        return list(self.modes.data.sets)

    @cached_property
    def data(self) -> ModalData:
        """The modal data that studies read; raises UnfinishedError where no mode was found."""
        if not self.modes.data.modes:
            raise UnfinishedError("no mode was found in the band")
        return self.modes.data

    @property
    def warnings(self) -> list[str]:
        """What is to be looked at: in the modes, the files, and the fit of each data set."""
        sets = list(zip(self.names, self.identified, self.modes.index, strict=True))
        modes = [
            f"mode {r + 1} of set {name!r}: {'; '.join(each.modes[k].flags)}"
            for name, each, of_set in sets
            for r, k in enumerate(of_set)
            if k >= 0 and each.modes[k].flags
        ]
        spread = [
            f"mode {r}: the sets differ by more than their own standard deviations: "
            f"{f:.2g} Hz, damping {100 * zeta:.2g} % between sets are included"
            for r, (f, zeta) in enumerate(self.modes.spread, 1)
            if f or zeta
        ]
        read = [text for part in self.test.sets for text in part.warnings]
        read += [
            f"set {setup.name!r}: {name} does not move and is left out"
            for setup in self.test.setups
            for name in setup.still
        ]
        fitted = [f"set {name!r}: {text}" for name, each, _ in sets for text in _warnings(each)]
        if any(x.duration > 60 * LONG for x in self.test.setups) and self.modes.data.modes:
            read.append(
                f"standard deviations of records of more than {LONG} min are up to a quarter too "
                "small where many modes share coloured forces"
            )
        return modes + spread + read + fitted

    def write(self, path: Path | str) -> list[Path]:
        """Write modal data, in ``.uff`` as dataset 55, and all else beside it; return the files.

        Raises InputError for a file that ends in neither, that has no folder, or whose columns
        sensors would take.
        """
        path, sensors = writable(path), self.data.sensors
        written = [path]
        if path.suffix.lower() == ".uff":
            modes = list[dict[int, tuple[complex, Complexes]]]()
            for each, of_set in zip(self.identified, self.modes.index, strict=True):
                at = [sensors.index(name) for name in each.responses]
                modes.append({})
                for number, k in ((r, k) for r, k in enumerate(of_set, 1) if k >= 0):
                    shape = np.zeros(len(sensors), complex)
                    mode = each.modes[k]
                    shape[at] = np.where(np.isnan(mode.shape_std), 0, mode.shape.complex_shape)
                    modes[-1][number] = mode.pole, shape
            write_uff55(path, self.names, modes, sensors, self.data.pairs)
        else:
            clashing = [name for name in sensors if is_reserved(name, sensors)]
            if clashing:
                expected = "names of sensors that are no columns of modal data"
                raise InputError(Fault("sensors", repr(clashing[0]), expected, "a reserved name"))
            write_csv(path, self.data, self.modes.damping_std)
            if self.data.shape_covariance is not None:
                written.append(path.with_name(path.stem + "-covariance.csv"))
                write_covariance(written[-1], self.data)
        written.append(path.with_name(path.stem + "-identification.json"))
        write_text(written[-1], json.dumps(self.as_plain(), indent=1) + "\n")
        return written

    def as_plain(self) -> dict[str, Any]:
        """Return all that was identified as plain data; complex numbers are [real, imaginary]."""
        named = zip(self.names, self.identified, strict=True)
        sets = [{"name": name} | _plain_set(identification) for name, identification in named]
        said = {"test": self.test.name, "warnings": self.warnings, "sets": sets}
        return json.loads(json_of(said))

    def __repr__(self) -> str:
        """Return the modes, a line each, and the first warnings."""
        out = [f"{self.test.name}: {len(self.names)} data set{'s' * (len(self.names) != 1)}"]
        data = self.modes.data
        columns = zip(data.mean_frequency, data.mean_damping, strict=True)
        lines = [f"  mode {r}: {f:.5g} Hz, {z:.2%}" for r, (f, z) in enumerate(columns, 1)]
        out += [*lines[:12], *[f"  and {len(lines) - 12} more"] * (len(lines) > 12)]
        warnings = self.warnings
        out += [f"warning: {text}" for text in warnings[:NAMED]]
        rest = len(warnings) - NAMED
        return "\n".join([*out, *([f"and {rest} more: see warnings"] if rest > 0 else [])])


def identify(
    test: Path | str,
    band: tuple[float, float] | None = None,
    *,
    keep: Sequence[int] = (),
    drop: Sequence[int] = (),
    seeds: Sequence[float] = (),
) -> IdentifiedTest:
    """Return the modes of a modal test.

    Parameters
    ----------
    test
        File of the test: TOML, a universal file, or CSV with frequency response functions. Only
        TOML has ambient tests.
    band
        Least and greatest frequency in Hz; that of the test file, or all lines, unless given.
    keep, drop
        Numbers of the modes that stay alone, and that do not, by the table without these options;
        those of the test file unless given.
    seeds
        Frequencies in Hz at which there is to be a mode, whatever its evidence; likewise.

    Raises
    ------
    InputError
        For files that are wrong, a band without lines or functions, modes that are none.
    """
    path = Path(test)
    read = read_test(path)
    band = band or read.band
    keep, drop, seeds = keep or read.keep, drop or read.drop, seeds or read.seeds
    read = replace(read, keep=tuple(keep), drop=tuple(drop), seeds=tuple(seeds))
    low, high = _ends(path, read, band)
    for f in seeds:
        if not low <= f <= high:
            expected = f"frequencies of the lines, {low:g} to {high:g} Hz"
            raise wrong(path, expected, f"{f:g}", "--seed")
    with threadpool_limits(1, user_api="blas"):  # threads wait for each other on small matrices
        identified = _identified(read, band, seeds)
        table = _identified(read, band) if seeds else identified
    names = [read.name] if read.setups else [part.name for part in read.sets]
    index = combine(names, table).index
    for option, numbers in (("--keep", keep), ("--drop", drop)):
        for number in numbers if index[0] else ():
            if not 1 <= number <= len(index[0]):
                expected = f"numbers of modes, from 1 to {len(index[0])}"
                raise wrong(path, expected, str(number), option)
    parts = [_chosen(read, *each) for each in zip(identified, table, index, strict=True)]
    left, numbered = zip(*parts, strict=True)
    return IdentifiedTest(read, left, combine(names, left), numbered)


def _identified(
    test: ModalTest, band: tuple[float, float] | None, seeds: Sequence[float] = ()
) -> list[Identification]:
    if test.setups:
        return [ambient.identify(test.setups, band, test.modes, seeds)]
    return [hammer.identify(part.data, band, test.modes, seeds) for part in test.sets]


def _chosen(
    test: ModalTest, each: Identification, table: Identification, of_set: Sequence[int]
) -> tuple[Identification, tuple[int, ...]]:
    """Return an identification without modes that were not chosen, and the numbers of the others.

    They are those of the ``table`` without seeds, whose modes ``of_set`` holds by number. Modes
    that are left out stay in the fit; those with a seed in their bandwidth stay anyway.
    """
    f, of_table = (np.array([mode.frequency for mode in x.modes]) for x in (each, table))
    rows, columns = linear_sum_assignment(np.abs(np.subtract.outer(of_table, f)))
    numbers = np.zeros(len(f), int)
    numbers[columns] = [of_set.index(row) + 1 for row in rows.tolist()]
    half = f * [mode.damping for mode in each.modes]
    held = (np.abs(np.subtract.outer(f, np.array(test.seeds))) <= half[:, None]).any(axis=1)
    out = (numbers > 0) & ~held & np.isin(numbers, test.drop)
    if test.keep:
        out |= (numbers > 0) & ~held & ~np.isin(numbers, test.keep)
    modes, gone = (tuple(compress(each.modes, some)) for some in (~out, out))
    rejected = (Rejected(mode.frequency, mode.damping, "left out by hand") for mode in gone)
    kept = replace(each, modes=modes, rejected=(*each.rejected, *rejected))
    return kept, tuple(numbers[~out].tolist())


def writable(path: Path | str) -> Path:
    """Return the path of modal data; raises InputError where none can be written to it."""
    path = Path(path)
    if path.suffix.lower() not in (".csv", ".uff"):
        expected = "a file that ends in .csv, or in .uff for dataset 55"
        raise InputError(Fault("modefront identify", "-o", expected, str(path)))
    if not path.parent.is_dir():
        raise wrong(path.parent, "a folder", "none", "folder")
    return path


def _ends(path: Path, test: ModalTest, band: tuple[float, float] | None) -> tuple[float, float]:
    """Return the ends of the lines within a band in Hz; raises InputError where they are few."""
    ends = list[float]()
    for setup in test.setups:
        low, high = band or ambient.default_band(test.setups)
        high = min(high, setup.rate / 2)
        if (high - low) * setup.duration < ambient.LEAST_LINES:
            expected = f"a band of {ambient.LEAST_LINES} lines of set {setup.name!r} at least"
            reach = f"{low:g} to {high:g} Hz of {setup.duration:g} s at {setup.rate:g} per s"
            reach += ": is the time in s?" * (high < low)
            raise wrong(path, expected, reach, "band")
        ends += low, high
    for data_set in test.sets:
        f, inside = data_set.data.frequency, data_set.data.within(*(band or (0.0, np.inf)))
        if (count := len(inside.frequency)) < hammer.LEAST_LINES:
            expected = f"at least {hammer.LEAST_LINES} lines of set {data_set.name!r} within it"
            reach = f"{count}: the files reach from {f[0]:g} to {f[-1]:g} Hz"
            raise wrong(path, expected, reach, "band")
        if not np.nan_to_num(inside.H).any():
            zeros = f"zeros in set {data_set.name!r}"
            raise wrong(path, "functions that are not zero", zeros, "band")
        ends += inside.frequency[[0, -1]].tolist()
    return min(ends), max(ends)


def _warnings(identification: Identification) -> list[str]:
    """Return the warnings on one identification."""
    out = []
    data, residuals = identification.data, identification.residuals
    if not identification.converged:
        out.append("the maximum of the likelihood was not reached within its tolerance")
    if residuals.chi2 > 1.5:
        out.append(
            f"the model leaves {residuals.chi2:.1f} times the variance that the data have: "
            "standard deviations are widened accordingly; nonlinearity, leakage or missing modes"
        )
    if residuals.widening > 1.5 and not data.decay:  # else the window is known
        out.append(
            "neighbouring lines are correlated: standard deviations are "
            f"{residuals.widening**0.5:.1f} times those of independent lines; windows, zero "
            "padding or drifting modes"
        )
    measured = {data.responses[i] for i in np.flatnonzero(data.measured.any(axis=(0, 2)))}
    empty = [np.isnan(mode.shape_std) for mode in identification.modes]
    silent = np.flatnonzero(np.any(empty, axis=0)).tolist() if empty else []
    names = [x for k in silent if (x := identification.responses[k]) in measured]
    if names:
        more = f" and {len(names) - NAMED} more" * (len(names) > NAMED)
        out.append(
            f"{', '.join(names[:NAMED])}{more}: nothing but noise at any mode; left empty. Is a "
            "sensor dead, or at a point that does not move?"
        )
    share = np.nan_to_num(residuals.share)
    poor = [(float(share[j, i]), j, i) for j, i in np.argwhere(share > POOR_FIT).tolist()]
    if poor:
        worst = [
            f"{data.references[j]} to {data.responses[i]} {x:.0%}"
            for x, j, i in sorted(poor, reverse=True)[:NAMED]
        ]
        more = f" and {len(poor) - NAMED} more" * (len(poor) > NAMED)
        out.append(
            f"{len(poor)} of {share.size} functions are fitted poorly, residuals over norms: "
            f"{', '.join(worst)}{more}"
        )
    return out


def _plain_set(identification: Identification) -> dict[str, Any]:
    """Return what was identified of one data set."""
    residuals = identification.residuals
    return {
        "references": identification.data.references,
        "responses": identification.responses,
        "band": identification.band,
        "chi2": residuals.chi2,
        "correlation_factor": residuals.widening,
        "force_noise": np.sqrt(residuals.force),
        "residual": residuals.share,
        "residual_terms": identification.residual_terms,
        "evaluations": identification.evaluations,
        "converged": identification.converged,
        "modes": [
            {
                "frequency": mode.frequency,
                "frequency_std": mode.frequency_std,
                "damping": mode.damping,
                "damping_std": mode.damping_std,
                "pole": (mode.pole.real, mode.pole.imag),
                "shape": mode.shape.complex_shape.view(float).reshape(-1, 2),
                "real_shape_std": mode.shape_std,
                "phase_collinearity": mode.shape.collinearity,
                "loss": (1 - np.sqrt(mode.shape.collinearity)) / 2,  # of the imaginary part
                "participation": mode.participation.view(float).reshape(-1, 2),
                "evidence": mode.gain,
                "support": mode.support,
                "visibility": mode.visibility,
                "flags": mode.flags,
            }
            for mode in identification.modes
        ],
        "rejected": [asdict(x) for x in identification.rejected],
    }
