"""A plain bush: p v, friction, heat and wear by hand; life against a bush that is worn step by step."""

import functools
import math
import re
import tomllib
from dataclasses import replace

import numpy as np
import pytest
from command_line import run_command

from bem import InputError, plan_scene, run_scene
from bem.app.element_form import answered, file_of
from bem.contact.shaft_in_bush import ShaftInBush
from bem.elements.answer import all_notes, answer, answer_notes, balance_heat, scene_notes, table_columns
from bem.elements.bush_polymers import DRY_FRICTION as DRY_FRICTIONS
from bem.elements.cases import columns
from bem.elements.element import element_template, load_element
from bem.elements.figure import element_figure
from bem.elements.plain_bush import WORN_IN, crescent_distance, sliding_to_depth
from bem.elements.running import run_all
from bem.elements.scene_text import element_scene_text
from bem.materials import contact_modulus
from bem.notes import Level
from bem.notes.checks import CAP_NOT_OF_SOFTER, CYLINDER_NARROW, HARDNESS_UNLIKELY, SLOPES_LARGE
from bem.notes.elements import (
    BUSH_BOUNDS,
    BUSH_CONFORMS,
    BUSH_FLOATS,
    BUSH_LEAKS,
    BUSH_LIQUID_LOST,
    BUSH_OVER_LIMIT,
    BUSH_ROUGHNESS_MISSING,
    BUSH_SWELLS,
    BUSH_SWINGS,
    BUSH_TOUCHES,
    BUSH_WARMER_THAN_OIL,
    BUSH_WEARS_IN_FILM,
    GLYCOL_ASSUMED,
    NO_HEAT,
    VISCOSITY_FIXED,
)
from bem.notes.general import VALUE_UNUSUAL
from bem.quantities import si
from bem.reference_solutions.journal_bearing import journal_film, sommerfeld_number
from bem.scenes.checks import examine, scene_warnings
from bem.scenes.checks.overview import common
from bem.scenes.checks.plausible import notes_over
from bem.scenes.edit import table_text
from bem.scenes.load import load_scene

TEMPLATE = tomllib.loads(element_template("plain-bush")) | {"name": "bush"}
WATER = {key: value for key, value in TEMPLATE.items() if key != "heat_balance"}
DRY = {key: value for key, value in WATER.items() if key != "oil"}
THIN = {"viscosity": "0.653 mPa*s", "pressure_viscosity": "0 1/GPa"}
DRY_FRICTION = DRY_FRICTIONS["peek"].value
WORN = DRY | {"specific_wear_rate": "1e-6 mm^3/(N*m)", "permitted_wear": "0.1 mm"}


def without(table, *keys):
    return {key: value for key, value in table.items() if key not in keys}


def codes(notes):
    return [note.code for note in notes]


def test_pressure_and_speed_by_hand():
    model = load_element(DRY).model
    assert model.mean_pressure == pytest.approx(500 / (0.02 * 0.02))
    assert model.sliding_speed == pytest.approx(math.pi * 0.02 * 5)
    said = dict(answer(load_element(DRY | {"pv_limit": "0.2 MPa*m/s"}), ()))
    assert said["pressure x velocity"].startswith("0.393 MPa m/s")
    assert "safety factor 0.509" in said["pressure x velocity"]
    assert "no limit given" in dict(answer(load_element(DRY), ()))["pressure x velocity"]
    swings = without(DRY, "speed")
    swings |= {
        "oscillation": {"amplitude": "90 deg", "frequency": "5 1/s"}
    }  # as far as a whole turn, five times a second
    assert load_element(swings).model.sliding_speed == pytest.approx(model.sliding_speed)


def test_heat_of_a_dry_bush_by_hand():
    power = DRY_FRICTION * 500 * math.pi * 0.02 * 5
    cooled = load_element(DRY | {"heat_balance": {"conductance": "1 W/K", "ambient": "30 degC"}})
    said = dict(answer(balance_heat(cooled), ()))
    assert said["friction power"].startswith(f"{power:.3g} W")
    assert f"bush {30 + power:.3g} °C" in said["temperatures"]
    assert codes(answer_notes(cooled, ())) == [BUSH_SWELLS.code]
    hot = answer_notes(load_element(DRY), ())
    assert codes(hot) == [BUSH_OVER_LIMIT.code, BUSH_SWELLS.code]
    assert hot[0].values["value"] == pytest.approx(20 + power / (15 * 15 * 0.02 * 0.02))
    slick = load_element(DRY | {"friction": 0.05, "pv_limit": "0.39 MPa*m/s"})
    assert codes(answer_notes(slick, ())) == [BUSH_OVER_LIMIT.code, BUSH_SWELLS.code]
    assert answer_notes(slick, ())[0].values["ratio"] == pytest.approx(math.pi / 8 / 0.39)
    assert (
        "limit 100 °C (given)"
        in dict(answer(load_element(DRY | {"maximum_temperature": "100 degC"}), ()))["temperatures"]
    )


@pytest.mark.parametrize(("bush", "limit"), [("pom", 100), ("pa66", 100), ("ptfe", 260), ("peek", 250)])
def test_polymers_have_limit_temperatures(bush, limit):
    """Each is above its limit one kelvin beyond it and not one below, and a given limit takes its place."""
    for beyond in (-1, 1):
        element = load_element(DRY | {"second": bush, "bulk_temperature": f"{limit + beyond} degC"})
        notes = [note for note in answer_notes(element, ()) if note.code == BUSH_OVER_LIMIT.code]
        assert len(notes) == (beyond > 0)
        assert f"limit {limit} °C (" in dict(answer(element, ()))["temperatures"]
    assert "soften or melt" in notes[0].headline
    given = load_element({**element.table, "maximum_temperature": "60 degC"})
    (note,) = [note for note in answer_notes(given, ()) if note.code == BUSH_OVER_LIMIT.code]
    assert "maximum_temperature" in note.headline


@pytest.mark.parametrize("wall", [0.3e-3, 2e-3, 10e-3])
def test_the_expansion_that_closes_the_clearance_is_that_of_finite_differences(wall):
    """Navier's equation along the radius in plane strain: free bore, outside held, with an error of second order."""
    warm = 60.0
    model = load_element(DRY | {"wall": f"{1e3 * wall} mm"}).model
    found = model.closing_expansion(293.15 + warm)
    ratio, nodes = model.second.build().poissons_ratio, 401
    radius, step = np.linspace(model.bodies.radius, model.bodies.radius + wall, nodes, retstep=True)
    matrix, right = np.zeros((nodes, nodes)), np.zeros(nodes)
    inner = np.arange(1, nodes - 1)
    matrix[inner, inner - 1] = 1 / step**2 - 1 / (2 * step * radius[inner])
    matrix[inner, inner] = -2 / step**2 - 1 / radius[inner] ** 2
    matrix[inner, inner + 1] = 1 / step**2 + 1 / (2 * step * radius[inner])
    matrix[0, :3] = (1 - ratio) * np.array([-1.5, 2, -0.5]) / step
    matrix[0, 0] += ratio / radius[0]
    right[0] = (1 + ratio) * found * warm
    matrix[-1, -1] = 1
    assert np.linalg.solve(matrix, right)[0] == pytest.approx(-model.radial_clearance, rel=1e-4, abs=0)
    if wall < 1e-3:
        thin = (1 + ratio) / (1 - ratio) * found * warm * wall
        assert thin == pytest.approx(model.radial_clearance, rel=0.03, abs=0)


def test_thermal_expansion_is_said_of_warm_polymer_walls_alone():
    warm = {"bulk_temperature": "60 degC"}
    for change, swells in (
        ({}, True),
        ({"clearance": "400 um"}, False),
        ({"wall": None, "housing": None}, False),
        ({"bulk_temperature": "20 degC"}, False),
        ({"second": "phosphor-bronze"}, False),
    ):
        table = {key: value for key, value in (DRY | warm | change).items() if value is not None}
        assert (BUSH_SWELLS.code in codes(answer_notes(load_element(table), ()))) == swells


