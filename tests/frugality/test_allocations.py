"""What is repeated allocates nothing that grows with the grid: memory traced by numpy's own allocations."""

import platform
import subprocess
import sys
import tracemalloc

import numpy as np
import pytest

from bem import Body, Grid, Material, displacement_operator, generate_surface, solve_contact
from bem.accuracy import ContactCase, contact_bars, solve_coarser
from bem.stress import set_stress_memory, stress_memory, subsurface_stress, von_mises_planes

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


@pytest.mark.parametrize(("moments", "fields"), [({}, 7.0), ({"skewness": -0.5, "kurtosis": 3.6}, 8.0)])
def test_a_surface_holds_a_bounded_number_of_fields(moments, fields):
    """Half-way spectra of the transforms, which are not traced, come on top of it."""
    grid = Grid((256, 256), (1e-7, 1e-7), periodic=(True, True))
    given = {"rms_height": 1e-7, "correlation_length": 1e-6, "seed": 1} | moments
    assert peak_of(lambda: generate_surface(grid, **given)) < 1.03 * fields * 8 * grid.cells


FAULTS_OF_FIVE_CONTACTS = """
import resource
import numpy as np
from bem import Body, Grid, Material, displacement_operator, solve_contact
grid = Grid((256, 256), (1e-6, 1e-6), periodic=(True, True))
operator = displacement_operator(grid, Body(Material("steel", youngs_modulus=210e9, poissons_ratio=0.3)))
gap = np.random.default_rng(0).random(grid.shape) * 1e-7
for count in range(8):
    if count == 3:
        before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
    solve_contact(gap, operator, load=1.0)
print(resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before)
"""


@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="another C library keeps what is freed in its own way")
def test_contacts_one_after_the_other_get_no_new_pages_from_the_system():
    ran = subprocess.run([sys.executable, "-c", FAULTS_OF_FIVE_CONTACTS], capture_output=True, text=True, check=True)
    # 2,300 to 3,200 where what is freed goes back; one field of 256 x 256 cells is 128 pages
    assert int(ran.stdout) < 128


def test_von_mises_of_many_depths_holds_no_plane_but_the_one_given():
    grid = Grid((128, 128), (1e-6, 1e-6))
    pressure = np.zeros(grid.shape)
    pressure[40:60, 40:60] = 1e9
    out = np.empty(grid.shape)
    depths = np.linspace(1e-6, 2e-5, 12)

    def sweep():
        for _ in von_mises_planes(pressure, grid, STEEL, depths, friction=0.2, out=out):
            pass

    padded_spectrum = 16 * 256 * 129
    # the transformed pressure; twelve planes would be 1.5 MB, one 0.13 MB
    assert peak_of(sweep) < 1.2 * padded_spectrum


def test_six_stresses_hold_the_result_and_twelve_spectra_a_depth():
    cells, depths = 256, np.linspace(1e-6, 2e-5, 5)
    grid = Grid((cells, cells), (1e-6, 1e-6))
    pressure = np.zeros(grid.shape)
    pressure[40:60, 40:60] = 1e9
    subsurface_stress(pressure, grid, STEEL, depths, friction=0.3)  # plans, compiled loops
    set_stress_memory(0)
    set_stress_memory(1 << 29)
    tracemalloc.start()
    try:
        stress = subsurface_stress(pressure, grid, STEEL, depths, friction=0.3)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    quarter = (cells + 1) ** 2
    # pressure and traction, six quarter arrays each
    assert stress_memory() == depths.size * 12 * 8 * quarter
    # beyond both: the transformed pressure, and what one depth needs while its kernels are made - coefficients of both
    # loads (12 fields), spectra and their sums (18 quarters) - for one depth at a time
    working = 16 * (cells + 1) * 2 * cells + 8 * (12 * grid.cells + 18 * quarter)
    assert peak < stress.nbytes + stress_memory() + 1.1 * working
    # with 64 depths: 0.63 GB for result, spectra and work
    whole = 64 / depths.size * (stress.nbytes + stress_memory()) + working
    assert whole < 0.65e9


def test_a_contact_solve_holds_a_bounded_number_of_fields():
    grid = Grid((256, 256), (1 / 256, 1 / 256), periodic=(True, True))
    operator = displacement_operator(grid, Body(Material("unit", youngs_modulus=1.0, poissons_ratio=0.0)))
    gap = -0.01 * np.random.default_rng(0).standard_normal(grid.shape)
    fields = peak_of(lambda: solve_contact(gap, operator, load=1e-3)) / gap.nbytes
    # pressure, displacement, gap of the result and of each grid (a third more), the scaled gap, states, a few on the
    # cells in contact
    assert fields < 14


@pytest.mark.parametrize("periodic", [(False, False), (True, True)])
def test_a_contact_takes_less_than_52_bytes_a_cell_besides_its_gap(periodic):
    """Displacement and the one before (8 each, the search's fields in the second), state and number of each cell (5),
    results, what coarser grids take (a third), and 190 bytes a cell in contact; buffers of transforms (8 bytes, 16 with
    padding) and spectra stay from one contact to the next. 16384 x 16384 cells with a surface are to fit in 20 GB."""
    cells = 512
    grid = Grid((cells, cells), (1e-3 / cells, 1e-3 / cells), periodic=periodic)
    operator = displacement_operator(grid, STEEL)
    waves = {"hurst": 0.8, "rolloff_wavelength": 2.5e-4, "cutoff_wavelength": 8e-6}
    heights = generate_surface(grid, rms_height=1e-6, seed=3, **waves)
    gap = heights.max() - heights
    solution = solve_contact(gap, operator, load=500.0, tolerance=1e-6)
    assert solution.counted_area == pytest.approx(0.074 * grid.area, rel=0.1)
    assert peak_of(lambda: solve_contact(gap, operator, load=500.0, tolerance=1e-6)) < 52 * grid.cells


@pytest.mark.internal
def test_error_bars_of_a_contact_hold_no_field_of_its_grid(monkeypatch):
    """A quarter of the cells are solved again; where the surface is sharp is told by rows: of 204 bytes a cell of a run
    of 3000 x 3000 cells half were second differences and their shifts. Beyond the coarser contact two bytes a cell."""
    monkeypatch.setattr("bem.numerics.blocks.BLOCK", 1 << 12)
    cells = 512
    grid = Grid((cells, cells), (1e-3 / cells, 1e-3 / cells), periodic=(True, True))
    operator = displacement_operator(grid, STEEL)
    heights = generate_surface(grid, rms_height=1e-6, seed=3, hurst=0.8, cutoff_wavelength=1.6e-5)
    gap = heights.max() - heights
    solution = solve_contact(gap, operator, load=500.0, tolerance=1e-6)
    case = ContactCase(operator, gap, solution, load=500.0, from_touch=True)
    coarser = solve_coarser(case)
    assert peak_of(lambda: contact_bars(case, coarser)) < 3 * grid.cells
    assert peak_of(lambda: solve_coarser(case)) < 28 * grid.cells
