"""From the tables of a scene to grids, bodies and heights."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from bem.errors import InputError
from bem.grid import FloatArray, Grid
from bem.laws import Law
from bem.materials import Body, contact_modulus, softer_hardness
from bem.scenes.common import GeneratedSurface, GridScene, MeasuredSurface, SceneModel, SmoothSurface
from bem.scenes.maps import KEPT, map_on, map_size
from bem.scenes.tables.shape import ShapeScene

if TYPE_CHECKING:
    from bem.convolution import DisplacementOperator
    from bem.scenes.context import Context

Scene = TypeVar("Scene", bound=SceneModel)
_NO_SHAPE = (
    "grid: lengths are given without shape; allowed: shape with spacing, shape with lengths, none of them, or an "
    'accuracy that is asked for, such as accuracy = "1 %"'
)
_NO_SIZE = (
    "grid: no size is given; allowed: shape with spacing or lengths, a measured surface to take them from, or an "
    'accuracy to choose them by, such as accuracy = "1 %"'
)
AnySurface = SmoothSurface | GeneratedSurface | MeasuredSurface


def grid_of(scene: GridScene) -> Grid:
    """The grid of a resolved table."""
    if scene.shape is None or (scene.spacing is None and scene.lengths is None):
        raise InputError(_NO_SIZE)
    if scene.spacing is not None:
        return Grid(scene.shape, scene.spacing, periodic=scene.periodic)
    assert scene.lengths is not None
    (nx, ny), (length_x, length_y) = scene.shape, scene.lengths
    return Grid(scene.shape, (length_x / nx, length_y / ny), periodic=scene.periodic)


def resolved_grid(scene: GridScene, *surfaces: AnySurface) -> GridScene:
    """The table with shape and spacing filled in, from the measured surfaces where they are left out.

    The spacing is then the finer of theirs, the area the one they have in common: never more cells than the finer map.

    Raises
    ------
    InputError : nothing to take them from.
    SurfaceFileError : a measured file that cannot be read.
    """
    if scene.shape is not None and (scene.spacing is not None or scene.lengths is not None):
        grid = grid_of(scene)
        return scene.model_copy(update={"spacing": grid.spacing, "lengths": None})
    if scene.lengths is not None and scene.shape is None:
        raise InputError(_NO_SHAPE)
    sizes = [map_size(surface) for surface in surfaces if isinstance(surface, MeasuredSurface)]
    if not sizes:
        raise InputError(_NO_SIZE)
    spacing = scene.spacing or (min(d[0] for _, d in sizes), min(d[1] for _, d in sizes))
    common = [min(shape[axis] * d[axis] for shape, d in sizes) for axis in (0, 1)]
    shape = scene.shape or (_whole(common[0] / spacing[0]), _whole(common[1] / spacing[1]))
    return scene.model_copy(update={"shape": shape, "spacing": spacing, "lengths": None})


def _whole(cells: float) -> int:
    """Whole cells in a length that may miss one by round-off."""
    return max(1, math.floor(cells * (1 + 1e-9)))


def heights_of(
    surface: AnySurface, grid: Grid, seed: int, note: Callable[[str], None] = lambda text: None
) -> FloatArray:
    """Heights on the grid [m], positive out of the body, zero mean; `note` is told what was done to measured data."""
    if isinstance(surface, SmoothSurface):
        return np.zeros(grid.shape)
    if isinstance(surface, GeneratedSurface):
        return _generated(surface, grid, seed)
    on_grid = map_on(surface, grid)
    for text in on_grid.remarks:
        note(text)
    return on_grid.heights if on_grid.heights.flags.writeable else on_grid.heights.copy()


def shape_of(scene: ShapeScene, grid: Grid) -> FloatArray:
    """Gap of the upper body's smooth shape over the plane [m], (nx, ny), new; spheres and cylinders as parabolas,
    profiles over the tangent plane of their contact point, or along the rail."""
    x, y = grid.x[:, None], grid.y[None, :]
    if scene.kind == "flat":
        gap = np.zeros(grid.shape)
    elif scene.kind == "sinusoid":
        assert scene.amplitude is not None
        assert scene.wavelength is not None
        gap = scene.amplitude * (1 - np.cos(2 * np.pi * x / scene.wavelength)) + 0 * y
    elif scene.kind == "profiles":
        from bem.profiles.gap import gap_along_rail, gap_over_tangent_plane

        placed = scene.placed()
        gap_of = gap_along_rail if scene.conforming else gap_over_tangent_plane
        gap = gap_of(placed, placed.contact_points[0], grid)
    else:
        assert scene.radius is not None
        curvature = {"sphere": 1 / scene.radius, "cylinder": 0.0, "ellipsoid": 1 / (scene.radius_y or math.inf)}[
            scene.kind
        ]
        gap = x**2 / (2 * scene.radius) + curvature * y**2 / 2
    return gap if gap.shape == grid.shape else np.array(np.broadcast_to(gap, grid.shape), order="C")


def both_heights(scene: Any, grid: Grid, context: Context) -> tuple[FloatArray, FloatArray]:
    """Heights of the lower and the upper body of a scene on a grid [m], as `heights_of` gives them."""
    with context.timer("surfaces"):
        lower, upper = (
            heights_of(getattr(scene, name).surface, grid, context.seed(name), context.note)
            for name in ("lower", "upper")
        )
    return lower, upper


def undeformed_gap(scene: Any, grid: Grid, lower: FloatArray, upper: FloatArray) -> FloatArray:
    """Gap between rough surfaces of a scene's shape before deformation [m], zero at first touch."""
    gap = shape_of(scene.shape, grid)
    gap -= lower
    gap -= upper
    if lower.any() or upper.any():
        gap -= gap.min()  # approach counts from first touch; smooth shapes touch at zero already
    return gap


