"""Kind wear: figures of the summary, variants, plans, and runs that are killed and go on to the same bits."""

import json
import subprocess
import sys

import numpy as np
import pytest
from small_scenes import WEAR

from bem.campaigns import campaign_of, compute, plan
from bem.errors import InfeasibleError, InputError
from bem.notes.note import percent
from bem.scenes import load_scene
from bem.scenes.checks import examine, outcome_warnings
from bem.scenes.kind import get_kind

KEYS = {
    "particle_equivalent_radius_nm",
    "particle_length_nm",
    "particle_width_nm",
    "particle_thickness_nm",
    "particles_per_cycle",
    "Sq_initial_nm",
    "Sq_final_nm",
    "contact_area_fraction",
    "cycles",
    "number_mean_equivalent_radius_nm",
    "area_mean_equivalent_radius_nm",
    "volume_mean_equivalent_radius_nm",
    "number_above_mean_equivalent_radius_nm",
    "cell_nm",
    "smallest_radius_nm",
}


@pytest.fixture
def scene_file(tmp_path):
    def write(text=WEAR, **replaced):
        for old, new in replaced.items():
            assert f"{old} = " in text, old
            head, _, rest = text.rpartition(f"{old} = ")  # the last one: cycles.count, not depths.count
            text = f"{head}{old} = {new}\n{rest.partition(chr(10))[2]}"
        path = tmp_path / "scene.toml"
        path.write_text(text)
        return path

    return write


def campaign(path):
    scene = load_scene(path)
    return campaign_of(get_kind("wear").resolve(scene))


def run(path):
    found = campaign(path)
    plan(found)
    return compute(found).outcome


def test_summary_has_its_figures_and_the_balance_holds(scene_file):
    outcome = run(scene_file())
    assert outcome.summary.keys() >= KEYS
    assert outcome.summary["cycles"] == 12
    worn = outcome.variables["height_before"].values - outcome.variables["height_after"].values
    volume = outcome.variables["particle_volume"].values
    cell = outcome.summary["cell_nm"] ** 2 * 1e-18
    assert volume.sum() == pytest.approx(worn.sum() * cell, rel=1e-10, abs=0)  # round-off of sums of a thousand heights
    assert outcome.variables["radius"].values.shape == (1, 1, 1, 12)  # load, variant, repetition, cycle


def test_the_mean_contact_pressure_is_a_result(scene_file):
    """It was the hardness in every cycle, as the area was no less than what carries the load at the hardness."""
    outcome = run(scene_file())
    pressure = (outcome.variables["contact_load"].values / outcome.variables["contact_area"].values).ravel()
    hardness = max(pressure.max(), outcome.variables["pressure"].values.max())
    assert hardness == outcome.variables["pressure"].values.max()  # nothing is above the hardness
    assert np.count_nonzero(pressure < hardness * (1 - 1e-5)) > pressure.size / 2
    assert np.ptp(pressure) > 1e-3 * hardness
    # the mean over whole cells is the least that it can be
    cells = outcome.variables["pressure"].values
    assert cells[cells > 0].mean() < pressure[-1] < hardness


def test_loads_variants_and_repetitions_make_lists_in_the_order_of_the_scene(scene_file):
    text = (
        WEAR + '[[variants]]\nname = "coarse"\ncells = 20\n[[variants]]\nname = "rough"\nupper_rms_height = "60 nm"\n'
    )
    outcome = run(scene_file(text, loads='["2.5 N", "5 N"]', repetitions="2", count="4", settled="2"))
    assert outcome.summary["load_N"] == [2.5, 2.5, 5.0, 5.0]
    assert outcome.summary["variant"] == ["coarse", "rough", "coarse", "rough"]
    assert outcome.summary["cell_nm"] == pytest.approx([200, 100, 200, 100])
    for key in ("particle_equivalent_radius_nm", "particle_equivalent_radius_nm_spread"):
        assert len(outcome.summary[key]) == 4


def test_a_load_beyond_the_hardness_and_wrong_variants_are_refused_by_the_plan(scene_file):
    with pytest.raises(InfeasibleError, match=r"cylinder\.loads"):
        plan(campaign(scene_file(loads='["1 MN"]')))
    text = WEAR + '[[variants]]\nname = "film"\nlayer_thickness = "50 nm"\n'
    with pytest.raises(InputError, match="layer_thickness"):
        plan(campaign(scene_file(text)))
    with pytest.raises(InputError, match="settled"):
        load_scene(scene_file(settled="99"))


