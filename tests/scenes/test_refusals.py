"""Scenes beyond what any half-space can be: refused before any work, and what lies short of that is run."""

import pytest

from bem.errors import InputError
from bem.runs import plan_scene, run_scene
from bem.scenes.checks import examine, scene_warnings, suspected_units
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


@pytest.mark.internal
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


@pytest.mark.internal
def test_a_contact_larger_than_its_body_is_refused():
    """a = (3 P R / 4 E*)^(1/3) is the radius itself at P = 4 E* R^2 / 3, on any grid that holds it."""
    large = ('grid.lengths="60 mm"',)
    (told,) = refused("hertz-sphere", *large, 'contact.load="2.4e7 N"')
    assert "larger than the body" in told
    assert refused("hertz-sphere", *large, 'contact.load="1e7 N"') == []


@pytest.mark.internal
def test_rubber_that_cannot_give_way_bears_more_than_its_contact_modulus():
    """E = 1 MPa, nu = 0.49: E* = 1.32 MPa, but what repeats has the uniaxial modulus of 17.1 MPa."""
    assert refused(rubber("5 MPa", periodic=True)) == []
    (told,) = refused(rubber("5 MPa", periodic=False))
    assert "3.8 times the contact modulus, 1.32 MPa" in told
    (told,) = refused(rubber("20 MPa", periodic=True))
    assert "1.2 times the softer body's uniaxial modulus, 17.1 MPa" in told


@pytest.mark.parametrize(
    ("source", "setting", "words"),
    [
        ("stribeck-mineral-oil", 'lower.material={youngs_modulus="3 Pa",poissons_ratio=0.3}', ("3 Pa", "3e-09 GPa")),
        ("wear-steel-steel", "lower.material={youngs_modulus=210,poissons_ratio=0.3}", ("210 Pa", '"210 GPa" if')),
        ("contact-to-accuracy", 'lower.material={youngs_modulus="3 Pa",poissons_ratio=0.3}', ("3 Pa", "1 kPa (gels)")),
        ("stribeck-mineral-oil", 'contact.radius="6 km"', ("contact.radius: was read as 6 km", "1000 m")),
        ("wear-steel-steel", 'cylinder.radius="6 km"', ("cylinder.radius", "check its unit")),
        ("stribeck-ball-on-disc", 'contact.ball="6 km"', ("contact.ball",)),
    ],
)
def test_a_unit_is_suspected_before_the_grid(source, setting, words, tmp_path):
    with pytest.raises(InputError) as caught:
        run_scene(source, tmp_path / "r", settings=[setting])
    (told,) = caught.value.messages
    assert told.startswith(setting.partition("=")[0])
    for text in words:
        assert text in told
    assert not (tmp_path / "r").exists()


@pytest.mark.internal
@pytest.mark.parametrize("modulus", ["1 kPa", "1.2 TPa", "210 GPa"])
def test_what_solids_have_is_not_suspected(modulus):
    """A gel under 10 N is refused for what it is, diamond not at all."""
    setting = f'lower.material={{youngs_modulus="{modulus}",poissons_ratio=0.3}}'
    assert suspected_units(plan_scene("hertz-sphere", [setting])[0]) == []
    assert all("check its unit:" not in told for told in refused("hertz-sphere", setting))


@pytest.mark.internal
def test_a_ball_of_three_pascal_is_refused_for_its_unit_and_a_rigid_one_is_meant():
    (told,) = refused("hertz-sphere", 'lower.material={youngs_modulus="3 Pa",poissons_ratio=0.3}')
    assert told.startswith("lower.material.youngs_modulus: was read as 3 Pa")
    rigid = 'lower.material={name="rigid",youngs_modulus="1e20 Pa",poissons_ratio=0.3}'
    assert suspected_units(plan_scene("hertz-sphere", [rigid])[0]) == []
