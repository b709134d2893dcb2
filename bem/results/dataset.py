"""Arrays of a run as one self-describing netCDF (HDF5) file with units and coordinates."""

from __future__ import annotations

import io
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from bem.errors import ResultsError
from bem.results.atomic import reason, replacing
from bem.scenes.context import Variable

if TYPE_CHECKING:
    import xarray


def write_variables(path: Path, variables: Mapping[str, Variable], attributes: Mapping[str, Any]) -> None:
    """Write the file, whole or not at all, the same bytes for the same values; ResultsError if it cannot be.

    By HDF5 itself: h5netcdf took most of the time of a sweep's points, two thirds of it for numbers without dimensions,
    and xarray would import a scheduler (a second) where dask is installed.
    """
    import h5py

    from bem.results.netcdf import NetCDF

    with replacing(path) as temporary, open(temporary, "w+b", buffering=0) as raw:
        sink = _Sink(raw)
        with h5py.File(sink, "w", track_order=True) as file:
            target = NetCDF(file, attributes, [(item.dimensions, item.values.shape) for item in variables.values()])
            for name, item in variables.items():
                target.write(name, item)
            target.finish()
        if sink.error is not None:
            raise sink.error


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
        """Read the bytes that were written; zeros where nothing was."""
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
        """Return the position."""
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
    with _readable(path), opened_dataset(path) as dataset:
        return dataset.load()


@contextmanager
def opened_dataset(path: Path) -> Iterator[xarray.Dataset]:
    """The dataset in the file; of its arrays, only what is asked for is read, each time anew.

    Raises
    ------
    ResultsError : the file is missing or damaged.
    """
    import xarray

    with _readable(path):
        found = xarray.open_dataset(path, engine="h5netcdf", cache=False)
    with found:
        yield found


@contextmanager
def _readable(path: Path) -> Iterator[None]:
    """Raise errors of reading a file as ResultsError."""
    try:
        yield
    except ResultsError:
        raise
    except OSError as error:
        raise ResultsError(f"{path}: cannot be read ({reason(error)})") from error
    except (RuntimeError, ValueError, KeyError, TypeError) as error:
        raise ResultsError(f"{path}: is damaged ({str(error).splitlines()[0]})") from error
