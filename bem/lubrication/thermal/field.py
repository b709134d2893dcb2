"""Heat along and across a film: finite volumes of temperature, between two moving half-spaces.

m columns along the entrainment of K even layers each, and the surfaces above and below:

    d/dx (c rho u T) + d/dz (c rho w T) = k d2T/dz2 + made,

with the flow across the layers from what comes and leaves along them, so that the oil that turns round in the inlet
takes its heat with it. What flows through a face has the temperature extrapolated from the two volumes upstream of it,
whichever way it flows; conduction along the film, h/l times smaller than that across, is left out. At the walls the
flux is that of the parabola through the wall and two layers, and enters bodies whose surfaces follow
`bem.heat.operators`. Second order in both directions. Oil that comes has the temperature of the supply.

Newton's method on all temperatures: each step a banded system (LAPACK), with the distant warming of the surfaces by
GMRES around it. Verified in tests/lubrication/test_full_thermal.py.
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
WILD = 150.0
"""Step [K] that is not taken but anew with the growth held back."""
NEAR = 1e-2
"""Of a step, over the largest rise, from which no wild step is waited for."""
LONGEST_STEP = 60.0
"""Of a temperature in one step [K]."""
TOLERANCE = 1e-10
"""Of the last step, over the largest rise."""
HELD_LESS = 0.3
LEAST_HELD = 0.01
SHORTEST, LONGEST = 0.125, 3.0
"""Shares of a step that are taken."""
LEAST_RISE = 1e-7
"""From which on rounding is what is left [K]."""
SURFACE_TOLERANCE = 1e-3
"""Of the surfaces in a step, over how far that step goes."""
APPLICATIONS = 120
_REACH = 2
"""Columns on either side that a volume sees."""


@dataclass(frozen=True)
class Duct:
    """The film as a place for heat: edges (m+1,) along the entrainment [m]; integral of 1/h over the columns (m,);
    conductivity [W/(m K)] and heat capacity by volume [J/(m^3 K)] of the oil; its temperature where it comes [K];
    bodies below and above; layers; warming of the surfaces by heat into the columns, (2, m, m) [K m/W]."""

    edges: FloatArray
    slender: FloatArray
    conductivity: float
    capacity: float
    supply: float
    bodies: tuple[Conductor, Conductor]
    layers: int
    warming: FloatArray

    @property
    def columns(self) -> int:
        """m."""
        return len(self.edges) - 1

    @cached_property
    def width(self) -> FloatArray:
        """Of the columns [m]."""
        return np.diff(self.edges)

    @property
    def middles(self) -> FloatArray:
        """Of the columns [m]."""
        return np.asarray(0.5 * (self.edges[1:] + self.edges[:-1]))

    @cached_property
    def across(self) -> FloatArray:
        """Conductance between two layers (m,) [W/(m K)]."""
        return np.asarray(self.conductivity * self.slender * self.layers)

    @cached_property
    def bulk(self) -> FloatArray:
        """Of the bodies (2, 1) [K]."""
        return np.array([[body.bulk] for body in self.bodies])

    def into_walls(self, temperature: FloatArray) -> FloatArray:
        """Heat that enters both bodies (2, m) [W/m], of temperatures (m, K + 2), walls first and last."""
        t = temperature
        lower = 9 * t[:, 1] - t[:, 2] - 8 * t[:, 0]
        upper = 9 * t[:, -2] - t[:, -3] - 8 * t[:, -1]
        return np.asarray(self.across / 3 * np.stack([lower, upper]))

    def surfaces(self, into: FloatArray) -> FloatArray:
        """Temperatures of both surfaces (2, m) [K] of heat into them (2, m) [W/m]."""
        return self.bulk + np.stack([one @ heat for one, heat in zip(self.warming, into, strict=True)])


def warming_of(edges: FloatArray, bodies: tuple[Conductor, Conductor]) -> FloatArray:
    """`Duct.warming` of columns between edges (m+1,) [m]."""
    return np.stack([band_temperatures(edges, body) / np.diff(edges) for body in bodies])


@dataclass(frozen=True)
class Sources:
    """At temperatures of the volumes (m, K), those at the edges linear between them.

    flux : flow through the columns' edges (m+1, K) [m^2/s]; bending : its derivatives with the temperatures there (m+1,
    K, K). made : heat made in the volumes (m, K) [W/m]; slope : derivatives of that of sliding, shifted : those of the
    rest, with the temperatures of the column before, the own one and the next (3, m, K, K). growth : the positive part
    of those of a volume with its own temperature (m, K). share : of the column behind an edge in the temperature there
    (m+1,).
    """

    flux: FloatArray
    bending: FloatArray
    made: FloatArray
    slope: FloatArray
    shifted: FloatArray
    growth: FloatArray
    share: FloatArray


Heat = Callable[[FloatArray], Sources]
"""Of temperatures of the volumes (m, K) [K]."""


@dataclass(frozen=True)
class Field:
    """Temperatures over that of the supply [K] (m, K + 2), those of the surfaces first and last; of their heat: flow
    through the edges (m+1, K) [m^2/s]. steps : of Newton's method. residual : largest change of the last one, over the
    largest rise."""

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
        """Of the volumes (m, K)."""
        return self.temperature[:, 1:-1]


def temperature_field(
    duct: Duct, heat: Heat, start: FloatArray, tolerance: float = TOLERANCE, held: float = 1.0
) -> Field:
    """Temperatures (m, K + 2) [K] at which the heat made goes where it can, from a guess of them.

    Far from the solution a layer that gets warmer takes more of the sliding and gets warmer still: Newton's equations
    are indefinite there. That growth is held back with a share of itself on the temperatures before, and so is what
    temperatures do to the flow: `held` at first, none in the end, see `_Pace`.
    """
    temperature = start - duct.supply
    rest = np.stack([one - np.diag(np.diag(one)) for one in duct.warming])
    distant = _distant(rest, duct.into_walls(temperature))
    residual, steps, rise, pace = np.inf, 0, 1.0, _Pace(held, np.zeros_like(temperature))
    while True:
        sources = heat(duct.supply + temperature[:, 1:-1])
        blocks = _blocks(duct, sources, temperature, pace.held)
        goal = SURFACE_TOLERANCE * min(residual, 1.0) * rise
        known = _known(sources, blocks, temperature)
        found, distant = _with_surfaces(duct, _Banded.of(duct, sources, blocks), rest, known, distant, goal)
        change = found - temperature
        rise = max(float(np.ptp(found)), LEAST_RISE)
        residual = float(np.abs(change).max()) / rise
        steps += 1
        if (pace.held == 0 and residual <= tolerance) or steps == MAX_STEPS or not np.isfinite(residual):
            break
        if not pace.is_wild(residual * rise):
            pace.follow(change, residual, tolerance)
            temperature = temperature + pace.length * np.clip(change, -LONGEST_STEP, LONGEST_STEP)
    return Field(found, duct.supply, heat(duct.supply + found[:, 1:-1]).flux, steps, residual)


@dataclass
class _Pace:
    """How much growth a step of `temperature_field` holds back and which share of it is taken, after those before.

    Oil that warms from cold takes many steps of one direction with all growth held back: they are taken further than
    they go, and less is held back the later, the more often that was wild.

    before : the last step's change [K], last : its residual. wait : steps until less is held back; patience : that
    after the next wild step.
    """

    held: float
    before: FloatArray
    last: float = np.inf
    length: float = 1.0
    wait: int = 0
    patience: int = 1

    def is_wild(self, longest: float) -> bool:
        """Return True if a step of at most so many K is not to be taken, but anew with all growth held back."""
        if self.held == 1 or longest <= WILD:
            return False
        self.held, self.length, self.wait, self.patience = 1.0, 1.0, self.patience, 2 * self.patience
        return True

    def follow(self, change: FloatArray, residual: float, tolerance: float) -> None:
        """Say how far to take this step, and how much the next one holds back."""
        onward = self.held == 1 and float(np.vdot(change, self.before)) > 0
        self.wait -= 1
        if residual <= tolerance:
            self.held, self.length = 0.0, 1.0
        elif self.held == 1 and self.wait > 0 and residual > NEAR:
            self.length = min(1.5 * self.length, LONGEST) if onward else max(0.5 * self.length, SHORTEST)
        elif residual < self.last or onward:
            self.held = self.held * HELD_LESS if self.held > LEAST_HELD else 0.0
            self.length = min(2 * self.length, 1.0)
        else:
            self.held = min(max(self.held, LEAST_HELD) / HELD_LESS**2, 1.0)
            self.length = max(0.5 * self.length, SHORTEST)
        self.before, self.last = change, residual


def carried(duct: Duct, flux: FloatArray, oil: FloatArray) -> float:
    """Heat that the oil takes on, less what it brings [W/m]: through the last edge and, where it turns round in the
    inlet, the first one; of flow (m+1, K) and temperatures over the supply's (m, K)."""
    along = _at_faces(duct, flux, np.pad(oil, ((0, 0), (1, 1)), mode="edge"))[0]
    return duct.capacity * float(flux[-1] @ along[-1] - flux[0] @ along[0])


