"""Doubly periodic half-space, bare or under bonded layers: the response to a harmonic load.

A load exp(i (kx x + ky y)) on the surface of a homogeneous half-space decays as exp(-q z), q = |k|. Fields are sampled
at the cell centres and loads are their trigonometric interpolants: the response is taken at the grid's own wavevectors,
with no average over a cell. Arrays follow the real transform over y (`numpy.fft.rfft2`): kx in the order of
`fftfreq`, ky >= 0.

Every response is real or purely imaginary, by the parity of its kernel in real space. The array returned is its real or
its imaginary part (spectrum = array, or i x array where the kernel is odd). At the highest wavenumber of an even
number of cells the sign of a derivative is undefined: responses odd in that wavenumber are 0 there.

Mean mode (q = 0): the displacement is 0 (a mean pressure moves the datum only: a half-space has no finite answer);
the stresses are those of the laterally constrained uniform state, zz = -1, xx = yy = -nu/(1-nu) per unit pressure, and
xz = -1 per unit traction.
"""

from __future__ import annotations

import numpy as np

from bem.errors import InputError
from bem.grid import FloatArray, Grid
from bem.kernels.layered import frequency_response
from bem.kernels.loads import (
    IN_PLANE_PARITY,
    STRESS_PARITY,
    SURFACE_PARITY,
    Load,
    Parities,
    refuse_special_surface,
)
from bem.kernels.special_surfaces import special_surface
from bem.materials import Body


def _check(grid: Grid) -> None:
    if grid.periodic != (True, True):
        raise InputError(f"grid: periodic {grid.periodic!r}; spectral responses need both axes periodic")


