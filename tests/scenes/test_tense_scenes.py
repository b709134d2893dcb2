"""Surface tension in scenes: error bars that cover the integral equation, adhesion, refusals."""

import math

import pytest

from bem import InputError, load_scene, run_scene
from bem.reference_solutions.tense_ball import tense_ball

GEL = {"youngs_modulus": "5 kPa", "poissons_ratio": 0.49, "surface_tension": "31 mN/m"}


def bead(material=GEL, **tables):
    return {
        "kind": "contact",
        "grid": {"shape": 64, "lengths": "60 um"},
        "lower": {"material": material},
        "shape": {"kind": "sphere", "radius": "100 um"},
        "contact": {"load": "1 uN"},
    } | tables


@pytest.mark.parametrize(("cells", "ratio"), [(32, 0.1), (48, 1.0), (64, 10.0)])
def test_error_bars_cover_the_integral_equation(tmp_path, cells, ratio):
    contact, modulus = 20e-6, 5e3 / (1 - 0.49**2)
    tension = 0.5 * ratio * modulus * contact
    exact = tense_ball(contact, 100e-6, modulus, tension, 40)
    scene = bead(
        GEL | {"surface_tension": tension},
        grid={"shape": cells, "lengths": "52 um"},
        contact={"load": exact.load},
    )
    run = run_scene(scene, tmp_path / "run")
    values = {
        "approach_m": exact.approach,
        "contact_area_m2": math.pi * contact**2,
        "mean_contact_pressure_Pa": exact.load / (math.pi * contact**2),
        "max_pressure_Pa": exact.maximum_pressure,
    }
    for name, value in values.items():
        bar = run.summary[f"{name}_error"]
        assert abs(run.summary[name] - value) <= bar, name
    assert run.summary["approach_m_error"] < 0.01 * exact.approach
    assert run.summary["contact_area_m2_error"] < 0.06 * math.pi * contact**2


def test_tension_weakens_the_pull_off_of_an_adhesive_bead(tmp_path):
    """Hui, Liu, Salez, Raphael & Jagota (2015): the pull-off load falls by at most a third from JKR on."""
    pulls = []
    for tension in ("1 uN/m", "500 mN/m"):
        path = ["2 um", "-2 um", "-4 um", "-6 um"]
        control = {"adhesion": {"work": "20 mJ/m^2", "range": "2 um"}, "approach_path": path, "approach": "-9 um"}
        scene = bead(
            GEL | {"youngs_modulus": "50 kPa", "surface_tension": tension}, contact=control, outputs={"errors": False}
        )
        scene["grid"] = {"shape": 32, "lengths": "120 um"}
        pulls.append(-run_scene(scene, tmp_path / tension[0]).summary["lowest_load_N"])
    radius = 100e-6
    assert 0.6 < pulls[1] / pulls[0] <= 1.0
    assert pulls[0] == pytest.approx(1.75 * math.pi * 20e-3 * radius, rel=0.3)


@pytest.mark.parametrize(
    ("scene", "message"),
    [
        (bead(GEL | {"surface_tension": "-1 mN/m"}), "surface_tension"),
        (bead(GEL | {"relaxation": {"shares": [0.5], "times": ["1 s"]}}), "surface_tension is given beside relaxation"),
    ],
)
def test_refusals(scene, message):
    with pytest.raises(InputError) as raised:
        load_scene(scene)
    assert message in str(raised.value)


def test_smooth_contact_of_plans_knows_surface_tension():
    """Its radius is that of the integral equation to a few per cent, where Hertz' is up to four times as large."""
    for ratio in (0.1, 1.0, 100.0):
        modulus = 5e3 / (1 - 0.49**2)
        exact = tense_ball(20e-6, 100e-6, modulus, 0.5 * ratio * modulus * 20e-6, 40)
        material = GEL | {"surface_tension": 0.5 * ratio * modulus * 20e-6}
        smooth = load_scene(bead(material, contact={"load": exact.load})).smooth_contact()
        assert smooth.semi_axes == pytest.approx((20e-6, 20e-6), rel=0.06, abs=0)
