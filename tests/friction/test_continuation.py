"""What one speed leaves to the next: fewer films and contacts, meshes whose weights are known, the same answers."""

import dataclasses
import pickle

import numpy as np
import pytest
from mixed_case import BALL, mixed_case, rough_patch, steel_line

from bem import Body, Grid, Lubricant, Material, Status, generate_surface, solve_line_film, solve_mixed, stribeck_curve
from bem.friction import point_film
from bem.friction.balance import BalanceStart, Regime
from bem.friction.film_table import FilmTable
from bem.friction.models import films_of
from bem.friction.setup import MixedSetup
from bem.lubrication.line import deflection as line_kernel
from bem.lubrication.line import linear as line_linear
from bem.lubrication.line.case import LineCase
from bem.lubrication.line.state import interpolate_to_mesh, without_factors
from bem.lubrication.line.steady import line_film

OIL = Lubricant(0.36, pressure_viscosity=25e-9, density_law="incompressible")
CASE = mixed_case(48, 90e-6 / 48, 4e-6, lubricant=OIL, boundary_friction=0.15, film_points=800)
SPEEDS = np.geomspace(0.003, 0.2, 8)
FILM = {"load": 300.0, "radius": 2e-3, "contact_modulus": 115.4e9, "lubricant": OIL}


@pytest.fixture(scope="module")
def curve():
    return stribeck_curve(SPEEDS, **CASE)


@pytest.mark.internal
def test_a_curve_is_that_of_its_speeds_alone(curve):
    cold = [solve_mixed(**CASE, speeds=(speed, 0.0)) for speed in SPEEDS]
    assert {point.regime for point in curve} == {Regime.MIXED, Regime.FULL_FILM}
    for one, other in zip(curve, cold, strict=True):
        assert one.status is other.status is Status.CONVERGED
        assert one.regime is other.regime
        # balances within 1e-4, of the film's thickness; meshes of 800 nodes differ by some 1e-4 of it
        assert one.friction == pytest.approx(other.friction, rel=1e-3)
        assert one.film_load == pytest.approx(other.film_load, rel=1e-3)
    mixed = [(a, b) for a, b in zip(curve[1:], cold[1:], strict=True) if a.regime is Regime.MIXED]
    assert sum(a.evaluations for a, _ in mixed) <= sum(b.evaluations for _, b in mixed) - 2 * len(mixed)
    assert sum(a.contact_solves for a, _ in mixed) <= sum(b.contact_solves for _, b in mixed) - 2 * len(mixed)


def test_next_to_full_film_no_film_of_next_to_no_load_is_tried():
    """A slope with ln(film load) is that with ln(film load / rest) over the rest: taken for the same at less rest, it
    sent the search to the other end, 14 Newton steps and a contact of 19 convolutions, and back in 51 and more."""
    roller = Material("steel", youngs_modulus=207e9, poissons_ratio=0.3)
    modulus, pressure, radius, width = 207e9 / 0.91 / 2, 1.5e9, 8e-3, 10e-3
    length = 6.4 * pressure * radius / modulus
    grid = Grid((60, 20), (length / 60, length / 60), periodic=(False, True))
    whole = Grid(grid.shape, grid.spacing, periodic=(True, True))
    case = steel_line(
        grid,
        bodies=(Body(roller), Body(roller)),
        height=generate_surface(whole, rms_height=150e-9, seed=5, correlation_length=30e-6),
        radius=radius,
        width=width,
        load=np.pi * pressure**2 * radius * width / modulus,
        lubricant=Lubricant(0.06, pressure_viscosity=20e-9, density_law="incompressible"),
        boundary_friction=0.12,
        film_points=800,
    )
    speeds = [(u, 0.95 * u) for u in np.geomspace(0.01, 0.9, 6)]
    curve = stribeck_curve(speeds, **case)
    assert all(point.status is Status.CONVERGED for point in curve)
    shares = [point.film_load / point.load for point in curve]
    assert 0.8 < min(shares) < max(shares) < 0.999
    # the film under the whole load, one to three on few nodes, one or two on all
    assert max(point.evaluations for point in curve[1:]) <= 6


@pytest.mark.internal
def test_a_slope_is_moved_with_the_odds():
    start = BalanceStart.from_similar(0.8, 2.0, 10.0, 9.0, None)
    assert start.slope * (1 - 0.9) == pytest.approx(2.0 * (1 - 0.8), rel=1e-12)
    assert start.slope_known


@pytest.mark.internal
def test_a_curve_in_full_film_makes_weights_twice(monkeypatch):
    """Of the coarse mesh and of the fine one; at every speed before."""
    made = []
    usual = line_kernel.LineOperator.of.__func__
    monkeypatch.setattr(
        line_kernel.LineOperator, "of", classmethod(lambda own, nodes: (made.append(len(nodes)), usual(own, nodes))[1])
    )
    case = CASE | {"height": 0.02 * CASE["height"]}
    first = stribeck_curve([0.2], **case)
    once = len(made)
    curve = stribeck_curve(np.geomspace(0.2, 1.0, 6), **case)
    assert all(point.regime is Regime.FULL_FILM for point in curve)
    assert len(made) == 2 * once
    assert curve[0].friction == first[0].friction


