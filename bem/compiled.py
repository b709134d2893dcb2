"""How loops are compiled, where they are kept, and whether they are there yet.

A loop stands below one of two decorators, which say all of it: it is kept on disk, lets go of the interpreter lock, a
division by zero gives infinity or not-a-number, and its arithmetic is that of its text. A loop that does not say the
last two is compiled as its first caller is, so that bits would follow the order of calls.

Sums stay in the order written and no product is rounded together with a sum. Where the compiler may choose, it chooses
by whether the loops that one calls were compiled in the same process or read from disk: of a b + c d it fused one or
the other, and a contact had other bits by the order in which an earlier process had met its loops. What the freedom
was worth: nothing up to 512 x 512 cells, 2 to 5 % of a contact of 1024 x 1024.

Annotations of a loop are for readers: what it takes is found when it is compiled.

Verified in tests/test_compiled_loops.py and tests/packaging/test_warm_up.py.
"""

from __future__ import annotations

import os
import re
import sys
import zlib
from pathlib import Path
from typing import Any, Literal

_HERE = Path(__file__).resolve().parent
SECONDS = 40.0
"""Approximate time that the loops of a contact take to compile on two cores [s]."""


def compiled(function: Any) -> Any:
    """A loop by itself."""
    return _loop(function, "never")


def inlined(function: Any) -> Any:
    """A loop that is written into each loop that calls it."""
    return _loop(function, "always")


def _loop(function: Any, inline: Literal["never", "always"]) -> Any:
    from numba import njit

    return njit(cache=True, nogil=True, error_model="numpy", fastmath=False, inline=inline)(function)


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


_LOOP = re.compile(r"^(@(compiled|inlined|intrinsic)|def compiled\(.*)$", re.MULTILINE)
"""What a source with loops has, and this one, which says how they are compiled."""
_IMPORTED = re.compile(r"^from bem([\w.]*) import (\([^)]*\)|[^\n]*)", re.MULTILINE)


def drop_stale(root: Path = _HERE) -> list[str]:
    """Remove compiled loops that are older than a file whose functions or numbers were compiled into them, or of which
    one was written since the last look, and return their names: numba looks at a loop's own file alone, so that who
    edits one that others call would run what it was. A process that began before may have compiled since, from what it
    had read: such loops beside new ones would take one another's arrays for what they are not.

    Only of a checkout, whose sources are edited; a millisecond where none is newer than at the last look.
    """
    if not (root.parent / "pyproject.toml").exists():
        return []
    named = os.environ.get("NUMBA_CACHE_DIR")
    kept = (Path(named) if named else root / "__pycache__") / f"sources-{zlib.crc32(str(root).encode()):08x}"
    times = _times(str(root))
    stamp = "\n".join(f"{time} {path}" for path, time in sorted(times.items()))
    try:
        before = kept.read_text() if kept.exists() else ""
        if before == stamp:
            return []
        known = set(before.splitlines())
        written = {path for path, time in times.items() if known and f"{time} {path}" not in known}
        dropped = _drop_older(root, Path(named) if named else None, times, written)
        beside = kept.with_name(f"{kept.name}.{os.getpid()}")
        kept.parent.mkdir(parents=True, exist_ok=True)
        beside.write_text(stamp)
        beside.replace(kept)
    except OSError:  # read-only, or another process was here first
        return []
    return dropped


def _times(folder: str) -> dict[str, int]:
    """When each source in a folder and those within was last written [ns]."""
    found: dict[str, int] = {}
    with os.scandir(folder) as entries:
        for entry in entries:
            if entry.is_dir() and entry.name != "__pycache__":
                found |= _times(entry.path)
            elif entry.name.endswith(".py"):
                found[entry.path] = entry.stat().st_mtime_ns
    return found


def _drop_older(root: Path, named: Path | None, times: dict[str, int], written: set[str]) -> list[str]:
    """Remove indices of compiled loops older than what their files import, those files in turn where they have loops
    themselves, and all of those that import what was just written."""
    texts = {path: Path(path).read_text(encoding="utf-8") for path in times}
    looped = {path for path, text in texts.items() if _LOOP.search(text)}
    imports = {path: _imports(root, texts[path], looped) & times.keys() for path in looped}
    dropped = []
    for path in sorted(looped):
        seen, ahead = {path}, [path]
        while ahead:
            new = imports.get(ahead.pop(), set()) - seen
            seen |= new
            ahead += new
        newest, source = max(times[each] for each in seen), Path(path)
        folders = [source.parent / "__pycache__"] if named is None else named.glob("*")
        for index in (index for folder in folders for index in folder.glob(f"{source.stem}.*.nbi")):
            if seen & written or index.stat().st_mtime_ns < newest:
                index.unlink(missing_ok=True)
                dropped.append(index.name)
    return dropped


def _imports(root: Path, text: str, looped: set[str]) -> set[str]:
    """Paths of what a source imports from this package that may be in its loops: modules, and functions and numbers of
    modules, of those without loops numbers alone."""
    found: set[str] = set()
    for module, names in _IMPORTED.findall(text):
        home, each = root.joinpath(*module.split(".")[1:]), re.findall(r"\w+", names)
        found |= {f"{home / name}.py" for name in each}
        places = {f"{home}.py", str(home / "__init__.py")}
        found |= places if any(name.isupper() for name in each) else places & looped
    return found


def is_cold() -> bool:
    """Whether the next run has to compile first: none of the transforms' loops is newer than their source."""
    if os.environ.get("NUMBA_DISABLE_JIT", "0") != "0":
        return False
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
