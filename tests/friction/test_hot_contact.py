"""Heat in mixed friction: film and contact temperatures from what is returned, the law that they tell, limits."""

import math
from dataclasses import replace

import numpy as np
import pytest
from mixed_case import mixed_case
from small_scenes import PATCH

from bem import (
    Body,
    Grid,
    InputError,
    Lubricant,
    Material,
    Status,
    generate_surface,
    load_scene,
    solve_line_film,
    solve_mixed,
    stribeck_curve,
)
from bem.accuracy import MixedCase, mixed_bars, solve_coarser_mixed
from bem.friction import line_film
from bem.friction.balance import Regime
from bem.friction.boundary import filled_part
from bem.friction.setup import MixedSetup
from bem.friction.solve import solve_setup
from bem.heat.steady import surface_temperature
from bem.lubrication.line import case as line_case
from bem.lubrication.thermal import lumped
from bem.notes import has_code
from bem.notes.friction import FILM_MODEL_ENDS, OIL_COUNTED
from bem.notes.lubrication import HEAT_NOT_FOUND
from bem.runs import run_scene

ELASTIC = {"youngs_modulus": 210e9, "poissons_ratio": 0.3}
STEEL = Body(Material("steel", **ELASTIC, thermal_conductivity=46.0, density=7800.0, heat_capacity=470.0))
OIL = Lubricant.of(
    "ISO VG 68", temperature=333.15, shear_law="eyring", shear_stress_limit=5e6, density_law="incompressible"
)
FALLING = {"kind": "table_over_temperature", "temperatures": [300.0, 500.0], "coefficients": [0.2, 0.02]}
CASE = mixed_case(64, 0.8e-6, 3e-6, lubricant=OIL, boundary_friction=0.1, bodies=(STEEL, STEEL), film_points=250)
ROLLING = (0.8, 0.2)


def hot(**changes):
    return solve_mixed(**CASE | {"thermal": "lumped", "speeds": ROLLING} | changes)


def conducted(found, coefficient):
    """Temperatures of what rubs in a solution, and their mean by pressure in contact.

    The oil's heat is that of the stress in the middle of the film, on the film's mesh.
    """
    pressure, slide = found.contact_pressure, abs(found.speeds[0] - found.speeds[1])
    stress = np.where(found.film.pressure > 0, np.abs(found.film.sliding_stress), 0.0)
    sheared = np.interp(found.grid.x, found.film.position, stress)[:, None]
    filled = filled_part(pressure, found.contact.contact_area, found.grid)
    heat = slide * (coefficient * pressure + np.where(pressure > 0, 1 - filled, 1.0) * sheared)
    field = surface_temperature(
        heat, found.grid, (STEEL, STEEL), speeds=found.speeds, bulk=(333.15, 333.15), tolerance=1e-7
    ).temperature
    return field, float((field * pressure).sum() / pressure.sum())


@pytest.mark.internal
def test_temperatures_are_those_of_what_rubs():
    found = hot()
    assert found.status is Status.CONVERGED
    assert found.regime is Regime.MIXED
    field, mean = conducted(found, 0.1)
    assert found.contact_temperature - 333.15 == pytest.approx(mean - 333.15, rel=1e-5)
    highest = field[found.contact_pressure > 0].max()
    assert found.flash_temperature - 333.15 == pytest.approx(highest - 333.15, rel=1e-5)
    assert 333.15 < found.contact_temperature < found.flash_temperature


def test_a_law_over_temperature_is_told_that_of_the_contact():
    """A hundredth of the conductivity makes the surfaces hot: the coefficient falls, and less heat is made for it."""
    poor = Body(Material("poor", **ELASTIC, thermal_conductivity=0.46, density=7800.0, heat_capacity=470.0))
    found = hot(boundary_friction=FALLING, bodies=(poor, poor))
    coefficient = found.boundary_force / found.contact_load
    expected = np.interp(found.contact_temperature, FALLING["temperatures"], FALLING["coefficients"])
    assert coefficient == pytest.approx(expected, rel=1e-5)
    assert found.contact_temperature > 333.15 + 10
    oil = np.interp(333.15, FALLING["temperatures"], FALLING["coefficients"])
    assert coefficient < 0.95 * oil
    # shear stress over the contact is that force
    stress = found.boundary_shear_stress.sum() * found.grid.cell_area * 6e-3 / found.grid.lengths[1]
    assert stress == pytest.approx(found.boundary_force, rel=1e-6)
    assert solve_mixed(**CASE | {"boundary_friction": FALLING}, speeds=ROLLING).boundary_force > found.boundary_force


