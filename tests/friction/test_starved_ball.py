"""Load sharing under a ball that gets little oil: limits, and what a line contact has."""

import math

import numpy as np
import pytest
from mixed_case import BALL, rough_patch

from bem import Grid, InputError, generate_surface, solve_mixed
from bem.errors import Status
from bem.friction.setup import MixedSetup
from bem.lubrication.supply import InletDistance
from bem.reference_solutions.hertz import ellipse_contact

STEEL, GRID, OIL = BALL["bodies"][0], BALL["grid"], BALL["lubricant"]
ROUGH = rough_patch(40e-9)


def shared(layer, speeds=(1.0, 0.5), **changes):
    return solve_mixed(**BALL | changes, height=ROUGH, speeds=speeds, supply=layer)


@pytest.mark.slow
@pytest.mark.parametrize(("counted", "least"), [("loaded", 2e-8), ("patch", 4e-8)])
def test_plenty_of_oil_is_a_flooded_ball_and_less_has_more_contact(counted, least):
    flooded, plenty, some, little = (shared(layer, oil_volume=counted) for layer in (None, 1e-4, 5e-8, least))
    assert {one.status for one in (flooded, plenty, some, little)} == {Status.CONVERGED}
    assert plenty.contact_load == flooded.contact_load
    assert plenty.film.starvation.flooded
    assert flooded.contact_load < some.contact_load < little.contact_load
    assert 1 > some.film.starvation.reduction > little.film.starvation.reduction
    assert little.contact_load + little.film_load == pytest.approx(20.0, rel=1e-4)  # the balance's own tolerance


def test_a_thin_layer_goes_through_as_it_comes_whatever_the_speed():
    """The film is the layer then, and speed has no say in what the surfaces carry; a flooded ball's share falls to a
    quarter where speed doubles."""
    slow, fast = (shared(1e-8, (u, u)) for u in (0.1, 2.0))
    assert {slow.status, fast.status} == {Status.CONVERGED}
    for one in (slow, fast):
        assert one.film.central_thickness == pytest.approx(1e-8, rel=0.01)
    assert fast.contact_load == pytest.approx(slow.contact_load, rel=0.01)
    flooded = [shared(None, (u, u)).contact_load for u in (0.1, 0.2)]
    assert 0 < flooded[1] < 0.3 * flooded[0]


def test_a_layer_thinner_than_what_rough_surfaces_leave_open_is_boundary_lubrication():
    """Films of next to no load were not found, and one of millimetres was taken in their place."""
    rougher = Grid((64, 64), (5e-6, 5e-6), periodic=(True, True))
    height = generate_surface(rougher, rms_height=400e-9, correlation_length=20e-6, seed=3)
    found = solve_mixed(**BALL, height=height, speeds=(1.0, 0.5), supply=1e-8)
    assert found.status is Status.CONVERGED
    assert found.regime.value == "boundary"
    assert found.contact_load == pytest.approx(20.0, rel=1e-3)
    # as a full layer in Hertz contact, 109 um in radius, it would shear by this; it fills a tenth of the gap at most
    sheared = 0.03 * 0.5 / 1e-8 * math.pi * (1.09e-4) ** 2 / 20.0
    assert 0.12 < found.friction < 0.12 + 0.1**2 * sheared
    stress = np.abs(found.film_shear_stress).max()
    assert 0 < stress < 0.1**2 * 0.03 * 0.5 / 1e-8
    assert found.film.central_thickness == pytest.approx(1e-8, rel=0.05)


def test_a_long_ellipse_shares_its_load_as_a_cylinder_of_its_mean_pressure():
    """Twenty times as long in radius across: of a layer far thinner than the flooded film both make the same film, and
    the surfaces carry by film and pressure. Nothing but roughness is the same code: films and patches are others."""
    modulus, load = 210e9 / (2 * (1 - 0.3**2)), 300.0
    ellipse = ellipse_contact(radii=(0.01, 0.2), contact_modulus=modulus, load=load)
    line = ellipse.mean_pressure**2 * 16 * 0.01 / (math.pi * modulus)  # w = 2 a p, a^2 = 4 w R/(pi E*)
    side = GRID.lengths[1]
    tile = 1.5 * ROUGH  # 60 nm
    beside = math.ceil(2.6 * ellipse.semi_axes[1] / side)
    same = {key: BALL[key] for key in ("bodies", "lubricant", "boundary_friction", "oil_volume")}
    same |= {"speeds": (1.0, 0.9), "supply": 3e-8}
    patch = Grid((64, 64), (5e-6, 5e-6), periodic=(False, True))
    long = Grid((64, 64 * beside), (5e-6, 5e-6))
    roller = solve_mixed(**same, grid=patch, height=tile, radius=0.01, width=side, load=line * side)
    barrel = solve_mixed(
        **same, grid=long, height=np.tile(tile, (1, beside)), radii=(0.01, 0.2), load=load, film_cells=64
    )
    assert {roller.status, barrel.status} == {Status.CONVERGED}
    assert {roller.regime.value, barrel.regime.value} == {"mixed"}
    assert barrel.film.central_thickness == pytest.approx(roller.film.central_thickness, rel=1e-3)
    shares = roller.contact_load / roller.load, barrel.contact_load / barrel.load
    assert 0.1 < shares[0] < 0.3
    # 2 % at layers of 80, 50 and 20 nm: pressures are distributed otherwise, and other asperities lie under them
    assert shares[1] == pytest.approx(shares[0], rel=0.03)
    # of an ellipse more of the load is at low pressure, s^3 against 4 s^3/(3 pi) below s times the largest, where the
    # oil is not at its limit: 3.5 % less friction
    assert 0.95 < barrel.friction / roller.friction < 1


@pytest.mark.internal
@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"supply": InletDistance(2e-4)}, "supply: an InletDistance is a line contact's"),
        ({"supply": -1e-6}, "OilLayer.thickness: -1e-06 must be positive"),
        ({"supply": "much"}, "supply: 'much' must be an OilLayer"),
    ],
)
def test_bad_supplies_are_said(wrong, said):
    with pytest.raises(InputError, match=said):
        MixedSetup(**BALL | wrong)
