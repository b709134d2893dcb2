"""The steady film of a point contact with roughness in Reynolds' equation itself, and contact where it would vanish.

One of the bodies is rough and at rest, the other one is smooth and moves over it. `touching_newton` has the equations.
Knows what `solve` knows; verified in tests/lubrication/point/test_rough_film.py: without speed against
`bem.contact`, without contact against `solve_point_film` and `march_point_film`.
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
from bem.lubrication.lubricant import Lubricant
from bem.lubrication.point import loops
from bem.lubrication.point.levels import Level
from bem.lubrication.point.linear import BoolArray, flows
from bem.lubrication.point.moving import Heights
from bem.lubrication.point.newton import own_film
from bem.lubrication.point.setting import Rectangle, Setting, default_rectangle, setting_of
from bem.lubrication.point.solve import Speeds, check_extent, checked, edges, entrainment
from bem.lubrication.point.touching_newton import TouchingBalance, TouchingOutcome, TouchingState, balance
from bem.lubrication.point.touching_start import reached
from bem.lubrication.point.validity import coarse_heights
from bem.materials import Body
from bem.notes import Note
from bem.notes.accuracy import NoBar, no_error_bar
from bem.notes.lubrication import FILM_NOT_FOUND, OIL_CREATED
from bem.representation import readable
from bem.threads import one_blas_thread

SHAPE = (128, 128)
LEAST_FILM = 1e-9
"""[m], of a few molecules: below, no oil is a continuum."""
INSIDE = 0.2
"""Share of the tolerance that Newton's method aims at: the certificate counts errors of films in balances, too."""
CREATED = 0.01
"""Of the oil through the contact, what may come from nowhere without a note."""


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
    load : of all [N], what is outside the grid included.
    contact_load : of surfaces alone [N].
    contact_share : of the load.
    contact_share_error : the difference to a grid of half as many cells a side; None where that has no
        film or was not asked for.
    contact_area : of cells that touch [m^2], of first order in the cells.
    mean_thickness : by pressure [m].
    minimum_thickness : of any cell [m].
    oil_friction : sliding stress of the oil where nothing touches, over the load.
    oil_on_contact : the same where surfaces touch, where a film of molecules has no viscosity to speak of:
        beside, in no sum.
    created_oil : oil that comes from nowhere where a ruptured film forms again in Hertz' contact, over what goes
        through its middle: Swift and Stieber's condition keeps no account of empty cells. Zero with mass conserved.
    iterations : Newton steps.
    cycles : of multigrid.
    residual : largest relative error of balances of oil, film against deflection, complementarity and load, recomputed
        from both pressures and H0 alone.
    complementarity : that of films alone, over the least film.
    mass_imbalance : as of `PointFilmSolution`, empty cells left out.
    status : converged where residual and complementarity, recomputed, meet what was asked for.
    notes : why there is no film, and what bears on its figures.
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
        """What surfaces carry (nx, ny) [Pa]."""
        return self.pressure - self.oil_pressure

    def friction(self, boundary_friction: float) -> float:
        """Coefficient: the oil's where nothing touches, and a coefficient of what surfaces carry."""
        return self.oil_friction + boundary_friction * self.contact_share


@dataclass(frozen=True)
class _Asked:
    heights: Heights
    least_film: float
    tolerance: float
    speeds: Speeds
    lubricant: Lubricant
    cavitation: Cavitation


