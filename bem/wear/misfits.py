"""Messages on parts of a wear model that do not go together."""

from __future__ import annotations

from bem.wear.criterion import Detachment, LocalWear
from bem.wear.traction import TractionLaw


def boundary_film_misfits(law: Detachment, tractions: TractionLaw) -> list[str]:
    """Return a message for each part that does not go with a boundary film."""
    found = []
    if not isinstance(law, LocalWear):
        found.append(f"film_defect of criterion {law.name}; allowed: archard, archard_over_hardness, energy, or none")
    if not tractions.slides:
        found.append(f"film_defect has one sliding speed; allowed: no traction {tractions.name}, or none")
    return found
