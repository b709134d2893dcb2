"""Stiffness of an anisotropic crystal, its orientation under a surface, and the compliance of that surface.

A wave of normal load of wavevector q on the surface of a half-space gives u = A(phi) p / q, where phi is the angle of q
from x. A is the normal component of the inverse of the second Barnett-Lothe tensor L of the plane of q and the normal:

    L = 1/pi integral of (Q - R T^-1 R^t) over omega from 0 to pi,   Q = (mm), R = (mn), T = (nn),
    (ab)_ik = C_ijkl a_j b_l,   m = cos(omega) q/|q| + sin(omega) z,   n = -sin(omega) q/|q| + cos(omega) z.

Source: D. M. Barnett & J. Lothe, Phys. Norvegica 7 (1973) 13, in the notation of T. C. T. Ting, Anisotropic Elasticity
(1996), sections 7.6 and 8.3; the originals were not read for this code. The integrand is analytic and periodic, so that
the trapezoidal rule converges exponentially. Unlike the sextic eigenvalue problem of Stroh it needs no care where
eigenvalues coincide, as those of isotropic solids do. Verified in tests/kernels/test_anisotropic.py.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from bem.arguments import is_finite
from bem.errors import InputError
from bem.representation import tabled

FloatArray = NDArray[np.float64]

CRYSTALS: dict[str, tuple[str, ...]] = {
    "cubic": ("c11", "c12", "c44"),
    "hexagonal": ("c11", "c12", "c13", "c33", "c44"),
    "trigonal": ("c11", "c12", "c13", "c14", "c33", "c44"),
    "tetragonal": ("c11", "c12", "c13", "c33", "c44", "c66"),
    "orthotropic": ("c11", "c12", "c13", "c22", "c23", "c33", "c44", "c55", "c66"),
}
"""Independent constants of each crystal in its own axes, Voigt's order xx, yy, zz, yz, xz, xy; the axis of symmetry of
the hexagonal (transversely isotropic), trigonal and tetragonal ones is z."""

_SAME_AS: dict[str, dict[str, str]] = {
    "cubic": {"c22": "c11", "c33": "c11", "c13": "c12", "c23": "c12", "c55": "c44", "c66": "c44"},
    "hexagonal": {"c22": "c11", "c23": "c13", "c55": "c44"},
    "trigonal": {"c22": "c11", "c23": "c13", "c55": "c44", "c56": "c14"},
    "tetragonal": {"c22": "c11", "c23": "c13", "c55": "c44"},
    "orthotropic": {},
}

_VOIGT = np.array([[0, 5, 4], [5, 1, 3], [4, 3, 2]])
"""Voigt's index of a pair of axes."""

_NAMES = tuple(f"c{i + 1}{j + 1}" for i in range(6) for j in range(i, 6))
"""Names of the constants of the upper triangle, row by row."""

_ROUND_OFF = 1e-15
_FEWEST, _MOST = 32, 2048
"""Points of the trapezoidal rules, doubled from the first to the last until round-off."""

Direction = tuple[float, float, float]


