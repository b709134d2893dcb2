"""Error bars of running-in: from the same cycles on the grid of twice the cell, where that is asked for."""

import copy
import json
import math

import numpy as np
import pytest
from small_scenes import PATCH

from bem import ConvergenceError, Grid
from bem.accuracy import running_in_bars
from bem.accuracy.wear import FROM_START, MIXED_RULES, worn_change
from bem.kinds.running_in.errors import at_resolution
from bem.runs import run_scene
from bem.scenes import build, get_kind
from bem.scenes.load import scene_from_table
from bem.scenes.wearing import on_every_second_cell
from reports.experiments.running_in_error_bars import EXPERIMENT

SCENE = {
    "kind": "running-in",
    "speeds": ["0.003 m/s", "0.5 m/s"],
    "depths": {"count": 12, "spacing": "100 nm"},
    "cycles": {"count": 6, "averaged": 3, "settled": 3, "coarser_grid": True},
    "sharing": {"film_points": 200},
    **PATCH,
    "contact": PATCH["contact"] | {"boundary_friction": 0.35},  # so that the coarser loop wears, too
}


def summary_of(tmp_path, **tables):
    return run_scene(copy.deepcopy(SCENE) | tables, tmp_path / "run", figures=False).summary


def test_figures_have_bars_in_boundary_lubrication_and_in_full_film_and_stay_what_they_are(tmp_path):
    found = summary_of(tmp_path)
    assert found["particles_per_cycle"][0] > 0 == found["contact_load_N"][1]
    for key in (
        "friction_initial",
        "friction_run_in",
        "Sq_initial_nm",
        "Sq_final_nm",
        "minimum_film_nm",
        "lambda_ratio",
    ):
        assert found[f"{key}_error"] == found[f"{key}_error_grid"], key
        assert all(error > 0 for error in found[f"{key}_error"]), key
    # no contact on either grid, and so none that could be wrong
    assert found["contact_load_N_error"][1] == 0
    # both loads together are given
    assert found["film_load_N_error"] == found["contact_load_N_error"]
    assert found["particle_equivalent_radius_nm_error"] in (None, [None, None])
    plain = summary_of(tmp_path / "plain", cycles={"count": 6, "averaged": 3, "settled": 3})
    for key in ("friction_run_in", "Sq_final_nm", "contact_load_N", "particles_per_cycle"):
        assert found[key] == plain[key], key
    assert "friction_run_in_error" not in plain


@pytest.mark.internal
def test_the_coarser_loop_has_half_of_all_and_slides_as_far():
    kind = get_kind("running-in")
    scene = kind.resolved(scene_from_table(copy.deepcopy(SCENE)))
    half = at_resolution(scene, 0.5)
    one, other = build.grid_of(scene.grid), build.grid_of(half.grid)
    assert other.shape == (32, 16)
    assert other.lengths == pytest.approx(one.lengths)
    assert half.sharing.film_points == 100
    assert half.wear.shift == 2  # of 3: half a cell cannot be slid
    assert build.grid_of(at_resolution(half, 2).grid) == one


def test_a_film_that_cannot_be_halved_is_doubled(tmp_path):
    """On 100 points, the fewest of a film, the coarser loop had as many, and bars no part of the film."""
    full = {"speeds": ["0.5 m/s"], "contact": PATCH["contact"]}
    found = summary_of(tmp_path, **full, sharing={"film_points": 100})
    alone = SCENE["cycles"] | {"coarser_grid": False}
    fine = summary_of(tmp_path / "fine", **full, sharing={"film_points": 400}, cycles=alone)
    for key in ("friction_run_in", "film_friction_part", "minimum_film_nm", "lambda_ratio"):
        missed = abs(found[key][0] - fine[key][0])
        assert missed < found[f"{key}_error"][0], key
        if not key.startswith(("friction", "film")):
            assert missed > 0.001 * found[key][0], key
            # 2.4 of the difference to twice the points, where order two leaves 4/3 of it
            assert found[f"{key}_error"][0] < 4 * missed, key


