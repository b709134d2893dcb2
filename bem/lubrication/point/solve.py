"""Steady elastohydrodynamic film of circular and elliptical contacts, from rigid and isoviscous to heavily loaded."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from bem.arguments import is_finite, is_positive
from bem.errors import InputError, Status
from bem.lubrication.cavitation import Cavitation, cavitation_of
from bem.lubrication.checks import check_oil
from bem.lubrication.flow_factors import WallFactors, notes_on_factors, plane_walls_of
from bem.lubrication.lubricant import Lubricant
from bem.lubrication.point.cascade import Reached, solved
from bem.lubrication.point.film import PointFilmSolution
from bem.lubrication.point.kept import KeptPoint, central_film, certificate, film_errors, film_fraction, least_film
from bem.lubrication.point.setting import Rectangle, Setting, setting_of
from bem.lubrication.point.starved import checked_layer, starvation, starved
from bem.lubrication.point.validity import notes_on_point
from bem.lubrication.supply import Starvation, Supply
from bem.materials import Body
from bem.plausibility import body_arguments, lubricant_arguments, notes_on_arguments
from bem.threads import one_blas_thread

MOES_LOADS = (1e-2, 1e5)
"""Loads M for which a film is looked for: below, the bodies are rigid."""
RATIOS = (1e-3, 1e3)
"""Ratios of radii Rx/Ry for which a film is looked for; beyond, a contact is a line contact."""
SHAPE = (256, 256)
SHORTEST, LONGEST = 32, 2048
"""Cells along an axis."""

Speeds = tuple[tuple[float, float], tuple[float, float]]


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
    """Steady film between an ellipsoid and a flat: Reynolds' equation with rupture and elastic deflection.

    Solves div[rho h^3/(12 mu) grad p] = (u1 + u2)/2 grad(rho h) with p = 0 and grad p = 0 where the film ruptures
    (Swift-Stieber), h = h0 + x^2/2Rx + y^2/2Ry + 1/(pi E*) integral p/|x - x'| and integral p = load, flooded from far
    upstream: on the outermost cells pressure is that of the gap of rigid paraboloids, which goes on outside the grid.

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
    supply : oil that reaches the contact, an `OilLayer` or the thickness of one [m], as thick everywhere; None is
        flooded. `PointFilmSolution.starvation` has where the gap begins to be full and by how much the film is thinner.
        Oil is kept account of everywhere then, with either cavitation. A layer as thick as the gap on the edge of the
        grid in the inlet floods the contact.

    Returns
    -------
    PointFilmSolution. `status` is `converged` only where what is recomputed from the result meets the tolerance, else
    `stalled` with the last iterate.

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
    pair = checked(load, radii, contact_modulus, speeds, lubricant, shape, tolerance, extent)
    model, cells = cavitation_of(cavitation), SHAPE if shape is None else (int(shape[0]), int(shape[1]))
    layer = checked_layer(supply, flow_factors, entrainment(pair))
    both = (bodies,) if isinstance(bodies, Body) else bodies
    setting = setting_of(
        float(load), (float(radii[0]), float(radii[1])), float(contact_modulus), entrainment(pair), lubricant,
        edges(extent), both, lambda unit: plane_walls_of(flow_factors, unit, pair),
    )  # fmt: skip
    check_load(setting, load)
    if not setting.scales.rigid:
        check_oil(lubricant, setting.scales.pressure)
    check_extent(setting, cells)
    along = (cells[1], cells[0]) if setting.frame.exchanged else cells
    flooded = reached = solved(setting.problem, along, tolerance, max_iterations)
    lacking = None
    if layer is not None:
        setting, reached = starved(setting, flooded, layer, tolerance, max_iterations, free=extent is None)
        lacking = starvation(setting, reached, flooded)
    asked = Request(pair, lubricant, tolerance, contact_modulus, model, starvation=lacking)
    film = result_of(setting, reached, asked)
    arguments = {
        "load": ("load", float(load)),
        "radii": ("radius", tuple(float(one) for one in radii if math.isfinite(one))),
        "speeds": ("speed", (*pair[0], *pair[1])),
    }
    said = notes_on_arguments(arguments | lubricant_arguments(lubricant) | body_arguments(both))
    return replace(film, notes=said + film.notes + notes_on_factors(flow_factors, film.minimum_thickness))


@dataclass(frozen=True)
class Request:
    """What a result repeats of what was asked for; time [s] of one in time, which was `given` and not solved for; what
    its supply does to it."""

    speeds: Speeds
    lubricant: Lubricant
    tolerance: float
    contact_modulus: float
    cavitation: Cavitation = Cavitation.SWIFT_STIEBER
    time: float | None = None
    given: bool = False
    starvation: Starvation | None = None


