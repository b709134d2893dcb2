"""Kind tribofilm: figures of the summary, variants, what is refused, what is skipped, and a run that goes on."""

import dataclasses

import numpy as np
import pytest

from bem.campaigns import campaign_of, compute, plan
from bem.errors import InfeasibleError, InputError
from bem.kinds.tribofilm.kind import KIND
from bem.scenes import get_kind, load_scene

SMALL = """
kind = "tribofilm"
[grid]
shape = 20
lengths = "40 nm"
[lower]
material = { name = "iron", youngs_modulus = "210 GPa", poissons_ratio = 0.3 }
[upper]
material = "dlc"
[shape]
kind = "sphere"
radius = "53 nm"
[rubbing]
loads = ["600 nN"]
temperatures = ["90 degC", "100 degC"]
duration = "6000 s"
points = 21
report = ["3000 s", "6000 s"]
[film]
activation_energy = "0.8 eV"
activation_volume = "85 angstrom^3"
wear_coefficient = "1e-3 1/s"
concentration_constant = "1.24e7 1/m"
hardness = { kind = "constant", value = "2 GPa" }
youngs_modulus = { kind = "constant", value = "15 GPa" }
"""
KEYS = {"temperature_C", "film_thickness_nm", "film_wear_rate_nm_s", "wear_depth_nm", "concentration"}


def prepared(tmp_path, text):
    path = tmp_path / "scene.toml"
    path.write_text(text)
    return campaign_of(get_kind("tribofilm").resolve(load_scene(path)))


def test_summary_lists_run_over_temperatures(tmp_path):
    campaign = prepared(tmp_path, SMALL)
    outcome = compute(campaign).outcome
    assert outcome.summary.keys() >= KEYS
    assert outcome.summary["temperature_C"] == pytest.approx([90, 100])
    thickness, worn = outcome.summary["film_thickness_nm"], outcome.summary["wear_depth_nm"]
    assert thickness[1] > thickness[0] > 0  # growth is thermally activated
    # a steady film: depth = alpha h exp(-C1 h) over the time between the two reports
    for h, depth in zip(thickness, worn, strict=True):
        expected = 1e-3 * h * np.exp(-1.24e7 * 1e-9 * h) * 3000
        assert depth == pytest.approx(expected, rel=0.05)  # 3 e-foldings after the start the film is 95 % there
    history = outcome.variables["thickness"].values
    assert history.shape == (1, 2, 1, 1, len(outcome.variables["time"].values))
    # the wear between the two times of the report is a part of the total, and means lie below the local maximum
    total = outcome.variables["substrate_wear"].values[..., -1].ravel()
    assert outcome.summary["total_wear_depth_nm"] == pytest.approx(1e9 * total)
    assert all(0 < part < 0.7 * whole for part, whole in zip(worn, 1e9 * total, strict=True))
    mean, local = (outcome.summary[f"largest_{which}thickness_nm"] for which in ("mean_", ""))
    assert mean == pytest.approx(1e9 * history.max(axis=-1).ravel())
    maps = outcome.variables["film_map"].values
    assert local == pytest.approx(1e9 * maps.reshape(-1, *maps.shape[-2:]).max(axis=(1, 2)))
    assert all(highest > average for highest, average in zip(local, mean, strict=True))


def test_loads_and_variants_come_in_the_order_of_the_scene(tmp_path):
    text = SMALL.replace('["600 nN"]', '["600 nN", "340 nN"]').replace('["90 degC", "100 degC"]', '["100 degC"]')
    text += '[[variants]]\nname = "worn"\n[[variants]]\nname = "unworn"\nwear_coefficient = "0 1/s"\n'
    campaign = prepared(tmp_path, text)
    summary = compute(campaign).outcome.summary
    assert summary["variant"] == ["worn", "unworn", "worn", "unworn"]
    assert summary["load_N"] == pytest.approx([600e-9, 600e-9, 340e-9, 340e-9])
    thickness = summary["film_thickness_nm"]
    assert thickness[1] > thickness[0]
    assert thickness[3] > thickness[2]
    assert thickness[0] > thickness[2]


@pytest.mark.internal
def test_a_finished_film_is_not_grown_again(tmp_path, monkeypatch):
    campaign = prepared(tmp_path, SMALL)
    whole = compute(campaign, tmp_path)
    (tmp_path / "cases" / "00001.bin").unlink()
    grown = []
    run = KIND.run
    counting = dataclasses.replace(KIND, run=lambda *given: grown.append(given) or run(*given))
    monkeypatch.setattr("bem.campaigns.engine.get_kind", lambda name: counting)
    rest = compute(campaign, tmp_path)
    assert len(grown) == 1
    assert np.array_equal(whole.outcome.variables["thickness"].values, rest.outcome.variables["thickness"].values)


def test_local_feedback_runs_and_refuses_a_lag(tmp_path):
    text = SMALL.replace('["90 degC", "100 degC"]', '["100 degC"]') + 'feedback = "local"\nlocal_tolerance = 0.05\n'
    campaign = prepared(tmp_path, text)
    outcome = compute(campaign).outcome
    assert outcome.summary["film_thickness_nm"] > 0
    with pytest.raises(InputError, match="lag"):
        prepared(tmp_path, text + 'lag = "10 s"\n')


def test_plan_refuses_what_the_film_cannot_carry_and_says_what_is_reused(tmp_path):
    campaign = prepared(tmp_path, SMALL)
    steps = {step.name: step for step in plan(campaign).steps}
    assert steps["contacts at other times"].skipped
    assert steps["tangential kernels"].skipped
    campaign = prepared(tmp_path, SMALL.replace("600 nN", "1 N"))
    with pytest.raises(InfeasibleError, match="loads"):
        plan(campaign)
    with pytest.raises(InputError, match="report"):
        prepared(tmp_path, SMALL.replace('"6000 s"]', '"9000 s"]'))
    table = 'hardness = { kind = "table", thickness = ["1 nm", "0 nm"], value = ["1 GPa", "2 GPa"] }'
    with pytest.raises(InputError, match="curve"):
        prepared(tmp_path, SMALL.replace('hardness = { kind = "constant", value = "2 GPa" }', table))


def test_with_speeds_spots_are_warmer_and_grow_faster(tmp_path):
    """A ceramic with thermal constants in place of iron and DLC, which have none here."""
    text = SMALL.replace('material = { name = "iron", youngs_modulus = "210 GPa", poissons_ratio = 0.3 }', WARM)
    text = text.replace('material = "dlc"', WARM).replace('["90 degC", "100 degC"]', '["90 degC"]')
    still = compute(prepared(tmp_path, text)).outcome.summary
    rubbed = text.replace("points = 21", 'points = 21\nspeeds = ["60 m/s", "0 m/s"]')
    fast = compute(prepared(tmp_path, rubbed)).outcome.summary
    assert "flash_temperature_C" not in still
    assert fast["flash_temperature_C"] > 91
    assert fast["film_thickness_nm"] > 1.02 * still["film_thickness_nm"]
    with pytest.raises(InputError, match=r"rubbing\.speeds: heat of .*, a material without thermal constants"):
        prepared(tmp_path, SMALL.replace("points = 21", 'points = 21\nspeeds = ["60 m/s", "0 m/s"]'))


WARM = """material = { name = "ceramic", youngs_modulus = "210 GPa", poissons_ratio = 0.3, \
thermal_conductivity = "30 W/(m*K)", density = "3200 kg/m^3", heat_capacity = "700 J/(kg*K)" }"""
