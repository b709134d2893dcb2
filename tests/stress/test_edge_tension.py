"""Tension at the edge of a contact, between the centres of cells: closed forms, finite elements, order, invariance."""

import json
import math
from importlib.resources import files

import numpy as np
import pytest

from bem import Body, Grid, Layer, Material, displacement_operator, solve_contact, subsurface_stress
from bem.stress import edge_tension, highest_principal

NU = 0.3
STEEL = Material("steel", youngs_modulus=200e9, poissons_ratio=NU)
COATED_WITH_ITSELF = Body(STEEL, layers=(Layer(STEEL, 3.0),))
"""A body whose closed forms are those of a half-space, but which goes the way of layers."""
MODULUS = STEEL.plane_strain_modulus
CURVATURE = 1e-3


def surface_of(pressure, grid, body, friction):
    return subsurface_stress(pressure, grid, body, [0.0], friction=friction)[:, 0]


def tensions(gap, grid, load, friction, body=COATED_WITH_ITSELF):
    """Of a contact: at its edges, and at the centres of cells."""
    pressure = solve_contact(gap, displacement_operator(grid, Body(STEEL)), load=load, tolerance=1e-9).pressure
    surface = surface_of(pressure, grid, body, friction)
    return edge_tension(surface, pressure, grid, body, friction).tension, highest_principal(surface).max()


def cylinder(cells, friction, centre):
    """Relative errors at the edge and at points for a cylinder of so many cells to half the width, on a free axis.

    The trailing edge has 2 friction p0 (Johnson, *Contact Mechanics*, section 7.1)."""
    grid = Grid((int(2.6 * cells) + 4, 1), (1.0, 1.0), periodic=(False, True))
    top = MODULUS * cells * CURVATURE / 2
    gap = 0.5 * CURVATURE * (grid.x[:, None] - centre) ** 2
    found = tensions(gap, grid, math.pi / 2 * cells * top, friction)
    return np.array(found) / (2 * friction * top) - 1


def test_a_rubbed_cylinder_has_its_closed_form():
    """On eight places of the edge between cells."""
    errors = np.array([cylinder(6, 0.3, place) for place in np.linspace(-0.5, 0.5, 9)[:-1] + 0.01])
    assert np.abs(errors[:, 0]).max() < 0.02
    assert errors[:, 1].max() < -0.15  # of the points, which the edge lies between


def test_the_edge_is_of_a_higher_order_than_the_points():
    """Points miss a root of the cell; the edge at least the cell."""
    few, many = (
        np.abs([cylinder(cells, 0.3, place) for place in (-0.4, -0.15, 0.1, 0.35)]).max(axis=0) for cells in (5, 40)
    )
    assert few[0] / many[0] > 8
    assert few[1] / many[1] < 8**0.75


def hertz(cells, friction, centre):
    """Relative errors at the edge and at points for a ball of so many cells to the radius, on a free grid.

    The trailing edge has p0 ((1 - 2 nu) / 3 + pi friction (4 + nu) / 8) (Hamilton, Proc. IMechE 197C (1983) 53)."""
    cells_wide = int(2.6 * cells) + 4
    grid = Grid((cells_wide, cells_wide), (1.0, 1.0))
    gap = 0.5 * CURVATURE * ((grid.x[:, None] - centre[0]) ** 2 + (grid.y - centre[1]) ** 2)
    load = 4 / 3 * MODULUS * CURVATURE * cells**3
    top = 1.5 * load / (math.pi * cells**2)
    exact = top * ((1 - 2 * NU) / 3 + math.pi * friction * (4 + NU) / 8)
    return np.array(tensions(gap, grid, load, friction)) / exact - 1


@pytest.mark.parametrize("friction", [0.0, 0.1, 0.4])
def test_a_ball_has_its_closed_form(friction):
    for cells, most in ((5, 0.06), (10, 0.03)):
        for centre in ((0.1, -0.3), (0.45, 0.2)):
            edge, points = hertz(cells, friction, centre)
            assert abs(edge) < most
            assert points < -2 * most


