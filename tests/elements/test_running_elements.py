"""What elements do as they run is what kind traction says of each place; tables of cases; what is not known is said."""

import csv
import functools
import math
import re
import tomllib
from dataclasses import replace

import numpy as np
import pytest
from command_line import run_command

from bem import InputError, load_scene, run_scene
from bem.elements.answer import answer, balance_heat, friction_power
from bem.elements.bearing_life import bearing_life
from bem.elements.cases import changed_keys, load_cases
from bem.elements.cases import columns as case_columns
from bem.elements.element import element_template, load_element
from bem.elements.element_wear import worn_volume_rate
from bem.elements.figure import element_figure
from bem.elements.gear_pair import path_of_contact
from bem.elements.gear_scuffing import scuffing_of
from bem.elements.running import (
    Running,
    columns,
    notes,
    operating_places,
    over_slices,
    run_all,
    run_contact,
    wear_per_pass,
)
from bem.errors import Status
from bem.kinds.traction.run import case_of
from bem.wear.criterion.local import Archard

WEAR_RATE = 1e-18  # m^2/N, 1e-9 mm^3/(N m)


def element_of(name, **changes):
    table = tomllib.loads(element_template(name)) | {"name": name} | changes
    return load_element(table)


@pytest.fixture(scope="module")
def gears():
    asked = {"points": 5, "specific_wear_rate": WEAR_RATE, "permissible_film_ratio": 0.25}
    element = element_of("gear-pair", **asked)
    return element, run_all(element)


@pytest.mark.internal
def test_a_place_is_what_its_scene_gives(gears, tmp_path):
    element, runs = gears
    scene = element.scene(runs[3].contact, "traction") | {"film": {"points": 500}, "outputs": {"errors": False}}
    found = run_scene(scene, tmp_path / "run", figures=False).summary
    assert found["friction_power_W"] == pytest.approx(runs[3].power, rel=1e-9)
    assert found["lambda_ratio"] == pytest.approx(runs[3].film_ratio, rel=1e-9)
    hottest = max(found["lower_temperature_C"], found["upper_temperature_C"])
    assert hottest + 273.15 == pytest.approx(runs[3].surface, rel=1e-9)


@pytest.mark.internal
def test_wear_is_local_archard_over_one_pass(gears):
    """Against the law stepped through Hertz' pressure: k p times the distance slid in each step of the crossing."""
    element, runs = gears
    contact = element.found.contacts[1]
    half = contact.half_width(element.modulus)
    x = half * (np.arange(4000) + 0.5) / 2000 - half
    pressure = contact.hertz(element.modulus).maximum_pressure * np.sqrt(1 - (x / half) ** 2)
    rate = Archard(specific_wear_rate=WEAR_RATE, distance=1.0).rate(None, 0.1)
    slid = abs(contact.speeds[0] - contact.speeds[1]) / np.array(contact.speeds) * (x[1] - x[0])
    # midpoints under a square root: 1e-5 of the area on 4000 steps
    assert wear_per_pass(element, contact) == pytest.approx(tuple(rate * pressure.sum() * slid), rel=1e-4, abs=0)
    found = columns(element, runs)
    assert (found["wear_per_pass_1 [m]"][1], found["wear_per_pass_2 [m]"][1]) == wear_per_pass(element, contact)


