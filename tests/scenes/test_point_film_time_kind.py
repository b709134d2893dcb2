"""The kind `point-film-time`: a scene from tables to figures, what passes through, going on, and mistakes in words."""

import numpy as np
import pytest
from small_scenes import oiled_ball

from bem import InputError, load_scene
from bem.runs import run_scene


def scene(**changes):
    table = oiled_ball(
        "point-film-time",
        {"radius": "12.5 mm", "load": "15 N"},
        {"viscosity": "0.25 Pa s", "pressure_viscosity": "22 1/GPa"},
        rolling={"mean_speed": "0.09 m/s"},
        film={"cells": 36, "extent": ["-260 um", "160 um", "-210 um", "210 um"]},
        march={"duration": "1.2 ms", "steps": 8},
        outputs={"errors": False},
    )
    return {**table, **changes}


def test_a_scene_from_tables_to_figures(tmp_path):
    dents = [{"depth": "100 nm", "radius": "30 um", "at": ["-120 um", "0 um"]}]
    run = run_scene(scene(dents=dents), tmp_path / "run")
    summary, data = run.summary, run.dataset
    assert summary["status"] == "converged"
    assert summary["thickest_central_film_nm"] >= summary["central_film_at_end_nm"] > summary["film_at_end_nm"]
    assert summary["mass_imbalance"] < 1e-7
    assert summary["load_missed"] < 1e-7
    # 1.2 ms at 0.09 m/s later: under the centre, to a cell
    x, heights = data["film_x"].values, data["surface_heights"].values
    assert x[heights[0].argmin()] == pytest.approx(-120e-6, abs=12e-6)
    assert x[heights[-1].argmin()] == pytest.approx(-12e-6, abs=12e-6)
    for name in ("passing-interferogram", "passing-sections", "passing-over-time", "film-over-time"):
        assert (run.path / "figures" / f"{name}.png").stat().st_size > 5000
    assert (run.path / "figures" / "passing-interferogram.gif").stat().st_size > 5000
    page = (run.path / "report.html").read_text("utf-8")
    assert page.count('href="figures/') == page.count('href="figures/passing-interferogram.gif"') == 1


def test_speed_and_load_change_over_time_with_bars(tmp_path):
    over_time = {"times": ["0 ms", "1.2 ms"], "speed": [1, 2], "load": [1, 1.2]}
    run = run_scene(scene(over_time=over_time, outputs={"errors": True}), tmp_path / "run", figures=False)
    assert run.dataset["speed"].values[[0, -1]] == pytest.approx([0.09, 0.18])
    assert run.summary["thickest_central_film_nm_error"] > 0
    assert run.summary["highest_pressure_Pa_error"] is None


def test_sliding_friction_has_its_scatter_from_the_oil(tmp_path):
    slides = {"mean_speed": "0.09 m/s", "slide_roll_ratio": 1.0}
    oil = {"viscosity": "0.25 Pa s", "pressure_viscosity": "22 1/GPa", "temperature": "40 degC"}
    data = run_scene(scene(rolling=slides, oil=oil), tmp_path / "run", figures=False).dataset
    friction, scatter = (data[name].values for name in ("friction", "friction_oil_scatter"))
    assert friction.shape == scatter.shape == (9,)
    assert (0.03 * friction < scatter).all()
    assert (scatter < 0.5 * friction).all()


def test_rough_bodies_pass_on_their_patch(tmp_path):
    rough = {"kind": "generated", "rms_height": "10 nm", "correlation_length": "30 um"}
    upper = {"material": "steel-52100", "surface": rough}
    patch = {"shape": 16, "spacing": "12 um", "at": ["-190 um", "0 um"]}
    run = run_scene(scene(upper=upper, patch=patch), tmp_path / "run", figures=False)
    heights = run.dataset["surface_heights"].values
    assert 2e-9 < np.std(heights[0][heights[0] != 0]) < 30e-9
    assert run.summary["status"] == "converged"


def test_a_start_from_rest_needs_a_gap():
    words = "starts from rest.*march.initial_thickness"
    with pytest.raises(InputError, match=words):
        load_scene(scene(over_time={"times": [0, 1], "speed": [0, 1]}))


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"over_time": {"times": [0, 1], "speed": [1]}}, "over_time"),
        ({"over_time": {"times": [0, 1]}}, "neither speed nor load changes"),
        ({"over_time": {"times": [1, 1], "speed": [1, 1]}}, "do not rise"),
        ({"patch": {"shape": 16, "spacing": "12 um"}}, "a patch of smooth surfaces"),
        ({"dents": [{"depth": "1 um", "radius": "0 um", "at": [0, 0]}]}, "dents"),
    ],
)
def test_mistakes_are_said(changes, words):
    with pytest.raises(InputError, match=words):
        load_scene(scene(**changes))
