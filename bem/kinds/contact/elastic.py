"""Elastic contact, or one capped at the hardness: history of its residual, and error bars."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from bem.grid import FloatArray
from bem.kinds.contact.response import Response
from bem.kinds.contact.scene import ContactScene
from bem.kinds.contact.solve import level_before
from bem.scenes.context import Context

if TYPE_CHECKING:
    from bem.accuracy import ContactCase, ErrorBars
    from bem.contact import ContactSolution
    from bem.stress import StressSummary


@dataclass(frozen=True, eq=False)
class ElasticResponse(Response):
    """Elastic contact, or one capped at the hardness.

    solution : the contact. history : (n, 2) iterations and residuals.
    """

    solution: ContactSolution
    history: FloatArray

    differentiable = True

    @property
    def contact(self) -> ContactSolution:
        """See `Response`."""
        return self.solution

    def arrays(self, scene: ContactScene) -> Mapping[str, Any]:
        """See `Response`."""
        if not len(self.history):
            return {}
        return {"iteration": self.history[:, 0].astype(np.int64), "residual_history": self.history[:, 1]}

    def bars(self, scene: ContactScene, case: ContactCase, below: StressSummary | None, context: Context) -> ErrorBars:
        """See `Response`."""
        from bem.accuracy import coarser_before, coating_bars, contact_bars, solve_coarser, stress_bars

        before = level_before(context)
        nested = None if before is None else coarser_before(case, before)
        coarser = nested or solve_coarser(case, scene.contact.max_iterations)
        bars = contact_bars(case, coarser)
        if below is None:
            return bars
        body, sign = scene.stressed()
        friction = sign * scene.contact.friction
        bars |= stress_bars(case, coarser, body, below, friction)
        if not body.layers or below.stress is None:
            return bars
        from bem.accuracy.coating import with_one_estimate

        return with_one_estimate(bars | coating_bars(case, coarser, body, below, friction), below, body)