def test_a_lubricated_bush_has_a_film_and_its_friction():
    element = load_element(without(WATER, "wall", "housing") | {"thermal": "off"})
    runs = run_all(element)
    said = dict(answer(element, runs))
    assert len(runs) == 1
    # the film of soft bodies in a liquid whose viscosity does not rise with pressure
    assert runs[0].minimum_film == pytest.approx(element.columns()["minimum_film [m]"][0], rel=0.05)
    assert "of film and asperities, by kind friction" in said["friction power"]
    assert float(said["friction power"].split()[0]) < 0.2 * DRY_FRICTION * 500 * element.model.sliding_speed
    notes = element.notes()
    assert BUSH_CONFORMS.code in codes(notes)
    assert SLOPES_LARGE.code not in codes(notes)
    light = load_element(WATER | {"radial_load": "20 N"})
    assert BUSH_CONFORMS.code not in codes(light.notes())
    swings = without(WATER, "speed") | {"oscillation": {"amplitude": "20 deg", "frequency": "2 Hz"}}
    assert BUSH_SWINGS.code in codes(load_element(swings).notes())


def test_a_given_friction_heats_a_lubricated_bush():
    """The balance is that of the given coefficient, at which the film is then solved."""
    balance = {"conductance": "2 W/K", "ambient": "30 degC"}
    element = balance_heat(load_element(WATER | {"friction": 0.1, "heat_balance": balance}))
    power = 0.1 * 500 * element.model.sliding_speed
    assert element.model.bulk_temperature == pytest.approx(303.15 + power / 2, abs=0.2)
    said = dict(answer(element, ()))
    assert said["friction power"].startswith(f"{power:.3g} W")
    assert f"bush {30 + power / 2:.3g} °C" in said["temperatures"]


def test_the_usual_conductance_balances_a_lubricated_bush():
    """Film, friction and temperature are of one state, also with a balance that gives the surroundings alone."""
    for change, around in (({}, 40), ({"heat_balance": {"ambient": "30 degC"}}, 30)):
        element = balance_heat(load_element(WATER | {"thermal": "off", "radial_load": "100 N"} | change))
        model = element.model
        assert model.conductance == pytest.approx(15 * 15 * 0.02 * 0.02)
        runs = run_all(element)
        found = table_columns(element, runs)
        balanced = 273.15 + around + found["friction_power_with_asperities [W]"][0] / model.conductance
        assert model.bulk_temperature == pytest.approx(balanced, abs=0.3)
        assert model.film_oil.temperature == pytest.approx(model.bulk_temperature)
        assert "assumed" in dict(answer(element, runs))["temperatures"]
        assert BUSH_WARMER_THAN_OIL.code not in codes(answer_notes(element, runs))


def sommerfeld_by_differences(eccentricity, slenderness, *, around=160, along=16):
    """Sommerfeld number and friction times R/c of a journal bearing: Reynolds' equation by over-relaxation."""
    angle = np.linspace(0, 2 * math.pi, around + 1)
    step, slice_length = angle[1], 1 / along
    half = (1 + eccentricity * np.cos(angle[:-1] + step / 2)) ** 3 / step**2
    gap = 1 + eccentricity * np.cos(angle)
    east, west = half[1:, None], half[:-1, None]
    axial = (gap[1:-1] ** 3 / slenderness**2 / slice_length**2)[:, None]
    wedge = eccentricity * np.sin(angle[1:-1])[:, None]
    pressure = np.zeros((around + 1, along + 1))
    chequer = [(np.add.outer(np.arange(1, around), np.arange(along)) % 2) == colour for colour in (0, 1)]
    for _ in range(3000):
        change = 0.0
        for cells in chequer:
            inner = pressure[1:-1]
            beside = np.concatenate([inner[:, 1:2], inner[:, :-2]], axis=1) + inner[:, 1:]
            new = east * pressure[2:, :-1] + west * pressure[:-2, :-1] + axial * beside + wedge
            new = np.maximum(-0.8 * inner[:, :-1] + 1.8 * new / (east + west + 2 * axial), 0)
            moved = np.where(cells, new - inner[:, :-1], 0)
            pressure[1:-1, :-1] += moved
            change = max(change, float(np.abs(moved).max()))
        if change < 1e-7:
            break
    mean = (pressure.sum(axis=1) - 0.5 * pressure[:, 0]) * slice_length
    load = 6 * math.hypot(float(mean @ np.cos(angle)), float(mean @ np.sin(angle))) * step
    sheared = np.sum(1 / gap[:-1]) * step + 1.5 * np.sum((gap[1:] + gap[:-1]) * np.diff(mean))
    return 1 / (math.pi * load), sheared / load


@pytest.mark.parametrize(
    ("eccentricity", "slenderness", "number", "friction"),
    [(0.6, 1, 0.121, 3.22), (0.8, 1, 0.0446, 1.70), (0.9, 1, 0.0188, 1.05), (0.8, 0.5, 0.0923, 3.26)],
)  # of Raimondi and Boyd, from memory
def test_the_journal_bearing_is_that_of_finite_differences(eccentricity, slenderness, number, friction):
    found, sheared = sommerfeld_by_differences(eccentricity, slenderness)
    assert found == pytest.approx(number, rel=0.02)
    assert sheared == pytest.approx(friction, rel=0.02)
    assert 0.86 < sommerfeld_number(eccentricity, slenderness) / found < 0.95
    radius, clearance, length, viscosity, speed = 12.5e-3, 30e-6, 25e-3 * slenderness, 0.05, 0.3
    load = viscosity * speed * length * radius**2 / (math.pi * found * clearance**2)
    film = journal_film(
        load=load, radius=radius, clearance=clearance, length=length, viscosity=viscosity, sliding_speed=speed
    )
    assert 1.0 < film.minimum_thickness / (clearance * (1 - eccentricity)) < 1.13
    assert film.friction * radius / clearance == pytest.approx(sheared, rel=0.08)


def test_a_film_as_thick_as_that_of_a_journal_bearing_is_outside_the_model():
    """Lambda has two digits and the estimate of a journal bearing beside it; the formula takes the thickest regime."""
    thick = {"grade": "ISO VG 32", "temperature": "25 degC"}
    peek = {"bore": "25 mm", "clearance": "60 um", "wall": "3 mm", "radial_load": "800 N", "speed": "250 rpm"}
    element = load_element(without(WATER, "shaft_diameter") | peek | {"oil": thick, "thermal": "off"})
    runs = run_all(element)
    (note,) = [note for note in answer_notes(element, runs) if note.code == BUSH_FLOATS.code]
    assert note.level is Level.OUTSIDE_MODEL
    assert 1.5 < note.values["film"] / note.values["journal"] < 2.1
    assert note.values["turning"] > note.values["friction"]
    thicker, lower = (note.values[a] / note.values[b] for a, b in (("film", "journal"), ("friction", "turning")))
    assert f"The film is {thicker:.2g} times that of the journal estimate, the friction {lower:.2g} times" in note
    given = load_element(without(WATER, "shaft_diameter") | peek | {"oil": thick, "thermal": "off", "friction": 0.3})
    (same,) = [one for one in answer_notes(given, runs) if one.code == BUSH_FLOATS.code]
    assert same.values == note.values
    assert "journal bearing" in dict(answer(element, runs))["lambda ratio"]
    assert element.columns()["minimum_film [m]"][0] == pytest.approx(runs[0].minimum_film, rel=0.2)
    thin = load_element(WATER | {"thermal": "off"})
    films = run_all(thin)
    assert BUSH_FLOATS.code not in codes(answer_notes(thin, films))
    estimates = columns([element, thin], [runs, films])["journal_bearing_film_estimate [m]"]
    assert estimates[0] == note.values["journal"]
    assert math.isnan(estimates[1])
    assert "journal_bearing_film_estimate [m]" not in columns([thin], [films])
    assert BUSH_LEAKS.code in codes(all_notes(thin, films))


LIGHT = without(WATER, "shaft_diameter") | {
    "bore": "20 mm", "clearance": "60 um", "length": "20 mm", "wall": "1.5 mm", "radial_load": "20 N",
    "speed": "300 rpm", "second": "pa66", "rms_roughness": "0.4 um", "thermal": "off", "bulk_temperature": "40 degC",
    "oil": {"grade": "ISO VG 32", "temperature": "40 degC"},
}  # fmt: skip
"""Bush whose film would be thicker than its radial clearance of 30 um."""
LIGHT_WATER = without(LIGHT, "bulk_temperature", "rms_roughness") | {
    "radial_load": "600 N", "friction": 0.1, "oil": {"grade": "water", "temperature": "25 degC"},
}  # fmt: skip
"""Bush that water does not cool, as its heat is taken to go to still air."""


