"""Two maps that come with the package, so that scenes with files run anywhere: `example/ground-disk.al3d` and
`example/polished-pin.x3p`.

They are not measured: `tests/surfaces/make_examples.py` generated them, with the tilt, the missing points and the
spikes that instruments leave, and wrote them in two instruments' formats; the files say so, too.
"""

from __future__ import annotations

import os
from pathlib import Path

_PREFIX = "example/"
FOLDER = Path(__file__).with_name("example")


def example_names() -> tuple[str, ...]:
    """What `read_surface` and scenes may be given as a path."""
    return tuple(_PREFIX + item.name for item in sorted(FOLDER.iterdir()) if not item.name.startswith("."))


def example_path(path: str | os.PathLike[str]) -> Path | None:
    """The file of an example, None for any other path, and where a file of that name is there."""
    text = os.fspath(path)
    if not isinstance(text, str) or not text.startswith(_PREFIX) or Path(text).exists():
        return None
    file = FOLDER / text.removeprefix(_PREFIX)
    return file if file.parent == FOLDER and file.is_file() else None
