"""How reliable the diagnosis is: random studies, correct ones and with one or two mistakes.

    python benchmarks/check.py [--studies 100] [--first 0] [--verbose]

Every study has a model of its own: masses between two walls, a tower of four columns with sensors
along two axes, or a plate with two edges clamped. The structure differs from it in its parameters
(log-normal, 25 %) and in what no parameter describes (2 % of each frequency, 4 % of every other
mode in each shape), and the data have noise (0.5 % of frequencies, 3 % of shapes) in one to three
sets, with gaps. Mistakes that no data could show are not made: of sensors that hardly move, and
places that move alike.

Prints the share of correct studies with a false alarm; of studies with one mistake and with two,
the share of mistakes that are named (alone, or as one of two or three that the data cannot tell
apart), by kind, and the share in which an innocent is blamed; the processor time. Pairs that a
window mends count as neither, since shapes alone, by which studies pair here, do not always tell
modes apart.
"""

from __future__ import annotations

import argparse
import time
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from modefront import fem
from modefront._typing import Floats
from modefront.data.modal import ModalData
from modefront.diagnosis.comparison import compare
from modefront.diagnosis.search import diagnose
from modefront.findings.record import Finding
from modefront.linalg.affine import DenseAffine
from modefront.linalg.small import mac
from modefront.models.chain import chain
from modefront.models.geometry import Geometry
from modefront.models.matrices import MatrixModel
from modefront.models.mesh import mesh_model
from modefront.residuals.groups import Group
from modefront.residuals.problem import UpdatingProblem

ALUMINIUM = fem.Material(E=70e9, nu=0.33, rho=2700.0)

Claim = tuple[str, ...]
"""Kind of a mistake, and whom it blames."""

OF_COLUMNS = {
    *("reversed-sensor", "exchanged-sensors", "sensor-factor", "copied-sensor", "odd-sensor"),
    "reversed-value",
}
"""Mistakes that are in the columns of sensors: where columns move later, they go with them."""


@dataclass(frozen=True)
class Case:
    """A study, the parameters of its structure, and the mistakes that were made."""

    problem: UpdatingProblem
    theta: Floats
    rng: np.random.Generator
    made: tuple[Claim, ...] = ()

    @property
    def data(self) -> ModalData:
        """The measured modes."""
        return self.problem.data

    @property
    def model(self) -> MatrixModel:
        """The model."""
        assert isinstance(self.problem.model, MatrixModel)
        return self.problem.model

    def spoilt(self, claim: Claim, *, data: Any = None, **changed: Any) -> Case:
        """Return the study with other parts of the data, or of the problem."""
        parts = {"data": replace(self.data, **data)} if data else changed
        return replace(self, problem=replace(self.problem, **parts), made=(*self.made, claim))

    def moved(self, columns: Mapping[str, str]) -> Case:
        """Return the study whose mistakes in columns of sensors are where the columns went."""
        made = []
        for kind, *names in self.made:
            now = [columns.get(x, x) for x in names] if kind in OF_COLUMNS else names
            made.append((kind, *(sorted(now) if kind == "exchanged-sensors" else now)))
        return replace(self, made=tuple(made))


def random_chain(rng: np.random.Generator) -> MatrixModel:
    """Return 5 to 12 masses between two walls, with a parameter for every one to three springs."""
    n = int(rng.integers(5, 13))
    each = int(rng.integers(1, 4))
    names = [f"k{i // each + 1}" for i in range(n + 1)]
    masses, springs = np.exp(rng.uniform(-0.5, 0.5, n)) * 20, np.exp(rng.uniform(-0.5, 0.5, n + 1))
    chosen = sorted(rng.choice(n, int(rng.integers(4, n + 1)), replace=False).tolist())
    sensors = {f"a{i}": int(i) for i in chosen}
    parameters = list(dict.fromkeys(names))
    return chain(parameters, masses, springs * 1e5, stiffness_parameters=names, sensors=sensors)