def _wavevectors(grid: Grid) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return kx, ky, q (1 at the mean mode), and kx, ky with the ambiguous highest wavenumber set to zero."""
    kx, ky = grid.wavevectors()
    q = np.hypot(kx, ky)
    q[0, 0] = 1.0
    odd_x, odd_y = kx.copy(), ky.copy()
    nx, ny = grid.shape
    if nx % 2 == 0:
        odd_x[nx // 2] = 0.0
    if ny % 2 == 0:
        odd_y[:, ny // 2] = 0.0
    return kx, ky, q, odd_x, odd_y


def _mirrored(rows: FloatArray, count: int, parities: Parities) -> FloatArray:
    """Return all `count` rows of kx from the first count // 2 + 1, (parts, rows, ...), by parity in x."""
    out = np.empty((len(rows), count, *rows.shape[2:]))
    out[:, : count // 2 + 1] = rows
    for part, (along_x, _) in enumerate(parities):
        np.multiply(rows[part, (count - 1) // 2 : 0 : -1], along_x, out=out[part, count // 2 + 1 :])
    return out


def surface_response(grid: Grid, body: Body, load: Load) -> FloatArray:
    """Return the normal surface displacement of a harmonic unit load, shape (nx, ny//2 + 1) [m/Pa].

    Pressure: 2 / (E* q), the spectrum itself. Traction along +x: -(1-2nu) kx / (2 G q^2), its imaginary part.
    Mean mode 0. Johnson (1985), section 13.2, and the transform of Cerruti's solution. With layers: see
    `layered.frequency_response`. Of a crystal it is the part that is even in kx and ky; `odd_surface_response` has the
    rest.

    Raises
    ------
    InputError : a grid that is not periodic along both axes; a crystal, or surface tension, under traction.
    """
    _check(grid)
    kx, ky, q, odd_x, _ = _wavevectors(grid)
    if load is Load.TANGENTIAL:
        refuse_special_surface(body, "displacements under traction")
    if not body.boussinesq and body.homogeneous:
        return special_surface(body.material).surface_response(kx, ky, body.material)
    if not body.homogeneous:
        tangential, half = load is Load.TANGENTIAL, grid.shape[0] // 2 + 1
        rows = frequency_response.surface_response((odd_x if tangential else kx)[:half], ky[:half], body, load)
        return _mirrored(rows[None], grid.shape[0], (SURFACE_PARITY[load],))[0]
    material = body.material
    if load is Load.NORMAL:
        out = 2 / (material.plane_strain_modulus * q)
    else:
        out = -(1 - 2 * material.poissons_ratio) / (2 * material.shear_modulus) * odd_x / q**2
    out[0, 0] = 0.0
    return out


def odd_surface_response(grid: Grid, body: Body) -> FloatArray | None:
    """Return the part of the displacement under harmonic pressure that is odd in kx and ky, (nx, ny//2 + 1) [m/Pa].

    None of a body that responds alike on both sides of the x axis: all but crystals do.

    Raises
    ------
    InputError : a grid that is not periodic along both axes.
    """
    _check(grid)
    if body.material.stiffness is None or body.material.stiffness.mirror_symmetric:
        return None
    from bem.kernels.anisotropic import odd_surface_response as crystal_response  # late, because few bodies need it

    kx, ky, _, odd_x, odd_y = _wavevectors(grid)
    return crystal_response(kx, ky, body.material) * ((odd_x == kx) & (odd_y == ky))


def pressure_response(grid: Grid, body: Body, columns: slice) -> FloatArray:
    """Return the response to harmonic unit pressures at kx >= 0 and some ky, (nx // 2 + 1, columns) [m/Pa].

    columns : range of wavenumbers along y. The values are those of `surface_response`, which is even in kx.

    Raises
    ------
    InputError : a grid that is not periodic along both axes.
    """
    _check(grid)
    kx, ky = grid.wavevectors()
    kx, ky = np.abs(kx[: grid.shape[0] // 2 + 1]), ky[:, columns]
    if not body.homogeneous:
        return frequency_response.surface_response(kx, ky, body, Load.NORMAL)
    if not body.boussinesq:
        return np.asarray(special_surface(body.material).surface_response(kx, ky, body.material))
    q = np.hypot(kx, ky)
    return np.divide(2 / body.material.plane_strain_modulus, q, out=np.zeros_like(q), where=q > 0)


def in_plane_response(grid: Grid, body: Body) -> FloatArray:
    """Return the in-plane surface displacements under harmonic unit tractions, shape (3, nx, ny//2 + 1) [m/Pa].

    ux under traction along x, uy under traction along y: (1 - nu cos^2) / (G q) and (1 - nu sin^2) / (G q) with the
    angle of the wavevector from x, the transform of Cerruti's solution; of one under the other: -nu cos sin / (G q).
    Mean mode 0. With layers: see `layered.frequency_response`.

    Raises
    ------
    InputError : a grid that is not periodic along both axes; a crystal or surface tension.
    """
    _check(grid)
    refuse_special_surface(body, "displacements under traction")
    kx, ky, q, odd_x, odd_y = _wavevectors(grid)
    if body.homogeneous:
        nu, scale = body.material.poissons_ratio, 1 / (body.material.shear_modulus * q)
        out = np.stack([1 - nu * (kx / q) ** 2, 1 - nu * (ky / q) ** 2, -nu * odd_x * odd_y / q**2]) * scale
        out[:, 0, 0] = 0.0
        return out
    half = grid.shape[0] // 2 + 1
    out = _mirrored(frequency_response.in_plane_response(kx[:half], ky[:half], body), grid.shape[0], IN_PLANE_PARITY)
    out[2] *= (odd_x == kx) & (odd_y == ky)
    return out


def stress_response(grid: Grid, body: Body, depth: float, load: Load) -> FloatArray:
    """Return the stresses (xx yy zz yz xz xy) at `depth` [m] of a harmonic unit load: (6, nx, ny//2 + 1) [Pa/Pa].

    The spectrum where the kernel is even, its imaginary part where it is odd (see `coefficients.STRESS_PARITY`).

    Raises
    ------
    InputError : a grid that is not periodic along both axes, a negative depth, a crystal or surface tension.
    """
    _check(grid)
    refuse_special_surface(body, "stresses below the surface")
    if not (np.isfinite(depth) and depth >= 0):
        raise InputError(f"depth: {depth!r} must be finite and not negative [m]")
    kx, ky, q, odd_x, odd_y = _wavevectors(grid)
    if not body.homogeneous:
        half = grid.shape[0] // 2 + 1
        rows = frequency_response.stress_response(kx[:half], ky[:half], body, float(depth), load)
        out = _mirrored(rows, grid.shape[0], STRESS_PARITY[load])
        for component, (parity_x, parity_y) in enumerate(STRESS_PARITY[load]):
            if parity_x < 0:
                out[component] *= odd_x == kx
            if parity_y < 0:
                out[component] *= odd_y == ky
        return out
    nu = body.material.poissons_ratio
    z = float(depth)
    decay = np.exp(-q * z)
    cx, cy = kx / q, ky / q
    ox, oy = odd_x / q, odd_y / q
    qz = q * z
    out = np.empty((6, *q.shape))
    if load is Load.NORMAL:
        out[0] = decay * ((qz - (1 - 2 * nu)) * cx**2 - 2 * nu)
        out[1] = decay * ((qz - (1 - 2 * nu)) * cy**2 - 2 * nu)
        out[2] = -decay * (1 + qz)
        out[3] = decay * qz * oy
        out[4] = decay * qz * ox
        out[5] = decay * (qz - (1 - 2 * nu)) * ox * oy
        mean = [-nu / (1 - nu), -nu / (1 - nu), -1.0, 0.0, 0.0, 0.0]
    else:
        out[0] = decay * ox * (2 + 2 * nu - (2 * nu + qz) * cx**2)
        out[1] = decay * ox * (2 * nu - (2 * nu + qz) * cy**2)
        out[2] = decay * qz * ox
        out[3] = decay * qz * ox * oy
        out[4] = decay * (qz * cx**2 - 1)
        out[5] = decay * oy * (1 - (2 * nu + qz) * cx**2)
        mean = [0.0, 0.0, 0.0, 0.0, -1.0, 0.0]
    out[:, 0, 0] = mean
    return out
