"""What the contact tests share: surfaces, operators, an independent check of a solution, a slow and certain solver."""

import numpy as np
import scipy.optimize
import scipy.signal
from random_surfaces import self_affine

from bem.contact.bounds import Iterate
from bem.convolution import displacement_operator
from bem.grid import Grid
from bem.kernels.coefficients import SURFACE_PARITY, Load, surface_coefficients
from bem.kernels.layered.frequency_response import surface_response
from bem.materials import Body, Material

FREE, PERIODIC, HALF_X, HALF_Y = (False, False), (True, True), (True, False), (False, True)


def body(modulus=1.0, poisson=0.0):
    return Body(Material("test", youngs_modulus=modulus, poissons_ratio=poisson))


def operator(shape, spacing, periodic, modulus=1.0):
    return displacement_operator(Grid(shape, spacing, periodic=periodic), body(modulus))


def active_cells(workspace, cells):
    """The cells as the active set of a workspace, with the rows of the sparse inverse connected."""
    iterate = Iterate(cells, np.zeros(cells.size), cells[:0])
    workspace.begin_round(iterate, keep=False)
    return workspace.activate(iterate, np.empty(0, np.int32), 0.0, with_unit_approach=False)


def rough(nx, ny, seed=0, hurst=0.8, rolloff=2.0):
    """Heights of unit rms with a self-affine spectrum down to the cell."""
    return self_affine(nx, ny, np.random.default_rng(seed), hurst, rolloff)


def notes_surface(cells, seed=0, rolloff=8, cutoff=8, slope=0.1):
    """The periodic surface that the counts of convolutions are quoted for: side 1, Hurst 0.8, given rms slope."""
    rng = np.random.default_rng(seed)
    kx = np.fft.fftfreq(cells, 1 / cells)[:, None]
    ky = np.fft.rfftfreq(cells, 1 / cells)[None, :]
    k = np.hypot(kx, ky)
    amplitude = np.maximum(k, rolloff) ** -1.8
    amplitude[k > cells / cutoff] = 0
    amplitude[0, 0] = 0
    spectrum = amplitude * np.fft.rfft2(rng.standard_normal((cells, cells)))
    slopes = [np.fft.irfft2(2j * np.pi * q * spectrum, s=(cells, cells)) for q in (kx, ky)]
    rms = np.sqrt(np.mean(slopes[0] ** 2 + slopes[1] ** 2))
    return np.fft.irfft2(spectrum, s=(cells, cells)) * (slope / rms)


def displacement(op, pressure):
    """The operator's product by other means: numpy's transforms, or a direct sum over the coefficients.

    Friction adds what the traction `op.friction` times the pressure displaces: of the lower body minus the upper one.
    """
    grid = op.grid
    if all(grid.periodic):
        kx, ky = grid.wavevectors()
        kernel = sum(_periodic_response(kx, ky, body, Load.NORMAL) for body in op.bodies).astype(complex)
        for sign, body in zip((op.friction, -op.friction), op.bodies, strict=False):
            kernel += 1j * sign * _periodic_response(kx, ky, body, Load.TANGENTIAL)
        return np.fft.irfft2(kernel * np.fft.rfft2(pressure), s=grid.shape)
    product = _direct_sum(
        grid, sum(surface_coefficients(grid, b, Load.NORMAL) for b in op.bodies), Load.NORMAL, pressure
    )
    if op.friction:
        signs = zip((op.friction, -op.friction), op.bodies, strict=False)
        coupling = sum(sign * surface_coefficients(grid, b, Load.TANGENTIAL) for sign, b in signs)
        product += _direct_sum(grid, coupling, Load.TANGENTIAL, pressure)
    return product


def _periodic_response(kx, ky, body, load):
    """Normal displacement of a wave of traction; for a traction along x, i times the result.

    Homogeneous: Johnson (1985), (3.74) and (3.75), transformed. An odd function has no part at the highest wavenumber.
    """
    q = np.hypot(kx, ky)
    inverse = np.divide(1.0, q, out=np.zeros_like(q), where=q > 0)
    if not body.homogeneous:
        found = np.where(q > 0, surface_response(kx, ky, body, load), 0.0)
    elif load is Load.NORMAL:
        found = 2 / body.material.plane_strain_modulus * inverse
    else:
        found = -(1 - 2 * body.material.poissons_ratio) / (2 * body.material.shear_modulus) * kx * inverse**2
    if load is Load.TANGENTIAL and q.shape[0] % 2 == 0:
        found[q.shape[0] // 2] = 0.0
    return found


def _direct_sum(grid, quarter, load, pressure):
    """Convolution with the coefficients of the quarter plane, mirrored by their parity."""
    full = quarter
    for axis in (0, 1):
        n = grid.shape[axis]
        parity = SURFACE_PARITY[load][axis]
        mirrored = parity * np.flip(np.take(full, range(1, n), axis), axis)
        full = np.concatenate([mirrored, full], axis)
    tiled = pressure
    if grid.periodic[0]:
        # coefficients hold all images: offset i - n and i are the same
        tiled = np.concatenate([pressure[1:], pressure], 0)
        full = full[grid.shape[0] - 1 :]
        tiled = tiled if grid.shape[0] > 1 else pressure
    if grid.periodic[1]:
        tiled = np.concatenate([tiled[:, 1:], tiled], 1) if grid.shape[1] > 1 else tiled
        full = full[:, grid.shape[1] - 1 :]
    product = scipy.signal.fftconvolve(tiled, full, "full")
    i0, j0 = grid.shape[0] - 1, grid.shape[1] - 1
    return product[i0 : i0 + grid.shape[0], j0 : j0 + grid.shape[1]]


def violation(op, gap, solution, hardness=np.inf):
    """Largest violation of the contact conditions, judged from the pressure and the approach alone."""
    pressure = solution.pressure
    assert (pressure >= 0).all()
    assert (pressure <= hardness).all()
    opening = gap + displacement(op, pressure) - solution.approach
    inside = (pressure > 0) & (pressure < hardness)
    return max(
        np.abs(opening[inside]).max(initial=0.0),
        (-opening[pressure <= 0]).max(initial=0.0),
        opening[pressure >= hardness].max(initial=0.0),
    )


def dense(op):
    """The operator as a matrix, column by column by the independent product."""
    columns = []
    for cell in range(op.grid.cells):
        unit = np.zeros(op.grid.cells)
        unit[cell] = 1
        columns.append(displacement(op, unit.reshape(op.grid.shape)).ravel())
    return np.array(columns).T


def certain_solution(matrix, gap, approach, hardness=np.inf):
    """Pressure at an approach, by bounded-variable least squares (an exact active-set method) on a Cholesky factor."""
    lower = np.linalg.cholesky(matrix)
    right = np.linalg.solve(lower, approach - gap.ravel())
    return scipy.optimize.lsq_linear(lower.T, right, (0, hardness), method="bvls", tol=1e-15).x


def certain_solution_for_load(matrix, gap, force, hardness=np.inf):
    """Pressure with a given sum. A constant added to the matrix then moves the approach only."""
    definite = matrix + (10 * np.abs(matrix).max() or 1.0)
    low, high = gap.min(), gap.max() + definite.max() * (force + 1) * 2

    def excess(approach):
        return certain_solution(definite, gap, approach, hardness).sum() - force

    approach = scipy.optimize.brentq(excess, low, high, xtol=1e-14 * (high - low), rtol=1e-15, maxiter=500)
    return certain_solution(definite, gap, approach, hardness)
