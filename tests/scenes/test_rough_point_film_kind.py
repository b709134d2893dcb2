"""The kind `point-film` with a rough body: the solver's figures, bars, notes, pictures, and its mistakes in words."""

import math

import numpy as np
import pytest
from small_scenes import oiled_ball

from bem import Grid, InputError, generate_surface, load_scene, solve_rough_point_film
from bem.kinds.point_film.touching import REMEDY, TouchingScene
from bem.lubrication import MeasuredHeights
from bem.lubrication.checks import MOLECULAR_FILM
from bem.runs import plan_scene, run_scene

WAVES = {"hurst": 0.8, "rolloff_wavelength": 100e-6, "cutoff_wavelength": 60e-6}
BUMPS = {"kind": "generated", "rms_height": "40 nm", "seed": 5} | WAVES
ROUGH = {"material": "steel-52100", "surface": BUMPS}


def scene(**changes):
    table = oiled_ball(
        "point-film",
        {"radius": "10 mm", "hertz_pressure": "0.7 GPa"},
        {"viscosity": "0.02 Pa s", "pressure_viscosity": "20 1/GPa"},
        rolling={"mean_speed": "5 mm/s", "slide_roll_ratio": 2},
        patch={"shape": 64, "lengths": "300 um"},
        contact={"boundary_friction": 0.2, "least_film": "2 nm"},
        film={"cells": 64},
    )
    return {**table, "upper": ROUGH, **changes}


def test_a_scene_has_what_the_solver_says(tmp_path):
    run = run_scene(scene(), tmp_path / "run")
    loaded, summary = load_scene(scene()), run.summary
    assert summary["status"] == "converged"
    steel = loaded.lower.build().material
    modulus = steel.youngs_modulus / (1 - steel.poissons_ratio**2) / 2
    grid = Grid((64, 64), (300e-6 / 64, 300e-6 / 64))
    heights = generate_surface(grid, rms_height=40e-9, seed=5, **WAVES)
    film = solve_rough_point_film(
        load=math.pi**3 * 0.7e9**3 * 10e-3**2 / (6 * modulus**2),  # Johnson 4.24
        radii=(0.01, 0.01), contact_modulus=modulus, speeds=(0.01, 0.0), lubricant=loaded.oil.build(),
        heights=MeasuredHeights(heights, grid.spacing), least_film=2e-9, shape=(64, 64),
    )  # fmt: skip
    half = summary["half_axis_x_um"] * 1e-6
    # 0.007: the surfaces do touch
    assert film.contact_share > 1e-4
    assert summary["contact_load_share"] == pytest.approx(film.contact_share, rel=1e-6)
    assert summary["contact_load_share_error"] >= 1.5 * film.contact_share_error * (1 - 1e-6)
    assert summary["contact_area_share"] == pytest.approx(film.contact_area / (math.pi * half**2), rel=1e-6)
    assert summary["traction_coefficient"] == pytest.approx(film.friction(0.2), rel=1e-6)
    assert summary["friction_power_W"] == pytest.approx(film.friction(0.2) * film.load * 0.01, rel=1e-6)
    assert summary["mean_thickness_nm"] == pytest.approx(1e9 * film.mean_thickness, rel=1e-6)
    # touching cells have the least film to the tolerance of the solver
    assert summary["minimum_thickness_nm"] == pytest.approx(2.0, rel=1e-6)
    assert summary["film_over_rms"] == pytest.approx(summary["formula_central_nm"] / (1e9 * heights.std()), rel=1e-6)
    both = run.dataset["oil_pressure"].values + run.dataset["contact_pressure"].values
    assert both == pytest.approx(run.dataset["pressure"].values, rel=1e-12)
    assert np.array_equal(run.dataset["contact_pressure"].values > 0, film.touching)
    for name in ("touching-film-maps", "interferogram", "point-film-maps", "point-film-sections", "point-pressure"):
        assert (run.path / "figures" / f"{name}.png").stat().st_size > 5000


def test_a_smooth_scene_has_none_of_it(tmp_path):
    smooth = {key: value for key, value in scene(upper={"material": "steel-52100"}).items() if key not in EXTRA}
    run = run_scene(smooth, tmp_path / "run")
    assert not {"contact_load_share", "mean_thickness_nm", "film_over_rms"} & set(run.summary)
    assert "contact_pressure" not in run.dataset
    assert not (run.path / "figures" / "touching-film-maps.png").exists()


EXTRA = ("patch", "contact")


