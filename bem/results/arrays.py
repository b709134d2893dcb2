"""The arrays of a run by name, without xarray: what figures are drawn from.

Importing xarray takes longer than most contacts do (and brings pandas, and dask and pint where they are installed), so
it waits until somebody opens results. What is here looks the same for as much as figures need.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bem.errors import ResultsError
from bem.results.atomic import reason
from bem.scenes.context import Variable


class Array:
    """An array with names of its axes and attributes; the values are read when first asked for."""

    def __init__(
        self,
        dims: tuple[str, ...],
        shape: tuple[int, ...],
        attrs: Mapping[str, Any],
        read: Callable[[], NDArray[Any]],
    ) -> None:
        self.dims = dims
        self.shape = shape
        self.attrs = dict(attrs)
        self._read = read

    @cached_property
    def values(self) -> NDArray[Any]:
        """The numbers."""
        return self._read()

    @property
    def size(self) -> int:
        """How many numbers."""
        return int(np.prod(self.shape))

    @property
    def ndim(self) -> int:
        """How many axes."""
        return len(self.shape)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        return np.array(self.values, dtype=dtype, copy=copy)

    def __float__(self) -> float:
        return float(self.values)


class Arrays(Mapping[str, Array]):
    """Arrays by name; `sizes` has the length of every axis, `coords` those named like their only axis."""

    def __init__(self, variables: Mapping[str, Array], attrs: Mapping[str, Any]) -> None:
        self.variables = dict(variables)
        self.attrs = dict(attrs)
        self.sizes = {
            name: size for item in self.variables.values() for name, size in zip(item.dims, item.shape, strict=True)
        }
        self.coords = {name: item for name, item in self.variables.items() if item.dims == (name,)}

    def __getitem__(self, name: str) -> Array:
        return self.variables[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.variables)

    def __len__(self) -> int:
        return len(self.variables)


LEFT_OUT = "left_out"
"""Attribute of a file of results: names of the arrays that the run had and the file has not."""


def stacks_of_maps(variables: Mapping[str, Variable]) -> list[str]:
    """Names of maps at each of several depths, times or cases: most of what a run writes, where it has any."""
    maps = (("x", "y"), ("film_x", "film_y"))
    return [name for name, item in variables.items() if len(item.dimensions) > 2 and item.dimensions[-2:] in maps]


def to_arrays(variables: Mapping[str, Variable], attributes: Mapping[str, Any]) -> Arrays:
    """Variables of an outcome as they would be read back."""

    def entry(item: Variable) -> Array:
        attrs = {"units": item.units, "long_name": item.description}
        return Array(item.dimensions, item.values.shape, attrs, lambda: item.values)

    return Arrays({name: entry(item) for name, item in variables.items()}, attributes)


Described = dict[str, tuple[tuple[str, ...], tuple[int, ...], dict[str, Any]]]
"""Axes, shape and attributes of arrays by name, without their values."""


def described(arrays: Arrays) -> Described:
    """What arrays are, to be sent to another process."""
    return {name: (item.dims, item.shape, item.attrs) for name, item in arrays.items()}


def stored_arrays(path: Path, known: Described, attributes: Mapping[str, Any]) -> Arrays:
    """The arrays of a file of which it is known what they are, each read when first asked for; what reads netCDF as
    such takes longer to load than many arrays do."""

    def entry(name: str) -> Array:
        return Array(*known[name], lambda: _values(path, name))

    return Arrays({name: entry(name) for name in known}, attributes)


def read_arrays(path: Path) -> Arrays:
    """The arrays in the file, each read when first asked for; ResultsError if it is missing or damaged."""
    import h5netcdf

    def entry(name: str, item: Any) -> Array:
        return Array(tuple(item.dimensions), tuple(item.shape), dict(item.attrs), lambda: _values(path, name))

    try:
        with h5netcdf.File(path, "r") as file:
            return Arrays({name: entry(name, item) for name, item in file.variables.items()}, dict(file.attrs))
    except OSError as error:
        raise ResultsError(f"{path}: cannot be read ({reason(error)})") from error
    except (RuntimeError, ValueError, KeyError, TypeError) as error:
        raise ResultsError(f"{path}: is damaged ({str(error).splitlines()[0]})") from error


def left_out(path: Path) -> list[str]:
    """Names of the arrays that a finished run had and did not write into the file, of which nothing else is read;
    ResultsError if it is missing or was cut off."""
    import h5py

    try:
        with h5py.File(path, "r") as file:
            return str(file.attrs.get(LEFT_OUT, "")).split()
    except (OSError, RuntimeError) as error:
        raise ResultsError(f"{path}: cannot be read ({str(error).splitlines()[0]})") from error


def _values(path: Path, name: str) -> NDArray[Any]:
    import h5py

    try:
        with h5py.File(path, "r") as file:
            stored = file.get(f"_nc4_non_coord_{name}", file[name])  # one named like a dimension that is not its own
            if h5py.check_string_dtype(stored.dtype) is not None:
                return np.asarray(stored.asstr()[...]).astype(str)
            return np.asarray(stored[...])
    except (OSError, RuntimeError, ValueError, KeyError, TypeError) as error:
        raise ResultsError(f"{path}: {name} cannot be read ({str(error).splitlines()[0]})") from error
