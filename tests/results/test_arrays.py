"""Arrays without xarray are those with it."""

import numpy as np
import pytest

from bem.errors import ResultsError
from bem.results.arrays import Arrays, read_arrays
from bem.results.dataset import read_dataset, write_variables
from bem.scenes.context import Variable

pytestmark = pytest.mark.internal

VARIABLES = {
    "x": Variable(("x",), np.arange(4.0), "m", "along sliding"),
    "name": Variable(("name",), np.array(["a", "µ"]), "1", "variant"),
    "state": Variable(("x",), np.arange(4, dtype=np.int8), "1", "state"),
    "height": Variable(("name", "x"), np.arange(8.0).reshape(2, 4), "m", "height"),
    "approach": Variable((), np.float64(3.0), "m", "approach"),
}


def test_what_is_read_is_what_xarray_reads(tmp_path):
    path = tmp_path / "results.nc"
    write_variables(path, VARIABLES, {"title": "t", "seed": 3})
    dataset = read_dataset(path)
    for arrays in (read_arrays(path), Arrays(VARIABLES, {"title": "t", "seed": 3})):
        assert set(arrays) == set(arrays.variables) == set(dataset.variables)
        assert arrays.sizes == dict(dataset.sizes)
        assert set(arrays.coords) == set(dataset.coords)
        assert arrays.attrs["title"] == dataset.attrs["title"]
        assert "height" in arrays
        assert "nothing" not in arrays
        for name, item in arrays.items():
            theirs = dataset[name]
            np.testing.assert_array_equal(item.values, theirs.values)
            np.testing.assert_array_equal(np.asarray(item), theirs.values)
            assert (item.dims, item.shape, item.size, item.ndim) == (
                theirs.dims,
                theirs.shape,
                theirs.size,
                theirs.ndim,
            )
            assert {key: item.attrs[key] for key in ("units", "long_name")} == theirs.attrs
        assert float(arrays["approach"]) == 3.0


def test_a_variable_may_be_called_like_the_dimension_of_another(tmp_path):
    path = tmp_path / "results.nc"
    write_variables(path, VARIABLES | {"name": Variable(("x",), np.arange(4.0), "m", "other")}, {})
    np.testing.assert_array_equal(read_arrays(path)["name"].values, np.arange(4.0))
    np.testing.assert_array_equal(read_dataset(path)["name"].values, np.arange(4.0))
    assert read_dataset(path)["name"].dims == ("x",)


def test_values_are_read_when_they_are_asked_for(tmp_path, monkeypatch):
    path = tmp_path / "results.nc"
    write_variables(path, VARIABLES, {})
    asked = []
    import bem.results.arrays as module

    read = module._values
    monkeypatch.setattr(module, "_values", lambda path, name: asked.append(name) or read(path, name))
    arrays = read_arrays(path)
    assert asked == []
    assert arrays["height"].values[1, 3] == 7.0
    assert arrays["height"].values.shape == (2, 4)
    assert asked == ["height"]


@pytest.mark.parametrize("content", [None, b"", b"not netCDF"])
def test_what_cannot_be_read_is_a_results_error(tmp_path, content):
    path = tmp_path / "results.nc"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(ResultsError, match=r"results\.nc"):
        read_arrays(path)
