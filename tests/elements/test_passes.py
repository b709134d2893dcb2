"""Scenes of lives and of running-in wear each body of an element as the element's own answer does, without a run."""

import math
import tomllib

import pytest

from bem import load_scene
from bem.elements.element import element_template, load_element
from bem.elements.passes import time_words
from bem.elements.rough_scenes import passes_in
from bem.elements.running import wear_per_pass
from bem.elements.scene_text import element_scene_text
from bem.scenes.wearing import wears_on_a_track

RATE = {"specific_wear_rate": "1e-9 mm^3/(N*m)"}
SOFT, HARD = "steel-52100", "case-hardened-steel"


def element_of(name, **changes):
    table = tomllib.loads(element_template(name)) | {"name": name} | RATE | changes
    if name == "plain-bush":  # without its layer, in which films have no heat
        table = {key: value for key, value in table.items() if key not in ("wall", "housing", "heat_balance")}
    return load_element(table)


def life_depths(made, contact):
    """Mean depths over the patch that a cycle of a life wears off (lower, upper) under the whole load [m]."""
    scene = load_scene(made)
    rates = scene.wear.rates(scene.bodies, scene.friction)
    return [rate * scene.wear.distance * contact.load / contact.length / made["grid"]["lengths"][0] for rate in rates]


def two_places(element):
    """Places far apart, at which the surfaces do not run against each other."""
    found = [one for one in element.found.contacts if 0 < abs(one.slide_roll_ratio) <= 2 and one.speeds[1]]
    return found[0], found[len(found) * 4 // 5]


GEARS = {"module": "4 mm", "teeth": [19, 61], "face_width": "40 mm", "torque": "420 N*m", "speed": "1450 rpm"} | {
    "profile_shifts": [0, 0],
    "tip_diameters": ["84 mm", "252 mm"],
}


@pytest.mark.parametrize(("name", "changes"), [("gear-pair", GEARS), ("cam-follower", {})])
def test_a_life_wears_both_bodies_as_the_element(name, changes):
    """At A of this pair the pinion's depth was 3.9 times too small and the wheel's 5.5 times too large."""
    element = element_of(name, **changes)
    first, second = element.found.passes
    each = 1.0 if second is None else second / first  # of a follower the passes are taken to be those of the cam
    for place in two_places(element):
        depths = life_depths(element.scene(place, "running-in-life"), place)
        lower, upper = wear_per_pass(element, place)
        assert depths == pytest.approx([lower, each * upper], rel=1e-12, abs=0)


def test_the_wear_of_a_life_at_the_ends_of_a_path():
    """Depths after 10^6 passes of the pinion by hand: 1e-18 m2/N times 98.0 kN/m times the sliding per pass."""
    element = element_of("gear-pair", **GEARS)
    marked = element.found.marked
    for mark, by_hand in (("A", (554.9e-9, 25.95e-9)), ("E", (53.0e-9, 35.9e-9))):
        depths = life_depths(element.scene(marked[mark], "running-in-life"), marked[mark])
        assert [1e6 * depth for depth in depths] == pytest.approx(by_hand, rel=3e-3, abs=0)
    made = element.scene(marked["A"], "running-in-life")
    assert "1000000 cycles, passes of the pinion, take 11 h" in made["description"]
    assert "slid by a place of the wheel" in element_scene_text(element, made)


def test_a_body_under_a_contact_that_stays_slides_all_the_time():
    """A ring slides the stroke while a place of the liner passes once."""
    ring = element_of("piston-ring")
    place = ring.worst()
    made = ring.scene(place, "running-in-life")
    lower, upper = life_depths(made, place)
    pressure = place.load / place.length / made["grid"]["lengths"][0]
    assert lower == pytest.approx(wear_per_pass(ring, place)[0], rel=1e-12, abs=0)
    assert upper == pytest.approx(1e-18 * pressure * ring.model.stroke, rel=1e-12, abs=0)
    assert load_scene(made).wear.passes == "lower"
    count = made["life"]["count"]
    assert f"take {time_words(count * math.pi / ring.model.speed)}" in made["description"]
    # the scar, a flat of width w that takes off w^3 / 12 R, reached the ends of the patch after 10^5 strokes
    scar = (12 * place.radius * count * upper * made["grid"]["lengths"][0]) ** (1 / 3)
    assert 0.45 < scar / made["grid"]["lengths"][0] < 0.55


def test_a_bush_slides_around_the_shaft_in_a_turn_and_over_both_ways_in_a_swing():
    bush = element_of("plain-bush")
    for changes, around, unit in (
        ({}, math.pi, "turns of the shaft"),
        (
            {"speed": None, "oscillation": {"amplitude": "30 deg", "frequency": "2 Hz"}},
            math.pi / 3,
            "swings of the shaft",
        ),
    ):
        table = {key: value for key, value in (bush.table | changes).items() if value is not None}
        element = load_element(table)
        passes = passes_in(element.scene(element.worst(), "running-in"), element.model, element.found.passes)
        assert passes.slid[1] == pytest.approx(around * element.model.shaft_diameter, rel=1e-9, abs=0)
        assert passes.unit == unit


@pytest.mark.parametrize(
    ("name", "changes", "worn", "track"),
    [
        ("gear-pair", {}, 0, True),
        ("gear-pair", {"first": HARD, "second": SOFT}, 1, True),
        ("cam-follower", {}, 0, True),
        ("piston-ring", {}, 0, True),
        ("plain-bush", {}, 1, False),
    ],
)
def test_running_in_wears_as_many_passes_as_its_comment_says(name, changes, worn, track):
    """Of a softer wheel running-in wore a groove, as wide as the contact, in place of its whole track."""
    element = element_of(name, **changes)
    still = (element.found.contacts[0],)  # the contact does not move on the ring or the bush
    for place in still if name in ("piston-ring", "plain-bush") else two_places(element):
        made = element.scene(place, "running-in")
        scene, per_pass = load_scene(made), wear_per_pass(element, place)
        assert wears_on_a_track(scene) is track
        passes, criterion = passes_in(made, element.model, element.found.passes), scene.wear.criterion
        depth = 1e-18 * criterion.distance * place.load / place.length / made["grid"]["lengths"][0]  # of a cycle
        number = criterion.distance / passes.slid[worn]
        rates = element.found.passes
        each = rates[1] / rates[0] if worn == 1 and rates[1] else 1.0
        if track:
            assert number * each * per_pass[worn] == pytest.approx(depth, rel=1e-9, abs=0)
        comment = f"each stands for {float(f'{number:.3g}'):g} {passes.unit}"
        assert comment in element_scene_text(element, made)


def test_a_contact_that_stands_still_on_the_follower_wears_the_cam():
    """At the ends of the flanks, where the film is the thinnest, no pass of the follower has a sliding distance."""
    element = element_of("cam-follower")
    place = element.thinnest_steady()
    assert place.speeds[1] == 0
    made = element.scene(place, "running-in-life")
    lower, upper = life_depths(made, place)
    assert (lower, upper) == (pytest.approx(wear_per_pass(element, place)[0], rel=1e-12, abs=0), 0.0)
    assert "stands still on the follower" in made["description"]
    assert load_scene(made).wear.passes == "lower"


@pytest.mark.parametrize(
    ("seconds", "words"), [(0.72, "0.72 s"), (72.0, "72 s"), (473.0, "7.9 min"), (41379.0, "11 h"), (4e5, "4.6 days")]
)
def test_times_are_read_at_a_glance(seconds, words):
    assert time_words(seconds) == words
