"""Steady film of a point contact with roughness in Reynolds' equation itself, and contact where the film would vanish.

One of the bodies is rough and at rest, the other one is smooth and moves over it. The equations are those of `newton`
with a least film. The film is solved on the grid asked for at once (`start.solve_with_contact`), and on half as many
cells a side for the error of the contact's share of the load.

Cost: 10 to 60 Newton steps of 10 to 20 cycles. Verified in tests/lubrication/point/test_rough_film.py: without speed
against `bem.contact`, without contact against `solve_point_film` and `march_point_film`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from bem.arguments import is_positive
from bem.errors import InputError, Status
from bem.grid import FloatArray
from bem.lubrication.cavitation import Cavitation, cavitation_of
from bem.lubrication.checks import MOLECULAR_FILM
from bem.lubrication.lubricant import Lubricant
from bem.lubrication.point.arguments import Speeds, check_arguments, check_extent, checked_edges, entrainment
from bem.lubrication.point.certificate import Certificate, certify, swift_stieber_fraction
from bem.lubrication.point.grid import GridLevel
from bem.lubrication.point.linear_system import BoolArray
from bem.lubrication.point.moving_surfaces import Heights
from bem.lubrication.point.newton import CONTACT_TOLERANCE, NewtonOutcome, PointFilmState
from bem.lubrication.point.problem import Rectangle, ScaledCase, default_rectangle, scale_case
from bem.lubrication.point.start import solve_with_contact
from bem.lubrication.point.validity import coarse_heights
from bem.materials import Body
from bem.notes import Note
from bem.notes.accuracy import NoBar, no_error_bar
from bem.notes.lubrication import FILM_NOT_FOUND, OIL_CREATED
from bem.representation import readable
from bem.threads import one_blas_thread

SHAPE = (128, 128)
"""Cells by default."""
LARGEST_CREATED_OIL = 0.01
"""Created oil over the throughput above which there is a note."""


@readable
@dataclass(frozen=True)
class RoughPointFilm:
    """Film between a rough body at rest and a smooth one that moves, and where they touch.

    Attributes
    ----------
    x, y : (nx,) and (ny,) centres of cells [m].
    pressure : (nx, ny) of oil and contact together [Pa].
    oil_pressure : (nx, ny), of the oil [Pa].
    thickness : (nx, ny) [m], the least film where surfaces touch.
    heights : (nx, ny) out of the rough body [m].
    touching : (nx, ny), where they touch.
    least_film : [m].
    approach_datum : H0 of the film [m].
    load : of oil and contact [N], the load outside the grid included.
    contact_load : carried by surfaces that touch [N].
    contact_share : contact_load over load.
    contact_share_error : difference to a grid of half as many cells a side; None where that grid has no film or was not
        asked for.
    contact_area : of cells that touch [m^2], of first order in the cells.
    mean_thickness : mean weighted by pressure [m].
    minimum_thickness : of the lowest cell [m].
    oil_friction : sliding force of the oil outside contact over the load.
    oil_on_contact : sliding force of the oil in contact over the load. A film of a few molecules has no bulk viscosity;
        the force is in no other figure.
    created_oil : with Swift and Stieber's condition, oil created where a ruptured film forms again in Hertz' contact,
        over the flow through the middle of the contact. Zero with mass-conserving cavitation.
    iterations : Newton steps.
    cycles : of multigrid.
    residual : largest relative residual of balances, complementarity and load, recomputed from both pressures and H0.
    complementarity : largest violation of the film's bound over the least film.
    mass_imbalance : as of `PointFilmSolution`, ruptured cells left out.
    status : converged where the recomputed residuals meet the tolerance.
    notes : why no film was found, and limits of the figures.
    speeds, lubricant : as given.
    """

    x: FloatArray
    y: FloatArray
    pressure: FloatArray
    oil_pressure: FloatArray
    thickness: FloatArray
    heights: FloatArray
    touching: BoolArray
    least_film: float
    approach_datum: float
    load: float
    contact_load: float
    contact_share: float
    contact_share_error: float | None
    contact_area: float
    mean_thickness: float
    minimum_thickness: float
    oil_friction: float
    oil_on_contact: float
    created_oil: float
    iterations: int
    cycles: int
    residual: float
    complementarity: float
    mass_imbalance: float
    status: Status
    speeds: Speeds
    lubricant: Lubricant
    notes: tuple[Note, ...] = ()

    @property
    def contact_pressure(self) -> FloatArray:
        """Pressure (nx, ny) of surfaces that touch [Pa]."""
        return self.pressure - self.oil_pressure

    def friction(self, boundary_friction: float) -> float:
        """Return the friction coefficient: the oil's outside contact, and `boundary_friction` of the contact load."""
        return self.oil_friction + boundary_friction * self.contact_share


