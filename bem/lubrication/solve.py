"""Public function of steady line films, and the one place that chooses between no heat, lumped and full heat.

1. `solve_line_film` checks the arguments and adds notes on unusual values.
2. `solve_case` solves the film: without heat `line.steady.line_film`; with heat `thermal.lumped` or `thermal.full`,
   which are imported only then, and which refuse what they do not solve.

Verified in tests/lubrication/test_line_film_steady.py, test_thermal_film.py and test_full_thermal.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from bem.errors import InputError
from bem.grid import FloatArray
from bem.lubrication.cavitation import Cavitation, cavitation_of
from bem.lubrication.flow_factors import WallFactors
from bem.lubrication.line.case import LineCase
from bem.lubrication.line.state import without_factors
from bem.lubrication.line.steady import line_film
from bem.lubrication.lubricant import Lubricant
from bem.lubrication.results import FilmSolution
from bem.lubrication.supply import Supply, checked_supply
from bem.lubrication.thermal.model import HEAT, FilmHeat
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
    """Solve the steady film between a cylinder and a flat: Reynolds' equation, cavitation and elastic deflection.

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
    points : nodes of the graded mesh.
    tolerance : largest residual, relative to the local film (and to the load).
    position : ascending abscissae [m] at which to return pressure and thickness; the mesh itself by default.
    initial : solution of a similar case, a warm start: film and mesh, with full heat temperatures too.
    max_iterations : Newton steps of one solve.
    cavitation : a `Cavitation` or its name; `Cavitation.MASS_CONSERVING` also returns the filled fraction of the gap
        behind the exit, `film_fraction`. Pressure and thickness are the same as with SWIFT_STIEBER: with a flooded
        inlet both rupture where p = dp/dx = 0, and behind a cylinder the gap only opens, so no film forms again. In
        time (`march_line_film`) the two differ.
    flow_factors : "off", or a table of `bem.flow_factors`: pressure flow is then phi_x times, Couette flow h + k s
        phi_s (`bem.lubrication.flow_factors`). The shear stress is that of smooth walls.
    supply : oil that reaches the contact, an `OilLayer` or an `InletDistance` (`bem.lubrication.supply`), or the
        thickness of a layer [m]; None is flooded. `FilmSolution.starvation` has the meniscus, the oil that
        passes, and the reduction of the film. Upstream of the meniscus there is no pressure and no
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
    heat = None if thermal == "off" else FilmHeat(thermal, bodies or (), bulk=bulk)
    film = without_factors(solve_case(case, heat, position=position, cavitation=cavitation, supply=supply))
    return replace(film, notes=said + film.notes)


def solve_case(
    case: LineCase,
    heat: FilmHeat | None = None,
    *,
    position: FloatArray | None = None,
    cavitation: Cavitation = Cavitation.SWIFT_STIEBER,
    supply: Supply | None = None,
) -> FilmSolution:
    """Solve the steady film of a case, with the model of heat that is asked for.

    Without heat the result keeps its factored equations, for the next similar film.

    Raises
    ------
    InputError : as `solve_line_film`; with heat, an unknown model, no bodies, or options that heat excludes.
    """
    if heat is None:
        return line_film(case, position=position, cavitation=cavitation, supply=supply)
    case.scaled(position)
    unheated = {
        "position": position is not None,
        "supply": supply is not None and heat.model == "full",
        "mass-conserving cavitation": cavitation is not Cavitation.SWIFT_STIEBER,
    }
    messages = []
    if heat.model not in HEAT:
        allowed = ", ".join(f'"{name}"' for name in ("off", *HEAT))
        messages.append(f"solve_line_film: thermal {heat.model!r} is not there; allowed: {allowed}")
    if not heat.bodies:
        messages.append("solve_line_film: with heat, bodies (flat, cylinder) with heat constants must be given")
    messages += [f"solve_line_film: {name} cannot be given with heat" for name, given in unheated.items() if given]
    if messages:
        raise InputError(messages)
    from bem.lubrication.thermal import full, lumped

    if heat.model == "full":
        sizes = round(heat.mesh * full.COLUMNS), round(heat.mesh * full.LAYERS)
        return full.full_thermal_film(case, heat.bodies, heat.bulk, *sizes).as_film()
    cells = round(heat.mesh * lumped.CELLS)
    return lumped.thermal_film(case, heat.bodies, heat.bulk, cells, supply).as_film()


def _notes_on_arguments(
    case: LineCase, bodies: Sequence[Body] | None, bulk: Sequence[float] | None
) -> tuple[Note, ...]:
    """Return notes on arguments outside their usual ranges; raise InputError for invalid arguments."""
    case.scaled()
    arguments = {
        "load": ("load per unit length", case.load),
        "radius": ("radius", case.radius),
        "speeds": ("speed", tuple(case.speeds)),
        "bulk": ("temperature", None if bulk is None else tuple(bulk)),
    }
    return notes_on_arguments(arguments | lubricant_arguments(case.lubricant) | body_arguments(bodies))
