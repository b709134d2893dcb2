"""What is warned of before and after a run: every check fires where it should, and not next to it."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from small_scenes import PATCH, oiled_ball

from bem import Grid
from bem.errors import InputError
from bem.materials import CATALOGUE, Body, Layer
from bem.notes import OUTSIDE, outside
from bem.notes.note import percent
from bem.quantities import si
from bem.runs import plan_scene, run_scene
from bem.scenes import library
from bem.scenes.checks import OUTCOME_CHECKS, SCENE_CHECKS, examine, outcome_warnings, scene_warnings, surfaces_of
from bem.scenes.checks.hertz import line_contact_on_layer, smooth_contact
from bem.scenes.checks.overview import bodies, common, differing
from bem.scenes.checks.words import times
from bem.scenes.common import GeneratedSurface
from bem.scenes.context import Outcome, Variable
from bem.surfaces import write_surface
from bem.surfaces.surface import Surface
from bem.wear.outcome import drift

STEEL = "steel-52100"
BALL = {
    "kind": "contact",
    "grid": {"shape": 32, "lengths": "400 um"},
    "lower": {"material": STEEL},
    "upper": {"material": STEEL},
    "shape": {"kind": "sphere", "radius": "10 mm"},
    "contact": {"load": "19 N"},
}
ROUGH = {
    "kind": "contact",
    "grid": {"shape": 64, "lengths": "40 um", "periodic": True},
    "lower": {
        "material": STEEL,
        "surface": {"kind": "generated", "rms_height": "50 nm", "correlation_length": "4 um"},
    },
    "contact": {"mean_pressure": "50 MPa", "behaviour": "capped"},
}
SINE = {
    "kind": "contact",
    "grid": {"shape": [64, 4], "spacing": "1 um", "periodic": True},
    "lower": {"material": STEEL},
    "shape": {"kind": "sinusoid", "amplitude": "50 nm", "wavelength": "32 um"},
    "contact": {"mean_pressure": "10 MPa"},
}


def with_(base, **settings):
    """A copy of a scene with `a__b=value` for key a.b; a value of None removes the key."""
    scene = {key: dict(value) if isinstance(value, dict) else value for key, value in base.items()}
    for path, value in settings.items():
        *tables, key = path.split("__")
        table = scene
        for name in tables:
            table[name] = dict(table.get(name, {}))
            table = table[name]
        if value is None:
            table.pop(key)
        else:
            table[key] = value
    return scene


def facts_of(source, *settings):
    return examine(plan_scene(source, settings)[0])


def material(modulus, nu=0.3, **constants):
    return {"youngs_modulus": modulus, "poissons_ratio": nu, **constants}


def capped_by_steel(softer):
    return {"lower__material": softer, "upper__material": "steel-52100", "contact__behaviour": "capped"}


def self_affine(**more):
    return {"kind": "generated", "rms_height": "50 nm", "hurst": 0.8, **more}


def random(rms_height, correlation_length):
    return {"kind": "generated", "rms_height": rms_height, "correlation_length": correlation_length}


def wear(*settings):
    return ("wear-steel-steel", *settings)


def brittle(**strength):
    """A layer that leaves where it is in tension; a strength of a fifteenth of the hardness is usual then."""
    layer = {"material": material("70 GPa", 0.22, **strength), "thickness": "2 um"}
    steel = with_(library()["wear-cylinder-scar"], upper__material=material("210 GPa"), upper__layer=layer)
    return with_(steel, wear__criterion={"kind": "maximum_tension"}, depths={"count": 8, "spacing": "100 nm"})


def coated(depths):
    """A layer of 2 um on an interlayer of 0.5 um, with stresses at some depths."""
    layers = [{"material": "dlc", "thickness": "2 um"}, {"material": "tungsten-carbide", "thickness": "0.5 um"}]
    return with_(BALL, lower__layers=layers, outputs__von_mises=True, outputs__depths=depths)


CASES = {
    "patch_sinks_at_given_separation": (
        (library()["asperities-given-film"], "sharing.separation"),
        with_(library()["asperities-given-film"], sharing__separation="volume", grid__periodic=[False, True]),
    ),
    "outside_usual_range": (  # every quantity: tests/test_plausibility.py
        (with_(BALL, lower__material=material(115.0)), '"115 GPa"'),
        with_(BALL, lower__material=material("115 GPa")),
    ),
    "viscoelastic_material": (
        (with_(BALL, lower__material="ptfe", contact__load="10 mN"), "500 MPa"),
        with_(BALL, lower__material="aluminium"),
    ),
    "incompressible_layer": (
        (with_(BALL, lower__layer={"material": material("1 GPa", 0.49), "thickness": "20 um"}), "17 times"),
        with_(BALL, lower__layer={"material": material("1 GPa", 0.45), "thickness": "20 um"}),
    ),
    "residual_stress_of_layers": (
        (with_(BALL, lower__layer={"material": "dlc", "thickness": "20 um", "residual_stress": "-2 GPa"}), "-2 GPa in"),
        with_(BALL, lower__layer={"material": "dlc", "thickness": "20 um"}),
    ),
    "hardness_against_modulus": (
        (with_(BALL, lower__material=material("200 GPa", hardness="70 GPa")), "perfect solid"),
        with_(BALL, lower__material=material("200 GPa", hardness="20 GPa")),
    ),
    "softer_body_without_hardness": (
        (with_(BALL, **capped_by_steel("phosphor-bronze")), "Give phosphor-bronze a hardness of its own"),
        with_(BALL, **capped_by_steel("peek")),
    ),
    "yield_against_hardness": (
        (with_(BALL, lower__material=material("200 GPa", hardness="7 GPa", yield_stress="5 GPa")), "hardness / 1.4"),
        with_(BALL, lower__material=material("200 GPa", hardness="7 GPa", yield_stress="2.5 GPa")),
    ),
    "tensile_strength_as_a_cap": (
        (brittle(yield_stress="400 MPa"), "the cap is 2.8 times that, 1.12 GPa"),
        brittle(yield_stress="400 MPa", hardness="6 GPa"),
    ),
    "contact_large_for_its_radius": (
        (with_(BALL, shape__radius="100 um", contact__load="25 N", grid__lengths="200 um"), "of the body's"),
        with_(BALL, shape__radius="1 mm", contact__load="25 N"),
    ),
    "hertz_pressure_above_hardness": (
        (with_(BALL, contact__load="20 kN", grid__lengths="4 mm"), "times the softer hardness"),
        with_(BALL, contact__load="20 kN", grid__lengths="4 mm", contact__behaviour="capped"),
    ),
    "yield_below_the_surface": (
        (with_(BALL, lower__material="steel-disk", contact__load="60 N"), "begins to yield"),
        with_(BALL, contact__load="100 N"),
    ),
    "mean_pressure_near_hardness": (
        (with_(ROUGH, contact__mean_pressure="4 GPa"), "0.57 of the hardness"),
        with_(ROUGH, contact__mean_pressure="4 GPa", contact__behaviour="elastic"),
    ),
    "grid_smaller_than_hertz": (
        (with_(BALL, grid__lengths="100 um"), "for a Hertz contact of 216 um"),
        with_(BALL, grid__lengths="240 um"),
    ),
    "adhesive_zone_of_few_cells": (
        (("adhesive-sphere", 'contact.adhesion.range="50 nm"'), "grid.shape to"),
        "adhesive-sphere",
    ),
    "flat_patch_with_free_edges": (
        (with_(ROUGH, grid__periodic=[True, False]), "free along y"),
        ROUGH,
    ),
    "curved_body_repeats": (
        (with_(BALL, grid__periodic=True), "3.7 contact radii apart"),
        "hertz-cylinder",
    ),
    "wave_does_not_fit_the_period": (
        (with_(SINE, shape__wavelength="30 um"), "2.133 waves"),
        SINE,
    ),
    "cylinder_too_narrow_for_a_line": (
        (wear('cylinder.width="20 um"', 'cylinder.loads=["0.03 N"]'), "a line contact needs five"),
        "wear-steel-steel",
    ),
    "few_cells_across_the_contact": (
        (with_(BALL, contact__load="0.1 N"), "There are 3 cells;"),
        BALL,
    ),
    "few_cells_per_wave": (
        (with_(ROUGH, lower__surface=self_affine(cutoff_wavelength="1.5 um")), "2.4 cells to its shortest wave"),
        with_(ROUGH, lower__surface=self_affine(cutoff_wavelength="2.5 um")),
    ),
    "few_cells_per_correlation_length": (
        (with_(ROUGH, grid__shape=20), "is 2 cells"),
        with_(ROUGH, grid__shape=40),
    ),
    "layer_against_the_mesh": (
        (with_(BALL, lower__layer={"material": "dlc", "thickness": "2 um"}), "outermost layer, dlc, is thinner"),
        with_(BALL, lower__layer={"material": "dlc", "thickness": "20 um"}),
    ),
    "depths_miss_the_largest_stress": (
        (with_(BALL, outputs__von_mises=True, outputs__depths=["0 um", "10 um", "100 um"]), "51.7 um below"),
        with_(BALL, outputs__von_mises=True, outputs__depths=["0 um", "50 um", "100 um"]),
    ),
    "few_depths_in_a_layer": (
        (coated(["0.5 um", "1 um", "1.9 um", "2.2 um", "3 um"]), "only 1 depth lies in layer 2 (2 um to 2.5 um)"),
        coated(["0.5 um", "1 um", "1.9 um", "2.1 um", "2.2 um", "2.4 um", "2.6 um"]),
    ),
    "depths_coarser_than_cells": (
        (wear('depths.spacing="500 nm"'), "Depths are 9.9 cells apart."),
        "wear-steel-steel",
    ),
    "fatigue_constants_of_another_material": (
        (("wear-brass-transfer-film", "wear.criterion=low_cycle_fatigue"), "is no steel"),
        wear("wear.criterion=low_cycle_fatigue"),
    ),
    "few_cells_per_length_of_the_criterion": (
        (
            wear('wear.criterion={kind="averaged_von_mises", averaging_length="100 nm"}'),
            'or less, or averaging_length = "300 nm".',
        ),
        wear('wear.criterion={kind="averaged_von_mises", averaging_length="400 nm"}'),
    ),
    "layer_of_one_depth": (
        (("wear-brass-transfer-film", 'depths.spacing="150 nm"'), "100 nm"),
        "wear-brass-transfer-film",
    ),
    "lengths_of_the_process": (
        (
            with_(library()["stribeck-ball-on-disc"], lower__surface={"process": "lapped"}),
            "lower: 6 um of process lapped",
        ),
        with_(
            library()["stribeck-ball-on-disc"], lower__surface={"process": "lapped", "correlation_length": "9 um"}
        ),
    ),
    "surfaces_only_roll": (
        (("stribeck-ball-on-disc", "speeds.slide_roll_ratio=0"), "asperities carry load but do not rub"),
        "stribeck-ball-on-disc",
    ),
    "nothing_slides": ((wear("wear.shift=0"), "wear.shift = 0"), wear("wear.shift=1")),
    "slides_differ": (
        (("wear-mesh-convergence", "variants[0].shift=3"), "wear.shift times the cell size"),
        "wear-mesh-convergence",
    ),
    "steep_roughness": (
        (with_(ROUGH, lower__surface=random("2 um", "4 um")), "slope is 0.97"),
        ROUGH,
    ),
    "roughness_as_large_as_the_patch": (
        (with_(ROUGH, lower__surface=random("50 um", "4 um")), "Sq 50 um"),
        ROUGH,
    ),
    "oil_outside_its_range": (
        (("film-start-stop", 'oil={ grade = "ISO VG 680", temperature = "-30 C" }'), "too thick to flow"),
        ("film-start-stop", 'oil={ grade = "ISO VG 68", temperature = "60 C" }'),
    ),
    "creepage_of_a_unit": (
        (("rolling-creepage", "over=", "roll.creepage=0.3"), "0.3 is 30 %"),
        ("rolling-creepage", "over=", "roll.creepage=0.003"),
    ),
    "tribofilm_on_a_coating": (
        (("tribofilm-ball", 'lower.layer={material="dlc",thickness="2 um"}'), "Growth constants come from steel"),
        "tribofilm-ball",
    ),
    "growth_without_a_barrier": (
        (("tribofilm-afm-tip", 'film.activation_volume="900 angstrom^3"'), "above the barrier of 0.8 eV"),
        "tribofilm-afm-tip",
    ),
}  # fmt: skip


def fired(name, source):
    settings = source[1:] if isinstance(source, tuple) else ()
    return list(SCENE_CHECKS[name](facts_of(source[0] if isinstance(source, tuple) else source, *settings)))


@pytest.mark.internal
@pytest.mark.parametrize("name", CASES)
def test_a_check_of_scenes_fires_where_it_should_and_not_next_to_it(name):
    (bad, words), good = CASES[name]
    found = fired(name, bad)
    assert found, "nothing is said"
    assert words in " ".join(found)
    assert fired(name, good) == []


@pytest.mark.internal
@pytest.mark.parametrize("size", [{"lengths": ["400 um", "16 mm"]}, {"spacing": ["12.5 um", "16 mm"]}])
def test_the_one_cell_of_a_period_is_no_cell_to_warn_of(size):
    """Of a line contact it has any length: no usual range holds for it, and no layer is thin against it."""
    layer = {"material": "dlc", "thickness": "20 um"}
    line = with_(BALL, shape__kind="cylinder", lower__layer=layer)
    told = []
    for cells, periodic in ((1, True), (1, False), (2, True)):
        scene = line | {"grid": {"shape": [32, cells], "periodic": [False, periodic]} | size}
        told.append(" ".join(map(str, scene_warnings(facts_of(scene)))))
    words = ("outside its usual range", "thick on cells of")
    assert not any(word in told[0] for word in words)
    assert all(word in told[1] for word in words)
    assert words[1] in told[2]


def test_a_ball_on_a_grid_periodic_along_both_axes_is_told_once():
    (said,) = fired("curved_body_repeats", with_(BALL, grid__periodic=True))
    assert "periodic along x and y" in said


def test_an_elongated_surface_is_held_against_each_length_of_the_patch():
    """384 um x 96 um of ridges 38 um x 9.5 um long are ten of their lengths along both axes."""
    lay = {"kind": "generated", "rms_height": "50 nm", "correlation_length": "19 um", "elongation": 4}
    patch = with_(ROUGH, grid__shape=[96, 48], grid__lengths=["384 um", "96 um"], lower__surface=lay)
    assert fired("patch_of_few_correlation_lengths", patch) == []
    (said,) = fired("patch_of_few_correlation_lengths", with_(patch, grid__lengths=["192 um", "96 um"]))
    assert "5.1 correlation lengths of the lower surface long along x" in said


def test_interfaces_that_no_depths_bracket_are_named():
    """Three depths in every layer and none near the interface at 2 um; a depth at it lies in the layer above."""
    depths = ["0.5 um", "1 um", "1.5 um", "2.2 um", "2.3 um", "2.4 um", "2.55 um"]
    (said,) = fired("few_depths_in_a_layer", coated(depths))
    assert "the interface at 2 um of" in said
    assert "in layer" not in said
    at_interfaces = ["1 um", "1.5 um", "2 um", "2.05 um", "2.4 um", "2.5 um", "2.55 um"]
    assert fired("few_depths_in_a_layer", coated(at_interfaces)) == []


@pytest.mark.internal
@pytest.mark.parametrize("kind", ["point-film", "point-film-time"])
def test_a_ball_in_oil_that_yields_is_told_as_a_dry_one(kind):
    """Under 20 kN it was solved at 8 GPa, and all that was said was about the oil."""
    ball = {"radius": "10 mm", "load": "20 kN"}
    oil = {"viscosity": "0.1 Pa s", "pressure_viscosity": "18 1/GPa"}
    heavy = oiled_ball(kind, ball, oil, rolling={"mean_speed": "1 m/s"}, film={"cells": 64})
    heavy |= {"march": {"duration": "1 ms", "steps": 4}} if kind == "point-film-time" else {}
    dry = with_(BALL, contact__load="20 kN", grid__lengths="4 mm")
    (told,) = fired("hertz_pressure_above_hardness", heavy)
    (same,) = fired("hertz_pressure_above_hardness", dry)
    assert told.values["pressure"] == pytest.approx(same.values["pressure"], rel=1e-6)
    assert fired("yield_below_the_surface", heavy) == []  # said once
    light = with_(heavy, ball__load="19 N")
    assert fired("hertz_pressure_above_hardness", light) == fired("yield_below_the_surface", light) == []
    softer = with_(light, ball__load="100 N", lower__material="steel-disk")
    assert "begins to yield" in " ".join(fired("yield_below_the_surface", softer))


@pytest.mark.internal
def test_a_roller_in_oil_that_yields_or_is_no_half_space_is_told_as_a_dry_one():
    """A polymer roller was pressed to 3 times its hardness over 0.38 of its radius, converged and without a word; on a
    path the worst row is said, once."""
    soft = {"kind": "traction", "thermal": "off", "lower": {"material": "peek"}, "upper": {"material": STEEL}}
    soft |= {"oil": {"viscosity": "0.1 Pa s", "pressure_viscosity": "18 1/GPa"}}
    soft |= {"rolling": {"mean_speed": "1 m/s", "slide_roll_ratio": 0.1}}
    heavy = soft | {"roller": {"radius": "10 mm", "width": "10 mm", "load": "50 kN"}}
    assert "Hertz' pressure 829 MPa is 3 times the softer hardness" in fired("hertz_pressure_above_hardness", heavy)[0]
    assert "radius is 0.38 of the body's" in fired("contact_large_for_its_radius", heavy)[0]
    lighter = with_(heavy, roller__load="5 kN")  # 262 MPa: above 179 MPa, below the hardness
    assert fired("hertz_pressure_above_hardness", lighter) == []
    assert "1.47 times" in fired("yield_below_the_surface", lighter)[0]
    path = soft | {"roller": {"width": "10 mm"}}
    path.pop("rolling")
    path["along"] = {
        "position": ["0 mm", "1 mm", "2 mm"], "radius": ["10 mm"] * 3, "load": ["3 kN", "5 kN", "1 kN"],
        "lower_speed": ["1 m/s"] * 3, "upper_speed": ["1 m/s"] * 3,
    }  # fmt: skip
    (told,) = fired("yield_below_the_surface", path)
    assert "1.47 times" in told
    assert told.where == "1 mm"


@pytest.mark.internal
@pytest.mark.parametrize("kind", ["rolling", "partial-slip", "surface-temperature"])
def test_every_dry_elastic_kind_is_told_of_yield(kind):
    heavy = {"kind": kind, **{key: value for key, value in BALL.items() if key != "kind"}}
    heavy = with_(heavy, contact__load="20 kN", grid__lengths="4 mm")
    if kind == "surface-temperature":
        heavy = with_(heavy, contact__friction=0.1)
    heavy |= {
        "rolling": {"roll": {"friction": 0.3, "creepage": 1e-3}},
        "partial-slip": {"push": {"friction": 0.4, "share": 0.6}},
        "surface-temperature": {"heat": {"lower_speed": "3 m/s", "upper_speed": "1 m/s"}},
    }[kind]
    (told,) = fired("hertz_pressure_above_hardness", heavy)
    assert "times the softer hardness" in told


@pytest.mark.internal
def test_hardness_is_compared_with_the_pressure_on_a_layer():
    """A soft lining spreads the load: Hertz' pressure of the substrates, 33 MPa, is not that of the contact."""
    lining = {"kind": "contact", "grid": {"shape": [128, 32], "lengths": ["29.3 mm", "7.325 mm"]}}
    lining["grid"]["periodic"] = [False, True]
    lining |= {"lower": {"material": STEEL}, "shape": {"kind": "cylinder", "radius": "6.67667 m"}}
    layer = {"material": "ptfe", "thickness": "1 mm"}  # of a hardness of 27 MPa
    lining |= {"upper": {"material": STEEL, "layer": layer}, "contact": {"load": "1.465 kN"}}
    assert fired("hertz_pressure_above_hardness", lining) == []
    (told,) = fired("hertz_pressure_above_hardness", with_(lining, contact__load="6 kN"))
    assert told.values["reason"] == "layer"
    assert told.values["ratio"] == pytest.approx(told.values["pressure"] / 27e6, rel=1e-9)
    thin = with_(lining, contact__load="6 kN", upper__layer__thickness="0.3 mm")  # no closed form: the run compares
    assert fired("hertz_pressure_above_hardness", thin) == []


