"""Load sharing of heights that the film has flattened: rough films solved directly, limits, refusals."""

from dataclasses import replace

import numpy as np
import pytest
from mixed_case import BALL, rough_patch

from bem import Body, Grid, InputError, Layer
from bem.friction.flattened import solve_flattened
from bem.friction.setup import MixedSetup
from bem.friction.solve import solve_setup
from bem.notes import has_code
from bem.notes.friction import FLATTENED_TOO_HIGH
from reports.experiments import kept, touching_films
from reports.experiments.rough_films import BOUNDARY, OIL, STEEL

SETUP = MixedSetup(**BALL)
SMOOTH = np.zeros(BALL["grid"].shape)
ROUGH = rough_patch(100e-9, BALL["grid"])


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
