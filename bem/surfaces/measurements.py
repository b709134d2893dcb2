"""Parameters of several measurements of one surface: means, scatter, averaged spectrum.

Takes maps as `read_surface` gives them. Verified in tests/surfaces/test_measurements.py on maps of known statistics.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from bem.errors import InputError
from bem.grid import FloatArray
from bem.representation import readable
from bem.surfaces.asperities import describe_asperities
from bem.surfaces.describe import RadialSpectrum, describe_surface, radial_spectrum
from bem.surfaces.finite_size import FiniteSizeError, finite_size_error
from bem.surfaces.material_ratio_curve import material_ratio
from bem.surfaces.self_affine import self_affine_fit_of_map
from bem.surfaces.surface import Surface

_PER_DECADE = 16
"""Wavenumbers of the averaged spectrum to a decade."""
_ROUND_OFF = 1e-9
"""Relative rounding error of wavenumbers."""
_PARAMETERS = {"none": 1, "plane": 3, "curvature": 6}
"""Parameters of each form that `read_surface` removes."""


def periodic_axes(surface: Surface) -> tuple[bool, bool]:
    """Return whether a map goes on across its edges along x and y, as its metadata say; measured maps do not."""
    known = surface.metadata.get("periodic")
    return (bool(known[0]), bool(known[1])) if isinstance(known, list | tuple) and len(known) == 2 else (False, False)


def finite_size_of(surface: Surface) -> FiniteSizeError:
    """Return the standard errors of a map by its finite size, with the waves that its levelling took."""
    return finite_size_error(surface, removed=_PARAMETERS.get(str(surface.metadata.get("detrend")), 1))


def parameters_of(surface: Surface) -> dict[str, float]:
    """Return all parameters of a map by name, in SI units: heights, material ratio, spectrum, asperities.

    Names of the spectrum's fit begin with `spectrum_`, nan where it is not self-affine; those of asperities with
    `asperity_`; standard errors by the finite size of the map end in `_finite_size_error`.
    """
    periodic = periodic_axes(surface)
    values = dataclasses.asdict(describe_surface(surface, periodic=periodic))
    errors = finite_size_of(surface)
    values |= {"Sq_finite_size_error": errors.Sq, "Sdq_finite_size_error": errors.Sdq}
    values |= {"independent_patches": errors.patches}
    curve = material_ratio(surface.heights)
    values |= {name: getattr(curve, name) for name in ("Sk", "Spk", "Svk", "Smr1", "Smr2")}
    fit = self_affine_fit_of_map(surface.heights, surface.spacing, periodic=periodic)
    if fit is not None:
        values |= {
            f"spectrum_{name}": value if fit.is_self_affine else math.nan
            for name, value in dataclasses.asdict(fit).items()
        }
    if min(surface.shape) >= 3:
        asperities = describe_asperities(surface, periodic=periodic)
        values |= {f"asperity_{name}": value for name, value in dataclasses.asdict(asperities).items()}
    return values


@dataclass(frozen=True)
class ParameterScatter:
    """A parameter over several measurements.

    Attributes
    ----------
    values : of the measurements, nan where one has none.
    finite_size : root mean square of the standard errors by the finite size of the maps; nan if unknown.
    """

    values: tuple[float, ...]
    finite_size: float = math.nan

    @property
    def known(self) -> FloatArray:
        """Values of the measurements that have the parameter."""
        return np.array([value for value in self.values if math.isfinite(value)])

    @property
    def mean(self) -> float:
        """Arithmetic mean of the measurements; nan if none has the parameter."""
        return float(self.known.mean()) if self.known.size else math.nan

    @property
    def scatter(self) -> float:
        """Standard deviation of the measurements (of n - 1); nan with fewer than two."""
        return float(self.known.std(ddof=1)) if self.known.size > 1 else math.nan


@readable
@dataclass(frozen=True, eq=False)
class MeanSpectrum:
    """Radial power spectral density averaged over measurements.

    Attributes
    ----------
    wavenumber : (n,) angular [rad/m].
    density : (n,) mean of the measurements that reach this wavenumber [m^4].
    scatter : (n,) standard deviation of ln(density) over them; nan where only one does.
    measurements : (n,) their number.
    """

    wavenumber: FloatArray
    density: FloatArray
    scatter: FloatArray
    measurements: FloatArray


@dataclass(frozen=True)
class Measurements:
    """Several measurements of one surface.

    Attributes
    ----------
    parameters : by their names of `parameters_of`.
    spectrum : averaged over the measurements.
    """

    parameters: dict[str, ParameterScatter]
    spectrum: MeanSpectrum


def describe_measurements(surfaces: Sequence[Surface]) -> Measurements:
    """Describe several measurements of one surface: every parameter with its scatter, and the averaged spectrum.

    Parameters
    ----------
    surfaces : two or more maps; cells and sizes may differ.

    Raises
    ------
    InputError : fewer than two maps, or one that is too small for a spectrum.
    """
    if len(surfaces) < 2:
        raise InputError(f"describe_measurements: {len(surfaces)} map; give two or more")
    found = [parameters_of(surface) for surface in surfaces]
    names = dict.fromkeys(name for one in found for name in one)
    parameters = {}
    for name in names:
        errors = [one.get(f"{name}_finite_size_error", math.nan) for one in found]
        finite = math.sqrt(float(np.mean(np.square(errors))))
        parameters[name] = ParameterScatter(tuple(one.get(name, math.nan) for one in found), finite)
    return Measurements(parameters, mean_spectrum(surfaces))


def mean_spectrum(surfaces: Sequence[Surface]) -> MeanSpectrum:
    """Average the radial power spectral densities of maps at wavenumbers that rise by equal factors.

    Rings of a map between two such wavenumbers are averaged, each by its number of waves; where the rings lie further
    apart, the density is a power law between them. A map counts between its lowest and its highest ring.

    Raises
    ------
    InputError : a map of fewer than 4 x 4 cells.
    """
    spectra = [radial_spectrum(one.heights, one.spacing, periodic=periodic_axes(one)) for one in surfaces]
    lowest = min(float(one.wavenumber[0]) for one in spectra)
    highest = max(float(one.wavenumber[-1]) for one in spectra)
    count = max(2, math.ceil(_PER_DECADE * math.log10(highest / lowest)) + 1)
    wavenumber = np.geomspace(lowest, highest, count)
    edges = np.sqrt(wavenumber[1:] * wavenumber[:-1])
    table = np.array([_density_at(one, wavenumber, edges) for one in spectra])
    number = np.isfinite(table).sum(axis=0).astype(np.float64)
    kept = number > 0
    table, number = table[:, kept], number[kept]
    deviation = np.log(table) - np.nanmean(np.log(table), axis=0)
    spread = np.sqrt(np.nansum(deviation**2, axis=0) / np.maximum(number - 1, 1))
    scatter = np.where(number > 1, spread, math.nan)
    return MeanSpectrum(wavenumber[kept], np.nanmean(table, axis=0), scatter, number)


def _density_at(spectrum: RadialSpectrum, wavenumber: FloatArray, edges: FloatArray) -> FloatArray:
    """Return the density at wavenumbers, a power law between means of the rings that lie between two edges.

    Densities beyond the lowest and the highest ring are nan.
    """
    q, density, modes = (one[spectrum.density > 0] for one in (spectrum.wavenumber, spectrum.density, spectrum.modes))
    if q.size < 2:
        return np.full(wavenumber.size, math.nan)
    place = np.searchsorted(edges, q)
    weights = np.bincount(place, modes, minlength=wavenumber.size)
    used = weights > 0
    means = [np.bincount(place, modes * one, minlength=wavenumber.size)[used] / weights[used] for one in (q, density)]
    x = np.log(np.append(means[0][means[0] < q[-1]], q[-1]))  # the last ring ends the curve
    y = np.log(np.append(means[1][means[0] < q[-1]], density[-1]))
    outside = (wavenumber < q[0] * (1 - _ROUND_OFF)) | (wavenumber > q[-1] * (1 + _ROUND_OFF))
    return np.where(outside, math.nan, np.exp(np.interp(np.log(wavenumber), x, y)))
