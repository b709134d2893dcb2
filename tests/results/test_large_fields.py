"""Fields that may not fit into memory: on disk while they are made, written in parts, drawn with fewer cells."""

import errno
import os
import tracemalloc

import numpy as np
import pytest

from bem.errors import ResultsError
from bem.numerics.blocks import BLOCK
from bem.numerics.cache import KeptValues
from bem.plots.style import largest_of, thinned
from bem.results import open_run
from bem.results.dataset import read_dataset, write_variables
from bem.results.scratch import scratch_array
from bem.runs import run_scene
from bem.scenes.context import Variable, release

pytestmark = pytest.mark.internal

SCENE = {
    "kind": "contact",
    "grid": {"shape": [32, 16], "spacing": "0.5 um", "periodic": True},
    "lower": {"material": "steel-disk"},
    "shape": {"kind": "sinusoid", "amplitude": "10 nm", "wavelength": "16 um"},
    "contact": {"mean_pressure": "2 MPa"},
    "outputs": {"von_mises": True, "depths": {"deepest": "4 um", "count": 5}},
}


def test_a_large_array_is_on_disk_and_leaves_no_file(tmp_path):
    values = scratch_array(tmp_path, (3, 64, 64), large=1)
    assert os.listdir(tmp_path) == []
    for i in range(3):
        values[i] = i
        release(values[i])
    assert [set(np.unique(plane)) for plane in values] == [{0.0}, {1.0}, {2.0}]
    small = scratch_array(tmp_path, (3, 4))
    small[:] = 1
    release(small)  # in memory: kept as it is
    assert np.all(small == 1)


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EACCES])
def test_a_disk_without_room_or_rights_is_said_beforehand(tmp_path, monkeypatch, number):
    def refused(*_):
        raise OSError(number, os.strerror(number))

    monkeypatch.setattr("os.posix_fallocate", refused)
    words = rf"cannot hold 1\.19e-07 GiB of scratch \({os.strerror(number)}\)$"  # 128 bytes
    with pytest.raises(ResultsError, match=words):
        scratch_array(tmp_path, (4, 4), large=1)
    assert os.listdir(tmp_path) == []


ROUGH = {
    "kind": "contact",
    "grid": {"shape": 512, "lengths": "100 um", "periodic": True},
    "lower": {"material": "steel-52100"},
    "contact": {"mean_pressure": "300 MPa", "tolerance": 1e-6},
}
for body in ("lower", "upper"):
    ROUGH[body] = {
        "material": "steel-52100",
        "surface": {
            "kind": "generated",
            "rms_height": "0.2 um",
            "hurst": 0.8,
            "rolloff_wavelength": "25 um",
            "cutoff_wavelength": "2 um",
        },
    }


@pytest.mark.parametrize("scene", [SCENE, ROUGH | {"grid": {"shape": 128, "lengths": "50 um", "periodic": True}}])
def test_results_are_the_same_on_disk_and_in_memory(tmp_path, monkeypatch, scene):
    run_scene(scene, tmp_path / "memory")
    monkeypatch.setattr("bem.results.scratch.scratch_array.__defaults__", (1,))
    monkeypatch.setattr("bem.results.netcdf.LARGE", 1)
    monkeypatch.setattr("bem.scenes.context.LARGE", 1)
    run_scene(scene, tmp_path / "disk")
    first, second = open_run(tmp_path / "memory"), open_run(tmp_path / "disk")
    assert first.dataset.identical(second.dataset)
    timing = ("wall_time_s", "seconds_by_stage")
    assert {k: v for k, v in first.summary.items() if k not in timing} == {
        k: v for k, v in second.summary.items() if k not in timing
    }
    for figure in (tmp_path / "memory" / "figures").glob("*.png"):
        assert figure.read_bytes() == (tmp_path / "disk" / "figures" / figure.name).read_bytes()


