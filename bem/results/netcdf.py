"""netCDF-4 as HDF5 has it: datasets with dimension scales, their attributes, and numbers of dimensions beside them.

The layout is that of the netCDF-4 file format specification (Unidata), appendix C; what it asks for is written as
h5netcdf would, and read back with it.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import h5py
import numpy as np
from h5py import h5a, h5d, h5ds, h5p, h5s, h5t
from numpy.typing import NDArray

from bem.scenes.context import LARGE, Variable, release

_TEXT = h5py.string_dtype()
_TEXT_TYPE = h5t.py_create(_TEXT, logical=True)
_NOT_A_VARIABLE = "This is a netCDF dimension but not a netCDF variable."
_CLASH = "_nc4_non_coord_"
"""In front of a variable that is called like a dimension that it does not begin with."""


class NetCDF:
    """An open HDF5 file that variables are written to.

    Parameters
    ----------
    file : empty, of `track_order`.
    attributes : of the whole file.
    shapes : dimensions and shape of all variables.
    """

    def __init__(
        self,
        file: h5py.File,
        attributes: Mapping[str, Any],
        shapes: Iterable[tuple[tuple[str, ...], tuple[int, ...]]],
    ) -> None:
        self._file = file
        self._sizes: dict[str, int] = {}
        for dimensions, shape in shapes:
            for name, size in zip(dimensions, shape, strict=True):
                self._sizes.setdefault(name, size)
        self._numbers = {name: i for i, name in enumerate(self._sizes)}
        self._scales: dict[str, Any] = {}
        self._waiting: list[tuple[Any, tuple[str, ...]]] = []
        for name, value in attributes.items():
            file.attrs[name] = value if isinstance(value, str) else np.atleast_1d(value)
        made_by = f"version=2,hdf5={h5py.version.hdf5_version},h5py={h5py.version.version}"
        file.attrs.create("_NCProperties", np.array(made_by, dtype=h5py.string_dtype("ascii", len(made_by))))

    def write(self, name: str, item: Variable) -> None:
        """Write a variable with its unit and meaning."""
        clashes = name in self._sizes and item.dimensions[:1] != (name,)
        dataset = self._dataset(_CLASH + name if clashes else name, item.values)
        if name in self._sizes and not clashes:
            self._scale(name, dataset, name)
        else:
            self._waiting.append((dataset, item.dimensions))
        if item.dimensions:
            numbers = np.array([self._numbers[of] for of in item.dimensions], dtype=np.int32)
            _attribute(dataset, b"_Netcdf4Coordinates", numbers)
            if name not in self._scales:
                _attribute(dataset, b"_Netcdf4Dimid", numbers[0])
        _text(dataset, b"units", item.units)
        _text(dataset, b"long_name", item.description)

    def finish(self) -> None:
        """Make what dimensions still lack, and tell variables of theirs."""
        for name, size in self._sizes.items():
            if name not in self._scales:
                dataset = self._dataset(name, np.zeros(size, dtype=">f4"))
                self._scale(name, dataset, f"{_NOT_A_VARIABLE}{size:10}")
        for dataset, dimensions in self._waiting:
            for i, name in enumerate(dimensions):
                h5ds.attach_scale(dataset, self._scales[name], i)

    def _scale(self, name: str, dataset: Any, label: str) -> None:
        h5ds.set_scale(dataset, label.encode())
        _attribute(dataset, b"_Netcdf4Dimid", np.int32(self._numbers[name]))
        self._scales[name] = dataset

    def _dataset(self, name: str, values: NDArray[Any]) -> Any:
        text = values.dtype.kind in "US"
        kind = _TEXT_TYPE if text else h5t.py_create(values.dtype, logical=True)
        space = h5s.create_simple(values.shape) if values.ndim else h5s.create(h5s.SCALAR)
        made = h5p.create(h5p.DATASET_CREATE)
        made.set_obj_track_times(False)  # the same bytes whenever it is written
        made.set_attr_creation_order(h5p.CRT_ORDER_TRACKED | h5p.CRT_ORDER_INDEXED)
        dataset = h5d.create(self._file.id, name.encode(), kind, space, made)
        if text:
            h5py.Dataset(dataset)[...] = values.astype(object)
        elif values.ndim > 0 and values.nbytes >= LARGE:  # it may be on disk and not in memory
            stored = h5py.Dataset(dataset)
            for i in range(len(values)):
                stored[i] = values[i]
                release(values)
        elif values.size:
            dataset.write(h5s.ALL, h5s.ALL, np.asarray(values, order="C"))
        return dataset


def _attribute(dataset: Any, name: bytes, value: Any) -> None:
    """A number or a row of numbers."""
    value = np.asarray(value)
    space = h5s.create_simple(value.shape) if value.ndim else h5s.create(h5s.SCALAR)
    h5a.create(dataset, name, h5t.py_create(value.dtype), space).write(value)


def _text(dataset: Any, name: bytes, words: str) -> None:
    attribute = h5a.create(dataset, name, _TEXT_TYPE, h5s.create(h5s.SCALAR))
    attribute.write(np.array(words, dtype=_TEXT))
