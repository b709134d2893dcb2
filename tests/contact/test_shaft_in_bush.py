"""Shaft in a bush: closed forms for similar bodies, Hertz for small angles, Navier's equations for walls."""

import math
from dataclasses import replace

import numpy as np
import pytest

from bem import InputError
from bem.contact.shaft_in_bush import (
    NODES,
    ShaftInBush,
    _bush_harmonics,
    _bush_mean,
    modulus_on_layer,
    solve_shaft_in_bush,
)
from bem.materials import CATALOGUE, Material, contact_modulus, dundurs_beta
from bem.reference_solutions.hertz import cylinder_contact
from bem.reference_solutions.pin_in_hole import load_of_angle, pressure_at
from bem.stiffness import Stiffness

STEEL, PEEK = CATALOGUE["steel-52100"].material, CATALOGUE["peek"].material
RADIUS, CLEARANCE = 10e-3, 20e-6
POLYMER = ShaftInBush(STEEL, PEEK, RADIUS, CLEARANCE)
CRYSTAL = Material("silicon", stiffness=Stiffness("cubic", c11=166e9, c12=64e9, c44=80e9))
SOFT = Material("gel", youngs_modulus=1e5, poissons_ratio=0.3, surface_tension=0.03)


def similar(first_ratio, second_ratio):
    """Two materials of unlike stiffness with Dundurs' beta of zero, by their Poisson's ratios."""
    first, second = (
        Material("one", youngs_modulus=2e9 * (1 - 2 * nu) * (1 + nu), poissons_ratio=nu)
        for nu in (first_ratio, second_ratio)
    )
    assert dundurs_beta(first, second) == pytest.approx(0, abs=1e-15)
    return first, second


@pytest.mark.parametrize("degrees", [5, 40, 75])
@pytest.mark.parametrize("bodies", [(STEEL, STEEL), similar(0.2, 0.4), similar(0.4, 0.2)], ids=["one", "ab", "ba"])
def test_the_closed_form_of_similar_bodies(bodies, degrees):
    pin, plate = bodies
    alpha = (plate.plane_strain_modulus - pin.plane_strain_modulus) / (
        plate.plane_strain_modulus + pin.plane_strain_modulus
    )
    half = math.radians(degrees)
    load = load_of_angle(half, modulus=pin.plane_strain_modulus, alpha=alpha, clearance=CLEARANCE)
    found = solve_shaft_in_bush(ShaftInBush(pin, plate, RADIUS, CLEARANCE), load)
    assert found.half_angle == pytest.approx(half, rel=1e-9)
    exact = pressure_at(found.angles, half_angle=half, load=load, radius=RADIUS)
    assert found.pressures == pytest.approx(exact, rel=1e-7)
    assert found.maximum_pressure == pytest.approx(
        pressure_at(np.zeros(1), half_angle=half, load=load, radius=RADIUS)[0], rel=1e-9
    )


def deviation(load):
    """How far Hertz' peak pressure is from that of equal bodies."""
    bodies = ShaftInBush(STEEL, STEEL, RADIUS, CLEARANCE)
    hertz = cylinder_contact(radius=bodies.equivalent_radius, contact_modulus=bodies.modulus, load=load)
    return hertz.maximum_pressure / solve_shaft_in_bush(bodies, load).maximum_pressure - 1


def test_small_contacts_are_hertz():
    """The deviation grows with the square of the angle, as the load does, beside that of the shaft's radius."""
    rest = deviation(1.0)
    assert abs(rest) < 2 * CLEARANCE / RADIUS
    few, more = (deviation(load) - rest for load in (400.0, 1600.0))
    assert more / few == pytest.approx(4, rel=0.02)


@pytest.mark.parametrize("clearance", [7.5e-3 * RADIUS, 1e-4 * RADIUS])
def test_light_loads_are_solved(clearance):
    """Hertz to the relative clearance and the square of the angle, at every load of seven decades."""
    bodies = ShaftInBush(STEEL, STEEL, RADIUS, clearance)
    for load in np.geomspace(1e-2, 1e5, 71) * clearance / RADIUS:
        found = solve_shaft_in_bush(bodies, load)
        half_width = cylinder_contact(
            radius=bodies.equivalent_radius, contact_modulus=bodies.modulus, load=load
        ).half_width
        assert found.load == pytest.approx(load, rel=1e-6, abs=0)
        near = clearance / RADIUS + found.half_angle**2
        assert found.half_angle == pytest.approx(half_width / RADIUS, rel=2 * near + 1e-6, abs=0)


