"""Results on disk: run directories, datasets, checkpoints, VTK. Every file is there whole or not at all.

`directory` is the folder of a run, `read` opens a finished one, `atomic` writes a file whole, `checkpoint` keeps a
state to the last bit, `arrays` and `dataset` read and write netCDF, `scratch` holds what does not fit in memory,
`compare` lays runs side by side.

Sees scenes and no solver. Verified in tests/results (bits, units, damage told) and tests/reliability (killed anywhere).
"""

from __future__ import annotations

from bem.results.directory import RunDirectory
from bem.results.read import FinishedRun, open_run

__all__ = ["FinishedRun", "RunDirectory", "open_run"]
