"""The solver on several ranks, which are threads here: against the serial solver, closed forms and itself."""

import numpy as np
import pytest
from thread_ranks import on_ranks

from bem import Body, Grid, Layer, Material, displacement_operator, solve_contact
from bem.distributed.bounded_cg import ApproachSearch, SlabProblem
from bem.distributed.convolution import slab_convolution
from bem.distributed.ranks import OneRank, own_slice
from bem.distributed.solve import _certified, solve_slabs
from bem.errors import InfeasibleError, InputError, Status

STEEL = Body(Material("steel", youngs_modulus=210e9, poissons_ratio=0.3))
BRONZE = Body(Material("bronze", youngs_modulus=110e9, poissons_ratio=0.34))
COATED = Body(STEEL.material, layers=(Layer(Material("hard", youngs_modulus=800e9, poissons_ratio=0.2), 3e-6),))
FREE, PERIODIC, ALONG_X = (False, False), (True, True), (True, False)


def rough_gap(shape, seed=1):
    """Smoothed noise of 100 nm, curved a little, so that contact is partial [m]."""
    noise = np.random.default_rng(seed).random(shape)
    return 1e-7 * (noise + np.roll(noise, 1, 0) + np.roll(noise, 1, 1)) / 3


def solved(size, gap, grid, bodies, **control):
    """Pressure of all ranks together, and the solution of each."""
    parts = on_ranks(
        size,
        lambda ranks: solve_slabs(
            np.ascontiguousarray(gap[own_slice(grid.shape[0], ranks)]), grid, bodies, ranks, **control
        ),
    )
    return np.concatenate([part.pressure for part in parts]), parts


CASES = {
    "free": ((19, 26), FREE, STEEL, {"pressure": 4e8}, None),
    "pair, cap": ((24, 18), FREE, (STEEL, BRONZE), {"pressure": 5e8}, 2e9),
    "periodic, cap": ((21, 32), PERIODIC, STEEL, {"pressure": 1e9}, 3e9),
    "periodic, approach": ((16, 15), PERIODIC, STEEL, {"approach": 4e-8}, None),
    "layered": ((12, 9), FREE, COATED, {"pressure": 1e9}, None),
    "layered, periodic along x, approach": ((10, 9), ALONG_X, COATED, {"approach": 7e-8}, 5e9),
    "five rows": ((5, 33), FREE, STEEL, {"approach": 1e-7}, 4e9),
    "one column": ((33, 1), PERIODIC, STEEL, {"pressure": 5e8}, None),
}
"""Cells, periodicity, bodies, mean pressure [Pa] or approach [m], hardness [Pa]."""


@pytest.mark.parametrize("name", CASES)
def test_any_number_of_ranks_gives_the_serial_contact(name):
    """To 1e-10 of the pressure at a tolerance of 1e-12; numbers of ranks agree to the last bit."""
    shape, periodic, bodies, control, hardness = CASES[name]
    grid, gap = Grid(shape, (1e-6, 2e-6), periodic=periodic), rough_gap(shape)
    given = {"load": control["pressure"] * grid.area} if "pressure" in control else control
    settings = {**given, "hardness": hardness, "tolerance": 1e-12}
    serial = solve_contact(gap, displacement_operator(grid, bodies), **settings)
    first, parts = solved(1, gap, grid, bodies, **settings)
    assert parts[0].status is Status.CONVERGED
    assert 0.03 < np.mean(first > 0) < 0.97
    assert hardness is None or (first == hardness).any()
    assert np.abs(first - serial.pressure).max() < 1e-10 * serial.pressure.max()
    assert parts[0].approach == pytest.approx(serial.approach, rel=1e-11, abs=0)
    assert np.abs(parts[0].gap - serial.gap).max() < 1e-11 * gap.std() + 1e-10 * serial.displacement.max()
    for size in (2, 3, 4):
        others, parts = solved(size, gap, grid, bodies, **settings)
        assert np.array_equal(others, first)
        assert len({(part.approach, part.load, part.residual, part.iterations) for part in parts}) == 1


