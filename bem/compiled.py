"""Compilation of loops with numba, and the folder that keeps the compiled code.

1. `compiled` and `inlined` are the two decorators. Both release the interpreter lock, let a division by zero give
   infinity or not-a-number, and forbid the compiler to reorder sums or to fuse a product with a sum. A loop that does
   not fix these options is compiled with the options of its first caller, so that its bits would depend on the order
   of calls. Fused products gained nothing up to 512 x 512 cells and 2 to 5 % of a contact of 1024 x 1024.
2. Compiled code is kept in `cache_folder()`, one folder per module and source. The folder's name ends in a hash of the
   source of the module and of everything that numba compiles into its loops: loops, named tuples and constants imported
   from other modules of this package. numba itself looks at the module's own file only. An edit therefore recompiles
   the edited loops and all loops that contain them; a process that began before the edit keeps to its own folder.
3. `is_cold` tells whether the next run has to compile first.

Annotations of a loop are for readers: numba infers the argument types at compilation.

Verified in tests/test_compiled_loops.py and tests/packaging/test_warm_up.py.
"""

from __future__ import annotations

import functools
import hashlib
import os
import sys
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any, Literal

_HERE = Path(__file__).resolve().parent
_PACKAGE = __name__.partition(".")[0] + "."
SECONDS = 40.0
"""Approximate time to compile the loops of a contact on two cores [s]."""
FILM_SECONDS = {"line": 5.0, "point": 45.0}
"""Approximate processor time to compile the loops of a film alone, of a cylinder and of a ball [s]."""
SHARING_SECONDS = 15.0
"""Approximate processor time to compile the loops of load sharing and its heat beside those of contact and film [s].

The first run of a mixed cylinder with lumped heat took 63 s of processor time, of which 4 s without compiling."""
WEAR_SECONDS = 65.0
"""Approximate processor time to compile the loops of film, stresses and particles of a running-in beside those [s]."""


def compiled(function: Any) -> Any:
    """Compile a loop as a function of its own."""
    return _loop(function, "never")


def inlined(function: Any) -> Any:
    """Compile a loop into each loop that calls it."""
    return _loop(function, "always")


def _loop(function: Any, inline: Literal["never", "always"]) -> Any:
    from numba import config, njit

    loop = njit(nogil=True, error_model="numpy", fastmath=False, inline=inline)(function)
    folder = cache_folder()
    if folder is not None and hasattr(loop, "enable_caching"):  # not with NUMBA_DISABLE_JIT
        settings = vars(config)
        before = settings["CACHE_DIR"]
        settings["CACHE_DIR"] = str(folder / f"{function.__module__}-{_source_hash(function.__module__)}")
        try:
            loop.enable_caching()
        finally:
            settings["CACHE_DIR"] = before
    return loop


def cache_folder() -> Path | None:
    """Folder of all compiled loops; None if no folder can be written.

    The first of: the variable NUMBA_CACHE_DIR, the package's own folder, the user's cache folder, and a temporary
    folder of this user. The last two serve installations that are read-only.
    """
    named = os.environ.get("NUMBA_CACHE_DIR")
    if named:
        return Path(named)
    return _HERE / "__pycache__" / "loops" if os.access(_HERE, os.W_OK) else _user_folder()


def _user_folder() -> Path | None:
    import tempfile

    base = os.environ.get("XDG_CACHE_HOME") or os.path.join(os.path.expanduser("~"), ".cache")
    own = Path(tempfile.gettempdir()) / f"bem-compiled-{os.getuid()}"
    for folder in (Path(base) / "bem" / "compiled", own):
        try:
            folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            status = folder.stat()
        except OSError:
            continue
        # the files are executed: no other user may write them
        if os.access(folder, os.W_OK) and status.st_uid == os.getuid() and not status.st_mode & 0o022:
            return folder
    return None


def _source_hash(name: str) -> str:
    """Hash of what the loops of a module are compiled from; the module has imported all of it already."""
    if name not in _HASHES:
        _HASHES[name] = ""  # ends circular imports
        module = sys.modules[name]
        digest = hashlib.sha256(_source(__file__) + _source(module.__file__))
        for key, item in sorted(vars(module).items()):
            if not key.startswith("__"):
                digest.update(_constant(item) or _source_hash_of_owner(item, name).encode())
        _HASHES[name] = digest.hexdigest()[:16]
    return _HASHES[name]


_HASHES: dict[str, str] = {}


def _constant(item: Any) -> bytes:
    """Value of a number, a text, an array or a tuple of numbers; empty for other objects."""
    if type(item).__module__ == "numpy" and hasattr(item, "tobytes"):
        return bytes(item.tobytes())
    parts = item if isinstance(item, tuple) else (item,)
    return repr(item).encode() if all(isinstance(part, int | float | complex | str) for part in parts) else b""


def _source_hash_of_owner(item: Any, importer: str) -> str:
    """`_source_hash` of the module of this package that defines a loop, a named tuple or a module; else empty."""
    owner = item.__name__ if isinstance(item, ModuleType) else getattr(item, "__module__", None)
    if not isinstance(owner, str) or not owner.startswith(_PACKAGE) or owner in (importer, __name__):
        return ""
    # numba compiles neither plain functions and classes into a loop, nor objects
    plain = isinstance(item, FunctionType) or (isinstance(item, type) and not hasattr(item, "_fields"))
    if plain or not (isinstance(item, ModuleType) or callable(item)):
        return ""
    return _source_hash(owner)


@functools.cache
def _source(file: str) -> bytes:
    return Path(file).read_bytes()


def is_cold(module: str = "transforms.loops") -> bool:
    """Return whether the next run has to compile: no compiled loop of a module is newer than its source.

    module : whose loops are looked for, by its name within the package; that of the transforms, which every contact
        needs, by default.
    """
    if os.environ.get("NUMBA_DISABLE_JIT", "0") != "0":
        return False
    folder, version = cache_folder(), f"py{sys.version_info[0]}{sys.version_info[1]}"
    if folder is None:
        return True
    try:
        changed = _HERE.joinpath(*module.split(".")).with_suffix(".py").stat().st_mtime
        indices = folder.glob(f"{_PACKAGE}{module}-*/*/{module.rpartition('.')[2]}.*.{version}*.nbi")
        return not any(index.stat().st_mtime >= changed for index in indices)
    except OSError:
        return True
