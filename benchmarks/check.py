"""False alarms and hits of the diagnosis: random studies, correct ones and with one mistake each.

    python benchmarks/check.py [--studies 100] [--mistake NAME] [--verbose]

Every study has a model of its own (a chain, a plane frame or a plate in bending), a structure that
differs from it in its parameters (log-normal, 25 %) and in what no parameter describes (2 % of
each frequency, 4 % of every other mode in each shape), and modal data with noise (0.5 % of
frequencies, 3 % of shapes) in one to three data sets, with gaps. Prints, for correct studies, the
share without any finding, and the share without any but pairs that are far apart: the rule of the
study pairs by shapes alone, and few sensors do not tell modes apart. For each mistake it prints the
share in which it is found, and in which nothing else is said but such pairs.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse

from modefront import fem
from modefront._typing import Floats
from modefront.data.modal import ModalData
from modefront.diagnosis.comparison import compare
from modefront.diagnosis.diagnose import diagnose
from modefront.diagnosis.words import in_words
from modefront.models.chain import chain
from modefront.models.matrices import MatrixModel
from modefront.models.mesh import mesh_model
from modefront.pairing.mac import mac
from modefront.residuals.groups import Group
from modefront.residuals.problem import UpdatingProblem

STEEL = fem.Material(E=210e9, nu=0.3, rho=7850.0)


@dataclass(frozen=True)
class Case:
    """A study with what is needed to spoil it."""

    problem: UpdatingProblem
    rng: np.random.Generator

    @property
    def data(self) -> ModalData:
        """The measured modes."""
        return self.problem.data

    def with_data(
        self,
        *,
        frequency: Floats | None = None,
        damping: Floats | None = None,
        shape: Floats | None = None,
    ) -> UpdatingProblem:
        """Return the problem with other data."""
        data = self.data
        changed = replace(
            data,
            frequency=data.frequency if frequency is None else frequency,
            damping=data.damping if damping is None else damping,
            shape=data.shape if shape is None else shape,
        )
        return replace(self.problem, data=changed)

    def with_model(self, model: MatrixModel) -> UpdatingProblem:
        """Return the problem with another model."""
        return replace(self.problem, model=model)


def random_chain(rng: np.random.Generator) -> MatrixModel:
    """Return a chain of 3 to 10 masses, each spring with a parameter, or two of them with one."""
    n = int(rng.integers(3, 11))
    names = [f"k{i // (1 + n // 6) + 1}" for i in range(n)]
    masses = rng.uniform(0.7, 1.4, n) * 1000
    springs = rng.uniform(0.7, 1.4, n) * 4e6
    count = int(rng.integers(3, n + 1))
    chosen = sorted(rng.choice(n, count, replace=False).tolist())
    sensors = {f"s{i + 1}": i for i in chosen}
    parameters = list(dict.fromkeys(names))
    return chain(parameters, masses, springs, stiffness_parameters=names, sensors=sensors)


def random_frame(rng: np.random.Generator) -> MatrixModel:
    """Return a plane frame of 2 to 4 storeys with sensors along x on all floors."""
    storeys, bays = int(rng.integers(2, 5)), int(rng.integers(1, 3))
    height, width = rng.uniform(2.5, 4.0), rng.uniform(3.0, 6.0)
    nodes = [(width * b, 0.0, height * s) for s in range(storeys + 1) for b in range(bays + 1)]
    position = {(s, b): s * (bays + 1) + b for s in range(storeys + 1) for b in range(bays + 1)}
    column, beam = fem.rectangle(0.08, 0.1), fem.rectangle(0.07, 0.14)
    groups = []
    for s in range(storeys):
        cells = [(position[s, b], position[s + 1, b]) for b in range(bays + 1)]
        groups.append(fem.Beams(f"columns{s + 1}", cells, STEEL, column, (1.0, 0.0, 0.0)))
        cells = [(position[s + 1, b], position[s + 1, b + 1]) for b in range(bays)]
        groups.append(fem.Beams(f"beams{s + 1}", cells, STEEL, beam, (0.0, 1.0, 0.0)))
    floors = [position[s, b] for s in range(1, storeys + 1) for b in range(bays + 1)]
    sensors = [
        fem.Sensor(f"x{node}", node, str(rng.choice(["x", "-x"])))
        for node in floors
        if node % (bays + 1) == 0 or rng.uniform() < 0.4
    ]
    parameters = [fem.Parameter(f"c{s + 1}", "E", (f"columns{s + 1}",)) for s in range(storeys)]
    structure = fem.Structure(
        np.array(nodes),
        groups,
        [fem.Support(list(range(bays + 1))), fem.Support(floors, ("y", "rx", "rz"))],
        masses=[fem.Mass("slabs", floors, rng.uniform(200.0, 800.0))],
        sensors=sensors,
        parameters=parameters,
    )
    return mesh_model(structure, [parameter.name for parameter in parameters])


def random_plate(rng: np.random.Generator) -> MatrixModel:
    """Return a cantilever plate of shells with 6 to 20 sensors across it."""
    length, width = rng.uniform(0.8, 1.2), rng.uniform(0.35, 0.55)
    X, cells = fem.grids.plate(length, width, 6, 3)
    half = X[cells].mean(axis=1)[:, 0] < length / 2
    free = np.flatnonzero(X[:, 0] > 0.2 * length)
    count = int(rng.integers(6, min(20, free.size)))
    nodes = sorted(rng.choice(free, count, replace=False).tolist())
    structure = fem.Structure(
        X,
        [
            fem.Shells("root", cells[half], STEEL, 0.01),
            fem.Shells("tip", cells[~half], STEEL, 0.01),
        ],
        [fem.Support(np.flatnonzero(X[:, 0] < 1e-9))],
        sensors=[fem.Sensor(f"n{node}", node, "z") for node in nodes],
        parameters=[fem.Parameter("root", "E", ("root",)), fem.Parameter("tip", "E", ("tip",))],
    )
    return mesh_model(structure, ["root", "tip"])


def simulated(model: MatrixModel, rng: np.random.Generator) -> ModalData:
    """Return the modal data of a structure like the model, in one to three data sets."""
    p = len(model.parameters)
    theta = np.clip(np.exp(0.25 * rng.standard_normal(p)), 0.4, 2.5)
    requested = int(rng.integers(2, 7))
    count = min(requested, model.size)
    modes = model.full_modes(theta, count)
    # What no parameter describes: each mode takes in a little of the others.
    mixing = np.eye(count) + 0.04 * rng.standard_normal((count, count))
    phi = (model.selection @ modes.Phi) @ mixing
    f = np.sqrt(modes.lam) / (2 * np.pi) * np.exp(0.02 * rng.standard_normal(count))
    seen = np.abs(phi).max(axis=0) > 0.1 * np.abs(phi).max()
    order = np.argsort(f[seen])
    f, phi = f[seen][order], phi[:, seen][:, order]
    if f.size > 3 and rng.uniform() < 0.3:
        kept = np.delete(np.arange(f.size), int(rng.integers(1, f.size - 1)))
        f, phi = f[kept], phi[:, kept]
    sets = int(rng.integers(1, 4))
    m, n = f.size, phi.shape[0]
    frequency = f * np.exp(0.005 * rng.standard_normal((sets, m)))
    size = np.sqrt((phi**2).mean(axis=0))[None, :, None]
    shape = phi.T[None] + 0.03 * size * rng.standard_normal((sets, m, n))
    shape *= rng.choice([-1.0, 1.0], (sets, m, 1)) * np.exp(rng.standard_normal((sets, m, 1)))
    if n > 4:
        shape[rng.uniform(size=shape.shape) < 0.03] = np.nan
    damping = np.exp(rng.normal(np.log(0.01), 0.5, (sets, m)))
    nothing = np.full(frequency.shape, np.nan)
    return ModalData(
        tuple(f"set{k + 1}" for k in range(sets)),
        tuple(range(1, m + 1)),
        model.sensors,
        *(frequency, damping, shape, nothing, np.full(shape.shape, np.nan)),
    )


FAMILIES = (random_chain, random_frame, random_plate)


def random_case(seed: int) -> Case:
    """Return a correct study."""
    rng = np.random.default_rng(seed)
    while True:
        model = FAMILIES[seed % len(FAMILIES)](rng)
        data = simulated(model, rng)
        if len(data.modes) > 1:
            break
    p = len(model.parameters)
    groups = (Group("frequencies", frequency="all"), Group("shapes", shape="all"))
    unit = np.ones(p)
    return Case(UpdatingProblem(model, data, groups, 0.2 * unit, 5.0 * unit, unit), rng)


def in_rad(case: Case) -> UpdatingProblem:
    """Return the study with frequencies in rad/s."""
    return case.with_data(frequency=2 * np.pi * case.data.frequency)


def in_kilo(case: Case) -> UpdatingProblem:
    """Return the study with frequencies off by a unit, 10^3 to 10^6, either way."""
    factor = 10.0 ** (case.rng.choice([-1, 1]) * case.rng.choice([3.0, 4.5, 6.0]))
    return case.with_data(frequency=factor * case.data.frequency)


def _sensor(case: Case) -> int:
    """Return a sensor that matters to the shapes, the others of it being noise."""
    fit = np.flatnonzero(_share(case) > 0.5)
    return int(case.rng.choice(fit))


def _share(case: Case) -> Floats:
    """Return the mean square of each sensor in the shapes, over that of all sensors."""
    psi = np.nan_to_num(case.data.shape)
    psi /= np.linalg.norm(psi, axis=2, keepdims=True)
    return np.asarray(psi.shape[2] * (psi**2).mean(axis=(0, 1)))


def reversed_in_all(case: Case) -> UpdatingProblem:
    """Return the study with the sign of one sensor reversed in all data sets."""
    shape = case.data.shape.copy()
    shape[:, :, _sensor(case)] *= -1
    return case.with_data(shape=shape)


def small_reversed(case: Case) -> UpdatingProblem | None:
    """Return the study with a sensor reversed that moves little, but five times the noise."""
    share = _share(case)
    little = np.flatnonzero((share < 0.5) & (share > 0.0225))
    if share.size < 6 or len(case.data.modes) < 3 or not little.size:
        return None
    shape = case.data.shape.copy()
    shape[:, :, int(case.rng.choice(little))] *= -1
    return case.with_data(shape=shape)


def reversed_in_one(case: Case) -> UpdatingProblem:
    """Return the study with the sign of one sensor reversed in one data set."""
    shape = case.data.shape.copy()
    shape[int(case.rng.integers(shape.shape[0])), :, _sensor(case)] *= -1
    return case.with_data(shape=shape)


def exchanged(case: Case) -> UpdatingProblem:
    """Return the study with two sensors exchanged that do not move alike."""
    psi = np.nan_to_num(case.data.shape)
    psi /= np.linalg.norm(psi, axis=2, keepdims=True)
    n = psi.shape[2]
    pairs = [(s, t) for s in range(n) for t in range(s + 1, n)]
    change = [float(((psi[:, :, s] - psi[:, :, t]) ** 2).mean()) for s, t in pairs]
    good = [pair for pair, value in zip(pairs, change, strict=True) if value > 0.5 / n]
    s, t = good[int(case.rng.integers(len(good)))] if good else pairs[int(np.argmax(change))]
    shape = case.data.shape.copy()
    shape[:, :, [s, t]] = shape[:, :, [t, s]]
    return case.with_data(shape=shape)


def direction_of_one(case: Case) -> UpdatingProblem | None:
    """Return the study with one sensor of the model along another axis."""
    return _redirected(case, [_sensor(case)])


def direction_of_all(case: Case) -> UpdatingProblem | None:
    """Return the study with all sensors of the model along another axis."""
    return _redirected(case, list(range(len(case.data.sensors))))


def _redirected(case: Case, sensors: list[int]) -> UpdatingProblem | None:
    model = case.problem.model
    if not isinstance(model, MatrixModel) or model.geometry is None:
        return None
    geometry = model.geometry
    axis = int(np.argmax(np.abs(geometry.sensor_directions[0])))
    directions = geometry.sensor_directions.copy()
    for other in case.rng.permutation([a for a in geometry.axes if a != axis]).tolist():
        directions[sensors] = np.eye(3)[other] * directions[sensors].sum(axis=1, keepdims=True)
        selection = geometry.weights(geometry.sensor_nodes, directions)
        if abs(selection).sum(axis=1).all():
            moved = replace(geometry, sensor_directions=directions)
            return case.with_model(replace(model, selection=selection, geometry=moved))
    return None


def node_of_one(case: Case) -> UpdatingProblem | None:
    """Return the study with one sensor of the model at another place that moves otherwise."""
    return _moved(case, shared=False)


def node_of_another(case: Case) -> UpdatingProblem | None:
    """Return the study with one sensor of the model at the place of another one."""
    return _moved(case, shared=True)


def _moved(case: Case, *, shared: bool) -> UpdatingProblem | None:
    model, s = case.problem.model, _sensor(case)
    if not isinstance(model, MatrixModel):
        return None
    geometry = model.geometry
    if geometry is None:
        return None
    taken = np.delete(geometry.sensor_nodes, s)
    free = np.setdiff1d(np.arange(len(geometry.nodes)), geometry.sensor_nodes)
    for node in case.rng.permutation(taken if shared else free).tolist():
        nodes = geometry.sensor_nodes.copy()
        nodes[s] = node
        selection = geometry.weights(nodes, geometry.sensor_directions)
        if abs(selection).sum(axis=1).all() and not _moves_alike(model, selection):
            moved = replace(geometry, sensor_nodes=nodes)
            return case.with_model(replace(model, selection=selection, geometry=moved))
    return None


def counted_from_one(case: Case) -> UpdatingProblem | None:
    """Return the study with degrees of freedom or nodes of the sensors counted from 1."""
    model = case.problem.model
    if not isinstance(model, MatrixModel):
        return None
    geometry = model.geometry
    if geometry is not None and len(geometry.axes) > 1:
        nodes = geometry.sensor_nodes + 1
        if nodes.max() >= len(geometry.nodes):
            return None
        selection = geometry.weights(nodes, geometry.sensor_directions)
        if not abs(selection).sum(axis=1).all() or _moves_alike(model, selection):
            return None
        moved = replace(geometry, sensor_nodes=nodes)
        return case.with_model(replace(model, selection=selection, geometry=moved))
    entries = model.selection.tocoo()
    if entries.col.max() + 1 >= model.size:
        return None
    shape = (entries.data, (entries.row, entries.col + 1))
    shifted = scipy.sparse.csr_array(shape, shape=entries.shape)
    if _moves_alike(model, shifted):
        return None
    return case.with_model(replace(model, selection=shifted))


def _moves_alike(model: MatrixModel, selection: scipy.sparse.csr_array) -> bool:
    """Return whether other places move as the sensors do: no mistake, as far as data can tell."""
    unit = np.ones(len(model.parameters))
    Phi = model.full_modes(unit, min(4, model.size)).Phi
    values = np.diag(mac(model.selection @ Phi, selection @ Phi))
    return bool(np.mean(1 - values) < 0.05)


def percent(case: Case) -> UpdatingProblem:
    """Return the study with damping in percent, as far as a file with it can be read."""
    return case.with_data(damping=np.minimum(100 * case.data.damping, 0.999))


def one_frequency(case: Case) -> UpdatingProblem | None:
    """Return the study with one frequency of one data set off by 8 to 20 %."""
    f = case.data.frequency.copy()
    if f.shape[0] < 2:
        return None
    k, r = int(case.rng.integers(f.shape[0])), int(case.rng.integers(f.shape[1]))
    f[k, r] *= 1 + case.rng.choice([-1, 1]) * case.rng.uniform(0.08, 0.2)
    return case.with_data(frequency=f)


def one_shape(case: Case) -> UpdatingProblem | None:
    """Return the study with two modes of one data set exchanged."""
    shape, f = case.data.shape.copy(), case.data.frequency.copy()
    if f.shape[0] < 2:
        return None
    k, m = int(case.rng.integers(f.shape[0])), f.shape[1]
    r = int(case.rng.integers(m - 1))
    shape[k, [r, r + 1]] = shape[k, [r + 1, r]]
    f[k, [r, r + 1]] = f[k, [r + 1, r]]
    return case.with_data(shape=shape, frequency=f)


def rad_in_one(case: Case) -> UpdatingProblem | None:
    """Return the study with the frequencies of one data set in rad/s."""
    f = case.data.frequency.copy()
    if f.shape[0] < 2:
        return None
    f[int(case.rng.integers(f.shape[0]))] *= 2 * np.pi
    return case.with_data(frequency=f)


def outside(case: Case) -> UpdatingProblem | None:
    """Return the study of a chain with a mode above all that it has."""
    model, f = case.problem.model, case.data.frequency.copy()
    if model.size > 12 or not isinstance(model, MatrixModel):
        return None
    lam = model.full_modes(case.problem.start, model.size).lam
    f[:, -1] *= case.rng.uniform(1.7, 5.0) * np.sqrt(lam[-1]) / (2 * np.pi) / f[:, -1].mean()
    return case.with_data(frequency=f)


Spoil = Callable[[Case], UpdatingProblem | None]

MISTAKES: dict[str, tuple[Spoil, tuple[str, ...]]] = {
    "rad/s for Hz": (in_rad, ("FrequencyFactor",)),
    "unit factor": (in_kilo, ("FrequencyFactor",)),
    "rad/s in one set": (rad_in_one, ("SetFactor",)),
    "sensor reversed in all sets": (reversed_in_all, ("WrongSensors",)),
    "sensor of small motion reversed": (small_reversed, ("WrongSensors", "OpposedSensor")),
    "sensor reversed in one set": (reversed_in_one, ("WrongSensors",)),
    "sensors exchanged": (exchanged, ("WrongSensors",)),
    "direction of one sensor": (direction_of_one, ("WrongPlaces",)),
    "direction of all sensors": (direction_of_all, ("WrongPlaces",)),
    "place of one sensor": (node_of_one, ("WrongPlaces",)),
    "two sensors at one place": (node_of_another, ("WrongPlaces",)),
    "counted from 1": (counted_from_one, ("WrongPlaces",)),
    "damping in percent": (percent, ("DampingInPercent",)),
    "frequency of one set": (one_frequency, ("SetFrequency",)),
    "modes exchanged in one set": (one_shape, ("SetNumbers",)),
    "mode outside the model": (outside, ("OutsideModel",)),
}


def rates(name: str, studies: int, *, verbose: bool) -> str:
    """Return the rates at which a mistake is found, in words."""
    spoil, kinds = MISTAKES[name]
    hits = alone = tried = 0
    seed = 10_000
    while tried < studies:
        seed += 1
        spoilt = spoil(random_case(seed))
        if spoilt is None:
            continue
        tried += 1
        result = diagnose(compare(spoilt))
        names = {type(finding).__name__ for finding in result}
        is_hit = bool(names & set(kinds))
        hits += is_hit
        alone += is_hit and names <= {*kinds, "DistantPair"}
        if verbose and not (is_hit and names <= {*kinds, "DistantPair"}):
            print(f"  {seed}: {[in_words(finding) for finding in result]}")
    return f"{name}: found in {hits} of {studies}, alone in {alone}"


def main() -> None:
    """Print the rates."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--studies", type=int, default=100)
    parser.add_argument("--mistake", default="")
    parser.add_argument("--verbose", action="store_true")
    options = parser.parse_args()
    started = time.process_time()
    clean = paired = 0
    for seed in range(options.studies if not options.mistake else 0):
        result = diagnose(compare(random_case(seed).problem))
        names = {type(finding).__name__ for finding in result}
        clean += not result
        paired += names <= {"DistantPair", "BeyondCandidates"}
        if result and options.verbose:
            print(f"  {seed}: {[in_words(finding) for finding in result]}")
    if not options.mistake:
        print(
            f"correct studies without a finding: {clean} of {options.studies}; without any but "
            f"pairs: {paired}"
        )
    for name in MISTAKES:
        if options.mistake in name:
            print(rates(name, options.studies, verbose=options.verbose))
    print(f"{time.process_time() - started:.0f} s of user time")


if __name__ == "__main__":
    main()
