"""Where a result comes from: versions, day, processor time."""

from __future__ import annotations

import datetime
import importlib.metadata
import platform
import resource


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
