"""The one-screen answer: rows of every element, pressure in place of load, temperatures of the bodies, the command."""

import dataclasses
import functools
import math
import re
import tomllib

import pytest
from command_line import run_command

from bem import InputError
from bem.elements.answer import PLACES, _balanced, answer, balance_heat, friction_power, likely_power
from bem.elements.bearing_life import bearing_life, life_notes, life_of_film, life_rows
from bem.elements.element import MODELS, element_template, load_element
from bem.elements.gear_scuffing import (
    friction_of_gear_tests,
    mean_flash_temperature,
    scuffing_of,
    sliding_power,
)
from bem.elements.rating_life import dynamic_rating
from bem.elements.running import operating_places, run_all, run_contact
from bem.notes import Level
from bem.notes.elements import OIL_FOLLOWS_BALANCE

STEEL_BEARING = {
    "element": "rolling-bearing", "name": "nu208", "rolling": "roller", "bore": "40 mm", "outside": "80 mm",
    "diameter": "11 mm", "length": "11 mm", "count": 14, "radial_load": "15 kN", "clearance": "20 um",
    "speed": "1500 rpm", "first": "steel-52100", "second": "steel-52100", "rms_roughness": "100 nm",
    "oil": {"grade": "ISO VG 220", "temperature": "70 degC"},
}  # fmt: skip


def element_of(name, **changes):
    table = tomllib.loads(element_template(name)) | {"name": name} | changes
    return load_element({key: value for key, value in table.items() if value is not None})


@pytest.mark.parametrize("name", ["rolling-bearing", "gear-pair"])
def test_a_pressure_in_place_of_the_load(name):
    """The load that it stands for gives that pressure: under the most loaded element, at the pitch point."""
    load = {"rolling-bearing": "radial_load", "gear-pair": "torque"}[name]
    found = element_of(name, **{load: None, "hertz_pressure": "1.2 GPa"})
    at = (
        found.worst()
        if name == "rolling-bearing"
        else min(found.found.contacts, key=lambda one: abs(one.place - found.found.marks["C"]))
    )
    # the row nearest to C is up to half a step beside it
    assert at.hertz(found.modulus).maximum_pressure == pytest.approx(1.2e9, rel=1e-9 if load == "radial_load" else 2e-3)
    given = found.model.load if load == "radial_load" else found.model.pinion_torque
    again = element_of(name, **{load: given})
    assert [one.load for one in again.found.contacts] == pytest.approx(
        [one.load for one in found.found.contacts], rel=1e-6
    )
    for wrong, words in (({load: None}, "neither"), ({"hertz_pressure": "1 GPa"}, "both")):
        with pytest.raises(InputError, match=f"{words} .*hertz_pressure"):
            element_of(name, **wrong)


def test_a_pressure_under_helical_teeth_and_rollers():
    gears = element_of(
        "gear-pair", torque=None, tip_diameters=None, helix_angle="20 deg", points=401, hertz_pressure="1.2 GPa"
    )
    pitch = min(gears.found.contacts, key=lambda one: abs(one.place))
    assert pitch.hertz(gears.modulus).maximum_pressure == pytest.approx(1.2e9, rel=1e-3)
    rollers = {key: value for key, value in STEEL_BEARING.items() if key != "radial_load"}
    found = load_element(rollers | {"hertz_pressure": "1.2 GPa"})
    assert found.worst().hertz(found.modulus).maximum_pressure == pytest.approx(1.2e9)


def test_a_selection_of_places_holds_marks_and_extremes():
    gears = element_of("gear-pair", points=201)
    places = operating_places(gears, PLACES)
    assert PLACES <= len(places) <= PLACES + 7
    assert gears.worst() in places
    for mark in gears.found.marks.values():
        assert min(abs(one.place - mark) for one in places) <= 0.5 * 19.1e-3 / 200
    assert operating_places(gears) == gears.found.contacts
    cam = element_of("cam-follower")
    assert all(abs(one.slide_roll_ratio) <= 2 for one in operating_places(cam, PLACES))


