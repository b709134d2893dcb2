"""Steady line film of a parabola plus a profile: known films, mirror image, ways that lead to one film."""

import numpy as np
import pytest

from bem import Lubricant
from bem.lubrication.line.case import LineCase
from bem.lubrication.line.shaped import ShapedContact
from bem.lubrication.line.steady import line_film

OIL = Lubricant(0.36, pressure_viscosity=25e-9, density_law="incompressible")
HALF_LENGTH = 45e-6


def case_of(speeds=(0.05, 0.0), radius=2e-3):
    return LineCase(5.5 / 6e-3, radius, 115.5e9, speeds, OIL, points=1000)


def contact_of(case):
    """The contact, and its film without a profile."""
    shaped = ShapedContact.of(case, line_film(case), HALF_LENGTH)
    return shaped, shaped.solve(np.zeros_like(shaped.position), shaped.unworn)


def groove(position, depth, radius=2e-3):
    """A groove that conforms to the cylinder, with a ridge beside the middle [m]."""
    conforming = np.clip(depth - np.maximum(position**2 - (5e-6) ** 2, 0) / (2 * radius), 0, None)
    return conforming * (1 - 0.3 * np.exp(-(((position - 6e-6) / 4e-6) ** 2)))


@pytest.mark.parametrize("speed", [0.01, 0.05, 0.2])
def test_without_a_profile_it_is_the_steady_film(speed):
    case = case_of((speed, 0.0))
    film, (_, found) = line_film(case), contact_of(case)
    assert found.film.minimum_thickness == pytest.approx(film.minimum_thickness, rel=4e-3)
    assert found.film.central_thickness == pytest.approx(film.central_thickness, rel=4e-3)
    assert found.film.load == pytest.approx(case.load, rel=1e-7)


@pytest.mark.parametrize("factor", [0.8, 1.25, 1.6])
def test_a_parabola_as_profile_makes_the_film_of_another_radius(factor):
    case, other = case_of(), case_of(radius=2e-3 * factor)
    shaped, without = contact_of(case)
    profile = shaped.position**2 * (1 / (2 * other.radius) - 1 / (2 * case.radius))
    found, known = shaped.solve(profile, without.start), line_film(other)
    assert found.film.minimum_thickness == pytest.approx(known.minimum_thickness, rel=8e-3)
    near = np.abs(found.film.position) < 3e-5
    x = found.film.position[near]
    pressure, thickness = known.at(x)
    assert found.film.thickness[near] == pytest.approx(thickness, rel=8e-3)
    assert found.film.pressure[near] == pytest.approx(pressure, abs=8e-3 * pressure.max())


def test_a_uniform_profile_changes_nothing():
    shaped, without = contact_of(case_of())
    found = shaped.solve(np.full_like(shaped.position, 3e-7), without.start)
    assert found.film.thickness == pytest.approx(without.film.thickness, rel=1e-6)


def test_entrainment_the_other_way_is_the_mirror_image():
    (ahead, first), (back, second) = contact_of(case_of((0.05, 0.0))), contact_of(case_of((-0.05, 0.0)))
    found = ahead.solve(groove(ahead.position, 2e-7), first.start)
    mirrored = back.solve(groove(-back.position, 2e-7), second.start)
    assert mirrored.film.thickness[::-1] == pytest.approx(found.film.thickness, rel=1e-6)


def test_a_deep_groove_at_once_and_in_steps_has_one_film():
    shaped, without = contact_of(case_of((0.02, 0.0)))
    at_once = shaped.solve(groove(shaped.position, 4e-7), without.start)
    start = without.start
    for depth in np.linspace(0, 4e-7, 9)[1:]:
        step = shaped.solve(groove(shaped.position, depth), start)
        start = step.start
    assert at_once.film.load == pytest.approx(case_of().load, rel=1e-7)
    assert at_once.film.thickness == pytest.approx(step.film.thickness, rel=1e-6)
    assert at_once.film.minimum_thickness > 1.02 * without.film.minimum_thickness


def test_the_film_of_another_load_is_a_start():
    low = LineCase(700.0, 2e-3, 115.5e9, (0.05, 0.0), OIL, points=1000)
    (one, first), (other, second) = contact_of(case_of()), contact_of(low)
    found = one.solve(groove(one.position, 3e-7), first.start)
    straight = other.solve(groove(other.position, 3e-7), second.start)
    start = other.start_from(one, found.start)
    again = other.solve(groove(other.position, 3e-7), start)
    assert again.film.thickness == pytest.approx(straight.film.thickness, rel=1e-6)
    assert again.film.load == pytest.approx(700.0, rel=1e-7)