@pytest.mark.internal
def test_the_whole_gear_pair(gears):
    element, runs = gears
    said = dict(answer(element, runs))
    power = friction_power(element, runs).film
    assert f"; {power:.3g} W if oil films carry the whole load" in said["friction power"]
    assert "W by a fit to gear tests" in said["friction power"].split(";")[0]
    at = [one.contact.place for one in runs]  # A, B, C, D and E
    per_load = [one.power / one.contact.load for one in runs]
    s = np.linspace(at[0], at[-1], 20001)
    share = np.array([path_of_contact(element.model).share(path_of_contact(element.model).pitch + one) for one in s])
    normal = runs[1].contact.load
    mean = np.mean(normal * share * np.interp(s, at, per_load)) * element.found.at_once
    assert power == pytest.approx(mean, rel=1e-3)
    assert f" {100 * (1 - power / 47124):.2f} % of 47.1 kW" in said["efficiency"]
    assert 0.003 < power / (200 * 2250 * np.pi / 30) < 0.03  # gears lose some per cent at most, films some tenths
    assert f"safety factor {min(one.film_ratio for one in runs) / 0.25:.3g}" in said["micropitting"]
    assert "not its procedure" in said["micropitting"]
    depths = columns(element, runs)["wear_per_pass_1 [m]"]
    assert f"pinion {max(depths) * 1e6 * 2250 * 60:.3g} um" in said["wear per hour"]
    assert "give mean_particle_volume" in said["worn volume per hour"]
    assert "mixed lubrication" in said["lambda ratio"]
    found = columns(element, runs)
    assert len(found["friction_power [W]"]) == 5
    slid = [abs(one.friction) * one.contact.load * abs(one.contact.speeds[0] - one.contact.speeds[1]) for one in runs]
    both = zip(found["friction_power [W]"], found["rolling_loss [W]"], strict=True)
    assert [power - rolling for power, rolling in both] == pytest.approx(slid, rel=0.05, abs=0.1)
    assert found["rolling_loss [W]"][2] == pytest.approx(found["friction_power [W]"][2])  # at C nothing slides


@pytest.mark.internal
def test_worn_volume_is_that_of_the_depths_over_both_flanks():
    """Depth of a pass over the flank's length (s ds / r_b of an involute) and width, for each tooth that passes."""
    element = element_of("gear-pair", points=401, specific_wear_rate=WEAR_RATE, mean_particle_volume="0.02 um^3")
    path = path_of_contact(element.model)
    depths = np.array([wear_per_pass(element, one) for one in element.found.contacts]).T
    s = path.pitch + np.array([one.place for one in element.found.contacts])
    teeth = element.model.speed / (2 * np.pi) * element.model.teeth[0]
    volumes = [
        np.trapezoid(depth * along / base, s) * element.model.face_width * teeth
        for depth, along, base in zip(depths, (s, path.line - s), path.base_radii, strict=True)
    ]
    rate = worn_volume_rate(element)
    assert rate == pytest.approx(sum(volumes), rel=2e-3, abs=0)  # trapezoids across the jumps of load at B and D
    said = dict(answer(element, [run_contact(element, element.worst())]))["worn volume per hour"]
    assert f"{3600e9 * rate:.3g} mm^3" in said
    assert f"{3600 * rate / 0.02e-18:.3g} particles of 0.02 um^3" in said


@pytest.mark.internal
def test_the_films_limits_are_said(tmp_path):
    """A creeping bearing at 1.6 GPa: 0.6 nm of oil are no film of Reynolds' equation, as that place's scene says."""
    bearing = element_of("rolling-bearing", speed="0.5 rpm", radial_load="1 kN")
    one = run_contact(bearing, bearing.worst())
    assert one.minimum_film < 1e-9
    scene = bearing.scene(bearing.worst(), "traction") | {"outputs": {"errors": False}}
    said = run_scene(scene, tmp_path / "run", figures=False).summary["notes"]
    assert any(text.code == "film-molecular" for text in one.notes)
    assert not any(text.code == "viscosity-extrapolated" for text in one.notes)  # friction of rolling is of the inlet
    assert {note.code for note in one.notes} <= {note["code"] for note in said}
    assert notes([one, replace(one, notes=())])[0] == one.notes[0].at(f"at 1 of 2 positions ({one.contact.name})")
    other = replace(one, contact=replace(one.contact, place=one.contact.place + 1.0), notes=())
    marks = {"A": one.contact.place}
    assert notes([other, one, one, other, one], marks)[0] == one.notes[0].at("at 3 of 5 positions (A to A, A)")


