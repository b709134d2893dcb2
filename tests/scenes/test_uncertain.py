"""Uncertain inputs of a scene: what is read, what is refused, and the scenes on both sides."""

import pytest

from bem import InputError, load_scene, plan_scene
from bem.scenes import get_kind
from bem.scenes.uncertain import deviations, moved, relative_step, value_of


def scene(**uncertain):
    return load_scene(
        {
            "kind": "contact",
            "uncertain": uncertain,
            "grid": {"shape": 16, "spacing": "1 um"},
            "lower": {"material": {"youngs_modulus": "200 GPa", "poissons_ratio": 0.3}},
            "shape": {"kind": "sphere", "radius": "1 mm"},
            "contact": {"load": "2 N"},
        }
    )


def test_relative_and_absolute_deviations_in_si_units():
    found = deviations(
        scene(**{"contact.load": "5 %", "shape": {"radius": "10 um"}, "lower.material.youngs_modulus": 3e9})
    )
    assert found == {
        "contact.load": pytest.approx(0.1),
        "shape.radius": pytest.approx(1e-5),
        "lower.material.youngs_modulus": 3e9,
    }


def test_a_moved_scene_has_another_value_at_the_key_alone():
    before = scene(**{"contact.load": "5 %"})
    after = moved(before, "contact.load", 0.1, -2.0)
    assert value_of(after, "contact.load") == pytest.approx(1.8)
    assert value_of(before, "contact.load") == 2.0
    assert after.shape == before.shape
    assert relative_step(before, "contact.load", 0.1, 1e-3) == pytest.approx(0.02)
    assert relative_step(before, "contact.load", 1e-9, 1e-3) == 1.0


def test_of_a_list_all_entries_change_alike():
    curve = load_scene("stribeck-mineral-oil", ["contact.loads=[5.5, 11]", 'uncertain={"contact.loads"="10 %"}'])
    (deviation,) = deviations(curve).values()
    assert deviation == pytest.approx(1.1)
    assert value_of(moved(curve, "contact.loads", deviation, 1.0), "contact.loads") == pytest.approx([6.05, 12.1])


@pytest.mark.parametrize(
    ("uncertain", "words"),
    [
        ({"contact.lod": "5 %"}, 'did you mean "contact.load"'),
        ({"contact.approach": "5 %"}, "not a whole number or a name"),
        ({"grid.shape": "5 %"}, "not a whole number or a name"),
        ({"shape.kind": "5 %"}, "not a whole number or a name"),
        ({"contact.load": "5 nm"}, "0.1 N"),
        ({"contact.load": "0 %"}, "not a positive standard deviation"),
        ({"contact.friction": "20 %"}, "the value is 0, so a share of it is none; allowed: an absolute deviation"),
        ({"contact.load": "-5 %"}, "not a positive standard deviation"),
    ],
)
def test_keys_and_deviations_that_are_refused(uncertain, words):
    with pytest.raises(InputError, match=words) as raised:
        plan_scene(scene(**uncertain))
    assert len(raised.value.messages) == 1


def test_a_share_of_a_residual_stress_that_is_not_set_is_refused_with_an_example_of_a_deviation():
    key = "lower.layer.residual_stress"
    coated = ("coated-sphere", [f'uncertain={{"{key}"="20 %"}}'])
    with pytest.raises(InputError, match=r'the value is 0, so a share of it is none; .* such as "0\.2 GPa"'):
        plan_scene(*coated)


@pytest.mark.parametrize("uncertain", [{}, {"contact.load": True}, "5 %"])
def test_tables_that_are_refused(uncertain):
    table = {
        "kind": "contact",
        "uncertain": uncertain,
        "grid": {"shape": 8, "spacing": "1 um"},
        "lower": {"material": {"youngs_modulus": "200 GPa", "poissons_ratio": 0.3}},
        "contact": {"load": 1.0},
    }
    with pytest.raises(InputError, match="standard deviations, such as"):
        load_scene(table)


def test_the_plan_counts_repeated_runs_and_says_which():
    uncertain = {"contact.load": "5 %", "grid.spacing": "1 %"}
    _, plan = plan_scene(scene(**uncertain))
    (step,) = [step for step in plan.steps if step.name == "uncertain inputs"]
    assert step.why == "by derivatives of the solution: contact.load; by two more runs each: grid.spacing"
    assert step.transforms > 2 * max(one.transforms for one in plan.steps if one is not step)
    assert not any(one.name == "uncertain inputs" for one in plan_scene("hertz-sphere")[1].steps)


def test_adhesion_and_stresses_have_no_derivative():
    by_tangent = get_kind("contact").by_tangent
    plain = scene(**{"contact.load": "5 %"})
    assert by_tangent(plain, "contact.load")
    assert not by_tangent(plain, "grid.spacing")
    assert not by_tangent(load_scene("adhesive-sphere"), "contact.approach")
    stressed = load_scene("hertz-sphere", ["outputs.von_mises=true"])
    assert stressed.wanted_depths()
    assert not by_tangent(stressed, "contact.load")


EYRING = ['oil.shear_law="eyring"', 'oil.shear_stress_limit="5 MPa"']


@pytest.mark.parametrize(
    ("name", "settings", "key", "unit", "value"),
    [
        ("adhesive-sphere", [], "contact.adhesion.work", "1 mJ/m^2", 1e-3),
        ("running-in-life", [], "wear.law.distance", "0.5 um", 0.5e-6),
        ("stribeck-mineral-oil", EYRING, "oil.shear_stress_limit", "0.2 MPa", 2e5),
        ("stribeck-mineral-oil", EYRING, "oil.shear_law.shear_stress_limit", "0.2 MPa", 2e5),
    ],
)
def test_parameters_of_laws_have_deviations_in_their_unit(name, settings, key, unit, value):
    before = load_scene(name, [*settings, f'uncertain={{"{key}"="{unit}"}}'])
    assert deviations(before) == {key: pytest.approx(value, rel=1e-12, abs=0)}
    after = moved(before, key, value, 2.0)
    assert value_of(after, key) == pytest.approx(value_of(before, key) + 2 * value, rel=1e-12, abs=0)
    assert type(after) is type(before)


@pytest.mark.parametrize(
    ("name", "settings", "key", "words"),
    [
        ("adhesive-sphere", [], "contact.adhesion", 'did you mean "contact.adhesion.work"'),
        ("adhesive-sphere", [], "contact.adhesion.wrk", 'did you mean "contact.adhesion.work"'),
        ("stribeck-mineral-oil", EYRING, "oil.shear_stress_limt", 'did you mean "oil.shear_stress_limit"'),
        ("stribeck-mineral-oil", [], "oil.shear_stress_limit", "no quantity is set there"),
        ("adhesive-sphere", [], "contact.adhesion.kind", "not a whole number or a name"),
    ],
)
def test_keys_of_laws_that_are_refused(name, settings, key, words):
    with pytest.raises(InputError, match=words):
        plan_scene(name, [*settings, f'uncertain={{"{key}"="5 %"}}'])
