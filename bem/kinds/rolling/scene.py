"""Kind `rolling`: where pressed bodies stick and slip while they roll over each other, with creepage and spin."""

from __future__ import annotations

from typing import Literal

from bem.scenes.keys import key
from bem.scenes.tables.tangential import RolledScene


class RollingContactScene(RolledScene):
    """Two bodies, what presses them together and how they roll."""

    kind: Literal["rolling"] = key("Kind of computation.", "basic", default="rolling")
