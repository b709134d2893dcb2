"""Kinds friction, running-in and asperities: closed forms, skips that change nothing, resuming, messages."""

import copy
import dataclasses
import math

import numpy as np
import pytest
from pydantic import ValidationError
from small_scenes import PATCH

from bem.campaigns import campaign_of, compute
from bem.campaigns.context import Silent
from bem.contact import solve_contact
from bem.errors import InputError, Status
from bem.friction import solve, solve_mixed
from bem.friction.asperity_array import SQUARE_LATTICE
from bem.friction.film_table import FilmTable
from bem.friction.line_film import SolvedLineFilm
from bem.friction.setup import MixedSetup
from bem.friction.smooth import LineContact
from bem.grid import Grid
from bem.lubrication import Lubricant
from bem.materials import CATALOGUE, Body
from bem.plots.tables import figure_tables
from bem.runs import plan_scene
from bem.scenes.context import notes_over
from bem.scenes.lubrication import SpeedsScene
from bem.surfaces import generate_surface
from bem.wear.mixed import MixedContact

OIL = Lubricant(0.36, pressure_viscosity=25e-9, density_law="incompressible")
FRICTION = {"kind": "friction", "speeds": ["0.003 m/s", "0.5 m/s"], "film": {"points": 300}, **PATCH}
RUNNING_IN = {
    "kind": "running-in",
    "speeds": ["0.003 m/s", "0.5 m/s"],
    "depths": {"count": 12, "spacing": "100 nm"},
    "cycles": {"count": 12, "averaged": 3, "settled": 12},
    "sharing": {"film_points": 200},
    **PATCH,
}


def scene_with(base, **tables):
    data = copy.deepcopy(base)
    for name, value in tables.items():
        data[name] = data[name] | value if isinstance(value, dict) and isinstance(data.get(name), dict) else value
    return data


def run(source):
    scene, _ = plan_scene(source, [])
    computed = compute(campaign_of(scene))
    return scene, computed.outcome, computed


@pytest.mark.parametrize("base", [FRICTION, RUNNING_IN], ids=["friction", "running-in"])
def test_a_grid_that_does_not_say_otherwise_goes_on_along_the_cylinder(base):
    for grid, periodic in (({}, (False, True)), ({"periodic": False}, (False, False))):
        scene, _ = plan_scene(base | {"grid": {"shape": [64, 32], "spacing": "0.8 um"} | grid}, [])
        assert scene.grid.periodic == periodic


@pytest.fixture(scope="module")
def friction():
    return run(scene_with(FRICTION, sharing={"models": ["capped", "uncoupled"]}, repetitions=2))[1]


def test_friction_keys_and_limits(friction):
    summary = friction.summary
    for key in ("speed_m_s", "friction", "contact_load_N", "film_load_N", "minimum_film_nm", "lambda_ratio"):
        assert len(summary[key]) == 2
    assert summary["model"] == "capped"
    assert summary["contact_load_N"][1] == 0.0  # full film at 0.5 m/s: no contact was solved
    assert summary["contact_solves"][1] == 0.0
    assert 0.1 < summary["friction"][0] < 0.15  # near, and below, the boundary friction
    # forces balance to the tolerance of the sharing, 1e-4
    np.testing.assert_allclose(np.add(summary["contact_load_N"], summary["film_load_N"]), 5.5, rtol=1e-4)


def test_both_lambda_ratios_stand_under_their_own_keys(friction):
    """That of the film under the whole load, and that of the film beside contact, which is its minimum over Sq."""
    summary = friction.summary
    mixed, whole = summary["lambda_ratio_mixed"], summary["lambda_ratio"]
    np.testing.assert_allclose(np.multiply(mixed, summary["Sq_nm"]), summary["minimum_film_nm"], rtol=1e-12)
    np.testing.assert_allclose(np.multiply(whole, summary["Sq_nm"]), summary["minimum_film_whole_nm"], rtol=1e-12)
    assert mixed[0] > 1.5 * whole[0]  # a film that carries a part of the load is thicker
    assert mixed[1] == pytest.approx(whole[1], rel=1e-9)  # in full film it carries all
    assert "whole load" in friction.variables["lambda_ratio"].description
    assert "part of the load" in friction.variables["lambda_ratio_mixed"].description
    names = ["minimum_film_nm", "lambda_ratio", "lambda_ratio_mixed"]
    heads = [head for table in figure_tables(summary, names) for head in table.head]
    assert any("minimum film thickness (under the film's load)" in head for head in heads)
    assert [head for head in heads if "lambda" in head] == [
        "lambda ratio (if the film carried the whole load)",
        "lambda ratio (under the film's load)",
    ]


