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


FALLING = {"kind": "falling_exponential", "static_friction": 0.4, "kinetic_friction": 0.2, "half_speed": "0.02 m/s"}


def test_falling_friction_slides_with_less_the_faster_it_slides():
    """All slips at 2 %: the coefficient is that of the slip speed, which is the creepage's but for the elastic part."""
    record, _ = run({"friction": FALLING, "speed": "2 m/s", "creepage": 0.02})
    assert record.status == "converged"
    assert record.stick_fraction == 0
    assert record.traction_coefficient == pytest.approx(0.2 + 0.2 * 2**-2, rel=0.01)
    assert record.traction_bound.sum() == pytest.approx(0.4 * record.pressure.sum(), rel=1e-12)
    finer, _ = run({"friction": FALLING, "speed": "2 m/s", "creepage": 5e-4}, grid={"shape": 120, "lengths": "300 um"})
    coarse, _ = run({"friction": FALLING, "speed": "2 m/s", "creepage": 5e-4})
    for name in ("force", "stick_fraction", "friction_work"):
        assert abs(getattr(coarse, name) - getattr(finer, name)) < coarse.errors[name]


@pytest.mark.parametrize(("creepage", "seen"), [(3.6e-3, True), (4.0e-3, False)])
def test_bars_cover_a_sticking_area_that_vanishes(creepage, seen):
    """A strip along the leading edge that is shorter than a cell is not seen; a longer one errs by part of a cell."""
    steel = {"material": {"youngs_modulus": "210 GPa", "poissons_ratio": 0.3}}
    roll = {"friction": FALLING, "speed": "4 m/s", "creepage": creepage}
    coarse, fine = (
        run(roll, grid={"shape": n, "lengths": "400 um"}, lower=steel, upper=steel, outputs={"errors": n < 100})[0]
        for n in (40, 120)
    )
    assert (coarse.stick_fraction > 0) == seen
    missed = fine.stick_fraction - coarse.stick_fraction
    assert missed > 0.01
    assert missed < coarse.errors["stick_fraction"] < 4 * missed


def test_a_share_of_a_shear_strength_is_one_of_strength_times_area():
    record, _ = run({"friction": {"kind": "tresca", "shear_limit": "50 MPa"}, "share": 0.5})
    area = record.contact_area_fraction * (300e-6) ** 2
    assert record.status == "converged"
    assert record.force == pytest.approx(0.5 * 50e6 * area, rel=1e-6)
    assert record.errors["force"] > 1e-4 * record.force


def test_a_history_from_rest_ends_in_the_steady_state():
    """Three contact lengths under a force, and under a creepage; curves, and error bars from twice the step."""
    steady, _ = run({"share": 0.5})
    ends = {"distances": ["0 um", "900 um"], "shares": [0.5, 0.5]}
    rolled, context = run({}, history=ends)
    assert rolled.status == "converged"
    assert not context.notes
    assert len(rolled.rolled_distance) == 120
    assert rolled.rolled_distance[-1] == pytest.approx(9e-4, rel=1e-9)
    assert rolled.creepage == pytest.approx(steady.creepage, rel=1e-3)
    assert rolled.friction_work == pytest.approx(steady.friction_work, rel=2e-3)
    assert rolled.errors["creepage"] == pytest.approx(steady.errors["creepage"], rel=0.05)
    # pushed before, the contact rolls with less creepage at first
    assert 0.3 < rolled.rolled_creepage[0] / rolled.creepage < 0.8
    creeping, _ = run({}, history={"distances": ["0 um", "900 um"], "creepages": [steady.creepage] * 2})
    assert creeping.force == pytest.approx(steady.force, rel=2e-3)
    assert creeping.rolled_force[0] < 0.1 * creeping.force


def test_a_history_is_linear_between_its_distances_and_may_jump():
    table = {"distances": ["0 um", "30 um", "30 um", "60 um"], "creepages": [0.0, 1e-3, -1e-3, -1e-3]}
    history = scene({}, history=table).history
    assert history.steps(7.5e-6) == 8
    assert history.values(7.5e-6)[:, 0] == pytest.approx([1.25e-4, 3.75e-4, 6.25e-4, 8.75e-4, *[-1e-3] * 4], rel=1e-9)
    assert not history.values(7.5e-6)[:, 1].any()


def test_messages_of_a_history():
    ends = {"distances": ["0 um", "100 um"]}
    for table, roll, text in (
        (ends, {}, "either creepages or shares"),
        (ends | {"shares": [0.5]}, {}, "2 shares"),
        ({"distances": ["1 um", "2 um"], "shares": [0, 0.5]}, {}, "rise from 0"),
        (ends | {"shares": [0, 0.5]}, {"share": 0.5}, "alone"),
        (ends | {"shares": [0, 0.5]}, {"friction": FALLING, "speed": "2 m/s"}, "a law of the pressure alone"),
    ):
        with pytest.raises(InputError, match=text):
            scene(roll, history=table)


def test_messages_of_friction_laws():
    with pytest.raises(InputError, match="speed with it, the rolling speed"):
        scene({"friction": FALLING})
    with pytest.raises(InputError, match="several creepages may have the same force"):
        scene({"friction": FALLING, "speed": "2 m/s", "share": 0.5})
    with pytest.raises(InputError, match="friction does not depend on it"):
        scene({"speed": "2 m/s", "creepage": 0.001})
    with pytest.raises(InputError, match="shear_limit"):
        scene({"friction": "tresca"})


def test_messages():
    with pytest.raises(InputError, match="creepage follows from the force"):
        scene({"share": 0.5, "creepage": 0.001})
    with pytest.raises(InputError, match=r"roll\.friction"):
        scene({"friction": -0.1})
    with pytest.raises(InputError, match=r"roll\.friction alone"):
        scene({}, contact={"load": "20 N", "friction": 0.1})


def test_bars_of_a_short_history_cover_the_half_cell_of_its_distance():
    """A ramp over six steps of a cell: curves end at the distance, figures within their bars of finer cells."""
    ramp = {"distances": ["0 um", "50 um"], "creepages": [0.0, 1e-3]}
    coarse, _ = run({}, history=ramp)
    fine, _ = run({}, history=ramp, grid={"shape": 120, "lengths": "300 um"}, outputs={"errors": False})
    assert coarse.rolled_distance[-1] == fine.rolled_distance[-1] == pytest.approx(5e-5, rel=1e-12)
    assert coarse.creepage == fine.creepage == pytest.approx(1e-3, rel=1e-12)
    for name in ("force", "friction_work", "stick_fraction", "traction_coefficient"):
        assert abs(getattr(coarse, name) - getattr(fine, name)) < coarse.errors[name]