@pytest.mark.internal
def test_what_did_not_converge_is_no_figure(gears):
    """Its film had been the thinnest, its power in the mean."""
    element, runs = gears
    lost = replace(runs[0], status=Status.STALLED, minimum_film=1e-12, film_ratio=1e-6, power=1e9, notes=("lost",))
    said = dict(answer(element, (lost, *runs[1:])))
    assert said["not converged"] == "1 of 5 films, the first at A (9.5 mm before C)"
    assert float(said["friction power"].split(" W")[0]) < 1e3  # the neighbours' in its place
    assert "safety factor 1e" not in said["micropitting"]
    assert said["lambda ratio"] == dict(answer(element, runs[1:]))["lambda ratio"]
    assert np.isnan(columns(element, (lost, *runs[1:]))["friction_power [W]"][0])
    assert notes((lost,)) == ()
    alone = dict(answer(element, (lost,)))
    assert alone["not converged"] == "1 of 1 films, the first at A (9.5 mm before C)"
    assert "friction power" not in alone


@pytest.mark.parametrize(
    ("kind", "ratio", "says"),
    [
        ("gear-pair", 0.99, True),
        ("gear-pair", 2.01, False),
        ("rolling-bearing", 0.99, True),
        ("rolling-bearing", 1.01, False),
    ],
)
def test_thin_films_say_that_the_estimate_is_of_run_in_surfaces(gears, kind, ratio, says):
    """Below a lambda ratio of one scenes of new ground surfaces have far more load on asperities, of superfinished
    ones often less; solved shares need no such words."""
    element, runs = gears
    if kind != "gear-pair":
        element = element_of(kind)
        runs = run_all(element)
    thin = replace(runs[0], minimum_film=1e-9, film_ratio=ratio, asperity_share=0.5)
    words = dict(answer(element, [thin, *runs[1:]]))["lambda ratio"]
    assert "of the load, an estimate" in words
    assert ("fit for ground, run-in surfaces" in words) == says
    assert ("often carry less" in words) == (says and kind == "rolling-bearing")
    solved = replace(thin, mixed_friction=0.1)
    assert "run-in" not in dict(answer(element, [solved, *runs[1:]]))["lambda ratio"]


@pytest.mark.internal
def test_what_is_not_known_is_said():
    iron = {"name": "bare iron", "youngs_modulus": "170 GPa", "poissons_ratio": 0.26}
    cam = element_of("cam-follower", points=9, first=iron)
    runs = run_all(cam)
    assert len(runs) < 9  # under the nose there is no steady film
    said = dict(answer(cam, runs))
    count = sum(abs(one.slide_roll_ratio) > 2 for one in cam.found.contacts)
    assert f"; {count} of 9 positions are left out of the former: surfaces that run against" in said["friction power"]
    assert "and the whole load where no film is solved" in said["friction power"]
    assert f"Not solved at {count} of 9 positions" in said["lambda ratio"]
    assert said["friction power"].endswith("; means over the whole turn, without contact on the base circle")
    power = friction_power(cam, runs)
    nose = [one for one in cam.found.contacts if abs(one.slide_roll_ratio) > 2]
    rubbed = 0.12 * sum(one.load * abs(one.speeds[0] - one.speeds[1]) for one in nose) / 8 * cam.found.at_once
    assert power.counted == pytest.approx(1 - len(nose) / 8)
    assert power.with_asperities > power.film + 0.9 * rubbed > power.film
    assert "thermal constants of a body are missing" in said["temperatures"]
    assert "give specific_wear_rate" in said["wear per hour"]
    assert said["micropitting"].startswith("not known: the thinnest films are not solved")
    assert np.isnan(columns(cam, runs)["friction"][4])
    assert not any(note.code == "follower-passed-often" for note in cam.notes())
    worn = element_of("cam-follower", points=9, specific_wear_rate=WEAR_RATE)
    assert any(note.code == "follower-passed-often" for note in worn.notes())
    nose = worn.found.contacts[4]  # where the cam wears most, and no steady film is
    assert abs(nose.slide_roll_ratio) > 2
    depths = columns(worn, [])["wear_per_pass_1 [m]"]
    assert depths[4] == np.nanmax(depths) == wear_per_pass(worn, nose)[0]
    said = dict(answer(worn, runs))["wear per hour"]
    assert f"at {nose.name}" in said
    assert "follower not known" in said  # one over the speed with which the contact turns round there
    bearing = element_of("rolling-bearing", specific_wear_rate=WEAR_RATE)
    one = run_contact(bearing, bearing.worst())
    assert wear_per_pass(bearing, one.contact) == (0.0, 0.0)
    assert "both surfaces roll at one speed" in dict(answer(bearing, [one]))["wear per hour"]


