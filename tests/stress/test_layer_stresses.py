"""Stresses of coatings by layer and interface: depths, principal stresses, finite elements of a coated half-space."""

import json
from importlib.resources import files

import numpy as np
import pytest

from bem import Body, Grid, Layer, Material, subsurface_stress
from bem.stress import (
    depth_maxima,
    highest_principal,
    layer_stresses,
    von_mises,
    with_layer_depths,
    with_tension_beyond,
)


def material(modulus, poisson):
    return Material("one", youngs_modulus=modulus, poissons_ratio=poisson)


HARD, STIFF, STEEL = material(200e9, 0.25), material(620e9, 0.22), material(207e9, 0.3)


@pytest.mark.parametrize("thicknesses", [(2e-6,), (2e-6, 0.5e-6), (1e-7, 3e-6, 1e-6)])
@pytest.mark.parametrize("depths", [(0.0,), tuple(50e-6 * (i / 23) ** 2 for i in range(24)), (1.999e-6, 2.001e-6)])
def test_every_layer_has_five_depths_and_every_interface_two_sides(thicknesses, depths):
    body = Body(STEEL, layers=tuple(Layer(HARD, thickness) for thickness in thicknesses))
    found = with_layer_depths(depths, body)
    assert list(found) == sorted(set(found))
    ends = (0.0, *body.interfaces)
    medium = [body.medium_at(depth) for depth in found]
    assert min(medium.count(number) for number in range(len(thicknesses))) >= 5
    for interface, thickness in zip(body.interfaces, thicknesses, strict=True):
        assert interface in found
        below = min(depth for depth in found if depth > interface)
        assert body.medium_at(below) == body.medium_at(interface) + 1
        assert below - interface <= 1e-3 * thickness * (1 + 1e-9)
    assert found[0] == 0
    assert {depth for depth in depths if depth > 1.1 * ends[-1]} <= set(found)


def test_more_depths_in_each_layer_keep_those_of_fewer():
    """Twice the intervals have every depth of the single ones, so that a refinement of depths never loses a stress."""
    body = Body(STEEL, layers=(Layer(HARD, 2e-6), Layer(STIFF, 0.5e-6)))
    few, many = (np.array(with_layer_depths((), body, number)) for number in (5, 9))
    assert np.abs(many[:, None] - few).min(axis=0).max() <= 1e-12
    assert len(many) == 2 * len(few) - 3


def test_a_body_without_layers_keeps_its_depths():
    assert with_layer_depths((0.0, 1e-6), Body(STEEL)) == (0.0, 1e-6)


def test_the_highest_principal_stress_is_the_largest_eigenvalue():
    stress = np.random.default_rng(3).normal(0, 1, (6, 200))
    stress[:, 0] = 0
    stress[:, 1] = (-2, -2, -2, 0, 0, 0)
    stress[:, 2] = (1, 1, -3, 0, 0, 0)
    xx, yy, zz, yz, xz, xy = stress
    tensors = np.moveaxis(np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]), -1, 0)
    np.testing.assert_allclose(highest_principal(stress), np.linalg.eigvalsh(tensors)[:, -1], atol=1e-7)


