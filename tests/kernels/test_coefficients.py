"""The door to the kernels: dispatch, shapes, refusals."""

import numpy as np
import pytest

from bem import Body, Grid, InputError, Material
from bem.kernels import semi_periodic
from bem.kernels.coefficients import in_plane_coefficients, stress_coefficients, surface_coefficients
from bem.kernels.half_space import rectangle_displacement
from bem.kernels.loads import STRESS_PARITY, SURFACE_PARITY, Load
from bem.kernels.subsurface import rectangle_stress

pytestmark = pytest.mark.internal

SOLID = Material("solid", youngs_modulus=210e9, poissons_ratio=0.3)
BODY = Body(SOLID)


@pytest.mark.parametrize("periodic", [(False, False), (False, True), (True, False)])
@pytest.mark.parametrize("shape", [(1, 1), (5, 1), (1, 4), (3, 6)])
def test_shapes_and_symmetry_zeros(shape, periodic):
    grid = Grid(shape, (1e-6, 2e-6), periodic=periodic)
    for load in Load:
        lift = surface_coefficients(grid, BODY, load)
        assert lift.shape == shape
        assert np.isfinite(lift).all()
        if SURFACE_PARITY[load][0] < 0:
            np.testing.assert_array_equal(lift[0], 0)
        for depth in (0.0, 1e-7):
            stress = stress_coefficients(grid, BODY, depth, load)
            assert stress.shape == (6, *shape)
            assert np.isfinite(stress).all()
            for component, (px, py) in enumerate(STRESS_PARITY[load]):
                if px < 0:
                    np.testing.assert_array_equal(stress[component, 0], 0)
                if py < 0:
                    np.testing.assert_array_equal(stress[component, :, 0], 0)


@pytest.mark.parametrize("load", Load)
def test_parity_tables_are_those_of_the_fields(load):
    place = (0.7, 0.4)
    for sx, sy in ((-1, 1), (1, -1), (-1, -1)):
        u = rectangle_displacement(*place, 0, (1, 1), SOLID, load)[2]
        mirrored = rectangle_displacement(sx * place[0], sy * place[1], 0, (1, 1), SOLID, load)[2]
        px, py = SURFACE_PARITY[load]
        assert mirrored == pytest.approx((px if sx < 0 else 1) * (py if sy < 0 else 1) * u, rel=1e-13, abs=0)
        s = rectangle_stress(*place, 0.3, (1, 1), 0.3, load)
        mirrored = rectangle_stress(sx * place[0], sy * place[1], 0.3, (1, 1), 0.3, load)
        for component, (px, py) in enumerate(STRESS_PARITY[load]):
            sign = (px if sx < 0 else 1) * (py if sy < 0 else 1)
            assert mirrored[component] == pytest.approx(sign * s[component], rel=1e-12, abs=1e-15)


def test_bad_input_is_refused():
    doubly = Grid((4, 4), (1, 1), periodic=(True, True))
    with pytest.raises(InputError, match="periodic along both"):
        surface_coefficients(doubly, BODY, Load.NORMAL)
    with pytest.raises(InputError, match="periodic along both"):
        stress_coefficients(doubly, BODY, 0.0, Load.NORMAL)
    for depth in (-1e-9, np.nan, np.inf):
        with pytest.raises(InputError, match="depth"):
            stress_coefficients(Grid((4, 4), (1, 1)), BODY, depth, Load.NORMAL)


@pytest.mark.parametrize("kernel", ["surface", "in plane", "stress"])
def test_coefficients_are_computed_with_one_thread_of_linear_algebra(kernel, monkeypatch):
    """Callers cache them, and rounding of linear algebra depends on its threads."""
    from threadpoolctl import threadpool_info, threadpool_limits

    threads, interpolation = set(), semi_periodic._interpolation_along_period

    def counted(*arguments):
        threads.update(one["num_threads"] for one in threadpool_info() if one["user_api"] == "blas")
        return interpolation(*arguments)

    monkeypatch.setattr(semi_periodic, "_interpolation_along_period", counted)
    grid = Grid((4, 6), (1.0, 1.0), periodic=(False, True))
    with threadpool_limits(2, user_api="blas"):
        if kernel == "surface":
            surface_coefficients(grid, BODY, Load.NORMAL)
        elif kernel == "in plane":
            in_plane_coefficients(grid, BODY)
        else:
            stress_coefficients(grid, BODY, 0.5, Load.NORMAL)
    assert threads == {1}
