"""Stresses below a contact and their figures, against a uniform state and the planes themselves."""

import numpy as np
import pytest

from bem import Body, Grid, Layer, Material
from bem.stress import stress_below, subsurface_stress, von_mises_field
from bem.stress.below import yield_stresses

GRID = Grid((16, 8), (1e-6, 1e-6), periodic=(True, True))
STEEL = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3, yield_stress=1e9)
FILM = Material("film", youngs_modulus=100e9, poissons_ratio=0.2)


def test_a_uniform_pressure_yields_everywhere_or_nowhere():
    # mean pressure p alone is the laterally constrained state: von Mises p (1 - 2 nu) / (1 - nu) at every depth
    depths = np.linspace(0.0, 4e-6, 5)
    mises = 2e9 * (1 - 0.6) / 0.7
    for limit, volume in ((0.9 * mises, GRID.area * 4e-6), (1.1 * mises, 0.0)):
        steel = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3, yield_stress=limit)
        found = stress_below(np.full(GRID.shape, 2e9), GRID, Body(steel), depths)
        assert found.max_von_mises == pytest.approx(mises, rel=1e-12)  # round-off of the transform
        assert found.yielded_volume == pytest.approx(volume, rel=1e-12)


@pytest.mark.parametrize("components", [False, True])
def test_figures_are_those_of_the_fields(components):
    rng = np.random.default_rng(3)
    pressure, depths, done = rng.random(GRID.shape) * 3e9, np.array([0.2e-6, 0.5e-6, 1e-6]), []
    out = np.empty((3, *GRID.shape))
    found = stress_below(
        pressure, GRID, Body(STEEL), depths, friction=0.2, components=components, out=out, after=done.append
    )
    field = von_mises_field(pressure, GRID, Body(STEEL), depths, friction=0.2)
    assert found.von_mises is out
    assert np.allclose(out, field, rtol=1e-10)  # five spectra or six: round-off
    assert np.array_equal(found.highest, out.max(axis=(1, 2)))
    assert found.max_von_mises_depth == depths[np.argmax(found.highest)]
    area = (out > 1e9).sum(axis=(1, 2)) * GRID.cell_area
    assert found.yielded_volume == pytest.approx(np.trapezoid(area, depths), rel=1e-14)
    assert found.yielded_volume > 0
    assert done == [1, 2, 3]
    if components:
        assert np.array_equal(found.stress, subsurface_stress(pressure, GRID, Body(STEEL), depths, friction=0.2))
    else:
        assert found.stress is None


def test_each_depth_yields_as_the_material_there():
    body = Body(STEEL, layers=[Layer(FILM, 1e-6)])
    assert yield_stresses(body, np.array([0.5e-6, 2e-6])).tolist() == [np.inf, 1e9]
    assert stress_below(np.ones(GRID.shape), GRID, Body(FILM), [0.0, 1e-6]).yielded_volume is None
