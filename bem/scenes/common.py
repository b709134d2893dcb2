"""The tables that scenes of several kinds share, as validated models. They hold numbers in SI units and do no work."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any, Literal, Self, TypeVar

from pydantic import Field, PrivateAttr, field_validator, model_validator
from pydantic_core import PydanticCustomError

from bem.materials import CATALOGUE, Body, Layer, Material
from bem.scenes.asked import AskedAccuracy
from bem.scenes.paths import checksum_of, what_is_wrong_with
from bem.scenes.ranges import values_of_keys
from bem.scenes.table import Table, check_rising, exactly_one, one_for_both, one_of, problem
from bem.scenes.tables.marks import CrossHatchScene, FeedMarksScene
from bem.scenes.units import Density, Force, HeatCapacity, Length, Pressure, Ratio, ThermalConductivity
from bem.surfaces.processes import PROCESSES, Lay, ProcessName, statistics_beside

PositiveLength = Annotated[Length, Field(gt=0)]
PositivePressure = Annotated[Pressure, Field(gt=0)]
Cells = Annotated[int, Field(strict=True, ge=1, le=65536)]
Loads = Annotated[list[Annotated[Force, Field(gt=0)]], Field(min_length=1, max_length=64)]
Repetitions = Annotated[int, Field(strict=True, ge=1, le=1000)]
Axis = Literal["none", "x", "y", "both"]
BODIES = ("lower", "upper")


class Variant(Table):
    """A case that differs from the scene in what is given here; kinds say which keys."""

    name: Annotated[str, Field(min_length=1, max_length=60)]

    def changes(self) -> dict[str, Any]:
        """The keys that are given, with their values."""
        values = {key: getattr(self, key) for key in type(self).model_fields if key != "name"}
        return {key: value for key, value in values.items() if value is not None}


class CylinderTable(Table):
    """A cylinder along y on a flat; forces are on its full width."""

    radius: PositiveLength
    width: PositiveLength


_Entry = TypeVar("_Entry")


def _named(name: Any, catalogue: Mapping[str, _Entry], wrong: str) -> _Entry:
    """The entry of a catalogue; a name that it does not have is `wrong`."""
    entry = catalogue.get(name) if isinstance(name, str) else None
    if entry is None:
        told = {"found": str(name)[:60], "names": sorted(catalogue)}
        raise PydanticCustomError("unknown_name", wrong, told)
    return entry


class MaterialScene(Table):
    """`material = "steel-52100"` from the catalogue, or constants of one's own; with both, the constants win."""

    name: str = "unnamed"
    youngs_modulus: PositivePressure
    poissons_ratio: Annotated[Ratio, Field(gt=-1, lt=0.5)]
    hardness: PositivePressure | None = None
    yield_stress: PositivePressure | None = None
    thermal_conductivity: Annotated[ThermalConductivity, Field(gt=0)] | None = None
    density: Annotated[Density, Field(gt=0)] | None = None
    heat_capacity: Annotated[HeatCapacity, Field(gt=0)] | None = None
    source: str = ""

    @model_validator(mode="before")
    @classmethod
    def _from_catalogue(cls, data: Any) -> Any:
        if isinstance(data, str):
            data = {"catalogue": data}
        if not isinstance(data, dict) or "catalogue" not in data:
            return data
        own = {key: value for key, value in data.items() if key != "catalogue"}
        entry = _named(data["catalogue"], CATALOGUE, "is not in the catalogue of materials")
        constants = asdict(entry.material) | {"source": entry.source}
        if own:
            constants["source"] = f"{entry.source}; changed in the scene: {', '.join(sorted(own))}"
        if "hardness" in own and "yield_stress" not in own:
            constants["yield_stress"] = None  # follows the new hardness
        return constants | own

    def build(self) -> Material:
        """As `bem.Material`."""
        return Material(**self.model_dump(exclude={"source"}))