@pytest.mark.parametrize("cells", [32, 64])
def test_oil_heats_the_contact_by_the_stress_of_the_films_own_mesh(cells):
    """On a patch of few cells the pressure gradient on the patch differs from that on the film's mesh."""
    case = mixed_case(cells, 0.8e-6 * 64 / cells, 6e-6, lubricant=OIL, boundary_friction=0.0, bodies=(STEEL, STEEL))
    found = hot(**case | {"film_points": 250})
    assert found.regime is Regime.MIXED
    _, mean = conducted(found, 0.0)
    assert found.contact_temperature - 333.15 == pytest.approx(mean - 333.15, rel=1e-5)


def test_a_law_of_the_pressure_heats_each_cell_by_its_own_stress():
    law = {"kind": "pressure_dependent", "shear_strength": 50e6, "pressure_coefficient": 0.02}
    found = hot(boundary_friction=law)
    pressure, slide = found.contact_pressure, abs(found.speeds[0] - found.speeds[1])
    stress = np.where(found.film.pressure > 0, np.abs(found.film.sliding_stress), 0.0)
    sheared = np.interp(found.grid.x, found.film.position, stress)[:, None]
    filled = filled_part(pressure, found.contact.contact_area, found.grid)
    heat = slide * (np.abs(found.boundary_shear_stress) + np.where(pressure > 0, 1 - filled, 1.0) * sheared)
    field = surface_temperature(
        heat, found.grid, (STEEL, STEEL), speeds=found.speeds, bulk=(333.15, 333.15), tolerance=1e-7
    ).temperature
    assert found.flash_temperature - 333.15 == pytest.approx(field[pressure > 0].max() - 333.15, rel=1e-5)


@pytest.mark.parametrize("softening", [-0.1, -0.05])
def test_heat_of_a_law_that_rises_may_run_away(softening):
    """No coefficient reproduces itself: it is said, and raises nothing."""
    poor = Body(Material("poor", **ELASTIC, thermal_conductivity=0.46, density=7800.0, heat_capacity=470.0))
    law = {"kind": "temperature_dependent", "friction": 0.2, "softening": softening, "reference_temperature": 333.15}
    found = hot(boundary_friction=law, bodies=(poor, poor))
    assert found.status is Status.STALLED
    assert has_code(found.notes, HEAT_NOT_FOUND, reason="boundary")
    assert math.isnan(found.friction)
    assert math.isnan(found.contact_temperature)


def test_a_hot_film_is_returned_at_the_positions_asked_for():
    own = hot().film
    n = len(own.position)
    position = np.append(own.position, [3e-5, 5e-5])  # beyond the exit, to cover the patch
    found = hot(film_position=position).film
    np.testing.assert_allclose(found.sliding_stress[:n], own.sliding_stress, rtol=1e-9)
    np.testing.assert_allclose(found.shear_stress()[: n - 1], own.shear_stress()[: n - 1], rtol=1e-9)
    assert not found.shear_stress()[n:].any()
    position = np.linspace(-0.3e-3, 0.8e-3, 3000)
    shorter = hot(film_position=position).film
    assert shorter.shear_stress().shape == position.shape
    cold = solve_mixed(**CASE, speeds=ROLLING, film_position=position).film
    assert shorter.inlet_load_fraction == pytest.approx(cold.inlet_load_fraction, rel=0.1)
    assert shorter.inlet_load_fraction > 1.5 * found.inlet_load_fraction > 0
    with pytest.raises(InputError, match="start at"):
        hot(film_position=np.linspace(-2.6e-5, 1e-3, 100))