def test_a_film_thicker_than_the_clearance_is_that_of_a_journal_bearing(tmp_path):
    """Answer, tables and cases have film, lambda ratio and friction of the estimate; the scene's run says that its film
    is impossible."""
    element = load_element(LIGHT)
    runs = run_all(element)
    journal = journal_film(
        load=20, radius=10e-3, clearance=30e-6, length=20e-3, viscosity=element.model.film_oil.build().viscosity,
        sliding_speed=math.pi * 5 * (20e-3 - 60e-6),
    )  # fmt: skip
    assert runs[0].impossible_film > 60e-6
    assert runs[0].minimum_film == pytest.approx(journal.minimum_thickness, rel=1e-9, abs=0)
    assert runs[0].film_ratio == pytest.approx(journal.minimum_thickness / 0.4e-6, rel=1e-9, abs=0)
    power = journal.friction * 20 * element.model.sliding_speed
    (note,) = [note for note in all_notes(element, runs) if note.level is Level.OUTSIDE_MODEL]
    assert note.values["reason"] == "beyond"
    rows = dict(answer(element, runs))
    assert rows["lambda ratio"].startswith(
        f"outside the model, about {runs[0].film_ratio:.2g}: minimum film about 20 um"
    )
    assert rows["friction power"].startswith(
        f"about {power:.2g} W (friction coefficient about {journal.friction:.2g} by"
    )
    found, heavy = columns([element, load_element(WATER)], [runs, run_all(load_element(WATER))]), 1
    assert found["solved_minimum_film [m]"][0] == runs[0].minimum_film
    assert found["friction_power [W]"][0] == pytest.approx(power, rel=1e-9, abs=0)
    assert math.isnan(found["minimum_film [m]"][0])
    assert found["minimum_film [m]"][heavy] > 0
    assert all(
        math.isnan(table_columns(element, runs)[name][0]) for name in ("minimum_film [m]", "film_over_roughness")
    )
    (tmp_path / "light.toml").write_text(table_text(LIGHT))
    (tmp_path / "loads.csv").write_text("radial_load [N]\n20\n600\n")
    bem = functools.partial(run_command, cwd=tmp_path)
    light, thick = bem("element", "light.toml", "--cases", "loads.csv").stdout.splitlines()[-2:]
    assert light.count("about") == 5
    assert re.search(r"about 20 µm +about 20 µm +about 49", light)
    assert thick.count("about") == 3
    made = bem("element", "light.toml", "--scene", "light-film.toml")
    said = made.stdout + made.stderr
    assert "1 outside the model\n" in said
    assert "Film, lambda ratio and friction do not hold" in said
    assert "caution" not in said
    assert "impossible" in (tmp_path / "light-film.toml").read_text()


def test_a_heat_balance_where_the_film_just_fills_the_clearance():
    """The friction jumps there, so that no temperature balances the heat: the answer is that of the jump."""
    hot = without(LIGHT, "bulk_temperature") | {
        "radial_load": "60 N", "speed": "1500 rpm", "wall": "2 mm", "heat_balance": {"conductance": "0.015 W/K"},
        "oil": {"grade": "ISO VG 32", "temperature": "30 degC"},
    }  # fmt: skip
    element = balance_heat(load_element(without(hot, "rms_roughness")))
    (one,) = run_all(element)
    assert (one.impossible_film or one.minimum_film) == pytest.approx(30e-6, rel=0.01, abs=0)
    assert "the friction jumps" in dict(answer(element, [one]))["temperatures"]
    slightly = balance_heat(load_element(without(hot, "rms_roughness") | {"heat_balance": {"conductance": "0.02 W/K"}}))
    assert "jumps" not in dict(answer(slightly, run_all(slightly)))["temperatures"]


@pytest.mark.parametrize("kind", ["contact", "friction", "running-in", "traction", "surface-temperature"])
def test_the_radius_of_a_close_bush_s_cylinder_is_not_doubted(kind):
    """Bore and clearance of the scene confirm 30 m, which was taken for a wrong unit; without them it is doubted."""
    close = {"shaft_diameter": "60 mm", "clearance": "60 um", "length": "60 mm", "radial_load": "3 kN"}
    element = load_element(WATER | close | {"oil": {"grade": "ISO VG 32", "temperature": "40 degC"}})
    scene = element.scene(element.worst(), kind)
    key = {"traction": "roller", "contact": "shape", "surface-temperature": "shape"}.get(kind, "contact")
    assert scene[key]["radius"] == pytest.approx(30.03)
    doubted = [
        [note for note in notes_over(load_scene(one)) if note.code == VALUE_UNUSUAL.code and "radius" in note.where]
        for one in (scene, without(scene, "bush"))
    ]
    assert [len(one) for one in doubted] == [0, 1]
    with pytest.raises(InputError, match=f"{key}.radius is not that of bush.bore"):
        load_scene(scene | {key: scene[key] | {"radius": "3 m"}})


def test_the_run_of_a_bush_s_running_in_says_that_its_film_is_too_thick(tmp_path):
    """They were in the description alone. The film is that of the element, on the wall as a layer."""
    element = load_element(LIGHT | {"radial_load": "600 N"})
    scene = element.scene(element.worst(), "running-in")
    scene["cycles"] = {"count": 4, "averaged": 2, "settled": 2}
    done = run_scene(scene, tmp_path / "run", figures=False).summary
    (said,) = (note["text"] for note in done["notes"] if note["code"] == BUSH_FLOATS.code)
    (answered,) = (note for note in all_notes(element, run_all(element)) if note.code == BUSH_FLOATS.code)
    assert si(answered.values["film"], "m") in said
    assert si(answered.values["journal"], "m") in said


@pytest.mark.parametrize(("kind", "places"), [("traction", "roller.radius"), ("friction", "contact.radius")])
def test_the_run_of_a_bush_s_scene_says_that_its_film_is_too_thick(kind, places, tmp_path):
    """At any speed by the bush that the scene names; a cylinder of another radius is not its equivalent."""
    element = load_element(LIGHT | {"radial_load": "600 N"})
    scene = element.scene(element.worst(), kind) | {"outputs": {"errors": False}}
    assert "at 313 mm/s" in scene["description"]
    if kind == "friction":
        scene |= {
            "speeds": {"values": ["20 mm/s", "0.1 m/s", "1 m/s"], "slide_roll_ratio": 2.0},
            "film": {"points": 200},
        }
    found = run_scene(scene, tmp_path / "run", figures=False)
    notes = {note["code"]: note for note in found.summary["notes"]}
    assert notes[BUSH_FLOATS.code]["where"] == ("speed 1 m/s" if kind == "friction" else "")
    assert (BUSH_BOUNDS.code in notes) == (kind == "friction")
    assert found.summary["outside_model"]
    (answered_note,) = [note for note in all_notes(element, run_all(element)) if note.code == BUSH_FLOATS.code]
    if kind == "traction":
        assert notes[BUSH_FLOATS.code]["text"] == str(answered_note)
    table, key = places.split(".")
    with pytest.raises(InputError, match=f"{places} is not that of bush.bore"):
        load_scene(scene | {table: scene[table] | {key: "3 m"}})
    with pytest.raises(InputError, match="clearance is not below the bore"):
        load_scene(scene | {"bush": {"bore": "20 mm", "clearance": "30 mm"}})


