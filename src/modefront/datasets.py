"""Arrays with named dimensions.

A run makes an `ArrayDataset`: importing `xarray`, which has more, takes as long as a small study.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True, eq=False)
class Array:
    """An array with names of its dimensions, and attributes that describe it."""

    dims: tuple[Any, ...]
    values: np.ndarray[Any, Any]
    attrs: Mapping[Any, Any] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class ArrayDataset:
    """Arrays by name that share dimensions; one named as its only dimension is a coordinate.

    Methods do what those of `xarray` do. Raises ValueError for arrays that do not fit together.
    """

    variables: Mapping[Any, Array]
    attrs: Mapping[Any, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for name, variable in self.variables.items():
            shape = tuple(self.sizes[each] for each in variable.dims)
            if variable.values.shape != shape:
                raise ValueError(f"'{name}' has the shape {variable.values.shape}, not {shape}")

    @cached_property
    def sizes(self) -> dict[Any, int]:
        """Size of each dimension by its name."""
        every = self.variables.values()
        return {k: n for x in every for k, n in zip(x.dims, x.values.shape, strict=False)}

    def __getitem__(self, name: Any) -> Array:
        return self.variables[name]

    def __contains__(self, name: object) -> bool:
        return name in self.variables

    def isel(self, **chosen: Any) -> "ArrayDataset":
        """Return what belongs to chosen places."""

        def of(variable: Array) -> Array:
            values, dims = variable.values, variable.dims
            for name, places in chosen.items():
                if name in dims:
                    values = values[(slice(None),) * dims.index(name) + (np.asarray(places),)]
                    dims = tuple(x for x in dims if x != name or np.ndim(places))
            return Array(dims, values, variable.attrs)

        return replace(self, variables={name: of(x) for name, x in self.variables.items()})

    def assign(self, variables: Mapping[Any, Array]) -> "ArrayDataset":
        """Return these with further variables, or others in their place."""
        return replace(self, variables={**self.variables, **variables})

    def assign_coords(self, names: Mapping[str, Any]) -> "ArrayDataset":
        """Return these with names of the places of some dimensions."""
        return self.assign({key: Array((key,), np.asarray(x)) for key, x in names.items()})

    def assign_attrs(self, attributes: Mapping[str, Any]) -> "ArrayDataset":
        """Return these with further attributes of all, or others in their place."""
        return replace(self, attrs={**self.attrs, **attributes})


Dataset: TypeAlias = "ArrayDataset | xr.Dataset"
"""What results are read by: of a run, or of `xarray`."""
