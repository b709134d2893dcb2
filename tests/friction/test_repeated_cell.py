"""A cell of the roughness that repeats under a ball: against a patch that holds the contact, and its limits."""

import math

import numpy as np
import pytest
from mixed_case import BALL as WHOLE

from bem import Grid, solve_mixed
from bem.accuracy import MixedCase, solve_coarser_mixed
from bem.convolution import displacement_operator
from bem.errors import InputError, Status
from bem.friction.cell_law import CellLaw, SolvedCell
from bem.friction.forces import friction_forces
from bem.friction.homogenised_contact import spread_pressure
from bem.friction.models import films_of, rough_contact
from bem.friction.setup import MixedSetup
from bem.friction.solve import solve_setup
from bem.notes.accuracy import NoBar
from bem.reference_solutions.hertz import ellipse_contact
from bem.wear.mixed import MixedContact

MODULUS = 210e9 / 2 / (1 - 0.3**2)
BALL = {key: value for key, value in WHOLE.items() if key != "grid"}
WAVE, A_WAVE = 20e-6, 16
CELL = Grid((A_WAVE, A_WAVE), (WAVE / A_WAVE, WAVE / A_WAVE), periodic=(True, True))
PATCH = Grid((15 * A_WAVE, 15 * A_WAVE), CELL.spacing)
SPEEDS = (0.045, 0.015)


def waves(grid, amplitude=30e-9):
    x, y = (2 * np.pi * axis / WAVE for axis in (grid.x, grid.y))
    return amplitude * np.cos(x)[:, None] * np.cos(y)[None, :]


@pytest.fixture(scope="module")
def both():
    """Set-up and rough contact of the cell and of the patch, and a film on each."""
    found = []
    for grid in (CELL, PATCH):
        setup = MixedSetup(grid=grid, **BALL)
        found.append((setup, rough_contact(setup, waves(grid), SPEEDS), films_of(setup, SPEEDS).under(18.0, 0, None)))
    return found