@pytest.mark.internal
def test_a_ball_has_a_point_film(tmp_path):
    bearing = element_of("rolling-bearing")
    scene = bearing.scene(bearing.worst(), "point-film")
    found = run_scene(
        scene | {"film": {"cells": 48}, "outputs": {"errors": False}}, tmp_path / "run", figures=False
    ).summary
    assert found["status"] == "converged"
    line = case_of(load_scene(bearing.scene(bearing.worst(), "traction"))).on(300)
    # an ellipse nine times as long across the rolling is nearly the line of its middle; 48 cells are coarse
    assert 1e-9 * found["central_thickness_nm"] == pytest.approx(line.central_thickness, rel=0.2)
    gear = element_of("gear-pair")
    with pytest.raises(InputError, match="allowed: traction, contact, friction"):
        gear.scene(gear.worst(), "point-film")


CASES = (
    "name, radial_load [kN], speed [rpm], oil.temperature [degC], count\nidle, 1, 800, 40, 9\nfull, 6, 3000, 80, 8\n"
)


@pytest.mark.internal
def test_cases_are_rows_of_a_table(tmp_path):
    file, rows = tmp_path / "b.toml", tmp_path / "c.csv"
    file.write_text(element_template("rolling-bearing"))
    rows.write_text(CASES)
    cases = load_cases(file, rows)
    assert [one.model.name for one in cases] == ["idle", "full"]
    assert cases[1].model.radial_load == 6000.0
    assert cases[1].model.oil.temperature == pytest.approx(353.15)
    found = case_columns(cases)
    assert found["hertz_pressure [Pa]"][1] == cases[1].worst().hertz(cases[1].modulus).maximum_pressure
    assert found["minimum_film [m]"][0] == min(cases[0].columns()["minimum_film [m]"])


def test_values_of_a_case_are_of_the_contact_that_its_row_names(tmp_path):
    """Pressure and load of one contact, film and lambda of another; at 20 000 rpm the outer ring has a higher load."""
    file, rows = tmp_path / "b.toml", tmp_path / "c.csv"
    file.write_text(element_template("rolling-bearing"))
    rows.write_text("radial_load [N], speed [rpm]\n600, 20000\n4000, 3000\n")
    cases = load_cases(file, rows)
    assert max(one.load for one in cases[0].found.contacts) > 1.1 * cases[0].worst().load
    found = case_columns(cases, [[run_contact(one, one.worst())] for one in cases], changed_keys(file, rows))
    assert found["speed"] == ["20000 rpm", "3000 rpm"]
    assert found["load [N]"] == [one.worst().load for one in cases]
    assert found["worst"] == found["thinnest"] == ["inner ring, 0 deg"] * 2
    lives = bearing_life(cases[1])
    life = lives.rating
    assert found["reference_life [h]"][1] == pytest.approx(lives.reference.basic / (60 * 3000))
    assert found["modified_reference_life [h]"][1] == pytest.approx(lives.modified_reference / (60 * 3000))
    assert found["basic_life [h]"][1] == pytest.approx(life.basic / (60 * 3000))
    assert found["modified_life [h]"][1] == pytest.approx(life.modified / (60 * 3000))
    assert found["friction_power [W]"][0] > found["friction_power [W]"][1] > 0
    gears = element_of("gear-pair", points=5, scuffing_load_stage=10, permissible_film_ratio=0.5)
    film = run_contact(gears, gears.found.contacts[0])
    row = {name: values[0] for name, values in case_columns([gears], [[film]]).items()}
    assert row["thinnest"] == row["thinnest_by_formula"] == "A (9.5 mm before C)"
    assert row["worst"] != row["thinnest"]
    assert row["load [N]"] == gears.critical().load
    assert row["worst"] == "B (3.69 mm before C)"
    assert row["micropitting_safety"] == pytest.approx(film.film_ratio / 0.5)
    assert row["scuffing_safety_contact_temperature"] == scuffing_of(gears, [film]).contact_safety


