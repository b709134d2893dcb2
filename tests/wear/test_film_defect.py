"""A boundary film that protects: closed forms of its defect, limits, loops and lives that wear by it."""

from dataclasses import replace

import numpy as np
import pytest

from bem import Body, Grid, InputError, Material, plan_scene
from bem.life.march import initial_state, run_life
from bem.life.positions import Passing
from bem.life.surfaces import LifeCase, solve_round
from bem.wear import DryContact, WearModel, run_in
from bem.wear.film_defect import FilmDefect

EV = 1.602176634e-19
FILM = FilmDefect(0.7 * EV, 0.5, 363.15)
STEEL = Body(Material("steel", youngs_modulus=210e9, poissons_ratio=0.3, hardness=6e9))
GRID = Grid((16, 16), (1e-6, 1e-6), periodic=(True, True))
PRESSURE, RATE, DISTANCE = 2e8, 1e-15, 1e-3


@pytest.mark.internal
def test_it_is_kingsbury_s_and_rises_from_nothing_to_all():
    # x / U over t0 exp(E / kT), where that is small: 5e-10 / 0.5 / (3e-12 exp(22.369)) by hand
    assert float(FILM.share()) == pytest.approx(1e-9 / (3e-12 * np.exp(0.7 / (8.617333262e-5 * 363.15))), rel=1e-6)
    shares = FILM.share(np.array([200.0, 400.0, 800.0, 1e5]))
    assert (np.diff(shares) > 0).all()
    assert shares[0] < 1e-12
    assert shares[-1] == pytest.approx(1, abs=1e-12)
    assert float(FILM.share(np.array(400.0))) == pytest.approx(
        2 * float(replace(FILM, sliding_speed=1.0).share(np.array(400.0))), rel=1e-3
    )
    assert float(replace(FILM, sliding_speed=0.0).share()) == 0


@pytest.mark.internal
@pytest.mark.parametrize("name", ["adsorption_energy", "temperature", "molecule_length", "vibration_time"])
def test_what_is_no_film_is_refused(name):
    with pytest.raises(InputError, match=f"{name} 0.0 must be positive"):
        replace(FILM, **{name: 0.0})


def loop(**model):
    flat = np.zeros(GRID.shape)
    law = {"kind": "archard", "specific_wear_rate": RATE, "distance": DISTANCE}
    return run_in(
        *(flat, flat),
        grid=GRID,
        bodies=(STEEL, STEEL),
        load=PRESSURE * GRID.area,
        depths=np.array([0.0, 1e-7]),
        cycles=2,
        model=WearModel(**{"criterion": law, "wears": "both"} | model),
    )


@pytest.mark.internal
def test_a_loop_wears_that_share_of_its_volume():
    volume = loop(film_defect=FILM).cycles["volume"]
    assert (volume > 0).all()
    assert volume / loop().cycles["volume"] == pytest.approx(float(FILM.share()), rel=1e-9, abs=0)


@pytest.mark.internal
def test_only_wear_by_pressure_and_distance_is_protected():
    with pytest.raises(InputError, match="film_defect of criterion von_mises"):
        WearModel(film_defect=FILM)
    with pytest.raises(InputError, match="film_defect has one sliding speed"):
        loop(film_defect=FILM, traction={"kind": "oscillating_force", "share": 0.5})


def hot(temperature):
    """Dry passes whose surfaces are as warm as given (nx, ny) [K]."""
    dry = DryContact(GRID, (STEEL, STEEL), np.zeros(GRID.shape), PRESSURE * GRID.area, hardness=6e9)
    return lambda *given: replace(dry(*given), temperature=temperature)


def life(temperature, cycles):
    return LifeCase(
        GRID, hot(temperature), Passing(1, (False, False)), (RATE, 0.0), DISTANCE, cycles, 0.02, defect=FILM
    )


@pytest.mark.internal
def test_a_life_wears_each_place_by_its_own_temperature():
    flat, warm = np.zeros(GRID.shape), np.full(GRID.shape, 400.0)
    wavy = 1e-9 * np.cos(2 * np.pi * np.arange(16) / 16)[:, None] * np.ones(GRID.shape)
    end = run_life(life(warm, 50.0), wavy, flat)
    share = float(FILM.share(np.array(400.0)))
    assert end.surfaces.volume[0] == pytest.approx(share * RATE * DISTANCE * 50 * PRESSURE * GRID.area, rel=1e-9, abs=0)
    # one half hotter, few cycles: the depths are as the shares, for the pressure has not answered yet
    warm = np.where(np.arange(16)[:, None] < 8, 400.0, 440.0) * np.ones(GRID.shape)
    after = solve_round(life(warm, 1.0), initial_state(life(warm, 1.0), wavy, flat).surfaces, 1.0).surfaces
    depth = wavy - after.heights[0]
    expected = FILM.share(np.array([440.0]))[0] / FILM.share(np.array([400.0]))[0]
    assert depth[12, 3] / depth[4, 3] == pytest.approx(expected, rel=1e-6)
    # in the long run what wears fastest carries less, until all wears as fast: shares sixfold apart leave rates within
    # an eighth of each other, which is at the edge where the temperature jumps
    end = run_life(replace(life(warm, 1e8), first_step=1e6, tolerance=0.1), wavy, flat)
    rate = FILM.share(warm) * end.contacts[0].pressure
    assert np.ptp(rate) < 0.15 * rate.mean()


def test_a_dry_boundary_film_without_speed_or_temperature_is_refused_by_the_plan():
    settings = ['wear.film_defect={adsorption_energy="0.6 eV"}']
    with pytest.raises(InputError) as refused:
        plan_scene("wear-cylinder-scar", settings=settings)
    assert [text.split(":")[0] for text in refused.value.messages] == [
        "wear.film_defect.sliding_speed",
        "wear.film_defect.temperature",
    ]