def random_tower(rng: np.random.Generator) -> MatrixModel:
    """Return a tower of four columns and 2 to 4 floors of beams, with sensors along x and y."""
    floors, a, b = int(rng.integers(2, 5)), rng.uniform(0.3, 0.4), rng.uniform(0.45, 0.6)
    corners = [(0.0, 0.0), (a, 0.0), (a, b), (0.0, b)]
    nodes = [(x, y, 0.4 * z) for z in range(floors + 1) for x, y in corners]
    column, beam = fem.rectangle(0.012, 0.018), fem.rectangle(0.03, 0.02)
    groups = []
    for s in range(1, floors + 1):
        up = [(4 * (s - 1) + c, 4 * s + c) for c in range(4)]
        round_ = [(4 * s + c, 4 * s + (c + 1) % 4) for c in range(4)]
        groups.append(fem.Beams(f"columns{s}", up, ALUMINIUM, column, (1.0, 0.0, 0.0)))
        groups.append(fem.Beams(f"beams{s}", round_, ALUMINIUM, beam, (0.0, 0.0, 1.0)))
    above = list(range(4, 4 * floors + 4))
    sensors = [
        fem.Sensor(f"{axis}{node}", node, f"{rng.choice(['', '-'])}{axis}")
        for node in above
        for axis in "xy"
        if rng.uniform() < 0.6
    ]
    parameters = [fem.Parameter(f"c{s}", "E", (f"columns{s}",)) for s in range(1, floors + 1)]
    parameters.append(fem.Parameter("m", "mass", ("plates",)))
    structure = fem.Structure(
        np.array(nodes),
        groups,
        [fem.Support([0, 1, 2, 3])],
        masses=[fem.Mass("plates", above, rng.uniform(0.3, 1.0))],
        sensors=sensors,
        parameters=parameters,
    )
    return mesh_model(structure, [parameter.name for parameter in parameters])


def random_plate(rng: np.random.Generator) -> MatrixModel:
    """Return a plate of three strips, two edges of which are clamped, with 8 to 18 sensors."""
    X, cells = fem.grids.plate(rng.uniform(1.2, 1.6), rng.uniform(0.7, 0.9), 6, 4)
    strip = np.minimum((3 * X[cells].mean(axis=1)[:, 0] / X[:, 0].max()).astype(int), 2)
    clamped = np.flatnonzero((X[:, 0] < 1e-9) | (X[:, 1] < 1e-9))
    free = np.setdiff1d(np.arange(len(X)), clamped)
    nodes = sorted(rng.choice(free, int(rng.integers(8, 19)), replace=False).tolist())
    names = [f"strip{k + 1}" for k in range(3)]
    structure = fem.Structure(
        X,
        [fem.Shells(name, cells[strip == k], ALUMINIUM, 0.008) for k, name in enumerate(names)],
        [fem.Support(clamped)],
        sensors=[fem.Sensor(f"p{node}", node, "z") for node in nodes],
        parameters=[fem.Parameter(name, "E", (name,)) for name in names],
    )
    return mesh_model(structure, names)


def simulated(model: MatrixModel, theta: Floats, rng: np.random.Generator) -> ModalData:
    """Return the modal data of a structure like the model, in one to three data sets."""
    count = min(int(rng.integers(3, 8)), model.size)
    modes = model.full_modes(theta, count)
    # What no parameter describes: each mode takes in a little of the others.
    mixing = np.eye(count) + 0.04 * rng.standard_normal((count, count))
    phi = (model.selection @ modes.Phi) @ mixing
    f = np.sqrt(modes.lam) / (2 * np.pi) * np.exp(0.02 * rng.standard_normal(count))
    seen = np.abs(phi).max(axis=0) > 0.1 * np.abs(phi).max()
    order = np.argsort(f[seen])
    f, phi = f[seen][order], phi[:, seen][:, order]
    sets, m, n = int(rng.integers(1, 4)), f.size, phi.shape[0]
    frequency = f * np.exp(0.005 * rng.standard_normal((sets, m)))
    size = np.sqrt((phi**2).mean(axis=0))[None, :, None]
    shape = phi.T[None] + 0.03 * size * rng.standard_normal((sets, m, n))
    shape *= rng.choice([-1.0, 1.0], (sets, m, 1)) * np.exp(rng.standard_normal((sets, m, 1)))
    shape[rng.uniform(size=shape.shape) < 0.02] = np.nan
    damping = np.exp(rng.normal(np.log(0.01), 0.5, (sets, m)))
    nothing = np.full(frequency.shape, np.nan)
    return ModalData(
        tuple(f"run{k + 1}" for k in range(sets)),
        tuple(range(1, m + 1)),
        model.sensors,
        *(frequency, damping, shape, nothing, np.full(shape.shape, np.nan)),
    )


