"""Scenes of kind friction, running-in and surface-temperature of machine elements: all plan, and one of each runs."""

import math
import re
import tomllib

import pytest
from typer.testing import CliRunner

from bem import InputError, load_scene, plan_scene, run_scene
from bem.cli import build
from bem.elements.element import KINDS, LIFE, MIXED, MODELS, element_template, load_element
from bem.elements.model import BOUNDARY_FRICTION
from bem.elements.rough_scenes import FINISHES, finish_lengths, patch_over
from bem.elements.scene_text import element_scene_text, scene_text
from bem.grid import Grid
from bem.scenes import get_kind
from bem.scenes.checks import examine, scene_warnings

ROUGH = (*MIXED, LIFE, "surface-temperature")
CONDUCTS = {"thermal_conductivity": 48.0, "density": 7200.0, "heat_capacity": 460.0}
ROLLERS = {"rolling": "roller", "length": "11 mm"}


def element_of(name, **changes):
    """The template's element; materials without thermal constants get some."""
    table = tomllib.loads(element_template("rolling-bearing" if name == "roller" else name))
    table |= {"name": name} | (ROLLERS if name == "roller" else {}) | changes
    if name == "plain-bush":  # a wall is a layer, in which films have no heat: test_plain_bush.py
        table = {key: value for key, value in table.items() if key not in ("wall", "housing", "heat_balance")}
    for body in ("first", "second"):
        if "cast-iron" in table[body]:
            table[body] = {"catalogue": table[body], **CONDUCTS}
    return load_element(table)


def with_film(element):
    """The contact of highest pressure whose surfaces do not run against each other."""
    steady = [one for one in element.found.contacts if abs(one.slide_roll_ratio) <= 2]
    return max(steady, key=lambda one: one.hertz(element.modulus).maximum_pressure)


@pytest.mark.internal
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", [*MODELS, "roller"])
def test_every_kind_of_scene_of_every_element_plans(name, kind):
    element = element_of(name)
    place = with_film(element)
    if (kind == "point-film" and place.length is not None) or (kind == LIFE and place.length is None):
        with pytest.raises(InputError, match="line contact"):
            element.scene(place, kind)
        return
    if kind == LIFE and name == "plain-bush":
        with pytest.raises(InputError, match="a bush wears at one place"):
            element.scene(place, kind)
        return
    made = element.scene(place, kind)
    scene, plan = plan_scene(made)
    assert scene.kind == kind
    assert plan.memory > 0
    if kind in ROUGH:
        heights = [getattr(getattr(scene, body).surface, "rms_height", 0.0) for body in ("lower", "upper")]
        assert math.hypot(*heights) == pytest.approx(element.model.rms_roughness)
        assert (
            scene.thermal == "lumped"
            if kind in (*MIXED, LIFE)
            else scene.heat.lower_bulk == element.model.oil.temperature
        )
        own = name == "plain-bush" and kind == "surface-temperature"  # has the bush's friction
        assert (f"{BOUNDARY_FRICTION:g} is assumed" in scene.description) is not own


@pytest.mark.internal
@pytest.mark.parametrize("kind", MIXED)
@pytest.mark.parametrize("name", [*MODELS, "roller"])
def test_a_mixed_contact_has_the_load_and_speeds_of_its_place(name, kind):
    element = element_of(name)
    place = with_film(element)
    scene = load_scene(element.scene(place, kind))
    assert scene.load == pytest.approx(place.load)
    ((flat, other),) = scene.speeds.build()
    sign = math.copysign(1, place.mean_speed)
    assert 0.5 * (flat + other) == pytest.approx(abs(place.mean_speed))
    if kind == "friction" or place.slide_roll_ratio:
        assert (flat, other) == pytest.approx(tuple(sign * speed for speed in place.speeds))
    assert scene.sharing.oil_volume == "loaded"
    half_axis = scene.contact.half_axes(scene.load, scene.modulus)[0]
    assert half_axis == pytest.approx(place.half_width(element.modulus))
    assert scene.contact.boundary_friction == BOUNDARY_FRICTION
    assert (scene.supply is None) == math.isinf(place.inlet)