@pytest.mark.internal
def test_a_selection_has_nearly_the_power_of_all_places():
    gears = element_of("gear-pair", points=21)
    whole, some = (friction_power(gears, run_all(gears, most=most)) for most in (None, 9))
    assert some.film == pytest.approx(whole.film, rel=0.05)
    assert whole.with_asperities > whole.film


def test_contacts_alike_are_solved_once(monkeypatch):
    import bem.elements.running as running

    calls = []
    monkeypatch.setattr(running, "run_contact", lambda element, one: calls.append(one) or run_contact(element, one))
    bearing = element_of("rolling-bearing", count=5)
    runs = run_all(bearing)
    assert [one.contact for one in runs] == list(bearing.found.contacts)
    assert len(calls) < len(runs)


@pytest.mark.internal
def test_every_element_answers_with_film_friction_and_temperatures():
    for name in MODELS:
        element = element_of(name)
        places = operating_places(element)[:: 20 if name != "rolling-bearing" else 4]
        said = dict(answer(element, [run_contact(element, one) for one in places]))
        assert {"critical contact", "lambda ratio", "friction power", "temperatures", "wear per hour"} <= set(said)
        assert ("scuffing" in said, "efficiency" in said) == (name == "gear-pair", name == "gear-pair")
        assert ("basic rating life" in said, "friction moment" in said) == (name == "rolling-bearing",) * 2
        assert "GPa" in said["critical contact"] or "MPa" in said["critical contact"]


def test_lives_of_a_bearing():
    """Basic life by hand from C of the geometry; kappa from the oil; a catalogue's C counts where it is given."""
    found = load_element(STEEL_BEARING)
    life = bearing_life(found)
    rating = dynamic_rating(found.model.geometry)
    assert life.rating.basic == pytest.approx(1e6 * (rating / 15e3) ** (10 / 3))
    oil = found.model.oil.build()
    needed = 4500e-6 / math.sqrt(1500 * 60)
    assert life.rating.viscosity_ratio == pytest.approx(oil.viscosity / oil.density / needed)
    assert life.rating.contamination == pytest.approx(0.55)
    catalogue = bearing_life(load_element(STEEL_BEARING | {"dynamic_load_rating": "53.9 kN"}))
    assert catalogue.rating.basic == pytest.approx(1e6 * (53.9 / 15) ** (10 / 3))
    clean = bearing_life(load_element(STEEL_BEARING | {"cleanliness": "extreme"}))
    assert clean.rating.modified > life.rating.modified
    assert clean.reference.basic == life.reference.basic
    tilted = bearing_life(load_element(STEEL_BEARING | {"tilt": "2 mrad"}))
    assert tilted.reference.basic < life.reference.basic
    assert life.slice_pressure == pytest.approx(found.worst().hertz(found.modulus).maximum_pressure, rel=1e-9)
    assert tilted.slice_pressure > life.slice_pressure
    safer = bearing_life(load_element(STEEL_BEARING | {"reliability": 99}))
    assert safer.rating.modified == pytest.approx(0.25 * life.rating.modified)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"cleanliness": "normal", "contamination_factor": 0.5}, "both cleanliness and contamination_factor"),
        ({"cleanliness": "clean"}, "cleanliness"),
        ({"reliability": 92}, "reliability"),
        ({"rolling": "ball", "length": None, "tilt": "1 mrad"}, "tilt of a ball bearing"),
        ({"bulk_temperature": "80 degC", "heat_balance": {"conductance": "5 W/K"}}, "one of both"),
        ({"heat_balance": {"conductance": "5 W"}}, "heat conductance"),
        ({"oil": None, "heat_balance": {"conductance": "5 W/K"}}, "temperature of an oil"),
    ],
)
def test_mistakes_in_ratings_and_temperatures_are_said(change, words):
    table = {key: value for key, value in (STEEL_BEARING | change).items() if value is not None}
    with pytest.raises(InputError, match=words):
        load_element(table)


