"""The kind `friction` with roughness that the film flattens: what the solver says, errors, defaults, refusals."""

import numpy as np
import pytest

from bem import InputError, load_scene
from bem.friction.flattened import solve_flattened
from bem.runs import plan_scene, run_scene

GENERATED = {"kind": "generated", "hurst": 0.8, "rolloff_wavelength": "60 um", "cutoff_wavelength": "20 um"}


def scene(**changes):
    """Return a ball whose flat is rough and moves, or other keys."""
    table = {
        "kind": "friction",
        "thermal": "off",
        "lower": {"material": "steel-52100", "surface": GENERATED | {"rms_height": "60 nm", "seed": 1}},
        "upper": {"material": "steel-52100"},
        "contact": {"ball": "10 mm", "loads": ["20 N"], "boundary_friction": 0.12},
        "oil": {"viscosity": "0.03 Pa s", "pressure_viscosity": "18 1/GPa", "density_law": "incompressible"},
        "speeds": {"values": ["0.1 m/s", "0.3 m/s"], "slide_roll_ratio": 0.5},
        "grid": {"shape": 64, "lengths": "320 um"},
        "film": {"cells": 48, "roughness": "waves"},
        "outputs": {"errors": False},
    }
    return table | changes


def line(**changes):
    """Return a cylinder whose flat is rough."""
    return scene(
        contact={"radius": "10 mm", "width": "1 mm", "hertz_pressures": ["0.8 GPa"], "boundary_friction": 0.12},
        grid={"shape": [128, 32], "lengths": ["600 um", "150 um"], "periodic": [False, True]},
        film={"points": 400, "roughness": "waves"},
        speeds={"values": ["0.3 m/s"], "slide_roll_ratio": 1.0},
        **changes,
    )


def test_a_curve_has_what_the_solver_says_and_undeformed_ratios(tmp_path):
    run, plain = (
        run_scene(scene(film={"cells": 48} | more), tmp_path / name, figures=False)
        for name, more in (("waves", {"roughness": "waves"}), ("plain", {}))
    )
    with_waves, undeformed = run.summary, plain.summary
    assert 0.1 < with_waves["ripple_over_heights"][0] < with_waves["ripple_over_heights"][1] < 0.9
    assert "ripple_over_heights" not in undeformed
    assert with_waves["contact_load_N"][0] < 0.6 * undeformed["contact_load_N"][0]
    assert with_waves["lambda_ratio"] == pytest.approx(undeformed["lambda_ratio"], rel=1e-9)
    assert with_waves["Sq_nm"] == undeformed["Sq_nm"]
    loaded, heights = plan_scene(scene())[0], plain.dataset["height"].values
    found = solve_flattened(loaded.curve_setup("off"), (heights, np.zeros(heights.shape)), loaded.speeds.build()[0])
    assert with_waves["friction"][0] == pytest.approx(found.solution.friction, rel=1e-3)
    # the fields that are shown are of the heights that the contact presses
    shown = run.dataset["height"].values
    assert shown.std() < 0.95 * plain.dataset["height"].values.std()


def test_a_line_contact_has_waves_and_error_bars_of_the_flattened_heights(tmp_path):
    summary = run_scene(line(outputs={"errors": True}), tmp_path / "run", figures=False).summary
    assert summary["status"] == "converged"
    assert 0.02 < summary["ripple_over_heights"][0] < 0.9
    assert 0 < summary["friction_error"][0] < 0.1 * summary["friction"][0]
    assert 0 < summary["lambda_ratio_error"][0] < 0.2 * summary["lambda_ratio"][0]


def test_plans_count_the_film_of_the_waves():
    steps = [step.name for step in plan_scene(scene())[1].steps]
    assert "waves" in steps
    assert "waves" not in [step.name for step in plan_scene(scene(film={"cells": 48}))[1].steps]


STEEL = {"material": "steel-52100"}


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"lower": STEEL}, "of smooth surfaces"),
        ({"supply": {"layer": "100 nm"}}, "inlet is flooded"),
        ({"upper": STEEL | {"layer": {"material": "a-C:H", "thickness": "2 um"}}}, "half-spaces"),
        ({"sharing": {"models": ["uncoupled"]}}, "uncoupled asperities"),
        ({"sharing": {"flow_factors": "surfaces"}}, "in the film already"),
        ({"grid": {"shape": 32, "lengths": "40 um", "periodic": True}}, "periodic along x"),
        ({"speeds": {"values": ["-0.1 m/s"]}}, "turn the axes"),
    ],
)
def test_refusals(changes, message):
    with pytest.raises(InputError, match=message):
        load_scene(scene(**changes))


def test_rough_films_in_time_are_sent_to_steady_waves():
    with pytest.raises(InputError, match=r'kind = "traction" with film\.roughness = "waves"'):
        load_scene(
            {
                "kind": "film",
                "lower": scene()["lower"],
                "cylinder": {"radius": "10 mm", "width": "1 mm", "load": "10 N"},
                "oil": scene()["oil"],
                "motion": {"kind": "reciprocating", "speed": "1 m/s", "period": "1 s"},
                "march": {"duration": "1 s"},
            }
        )


def test_ridges_across_a_line_contact_need_one_row(tmp_path):
    """A patch of one row has ripples of every wave alone; they are those of many equal rows in the solver."""
    table = {
        "kind": "traction",
        "thermal": "off",
        "lower": STEEL | {"surface": GENERATED | {"rms_height": "20 nm", "seed": 1}},
        "upper": STEEL,
        "roller": {"radius": "10 mm", "width": "1 mm", "hertz_pressure": "0.8 GPa"},
        "oil": scene()["oil"],
        "rolling": {"mean_speed": "0.5 m/s", "slide_roll_ratio": 0.5},
        "patch": {"shape": [256, 1], "lengths": ["800 um", "20 um"], "periodic": True},
        "film": {"points": 300, "roughness": "waves"},
        "outputs": {"errors": False},
    }
    run = run_scene(table, tmp_path / "run", figures=False)
    heights, ripple = run.dataset["rough_heights"].values, run.dataset["film_ripple_field"].values
    assert heights.shape == (256, 1)
    assert heights.std() == pytest.approx(20e-9, rel=1e-3)
    assert 0.05 < run.summary["ripple_over_heights"] < 1
    assert ripple.std() > 0
