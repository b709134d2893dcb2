"""The key `supply` of the kinds with an oil film: figures, limits, mistakes in words."""

import numpy as np
import pytest
from small_scenes import FILM, PATCH, oiled_ball

from bem import InputError, Status, load_scene, solve_mixed
from bem.campaigns.collect import outcome_of
from bem.reference_solutions.starved_inlet import starved_film
from bem.runs import run_scene
from bem.scenes import PlainContext, get_kind, library

TRACTION = {
    "kind": "traction",
    "thermal": "off",
    "lower": {"material": "steel-52100"},
    "upper": {"material": "steel-52100"},
    "roller": {"radius": "10 mm", "width": "8 mm", "hertz_pressure": "1 GPa"},
    "oil": {"grade": "ISO VG 68", "temperature": "60 degC", "density_law": "dowson_higginson"},
    "rolling": {"mean_speed": "2 m/s"},
    "film": {"points": 200},
}
BALL = oiled_ball(
    "point-film",
    {"radius": "10 mm", "hertz_pressure": "0.7 GPa"},
    {"viscosity": "0.05 Pa s", "pressure_viscosity": "20 1/GPa"},
    rolling={"mean_speed": "0.5 m/s", "slide_roll_ratio": 0.1},
    film={"cells": 64},
    outputs={"errors": False},
)
FRICTION = {"kind": "friction", "speeds": ["0.05 m/s", "0.5 m/s"], "film": {"points": 200}, **PATCH}
IN_TIME = FILM | {
    "motion": {"kind": "reciprocating", "speed": "0.05 m/s", "period": "20 ms"},
    "march": {"duration": "10 ms", "steps": 20, "points": 201, "cavitation": "mass_conserving"},
}


def test_a_starved_roller_follows_the_published_curve(tmp_path):
    """Wolveridge, Baglin and Archard's, whose contact is Hertz': to 0.02 of the flooded film."""
    layers = ["0.05 um", "0.2 um", "0.3 um", "2 um"]
    run = run_scene(TRACTION | {"over": {"supply.layer": layers}, "supply": {"layer": "1 um"}}, tmp_path / "run")
    found = run.summary
    assert found["status"] == "converged"
    inlet, reduction = np.array(found["inlet"][:3]), np.array(found["film_reduction"][:3])
    curve = starved_film(np.geomspace(1e-3, 1e3, 2000))
    np.testing.assert_allclose(reduction, np.interp(inlet, *curve), atol=0.02)
    np.testing.assert_allclose(found["oil_layer_nm"][:3], [50, 200, 300], rtol=1e-6)
    # a flooded contact has no meniscus
    assert found["film_reduction"][3] == 1
    assert found["meniscus_position_um"][3] is None
    assert found["oil_layer_nm"][3] == pytest.approx(found["flooded_layer_nm"][3])
    assert (np.diff(found["central_thickness_nm"]) > 0).all()
    bars = np.array(found["film_reduction_error"][:3])
    assert ((bars > 0) & (bars < 0.05)).all()
    assert (run.path / "figures" / "starvation-curve.png").exists()


def test_a_starved_ball_from_table_to_figures(tmp_path):
    """More oil, more film, up to the flooded one."""
    layers = ["60 nm", "150 nm", "1 mm"]
    run = run_scene(BALL | {"over": {"supply.layer": layers}, "supply": {"layer": "1 um"}}, tmp_path / "run")
    found = run.summary
    assert found["status"] == "converged"
    central = np.array(found["central_thickness_nm"])
    assert (np.diff(central) > 0).all()
    assert found["oil_layer_nm"][0] == pytest.approx(60, rel=0.03)  # less than half of what it would take
    assert found["film_reduction"][0] < 0.5
    assert found["film_reduction"][2] == 1
    first, second, third = found["meniscus_position_um"]
    assert second < first < 0
    assert third is None
    flooded = run_scene(BALL, tmp_path / "flooded", figures=False).summary
    assert central[2] == pytest.approx(flooded["central_thickness_nm"], rel=1e-9)
    assert "film_reduction" not in flooded
    full = run.dataset["film_fraction"].values
    assert full.min() < 0.1
    assert full.max() == 1


def test_a_distance_is_the_meniscus(tmp_path):
    done = run_scene(TRACTION | {"supply": {"distance": "0.3 mm"}}, tmp_path / "run", figures=False).summary
    assert done["meniscus_position_um"] == pytest.approx(-300, rel=1e-6)
    assert 0 < done["film_reduction"] < 1


