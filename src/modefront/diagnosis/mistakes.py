"""The mistakes that are looked for: each is a record, and a new one is one more record here.

A mistake has a probability with which a study has one, which its variants share: its price is the
negative logarithm of that. A variant says whom it blames (``subject``), the names and numbers of
its sentence, and how data or model look without it. Sentence and remedy have ``{name}`` for the
numbers of a variant.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import scipy.sparse

from modefront._typing import Floats
from modefront.diagnosis.evidence import OF_MODEL, Point, State, loss
from modefront.diagnosis.measured import RIGID, assigned, log_frequencies, mac_values, median
from modefront.diagnosis.notes import ALONG, axis_name
from modefront.models.geometry import Geometry

AXES = "xyz"

PER_SENSOR, TRIED = 3, 40
"""Variants of a mistake for each sensor, and of all, that are tried: those that promise most."""


@dataclass(frozen=True, eq=False)
class Setting:
    """What variants are sought for: a state, and the model beside it at some parameters.

    Attributes
    ----------
    state : data and model
    points : the state at the nominal and at fitted parameters
    frequencies, shapes : of the model at each point: (model modes,) in Hz, and (N, model modes)
    sets, modes, sensors, parameters : names
    geometry : of the model; None where it is not known
    """

    state: State
    points: Sequence[Point]
    frequencies: Sequence[Floats]
    shapes: Sequence[Floats]
    sets: tuple[str, ...]
    modes: tuple[int, ...]
    sensors: tuple[str, ...]
    parameters: tuple[str, ...]
    geometry: Geometry | None

    @property
    def measured_sensors(self) -> list[int]:
        """Sensors with data."""
        known: list[int] = np.flatnonzero(self.state.data.known.any(axis=0)).tolist()
        return known

    def gain(self, s: int, rows: scipy.sparse.csr_array) -> Floats:
        """Return by how much the cost falls with sensor s at other rows (places, N), (places,)."""
        data, out = self.state.data, np.full(rows.shape[0], -np.inf)
        for point, Phi in zip(self.points, self.shapes, strict=True):
            used = data.known[:, s] & ~self.state.foreign
            c, scale = data.mean[used, s], point.sigma
            new = (rows @ Phi[:, point.index[used]]) * point.beta[used]
            old = point.beta[used] * point.chi[used, s]
            before = loss((old - c) / scale, OF_MODEL).sum()
            out = np.maximum(out, before - loss((new - c) / scale, OF_MODEL).sum(axis=1))
        return out


@dataclass(frozen=True, eq=False)
class Variant:
    """A mistake of a certain sensor, data set or parameter.

    Attributes
    ----------
    subject : what it blames
    change : returns a state without it
    numbers : names and numbers of its sentence
    price : what it costs beside the price of its mistake
    """

    subject: tuple[str, ...]
    change: Callable[[State], State]
    numbers: Mapping[str, Any] = field(default_factory=dict)
    price: float = 0.0


@dataclass(frozen=True, eq=False)
class Mistake:
    """A kind of mistake.

    Attributes
    ----------
    kind : name
    probability : with which a study has one
    sentence, remedy : what is wrong, and what mends it
    variants : yields the variants in a setting
    """

    kind: str
    probability: float
    sentence: str
    remedy: str
    variants: Callable[[Setting], Iterator[Variant]]


def _shared(count: float) -> float:
    """Return the price of one of ``count`` variants."""
    return float(np.log(max(count, 1)))


def _enumerated(names: Sequence[str], most: int = 6) -> str:
    """Return names as a text, the first of many.

    >>> _enumerated(["a", "b", "c"], 2)
    'a, b and 1 more'
    """
    shown = list(names[:most])
    if len(names) > most:
        return f"{', '.join(shown)} and {len(names) - most} more"
    return " and ".join([*([", ".join(shown[:-1])] if shown[1:] else []), *shown[-1:]])


# Sensors of the data.


def _parts(sets: tuple[str, ...]) -> list[tuple[list[int], str]]:
    """Return data sets in which a sensor may be wrong, and their names: all, one, all but one."""
    everyone = list(range(len(sets)))
    parts = [everyone]
    if len(sets) > 1:
        parts += [[k] for k in everyone]
    if len(sets) > 2:
        parts += [[j for j in everyone if j != k] for k in everyone]
    names = [f"set{'s' * (len(part) > 1)} {_enumerated([sets[k] for k in part])}" for part in parts]
    return list(zip(parts, ["all data", *names[1:]], strict=True))


def _permuted(sets: list[int], sensors: list[int], order: list[int], sign: float) -> Callable[[State], State]:
    def change(state: State) -> State:
        shape = state.data.shape.copy()
        shape[np.ix_(sets, range(shape.shape[1]), sensors)] = (
            sign * state.data.shape[np.ix_(sets, range(shape.shape[1]), order)]
        )
        return replace(state, data=replace(state.data, shape=shape))

    return change


def _reversed(setting: Setting) -> Iterator[Variant]:
    parts = _parts(setting.sets)
    price = _shared(len(parts) * len(setting.measured_sensors))
    for s in setting.measured_sensors:
        for part, where in parts:
            name = setting.sensors[s]
            yield Variant((name, where), _permuted(part, [s], [s], -1.0), {"sensor": name, "where": where}, price)


def _exchanged(setting: Setting) -> Iterator[Variant]:
    """Yield exchanges, of many sensors those after which residuals are the least."""
    data, sensors = setting.state.data, np.array(setting.measured_sensors)
    parts = _parts(setting.sets)
    price = _shared(len(parts) * sensors.size * (sensors.size - 1) / 2)
    for part, where in parts:
        best: dict[tuple[int, int], float] = {}
        for point in setting.points:
            a = data.factors(data.mean)[part]
            measured = (data.psi[part] / np.where(a == 0, 1.0, a))[:, :, sensors]
            seen = data.seen[part][:, :, sensors]
            target = (point.beta[:, None] * point.chi)[:, sensors]
            if len(part) < len(setting.sets):
                target = data.mean[:, sensors]
            r = np.where(seen[..., None], measured[..., None] - target[None, :, None, :], 0.0)
            cost = loss(r / point.sigma, OF_MODEL).mean(axis=0).sum(axis=0)
            own = np.diag(cost)
            gain = own[:, None] + own[None, :] - cost - cost.T
            for i, j in zip(*np.triu_indices(sensors.size, 1), strict=True):
                key = int(sensors[i]), int(sensors[j])
                best[key] = max(best.get(key, -np.inf), float(gain[i, j]))
        for s, t in sorted(best, key=lambda key: -best[key])[: TRIED if len(part) == len(setting.sets) else PER_SENSOR]:
            names = setting.sensors[s], setting.sensors[t]
            yield Variant(
                (*names, where),
                _permuted(part, [s, t], [t, s], 1.0),
                {"sensors": _enumerated(names), "where": where},
                price,
            )


# Sensors of the model.


def _placed(rows: Mapping[int, scipy.sparse.csr_array]) -> Callable[[State], State]:
    def change(state: State) -> State:
        if state.selection is None:
            return state
        selection = state.selection.tolil()
        for s, row in rows.items():
            selection[[s]] = row.tolil()
        return replace(state, selection=selection.tocsr())

    return change


def _spatial(setting: Setting) -> Geometry | None:
    """Return the geometry of a model whose nodes move along several axes."""
    geometry = setting.geometry
    return geometry if geometry is not None and len(geometry.axes) > 1 else None


def _moved(setting: Setting) -> Iterator[Variant]:
    """Yield single sensors at other nodes, direction kept; along one axis, degrees of freedom."""
    selection, geometry = setting.state.selection, _spatial(setting)
    if selection is None:
        return
    found: list[tuple[float, int, int, scipy.sparse.csr_array]] = []
    count = 0
    for s in setting.measured_sensors:
        own = selection[[s]]
        if geometry is not None:
            nodes = np.arange(len(geometry.nodes))
            rows = geometry.weights(nodes, np.tile(geometry.sensor_directions[s], (nodes.size, 1)))
        elif own.nnz == 1:
            rows = (own.sum() * scipy.sparse.eye_array(own.shape[1])).tocsr()
        else:
            continue
        there = abs(rows).sum(axis=1) > 0
        if not there.any():
            continue
        count = max(count, int(there.sum()) - 1)
        gains = np.where(there, setting.gain(s, rows), -np.inf)
        for k in np.argsort(-gains)[: PER_SENSOR + 1].tolist():
            if abs(rows[[k]] - own).sum() > 0 and np.isfinite(gains[k]):
                found.append((float(gains[k]), s, k, rows[[k]]))
    price = _shared(count * len(setting.measured_sensors))
    for _, s, k, row in sorted(found, key=lambda each: -each[0])[:TRIED]:
        if geometry is not None:
            given, place = (
                f"({', '.join(f'{x:.4g}' for x in geometry.nodes[n])})"
                for n in (geometry.sensor_nodes[s], k)
            )
        else:
            given, place = (f"degree of freedom {d}" for d in (int(selection[[s]].indices[0]), k))
        others = [
            setting.sensors[t]
            for t in range(selection.shape[0])
            if t != s and not abs(selection[[t]] - selection[[s]]).sum()
        ]
        too = f", where the model has {_enumerated(others)} too" if others else ""
        numbers = {"sensor": setting.sensors[s], "given": given, "place": place, "too": too}
        yield Variant((setting.sensors[s],), _placed({s: row}), numbers, price - 2.0 * bool(others))


def _turned(setting: Setting) -> Iterator[Variant]:
    """Yield other directions: of single sensors, of all along an axis, of two axes exchanged."""
    geometry, selection = _spatial(setting), setting.state.selection
    if geometry is None or selection is None:
        return
    directions = geometry.sensor_directions
    axis = np.where(np.abs(directions).max(axis=1) > ALONG, np.abs(directions).argmax(axis=1), -1)
    size = np.sign(directions[np.arange(len(axis)), axis])
    groups = {a: np.flatnonzero(axis == a).tolist() for a in range(3)}
    free = _shared(2 * len(geometry.axes) * len(setting.measured_sensors))

    def variant(along: Mapping[int, tuple[int, float]], given: str, better: str, price: float) -> Variant:
        new = np.array([sign * size[s] * np.eye(3)[b] for s, (b, sign) in along.items()])
        at = geometry.weights(geometry.sensor_nodes[list(along)], new)
        rows = {s: at[[i]] for i, s in enumerate(along)}
        names = [setting.sensors[s] for s in along]
        better = better or " and ".join([axis_name(new[0])])
        numbers = {"sensors": _enumerated(names), "given": given, "better": better, "s": "s" * (len(names) == 1)}
        return Variant(tuple(names), _placed(rows), numbers, price)

    for a, members in groups.items():
        others = [b for b in geometry.axes if b != a]
        for b in others:
            for sign in (1.0, -1.0):
                if len(members) > 1:
                    given = axis_name(directions[members[0]])
                    yield variant(dict.fromkeys(members, (b, sign)), given, "", _shared(12))
                for s in members:
                    yield variant({s: (b, sign)}, axis_name(directions[s]), "", free)
    for a, b in ((0, 1), (0, 2), (1, 2)):
        if groups[a] and groups[b]:
            both = dict.fromkeys(groups[a], (b, 1.0)) | dict.fromkeys(groups[b], (a, 1.0))
            names = f"{AXES[a]} and {AXES[b]}", f"{AXES[b]} and {AXES[a]}"
            yield variant(both, *names, _shared(12))


def _counted(setting: Setting) -> Iterator[Variant]:
    geometry, selection = _spatial(setting), setting.state.selection
    if selection is None:
        return
    what = "nodes"
    if geometry is not None:
        if (geometry.sensor_nodes == 0).any() or not geometry.sensor_directions.any(axis=1).all():
            return
        shifted = geometry.weights(geometry.sensor_nodes - 1, geometry.sensor_directions)
    else:
        what, entries = "degrees of freedom", selection.tocoo()
        if not entries.col.size or entries.col.min() == 0:
            return
        parts = entries.data, (entries.row, entries.col - 1)
        shifted = scipy.sparse.csr_array(parts, shape=selection.shape)
    rows = {s: shifted[[s]] for s in range(selection.shape[0])}
    yield Variant(("places",), _placed(rows), {"what": what})


# Units.


def _with_frequency(new: Callable[[Floats], Floats]) -> Callable[[State], State]:
    return lambda state: replace(state, data=replace(state.data, frequency=new(state.data.frequency)))


RAD = 2 * np.pi
G = float(np.sqrt(9.81))

UNITS: Sequence[tuple[float, str, str]] = (
    (RAD, "they look like rad/s, 2π times Hz", "divide the column 'frequency' by 6.2832 (2π)"),
    (
        1 / RAD,
        "the model looks as if its matrices gave Hz for rad/s, or the data are divided by 2π twice",
        "see that eigenvalues of K and M are (rad/s)², and multiply the data by 6.2832 (2π) where "
        "they are not in Hz",
    ),
    (60.0, "they look like revolutions or cycles per minute", "divide 'frequency' by 60"),
    (1e3, "they look like mHz, or E is in MPa, or lengths in mm, where all else is in SI units", ""),
    (1e-3, "they look like kHz, or lengths are in m where all else is in N, mm and t", ""),
    (
        G,
        "the model looks as if weight were given for mass, a factor of g = 9.81 on M",
        "divide masses and densities by 9.81",
    ),
    (
        1 / G,
        "the model looks as if stiffness were g = 9.81 times too great, or mass 9.81 too small",
        "",
    ),
    (10**1.5, "masses look like kg with stiffness in kN, or like t with N", ""),
    (10**-1.5, "masses look like t with stiffness in N, or like kg with kN", ""),
    (10**4.5, "E looks like GPa where all else is in SI units", ""),
    (10**-4.5, "E looks like Pa where it should be GPa", ""),
    (1e6, "lengths look like mm with thicknesses and sections in m", ""),
    (1e-6, "densities look like t/mm³, or sections like mm with lengths in m", ""),
)
"""Measured frequencies over the model's, what makes them so, and what mends it."""