def test_friction_parts_add_up(friction):
    for curve in friction.summary["curves"]:
        parts = np.add(curve["boundary_friction_part"], curve["film_friction_part"])
        np.testing.assert_allclose(parts, curve["friction"], rtol=1e-12)  # sums of the same numbers


def test_difference_is_that_of_the_curves(friction):
    (row,) = friction.summary["largest_difference"]
    friction_of = friction.variables["friction"].values
    each = [
        100 * np.max(np.abs(friction_of[0, 0, 1, r] - friction_of[0, 0, 0, r])) / friction_of[0, 0, 1, r, 0]
        for r in range(2)
    ]  # at 0.5 m/s both are full film
    assert row["d_percent"] == pytest.approx(np.mean(each), rel=1e-12)


def test_pressures_give_the_load():
    """Maximum Hertz pressures of 1 GPa and 0.5 GPa are loads in the ratio of four."""
    contact = {"loads": None, "hertz_pressures": ["0.5 GPa", "1 GPa"]}
    data = scene_with(FRICTION, contact=contact, grid={"shape": [128, 32], "spacing": "0.8 um"})
    del data["contact"]["loads"]
    scene, _ = plan_scene(data, [])
    modulus = 210e9 / (2 * (1 - 0.3**2))
    low, high = scene.contact.forces(modulus)
    assert high / low == pytest.approx(4, rel=1e-12)
    assert high == pytest.approx(math.pi * 2e-3 * 1e18 / modulus * 6e-3, rel=1e-12)


@pytest.mark.internal
def test_film_table_is_the_film():
    position = (np.arange(64) - 31.5) * 0.8e-6
    table = FilmTable(SolvedLineFilm(LineContact(2e-3, 1.0, 115e9, OIL), (0.02, 0.0), position, 300), load=900.0)
    # ten times below the 0.3 % asked of the film, but at the exit's constriction, where films are steep
    assert max(table.error(load) for load in (850.0, 300.0, 60.0)) < 4e-3
    exact = table.films.solve(300.0, table.entry(8))
    at = table.under(300.0)
    assert at.thickness.mean() == pytest.approx(exact.at(position)[1].mean(), rel=3e-4)
    assert at.shear_force == pytest.approx(exact.shear_force, rel=1e-3)
    with pytest.raises(InputError, match="table"):
        table.under(901.0)


@pytest.mark.internal
def test_film_table_does_not_depend_on_what_was_asked_first():
    position = (np.arange(16) - 7.5) * 2e-6
    values = []
    for loads in ((100.0, 700.0), (700.0, 100.0)):
        table = FilmTable(SolvedLineFilm(LineContact(2e-3, 1.0, 115e9, OIL), (0.02, 0.0), position, 200), load=900.0)
        found = {load: table.under(load).thickness for load in loads}
        values.append(found)
    for load in (100.0, 700.0):
        assert np.array_equal(values[0][load], values[1][load])


def patch_case(**more):
    """Heights like those of `PATCH`, and the other arguments of `solve_mixed`."""
    grid = Grid((64, 32), (0.8e-6, 0.8e-6), periodic=(False, True))
    case = {
        "grid": grid,
        "bodies": (Body(CATALOGUE["steel-disk-110HV"].material), Body(CATALOGUE["steel-cylinder"].material)),
        "radius": 2e-3,
        "width": 6e-3,
        "load": 5.5,
        "lubricant": OIL,
        "boundary_friction": 0.15,
        "hardness": 1.08e9,
    }
    return generate_surface(grid, rms_height=120e-9, correlation_length=2e-6, seed=4), case | more


