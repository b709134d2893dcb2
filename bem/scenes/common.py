"""The tables that scenes of several kinds share, as validated models. They hold numbers in SI units and do no work."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal, Self, TypeVar

from pydantic import BaseModel, Field, PrivateAttr, ValidationInfo, field_validator, model_validator
from pydantic_core import PydanticCustomError

from bem.errors import InputError
from bem.materials import CATALOGUE, Body, Layer, Material
from bem.quantities import si
from bem.reference_solutions.hertz import smooth_load
from bem.relaxation import PronySeries
from bem.scenes.asked import AskedAccuracy, AskedUncertainty
from bem.scenes.keys import key
from bem.scenes.paths import checksum_of, what_is_wrong_with
from bem.scenes.ranges import values_of_keys
from bem.scenes.table import Table, check_rising, exactly_one, one_for_both, one_of, problem
from bem.scenes.tables.marks import CrossHatchScene, FeedMarksScene
from bem.scenes.units import (
    Density,
    Force,
    HeatCapacity,
    Length,
    Pressure,
    Ratio,
    SurfaceTension,
    ThermalConductivity,
    Time,
)
from bem.stiffness import Stiffness
from bem.surfaces.processes import PROCESSES, Lay, ProcessName, statistics_beside

PositiveLength = Annotated[Length, Field(gt=0)]
PositivePressure = Annotated[Pressure, Field(gt=0)]
Cells = Annotated[int, Field(strict=True, ge=1, le=65536)]
Loads = Annotated[list[Annotated[Force, Field(gt=0)]], Field(min_length=1, max_length=64)]
HertzPressures = Annotated[list[PositivePressure], Field(min_length=1, max_length=64)]
Repetitions = Annotated[int, Field(strict=True, ge=1, le=1000)]
Axis = Literal["none", "x", "y", "both"]
BODIES = ("lower", "upper")
DEEP_RADII = 1.5
"""Deepest depth of stresses over the radius of the smooth contact, at least, where an accuracy is asked for."""


class Variant(Table):
    """A case that differs from the scene in what is given here; kinds say which keys."""

    name: Annotated[str, Field(min_length=1, max_length=60)] = key("Name of the case in tables and figures.", "basic")

    def changes(self) -> dict[str, Any]:
        """The keys that are given, with their values."""
        values = {key: getattr(self, key) for key in type(self).model_fields if key != "name"}
        return {key: value for key, value in values.items() if value is not None}


class CylinderTable(Table):
    """A cylinder along y on a flat; forces act on its full width."""

    radius: PositiveLength = key("Radius of the cylinder.", "basic", example="10 mm")
    width: PositiveLength = key(
        "Width of the contact: length of the cylinder along y, on which the load acts.", "basic", example="8 mm"
    )

    def load_under(self, maximum_pressure: float, contact_modulus: float) -> float:
        """Load on the width [N] under a maximum Hertz pressure [Pa]."""
        asked = {"contact_modulus": contact_modulus, "maximum_pressure": maximum_pressure}
        return smooth_load(radii=(self.radius, math.inf), **asked) * self.width


_Entry = TypeVar("_Entry")


def _named(name: Any, catalogue: Mapping[str, _Entry], wrong: str) -> _Entry:
    """The entry of a catalogue; a name that it does not have is `wrong`."""
    entry = catalogue.get(name) if isinstance(name, str) else None
    if entry is None:
        told = {"found": str(name)[:60], "names": sorted(catalogue)}
        raise PydanticCustomError("unknown_name", wrong, told)
    return entry


class RelaxationScene(Table):
    """Relaxation of the modulus over time, a Prony series: E(t) = E [1 - sum of shares (1 - exp(-t / times))]."""

    shares: Annotated[list[Annotated[Ratio, Field(gt=0, le=1)]], Field(min_length=1, max_length=64)] = key(
        "Parts of Young's modulus that relax; with a sum of one the body flows.", "basic", example=[0.5, 0.3]
    )
    times: Annotated[list[Annotated[Time, Field(gt=0)]], Field(min_length=1, max_length=64)] = key(
        "Relaxation times, one for each share.", "basic", example=["1 ms", "1 s"]
    )

    @model_validator(mode="after")
    def _a_series(self) -> RelaxationScene:
        try:
            self.build()
        except InputError as error:
            raise problem(
                "; ".join(message.removeprefix("PronySeries: ") for message in error.messages),
                "as many shares as times, and a sum of shares of at most one",
            ) from None
        return self

    def build(self) -> PronySeries:
        """Return the series that the scene describes."""
        return PronySeries(self.shares, self.times)


Direction = Annotated[list[Ratio], Field(min_length=3, max_length=3)]


class StiffnessScene(Table):
    """Stiffness of a crystal in its own axes, Voigt's order xx, yy, zz, yz, xz, xy; z is its axis of symmetry."""

    crystal: Literal["cubic", "hexagonal", "trigonal", "tetragonal", "orthotropic", "general"] = key(
        "Symmetry of the crystal, which says the constants that it has; hexagonal is transversely isotropic.",
        "basic",
        example="cubic",
    )
    c11: PositivePressure | None = key("Stiffness along the first axis.", "basic", default=None, example="165.7 GPa")
    c12: Pressure | None = key("Stiffness of the first two axes.", "basic", default=None, example="63.9 GPa")
    c13: Pressure | None = key("Stiffness of the first and third axis.", "advanced", default=None)
    c14: Pressure | None = key(
        "Stiffness of the first axis and shear yz, of trigonal crystals.", "advanced", default=None
    )
    c22: PositivePressure | None = key("Stiffness along the second axis.", "advanced", default=None)
    c23: Pressure | None = key("Stiffness of the second and third axis.", "advanced", default=None)
    c33: PositivePressure | None = key("Stiffness along the third axis.", "advanced", default=None)
    c44: PositivePressure | None = key("Stiffness in shear yz.", "basic", default=None, example="79.6 GPa")
    c55: PositivePressure | None = key("Stiffness in shear xz.", "advanced", default=None)
    c66: PositivePressure | None = key("Stiffness in shear xy.", "advanced", default=None)
    matrix: (
        Annotated[list[Annotated[list[Pressure], Field(min_length=6, max_length=6)]], Field(min_length=6)] | None
    ) = key(
        'All stiffnesses as six rows, of crystal = "general".',
        "expert",
        default=None,
        example=[
            ["166 GPa", "64 GPa", "64 GPa", 0, 0, 0],
            ["64 GPa", "166 GPa", "64 GPa", 0, 0, 0],
            ["64 GPa", "64 GPa", "166 GPa", 0, 0, 0],
            [0, 0, 0, "80 GPa", 0, 0],
            [0, 0, 0, 0, "80 GPa", 0],
            [0, 0, 0, 0, 0, "80 GPa"],
        ],
    )

    @model_validator(mode="after")
    def _its_constants(self) -> Self:
        try:
            self.build()
        except InputError as error:
            raise problem(
                "; ".join(message.removeprefix("Stiffness: ") for message in error.messages),
                "the constants of that crystal, and a positive definite stiffness",
            ) from None
        return self

    def build(self, **directions: Any) -> Stiffness:
        """Return the `bem.Stiffness` of these constants, with the directions of an orientation."""
        return Stiffness(**self.model_dump(), **directions)


