"""The arrays of a run by name, without xarray: what figures are drawn from.

Importing xarray takes longer than most contacts do (and brings pandas, and dask and pint where they are installed), so
it waits until somebody opens results. A `Variable` has the names of xarray that figures need.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bem.errors import ResultsError
from bem.results.atomic import reason
from bem.scenes.context import Variable


class Arrays(Mapping[str, Variable]):
    """Arrays by name; `sizes` has the length of every axis, `coords` those named like their only axis."""

    def __init__(self, variables: Mapping[str, Variable], attrs: Mapping[str, Any]) -> None:
        self.variables = dict(variables)
        self.attrs = dict(attrs)
        self.sizes = {
            name: size for item in self.variables.values() for name, size in zip(item.dims, item.shape, strict=True)
        }
        self.coords = {name: item for name, item in self.variables.items() if item.dims == (name,)}

    def __getitem__(self, name: str) -> Variable:
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


def read_arrays(path: Path) -> Arrays:
    """The arrays in the file, each read when first asked for; ResultsError if it is missing or damaged."""
    import h5netcdf

    def entry(name: str, item: Any) -> Variable:
        units, description = (str(item.attrs.get(key, "")) for key in ("units", "long_name"))
        return Variable(
            item.dimensions,
            lambda: _values(path, name),
            units,
            description,
            shape=tuple(item.shape),
            read_at=lambda place: _values(path, name, place),
        )

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


def _values(path: Path, name: str, place: tuple[int, ...] = ()) -> NDArray[Any]:
    """The values of a stored array, of the `place` along its first axes."""
    import h5py

    here = (*place, ...)

    try:
        with h5py.File(path, "r") as file:
            stored = file.get(f"_nc4_non_coord_{name}", file[name])  # one named like a dimension that is not its own
            if h5py.check_string_dtype(stored.dtype) is not None:
                return np.asarray(stored.asstr()[here]).astype(str)
            return np.asarray(stored[here])
    except (OSError, RuntimeError, ValueError, KeyError, TypeError) as error:
        raise ResultsError(f"{path}: {name} cannot be read ({str(error).splitlines()[0]})") from error