@pytest.mark.internal
def test_cells_are_pressed_as_a_patch_that_holds_the_contact(both):
    """The same load, film and waves, five and a half of which go into the contact's half-axis. What is left is that of
    sixteen cells a wave (0.5 % of the opening with eight, 0.15 % with sixteen) and of the contact's edge."""
    (_, cells, film), (_, patch, same) = both
    one, other = cells.at_load(film, 2.0, 1e-6, None), patch.at_load(same, 2.0, 1e-6, None)
    assert one.status is Status.CONVERGED
    assert one.load == pytest.approx(2.0, rel=1e-9)
    assert one.pressure.sum() * cells.setup.film_grid.cell_area == pytest.approx(2.0, rel=1e-9)
    assert one.opening == pytest.approx(other.opening, rel=0.01)
    assert one.area == pytest.approx(other.area, rel=0.05)
    # where it is pressed: means over waves of the patch along the middle row of waves
    means = other.pressure.reshape(15, A_WAVE, 15, A_WAVE).mean(axis=(1, 3))[7]
    grid = cells.setup.film_grid
    centres = PATCH.y.reshape(15, A_WAVE).mean(axis=1)
    middle = one.pressure[len(grid.x) // 2 - 1 : len(grid.x) // 2 + 1].mean(axis=0)
    inside = np.abs(centres) < 0.6 * 110e-6
    np.testing.assert_allclose(np.interp(centres, grid.y, middle)[inside], means[inside], rtol=0.02)


@pytest.mark.internal
def test_cells_at_the_approach_of_a_load_carry_it(both):
    (_, cells, film), _ = both
    by_load = cells.at_load(film, 2.0, 1e-9, None)
    for start in (None, by_load.pressure * 3):
        found = cells.at_approach(film, by_load.approach, 1e-9, start)
        assert found.status is Status.CONVERGED
        assert found.load == pytest.approx(2.0, rel=1e-7)  # 1e-9 of the roughness, some tens of which the load lifts
        assert found.opening == pytest.approx(by_load.opening, rel=1e-7)
    closer = cells.at_approach(film, by_load.approach + 5e-9, 1e-9, by_load.pressure)
    assert closer.load > 1.02 * by_load.load
    assert closer.opening < by_load.opening


@pytest.mark.internal
def test_friction_is_that_of_the_load_shared(both):
    (setup, cells, film), _ = both
    pressed = cells.at_load(film, 2.0, 1e-6, None)
    forces = friction_forces(film, pressed, setup, SPEEDS)
    assert forces.boundary == pytest.approx(0.24, rel=1e-9)
    # the film's shear where nothing touches, integrated here
    grid = setup.film_grid
    share = pressed.touching_fraction
    assert share.max() < 0.2
    assert pressed.area == pytest.approx(share.sum() * grid.cell_area, rel=1e-12)
    left = film.shear_force - (film.shear_stress * share).sum() * grid.cell_area
    assert forces.film == pytest.approx(left, rel=1e-12)


@pytest.mark.internal
def test_a_law_of_friction_sees_the_pressures_of_the_cells(both):
    """A law in proportion to the pressure is a coefficient; one with a shear strength besides has it on the real area,
    f = a + s A / F, whichever cell it is in."""
    (_, cells, film), _ = both
    pressed = cells.at_load(film, 2.0, 1e-6, None)
    setup = MixedSetup(
        grid=CELL,
        **BALL
        | {
            "boundary_friction": {
                "kind": "pressure_dependent",
                "shear_strength": 1e6,
                "pressure_coefficient": 0.1,
            }
        },
    )
    found = friction_forces(film, pressed, setup, SPEEDS).coefficient
    assert found == pytest.approx(0.1 + 1e6 * pressed.area / 2.0, rel=1e-3)  # cubics against lines between cells


@pytest.mark.internal
@pytest.mark.slow
def test_load_sharing_is_that_of_the_patch():
    """Measured: shares 0.0628 and 0.0629, friction 0.0680 and 0.0669 (a patch counts whole cells in contact, which
    leave out more of the film; with 32 cells a wave 0.0679, 0.0676)."""
    one, other = (solve_setup(MixedSetup(grid=g, **BALL), waves(g), SPEEDS) for g in (CELL, PATCH))
    assert one.status is other.status is Status.CONVERGED
    assert one.contact_load == pytest.approx(other.contact_load, rel=0.02)
    assert one.friction == pytest.approx(other.friction, rel=0.025)
    assert one.lambda_ratio == pytest.approx(other.lambda_ratio, rel=1e-6)
    assert one.contact_pressure.shape == one.film_pressure.shape == CELL.shape
    assert one.separation.shape == one.film_along_x[0].shape == (A_WAVE,)


@pytest.mark.internal
def test_soft_cells_are_a_foundation_beside_hertz():
    """A cell that hardly gives way leaves Hertz' pressure; one on whose logarithm the load rests, Greenwood and
    Tripp's: lower and wider, with the same load."""
    dry = ellipse_contact(radii=(0.01, 0.01), contact_modulus=MODULUS, load=20.0)
    highest = []
    for length in (1e-9, 100e-9):
        law = logarithmic(length)
        found = spread_under_a_ball(law)[0]
        highest.append(found.pressure.max() / dry.maximum_pressure)
        kept = found.pressure > 1e-3 * found.pressure.max()
        by_law, _ = law.separation(np.log(found.pressure))
        np.testing.assert_allclose(found.separation[kept], by_law[kept], rtol=0, atol=1e-12)
    assert highest[0] == pytest.approx(1, rel=0.02)  # 31 cells across the contact
    assert highest[1] < 0.95


@pytest.mark.internal
@pytest.mark.parametrize("pressure", [1e7, 1e8, 3e8])
def test_cells_that_sink_under_one_pressure_are_spread(pressure):
    """As with few summits at the hardness: Newton's steps took turns between the flat and the steep part of their law,
    and the load sharing stalled."""
    law = logarithmic(1e-9, sinks=500e-9, at=pressure)
    found, deflected = spread_under_a_ball(law)
    missed = deflected - found.approach - law.separation(np.log(found.pressure))[0]
    assert np.abs(missed[found.pressure > 1e-3 * found.pressure.max()]).max() <= 1e-13


def spread_under_a_ball(law):
    """Cells under 20 N on a ball of 10 mm: their pressures, and the gap that these deflect."""
    grid = Grid((48, 48), (7e-6, 7e-6))
    gap = (grid.x[:, None] ** 2 + grid.y[None, :] ** 2) / 0.02
    operator = displacement_operator(grid, BALL["bodies"])
    found = spread_pressure(gap, law, operator, grid, np.ones(grid.shape), 1e-13, load=20.0)
    assert found.status is Status.CONVERGED
    assert found.pressure.sum() * grid.cell_area == pytest.approx(20.0, rel=1e-9)
    return found, gap + operator(found.pressure)


def logarithmic(length, sinks=0.0, at=1e8):
    """Cells whose planes come closer by so much wherever the pressure grows by a factor e, and sink at a pressure."""
    empty = np.zeros(CELL.shape)
    cells = []
    for p in np.geomspace(1e4, 1e10, 24):
        apart = length * math.log(1e11 / p) - sinks * math.tanh(3 * math.log(p / at))
        cells.append(SolvedCell(p, apart, apart, p / 1e11, empty, empty, 0.0, Status.CONVERGED))
    return CellLaw(CELL, tuple(cells))


@pytest.mark.internal
def test_real_area_is_proportional_to_pressure_up_to_the_whole_cell():
    """Cells whose real area is p / 1e11 of them: so it is between those tabulated (1e4 to 1e10 Pa), below and above
    them, and no more than all of a cell."""
    pressure = np.geomspace(1e2, 1e13, 45)
    share = logarithmic(1e-9).share(np.log(pressure))
    np.testing.assert_allclose(share, np.minimum(pressure / 1e11, 1.0), rtol=1e-12)


def test_smooth_enough_or_fast_enough_is_a_full_film():
    found = solve_mixed(**BALL, grid=CELL, height=waves(CELL, 1e-9), speeds=(0.6, 0.4))
    assert found.full_film
    assert found.status is Status.CONVERGED
    assert found.separation.shape == (A_WAVE,)
    assert found.oil.share == 0


@pytest.mark.internal
def test_what_a_cell_has_not_is_said():
    long = Grid((16, 16), (10e-6, 10e-6), periodic=(True, True))
    for wrong, said in (
        ({"oil_volume": "patch"}, "where the film carries"),
        ({"contact_model": "uncoupled"}, "uncoupled"),
        ({"grid": long}, "more than the contact's half-axis"),
        ({"grid": Grid((16, 16), (1e-6, 1e-6), periodic=(True, False))}, "along x and y"),
    ):
        with pytest.raises(InputError, match=said):
            MixedSetup(**{"grid": CELL, **BALL, **wrong})
    setup = MixedSetup(grid=CELL, **BALL)
    with pytest.raises(InputError, match="does not wear"):
        MixedContact(setup, SPEEDS)
    assert solve_coarser_mixed(MixedCase(setup, waves(CELL), None)).why is NoBar.REPEATED_CELL