@pytest.mark.internal
@pytest.mark.parametrize("name", [*FINISHES, "roller"])
def test_the_patch_holds_the_contact_and_resolves_the_roughness(name):
    element = element_of(name)
    place, lengths = with_film(element), finish_lengths(element.model)
    patch, hertz = patch_over(place, element.modulus, lengths), place.hertz(element.modulus)
    half = [hertz.half_width] if place.length is not None else hertz.semi_axes
    for side, axis in zip(patch.lengths, half, strict=False):
        assert 0.5 * side >= 1.5 * axis * (1 - 1e-12)
    for side, cells, length in zip(patch.lengths, patch.shape, lengths, strict=True):
        assert cells * length >= 3.25 * side * (1 - 1e-12)
        assert side >= 8 * length * (1 - 1e-12)


@pytest.mark.internal
def test_one_finish_has_one_correlation_length_under_every_contact():
    """It followed the size of the contact: 95 um under a ball whose roller, of the same finish, had 20 um."""
    found = []
    for name, changes in (("rolling-bearing", {}), ("rolling-bearing", {"radial_load": "400 N"}), ("roller", {})):
        element = element_of(name, **changes)
        scene = load_scene(element.scene(element.worst(), "friction"))
        found.append(scene.lower.surface.correlation_lengths)
        assert "15 um), which is assumed" in scene.description
    assert found == [pytest.approx((15e-6, 15e-6))] * 3
    gears = element_of("gear-pair")
    across, along = load_scene(gears.scene(gears.worst(), "friction")).lower.surface.correlation_lengths
    assert (across, along) == pytest.approx((6.5e-6, 65e-6))  # grooves of grinding along the teeth


@pytest.mark.internal
@pytest.mark.parametrize(
    ("name", "along", "words"),
    [
        ("rolling-bearing", 9e-6, "rms_roughness and correlation_length: put your measured map here"),
        ("gear-pair", 90e-6, "geometric mean of 9 um across the grooves (the element's) and 90 um along them"),
        ("cam-follower", 90e-6, "geometric mean of 9 um across the grooves (the element's) and 90 um along them"),
        ("piston-ring", 9e-6, "rms_roughness and correlation_length: put your measured map here"),
    ],
)
def test_an_elements_own_correlation_length_is_that_of_its_scenes(name, along, words):
    element = element_of(name, correlation_length="9 um")
    made = element.scene(with_film(element), "friction")
    scene = load_scene(made)
    for body in (scene.lower, scene.upper):
        assert body.surface.correlation_lengths == pytest.approx((9e-6, along), rel=1e-9, abs=0)
    assert scene.grid.lengths[0] / scene.grid.shape[0] <= 9e-6 / 3.25 * (1 + 1e-9)
    assert "correlation length of 9 um" in made["description"]
    assert "assumed and decides" not in made["description"]
    assert element_scene_text(element, made).count(words) == 2


@pytest.mark.internal
def test_running_in_and_life_assume_one_wear_rate_and_say_it():
    """They assumed 1e-7 and 2e-8 mm^3/(N*m), both with "the wear rate is assumed" alone."""
    element = element_of("roller")
    made = [element.scene(element.worst(), kind) for kind in ("running-in", "running-in-life")]
    rates = [one["wear"][law]["specific_wear_rate"] for one, law in zip(made, ("criterion", "law"), strict=True)]
    assert rates[0] == rates[1]
    assert all(f"the wear rate {rates[0]} is assumed" in one["description"] for one in made)


@pytest.mark.internal
def test_running_in_slides_where_the_element_rolls():
    """In pure rolling no cycle could wear anything, of which nothing was said."""
    element = element_of("roller")
    made = element.scene(element.worst(), "running-in")
    assert made["speeds"]["slide_roll_ratio"] == 0.02
    assert "0.02 is assumed" in made["description"]
    assert 0.5 * sum(load_scene(made).speeds.build()[0]) == pytest.approx(element.worst().mean_speed)
    assert element.scene(element.worst(), "friction")["speeds"]["slide_roll_ratio"] == 0
    assert f"the entrainment speed is {element.worst().mean_speed:.4g} m/s" in scene_text(made)