def bodies_of(scene: Any) -> Body | tuple[Body, Body]:
    """A scene's two bodies as solvers take them: the lower one alone where the upper one is rigid."""
    lower, upper = scene.lower.build(), scene.upper.build()
    return lower if upper is None else (lower, upper)


def modulus_of(scene: Any) -> float:
    """Contact modulus of the substrates of a scene's two bodies [Pa]."""
    lower, upper = scene.lower.build(), scene.upper.build()
    return contact_modulus(lower.material, None if upper is None else upper.material)


def operator_of(scene: Any, grid: Grid, friction: float = 0.0) -> DisplacementOperator:
    """Displacement of a scene's two bodies together under pressure, and under traction friction x pressure."""
    from bem.convolution import displacement_operator

    return displacement_operator(grid, bodies_of(scene), friction=friction)


def with_grid(scene: Scene) -> Scene:
    """The scene with its grid filled in where measured surfaces decide it; see `resolved_grid`."""
    table: Any = scene
    return scene.model_copy(update={"grid": resolved_grid(table.grid, table.lower.surface, table.upper.surface)})


def with_hardness(scene: Scene, table: str = "contact", *, needed: bool) -> Scene:
    """The scene with the softer body's hardness where its table of the contact gives none.

    Raises
    ------
    InputError : neither body has one, and it is needed.
    """
    given: Any = getattr(scene, table)
    if given.hardness is not None:
        return scene
    hardness = softer_hardness(scene.lower.build(), scene.upper.build())  # type: ignore[attr-defined]
    if hardness is None and needed:
        raise InputError(
            f"{table}.hardness: missing for a capped contact, and neither material has a hardness or a "
            f"yield stress; allowed: {table}.hardness, or one of them in a material"
        )
    return scene.model_copy(update={table: given.model_copy(update={"hardness": hardness})})


def show_layers(body: Body) -> str:
    """The layers of a coated body for a reader, outermost first."""
    if len(body.layers) == 1:
        return "a layer"
    stack = ", ".join(f"{layer.material.name} {1e6 * layer.thickness:.4g} um" for layer in body.layers)
    return f"{len(body.layers)} layers ({stack})"


def traction_couples(lower: Body, upper: Body | None, friction: float | Law) -> bool:
    """Return True if traction moves the normal gap: friction between elastically different bodies, as the operator has
    it."""
    from bem.convolution import couples

    return friction != 0 and couples((lower,) if upper is None else (lower, upper))


def check_surfaces(grid: Grid, larger: str = "take a larger grid", **surfaces: AnySurface) -> None:
    """Refuse generated surfaces that cannot be had on the grid, before any work; by the names of their bodies.

    larger : what makes the grid of the scene larger, in words.

    Raises
    ------
    InputError : statistics that the generator refuses, each with its body's name.
    """
    messages = []
    for name, surface in surfaces.items():
        if isinstance(surface, GeneratedSurface):
            from bem.surfaces.generate import check_statistics

            try:
                check_statistics(_drawn_on(surface, grid), **_statistics(surface))
            except InputError as error:
                messages += [_of_scene(m, f"{name}.surface", surface, larger) for m in error.messages]
            try:
                marks_of(surface, grid, 0)
            except InputError as error:
                messages += [f"{name}.surface.{m}" for m in error.messages]
    if messages:
        raise InputError(messages)


