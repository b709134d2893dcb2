"""One implicit time step of the line-contact film on a fixed mesh, with cavitation as a complementarity.

In similarity variables (`problem`), with time in units of 2 length / reference speed and s the entrainment speed over
that reference:

    d/dX (s rho H - rho H^3/(6 m) P') + d/dT (rho H) >= 0,   P >= 0,   one of them zero at every node.

1. Finite volumes around the nodes; Couette flow extrapolated from the two nodes upstream of a face. Every full-film
   volume is balanced exactly by construction; at cavitated nodes the excess is the void that opens.
2. With mass-conserving cavitation H becomes theta H in flow and storage, theta <= 1 the filled fraction of the gap. The
   balance is then an equation at every node, and P >= 0 is complementary to 1 - theta >= 0. A face carries the theta of
   the node upstream on the film extrapolated to it: of second order in the full film, without oscillations behind it,
   and the same formula in both zones, so that the discrete problem has one solution.
3. An active set says whether P or theta is unknown at a node, and changes with every Newton step (`cavitation` has what
   differs between the models).
4. The film is eliminated: one dense system for pressures, fractions and H0, solved by LU.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import lu_factor, lu_solve

from bem.compiled import compiled
from bem.grid import FloatArray
from bem.lubrication.cavitation import Cavitation
from bem.lubrication.line.cavitation import CAVITATION_MODELS, CavitationModel, Indices, Iterate, Nodes
from bem.lubrication.line.deflection import DEFLECTION, logarithmic_weights
from bem.lubrication.line.mesh import trapezoidal_weights, upwind_extrapolation
from bem.lubrication.line.problem import Problem
from bem.lubrication.line.reynolds import PoiseuilleFlow, longest_step, poiseuille_flow

_DIVERGED = 1e12
"""Film in similarity variables beyond which Newton's method has diverged: steps that converge stay below 1e6."""


@dataclass(frozen=True)
class FixedMesh:
    """Fixed mesh of n cells.

    position, shape : (n+1,) nodes, and film of the undeformed bodies.
    weights : (n+1, n+1) of the deflection.
    volume, quadrature : (n+1,) lengths of the volumes, and trapezoidal weights.
    spacing : (n,) cells.
    ahead, behind : (n,) upwind extrapolation factors on the faces for entrainment along +x and -x.
    """

    position: FloatArray
    shape: FloatArray
    weights: FloatArray
    volume: FloatArray
    quadrature: FloatArray
    spacing: FloatArray
    ahead: FloatArray
    behind: FloatArray


@dataclass(frozen=True)
class TransientState:
    """State of the film at a time.

    pressure, film : (n+1,). rigid_separation : H0. mass : (n+1,) rho H theta.
    full : (n+1,) nodes that carry pressure. fraction : (n+1,) theta.
    """

    pressure: FloatArray
    film: FloatArray
    rigid_separation: float
    mass: FloatArray
    full: Nodes
    fraction: FloatArray


@dataclass(frozen=True)
class StepOutcome:
    """State after the step, Newton steps, largest residual, whether it converged, and the relative imbalance of all
    volumes."""

    film: TransientState
    iterations: int
    residual: float
    converged: bool
    imbalance: float


def fixed_mesh(half_width: float, far: float, cells: int) -> FixedMesh:
    """Return a symmetric mesh: uniform within `half_width`, growing geometrically to `far` on both sides."""
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
    return mesh_from_nodes(position, 0.5 * position**2, logarithmic_weights(position, position))


def mesh_from_nodes(position: FloatArray, shape: FloatArray, weights: FloatArray) -> FixedMesh:
    """Return the mesh of given nodes, film of the undeformed bodies and deflection weights."""
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


def elastic_film(mesh: FixedMesh, pressure: FloatArray, rigid_separation: float) -> FloatArray:
    """Return the film (n+1,) of a pressure (n+1,) and H0."""
    film: FloatArray = rigid_separation + mesh.shape - DEFLECTION * (mesh.weights @ pressure)
    return film


