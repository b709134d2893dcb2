"""Frictionless contact of a round shaft in a slightly larger round hole: pressure and contact angle at any clearance.

Small displacements at the common radius R, plane strain. The hole is in an infinite body, or in a bush that is bonded
to an infinite elastic or rigid housing. Under a pressure p cos(n angle) a surface moves along the radius by a
flexibility times p cos(n angle), by Michell's stress functions (Timoshenko and Goodier, Theory of Elasticity, quoted
from memory):

    shaft        R/(4 G) [1/(n - 1) + kappa/(n + 1)],    n >= 2
    hole         R/(4 G) [kappa/(n - 1) + 1/(n + 1)],    n >= 2,    kappa = 3 - 4 nu

n = 1 moves the bodies as a whole, so that how the load enters them matters only where it deforms them otherwise. The
sums over n are closed: a logarithm, which both bodies have, and a jump, which vanishes with Dundurs' beta. The finite
wall adds a rapidly decaying sum. With Chebyshev nodes over the contact and weights that integrate logarithm and jump
exactly the error falls exponentially with the number of nodes for beta = 0, and with their sixth power otherwise.
Verified in tests/contact/test_shaft_in_bush.py: the closed form of `pin_in_hole` for beta = 0, Hertz, and displacements
of bush and shaft by Navier's equations along the radius; and by gates against contacts in finite elements
(`bem.verification.bush`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from bem.errors import InputError
from bem.materials import Material, contact_modulus

NODES = 48
"""Nodes over the contact; pressures of 48 and 96 nodes agree to 1e-8, under a wall of 2 % of the radius to 1e-6."""
_MIN_HALF_ANGLE, _MAX_HALF_ANGLE = 1e-3, 2.6
"""Half-angles between which a load is sought [rad]: below, contacts are those of Hertz to 1e-6; above them no
contact with clearance is found."""
_MAX_TRIALS, _LOAD_TOLERANCE = 100, 1e-10
"""Half-angles that are tried at most, and the relative deviation of the load at which one is found."""
_ANGLE_RESOLUTION = 1e-14
"""Relative width of a bracket of half-angles at which the search ends: no load is found between its ends."""
_MIN_WALL = 0.001
"""Thinnest wall over the radius whose harmonics are summed: it takes 20 000 of them."""
_CYLINDER_SCALE = 10.0
"""Radii of the equivalent cylinder over those of shaft and bush: the effect of conformity is a hundredth."""
_BORE_SCALE = 12.0
"""Radius of a cylinder on a flat over that of the bore in which it is solved."""
_DECAY = 40.0
"""Harmonics of a wall are summed until they have fallen by exp of this, to 4e-18."""


@dataclass(frozen=True)
class ShaftInBush:
    """Shaft and bush.

    Attributes
    ----------
    shaft, bush : materials.
    radius : of the bore [m].
    clearance : difference of the radii of bore and shaft [m]; positive.
    wall : thickness of the bush [m]; None for an infinite body of its material.
    housing : material around a bush with a wall; None for a rigid one.

    Raises
    ------
    InputError : crystals, surface tension, or lengths of no bush.
    """

    shaft: Material
    bush: Material
    radius: float
    clearance: float
    wall: float | None = None
    housing: Material | None = None
    _most_clearance: ClassVar[float] = 0.1

    def __post_init__(self) -> None:
        for material in (self.shaft, self.bush, self.housing):
            if material is not None and not material.boussinesq:
                raise InputError(
                    f"shaft in a bush: {material.name} is a crystal or has surface tension; allowed: isotropic "
                    "materials without it"
                )
        if not 0 < self.radius < math.inf:
            raise InputError(f"bush of radius {self.radius:g} m; allowed: a positive radius")
        if not 0 < self.clearance < self._most_clearance * self.radius:
            raise InputError(
                f"clearance {self.clearance:g} m of a bush of radius {self.radius:g} m; allowed: positive, and below a "
                "tenth of the radius"
            )
        if self.wall is not None and not _MIN_WALL * self.radius < self.wall < math.inf:
            raise InputError(
                f"wall {self.wall:g} m; allowed: above {_MIN_WALL:g} of the radius of the bore, or None for a body "
                "without end"
            )

    @property
    def equivalent_radius(self) -> float:
        """Radius of the cylinder on a flat with the same gap near the load line [m]."""
        return self.radius * (self.radius - self.clearance) / self.clearance

    @property
    def cylinder(self) -> ShaftInBush:
        """Nearly the cylinder on a flat, under its layer if the bush has a wall, with the same gap near the load line.

        Radii are ten times larger and the gap near the load line, clearance/radius^2, is that of the equivalent radius:
        the effect of conformity falls with the square of the angle.
        """
        radius = _CYLINDER_SCALE * self.radius
        clearance = radius**2 / self.equivalent_radius
        return _CylinderOnFlat(self.shaft, self.bush, radius, clearance, self.wall, self.housing)

    @property
    def modulus(self) -> float:
        """Contact modulus of shaft and bush [Pa]."""
        return contact_modulus(self.shaft, self.bush)


class _CylinderOnFlat(ShaftInBush):
    """Bodies of any clearance, of which only the gap near the load line counts."""

    _most_clearance = math.inf


@dataclass(frozen=True)
class ShaftContact:
    """Contact of a shaft in a bush under a load.

    Attributes
    ----------
    load : per length [N/m].
    half_angle : of the contact [rad].
    maximum_pressure : [Pa].
    angles, pressures : pressure at nodes across the contact [rad], [Pa].
    """

    load: float
    half_angle: float
    maximum_pressure: float
    angles: NDArray[np.float64]
    pressures: NDArray[np.float64]


def solve_shaft_in_bush(bodies: ShaftInBush, load: float, *, nodes: int = NODES) -> ShaftContact:
    """Solve the contact under a load per length [N/m].

    Raises
    ------
    InputError : a load that is not positive, or under which the contact would go nearly all around.
    """
    if not 0 < load < math.inf:
        raise InputError(f"load {load:g} N/m of a shaft in a bush; allowed: a positive load")
    wall = _WallSeries.of(bodies)
    low, high = _MIN_HALF_ANGLE, _MAX_HALF_ANGLE
    first = _contact_over(bodies, low, nodes, wall)
    if load <= first.load:  # Hertz: the load grows with the square of the half-angle
        return _contact_over(bodies, low * math.sqrt(load / first.load), nodes, wall)
    # the load grows about as the square of the half-angle; none is positive beyond that of a shaft without clearance
    below, tried, found = first, math.sqrt(load / first.load) * low, first
    for _ in range(_MAX_TRIALS):
        if not low < tried < high:
            tried = math.sqrt(low * high)
        found = _contact_over(bodies, tried, nodes, wall)
        if math.isclose(found.load, load, rel_tol=_LOAD_TOLERANCE):
            return found
        slope = 2.0
        if found.load > below.load:
            slope = math.log(found.load / below.load) / math.log(found.half_angle / below.half_angle)
        if 0 < found.load < load:
            low, below = tried, found
        else:
            high = tried
        if high - low < _ANGLE_RESOLUTION * high:
            break
        tried = 0.0 if found.load <= 0 else found.half_angle * (load / found.load) ** (1 / slope)
    raise InputError(
        f"load {load:g} N/m: shaft and bush would touch over {math.degrees(2 * high):.0f} degrees, as without "
        "clearance; allowed: a smaller load, or more clearance"
    )


def cylinder_on_layer(
    cylinder: Material, layer: Material, substrate: Material, *, thickness: float, radius: float, load: float
) -> tuple[float, float]:
    """Return half-width [m] and highest pressure [Pa] of a cylinder on a layer that is bonded to a substrate.

    thickness : of the layer [m]. radius : of relative curvature [m]. load : per length [N/m].
    The cylinder lies in a bore of a twelfth of the radius. Its curvature makes the contact 0.05 % narrower under the
    wall of a PEEK bush, and 2 % where the half-width is 0.04 of the radius.

    Raises
    ------
    InputError : as `ShaftInBush` and `solve_shaft_in_bush`.
    """
    bore = radius / _BORE_SCALE
    found = solve_shaft_in_bush(ShaftInBush(cylinder, layer, bore, bore**2 / radius, thickness, substrate), load)
    return found.half_angle * bore, found.maximum_pressure


def modulus_on_layer(
    cylinder: Material, layer: Material, substrate: Material, *, thickness: float, radius: float, load: float
) -> float:
    """Return the contact modulus [Pa] of half-spaces on which a cylinder is as wide as on a layer on a substrate.

    Parameters and errors as of `cylinder_on_layer`.
    """
    half_width, _ = cylinder_on_layer(cylinder, layer, substrate, thickness=thickness, radius=radius, load=load)
    return 4 * load * radius / (math.pi * half_width**2)


def _contact_over(bodies: ShaftInBush, half: float, nodes: int, wall: _WallSeries) -> ShaftContact:
    """Return the contact over a half-angle [rad], whatever its load.

    The unknowns are the pressure at the nodes times sqrt(1 - x^2) and the shift of the shaft. The equations are that of
    the closed gap at every node, and that the pressure vanishes at the ends of the contact.
    """
    turn = math.pi * (np.arange(nodes) + 0.5) / nodes  # arccos of the nodes of the contact, from -1 to 1
    angle = half * np.cos(turn)
    orders = np.arange(1, nodes)
    chebyshev = np.cos(orders[:, None] * turn)  # T_n at the nodes, n >= 1
    kernel = _influence(bodies, half, turn) + math.pi / nodes * wall.sum(angle)
    matrix = np.zeros((nodes + 1, nodes + 1))
    scale = bodies.radius / bodies.modulus
    matrix[:nodes, :nodes] = half / (math.pi * scale) * kernel
    matrix[:nodes, nodes] = -np.cos(angle)
    matrix[nodes, :nodes] = (1 + 2 * chebyshev.sum(axis=0)) / nodes  # the density at x = 1
    right = np.zeros(nodes + 1)
    # over the distance of the shaft from a bore that it would fill: -clearance, less the clearance's part along cos,
    # which leaves no difference of nearly equal numbers at small angles
    right[:nodes] = -bodies.clearance / scale * 2 * np.sin(0.5 * angle) ** 2
    density = np.linalg.solve(matrix, right)[:nodes]  # pressure times sqrt(1 - x^2)
    load = half * bodies.radius * math.pi / nodes * float(density @ np.cos(angle))
    coefficients = np.concatenate([[np.mean(density)], 2 / nodes * chebyshev @ density])
    at_middle = np.cos(0.5 * math.pi * np.arange(nodes))  # T_n at x = 0
    return ShaftContact(load, half, float(at_middle @ coefficients), angle, density / np.sin(turn))


def _influence(bodies: ShaftInBush, half: float, turn: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the widening of the gap by densities at the nodes, times pi over the half-angle, (nodes, nodes) [m/Pa].

    Of a bush without a wall; the density is the pressure times sqrt(1 - x^2).

    half : half-angle of the contact [rad]. turn : arccos of the nodes, (nodes,) [rad].
    """
    nodes = len(turn)
    angle = half * np.cos(turn)
    apart = angle[:, None] - angle[None, :]
    log_weights, jump_weights = _weights(turn)
    plain = math.pi / nodes
    quarter = 0.25 * bodies.radius
    shaft, bush = bodies.shaft, bodies.bush
    kappa_shaft, kappa_bush = 3 - 4 * shaft.poissons_ratio, 3 - 4 * bush.poissons_ratio
    less = quarter * (1 / shaft.shear_modulus + kappa_bush / bush.shear_modulus)  # of 1/(n - 1)
    more = quarter * (kappa_shaft / shaft.shear_modulus + 1 / bush.shear_modulus)  # of 1/(n + 1)
    mean = quarter * ((kappa_shaft - 1) / shaft.shear_modulus + 2 / bush.shear_modulus)
    cosine, sine = np.cos(apart), np.sin(apart)
    # -ln|2 sin(apart/2)| = -ln|x - x'| - ln(2 sin(apart/2)/(x - x'))
    ratio = half * np.sinc(0.5 * apart / math.pi)
    logarithm = -log_weights - plain * np.log(ratio)
    jump = 0.5 * math.pi * jump_weights - 0.5 * plain * apart
    kernel: NDArray[np.float64] = (less + more) * cosine * logarithm + (more - less) * sine * jump
    kernel += plain * (0.5 * mean - more * (1 + 0.5 * cosine))
    return kernel