CONSISTENT = "give lengths, forces and masses in consistent units: m, N, kg or mm, N, t"


def _factors(setting: Setting) -> Iterator[Variant]:
    """Yield known factors on all frequencies, and the one that the pairs show."""
    price = _shared(len(UNITS))
    for factor, looks, mend in UNITS:
        yield _factor(factor, f": {looks}", mend or CONSISTENT, price)
    for factor in sorted(_ratios(setting)):
        what = f": stiffness over mass is off by {factor**2:.3g}"
        mend = "check units, sections and masses, or the nominal values of the parameters"
        yield _factor(factor, what, mend, 2 * price)


def _ratios(setting: Setting) -> set[float]:
    """Return factors between measured and model frequencies: of pairs, and of modes in order."""
    logs, out = setting.state.data.logs, set()
    known = np.flatnonzero(np.isfinite(logs))
    for point, f in zip(setting.points, setting.frequencies, strict=True):
        elastic = np.log(f[f > RIGID * f.max()])
        if not known.size or not elastic.size:
            continue
        of_pairs = np.median(logs[known] - log_frequencies(f)[point.index[known]])
        in_order = np.sort(logs[known])[: elastic.size] - elastic[: known.size]
        for value in (of_pairs, np.median(in_order), *(np.sort(logs[known])[0] - elastic[:3])):
            out.add(round(float(np.exp(value)), 6))
    return {factor for factor in out if factor > 0}


