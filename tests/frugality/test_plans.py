"""`bem plan` for every kind and every built-in scene: what runs, what is skipped and why; it follows the scene."""

import json
import math

import numpy as np
import pytest

from bem import Body, Grid, Material
from bem.campaigns import campaign_of, compute
from bem.contact import solve_contact
from bem.convolution import DisplacementOperator, displacement_operator
from bem.errors import InputError, Status
from bem.friction import point_film
from bem.runs import plan_scene
from bem.scenes import build, film_plans, library
from bem.scenes.kind import kind_names
from bem.scenes.planner import SEARCHED_IN_SINGLE
from bem.scenes.plans import CONVOLUTION, convolutions, stiffest
from bem.surfaces import generate_surface
from bem.transforms import COUNT
from bem.wear import WearModel, WearSetup, yielded_pieces
from bem.wear.loads import SurfaceLoad

SCENES = sorted(name for name, tables in library().items() if '"kind": "measured"' not in json.dumps(tables))
"""Those that need no file of the user's."""


def test_every_kind_has_a_built_in_scene_and_something_to_skip():
    kinds = {}
    for name in SCENES:
        scene, plan = plan_scene(name)
        kinds.setdefault(scene.kind, []).append(any(step.skipped for step in plan.steps))
    for kind in kind_names():
        if kind in kinds:
            assert any(kinds[kind]), f"no scene of kind {kind} skips anything"


@pytest.mark.internal
def test_the_plan_names_precision_where_the_scene_asks_for_it():
    _, free = plan_scene("hertz-sphere")
    assert free.precisions == {"contact": SEARCHED_IN_SINGLE}
    assert [name for name, _ in free.precision_rows] == ["contact", "all else"]
    _, film = plan_scene("film-ball")
    assert not film.precisions
    assert film.precision_rows == [("all", "double")]


@pytest.mark.internal
@pytest.mark.parametrize("tolerance", [1e-6, 1e-10])
def test_a_search_in_single_precision_costs_a_contact_no_accuracy(tolerance, monkeypatch):
    grid = Grid((64, 64), (1e-7, 1e-7))
    torus = Grid(grid.shape, grid.spacing, periodic=(True, True))
    body = Body(Material("steel", youngs_modulus=210e9, poissons_ratio=0.3))
    height = generate_surface(torus, rms_height=1e-7, correlation_length=1e-6, seed=3)

    def solved():
        operator = displacement_operator(grid, (body, body))
        return solve_contact(height.max() - height, operator, load=5e8 * grid.area, tolerance=tolerance)

    single, kinds, scaled = solved(), [], DisplacementOperator.scaled

    def in_double(self, dtype=np.float64, **choices):
        kinds.append(dtype)
        return scaled(self, np.float64, **choices)

    monkeypatch.setattr(DisplacementOperator, "scaled", in_double)
    double = solved()
    assert np.float32 in kinds
    assert single.status == double.status == Status.CONVERGED
    assert single.convolutions <= 1.1 * double.convolutions
    # both are within the tolerance of the answer; they lie much nearer to each other
    assert np.abs(single.pressure - double.pressure).max() <= 0.1 * tolerance * double.pressure.max()


def skipped(source, *settings):
    _, plan = plan_scene(source, settings)
    return {step.name: step.skipped for step in plan.steps}


def test_a_contact_plan_follows_what_is_asked_for():
    everything = skipped("rough-contact")
    assert not everything["stresses below"]
    assert not everything["traction kernels"]
    assert everything["layered kernels"]
    less = skipped("rough-contact", "outputs.von_mises=false", "outputs.stresses=false", "outputs.vtk=false")
    assert less["stresses below"]
    assert skipped("rough-contact", "contact.friction=0")["traction kernels"]
    assert not skipped("coated-sphere")["layered kernels"]


def test_time_and_memory_of_a_plan_grow_with_the_grid():
    _, small = plan_scene("hertz-sphere", ["grid.shape=128"])
    _, large = plan_scene("hertz-sphere", ["grid.shape=1024"])
    # 1.5 GB and 0.65 GB, of which 0.6 GB are libraries; the larger grid's components of stress lie on disk: 1.2 GB of
    # memory and 1.6 GB of mapped files are measured
    assert large.memory > 2 * small.memory
    assert large.seconds(2e9) > small.seconds(2e9)


@pytest.mark.internal
@pytest.mark.parametrize("name", ["rough-contact", "hertz-sphere", "sinusoid", "coated-sphere"])
def test_convolutions_of_a_contact_are_as_many_as_planned_within_a_factor_of_two(name):
    scene, _ = plan_scene(name, ["grid.shape=128", "outputs.von_mises=false", "outputs.stresses=false"])
    outcome = compute(campaign_of(scene)).outcome
    planned = convolutions(build.grid_of(scene.grid), scene.contact.behaviour == "capped")
    assert planned / 2 <= outcome.summary["convolutions"] <= 2 * planned