def test_transposes_are_two_for_each_convolution():
    """And one for a table of coefficients; a periodic spectrum needs none."""
    for periodic, tables in ((FREE, 1), (PERIODIC, 0)):
        grid, gap = Grid((12, 10), (1e-6, 1e-6), periodic=periodic), rough_gap((12, 10))

        def counted(ranks, grid=grid, gap=gap):
            rows = np.ascontiguousarray(gap[own_slice(12, ranks)])
            solution = solve_slabs(rows, grid, STEEL, ranks, load=0.005)
            return ranks.count.transposes, solution.convolutions

        for transposes, convolutions in on_ranks(3, counted):
            assert transposes == 2 * convolutions + tables


@pytest.mark.parametrize("periodic", [FREE, PERIODIC, ALONG_X, (False, True)])
@pytest.mark.parametrize("body", [STEEL, COATED], ids=["bare", "coated"])
def test_convolution_is_that_of_the_operator(periodic, body):
    """To round-off, from spectra that each rank computes for its columns."""
    shape = (11, 14)
    grid = Grid(shape, (1e-6, 1.5e-6), periodic=periodic)
    pressure = np.random.default_rng(4).random(shape)
    expected = displacement_operator(grid, body)(pressure)

    def displaced(ranks):
        convolution = slab_convolution(grid, (body,), ranks)
        mean = convolution.spectra.mean_compliance * pressure.mean()  # included on doubly periodic grids
        return convolution.displacement(pressure[own_slice(shape[0], ranks)]) - mean

    found = np.concatenate(on_ranks(3, displaced))
    assert np.abs(found - expected).max() < 1e-13 * np.abs(expected).max()


def test_preconditioner_inverts_all_waves_of_a_periodic_grid():
    """The mean included, to which it gives a compliance."""
    grid = Grid((12, 9), (1e-6, 1e-6), periodic=PERIODIC)
    convolution = slab_convolution(grid, (COATED,), OneRank())
    pressure = np.random.default_rng(5).random(grid.shape)
    found = convolution.precondition(convolution.displacement(pressure))
    assert np.abs(found - pressure).max() < 1e-5  # single precision


def test_hertz_contact_is_second_order_in_the_cell():
    """Approach of a ball under a load: within 0.6 % at 13 cells a radius, and falling with the cell."""
    radius, load = 0.01, 10.0
    modulus = STEEL.material.plane_strain_modulus
    half_width = (0.75 * load * radius / modulus) ** (1 / 3)
    errors = []
    for cells in (32, 64):
        spacing = 2.5 * half_width / cells
        grid = Grid((cells, cells), (spacing, spacing))
        gap = (grid.x[:, None] ** 2 + grid.y[None, :] ** 2) / (2 * radius)
        solution = solve_slabs(gap, grid, STEEL, OneRank(), load=load)
        assert solution.status is Status.CONVERGED
        errors.append(abs(solution.approach * radius / half_width**2 - 1))
    assert errors[0] < 6e-3
    assert errors[1] < 0.6 * errors[0]


def test_full_contact_takes_the_mean_gap_as_approach():
    """Westergaard's wave pressed flat: p = mean + E* q amplitude / 2 of the wave."""
    grid = Grid((16, 8), (1e-6, 1e-6), periodic=PERIODIC)
    wavenumber, amplitude = 2 * np.pi / 16e-6, 1e-8
    gap = np.repeat(amplitude * (1 - np.cos(wavenumber * grid.x))[:, None], 8, axis=1)
    most = STEEL.material.plane_strain_modulus * wavenumber * amplitude / 2
    solution = solve_slabs(gap, grid, STEEL, OneRank(), load=1.5 * most * grid.area, tolerance=1e-12)
    assert solution.status is Status.CONVERGED
    expected = most * (1.5 + np.cos(wavenumber * grid.x))
    assert np.abs(solution.pressure - expected[:, None]).max() < 1e-11 * most
    assert solution.approach == pytest.approx(amplitude, rel=1e-11, abs=0)


def test_near_full_contact():
    """White noise pressed nearly flat, where the load runs away with the approach: without a compliance of the mean
    pressure the solver stalled, or pressures overflowed."""
    grid = Grid((33, 1), (1e-6, 2e-6), periodic=PERIODIC)
    operator = displacement_operator(grid, COATED)
    for seed in (1, 7, 9, 12, 17):
        gap = 1e-7 * np.random.default_rng(seed).random(grid.shape)
        load = 0.03 * operator.contact_modulus * grid.area
        serial = solve_contact(gap, operator, load=load, tolerance=1e-11)
        for control in ({"load": load}, {"approach": serial.approach}):
            solution = solve_slabs(gap, grid, COATED, OneRank(), tolerance=1e-11, **control)
            assert 0.7 < np.mean(solution.pressure > 0) < 1
            assert solution.status is Status.CONVERGED
            assert np.abs(solution.pressure - serial.pressure).max() < 1e-9 * serial.pressure.max()