class LayerScene(Table):
    """A bonded layer."""

    material: MaterialScene
    thickness: PositiveLength

    def build(self) -> Layer:
        """As `bem.Layer`."""
        return Layer(self.material.build(), self.thickness)


class SmoothSurface(Table):
    """No roughness."""

    kind: Literal["smooth"] = "smooth"


class GeneratedSurface(Table):
    """A random surface of prescribed statistics; see `bem.generate_surface`.

    `elongation` is the ratio of the correlation lengths along x and y, of which `correlation_length` is then the
    geometric mean. `drawn_on` draws the surface on so many cells whatever the grid has, and carries its waves to the
    grid: the same surface on all grids that are as fine. `process` gives every statistic that is not given beside it;
    `lay` is the direction of its ridges. `feed_marks` or `cross_hatch` are added, and the statistics are then those of
    what lies between them.
    """

    kind: Literal["generated"] = "generated"
    process: ProcessName | None = None
    lay: Lay | None = None
    rms_height: PositiveLength
    correlation_length: PositiveLength | None = None
    elongation: Annotated[Ratio, Field(ge=0.01, le=100)] | None = None
    hurst: Annotated[Ratio, Field(gt=0, le=1)] | None = None
    rolloff_wavelength: PositiveLength | None = None
    cutoff_wavelength: PositiveLength | None = None
    skewness: Ratio = 0.0
    kurtosis: Annotated[Ratio, Field(gt=1)] = 3.0
    feed_marks: FeedMarksScene | None = None
    cross_hatch: CrossHatchScene | None = None
    seed: Annotated[int, Field(strict=True, ge=0, lt=2**63)] | None = None
    drawn_on: tuple[Cells, Cells] | None = None
    source: str = ""

    _pairs = field_validator("drawn_on", mode="before")(one_for_both)

    @model_validator(mode="before")
    @classmethod
    def _of_process(cls, data: Any) -> Any:
        if not isinstance(data, dict) or data.get("process") is None:
            return data
        process = _named(data["process"], PROCESSES, "is not a manufacturing process of the catalogue")
        said = str(data.get("source", ""))
        other = next((name for name, one in PROCESSES.items() if said.startswith(one.title)), data["process"])
        if other != data["process"]:  # a run's scene has all statistics, which would win
            raise problem(
                f"process {data['process']} beside statistics of {other}", "process without them, or without source"
            )
        wrong = process.wrong_marks(data)
        if wrong is not None:
            raise problem(*wrong)
        return statistics_beside(process, data)

    @model_validator(mode="after")
    def _one_lay(self) -> GeneratedSurface:
        marked = self.feed_marks is not None or self.cross_hatch is not None
        if self.feed_marks is not None and self.cross_hatch is not None:
            raise problem("feed_marks and cross_hatch are both given", "one of them")
        if self.lay is None or (marked and self.elongation is None):
            return self
        if self.process is None and not marked:
            raise problem("lay without process or marks", "one of them with lay; elongation where there is none")
        if self.elongation is None:
            directional = [name for name, one in PROCESSES.items() if one.directional]
            raise problem(f"{self.process} has no lay", f"none, or one of {', '.join(directional)}")
        if self.elongation > 1 if self.lay == "y" else self.elongation < 1:
            raise problem(f"lay {self.lay} with elongation {self.elongation:g}, ridges the other way", "one of the two")
        return self

    @model_validator(mode="after")
    def _one_spectrum(self) -> GeneratedSurface:
        exactly_one(self, "correlation_length", "hurst")
        if self.elongation is not None and self.correlation_length is None:
            raise problem("elongation without correlation_length", "both, or neither")
        if self.kurtosis < 1 + self.skewness * self.skewness:  # a power of a float can overflow
            raise problem(
                f"kurtosis {self.kurtosis:g} with skewness {self.skewness:g} is a pair that no distribution has",
                "kurtosis >= 1 + skewness^2",
            )
        return self

    @property
    def correlation_lengths(self) -> tuple[float, float] | None:
        """Along x and y [m]; None of a self-affine surface."""
        if self.correlation_length is None:
            return None
        root = math.sqrt(self.elongation or 1.0)
        return self.correlation_length * root, self.correlation_length / root


