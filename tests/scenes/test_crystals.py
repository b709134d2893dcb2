"""Crystals in scenes: keys, catalogue, a run against the closed form, and refusals."""

import math

import pytest

from bem import InputError, load_scene, run_scene
from bem.materials import CATALOGUE
from bem.reference_solutions.crystal_hertz import crystal_hertz

ON_111 = {"normal": [1, 1, 1], "along_x": [1, -1, 0]}


def ball(material, **tables):
    return {
        "kind": "contact",
        "grid": {"shape": 64, "lengths": "16 um"},
        "lower": {"material": material},
        "shape": {"kind": "sphere", "radius": "1 mm"},
        "contact": {"load": "50 mN"},
    } | tables


@pytest.mark.parametrize("orientation", [ON_111, {"normal": [1, 2, 3], "along_x": [1, 1, -1]}])
def test_ball_on_a_crystal_is_the_closed_form_within_its_error_bars(tmp_path, orientation):
    run = run_scene(ball({"catalogue": "copper-crystal", "orientation": orientation}), tmp_path / "run")
    stiffness = CATALOGUE["copper-crystal"].material.stiffness.oriented(**orientation)
    exact = crystal_hertz([stiffness], (1e-3, 1e-3), 0.05)
    values = {
        "approach_m": exact.approach,
        "max_pressure_Pa": exact.maximum_pressure,
        "contact_area_m2": math.pi * math.prod(exact.semi_axes),
    }
    for name, value in values.items():
        bar = run.summary[f"{name}_error"]
        assert abs(run.summary[name] - value) <= bar, name
        assert bar < 0.02 * value


def test_own_constants_and_the_catalogue_give_the_same_material():
    by_name = load_scene(ball({"catalogue": "silicon-crystal", "orientation": ON_111}))
    table = {"crystal": "cubic", "c11": "165.7 GPa", "c12": "63.9 GPa", "c44": "79.6 GPa"}
    own = load_scene(ball({"stiffness": table, "orientation": ON_111}))
    one, other = by_name.lower.build().material, own.lower.build().material
    assert one.stiffness == other.stiffness
    assert one.youngs_modulus == other.youngs_modulus
    assert load_scene(ball("silicon-crystal")).lower.build().material == CATALOGUE["silicon-crystal"].material
    matrix = CATALOGUE["silicon-crystal"].material.stiffness.matrix.tolist()
    general = load_scene(ball({"stiffness": {"crystal": "general", "matrix": matrix}, "orientation": ON_111}))
    assert general.lower.build().material.stiffness.constants == one.stiffness.constants


def test_uncertain_stiffness_moves_the_crystal(tmp_path):
    scene = ball("copper-crystal", uncertain={"lower.material.stiffness.c44": "1 %"}, outputs={"errors": False})
    run = run_scene(scene, tmp_path / "run")
    stiffness = CATALOGUE["copper-crystal"].material.stiffness
    by = [
        crystal_hertz(
            [type(stiffness)("cubic", **{**stiffness.by_name, "c44": 75.4e9 * factor})], (1e-3, 1e-3), 0.05
        ).approach
        for factor in (0.995, 1.005)
    ]
    assert run.summary["approach_input_scatter_m"] == pytest.approx(abs(by[1] - by[0]), rel=0.02, abs=0)


CUBIC = {"crystal": "cubic", "c11": "3 GPa", "c12": "1 GPa", "c44": "1 GPa"}


@pytest.mark.parametrize(
    ("scene", "message"),
    [
        (ball({"poissons_ratio": 0.3}), "lower.material.youngs_modulus: missing"),
        (ball({"stiffness": CUBIC, "youngs_modulus": "3 GPa"}), "beside stiffness"),
        (ball({"stiffness": CUBIC | {"c33": "1 GPa"}}), "a cubic crystal has c11, c12, c44"),
        (ball({"stiffness": CUBIC | {"c12": "4 GPa"}}), "not positive definite"),
        (ball({"youngs_modulus": "3 GPa", "poissons_ratio": 0.3, "orientation": ON_111}), "without stiffness"),
        (ball({"stiffness": CUBIC, "orientation": {"along_x": [0, 0, 1]}}), "is the normal"),
        (
            ball("TiN") | {"lower": {"material": "TiN", "layer": {"material": "copper-crystal", "thickness": 1e-6}}},
            "layer is a crystal",
        ),
    ],
)
def test_refusals(scene, message):
    with pytest.raises(InputError) as raised:
        load_scene(scene)
    assert message in str(raised.value)
