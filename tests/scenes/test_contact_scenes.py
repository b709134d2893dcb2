"""Kind `contact` run without a disk: closed forms, skips that change nothing, the same bits, resuming."""

import copy
import dataclasses

import numpy as np
import pytest

from bem.accuracy import ErrorBars
from bem.campaigns.collect import outcome_of
from bem.convolution import displacement_operator
from bem.errors import InputError, Status
from bem.grid import Grid
from bem.materials import Body, Layer, Material, contact_modulus
from bem.notes import Level, has_code
from bem.notes.accuracy import ERROR_BARS_LOST, NoBar
from bem.notes.checks import DEPTHS_MISS_STRESS, RESIDUAL_STRESS, RESIDUAL_STRESS_UNUSUAL, YIELDS
from bem.notes.contact import (
    ADHESION_ENDS_APART,
    ADHESIVE_ZONE_UNRESOLVED,
    CONTACT_UNRESOLVED,
    LINE_APPROACH,
    PULL_OFF_NOT_REACHED,
    PULL_OFF_OF_RANGE,
)
from bem.plots.tables import words_of
from bem.reference_solutions.hertz import cylinder_contact, sphere_contact
from bem.reference_solutions.westergaard import crossed_full_contact_pressure
from bem.relaxation import PronySeries
from bem.runs import plan_scene, run_scene
from bem.scenes import PlainContext, get_kind, load_scene
from bem.scenes.build import grid_of, traction_couples
from bem.scenes.checks import examine, scene_warnings
from bem.scenes.checks.outcome import elastic_stress_above_yield
from bem.scenes.context import error_bars
from bem.transforms import COUNT

KIND = get_kind("contact")


def run(source, settings=(), context=None):
    scene, _ = plan_scene(source, settings)
    context = context or PlainContext(scene.seed)
    return scene, outcome_of(scene, KIND.run(scene, context)), context


ROUGH = {
    "kind": "contact",
    "grid": {"shape": 64, "spacing": "0.5 um", "periodic": True},
    "lower": {
        "material": "steel-disk",
        "surface": {"kind": "generated", "rms_height": "100 nm", "correlation_length": "3 um"},
    },
    "upper": {"material": "steel-cylinder"},
    "contact": {"mean_pressure": "80 MPa", "behaviour": "capped"},
    "outputs": {"von_mises": True, "depths": ["0 um", "0.5 um", "2 um"]},
}


def rough(**tables):
    data = copy.deepcopy(ROUGH)
    for name, keys in tables.items():
        data[name] |= keys
    return data


def steel():
    scene, _ = plan_scene("hertz-sphere")
    material = scene.lower.material.build()
    return contact_modulus(material, material)


@pytest.mark.internal
def test_hertz_sphere():
    scene, outcome, _ = run("hertz-sphere", ["grid.shape=96", "outputs.stresses=false"])
    hertz = sphere_contact(radius=scene.shape.radius, contact_modulus=steel(), load=scene.contact.load)
    assert outcome.status == Status.CONVERGED
    # 38 cells across the contact: second order in the cell, (1/19)^2 = 0.3 %; the edge in the area, 1/19
    assert outcome.summary["approach_m"] == pytest.approx(hertz.approach, rel=3e-3)
    assert outcome.summary["max_pressure_Pa"] == pytest.approx(hertz.maximum_pressure, rel=5e-3)
    assert outcome.summary["contact_area_m2"] == pytest.approx(np.pi * hertz.semi_axes[0] ** 2, rel=5e-2)
    assert outcome.summary["load_N"] == pytest.approx(scene.contact.load, rel=1e-9)
    assert "von_mises" not in outcome.variables


@pytest.mark.internal
def test_hertz_cylinder():
    scene, outcome, _ = run("hertz-cylinder", ["outputs.von_mises=false", "grid.shape=[512,4]"])
    length = scene.grid.spacing[1] * 4
    material = scene.lower.material.build()
    hertz = cylinder_contact(
        radius=scene.shape.radius, contact_modulus=contact_modulus(material, material), load=scene.contact.load / length
    )
    # 100 cells across the contact
    assert outcome.summary["max_pressure_Pa"] == pytest.approx(hertz.maximum_pressure, rel=2e-3)


@pytest.mark.internal
def test_sinusoid_is_at_the_tenth_of_full_contact_it_says():
    scene, _ = plan_scene("sinusoid")
    full = crossed_full_contact_pressure(scene.shape.amplitude, (scene.shape.wavelength, np.inf), steel())
    assert scene.contact.mean_pressure == pytest.approx(0.1 * full, rel=1e-3)  # written with four digits
    _, outcome, _ = run("sinusoid", ["outputs.von_mises=false"])
    # Westergaard: contact fraction = 2/pi asin(sqrt(p/p*)); one cell of 512 on either edge
    assert outcome.summary["contact_area_fraction"] == pytest.approx(2 / np.pi * np.arcsin(np.sqrt(0.1)), abs=2 / 512)


