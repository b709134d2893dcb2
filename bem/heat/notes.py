"""When a surface temperature should not be believed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from bem.heat.bodies import Conductor

ABSOLUTE = 150.0
"""A bulk temperature from here on is taken as one above absolute zero [K]; else temperatures are rises."""
HOT_BULK = 573.15
"""Bulk temperature that is said to be hot: 300 C [K]."""
SOFTENING = 423.15
"""Lowest tempering temperature of through-hardened bearing steel, 150 C [K]."""
TRANSFORMATION = 1000.0
"""Eutectoid temperature of steel, 727 C [K]."""


def notes_of(maximum: float, bodies: Sequence[Conductor]) -> tuple[str, ...]:
    """Sentences on a largest temperature [K] over those bodies."""
    return tuple(_notes(maximum, max(body.bulk for body in bodies)))


def _notes(maximum: float, bulk: float) -> Iterator[str]:
    if bulk < ABSOLUTE:
        if maximum > TRANSFORMATION:
            yield (
                f"the temperature rises by {maximum:.0f} K, which neither steel (transformed at 727 C) nor light "
                "metals or polymers stand; heat, speed or conductivity are not what they will be"
            )
        return
    if bulk > HOT_BULK:
        yield (
            f"the bulk temperature of {bulk - 273.15:.0f} C is above 300 C, beyond what oils and hardened bearing "
            "steels stand; the catalogue's thermal constants are those near room temperature"
        )
    if maximum > TRANSFORMATION:
        yield (
            f"the surface reaches {maximum - 273.15:.0f} C, above the transformation of steel (727 C) and the melting "
            "of aluminium (660 C) and polymers; hardness, friction and so the heat are not what they will be"
        )
    elif maximum > SOFTENING >= bulk:
        yield (
            f"the surface reaches {maximum - 273.15:.0f} C; usual hardened bearing steel is tempered at 150 to 200 C "
            "and softens above, most polymers melt below 330 C"
        )
