"""Reynolds' equation on a patch against closed forms, bounds, perturbation theory and a direct solution."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import spsolve

from bem import Grid, Status, generate_surface
from bem.flow import cell_flow
from bem.flow.factors import LEAST_GAP
from bem.reference_solutions.rough_flow import effective_medium, groove_factors


def rough(n, seed, *, lengths=(1 / 16, 1 / 16), sides=(1.0, 1.0)):
    grid = Grid((n, n), (sides[0] / n, sides[1] / n), periodic=(True, True))
    return generate_surface(grid, rms_height=1.0, seed=seed, correlation_length=lengths)


@pytest.mark.parametrize("spacing", [(1.0, 1.0), (1.0, 0.3), (1e-7, 4e-7)])
def test_grooves_are_exact(spacing):
    """Any step from cell to cell: means of h^-3, h^-2, h^3, 1/h; to what conjugate gradients were asked for."""
    profile = np.random.default_rng(5).uniform(0.1, 2.0, 24)
    across, along, dragged = groove_factors(profile)
    found = cell_flow(np.repeat(profile[:, None], 10, 1), spacing, tolerance=1e-10)
    turned = cell_flow(np.repeat(profile[None, :], 10, 0), spacing, tolerance=1e-10)
    assert found.pressure_flow == pytest.approx(np.diag([across, along]), rel=1e-9, abs=1e-12)
    assert found.couette_gap == pytest.approx(np.diag([dragged, profile.mean()]), rel=1e-9, abs=1e-12)
    assert found.sliding_shear == pytest.approx((1 / profile).mean() - dragged**2 / across, rel=1e-8)
    assert turned.pressure_flow == pytest.approx(np.diag([along, across]), rel=1e-9, abs=1e-12)
    # along grooves nothing is dragged off: h varies across the sliding only
    assert turned.couette_gap[0, 0] == pytest.approx(profile.mean(), rel=1e-12)
    assert turned.sliding_shear == pytest.approx(0, abs=1e-12)


def test_oblique_grooves_by_rotation_second_order():
    """Waves along (1, 2): the tensor of straight grooves turned, approached with the square of the cell."""
    phase = 2 * np.pi * (np.arange(20000) + 0.5) / 20000
    across, along, _ = groove_factors(1 + 0.6 * np.cos(phase))
    normal = np.array([1.0, 2.0]) / np.sqrt(5)
    exact = along * np.eye(2) + (across - along) * np.outer(normal, normal)
    errors = []
    for n in (32, 64, 128):
        x = (np.arange(n) + 0.5) / n
        gap = 1 + 0.6 * np.cos(2 * np.pi * (x[:, None] + 2 * x[None, :]))
        errors.append(np.abs(cell_flow(gap, (1 / n, 1 / n)).pressure_flow - exact).max())
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert (orders > 1.8).all(), orders
    assert errors[-1] < 0.004 * along  # observed 0.0018


def test_small_roughness_is_perturbation_theory():
    """phi = 1 + 3 s^2 - 9 s^2 <q_x^2/q^2> over the patch's own spectrum; s phi_s = 3 s^2 <q_x^2/q^2> = 3 <h chi_s'>.
    The third order of a random surface is s^3 = 1e-6; waves are long, so that the cell's own error is small."""
    n, s = 96, 0.01
    x = 2 * np.pi * np.arange(n) / n
    rng = np.random.default_rng(8)
    height = sum(
        rng.normal() * np.cos(a * x[:, None] + b * x[None, :] + rng.uniform(0, 6))
        for a in range(-2, 3)
        for b in range(-1, 2)
        if (a, b) != (0, 0)
    )
    height *= s / np.sqrt((height**2).mean())
    spectrum = np.abs(np.fft.fft2(height)) ** 2
    qx, qy = np.meshgrid(np.fft.fftfreq(n), np.fft.fftfreq(n), indexing="ij")
    share = (spectrum * qx**2 / np.where(qx**2 + qy**2 > 0, qx**2 + qy**2, 1)).sum() / spectrum.sum()
    cross = (spectrum * qx * qy / np.where(qx**2 + qy**2 > 0, qx**2 + qy**2, 1)).sum() / spectrum.sum()
    found = cell_flow(1 - height, (1.0, 1.0), tolerance=1e-10)
    assert (found.pressure_flow[0, 0] - 1) / s**2 == pytest.approx(3 - 9 * share, abs=0.05)
    assert (found.pressure_flow[1, 1] - 1) / s**2 == pytest.approx(3 - 9 * (1 - share), abs=0.05)
    assert found.pressure_flow[0, 1] / s**2 == pytest.approx(-9 * cross, abs=0.05)
    assert (found.mean_gap - found.couette_gap[0, 0]) / s**2 == pytest.approx(3 * share, abs=0.03)
    assert found.sliding_shear / s**2 == pytest.approx(share, abs=0.02)


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10**6), st.integers(2, 20), st.integers(2, 20), st.floats(-0.5, 3), st.floats(0.2, 5))
def test_bounds_symmetry_and_conservation(seed, nx, ny, separation, ratio):
    """Wiener's bounds of h^3, a symmetric positive tensor, transposition, and flow that closes; any contact."""
    gap = np.maximum(separation + np.random.default_rng(seed).normal(size=(nx, ny)), 0)
    found = cell_flow(gap, (1.0, ratio))
    flow = found.pressure_flow
    assert found.status is Status.CONVERGED
    assert found.residual <= 1e-8
    for axis in (0, 1):
        low = groove_factors(gap)[0]
        assert low * (1 - 1e-7) <= flow[axis, axis] <= (gap**3).mean() * (1 + 1e-12)
        assert -1e-9 <= found.couette_gap[axis, axis] <= gap.max()
    # errors are relative to 1e-4 of the mean h^3 at least
    scale = 1e-9 * (gap**3).mean()
    assert flow[0, 1] == pytest.approx(flow[1, 0], abs=scale + 1e-5 * abs(flow[0, 1]))
    assert abs(flow[0, 1]) <= np.sqrt(flow[0, 0] * flow[1, 1]) * (1 + 1e-5) + scale
    assert (flow[0, 0] > 0) == found.percolates_x
    assert (flow[1, 1] > 0) == found.percolates_y
    # a saving of energy: both means over one positive field
    assert found.sliding_shear >= -1e-9 * (1 / gap[gap > 0]).sum() / gap.size
    turned = cell_flow(np.ascontiguousarray(gap.T), (ratio, 1.0))
    assert turned.pressure_flow == pytest.approx(flow.T[::-1, ::-1].T, rel=1e-6, abs=1e-9)


