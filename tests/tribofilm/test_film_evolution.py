"""Film balance against closed forms: exponential approach, the method of steps, Arrhenius; conservation; order."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.constants import Boltzmann, electron_volt

from bem import InputError
from bem.tribofilm.evolution import evolve_film, steady_thickness
from bem.tribofilm.growth import StressActivatedGrowth
from bem.tribofilm.properties import Constant, FadingSubstrate, Table


def test_constant_growth_approaches_its_plateau_exponentially():
    alpha, growth = 6.9e-4, 4.07e-11
    times = np.linspace(0, 7200, 61)
    film = evolve_film(times, lambda h: growth, wear_coefficient=alpha, tolerance=1e-9)
    exact = growth / alpha * -np.expm1(-alpha * times)
    # global error of a fifth-order method with a local tolerance of 1e-9
    assert np.allclose(film.thickness, exact, rtol=1e-8, atol=1e-18)
    assert steady_thickness(lambda h: growth, alpha) == pytest.approx(growth / alpha, rel=1e-12)


def test_thesis_wear_depths_follow_from_steady_films_of_59_and_214_nm():
    """THESIS.md section 6: alpha h exp(-C1 h) over 75 minutes gives 86.3 and 45.8 nm."""
    for thickness, depth in ((59e-9, 86.3e-9), (214e-9, 45.8e-9)):
        film = evolve_film(
            np.array([45.0, 120.0]) * 60,
            lambda h, t=thickness: 6.9e-4 * t,
            wear_coefficient=6.9e-4,
            concentration_constant=1.24e7,
            initial_thickness=thickness,
        )
        # "about" 59 and 214 nm: two nanometres of either change the depth by 2 %
        assert film.substrate_wear[-1] == pytest.approx(depth, rel=0.025)


def test_delayed_wear_is_the_method_of_steps():
    """h' = g - a h(t - lag), h = 0 before: h = g sum_k (-a)^k (t - k lag)_+^(k+1) / (k+1)!."""
    growth, alpha, lag = 1.0e-12, 3e-4, 3000.0
    times = np.linspace(0, 4e4, 81)
    film = evolve_film(times, lambda h: growth, wear_coefficient=alpha, lag=lag, tolerance=1e-9)
    exact = np.zeros_like(times)
    for k in range(15):
        exact += growth * (-alpha) ** k * np.maximum(times - k * lag, 0) ** (k + 1) / math.factorial(k + 1)
    assert np.allclose(film.thickness, exact, rtol=1e-7, atol=1e-18)
    plateau = growth / alpha
    assert film.thickness.max() > 1.05 * plateau  # overshoot: alpha lag = 0.9 > 1/e
    undelayed = evolve_film(times, lambda h: growth, wear_coefficient=alpha)
    assert undelayed.thickness.max() <= plateau * (1 + 1e-6)
    assert film.thickness[-1] == pytest.approx(plateau, rel=0.02)


def test_error_follows_the_tolerance():
    def growth(h):
        return 1e-9 * math.exp(-h / 3e-8)

    times = np.array([0.0, 500.0, 2000.0])
    best = evolve_film(times, growth, wear_coefficient=1e-3, tolerance=1e-11).thickness
    errors = [
        np.abs(evolve_film(times, growth, wear_coefficient=1e-3, tolerance=t).thickness[1:] / best[1:] - 1).max()
        for t in (1e-3, 1e-5, 1e-7)
    ]
    # the stated tolerance is local; ten times it is what a handful of steps may add up to
    assert all(e < 10 * t for e, t in zip(errors, (1e-3, 1e-5, 1e-7), strict=True))
    assert errors[2] < 0.01 * errors[0]


