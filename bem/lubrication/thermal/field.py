"""Energy equation along and across a film: finite volumes of temperature, between two moving half-spaces.

m columns along the entrainment of K even layers each, and the surfaces above and below:

    d/dx (c rho u T) + d/dz (c rho w T) = k d2T/dz2 + heat.

1. The flow across the layers follows from continuity, so that oil that turns round in the inlet carries its heat with
   it. Oil through a face has the temperature extrapolated from the two volumes upstream. Conduction along the film, h/l
   times that across, is left out.
2. At the walls the flux is that of the parabola through the wall and two layers; it enters bodies whose surfaces follow
   `bem.heat.operators`. Second order in both directions. Supplied oil has the temperature of the supply.
3. Newton's method on all temperatures: each step a banded system (LAPACK), with the distant warming of the surfaces by
   GMRES around it. Damping (`DampingControl`) where heat feeds itself.

Verified in tests/lubrication/test_full_thermal.py.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg.lapack import dgbtrf, dgbtrs

from bem.grid import FloatArray
from bem.heat.bodies import Conductor
from bem.heat.line_contact import band_temperatures
from bem.numerics.gmres import gmres

MAX_STEPS = 200
"""Largest number of Newton steps."""
WILD_STEP = 150.0
"""Change of a temperature [K] above which a step is discarded and repeated with full damping."""
NEAR = 1e-2
"""Change over the largest rise, below which no wild step is expected."""
LONGEST_STEP = 60.0
"""Longest change of a temperature in one step [K]."""
TOLERANCE = 1e-10
"""Last change over the largest rise."""
DAMPING_DECAY = 0.3
"""Factor of the damping after a good step."""
LEAST_DAMPING = 0.01
"""Damping below which there is none."""
SHORTEST_STEP, LONGEST_FACTOR = 0.125, 3.0
"""Shortest and longest factor of a step."""
LEAST_RISE = 1e-7
"""Largest rise [K] below which only rounding is left."""
SURFACE_TOLERANCE = 1e-3
"""Tolerance of the surface temperatures in a step, over its length."""
APPLICATIONS = 120
"""Largest number of GMRES applications."""
_NEIGHBOURS = 2
"""Columns on either side that a volume depends on."""


@dataclass(frozen=True)
class EnergyGeometry:
    """Geometry and properties of the film for the energy equation.

    edges : (m+1,) of the columns along the entrainment [m].
    inverse_thickness : (m,) integral of 1/h over the columns.
    conductivity, capacity : of the oil [W/(m K)], by volume [J/(m^3 K)].
    supply : temperature of the supplied oil [K].
    bodies : below and above. layers : K.
    surface_response : (2, m, m) temperature of the surfaces per heat into the columns [K m/W].
    """

    edges: FloatArray
    inverse_thickness: FloatArray
    conductivity: float
    capacity: float
    supply: float
    bodies: tuple[Conductor, Conductor]
    layers: int
    surface_response: FloatArray

    @property
    def columns(self) -> int:
        """Number of columns m."""
        return len(self.edges) - 1

    @cached_property
    def width(self) -> FloatArray:
        """Widths of the columns (m,) [m]."""
        return np.diff(self.edges)

    @property
    def centres(self) -> FloatArray:
        """Centres of the columns (m,) [m]."""
        return np.asarray(0.5 * (self.edges[1:] + self.edges[:-1]))

    @cached_property
    def layer_conductance(self) -> FloatArray:
        """Conductance between two layers (m,) [W/(m K)]."""
        return np.asarray(self.conductivity * self.inverse_thickness * self.layers)

    @cached_property
    def bulk(self) -> FloatArray:
        """Bulk temperatures of the bodies (2, 1) [K]."""
        return np.array([[body.bulk] for body in self.bodies])

    def wall_heat(self, temperature: FloatArray) -> FloatArray:
        """Return the heat into both bodies (2, m) [W/m], from temperatures (m, K + 2), walls first and last."""
        t = temperature
        lower = 9 * t[:, 1] - t[:, 2] - 8 * t[:, 0]
        upper = 9 * t[:, -2] - t[:, -3] - 8 * t[:, -1]
        return np.asarray(self.layer_conductance / 3 * np.stack([lower, upper]))

    def surface_temperatures(self, into: FloatArray) -> FloatArray:
        """Return the temperatures of both surfaces (2, m) [K], from heat into them (2, m) [W/m]."""
        return self.bulk + np.stack([one @ heat for one, heat in zip(self.surface_response, into, strict=True)])


def surface_responses(edges: FloatArray, bodies: tuple[Conductor, Conductor]) -> FloatArray:
    """Return `EnergyGeometry.surface_response` of columns between edges (m+1,) [m]."""
    return np.stack([band_temperatures(edges, body) / np.diff(edges) for body in bodies])


@dataclass(frozen=True)
class HeatLinearisation:
    """Heat and its derivatives at temperatures of the volumes (m, K); temperatures at the edges are linear between
    them.

    flux : (m+1, K) flow through the edges of the columns [m^2/s].
    flux_slope : (m+1, K, K) its derivatives with the temperatures there.
    heat : (m, K) generated in the volumes [W/m].
    sliding_slope, flow_slope : (3, m, K, K) derivatives of the heat of sliding, and of the rest, with the temperatures
        of the column before, the own column and the next.
    growth : (m, K) positive part of the derivative of a volume's heat with its own temperature.
    share : (m+1,) of the column behind an edge in the temperature there.
    """

    flux: FloatArray
    flux_slope: FloatArray
    heat: FloatArray
    sliding_slope: FloatArray
    flow_slope: FloatArray
    growth: FloatArray
    share: FloatArray


Heat = Callable[[FloatArray], HeatLinearisation]
"""Function of temperatures of the volumes (m, K) [K]."""


@dataclass(frozen=True)
class Field:
    """Solution of the energy equation.

    rise : (m, K + 2) temperatures over the supply [K], surfaces first and last. flux : (m+1, K) through the edges
        [m^2/s].
    steps : of Newton's method. residual : largest change of the last step, over the largest rise.
    """

    rise: FloatArray
    supply: float
    flux: FloatArray
    steps: int
    residual: float

    @property
    def temperature(self) -> FloatArray:
        """Temperatures (m, K + 2) [K]."""
        return self.supply + self.rise

    @property
    def oil(self) -> FloatArray:
        """Temperatures of the oil (m, K) [K]."""
        return self.temperature[:, 1:-1]


def temperature_field(
    geometry: EnergyGeometry, heat: Heat, start: FloatArray, tolerance: float = TOLERANCE, damping: float = 1.0
) -> Field:
    """Solve the energy equation from a guess of the temperatures (m, K + 2) [K].

    Far from the solution a layer that gets warmer takes more of the sliding and gets warmer still: Newton's equations
    are indefinite there. That growth, and the effect of temperatures on the flow, are damped by a share `damping` at
    first, by none in the end (`DampingControl`).
    """
    temperature = start - geometry.supply
    rest = np.stack([one - np.diag(np.diag(one)) for one in geometry.surface_response])
    distant = _distant_warming(rest, geometry.wall_heat(temperature))
    residual, steps, rise, control = np.inf, 0, 1.0, DampingControl(damping, np.zeros_like(temperature))
    while True:
        sources = heat(geometry.supply + temperature[:, 1:-1])
        blocks = _slope_blocks(geometry, sources, temperature, control.damping)
        goal = SURFACE_TOLERANCE * min(residual, 1.0) * rise
        known = _right_side(sources, blocks, temperature)
        found, distant = _with_surfaces(
            geometry, BandedSystem.of(geometry, sources, blocks), rest, known, distant, goal
        )
        change = found - temperature
        rise = max(float(np.ptp(found)), LEAST_RISE)
        residual = float(np.abs(change).max()) / rise
        steps += 1
        if (control.damping == 0 and residual <= tolerance) or steps == MAX_STEPS or not np.isfinite(residual):
            break
        if not control.must_restart(residual * rise):
            control.update(change, residual, tolerance)
            temperature = temperature + control.length * np.clip(change, -LONGEST_STEP, LONGEST_STEP)
    return Field(found, geometry.supply, heat(geometry.supply + found[:, 1:-1]).flux, steps, residual)


@dataclass
class DampingControl:
    """Damping and length of the steps of `temperature_field`, from the steps before.

    Oil that warms from cold takes many steps in one direction with full damping: these are lengthened, and damping is
    released the later, the more often its release led to a wild step.

    before, last : change [K] and residual of the last step. wait : steps until damping is released; patience : the same
        after the next wild step.
    """

    damping: float
    before: FloatArray
    last: float = np.inf
    length: float = 1.0
    wait: int = 0
    patience: int = 1

    def must_restart(self, longest: float) -> bool:
        """Return True if a step whose largest change is `longest` [K] must be repeated with full damping."""
        if self.damping == 1 or longest <= WILD_STEP:
            return False
        self.damping, self.length, self.wait, self.patience = 1.0, 1.0, self.patience, 2 * self.patience
        return True

    def update(self, change: FloatArray, residual: float, tolerance: float) -> None:
        """Set the length of this step and the damping of the next one."""
        onward = self.damping == 1 and float(np.vdot(change, self.before)) > 0
        self.wait -= 1
        if residual <= tolerance:
            self.damping, self.length = 0.0, 1.0
        elif self.damping == 1 and self.wait > 0 and residual > NEAR:
            self.length = min(1.5 * self.length, LONGEST_FACTOR) if onward else max(0.5 * self.length, SHORTEST_STEP)
        elif residual < self.last or onward:
            self.damping = self.damping * DAMPING_DECAY if self.damping > LEAST_DAMPING else 0.0
            self.length = min(2 * self.length, 1.0)
        else:
            self.damping = min(max(self.damping, LEAST_DAMPING) / DAMPING_DECAY**2, 1.0)
            self.length = max(0.5 * self.length, SHORTEST_STEP)
        self.before, self.last = change, residual


def heat_carried(geometry: EnergyGeometry, flux: FloatArray, oil: FloatArray) -> float:
    """Return the heat that the oil carries out, less what it brings [W/m].

    Through the last edge and, where oil turns round in the inlet, the first one; flux (m+1, K), oil : temperatures over
    the supply (m, K).
    """
    along = _at_faces(geometry, flux, np.pad(oil, ((0, 0), (1, 1)), mode="edge"))[0]
    return geometry.capacity * float(flux[-1] @ along[-1] - flux[0] @ along[0])


def _distant_warming(rest: FloatArray, into: FloatArray) -> FloatArray:
    """Return the temperatures of the surfaces (2, m) [K] by heat into other columns."""
    return np.stack([one @ heat for one, heat in zip(rest, into, strict=True)])


def _with_surfaces(
    geometry: EnergyGeometry,
    solver: BandedSystem,
    rest: FloatArray,
    known: FloatArray,
    distant: FloatArray,
    goal: float,
) -> tuple[FloatArray, FloatArray]:
    """Solve a step: temperatures, and the distant warming of the surfaces (2, m) [K] by the heat into them."""

    def solved(warmer: FloatArray) -> FloatArray:
        right = known.copy()
        right[:, 0], right[:, -1] = geometry.bulk[:, 0, None] - geometry.supply + warmer
        return solver(right)

    shape = distant.shape
    none = np.zeros_like(distant)
    base = _distant_warming(rest, geometry.wall_heat(solved(none)))

    def missed(values: FloatArray) -> FloatArray:
        warmer = values.reshape(shape)
        return (warmer - _distant_warming(rest, geometry.wall_heat(solved(warmer))) + base).ravel()

    found = gmres(missed, base.ravel(), lambda r: r, distant.ravel(), goal, APPLICATIONS).values.reshape(shape)
    return solved(found), found


def _right_side(sources: HeatLinearisation, blocks: FloatArray, temperature: FloatArray) -> FloatArray:
    """Return the right-hand side (m, K + 2): heat, linear about the temperatures.

    Temperatures are over the supply, so that supplied oil brings none, and small rises are not lost in rounding.
    """
    right, oil = np.zeros_like(temperature), temperature[:, 1:-1]
    right[:, 1:-1] = sources.heat + _apply_blocks(blocks, oil)
    return right


def _apply_blocks(blocks: FloatArray, oil: FloatArray) -> FloatArray:
    """Return blocks (3, m, K, K) of the column before, the own one and the next, times temperatures (m, K)."""
    out = np.einsum("jkl,jl->jk", blocks[1], oil)
    out[1:] += np.einsum("jkl,jl->jk", blocks[0, 1:], oil[:-1])
    out[:-1] += np.einsum("jkl,jl->jk", blocks[2, :-1], oil[1:])
    return np.asarray(out)


def _slope_blocks(
    geometry: EnergyGeometry, sources: HeatLinearisation, temperature: FloatArray, damping: float
) -> FloatArray:
    """Return the derivatives of the balances with the temperatures by way of heat and flow, (3, m, K, K): less heat,
    more outflow."""
    blocks = -sources.sliding_slope - (1 - damping) * sources.flow_slope
    layer = np.arange(geometry.layers)
    blocks[1][:, layer, layer] += damping * sources.growth
    if damping == 1:
        return blocks
    along, crossing = _at_faces(geometry, sources.flux, temperature)
    share = sources.share[:, None, None]
    for edge, sign in ((slice(1, None), 1.0), (slice(None, -1), -1.0)):
        bent = (1 - damping) * sign * geometry.capacity * sources.flux_slope[edge]
        # what more flows along a layer has crossed from one to the next
        crossed = np.cumsum(bent, axis=1)[:, :-1] * crossing[:, :, None]
        out = bent * along[edge][:, :, None]
        out[:, :-1] -= crossed
        out[:, 1:] += crossed
        before, behind = (1 - share[edge]) * out, share[edge] * out
        if sign > 0:  # between this column and the next; the last edge extrapolates
            blocks[1, :-1] += before[:-1]
            blocks[2, :-1] += behind[:-1]
            blocks[0, -1] += before[-1]
            blocks[1, -1] += behind[-1]
        else:
            blocks[0, 1:] += before[1:]
            blocks[1, 1:] += behind[1:]
            blocks[1, 0] += before[0] + behind[0]
    return blocks


def _at_faces(geometry: EnergyGeometry, flux: FloatArray, temperature: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the temperatures over the supply of the flow through the edges (m+1, K) and from layer to layer (m,
    K-1)."""
    oil, (ahead, back) = temperature[:, 1:-1], _extrapolations(geometry.width)
    along = np.empty_like(flux)
    before, behind = np.vstack([oil[:1], oil]), np.vstack([oil, oil[-1:]])
    before[2:] += ahead[2:, None] * (oil[1:] - oil[:-1])
    before[0] = 0.0
    behind[1:-2] += back[1:-2, None] * (oil[1:-1] - oil[2:])
    along = np.where(flux > 0, before, behind)
    up, down = 1.5 * oil[:, :-1], 1.5 * oil[:, 1:]
    up[:, 1:] -= 0.5 * oil[:, :-2]
    up[:, 0] = 2 * oil[:, 0] - temperature[:, 0]
    down[:, :-1] -= 0.5 * oil[:, 2:]
    down[:, -1] = 2 * oil[:, -1] - temperature[:, -1]
    return along, np.where(_upward(flux) > 0, up, down)


