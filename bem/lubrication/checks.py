"""Checks of the validity of a film's model: each is a small function that returns a note or None.

To add a check, write a function of a `Case`, enter it in `CHECKS`, and its note in `bem.notes.lubrication`.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from bem.errors import InputError
from bem.grid import FloatArray
from bem.lubrication.inlet_heating import hertz_over_modulus, inlet_heating_factor
from bem.lubrication.lubricant import Lubricant
from bem.lubrication.shear import REFERENCE_TEMPERATURE, LimitedShear
from bem.notes import Level, Note
from bem.notes.lubrication import (
    FILM_MOLECULAR,
    FILM_NOT_FOUND,
    FILM_SPIKE,
    FILM_THICK,
    HEAT_LEFT_OUT,
    SET_THERMAL,
    SHEAR_BEYOND_MEASURED,
    SHEAR_LIMITED,
    VISCOSITY_EXTRAPOLATED,
)
from bem.physical_constants import ZERO_CELSIUS

LARGEST_SHEAR_COEFFICIENT = 0.12
"""Largest limiting shear stress over pressure that was measured; Hoglund and Jacobson (1986), Bair (2007)."""
LARGEST_AMBIENT_STRENGTH = 5e6
"""Largest shear strength at ambient pressure that was measured [Pa]; Hoglund and Jacobson (1986)."""
LOAD_AT_THE_LIMIT = 0.1
"""Share of the load over places at the limiting stress, above which the limit decides the friction."""
NEAR_THE_LIMIT = 0.89
"""Stress over limit from which a law that joins its limit smoothly is at it: its own stress is beyond the limit."""
SHARP_SPIKE = 0.7
"""Pressure of the node next to a spike over the pressure of the spike, below which the spike is not resolved: its
height then changes by 2 % to 30 % on finer meshes."""
LEAST_INLET_FACTOR = 0.9
"""Film with inlet heating over the film without, below which the heating is noted."""
LARGEST_HEATING = 10.0
"""Temperature rise [K] above which heating by sliding is noted: a mineral oil then has lost a third of its
viscosity."""
LARGEST_MATERIAL = 200.0
"""Largest Moes number L that is accepted: eight times that of the stiffest oils between hard bodies at speed."""
GLASS = 1e12
"""Viscosity of a glass [Pa s]; C. A. Angell, *Science* 267 (1995) 1924."""
LARGEST_FILM = 0.02
"""Film over radius up to which the model holds: the gap where pressure begins, 15 films, is then 0.77 of the radius
upstream."""
MOLECULAR_FILM = 1e-9
"""Film of a few molecules [m]: below it oil is no continuum, and rough surfaces touch nearly everywhere (99 % of the
load at 0.6 and 0.8 nm)."""
THINNEST_FILM = 2e-9
"""Film [m] of four or five molecules; oil is layered below about 5 nm, D. Y. C. Chan and R. G. Horn, *J. Chem. Phys.*
83 (1985) 5311."""
_PRESSURE = 1e9
"""Pressure at which the slope of a limit that rises linearly is taken [Pa]."""
OIL_CONDUCTIVITY = 0.13
"""Thermal conductivity of mineral oil [W/(m K)]."""
OIL_SOFTENING = 0.04
"""-d ln(viscosity)/dT of mineral oil [1/K]."""
STEEL_EFFUSIVITY = 1.3e4
"""Thermal effusivity sqrt(k rho c) of bearing steel [W s^0.5/(m^2 K)], with 46 W/(m K), 7850 kg/m^3 and 470 J/(kg
K)."""


@dataclass(frozen=True)
class Case:
    """A film on its own mesh, as the checks need it.

    position, pressure, thickness : (n,) [m], [Pa], [m]. speeds : of flat and cylinder [m/s]. lubricant : the oil.
    radius : [m]. contact_modulus : [Pa], infinite for rigid bodies. reduction : of the film by its supply.
    hot_stress : mu (u1 - u2)/h at the temperatures of a film with heat (n,) [Pa]; None without heat.
    temperature : of the oil in a film with heat, its mean weighted by pressure [K]; None without heat.
    not_found : note with the reason why the film was not found; None of a film that was found.
    """

    position: FloatArray
    pressure: FloatArray
    thickness: FloatArray
    speeds: tuple[float, float]
    lubricant: Lubricant
    radius: float
    contact_modulus: float
    reduction: float = 1.0
    hot_stress: FloatArray | None = None
    temperature: float | None = None
    not_found: Note | None = None

    @cached_property
    def newtonian_stress(self) -> FloatArray:
        """|mu (u1 - u2) / h| in the full film [Pa]."""
        if self.hot_stress is not None:
            return np.where(self.pressure > 0, np.abs(self.hot_stress), 0.0)
        viscosity = self.lubricant.viscosity_at(self.pressure)
        stress = viscosity * abs(self.speeds[0] - self.speeds[1]) / self.thickness
        return np.where(self.pressure > 0, stress, 0.0)

    @cached_property
    def limiting_stress(self) -> FloatArray:
        """Limiting stress at the temperature at which `newtonian_stress` is [Pa]."""
        temperature = None if self.hot_stress is None else self.temperature
        return np.broadcast_to(self.lubricant.limiting_stress(self.pressure, temperature), self.pressure.shape)

    @cached_property
    def sliding_stress(self) -> FloatArray:
        """Stress of the shear law at `newtonian_stress` [Pa]; with heat the stress there, up to the limit: beside the
        middle of a film pressure shears it, too."""
        if self.hot_stress is not None:
            return np.minimum(self.newtonian_stress, self.limiting_stress)
        return self.lubricant.shear_stress(self.newtonian_stress, self.pressure)

    def integral(self, values: FloatArray) -> float:
        """Return the integral over x of values at the nodes."""
        return float(np.trapezoid(values, self.position))


def film_not_found(case: Case) -> Note | None:
    """Return the note on a film that was not found; the other checks then see its last iterate."""
    return case.not_found


def why_not_found(oil: Lubricant, hertz: float, otherwise: Note) -> Note:
    """Return the reason why no film was found, by oil and Hertz pressure [Pa], infinite for rigid bodies; else
    `otherwise`."""
    if math.isinf(hertz) and oil.log_viscosity_ratio(np.zeros(1))[1][0] > 0:
        return FILM_NOT_FOUND(reason="rigid-spike")
    if math.isfinite(hertz) and oil.viscosity_at(np.array([hertz]))[0] > GLASS:
        return FILM_NOT_FOUND(reason="glass", hertz=float(hertz), glass=GLASS)
    return otherwise


def why_no_line_film(oil: Lubricant, load: float, radius: float, contact_modulus: float) -> Note:
    """Return the reason why no line film was found: load per unit length [N/m], radius [m], modulus [Pa]."""
    hertz = math.inf
    if math.isfinite(contact_modulus):
        hertz = contact_modulus * hertz_over_modulus(load, radius, contact_modulus)
    return why_not_found(oil, hertz, FILM_NOT_FOUND(reason="line"))


def shear_beyond_measurements(case: Case) -> Note | None:
    """Return a note if the shear stress exceeds every measured strength."""
    if (case.sliding_stress <= LARGEST_AMBIENT_STRENGTH + LARGEST_SHEAR_COEFFICIENT * case.pressure).all():
        return None
    return SHEAR_BEYOND_MEASURED(
        law=case.lubricant.shear_law.name, strength=LARGEST_AMBIENT_STRENGTH, slope=LARGEST_SHEAR_COEFFICIENT
    )


def shear_at_the_limit(case: Case) -> Note | None:
    """Return a note if the limiting stress decides the friction."""
    law = case.lubricant.shear_law
    if law.joins_limit_smoothly:
        stress = law.under_limit(law.unlimited(case.newtonian_stress), case.limiting_stress)
        cut = stress > NEAR_THE_LIMIT * case.limiting_stress
    else:
        cut = case.sliding_stress < case.lubricant.shear_stress(case.newtonian_stress)
    if _load_share(case, cut) < LOAD_AT_THE_LIMIT:
        return None
    return friction_limited(case.lubricant, case.temperature)


def friction_limited(oil: Lubricant, temperature: float | None) -> Note:
    """Return the note that the limiting stress sets the friction, with the limit in a film of an oil at a mean
    temperature [K]; None for that of the oil."""
    law = oil.shear_law
    if not isinstance(law, LimitedShear):
        return SHEAR_LIMITED(reason="friction-own-law")
    at = oil.temperature if temperature is None else temperature
    strength, more = (float(law.limit_at(pressure, at)) for pressure in (0.0, _PRESSURE))
    slope = (more - strength) / _PRESSURE
    if not law.limit_falls_with_temperature:
        return SHEAR_LIMITED(strength=strength, slope=slope, reason="friction")
    celsius = (REFERENCE_TEMPERATURE if at is None else at) - ZERO_CELSIUS
    return SHEAR_LIMITED(strength=strength, slope=slope, celsius=celsius, reason="friction-warm")


def film_slips(case: Case) -> Note | None:
    """Return a note if the oil slips at the limiting stress, where the film depends on the unknown place of the
    slip."""
    if not case.lubricant.shears_film or abs(case.speeds[0] - case.speeds[1]) <= abs(sum(case.speeds)) / 2:
        return None
    if shear_at_the_limit(case) is None:
        return None
    return SHEAR_LIMITED(reason="film")


def _load_share(case: Case, where: NDArray[np.bool_]) -> float:
    """Return the share of the load over marked places, shaped like the pressure."""
    return float(case.integral(np.where(where, case.pressure, 0.0)) / max(case.integral(case.pressure), 1e-300))


_ROLLS = 1e-9
"""Difference of both speeds over their sum up to which a contact rolls without sliding."""


def viscosity_beyond_range(case: Case) -> Note | None:
    """Return a note if the viscosity law is used beyond its pressures.

    Between elastic bodies this counts above 10 % of the load; a spike holds up to 5 % of it at many times the Hertz
    pressure, as high as the mesh makes it. There it changes sliding friction alone, so none is returned in pure
    rolling.
    """
    oil, largest = case.lubricant, case.lubricant.viscosity_law.described.largest_pressure
    beyond = case.pressure > largest
    spike = math.isfinite(case.contact_modulus) and _load_share(case, beyond) < LOAD_AT_THE_LIMIT
    if spike or not beyond.any():
        highest = case.pressure[~beyond].max(initial=0.0)
        return _glass(oil) if case.not_found is None and oil.viscosity_at(np.array([highest]))[0] > GLASS else None
    reason = "rigid" if math.isinf(case.contact_modulus) else "elastic"
    if reason == "elastic" and abs(case.speeds[0] - case.speeds[1]) <= _ROLLS * abs(sum(case.speeds)):
        return None
    level = Level.CAUTION if reason == "rigid" else None
    name = oil.viscosity_law.described.name
    factors = law_factors(estimated=_is_estimated(oil)) if name == "roelands" else ""
    return VISCOSITY_EXTRAPOLATED(level=level, reason=reason, limit=float(largest), law=name, factors=factors)


def law_factors(*, estimated: bool) -> str:
    """Return in words how far Roelands' law is from measured viscosities at 1 GPa.

    estimated : whether the pressure-viscosity coefficient is that of a correlation. The numbers are those of
        tests/reports/test_friction_report.py, of three oils that Mann (1995) measured.
    """
    known = "an estimated pressure-viscosity coefficient, as of this oil" if estimated else "a measured coefficient"
    factors = "0.001 to 6" if estimated else "0.001 to 1.3"
    return f": at 1 GPa Roelands' law with {known} gave {factors} times the viscosity measured on three oils"


def _is_estimated(oil: Lubricant) -> bool:
    """Return True if the pressure-viscosity coefficient is that of a correlation of the catalogue."""
    source = oil.oil
    if source is None or oil.temperature is None or source.pressure_viscosity is None:
        return False
    estimate = source.pressure_coefficient(oil.temperature)
    return source.pressure_viscosity.name != "given" and math.isclose(oil.pressure_viscosity, estimate, rel_tol=1e-6)


def _glass(oil: Lubricant) -> Note:
    return VISCOSITY_EXTRAPOLATED(law=oil.viscosity_law.described.name, glass=GLASS, reason="glass")


def check_oil(lubricant: Lubricant, unit: float) -> None:
    """Refuse an oil that hardly flows under pressure. unit : Moes' unit of pressure [Pa].

    Raises
    ------
    InputError : a slope of ln(viscosity) with pressure of more than `LARGEST_MATERIAL` of these units.
    """
    slope = float(lubricant.log_viscosity_ratio(np.zeros(1))[1][0])
    if slope * unit > LARGEST_MATERIAL:
        raise InputError(
            f"lubricant: pressure_viscosity {slope!r} 1/Pa is L = {slope * unit:.3g} in Moes' units of this contact; "
            f"oils have 0 to 25, and up to {LARGEST_MATERIAL:g} a film is looked for; check the units: 20 1/GPa are "
            "20e-9"
        )


def spike_unresolved(case: Case) -> Note | None:
    """Return a note if the mesh decides the height of the pressure spike."""
    p = case.pressure
    inner = p[1:-1]
    peaks = (inner > p[:-2]) & (inner >= p[2:]) & (inner > 0.2 * p.max(initial=0.0))
    if not (np.minimum(p[:-2], p[2:])[peaks] < SHARP_SPIKE * inner[peaks]).any():
        return None
    incompressible = case.lubricant.density_law.name == "incompressible"
    return FILM_SPIKE(remedy='; density_law = "dowson_higginson" blunts the spike' if incompressible else "")


def inlet_heating(case: Case) -> Note | None:
    """Return a note if shear in the inlet heats the oil and thins the film.

    By the factor of `bem.lubrication.inlet_heating`, for a mineral oil. A film that is starved by more than that factor
    is as thick as the oil that arrives, hot or not.
    """
    load = max(case.integral(case.pressure), 0.0)
    hertz = hertz_over_modulus(load, case.radius, case.contact_modulus)
    heating = inlet_heating_factor(case.lubricant.viscosity, OIL_SOFTENING, OIL_CONDUCTIVITY, case.speeds, hertz)
    if heating.factor >= LEAST_INLET_FACTOR * case.reduction:
        return None
    return HEAT_LEFT_OUT(factor=1 / heating.factor, reason="inlet", remedy=SET_THERMAL)


def film_heating(case: Case) -> Note | None:
    """Return a note if sliding heats film and surfaces.

    Two estimates are added: q/8 h/k across the film, for even heat q that leaves through both surfaces (A. W. Crook,
    *Phil. Trans. A* 254 (1961) 237), and 2 q sqrt(l/pi) / (e (sqrt(u1) + sqrt(u2))) at the end of the heated length l
    of two surfaces of effusivity e and equal temperature (Jaeger 1942), with the mean of q over the loaded length.
    """
    loaded = case.pressure > 0.05 * case.pressure.max(initial=0.0)
    if not loaded.any() or case.pressure.max() == 0:
        return None
    length = float(np.ptp(case.position[loaded]))
    root = math.sqrt(abs(case.speeds[0])) + math.sqrt(abs(case.speeds[1]))
    if length == 0 or root == 0:
        return None
    heat = case.integral(np.where(loaded, case.sliding_stress, 0.0)) / length * abs(case.speeds[0] - case.speeds[1])
    film = heat * float(np.median(case.thickness[loaded])) / (8 * OIL_CONDUCTIVITY)
    flash = 2 * heat * math.sqrt(length / math.pi) / (STEEL_EFFUSIVITY * root)
    if film + flash <= LARGEST_HEATING:
        return None
    return HEAT_LEFT_OUT(limit=LARGEST_HEATING, rise=film + flash, reason="sliding", remedy=SET_THERMAL)


def molecular_film(case: Case) -> Note | None:
    """Return a note if the film is a few molecules thick."""
    if case.thickness.min() >= THINNEST_FILM:
        return None
    return FILM_MOLECULAR(limit=THINNEST_FILM)


def film_thick_for_radius(case: Case) -> Note | None:
    """Return a note if the film is too thick for a parabola and for Reynolds' equation: slopes in the inlet approach
    one."""
    if case.not_found is not None or not case.thickness.min() > LARGEST_FILM * case.radius:
        return None
    return FILM_THICK(limit=LARGEST_FILM)


CHECKS: list[Callable[[Case], Note | None]] = [
    film_not_found,
    film_thick_for_radius,
    shear_beyond_measurements,
    shear_at_the_limit,
    film_slips,
    viscosity_beyond_range,
    spike_unresolved,
    inlet_heating,
    film_heating,
    molecular_film,
]


def notes_on(case: Case) -> tuple[Note, ...]:
    """Return the notes on a film, in the order of the checks."""
    return case.lubricant.notes + tuple(note for check in CHECKS if (note := check(case)) is not None)