@pytest.mark.internal
def test_a_friction_curve_is_told_of_yield_as_a_dry_contact_where_no_cap_is():
    """By model: of a capped and an elastic one the elastic one is. The disk of 110 HV yields below its surface at
    0.7 GPa and is indented at 1.1; 200 N make 0.8 GPa, 600 N 1.35."""
    heavy = PATCH | {"kind": "friction", "speeds": {"values": ["1 m/s"]}, "sharing": {"models": ["elastic"]}}
    heavy = with_(heavy, contact__loads=["600 N"], grid__shape=[320, 32])
    (told,) = fired("hertz_pressure_above_hardness", heavy)
    assert 'take sharing.models = ["capped"]' in told
    (both,) = fired("hertz_pressure_above_hardness", with_(heavy, sharing__models=["capped", "elastic"]))
    assert both.where == "elastic"
    assert fired("hertz_pressure_above_hardness", with_(heavy, sharing__models=["capped"])) == []
    lighter = with_(heavy, contact__loads=["200 N"])
    assert fired("hertz_pressure_above_hardness", lighter) == fired("yield_below_the_surface", heavy) == []
    assert "begins to yield" in " ".join(fired("yield_below_the_surface", lighter))
    assert fired("yield_below_the_surface", with_(heavy, contact__loads=["100 N"])) == []