def test_a_rough_contact_with_its_error_bars_holds_nine_and_a_half_fields(tmp_path, monkeypatch):
    """The surfaces while the second one is made (eight fields), the contact and the error bars beside the heights (a
    field each, on disk where the grid is very large); buffers of transforms, which are not traced, come on top."""
    monkeypatch.setattr("bem.numerics.blocks.BLOCK", 1 << 12)
    monkeypatch.setattr("bem.scenes.build.KEPT", KeptValues(0))  # no large surface is kept
    field = 8 * ROUGH["grid"]["shape"] ** 2
    run_scene(ROUGH, tmp_path / "first", figures=False)  # loops, plans, spectra, surfaces that are kept
    held = {}
    for name, large in (("memory", 1 << 30), ("disk", field)):
        monkeypatch.setattr("bem.results.scratch.scratch_array.__defaults__", (large,))
        monkeypatch.setattr("bem.scenes.context.LARGE", large)
        tracemalloc.start()
        try:
            run_scene(ROUGH, tmp_path / name, figures=False)
            held[name] = tracemalloc.get_traced_memory()[1] / field
        finally:
            tracemalloc.stop()
    assert held["memory"] < 9.6
    assert held["disk"] < 8.3


def test_pictures_of_a_contact_hold_no_field_besides_its_own(tmp_path, monkeypatch):
    """But for what grows with the dots of the picture, not with the cells, of which there are few here."""
    from bem.plots.draw import draw_all
    from bem.results.arrays import Arrays
    from bem.results.read import FinishedRun

    monkeypatch.setattr("bem.plots.style._MOST_CELLS", 300)
    monkeypatch.setattr("bem.numerics.blocks.BLOCK", 1 << 12)
    cells = 1800
    rng, x = np.random.default_rng(3), np.arange(cells) * 1e-6
    heights = rng.standard_normal((cells, cells))
    pressure = np.maximum(heights - 1.5, 0.0) * 1e9
    fields = {
        "pressure": (pressure, "Pa"),
        "gap": (np.maximum(1.5 - heights, 0.0) * 1e-7, "m"),
        "undeformed_gap": (-heights * 1e-7, "m"),
        "lower_height": (heights * 1e-7, "m"),
        "contact_state": ((pressure > 0).view(np.int8), "1"),
    }
    variables = {name: Variable(("x", "y"), values, unit, name) for name, (values, unit) in fields.items()}
    variables |= {name: Variable((name,), x, "m", name) for name in "xy"}
    run = FinishedRun(tmp_path, {"contact": {}}, {"approach_m": 1e-7})
    run.__dict__["arrays"] = Arrays(variables, {})
    names = ["pressure-map", "contact-map", "contact-section", "pressure-histogram", "surface-maps"]
    draw_all(run, names[1:2], tmp_path)  # what draws
    tracemalloc.start()
    try:
        assert len(draw_all(run, names, tmp_path)) == 5
        assert tracemalloc.get_traced_memory()[1] < 2.2 * pressure.nbytes  # of the figures themselves a field and more
    finally:
        tracemalloc.stop()


def test_a_field_written_in_parts_reads_the_same(tmp_path, monkeypatch):
    values = np.random.default_rng(1).normal(size=(5, 6, 7))
    variables = {"field": Variable(("a", "b", "c"), values, "Pa", "a field")}
    monkeypatch.setattr("bem.results.netcdf.LARGE", 1)
    write_variables(tmp_path / "parts.nc", variables, {})
    np.testing.assert_array_equal(read_dataset(tmp_path / "parts.nc")["field"], values)


def test_maps_with_more_cells_than_dots():
    values = np.arange(3000.0 * 900).reshape(3000, 900)
    few = thinned(values)
    assert few.shape == (1000, 900)
    assert np.shares_memory(few, values), "no copy"
    assert few[0, 0] == values[1, 0], "the middle of each group"
    assert thinned(values[:1400]).shape == (1400, 900)


def test_the_largest_of_a_large_array():
    values = np.zeros((3, 2000, 2000))
    values[1, 7, 7], values[2, 0, 0], values[0, 0, 0] = -5.0, np.nan, np.inf
    assert largest_of(values) == 5.0
    assert largest_of(np.full(4, np.nan)) == 0.0
    assert largest_of(-3.0) == 3.0
    assert largest_of(np.zeros((0, 4))) == 0.0


@pytest.mark.parametrize("shape", [(2048 * 2048,), (1 << 21, 2), (2048, 2048)])
def test_the_largest_of_an_array_is_looked_for_in_blocks_whatever_its_shape(shape, monkeypatch):
    """Entry by entry, a list of 4 million values took 104 s."""
    looks = []
    monkeypatch.setattr("bem.plots.labels.release", lambda array: looks.append(1))
    values = np.zeros(shape)
    values.flat[-1] = -7.0
    assert largest_of(values) == 7.0
    assert len(looks) <= 2 * values.size / BLOCK + 2
