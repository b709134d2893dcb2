"""One implicit time step of the line-contact film on a fixed mesh, with cavitation as a complementarity.

In similarity variables (see `line_newton`), with time in units of 2 length / reference speed and s the entrainment
speed over that reference:

    d/dX (s rho H - rho H^3/(6 m) P') + d/dT (rho H) >= 0,   P >= 0,   one of them zero at every node,

finite volumes around the nodes, Couette flow extrapolated from the two nodes upstream. Every full-film volume is
balanced exactly by construction; at cavitated nodes the excess is the void that opens.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.linalg import lu_factor, lu_solve

from bem.grid import FloatArray
from bem.lubrication.line_kernel import logarithmic_weights
from bem.lubrication.line_linear import DEFLECTION
from bem.lubrication.line_newton import Problem, mean_fluidity


@dataclass(frozen=True)
class FixedMesh:
    """Nodes (n+1,), kernel weights, volumes, quadrature, and the operators from nodes to faces and back."""

    position: FloatArray
    weights: FloatArray
    volume: FloatArray
    quadrature: FloatArray
    gradient: sparse.csr_array
    average: sparse.csr_array
    forward: sparse.csr_array
    backward: sparse.csr_array
    divergence: sparse.csr_array


@dataclass(frozen=True)
class Film:
    """Pressure and film at the nodes, datum, the mass rho H, and which nodes are full of oil."""

    pressure: FloatArray
    film: FloatArray
    datum: float
    mass: FloatArray
    full: FloatArray


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
        weights=logarithmic_weights(position, position),
        volume=quadrature.copy(),
        quadrature=quadrature,
        gradient=faces((-1 / spacing, 0), (1 / spacing, 1)),
        average=faces((0.5 * ones, 0), (0.5 * ones, 1)),
        forward=faces((1 + ahead, 0), (-ahead, -1)),
        backward=faces((1 + behind, 1), (-behind, 2)),
        divergence=sparse.csr_array(sparse.diags_array([ones, -ones], offsets=[0, -1], shape=(n + 1, n))),
    )


def elastic_film(mesh: FixedMesh, pressure: FloatArray, datum: float) -> FloatArray:
    """Film of a pressure and a datum."""
    film: FloatArray = datum + 0.5 * mesh.position**2 - DEFLECTION * (mesh.weights @ pressure)
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
) -> StepOutcome:
    """Solve for pressure and datum such that flow, `leading * rho H + history` (the time derivative) and load agree."""
    nodes = len(mesh.position)
    upwind = mesh.forward if entrainment >= 0 else mesh.backward
    pressure, film, datum = start.pressure.copy(), start.film.copy(), start.datum
    full = start.full.copy()
    full[0] = full[-1] = False
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
        mass = density * film
        flux = entrainment * (upwind @ mass) - cubed * mean_density * fluid * gradient
        excess = mesh.divergence @ flux + mesh.volume * (leading * mass + history)
        row = mesh.volume * leading * film + abs(entrainment) * film
        scaled = excess / row
        load_error = 1 - (mesh.quadrature @ pressure) / problem.load

        # a node is full unless pressure vanishes there and a void opens; both measured by their own scale
        highest = max(float(pressure.max()), 1e-300)
        new_full = pressure / highest > scaled
        new_full[0] = new_full[-1] = False
        if iterations:
            residual = max(
                float(np.max(np.abs(scaled[full]), initial=0.0)),
                abs(float(load_error)),
                max(-float(pressure.min()) / highest, 0.0),
                -float(np.where(full, 0.0, scaled)[1:-1].min(initial=0.0)),
            )
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
        through_film = mesh.average * (0.5 * thickness**2 * mean_density * fluid * gradient)[:, None]
        by_film = mesh.divergence @ (entrainment * (upwind * density[None, :]) - through_film)
        by_film = by_film + sparse.diags_array(mesh.volume * leading * density)
        rows = sparse.csr_array(by_film)[index] * (1 / row[index])[:, None]
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
        by_pressure = mesh.divergence @ (entrainment * (upwind * (film * density_slope)[None, :]) - low - ends)
        by_pressure = by_pressure + sparse.diags_array(mesh.volume * leading * film * density_slope)
        direct = (sparse.csr_array(by_pressure)[index] * (1 / row[index])[:, None])[:, index].toarray()

        size = len(index)
        matrix = np.empty((size + 1, size + 1))
        matrix[:-1, :-1] = (rows @ mesh.weights[:, index]) * (-DEFLECTION * highest) + direct * highest
        unit = float(film.min())
        matrix[:-1, -1] = (rows @ np.ones(nodes)) * unit
        matrix[-1, :-1] = mesh.quadrature[index] * highest / problem.load
        matrix[-1, -1] = 0.0
        # nodes that leave the film drop their pressure in the same step
        dropped = np.where(full, 0.0, -pressure)
        film_drop = -DEFLECTION * (mesh.weights @ dropped)
        right_side = np.append(
            -scaled[index] - rows @ film_drop - (sparse.csr_array(by_pressure)[index] @ dropped) / row[index],
            load_error - (mesh.quadrature @ dropped) / problem.load,
        )
        change = lu_solve(lu_factor(matrix, overwrite_a=True, check_finite=False), right_side, check_finite=False)
        if not np.isfinite(change).all():
            break
        step_pressure = dropped
        step_pressure[index] = change[:-1] * highest
        step_datum = change[-1] * unit
        step_film = step_datum - DEFLECTION * (mesh.weights @ step_pressure)
        shrinking = step_film < 0
        length = 1.0
        if shrinking.any():
            length = min(1.0, 0.8 * float(np.min(-film[shrinking] / step_film[shrinking])))
        pressure = pressure + length * step_pressure
        datum += length * step_datum
        film = film + length * step_film
        iterations += 1
    moved = float(np.abs(flux).max()) + float(np.abs(mesh.volume * (leading * mass + history))[full].sum())
    imbalance = abs(float(excess[full].sum())) / max(moved, 1e-300)
    outcome = Film(np.maximum(pressure, 0.0), film, datum, mass, full)
    return StepOutcome(outcome, iterations, residual, converged, imbalance)
