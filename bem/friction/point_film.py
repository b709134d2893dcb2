"""Films of a ball or ellipsoid over the load they carry, as load sharing asks for them: solved, on a rough patch.

Verified in tests/friction/test_ball.py.
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
from bem.friction.film import PatchFilm, smooth_gap
from bem.friction.smooth import PointContact
from bem.grid import FloatArray
from bem.lubrication import Lubricant, PointFilmSolution, solve_point_film
from bem.lubrication.point.scales import nijenbanning_film, point_scales
from bem.lubrication.point.solve import MOES_LOADS
from bem.lubrication.point.validity import but_unknown
from bem.lubrication.supply import OilLayer
from bem.lubrication.validity import THINNEST_FILM
from bem.notes.friction import POINT_FILM_SCALED
from bem.numerics.cache import KeptValues
from bem.plausibility import without_argument_notes
from bem.reference_solutions.hertz import ellipse_contact

if TYPE_CHECKING:
    from bem.lubrication.inlet_heating import InletHeating
    from bem.lubrication.thermal.lumped_point import Thinning

BALANCE_CELLS = 64
"""Cells along an axis of the coarse grid, on which the balance is first looked for."""
COARSE_FILM = 0.03
"""Relative error of films on `BALANCE_CELLS` cells."""
LARGEST_MOES_LOAD, GROWTH = 2500.0, 1.25
"""Moes' load M up to which a film is solved on `BALANCE_CELLS`, and the power of the cells that it goes with: films
above stall, their constrictions narrower than a cell (tried with L 1 to 5, Rx/Ry 0.2 and 1, 64 to 128 cells)."""
LEAST_FILM = 0.5 * THINNEST_FILM
"""Thickness [m] at the centre to which films go on: half of what counts as none."""
THINNED = 3.0
"""Ratio of the loads at which it is found how thin inlet heating makes the oil."""
_TRIED = (1.0, 0.5, 0.25)
"""Shares of a load under which a film is looked for, one after the other."""
_HEAVIER = tuple(2.0**k for k in range(11))
"""The same of films whose flooded ones are `DEEP` layers thick: heavier ones are found."""
DEEP = 30.0
_DECADES = 12.0
_FACTORS = "; flow factors are those at that load"
"""Words of the notes on scaled films with flow factors."""


@dataclass(frozen=True, eq=False)
class SolvedPointFilm:
    """Films of a point contact, each solved when it is asked for, on few and on the wanted cells.

    x, y : (nx,), (ny,) abscissae of the patch [m]. speeds : (u1, u2) of flat and ball along x [m/s]. cells : of the
    film's own grid, along an axis. thinnings : by inlet heating, at the loads where they were found (`point_film`).
    """

    contact: PointContact
    speeds: tuple[float, float]
    x: FloatArray
    y: FloatArray
    cells: int
    thinnings: dict[int, Thinning] = field(default_factory=dict)

    step = 0.25
    growth = 1 / 3
    continued = False

    @property
    def solved_load(self) -> float:
        """Load [N] up to which films are solved on the wanted cells; beyond it they go on from there."""
        return largest_point_load(self.contact, self.speeds, self.cells)

    @cached_property
    def largest_load(self) -> float:
        """As `Film`: to where it is so thin, by the fit, that it is none."""
        solved = self.solved_load

        def thicker(decades: float) -> float:
            return math.log(_fitted_film(self.contact, self.speeds, solved * 10**decades) / LEAST_FILM)

        if thicker(0.0) <= 0:
            return solved
        return math.inf if thicker(_DECADES) > 0 else solved * 10 ** float(brentq(thicker, 0.0, _DECADES, rtol=1e-9))

    @property
    def errors(self) -> tuple[float, ...]:
        """As `Film`: few cells and those asked for, or these alone if they are no more."""
        return (COARSE_FILM, 0.0) if self.cells > BALANCE_CELLS else (0.0,)

    def coarse_alone(self) -> SolvedPointFilm:
        """Return the same films at the coarse level alone."""
        return replace(self, cells=min(self.cells, BALANCE_CELLS), thinnings={})

    def under(self, load: float, level: int, start: PatchFilm | None) -> PatchFilm:
        """As `Film`; each film begins from the dry contact, whatever `start` is."""
        cells = self.cells if level == len(self.errors) - 1 else BALANCE_CELLS
        return self.sampled(point_film(self.contact, self.speeds, load, cells, self.thinnings), load)

    @property
    def parabola(self) -> FloatArray:
        """As `TabulatedFilms`."""
        return self.contact.parabola(self.x, self.y)

    def solve(self, load: float, initial: PointFilmSolution | None = None) -> PointFilmSolution:
        """As `TabulatedFilms`."""
        return point_film(self.contact, self.speeds, load, self.cells, self.thinnings)

    def sampled(self, film: PointFilmSolution, load: float, stretch: float = 1.0) -> PatchFilm:
        """As `TabulatedFilms`."""
        return sampled_point(film, stretch * self.x, stretch * self.y, load, self.contact)


def largest_point_load(contact: PointContact, speeds: Sequence[float], cells: int) -> float:
    """Load [N] up to which a film is solved: Moes' M goes with the load, and with the root of the fourth order of
    the modulus downwards, which itself goes with the load where all of the load deforms the bodies."""
    entrained = abs(sum(speeds))
    one = point_scales(1.0, contact.radii, contact.contact_modulus, entrained, contact.lubricant.viscosity).load
    narrow = max(contact.radii[0] / contact.radii[1], 1.0)
    largest = LARGEST_MOES_LOAD * (cells / BALANCE_CELLS) ** GROWTH / narrow / one
    return largest if contact.deforming_load is None else (largest**4 / contact.deforming_load) ** (1 / 3)


def point_film(
    contact: PointContact,
    speeds: Sequence[float],
    load: float,
    cells: int,
    thinnings: dict[int, Thinning] | None = None,
) -> PointFilmSolution:
    """The film under a load [N], with its heat where that is asked for.

    How much thinner the oil must be is found at the nearest of loads `THINNED` times apart, of a flooded film, of which
    a supply then lets as much through as there is, as of line films; `thinnings` keeps it.
    """
    if contact.heat is None:
        return cold_film(contact, speeds, load, cells)
    from bem.lubrication.thermal.lumped_point import thinning, with_heat  # heat's modules only where there is heat

    known = {} if thinnings is None else thinnings
    place = round(math.log(load) / math.log(THINNED))
    inlet, oil = _inlet(contact, speeds, load), contact.lubricant
    if place not in known:
        at = THINNED**place

        def central(lubricant: Lubricant) -> float:
            flooded = replace(_of_oil(contact, lubricant), supply=None)
            film = cold_film(flooded, speeds, at, min(cells, BALANCE_CELLS))
            return film.central_thickness if film.status is Status.CONVERGED else math.nan

        known[place] = thinning(oil, _inlet(contact, speeds, at), central, _fitted_exponent(contact, speeds, at))
    film = cold_film(_of_oil(contact, known[place].oil(oil, inlet)), speeds, load, cells)
    dry = ellipse_contact(radii=contact.radii, contact_modulus=contact.film_modulus(load), load=load)
    return with_heat(film, oil, contact.heat.bodies, dry.semi_axes, inlet, known[place].missed)


def _of_oil(contact: PointContact, lubricant: Lubricant) -> PointContact:
    """With another oil, without heat."""
    return replace(contact, lubricant=lubricant, heat=None)


def _inlet(contact: PointContact, speeds: Sequence[float], load: float) -> InletHeating:
    """Of line contacts, with the ellipse's Hertz pressure."""
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
    """Of the fitted film in the viscosity."""
    oil, share = contact.lubricant, 0.9
    thinner = _of_oil(contact, replace(oil, viscosity=share * oil.viscosity))
    return math.log(_fitted_film(thinner, speeds, load) / _fitted_film(contact, speeds, load)) / math.log(share)