def reduced(made, kind):
    """Few cells, roughness that they resolve, few points of the film, no heat of it."""
    made["grid"]["shape"] = [96, 32]
    coarse = {"kind": "generated", "correlation_length": 48e-6, "elongation": 0.25}
    for body in ("lower", "upper"):
        made[body]["surface"] = coarse | {"rms_height": made[body]["surface"]["rms_height"]}
    if kind in MIXED:
        made["thermal"] = "off"
    if kind == "friction":
        made |= {"film": {"points": 200}, "outputs": {"errors": False}}
    if kind == "running-in-life":
        made["life"]["count"] = 1000
    if kind == "running-in":
        made["cycles"] = {"count": 2, "averaged": 1, "settled": 1}
        made["depths"]["count"] = 6
        made["sharing"]["film_points"] = 200
    return made


@pytest.mark.internal
@pytest.mark.parametrize("kind", ROUGH)
def test_a_rough_scene_of_a_gear_pair_runs(kind, tmp_path):
    element = element_of("gear-pair")
    place = element.worst()
    done = run_scene(reduced(element.scene(place, kind), kind), tmp_path / "run", figures=False).summary
    assert done["status"] == "converged"
    if kind == "surface-temperature":
        assert done["maximum_temperature_C"] > 90
        length = patch_over(place, element.modulus, finish_lengths(element.model)).lengths[1]
        assert done["load_N"] == pytest.approx(place.load / place.length * length)
        return
    # lambda 0.35: the surfaces carry much, friction lies below theirs
    if kind == "running-in-life":
        assert 0.02 < done["friction_initial"] < BOUNDARY_FRICTION
        assert 0.2 < done["contact_share_initial"] < 1
        assert done["lower_worn_depth_nm"] > 0
        return
    friction, contact = (
        (done["friction"][0], done["contact_load_N"][0])
        if kind == "friction"
        else (done["friction_initial"][0], done["contact_load_N"][0])
    )
    assert 0.02 < friction < BOUNDARY_FRICTION
    assert 0.2 * place.load < contact < place.load


def test_what_a_kind_needs_is_named():
    smooth = element_of("gear-pair", rms_roughness=None)
    with pytest.raises(InputError, match="rms_roughness"):
        smooth.scene(smooth.worst(), "friction")
    assert load_scene(smooth.scene(smooth.worst(), "surface-temperature")).lower.surface.kind == "smooth"
    iron = {"name": "bare iron", "youngs_modulus": "130 GPa", "poissons_ratio": 0.35}
    cold = load_element(tomllib.loads(element_template("piston-ring")) | {"name": "ring", "first": iron})
    with pytest.raises(InputError, match=r"thermal_conductivity.*bare iron"):
        cold.scene(cold.worst(), "surface-temperature")
    assert load_scene(cold.scene(cold.worst(), "friction")).thermal == "off"
    assert set(KINDS) <= {get_kind(kind).name for kind in KINDS}


def test_materials_without_hardness_share_the_load_elastically():
    bare = {"name": "bare", "youngs_modulus": "130 GPa", "poissons_ratio": 0.3}
    soft = element_of("gear-pair", first=bare, second=bare)
    assert load_scene(soft.scene(soft.worst(), "friction")).sharing.models == ["elastic"]
    with pytest.raises(InputError, match="hardness"):
        plan_scene(soft.scene(soft.worst(), "running-in"))


def test_a_whole_path_is_of_kind_traction_alone(tmp_path):
    from typer.testing import CliRunner

    from bem.cli import build

    path = tmp_path / "gears.toml"
    path.write_text(element_template("gear-pair"))
    words = ["element", str(path), "--scene", str(tmp_path / "s.toml"), "--kind", "friction"]
    done = CliRunner().invoke(build(), [*words, "--at", "path"])
    assert isinstance(done.exception, InputError)
    assert "traction" in str(done.exception)
    assert CliRunner().invoke(build(), [*words, "--at", "20"]).exit_code == 0
    assert load_scene(tmp_path / "s.toml").kind == "friction"


