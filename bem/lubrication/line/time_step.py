"""One implicit time step of the line-contact film on a fixed mesh, with cavitation as a complementarity.

In similarity variables (see `newton`), with time in units of 2 length / reference speed and s the entrainment
speed over that reference:

    d/dX (s rho H - rho H^3/(6 m) P') + d/dT (rho H) >= 0,   P >= 0,   one of them zero at every node,

finite volumes around the nodes, Couette flow extrapolated from the two nodes upstream. Every full-film volume is
balanced exactly by construction; at cavitated nodes the excess is the void that opens.

With mass-conserving cavitation H becomes theta H in both flow and storage, theta <= 1 the fraction of the gap that is
filled, the balance is an equation at every node, and P >= 0 is complementary to 1 - theta >= 0 instead: an active set
says which of P and theta is unknown at a node, and changes with every Newton step. A face carries the theta of the
node upstream on the film extrapolated to it: of second order in the full film, without oscillations behind it, and the
same formula whoever is full, so that the discrete problem has one solution. What differs between the two models is in
`cavitation`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import lu_factor, lu_solve

from bem.compiled import compiled
from bem.grid import FloatArray
from bem.lubrication.cavitation import Cavitation
from bem.lubrication.line.cavitation import RUPTURES, Indices, Iterate, Nodes, Rupture
from bem.lubrication.line.deflection import DEFLECTION, logarithmic_weights
from bem.lubrication.line.mesh import trapezoidal_weights, upwind_extrapolation
from bem.lubrication.line.reynolds import Problem, longest_step, mean_fluidity
from bem.lubrication.shear_profile import Driven, newtonian


@dataclass(frozen=True)
class FixedMesh:
    """Nodes (n+1,), film of undeformed bodies, kernel weights, volumes, quadrature; cells (n,), and on their faces how
    much of the difference between the two nodes upstream extrapolates the nearer one, for either direction."""

    position: FloatArray
    shape: FloatArray
    weights: FloatArray
    volume: FloatArray
    quadrature: FloatArray
    spacing: FloatArray
    ahead: FloatArray
    behind: FloatArray


@dataclass(frozen=True)
class Film:
    """Pressure and film at the nodes, datum, the mass rho H theta, which nodes carry pressure, and theta."""

    pressure: FloatArray
    film: FloatArray
    datum: float
    mass: FloatArray
    full: Nodes
    fraction: FloatArray


@dataclass(frozen=True)
class StepOutcome:
    """State after the step, Newton steps, residual, whether converged, and the volume balance."""

    film: Film
    iterations: int
    residual: float
    converged: bool
    imbalance: float


def fixed_mesh(half_width: float, far: float, cells: int) -> FixedMesh:
    """Symmetric mesh: uniform within `half_width`, growing geometrically to `far` on both sides."""
    half = cells // 2
    inner = max(int(0.72 * half), 4)
    width = half_width / inner
    outer = half - inner
    # ratio r with width (r + r^2 + ... + r^outer) = far - half_width
    low, high = 1.0 + 1e-9, 4.0
    for _ in range(80):
        ratio = 0.5 * (low + high)
        reach = width * ratio * (ratio**outer - 1) / (ratio - 1)
        low, high = (ratio, high) if reach < far - half_width else (low, ratio)
    right = np.concatenate(
        [np.arange(inner + 1) * width, half_width + width * np.cumsum(ratio ** np.arange(1, outer + 1))]
    )
    position = np.concatenate([-right[:0:-1], right])
    return mesh_of(position, 0.5 * position**2, logarithmic_weights(position, position))


def mesh_of(position: FloatArray, shape: FloatArray, weights: FloatArray) -> FixedMesh:
    """The mesh with given nodes, film of undeformed bodies and kernel weights."""
    spacing, quadrature = np.diff(position), trapezoidal_weights(position)
    return FixedMesh(
        position=position,
        shape=shape,
        weights=weights,
        volume=quadrature.copy(),
        quadrature=quadrature,
        spacing=spacing,
        ahead=upwind_extrapolation(spacing),
        behind=upwind_extrapolation(spacing[::-1])[::-1],
    )


def elastic_film(mesh: FixedMesh, pressure: FloatArray, datum: float) -> FloatArray:
    """Film of a pressure and a datum."""
    film: FloatArray = datum + mesh.shape - DEFLECTION * (mesh.weights @ pressure)
    return film


@dataclass(frozen=True)
class Step:
    """What stays the same during a time step.

    The time derivative is `leading * rho H + history`. upstream, farther : the node upstream of every face, and the one
    upstream of that; extrapolation : how much of their difference is added on the face.
    """

    problem: Problem
    mesh: FixedMesh
    entrainment: float
    leading: float
    history: FloatArray
    rupture: Rupture
    upstream: Indices
    farther: Indices
    extrapolation: FloatArray

    @property
    def loaded(self) -> bool:
        """Return True if the load is given; else the datum stays as it is."""
        return bool(np.isfinite(self.problem.load))


@dataclass(frozen=True)
class Balance:
    """The balances at an iterate. On nodes: density and slopes, mass, mass of a full gap (held), excess of each volume,
    row (its scale), scaled (their ratio). On faces: the rest. highest : of the pressure."""

    density: FloatArray
    density_slope: FloatArray
    slope: FloatArray
    thickness: FloatArray
    mean_density: FloatArray
    fluid: FloatArray
    left: FloatArray
    right: FloatArray
    driven: Driven
    cubed: FloatArray
    mass: FloatArray
    held: FloatArray
    carried: FloatArray
    faced: FloatArray
    flux: FloatArray
    excess: FloatArray
    row: FloatArray
    scaled: FloatArray
    load_error: float
    highest: float


def step_of(
    problem: Problem,
    mesh: FixedMesh,
    entrainment: float,
    leading: float,
    history: FloatArray,
    cavitation: Cavitation = Cavitation.SWIFT_STIEBER,
) -> Step:
    """A step under what acts, in which the time derivative is `leading * rho H + history`."""
    extrapolation = mesh.ahead if entrainment >= 0 else mesh.behind
    upstream = _upstream_nodes(mesh, entrainment)
    return Step(problem, mesh, entrainment, leading, history, RUPTURES[cavitation], *upstream, extrapolation)


def time_step(
    step: Step, start: Film, tolerance: float, max_iterations: int = 30, layer: float = np.inf
) -> StepOutcome:
    """Solve for pressure and datum such that flow, the time derivative and load agree.

    An infinite load keeps the datum as it is: a gap of given shape. The upstream end is filled by a layer, or full.
    """
    fraction = step.rupture.start(start.fraction)
    inlet = 0 if step.entrainment >= 0 else -1
    fraction[inlet] = min(layer / start.film[inlet], 1.0)  # the gap is so wide there that it does not change
    at = Iterate(start.pressure.copy(), start.film.copy(), start.datum, fraction)
    full = start.full.copy()
    full[0] = full[-1] = False
    converged, residual, iterations = False, np.inf, 0
    seen: list[bytes] = []
    while True:
        balance = balance_of(step, at)
        if iterations:
            residual = _residual(step, at, balance, full)
            converged = residual <= tolerance
        if converged or iterations == max_iterations or not np.isfinite(balance.scaled).all():
            break
        if iterations:
            full = _carrying(step, at, balance, full, seen, settle=iterations > 8)
        full[np.flatnonzero(full)[0] if full.any() else len(full) // 2] = True
        changed = _newton(step, at, balance, full)
        if changed is None:
            break
        at = changed
        iterations += 1
    return _outcome(step, at, balance, full, iterations, residual, converged)


def balance_of(step: Step, at: Iterate) -> Balance:
    """Flow through the faces and what it leaves in the volumes."""
    mesh, positive = step.mesh, np.maximum(at.pressure, 0.0)
    log_viscosity, slope = step.problem.log_viscosity(positive)
    density, density_slope = step.problem.density(positive)
    thickness = 0.5 * (at.film[1:] + at.film[:-1])
    mean_density = 0.5 * (density[1:] + density[:-1])
    fluid, left, right = mean_fluidity(log_viscosity)
    gradient = np.diff(at.pressure) / mesh.spacing
    cubed = thickness**3 / 6
    mass = at.fraction * density * at.film
    carried = step.entrainment * at.fraction[step.upstream]
    held = density * at.film
    faced = held[step.upstream] + step.extrapolation * (held[step.upstream] - held[step.farther])
    driven = newtonian(gradient)
    if step.problem.shear is not None:
        driven = step.problem.shear.driven(gradient, thickness, fluid, 0.5 * (positive[1:] + positive[:-1]))
    flux = carried * faced - cubed * mean_density * fluid * driven.gradient
    excess = np.diff(flux, prepend=0.0, append=0.0) + mesh.volume * (step.leading * mass + step.history)
    # one flux to measure by: what is entrained or squeezed through the contact
    row = (mesh.volume * step.leading + abs(step.entrainment)) * step.rupture.measure(at.film)
    return Balance(
        density=density,
        density_slope=density_slope,
        slope=slope,
        thickness=thickness,
        mean_density=mean_density,
        fluid=fluid,
        left=left,
        right=right,
        driven=driven,
        cubed=cubed,
        mass=mass,
        held=held,
        carried=carried,
        faced=faced,
        flux=flux,
        excess=excess,
        row=row,
        scaled=excess / row,
        load_error=float(1 - (mesh.quadrature @ at.pressure) / step.problem.load) if step.loaded else 0.0,
        highest=max(float(at.pressure.max()), 1e-300),
    )


def _residual(step: Step, at: Iterate, balance: Balance, full: Nodes) -> float:
    """The worst of load, negative pressure, balance and complementarity."""
    worst = [abs(balance.load_error), max(-float(at.pressure.min()) / balance.highest, 0.0)]
    share = at.pressure / balance.highest
    return max(worst + step.rupture.violations(share, at.fraction, balance.scaled, full))


def _carrying(step: Step, at: Iterate, balance: Balance, full: Nodes, seen: list[bytes], *, settle: bool) -> Nodes:
    """The nodes that carry pressure next; `seen` are those of earlier iterates, and gets these."""
    found = step.rupture.carrying(at.pressure / balance.highest, at.fraction, balance.scaled)
    found[0] = found[-1] = False
    key = found.tobytes()
    if key in seen and not np.array_equal(found, full) and settle:
        # the exit hops between two nodes: take the smaller film and let Newton settle
        found &= full
    seen.append(key)
    return found


def _derivatives(step: Step, at: Iterate, balance: Balance) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Of the scaled excess with film, pressure and fraction, as bands of five nodes."""
    b, volume = balance, step.mesh.volume
    driven = b.driven
    through_film = 0.5 * b.thickness**2 * b.mean_density * b.fluid * driven.gradient
    steep = b.cubed * driven.gradient * b.mean_density
    mobility = b.cubed * b.mean_density * b.fluid / step.mesh.spacing
    dense = 0.5 * b.cubed * b.fluid * driven.gradient
    if step.problem.shear is not None:
        through_film = through_film + b.cubed * b.mean_density * b.fluid * driven.by_film
        steep = steep + b.cubed * b.mean_density * b.fluid * driven.by_fluidity
        mobility = mobility * driven.by_gradient
    stored = at.film * b.density_slope
    faces = _upwind(b.carried, b.density, step.extrapolation, step.entrainment)
    faces[1:3] -= 0.5 * through_film
    by_film = _bands(faces, volume * step.leading * at.fraction * b.density / b.row, b.row)
    faces = _upwind(b.carried, stored, step.extrapolation, step.entrainment)
    faces[1] += mobility - steep * b.left * b.slope[:-1] - dense * b.density_slope[:-1]
    faces[2] -= mobility + steep * b.right * b.slope[1:] + dense * b.density_slope[1:]
    if step.problem.shear is not None:
        faces[1:3] -= 0.5 * b.cubed * b.mean_density * b.fluid * driven.by_pressure
    by_pressure = _bands(faces, volume * step.leading * at.fraction * stored / b.row, b.row)
    faces = np.zeros_like(faces)
    faces[1 if step.entrainment >= 0 else 2] = step.entrainment * b.faced
    by_fraction = _bands(faces, volume * step.leading * b.held / b.row, b.row)
    return by_film, by_pressure, by_fraction


