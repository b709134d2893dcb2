"""Load of an asperity among its neighbours: Hertz where it stands alone, less to press in where they help."""

import math

import numpy as np
import pytest

from bem import Body, Grid, InputError, Material, Status, contact_modulus
from bem.convolution import displacement_operator
from bem.friction.asperity_array import SQUARE_LATTICE, press_array

pytestmark = pytest.mark.internal

STEEL = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3)
RADIUS, HEIGHT, DEPTHS = 20e-6, 0.5e-6, np.array([10e-9, 20e-9])
MODULUS = contact_modulus(STEEL)


def pressed(spacing, cells, depths=DEPTHS):
    grid = Grid((cells, cells), (spacing / cells, spacing / cells), periodic=(True, True))
    return press_array(
        displacement_operator(grid, Body(STEEL)),
        radius=RADIUS,
        height=HEIGHT,
        contact_modulus=MODULUS,
        depths=depths,
        window=10 * spacing,
    )


def test_neighbours_lift_an_asperity_by_the_potential_of_the_lattice():
    found = pressed(16e-6, 128)
    assert found.status is Status.CONVERGED
    assert found.alone == pytest.approx(4 / 3 * MODULUS * math.sqrt(RADIUS) * DEPTHS**1.5, rel=1e-14)
    # from the mean plane: depth = Hertz' (3P / 4E* sqrt R)^(2/3) - C P / (pi E* s), all others as point loads
    load = found.mean_plane
    hertz = (3 * load / (4 * MODULUS * math.sqrt(RADIUS))) ** (2 / 3)
    depth = hertz - SQUARE_LATTICE * load / (math.pi * MODULUS * 16e-6)
    # contacts of 4 to 5 cells in radius: some per cent of the load; without the lattice it would be 5 to 8
    assert depth == pytest.approx(DEPTHS, rel=0.025)
    assert (found.mean_plane > found.alone).all()
    assert (found.from_flat < found.mean_plane).all()


def test_an_array_that_ends_sinks_in_by_the_deflection_under_its_mean_pressure():
    """At the middle of a square of side W under a uniform pressure q, 4 asinh(1) q W / (pi E*) (Johnson 1985, section
    3.3): the depth from the flat less that is the depth from the mean plane, under the same load."""
    spacing = 8e-6
    load = pressed(spacing, 64).from_flat
    sunk = 4 * math.log(1 + math.sqrt(2)) * load / spacing**2 * (10 * spacing) / (math.pi * MODULUS)
    assert ((sunk > 0.1 * DEPTHS) & (sunk < 0.9 * DEPTHS)).all()
    # each array interpolates between its own fourteen loads, of contacts of some cells
    assert pressed(spacing, 64, DEPTHS - sunk).mean_plane == pytest.approx(load, rel=0.01, abs=0)


def test_depths_beyond_the_loads_are_refused():
    with pytest.raises(InputError, match="cannot be reached"):
        pressed(3e-6, 16, depths=np.array([1e-9, 400e-9]))
