"""From a case in SI units to the similarity problem: axes along the flow, a rectangle that reaches the inlet."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from bem.convolution import DisplacementOperator, displacement_operator
from bem.grid import FloatArray, Grid
from bem.lubrication.flow_factors import LEAST_FACTOR, PlaneWalls
from bem.lubrication.lubricant import Lubricant
from bem.lubrication.point.levels import PointProblem
from bem.lubrication.point.scales import PointScales, nijenbanning_film, point_scales, rigid_film
from bem.materials import Body, Material
from bem.reference_solutions.hertz import PointContact, ellipse_contact

Rectangle = tuple[float, float, float, float]

OUTLET, SIDE = 4.0, 10.0
"""Films to which the dry gap has opened where a grid ends, and at its sides."""
INLET = (15.0, 30.0)
"""The same where it begins, of rigid bodies and of those that are pressed flat: there the gap opens faster than far
away, and the far pressure is more than there is. At M 1000, L 10 films are then off by 0.1 %, 1.3 % from 15."""
LONG, LONGEST_INLET = 6.0, 2.5
"""Half-axis across over that along from which an inlet begins further away, in proportion and up to so many times the
films: with the ball's, ellipses 12 to 68 times as long as wide had films 0.10 to 0.39 % thicker than the line contact's
on 128 x 64 cells, now 0.01 to 0.22 % (on 256 x 128 -0.03 to 0.12 %)."""
LEAST_MARGIN = 1.25
"""Half-axes of Hertz' ellipse that it reaches at least."""


