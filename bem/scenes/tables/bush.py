"""Bush of which a cylinder on a flat is the equivalent: what its clearance says of a thick film.

The cylinder on a flat has the gap of shaft and bush near the load line alone, and its film leaks nothing at the ends. A
film that is a good part of the clearance is that of a journal bearing, of which
`bem.reference_solutions.journal_bearing` gives an estimate.
"""

from __future__ import annotations

import math
from typing import Any

from pydantic import model_validator

from bem.notes import Note
from bem.notes.elements import BUSH_BOUNDS, BUSH_FLOATS
from bem.reference_solutions.journal_bearing import JournalFilm, journal_film
from bem.scenes.common import PositiveLength, Table, problem
from bem.scenes.keys import key

THICK = 0.1
"""Film over the radial clearance from which the oil carries the shaft as in a journal bearing. There, at L/D = 0.8, the
film of an endless line is 1.9 times as thick as that of `reference_solutions.journal_bearing`, which is itself up to
12 % too thick."""
BOUNDED = 1 / 30
"""Film over the radial clearance from which the film of a journal bearing stands beside it as its lower bound: of the
rigid endless cylinder's load (Martin's film, dp/dx = 0 at the outlet) 8 % is then carried beyond 45 degrees before the
load line, where the gap of shaft and bush is no parabola and liquid leaves at the ends; of a film of c/100 2.6 %."""
RUBS = 0.1
"""Part of the friction that asperities cause from which notes on the film name it."""
_SAME = 0.01
"""Relative deviation of the cylinder's radius from that of the bush that counts as none."""


class BushScene(Table):
    """Bore and clearance of the bush of which the cylinder is the equivalent; the run notes films too thick for it."""

    bore: PositiveLength = key("Diameter of the bore.", "basic", example="20 mm")
    clearance: PositiveLength = key("Bore less shaft diameter.", "basic", example="60 um")

    @model_validator(mode="after")
    def _fits(self) -> BushScene:
        if not self.clearance < self.bore:
            raise problem("clearance is not below the bore", "bore less shaft diameter")
        return self

    def check_radius(self, radius: float, name: str) -> None:
        """Refuse a cylinder that has not the gap of shaft and bush near the load line.

        Parameters
        ----------
        radius : of the cylinder [m].
        name : of its key.

        Raises
        ------
        PydanticCustomError : another radius.
        """
        own = self.bore * (self.bore - self.clearance) / (2 * self.clearance)
        if not math.isclose(radius, own, rel_tol=_SAME):
            raise problem(
                f"{name} is not that of bush.bore and bush.clearance",
                f'{name} = "{own:.6g} m", bore times shaft diameter over twice the clearance, or no table bush',
            )

    def film_notes(
        self,
        thickness: float,
        *,
        friction: float,
        load: float,
        length: float,
        viscosity: float,
        mean_speed: float,
        rubbing: float = 0.0,
    ) -> tuple[Note, ...]:
        """Return a note on a film that is a good part of the clearance; none of a thinner one.

        Parameters
        ----------
        thickness : of the film at its thinnest [m].
        friction : coefficient.
        load : [N].
        length : of the bush [m].
        viscosity : of the oil as it comes in [Pa s].
        mean_speed : entrainment speed [m/s].
        rubbing : part of the friction that asperities cause.
        """
        journal = journal_beside(
            thickness,
            load=load,
            radius=0.5 * self.bore,
            clearance=0.5 * self.clearance,
            length=length,
            viscosity=viscosity,
            sliding_speed=2 * abs(mean_speed),
        )
        if journal is None:
            return ()
        clearance = 0.5 * self.clearance
        return (thick_film_note(thickness, friction, journal, clearance, impossible="beyond-scene", rubbing=rubbing),)


def check_equivalent(bush: BushScene | None, radius: float | None, name: str) -> None:
    """Refuse a table `bush` whose equivalent is another cylinder, or that stands beside a shape with two radii.

    Parameters
    ----------
    bush : table of a scene, if it has one.
    radius : of the scene's cylinder [m]; None of another shape.
    name : of its key.

    Raises
    ------
    PydanticCustomError : another radius, or no cylinder.
    """
    if bush is None:
        return
    if radius is None:
        raise problem("a table bush without a cylinder", "a cylinder, or no table bush")
    bush.check_radius(radius, name)


def journal_beside(
    thickness: float,
    *,
    load: float,
    radius: float,
    clearance: float,
    length: float,
    viscosity: float,
    sliding_speed: float,
) -> JournalFilm | None:
    """Return the estimated film of a rigid journal bearing; None beside a thin film.

    thickness : of the film of the equivalent cylinder [m]; others as in `journal_film`.
    """
    if thickness < BOUNDED * clearance:
        return None
    return journal_film(
        load=load,
        radius=radius,
        clearance=clearance,
        length=length,
        viscosity=viscosity,
        sliding_speed=sliding_speed,
    )


def thick_film_note(
    thickness: float,
    friction: float,
    journal: JournalFilm,
    clearance: float,
    *,
    impossible: str,
    rubbing: float = 0.0,
) -> Note:
    """Return the note on a film of the equivalent cylinder beside which that of a journal bearing stands.

    Parameters
    ----------
    thickness : of the film [m].
    friction : coefficient.
    journal : film of the journal bearing.
    clearance : difference of the radii [m].
    impossible : reason of `BUSH_FLOATS` for a film thicker than the clearance.
    rubbing : part of the friction that asperities cause.
    """
    touching = rubbing > RUBS
    values: dict[str, Any] = {
        "share": thickness / clearance,
        "film": thickness,
        "journal": journal.minimum_thickness,
        "friction": friction,
        "turning": journal.friction,
        "rubbing": rubbing,
    }
    if thickness < THICK * clearance:
        return BUSH_BOUNDS(**values, reason="touching" if touching else "film")
    return BUSH_FLOATS(
        **values,
        thicker=thickness / journal.minimum_thickness,
        lower=friction / journal.friction,
        clearance=clearance,
        reason=("thick, touching" if touching else "thick") if thickness <= clearance else impossible,
    )