class OrientationScene(Table):
    """Orientation of a crystal: directions in its own axes, of any length."""

    normal: Direction = key(
        "Direction from the lower body to the upper one; Miller indices of the surface of a cubic crystal.",
        "basic",
        default=[0.0, 0.0, 1.0],
        example=[1, 1, 1],
    )
    along_x: Direction | None = key(
        "Direction along x of the grid, whose part in the surface counts.",
        "basic",
        default=None,
        reason="the crystal's x, or its y where x is the normal",
        example=[1, -1, 0],
    )


class MaterialScene(Table):
    """Elastic solid: a name of the catalogue (`bem materials`), or constants of your own, which win over its own."""

    name: str = key("Name of the material in reports.", "advanced", default="unnamed", example="my steel")
    stiffness: StiffnessScene | None = key(
        "Stiffness of a crystal, instead of youngs_modulus and poissons_ratio; for the kind contact, without friction.",
        "advanced",
        default=None,
        reason="isotropic",
    )
    orientation: OrientationScene | None = key(
        "Directions of a crystal's surface and of x in it.",
        "advanced",
        default=None,
        reason="surface (001), x along [100]",
    )
    youngs_modulus: PositivePressure | None = key(
        "Young's modulus E.",
        "basic",
        default=None,
        reason="that of the stiffness, else it is needed",
        example="210 GPa",
    )
    poissons_ratio: Annotated[Ratio, Field(gt=-1, lt=0.5)] | None = key(
        "Poisson's ratio, above -1 and below 0.5.",
        "basic",
        default=None,
        reason="that of the stiffness, else it is needed",
        example=0.3,
    )
    hardness: PositivePressure | None = key(
        "Indentation hardness: the highest contact pressure of elastic-perfectly plastic models.",
        "advanced",
        default=None,
        reason="2.8 times the yield stress",
        example="7 GPa",
    )
    yield_stress: PositivePressure | None = key(
        "Yield stress, with which wear criteria compare the equivalent stress.",
        "advanced",
        default=None,
        reason="hardness / 2.8",
        example="2.5 GPa",
    )
    thermal_conductivity: Annotated[ThermalConductivity, Field(gt=0)] | None = key(
        "Thermal conductivity; only temperatures need it.", "advanced", default=None
    )
    density: Annotated[Density, Field(gt=0)] | None = key(
        "Density; only temperatures need it.", "advanced", default=None, example="7850 kg/m^3"
    )
    heat_capacity: Annotated[HeatCapacity, Field(gt=0)] | None = key(
        "Specific heat capacity; only temperatures need it.", "advanced", default=None
    )
    relaxation: RelaxationScene | None = key(
        "Relaxation of a viscoelastic body, whose modulus starts at youngs_modulus; for the kind contact.",
        "advanced",
        default=None,
        reason="elastic",
    )
    surface_tension: Annotated[SurfaceTension, Field(gt=0)] | None = key(
        "Surface tension of a soft solid, which flattens it below the length 2 gamma (1 - nu^2) / E; for the kind "
        "contact, without friction.",
        "advanced",
        default=None,
        reason="none",
        example="30 mN/m",
    )
    source: str = key("Source of the constants, repeated in the scene file of the run.", "expert", default="")

    @classmethod
    def short_forms(cls, table: dict[str, Any]) -> None:
        """Add the name of a material, and constants beside `catalogue`."""
        super().short_forms(table)
        table["properties"]["catalogue"] = {"enum": sorted(CATALOGUE)}
        table.pop("required", None)
        isotropic = {"required": ["youngs_modulus", "poissons_ratio"]}
        table["anyOf"] = [{"required": ["catalogue"]}, isotropic, {"required": ["stiffness"]}]
        whole = dict(table)
        table.clear()
        table |= {"anyOf": [{"enum": sorted(CATALOGUE)}, whole], "description": whole.get("description")}

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
        stiffness = entry.material.stiffness
        if stiffness is not None:
            constants["stiffness"] = {"crystal": stiffness.crystal, **stiffness.by_name}
            del constants["youngs_modulus"], constants["poissons_ratio"]
        if own:
            constants["source"] = f"{entry.source}. The scene itself gives {', '.join(sorted(own))}"
        if "hardness" in own and "yield_stress" not in own:
            constants["yield_stress"] = None  # follows the new hardness
        return constants | own

    @field_validator("youngs_modulus", "poissons_ratio")
    @classmethod
    def _one_elasticity(cls, value: float | None, info: ValidationInfo) -> float | None:
        if "stiffness" not in info.data:  # wrong itself
            return value
        crystal = info.data["stiffness"] is not None
        if value is None and not crystal:
            raise PydanticCustomError("missing", "missing")
        if value is not None and crystal:
            raise problem("it is given beside stiffness, from which it follows", "one of them")
        return value

    @model_validator(mode="after")
    def _a_crystal(self) -> Self:
        if self.stiffness is None:
            if self.orientation is not None:
                raise problem("orientation is given without stiffness", "orientation of a crystal")
            return self
        if self.relaxation is not None:
            raise problem("relaxation is given beside stiffness", "relaxation of an isotropic body")
        try:
            self._crystal()
        except InputError as error:
            raise problem(
                "; ".join(message.removeprefix("Stiffness: ") for message in error.messages),
                "stiffnesses of a stable crystal, and directions across each other",
            ) from None
        return self

    @model_validator(mode="after")
    def _tension_of_an_elastic_body(self) -> Self:
        if self.surface_tension is not None and (self.relaxation is not None or self.stiffness is not None):
            other = "relaxation" if self.relaxation is not None else "stiffness"
            raise problem(f"surface_tension is given beside {other}", "one of them")
        return self

    @property
    def special(self) -> str:
        """Property that only kind contact has, in words ("is a crystal"); empty for a material without such a one."""
        if self.stiffness is not None:
            return "is a crystal"
        return "has surface tension" if self.surface_tension is not None else ""

    def _crystal(self) -> Stiffness | None:
        if self.stiffness is None:
            return None
        return self.stiffness.build(**({} if self.orientation is None else self.orientation.model_dump()))

    def build(self) -> Material:
        """As `bem.Material`."""
        constants = self.model_dump(exclude={"source", "relaxation", "stiffness", "orientation"})
        relaxation = None if self.relaxation is None else self.relaxation.build()
        return Material(**constants, relaxation=relaxation, stiffness=self._crystal())