@pytest.mark.internal
@pytest.mark.parametrize(("model", "left"), [("lumped", 0.9), ("full", 0.96)])  # full heat takes 4.7 %
def test_the_film_is_the_one_with_heat(model, left):
    found = hot(speeds=(12.0, 6.0), thermal=model)
    assert found.regime is Regime.FULL_FILM
    assert found.contact_temperature is None
    film = solve_line_film(
        load=5.5 / 6e-3, radius=2e-3, contact_modulus=210e9 / (2 * 0.91), speeds=(12.0, 6.0), lubricant=OIL,
        bodies=(STEEL, STEEL), thermal=model, points=250,
    )  # fmt: skip
    assert found.friction == pytest.approx(film.shear_force / film.load, rel=1e-9)
    assert found.film.mean_temperature == pytest.approx(film.mean_temperature, abs=1e-6)
    cold = solve_mixed(**CASE, speeds=(12.0, 6.0))
    assert found.minimum_film < left * cold.minimum_film
    assert found.friction < cold.friction


def test_stresses_of_a_hot_film_make_its_force():
    film = hot(speeds=(12.0, 6.0)).film
    inside = film.pressure > 0
    total = np.trapezoid(np.where(inside, film.shear_stress(), 0.0), film.position)
    # before the mesh 2 R mu/x (u1 - u2) and three times that of the sum of speeds are not in it: some 3 % at 12 m/s
    assert total == pytest.approx(film.shear_force, rel=0.04)
    assert total < film.shear_force


@pytest.mark.parametrize("speed", [1e-6, 1e-3])
def test_creeping_is_isothermal(speed):
    slow, cold = hot(speeds=(speed, 0.0)), solve_mixed(**CASE, speeds=(speed, 0.0))
    assert slow.status is cold.status is Status.CONVERGED
    assert slow.friction == pytest.approx(cold.friction, rel=1e-3)
    assert slow.contact_temperature == pytest.approx(333.15, abs=0.05)


def test_a_curve_with_heat_costs_little_more():
    """Balances with heat need about as many films and contacts; the law's temperature is found without any."""
    speeds = [(0.1, 0.0), (0.5, 0.0), (1.0, 0.0)]
    cold = stribeck_curve(speeds, **CASE)
    warm = stribeck_curve(speeds, **CASE | {"boundary_friction": FALLING, "thermal": "lumped"})
    assert {one.status for one in warm} == {Status.CONVERGED}
    assert sum(one.contact_solves for one in warm) <= sum(one.contact_solves for one in cold) + 3
    temperatures = [one.contact_temperature for one in warm]
    assert temperatures == sorted(temperatures)


@pytest.mark.internal
def test_a_speed_at_which_inlet_heating_leaves_no_film_fails_alone(monkeypatch):
    """A polymer at a third of the largest M with the oil as supplied, and beyond it with what 500 m/s leave of the oil,
    were the largest M 1.5e4."""
    for module in (line_case, line_film):
        monkeypatch.setattr(module, "MOES_LOADS", (1e-5, 1.5e4))
    thin, radius, modulus = Lubricant.of("ISO VG 10", temperature=373.15, density_law="incompressible"), 10e-3, 1e9
    heat = {"thermal_conductivity": 0.3, "density": 1100.0, "heat_capacity": 1500.0}
    polymer = Body(Material("polymer", youngs_modulus=1.68e9, poissons_ratio=0.4, **heat))
    heavy = 5000 * math.sqrt(2 * modulus * radius * thin.viscosity * 100)
    spacing = 3 * math.sqrt(4 * heavy * radius / math.pi / modulus) / 32
    grid = Grid((32, 16), (spacing, spacing), periodic=(False, True))
    case = {
        "height": generate_surface(grid, rms_height=1e-6, seed=1, correlation_length=4 * spacing),
        "grid": grid,
        "bodies": (polymer, polymer),
        "radius": radius,
        "width": 1e-3,
        "load": heavy * 1e-3,
        "lubricant": thin,
        "boundary_friction": 0.1,
        "film_points": 200,
        "thermal": "lumped",
        "tolerance": 1e-3,
        "contact_tolerance": 1e-4,
        "oil_volume": "patch",
    }
    slow, fast = (75.0, 25.0), (750.0, 250.0)
    first, hottest, again = stribeck_curve([slow, fast, slow], **case)
    assert (first.status, hottest.status, again.status) == (Status.CONVERGED, Status.INFEASIBLE, Status.CONVERGED)
    assert has_code(hottest.notes, FILM_MODEL_ENDS, reason="balance")
    assert hottest.film_load < case["load"]
    assert first.friction == solve_mixed(**case, speeds=slow).friction
    assert again.film_load == pytest.approx(first.film_load, rel=1e-3)  # the balance's own tolerance
    assert again.minimum_film == pytest.approx(first.minimum_film, rel=5e-3)


