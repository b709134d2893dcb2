"""The similarity problem of a point contact: from SI units to axes along the flow, a rectangle, and equations.

1. Axes are exchanged and reversed so that entrainment points to larger indices, more along x than along y (`FlowAxes`).
2. Lengths, films and pressures are measured in Moes' units (`similarity`).
3. The rectangle ends where the dry gap has opened to a number of films (`default_rectangle`); beyond it the pressure is
   that of the far field (`far_field`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from bem.convolution import DisplacementOperator, displacement_operator
from bem.grid import FloatArray, Grid
from bem.lubrication.flow_factors import LEAST_FACTOR, PlaneWalls
from bem.lubrication.lubricant import Lubricant
from bem.lubrication.point.far_field import FarField, far_load
from bem.lubrication.point.similarity import PointScales, nijenbanning_film, point_scales, rigid_film
from bem.materials import Body, Material
from bem.reference_solutions.hertz import PointContact, ellipse_contact

Scalar = TypeVar("Scalar", np.float64, np.bool_)
Rectangle = tuple[float, float, float, float]
ScaledOil = Callable[[FloatArray], FloatArray]
"""Oil properties (4, ...) at pressures in their unit: ln m and its derivative with pressure, rho and its derivative."""
ElasticOperator = Callable[[tuple[int, int]], tuple[DisplacementOperator, float]]
"""Displacement operator of both bodies on a grid of a shape, and the factor from its result to films."""

OUTLET, SIDE = 4.0, 10.0
"""Films to which the dry gap has opened at the outlet of the rectangle, and at its sides."""
INLET = (15.0, 30.0)
"""Films to which it has opened at the inlet, of rigid bodies and of bodies that are pressed flat. Around a flattened
contact the gap opens faster than far away, and the far pressure exceeds the true one: at M 1000, L 10 films have an
error of 0.1 % from 30 films and 1.3 % from 15."""
LONG, LONGEST_INLET = 6.0, 2.5
"""Half-axis across over that along the flow from which the inlet begins further away, in proportion, and the largest
factor. With a ball's inlet, ellipses 12 to 68 times as long as wide have films 0.10 to 0.39 % thicker than the line
contact on 128 x 64 cells, with this one 0.01 to 0.22 % (on 256 x 128 -0.03 to 0.12 %)."""
LEAST_MARGIN = 1.25
"""Smallest distance of an edge from the centre, in half-axes of Hertz' ellipse."""


@dataclass(frozen=True, eq=False)
class TimeTerms:
    """Terms that a time step adds to the equations.

    storage_rate, history : d(rho H)/dT = storage_rate rho H + history (nx, ny).
    separation_history : dH0/dT = storage_rate H0 + separation_history.
    inertia : (a, b) of the force a H0 + b that accelerates the ball.
    """

    storage_rate: float
    history: FloatArray
    separation_history: float
    inertia: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True, eq=False)
