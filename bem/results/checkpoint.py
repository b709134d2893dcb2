"""Checkpoints: a tree of arrays and plain values in one file, with a checksum, and no way to execute anything.

Layout: the line `bem checkpoint 1`, eight bytes little-endian length of the header, the header as JSON, the arrays'
bytes one after the other, 32 bytes of SHA-256 over all before. In the header an array stands as `{"array": i}` and a
dictionary as `{"table": {...}}`; it also has the digest of the code with which the run was begun, since other code may
hold its state otherwise, and ends in other bits in any case.
"""

from __future__ import annotations

import hashlib
import inspect
import json
import os
import struct
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

import bem
from bem.errors import ResultsError
from bem.results.atomic import reason, replacing
from bem.scenes.kind import KINDS, get_kind

_MAGIC = b"bem checkpoint 1\n"
_DIGEST = hashlib.sha256().digest_size


_OUTSIDE_RUNS = ("__main__.py", "app", "benchmarks", "cli", "elements", "plots", "runs", "verification", "warm_up.py")
"""Parts of the package that the run of a case does not execute: imports run downwards only."""


@cache
def code_digest(kind: str) -> str:
    """Digest of the code that a run of a kind executes: a resumed run must have been begun with the same code.

    It covers the package below the kinds, and the kind's own modules without its figures; for a kind from outside the
    package, the file with its `run`. Other kinds, pictures and the command line are left out.

    Parameters
    ----------
    kind : name of the kind; empty for the code of no kind.
    """
    home = Path(bem.__file__).parent
    digest = hashlib.sha256(bem.__version__.encode())
    for path in sorted(home.rglob("*.py")):
        name = path.relative_to(home)
        if name.parts[0] not in (*_OUTSIDE_RUNS, KINDS.name):
            _add_source(digest, path, name.as_posix())
    own = KINDS / kind.replace("-", "_")
    if kind and own.is_dir():
        for path in sorted(own.rglob("*.py")):
            if path.name != "figures.py":
                _add_source(digest, path, path.relative_to(home).as_posix())
    elif kind:
        source = inspect.getsourcefile(get_kind(kind).run)
        if source is not None:
            _add_source(digest, Path(source), kind)
    return digest.hexdigest()[:16]


def _add_source(digest: Any, path: Path, name: str) -> None:
    digest.update(name.encode())
    digest.update(path.read_bytes())


def save_checkpoint(path: Path, state: Mapping[str, Any], kind: str = "") -> None:
    """Replace the checkpoint by `state`, whole or not at all.

    Parameters
    ----------
    path : of the file.
    state : arrays of numbers, numbers, strings, booleans, None, and lists and dictionaries (with text keys) of them.
    kind : name of the kind of the run, whose code must be the same when it is resumed.

    Raises
    ------
    ResultsError : it cannot be written.
    TypeError : something else is in the state.
    """
    arrays: list[NDArray[Any]] = []
    tree = _flatten(state, arrays)
    layout = [[array.dtype.str, list(array.shape)] for array in arrays]
    header = json.dumps({"state": tree, "arrays": layout, "code": code_digest(kind)}).encode()
    with replacing(path) as temporary, open(temporary, "wb") as file:
        digest = hashlib.sha256()
        parts: list[Any] = [
            _MAGIC,
            struct.pack("<Q", len(header)),
            header,
            *(a.reshape(-1).view(np.uint8).data for a in arrays),
        ]
        for part in parts:
            digest.update(part)
            file.write(part)
        file.write(digest.digest())


def load_checkpoint(path: Path, kind: str = "") -> dict[str, Any] | None:
    """The state in the file of a run of a kind, or None where there is no file.

    Raises
    ------
    ResultsError : the file is damaged or cannot be read, or other code wrote it.
    """
    try:
        with open(path, "rb") as file:
            return _read(path, file, kind)
    except FileNotFoundError:
        return None
    except ResultsError:
        raise
    except OSError as error:
        raise ResultsError(f"{path}: the checkpoint cannot be read ({reason(error)})") from error


def _read(path: Path, file: BinaryIO, kind: str) -> dict[str, Any]:
    """The checksum first, then the parts: never more than the arrays in memory."""
    size = os.fstat(file.fileno()).st_size
    digest = hashlib.sha256()
    left = size - _DIGEST
    sound = left >= len(_MAGIC) + 8 and file.read(len(_MAGIC)) == _MAGIC
    file.seek(0)
    while sound and left > 0:
        part = file.read(min(left, 1 << 24))
        sound = bool(part)
        digest.update(part)
        left -= len(part)
    if not sound or file.read() != digest.digest():
        raise ResultsError(f"{path}: the checkpoint is damaged (its checksum does not match); delete it to start again")
    file.seek(len(_MAGIC))
    (length,) = struct.unpack("<Q", file.read(8))
    header = json.loads(file.read(length))
    if header.get("code") != code_digest(kind):
        raise ResultsError(
            f"{path}: the run was begun with another version of bem and would not end as with either; begin it anew "
            "(--overwrite, or another --out), or go on with that version"
        )
    arrays = []
    for kind, shape in header["arrays"]:
        array = np.empty(shape, np.dtype(kind))
        if array.size:
            file.readinto(array.reshape(-1).view(np.uint8).data)  # type: ignore[attr-defined]
        arrays.append(array)
    state = _restore(header["state"], arrays)
    assert isinstance(state, dict)
    return state


def _flatten(value: Any, arrays: list[NDArray[Any]]) -> Any:
    if isinstance(value, np.ndarray):
        if value.dtype.kind not in "fiubc":
            raise TypeError(f"a checkpoint holds arrays of numbers, not of {value.dtype}")
        arrays.append(np.ascontiguousarray(value).reshape(value.shape))
        return {"array": len(arrays) - 1}
    if isinstance(value, np.generic):
        value = value.item()
    if value is None or isinstance(value, bool | int | float):
        return value
    if isinstance(value, str):
        return str(value)
    if isinstance(value, Mapping):
        if not all(isinstance(key, str) for key in value):
            raise TypeError("keys of a checkpoint's dictionaries must be text")
        return {"table": {key: _flatten(item, arrays) for key, item in value.items()}}
    if isinstance(value, list | tuple):
        return [_flatten(item, arrays) for item in value]
    raise TypeError(f"a checkpoint cannot hold {type(value).__name__}")


def _restore(value: Any, arrays: list[NDArray[Any]]) -> Any:
    if isinstance(value, dict):
        if "array" in value:
            return arrays[value["array"]]
        return {key: _restore(item, arrays) for key, item in value["table"].items()}
    if isinstance(value, list):
        return [_restore(item, arrays) for item in value]
    return value
