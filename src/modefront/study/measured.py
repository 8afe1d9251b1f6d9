"""``[data]``: the measured modes."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from operator import attrgetter
from pathlib import Path
from typing import Any

import numpy as np

from modefront._typing import Floats
from modefront.data.csv import COLUMNS, read_covariance, read_csv
from modefront.data.modal import ModalData
from modefront.data.uff import NodalModes, is_universal, read_uff55
from modefront.errors import refusing, suggestion
from modefront.families import Family
from modefront.fem.check import unit_vector
from modefront.fem.structure import DIRECTION
from modefront.findings.record import found
from modefront.inputs import file_size, wrong
from modefront.models.base import Model
from modefront.models.geometry import Geometry, axis_name
from modefront.models.matrices import MatrixModel
from modefront.options import NAME, Table, any_of, entries, keys, of_options, table_of, text, whole
from modefront.text import Shown

FILE = text("the name of a file of modal data")
COVARIANCE = text("the name of a file of covariances of shapes, in CSV")
OF_PLACE = keys(["node", "direction"], node=whole(0, 10**9), direction=DIRECTION)
PLACE = any_of(NAME, of_options(OF_PLACE))
SENSORS = entries("a table, sensor = node and direction in the file", table_of(PLACE))
DATA = keys(["file"], file=FILE, covariance=COVARIANCE, sensors=SENSORS, columns=COLUMNS)


@dataclass(frozen=True, repr=False)
class DataReader(Shown):
    """A reader of files of modal data, besides those in CSV and UFF.

    Attributes
    ----------
    ending : of the names of its files, with a point
    read : returns the data of a file, given its path and the names of the model's sensors in their
        order, or None where these are not known; raises InputError for what is wrong with it
    """

    ending: str
    read: Callable[[Path, Sequence[str] | None], ModalData]


READERS: Family[DataReader] = Family(
    "modefront.readers", "a DataReader", DataReader, name=attrgetter("ending")
)
"""Readers of the user by their endings."""


def read_data(root: Table, model: Model | None) -> ModalData | None:
    """Return the measured modes, None where they have faults."""
    table = root.table("data", "a table [data]")
    if table is None:
        return None
    name, covariance = table.value("file", FILE), table.value("covariance", COVARIANCE, None)
    file = None if name is None else table.path(name)
    places, columns, universal = None, dict[str, str](), file is not None and is_universal(file)
    if universal:
        places = table.table("sensors", "a table, sensor = node and direction", None)
    else:
        columns = table.value("columns", COLUMNS, None) or {}
    table.close()
    if file is None:
        return None
    sensors, data = model.sensors if model else None, None
    with root.noting():
        if universal:
            modes = read_uff55(file)
            data = _of_nodes(table, places, modes, model) if model else None
        elif file.suffix.lower() == ".csv":
            # Without a model all columns may be sensors: what else is wrong is found nevertheless.
            data = read_csv(file, sensors, columns)
        elif file.suffix in READERS:
            file_size(file, "a file of modal data")
            with refusing(file, "a file of modal data"):  # a user's function may raise anything
                data = READERS[file.suffix].read(file, sensors)
            if sensors is not None and tuple(data.sensors) != sensors:
                expected = f"the sensors {', '.join(sensors)}, in this order"
                raise wrong(file, expected, ", ".join(data.sensors))
        else:
            endings = ", ".join([*READERS, ".csv", ".uff"])
            table.fault("file", f"a file that ends in {endings} or .unv", f"'{name}'")
        if covariance is not None:
            errors = table.path(covariance)
            data = read_covariance(errors, data, columns) if data else None
    if data and model and len(data.modes) > model.size:
        found = f"{len(data.modes)} in '{name}'"
        root.fault("[data] file", f"at most {model.size} modes, as the model has", found)
    return data


def _of_nodes(
    table: Table, places: Table | None, modes: NodalModes, model: Model
) -> ModalData | None:
    """Return the modes at the sensors of the model, None where a sensor is not found.

    A sensor is where ``[data.sensors]`` says, else where its name says, such as ``12Z``, else at
    the node of the test that has its coordinates.
    """
    given: Mapping[str, Any] = places.values if places else {}
    geometry = model.geometry if isinstance(model, MatrixModel) else None
    in_space = geometry if geometry is not None and len(geometry.axes) > 1 else None
    placed: dict[str, tuple[int, Floats]] = {}
    before, names = len(table.faults), modes.measured
    known = ", ".join(names[:8]) + f" and {len(names) - 8} more" * (len(names) > 8)
    for name in given:
        if places and name not in model.sensors:
            places.fault(name, "a sensor of the model", suggestion(name, model.sensors))
    for s, name in enumerate(model.sensors):
        if places and isinstance(value := given.get(name), str):
            if (place := modes.place(value)) is None:
                places.fault(name, f"one of {known}", suggestion(value, names))
        elif places and name in given:
            inner, place = places.table(name, 'node and direction, such as "12Z"'), None
            if inner and (chosen := inner.read(OF_PLACE)):
                if at := np.flatnonzero(modes.nodes == chosen["node"]).tolist():
                    place = at[0], unit_vector(chosen["direction"])
                else:
                    inner.fault("node", "a node of the test", str(chosen["node"]))
        elif (place := modes.place(name) or _by_coordinates(modes, in_space, s)) is None:
            expected = f"{name} = node and direction, one of {known}: the file does not say which "
            expected += "sensor is which, nor do coordinates in the unit of the model"
            table.fault("sensors", expected, "nothing")
        if place is None:
            continue
        placed[name] = place
        axis = None if in_space is None else in_space.sensor_directions[s]
        in_data = modes.in_space(*place)
        if axis is not None and axis.any() and abs(axis @ in_data[:3]) < 0.5:
            model_axis, data_axis = axis_name(axis), axis_name(in_data)
            table.notes.append(found("data-direction", name, model=model_axis, data=data_axis))
    for name, (node, direction) in placed.items() if len(table.faults) == before else ():
        if np.isnan(modes.along(node, direction)).all():
            what = f"{modes.nodes[node]} along {axis_name(direction)}, which is 0 in all modes"
            table.fault(f"sensors {name}", f"one of {known}", what)
    return modes.at(placed) if len(table.faults) == before else None


def _by_coordinates(
    modes: NodalModes, geometry: Geometry | None, s: int
) -> tuple[int, Floats] | None:
    """Return the node of the test at the coordinates of a sensor, and its direction there."""
    if geometry is None or np.isnan(modes.position).any():
        return None
    direction = np.concatenate([geometry.sensor_directions[s], np.zeros(3)])
    distance = np.linalg.norm(modes.position - geometry.nodes[geometry.sensor_nodes[s]], axis=1)
    nearest = int(np.argmin(distance))
    # Of the lesser one, as one may be in m and the other in mm.
    size = min(np.linalg.norm(np.ptp(x, axis=0)) for x in (modes.position, geometry.nodes))
    is_known = direction.any() and np.isfinite(modes.axes[nearest]).all()
    if not is_known or distance[nearest] > 0.01 * size:  # another node would be as likely
        return None
    return nearest, modes.local(nearest, direction)
