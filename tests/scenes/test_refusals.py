"""Scenes beyond what any half-space can be: refused before any work, and what lies short of that is run."""

import pytest

from bem.errors import InputError
from bem.runs import plan_scene, run_scene
from bem.scenes.checks import examine, scene_warnings
from bem.scenes.checks.refusals import refusals


def refused(source, *settings):
    return refusals(examine(plan_scene(source, settings)[0]))


def rubber(mean_pressure, *, periodic):
    return {
        "kind": "contact",
        "grid": {"shape": 32, "lengths": "40 um", "periodic": periodic},
        "lower": {
            "material": {"youngs_modulus": "1 MPa", "poissons_ratio": 0.49},
            "surface": {"kind": "generated", "rms_height": "50 nm", "correlation_length": "4 um"},
        },
        "contact": {"mean_pressure": mean_pressure},
    }


def test_a_ball_under_a_hundred_tons_is_refused_and_nothing_written(tmp_path):
    """It was `converged` at 84 TPa, with seven notes: 1 MN on (480 um)^2 are 4.34 TPa, E* of steel on steel 113.8 GPa
    at nu = 0.3."""
    settings = ('contact.load="1e6 N"',)
    with pytest.raises(InputError) as caught:
        run_scene("hertz-sphere", settings=settings, out=tmp_path / "run")
    (told,) = caught.value.messages
    assert "4.34e+12 Pa over the grid" in told
    assert "times the contact modulus" in told
    assert "check the units" in told
    assert not (tmp_path / "run").exists()
    with pytest.raises(InputError):
        scene_warnings(examine(plan_scene("hertz-sphere", settings)[0]))


def test_a_contact_larger_than_its_body_is_refused():
    """a = (3 P R / 4 E*)^(1/3) is the radius itself at P = 4 E* R^2 / 3, on any grid that holds it."""
    large = ('grid.lengths="60 mm"',)
    (told,) = refused("hertz-sphere", *large, 'contact.load="2.4e7 N"')
    assert "larger than the body" in told
    assert refused("hertz-sphere", *large, 'contact.load="1e7 N"') == []


def test_rubber_that_cannot_give_way_bears_more_than_its_contact_modulus():
    """E = 1 MPa, nu = 0.49: E* = 1.32 MPa, but what repeats has the uniaxial modulus of 17.1 MPa."""
    assert refused(rubber("5 MPa", periodic=True)) == []
    (told,) = refused(rubber("5 MPa", periodic=False))
    assert "3.8 times the contact modulus, 1.32 MPa" in told
    (told,) = refused(rubber("20 MPa", periodic=True))
    assert "1.2 times the softer body's uniaxial modulus, 17.1 MPa" in told
