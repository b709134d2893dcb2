"""Load sharing of heights that the film has flattened: the waves themselves, rough films solved directly, limits."""

from dataclasses import replace

import numpy as np
import pytest
from mixed_case import BALL, rough_patch

from bem import Body, Grid, InputError, Layer, Lubricant, solve_line_film
from bem.friction.flattened import solve_flattened
from bem.friction.setup import MixedSetup
from bem.friction.solve import solve_setup
from bem.lubrication.waves.flattening import flatten_heights
from bem.lubrication.waves.plateau import wave_amplitudes
from bem.lubrication.waves.ripples import plateau_of
from bem.notes import has_code
from bem.notes.friction import FLATTENED_TOO_HIGH
from bem.reference_solutions.hertz import cylinder_contact
from reports.experiments import kept, touching_films
from reports.experiments.rough_films import BOUNDARY, OIL, STEEL

SETUP = MixedSetup(**BALL)
SMOOTH = np.zeros(BALL["grid"].shape)
ROUGH = rough_patch(100e-9, BALL["grid"])


@pytest.fixture(scope="module")
def line():
    """Return a line film at 1 GPa with its contact, and a grid around it, free along x."""
    modulus, radius = 1.15e11, 0.01
    load = np.pi * radius * 1e9**2 / modulus
    hertz = cylinder_contact(radius=radius, contact_modulus=modulus, load=load)
    oil = Lubricant(0.04, pressure_viscosity=20e-9)
    film = solve_line_film(
        load=load, radius=radius, contact_modulus=modulus, speeds=(0.0, 2.0), lubricant=oil, points=300
    )
    grid = Grid((240, 4), (4 * hertz.half_width / 240, 1e-5), periodic=(False, True))
    return film, hertz, grid


def test_a_ridge_at_rest_keeps_the_amplitude_of_its_wave(line):
    """Ridges across the flow: -d of the particular wave in the contact, their own height outside."""
    film, hertz, grid = line
    number = 2 * np.pi * 5 / grid.lengths[0]
    heights = 1e-8 * np.cos(number * grid.x)[:, None] + np.zeros(grid.shape)
    found = flatten_heights(film, hertz, (heights, None), grid)
    wave = wave_amplitudes(plateau_of(film, hertz), np.array([number]), np.zeros(1), 0.0).particular_film[0]
    inner, outer = np.abs(grid.x) < 0.3 * hertz.half_width, np.abs(grid.x) > 1.05 * hertz.half_width
    expected = 1e-8 * np.real(-wave * np.exp(1j * number * grid.x))[:, None]
    # stiff oil leaves 6 % of it; the inlet raises or lowers all of the film, and the continued patch is no pure wave
    assert 0.01 < abs(wave) < 0.1
    missed = (found.heights - expected)[inner]
    assert np.abs(missed - missed.mean()).max() < 0.1 * abs(wave) * 1e-8
    assert found.heights[outer] == pytest.approx((heights - heights.mean())[outer], rel=1e-9, abs=1e-20)


def test_rolling_without_sliding_flattens_less(line):
    film, hertz, grid = line
    heights = 1e-8 * np.cos(2 * np.pi * 20 * grid.x / grid.lengths[0])[:, None] + np.zeros(grid.shape)
    rolling = flatten_heights(replace(film, speeds=(1.0, 1.0)), hertz, (heights, None), grid)
    at_rest = flatten_heights(film, hertz, (heights, None), grid)
    assert 0.5 < rolling.amplitude_ratio < 1.1
    assert at_rest.amplitude_ratio < 0.3 * rolling.amplitude_ratio
    assert rolling.lambda_ratio == pytest.approx(at_rest.lambda_ratio, rel=1e-9)