@dataclass(frozen=True)
class Step:
    """Quantities that stay constant during a time step.

    entrainment : over the reference speed. leading, history : the time derivative is leading * rho H + history.
    upstream, farther : (n,) the two nodes upstream of every face. extrapolation : (n,) factors of their difference.
    """

    problem: Problem
    mesh: FixedMesh
    entrainment: float
    leading: float
    history: FloatArray
    cavitation: CavitationModel
    upstream: Indices
    farther: Indices
    extrapolation: FloatArray

    @property
    def loaded(self) -> bool:
        """Return True if the load is given; otherwise H0 is."""
        return bool(np.isfinite(self.problem.load))


@dataclass(frozen=True)
class VolumeBalance:
    """Terms of the balances at an iterate.

    On nodes (n+1,): density, its slope, mass, mass of a full gap, excess of each volume, its scale, and their ratio.
    On faces (n,): density, Poiseuille flow, speed of the Couette flow times theta, mass on the face, flux.
    load_error : relative error of the load. largest_pressure : of the iterate.
    """

    density: FloatArray
    density_slope: FloatArray
    mean_density: FloatArray
    poiseuille: PoiseuilleFlow
    mass: FloatArray
    full_mass: FloatArray
    face_speed: FloatArray
    face_mass: FloatArray
    flux: FloatArray
    excess: FloatArray
    scale: FloatArray
    scaled: FloatArray
    load_error: float
    largest_pressure: float


def build_step(
    problem: Problem,
    mesh: FixedMesh,
    entrainment: float,
    leading: float,
    history: FloatArray,
    cavitation: Cavitation = Cavitation.SWIFT_STIEBER,
) -> Step:
    """Return the step in which the time derivative is leading * rho H + history."""
    extrapolation = mesh.ahead if entrainment >= 0 else mesh.behind
    upstream = _upstream_nodes(mesh, entrainment)
    return Step(problem, mesh, entrainment, leading, history, CAVITATION_MODELS[cavitation], *upstream, extrapolation)