def test_life_without_a_kinematic_viscosity_is_the_basic_one():
    own = {"viscosity": "40 mPa*s", "pressure_viscosity": "20 1/GPa"}
    said = dict(answer(load_element(STEEL_BEARING | {"oil": own}), []))
    assert "kinematic viscosity is missing" in said["modified rating life"]
    assert "L10 = " in said["basic rating life"]
    assert "roll at one speed without sliding" in said["wear per hour"]  # known without a wear rate
    thin = STEEL_BEARING["oil"] | {"grade": "ISO VG 10", "temperature": "120 degC"}
    assert (
        "below 0.1"
        in dict(answer(load_element(STEEL_BEARING | {"oil": thin, "speed": "30 rpm"}), []))["modified rating life"]
    )


def test_films_are_solved_at_the_temperature_of_the_bodies():
    """Scenes of films start there, dry heat has it, and the formula's film is thinner."""
    cold, warm = (load_element(STEEL_BEARING | change) for change in ({}, {"bulk_temperature": "95 degC"}))
    place = warm.worst()
    assert warm.scene(place, "traction")["oil"]["temperature"] == pytest.approx(368.15)
    assert warm.scene(place, "surface-temperature")["heat"]["lower_bulk"] == pytest.approx(368.15)
    assert min(warm.columns()["minimum_film [m]"]) < 0.7 * min(cold.columns()["minimum_film [m]"])
    assert bearing_life(warm).rating.viscosity_ratio < bearing_life(cold).rating.viscosity_ratio
    assert cold.at_bulk(368.15).columns() == warm.columns()


@pytest.mark.internal
def test_the_heat_balance_balances():
    """Bodies are warmer than the surroundings by friction power over conductance, at that temperature."""
    gears = element_of("gear-pair", points=5, heat_balance={"conductance": "20 W/K", "ambient": "60 degC"})
    warm = balance_heat(gears, most=5)
    power = likely_power(warm, run_all(warm, most=5))
    assert power == pytest.approx(sliding_power(gears, friction_of_gear_tests(warm).power))  # oil as warm as bodies
    assert warm.model.bulk_temperature == pytest.approx(333.15 + power / 20, abs=0.5)
    assert warm.model.bulk_temperature > 345
    rollers = load_element(STEEL_BEARING | {"heat_balance": {"conductance": "2 W/K"}})
    hot = balance_heat(rollers)
    power = friction_power(hot, run_all(hot)).with_asperities
    assert hot.model.bulk_temperature == pytest.approx(343.15 + power / 2, abs=0.5)
    assert hot.model.bulk_temperature > 348
    plain = load_element(STEEL_BEARING)
    assert balance_heat(plain) is plain


def test_a_heat_balance_far_from_the_surroundings_is_found():
    """The first step of the secants leaves the temperatures of the oil: 40 W at 20 degC over 0.1 W/K."""
    hot = _balanced(_cooled, 293.15)
    assert 0.1 * (hot - 293.15) == pytest.approx(40 * math.exp(-0.03 * (hot - 293.15)), abs=0.02)
    with pytest.raises(InputError, match="no temperature is found"):
        _balanced(lambda at: 1.0, 293.15)


def _cooled(temperature):
    if temperature > 573:
        raise InputError("oils crack")
    return 293.15 + 40 * math.exp(-0.03 * (temperature - 293.15)) / 0.1 - temperature