def result_of(setting: Setting, reached: Reached, asked: Request) -> PointFilmSolution:
    """The result, judged by its pressure and H0 alone; a film that was given is taken as it is."""
    level, outcome, scales, frame = reached.level, reached.outcome, setting.scales, setting.frame
    state = outcome.state
    proof = certificate(level, state.pressure, state.datum)
    status = Status.CONVERGED
    if not (asked.given or max(proof.residual, proof.mass) <= asked.tolerance):
        status = Status.STALLED
    sound = np.isfinite(proof.mass)
    film = proof.film if sound else state.film
    central, least = central_film(level, film), least_film(film)
    errors: tuple[float | None, float | None] = (None, None)
    if reached.coarse is not None and status is Status.CONVERGED:
        coarse = reached.coarse
        rough = central_film(coarse[0], coarse[1].film), least_film(coarse[1].film)
        errors = film_errors((central, least), rough, film, setting)
    share = setting.problem.outside(state.datum)[0] / setting.problem.load
    full = None
    if asked.cavitation is Cavitation.MASS_CONSERVING:
        full = frame.outer(film_fraction(level, state.pressure, film) if sound else np.ones(level.shape))
    x, y = frame.axes(level.x * scales.length, level.y * scales.length)
    fields: dict[str, Any] = {
        "x": x,
        "y": y,
        "pressure": frame.outer(state.pressure) * scales.pressure,
        "thickness": frame.outer(film) * scales.film,
    }
    unforced = PointFilmSolution(
        **fields,
        central_thickness=central * scales.film,
        minimum_thickness=least * scales.film,
        central_thickness_error=None if errors[0] is None else errors[0] * scales.film,
        minimum_thickness_error=None if errors[1] is None else errors[1] * scales.film,
        load=proof.load * setting.problem.load * scales.pressure * scales.length**2,
        inlet_load_fraction=share,
        shear_force=np.zeros((2, 2)),
        rolling_force=np.zeros(2),
        iterations=outcome.steps,
        cycles=outcome.cycles,
        convolutions=reached.convolutions,
        residual=proof.residual,
        mass_imbalance=proof.mass,
        status=status,
        speeds=asked.speeds,
        lubricant=asked.lubricant,
        film_fraction=full,
        time=asked.time,
        starvation=asked.starvation,
        state=KeptPoint(setting, level, state),
    )
    forces, rolling = unforced.forces()
    film_ = replace(unforced, shear_force=forces, rolling_force=rolling)
    return replace(film_, notes=notes_on_point(film_, setting, level, asked.contact_modulus))


def entrainment(speeds: Speeds) -> tuple[float, float]:
    """Sum of both speeds along x and y [m/s]."""
    return speeds[0][0] + speeds[1][0], speeds[0][1] + speeds[1][1]


def edges(extent: Sequence[float] | None) -> Rectangle | None:
    """Of the grid [m], None where they are to be found."""
    if extent is None:
        return None
    x0, x1, y0, y1 = (float(v) for v in extent)
    return x0, x1, y0, y1


def check_load(setting: Setting, load: float) -> None:
    """Refuse loads for which there is no film to look for."""
    scales = setting.scales
    low, high = MOES_LOADS
    if not scales.rigid and not low <= scales.load <= high:
        advice = "Raise the load, or give contact_modulus=math.inf."
        if scales.load > high:
            advice = "The film cannot carry that: lower the load, or raise speed or viscosity."
        raise InputError(
            f"load: {load!r} N is {scales.load:.3g} in Moes' units of a point contact; a film is looked for between "
            f"{low:g} and {high:g}. {advice}"
        )
    if setting.hertz is None:
        return
    along, across = (half * scales.film / scales.length for half in setting.hertz.semi_axes)  # over the radius along
    larger = max(along, across * scales.ratio)
    if larger > 1:
        raise InputError(
            f"load: {load!r} N makes a contact {larger:.3g} times as large as the radius of the body: check the units "
            "of load, radii and contact_modulus [N, m, Pa]"
        )


