"""Models of cavitation: what happens to the oil where the film ruptures."""

from __future__ import annotations

from enum import Enum

from bem.errors import InputError


class Cavitation(Enum):
    """Model of the ruptured film.

    Attributes
    ----------
    SWIFT_STIEBER : Reynolds' equation or no pressure, a complementarity (Swift 1932, Stieber 1933). Oil behind the
        rupture is not tracked: a film that forms again has as much oil as it can take.
    MASS_CONSERVING : Jakobsson and Floberg (1957), Olsson (1965), in the form of Elrod and Adams (1974): where there is
        no pressure, a fraction of the gap is filled and carried along; mass is conserved everywhere. The rupture is
        that of Swift and Stieber. A film forms again where the fraction reaches one, with a step in the pressure
        gradient.
    """

    SWIFT_STIEBER = "swift_stieber"
    MASS_CONSERVING = "mass_conserving"


def cavitation_of(value: object) -> Cavitation:
    """Return the model, or the model of that name.

    Raises
    ------
    InputError : neither.
    """
    try:
        return Cavitation(value)
    except ValueError:
        names = ", ".join(repr(one.value) for one in Cavitation)
        raise InputError(f"cavitation: {value!r} is unknown; choose from {names}") from None
