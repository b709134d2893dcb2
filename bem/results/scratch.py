"""Arrays that may be larger than memory: on disk beside the run, gone with the process."""

from __future__ import annotations

import math
import mmap
import os
import tempfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from bem.errors import ResultsError
from bem.results.atomic import reason
from bem.scenes.context import LARGE


def scratch_array(folder: Path, shape: tuple[int, ...], large: int = LARGE) -> NDArray[np.float64]:
    """An uninitialised array; a large one is kept in a file of its own in `folder` that has no name.

    The system moves its pages between memory and disk; `bem.scenes.context.release` lets go of them.

    Raises
    ------
    ResultsError : a folder that cannot be written, or a disk without room for it (asked for beforehand: a full one ends
        a process that writes to a page).
    """
    size = 8 * math.prod(shape)
    if size < large:
        return np.empty(shape)
    try:
        with tempfile.TemporaryFile(dir=folder) as file:
            os.posix_fallocate(file.fileno(), 0, size)
            pages = mmap.mmap(file.fileno(), size)
    except OSError as error:
        raise ResultsError(f"{folder}: cannot hold {size / 2**30:.3g} GiB of scratch ({reason(error)})") from error
    return np.frombuffer(pages, np.float64).reshape(shape)