def _distant(rest: FloatArray, into: FloatArray) -> FloatArray:
    return np.stack([one @ heat for one, heat in zip(rest, into, strict=True)])


def _with_surfaces(
    duct: Duct, solver: _Banded, rest: FloatArray, known: FloatArray, distant: FloatArray, goal: float
) -> tuple[FloatArray, FloatArray]:
    """Temperatures where what warms the surfaces from elsewhere, (2, m) [K], is that of the heat that enters them."""

    def solved(warmer: FloatArray) -> FloatArray:
        right = known.copy()
        right[:, 0], right[:, -1] = duct.bulk[:, 0, None] - duct.supply + warmer
        return solver(right)

    shape = distant.shape
    none = np.zeros_like(distant)
    base = _distant(rest, duct.into_walls(solved(none)))

    def missed(values: FloatArray) -> FloatArray:
        warmer = values.reshape(shape)
        return (warmer - _distant(rest, duct.into_walls(solved(warmer))) + base).ravel()

    found = gmres(missed, base.ravel(), lambda r: r, distant.ravel(), goal, APPLICATIONS).values.reshape(shape)
    return solved(found), found


def _known(sources: Sources, blocks: FloatArray, temperature: FloatArray) -> FloatArray:
    """Right side (m, K + 2): heat made, linear about the temperatures; these over the supply's, so that oil that comes
    brings none, and what slow motion warms by is not lost beside some 300 K."""
    right, oil = np.zeros_like(temperature), temperature[:, 1:-1]
    right[:, 1:-1] = sources.made + _times(blocks, oil)
    return right


