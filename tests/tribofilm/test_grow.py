"""Films in a contact: reuse changes nothing that matters, maps add up, limits are where the model says."""

import numpy as np
import pytest
from tip import LAW, tip_contact

from bem import Body, Grid, InfeasibleError, InputError, Material, flash_temperature, grow_tribofilm
from bem.tribofilm import Constant, FadingSubstrate, StressActivatedGrowth, solve_film_contact
from bem.tribofilm.mean_film import survival

DLC = Material("dlc", youngs_modulus=200e9, poissons_ratio=0.25)
GRID = Grid((32, 32), (1.2e-9, 1.2e-9))
GIVEN = {"counterface": DLC, "hardness": FadingSubstrate(6e9, 2e9, 4e-9), "modulus": Constant(15e9)}


def contact(**change):
    return tip_contact(**{"grid": GRID, **GIVEN, **change})


TIMES = np.linspace(0, 2000, 41)


def test_reused_contacts_give_the_film_of_contacts_solved_at_every_step():
    fresh, reused = [], []
    grid = Grid((16, 16), (2.4e-9, 2.4e-9))
    small = contact(grid=grid, gap=(grid.x[:, None] ** 2 + grid.y[None, :] ** 2) / 2 / 53e-9)
    times = np.linspace(0, 1000, 5)
    direct = grow_tribofilm(
        times, small, wear_coefficient=3e-3, reuse_tolerance=0, tolerance=1e-3, callback=fresh.append
    )
    table = grow_tribofilm(times, small, wear_coefficient=3e-3, tolerance=1e-3, callback=reused.append)
    # growth is reproduced to 2e-3; thickness follows, plus the tolerance of the integration
    assert np.allclose(table.history.thickness[1:], direct.history.thickness[1:], rtol=4e-3)
    assert len(reused) == len(table.contacts)
    assert len(fresh) == direct.contacts_solved
    assert direct.film_pressure.sum() == pytest.approx(table.film_pressure.sum(), rel=1e-5)  # the same load
    assert len(reused) < len(fresh) / 2


def test_film_map_and_mean_thickness_are_the_same_film():
    """Where the mean is taken over the grid, the local film has that mean; with a delay too."""
    for lag in (0.0, 150.0):
        film = grow_tribofilm(TIMES, contact(), wear_coefficient=3e-3, lag=lag)
        # both integrate the same growth; the map interpolates maps linearly, the mean its logarithm
        assert film.film_map.mean() == pytest.approx(film.history.thickness[-1], rel=5e-3)
        assert (film.film_map >= 0).all()
        assert film.film_map.max() > 2 * film.film_map.mean()


def test_what_grew_and_wore_is_what_is_there():
    film = grow_tribofilm(TIMES, contact(), wear_coefficient=3e-3, initial_thickness=1e-9)
    history = film.history
    assert np.allclose(1e-9 + history.grown - history.worn, history.thickness, rtol=1e-14, atol=1e-24)
    # independent quadrature of what wore: Simpson over a fine history
    fine = grow_tribofilm(np.linspace(0, 2000, 2001), contact(), wear_coefficient=3e-3, initial_thickness=1e-9).history
    from scipy.integrate import simpson

    assert fine.worn[-1] == pytest.approx(3e-3 * simpson(fine.thickness, x=fine.time), rel=1e-5)


def test_self_limitation_comes_from_stress_and_wear_and_is_lost_without_either():
    limited = grow_tribofilm(TIMES, contact(), wear_coefficient=3e-3)
    history = limited.history
    assert history.growth_rate[-1] < 0.7 * history.growth_rate[0]  # the softer film lowers the stress, and growth
    assert history.growth_rate[-1] == pytest.approx(history.wear_rate[-1], rel=0.02, abs=0)  # and wear balances it
    assert limited.steady == pytest.approx(history.thickness[-1], rel=0.01)
    unworn = grow_tribofilm(TIMES, contact(), wear_coefficient=0.0)
    assert np.isinf(unworn.steady)  # no balance: it grows on
    middle = len(TIMES) // 2
    assert unworn.history.thickness[-1] > 1.25 * unworn.history.thickness[middle]
    assert history.thickness[-1] < 1.01 * history.thickness[middle]
    thermal = StressActivatedGrowth.from_electron_volts(1e-2, 0.6, 0.0)
    plain = grow_tribofilm(TIMES, contact(growth=thermal, hardness=Constant(6e9)), wear_coefficient=0.0)
    rates = plain.history.growth_rate
    # without stress activation growth only follows the contact area, which a compliant film makes larger
    assert rates[-1] >= rates[0]


def test_a_growing_soft_film_lowers_the_mean_pressure():
    pressures = [solve_film_contact(contact(), h).mean_pressure for h in (0.0, 2e-9, 10e-9)]
    assert pressures[0] > pressures[1] > pressures[2]
    assert max(pressures) <= 6e9


