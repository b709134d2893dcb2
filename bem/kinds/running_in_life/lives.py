"""Life of a scene: its case with contact and film, its monitors, and coarser lives for error bars.

Verified in tests/scenes/test_running_in_life_kind.py.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from bem.errors import ConvergenceError, Status
from bem.grid import FloatArray
from bem.scenes import build, wearing
from bem.scenes.axes import with_keys
from bem.scenes.tables.film_defect import film_defect

if TYPE_CHECKING:
    from bem.accuracy import ErrorBars
    from bem.friction.setup import MixedSetup
    from bem.kinds.running_in_life.tables import LifeFilm
    from bem.life.march import LifeState
    from bem.life.monitors import Monitors
    from bem.life.surfaces import GrowingTribofilm, LifeCase

_JUMPS_OF_FATIGUE = 16  # at least: the stresses of a jump are those of its ends


def monitors_of(scene: Any, setup: MixedSetup, case: LifeCase) -> Monitors:
    """Return the monitors of pieces and fatigue that a scene asks for."""
    from bem.life.monitors import Monitors

    sizes, fatigue = None, None
    if scene.particles is not None:
        sizes = scene.particles.build(setup.grid, scene.bodies, setup.hardness, on_grid(scene))
    if scene.fatigue is not None:
        fatigue = scene.fatigue.build(scene.bodies, setup.hardness)
    return Monitors(case, sizes, fatigue)


def on_grid(scene: Any) -> float:
    """Load on the patch [N]."""
    grid = build.grid_of(scene.grid)
    return scene.contact.on_patch(scene.load, grid.lengths)


def longest_jump(scene: Any) -> float:
    """Return the longest jump allowed [cycles]."""
    return math.inf if scene.fatigue is None else float(scene.life.count / _JUMPS_OF_FATIGUE)


def case_of(scene: Any, setup: MixedSetup) -> LifeCase:
    """Return the parts of the life that stay the same."""
    from bem.kinds.running_in_life.tables import INDICES
    from bem.life.positions import Passing
    from bem.life.surfaces import LifeCase
    from bem.wear.mixed import MixedContact, shared_film_table

    (speeds,), wear, life = scene.speeds.build(), scene.wear, scene.life
    contact = MixedContact(setup, speeds, table=shared_film_table(setup, speeds), film_shape="unworn")
    passing = Passing(wear.positions, (0 in INDICES[wear.passes], 1 in INDICES[wear.passes]))
    rates = wear.rates(scene.bodies, scene.friction)
    film = None if scene.tribofilm is None else _film(scene, scene.tribofilm, setup)
    return LifeCase(
        setup.grid,
        contact,
        passing,
        rates,
        wear.distance,
        life.count,
        life.tolerance,
        film,
        life.first_step,
        longest=longest_jump(scene),
        defect=film_defect(scene),
    )


def _film(scene: Any, table: LifeFilm, setup: MixedSetup) -> GrowingTribofilm:
    """The tribofilm, as warm as the oil, or as rubbing makes each spot."""
    bulk = table.temperature if table.temperature is not None else scene.oil.temperature
    assert bulk is not None
    temperature: float = bulk
    if not table.heat:
        return table.build(scene.friction, lambda pressure: temperature)

    from bem.heat import flash_temperature

    (speeds,) = scene.speeds.build()

    def spots(pressure: FloatArray) -> float | FloatArray:
        if not pressure.any():
            return temperature
        found = flash_temperature(
            pressure,
            setup.grid,
            scene.bodies,
            friction=scene.friction,
            speeds=speeds,
            bulk=(temperature, temperature),
        )
        if found.status is not Status.CONVERGED:
            raise ConvergenceError(f"the temperature of a pass ended with residual {found.residual:.1e}")
        return found.temperature

    return table.build(scene.friction, spots)


def oil_scatter(case: LifeCase, end: LifeState) -> float | None:
    """Return the scatter of the friction at the end of a life from the constants of the oil, of the solved film whose
    load is nearest to the film's at the end; None where none is known."""
    from bem.lubrication.oil_scatter import friction_scatter
    from bem.wear.mixed import MixedContact

    contact = case.contact
    assert isinstance(contact, MixedContact)
    load = contact.setup.load * (1.0 - float(end.over("contact_share")[-1]))
    if load <= 0:
        return None
    film = contact.table.nearest(load)
    return friction_scatter(film, contact.setup.lubricant, float(end.over("oil_friction")[-1]))


def end_of(scene: Any, heights: tuple[FloatArray, FloatArray]) -> LifeState:
    """A scene's life from these heights [m] on its grid, to its end."""
    from bem.life.march import run_life

    return run_life(_alone(scene), *heights)


def bars(scene: Any, initial: tuple[FloatArray, FloatArray], end: LifeState) -> ErrorBars:
    """Error bars of a life from these heights (lower, upper) [m] to its end."""
    from bem.accuracy.coarsened import other_points
    from bem.accuracy.film import FEWEST
    from bem.accuracy.life import OtherLives, fewer_positions, life_bars, two_rounds

    def half(positions: int) -> LifeState | None:
        keys = {"wear.positions": positions, "particles": None, "fatigue": None}

        def life(heights: tuple[FloatArray, FloatArray], across: float) -> LifeState:
            cells = wearing.grid_keys(scene, 0.5, across)
            own = {name: value for name, value in cells.items() if name.startswith("grid.")}
            return end_of(with_keys(scene, own | keys), heights)

        return wearing.on_every_second_cell(initial, grid, life)

    grid, positions = build.grid_of(scene.grid), scene.wear.positions
    coarser, fewer = half(positions), half(fewer_positions(positions))
    if coarser is None or fewer is None:
        return life_bars(end, None)
    points = scene.sharing.film_points
    other = other_points(points, FEWEST)
    rounds = [two_rounds(_alone(with_keys(scene, {"sharing.film_points": count})), end) for count in (points, other)]
    return life_bars(end, OtherLives(_alone(scene).passing, coarser, fewer, rounds[0], rounds[1], other / points))


def _alone(scene: Any) -> LifeCase:
    return case_of(scene, scene.setup(**scene.sharing.model_dump()))
