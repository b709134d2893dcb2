"""The films of a set-up, by what its smooth contact is: the one place that asks for a line or a point."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, TypeAlias

from bem.friction.film import SolvedFilm
from bem.friction.setup import MixedSetup
from bem.friction.smooth import PointContact
from bem.grid import FloatArray
from bem.lubrication import FilmSolution, PointFilmSolution
from bem.lubrication.line_case import check_entrainment

if TYPE_CHECKING:
    from bem.friction.point_film import SolvedPointFilm

SolvedFilms: TypeAlias = "SolvedFilm | SolvedPointFilm"


def films_of(
    setup: MixedSetup,
    speeds: Sequence[float],
    *,
    at: tuple[FloatArray, FloatArray] | None = None,
    resolution: int | None = None,
    initial: FilmSolution | PointFilmSolution | None = None,
) -> SolvedFilms:
    """Films at a pair of speeds (u1, u2) [m/s], given at the abscissae (nx,), (ny,) [m] of the patch.

    Parameters
    ----------
    setup, speeds : of the load sharing.
    at : other abscissae.
    resolution : other than the set-up's.
    initial : a film of
        a similar case.

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
        from bem.friction.point_film import SolvedPointFilm  # a cylinder's run does without, and starts sooner

        return SolvedPointFilm(contact, pair, x, y, fine)
    initial = initial if isinstance(initial, FilmSolution) else None
    return SolvedFilm(contact, pair, x, fine, striated_exit=setup.striated_exit, initial=initial)