def test_with_an_ambient_the_oil_is_as_warm_as_the_bodies():
    """The oil's own temperature is not used, and a caution says so; none without it, or without an ambient."""
    ambient = {"conductance": "2 W/K", "ambient": "40 degC"}
    found = load_element(STEEL_BEARING | {"heat_balance": ambient}).at_bulk(325.15)
    said = dict(answer(found, [run_contact(found, found.worst())]))["temperatures"]
    assert said.startswith("oil and bodies 52 °C by the heat balance with surroundings of 40 °C, at which films")
    (caution,) = [str(note) for note in found.notes() if note.code == OIL_FOLLOWS_BALANCE.code]
    assert "52 °C; oil.temperature, 70 °C, is not used" in caution
    given = {"grade": "ISO VG 220"}
    alone = load_element(STEEL_BEARING | {"heat_balance": ambient, "oil": given}).at_bulk(325.15)
    assert OIL_FOLLOWS_BALANCE.code not in [note.code for note in alone.notes()]
    assert alone.columns() == found.columns()
    to_oil = load_element(STEEL_BEARING | {"heat_balance": {"conductance": "2 W/K"}}).at_bulk(348.15)
    assert OIL_FOLLOWS_BALANCE.code not in [note.code for note in to_oil.notes()]
    with pytest.raises(InputError, match="temperature"):
        load_element(STEEL_BEARING | {"heat_balance": {"conductance": "2 W/K"}, "oil": given})


@pytest.mark.parametrize("name", ["gear-pair", "cam-follower", "piston-ring"])
def test_an_ambient_leaves_no_trace_of_the_oils_temperature(name):
    """Temperature of the balance, friction of gear tests and scuffing are the same for any oil.temperature."""
    balance = {"conductance": "20 W/K", "ambient": "30 degC"}
    more = {"scuffing_load_stage": 12, "points": 5} if name == "gear-pair" else {}
    said = set()
    for temperature in ({"temperature": "100 degC"}, {}):
        oil = {"grade": "ISO VG 150", **temperature}
        found = balance_heat(element_of(name, heat_balance=balance, oil=oil, rms_roughness="700 nm", **more), most=2)
        said.add((found.model.bulk_temperature, *answer(found, [run_contact(found, operating_places(found, 2)[0])])))
    assert len(said) == 1
    assert name != "gear-pair" or "safety factor" in dict(next(iter(said))[1:])["scuffing"]


@pytest.mark.internal
def test_asperities_take_nothing_off_rolling_resistance():
    """Pure rolling: one friction power of any roughness, in the answer, the table of cases and the heat balance."""
    powers = {}
    for roughness in ("50 nm", "400 nm"):
        rough = load_element(STEEL_BEARING | {"rms_roughness": roughness})
        runs = run_all(rough, most=3)
        power = friction_power(rough, runs)
        assert likely_power(rough, runs) == power.with_asperities == pytest.approx(power.film)
        assert all(one.rolling_power == pytest.approx(one.power) for one in runs)
        powers[roughness] = power.film
    assert max(one.asperity_share for one in runs) > 0.2
    assert powers["400 nm"] == pytest.approx(powers["50 nm"])
    hot = balance_heat(
        load_element(STEEL_BEARING | {"rms_roughness": "400 nm", "heat_balance": {"conductance": "2 W/K"}})
    )
    shown = float(dict(answer(hot, run_all(hot, most=PLACES)))["friction power"].partition(" W")[0])
    assert hot.model.bulk_temperature - 343.15 == pytest.approx(shown / 2, abs=0.25)


@pytest.mark.internal
def test_asperities_replace_their_share_of_the_films_sliding():
    """A flank: rolling resistance whole, sliding friction of film and asperities by their shares."""
    gears = element_of("gear-pair", points=5)
    one = run_contact(gears, gears.found.contacts[0])
    slid = one.contact.load * abs(one.contact.speeds[0] - one.contact.speeds[1])
    expected = (
        one.rolling_power
        + (1 - one.asperity_share) * (one.power - one.rolling_power)
        + 0.12 * one.asperity_share * slid
    )
    assert 0 < one.rolling_power < 0.5 * one.power
    power = friction_power(gears, [one]).with_asperities
    whole = gears.found.mean(lambda other: other.load) * gears.found.at_once
    assert power == pytest.approx(expected / one.contact.load * whole)