@pytest.mark.internal
def test_where_nothing_wears_only_what_was_before_any_wear_has_a_bar():
    worn = dict.fromkeys(MIXED_RULES, 1.0)
    for found, coarser in ((worn, worn | {"worn_depth": 0.0}), (worn | {"worn_depth": 0.0},) * 2):
        told = running_in_bars(found, coarser)
        assert {name for name, bar in told.values.items() if bar is not None} == set(FROM_START)
        assert told.notes[0].values["reason"] == "nothing-wears"
    full = worn | {"worn_depth": 0.0, "contact_load": 0.0}
    assert None not in running_in_bars(full, full).values.values()
    assert None not in running_in_bars(worn, worn | {"friction": 2.0}).values.values()


@pytest.mark.internal
def test_where_one_of_film_and_contact_has_all_of_the_load_wear_passes_little():
    """A tenth of what wears differently stood in the bars of friction whatever passes: forty times the error."""
    contact = dict.fromkeys(MIXED_RULES, 1.0) | {"film_load": 0.01}
    worn = contact | {"worn_depth": 2.0}
    shared = running_in_bars(contact | {"film_load": 1.0}, worn | {"film_load": 1.0}).values
    alone = running_in_bars(contact, worn).values
    for name in ("friction", "boundary_friction_part", "contact_load", "contact_area_fraction"):
        assert shared[name] > 0.1
        assert 0.001 < alone[name] < 0.01
    # the film's load is off by as much, and its thickness with it
    assert alone["film_load"] == alone["contact_load"]
    assert alone["minimum_film"] > 0.1


def test_wear_of_a_law_by_pressure_has_the_error_of_the_load(tmp_path):
    """Archard's V = k F s, and the depth over a track, had the bar of wear by pieces, twenty times that of F."""
    law = {"kind": "archard", "specific_wear_rate": "1e-7 mm^3/(N*m)", "distance": "2 mm"}
    wear, cycles = {"criterion": law}, SCENE["cycles"] | {"averaged": 6, "settled": 6}
    found = summary_of(tmp_path, wear=wear, cycles=cycles, speeds=["0.003 m/s"])
    volume, depth, load = (
        found[f"{name}_error"][0] / found[name][0] for name in ("wear_volume_um3", "worn_depth_nm", "contact_load_N")
    )
    assert volume == pytest.approx(load, rel=0.5), "all cycles are averaged: V is the load times k s"
    assert volume > 0
    assert depth == pytest.approx(volume, rel=1e-6), "the region is the whole track, and its depth the volume over it"
    fine = {"shape": [128, 64], "spacing": "0.4 um", "periodic": [False, True]}
    alone = cycles | {"coarser_grid": False}
    finer = summary_of(tmp_path / "fine", wear=wear, cycles=alone, speeds=["0.003 m/s"], grid=fine)
    for name in ("wear_volume_um3", "worn_depth_nm"):
        assert abs(finer[name][0] / found[name][0] - 1) < 2 * volume, name
    # its rate is that of the load, too
    rate = found["criterion_wear_rate_mm3_Nm_error"][0] / found["criterion_wear_rate_mm3_Nm"][0]
    assert rate == pytest.approx(volume, rel=1e-6)


