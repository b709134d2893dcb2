"""What is written by HDF5 itself is netCDF-4 as h5netcdf would write it."""

import h5netcdf
import h5py
import numpy as np
import pytest

from bem.results.dataset import read_dataset, write_variables
from bem.scenes.context import Variable

pytestmark = pytest.mark.internal


@pytest.fixture
def variables():
    """Coordinates, one of text; a dimension without a variable; a variable called like a dimension it does not have;
    a coordinate of two dimensions; numbers without dimensions; nothing at all along one dimension."""
    rng = np.random.default_rng(1)
    return {
        "x": Variable(("x",), np.arange(4.0), "m", "x, along sliding"),
        "pressure": Variable(("x", "y"), rng.random((4, 3)), "Pa", "pressure"),
        "load": Variable((), np.array(2.5), "N", "load µ"),
        "component": Variable(("component",), np.array(["xx", "größer"]), "1", "component"),
        "stress": Variable(("component", "x"), rng.random((2, 4)).astype(np.float32), "Pa", "stress"),
        "state": Variable(("x",), np.array([True, False, True, True]).astype(np.int8), "1", "state"),
        "depth": Variable(("case", "depth"), rng.random((2, 5)), "m", "depth of each case"),
        "case": Variable(("case", "x"), rng.random((2, 4)), "1", "a coordinate of two dimensions"),
        "none": Variable(("nothing",), np.empty(0), "1", "no value"),
    }


ATTRIBUTES = {"title": "Röllchen", "seed": 3, "axes": ""}


def by_h5netcdf(path, variables):
    with h5netcdf.File(path, "w") as file:
        file.attrs.update(ATTRIBUTES)
        for item in variables.values():
            for name, size in zip(item.dimensions, item.values.shape, strict=True):
                if name not in file.dimensions:
                    file.dimensions[name] = size
        for name, item in variables.items():
            text = item.values.dtype.kind in "US"
            kind = h5py.string_dtype() if text else item.values.dtype
            stored = file.create_variable(
                name, item.dimensions, kind, data=item.values.astype(object if text else kind)
            )
            stored.attrs["units"], stored.attrs["long_name"] = item.units, item.description


def told(path):
    """Of each dataset: shape, type, and attributes, references by what they point at."""
    with h5py.File(path) as file:
        found = {}
        for name, dataset in file.items():
            attributes = {}
            for key, value in dataset.attrs.items():
                if key == "DIMENSION_LIST":
                    value = [[file[reference].name for reference in row] for row in value]
                if key == "REFERENCE_LIST":
                    value = sorted((file[reference].name, int(axis)) for reference, axis in value)
                attributes[key] = np.asarray(value).tolist()
            found[name] = (dataset.shape, str(dataset.dtype), attributes)
        return found


def test_the_layout_is_that_of_h5netcdf(tmp_path, variables):
    del variables["none"]  # h5netcdf takes a dimension of length zero as one without an end
    write_variables(tmp_path / "ours.nc", variables, ATTRIBUTES)
    by_h5netcdf(tmp_path / "theirs.nc", variables)
    ours, theirs = told(tmp_path / "ours.nc"), told(tmp_path / "theirs.nc")
    assert ours.keys() == theirs.keys()
    for name in ours:
        assert ours[name] == theirs[name], name


def test_everything_is_read_back(tmp_path, variables):
    write_variables(tmp_path / "ours.nc", variables, ATTRIBUTES)
    with h5netcdf.File(tmp_path / "ours.nc") as file:
        assert file.attrs["title"] == "Röllchen"
        assert {name: len(size) for name, size in file.dimensions.items()} == {
            "x": 4, "y": 3, "component": 2, "case": 2, "depth": 5, "nothing": 0,
        }  # fmt: skip
        for name, item in variables.items():
            stored = file.variables[name]
            assert stored.dimensions == item.dimensions, name
            values = [value.decode() if isinstance(value, bytes) else value for value in np.ravel(stored[...]).tolist()]
            assert values == np.ravel(item.values).tolist(), name
            assert stored.attrs["units"] == item.units
            assert stored.attrs["long_name"] == item.description


def test_xarray_opens_it(tmp_path, variables):
    del variables["case"], variables["depth"]  # xarray takes no coordinate of two dimensions
    write_variables(tmp_path / "ours.nc", variables, ATTRIBUTES)
    dataset = read_dataset(tmp_path / "ours.nc")
    assert dataset.pressure.dims == ("x", "y")
    assert (dataset.x.values == variables["x"].values).all()
    assert dataset.component.values.tolist() == ["xx", "größer"]
    assert float(dataset["load"]) == 2.5