@pytest.mark.parametrize("name", ["gear-pair", "cam-follower", "rolling-bearing"])
def test_running_in_wears_summits_over_two_turns_in_stable_steps(name):
    """Archard's law with a step that is stable on the cells, particles of a criterion, and two turns of the roughness.

    Pieces alone, as without a law of volume, left the worn surface of gears rougher than the new one.
    """
    from bem.wear.criterion.local import cell_to_cell_compliance

    element = element_of(name, specific_wear_rate="1e-8 mm^3/(N*m)")
    made = element.scene(element.thinnest_steady(), "running-in")
    scene, shape = load_scene(made), made["grid"]["shape"]
    cell = tuple(length / cells for length, cells in zip(made["grid"]["lengths"], shape, strict=True))
    criterion = scene.wear.criterion
    assert criterion.name == "archard"
    text = element_scene_text(element, made)
    alike = scene.lower.material == scene.upper.material
    assert alike is (name != "cam-follower")
    assert (scene.wear.wears == "lower") is alike  # "softer", of equal materials, did not say which one
    assert ("whole track wears" in text) is alike
    particles = scene.wear.particle_criterion
    if max(cell) > 1.5 * min(cell):  # sizes followed the cells along y, without the direction being said
        assert particles is None
        (own,) = re.findall(r"grid.shape = (\[.*?\]) and particle_criterion = (\{.*?\})", text)
        fine = made | {"grid": made["grid"] | {"shape": tomllib.loads(f"a = {own[0]}")["a"]}}
        fine["wear"] = made["wear"] | {"particle_criterion": tomllib.loads(f"a = {own[1]}")["a"]}
        assert not {"particles-of-mesh"} & {note.code for note in scene_warnings(examine(plan_scene(fine)[0]))}
        long = fine | {"grid": made["grid"]}
        (note,) = (n for n in scene_warnings(examine(plan_scene(long)[0])) if n.code == "particles-of-mesh")
        assert "or less along y" in note
        particles = load_scene(fine).wear.particle_criterion
    else:
        assert particles.name == "averaged_von_mises"
    # 3.3 averaging lengths cut 16 % of the particles of a ground flank, ten none
    assert scene.depths.build()[-1] > 10 * particles.averaging_length
    assert not {"particles-of-mesh"} & {note.code for note in scene_warnings(examine(plan_scene(made)[0]))}
    assert criterion.specific_wear_rate == pytest.approx(1e-17)
    compliance = cell_to_cell_compliance(Grid((32, 32), cell), (scene.lower.build(), scene.upper.build()))
    assert criterion.specific_wear_rate * criterion.distance < 0.5 * compliance
    turn = round(shape[0] / abs(scene.wear.shift))
    assert 32 <= turn < 96
    assert (scene.cycles.count, scene.cycles.averaged) == (2 * turn, turn)


@pytest.mark.parametrize("place", ["worst", "thinnest", ""])
def test_named_places_of_a_cam_without_a_steady_film_give_way_to_the_thinnest_one(place, tmp_path):
    """Under the nose the surfaces run against each other. Without a place the scene is that of the thinnest film."""
    file, scene = tmp_path / "cam.toml", tmp_path / "mixed.toml"
    file.write_text(element_template("cam-follower"))
    command = ["element", str(file), "--scene", str(scene), "--kind", "friction", *(["--at", place] if place else [])]
    done = CliRunner().invoke(build(), command)
    assert done.exit_code == 0, done.output
    named = "highest pressure" if place == "worst" else "the thinnest film"
    assert f"At the place of {named} the surfaces run against each other" in done.output
    assert "contact with the thinnest film" not in done.output
    steady = load_element(file).thinnest_steady()
    assert load_scene(scene).speeds.slide_roll_ratio == pytest.approx(steady.slide_roll_ratio, rel=1e-6)


def test_scenes_say_that_friction_has_no_sign_of_a_body():
    """Before point C `bem element` has a negative friction coefficient where the scene's is positive."""
    for name, slower in (("gear-pair", True), ("roller", False)):
        element = element_of(name)
        made = element.scene(element.worst(), "friction")
        assert (made["speeds"]["slide_roll_ratio"] < 0) is slower
        lines = [line for line in scene_text(made).splitlines() if "positive where it resists" in line]
        assert [line.partition(" ")[0] for line in lines] == ["slide_roll_ratio"] * slower
