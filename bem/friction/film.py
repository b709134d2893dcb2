"""Films over the load they carry: what load sharing asks of a film model, and the film that is solved when asked for.

A film model is anything with the three members of `Film`: line or point contact, solved or tabulated, thermal or not.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from bem.errors import InputError, Status
from bem.friction.smooth import LineContact, SmoothContact
from bem.grid import FloatArray
from bem.lubrication import FilmSolution, PointFilmSolution
from bem.lubrication.line_case import MOES_LOADS, LineCase, load_range
from bem.lubrication.line_kept import without_equations
from bem.lubrication.line_scales import line_scales
from bem.lubrication.line_starts import on_mesh_of
from bem.lubrication.steady import line_film
from bem.lubrication.validity import THINNEST_FILM
from bem.lubrication.with_heat import film_with_heat
from bem.notes import Note

BALANCE_POINTS = 400
"""Film nodes while the balance is looked for; the last evaluations use the number asked for."""
BALANCE_CELLS = 64
"""The same of a ball's film: cells along an axis."""
MOLECULAR_LOAD = 1e4
"""Moes' load M up to which line films are looked for, however thin."""
LEAST_FILM = 0.5 * THINNEST_FILM
"""Least film [m] beyond that load: half of the thickness below which a film counts as none."""
HOT_SHARE = 0.9
"""Of the largest load that an oil carries, while heat in the inlet thins it by less than a fifth."""
COARSE_FILM = 1e-3
"""Relative error of films of `BALANCE_POINTS`: the balance is met no better with them."""
TOLERANCE, COARSE_TOLERANCE = 1e-8, 1e-5
"""Largest residual of films, and of those of `BALANCE_POINTS`: a hundredth of what their points leave."""


@dataclass(frozen=True, eq=False)
class PatchFilm:
    """A smooth film as the rough patch sees it; arrays (nx, ny), or (nx, 1) where it is the same along y.

    load : it carries [N]. thickness [m], pressure and shear_stress [Pa] : on the patch. shear_force : of the whole
    film [N], signed like `FilmSolution.shear_force`. minimum_thickness : of the whole film [m]. status : outcome.
    notes : where the film's model is outside its validity. solution : what it was sampled from, if it was solved.
    smooth_gap : of the surfaces as far as the film's pressure alone deforms them, but for a constant [m]; the thickness
    if None. plateau : a ball's film at its centre [m]; None of a cylinder.
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

    @property
    def carrying_thickness(self) -> float:
        """Of the film where it carries [m]: at a ball's centre, whose constrictions are far thinner; else the
        minimum."""
        return self.minimum_thickness if self.plateau is None else self.plateau

    @property
    def gap(self) -> FloatArray:
        """What the rough contact's own deflection adds to, but for a constant [m]."""
        return self.thickness if self.smooth_gap is None else self.smooth_gap

    def left_in(self, opening: float, oil: float) -> PatchFilm:
        """Of a starved film the same, sheared in a wider mean gap [m] than its own, the oil's mean thickness [m]: no
        more oil comes, so it fills oil/opening of the gap, across which it is sheared as much more slowly. A flooded
        gap is full, and its film keeps its shear stress, an upper bound."""
        starvation = None if self.solution is None else self.solution.starvation
        if starvation is None or starvation.flooded or not 0 < oil < opening:
            return self
        part = (oil / opening) ** 2
        return replace(self, shear_stress=part * self.shear_stress, shear_force=part * self.shear_force)