@settings(deadline=None, max_examples=20)
@given(
    peak=st.floats(1e-16, 1e-5),
    decay=st.floats(1e-9, 1e-6),
    alpha=st.floats(0, 1e-1),
    lag=st.sampled_from([0.0, 1500.0]),
    initial=st.sampled_from([0.0, 1e-8]),
)
def test_film_is_never_negative_and_nothing_is_lost(peak, decay, alpha, lag, initial):
    film = evolve_film(
        np.linspace(0, 7200, 25),
        lambda h: peak * math.exp(-h / decay),
        wear_coefficient=alpha,
        lag=lag,
        initial_thickness=initial,
        concentration_constant=1.24e7,
    )
    assert np.isfinite(film.thickness).all()
    assert (film.thickness >= 0).all()
    balance = initial + film.grown - film.worn - film.thickness
    # round-off of the sums, and the integrator's own tolerance where a film has vanished
    assert np.abs(balance).max() <= 2e-6 * max(film.grown.max(), initial) + 1e-16
    assert (np.diff(film.grown) >= -1e-6 * film.grown.max()).all()
    assert (film.substrate_wear <= film.worn * (1 + 1e-5) + 1e-16).all()


def test_growth_is_arrhenius_with_a_barrier_lowered_by_stress():
    law = StressActivatedGrowth.from_electron_volts(1e-2, 0.8, 85)
    hot, cold = law.rate(np.array(0.2e9), 373.15), law.rate(np.array(0.2e9), 333.15)
    barrier = 0.8 * electron_volt - 0.2e9 * 85e-30
    expected = -barrier / Boltzmann * (1 / 373.15 - 1 / 333.15)
    assert math.log(hot / cold) == pytest.approx(expected, rel=1e-12)
    assert law.rate(np.array(1e12), 300.0) == 1e-2  # no barrier below zero
    with pytest.raises(InputError, match=r"add 273\.15"):
        law.rate(np.array(0.0), -20.0)


def test_properties_end_where_they_should():
    curve = FadingSubstrate(6e9, 2e9, 30e-9, temperature_slope=2e-3)
    assert curve(0.0, 373.15) == 6e9
    assert curve(1e-6, 298.15) == pytest.approx(2e9)
    assert curve(1e-6, 373.15) == pytest.approx(2e9 * (1 - 0.15))
    # one factor on the whole curve, as the source: 1 - 2e-3 * 75 K = 0.85 of what it is at the reference temperature
    whole = FadingSubstrate(6e9, 2e9, 30e-9, temperature_slope=2e-3, substrate_temperature_slope=2e-3)
    for thickness in (0.0, 10e-9, 1e-6):
        assert whole(thickness, 373.15) == pytest.approx(0.85 * whole(thickness, 298.15), rel=1e-12)
        assert whole(thickness, 298.15) == curve(thickness, 298.15)
    assert curve(10e-9, 373.15) > 1.02 * whole(
        10e-9, 373.15
    )  # the default leaves the substrate's part as hard as it is
    assert whole(0.0, 2000.0) == pytest.approx(0.1 * 6e9)
    assert whole.highest(373.15) == pytest.approx(0.85 * 6e9)
    assert whole.lowest(10e-9, 373.15) == whole(10e-9, 373.15)
    assert Constant(3.0)(1.0, 1.0) == 3.0
    table = Table.from_lists([0, 1e-7], [6e9, 3e9], [300, 400], [1.0, 0.5])
    assert table(5e-8, 350) == pytest.approx(4.5e9 * 0.75)
    with pytest.raises(InputError, match="increase"):
        Table.from_lists([0, 0], [1, 1])


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"times": np.array([1.0, 0.0])}, "times"),
        ({"wear_coefficient": -1.0}, "wear_coefficient"),
        ({"lag": math.nan}, "lag"),
        ({"concentration_constant": 0.0}, "concentration"),
        ({"tolerance": 2.0}, "tolerance"),
    ],
)
def test_wrong_arguments_are_named(change, word):
    arguments = {"times": np.array([0.0, 1.0]), "wear_coefficient": 1.0} | change
    with pytest.raises(InputError, match=word):
        evolve_film(arguments.pop("times"), lambda h: 1e-9, **arguments)
