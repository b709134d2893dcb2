"""Kind `partial-slip`: where pressed bodies stick and slip while they are pushed along, once or there and back."""

from __future__ import annotations

from typing import Literal

from bem.scenes.keys import key
from bem.scenes.tables.tangential import PushedScene


class PartialSlipScene(PushedScene):
    """Two bodies, what presses them together and what pushes them along."""

    kind: Literal["partial-slip"] = key("Kind of computation.", "basic", default="partial-slip")