@pytest.mark.internal
def test_rough_capped_contact():
    scene, outcome, _ = run(ROUGH)
    pressure = outcome.variables["pressure"].values
    state = outcome.variables["contact_state"].values
    assert scene.contact.hardness == 1.8e9  # of the softer body
    assert pressure.max() == 1.8e9
    assert (state == 2).any()
    assert (state == 1).any()
    # areas end inside cells: less than the cells that carry pressure, and by no more than what their edges hold
    assert 0.8 * np.mean(pressure > 0) < outcome.summary["contact_area_fraction"] < np.mean(pressure > 0)
    assert 0.8 * np.mean(state == 2) < outcome.summary["plastic_area_fraction"] < 1.2 * np.mean(state == 2)
    assert outcome.summary["load_N"] == pytest.approx(80e6 * (32e-6) ** 2, rel=1e-9)
    mises = outcome.variables["von_mises"].values
    # the highest stress lies between points, that of a point stands beside it
    assert outcome.summary["max_von_mises_of_points_Pa"] == mises.max()
    assert mises.max() <= outcome.summary["max_von_mises_Pa"] < 1.02 * mises.max()
    assert outcome.summary["max_pressure_of_cells_Pa"] == outcome.summary["max_pressure_Pa"] == 1.8e9
    assert outcome.summary["counted_contact_area_fraction"] == pytest.approx(np.mean(pressure > 0), rel=1e-12)
    assert outcome.summary["counted_plastic_area_fraction"] == pytest.approx(np.mean(state == 2), rel=1e-12)
    assert 1 < outcome.summary["contact_spots"] < np.sum(pressure > 0)
    # no shorter than that of one round spot of the whole area
    area = outcome.summary["contact_area_m2"]
    assert outcome.summary["contact_perimeter_m"] > np.sqrt(4 * np.pi * area)
    assert outcome.summary["mean_contact_pressure_Pa"] == pytest.approx(outcome.summary["load_N"] / area, rel=1e-12)
    assert mises.shape == (3, 64, 64)
    assert outcome.summary["yielded_volume_m3"] > 0


@pytest.mark.internal
def test_a_key_of_the_api_for_every_scene():
    _, outcome, _ = run(ROUGH)
    for key in (
        *("contact_area_fraction", "plastic_area_fraction", "mean_contact_pressure_Pa", "approach_m", "residual"),
        *("convolutions", "max_von_mises_Pa"),
    ):
        assert isinstance(outcome.summary[key], float), key


@pytest.mark.internal
def test_approach_and_mean_gap_reach_the_same_contact_as_the_load():
    _, by_load, _ = run(rough(outputs={"von_mises": False}))
    approach, gap = by_load.summary["approach_m"], by_load.summary["mean_gap_m"]
    elsewhere = rough(outputs={"von_mises": False})
    for control in ({"approach": approach}, {"mean_gap": gap}):
        _, other, _ = run(elsewhere | {"contact": {"behaviour": "capped"} | control})
        # both solutions are right to the solver's 1e-8 of the roughness; pressures follow within a stiff factor
        difference = np.abs(other.variables["pressure"].values - by_load.variables["pressure"].values).max()
        assert difference < 1e-4 * 1.8e9


@pytest.mark.internal
def test_a_figure_that_its_solution_lost_is_an_error(monkeypatch):
    """An optional figure was left out in silence when its name in the solution changed."""
    from bem.stress.stress_summary import StressSummary

    monkeypatch.delattr(StressSummary, "max_von_mises_of_points")
    with pytest.raises(AttributeError, match="max_von_mises_of_points"):
        run(rough())


@pytest.mark.internal
def test_von_mises_alone_is_the_same_as_from_all_stresses():
    _, alone, _ = run(ROUGH)
    _, everything, _ = run(rough(outputs={"stresses": True}))
    # the same sums in another order
    np.testing.assert_allclose(
        alone.variables["von_mises"].values, everything.variables["von_mises"].values, rtol=1e-10, atol=1.0
    )
    assert everything.variables["stress"].values.shape == (6, 3, 64, 64)


@pytest.mark.internal
def test_von_mises_of_a_coated_body_gives_figures_of_layers_and_interfaces():
    """The same as with all stresses, with their places and bars, but the stress field is not in the results."""
    layers = 'lower.layers=[{material="dlc",thickness="1 um"},{material="tungsten-carbide",thickness="1 um"}]'
    base = ["grid.shape=64", layers, 'outputs.depths={deepest="4 um",count=6}']
    _, alone, _ = run("multilayer-coating", base)
    _, everything, _ = run("multilayer-coating", [*base, "outputs.stresses=true"])
    told = alone.summary
    for name in ("interface_max_shear", "interface_max_tension", "layer_max_von_mises", "layer_max_tension"):
        assert len(told[f"{name}_Pa"]) == len(told[f"{name}_Pa_error"]) == len(told[f"{name}_x_m"]) == 2
    assert told["layer_material"] == ["dlc", "tungsten-carbide"]
    assert told["substrate_max_von_mises_Pa"] > 0
    np.testing.assert_equal(everything.summary, told)
    assert "stress" not in alone.variables
    assert everything.variables["stress"].values.shape[0] == 6


@pytest.mark.internal
def test_no_stress_is_computed_when_none_is_wanted():
    run(rough(outputs={"von_mises": False}))  # plans and spectra are made once
    COUNT.reset()
    _, without, _ = run(rough(outputs={"von_mises": False}))
    few = COUNT.inverse
    COUNT.reset()
    _, with_stress, _ = run(ROUGH)
    assert COUNT.inverse > few
    np.testing.assert_array_equal(without.variables["pressure"].values, with_stress.variables["pressure"].values)


@pytest.mark.internal
def test_friction_between_equal_bodies_changes_no_pressure_and_builds_no_kernel():
    _, without, _ = run(rough(outputs={"von_mises": False}))
    COUNT.reset()
    _, with_friction, _ = run(rough(outputs={"von_mises": False}, contact={"friction": 0.3}))
    assert COUNT.kernels == 0
    np.testing.assert_array_equal(without.variables["pressure"].values, with_friction.variables["pressure"].values)


