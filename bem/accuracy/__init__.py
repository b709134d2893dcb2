"""How wrong a figure is: error bars by Richardson extrapolation from coarser solutions of the same problem.

1. A solved problem is solved once more on a coarser mesh: every second cell, depth or pixel, half of the points or of
   the time steps; or on twice as many points where half are too few.
2. A figure of order p differs from its limit by |f_h - f_2h| / (2^p - 1), Richardson's estimate; a difference to
   another ratio of meshes is first converted to that of a factor of two.
3. The order is assumed, not observed: differences of rough contacts scatter too much for an observed order, which
   needs a third mesh. Films whose difference is large are the exception: more of it counts.
4. Instead of 1 / (2^p - 1) the difference therefore has a factor with a safety margin, chosen by experiment for each
   figure, and a larger one where the coarser grid does not resolve the surface.
5. A difference may pass zero where the error does not: floors remain, each a factor on an indicator of the mesh, such
   as the fraction of a contact within a cell of its edge or the relative change of the film.
6. Errors that both meshes share do not show in differences (peaks between cells, lost curvature, counts of cells):
   they are estimated from the finer solution alone, or from theory, and added.
7. The residual of the solvers adds a floor of noise, ten times its relative size unless the problem says better.
8. Parts of different origins are added, since all may have one sign. Figures with a prescribed sum share the largest
   error, figures in proportion the relative one, and a sum is no better known than its parts.
9. A figure without a limit (a pressure spike, a sharp edge), or without a coarser solution, has no bar, and a note
   says why. Errors of the model, the measured surface and the material's constants are not covered.
10. A bar is an estimate and no proved bound: the numbers of each table were chosen on random cases and are judged on
    others, stored in reports/results, so that nine errors in ten lie within their bars.

`richardson` is the engine and the form of a table, `coarsened` solves contacts on coarser grids, `bars` holds the
result; each other module has the table of a kind and the errors that differences miss. Names are loaded when first
used: the bars of a contact cost no film. Knows what solvers of every room give; no scene, no file.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from bem.startup.lazy import loader

if TYPE_CHECKING:
    from bem.accuracy.asperities import asperity_bars
    from bem.accuracy.bars import ErrorBars
    from bem.accuracy.coarsened import Coarser, ContactCase, coarser_before, solve_coarser, surface_is_resolved
    from bem.accuracy.coating import coating_bars
    from bem.accuracy.contact import contact_bars, counted_figures, figures_of
    from bem.accuracy.film import FilmCase, OtherFilm, film_bars, film_figures, solve_coarser_film
    from bem.accuracy.flow import flow_bars
    from bem.accuracy.life import OtherLives, jump_bars, life_bars, life_figures
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
    "OtherLives",
    "RubbingCase",
    "TractionCase",
    "TribofilmCase",
    "asperity_bars",
    "coarser_before",
    "coating_bars",
    "contact_bars",
    "counted_figures",
    "figures_of",
    "film_bars",
    "film_figures",
    "flow_bars",
    "history_figures",
    "jump_bars",
    "life_bars",
    "life_figures",
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
        "coarsened": ["Coarser", "ContactCase", "coarser_before", "solve_coarser", "surface_is_resolved"],
        "coating": ["coating_bars"],
        "contact": ["contact_bars", "counted_figures", "figures_of"],
        "film": ["FilmCase", "OtherFilm", "film_bars", "film_figures", "solve_coarser_film"],
        "flow": ["flow_bars"],
        "life": ["OtherLives", "jump_bars", "life_bars", "life_figures"],
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
