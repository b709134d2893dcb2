"""Cylinder, domain, cycles and variants of a wear loop in boundary lubrication: tables of the kind wear."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, field_validator, model_validator

from bem.errors import InputError
from bem.grid import Grid
from bem.reference_solutions.hertz import cylinder_contact
from bem.scenes.axes import Model, with_keys
from bem.scenes.common import (
    Cells,
    CylinderTable,
    Force,
    Loads,
    PositiveLength,
    PositivePressure,
    Table,
    Variant,
    one_for_both,
    problem,
)
from bem.scenes.laws import LawKey
from bem.scenes.units import Length, Ratio
from bem.scenes.wearing import LastCycles, WearDepthsScene
from bem.wear.criterion import Detachment
from bem.wear.removal import RemovalLaw
from bem.wear.traction import TractionLaw


class CylinderScene(CylinderTable):
    """The contact as a whole: a cylinder along y on a flat, and the loads on its full width; radius 0 is a flat."""

    radius: Annotated[Length, Field(ge=0)] = 0.0
    loads: Loads
    friction: Annotated[Ratio, Field(ge=0, le=2)] = 0.0
    hardness: PositivePressure | None = None


class DomainScene(Table):
    """The slice that is computed: `cells` over a square of `half_widths` Hertz half-widths, or of given `lengths`.

    The half-width is that at each load, as in the thesis, or that at `half_widths_at`, so that cells stay the same over
    loads. Free in x and periodic in y, or periodic in both.
    """

    cells: tuple[Cells, Cells] = (240, 240)
    half_widths: Annotated[Ratio, Field(gt=0, le=100)] | None = None
    half_widths_at: Annotated[Force, Field(gt=0)] | None = None
    lengths: tuple[PositiveLength, PositiveLength] | None = None
    periodic: Literal["y", "both"] = "y"

    _pairs = field_validator("cells", "lengths", mode="before")(one_for_both)

    @model_validator(mode="after")
    def _one_size(self) -> DomainScene:
        if (self.half_widths is None) == (self.lengths is None):
            raise problem("half_widths and lengths", "exactly one of half_widths, lengths")
        if self.half_widths is None and self.half_widths_at is not None:
            raise problem("half_widths_at without half_widths", "half_widths with half_widths_at, or lengths alone")
        return self

    def at(self, cylinder: CylinderScene, modulus: float) -> tuple[Grid, float]:
        """The grid of a case and its load [N], the slice's share of that on the full width; modulus : E* [Pa]."""
        (load,), lengths, (nx, ny) = cylinder.loads, self.lengths, self.cells
        if lengths is None:
            assert self.half_widths is not None
            per_length = (self.half_widths_at or load) / cylinder.width
            smooth = cylinder_contact(radius=cylinder.radius, contact_modulus=modulus, load=per_length)
            lengths = (self.half_widths * smooth.half_width,) * 2
        grid = Grid((nx, ny), (lengths[0] / nx, lengths[1] / ny), periodic=(self.periodic == "both", True))
        return grid, load * grid.lengths[1] / cylinder.width


class CyclesScene(LastCycles):
    """How long: `count` cycles, or until settled; means are over the last `settled` cycles."""

    stop_when_settled: bool = Field(default=False, strict=True)
    tolerance: Annotated[Ratio, Field(gt=0, lt=1)] = 0.02


class WearVariantScene(Variant):
    """A run that differs from the scene in what is given here: mesh, roughness, film, sliding per cycle."""

    cells: Annotated[int, Field(strict=True, ge=2, le=8192)] | None = None
    depths: WearDepthsScene | None = None
    shift: Annotated[int, Field(strict=True, ge=-10_000, le=10_000)] | None = None
    lower_rms_height: PositiveLength | None = None
    upper_rms_height: PositiveLength | None = None
    layer_thickness: PositiveLength | None = None
    connectivity: Literal[6, 18, 26] | None = None
    refinement: Literal["monotone_cubic", "linear", "exact"] | None = None
    criterion: Annotated[Detachment, LawKey("criterion")] | None = None
    removal: Annotated[RemovalLaw, LawKey("removal")] | None = None
    traction: Annotated[TractionLaw, LawKey("traction")] | None = None

    def applied(self, scene: Model) -> Model:
        """The scene with a variant's changes in it.

        Raises
        ------
        InputError : a roughness for a surface that is not generated, a film thickness without a film.
        """
        changes = self.changes()
        thickness = changes.pop("layer_thickness", None)
        for name in ("lower", "upper"):
            if f"{name}_rms_height" in changes and getattr(scene, name).surface.kind == "smooth":
                raise InputError(f"variants.{name}_rms_height: the {name} surface is smooth; allowed: a rough one")
        if "cells" in changes:
            changes["cells"] = (changes["cells"],) * 2
        scene = with_keys(scene, {_VARIED.get(key, f"wear.{key}"): value for key, value in changes.items()})
        coated = [name for name in ("lower", "upper") if getattr(scene, name).stack]
        if thickness is not None and not coated:
            raise InputError("variants.layer_thickness: neither body is coated; allowed: a scene with a layer")
        bodies = {name: getattr(scene, name) for name in coated if thickness is not None}
        return with_keys(scene, {name: body.with_outermost(thickness) for name, body in bodies.items()})


_VARIED = {
    "cells": "domain.cells",
    "depths": "depths",
    "lower_rms_height": "lower.surface.rms_height",
    "upper_rms_height": "upper.surface.rms_height",
}
"""Where the keys of a variant stand in the scene, if not in `wear`."""
