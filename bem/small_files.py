"""Files that people write by hand: regular, not larger than they should be, and read without waiting for anybody."""

from __future__ import annotations

import os
import stat

MOST_BYTES = 1_000_000


def read_small(path: str | os.PathLike[str]) -> bytes:
    """The content of a regular file of at most `MOST_BYTES`.

    Raises
    ------
    OSError : it cannot be opened or read. ValueError : it is a pipe or a device, or larger.
    """
    # a pipe that nobody writes into would keep an ordinary `open` for ever
    descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC)
    with open(descriptor, "rb") as file:
        if not stat.S_ISREG(os.fstat(descriptor).st_mode):
            raise ValueError("not a regular file")
        content = file.read(MOST_BYTES + 1)
    if len(content) > MOST_BYTES:
        raise ValueError(f"larger than {MOST_BYTES} bytes")
    return content
