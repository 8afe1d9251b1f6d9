"""Results that are damaged: every variable and attribute, in every way."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial

import numpy as np
import xarray as xr


def damages(data: xr.Dataset) -> Iterator[tuple[str, Callable[[], xr.Dataset]]]:
    """Yield what is done to results, and what returns them so."""
    for name in map(str, data.variables):
        yield f"{name} is dropped", partial(data.drop_vars, [name])
        values = data[name]
        for what, changed in _changed(values.values):
            if name in data.dims:
                if changed.shape == values.shape:
                    yield f"{name} {what}", partial(data.assign_coords, {name: changed})
            elif changed.ndim == values.ndim:
                dims = [d if n == m else f"{name}_{d}" for d, n, m in _sizes(values, changed)]
                yield f"{name} {what}", partial(data.assign, {name: (dims, changed)})
            else:
                dims = [f"other_{k}" for k in range(changed.ndim)]
                rest = data.drop_vars([name])
                yield f"{name} {what}", partial(rest.assign, {name: (dims, changed)})
    for name in map(str, data.dims):
        yield f"dimension {name} is empty", partial(data.isel, {name: slice(0)})
        yield f"dimension {name} has one", partial(data.isel, {name: slice(1)})
        yield f"dimension {name} lacks one", partial(data.isel, {name: slice(1, None)})
        twice = [*range(data.sizes[name]), *range(data.sizes[name])]
        yield f"dimension {name} has all twice", partial(data.isel, {name: twice})
    for key, value in data.attrs.items():
        others = {name: other for name, other in data.attrs.items() if name != key}
        yield f"attribute {key} is dropped", partial(_with, data, others)
        for other in ("", "text", "\x1b[31m", -1, 0.5, np.nan, 1e300, np.arange(3), 2**62):
            changes = {**others, key: other}
            yield f"attribute {key} is {other!r}, not {value!r}", partial(_with, data, changes)


def _with(data: xr.Dataset, attributes: dict[str, object]) -> xr.Dataset:
    out = data.copy()
    out.attrs = attributes
    return out


def _sizes(values: xr.DataArray, changed: np.ndarray) -> Iterator[tuple[str, int, int]]:
    return zip(map(str, values.dims), values.shape, changed.shape, strict=True)


def _changed(values: np.ndarray) -> Iterator[tuple[str, np.ndarray]]:
    """Yield values that were changed, and how."""
    shape = values.shape
    yield "is a number", np.full(shape, 1.5)
    yield "is zero", np.zeros(shape, int)
    yield "is not a number", np.full(shape, np.nan)
    yield "is infinite", np.full(shape, -np.inf)
    yield "is huge", np.full(shape, 1e300)
    yield "is negative", np.full(shape, -7)
    yield "is a text", np.full(shape, "text")
    yield "is an order to the terminal", np.full(shape, "\x1b]0;x\x07" + "y" * 5000)
    yield "is an empty text", np.full(shape, "")
    yield "is true", np.full(shape, True)
    yield "is a scalar", np.array(1.0) if shape else np.ones(2)
    if len(shape) > 1 and shape[0]:
        yield "is turned", np.moveaxis(values, 0, -1)
        yield "lacks a dimension", values[0]
    if shape and shape[0]:
        yield "is shorter", values[:-1]
        yield "is longer", np.concatenate([values, values])
