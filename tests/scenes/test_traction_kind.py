"""The kind `traction`: a scene from tables to figures, over the slide-to-roll ratio, and its mistakes in words."""

import numpy as np
import pytest

from bem import InputError, load_scene, solve_full_thermal_line_film, solve_line_film, solve_thermal_line_film
from bem.accuracy import TractionCase, traction_figures
from bem.campaigns.context import Silent
from bem.lubrication.thermal import full, lumped
from bem.runs import run_scene

ROUGH = {"kind": "generated", "rms_height": "1 um", "correlation_length": "9 um"}


def scene(**changes):
    table = {
        "kind": "traction",
        "lower": {"material": "steel-52100"},
        "upper": {"material": "steel-52100"},
        "roller": {"radius": "10 mm", "width": "8 mm", "hertz_pressure": "0.7 GPa"},
        "oil": {
            "grade": "ISO VG 68",
            "temperature": "60 degC",
            "density_law": "dowson_higginson",
            "shear_law": "eyring",
            "shear_stress_limit": "5 MPa",
        },
        "rolling": {"mean_speed": "5 m/s"},
        "film": {"points": 200},
    }
    return {**table, **changes}


def line(loaded):
    """The line contact of the scene: two rollers of one steel, the load by Hertz of the scene's pressure."""
    steel = loaded.lower.build().material
    modulus = steel.youngs_modulus / (1 - steel.poissons_ratio**2) / 2
    return {
        "load": np.pi * 10e-3 * 0.7e9**2 / modulus,
        "radius": 10e-3,
        "contact_modulus": modulus,
        "lubricant": loaded.oil.build(),
        "points": 200,
    }


def test_a_curve_over_the_slide_to_roll_ratio(tmp_path):
    run = run_scene(scene(over={"rolling.slide_roll_ratio": [0.0, 0.1, 2.0]}), tmp_path / "run")
    summary = run.summary
    loaded = load_scene(scene())
    bodies = (loaded.lower.build(), loaded.upper.build())
    found = solve_thermal_line_film(speeds=(5.25, 4.75), bodies=bodies, **line(loaded))
    assert summary["traction_coefficient"][1] == pytest.approx(found.shear_force / found.film.load, rel=1e-9)
    assert summary["friction_power_W"][1] == pytest.approx(8e-3 * found.friction_power, rel=1e-9)
    assert summary["highest_film_temperature_C"][1] == pytest.approx(found.highest_film_temperature - 273.15, rel=1e-9)
    assert summary["traction_coefficient"][1] > summary["traction_coefficient"][2] > summary["traction_coefficient"][0]
    bars, values = (np.array(summary[f"traction_coefficient{end}"]) for end in ("_error", ""))
    assert (bars > 0).all()
    assert (bars < 0.05 * values).all()
    shares = [np.array(summary[f"share_of_{name}"]) for name in ("lower", "upper", "oil")]
    np.testing.assert_allclose(sum(shares), 1.0, rtol=1e-6)
    for name in ("traction-curve", "film-temperatures", "rolling-film"):
        assert (run.path / "figures" / f"{name}.png").exists()


