"""Where compiled loops are kept, and whether they are there yet."""

from __future__ import annotations

import os
import sys
from pathlib import Path

_HERE = Path(__file__).resolve().parent
SECONDS = 15.0
"""What compiling takes, about, beside a contact that takes one [s]."""


def provide_folder() -> None:
    """Let numba keep compiled loops somewhere: beside the sources where that can be written, as it does by itself, else
    in the user's cache folder, else in a temporary one of this user's own. `NUMBA_CACHE_DIR` goes before all.

    Without this an installation that is read-only, used by somebody without a home, could not be imported at all.
    """
    if os.environ.get("NUMBA_CACHE_DIR") or os.access(_HERE, os.W_OK):
        return
    import tempfile

    base = os.environ.get("XDG_CACHE_HOME") or os.path.join(os.path.expanduser("~"), ".cache")
    own = Path(tempfile.gettempdir()) / f"bem-compiled-{os.getuid()}"
    for folder in (Path(base) / "bem" / "compiled", own):
        try:
            folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            status = folder.stat()
        except OSError:
            continue
        # what is in it is executed: nobody else may have put it there
        if os.access(folder, os.W_OK) and status.st_uid == os.getuid() and not status.st_mode & 0o022:
            os.environ["NUMBA_CACHE_DIR"] = str(folder)
            if "numba" in sys.modules:  # it has read the variable already
                sys.modules["numba"].config.CACHE_DIR = str(folder)
            return


def is_cold() -> bool:
    """Whether the next run has to compile first: none of the transforms' loops is newer than their source."""
    named = os.environ.get("NUMBA_CACHE_DIR")
    folders = Path(named).glob("*") if named else [_HERE / "transforms" / "__pycache__"]
    version = f"py{sys.version_info[0]}{sys.version_info[1]}"
    try:
        changed = (_HERE / "transforms" / "loops.py").stat().st_mtime
        return not any(
            index.stat().st_mtime >= changed for folder in folders for index in folder.glob(f"loops.*.{version}*.nbi")
        )
    except OSError:
        return True
