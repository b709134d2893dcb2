"""Steady elastohydrodynamic film of circular and elliptical contacts, from rigid and isoviscous to heavily loaded."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from bem.errors import Status
from bem.lubrication.cavitation import Cavitation, cavitation_of
from bem.lubrication.checks import check_oil
from bem.lubrication.flow_factors import WallFactors, notes_on_factors, plane_walls_of
from bem.lubrication.lubricant import Lubricant
from bem.lubrication.point.arguments import (
    Speeds,
    check_arguments,
    check_extent,
    check_load,
    checked_edges,
    entrainment,
)
from bem.lubrication.point.certificate import (
    SolvedPointCase,
    central_film,
    certify,
    film_errors,
    film_fraction,
    minimum_film,
)
from bem.lubrication.point.film import PointFilmSolution
from bem.lubrication.point.problem import ScaledCase, scale_case
from bem.lubrication.point.start import NestedSolution, solve_nested
from bem.lubrication.point.starved import solve_starved, starvation
from bem.lubrication.point.validity import notes_on_point
from bem.lubrication.supply import Starvation, Supply, checked_layer
from bem.materials import Body
from bem.plausibility import body_arguments, lubricant_arguments, notes_on_arguments
from bem.threads import one_blas_thread

SHAPE = (256, 256)
"""Cells by default."""


@one_blas_thread
def solve_point_film(
    *,
    load: float,
    radii: Sequence[float],
    contact_modulus: float,
    speeds: Sequence[float] | Sequence[Sequence[float]],
    lubricant: Lubricant,
    shape: tuple[int, int] | None = None,
    tolerance: float = 1e-8,
    extent: Sequence[float] | None = None,
    bodies: Body | Sequence[Body] | None = None,
    cavitation: Cavitation | str = Cavitation.SWIFT_STIEBER,
    max_iterations: int = 40,
    flow_factors: WallFactors | str = "off",
    supply: Supply | float | None = None,
) -> PointFilmSolution:
    """Solve the steady film between an ellipsoid and a flat: Reynolds' equation, cavitation, elastic deflection.

    Solves div[rho h^3/(12 mu) grad p] = (u1 + u2)/2 grad(rho h) with p = 0 and grad p = 0 where the film ruptures
    (Swift-Stieber), h = h0 + x^2/2Rx + y^2/2Ry + 1/(pi E*) integral p/|x - x'| and integral p = load, flooded from far
    upstream: outermost cells have the far pressure of rigid paraboloids, whose load outside the grid counts.

    Parameters
    ----------
    load : [N].
    radii : (Rx, Ry) of relative curvature [m], x along entrainment unless speeds are vectors.
    contact_modulus : E* of the pair [Pa]; math.inf for rigid bodies.
    speeds : (u1, u2) of the flat (below) and the ball (above) along x [m/s], or ((u1x, u1y), (u2x, u2y)); their sum,
        in any direction, must not be zero.
    lubricant : the oil; its shear law acts on friction.
    shape : (nx, ny) cells; 256 x 256 by default.
    tolerance : largest relative residual, see `PointFilmSolution.residual`.
    extent : (x0, x1, y0, y1), edges of the grid [m]; by default where the dry gap has opened to 30 films upstream, 10
        at the sides and 4 downstream.
    bodies : one Body or a pair, with their layers, in place of the half-spaces of E*, which then sets the units only.
    cavitation : a `Cavitation` or its name; MASS_CONSERVING also says how full the gap is behind the rupture. Pressure
        and film are the same: a flooded film of smooth surfaces does not form again.
    max_iterations : Newton steps from one start on one grid; up to four starts are tried.
    flow_factors : "off", or a table of `bem.flow_factors`: pressure flow phi_x h^3 along x and phi_y h^3 along y, and
        shear flow (u1 - u2)/2 s phi_s along x, along which both walls must move then. Far away they count as smooth.
    supply : oil that reaches the contact, an `OilLayer` or the thickness of one [m], equally thick everywhere; None is
        flooded. `PointFilmSolution.starvation` has the meniscus and the reduction of the film. Cavitation conserves
        mass then, whatever `cavitation` is. A layer as thick as the gap on the inlet edge of the grid floods the
        contact.

    Returns
    -------
    PointFilmSolution. `status` is `converged` only where the residuals recomputed from the result meet the tolerance,
    else `stalled` with the last iterate.

    Raises
    ------
    InputError : a value out of range, no entrainment, a load far outside what a film can carry, a grid that does not
        hold the contact, a supply that is a distance or comes with flow factors or at an angle.

    Notes
    -----
    Newton's method with primal-dual active sets, its equations by GMRES with multigrid cycles of line relaxation,
    distributive where the oil does not flow (Venner and Lubrecht, *Multilevel methods in lubrication*, 2000); starts
    from the dry contact lifted by the film of Nijenbanning, Venner and Moes (1994). Of second order.
    """
    pair = check_arguments(load, radii, contact_modulus, speeds, lubricant, shape, tolerance, extent)
    model, cells = cavitation_of(cavitation), SHAPE if shape is None else (int(shape[0]), int(shape[1]))
    layer = checked_layer(supply, flow_factors, entrainment(pair))
    both = (bodies,) if isinstance(bodies, Body) else bodies
    case = scale_case(
        float(load), (float(radii[0]), float(radii[1])), float(contact_modulus), entrainment(pair), lubricant,
        checked_edges(extent), both, lambda unit: plane_walls_of(flow_factors, unit, pair),
    )  # fmt: skip
    check_load(case, load)
    if not case.scales.rigid:
        check_oil(lubricant, case.scales.pressure)
    check_extent(case, cells)
    along = (cells[1], cells[0]) if case.axes.exchanged else cells
    flooded = nested = solve_nested(case.problem, along, tolerance, max_iterations)
    starved = None
    if layer is not None:
        case, nested = solve_starved(case, flooded, layer, tolerance, max_iterations, free=extent is None)
        starved = starvation(case, nested, flooded)
    film = point_film_solution(
        case, nested, FilmRequest(pair, lubricant, tolerance, contact_modulus, model, starvation=starved)
    )
    arguments = {
        "load": ("load", float(load)),
        "radii": ("radius", tuple(float(one) for one in radii if math.isfinite(one))),
        "speeds": ("speed", (*pair[0], *pair[1])),
    }
    notes = notes_on_arguments(arguments | lubricant_arguments(lubricant) | body_arguments(both))
    return replace(film, notes=notes + film.notes + notes_on_factors(flow_factors, film.minimum_thickness))


@dataclass(frozen=True)
class FilmRequest:
    """Arguments of a solve that its result repeats or is judged by.

    speeds, lubricant, tolerance, contact_modulus, cavitation : of `solve_point_film`.
    time : of a film in time [s].
    given : whether the film is an initial film and not solved for: it is taken as it is.
    starvation : of a starved film.
    """

    speeds: Speeds
    lubricant: Lubricant
    tolerance: float
    contact_modulus: float
    cavitation: Cavitation = Cavitation.SWIFT_STIEBER
    time: float | None = None
    given: bool = False
    starvation: Starvation | None = None


def point_film_solution(case: ScaledCase, nested: NestedSolution, request: FilmRequest) -> PointFilmSolution:
    """Return the result in SI units on the user's axes, judged by its certificate."""
    level, outcome, scales, axes = nested.level, nested.outcome, case.scales, case.axes
    state = outcome.state
    proof = certify(level, state)
    converged = request.given or proof.meets(request.tolerance)
    has_residual = bool(np.isfinite(proof.mass))
    film = proof.film if has_residual else state.film
    central, minimum = central_film(level, film), minimum_film(film)
    if case.problem.least_film is not None and proof.contact.any():
        minimum = max(minimum, case.problem.least_film)  # films in contact are no paraboloid
    errors: tuple[float | None, float | None] = (None, None)
    if nested.coarse is not None and converged:
        coarse_level, coarse = nested.coarse
        coarse_films = central_film(coarse_level, coarse.film), minimum_film(coarse.film)
        errors = film_errors((central, minimum), coarse_films, film, case)
    outside = case.problem.outside_load(state.separation)[0] / case.problem.load
    fraction = None
    if request.cavitation is Cavitation.MASS_CONSERVING:
        fraction = film_fraction(level, state.oil_pressure, film) if has_residual else np.ones(level.shape)
    touching = case.problem.least_film is not None
    contact = float((state.pressure - state.oil_pressure).sum()) * level.cell_area
    force = scales.pressure * scales.length**2
    x, y = axes.coordinates_to_user(level.x * scales.length, level.y * scales.length)
    without_forces = PointFilmSolution(
        x=x,
        y=y,
        pressure=axes.to_user(state.pressure) * scales.pressure,
        thickness=axes.to_user(film) * scales.film,
        central_thickness=central * scales.film,
        minimum_thickness=minimum * scales.film,
        central_thickness_error=None if errors[0] is None else errors[0] * scales.film,
        minimum_thickness_error=None if errors[1] is None else errors[1] * scales.film,
        load=proof.load * case.problem.load * scales.pressure * scales.length**2,
        inlet_load_fraction=outside,
        shear_force=np.zeros((2, 2)),
        rolling_force=np.zeros(2),
        iterations=outcome.steps,
        cycles=outcome.cycles,
        convolutions=nested.convolutions,
        residual=proof.residual,
        mass_imbalance=proof.mass,
        status=Status.CONVERGED if converged else Status.STALLED,
        speeds=request.speeds,
        lubricant=request.lubricant,
        film_fraction=None if fraction is None else axes.to_user(fraction),
        time=request.time,
        starvation=request.starvation,
        oil_pressure=axes.to_user(state.oil_pressure) * scales.pressure if touching else None,
        contact_load=contact * force if touching else None,
        state=SolvedPointCase(case, level, state),
    )
    forces, rolling = without_forces.forces()
    result = replace(without_forces, shear_force=forces, rolling_force=rolling)
    return replace(result, notes=notes_on_point(result, case, level, request.contact_modulus))
