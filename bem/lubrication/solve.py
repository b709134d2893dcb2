"""Steady film of a line contact, without heat or with it: the public function, which chooses the solver."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from bem.grid import FloatArray
from bem.lubrication.cavitation import Cavitation, cavitation_of
from bem.lubrication.flow_factors import WallFactors
from bem.lubrication.line.case import LineCase
from bem.lubrication.line.state import without_equations
from bem.lubrication.line.steady import line_film
from bem.lubrication.lubricant import Lubricant
from bem.lubrication.results import FilmSolution
from bem.lubrication.supply import Supply, checked_supply
from bem.lubrication.thermal.model import FilmHeat, film_with_heat
from bem.materials import Body
from bem.notes import Note
from bem.plausibility import body_arguments, lubricant_arguments, notes_on_arguments


def solve_line_film(
    *,
    load: float,
    radius: float,
    contact_modulus: float,
    speeds: Sequence[float],
    lubricant: Lubricant,
    points: int = 2000,
    tolerance: float = 1e-8,
    position: FloatArray | None = None,
    initial: FilmSolution | None = None,
    max_iterations: int = 40,
    cavitation: Cavitation | str = Cavitation.SWIFT_STIEBER,
    flow_factors: WallFactors | str = "off",
    supply: Supply | float | None = None,
    thermal: str = "off",
    bodies: Sequence[Body] | None = None,
    bulk: Sequence[float] | None = None,
) -> FilmSolution:
    """Steady film between a cylinder and a flat: Reynolds' equation with cavitation and elastic deflection.

    Solves d/dx[rho h^3/(12 mu) dp/dx] = (u1 + u2)/2 d(rho h)/dx with p = dp/dx = 0 at the free exit (Swift-Stieber),
    h = h0 + x^2/2R - 2/(pi E*) integral p ln|x - x'| dx' and integral p dx = load, flooded from far upstream.

    Parameters
    ----------
    load : per unit length [N/m].
    radius : of the cylinder (or reduced radius) [m].
    contact_modulus : E* of the pair [Pa]; math.inf for rigid bodies.
    speeds : (u1, u2) of the flat (below) and the cylinder (above) [m/s]; their sum, positive or negative, must not
        be zero.
    lubricant : the oil.
    points : nodes of the graded mesh that the equations are solved on.
    tolerance : largest residual, relative to the local film (and to the load).
    position : ascending abscissae [m] at which to return pressure and thickness; the mesh itself by default.
    initial : an earlier solution of a similar case: its film and mesh are the start, and with full heat its
        temperatures.
    max_iterations : Newton steps of one solve.
    cavitation : a `Cavitation` or its name; `Cavitation.MASS_CONSERVING` also says how full the gap is behind the
        exit, `film_fraction`. Pressure and thickness are the same as with SWIFT_STIEBER: with a flooded inlet both
        rupture where p = dp/dx = 0, and behind a cylinder the gap only opens, so no film forms again.
        In time (`march_line_film`) the two differ.
    flow_factors : "off", or a table of `bem.flow_factors`: pressure flow is then phi_x times, Couette flow h + k s
        phi_s (`bem.lubrication.flow_factors`). Shear stress and what is behind the exit stay those of smooth walls.
    supply : oil that reaches the contact, an `OilLayer` or an `InletDistance` (`bem.lubrication.supply`), or the
        thickness of a layer [m]; None is flooded. `FilmSolution.starvation` has the meniscus, the oil that goes
        through, and how much thinner the film is than flooded. Upstream of the meniscus there is no pressure and no
        friction.
    thermal : "off"; "lumped": inlet shear heating and the oil's mean temperature, see `solve_thermal_line_film`; or
        "full": the temperature along and across the film, see `solve_full_thermal_line_film`. Friction and temperatures
        of the result are then those, and `heat` of it has the rest.
    bodies, bulk : with heat: flat and cylinder with their heat constants, and their temperatures far away [K].

    Returns
    -------
    FilmSolution. `status` is `converged`, or `stalled` with the last iterate, whose `load` may be another one.

    Raises
    ------
    InputError : a value out of range, no entrainment, a load far outside what a film can carry, or positions that
        do not reach the inlet (the message says how far they should).

    Notes
    -----
    Dowson and Higginson (1966); Moes, *Lubrication and beyond* (2000) for the similarity variables; Okamura (1982)
    and Houpert and Hamrock (1986) for Newton's method on the whole system. For incompressible oil above about
    L = 6 to 10 the pressure spike has no limit: it grows with the mesh as the inverse root of a cell, while the film
    thickness converges.
    """
    cavitation, supply = cavitation_of(cavitation), checked_supply(supply)
    case = LineCase(
        load, radius, contact_modulus, speeds, lubricant, points, tolerance, initial, max_iterations, flow_factors
    )
    said = _notes_on_arguments(case, bodies, bulk)
    if thermal == "off":
        film = without_equations(line_film(case, position=position, cavitation=cavitation, supply=supply))
        return replace(film, notes=said + film.notes)
    case.scaled(position)
    own = {"position": position is not None, "supply": supply is not None and thermal == "full"}
    own["mass-conserving cavitation"] = cavitation is not Cavitation.SWIFT_STIEBER
    film = film_with_heat(case, FilmHeat(thermal, bodies or (), bulk=bulk), supply, own)
    return replace(film, notes=said + film.notes)


def _notes_on_arguments(
    case: LineCase, bodies: Sequence[Body] | None, bulk: Sequence[float] | None
) -> tuple[Note, ...]:
    """Notes on arguments outside their usual ranges; InputError of those that are none."""
    case.scaled()
    arguments = {
        "load": ("load per unit length", case.load),
        "radius": ("radius", case.radius),
        "speeds": ("speed", tuple(case.speeds)),
        "bulk": ("temperature", None if bulk is None else tuple(bulk)),
    }
    return notes_on_arguments(arguments | lubricant_arguments(case.lubricant) | body_arguments(bodies))