@pytest.mark.internal
@pytest.mark.parametrize("speed", [0.003, 0.05, 0.5])
def test_cycle_contact_is_load_sharing(speed):
    """The contact of a wear cycle, from tabulated films, is `solve_mixed`."""
    height, case = patch_case(film_points=300)
    step = MixedContact(MixedSetup(**case, tolerance=5e-4, contact_tolerance=1e-4), (speed, 0.0))
    outcome = step(height + 3e-7, None)  # the mean does not matter
    solution = solve_mixed(height=height, speeds=(speed, 0.0), **case)
    row = outcome.sharing[0]
    assert outcome.status is Status.CONVERGED
    assert abs(outcome.memory.last.balance.imbalance) <= 5e-4
    # tolerance of the balance 5e-4; film thickness from another mesh 2e-3
    assert row["total_friction"] == pytest.approx(solution.friction, rel=3e-3)
    assert row["width_contact_load"] == pytest.approx(solution.contact_load, rel=1e-2, abs=1e-12)
    assert row["minimum_film"] == pytest.approx(solution.minimum_film, rel=5e-3)
    if speed == 0.5:
        assert outcome.memory.last.balance.contacts == 0


@pytest.mark.internal
def test_a_contact_solved_too_coarsely_is_solved_better(monkeypatch):
    """Loads that jump with the contact's own tolerance must not keep film and contact from their balance."""
    height, case = patch_case(film_points=200, tolerance=5e-4)
    exact = MixedContact(MixedSetup(**case), (0.05, 0.0))
    middle = exact(height).sharing["film_load"][0]
    tolerances = []

    def jumping(gap, operator, *, tolerance, **others):
        solution = solve_contact(gap, operator, tolerance=tolerance, **others)
        tolerances.append(tolerance)
        noise = 50 * tolerance * (-1) ** len(tolerances)
        return dataclasses.replace(solution, gap=solution.gap * (1 + noise))

    monkeypatch.setattr("bem.friction.rough_contact.solve_contact", jumping)
    # openings are 0.5 % off, to and fro, ten times the balance's tolerance
    step = MixedContact(MixedSetup(**case, contact_tolerance=1e-4), (0.05, 0.0))
    outcome = step(height, None)
    assert outcome.status is Status.CONVERGED
    assert abs(outcome.memory.last.balance.imbalance) <= 5e-4
    assert tolerances[0] == 1e-4
    assert tolerances[-1] == pytest.approx(1e-6)
    assert outcome.sharing["film_load"][0] == pytest.approx(middle, rel=1e-3)  # the balance' tolerance, twice


class StopHereError(Exception):
    """The run is killed."""


class Interrupting(Silent):
    def __init__(self, what="cycles", done=11):  # one cycle beyond the checkpoint
        self.stop = (what, done)

    def progress(self, done, total, what, figures):
        if (what, done) == self.stop:
            raise StopHereError


def test_figures_over_speed_have_their_errors():
    scene = scene_with(FRICTION, speeds=["0.02 m/s", "0.5 m/s"], sharing={"models": ["capped"]})
    summary = run(scene)[1].summary
    for name in ("friction", "contact_load_N", "film_load_N", "minimum_film_nm", "lambda_ratio"):
        errors = summary[f"{name}_error"]
        assert len(errors) == 2, name
        assert all(error is None or error >= 0 for error in errors), name
    assert 0 < summary["friction_error"][0] < 0.2 * summary["friction"][0]
    assert not [key for key in run({**scene, "outputs": {"errors": False}})[1].summary if key.endswith("_error")]


@pytest.mark.parametrize("counted", ["patch", "loaded"])
def test_where_the_oil_is_counted_is_a_key_and_said_once_for_all_speeds(counted):
    speeds = ["0.003 m/s", "0.05 m/s", "0.08 m/s", "0.5 m/s"]
    sharing = {"models": ["capped"], "oil_volume": counted}
    _, outcome, result = run(scene_with(FRICTION, speeds=speeds, sharing=sharing) | {"outputs": {"errors": False}})
    summary = outcome.summary
    assert all(0 < share < 1 for share in summary["oil_beside_contact"])
    said = [note for note in result.notes if note.code == "oil-counted"]
    changed = np.array(summary["loaded_friction"]) / np.array(summary["friction"]) - 1
    if counted == "loaded":
        assert said == []
        assert (changed == 0).all()
        assert summary["loaded_contact_load_N"] == pytest.approx(summary["contact_load_N"], rel=1e-14)  # round-off
    else:
        assert len(said) == 1
        assert "speed" not in said[0]
        assert np.abs(changed).max() > 0.01
        assert changed[-1] == 0  # full film