class MeasuredSurface(Table):
    """A surface from an instrument's file; see `bem.read_surface`. Paths are relative to the scene file.

    In this order: read, despiked, levelled, missing points filled, cropped to lengths around `centre`, filtered,
    resampled to the grid, levelled again, made periodic (mirrored or seams closed), scaled to `rms_height`. A run's
    scene has the file's checksum: one that has changed since is refused.
    """

    kind: Literal["measured"] = "measured"
    path: str
    detrend: Literal["plane", "curvature", "none"] = "plane"
    despike: Annotated[Ratio, Field(ge=3)] | None = None
    fill: bool = Field(default=True, strict=True)
    channel: str | Annotated[int, Field(strict=True, ge=0)] | None = None
    spacing: tuple[PositiveLength, PositiveLength] | None = None
    height_unit: str | None = None
    crop: tuple[PositiveLength, PositiveLength] | None = None
    centre: tuple[Length, Length] = (0.0, 0.0)
    low_pass: PositiveLength | None = None
    high_pass: PositiveLength | None = None
    mirror: Axis = "none"
    rms_height: PositiveLength | None = None
    sha256: Annotated[str, Field(pattern="^[0-9a-f]{64}$")] | None = None

    _pairs = field_validator("spacing", "crop", mode="before")(one_for_both)

    @field_validator("path")
    @classmethod
    def _readable(cls, path: str) -> str:
        if (wrong := what_is_wrong_with(path)) is not None:
            raise problem(*wrong)
        return path

    @model_validator(mode="after")
    def _unchanged(self) -> Self:
        if self.sha256 is not None and self.sha256 != (found := checksum_of(self.path)):
            raise problem(
                f"{Path(self.path).name} has changed since: its SHA-256 is {found[:12]}..., not {self.sha256[:12]}...",
                "the file as it was, or no sha256",
            )
        return self


SurfaceScene = Annotated[SmoothSurface | GeneratedSurface | MeasuredSurface, Field(discriminator="kind")]


class _LayeredScene(Table):
    """What both bodies share: a stack of layers and a surface."""

    layer: LayerScene | None = None
    layers: list[LayerScene] = Field(default=[])
    surface: SurfaceScene = SmoothSurface()

    @field_validator("surface", mode="before")
    @classmethod
    def _kind_by_default(cls, data: Any) -> Any:
        if isinstance(data, dict) and "process" in data:
            return {"kind": "generated", **data}
        return {"kind": "smooth"} if data == "smooth" else data

    @model_validator(mode="after")
    def _one_stack(self) -> Self:
        if self.layer is not None and self.layers:
            raise problem("layer and layers are both given", "layer for one, or layers for a stack, outermost first")
        return self

    @property
    def stack(self) -> list[LayerScene]:
        """All layers, outermost first."""
        return self.layers if self.layer is None else [self.layer]

    def with_outermost(self, thickness: float) -> Self:
        """The same body with another thickness of its outermost layer [m]."""
        first, *others = self.stack
        first = first.model_copy(update={"thickness": thickness})
        return self.model_copy(update={"layers": [first, *others]} if self.layers else {"layer": first})

    def _on(self, material: MaterialScene) -> Body:
        return Body(material.build(), layers=[layer.build() for layer in self.stack])


class BodyScene(_LayeredScene):
    """One of the two bodies: what it is made of and what its surface looks like."""

    material: MaterialScene

    def build(self) -> Body:
        """As `bem.Body`."""
        return self._on(self.material)


