"""The largest tension of a contact that nothing comes off, beside closed forms: McEwen's line contact with friction,
Hertz' round one without, a thin layer that stretches with its substrate."""

import numpy as np
import pytest

from bem import Body, Grid, Layer, Material
from bem.wear import WearModel, WearSetup
from bem.wear.loads import SurfaceLoad
from bem.wear.setup import LOWER, UPPER
from bem.wear.yielding import largest_stress

pytestmark = pytest.mark.internal

STEEL = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3, hardness=7e9)
HALF, HIGHEST = 91e-6, 1.05e9
MODEL = WearModel(criterion="maximum_tension", wears="lower")


def line(cells=512, *, friction=0.1, layer=None, body=LOWER):
    """The largest tension under Hertz' pressure on a strip."""
    grid = Grid((cells, 8), (400e-6 / cells,) * 2, periodic=(False, True))
    pressure = HIGHEST * np.sqrt(np.clip(1 - (grid.x / HALF) ** 2, 0, None))[:, None] * np.ones((1, 8))
    bodies = (Body(STEEL) if layer is None else Body(STEEL, layer=layer), Body(STEEL))
    setup = WearSetup(grid, bodies, np.zeros(grid.shape), 1.0, friction, np.linspace(0, 2e-6, 5))
    return largest_stress(SurfaceLoad(pressure, friction), setup, MODEL, body)


@pytest.mark.parametrize("body", [LOWER, UPPER])
def test_a_line_contact_is_in_tension_by_friction_alone(body):
    """2 f p0 at the trailing edge (McEwen 1949): a peak as steep as a root, of which a cell sees 0.94."""
    assert line(body=body) == pytest.approx(2 * 0.1 * HIGHEST, rel=0.08)
    assert line(friction=0.0) < 0.01 * HIGHEST


@pytest.mark.parametrize(("cells", "across", "least", "most"), [(64, 29, 0.7, 0.8), (220, 100, 0.87, 0.93)])
def test_cells_see_of_the_peak_what_is_told(cells, across, least, most):
    """As the note on what nothing comes off by says; where the edge lies in its cell makes some per cents."""
    assert round(2 * HALF / (400e-6 / cells)) == across
    for friction in (0.1, 0.5):
        assert least < line(cells, friction=friction) / (2 * friction * HIGHEST) < most


@pytest.mark.parametrize("friction", [0.0, 0.1, 0.5])
def test_a_round_contact_is_in_tension_on_its_edge(friction):
    """(1 - 2 nu) p0 / 3 without friction (Johnson 1985, section 3.4), pi (4 + nu) f p0 / 8 more at the trailing edge
    with it (Hamilton and Goodman 1966): peaks as steep as a root, of which a cell sees 0.92 to
    0.99, and cells half as wide 0.94 to 1."""
    grid = Grid((256, 256), (300e-6 / 256,) * 2)
    x, y = np.meshgrid(grid.x, grid.y, indexing="ij")
    pressure = HIGHEST * np.sqrt(np.clip(1 - (x**2 + y**2) / HALF**2, 0, None))
    setup = WearSetup(grid, (Body(STEEL),) * 2, np.zeros(grid.shape), 1.0, friction, np.array([0.0, 1e-6]))
    tension = largest_stress(SurfaceLoad(pressure, friction), setup, MODEL, LOWER)
    share = (1 - 2 * 0.3) / 3 + np.pi * (4 + 0.3) / 8 * friction
    assert tension == pytest.approx(share * HIGHEST, rel=0.08)


@pytest.mark.parametrize(("modulus", "off"), [(70e9, 0.25), (400e9, 0.1)])
def test_a_thin_layer_stretches_with_its_substrate(modulus, off):
    """Its tension is the substrate's in the ratio of the plane moduli, as thin as it is; thicker ones of a soft layer
    bear more by the shear across them, of a stiff one less. 113 MPa in a layer of 70 GPa so took nothing off 400 MPa.
    """
    ratio = modulus / (1 - 0.22**2) / (210e9 / (1 - 0.3**2))
    found = []
    for thickness in (0.1e-6, 0.5e-6, 2e-6):
        made = Material("layer", youngs_modulus=modulus, poissons_ratio=0.22, hardness=6e9, yield_stress=400e6)
        found.append(line(layer=Layer(made, thickness)))
    membrane = ratio * line()
    assert found[0] == pytest.approx(membrane, rel=off)
    assert abs(found[0] - membrane) < abs(found[1] - membrane) < abs(found[2] - membrane)
    assert (found[2] > membrane) is (ratio < 1)
