"""Six stresses below loaded rectangles. Errors are relative to the largest component at the point: components that
vanish by symmetry or decay faster have no scale of their own."""

import corner_forms
import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from point_forces import relative

from bem import InputError, Material
from bem.kernels.half_space import rectangle_displacement
from bem.kernels.loads import STRESS_PARITY, Load, clear_odd
from bem.kernels.subsurface import add_rectangle, rectangle_stress, stress_table

pytestmark = pytest.mark.internal

NU = 0.3


def test_any_distance_depth_and_aspect_ratio_against_sixty_digits():
    """10^-3 to 20,000 cells away, 10^-3 to 10^3 deep, sides 1:1000 to 1000:1, all of nu."""
    mp.mp.dps = 60
    rng = np.random.default_rng(11)
    for _ in range(80):
        dx, dy = sorted((1.0, 10 ** rng.uniform(0, 3)), reverse=bool(rng.integers(2)))
        nu = rng.choice([0.0, 0.3, 0.49999, rng.uniform(-0.9, 0.5)])
        distance, angle = 10 ** rng.uniform(-3, 4.3), rng.uniform(0, 2 * np.pi)
        x, y, z = distance * np.cos(angle), distance * np.sin(angle), 10 ** rng.uniform(-3, 3)
        solid = Material("solid", youngs_modulus=2 * (1 + nu), poissons_ratio=nu)
        want = corner_forms.rectangle(x, y, z, dx / 2, dy / 2, nu)
        got = [rectangle_stress(x, y, z, (dx, dy), nu, load) for load in Load]
        got += [rectangle_displacement(x, y, z, (dx, dy), solid, load) for load in Load]
        # near the surface with nu near 1/2 all but z / R of the stress vanishes: there, round-off of the scale of
        # a point force. Largest of 1500 such points by the first term alone: 2e-12, at aspect ratio 400
        scale = 1e-15 * min(1.0, dx * dy / (distance**2 + z**2))
        for one, other in zip(got[:2], want[:2], strict=True):
            assert np.abs(one - other).max() <= 1e-12 * np.abs(other).max() + scale
        for one, other in zip(got[2:], want[2:], strict=True):
            assert relative(one, other) < 1e-12


def test_surface_limits_inside_edge_and_outside():
    normal = rectangle_stress([0, 0.5, 1, 3, 1], [0, -0.7, 0, 0.5, 1], 0.0, (2, 2), NU)
    np.testing.assert_allclose(normal[2], [-1, -1, -0.5, 0, -0.25], atol=1e-15)  # -p; edge and corner: the mean
    np.testing.assert_array_equal(normal[3:5], 0)
    # under the middle of a square xx = yy, and their sum is -(1 + 2 nu) all over the loaded part
    np.testing.assert_allclose(normal[:2, 0], -(1 + 2 * NU) / 2, rtol=1e-15)
    np.testing.assert_allclose(normal[0] + normal[1], (1 + 2 * NU) * normal[2], atol=1e-15)
    assert np.isinf(normal[5, 4])
    traction = rectangle_stress([0, 0.5, 1, 3, 1], [0, -0.7, 0, 0.5, 1], 0.0, (2, 2), NU, Load.TANGENTIAL)
    np.testing.assert_allclose(traction[4], [-1, -1, -0.5, 0, -0.25], atol=1e-15)
    np.testing.assert_array_equal(traction[2:4], 0)
    assert traction[0, 2] == -np.inf  # the body is pushed together ahead of the load, pulled apart behind it
    assert rectangle_stress(-1, 0, 0, (2, 2), NU, Load.TANGENTIAL)[0] == np.inf


@pytest.mark.parametrize("load", Load)
def test_the_surface_is_the_limit_of_small_depths(load):
    x, y = [0.2, 1.3, 0.9, -2.0], [0.1, 0.2, 1.1, 0.0]
    at = rectangle_stress(x, y, 0.0, (2, 2), NU, load)
    for depth in (1e-4, 1e-7, 1e-10):
        below = rectangle_stress(x, y, depth, (2, 2), NU, load)
        assert np.abs(below - at).max() < 20 * depth + 1e-14  # slope of order 1 / distance to the edge