def test_the_plan_says_what_is_skipped(scene_file):
    steps = {step.name: step for step in plan(campaign(scene_file())).steps}
    assert steps["layered kernels"].skipped
    assert steps["traction kernels"].skipped  # steel on steel: Dundurs' beta is zero
    assert any(step.skipped and "deeper" in name for name, step in steps.items())


@pytest.mark.slow
def test_killed_several_times_it_ends_in_the_same_bits(scene_file, tmp_path):
    path = scene_file(count="600", settled="20")  # some two seconds: long enough to be killed in
    bem = [sys.executable, "-m", "bem", "run", str(path)]
    whole, torn = tmp_path / "whole", tmp_path / "torn"
    subprocess.run([*bem, "--out", str(whole)], check=True, capture_output=True, timeout=300)
    random = np.random.default_rng(5)
    kills = 0
    for attempt in range(40):
        command = [*bem, "--out", str(torn), *(["--resume"] if torn.exists() else [])]
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        try:
            # some in the middle of start-up, some in the cycles, some while files are written
            process.wait(timeout=float(random.uniform(0.5, 2.5)) if kills < 3 else 300)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
            kills += 1
            continue
        finally:
            message = process.stderr.read().decode()
            process.stderr.close()
        assert process.returncode == 0, (attempt, message)
        break
    assert kills >= 2  # a fast machine may finish before the third
    import xarray

    with xarray.open_dataset(whole / "results.nc") as a, xarray.open_dataset(torn / "results.nc") as b:
        for name in a.variables:
            if name.endswith("_seconds"):
                continue  # what it took, not what it gave
            assert np.array_equal(a[name].values, b[name].values, equal_nan=a[name].dtype.kind == "f"), name
    first, second = (json.loads((folder / "summary.json").read_text()) for folder in (whole, torn))
    for key in first:
        if not key.endswith("seconds") and key not in ("wall_time_s", "seconds_by_stage", "scene"):
            assert first[key] == second[key], key


@pytest.mark.parametrize(
    ("criterion", "converges"),
    [
        ('"von_mises"', False),
        ('{ kind = "low_cycle_fatigue", passes = 30000 }', False),
        ('{ kind = "averaged_von_mises", averaging_length = "200 nm" }', True),
        ('{ kind = "averaged_von_mises", averaging_length = "100 nm" }', False),  # one and a half cells
        ('{ kind = "junction", surface_energy = "0.045 J/m^2" }', True),
        ('{ kind = "junction", surface_energy = "0.02 J/m^2" }', False),  # d* is two cells
    ],
)
def test_what_follows_the_mesh_has_a_bar_where_it_converges(tmp_path, criterion, converges):
    """The scatter over repetitions; and the wear rate is what left by load and distance."""
    path = tmp_path / "scene.toml"
    path.write_text(
        WEAR.replace("repetitions = 1", "repetitions = 2").replace("cells = 40", "cells = 60")
        + f"[wear]\ncriterion = {criterion}\n"
    )
    found = campaign(path)
    summary = compute(found).outcome.summary
    error = summary["number_mean_equivalent_radius_nm_error"]
    assert (error is not None) is converges
    if converges:
        spread = summary["number_mean_equivalent_radius_nm_spread"]
        assert error == pytest.approx(spread / np.sqrt(2), rel=1e-9)
    grid, load = found.scene.domain.at(found.scene.cylinder, 0.0)
    slid = 3 * grid.spacing[0] * found.scene.wear.criterion.passes_per_cycle
    rate = 1e-9 * summary["worn_volume_per_cycle_um3"] / (load * slid)  # um^3 to mm^3
    assert rate > 0
    assert summary["criterion_wear_rate_mm3_Nm"] == pytest.approx(rate, rel=1e-9)