@tabled
@dataclass(frozen=True)
class Stiffness:
    """Elastic stiffness of a crystal and its orientation.

    Parameters
    ----------
    crystal : a name of `CRYSTALS`, or "general".
    matrix : 6 x 6 stiffnesses [Pa] in the crystal's axes, Voigt's order xx, yy, zz, yz, xz, xy; of "general" alone.
    normal : direction in the crystal's axes that points from the lower body to the upper one, of any length; Miller
        indices of the surface of a cubic crystal.
    along_x : direction in the crystal's axes along the grid's x; its part in the surface counts. By default the
        crystal's x, or its y where that is the normal. The grid's y lies along normal x along_x.
    **constants : the independent constants by name, such as c11=165.7e9 [Pa].

    Raises
    ------
    InputError : one message for each mistake; a stiffness that is not positive definite.
    """

    crystal: str
    constants: tuple[float, ...]
    normal: Direction
    along_x: Direction

    def __init__(
        self,
        crystal: str,
        *,
        matrix: Sequence[Sequence[float]] | None = None,
        normal: Sequence[float] = (0.0, 0.0, 1.0),
        along_x: Sequence[float] | None = None,
        **constants: float | None,
    ) -> None:
        given = {name: value for name, value in constants.items() if value is not None}
        values, messages = _upper_triangle(crystal, given, matrix)
        up, right, wrong = _axes(normal, along_x)
        messages += wrong
        if messages:
            raise InputError(messages)
        object.__setattr__(self, "crystal", crystal)
        object.__setattr__(self, "constants", values)
        object.__setattr__(self, "normal", up)
        object.__setattr__(self, "along_x", right)
        lowest = float(np.linalg.eigvalsh(self.matrix)[0])
        if not lowest > 1e-12 * float(np.abs(self.matrix).max()):
            raise InputError(
                f"Stiffness: not positive definite, its lowest eigenvalue is {lowest:.4g} Pa; a crystal of these "
                f"constants would be unstable (cubic: c11 > |c12|, c11 + 2 c12 > 0 and c44 > 0)"
            )

    def oriented(self, normal: Sequence[float], along_x: Sequence[float] | None = None) -> Stiffness:
        """Return the crystal in another orientation."""
        if self.crystal == "general":
            return Stiffness("general", matrix=self.matrix.tolist(), normal=normal, along_x=along_x)
        return Stiffness(self.crystal, matrix=None, normal=normal, along_x=along_x, **self.by_name)

    @property
    def by_name(self) -> dict[str, float]:
        """Independent constants by name [Pa]; empty for a general crystal."""
        values = dict(zip(_NAMES, self.constants, strict=True))
        return {name: values[name] for name in CRYSTALS.get(self.crystal, ())}

    @cached_property
    def matrix(self) -> FloatArray:
        """Stiffnesses in the crystal's axes (6, 6) [Pa]."""
        full = np.zeros((6, 6))
        full[np.triu_indices(6)] = self.constants
        return full + np.triu(full, 1).T

    @cached_property
    def rotation(self) -> FloatArray:
        """Unit vectors along the grid's x and y and along the normal, in the crystal's axes, (3, 3)."""
        up, right = np.array(self.normal), np.array(self.along_x)
        return np.array([right, np.cross(up, right), up])

    @cached_property
    def tensor(self) -> FloatArray:
        """Stiffnesses C_ijkl in the axes of the surface (3, 3, 3, 3) [Pa]."""
        turn = self.rotation
        crystal = self.matrix[_VOIGT[:, :, None, None], _VOIGT[None, None, :, :]]
        return np.asarray(np.einsum("ia,jb,kc,ld,abcd->ijkl", turn, turn, turn, turn, crystal, optimize=True))

    @property
    def poissons_ratio(self) -> float:
        """Poisson's ratio of the polycrystal: Hill's mean of Voigt's and Reuss' averages."""
        c, s = self.matrix, np.linalg.inv(self.matrix)
        c_sum, s_sum = c[:3, :3].sum(), s[:3, :3].sum()
        voigt_shear = (3 * np.trace(c[:3, :3]) - c_sum + 6 * np.trace(c[3:, 3:])) / 30
        reuss_shear = 15 / (6 * np.trace(s[:3, :3]) - 2 * s_sum + 3 * np.trace(s[3:, 3:]))
        bulk, shear = 0.5 * (c_sum / 9 + 1 / s_sum), 0.5 * (voigt_shear + reuss_shear)
        return float((3 * bulk - 2 * shear) / (6 * bulk + 2 * shear))

    @property
    def plane_strain_modulus(self) -> float:
        """Indentation modulus [Pa]: 2 over the mean of A, which stands for E / (1 - nu^2) of an isotropic solid.

        J. J. Vlassak, M. Ciavarella, J. R. Barber & X. Wang, J. Mech. Phys. Solids 51 (2003) 1701, for round contacts;
        not read, as cited by others.
        """
        return 2 / float(self.harmonics[0][0])

    @property
    def harmonics(self) -> tuple[FloatArray, FloatArray]:
        """Coefficients a_m of cos(2 m phi), m from 0, and b_m of sin(2 m phi), m from 1, of A(phi) [1/Pa]."""
        return _harmonics(self)

    @property
    def mirror_symmetric(self) -> bool:
        """Return True if the response of the surface is the same on both sides of the x axis, to 1e-9."""
        even, odd = self.harmonics
        return float(np.abs(odd).sum()) <= 1e-9 * float(even[0])

    def surface_compliance(self, angles: FloatArray) -> FloatArray:
        """Return A [1/Pa] at angles of the wavevector from x (n,) [rad]: u = A p / q."""
        points = _FEWEST
        found = _barnett_lothe(self.tensor, angles, points)
        while points < _MOST:
            points *= 2
            previous, found = found, _barnett_lothe(self.tensor, angles, points)
            if float(np.abs(found - previous).max()) <= _ROUND_OFF * float(found.max()) * math.sqrt(points):
                break
        return found


def _barnett_lothe(tensor: FloatArray, angles: FloatArray, points: int) -> FloatArray:
    """Return (L^-1)_zz of the planes at angles from x, with so many points of the trapezoidal rule."""
    along = np.stack([np.cos(angles), np.sin(angles), np.zeros_like(angles)], axis=1)
    up = np.array([0.0, 0.0, 1.0])
    # C contracted with the directions of the plane: (angles, 3, 3) each
    q0 = np.einsum("ijkl,pj,pl->pik", tensor, along, along, optimize=True)
    r0 = np.einsum("ijkl,pj,l->pik", tensor, along, up, optimize=True)
    t0 = np.broadcast_to(np.einsum("ijkl,j,l->ik", tensor, up, up), q0.shape)
    mixed = r0 + r0.transpose(0, 2, 1)
    total = np.zeros_like(q0)
    for omega in (np.arange(points) + 0.5) * (np.pi / points):
        c, s = math.cos(omega), math.sin(omega)
        q = c * c * q0 + c * s * mixed + s * s * t0
        t = s * s * q0 - c * s * mixed + c * c * t0
        r = c * c * r0 - s * s * r0.transpose(0, 2, 1) + c * s * (t0 - q0)
        total += q - r @ np.linalg.solve(t, r.transpose(0, 2, 1))
    return np.asarray(np.linalg.inv(total / points)[:, 2, 2])


