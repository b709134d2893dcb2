"""The verification report's section on line-contact films: the committed table over Moes' M and L, and the fits."""

from __future__ import annotations

import io
import math
from pathlib import Path

from reports.benchmarks.line_film import drawing, read_table
from reports.builder import picture, table, text
from reports.reproduced import paragraph

RESULTS = Path(__file__).resolve().parent / "results" / "line_film.csv"
HEADERS = (
    "M",
    "L",
    "H min",
    "order",
    "error 400",
    "error 2000",
    "fit D",
    "H central",
    "order",
    "error 400",
    "error 2000",
    "fit M",
    "Newton steps",
)


def body() -> str:
    """Figure, table and how to read them, as HTML."""
    rows = read_table(RESULTS)
    worst = max(max(abs(row.error_minimum_2000), abs(row.error_central_2000)) for row in rows)
    lines = [
        (
            f"{row.load:g}",
            f"{row.piezo:g}",
            row.minimum,
            f"{row.order_minimum:.2f}",
            f"{row.error_minimum_400:.2g}",
            f"{row.error_minimum_2000:.2g}",
            None if math.isnan(row.dowson_higginson_minimum_fit) else row.dowson_higginson_minimum_fit,
            row.central,
            f"{row.order_central:.2f}",
            f"{row.error_central_400:.2g}",
            f"{row.error_central_2000:.2g}",
            row.moes_central_fit,
            row.newton_steps_2000,
        )
        for row in rows
    ]
    png = io.BytesIO()
    drawing(rows).savefig(png, format="png", dpi=100)
    return (
        text(
            "Steady films of solve_line_film over Moes' load M and piezoviscous parameter L (Roelands' law, "
            "incompressible), in the unit R U^(1/2). The converged film is extrapolated over nested meshes of 250 to "
            "2000 cells, whose last three levels give the observed order (two is expected). Errors are those of a "
            f"plain call with 400 and 2000 points, in per cent of the converged film; at 2000 points none exceeds "
            f"{worst:.2g} %, where 0.3 % is asked for. Newton steps are those of a cold start at 2000 points, all "
            "coarse meshes included. The table is made again by python -m reports.benchmarks.line_film, and tests hold "
            "it to the solver."
        )
        + picture(
            png.getvalue(),
            "Films over the load, with Martin's rigid and isoviscous limit; below, what the fits are off by. Moes' fit "
            "is meant to be within ten per cent, for Barus' oil; where the cylinder is rigid it is 3/M, the film at "
            "the largest pressure and at the exit, 1.226 times the film at x = 0 that is drawn. Dowson's fit of the "
            "minimum film is for heavily loaded piezoviscous contacts only, and leaves the picture elsewhere.",
        )
        + table(
            HEADERS, lines, caption="Line-contact films: errors in per cent; fit D: Dowson (1968), fit M: Moes (1992)."
        )
        + paragraph(RESULTS.stem)
    )


__all__ = ["body"]