def _newton(step: Step, at: Iterate, balance: Balance, full: Nodes) -> Iterate | None:
    """One step of Newton's method for the pressures of full nodes, the fractions of empty ones and the datum; as long
    as the film stays positive. None where the equations have no solution."""
    mesh, highest = step.mesh, balance.highest
    by_film, by_pressure, by_fraction = _derivatives(step, at, balance)
    index, rows_at, empty = np.flatnonzero(full), step.rupture.balanced(full), step.rupture.empty(full)
    size, unknown = len(rows_at), len(index)
    matrix = np.zeros((size + 1, size + 1))
    place = np.full(len(full), -1)
    place[index] = np.arange(unknown)
    place[empty] = unknown + np.arange(len(empty))
    elastic = -DEFLECTION * highest
    _assemble(matrix, rows_at, index, place, elastic * by_film, mesh.weights, highest * by_pressure, by_fraction)
    unit = float(at.film.min())
    matrix[:-1, -1] = by_film.sum(axis=0)[rows_at] * unit
    # nodes that leave the film drop their pressure in the same step, those that enter it are filled
    dropped = np.where(full, 0.0, -at.pressure)
    filled = step.rupture.filling(at.fraction, full)
    known = -balance.scaled - _applied(by_film, -DEFLECTION * (mesh.weights @ dropped)) - _applied(by_pressure, dropped)
    known -= _applied(by_fraction, filled)
    missing: float = 0.0
    if step.loaded:
        matrix[-1, :unknown] = mesh.quadrature[index] * highest / step.problem.load
        missing = balance.load_error - float(mesh.quadrature @ dropped) / step.problem.load
    else:
        matrix[-1, -1] = 1.0
    right_side = np.append(known[rows_at], missing)
    change = lu_solve(lu_factor(matrix, overwrite_a=True, check_finite=False), right_side, check_finite=False)
    if not np.isfinite(change).all():
        return None
    dropped[index] = change[:unknown] * highest
    filled[empty] = change[unknown:-1]
    datum = change[-1] * unit
    thicker: FloatArray = datum - DEFLECTION * (mesh.weights @ dropped)
    length = longest_step(at.film, thicker, 0.8)
    return Iterate(
        pressure=at.pressure + length * dropped,
        film=at.film + length * thicker,
        datum=at.datum + length * datum,
        fraction=at.fraction + length * filled,
    )