def _factor(factor: float, looks: str, mend: str, price: float) -> Variant:
    numbers = {"factor": factor, "looks": looks, "mend": mend}
    return Variant(("frequencies",), _with_frequency(lambda f: f / factor), numbers, price)



def _quantities(setting: Setting) -> Iterator[Variant]:
    logs = setting.state.data.logs
    for quantity, new in (
        ("periods in s", lambda f: 1 / f),
        ("eigenvalues in (rad/s)²", lambda f: np.sqrt(f) / RAD),
    ):
        r = int(np.flatnonzero(np.isfinite(logs))[0]) if np.isfinite(logs).any() else 0
        given = float(np.exp(logs[r]))
        numbers = {"quantity": quantity, "mode": setting.modes[r], "given": given, "f": float(new(given))}
        yield Variant(("frequencies",), _with_frequency(new), numbers)


def _damping(setting: Setting) -> Iterator[Variant]:
    zeta = setting.state.data.damping
    known = zeta[np.isfinite(zeta)]
    if known.size:
        numbers = {"least": float(known.min()), "greatest": float(known.max())}

        def change(state: State) -> State:
            return replace(state, data=replace(state.data, damping=state.data.damping / 100))

        yield Variant(("damping",), change, numbers)


# Parameters.


def _nominal(setting: Setting) -> Iterator[Variant]:
    state = setting.state
    powers = [sign * k for k in (1, 2, 3, 6, 9) for sign in (1, -1)]
    price = _shared(len(powers) * len(setting.parameters))
    for j, name in enumerate(setting.parameters):
        for power in powers if state.is_positive[j] else ():
            factor = np.ones(len(setting.parameters))
            factor[j] = 10.0**power

            def change(state: State, factor: Floats = factor) -> State:
                values = (state.start * factor, state.lower * factor, state.upper * factor)
                return replace(state, start=values[0], lower=values[1], upper=values[2])

            numbers = {"name": name, "given": float(state.start[j]), "better": float(state.start[j] * 10.0**power)}
            yield Variant((name,), change, numbers, price)


