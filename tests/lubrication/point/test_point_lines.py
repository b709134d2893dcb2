"""Line relaxation of point contacts: a line is solved with the films that its own changes make; memory of a grid."""

import tracemalloc

import numpy as np
import pytest

from bem import Lubricant, solve_point_film
from bem.lubrication.point import line_relaxation, newton, reynolds
from bem.lubrication.point.linear_system import to_single_precision
from bem.lubrication.point.newton import residual_of

SPACING, STORING = (0.3, 0.2), 0.7


def problem_of(drag, shape):
    """Derivatives and films under a change, at random; of oil along x alone films beside a line are not counted."""
    rng = np.random.default_rng(5)
    stencil = rng.uniform(0.5, 1.5, (13, *shape))
    stencil[[1, 5]] *= -1
    near = rng.uniform(0.0, 0.3, (2, line_relaxation.REACH + 1, 3))
    if drag[1] == 0:
        stencil[6:8] = 0.0
    return stencil, near, rng.normal(size=shape)


def balances(stencil, drag, dp, film, along_y=0):
    """Changes of the balances by `reynolds.apply_jacobian`, with Couette flow across lines of first order."""
    out = np.zeros(dp.shape)
    along = (0.0, drag[1]) if along_y else (drag[0], 0.0)
    reynolds.apply_jacobian(stencil, SPACING, along, STORING, dp, film, out)
    across = 1 - along_y
    if drag[across]:
        flow = stencil[11 + across] * (stencil[9] * film + stencil[10] * dp)
        out += (flow - np.roll(flow, 1, axis=across)) / SPACING[across]
    return out


@pytest.mark.internal
@pytest.mark.parametrize("drag", [(1.0, 0.0), (0.8, 0.6)])
@pytest.mark.parametrize("downwards", [False, True])
def test_a_line_alone_leaves_nothing_of_its_balances(drag, downwards):
    """Against `reynolds.apply_jacobian` of the whole grid; five cells, so that the band holds all of their coupling."""
    shape, j = (5, 5), 2
    stencil, near, residual = problem_of(drag, shape)
    if drag[1] == 0:
        near[:, :, 1:] = 0.0
    kinds = np.zeros(shape, np.int8)
    kinds[1:4, j] = 1, 2, 1
    dp = np.full(shape, np.nan)
    factors = np.zeros((*shape, line_relaxation.FACTORS))
    line_relaxation.factorise(stencil, SPACING, drag, STORING, 0, near, kinds, factors)
    line_relaxation.relax(
        factors, stencil, SPACING, drag, STORING, 0, near, kinds, residual, downwards, (1.0, 1.0), True, dp
    )
    squares = SPACING[0] ** 2 + SPACING[1] ** 2
    along, across = 0.5 * SPACING[1] ** 2 / squares, 0.5 * SPACING[0] ** 2 / squares
    middle = -dp[2, j - 1] / across
    assert dp[2, j + 1] == pytest.approx(-across * middle, rel=1e-14)
    changes = [dp[1, j] + along * middle, middle, dp[3, j] + along * middle]
    film = np.zeros(shape)
    for i, change in zip((1, 2, 3), changes, strict=True):
        for k in range(5):
            for n in range(5):
                film[k, n] += change * near[kinds[i, j] - 1, abs(k - i), abs(n - j)]
    assert np.abs(changes).min() > 1e-3
    np.testing.assert_allclose(balances(stencil, drag, dp, film)[1:4, j], residual[1:4, j], rtol=1e-11)


@pytest.mark.internal
@pytest.mark.parametrize("drag", [(1.0, 0.0), (0.8, 0.6)])
@pytest.mark.parametrize("along_y", [0, 1])
def test_the_last_line_of_a_sweep_is_solved_with_what_those_before_it_have_changed(drag, along_y):
    """Pressures and films: with three lines of three cells, none is out of reach. Lines along either axis."""
    shape = (5, 5)
    stencil, near, residual = problem_of(drag, shape)
    stencil[[2, 3, 6, 7]] = 0.0  # films of lines further ahead
    kinds = np.zeros(shape, np.int8)
    kinds[1:4, 1:4] = 1
    factors, dp = np.zeros((*shape, line_relaxation.FACTORS)), np.full(shape, np.nan)
    line_relaxation.factorise(stencil, SPACING, drag, STORING, along_y, near, kinds, factors)
    line_relaxation.relax(
        factors, stencil, SPACING, drag, STORING, along_y, near, kinds, residual, False, (1.0, 1.0), True, dp
    )
    film = np.zeros(shape)
    for i in range(1, 4):
        for j in range(1, 4):
            for k in range(5):
                for n in range(5):
                    apart = (abs(n - j), abs(k - i)) if along_y else (abs(k - i), abs(n - j))
                    if (
                        apart[1] <= line_relaxation.COUPLED_LINES
                    ):  # further ones are of lines that no balance of the last one hears of
                        film[k, n] += dp[i, j] * near[0, apart[0], apart[1]]
    last = np.s_[3, 1:4] if along_y else np.s_[1:4, 3]
    done = balances(stencil, drag, dp, film, along_y)[last]
    np.testing.assert_allclose(done, residual[last], rtol=1e-11)