def test_bars_of_a_running_in_that_hardly_wears_are_those_of_its_start(tmp_path):
    """Bars held a fraction of Sq, of lambda and of the load however little wore: 15 nm of Sq where 4 fm were worn."""
    law = {"kind": "archard", "specific_wear_rate": "1e-9 mm^3/(N*m)", "distance": "1 mm"}
    surface = {"kind": "generated", "rms_height": "120 nm", "correlation_length": "4 um", "drawn_on": [64, 32]}
    lower = {"material": "steel-disk-110HV", "surface": surface}
    changes = {"wear": {"criterion": law}, "speeds": ["0.12 m/s"], "lower": lower}
    found = summary_of(tmp_path, **changes)
    fine = {"shape": [128, 64], "spacing": "0.4 um", "periodic": [False, True]}
    alone = SCENE["cycles"] | {"coarser_grid": False}
    changes["wear"] = changes["wear"] | {"shift": 6}
    finer = summary_of(tmp_path / "fine", **changes, grid=fine, cycles=alone, sharing={"film_points": 400})
    assert 0 < found["worn_depth_nm"][0] < 1e-4
    for key in ("Sq_final_nm", "lambda_ratio", "contact_load_N", "criterion_wear_rate_mm3_Nm"):
        assert abs(found[key][0] - finer[key][0]) < found[f"{key}_error"][0], key
    assert found["Sq_final_nm_error"][0] < 1e-4, "15 nm"
    assert found["lambda_ratio_error"][0] < 4 * abs(found["lambda_ratio"][0] - finer["lambda_ratio"][0]), "0.13"


@pytest.mark.internal
def test_the_error_of_sq_is_at_most_that_of_its_start_and_what_wear_changes():
    """A sine of heights and a sine of depths in phase: Sq falls by their whole, and a seminorm changes by no more."""
    assert worn_change(1.0, 0.8, 0.2) == pytest.approx(0.2)
    assert worn_change(1.0, 1.0, 0.0) == 0.0
    # depths that are a tenth of the heights and not in phase change Sq by half of their square
    assert worn_change(1.0, math.sqrt(1.01), 0.1) == pytest.approx(0.01, rel=0.01)
    figures = dict.fromkeys(MIXED_RULES, 1.0) | {"worn_depth": 1e-3}
    coarser = figures | {"worn_depth": 5e-3, "Sq_initial": 1.1, "Sq_final": 1.15}
    hardly = running_in_bars(figures, coarser, unworn_error=0.02, worn_rms=1e-3).values
    assert 0.02 < hardly["Sq_final"] <= 0.02 + 2e-3
    assert running_in_bars(figures, coarser, unworn_error=0.0, worn_rms=1e-3).values["Sq_final"] <= 2e-3
    assert running_in_bars(figures, coarser, unworn_error=0.0, worn_rms=1.0).values["Sq_final"] > 0.3
    for name in ("lambda_ratio", "contact_load", "friction"):
        assert hardly[name] < 0.015, name


def test_odd_grids_have_none_and_say_so(tmp_path):
    found = summary_of(tmp_path, grid={"shape": [64, 31], "spacing": "0.8 um"}, speeds=["0.5 m/s"])
    assert found["friction_run_in_error"] in (None, [None])
    assert any("even numbers of cells" in note["text"] for note in found["notes"])


def test_the_stored_judgement_covers():
    stored = json.loads(EXPERIMENT.path.read_text())
    bars = sum(row["bars"] for row in stored["figures"].values())
    covered = sum(row["bars"] * row["covered"] for row in stored["figures"].values())
    assert bars > 100
    # 90 %; film and contact loads 82 to 88 %: a piece more or less on finer cells is no matter of order
    assert covered / bars > 0.85


@pytest.mark.internal
def test_a_coarser_loop_that_does_not_converge_leaves_the_case_as_it_is():
    grid = Grid((32, 24), (1e-6, 1e-6), periodic=(False, True))
    flat = np.zeros(grid.shape)

    def stalls(heights, across):
        assert heights[0].shape == (16, 12)
        raise ConvergenceError("cycle 1: the contact stalled")

    assert on_every_second_cell((flat, flat), grid, stalls) is None
    assert on_every_second_cell((flat, flat), grid, lambda heights, across: 7.0) == 7.0
    told = running_in_bars(dict.fromkeys(MIXED_RULES, 1.0), None)
    assert set(told.values.values()) == {None}
    assert told.notes[0].values["reason"] == "even-cells-of-loop"