@pytest.mark.internal
def test_cells_unlike_along_x_and_y_are_told_the_spacing_that_the_contact_asks_for():
    cylinder = with_(BALL, shape__kind="cylinder", grid={"shape": [8, 400], "spacing": ["100 um", "1 um"]})
    (told,) = [words for words in scene_warnings(facts_of(cylinder)) if "across the Hertz contact" in words]
    # 19 N over 400 um, R = 10 mm, E* = 113.8 GPa: a = sqrt(4 P R / (pi E*)) = 72.9 um (it said 72.9 nm, of cells
    # along y)
    assert "1.5 cells" in told
    assert "spacing to 7.29 um" in told


@pytest.mark.internal
def test_cells_of_an_elongated_surface_are_looked_at_along_each_axis():
    """Ridges along y, 36 um by 4 um, on cells of 2 um: of their geometric mean there had been six, and nothing was
    said; on long cells along them all is well."""
    ridges = {"lower__surface__correlation_length": "12 um", "lower__surface__elongation": 1 / 9}
    name, lengths = "few_cells_per_correlation_length", ["120 um", "960 um"]
    (told,) = fired(name, with_(ROUGH, **ridges, grid__shape=[60, 160], grid__lengths=lengths))
    assert "length, 4 um, is 2 cells" in told
    assert fired(name, with_(ROUGH, **ridges, grid__shape=[120, 160], grid__lengths=lengths)) == []


@pytest.mark.internal
def test_one_rule_says_how_cells_resolve_a_self_affine_surface():
    """A cutoff of 8 cells, and smaller cells where the roll-off lies below 16: what the note says leaves no second one.

    A rule of the correlation length beside it had asked for 12 to 14 cells to a wave.
    """
    names = ("few_cells_per_wave", "few_cells_per_correlation_length")

    def said(shape, **waves):
        surface = self_affine(rolloff_wavelength="20 um", **waves)
        rough = with_(ROUGH, grid__shape=shape, grid__lengths="160 um", lower__surface=surface)
        return [words for name in names for words in fired(name, rough)]

    (fine,) = said(160)
    assert "Set cutoff_wavelength to 8 cells, 8 um, or more" in fine
    assert said(160, cutoff_wavelength="8 um") == []
    (coarse,) = said(64)
    assert "a spacing of 1.25 um or less and set cutoff_wavelength to 10 um" in coarse
    assert said(128, cutoff_wavelength="10 um") == said(64, cutoff_wavelength="10 um") == []


@pytest.fixture
def maps(tmp_path):
    """Maps of few points, with missing points, with nothing but form, and one as it should be."""
    rng = np.random.default_rng(3)
    few, gaps = rng.normal(0, 1e-7, (12, 9)), rng.normal(0, 1e-7, (64, 64))
    np.savez(tmp_path / "few.npz", heights=few, spacing=np.array([1e-5, 1e-5]))
    gaps[:16] = np.nan
    form = np.cos(np.pi * (np.arange(64) + 0.5) / 64)[:, None] * np.ones(64) * 1e-6
    np.savez(tmp_path / "form.npz", heights=form, spacing=np.array([1e-6, 1e-6]))
    np.savez(tmp_path / "gaps.npz", heights=gaps, spacing=np.array([1e-6, 1e-6]))
    np.savez(tmp_path / "metres.npz", heights=form * 1e6, spacing=np.array([1e-6, 1e-6]))
    write_surface(tmp_path / "whole.npz", Surface(rng.normal(0, 1e-7, (64, 64)), (1e-6, 1e-6)))
    spiky = rng.normal(0, 1e-7, (64, 64))
    spiky[20, 30] = spiky[40, 11] = 3e-6
    np.savez(tmp_path / "spiky.npz", heights=spiky, spacing=np.array([1e-6, 1e-6]))
    return tmp_path


def on_map(path, lengths, **surface):
    table = {"kind": "measured", "path": str(path), "mirror": "both", **surface}
    return with_(ROUGH, grid__lengths=lengths, lower__surface=table)


MAPS = {
    "height_unit_of_a_map": (("metres.npz", {}, "is the height unit right"), ("whole.npz", {})),
    "patch_of_few_correlation_lengths": (
        ("form.npz", {"detrend": "none"}, "5.3 correlation lengths of the lower surface long"),
        ("whole.npz", {}),
    ),
    "surface_interpolated_from_few_points": (("few.npz", {}, "6 x 6 measured points"), ("whole.npz", {})),
    "much_of_the_map_is_filled": (("gaps.npz", {}, "25 %"), ("whole.npz", {})),
    "outliers_of_the_instrument": (
        ("spiky.npz", {}, "2 points more than 6 standard"),
        ("spiky.npz", {"despike": 6.0}),
    ),
    "seams_that_alter_the_map": (
        ("form.npz", {"detrend": "none", "mirror": "none"}, "changed its heights by"),
        ("form.npz", {"detrend": "none"}),
    ),
    "scaled_out_of_proportion": (
        ("whole.npz", {"rms_height": "1 um"}, "multiplied by"),
        ("whole.npz", {"rms_height": "150 nm"}),
    ),
}


@pytest.mark.internal
@pytest.mark.parametrize("name", MAPS)
def test_a_check_of_measured_surfaces_fires_where_it_should_and_not_next_to_it(name, maps):
    (bad, keys, words), (good, good_keys) = MAPS[name]
    lengths = "64 um" if keys.get("mirror") == "none" else "128 um"  # the whole map
    found = list(SCENE_CHECKS[name](facts_of(on_map(maps / bad, lengths, **keys))))
    assert words in " ".join(found)
    assert list(SCENE_CHECKS[name](facts_of(on_map(maps / good, lengths, **good_keys)))) == []


@pytest.mark.internal
def test_a_grid_between_two_measured_points_is_not_said_to_lie_on_none(maps):
    scene = on_map(maps / "few.npz", "5 um", mirror="none")
    (said,) = SCENE_CHECKS["surface_interpolated_from_few_points"](facts_of(scene))
    assert "grid lies on 0.5 x 0.5 measured points 10 um apart" in said


def contact_outcome(pressure, **more):
    variables = {"pressure": Variable(("x", "y"), np.asarray(pressure, dtype=float), "Pa", "contact pressure")}
    for name in ("depth",):
        if name in more:
            variables[name] = Variable((name,), np.array(more.pop(name)), "m", name)
    return Outcome(more, variables)


def spot(value, size=32, at=16, width=2):
    """A square of contact under one pressure."""
    pressure = np.zeros((size, size))
    pressure[at - width : at + width, at - width : at + width] = value
    return pressure


def wear_outcome(lengths, **more):
    """Particles of the second of two cases, on cells of 50.5 nm; the first had other cells."""
    variables = {
        "cell": Variable(("load",), np.array([1e-6, 50.5e-9]), "m", "cell"),
        "particle_case": Variable(("particle",), np.ones(len(lengths), dtype=int), "1", "case"),
        "particle_volume": Variable(("particle",), np.array(lengths) ** 3, "m^3", "volume"),
        "particle_length": Variable(("particle",), np.array(lengths), "m", "length"),
        "particle_width": Variable(("particle",), np.array(lengths), "m", "width"),
    }
    return Outcome(more, variables)


def scar_outcome(depth, half_width=0.0):
    """A cylinder's scar, of which the grid holds the middle [m]."""
    before, pressure = np.zeros((300, 2)), np.zeros((300, 2))
    pressure[150 - round(half_width / 2e-6) : 150 + round(half_width / 2e-6)] = 1e8
    maps = {"height_before": before, "height_after": before - depth, "pressure": pressure}
    return Outcome({}, {name: Variable(("x", "y"), values, "m", name) for name, values in maps.items()})


def both_outcome(volume):
    """Two cycles, and a particle of half of what wore in them [m^3]."""
    worn = Variable(("cycle",), np.array([0.0, volume]), "m^3", "volume")
    return Outcome({}, {"volume": worn, "particle_volume": Variable(("particle",), np.array([volume / 2]), "m^3", "v")})


def oil_outcome(volume):
    """One cycle in oil and what wore in it [m^3]."""
    return Outcome({}, {"volume_over_cycles": Variable(("cycle",), np.array([volume]), "m^3", "volume")})