def _extrapolations(width: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the extrapolation factors (m+1,) of flow along and against the numbering; zero with one column
    upstream."""
    ahead, back = np.zeros(len(width) + 1), np.zeros(len(width) + 1)
    ahead[2:] = width[1:] / (width[1:] + width[:-1])
    back[1:-2] = width[1:-1] / (width[1:-1] + width[2:])
    return ahead, back


def _upward(flux: FloatArray) -> FloatArray:
    """Return the flow from layer to layer (m, K-1) [m^2/s], by continuity."""
    return np.asarray(-np.cumsum(np.diff(flux, axis=0), axis=1)[:, :-1])


@dataclass(frozen=True)
class BandedSystem:
    """LU factors of a banded linear system of temperatures (m, K + 2)."""

    factors: FloatArray
    pivots: FloatArray
    half: int

    @classmethod
    def of(cls, geometry: EnergyGeometry, sources: HeatLinearisation, blocks: FloatArray) -> BandedSystem:
        """Return the factors of the balances of the volumes and of the surfaces with their own heat alone."""
        own, along = _own_blocks(geometry, sources.flux), _along_coefficients(geometry, sources.flux)
        m, size = own.shape[:2]
        inner = np.arange(1, size - 1)
        own[:, inner, inner] += along[0]
        own[:, 1:-1, 1:-1] += blocks[1]
        half = _NEIGHBOURS * size
        band = np.zeros((3 * half + 1, m * size))
        row, column = np.meshgrid(np.arange(size), np.arange(size), indexing="ij")
        at = np.arange(m)[:, None, None] * size
        band[2 * half + row - column, at + column] = own
        row, column = row[1:-1, 1:-1], column[1:-1, 1:-1]
        for step, block in ((-1, blocks[0, 1:]), (1, blocks[2, :-1])):
            block[:, inner - 1, inner - 1] += along[step][1:] if step < 0 else along[step][:-1]
            to = (np.arange(m - 1)[:, None, None] + (step > 0)) * size
            band[2 * half - step * size + row - column, to + column] = block
        for step in (-2, 2):
            here = np.arange(max(0, -step), min(m, m - step))
            band[2 * half - step * size, (here + step)[:, None] * size + inner] = along[step][here]
        factors, pivots, info = dgbtrf(band, half, half, overwrite_ab=True)
        if info != 0:
            factors = np.full_like(factors, np.nan)
        return cls(factors, pivots, half)

    def __call__(self, right: FloatArray) -> FloatArray:
        """Return the solution for a right-hand side (m, K + 2)."""
        found = dgbtrs(self.factors, self.half, self.half, right.ravel(), self.pivots)[0]
        return np.asarray(found).reshape(right.shape)


def _own_blocks(geometry: EnergyGeometry, flux: FloatArray) -> FloatArray:
    """Return the coefficients of conduction and of flow across the layers, in the temperatures of the own column (m, K
    + 2, K + 2)."""
    m, layers = geometry.columns, geometry.layers
    own = np.zeros((m, layers + 2, layers + 2))
    between, inner = geometry.layer_conductance[:, None], np.arange(1, layers + 1)
    own[:, inner[:-1], inner[:-1]] += between
    own[:, inner[:-1], inner[1:]] -= between
    own[:, inner[1:], inner[1:]] += between
    own[:, inner[1:], inner[:-1]] -= between
    # the flux into a wall is linear in the wall and two layers
    for wall, near, next_, body in ((0, 1, 2, 0), (-1, -2, -3, 1)):
        share = np.diagonal(geometry.surface_response[body])
        for place, factor in ((wall, -8.0), (near, 9.0), (next_, -1.0)):
            into = geometry.layer_conductance * factor / 3
            own[:, near, place] += into
            own[:, wall, place] -= share * into
        own[:, wall, wall] += 1.0
    upward = geometry.capacity * _upward(flux)
    for below in range(1, layers):  # the face between layers `below` and `below + 1`
        up, down = np.maximum(upward[:, below - 1], 0.0), np.minimum(upward[:, below - 1], 0.0)
        # of the two places upstream; the wall is half as far as the next layer
        first, second = (1.5, -0.5) if below > 1 else (2.0, -1.0)
        third, fourth = (1.5, -0.5) if below < layers - 1 else (2.0, -1.0)
        for at, sign in ((below, 1.0), (below + 1, -1.0)):
            own[:, at, below] += sign * up * first
            own[:, at, below - 1] += sign * up * second
            own[:, at, below + 1] += sign * down * third
            own[:, at, below + 2] += sign * down * fourth
    return own


def _along_coefficients(geometry: EnergyGeometry, flux: FloatArray) -> dict[int, FloatArray]:
    """Return the coefficients of convection along the film, by distance in columns: (m, K) each."""
    m = geometry.columns
    out = {step: np.zeros((m, geometry.layers)) for step in range(-_NEIGHBOURS, _NEIGHBOURS + 1)}
    ahead, back = _extrapolations(geometry.width)
    forward, backward = geometry.capacity * np.maximum(flux, 0.0), geometry.capacity * np.minimum(flux, 0.0)
    taken, brought = forward[1:], -forward[1:-1]  # through the faces behind and before a column
    out[0] += taken * (1 + ahead[1:, None])
    out[-1][1:] -= (taken * ahead[1:, None])[1:]
    out[-1][1:] += brought * (1 + ahead[1:-1, None])
    out[-2][2:] -= (brought * ahead[1:-1, None])[1:]
    taken, brought = -backward[:-1], backward[1:-1]
    out[0] += taken * (1 + back[:-1, None])
    out[1][:-1] -= (taken * back[:-1, None])[:-1]
    out[1][:-1] += brought * (1 + back[1:-1, None])
    out[2][:-2] -= (brought * back[1:-1, None])[:-1]
    out[0][-1] += backward[-1]
    return out