def test_modified_lives_of_rough_cases_are_those_of_their_film(tmp_path):
    file, rows = tmp_path / "b.toml", tmp_path / "c.csv"
    file.write_text(element_template("rolling-bearing"))
    rows.write_text("rms_roughness [nm]\n70\n400\n")
    cases = load_cases(file, rows)
    runs = [[run_contact(one, one.worst())] for one in cases]
    found = case_columns(cases, runs)
    kappa = runs[1][0].film_ratio ** 1.3
    rough = bearing_life(cases[1], kappa)
    assert np.isnan(found["viscosity_ratio_of_film"][0])
    assert found["viscosity_ratio_of_film"][1] == pytest.approx(kappa)
    assert found["modified_life [h]"][1] == pytest.approx(rough.rating.modified / (60 * 3000))
    assert found["modified_reference_life [h]"][1] < found["modified_reference_life [h]"][0]
    assert found["reference_life [h]"][1] == found["reference_life [h]"][0]


def test_a_pressure_in_a_table_of_cases_stands_in_place_of_the_load(tmp_path):
    file, rows = tmp_path / "b.toml", tmp_path / "c.csv"
    file.write_text(element_template("rolling-bearing"))
    rows.write_text("hertz_pressure [GPa]\n1.2\n1.5\n")
    cases = load_cases(file, rows)
    assert [one.worst().hertz(one.modulus).maximum_pressure for one in cases] == pytest.approx([1.2e9, 1.5e9])
    rows.write_text("radial_load [kN], hertz_pressure [GPa]\n1, 1.2\n")
    with pytest.raises(InputError, match="both radial_load and hertz_pressure"):
        load_cases(file, rows)


@pytest.mark.internal
@pytest.mark.parametrize(
    ("text", "message"),
    [
        (CASES.replace("speed", "sped"), 'column "sped .*did you mean "speed"'),
        (CASES.replace("full, 6", "full, -6"), "row 2 of .*radial_load"),
        (CASES.replace("idle, 1, 800", "idle, 1 m, 800"), "row 1 of .*radial_load"),
    ],
)
def test_mistakes_in_cases_are_said(text, message, tmp_path):
    file, rows = tmp_path / "b.toml", tmp_path / "c.csv"
    file.write_text(element_template("rolling-bearing"))
    rows.write_text(text)
    with pytest.raises(InputError, match=message):
        load_cases(file, rows)


def test_the_command_shows_and_writes_them(tmp_path):
    (tmp_path / "b.toml").write_text(element_template("rolling-bearing"))
    (tmp_path / "c.csv").write_text(CASES)
    bem = functools.partial(run_command, "element", "b.toml", cwd=tmp_path)
    done = bem("--running", "--table", "all.csv")
    assert done.returncode == 0, done.stderr
    assert "friction power" in done.stdout
    assert "rating life" in done.stdout
    rows = list(csv.DictReader((tmp_path / "all.csv").read_text().splitlines()))
    assert len(rows) == 10
    assert all(float(row["friction_power [W]"]) > 0 for row in rows)
    assert bem("--cases", "c.csv", "--table", "cases.csv").returncode == 0
    assert (tmp_path / "cases.csv").read_text().count("\n") == 3
    both = bem("--cases", "c.csv", "--running")
    assert both.returncode == 2
    assert "goes with --table alone" in both.stderr


