"""Changes offered for what a plan finds: a scene with them has fewer mistakes, or without the note."""

import copy

import pytest

from bem.app.planning import shown_plan

pytestmark = pytest.mark.internal

MAP = {
    "kind": "contact",
    "grid": {"shape": 64, "lengths": "320 um"},
    "lower": {"material": "steel-52100", "surface": {"kind": "measured", "path": "example/ground-disk.al3d"}},
    "upper": {"material": "steel-52100"},
    "shape": {"kind": "sphere", "radius": "10 mm"},
    "contact": {"load": "0.5 N", "behaviour": "capped"},
}
ROUGH = {
    "kind": "contact",
    "grid": {"shape": 64, "spacing": "1 um", "periodic": True},
    "lower": {
        "material": "steel-disk",
        "surface": {"kind": "generated", "rms_height": "100 nm", "correlation_length": "2 um"},
    },
    "upper": {"material": "steel-52100"},
    "contact": {"mean_pressure": "50 MPa", "behaviour": "capped"},
}


def test_a_grid_larger_than_the_map_can_be_fitted_to_it():
    before = copy.deepcopy(MAP)
    plan = shown_plan(MAP)
    (message,) = plan.messages
    assert "along x" in message
    assert "along y" in message
    (remedy,) = plan.remedies
    mended = remedy.changed(MAP)
    assert mended["grid"] == {"shape": [128, 128], "lengths": ["102.4 um", "102.4 um"]}
    assert shown_plan(mended).messages == ()
    assert before == MAP  # a copy was changed


def test_nothing_is_offered_that_does_not_help():
    table = MAP | {"contact": {"load": "many", "behaviour": "capped"}, "grid": {"shape": 64, "lengths": "80 um"}}
    plan = shown_plan(table)
    assert plan.messages
    assert plan.remedies == ()
    sound = shown_plan(table | {"contact": MAP["contact"]})
    assert [one for one in sound.remedies if one.key == "grid"] == []


def test_roughness_that_the_cells_do_not_resolve_gets_smaller_cells():
    plan = shown_plan(ROUGH)
    assert any("correlation length" in text for text in plan.warnings)
    (remedy,) = [one for one in plan.remedies if one.key == "grid"]
    mended = remedy.changed(ROUGH)
    assert mended["grid"]["lengths"] == ["64 um", "64 um"]
    assert mended["grid"]["shape"][0] > 64
    after = shown_plan(mended)
    assert after.messages == ()
    assert not any("correlation length" in text for text in after.warnings)


def test_outliers_of_a_map_can_be_taken_for_spikes():
    table = MAP | {"grid": {"shape": [128, 128], "lengths": "102.4 um"}}
    (remedy,) = shown_plan(table).remedies
    assert remedy.key == "lower.surface.despike"
    assert shown_plan(remedy.changed(table)).warnings == ()