def test_one_variant_without_a_length_leaves_no_bars(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(
        WEAR.replace("repetitions = 1", "repetitions = 2")
        + '[wear]\ncriterion = "junction"\n'
        + '[[variants]]\nname = "with"\n[[variants]]\nname = "without"\ncriterion = "von_mises"\n'
    )
    summary = compute(campaign(path)).outcome.summary
    assert summary["number_mean_equivalent_radius_nm_error"] == [None, None]


@pytest.mark.parametrize(
    ("criterion", "key"),
    [
        ('{ kind = "averaged_von_mises", averaging_length = "1 mm" }', "averaging_length"),
        ('{ kind = "low_cycle_fatigue", averaging_length = "1 mm" }', "averaging_length"),
    ],
)
def test_a_length_larger_than_the_grid_is_refused_by_the_plan(scene_file, criterion, key):
    for text in (f"[wear]\ncriterion = {criterion}\n", f'[[variants]]\nname = "long"\ncriterion = {criterion}\n'):
        with pytest.raises(InputError, match=rf"{key} .* more than half of the grid's longer side; allowed: up to"):
            plan(campaign(scene_file(WEAR + text)))


def test_a_criterion_that_is_not_one_is_named_before_any_work(scene_file):
    for text, words in (
        ('{ kind = "junction", surface_energy = "-1 J/m^2" }', "surface_energy"),
        ('{ kind = "junction", surface_energy = "1 N" }', "surface_energy"),
        ('{ kind = "averaged_von_mises", length = "1 nm" }', "length"),
        ('"grain"', "junction"),
    ):
        with pytest.raises(InputError, match=words):
            load_scene(scene_file(WEAR + f"[wear]\ncriterion = {text}\n"))


def test_a_cylinder_wears_to_the_flat_of_archards_law():
    """The built-in scene in a tenth of its steps: k w s = 2 a^3 / (3 R) by length, and depth a^2 / 2R in the middle."""
    scene = load_scene(
        "wear-cylinder-scar", ("cycles.count=20", 'wear.criterion.distance="1070 mm"', "cycles.settled=5")
    )
    summary = (found := compute(campaign_of(get_kind("wear").resolve(scene))).outcome).summary
    worn = found.variables["height_before"].values - found.variables["height_after"].values
    area = 1e-15 * 5e4 * 20 * 1.07
    half_width = (1.5 * 5e-3 * area) ** (1 / 3)
    assert half_width == pytest.approx(200e-6, rel=0.01)
    # k w s: the load is met to round-off
    assert worn.sum() * 2e-6 / 2 == pytest.approx(area, rel=1e-9)
    # Hertz' half-width is a sixth of the flat's
    assert worn.reshape(300, 2)[150, 0] == pytest.approx(half_width**2 / 1e-2, rel=0.02)
    assert 0 < summary["step_error_nm"] < 0.02 * 1e9 * worn.max()
    assert summary["largest_worn_depth_nm"] == pytest.approx(1e9 * worn.max(), rel=1e-12)
    assert {"step_error_nm", "largest_worn_depth_nm"} <= set(get_kind("wear").headline)  # an error and what it is of
    assert summary["criterion_wear_rate_mm3_Nm"] == pytest.approx(1e-6, rel=1e-9)
    assert summary["particles_per_cycle"] is None


@pytest.mark.internal
def test_what_is_listed_where_both_bodies_wear_says_of_which_it_is(scene_file):
    """Particles were those of the lower body, about half of the volume, and nothing said so."""
    both = scene_file(WEAR.replace("steel-cylinder", "steel-disk") + '\n[wear]\nwears = "both"\n')
    found = {}
    for name in ("lower", "upper"):
        scene = load_scene(both, (f"sizes.particles_of={name}",))
        outcome = found[name] = compute(campaign_of(get_kind("wear").resolve(scene))).outcome
        values = {key: item.values for key, item in outcome.variables.items()}
        assert outcome.summary["particles_of"] == name
        assert set(values["particle_body"]) == {("lower", "upper").index(name)}
        share = values["particle_volume"].sum() / values["volume"].sum()
        (note,) = [
            one
            for one in outcome_warnings(examine(scene), outcome)
            if (one.code, one.values.get("reason")) == ("particles-of-body", "both")
        ]
        assert "worn depth are those of the lower one, volumes of both" in note
        assert f"are those of the {name} body, {percent(share)} of the volume" in note
    volumes = [outcome.variables["particle_volume"].values.sum() for outcome in found.values()]
    assert sum(volumes) == pytest.approx(found["lower"].variables["volume"].values.sum(), rel=1e-12, abs=0)
    assert "0 lower, 1 upper" in found["lower"].variables["particle_body"].description


@pytest.mark.internal
def test_particles_asked_for_of_a_body_that_does_not_wear_are_told(scene_file):
    scene = load_scene(scene_file(WEAR + '\n[wear]\nwears = "lower"\n'), ("sizes.particles_of=upper",))
    outcome = compute(campaign_of(get_kind("wear").resolve(scene))).outcome
    assert outcome.summary["particles_per_cycle"] == 0
    assert [text for text in outcome_warnings(examine(scene), outcome) if "only the lower one wears" in text]
    scene = load_scene(scene_file(WEAR + '\n[wear]\nwears = "lower"\n'))
    outcome = compute(campaign_of(get_kind("wear").resolve(scene))).outcome
    told = outcome_warnings(examine(scene), outcome)
    assert outcome.summary["particles_of"] == "lower"
    assert not [text for text in told if "bodies wear" in text or "one wears" in text]


STAY = '\n[wear.third_bodies]\ndiameter = "300 nm"\n'


def test_particles_that_stay_bear_load_and_are_told(scene_file, tmp_path):
    given = scene_file(WEAR + STAY + "number_per_area = 1e11\nfriction = 0.05\n")
    outcome = run(given)
    share, coverage = (outcome.summary[f"third_body_{name}"] for name in ("load_share", "coverage"))
    assert 0 < share < 1
    assert coverage == pytest.approx(np.pi / 4 * 300e-9**2 * 1e11)
    own = load_scene(given).cylinder.friction
    assert outcome.summary["third_body_friction"] == pytest.approx((1 - share) * own + share * 0.05)
    apart = run(scene_file(WEAR + STAY + "number_per_area = 1e13\n"))
    # they hold the surfaces apart: no contact has no pressure, and no friction is less than none
    assert apart.summary["third_body_load_share"] == pytest.approx(1, abs=1e-12)
    assert apart.summary["third_body_friction"] >= 0
    assert np.isnan(apart.summary["mean_contact_pressure_Pa"])
    none, plain = (run(scene_file(WEAR + more)) for more in (STAY + "number_per_area = 0.0\n", ""))
    assert np.array_equal(none.variables["height_after"].values, plain.variables["height_after"].values)
    assert "third_body_load_share" not in plain.summary


@pytest.mark.filterwarnings("error")
def test_particles_that_bear_all_of_the_load_are_told(scene_file):
    """Nothing touches: no mean pressure of it, and a note; the terminal shows the share."""
    result = compute(campaign(scene_file(WEAR + '\n[wear.third_bodies]\ndiameter = "20 um"\nnumber_per_area = 2e9\n')))
    outcome = result.outcome
    assert outcome.summary["contact_area_fraction"] == 0
    assert np.isnan(outcome.summary["mean_contact_pressure_Pa"])
    assert outcome.summary["third_body_load_share"] == pytest.approx(1, abs=1e-5)  # BALANCE, and a little
    assert any((note.code, note.values.get("reason")) == ("third-bodies-many", "load") for note in result.notes)


def test_as_many_particles_lie_there_as_wear_makes_within_their_residence(scene_file):
    found = STAY + 'specific_wear_rate = "1e-6 mm^3/(N*m)"\nresidence = "1 mm"\nkept = 0.5\n'
    table = load_scene(scene_file(WEAR + found)).wear.third_bodies
    # depth worn along the residence over the volume of a sphere
    assert table.build(1e9).number_per_area == pytest.approx(0.5 * 1e-15 * 1e9 * 1e-3 / (np.pi / 6 * 300e-9**3))


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ("", "number_per_area alone nor"),
        ('number_per_area = 1e11\nresidence = "1 mm"\n', "specific_wear_rate with residence"),
        ("number_per_area = 1e13\nremoved = 1.0\n[wear]\nshift = 30\n", "cut deeper than they lie"),
        ("number_per_area = 1e15\n", "covers 70.7 times the area"),
    ],
)
def test_particles_that_cannot_be_are_refused_before_any_work(scene_file, more, message):
    with pytest.raises(InputError, match=message):
        plan(campaign_of(load_scene(scene_file(WEAR + STAY + more))))


@pytest.mark.parametrize(
    ("given", "lacks"), [('temperature = "90 C"', "sliding_speed"), ('sliding_speed = "0.5 m/s"', "temperature")]
)
def test_what_a_boundary_film_between_dry_surfaces_lacks_is_said_before_any_work(scene_file, given, lacks):
    film = f"\n[wear.film_defect]\nadsorption_energy = 1e-19\n{given}\n[wear.criterion]\nkind = 'archard'\n"
    law = "specific_wear_rate = 1e-15\ndistance = '1 mm'\n"
    with pytest.raises(InputError, match=rf"wear\.film_defect\.{lacks}: missing"):
        plan(campaign_of(load_scene(scene_file(WEAR + film + law))))