def _outcome(
    step: Step,
    at: Iterate,
    balance: Balance,
    full: Nodes,
    iterations: int,
    residual: float,
    converged: bool,
) -> StepOutcome:
    """The film after the step, and how well all volumes together balance."""
    moved = float(np.abs(balance.flux).max())
    moved += float(np.abs(step.mesh.volume * (step.leading * balance.mass + step.history))[full].sum())
    imbalance = abs(float(balance.excess[step.rupture.balanced(full)].sum())) / max(moved, 1e-300)
    step.rupture.leave(at, balance.density, balance.mass, (-1, -2) if step.entrainment >= 0 else (0, 1))
    film = Film(np.maximum(at.pressure, 0.0), at.film, at.datum, balance.mass, full, at.fraction)
    return StepOutcome(film, iterations, residual, converged, imbalance)


def _upstream_nodes(mesh: FixedMesh, entrainment: float) -> tuple[Indices, Indices]:
    """The node upstream of every face, and the one upstream of that (at the ends the same)."""
    faces = np.arange(len(mesh.spacing))
    if entrainment >= 0:
        return faces, np.maximum(faces - 1, 0)
    return faces + 1, np.minimum(faces + 2, len(faces))


def _upwind(carried: FloatArray, values: FloatArray, extrapolation: FloatArray, entrainment: float) -> FloatArray:
    """Coefficients (4, n) of face k's Couette flow in the unknowns at nodes k - 1 .. k + 2."""
    out = np.zeros((4, len(carried)))
    if entrainment >= 0:
        out[1] = carried * (1 + extrapolation) * values[:-1]
        out[0, 1:] = -carried[1:] * extrapolation[1:] * values[:-2]
    else:
        out[2] = carried * (1 + extrapolation) * values[1:]
        out[3, :-1] = -carried[:-1] * extrapolation[:-1] * values[2:]
    return out