@pytest.mark.internal
def test_friction_of_a_starved_contact(tmp_path):
    """Half the oil that a flooded film takes: more contact, more friction, and what `solve_mixed` says of it."""
    flooded = run_scene(FRICTION, tmp_path / "flooded", figures=False).summary
    run = run_scene(FRICTION | {"supply": {"layer": "0.25 um"}}, tmp_path / "starved", figures=False)
    found = run.summary
    assert found["status"] == flooded["status"] == "converged"
    assert found["film_reduction"][1] < 0.5
    assert found["meniscus_position_um"][1] < 0
    assert found["friction"][1] > 1.2 * flooded["friction"][1]
    assert found["lambda_ratio"][1] < flooded["lambda_ratio"][1]
    assert "film_reduction" not in flooded
    loaded = load_scene(FRICTION | {"supply": {"layer": "0.25 um"}})
    setup = {
        "grid": run_grid(loaded), "bodies": loaded.bodies, "radius": 2e-3, "width": 6e-3, "load": 5.5,
        "lubricant": loaded.oil.build(), "boundary_friction": 0.15, "film_points": 200, "hardness": 1.08e9,
    }  # fmt: skip
    height = np.asarray(run.dataset["height"].values).reshape(64, 32)
    again = solve_mixed(**setup, height=height, speeds=(0.5, 0.0), supply=0.25e-6)
    assert again.status is Status.CONVERGED
    # another start: to the tolerance of the balance
    assert again.friction == pytest.approx(found["friction"][1], rel=1e-3)
    assert again.film.starvation.reduction == pytest.approx(found["film_reduction"][1], rel=1e-3)


def test_friction_of_a_starved_ball(tmp_path):
    """Half the oil of the flooded film: more contact; as much as there is room for, the flooded ball's."""
    bench = library()["stribeck-ball-on-disc"]
    small = {
        "grid": {"shape": 64, "lengths": "320 um"}, "film": {"cells": 48}, "speeds": {"values": ["0.3 m/s"]},
        "outputs": {"errors": False}, "contact": bench["contact"] | {"hertz_pressures": ["0.8 GPa"]},
        "oil": {"grade": "ISO VG 68", "temperature": "60 degC"},
    }  # fmt: skip

    def found(layer):
        changes = small if layer is None else small | {"supply": {"layer": layer}}
        return run_scene(bench | changes, tmp_path / str(layer), figures=False).summary

    flooded, plenty, starved = (found(layer) for layer in (None, "1 mm", "30 nm"))
    assert {one["status"] for one in (flooded, plenty, starved)} == {"converged"}
    assert plenty["contact_load_N"] == flooded["contact_load_N"]
    assert plenty["film_reduction"] == [1.0]
    assert starved["film_reduction"][0] < 0.6
    assert starved["meniscus_position_um"][0] < -100  # before Hertz' contact, 109 um in radius
    assert starved["contact_load_N"][0] > 1.5 * flooded["contact_load_N"][0]


def run_grid(loaded):
    from bem.scenes import build

    return build.grid_of(loaded.grid)


@pytest.mark.internal
def test_a_film_in_time_has_less_oil_after_it_turned():
    def outcome(**changes):
        scene = load_scene(IN_TIME | changes)
        return outcome_of(scene, get_kind("film").run(scene, PlainContext()))

    starved, flooded = outcome(supply={"layer": "0.1 um"}), outcome()
    assert str(starved.status) == "converged"
    assert starved.summary["film_at_end_nm"] < flooded.summary["film_at_end_nm"]
    meniscus = starved.variables["meniscus"].values
    assert meniscus[0] < 0 < meniscus[-1]  # it turned
    assert "meniscus" not in flooded.variables
    plenty = outcome(supply={"layer": "1 mm"}).summary
    # the last film forgets how full the far inlet was
    assert plenty["film_at_end_nm"] == pytest.approx(flooded.summary["film_at_end_nm"], rel=0.01)


@pytest.mark.parametrize(
    ("scene", "changes", "words"),
    [
        (TRACTION, {"supply": {}}, "none of layer, distance is given; allowed: exactly one"),
        (TRACTION, {"supply": {"layer": "1 um", "distance": "1 mm"}}, "exactly one of layer, distance"),
        (TRACTION, {"supply": {"layer": "0 nm"}}, "supply.layer"),
        (BALL, {"supply": {"distance": "1 mm"}}, "the meniscus of a point contact is curved and is found"),
        (
            BALL,
            {"supply": {"layer": "1 um"}, "rolling": BALL["rolling"] | {"direction": "20 deg"}},
            "rolling.direction: at an angle to the axes",
        ),
        (
            library()["stribeck-ball-on-disc"],
            {"supply": {"layer": "1 um"}, "sharing": {"flow_factors": "surfaces"}},
            "a supply of a ball's film with sharing.flow_factors",
        ),
        (TRACTION, {"supply": {"layer": "1 um"}, "thermal": "full"}, "a supply of oil with thermal"),
        (IN_TIME, {"supply": {"distance": "1 mm"}}, "in time the meniscus moves"),
        (
            IN_TIME,
            {"supply": {"layer": "1 um"}, "march": IN_TIME["march"] | {"cavitation": "swift_stieber"}},
            "which forgets oil",
        ),
    ],
)
def test_mistakes_are_said(scene, changes, words):
    with pytest.raises(InputError, match=words):
        load_scene(scene | changes)


def test_a_meniscus_inside_hertz_contact_is_refused_before_any_work(tmp_path):
    for scene in (FRICTION, TRACTION):
        with pytest.raises(InputError, match="inside Hertz' contact; allowed: more than its half-width"):
            run_scene(scene | {"supply": {"distance": "2 um"}}, tmp_path / "run")
    assert not (tmp_path / "run").exists()
