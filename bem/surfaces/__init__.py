"""Rough surfaces: generate, read measured ones, filter, describe.

`generate` makes heights of a `spectrum` (`request` checks what is asked, `moments` imposes skewness and kurtosis),
`processes` are statistics by how a surface is made, `marks` what a tool leaves, `read` opens an instrument's file by
its `formats`, `spikes` finds the outliers of an instrument, `filter` levels, fills, cuts and resamples, `seams` makes a
map periodic, `describe` measures, with `material_ratio_curve` (Abbott curve), `self_affine` (Hurst exponent),
`asperities` (summits and plasticity indices), `finite_size` (errors by the size of a map) and `measurements` (several
maps); `examples` are two maps of our own.
Names are loaded when first used: planning a contact of smooth bodies costs no transforms and no splines.

Sees grids and no contact. Verified in tests/surfaces: what is asked for is what `describe` finds, the same seed gives
the same bits, files of every format and damaged ones.
"""

from typing import TYPE_CHECKING

from bem.startup.lazy import loader

if TYPE_CHECKING:
    from bem.surfaces.asperities import (
        AsperityStatistics,
        describe_asperities,
        plasticity_index,
        slope_plasticity_index,
    )
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
        level_lines,
        low_pass,
        mirror_to_periodic,
        resample,
        scale_to_rms,
    )
    from bem.surfaces.finite_size import FiniteSizeError, finite_size_error
    from bem.surfaces.formats import SurfaceFormat
    from bem.surfaces.generate import generate_surface
    from bem.surfaces.marks import cross_hatch, feed_marks, hatch_angle
    from bem.surfaces.material_ratio_curve import MaterialRatio, material_ratio
    from bem.surfaces.measurements import MeanSpectrum, Measurements, ParameterScatter, describe_measurements
    from bem.surfaces.processes import PROCESSES, Process
    from bem.surfaces.read import read_surface, write_surface
    from bem.surfaces.seams import close_seams
    from bem.surfaces.self_affine import SelfAffineFit, fit_self_affine
    from bem.surfaces.spikes import despike
    from bem.surfaces.surface import Surface

__all__ = [
    "PROCESSES",
    "AsperityStatistics",
    "FiniteSizeError",
    "MaterialRatio",
    "MeanSpectrum",
    "Measurements",
    "MirrorWarning",
    "ParameterScatter",
    "Process",
    "RadialSpectrum",
    "SelfAffineFit",
    "Surface",
    "SurfaceDescription",
    "SurfaceFormat",
    "autocorrelation",
    "close_seams",
    "crop",
    "cross_hatch",
    "describe_asperities",
    "describe_measurements",
    "describe_surface",
    "despike",
    "detrend",
    "feed_marks",
    "fill_missing",
    "finite_size_error",
    "fit_self_affine",
    "generate_surface",
    "hatch_angle",
    "high_pass",
    "level_lines",
    "low_pass",
    "material_ratio",
    "mirror_to_periodic",
    "plasticity_index",
    "radial_spectrum",
    "read_surface",
    "resample",
    "scale_to_rms",
    "slope_plasticity_index",
    "write_surface",
]

__getattr__ = loader(
    __name__,
    {
        "asperities": ["AsperityStatistics", "describe_asperities", "plasticity_index", "slope_plasticity_index"],
        "material_ratio_curve": ["MaterialRatio", "material_ratio"],
        "self_affine": ["SelfAffineFit", "fit_self_affine"],
        "describe": ["RadialSpectrum", "SurfaceDescription", "autocorrelation", "describe_surface", "radial_spectrum"],
        "filter": [
            "MirrorWarning",
            "crop",
            "detrend",
            "fill_missing",
            "high_pass",
            "level_lines",
            "low_pass",
            "mirror_to_periodic",
            "resample",
            "scale_to_rms",
        ],
        "finite_size": ["FiniteSizeError", "finite_size_error"],
        "formats": ["SurfaceFormat"],
        "generate": ["generate_surface"],
        "marks": ["cross_hatch", "feed_marks", "hatch_angle"],
        "measurements": ["MeanSpectrum", "Measurements", "ParameterScatter", "describe_measurements"],
        "processes": ["PROCESSES", "Process"],
        "read": ["read_surface", "write_surface"],
        "seams": ["close_seams"],
        "spikes": ["despike"],
        "surface": ["Surface"],
    },
)