def body(name="a", modulus=210e9, hardness=2e9, film=100e-9):
    base = Material(name, youngs_modulus=modulus, poissons_ratio=0.3, hardness=hardness)
    soft = Material("film", youngs_modulus=15e9, poissons_ratio=0.3)
    return Body(base, layer=Layer(soft, film) if film else None)


@pytest.mark.internal
@pytest.mark.parametrize(
    ("lower", "upper", "couples"),
    [
        (body(), body(name="b"), False),
        (body(), body(hardness=6e9), False),
        (body(), body(film=101e-9), True),
        (body(), body(film=0), True),
        (body(), None, True),
        (body(film=0), body("b", hardness=6e9, film=0), False),
        # round-off of input: the operator takes such bodies as equal
        (body(film=0), body(modulus=210e9 * (1 + 3e-16), film=0), False),
        (body(film=0), None, True),
    ],
)
def test_the_plan_takes_bodies_as_coupled_where_the_operator_does(lower, upper, couples):
    pair = lower if upper is None else (lower, upper)
    operator = displacement_operator(Grid((8, 8), (1e-6, 1e-6)), pair, friction=0.3)
    assert traction_couples(lower, upper, 0.3) == (not operator.symmetric) == couples
    assert not traction_couples(lower, upper, 0.0)


@pytest.mark.internal
def test_friction_raises_the_stress_at_the_surface_of_either_body():
    values = {}
    for body in ("lower", "upper"):
        for friction in (0.0, 0.5):
            data = rough(contact={"friction": friction}, outputs={"body": body})
            values[body, friction] = run(data)[1].variables["von_mises"].values[0].mean()
    assert values["lower", 0.5] > 1.1 * values["lower", 0.0]
    # the two bodies have the same elastic constants: traction reversed, the stress is the mirror image's, not the same
    assert values["upper", 0.0] == pytest.approx(values["lower", 0.0], rel=1e-12)


@pytest.mark.internal
def test_same_seed_same_bits_other_seed_other_surface():
    _, first, _ = run(ROUGH)
    _, again, _ = run(ROUGH)
    for name, item in first.variables.items():
        assert item.values.tobytes() == again.variables[name].values.tobytes(), name
    assert first.summary == again.summary
    _, other, _ = run(ROUGH | {"seed": 2})
    assert not np.array_equal(other.variables["lower_height"].values, first.variables["lower_height"].values)


@pytest.mark.internal
def test_resumed_after_the_contact_solve_the_bits_are_the_same():
    _, whole, context = run(ROUGH)
    resumed = PlainContext(1, resumed=True, state=context.state)
    COUNT.reset()
    _, rest, _ = run(ROUGH, context=resumed)
    assert whole.variables.keys() == rest.variables.keys()
    for name, item in whole.variables.items():
        assert item.values.tobytes() == rest.variables[name].values.tobytes(), name
    assert whole.summary == rest.summary


@pytest.mark.internal
def test_iteration_limit_is_said_and_the_result_kept():
    _, outcome, _ = run(rough(contact={"max_iterations": 2}, outputs={"von_mises": False}))
    assert outcome.status == Status.MAX_ITERATIONS
    assert "contact solve" in outcome.where
    assert outcome.variables["pressure"].values.shape == (64, 64)


def test_plan_says_what_is_skipped_and_why():
    _, plan = plan_scene(rough(outputs={"von_mises": False}))
    skipped = {step.name: step.why for step in plan.steps if step.skipped}
    assert skipped["layered kernels"] == "no body is coated"
    assert skipped["traction kernels"] == "no friction"
    assert skipped["stresses below"] == "neither stresses nor von Mises are asked for"
    _, plan = plan_scene(rough(contact={"friction": 0.1}))
    skipped = {step.name: step.why for step in plan.steps if step.skipped}
    assert "Dundurs' beta is zero" in skipped["traction kernels"]
    _, plan = plan_scene(rough(contact={"friction": 0.1}, lower={"material": "brass-disk"}))
    assert "traction kernels" not in {step.name for step in plan.steps if step.skipped}


@pytest.mark.internal
def test_same_bits_on_two_threads():
    from bem.threads import get_threads, set_threads

    before = get_threads()
    try:
        set_threads(1)
        _, one, _ = run(ROUGH)
        set_threads(2)
        _, two, _ = run(ROUGH)
    finally:
        set_threads(before)
    for name, item in one.variables.items():
        assert item.values.tobytes() == two.variables[name].values.tobytes(), name


@pytest.mark.internal
@pytest.mark.parametrize("asked", [{"mean_gap": "5 um"}, {"approach": "-1 um"}])
def test_bodies_that_do_not_touch_say_so(asked):
    _, outcome, context = run(rough() | {"contact": asked})
    assert outcome.summary["load_N"] == 0
    assert any(note.code == "bodies-apart" for note in context.notes)


COATED = ("grid.shape=32", "contact.friction=0.1", 'outputs={"stresses" = true, "errors" = false}')


