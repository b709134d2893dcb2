"""Transient rolling: from Cattaneo to Carter against series, to the steady state, and by its certificate."""

import numpy as np
import pytest

from bem import Body, Grid, InfeasibleError, InputError, Material, solve_partial_slip, solve_rolling
from bem.reference_solutions.partial_slip import RollingCylinder
from bem.reference_solutions.rolling_cylinder import TransientRollingCylinder
from bem.tangential import solve_transient_rolling, tangential_operator
from bem.tangential.friction_laws import RationallyFallingFriction, TrescaFriction

STEEL = Body(Material("steel", youngs_modulus=200e9, poissons_ratio=0.3))
SOFT = Body(Material("soft", youngs_modulus=5e9, poissons_ratio=0.1))
HALF, RADIUS, SHARE, FRICTION = 1e-4, 1e-2, 0.6, 0.3
PLACES = HALF * np.array([0.2, 0.5, 1.0, 2.0, 3.0])


def line(cells):
    grid = Grid((cells, 1), (2.2 * HALF / cells, 1e-3), periodic=(False, True))
    x = grid.x - grid.x.mean()
    peak = HALF * STEEL.material.plane_strain_modulus / (4 * RADIUS)
    return grid, peak * np.sqrt(np.maximum(1 - (x / HALF) ** 2, 0))[:, None], peak


def from_cattaneo(cells):
    """Roll over five half-widths under a constant force: history, its creepage at `PLACES`."""
    grid, pressure, _ = line(cells)
    force = np.array([SHARE * FRICTION * float(pressure.sum()) * grid.cell_area, 0.0])
    bodies = (STEEL, STEEL)
    pushed = solve_partial_slip(pressure, grid, bodies, friction=FRICTION, force=force)
    steps = round(5 * HALF / grid.spacing[0])
    history = solve_transient_rolling(
        pressure, grid, bodies, friction=FRICTION, force=np.tile(force, (steps, 1)), start=pushed
    )
    assert history.status == "converged"
    middle = history.distance - 0.5 * grid.spacing[0]
    return grid, pressure, force, history, np.interp(PLACES, middle, history.creepage[:, 0])


def series(steps):
    """Creepage at `PLACES` by series, over Carter's."""
    modulus = STEEL.material.plane_strain_modulus / 2
    peak = HALF * modulus / (2 * RADIUS)
    own = TransientRollingCylinder(HALF, peak, modulus, FRICTION, SHARE, terms=100)
    middle = (np.arange(steps) + 0.5) * 5 * HALF / steps
    return np.interp(PLACES, middle, own.creepage(5 * HALF, steps))


@pytest.fixture(scope="module")
def rolled():
    return from_cattaneo(44)


def test_from_cattaneo_to_carter_by_series(rolled):
    """Creepage starts at half of Carter's, rises to 1.2 of it after half a contact, and ends there.

    Edges of contact and of cells coincide. The series are of first order in their step: extrapolated from 100 and 200
    steps to 3e-3.
    """
    carter = RollingCylinder(HALF, RADIUS, 1.0, FRICTION).creepage(SHARE)
    coarse, fine = series(100) / carter, series(200) / carter
    want = 2 * fine - coarse
    assert np.abs(want - coarse).max() < 0.025
    found = rolled[4] / carter
    coarser = from_cattaneo(22)[4] / carter
    error, before = np.abs(found - want).max(), np.abs(coarser - want).max()
    assert error < 0.025
    assert error < 0.65 * before  # first order
    assert found.max() > 1.17


def test_a_long_history_ends_in_the_steady_state(rolled):
    grid, pressure, force, history, _ = rolled
    steady = solve_rolling(pressure, grid, (STEEL, STEEL), friction=FRICTION, force=force)
    assert history.creepage[-1, 0] == pytest.approx(steady.creepage[0], rel=1e-3)
    assert history.last.stick_area == pytest.approx(steady.stick_area, rel=1e-9)
    assert np.abs(history.last.traction - steady.traction).max() < 2e-3 * steady.traction.max()
    assert history.friction_work[-1] == pytest.approx(steady.dissipated_energy / grid.spacing[0], rel=1e-3)


def ball(cells=16):
    grid = Grid((cells, cells), (2.4e-3 / cells,) * 2)
    x, y = grid.x - grid.x.mean(), grid.y - grid.y.mean()
    return grid, 1e9 * np.sqrt(np.maximum(1 - (x[:, None] ** 2 + y**2) / 1e-6, 0))