def test_the_lower_body_may_be_the_rough_one(tmp_path):
    """A ball's film is the same whichever body is at rest."""
    shares = []
    for one, other, ratio in (("upper", "lower", 2), ("lower", "upper", -2)):
        table = scene(**{one: ROUGH, other: {"material": "steel-52100"}}, outputs={"errors": False})
        table["rolling"] = {"mean_speed": "5 mm/s", "slide_roll_ratio": ratio}
        run = run_scene(table, tmp_path / one, figures=False)
        shares.append((run.summary["contact_load_share"], run.summary["mean_thickness_nm"]))
    assert shares[0] == pytest.approx(shares[1], rel=1e-6)


@pytest.mark.internal
def test_what_bounds_the_figures_is_said(tmp_path):
    thin = scene(contact={"boundary_friction": 0.1, "least_film": "50 nm"})
    notes = run_scene(thin, tmp_path / "thin", figures=False).summary["notes"]
    assert any(note["code"] == "least-film-decides" for note in notes)
    assert any(note["code"] == "error-bars-partial" for note in notes)
    short = scene(patch={"shape": 32, "lengths": "150 um"}, outputs={"errors": False})
    notes = run_scene(short, tmp_path / "short", figures=False).summary["notes"]
    assert any(note["code"] == "patch-smaller-than-hertz" for note in notes)
    coarse = scene(film={"cells": 32}, outputs={"errors": False})
    notes = run_scene(coarse, tmp_path / "coarse", figures=False).summary["notes"]
    assert any(note["code"] == "roughness-unresolved" for note in notes)
    # of the film, whether bars are asked for or not
    assert any(note["code"] == "film-cells-few" for note in notes)


@pytest.mark.internal
def test_a_film_that_is_not_found_is_not_converged_and_says_what_to_do(tmp_path, monkeypatch):
    from bem.lubrication.point import newton, start

    for module, name in ((start, "FIRST_STEPS"), (start, "CONTACT_STEPS"), (newton, "MOST_STEPS")):
        monkeypatch.setattr(module, name, 2)
    run = run_scene(scene(), tmp_path / "run", figures=False)
    assert run.summary["status"] == "stalled"
    assert REMEDY in run.summary["where"]
    assert "contact_load_share_error" not in run.summary
    assert any(note["code"] == "film-not-found" for note in run.summary["notes"])


def test_oil_comes_at_any_angle(tmp_path):
    rolling = {"mean_speed": "5 mm/s", "slide_roll_ratio": 2, "direction": "30 deg"}
    run = run_scene(scene(rolling=rolling), tmp_path / "run", figures=False)
    assert run.summary["status"] == "converged"
    assert run.summary["mass_imbalance"] < 1e-8
    assert 0 <= run.summary["contact_load_share"] < 1


def test_the_plan_names_what_is_computed():
    _, plan = plan_scene(scene())
    texts = " ".join(step.why for step in plan.steps)
    assert "heights of upper" in texts
    assert "touching" in texts


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"lower": ROUGH}, "both surfaces are rough"),
        ({"rolling": {"mean_speed": "5 mm/s", "slide_roll_ratio": 1}}, "the rough body moves"),
        ({"rolling": {"mean_speed": "5 mm/s", "slide_roll_ratio": -2}}, "the rough body moves"),
        ({"supply": {"layer": "100 nm"}}, "supply of a rough body"),
        ({"roughness": "40 nm"}, "roughness beside"),
        ({"patch": None}, "without a patch"),
        ({"contact": None}, "without contact"),
        ({"contact": {"least_film": "1 nm"}}, "boundary_friction"),
        ({"contact": {"boundary_friction": 0.1, "least_film": "0 nm"}}, "least_film"),
        ({"upper": {"material": "steel-52100"}}, "patch of smooth surfaces"),
        ({"thermal": "lumped"}, "thermal"),
        ({"march": {"duration": "1 s"}}, "march"),
    ],
)
def test_mistakes_are_named(change, words):
    with pytest.raises(InputError, match=words) as raised:
        load_scene(scene(**change))
    assert len(raised.value.messages) == 1


def test_a_patch_without_a_size_is_refused_before_any_work():
    with pytest.raises(InputError, match="no size"):
        plan_scene(scene(patch={"shape": 64}))


@pytest.mark.internal
def test_the_least_film_is_the_solvers():
    assert TouchingScene(boundary_friction=0.1).least_film == MOLECULAR_FILM