def test_waves_have_their_closed_form():
    """A sinusoidal gap on a doubly periodic grid: under the contact the traction f p strains the surface as much as
    the pressure bends it, so that the trailing edge has friction E* times the slope of the gap there. The constrained
    mean state has -nu / (1 - nu) of the mean pressure in place of -1 (Westergaard; Johnson, section 13.2)."""
    grid, height, friction = Grid((64, 1), (1.0, 1.0), periodic=(True, True)), 1e-3, 0.3
    for half in (9.8, 10.0, 10.3):
        mean = math.pi * MODULUS * height / 64 * math.sin(math.pi * half / 64) ** 2
        gap = height * (1 - np.cos(2 * math.pi * grid.x[:, None] / 64))
        edge, points = tensions(gap, grid, mean * grid.area, friction)
        slope = 2 * math.pi * height / 64 * math.sin(2 * math.pi * half / 64)
        exact = friction * MODULUS * slope + (1 - NU / (1 - NU)) * mean
        assert edge == pytest.approx(exact, rel=0.01)
        assert points < 0.92 * exact


@pytest.mark.parametrize(
    ("cells", "dy", "close"),
    [((64, 64), 1.0, 0.01), ((64, 80), 1.0, 0.015), ((64, 96), 0.6, 0.02), ((96, 64), 1.0, 0.035)],
)
def test_waves_askew_to_the_traction_have_their_closed_form(cells, dy, close):
    """As above, with the traction at 39 to 56 degrees from the wavevector: its part along the edge shears the surface
    by half of what its part across the edge strains it. Along the edge there is no strain."""
    grid, height, friction = Grid(cells, (1.0, dy), periodic=(True, True)), 1e-3, 0.3
    kx, ky = (2 * math.pi / length for length in grid.lengths)
    k = math.hypot(kx, ky)
    cosine, sine = kx / k, ky / k
    for half in (9.8, 10.3):
        mean = 0.5 * MODULUS * height * k * math.sin(0.5 * k * half) ** 2
        gap = height * (1 - np.cos(kx * grid.x[:, None] + ky * grid.y))
        edge, points = tensions(gap, grid, mean * grid.area, friction)
        rubbed = friction * MODULUS * k * height * math.sin(k * half)
        across = rubbed * cosine + (1 - NU / (1 - NU)) * mean
        along = NU * rubbed * cosine + (2 * NU - NU / (1 - NU)) * mean
        exact = 0.5 * (across + along) + math.hypot(0.5 * (across - along), 0.5 * rubbed * sine)
        assert edge == pytest.approx(exact, rel=close)
        assert points < 0.92 * exact


def test_an_edge_at_the_end_of_a_free_grid_is_left_out():
    """Beyond it no stress is known: a cylinder whose trailing edge is that of its grid."""
    grid, body, friction = Grid((30, 1), (1.0, 1.0), periodic=(False, True)), COATED_WITH_ITSELF, 0.3
    pressure = np.sqrt(np.clip(1 - ((grid.x[:, None] + 2.0) / 9.0) ** 2, 0, None)) * 1e9
    whole = edge_tension(surface_of(pressure, grid, body, friction), pressure, grid, body, friction)
    assert whole.tension == pytest.approx(2 * friction * 1e9, rel=0.03)
    cut = pressure[np.flatnonzero(pressure)[0] :]
    grid = Grid(cut.shape, (1.0, 1.0), periodic=(False, True))
    left = edge_tension(surface_of(cut, grid, body, friction), cut, grid, body, friction)
    assert left.tension < 0.1 * whole.tension  # of the leading edge, which is compressed