def loop_outcome(sq, friction=(0.1, 0.1, 0.1, 0.1)):
    """Two loops of four cycles with 100 nm at the start; the second is at rest."""
    over = {"rms_height_over_cycles": np.linspace(sq, sq, 4) * 1e-9, "friction_over_cycles": np.array(friction)}
    variables = {n: Variable(("speed", "cycle"), np.stack([v, np.full(4, v[0])]), "1", n) for n, v in over.items()}
    sizes = {"Sq_initial_nm": [100.0, 100.0], "Sq_final_nm": [sq, 100.0], "volume_mean_radius_nm": [sq, 0.0]}
    return Outcome(sizes, variables)


SMOOTH_COUNTERFACE = library()["running-in-stribeck"]
SMOOTH_COUNTERFACE = SMOOTH_COUNTERFACE | {"upper": SMOOTH_COUNTERFACE["upper"] | {"surface": {"kind": "smooth"}}}
"""Nothing rough moves, so that settling is judged in a loop of any length."""
TURN = 67
"""Cycles in which 200 rows pass at 3 a cycle, to half a slide: of scene running-in-stribeck."""


def swinging_outcome(amplitude, drift=0.0, count=200):
    """A loop whose friction swings about 0.11 with the place of the roughness; it was a turn before its last cycle."""
    cycle = np.arange(count)
    friction = 0.11 + amplitude * np.cos(2 * np.pi * cycle / TURN) - drift * cycle
    over = Variable(("cycle",), friction, "1", "friction")
    return Outcome({"friction_run_in": friction[-50:].mean()}, {"friction_over_cycles": over})


def particles_outcome(number):
    """Two loops of four cycles; the second sheds a particle in each."""
    over = Variable(("speed", "cycle"), np.array([[number] * 4, [1.0] * 4]), "1", "particles")
    return Outcome({}, {"particles_over_cycles": over, "particles_all_cycles": all_particles([4 * number, 4.0])})


def all_particles(numbers):
    """The expected number of particles of all cycles of some loops."""
    return Variable(("speed",), np.array(numbers), "1", "particles")


def least_area_outcome(area):
    """Half of the cells touch, at half the hardness each: a quarter of the area would carry that at the hardness."""
    cap = facts_of("wear-steel-steel").cases[0].cap
    pressure = np.zeros((1, 8, 8))
    pressure[0, :4] = 0.5 * cap
    return Outcome({"contact_area_fraction": [area]}, {"pressure": Variable(("load", "x", "y"), pressure, "Pa", "p")})


def film_outcome(worn):
    """A film that took some of what it grew on [nm]."""
    return Outcome({"total_wear_depth_nm": [worn]}, {})


CELL = 50.5e-9
MIRRORED = with_(
    ROUGH,
    grid={"shape": 64, "spacing": "0.8 um", "periodic": True},
    lower__surface={"kind": "measured", "path": "example/polished-pin.x3p", "mirror": "x"},
)
COATED_BALL = with_(library()["tribofilm-ball"], lower__layer={"material": "dlc", "thickness": "100 nm"})
OUTCOMES = {
    "rolling_of_large_errors": (
        "rolling-creepage",
        (Outcome({"friction_work_N": [1.0, 2.0], "friction_work_N_error": [2.2, 0.1]}, {}), "220 % of it"),
        Outcome({"friction_work_N": [1.0, 0.0], "friction_work_N_error": [0.4, 0.1]}, {}),
    ),
    "few_contact_spots": (
        ROUGH,
        (Outcome({"contact_spots": 16}, {}), "1/sqrt(spots), 12 %"),
        Outcome({"contact_spots": 30}, {}),
    ),
    "coating_taken_by_the_film": (COATED_BALL, (film_outcome(120.0), "the outermost coating, dlc"), film_outcome(80.0)),
    "highest_pressure_at_a_seam": (
        MIRRORED,
        (contact_outcome(spot(1e9, width=1)), "of one seam (along x), on 6.2 % of the area: the ridge there is the"),
        contact_outcome(spot(1e9, at=12, width=1)),
    ),
    "contact_at_free_edges": (
        "tribofilm-macro",
        (contact_outcome(spot(1e9, at=2)), "the ends of x and y, whose outermost cells carry 25 % of the load"),
        contact_outcome(spot(1e9)),
    ),
    "elastic_pressure_above_hardness": (
        BALL,
        (contact_outcome(spot(98e9)), "98 GPa, 14 times the softer hardness, and 100 % of the load"),
        contact_outcome(spot(6.9e9)),
    ),
    "pressure_beyond_linear_elasticity": (
        BALL,
        (contact_outcome(spot(40e9)), "0.35 times the contact modulus, and 100 % of the load"),
        contact_outcome(spot(10e9)),
    ),
    "contact_at_the_cap": (
        with_(BALL, contact__behaviour="capped"),
        (contact_outcome(spot(7e9)), "100 % of the cells in contact, which carry 100 % of the load, are at"),
        contact_outcome(spot(6.9e9)),
    ),
    "cap_within_the_error_of_the_pressure": (
        with_(BALL, contact__behaviour="capped"),
        (
            contact_outcome(spot(6e9), plastic_area_fraction=0.0, max_pressure_Pa=6e9, max_pressure_Pa_error=1.8e9),
            "Nothing is at the hardness here, 7 GPa",
        ),
        contact_outcome(spot(6e9), plastic_area_fraction=0.0, max_pressure_Pa=6e9, max_pressure_Pa_error=0.8e9),
    ),
    "capped_contact_nearly_full": (
        with_(BALL, contact__behaviour="capped"),
        (contact_outcome(spot(7e9), contact_area_fraction=0.7, plastic_area_fraction=0.6), "70 % of the patch"),
        contact_outcome(spot(7e9), contact_area_fraction=0.4, plastic_area_fraction=0.3),
    ),
    "largest_stress_at_the_deepest_depth": (
        BALL,
        (contact_outcome(spot(1e9), depth=[0.0, 1e-5, 2e-5], max_von_mises_depth_m=2e-5), "20 um"),
        contact_outcome(spot(1e9), depth=[0.0, 1e-5, 2e-5], max_von_mises_depth_m=1e-5),
    ),
    "elastic_stress_above_yield": (
        BALL,
        (contact_outcome(spot(6e9), yielded_volume_m3=1e-15, max_von_mises_Pa=3e9), "1e+03 um^3"),
        contact_outcome(spot(6e9), yielded_volume_m3=0.0, max_von_mises_Pa=2e9),
    ),
    "particles_of_one_cell": (
        "wear-steel-steel",
        (wear_outcome([CELL] * 3 + [4 * CELL]), "75 % of the particles, with 4.5 % of their volume"),
        wear_outcome([CELL] + [4 * CELL] * 3),
    ),
    "particles_as_large_as_the_grid": (
        "wear-steel-steel",
        (wear_outcome([CELL, 10e-6]), "10 um long on a grid of 12.1 um"),
        wear_outcome([CELL, 6e-6]),
    ),
    "nothing_comes_off": (
        "wear-steel-steel",
        (
            wear_outcome([], particles_per_cycle=[2.0, 0.0, 1.0]),
            "5 N: The wear criterion von_mises removed no particle",
        ),
        wear_outcome([CELL], particles_per_cycle=[2.0, 0.1, 1.0]),
    ),
    "worn_beyond_small_slopes": (
        "wear-cylinder-scar",
        (scar_outcome(120e-6), "worn 120 um deep at a radius of 5 mm: the scar's edge has a slope of 0.22"),
        scar_outcome(80e-6),
    ),
    "particles_and_heights_of_one_of_two": (
        library()["wear-steel-steel"] | {"wear": {"wears": "both"}},
        (both_outcome(2e-18), "particles, their sizes and numbers are those of the lower body, 50 % of the volume"),
        both_outcome(0.0),
    ),
    "steps_of_wear_in_oil_that_overshoot": (
        library()["running-in-stribeck"]
        | {"wear": {"criterion": {"kind": "archard", "specific_wear_rate": 1e-16, "distance": 1.0}}},
        (oil_outcome(1e-18), "One removes 44 times"),
        oil_outcome(0.0),
    ),
    "rougher_by_its_own_pieces": (
        "running-in-stribeck",
        (loop_outcome(480.0), "Sq went from 100 nm to 480 nm in 1 of 2 loops"),
        loop_outcome(140.0),
    ),
    "no_wear_rate_of_a_metal": (
        "wear-steel-steel",
        (Outcome({"criterion_wear_rate_mm3_Nm": [0.26, 1e-5]}, {}), "up to 0.26 mm3/(N m)"),
        Outcome({"criterion_wear_rate_mm3_Nm": [5e-4, 1e-5]}, {}),
    ),
    "drifting_at_the_last_cycle": (
        SMOOTH_COUNTERFACE,
        (loop_outcome(100.0, (0.13, 0.12, 0.11, 0.1)), "friction by 16 % in 1 of 2 loops"),
        loop_outcome(100.0),
    ),
    "friction_that_swings_with_the_place": (
        "running-in-stribeck",
        (
            swinging_outcome(0.002),
            "0.11 over the first repeat of the roughness patch, 67 cycles, and 0.11 over the last;",
        ),
        swinging_outcome(0.0002),
    ),
    "wear_outside_the_contact_region": (
        "running-in-stribeck",
        (
            Outcome({"volume_outside_region": [0.05, 0.2]}, {}),
            "20 % of the worn volume lies outside it in 1 of 2 loops. The region is",
        ),
        Outcome({"volume_outside_region": [0.05, 0.09]}, {}),
    ),
    "running_in_within_its_error": (
        "running-in-stribeck",
        (
            Outcome({"friction_initial": [0.11], "friction_run_in": [0.109], "friction_run_in_error": [0.002]}, {}),
            "from 0.11 to 0.109, is less than its error of 0.002",
        ),
        Outcome({"friction_initial": [0.11], "friction_run_in": [0.1], "friction_run_in_error": [0.002]}, {}),
    ),
    "less_than_one_particle": (
        "running-in-stribeck",
        (particles_outcome(0.2), "an expected number, worn volume over mean volume of a particle, and no count"),
        particles_outcome(0.25),
    ),
    "least_area_of_worn_surfaces": (
        "wear-steel-steel",
        (
            least_area_outcome(0.25),
            "in the last cycle lies between 25 % of the grid (load over the hardness) and 50 %",
        ),
        least_area_outcome(0.4),
    ),
    "long_steps_of_wear_by_pressure": (
        "wear-cylinder-scar",
        (
            Outcome({"step_error_nm": [20.0], "largest_worn_depth_nm": [100.0], "worn_depth_nm": [60.0]}, {}),
            "The deepest place, worn 100 nm deep, is uncertain by about 20 %",
        ),
        # of rough summits: 41 cycles and 82 of half the distance left mean depths of 0.2806 and 0.2793 nm
        Outcome({"step_error_nm": [0.051], "largest_worn_depth_nm": [29.2], "worn_depth_nm": [0.2806]}, {}),
    ),
    "law_without_particles": (
        library()["wear-steel-steel"]
        | {"wear": {"criterion": {"kind": "archard", "specific_wear_rate": 1e-16, "distance": 1.0}}},
        (
            both_outcome(2e-18),
            'set wear.particle_criterion = { kind = "averaged_von_mises", averaging_length = "300 nm" }',
        ),
        both_outcome(0.0),
    ),
    "loop_without_error_bars": (
        "running-in-stribeck",
        (Outcome({"Sq_final_nm": [90.0]}, {}), "A single loop has none"),
        Outcome({"Sq_final_nm": [90.0], "Sq_final_nm_error": [None]}, {}),
    ),
    "particles_cut_by_the_depths": (
        "wear-steel-steel",
        (wear_outcome([CELL], truncated_particles=30, particles_per_cycle=10.0), "6 % of the settled particles"),
        wear_outcome([CELL], truncated_particles=5, particles_per_cycle=10.0),
    ),
}