def _of_scene(message: str, table: str, surface: GeneratedSurface, larger: str) -> str:
    """Return a message of the generator with the remedies of a scene, and whether the process set what it is about."""
    from bem.surfaces.processes import PROCESSES
    from bem.surfaces.request import FINER, LARGER

    said = message.removeprefix("generate_surface: ")
    name = said.split(" ", 1)[0]
    key = f"{table}.correlation_length"
    said = said.replace(LARGER, f"{larger}, or shorten {key}").replace(FINER, f"take more cells, or lengthen {key}")
    if surface.process is not None:
        usual = PROCESSES[surface.process].keys(surface.lay or "y")
        if name not in usual or getattr(surface, name, None) == usual[name]:
            said += f' (set by process = "{surface.process}")'
    return f"{table}: {said}"


def _statistics(surface: GeneratedSurface) -> dict[str, Any]:
    length: float | tuple[float, float] | None = surface.correlation_length
    if surface.correlation_length is not None and surface.elongation is not None:
        root = math.sqrt(surface.elongation)
        length = (surface.correlation_length * root, surface.correlation_length / root)
    return {
        "rms_height": surface.rms_height,
        "correlation_length": length,
        "hurst": surface.hurst,
        "rolloff_wavelength": surface.rolloff_wavelength,
        "cutoff_wavelength": surface.cutoff_wavelength,
        "skewness": surface.skewness,
        "kurtosis": surface.kurtosis,
    }


def _generated(surface: GeneratedSurface, grid: Grid, seed: int) -> FloatArray:
    from bem.surfaces.waves import on_cells

    seed = seed if surface.seed is None else surface.seed
    waves = on_cells(_waves(surface, _drawn_on(surface, grid), seed), grid.shape)
    marks = marks_of(surface, grid, seed)
    if marks is not None:
        return waves + (marks - marks.mean())
    return waves if waves.flags.writeable else waves.copy()


def _waves(surface: GeneratedSurface, grid: Grid, seed: int) -> FloatArray:
    """Heights [m] of a generated surface on the grid that it is drawn on, marks left out; those that are kept are
    read-only."""
    from bem.surfaces import generate_surface

    statistics = _statistics(surface)

    def make() -> FloatArray:
        heights = generate_surface(grid, seed=seed, **statistics)
        heights.flags.writeable = False
        return heights

    if 8 * grid.cells > KEPT.limit:  # it would not be kept, and a copy of its own would be for nothing
        return generate_surface(grid, seed=seed, **statistics)
    return KEPT.of((grid, seed, *statistics.values()), make)


def marks_of(surface: GeneratedSurface, grid: Grid, seed: int) -> FloatArray | None:
    """Marks of a tool on the grid's own cells, which resolve them or refuse: they are no waves to be carried.

    Raises
    ------
    InputError : as `bem.surfaces.feed_marks` and `cross_hatch`.
    """
    from bem.surfaces.marks import cross_hatch, feed_marks

    lay = surface.lay or "y"
    if surface.feed_marks is not None:
        return feed_marks(grid, seed=seed, lay=lay, **surface.feed_marks.model_dump())
    if surface.cross_hatch is not None:
        return cross_hatch(grid, seed=seed, lay=lay, **surface.cross_hatch.model_dump())
    return None


def drawn_hatch_angle(surface: GeneratedSurface, grid: Grid) -> float:
    """Angle between the grooves of a surface's cross-hatch as it closes on the grid [rad]."""
    from bem.surfaces.marks import hatch_angle

    assert surface.cross_hatch is not None
    return hatch_angle(grid, surface.cross_hatch.angle, surface.cross_hatch.spacing, surface.lay or "y")


def _drawn_on(surface: GeneratedSurface, grid: Grid) -> Grid:
    """The grid that a surface is drawn on: its own cells over the rectangle of the grid, or the grid itself."""
    if surface.drawn_on is None:
        return grid
    nx, ny = surface.drawn_on
    return Grid((nx, ny), (grid.lengths[0] / nx, grid.lengths[1] / ny), periodic=grid.periodic)