@one_blas_thread
def solve_rough_point_film(
    *,
    load: float,
    radii: Sequence[float],
    contact_modulus: float,
    speeds: Sequence[float] | Sequence[Sequence[float]],
    lubricant: Lubricant,
    heights: Heights,
    least_film: float = LEAST_FILM,
    shape: tuple[int, int] | None = None,
    tolerance: float = 1e-8,
    extent: Sequence[float] | None = None,
    bodies: Body | Sequence[Body] | None = None,
    cavitation: Cavitation | str = Cavitation.MASS_CONSERVING,
    errors: bool = True,
) -> RoughPointFilm:
    """Steady film of an ellipsoid on a flat, one of them rough and at rest, with contact where the film vanishes.

    The whole pressure P deflects the bodies and carries the load; the oil's, q, solves Reynolds' equation with the
    film there is. Where surfaces touch the film is the least one and P >= q, elsewhere
    it is thicker and P = q. Without speed P is the dry contact's, without contact the film that of `solve_point_film`.

    Parameters
    ----------
    load, radii, contact_modulus, lubricant, tolerance, extent, bodies : as of `solve_point_film`; bodies are elastic.
    speeds : as there; one of them must be zero: the body at rest is the rough one, else no film is steady.
    heights : out of the rough body [m], a function of arrays x and y [m] of one shape: `Waves`, `MeasuredHeights`, any.
    least_film : [m], 1 nm by default.
    shape : (nx, ny) cells; 128 x 128 by default. Take eight cells a wavelength or more; a small share of the
        surfaces lies in constrictions at the contact's rim and takes more, see `contact_share_error`.
    cavitation : a `Cavitation` or its name; with SWIFT_STIEBER a film that forms again behind a summit is full at once,
        of oil from nowhere (`created_oil`).
    errors : also solve on half as many cells a side, for `contact_share_error`.

    Returns
    -------
    RoughPointFilm. `status` is `converged` only where what is recomputed from the result meets the tolerance, else
    `stalled` with the least wrong iterate: films much thinner than heights on few cells a wavelength are not always
    found.

    Raises
    ------
    InputError : a value out of range, two moving bodies, rigid bodies, heights that are not finite on the grid.
    """
    cells = SHAPE if shape is None else shape
    pair = checked(load, radii, contact_modulus, speeds, lubricant, cells, tolerance, extent)
    _check_rough(pair, contact_modulus, heights, least_film)
    asked = _Asked(heights, float(least_film), tolerance, pair, lubricant, cavitation_of(cavitation))
    both = (bodies,) if isinstance(bodies, Body) else bodies
    size = float(radii[0]), float(radii[1])

    def set_up(rectangle: Rectangle | None) -> Setting:
        return setting_of(float(load), size, float(contact_modulus), entrainment(pair), lubricant, rectangle, both)

    setting = set_up(edges(extent))
    if extent is None:
        setting = set_up(_reach(setting, heights))
    check_extent(setting)
    inner = (int(cells[1]), int(cells[0])) if setting.frame.exchanged else (int(cells[0]), int(cells[1]))
    found = _said(setting, *_solved(setting, inner, asked), asked)
    if errors and found.status is Status.CONVERGED:
        half = (inner[0] // 2, inner[1] // 2)
        coarse = _said(setting, *_solved(setting, half, asked), asked)
        if coarse.status is Status.CONVERGED:
            found = replace(found, contact_share_error=abs(found.contact_share - coarse.contact_share))
        else:
            found = replace(found, notes=(*found.notes, no_error_bar(["contact_share"], NoBar.NO_COARSE_FILM)))
    return found


def _check_rough(speeds: Speeds, contact_modulus: float, heights: Any, least_film: Any) -> None:
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


def _reach(setting: Setting, heights: Heights) -> Rectangle:
    """Edges [m] where the gap has opened to films at least as thick as the heights' rms in Hertz' contact."""
    scales, frame = setting.scales, setting.frame
    assert setting.hertz is not None
    a, b = frame.pair([half * scales.length for half in setting.hertz.semi_axes])
    place = np.linspace(-1, 1, 129)
    rms = float(np.std(heights(*np.meshgrid(a * place, b * place, indexing="ij"))))
    film = max(setting.problem.typical_film, rms / scales.film)
    if not math.isfinite(film):
        raise InputError("heights: not finite [m] in the contact")
    x0, x1, y0, y1 = default_rectangle(setting.hertz, scales.ratio, film, setting.problem.drag)
    x, y = frame.axes(np.array([x0, x1]) * scales.length, np.array([y0, y1]) * scales.length)
    return float(x[0]), float(x[1]), float(y[0]), float(y[1])


def _solved(setting: Setting, shape: tuple[int, int], asked: _Asked) -> tuple[Level, TouchingOutcome]:
    """The film on a grid."""
    smooth = Level(setting.problem, shape)
    unit, frame = setting.scales.length, setting.frame
    x, y = frame.axes(smooth.x * unit, smooth.y * unit)
    wide = np.broadcast_arrays(x[:, None], y[None, :])
    found = np.asarray(asked.heights(*wide), dtype=np.float64)
    if found.shape != wide[0].shape or not np.isfinite(found).all():
        raise InputError(f"heights: not {wide[0].shape[0]} x {wide[0].shape[1]} finite heights [m] on the grid")
    layer = math.inf if asked.cavitation is Cavitation.MASS_CONSERVING else None
    level = Level(replace(setting.problem, heights=frame.inner(found) / setting.scales.film, layer=layer), shape)
    return level, reached(level, asked.least_film / setting.scales.film, INSIDE * asked.tolerance)


def _said(setting: Setting, level: Level, outcome: TouchingOutcome, asked: _Asked) -> RoughPointFilm:
    """The result, judged by its pressures and H0 alone."""
    scales, frame, state = setting.scales, setting.frame, outcome.state
    judged = _judged(level, state, asked.least_film / scales.film, asked.tolerance)
    film, touching = judged.film, judged.touching
    carried = float(state.pressure.sum())
    contact = float((state.pressure - state.oil).sum())
    total = level.problem.load + judged.balance.load
    oil_friction, on_contact = _stresses(setting, state, touching, asked)
    created = _created(setting, level, state)
    x, y = frame.axes(level.x * scales.length, level.y * scales.length)
    cell = level.cell * scales.length**2
    force = scales.pressure * scales.length**2
    heights = level.problem.heights
    assert heights is not None
    return RoughPointFilm(
        x=x,
        y=y,
        pressure=frame.outer(state.pressure) * scales.pressure,
        oil_pressure=frame.outer(state.oil) * scales.pressure,
        thickness=frame.outer(film) * scales.film,
        heights=frame.outer(heights) * scales.film,
        touching=frame.outer(touching.astype(float)) > 0,
        least_film=asked.least_film,
        approach_datum=state.datum * scales.film,
        load=total * force,
        contact_load=contact * level.cell * force,
        contact_share=contact * level.cell / total,
        contact_share_error=None,
        contact_area=int(touching.sum()) * cell,
        mean_thickness=float((film * state.pressure).sum()) / carried * scales.film,
        minimum_thickness=float(film.min()) * scales.film,
        oil_friction=oil_friction / (total * force) * cell,
        oil_on_contact=on_contact / (total * force) * cell,
        created_oil=created,
        iterations=outcome.steps,
        cycles=outcome.cycles,
        residual=judged.residual,
        complementarity=judged.complementarity,
        mass_imbalance=judged.balance.mass,
        status=Status.CONVERGED if judged.right else Status.STALLED,
        speeds=asked.speeds,
        lubricant=asked.lubricant,
        notes=(*_notes(judged, created), *coarse_heights(heights)),
    )


@dataclass(frozen=True)
class _Judged:
    """Of pressures and H0 alone: the film, what touches, balances, errors, and whether all is right."""

    film: FloatArray
    touching: BoolArray
    balance: TouchingBalance
    complementarity: float
    residual: float
    right: bool


def _judged(level: Level, state: TouchingState, least: float, tolerance: float) -> _Judged:
    film = own_film(level, state.pressure, state.datum)
    touching = state.pressure > state.oil
    off = np.where(touching, np.abs(film - least), np.maximum(least - film, 0.0))
    complementarity = float(off.max()) / least
    sound = bool(film.min() > 0) and not bool((touching & level.border).any())
    # what is not sound has no balances: figures are then the iterate's, and the status says so
    shown = replace(state, film=film if sound else state.film, touching=touching & ~level.border)
    of = balance(level, shown, 0 * film)
    share = abs(of.load) / level.problem.load
    # nothing pulls: neither the oil nor the surfaces
    pulled = float(np.minimum(state.oil, state.pressure - state.oil).min()) < 0
    residual = max(float(np.abs(of.wrong).max()), share, complementarity)
    right = sound and not pulled and max(residual, of.mass) <= tolerance
    return _Judged(shown.film, touching, of, complementarity, residual, right)


def _notes(judged: _Judged, created: float) -> tuple[Note, ...]:
    notes = []
    if not judged.right:
        notes.append(FILM_NOT_FOUND(residual=judged.residual, reason="rough"))
    if created > CREATED:
        notes.append(OIL_CREATED(created=created))
    return tuple(notes)


def _stresses(setting: Setting, state: TouchingState, touching: BoolArray, asked: _Asked) -> tuple[float, float]:
    """Sums over cells [Pa] of the oil's sliding stress where nothing touches, and where surfaces do."""
    scales, oil = setting.scales, asked.lubricant
    slide = math.hypot(*np.subtract(asked.speeds[1], asked.speeds[0]))
    pressure = state.oil * scales.pressure
    newtonian = oil.viscosity_at(pressure) * slide / (state.film * scales.film)
    stress = np.where(pressure > 0, oil.shear_stress(newtonian, pressure), 0.0)
    return float(stress[~touching].sum()), float(stress[touching].sum())


def _created(setting: Setting, level: Level, state: TouchingState) -> float:
    """Oil from nowhere in Hertz' contact over what goes through its middle (across the frame's x): where ruptured films
    form again, through faces along either axis."""
    assert setting.hertz is not None
    if level.problem.layer is not None:
        return 0.0
    a, b = setting.hertz.semi_axes
    flow, stencil = flows(level, state.oil, state.film)
    full, share = state.oil > 0, np.ones(level.shape)
    loops.carry_on(flow, stencil[8], full, level.problem.drag, level.spacing, share)
    forms = full & ((level.x[:, None] / a) ** 2 + (level.y / b) ** 2 < 1)
    missing = np.where(full, 0.0, flow * (1 - share))
    along = float(missing[0, :-1][forms[1:]].sum())
    if level.problem.drag[1] > 0:
        along += float(missing[1, :, :-1][forms[:, 1:]].sum()) * level.spacing[0] / level.spacing[1]
    middle = flow[0, int(np.searchsorted(level.x, 0.0)), np.abs(level.y) < b]
    return along / abs(float(middle.sum()))