def test_speeds_that_entrain_nothing_are_refused_before_any_work(monkeypatch):
    monkeypatch.setattr("bem.friction.solve.solve_setup", lambda *_: pytest.fail("a speed was solved"))
    with pytest.raises(InputError, match="entrain no oil"):
        stribeck_curve([ROLLING, (1.0, -1.0)], **CASE)


@pytest.mark.internal
def test_full_heat_in_mixed_lubrication():
    """Mild heat is that of the lumped model; the film that is returned is the full one under its own load, whose energy
    closes, and film and contact carry the load together."""
    full, lumped, cold = hot(thermal="full"), hot(), solve_mixed(**CASE, speeds=ROLLING)
    assert {full.status, lumped.status} == {Status.CONVERGED}
    assert full.regime is Regime.MIXED
    assert full.film.heat.energy_imbalance < 1e-6
    assert full.film.load * 6e-3 + full.contact_load == pytest.approx(5.5, rel=1e-4)  # the balance's own
    # the lumped model's inlet factor takes 0.25 % of this film, full heat 0.03 %
    assert full.film.mean_temperature - 333.15 == pytest.approx(lumped.film.mean_temperature - 333.15, rel=0.2)
    assert cold.minimum_film > full.minimum_film > lumped.minimum_film
    assert full.contact_temperature - 333.15 == pytest.approx(lumped.contact_temperature - 333.15, rel=0.02)


def test_heat_of_a_starved_contact():
    """More surfaces touch and more heat is made; plenty of oil is the flooded one."""
    flooded, plenty, starved = (hot(supply=supply) for supply in (None, 1e-3, 1e-7))
    assert {flooded.status, plenty.status, starved.status} == {Status.CONVERGED}
    # each film lays its 250 points from a start of its own, 0.03 mm apart at the inlet: 1.3e-6, where twice the points
    # change friction by 7e-4
    assert plenty.friction == pytest.approx(flooded.friction, rel=1e-5)
    assert starved.film.starvation.reduction < 0.5
    assert starved.contact_load > flooded.contact_load
    assert starved.contact_temperature > flooded.contact_temperature


def without_temperatures(monkeypatch):
    """Let the energy equation of every film end without a solution."""
    solve = lumped.film_temperatures
    monkeypatch.setattr(lumped, "film_temperatures", lambda *given: replace(solve(*given), residual=1.0))


def test_heat_that_is_not_found_stalls_and_says_so(monkeypatch):
    without_temperatures(monkeypatch)
    (found,) = stribeck_curve([ROLLING], **CASE | {"thermal": "lumped", "boundary_friction": FALLING})
    assert found.status is Status.STALLED
    assert has_code(found.notes, HEAT_NOT_FOUND, reason="lumped")
    assert found.regime is Regime.MIXED
    assert math.isnan(found.friction)
    assert math.isnan(found.contact_temperature)
    assert math.isnan(found.flash_temperature)


