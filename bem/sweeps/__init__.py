"""Many runs of one scene: which points, who computes them, and one dataset of what they gave."""

from __future__ import annotations

from bem.sweeps.run import FinishedSweep, run_sweep

__all__ = ["FinishedSweep", "run_sweep"]
