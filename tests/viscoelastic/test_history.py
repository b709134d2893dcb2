"""Contacts in time against Lee and Radok (1960), Ting (1966), elastic limits and the balance of energy."""

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

from bem import Grid, InputError, Layer, Material
from bem.contact import solve_contact
from bem.convolution import displacement_operator
from bem.errors import Status
from bem.materials import Body
from bem.relaxation import PronySeries
from bem.viscoelastic import follow_times

SERIES = PronySeries([0.6, 0.2], [1.0, 10.0])
RUBBER = Body(Material("rubber", youngs_modulus=1e6, poissons_ratio=0.4, relaxation=SERIES))
MODULUS = RUBBER.material.plane_strain_modulus
RADIUS, FORCE = 0.01, 0.1


def ball(cells, radius, bodies=RUBBER):
    """Gap and operator of a grid on which a contact of a radius fits."""
    grid = Grid((cells, cells), (2.6 * radius / cells,) * 2)
    return (grid.x[:, None] ** 2 + grid.y**2) / (2 * RADIUS), displacement_operator(grid, bodies)


def hertz(cubed):
    """Contact radius of a load times a compliance over the instantaneous one."""
    return (3 * RADIUS * cubed / (4 * MODULUS)) ** (1 / 3)


def test_growing_contact_under_a_step_is_lee_and_radoks():
    """a^3 = 3 R P J(t) / 4 E*; the approach is of second order in the cell, the area near it."""
    time = 5.0
    radius = hertz(FORCE * SERIES.creep().compliance(time))
    errors = []
    for cells in (32, 64):
        found = follow_times(*ball(cells, radius), [0, time], loads=[FORCE, FORCE])
        assert found.status is Status.CONVERGED
        errors.append(abs(found.approach[-1] * RADIUS / radius**2 - 1))
        assert found.imbalance < 1e-4
    assert errors[1] < 1e-4
    assert errors[1] < 0.4 * errors[0]
    assert found.contact_area[-1] == pytest.approx(math.pi * radius**2, rel=4e-3)
    assert np.all(np.diff(found.dissipated) >= 0)


def test_relaxing_load_under_a_step_of_approach():
    """A held approach keeps the contact and relaxes the load as the modulus."""
    radius = 1e-3
    gap, operator = ball(48, radius)
    found = follow_times(gap, operator, [0, 20], approaches=[radius**2 / RADIUS] * 2, accuracy=1e-4)
    relaxed = [SERIES.modulus(time) for time in found.time]
    # p(t) / p(0) is E(t): in each step the pressure is linear
    assert found.load / found.load[0] == pytest.approx(relaxed, abs=2e-4)
    assert found.load[0] == pytest.approx(4 / 3 * MODULUS * radius**3 / RADIUS, rel=2e-3)


def ting_radius(time, rise):
    """Contact radius under a load that rises and falls back in `rise` each (Ting 1966), by quadrature."""
    creep, rate = SERIES.creep(), FORCE / rise

    def growth(s):
        """d a^3 / ds over 3 R / 4 E* while the load rises."""
        return rate * creep.compliance(s)

    def missed(first):
        held = quad(lambda s: SERIES.modulus(time - s) * growth(s), 0, first, epsabs=0, epsrel=1e-12)[0]
        return held - rate * (2 * rise - time)

    first = brentq(missed, 0, rise, xtol=1e-13)
    return hertz(quad(growth, 0, first, epsabs=0, epsrel=1e-12)[0])


def test_shrinking_contact_is_tings():
    """Order between one and two in the step where contact shrinks; the radius within 0.5 % at 64 cells."""
    rise, time = 1.0, 1.4
    radius = ting_radius(time, rise)
    gap, operator = ball(64, 1.15 * hertz(FORCE * SERIES.creep().compliance(rise / 2)))
    loads = [0.0, FORCE, FORCE * (2 - time)]
    errors = []
    best = follow_times(gap, operator, [0, rise, time], loads=loads, steps=np.linspace(0, 2, 321))
    for count in (20, 40, 80):
        found = follow_times(gap, operator, [0, rise, time], loads=loads, steps=np.linspace(0, 2, count + 1))
        errors.append(abs(found.approach[-1] / best.approach[-1] - 1))
    assert math.sqrt(best.contact_area[-1] / math.pi) == pytest.approx(radius, rel=5e-3)
    assert errors[2] < errors[0] / 2**2.4  # order 1.2 or more over two halvings
    assert errors[2] < 1e-3


