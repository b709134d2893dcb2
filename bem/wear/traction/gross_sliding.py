"""Gross sliding, the source's traction law."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from bem.grid import FloatArray
from bem.laws import register
from bem.wear.criterion import Criterion, LocalWear
from bem.wear.traction.base import TractionLaw

if TYPE_CHECKING:
    from bem.wear.setup import WearSetup


@register
@dataclass(frozen=True)
class GrossSliding(TractionLaw):
    """Friction x pressure along +x at every place: the bodies slide over each other (thesis, papers C and D)."""

    name: ClassVar[str] = "gross_sliding"

    @property
    def slides(self) -> bool:
        """True."""
        return True

    def misfits(self, criterion: Criterion, stress_range: bool) -> tuple[str, ...]:
        """Return a message if a local law has no sliding distance."""
        if isinstance(criterion, LocalWear) and criterion.distance == 0:
            return (
                f"criterion {criterion.name}: distance 0 m wears nothing; allowed: criterion.distance, the sliding "
                'distance that one cycle stands for, above 0, such as "1 mm"',
            )
        return ()

    def rub(self, pressure: FloatArray, friction: float, setup: WearSetup) -> None:
        """Return None: the traction is friction x pressure."""
        return None
