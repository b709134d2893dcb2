"""Residual stress of layers: closed forms, superposition, criteria of stress, and what does not depend on it."""

import numpy as np
import pytest

from bem import Body, Grid, InputError, Layer, Material, displacement_operator, solve_contact, subsurface_stress
from bem.life.fatigue_limit import FatigueLimit
from bem.stress import (
    connected_stress,
    depth_maxima,
    layer_stresses,
    summarise_stress,
    von_mises,
    von_mises_field,
    von_mises_upper_bound,
)
from bem.wear import WearModel, WearSetup
from bem.wear.criterion import VonMises
from bem.wear.loads import SurfaceLoad
from bem.wear.yielding import cannot_yield, equivalent_stress_planes, piece_stress, yielded_stress

CARBON = Material("carbon", youngs_modulus=200e9, poissons_ratio=0.25, hardness=20e9)
NITRIDE = Material("nitride", youngs_modulus=300e9, poissons_ratio=0.22, hardness=18e9)
STEEL = Material("steel", youngs_modulus=207e9, poissons_ratio=0.3, hardness=7e9)
OUTER, INNER = -2e9, 0.7e9
PLAIN = Body(STEEL, layers=(Layer(CARBON, 2e-6), Layer(NITRIDE, 1e-6)))
STRESSED = Body(STEEL, layers=(Layer(CARBON, 2e-6, OUTER), Layer(NITRIDE, 1e-6, residual_stress=INNER)))
DEPTHS = np.array([0.0, 1e-6, 2e-6, 2.001e-6, 3e-6, 3.001e-6, 5e-6])
RESIDUAL = np.array([OUTER, OUTER, OUTER, INNER, INNER, 0.0, 0.0])
GRIDS = [
    Grid((24, 20), (0.5e-6, 0.5e-6), periodic=periodic) for periodic in ((False, False), (True, True), (False, True))
]


def hertz(grid, highest=2e9, radius=4e-6):
    x, y = np.meshgrid(grid.x, grid.y, indexing="ij")
    return highest * np.sqrt(np.clip(1 - (x**2 + y**2) / radius**2, 0, None))


@pytest.mark.parametrize("grid", GRIDS)
@pytest.mark.parametrize("friction", [0.0, 0.2])
def test_it_adds_to_both_stresses_in_the_plane_and_to_nothing_else(grid, friction):
    pressure = hertz(grid)
    found = subsurface_stress(pressure, grid, STRESSED, DEPTHS, friction=friction)
    without = subsurface_stress(pressure, grid, PLAIN, DEPTHS, friction=friction)
    expected = without.copy()
    expected[:2] += RESIDUAL[:, None, None]
    np.testing.assert_allclose(found, expected, atol=1e-13 * 2e9, rtol=1e-12)
    mises = von_mises_field(pressure, grid, STRESSED, DEPTHS, friction=friction)
    np.testing.assert_allclose(mises, von_mises(expected), rtol=1e-9, atol=1e-12 * 2e9)
    xx, yy, zz, yz, xz, xy = expected
    by_hand = np.sqrt(0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3 * (yz**2 + xz**2 + xy**2))
    np.testing.assert_allclose(mises, by_hand, rtol=1e-9, atol=1e-12 * 2e9)


def test_prescribed_tractions_along_both_axes_carry_it_once():
    grid = GRIDS[0]
    pressure, traction = hertz(grid), np.stack([0.1 * hertz(grid), -0.2 * hertz(grid)])
    expected = subsurface_stress(pressure, grid, PLAIN, DEPTHS, traction=traction)
    expected[:2] += RESIDUAL[:, None, None]
    np.testing.assert_allclose(
        von_mises_field(pressure, grid, STRESSED, DEPTHS, traction=traction), von_mises(expected), rtol=1e-9
    )


def test_without_a_contact_the_layers_hold_it_alone():
    """Von Mises stress of an equibiaxial stress is its size; the highest principal stress is zero in compression."""
    grid = GRIDS[0]
    below = summarise_stress(np.zeros(grid.shape), grid, STRESSED, DEPTHS, components=True)
    np.testing.assert_allclose(below.von_mises, np.abs(RESIDUAL)[:, None, None] + 0 * below.von_mises, rtol=1e-12)
    found = layer_stresses(depth_maxima(below.stress, below.von_mises, DEPTHS, STRESSED), STRESSED)
    np.testing.assert_allclose(found.layer_max_von_mises, [2e9, 0.7e9], rtol=1e-12)
    np.testing.assert_allclose(found.layer_max_tension, [0.0, 0.7e9], atol=1e-3)
    assert found.interface_max_shear.tolist() == found.interface_max_tension.tolist() == [0.0, 0.0]


def test_compression_takes_tension_from_a_rubbed_coating():
    """Behind a sliding contact the surface of a layer is in tension; with compression of more it is not."""
    grid = GRIDS[0]
    below = [
        summarise_stress(hertz(grid), grid, body, DEPTHS, friction=0.3, components=True) for body in (PLAIN, STRESSED)
    ]
    plain, stressed = (
        layer_stresses(depth_maxima(one.stress, one.von_mises, DEPTHS, PLAIN), PLAIN).layer_max_tension for one in below
    )
    assert plain[0] > 0.5e9
    assert stressed[0] < plain[0] - 0.4e9
    assert stressed[1] == pytest.approx(plain[1] + INNER, rel=0.5)