@pytest.mark.parametrize("oil_volume", ["loaded", "patch"])
def test_unknown_friction_does_not_depend_on_the_volume_of_oil(oil_volume, monkeypatch):
    without_temperatures(monkeypatch)
    found = hot(speeds=(12.0, 6.0), oil_volume=oil_volume)
    assert found.regime is Regime.FULL_FILM
    assert math.isnan(found.friction)
    assert not found.oil.matters
    assert not has_code(found.notes, OIL_COUNTED)


def test_what_heat_needs_is_said():
    bare = Body(Material("bare", **ELASTIC))
    for changes, words in (
        ({"lubricant": Lubricant(0.03, density_law="incompressible")}, "the lubricant lacks temperature, density"),
        ({"bodies": (bare, STEEL)}, "needs thermal_conductivity"),
        ({"bodies": STEEL}, "heat enters both bodies; give a pair"),
        ({"thermal": "warm"}, "'warm' is unknown; choose from off, lumped, full"),
        ({"thermal": "full", "supply": 1e-7}, 'supply: not there with thermal "full"'),
        (
            {"grid": Grid((64, 64), (0.8e-6, 0.8e-6), periodic=(True, True)), "separation": "film"},
            "thermal: on a grid periodic along x",
        ),
    ):
        with pytest.raises(InputError, match=words):
            hot(**changes)


def test_a_scene_with_heat_reports_its_temperatures(tmp_path):
    scene = {
        "kind": "friction",
        "speeds": ["0.1 m/s", "1 m/s"],
        "film": {"points": 200},
        "thermal": "lumped",
        **PATCH,
        "lower": {"material": "steel-52100", "surface": PATCH["lower"]["surface"]},
        "upper": {"material": "steel-52100"},
        "oil": {"grade": "ISO VG 68", "temperature": "60 degC"},
    }
    scene["contact"] = PATCH["contact"] | {"hardness": "6 GPa"}
    found = run_scene(scene, tmp_path / "run", figures=False).summary
    assert found["status"] == "converged"
    means, highest = found["contact_temperature_C"], found["flash_temperature_C"]
    assert 60 < means[0] < means[1] < highest[1] < 80
    assert all(oil > 60 for oil in found["oil_temperature_C"])
    full = run_scene(scene | {"thermal": "full"}, tmp_path / "full", figures=False).summary
    assert full["status"] == "converged"
    assert all(error > 0 for error in full["minimum_film_nm_error"])
    np.testing.assert_allclose(full["contact_temperature_C"], means, atol=0.05 * (means[1] - 60))
    with pytest.raises(InputError, match=r"a supply of oil with thermal = \"full\""):
        load_scene(scene | {"thermal": "full", "supply": {"layer": "100 nm"}})
    with pytest.raises(InputError, match=r"thermal = \"lumped\" on a grid periodic along x"):
        load_scene(scene | {"grid": PATCH["grid"] | {"periodic": [True, True]}, "sharing": {"separation": "film"}})
    off = run_scene(scene | {"thermal": "off"}, tmp_path / "off", figures=False).summary
    assert not [key for key in off if "temperature" in key]
    with pytest.raises(InputError, match="heat of an oil without temperature"):
        load_scene(scene | {"oil": PATCH["oil"]})


@pytest.mark.internal
def test_bars_of_full_heat_hold_its_columns_and_layers():
    """Half the points alone gave a film at 20 m/s a bar of 1e-5, where half the columns and layers move it by 1.3 %."""
    asked = CASE | {"bodies": (STEEL, STEEL), "thermal": "full"}
    height = asked.pop("height")
    setup = MixedSetup(**asked)
    speeds = (20.0, 10.0)
    finer = solve_setup(replace(setup, heat_mesh=3.0, film_points=500), height, speeds)
    found = solve_setup(setup, height, speeds)
    assert {found.status, finer.status} == {Status.CONVERGED}
    case = MixedCase(setup, height, found)
    bars = mixed_bars(case, solve_coarser_mixed(case)).parts["film points"]
    of_film = abs(found.minimum_film - finer.minimum_film)
    assert 1e-3 * found.minimum_film < of_film < bars["minimum_film"] < 0.1 * found.minimum_film
    assert abs(found.film_force - finer.film_force) / found.load < bars["film_part"]
