"""Error bars of rough films by waves: how far linear waves were from marches in time.

The waves are sums without a mesh to refine; what they miss is the model: heights that are no small part of the film, an
inlet that is the same around the whole contact, pressure that varies inside it. Bars are fractions that grow with the
rms heights over the film, chosen on fourteen random balls with rough surfaces on both bodies (lambda ratio 0.5 to 3,
slide-to-roll ratio -1 to 1) against `march_point_film`, and judged by ten others
(reports/experiments/wave_ripples.py). They covered 29 of 30 errors there. A minimum
that waves give is mostly a lower one: of 24 marched minima 21 were higher.
Verified in tests/accuracy/test_wave_bars.py.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from bem.accuracy.bars import ErrorBars

if TYPE_CHECKING:
    from bem.lubrication.waves import FilmRipples

MODEL = "linear waves"
"""Origin of the errors."""
FILM = (0.15, 0.20)
PRESSURE = (0.20, 0.35)
"""Relative error of the ripples' standard deviations: of low heights, and more with the heights over the film."""
MINIMUM = 2.0
"""Error of the minimum over the standard deviation of the film."""


def wave_bars(ripples: FilmRipples) -> ErrorBars:
    """Return the error bars of the figures of ripples, by the record's names."""
    steep = 1 / ripples.lambda_ratio
    film, pressure = (low + more * steep for low, more in (FILM, PRESSURE))
    return ErrorBars.together(
        {
            MODEL: {
                "film_ripple": film * ripples.rms_film_ripple,
                "pressure_ripple": pressure * ripples.rms_pressure_ripple,
                "ripple_over_heights": film * ripples.amplitude_ratio,
                "film_over_ripple": film * ripples.deformed_lambda_ratio,
                "rough_minimum_thickness": MINIMUM * ripples.rms_film_ripple,
            }
        }
    )
