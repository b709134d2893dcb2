"""Displacement of bodies that touch on a curved surface, prismatic along x, under pressures along its normals.

Rows of cells follow the profile. A unit pressure on a cell moves another cell along the other cell's normal by

    cos(angle between the normals) C(x, d),

C the displacement of a half-space along its normal at the distance x along the rail and d, the chord, across it: the
load and the displacement are turned with the surface (Vollebregt 2021; abstract and outline read). What a half-space
moves along its surface is left out: of two bodies with Dundurs' beta = 0 it cancels, as both are drawn to the load.

Of a round shaft in a hole of the same material in plane strain, -cos(t) ln(2 sin(t/2)) is the exact kernel but for
rigid motions and the part of uniform pressure all around, of which it has twice the displacement (Michell; see
`bem.contact.shaft_in_bush`): a body of finite size decides that part. Against this closed form the highest pressure is
0.2, 0.8 and 1.6 % too high at half-angles of 10, 20 and 30 degrees, where a flat contact is 1.2, 4.8 and 11 % too low;
without that part it agrees within 0.03 % (tests/profiles/test_curved_contact.py).

Along x the influence is a convolution, applied by FFT with zeros beyond the grid; across it a dense matrix for each
wavenumber. Cost: rows^2 times cells along x.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from bem.convolution import couples
from bem.errors import InputError
from bem.grid import FloatArray, Grid
from bem.kernels.half_space import rectangle_displacement
from bem.materials import Body, Material, contact_modulus

MOST_ROWS = 512
"""Most rows of cells across: their matrices then take 0.5 GiB with 256 cells along x."""


@dataclass(frozen=True, eq=False)
class CurvedSurface:
    """A curved surface of two bodies: callable, pressure (nx, ny) [Pa] along the normals -> displacement (nx, ny) [m].

    Attributes
    ----------
    grid : cells along x and along the arc length of the profile.
    y, z : positions of the rows, (ny,) [m].
    angles : of the rows' tangents to the horizontal, (ny,) [rad].
    bodies : two bodies without layers. One under a rigid one is refused: its surface moves in its plane.

    Raises
    ------
    InputError : layers, crystals, surface tension, materials whose Dundurs' beta is not zero, periodic axes, or too
        many rows.
    """

    grid: Grid
    y: FloatArray
    z: FloatArray
    angles: FloatArray
    bodies: tuple[Body, ...]
    applications: list[int] = field(default_factory=lambda: [0], repr=False)

    def __post_init__(self) -> None:
        if any(body.layers for body in self.bodies):
            raise InputError("curved contact: a body has layers; allowed: homogeneous bodies")
        if not all(body.boussinesq for body in self.bodies):
            raise InputError(
                "curved contact: a body is a crystal or has surface tension; allowed: isotropic bodies without it"
            )
        if couples(self.bodies):
            cause = "the materials differ" if len(self.bodies) > 1 else "one body is rigid"
            raise InputError(
                f"curved contact: {cause}, so that pressures move the surfaces in their plane; allowed: bodies of one "
                "material, or of materials whose Dundurs' beta is zero"
            )
        if any(self.grid.periodic):
            raise InputError("curved contact: grid.periodic; allowed: a free grid")
        if self.grid.shape[1] > MOST_ROWS:
            raise InputError(f"curved contact: {self.grid.shape[1]} cells across; allowed: {MOST_ROWS} at most")

    @property
    def modulus(self) -> float:
        """Contact modulus of the bodies [Pa]."""
        materials: list[Material | None] = [body.material for body in self.bodies]
        assert materials[0] is not None
        return contact_modulus(materials[0], materials[1] if len(materials) > 1 else None)

    def cosines(self, angle: float) -> FloatArray:
        """Return the cosines (ny,) between the rows' normals and the normal of a tangent at an angle [rad]."""
        cosines: FloatArray = np.cos(self.angles - angle)
        return cosines

    @cached_property
    def _spectra(self) -> FloatArray:
        """Influence of rows on rows for each wavenumber along x, (2 nx // 2 + 1, ny, ny) [m/Pa]."""
        (nx, ny), sides = self.grid.shape, self.grid.spacing
        receiver, source = np.tril_indices(ny)
        chord = np.hypot(self.y[receiver] - self.y[source], self.z[receiver] - self.z[source])
        material = self.bodies[0].material
        along = sides[0] * np.arange(nx + 1)
        table = rectangle_displacement(along[:, None], chord, 0.0, sides, material)[2]
        # of both bodies together, by their moduli
        table *= material.plane_strain_modulus / self.modulus
        table *= np.cos(self.angles[receiver] - self.angles[source])
        # even along x: the transform of a row and its mirror image is real
        padded = np.concatenate([table, table[-2:0:-1]])
        spectrum = np.fft.rfft(padded, axis=0).real
        full = np.empty((nx + 1, ny, ny))
        full[:, receiver, source] = spectrum
        full[:, source, receiver] = spectrum
        return full

    def __call__(self, pressure: FloatArray) -> FloatArray:
        """Return the displacement along the normals (nx, ny) [m], both bodies together."""
        self.applications[0] += 1
        nx = self.grid.shape[0]
        spectrum = np.fft.rfft(pressure, 2 * nx, axis=0)
        parts = np.stack([spectrum.real, spectrum.imag], axis=2)
        moved = self._spectra @ parts
        displacement: FloatArray = np.fft.irfft(moved[..., 0] + 1j * moved[..., 1], 2 * nx, axis=0)[:nx]
        return displacement

    @cached_property
    def diagonal(self) -> float:
        """Displacement of a cell by its own unit pressure [m/Pa]."""
        own = rectangle_displacement(0.0, 0.0, 0.0, self.grid.spacing, self.bodies[0].material)[2]
        return float(own) * self.bodies[0].material.plane_strain_modulus / self.modulus