def _bands(faces: FloatArray, diagonal: FloatArray, row: FloatArray) -> FloatArray:
    """Coefficients (5, n+1) of volume i's balance over `row` in the unknowns at nodes i - 2 .. i + 2."""
    out = np.zeros((5, len(diagonal)))
    out[1:, :-1] += faces
    out[:-1, 1:] -= faces
    out /= row
    out[2] += diagonal
    return out


def _applied(bands: FloatArray, values: FloatArray) -> FloatArray:
    """Bands times values at the nodes."""
    nodes = len(values)
    padded = np.zeros(nodes + 4)
    padded[2:-2] = values
    out = bands[0] * padded[:nodes]
    for k in range(1, 5):
        out += bands[k] * padded[k : k + nodes]
    return out


@compiled
def _assemble(
    matrix: FloatArray,
    rows: Indices,
    columns: Indices,
    place: Indices,
    by_film: FloatArray,
    weights: FloatArray,
    by_pressure: FloatArray,
    by_fraction: FloatArray,
) -> None:
    """Fill in the rows of the balances: through the film that follows pressures at `columns`, and directly."""
    nodes, pressures = len(place), len(columns)
    for a in range(len(rows)):
        i = rows[a]
        for k in range(5):
            j = i + k - 2
            if j < 0 or j >= nodes:
                continue
            factor = by_film[k, i]
            if factor != 0.0:
                for b in range(pressures):
                    matrix[a, b] += factor * weights[j, columns[b]]
            b = place[j]
            if b >= pressures:
                matrix[a, b] += by_fraction[k, i]
            elif b >= 0:
                matrix[a, b] += by_pressure[k, i]
