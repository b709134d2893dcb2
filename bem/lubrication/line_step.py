"""One implicit time step of the line-contact film on a fixed mesh, with cavitation as a complementarity.

In similarity variables (see `line_newton`), with time in units of 2 length / reference speed and s the entrainment
speed over that reference:

    d/dX (s rho H - rho H^3/(6 m) P') + d/dT (rho H) >= 0,   P >= 0,   one of them zero at every node,

finite volumes around the nodes, Couette flow extrapolated from the two nodes upstream. Every full-film volume is
balanced exactly by construction; at cavitated nodes the excess is the void that opens.

With mass-conserving cavitation H becomes theta H in both flow and storage, theta <= 1 the fraction of the gap that is
filled, the balance is an equation at every node, and P >= 0 is complementary to 1 - theta >= 0 instead: an active set
says which of P and theta is unknown at a node, and changes with every Newton step. A face carries the theta of the
node upstream on the film extrapolated to it: of second order in the full film, without oscillations behind it, and the
same formula whoever is full, so that the discrete problem has one solution.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.linalg import lu_factor, lu_solve

from bem.grid import FloatArray
from bem.lubrication.cavitation import Cavitation
from bem.lubrication.line_flow import Problem, mean_fluidity
from bem.lubrication.line_kernel import logarithmic_weights
from bem.lubrication.line_linear import DEFLECTION


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
    full: NDArray[np.bool_]
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
    n = len(position) - 1
    spacing = np.diff(position)
    quadrature = np.zeros(n + 1)
    quadrature[1:] += 0.5 * spacing
    quadrature[:-1] += 0.5 * spacing

    ahead = np.zeros(n)
    ahead[1:] = 0.5 * spacing[1:] / spacing[:-1]
    behind = np.zeros(n)
    behind[:-1] = 0.5 * spacing[:-1] / spacing[1:]
    return FixedMesh(
        position=position,
        shape=shape,
        weights=weights,
        volume=quadrature.copy(),
        quadrature=quadrature,
        spacing=spacing,
        ahead=ahead,
        behind=behind,
    )


def elastic_film(mesh: FixedMesh, pressure: FloatArray, datum: float) -> FloatArray:
    """Film of a pressure and a datum."""
    film: FloatArray = datum + mesh.shape - DEFLECTION * (mesh.weights @ pressure)
    return film


def time_step(
    problem: Problem,
    mesh: FixedMesh,
    start: Film,
    entrainment: float,
    leading: float,
    history: FloatArray,
    tolerance: float,
    max_iterations: int = 30,
    cavitation: Cavitation = Cavitation.SWIFT_STIEBER,
) -> StepOutcome:
    """Solve for pressure and datum such that flow, `leading * rho H + history` (the time derivative) and load agree.

    An infinite load keeps the datum as it is: a gap of given shape.
    """
    nodes = len(mesh.position)
    conserving = cavitation is Cavitation.MASS_CONSERVING
    loaded = np.isfinite(problem.load)
    upstream, farther = _upstream_nodes(mesh, entrainment)
    extrapolation = mesh.ahead if entrainment >= 0 else mesh.behind
    spacing = mesh.spacing
    pressure, film, datum = start.pressure.copy(), start.film.copy(), start.datum
    fraction = start.fraction.copy() if conserving else np.ones(nodes)
    inlet = 0 if entrainment >= 0 else -1
    fraction[inlet] = 1.0  # flooded
    full = start.full.copy()
    full[0] = full[-1] = False
    interior = np.arange(1, nodes - 1)
    # one flux to measure by: what is entrained or squeezed through the contact
    converged, residual, iterations = False, np.inf, 0
    seen: list[bytes] = []
    while True:
        positive = np.maximum(pressure, 0.0)
        log_viscosity, slope = problem.log_viscosity(positive)
        density, density_slope = problem.density(positive)
        thickness = 0.5 * (film[1:] + film[:-1])
        mean_density = 0.5 * (density[1:] + density[:-1])
        fluid, left, right = mean_fluidity(log_viscosity)
        gradient = np.diff(pressure) / spacing
        cubed = thickness**3 / 6
        mass = fraction * density * film

        carried = entrainment * fraction[upstream]
        held = density * film
        faced = held[upstream] + extrapolation * (held[upstream] - held[farther])
        flux = carried * faced - cubed * mean_density * fluid * gradient
        excess = np.diff(flux, prepend=0.0, append=0.0) + mesh.volume * (leading * mass + history)
        # what is carried through a ruptured gap is as thin as the exit, however wide the gap
        measure = np.minimum(film, 10 * film.min()) if conserving else film
        row = (mesh.volume * leading + abs(entrainment)) * measure
        scaled = excess / row
        load_error = 1 - (mesh.quadrature @ pressure) / problem.load if loaded else 0.0

        # a node carries pressure unless that vanishes and a void opens; both measured by their own scale
        highest = max(float(pressure.max()), 1e-300)
        new_full = pressure / highest > (1 - fraction if conserving else scaled)
        new_full[0] = new_full[-1] = False
        if iterations:
            worst = [abs(float(load_error)), max(-float(pressure.min()) / highest, 0.0)]
            if conserving:
                worst += [
                    float(np.max(np.abs(scaled[1:-1]))),
                    float(np.max(fraction[1:-1])) - 1,
                    float(np.max(np.abs(np.where(full, 1 - fraction, pressure / highest))[1:-1])),
                ]
            else:
                worst += [
                    float(np.max(np.abs(scaled[full]), initial=0.0)),
                    -float(np.where(full, 0.0, scaled)[1:-1].min(initial=0.0)),
                ]
            residual = max(worst)
            if residual <= tolerance:
                converged = True
                break
        if iterations == max_iterations or not np.isfinite(scaled).all():
            break
        if iterations:
            key = new_full.tobytes()
            if key in seen and not np.array_equal(new_full, full) and iterations > 8:
                # the exit hops between two nodes: take the smaller film and let Newton settle
                new_full &= full
            seen.append(key)
            full = new_full
        full[np.flatnonzero(full)[0] if full.any() else nodes // 2] = True
        index = np.flatnonzero(full)
        rows_at = interior if conserving else index
        empty = interior[~full[1:-1]] if conserving else interior[:0]
        through_film = 0.5 * thickness**2 * mean_density * fluid * gradient
        steep = cubed * gradient * mean_density
        mobility = cubed * mean_density * fluid / spacing
        dense = 0.5 * cubed * fluid * gradient
        stored = film * density_slope
        faces = _upwind(carried, density, extrapolation, entrainment)
        faces[1:3] -= 0.5 * through_film
        by_film = _bands(faces, mesh.volume * leading * fraction * density / row, row)
        faces = _upwind(carried, stored, extrapolation, entrainment)
        faces[1] += mobility - steep * left * slope[:-1] - dense * density_slope[:-1]
        faces[2] -= mobility + steep * right * slope[1:] + dense * density_slope[1:]
        by_pressure = _bands(faces, mesh.volume * leading * fraction * stored / row, row)
        faces = np.zeros_like(faces)
        faces[1 if entrainment >= 0 else 2] = entrainment * faced
        by_fraction = _bands(faces, mesh.volume * leading * held / row, row)

        size = len(rows_at)
        matrix = np.zeros((size + 1, size + 1))
        unknown = len(index)
        place = np.full(nodes, -1)
        place[index] = np.arange(unknown)
        place[empty] = unknown + np.arange(len(empty))
        elastic = -DEFLECTION * highest
        _assemble(matrix, rows_at, index, place, elastic * by_film, mesh.weights, highest * by_pressure, by_fraction)
        unit = float(film.min())
        matrix[:-1, -1] = by_film.sum(axis=0)[rows_at] * unit
        if loaded:
            matrix[-1, :unknown] = mesh.quadrature[index] * highest / problem.load
        else:
            matrix[-1, -1] = 1.0
        # nodes that leave the film drop their pressure in the same step
        dropped = np.where(full, 0.0, -pressure)
        film_drop = -DEFLECTION * (mesh.weights @ dropped)
        known = -scaled - _applied(by_film, film_drop) - _applied(by_pressure, dropped)
        # and those that enter it are filled
        filled = np.where(full, 1 - fraction, 0.0) if conserving else np.zeros(nodes)
        if conserving:
            known -= _applied(by_fraction, filled)
        right_side = np.append(
            known[rows_at], load_error - (mesh.quadrature @ dropped) / problem.load if loaded else 0.0
        )
        change = lu_solve(lu_factor(matrix, overwrite_a=True, check_finite=False), right_side, check_finite=False)
        if not np.isfinite(change).all():
            break
        step_pressure = dropped
        step_pressure[index] = change[:unknown] * highest
        step_fraction = filled
        step_fraction[empty] = change[unknown:-1]
        step_datum = change[-1] * unit
        step_film = step_datum - DEFLECTION * (mesh.weights @ step_pressure)
        shrinking = step_film < 0
        length = 1.0
        if shrinking.any():
            length = min(1.0, 0.8 * float(np.min(-film[shrinking] / step_film[shrinking])))
        pressure = pressure + length * step_pressure
        fraction = fraction + length * step_fraction
        datum += length * step_datum
        film = film + length * step_film
        iterations += 1
    moved = float(np.abs(flux).max()) + float(np.abs(mesh.volume * (leading * mass + history))[full].sum())
    balanced = excess[1:-1] if conserving else excess[full]
    imbalance = abs(float(balanced.sum())) / max(moved, 1e-300)
    if conserving:
        outlet, last = (-1, -2) if entrainment >= 0 else (0, 1)
        fraction[outlet] = min(mass[last] / (density[outlet] * film[outlet]), 1.0)
        mass[outlet] = fraction[outlet] * density[outlet] * film[outlet]
    outcome = Film(np.maximum(pressure, 0.0), film, datum, mass, full, fraction)
    return StepOutcome(outcome, iterations, residual, converged, imbalance)


def _upstream_nodes(mesh: FixedMesh, entrainment: float) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
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


@njit(cache=True)
def _assemble(
    matrix: FloatArray,
    rows: NDArray[np.intp],
    columns: NDArray[np.intp],
    place: NDArray[np.intp],
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