@pytest.mark.parametrize(
    "case", ["disc-hertz-soft", "disc-hertz-soft-thick", "disc-hertz-stiff-on-soft", "disc-hertz-low-nu-stiff-on-soft"]
)
def test_layers_agree_with_finite_elements(case):
    """A Hertzian pressure on one and two layers: the strain at its edge, from the radial displacements there."""
    stored = json.loads((files("bem.verification") / "fem_results" / f"{case}.json").read_text())
    numbers = stored["parameters"]["layer"]

    def material(modulus, poisson):
        return Material("one", youngs_modulus=modulus, poissons_ratio=poisson)

    stack = [Layer(material(*numbers[i : i + 2]), numbers[i + 2]) for i in range(0, len(numbers), 3)]
    body = Body(material(1.0, stored["parameters"]["nu"]), layers=stack)
    (moved,) = [
        one
        for one in stored["quantities"]
        if (one["name"], one["along"]) == ("tangential_displacement", "surface, y = 0")
    ]
    radius, outwards = np.array(moved["coordinates"])[:, 0], np.array(moved["values"])
    outside = np.flatnonzero(radius >= 1)[:3]
    slope = np.polyfit(radius[outside] - 1, outwards[outside], 2)[1]
    modulus, poisson = numbers[:2]
    expected = modulus / (1 - poisson**2) * (slope + poisson * outwards[outside[0]])

    grid = Grid((97, 97), (3.0 / 97, 3.0 / 97))
    pressure = np.sqrt(np.clip(1 - grid.x[:, None] ** 2 - grid.y**2, 0, None))
    pressure *= 2 / 3 * np.pi / (pressure.sum() * grid.cell_area)
    found = edge_tension(surface_of(pressure, grid, body, 0.0), pressure, grid, body)
    assert found.tension == pytest.approx(expected, rel=0.04)  # the slope of finite elements 0.05 radii apart has 2 %


def test_a_coated_balls_tension_does_not_depend_on_the_grid():
    """A layer of one and of three cells, rubbed: the edge agrees to a per cent where points differ by a tenth."""
    soft = Material("soft", youngs_modulus=150e9, poissons_ratio=0.22)
    body, found = Body(STEEL, layers=(Layer(soft, 2.0),)), []
    for cells in (22, 66):
        grid = Grid((cells, cells), (44.0 / cells,) * 2)
        gap = 0.5 * CURVATURE * (grid.x[:, None] ** 2 + grid.y**2)
        pressure = solve_contact(gap, displacement_operator(grid, body), load=4e11).pressure
        surface = surface_of(pressure, grid, body, 0.1)
        edge = edge_tension(surface, pressure, grid, body, 0.1).tension
        found.append((edge, highest_principal(surface).max()))
    (coarse, points), (fine, finer_points) = found
    assert coarse == pytest.approx(fine, rel=0.015)
    assert points < 0.9 * finer_points < 0.9 * fine


def rough_case():
    rng = np.random.default_rng(2)
    grid = Grid((40, 36), (1.0, 1.0), periodic=(True, False))
    x, y = grid.x[:, None], grid.y
    gap = 0.02 * (x**2 * 0.02 + y**2 * 0.03) + 0.1 * np.cos(2 * np.pi * x / 10 + rng.uniform()) * np.cos(y / 3)
    pressure = solve_contact(gap - gap.min(), displacement_operator(grid, Body(STEEL)), load=2e12).pressure
    return grid, pressure, Body(STEEL, layers=(Layer(Material("soft", youngs_modulus=60e9, poissons_ratio=0.25), 1.5),))


def test_mirrored_and_turned_contacts_have_the_same_tension():
    grid, pressure, body = rough_case()
    turned = Grid(grid.shape[::-1], grid.spacing[::-1], periodic=grid.periodic[::-1])
    plain = edge_tension(surface_of(pressure, grid, body, 0.0), pressure, grid, body).tension
    other = np.ascontiguousarray(pressure.T)
    assert edge_tension(surface_of(other, turned, body, 0.0), other, turned, body).tension == pytest.approx(plain)
    rubbed = edge_tension(surface_of(pressure, grid, body, 0.2), pressure, grid, body, 0.2).tension
    other = np.ascontiguousarray(pressure[::-1])
    mirrored = edge_tension(surface_of(other, grid, body, -0.2), other, grid, body, -0.2).tension
    assert mirrored == pytest.approx(rubbed)
    assert rubbed > 1.05 * plain


def test_edges_at_the_hardness_and_single_cells_have_none():
    """A plateau has no root of the distance at its edge, and a cell has no second one."""
    grid, body = Grid((16, 16), (1.0, 1.0)), COATED_WITH_ITSELF
    for cells in (np.s_[5:11, 5:11], np.s_[7, 7]):
        pressure = np.zeros(grid.shape)
        pressure[cells] = 1e9
        assert edge_tension(surface_of(pressure, grid, body, 0.0), pressure, grid, body).tension == -math.inf
