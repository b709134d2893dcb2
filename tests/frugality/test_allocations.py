"""What is repeated allocates nothing that grows with the grid: memory traced by numpy's own allocations."""

import tracemalloc

import numpy as np
import pytest

from bem import Body, Grid, Material, displacement_operator, solve_contact
from bem.stress import von_mises_planes

STEEL = Body(Material("steel", youngs_modulus=210e9, poissons_ratio=0.3))


def peak_of(work):
    work()  # plans, spectra, buffers
    tracemalloc.start()
    try:
        work()
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize("periodic", [(False, False), (False, True), (True, True)])
def test_a_convolution_allocates_no_field(periodic):
    grid = Grid((256, 240), (1e-6, 1e-6), periodic=periodic)
    scaled = displacement_operator(grid, STEEL).scaled()
    field = np.random.default_rng(0).random(grid.shape)
    out = np.empty(grid.shape)
    assert peak_of(lambda: scaled.apply(field, out)) < 0.05 * field.nbytes


def test_von_mises_of_many_depths_holds_one_plane_and_one_scratch():
    grid = Grid((128, 128), (1e-6, 1e-6))
    pressure = np.zeros(grid.shape)
    pressure[40:60, 40:60] = 1e9
    out = np.empty(grid.shape)
    depths = np.linspace(1e-6, 2e-5, 12)

    def sweep():
        for _ in von_mises_planes(pressure, grid, STEEL, depths, friction=0.2, out=out):
            pass

    padded_spectrum = 16 * 256 * 129
    # the transformed pressure, and one plane to work in; twelve planes would be 1.5 MB
    assert peak_of(sweep) < 1.2 * (padded_spectrum + out.nbytes)


def test_a_contact_solve_holds_a_bounded_number_of_fields():
    grid = Grid((256, 256), (1 / 256, 1 / 256), periodic=(True, True))
    operator = displacement_operator(grid, Body(Material("unit", youngs_modulus=1.0, poissons_ratio=0.0)))
    gap = -0.01 * np.random.default_rng(0).standard_normal(grid.shape)
    fields = peak_of(lambda: solve_contact(gap, operator, load=1e-3)) / gap.nbytes
    # pressure, displacement, gap of the result and of each grid (a third more), the scaled gap, states, a few on the
    # cells in contact
    assert fields < 14