def _weights(turn: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the weights of ln|x - x'| and of sign(x - x') at the nodes x by densities at the nodes x', (nodes, nodes).

    The integrals of a density over sqrt(1 - x'^2) are exact for polynomials of a degree below the number of nodes.
    """
    nodes = len(turn)
    orders = np.arange(1, nodes)
    values, sines = np.cos(orders[:, None] * turn), np.sin(orders[:, None] * turn)
    log_weights = math.pi / nodes * (-math.log(2) - 2 * (values.T / orders) @ values)
    jump_weights = ((math.pi - 2 * turn)[:, None] - 4 * (sines.T / orders) @ values) / nodes
    return log_weights, jump_weights


@dataclass(frozen=True)
class _WallSeries:
    """Flexibility of a bush with a wall less that of an infinite body of its material, by harmonic, over the pressure.

    constant : of the mean pressure [m/Pa]. harmonics : from n = 2 on [m/Pa].
    """

    constant: float
    harmonics: NDArray[np.float64]

    @classmethod
    def of(cls, bodies: ShaftInBush) -> _WallSeries:
        """Return the series of a pair of bodies, empty without a wall."""
        if bodies.wall is None:
            return cls(0.0, np.zeros(0))
        count = math.ceil(0.5 * _DECAY / math.log1p(bodies.wall / bodies.radius))
        return cls(_bush_mean(bodies), _bush_harmonics(bodies, np.arange(2, max(count, 8))))

    def sum(self, angle: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the sum over all harmonics at the differences of all pairs of angles [rad]."""
        turns = np.outer(angle, np.arange(2, 2 + len(self.harmonics)))
        cosines, sines = np.cos(turns), np.sin(turns)
        return 0.5 * self.constant + (cosines * self.harmonics) @ cosines.T + (sines * self.harmonics) @ sines.T


def _bush_mean(bodies: ShaftInBush) -> float:
    """Return the flexibility of the bush under uniform pressure less that of the infinite body (Lamé)."""
    assert bodies.wall is not None
    radius, outer = bodies.radius, bodies.radius + bodies.wall
    shear, kappa = bodies.bush.shear_modulus, 3 - 4 * bodies.bush.poissons_ratio
    # displacement A r + B/r, radial stress 4 G A/(kappa - 1) - 2 G B/r^2; the housing moves q outer/(2 G_housing)
    stretch = 4 * shear / (kappa - 1)
    around = 0.0 if bodies.housing is None else outer / (2 * bodies.housing.shear_modulus)
    matrix = np.array([
        [stretch, -2 * shear / radius**2],
        [outer + around * stretch, 1 / outer - around * 2 * shear / outer**2],
    ])  # fmt: skip
    a, b = np.linalg.solve(matrix, [-1.0, 0.0])
    return float(a * radius + b / radius - radius / (2 * shear))


def _bush_harmonics(bodies: ShaftInBush, orders: NDArray[np.int_]) -> NDArray[np.float64]:
    """Return the flexibility of the bush under cos(n angle) less that of the infinite body, n >= 2 [m/Pa].

    Michell's functions r^n, r^(n+2), r^-n, r^(2-n) of radii over the bore's; rising ones are scaled at the outer,
    falling ones at the inner radius, and those of the housing at the outer one.
    """
    assert bodies.wall is not None
    n = orders.astype(float)
    shear, kappa = bodies.bush.shear_modulus, 3 - 4 * bodies.bush.poissons_ratio
    outer = 1 + bodies.wall / bodies.radius
    inner_rows, outer_rows = _michell(n, kappa, 1.0, outer, 1.0), _michell(n, kappa, outer, outer, 1.0)
    size = 4 if bodies.housing is None else 6
    matrix, right = np.zeros((len(n), size, size)), np.zeros((len(n), size, 1))
    matrix[:, :2, :4] = inner_rows[:, :2]
    right[:, 0] = -1.0
    matrix[:, 2:4, :4] = outer_rows[:, 2:]
    if bodies.housing is not None:
        beyond = _michell(n, 3 - 4 * bodies.housing.poissons_ratio, outer, outer, outer)[:, :, 2:]
        matrix[:, 2:4, 4:] = -beyond[:, 2:] * shear / bodies.housing.shear_modulus
        matrix[:, 4:6, :4], matrix[:, 4:6, 4:] = outer_rows[:, :2], -beyond[:, :2]
    found = np.linalg.solve(matrix, right)[:, :4, 0]
    moved = np.sum(inner_rows[:, 2] * found, axis=1) / (2 * shear)
    infinite: NDArray[np.float64] = (kappa / (n - 1) + 1 / (n + 1)) / (4 * shear)
    return bodies.radius * (moved - infinite)


def _michell(n: NDArray[np.float64], kappa: float, radius: float, rising: float, falling: float) -> NDArray[np.float64]:
    """Return radial stress, shear stress and both displacements times 2 G of the four functions at a radius, (n, 4, 4).

    rising, falling : radii at which the powers n and -n are one.
    """
    rise, fall = (radius / rising) ** n, (radius / falling) ** -n
    square = 1 / radius**2
    up, down = n * (n - 1), n * (n + 1)
    rows = np.array([
        [-up * rise * square, -(n + 1) * (n - 2) * rise, -down * fall * square, -(n - 1) * (n + 2) * fall],
        [up * rise * square, down * rise, -down * fall * square, -up * fall],
        [-n * rise / radius, (kappa - n - 1) * rise * radius, n * fall / radius, (kappa + n - 1) * fall * radius],
        [n * rise / radius, (kappa + n + 1) * rise * radius, n * fall / radius, (n - kappa - 1) * fall * radius],
    ])  # fmt: skip
    return np.moveaxis(rows, -1, 0)