@pytest.mark.internal
def test_friction_power_has_the_scatter_of_the_base_oil(gears):
    """With the law of base oils, which the template names, at every place; no other law has one."""
    element, runs = gears
    oil = tomllib.loads(element_template("gear-pair"))["oil"]
    limited = element_of("gear-pair", points=5, oil=oil | {"shear_law": "limited"})
    assert run_contact(limited, limited.found.contacts[0]).scatter is None
    sliding = [one for one in runs if abs(one.contact.slide_roll_ratio) > 1e-9]
    assert all(0.05 < value / abs(one.friction) < 0.6 for one in sliding for value in one.scatter)
    slid = [one.contact.load * abs(one.contact.speeds[0] - one.contact.speeds[1]) for one in runs]
    share = element.found.at_once / len(runs)
    down, up = (share * sum(s * one.scatter[k] for s, one in zip(slid, runs, strict=True)) for k in (0, 1))
    power = dict(answer(element, runs))["friction power"]
    low, high = map(float, re.search(r"\(([\d.]+) to ([\d.]+) W with other oils of this base\)", power).groups())
    film = share * sum(s * abs(one.friction) for s, one in zip(slid, runs, strict=True))
    assert (low, high) == pytest.approx((film - down, film + up), rel=0.05)


@pytest.mark.internal
def test_losses_of_gears_by_default_are_those_of_tests_with_each_oil():
    """FZG type C at 90 degC: a mineral oil loses 330 to 560 W; a PAO 0.6 to 0.97, an ester 0.3 to 1 and a polyglycol
    0.2 to 0.75 of it (Schlenk's formula, twin discs and gears of Doleschel et al.)."""
    oil = tomllib.loads(element_template("gear-pair"))["oil"]

    def power(base):
        element = element_of("gear-pair", oil={key: oil[key] for key in ("grade", "temperature")} | base)
        runs = run_all(element)
        assert all(one.converged for one in runs)
        return sum(one.power for one in runs) / len(runs) * element.found.at_once

    mineral = power({})
    assert 330 < mineral < 560
    for base, low, high in (("pao", 0.6, 0.97), ("ester", 0.3, 1.0), ("pag", 0.2, 0.75)):
        assert low < power({"base": base}) / mineral < high


ROLLERS_OF_NU1016 = {
    "element": "rolling-bearing", "name": "nu1016", "rolling": "roller", "bore": "80 mm", "outside": "125 mm",
    "diameter": "11 mm", "length": "11 mm", "count": 22, "radial_load": "15 kN", "clearance": "20 um",
    "speed": "3000 rpm", "first": "steel-52100", "second": "steel-52100",
    "oil": {"grade": "ISO VG 68", "temperature": "65 degC"},
}  # fmt: skip


@pytest.fixture(scope="module")
def tilted():
    element = load_element(ROLLERS_OF_NU1016 | {"tilt": "0.6 mrad"})
    return element, run_all(element, most=6)


def test_the_friction_power_of_tilted_rollers_does_not_depend_on_the_number_of_films(tilted):
    """Its lightly loaded slices were interpolated linearly to none: 242 W from 11 films and 265 W from 18."""
    element, few = tilted
    every = run_all(element)
    assert len(few) < len(every) == len(element.found.contacts)
    power = friction_power(element, every).film
    assert friction_power(element, few).film == pytest.approx(power, rel=0.015)
    found = columns(element, every)
    assert sum(found["friction_power [W]"]) == pytest.approx(power, rel=1e-12)
    assert sum(found["rolling_loss [W]"]) == pytest.approx(power, rel=1e-6)  # nothing slides
    assert sum(one.power for one in every) > 1.15 * power  # as if whole rollers were loaded as their highest slice


