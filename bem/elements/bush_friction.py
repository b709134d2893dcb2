"""Friction of film and asperities of a lubricated bush, by the balance of kind friction.

The scene is the one that `bem element --scene FILE --kind friction` writes, so that element and scene agree.
Verified in tests/elements/test_plain_bush.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from bem.errors import Status
from bem.scenes.context import PlainContext


@dataclass(frozen=True)
class SharedFriction:
    """Balance of film and asperities of a bush.

    Attributes
    ----------
    friction : coefficient of film and asperities. asperity_share : of the load. hottest : highest temperature of the
        touching surfaces [K]; None without heat or contact.
    """

    friction: float
    asperity_share: float
    hottest: float | None


class _FirstRepetition(PlainContext):
    """Context with the random surfaces that a run of the scene has in its first repetition."""

    def seed(self, purpose: str, *indices: int) -> int:
        """See `bem.scenes.context.Context`."""
        return super().seed(purpose, 0, *indices)


def shared_friction(scene: Mapping[str, Any], load: float) -> SharedFriction | None:
    """Solve the load sharing of a scene of kind friction under one load [N]; None where it does not converge.

    Raises
    ------
    InputError : a scene that cannot be made.
    """
    from bem.kinds.friction.kind import KIND
    from bem.kinds.friction.run import run
    from bem.scenes.load import load_scene

    resolved = KIND.resolved(load_scene({**scene, "outputs": {"errors": False}}))
    record = run(resolved, _FirstRepetition(resolved.seed))
    if record.status is not Status.CONVERGED:
        return None
    flash = record.flash_temperature
    hottest = None if flash is None or not math.isfinite(flash[0]) else float(flash[0])
    return SharedFriction(float(record.friction[0]), float(record.contact_load[0]) / load, hottest)