@pytest.mark.internal
@pytest.mark.parametrize("pressure", ["20 MPa", "100 MPa", "1 GPa"])
def test_a_layer_stiffer_than_its_base_takes_what_is_planned_within_a_factor_of_two(pressure):
    """The plan knew of no layer: 15 convolutions where up to 44 were counted under one ten times as stiff."""
    settings = ["grid.shape=256", "outputs.von_mises=false", "outputs.errors=false", "contact.behaviour=elastic"]
    settings += ["lower.surface.skewness=0", "lower.surface.kurtosis=3"]  # which take long to make
    settings += ['lower.layer.material="dlc"', 'lower.layer.thickness="0.5 um"', f'contact.mean_pressure="{pressure}"']
    settings += ['lower.material.name="base"', 'lower.material.youngs_modulus="20 GPa"']
    scene, plan = plan_scene("rough-contact", [*settings, "lower.material.poissons_ratio=0.35"])
    over = stiffest(scene.lower.build(), scene.upper.build())
    assert over == pytest.approx(10.0)
    planned = convolutions(build.grid_of(scene.grid), stiffness=over)
    (step,) = [step for step in plan.steps if step.name == "contact"]
    assert step.transforms == CONVOLUTION * planned
    found = compute(campaign_of(scene)).outcome.summary["convolutions"]
    assert planned / 2 <= found <= 2 * planned


@pytest.mark.internal
def test_a_capped_contact_of_many_cells_takes_what_is_planned_within_a_factor_of_two():
    """The plan had no more convolutions for it than for an elastic one, and 36 where 179 were counted at 8192 cells."""
    settings = ["grid.shape=1024", "outputs.von_mises=false", "outputs.errors=false"]
    settings += ["lower.surface.skewness=0", "lower.surface.kurtosis=3"]  # which take long to make
    scene, _ = plan_scene("rough-contact", settings)
    found = compute(campaign_of(scene)).outcome.summary["convolutions"]
    planned = convolutions(build.grid_of(scene.grid), capped=True)
    assert planned > 1.4 * convolutions(build.grid_of(scene.grid))
    assert planned / 2 <= found <= 2 * planned


SMALL = {
    "wear-steel-steel": [
        "repetitions=1",
        'cylinder.loads=["2.5 N"]',
        "domain.cells=120",
        "cycles.count=6",
        "cycles.settled=3",
    ],
    "stribeck-mineral-oil": [
        "repetitions=1",
        'sharing.models=["capped"]',
        "speeds.count=4",
        "grid.shape=100",
        "grid.spacing=0.9 um",
    ],
}


@pytest.mark.slow
@pytest.mark.parametrize("name", SMALL)
def test_transforms_of_a_run_are_as_many_as_planned_within_a_factor_of_two(name):
    scene, plan = plan_scene(name, SMALL[name])
    # surfaces are generated by transforms of their own, which are not counted
    planned = sum(step.transforms for step in plan.steps if not step.skipped and step.name != "surfaces")
    COUNT.reset()
    compute(campaign_of(scene))
    assert planned / 2 <= COUNT.forward + COUNT.inverse <= 2 * planned


@pytest.mark.internal
@pytest.mark.parametrize(
    ("name", "settings", "words"),
    [
        ("rough-contact", ["lower.surface.skewness=2", "lower.surface.kurtosis=4.5"], "no distribution has"),
        ("rough-contact", ["lower.surface.cutoff_wavelength=1 nm"], "below two cells"),
        ("running-in-stribeck", ["lower.surface.correlation_length=1 mm"], "half the grid"),
        ("wear-steel-steel", ["upper.surface.cutoff_wavelength=60 nm"], "below two cells"),
        # kind wear has no table [grid]
        (
            "wear-steel-steel",
            ['lower.surface={kind = "generated", rms_height = "0.1 um", correlation_length = "1 mm"}'],
            r"raise domain\.[a-z_]+(| or the load), or shorten lower\.surface\.correlation_length",
        ),
        ("stribeck-mineral-oil", ["lower.surface.cutoff_wavelength=0.5 um"], "below two cells"),
        ("running-in-stribeck", ["lower.surface.cutoff_wavelength=1 nm"], "below two cells"),
        ("tribofilm-macro", ["upper.surface.cutoff_wavelength=1 nm"], "below two cells"),
    ],
)
def test_a_plan_refuses_surfaces_that_cannot_be_generated(monkeypatch, name, settings, words):
    def forbidden(*arguments, **keywords):
        raise AssertionError("heights were made")

    plan_scene(name)  # the scene as it is can be had: the check can fail
    monkeypatch.setattr("bem.surfaces.generate.impose_moments", forbidden)
    with pytest.raises(InputError, match=words) as caught:
        plan_scene(name, settings)
    body = settings[0].split(".")[0]
    assert any(body in message for message in caught.value.messages)
    assert len(caught.value.messages) == len(set(caught.value.messages))


