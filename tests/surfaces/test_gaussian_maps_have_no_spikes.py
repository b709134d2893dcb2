"""Spikes of an instrument: none on Gaussian roughness of any correlation length, and real ones found on it."""

import numpy as np
import pytest

from bem import Grid, generate_surface
from bem.surfaces.spikes import count_spikes, despike

GRID = Grid((128, 128), (1e-6, 1e-6), periodic=(True, True))
LENGTHS = [1, 2, 3, 4, 5, 6, 8, 10, 12, 16]  # correlation lengths in cells
SPIKES = [(20, 30), (64, 64), (64, 65), (65, 64), (65, 65), (90, 17)]


def roughness(cells: int, kind: str) -> np.ndarray:
    return generate_surface(GRID, rms_height=1e-7, seed=cells, correlation_length=cells * 1e-6, autocorrelation=kind)


@pytest.mark.parametrize("kind", ["gaussian", "exponential"])
@pytest.mark.parametrize("cells", LENGTHS)
def test_twenty_gaussian_maps_raise_no_alarm(cells, kind):
    assert count_spikes(roughness(cells, kind), GRID.spacing) == 0


@pytest.mark.parametrize("cells", [1, 4, 12])
def test_spikes_of_one_point_and_of_four_are_found_on_them(cells):
    heights = roughness(cells, "gaussian")
    for place in SPIKES:
        heights[place] += 2e-6
    taken = np.isnan(despike(heights, GRID.spacing))
    assert all(taken[place] for place in SPIKES)
    assert taken.sum() == len(SPIKES)