FAMILIES = (random_chain, random_tower, random_plate)


def random_case(seed: int, far: float = 1.0) -> Case:
    """Return a correct study; the structure's first parameter is ``far`` from the nominal one."""
    rng = np.random.default_rng([seed, 36])
    while True:
        model = FAMILIES[seed % len(FAMILIES)](rng)
        p = len(model.parameters)
        theta = np.clip(np.exp(0.25 * rng.standard_normal(p)), 0.4, 2.5)
        theta[0] = theta[0] if far == 1 else far
        data = simulated(model, theta, rng)
        if len(data.modes) > 2 and len(data.sensors) > 3:
            break
    groups = (Group("frequencies", frequency="all"), Group("shapes", shape="all"))
    unit = np.ones(p)
    problem = UpdatingProblem(model, data, groups, 0.2 * unit, 5.0 * unit, unit)
    return Case(problem, theta, rng)


def _psi(case: Case) -> Floats:
    """Return the shapes with a mean square of 1."""
    psi = np.nan_to_num(case.data.shape)
    return np.asarray(psi / np.sqrt((psi**2).mean(axis=2, keepdims=True)))


def _sensor(case: Case) -> int | None:
    """Return a sensor that moves at least half as much as the mean, and nobody has blamed yet."""
    moves = (_psi(case) ** 2).mean(axis=(0, 1)) > 0.5
    blamed = {name for claim in case.made for name in claim}
    fit = [s for s in np.flatnonzero(moves).tolist() if case.data.sensors[s] not in blamed]
    return int(case.rng.choice(fit)) if fit else None


def factor(case: Case) -> Case | None:
    """Return the study with frequencies in rad/s, or a model in units that do not agree."""
    factors = [2 * np.pi, 2 * np.pi, 60.0, 10**1.5, 10**-1.5, 1e3, 1e-3, 10**4.5]
    data = {"frequency": float(case.rng.choice(factors)) * case.data.frequency}
    return case.spoilt(("frequency-factor", "frequencies"), data=data)


def set_factor(case: Case) -> Case | None:
    """Return the study with the frequencies of one of several data sets in rad/s."""
    f, k = case.data.frequency.copy(), int(case.rng.integers(len(case.data.sets)))
    f[k] *= 2 * np.pi
    claim = ("set-factor", case.data.sets[k])
    return case.spoilt(claim, data={"frequency": f}) if len(f) > 1 else None


def reversal(case: Case) -> Case | None:
    """Return the study with a sensor reversed in all data sets, or in one of them."""
    s, sets = _sensor(case), len(case.data.sets)
    k = slice(None) if case.rng.uniform() < 0.7 else int(case.rng.integers(sets))
    if s is None:
        return None
    shape = case.data.shape.copy()
    shape[k, ..., s] *= -1
    return case.spoilt(("reversed-sensor", case.data.sensors[s]), data={"shape": shape})


def _unlike(case: Case) -> tuple[int, int] | None:
    """Return two sensors that do not move alike, of which nothing is wrong so far."""
    s, psi = _sensor(case), _psi(case)
    if s is None:
        return None
    unlike = ((psi - psi[:, :, [s]]) ** 2).mean(axis=(0, 1)) > 0.5
    blamed = {name for claim in case.made for name in claim}
    fit = [t for t in np.flatnonzero(unlike).tolist() if case.data.sensors[t] not in blamed]
    return (s, int(case.rng.choice(fit))) if fit else None


