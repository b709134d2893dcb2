"""Fields of film and pressure that the waves of two rough surfaces leave in a line, circular or elliptical contact."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import RectBivariateSpline
from scipy.ndimage import map_coordinates

from bem.errors import InputError
from bem.grid import FloatArray
from bem.lubrication.results import FilmSolution
from bem.lubrication.waves.plateau import Plateau, effective_viscosities, wave_amplitudes
from bem.reference_solutions.hertz import LineContact, PointContact
from bem.representation import readable

if TYPE_CHECKING:
    from bem.lubrication.point.film import PointFilmSolution

FLAT = 0.9
"""Part of Hertz' half-axes within which standard deviations are taken: the constrictions at the rim are no ripples."""


@readable
@dataclass(frozen=True)
class FilmRipples:
    """Film and pressure of a smooth contact and the ripples that roughness leaves on them; arrays (nx, ny).

    Attributes
    ----------
    x, y : (nx,) and (ny,) centres of the patch's cells [m].
    heights : of both surfaces together, out of the bodies, at the time [m].
    film_ripple, pressure_ripple : change of thickness [m] and pressure [Pa]; zero outside Hertz' contact.
    thickness, pressure : of the smooth contact and the ripples together [m, Pa]; not below zero.
    inside : cells within Hertz' contact.
    rms_heights, rms_film_ripple, rms_pressure_ripple : standard deviations within `FLAT` of Hertz' contact.
    minimum_thickness : within Hertz' contact [m].
    touching_share : share of Hertz' contact whose film would be zero or less. The waves say that surfaces meet there,
        not what they bear.
    tension_share : share within `FLAT` of the contact whose pressure would be zero or less.
    plateau : smooth film in the middle.
    """

    x: FloatArray
    y: FloatArray
    heights: FloatArray
    film_ripple: FloatArray
    pressure_ripple: FloatArray
    thickness: FloatArray
    pressure: FloatArray
    inside: NDArray[np.bool_]
    rms_heights: float
    rms_film_ripple: float
    rms_pressure_ripple: float
    minimum_thickness: float
    touching_share: float
    tension_share: float
    plateau: Plateau

    @property
    def amplitude_ratio(self) -> float:
        """Standard deviation of the film over that of the undeformed heights."""
        return self.rms_film_ripple / self.rms_heights

    @property
    def lambda_ratio(self) -> float:
        """Central film over the standard deviation of the undeformed heights."""
        return self.plateau.film / self.rms_heights

    @property
    def deformed_lambda_ratio(self) -> float:
        """Central film over the standard deviation of the film."""
        return self.plateau.film / self.rms_film_ripple


def plateau_of(film: FilmSolution | PointFilmSolution, hertz: LineContact | PointContact) -> Plateau:
    """Return the flat part of a smooth film, at Hertz' mean pressure.

    The inlet's length follows from the dry gap beside the edge, (4 sqrt 2/3) (p0/E*) s^(3/2)/a^(1/2), p0 the highest
    pressure and a the half-axis along x (Johnson (1985), chapter 4, beside any edge of Hertz' contact). It opens by the
    central film itself. The film of the same mass at ambient density, thicker by a fifth, would leave up to 25 % more
    of long waves; of the two, linear solutions of whole line contacts at M 50 and 100 are nearer to this one, at M 200
    half of them.

    Raises
    ------
    InputError : entrainment that is not along +x.
    """
    flat, upper = _along_x(film)
    half = hertz.half_width if isinstance(hertz, LineContact) else hertz.semi_axes[0]
    lubricant, thickness, pressure = film.lubricant, film.central_thickness, hertz.mean_pressure
    opening = 4 * math.sqrt(2) / 3 * hertz.maximum_pressure / hertz.contact_modulus / math.sqrt(half)
    density, slope = lubricant.density_ratio(np.array(pressure))
    along, across = effective_viscosities(lubricant, pressure, (flat - upper) / thickness)
    return Plateau(
        film=thickness,
        pressure=pressure,
        viscosity_along=along,
        viscosity_across=across,
        compression=thickness * float(slope) / float(density),
        contact_modulus=hertz.contact_modulus,
        mean_speed=0.5 * (flat + upper),
        inlet_length=(thickness / opening) ** (2 / 3),
        reach=half,
    )


