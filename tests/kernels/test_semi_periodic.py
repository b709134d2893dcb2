"""Free along one axis, periodic along the other: against brute-force images and against strips."""

import numpy as np
import pytest

from bem import Body, Grid, Material
from bem.kernels import half_space, subsurface
from bem.kernels.coefficients import stress_coefficients, surface_coefficients
from bem.kernels.half_plane import strip_displacement, strip_stress
from bem.kernels.loads import STRESS_PARITY, SURFACE_PARITY, Load

pytestmark = pytest.mark.internal

NU = 0.3
SOLID = Material("solid", youngs_modulus=2 * (1 + NU), poissons_ratio=NU)
BODY = Body(SOLID)

CASES = [
    ((6, 5), (1.0, 1.3), (False, True)),
    ((7, 8), (1.0, 0.4), (True, False)),
    ((4, 1), (1.0, 1.0), (False, True)),
    ((1, 5), (3.0, 1.0), (True, False)),
    ((3, 2), (2.0, 0.2), (False, True)),  # the period is a fifth of a cell's other side
    ((5, 17), (1.0, 1.3), (False, True)),  # many cells: only the origin's image is summed as it is
    ((18, 3), (0.2, 0.2), (True, False)),
    ((4, 18), (0.7, 0.7), (False, True)),
]


def geometry(grid):
    axis = 0 if grid.periodic[0] else 1
    return axis, grid.lengths[axis], grid.lengths[1 - axis]


def images(grid, count):
    """Coordinates of all offsets, with `count` images on either side along the last axis."""
    axis, period, _ = geometry(grid)
    shifts = np.arange(-count, count + 1) * period
    x = np.arange(grid.shape[0])[:, None, None] * grid.spacing[0] + (shifts if axis == 0 else 0 * shifts)
    y = np.arange(grid.shape[1])[None, :, None] * grid.spacing[1] + (shifts if axis == 1 else 0 * shifts)
    return x, y


def limit(partial_sum, grid, depth=0.0):
    """Brute force: partial sums over M, 2M, 3M, ... images, extrapolated in powers of 1/(M + 1/2).

    The tail of a sum of inverse powers is a series in those powers; M is far beyond the scale of the offsets.
    """
    _, period, _ = geometry(grid)
    first = int(np.ceil(16 * max(*grid.lengths, depth) / period + 4))
    counts = [first * k for k in (1, 2, 3, 4, 6, 8, 12, 16)]
    h = np.array([1 / (m + 0.5) for m in counts])
    weights = [np.prod([h[j] / (h[j] - h[i]) for j in range(8) if j != i]) for i in range(8)]
    return sum(w * partial_sum(m) for w, m in zip(weights, counts, strict=True))


@pytest.mark.parametrize("load", Load)
@pytest.mark.parametrize("case", CASES)
def test_stresses_are_the_sum_of_images(case, load):
    shape, spacing, periodic = case
    grid = Grid(shape, spacing, periodic=periodic)
    for depth in (0.0, 0.3, 5.0):

        def partial(count, depth=depth):
            x, y = images(grid, count)
            return subsurface.rectangle_stress(x, y, depth, spacing, NU, load).sum(-1)

        got = stress_coefficients(grid, BODY, depth, load)
        want = limit(partial, grid, depth)
        # 1e-10 is asked for, the brute force is good to 1e-12. The scale is the largest stress on the grid: where
        # images cancel to exp(-2 pi x / period), their sum knows no smaller one
        assert np.abs(got - want).max() < 1e-11 * np.abs(want).max()


@pytest.mark.parametrize("load", Load)
@pytest.mark.parametrize("case", CASES)
def test_displacement_is_the_sum_of_images_with_its_datum(case, load):
    shape, spacing, periodic = case
    grid = Grid(shape, spacing, periodic=periodic)
    _, period, reference = geometry(grid)

    def partial(count):
        x, y = images(grid, count)
        total = half_space.rectangle_displacement(x, y, 0.0, spacing, SOLID, load)[2].sum(-1)
        if load is Load.NORMAL:  # a line load of this length, seen from the reference distance
            length = (2 * count + 1) * period
            total -= 2 * grid.cell_area / period / (np.pi * SOLID.plane_strain_modulus) * np.log(length / reference)
        return total

    got = surface_coefficients(grid, BODY, load)
    want = limit(partial, grid)
    scale = np.abs(half_space.rectangle_displacement(0, 0, 0, spacing, SOLID, Load.NORMAL)).max()
    assert np.abs(got - want).max() < 1e-11 * scale  # 1e-10 is asked for; the brute force is good to 1e-12


