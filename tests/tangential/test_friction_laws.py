"""Friction laws other than Coulomb's: shear limits against Abel's closed forms, falling friction against series."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import pytest

from bem import (
    Body,
    Grid,
    InputError,
    Material,
    displacement_operator,
    solve_contact,
    solve_partial_slip,
    solve_rolling,
)
from bem.laws import laws_of
from bem.notes import has_code
from bem.notes.contact import FRICTION_NOT_UNIQUE
from bem.reference_solutions.partial_slip import LimitedBall, PushedBall, RollingCylinder
from bem.reference_solutions.rolling_cylinder import FallingRollingCylinder
from bem.tangential import tangential_operator
from bem.tangential.friction_laws import (
    CoulombFriction,
    CoulombTrescaFriction,
    ExponentiallyFallingFriction,
    RationallyFallingFriction,
    SlipFriction,
    TrescaFriction,
)

CORK = Body(Material("cork", youngs_modulus=2.0, poissons_ratio=0.0))
"""Shear modulus 1 and nu = 0, where nothing slips sideways."""
STEEL = Body(Material("steel", youngs_modulus=200e9, poissons_ratio=0.3))


def pressed_ball(cells):
    """Hertz contact of radius one: E* = 1, radius R = 40, so that it stays small."""
    grid = Grid((cells, cells), (2.3 / cells, 2.3 / cells))
    x, y = grid.x - grid.x.mean(), grid.y - grid.y.mean()
    gap = (x[:, None] ** 2 + y**2) / (2 * 40.0)
    return (
        grid,
        solve_contact(gap, displacement_operator(grid, (CORK, CORK)), load=4 / 3 / 40.0),
        np.hypot(x[:, None], y),
    )


def limited(law):
    friction = getattr(law, "friction", np.inf)
    return LimitedBall(1.0, 4 / 3 / 40.0, friction, law.shear_limit, 4.0)


@pytest.mark.parametrize("law", [TrescaFriction(1e-3), CoulombTrescaFriction(0.3, 3e-3)])
def test_shear_limits_against_abel_s_closed_form(law):
    """Shift and force at stick radius 0.6: first order through the edge, whose cells carry the full shear strength."""
    exact, misses = limited(law), []
    for cells in (32, 128):
        grid, contact, r = pressed_ball(cells)
        solved = solve_partial_slip(contact, grid, (CORK, CORK), friction=law, force=(exact.force(0.6), 0.0))
        assert solved.status == "converged"
        stick = np.sqrt(solved.stick_area / np.pi)
        misses.append([abs(solved.shift[0] / exact.shift(0.6) - 1), abs(stick - 0.6)])
        if isinstance(law, TrescaFriction):
            inner = r < 0.9
            want = exact.traction(r[inner], 0.6)
            assert np.abs(solved.traction[0][inner] - want).mean() < 1 / cells * law.shear_limit
    assert misses[1][0] < 4e-3
    assert misses[1][1] < 0.01
    assert misses[1][0] < 0.5 * misses[0][0]


def test_closed_forms_agree_in_their_limits():
    """Without a reached limit it is Mindlin's ball; the force of full sliding is the integral of the bound."""
    coulomb, stick = LimitedBall(1.0, 2.0, 0.3, 1e6, 4.0), 0.4
    mindlin = PushedBall(1.0, 2.0, 0.3, 4.0)
    assert mindlin.stick_radius(coulomb.force(stick)) == pytest.approx(stick, rel=1e-9)
    assert coulomb.shift(stick) == pytest.approx(mindlin.shift(coulomb.force(stick)), rel=1e-9)
    assert LimitedBall(1.0, 2.0, np.inf, 0.2, 4.0).force(0.0) == pytest.approx(0.2 * np.pi, rel=1e-9)
    assert LimitedBall(1.0, 2.0, 1e3, 0.2, 4.0).force(0.5) == pytest.approx(
        LimitedBall(1.0, 2.0, np.inf, 0.2, 4.0).force(0.5), rel=1e-5
    )
    both, peak = LimitedBall(1.0, 2.0, 0.3, 0.15, 4.0), 1.5 * 2.0 / np.pi
    edge = np.sqrt(1 - (0.15 / (0.3 * peak)) ** 2)
    slid = 0.15 * np.pi * edge**2 + 0.3 * 2.0 * (1 - edge**2) ** 1.5
    assert both.force(0.0) == pytest.approx(slid, rel=1e-9)