@lru_cache(maxsize=256)
def _harmonics(stiffness: Stiffness) -> tuple[FloatArray, FloatArray]:
    count = _FEWEST
    while True:
        values = stiffness.surface_compliance(np.pi / count * np.arange(count, dtype=np.float64))
        spectrum = np.fft.rfft(values) / count
        small = np.abs(spectrum) <= 4 * _ROUND_OFF * abs(spectrum[0])
        if small[-(count // 8) :].all() or count >= _MOST:
            break
        count *= 2
    last = int(np.flatnonzero(~small)[-1])
    even, odd = 2 * spectrum.real[: last + 1], -2 * spectrum.imag[1 : last + 1]
    even[0] /= 2
    return even, odd


def _upper_triangle(
    crystal: str, given: dict[str, float], matrix: Sequence[Sequence[float]] | None
) -> tuple[tuple[float, ...], list[str]]:
    """Return the 21 constants of the upper triangle, row by row, and what is wrong."""
    if crystal == "general":
        messages = [f"Stiffness: {name} is given for a general crystal; allowed: matrix" for name in given]
        full = np.asarray(matrix if matrix is not None else [], dtype=np.float64) if _is_square(matrix) else None
        if full is None or not np.isfinite(full).all():
            messages.append("Stiffness: a general crystal needs matrix, 6 x 6 finite stiffnesses [Pa]")
        elif not np.allclose(full, full.T, rtol=1e-6, atol=1e-9 * float(np.abs(full).max())):
            messages.append("Stiffness: matrix is not symmetric")
        if messages or full is None:
            return (), messages
        return tuple(float(value) for value in (0.5 * (full + full.T))[np.triu_indices(6)]), []
    if crystal not in CRYSTALS:
        return (), [f"Stiffness: crystal {crystal!r}; allowed: {', '.join(CRYSTALS)}, general"]
    wanted = CRYSTALS[crystal]
    messages = [] if matrix is None else [f"Stiffness: matrix is given for a {crystal} crystal; allowed: general"]
    wrong = [name for name in given if name not in wanted] + [name for name in wanted if name not in given]
    if wrong:
        messages.append(
            f"Stiffness: a {crystal} crystal has {', '.join(wanted)}; given: {', '.join(sorted(given)) or 'none'}"
        )
    messages += [
        f"Stiffness: {name} {value!r} must be finite [Pa]" for name, value in given.items() if not is_finite(value)
    ]
    if messages:
        return (), messages
    known = dict(given)
    if crystal in ("hexagonal", "trigonal"):
        known["c66"] = 0.5 * (known["c11"] - known["c12"])
    if crystal == "trigonal":
        known["c24"] = -known["c14"]
    known |= {name: known[other] for name, other in _SAME_AS[crystal].items()}
    return tuple(float(known.get(name, 0.0)) for name in _NAMES), []


def _is_square(matrix: object) -> bool:
    return (
        isinstance(matrix, Sequence | np.ndarray)
        and len(matrix) == 6
        and all(isinstance(row, Sequence | np.ndarray) and len(row) == 6 for row in matrix)
    )


def _axes(normal: Sequence[float], along_x: Sequence[float] | None) -> tuple[Direction, Direction, list[str]]:
    """Return unit vectors along the normal and along x, and what is wrong."""
    nothing = (0.0, 0.0, 0.0)
    messages = [
        f"Stiffness: {name} {tuple(value)!r} must be three finite numbers, not all zero"
        for name, value in (("normal", normal), ("along_x", along_x))
        if value is not None and not (len(value) == 3 and all(map(is_finite, value)) and any(value))
    ]
    if messages:
        return nothing, nothing, messages
    up = _unit(normal)
    for right in [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0)] if along_x is None else [along_x]:
        flat = _unit(right)
        flat -= (flat @ up) * up
        length = float(np.linalg.norm(flat))
        if length > 1e-6:
            flat /= length
            return _direction(up), _direction(flat), []
    return nothing, nothing, [f"Stiffness: along_x {tuple(along_x or ())!r} is the normal; give a direction across it"]


def _unit(vector: Sequence[float]) -> FloatArray:
    """Return a vector divided by its length. It is scaled first, as the square of its length may overflow."""
    scaled = np.array(vector, dtype=np.float64)
    scaled /= np.abs(scaled).max()
    return np.asarray(scaled / np.linalg.norm(scaled))


def _direction(vector: FloatArray) -> Direction:
    x, y, z = (float(value) for value in vector)
    return x, y, z