def direct_flow(gap, repeats):
    """Flow along x through `repeats` patches between two pressures, by a sparse direct solution of the same links."""
    tiled = np.tile(gap, (repeats, 1))
    nx, ny = tiled.shape
    number = np.arange(nx * ny).reshape(nx, ny)
    half = 0.5 * tiled**-3.0
    along = 1 / (half[1:] + half[:-1])
    other = np.roll(half, -1, 1)
    across = 1 / (half + other)
    a = np.concatenate([number[:-1].ravel(), number.ravel()])
    b = np.concatenate([number[1:].ravel(), np.roll(number, -1, 1).ravel()])
    c = np.concatenate([along.ravel(), across.ravel()])
    ends = np.zeros((nx, ny))
    ends[0], ends[-1] = 1 / half[0], 1 / half[-1]
    right = np.zeros((nx, ny))
    right[-1] = ends[-1] * nx
    diagonal = np.bincount(a, c, nx * ny) + np.bincount(b, c, nx * ny) + ends.ravel()
    row = np.concatenate([a, b, number.ravel()])
    matrix = coo_matrix((np.concatenate([-c, -c, diagonal]), (row, np.concatenate([b, a, number.ravel()]))))
    pressure = spsolve(matrix.tocsc(), right.ravel()).reshape(nx, ny)
    return float((ends[0] * pressure[0]).mean())