def test_sliding_force_of_a_shear_strength_is_that_of_the_area_inside_cells():
    grid, contact, _ = pressed_ball(24)
    solved = solve_partial_slip(contact, grid, (CORK, CORK), friction=TrescaFriction(1e-3), shift=(1.0, 0.0))
    assert solved.stick_area == 0
    assert solved.force[0] == pytest.approx(1e-3 * contact.contact_area, rel=1e-9)
    assert abs(contact.counted_area / contact.contact_area - 1) > 1e-3


def test_coulomb_as_a_law_is_a_number():
    grid, contact, _ = pressed_ball(24)
    asked = {"force": (2e-3, 1e-3)}
    one = solve_partial_slip(contact, grid, (CORK, CORK), friction=0.3, **asked)
    two = solve_partial_slip(contact, grid, (CORK, CORK), friction=CoulombFriction(0.3), **asked)
    np.testing.assert_allclose(two.traction, one.traction, rtol=1e-9, atol=1e-9 * one.traction.max())
    rolled = [solve_rolling(contact, grid, CORK, friction=f, creepage=(1e-3, 0.0)) for f in (0.3, CoulombFriction(0.3))]
    np.testing.assert_allclose(rolled[1].force, rolled[0].force, rtol=1e-7, atol=1e-12)


def line(cells, half_width=1e-4, radius=1e-2):
    """A cylinder's Hertz pressure in plane strain on one row; the edges of 500 cells are those of cells."""
    grid = Grid((cells, 1), (2.2 * half_width / cells, 1e-3), periodic=(False, True))
    x = grid.x - grid.x.mean()
    peak = half_width * STEEL.material.plane_strain_modulus / (4 * radius)
    return grid, peak * np.sqrt(np.maximum(1 - (x / half_width) ** 2, 0))[:, None], peak


def series(law, peak, speed, terms=400):
    modulus = STEEL.material.plane_strain_modulus / 2
    return FallingRollingCylinder(
        1e-4, peak, modulus, lambda slip: law.traction_bound(np.ones_like(slip), speed * slip), terms
    )


def test_series_of_constant_friction_are_carter_s():
    _, _, peak = line(10)
    carter, own = RollingCylinder(1e-4, 1e-2, peak, 0.3), series(CoulombFriction(0.3), peak, 1.0)
    creepage, force = own.rolling(0.5)
    assert creepage == pytest.approx(carter.creepage(0.75), rel=1e-9)
    assert force == pytest.approx(0.3 * 0.75, rel=1e-9)
    assert own.sliding(-0.01) == pytest.approx(0.3, rel=1e-9)


@pytest.mark.parametrize("law", [RationallyFallingFriction, ExponentiallyFallingFriction])
def test_carter_s_cylinder_with_falling_friction(law):
    """Force over creepage, with a maximum: within 5e-4 of the series on 500 cells (Carter's own: within 1.5e-4)."""
    law, speed = law(0.3, 0.15, 0.02), 4.0
    grid, pressure, peak = line(500)
    total, own = float(pressure.sum()) * grid.cell_area, series(law, peak, speed)
    points = [own.rolling(stick) for stick in (0.5, 0.2)] + [(-xi, own.sliding(-xi)) for xi in (4e-3, 2e-2)]
    forces = []
    for creepage, force in points:
        solved = solve_rolling(pressure, grid, (STEEL, STEEL), friction=law, speed=speed, creepage=(creepage, 0.0))
        assert solved.status == "converged"
        assert solved.iterations <= (16 if creepage > -4e-3 else 6)  # Newton steps: 12 to 14, and 4 where all slips
        assert not has_code(solved.notes, FRICTION_NOT_UNIQUE)
        forces.append(solved.force[0] / total)
        assert forces[-1] == pytest.approx(force, rel=5e-4)
    assert max(forces) == forces[1]
    assert forces[-1] < 0.75 * forces[1]