@pytest.mark.internal
def test_notes_of_several_speeds_are_told_once_with_the_speeds_that_have_them():
    """The film's named none, those of error bars were told again for each speed and repetition."""
    notes = [["a", "b"], ["a", "c", "c"], ["b", "a", "c"], ["a", "b"]]
    told = notes_over("speed", "m/s", [0.1, 0.2, 0.4, 1.0], notes)
    assert told == ["a", "speeds 0.1, 0.4 to 1 m/s: b", "speeds 0.2 to 0.4 m/s: c"]
    assert notes_over("speed", "m/s", [0.1], [["a"]]) == ["a"]
    speeds = ["1e-6 m/s", "0.003 m/s", "0.02 m/s", "5 m/s"]
    scene = scene_with(FRICTION, speeds=speeds, film={"points": 200}, sharing={"models": ["uncoupled"]})
    _, _, computed = run(scene)
    summits = [note for note in computed.notes if note.values.get("reason") == "other-summits"]
    assert [note.where for note in summits] == ["speeds 1e-06 to 0.02 m/s"]  # the last is a full film
    hot = [note for note in computed.notes if (note.code, note.values.get("reason")) == ("heat-left-out", "sliding")]
    assert [note.where for note in hot] == ["speed 5 m/s, film"]


LAW = {"kind": "pressure_dependent", "shear_strength": 1e6, "pressure_coefficient": 0.1}


@pytest.mark.internal
@pytest.mark.parametrize(
    ("model", "friction"), [("capped", LAW), ("uncoupled", 0.15)], ids=["capped-law", "uncoupled-coefficient"]
)
def test_a_curve_killed_between_speeds_goes_on_to_the_same_bits(tmp_path, model, friction, monkeypatch):
    speeds = ["0.003 m/s", "0.02 m/s", "0.1 m/s", "0.5 m/s"]
    data = scene_with(FRICTION, speeds=speeds, sharing={"models": [model]}, contact={"boundary_friction": friction})
    scene, outcome, whole = run(data)
    solved = []
    solve_setup = solve.solve_setup
    monkeypatch.setattr(solve, "solve_setup", lambda *given: solved.append(0) or solve_setup(*given))
    for done in (1, 3):
        with pytest.raises(StopHereError):
            compute(campaign_of(scene), tmp_path, watcher=Interrupting("speeds", done))
    assert len(solved) == 3  # none twice
    resumed = compute(campaign_of(scene), tmp_path)
    assert len(solved) == len(speeds)
    assert resumed.outcome.summary == outcome.summary
    assert resumed.notes == whole.notes
    for name, variable in outcome.variables.items():
        np.testing.assert_array_equal(variable.values, resumed.outcome.variables[name].values, err_msg=name)


@pytest.mark.internal
def test_running_in_resumes_to_the_same_bits(tmp_path):
    scene, outcome, _ = run(RUNNING_IN)
    summary = outcome.summary
    for key in ("friction_initial", "friction_run_in", "particle_equivalent_radius_nm", "Sq_initial_nm", "Sq_final_nm"):
        assert len(summary[key]) == 2
    # full film: nothing wears, and the mean of equal numbers is that number up to rounding
    assert summary["friction_run_in"][1] == pytest.approx(summary["friction_initial"][1], rel=1e-14)
    assert summary["particles_per_cycle"][1] == 0
    assert summary["Sq_final_nm"][1] == summary["Sq_initial_nm"][1]
    assert summary["particles_per_cycle"][0] > 0
    with pytest.raises(StopHereError):
        compute(campaign_of(scene), tmp_path, watcher=Interrupting())
    resumed = compute(campaign_of(scene), tmp_path).outcome
    assert resumed.summary == summary
    for name, variable in outcome.variables.items():
        np.testing.assert_array_equal(variable.values, resumed.variables[name].values, err_msg=name)


