"""Rough surfaces: generate, read measured ones, filter, describe."""

from bem.surfaces.describe import (
    RadialSpectrum,
    SurfaceDescription,
    autocorrelation,
    describe_surface,
    radial_spectrum,
)
from bem.surfaces.filter import (
    MirrorWarning,
    crop,
    detrend,
    fill_missing,
    high_pass,
    low_pass,
    mirror_to_periodic,
    resample,
    scale_to_rms,
)
from bem.surfaces.formats import SurfaceFormat
from bem.surfaces.generate import generate_surface
from bem.surfaces.read import read_surface, write_surface
from bem.surfaces.surface import Surface

__all__ = [
    "MirrorWarning",
    "RadialSpectrum",
    "Surface",
    "SurfaceDescription",
    "SurfaceFormat",
    "autocorrelation",
    "crop",
    "describe_surface",
    "detrend",
    "fill_missing",
    "generate_surface",
    "high_pass",
    "low_pass",
    "mirror_to_periodic",
    "radial_spectrum",
    "read_surface",
    "resample",
    "scale_to_rms",
    "write_surface",
]
