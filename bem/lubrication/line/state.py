"""What a steady line film leaves behind its figures: to be looked at anywhere, and for others to start from.

Equations of the last Newton step are megabytes, and of use only to a start next to it: who solves many films in a row
keeps them from one to the next (`steady.line_film`), results are handed out without. Knows the discrete film.
Verified in tests/lubrication/test_line_film_steady.py and tests/friction/test_continuation.py.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from bem.grid import FloatArray
from bem.lubrication.line.deflection import DEFLECTION, logarithmic_integral
from bem.lubrication.line.newton import State
from bem.lubrication.line.scales import Scales
from bem.lubrication.line.temperatures import KeptHeat
from bem.lubrication.results import FilmSolution
from bem.numerics.monotone import MonotoneCubic
from bem.threads import one_blas_thread


@dataclass(frozen=True)
class KeptSteady:
    """What a warm start and a look at other positions need; `flooded`: without a supply, `sketch`: of `coarse`,
    `heat`: what full heat starts from."""

    state: State
    flooded: State
    load: float
    scales: Scales
    reversed: bool
    sketch: bool = False
    heat: KeptHeat | None = None

    @one_blas_thread
    def sample(self, position: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Pressure [Pa] and thickness [m] at any positions [m]: interpolated on the mesh, by the kernel off it."""
        position = np.asarray(position, dtype=np.float64)
        at = -position if self.reversed else position
        order = np.argsort(at, kind="stable")
        pressure, film = np.empty(len(at)), np.empty(len(at))
        pressure[order], film[order] = sampled_state(at[order], self.state, self.scales)
        return pressure, film


def without_equations(film: FilmSolution) -> FilmSolution:
    """The film without what only starts next to it need: megabytes."""
    kept = film.state
    if not isinstance(kept, KeptSteady):
        return film
    state = replace(kept.state, linear=None)
    flooded = state if kept.flooded is kept.state else replace(kept.flooded, linear=None)
    return replace(film, state=replace(kept, state=state, flooded=flooded))


def sampled_state(at: FloatArray, state: State, scales: Scales) -> tuple[FloatArray, FloatArray]:
    """Pressure and thickness at ascending positions [m] for positive entrainment."""
    x = state.position
    target = at / scales.length
    inside = (target >= x[0]) & (target <= x[-1])
    pressure = np.interp(target, x, np.maximum(state.pressure, 0.0), right=0.0)
    upstream = target < x[0]
    pressure[upstream] = state.far_field * 8 / np.abs(target[upstream]) ** 3
    film = np.empty_like(target)
    film[inside] = MonotoneCubic(x, state.film)(target[inside])
    far = inside & (np.abs(target) > 1.5 * state.exit)
    film[far] = 0.5 * target[far] ** 2 + MonotoneCubic(x, state.film - 0.5 * x**2)(target[far])
    if not inside.all():
        out = target[~inside]
        deflection = DEFLECTION * logarithmic_integral(out - state.exit, state.offset, state.pressure)
        film[~inside] = state.datum + 0.5 * out**2 - deflection
    return pressure * scales.pressure, film * scales.film
