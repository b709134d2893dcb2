"""Files that are written whole or not at all: into a neighbour first, forced to disk, then renamed.

A new name is on disk once its folder has been forced there (`force_names`): until then a computer that stops may show
the old file, whole. Whoever writes many files does so once for all of them, a third of what waiting for a disk cost.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from bem.errors import ResultsError


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Yield a temporary path beside `path`; what is written there takes the place of `path` when the block ends well.

    The temporary name ends like `path` does, since some writers choose their format by it.

    Raises
    ------
    ResultsError : the system refused (disk full, folder read-only, ...); the old file, if any, is untouched.
    """
    temporary = path.with_name(f".writing-{os.getpid()}-{path.name}")
    try:
        yield temporary
        _sync(temporary)
        os.replace(temporary, path)
    except OSError as error:
        if isinstance(error, ResultsError):
            raise
        raise ResultsError(f"{path}: cannot be written ({reason(error)}); nothing is left half-written") from error
    finally:
        with suppress(OSError):
            temporary.unlink(missing_ok=True)


def write_bytes(path: Path, data: bytes) -> None:
    """Replace the file's content by `data`; raises ResultsError as `replacing` does."""
    with replacing(path) as temporary:
        temporary.write_bytes(data)


def write_text(path: Path, text: str) -> None:
    """Replace the file's content by `text` in UTF-8; raises ResultsError as `replacing` does."""
    write_bytes(path, text.encode("utf-8"))


def force_names(folder: Path) -> None:
    """Force to disk which files a folder holds, where its file system can."""
    with suppress(OSError):
        _sync(folder)


def reason(error: OSError) -> str:
    """Return the system's message without the path."""
    return error.strerror or str(error) or type(error).__name__


def _sync(path: Path) -> None:
    """Force a file, or what a folder lists, to disk."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
