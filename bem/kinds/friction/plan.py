"""Plan of a case of kind `friction`."""

from __future__ import annotations

from bem.kinds.friction.scene import FrictionScene
from bem.scenes import film_plans, plans
from bem.scenes.planner import Plan, Step

_CONVOLUTIONS = 30  # of the contacts of one speed: 11 to 21 were counted, and those that tell of the oil beside them
_SEPARATIONS = 10  # of the flow factors' table
_FILMS_AGAIN, _BALL_FILMS_AGAIN, _HEAT_AGAIN = 1.2, 0.7, 0.6
"""Fractions of the time of films, and of the time of their heat, for both balances of error bars: 0.8 to 2 of a
cylinder's films was measured, 0.7 of a ball's, 0.4 to 0.8 of both with heat."""


def _films_of_ball(scene: FrictionScene) -> list[film_plans.BallFilms]:
    """Return the films of a balance of a ball at each speed."""
    from bem.friction.point_film import moes_of_solved_film, thinned_at
    from bem.friction.smooth import PointContact

    contact, cells = scene.curve_setup("off").smooth, scene.film.cells
    assert isinstance(contact, PointContact)
    found = []
    for pair in scene.speeds.build():
        extrapolated, material = moes_of_solved_film(contact, pair, scene.load, cells)
        thinned = thinned_at(contact, pair, scene.load)
        found.append(film_plans.BallFilms(cells, extrapolated, contact.heat is not None, thinned, material))
    return found


def plan(scene: FrictionScene) -> Plan:
    """Plan the computation of one curve.

    Raises
    ------
    InputError : a patch that does not fit. InfeasibleError : a load that neither film nor surfaces can carry.
    """
    grid, speeds, coupled = scene.check(scene.film), len(scene.speeds.build()), scene.coupled
    ball = scene.contact.point_radii is not None
    heat = film_plans.heat(scene.thermal, speeds, grid.cells, ball=ball)
    smooth = scene.smooth_contact()
    if ball:
        films = film_plans.of_ball_curve(_films_of_ball(scene))
    else:
        pressure = smooth.maximum_pressure if smooth is not None else 0.0
        films = film_plans.of_curve(speeds, scene.film.points, pressure)
    # a further one of the four films of a balance, and the Fourier transforms of the continued patch
    waves = films.seconds / 4 + 0.3 * speeds
    again = _BALL_FILMS_AGAIN if ball else _FILMS_AGAIN
    return Plan.of(
        plans.surfaces(grid, scene.lower.surface, scene.upper.surface),
        films,
        *(
            [Step("waves", "a film under the whole load at each speed, and its waves", seconds=waves)]
            if scene.by_waves
            else []
        ),
        heat,
        plans.contacts(
            grid,
            _CONVOLUTIONS * speeds,
            "each speed from the one before; none where the film clears the roughness",
            name="rough contacts",
            skipped=not coupled,
        ),
        film_plans.oil_beside(scene.sharing.oil_volume, speeds, at_film_separation=scene.at_film_separation),
        plans.error_bars(
            scene.outputs.errors,
            "each balance on the grid of twice the cell, and there with half the film's points",
            seconds=again * films.seconds + (0.0 if heat.skipped else _HEAT_AGAIN * heat.seconds),
            **plans.coarser_contacts(grid, _CONVOLUTIONS * speeds if coupled else 0, 2.0),
        ),
        plans.flow_factors(grid, _SEPARATIONS, wanted=scene.sharing.flow_factors != "off"),
        Step("stresses", "friction alone needs none", skipped=True),
        plans.traction_kernels(grid, *scene.bodies, scene.contact.boundary_friction, wanted=coupled),
        plans.figures(grid.cells),
    )