def test_a_film_that_reaches_far_around_stands_between_two_bounds():
    """Between c/30 and c/10 the journal bearing's film is the lower bound: answer, cases, note and written scenes."""
    table = without(WATER, "shaft_diameter") | {
        "bore": "30 mm", "clearance": "80 um", "length": "25 mm", "wall": "2.5 mm", "radial_load": "1.2 kN",
        "speed": "150 rpm", "second": "pa66", "rms_roughness": "0.3 um", "thermal": "off",
        "oil": {"grade": "ISO VG 46", "temperature": "50 degC"},
    }  # fmt: skip
    element = load_element(table)
    runs = run_all(element)
    found = all_notes(element, runs)
    (note,) = [note for note in found if note.code == BUSH_BOUNDS.code]
    journal = journal_film(
        load=1200, radius=15e-3, clearance=40e-6, length=25e-3, viscosity=element.model.film_oil.build().viscosity,
        sliding_speed=element.model.sliding_speed,
    )  # fmt: skip
    assert note.values["journal"] == pytest.approx(journal.minimum_thickness, rel=1e-9, abs=0)
    assert note.values["journal"] < 0.5 * note.values["film"] == 0.5 * runs[0].minimum_film
    assert note.values["turning"] > note.values["friction"]
    assert not {BUSH_FLOATS.code, BUSH_LEAKS.code} & set(codes(found))
    low, high = (f"{note.values[name] / 0.3e-6:.2g}" for name in ("journal", "film"))
    assert dict(answer(element, runs))["lambda ratio"].startswith(f"between about {low} and {high}: minimum film")
    turning = f"about {journal.friction:.2g} by an estimate as a full journal bearing"
    assert turning in dict(answer(element, runs))["friction power"]
    assert columns([element], [runs])["journal_bearing_film_estimate [m]"] == [note.values["journal"]]
    assert table_columns(element, runs)["journal_bearing_film_estimate [m]"] == [note.values["journal"]]
    for kind in ("traction", "friction"):
        about = element.scene(element.found.contacts[0], kind)["description"]
        assert "upper bound" in about
        assert "rigid journal bearing" in about
        assert "endless cylinder" not in about
    assert (
        "upper bound" not in load_element(WATER).scene(load_element(WATER).found.contacts[0], "traction")["description"]
    )


def test_a_film_outside_the_model_has_no_weaker_cautions(tmp_path):
    """Command, cases and page say that the shaft floats, not that its film is an estimate and an upper bound."""
    floating = {
        "shaft_diameter": "25 mm", "clearance": "60 um", "length": "20 mm", "wall": "3 mm", "radial_load": "800 N",
        "speed": "250 rpm", "first": "steel-52100", "second": "peek", "thermal": "off", "oil.grade": "ISO VG 32",
        "oil.temperature": "25 degC",
    }  # fmt: skip
    weaker = (BUSH_CONFORMS, BUSH_LEAKS)
    (tmp_path / "floats.toml").write_text(file_of("plain-bush", floating))
    (tmp_path / "cases.csv").write_text("speed [rpm]\n250\n10\n")
    assert {note.code for note in weaker} <= set(codes(load_element(tmp_path / "floats.toml").notes()))
    single = run_command("element", "floats.toml", cwd=tmp_path)
    page = " ".join(answered("plain-bush", floating).cautions)
    for shown in (single.stdout + single.stderr, page):
        assert BUSH_FLOATS.headline in shown
        assert not any(note.headline in shown for note in weaker)
    both = run_command("element", "floats.toml", "--cases", "cases.csv", cwd=tmp_path)
    said = " ".join((both.stdout + both.stderr).split())
    assert f"row 1: {BUSH_FLOATS.headline}" in said
    assert all(f"row 2: {note.headline}" in said for note in weaker)


def test_cases_of_a_lubricated_bush_are_solved_as_its_answer():
    cases = [
        balance_heat(load_element(WATER | {"radial_load": load, "heat_balance": {"conductance": "5 W/K"}}))
        for load in ("100 N", "500 N")
    ]
    runs = [run_all(one) for one in cases]
    found = columns(cases, runs)
    for row, (case, own) in enumerate(zip(cases, runs, strict=True)):
        one = table_columns(case, own)
        assert found["friction_power [W]"][row] == one["friction_power_with_asperities [W]"][0]
        assert found["bush_temperature [K]"][row] == one["bush_temperature [K]"][0]
        assert found["solved_film_over_roughness"][row] == own[0].film_ratio
        slid = case.model.radial_load * case.model.sliding_speed
        assert found["friction_coefficient"][row] == pytest.approx(found["friction_power [W]"][row] / slid)


@pytest.mark.parametrize(
    "change", [{"bulk_temperature": "60 degC"}, {"heat_balance": {"conductance": "0.5 W/K", "ambient": "60 degC"}}]
)
def test_the_oil_needs_no_temperature_beside_that_of_bush_or_surroundings(change):
    own, none = WATER | {"thermal": "off"}, {"grade": "water"}
    given = load_element(own | change | {"oil": none | {"temperature": "60 degC"}})
    left_out = load_element(own | change | {"oil": none})
    assert left_out.model.film_oil == given.model.film_oil
    assert left_out.model.surroundings == given.model.surroundings
    with pytest.raises(InputError, match="without temperature"):
        load_element(own | {"oil": none})


def test_the_template_stays_cool():
    """Its water does not boil, as it would with the usual conductance of still air."""
    element = balance_heat(load_element(TEMPLATE))
    assert 293 < element.model.bulk_temperature < 333
    assert BUSH_LIQUID_LOST.code not in codes(answer_notes(element, run_all(element)))


def test_a_bush_warmer_than_its_liquid_is_noted():
    """Not where conductance or ambience keep both within a few kelvin."""
    warm = load_element(WATER | {"thermal": "off", "heat_balance": {"conductance": "0.2 W/K", "ambient": "40 degC"}})
    note = next(note for note in answer_notes(warm, run_all(warm)) if note.code == BUSH_WARMER_THAN_OIL.code)
    assert note.values["oil"] == pytest.approx(40)
    assert 55 < note.values["bush"] < 100
    cooled = load_element(WATER | {"thermal": "off", "heat_balance": {"conductance": "2 W/K", "ambient": "40 degC"}})
    assert BUSH_WARMER_THAN_OIL.code not in codes(answer_notes(cooled, run_all(cooled)))


def test_a_given_viscosity_follows_the_bulk_temperature():
    """By its coefficient of temperature; without one it holds at the bulk temperature, or both temperatures agree."""
    softening = {"temperature": "40 degC", "temperature_viscosity": "0.02 1/K"}
    hot = load_element(WATER | {"bulk_temperature": "60 degC", "oil": THIN | softening})
    mixed = hot.scene(hot.worst(), "friction")["oil"]
    assert mixed["viscosity"] == pytest.approx(0.653e-3 * math.exp(-0.4))
    assert mixed["temperature"] == pytest.approx(333.15)
    assert hot.model.film_oil.build().viscosity == pytest.approx(mixed["viscosity"])
    fixed = load_element(WATER | {"bulk_temperature": "60 degC", "oil": THIN})
    assert "viscosity given is taken at this temperature" in dict(answer(fixed, ()))["temperatures"]
    assert fixed.scene(fixed.worst(), "friction")["oil"]["viscosity"] == pytest.approx(0.653e-3)
    with pytest.raises(InputError, match="bulk_temperature differs from"):
        load_element(WATER | {"bulk_temperature": "60 degC", "oil": THIN | {"temperature": "40 degC"}})
    given = WATER | {"friction": 0.1, "oil": THIN | {"temperature": "40 degC"}}
    balanced = balance_heat(load_element(given | {"heat_balance": {"conductance": "1 W/K"}}))
    assert VISCOSITY_FIXED.code in codes(balanced.notes())
    assert "by the heat balance" in dict(answer(balanced, ()))["temperatures"]


@pytest.mark.parametrize(("bulk", "reason"), [(99.5, None), (100.5, "boils"), (-1.0, "freezes"), (1.0, None)])
def test_a_liquid_that_boils_or_freezes_is_noted(bulk, reason):
    """Its film is then that of the liquid at the limit."""
    element = load_element(WATER | {"friction": 0.01, "bulk_temperature": f"{bulk} degC"})
    found = [note for note in answer_notes(element, ()) if note.code == BUSH_LIQUID_LOST.code]
    assert [reason in note for note in found] == ([] if reason is None else [True])
    assert element.model.film_oil.build().viscosity > 0
    own = THIN | {"heat_capacity": "4180 J/(kg*K)"}
    assert load_element(WATER | {"oil": own}).model.liquid_limits == element.model.liquid_limits
    assert load_element(WATER | {"oil": THIN}).model.liquid_limits is None


def test_a_scene_of_a_bush_says_that_its_liquid_boils(tmp_path):
    """No film is solved for the scene; the bush's own temperature tells it."""
    (tmp_path / "hot.toml").write_text(table_text(WATER | {"second": "pom", "bulk_temperature": "120 degC"}))
    made = run_command("element", "hot.toml", "--scene", "mixed.toml", "--kind", "friction", cwd=tmp_path)
    said = made.stdout + made.stderr
    assert "The liquid boils in the bush" in said
    assert "The bush becomes too hot" in said