def test_pressure_and_displacement_do_not_depend_on_it():
    grid = GRIDS[0]
    gap = (grid.x[:, None] ** 2 + grid.y**2) / 1e-4
    plain, stressed = (solve_contact(gap, displacement_operator(grid, body), load=0.05) for body in (PLAIN, STRESSED))
    assert plain.pressure.tobytes() == stressed.pressure.tobytes()
    assert plain.displacement.tobytes() == stressed.displacement.tobytes()


@pytest.mark.parametrize("grid", GRIDS)
def test_the_bound_without_a_transform_holds_with_it(grid):
    pressure = hertz(grid)
    bound = von_mises_upper_bound(pressure, grid, STRESSED, DEPTHS, friction=0.2)
    highest = von_mises_field(pressure, grid, STRESSED, DEPTHS, friction=0.2).max(axis=(1, 2))
    assert (bound >= highest).all()
    assert bound[0] < von_mises_upper_bound(pressure, grid, PLAIN, DEPTHS, friction=0.2)[0] + 2.001e9


LIMIT, FRICTION = 6e9 / 2.8, 0.25
SOFT = Material("soft", youngs_modulus=200e9, poissons_ratio=0.25, hardness=6e9)


def worn(residual, pressure):
    """Set-up of wear of a soft layer with a residual stress."""
    grid = Grid((32, 24), (0.25e-6, 0.25e-6), periodic=(False, True))
    body = Body(STEEL, layers=(Layer(SOFT, 3e-6, residual),))
    return WearSetup(grid, (body, body), np.zeros(grid.shape), 1.0, FRICTION, np.arange(12) * 0.2e-6), pressure(grid)


@pytest.mark.parametrize("residual", [-1.9e9, 1.9e9])
def test_wear_criteria_of_stress_include_it(residual):
    """Pieces follow whole planes, two loads count it once, and a layer in compression yields where it did not."""
    model = WearModel(criterion=VonMises())
    setup, pressure = worn(residual, lambda grid: hertz(grid, 2.2e9, 2e-6))
    free, _ = worn(0.0, lambda grid: hertz(grid, 2.2e9, 2e-6))
    whole = yielded_stress(pressure, setup, model, 0)
    expected = von_mises_field(pressure, setup.grid, setup.bodies[0], whole.depths, friction=FRICTION)
    np.testing.assert_allclose(whole.stress, expected, rtol=1e-9)
    assert (whole.stress > LIMIT).any()
    assert not (yielded_stress(pressure, free, model, 0).stress > LIMIT).any()
    pieces = piece_stress(pressure, setup, model, 0)
    reached = len(pieces.planes)
    np.testing.assert_allclose(pieces.stress[:reached], expected[:reached], rtol=1e-9)
    assert np.array_equal(pieces.yielding, (expected[:reached] > LIMIT).any(axis=0))
    halves = (SurfaceLoad(0.5 * pressure, FRICTION), SurfaceLoad(0.5 * pressure, FRICTION))
    out = np.empty((len(whole.depths), *setup.grid.shape))
    for _ in equivalent_stress_planes(halves, setup, 0, whole.depths, model.criterion_law, out):
        pass
    np.testing.assert_allclose(out[:reached], expected[:reached], rtol=1e-9)
    assert not cannot_yield(halves, setup, 0, float(whole.depths[0]), model.criterion_law)


def test_regions_end_where_whole_planes_say_so():
    """Connected stress ends below the first plane without a point above the limit, and keeps the planes beside it."""
    setup, pressure = worn(-1.9e9, lambda grid: hertz(grid, 2.2e9, 2e-6))
    depths = np.arange(16) * 0.4e-6
    found = connected_stress(pressure, setup.grid, setup.bodies[0], depths, LIMIT, friction=FRICTION, depths_beside=2)
    whole = von_mises_field(pressure, setup.grid, setup.bodies[0], depths, friction=FRICTION)
    (blocked, *_) = np.flatnonzero(whole.max(axis=(1, 2)) <= LIMIT)
    assert 0 < blocked < len(depths) - 2
    assert len(found.planes) == blocked + 2
    np.testing.assert_allclose(found.planes, whole[: blocked + 2], rtol=1e-9)
    assert np.array_equal(found.exceeding, (whole[:blocked] > LIMIT).any(axis=0))


def test_fatigue_counts_its_hydrostatic_part():
    """A constant stress of a path moves its centre: Dang Van's shear rises by the weight times two thirds of it."""
    random = np.random.default_rng(5)
    path = random.normal(0, 1e9, (6, 4, 30))
    limit = FatigueLimit()
    moved = path.copy()
    moved[:2] += -0.8e9
    np.testing.assert_allclose(
        limit.equivalent_shear(moved),
        FatigueLimit(residual=-0.8e9).equivalent_shear(path),
        atol=1e-4 * np.abs(limit.equivalent_shear(path)).max(),
    )


@pytest.mark.parametrize(
    ("stress", "words"), [(float("nan"), "finite"), (-8e9, "yield stress"), (7.2e9, "yield stress")]
)
def test_what_a_layer_cannot_hold_is_refused(stress, words):
    with pytest.raises(InputError, match=words):
        Layer(CARBON, 2e-6, stress)
    assert Layer(CARBON, 2e-6, -7e9).residual_stress == -7e9


def test_a_body_without_it_is_the_same_body():
    assert PLAIN.without_residual_stress() is PLAIN
    assert STRESSED.without_residual_stress() == PLAIN
    assert STRESSED.residual_stress_at(2e-6) == OUTER
    assert STRESSED.residual_stress_at(2.1e-6) == INNER
    assert STRESSED.residual_stress_at(9e-6) == 0