def test_creepage_spin_and_unlike_bodies_end_in_their_steady_state():
    grid, pressure = ball()
    asked = {"friction": 0.2, "spin": 1.0}
    history = solve_transient_rolling(pressure, grid, (STEEL, SOFT), creepage=np.tile([2e-3, 1e-3], (80, 1)), **asked)
    steady = solve_rolling(pressure, grid, (STEEL, SOFT), creepage=(2e-3, 1e-3), **asked)
    assert history.status == "converged"
    np.testing.assert_allclose(history.force[-1], steady.force, rtol=1e-4)
    assert np.abs(history.last.traction - steady.traction).max() < 1e-3 * np.abs(steady.traction).max()


def test_each_step_obeys_coulomb_s_law():
    """Slip formed here from two steps of a changing creepage; tractions under a shear strength."""
    grid, pressure = ball()
    creepage = np.stack([2e-3 * np.sin(np.linspace(0, 6, 12)), np.full(12, 5e-4)], axis=1)
    law, states = TrescaFriction(1e8), []
    for steps in (11, 12):
        history = solve_transient_rolling(pressure, grid, (STEEL, STEEL), friction=law, creepage=creepage[:steps])
        assert history.status == "converged"
        states.append(history.last.traction)
    operator = tangential_operator(grid, (STEEL, STEEL))
    before, now = operator(states[0]), operator(states[1])
    slip = now.copy()
    slip[:, :-1] -= before[:, 1:]
    slip += creepage[-1][:, None, None] * grid.spacing[0]
    touches, size = pressure > 0, np.hypot(*states[1])
    assert (size <= 1e8 * (1 + 1e-12)).all()
    sticks, scale = touches & (size < (1 - 1e-6) * 1e8), np.abs(slip[:, touches]).max()
    assert 0 < sticks.sum() < touches.sum()
    assert np.abs(slip[:, sticks]).max() < 1e-6 * scale
    slides = touches & ~sticks
    turned = slip[0] * states[1][1] - slip[1] * states[1][0]
    assert np.abs(turned[slides]).max() < 1e-6 * scale * 1e8
    assert (slip * states[1]).sum(0)[slides].max() < 1e-6 * scale * 1e8


def test_friction_takes_no_more_than_is_put_in():
    """From rest to rest: the work of the creepages is the energy of friction, for the elastic energy comes back.

    After the creepage ends the contact rolls on and leaves its tractions behind.
    """
    grid, pressure = ball()
    creepage = np.zeros((80, 2))
    creepage[:20, 0] = 3e-3
    history = solve_transient_rolling(pressure, grid, (STEEL, STEEL), friction=0.3, creepage=creepage)
    assert np.abs(history.force[-1]).max() < 3e-3 * np.abs(history.force).max()
    # the mean of the forces before and after a step acts over it
    mean = 0.5 * (history.force + np.vstack([np.zeros(2), history.force[:-1]]))
    put_in = -float((mean * history.creepage).sum())
    assert float(history.friction_work.sum()) == pytest.approx(put_in, rel=0.02)


def test_contact_that_reaches_the_end_of_its_grid_is_that_on_a_longer_one():
    grid, pressure = ball(12)
    rows = np.flatnonzero(pressure.any(axis=1))
    short = Grid((len(rows), 12), grid.spacing)
    asked = {"friction": 0.3, "creepage": np.tile([1e-3, 0.0], (5, 1))}
    one = solve_transient_rolling(pressure, grid, (STEEL, STEEL), **asked)
    two = solve_transient_rolling(pressure[rows], short, (STEEL, STEEL), **asked)
    assert two.last.traction.shape == (2, len(rows), 12)
    np.testing.assert_allclose(two.force, one.force, rtol=1e-5, atol=1e-6 * np.abs(one.force).max())


def test_messages():
    grid, pressure = ball(8)
    rolling = {"friction": 0.3}
    with pytest.raises(InputError, match="exactly one of them"):
        solve_transient_rolling(pressure, grid, STEEL, **rolling)
    with pytest.raises(InputError, match="one row for each step"):
        solve_transient_rolling(pressure, grid, STEEL, creepage=(1e-3, 0.0), **rolling)
    with pytest.raises(InfeasibleError, match="must be less than friction x load"):
        solve_transient_rolling(pressure, grid, STEEL, force=[(1.0, 0.0), (1e9, 0.0)], **rolling)
    law = RationallyFallingFriction(0.3, 0.2, 1.0)
    with pytest.raises(InputError, match="transient rolling does not have"):
        solve_transient_rolling(pressure, grid, STEEL, friction=law, creepage=[(1e-3, 0.0)])
    still = solve_transient_rolling(np.zeros(grid.shape), grid, STEEL, creepage=[(1e-3, 0.0)], **rolling)
    assert still.status == "converged"
    assert not still.force.any()
