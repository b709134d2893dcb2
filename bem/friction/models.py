"""Choice of the film model and of the contact model of a set-up: line or point film, kind of rough contact.

Modules that only some set-ups need are imported where they are chosen.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, TypeAlias

from bem.friction.line_film import SolvedLineFilm
from bem.friction.rough_contact import (
    CoupledContact,
    RoughContact,
    boundary_traction,
    reference_friction,
)
from bem.friction.setup import MixedSetup
from bem.friction.smooth import PointContact
from bem.grid import FloatArray
from bem.lubrication import FilmSolution
from bem.lubrication.line.case import check_entrainment

if TYPE_CHECKING:
    from bem.friction.point_film import SolvedPointFilm
    from bem.lubrication import PointFilmSolution

SolvedFilms: TypeAlias = "SolvedLineFilm | SolvedPointFilm"
"""Film models that solve every film when it is requested."""


def films_of(
    setup: MixedSetup,
    speeds: Sequence[float],
    *,
    at: tuple[FloatArray, FloatArray] | None = None,
    resolution: int | None = None,
    initial: FilmSolution | PointFilmSolution | None = None,
) -> SolvedFilms:
    """Return the film model of a set-up at a pair of speeds (u1, u2) [m/s].

    Parameters
    ----------
    setup : set-up of the load sharing.
    speeds : of flat and cylinder or ball.
    at : abscissae (nx,), (ny,) [m] at which films are sampled; those of the patch by default.
    resolution : nodes of the line film, or cells along an axis of the point film; those of the set-up by default.
    initial : line film of a similar case, whose mesh the first film takes (not with heat) and which it may start from.

    Raises
    ------
    InputError : speeds that are not finite or entrain nothing.
    """
    check_entrainment(speeds)
    pair = (float(speeds[0]), float(speeds[1]))
    x, y = (setup.film_grid.x, setup.film_grid.y) if at is None else at
    fine = setup.film_resolution if resolution is None else resolution
    contact = setup.smooth
    if isinstance(contact, PointContact):
        from bem.friction.point_film import SolvedPointFilm

        return SolvedPointFilm(contact, pair, x, y, fine)
    initial = initial if isinstance(initial, FilmSolution) else None
    return SolvedLineFilm(contact, pair, x, fine, initial=initial)


def rough_contact(setup: MixedSetup, height: FloatArray, speeds: Sequence[float]) -> RoughContact:
    """Return the rough contact of a set-up.

    Parameters
    ----------
    setup : set-up of the load sharing.
    height : (nx, ny) [m], sum of both surfaces, positive out of the flat; its mean does not matter.
    speeds : (u1, u2) of flat and cylinder or ball [m/s]; their order decides the direction of friction.
    """
    rough = height - height.mean()
    if setup.at_film_separation:
        from bem.friction.given_separation import contact_at_film_separation

        return contact_at_film_separation(setup, rough, speeds)
    if setup.contact_model == "uncoupled":
        from bem.friction.uncoupled_asperities import UncoupledAsperities

        return UncoupledAsperities(setup, rough)
    patch = CoupledContact(setup, rough, boundary_traction(speeds, reference_friction(setup, rough, speeds)))
    if not setup.repeated_cell:
        return patch
    from bem.friction.homogenised_contact import HomogenisedContact

    return HomogenisedContact(patch)