def _bound(setting: Setting) -> Iterator[Variant]:
    """Yield bounds at which the fit ends, moved away by a factor of four, or half the range."""
    state, theta = setting.state, setting.points[-1].theta
    for j, name in enumerate(setting.parameters):
        room = state.upper[j] - state.lower[j]
        for side, bound, away in (("lower", state.lower[j], -1), ("upper", state.upper[j], 1)):
            if abs(theta[j] - bound) > 1e-6 * room or state.start[j] == bound:
                continue
            new = bound * 4.0**away if state.is_positive[j] else bound + away * room / 2

            def change(state: State, side: str = side, j: int = j, new: float = new) -> State:
                values = getattr(state, side).copy()
                values[j] = new
                return replace(state, **{side: values})

            numbers = {"name": name, "side": side, "bound": float(bound)}
            yield Variant((name, side), change, numbers, _shared(2 * len(setting.parameters)))


# Single data sets, and single modes.


def _others(setting: Setting, k: int) -> str:
    return _enumerated([name for i, name in enumerate(setting.sets) if i != k], 2)


def _set_factors(setting: Setting) -> Iterator[Variant]:
    f = setting.state.data.frequency
    for k, name in enumerate(setting.sets if len(setting.sets) > 1 else ()):
        ratios = np.log(f[k] / np.exp(median(np.log(np.delete(f, k, axis=0)))))
        if np.isfinite(ratios).sum() < 2:
            continue
        factor = float(np.exp(np.nanmedian(ratios)))
        names = {RAD: ": rad/s for Hz", 1 / RAD: ": Hz for rad/s", 60.0: ": per minute for Hz"}
        looks = next((text for x, text in names.items() if abs(np.log(factor / x)) < 0.1), "")
        percent = 100 * (factor - 1)
        size = f"{factor:.3g} times" if abs(percent) > 40 else f"{percent:+.1f} % off"
        mend = (
            "give all data sets in Hz"
            if abs(percent) > 40
            else "the structure differed (mass, temperature, supports): update with one of the sets, "
            "or say by frequency_std how far frequencies scatter"
        )
        numbers = {"set": name, "size": size, "other": _others(setting, k), "looks": looks, "mend": mend}

        def change(state: State, k: int = k, factor: float = factor) -> State:
            f = state.data.frequency.copy()
            f[k] /= factor
            return replace(state, data=replace(state.data, frequency=f))

        yield Variant((name,), change, numbers, _shared(len(setting.sets)))