@pytest.mark.parametrize("load", Load)
@pytest.mark.parametrize("depth", [0.0, 1e-9, 3e-6])
def test_table_is_the_rectangle_at_offsets(load, depth):
    table = stress_table((5, 4), (1e-6, 3e-6), depth, NU, load)
    i, j = np.meshgrid(np.arange(5), np.arange(4), indexing="ij")
    direct = rectangle_stress(i * 1e-6, j * 3e-6, depth, (1e-6, 3e-6), NU, load)
    np.testing.assert_allclose(table, direct, rtol=0, atol=1e-14)  # of order one; coordinates rounded differently


coordinate = st.floats(-30, 30)
side = st.floats(-3, 3).map(lambda e: 10.0**e)


@pytest.mark.parametrize("load", Load)
@pytest.mark.parametrize("spacing", [(1.0, 1.0), (1.0, 12.0), (12.0, 1.0)])
@pytest.mark.parametrize("depth", [0.0, 0.7, 90.0])
def test_cells_side_by_side_have_the_bits_of_single_ones(load, spacing, depth):
    """Rows longer than a block, with several rules in them."""
    shape, first = (13, 150), 2
    table = stress_table(shape, spacing, depth, NU, load, first)
    scale = max(spacing)
    pressure, traction = float(load is Load.NORMAL), float(load is Load.TANGENTIAL)
    single = np.zeros((6, *shape))
    for i, j in np.ndindex(*shape):
        stress = np.zeros(6)
        x, y = i * (spacing[0] / scale), (j + first) * (spacing[1] / scale)
        sides = 0.5 * spacing[0] / scale, 0.5 * spacing[1] / scale
        add_rectangle(x, y, depth / scale, *sides, NU, pressure, traction, stress)
        single[:, i, j] = stress / (2 * np.pi)
    clear_odd(single, np.arange(13)[:, None], np.arange(first, 152)[None, :], STRESS_PARITY[load])
    assert np.array_equal(table, single)


@settings(max_examples=60, deadline=None)
@given(coordinate, coordinate, st.floats(1e-3, 30), side, side, st.floats(-0.9, 0.5), st.integers(-30, 30))
def test_parity_exchange_of_axes_trace_and_scaling(x, y, z, dx, dy, nu, power):
    for load in Load:
        s = rectangle_stress(x, y, z, (dx, dy), nu, load)
        # round-off of the point force's scale where symmetry leaves little of the stress itself
        scale = 1e-12 * np.abs(s).max() + 1e-15 * min(1.0, dx * dy / (x * x + y * y + z * z))
        signs = np.array(STRESS_PARITY[load])
        assert np.abs(rectangle_stress(-x, y, z, (dx, dy), nu, load) - signs[:, 0] * s).max() <= scale
        assert np.abs(rectangle_stress(x, -y, z, (dx, dy), nu, load) - signs[:, 1] * s).max() <= scale
        factor = 2.0**power
        far = rectangle_stress(x * factor, y * factor, z * factor, (dx * factor, dy * factor), nu, load)
        np.testing.assert_array_equal(far, s)  # stress knows no length; powers of two change no digit
        # the trace is (1 + nu) times a harmonic function that does not know nu; zz, yz and xz do not know nu either
        other = rectangle_stress(x, y, z, (dx, dy), 0.25, load)
        assert abs(s[:3].sum() / (1 + nu) - other[:3].sum() / 1.25) <= 1e-12 * max(np.abs(s).max(), np.abs(other).max())
        assert np.abs(s[2:5] - other[2:5]).max() <= scale
    normal = rectangle_stress(x, y, z, (dx, dy), nu)
    turned = rectangle_stress(y, x, z, (dy, dx), nu)[[1, 0, 2, 4, 3, 5]]
    assert np.abs(normal - turned).max() <= 1e-12 * np.abs(normal).max()


def test_bad_input_is_refused_with_every_mistake_named():
    with pytest.raises(InputError) as caught:
        rectangle_stress(0, np.inf, -1, (1.0, -1.0), 0.6)
    assert [m.split(":")[0] for m in caught.value.messages] == ["y", "depth", "sides", "poissons_ratio"]