def _times(blocks: FloatArray, oil: FloatArray) -> FloatArray:
    """Blocks (3, m, K, K) of the column before, the own one and the next, times temperatures (m, K)."""
    out = np.einsum("jkl,jl->jk", blocks[1], oil)
    out[1:] += np.einsum("jkl,jl->jk", blocks[0, 1:], oil[:-1])
    out[:-1] += np.einsum("jkl,jl->jk", blocks[2, :-1], oil[1:])
    return np.asarray(out)


def _blocks(duct: Duct, sources: Sources, temperature: FloatArray, held: float) -> FloatArray:
    """What heat made and flow have to do with the temperatures, (3, m, K, K) as `Sources.slope`: what they do to a
    balance is less heat, and more oil that leaves."""
    blocks = -sources.slope - (1 - held) * sources.shifted
    layer = np.arange(duct.layers)
    blocks[1][:, layer, layer] += held * sources.growth
    if held == 1:
        return blocks
    along, crossing = _at_faces(duct, sources.flux, temperature)
    share = sources.share[:, None, None]
    for edge, sign in ((slice(1, None), 1.0), (slice(None, -1), -1.0)):
        bent = (1 - held) * sign * duct.capacity * sources.bending[edge]
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


def _at_faces(duct: Duct, flux: FloatArray, temperature: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Temperatures over the supply's of what flows through the edges (m+1, K) and from layer to layer (m, K-1)."""
    oil, (ahead, back) = temperature[:, 1:-1], _extrapolations(duct.width)
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
    """How much of the difference between the two columns upstream of an edge is added to the nearer one (m+1,): of flow
    with and against the numbering; none where there is but one."""
    ahead, back = np.zeros(len(width) + 1), np.zeros(len(width) + 1)
    ahead[2:] = width[1:] / (width[1:] + width[:-1])
    back[1:-2] = width[1:-1] / (width[1:-1] + width[2:])
    return ahead, back


def _upward(flux: FloatArray) -> FloatArray:
    """Flow from layer to layer (m, K-1) [m^2/s]: what comes along a layer and does not go on."""
    return np.asarray(-np.cumsum(np.diff(flux, axis=0), axis=1)[:, :-1])


@dataclass(frozen=True)
class _Banded:
    """The factors of a linear system of temperatures (m, K + 2)."""

    factors: FloatArray
    pivots: FloatArray
    half: int

    @classmethod
    def of(cls, duct: Duct, sources: Sources, blocks: FloatArray) -> _Banded:
        """Of balances of the volumes, and of the surfaces with their own heat alone."""
        own, along = _own(duct, sources.flux), _along(duct, sources.flux)
        m, size = own.shape[:2]
        inner = np.arange(1, size - 1)
        own[:, inner, inner] += along[0]
        own[:, 1:-1, 1:-1] += blocks[1]
        half = _REACH * size
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
        """Solved for a right side (m, K + 2)."""
        found = dgbtrs(self.factors, self.half, self.half, right.ravel(), self.pivots)[0]
        return np.asarray(found).reshape(right.shape)


def _own(duct: Duct, flux: FloatArray) -> FloatArray:
    """What conduction and flow across have to do with the temperatures of the own column (m, K + 2, K + 2)."""
    m, layers = duct.columns, duct.layers
    own = np.zeros((m, layers + 2, layers + 2))
    between, inner = duct.across[:, None], np.arange(1, layers + 1)
    own[:, inner[:-1], inner[:-1]] += between
    own[:, inner[:-1], inner[1:]] -= between
    own[:, inner[1:], inner[1:]] += between
    own[:, inner[1:], inner[:-1]] -= between
    # the flux into a wall is linear in the wall and two layers
    for wall, near, next_, body in ((0, 1, 2, 0), (-1, -2, -3, 1)):
        share = np.diagonal(duct.warming[body])
        for place, factor in ((wall, -8.0), (near, 9.0), (next_, -1.0)):
            into = duct.across * factor / 3
            own[:, near, place] += into
            own[:, wall, place] -= share * into
        own[:, wall, wall] += 1.0
    upward = duct.capacity * _upward(flux)
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


def _along(duct: Duct, flux: FloatArray) -> dict[int, FloatArray]:
    """What oil that flows along takes from a volume and brings from others, by how many columns on: (m, K) each."""
    m = duct.columns
    out = {step: np.zeros((m, duct.layers)) for step in range(-_REACH, _REACH + 1)}
    ahead, back = _extrapolations(duct.width)
    forward, backward = duct.capacity * np.maximum(flux, 0.0), duct.capacity * np.minimum(flux, 0.0)
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
