"""What is made of a contact is a good scene of that contact; tables have units; the command says where it ends."""

import csv
import functools
import math
import re
import tomllib

import pytest
from command_line import run_command

from bem import InputError, load_scene, plan_scene, run_scene
from bem.elements.answer import balance_heat
from bem.elements.contact import WIDE
from bem.elements.element import KINDS, LIFE, MODELS, element_template, load_element
from bem.elements.scene_text import scene_text
from bem.reference_solutions.hertz import PointContact
from bem.scenes.load import scene_from_table, scene_table


@pytest.fixture(params=MODELS)
def element(request, tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(element_template(request.param))
    return load_element(path)


def test_a_film_of_a_contact(element):
    """The worst one of those whose surfaces go the same way: under a cam's nose they run against each other."""
    steady = [one for one in element.found.contacts if abs(one.slide_roll_ratio) <= 2]
    worst = max(steady, key=lambda one: one.hertz(element.modulus).maximum_pressure)
    for other in element.found.contacts:
        if other not in steady:
            with pytest.raises(InputError, match=r"run against each other.*allowed: kind contact, or .*: 1 to "):
                element.scene(other, "traction")
    scene = load_scene(element.scene(worst, "traction"))
    assert scene.roller.load == pytest.approx(worst.load)
    lower, upper = scene.rolling.speeds
    assert (lower, upper) == pytest.approx(tuple(speed * (1 if worst.mean_speed > 0 else -1) for speed in worst.speeds))
    # the roller has the contact's highest pressure, of a point too
    line = element.modulus * scene.roller.load / scene.roller.width / (3.141592653589793 * scene.roller.radius)
    assert line**0.5 == pytest.approx(worst.hertz(element.modulus).maximum_pressure, rel=1e-12)


def test_a_dry_contact_has_the_same_hertz_contact(element):
    worst = element.worst()
    scene, _ = plan_scene(element.scene(worst, "contact"))
    hertz = worst.hertz(element.modulus)
    if isinstance(hertz, PointContact):
        assert scene.contact.load == pytest.approx(worst.load)
        assert (scene.shape.radius, scene.shape.radius_y) == pytest.approx((worst.radius, worst.across))
    else:
        length = scene.grid.spacing[1] * scene.grid.shape[1]
        assert scene.contact.load / length == pytest.approx(worst.load / worst.length)


@pytest.mark.parametrize("name", MODELS)
def test_what_the_template_names_runs(name, tmp_path):
    """Dry: the scene's pressure is Hertz'. With oil: the film is as thick as Dowson's fit says."""
    table = tomllib.loads(element_template(name)) | {"name": name}
    table = {key: value for key, value in table.items() if key not in ("wall", "housing")}  # without the bush's layer
    element = load_element(table)
    worst = element.worst()
    made = element.scene(worst, "contact")
    made["grid"]["shape"] = [64, 16] if isinstance(made["grid"]["shape"], list) else 64
    dry = run_scene(made | {"outputs": {"errors": False}}, tmp_path / "dry", figures=False).summary
    assert dry["status"] == "converged"
    # 0.05 % is seen on these 64 cells, whose middles lie up to half a cell (0.03 half-widths) beside the peak
    assert dry["max_pressure_Pa"] == pytest.approx(worst.hertz(element.modulus).maximum_pressure, rel=2e-3)
    place = element.found.contacts[9 if name == "cam-follower" else 0]
    film = run_scene(element.scene(place, "traction") | {"thermal": "off"}, tmp_path / "film", figures=False).summary
    assert film["status"] == "converged"
    fit = place.minimum_film(element.modulus, element.model.oil.build())
    # Dowson's own spread is some 10 %, and it is of Barus' law
    assert 1e-9 * film["minimum_thickness_nm"] == pytest.approx(fit, rel=0.15)


def test_the_thinnest_film_is_the_thinnest(element):
    oil = element.model.oil.build()
    films = [one.minimum_film(element.modulus, oil) for one in element.found.contacts]
    assert element.thinnest().minimum_film(element.modulus, oil) == min(films)


def test_columns_have_units_and_a_line_for_each_contact(element):
    rows = list(csv.reader(element.csv().splitlines()))
    if element.found.marks:
        assert rows[0].pop() == "mark"
        assert [row.pop() for row in rows[1:]] == element.letters()
    assert all("[" in name or name == "film_over_roughness" for name in rows[0])
    assert len(rows) == len(element.found.contacts) + 1
    first = dict(zip(rows[0], map(float, rows[1]), strict=True))
    contact = element.found.contacts[0]
    assert first["load [N]"] == contact.load
    assert 1 / first["radius [m]"] == pytest.approx(1 / first["radius_1 [m]"] + 1 / first["radius_2 [m]"])


@pytest.mark.internal
def test_what_conforms_is_said_to():
    table = {
        "element": "rolling-bearing", "bore": "40 mm", "outside": "80 mm", "diameter": "11.9 mm", "count": 9,
        "groove": 0.505, "radial_load": "30 kN", "speed": "3000 rpm", "first": "steel-52100", "second": "steel-52100",
    }  # fmt: skip
    found = load_element(table)
    assert any((note.code, note.values.get("reason")) == ("slopes-large", "element") for note in found.notes())
    ball, groove = 0.5 * 11.9e-3, 0.505 * 11.9e-3
    edge = WIDE * ball
    gap = [r - math.sqrt(r**2 - edge**2) - edge**2 / (2 * r) for r in (ball, groove)]
    assert (gap[0] - gap[1]) / (0.5 * edge**2 * (1 / ball - 1 / groove)) == pytest.approx(0.07, abs=0.005)
    with pytest.raises(InputError, match="has an oil film"):
        found.scene(found.worst(), "traction")
    with pytest.raises(InputError, match="no oil"):
        found.thinnest()
    with pytest.raises(InputError, match='did you mean "contact"'):
        found.scene(found.worst(), "contct")


def test_the_command_writes_scene_and_table(tmp_path):
    bem = functools.partial(run_command, cwd=tmp_path)
    assert bem("new", "gear", "gears.toml").returncode == 0
    done = bem(
        "element", "gears.toml", "--remarks", "--table", "all.csv", "--path", "path.csv", "--scene", "worst.toml"
    )
    assert done.returncode == 0, done.stderr
    assert "Contact ratio 1.43" in done.stdout
    assert load_scene(tmp_path / "worst.toml").kind == "traction"
    assert (tmp_path / "path.csv").read_text().count("\n") == 42
    assert bem("element", "gears.toml", "--scene", "flank.toml", "--at", "path").returncode == 0
    flank = load_scene(tmp_path / "flank.toml")
    assert len(flank.along.position) == 41
    assert flank.along.marks.C == 0
    assert (tmp_path / "flank-path.csv").read_text() == (tmp_path / "path.csv").read_text()
    again = bem("element", "gears.toml", "--scene", "other.toml", "--at", "99")
    assert again.returncode == 2
    assert "a number from 1 to 41" in again.stderr
    assert not (tmp_path / "other.toml").exists()
    refused = bem("new", "journal-bearing")
    assert refused.returncode == 2
    assert "plain-bush" in refused.stderr


@pytest.mark.parametrize("kind", KINDS)
def test_written_scenes_have_units_and_six_digits(element, kind):
    """Every number with a dimension has its unit, and the scene is that of the element to the digits."""
    place = element.found.contacts[9 if element.model.element == "cam-follower" else 0]
    if kind == "point-film" and place.length is not None:
        with pytest.raises(InputError, match="allowed: traction, contact, friction, running-in, surface-temperature"):
            element.scene(place, kind)
        return
    if kind == LIFE and place.length is None:
        with pytest.raises(InputError, match="running-in-life has line contacts alone"):
            element.scene(place, kind)
        return
    if kind == LIFE and element.model.element == "plain-bush":
        with pytest.raises(InputError, match="a bush wears at one place"):
            element.scene(place, kind)
        return
    table = element.scene(place, kind)
    text = scene_text(table)
    bare = {"slide_roll_ratio", "boundary_friction", "friction", "shape", "count", "averaged", "settled", "shift"}
    bare |= {"skewness", "kurtosis", "upper_over_lower"}
    numbers = {name for name, _ in re.findall(r"\b(\w+) = (\[?-?\d)", text)}
    assert numbers <= bare
    written, own = (scene_table(scene_from_table(one)) for one in (tomllib.loads(text), table))
    assert flat(written) == pytest.approx(flat(own), rel=6e-6)


def flat(table, key=""):
    """Numbers of a table of tables by their dotted keys."""
    if isinstance(table, dict):
        return {name: value for inner, one in table.items() for name, value in flat(one, f"{key}.{inner}").items()}
    if isinstance(table, list):
        return {name: value for i, one in enumerate(table) for name, value in flat(one, f"{key}.{i}").items()}
    return {key: table} if isinstance(table, int | float) else {}


def test_the_heat_of_an_elements_films_can_be_chosen():
    table = tomllib.loads(element_template("gear-pair"))
    whole = load_element(table | {"thermal": "full"})
    assert {kind: whole.scene(whole.worst(), kind)["thermal"] for kind in ("traction", "friction")} == {
        "traction": "full", "friction": "full",
    }  # fmt: skip
    plain = load_element(table)
    assert plain.scene(plain.worst(), "traction")["thermal"] == "lumped"
    balls = load_element(tomllib.loads(element_template("rolling-bearing")) | {"thermal": "full"})
    assert balls.scene(balls.worst(), "friction")["thermal"] == "lumped"  # full heat is one of lines


def test_the_oil_of_a_gear_scene_says_that_its_temperature_is_an_estimate():
    """And a life how long its cycles take: a flank passes once a turn of its gear."""
    gears = balance_heat(load_element(tomllib.loads(element_template("gear-pair")) | {"name": "gears"}))
    assert gears.bulk_estimated
    text = scene_text(gears.path_scene(), bulk_estimated=True)
    (line,) = (one for one in text.splitlines() if one.startswith("temperature = "))
    assert "estimated with this oil" in line
    assert "estimated" not in scene_text(gears.path_scene())
    life = gears.scene(gears.thinnest_steady(), LIFE)
    assert f"take {1e6 / (2250 / 60) / 3600:.2g} h" in life["description"]
