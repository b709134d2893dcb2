"""Scenes: validated files that say what is wanted, the planner, and the kinds of scene there are."""

from __future__ import annotations

from bem.scenes.context import Context, Outcome, PlainContext, Variable
from bem.scenes.kinds import Kind, get_kind, kind_names
from bem.scenes.load import dump_scene, library, load_scene
from bem.scenes.planner import Plan, Step

__all__ = [
    "Context",
    "Kind",
    "Outcome",
    "PlainContext",
    "Plan",
    "Step",
    "Variable",
    "dump_scene",
    "get_kind",
    "kind_names",
    "library",
    "load_scene",
]
