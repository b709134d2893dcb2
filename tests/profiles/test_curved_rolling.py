"""Rolling on a curved surface: flat limit and its order, a dense operator by vectors, a turning wheel, full sliding."""

import itertools
import math

import numpy as np
import pytest

from bem import Grid, solve_contact, solve_rolling
from bem.convolution import displacement_operator
from bem.errors import InputError, Status
from bem.kernels.half_space import rectangle_displacement
from bem.kernels.loads import Load
from bem.materials import Body, Material
from bem.profiles import curved_rolling
from bem.profiles.curved_rolling import Rolling, solve_curved_rolling
from bem.profiles.curved_surface import CurvedSurface
from bem.profiles.curved_traction import MOST_ROWS, CurvedTraction

STEEL = Material("steel", youngs_modulus=210e9, poissons_ratio=0.28)
BODIES = (Body(STEEL), Body(STEEL))
GRID = Grid((24, 20), (0.5e-3, 0.4e-3))
GAP = GRID.x[:, None] ** 2 / 0.9 + GRID.y**2 / 0.6
MOTION = Rolling((8e-4, -3e-4), 0.2, 0.0)


def bent(grid, turn, tilt=0.0):
    """A surface whose tangent turns evenly by `turn` from the middle to its side, tilted by `tilt` [rad]."""
    angle = tilt + turn * grid.y / grid.y.max()
    radius = grid.y.max() / turn if turn else math.inf
    if math.isinf(radius):
        return CurvedSurface(grid, math.cos(tilt) * grid.y, math.sin(tilt) * grid.y, angle, BODIES)
    y, z = radius * (np.sin(angle) - math.sin(tilt)), radius * (math.cos(tilt) - np.cos(angle))
    return CurvedSurface(grid, y, z, angle, BODIES)


def rolled(surface, motion=MOTION, angle=0.0, **given):
    given = {"friction": 0.3, "load": 20e3, "slip_tolerance": 1e-9, "tolerance": 1e-9} | given
    found = solve_curved_rolling(GAP, surface, angle, motion, **given)
    assert found.contact.status is found.rolling.status is Status.CONVERGED
    return found


def test_a_flat_surface_is_the_flat_solver_s_at_any_tilt():
    flat = solve_contact(GAP, displacement_operator(GRID, BODIES), load=20e3, tolerance=1e-10)
    expected = solve_rolling(
        flat, GRID, BODIES, friction=0.3, creepage=MOTION.creepage, spin=MOTION.spin, tolerance=1e-9
    )
    for tilt in (0.0, 0.6):
        found = rolled(bent(GRID, 0.0, tilt), angle=tilt)
        assert np.allclose(found.rolling.traction, expected.traction, atol=1e-6 * np.abs(expected.traction).max())
        assert found.rolling.force == pytest.approx(expected.force, rel=1e-6)
        assert found.rolling.stick_area == pytest.approx(expected.stick_area, rel=1e-12, abs=0)
        assert found.rolling.dissipated_energy == pytest.approx(expected.dissipated_energy, rel=1e-6, abs=0)
        assert found.lateral_force == pytest.approx(0, abs=1e-6)
        assert found.turns == 1


def test_small_angles_change_tractions_and_force_in_proportion():
    """The coupling goes with the sine of the angle: twice the angle changes tractions twice as much."""
    motion = Rolling((8e-4, 0.0), 0.0, 0.0)
    flat = rolled(bent(GRID, 0.0), motion)
    found = [rolled(bent(GRID, turn), motion) for turn in (0.025, 0.05, 0.1)]
    across = [float(np.linalg.norm((one.rolling.traction - flat.rolling.traction)[1])) for one in found]
    forces = [abs(one.rolling.force[0] / flat.rolling.force[0] - 1) for one in found]
    assert all(1.8 < two / one < 2.2 for one, two in itertools.pairwise(across))
    assert all(1.8 < two / one < 2.5 for one, two in itertools.pairwise(forces))
    assert forces[0] < 0.025 * 0.025


