"""Steps of plans of oil films, each with what it was measured to cost.

Knows what a scene says of its films and speeds; no kind of scene, no film. Verified in tests/frugality/test_plans.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from bem.scenes.planner import SEARCHED_IN_SINGLE, Step

_IN_CONTACT = "; that of the surfaces in contact at each speed"
_HEAT = {
    "off": ('thermal is "off"', 0.0, 0.0),
    "lumped": ("inlet heating of each film and its oil's temperature" + _IN_CONTACT, 0.15, 1.0),
    "full": ("temperature along and across each film" + _IN_CONTACT, 5.0, 5.0),
}
"""Reason of the step, and seconds at a speed on any grid, of cylinders and of balls."""

_HELD = 1e4
"""Bytes a node of a line film's weights and of its equations taken apart, 500 to 8000 nodes."""


_LIGHT_PRESSURE = 0.15e9
"""Hertz pressure [Pa] beyond which the cost of a line film grows in proportion to the pressure."""


_COARSE_CELLS = 64
"""`bem.friction.point_film.BALANCE_CELLS`."""
_BALL_FILM, _NEARLY_ISOVISCOUS, _HARD = 2e-5, 0.4, 10.0
"""Processor time of a film over cells squared [s], Moes' L below which films take many times as long, and how many:
0.13 s at L of 0.5 to 6 and 0.65 to 0.96 s below 0.2 on 64 cells, 0.2 and 1.9 to 2.5 s on 96 (ellipse 1 : 10)."""


def _for_speeds(speeds: int) -> str:
    return "for the speed" if speeds == 1 else f"for each of {speeds} speeds of a curve"


def of_curve(speeds: int, points: int, hertz_pressure: float) -> Step:
    """Return the step of the films of a curve of a cylinder.

    Parameters
    ----------
    speeds : number of speeds.
    points : nodes of a film.
    hertz_pressure : highest pressure of the smooth contact [Pa].
    """
    seconds = speeds * (0.02 + 1.7e-5 * points) * max(1.0, hertz_pressure / _LIGHT_PRESSURE)
    what = f"about 5 {_for_speeds(speeds)}, most of them on a coarser mesh"
    return Step("films", what, seconds=seconds, memory=_HELD * points)


@dataclass(frozen=True)
class BallFilms:
    """Films of one balance of a ball.

    Each trial has a film of its own, and each grid one under the whole load. Films beyond the largest solved load are
    extrapolated from one film; with heat each load has its own oil, and so its own film. Thinned oil is found from
    coarse films at two loads, five in all.

    Attributes
    ----------
    cells : along an axis of the film.
    extrapolated : films are extrapolated in load.
    heated : films have heat.
    thinned : inlet heating thins the oil.
    material : Moes' L of the film that is solved.
    """

    cells: int
    extrapolated: bool
    heated: bool
    thinned: bool
    material: float

    @property
    def numbers(self) -> tuple[int, int]:
        """Numbers of films on the coarse and on the wanted cells."""
        coarse, fine = (4, 4) if self.heated or not self.extrapolated else (1, 1)
        if self.cells <= _COARSE_CELLS:
            coarse, fine = 0, max(coarse, fine)
        return coarse + 5 * self.thinned, fine

    @property
    def seconds(self) -> float:
        """Processor time [s]."""
        coarse, fine = self.numbers
        squares = coarse * min(self.cells, _COARSE_CELLS) ** 2 + fine * self.cells**2
        return _BALL_FILM * squares * (_HARD if self.material < _NEARLY_ISOVISCOUS else 1.0)


def of_ball_curve(films: Sequence[BallFilms]) -> Step:
    """Return the step of the films of a curve of a ball, given those of each speed."""
    most = max(sum(one.numbers) for one in films)
    what = f"about {most} {_for_speeds(len(films))}, some of them on fewer cells"
    seconds = sum(one.seconds for one in films)
    return Step("films", what, seconds=seconds, memory=900.0 * max(one.cells for one in films) ** 2)


def heat(thermal: str, speeds: int, cells: int, *, ball: bool) -> Step:
    """Step of heat for films and contacts at a number of speeds, on a grid of a number of cells."""
    what, of_cylinder, of_ball = _HEAT[thermal]
    cost = speeds * ((of_ball if ball else of_cylinder) + 3e-6 * cells)
    return Step("heat", what, skipped=thermal == "off", seconds=cost, memory=2e7 + 300.0 * cells)


def oil_beside(oil_volume: str, speeds: int, *, at_film_separation: bool = False) -> Step:
    """Step of a curve for the oil beside Hertz' contact."""
    loaded = oil_volume == "loaded" or at_film_separation
    why = (
        "no volume of oil is kept"
        if at_film_separation
        else "oil is counted where the film is loaded"
        if loaded
        else "once more at each speed where film and contact share the load, to tell what that oil decides"
    )
    return Step(
        "balance without the oil beside the contact",
        why,
        seconds=speeds * 0.015,
        skipped=loaded,
        precision=SEARCHED_IN_SINGLE,
    )


def tables(points: int, cells: int | None, thermal: str, shared_by: str) -> Step:
    """Return the step of films over the load they carry, tabulated once for each speed.

    Parameters
    ----------
    points : nodes of a cylinder's film.
    cells : cells along an axis of a ball's film; None for a cylinder.
    thermal : heat of the films, which each film of a table has.
    shared_by : what looks films up in the table, in words.
    """
    _, of_cylinder, of_ball = _HEAT[thermal]
    if cells is None:
        films, memory = 20, 20 * _HELD * points
        seconds = films * (0.005 + 1.5e-5 * points + 0.2 * of_cylinder)
    else:
        films, memory = 8, 8 * 900.0 * cells**2
        seconds = films * (0.05 + 4.5e-5 * cells**2) * (1.0 + 0.65 * of_ball)
    what = f"about {films} films for each speed, shared by all {shared_by}"
    return Step("film tables", what, per="grid", seconds=seconds, memory=memory)


def heat_of_contacts(thermal: str, contacts: float, cells: int) -> Step:
    """Return the step of the temperature of surfaces that touch, once for each of a number of contacts."""
    return Step(
        "heat of contacts",
        _HEAT[thermal][0] if thermal == "off" else "temperature of the surfaces in contact, once for each contact",
        skipped=thermal == "off",
        seconds=contacts * 1e-6 * cells,
        memory=300.0 * cells,
    )


def of_ball(cells: int, *, wanted: bool) -> Step:
    """One balance of a ball's film on so many cells along an axis with the surfaces under it."""
    what = "load shared once between oil and surfaces" if wanted else "no oil: the surfaces carry all of the load"
    return Step("oil film", what, skipped=not wanted, seconds=2.0 + 2e-4 * cells**2, memory=900.0 * cells**2)