def test_layers_and_interfaces_have_the_stresses_of_the_layered_kernels_there():
    """Each figure is the highest of the stresses that the kernels give at the depths of its layer alone, on either side
    of an interface."""
    body = Body(STEEL, layers=(Layer(HARD, 2e-6), Layer(STIFF, 0.5e-6)))
    grid = Grid((32, 32), (0.625e-6, 0.625e-6))
    x, y = np.meshgrid(grid.x, grid.y, indexing="ij")
    pressure = 2e9 * np.sqrt(np.clip(1 - (x**2 + y**2) / 5e-6**2, 0, None))
    depths = np.array(with_layer_depths(tuple(np.linspace(0, 10e-6, 6)), body))
    stress = subsurface_stress(pressure, grid, body, depths, friction=0.1)
    found = layer_stresses(depth_maxima(stress, von_mises(stress), depths, body), body)
    np.testing.assert_allclose(found.interface_depth, [2e-6, 2.5e-6], rtol=1e-12)
    for number, (top, bottom) in enumerate([(0.0, body.interfaces[0]), (2.0005e-6, body.interfaces[1])]):
        own = np.linspace(top, bottom, 5)
        there = subsurface_stress(pressure, grid, body, own, friction=0.1)
        assert found.layer_max_von_mises[number] == pytest.approx(von_mises(there).max(), rel=1e-3)
        assert found.layer_max_tension[number] == pytest.approx(highest_principal(there).max(), rel=1e-3)
    for number, interface in enumerate(body.interfaces):
        beside = subsurface_stress(pressure, grid, body, [interface * (1 - 1e-6), interface * (1 + 1e-6)], friction=0.1)
        for side in (0, 1):  # tractions are continuous
            shear = np.hypot(beside[3, side], beside[4, side]).max()
            assert found.interface_max_shear[number] == pytest.approx(shear, rel=1e-4)
            tension = beside[2, side].max()
            assert found.interface_max_tension[number] == pytest.approx(max(tension, 0), rel=1e-3, abs=1e3)


@pytest.mark.parametrize("case", ["disc-hertz-stiff", "disc-hertz-stiff-thick"])
def test_coatings_agree_with_finite_elements(case):
    """A Hertzian pressure on a layer ten times as stiff: tension at the foot of the layer, and shear at the interface,
    of which the finite elements have ten points."""
    stored = json.loads((files("bem.verification") / "fem_results" / f"{case}.json").read_text())
    ratio, poisson, thickness = stored["parameters"]["layer"]
    body = Body(material(1.0, stored["parameters"]["nu"]), layers=(Layer(material(ratio, poisson), thickness),))
    grid = Grid((129, 129), (6.0 / 129, 6.0 / 129))
    x, y = np.meshgrid(grid.x, grid.y, indexing="ij")
    pressure = np.sqrt(np.clip(1 - x**2 - y**2, 0, None))
    pressure *= 2 / 3 * np.pi / (pressure.sum() * grid.cell_area)
    depths = np.array(with_layer_depths((0.0, 3.0), body))
    stress = subsurface_stress(pressure, grid, body, depths)
    found = layer_stresses(depth_maxima(stress, von_mises(stress), depths, body), body)
    of = {(one["name"], one["along"]): np.array(one["values"]) for one in stored["quantities"]}
    foot = of["stress_xx", "interface, y = 0 (layer)"][0]
    shear = np.abs(of["stress_xz", "interface, y = 0 (layer)"]).max()
    assert found.layer_max_tension[0] == pytest.approx(foot, rel=5e-3)
    assert shear * (1 - 5e-3) <= found.interface_max_shear[0] <= 1.05 * shear
    assert found.interface_max_tension[0] < 0.05 * foot


