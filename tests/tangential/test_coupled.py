"""Contact and partial slip together: reciprocity, Spence's bonded ball, conditions formed anew, messages."""

import numpy as np
import pytest
from scipy.special import ellipe, ellipk

from bem import Body, Grid, InputError, Material, displacement_operator, generate_surface, solve_contact
from bem.reference_solutions.partial_slip import bonded_stiffening, spence_stick_share
from bem.tangential import solve_coupled_slip, solve_partial_slip, tangential_operator

SOFT = Body(Material("soft", youngs_modulus=1e9, poissons_ratio=0.1))
HARD = Body(Material("hard", youngs_modulus=5e9, poissons_ratio=0.3))
RADIUS = 10e-3


@pytest.mark.parametrize("periodic", [(False, False), (False, True), (True, False), (True, True)])
def test_tractions_lift_as_friction_does(periodic):
    """The adjoint of what pressure moves in the plane is the kernel of friction in the normal contact."""
    grid = Grid((24, 20), (1e-6, 1.3e-6), periodic=periodic)
    pressure = np.random.default_rng(1).random(grid.shape)
    with_friction, without = (displacement_operator(grid, (SOFT, HARD), friction=f)(pressure) for f in (0.3, 0.0))
    operator = tangential_operator(grid, (SOFT, HARD))
    lift = operator.normal_displacement(np.stack([0.3 * pressure, np.zeros(grid.shape)]))
    assert np.abs(lift - (with_friction - without)).max() < 1e-12 * np.abs(lift).max()
    turned = tangential_operator(Grid(grid.shape[::-1], grid.spacing[::-1], periodic=periodic[::-1]), (SOFT, HARD))
    across = turned.normal_displacement(np.stack([np.zeros(grid.shape[::-1]), 0.3 * pressure.T]))
    assert np.abs(across.T - lift).max() < 1e-12 * np.abs(lift).max()


def pressed(friction, steps, nu=0.0, cells=32):
    """A rigid ball on an elastic body, in steps of equal contact radius: the last, and 3/2 load / (approach a G)."""
    body = Body(Material("body", youngs_modulus=1e9, poissons_ratio=nu))
    half = (3 * RADIUS * (1 - nu**2) / (4 * 1e9)) ** (1 / 3)
    grid = Grid((cells, cells), (2.3 * half / cells,) * 2)
    x, y = grid.x - grid.x.mean(), grid.y - grid.y.mean()
    gap, found = (x[:, None] ** 2 + y**2) / (2 * RADIUS), None
    for step in range(1, steps + 1):
        asked = {"load": (step / steps) ** 3, "force": (0.0, 0.0), "tolerance": 1e-5}
        found = solve_coupled_slip(gap, grid, body, friction=friction, previous=found, **asked)
        assert found.status == "converged"
    contact = found.contact
    radius = np.sqrt(contact.contact_area / np.pi)
    return found, 1.5 * contact.load / (contact.approach * radius * body.material.shear_modulus)


@pytest.mark.parametrize("nu", [0.0, 0.3])
def test_a_ball_that_sticks_is_as_stiff_as_spence_has_it(nu):
    """Of first order in the steps: what two of them extrapolate to. Without friction 4 / (1 - nu), 9 and 3 % less."""
    (_, coarse), (found, fine) = pressed(10.0, 4, nu), pressed(10.0, 8, nu)
    exact = 4 / (1 - nu) * bonded_stiffening(nu)
    assert 2 * fine - coarse == pytest.approx(exact, rel=6e-3)
    assert abs(2 * fine - coarse - exact) < 0.25 * abs(4 / (1 - nu) - exact)
    assert found.tangential.slip_area < 0.02 * found.contact.contact_area