def test_films_of_gears_are_at_the_estimated_bulk_temperature():
    """Without one of the file: the oil's plus 0.7 mean flash temperatures, as in scuffing; else that of the file."""
    gears = element_of("gear-pair", points=5)
    warm = balance_heat(gears)
    oil = gears.model.oil.temperature
    mean = mean_flash_temperature(gears, friction_of_gear_tests(gears).scuffing)
    assert warm.model.bulk_temperature == pytest.approx(oil + 0.7 * mean)
    runs = [run_contact(warm, warm.found.contacts[0])]
    assert scuffing_of(warm, runs).bulk == warm.model.bulk_temperature
    assert scuffing_of(warm, runs).estimated
    said = dict(answer(warm, runs))
    assert "estimate: oil + 0.7 x mean flash temperature" in said["temperatures"]
    cool = float(re.search(r"about ([\d.]+) if the flanks", said["lambda ratio"])[1])
    assert cool == pytest.approx(run_contact(gears, gears.found.contacts[0]).film_ratio, rel=0.05)
    assert warm.model.film_oil.temperature == warm.model.bulk_temperature
    for change in (
        {"bulk_temperature": "100 degC"},
        {"rms_roughness": None},
        {"oil": {"viscosity": "10 mPa*s", "pressure_viscosity": "20 1/GPa", "temperature": "90 degC"}},
    ):
        known = element_of("gear-pair", points=5, **change)
        assert balance_heat(known) is known


def test_boundary_friction_of_the_element_is_that_of_its_scenes():
    gears = element_of("gear-pair", boundary_friction=0.09)
    scene = gears.scene(gears.worst(), "friction")
    assert scene["contact"]["boundary_friction"] == 0.09
    assert "boundary friction" not in scene["description"]
    assert (
        "boundary friction 0.12 is assumed" in element_of("gear-pair").scene(gears.worst(), "friction")["description"]
    )


@pytest.fixture
def bem(tmp_path):
    (tmp_path / "gears.toml").write_text(element_template("gear-pair").replace("points = 41", "points = 7"))
    (tmp_path / "bearing.toml").write_text(element_template("rolling-bearing"))
    return functools.partial(run_command, cwd=tmp_path)


def test_the_command_answers_on_one_screen(bem, tmp_path):
    done = bem("element", "gears.toml", "--figure", "gears.png")
    assert done.returncode == 0, done.stderr
    for name in ("critical contact", "lambda ratio", "efficiency", "temperatures", "scuffing", "micropitting"):
        assert f"\n{name} " in done.stdout
    assert done.stdout.count("\n") < 30
    assert (tmp_path / "gears.png").stat().st_size > 10_000
    table = bem("element", "gears.toml", "--contacts")
    assert "Hertz pressure (GPa)" in table.stdout
    assert "slower one, as before the pitch point" in table.stdout
    assert "degC" not in table.stdout
    assert bem("element", "gears.toml", "--scene", "c.toml", "--at", "C").returncode == 0
    assert (
        "allowed: worst, thinnest, path, A, B, C"
        in bem("element", "gears.toml", "--scene", "f.toml", "--at", "F").stderr
    )


def test_words_of_life_and_scuffing_lead_to_their_element(bem, tmp_path):
    for word, name in (("bearing-life", "rolling-bearing"), ("l10", "rolling-bearing"), ("scuffing", "gear-pair")):
        assert bem("new", word, "made.toml").returncode == 0
        assert f'element = "{name}"' in (tmp_path / "made.toml").read_text()
        (tmp_path / "made.toml").unlink()


def test_a_favourable_kappa_beside_a_thin_film_is_said():
    """ISO 281 relates kappa to lambda^1.3; the life with the film's own kappa stands beside."""
    rough = load_element(STEEL_BEARING | {"rms_roughness": "280 nm"})
    (note,) = life_notes(rough, 1.1)
    assert note.code == "kappa-above-film"
    assert note.values["film"] == pytest.approx(1.1**1.3)
    assert note.values["kappa"] == bearing_life(rough).rating.viscosity_ratio > 3
    assert note.level is Level.CAUTION
    film = life_of_film(rough, 1.1)
    assert film.rating.modified < bearing_life(rough).rating.modified
    assert film.modified_reference < bearing_life(rough).modified_reference
    said = dict(life_rows(rough, 1.1))
    assert f"L10m = {film.rating.modified / 1e6:.3g} million" in said["modified rating life"]
    assert f"with kappa = {1.1**1.3:.3g}, for which lambda = 1.1 of these rough" in said["modified rating life"]
    assert "given first" in str(note)
    assert "with the kappa of lambda (" in said["reference rating life"]
    assert "lambda" not in str(life_rows(rough, 3.0))
    assert life_notes(rough, 3.0) == ()
    assert life_notes(rough, None) == ()
    heavy = load_element(STEEL_BEARING | {"radial_load": "40 kN"})
    (note,) = life_notes(heavy, None)
    assert (note.code, note.level) == ("load-above-life-formula", Level.CAUTION)


