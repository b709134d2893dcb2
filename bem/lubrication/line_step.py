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
from numpy.typing import NDArray
from scipy import sparse
from scipy.linalg import lu_factor, lu_solve

from bem.grid import FloatArray
from bem.lubrication.cavitation import Cavitation
from bem.lubrication.line_kernel import logarithmic_weights
from bem.lubrication.line_linear import DEFLECTION
from bem.lubrication.line_newton import Problem, mean_fluidity


@dataclass(frozen=True)
class FixedMesh:
    """Nodes (n+1,), film of undeformed bodies, kernel weights, volumes, quadrature, and the operators from nodes to
    faces and back; `ahead` and `behind` take the upstream node alone."""

    position: FloatArray
    shape: FloatArray
    weights: FloatArray
    volume: FloatArray
    quadrature: FloatArray
    gradient: sparse.csr_array
    average: sparse.csr_array
    forward: sparse.csr_array
    backward: sparse.csr_array
    ahead: sparse.csr_array
    behind: sparse.csr_array
    divergence: sparse.csr_array


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

    def faces(*diagonals: tuple[FloatArray, int]) -> sparse.csr_array:
        return sparse.csr_array(
            sparse.diags_array(
                [d[max(0, -k) : n - max(0, k - 1)] for d, k in diagonals],
                offsets=[k for _, k in diagonals],
                shape=(n, n + 1),
            )
        )

    ones = np.ones(n)
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
        gradient=faces((-1 / spacing, 0), (1 / spacing, 1)),
        average=faces((0.5 * ones, 0), (0.5 * ones, 1)),
        forward=faces((1 + ahead, 0), (-ahead, -1)),
        backward=faces((1 + behind, 1), (-behind, 2)),
        ahead=faces((ones, 0)),
        behind=faces((ones, 1)),
        divergence=sparse.csr_array(sparse.diags_array([ones, -ones], offsets=[0, -1], shape=(n + 1, n))),
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
    extrapolated, carrier = (mesh.forward, mesh.ahead) if entrainment >= 0 else (mesh.backward, mesh.behind)
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
        thickness = mesh.average @ film
        mean_density = mesh.average @ density
        fluid, left, right = mean_fluidity(log_viscosity)
        gradient = mesh.gradient @ pressure
        cubed = thickness**3 / 6
        mass = fraction * density * film

        carried = carrier @ fraction
        upwind = extrapolated * carried[:, None]
        flux = entrainment * (upwind @ (density * film)) - cubed * mean_density * fluid * gradient
        excess = mesh.divergence @ flux + mesh.volume * (leading * mass + history)
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
        through_film = mesh.average * (0.5 * thickness**2 * mean_density * fluid * gradient)[:, None]
        by_film = mesh.divergence @ (entrainment * (upwind * density[None, :]) - through_film)
        by_film = by_film + sparse.diags_array(mesh.volume * leading * fraction * density)
        rows = sparse.csr_array(by_film)[rows_at] * (1 / row[rows_at])[:, None]
        steep = cubed * gradient * mean_density
        low = mesh.gradient * (cubed * mean_density * fluid)[:, None]
        ends = sparse.diags_array(
            [
                steep * left * slope[:-1] + 0.5 * cubed * fluid * gradient * density_slope[:-1],
                steep * right * slope[1:] + 0.5 * cubed * fluid * gradient * density_slope[1:],
            ],
            offsets=[0, 1],
            shape=(nodes - 1, nodes),
        )
        stored = film * density_slope
        by_pressure = mesh.divergence @ (entrainment * (upwind * stored[None, :]) - low - ends)
        by_pressure = by_pressure + sparse.diags_array(mesh.volume * leading * fraction * stored)
        by_pressure = sparse.csr_array(by_pressure)[rows_at]
        by_pressure = sparse.csr_array(by_pressure * (1 / row[rows_at])[:, None])

        size = len(rows_at)
        matrix = np.zeros((size + 1, size + 1))
        unknown = len(index)
        matrix[:-1, :unknown] = (rows @ mesh.weights[:, index]) * (-DEFLECTION * highest)
        matrix[:-1, :unknown] += by_pressure[:, index].toarray() * highest
        unit = float(film.min())
        matrix[:-1, -1] = (rows @ np.ones(nodes)) * unit
        if loaded:
            matrix[-1, :unknown] = mesh.quadrature[index] * highest / problem.load
        else:
            matrix[-1, -1] = 1.0
        # nodes that leave the film drop their pressure in the same step
        dropped = np.where(full, 0.0, -pressure)
        film_drop = -DEFLECTION * (mesh.weights @ dropped)
        known = -scaled[rows_at] - rows @ film_drop - by_pressure @ dropped
        filled = np.zeros(nodes)
        if conserving:
            # and those that enter it are filled
            filled = np.where(full, 1 - fraction, 0.0)
            held = density * film
            by_fraction = mesh.divergence @ (entrainment * (carrier * (extrapolated @ held)[:, None]))
            by_fraction = sparse.csr_array(by_fraction + sparse.diags_array(mesh.volume * leading * held))[rows_at]
            by_fraction = sparse.csr_array(by_fraction * (1 / row[rows_at])[:, None])
            matrix[:-1, unknown:-1] = by_fraction[:, empty].toarray()
            known -= by_fraction @ filled
        right_side = np.append(known, load_error - (mesh.quadrature @ dropped) / problem.load if loaded else 0.0)
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