def check_extent(setting: Setting, cells: tuple[int, int] | None = None) -> None:
    """Refuse grids without the contact, and cells larger than it and the film around it."""
    scales, frame = setting.scales, setting.frame
    x0, x1, y0, y1 = setting.problem.rectangle
    a, b = (0.0, 0.0) if setting.hertz is None else setting.hertz.semi_axes
    if not (x0 < -a and x1 > a and y0 < -b and y1 > b):
        size = " x ".join(f"{v * scales.length:.3g}" for v in frame.pair((a, b)))
        raise InputError(f"extent: must hold the contact, half-axes {size} m in x and y, with room for the inlet")
    if cells is None or setting.hertz is None:  # pressure of rigid bodies is far wider than their film
        return
    film, curvatures = setting.problem.typical_film, setting.problem.curvatures
    names = ("y", "x") if frame.exchanged else ("x", "y")
    for name, half, curvature, length, n in zip(
        names, (a, b), curvatures, (x1 - x0, y1 - y0), frame.pair(cells), strict=True
    ):
        room = half + math.sqrt(2 * film / curvature)
        if length / n > room:
            raise InputError(
                f"extent: cells of {length / n * scales.length:.3g} m along {name} are larger than the contact and the "
                f"film around it, {room * scales.length:.3g} m; make the grid smaller, or leave extent out"
            )


def checked(
    load: float,
    radii: Sequence[float],
    contact_modulus: float,
    speeds: Any,
    lubricant: Lubricant,
    shape: Any,
    tolerance: float,
    extent: Any,
) -> Speeds:
    """Both speeds as vectors [m/s].

    Raises
    ------
    InputError : with a message for each mistake.
    """
    messages = []
    if not is_positive(load):
        messages.append(f"load: {load!r} must be positive and finite [N]")
    pair = numbers(radii, 2)
    if pair is None or not all(r > 0 for r in pair):
        messages.append(f"radii: {radii!r} must be two positive, finite radii (Rx, Ry) [m]")
    elif not RATIOS[0] <= pair[0] / pair[1] <= RATIOS[1]:
        messages.append(
            f"radii: Rx/Ry {pair[0] / pair[1]:.3g} must lie between {RATIOS[0]:g} and {RATIOS[1]:g}; beyond, a contact "
            "is a line contact (solve_line_film)"
        )
    if not is_positive(contact_modulus, finite=False):
        messages.append(f"contact_modulus: {contact_modulus!r} must be positive [Pa]; math.inf is rigid")
    both = vectors(speeds)
    if both is None:
        messages.append(
            f"speeds: {speeds!r} must be a pair (u1, u2) of finite speeds along x, or of vectors ((u1x, u1y), (u2x, "
            "u2y)) [m/s]"
        )
    elif math.hypot(*entrainment(both)) <= 1e-12 * sum(math.hypot(*v) for v in both):
        messages.append(
            f"speeds: {speeds!r} entrain no oil (their sum is zero), so no steady film exists; give a sum other than "
            "zero"
        )
    if not isinstance(lubricant, Lubricant):
        messages.append(f"lubricant: {type(lubricant).__name__} is not a Lubricant")
    elif lubricant.shears_film:
        messages.append(
            'lubricant: film_rheology "shear_law" is not there for point contacts; use "newtonian", with which the '
            "shear law acts on friction alone"
        )
    cells = SHAPE if shape is None else shape
    if numbers(cells, 2) is None or not all(float(n).is_integer() and SHORTEST <= n <= LONGEST for n in cells):
        messages.append(f"shape: {shape!r} must be two integers from {SHORTEST} to {LONGEST}")
    if not (is_finite(tolerance) and 1e-11 <= tolerance <= 1e-2):
        messages.append(f"tolerance: {tolerance!r} must lie between 1e-11 and 1e-2")
    edges = (-1, 1, -1, 1) if extent is None else numbers(extent, 4)
    if edges is None or not (edges[0] < 0 < edges[1] and edges[2] < 0 < edges[3]):
        messages.append(f"extent: {extent!r} must be (x0, x1, y0, y1) around the origin [m]")
    if messages:
        raise InputError(messages)
    assert both is not None
    return both


def numbers(values: Any, count: int) -> tuple[float, ...] | None:
    """So many finite numbers; None where they are not."""
    try:
        listed = tuple(values)
    except TypeError:
        return None
    good = len(listed) == count and all(is_finite(v) for v in listed)
    return tuple(float(v) for v in listed) if good else None


def vectors(speeds: Any) -> Speeds | None:
    """Speeds as vectors; None where they are not."""
    plain = numbers(speeds, 2)
    if plain is not None:
        return (plain[0], 0.0), (plain[1], 0.0)
    try:
        found = [numbers(one, 2) for one in speeds]
    except TypeError:
        return None
    if len(found) != 2 or found[0] is None or found[1] is None:
        return None
    return (found[0][0], found[0][1]), (found[1][0], found[1][1])
