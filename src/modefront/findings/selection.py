"""Selections of points of results."""

from __future__ import annotations

import numpy as np
import xarray as xr

from modefront._typing import Ints
from modefront.front.point import Kind, preferred


def front_points(data: xr.Dataset) -> Ints:
    """Return the positions of the points of the front, in their order along it."""
    return np.flatnonzero(data["kind"].values == Kind.FRONT.value)


def position(data: xr.Dataset, point: str | int) -> int:
    """Return the position of a point from its label or position; raises KeyError without one."""
    if not isinstance(point, str):
        return point
    labels = [str(x) for x in data["label"].values]
    if point not in labels:
        raise KeyError(f"expected one of {', '.join(labels)}, found {point!r}")
    return labels.index(point)


def reference(data: xr.Dataset) -> int:
    """Return the position of the model that the data prefer."""
    return position(data, preferred(data.attrs))


def verdict(data: xr.Dataset) -> list[str]:
    """Return the sentences of the first answer."""
    return str(data.attrs.get("verdict", "")).splitlines()


def not_converged(data: xr.Dataset) -> list[str]:
    """Return the labels of points that should have converged and did not."""
    solved = ~np.isin(data["status"].values, ["sampled", "jump"])
    return data["label"].values[~data["converged"].values & solved].tolist()


def uncertified(data: xr.Dataset) -> np.ndarray:
    """Return the labels of models whose eigenvalues do not meet the tolerance."""
    if "certified" not in data:
        return np.zeros(0, dtype=str)
    return np.asarray(data["label"].values[~data["certified"].values])
