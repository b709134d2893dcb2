"""Surfaces are made, or read, once for plan, run and points of a sweep, and are what they are without."""

from collections import Counter

import numpy as np
import pytest
from small_scenes import CONTACT

import bem.surfaces
from bem import Grid, generate_surface, run_scene
from bem.numerics.cache import KeptValues
from bem.results import open_run
from bem.runs import run_sweep
from bem.scenes import build, maps
from bem.scenes.checks import surfaces_of
from bem.scenes.common import GeneratedSurface, GridScene, MeasuredSurface
from bem.surfaces import Surface, write_surface

pytestmark = pytest.mark.internal

GRID = Grid((24, 16), (1e-6, 1e-6), periodic=(True, True))
PLAIN = {"rms_height": 1e-7, "correlation_length": 3e-6}
OTHERS = {
    "upper": {
        "material": "steel-cylinder",
        "surface": {"kind": "generated", "rms_height": "30 nm", "hurst": 0.8, "skewness": -0.5},
    }
}


@pytest.fixture
def made(monkeypatch):
    """Surfaces that are made and looked at from here on, by seed."""
    counted, make, describe = Counter(), bem.surfaces.generate_surface, surfaces_of._described

    def counting(grid, *, seed, **more):
        counted.update([seed])
        return make(grid, seed=seed, **more)

    monkeypatch.setattr(bem.surfaces, "generate_surface", counting)
    read, fit = bem.surfaces.read_surface, maps.fitted
    monkeypatch.setattr(bem.surfaces, "read_surface", lambda *of, **how: counted.update(["read"]) or read(*of, **how))
    monkeypatch.setattr(maps, "fitted", lambda *of: counted.update(["fitted"]) or fit(*of))
    monkeypatch.setattr(surfaces_of, "_described", lambda *of: counted.update(["described"]) or describe(*of))
    maps.KEPT.clear()
    surfaces_of._generated.cache_clear()
    surfaces_of._described_map.cache_clear()
    yield counted
    maps.KEPT.clear()


def test_a_run_makes_a_surface_once(made, tmp_path):
    run_scene(CONTACT, tmp_path / "r", figures=False)
    assert made.pop("described") == 1
    assert list(made.values()) == [1]


def test_points_of_a_sweep_share_their_surfaces(made, tmp_path):
    """The skewed one is looked at as if it were Gaussian, which is another one: three in all."""
    found = run_sweep(CONTACT | OTHERS, ["contact.mean_pressure=log:20 MPa:80 MPa:3"], tmp_path / "s", workers=1)
    assert found.computed == 3
    assert made.pop("described") == 2
    assert sorted(made.values()) == [1, 2]


def surface(**change):
    return GeneratedSurface.model_validate({"kind": "generated"} | PLAIN | change)


def test_what_is_handed_out_is_what_the_generator_makes_and_the_callers_own(made):
    wanted = generate_surface(GRID, seed=5, **PLAIN)
    for _ in range(2):
        heights = build.heights_of(surface(), GRID, 5)
        np.testing.assert_array_equal(heights, wanted)
        heights += 1.0
    assert made[5] == 1


@pytest.mark.parametrize(
    ("change", "grid", "seed"),
    [
        ({}, GRID, 6),
        ({"seed": 6}, GRID, 5),
        ({"rms_height": 2e-7}, GRID, 5),
        ({"elongation": 2.0}, GRID, 5),
        ({}, Grid(GRID.shape, (2e-6, 1e-6), periodic=GRID.periodic), 5),
        ({"drawn_on": [48, 32]}, GRID, 5),
    ],
)
def test_other_surfaces_are_others(made, change, grid, seed):
    first = build.heights_of(surface(), GRID, 5)
    other = build.heights_of(surface(**change), grid, seed)
    assert made.total() == 2
    assert np.abs(other - first).max() > 1e-10  # of 1e-7; drawn on other cells, the same waves but for the moments


def test_marks_of_a_tool_stand_on_the_waves_that_are_kept(made):
    marked = surface(feed_marks={"feed": 8e-6, "nose_radius": 2e-4})
    first = build.heights_of(marked, GRID, 5)
    plain = build.heights_of(surface(), GRID, 5)
    marks = build.marks_of(marked, GRID, 5)
    np.testing.assert_array_equal(first, plain + (marks - marks.mean()))
    assert made[5] == 1