def test_dissimilar_bodies_converge_with_the_nodes():
    pressures = [solve_shaft_in_bush(POLYMER, 25e3, nodes=nodes).maximum_pressure for nodes in (12, 24, 96)]
    errors = [abs(one / pressures[-1] - 1) for one in pressures[:-1]]
    assert math.log2(errors[0] / errors[1]) > 4
    assert solve_shaft_in_bush(POLYMER, 25e3).maximum_pressure == pytest.approx(pressures[-1], rel=1e-8)
    thin = replace(POLYMER, wall=0.02 * RADIUS)
    fine = solve_shaft_in_bush(thin, 25e3, nodes=2 * NODES).maximum_pressure
    assert solve_shaft_in_bush(thin, 25e3).maximum_pressure == pytest.approx(fine, rel=1e-6)


def test_a_housing_of_the_bush_s_material_is_an_infinite_bush():
    alone, housed = (solve_shaft_in_bush(one, 25e3) for one in (POLYMER, replace(POLYMER, wall=2e-3, housing=PEEK)))
    assert housed.maximum_pressure == pytest.approx(alone.maximum_pressure, rel=1e-9)
    thick = solve_shaft_in_bush(replace(POLYMER, wall=10 * RADIUS), 25e3)
    assert thick.maximum_pressure == pytest.approx(alone.maximum_pressure, rel=1e-2)
    stiff = Material("stiff", youngs_modulus=1e18, poissons_ratio=0.3)
    rigid, nearly = (replace(POLYMER, wall=2e-3, housing=one) for one in (None, stiff))
    pressures = [solve_shaft_in_bush(one, 25e3).maximum_pressure for one in (rigid, nearly)]
    assert pressures[0] == pytest.approx(pressures[1], rel=1e-6)


def navier(n, material, inner, outer, *, fixed):
    """Radial displacement of a ring at `inner` under the pressure cos(n angle) there, by collocation along the radius.

    fixed : the outer surface is held; else the inner one is free and the pressure acts on the outer, whose inward
    displacement it is.
    """
    count = 60
    turn = math.pi * np.arange(count + 1) / count
    x = np.cos(turn)
    weight = np.array([2.0, *[1.0] * (count - 1), 2.0]) * (-1.0) ** np.arange(count + 1)
    difference = np.outer(weight, 1 / weight) / (x[:, None] - x[None, :] + np.eye(count + 1))
    difference -= np.diag(difference.sum(axis=1))
    # the logarithm of the radius resolves rings of any width: r d/dr is a plain derivative
    span = 0.5 * math.log(outer / inner)
    slope = difference / span
    identity, zero = np.eye(count + 1), np.zeros((count + 1, count + 1))
    mu, nu = material.shear_modulus, material.poissons_ratio
    lam = 2 * mu * nu / (1 - 2 * nu)
    radius = np.exp(math.log(inner) + span * (x + 1))
    # u = U cos, v = V sin; strains times r: r U', U + n V, r V' - V - n U
    dilation = [slope + identity, n * identity]
    radial = [lam * dilation[0] + 2 * mu * slope, lam * dilation[1]]
    hoop = [lam * dilation[0] + 2 * mu * identity, lam * dilation[1] + 2 * mu * n * identity]
    shear = [-mu * n * identity, mu * (slope - identity)]
    # stresses times r are S: equilibrium r S' - S + S_radial - S_hoop + n S_shear = 0, and the other alike
    first = [slope @ radial[k] - hoop[k] + n * shear[k] for k in (0, 1)]
    second = [slope @ shear[k] + shear[k] - n * hoop[k] for k in (0, 1)]
    system = np.vstack([np.hstack(first), np.hstack(second)])
    right = np.zeros(2 * count + 2)
    last, top = count, 0  # nodes of the inner and outer radius
    loaded, other = (last, top) if fixed else (top, last)
    for row, parts in ((loaded, radial), (count + 1 + loaded, shear)):
        system[row] = np.hstack([part[loaded] for part in parts])
    right[loaded] = -radius[loaded]
    held = ([identity, zero], [zero, identity]) if fixed else (radial, shear)
    for row, parts in ((other, held[0]), (count + 1 + other, held[1])):
        system[row] = np.hstack([part[other] for part in parts])
    moved = np.linalg.solve(system, right)[loaded]
    return moved if fixed else -moved