@pytest.mark.internal
def test_a_contact_most_of_whose_load_its_bodies_could_not_bear_is_outside_the_model():
    """It was called converged, with 98 % of the load above the hardness and pressures as high as the modulus."""
    facts = facts_of(BALL)
    for name, high in (("elastic_pressure_above_hardness", 9e9), ("pressure_beyond_linear_elasticity", 40e9)):
        for width, beyond in ((2, False), (8, True)):
            summits = spot(1e9, width=8)
            summits[8 : 8 + width, 8 : 8 + width] = high
            (told,) = OUTCOME_CHECKS[name](facts, contact_outcome(summits))
            share = summits[summits > 1e9].sum() / summits.sum()
            assert bool(share > 0.5) is beyond
            assert told.startswith(OUTSIDE) is beyond
    (told,) = OUTCOME_CHECKS["elastic_pressure_above_hardness"](facts_of("fretting-ball"), contact_outcome(spot(98e9)))
    assert told.startswith(OUTSIDE)
    assert told.endswith("take a smaller load.")


@pytest.mark.internal
def test_particles_of_running_in_that_the_depths_cut_are_told():
    facts = facts_of("running-in-stribeck")
    cut = Outcome({"truncated_particles": [0, 40], "particles_per_cycle": [1.0, 10.0]}, {})
    share = 40 / (10.0 * facts.scene.cycles.settled)
    (words,) = OUTCOME_CHECKS["particles_cut_by_the_depths"](facts, cut)
    assert words.values["share"] == pytest.approx(share)


@pytest.mark.internal
def test_particles_that_end_at_an_interface_need_no_deeper_depths():
    """All pieces of a layer of 1 um reached its interface, and 10 um of depths were told to be too few."""
    cut = Outcome({"truncated_particles": [40], "particles_per_cycle": [2.0]}, {})
    for name, coated in (("wear-brass-transfer-film", True), ("wear-steel-brass", False)):
        (words,) = OUTCOME_CHECKS["particles_cut_by_the_depths"](facts_of(name), cut)
        assert ("wear.within_layer" in words) is coated


@pytest.mark.internal
def test_a_swing_with_the_place_of_the_roughness_is_no_drift():
    """Means of 25 cycles are those of other places on the track; over whole turns only a drift remains."""
    facts, check = facts_of("running-in-stribeck"), OUTCOME_CHECKS["drifting_at_the_last_cycle"]
    swing = swinging_outcome(0.01)
    assert drift(swing.variables["friction_over_cycles"].values) is not None
    assert list(check(facts, swing)) == []
    (told,) = check(facts, swinging_outcome(0.01, drift=1e-4))
    assert "(67, whole repeats of the roughness patch)" in told


@pytest.mark.internal
def test_a_loop_that_wore_nothing_is_not_unsettled():
    """Friction alone then moves with the place; particles of one cycle are wear."""
    facts, check = facts_of(SMOOTH_COUNTERFACE), OUTCOME_CHECKS["drifting_at_the_last_cycle"]
    moved = loop_outcome(100.0, (0.13, 0.12, 0.11, 0.1))
    for number, told in ((0.0, False), (1.0, True)):
        counts = Variable(("speed", "cycle"), np.array([[0.0, 0.0, 0.0, number], [0.0] * 4]), "1", "particles")
        series = {**moved.variables, "particles_over_cycles": counts}
        assert bool(list(check(facts, Outcome(moved.summary, series)))) == told


@pytest.mark.internal
@pytest.mark.parametrize(
    ("stress", "words"),
    [(0.3e9, "particle: 300 MPa of the 386 MPa that it takes"), (9e9, "the 386 MPa that it takes are exceeded below")],
)
def test_a_criterion_that_removed_nothing_says_stress_and_strength(stress, words):
    facts, check = facts_of("running-in-stribeck"), OUTCOME_CHECKS["nothing_comes_off"]
    count = len(facts.cases)
    summary = {"particles_per_cycle": [0.0] * count, "largest_stress_Pa": [stress] * count}
    assert words in " ".join(note.line for note in check(facts, Outcome(summary, {})))


@pytest.mark.internal
@pytest.mark.parametrize("count", [20, 100])
def test_a_loop_shorter_than_two_turns_says_so_once_and_only_where_rough_bodies_move(count):
    """It was called not settled, by means of other places, and 82 cycles were asked for beside 7000."""
    names, short = (
        ("drifting_at_the_last_cycle", "friction_that_swings_with_the_place"),
        swinging_outcome(0.02, 0, count),
    )
    notes = [note for name in names for note in OUTCOME_CHECKS[name](facts_of("running-in-stribeck"), short)]
    assert [note.code for note in notes] == ["settling-unjudged"]
    assert f"again every 67 cycles, one repeat of its patch, and the run has {count}:" in notes[0]
    assert (
        "Set cycles.count = 134 (two repeats of the roughness patch) or more, and cycles.averaged = 67 (one repeat)."
        in notes[0]
    )
    smooth = facts_of(SMOOTH_COUNTERFACE)
    assert all(note.code == "not-settled" for name in names for note in OUTCOME_CHECKS[name](smooth, short))
    quiet = swinging_outcome(0.0002, 0, count)
    assert not any(list(OUTCOME_CHECKS[name](facts_of("running-in-stribeck"), quiet)) for name in names)


@pytest.mark.internal
def test_a_plan_shows_no_depths_where_no_stress_is_computed():
    """ "depths 50 down to 19.1 um" stood beside stresses that a wear law skips."""
    law = {"criterion": {"kind": "archard", "specific_wear_rate": 1e-16, "distance": 1.0}}
    sized = law | {"particle_criterion": "averaged_von_mises"}
    for wear, shown in (({}, True), (sized, True), (law, False)):
        rows = common(facts_of(library()["running-in-stribeck"] | {"wear": wear}))
        assert ("depths" in dict(rows)) is shown


@pytest.mark.internal
def test_a_swing_is_not_told_where_whole_turns_are_averaged():
    """The caution asked for cycles.averaged = 41, and stayed when that was given."""
    check, swing = OUTCOME_CHECKS["friction_that_swings_with_the_place"], swinging_outcome(0.01, drift=1e-4)
    for averaged, told in ((50, 1), (67, 0), (134, 0)):
        assert len(list(check(facts_of("running-in-stribeck", f"cycles.averaged={averaged}"), swing))) == told


@pytest.mark.internal
def test_a_swing_within_the_error_bars_is_not_told():
    facts, check = facts_of("running-in-stribeck"), OUTCOME_CHECKS["friction_that_swings_with_the_place"]
    found = swinging_outcome(0.002)
    for error, told in ((0.0001, 1), (0.003, 0)):
        errors = {"friction_initial_error": error, "friction_run_in_error": error}
        assert len(list(check(facts, Outcome(found.summary | errors, found.variables)))) == told


@pytest.mark.internal
def test_cycles_for_a_count_of_particles_follow_the_rate_in_the_table():
    """The particles of all cycles fall off after the first; the rate of the last ones is what the table has."""
    over = Variable(("cycle",), np.array([0.3, 0.1, 0.1, 0.1]), "1", "particles")
    total = all_particles([0.6])
    outcome = Outcome({"particles_per_cycle": [0.1]}, {"particles_over_cycles": over, "particles_all_cycles": total})
    check = OUTCOME_CHECKS["less_than_one_particle"]
    (told,) = check(facts_of("running-in-stribeck", "cycles.count=4", "cycles.settled=2", "cycles.averaged=2"), outcome)
    # 43 000 cycles were advised without a word that they take nine hours
    assert re.search(r"count of 20 would take about 200 cycles, about [\d.]+ (s|min|h), at the rate", told)
    assert told.endswith("of the last 2 cycles, 0.1 a cycle.")


@pytest.mark.internal
def test_cycles_for_a_count_of_particles_are_those_of_all_where_the_last_ones_know_no_size():
    over = Variable(("cycle",), np.array([0.3, 0.3, np.nan, np.nan]), "1", "particles")
    outcome = Outcome({}, {"particles_over_cycles": over, "particles_all_cycles": all_particles([0.8])})
    check = OUTCOME_CHECKS["less_than_one_particle"]
    (told,) = check(facts_of("running-in-stribeck", "cycles.count=4", "cycles.settled=2", "cycles.averaged=2"), outcome)
    assert "shed 0.8 particles" in told
    assert told.endswith("at the rate of all cycles, 0.2 a cycle.")