class LayerScene(Table):
    """Coating: a bonded layer of uniform thickness."""

    material: MaterialScene = key(
        "Material of the layer: a name of the catalogue (`bem materials`), or a table of constants.",
        "basic",
        example="dlc",
    )
    thickness: PositiveLength = key("Thickness of the layer.", "basic", example="2 um")
    residual_stress: Pressure = key(
        "Residual stress in the plane of the layer, compression negative; adds to stresses below the surface.",
        "advanced",
        default=0.0,
        reason="none",
        example="-2 GPa",
    )

    @model_validator(mode="after")
    def _elastic_in_time(self) -> LayerScene:
        if self.material.relaxation is not None:
            raise problem("the material of a layer relaxes", "relaxation of bodies without layers")
        if self.material.special:
            raise problem(f"the material of a layer {self.material.special}", "an isotropic layer without it")
        return self

    @model_validator(mode="after")
    def _elastic_without_a_contact(self) -> Self:
        strength = self.material.build().yield_stress
        if strength is not None and abs(self.residual_stress) >= strength:
            raise problem(
                f"residual_stress {si(self.residual_stress, 'Pa')} exceeds the yield stress of the layer, "
                f"{si(strength, 'Pa')}",
                "a smaller one, or a higher hardness or yield stress",
            )
        return self

    def build(self) -> Layer:
        """As `bem.Layer`."""
        return Layer(self.material.build(), self.thickness, self.residual_stress)


