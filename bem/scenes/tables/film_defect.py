"""A boundary film that protects what wears by pressure and distance: a table of the kinds with wear."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

from pydantic import Field

from bem.errors import InputError
from bem.scenes.common import PositiveLength, Table
from bem.scenes.keys import key
from bem.scenes.units import Energy, Speed, Temperature, Time

if TYPE_CHECKING:
    from bem.wear.film_defect import FilmDefect


class FilmDefectScene(Table):
    """Adsorbed boundary film, whose defects let the surfaces wear; the wear law's rate is that of bare surfaces."""

    adsorption_energy: Annotated[Energy, Field(gt=0)] = key(
        "Adsorption energy: energy that a molecule needs to leave the surface.", "basic", example="0.6 eV"
    )
    molecule_length: PositiveLength = key("Length of an adsorbed molecule along sliding.", "advanced", default=5e-10)
    vibration_time: Annotated[Time, Field(gt=0)] = key(
        "Vibration period of an adsorbed molecule; its residence time is this times exp(adsorption_energy / kT).",
        "advanced",
        default=3e-12,
    )
    sliding_speed: Annotated[Speed, Field(ge=0)] | None = key(
        "Sliding speed.", "basic", default=None, reason="from the table speeds; kind wear has none and needs it here"
    )
    temperature: Annotated[Temperature, Field(gt=0)] | None = key(
        "Surface temperature.", "basic", default=None, reason="the oil's; kind wear has none and needs it here"
    )

    def build(self, speeds: tuple[float, float] | None = None, temperature: float | None = None) -> FilmDefect:
        """Build the defect of surfaces at speeds (u1, u2) [m/s] and a temperature [K], if the table has none of its
        own.

        Raises
        ------
        InputError : no sliding speed or no temperature.
        """
        from bem.wear.film_defect import FilmDefect

        slide = abs(speeds[0] - speeds[1]) if self.sliding_speed is None and speeds is not None else self.sliding_speed
        warm = temperature if self.temperature is None else self.temperature
        missing = [name for name, value in (("sliding_speed", slide), ("temperature", warm)) if value is None]
        if missing:
            raise InputError(
                [
                    f"wear.film_defect.{name}: missing; allowed: a value, which nothing else here gives"
                    for name in missing
                ]
            )
        assert slide is not None
        assert warm is not None
        return FilmDefect(self.adsorption_energy, slide, warm, self.molecule_length, self.vibration_time)


def film_defect(scene: Any) -> FilmDefect | None:
    """Return the film defect of a case's boundary film in oil at its speeds and the oil's temperature; InputError
    for missing keys."""
    table, oil = scene.wear.film_defect, getattr(scene, "oil", None)
    if table is None:
        return None
    found: FilmDefect = table.build() if oil is None else table.build(scene.speeds.build()[0], oil.temperature)
    return found