def exchange(case: Case) -> Case | None:
    """Return the study with two sensors exchanged that do not move alike."""
    pair = _unlike(case)
    if pair is None:
        return None
    (s, t), shape = pair, case.data.shape.copy()
    shape[:, :, [s, t]] = shape[:, :, [t, s]]
    names = sorted([case.data.sensors[s], case.data.sensors[t]])
    return case.spoilt(("exchanged-sensors", *names), data={"shape": shape})


def _placed(case: Case, claim: Claim, s: Sequence[int], nodes: Any, directions: Any) -> Case | None:
    """Return the study with sensors at other places, if they move there, and otherwise."""
    model, geometry = case.model, case.model.geometry
    assert geometry is not None
    all_nodes, all_directions = geometry.sensor_nodes.copy(), geometry.sensor_directions.copy()
    all_nodes[s], all_directions[s] = nodes, directions
    selection = geometry.weights(all_nodes, all_directions)
    Phi = model.full_modes(case.theta, min(len(case.data.modes), model.size)).Phi
    if not abs(selection).sum(axis=1).all():
        return None
    if np.mean(1 - np.diag(mac(model.selection @ Phi, selection @ Phi))) < 0.03:
        return None
    moved = replace(geometry, sensor_nodes=all_nodes, sensor_directions=all_directions)
    return case.spoilt(claim, model=replace(model, selection=selection, geometry=moved))


def _geometry(case: Case) -> Geometry:
    assert case.model.geometry is not None
    return case.model.geometry


def direction(case: Case) -> Case | None:
    """Return the study of a tower with a sensor along the other axis."""
    geometry, s = _geometry(case), _sensor(case)
    if s is None or len(geometry.axes) < 2:
        return None
    turned = geometry.sensor_directions[s][[1, 0, 2]]
    return _placed(
        case, ("wrong-direction", case.data.sensors[s]), [s], geometry.sensor_nodes[s], turned
    )


def directions(case: Case) -> Case | None:
    """Return the study of a tower with all sensors along the other axis."""
    geometry = _geometry(case)
    if len(geometry.axes) < 2:
        return None
    every, turned = list(range(len(case.data.sensors))), geometry.sensor_directions[:, [1, 0, 2]]
    return _placed(case, ("wrong-direction", "all"), every, geometry.sensor_nodes, turned)


def place(case: Case) -> Case | None:
    """Return the study with a sensor at another node, half of the time that of another sensor."""
    geometry, s = _geometry(case), _sensor(case)
    if s is None:
        return None
    at = np.delete(geometry.sensor_nodes, s)
    if case.rng.uniform() < 0.5:
        at = np.setdiff1d(np.arange(len(geometry.nodes)), geometry.sensor_nodes)
    for node in case.rng.permutation(at).tolist():
        claim = ("wrong-place", case.data.sensors[s])
        moved = _placed(case, claim, [s], node, geometry.sensor_directions[s])
        if moved is not None:
            return moved
    return None


def counted(case: Case) -> Case | None:
    """Return the study with nodes, or degrees of freedom, counted from 1."""
    geometry = _geometry(case)
    nodes = geometry.sensor_nodes + 1
    if nodes.max() >= len(geometry.nodes):
        return None
    every = list(range(len(nodes)))
    return _placed(case, ("counted-from-one",), every, nodes, geometry.sensor_directions)


def nominal(case: Case) -> Case | None:
    """Return the study with one nominal value off by a thousand, or a hundred."""
    problem, j = case.problem, int(case.rng.integers(len(case.model.parameters)))
    factor = np.ones(len(case.model.parameters))
    factor[j] = float(case.rng.choice([1e3, 1e-3, 1e2]))
    values = {x: getattr(problem, x) * factor for x in ("start", "lower", "upper")}
    claim = ("nominal-value", case.model.parameters[j])
    return case.spoilt(claim, **values) if factor.size > 1 else None