def test_a_plan_counts_the_process_itself_and_its_start():
    from bem.scenes.planner import Plan, Step

    nothing = Plan(())
    assert nothing.memory > 1e8  # the interpreter, numpy and compiled loops: 120 MiB measured
    assert nothing.seconds(1e9) > 0.5
    one = Plan(
        (Step("a", "b", memory=3e8, kept=1e8, seconds=2), Step("c", "d", memory=2.5e8, transforms=10, points=1e6))
    )
    assert one.memory == nothing.memory + 3.5e8
    assert one.seconds(5e8) - nothing.seconds(5e8) == pytest.approx(2 + 10 * 2.5e6 * math.log2(1e6) / 5e8)


def test_kernels_of_a_wear_scene_are_planned_once_for_a_grid_not_for_a_cycle():
    def seconds(*settings):
        _, plan = plan_scene("wear-steel-steel", ['cylinder.loads=["10 N"]', *settings])
        return {step.name: step.seconds for step in plan.steps}

    few, many = seconds("cycles.count=60"), seconds("cycles.count=240")
    assert many["stresses"] == few["stresses"] > 0
    assert many["pieces"] == pytest.approx(4 * few["pieces"])


@pytest.mark.internal
@pytest.mark.parametrize(
    "choice",
    [
        {},
        {"criterion": "tresca"},
        {"criterion": "maximum_tension"},
        {"traction": {"kind": "oscillating_force", "share": 0.5}},
        {"traction": {"kind": "oscillating_force", "share": 0.5}, "criterion": "tresca"},
        {"stress_range": True},
    ],
)
def test_stresses_of_a_wear_cycle_take_as_many_transforms_as_are_planned(choice):
    """Seven were planned for each depth, whatever the criterion, the tractions and the loads."""
    from bem.scenes.tables.wear_model import WearScenePart
    from bem.scenes.wearing import stress_transforms

    grid = Grid((48, 40), (1e-7, 1e-7), periodic=(False, True))
    solid = Body(Material("steel", youngs_modulus=210e9, poissons_ratio=0.3, hardness=1.8e9))
    setup = WearSetup(grid, (solid, solid), np.zeros(grid.shape), 1.0, 0.2, np.arange(12) * 1e-7)
    pressure, model = np.zeros(grid.shape), WearModel(**choice)
    pressure[20:30, 14:24] = 1.7e9
    loads = [
        SurfaceLoad(pressure, 0.2, None if model.traction_law.slides else np.stack([0.2 * pressure, 0.1 * pressure]))
    ]
    if model.stress_range:
        loads.append(SurfaceLoad(0.5 * pressure, 0.2))
    COUNT.reset()
    found = yielded_pieces(loads, setup, model, 0)
    assert found.depths_computed > 2
    table = WearScenePart.model_validate(choice)
    planned, counted = stress_transforms(table, found.depths_computed), COUNT.forward + COUNT.inverse
    # a depth to which only a deeper one led is gone through twice
    assert counted == planned or (model == WearModel() and counted == planned + 5)


def test_depths_of_a_wear_scene_are_planned_within_a_factor_of_two_and_of_both_bodies_where_both_wear():
    scene, plan = plan_scene("wear-steel-steel", SMALL["wear-steel-steel"])
    (step,) = (step for step in plan.steps if step.name == "stresses")
    depths = compute(campaign_of(scene)).outcome.variables["depths_computed"].values
    counted = 5 * depths.sum() + depths.size
    assert counted / 2 <= step.transforms <= 2 * counted
    _, both = plan_scene("wear-steel-steel", [*SMALL["wear-steel-steel"], "wear.wears=both"])
    assert [s.transforms for s in both.steps if s.name == "stresses"] == [2 * step.transforms]