@dataclass(frozen=True)
class Frame:
    """Axes in which oil comes from below along both, more along x than along y: the user's, exchanged and reversed."""

    exchanged: bool
    reversed: tuple[bool, bool]

    @staticmethod
    def of(entrainment: tuple[float, float]) -> Frame:
        """Of the sum of the speeds, in the user's axes."""
        exchanged = abs(entrainment[1]) > abs(entrainment[0])
        first, second = entrainment[::-1] if exchanged else entrainment
        return Frame(exchanged, (first < 0, second < 0))

    def pair(self, values: Sequence[float]) -> tuple[float, float]:
        """Two values along the user's axes, exchanged; back is the same."""
        return (values[1], values[0]) if self.exchanged else (values[0], values[1])

    def inner(self, field: FloatArray) -> FloatArray:
        """A field (nx, ny) on the user's axes, on these."""
        field = field.T if self.exchanged else field
        return np.ascontiguousarray(field[self._steps])

    def outer(self, field: FloatArray) -> FloatArray:
        """A field on these axes, on the user's."""
        field = field[self._steps]
        return np.ascontiguousarray(field.T if self.exchanged else field)

    @property
    def _steps(self) -> tuple[slice, slice]:
        return slice(None, None, -1 if self.reversed[0] else 1), slice(None, None, -1 if self.reversed[1] else 1)

    def rectangle(self, x0: float, x1: float, y0: float, y1: float) -> Rectangle:
        """Edges on the user's axes, on these."""
        (a0, a1), (b0, b1) = ((y0, y1), (x0, x1)) if self.exchanged else ((x0, x1), (y0, y1))
        if self.reversed[0]:
            a0, a1 = -a1, -a0
        if self.reversed[1]:
            b0, b1 = -b1, -b0
        return a0, a1, b0, b1

    def axes(self, x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Abscissae on these axes, on the user's."""
        first = -x[::-1] if self.reversed[0] else x
        second = -y[::-1] if self.reversed[1] else y
        return (second, first) if self.exchanged else (first, second)


@dataclass(frozen=True)
class Setting:
    """A case: axes, units, the similarity problem, Hertz' contact in its units (None of rigid bodies), and how far the
    rectangle reaches into the inlet and to its sides, over how far the default one does."""

    frame: Frame
    scales: PointScales
    problem: PointProblem
    hertz: PointContact | None
    reach: float = 1.0


def setting_of(
    load: float,
    radii: tuple[float, float],
    contact_modulus: float,
    entrainment: tuple[float, float],
    lubricant: Lubricant,
    extent: Rectangle | None,
    bodies: Sequence[Body] | None,
    walls_of: Callable[[float], PlaneWalls | None] | None = None,
) -> Setting:
    """The setting of a case; `entrainment` is the sum of the speeds [m/s], `extent` edges on the user's axes [m],
    `walls_of` gives the rough walls of films in a unit [m], None between smooth ones."""
    frame = Frame.of(entrainment)
    speed = math.hypot(*entrainment)
    along = frame.pair(radii)
    scales = point_scales(load, along, contact_modulus, speed, lubricant.viscosity)
    flow = frame.pair(entrainment)
    drag = (abs(flow[0]) / speed, abs(flow[1]) / speed)
    film = typical_film(scales, drag, lubricant.pressure_viscosity)
    walls = None if walls_of is None else walls_of(scales.film)
    if walls is not None:
        film = _film_between(walls, film)
    hertz = None
    if not scales.rigid:
        # E* = 1/2 in units in which 2/pi is 1/(pi E*)
        hertz = ellipse_contact(radii=(1.0, 1 / scales.ratio), contact_modulus=0.5, load=scales.load)
    reach = 1.0
    if extent is None:
        rectangle = default_rectangle(hertz, scales.ratio, film, drag)
    else:
        a0, a1, b0, b1 = frame.rectangle(*extent)
        unit = scales.length
        rectangle = (a0 / unit, a1 / unit, b0 / unit, b1 / unit)
        if any(drag):
            usual = default_rectangle(hertz, scales.ratio, film, drag)
            reach = min(rectangle[i] / usual[i] for i in (0, 2, 3))
    oil = scaled_oil(lubricant, scales.pressure)
    operator = None if scales.rigid else Operators(scales, rectangle, contact_modulus, bodies)
    problem = PointProblem(scales.load, (1.0, scales.ratio), drag, oil, rectangle, operator, film, walls=walls)
    return Setting(frame, scales, problem, hertz, reach)


def scaled_oil(lubricant: Lubricant, unit: float) -> Callable[[FloatArray], FloatArray]:
    """What `loops.flows` takes of an oil at pressures in their unit [Pa]."""

    def oil(pressure: FloatArray) -> FloatArray:
        physical = pressure * unit
        log_viscosity, slope = lubricant.log_viscosity_ratio(physical)
        density, density_slope = lubricant.density_ratio(physical)
        return np.stack([log_viscosity, slope * unit, density, density_slope * unit])

    return oil


@dataclass(frozen=True)
class Operators:
    """Displacement operators on grids of a rectangle, and the factor from what they make of pressures to films."""

    scales: PointScales
    rectangle: Rectangle
    contact_modulus: float
    bodies: Sequence[Body] | None

    def __call__(self, shape: tuple[int, int]) -> tuple[DisplacementOperator, float]:
        """On a grid of this shape."""
        x0, x1, y0, y1 = self.rectangle
        unit = self.scales.length
        grid = Grid(shape, ((x1 - x0) / shape[0] * unit, (y1 - y0) / shape[1] * unit))
        if self.bodies is None:
            pair: tuple[Body, ...] = (_body(self.contact_modulus),)
        else:
            pair = tuple(self.bodies)
        operator = displacement_operator(grid, pair if len(pair) > 1 else pair[0])  # type: ignore[arg-type]
        return operator, self.scales.pressure / self.scales.film


def _body(contact_modulus: float) -> Body:
    """A half-space that yields as much as both bodies."""
    return Body(Material("both bodies", youngs_modulus=contact_modulus, poissons_ratio=0.0))


def typical_film(scales: PointScales, drag: tuple[float, float], pressure_viscosity: float) -> float:
    """Central film to be expected, in its unit: between those along both axes."""
    law = rigid_film if scales.rigid else nijenbanning_film
    load, material, ratio = scales.load, pressure_viscosity * scales.pressure, scales.ratio
    # across: radii exchanged, and with them the units
    across = law(load * ratio**1.25, material * ratio**0.25, 1 / ratio) / math.sqrt(ratio)
    return drag[0] ** 2 * law(load, material, ratio) + drag[1] ** 2 * across


def _film_between(walls: PlaneWalls, film: float) -> float:
    """Film to be expected between rough walls where it would be `film` between smooth ones: that of an oil of the
    viscosity over phi_x, with whose power 2/3 films go."""
    from scipy.optimize import brentq

    least, most = film / 10, film * LEAST_FACTOR ** (-2 / 3)

    def missing(log: float) -> float:
        return log + 2 / 3 * math.log(float(walls.on(np.array([[math.exp(log)]]))[0, 0, 0])) - math.log(film)

    ends = math.log(least), math.log(most)
    if missing(math.log(film)) == 0 or missing(ends[0]) >= 0 or missing(ends[1]) <= 0:
        return film
    return math.exp(float(brentq(missing, *ends, rtol=1e-6)))


def default_rectangle(hertz: PointContact | None, ratio: float, film: float, drag: tuple[float, float]) -> Rectangle:
    """Edges where the dry gap has opened to some films."""
    from scipy.optimize import brentq

    def reach(along_y: bool, films: float) -> float:
        opening, curvature = films * film, ratio if along_y else 1.0
        if hertz is None:
            return math.sqrt(2 * opening / curvature)
        half = hertz.semi_axes[along_y]

        def missing(s: float) -> float:
            return float(hertz.gap(0.0, s) if along_y else hertz.gap(s, 0.0)) - opening

        far = 2 * half + 3 * math.sqrt(2 * opening / curvature)
        return max(float(brentq(missing, half * (1 + 1e-9), far)), LEAST_MARGIN * half)

    flat = 0.0 if hertz is None else hertz.approach / (hertz.approach + film)
    inlet = INLET[0] + flat * (INLET[1] - INLET[0])
    further = 1.0 if hertz is None else min(max(hertz.semi_axes[1] / hertz.semi_axes[0] / LONG, 1.0), LONGEST_INLET)
    # at an angle oil comes from below, too: across a long contact along x most of it
    across = drag[1] ** 2
    if hertz is not None and drag[1] > 0:
        along, beside = (half * way for half, way in zip(hertz.semi_axes, drag[::-1], strict=True))
        across = max(across, along**2 / (along**2 + beside**2))
    below = SIDE + across * (inlet - SIDE)
    end = OUTLET + drag[1] ** 2 * (SIDE - OUTLET)
    return -reach(False, further * inlet), reach(False, end), -reach(True, below), reach(True, SIDE)
