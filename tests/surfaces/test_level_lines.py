"""Offsets of scan lines: removed from maps, on the command line and in scenes."""

import numpy as np
import pytest

from bem.grid import Grid
from bem.runs import plan_scene
from bem.scenes.build import heights_of
from bem.scenes.checks import examine, scene_warnings
from bem.scenes.maps import read_map
from bem.surfaces import Surface, generate_surface, level_lines, read_surface, write_surface

GRID = Grid((96, 64), (1e-6, 1e-6))


@pytest.fixture
def scanned():
    """A surface of Sq 50 nm without and with line offsets of 200 nm."""
    plain = generate_surface(GRID, rms_height=50e-9, correlation_length=2e-6, seed=3)
    return plain, plain + 200e-9 * np.random.default_rng(2).standard_normal(64)[None, :]


def test_offsets_go_and_the_heights_along_a_line_stay(scanned):
    plain, lines = scanned
    level = level_lines(lines)
    assert lines.std() > 3 * plain.std()
    assert level.std() == pytest.approx(plain.std(), rel=0.1)
    assert np.ptp(level - plain, axis=0).max() < 1e-20  # along x nothing but a constant is taken off
    assert np.median(level, axis=0) == pytest.approx(np.median(lines) + 0 * np.zeros(64), abs=1e-20)


def test_missing_points_do_not_count_and_stay_missing(scanned):
    _, lines = scanned
    holes = lines.copy()
    holes[:40, 5] = np.nan
    holes[:, 9] = np.nan
    level = level_lines(holes)
    assert (np.isnan(level) == np.isnan(holes)).all()
    assert np.nanmedian(level[:, 5]) == pytest.approx(np.nanmedian(holes), abs=1e-20)


def test_files_and_scenes_are_levelled_alike(scanned, tmp_path):
    path = write_surface(tmp_path / "scan.npz", Surface(scanned[1], GRID.spacing))
    own = read_surface(path, level_lines=True)
    assert own.metadata["lines_levelled"] is True
    assert own.heights.std() < 0.4 * read_surface(path).heights.std()
    surface = {"kind": "measured", "path": str(path), "level_lines": True}
    scene = {
        "kind": "contact",
        "lower": {"material": "steel-52100", "surface": surface},
        "upper": {"material": "steel-52100"},
        "grid": {"periodic": True},
        "contact": {"mean_pressure": "20 MPa"},
    }
    assert (read_map(plan_scene(scene)[0].lower.surface).heights == own.heights).all()


@pytest.mark.parametrize(("despike", "told"), [({}, 1), ({"despike": 6}, 0)])
def test_a_scene_with_outliers_proposes_to_remove_them(despike, told):
    scene = {
        "kind": "contact",
        "lower": {
            "material": "steel-52100",
            "surface": {"kind": "measured", "path": "example/ground-disk.al3d"} | despike,
        },
        "upper": {"material": "steel-52100"},
        "grid": {"periodic": True},
        "contact": {"mean_pressure": "20 MPa"},
    }
    notes = scene_warnings(examine(plan_scene(scene)[0]))
    assert sum("Set despike = 6" in note for note in notes) == told


def test_a_scene_says_what_despiking_left_or_that_it_found_nothing(tmp_path):
    """A tilted map lost none of its spikes by despike = 6, and no note said so."""
    heights = np.random.default_rng(1).normal(0, 1e-8, (64, 64))
    surface = {"kind": "measured", "path": str(tmp_path / "map.npz"), "despike": 6}
    scene = {
        "kind": "contact",
        "lower": {"material": "steel-52100", "surface": surface},
        "upper": {"material": "steel-52100"},
        "grid": {"periodic": True},
        "contact": {"mean_pressure": "20 MPa"},
    }
    write_surface(tmp_path / "map.npz", Surface(heights, (1e-6, 1e-6)))
    notes: list = []
    grid = Grid((64, 64), (1e-6, 1e-6), periodic=(True, True))
    heights_of(plan_scene(scene)[0].lower.surface, grid, 1, notes.append)
    assert any("No point stands out from its neighbours by 6 standard deviations" in note for note in notes)
    heights[:3, 30:33] += 1e-6  # on the edge: one row goes, and then the next stands out
    write_surface(tmp_path / "map.npz", Surface(heights, (1e-6, 1e-6)))
    (said,) = (note for note in scene_warnings(examine(plan_scene(scene)[0])) if "After despiking" in note)
    assert "3 points still stand out" in said
    assert "Set despike" not in said