@pytest.mark.internal
def test_cycles_for_a_count_of_particles_have_a_time_where_there_are_several_loads():
    """The plan of one case refused a scene of several, and the note was lost."""
    over = Variable(("load", "cycle"), np.full((2, 4), 0.1), "1", "particles")
    variables = {"particles": over, "particles_all_cycles": all_particles([0.4, 0.4])}
    check, settings = OUTCOME_CHECKS["less_than_one_particle"], ("cycles.count=4", "cycles.settled=2", *WORN)
    seconds = []
    for loads in ('["5 N"]', '["5 N", "5 N"]'):
        facts = facts_of("wear-steel-steel", f"cylinder.loads={loads}", *settings)
        (told,) = check(facts, Outcome({}, variables))
        (time,) = re.findall(r"200 cycles, about (.*?), at the rate", told)
        seconds.append(time)
    assert seconds[0] != seconds[1]


@pytest.mark.internal
def test_values_that_differ_between_loops_are_told_as_those_of_the_worst():
    """ "Friction by 20 % in 2 of 2 loops" was said of 20.2 and 7.0 %."""
    facts, smooth = facts_of("running-in-stribeck"), facts_of(SMOOTH_COUNTERFACE)

    def said(name, summary, variables=None, of=facts):
        return str(next(iter(OUTCOME_CHECKS[name](of, Outcome(summary, variables or {})))))

    outside = "wear_outside_the_contact_region"
    assert "Up to 20 % of the worn volume lies outside it in 2 of 2" in said(
        outside, {"volume_outside_region": [0.17, 0.2]}
    )
    assert "Up to" not in said(outside, {"volume_outside_region": [0.2, 0.2]})
    change = {"friction_initial": [0.11] * 2, "friction_run_in": [0.109] * 2, "friction_run_in_error": [0.002] * 2}
    assert "its error of 0.002 in 2 of 2 loops." in said("running_in_within_its_error", change)
    change["friction_run_in_error"] = [0.002, 0.004]
    assert "0.004 in 2 of 2 loops (numbers of one of them)." in said("running_in_within_its_error", change)
    for second, words in (((0.13, 0.12, 0.11, 0.1), "friction by 16 % in"), ((0.13, 0.13, 0.12, 0.12), "by up to 16")):
        values = np.array([(0.13, 0.12, 0.11, 0.1), second])
        series = {"friction_over_cycles": Variable(("speed", "cycle"), values, "1", "friction")}
        assert words in said("drifting_at_the_last_cycle", {}, series, smooth)
    series = particles_outcome(0.2).variables | {"particles_all_cycles": all_particles([0.8, 0.4])}
    assert "shed up to 0.8 particles of one body in 2 of 2 loops" in said("less_than_one_particle", {}, series)


@pytest.mark.internal
def test_the_length_of_a_particle_criterion_is_told_by_its_key():
    """The note named wear.criterion averaged_von_mises where wear.criterion was archard."""
    for changes, key in ((WORN, "particle_criterion"), ((), "criterion")):
        law = f'wear.{key}={{kind="averaged_von_mises", averaging_length="100 nm"}}'
        told = next(
            iter(SCENE_CHECKS["few_cells_per_length_of_the_criterion"](facts_of("wear-steel-steel", *changes, law)))
        )
        assert f"The length of wear.{key} averaged_von_mises, 100 nm, is" in told


@pytest.mark.internal
def test_roughness_does_not_drift_where_nothing_came_off():
    """The strip in contact moves, and its roughness with it."""
    worn = loop_outcome(100.0)
    rough = Variable(("speed", "cycle"), np.array([[1.0, 1.1, 1.4, 1.5], [1.0, 1.0, 1.0, 1.0]]) * 1e-7, "m", "Sq")
    facts, check = facts_of(SMOOTH_COUNTERFACE), OUTCOME_CHECKS["drifting_at_the_last_cycle"]
    for volume, told in ((0.0, False), (1e-18, True)):
        volumes = Variable(("speed", "cycle"), np.array([[0.0, 0.0, 0.0, volume], [0.0] * 4]), "m^3", "volume")
        series = {**worn.variables, "rms_height_over_cycles": rough, "volume_over_cycles": volumes}
        words = list(check(facts, Outcome(worn.summary, series)))
        assert [("Sq of the worn surface" in word, "in 1 of 2 loops" in word) for word in words] == [
            (True, True)
        ] * told


@pytest.mark.internal
@pytest.mark.parametrize("name", OUTCOMES)
def test_a_check_of_results_fires_where_it_should_and_not_next_to_it(name):
    scene, (bad, words), good = OUTCOMES[name]
    facts = facts_of(scene)
    assert words in " ".join(OUTCOME_CHECKS[name](facts, bad))
    assert list(OUTCOME_CHECKS[name](facts, good)) == []


@pytest.mark.internal
@pytest.mark.parametrize(("length", "told"), [(8e-6, 0), (15e-6, 1)])
def test_a_particle_is_held_against_the_grid_of_its_own_load(length, told):
    """A piece of the largest load was held against the grid of the smallest: 119 um long on one of 23.9 um."""
    facts = facts_of("wear-steel-steel")
    sides = [case.grid.lengths[0] for case in facts.cases]
    outcome = wear_outcome([CELL, length])
    outcome.variables["cell"] = Variable(("load",), np.array(sides) / 240, "m", "cell")
    outcome.variables["particle_case"] = Variable(("particle",), np.array([0, len(sides) - 1]), "1", "case")
    found = list(OUTCOME_CHECKS["particles_as_large_as_the_grid"](facts, outcome))
    assert len(found) == told
    assert all(f"15 um long on a grid of {si(sides[-1], 'm')}" in text for text in found)


@pytest.mark.internal
@pytest.mark.parametrize(("length", "width", "told"), [(4, 1, 1), (4, 2, 0), (8, 1, 0)])
def test_particles_of_one_cell_are_known_where_cells_are_longer_than_wide(length, width, told):
    """Cells of 4 x 1 were held against 1.5 times the root of their area: 56 % of particles were one, none was told."""
    facts = facts_of("wear-steel-steel", "domain.half_widths=", "domain.cells=[64,256]", "domain.lengths=12.8 um")
    outcome = wear_outcome([length * 50e-9] * 3)
    outcome.variables["cell"] = Variable(("load",), np.full(3, 100e-9), "m", "cell")
    outcome.variables["particle_width"] = Variable(("particle",), np.full(3, width * 50e-9), "m", "width")
    found = list(OUTCOME_CHECKS["particles_of_one_cell"](facts, outcome))
    assert len(found) == told
    assert all("one cell wide (200 nm x 50 nm)" in text for text in found)


@pytest.mark.internal
def test_running_in_tells_of_particles_of_one_cell_by_their_mean():
    facts, check = facts_of("running-in-stribeck"), OUTCOME_CHECKS["particles_of_one_cell"]
    found = list(check(facts, Outcome({"number_mean_radius_nm": [300.0, 500.0, 0.0]}, {})))
    assert "450 nm in 1 of 3 runs" in " ".join(found)
    assert list(check(facts, Outcome({"number_mean_radius_nm": [400.0]}, {}))) == []


WORN = ('wear.criterion={kind="archard", specific_wear_rate=1e-16, distance=0.1}', "wear.particle_criterion=von_mises")
"""Settings of wear by a rate, which changes the surfaces without particles."""


@pytest.mark.internal
@pytest.mark.parametrize(
    ("changes", "summary", "words", "action"),
    [
        (("speeds.slide_roll_ratio=0",), {}, "roll without sliding", "Set speeds.slide_roll_ratio"),
        (("speeds.slide_roll_ratio=0.5",), {"friction_first_turn": [0.05]}, "repeats the one before", "Raise load or"),
        (("speeds.slide_roll_ratio=0.5",), {}, "", "cycles.count"),
        ((*WORN, "speeds.slide_roll_ratio=0.5"), {"friction_first_turn": [0.05]}, "", "cycles.count"),
    ],
)
def test_more_cycles_are_advised_only_where_they_may_change_something(changes, summary, words, action):
    """In pure rolling and after a whole turn without wear every cycle is like those before."""
    facts = facts_of("running-in-ball", *changes)
    nothing = Outcome({"particles_per_cycle": [0.0] * len(facts.cases), **summary}, {})
    (told, *_) = OUTCOME_CHECKS["nothing_comes_off"](facts, nothing)
    assert words in told
    assert action in told
    assert ("cycles.count" in told) == (action == "cycles.count")
    foreseen = list(SCENE_CHECKS["surfaces_only_roll"](facts))
    assert len(foreseen) == (changes == ("speeds.slide_roll_ratio=0",))


@pytest.mark.internal
@pytest.mark.parametrize(("criterion", "words"), [("junction", "must be 426 nm wide"), ("low_cycle_fatigue", "passes")])
def test_nothing_comes_off_and_why(criterion, words):
    facts = facts_of("wear-steel-steel", f"wear.criterion={criterion}")
    none = wear_outcome([], particles_per_cycle=[0.0] * 3)
    assert words in " ".join(OUTCOME_CHECKS["nothing_comes_off"](facts, none))


@pytest.mark.internal
def test_the_variant_of_which_nothing_comes_off_is_named():
    facts, check = facts_of("wear-criteria"), OUTCOME_CHECKS["nothing_comes_off"]
    (told,) = check(facts, wear_outcome([CELL], particles_per_cycle=[3.0, 2.0, 0.0, 1.0, 1.0]))
    assert "A junction must be 426 nm wide" in told

    said = " ".join(check(facts, Outcome({"particles_per_cycle": [0.0] * len(facts.cases)}, {})))
    assert "removed no particle" in said