def test_a_wrong_bracket_is_opened_again():
    """Errors of inexact pressures closed the bracket at 1; the approach sought is 2."""
    search = ApproachSearch(0.9, target=1.0, controls_load=True, compliance=0.0, length=0.1)
    search.advance(-0.1)
    search.approach = 1.0
    search.advance(0.1)
    for _ in range(60):
        before = search.ratio
        search.advance(0.5 * search.approach - 1.0)
        if search.approach == pytest.approx(2.0, rel=1e-9, abs=0):
            break
    assert before < 0.1
    assert search.approach == pytest.approx(2.0, rel=1e-9, abs=0)


def test_without_contact():
    """No load, or an approach before first touch: no pressure, and no iteration."""
    grid, gap = Grid((6, 5), (1e-6, 1e-6)), rough_gap((6, 5)) + 1e-6
    for control, approach in (({"load": 0.0}, gap.min()), ({"approach": 5e-7}, 5e-7)):
        solution = solve_slabs(gap, grid, STEEL, OneRank(), **control)
        assert solution.status is Status.CONVERGED
        assert not solution.pressure.any()
        assert solution.approach == pytest.approx(approach, rel=1e-12, abs=0)
        assert solution.iterations == 0


def test_refusals_are_raised_on_all_ranks():
    """Also those that only one rank can see."""
    grid, gap = Grid((6, 5), (1e-6, 1e-6), periodic=PERIODIC), rough_gap((6, 5))

    def raised(error, words, size=2, broken=None, **control):
        def call(ranks):
            rows = np.array(gap[own_slice(6, ranks)])
            if ranks.rank == broken:
                rows[0, 0] = np.nan
            with pytest.raises(error, match=words):
                solve_slabs(rows, grid, STEEL, ranks, **control)

        on_ranks(size, call)

    raised(InputError, "exactly one of load and approach")
    raised(InputError, "at most one rank for each row", size=7, load=1.0)
    raised(InputError, "gap of rank 1 must be finite", broken=1, load=1.0)
    raised(InputError, "tolerance", load=1.0, tolerance=2.0)
    raised(InfeasibleError, "above hardness x area", load=1.0, hardness=1e9)
    raised(InfeasibleError, "cannot come closer", approach=1e-6)


def test_an_iteration_limit_is_told_with_the_residual_of_what_is_returned():
    """The certificate recomputes violation and load: of a pressure whose load is a hundredth off, at least that."""
    grid, gap = Grid((12, 10), (1e-6, 1e-6)), rough_gap((12, 10))
    stopped = solve_slabs(gap, grid, STEEL, OneRank(), load=0.02, max_iterations=2)
    assert stopped.status is Status.MAX_ITERATIONS
    assert stopped.iterations == 2
    assert stopped.residual > 1e-4
    solved_load = solve_slabs(gap, grid, STEEL, OneRank(), load=0.02)
    problem = SlabProblem(slab_convolution(grid, (STEEL,), OneRank()), gap - gap.min(), np.inf)
    certified = _certified(
        problem, solved_load.pressure, solved_load.approach - gap.min(), lowest=gap.min(), load=0.02 * 1.01,
        violation_scale=lambda displacement: gap.std(), tolerance=1e-8, status_if_unmet=Status.STALLED,
        rows=slice(0, 12), iterations=0, unit=1.0,
    )  # fmt: skip
    assert certified.residual == pytest.approx(0.01 / 1.01, rel=1e-6, abs=0)
    assert certified.status is Status.STALLED


def test_iterations_hardly_grow_with_the_grid():
    """A ball on 32, 64 and 128 cells: without the preconditioner they grow with the root of the cells a side."""
    counts = []
    for cells in (32, 64, 128):
        grid = Grid((cells, cells), (1e-3 / cells, 1e-3 / cells))
        gap = (grid.x[:, None] ** 2 + grid.y[None, :] ** 2) / 0.02
        counts.append(solve_slabs(gap, grid, STEEL, OneRank(), approach=5e-6).iterations)
    assert max(counts) <= 20
    assert counts[2] <= counts[0] + 6