def test_a_residual_stress_of_a_layer_adds_to_stresses_and_is_said():
    """The pressure keeps its bits; in-plane stresses of the layer move by it; its figure stands beside the others."""
    settings = [*COATED, 'outputs.depths={deepest="20 um",count=4}']
    stated = "lower.layer.residual_stress=-2 GPa"
    _, plain, _ = run("coated-sphere", settings)
    scene, found, _ = run("coated-sphere", [*settings, stated])
    layer = [depth <= 2e-6 for depth in scene.wanted_depths()]
    moved = found.variables["stress"].values - plain.variables["stress"].values
    np.testing.assert_allclose(moved[:2, layer], -2e9, rtol=1e-9)
    assert np.abs(moved[2:]).max() < 1e-3
    assert np.abs(moved[:2, np.logical_not(layer)]).max() < 1e-3
    assert found.variables["pressure"].values.tobytes() == plain.variables["pressure"].values.tobytes()
    assert found.summary["layer_residual_stress_Pa"] == [-2e9]
    assert "layer_residual_stress_Pa" not in plain.summary
    assert found.summary["layer_max_tension_Pa"][0] < plain.summary["layer_max_tension_Pa"][0]
    assert has_code(scene_warnings(examine(scene)), RESIDUAL_STRESS)
    thinner = scene.lower.with_outermost(1e-6).build()
    assert (thinner.layers[0].thickness, thinner.layers[0].residual_stress) == (1e-6, -2e9)


def test_a_residual_stress_that_is_no_usual_one_of_the_coating_is_a_caution():
    for stress, told in (("2 GPa", True), ("-2 GPa", False)):
        scene, _ = plan_scene("coated-sphere", [f'lower.layer.residual_stress="{stress}"'])
        assert has_code(scene_warnings(examine(scene)), RESIDUAL_STRESS_UNUSUAL) is told


def test_a_residual_stress_without_a_unit_is_said_once_and_another_sign_only_where_it_would_do():
    """-2 [Pa] is no stress of any coating: its unit is asked for, and not its sign, which is right."""
    scene, _ = plan_scene("coated-sphere", ["lower.layer.residual_stress=-2"])
    cautions = [str(note) for note in scene_warnings(examine(scene)) if "residual_stress" in note]
    assert len(cautions) == 1
    assert "-2 GPa" in cautions[0]
    for stress, check in (("2 GPa", "sign"), ("-100 MPa", "unit")):
        scene, _ = plan_scene("coated-sphere", [f'lower.layer.residual_stress="{stress}"'])
        assert any(f"Check the {check} of residual_stress" in note for note in scene_warnings(examine(scene)))


def test_the_approach_of_a_rolling_line_contact_is_said_to_have_no_meaning():
    """Of either sign: 392 um at 1 mm/s, 180 um at 1 m/s, between limits that the elastic moduli set at 225 um."""
    for speed in ("1 mm/s", "1 m/s"):
        settings = ["over=", "contact.sliding_speed=", f'contact.rolling_speed="{speed}"']
        _, _, context = run("sliding-hysteresis", settings)
        (note,) = [one for one in context.notes if one.code == LINE_APPROACH.code]
        assert "two speeds" in str(note)


def test_a_residual_stress_beyond_the_yield_stress_is_refused():
    with pytest.raises(InputError, match=r"residual_stress -9 GPa exceeds the yield stress of the layer, 7\.14 GPa"):
        run("coated-sphere", ["lower.layer.residual_stress=-9 GPa"])


def test_the_highest_tension_at_the_edge_of_the_contact_has_a_place_on_the_edge():
    """Extrapolated between the cells (`bem.stress.edge_tension`): on the circle of the contact."""
    _, outcome, _ = run("coated-sphere", ["grid.shape=48", "contact.friction=0.4", *COATED[2:]])
    told = outcome.summary
    assert told["layer_max_tension_depth_m"] == [0.0]
    radius = np.hypot(told["layer_max_tension_x_m"][0], told["layer_max_tension_y_m"][0])
    assert radius == pytest.approx(np.sqrt(told["contact_area_m2"] / np.pi), rel=0.02, abs=0)
    assert told["layer_max_tension_x_m"][0] < 0


def test_coatings_have_depths_and_stresses_by_layer_and_interface():
    layers = 'lower.layers=[{material="dlc",thickness="2 um"},{material="tungsten-carbide",thickness="0.5 um"}]'
    settings = [*COATED, "lower.layer=", layers]
    scene, outcome, _ = run("coated-sphere", settings)
    depths = np.array(scene.wanted_depths())
    told = outcome.summary
    assert told["interface_depth_m"] == pytest.approx([2e-6, 2.5e-6])
    for top, bottom in ((-1, 2e-6), (2e-6, 2.501e-6)):
        assert np.count_nonzero((depths > top) & (depths <= bottom)) >= 5
    assert len(told["interface_max_shear_Pa"]) == len(told["layer_max_tension_Pa"]) == 2
    assert max(told["layer_max_von_mises_Pa"]) <= told["max_von_mises_Pa"] * (1 + 1e-9)
    assert told["layer_material"] == ["dlc", "tungsten-carbide"]
    yields = np.array([layer.material.yield_stress for layer in scene.lower.build().layers])
    np.testing.assert_allclose(told["layer_yield_ratio"], told["layer_max_von_mises_Pa"] / yields, rtol=1e-12)
    beneath = outcome.variables["von_mises"].values[depths > 2.5e-6].max()
    assert told["substrate_max_von_mises_Pa"] == pytest.approx(beneath, rel=0.02, abs=0)
    steel = scene.lower.build().material.yield_stress
    assert told["substrate_yield_ratio"] == pytest.approx(told["substrate_max_von_mises_Pa"] / steel, rel=1e-12, abs=0)
    assert told["max_von_mises_Pa"] == max(*told["layer_max_von_mises_Pa"], told["substrate_max_von_mises_Pa"])
    for name, top, bottom in (("layer_max_von_mises", 0, 2e-6), ("layer_max_tension", 0, 2e-6)):
        assert top <= told[f"{name}_depth_m"][0] <= bottom
    assert abs(told["interface_max_shear_x_m"][0]) + abs(told["interface_max_shear_y_m"][0]) > 0  # off the axis
    assert not has_code(scene_warnings(examine(scene)), DEPTHS_MISS_STRESS)
    graded, _, _ = run("coated-sphere", [*settings, 'outputs.depths={deepest="60 um",count=8}'])
    assert {2e-6, 2.5e-6} <= set(np.round(graded.wanted_depths(), 15))
    listed, _, _ = run("coated-sphere", [*settings, 'outputs.depths=["0 um","1 um"]'])
    assert listed.wanted_depths() == (0.0, 1e-6)
    _, plain, _ = run("hertz-sphere", ["grid.shape=32", 'outputs={"stresses" = true, "errors" = false}'])
    assert "interface_depth_m" not in plain.summary