@pytest.mark.parametrize("case", [*CASES, ((50, 1), (1e-6, 1.0), (False, True)), ((50, 1), (1.0, 1e-6), (False, True))])
def test_all_cells_of_a_period_make_a_strip(case):
    shape, spacing, periodic = case
    grid = Grid(shape, spacing, periodic=periodic)
    axis, _, reference = geometry(grid)
    width = spacing[1 - axis]
    place = np.arange(shape[1 - axis]) * width
    total = surface_coefficients(grid, BODY, Load.NORMAL).sum(axis)
    strip = strip_displacement(place, width, SOLID, reference_length=reference)
    np.testing.assert_allclose(total, strip, rtol=0, atol=1e-13 * np.abs(strip).max())  # round-off
    total = surface_coefficients(grid, BODY, Load.TANGENTIAL).sum(axis)
    across = strip_displacement(place, width, SOLID, Load.TANGENTIAL, reference_length=reference)
    if axis == 1:
        np.testing.assert_allclose(total, across, rtol=0, atol=1e-13 * width)
    order = [1, 0, 2, 4, 3, 5] if axis == 0 else list(range(6))
    for depth in (0.0, 0.2, 40.0):
        total = stress_coefficients(grid, BODY, depth, Load.NORMAL).sum(axis + 1)
        strip = strip_stress(place, depth, width, NU)[order]
        even = [c for c in range(6) if STRESS_PARITY[Load.NORMAL][c][axis] > 0]
        # round-off of the sum; odd stresses cancel over a period only together with those at negative offsets
        np.testing.assert_allclose(total[even], strip[even], rtol=0, atol=1e-13)
        total = stress_coefficients(grid, BODY, depth, Load.TANGENTIAL).sum(axis + 1)
        if axis == 1:
            want = strip_stress(place, depth, width, NU, Load.TANGENTIAL)
        else:  # traction along the strip: anti-plane shear, Johnson (1985), section 2.9 turned
            want = np.zeros((6, place.size))
            with np.errstate(divide="ignore", invalid="ignore"):
                high, low = place + width / 2, place - width / 2
                want[4] = -(np.arctan2(high, depth) - np.arctan2(low, depth)) / np.pi
                want[5] = -0.5 * np.log((high**2 + depth**2) / (low**2 + depth**2)) / np.pi
        even = [c for c in range(6) if STRESS_PARITY[Load.TANGENTIAL][c][axis] > 0]
        np.testing.assert_allclose(total[even], want[even], rtol=0, atol=1e-13)


@pytest.mark.parametrize("load", Load)
def test_a_long_period_tends_to_free_space(load):
    free = Grid((4, 8), (1.0, 1.0))
    near = stress_coefficients(free, BODY, 0.7, load)[:, :, :4]
    errors = []
    for cells in (101, 201, 401):
        periodic = Grid((4, cells), (1.0, 1.0), periodic=(False, True))
        errors.append(np.abs(stress_coefficients(periodic, BODY, 0.7, load)[:, :, :4] - near).max())
    # images are at n cells and their stresses fall with the square of the distance; under traction the leading terms
    # of the two neighbours cancel, and one power more is left
    order = 2 if load is Load.NORMAL else 3
    assert errors[0] < 1e-3
    assert np.log2(errors[0] / errors[1]) == pytest.approx(order, abs=0.1)
    assert np.log2(errors[1] / errors[2]) == pytest.approx(order, abs=0.1)


@pytest.mark.parametrize("cells", [1, 2, 3, 8, 9])
def test_offsets_beyond_half_a_period_follow_by_parity(cells):
    grid = Grid((3, cells), (1.0, 0.5), periodic=(False, True))
    for load in Load:
        table = stress_coefficients(grid, BODY, 0.4, load)
        lift = surface_coefficients(grid, BODY, load)
        for j in range(1, cells):
            np.testing.assert_array_equal(lift[:, cells - j], SURFACE_PARITY[load][1] * lift[:, j])
            for c in range(6):
                np.testing.assert_array_equal(table[c, :, cells - j], STRESS_PARITY[load][c][1] * table[c, :, j])


def test_axes_may_be_exchanged_under_pressure():
    along_y = Grid((5, 6), (1.0, 0.7), periodic=(False, True))
    along_x = Grid((6, 5), (0.7, 1.0), periodic=(True, False))
    np.testing.assert_allclose(
        surface_coefficients(along_y, BODY, Load.NORMAL),
        surface_coefficients(along_x, BODY, Load.NORMAL).T,
        rtol=1e-12,  # the same sums with x and y exchanged inside
    )
    a = stress_coefficients(along_y, BODY, 0.3, Load.NORMAL)
    b = stress_coefficients(along_x, BODY, 0.3, Load.NORMAL)[[1, 0, 2, 4, 3, 5]].transpose(0, 2, 1)
    np.testing.assert_allclose(a, b, rtol=0, atol=1e-14)


def test_scaling_lengths_scales_displacement_and_keeps_stress():
    small = Grid((5, 6), (1e-9, 2e-9), periodic=(False, True))
    large = Grid((5, 6), (1.0, 2.0), periodic=(False, True))
    for load in Load:
        np.testing.assert_allclose(
            surface_coefficients(small, BODY, load), 1e-9 * surface_coefficients(large, BODY, load), rtol=1e-12
        )  # the datum scales too; rounded coordinates
        np.testing.assert_allclose(
            stress_coefficients(small, BODY, 0.5e-9, load), stress_coefficients(large, BODY, 0.5, load), atol=1e-13
        )
