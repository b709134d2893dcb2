"""Meshes of the finite-element reference: gmsh geometry builders, graded, parametrised and deterministic.

Conventions
-----------
A builder is a frozen dataclass whose fields are its parameters (lengths in units of the problem's own length, usually
the load's half-width), with

- ``build(model)``: draw the geometry in the current gmsh model, tag it and mesh it; curved boundaries get
  ``setOrder(2)``;
- ``dimension``: 2 or 3;
- ``cell_tags`` and ``facet_tags``: which physical group has which number, as dictionaries by name.

Coordinates: x (or the radius r) along the surface, the last coordinate z into the body, the surface is z = 0. Facets
that carry a condition are tagged ``axis`` (x = 0 or the symmetry plane), ``loaded``, ``surface`` (the rest of z = 0),
``far`` (the outer boundary); cells ``layer`` and ``substrate``.

Node numbers are contiguous and every cell belongs to a physical group, as dolfinx needs. The same parameters give the
same mesh, bit for bit: one thread, fixed seed, no user configuration file. Nothing here imports dolfinx: meshes can be
looked at wherever gmsh is installed (``python -m meshes BUILDER --out FILE.msh``).
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Protocol


class Builder(Protocol):
    """What a mesh builder offers; see the module's conventions."""

    @property
    def dimension(self) -> int:
        """2 or 3."""

    def build(self, model: Any) -> None:
        """Draw, tag and mesh in the current gmsh model."""


@contextmanager
def gmsh_model(name: str) -> Iterator[Any]:
    """Open a quiet gmsh session with reproducible options; yields ``gmsh.model``, closes the session at the end."""
    import gmsh

    gmsh.initialize(readConfigFiles=False, interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("General.NumThreads", 1)
        gmsh.option.setNumber("Mesh.RandomSeed", 1)
        gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 0)
        gmsh.option.setNumber("Mesh.MeshSizeFromPoints", 0)
        gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", 0)
        gmsh.model.add(name)
        yield gmsh.model
    finally:
        gmsh.finalize()


def describe(builder: Any) -> dict[str, Any]:
    """Name and parameters of a builder, as stored with results."""
    kind = type(builder)
    return {"builder": f"{kind.__module__}.{kind.__qualname__}", "parameters": dataclasses.asdict(builder)}
