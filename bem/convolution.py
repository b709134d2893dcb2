"""Displacement operator: normal surface displacement of one body or a pair under pressure, as a discrete convolution.

One operator serves free and periodic axes, homogeneous and layered bodies, and friction. Source: discrete convolution
with zero padding (Liu, Wang and Liu 2000); the kernels have sources of their own.

1. Arguments. `displacement_operator` checks them. Kernels and spectra are computed when an application or a property
   (`unit`, `symmetric`, `near_field`, `scaled`) first needs them.
2. Influence coefficients (`bem.kernels.coefficients`) of each body, summed over both (`_spectrum_of_pair`). A doubly
   periodic grid takes the response to harmonic loads instead (`bem.kernels.spectral`); its mean displacement is zero.
   Homogeneous, isotropic bodies have proportional kernels, so one kernel is computed; else one for each body.
3. Friction. The traction friction x pressure adds the coefficients of the tangential load, lower body minus upper, if
   traction changes the normal gap (`couples`: Dundurs' beta is not zero, or layers differ).
4. Spectrum (`bem.transforms.kernel_spectra`), padded with zeros along free axes. Every kernel is even or odd along each
   axis, so its spectrum is a quarter array of real numbers. That of pressure is even; a crystal that does not respond
   alike on both sides of the x axis adds one that is odd along both axes, since every kernel of pressure is the same at
   opposite offsets (Betti's theorem). Spectra are cached by grid and elastic constants, within a
   limit on memory, and shared by all operators (`cached_spectra`). Cost: a transform for each kernel of step 2, once
   for each grid, coarser ones included; none on doubly periodic grids, whose responses are the spectrum.
5. Scaling. The spectrum is divided by `unit`, a power of two [m/Pa], so that it is of order one: single precision
   cannot overflow, and results have the same digits in every system of units.
6. Application (`ScaledConvolution`): one transform forward and one back (`bem.transforms`), in double or single
   precision. Cost: n log n.
7. Parts for the contact solver: `coarsened` gives coarser grids, `near_field` and `smooth_part` parts of its
   preconditioner, and `scaled_inverse` full contact of a doubly periodic gap.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, TypeVar

import numpy as np
from numpy.typing import DTypeLike, NDArray

from bem.arguments import is_finite
from bem.errors import InputError
from bem.grid import Grid
from bem.kernels.coefficients import Load, odd_surface_coefficients, surface_coefficients
from bem.kernels.layered import frequency_response
from bem.kernels.loads import refuse_special_surface
from bem.kernels.spectral import odd_surface_response, surface_response
from bem.materials import Body, Material
from bem.numerics.cache import KeptValues, Sized, bytes_of
from bem.transforms import (
    Multiplier,
    PaddedTransform,
    kernel_spectrum,
    multiplier,
    offset_cosines,
    padded_shape,
    transform_of,
)
from bem.transforms.loops import Factor, Scratch, TransformPlan

FloatArray = NDArray[np.float64]

_SAME = 1e-14
"""Relative difference of moduli below which two bodies count as elastically equal (round-off of input)."""

SMALLEST_GRID = 16
"""Least number of cells along the longer side of a grid of `coarsened`."""


class ConvolutionCount(threading.local):
    """Number of applications of an operator and of its coarser grids.

    Each thread has counts of its own, so that contacts solved concurrently on one operator do not share them.

    applications : number of applications.
    weighted : the same, each weighted by its number of cells over that of the finest grid.
    """

    applications: int = 0
    weighted: float = 0.0

    def __reduce__(self) -> tuple[type[ConvolutionCount], tuple[()]]:
        return ConvolutionCount, ()  # the count of an unpickled operator starts at zero

    @staticmethod
    def round_weight(weight: float) -> float:
        """Round a weight to a multiple of 2^-32, so that sums up to two million are exact in any order."""
        return round(weight * 2.0**32) / 2.0**32


@dataclass
class KernelCount:
    """Number of kernels evaluated in this process, by load; for tests and reports."""

    normal: int = 0
    tangential: int = 0
    in_plane: int = 0

    def reset(self) -> None:
        """Set all counts to zero."""
        self.normal = self.tangential = self.in_plane = 0


COUNT = KernelCount()
"""Kernels evaluated by this process (spectra taken from the cache are not counted)."""

EVEN, ODD_IN_X, ODD_IN_BOTH = (1, 1), (-1, 1), (-1, -1)
"""Parity (in x, in y) of the kernel of pressure, of that of traction along x, and of what crystals add to the first."""


@dataclass(frozen=True)
class KernelSpectra:
    """Kernel spectra of a pair of bodies on a grid, as quarter arrays (py // 2 + 1, px // 2 + 1), divided by `unit`.

    even : spectrum of the kernel of pressure, with the local compliance.
    odd : imaginary part of the spectrum of the kernel of friction x traction; None if it does not couple.
    unit : power of two [m/Pa].
    odd_in_both : minus the spectrum of the part of the kernel of pressure that is odd along both axes, as
        `kernel_spectrum` gives it; None if both bodies respond alike on both sides of the x axis. Without friction.
    """

    even: FloatArray
    odd: FloatArray | None
    unit: float
    odd_in_both: FloatArray | None = None

    @property
    def nbytes(self) -> int:
        """Memory [bytes]."""
        return sum(part.nbytes for part in (self.even, self.odd, self.odd_in_both) if part is not None)


_SPECTRA = KeptValues()


def set_spectra_memory(limit: int) -> None:
    """Set the memory [bytes] that cached kernel spectra may hold; default 512 MiB, 0 caches none.

    Raises
    ------
    InputError : not a number of bytes.
    """
    _SPECTRA.resize(bytes_of("set_spectra_memory", limit))


def spectra_memory() -> int:
    """Return the memory held by cached kernel spectra [bytes]."""
    return _SPECTRA.nbytes


_Cached = TypeVar("_Cached", bound=Sized)


def cached_spectra(key: tuple[Any, ...], make: Callable[[], _Cached]) -> _Cached:
    """Return the spectra of a key from the cache of this process; `make` computes them if they are not there."""
    return _SPECTRA.of(key, make)


def elastic_constants(body: Body) -> tuple[Any, ...]:
    """Return the properties that determine the elastic response of a body.

    Young's modulus and Poisson's ratio of each medium, then the depths of the interfaces; of a crystal its stiffness,
    and of a surface under tension its tension too.
    """
    if not body.boussinesq and body.homogeneous:
        material = body.material
        return (material.stiffness or _moduli(material), material.surface_tension)
    return (*(value for solid in body.media for value in _moduli(solid)), *body.interfaces)


def _moduli(material: Material) -> tuple[float, float]:
    return (material.youngs_modulus, material.poissons_ratio)


def _coupling(body: Body) -> float:
    """Return (1 - 2 nu)/2G [1/Pa], the factor of the normal displacement of a homogeneous body under traction."""
    return (1 - 2 * body.material.poissons_ratio) / (2 * body.material.shear_modulus)


def couples(bodies: tuple[Body, ...]) -> bool:
    """Return True if traction changes the normal gap: Dundurs' beta is not zero, or layered bodies differ."""
    if not all(body.homogeneous for body in bodies):
        return len(bodies) == 1 or elastic_constants(bodies[0]) != elastic_constants(bodies[1])
    total = sum((-1) ** i * _coupling(body) for i, body in enumerate(bodies))
    return abs(total) > _SAME * sum(abs(_coupling(body)) + 1 / body.material.shear_modulus for body in bodies)


def _mean_response(body: Body, wavenumber: float) -> float:
    """Return u / p [m/Pa] of a harmonic pressure of a wavenumber [rad/m], the mean over its directions."""
    if not body.boussinesq and body.homogeneous:
        material = body.material
        return 2 / (material.plane_strain_modulus * wavenumber * (1 + wavenumber * material.elastocapillary_length))
    return float(frequency_response.surface_response(wavenumber, 0.0, body, Load.NORMAL))


def pressure_terms(bodies: tuple[Body, ...]) -> list[tuple[Body, float]]:
    """Return the bodies whose responses to pressure are computed, each with its factor in the sum of both bodies."""
    return _terms(bodies, Load.NORMAL)


def _terms(bodies: tuple[Body, ...], load: Load) -> list[tuple[Body, float]]:
    """Return the bodies whose kernels are computed, and their factors: sum for pressure, difference for traction."""
    signs = (1.0, 1.0) if load is Load.NORMAL else (1.0, -1.0)
    if not all(body.boussinesq for body in bodies):
        return list(zip(bodies, signs, strict=False))
    # kernels of homogeneous, isotropic half-spaces are proportional to each other: one is computed
    factors = [1 / b.material.plane_strain_modulus if load is Load.NORMAL else _coupling(b) for b in bodies]
    first = max(range(len(bodies)), key=lambda i: abs(factors[i]))
    scale = sum(s * f for s, f in zip(signs, factors, strict=False)) / factors[first]
    return [(bodies[first], scale)]


def _spectrum_of_pair(grid: Grid, bodies: tuple[Body, ...], load: Load) -> FloatArray:
    """Compute the spectrum [m/Pa] of the kernel of both bodies: the sum for pressure, lower minus upper for traction.

    (py // 2 + 1, px // 2 + 1); the imaginary part for traction.
    """
    terms = _terms(bodies, load)
    padded = padded_shape(grid.shape, grid.periodic)
    parity = EVEN if load is Load.NORMAL else ODD_IN_X
    total: FloatArray | None = None
    for body, factor in terms:
        if load is Load.NORMAL:
            COUNT.normal += 1
        else:
            COUNT.tangential += 1
        if all(grid.periodic):
            response = surface_response(grid, body, load)
            spectrum = np.ascontiguousarray(response[: padded[0] // 2 + 1].T)
            if load is Load.TANGENTIAL and padded[0] % 2 == 0:
                spectrum[:, -1] = 0  # an odd function has no component at the highest wavenumber
        else:
            spectrum = kernel_spectrum(surface_coefficients(grid, body, load), padded, parity)
        spectrum *= factor
        total = spectrum if total is None else total + spectrum
    assert total is not None
    return total


def _odd_spectrum_of_pair(grid: Grid, bodies: tuple[Body, ...]) -> FloatArray | None:
    """Compute `KernelSpectra.odd_in_both` [m/Pa] of both bodies; None if both respond alike on both sides of x."""
    padded = padded_shape(grid.shape, grid.periodic)
    total: FloatArray | None = None
    for body in bodies:
        if all(grid.periodic):
            response = odd_surface_response(grid, body)
            spectrum = None if response is None else np.ascontiguousarray(-response[: padded[0] // 2 + 1].T)
        else:
            table = odd_surface_coefficients(grid, body)
            spectrum = None if table is None else kernel_spectrum(table, padded, ODD_IN_BOTH)
        if spectrum is not None:
            total = spectrum if total is None else total + spectrum
    return total


def _spectra(grid: Grid, bodies: tuple[Body, ...], friction: float, compliance: float) -> KernelSpectra:
    """Return the kernel spectra of the pair from the cache, or compute them."""
    coupled = friction != 0 and couples(bodies)

    def make() -> KernelSpectra:
        even = _spectrum_of_pair(grid, bodies, Load.NORMAL)
        if compliance > 0:
            # the local compliance is the same for every wave; the mean displacement of a doubly periodic grid is zero
            even = np.where(even == 0, 0.0, even + compliance) if all(grid.periodic) else even + compliance
        largest = float(np.abs(even).max())
        unit = 2.0 ** round(math.log2(largest)) if largest > 0 else 1.0
        even /= unit
        odd = _spectrum_of_pair(grid, bodies, Load.TANGENTIAL) * (friction / unit) if coupled else None
        odd_in_both = _odd_spectrum_of_pair(grid, bodies)
        return KernelSpectra(even, odd, unit, None if odd_in_both is None else odd_in_both / unit)

    constants = tuple(elastic_constants(body) for body in bodies)
    key = (grid, constants, friction if coupled else 0.0, compliance)
    return cached_spectra(key, make)


@dataclass(frozen=True)
class ScaledConvolution:
    """Displacement operator divided by its unit, in one precision; `apply` writes into preallocated arrays.

    transform, multiplier : of the convolution.
    count : applications so far, shared with the operator.
    weight : of an application in `count`: its number of cells over that of the finest grid.
    """

    transform: PaddedTransform
    multiplier: Multiplier
    count: ConvolutionCount
    weight: float

    @property
    def dtype(self) -> np.dtype[Any]:
        """Precision of fields."""
        return self.transform.dtype

    def apply(self, values: NDArray[Any], out: NDArray[Any]) -> NDArray[Any]:
        """Convolve `values` (nx, ny) into `out`, which may be the same array."""
        self.count.applications += 1
        self.count.weighted += self.weight
        return self.transform.convolve(values, self.multiplier, out)

    def apply_to_cells(self, cells: NDArray[np.int64], values: FloatArray, out: NDArray[Any]) -> NDArray[Any]:
        """Convolve a field that is zero except for `values` (n,) on `cells` (n,) into `out` (nx, ny).

        cells : flat indices, ascending.
        """
        self.count.applications += 1
        self.count.weighted += self.weight
        return self.transform.convolve_cells(cells, values, self.multiplier, out)

    def compiled(self) -> tuple[TransformPlan, Scratch, Factor]:
        """Return the arguments of `transforms.loops.convolve` for compiled loops that convolve themselves.

        The caller holds the transform's lock while such a loop runs, and reports its applications to `counted`.
        """
        factor = self.multiplier.factor(self.transform.dtype)
        return self.transform.plan_for(factor), self.transform.ready(1), factor

    def counted(self, applications: int) -> None:
        """Add the number of applications of a compiled loop that called `transforms.loops.convolve`."""
        self.count.applications += applications
        self.count.weighted += applications * self.weight
        self.transform.counted(applications)


@dataclass(frozen=True)
class _EvenPart:
    """Spectra on a grid without the part of friction."""

    whole: Callable[[Grid], KernelSpectra]

    def __call__(self, grid: Grid) -> KernelSpectra:
        return replace(self.whole(grid), odd=None)


@dataclass(frozen=True)
class DisplacementOperator:
    """Callable: pressure (nx, ny) [Pa] -> normal surface displacement (nx, ny) [m], the sum over both bodies.

    On a doubly periodic grid the mean displacement is zero by definition: the mean pressure moves the datum only.

    grid, bodies, friction, compliance : see `displacement_operator`.
    spectra_on : returns the spectra on a grid, in place of those of normal displacement under pressure.
    count : applications so far by the calling thread.
    weight : of an application in `count`: its number of cells over that of the finest grid.
    """

    grid: Grid
    bodies: tuple[Body, ...]
    friction: float = 0.0
    compliance: float = field(default=0.0, kw_only=True)
    spectra_on: Callable[[Grid], KernelSpectra] | None = field(default=None, kw_only=True, repr=False)
    count: ConvolutionCount = field(default_factory=ConvolutionCount, compare=False, repr=False)
    weight: float = field(default=1.0, compare=False, repr=False)

    @cached_property
    def _spectra(self) -> KernelSpectra:
        if self.spectra_on is not None:
            return self.spectra_on(self.grid)
        return _spectra(self.grid, self.bodies, self.friction, self.compliance)

    @property
    def unit(self) -> float:
        """Power of two [m/Pa] near the largest value of the spectrum, which scales it to order one."""
        return self._spectra.unit

    @property
    def contact_modulus(self) -> float:
        """E* [Pa] of the surface materials."""
        return 1 / sum(1 / body.surface_material.plane_strain_modulus for body in self.bodies)

    def modulus_at(self, wavenumber: float) -> float:
        """Return the effective contact modulus E* [Pa] under a harmonic pressure of a wavenumber [rad/m].

        Of crystals it is that of the mean over all directions.
        """
        if wavenumber not in self._moduli:
            response = sum(_mean_response(body, wavenumber) for body in self.bodies)
            self._moduli[wavenumber] = 2 / (wavenumber * response)
        return self._moduli[wavenumber]

    @cached_property
    def _moduli(self) -> dict[float, float]:
        return {}

    @property
    def symmetric(self) -> bool:
        """True if friction does not couple into normal displacement; of `spectra_on`, if these have no odd part."""
        if self.spectra_on is None:  # decided by the bodies: no spectrum is computed
            return self.friction == 0 or not couples(self.bodies)
        return self._spectra.odd is None

    @cached_property
    def frictionless(self) -> DisplacementOperator:
        """Operator of the same bodies, or of the even part of `spectra_on`, without the coupling of friction; it shares
        this operator's count."""
        spectra_on = None if self.spectra_on is None else _EvenPart(self.spectra_on)
        return replace(self, friction=0.0, spectra_on=spectra_on)

    @property
    def mean_free(self) -> bool:
        """True if a uniform pressure gives no displacement (doubly periodic grids)."""
        return all(self.grid.periodic)

    @property
    def padded(self) -> tuple[int, int]:
        """Lengths of the transforms."""
        return padded_shape(self.grid.shape, self.grid.periodic)

    def scaled(self, dtype: DTypeLike = np.float64) -> ScaledConvolution:
        """Return the operator divided by `unit`, in float64 or float32."""
        key = (np.dtype(dtype).char, "displacement")
        if key not in self._multipliers:
            parts = [(self._spectra.even, EVEN, 1.0)]
            if self._spectra.odd is not None:
                parts.append((self._spectra.odd, ODD_IN_X, 1.0))
            if self._spectra.odd_in_both is not None:
                parts.append((self._spectra.odd_in_both, ODD_IN_BOTH, 1.0))
            self._multipliers[key] = multiplier(parts, self.padded[0]).astype(dtype)
        transform = transform_of(self.grid.shape, self.padded, dtype)
        return ScaledConvolution(transform, self._multipliers[key], self.count, self.weight)

    def scaled_inverse(self, dtype: DTypeLike = np.float64) -> ScaledConvolution:
        """Return the inverse of the scaled operator on a doubly periodic grid, with friction; its mean mode is zero."""
        key = (np.dtype(dtype).char, "inverse")
        if key not in self._multipliers:
            even, odd, odd_in_both = self._spectra.even, self._spectra.odd, self._spectra.odd_in_both
            # positive for all waves but the mean: the bound only guards against round-off in the response of layers
            floor = 1e-3 * float(even.min(initial=math.inf, where=even > 0))
            bounded = np.maximum(np.abs(even), floor)
            if odd_in_both is not None:
                # 1 / (S + T) and 1 / (S - T) at both signs of kx: S / (S^2 - T^2) and -T / (S^2 - T^2)
                inverse = np.divide(1.0, bounded**2 - odd_in_both**2, out=np.zeros_like(even), where=even != 0)
                parts = [(inverse * bounded, EVEN, 1.0), (inverse * odd_in_both, ODD_IN_BOTH, -1.0)]
            elif odd is None:
                parts = [(np.divide(1.0, bounded, out=np.zeros_like(even), where=even != 0), EVEN, 1.0)]
            else:
                # 1 / (S + iA) = (S - iA) / (S^2 + A^2)
                inverse = np.divide(1.0, bounded**2 + odd**2, out=np.zeros_like(even), where=even != 0)
                parts = [(inverse * bounded, EVEN, 1.0), (inverse * odd, ODD_IN_X, -1.0)]
            self._multipliers[key] = multiplier(parts, self.padded[0]).astype(dtype)
        transform = transform_of(self.grid.shape, self.padded, dtype)
        return ScaledConvolution(transform, self._multipliers[key], self.count, self.weight)

    def smooth_part(self, fine: DisplacementOperator, near: float) -> ScaledConvolution | None:
        """Return the even part with the constant `near` taken off its spectrum, in single precision.

        The constant stands for the local response, which the finer grid computes itself. The result maps the finer
        operator's pressure, summed over each cell of this grid, to displacements in units of the finer operator.

        fine : operator on the finer grid.
        near : constant, in the finer operator's unit; values of the spectrum below it become zero. None is returned if
            all do.
        """
        key = ("smooth", fine.unit, near)
        if key not in self._multipliers:
            rest = np.maximum(self._spectra.even * (self.unit / fine.unit) - near, 0.0)
            rest *= fine.grid.cell_area / self.grid.cell_area
            self._multipliers[key] = Multiplier(rest).astype(np.float32)
        part = self._multipliers[key]
        if part.real is None or not part.real.any():
            return None
        return ScaledConvolution(transform_of(self.grid.shape, self.padded, np.float32), part, self.count, self.weight)

    @cached_property
    def _multipliers(self) -> dict[Any, Multiplier]:
        return {}

    def near_field(self, radius: int) -> FloatArray:
        """Return the influence coefficients of the even part over `unit` up to `radius` cells away.

        (2 radius + 1, 2 radius + 1), offset zero in the middle; from the spectrum, so with the images of periodic axes.
        Preconditioners take it for the whole, of which it is the mean with its mirror image.
        """
        if radius not in self._near_fields:
            px, py = self.padded
            offsets = np.arange(-radius, radius + 1)
            along_x = offset_cosines(px, offsets)
            along_y = offset_cosines(py, offsets)
            # einsum: no threads of a BLAS library, the same bits everywhere
            rows = np.einsum("jk,kl->jl", along_y, self._spectra.even)
            self._near_fields[radius] = np.einsum("il,jl->ij", along_x, rows)
        return self._near_fields[radius]

    @cached_property
    def _near_fields(self) -> dict[int, FloatArray]:
        return {}

    def coarsened(self) -> DisplacementOperator | None:
        """Return the operator on a grid of half as many cells along each axis; None if that grid is too small."""
        if self._coarser:
            return self._coarser[0]
        grid = self.grid.coarsened()
        coarser = (
            None
            if max(grid.shape) < SMALLEST_GRID
            else DisplacementOperator(
                grid,
                self.bodies,
                self.friction,
                self.count,
                ConvolutionCount.round_weight(self.weight * grid.cells / self.grid.cells),
                compliance=self.compliance,
                spectra_on=self.spectra_on,
            )
        )
        self._coarser.append(coarser)
        return coarser

    @cached_property
    def _coarser(self) -> list[DisplacementOperator | None]:
        return []

    def __call__(self, pressure: FloatArray) -> FloatArray:
        """Return the displacement [m] under a pressure [Pa], both (nx, ny).

        Raises
        ------
        InputError : another shape, or values that are not finite.
        """
        pressure = self.grid.check_field(pressure, "pressure")
        displacement = np.empty(self.grid.shape)
        self.scaled().apply(pressure, displacement)
        displacement *= self.unit
        return displacement


def displacement_operator(
    grid: Grid, bodies: Body | tuple[Body, Body], *, friction: float = 0.0, compliance: float = 0.0
) -> DisplacementOperator:
    """Return the operator from pressure to normal displacement of one body (the other rigid) or a pair.

    Parameters
    ----------
    grid : cells, free or periodic along each axis.
    bodies : one Body, or (lower, upper).
    friction : f; the traction is f x pressure, along +x on the lower body and along -x on the upper one. It is computed
        only if it changes the normal gap (Dundurs' beta is not zero, or layers differ).
    compliance : additional local displacement per unit pressure at the same point [m/Pa]: a soft thin film, or wear in
        a step.

    Raises
    ------
    InputError : not a Grid, not one or two bodies, a friction or compliance that is not finite, friction on a crystal
        or a surface under tension.
    """
    messages = []
    if not isinstance(grid, Grid):
        messages.append(f"displacement_operator: grid {grid!r} must be a Grid")
    pair = (bodies,) if isinstance(bodies, Body) else bodies
    if not isinstance(pair, tuple | list) or len(pair) not in (1, 2) or not all(isinstance(b, Body) for b in pair):
        messages.append(f"displacement_operator: bodies {bodies!r} must be one Body or a pair of them")
    if not is_finite(friction):
        messages.append(f"displacement_operator: friction {friction!r} must be a finite number")
    if not (is_finite(compliance) and compliance >= 0):
        messages.append(f"displacement_operator: compliance {compliance!r} must be zero or positive and finite [m/Pa]")
    if messages:
        raise InputError(messages)
    for body in pair:
        if friction != 0:
            refuse_special_surface(body, "displacements under friction")
    return DisplacementOperator(grid, tuple(pair), float(friction), compliance=float(compliance))
