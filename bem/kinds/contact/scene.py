"""Kind `contact`: two rough, possibly coated bodies pressed together; pressure, gap, approach, stresses below."""

from __future__ import annotations

from typing import Literal

from bem.scenes.keys import key
from bem.scenes.tables.pressing import ContactOutputs, StressedScene


class ContactScene(StressedScene):
    """Two bodies, a grid and a load."""

    kind: Literal["contact"] = key("Kind of computation.", "basic", default="contact")
    outputs: ContactOutputs = key("Results besides pressure, gap and displacement.", "basic", default=ContactOutputs())
