"""Contact of a rough ball under its film: the table `contact` of the kind point-film, and its notes.

Verified in tests/scenes/test_rough_point_film_kind.py.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

from pydantic import Field

from bem.grid import Grid
from bem.notes import Note
from bem.notes.checks import ROUGHNESS_UNRESOLVED
from bem.notes.scenes import PATCH_SMALLER_THAN_HERTZ
from bem.scenes.common import PositiveLength, Table, problem
from bem.scenes.keys import key
from bem.scenes.units import Ratio

if TYPE_CHECKING:
    from bem.lubrication import RoughPointFilm


FEWEST_CELLS = 8.0
"""A wavelength: shares of the load in contact change by tenths on fewer."""
REMEDY = "take finer film.cells, a higher rolling.mean_speed, or a surface that is lower or longer in its waves"


class TouchingScene(Table):
    """Asperity contact of a rough body inside the film."""

    boundary_friction: Annotated[Ratio, Field(ge=0)] = key(
        "Friction coefficient where the surfaces touch.", "basic", example=0.12
    )
    least_film: PositiveLength = key(
        "Film thickness at which the surfaces touch.", "advanced", default=1e-9, reason="a few molecules"
    )


def rough_body(scene: Any) -> str | None:
    """Name of the first rough body of a scene; None of smooth ones."""
    return next((name for name in ("lower", "upper") if getattr(scene, name).surface.kind != "smooth"), None)


def check_touching(scene: Any) -> None:
    """Refuse tables that belong to a rough body where there is none, and what rough bodies cannot have.

    Raises
    ------
    ValueError : with a message.
    """
    rough = rough_body(scene)
    if rough is None:
        for name in ("patch", "contact"):
            if getattr(scene, name) is not None:
                raise problem(
                    f"{name} of smooth surfaces", f"lower.surface or upper.surface other than smooth, or no {name}"
                )
        return
    if rough == "lower" and scene.upper.surface.kind != "smooth":
        raise problem(
            "both surfaces are rough, which makes no steady film", "one of them rough; kind friction shares the load"
        )
    if scene.patch is None:
        raise problem("a rough surface without a patch", "patch, with shape and spacing, or smooth surfaces")
    if scene.contact is None:
        raise problem("a rough surface without contact", "contact.boundary_friction, or smooth surfaces")
    if scene.supply is not None:
        raise problem("supply of a rough body", "no supply: its inlet is flooded; or smooth surfaces")
    if scene.roughness is not None:
        raise problem("roughness beside a rough surface", "one of them: roughness is of surfaces that are taken smooth")
    flat, ball = scene.rolling.speeds
    if any(flat if rough == "lower" else ball):
        at_rest = "-2: the flat stands still" if rough == "lower" else "2: the ball stands still"
        raise problem(
            f"rolling.slide_roll_ratio {scene.rolling.slide_roll_ratio:g}: the rough body moves, whose film is not "
            "steady",
            f"{at_rest}; roughness that moves is of kind point-film-time",
        )


def rough_notes(scene: Any, grid: Grid, semi_axes: tuple[float, float], film: RoughPointFilm) -> list[Note]:
    """Return notes on a patch over Hertz' contact of these half-axes [m], and on the film's cells on it."""
    from bem.lubrication import MeasuredHeights

    notes = []
    fading = MeasuredHeights.fading
    reach = 0.5 - fading
    ends = [
        abs(at) + half > reach * length
        for at, half, length in zip(scene.patch.at, semi_axes, grid.lengths, strict=True)
    ]
    if any(ends):
        notes.append(PATCH_SMALLER_THAN_HERTZ(fading=fading))
    surface = getattr(scene, rough_body(scene) or "lower").surface
    shortest = getattr(surface, "cutoff_wavelength", None)
    cell = max(film.x[1] - film.x[0], film.y[1] - film.y[0])
    if shortest is not None and shortest < FEWEST_CELLS * cell:
        notes.append(ROUGHNESS_UNRESOLVED(cells=float(shortest / cell), fewest=FEWEST_CELLS, reason="film-wave"))
    return notes
