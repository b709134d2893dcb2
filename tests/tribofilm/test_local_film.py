"""Local feedback: order in time, limits of the mean model, conservation, never negative."""

import numpy as np
import pytest
from tip import IRON, tip_contact

from bem import Grid, InputError
from bem.tribofilm import Constant, StressActivatedGrowth, grow_local_film, grow_tribofilm

GRID = Grid((24, 24), (1.6e-9, 1.6e-9))
GIVEN = {"counterface": IRON, "hardness": Constant(4e9), "modulus": Constant(210e9)}


def contact(**change):
    return tip_contact(**{"grid": GRID, **GIVEN, **change})


def test_without_feedback_from_the_surface_it_is_the_mean_model():
    """Growth that does not feel stress, on a contact that covers everything: both are g / alpha (1 - e^-alpha t)."""
    flat = Grid((8, 8), (1e-9, 1e-9), periodic=(True, True))
    thermal = StressActivatedGrowth.from_electron_volts(1e-2, 0.7, 0.0)
    case = contact(grid=flat, gap=np.zeros(flat.shape), growth=thermal, load=6.4e-8)
    times = np.linspace(0, 2000, 6)
    given = {"wear_coefficient": 1e-3, "concentration_constant": 1e8}
    local = grow_local_film(times, case, tolerance=1e-4, **given)
    mean = grow_tribofilm(times, case, **given).history
    # growth is constant, so the exponential rule is exact; the mean model integrates to 1e-6
    assert np.allclose(local.thickness, mean.thickness, rtol=1e-5, atol=0)
    # the film of a step wears with the mean of what it holds of the substrate at both ends
    assert np.allclose(local.substrate_wear, mean.substrate_wear, rtol=1e-2, atol=0)
    assert local.substrate_wear[-1] < 0.9 * local.worn[-1]


def test_second_order_in_time():
    times = np.array([0.0, 400.0])
    best = grow_local_film(times, contact(), wear_coefficient=2e-3, tolerance=1e-4)
    errors, steps = [], []
    for tolerance in (1e-1, 1e-2, 1e-3):
        film = grow_local_film(times, contact(), wear_coefficient=2e-3, tolerance=tolerance)
        errors.append(abs(film.thickness[-1] / best.thickness[-1] - 1))
        steps.append(film.contacts_solved)
    assert steps[0] < steps[1] < steps[2] < best.contacts_solved
    assert errors[2] < 2e-3
    assert errors[2] < errors[0]


def test_it_grows_under_the_tip_and_nothing_is_lost():
    times = np.linspace(0, 800, 9)
    film = grow_local_film(times, contact(), wear_coefficient=1e-3, concentration_constant=1.24e7)
    assert np.allclose(film.grown - film.worn, film.thickness, rtol=1e-12, atol=1e-22)
    assert (film.film_map >= 0).all()
    assert (np.diff(film.substrate_wear) >= 0).all()
    assert film.substrate_wear[-1] <= film.worn[-1]
    # it grows under the tip, and what does not touch stays bare
    assert film.film_map[GRID.shape[0] // 2, GRID.shape[1] // 2] > 0.5 * film.film_map.max()
    assert film.film_map[0, 0] == 0


def test_wrong_arguments_are_named():
    with pytest.raises(InputError, match="times"):
        grow_local_film(np.array([1.0]), contact(), wear_coefficient=1.0)
    with pytest.raises(InputError, match="wear_coefficient"):
        grow_local_film(np.array([0.0, 1.0]), contact(), wear_coefficient=-1.0)
    with pytest.raises(InputError, match="tolerance"):
        grow_local_film(np.array([0.0, 1.0]), contact(), wear_coefficient=1.0, tolerance=0.0)
    with pytest.raises(InputError, match="concentration_constant"):
        grow_local_film(np.array([0.0, 1.0]), contact(), wear_coefficient=1.0, concentration_constant=-1.0)