def test_temperatures_of_contacts_have_error_bars_where_surfaces_touch():
    steel = {
        "lower": {"material": "steel-52100", "surface": PATCH["lower"]["surface"]},
        "upper": {"material": "steel-52100"},
    }
    oil = {"oil": {"grade": "ISO VG 10", "temperature": "100 degC"}, "speeds": ["0.5 m/s", "40 m/s"]}
    slow, fast = 0, 1
    summary = run(FRICTION | steel | oil | {"thermal": "lumped"})[1].summary
    assert summary["contact_load_N"][fast] == 0 < summary["contact_load_N"][slow]
    for name in ("contact_temperature_C", "flash_temperature_C"):
        error = summary[f"{name}_error"]
        assert 0 < error[slow] < summary[name][slow] - 100
        assert error[slow] == pytest.approx(
            sum(summary[f"{name}_error_{part}"][slow] for part in ("grid", "film_points", "balance"))
        )
        assert np.isnan(summary[name][fast])
        assert error[fast] is None
    off = run(FRICTION | steel | oil | {"thermal": "off"})[1].summary
    assert "flash_temperature_C_error" not in off


def test_running_in_with_heat_wears_where_a_boundary_film_is_hot():
    steel = {"catalogue": "steel-52100", "hardness": "1.08 GPa"}
    law = {"kind": "archard", "specific_wear_rate": "1e-6 mm^3/(N*m)", "distance": "1 cm"}
    scene = RUNNING_IN | {
        "lower": {"material": steel, "surface": PATCH["lower"]["surface"]},
        "upper": {"material": steel},
        "oil": {"grade": "ISO VG 10", "temperature": "100 degC"},
        "speeds": ["2 m/s"],
        "wear": {"criterion": law, "film_defect": {"adsorption_energy": "0.6 eV"}},
        "cycles": {"count": 2, "averaged": 1, "settled": 1, "coarser_grid": True},
    }
    hot, full, off = (run(scene | {"thermal": thermal})[1].summary for thermal in ("lumped", "full", "off"))
    # the film's heat is mild: the contact's, which wears, hardly knows its model
    assert full["worn_depth_nm"][0] == pytest.approx(hot["worn_depth_nm"][0], rel=0.01)
    assert full["flash_temperature_C"][0] - 100 == pytest.approx(hot["flash_temperature_C"][0] - 100, rel=0.01)
    assert hot["flash_temperature_C"][0] > hot["contact_temperature_C"][0] > 101
    assert "flash_temperature_C" not in off
    # with what columns and layers leave
    assert full["minimum_film_nm_error"][0] > 0
    assert full["worn_depth_nm_error"][0] > 0
    depth, volume = (full[f"{name}_error"][0] / full[name][0] for name in ("worn_depth_nm", "wear_volume_um3"))
    assert volume == pytest.approx(depth, rel=1e-9)
    assert hot["minimum_film_nm_error"][0] > 0
    for name in ("contact_temperature_C", "flash_temperature_C"):
        rise = hot[name][0] - 100
        assert 0 < hot[f"{name}_error"][0] < rise
        assert f"{name}_error" not in off
    assert hot["worn_depth_nm"][0] > 1.1 * off["worn_depth_nm"][0] > 0
    with pytest.raises(InputError, match=r"film_defect\.temperature: missing"):
        run(scene | {"oil": PATCH["oil"]})
    with pytest.raises(InputError, match="film_defect of criterion von_mises"):
        run(scene | {"wear": {"film_defect": {"adsorption_energy": "0.6 eV"}}})


