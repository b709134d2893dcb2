"""Protocol of a film model, and the film as the rough contact sees it.

A film model gives the film under any load up to a largest one. Four models implement `Film`: line and point films that
are solved on request (`line_film`, `point_film`), films interpolated in a table (`film_table`), and line films between
worn bodies (`worn_film`). Load sharing knows nothing else of a film.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Protocol

from bem.errors import Status
from bem.friction.smooth import SmoothContact
from bem.grid import FloatArray
from bem.lubrication.checks import THINNEST_FILM
from bem.notes import Note

if TYPE_CHECKING:
    from bem.lubrication import FilmSolution, PointFilmSolution

LEAST_EXTRAPOLATED_FILM = 0.5 * THINNEST_FILM
"""Least thickness [m] of films under loads at which none is solved: half of that below which the model is not valid."""


@dataclass(frozen=True, eq=False)
class PatchFilm:
    """Film between smooth surfaces, sampled on the rough patch; arrays (nx, ny), or (nx, 1) of a line contact.

    Attributes
    ----------
    load : under which the film was requested [N]; `status` says whether the film carries it.
    thickness : film thickness [m].
    pressure : film pressure [Pa].
    shear_stress : shear stress on the flat, positive along -x as of `FilmSolution` [Pa]; `PointFilmSolution` has it
        along +x.
    shear_force : of the film, beyond the patch too [N], signed like `FilmSolution.shear_force`.
    minimum_thickness : of the film, beyond the patch too [m].
    status : outcome of the solution.
    notes : on the validity of the film's model.
    solution : solution that the film was sampled from; None of an interpolated film.
    smooth_gap : gap of the smooth bodies deformed by the film pressure alone, up to a constant [m]; None where it is
        the thickness.
    plateau : central film thickness [m] of a point contact; None of a line contact.
    sliding_stress : shear stress in the middle of the film [Pa], zero without pressure; None where the film model hands
        none over (point films), and it is computed from `shear_stress` and the pressure gradient on the patch.
    """

    load: float
    thickness: FloatArray
    pressure: FloatArray
    shear_stress: FloatArray
    shear_force: float
    minimum_thickness: float
    status: Status = Status.CONVERGED
    notes: tuple[Note, ...] = ()
    solution: FilmSolution | PointFilmSolution | None = None
    smooth_gap: FloatArray | None = None
    plateau: float | None = None
    sliding_stress: FloatArray | None = None

    @property
    def carrying_thickness(self) -> float:
        """Film thickness where the film carries its load [m].

        At the centre of a point contact, because the side lobes are far thinner; else the minimum.
        """
        return self.minimum_thickness if self.plateau is None else self.plateau

    @property
    def gap(self) -> FloatArray:
        """Gap that the deflection by contact pressure adds to, up to a constant [m]."""
        return self.thickness if self.smooth_gap is None else self.smooth_gap

    def sheared_in(self, opening: float, oil: float) -> PatchFilm:
        """Return the film sheared across a wider gap than its own thickness.

        A starved film fills only the fraction oil/opening of the gap and is sheared that much more slowly, so its shear
        stress scales with (oil/opening)^2. A flooded gap is full: its film keeps the shear stress, an upper bound.

        Parameters
        ----------
        opening : mean gap [m].
        oil : mean film thickness [m].
        """
        starvation = None if self.solution is None else self.solution.starvation
        if starvation is None or starvation.flooded or not 0 < oil < opening:
            return self
        scale = (oil / opening) ** 2
        return replace(
            self,
            shear_stress=scale * self.shear_stress,
            shear_force=scale * self.shear_force,
            sliding_stress=None if self.sliding_stress is None else scale * self.sliding_stress,
        )


def middle_line(field: FloatArray) -> FloatArray:
    """Return the line (nx,) through the middle of a field (nx, ny), or of a field (nx, 1) that is uniform along y."""
    ny = field.shape[1]
    return field[:, 0] if ny == 1 else 0.5 * (field[:, (ny - 1) // 2] + field[:, ny // 2])


class Film(Protocol):
    """Films of one contact at one pair of speeds, as a function of the load that they carry."""

    @property
    def largest_load(self) -> float:
        """Load [N] up to which there are films; math.inf without a limit."""

    @property
    def level_errors(self) -> tuple[float, ...]:
        """Relative errors of the levels of accuracy, coarse to fine; the last level counts as exact."""

    def under(self, load: float, level: int, start: PatchFilm | None) -> PatchFilm:
        """Return the film under a load [N], positive and at most the largest, at a level of accuracy.

        `start` is a film of a similar case: a warm start.
        """


def smooth_gap(thickness: FloatArray, parabola: FloatArray, load: float, contact: SmoothContact) -> FloatArray | None:
    """Return the gap [m] of the smooth bodies deformed by the film pressure alone; None where it is the thickness.

    With `OilVolume.LOADED` the thickness contains the deflection by the whole load. Film pressure contributes the
    fraction load / deforming load of it.

    Parameters
    ----------
    thickness : film thickness on the patch [m].
    parabola : undeformed gap on the patch [m].
    load : that the film carries [N].
    contact : the smooth contact.
    """
    if contact.deforming_load is None:
        return None
    return parabola + load / contact.deforming_load * (thickness - parabola)