def film_ripples(
    film: FilmSolution | PointFilmSolution,
    hertz: LineContact | PointContact,
    heights: tuple[FloatArray | None, FloatArray | None],
    spacing: tuple[float, float],
    *,
    at: tuple[float, float] = (0.0, 0.0),
    travelled: tuple[float, float] = (0.0, 0.0),
) -> FilmRipples:
    """Return the ripples of film and pressure that the roughness of both bodies leaves in a steady, smooth film.

    The patch repeats along x and y. Wave by wave: see `bem.lubrication.waves`. The whole contact has the plateau of its
    middle, the inlet's edge is Hertz', and waves meet it as they do on the middle line.

    Parameters
    ----------
    film : smooth film, with entrainment along +x.
    hertz : its dry contact.
    heights : (nx, ny) out of the lower and of the upper body [m], None of a smooth one; their means do not matter. In a
        line contact ny may be one.
    spacing : sides of the patch's cells [m].
    at : centre of the patch [m].
    travelled : distances along x that the lower and the upper body have moved since the heights stood so [m].

    Raises
    ------
    InputError : entrainment along another direction, two smooth bodies, heights of two shapes or not finite.
    """
    rough = _checked(heights)
    shape = rough[0][1].shape
    plateau, speeds = plateau_of(film, hertz), _along_x(film)
    x = at[0] + (np.arange(shape[0]) - 0.5 * (shape[0] - 1)) * spacing[0]
    y = at[1] + (np.arange(shape[1]) - 0.5 * (shape[1] - 1)) * spacing[1]
    kx = 2 * np.pi * np.fft.fftfreq(shape[0], spacing[0])[:, None] + np.zeros(shape)
    ky = 2 * np.pi * np.fft.rfftfreq(shape[1], spacing[1])[None, :]
    kx, ky = np.broadcast_arrays(kx[:, : ky.shape[1]], ky)
    waves = (kx != 0) | (ky != 0)
    half_axes = (hertz.half_width, math.inf) if isinstance(hertz, LineContact) else hertz.semi_axes
    across = np.clip(1 - (y / half_axes[1]) ** 2, 0.0, 1.0)
    edge = -half_axes[0] * np.sqrt(across)
    total, ripple, pressure = np.zeros(shape), np.zeros(shape), np.zeros(shape)
    for body, field in rough:
        spectrum = np.fft.rfft2(field) * np.exp(-1j * kx * travelled[body])
        spectrum[~waves] = 0.0
        found = wave_amplitudes(plateau, kx[waves], ky[waves], speeds[body])
        total += np.fft.irfft2(spectrum, shape)
        ripple += _filtered(spectrum, waves, found.particular_film, shape)
        pressure += _filtered(spectrum, waves, found.particular_pressure, shape)
        # generated at the edge as the surface passes it, and stretched by mean speed over speed of the surface
        left = np.exp(-found.decay)
        source = edge + speeds[body] / plateau.mean_speed * (x[:, None] - edge)
        for target, part in ((ripple, found.complementary_film), (pressure, found.complementary_pressure)):
            target += _at(_filtered(spectrum, waves, left * part, shape), source, x[0], spacing[0])
    return _result(film, half_axes, plateau, x, y, total, ripple, pressure)


def _along_x(film: FilmSolution | PointFilmSolution) -> tuple[float, float]:
    """Return the speeds of both bodies along x [m/s].

    Raises
    ------
    InputError : a speed along y, or entrainment that is not along +x.
    """
    both = np.array([np.ravel(one) for one in film.speeds], dtype=np.float64)
    if both.shape[1] > 1 and np.any(both[:, 1] != 0):
        raise InputError(f"film: speeds {film.speeds!r} are not along x, as waves need; turn the axes")
    if not both[:, 0].sum() > 0:
        raise InputError(f"film: speeds {film.speeds!r} must entrain along +x; turn the axes")
    return float(both[0, 0]), float(both[1, 0])


def _checked(heights: tuple[FloatArray | None, FloatArray | None]) -> list[tuple[int, FloatArray]]:
    rough = [(body, np.asarray(one, dtype=np.float64)) for body, one in enumerate(heights) if one is not None]
    if not rough:
        raise InputError("heights: both bodies are smooth; give the heights of one at least")
    if any(one.ndim != 2 or one.shape != rough[0][1].shape or not np.isfinite(one).all() for _, one in rough):
        raise InputError("heights: must be finite arrays (nx, ny) of one shape [m]")
    return rough


def _filtered(
    spectrum: NDArray[np.complex128], waves: NDArray[np.bool_], factor: NDArray[np.complex128], shape: tuple[int, ...]
) -> FloatArray:
    """Return the field whose spectrum is the given one times a factor on every wave."""
    filtered = np.zeros_like(spectrum)
    filtered[waves] = spectrum[waves] * factor
    return np.fft.irfft2(filtered, shape)


def _at(field: FloatArray, source: FloatArray, first: float, spacing: float) -> FloatArray:
    """Interpolate a field that repeats at other abscissae `source` (nx, ny) of the same rows along x."""
    along = (source - first) / spacing
    rows = np.broadcast_to(np.arange(field.shape[1], dtype=np.float64), source.shape)
    return np.asarray(map_coordinates(field, [along, rows], order=3, mode="grid-wrap"))


def _result(
    film: FilmSolution | PointFilmSolution,
    half_axes: tuple[float, float],
    plateau: Plateau,
    x: FloatArray,
    y: FloatArray,
    heights: FloatArray,
    ripple: FloatArray,
    pressure: FloatArray,
) -> FilmRipples:
    distance = np.hypot(x[:, None] / half_axes[0], y[None, :] / half_axes[1])
    inside, flat = distance < 1, distance < FLAT
    if not flat.any():
        raise InputError("heights: no cell of the patch lies in Hertz' contact; move the patch or take finer cells")
    if isinstance(film, FilmSolution):
        smooth = [np.interp(x, film.position, of)[:, None] + 0 * y for of in (film.thickness, film.pressure)]
    else:
        smooth = [RectBivariateSpline(film.x, film.y, of, kx=1, ky=1)(x, y) for of in (film.thickness, film.pressure)]
    ripple, pressure = np.where(inside, ripple, 0.0), np.where(inside, pressure, 0.0)
    thickness, total = smooth[0] + ripple, smooth[1] + pressure
    return FilmRipples(
        x=x,
        y=y,
        heights=heights,
        film_ripple=ripple,
        pressure_ripple=pressure,
        thickness=np.maximum(thickness, 0.0),
        pressure=np.maximum(total, 0.0),
        inside=inside,
        rms_heights=float(heights[flat].std()),
        rms_film_ripple=float(ripple[flat].std()),
        rms_pressure_ripple=float(pressure[flat].std()),
        minimum_thickness=float(np.maximum(thickness[inside], 0.0).min()),
        touching_share=float((thickness[inside] <= 0).mean()),
        tension_share=float((total[flat] <= 0).mean()),
        plateau=plateau,
    )