def middle_line(field: FloatArray) -> FloatArray:
    """Of a field (nx, ny), or (nx, 1) where it is the same along y, the line (nx,) through the middle."""
    ny = field.shape[1]
    return field[:, 0] if ny == 1 else 0.5 * (field[:, (ny - 1) // 2] + field[:, ny // 2])


class Film(Protocol):
    """Films of one contact at one pair of speeds."""

    @property
    def largest_load(self) -> float:
        """Load [N] up to which there are films; math.inf for any."""

    @property
    def errors(self) -> tuple[float, ...]:
        """Relative errors of the levels of accuracy on offer, coarse to fine; the last counts as zero."""

    def under(self, load: float, level: int, start: PatchFilm | None) -> PatchFilm:
        """The film under any positive load [N] up to the largest, at a level; `start` is one of a similar case."""


def solved_line_film(
    contact: LineContact,
    speeds: Sequence[float],
    load: float,
    points: int,
    *,
    initial: FilmSolution | None = None,
    position: FloatArray | None = None,
    tolerance: float = TOLERANCE,
) -> FilmSolution:
    """The film under a load on the whole width [N] up to the largest.

    Where the load is so small that the elastic film is outside its range, the surfaces are rigid: pressures that small
    move them by less than 1e-5 of the film. tolerance : as of `solve_line_film`, without heat: rounds of heat have
    their own.
    """
    modulus, heat = contact.film_modulus(load), contact.heat
    lowest, _ = load_range(contact.radius, modulus, speeds, contact.lubricant)
    case = LineCase(
        load=load / contact.width,
        radius=contact.radius,
        contact_modulus=math.inf if load / contact.width < lowest else modulus,
        speeds=speeds,
        lubricant=contact.lubricant,
        points=points,
        initial=initial,
        flow_factors=contact.flow_factors,
    )
    if heat is None:
        return line_film(replace(case, tolerance=tolerance), position=position, supply=contact.supply)
    unheated = {"position": position is not None, "supply": contact.supply is not None and heat.model == "full"}
    return film_with_heat(case, heat, contact.supply, unheated)


@dataclass(frozen=True, eq=False)
class SolvedFilm:
    """Films of a line contact, each solved when it is asked for, on a coarse and on the wanted mesh.

    position : (nx,) abscissae of the patch [m]. speeds : (u1, u2) of flat and cylinder [m/s]. points : of the film's
    own mesh. striated_exit : whether the oil behind the exit adds to the shear force. initial : a film of a similar
    case, where the first one starts. tolerance : of the films on the wanted mesh.
    """

    contact: LineContact
    speeds: tuple[float, float]
    position: FloatArray
    points: int
    striated_exit: bool = False
    initial: FilmSolution | None = None
    tolerance: float = TOLERANCE

    step = 0.125  # cubic interpolation is then good to about 1e-4 of the film (tested)
    growth = 0.5
    continued = True

    @property
    def largest_load(self) -> float:
        """Load [N] up to which a film is looked for."""
        return largest_film_load(self.contact, self.speeds)

    solved_load = math.inf  # as of `SolvedPointFilm`: none goes on from another

    @property
    def errors(self) -> tuple[float, ...]:
        """As `Film`: a coarse mesh and the one asked for, or that alone if it is no finer."""
        return (COARSE_FILM, 0.0) if self.points > BALANCE_POINTS else (0.0,)

    def under(self, load: float, level: int, start: PatchFilm | None) -> PatchFilm:
        """As `Film`."""
        points = self.points if level == len(self.errors) - 1 else BALANCE_POINTS
        initial = self.initial if start is None else line_solution(start.solution)
        tolerance = self.tolerance if level == len(self.errors) - 1 else COARSE_TOLERANCE
        kept = None if self.contact.heat is not None else self.initial
        if initial is not None and kept is not None and len(kept.position) == points != len(initial.position):
            initial = on_mesh_of(initial, kept)
        film = solved_line_film(self.contact, self.speeds, load, points, initial=initial, tolerance=tolerance)
        return self.sampled(film, load)

    @property
    def parabola(self) -> FloatArray:
        """As `TabulatedFilms`."""
        return self.contact.parabola(self.position, self.position[:0])

    def solve(self, load: float, initial: FilmSolution | None) -> FilmSolution:
        """As `TabulatedFilms`: a table's films lie too far apart to start by one another's equations."""
        return without_equations(solved_line_film(self.contact, self.speeds, load, self.points, initial=initial))

    def solved(self, load: float) -> FilmSolution:
        """Return the film that is solved for a load [N]."""
        return self.solve(load, self.initial)

    def sampled(self, film: FilmSolution, load: float, stretch: float = 1.0) -> PatchFilm:
        """As `TabulatedFilms`."""
        return sampled(film, stretch * self.position, load, self.contact, striated_exit=self.striated_exit)

    def resampled(self, film: PatchFilm, position: FloatArray, *, negligible: bool) -> FilmSolution:
        """The film at abscissae [m] of the caller's choice; a film that carries next to nothing may reach beyond them.

        Raises
        ------
        InputError : a film that counts reaches beyond the positions.
        """
        solution = line_solution(film.solution)
        assert solution is not None
        if self.contact.heat is not None:
            pressure, thickness = solution.at(position)
            return replace(solution, position=position, pressure=pressure, thickness=thickness)
        try:
            return solved_line_film(
                self.contact, self.speeds, film.load, self.points, initial=solution, position=position
            )
        except InputError:
            if not negligible:
                raise
        pressure, thickness = solution.at(position)
        return replace(solution, position=position, pressure=pressure, thickness=thickness)


def largest_film_load(contact: LineContact, speeds: Sequence[float]) -> float:
    """Load on the whole width [N] up to which a film is looked for.

    The end is one of Moes' parameter M, load over a root of the modulus: where that goes with the load, with its root.
    Beyond `MOLECULAR_LOAD` it is where the film is thinner than `LEAST_FILM` by its asymptotes; such a film is none.
    """
    largest = contact.width * load_range(contact.radius, contact.contact_modulus, speeds, contact.lubricant)[1]
    if math.isfinite(largest):
        largest *= min(max(_load_of_least_film(contact, speeds), MOLECULAR_LOAD) / MOES_LOADS[1], 1.0)
    if contact.heat is not None:
        largest *= HOT_SHARE
    return largest if contact.deforming_load is None else largest**2 / contact.deforming_load * (1 - 1e-9)


def _load_of_least_film(contact: LineContact, speeds: Sequence[float]) -> float:
    """Moes' load M under which the film is `LEAST_FILM` thick.

    Of the asymptotes of the least film, 1.98 M^(-1/5) of isoviscous oils (Herrebrugh 1968: 2.05) and
    0.98 L^(3/4) M^(-1/8) of those that pressure thickens (Moes 2000, central 1.31), the thicker one.
    """
    oil = contact.lubricant
    scales = line_scales(1.0, contact.radius, contact.contact_modulus, abs(sum(speeds)), oil.viscosity)
    material = float(oil.log_viscosity_ratio(np.zeros(1))[1][0]) * scales.pressure
    films = scales.film / LEAST_FILM
    return max((1.98 * films) ** 5, (0.98 * material**0.75 * films) ** 8)


def sampled(
    film: FilmSolution, position: FloatArray, load: float, contact: LineContact, *, striated_exit: bool = False
) -> PatchFilm:
    """A solved film at the abscissae (nx,) [m] of a patch; `load` and the forces are on the whole width [m]."""
    pressure, thickness = film.at(position)
    force = film.striated_shear_force if striated_exit else film.shear_force
    return PatchFilm(
        load=load,
        thickness=thickness[:, None],
        pressure=pressure[:, None],
        shear_stress=film.shear_stress(position)[:, None],
        shear_force=force * contact.width,
        minimum_thickness=film.minimum_thickness,
        status=film.status,
        notes=film.notes,
        solution=film,
        smooth_gap=smooth_gap(thickness[:, None], contact.parabola(position, position[:0]), load, contact),
    )


def line_solution(film: FilmSolution | PointFilmSolution | None) -> FilmSolution | None:
    """The same, known to be of a line contact if there is one."""
    assert film is None or isinstance(film, FilmSolution)
    return film


def smooth_gap(thickness: FloatArray, parabola: FloatArray, load: float, contact: SmoothContact) -> FloatArray | None:
    """The gap [m] that a film's own pressure makes, where its thickness has all of the load's deflection: undeformed
    the parabola [m], and of the deflection the film's part. None where the thickness is that gap."""
    if contact.deforming_load is None:
        return None
    return parabola + load / contact.deforming_load * (thickness - parabola)