def test_the_caution_of_a_yielding_coat_names_the_layer_that_yields_first():
    settings = [*COATED, 'lower.layer={material="tribofilm",thickness="2 um"}']
    scene, outcome, _ = run("coated-sphere", [*settings, "contact.load=20 N"])
    ratio = outcome.summary["layer_yield_ratio"][0]
    assert ratio > 1
    facts = examine(scene)
    found = list(elastic_stress_above_yield(facts, outcome))
    assert [note.code for note in found] == [YIELDS.code]
    assert found[0].headline == "tribofilm yields first"
    assert (
        f"{ratio:.2g} in tribofilm, {outcome.summary['substrate_yield_ratio']:.2g} in steel-52100 below the coating"
        in found[0]
    )
    below = dataclasses.replace(outcome, summary=outcome.summary | {"layer_yield_ratio": [0.5]})
    below.summary["substrate_yield_ratio"] = 0.6
    assert not list(elastic_stress_above_yield(facts, below))
    below.summary["substrate_yield_ratio"] = 1.6
    assert "steel-52100 below the coating yields first" in next(elastic_stress_above_yield(facts, below))


def test_a_coated_rough_contact_has_no_plasticity_index():
    """Of the substrates' modulus it was 0.18, which reads as elastic, beside layers beyond their yield stress."""
    layer = {"material": "dlc", "thickness": "2 um"}
    for tables, there in (({}, True), ({"lower": {"layer": layer}}, False)):
        _, outcome, _ = run(rough(**tables))
        assert ("plasticity_index" in outcome.summary) is there
        assert ("slope_plasticity_index" in outcome.summary) is there
        assert "combined_Sdq" in outcome.summary


def test_an_elastic_patch_lies_between_the_theories_of_contact_area():
    """Area over reduced pressure: above Persson's sqrt(8/pi), below sqrt(2 pi) of Bush, Gibson and Thomas."""
    surface = {"kind": "generated", "rms_height": "100 nm", "hurst": 0.8, "rolloff_wavelength": "8 um"}
    surface["cutoff_wavelength"] = "4 um"  # eight cells a wave
    data = rough(lower={"surface": surface}, contact={"behaviour": "elastic", "mean_pressure": "60 MPa"})
    data["outputs"] = {"von_mises": False}
    scene, outcome, _ = run(data)
    summary, bodies = outcome.summary, (scene.lower.build(), scene.upper.build())
    modulus, slope = contact_modulus(bodies[0].material, bodies[1].material), summary["combined_Sdq"]
    hardness = min(body.material.indentation_hardness for body in bodies)
    assert summary["slope_plasticity_index"] == pytest.approx(modulus / hardness * slope, rel=1e-9)
    assert "plasticity_index" in KIND.headline
    ratio = summary["contact_area_fraction"] / summary["reduced_pressure"]
    assert np.sqrt(8 / np.pi) < ratio < np.sqrt(2 * np.pi)


def test_smooth_bodies_have_no_roughness_figures():
    _, outcome, _ = run("hertz-sphere", ["grid.shape=48", "outputs.stresses=false"])
    assert not {"combined_Sdq", "reduced_pressure", "plasticity_index"} & set(outcome.summary)


PRESSED = {
    "kind": "contact", "name": "by-pressure", "grid": {"shape": [64, 64], "lengths": ["300 um", "300 um"]},
    "lower": {"material": "steel-52100"}, "upper": {"material": "steel-52100"},
    "contact": {"hertz_pressure": "1 GPa"}, "outputs": {"errors": False},
}  # fmt: skip


@pytest.mark.parametrize(
    "shape",
    [
        {"kind": "sphere", "radius": "5 mm"},
        {"kind": "ellipsoid", "radius": "5 mm", "radius_y": "8 mm"},
        {"kind": "cylinder", "radius": "5 mm"},
    ],
    ids=lambda shape: shape["kind"],
)
def test_a_hertz_pressure_stands_for_its_load(shape, tmp_path):
    """The load of the plan is that of the closed form; the contact that is solved has the pressure."""
    grid = PRESSED["grid"] | {"periodic": [False, shape["kind"] == "cylinder"]}
    table = PRESSED | {"shape": shape, "grid": grid}
    scene, _ = plan_scene(table)
    assert scene.contact.hertz_pressure is None
    smooth = scene.smooth_contact(grid_of(scene.grid).lengths)
    assert smooth.maximum_pressure == pytest.approx(1e9, rel=1e-9)
    found = run_scene(table, tmp_path / "run", figures=False).summary
    assert found["max_pressure_Pa"] == pytest.approx(1e9, rel=0.02)  # cells of a thirtieth of the contact


