"""Adhesive contacts against closed forms: Maugis, Bradley, Johnson-Kendall-Roberts, Johnson's wave, the hard wall."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bem import Grid, InputError, Material
from bem.adhesion import DugdaleAdhesion, ExponentialAdhesion, follow_path, solve_adhesive_contact
from bem.contact import solve_contact
from bem.convolution import displacement_operator
from bem.errors import Status
from bem.materials import Body

STEEL = Body(Material("elastic", youngs_modulus=70e9, poissons_ratio=0.3))
MODULUS = STEEL.material.plane_strain_modulus
RADIUS, WORK = 1e-6, 0.05
STIFFNESS = 4 / 3 * MODULUS
SIZE = (math.pi * WORK * RADIUS**2 / STIFFNESS) ** (1 / 3)
"""Maugis' unit of the contact radius [m]."""
DEPTH = (math.pi**2 * WORK**2 * RADIUS / STIFFNESS**2) ** (1 / 3)
FORCE = math.pi * WORK * RADIUS


def range_of(maugis):
    """Range of the attraction [m] at Maugis' parameter lambda = 2 strength (R / (pi w K^2))^(1/3)."""
    return 2 * WORK / maugis * (RADIUS / (math.pi * WORK * STIFFNESS**2)) ** (1 / 3)


def maugis_state(parameter, ratio):
    """Contact radius, load and approach of Maugis (1992), in his units, by the outer over the inner radius."""
    root, angle = math.sqrt(ratio**2 - 1), math.acos(1 / ratio)
    square = parameter / 2 * (root + (ratio**2 - 2) * angle)
    linear = 4 * parameter**2 / 3 * (root * angle - ratio + 1)
    radius = (-linear + math.sqrt(linear**2 + 4 * square)) / (2 * square)
    load = radius**3 - parameter * radius**2 * (root + ratio**2 * angle)
    return radius, load, radius**2 - 4 / 3 * radius * parameter * root


def sphere(cells, width):
    grid = Grid((cells, cells), (width * SIZE / cells,) * 2)
    gap = (grid.x[:, None] ** 2 + grid.y[None, :] ** 2) / (2 * RADIUS)
    return gap, displacement_operator(grid, STEEL)


def dugdale_error(cells, ratio, parameter=1.0):
    radius, load, approach = maugis_state(parameter, ratio)
    gap, operator = sphere(cells, 5.0)
    law = DugdaleAdhesion(WORK, range_of(parameter))
    # from contact: the state of the outer branch
    found = follow_path(gap, operator, law, approaches=[1.5 * DEPTH, approach * DEPTH]).last
    assert found.status is Status.CONVERGED
    area = found.contact.contact_area / (math.pi * (radius * SIZE) ** 2)
    return abs(found.load / FORCE - load), abs(area - 1)


@pytest.mark.parametrize("ratio", [1.2, 1.6])
def test_dugdales_attraction_gives_maugis_sphere(ratio):
    """At 128 cells the zone is 3 to 10 cells wide; load and area are near second order in the cell."""
    coarse, fine = (dugdale_error(cells, ratio) for cells in (64, 128))
    assert fine[0] < 0.01  # of pi w R
    assert fine[1] < 0.01
    assert fine[0] < 0.7 * coarse[0] + 1e-3
    assert fine[1] < 0.7 * coarse[1] + 1e-3


def test_short_ranges_approach_johnson_kendall_and_roberts():
    """Pull-off at a prescribed load: 1.5 pi w R, and the radius at zero load (6 pi w R^2 / K)^(1/3)."""
    gap, operator = sphere(128, 4.0)
    law = ExponentialAdhesion(WORK, range_of(3.0))
    free = follow_path(gap, operator, law, loads=[FORCE, 0.0]).last
    radius = math.sqrt(free.contact.contact_area / math.pi) / SIZE
    assert radius == pytest.approx(6 ** (1 / 3), rel=0.05)  # Maugis' own at lambda = 3 is 3 % lower
    pulled = follow_path(gap, operator, law, loads=[FORCE, 0.0, -FORCE, -1.4 * FORCE, -1.7 * FORCE])
    assert pulled.status is Status.INFEASIBLE  # it bears 1.4 and not 1.7 pi w R
    assert pulled.lowest_load == pytest.approx(-1.4 * FORCE, rel=1e-5)


