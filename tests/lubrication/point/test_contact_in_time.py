"""Films in time with contact: they end in the steady film, agree with films that never touch, and carry the load."""

import numpy as np
import pytest

from bem import InputError, Lubricant, MovingSurface, Waves, march_point_film, solve_rough_point_film
from bem.notes import has_code
from bem.notes.lubrication import FILM_CELLS_FEW

MODULUS = 1.15e11
OIL = Lubricant(0.03, pressure_viscosity=18e-9, density_law="incompressible")
HALF = (0.75 * 20 * 0.01 / MODULUS) ** (1 / 3)
EXTENT = tuple(edge * HALF for edge in (-2.5, 1.7, -1.8, 1.8))
SHAPE = (48, 40)
LEAST = 1e-9
CASE = {"radii": (0.01, 0.01), "contact_modulus": MODULUS, "lubricant": OIL, "extent": EXTENT, "shape": SHAPE}


def bumps(rms):
    wave = 2 * np.pi / (0.74 * HALF)
    return lambda x, y: 2 * rms * np.cos(wave * x) * np.cos(wave * y)


def march(times, speeds, **more):
    return march_point_film(np.asarray(times), load=lambda t: 20.0, speeds=lambda t: speeds, **CASE | more)


def on_grid(surface):
    centres = [a + (b - a) / n * (np.arange(n) + 0.5) for a, b, n in zip(EXTENT[::2], EXTENT[1::2], SHAPE, strict=True)]
    return surface(centres[0][:, None], centres[1][None, :])


def test_a_march_that_waits_ends_in_the_steady_film_with_contact():
    """A rough body at rest, its heights raised in one step, ten thousand times as long as the passage of the oil."""
    speed, surface = 2e-3, bumps(20e-9)
    steady = solve_rough_point_film(
        load=20.0, speeds=(0.0, speed), heights=surface, cavitation="swift_stieber", errors=False, **CASE
    )
    step, heights = 1e4 * (EXTENT[1] - EXTENT[0]) / speed, on_grid(surface)
    last = march(
        np.arange(3) * step,
        (0.0, speed),
        roughness=lambda t: min(t / step, 1.0) * heights,
        least_film=LEAST,
    )[-1]
    assert last.status.value == steady.status.value == "converged"
    assert steady.contact_share > 0.02
    assert last.contact_load == pytest.approx(steady.contact_load, rel=1e-4)
    np.testing.assert_array_equal(last.touching, steady.touching)
    np.testing.assert_allclose(last.oil_pressure, steady.oil_pressure, atol=1e-5 * steady.oil_pressure.max())
    np.testing.assert_allclose(last.thickness, steady.thickness, rtol=1e-4)


def test_without_contact_it_is_the_march_of_surfaces_that_never_touch():
    waves = MovingSurface(Waves(5e-9, 0.6 * HALF, begin=-1.5 * HALF))
    times = np.linspace(0, 1.5 * HALF / 0.2, 4)
    free, bounded = (march(times, (0.2, 0.2), roughness=waves, least_film=least) for least in (None, LEAST))
    for one, other in zip(free, bounded, strict=True):
        assert one.status.value == other.status.value == "converged"
        assert one.contact_load is None
        assert other.contact_load in (None, 0.0)
        assert not other.touching.any()
        np.testing.assert_allclose(other.thickness, one.thickness, rtol=1e-5)
        np.testing.assert_allclose(other.pressure, one.pressure, atol=1e-5 * one.pressure.max())


def test_ridges_that_move_through_the_contact_touch_and_share_the_load():
    """Where surfaces touch the film is the least one; elsewhere the oil carries all pressure; the load is balanced."""
    speed = 4e-3
    ridges = MovingSurface(Waves(200e-9, 0.74 * HALF, begin=-1.6 * HALF))
    times, states = np.linspace(0, 1.3 * HALF / speed, 11), []
    films = march(times, (speed, speed), roughness=ridges, least_film=LEAST, callback=states.append)
    assert all(film.status.value == "converged" for film in films)
    assert max(film.contact_load for film in films[1:]) > 0.01 * 20
    last = films[-1]
    assert last.load == pytest.approx(20.0, rel=1e-6)
    cell = (last.x[1] - last.x[0]) * (last.y[1] - last.y[0])
    assert last.contact_load == pytest.approx((last.pressure - last.oil_pressure).sum() * cell, rel=1e-9)
    assert last.touching.any()
    np.testing.assert_allclose(last.thickness[last.touching], LEAST, rtol=1e-4)
    assert last.minimum_thickness == pytest.approx(LEAST, rel=1e-4)
    assert last.thickness.min() > 0.999 * LEAST
    assert (last.oil_pressure[~last.touching] == last.pressure[~last.touching]).all()
    assert (last.sliding_stress()[:, last.touching] == 0).all()
    assert not has_code(last.notes, FILM_CELLS_FEW, reason="constriction")  # the minimum is the least film
    assert max(film.mass_imbalance for film in films[1:]) < 1e-6
    resumed = march(times, (speed, speed), roughness=ridges, least_film=LEAST, state=states[8])
    np.testing.assert_array_equal(resumed[-1].oil_pressure, last.oil_pressure)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"least_film": 0.0}, "least_film: 0.0 must be positive"),
        ({"contact_modulus": np.inf}, "least_film: .* elastic"),
    ],
)
def test_mistakes_are_said(changes, words):
    with pytest.raises(InputError, match=words):
        march([0.0, 1e-3], (0.2, 0.2), **{"least_film": LEAST} | changes)