@pytest.mark.internal
def test_depths_of_the_first_cycle_are_within_what_memory_is_planned_for():
    """The memory of a plan holds spectra of so many depths; the first cycle, of the sharpest asperities, needs most."""
    from bem.kinds.wear.plan import _DEPTHS_AT_FIRST

    settings = ["repetitions=1", "cycles.count=1", "cycles.settled=1", 'cylinder.loads=["10 N"]']
    scene, _ = plan_scene("wear-steel-steel", settings)
    outcome = compute(campaign_of(scene)).outcome
    computed = float(outcome.variables["depths_computed"].values.max())
    assert _DEPTHS_AT_FIRST / 2 <= computed <= 1.25 * _DEPTHS_AT_FIRST


@pytest.mark.internal
def test_very_large_transforms_are_slower_than_the_rate_of_smaller_ones():
    from bem.scenes.planner import Step, step_seconds

    small, large, huge = (
        step_seconds(Step("a", "b", transforms=1, points=float(n * n)), 1e9) for n in (2048, 4096, 8192)
    )
    # to 4096 x 4096 points N log N; four times the points beyond it cost the root of four more
    assert large / small == pytest.approx(4 * 24 / 22, rel=1e-12)
    assert huge / large == pytest.approx(4 * 26 / 24 * 2, rel=1e-12)


def test_cycles_on_small_grids_cost_more_than_their_transforms():
    """20,000 cycles of 300 x 2 cells took 29 s where 4 s were planned."""

    def seconds(count):
        return plan_scene("wear-cylinder-scar", [f"cycles.count={count}"])[1].seconds(1e10)

    assert 15 < seconds(20_000) - seconds(200) < 60
    # tables that grow are copied in every cycle
    assert seconds(200_000) - seconds(200) > 15 * (seconds(20_000) - seconds(200))


@pytest.mark.parametrize("name", ["running-in-ball", "running-in-life"])
def test_heat_of_lubricated_wear_is_planned(name):
    """Of the films of the table and of each contact."""

    def steps(thermal):
        oil = ['oil={grade="ISO VG 68", temperature="60 degC"}', f"thermal={thermal}"]
        return {step.name: step for step in plan_scene(name, oil)[1].steps}

    warm, cold = steps("lumped"), steps("off")
    assert cold["heat of contacts"].skipped
    assert warm["heat of contacts"].seconds > 0
    assert warm["film tables"].seconds > 1.2 * cold["film tables"].seconds


def ball_in_oil(thermal, speed, load):
    surface = {"kind": "generated", "rms_height": "300 nm" if speed > 1 else "100 nm", "correlation_length": "20 um"}
    return {
        "kind": "friction",
        "name": "ball",
        "thermal": thermal,
        "lower": {"material": "steel-52100", "surface": surface},
        "upper": {"material": "steel-52100"},
        "contact": {"radii": ["10 mm", "10 mm"], "loads": [load], "boundary_friction": 0.12},
        "oil": {"grade": "ISO VG 46", "temperature": "80 degC"},
        "speeds": {"values": [speed], "slide_roll_ratio": 0.1},
        "grid": {"shape": [64, 64], "lengths": ["0.9 mm", "0.9 mm"], "periodic": [False, False]},
        "film": {"cells": 72},
        "sharing": {"oil_volume": "loaded"},
        "outputs": {"errors": False},
    }


@pytest.mark.parametrize(
    ("thermal", "speed", "load", "extrapolated"),
    [("lumped", 4.0, 100, False), ("lumped", 0.4, 100, False), ("off", 0.4, 100, False), ("off", 0.4, 1000, True)],
)
def test_films_of_a_ball_are_counted_as_its_balance_solves_them(monkeypatch, thermal, speed, load, extrapolated):
    """Five cheap films were planned at each speed, where heat gives each load a film of its own."""
    solve, solved = point_film._solved, []

    def counted(contact, speeds, load, cells):
        solved.append(cells)
        return solve(contact, speeds, load, cells)

    monkeypatch.setattr(point_film, "_solved", counted)
    point_film.KEPT.clear()
    scene, plan = plan_scene(ball_in_oil(thermal, speed, load))
    compute(campaign_of(scene))
    numbers = film_plans.BallFilms(72, extrapolated, thermal == "lumped", speed == 4.0, 1.0).numbers
    assert f"about {sum(numbers)} " in next(step.why for step in plan.steps if step.name == "films")
    found = solved.count(64), solved.count(72)
    assert sum(found) == len(solved)
    assert all(planned / 1.5 <= count <= 1.5 * planned for planned, count in zip(numbers, found, strict=True)), found


@pytest.mark.internal
def test_films_of_a_ball_cost_more_where_viscosity_hardly_rises():
    """At 0.27 m/s a bearing's films of 96 cells take 2 s each, at 4.8 m/s 0.13 s."""
    slow, fast = (film_plans.BallFilms(96, True, True, True, material).seconds for material in (0.2, 2.0))
    assert slow == pytest.approx(10 * fast)
