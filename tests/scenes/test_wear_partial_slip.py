"""Wear and running-in in partial slip as scenes: the closed forms of a cylinder, what is refused, runs that go on."""

import copy

import numpy as np
import pytest
from small_scenes import WEAR
from test_friction_kinds import RUNNING_IN, Interrupting, StopHereError, run

from bem.campaigns import campaign_of, compute
from bem.errors import InputError
from bem.notes import has_code
from bem.notes.wear import PARTIAL_SLIP_IN_OIL
from bem.runs import plan_scene
from bem.scenes import load_scene
from bem.scenes.kind import get_kind

FORCE = {"kind": "oscillating_force", "share": 0.8}


def wear_scene(tmp_path, text):
    path = tmp_path / "scene.toml"
    path.write_text(WEAR + text)
    return load_scene(path)


def test_a_cylinder_wears_in_two_stripes_beside_what_sticks_or_everywhere():
    """The built-in scene in few steps: half-width of stick a sqrt(1 - share); energy of sliding as a whole."""
    scene = load_scene("fretting-wear", ("cycles.count=2", "cycles.settled=1"))
    outcome = compute(campaign_of(get_kind("wear").resolve(scene))).outcome
    slides, sticks = outcome.summary["stick_share"]
    assert slides == 0
    assert sticks == pytest.approx(np.sqrt(0.4), rel=0.03)
    x, worn = outcome.variables["x"].values, outcome.variables["height_before"].values
    worn = (worn - outcome.variables["height_after"].values)[:, 0]
    half = 105.1e-6  # Hertz
    assert np.abs(x[worn > 0]).min() == pytest.approx(half * np.sqrt(0.4), abs=2 * (x[1] - x[0]))
    assert np.abs(x[worn > 0]).max() == pytest.approx(half, abs=2 * (x[1] - x[0]))
    assert (outcome.variables["slid"].values[:, 0][worn > 0] > 0).all()
    # the force on the slice is 0.4 N: less than friction x load x four amplitudes, by what is elastic
    energy = outcome.summary["loop_energy_J"][0]
    assert 0.5 * 4 * 0.6 * 0.4 * 6e-6 < energy < 4 * 0.6 * 0.4 * 6e-6


def test_gross_sliding_tells_nothing_of_loops(tmp_path):
    outcome = compute(campaign_of(get_kind("wear").resolve(wear_scene(tmp_path, "")))).outcome
    assert not {"stick_share", "loop_energy_J"} & outcome.summary.keys()
    assert "slid" not in outcome.variables


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('traction = "gross"', "gross_sliding"),
        ('traction = { kind = "oscillating_force", share = 1.2 }', "share"),
        ('traction = { kind = "oscillating_force" }', "share"),
        ('traction = { kind = "oscillating_shift", amplitude = "2 N" }', "amplitude"),
        ('stress_range = true\ntraction = { kind = "oscillating_force", share = 0.5 }', "stress_range"),
        ('criterion = { kind = "archard", specific_wear_rate = "1e-15 m^2/N" }', "distance"),
    ],
)
def test_what_cannot_be_meant_is_named_before_any_work(tmp_path, text, words):
    with pytest.raises(InputError, match=words) as caught:
        wear_scene(tmp_path, f"[wear]\n{text}\n")
    assert len(caught.value.messages) == 1


def test_partial_slip_without_friction_is_refused_by_the_plan():
    with pytest.raises(InputError, match="friction is 0"):
        plan_scene("fretting-wear", ["cylinder.friction=0"])


@pytest.mark.internal
def test_running_in_takes_its_stresses_from_partial_slip_and_goes_on_to_the_same_bits(tmp_path):
    data = copy.deepcopy(RUNNING_IN) | {"speeds": ["0.003 m/s"], "wear": {"traction": FORCE}}
    scene, outcome, whole = run(data)
    assert 0 < outcome.summary["stick_share"][0] < 1
    assert outcome.summary["particles_per_cycle"][0] > 0
    # friction and film take the surfaces to slide everywhere, which nothing said
    assert has_code(whole.notes, PARTIAL_SLIP_IN_OIL)
    with pytest.raises(StopHereError):
        compute(campaign_of(scene), tmp_path, watcher=Interrupting())
    resumed = compute(campaign_of(scene), tmp_path)
    assert resumed.outcome.summary == outcome.summary
    assert resumed.notes == whole.notes
    for name, variable in outcome.variables.items():
        assert np.array_equal(variable.values, resumed.outcome.variables[name].values), name


def test_running_in_at_equal_speeds_has_no_friction_to_take_a_part_of():
    speeds = {"values": ["0.003 m/s"], "cylinder": 1.0}
    with pytest.raises(InputError, match="friction is 0"):
        run(copy.deepcopy(RUNNING_IN) | {"speeds": speeds, "wear": {"traction": FORCE}})
