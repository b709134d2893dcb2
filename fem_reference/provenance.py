"""Where a result comes from: sources and parameters, versions, day, processor time."""

from __future__ import annotations

import ast
import datetime
import hashlib
import importlib.metadata
import json
import platform
import resource
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

_ROOT = Path(__file__).resolve().parents[1]
_PACKAGES = ("fem_reference", "meshes")
_NO_FIGURES = {"fem_reference.problem", "fem_reference.provenance", "fem_reference.results"}
"""Modules that only describe, store and compare results."""


def inputs_digest(module: str, parameters: Mapping[str, Any]) -> str:
    """SHA-256 of what determines the figures of a case: statements of the sources, and parameters.

    Comments and docstrings do not count.

    Parameters
    ----------
    module : the module that solves the problem; all that it imports of the reference and of the meshes counts.
    parameters : what it is called with.
    """
    digest = hashlib.sha256(json.dumps(parameters, sort_keys=True).encode())
    for name in sorted(_imported(module) - _NO_FIGURES):
        digest.update(f"{name}\n{_statements(name)}\n".encode())
    return digest.hexdigest()[:32]


@cache
def _imported(module: str) -> frozenset[str]:
    """The module and all modules of the reference and of the meshes that it imports, directly or not."""
    found, ahead = set(), [module]
    while ahead:
        name = ahead.pop()
        if name in found or not _path(name).is_file():
            continue
        found.add(name)
        for node in ast.walk(_parsed(name)):
            if isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] in _PACKAGES:
                ahead += [str(node.module), *(f"{node.module}.{alias.name}" for alias in node.names)]
            elif isinstance(node, ast.Import):
                ahead += [alias.name for alias in node.names if alias.name.split(".")[0] in _PACKAGES]
    return frozenset(found)


@cache
def _statements(module: str) -> str:
    """The syntax tree of a module without docstrings, as text."""
    tree = _parsed(module)
    for node in ast.walk(tree):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef) and ast.get_docstring(node) is not None:
            node.body = node.body[1:]
    return ast.dump(tree)


def _parsed(module: str) -> ast.Module:
    return ast.parse(_path(module).read_text(encoding="utf-8"))


def _path(module: str) -> Path:
    place = _ROOT.joinpath(*module.split("."))
    return place / "__init__.py" if place.is_dir() else place.with_suffix(".py")


def versions() -> dict[str, str]:
    """Versions of everything that could change a figure; "absent" for what is not installed."""
    import numpy

    found = {"python": platform.python_version(), "numpy": numpy.__version__}
    try:
        import dolfinx

        found["dolfinx"] = dolfinx.__version__
    except ImportError:
        found["dolfinx"] = "absent"
    try:
        from petsc4py import PETSc

        found["petsc"] = ".".join(str(part) for part in PETSc.Sys.getVersion())
    except ImportError:
        found["petsc"] = "absent"
    try:
        found["gmsh"] = importlib.metadata.version("gmsh")
    except importlib.metadata.PackageNotFoundError:
        found["gmsh"] = "absent"
    return found


def today() -> str:
    """The day, UTC, ISO 8601."""
    return datetime.datetime.now(datetime.UTC).date().isoformat()


def processor_time() -> float:
    """User and system time of this process and its finished children (compilers), seconds."""
    mine = resource.getrusage(resource.RUSAGE_SELF)
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return mine.ru_utime + mine.ru_stime + children.ru_utime + children.ru_stime
