"""A surface on one sheet: heights, distribution, material ratio, autocorrelation, spectrum; spectra of several."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from bem.plots.style import BLACK, BLUE, VERMILION, label, map_of_heights, prefix, style
from bem.results.atomic import replacing
from bem.surfaces import (
    Surface,
    autocorrelation,
    describe_surface,
    material_ratio,
    radial_spectrum,
)
from bem.surfaces.measurements import finite_size_of, mean_spectrum, periodic_axes
from bem.surfaces.self_affine import self_affine_fit_of_map


def draw_surface(surface: Surface, path: Path, *, periodic: tuple[bool, bool] = (False, False)) -> Path:
    """Write the figure; its format is the path's ending (.png, .pdf, .svg).

    Raises
    ------
    ResultsError : the file cannot be written.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    heights = surface.heights - surface.heights.mean()
    grid = surface.grid()
    described = describe_surface(heights, surface.spacing, periodic=periodic)
    with style():
        figure = Figure(figsize=(11.0, 6.0), layout="constrained")
        FigureCanvasAgg(figure)
        sheet = figure.subplots(2, 3).ravel()
        map_axes, height_axes, ratio_axes, correlation_axes, spectrum_axes, text_axes = sheet
        map_of_heights(figure, map_axes, grid.x, grid.y, heights)
        map_axes.set_title(str(surface.metadata.get("file", "")))

        factor, unit = prefix(heights, "m")
        density, edges = np.histogram(heights * factor, bins=80, density=True)
        height_axes.stairs(density, edges, fill=True, color=BLUE, alpha=0.85)
        if described.Sq > 0:
            z = np.linspace(edges[0], edges[-1], 200)
            rms = described.Sq * factor
            gauss = np.exp(-0.5 * (z / rms) ** 2) / (rms * np.sqrt(2 * np.pi))
            height_axes.plot(z, gauss, color=BLACK, linewidth=0.9, label="Gaussian of the same Sq")
            height_axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0))
        height_axes.set_xlabel(label("height", unit))
        height_axes.set_ylabel(f"probability density (1/{unit or 'm'})")

        ratio = material_ratio(heights)
        ratios, sorted_heights = ratio.thinned()
        ratio_axes.plot(100 * ratios, sorted_heights * factor, color=BLUE)
        if ratio.Sk > 0:
            ratio_axes.plot([0, 100], [z * factor for z in ratio.core], color=VERMILION, linewidth=0.9, label="core")
            ratio_axes.legend()
        ratio_axes.set_xlim(0, 100)
        ratio_axes.set_xlabel("material ratio (%)")
        ratio_axes.set_ylabel(label("height", unit))
        shown = [f"{name} = {getattr(described, name) * factor:.3g} {unit}" for name in ("Sq", "Sa", "Sz")]
        error = finite_size_of(surface)
        if error.Sq > 0:
            shown[0] += f" ± {error.Sq * factor:.2g} {unit}"
        shown += [f"{name} = {getattr(described, name):.3g}" for name in ("Ssk", "Sku", "Sdq")]
        shown += [f"{name} = {getattr(ratio, name) * factor:.3g} {unit}" for name in ("Sk", "Spk", "Svk")]
        shown += [f"{name} = {getattr(ratio, name):.1%}" for name in ("Smr1", "Smr2")]

        factor, unit = prefix([0.5 * side for side in surface.lengths], "m")
        for axis, colour in ((0, BLUE), (1, VERMILION)):
            if surface.shape[axis] > 1:
                curve = autocorrelation(heights, axis, periodic=periodic[axis])
                lag = np.arange(len(curve)) * surface.spacing[axis] * factor
                correlation_axes.plot(lag, curve, color=colour, label=f"along {'xy'[axis]}")
        correlation_axes.axhline(np.exp(-1), color="0.5", linewidth=0.7, linestyle="--")
        correlation_axes.set_xlabel(label("lag", unit))
        correlation_axes.set_ylabel("autocorrelation")
        correlation_axes.legend()

        if min(surface.shape) >= 4 and described.Sq > 0:
            spectrum = radial_spectrum(heights, surface.spacing, periodic=periodic)
            seen = spectrum.density > 1e-20 * spectrum.density.max()
            spectrum_axes.loglog(spectrum.wavenumber[seen] * 1e-6, spectrum.density[seen] * 1e24, color=BLUE)
            fit = self_affine_fit_of_map(heights, surface.spacing, periodic=periodic)
            if fit is not None and not fit.is_self_affine:
                words = "no power law of self-affine surfaces"
                spectrum_axes.text(1.0, 1.01, words, transform=spectrum_axes.transAxes, ha="right", va="bottom")
            elif fit is not None:
                q = spectrum.wavenumber[spectrum.wavenumber <= 2 * np.pi / fit.shortest_wavelength * (1 + 1e-9)]
                name = f"H = {fit.hurst:.2f} ± {fit.hurst_error:.2f}"
                spectrum_axes.loglog(q * 1e-6, fit.at(q) * 1e24, "--", color=VERMILION, linewidth=1.0, label=name)
                spectrum_axes.legend()
            spectrum_axes.set_xlabel("wavenumber (rad/µm)")
            spectrum_axes.set_ylabel("power spectral density (µm⁴)")
        else:
            spectrum_axes.set_axis_off()
        text_axes.set_axis_off()
        text_axes.text(0.05, 0.97, "\n".join(shown), transform=text_axes.transAxes, va="top")
        with replacing(path) as temporary:
            figure.savefig(temporary, format=path.suffix[1:].lower())
    return path


