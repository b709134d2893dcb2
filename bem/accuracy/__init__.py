"""How wrong a figure is: error bars from coarser solutions of the same problem.

A bar is an estimate, no bound that is proved: the difference to a coarser solution, divided by what the figure's order
of convergence makes of it where the coarser grid resolves the surface, the difference itself where it does not, times a
safety factor; and what the solver's residual may add. Factors are set so that bars cover nine errors in ten of random
contacts (`reports/experiments/contact_error_bars.py`). A figure that does not converge has no bar, and a note says why.
Names are loaded when first used: the bars of a contact cost no film.

Knows what solvers of every room give, and solves the same again, coarser; no scene, no file. Verified in
tests/accuracy: factors against finer solutions, notes where there is no bar; coverage on fresh seeds in
reports/experiments, one script a kind of figure.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from bem.startup.lazy import loader

if TYPE_CHECKING:
    from bem.accuracy.asperities import asperity_bars
    from bem.accuracy.bars import ErrorBars
    from bem.accuracy.contact import (
        Coarser,
        ContactCase,
        coarser_before,
        contact_bars,
        counted_figures,
        figures_of,
        solve_coarser,
        surface_is_resolved,
    )
    from bem.accuracy.film import FilmCase, OtherFilm, film_bars, film_figures, solve_coarser_film
    from bem.accuracy.flow import flow_bars
    from bem.accuracy.march import MarchCase, march_bars, march_figures
    from bem.accuracy.mixed import CoarserShares, MixedCase, mixed_bars, mixed_figures, solve_coarser_mixed
    from bem.accuracy.particles import map_figures, particle_bars
    from bem.accuracy.rubbing import RubbingCase, rubbing_bars
    from bem.accuracy.stress import stress_bars
    from bem.accuracy.traction import TractionCase, traction_bars, traction_figures
    from bem.accuracy.tribofilm import TribofilmCase, history_figures, tribofilm_bars
    from bem.accuracy.wear import running_in_bars, wear_bars

__all__ = [
    "Coarser",
    "CoarserShares",
    "ContactCase",
    "ErrorBars",
    "FilmCase",
    "MarchCase",
    "MixedCase",
    "OtherFilm",
    "RubbingCase",
    "TractionCase",
    "TribofilmCase",
    "asperity_bars",
    "coarser_before",
    "contact_bars",
    "counted_figures",
    "figures_of",
    "film_bars",
    "film_figures",
    "flow_bars",
    "history_figures",
    "map_figures",
    "march_bars",
    "march_figures",
    "mixed_bars",
    "mixed_figures",
    "particle_bars",
    "rubbing_bars",
    "running_in_bars",
    "solve_coarser",
    "solve_coarser_film",
    "solve_coarser_mixed",
    "stress_bars",
    "surface_is_resolved",
    "traction_bars",
    "traction_figures",
    "tribofilm_bars",
    "wear_bars",
]

__getattr__ = loader(
    __name__,
    {
        "asperities": ["asperity_bars"],
        "bars": ["ErrorBars"],
        "contact": [
            "Coarser",
            "ContactCase",
            "coarser_before",
            "contact_bars",
            "counted_figures",
            "figures_of",
            "solve_coarser",
            "surface_is_resolved",
        ],
        "film": ["FilmCase", "OtherFilm", "film_bars", "film_figures", "solve_coarser_film"],
        "flow": ["flow_bars"],
        "march": ["MarchCase", "march_bars", "march_figures"],
        "mixed": ["CoarserShares", "MixedCase", "mixed_bars", "mixed_figures", "solve_coarser_mixed"],
        "particles": ["map_figures", "particle_bars"],
        "rubbing": ["RubbingCase", "rubbing_bars"],
        "stress": ["stress_bars"],
        "traction": ["TractionCase", "traction_bars", "traction_figures"],
        "tribofilm": ["TribofilmCase", "history_figures", "tribofilm_bars"],
        "wear": ["running_in_bars", "wear_bars"],
    },
)