def test_very_fast_and_very_slow_paths_are_elastic():
    gap, operator = ball(32, 1.2 * hertz(5 * FORCE))
    stiff = solve_contact(gap, operator, load=FORCE)
    fast = follow_times(gap, operator, [0, 1e-6], loads=[FORCE, FORCE])
    assert fast.approach[-1] == pytest.approx(stiff.approach, rel=1e-5)
    soft = Body(Material("relaxed", youngs_modulus=1e6 * (1 - sum(SERIES.shares)), poissons_ratio=0.4))
    slow = follow_times(gap, operator, [0, 1e4], loads=[FORCE, FORCE])
    relaxed = solve_contact(gap, displacement_operator(operator.grid, soft), load=FORCE)
    assert slow.last.pressure == pytest.approx(relaxed.pressure, abs=1e-5 * relaxed.maximum_pressure)


def test_two_bodies_add_their_compliances():
    """Two equal bodies approach each other twice as far under the same pressure as one of half the compliance."""
    gap, operator = ball(32, hertz(4 * FORCE))
    double = Body(Material("two", youngs_modulus=2e6, poissons_ratio=0.4, relaxation=SERIES))
    pair = displacement_operator(operator.grid, (double, double))
    one, two = (follow_times(gap, each, [0, 2], loads=[FORCE, FORCE]) for each in (operator, pair))
    assert two.approach == pytest.approx(one.approach, rel=1e-7)
    rigid = Body(Material("steel", youngs_modulus=1e12, poissons_ratio=0.3))
    beside = displacement_operator(operator.grid, (rigid, RUBBER))
    assert follow_times(gap, beside, [0, 2], loads=[FORCE] * 2).approach[-1] == pytest.approx(
        one.approach[-1], rel=1e-5
    )


def test_a_fluid_flows_on_a_periodic_grid_and_energy_balances():
    grid = Grid((32, 32), (1e-5 / 32, 1e-5 / 32), periodic=(True, True))
    x = 2 * math.pi * grid.x / grid.lengths[0]
    gap = 1e-7 * (2 - np.cos(x)[:, None] - np.cos(x)[None, :])
    pitch = Body(Material("pitch", youngs_modulus=1e9, poissons_ratio=0.4, relaxation=PronySeries.maxwell(1.0)))
    load = 0.2 * 1e9 * 1e-7 / 1e-5 * grid.area
    found = follow_times(gap, displacement_operator(grid, pitch), [0, 2, 4], loads=[load, load, 0.5 * load])
    assert found.status is Status.CONVERGED
    assert found.contact_area[-1] > 1.5 * found.contact_area[0]
    assert found.imbalance < 2e-3


def test_what_is_not_modelled_is_refused():
    gap, operator = ball(16, 1e-3)
    elastic = Material("elastic", youngs_modulus=1e6, poissons_ratio=0.4)
    with pytest.raises(InputError, match="no body relaxes"):
        follow_times(gap, displacement_operator(operator.grid, Body(elastic)), [0], loads=[1.0])
    coated = Body(RUBBER.material, layer=Layer(elastic, 1e-4))
    with pytest.raises(InputError, match="layers"):
        follow_times(gap, displacement_operator(operator.grid, coated), [0], loads=[1.0])
    with pytest.raises(InputError, match="must not fall"):
        follow_times(gap, operator, [1, 0], loads=[1.0, 1.0])
    with pytest.raises(InputError, match="exactly one"):
        follow_times(gap, operator, [0])