def test_no_life_is_recommended_where_iso_281_defines_none():
    rough = load_element(STEEL_BEARING | {"rms_roughness": "1 um"})
    (note,) = life_notes(rough, 0.066)
    assert "kappa of lambda is 0.029, below 0.1" in note.headline
    assert "given first" not in str(note)
    said = dict(life_rows(rough, 0.066))["modified rating life"]
    assert said.startswith("L10m not defined: kappa 0.029")


def test_a_load_above_the_static_rating_is_a_caution():
    life = bearing_life(load_element(STEEL_BEARING))
    for factor, told in ((0.99, False), (1.01, True)):
        load = factor * life.static_rating / life.static_load * load_element(STEEL_BEARING).model.load
        notes = life_notes(load_element(STEEL_BEARING | {"radial_load": f"{load} N"}), None)
        assert ("static-load-above-rating" in [note.code for note in notes if note.level is Level.CAUTION]) is told


def test_a_speed_without_a_unit_is_said_in_rpm():
    note = load_element(STEEL_BEARING | {"speed": 1500}).speed_note()
    assert "14323.9 rpm" in str(note)
    assert load_element(STEEL_BEARING).speed_note() is None


@pytest.mark.parametrize(
    ("name", "change", "words"),
    [
        ("rolling-bearing", {"ra": "0.3 um"}, "write rms_roughness"),
        ("rolling-bearing", {"groove": "6.2 mm"}, "diameter of a ball, such as 0.52"),
        ("rolling-bearing", {"foo": 1}, "allowed at the top of the file"),
        ("gear-pair", {"scuffing_load_stage": 20}, "load stage of the FZG test from 1 to 14"),
    ],
)
def test_mistakes_are_said_in_words_of_the_element(name, change, words):
    with pytest.raises(InputError, match=words):
        element_of(name, **change)


def test_a_scene_of_mixed_friction_is_of_the_thinnest_film(bem, tmp_path):
    """Of the highest pressure with --at worst; a kind without --scene is refused."""
    done = bem("element", "gears.toml", "--scene", "mixed.toml", "--kind", "friction")
    assert done.returncode == 0, done.stderr
    assert "contact with the thinnest film, A (9.5 mm before C)" in done.stdout
    assert "The highest pressure is at B" in done.stdout
    assert "allowed: --scene FILE" in bem("element", "gears.toml", "--kind", "friction").stderr
    assert bem("element", "bearing.toml", "--scene", "rolls.toml", "--kind", "friction").returncode == 0
    assert "slide_roll_ratio = 0.0    # pure rolling" in (tmp_path / "rolls.toml").read_text()


@pytest.mark.internal
@pytest.mark.parametrize(("rise", "words"), [(0.39, "flash temperature below 1 K"), (2.6, "surfaces by up to 2.6 K")])
def test_surfaces_that_roll_are_as_warm_as_the_figure_shows_them(rise, words):
    """ "No flash temperature" stood beside surfaces that the figure drew 0.39 K warmer."""
    found = load_element(STEEL_BEARING)
    one = run_contact(found, found.worst())
    run = dataclasses.replace(one, flash=0.0, surface=found.model.oil.temperature + rise)
    assert f"{words}, as both surfaces roll" in dict(answer(found, [run]))["temperatures"]
