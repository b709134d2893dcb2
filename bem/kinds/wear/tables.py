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
    HertzPressures,
    Loads,
    PositiveLength,
    PositivePressure,
    Table,
    Variant,
    exactly_one,
    one_for_both,
    problem,
)
from bem.scenes.keys import key
from bem.scenes.laws import LawKey
from bem.scenes.units import Length, Ratio
from bem.scenes.wearing import LastCycles, WearDepthsScene
from bem.wear.criterion import Criterion
from bem.wear.removal import RemovalLaw
from bem.wear.traction import TractionLaw


class CylinderScene(CylinderTable):
    """The cylinder on the flat, its loads and its friction; radius 0 is a flat."""

    radius: Annotated[Length, Field(ge=0)] = key("Radius of the cylinder; 0 is a flat.", "basic", default=0.0)
    loads: Loads | None = key(
        "Normal loads on the width, one result for each; instead of hertz_pressures.",
        "basic",
        default=None,
        example=["10 N"],
    )
    hertz_pressures: HertzPressures | None = key(
        "Maximum Hertz pressures of the smooth contact, one result for each; instead of loads.",
        "basic",
        default=None,
        example=["1.2 GPa"],
    )
    friction: Annotated[Ratio, Field(ge=0, le=2)] = key(
        "Friction coefficient of boundary lubrication: shear stress over pressure.", "basic", default=0.0
    )
    hardness: PositivePressure | None = key(
        "Hardness that limits the contact pressure.",
        "advanced",
        default=None,
        reason="that of the softer body",
        example="2 GPa",
    )

    @model_validator(mode="after")
    def _one_load(self) -> CylinderScene:
        exactly_one(self, "loads", "hertz_pressures")
        if self.hertz_pressures is not None and self.radius == 0:
            raise problem("hertz_pressures of a flat", "a radius, or loads")
        return self

    def forces(self, contact_modulus: float) -> list[float]:
        """Loads on the width [N], as given or by the maximum pressures."""
        if self.loads is not None:
            return list(self.loads)
        assert self.hertz_pressures is not None
        return [self.load_under(pressure, contact_modulus) for pressure in self.hertz_pressures]


class DomainScene(Table):
    """The slice of the contact that is computed."""

    cells: tuple[Cells, Cells] = key(
        "Number of cells along x and y; check that particle sizes do not depend on it.", "basic", default=(240, 240)
    )
    half_widths: Annotated[Ratio, Field(gt=0, le=100)] | None = key(
        "Side of the computed square in Hertz half-widths; instead of lengths.",
        "basic",
        default=None,
        example=4.0,
    )
    half_widths_at: Annotated[Force, Field(gt=0)] | None = key(
        "Load whose Hertz half-width sets the slice for all loads.",
        "advanced",
        default=None,
        reason="each load its own",
    )
    lengths: tuple[PositiveLength, PositiveLength] | None = key(
        "Side lengths of the slice along x and y; instead of half_widths.", "basic", default=None, example="40 um"
    )
    periodic: Literal["y", "both"] = key(
        "Periodic continuation: along y (line contact), or both axes (nominally flat contact).", "advanced", default="y"
    )

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
        (load,), lengths, (nx, ny) = cylinder.forces(modulus), self.lengths, self.cells
        if lengths is None:
            assert self.half_widths is not None
            per_length = (self.half_widths_at or load) / cylinder.width
            smooth = cylinder_contact(radius=cylinder.radius, contact_modulus=modulus, load=per_length)
            lengths = (self.half_widths * smooth.half_width,) * 2
        grid = Grid((nx, ny), (lengths[0] / nx, lengths[1] / ny), periodic=(self.periodic == "both", True))
        return grid, load * grid.lengths[1] / cylinder.width


class CyclesScene(LastCycles):
    """Number of wear cycles, and of the last ones over which means are taken."""

    stop_when_settled: bool = key(
        "End the run as soon as particle size and roughness have settled.", "advanced", default=False, strict=True
    )
    tolerance: Annotated[Ratio, Field(gt=0, lt=1)] = key(
        "Relative change of particle size and roughness below which they have settled.", "advanced", default=0.02
    )


class WearVariantScene(Variant):
    """Changes of mesh, roughness, film and wear model."""

    cells: Annotated[int, Field(strict=True, ge=2, le=8192)] | None = key(
        "Number of cells along x and y.", "basic", default=None, example=256
    )
    depths: WearDepthsScene | None = key("Depths at which stresses are computed.", "basic", default=None)
    shift: Annotated[int, Field(strict=True, ge=-10_000, le=10_000)] | None = key(
        "Sliding distance of a cycle, in cells.", "advanced", default=None, example=3
    )
    lower_rms_height: PositiveLength | None = key(
        "Root-mean-square roughness Sq of the lower surface.", "basic", default=None, example="0.2 um"
    )
    upper_rms_height: PositiveLength | None = key(
        "Root-mean-square roughness Sq of the upper surface.", "basic", default=None, example="0.1 um"
    )
    layer_thickness: PositiveLength | None = key("Thickness of the (outermost) layer.", "basic", default=None)
    connectivity: Literal[6, 18, 26] | None = key(
        "Neighbours that belong to one particle: 6 by faces, 18 also by edges, 26 also by corners.",
        "expert",
        default=None,
        example=26,
    )
    refinement: Literal["monotone_cubic", "linear", "exact"] | None = key(
        "Interpolation of the stress over depth.", "expert", default=None
    )
    criterion: Annotated[Criterion, LawKey("criterion")] | None = key(
        "Wear criterion or wear law.", "advanced", default=None
    )
    removal: Annotated[RemovalLaw, LawKey("removal")] | None = key(
        "Material that leaves with a yielded region.", "advanced", default=None
    )
    traction: Annotated[TractionLaw, LawKey("traction")] | None = key(
        "Traction on the surface: gross sliding, or partial slip.", "advanced", default=None
    )

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
"""Places of a variant's keys in the scene, if not in `wear`."""