def sticking_share(friction, nu, coupled, rings=100):
    """Radius of what sticks over that of contact, of a rigid ball pressed on: from rings of pressure and traction.

    What grows alike at every load moves in the plane by a^2 f(r/a); what sticks keeps what it has, so f = C s^2 there.
    The rings are those of Boussinesq and Cerruti (Johnson, Contact Mechanics, 3.8): elliptic integrals for pressure on
    height and traction in the plane, sums within or without a radius for one on the other. Traction runs on smoothly
    into friction x pressure for one share only. Nothing is shared with bem.
    """
    edges = np.linspace(0, 1, rings + 1)
    r, width, fine = 0.5 * (edges[1:] + edges[:-1]), 1 / rings, (np.arange(40) + 0.5) / 40
    at, source = r[:, None, None], (edges[:-1, None] + width * fine)[None]
    low, high = np.minimum(at, source), np.maximum(at, source)
    first, second = ellipk((low / high) ** 2), ellipe((low / high) ** 2)
    height = 2 * (1 - nu**2) * (2 / np.pi * first / high * source).sum(2) * width / 40
    plane = 2 * (1 - nu**2) * (2 / np.pi * (first - second) / low * source).sum(2) * width / 40
    part = (1 - 2 * nu) * (1 + nu) * width
    within = np.tril(np.ones((rings, rings)), -1) + 0.5 * np.eye(rings)
    drawn, lifted = -part * within * r / r[:, None], -part * within.T * coupled

    def excess(stuck):
        size = rings + stuck + 2  # pressures, tractions that stick, C, approach
        system, right = np.zeros((size, size)), np.zeros(size)
        system[:rings, :rings] = height
        system[:rings, rings : rings + stuck] = lifted[:, :stuck]
        system[:rings, stuck:rings] += friction * lifted[:, stuck:]
        system[:rings, -1], right[:rings] = -1, -0.5 * r**2
        system[rings : rings + stuck, :rings] = drawn[:stuck]
        system[rings : rings + stuck, stuck:rings] += friction * plane[:stuck, stuck:]
        system[rings : rings + stuck, rings : rings + stuck] = plane[:stuck, :stuck]
        system[rings : rings + stuck, -2] = -(r[:stuck] ** 2)
        # pressure falls like a root at its edge, and the traction that sticks runs on into that which slips
        system[-1, rings - 1], system[-1, rings - 2] = 1, -np.sqrt(1 / 3)
        system[-2, [rings + stuck - 1, rings + stuck - 2, stuck]] = 2, -1, -friction
        found = np.linalg.solve(system, right)
        return found[rings + stuck - 2] / found[stuck - 2] / friction - 1

    counts = np.arange(rings // 10, rings // 2)
    values = np.array([excess(count) for count in counts])
    after = int(np.argmax(values >= 0))
    return float(np.interp(0, values[after - 1 : after + 1], counts[after - 1 : after + 1])) / rings


def test_less_sticks_under_the_pressure_that_friction_makes():
    """Rings of first order, extrapolated; they meet Spence's closed form, which leaves the pressure as it is."""
    alone, both = (2 * sticking_share(0.2, 0.0, c) - sticking_share(0.2, 0.0, c, rings=50) for c in (False, True))
    assert alone == pytest.approx(spence_stick_share(0.2 / 0.5), rel=0.01)
    found, _ = pressed(0.2, 16)
    share = np.sqrt(found.tangential.stick_area / found.contact.contact_area)
    # measured 1 %, with 14 cells to a radius and 16 steps of first order
    assert share == pytest.approx(both, rel=0.03)
    assert both < 0.75 * alone


def test_friction_draws_the_pressure_together_and_less_sticks():
    """At a given load: higher in the middle, a smaller contact; and what sticks under that pressure is less."""
    found, _ = pressed(0.2, 4)
    grid = Grid((32, 32), (2.3 * (3 * RADIUS / 4e9) ** (1 / 3) / 32,) * 2)
    body = Body(Material("body", youngs_modulus=1e9, poissons_ratio=0.0))
    x, y = grid.x - grid.x.mean(), grid.y - grid.y.mean()
    gap, alone = (x[:, None] ** 2 + y**2) / (2 * RADIUS), None
    for step in range(1, 5):
        contact = solve_contact(gap, displacement_operator(grid, body), load=(step / 4) ** 3)
        alone = solve_partial_slip(contact, grid, body, friction=0.2, force=(0.0, 0.0), previous=alone)
    assert found.contact.maximum_pressure > 1.05 * contact.maximum_pressure
    assert found.contact.contact_area < 0.98 * contact.contact_area
    assert found.tangential.stick_area < 0.7 * alone.stick_area
    assert found.contact.load == pytest.approx(contact.load, rel=1e-6)


def test_both_hold_under_each_other():
    """Rough, of unlike bodies, pushed: gap and slip formed here from pressure and tractions."""
    grid = Grid((40, 40), (1e-6, 1e-6), periodic=(True, True))
    height = generate_surface(grid, rms_height=20e-9, seed=3, correlation_length=6e-6)
    gap, load = height.max() - height, 2e6 * grid.area
    found = solve_coupled_slip(
        gap, grid, (SOFT, HARD), friction=0.5, load=load, force=(0.3 * load, 0.0), tolerance=1e-7
    )
    assert found.status == "converged"
    assert found.residual <= 1e-7
    pressure, traction = found.contact.pressure, found.tangential.traction
    operator = tangential_operator(grid, (SOFT, HARD))
    opened = gap + displacement_operator(grid, (SOFT, HARD))(pressure) + operator.normal_displacement(traction)
    touches = pressure > 0
    scale = np.abs(found.contact.displacement).max()
    middle = opened[touches].mean()
    assert np.abs(opened[touches] - middle).max() < 3e-7 * scale  # mean and middle of what is missed differ
    assert (opened - middle).min() > -3e-7 * scale
    assert np.abs(operator.normal_displacement(traction)).max() > 1e-3 * scale  # there is something to miss
    assert (np.hypot(*traction) <= 0.5 * pressure * (1 + 1e-12)).all()
    moved = operator(traction) + operator.displacement_under_pressure(pressure) - found.tangential.shift[:, None, None]
    inside = touches & (np.hypot(*traction) < 0.5 * pressure * (1 - 1e-6))
    assert inside.any()
    assert np.abs(moved[:, inside]).max() < 1e-6 * scale


def test_like_bodies_answer_in_one_round():
    grid = Grid((24, 24), (1e-5, 1e-5))
    x = grid.x - grid.x.mean()
    gap = (x[:, None] ** 2 + x**2) / (2 * RADIUS)
    found = solve_coupled_slip(gap, grid, (SOFT, SOFT), friction=0.3, load=0.1, force=(0.01, 0.0))
    contact = solve_contact(gap, displacement_operator(grid, (SOFT, SOFT)), load=0.1)
    alone = solve_partial_slip(contact, grid, (SOFT, SOFT), friction=0.3, force=(0.01, 0.0))
    assert found.rounds == 1
    assert not found.normal_displacement.any()
    assert found.tangential.shift == pytest.approx(alone.shift, rel=1e-5, abs=1e-14)


def test_what_does_not_close_in_says_so_and_messages():
    grid = Grid((16, 16), (1e-5, 1e-5))
    x = grid.x - grid.x.mean()
    gap = (x[:, None] ** 2 + x**2) / (2 * RADIUS)
    given = {"friction": 0.3, "load": 0.1, "force": (0.01, 0.0)}
    short = solve_coupled_slip(gap, grid, SOFT, **given, max_rounds=1)
    assert short.status == "max_iterations"
    assert short.residual > 1e-6
    with pytest.raises(InputError, match="max_rounds"):
        solve_coupled_slip(gap, grid, SOFT, **given, max_rounds=0)
    with pytest.raises(InputError, match="load"):
        solve_coupled_slip(gap, grid, SOFT, friction=0.3, force=(0.01, 0.0))


@pytest.mark.parametrize("share", [0.0, 1e-6, 0.5, 0.99])
def test_one_cell_in_contact_of_unlike_bodies(share):
    """The first step of a load that grows: 38 to 78 s into the limit of rounds; one cell without a force lies still."""
    grid = Grid((16, 16), (1e-6, 1e-6))
    gap = (grid.x[:, None] ** 2 + grid.y[None, :] ** 2) / (2 * 1e-5)
    gap[8, 8] -= 1e-9
    friction, load = 0.1, 1e-7
    force = (share * friction * load, 0.0)
    found = solve_coupled_slip(gap, grid, (SOFT, HARD), friction=friction, load=load, force=force)
    assert np.count_nonzero(found.contact.pressure) == 1
    assert found.status == "converged"
    assert found.tangential.iterations < 30
    assert np.abs(found.tangential.force - force).max() <= 1e-6 * friction * load
    more = solve_coupled_slip(gap, grid, (SOFT, HARD), friction=friction, load=3000 * load, force=force, previous=found)
    assert more.status == "converged"
    assert np.count_nonzero(more.contact.pressure) > 1