def cold_film(contact: PointContact, speeds: Sequence[float], load: float, cells: int) -> PointFilmSolution:
    """The film under a load [N] without heat: solved, or from one under a smaller load where none is found."""
    largest = min(load, largest_point_load(contact, speeds, cells))
    for share in _HEAVIER if _deep(contact, speeds, largest) else _TRIED:
        film = solved_point_film(contact, speeds, share * largest, cells)
        if film.status is Status.CONVERGED:
            break
    return film if share * largest == load else thin_film(film, contact, speeds, share * largest, load)


def _deep(contact: PointContact, speeds: Sequence[float], load: float) -> bool:
    """Whether a layer of oil is so thin that under a load [N] the film is the layer, but for compression."""
    if not isinstance(contact.supply, OilLayer):
        return False
    return _fitted_film(contact, speeds, load) > DEEP * contact.supply.thickness


def thin_film(
    film: PointFilmSolution, contact: PointContact, speeds: Sequence[float], solved: float, load: float
) -> PointFilmSolution:
    """A film under a load [N] from one solved under a smaller load: where films are so thin the bodies touch as dry
    ones do but for it. Pressure and dry gap go on as Hertz', what the film adds to that gap as its centre by the fit
    (`nijenbanning_film`). Against films solved on 128 cells (M 5800; 24 cases with L 4 to 15, Rx/Ry 0.3 and 1, p0 1.1
    to 2.5 GPa): the centre within 10 % at 2.5 to 20 times the load; the mean by pressure, whose inlet stays as wide, 5
    to 12 % too thick at 2.5, 9 to 40 % at 6, 20 to 230 % at 20 times; sliding friction within 13 %; the minimum up to
    20 times too thick. Of a layer of oil far thinner than a flooded film the film stays as it is, also under smaller
    loads.
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
    """Central film by the fit [m]."""
    oil, modulus = contact.lubricant, contact.film_modulus(load)
    scales = point_scales(load, contact.radii, modulus, abs(sum(speeds)), oil.viscosity)
    return scales.film * nijenbanning_film(scales.load, oil.pressure_viscosity * scales.pressure, scales.ratio)


@dataclass(frozen=True, eq=False)
class _Kept:
    """A film, and its size."""

    film: PointFilmSolution

    @property
    def nbytes(self) -> int:
        return sum(value.nbytes for value in vars(self.film).values() if isinstance(value, np.ndarray))

    def own(self) -> PointFilmSolution:
        """The film with arrays of its own: a caller may write into them."""
        arrays: dict[str, Any] = {
            name: value.copy() for name, value in vars(self.film).items() if isinstance(value, np.ndarray)
        }
        return replace(self.film, **arrays)


KEPT = KeptValues(1 << 26)
"""Films of this process: a film begins from the dry contact whatever was before it, so one asked for again is the same.
Under loads beyond the largest all trials of a balance go on from one film; error bars ask for it, too."""


def solved_point_film(contact: PointContact, speeds: Sequence[float], load: float, cells: int) -> PointFilmSolution:
    """The film under a load [N] up to the largest, without the solver's state; of rigid bodies where the load is so
    small that the elastic film is outside its range. What its error is a balance finds by itself. Solved once."""
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
    """A solved film at the abscissae (nx,), (ny,) [m] of a patch.

    Deflection is interpolated by cubics, pressure and stress linearly. Beyond the film's grid there is no pressure, and
    the bodies are deflected as by the load at a point, from where the grid ends.
    """
    inside_x, inside_y = np.clip(x, film.x[0], film.x[-1]), np.clip(y, film.y[0], film.y[-1])
    deflection = _interpolated(film, film.thickness - contact.parabola(film.x, film.y), inside_x, inside_y, 3)
    distance, begins = (np.hypot(a[:, None], b[None, :]) for a, b in ((x, y), (inside_x, inside_y)))
    beyond = distance > begins
    at_a_point = load / (math.pi * contact.film_modulus(load))
    deflection[beyond] += at_a_point * (1 / distance[beyond] - 1 / begins[beyond])
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