def test_hot_films_do_not_blow_up():
    """300 degrees: growth starts so fast that an explicit step would overshoot by orders of magnitude."""
    film = grow_tribofilm(TIMES, contact(temperature=573.15), wear_coefficient=3e-3)
    assert np.isfinite(film.history.thickness).all()
    assert (np.diff(film.history.thickness) >= -1e-6 * film.history.thickness.max()).all()


def test_a_load_beyond_the_hardness_is_refused():
    with pytest.raises(InfeasibleError):
        grow_tribofilm(TIMES, contact(load=1e-3), wear_coefficient=3e-3)
    with pytest.raises(InputError, match="average"):
        contact(average="guess")
    with pytest.raises(InputError, match="reuse_tolerance"):
        grow_tribofilm(TIMES, contact(), wear_coefficient=3e-3, reuse_tolerance=-1)


STEEL = Material(
    "steel", youngs_modulus=210e9, poissons_ratio=0.3, thermal_conductivity=46.0, density=7800.0, heat_capacity=470.0
)


def test_no_film_carries_more_than_a_counterface_that_yields():
    """A polymer with a yield stress alone: 2.8 times that, as in any capped contact."""
    polymer = Material("polymer", youngs_modulus=4e9, poissons_ratio=0.4, yield_stress=100e6)
    film = contact(counterface=polymer, load=2e-7)
    assert film.hardness_at(0.0) == 280e6
    # rounding of 2.8 times the yield stress
    assert solve_film_contact(film, 2e-9).pressure.max() == pytest.approx(280e6, rel=1e-12)


def test_spots_grow_as_warm_as_rubbing_makes_them():
    """Growth of each cell is the law's at the temperature that its heat conducts to, and no rubbing is no heat."""
    ball = {"gap": (GRID.x[:, None] ** 2 + GRID.y[None, :] ** 2) / 2 / 53e-9, "substrate": STEEL, "counterface": STEEL}
    still, fast = (solve_film_contact(contact(**ball, speeds=speeds), 2e-9) for speeds in ((1.0, 1.0), (50.0, 0.0)))
    cold = solve_film_contact(contact(**ball), 2e-9)
    assert np.array_equal(still.growth_map, cold.growth_map)
    assert still.temperature == cold.temperature == 373.15
    spots = flash_temperature(
        fast.pressure, GRID, (Body(STEEL), Body(STEEL)), friction=0.1, speeds=(50.0, 0.0), bulk=(373.15, 373.15)
    ).temperature
    touching = fast.pressure > 0
    assert fast.temperature == pytest.approx(spots[touching].max(), rel=1e-12)
    assert fast.temperature > 373.15 + 1
    one = LAW.rate(0.1 * fast.pressure[16, 16], float(spots[16, 16]))
    assert fast.growth_map[16, 16] == pytest.approx(float(one), rel=1e-12, abs=0)
    assert fast.growth > 1.05 * cold.growth
    with pytest.raises(InputError, match="needs thermal_conductivity"):
        solve_film_contact(contact(speeds=(1.0, 0.0)), 2e-9)


@pytest.mark.parametrize("loss", [0.01, 0.3, np.exp(-1), 1.0], ids=["slow", "monotone", "critical", "oscillating"])
def test_film_left_after_many_lags_is_that_of_step_by_step_integration(loss):
    """Simpson's rule over one lag after the other, from the values of the lag before."""
    from scipy.integrate import cumulative_simpson

    lag, steps, count = 10.0, 400, 120
    lags = [np.ones(steps + 1)]
    for _ in range(count - 1):
        worn = cumulative_simpson(lags[-1], dx=1 / steps, initial=0.0)
        lags.append(lags[-1][-1] - loss * worn)
    left = np.concatenate([each[:-1] for each in lags])
    times = np.arange(left.size) * lag / steps
    # the reference rounds and integrates to 1e-12 per lag, relative to the film of that lag
    scale = np.repeat([np.abs(each).max() for each in lags], steps)
    assert (np.abs(survival(times, loss / lag, lag) - left) <= 1e-8 * scale).all()
    assert left[-1] != 0


def test_film_left_of_unstable_wear_is_finite():
    left = survival(np.arange(0.0, 3000.0), 10.0, 1.0)
    assert np.isfinite(left).all()
    assert left[-1] == 0


def test_film_map_has_the_mean_thickness_after_many_lags():
    film = grow_tribofilm(TIMES, contact(), wear_coefficient=3e-4, lag=20.0, initial_thickness=5e-9)
    assert film.film_map.mean() == pytest.approx(film.history.thickness[-1], rel=5e-3)