def rolling(drag, cells):
    """The film of a ball that rolls along `drag`."""
    return solve_point_film(
        load=20.0,
        radii=(0.01, 0.01),
        contact_modulus=1.15e11,
        speeds=((0.5 * drag[0], 0.5 * drag[1]),) * 2,
        lubricant=Lubricant(0.04, pressure_viscosity=22e-9, density_law="incompressible"),
        shape=(cells, cells),
    )


@pytest.mark.internal
@pytest.mark.parametrize(("drag", "most", "cycles"), [((1.0, 0.0), 76, 28), ((0.8, 0.6), 108, 12)])
def test_a_grid_keeps_76_bytes_a_cell_and_108_of_oil_at_an_angle(drag, most, cycles):
    """Derivatives and the factors of its lines; of oil that comes at an angle, lines along both axes. Where lines did
    not hear what those before them made of films, and oil was dragged across them of third order, it took 56 cycles."""
    film = rolling(drag, 48)
    kept = film.state
    system = residual_of(kept.level, kept.state, np.zeros(kept.level.shape)).system
    for back in (False, True):
        system.relax_lines(np.ones(system.film.shape), back)
    made = [one for one in vars(system).values() if isinstance(one, np.ndarray) and one.ndim == 3]
    assert sum(one.nbytes for one in made) == most * system.film.size
    assert film.cycles <= 1.1 * cycles  # the cascade and all


@pytest.mark.internal
@pytest.mark.parametrize("drag", [(1.0, 0.0), (0.8, 0.6)])
def test_lines_are_eliminated_once_for_all_sweeps(drag, monkeypatch):
    """A Newton step sweeps its grid three to seven times; it took as many eliminations. As good in half the digits: a
    sweep differs from that of whole ones by rounding."""
    made, swept, factorise, relax = [], [], line_relaxation.factorise, line_relaxation.relax

    def counted(*asked):
        made.append(asked[0].shape[1:])
        factorise(*asked)

    def relaxed(*asked):
        swept.append(asked[1].shape[1:])
        relax(*asked)

    monkeypatch.setattr(line_relaxation, "factorise", counted)
    monkeypatch.setattr(line_relaxation, "relax", relaxed)
    film = rolling(drag, 64)
    ways = 1 if drag[1] == 0 else 2
    assert made.count((64, 64)) <= ways * film.iterations < swept.count((64, 64)) / 2
    kept = film.state
    system = residual_of(kept.level, kept.state, np.zeros(kept.level.shape)).system
    right = np.random.default_rng(7).normal(size=kept.level.shape) * np.abs(system.derivatives[8])
    half = system.relax_lines(right, backward=False)
    whole = np.zeros((64, 64, line_relaxation.FACTORS))
    problem = kept.level.problem
    near, steps = kept.level.near_influence, kept.level.spacing
    factorise(system.derivatives, steps, problem.entrainment, problem.storage_rate, 0, near, system.kinds, whole)
    vars(system)["_lines_along_x"] = whole
    np.testing.assert_allclose(half, system.relax_lines(right, backward=False), rtol=0, atol=1e-5 * np.abs(half).max())


@pytest.mark.internal
def test_derivatives_beyond_half_the_digits_are_the_most_these_hold():
    """Oil that hardly resists, in a trial: no infinity, which the next product would make not a number."""
    half = to_single_precision(np.array([1.0, -2e38, 1e39, -1e300]))
    most = np.finfo(np.float32).max
    np.testing.assert_array_equal(half, np.array([1.0, -2e38, most, -most], np.float32))


def test_a_film_takes_950_bytes_a_cell_at_most():
    """The dense matrix of the coarsest grid, seven of it in all digits, and both bases of GMRES took 4,790."""
    rolling((1.0, 0.0), 128)  # what is loaded once is no part of it
    tracemalloc.start()
    rolling((1.0, 0.0), 128)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert most < 950 * 128**2


@pytest.mark.internal
def test_equations_are_solved_as_well_as_their_step_is_good(monkeypatch):
    """Two thirds of the cycles of equations that are all solved to a thousandth, and the same film."""
    film = rolling((1.0, 0.0), 64)
    monkeypatch.setattr(newton, "LARGEST_FORCING", 1e-3)
    strict = rolling((1.0, 0.0), 64)
    assert film.cycles < 0.75 * strict.cycles
    np.testing.assert_allclose(film.thickness, strict.thickness, rtol=1e-8)
