"""The part of a point film's error that where its grid ends has: on a far larger rectangle of the same cells."""

import math

import pytest

from bem import Lubricant, solve_point_film
from bem.errors import Status
from bem.lubrication.point.certificate import rectangle_error

pytestmark = pytest.mark.internal

OIL = Lubricant(0.05, pressure_viscosity=18e-9, density_law="dowson_higginson")
CELLS = 48


def case(ratio, degrees, load):
    """A steel ellipsoid with a mean speed of 1 m/s at an angle to x."""
    first = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return {
        "load": load, "radii": (0.01, 0.01 / ratio), "contact_modulus": 115e9, "speeds": (first, first),
        "lubricant": OIL,
    }  # fmt: skip


def scaled(film, factor):
    """Edges and cells of a rectangle so many times as far, of the same cells."""
    edges, shape = [], []
    for axis in (film.x, film.y):
        cell = float(axis[1] - axis[0])
        ends = float(axis[0]) - cell / 2, float(axis[-1]) + cell / 2
        more = [round((factor - 1) * abs(end) / cell) for end in ends]
        edges += [ends[0] - more[0] * cell, ends[1] + more[1] * cell]
        shape.append(len(axis) + sum(more))
    return {"extent": edges, "shape": tuple(shape)}


@pytest.mark.parametrize(
    ("ratio", "degrees", "load"), [(1.0, 0, 20.0), (0.2, 0, 100.0), (5.0, 25, 10.0), (0.2, 40, 50.0)]
)
@pytest.mark.parametrize("factor", [1.0, 1.4])
def test_errors_cover_what_a_far_larger_rectangle_changes(ratio, degrees, load, factor):
    own = case(ratio, degrees, load)
    film = solve_point_film(**own, shape=(CELLS, CELLS))
    if factor != 1:
        film = solve_point_film(**own, **scaled(film, factor))
    wide = solve_point_film(**own, **scaled(film, 2.5 / factor))
    assert film.status is wide.status is Status.CONVERGED
    allowed = rectangle_error(film.state.case)
    assert abs(wide.central_thickness / film.central_thickness - 1) < allowed
    assert abs(wide.minimum_thickness / film.minimum_thickness - 1) < allowed


def test_the_errors_of_a_film_have_it_beside_those_of_the_cells():
    film = solve_point_film(**case(1.0, 0, 20.0), shape=(128, 128))
    allowed = rectangle_error(film.state.case)
    assert film.central_thickness_error > allowed * film.central_thickness
    assert film.minimum_thickness_error > allowed * film.minimum_thickness


def test_a_rectangle_that_ends_sooner_has_a_larger_error():
    own = case(1.0, 0, 20.0)
    film = solve_point_film(**own, shape=(CELLS, CELLS))
    near = solve_point_film(**own, **scaled(film, 0.75))
    assert rectangle_error(near.state.case) > 3 * rectangle_error(film.state.case)
