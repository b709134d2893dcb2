"""Ball on a half-space with surface tension: both limits, and the contact solver against it."""

import math

import pytest

from bem import Body, Grid, Material, displacement_operator, solve_contact
from bem.reference_solutions.tense_ball import tense_ball

RADIUS, CONTACT, MODULUS = 1.0, 0.1, 2.0


def ball(ratio: float, terms: int = 24):
    """The contact at an elastocapillary length of so many contact radii."""
    return tense_ball(CONTACT, RADIUS, MODULUS, 0.5 * ratio * MODULUS * CONTACT, terms)


def test_tension_alone_is_a_film_under_the_pressure_of_a_drop() -> None:
    """The pressure is 2 gamma / R; elasticity adds a part of the order a / s."""
    off = []
    for ratio in (1e3, 1e4):
        found = ball(ratio)
        film = 2 * 0.5 * ratio * MODULUS * CONTACT / RADIUS
        off.append(found.load / (math.pi * CONTACT**2 * film) - 1)
        assert found.maximum_pressure == pytest.approx(film, rel=3 / ratio)
    assert off[0] == pytest.approx(10 * off[1], rel=0.01)
    assert 0 < off[1] < 1e-3


def test_little_tension_is_hertz() -> None:
    hertz = 4 / 3 * MODULUS * CONTACT**3 / RADIUS
    off = [ball(ratio, 40).load / hertz - 1 for ratio in (0.02, 0.01)]
    assert 0.0 < off[1] < 0.07
    assert 1.6 < off[0] / off[1] < 2  # of first order, but for a logarithm
    assert ball(0.01, 40).approach == pytest.approx(CONTACT**2 / RADIUS, rel=0.05)


def test_expansion_converges() -> None:
    for ratio in (0.1, 1.0, 10.0):
        coarse, fine = ball(ratio, 20), ball(ratio, 40)
        assert coarse.load == pytest.approx(fine.load, rel=1e-4)
        assert coarse.approach == pytest.approx(fine.approach, rel=2e-5)
        assert coarse.maximum_pressure == pytest.approx(fine.maximum_pressure, rel=5e-5)


@pytest.mark.parametrize("ratio", [0.1, 1.0, 10.0])
def test_contact_solver_finds_it(ratio: float) -> None:
    """Approach of second order. The pressure ends on a step, so that the area is of first order."""
    exact = ball(ratio, 40)
    gel = Material("gel", youngs_modulus=MODULUS, poissons_ratio=0.0, surface_tension=0.5 * ratio * MODULUS * CONTACT)
    areas = []
    for cells in (32, 64, 128):
        grid = Grid((cells, cells), (2.6 * CONTACT / cells,) * 2)
        gap = (grid.x[:, None] ** 2 + grid.y**2) / (2 * RADIUS)
        found = solve_contact(gap, displacement_operator(grid, Body(gel)), load=exact.load)
        assert found.approach == pytest.approx(exact.approach, rel=0.25 / cells**2, abs=0)
        areas.append(found.contact_area / (math.pi * CONTACT**2) - 1)
        middle = found.pressure[cells // 2 - 1 : cells // 2 + 1, cells // 2 - 1 : cells // 2 + 1].mean()
        assert middle == pytest.approx(exact.maximum_pressure, rel=2 / cells**2 + 1e-4)
    assert all(0 < area < 0.8 / cells for area, cells in zip(areas, (32, 64, 128), strict=True))
