"""Kind `rolling`: creep of a ball against Kalker, a force that asks for its creepage, sliding, stresses, messages."""

import numpy as np
import pytest
from small_scenes import pressed_ball

from bem import InputError
from bem.campaigns.refine import solve_case
from bem.scenes import PlainContext, get_kind, load_scene


def scene(roll, **changes):
    return load_scene(pressed_ball("rolling", 40) | {"roll": {"friction": 0.4} | roll} | changes)


def run(roll, **changes):
    kind = get_kind("rolling")
    resolved = kind.resolve(scene(roll, **changes))
    assert kind.plan(resolved).memory > 0
    context = PlainContext(resolved)
    return kind.run(resolved, context), context


def test_small_creepage_is_kalker_s_and_a_force_finds_it_again():
    creep, own = 1e-5, {"youngs_modulus": "205 GPa", "poissons_ratio": 0.25}
    bodies = {"lower": {"material": own}, "upper": {"material": own}}
    record, context = run({"creepage": creep}, **bodies)
    assert record.status == "converged"
    assert not context.notes
    radius = (3 * 20.0 * 10e-3 * (1 - 0.25**2) / (2 * 205e9)) ** (1 / 3)
    # C11 = 4.12 (Kalker 1967; Johnson, table 8.1); of first order in the cell, 14 cells a radius
    assert -record.force / (205e9 / 2.5 * radius**2 * creep) == pytest.approx(4.12, rel=0.04)
    assert record.stick_fraction > 0.9
    # nothing else takes energy: the drag is force x creepage, made where cells of this size show nothing
    assert record.friction_work == pytest.approx(-record.force * creep, rel=1e-9)
    assert record.resolved_work < 0.2
    again, _ = run({"share": float(record.force / (0.4 * record.load))}, **bodies)
    assert again.creepage == pytest.approx(creep, rel=1e-4)


def test_much_creepage_slides():
    record, _ = run({"creepage": 0.0, "creepage_across": 0.05}, outputs={"von_mises": True, "body": "upper"})
    assert record.traction_coefficient == pytest.approx(0.4, rel=1e-3)
    assert record.force_across < 0
    assert record.stick_fraction == 0
    assert record.von_mises.shape == (24, 40, 40)
    assert np.isfinite(record.max_von_mises)


def test_bodies_that_differ_say_that_the_pressure_stays():
    record, context = run({"creepage": 1e-4}, upper={"material": "phosphor-bronze"})
    assert record.status == "converged"
    assert any((note.code, note.values.get("reason")) == ("friction-on-pressure", "left-out") for note in context.notes)


def test_figures_have_error_bars_of_first_order():
    record, _ = run({"creepage": 5e-4, "creepage_across": 2e-4})
    finer, _ = run({"creepage": 5e-4, "creepage_across": 2e-4}, grid={"shape": 120, "lengths": "300 um"})
    for name in ("force", "force_across", "traction_coefficient", "stick_fraction", "friction_work"):
        error = abs(getattr(record, name) - getattr(finer, name))
        assert error < record.errors[name] < 0.2 * abs(getattr(record, name))
        assert finer.errors[name] < 0.7 * record.errors[name]
    assert record.errors["creepage"] < 1e-5 * record.creepage  # given


@pytest.mark.internal
def test_an_accuracy_can_be_asked_for():
    """Of the force alone: cells are chosen and refined until its bar is within it."""
    asked = scene({"creepage": 5e-4}, grid={"lengths": "300 um"}, accuracy={"force": "1.5 %"})
    kind = get_kind("rolling")
    resolved = kind.resolved(asked)
    record = solve_case(kind, resolved, PlainContext(resolved.seed))
    assert record.status == "converged"
    assert record.errors["force"] <= 0.015 * abs(record.force)
    assert record.pressure.shape[0] > resolved.grid.shape[0]  # not met on the first level


def test_nothing_in_contact_carries_nothing():
    record, _ = run({"creepage": 1e-4}, contact={"approach": "-1 um"})
    assert record.status == "converged"
    assert record.force == record.traction_coefficient == 0


def test_messages():
    with pytest.raises(InputError, match="creepage follows from the force"):
        scene({"share": 0.5, "creepage": 0.001})
    with pytest.raises(InputError, match=r"roll\.friction"):
        scene({"friction": -0.1})
    with pytest.raises(InputError, match=r"roll\.friction alone"):
        scene({}, contact={"load": "20 N", "friction": 0.1})