def test_a_hertz_pressure_needs_a_shape_and_no_load():
    for shape in ({"kind": "flat"}, {"kind": "sinusoid", "amplitude": "1 um", "wavelength": "50 um"}):
        with pytest.raises(InputError, match=r"hertz_pressure under a shape of kind .*contact\.mean_pressure"):
            load_scene(PRESSED | {"shape": shape})
    ball = PRESSED | {"shape": {"kind": "sphere", "radius": "5 mm"}}
    with pytest.raises(InputError, match="load and hertz_pressure are given"):
        load_scene(ball | {"contact": {"hertz_pressure": "1 GPa", "load": "3 N"}})
    with pytest.raises(InputError, match="exactly one of load, hertz_pressure, mean_pressure"):
        load_scene(ball | {"contact": {}})


def test_a_key_over_hertz_pressures_runs_each(tmp_path):
    over = {"contact.hertz_pressure": ["0.5 GPa", "1 GPa"]}
    found = run_scene(
        PRESSED | {"shape": {"kind": "sphere", "radius": "5 mm"}, "over": over}, tmp_path / "run", figures=False
    )
    loads = found.dataset["load"].values
    assert loads[1] / loads[0] == pytest.approx(8)


ADHESIVE = {
    "kind": "contact",
    "grid": {"shape": 64, "lengths": "40 um"},
    "lower": {"material": {"youngs_modulus": "5 MPa", "poissons_ratio": 0.49}},
    "shape": {"kind": "sphere", "radius": "50 um"},
    "contact": {
        "adhesion": {"work": "50 mJ/m^2", "range": "200 nm"},
        "approach_path": ["-1 um", "0.4 um", "0 um", "-0.2 um"],
        "approach": "-0.4 um",
    },
}


def test_adhesion_follows_the_path_and_tells_the_lowest_load():
    _, outcome, _ = run(ADHESIVE)
    assert outcome.status == Status.CONVERGED
    load, approach = (outcome.variables[name].values for name in ("path_load", "path_approach"))
    assert [one for one in approach * 1e6 if np.isclose(one, [-1, 0.4, 0, -0.2, -0.4]).any()] == pytest.approx(
        [-1, 0.4, 0, -0.2, -0.4]
    )
    assert 5 < load.size <= 17  # with points about the lowest load
    assert 0 < load.argmin() < load.size - 2
    assert outcome.summary["load_N"] == load[-1]
    assert outcome.summary["lowest_load_N"] == load.min()
    # between Johnson, Kendall and Roberts' 1.5 and Bradley's 2 pi w R
    assert 1.5 < -outcome.summary["lowest_load_N"] / (np.pi * 0.05 * 50e-6) < 2
    net = outcome.variables["pressure"].values - outcome.variables["attraction"].values
    assert net.sum() * (40e-6 / 64) ** 2 == pytest.approx(load[-1], rel=1e-5)
    assert 0 < outcome.summary["lowest_load_N_error"] < 0.1 * -outcome.summary["lowest_load_N"]


def test_a_sphere_has_the_limits_of_its_pull_off_force_beside_it():
    pressed = copy.deepcopy(ADHESIVE)
    pressed["contact"] |= {"approach_path": ["-1 um"], "approach": "0.4 um"}
    _, outcome, context = run(pressed)
    told, radius, work = outcome.summary, 50e-6, 0.05
    assert told["jkr_lowest_load_N"] == pytest.approx(-1.5 * np.pi * work * radius, rel=1e-12, abs=0)
    assert told["dmt_lowest_load_N"] == pytest.approx(-2 * np.pi * work * radius, rel=1e-12, abs=0)
    modulus = 5e6 / (1 - 0.49**2)
    tabor = (radius * work**2 / (modulus**2 * (200e-9) ** 3)) ** (1 / 3)
    assert told["tabor_parameter"] == pytest.approx(tabor, rel=1e-12)
    assert next(iter(outcome.summary)) == "lowest_load_N"
    assert not has_code(context.notes, ADHESION_ENDS_APART)
    assert "lowest_load_pressure" not in outcome.variables
    _, outcome, context = run(ADHESIVE)
    assert outcome.summary["contact_area_m2"] == 0
    (apart,) = (note for note in context.notes if note.code == ADHESION_ENDS_APART.code)
    assert apart.values["load"] == outcome.summary["load_N"] < 0, "an exponential attraction ends at no gap"
    assert "falls by a factor of 2.7" in apart
    # the residual of an approach that is prescribed was shown as its error
    assert outcome.summary["approach_m_error"] == outcome.summary["approach_m_error_residual"] == 0
    lowest = outcome.variables["lowest_load_pressure"].values > 0
    area = np.count_nonzero(lowest) / lowest.size
    least = int(np.argmin(outcome.variables["path_load"].values))
    assert area > 0
    assert area * grid_of(load_scene(ADHESIVE).grid).area == pytest.approx(
        outcome.variables["path_contact_area"].values[least], rel=0.35, abs=0
    )
    (note,) = [one for one in context.notes if one.code == PULL_OFF_OF_RANGE.code]
    assert note.values["jkr"] < note.values["dmt"]


