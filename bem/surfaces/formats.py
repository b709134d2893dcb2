"""Formats of surface files from outside the package: by the file's ending, by how it begins, or both.

`read_surface`, scenes and `bem surface` ask them before the formats they know themselves.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from bem.errors import InputError
from bem.extensions import load_extensions, same_origin
from bem.grid import FloatArray

HeightMap = tuple[FloatArray, tuple[float, float] | None, Mapping[str, Any]]
"""Heights (nx, ny) [m], not-a-number where a point is missing; spacing (dx, dy) [m] or None; notes on the origin."""

_HEAD = 4096


@dataclass(frozen=True)
class SurfaceFormat:
    """A format of surface files: enter it with `bem.register`.

    Attributes
    ----------
    name : in metadata and messages.
    read : function of a path that returns a `HeightMap`; it may raise anything on a damaged file.
    suffixes : endings such as ".xyz"; none for any. Endings or `recognises` are needed.
    recognises : function of the first 4096 bytes that says whether the file has this format; None for any.
    """

    name: str
    read: Callable[[Path], HeightMap]
    suffixes: tuple[str, ...] = ()
    recognises: Callable[[bytes], bool] | None = None

    def enter(self) -> None:
        """Enter it.

        Raises
        ------
        InputError : no name, neither endings nor a beginning, endings without a dot, or a name that is taken.
        """
        messages = []
        if not self.name:
            messages.append("register: a SurfaceFormat needs a name")
        if isinstance(self.suffixes, str) or any(len(one) < 2 or one[0] != "." for one in self.suffixes):
            messages.append(f"register: {self.name}: suffixes {self.suffixes!r} must be a tuple of endings like '.xyz'")
        if not self.suffixes and self.recognises is None:
            messages.append(f"register: {self.name}: needs suffixes, recognises or both")
        if messages:
            raise InputError(messages)
        other = _formats.get(self.name)
        if other is not None and not same_origin(other.read, self.read):
            raise InputError(f"register: the surface format {self.name!r} is taken by {other.read.__module__}")
        _formats[self.name] = self

    def fits(self, path: Path) -> bool:
        """Return True if a file is of this format."""
        if self.suffixes and path.suffix.lower() not in {one.lower() for one in self.suffixes}:
            return False
        if self.recognises is None:
            return True
        with path.open("rb") as stream:
            return bool(self.recognises(stream.read(_HEAD)))


_formats: dict[str, SurfaceFormat] = {}


def format_of(path: Path) -> SurfaceFormat | None:
    """The registered format of a file, None if it is of none; by name in alphabetical order where several fit."""
    load_extensions()
    return next((_formats[name] for name in sorted(_formats) if _formats[name].fits(path)), None)


def modules_of_formats() -> tuple[str, ...]:
    """Modules of all registered formats: what another process has to import to know them too."""
    return tuple(sorted({one.read.__module__ for one in _formats.values()}))
