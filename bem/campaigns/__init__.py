"""Many cases of one scene: which, who computes them, and one dataset of what they gave.

A kind of scene knows one case. Here a scene becomes its cases (`cases`), they are planned together (`planning`), run in
this process, on all cores or on a Dask cluster (`engine`, `local`, `cluster`), each with a checkpoint of its own, and
their records become one summary and one dataset with the axes of the scene as dimensions (`collect`). What runs where
never shows in the result: the same scene gives the same bits on any number of workers.

Knows scenes, kinds, records and checkpoints; no solver, no picture. Verified in tests/campaigns: cases, workers of
every sort bit for bit, what an interrupted run goes on from, statistics over repetitions.
"""

from __future__ import annotations

from bem.campaigns.cases import Campaign, Case, campaign_of
from bem.campaigns.engine import Computed, compute
from bem.campaigns.planning import plan

__all__ = ["Campaign", "Case", "Computed", "campaign_of", "compute", "plan"]