@pytest.mark.internal
def test_a_film_next_to_another_is_found_by_chord_steps_alone(monkeypatch):
    near = line_film(LineCase(**FILM, speeds=(0.05, 0.0)))
    taken = []
    usual = line_linear.factorise
    monkeypatch.setattr(line_linear, "factorise", lambda *given: (taken.append(1), usual(*given))[1])
    changed = FILM | {"load": 300.3}
    film = solve_line_film(**changed, speeds=(0.05, 0.0), initial=near)
    assert not taken
    assert film.status is Status.CONVERGED
    assert film.residual <= 1e-8
    bare = solve_line_film(**changed, speeds=(0.05, 0.0), initial=without_factors(near))
    assert taken
    np.testing.assert_allclose(film.thickness, bare.thickness, rtol=1e-7)  # residuals of 1e-8 of the film
    np.testing.assert_allclose(film.pressure, bare.pressure, atol=1e-6 * bare.pressure.max())


def test_a_curve_keeps_no_factored_equations(curve):
    for point in curve:
        assert point.film.state.state.factored is None
        assert point.film.state.flooded.factored is None
        assert point.continuation.whole_film.solution.state.state.factored is None


@pytest.mark.internal
def test_a_film_on_the_mesh_of_another_is_itself():
    coarse = solve_line_film(**FILM, speeds=(0.05, 0.0), points=400)
    other = solve_line_film(**FILM, speeds=(0.08, 0.0), points=1500)
    start = interpolate_to_mesh(coarse, other)
    state, mesh = start.state.state, other.state.state
    assert state.operator.nodes is mesh.operator.nodes  # its weights are known
    inside = (state.position > 2 * coarse.state.state.position[0] / 3) & (state.position < 0)
    at = state.position[inside] * coarse.state.scales.length
    # cubics through 400 nodes
    np.testing.assert_allclose(state.film[inside] * coarse.state.scales.film, coarse.at(at)[1], rtol=2e-3)
    found = solve_line_film(**FILM, speeds=(0.05, 0.0), points=1500, initial=start)
    own = solve_line_film(**FILM, speeds=(0.05, 0.0), points=1500)
    assert found.minimum_thickness == pytest.approx(own.minimum_thickness, rel=2e-4)
    assert interpolate_to_mesh(coarse, dataclasses.replace(other, state=None)) is coarse


@pytest.mark.internal
def test_a_ball_under_more_than_films_are_solved_for_solves_one(monkeypatch):
    """All trials of its balance go on from one film: five were solved for two."""
    point_film.KEPT.clear()
    asked = []
    usual = point_film.solve_point_film

    def counted(**case):
        asked.append((case["load"], case["shape"]))
        return usual(**case)

    monkeypatch.setattr(point_film, "solve_point_film", counted)
    creeping = BALL | {"height": rough_patch(200e-9), "film_cells": 32}
    point = solve_mixed(**creeping, speeds=(1e-3, 1e-3))
    assert point.status is Status.CONVERGED
    assert len(asked) == len(set(asked))
    assert len(asked) < point.evaluations
    again = solve_mixed(**creeping, speeds=(1e-3, 1e-3))
    assert len(asked) == len(set(asked))
    assert again.friction == point.friction


@pytest.mark.internal
def test_a_film_that_is_kept_is_not_changed_by_who_got_it():
    """In micrometres for a picture, in place: the next balance was that of a film a million times as thick."""
    point_film.KEPT.clear()
    rolling = BALL | {"height": rough_patch(200e-9), "film_cells": 32}
    first = solve_mixed(**rolling, speeds=(0.5, 0.5))
    first.film.thickness[:] *= 1e6
    first.film.pressure[:] = np.nan
    again = solve_mixed(**rolling, speeds=(0.5, 0.5))
    assert (again.friction, again.film_load) == (first.friction, first.film_load)
    assert again.film.thickness.min() < 1e-6


@pytest.mark.internal
def test_equations_are_not_kept_in_a_table():
    """Megabytes each; its films lie too far apart to start by them."""
    given = {name: value for name, value in CASE.items() if name != "height"}
    setup = MixedSetup(**given)
    table = FilmTable(films_of(setup, (0.02, 0.0)), load=setup.load)
    for index in range(3):
        assert table.entry(index).status is Status.CONVERGED
        assert table.entry(index).state.state.factored is None
        assert table.entry(index).state.flooded.factored is None


@pytest.mark.parametrize("speeds", [SPEEDS[3::-1], [0.02, 0.5, 0.003], [0.02, 0.02], [1e-6, 0.05]])
def test_a_curve_goes_on_from_what_was_written_down(speeds):
    """Down, from regime to regime, at the same speed again, decades apart: the bits of an uninterrupted one."""
    whole, last = stribeck_curve(speeds, **CASE), None
    for speed, point in zip(speeds, whole, strict=True):
        last = solve_mixed(**CASE, speeds=(speed, 0.0), initial=pickle.loads(pickle.dumps(last)))
        assert (last.friction, last.film_load, last.minimum_film) == (
            point.friction,
            point.film_load,
            point.minimum_film,
        )
        cold = solve_mixed(**CASE, speeds=(speed, 0.0))
        assert (last.status, last.regime) == (cold.status, cold.regime)
        # both within 1e-4 of the film's oil; friction moves by a few times as much at most
        assert last.friction == pytest.approx(cold.friction, rel=1e-3)
