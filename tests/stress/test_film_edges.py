"""Films at their edges: M from 0.001 to 3000, L to 20; what comes out converged is checked, the rest says so."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bem import Body, Grid, InputError, Lubricant, Material, Status, march_line_film, solve_line_film, solve_mixed
from reports.benchmarks.line_film import similarity_case

LOADS = (0.001, 0.03, 1.0, 30.0, 3000.0)


@pytest.mark.parametrize("piezo", [0.0, 1.0, 5.0, 10.0, 20.0])
def test_films_over_the_whole_map(piezo):
    """Loads carried, films positive, and thinner the heavier; warm from the load before, as a user would go."""
    films = []
    for load in LOADS:
        case, unit = similarity_case(load, piezo)
        film = solve_line_film(**case, points=300)
        if film.status is not Status.CONVERGED:
            films.append(math.nan)
            continue
        assert film.load == pytest.approx(case["load"], rel=1e-6)
        assert (film.pressure >= 0).all()
        assert (film.thickness > 0).all()
        films.append(film.minimum_thickness / unit)
    solved = np.array(films)[~np.isnan(films)]
    assert (np.diff(solved) < 0).all()
    # incompressible Roelands films sharpen without limit above L = 6 to 10: there a clear status may end the map
    assert solved.size == len(LOADS) if piezo <= 5 else solved.size >= 3


@settings(max_examples=12, deadline=None)
@given(st.floats(math.log(1e-3), math.log(3e3)), st.floats(0, 8))
def test_any_film_is_converged_and_right_or_says_no(log_load, piezo):
    case, _ = similarity_case(math.exp(log_load), piezo)
    try:
        film = solve_line_film(**case, points=200)
    except InputError:
        return
    if film.status is Status.CONVERGED:
        assert film.load == pytest.approx(case["load"], rel=1e-6)
        assert film.thickness.min() > 0
        assert film.minimum_thickness <= film.central_thickness * (1 + 1e-12)


@pytest.mark.parametrize("speeds", [(-0.1, 0.0), (0.1, -0.0999999), (1e-9, 0.0), (1e4, 0.0)])
def test_extreme_speeds_end_in_a_film_or_a_clear_answer(speeds):
    oil = Lubricant(0.36, pressure_viscosity=25e-9, density_law="incompressible")
    try:
        film = solve_line_film(load=900.0, radius=2e-3, contact_modulus=115e9, speeds=speeds, lubricant=oil, points=200)
    except InputError:  # a film that no equation of this kind describes is refused before any work
        return
    if film.status is Status.CONVERGED:
        assert np.isfinite(film.pressure).all()
        assert film.load == pytest.approx(900.0, rel=1e-6)


@pytest.mark.slow
def test_speed_and_load_reversed_in_time():
    times = np.linspace(0, 4e-3, 21)
    films = march_line_film(
        times,
        load=lambda t: 900.0 * (1 + 0.5 * math.sin(2 * math.pi * t / 4e-3)),
        speeds=lambda t: (0.1 * math.cos(2 * math.pi * t / 4e-3), 0.0),
        radius=2e-3,
        contact_modulus=115e9,
        lubricant=Lubricant(0.36, pressure_viscosity=15e-9, density_law="incompressible"),
    )
    assert len(films) == times.size
    for film in films:
        assert film.status is Status.CONVERGED
        assert film.thickness.min() > 0
        assert np.isfinite(film.pressure).all()


STEEL = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3)


def mixed(**change):
    grid = Grid((40, 40), (2e-6, 2e-6), periodic=(False, True))
    case = {
        "height": 1e-7 * np.random.default_rng(0).standard_normal(grid.shape),
        "grid": grid,
        "bodies": (Body(STEEL), Body(STEEL)),
        "radius": 2e-3,
        "width": 6e-3,
        "load": 5.5,
        "speeds": (0.03, 0.0),
        "lubricant": Lubricant(0.36, pressure_viscosity=25e-9, density_law="incompressible"),
        "boundary_friction": 0.15,
        "hardness": 6e9,
        "film_points": 200,
    }
    return solve_mixed(**(case | change))


@pytest.mark.parametrize(
    "change",
    [
        {"speeds": (1e-6, 0.0)},
        {"speeds": (5.0, 0.0)},
        {"height": np.zeros((40, 40))},
        {"boundary_friction": 0.0},
        {"boundary_friction": 1.0},
        {"hardness": None},
        {"load": 1e-3},
        {"load": 20.0},
    ],
    ids=lambda c: next(iter(c)) + "=" + str(next(iter(c.values())))[:8].replace("\n", ""),
)
def test_load_sharing_from_boundary_to_full_film(change):
    point = mixed(**change)
    load = change.get("load", 5.5)
    assert point.status is Status.CONVERGED
    assert point.contact_load + point.film_load == pytest.approx(load, rel=2e-4)  # the tolerance
    assert 0 <= point.contact_load <= load * (1 + 2e-4)
    assert 0 <= point.friction < 1.1