_MOST_NAMED = 8
"""Measurements whose files the legend names."""


def draw_measurements(surfaces: Sequence[Surface], names: Sequence[str], path: Path) -> Path:
    """Write the radial power spectral density averaged over measurements, its scatter as a band, and each of them.

    surfaces : two or more maps. names : of the measurements. path : .png, .pdf or .svg.

    Raises
    ------
    InputError : a map of fewer than 4 x 4 cells.
    ResultsError : the file cannot be written.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    mean = mean_spectrum(surfaces)
    with style():
        figure = Figure(figsize=(6.4, 4.8), layout="constrained")
        FigureCanvasAgg(figure)
        axes = figure.subplots()
        exponents = []
        for number, (surface, name) in enumerate(zip(surfaces, names, strict=True)):
            periodic = periodic_axes(surface)
            one = radial_spectrum(surface.heights, surface.spacing, periodic=periodic)
            seen = one.density > 1e-20 * one.density.max()
            words = name if len(surfaces) <= _MOST_NAMED else ("each measurement" if number == 0 else None)
            axes.loglog(
                one.wavenumber[seen] * 1e-6,
                one.density[seen] * 1e24,
                color=f"C{number}" if len(surfaces) <= _MOST_NAMED else "0.7",
                linewidth=0.6,
                alpha=0.7,
                label=words,
            )
            fit = self_affine_fit_of_map(surface.heights, surface.spacing, periodic=periodic)
            if fit is not None and fit.is_self_affine:
                exponents.append(fit.hurst)
        known = np.isfinite(mean.scatter)
        q, density, spread = mean.wavenumber[known] * 1e-6, mean.density[known] * 1e24, np.exp(mean.scatter[known])
        axes.fill_between(
            q, density / spread, density * spread, color=BLACK, alpha=0.18, linewidth=0, label="scatter (one deviation)"
        )
        hurst = ""
        if len(exponents) > 1:
            hurst = f", H = {np.mean(exponents):.2f} ± {np.std(exponents, ddof=1):.2g} (scatter)"
        axes.loglog(mean.wavenumber * 1e-6, mean.density * 1e24, color=BLACK, label=f"mean of {len(surfaces)}{hurst}")
        axes.set_xlabel("wavenumber (rad/µm)")
        axes.set_ylabel("power spectral density (µm⁴)")
        axes.legend(loc="lower left")
        with replacing(path) as temporary:
            figure.savefig(temporary, format=path.suffix[1:].lower())
    return path