@pytest.mark.internal
def test_light_slices_have_the_power_of_their_own_films(tilted):
    """Against films solved at loads between those of `lighter`, and below the lightest."""
    element, few = tilted
    known = [one for one in few if one.converged]
    whole = known[0].contact
    light = [one.contact.load for one in known[0].lighter]
    assert min(light) == pytest.approx(max(light) / 64)
    for load in (0.3 * min(light), 3 * min(light), 0.4 * max(light)):
        even = replace(whole, load=load, slices=(load / whole.length,) * 5)
        own = run_contact(element, even)
        # between films of loads eight apart within 5 %, of slices that carry little of the whole
        assert over_slices(even, known, lambda one: one.power) == pytest.approx(own.power, rel=0.05)


def test_a_vanishing_tilt_changes_nothing():
    """It brought the profile into the contacts: 1.48 to 1.70 GPa, and 346 to 262 W."""
    even, hardly = (load_element(ROLLERS_OF_NU1016 | {"tilt": tilt}) for tilt in ("0 mrad", "0.001 mrad"))
    assert hardly.worst().hertz(hardly.modulus).maximum_pressure == pytest.approx(
        even.worst().hertz(even.modulus).maximum_pressure, rel=1e-4
    )
    powers = [friction_power(one, run_all(one, most=4)).film for one in (even, hardly)]
    assert powers[1] == pytest.approx(powers[0], rel=1e-4)


@pytest.mark.parametrize("rolling", ["roller", "ball"])
def test_contacts_on_both_sides_of_the_load_are_drawn_alike(rolling):
    """The selection is even on each ring and has both sides; markers stand clear of the upper edge."""
    given = ROLLERS_OF_NU1016 | {"clearance": 0.0, "oil": {"grade": "ISO VG 68", "temperature": "65 degC"}}
    if rolling == "ball":
        given = {key: value for key, value in given.items() if key != "length"} | {"rolling": "ball"}
    element = load_element(given)
    some = operating_places(element, 6)
    assert len(some) < len(element.found.contacts)
    for ring in ("inner ring", "outer ring"):
        at = sorted(math.degrees(one.place) for one in some if one.path == ring)
        assert at == pytest.approx([-one for one in reversed(at)], abs=1e-9)
        assert at[-1] == max(math.degrees(one.place) for one in element.found.contacts if one.path == ring)
    contacts = [one for one in some if one.path]
    runs = [
        Running(one, Status.CONVERGED, 1e-7, None, 0.0, 19 + 0.1 * abs(one.place), 340.0, 341.0) for one in contacts
    ]
    for axes in element_figure(element, runs).axes:
        highest = max((max(line.get_ydata()) for line in axes.lines), default=None)
        if axes.get_ylabel().startswith("friction power"):
            assert axes.get_ylim()[1] > 1.05 * highest


def test_the_heat_balance_says_how_far_it_is():
    told = []
    element = load_element(
        ROLLERS_OF_NU1016 | {"thermal": "off", "heat_balance": {"conductance": "50 W/K"}, "count": 8}
    )
    balance_heat(element, most=2, told=lambda done, total: told.append((done, total)))
    assert told[0] == (0, told[0][1])
    assert told[0][1] > 2


def test_the_friction_moment_of_balls_says_what_is_missing():
    for name, words in (("rolling-bearing", "sliding within the curved contacts"), ("roller", "roller ends")):
        changes = {} if name == "rolling-bearing" else {"rolling": "roller", "length": "11 mm"}
        element = element_of("rolling-bearing", thermal="off", **changes)
        said = dict(answer(element, run_all(element, most=2)))["friction moment"]
        assert words in said
        usual = 0.0015 * 4e3 * 20
        assert (f"{usual:.3g} N mm" in said) is (name == "rolling-bearing")