@pytest.mark.parametrize("apart", [0.0, 0.7])
def test_rigid_spheres_attract_each_other_as_bradleys(apart):
    """2 pi w R exp(-d / range) at the distance d, from the integral over a paraboloid."""
    reach = 1e-9
    width = 14 * math.sqrt(2 * RADIUS * reach)  # exp(-49 / 2) of the attraction at the border is left out
    grid = Grid((96, 96), (width / 96,) * 2)
    gap = (grid.x[:, None] ** 2 + grid.y[None, :] ** 2) / (2 * RADIUS)
    stiff = Body(Material("stiff", youngs_modulus=1e16, poissons_ratio=0.3))
    found = solve_adhesive_contact(
        gap, displacement_operator(grid, stiff), ExponentialAdhesion(WORK, reach), approach=-apart * reach
    )
    # the midpoint rule of a Gaussian is exact; the centre is between cells
    assert found.load == pytest.approx(-2 * FORCE * math.exp(-apart), rel=1e-4)


def test_adhesive_wave_is_johnsons():
    """A rigid wave on a half-space, short range: p = p* sin^2(pi a / L) - sqrt(2 E* w tan(pi a / L) / L)."""
    length, cells = 1e-6, 512
    grid = Grid((cells, 1), (length / cells, length), periodic=(True, True))
    height = 2e-9
    gap = height * (1 - np.cos(2 * np.pi * grid.x[:, None] / length))
    full = math.pi * MODULUS * height / length
    half = 0.3 * length
    tangent = math.tan(math.pi * half / length)
    work = (0.2 * full) ** 2 * length / (2 * MODULUS * tangent)
    pressure = full * math.sin(math.pi * half / length) ** 2 - 0.2 * full
    zone = 12 * length / cells
    law = DugdaleAdhesion(work, work / math.sqrt(math.pi * MODULUS * work / (4 * zone)))
    operator = displacement_operator(grid, STEEL)
    found = solve_adhesive_contact(gap, operator, law, load=pressure * grid.area)
    assert found.status is Status.CONVERGED
    # the zone of 12 cells belongs to neither side: half of it at each edge, of 154 cells
    assert found.contact.contact_area / grid.area == pytest.approx(2 * half / length, abs=zone / length)


def test_weak_attraction_is_the_contact_without_it():
    gap, operator = sphere(64, 5.0)
    law = ExponentialAdhesion(1e-9, 1e-9)
    hard = solve_contact(gap, operator, load=3 * FORCE)
    found = solve_adhesive_contact(gap, operator, law, load=3 * FORCE)
    assert found.contact.pressure == pytest.approx(hard.pressure, abs=1e-5 * hard.maximum_pressure)
    assert found.load == pytest.approx(3 * FORCE, rel=1e-9)


def test_load_and_approach_find_the_same_state():
    gap, operator = sphere(64, 5.0)
    law = ExponentialAdhesion(WORK, range_of(0.5))
    one = solve_adhesive_contact(gap, operator, law, approach=0.5 * DEPTH, tolerance=1e-8)
    other = solve_adhesive_contact(gap, operator, law, load=one.load, start=one, tolerance=1e-8)
    assert other.contact.approach == pytest.approx(one.contact.approach, rel=1e-6)
    moved = solve_adhesive_contact(gap, operator, law, load=0.5 * FORCE, start=one, tolerance=1e-8)
    back = solve_adhesive_contact(gap, operator, law, load=one.load, start=moved, tolerance=1e-8)
    assert back.contact.approach == pytest.approx(one.contact.approach, rel=1e-5)