class UpperBodyScene(_LayeredScene):
    """The upper body; without a material it is rigid."""

    material: MaterialScene | None = None

    @model_validator(mode="after")
    def _layer_needs_material(self) -> UpperBodyScene:
        if self.stack and self.material is None:
            raise problem(
                "a layer without a material below it", "material with layer, material alone, or neither (rigid)"
            )
        return self

    def build(self) -> Body | None:
        """As `bem.Body`; None is rigid."""
        return None if self.material is None else self._on(self.material)


class GridScene(Table):
    """Cells along x (sliding) and y; one value stands for both axes.

    Without `shape` and `spacing` (or `lengths`) those of the measured surfaces are taken: the finer spacing, the
    common area; where an accuracy is asked for, shape and, of a round contact, lengths are chosen.
    """

    shape: tuple[Cells, Cells] | None = None
    spacing: tuple[PositiveLength, PositiveLength] | None = None
    lengths: tuple[PositiveLength, PositiveLength] | None = None
    periodic: tuple[Annotated[bool, Field(strict=True)], Annotated[bool, Field(strict=True)]] = (False, False)

    _pairs = field_validator("shape", "spacing", "lengths", "periodic", mode="before")(one_for_both)

    @model_validator(mode="after")
    def _one_size(self) -> GridScene:
        if self.spacing is not None and self.lengths is not None:
            raise problem("spacing and lengths are both given", "one of them")
        return self


class LineGridScene(GridScene):
    """Cells along x (sliding) and y of a slice of a line contact, which goes on along y where `periodic` is not given.

    Without `shape` and `spacing` (or `lengths`) those of the measured surfaces are taken: the finer spacing, the
    common area.
    """

    periodic: tuple[Annotated[bool, Field(strict=True)], Annotated[bool, Field(strict=True)]] = (False, True)


class OutputsScene(Table):
    """What is wanted besides the figures: their error bars."""

    errors: bool = Field(default=True, strict=True)


class SceneModel(Table):
    """What every scene has. `redoes` says which figure or table of the thesis, where it is one.

    `repetitions` runs every case so often, with seeds of its own; means and spreads of all figures are then reported.
    `over` holds dotted keys with several values each, of which all combinations are run: lists, or ranges as of
    `bem sweep --over`. `accuracy` is the relative error that the headline figures, or those that it names, may have:
    what the scene resolves is then refined until the error bars say so.
    """

    kind: str
    name: Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9_.-]{0,63}$")] = "scene"
    description: str = ""
    redoes: str = ""
    seed: Annotated[int, Field(strict=True, ge=0, lt=2**63)] = 1
    repetitions: Repetitions | None = None
    over: dict[str, list[Any]] | None = None
    accuracy: AskedAccuracy | None = None
    _source: dict[str, Any] | None = PrivateAttr(default=None)

    @field_validator("over", mode="before")
    @classmethod
    def _values_of_keys(cls, data: Any) -> Any:
        return None if data is None else values_of_keys(data)

    @property
    def source(self) -> dict[str, Any] | None:
        """The table as it was written, of a scene with `over`: what keys change is changed there."""
        return self._source

    def with_source(self, table: dict[str, Any]) -> Self:
        """The scene with the table that it was made from."""
        made = self.model_copy()
        made._source = table
        return made


__all__ = [
    "Axis",
    "BodyScene",
    "Cells",
    "CylinderTable",
    "Force",
    "GeneratedSurface",
    "GridScene",
    "LayerScene",
    "Loads",
    "MaterialScene",
    "MeasuredSurface",
    "PositiveLength",
    "PositivePressure",
    "Repetitions",
    "SceneModel",
    "SmoothSurface",
    "SurfaceScene",
    "Table",
    "UpperBodyScene",
    "Variant",
    "check_rising",
    "exactly_one",
    "one_for_both",
    "one_of",
    "problem",
]


def check_smooth(scene: Any, allowed: str) -> None:
    """Refuse rough bodies of a scene whose film knows none."""
    if scene.lower.surface.kind != "smooth" or scene.upper.surface.kind != "smooth":
        raise problem("a rough surface", allowed)
