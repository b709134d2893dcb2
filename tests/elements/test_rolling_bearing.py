"""Load share against tabulated integrals, speeds against the kinematics solved anew, Hertz' stiffness."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad

from bem import CATALOGUE, InputError, contact_modulus
from bem.cli.new import element_text
from bem.elements.answer import answer_notes, balance_heat, friction_power
from bem.elements.bearing_life import bearing_life, life_notes
from bem.elements.element import ALIASES, MODELS, NOT_MODELLED, element_template, load_element
from bem.elements.rolling_bearing import BearingModel, _centrifugal, load_integral, share
from bem.elements.running import Running, run_all
from bem.errors import Status
from bem.notes import Level, has_code
from bem.notes.checks import SLOPES_LARGE
from bem.notes.elements import GLYCOL_ASSUMED, RATING_NOT_OF_GEOMETRY
from bem.notes.general import VALUE_UNUSUAL
from bem.reference_solutions.hertz import ellipse_contact

STEEL = "steel-52100"
BALLS = {
    "element": "rolling-bearing", "bore": "40 mm", "outside": "80 mm", "diameter": "11.9 mm", "count": 9,
    "radial_load": "4 kN", "speed": "3000 rpm", "first": STEEL, "second": STEEL,
}  # fmt: skip
ROLLERS = BALLS | {"rolling": "roller", "length": "12 mm", "diameter": "10 mm", "count": 14}


@pytest.mark.internal
@pytest.mark.parametrize(("power", "factor", "tabulated"), [(1.5, 0.5, 0.2288), (1.1, 0.5, 0.2453)])
def test_load_integrals_are_those_of_the_tables(power, factor, tabulated):
    """Harris, Rolling Bearing Analysis, table of J_r at half a load zone (its lines have n = 1.1): four digits."""
    assert load_integral(factor, power, quad) == pytest.approx(tabulated, abs=2e-4)


@pytest.mark.internal
@pytest.mark.parametrize("power", [1.5, 10 / 9])
@pytest.mark.parametrize("clearance", [0.0, 5e-6, 50e-6])
def test_many_elements_share_as_the_integral_says(power, clearance):
    """F_r = Z Q_max J_r(epsilon), epsilon = (1 - c / 2 delta) / 2; 400 elements are nearly a continuum."""
    count, load, stiffness = 400, 1e4, 1e9 if power == 1.5 else 1e8
    angles = [2 * math.pi * i / count for i in range(count)]
    loads = share(load, stiffness, power, clearance, angles)
    assert sum(q * math.cos(a) for q, a in zip(loads, angles, strict=True)) == pytest.approx(load, rel=1e-10)
    pressed = (loads[0] / stiffness) ** (1 / power)
    factor = 0.5 * (1 - 0.5 * clearance / (pressed + 0.5 * clearance))
    # the rule of rectangles with 400 points over a function with a kink: 1e-4
    assert load / (count * loads[0]) == pytest.approx(load_integral(factor, power, quad), rel=2e-4)


@pytest.mark.internal
def test_stribecks_numbers():
    """Q_max = 4.37 F_r / Z for balls, 4.08 F_r / Z for rollers without clearance."""
    for power, number in ((1.5, 4.37), (10 / 9, 4.08)):
        loads = share(1.0, 1.0, power, 0.0, [2 * math.pi * i / 400 for i in range(400)])
        assert loads[0] * 400 == pytest.approx(number, abs=0.005)


@pytest.mark.internal
def test_a_ball_is_as_stiff_as_both_its_hertz_contacts():
    element = load_element(BALLS)
    inner, outer = element.found.contacts[:2]
    modulus = contact_modulus(CATALOGUE[STEEL]) / 2
    assert element.modulus == pytest.approx(modulus)
    both = sum(
        ellipse_contact(radii=(one.radius, one.across), contact_modulus=modulus, load=inner.load).approach
        for one in (inner, outer)
    )
    loads = share(4e3, inner.load / both**1.5, 1.5, 0.0, [2 * math.pi * i / 9 for i in range(9)])
    assert loads[0] == pytest.approx(inner.load, rel=1e-9)


@pytest.mark.internal
def test_surfaces_roll_as_the_parts_turn():
    """Turning speeds of cage and ball from no slip at both rings, as two equations; then both surfaces' speeds less
    that of the contact."""
    model = load_element(BALLS).model
    assert isinstance(model, BearingModel)
    ball, pitch, omega = model.diameter / 2, model.pitch / 2, model.speed
    # at the inner ring: cage * pitch - spin * ball = omega (pitch - ball); at the outer: cage * pitch + spin * ball = 0
    cage, spin = np.linalg.solve([[pitch, -ball], [pitch, ball]], [omega * (pitch - ball), 0.0])
    inner, outer = load_element(BALLS).found.contacts[:2]
    for contact, ring, at in ((inner, omega, pitch - ball), (outer, 0.0, pitch + ball)):
        moves = cage * at
        side = -1 if at < pitch else 1
        of_ring, of_ball = ring * at - moves, cage * pitch + side * spin * ball - moves
        assert of_ring == pytest.approx(of_ball)
        assert abs(of_ring) == pytest.approx(contact.speeds[0], rel=1e-12)
        assert contact.slide_roll_ratio == 0


def test_curvatures_of_rings():
    inner, outer = load_element(BALLS).found.contacts[:2]
    ball = 11.9e-3 / 2
    assert 1 / inner.radius == pytest.approx(1 / ball + 1 / (30e-3 - ball))
    assert 1 / outer.radius == pytest.approx(1 / ball - 1 / (30e-3 + ball))
    assert 1 / inner.across == pytest.approx(1 / ball - 1 / (0.52 * 11.9e-3))


def test_centrifugal_force_is_in_the_outer_contact_alone():
    slow, fast = (load_element(BALLS | {"speed": speed}) for speed in ("1 rpm", "12000 rpm"))
    assert slow.found.contacts[0].load == pytest.approx(fast.found.contacts[0].load)
    mass = 7810 * math.pi * 11.9e-3**3 / 6
    cage = 0.5 * 12000 * 2 * math.pi / 60 * (1 - 11.9 / 60)
    expected = mass * 30e-3 * cage**2
    assert fast.found.contacts[1].load - fast.found.contacts[0].load == pytest.approx(expected)
    assert "Centrifugal" in " ".join(load_element(BALLS | {"speed": "30000 rpm"}).found.geometry)


def test_speeds_of_rotation_by_their_angle():
    speeds = ("1500 rpm", "25 rps", "25 turn/s", "9000 deg/s", "157.07963267949 rad/s", 157.07963267949)
    found = [load_element(BALLS | {"speed": speed}).model.speed for speed in speeds]
    assert found == pytest.approx([50 * math.pi] * len(speeds), rel=1e-12)


def test_rollers_touch_in_lines():
    found = load_element(ROLLERS)
    worst = found.worst()
    assert worst.name == "inner ring, 0 deg"
    assert worst.length == pytest.approx(12e-3)
    assert worst.load > 1.5 * worst.carried  # the highest slice of a profiled roller under a light load
    straight = load_element(ROLLERS | {"profile": "straight"}).worst()
    assert straight.load == pytest.approx(straight.carried, rel=1e-12)
    assert straight.carried < worst.carried  # fewer rollers carry, as those with a profile are pressed in further
    # 14 elements do not quite have the continuum's 4.08
    assert straight.load * 14 / 4e3 == pytest.approx(4.08, rel=0.02)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"outside": "30 mm"}, "outside is not larger than bore"),
        ({"count": 30}, "do not fit on the pitch circle"),
        ({"diameter": "25 mm"}, "do not fit between"),
        ({"rolling": "roller"}, "length of a roller"),
        ({"spead": "3 rpm"}, 'did you mean "speed"'),
        ({"first": "stel-52100"}, 'did you mean "steel-52100"'),
        ({"element": "journal-bearing"}, "plain-bush"),
        ({"element": "bering"}, "not allowed"),
        ({"reliability": "95"}, r'= "95": not allowed; allowed: 90, 95, 96, 97, 98, 99 \(a number without quotes\)$'),
        ({"reliability": 94}, r"= 94: not allowed; allowed: 90, 95, 96, 97, 98, 99$"),
        ({"speed": "3 m"}, "is not a speed of rotation"),
        ({"speed": "25 Hz"}, "says no angle"),  # was read as radians: 6.28 times too slow, without a word
        ({"speed": "25 1/s"}, "says no angle"),
        ({"radial_load": "10,5 kN"}, 'has a comma; write a decimal point, "10.5 kN"; allowed'),
        ({"radial_load": "10,5"}, 'write a decimal point, "10.5" and its unit'),
        (
            {"hertz_pressure": "1 GPa"},
            "both radial_load and hertz_pressure given; allowed: one of them; delete the other",
        ),
        ({"first": "100Cr6"}, 'did you mean "steel-52100"'),
        ({"first": "AISI 52100"}, 'did you mean "steel-52100"'),
        ({"first": "16MnCr5"}, 'did you mean "case-hardened-steel"'),
        ({"profile": "crowned"}, r"\(logarithmic: crowned or profiled rollers"),
    ],
)
def test_mistakes_are_said_with_what_is_allowed(change, words):
    with pytest.raises(InputError, match=words):
        load_element(BALLS | change)


@pytest.mark.parametrize(
    "speed", ["1500 1/min", "1500/min", "1500 min^-1", "1500 min-1", "1500 min⁻¹", "1.5e3 1 / min"]
)
def test_speeds_per_minute_are_turns(speed):
    """As drawings and catalogues write n; a remark says so."""
    element = load_element(BALLS | {"speed": speed})
    assert element.model.speed == load_element(BALLS | {"speed": "1500 rpm"}).model.speed
    assert element.speed_note().level is Level.INFO
    assert 'read as revolutions per minute. Write "1500 rpm"' in str(element.speed_note())
    assert load_element(BALLS | {"speed": "1500 rpm"}).speed_note() is None


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"clearance": 35}, 'write "35 um"'),
        ({"clearance": 0.035}, "35 mm"),
        ({"tilt": "1 deg"}, "some 1 mrad"),
        ({"clearance": "1 mm"}, None),
        ({"clearance": 0.0}, None),
        ({"tilt": "2 mrad"}, None),
    ],
)
def test_unusual_clearance_and_tilt_have_a_caution(change, words):
    found = [str(note) for note in load_element(ROLLERS | change).notes() if note.code == VALUE_UNUSUAL.code]
    assert len(found) == (words is not None)
    assert words is None or words in found[0]


def test_a_wide_contact_names_its_places():
    """One place is no "1 places"."""
    for load, words in (
        ("3.6 kN", "at inner ring, 0 deg: the gap"),
        ("20 kN", "at inner ring, 0 deg and 5 more places: the gap"),
    ):
        wide = load_element(BALLS | {"radial_load": load})
        (note,) = [str(one) for one in wide.notes() if one.code == SLOPES_LARGE.code]
        assert words in note


def test_the_template_is_a_good_one(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(element_template("bearing"))
    assert load_element(path).model.name == "mine"


def test_friction_of_tilted_rollers_is_the_sum_over_slices():
    """Of films whose power is as their load: that of the load of all slices, not of the most loaded ones."""
    element = load_element(ROLLERS | {"tilt": "2 mrad"})
    contacts = element.found.contacts

    def film(contact, load, lighter=()):
        return Running(
            replace(contact, load=load), Status.CONVERGED, 1e-7, None, 0.0, 1e-3 * load, None, None, lighter=lighter
        )

    # a cubic in the logarithm of the load: films closer by a factor of 1.1 leave 1e-3 of a straight line
    lighter = tuple(film(contacts[0], contacts[0].load / 1.1**k) for k in range(120))
    runs = [film(one, one.load, lighter) for one in contacts[:4]]
    slices = element.model.slices.loads
    carried = 2 * slices.sum() + (slices > 0).any(axis=1).sum() * _centrifugal(element.model)
    assert friction_power(element, runs).film == pytest.approx(1e-3 * carried, rel=1e-3)
    assert sum(one.load for one in contacts) > 1.5 * carried
    assert sum(one.carried for one in contacts) == pytest.approx(carried, rel=1e-9)
    roller = slices[np.unravel_index(slices.argmax(), slices.shape)[0]]
    assert f"critical roller has {roller.max() / roller.mean():.3g} times" in " ".join(element.found.geometry)


def test_tilted_rollers_have_the_pressure_of_their_most_loaded_slice():
    """That of the reference life, with and without tilt: a tilt that vanishes changes nothing."""
    for tilt in ("0 mrad", "0.001 mrad", "2 mrad"):
        element = load_element(ROLLERS | {"tilt": tilt})
        life = bearing_life(element)
        assert element.worst().hertz(element.modulus).maximum_pressure == pytest.approx(life.slice_pressure, rel=1e-9)
    assert "tilted" in " ".join(element.found.geometry)
    assert sum(element.model.shared) == pytest.approx(element.model.slices.loads.sum())
    even, hardly = (load_element(ROLLERS | {"tilt": tilt}).worst() for tilt in ("0 mrad", "1e-6 mrad"))
    assert even.load == pytest.approx(hardly.load, rel=1e-6)
    assert element.worst().load > 1.1 * even.load


@pytest.mark.internal
@pytest.mark.parametrize("profile", ["straight", "logarithmic"])
def test_the_hertz_pressure_of_tilted_rollers_is_the_highest_on_the_inner_ring(profile):
    given = {**ROLLERS, "radial_load": None, "hertz_pressure": "1.2 GPa", "clearance": "20 um", "profile": profile}
    even, tilted = load_element(given), load_element(given | {"tilt": "1 mrad"})
    for element in (even, tilted):
        assert element.worst().hertz(element.modulus).maximum_pressure == pytest.approx(1.2e9, rel=1e-6)
        assert bearing_life(element).slice_pressure == pytest.approx(1.2e9, rel=1e-6)
    assert tilted.model.load < even.model.load


@pytest.mark.internal
def test_water_glycol_has_a_stated_coefficient_and_thinner_films_than_mineral_oil():
    """About a third of the film of a mineral oil of its viscosity, as of polyglycol solutions (Wan et al. 1984)."""
    films = {}
    for grade in ("water-glycol 46", "ISO VG 46"):
        element = load_element(BALLS | {"oil": {"grade": grade, "temperature": "40 degC"}})
        films[grade] = element.columns()["minimum_film [m]"][0]
        assert has_code(element.notes(), GLYCOL_ASSUMED) is (grade != "ISO VG 46")
    assert films["water-glycol 46"] == pytest.approx(films["ISO VG 46"] / 3, rel=0.15, abs=0)


def test_a_rating_that_is_not_of_these_dimensions_is_named():
    """A ball of 1.9 mm in a bearing with the catalogue's 30 kN; the catalogue's ball, 11.9 mm, fits."""
    for diameter, told in (("1.19 mm", True), ("11.9 mm", False)):
        element = load_element(BALLS | {"diameter": diameter, "dynamic_load_rating": "32.5 kN"})
        assert has_code(life_notes(element, None), RATING_NOT_OF_GEOMETRY) is told


def test_a_heat_balance_of_balls_says_what_friction_it_lacks():
    """Films have about half of the usual friction, which counts cage and churning."""
    oil = {"grade": "ISO VG 46", "temperature": "70 degC", "shear_law": "base_oil"}
    table = BALLS | {"oil": oil, "heat_balance": {"conductance": "1 W/K", "ambient": "25 degC"}}
    element = balance_heat(load_element(table))
    (run,) = run_all(element, most=1)[:1]
    (note,) = [one for one in answer_notes(element, [run]) if one.code == "balance-below-usual"]
    usual = 0.0015 * 4000 * 0.02 * element.model.speed
    assert note.values["usual"] == pytest.approx(usual)
    films = note.values["films"]
    assert note.values["celsius"] == pytest.approx(25 + (element.model.bulk_temperature - 298.15) * usual / films)
    given = load_element(BALLS | {"oil": oil, "bulk_temperature": "70 degC"})
    assert not any(one.code == "balance-below-usual" for one in answer_notes(given, run_all(given, most=1)))


def test_every_word_for_an_element_is_known_to_bem_new():
    """The command knows them without loading elements."""
    words = {*ALIASES, *NOT_MODELLED, *MODELS}
    assert {word for word in words if not _of_new(word)} == set()
    assert 'rolling = "ball"' in element_text("deep groove ball bearing")
    with pytest.raises(InputError, match="Only radial deep groove ball and cylindrical roller bearings"):
        element_text("tapered roller bearing")


def _of_new(word):
    try:
        return bool(element_text(word))
    except InputError:
        return True


@pytest.mark.parametrize("table", [BALLS | {"count": 8}, ROLLERS | {"count": 12}])
def test_an_element_at_ninety_degrees_carries_nothing_without_clearance(table):
    """It carried 1e-17 of the load by rounding, and its film was refused."""
    element = load_element(table | {"clearance": 0})
    angles = {round(math.degrees(one.place)) for one in element.found.contacts}
    assert max(angles) < 90
    assert element.found.geometry[0].startswith(f"{len(angles)} of {table['count']}")


def test_centrifugal_force_presses_the_whole_of_a_lightly_loaded_roller():
    """Ends that the inner ring does not load were left without it: 0.28 of 0.88 N."""
    element = load_element(ROLLERS | {"speed": "6000 rpm", "clearance": "20 um", "radial_load": "6 kN"})
    pairs = {}
    for one in element.found.contacts:
        pairs.setdefault(one.place, {})[one.path] = one.carried
    for both in pairs.values():
        assert both["outer ring"] - both["inner ring"] == pytest.approx(_centrifugal(element.model), rel=1e-6, abs=0)


def test_the_balance_of_an_axial_load_is_compared_with_the_usual_moment_of_its_equivalent_load():
    oil = {"grade": "PAO 4", "temperature": "70 degC", "shear_law": "base_oil"}
    table = BALLS | {"oil": oil, "heat_balance": {"conductance": "1 W/K", "ambient": "25 degC"}}
    element = balance_heat(load_element(table | {"axial_load": "1 kN"}), most=2)
    (note,) = [one for one in answer_notes(element, run_all(element, most=2)) if one.code == "balance-below-usual"]
    load = bearing_life(element).rating.load
    assert load >= 4000
    assert note.values["usual"] == pytest.approx(0.0015 * load * 0.02 * element.model.speed)