@pytest.mark.parametrize("n", [2, 3, 8, 25])
def test_the_bush_moves_as_navier_s_equations_say(n):
    bodies = replace(POLYMER, wall=2e-3)
    shear, kappa = PEEK.shear_modulus, 3 - 4 * PEEK.poissons_ratio
    infinite = RADIUS / (4 * shear) * (kappa / (n - 1) + 1 / (n + 1))
    moved = navier(n, PEEK, RADIUS, RADIUS + bodies.wall, fixed=True)
    assert infinite + _bush_harmonics(bodies, np.array([n]))[0] == pytest.approx(moved, rel=1e-8, abs=0)
    if n == 2:
        uniform = navier(0, PEEK, RADIUS, RADIUS + bodies.wall, fixed=True)
        assert RADIUS / (2 * shear) + _bush_mean(bodies) == pytest.approx(uniform, rel=1e-8, abs=0)


@pytest.mark.parametrize("n", [2, 3, 8])
def test_the_shaft_moves_as_navier_s_equations_say(n):
    """With a hole of 1 % of the radius, which for n = 2 softens it by some 3e-4."""
    shear, kappa = STEEL.shear_modulus, 3 - 4 * STEEL.poissons_ratio
    moved = navier(n, STEEL, 0.01 * RADIUS, RADIUS, fixed=False)
    assert RADIUS / (4 * shear) * (1 / (n - 1) + kappa / (n + 1)) == pytest.approx(moved, rel=1e-3, abs=0)


@pytest.mark.parametrize("wall", [None, 2e-3])
def test_the_deformed_surfaces_close_the_gap(wall):
    """The gap from 78 harmonics of the pressure is none within the contact and open beside it."""
    bodies = replace(POLYMER, wall=wall)
    found = solve_shaft_in_bush(bodies, 25e3)
    count = len(found.angles)
    weights = found.half_angle * math.pi / count * np.sin(math.pi * (np.arange(count) + 0.5) / count)
    n = np.arange(2, 80)
    harmonics = np.cos(np.outer(n, found.angles)) @ (weights * found.pressures) / math.pi
    quarter = 0.25 * RADIUS
    kappa = [3 - 4 * one.poissons_ratio for one in (STEEL, PEEK)]
    soft = [quarter / one.shear_modulus for one in (STEEL, PEEK)]
    flexibility = soft[0] * (1 / (n - 1) + kappa[0] / (n + 1)) + soft[1] * (kappa[1] / (n - 1) + 1 / (n + 1))
    mean = soft[0] * (kappa[0] - 1) + 2 * soft[1]
    if wall is not None:
        flexibility += _bush_harmonics(bodies, n)
        mean += _bush_mean(bodies)
    mean *= float(weights @ found.pressures) / (2 * math.pi)
    inside = found.half_angle * np.array([0.0, 0.3, 0.6, 0.9])
    opening = CLEARANCE + mean + np.cos(np.outer(inside, n)) @ (flexibility * harmonics)
    shifts = opening / np.cos(inside)  # of the shaft, one for all angles
    assert np.ptp(shifts) < 2e-3 * CLEARANCE
    beside = found.half_angle * np.array([1.3, 1.6, 2.0])
    gap = CLEARANCE + mean + np.cos(np.outer(beside, n)) @ (flexibility * harmonics) - shifts[0] * np.cos(beside)
    assert np.all(gap > 0.01 * CLEARANCE)