def percent(case: Case) -> Case | None:
    """Return the study with damping in percent, as far as a file with it can be read."""
    damping = np.minimum(100 * case.data.damping, 0.999)
    return case.spoilt(("damping", "damping"), data={"damping": damping})


def odd_frequency(case: Case) -> Case | None:
    """Return the study with one frequency of one data set off by 8 to 20 %."""
    f = case.data.frequency.copy()
    k, r = (int(case.rng.integers(size)) for size in f.shape)
    f[k, r] *= 1 + case.rng.choice([-1, 1]) * case.rng.uniform(0.08, 0.2)
    claim = ("odd-frequency", str(case.data.modes[r]))
    return case.spoilt(claim, data={"frequency": f}) if len(f) > 1 else None


def numbers(case: Case) -> Case | None:
    """Return the study with two modes of one data set exchanged."""
    k = int(case.rng.integers(len(case.data.sets)))
    r = int(case.rng.integers(len(case.data.modes) - 1))
    parts = {x: getattr(case.data, x).copy() for x in ("frequency", "damping", "shape")}
    for values in parts.values():
        values[k, [r, r + 1]] = values[k, [r + 1, r]]
    claim = ("set-numbers", case.data.sets[k])
    return case.spoilt(claim, data=parts) if len(case.data.sets) > 1 else None


def calibration(case: Case) -> Case | None:
    """Return the study with a sensor of another sensitivity or unit."""
    s = _sensor(case)
    if s is None:
        return None
    shape = case.data.shape.copy()
    shape[..., s] *= case.rng.choice([10.0, 0.1, 9.81, 1 / 9.81, 1e3, 2.0])
    return case.spoilt(("sensor-factor", case.data.sensors[s]), data={"shape": shape})


def pasted(case: Case) -> Case | None:
    """Return the study with the column of a sensor in the place of one that moves otherwise."""
    pair = _unlike(case)
    if pair is None:
        return None
    (s, t), shape = pair, case.data.shape.copy()
    shape[:, :, t] = shape[:, :, s]
    return case.spoilt(("copied-sensor", case.data.sensors[t]), data={"shape": shape})


def shifted(case: Case) -> Case | None:
    """Return the study with a cell lost in a row of shapes, or in all: the rest moves up to it."""
    sets, modes, n = case.data.shape.shape
    start, shape = int(case.rng.integers(n - 2)), case.data.shape.copy()
    k, r = int(case.rng.integers(sets)), int(case.rng.integers(modes))
    where = f"mode {case.data.modes[r]}" + f" of set {case.data.sets[k]}" * (sets > 1)
    row = shape[k, r] if case.rng.uniform() < 0.5 else shape
    if row.ndim > 1:
        where = "all data"
    old = row.copy()
    row[..., start:-1], row[..., -1] = row[..., start + 1 :].copy(), np.nan
    psi, true = np.nan_to_num(row), np.nan_to_num(old)
    cross, size = (psi * true).sum(axis=-1) ** 2, (psi**2).sum(axis=-1) * (true**2).sum(axis=-1)
    if np.mean(1 - cross / size) < 0.1:
        return None
    names = case.data.sensors
    if row.ndim > 1:
        if any(names[start] in claim for claim in case.made):
            return None
        case = case.moved(dict(zip(names[start + 1 :], names[start:-1], strict=True)))
    return case.spoilt(("shifted-values", where), data={"shape": shape})


def misread(case: Case) -> Case | None:
    """Return the study with a frequency of a mode that lacks its decimal point, or is aliased."""
    f, r = case.data.frequency.copy(), int(case.rng.integers(len(case.data.modes)))
    f[:, r] *= case.rng.choice([10.0, 0.1, 100.0, 2.0, 0.5])
    return case.spoilt(("far-from-model", str(case.data.modes[r])), data={"frequency": f})


