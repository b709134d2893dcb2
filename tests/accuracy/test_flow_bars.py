"""Error bars of flow factors where few cells touch."""

import numpy as np
import pytest

from bem import Body, Grid, Material, flow_factors
from bem.accuracy import flow_bars
from bem.surfaces import generate_surface
from reports.experiments.contact_error_bars import waves_through

STEEL = Body(Material("steel", youngs_modulus=200e9, poissons_ratio=0.3))


@pytest.mark.parametrize("seed", range(10, 18))
def test_shear_beside_a_spot_of_a_cell_or_two_is_covered(seed):
    """Random patches with two to four cells in contact against four times finer ones: a quarter was not covered without
    a share of its own."""
    grid = Grid((32, 32), (1e-6, 1e-6), periodic=(True, True))
    heights = waves_through(generate_surface(grid, seed=seed, hurst=0.7, cutoff_wavelength=5e-6, rms_slope=0.03), 1)
    apart = [0.97 * np.sort(heights.ravel())[-4]]
    own = flow_factors(heights, grid, STEEL, separations=apart, errors=True)
    finer = Grid((128, 128), (0.25e-6, 0.25e-6), periodic=(True, True))
    truth = flow_factors(waves_through(heights, 4), finer, STEEL, separations=apart)
    assert 0 < own.contact_area_fraction[0] * heights.size < 4
    error = abs(own.friction_shear - truth.friction_shear)[0]
    bar = flow_bars(own, heights, grid).values["friction_shear"][0]
    assert error <= bar < 0.6 * own.friction_shear[0]
