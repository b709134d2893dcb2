"""Steps of plans of oil films, each with what it was measured to cost.

Knows what a scene says of its films and speeds; no kind of scene, no film. Verified in tests/frugality/test_plans.py.
"""

from __future__ import annotations

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


def of_curve(speeds: int, points: int, cells: int | None, hertz_pressure: float) -> Step:
    """Return the step of the films of a curve.

    Parameters
    ----------
    speeds : number of speeds.
    points : nodes of a cylinder's film.
    cells : cells along an axis of a ball's film; None for a cylinder.
    hertz_pressure : highest pressure of the smooth contact [Pa].
    """
    what = "for the speed" if speeds == 1 else f"for each of {speeds} speeds of a curve"
    if cells is None:
        seconds = speeds * (0.02 + 1.7e-5 * points) * max(1.0, hertz_pressure / _LIGHT_PRESSURE)
        return Step("films", f"about 5 {what}, most of them on a coarser mesh", seconds=seconds, memory=_HELD * points)
    seconds = speeds * (0.05 + 6e-5 * cells**2)  # measured: 8 speeds on 80 and on 128 cells
    return Step(
        "films",
        f"about 5 {what}, some of them on fewer cells",
        seconds=seconds,
        memory=900.0 * cells**2,
    )


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