class SmoothSurface(Table):
    """Surface without roughness."""

    kind: Literal["smooth"] = key("Smooth surface, without roughness.", "basic", default="smooth")


class GeneratedSurface(Table):
    """Random rough surface with given statistics; `process` supplies every statistic that is not given."""

    kind: Literal["generated"] = key("Random rough surface with given statistics.", "basic", default="generated")
    process: ProcessName | None = key(
        "Manufacturing process, which supplies typical statistics (`bem surfaces`).",
        "basic",
        default=None,
        example="ground",
    )
    lay: Lay | None = key(
        "Direction of the ridges of a directional process: x along sliding, y across.",
        "advanced",
        default=None,
        reason="y, the usual lay across sliding",
    )
    rms_height: PositiveLength = key("Root-mean-square roughness Sq.", "basic", example="0.2 um")
    correlation_length: PositiveLength | None = key(
        "Autocorrelation length (decay to 1/e); geometric mean over both axes; or give hurst.",
        "basic",
        default=None,
        example="15 um",
    )
    elongation: Annotated[Ratio, Field(ge=0.01, le=100)] | None = key(
        "Ratio of the autocorrelation lengths along x and y (anisotropy).",
        "advanced",
        default=None,
        reason="1, or that of the process",
        example=3.0,
    )
    hurst: Annotated[Ratio, Field(gt=0, le=1)] | None = key(
        "Hurst exponent of a self-affine power spectrum; instead of correlation_length.",
        "advanced",
        default=None,
        example=0.8,
    )
    rolloff_wavelength: PositiveLength | None = key(
        "Roll-off wavelength: the self-affine power spectrum is flat above it.",
        "advanced",
        default=None,
        example="40 um",
    )
    cutoff_wavelength: PositiveLength | None = key(
        "Shortest wavelength of the roughness; several cells, or slopes depend on the grid.",
        "advanced",
        default=None,
        example="12 um",
    )
    skewness: Ratio = key("Skewness Ssk of the heights; 0 is Gaussian.", "advanced", default=0.0)
    kurtosis: Annotated[Ratio, Field(gt=1)] = key(
        "Kurtosis Sku of the heights; 3 is Gaussian, the least is 1 + Ssk^2.", "advanced", default=3.0
    )
    feed_marks: FeedMarksScene | None = key(
        'Turning marks added to the random roughness; {} with process "turned" takes typical ones.',
        "advanced",
        default=None,
    )
    cross_hatch: CrossHatchScene | None = key(
        'Honing grooves cut into the random roughness; {} with process "honed" takes typical ones.',
        "advanced",
        default=None,
    )
    seed: Annotated[int, Field(strict=True, ge=0, lt=2**63)] | None = key(
        "Seed of this surface's random numbers.",
        "expert",
        default=None,
        reason="derived from the seed of the scene",
        example=7,
    )
    drawn_on: tuple[Cells, Cells] | None = key(
        "Number of cells along x and y on which the surface is generated; all grids as fine then see the same surface.",
        "expert",
        default=None,
        reason="the cells of the grid",
        example=256,
    )
    source: str = key("Source of the statistics, repeated in the scene file of the run.", "expert", default="")

    @classmethod
    def short_forms(cls, table: dict[str, Any]) -> None:
        """Add a `process`, which supplies the statistics."""
        super().short_forms(table)
        table["anyOf"] = [{"required": ["process"]}, {"required": table.pop("required", [])}]

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
    """Measured surface from an instrument's file.

    In this order: read, scan lines levelled, despiked, levelled, missing points filled, cropped to lengths around
    `centre`, filtered, resampled to the grid, levelled again, made periodic (mirrored or seams closed), scaled to
    `rms_height`. A run's scene has the file's checksum: one that has changed since is refused.
    """

    kind: Literal["measured"] = key("Measured surface, from the file of an instrument.", "basic", default="measured")
    path: str = key(
        "File of the measured heights, relative to the scene file; `bem surface describe FILE` shows it.",
        "basic",
        example="my-surface.sur",
    )
    detrend: Literal["plane", "curvature", "none"] = key(
        "Form removal: subtract the mean plane, a second-order surface (curvature), or nothing.",
        "advanced",
        default="plane",
        reason="the plane, because tilt is not roughness",
    )
    despike: Annotated[Ratio, Field(ge=3)] | None = key(
        "Remove outliers that stand out from their neighbours by this many standard deviations (6: spikes only).",
        "advanced",
        default=None,
        example=6.0,
    )
    level_lines: bool = key(
        "Remove the offset of each scan line (along x), as scanning instruments leave it.",
        "advanced",
        default=False,
        strict=True,
    )
    fill: bool = key(
        "Fill missing points by harmonic interpolation; false refuses maps with missing points.",
        "advanced",
        default=True,
        strict=True,
    )
    channel: str | Annotated[int, Field(strict=True, ge=0)] | None = key(
        "Name or number of the data channel, for files that hold several.", "advanced", default=None, example="Height"
    )
    spacing: tuple[PositiveLength, PositiveLength] | None = key(
        "Pixel size along x and y, for files that do not state it or state it wrongly.",
        "advanced",
        default=None,
        example="0.5 um",
    )
    height_unit: str | None = key(
        'Unit of the heights, such as "um", for files that do not state it.', "advanced", default=None, example="um"
    )
    crop: tuple[PositiveLength, PositiveLength] | None = key(
        "Lengths along x and y of the part of the map that is used.",
        "advanced",
        default=None,
        reason="the whole map",
        example="200 um",
    )
    centre: tuple[Length, Length] = key(
        "Centre of that part, measured from the middle of the map.", "advanced", default=(0.0, 0.0)
    )
    low_pass: PositiveLength | None = key(
        "Low-pass filter: removes shorter wavelengths than this.", "advanced", default=None, example="2.5 um"
    )
    high_pass: PositiveLength | None = key(
        "High-pass filter: removes longer wavelengths than this.", "advanced", default=None, example="80 um"
    )
    mirror: Axis = key(
        "Mirror the map along these axes to make it periodic.",
        "advanced",
        default="none",
        reason="none: edge steps of a periodic map are removed by the periodic-plus-smooth decomposition",
    )
    rms_height: PositiveLength | None = key(
        "Scales the measured heights to this root-mean-square roughness Sq.", "advanced", default=None, example="0.2 um"
    )
    sha256: Annotated[str, Field(pattern="^[0-9a-f]{64}$")] | None = key(
        "Checksum of the file, written by a run; a changed file is then refused.", "expert", default=None
    )

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
    """Parts of both bodies: a stack of layers and a surface."""

    layer: LayerScene | None = key("Coating: one bonded layer of uniform thickness.", "advanced", default=None)
    layers: list[LayerScene] = key(
        "Stack of coatings, outermost first, each with material and thickness; instead of layer.",
        "advanced",
        default=[],
    )
    surface: SurfaceScene = key(
        "Roughness of the body: generated or measured; smooth without this table.", "basic", default=SmoothSurface()
    )

    @classmethod
    def short_forms(cls, table: dict[str, Any]) -> None:
        """Add the word "smooth" for a surface."""
        super().short_forms(table)
        table["properties"]["surface"] = {"anyOf": [{"const": "smooth"}, table["properties"]["surface"]]}

    @field_validator("surface", mode="before")
    @classmethod
    def _kind_by_default(cls, data: Any) -> Any:
        if isinstance(data, dict):
            for key_of_one, kind in (("process", "generated"), ("path", "measured")):
                if key_of_one in data:
                    return {"kind": kind, **data}
        return {"kind": "smooth"} if data == "smooth" else data

    @model_validator(mode="after")
    def _one_stack(self) -> Self:
        if self.layer is not None and self.layers:
            raise problem("layer and layers are both given", "layer for one, or layers for a stack, outermost first")
        material: MaterialScene | None = getattr(self, "material", None)
        if self.stack and material is not None and material.special:
            raise problem(f"layers on a body whose material {material.special}", "a bare body, or another material")
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
    """One of the two bodies: material, coating and roughness."""

    material: MaterialScene = key(
        "Material: a name of the catalogue (`bem materials`), or a table of constants.", "basic"
    )

    def build(self) -> Body:
        """As `bem.Body`."""
        return self._on(self.material)


