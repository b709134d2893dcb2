"""Arrays of a run as one self-describing netCDF (HDF5) file with units and coordinates."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from bem.errors import ResultsError
from bem.results.atomic import reason, replacing
from bem.scenes.context import Variable

if TYPE_CHECKING:
    import xarray


def to_dataset(variables: Mapping[str, Variable], attributes: Mapping[str, Any]) -> xarray.Dataset:
    """Variables as an `xarray.Dataset`; those named like their only dimension become coordinates."""
    import xarray

    def entry(variable: Variable) -> tuple[tuple[str, ...], Any, dict[str, str]]:
        return variable.dimensions, variable.values, {"units": variable.units, "long_name": variable.description}

    coordinates = {name: entry(item) for name, item in variables.items() if item.dimensions == (name,)}
    data = {name: entry(item) for name, item in variables.items() if name not in coordinates}
    return xarray.Dataset(data, coords=coordinates, attrs=dict(attributes))


def write_variables(path: Path, variables: Mapping[str, Variable], attributes: Mapping[str, Any]) -> None:
    """Write the file, whole or not at all, the same bytes for the same values; ResultsError if it cannot be.

    h5netcdf is used directly: `xarray.Dataset.to_netcdf` would import a scheduler (a second) where dask is installed.
    """
    import h5netcdf
    import h5py

    with replacing(path) as temporary:
        try:
            with h5netcdf.File(temporary, "w") as file:
                file.attrs.update(attributes)
                for item in variables.values():
                    for name, size in zip(item.dimensions, item.values.shape, strict=True):
                        if name not in file.dimensions:
                            file.dimensions[name] = size
                for name, item in variables.items():
                    text = item.values.dtype.kind in "US"
                    values = item.values.astype(object) if text else np.ascontiguousarray(item.values)
                    stored = file.create_variable(name, item.dimensions, h5py.string_dtype() if text else values.dtype, data=values)
                    stored.attrs["units"] = item.units
                    stored.attrs["long_name"] = item.description
        except RuntimeError as error:  # HDF5 reports a full disk this way when it closes the file
            raise OSError(None, str(error).splitlines()[0]) from error


def read_dataset(path: Path) -> xarray.Dataset:
    """The dataset in the file, loaded; ResultsError if it is missing or damaged."""
    import xarray

    try:
        with xarray.open_dataset(path, engine="h5netcdf") as dataset:
            return dataset.load()
    except OSError as error:
        raise ResultsError(f"{path}: cannot be read ({reason(error)})") from error
    except (RuntimeError, ValueError, KeyError, TypeError) as error:
        raise ResultsError(f"{path}: is damaged ({str(error).splitlines()[0]})") from error
