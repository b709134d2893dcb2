"""Error bars of contacts on cells that are four times as long along one axis as along the other."""

import numpy as np
import pytest

from bem import Body, Grid, Material, displacement_operator, generate_surface, solve_contact
from bem.accuracy import ContactCase, contact_bars, figures_of, solve_coarser, surface_is_resolved
from bem.accuracy.coarsened import edge_cell, widest_cell
from bem.errors import Status
from reports.experiments.contact_error_bars import waves_through

STEEL = Material("steel", youngs_modulus=200e9, poissons_ratio=0.3)


@pytest.mark.internal
def test_the_axis_with_the_fewest_cells_across_a_spot_decides_how_wide_its_edge_is():
    """The root of the cell's area stood here: 2 for every region."""
    grid, rows, columns = Grid((64, 32), (1.0, 4.0)), np.arange(64)[:, None], np.arange(32)[None, :]
    spot = ((rows - 31.5) ** 2 + (4 * (columns - 15.5)) ** 2 < 20**2).astype(float)
    assert edge_cell(spot, grid) == pytest.approx(4.0, rel=0.05)
    assert edge_cell(spot, Grid((64, 32), (1.0, 1.0))) == 1.0
    cylinder = np.broadcast_to(np.abs(rows - 31.5) < 10, (64, 32)).astype(float)
    assert edge_cell(cylinder, grid) == 1.0
    # four times as long along y as along x, as many cells along both: between the two widths
    long = ((rows - 31.5) ** 2 + (columns - 15.5) ** 2 < 10**2).astype(float)
    assert 1.0 < edge_cell(long, grid) < 2.0
    assert edge_cell(2 * spot, grid, above=3.0) == widest_cell(grid) == 4.0
    assert widest_cell(Grid((64, 1), (1.0, 4.0))) == 1.0


@pytest.mark.internal
def test_a_surface_is_resolved_along_both_axes_or_not_at_all():
    """The mean over both axes called a surface resolved whose shortest waves have 4.5 cells along one of them."""
    torus = Grid((192, 192), (1e-6, 1e-6), periodic=(True, True))
    heights = generate_surface(torus, rms_height=1e-7, hurst=0.8, cutoff_wavelength=18e-6, seed=2)
    assert surface_is_resolved(heights, torus)
    long = Grid((192, 48), (1e-6, 4e-6), periodic=(True, True))
    assert not surface_is_resolved(np.ascontiguousarray(heights[:, ::4]), long)
    # cells as long as the waves of a lay
    lay = generate_surface(torus, rms_height=1e-7, correlation_length=(9e-6, 36e-6), seed=2)
    assert surface_is_resolved(np.ascontiguousarray(lay[:, ::4]), long)


def test_rough_contacts_on_long_cells_are_covered():
    """59 % were covered by bars with the root of the cell's area; 114 random contacts were by 77 %, and are by 93 %."""
    rng, covered = np.random.default_rng(5), []
    for number in range(16):
        sides = (1e-7, 4e-7) if number % 2 else (4e-7, 1e-7)
        shape = (96, 32) if number % 2 else (32, 96)
        grid = Grid(shape, sides, periodic=(True, True))
        finer = Grid((4 * shape[0], 4 * shape[1]), (sides[0] / 4, sides[1] / 4), periodic=(True, True))
        heights = generate_surface(
            grid,
            seed=number,
            hurst=float(rng.uniform(0.4, 1.0)),
            cutoff_wavelength=float(rng.uniform(3, 8)) * 4e-7,
            rms_slope=0.05,
        )
        load = float(10 ** rng.uniform(-1.5, -0.5)) * grid.area * STEEL.plane_strain_modulus * 0.025
        cases = []
        for on, factor in ((grid, 1), (finer, 4)):
            gap = -waves_through(heights, factor)
            gap -= gap.min()
            operator = displacement_operator(on, Body(STEEL))
            solution = solve_contact(gap, operator, load=load, tolerance=1e-7)
            assert solution.status is Status.CONVERGED
            cases.append(ContactCase(operator, gap, solution, load=load, from_touch=True))
        bars = contact_bars(cases[0], solve_coarser(cases[0])).values
        found, truth = (figures_of(case.solution, grid.area) for case in cases)
        covered += [abs(found[name] - truth[name]) <= bars[name] for name in ("contact_area", "mean_contact_pressure")]
    assert np.mean(covered) >= 0.8