@pytest.mark.parametrize(
    ("path", "end", "known"),
    [
        ({"approach_path": ["-1 um", "0.4 um", "0 um", "-0.2 um"], "approach": "-0.4 um"}, "apart", "pull-off"),
        ({"approach_path": ["-1 um", "0.4 um"], "approach": "0 um"}, "in contact", "in contact"),
        ({"approach_path": ["0.4 um", "0 um"], "approach": "0.4 um"}, "in contact", "in contact"),
        ({"load_path": ["20 uN", "-5 uN"], "load": "5 uN"}, "in contact", "in contact"),
    ],
)
def test_the_lowest_load_of_a_path_is_a_pull_off_force_only_once_the_bodies_part(path, end, known):
    data = copy.deepcopy(ADHESIVE)
    data["contact"] = {"adhesion": data["contact"]["adhesion"], **path}
    _, outcome, context = run(data)
    summary = outcome.summary
    assert summary["lowest_load_N"] < 0
    assert (summary["contact_area_m2"] > 0) == (end == "in contact")
    assert summary["lowest_load_is"] == known
    words = words_of("lowest_load_N", summary)
    assert words.startswith("pull-off force" if known == "pull-off" else "lowest load of the path (the bodies did not")
    assert has_code(context.notes, PULL_OFF_OF_RANGE) == (known == "pull-off")
    assert has_code(context.notes, PULL_OFF_NOT_REACHED) == (known != "pull-off")
    assert words_of("mean_contact_pressure_Pa", summary).startswith("mean repulsion in the contact")
    assert words_of("mean_contact_pressure_Pa", {}) == "mean contact pressure"


def test_a_load_beyond_the_pull_off_is_named_with_the_load_of_the_figures():
    """1.5 pi w R = 11.8 uN and 2 pi w R = 15.7 uN: the advice was to lower the load or to raise the hardness."""
    data = copy.deepcopy(ADHESIVE)
    data["contact"] = {"adhesion": data["contact"]["adhesion"], "load": "5 uN"}
    data["contact"]["load_path"] = ["20 uN", "-5 uN", "-20 uN"]
    _, outcome, context = run(data)
    assert outcome.status is Status.INFEASIBLE
    assert outcome.summary["load_N"] == pytest.approx(-5e-6, rel=1e-6, abs=0)
    assert outcome.where == (
        "contact.load_path = -20 uN pulls the bodies apart (pull-off by JKR 11.8 uN, by DMT 15.7 uN);"
        " for the pull-off take approach_path and approach."
        " Figures are of -5 uN"
    )
    assert "that the bodies bear" in words_of("lowest_load_N", outcome.summary)
    assert not has_code(context.notes, PULL_OFF_NOT_REACHED)


def test_all_error_bars_lost_to_an_unsolved_coarser_grid_are_one_caution():
    lost = ErrorBars.unknown(("load", "approach"), NoBar.COARSER_UNSOLVED)
    context = PlainContext()
    error_bars(context, True, lambda: lost)
    assert [(note.code, note.level) for note in context.notes] == [(ERROR_BARS_LOST.code, Level.CAUTION)]
    context = PlainContext()
    error_bars(context, True, lambda: lost | ErrorBars({"area": 1.0}))
    assert not has_code(context.notes, ERROR_BARS_LOST)


def test_one_state_at_a_time_is_the_same_as_its_path_without_hysteresis():
    data = copy.deepcopy(ADHESIVE)
    data["contact"] = {"adhesion": data["contact"]["adhesion"], "load": "5 uN"}
    _, alone, _ = run(data)
    data["contact"]["load_path"] = ["20 uN", "1 uN"]
    _, after, _ = run(data)
    assert after.summary["approach_m"] == pytest.approx(alone.summary["approach_m"], rel=1e-3)
    assert "path_load" not in alone.variables
    assert not [name for name in alone.summary if name.startswith("lowest_load")]
    assert after.summary["lowest_load_N"] == pytest.approx(1e-6)


def test_too_wide_cells_for_the_adhesive_zone_are_outside_the_model():
    data = copy.deepcopy(ADHESIVE)
    data["contact"] = {"adhesion": {"work": "50 mJ/m^2", "range": "20 nm"}, "load": "5 uN"}
    _, _, context = run(data)
    assert has_code(context.notes, ADHESIVE_ZONE_UNRESOLVED)
    _, _, context = run(ADHESIVE)
    assert not has_code(context.notes, ADHESIVE_ZONE_UNRESOLVED)


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"friction": 0.1}, "friction is given with adhesion"),
        ({"load_path": ["1 uN"]}, "load_path does not go with"),
        ({"approach": None, "mean_gap": "1 um", "approach_path": []}, "mean_gap is given with adhesion"),
        ({"adhesion": None}, "approach_path is given without adhesion"),
        ({"adhesion": {"work": "50 mJ/m^2"}}, "range"),
        ({"adhesion": {"kind": "glue", "work": "50 mJ/m^2", "range": "1 nm"}}, "glue"),
    ],
)
def test_adhesion_refuses_what_does_not_go_with_it(changed, message):
    data = copy.deepcopy(ADHESIVE)
    data["contact"] = {key: value for key, value in (data["contact"] | changed).items() if value is not None}
    with pytest.raises(InputError, match=message):
        plan_scene(data)


RELAXING = {
    "kind": "contact",
    "grid": {"shape": 48, "lengths": "5 mm"},
    "lower": {
        "material": {
            "youngs_modulus": "20 MPa",
            "poissons_ratio": 0.45,
            "relaxation": {"shares": [0.5, 0.25], "times": ["0.1 s", "2 s"]},
        }
    },
    "shape": {"kind": "sphere", "radius": "10 mm"},
    "contact": {"times": ["0 s", "4 s"], "load_path": ["1 N"], "load": "1 N"},
}


