"""Scenes: validated files that say what is wanted, the planner, and what a kind of scene is.

`load` reads a scene and writes it resolved, `validate` turns mistakes into messages, `units` reads quantities, `build`
makes bodies, surfaces and grids of it, `checks` warns of what an expert would, `planner` estimates;
`records` says what a case gives. The kinds themselves and the built-in scenes are in `bem.kinds`.

Sees the solvers, and no folder of results. Verified in tests/scenes, tests/gallery (every built-in
scene) and tests/reliability (hostile and random scenes).
"""

from __future__ import annotations

from bem.scenes.context import Context, Outcome, PlainContext, Variable
from bem.scenes.kind import Kind, get_kind, kind_names
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