def test_traction_and_mixed_friction_of_one_smooth_hot_contact_agree(tmp_path):
    """Summits of nanometres touch no film: mixed lubrication is the film with its heat, by another solver of loads."""
    oil = {"grade": "ISO VG 68", "temperature": "60 degC"}
    rolled = run_scene(
        scene(oil=oil, rolling={"mean_speed": "5 m/s", "slide_roll_ratio": 0.1}), tmp_path / "traction", figures=False
    ).summary
    mixed = {
        "kind": "friction",
        "lower": {
            "material": "steel-52100",
            "surface": {"kind": "generated", "rms_height": "1 nm", "correlation_length": "12 um"},
        },
        "upper": {"material": "steel-52100"},
        "contact": {"radius": "10 mm", "width": "8 mm", "hertz_pressures": ["0.7 GPa"], "boundary_friction": 0.1},
        "oil": oil,
        "speeds": {"values": ["5.25 m/s"], "cylinder": 4.75 / 5.25},
        "grid": {"shape": [64, 16], "spacing": "5 um", "periodic": [False, True]},
        "film": {"points": 200},
    }
    shared = run_scene(mixed, tmp_path / "friction", figures=False).summary
    assert shared["status"] == rolled["status"] == "converged"
    assert shared["contact_load_N"][0] == 0.0
    assert min(shared["oil_temperature_C"][0], rolled["film_temperature_C"]) > 61  # both are hot by default
    apart = abs(shared["friction"][0] - rolled["traction_coefficient"])
    assert apart <= shared["friction_error"][0] + rolled["traction_coefficient_error"]
    assert shared["friction_error"][0] + rolled["traction_coefficient_error"] < 0.1 * rolled["traction_coefficient"]


def test_bars_cover_the_mesh(tmp_path):
    """The same on eight times the points, which leave a sixtieth of the error."""
    rolling = {"mean_speed": "5 m/s", "slide_roll_ratio": 0.3}
    coarse = run_scene(scene(rolling=rolling), tmp_path / "coarse", figures=False).summary
    fine = run_scene(
        scene(
            rolling=rolling,
            film={"points": 1600},
            outputs={"errors": False},
        ),
        tmp_path / "fine",
        figures=False,
    ).summary
    films = ("minimum_thickness_nm", "central_thickness_nm")
    for name in ("traction_coefficient", "film_temperature_C", "friction_power_W", *films):
        assert abs(coarse[name] - fine[name]) <= coarse[f"{name}_error"], name


def test_an_accuracy_asked_for_refines_film_and_heat(tmp_path):
    """Heat has twice as many cells on twice 1000 points: it would keep its own error, else."""
    asked = scene(accuracy=0.01, rolling={"mean_speed": "5 m/s", "slide_roll_ratio": 0.7})
    done = run_scene(asked, tmp_path / "run", figures=False).summary
    (case,) = done["accuracy"]["cases"]
    assert len(case["levels"]) > 1
    assert done["accuracy"]["met"]
    assert done["film_temperature_C_error"] <= 0.01 * done["film_rise_K"]  # not of degrees over freezing water
    cells = [TractionCase(speeds=(5.0, 5.0), **line(load_scene(scene())) | {"points": n}).cells for n in (400, 2000)]
    assert cells == [200, 400]


def test_full_heat_has_its_field(tmp_path):
    """The same solver's figures, the field with the surfaces at its ends, bars that cover a finer one."""
    rolling = {"mean_speed": "5 m/s", "slide_roll_ratio": 0.5}
    run = run_scene(scene(thermal="full", rolling=rolling), tmp_path / "run")
    summary, loaded = run.summary, load_scene(scene())
    case = line(loaded) | {"bodies": (loaded.lower.build(), loaded.upper.build()), "speeds": (6.25, 3.75)}
    found = solve_full_thermal_line_film(**case)
    assert summary["status"] == "converged"
    assert summary["traction_coefficient"] == pytest.approx(found.shear_force / found.film.load, rel=1e-9)
    assert summary["hottest_oil_C"] == pytest.approx(found.temperature.max() - 273.15, rel=1e-9)
    assert summary["energy_imbalance"] < 1e-6
    data = run.dataset
    assert data["field"].shape == (len(data["x"].values), len(found.height) + 2)
    np.testing.assert_array_equal(data["field"].values[:, 0], data["lower_surface_temperature"].values)
    fine = solve_full_thermal_line_film(**case | {"points": 800}, columns=320, layers=32)
    assert (
        abs(summary["traction_coefficient"] - fine.shear_force / fine.film.load) < summary["traction_coefficient_error"]
    )
    rise = abs(summary["film_temperature_C"] + 273.15 - fine.mean_film_temperature)
    assert rise < summary["film_temperature_C_error"]
    assert (run.path / "figures" / "temperature-field.png").exists()