def test_curvatures_of_shaft_and_bore_subtract_to_that_of_the_equivalent_cylinder():
    bodies = ShaftInBush(STEEL, PEEK, RADIUS, 0.05 * RADIUS)
    exact = 1 / (1 / (0.95 * RADIUS) - 1 / RADIUS)
    assert bodies.equivalent_radius == pytest.approx(exact, rel=1e-12, abs=0)


def test_the_equivalent_cylinder_is_that_of_hertz():
    bodies = POLYMER.cylinder
    hertz = cylinder_contact(radius=POLYMER.equivalent_radius, contact_modulus=bodies.modulus, load=8e3)
    assert solve_shaft_in_bush(bodies, 8e3).maximum_pressure == pytest.approx(hertz.maximum_pressure, rel=5e-3)


@pytest.mark.parametrize("relative", [0.015, 0.09])
def test_wide_clearances_have_an_equivalent_cylinder(relative):
    bodies = ShaftInBush(STEEL, PEEK, RADIUS, relative * RADIUS)
    hertz = cylinder_contact(radius=bodies.equivalent_radius, contact_modulus=bodies.modulus, load=50e3)
    found = solve_shaft_in_bush(bodies.cylinder, 50e3)
    assert found.maximum_pressure == pytest.approx(hertz.maximum_pressure, rel=5e-3)
    assert found.half_angle * bodies.cylinder.radius == pytest.approx(hertz.half_width, rel=5e-3)


def test_a_layer_of_the_substrate_s_material_has_the_modulus_of_half_spaces():
    """By Hertz; a soft layer is between its material and the substrate, the stiffer the thinner it is."""
    given = {"radius": 5.2, "load": 40e3}
    plain = modulus_on_layer(STEEL, PEEK, PEEK, thickness=3e-3, **given)
    assert plain == pytest.approx(contact_modulus(STEEL, PEEK), rel=5e-3)
    found = [modulus_on_layer(STEEL, PEEK, STEEL, thickness=thickness, **given) for thickness in (1e-3, 3e-3, 9e-3)]
    assert found[0] > found[1] > found[2] > plain
    # the dry contact by harmonics of the half-space: 5.446 MPa on a slice of 128 cells of a 3 mm wall under 40 kN/m
    half_width = math.sqrt(4 * 40e3 * 5.2 / (math.pi * found[1]))
    assert half_width == pytest.approx(5.09e-3, rel=5e-3)


def test_the_load_is_that_of_the_pressure():
    found = solve_shaft_in_bush(replace(POLYMER, wall=1e-3), 25e3)
    at = np.concatenate([[-found.half_angle], found.angles[::-1], [found.half_angle]])
    pressure = np.concatenate([[0.0], found.pressures[::-1], [0.0]])
    assert RADIUS * np.trapezoid(pressure * np.cos(at), at) == pytest.approx(25e3, rel=2e-3)
    assert found.maximum_pressure == pytest.approx(found.pressures.max(), rel=1e-2)


@pytest.mark.parametrize("place", ["shaft", "bush", "housing"])
@pytest.mark.parametrize("material", [CRYSTAL, SOFT], ids=["crystal", "tension"])
def test_crystals_and_surface_tension_are_refused(place, material):
    housed = replace(POLYMER, wall=2e-3, housing=STEEL)
    with pytest.raises(InputError, match="isotropic"):
        replace(housed, **{place: material})


def test_what_is_no_bush_is_refused():
    with pytest.raises(InputError, match="clearance"):
        ShaftInBush(STEEL, PEEK, RADIUS, 0.0)
    with pytest.raises(InputError, match="wall"):
        ShaftInBush(STEEL, PEEK, RADIUS, CLEARANCE, wall=1e-6)
    with pytest.raises(InputError, match="wall"):
        ShaftInBush(STEEL, PEEK, RADIUS, CLEARANCE, wall=math.inf)
    with pytest.raises(InputError, match="radius"):
        ShaftInBush(STEEL, PEEK, math.inf, CLEARANCE)
    for load in (0.0, -1.0, math.nan, math.inf):
        with pytest.raises(InputError, match="positive load"):
            solve_shaft_in_bush(POLYMER, load)
    with pytest.raises(InputError, match="as without clearance"):
        solve_shaft_in_bush(POLYMER, 1e16)