def test_water_with_glycol_evaporates_before_it_boils():
    glycol = {"grade": "water-glycol 46", "temperature": "40 degC", "pressure_viscosity": "3 1/GPa"}
    element = load_element(WATER | {"friction": 0.01, "bulk_temperature": "70 degC", "oil": glycol})
    (note,) = [note for note in answer_notes(element, ()) if note.code != BUSH_SWELLS.code]
    assert "evaporates" in note
    assert note.values["limit"] == pytest.approx(65)
    assumed = load_element(WATER | {"oil": without(glycol, "pressure_viscosity")})
    (note,) = [note for note in assumed.notes() if note.code == GLYCOL_ASSUMED.code]
    assert note.values["change"] == pytest.approx(math.expm1(3e-9 * assumed.model.shaft_contact.maximum_pressure))
    assert assumed.columns()["minimum_film [m]"] == load_element(WATER | {"oil": glycol}).columns()["minimum_film [m]"]
    assert GLYCOL_ASSUMED.code not in codes(load_element(WATER).notes())


@pytest.mark.parametrize("clearance", ["0.3 mm", "1.8 mm"])
def test_a_wide_clearance_is_answered(clearance):
    """Shaft and bush are a cylinder on a flat but for half of the relative clearance: one radius stands for both."""
    model = load_element(DRY | {"clearance": clearance}).model
    bound = 0.5 * model.radial_clearance / model.bodies.radius + 0.02
    assert all(abs(deviation) < bound for deviation in model.cylinder_deviation())


@pytest.mark.parametrize(("wall", "depth", "name"), [("0.4 mm", 0.4e-3, "wall"), ("2 mm", 0.6e-3, "clearance")])
def test_without_permitted_wear_a_bush_lasts_until_its_clearance_or_wall_is_gone(wall, depth, name):
    table = without(WORN, "permitted_wear") | {"clearance": "0.6 mm", "wall": wall}
    model = load_element(table).model
    life = dict(answer(load_element(table), ()))["wear life"]
    hours = sliding_to_depth(model, depth) / model.sliding_speed / 3600
    assert f"to a depth of {1e6 * depth:.3g} um (the {name}; give permitted_wear)" in life
    assert float(life.split(" h ")[0]) == pytest.approx(hours, rel=1e-2)


def test_the_bore_stands_for_diameter_or_clearance():
    usual = load_element(DRY).model
    for change in ({"clearance": None}, {"shaft_diameter": None}):
        table = {key: value for key, value in (DRY | {"bore": "20.04 mm"} | change).items() if value is not None}
        model = load_element(table).model
        assert model.clearance == pytest.approx(usual.clearance, rel=1e-9, abs=0)
        assert model.shaft_diameter == pytest.approx(usual.shaft_diameter)
    for wrong, words in (({}, "both of"), ({"clearance": None, "bore": "19 mm"}, "not above shaft_diameter")):
        table = {key: value for key, value in (DRY | {"bore": "20.04 mm"} | wrong).items() if value is not None}
        with pytest.raises(InputError, match=words):
            load_element(table)


def test_dry_friction_is_that_of_the_polymer_or_asked_for():
    assert 0.05 <= DRY_FRICTIONS["ptfe"].value <= 0.2
    teflon = dict(answer(load_element(DRY | {"second": "ptfe"}), ()))
    power = DRY_FRICTIONS["ptfe"].value * 500 * math.pi * 0.02 * 5
    assert teflon["friction power"].startswith(f"{power:.3g} W")
    bronze = load_element(DRY | {"second": "phosphor-bronze"})
    assert "give friction" in dict(answer(bronze, ()))["friction power"]
    assert "not known" in dict(answer(bronze, ()))["temperatures"]
    assert math.isnan(columns([bronze])["bush_temperature [K]"][0])
    rubbing = load_element(DRY).scene(load_element(DRY).worst(), "surface-temperature")
    assert rubbing["contact"]["friction"] == pytest.approx(DRY_FRICTION)
    assert rubbing["heat"]["lower_bulk"] > 500


def test_friction_is_that_of_the_scene_that_the_element_writes(tmp_path):
    element = load_element(WATER)
    (one,) = run_all(element)
    scene = element.scene(element.worst(), "friction") | {"outputs": {"errors": False}}
    found = run_scene(scene, tmp_path / "mixed", figures=False).summary
    assert one.mixed_friction == pytest.approx(found["friction"][0], rel=1e-6)
    assert one.asperity_share == pytest.approx(found["contact_load_N"][0] / 500, rel=1e-6)
    assert one.film_ratio == pytest.approx(found["lambda_ratio"][0], rel=1e-3)
    assert 1e9 * one.minimum_film == pytest.approx(found["minimum_film_whole_nm"][0], rel=1e-3)


def test_an_oil_without_heat_constants_has_an_isothermal_film():
    element = load_element(WATER | {"oil": THIN})
    assert element.scene(element.worst(), "traction")["thermal"] == "off"
    assert NO_HEAT.code in codes(element.notes())
    assert run_all(element)[0].converged


def test_cases_of_a_bush_have_its_answers():
    cases = [load_element(WORN | {"name": str(load), "radial_load": f"{load} N"}) for load in (250, 500)]
    found = columns(cases)
    assert found["pv [Pa*m/s]"][1] == pytest.approx(cases[1].model.mean_pressure * cases[1].model.sliding_speed)
    power = DRY_FRICTION * 500 * cases[1].model.sliding_speed
    assert found["friction_power [W]"] == pytest.approx([power / 2, power])
    assert found["friction_coefficient"] == pytest.approx([DRY_FRICTION, DRY_FRICTION])
    assert found["bush_temperature [K]"][1] == pytest.approx(293.15 + power / (15 * 15 * 0.02 * 0.02))
    assert f"{found['wear_life [h]'][1]:.3g} h" in dict(answer(cases[1], ()))["wear life"]
    wet = columns([load_element(WATER)])
    assert "friction_power [W]" not in wet
    assert wet["film_over_roughness"][0] == pytest.approx(0.84, abs=0.06)


def test_a_peak_above_the_yield_stress_is_noted():
    heavy = load_element(DRY | {"radial_load": "60 kN", "friction": 0.01, "heat_balance": {"conductance": "1 kW/K"}})
    assert heavy.model.shaft_contact.maximum_pressure > 100e6
    (note,) = answer_notes(heavy, ())
    assert note.values["limit"] == pytest.approx(100)


def test_the_scene_of_surface_temperature_is_a_slice_with_the_ground_shaft():
    """Its bush creeps, its shaft and friction are those of kind friction, with grooves along the sliding."""
    element = load_element(WATER | {"bulk_temperature": "60 degC"})
    contact = element.worst()
    rubbing, mixed = (element.scene(contact, kind) for kind in ("surface-temperature", "friction"))
    assert rubbing["grid"]["periodic"] == [False, True]
    assert rubbing["lower"]["surface"] == mixed["lower"]["surface"]
    assert rubbing["lower"]["surface"]["lay"] == "x"
    assert "surface" not in rubbing["upper"]
    assert rubbing["contact"]["friction"] == pytest.approx(run_all(element)[0].mixed_friction)
    assert rubbing["contact"]["load"] == pytest.approx(500 * rubbing["grid"]["lengths"][1] / 0.02)
    assert 0 < rubbing["heat"]["upper_speed"] <= 1e-3 * rubbing["heat"]["lower_speed"]
    axial = load_element(WATER | {"bulk_temperature": "60 degC", "lay": "axial", "correlation_length": "10 um"})
    surface = axial.scene(contact, "friction")["lower"]["surface"]
    assert surface["lay"] == "y"
    assert surface["correlation_length"] == pytest.approx(10e-6 * math.sqrt(10))
    built = load_scene(axial.scene(contact, "friction")).lower.surface
    assert built.correlation_lengths == pytest.approx((10e-6, 100e-6), rel=1e-9, abs=0)


def test_a_short_bush_leaks():
    short = load_element(WATER)
    (note,) = [note for note in short.notes() if note.code == BUSH_LEAKS.code]
    half_width = short.model.cylinder.half_angle * short.model.bodies.cylinder.radius
    assert note.values["ratio"] == pytest.approx(0.02 / (2 * half_width))
    assert BUSH_LEAKS.code not in codes(load_element(WATER | {"length": "50 mm", "radial_load": "100 N"}).notes())
    assert BUSH_LEAKS.code not in codes(load_element(DRY).notes())


