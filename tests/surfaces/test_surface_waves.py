"""The same surface on other cells: its waves are carried to their centres."""

import numpy as np
import pytest

from bem.grid import Grid
from bem.scenes.build import heights_of
from bem.scenes.common import GeneratedSurface
from bem.surfaces import generate_surface
from bem.surfaces.waves import on_cells

pytestmark = pytest.mark.internal


def height(x, y):
    return np.cos(2 * np.pi * (3 * x + y) + 0.3) + 0.4 * np.sin(2 * np.pi * (2 * y - x)) + 0.1 * np.cos(8 * np.pi * y)


def at_centres(shape):
    x, y = ((np.arange(n) + 0.5) / n for n in shape)
    return height(x[:, None], y[None, :])


@pytest.mark.parametrize("shape", [(9, 10), (12, 24), (30, 17), (64, 11)])
def test_waves_are_met_at_the_centres_of_other_cells(shape):
    # fewest cells that hold four waves: nine
    np.testing.assert_allclose(on_cells(at_centres((12, 9)), shape), at_centres(shape), rtol=0, atol=1e-13)


def test_the_same_cells_give_the_same_bits_and_finer_ones_pass_through_the_heights():
    grid = Grid((20, 15), (1e-6, 1e-6), periodic=(True, True))
    heights = generate_surface(grid, rms_height=1e-7, hurst=0.8, seed=4)
    assert on_cells(heights, (20, 15)).tobytes() == heights.tobytes()
    # the middle ones of 3 x 3 lie where the cells did; 20 is even: with the wave of two cells
    np.testing.assert_allclose(on_cells(heights, (60, 45))[1::3, 1::3], heights, atol=1e-20)


def test_a_coarser_grid_has_the_waves_that_it_can_hold():
    assert np.abs(on_cells(np.cos(2 * np.pi * 5 * (np.arange(16) + 0.5) / 16)[:, None], (8, 1))).max() < 1e-15


def test_a_surface_drawn_on_cells_of_its_own_is_the_same_on_finer_grids():
    table = GeneratedSurface(rms_height=1e-7, hurst=0.8, cutoff_wavelength=4e-6, skewness=-0.5, kurtosis=4, drawn_on=16)
    coarse, fine, own = (
        heights_of(table, Grid((n, n), (16e-6 / n, 16e-6 / n), periodic=(False, True)), seed=7) for n in (16, 48, 16)
    )
    np.testing.assert_allclose(on_cells(fine, (16, 16)), coarse, atol=1e-20)
    plain = table.model_copy(update={"drawn_on": None})
    assert heights_of(plain, Grid((16, 16), (1e-6, 1e-6)), seed=7).tobytes() == own.tobytes()
