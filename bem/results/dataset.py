"""Arrays of a run as one self-describing netCDF (HDF5) file with units and coordinates."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

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


def write_dataset(path: Path, dataset: xarray.Dataset) -> None:
    """Write the file, whole or not at all; ResultsError if it cannot be."""
    with replacing(path) as temporary:
        try:
            dataset.to_netcdf(temporary, engine="h5netcdf")
        except OSError:
            raise
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