@pytest.mark.internal
def test_particles_that_stay_in_oil_bear_load_roll_and_are_fed(tmp_path):
    stay = {"diameter": "400 nm", "number_per_area": 1e9, "friction": 0.02, "shed": 1e-3, "leaving": 0.2}
    scene = scene_with(RUNNING_IN, speeds=["0.003 m/s"], cycles={"count": 11, "averaged": 3, "settled": 4})
    with_them = scene | {"wear": {"third_bodies": stay}}
    plain, outcome = (run(each)[1] for each in (scene, with_them))
    share, coverage = (outcome.summary[f"third_body_{name}"][0] for name in ("load_share", "coverage"))
    assert 0 < share < 1
    contact, film = outcome.summary["contact_load_N"][0], outcome.summary["film_load_N"][0]
    assert contact + film + share * 5.5 == pytest.approx(5.5, rel=1e-2)  # means over 3 and 4 cycles
    assert contact < plain.summary["contact_load_N"][0]
    over = np.squeeze(outcome.variables["third_body_coverage_over_cycles"].values)
    assert over[0] == pytest.approx(np.pi / 4 * 400e-9**2 * 1e9)
    assert coverage == pytest.approx(over[-4:].mean())
    assert len(np.unique(over)) == 11
    assert "third_body_load_share" not in plain.summary
    # stopped after ten cycles and gone on with: the same bits
    with pytest.raises(StopHereError):
        compute(campaign_of(plan_scene(with_them, [])[0]), tmp_path, watcher=Interrupting())
    assert compute(campaign_of(plan_scene(with_them, [])[0]), tmp_path).outcome.summary == outcome.summary


def test_particles_in_oil_that_cut_deeper_than_they_lie_are_refused_before_any_work():
    """As between dry surfaces; it was said after the films."""
    stay = {"diameter": "400 nm", "number_per_area": 6e12, "removed": 1.0}
    with pytest.raises(InputError, match="cut deeper than they lie"):
        plan_scene(scene_with(RUNNING_IN, wear={"shift": 60, "third_bodies": stay}), [])


def test_hardness_moves_the_cap_and_the_yield_stress():
    data = scene_with(RUNNING_IN, hardnesses=["1 GPa", "20 GPa"], speeds=["0.003 m/s"])
    data["cycles"] = {"count": 3, "averaged": 1, "settled": 3}
    _, outcome, _ = run(data)
    soft, hard = outcome.summary["particles_per_cycle"]
    assert outcome.summary["hardness_Pa"] == [1e9, 6e9]  # beyond 6 GPa the cylinder is the softer
    assert soft > 0
    assert hard < soft


@pytest.mark.parametrize(
    ("tables", "words"),
    [
        ({"oil": {"viscosity": "0 Pa*s"}}, "an oil without viscosity makes no film"),
        ({"speeds": ["0.01 m/s", "0 m/s"]}, "a speed of zero entrains no oil"),
        ({"speeds": {"values": ["0.1 m/s"], "cylinder": -1}}, "entrain no oil"),
        ({"contact": {"loads": ["1 MN"]}}, "half-width"),
        ({"grid": {"shape": [8, 8]}}, "less than the contact's half-width"),
        ({"film": {"start": "-20 um", "end": "20 um"}}, "larger than the film grid"),
    ],
)
def test_bad_input_is_one_message(tables, words):
    with pytest.raises(InputError) as caught:
        plan_scene(scene_with(FRICTION, **tables), [])
    assert len(caught.value.messages) == 1
    assert words in str(caught.value)
    assert "allowed" in str(caught.value)


def test_speeds_may_be_ranges_as_in_sweeps():
    """A text or an entry of the list, in equal ratios or equal steps; what is no range is refused with an example."""
    ratios = pytest.approx([0.005 * 400 ** (i / 7) for i in range(8)], rel=1e-9, abs=0)
    for given in ({"values": "log:5 mm/s:2 m/s:8"}, {"values": ["log:5 mm/s:2 m/s:8"]}, ["log:5 mm/s:2 m/s:8"]):
        assert SpeedsScene.model_validate(given).values == ratios
    steps = {"values": ["1 mm/s", "1 m/s:3 m/s:3"]}
    assert SpeedsScene.model_validate(steps).values == pytest.approx([1e-3, 1, 2, 3])
    with pytest.raises(ValidationError, match=r"count '8x' .*log:0\.1 m/s:1 m/s:8"):
        SpeedsScene.model_validate({"values": "log:5 mm/s:2 m/s:8x"})


