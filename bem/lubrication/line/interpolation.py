"""Line films as starts for others, on a mesh whose weights are known.

Knows steady line films. Verified in tests/friction/test_continuation.py.
"""

from __future__ import annotations

from dataclasses import replace

from bem.lubrication.line.continuation import MIDDLE, SPIKE_CELLS
from bem.lubrication.line.newton import carried, is_start, spike_cell
from bem.lubrication.line.scales import scaled_problem
from bem.lubrication.line.state import KeptSteady
from bem.lubrication.results import FilmSolution


def on_mesh_of(film: FilmSolution, other: FilmSolution) -> FilmSolution:
    """The film as a start on the mesh of another, whose weights are known; itself where that is not a mesh for it, or a
    spike would move on it, or oil is lacking."""
    kept, there = film.state, other.state
    if not isinstance(kept, KeptSteady) or not isinstance(there, KeptSteady):
        return film
    if min(kept.state.far_field, there.state.far_field) == 0 or not (is_start(kept.state) and is_start(there.state)):
        return film
    scales, speeds = kept.scales, film.speeds
    problem = scaled_problem(scales, kept.load, film.lubricant, None, speeds[0] - speeds[1])
    if spike_cell(problem, kept.state, MIDDLE) < SPIKE_CELLS[0]:
        return film
    state = carried(problem, kept.state, there.state)
    return film if state is None else replace(film, state=replace(kept, state=state, flooded=state, sketch=False))
