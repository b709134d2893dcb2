"""Surface temperature of coated bodies: finite volumes over depth, a Hankel integral, limits of thin layers."""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.linalg import solve_banded
from scipy.special import j1
from unit_body import UNIT, body

from bem import Body, Grid, InputError, Layer
from bem.heat import surface_temperature, surface_temperature_history
from bem.heat.bodies import conductors_of
from bem.heat.layers import added_impedance

POOR, GOOD = body(conductivity=0.1, capacity=0.5).material, body(conductivity=5.0, capacity=2.0).material


def conductor(*layers, speed=0.0):
    (found,) = conductors_of("test", Body(UNIT.material, layers=layers), speed, 0.0, layered=True)
    return found


def impedance_by_finite_volumes(layers, speed, square, along, cells):
    """Temperature over flux at the surface: (k T')' = k (q^2 + i U q_x / kappa) T in depth, T = 0 ten decays below."""
    depth = sum(layer.thickness for layer in layers)
    parts = [(layer.thickness, layer.material, cells) for layer in layers]
    parts.append((10 / np.sqrt(square), UNIT.material, 40 * cells))
    width = np.concatenate([np.full(n, thickness / n) for thickness, _, n in parts])
    conductivity = np.concatenate([np.full(n, one.thermal_conductivity) for _, one, n in parts])
    sink = np.concatenate([
        np.full(n, one.thermal_conductivity * (square + 1j * speed * along / one.thermal_diffusivity))
        for _, one, n in parts
    ])  # fmt: skip
    half = 0.5 * width / conductivity
    between = 1 / (half[:-1] + half[1:])
    main = sink * width
    main[:-1] += between
    main[1:] += between
    main[-1] += 1 / half[-1]
    bands = np.zeros((3, len(width)), dtype=complex)
    bands[0, 1:], bands[1], bands[2, :-1] = -between, main, -between
    flux = np.zeros(len(width), dtype=complex)
    flux[0] = 1.0
    assert depth > 0
    return solve_banded((1, 1), bands, flux)[0] + half[0]


@pytest.mark.parametrize("speed", [0.0, 20.0, -20.0])
@pytest.mark.parametrize("layers", [(Layer(POOR, 0.05),), (Layer(GOOD, 0.2), Layer(POOR, 0.1))])
def test_waves_agree_with_finite_volumes_over_depth(layers, speed):
    """Of second order in the cell."""
    square, along = 5.0, 1.7
    bare = 1 / np.sqrt(square + 1j * speed * along)
    exact = bare + added_impedance(conductor(*layers, speed=speed), np.array([square]), np.array([along]))[0]
    errors = [abs(impedance_by_finite_volumes(layers, speed, square, along, n) - exact) for n in (20, 40)]
    assert errors[1] < 2e-3 * abs(exact)
    assert errors[0] / errors[1] == pytest.approx(4, rel=0.1)


@pytest.mark.parametrize(("material", "thickness"), [(POOR, 0.1), (POOR, 1.0), (GOOD, 0.3)])
def test_a_disc_at_rest_agrees_with_its_hankel_integral(material, thickness):
    """Centre of a uniform disc: the integral of Z(q) J1(q) over q, radius and flux one."""

    def wave(q):
        own, fall = 1 / (material.thermal_conductivity * q), np.tanh(q * thickness)
        return own * (1 / q + own * fall) / (own + fall / q)

    # the bare half-space has 1; the rest falls like 1/q, and 200 waves leave 1e-3
    expected = 1 + quad(lambda q: (wave(q) - 1 / q) * j1(q), 0, 200, limit=2000)[0]
    rises = []
    for cells in (41, 81):
        grid = Grid((cells, cells), (4 / cells, 4 / cells))
        inside = 0.5 - (np.hypot(grid.x[:, None], grid.y) - 1) / grid.spacing[0]
        found = surface_temperature(
            np.clip(inside, 0, 1), grid, Body(UNIT.material, layer=Layer(material, thickness)), speeds=0.0
        )
        rises.append(found.temperature[cells // 2, cells // 2])
    assert rises[1] == pytest.approx(expected, rel=6e-3)


@pytest.mark.parametrize("speed", [0.0, 50.0, -50.0])
def test_a_layer_of_the_same_material_changes_nothing(speed):
    grid = Grid((24, 16), (0.1, 0.1))
    heat = np.where(np.hypot(grid.x[:, None], grid.y) < 0.6, 1.0, 0.0)
    plain, coated = (
        surface_temperature(heat, grid, one, speeds=speed).temperature
        for one in (UNIT, Body(UNIT.material, layer=Layer(UNIT.material, 0.2)))
    )
    assert coated == pytest.approx(plain, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("speed", [0.0, 5e3])
def test_a_thin_poor_layer_adds_flux_times_thickness_over_conductivity(speed):
    """Less what it takes from the half-space: (k / k_s)^2 of it at rest, the ratio of k rho c at high speed."""
    grid = Grid((64, 48), (0.05, 0.05))
    heat = np.where(np.hypot(grid.x[:, None], grid.y) < 0.8, 1.0, 0.0)
    thin = Body(UNIT.material, layer=Layer(POOR, 1e-3))
    plain, coated = (surface_temperature(heat, grid, one, speeds=speed).temperature for one in (UNIT, thin))
    middle = np.hypot(grid.x[:, None], grid.y) < 0.4
    lost = 0.1**2 if speed == 0 else 0.1 * 0.5
    assert (coated - plain)[middle] == pytest.approx(1e-2 * (1 - lost), rel=0.03)


@pytest.mark.parametrize("periodic", [(False, False), (False, True)])
@pytest.mark.parametrize("speed", [6.0, -6.0])
def test_a_thick_layer_is_a_half_space(speed, periodic):
    """Also downstream and upstream of the source."""
    grid = Grid((48, 24), (0.1, 0.1), periodic=periodic)
    heat = np.where(np.abs(grid.x[:, None]) + 0 * grid.y < 0.5, 1.0 + 0.2 * np.cos(2 * np.pi * grid.y / 2.4), 0.0)
    thick = Body(UNIT.material, layer=Layer(POOR, 1.2))
    found, expected = (surface_temperature(heat, grid, one, speeds=speed).temperature for one in (thick, Body(POOR)))
    assert np.abs(found - expected).max() < 0.02 * expected.max()


def test_heat_goes_round_a_coating_into_the_other_body():
    grid = Grid((32, 32), (0.1, 0.1))
    heat = np.where(np.hypot(grid.x[:, None], grid.y) < 0.8, 1.0, 0.0)
    coated = Body(UNIT.material, layer=Layer(POOR, 0.05))
    plain, one, both = (
        surface_temperature(heat, grid, pair, speeds=(2.0, -1.0))
        for pair in ((UNIT, UNIT), (coated, UNIT), (coated, coated))
    )
    assert one.residual < 1e-8
    assert one.share < 0.8 * plain.share
    assert plain.maximum < one.maximum < both.maximum


def test_layers_over_time_are_refused():
    grid = Grid((4, 4), (0.1, 0.1))
    with pytest.raises(InputError, match="layer"):
        surface_temperature_history(
            [0.0, 1.0, 2.0], np.ones((4, 4)), grid, Body(UNIT.material, layer=Layer(POOR, 0.1)), speeds=1.0
        )