@pytest.mark.parametrize(("case", "row"), [(0, 3), (1, 4), (4, 3)])
def test_shares_are_nearer_to_a_film_with_roughness_in_reynolds_equation(case, row):
    """Stored films of `touching_films` at lambda ratios of 0.4 and 0.2, none of which touches."""
    surface, solved = touching_films.SURFACES[case], kept.found("touching_films")["cases"][case]["rows"][row]
    spacing = 3 * touching_films.HALF / 72
    grid = Grid((72, 72), (spacing, spacing))
    setup = MixedSetup(
        **touching_films.BALL, grid=grid, bodies=(Body(STEEL),) * 2, lubricant=OIL, boundary_friction=BOUNDARY
    )
    heights = np.asarray(surface.heights(*np.meshgrid(grid.x, grid.y, indexing="ij")))
    speeds = (0.0, solved["speed"])
    found = solve_flattened(setup, (heights, np.zeros(grid.shape)), speeds).solution
    undeformed = solve_setup(setup, heights, speeds)
    share, friction = solved["film"]["contact_load_share"], solved["film"]["traction_coefficient"]
    assert found.contact_load / found.load == pytest.approx(share, abs=0.04)
    assert undeformed.contact_load / found.load > share + 0.1
    assert found.friction == pytest.approx(friction, rel=0.05)
    assert abs(found.friction - friction) < 0.5 * abs(undeformed.friction - friction)


def test_a_film_that_clears_the_roughness_carries_all_with_the_same_friction():
    low = rough_patch(1e-9, BALL["grid"])
    found, undeformed = solve_flattened(SETUP, (low, SMOOTH), (1.0, 0.6)).solution, solve_setup(SETUP, low, (1.0, 0.6))
    assert found.full_film
    assert found.friction == undeformed.friction
    assert found.lambda_ratio == pytest.approx(undeformed.lambda_ratio, rel=1e-9)


def test_lambda_ratio_is_of_undeformed_heights_and_a_thin_film_says_so():
    speeds = (0.02, 0.01)
    found, undeformed = solve_flattened(SETUP, (ROUGH, SMOOTH), speeds).solution, solve_setup(SETUP, ROUGH, speeds)
    assert found.lambda_ratio == pytest.approx(undeformed.lambda_ratio, rel=1e-9)
    assert has_code(found.notes, FLATTENED_TOO_HIGH)
    assert found.contact_load < undeformed.contact_load


def test_less_than_a_few_molecules_of_oil_flatten_nothing():
    speeds = (2e-4, 1e-4)
    found, undeformed = solve_flattened(SETUP, (ROUGH, SMOOTH), speeds), solve_setup(SETUP, ROUGH, speeds)
    assert found.flattened.amplitude_ratio == 1
    assert found.solution.friction == pytest.approx(undeformed.friction, rel=1e-9)
    (note,) = [one for one in found.solution.notes if one.code == FLATTENED_TOO_HIGH.code]
    assert 0 < note.values["film"] < 1e-9
    # a hundred times as fast the film is thicker
    assert solve_flattened(SETUP, (ROUGH, SMOOTH), (2e-2, 1e-2)).flattened.amplitude_ratio < 0.5


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"contact_model": "uncoupled"}, "rough half-space"),
        ({"supply": 1e-7}, "flooded"),
        ({"grid": Grid((48, 48), (1e-6, 1e-6), periodic=(True, True))}, "holds the contact"),
        ({"bodies": Body(STEEL, layer=Layer(STEEL, 1e-6))}, "layers"),
    ],
)
def test_refusals_of_setups(changes, message):
    setup = replace(SETUP, **changes)
    heights = np.ones(setup.grid.shape)
    with pytest.raises(InputError, match=message):
        solve_flattened(setup, (heights, heights), (1.0, 0.5))


def test_refusals_of_heights_and_speeds():
    with pytest.raises(InputError, match="both bodies are smooth"):
        solve_flattened(SETUP, (SMOOTH, SMOOTH), (1.0, 0.5))
    with pytest.raises(InputError, match="along"):
        solve_flattened(SETUP, (ROUGH, SMOOTH), (-1.0, -0.5))