def test_film_grid_must_reach_the_inlet():
    scene, _ = plan_scene(scene_with(FRICTION, film={"points": 300, "start": "-26 um", "end": "26 um"}), [])
    with pytest.raises(InputError, match=r"film: the film grid starts at .* where the film already carries"):
        compute(campaign_of(scene))


ARRAY = {
    "kind": "asperities",
    "lower": {"material": "steel-cylinder"},
    "upper": {"material": "steel-cylinder"},
    "array": {
        "radius": "30 um",
        "height": "500 nm",
        "spacings": ["14 um", "28 um", "56 um"],
        "interferences": ["50 nm"],
        "cell": "250 nm",
        "window": "230 um",
    },
}


@pytest.mark.internal
def test_asperities_feel_the_lattice():
    """To first order an asperity rises by 3.9003 P / (pi E* spacing) over the mean plane; Hertz as they part."""
    _, outcome, _ = run(ARRAY)
    modulus = 210e9 / (2 * (1 - 0.3**2))
    hertz = outcome.summary["hertz_load_N"]
    for spacing, share in zip((14e-6, 28e-6, 56e-6), outcome.summary["load_over_hertz"], strict=True):
        inward = 50e-9 + SQUARE_LATTICE * share * hertz / (math.pi * modulus * spacing)
        # Hertz on the cells of 250 nm, a fifth of the contact's radius of 1.2 um: 2 %
        assert share == pytest.approx((inward / 50e-9) ** 1.5, rel=0.03)
    # the grid of twice the cell says what these cells cost: some per cent
    for value, error in zip(outcome.summary["load_over_hertz"], outcome.summary["load_over_hertz_error"], strict=True):
        assert 1e-3 < error / value < 0.2
    assert outcome.variables["asperity_load_error"].units == "N"
    finite = outcome.summary["load_over_hertz_finite_array"]
    assert finite[0] < finite[1] < finite[2] < 1  # neighbours take load from one another, as in the thesis


def test_one_asperity_is_the_whole_array():
    from bem.contact import solve_contact
    from bem.convolution import displacement_operator

    approaches = []
    for copies in (1, 2):
        grid = Grid((40 * copies, 40 * copies), (0.35e-6, 0.35e-6), periodic=(True, True))
        one = Grid((40, 40), (0.35e-6, 0.35e-6), periodic=(True, True))
        gap = np.minimum((one.x[:, None] ** 2 + one.y[None, :] ** 2) / 60e-6, 0.5e-6)
        operator = displacement_operator(grid, Body(CATALOGUE["steel-cylinder"].material))
        solution = solve_contact(np.tile(gap, (copies, copies)), operator, load=0.01 * copies**2)
        approaches.append(solution.approach)
    assert approaches[0] == pytest.approx(approaches[1], rel=1e-7)  # the solver's 1e-8 of the roughness


def test_boundary_lubrication_is_said_and_lambda_ratio_is_one_in_both_kinds():
    """Creeping: both kinds converge with the load met, say that it is boundary, and mean the same by lambda."""
    speeds = {"speeds": ["1e-7 m/s"]}
    _, sharing, said = run(scene_with(FRICTION, film={"points": 200}, **speeds))
    _, cycles, told = run(scene_with(RUNNING_IN, cycles={"count": 1, "averaged": 1, "settled": 1}, **speeds))
    for outcome, context in ((sharing, said), (cycles, told)):
        summary = outcome.summary
        assert outcome.status is Status.CONVERGED
        assert summary["contact_load_N"][0] + summary["film_load_N"][0] == pytest.approx(5.5, rel=5e-4)
        assert summary["friction"][0] == pytest.approx(0.15, rel=1e-3)  # the tolerance's tenth is the film's
        assert any((note.code, note.values.get("reason")) == ("boundary-lubrication", "load") for note in context.notes)
    # the first cycle's surfaces are unworn; both films are solved on 200 nodes
    assert cycles.summary["lambda_ratio"][0] == pytest.approx(sharing.summary["lambda_ratio"][0], rel=1e-6)
    for summary in (sharing.summary, cycles.summary):
        film = summary["lambda_ratio_mixed"][0] * sharing.summary["Sq_nm"]
        assert film == pytest.approx(summary["minimum_film_nm"][0], rel=1e-6)
