"""Tribofilms under a ball in oil: the surfaces carry what load sharing leaves them; without oil, all of it."""

import numpy as np
import pytest

from bem import Body, Grid, Lubricant, Material, generate_surface, solve_mixed
from bem.errors import InfeasibleError, InputError
from bem.runs import plan_scene
from bem.scenes import library
from bem.tribofilm import FilmContact, solve_film_contact
from bem.tribofilm.growth import StressActivatedGrowth
from bem.tribofilm.properties import Constant
from bem.tribofilm.under_oil import under_oil

STEEL = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3)
GRID = Grid((64, 64), (5e-6, 5e-6))
HEIGHT = generate_surface(
    Grid(GRID.shape, GRID.spacing, periodic=(True, True)), rms_height=50e-9, correlation_length=20e-6, seed=3
)
RADII = (0.01, 0.01)


def rubbed(speeds):
    return FilmContact(
        gap=(GRID.x[:, None] ** 2 + GRID.y[None, :] ** 2) / 0.02 - HEIGHT,
        grid=GRID,
        substrate=STEEL,
        counterface=STEEL,
        load=20.0,
        growth=StressActivatedGrowth.from_electron_volts(1e-2, 0.665, 53.0),
        hardness=Constant(6e9),
        modulus=Constant(15e9),
        temperature=353.15,
        friction=0.12,
        speeds=speeds,
    )


@pytest.mark.internal
def test_surfaces_carry_what_load_sharing_leaves_them():
    speeds, oil = (0.2, 0.1), Lubricant(0.03, pressure_viscosity=18e-9, density_law="incompressible")
    given = rubbed(speeds)
    contact, _ = under_oil(given, HEIGHT, RADII, oil, 48)
    same = solve_mixed(
        height=HEIGHT, grid=GRID, bodies=(Body(STEEL), Body(STEEL)), radii=RADII, load=20.0, speeds=speeds,
        lubricant=oil, boundary_friction=0.12, hardness=6e9, film_cells=48, oil_volume="loaded",
    )  # fmt: skip
    assert contact.load == same.contact_load
    assert 0.01 * 20 < contact.load < 0.5 * 20
    # the tribofilm's contact without tribofilm is that of the balance
    found = solve_film_contact(given.__class__(**vars(contact) | {"speeds": None}), 0.0)
    assert found.contact_area == pytest.approx(same.contact_area, rel=1e-3)
    assert np.abs(found.pressure - same.contact_pressure).max() < 1e-3 * same.contact_pressure.max()


@pytest.mark.internal
def test_an_oil_next_to_none_leaves_the_dry_contact():
    given = rubbed((1e-5, 0.0))
    contact, _ = under_oil(
        given, HEIGHT, RADII, Lubricant(1e-3, pressure_viscosity=18e-9, density_law="incompressible"), 48
    )
    assert contact.load == pytest.approx(20.0, rel=3e-4)  # as tests/friction/test_ball.py
    cold = {"speeds": None}  # temperatures of spots are not looked at
    one, dry = (solve_film_contact(FilmContact(**vars(c) | cold), 5e-9) for c in (contact, given))
    assert one.growth == pytest.approx(dry.growth, rel=2e-3, abs=0)


@pytest.mark.internal
def test_a_film_that_carries_everything_grows_nothing():
    with pytest.raises(InfeasibleError, match="carries all of the load"):
        under_oil(
            rubbed((3.0, 3.0)),
            HEIGHT * 0.02,
            RADII,
            Lubricant(0.03, pressure_viscosity=18e-9, density_law="incompressible"),
            48,
        )


OIL = {"grade": "ISO VG 68", "temperature": "80 degC"}


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"shape": {"kind": "cylinder", "radius": "10 mm"}}, "anything but a ball"),
        ({"rubbing": {"speeds": ["0.1 m/s", "-0.1 m/s"]}}, "entrain"),
        ({"rubbing": {"temperatures": ["60 degC"]}}, "another temperature"),
        ({"oil": OIL | {"film_rheology": "shear_law"}}, "newtonian"),
    ],
)
def test_what_oil_needs_is_said(changes, said):
    scene = {**library()["tribofilm-ball"], "oil": OIL}
    assert plan_scene(scene, [])[0].oil is not None
    wrong = {key: {**scene[key], **value} if key == "rubbing" else value for key, value in changes.items()}
    with pytest.raises(InputError, match=said):
        plan_scene({**scene, **wrong}, [])
