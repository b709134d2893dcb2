"""Surface and subsurface displacement of loaded rectangles."""

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bem import InputError, Material
from bem.kernels.half_space import rectangle_displacement, surface_table
from bem.kernels.loads import Load

pytestmark = pytest.mark.internal

NU = 0.3
SOLID = Material("solid", youngs_modulus=2 * (1 + NU), poissons_ratio=NU)  # G = 1


def love(x, y, a, b):
    """V on the surface, as printed by Johnson (1985), eq. 3.25, in 40 digits."""
    mp.mp.dps = 40
    x, y, a, b = (mp.mpf(float(v)) for v in (x, y, a, b))
    total = mp.mpf(0)
    for s, t in ((x, y), (y, x)):
        c, d = (a, b) if s is x else (b, a)
        for sign in (1, -1):
            u = s + sign * c
            if u == 0:
                continue
            top, bottom = t + sign * d, t - sign * d
            total += u * mp.log((top + mp.sqrt(top**2 + u**2)) / (bottom + mp.sqrt(bottom**2 + u**2)))
    return total


@pytest.mark.parametrize("sides", [(1, 1), (1, 10), (10, 1), (1, 1000), (1e-9, 1e-9), (1.0, 0.3)])
@pytest.mark.parametrize("cells", [(0, 0), (1, 0), (0, 1), (1, 1), (5, 7), (6, 0), (100, 3), (0, 999), (10000, 10000)])
def test_table_against_love_in_forty_digits(sides, cells):
    dx, dy = sides
    i, j = cells
    got = rectangle_displacement(i * dx, j * dy, 0.0, sides, SOLID)[2]
    want = love(i * dx, j * dy, dx / 2, dy / 2) * 2 * (1 - mp.mpf(NU)) / (4 * mp.pi)
    assert abs(got / want - 1) < 1e-13  # round-off; 1e-12 near and 1e-10 far are asked for


@pytest.mark.parametrize("load", Load)
def test_table_is_the_rectangle_at_offsets(load):
    table = surface_table((5, 4), (1e-6, 3e-6), SOLID, load)
    i, j = np.meshgrid(np.arange(5), np.arange(4), indexing="ij")
    direct = rectangle_displacement(i * 1e-6, j * 3e-6, 0.0, (1e-6, 3e-6), SOLID, load)[2]
    np.testing.assert_allclose(
        table, direct, rtol=1e-12, atol=1e-28
    )  # the same sums, with coordinates rounded differently


coordinate = st.floats(-30, 30)
side = st.floats(-3, 3).map(lambda e: 10.0**e)


@settings(max_examples=60, deadline=None)
@given(coordinate, coordinate, side, side)
def test_reciprocity_of_pressure_and_traction(x, y, dx, dy):
    lift = rectangle_displacement(x, y, 0.0, (dx, dy), SOLID, Load.TANGENTIAL)[2]
    drag = rectangle_displacement(-x, -y, 0.0, (dx, dy), SOLID, Load.NORMAL)[0]
    # Betti: work of either load on the other's displacement is the same; scale: the largest displacement there
    scale = np.abs(rectangle_displacement(x, y, 0.0, (dx, dy), SOLID, Load.NORMAL)).max()
    assert abs(lift - drag) <= 1e-13 * scale


@settings(max_examples=60, deadline=None)
@given(coordinate, coordinate, st.floats(0, 20), side, side, st.sampled_from(Load), st.integers(-30, 30))
def test_symmetry_and_scaling(x, y, z, dx, dy, load, power):
    u = rectangle_displacement(x, y, z, (dx, dy), SOLID, load)
    mirrored_x = rectangle_displacement(-x, y, z, (dx, dy), SOLID, load)
    mirrored_y = rectangle_displacement(x, -y, z, (dx, dy), SOLID, load)
    signs_x = np.array([-1, 1, 1]) if load is Load.NORMAL else np.array([1, -1, -1])
    scale = 1e-13 * np.abs(u).max()
    assert np.abs(mirrored_x - signs_x * u).max() <= scale
    assert np.abs(mirrored_y - np.array([1, -1, 1]) * u).max() <= scale
    factor = 2.0**power
    stretched = rectangle_displacement(x * factor, y * factor, z * factor, (dx * factor, dy * factor), SOLID, load)
    # powers of two change no digit, but for coordinates that fall below the smallest number there is
    assert np.abs(stretched - u * factor).max() <= 1e-17 * np.abs(u * factor).max()


def test_bad_input_is_refused_with_every_mistake_named():
    with pytest.raises(InputError) as caught:
        rectangle_displacement(np.nan, 0, -1, (0.0, 1.0), SOLID)
    assert [m.split(":")[0] for m in caught.value.messages] == ["x", "depth", "sides"]
