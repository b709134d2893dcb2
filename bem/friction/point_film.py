"""Film model of a point contact: every film is solved when the balance requests it, on coarse or on the wanted cells.

Films come from `bem.lubrication.solve_point_film`, each from the dry contact, without warm starts. Above the largest
load for which a film is found, films are extrapolated (`extrapolate_in_load`). Verified in tests/friction/test_ball.py.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.interpolate import RectBivariateSpline
from scipy.optimize import brentq

from bem.errors import Status
from bem.friction.film import LEAST_EXTRAPOLATED_FILM, PatchFilm, smooth_gap
from bem.friction.smooth import PointContact
from bem.grid import FloatArray
from bem.lubrication import Lubricant, PointFilmSolution, solve_point_film
from bem.lubrication.point.arguments import MOES_LOADS
from bem.lubrication.point.similarity import nijenbanning_film, point_scales
from bem.lubrication.point.validity import but_unknown
from bem.lubrication.supply import OilLayer
from bem.notes.friction import POINT_FILM_SCALED
from bem.numerics.cache import KeptValues
from bem.plausibility import without_argument_notes
from bem.reference_solutions.hertz import ellipse_contact

if TYPE_CHECKING:
    from bem.lubrication.inlet_heating import InletHeating
    from bem.lubrication.thermal.lumped_point import OilThinning

BALANCE_CELLS = 64
"""Cells along an axis of the coarse grid, on which the balance is first looked for."""
COARSE_ERROR = 0.03
"""Relative error of films on `BALANCE_CELLS` cells."""
LARGEST_MOES_LOAD, GROWTH = 2500.0, 1.25
"""Moes' load M up to which a film is solved on `BALANCE_CELLS`, and its power of the number of cells. Above it the
solver stalls, because the side lobes are narrower than a cell."""
LATTICE_RATIO = 3.0
"""Ratio of neighbouring loads at which the power of the viscosity that a film follows is found."""
_TRIED = (1.0, 0.5, 0.25)
"""Fractions of a load under which a film is tried, in this order."""
_HEAVIER = tuple(2.0**k for k in range(11))
"""Multiples of a load that are tried for a starved film whose flooded film is `DEEP` layers of oil thick: films under
larger loads are found."""
DEEP = 30.0
_DECADES = 12.0
_FACTORS = "; flow factors are those at that load"
"""Addition to notes on extrapolated films with flow factors."""


@dataclass(frozen=True, eq=False)
class SolvedPointFilm:
    """Films of a point contact, each solved when it is requested; a `Film` and a `TabulatedFilms`.

    Attributes
    ----------
    contact : the smooth contact and its oil.
    speeds : (u1, u2) of flat and ball along x [m/s].
    x, y : (nx,), (ny,) abscissae of the patch [m].
    cells : along an axis of the wanted grid.
    thinnings : of the oil by inlet heating, at the loads where they were computed (`point_film`).
    """

    contact: PointContact
    speeds: tuple[float, float]
    x: FloatArray
    y: FloatArray
    cells: int
    thinnings: dict[int, OilThinning] = field(default_factory=dict)

    step = 0.25  # this and the next two: see `film_table.TabulatedFilms`
    growth = 1 / 3
    continued = False

    @property
    def solved_load(self) -> float:
        """Load [N] up to which films are solved on the wanted cells; beyond it they are extrapolated."""
        return largest_point_load(self.contact, self.speeds, self.cells)

    @cached_property
    def largest_load(self) -> float:
        """Load [N] at which the fitted film is `LEAST_EXTRAPOLATED_FILM` thick; see `Film`."""
        solved = self.solved_load

        def thicker(decades: float) -> float:
            return math.log(_fitted_film(self.contact, self.speeds, solved * 10**decades) / LEAST_EXTRAPOLATED_FILM)

        if thicker(0.0) <= 0:
            return solved
        return math.inf if thicker(_DECADES) > 0 else solved * 10 ** float(brentq(thicker, 0.0, _DECADES, rtol=1e-9))

    @property
    def level_errors(self) -> tuple[float, ...]:
        """Errors of the coarse and the wanted grid, or of the latter alone if it is no finer; see `Film`."""
        return (COARSE_ERROR, 0.0) if self.cells > BALANCE_CELLS else (0.0,)

    def coarse_alone(self) -> SolvedPointFilm:
        """Return the same films at the coarse level alone."""
        return replace(self, cells=min(self.cells, BALANCE_CELLS), thinnings={})

    def under(self, load: float, level: int, start: PatchFilm | None) -> PatchFilm:
        """Solve the film under a load at a level of accuracy, from the dry contact; see `Film`."""
        cells = self.cells if level == len(self.level_errors) - 1 else BALANCE_CELLS
        return self.sampled(film_with_heat(self.contact, self.speeds, load, cells, self.thinnings), load)

    @property
    def parabola(self) -> FloatArray:
        """Undeformed gap on the patch; see `TabulatedFilms`."""
        return self.contact.parabola(self.x, self.y)

    def solve(self, load: float, initial: PointFilmSolution | None = None) -> PointFilmSolution:
        """Solve a film for a table; see `TabulatedFilms`."""
        return film_with_heat(self.contact, self.speeds, load, self.cells, self.thinnings)

    def sampled(self, film: PointFilmSolution, load: float, stretch: float = 1.0) -> PatchFilm:
        """Sample a film at stretched abscissae of the patch; see `TabulatedFilms`."""
        return sampled_point(film, stretch * self.x, stretch * self.y, load, self.contact)


def largest_point_load(contact: PointContact, speeds: Sequence[float], cells: int) -> float:
    """Return the load [N] up to which films are solved.

    Moes' M is proportional to the load and to the modulus to the power -1/4. The modulus is itself proportional to the
    load where the whole load deforms the bodies.
    """
    entrained = abs(sum(speeds))
    one = point_scales(1.0, contact.radii, contact.contact_modulus, entrained, contact.lubricant.viscosity).load
    narrow = max(contact.radii[0] / contact.radii[1], 1.0)
    largest = LARGEST_MOES_LOAD * (cells / BALANCE_CELLS) ** GROWTH / narrow / one
    return largest if contact.deforming_load is None else (largest**4 / contact.deforming_load) ** (1 / 3)


def moes_of_solved_film(contact: PointContact, speeds: Sequence[float], load: float, cells: int) -> tuple[bool, float]:
    """Return whether films under a load [N] are extrapolated, and Moes' L of the one that is solved, for plans.

    Parameters
    ----------
    contact : the smooth contact and its oil.
    speeds : (u1, u2) of flat and ball [m/s].
    load : on the film [N].
    cells : along an axis of the grid.
    """
    largest = largest_point_load(contact, speeds, cells)
    solved, oil = min(load, largest), contact.lubricant
    scales = point_scales(solved, contact.radii, contact.film_modulus(solved), abs(sum(speeds)), oil.viscosity)
    return load > largest, oil.pressure_viscosity * scales.pressure


def thinned_at(contact: PointContact, speeds: Sequence[float], load: float) -> bool:
    """Return True if films are solved under a load [N] to find the oil that inlet heating thins, for plans."""
    if contact.heat is None:
        return False
    from bem.lubrication.thermal.inlet_thinning import FACTOR_TOLERANCE

    return abs(math.log(_inlet(contact, speeds, load).factor)) > FACTOR_TOLERANCE


def film_with_heat(
    contact: PointContact,
    speeds: Sequence[float],
    load: float,
    cells: int,
    thinnings: dict[int, OilThinning] | None = None,
) -> PointFilmSolution:
    """Return the film under a load [N], with its heat if the contact has a heat model.

    The power of the viscosity that the central film follows is found for flooded films at the two nearest of loads
    `LATTICE_RATIO` times apart, stored in `thinnings`, and interpolated in ln(load), so that films are continuous in
    the load; the factor of inlet heating is that of the load itself. A supply then limits the film, as of line films.
    `lumped_point.add_heat` adds the temperatures of the oil past the inlet, which act on its shear stress alone.
    """
    if contact.heat is None:
        return film_without_heat(contact, speeds, load, cells)
    from bem.lubrication.thermal.lumped_point import (  # heat's modules only where there is heat
        add_heat,
        find_oil_thinning,
    )

    known = {} if thinnings is None else thinnings
    inlet, oil = _inlet(contact, speeds, load), contact.lubricant

    def thinning_at(place: int) -> OilThinning:
        if place not in known:
            at = LATTICE_RATIO**place

            def central(lubricant: Lubricant) -> float:
                flooded = replace(_of_oil(contact, lubricant), supply=None)
                film = film_without_heat(flooded, speeds, at, min(cells, BALANCE_CELLS))
                return film.central_thickness if film.status is Status.CONVERGED else math.nan

            known[place] = find_oil_thinning(
                oil, _inlet(contact, speeds, at), central, _fitted_exponent(contact, speeds, at)
            )
        return known[place]

    exact = math.log(load) / math.log(LATTICE_RATIO)
    below = math.floor(exact + 1e-9)
    thinning = thinning_at(below)
    if exact - below > 1e-9:
        thinning = thinning.between(thinning_at(below + 1), exact - below)
    film = film_without_heat(_of_oil(contact, thinning.oil(oil, inlet)), speeds, load, cells)
    dry = ellipse_contact(radii=contact.radii, contact_modulus=contact.film_modulus(load), load=load)
    return add_heat(film, oil, contact.heat.bodies, dry.semi_axes, inlet, thinning.deviation)


def _of_oil(contact: PointContact, lubricant: Lubricant) -> PointContact:
    """Return the contact with another oil and without heat."""
    return replace(contact, lubricant=lubricant, heat=None)


def _inlet(contact: PointContact, speeds: Sequence[float], load: float) -> InletHeating:
    """Return the inlet heating by the fit for line contacts, with the Hertz pressure of the ellipse."""
    from bem.lubrication.inlet_heating import inlet_heating_factor

    oil, modulus = contact.lubricant, contact.film_modulus(load)
    assert oil.temperature_viscosity is not None
    assert oil.thermal_conductivity is not None
    pressure = ellipse_contact(radii=contact.radii, contact_modulus=modulus, load=load).maximum_pressure
    both = float(speeds[0]), float(speeds[1])
    return inlet_heating_factor(
        oil.viscosity, oil.temperature_viscosity, oil.thermal_conductivity, both, pressure / modulus
    )


def _fitted_exponent(contact: PointContact, speeds: Sequence[float], load: float) -> float:
    """Return the power of the viscosity that the fitted film follows."""
    oil, share = contact.lubricant, 0.9
    thinner = _of_oil(contact, replace(oil, viscosity=share * oil.viscosity))
    return math.log(_fitted_film(thinner, speeds, load) / _fitted_film(contact, speeds, load)) / math.log(share)


def film_without_heat(contact: PointContact, speeds: Sequence[float], load: float, cells: int) -> PointFilmSolution:
    """Return the film under a load [N] without heat: solved, or extrapolated from one under a smaller load."""
    largest = min(load, largest_point_load(contact, speeds, cells))
    for share in _HEAVIER if _deep(contact, speeds, largest) else _TRIED:
        film = cached_film(contact, speeds, share * largest, cells)
        if film.status is Status.CONVERGED:
            break
    return film if share * largest == load else extrapolate_in_load(film, contact, speeds, share * largest, load)


def _deep(contact: PointContact, speeds: Sequence[float], load: float) -> bool:
    """Return True if the layer of oil is so thin that the film under a load [N] is the compressed layer."""
    if not isinstance(contact.supply, OilLayer):
        return False
    return _fitted_film(contact, speeds, load) > DEEP * contact.supply.thickness


def extrapolate_in_load(
    film: PointFilmSolution, contact: PointContact, speeds: Sequence[float], solved: float, load: float
) -> PointFilmSolution:
    """Extrapolate a film in load.

    Films above the largest solved load are thin compared with the Hertz deflection. Pressure and dry gap follow Hertz;
    the film that is added to the dry gap follows the fitted central film (`nijenbanning_film`). A film of a layer of
    oil far thinner than the flooded film is unchanged, also under smaller loads.

    Error against films solved on 128 cells at 2.5 to 20 times the load: central film 10 %, sliding friction 13 %. The
    mean weighted by pressure is too thick, by 5 to 12 % at 2.5 times the load and 20 to 230 % at 20 times, because the
    inlet keeps its width. The minimum is up to 20 times too thick.

    Parameters
    ----------
    film : solved film.
    contact : the smooth contact and its oil.
    speeds : (u1, u2) of flat and ball [m/s].
    solved : load of the solved film [N].
    load : wanted load [N].
    """
    stretch = 1.0 if contact.deforming_load is not None else (load / solved) ** (1 / 3)
    as_it_is = solved > load or _deep(contact, speeds, solved)
    thinner = 1.0 if as_it_is else _fitted_film(contact, speeds, load) / _fitted_film(contact, speeds, solved)
    dry = ellipse_contact(radii=contact.radii, contact_modulus=contact.film_modulus(solved), load=solved)
    opening = contact.parabola(film.x, film.y) + dry.displacement(film.x[:, None], film.y[None, :]) - dry.approach
    opening = np.maximum(opening, 0.0)
    least, reason = thinner * film.minimum_thickness, "layer" if solved > load else "thin"
    made = replace(
        film,
        x=stretch * film.x,
        y=stretch * film.y,
        pressure=film.pressure * (load / solved / stretch**2),
        thickness=np.maximum(stretch**2 * opening + thinner * (film.thickness - opening), least),
        central_thickness=thinner * film.central_thickness,
        minimum_thickness=least,
        central_thickness_error=None,
        minimum_thickness_error=None,
        load=film.load * (load / solved),
        notes=(
            *film.notes,
            POINT_FILM_SCALED(reason=reason, factors="" if contact.flow_factors == "off" else _FACTORS),
        ),
    )
    forces, rolling = made.forces()
    return replace(made, shear_force=forces, rolling_force=rolling)


def _fitted_film(contact: PointContact, speeds: Sequence[float], load: float) -> float:
    """Return the central film by the fit [m]."""
    oil, modulus = contact.lubricant, contact.film_modulus(load)
    scales = point_scales(load, contact.radii, modulus, abs(sum(speeds)), oil.viscosity)
    return scales.film * nijenbanning_film(scales.load, oil.pressure_viscosity * scales.pressure, scales.ratio)


@dataclass(frozen=True, eq=False)
class _Kept:
    """Film in the cache, with its size."""

    film: PointFilmSolution

    @property
    def nbytes(self) -> int:
        return sum(value.nbytes for value in vars(self.film).values() if isinstance(value, np.ndarray))

    def own(self) -> PointFilmSolution:
        """Return the film with arrays of its own, which a caller may change."""
        arrays: dict[str, Any] = {
            name: value.copy() for name, value in vars(self.film).items() if isinstance(value, np.ndarray)
        }
        return replace(self.film, **arrays)


KEPT = KeptValues(1 << 26)
"""Cache of the films of this process. Films start from the dry contact, so a cached film equals a new one. Under loads
beyond the largest all trials of a balance, and error bars, extrapolate from one film; with lumped heat each load has
its own thinned oil, and so its own film."""


def cached_film(contact: PointContact, speeds: Sequence[float], load: float, cells: int) -> PointFilmSolution:
    """Return the film under a load [N] up to the largest, without the solver's state; cached.

    Bodies are rigid where the load is too small for the elastic film's range. Notes on the film's own error are
    dropped, because load sharing has error bars of its own.
    """
    key = (solve_point_film, contact, tuple(map(float, speeds)), float(load), cells)
    try:
        hash(key)
    except TypeError:  # laws that are no keys
        return _solved(contact, speeds, load, cells)
    if not isinstance(contact.flow_factors, str):  # keys by what they are, not by what they hold, which may change
        return _solved(contact, speeds, load, cells)
    return KEPT.of(key, lambda: _Kept(_solved(contact, speeds, load, cells))).own()


def _solved(contact: PointContact, speeds: Sequence[float], load: float, cells: int) -> PointFilmSolution:
    modulus = contact.film_modulus(load)
    scales = point_scales(load, contact.radii, modulus, abs(sum(speeds)), contact.lubricant.viscosity)
    film = solve_point_film(
        load=load,
        radii=contact.radii,
        contact_modulus=math.inf if scales.load < MOES_LOADS[0] * (1 + 1e-9) else modulus,
        speeds=speeds,
        lubricant=contact.lubricant,
        shape=(cells, cells),
        flow_factors=contact.flow_factors,
        supply=contact.supply,
    )
    return replace(film, notes=without_argument_notes(but_unknown(film.notes)), state=None)


def sampled_point(
    film: PointFilmSolution, x: FloatArray, y: FloatArray, load: float, contact: PointContact
) -> PatchFilm:
    """Sample a solved film at the abscissae (nx,), (ny,) [m] of a patch.

    Deflection is interpolated by cubics, pressure and stress linearly. Beyond the film's grid the pressure is zero, and
    the deflection decays from the edge of the grid as that of the Hertz contact under the same load: beside a long
    ellipse far more slowly than that of a point load.
    """
    inside_x, inside_y = np.clip(x, film.x[0], film.x[-1]), np.clip(y, film.y[0], film.y[-1])
    deflection = _interpolated(film, film.thickness - contact.parabola(film.x, film.y), inside_x, inside_y, 3)
    away, edge = (np.broadcast_arrays(a[:, None], b[None, :]) for a, b in ((x, y), (inside_x, inside_y)))
    beyond = (away[0] != edge[0]) | (away[1] != edge[1])
    if beyond.any():
        dry = ellipse_contact(radii=contact.radii, contact_modulus=contact.film_modulus(load), load=load)
        there, begins = (dry.displacement(a[beyond], b[beyond]) for a, b in (away, edge))
        deflection[beyond] += there - begins
    parabola = contact.parabola(x, y)
    thickness = np.maximum(parabola + deflection, film.minimum_thickness)
    pressure = np.maximum(_interpolated(film, film.pressure, inside_x, inside_y, 1), 0.0)
    # on the flat, against its sliding over the ball, as of line films
    stress = -_interpolated(film, film.shear_stress()[0], inside_x, inside_y, 1)
    pressure[beyond] = stress[beyond] = 0.0
    return PatchFilm(
        load=load,
        thickness=thickness,
        pressure=pressure,
        shear_stress=stress,
        shear_force=-float(film.shear_force[0, 0]),
        minimum_thickness=film.minimum_thickness,
        status=film.status,
        notes=film.notes,
        solution=film,
        plateau=film.central_thickness,
        smooth_gap=smooth_gap(thickness, parabola, load, contact),
    )


def _interpolated(film: PointFilmSolution, field: FloatArray, x: FloatArray, y: FloatArray, order: int) -> FloatArray:
    return np.asarray(RectBivariateSpline(film.x, film.y, field, kx=order, ky=order)(x, y))
