"""Films between worn bodies: those of another radius, of no shape, and beyond the loads that were solved."""

import math

import numpy as np
import pytest

from bem import Lubricant, Status
from bem.friction.film_table import FilmTable
from bem.friction.line_film import SolvedLineFilm
from bem.friction.smooth import LineContact
from bem.friction.worn_film import LATTICE_STEP, SearchedWornFilms, ShapeSolver, neighbours

OIL = Lubricant(0.36, pressure_viscosity=25e-9, density_law="incompressible")
POSITION = (np.arange(100) - 49.5) * 0.9e-6
SPEEDS = (0.05, 0.0)


def table_of(radius=2e-3, deforming=None):
    contact = LineContact(radius, 6e-3, 115.5e9, OIL, deforming_load=deforming)
    return FilmTable(SolvedLineFilm(contact, SPEEDS, POSITION, 800), load=5.5)


def solver_of(table):
    return ShapeSolver(table, table.contact, SPEEDS, POSITION)


@pytest.mark.parametrize("deforming", [None, 5.5])
def test_without_changes_the_films_are_the_unworn_ones(deforming):
    table = table_of(deforming=deforming)
    films = solver_of(table).films(np.zeros_like(POSITION), {})
    worn, unworn = films.under(3.0), table.under(3.0)
    assert np.array_equal(worn.thickness, unworn.thickness)
    assert np.array_equal(worn.pressure, unworn.pressure)
    assert worn.shear_force == unworn.shear_force


@pytest.mark.parametrize(("load", "deforming"), [(500.0, None), (350.0, 600.0)])
def test_the_shape_of_another_radius_makes_its_films(load, deforming):
    """Under a load that makes a film within some half-widths, beyond which the shape does not go on."""
    oil, speeds, x = (
        Lubricant(0.05, pressure_viscosity=25e-9, density_law="incompressible"),
        (1.0, 0.5),
        (np.arange(120) - 59.5) * 5e-6,
    )

    def table(radius):
        contact = LineContact(radius, 6e-3, 115.5e9, oil, deforming_load=deforming)
        return FilmTable(SolvedLineFilm(contact, speeds, x, 800), load=600.0)

    unworn, other = table(5e-3), table(6e-3)
    shape = x**2 * (1 / 12e-3 - 1 / 10e-3)
    solver = ShapeSolver(unworn, unworn.contact, speeds, x)
    film, known = SearchedWornFilms(solver, shape - shape.min()).under(load), other.under(load)
    assert abs(unworn.under(load).minimum_thickness / known.minimum_thickness - 1) > 0.05
    assert film.minimum_thickness == pytest.approx(known.minimum_thickness, rel=1e-2)
    assert film.shear_force == pytest.approx(known.shear_force, rel=1e-2)
    near = np.abs(x) < 1.5e-4
    ratio = film.thickness[near] / known.thickness[near]
    assert np.abs(ratio - 1).mean() < 5e-3  # the constriction lies within two cells
    assert np.abs(film.pressure - known.pressure).mean() < 2e-2 * known.pressure.max()
    if deforming is not None:
        uniform = (film.gap - known.gap)[near]  # a gap is known but for a constant
        assert np.ptp(uniform) < 2e-2 * np.ptp(known.gap[near])


def test_films_between_two_solved_loads_are_those_solved_there():
    table = table_of()
    solver, shape = solver_of(table), 2e-7 * np.exp(-((POSITION / 1.2e-5) ** 2))
    load = 5.5 * math.exp(-4.5 * LATTICE_STEP)
    between = SearchedWornFilms(solver, shape).under(load)
    exact = solver_of(table)
    (index, step) = 9, LATTICE_STEP / 2
    assert load == pytest.approx(5.5 * math.exp(-index * step))
    contact = exact._solved_unworn(load)
    profile = np.interp(contact[0].position, POSITION, shape)
    film = contact[0].solve(profile, contact[1].start).film
    ratio = film.minimum_thickness / contact[1].film.minimum_thickness
    assert between.minimum_thickness / table.under(load).minimum_thickness == pytest.approx(ratio, rel=1e-3)
    assert abs(ratio - 1) > 0.01


def test_beyond_the_solved_loads_the_nearest_change_counts():
    solver = solver_of(table_of())
    shape = 2e-7 * np.exp(-((POSITION / 1.2e-5) ** 2))
    found = {index: solver.film(index, shape, {}) for index in (3, 4)}
    films = solver.films(shape, {index: film.change for index, film in found.items()})
    low = films.under(0.01)
    assert low.minimum_thickness == pytest.approx(
        solver.unworn.under(0.01).minimum_thickness * math.exp(found[4].change.minimum_thickness), rel=1e-12
    )
    thick = [films.under(load).minimum_thickness for load in np.geomspace(5.5, 0.01, 30)]
    assert (np.diff(thick) > 0).all()


def test_a_film_that_is_not_found_is_said_so(monkeypatch):
    monkeypatch.setattr("bem.lubrication.line.shaped.ShapedContact.solve", lambda self, profile, start: None)
    film = SearchedWornFilms(solver_of(table_of()), np.full_like(POSITION, 1e-7)).under(2.0)
    assert film.status is Status.STALLED


def test_neighbours_on_the_lattice():
    assert neighbours(5.5, 5.5) == (0,)
    assert neighbours(5.5 * math.exp(-1.5 * LATTICE_STEP), 5.5) == (1, 2)
    assert neighbours(5.5 * math.exp(-3 * LATTICE_STEP), 5.5) == (3,)
