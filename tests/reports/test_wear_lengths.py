"""What the chapter on wear criteria says, against the stored experiment."""

import json
from statistics import mean

import pytest

from reports import wear_lengths
from reports.wear_lengths import MEASURED_RATE, SIZES, by_seed, change


def average(criterion, group, value, name):
    return mean(by_seed(criterion, group, value, name).values())


def test_the_source_s_number_mean_follows_the_mesh_and_its_volume_mean_does_not_settle():
    assert change("von_mises", "number_equivalent_radius") < -0.5
    coarse, fine = (average("von_mises", "cells", mesh, "particles_per_cycle") for mesh in ("101 nm", "25 nm"))
    assert fine > 8 * coarse
    volume = [average("von_mises", "cells", mesh, "volume_equivalent_radius") for mesh in ("202 nm", "101 nm", "25 nm")]
    assert volume[1] < 0.8 * volume[0]
    assert volume[2] > 1.1 * volume[1]


@pytest.mark.parametrize("name", [*SIZES, "number_length", "number_width", "number_thickness"])
def test_averaged_stress_converges_with_cells_and_depths(name):
    # rectangles are counted in whole cells: half a cell of 51 nm is five per cent of a width
    assert abs(change("averaged_von_mises", name)) < 0.05
    by_depth = [average("averaged_von_mises", "depths", value, name) for value in ("48 nm", "24 nm")]
    assert by_depth[0] == pytest.approx(by_depth[1], rel=0.02)


def test_averaged_stress_has_the_length_and_width_of_the_microscope_and_not_the_thickness():
    sizes = [average("averaged_von_mises", "cells", "51 nm", f"number_{s}") for s in ("length", "width", "thickness")]
    assert sizes[:2] == pytest.approx([747e-9, 541e-9], rel=0.1)
    assert sizes[2] > 2 * 145e-9


@pytest.mark.parametrize("group", ["load", "soft body's Sq"])
def test_sizes_of_averaged_stress_do_not_follow_load_and_soft_roughness(group):
    values = {"load": ("2.5 N", "5 N", "10 N"), "soft body's Sq": ("300 nm", "610 nm", "1200 nm")}[group]
    for name in SIZES:
        sizes = [average("averaged_von_mises", group, value, name) for value in values]
        assert max(sizes) < 1.1 * min(sizes)


@pytest.mark.parametrize(
    ("group", "value", "material"),
    [("cells", "101 nm", "steel"), ("cells", "51 nm", "steel"), ("material", "brass film", "brass")],
)
def test_passes_give_the_measured_wear_rate_within_a_factor_of_two(group, value, material):
    rate = average("low_cycle_fatigue", group, value, "wear_rate")
    assert 0.5 < rate / MEASURED_RATE[material] < 2


@pytest.mark.parametrize("criterion", ["von_mises", "averaged_von_mises", "sphere", "junction"])
def test_without_passes_the_wear_rate_is_thousands_of_times_too_high(criterion):
    assert average(criterion, "cells", "51 nm", "wear_rate") > 1000 * MEASURED_RATE["steel"]


def test_lengths_of_pieces_that_hold_a_sphere_follow_the_mesh():
    assert change("sphere", "number_length") > 0.1
    assert abs(change("sphere", "number_equivalent_radius")) < 0.05


def test_junctions_know_no_depths_and_are_larger_than_what_was_measured():
    depths = [by_seed("junction", "depths", value, "volume_equivalent_radius") for value in ("190 nm", "48 nm")]
    assert depths[0] == depths[1]
    assert average("junction", "cells", "51 nm", "volume_equivalent_radius") > 2 * 358e-9


def test_a_film_too_thin_for_the_sphere_has_no_pieces_and_no_sizes():
    assert average("sphere", "material", "brass film", "particles_per_cycle") == 0
    assert by_seed("sphere", "material", "brass film", "number_equivalent_radius") == {}
    assert by_seed("sphere", "material", "steel", "number_equivalent_radius")  # the contact that all groups share


def test_bare_brass_has_larger_pieces_than_its_film_under_junctions_alone():
    def volume(criterion, value):
        return average(criterion, "material", value, "volume_equivalent_radius")

    larger = [name for name in wear_lengths.criteria() if name != "sphere"]
    assert [name for name in larger if volume(name, "brass") > volume(name, "brass film")] == ["junction"]
    assert volume("averaged_von_mises", "brass") == pytest.approx(194e-9, rel=0.01)
    assert volume("averaged_von_mises", "brass film") == pytest.approx(353e-9, rel=0.01)


def test_a_cycle_of_any_criterion_costs_little_more_than_the_source_s_on_the_same_surfaces():
    """What the guide says of the stored run."""
    stored = json.loads((wear_lengths.RESULT.parent / "wear_cycle_times.json").read_text("utf-8"))["rows"]

    def ratios(surfaces, *criteria):
        chosen = [row for row in stored if row["surfaces"] == surfaces and row["criterion"] in criteria]
        return [row["ratio"] for row in chosen]

    names = wear_lengths.criteria()
    assert 0.645 < min(ratios("same", *names)) <= max(ratios("same", *names)) < 1.15
    assert 0.8 < min(ratios("own", "averaged_von_mises", "sphere")) <= max(ratios("own", "averaged_von_mises")) < 1.05
    assert 1.5 < min(ratios("own", "low_cycle_fatigue")) <= max(ratios("own", "averaged_fatigue")) < 2.55
    depths = {(r["criterion"], r["seed"]): r["depths_computed"] for r in stored if r["surfaces"] == "own"}
    for seed in (1, 2):
        assert 2.5 < depths["low_cycle_fatigue", seed] / depths["von_mises", seed] < 4.5
        assert depths["averaged_fatigue", seed] < 5.5 * depths["von_mises", seed]


def test_the_chapter_is_drawn():
    first, *others = wear_lengths.chapter()
    assert "data:image/png" in first.body
    assert len(others) == 6
    assert all("fatigue" in section.body for section in others)
