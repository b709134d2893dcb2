"""Standard streams that survive a closed, full or broken terminal, and the exit code of a command that lost its output.

Everything that a command prints passes through `OutputStream`. Its first failed write is remembered, and all later text
is dropped: a run goes on to its end whatever happens to the terminal.
"""

from __future__ import annotations

import io
import os
import sys
from contextlib import suppress
from typing import Any

_OUTPUT_LOST = 1
"""Exit code of a command whose only result is its output, where that could not be written."""


class OutputStream(io.RawIOBase):
    """Raw stream on a file descriptor; a failed write sets `lost` and is not raised.

    Parameters
    ----------
    descriptor : open file descriptor; it stays open when this stream is closed.
    lost : True if the output is lost from the start, as on a descriptor that was closed before the command began.
    """

    def __init__(self, descriptor: int, *, lost: bool = False) -> None:
        super().__init__()
        self._descriptor = descriptor
        self.lost = lost

    def fileno(self) -> int:
        """File descriptor."""
        return self._descriptor

    def isatty(self) -> bool:
        """True if the descriptor is a terminal."""
        return os.isatty(self._descriptor)

    def writable(self) -> bool:
        """Always True."""
        return True

    def write(self, data: Any, /) -> int:
        """Write bytes, or drop them once a write has failed; return the number of bytes taken."""
        size = memoryview(data).nbytes
        if self.lost:
            return size
        try:
            return os.write(self._descriptor, data)
        except BlockingIOError:  # a terminal that is slow, not lost
            return self._write_blocking(data, size)
        except OSError:
            self.lost = True
            return size

    def _write_blocking(self, data: Any, size: int) -> int:
        import select

        with suppress(OSError, ValueError):
            select.select([], [self._descriptor], [])
            return os.write(self._descriptor, data)
        self.lost = True
        return size


class _State:
    """State of the standard output of this process: the stream, and whether the results lie in files."""

    output: OutputStream | None = None
    saved: bool = False


def protect_streams() -> None:
    """Replace `sys.stdout` and `sys.stderr` by streams that never raise; open /dev/null on descriptors that are closed.

    A descriptor that stays closed would be given to the next file that is opened, such as a run's results, and what is
    printed would be written into that file. Streams that someone has replaced already are left as they are.
    """
    closed = [descriptor for descriptor in (0, 1, 2) if not _is_open(descriptor)]
    for descriptor in closed:
        opened = os.open(os.devnull, os.O_RDWR)
        if opened != descriptor:
            os.dup2(opened, descriptor)
            os.close(opened)
        os.set_inheritable(descriptor, True)
    for name, descriptor in (("stdout", 1), ("stderr", 2)):
        old = getattr(sys, name)
        if old is not getattr(sys, f"__{name}__"):
            continue
        raw = OutputStream(descriptor, lost=descriptor in closed)
        text = io.TextIOWrapper(
            io.BufferedWriter(raw),
            encoding=getattr(old, "encoding", None) or "utf-8",
            errors="backslashreplace",  # a name or a unit that the terminal cannot spell is no reason to stop
            line_buffering=name == "stderr" or raw.isatty(),
        )
        if old is not None:
            with suppress(OSError, ValueError):
                old.flush()
        setattr(sys, name, text)
        if name == "stdout":
            _State.output = raw


def results_saved() -> None:
    """Say that the command's results lie in files: the exit code then does not depend on the terminal."""
    _State.saved = True


def code_at_end(code: int) -> int:
    """Exit code of a command that ended with `code`: 1 instead of 0 if the output was its only result and is lost."""
    with suppress(OSError, ValueError):
        sys.stdout.flush()
    if code == 0 and not _State.saved and _State.output is not None and _State.output.lost:
        return _OUTPUT_LOST
    return code


def _is_open(descriptor: int) -> bool:
    try:
        os.fstat(descriptor)
    except OSError:
        return False
    return True