def test_the_table_has_the_bush_s_friction_and_no_wear_per_pass():
    element = load_element(WATER | {"specific_wear_rate": "1e-6 mm^3/(N*m)"})
    runs = run_all(element)
    found = table_columns(element, runs)
    assert not [name for name in found if name.startswith("wear_per_pass")]
    power = found["friction_power_with_asperities [W]"][0]
    assert dict(answer(element, runs))["friction power"].startswith(f"{power:.3g} W")
    assert found["bush_temperature [K]"][0] == pytest.approx(313.15 + power / element.model.conductance)
    assert found["friction_power [W]"][0] < power


def test_wear_under_a_full_film_is_noted():
    oil = THIN | {"viscosity": "40 mPa*s"}
    worn = WATER | {"thermal": "off", "oil": oil, "specific_wear_rate": "1e-6 mm3/(N m)"}
    element = load_element(worn)
    runs = run_all(element)
    assert BUSH_WEARS_IN_FILM.code in codes(answer_notes(element, runs))
    said = dict(answer(element, runs))["friction power"]
    assert "of the film; about" in said
    assert said.endswith("by an estimate as a full journal bearing)")
    thin = load_element(worn | {"oil": WATER["oil"]})
    assert BUSH_WEARS_IN_FILM.code not in codes(answer_notes(thin, run_all(thin)))


def test_a_film_between_bounds_carries_the_load_only_at_its_upper_one():
    """0.0 % on asperities stood beside a lower bound at which they touch."""
    table = {
        "element": "plain-bush", "shaft_diameter": "25 mm", "clearance": "100 um", "length": "25 mm", "wall": "3 mm",
        "radial_load": "1 kN", "speed": "60 rpm", "first": "steel-52100", "second": "pa66", "rms_roughness": "500 nm",
        "specific_wear_rate": "1e-7 mm^3/(N*m)", "bulk_temperature": "40 degC",
        "oil": {"grade": "ISO VG 46", "temperature": "40 degC"},
    }  # fmt: skip
    element = load_element(table)
    (note,) = [one for one in answer_notes(element, run_all(element)) if one.code == BUSH_WEARS_IN_FILM.code]
    assert note.values["reason"] == "bounds"
    assert 0.5 < note.values["ratio"] < 2


def test_running_in_of_a_walled_bush_has_the_film_of_its_answer():
    """On the housing alone the contact was 2.4 in place of 11.5 mm wide, and the film a third of the answer's."""
    element = load_element(WATER | {"second": "pa66", "wall": "3 mm"})
    made = element.scene(element.worst(), "running-in")
    scene = load_scene(made)
    assert scene.upper.layer is None
    one = run_all(element)[0]
    film = element.worst().minimum_film(element.model.film_modulus, element.model.film_oil.build())
    materials = scene.lower.build().surface_material, scene.upper.build().surface_material
    assert contact_modulus(*materials) == pytest.approx(element.model.film_modulus, rel=1e-4)  # digits of the file
    assert one.minimum_film == pytest.approx(film, rel=0.2, abs=0)
    assert "too stiff" in made["description"]
    thin = load_element(without(WATER, "wall", "housing") | {"second": "pa66"})
    assert "too stiff" not in thin.scene(thin.worst(), "running-in")["description"]


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({}, "friction"),
        ({"specific_wear_rate": "1e-6 mm3/(N m)"}, "friction and wear"),
        ({"friction": 0.1, "specific_wear_rate": "1e-6 mm3/(N m)"}, "wear"),
        ({"friction": 0.1}, None),
    ],
)
def test_without_roughness_no_film_is_said_to_carry_the_load(change, reason):
    element = load_element(without(WATER, "rms_roughness") | {"thermal": "off"} | change)
    notes = answer_notes(element, run_all(element))
    assert BUSH_WEARS_IN_FILM.code not in codes(notes)
    found = [note.values["reason"] for note in notes if note.code == BUSH_ROUGHNESS_MISSING.code]
    assert found == [reason] * (reason is not None)
    assert BUSH_ROUGHNESS_MISSING.code not in codes(scene_notes(element, run_all(element), "traction"))


def test_a_swinging_bush_wears_where_it_turns_round():
    oil = THIN | {"viscosity": "40 mPa*s"}
    worn = without(WATER, "speed") | {"thermal": "off", "oil": oil, "specific_wear_rate": "1e-6 mm3/(N m)"}
    element = load_element(worn | {"oscillation": {"amplitude": "45 deg", "frequency": "10 Hz"}})
    (note,) = [one for one in all_notes(element, run_all(element)) if one.code == BUSH_WEARS_IN_FILM.code]
    assert note.values["reason"] == "swings"
    assert "turning points" in note


def test_a_temperature_that_is_no_key_of_the_file_has_no_usual_range():
    hot = load_element(WATER | {"friction": 0.5, "radial_load": "2 kN", "heat_balance": {"conductance": "0.1 W/K"}})
    balanced = balance_heat(hot)
    assert balanced.model.bulk_temperature > 1000
    assert not any("bulk_temperature" in note for note in all_notes(balanced, ()))
    given = load_element(without(DRY, "oil") | {"bulk_temperature": "1500 K"})
    assert any("bulk_temperature" in note for note in all_notes(given, ()))


def test_the_friction_of_asperities_is_not_compared_with_that_of_a_journal_bearing():
    """Asperities have 18 % of the load and 97 % of the friction."""
    table = without(WATER, "speed") | {
        "shaft_diameter": "30 mm", "clearance": "15 um", "length": "30 mm", "housing": "aluminium", "speed": "20 rpm",
        "radial_load": "900 N", "second": "pom", "rms_roughness": "2 um", "bulk_temperature": "40 degC",
        "oil": {"grade": "ISO VG 46", "temperature": "40 degC"},
    }  # fmt: skip
    element = load_element(table)
    runs = run_all(element)
    (note,) = [one for one in answer_notes(element, runs) if one.code == BUSH_FLOATS.code]
    assert note.values["reason"] == "thick, touching"
    share = runs[0].asperity_share
    assert note.values["rubbing"] == pytest.approx(0.12 * share / runs[0].mixed_friction, rel=1e-9)
    assert "the friction" not in note.texts[2].replace("of the friction", "")
    smooth = load_element(table | {"rms_roughness": "100 nm"})
    (film,) = [one for one in answer_notes(smooth, run_all(smooth)) if one.code == BUSH_FLOATS.code]
    assert film.values["reason"] == "thick"


@pytest.mark.parametrize(("clearance", "reason"), [("0.1 um", "clearance"), ("0.81 um", "unknown")])
def test_a_clearance_below_the_roughness_is_said_and_no_load_share(clearance, reason):
    """The film of a journal bearing, thinner than the roughness, has no load share: it was one of a whole film."""
    element = load_element(WATER | {"clearance": clearance, "specific_wear_rate": "1e-6 mm3/(N m)"})
    runs = run_all(element)
    assert runs[0].impossible_film
    notes = answer_notes(element, runs)
    assert [note.values["reason"] for note in notes if note.code == BUSH_TOUCHES.code] == [reason]
    assert BUSH_WEARS_IN_FILM.code not in codes(notes)
    assert "asperity_load_share" not in columns([element], [runs])