def _unlike_shapes(case: Case, shape: Floats, least: float) -> bool:
    """Return whether shapes differ from those of a study by ``least`` in the MAC on average."""
    of_both = np.nan_to_num(shape), np.nan_to_num(case.data.shape)
    psi, phi = (x.reshape(-1, x.shape[-1]).T for x in of_both)
    return bool(np.mean(1 - np.diag(mac(psi, phi))) >= least)


def shapes_exchanged(case: Case) -> Case | None:
    """Return the study with the shapes of two modes exchanged, of other frequencies by 10 %."""
    shape, f = case.data.shape.copy(), case.data.mean_frequency
    r, q = sorted(case.rng.choice(f.size, 2, replace=False).tolist())
    shape[:, [r, q]] = shape[:, [q, r]]
    claim = ("exchanged-shapes", *(str(case.data.modes[x]) for x in (r, q)))
    return case.spoilt(claim, data={"shape": shape}) if f[q] > 1.1 * f[r] else None


def turned_round(case: Case) -> Case | None:
    """Return the study with all sensors in the opposite order."""
    shape, names = case.data.shape[..., ::-1], case.data.sensors
    if not _unlike_shapes(case, shape, 0.2):
        return None
    case = case.moved(dict(zip(names, names[::-1], strict=True)))
    return case.spoilt(("opposite-order", "sensors"), data={"shape": shape})


def unsigned(case: Case) -> Case | None:
    """Return the study with magnitudes for shapes."""
    shape = np.abs(case.data.shape)
    claim = ("unsigned-shapes", "shapes")
    return case.spoilt(claim, data={"shape": shape}) if _unlike_shapes(case, shape, 0.2) else None


def channel(case: Case) -> Case | None:
    """Return the study with a sensor without signal, or with noise alone."""
    s, shape = _sensor(case), case.data.shape.copy()
    if s is None or len(shape[0]) < 4:
        return None
    size = np.sqrt(np.nanmean(shape**2, axis=2))
    noise = case.rng.choice([0.0, 0.01, 1.0]) * case.rng.standard_normal(size.shape)
    shape[..., s] = np.where(np.isnan(shape[..., s]), np.nan, size * noise)
    return case.spoilt(("odd-sensor", case.data.sensors[s]), data={"shape": shape})


def slip(case: Case) -> Case | None:
    """Return the study of one data set with the sign of one great value lost."""
    shape, psi = case.data.shape.copy(), np.abs(_psi(case))
    great = np.argwhere(psi[0] > 1.0)
    if len(shape) > 1 or not len(great):
        return None
    r, s = case.rng.choice(great).tolist()
    shape[0, r, s] *= -1
    claim = ("reversed-value", str(case.data.modes[r]), case.data.sensors[s])
    return case.spoilt(claim, data={"shape": shape})


def member(case: Case) -> Case | None:
    """Return the study of a chain with one spring of the model 3 to 5 times too stiff or soft.

    A parameter of its own would make up for it.
    """
    stiffness = case.model.stiffness
    if _geometry(case).cells[0].group != "chain" or not isinstance(stiffness, DenseAffine):
        return None
    springs = np.diagonal(stiffness.terms, 1, 1, 2) != 0
    shared = np.argwhere(springs & (springs.sum(axis=1) > 1)[:, None])
    if not len(shared):
        return None
    term, mass = case.rng.choice(shared)
    factor = case.rng.uniform(3, 5) ** case.rng.choice([-1, 1])
    terms, s = stiffness.terms.copy(), np.zeros(case.model.size)
    s[[mass, mass + 1]] = 1, -1
    terms[term] -= (factor - 1) * terms[term, mass, mass + 1] * np.outer(s, s)
    model = replace(case.model, stiffness=DenseAffine(terms, stiffness.coefficients))
    phi, psi = (
        x.selection @ x.full_modes(case.theta, min(len(case.data.modes), x.size)).Phi
        for x in (case.model, model)
    )
    claim = ("wrong-member", "model")
    return case.spoilt(claim, model=model) if np.mean(1 - np.diag(mac(phi, psi))) > 0.1 else None


