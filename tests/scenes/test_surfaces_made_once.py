"""Generated surfaces are made once for plan, run and points of a sweep, and are what the generator makes."""

from collections import Counter

import numpy as np
import pytest
from small_scenes import CONTACT

import bem.surfaces
from bem import Grid, generate_surface, run_scene
from bem.runs import run_sweep
from bem.scenes import build
from bem.scenes.checks import surfaces_of
from bem.scenes.common import GeneratedSurface

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
    monkeypatch.setattr(surfaces_of, "_described", lambda *of: counted.update(["described"]) or describe(*of))
    build.KEPT.clear()
    surfaces_of._generated.cache_clear()
    yield counted
    build.KEPT.clear()


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
    assert np.abs(other - first).max() > 1e-9


def test_marks_of_a_tool_stand_on_the_waves_that_are_kept(made):
    marked = surface(feed_marks={"feed": 8e-6, "nose_radius": 2e-4})
    first = build.heights_of(marked, GRID, 5)
    plain = build.heights_of(surface(), GRID, 5)
    marks = build.marks_of(marked, GRID, 5)
    np.testing.assert_array_equal(first, plain + (marks - marks.mean()))
    assert made[5] == 1


def test_surfaces_that_are_too_large_are_not_kept(made, monkeypatch):
    monkeypatch.setattr(build.KEPT, "limit", 8 * GRID.cells - 1)
    for _ in range(2):
        build.heights_of(surface(), GRID, 5)
    assert made[5] == 2
    assert build.KEPT.nbytes == 0
