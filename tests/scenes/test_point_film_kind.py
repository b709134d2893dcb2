"""The kind `point-film`: a scene from tables to figures, its error bars, and its mistakes in words."""

import math

import numpy as np
import pytest
from small_scenes import oiled_ball

from bem import InputError, load_scene, solve_point_film
from bem.kinds.point_film.run import of_this_kind
from bem.notes.lubrication import HEAT_LEFT_OUT, SET_THERMAL
from bem.plots.interferograms import colours_of, finely_coloured
from bem.runs import run_scene


def scene(**changes):
    table = oiled_ball(
        "point-film",
        {"radius": "10 mm", "hertz_pressure": "0.7 GPa"},
        {"viscosity": "0.05 Pa s", "pressure_viscosity": "20 1/GPa"},
        rolling={"mean_speed": "0.5 m/s", "slide_roll_ratio": 0.1},
        film={"cells": 64},
    )
    return {**table, **changes}


def test_a_scene_from_tables_to_figures(tmp_path):
    run = run_scene(scene(roughness="20 nm"), tmp_path / "run")
    summary, loaded = run.summary, load_scene(scene())
    steel = loaded.lower.build().material
    modulus = steel.youngs_modulus / (1 - steel.poissons_ratio**2) / 2
    load = math.pi**3 * 0.7e9**3 * 10e-3**2 / (6 * modulus**2)  # Johnson 4.24
    assert summary["load_N"] == pytest.approx(load, rel=1e-9)
    film = solve_point_film(
        load=load, radii=(10e-3, 10e-3), contact_modulus=modulus, speeds=(0.525, 0.475),
        lubricant=loaded.oil.build(), shape=(64, 64),
    )  # fmt: skip
    assert summary["status"] == "converged"
    assert summary["central_thickness_nm"] == pytest.approx(1e9 * film.central_thickness, rel=1e-7)
    assert summary["traction_coefficient"] == pytest.approx(film.friction, rel=1e-7)
    assert summary["lambda_ratio"] == pytest.approx(film.minimum_thickness / 20e-9, rel=1e-7)
    assert run.dataset["thickness"].values == pytest.approx(film.thickness, rel=1e-7)
    for name in ("interferogram", "point-film-maps", "point-film-sections", "point-pressure"):
        assert (run.path / "figures" / f"{name}.png").stat().st_size > 5000


def test_bars_cover_the_grid_but_the_spike_has_none(tmp_path):
    """The same on three times the cells, which leave a ninth of the error."""
    coarse = run_scene(scene(), tmp_path / "coarse", figures=False).summary
    fine = run_scene(scene(film={"cells": 192}, outputs={"errors": False}), tmp_path / "fine", figures=False).summary
    for key in ("central_thickness_nm", "minimum_thickness_nm", "central_pressure_Pa", "traction_coefficient"):
        assert abs(coarse[key] - fine[key]) < coarse[f"{key}_error"] < 0.3 * coarse[key], key
    assert coarse["maximum_pressure_Pa_error"] is None


def test_a_scene_on_few_cells_has_bars_and_does_not_say_that_there_is_no_error(tmp_path):
    summary = run_scene(scene(), tmp_path / "run", figures=False).summary
    assert summary["central_thickness_nm_error"] > 0
    assert not any(
        note["code"] == "no-error-bar" and "central thickness" in note["text"] for note in summary.get("notes", ())
    )


def test_bars_of_friction_count_what_the_inlet_adds(tmp_path):
    light = scene(
        ball={"radius": "10 mm", "load": "0.5 N"},
        oil={"viscosity": "0.2 Pa s", "pressure_viscosity": "10 1/GPa"},
        lower={"material": {"youngs_modulus": "3 GPa", "poissons_ratio": 0.4}},
    )
    run = run_scene(light, tmp_path / "run", figures=False)
    friction, power = (
        run.summary[f"{key}_error"] / run.summary[key] for key in ("traction_coefficient", "friction_power_W")
    )
    assert friction > 0.1
    assert power == pytest.approx(friction, rel=1e-6)
    assert any(note["code"] == "inlet-friction" for note in run.summary["notes"])


def test_over_speeds_films_grow(tmp_path):
    over = {"rolling.mean_speed": ["0.2 m/s", "0.5 m/s"]}
    run = run_scene(scene(over=over, outputs={"errors": False}), tmp_path / "run", figures=False)
    films = run.summary["central_thickness_nm"]
    # Hamrock and Dowson's exponent of the speed, 0.67
    assert math.log(films[1] / films[0]) / math.log(2.5) == pytest.approx(0.67, abs=0.04)
    assert run.dataset["thickness_along"].shape[0] == 2


def test_heat_left_out_is_that_of_another_kind():
    """`thermal` is no key of this kind, and the note on heat said to set it."""
    (said,) = of_this_kind([HEAT_LEFT_OUT(factor=1.2, reason="inlet", remedy=SET_THERMAL)])
    assert said.values["remedy"] != SET_THERMAL
    assert "take kind friction" in said.line


def test_a_film_thinner_than_its_roughness_is_said(tmp_path):
    run = run_scene(scene(roughness="1 um", outputs={"errors": False}), tmp_path / "run", figures=False)
    assert any(note["code"] == "film-thinner-than-roughness" for note in run.summary["notes"])


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"ball": {"radius": "10 mm"}}, "hertz_pressure"),
        ({"film": {"cells": 16}}, "film.cells"),
        (
            {
                "lower": {
                    "material": "steel-52100",
                    "surface": {"kind": "generated", "rms_height": "1 um", "correlation_length": "9 um"},
                }
            },
            "smooth",
        ),
        ({"rolling": {"mean_speed": "0 m/s"}}, "mean_speed"),
    ],
)
def test_mistakes_are_named(change, words):
    with pytest.raises(InputError, match=words):
        load_scene(scene(**change))


@pytest.mark.internal
def test_colours_are_dark_without_a_film_and_bright_where_beams_agree():
    assert colours_of(np.zeros((2, 2))).max() == 0
    # half a wavelength of green in oil there and back
    assert colours_of(np.array([532e-9 / 6]))[0, 1] > 0.95


@pytest.mark.internal
def test_colours_of_a_table_are_those_of_the_film_to_one_of_255():
    thickness = np.random.default_rng(1).random((40, 30)) * np.geomspace(1e-9, 1e-4, 30)
    found = finely_coloured(thickness, dots=10)  # more cells than dots: nothing in between
    assert found.shape == (40, 30, 3)
    assert np.abs(found - 255 * colours_of(thickness)).max() < 2
    assert finely_coloured(np.array([[-1e-9, np.nan], [0.0, 1.0]]), dots=2).shape == (2, 2, 3)
    assert finely_coloured(thickness, dots=64).shape == (64, 64, 3)