def test_reynolds_on_many_patches():
    """Flow between two reservoirs through N patches: the cell problem's as N grows, the two ends' share falling as 1/N;
    what is left when that is taken out falls faster than any power, as the ends' fields die out within a patch."""
    gap = 1.4 - 0.55 * rough(24, 11, lengths=(1 / 6, 1 / 6))
    gap = np.maximum(gap, 0.05)
    exact = cell_flow(gap, (1.0, 1.0), tolerance=1e-11).pressure_flow[0, 0]
    # resistances add up: N R + ends
    resistance = {n: n / direct_flow(gap, n) for n in (1, 2, 3, 6)}
    assert abs(direct_flow(gap, 1) / exact - 1) > 0.005
    assert resistance[3] - resistance[2] == pytest.approx(1 / exact, rel=3e-6)
    assert (resistance[6] - resistance[3]) / 3 == pytest.approx(1 / exact, rel=1e-8)


def test_pocket_is_carried_along():
    """A pocket in contact all round: no pressure flow, and the rough wall takes all its fluid with it."""
    gap = np.zeros((12, 12))
    gap[3:8, 2:9] = np.random.default_rng(0).uniform(0.5, 1.5, (5, 7))
    found = cell_flow(gap, (1.0, 1.0))
    assert not found.pressure_flow.any()
    assert not found.couette_gap.any()
    assert (found.percolates_x, found.percolates_y) == (False, False)
    # between closed ends Couette flow is sent back by pressure: four times the shear in all
    assert cell_flow(np.where(np.arange(8)[:, None] > 0, 1.0, 0.0) * np.ones((8, 3)), (1.0, 1.0)).sliding_shear == (
        pytest.approx(7 / 8, rel=1e-9)
    )


def test_flow_is_zero_exactly_below_percolation():
    gap = 1 + 0 * rough(32, 1)
    gap[7] = 0
    found = cell_flow(gap, (1.0, 1.0))
    assert found.pressure_flow[0, 0] == 0
    assert found.pressure_flow[1, 1] == pytest.approx(31 / 32, rel=1e-12)
    assert (found.percolates_x, found.percolates_y) == (False, True)
    nothing = cell_flow(np.zeros((4, 4)), (1.0, 1.0))
    assert (nothing.mean_gap, nothing.open_fraction, nothing.status) == (0, 0, Status.CONVERGED)


def test_second_order_in_the_cell():
    """A smooth surface at thrice its rms height, cells of 1/64 to 1/256 of the patch against 1/512."""
    height = rough(512, 4, lengths=(1 / 8, 1 / 8))
    fine = cell_flow(3.5 - height, (1.0, 1.0), shear=False).pressure_flow[0, 0]
    # means over the fine cells' centres that the coarse cell's centre lies between would smooth; points do not
    errors = []
    for step in (8, 4, 2):
        coarse = 3.5 - height[::step, ::step]
        errors.append(abs(cell_flow(coarse, (1.0, 1.0), shear=False).pressure_flow[0, 0] - fine) / fine)
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert (orders > 1.7).all(), (errors, orders)
    assert errors[0] < 0.01


def test_effective_medium():
    """Bruggeman's figure knows nothing of correlation: at light contact it is 10 % above a smooth isotropic patch."""
    gap = np.maximum(2 - rough(128, 6, lengths=(1 / 24, 1 / 24)), 0)
    found = np.trace(cell_flow(gap, (1.0, 1.0), shear=False).pressure_flow) / 2
    assert found == pytest.approx(effective_medium(gap), rel=0.12)


@pytest.mark.internal
@pytest.mark.parametrize("separation", [4.0, 1.0, 0.5, 0.3, 0.1, 0.02])
def test_few_iterations_whatever_the_contact(separation):
    """Cubes of gaps over twelve orders and more, half of the patch in contact: counts, on two grids."""
    for n in (64, 128):
        gap = separation - rough(n, 3, lengths=(1 / 32, 1 / 32))
        found = cell_flow(np.where(gap < LEAST_GAP, 0.0, gap), (1.0, 1.0))
        assert found.status is Status.CONVERGED
        assert found.iterations <= 3 * 70, (n, found.iterations)  # observed 65 to 183, most just above percolation


def test_status_is_of_what_was_reached():
    gap = np.maximum(1 - rough(64, 3), 0)
    stopped = cell_flow(gap, (1.0, 1.0), max_iterations=3)
    assert stopped.status is Status.MAX_ITERATIONS
    assert stopped.residual > 1e-8
    beyond = cell_flow(gap, (1.0, 1.0), tolerance=1e-19)
    assert beyond.status is not Status.CONVERGED