class UpperBodyScene(_LayeredScene):
    """The upper body: material, coating and roughness; without a material it is rigid."""

    material: MaterialScene | None = key(
        "Material: a name of the catalogue (`bem materials`), or constants; without it the body is rigid.",
        "basic",
        default=None,
    )

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

    shape: tuple[Cells, Cells] | None = key(
        "Number of mesh cells along x and y; one number stands for both.", "basic", default=None, example=256
    )
    spacing: tuple[PositiveLength, PositiveLength] | None = key(
        "Cell size along x and y; instead of lengths. The shortest roughness wavelength needs several cells.",
        "basic",
        default=None,
        example="1 um",
    )
    lengths: tuple[PositiveLength, PositiveLength] | None = key(
        "Side lengths of the grid along x and y; instead of spacing.", "basic", default=None, example="256 um"
    )
    periodic: tuple[Annotated[bool, Field(strict=True)], Annotated[bool, Field(strict=True)]] = key(
        "Periodic continuation along x and y; true for a nominally flat contact.",
        "advanced",
        default=(False, False),
        reason="free edges, for a contact inside the grid",
    )

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

    periodic: tuple[Annotated[bool, Field(strict=True)], Annotated[bool, Field(strict=True)]] = key(
        "Periodic continuation along x and y; [true, true]: a patch of the roughness that repeats under the contact.",
        "advanced",
        default=(False, True),
        reason="a line contact continues along y, the patch under a ball ends",
    )


