"""Usual ranges of what users give: each fires outside and not inside, in scenes, elements and from Python."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from small_scenes import oiled_ball

from bem import (
    Body,
    Grid,
    Lubricant,
    Material,
    displacement_operator,
    generate_surface,
    grow_tribofilm,
    march_line_film,
    march_point_film,
    run_in,
    solve_contact,
    solve_line_film,
    solve_mixed,
    solve_point_film,
)
from bem.elements.element import load_element
from bem.errors import Status
from bem.notes import OUTSIDE, outside
from bem.physical_constants import ELECTRON_VOLT
from bem.plausibility import ARGUMENT, BY_KEY, RANGES, notes_on, notes_on_arguments, range_of_key
from bem.runs import plan_scene, run_scene
from bem.scenes import library
from bem.scenes.checks import SCENE_CHECKS, examine, scene_warnings
from bem.scenes.checks.plausible import notes_on_table
from bem.tribofilm import FilmContact, grow_local_film
from bem.tribofilm.growth import StressActivatedGrowth

pytestmark = pytest.mark.internal

STEEL = "steel-52100"


def fired(source, *settings):
    return list(SCENE_CHECKS["outside_usual_range"](examine(plan_scene(source, settings)[0])))


@pytest.mark.parametrize("usual", RANGES, ids=lambda usual: usual.quantity)
@given(share=st.floats(0, 1), beyond=st.floats(1.001, 1e3))
def test_each_range_fires_outside_and_not_inside(usual, share, beyond):
    inside = math.exp((1 - share) * math.log(usual.low) + share * math.log(usual.high))
    inside = min(max(inside, usual.low), usual.high)
    assert usual.note("key", inside) is None
    for value in (usual.low / beyond, usual.high * beyond):
        note = usual.note("table.key", value)
        assert note.where == "table.key"
        assert note.values["quantity"] == usual.quantity


@pytest.mark.parametrize(("amplitude", "unusual"), [(15, True), ("15 deg", False), ("180 deg", False)])
def test_an_amplitude_of_degrees_without_unit_is_said(amplitude, unusual):
    bush = {"element": "plain-bush", "shaft_diameter": "20 mm", "clearance": "40 um", "length": "20 mm"}
    bush |= {"radial_load": "500 N", "first": STEEL, "second": "pom", "name": "bush"}
    bush |= {"oscillation": {"amplitude": amplitude, "frequency": "1 Hz"}}
    said = [note for note in load_element(bush).notes() if note.where == "oscillation.amplitude"]
    assert ['write "15 deg"' in note for note in said] == [True] * unusual


def test_a_key_has_one_range_and_a_quantity_one_entry():
    assert len({usual.quantity for usual in RANGES}) == len(RANGES)
    assert sum(len(usual.keys) for usual in RANGES) == len(BY_KEY)


def test_a_small_mean_pressure_is_meant_in_megapascal():
    for key, unit in (("contact.mean_pressure", "MPa"), ("contact.hertz_pressure", "GPa")):
        assert f'write "20 {unit}"' in range_of_key(key).note(key, 20.0)


@pytest.mark.internal
@pytest.mark.parametrize(("value", "proposed"), [(141e-6, "141 nm"), (0.2, "0.2 um"), (141.0, "141 nm")])
def test_the_number_is_proposed_as_it_was_written(value, proposed):
    """Of "141 um" it proposed "0.000141 um", which nobody means."""
    assert f'write "{proposed}"' in range_of_key("rms_height").note("rms_height", value)


def test_the_table_of_a_key_and_its_unit_decide_between_ranges():
    assert range_of_key("oil.density").quantity == "density of a liquid"
    assert range_of_key("lower.layers[1].material.density").quantity == "density"
    assert range_of_key("speed", "rad/s").quantity == "speed of rotation"
    assert range_of_key("motion.speed", "m/s").quantity == "speed"
    assert range_of_key("contact.hardness", "m") is None
    assert range_of_key("description") is None


def test_of_a_list_the_farthest_value_at_either_end_is_told():
    speed = BY_KEY["speed"]
    values = [("speeds[0]", speed, 1e-15), ("speeds[1]", speed, 1e-12), ("speeds[2]", speed, 1.0)]
    values += [("speeds[3]", speed, 300.0), ("speeds[4]", speed, -900.0)]
    low, high = notes_on(values)
    assert low.startswith("speeds[0]")
    assert high.startswith("speeds[4]")


CASES = [
    (("traction-curve", "roller.hertz_pressure=1.2"), "roller.hertz_pressure", "1.2 GPa"),
    (("traction-curve", 'rolling.mean_speed="200 m/s"'), "rolling.mean_speed", "200 m/s"),
    (("stribeck-mineral-oil", "lower.material.poissons_ratio=0.03"), "lower.material.poissons_ratio", "metals 0.25"),
    (("hertz-sphere", 'upper.material.hardness="200 Pa"'), "upper.material.hardness", "HV"),
    (("hertz-sphere", "shape.radius=10", 'grid.lengths="2 mm"', 'contact.load="100 N"'), "shape.radius", "10 mm"),
    (("hertz-sphere", "contact.friction=2"), "contact.friction", "rubber"),
    (("stribeck-mineral-oil", 'speeds.last="400 m/s"'), "speeds.last", "400 m/s"),
    (("film-start-stop", "oil.viscosity=80"), "oil.viscosity", "80 mPa*s"),
    (("film-start-stop", 'oil.pressure_viscosity="200 1/GPa"'), "oil.pressure_viscosity", "1/GPa"),
    (("tribofilm-macro", "rubbing.temperatures=[60]"), "rubbing.temperatures", "60 degC"),
    (("tribofilm-macro", 'film.wear_coefficient="3e5 1/s"'), "film.wear_coefficient", "3e+05 1/s"),
    (("tribofilm-macro", "film.activation_energy=0.8"), "film.activation_energy", "0.8 eV"),
    (("coated-sphere", 'lower.layer.thickness="0.1 nm"'), "lower.layer.thickness", "1e-10 m"),
    (("coated-sphere", "lower.layer.material.youngs_modulus=115.0"), "lower.layer.material.youngs", "115 GPa"),
    (("flash-temperature", "lower.material.heat_capacity=4.0"), "lower.material.heat_capacity", "J/(kg*K)"),
    (("wheel-rail", "over=", "roll.creepage=0.1"), "roll.creepage", '"0.1 %"'),
    (("rolling-creepage", 'over={"roll.creepage_across"=[0.0, -0.2]}'), "roll.creepage_across", '"-0.2 %"'),
    (("hertz-sphere", 'shape.radius="20 nm"', 'contact.load="0.1 nN"', 'grid={shape=64, spacing="0.1 nm"}'),
     "grid.spacing", "atoms"),
]  # fmt: skip


@pytest.mark.parametrize(("source", "key", "words"), CASES)
def test_a_value_of_another_unit_is_told_with_its_key_and_what_may_be_meant(source, key, words):
    found = [note for note in fired(*source) if note.startswith(key)]
    assert len(found) == 1, fired(*source)
    assert words in found[0]


def test_a_rigid_stand_in_has_no_modulus_to_be_told_of():
    stiff = 'lower.material={name="rigid flat", youngs_modulus="3 TPa", poissons_ratio=0.3}'
    assert fired("hertz-sphere", stiff) == []
    assert fired("hertz-sphere", stiff.replace("rigid flat", "very stiff"))


def test_an_element_is_told_of_its_own_keys():
    bearing = {
        "element": "rolling-bearing", "bore": "40 mm", "outside": "80 mm", "diameter": "11.9 mm", "count": 9,
        "radial_load": "4 kN", "speed": "3000 rpm", "first": STEEL, "second": STEEL,
    }  # fmt: skip
    assert notes_on_table(load_element(bearing).model) == []
    odd = bearing | {"speed": "1e6 rpm", "first": {"catalogue": STEEL, "poissons_ratio": 0.03}}
    told = [note.partition(":")[0] for note in load_element(odd).notes()]
    assert {"speed", "first.poissons_ratio"} <= set(told)


ROLLER = {"load": 1e5, "radius": 0.01, "contact_modulus": 115e9, "speeds": (1.0, 1.0), "points": 200}
OIL = Lubricant(0.08, pressure_viscosity=20e-9, density_law="incompressible")


def told(film):
    return [note.removeprefix(ARGUMENT).partition(":")[0] for note in film.notes if note.startswith(ARGUMENT)]


def test_a_film_of_centistokes_at_a_thousand_metres_a_second_is_told():
    """It was a converged film of 2.27 mm without a word."""
    assert told(solve_line_film(**ROLLER, lubricant=OIL)) == []
    film = solve_line_film(
        **ROLLER | {"speeds": (1000.0, 1000.0)}, lubricant=Lubricant(80.0, density_law="incompressible")
    )
    assert film.status is Status.CONVERGED
    assert told(film) == ["speeds", "lubricant.viscosity"]
    assert any(note.startswith(OUTSIDE) and "radius" in note for note in film.notes)


def test_a_point_film_is_told_of_its_arguments():
    case = {"load": 20.0, "radii": (0.01, 0.01), "contact_modulus": 115e9, "shape": (32, 32), "speeds": (1.0, 1.0)}
    assert told(solve_point_film(**case, lubricant=OIL)) == []
    odd = Body(Material("odd", youngs_modulus=210e9, poissons_ratio=0.03))
    film = solve_point_film(**case | {"speeds": (200.0, 200.0), "bodies": (odd, odd)}, lubricant=OIL)
    assert told(film)[0] == "speeds"
    assert "bodies[0].material.poissons_ratio" in told(film)


STEADY = {"load": lambda t: 1e5, "speeds": lambda t: (1.0, 1.0)}


def test_a_march_of_a_line_film_is_told_of_centistokes_given_as_pascal_seconds():
    case = {"times": np.array([0.0, 1e-3]), **STEADY, "radius": 0.01, "contact_modulus": 115e9, "points": 151}
    assert [told(film) for film in march_line_film(**case, lubricant=OIL)] == [[], []]
    films = march_line_film(**case, lubricant=Lubricant(80.0, density_law="incompressible"))
    assert [told(film) for film in films] == [["lubricant.viscosity"]] * 2
    assert all("mPa*s" in film.notes[0] for film in films)


def test_a_march_of_a_point_film_is_told_of_millimetres_given_as_metres():
    def found(load, radius):
        case = {"times": np.array([0.0, 1e-3]), **STEADY, "load": lambda t: load, "contact_modulus": 115e9}
        return [told(film) for film in march_point_film(**case, radii=(radius,) * 2, shape=(32, 32), lubricant=OIL)]

    assert found(20.0, 0.01) == [[], []]
    assert found(2e4, 10.0) == [["radii"]] * 2


def steel(**changes):
    return Body(Material("steel", **{"youngs_modulus": 210e9, "poissons_ratio": 0.3, "hardness": 2e9} | changes))


def test_a_contact_is_told_of_gigapascals_given_as_pascals_and_of_micrometres_given_as_metres():
    def found(grid, body, load):
        gap = (grid.x[:, None] ** 2 + grid.y[None, :] ** 2) / 0.02
        return told(solve_contact(gap, displacement_operator(grid, body), load=load))

    small = Grid((16, 16), (5e-6, 5e-6))
    assert found(small, steel(), 1e-2) == []
    assert found(small, steel(youngs_modulus=210.0), 1e-8) == ["bodies[0].material.youngs_modulus"]
    assert found(Grid((16, 16), (5.0, 5.0)), steel(), 1e-2) == ["grid.spacing"]


def test_a_wear_loop_is_told_of_gigapascals_given_as_pascals():
    grid = Grid((16, 16), (0.2e-6, 0.2e-6), periodic=(True, True))
    rough = generate_surface(grid, rms_height=20e-9, correlation_length=0.6e-6, seed=1)
    depths = np.linspace(0.0, 1e-6, 6)
    case = {"grid": grid, "load": 80e6 * grid.area, "friction": 0.1, "depths": depths, "cycles": 1}

    def found(lower, upper):
        return told(run_in(rough, np.zeros(grid.shape), bodies=(lower, upper), **case))

    assert found(steel(), steel(hardness=6e9)) == []
    stiff = steel(hardness=6e9, youngs_modulus=210e18)  # gigapascals written behind gigapascals
    assert found(steel(), stiff) == ["bodies[1].material.youngs_modulus"]


@pytest.mark.parametrize("grow", [grow_tribofilm, grow_local_film])
def test_a_tribofilm_is_told_of_electron_volts_given_as_joules(grow):
    grid = Grid((8, 8), (1e-6, 1e-6), periodic=(True, True))
    gap = 1e-8 * np.cos(2 * math.pi * grid.x / 8e-6)[:, None] * np.ones(8)

    def found(energy, volume):
        contact = FilmContact(
            gap, grid, steel().material, None, 1e8 * grid.area, StressActivatedGrowth(1e-2, energy, volume),
            hardness=lambda thickness, temperature: 2e9, modulus=lambda thickness, temperature: 200e9,
            temperature=373.15,
        )  # fmt: skip
        return told(grow(np.array([0.0, 1.0, 2.0]), contact, wear_coefficient=1e-3))

    assert found(0.8 * ELECTRON_VOLT, 1e-29) == []
    assert found(0.8, 1e-29) == ["contact.growth.activation_energy"]


def test_arguments_left_out_and_zeros_are_usual():
    assert notes_on_arguments({"bulk": ("temperature", None), "speeds": ("speed", (0.0, 1.0))}) == ()


def test_a_run_says_it_once(tmp_path):
    ball = oiled_ball("point-film", {"radius": "10 mm", "load": "20 N"}, {"viscosity": 80.0}, film={"cells": 32})
    ball |= {"rolling": {"mean_speed": "1 mm/s"}}
    assert any(note.startswith("oil.viscosity") for note in scene_warnings(examine(plan_scene(ball)[0])))
    notes = run_scene(ball, tmp_path / "run", figures=False).summary["notes"]
    assert sum("viscosity" in note["text"] and note["code"].startswith("value-unusual") for note in notes) == 1


def test_a_friction_beyond_any_bound_is_outside_the_model():
    """A friction of 8.9 was converged, a note in the middle of others."""
    grid = Grid((48, 12), (0.8e-6, 0.8e-6), periodic=(False, True))
    height = generate_surface(grid, rms_height=50e-9, correlation_length=3e-6, seed=1)
    case = {"height": height, "grid": grid, "bodies": Body(Material("steel", youngs_modulus=210e9, poissons_ratio=0.3))}
    case |= {"radius": 2e-3, "width": 6e-3, "load": 5.5, "boundary_friction": 0.12, "film_points": 200}
    thick = Lubricant(1.0, pressure_viscosity=20e-9, density_law="incompressible")
    found = solve_mixed(**case | {"load": 0.01}, speeds=(1.0, 0.0), lubricant=thick)
    assert found.friction > 1
    assert any("Friction" in said for said in outside(found.notes))
    status = next(line for line in repr(found).splitlines() if "status=" in line)
    assert "outside the model" in status
    assert "Friction" in status
    usual = solve_mixed(
        **case, speeds=(0.2, 0.0), lubricant=Lubricant(0.08, pressure_viscosity=20e-9, density_law="incompressible")
    )
    assert usual.friction < 1
    assert not any("Friction" in said and "bound" in said for said in outside(usual.notes))
    assert not told(usual)


def test_values_of_the_key_over_are_told(tmp_path):
    over = {"shape.radius": ["10 mm", "20 m"]}
    assert [note.partition(":")[0] for note in fired(library()["hertz-sphere"] | {"over": over})] == ["shape.radius"]
    small = library()["hertz-sphere"] | {"grid": {"shape": 16, "lengths": "400 um"}, "over": over}
    notes = run_scene(small, tmp_path / "run", figures=False).summary["notes"]
    assert sum(note["where"] == "shape.radius" and note["code"].startswith("value-unusual") for note in notes) == 1