def test_a_law_that_finds_no_particles_beside_a_worn_volume_is_named_by_its_key():
    """The note read as if nothing had worn, beside a wear volume by Archard's law."""
    archard = 'wear.criterion={ kind = "archard", specific_wear_rate = "1e-7 mm^3/(N*m)", distance = "1 mm" }'
    facts = facts_of("wear-steel-steel", archard, "wear.particle_criterion=averaged_von_mises")
    told = next(OUTCOME_CHECKS["nothing_comes_off"](facts, wear_outcome([], particles_per_cycle=[0.0] * 3)))
    assert "wear.particle_criterion averaged_von_mises found no particle" in told
    assert "worn volume holds" in told.line
    assert "wear.criterion, archard" in told
    # a number that is not known, of loops that were solved
    for cut, found in (([0] * 3, 3), ([None] * 3, 0)):
        none = wear_outcome([], particles_per_cycle=[None] * 3, truncated_particles=cut)
        assert len(list(OUTCOME_CHECKS["nothing_comes_off"](facts, none))) == found


def test_running_in_tells_too_where_nothing_comes_off():
    facts, check = facts_of("running-in-stribeck"), OUTCOME_CHECKS["nothing_comes_off"]
    assert "removed no particle" in " ".join(
        check(facts, Outcome({"particles_per_cycle": [0.0] * len(facts.cases)}, {}))
    )


@pytest.mark.internal
@pytest.mark.parametrize(
    ("criterion", "stress", "words"),
    [
        ("von_mises", 1e8, "in the last cycle is 100 MPa, and"),
        ("maximum_tension", 1e8, "friction f adds 2 f of it behind a line contact"),
        ("von_mises", 9e9, "nothing that exceeds the yield stress reaches the surface"),
    ],
)
def test_nothing_comes_off_and_how_far_from_it_the_stress_is(criterion, stress, words):
    facts = facts_of("wear-steel-steel", f"wear.criterion={criterion}")
    none = wear_outcome([], particles_per_cycle=[0.0] * 3, largest_stress_Pa=[stress] * 3)
    told = list(OUTCOME_CHECKS["nothing_comes_off"](facts, none))
    assert len(told) == 3
    assert all(words in text for text in told)


@pytest.mark.internal
def test_smooth_bodies_far_below_the_hardness_have_no_valleys_that_resist():
    """62 % of a slice touched at a sixth of the hardness, and was told of its cap."""
    facts, check = facts_of("wear-steel-steel"), OUTCOME_CHECKS["capped_contact_nearly_full"]
    for area, told in ((0.0, 0), (1e-12, 1)):
        plastic = Variable(("cycle",), np.array([0.0, area]), "m^2", "area at the hardness")
        assert len(list(check(facts, Outcome({"contact_area_fraction": 0.7}, {"plastic_area": plastic})))) == told


@pytest.mark.internal
def test_a_surface_full_of_holes_is_one_story_that_goes_first():
    """Five notes were said of it one by one: it still drifts, and is at its hardness, because it is full of holes."""
    facts = facts_of(SMOOTH_COUNTERFACE)
    cap = facts.cases[0].cap
    plane = np.full((1, 4, 4), cap)
    plane[:, [0, -1]] = 0  # a contact that ends before the grid does
    pressure = Variable(("speed", "x", "y"), plane, "Pa", "p")
    for sq, stories in ((480.0, 1), (140.0, 2)):
        found = loop_outcome(sq, (0.13, 0.12, 0.11, 0.1))
        notes = outcome_warnings(facts, Outcome(found.summary, {**found.variables, "pressure": pressure}))
        codes = ("hardness-decides", "not-settled", "surface-roughened")
        about = [note for note in notes if note.code in codes]
        assert len(about) == stories
        assert len(outside(notes)) == (1 if sq > 200 else 0)
        assert all("friction by 16 %" in about[0] for _ in outside(notes))
    assert outside(["10 N: " + OUTSIDE + "too thin; details", "plain"]) == ("10 N: too thin",)
    assert outside(["10 N; 20 N: " + OUTSIDE + "too thin; details"]) == ("10 N; 20 N: too thin",)


@pytest.mark.internal
def test_every_check_has_its_two_tests():
    assert set(SCENE_CHECKS) == set(CASES) | set(MAPS)
    assert set(OUTCOME_CHECKS) == set(OUTCOMES)


@pytest.mark.internal
def test_a_map_smaller_than_the_grid_is_refused_by_the_plan(maps):
    with pytest.raises(InputError) as refused:
        scene_warnings(facts_of(on_map(maps / "whole.npz", "1 mm")))
    (message,) = refused.value.messages
    assert "the grid is 1 mm long along x, the mirrored map only 128 um; " in message
    assert message.endswith("use 128 um or less along x and 128 um or less along y")


@pytest.mark.internal
def test_one_warning_is_said_once_and_a_check_that_fails_says_so(monkeypatch):
    def broken(facts):
        raise ZeroDivisionError("nothing to divide by")
        yield

    monkeypatch.setitem(SCENE_CHECKS, "broken", broken)
    found = scene_warnings(facts_of(BALL))
    (note,) = found
    assert note.values == {"task": "The check broken", "error": "ZeroDivisionError('nothing to divide by')"}


@pytest.mark.internal
@pytest.mark.parametrize(
    ("pressure", "check"), [(98e9, "elastic_pressure_above_hardness"), (40e9, "pressure_beyond_linear_elasticity")]
)
def test_the_highest_pressure_of_a_note_is_that_of_the_table(pressure, check):
    """Notes gave 15.5 GPa, on the cells, beside 16.39 GPa in the table, which is between cells."""
    outcome = contact_outcome(spot(pressure), max_pressure_Pa=1.1 * pressure)
    (note,) = OUTCOME_CHECKS[check](facts_of(BALL), outcome)
    assert note.values["pressure"] == pytest.approx(1.1 * pressure)


@pytest.mark.internal
def test_strains_of_an_adhesive_contact_are_those_of_pressure_less_attraction():
    """A soft ball was called outside the model for pressures of 0.22 E*, most of which attraction cancels."""
    facts, outcome = facts_of(BALL), contact_outcome(spot(40e9))
    for attraction, share in ((spot(32e9), None), (spot(5e9), 1.0), (spot(120e9), 1.0)):
        pulled = Variable(("x", "y"), attraction, "Pa", "attraction")
        adhesive = replace(outcome, variables={**outcome.variables, "attraction": pulled})
        found = list(OUTCOME_CHECKS["pressure_beyond_linear_elasticity"](facts, adhesive))
        assert bool(found) is (share is not None)
        for note in found:
            assert note.values["pressure"] == abs(40e9 - attraction.max())
            assert note.values["share"] == pytest.approx(share)
            assert "less attraction" in note.line


@pytest.mark.internal
def test_cells_across_an_adhesive_contact_count_its_adhesion():
    """Hertz' contact of a soft ball under 20 uN had 5.7 cells, where the contact is 21 cells wide."""
    gel = {"material": {"youngs_modulus": "2 MPa", "poissons_ratio": 0.49}}
    adhesion = {"work": "50 mJ/m^2", "range": "1 um"}
    soft = with_(BALL, lower=gel, upper=None, shape__radius="1 mm", contact={"load": "20 uN", "adhesion": adhesion})
    across = "few_cells_across_the_contact"
    assert fired(across, with_(soft, contact__adhesion=None, grid__shape=64)) != []
    assert fired(across, with_(soft, grid__shape=64)) == []
    (told,) = fired(across, with_(soft, grid__shape=32))
    hertz = facts_of(with_(soft, contact__adhesion=None)).cases[0].smooth.semi_axes[0]
    larger = (1 + 2 * np.pi * 0.05 * 1e-3 / 20e-6) ** (1 / 3)
    assert told.values["across"] == pytest.approx(2 * hertz * larger / 12.5e-6)
    assert fired(across, with_(soft, contact__adhesion=adhesion | {"range": "100 nm"}, grid__shape=32)) == []


@pytest.mark.internal
def test_rolling_whose_force_is_small_by_spin_is_not_told_that_it_sticks():
    check, facts = OUTCOME_CHECKS["rolling_of_large_errors"], facts_of("rolling-creepage")
    figures = {"traction_coefficient": 0.09, "traction_coefficient_error": 0.5}
    (slips,) = check(facts, Outcome({**figures, "stick_fraction": 0.003}, {}))
    assert "spin makes nearly everything slip" in slips
    (sticks,) = check(facts, Outcome({**figures, "stick_fraction": 0.9}, {}))
    assert "sticks little slips" in sticks


def test_shares_at_the_hardness_are_those_of_the_areas_of_the_table():
    """The remark counted cells, 64 % with 79 % of the load; the table's areas are 85 %, with 92 % of it."""
    facts = facts_of(with_(BALL, contact__behaviour="capped"))
    cap, plane = facts.cases[0].cap, np.zeros((8, 8))
    plane[:4, :4], plane[4, :4] = cap, 0.5 * cap
    outcome = contact_outcome(plane)
    area, load = 17 / 64, float(plane.mean()) / cap
    figures = {"contact_area_fraction": area, "plastic_area_fraction": 0.9 * load}
    (note,) = [
        note
        for note in outcome_warnings(facts, replace(outcome, summary={**outcome.summary, **figures}))
        if note.code == "hardness-decides"
    ]
    assert note.values["area"] == pytest.approx(0.9 * load / area)
    assert note.values["load"] == pytest.approx(0.9)
    assert "95 % of the contact area, which carries 90 % of the load, is at the hardness" in note
    assert "these are 80 % with 89 % of the load" in note


def test_a_run_notes_what_was_warned_of_before_and_after(tmp_path):
    class Listener:
        def __init__(self):
            self.notes = []

        def progress(self, *_):
            pass

        def note(self, text):
            self.notes.append(text)

    watcher = Listener()
    run = run_scene(with_(BALL, grid__lengths="100 um"), tmp_path / "out", watcher=watcher)
    assert run.summary["contact_area_fraction"] == 1
    before, *others = watcher.notes
    assert "for a Hertz contact of 216 um" in before
    assert sorted(note["text"] for note in run.summary["notes"]) == sorted(others), "what was foreseen is confirmed"
    (note,) = [note for note in run.summary["notes"] if note["code"] == "contact-at-edge"]
    assert note["level"] == "outside_model"
    assert note["text"].endswith("Set grid.lengths to 323 um or more."), "what was foreseen knows the length"
    assert run.summary["outside_model"]
    assert "contact reaches a free edge of the grid" in (tmp_path / "out" / "report.html").read_text()