def test_a_symmetric_groove_under_longitudinal_creepage_has_no_lateral_force():
    found = rolled(bent(GRID, 0.5), Rolling((8e-4, 0.0), 0.0, 2.0))
    traction, pressure = found.rolling.traction, found.contact.pressure
    assert np.allclose(traction[0], traction[0, :, ::-1], atol=1e-6 * pressure.max())
    assert np.allclose(traction[1], -traction[1, :, ::-1], atol=1e-6 * pressure.max())
    assert np.abs(traction[1]).max() > 0.01 * pressure.max()
    assert found.rolling.force[0] < -100
    assert found.rolling.force[1] == pytest.approx(0, abs=1e-3)
    assert found.lateral_force == pytest.approx(0, abs=1e-3)
    assert 2 <= found.turns <= 8


def test_returned_pressures_and_tractions_meet_both_laws_together():
    surface = bent(GRID, 0.4, 0.2)
    motion = Rolling((8e-4, 3e-4), 0.3, 2.0)
    found = rolled(surface, motion, angle=0.2)
    pressure, traction, operator = found.contact.pressure, found.rolling.traction, CurvedTraction(surface)
    touching = pressure > 0
    lifted = operator.normal_displacement(traction)
    gap = GAP + surface(pressure) + lifted - found.contact.approach * np.cos(surface.angles - 0.2)
    assert np.abs(lifted).max() > 1e-3 * GAP[touching].max()
    assert np.abs(gap[touching]).max() < 1e-8 * GAP.std()
    assert gap.min() > -1e-8 * GAP.std()
    assert np.allclose(found.contact.gap, np.maximum(gap, 0.0), atol=1e-8 * GAP.std())
    moved = operator.apply(traction) + operator.displacement_under_pressure(pressure)
    slip = motion.slip_over_cell(surface, 0.2)
    slip[:, :-1] += moved[:, :-1] - moved[:, 1:]
    bound, size = 0.3 * pressure, np.hypot(*traction)
    assert (size <= bound * (1 + 1e-12)).all()
    slides = touching & found.rolling.slip.any(axis=0)
    scale = np.abs(slip[:, touching]).max()
    assert 20 < slides.sum() < touching.sum() - 20
    assert np.abs(slip[:, touching & ~slides]).max() < 1e-7 * scale
    against = slip + np.hypot(*slip) * traction / np.where(touching, bound, 1.0)
    assert np.abs(against[:, slides]).max() < 1e-6 * scale


def test_full_sliding_has_friction_times_the_local_pressures_and_both_carry_the_load():
    surface = bent(GRID, 0.4, 0.3)
    found = rolled(surface, Rolling((0.3, 0.6), 0.0, 0.0), angle=0.3)
    pressure, traction = found.contact.pressure, found.rolling.traction
    assert found.rolling.stick_area == 0
    assert np.hypot(*traction) == pytest.approx(0.3 * pressure, rel=1e-6)
    # vectors on the lower body in (x, y, z): traction along the tangents, pressure against the normals
    cosine, sine = np.cos(surface.angles), np.sin(surface.angles)
    area = GRID.cell_area
    y = area * float((traction[1] * cosine - pressure * sine).sum())
    z = area * float((traction[1] * sine + pressure * cosine).sum())
    assert found.rolling.force[0] == pytest.approx(area * traction[0].sum(), rel=1e-12)
    assert -y * math.sin(0.3) + z * math.cos(0.3) == pytest.approx(20e3, rel=1e-8)
    across = y * math.cos(0.3) + z * math.sin(0.3)
    assert found.rolling.force[1] + found.lateral_force == pytest.approx(across, rel=1e-9)
    assert found.contact.load == pytest.approx(20e3, rel=1e-8)
    again = rolled(surface, Rolling((0.3, 0.6), 0.0, 0.0), angle=0.3, load=None, approach=found.contact.approach)
    assert again.contact.load == pytest.approx(20e3, rel=1e-6)