def test_approach_and_retraction_differ_and_jumps_are_told():
    """Lambda 3: the sphere jumps in, and off at a larger distance; Maugis' unstable branch is between."""
    gap, operator = sphere(96, 5.0)
    law = ExponentialAdhesion(WORK, range_of(2.5))
    distance = np.array([-1.4, -1.1, -0.8, -0.5, -0.2, -0.5, -0.8, -1.1, -1.4])
    path = follow_path(gap, operator, law, approaches=list(distance * DEPTH))
    assert path.status is Status.CONVERGED
    assert path.jumped.any()
    assert path.jumped[4:].any()
    touching = path.contact_area > 0
    assert not touching[0]
    assert not touching[-1]
    assert touching[6]
    assert path.load[[0, 3]] == pytest.approx(path.load[[8, 5]], rel=1e-4)
    # no work is gained in a closed path
    work = np.sum(0.5 * (path.load[1:] + path.load[:-1]) * np.diff(path.approach))
    assert work > 0


def test_smooth_steps_do_not_jump_and_balance_energy():
    gap, operator = sphere(64, 6.0)
    law = ExponentialAdhesion(WORK, range_of(0.3))
    path = follow_path(gap, operator, law, approaches=list(np.linspace(-0.5, 1.0, 9) * DEPTH), tolerance=1e-8)
    assert not path.jumped.any()
    work = np.sum(0.5 * (path.load[1:] + path.load[:-1]) * np.diff(path.approach))
    # the trapezoidal rule over eight steps; discrete energy and load agree otherwise
    assert path.energy[-1] - path.energy[0] == pytest.approx(work, rel=0.02)


@settings(max_examples=12, deadline=None)
@given(st.integers(0, 10**6), st.floats(0.05, 0.8), st.booleans())
def test_the_state_is_recomputed_from_itself(seed, parameter, periodic):
    """Gap and law agree, pressures act where the gap is zero, and the load is their sum, for any rough surface."""
    grid = Grid((32, 24), (SIZE / 6, SIZE / 5), periodic=(periodic, periodic))
    gap = 3 * DEPTH * np.random.default_rng(seed).random(grid.shape)
    operator = displacement_operator(grid, STEEL)
    law = ExponentialAdhesion(WORK, range_of(parameter))
    load = 2 * FORCE
    found = solve_adhesive_contact(gap, operator, law, load=load)
    assert found.status is Status.CONVERGED
    deformed = gap + operator(found.traction) - found.contact.approach
    assert deformed.min() > -1e-6 * law.range
    assert found.attraction == pytest.approx(law.traction(deformed, grid), abs=3e-6 * law.strength)
    assert np.all(deformed[found.contact.pressure > 1e-6 * law.strength] < 1e-6 * law.range)
    assert found.traction.sum() * grid.cell_area == pytest.approx(load, rel=1e-6)


def test_refuses_what_it_cannot_solve():
    gap, operator = sphere(16, 5.0)
    law = ExponentialAdhesion(WORK, 1e-9)
    with pytest.raises(InputError, match="exactly one of load and approach"):
        solve_adhesive_contact(gap, operator, law)
    with pytest.raises(InputError, match="exactly one of loads and approaches"):
        follow_path(gap, operator, law, loads=[])
    with pytest.raises(InputError, match="work"):
        ExponentialAdhesion(-1.0, 1e-9)
    assert solve_adhesive_contact(gap, operator, law, load=-FORCE).status is Status.INFEASIBLE


@pytest.mark.parametrize(("law", "ends"), [(DugdaleAdhesion, True), (ExponentialAdhesion, False)])
def test_words_on_the_attraction_beyond_its_range_are_those_of_the_law(law, ends):
    found = law(work=0.05, range=1e-8).traction(np.full((2, 2), 3e-8), Grid((2, 2), (1e-6, 1e-6)))
    assert (found == 0).all() == (law.beyond_range == "zero at gaps beyond its range") == ends