@pytest.mark.internal
@pytest.mark.parametrize("thickness", [0.5e-3, 5e-3])
def test_a_line_contact_on_a_layer_of_the_substrate_is_that_of_hertz(thickness):
    """Within the 0.3 % of the bore that it is solved in; none of a rigid body, two layers, a ball and a thin layer."""
    steel, soft = CATALOGUE["steel-52100"].material, CATALOGUE["peek"].material
    body = Body(steel)
    line = smooth_contact(body, body, (0.02, math.inf), load=1e5)
    found = line_contact_on_layer(Body(steel, layer=Layer(steel, thickness)), body, line)
    assert found == pytest.approx((line.semi_axes[0], line.maximum_pressure), rel=5e-3, abs=0)
    layered = Body(steel, layer=Layer(soft, thickness))
    half_width, highest = line_contact_on_layer(body, layered, line)
    assert half_width > 1.5 * line.semi_axes[0]
    assert highest < 0.5 * line.maximum_pressure
    assert line_contact_on_layer(layered, None, line) is None
    assert line_contact_on_layer(layered, layered, line) is None
    assert line_contact_on_layer(layered, body, smooth_contact(body, body, (0.02, 0.02), load=1e3)) is None
    assert line_contact_on_layer(Body(steel, layer=Layer(soft, 1e-6)), body, line) is None


RADII = [[], ["contact.ball=", 'contact.radii=["10 mm", "9 mm"]']]


@pytest.mark.internal
def test_the_overview_shows_what_is_pressed_together():
    facts = facts_of(with_(BALL, lower__layer={"material": "dlc", "thickness": "20 um"}))
    shown = dict(common(facts))
    assert shown["cells"] == "32 x 32"
    assert shown["edges"] == "free"
    assert shown["Hertz radius without layers"] == "108 um"
    assert shown["Hertz pressure without layers"] == "781 MPa"
    assert "20 um of dlc" in dict(bodies(facts))["lower"]
    assert differing(facts) == ([], [])
    oiled = [dict(bodies(facts_of("stribeck-ball-on-disc", *change)))["upper shape"] for change in RADII]
    assert [shape.split(",")[0] for shape in oiled] == ["sphere", "ellipsoid"]
    names, rows = differing(facts_of("wear-steel-steel"))
    assert names[0] == "case"
    assert [row[0] for row in rows] == ["2.5 N", "5 N", "10 N"]


@pytest.mark.internal
def test_numbers_in_words():
    assert si(45e-9, "m") == "45 nm"
    assert si(0.9996e-6, "m") == "1 um"
    assert si(1.2e9, "Pa") == "1.2 GPa"
    assert si(3.2e-13, "m") == "3.2e-13 m"
    assert si(0.0, "N") == "0 N"
    assert times((1e-6, 1e-6), "m") == "1 um"
    assert times((1e-6, 2e-6), "m") == "1 um x 2 um"
    assert percent(0.004) == "0.4 %"
    assert percent(0.9999) == "100 %"


@pytest.mark.internal
@pytest.mark.parametrize("kind", ["wear-steel-steel", "running-in-stribeck"])
def test_both_kinds_of_wear_loops_tell_of_a_surface_of_twice_its_roughness(kind):
    """Sq of a strip grew from 36 to 74 nm on a counterface of 50 nm; it was compared with all of both surfaces."""
    facts = facts_of(kind)
    for after, told in ((74.0, 1), (60.0, 0)):
        outcome = Outcome({"Sq_initial_nm": [36.0], "Sq_final_nm": [after]}, {})
        notes = [note for note in outcome_warnings(facts, outcome) if "grew rough" in note]
        assert len(notes) == told == len(outside(notes))


@pytest.mark.internal
def test_a_scar_worn_by_pressure_is_meant_to_grow():
    facts = facts_of("wear-cylinder-scar")
    grown = Outcome(
        {"Sq_initial_nm": [1.0], "Sq_final_nm": [90.0]},
        {"rms_height": Variable(("cycle",), np.linspace(1e-9, 9e-8, 20), "m", "Sq")},
    )
    for name in ("rougher_by_its_own_pieces", "drifting_at_the_last_cycle"):
        assert list(OUTCOME_CHECKS[name](facts, grown)) == []


@pytest.mark.internal
@pytest.mark.parametrize(
    "waves",
    [
        {"hurst": 0.8, "rolloff_wavelength": 25e-6, "cutoff_wavelength": 2e-6},
        {"hurst": 0.5, "rolloff_wavelength": 10e-6, "cutoff_wavelength": 0.5e-6},
        {"hurst": 1.0, "cutoff_wavelength": 1e-6},
    ],
)
def test_what_a_plan_says_of_a_self_affine_surface_is_that_of_all_of_it(monkeypatch, waves):
    """A part of it at the height of the whole was 2.5 times as steep on 8192 cells, and beyond 16384 had no wave."""
    table = GeneratedSurface(kind="generated", rms_height=2e-7, **waves)
    grid = Grid((1024, 1024), (1e-7, 1e-7), periodic=(True, True))
    said = surfaces_of.rough_surface("lower", table, grid, 1)
    monkeypatch.setattr(surfaces_of, "_CELLS", grid.cells)
    drawn = surfaces_of.rough_surface("lower", table, grid, 1)
    assert said.rms_height == pytest.approx(drawn.rms_height, rel=1e-9)
    # differences between cells miss of waves of five cells (pi / 5)^2 / 6 of their slope, the lattice ends elsewhere
    assert said.rms_slope == pytest.approx(drawn.rms_slope, rel=0.03)
    assert said.correlation_length == pytest.approx(drawn.correlation_length, rel=1e-3)
    vast = Grid((65536, 65536), (1e-7 / 64, 1e-7 / 64), periodic=(True, True))
    assert surfaces_of.rough_surface("lower", table, vast, 1).rms_slope == pytest.approx(said.rms_slope, rel=1e-9)


@pytest.mark.internal
def test_a_scar_as_wide_as_its_body_is_outside_the_model():
    """Deeper than the radius it said `converged`, with a note on the grid's edge; the width counts where depths do not
    say it."""
    facts = scar_facts()
    for outcome, slope, beyond in (
        (scar_outcome(6e-3), "1.5", True),
        (scar_outcome(626e-6), "0.5", True),
        (scar_outcome(620e-6), "0.5", False),
    ):
        (text,) = [
            note
            for note in outcome_warnings(facts, outcome)
            if (note.code, note.values.get("reason")) == ("slopes-large", "worn")
        ]
        assert f"slope of {slope}," in text
        assert text.startswith(OUTSIDE) == beyond
    facts = scar_facts("cylinder.radius=1 mm")
    (text,) = [
        note
        for note in outcome_warnings(facts, scar_outcome(5e-6, half_width=250e-6))
        if (note.code, note.values.get("reason")) == ("slopes-large", "worn")
    ]
    assert "slope of 0.25," in text
    assert not [
        note
        for note in outcome_warnings(facts, scar_outcome(0.0, half_width=250e-6))
        if (note.code, note.values.get("reason")) == ("slopes-large", "worn")
    ]


def scar_facts(*settings):
    return examine(plan_scene("wear-cylinder-scar", settings)[0])


def test_a_cylinder_worn_through_says_so_in_its_run(tmp_path):
    settings = ["cycles.count=20", 'wear.criterion.distance="10 km"', "cycles.settled=5"]
    run = run_scene("wear-cylinder-scar", tmp_path / "run", settings=settings, figures=False)
    assert run.summary["status"] == "converged"
    assert any("wide for the radius" in text for text in run.summary["outside_model"])
    (text,) = [note["text"] for note in run.summary["notes"] if note["code"] == "slopes-large"]
    assert "slope of 2.6," in text


@pytest.mark.internal
def test_steps_of_wear_in_oil_may_take_off_twice_what_bodies_give_way_by():
    check, worn = OUTCOME_CHECKS["steps_of_wear_in_oil_that_overshoot"], oil_outcome(1e-18)
    for distance, told in ((0.0385, 0), (0.0475, 1)):  # 1.7 and 2.1 times 2.26e-18 m/Pa
        law = {"kind": "archard", "specific_wear_rate": 1e-16, "distance": distance}
        facts = facts_of(library()["running-in-stribeck"] | {"wear": {"criterion": law}})
        assert len(list(check(facts, worn))) == told


@pytest.mark.internal
def test_cells_and_load_at_the_hardness_are_of_the_same_cells():
    """92 % of the area by interpolated edges stood beside 86 % of the load by cells, of which 74 % were counted."""
    pressure, areas = spot(7e9), {"contact_area_fraction": 0.02, "plastic_area_fraction": 0.019}
    pressure[16, 16] = 3.5e9
    capped, touching = np.count_nonzero(pressure == 7e9), np.count_nonzero(pressure)
    facts = facts_of(with_(BALL, contact__behaviour="capped", contact__hardness="7 GPa"))
    (told,) = OUTCOME_CHECKS["contact_at_the_cap"](facts, contact_outcome(pressure, **areas))
    assert told.values["cells"] == pytest.approx(capped / touching, rel=1e-12)
    assert told.values["cells_load"] == pytest.approx(2 * capped / (2 * capped + 1), rel=1e-12)
    assert told.values["area"] == pytest.approx(0.95, rel=1e-12)
    assert told.values["cells"] < told.values["load"], "cells touched in part carry less than their number"


def test_lengths_of_grooves_are_given_across_and_along_them():
    """The remark had their geometric mean, 20.6 um, which no other view shows."""
    ground = {"process": "ground", "lay": "y", "rms_height": "100 nm"}
    scene = with_(library()["stribeck-ball-on-disc"], lower__surface=ground)
    assert any(
        "6.5 um across and 65 um along the grooves of process ground" in note
        for note in scene_warnings(facts_of(scene))
    )