def _numbers(setting: Setting) -> Iterator[Variant]:
    """Yield the numbering of the modes of each set that makes it most like the others."""
    data = setting.state.data
    for k, name in enumerate(setting.sets if len(setting.sets) > 1 else ()):
        rest = replace(
            data,
            **{x: np.delete(getattr(data, x), k, axis=0) for x in ("frequency", "damping", "shape", "std")},
        )
        mac = mac_values(data.psi[k], data.seen[k], rest.mean.T)
        distance = np.abs(np.log(data.frequency[k])[:, None] - rest.logs)
        keep = 1.0 - np.eye(len(setting.modes))
        known = np.isfinite(mac) | np.isfinite(distance)
        cost = np.where(np.isfinite(mac), 1 - mac, 0.0) + np.nan_to_num(np.minimum(4 * distance, 1.0))
        index = assigned(np.where(known, cost, keep))
        rows = np.flatnonzero(index != np.arange(index.size))
        if not rows.size or np.unique(index).size < index.size:
            continue

        def change(state: State, k: int = k, index: Any = index) -> State:
            parts = {}
            for part in ("frequency", "damping", "shape", "std"):
                values = getattr(state.data, part).copy()
                values[k, index] = getattr(state.data, part)[k]
                parts[part] = values
            return replace(state, data=replace(state.data, **parts))

        modes, of = (_enumerated([str(setting.modes[r]) for r in x]) for x in (rows, index[rows]))
        numbers = {"set": name, "other": _others(setting, k), "modes": modes, "of": of}
        yield Variant((name,), change, numbers, _shared(len(setting.sets)))