MISTAKES: Sequence[Callable[[Case], Case | None]] = (
    *(factor, set_factor, reversal, exchange, direction, directions, place, counted, nominal),
    *(percent, odd_frequency, numbers, calibration, pasted, shifted, misread, shapes_exchanged),
    *(turned_round, unsigned, channel, slip, member),
)


def spoilt_case(seed: int, count: int) -> Case:
    """Return a study with one or two mistakes of different kinds."""
    case = random_case(seed)
    order = np.random.default_rng([seed, count]).permutation(len(MISTAKES)).tolist()
    for spoil in (MISTAKES[i] for i in order):
        made = spoil(case)
        if made is not None and len(case.made) < count:
            case = made
    return case


def claims(found: Finding) -> list[Claim]:
    """Return what a finding claims, and what it says may be instead."""
    out = []
    for each in (found, *found.others):
        names = tuple(each.subject.split(", "))
        if each.kind in ("reversed-sensor", "exchanged-sensors", "sensor-factor"):
            names = tuple(sorted(names[:-1]))
        if each.kind == "copied-sensor":
            names = (each.numbers["sensor"],)
        if each.kind == "wrong-direction" and len(names) > 1:
            names = ("all",)
        if each.kind == "counted-from-one":
            names = ()
        out.append((each.kind, *(names[:1] if each.kind == "odd-frequency" else names)))
    return out


@dataclass
class Rates:
    """Counts of studies, of those in which an innocent is blamed, and of mistakes by kind."""

    studies: int
    blamed: int
    made: Counter[str]
    alone: Counter[str]
    among: Counter[str]

    def add(self, case: Case, found: Sequence[list[Claim]]) -> list[Claim]:
        """Count a study with what was found; return the mistakes that were not."""
        self.studies += 1
        self.blamed += any(not set(each) & set(case.made) for each in found)
        missed = []
        for claim in case.made:
            self.made[claim[0]] += 1
            if [claim] in found:
                self.alone[claim[0]] += 1
            elif any(claim in each for each in found):
                self.among[claim[0]] += 1
            else:
                missed.append(claim)
        return missed

    def lines(self) -> list[str]:
        """Return the rates in words."""
        out = [f"an innocent blamed in {self.blamed} of {self.studies} studies"]
        for kind, made in [*self.made.items(), ("all", self.made.total())]:
            alone, among = (
                counts.total() if kind == "all" else counts[kind]
                for counts in (self.alone, self.among)
            )
            out.append(f"{kind}: {alone} of {made} named, and {among} as one of two or three")
        return out


def main() -> None:
    """Print the rates."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--studies", type=int, default=100)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--verbose", action="store_true")
    options = parser.parse_args()
    longest, started = 0.0, time.process_time()
    for count in (0, 1, 2):
        rates = Rates(0, 0, Counter(), Counter(), Counter())
        for seed in range(options.first, options.first + options.studies):
            case, before = spoilt_case(seed, count), time.process_time()
            found = diagnosed(case)
            longest = max(longest, time.process_time() - before)
            missed = rates.add(case, [claimed for claimed, _ in found])
            wrong = [text for claimed, text in found if not set(claimed) & set(case.made)]
            if options.verbose and (missed or wrong):
                print(
                    f"  {count} {seed}: missed {missed}, said {[x for _, x in found]}", flush=True
                )
        print(f"{count} mistakes in each study:", *rates.lines(), sep="\n  ", flush=True)
    spent = time.process_time() - started
    print(f"{spent:.0f} s of user time, {longest:.1f} s for one study at most")


def diagnosed(case: Case) -> list[tuple[list[Claim], str]]:
    """Return what is claimed of a study, with its words."""
    found = diagnose(compare(case.problem))
    return [(claims(each), str(each)) for each in found if not np.isnan(each.gain)]


if __name__ == "__main__":
    main()
