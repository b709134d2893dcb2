"""Arrays of a run as one self-describing netCDF (HDF5) file with units and coordinates."""

from __future__ import annotations

import io
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from bem.errors import ResultsError
from bem.results.atomic import reason, replacing
from bem.scenes.context import LARGE, Variable, release

if TYPE_CHECKING:
    import xarray


def write_variables(path: Path, variables: Mapping[str, Variable], attributes: Mapping[str, Any]) -> None:
    """Write the file, whole or not at all, the same bytes for the same values; ResultsError if it cannot be.

    The netCDF-4 data model in HDF5 (NetCDF User's Guide, "File Format Specifications"): dimensions are scales, attached
    to the variables. h5py is used directly: h5netcdf took twice as long for it as a small contact takes to solve, and
    xarray would import a scheduler (a second) where dask is installed.
    """
    import h5py

    with replacing(path) as temporary, open(temporary, "w+b", buffering=0) as raw:
        sink = _Sink(raw)
        with h5py.File(sink, "w", track_order=True) as file:
            versions = f"version=2,h5py={h5py.version.version},hdf5={h5py.version.hdf5_version}"
            file.attrs.update({"_NCProperties": np.bytes_(versions), **attributes})
            sizes = {
                name: size
                for item in variables.values()
                for name, size in zip(item.dimensions, item.values.shape, strict=True)
            }
            stored = [(item, _stored(file, name, item, sizes)) for name, item in variables.items()]
            for number, (name, size) in enumerate(sizes.items()):
                bare = name not in file
                scale = file.create_dataset(name, (size,), ">f4", track_order=True) if bare else file[name]
                scale.make_scale(f"{_NO_VARIABLE} {size:10d}" if bare else name)
                scale.attrs["_Netcdf4Dimid"] = np.int32(number)
            for item, dataset in stored:
                for axis, name in enumerate(item.dimensions):
                    if dataset != file[name]:
                        dataset.dims[axis].attach_scale(file[name])
        if sink.error is not None:
            raise sink.error


_NO_VARIABLE = "This is a netCDF dimension but not a netCDF variable."


def _stored(file: Any, name: str, item: Variable, dimensions: Mapping[str, int]) -> Any:
    """The dataset of a variable; one named like a dimension that is not its own is marked as the format asks for."""
    import h5py

    text = item.values.dtype.kind in "US"
    kind = h5py.string_dtype() if text else item.values.dtype
    values = item.values.astype(object) if text else np.asarray(item.values, order="C")
    parts = not text and values.ndim > 0 and values.nbytes >= LARGE  # it may be on disk and not in memory
    own = name not in dimensions or item.dimensions == (name,)
    stored = file.create_dataset(
        name if own else f"_nc4_non_coord_{name}",
        values.shape,
        kind,
        data=None if parts else values,
        track_order=True,
    )
    for i in range(len(values) if parts else 0):
        stored[i] = values[i]
        release(values)
    stored.attrs.update({"units": item.units, "long_name": item.description})
    return stored


class _Sink(io.RawIOBase):
    """A file that never fails but keeps its first error: HDF5 crashes the process when a disk fills."""

    def __init__(self, raw: io.FileIO) -> None:
        self._raw = raw
        self.error: OSError | None = None

    def write(self, data: Any) -> int:
        """All of `data`, or, once something has failed, nothing."""
        view = memoryview(data).cast("B")
        done = 0
        try:
            while done < len(view) and self.error is None:
                done += self._raw.write(view[done:]) or 0
        except OSError as error:
            self.error = error
        return len(view)

    def readinto(self, buffer: Any) -> int:
        """What was written; zeros where nothing was."""
        view = memoryview(buffer).cast("B")
        done = self._raw.readinto(view) or 0
        view[done:] = bytes(len(view) - done)
        return len(view)

    def truncate(self, size: int | None = None) -> int:
        """Set the length."""
        try:
            return self._raw.truncate(size)
        except OSError as error:
            self.error = self.error or error
            return size or 0

    def seek(self, offset: int, whence: int = 0) -> int:
        """Move."""
        return self._raw.seek(offset, whence)

    def tell(self) -> int:
        """Where we are."""
        return self._raw.tell()

    def readable(self) -> bool:
        """Yes."""
        return True

    def writable(self) -> bool:
        """Yes."""
        return True

    def seekable(self) -> bool:
        """Yes."""
        return True


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