def test_a_wall_is_a_layer_of_films_and_scenes(tmp_path):
    """The scene's pressure is that of the equivalent cylinder by harmonics, and its film thinner than without wall."""
    element = load_element(WATER)
    model = element.model
    made = element.scene(element.worst(), "contact") | {"outputs": {"errors": False}}
    dry = run_scene(made, tmp_path / "dry", figures=False).summary
    assert dry["max_pressure_Pa"] == pytest.approx(model.cylinder.maximum_pressure, rel=0.01)
    shown = dict(common(examine(plan_scene(made)[0])))
    number, unit = shown["highest pressure on the layer"].split()
    assert unit == "MPa"
    assert 1e6 * float(number) == pytest.approx(dry["max_pressure_Pa"], rel=0.01)
    width, length = (float(shown[name].split()[0]) for name in ("half-width on the layer", "lengths"))
    assert dry["contact_area_fraction"] == pytest.approx(2 * width / length, rel=0.01)
    assert "Hertz" not in " ".join(shown)
    pressure, width = model.cylinder_deviation()
    assert -0.07 < pressure < 0 < width < 0.07
    runs = run_all(element)
    thick = run_all(load_element(without(WATER, "wall", "housing") | {"thermal": "off"}))
    # soft bodies in a liquid whose viscosity does not rise: films go with the modulus to the power -0.4
    softer = thick[0].minimum_film / runs[0].minimum_film
    assert softer == pytest.approx((model.film_modulus / element.modulus) ** 0.4, rel=0.05)
    assert BUSH_TOUCHES.code in codes(answer_notes(element, runs))
    assert BUSH_LIQUID_LOST.code in codes(answer_notes(element, runs))
    assert element.columns()["minimum_film [m]"][0] == pytest.approx(runs[0].minimum_film, rel=0.08)
    mixed = element.scene(element.worst(), "friction")
    assert "grid" not in mixed
    assert mixed["upper"] == {"material": "peek"}
    assert mixed["sharing"]["film_modulus"] == pytest.approx(model.film_modulus)
    for kind in ("friction", "running-in", "surface-temperature"):
        assert plan_scene(element.scene(element.worst(), kind))[1].memory > 0


def test_the_wear_of_rigid_bodies():
    """Against the integral over the depth, and its limit far beyond the clearance."""
    radius, clearance, depth = 10e-3, 20e-6, 100e-6
    deep = depth * np.linspace(0, 1, 20001) ** 2
    angle = np.arccos(clearance / (clearance + deep))
    whole = radius * np.trapezoid(angle + np.sin(angle) * np.cos(angle), deep)
    found = crescent_distance(depth, radius=radius, clearance=clearance)
    assert found == pytest.approx(whole, rel=1e-6, abs=0)
    far = 1e4 * clearance
    assert crescent_distance(far, radius=radius, clearance=clearance) == pytest.approx(
        far * 2 * radius / WORN_IN, rel=1e-3, abs=0
    )


def worn_step_by_step(bodies: ShaftInBush, line_load, rate, depth, *, distance, steps=150, count=61):
    """Sliding distance [m] until a bush of infinite thickness is worn to a depth, by implicit steps of Archard's law.

    Cells around a quarter of the bore; steps grow with the distance slid, up to some share of `distance`.
    """
    half = np.linspace(0, 0.5 * math.pi, count)
    n = np.arange(2, 400)
    quarter = [0.25 * bodies.radius / one.shear_modulus for one in (bodies.shaft, bodies.bush)]
    kappa = [3 - 4 * one.poissons_ratio for one in (bodies.shaft, bodies.bush)]
    flexibility = quarter[0] * (1 / (n - 1) + kappa[0] / (n + 1)) + quarter[1] * (kappa[1] / (n - 1) + 1 / (n + 1))
    weights = np.full(count, half[1])
    weights[[0, -1]] *= 0.5
    cosines = np.cos(np.outer(half, n))
    smooth = np.sinc(0.5 * n * half[1] / math.pi) ** 2  # cells average the harmonics that nodes do not resolve
    kernel = 2 / math.pi * (cosines * flexibility * smooth) @ cosines.T * weights
    kernel += (quarter[0] * (kappa[0] - 1) + 2 * quarter[1]) / math.pi * weights
    worn, slid, touching = np.zeros(count), 0.0, half < 0.3
    while True:
        step = max(distance / steps**2, 3 * slid / steps)
        for _ in range(100):
            i = np.flatnonzero(touching)
            system = np.block([
                [kernel[np.ix_(i, i)] + rate * step * np.eye(len(i)), -np.cos(half[i])[:, None]],
                [2 * bodies.radius * (weights * np.cos(half))[None, i], np.zeros((1, 1))],
            ])  # fmt: skip
            found = np.linalg.solve(system, np.append(-(bodies.clearance + worn)[i], line_load))
            pressure = np.zeros(count)
            pressure[i] = found[:-1]
            gap = bodies.clearance + worn + kernel @ pressure - found[-1] * np.cos(half)
            now = (pressure > 0) | (~touching & (gap < 0))
            if np.array_equal(now, touching):
                break
            touching = now
        deeper = rate * pressure * step
        if worn[0] + deeper[0] > depth:
            return slid + step * (depth - worn[0]) / deeper[0]
        worn, slid = worn + deeper, slid + step


@pytest.mark.parametrize("depth", [1e-6, 6e-6, 20e-6, 100e-6])
def test_the_life_is_at_most_that_of_a_bush_worn_step_by_step(depth):
    model = load_element(without(WORN, "wall", "housing")).model
    least = sliding_to_depth(model, depth)
    slid = worn_step_by_step(model.bodies, model.line_load, model.specific_wear_rate, depth, distance=least)
    assert 0.995 * least < slid < 1.17 * least
    if depth > 50e-6:
        assert slid == pytest.approx(least, rel=5e-3)


def test_particles_of_a_bush_are_its_worn_volume():
    """Archard's law, k F v; the shaft does not wear."""
    element = load_element(WORN | {"mean_particle_volume": "1 um^3"})
    volume = 1e-15 * 500 * element.model.sliding_speed * 3600
    said = dict(answer(element, ()))["worn volume per hour"]
    assert said.startswith(f"{1e9 * volume:.3g} mm^3 of the bush, {volume / 1e-18:.3g} particles of")


def test_wear_and_life_in_words():
    element = load_element(WORN)
    said = dict(answer(element, ()))
    hourly = 1e-15 * element.model.sliding_speed * 3600  # m^2/N times m
    assert f"{1e6 * hourly * WORN_IN * 1.25e6:.3g} um worn in" in said["wear per hour"]
    hours = sliding_to_depth(element.model, 1e-4) / element.model.sliding_speed / 3600
    assert said["wear life"].startswith(f"{hours:.3g} h")
    assert "80 deg" in said["wear life"]
    assert "does not hold above 250 °C" in said["wear life"]
    cool = load_element(WORN | {"heat_balance": {"conductance": "5 W/K"}})
    assert "does not hold" not in dict(answer(cool, ()))["wear life"]
    wet = load_element(WATER | {"specific_wear_rate": "1e-6 mm3/(N m)", "bulk_temperature": "60 degC"})
    assert "test in this liquid" in dict(answer(wet, run_all(wet)))["wear per hour"]
    assert "not known" in dict(answer(load_element(DRY), ()))["wear per hour"]
    assert len(element_figure(element, ()).axes) == 2
    rubs = element_figure(wet, run_all(wet)).axes[1]
    assert rubs.get_title() == ""  # asperities carry a part of the load
    floats = [replace(one, asperity_share=0.001) for one in run_all(wet)]
    assert "a film carries the load" in element_figure(wet, floats).axes[1].get_title()
    unknown = [replace(one, asperity_share=None) for one in floats]
    assert element_figure(wet, unknown).axes[1].get_title() == ""


def test_an_assumed_friction_is_that_on_steel():
    said = dict(answer(load_element(DRY | {"second": "pa66"}), ()))["friction power"]
    assert "against a shaft" not in said
    soft = dict(answer(load_element(DRY | {"second": "pa66", "first": "pa66"}), ()))["friction power"]
    assert "that is on steel, none is known against a shaft of pa66" in soft


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"speed": None}, "neither of speed"),
        ({"oscillation": {"amplitude": "20 deg", "frequency": "2 1/s"}}, "both of speed"),
        ({"clearance": "3 mm"}, "allowed: below 2 mm"),
        ({"first": "peek", "second": "steel-52100"}, "swap first and second"),
        ({"wall": "0.1 mm"}, "at least 200 um.*upper.layer.thickness"),
        ({"first": "stainless"}, "youngs_modulus, poissons_ratio"),
        ({"wall": None}, "housing without wall"),
        ({"permitted_wear": "2 mm"}, "permitted_wear"),
        ({"pv_limit": "0.2 MPa"}, "pressure times a speed"),
        ({"specific_wear_rate": 3e-6}, 'a unit beside the number, such as "3e-06 mm'),
        ({"wal": "2 mm"}, "boundary_friction, bulk_temperature"),
        ({"wal": "2 mm"}, "bore"),
    ],
)
def test_mistakes_are_said_with_what_is_allowed(change, words):
    table = {key: value for key, value in (DRY | change).items() if value is not None}
    with pytest.raises(InputError, match=words):
        load_element(table)


