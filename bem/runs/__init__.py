"""Runs on disk: one scene to its folder (`scene`), one scene at many values of its keys to a folder of such (`sweep`).

Computing and handing out is the business of `bem.campaigns`; here is what is written and when. Knows folders, results
and plots; no solver. Verified in tests/results (what a folder holds), tests/gallery (every built-in scene) and
tests/test_cli_commands.py.
"""

from typing import TYPE_CHECKING

from bem.startup.lazy import loader

if TYPE_CHECKING:
    from bem.runs.scene import plan_scene, run_scene
    from bem.runs.sweep import FinishedSweep, run_sweep

__all__ = ["FinishedSweep", "plan_scene", "run_scene", "run_sweep"]

__getattr__ = loader(__name__, {"scene": ["plan_scene", "run_scene"], "sweep": ["FinishedSweep", "run_sweep"]})
