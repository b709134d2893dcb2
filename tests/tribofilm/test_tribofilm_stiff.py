"""Films that wear so fast, or after such a lag, that the integration of their thickness is in danger."""

import math
import warnings

import numpy as np
import pytest

from bem.errors import ConvergenceError, InfeasibleError, InputError
from bem.runs import plan_scene
from bem.tribofilm import Constant, FadingSubstrate, Table, evolution
from bem.tribofilm.evolution import evolve_film

TIMES = np.linspace(0.0, 20_000.0, 241)


@pytest.mark.parametrize("growth", [1e-22, 1e-13, 1e-9, 1e-2])
@pytest.mark.parametrize("wear", [3.0, 3e5, 3e9])
def test_fast_wear_takes_few_steps_and_no_warnings(growth, wear):
    """h = g / alpha, and all that grows is worn: exact. It took minutes, and scipy's warnings, for films thinner than
    rounding: cut off at zero, their wear had no slope."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        film = evolve_film(TIMES, lambda h: growth, wear_coefficient=wear)
    # growing lasts 1 / alpha at first, then nothing happens: 1e3 evaluations; it was 1e6 and more
    assert film.evaluations < 3000
    # relative to what has grown, or to a hair's breadth of an atom: the tolerance of the integration, a few steps long
    allowed = 1e-5 * growth * TIMES[-1] + 1e-14
    assert film.grown[-1] == pytest.approx(growth * TIMES[-1], rel=1e-5, abs=0)
    assert abs(film.thickness[-1] - growth / wear) <= allowed
    assert abs(film.worn[-1] - growth * (TIMES[-1] - 1 / wear)) <= allowed


@pytest.mark.internal
def test_a_film_that_comes_and_goes_without_end_is_given_up_in_words(monkeypatch):
    monkeypatch.setattr(evolution, "_MOST_EVALUATIONS", 3000)  # more than films with an end take
    with pytest.raises(ConvergenceError, match=r"evaluations|broke off"):  # and warnings are errors in all tests
        evolve_film(TIMES, lambda h: 0.01, wear_coefficient=3.0, lag=10.0)


def test_a_lag_that_fits_too_often_is_refused():
    with pytest.raises(InputError, match="lag"):
        evolve_film(TIMES, lambda h: 1e-12, wear_coefficient=1e-4, lag=1.0)


@pytest.mark.parametrize(
    "curve",
    [
        Constant(2e9),
        FadingSubstrate(6e9, 2e9, 30e-9, 0.001),
        FadingSubstrate(1e9, 2e9, 30e-9),
        Table((0.0, 10e-9, 40e-9), (5e9, 1e9, 3e9), (300.0, 400.0), (1.0, 0.5)),
    ],
)
@pytest.mark.parametrize("temperature", [298.15, 380.0])
def test_softest_and_hardest_are_those_of_a_fine_search(curve, temperature):
    # nodes of the tables lie on the search
    thickness = np.linspace(0.0, 50e-9, 501)
    values = [curve(h, temperature) for h in thickness]
    for last in (0, 30, 100, 500):
        assert curve.lowest(thickness[last], temperature) == pytest.approx(min(values[: last + 1]), rel=1e-12)
    beyond = [curve(h, temperature) for h in (*thickness, 1e-3, math.inf)]
    assert curve.highest(temperature) == pytest.approx(max(beyond), rel=1e-12)


def film_scene(load, hardness, **film):
    return {
        "kind": "tribofilm",
        "grid": {"shape": 32, "lengths": "40 nm"},
        "lower": {"material": "steel-cylinder"},
        "upper": {"material": "dlc"},
        "shape": {"kind": "sphere", "radius": "50 nm"},
        "rubbing": {"loads": ["0.1 uN", load], "temperatures": ["100 degC"], "duration": "20000 s"},
        "film": {
            "activation_energy": "0.8 eV",
            "activation_volume": "20 angstrom^3",
            "wear_coefficient": "0 1/s",
            "hardness": hardness,
            "youngs_modulus": {"kind": "constant", "value": "100 GPa"},
        }
        | film,
    }


SOFTENING = {"kind": "fading_substrate", "substrate": "8 GPa", "film": "0.5 GPa", "length": "1 nm"}


def test_a_load_beyond_the_softest_film_is_refused_by_the_plan():
    """1.6e-15 m2 carry 12.8 uN at 8 GPa, but only 0.8 uN once the film is thick: it was found out hours later."""
    plan_scene(film_scene("0.7 uN", SOFTENING))
    with pytest.raises(InfeasibleError, match=r"rubbing\.loads: 1 uN is beyond the softest film"):
        plan_scene(film_scene("1 uN", SOFTENING))


def test_a_counter_body_with_a_yield_stress_alone_limits_the_load():
    """2.8 x 100 MPa on 1.6e-15 m2 are 0.45 uN; it had counted as infinitely hard."""
    polymer = {"name": "polymer", "youngs_modulus": "4 GPa", "poissons_ratio": 0.4, "yield_stress": "100 MPa"}
    plan_scene(film_scene("0.4 uN", SOFTENING) | {"upper": {"material": polymer}})
    with pytest.raises(InfeasibleError, match=r"rubbing\.loads: 500 nN is beyond .* 448 nN"):
        plan_scene(film_scene("0.5 uN", SOFTENING) | {"upper": {"material": polymer}})


def test_a_film_that_stays_thin_is_not_refused_for_what_it_never_becomes():
    plan_scene(film_scene("1 uN", SOFTENING, wear_coefficient="1e6 1/s"))