def test_temperatures_near_the_limit_have_a_digit_more():
    """100.2 °C above 100 °C; what is shown as the limit is not above it."""
    for warm, flagged in (("100.2 degC", True), ("100.02 degC", False)):
        own = {"second": "pa66", "friction": 0.1, "heat_balance": {"conductance": "1 MW/K", "ambient": warm}}
        element = load_element(DRY | own)
        found = [note for note in answer_notes(element, ()) if note.code == BUSH_OVER_LIMIT.code]
        assert ("bush 100.2 °C" in dict(answer(element, ()))["temperatures"]) == flagged
        assert ["It would reach 100.2 °C, above 100 °C" in note for note in found] == [True] * flagged


def test_a_liquid_that_boils_in_assumed_still_air_says_so():
    """The action names the keys that end the assumption; with a conductance of the file it is another one."""
    still = balance_heat(load_element(LIGHT_WATER))
    (note,) = [note for note in all_notes(still, run_all(still)) if note.code == BUSH_LIQUID_LOST.code]
    assert "still air is assumed" in note.line
    cooled = LIGHT_WATER | {"heat_balance": {"conductance": "5 W/K"}}
    assert BUSH_LIQUID_LOST.code not in codes(all_notes(balance_heat(load_element(cooled)), ()))
    known = load_element(LIGHT_WATER | {"friction": 0.2, "heat_balance": {"conductance": "0.1 W/K"}})
    (note,) = [note for note in answer_notes(balance_heat(known), ()) if note.code == BUSH_LIQUID_LOST.code]
    assert "still air" not in note


def test_notes_and_kinds_of_scenes_are_those_that_a_bush_has(tmp_path):
    """A dry scene has no words on films; a life of two bodies that pass is none of a bush; the motion is named."""
    element = load_element(WATER)
    assert BUSH_LEAKS.code in codes(scene_notes(element, (), "traction"))
    assert {BUSH_LEAKS.code, NO_HEAT.code, BUSH_SWINGS.code}.isdisjoint(codes(scene_notes(element, (), "contact")))
    with pytest.raises(InputError, match="a bush wears at one place"):
        element.scene(element.worst(), "running-in-life")
    swings = without(DRY, "speed") | {"oscillation": {"amplitude": "40 deg", "frequency": "0.5 Hz"}}
    (tmp_path / "swings.toml").write_text(table_text(swings))
    said = run_command("element", "swings.toml", cwd=tmp_path).stdout
    assert said.splitlines()[0].endswith("plain-bush, ±40°, 0.5 Hz")
    assert "1 contact: --contacts shows it, --table FILE.csv and --figure FILE.png write it." in said


def test_the_command(tmp_path):
    bem = functools.partial(run_command, cwd=tmp_path)
    assert bem("new", "bushing", "pump.toml").returncode == 0
    dry = (tmp_path / "pump.toml").read_text().partition("\n[oil]")[0]
    (tmp_path / "dry.toml").write_text(dry.replace("\nheat_balance", "\n# heat_balance"))
    done = bem("element", "dry.toml", "--table", "all.csv", "--figure", "all.png")
    assert done.returncode == 0, done.stderr
    assert "half-angle 21.0 deg, peak pressure 4.86 MPa" in done.stdout
    assert "The bush becomes too hot" in done.stdout + done.stderr
    assert (tmp_path / "all.png").stat().st_size > 1000
    shown = bem("element", "pump.toml", "--contacts").stdout
    assert "4.86" in shown
    cited = bem("cite", "dry.toml").stdout
    assert "friction of dry peek: 0.35: between" in cited
    assert "highest temperature of peek: 250 degC" in cited
    assert "Michell" in cited
    wet = bem("cite", "pump.toml").stdout
    assert "M100" not in wet
    assert "load sharing of film and asperities" in wet  # of kind friction, in place of the estimate
    assert "Zhou" not in wet
    assert "Hertz" not in shown
    (tmp_path / "cases.csv").write_text("name, radial_load [N], speed [rpm]\nlow, 100, 300\nhigh, 500, 100\n")
    cases = bem("element", "pump.toml", "--cases", "cases.csv").stdout
    assert "250 kPa" in cases
    assert "105 mm/s" in cases
    assert "load line" not in cases
    loads = cases.splitlines()[-1].split("  ")
    assert sum(cell.strip() == "500 N" for cell in loads) == 1
    assert "driving pinion" not in shown
    mixed = bem("element", "pump.toml", "--scene", "mixed.toml", "--kind", "friction")
    assert mixed.returncode == 0, mixed.stderr
    assert "thinnest film" not in mixed.stdout
    assert 'kind = "friction"' in (tmp_path / "mixed.toml").read_text()


@pytest.mark.parametrize("bush", ["pom", "pa66", "ptfe", "peek"])
def test_the_mixed_scene_of_a_polymer_bush_asks_for_nothing_of_its_material(bush):
    """Its asperities are capped by the bush's own hardness, and the caution on its ends is one of a bush too."""
    element = load_element(WATER | {"second": bush, "bulk_temperature": "30 degC"})
    facts = examine(plan_scene(element.scene(element.worst(), "friction"))[0])
    notes = {note.code: note for note in scene_warnings(facts)}
    assert CAP_NOT_OF_SOFTER.code not in notes
    assert HARDNESS_UNLIKELY.code not in notes
    assert "bush" in str(notes[CYLINDER_NARROW.code])
    assert max(case.cap for case in facts.cases) < 0.3e9


def test_a_written_film_of_a_thin_wall_says_its_modulus_and_no_caution_on_hardness():
    """The modulus is that of a half-space; hardness and yield stress are still those of the catalogue."""
    thin = WATER | {"second": "pa66", "wall": "1.2 mm", "bulk_temperature": "30 degC", "correlation_length": "10 um"}
    element = load_element(thin)
    made = element.scene(element.worst(), "traction")
    assert made["upper"]["material"]["youngs_modulus"] > 6e9
    text = element_scene_text(element, made)
    line = next(line for line in text.splitlines() if "youngs_modulus" in line)
    assert "# youngs_modulus: of the half-space" in line
    assert HARDNESS_UNLIKELY.code not in codes(scene_warnings(examine(plan_scene(tomllib.loads(text))[0])))
    made["upper"]["material"] |= {"yield_stress": "80 MPa"}
    assert HARDNESS_UNLIKELY.code in codes(scene_warnings(examine(plan_scene(made)[0])))
    mixed = element_scene_text(element, element.scene(element.worst(), "friction"))
    assert 'correlation_length = "31.6228 um" }' in mixed
    assert "geometric mean of 10 um across the grooves (the element's) and 100 um along them" in mixed


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [("clearance", 80, "80 m"), ("wall", 1e-4, "100 um"), ("permitted_wear", 5, "5 m")],
)
def test_a_length_without_unit_that_does_not_fit_is_said_to_be_in_m(key, value, words):
    with pytest.raises(InputError, match=f"{key} = {value:g} has no unit and is read as {words}"):
        load_element(WATER | {key: value})
    with pytest.raises(InputError) as told:
        load_element(WATER | {key: f"{value} m"})
    assert "has no unit" not in str(told.value)
    with pytest.raises(InputError, match="shaft_diameter = 25 has no unit and is read as 25 m"):
        load_element(WATER | {"shaft_diameter": 25})
    with pytest.raises(InputError, match=r"bore = 0\.01 has no unit and is read in SI units"):
        load_element(without(WATER, "clearance") | {"bore": 0.01})


def test_a_wall_or_a_shaft_of_metres_has_a_caution():
    """Their unit was forgotten: 2.5 and 20 are read as metres."""
    said = " ".join(str(note) for note in load_element(WATER | {"wall": 20, "shaft_diameter": 20}).notes())
    assert 'write "20 mm"' in said
    assert "wall" in said
    assert "shaft_diameter" in said


def test_a_wall_makes_the_bush_stiffer():
    walls = [load_element(DRY | {"wall": wall}).model for wall in ("5 mm", "2 mm", "1 mm")]
    angles = [one.shaft_contact.half_angle for one in walls]
    assert angles == sorted(angles, reverse=True)
    infinite = replace(walls[0].bodies, wall=None, housing=None)
    assert infinite.equivalent_radius == pytest.approx(walls[0].contact().radius)