@one_blas_thread
def solve_rough_point_film(
    *,
    load: float,
    radii: Sequence[float],
    contact_modulus: float,
    speeds: Sequence[float] | Sequence[Sequence[float]],
    lubricant: Lubricant,
    heights: Heights,
    least_film: float = MOLECULAR_FILM,
    shape: tuple[int, int] | None = None,
    tolerance: float = 1e-8,
    extent: Sequence[float] | None = None,
    bodies: Body | Sequence[Body] | None = None,
    cavitation: Cavitation | str = Cavitation.MASS_CONSERVING,
    errors: bool = True,
) -> RoughPointFilm:
    """Steady film of an ellipsoid on a flat, one of them rough and at rest, with contact where the film vanishes.

    The whole pressure P deflects the bodies and carries the load; the oil's pressure q solves Reynolds' equation with
    the film. Where surfaces touch the film is the least one and P >= q, elsewhere it is thicker and P = q. Without
    speed P is the dry contact's, without contact the film is that of `solve_point_film`.

    Parameters
    ----------
    load, radii, contact_modulus, lubricant, tolerance, extent, bodies : as of `solve_point_film`; bodies are elastic.
    speeds : as there; one of them must be zero: the body at rest is the rough one, else no film is steady.
    heights : out of the rough body [m], a function of arrays x and y [m] of one shape: `Waves`, `MeasuredHeights`, any.
    least_film : [m], 1 nm by default.
    shape : (nx, ny) cells; 128 x 128 by default. Take eight cells a wavelength or more; a small share of the
        surfaces lies in constrictions at the contact's rim and takes more, see `contact_share_error`.
    cavitation : a `Cavitation` or its name; with SWIFT_STIEBER a film that forms again behind a summit is full at once,
        by created oil (`created_oil`).
    errors : also solve on half as many cells a side, for `contact_share_error`.

    Returns
    -------
    RoughPointFilm. `status` is `converged` only where the residuals recomputed from the result meet the tolerance, else
    `stalled` with the iterate of the smallest residual: films much thinner than heights on few cells a wavelength are
    not always found.

    Raises
    ------
    InputError : a value out of range, two moving bodies, rigid bodies, heights that are not finite on the grid.
    """
    cells = SHAPE if shape is None else shape
    pair = check_arguments(load, radii, contact_modulus, speeds, lubricant, cells, tolerance, extent)
    _check_rough(pair, contact_modulus, heights, least_film)
    request = _Request(heights, float(least_film), tolerance, pair, lubricant, cavitation_of(cavitation))
    both = (bodies,) if isinstance(bodies, Body) else bodies
    size = float(radii[0]), float(radii[1])

    def scaled(rectangle: Rectangle | None) -> ScaledCase:
        return scale_case(float(load), size, float(contact_modulus), entrainment(pair), lubricant, rectangle, both)

    case = scaled(checked_edges(extent))
    if extent is None:
        case = scaled(_default_extent(case, heights))
    check_extent(case)
    along = (int(cells[1]), int(cells[0])) if case.axes.exchanged else (int(cells[0]), int(cells[1]))
    film = _solve_on(case, along, request)
    if errors and film.status is Status.CONVERGED:
        coarse = _solve_on(case, (along[0] // 2, along[1] // 2), request)
        if coarse.status is Status.CONVERGED:
            film = replace(film, contact_share_error=abs(film.contact_share - coarse.contact_share))
        else:
            film = replace(film, notes=(*film.notes, no_error_bar(["contact_share"], NoBar.NO_COARSE_FILM)))
    return film


@dataclass(frozen=True)
class _Request:
    """Arguments of `solve_rough_point_film`."""

    heights: Heights
    least_film: float
    tolerance: float
    speeds: Speeds
    lubricant: Lubricant
    cavitation: Cavitation


def _check_rough(speeds: Speeds, contact_modulus: float, heights: Any, least_film: Any) -> None:
    """Refuse what solve_rough_point_film needs beyond solve_point_film [InputError]."""
    messages = []
    if not any(math.hypot(*one) == 0 for one in speeds):
        messages.append("speeds: one of the bodies must be at rest, it is the rough one; in time use march_point_film")
    if math.isinf(contact_modulus):
        messages.append("contact_modulus: bodies that touch must be elastic; give a finite modulus [Pa]")
    if not callable(heights):
        messages.append(f"heights: {type(heights).__name__} must be a function of x and y [m] to heights [m]")
    if not is_positive(least_film):
        messages.append(f"least_film: {least_film!r} must be positive and finite [m]")
    if messages:
        raise InputError(messages)


def _default_extent(case: ScaledCase, heights: Heights) -> Rectangle:
    """Return edges [m] where the gap has opened to films at least as thick as the heights' rms in Hertz' contact."""
    scales, axes = case.scales, case.axes
    assert case.hertz is not None
    a, b = axes.exchange([half * scales.length for half in case.hertz.semi_axes])
    place = np.linspace(-1, 1, 129)
    rms = float(np.std(heights(*np.meshgrid(a * place, b * place, indexing="ij"))))
    film = max(case.problem.typical_film, rms / scales.film)
    if not math.isfinite(film):
        raise InputError("heights: not finite [m] in the contact")
    edges = default_rectangle(case.hertz, scales.ratio, film, case.problem.entrainment)
    x0, x1, y0, y1 = (edge * scales.length for edge in edges)
    return axes.rectangle_to_user((x0, x1, y0, y1))


def _solve_on(case: ScaledCase, shape: tuple[int, int], request: _Request) -> RoughPointFilm:
    """Solve on a grid of this shape."""
    smooth = GridLevel(case.problem, shape)
    unit, axes = case.scales.length, case.axes
    x, y = axes.coordinates_to_user(smooth.x * unit, smooth.y * unit)
    points = np.broadcast_arrays(x[:, None], y[None, :])
    heights = np.asarray(request.heights(*points), dtype=np.float64)
    if heights.shape != points[0].shape or not np.isfinite(heights).all():
        nx, ny = points[0].shape
        raise InputError(f"heights: not {nx} x {ny} finite heights [m] on the grid")
    problem = replace(
        case.problem,
        heights=axes.to_flow(heights) / case.scales.film,
        layer=math.inf if request.cavitation is Cavitation.MASS_CONSERVING else None,
        least_film=request.least_film / case.scales.film,
    )
    level = GridLevel(problem, shape)
    return _result(case, level, solve_with_contact(level, CONTACT_TOLERANCE * request.tolerance), request)


def _result(case: ScaledCase, level: GridLevel, outcome: NewtonOutcome, request: _Request) -> RoughPointFilm:
    """Return the result in SI units on the user's axes, judged by its certificate."""
    scales, axes, state, heights = case.scales, case.axes, outcome.state, level.problem.heights
    assert heights is not None
    proof = certify(level, state)
    converged = proof.meets(request.tolerance)
    pressure_sum = float(state.pressure.sum())
    contact = float((state.pressure - state.oil_pressure).sum())
    total = level.problem.load * proof.load
    oil_friction, on_contact = _sliding_stress_sums(case, state, proof.contact, request)
    created = _created_oil(case, level, state)
    x, y = axes.coordinates_to_user(level.x * scales.length, level.y * scales.length)
    cell = level.cell_area * scales.length**2
    force = scales.pressure * scales.length**2
    return RoughPointFilm(
        x=x,
        y=y,
        pressure=axes.to_user(state.pressure) * scales.pressure,
        oil_pressure=axes.to_user(state.oil_pressure) * scales.pressure,
        thickness=axes.to_user(proof.film) * scales.film,
        heights=axes.to_user(heights) * scales.film,
        touching=axes.to_user(proof.contact),
        least_film=request.least_film,
        approach_datum=state.separation * scales.film,
        load=total * force,
        contact_load=contact * level.cell_area * force,
        contact_share=contact * level.cell_area / total,
        contact_share_error=None,
        contact_area=int(proof.contact.sum()) * cell,
        mean_thickness=float((proof.film * state.pressure).sum()) / pressure_sum * scales.film,
        minimum_thickness=float(proof.film.min()) * scales.film,
        oil_friction=oil_friction / (total * force) * cell,
        oil_on_contact=on_contact / (total * force) * cell,
        created_oil=created,
        iterations=outcome.steps,
        cycles=outcome.cycles,
        residual=proof.residual,
        complementarity=proof.complementarity,
        mass_imbalance=proof.mass,
        status=Status.CONVERGED if converged else Status.STALLED,
        speeds=request.speeds,
        lubricant=request.lubricant,
        notes=(*_notes(proof, converged, created), *coarse_heights(heights)),
    )


def _notes(proof: Certificate, converged: bool, created: float) -> tuple[Note, ...]:
    """Return the notes on a film that was not found, and on created oil."""
    notes = []
    if not converged:
        notes.append(FILM_NOT_FOUND(residual=proof.residual, reason="rough"))
    if created > LARGEST_CREATED_OIL:
        notes.append(OIL_CREATED(created=created))
    return tuple(notes)


def _sliding_stress_sums(
    case: ScaledCase, state: PointFilmState, contact: BoolArray, request: _Request
) -> tuple[float, float]:
    """Return the sums over cells of the oil's sliding stress [Pa] outside contact, and in contact."""
    scales, oil = case.scales, request.lubricant
    slide = math.hypot(*np.subtract(request.speeds[1], request.speeds[0]))
    pressure = state.oil_pressure * scales.pressure
    newtonian = oil.viscosity_at(pressure) * slide / (state.film * scales.film)
    stress = np.where(pressure > 0, oil.shear_stress(newtonian, pressure), 0.0)
    return float(stress[~contact].sum()), float(stress[contact].sum())


def _created_oil(case: ScaledCase, level: GridLevel, state: PointFilmState) -> float:
    """Return the oil created in Hertz' contact over the flow through its middle.

    Ruptured films form again there, through faces along either axis, without account of the oil that comes in.
    """
    problem = level.problem
    assert case.hertz is not None
    if problem.layer is not None:
        return 0.0
    a, b = case.hertz.semi_axes
    flux, derivatives = level.flux(state.oil_pressure, state.film)
    full = state.oil_pressure > 0
    fraction = swift_stieber_fraction(level, flux, derivatives, state.oil_pressure)
    forms = full & ((level.x[:, None] / a) ** 2 + (level.y / b) ** 2 < 1)
    missing = np.where(full, 0.0, flux * (1 - fraction))
    created = float(missing[0, :-1][forms[1:]].sum())
    if problem.entrainment[1] > 0:
        created += float(missing[1, :, :-1][forms[:, 1:]].sum()) * level.spacing[0] / level.spacing[1]
    middle = flux[0, int(np.searchsorted(level.x, 0.0)), np.abs(level.y) < b]
    return created / abs(float(middle.sum()))