class PointProblem:
    """Similarity problem of a point contact.

    load : Moes' M.
    curvatures : of the gap along x and y, (1, Rx/Ry); others where radii change in time.
    entrainment : along x and y, over that of its unit.
    oil : properties of the oil.
    rectangle : (x0, x1, y0, y1), outer edges of the outermost cells.
    operator : elastic bodies; None of rigid bodies.
    typical_film : central film to be expected.
    heights : (nx, ny) of both surfaces out of the bodies; None of smooth ones.
    time_terms : None of a steady film.
    walls : flow factors, of steady films alone; None of smooth walls. The far field has smooth walls.
    layer : oil that the surfaces bring along, as a film, with mass-conserving cavitation of steady films. Smaller than
        the gap on the inlet's outermost cells; infinite of a flooded inlet; None with Swift and Stieber's condition.
    least_film : film at which surfaces touch; None of surfaces that never touch.
    """

    load: float
    curvatures: tuple[float, float]
    entrainment: tuple[float, float]
    oil: ScaledOil
    rectangle: Rectangle
    operator: ElasticOperator | None
    typical_film: float
    heights: FloatArray | None = None
    time_terms: TimeTerms | None = None
    walls: PlaneWalls | None = None
    layer: float | None = None
    least_film: float | None = None

    @property
    def starved(self) -> bool:
        """Return True if the gap is not full at the inlet of the rectangle."""
        return self.layer is not None and self.layer < np.inf

    @property
    def storage_rate(self) -> float:
        """Derivative of d(rho H)/dT with rho H; zero of a steady film."""
        return 0.0 if self.time_terms is None else self.time_terms.storage_rate

    @property
    def squeeze_slope(self) -> float:
        """Derivative of the squeeze's part of the far pressure times h^2 with H0."""
        return -3 / sum(self.curvatures) * self.storage_rate

    def far_field(self, separation: float) -> FarField:
        """Return the far field at H0."""
        squeeze = 0.0
        if self.time_terms is not None:
            approach = self.storage_rate * separation + self.time_terms.separation_history
            squeeze = -3 / sum(self.curvatures) * approach
        return FarField(self.entrainment, self.curvatures, squeeze)

    def outside_load(self, separation: float) -> tuple[float, float]:
        """Return the load outside the rectangle, and its derivative with H0."""
        if self.starved:
            return 0.0, 0.0
        deflecting = 0.0 if self.operator is None else self.load
        return far_load(self.rectangle, self.far_field(separation), separation, deflecting, self.squeeze_slope)

    def required_load(self, separation: float) -> tuple[float, float]:
        """Return the load that pressures must carry, inertia included, and its derivative with H0."""
        slope, rest = (0.0, 0.0) if self.time_terms is None else self.time_terms.inertia
        return self.load + slope * separation + rest, slope


