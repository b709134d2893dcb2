"""Read or generated, a surface is the same kind of thing; spikes; the package's own maps."""

import sys
from pathlib import Path

import numpy as np
import pytest

import bem
from bem import (
    Grid,
    InputError,
    Surface,
    crop,
    describe_surface,
    despike,
    displacement_operator,
    generate_surface,
    read_surface,
    solve_contact,
)
from bem.surfaces.examples import FOLDER, example_names, example_path

GRID = Grid((32, 32), (1e-6, 1e-6), periodic=(True, True))
ASKED = {"rms_height": 1e-7, "correlation_length": 4e-6, "seed": 2}


def test_both_ways_give_a_surface_and_the_promise_stays():
    made = Surface.generate(GRID, **ASKED)
    heights = generate_surface(GRID, **ASKED)
    assert type(heights) is np.ndarray  # API.md: heights (nx, ny)
    np.testing.assert_array_equal(made.heights, heights)
    assert made.metadata["periodic"] == (True, True)
    read = Surface.read("example/polished-pin.x3p")
    assert type(read) is type(made)
    for surface in (made, read):
        assert describe_surface(surface) == describe_surface(surface.heights, surface.spacing)
        assert crop(surface, (10e-6, 10e-6)).shape[0] <= 14


def test_a_surface_stands_for_its_heights():
    surface = Surface.generate(GRID, **ASKED)
    np.testing.assert_array_equal(np.asarray(surface), surface.heights)
    assert type(1e-6 - surface) is np.ndarray
    np.testing.assert_array_equal(surface + surface, 2 * surface.heights)
    material = bem.CATALOGUE["steel-52100"]
    operator = displacement_operator(GRID, material)
    ours = solve_contact(-surface, operator, load=1e-4, tolerance=1e-6)
    plain = solve_contact(-surface.heights, operator, load=1e-4, tolerance=1e-6)
    np.testing.assert_array_equal(ours.pressure, plain.pressure)


@pytest.mark.parametrize(
    "name", ["close_seams", "crop", "despike", "detrend", "resample", "write_surface", "run_sweep"]
)
def test_tools_come_from_bem_itself(name):
    assert callable(getattr(bem, name))
    assert name in dir(bem)


def test_spikes_go_and_roughness_stays():
    heights = generate_surface(Grid((128, 128), (1e-6, 1e-6)), rms_height=1e-7, correlation_length=6e-6, seed=4)
    assert not np.isnan(despike(heights, (1e-6, 1e-6))).any()  # a Gaussian surface loses nothing
    rng = np.random.default_rng(0)
    at = tuple(rng.integers(2, 126, (2, 20)))
    broken = heights.copy()
    broken[at] += 3e-6
    broken[0, :3] = np.nan
    found = np.isnan(despike(broken, (1e-6, 1e-6)))
    expected = np.isnan(broken)
    expected[at] = True
    np.testing.assert_array_equal(found, expected)


@pytest.mark.parametrize("threshold", [2.9, -1.0, float("nan"), 0.0])
def test_a_threshold_that_takes_the_surface_is_refused(threshold):
    with pytest.raises(InputError, match="at least 3"):
        despike(np.zeros((8, 8)), (1.0, 1.0), threshold)
    with pytest.raises(InputError, match="despike"):
        read_surface("example/ground-disk.al3d", despike=threshold)


@pytest.mark.internal
def test_examples_are_what_their_script_makes(tmp_path):
    """And say themselves that nothing was measured."""
    sys.path.insert(0, str(Path(__file__).parent))
    try:
        import make_examples
    finally:
        sys.path.pop(0)
    make_examples.main(tmp_path)
    assert example_names() == ("example/ground-disk.al3d", "example/polished-pin.x3p")
    for name in example_names():
        ours, again = read_surface(name, detrend="none"), read_surface(tmp_path / Path(name).name, detrend="none")
        # the same numbers but for the last bits of another machine's transforms
        np.testing.assert_allclose(ours.heights, again.heights, rtol=1e-5, atol=1e-10)
        assert "generated" in str(dict(ours.metadata["instrument"]))
        assert ours.spacing == pytest.approx((0.8e-6, 0.8e-6))


def test_examples_have_what_instruments_leave():
    raw, clean = read_surface("example/ground-disk.al3d"), read_surface("example/ground-disk.al3d", despike=6)
    assert raw.metadata["missing_points"] == 40
    assert clean.metadata["spikes"] >= 12
    assert describe_surface(raw).Sku > 10 > 4 > describe_surface(clean).Sku


@pytest.mark.internal
def test_a_file_of_ones_own_comes_first(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert example_path("example/ground-disk.al3d") == FOLDER / "ground-disk.al3d"
    (tmp_path / "example").mkdir()
    (tmp_path / "example" / "ground-disk.al3d").write_bytes(b"mine")
    assert example_path("example/ground-disk.al3d") is None
    assert example_path("example/../surface.py") is None