def _odd(setting: Setting, part: str) -> Iterator[Variant]:
    """Yield the values of single sets that differ most from the others, one a mode (of two: both)."""
    data, count = setting.state.data, len(setting.sets)
    if part == "frequency":
        away = np.abs(np.log(data.frequency) - data.logs)
    else:
        away = ((data.psi - data.factors(data.mean) * data.mean) ** 2).sum(axis=2)
        away[~data.seen.any(axis=2)] = np.nan
    price = _shared(count * len(setting.modes))
    for r, mode in enumerate(setting.modes if count > 1 else ()):
        known = np.flatnonzero(np.isfinite(away[:, r]))
        for k in known[np.argsort(-away[known, r])][: 2 if known.size > 1 else 0].tolist():

            def change(state: State, k: int = k, r: int = r) -> State:
                values = getattr(state.data, part).copy()
                lost = int(np.isfinite(values[k, r]).sum())
                values[k, r] = np.nan
                data = replace(state.data, **{part: values})
                return replace(state, data=data, left_out=state.left_out + lost)

            others = [setting.sets[j] for j in known.tolist() if j != k]
            numbers = {
                "mode": mode,
                "who": f"set {setting.sets[k]} disagrees with {_enumerated(others, 3)}"
                if len(others) > 1
                else f"sets {setting.sets[max(k, *known)]} and {setting.sets[min(k, *known)]} disagree",
                "mend": f"look at set {setting.sets[k]} again, or leave out its"
                if len(others) > 1
                else "look at both again, or leave out the worse",
            }
            if part == "frequency":
                f = data.frequency[:, r]
                numbers |= {"f": float(f[k]), "other": float(np.exp(np.median(np.log(f[[j for j in known if j != k]]))))}
                numbers["percent"] = 100 * (numbers["f"] / numbers["other"] - 1)
            yield Variant((str(mode), *([setting.sets[k]] if known.size > 2 else [])), change, numbers, price)