@dataclass(frozen=True)
class FlowAxes:
    """Axes along which entrainment is positive, larger along x: the user's axes, exchanged and reversed."""

    exchanged: bool
    reversed: tuple[bool, bool]

    @staticmethod
    def of(entrainment: tuple[float, float]) -> FlowAxes:
        """Return the axes of an entrainment along the user's axes."""
        exchanged = abs(entrainment[1]) > abs(entrainment[0])
        first, second = entrainment[::-1] if exchanged else entrainment
        return FlowAxes(exchanged, (first < 0, second < 0))

    def exchange(self, values: Sequence[float]) -> tuple[float, float]:
        """Exchange two values along the axes, from the user's axes or back."""
        return (values[1], values[0]) if self.exchanged else (values[0], values[1])

    def to_flow(self, field: NDArray[Scalar]) -> NDArray[Scalar]:
        """Return a field (nx, ny) on the user's axes on the flow axes."""
        field = field.T if self.exchanged else field
        return np.ascontiguousarray(field[self._steps])

    def to_user(self, field: NDArray[Scalar]) -> NDArray[Scalar]:
        """Return a field on the flow axes on the user's axes."""
        field = field[self._steps]
        return np.ascontiguousarray(field.T if self.exchanged else field)

    @property
    def _steps(self) -> tuple[slice, slice]:
        return slice(None, None, -1 if self.reversed[0] else 1), slice(None, None, -1 if self.reversed[1] else 1)

    def rectangle_to_flow(self, x0: float, x1: float, y0: float, y1: float) -> Rectangle:
        """Return edges on the user's axes on the flow axes."""
        (a0, a1), (b0, b1) = ((y0, y1), (x0, x1)) if self.exchanged else ((x0, x1), (y0, y1))
        if self.reversed[0]:
            a0, a1 = -a1, -a0
        if self.reversed[1]:
            b0, b1 = -b1, -b0
        return a0, a1, b0, b1

    def rectangle_to_user(self, rectangle: Rectangle) -> Rectangle:
        """Return edges on the flow axes on the user's axes."""
        x, y = self.coordinates_to_user(np.array(rectangle[:2]), np.array(rectangle[2:]))
        return float(x[0]), float(x[1]), float(y[0]), float(y[1])

    def coordinates_to_user(self, x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return ascending coordinates on the flow axes on the user's axes."""
        first = -x[::-1] if self.reversed[0] else x
        second = -y[::-1] if self.reversed[1] else y
        return (second, first) if self.exchanged else (first, second)


@dataclass(frozen=True)
class ScaledCase:
    """A case in similarity variables.

    axes, scales, problem : axes along the flow, units, equations.
    hertz : dry contact in these units; None of rigid bodies.
    relative_extent : distance of the inlet and the sides of the rectangle over that of the default rectangle.
    """

    axes: FlowAxes
    scales: PointScales
    problem: PointProblem
    hertz: PointContact | None
    relative_extent: float = 1.0


def scale_case(
    load: float,
    radii: tuple[float, float],
    contact_modulus: float,
    entrainment: tuple[float, float],
    lubricant: Lubricant,
    extent: Rectangle | None,
    bodies: Sequence[Body] | None,
    walls_of: Callable[[float], PlaneWalls | None] | None = None,
) -> ScaledCase:
    """Return a case in similarity variables.

    Parameters
    ----------
    load, radii, contact_modulus, lubricant, bodies : as of `steady.solve_point_film`.
    entrainment : sum of the speeds along the user's axes [m/s].
    extent : edges on the user's axes [m]; None of the default rectangle.
    walls_of : function of the unit of films [m] to the flow factors of rough walls.
    """
    axes = FlowAxes.of(entrainment)
    speed = math.hypot(*entrainment)
    scales = point_scales(load, axes.exchange(radii), contact_modulus, speed, lubricant.viscosity)
    flow = axes.exchange(entrainment)
    direction = (abs(flow[0]) / speed, abs(flow[1]) / speed)
    film = typical_film(scales, direction, lubricant.pressure_viscosity)
    walls = None if walls_of is None else walls_of(scales.film)
    if walls is not None:
        film = _film_between_walls(walls, film)
    hertz = hertz_contact(scales, (1.0, scales.ratio), scales.load)
    relative_extent = 1.0
    if extent is None:
        rectangle = default_rectangle(hertz, scales.ratio, film, direction)
    else:
        a0, a1, b0, b1 = axes.rectangle_to_flow(*extent)
        unit = scales.length
        rectangle = (a0 / unit, a1 / unit, b0 / unit, b1 / unit)
        if any(direction):
            default = default_rectangle(hertz, scales.ratio, film, direction)
            relative_extent = min(rectangle[i] / default[i] for i in (0, 2, 3))
    oil = scale_oil(lubricant, scales.pressure)
    operator = None if scales.rigid else Elasticity(scales, rectangle, contact_modulus, bodies)
    problem = PointProblem(scales.load, (1.0, scales.ratio), direction, oil, rectangle, operator, film, walls=walls)
    return ScaledCase(axes, scales, problem, hertz, relative_extent)


def scale_oil(lubricant: Lubricant, unit: float) -> ScaledOil:
    """Return the properties of an oil as functions of the pressure in its unit [Pa]."""

    def oil(pressure: FloatArray) -> FloatArray:
        physical = pressure * unit
        log_viscosity, slope = lubricant.log_viscosity_ratio(physical)
        density, density_slope = lubricant.density_ratio(physical)
        return np.stack([log_viscosity, slope * unit, density, density_slope * unit])

    return oil


def hertz_contact(scales: PointScales, curvatures: tuple[float, float], load: float) -> PointContact | None:
    """Return Hertz' contact in similarity variables; None of rigid bodies."""
    if scales.rigid:
        return None
    along, across = curvatures
    # the factor 2/pi of the film equation is 1/(pi E*) with E* = 1/2
    return ellipse_contact(radii=(1 / along, 1 / across), contact_modulus=0.5, load=load)


@dataclass(frozen=True)
class Elasticity:
    """Displacement operators on grids of a rectangle, see `ElasticOperator`."""

    scales: PointScales
    rectangle: Rectangle
    contact_modulus: float
    bodies: Sequence[Body] | None

    def __call__(self, shape: tuple[int, int]) -> tuple[DisplacementOperator, float]:
        """Return the operator on a grid of this shape, and the factor to films."""
        x0, x1, y0, y1 = self.rectangle
        unit = self.scales.length
        grid = Grid(shape, ((x1 - x0) / shape[0] * unit, (y1 - y0) / shape[1] * unit))
        if self.bodies is None:
            # one half-space as compliant as both bodies
            material = Material("both bodies", youngs_modulus=self.contact_modulus, poissons_ratio=0.0)
            pair: tuple[Body, ...] = (Body(material),)
        else:
            pair = tuple(self.bodies)
        operator = displacement_operator(grid, pair if len(pair) > 1 else pair[0])  # type: ignore[arg-type]
        return operator, self.scales.pressure / self.scales.film


def typical_film(scales: PointScales, direction: tuple[float, float], pressure_viscosity: float) -> float:
    """Return the central film to be expected over its unit: between those of flow along both axes."""
    law = rigid_film if scales.rigid else nijenbanning_film
    load, material, ratio = scales.load, pressure_viscosity * scales.pressure, scales.ratio
    # along y radii are exchanged, and units with them
    across = law(load * ratio**1.25, material * ratio**0.25, 1 / ratio) / math.sqrt(ratio)
    return direction[0] ** 2 * law(load, material, ratio) + direction[1] ** 2 * across


def _film_between_walls(walls: PlaneWalls, film: float) -> float:
    """Return the film to be expected between rough walls, from that between smooth walls.

    Flow factors act as an oil of viscosity mu/phi_x, and films go with the power 2/3 of the viscosity.
    """
    from scipy.optimize import brentq

    least, most = film / 10, film * LEAST_FACTOR ** (-2 / 3)

    def residual(log: float) -> float:
        return log + 2 / 3 * math.log(float(walls.on(np.array([[math.exp(log)]]))[0, 0, 0])) - math.log(film)

    ends = math.log(least), math.log(most)
    if residual(math.log(film)) == 0 or residual(ends[0]) >= 0 or residual(ends[1]) <= 0:
        return film
    return math.exp(float(brentq(residual, *ends, rtol=1e-6)))


def default_rectangle(
    hertz: PointContact | None, ratio: float, film: float, direction: tuple[float, float]
) -> Rectangle:
    """Return edges where the dry gap has opened to a number of films, see `INLET`, `OUTLET` and `SIDE`."""
    from scipy.optimize import brentq

    def distance(along_y: bool, films: float) -> float:
        opening, curvature = films * film, ratio if along_y else 1.0
        if hertz is None:
            return math.sqrt(2 * opening / curvature)
        half = hertz.semi_axes[along_y]

        def residual(s: float) -> float:
            return float(hertz.gap(0.0, s) if along_y else hertz.gap(s, 0.0)) - opening

        far = 2 * half + 3 * math.sqrt(2 * opening / curvature)
        return max(float(brentq(residual, half * (1 + 1e-9), far)), LEAST_MARGIN * half)

    flat = 0.0 if hertz is None else hertz.approach / (hertz.approach + film)
    inlet = INLET[0] + flat * (INLET[1] - INLET[0])
    longer = 1.0 if hertz is None else min(max(hertz.semi_axes[1] / hertz.semi_axes[0] / LONG, 1.0), LONGEST_INLET)
    # with oblique entrainment oil comes from the side, too: across a contact that is long along x most of it
    across = direction[1] ** 2
    if hertz is not None and direction[1] > 0:
        along, beside = (half * part for half, part in zip(hertz.semi_axes, direction[::-1], strict=True))
        across = max(across, along**2 / (along**2 + beside**2))
    below = SIDE + across * (inlet - SIDE)
    end = OUTLET + direction[1] ** 2 * (SIDE - OUTLET)
    return -distance(False, longer * inlet), distance(False, end), -distance(True, below), distance(True, SIDE)
