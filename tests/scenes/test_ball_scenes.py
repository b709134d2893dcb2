"""Balls and ellipsoids in the kinds friction and running-in: geometry is data of the scene."""

import math

import pytest

from bem.errors import InputError
from bem.reference_solutions.hertz import ellipse_contact
from bem.runs import plan_scene
from bem.scenes import library


def scene_with(**contact):
    scene = dict(library()["stribeck-ball-on-disc"])
    shape = {key: value for key, value in scene["contact"].items() if key not in ("ball", "radii")}
    return scene | {"contact": shape | contact}


def setup_of(scene):
    return plan_scene(scene, [])[0].model_copy(update={"sharing": _one_model()}).curve_setup("off")


def _one_model():
    from bem.scenes.tables.sharing import SharingScene

    return SharingScene(oil_volume="loaded")


@pytest.mark.internal
def test_a_ball_is_an_ellipsoid_of_equal_radii():
    ball, radii = (setup_of(scene_with(**shape)) for shape in ({"ball": "10 mm"}, {"radii": ["10 mm", "10 mm"]}))
    assert ball.radii == radii.radii == (0.01, 0.01)
    assert ball.load == radii.load
    assert ball.slices == 1
    pressure = ellipse_contact(radii=(0.01, 0.01), contact_modulus=ball.smooth.contact_modulus, load=ball.load)
    assert pressure.maximum_pressure == pytest.approx(0.5e9, rel=1e-12)


def test_a_cylinder_is_said_in_two_ways():
    scene = dict(library()["stribeck-mineral-oil"])
    named = {"cylinder" if key == "radius" else key: value for key, value in scene["contact"].items()}
    one, other = (plan_scene(given, [])[0] for given in (scene, scene | {"contact": named}))
    assert one.contact == other.contact
    assert one.contact.geometry == {"radius": 2e-3, "width": 6e-3}


@pytest.mark.parametrize(("ratio", "other"), [(0, 1.0), (2, 0.0), (0.5, 0.6), (-0.5, 5 / 3)])
def test_slide_roll_ratio_is_that_of_both_surfaces(ratio, other):
    scene, _ = plan_scene(scene_with(ball="10 mm") | {"speeds": {"values": [0.3], "slide_roll_ratio": ratio}}, [])
    ((flat, ball),) = scene.speeds.build()
    assert ball == pytest.approx(0.3 * other)
    assert 2 * (flat - ball) / (flat + ball) == pytest.approx(ratio)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"contact": {"ball": "10 mm", "radius": "10 mm"}}, "radius and ball"),
        ({"contact": {"ball": "10 mm", "width": "6 mm"}}, "width and ball"),
        ({"contact": {"cylinder": "2 mm", "radius": "2 mm"}}, "they say the same"),
        ({"contact": {}}, "no shape"),
        ({"grid": {"shape": 64, "lengths": "320 um", "periodic": [False, True]}}, "patch holds the contact of a ball"),
        ({"grid": {"shape": 64, "lengths": ["320 um", "100 um"]}}, "half-axis along y"),
        ({"thermal": "full", "oil": {"grade": "ISO VG 68", "temperature": "60 degC"}}, "thermal"),
        ({"oil": {"viscosity": 0.03, "film_rheology": "shear_law"}}, "film of a point contact"),
        ({"supply": {"thickness": "1 um"}}, "supply"),
        ({"speeds": {"values": [0.1], "cylinder": 0.5, "slide_roll_ratio": 1}}, "they say the same"),
        ({"film": {"start": "-1 mm", "end": "1 mm"}}, "film.start"),
    ],
)
def test_what_a_ball_has_not_is_said(changes, said):
    scene = scene_with(ball="10 mm")
    if "contact" in changes:
        shape = {key: value for key, value in scene["contact"].items() if key != "ball"}
        changes = {"contact": shape | changes["contact"]}
    with pytest.raises(InputError, match=said):
        plan_scene(scene | changes, [])


def test_the_patch_of_a_ball_goes_on_nowhere():
    scene, _ = plan_scene(scene_with(ball="10 mm"), [])
    assert scene.grid.periodic == (False, False)
    assert math.isfinite(scene.contact.half_axes(20.0, 1e11)[1])


CELL = {"shape": 32, "lengths": "40 um", "periodic": True}


@pytest.mark.internal
def test_a_cell_of_the_roughness_may_repeat_under_a_ball():
    scene, _ = plan_scene(scene_with(ball="10 mm") | {"grid": CELL}, [])
    assert scene.cell_repeats
    assert setup_of(scene_with(ball="10 mm") | {"grid": CELL}).repeated_cell


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"sharing": {"oil_volume": "patch"}}, "oil_volume"),
        ({"sharing": {"oil_volume": "loaded", "models": ["capped", "uncoupled"]}}, "uncoupled asperities"),
        ({"grid": CELL | {"lengths": "150 um"}}, "cell that repeats is 150 um long"),
        ({"film": {"start": "-1 mm", "end": "1 mm"}}, "film.start"),
    ],
)
def test_what_a_cell_that_repeats_has_not_is_said(changes, said):
    with pytest.raises(InputError, match=said):
        plan_scene(scene_with(ball="10 mm") | {"grid": CELL} | changes, [])


def test_nothing_wears_on_a_cell_that_repeats():
    with pytest.raises(InputError, match=r"grid\.periodic"):
        plan_scene(dict(library()["running-in-ball"]) | {"grid": CELL}, [])