def test_falling_friction_holds_by_the_slip_of_the_result():
    """Bound formed here from the slip over a cell; with spin, where directions turn."""
    grid = Grid((24, 20), (1e-4, 1.2e-4))
    x, y = grid.x - grid.x.mean(), grid.y - grid.y.mean()
    pressure = 1e9 * np.sqrt(np.maximum(1 - (x[:, None] ** 2 + y**2) / 1e-6, 0))
    law = ExponentiallyFallingFriction(0.4, 0.2, 0.05)
    asked = {"friction": law, "creepage": (2e-3, 1e-3), "spin": 2.0}
    solved = solve_rolling(pressure, grid, (STEEL, STEEL), speed=20.0, **asked)
    assert solved.status == "converged"
    moved = tangential_operator(grid, (STEEL, STEEL))(solved.traction)
    slip = moved.copy()
    slip[:, :-1] -= moved[:, 1:]
    slip[0] += (2e-3 - 2.0 * y[None, :]) * 1e-4
    slip[1] += (1e-3 + 2.0 * x[:, None]) * 1e-4
    touches, size = pressure > 0, np.hypot(*solved.traction)
    speed = 20.0 * np.hypot(*slip) / 1e-4
    bound = np.where(touches, (0.2 + 0.2 * 2 ** (-speed / 0.05)) * pressure, 0.0)
    slips = touches & (speed > 1e-6 * speed.max())
    np.testing.assert_allclose(size[slips], bound[slips], rtol=1e-5)
    assert (size[touches] <= bound[touches] * (1 + 1e-5)).all()
    assert slips.any()
    assert (touches & ~slips).any()
    # slower rolling has less slip speed, and so more friction
    slow = solve_rolling(pressure, grid, (STEEL, STEEL), speed=0.2, **asked)
    assert np.hypot(*slow.force) > 1.1 * np.hypot(*solved.force)


def test_steeply_falling_friction_says_that_it_may_not_be_unique():
    grid, pressure, _ = line(100)
    law = RationallyFallingFriction(0.3, 0.15, 1e-3)
    solved = solve_rolling(pressure, grid, (STEEL, STEEL), friction=law, speed=1.0, creepage=(-1e-3, 0.0))
    assert has_code(solved.notes, FRICTION_NOT_UNIQUE)


@pytest.mark.parametrize("name", [name for name, law in laws_of("slip_friction").items() if law.depends_on_speed])
def test_falling_laws_have_half_of_the_difference_at_their_speed_and_its_derivative(name):
    law = laws_of("slip_friction")[name](0.5, 0.1, 0.2)
    pressure, speed = np.full(4, 3.0), np.array([0.0, 0.2, 0.3, 5.0])
    bound = law.traction_bound(pressure, speed)
    assert bound[:2] == pytest.approx([1.5, 0.9], rel=1e-12)
    assert (np.diff(bound) < 0).all()
    step = 1e-6
    difference = (law.traction_bound(pressure, speed + step) - bound) / step
    np.testing.assert_allclose(law.slope(pressure, speed), difference, rtol=1e-4, atol=1e-6)
    np.testing.assert_allclose(SlipFriction.slope(law, pressure, speed), difference, rtol=1e-3, atol=1e-6)


@dataclass(frozen=True)
class RootFriction(SlipFriction):
    """A law of one's own: friction that grows with the root of the pressure."""

    name: ClassVar[str] = "root"

    def traction_bound(self, pressure, slip_speed):
        return 1e-3 * np.sqrt(pressure / 1e-2)


def test_a_law_of_one_s_own_bounds_the_traction():
    grid, contact, _ = pressed_ball(24)
    solved = solve_partial_slip(contact, grid, (CORK, CORK), friction=RootFriction(), shift=(2e-3, 0.0))
    assert solved.status == "converged"
    filled = contact.contact_area / contact.counted_area
    bound = filled * 1e-3 * np.sqrt(contact.pressure / filled / 1e-2)
    size = np.hypot(*solved.traction)
    assert (size <= bound * (1 + 1e-9)).all()
    slips = solved.slip.any(axis=0)
    assert 0 < slips.sum() < (contact.pressure > 0).sum()
    np.testing.assert_allclose(size[slips], bound[slips], rtol=1e-9)


def test_messages():
    grid, contact, _ = pressed_ball(12)
    falling = RationallyFallingFriction(0.3, 0.1, 0.1)
    with pytest.raises(InputError, match="depends on the slip speed, which partial slip does not have"):
        solve_partial_slip(contact, grid, CORK, friction=falling, shift=(1e-3, 0.0))
    with pytest.raises(InputError, match="needs the rolling speed"):
        solve_rolling(contact, grid, CORK, friction=falling, creepage=(1e-3, 0.0))
    with pytest.raises(InputError, match="several creepages may have it"):
        solve_rolling(contact, grid, CORK, friction=falling, speed=1.0, force=(1e-3, 0.0))
    with pytest.raises(InputError, match="must be positive"):
        solve_rolling(contact, grid, CORK, friction=falling, speed=-1.0)
    with pytest.raises(InputError, match="must not exceed static_friction"):
        RationallyFallingFriction(0.1, 0.3, 0.1)