def test_operators_are_those_of_turned_vectors():
    """Each row's half-space in vectors, without transforms: displacements of the first body against the second."""
    grid = Grid((5, 6), (0.6e-3, 0.5e-3))
    angle = 0.4 + 160 * grid.y + 6e4 * grid.y**2
    steps = 0.5 * (angle[1:] + angle[:-1])
    y = np.concatenate([[0.0], np.cumsum(np.cos(steps) * grid.spacing[1])])
    z = np.concatenate([[0.0], np.cumsum(np.sin(steps) * grid.spacing[1])])
    operator = CurvedTraction(CurvedSurface(grid, y, z, angle, BODIES))
    generator = np.random.default_rng(5)
    traction, pressure = generator.normal(size=(2, *grid.shape)), generator.random(grid.shape)

    def frame(row):
        tangent = np.array([0.0, math.cos(angle[row]), math.sin(angle[row])])
        return np.array([1.0, 0, 0]), tangent, np.array([0.0, -math.sin(angle[row]), math.cos(angle[row])])

    expected = np.zeros((2, 3, *grid.shape))  # of tractions, of pressures; along x, tangent, into the bodies
    dx, dy = grid.spacing
    for (i, j), (k, m) in itertools.product(np.ndindex(grid.shape), repeat=2):
        along = grid.x[i] - grid.x[k]
        beside = math.copysign(math.hypot(y[j] - y[m], z[j] - z[m]), j - m)
        x_axis, tangent, inwards = frame(m)
        by_x = rectangle_displacement(along, beside, 0.0, (dx, dy), STEEL, Load.TANGENTIAL)
        by_s = rectangle_displacement(beside, along, 0.0, (dy, dx), STEEL, Load.TANGENTIAL)
        qx, qs = traction[:, k, m]
        moved = 2 * ((qx * by_x[0] + qs * by_s[1]) * x_axis + (qx * by_x[1] + qs * by_s[0]) * tangent)
        pressed = 2 * pressure[k, m] * rectangle_displacement(along, beside, 0.0, (dx, dy), STEEL)[2] * inwards
        for part, vector in enumerate((moved, pressed)):
            expected[part, :, i, j] += [vector @ axis for axis in frame(j)]
    scale = np.abs(expected).max(axis=(1, 2, 3))
    assert np.allclose(operator.apply(traction), expected[0, :2], atol=1e-12 * scale[0])
    assert np.allclose(operator.normal_displacement(traction), expected[0, 2], atol=1e-12 * scale[0])
    assert np.allclose(operator.displacement_under_pressure(pressure), expected[1, :2], atol=1e-12 * scale[1])
    assert np.allclose(operator.surface(pressure), expected[1, 2], atol=1e-12 * scale[1])
    assert operator.count.applications == 2
    alone = np.zeros((2, *grid.shape))
    alone[:, 2, 3] = 1.0
    assert operator.apply(alone)[:, 2, 3].mean() * operator.stiffness == pytest.approx(1, rel=1e-9)


def test_the_rigid_slip_is_that_of_a_wheel_that_turns_about_its_axis():
    radius, tilt = 0.46, -0.5
    surface = bent(GRID, 0.3, tilt)
    motion = Rolling((0.0, 0.0), -math.sin(tilt) / radius, math.cos(tilt) / radius)
    slip = motion.slip_over_cell(surface, tilt) / GRID.spacing[0]
    for i, j in ((0, 0), (5, 17), (23, 9)):
        point = np.array([GRID.x[i], surface.y[j], radius + surface.z[j]])  # from the axis, z down
        wheel = np.cross([0.0, -1 / radius, 0.0], point)
        relative = np.array([-1.0, 0, 0]) - wheel  # the rail passes the axis with the rolling velocity
        angle = surface.angles[j]
        assert slip[0, i, j] == pytest.approx(relative[0], rel=1e-9, abs=1e-12)
        along = relative[1] * math.cos(angle) + relative[2] * math.sin(angle)
        assert slip[1, i, j] == pytest.approx(along, rel=1e-9, abs=1e-12)


def test_turns_that_end_early_have_not_converged(monkeypatch):
    monkeypatch.setattr(curved_rolling, "MOST_TURNS", 1)
    found = solve_curved_rolling(GAP, bent(GRID, 0.4), 0.0, MOTION, friction=0.3, load=20e3)
    assert found.contact.status is not Status.CONVERGED
    assert found.contact.residual > 1e-4


def test_too_many_rows_and_creepages_that_are_no_numbers_are_refused():
    wide = Grid((2, MOST_ROWS + 1), (1e-3, 1e-4))
    with pytest.raises(InputError, match="cells across"):
        CurvedTraction(CurvedSurface(wide, wide.y, 0 * wide.y, 0 * wide.y, BODIES))
    for motion, message in ((Rolling((math.nan, 0.0), 0.0, 0.0), "creepage"), (Rolling((0, 0), math.inf, 0), "finite")):
        with pytest.raises(InputError, match=message):
            solve_curved_rolling(GAP, bent(GRID, 0.1), 0.0, motion, friction=0.3, load=1e3)