class OutputsScene(Table):
    """Results besides the standard ones: error estimates."""

    errors: bool = key(
        "Error estimate of every result, from a second solution on a coarser grid or mesh.",
        "advanced",
        default=True,
        strict=True,
    )


def relaxing_bodies(scene: Table) -> list[str]:
    """Return the names of bodies of a scene whose material relaxes."""
    bodies = {name: getattr(scene, name) for name in type(scene).model_fields}
    return [
        name
        for name, body in bodies.items()
        if isinstance(body, BodyScene | UpperBodyScene)
        and body.material is not None
        and body.material.relaxation is not None
    ]


def special_bodies(scene: Table) -> dict[str, str]:
    """Return the bodies of a scene that are known under pressure alone, with what they are: crystals, and those whose
    surface is under tension."""
    bodies = {name: getattr(scene, name) for name in type(scene).model_fields}
    materials = {
        name: body.material
        for name, body in bodies.items()
        if isinstance(body, BodyScene | UpperBodyScene) and body.material is not None
    }
    return {name: special for name, material in materials.items() if (special := material.special)}


def refuse_relaxation(scene: Table, allowed: str) -> None:
    """Refuse bodies that relax."""
    for name in relaxing_bodies(scene):
        raise problem(f"{name}.material relaxes", allowed)


