"""Film model of a line contact: every film is solved when the balance requests it, on a coarse or on the wanted mesh.

Films come from `bem.lubrication.solve.solve_case`. Warm starts: the film of the nearest load of the same balance, or a
film of a similar case. Verified in
tests/friction/test_balance.py and test_continuation.py.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from bem.errors import InputError
from bem.friction.film import LEAST_EXTRAPOLATED_FILM, PatchFilm, smooth_gap
from bem.friction.smooth import LineContact
from bem.grid import FloatArray
from bem.lubrication import FilmSolution
from bem.lubrication.inlet_heating import hertz_over_modulus, inlet_heating_factor
from bem.lubrication.line.case import MOES_LOADS, LineCase, load_range
from bem.lubrication.line.problem import line_scales
from bem.lubrication.line.state import interpolate_to_mesh, without_factors
from bem.lubrication.line.steady import film_at_positions
from bem.lubrication.solve import solve_case

if TYPE_CHECKING:
    from bem.lubrication import PointFilmSolution

BALANCE_POINTS = 400
"""Nodes of the coarse mesh, on which the balance is first looked for."""
MOLECULAR_LOAD = 1e4
"""Moes' load parameter M up to which line films are solved, however thin they are."""
HOT_FRACTION = 0.9
"""Fraction of the largest load that is used with heat; smaller where inlet heating takes more than a fifth of the
viscosity (`_hot_fraction`)."""
_LEAST_EXPONENT = 0.6
"""Smallest exponent of the film in the viscosity, that of elastic bodies with isoviscous oil: the oil of a film thinned
by a factor is at most as thin as factor^(1/0.6)."""
_SEARCHED_BEYOND = 0.97
"""Margin for oils that the search for the thinned oil tries beyond its result."""
COARSE_ERROR = 1e-3
"""Relative error of films on `BALANCE_POINTS` nodes; the balance is not solved more accurately with them."""
TOLERANCE, COARSE_TOLERANCE = 1e-8, 1e-5
"""Largest residual of films without heat on the wanted and on the coarse mesh; the latter is a hundredth of the mesh's
own error."""


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
    """Solve the line film under a load.

    Bodies are rigid where the load is too small for the elastic film's range: such pressures deflect the surfaces by
    less than 1e-5 of the film thickness.

    Parameters
    ----------
    contact : the smooth contact and its oil.
    speeds : (u1, u2) of flat and cylinder [m/s].
    load : on the whole width [N], at most `largest_film_load`.
    points : nodes of the mesh.
    initial : warm start.
    position : abscissae of the solution [m]; its own mesh by default.
    tolerance : largest residual without heat. With heat the residual is at most 1e-8, on coarse meshes 1e-4 (lumped)
        or 1e-3 (full). Inlet heating's film is met to 5e-3 (`inlet_thinning.FACTOR_TOLERANCE`).
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
    case = case if heat is not None else replace(case, tolerance=tolerance)
    return solve_case(case, heat, position=position, supply=contact.supply)


@dataclass(frozen=True, eq=False)
class SolvedLineFilm:
    """Films of a line contact, each solved when it is requested; a `Film` and a `TabulatedFilms`.

    Attributes
    ----------
    contact : the smooth contact and its oil.
    speeds : (u1, u2) of flat and cylinder [m/s].
    position : (nx,) abscissae of the patch [m].
    points : nodes of the wanted mesh; a coarse mesh has `BALANCE_POINTS`.
    initial : film of a similar case, whose mesh the first film takes (not with heat) and which it may start from.
    tolerance : largest residual on the wanted mesh; with heat `TOLERANCE` on both levels.
    """

    contact: LineContact
    speeds: tuple[float, float]
    position: FloatArray
    points: int
    initial: FilmSolution | None = None
    tolerance: float = TOLERANCE

    # step, growth and continued: see `film_table.TabulatedFilms`
    step = 0.125  # cubic interpolation is then good to about 1e-4 of the film (tested)
    growth = 0.5
    continued = True

    @property
    def largest_load(self) -> float:
        """Load [N] up to which films are solved."""
        return largest_film_load(self.contact, self.speeds)

    solved_load = math.inf
    """Load [N] beyond which films are extrapolated (see `SolvedPointFilm`): line films never are."""

    @property
    def level_errors(self) -> tuple[float, ...]:
        """Errors of the coarse and the wanted mesh, or of the latter alone if it is no finer; see `Film`."""
        return (COARSE_ERROR, 0.0) if self.points > BALANCE_POINTS else (0.0,)

    def coarse_alone(self) -> SolvedLineFilm:
        """Return the same films at the coarse level alone."""
        return replace(self, points=min(self.points, BALANCE_POINTS), tolerance=COARSE_TOLERANCE)

    def under(self, load: float, level: int, start: PatchFilm | None) -> PatchFilm:
        """Solve the film under a load at a level of accuracy; see `Film`."""
        points = self.points if level == len(self.level_errors) - 1 else BALANCE_POINTS
        initial = self.initial if start is None else line_solution(start.solution)
        tolerance = self.tolerance if level == len(self.level_errors) - 1 else COARSE_TOLERANCE
        on_known_mesh = None if self.contact.heat is not None else self.initial
        if (
            initial is not None
            and on_known_mesh is not None
            and len(on_known_mesh.position) == points != len(initial.position)
        ):
            initial = interpolate_to_mesh(initial, on_known_mesh)
        film = solved_line_film(self.contact, self.speeds, load, points, initial=initial, tolerance=tolerance)
        return self.sampled(film, load)

    @property
    def parabola(self) -> FloatArray:
        """Undeformed gap on the patch; see `TabulatedFilms`."""
        return self.contact.parabola(self.position, self.position[:0])

    def solve(self, load: float, initial: FilmSolution | None) -> FilmSolution:
        """Solve a film for a table; see `TabulatedFilms`.

        The factorised equations are dropped, because the entries of a table are too far apart to start from them.
        """
        return without_factors(solved_line_film(self.contact, self.speeds, load, self.points, initial=initial))

    def solved(self, load: float) -> FilmSolution:
        """Solve the film under a load [N] on the wanted mesh."""
        return self.solve(load, self.initial)

    def sampled(self, film: FilmSolution, load: float, stretch: float = 1.0) -> PatchFilm:
        """Sample a film at stretched abscissae of the patch; see `TabulatedFilms`."""
        return sampled(film, stretch * self.position, load, self.contact)

    def resampled(self, film: PatchFilm, position: FloatArray, *, negligible: bool) -> FilmSolution:
        """Return a film's solution at other abscissae [m]; a negligible film may reach beyond them.

        Without heat Reynolds' equation is solved again from the film, which `evaluations` does not count. A film with
        heat is interpolated.

        Raises
        ------
        InputError : a film that is not negligible reaches beyond the positions, with or without heat.
        """
        solution = line_solution(film.solution)
        assert solution is not None
        if self.contact.heat is not None:
            return film_at_positions(solution, position, may_reach_beyond=negligible)
        try:
            return solved_line_film(
                self.contact, self.speeds, film.load, self.points, initial=solution, position=position
            )
        except InputError:
            if not negligible:
                raise
        return film_at_positions(solution, position, may_reach_beyond=True)


def largest_film_load(contact: LineContact, speeds: Sequence[float]) -> float:
    """Return the load on the whole width [N] up to which films are solved.

    The limit is one of Moes' load parameter M, `MOLECULAR_LOAD`. Above it films are solved as long as their asymptotes
    are thicker than `LEAST_EXTRAPOLATED_FILM`. M goes with the load over the root of the modulus; where the modulus
    itself goes with the load (`OilVolume.LOADED`), M goes with the root of the load. With heat the oil is that which
    inlet heating leaves, so that a film too hot for a load is a film model that ends, at this speed alone.
    """
    largest = contact.width * load_range(contact.radius, contact.contact_modulus, speeds, contact.lubricant)[1]
    if math.isfinite(largest):
        largest *= min(max(_load_of_least_film(contact, speeds), MOLECULAR_LOAD) / MOES_LOADS[1], 1.0)
    if contact.heat is None or math.isinf(largest):
        return _load_on_modulus(contact, largest)
    # the fraction falls with the load: at the smaller one of both it is at least as large
    fraction = _hot_fraction(contact, speeds, _load_on_modulus(contact, HOT_FRACTION * largest))
    return _load_on_modulus(contact, min(HOT_FRACTION, fraction) * largest)


def _load_on_modulus(contact: LineContact, largest: float) -> float:
    """Return the load [N] whose M is that of `largest` [N] on the unscaled modulus; see `LineContact.film_modulus`."""
    return largest if contact.deforming_load is None else largest**2 / contact.deforming_load * (1 - 1e-9)


def _hot_fraction(contact: LineContact, speeds: Sequence[float], load: float) -> float:
    """Return the fraction of the largest load that inlet heating leaves to a film under a load [N].

    M goes with the inverse root of the viscosity. The thinned oil is estimated from below, so that the search for it
    stays within the largest M.
    """
    oil = contact.lubricant
    assert oil.temperature_viscosity is not None
    assert oil.thermal_conductivity is not None
    first, second = speeds
    hertz = hertz_over_modulus(load / contact.width, contact.radius, contact.film_modulus(load))
    inlet = inlet_heating_factor(
        oil.viscosity, oil.temperature_viscosity, oil.thermal_conductivity, (float(first), float(second)), hertz
    )
    return _SEARCHED_BEYOND * inlet.factor ** (0.5 / _LEAST_EXPONENT)


def _load_of_least_film(contact: LineContact, speeds: Sequence[float]) -> float:
    """Return Moes' load parameter M under which the film is `LEAST_EXTRAPOLATED_FILM` thick.

    The thicker one of two asymptotes of the minimum film counts: 1.98 M^(-1/5), elastic and isoviscous (Herrebrugh
    1968: 2.05), and 0.98 L^(3/4) M^(-1/8), elastic and piezoviscous (Moes 2000; central film 1.31).
    """
    oil = contact.lubricant
    scales = line_scales(1.0, contact.radius, contact.contact_modulus, abs(sum(speeds)), oil.viscosity)
    material = float(oil.log_viscosity_ratio(np.zeros(1))[1][0]) * scales.pressure
    films = scales.film / LEAST_EXTRAPOLATED_FILM
    return max((1.98 * films) ** 5, (0.98 * material**0.75 * films) ** 8)


def sampled(film: FilmSolution, position: FloatArray, load: float, contact: LineContact) -> PatchFilm:
    """Sample a solved film at the abscissae (nx,) [m] of a patch; `load` and forces are on the whole width [N]."""
    pressure, thickness = film.at(position)
    sliding = None if film.sliding_stress is None else np.where(film.pressure > 0, film.sliding_stress, 0.0)
    return PatchFilm(
        load=load,
        thickness=thickness[:, None],
        pressure=pressure[:, None],
        shear_stress=film.shear_stress(position)[:, None],
        shear_force=film.shear_force * contact.width,
        minimum_thickness=film.minimum_thickness,
        status=film.status,
        notes=film.notes,
        solution=film,
        smooth_gap=smooth_gap(thickness[:, None], contact.parabola(position, position[:0]), load, contact),
        sliding_stress=None
        if sliding is None
        else np.interp(position, film.position, sliding, left=0.0, right=0.0)[:, None],
    )


def line_solution(film: FilmSolution | PointFilmSolution | None) -> FilmSolution | None:
    """Narrow the type of a solution that belongs to a line contact."""
    assert film is None or isinstance(film, FilmSolution)
    return film