def test_surfaces_that_are_too_large_are_not_kept(made, monkeypatch):
    monkeypatch.setattr(maps.KEPT, "limit", 8 * GRID.cells - 1)
    for _ in range(2):
        build.heights_of(surface(), GRID, 5)
    assert made[5] == 2
    assert maps.KEPT.nbytes == 0


def write_map(path, seed=1):
    """Write a map with a spike, which a note tells of where it is removed."""
    heights = 1e-8 * np.random.default_rng(seed).standard_normal((30, 20))
    heights[5, 9] = 1e-6
    return write_surface(path, Surface(heights, (1e-6, 1e-6)))


def measured(path, **change):
    return MeasuredSurface.model_validate({"kind": "measured", "path": str(path)} | change)


def test_points_of_a_sweep_share_measured_maps(made, tmp_path):
    """Read, put on the grid and described once, with the same notes at every point; a file that has changed anew."""
    path = write_map(tmp_path / "map.npz")
    scene = CONTACT | {"lower": CONTACT["lower"] | {"surface": {"kind": "measured", "path": str(path), "despike": 6}}}
    over = ["contact.mean_pressure=20 MPa,40 MPa,80 MPa"]
    found = run_sweep(scene, over, tmp_path / "s", workers=1)
    assert (found.computed, made) == (3, {"read": 1, "fitted": 1, "described": 1})
    notes = [open_run(point).summary["notes"] for point in (tmp_path / "s" / "points").iterdir()]
    maps_notes = [{note["code"] for note in of if note["code"].startswith("map-")} for of in notes]
    assert maps_notes == [{"map-coarse", "map-altered"}] * 3
    whole = bem.surfaces.read_surface(path, despike=6)
    alone = maps.fitted(measured(path, despike=6), whole, found_grid(found), lambda text: None)
    for point in (tmp_path / "s" / "points").iterdir():
        np.testing.assert_array_equal(open_run(point).arrays["lower_height"].values, alone)
    made.clear()
    write_map(path, seed=2)
    run_sweep(scene, over, tmp_path / "t", workers=1)
    assert made == {"read": 1, "fitted": 1, "described": 1}


def found_grid(sweep):
    return build.grid_of(GridScene.model_validate(open_run(next((sweep.path / "points").iterdir())).scene["grid"]))


@pytest.mark.parametrize("change", [{"detrend": "none"}, {"crop": [2e-5, 1.5e-5]}, {"mirror": "both"}, {"fill": False}])
def test_other_treatments_of_a_map_are_others(made, tmp_path, change):
    path = write_map(tmp_path / "map.npz")
    grid = Grid((16, 12), (1e-6, 1e-6))
    for surface in (measured(path, despike=6), measured(path, despike=6, **change)):
        for _ in range(2):
            told = []
            heights = build.heights_of(surface, grid, 0, told.append)
            np.testing.assert_array_equal(
                heights, maps.fitted(surface, maps.read_map(surface), grid, lambda text: None)
            )
            assert any((note.code, note.values["reason"]) == ("map-altered", "spikes") for note in told)
            heights += 1.0  # the caller's own
    assert made["read"] == (1 if "mirror" in change else 2)
    assert made["fitted"] == 2 + 4  # four of the test's own


def test_maps_of_a_users_own_format_are_read_each_time(made, tmp_path, monkeypatch):
    """Whose reader may look at more than the file."""
    path = write_map(tmp_path / "map.npz")
    monkeypatch.setattr("bem.surfaces.formats.format_of", lambda file: object())
    for _ in range(2):
        build.heights_of(measured(path), Grid((16, 12), (1e-6, 1e-6)), 0)
    assert made == {"read": 2, "fitted": 2}


def test_a_value_that_is_too_large_drives_out_no_other():
    store = KeptValues(100)
    small = store.of("a", lambda: np.zeros(5))
    assert store.of("b", lambda: np.zeros(50)).nbytes == 400
    assert store.of("a", lambda: np.zeros(6)) is small