def time_step(
    step: Step, start: TransientState, tolerance: float, max_iterations: int = 30, layer: float = np.inf
) -> StepOutcome:
    """Solve for pressure, fraction and H0 such that flow, time derivative and load agree.

    layer : film of the oil that arrives upstream; infinite for a full gap. An infinite load of the problem fixes H0: a
        gap of given shape.
    """
    fraction = step.cavitation.initial_fraction(start.fraction)
    inlet = 0 if step.entrainment >= 0 else -1
    fraction[inlet] = min(layer / start.film[inlet], 1.0)  # the gap is so wide there that it does not change
    at = Iterate(start.pressure.copy(), start.film.copy(), start.rigid_separation, fraction)
    full = start.full.copy()
    full[0] = full[-1] = False
    converged, residual, iterations = False, np.inf, 0
    earlier_sets: list[bytes] = []
    while True:
        balance = balance_of(step, at)
        if iterations:
            residual = _residual(step, at, balance, full)
            converged = residual <= tolerance
        if converged or iterations == max_iterations or not np.isfinite(balance.scaled).all():
            break
        if iterations:
            full = _next_active_set(step, at, balance, full, earlier_sets, settle=iterations > 8)
        full[np.flatnonzero(full)[0] if full.any() else len(full) // 2] = True
        changed = _newton(step, at, balance, full)
        if changed is None:
            break
        at = changed
        iterations += 1
    return _outcome(step, at, balance, full, iterations, residual, converged)


def balance_of(step: Step, at: Iterate) -> VolumeBalance:
    """Return flux and balances at an iterate."""
    mesh, positive = step.mesh, np.maximum(at.pressure, 0.0)
    density, density_slope = step.problem.density(positive)
    mean_density = 0.5 * (density[1:] + density[:-1])
    viscosity = step.problem.log_viscosity(positive)
    poiseuille = poiseuille_flow(step.problem, at.pressure, at.film, mesh.spacing, mean_density, viscosity)
    mass = at.fraction * density * at.film
    face_speed = step.entrainment * at.fraction[step.upstream]
    full_mass = density * at.film
    face_mass = full_mass[step.upstream] + step.extrapolation * (full_mass[step.upstream] - full_mass[step.farther])
    flux = face_speed * face_mass - poiseuille.flow
    excess = np.diff(flux, prepend=0.0, append=0.0) + mesh.volume * (step.leading * mass + step.history)
    # one flux to measure by: what is entrained or squeezed through the contact
    scale = (mesh.volume * step.leading + abs(step.entrainment)) * step.cavitation.reference_film(at.film)
    return VolumeBalance(
        density=density,
        density_slope=density_slope,
        mean_density=mean_density,
        poiseuille=poiseuille,
        mass=mass,
        full_mass=full_mass,
        face_speed=face_speed,
        face_mass=face_mass,
        flux=flux,
        excess=excess,
        scale=scale,
        scaled=excess / scale,
        load_error=float(1 - (mesh.quadrature @ at.pressure) / step.problem.load) if step.loaded else 0.0,
        largest_pressure=max(float(at.pressure.max()), 1e-300),
    )


def _residual(step: Step, at: Iterate, balance: VolumeBalance, full: Nodes) -> float:
    """Return the largest violation of load, positive pressure, balance and complementarity."""
    worst = [abs(balance.load_error), max(-float(at.pressure.min()) / balance.largest_pressure, 0.0)]
    share = at.pressure / balance.largest_pressure
    return max(worst + step.cavitation.violations(share, at.fraction, balance.scaled, full))


def _next_active_set(
    step: Step, at: Iterate, balance: VolumeBalance, full: Nodes, earlier_sets: list[bytes], *, settle: bool
) -> Nodes:
    """Return the next active set; `earlier_sets` collects all sets so far."""
    found = step.cavitation.active_set(at.pressure / balance.largest_pressure, at.fraction, balance.scaled)
    found[0] = found[-1] = False
    key = found.tobytes()
    if key in earlier_sets and not np.array_equal(found, full) and settle:
        # the exit hops between two nodes: take the smaller film and let Newton settle
        found &= full
    earlier_sets.append(key)
    return found


def _derivatives(step: Step, at: Iterate, balance: VolumeBalance) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the derivatives of the scaled excess with film, pressure and fraction, as bands (5, n+1)."""
    b, volume, poiseuille = balance, step.mesh.volume, balance.poiseuille
    stored = at.film * b.density_slope
    faces = _couette_coefficients(b.face_speed, b.density, step.extrapolation, step.entrainment)
    faces[1:3] -= poiseuille.by_film
    by_film = _bands(faces, volume * step.leading * at.fraction * b.density / b.scale, b.scale)
    faces = _couette_coefficients(b.face_speed, stored, step.extrapolation, step.entrainment)
    mobility = poiseuille.mobility / step.mesh.spacing
    dense = 0.5 * poiseuille.flow / b.mean_density
    faces[1] += mobility - poiseuille.left - dense * b.density_slope[:-1]
    faces[2] -= mobility + poiseuille.right + dense * b.density_slope[1:]
    by_pressure = _bands(faces, volume * step.leading * at.fraction * stored / b.scale, b.scale)
    faces = np.zeros_like(faces)
    faces[1 if step.entrainment >= 0 else 2] = step.entrainment * b.face_mass
    by_fraction = _bands(faces, volume * step.leading * b.full_mass / b.scale, b.scale)
    return by_film, by_pressure, by_fraction


def _newton(step: Step, at: Iterate, balance: VolumeBalance, full: Nodes) -> Iterate | None:
    """Take a Newton step for the pressures of full nodes, the fractions of the others and H0, shortened to positive
    films; None where the equations have no solution, or the step diverges."""
    mesh, largest_pressure = step.mesh, balance.largest_pressure
    by_film, by_pressure, by_fraction = _derivatives(step, at, balance)
    index, balanced, empty = (
        np.flatnonzero(full),
        step.cavitation.balanced_nodes(full),
        step.cavitation.partly_filled_nodes(full),
    )
    size, unknown = len(balanced), len(index)
    matrix = np.zeros((size + 1, size + 1))
    place = np.full(len(full), -1)
    place[index] = np.arange(unknown)
    place[empty] = unknown + np.arange(len(empty))
    elastic = -DEFLECTION * largest_pressure
    _assemble(
        matrix, balanced, index, place, elastic * by_film, mesh.weights, largest_pressure * by_pressure, by_fraction
    )
    unit = float(at.film.min())
    matrix[:-1, -1] = by_film.sum(axis=0)[balanced] * unit
    # nodes that leave the film drop their pressure in the same step, those that enter it are filled
    dropped = np.where(full, 0.0, -at.pressure)
    filled = step.cavitation.fraction_change(at.fraction, full)
    known = (
        -balance.scaled
        - _apply_bands(by_film, -DEFLECTION * (mesh.weights @ dropped))
        - _apply_bands(by_pressure, dropped)
    )
    known -= _apply_bands(by_fraction, filled)
    missing: float = 0.0
    if step.loaded:
        matrix[-1, :unknown] = mesh.quadrature[index] * largest_pressure / step.problem.load
        missing = balance.load_error - float(mesh.quadrature @ dropped) / step.problem.load
    else:
        matrix[-1, -1] = 1.0
    right_side = np.append(known[balanced], missing)
    change = lu_solve(lu_factor(matrix, overwrite_a=True, check_finite=False), right_side, check_finite=False)
    if not np.isfinite(change).all():
        return None
    dropped[index] = change[:unknown] * largest_pressure
    filled[empty] = change[unknown:-1]
    rigid_separation = change[-1] * unit
    thicker: FloatArray = rigid_separation - DEFLECTION * (mesh.weights @ dropped)
    length = longest_step(at.film, thicker, 0.8)
    film = at.film + length * thicker
    if float(np.abs(film).max()) > _DIVERGED:
        return None
    return Iterate(
        pressure=at.pressure + length * dropped,
        film=film,
        rigid_separation=at.rigid_separation + length * rigid_separation,
        fraction=at.fraction + length * filled,
    )


def _outcome(
    step: Step,
    at: Iterate,
    balance: VolumeBalance,
    full: Nodes,
    iterations: int,
    residual: float,
    converged: bool,
) -> StepOutcome:
    """Return the outcome of the step, with the imbalance of all volumes together."""
    moved = float(np.abs(balance.flux).max())
    moved += float(np.abs(step.mesh.volume * (step.leading * balance.mass + step.history))[full].sum())
    imbalance = abs(float(balance.excess[step.cavitation.balanced_nodes(full)].sum())) / max(moved, 1e-300)
    step.cavitation.fill_outlet(at, balance.density, balance.mass, (-1, -2) if step.entrainment >= 0 else (0, 1))
    film = TransientState(np.maximum(at.pressure, 0.0), at.film, at.rigid_separation, balance.mass, full, at.fraction)
    return StepOutcome(film, iterations, residual, converged, imbalance)


def _upstream_nodes(mesh: FixedMesh, entrainment: float) -> tuple[Indices, Indices]:
    """Return the node upstream of every face and the next one upstream (the same node at the ends)."""
    faces = np.arange(len(mesh.spacing))
    if entrainment >= 0:
        return faces, np.maximum(faces - 1, 0)
    return faces + 1, np.minimum(faces + 2, len(faces))


def _couette_coefficients(
    face_speed: FloatArray, values: FloatArray, extrapolation: FloatArray, entrainment: float
) -> FloatArray:
    """Return the coefficients (4, n) of the Couette flow through face k in the unknowns at nodes k - 1 .. k + 2."""
    out = np.zeros((4, len(face_speed)))
    if entrainment >= 0:
        out[1] = face_speed * (1 + extrapolation) * values[:-1]
        out[0, 1:] = -face_speed[1:] * extrapolation[1:] * values[:-2]
    else:
        out[2] = face_speed * (1 + extrapolation) * values[1:]
        out[3, :-1] = -face_speed[:-1] * extrapolation[:-1] * values[2:]
    return out


def _bands(faces: FloatArray, diagonal: FloatArray, scale: FloatArray) -> FloatArray:
    """Return the coefficients (5, n+1) of the scaled balance of volume i in the unknowns at nodes i - 2 .. i + 2."""
    out = np.zeros((5, len(diagonal)))
    out[1:, :-1] += faces
    out[:-1, 1:] -= faces
    out /= scale
    out[2] += diagonal
    return out


def _apply_bands(bands: FloatArray, values: FloatArray) -> FloatArray:
    """Return the product of bands (5, n+1) with values at the nodes."""
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
    """Fill in the rows of the balances: terms by way of the film under pressures at `columns`, and direct terms."""
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