def test_two_layers_agree_with_finite_elements():
    """A Hertzian pressure on a stiff layer on a soft one: shear and tension across both interfaces, tension and von
    Mises stress of both layers, and von Mises stress below them.

    All maxima are on interfaces, where the finite elements have points within 0.1 radii of each maximum. The tension
    across, 0.8 % of the pressure, is at 2.14 and 2.17 radii.
    """
    stored = json.loads((files("bem.verification") / "fem_results" / "disc-hertz-stiff-on-soft.json").read_text())
    numbers = stored["parameters"]["layer"]
    stack = [Layer(material(*numbers[i : i + 2]), numbers[i + 2]) for i in (0, 3)]
    body = Body(material(1.0, stored["parameters"]["nu"]), layers=stack)
    grid = Grid((129, 129), (6.0 / 129, 6.0 / 129))
    x, y = np.meshgrid(grid.x, grid.y, indexing="ij")
    pressure = np.sqrt(np.clip(1 - x**2 - y**2, 0, None))
    pressure *= 2 / 3 * np.pi / (pressure.sum() * grid.cell_area)
    depths = np.array(with_layer_depths((0.0, 3.0), body))
    stress = subsurface_stress(pressure, grid, body, depths)
    found = layer_stresses(depth_maxima(stress, von_mises(stress), depths, body), body)
    lower = _on_interface(stored, "interface, y = 0 (layer)"), _on_interface(stored, "interface 2, y = 0 (layer 2)")
    upper = _on_interface(stored, "interface, y = 0 (layer 2)"), _on_interface(stored, "interface 2, y = 0 (substrate)")
    across = [(np.abs(one[4]).max(), one[2].max()) for one in lower]
    np.testing.assert_allclose(found.interface_depth, [0.25, 0.4], rtol=1e-12)
    np.testing.assert_allclose(found.interface_max_shear, [shear for shear, _ in across], rtol=3e-3)
    np.testing.assert_allclose(found.interface_max_tension, [tension for _, tension in across], rtol=3e-3)
    layers = [lower[0]], [upper[0], lower[1]]
    tension = [max(highest_principal(side).max() for side in sides) for sides in layers]
    np.testing.assert_allclose(found.layer_max_tension, tension, rtol=3e-3)
    mises = [max(von_mises(side).max() for side in sides) for sides in layers]
    np.testing.assert_allclose(found.layer_max_von_mises, mises, rtol=3e-3)
    beneath = von_mises(stress)[depths > 0.4].max()
    assert beneath == pytest.approx(von_mises(upper[1]).max(), rel=3e-3)


def _on_interface(stored, along):
    """Return the six stresses (6, n) of the stored points on one side of an interface; yz and xy vanish at y = 0."""
    of = {one["name"]: np.array(one["values"]) for one in stored["quantities"] if one["along"] == along}
    zero = np.zeros_like(of["stress_xx"])
    return np.array([of["stress_xx"], of["stress_yy"], of["stress_zz"], zero, of["stress_xz"], zero])


@pytest.mark.parametrize("cells", [48, 150])
@pytest.mark.parametrize("periodic", [(False, False), (False, True)])
def test_tension_beyond_a_grid_is_that_of_a_wider_grid(cells, periodic):
    """A rubbed soft thick layer is in tension behind the contact and outside a grid that fits the contact; 150 cells go
    in blocks of two. The wider grid has the same cells and sees the whole."""
    body = Body(STEEL, layers=(Layer(material(60e9, 0.3), 8e-6),))
    grid = Grid((cells, 24), (24e-6 / cells, 1e-6), periodic=periodic)
    half = np.where(periodic, np.inf, 7e-6)
    pressure = np.where((np.abs(grid.x[:, None]) < 8e-6) & (np.abs(grid.y) < half[1]), 1e9, 0.0)
    depths = np.array(with_layer_depths((0.0, 10e-6), body))
    stress = subsurface_stress(pressure, grid, body, depths, friction=0.4)
    maxima = depth_maxima(stress, von_mises(stress), depths, body)
    found = layer_stresses(with_tension_beyond(maxima, pressure, grid, body, 0.4), body)
    margin = [(0, 0) if one else (2 * n, 2 * n) for one, n in zip(periodic, grid.shape, strict=True)]
    wide = np.pad(pressure, margin)
    whole = subsurface_stress(wide, Grid(wide.shape, grid.spacing, periodic=periodic), body, [8e-6], friction=0.4)
    assert found.interface_max_tension[0] == pytest.approx(whole[2].max(), rel=1e-2)
    assert found.interface_max_tension[0] > 1.1 * layer_stresses(maxima, body).interface_max_tension[0]
    assert found.interface_max_shear.tolist() == layer_stresses(maxima, body).interface_max_shear.tolist()


def test_nothing_lies_beyond_a_periodic_grid():
    body, grid = Body(STEEL, layers=(Layer(HARD, 2e-6),)), Grid((8, 8), (1e-6, 1e-6), periodic=(True, True))
    depths = np.array(with_layer_depths((0.0,), body))
    stress = subsurface_stress(np.ones(grid.shape), grid, body, depths)
    maxima = depth_maxima(stress, von_mises(stress), depths, body)
    assert with_tension_beyond(maxima, np.ones(grid.shape), grid, body) is maxima