def test_a_body_that_relaxes_creeps_under_a_held_load():
    """Lee and Radok: a^3 grows as the compliance; the path is in the dataset."""
    _, outcome, _ = run(RELAXING)
    series = PronySeries([0.5, 0.25], [0.1, 2.0])
    modulus = 20e6 / (1 - 0.45**2)
    radius = np.cbrt(3 * 0.01 * series.creep().compliance(4.0) / (4 * modulus))
    assert outcome.summary["approach_m"] == pytest.approx(radius**2 / 0.01, rel=5e-4)
    assert outcome.variables["path_time"].values[[0, -1]] == pytest.approx([0, 4])
    assert outcome.summary["energy_imbalance"] < 1e-3
    assert 0 < outcome.summary["dissipated_energy_J_error"] < 0.05 * outcome.summary["dissipated_energy_J"]
    assert outcome.summary["load_N_error"] == 0


def test_sliding_has_hysteresis_friction_and_rolling_of_one_body_the_same():
    data = copy.deepcopy(RELAXING)
    data["contact"] = {"load": "1 N", "sliding_speed": "1 mm/s"}
    _, outcome, _ = run(data)
    assert 0.005 < outcome.summary["hysteresis_friction"] < 0.1
    assert outcome.summary["energy_imbalance"] < 0.02
    assert outcome.summary["dissipated_power_W"] == pytest.approx(
        1e-3 * outcome.summary["hysteresis_force_N"], rel=0.02
    )
    data["contact"] = {"load": "1 N", "rolling_speed": "1 mm/s"}
    _, rolling, _ = run(data)
    assert rolling.summary["hysteresis_friction"] == outcome.summary["hysteresis_friction"]


def test_creeping_bodies_dissipate_friction_times_speed_on_cells_longer_than_their_memory():
    """At 1 um/s the bodies remember 2 um of their way, on cells of 104 um."""
    data = copy.deepcopy(RELAXING)
    data["contact"] = {"load": "1 N", "sliding_speed": "1 um/s"}
    _, outcome, context = run(data)
    assert outcome.summary["energy_imbalance"] < 0.05
    assert not [note for note in context.notes if note.code == "hysteresis-unbalanced"]
    # friction, by the slope, is in proportion to the speed there
    data["contact"]["sliding_speed"] = "2 um/s"
    _, faster, _ = run(data)
    assert faster.summary["hysteresis_friction"] == pytest.approx(2 * outcome.summary["hysteresis_friction"], rel=0.02)


def test_a_contact_of_few_cells_says_that_its_power_is_not_resolved():
    data = copy.deepcopy(RELAXING)
    data["grid"]["shape"] = 6
    data["contact"] = {"load": "1 N", "sliding_speed": "1 um/s"}
    _, outcome, context = run(data)
    assert outcome.summary["energy_imbalance"] > 0.2
    (note,) = [note for note in context.notes if note.code == "hysteresis-unbalanced"]
    assert note.values["length"] == pytest.approx(2e-6, rel=1e-12, abs=0)


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"contact": {"load": "1 N"}}, "lower.material relaxes"),
        ({"contact": {"load": "1 N", "times": ["0 s", "1 s"]}}, "2 times for 0 values"),
        ({"contact": {"load": "1 N", "times": ["0 s"], "sliding_speed": "1 m/s"}}, "times and sliding_speed are given"),
        ({"contact": {"load": "1 N", "times": ["0 s"], "friction": 0.1}}, "times with friction"),
        ({"contact": {"load": "1 N", "times": ["2 s", "1 s"], "load_path": ["1 N"]}}, "times fall"),
        ({"lower": {"material": "steel-disk"}}, "without a body that relaxes"),
    ],
)
def test_relaxation_refuses_what_does_not_go_with_it(keys, message):
    with pytest.raises(InputError, match=message):
        plan_scene(copy.deepcopy(RELAXING) | keys)


def test_other_kinds_refuse_a_body_that_relaxes():
    data = {
        "kind": "surface-temperature",
        "grid": {"shape": 32, "lengths": "5 mm"},
        "lower": RELAXING["lower"],
        "shape": RELAXING["shape"],
        "contact": {"load": "1 N", "friction": 0.1},
        "heat": {"lower_speed": "1 m/s"},
    }
    with pytest.raises(InputError, match="relaxes"):
        plan_scene(data)


def test_a_contact_of_few_cells_says_that_it_is_not_resolved():
    """A single cell had a mean pressure above its maximum without a word."""
    rough = {"kind": "generated", "rms_height": "50 nm", "correlation_length": "4 um"}
    body = {"material": "steel-52100", "surface": rough}
    patch = {"kind": "contact", "lower": body, "upper": {"material": "steel-52100"}, "grid": {"shape": 64}}
    patch["grid"] |= {"lengths": "64 um", "periodic": True}
    for pressure, expected in (("5 kPa", True), ("50 MPa", False)):
        resolved, _ = plan_scene(patch | {"contact": {"mean_pressure": pressure}})
        context = PlainContext(resolved.seed)
        pressures = KIND.run(resolved, context).pressure
        cells = int((pressures > 0).sum())
        assert (cells < 10) == expected
        said = [n for n in context.notes if has_code([n], CONTACT_UNRESOLVED, reason="few-cells")]
        assert [note.values["cells"] for note in said] == [cells] * expected