@pytest.mark.internal
@pytest.mark.parametrize(
    ("solver", "tolerance", "ratios"),
    [
        (full, "ENERGY_TOLERANCE", [0.1, 0.5]),
        (lumped, "FACTOR_TOLERANCE", [0.5, 0.7]),
    ],
    ids=["full-one", "lumped-all"],
)
def test_heat_that_is_not_found_is_in_no_figure(tmp_path, monkeypatch, solver, tolerance, ratios):
    """The last case, or all: the field of the last one was drawn, without a number to draw; its friction was a dot like
    the others of the curve."""
    told, result, allowed = [], solver._result, getattr(solver, tolerance)

    def lost(found, *more):
        speeds = (found.film if solver is full else found.films[-1]).speeds
        monkeypatch.setattr(solver, tolerance, -1.0 if abs(speeds[0] - speeds[1]) > 1.0 else allowed)
        try:
            return result(found, *more)
        finally:
            monkeypatch.setattr(solver, tolerance, allowed)

    class Telling(Silent):
        def note(self, text):
            told.append(text)

    monkeypatch.setattr(solver, "_result", lost)
    changed = scene(
        thermal=solver.__name__.rpartition(".")[2], over={"rolling.slide_roll_ratio": ratios}, outputs={"errors": False}
    )
    run = run_scene(changed, tmp_path / "run", workers=1, watcher=Telling())
    known = [ratio < 0.2 for ratio in ratios]
    for name in ("traction_coefficient", "friction_power_W", "film_temperature_C", "share_of_oil"):
        assert [value is not None for value in run.summary[name]] == known
    assert not any("Drawing figure" in text for text in told)
    for name in ("temperature-field",) * (solver is full) + ("film-temperatures",):
        assert (run.path / "figures" / f"{name}.png").exists() == any(known)


def test_pure_rolling_has_no_traction_of_sliding():
    case = line(load_scene(scene()))
    film = solve_line_film(speeds=(5.0, 5.0), **case)
    figures = traction_figures(TractionCase(speeds=(5.0, 5.0), **case), film)
    assert figures["traction_coefficient"] > 1e-5
    assert abs(figures["sliding_traction"]) < 1e-12


def test_without_heat_it_is_the_isothermal_film(tmp_path):
    rolling = {"mean_speed": "5 m/s", "slide_roll_ratio": 1.0}
    run = run_scene(scene(thermal="off", rolling=rolling), tmp_path / "run", figures=False)
    found = solve_line_film(speeds=(7.5, 2.5), **line(load_scene(scene())))
    assert run.summary["traction_coefficient"] == pytest.approx(found.shear_force / found.load, rel=1e-12)
    assert run.summary.get("film_temperature_C") is None
    assert any(note["code"] == "heat-left-out" for note in run.summary["notes"])


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"thermal": "lumped", "oil": {"viscosity": "0.05 Pa*s"}}, "heat of an oil without temperature"),
        ({"rolling": {"mean_speed": "5 m/s", "slide_roll_ratio": 2.5}}, "slide_roll_ratio"),
        ({"rolling": {"mean_speed": "0 m/s"}}, "mean_speed"),
        ({"roller": {"radius": "1 mm", "width": "1 mm"}}, "exactly one of load, hertz_pressure"),
        (
            {"thermal": "full", "upper": {"material": {"youngs_modulus": "210 GPa", "poissons_ratio": 0.3}}},
            "upper, which has layers or a material without thermal constants",
        ),
        ({"lower": {"material": "steel-52100", "surface": ROUGH}}, "a rough surface"),
    ],
)
def test_mistakes_are_said(changes, words):
    with pytest.raises(InputError, match=words):
        load_scene(scene(**changes))