def _foreign(setting: Setting) -> Iterator[Variant]:
    """Yield modes that the model does not have."""
    data = setting.state.data
    highest = max(float(f.max()) for f in setting.frequencies)
    for r, mode in enumerate(setting.modes):
        f = float(np.exp(data.logs[r]))

        def change(state: State, r: int = r) -> State:
            foreign = state.foreign.copy()
            foreign[r] = True
            return replace(state, foreign=foreign)

        at = "" if np.isnan(f) else f" at {f:.4g} Hz"
        looked = f" (the modes that were looked at end at {highest:.4g} Hz)" if f > highest else ""
        yield Variant((str(mode),), change, {"mode": mode, "at": at, "looked": looked}, _shared(len(setting.modes)))


RARE, USUAL, OFTEN = 0.003, 0.02, 0.05
"""Probabilities of mistakes."""

MISTAKES: Sequence[Mistake] = (
    Mistake(
        "frequency-factor",
        OFTEN,
        "all measured frequencies are about {factor:.3g} times the model's{looks}",
        "{mend}",
        _factors,
    ),
    Mistake(
        "other-quantity",
        RARE,
        "the column 'frequency' looks like {quantity}: mode {mode} has {given:.4g}, which is "
        "{f:.4g} Hz",
        "give frequencies in Hz",
        _quantities,
    ),
    Mistake(
        "set-factor",
        USUAL,
        "all frequencies of set {set} are {size} those of {other}{looks}",
        "{mend}",
        _set_factors,
    ),
    Mistake(
        "set-numbers",
        USUAL,
        "modes {modes} of set {set} are modes {of} of {other}, by frequencies and shapes",
        "number the modes of set {set} like those of {other}",
        _numbers,
    ),
    Mistake(
        "reversed-sensor",
        OFTEN,
        "sensor {sensor} is reversed in {where}",
        "check the direction of {sensor}, and change the sign of its column, or of the direction "
        "in the model",
        _reversed,
    ),
    Mistake(
        "exchanged-sensors",
        OFTEN,
        "sensors {sensors} are exchanged in {where}",
        "check the cables of {sensors}, and exchange their columns or sensors",
        _exchanged,
    ),
    Mistake(
        "counted-from-one",
        USUAL,
        "the {what} of the sensors look as if they were counted from 1",
        "count {what} from 0: subtract 1 from each in [model.sensors]",
        _counted,
    ),
    Mistake(
        "wrong-direction",
        OFTEN,
        "direction {given} of {sensors} does not match the data: they fit along {better}",
        'check along which axis {sensors} measure{s}, and write direction = "{better}"',
        _turned,
    ),
    Mistake(
        "wrong-place",
        USUAL,
        "sensor {sensor} fits the data at {place} and not at {given}{too}",
        "check where {sensor} was in the test, and write its place in [model.sensors]",
        _moved,
    ),
    Mistake(
        "nominal-value",
        USUAL,
        "the nominal value of {name} is {given:.4g}, and the data say about {better:.4g}",
        "check the unit of {name}, its nominal value and its bounds",
        _nominal,
    ),
    Mistake(
        "bound",
        USUAL,
        "the {side} bound {bound:.4g} of {name} excludes the values that fit the data",
        "widen the bounds of {name}, or find what else differs between model and structure",
        _bound,
    ),
    Mistake(
        "odd-frequency",
        OFTEN,
        "{who} in the frequency of mode {mode}: {f:.5g} and {other:.5g} Hz, {percent:+.1f} %",
        "{mend} value",
        lambda setting: _odd(setting, "frequency"),
    ),
    Mistake(
        "odd-shape",
        OFTEN,
        "{who} in the shape of mode {mode}",
        "{mend} shape",
        lambda setting: _odd(setting, "shape"),
    ),
    Mistake(
        "damping",
        OFTEN,
        "damping of {least:.3g} to {greatest:.3g} looks like percent",
        "give the ratio to critical damping: divide the column 'damping' by 100",
        _damping,
    ),
    Mistake(
        "foreign-mode",
        OFTEN,
        "measured mode {mode}{at} is none of the model's{looked}",
        "check its shape, refine the model, or leave it out of the groups",
        _foreign,
    ),
)