def _rough_surfaces(value: Any) -> Iterator[GeneratedSurface | MeasuredSurface]:
    """Yield the tables of rough surfaces inside a value of a scene."""
    if isinstance(value, GeneratedSurface | MeasuredSurface):
        yield value
    elif isinstance(value, BaseModel):
        for name in type(value).model_fields:
            yield from _rough_surfaces(getattr(value, name))
    elif isinstance(value, list | tuple):
        for one in value:
            yield from _rough_surfaces(one)


class SceneModel(Table):
    """Keys of every scene. `redoes` names the figure or table of the thesis that the scene repeats.

    `repetitions` runs every case so often, with seeds of its own; means and spreads of all figures are then reported.
    `over` holds dotted keys with several values each, of which all combinations are run: lists, or ranges as of
    `bem sweep --over`. `accuracy` is the relative error that the headline figures, or those that it names, may have:
    what the scene resolves is then refined until the error bars say so. `uncertain` has standard deviations of inputs.
    """

    kind: str = key("Kind of computation.", "basic")
    name: Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9_.-]{0,63}$")] = key(
        "Name of the run's folder.", "advanced", default="scene", reason="the name of the file"
    )
    description: str = key("Title of the report.", "advanced", default="")
    redoes: str = key("Figure or table of the literature that the scene reproduces.", "expert", default="")
    seed: Annotated[int, Field(strict=True, ge=0, lt=2**63)] = key(
        "Seed of all random numbers; the same seed gives the same surfaces.", "advanced", default=1
    )
    repetitions: Repetitions | None = key(
        "Number of runs with other random surfaces, for means and standard deviations.",
        "advanced",
        default=None,
        example=5,
    )
    over: dict[str, list[Any]] | None = key(
        "Parameter study: dotted keys with lists of values, of which all combinations are run.",
        "advanced",
        default=None,
        example={"seed": [1, 2, 3]},
    )
    accuracy: AskedAccuracy | None = key(
        'Target accuracy, such as "1 %": grid, mesh and steps are refined until the error estimates meet it.',
        "advanced",
        default=None,
        example="1 %",
    )
    uncertain: AskedUncertainty | None = key(
        "Standard deviations of numbers of the scene, by dotted keys: figures get a second error, by their inputs.",
        "advanced",
        default=None,
        example={"contact.load": "2 %"},
    )
    viscoelastic: ClassVar[bool] = False
    """Whether the kind knows bodies that relax."""
    special_surfaces: ClassVar[bool] = False
    """Whether the kind knows crystals and surface tension."""
    _source: dict[str, Any] | None = PrivateAttr(default=None)

    @field_validator("over", mode="before")
    @classmethod
    def _values_of_keys(cls, data: Any) -> Any:
        return None if data is None else values_of_keys(data)

    @property
    def source(self) -> dict[str, Any] | None:
        """The table as it was written, of a scene with `over`: what keys change is changed there."""
        return self._source

    @model_validator(mode="after")
    def _repetitions_of_generated_surfaces(self) -> Self:
        kinds = {type(surface) for surface in _rough_surfaces(self)}
        if (self.repetitions or 1) > 1 and kinds == {MeasuredSurface}:
            allowed = (
                "1, or a generated surface; take other maps or parts of maps instead, such as --over "
                "lower.surface.path=spot1.al3d,spot2.al3d (or crop and centre of the surface)"
            )
            raise problem("repetitions: all surfaces are measured, so that all repetitions would be equal", allowed)
        return self

    @model_validator(mode="after")
    def _relaxation_where_time_is(self) -> Self:
        if not self.viscoelastic:
            refuse_relaxation(self, "an elastic material, or kind contact with contact.times or a speed")
        return self

    @model_validator(mode="after")
    def _special_bodies_under_pressure(self) -> Self:
        for name, special in special_bodies(self).items() if not self.special_surfaces else ():
            allowed = "an isotropic material without surface tension, or kind contact"
            raise problem(f"{name}.material {special}", allowed)
        return self

    def cited_methods(self) -> Iterator[Mapping[str, str]]:
        """Yield the sources of methods that this scene uses and others of its kind do not: keys and methods.

        The keys are of `bem.references`; `bem.scenes.sources` has the tables.
        """
        yield from ()

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
