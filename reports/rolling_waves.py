"""The verification report's section on waves that roll through films: what is left of their amplitude, and fits."""

from __future__ import annotations

import io
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from bem.lubrication.point.moving_surfaces import amplitude_reduction
from reports.builder import picture, table, text
from reports.experiments.kept import age, found

if TYPE_CHECKING:
    from matplotlib.figure import Figure

WAVES = ("contact", "M", "L", "wavelength/half-axis", "scaled", "left", "fit", "line fit of an inlet as long")

RIPPLES = (
    "film over rms", "slide-to-roll", "film ripple [nm]", "correlation", "pressure ripple [MPa]", "correlation",
    "minimum [nm]",
)  # fmt: skip


def body() -> str:
    """Figure, table and how to read them, as HTML."""
    stored = found("waviness_reduction")
    lines = [("line", *_wave(row), "") for row in stored["lines"]]
    lines += [("ball", *_wave(row), row["line_fit_of_an_inlet_as_long"]) for row in stored["points"]]
    long = [f"{row['settled']:.3f} beside {row['line_amplitudes'][-1]:.3f}" for row in stored["long_ellipse"]]
    march = stored["march"]
    scaled = [row["scaled_wavelength"] for row in stored["points"]]
    return (
        text(
            "Waves across the flow, in pure rolling, of small amplitude: what is left of them in the centre of the "
            "film, from linear equations around the steady film, exact in time, extrapolated over two grids. Scaled "
            "wavelengths are (wavelength/a)(M/L)^(1/2) in point contacts and (wavelength/b) M^(3/4)/L^(1/2) in line "
            "contacts (Venner, Couhier, Lubrecht and Greenwood 1997): in both the wavelength over the length of the "
            "inlet. Line contacts are solved by differences written anew; only their start comes from bem. In the "
            f"middle of a long ellipse amplitudes are those of the line contact: {', '.join(long)}. A march in time on "
            f"{march['shape'][0]} x {march['shape'][1]} cells with {march['steps_a_wave']} steps a wave leaves "
            f"{march['marched']:.3f}, the linear equations on the same grid {march['linear']:.3f}."
        )
        + picture(
            _png(_waves_drawn(stored, max(scaled))),
            "Amplitudes that are left (marks) and Venner and Lubrecht's fit for point contacts (line).",
        )
        + table(WAVES, lines, caption="Amplitudes of waves in the centre over those of the surface, and fits.")
        + text(_verdict(stored["points"], stored["lines"]))
        + age("waviness_reduction")
        + _random_surfaces(found("wave_ripples")["judged"])
        + age("wave_ripples")
    )


def _random_surfaces(rows: list[dict[str, Any]]) -> str:
    """Rough films by waves beside marches: how far off, how alike, how much faster, as HTML."""
    faster = sorted(row["seconds"][0] / row["seconds"][2] for row in rows)
    first = sorted(row["seconds"][0] / row["seconds"][1] for row in rows)
    middle = len(rows) // 2
    return text(
        f"{len(rows)} random balls with rough surfaces on both bodies, by waves (bem.lubrication.waves) and by marches "
        "in time: standard deviations of film and pressure inside the contact, the correlation of their fields, and "
        f"minima. Waves are {faster[0]:.0f} to {faster[-1]:.0f} times faster (median {faster[middle]:.0f}); with the "
        f"table of the inlet, which is computed once for a pair of speeds, {first[0]:.0f} to {first[-1]:.0f} times "
        f"(median {first[middle]:.0f})."
    ) + table(
        RIPPLES,
        [_ripple(row) for row in rows],
        caption="Ripples of random surfaces in films of balls: marched, and by waves.",
    )


def _ripple(row: dict[str, Any]) -> tuple[Any, ...]:
    film, pressure, least = row["film"], row["pressure"], row["minimum"]
    return (
        f"{row['central'] / row['heights']:.2g}",
        f"{row['slide_roll_ratio']:g}",
        f"{1e9 * film['marched']:.1f}, {1e9 * film['waves']:.1f}",
        f"{film['correlation']:.2f}",
        f"{1e-6 * pressure['marched']:.0f}, {1e-6 * pressure['waves']:.0f}",
        f"{pressure['correlation']:.2f}",
        f"{1e9 * least['marched']:.1f}, {1e9 * least['waves']:.1f}",
    )


def _verdict(points: list[dict[str, Any]], lines: list[dict[str, Any]]) -> str:
    """By how much short and long waves under balls are off the fit, and those of line contacts by their load."""
    long = _off(row for row in points if row["scaled_wavelength"] > 4)
    short = _off(row for row in points if row["scaled_wavelength"] <= 4)
    least = min(row["load"] for row in lines)
    light, loaded = (_off(row for row in lines if (row["load"] == least) is so) for so in (True, False))
    return (
        f"Under balls waves that are long (scaled beyond 4) are {long} off the fit, shorter ones {short}. In line "
        f"contacts it is {loaded}, but {light} at M = {least:g}, the lightest. "
        "The fit has no load and no oil in it but by the scaled wavelength, and its authors' own solutions scatter "
        "around it by about 10 %; the fit of line contacts, taken at an inlet as long, lies higher there, too."
    )


def _off(rows: Iterable[dict[str, Any]]) -> str:
    """From the least to the most that amplitudes are off their fit."""
    off = [f"{100 * (row['settled'] / row['fit'] - 1):+.2g}" for row in sorted(rows, key=_over_fit)]
    return f"{off[0]} to {off[-1]} %" if off[0] != off[-1] else f"{off[0]} %"


def _over_fit(row: dict[str, Any]) -> float:
    return float(row["settled"] / row["fit"])


def _wave(row: dict[str, Any]) -> tuple[Any, ...]:
    return (
        f"{row['load']:g}",
        f"{row['oil']:g}",
        f"{row['wavelength_over_half_axis']:g}",
        f"{row['scaled_wavelength']:.2f}",
        f"{row['settled']:.3f}",
        f"{row['fit']:.3f}",
    )


def _waves_drawn(stored: dict[str, Any], longest: float) -> Figure:
    import numpy as np
    from matplotlib.figure import Figure

    from reports.builder import COLOURS

    figure = Figure(figsize=(6.5, 3.6), layout="constrained")
    axes = figure.subplots()
    waves = np.linspace(0, 1.3 * longest, 100)
    axes.plot(waves, [amplitude_reduction(float(one)) for one in waves], color="0.4", label="Venner and Lubrecht")
    loads = sorted({row["load"] for row in stored["points"]})
    for load, colour in zip(loads, COLOURS, strict=False):
        line = [row for row in stored["points"] if row["load"] == load]
        where = [row["scaled_wavelength"] for row in line]
        axes.plot(where, [row["settled"] for row in line], "o", color=colour, label=f"M = {load:g}")
    axes.set_xlabel("(wavelength/a) (M/L)^(1/2)")
    axes.set_ylabel("amplitude left")
    axes.legend(fontsize=8)
    return figure


def _png(figure: Figure) -> bytes:
    png = io.BytesIO()
    figure.savefig(png, format="png", dpi=100)
    return png.getvalue()


__all__ = ["body"]
