"""The kinds `point-film` and `traction` by waves: ripples of the solver, bars, notes and refusals."""

import math

import numpy as np
import pytest
from small_scenes import oiled_ball

from bem import Grid, InputError, generate_surface, load_scene, solve_line_film, solve_point_film
from bem.lubrication.waves import film_ripples
from bem.reference_solutions.hertz import cylinder_contact, ellipse_contact
from bem.runs import plan_scene, run_scene

WAVES = {"hurst": 0.8, "rolloff_wavelength": 100e-6, "cutoff_wavelength": 40e-6}


def rough(rms, seed):
    return {"material": "steel-52100", "surface": {"kind": "generated", "rms_height": rms, "seed": seed} | WAVES}


def scene(**changes):
    table = oiled_ball(
        "point-film",
        {"radius": "10 mm", "hertz_pressure": "0.7 GPa"},
        {"viscosity": "0.04 Pa s", "pressure_viscosity": "20 1/GPa"},
        rolling={"mean_speed": "0.5 m/s", "slide_roll_ratio": 0.6},
        patch={"shape": 64, "lengths": "480 um", "periodic": True},
        film={"cells": 48, "roughness": "waves"},
        outputs={"errors": False},
    )
    return table | {"lower": rough("10 nm", 3), "upper": rough("20 nm", 4)} | changes


def test_a_scene_has_what_the_solver_says(tmp_path):
    run = run_scene(scene(), tmp_path / "run")
    loaded, summary = load_scene(scene()), run.summary
    assert summary["status"] == "converged"
    steel = loaded.lower.build().material
    modulus = steel.youngs_modulus / (1 - steel.poissons_ratio**2) / 2
    load = math.pi**3 * 0.7e9**3 * 10e-3**2 / (6 * modulus**2)  # Johnson 4.24
    grid = Grid((64, 64), (480e-6 / 64, 480e-6 / 64), periodic=(True, True))
    heights = tuple(generate_surface(grid, rms_height=rms, seed=s, **WAVES) for rms, s in ((10e-9, 3), (20e-9, 4)))
    film = solve_point_film(
        load=load, radii=(0.01, 0.01), contact_modulus=modulus, speeds=(0.65, 0.35), lubricant=loaded.oil.build(),
        shape=(48, 48), cavitation="mass_conserving",
    )  # fmt: skip
    hertz = ellipse_contact(radii=(0.01, 0.01), contact_modulus=modulus, load=load)
    ripples = film_ripples(film, hertz, heights, grid.spacing)
    assert summary["film_ripple_nm"] == pytest.approx(1e9 * ripples.rms_film_ripple, rel=1e-6)
    assert summary["pressure_ripple_Pa"] == pytest.approx(ripples.rms_pressure_ripple, rel=1e-6)
    assert summary["ripple_over_heights"] == pytest.approx(ripples.amplitude_ratio, rel=1e-6)
    assert summary["rough_minimum_thickness_nm"] == pytest.approx(1e9 * ripples.minimum_thickness, rel=1e-6)
    both = math.hypot(*(one.std() for one in heights))
    assert summary["lambda_ratio"] == pytest.approx(film.minimum_thickness / both, rel=1e-6)
    data = run.dataset
    inside = data["film_ripple_field"].values != 0
    smooth = data["rough_thickness"].values - data["film_ripple_field"].values
    assert np.ptp(smooth[inside & (np.hypot(data["patch_x"].values[:, None], data["patch_y"].values) < 3e-5)]) < 1e-8
    assert "waves-too-high" not in [note["code"] for note in summary["notes"]]
    assert "film-ripple-maps" in [path.stem for path in (tmp_path / "run" / "figures").iterdir()]
    _, plan = plan_scene(scene())
    assert any(step.name == "waves" for step in plan.steps)


def roller(**changes):
    table = oiled_ball("traction", {}, {"viscosity": "0.04 Pa s", "pressure_viscosity": "20 1/GPa"})
    del table["ball"]
    return (
        table
        | {
            "roller": {"radius": "10 mm", "width": "8 mm", "hertz_pressure": "0.7 GPa"},
            "rolling": {"mean_speed": "1 m/s", "slide_roll_ratio": 0.6},
            "patch": {"shape": 64, "lengths": "480 um", "periodic": True},
            "film": {"points": 400, "roughness": "waves"},
            "thermal": "off",
            "lower": rough("20 nm", 3),
            "upper": {"material": "steel-52100"},
        }
        | changes
    )


def test_a_roller_has_what_the_solver_says(tmp_path):
    run = run_scene(roller(), tmp_path / "run", figures=False)
    summary, loaded = run.summary, load_scene(roller())
    modulus = loaded.lower.build().material.plane_strain_modulus / 2
    load = math.pi * 0.7e9**2 * 0.01 / modulus  # Johnson 4.45
    film = solve_line_film(
        load=load, radius=0.01, contact_modulus=modulus, speeds=(1.3, 0.7), lubricant=loaded.oil.build(), points=400
    )
    grid = Grid((64, 64), (480e-6 / 64, 480e-6 / 64), periodic=(True, True))
    heights = generate_surface(grid, rms_height=20e-9, seed=3, **WAVES)
    hertz = cylinder_contact(radius=0.01, contact_modulus=modulus, load=load)
    ripples = film_ripples(film, hertz, (heights, None), grid.spacing)
    assert summary["film_ripple_nm"] == pytest.approx(1e9 * ripples.rms_film_ripple, rel=1e-6)
    assert summary["rough_minimum_thickness_nm"] == pytest.approx(1e9 * ripples.minimum_thickness, rel=1e-6)
    assert summary["film_ripple_nm_error"] > 0.15 * summary["film_ripple_nm"]
    assert summary["lambda_ratio"] == pytest.approx(film.minimum_thickness / heights.std(), rel=1e-6)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"film": {"points": 400}}, 'film.roughness = "waves"'),
        ({"film": {"points": 400}, "lower": {"material": "steel-52100"}}, "a patch of smooth surfaces"),
        ({"supply": {"layer": "100 nm"}}, "inlet is flooded"),
    ],
)
def test_refusals_of_rollers(changes, message):
    with pytest.raises(InputError, match=message):
        load_scene(roller(**changes))


@pytest.mark.parametrize(("height", "level"), [("250 nm", "caution"), ("400 nm", "outside_model")])
def test_high_roughness_is_said_to_be_too_high(height, level, tmp_path):
    """Waves were compared with marches down to films of half the rms heights: 0.68 of them here, and 0.43."""
    summary = run_scene(scene(upper=rough(height, 4)), tmp_path / "run", figures=False).summary
    assert [note["level"] for note in summary["notes"] if note["code"] == "waves-too-high"] == [level]


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"lower": {"material": "steel-52100"}, "upper": {"material": "steel-52100"}}, "of smooth surfaces"),
        ({"patch": None}, "a rough surface without a patch"),
        ({"contact": {"boundary_friction": 0.1}}, "not what they bear"),
        ({"supply": {"layer": "100 nm"}}, "inlet is flooded"),
        ({"roughness": "20 nm"}, "beside a rough surface"),
        ({"rolling": {"mean_speed": "0.5 m/s", "direction": "10 deg"}}, "turn the axes"),
        ({"film": {"cells": 48}}, "both surfaces are rough"),
    ],
)
def test_refusals(changes, message):
    table = {key: value for key, value in (scene() | changes).items() if value is not None}
    with pytest.raises(InputError, match=message):
        load_scene(table)
