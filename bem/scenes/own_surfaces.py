"""First scenes on measured surfaces: files of an instrument in place of generated roughness, and a mesh that fits them.

`bem new KIND --lower FILE --upper FILE` writes them, and so does the page of surfaces.
Verified in tests/scenes/test_own_surfaces.py.
"""

from __future__ import annotations

import math
import os
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from bem.errors import InputError
from bem.grid import Grid
from bem.notes.note import percent, told_apart
from bem.quantities import si
from bem.scenes.common import MeasuredSurface
from bem.scenes.kind import get_kind
from bem.scenes.maps import MOST_SEAM_CHANGE, height_unit_note, map_on
from bem.scenes.paths import absolute
from bem.scenes.tables.wear_model import WearScenePart
from bem.scenes.validate import validate
from bem.surfaces.examples import example_path

KINDS = ("contact", "friction", "running-in", "running-in-life", "wear")
_LINE_CONTACTS = ("wear", "running-in-life")
"""Kinds whose first scene has a cylinder; its load is in proportion to the radius at the same Hertz pressure."""
_MOST_FILLED = 0.25
"""Share of missing points of a map above which filling them draws most of what touches."""
_SAME_SPACING = 0.7
"""Ratio of the spacings of two maps above which the finer one is taken for the grid."""
_MOST_CELLS = 192
"""Cells along an axis of a first mesh: a wear loop of 100 cycles takes some minutes."""
_FEWEST_POINTS = 32
"""Points of a map along an axis of a patch: on fewer the contact is a handful of cells."""
_MOST_UNLIKE = 10.0
"""Ratio of the cells of two maps above which the finer map is mostly left out."""
_LEAST_COMMON = 0.1
"""Common area over that of the larger map, below which the pair is remarked on."""
_GAP = 3.0
"""Gap of the smooth bodies over Sq up to which summits touch beside Hertz' contact: the highest of some thousand are
three to four Sq high. At half of it summits touched at the ends of a grid whose Sq was three times Hertz' approach."""
_MARGIN = 2.2
"""Length of the mesh over the half-width within which the surfaces touch."""
_MOST_CELLS_ACROSS = 64
"""Cells along a cylinder of a first mesh of a life, which solves some hundred contacts."""
_FEWEST_CELLS = 48
"""Cells along an axis of a first mesh, at least."""
_CELLS_PER_LENGTH = 3
"""Cells to the averaging length of the particle criterion."""
_SHORTEST_AVERAGE = 300e-9
"""Averaging length of the particle criterion where cells are small enough [m]."""
_WEAR_RATE = 1e-16
"""Specific wear rate of a first scene [m^2/N]: 1e-7 mm^3/(N m), of steel in boundary lubrication."""
_CYCLES = 150
"""Wear cycles of a lubricated first scene: with the largest stable steps, summits lose about 10 nm in them."""
_STEP = 0.5
"""Compliance by wear of a cycle over that by which the bodies give way from cell to cell: a stable step."""


@dataclass(frozen=True)
class MeasuredMap:
    """A measured map.

    Attributes
    ----------
    shape : cells. spacing : of the cells [m].
    table : keys of its table in a scene.
    rms_height : Sq [m]. rms_slope : Sdq; 0 where it is not known.
    resampled : True if the cells are not those of the file.
    source : the table with its file's absolute path, from which its seams are judged; None where they are not.
    """

    shape: tuple[int, int]
    spacing: tuple[float, float]
    table: dict[str, Any]
    rms_height: float
    resampled: bool = False
    source: MeasuredSurface | None = None
    rms_slope: float = 0.0

    @property
    def lengths(self) -> tuple[float, float]:
        """Side lengths [m]."""
        return self.shape[0] * self.spacing[0], self.shape[1] * self.spacing[1]


@dataclass(frozen=True)
class MapScale:
    """Scale of a map whose file has plain numbers, without units.

    Attributes
    ----------
    spacing : distance of points along x and y [m]; None if not given.
    height_unit : unit of the heights, such as "nm"; None if not given, and heights are then in metres.
    """

    spacing: tuple[float, float] | None = None
    height_unit: str | None = None

    @property
    def read_arguments(self) -> dict[str, Any]:
        """Arguments of `read_surface` that are given."""
        return {name: value for name, value in vars(self).items() if value is not None}

    @property
    def keys(self) -> dict[str, Any]:
        """Keys of the surface's table in a scene."""
        keys: dict[str, Any] = {}
        if self.spacing is not None:
            x, y = (f"{1e6 * side:.9g} um" for side in self.spacing)
            keys["spacing"] = x if x == y else [x, y]
        return keys if self.height_unit is None else keys | {"height_unit": self.height_unit}


def read_maps(files: Mapping[str, str], folder: Path, scale: MapScale | None = None) -> dict[str, MeasuredMap]:
    """Read the map of each body, by "lower" and "upper"; paths are relative to the folder of the scene file.

    scale : spacing and unit of heights of the files that do not say them.

    Raises
    ------
    InputError : a map with too many missing points; a scale that is missing, or that no file needs.
    SurfaceFileError : a file that cannot be read.
    """
    scale = scale or MapScale()
    found, unstated = {}, False
    for body, path in files.items():
        own = _scale_of(body, path, scale)
        unstated = unstated or own is not None
        found[body] = _read(body, path, folder, own or MapScale())
    if scale.read_arguments and not unstated:
        raise InputError(
            "--spacing, --height-unit: the files say both; allowed: for files of plain numbers (in a scene, the keys "
            "spacing and height_unit of a surface replace what its file says)"
        )
    return found


@dataclass(frozen=True)
class OwnStart:
    """A first scene on measured surfaces.

    Attributes
    ----------
    values : of the scene, by key.
    reasons : why some of them were chosen, by path of the key.
    """

    values: dict[str, Any]
    reasons: dict[tuple[str, ...], str] = field(default_factory=dict)


def notes_on_maps(found: Mapping[str, MeasuredMap]) -> list[str]:
    """Return what is doubtful of maps, each with what to do: the unit of heights first, then of two maps what makes
    them a poor pair, cells of unlike size or a small common area."""
    notes, names = _unit_doubts(found), list(found)
    if len(found) < 2:
        return notes
    cells = [max(one.spacing) for one in found.values()]
    coarse, fine = (names[cells.index(pick(cells))] for pick in (max, min))
    if max(cells) > _MOST_UNLIKE * min(cells):
        notes.append(
            f"the cells of the {coarse} map ({si(max(cells), 'm')}) are {max(cells) / min(cells):.0f} times those of "
            f"the {fine} map ({si(min(cells), 'm')}): roughness shorter than two of the large cells is left out; "
            "measure both with similar cells"
        )
    areas = [math.prod(one.lengths) for one in found.values()]
    common = math.prod(_common_lengths(found.values()))
    if common < _LEAST_COMMON * max(areas):
        large = names[areas.index(max(areas))]
        notes.append(
            f"only {percent(common / max(areas))} of the {large} map is used, its middle, as large as the other map; "
            "measure areas of similar size"
        )
    return notes


def _unit_doubts(found: Mapping[str, MeasuredMap]) -> list[str]:
    """Return a note on each map whose heights are probably in another unit."""
    notes = (height_unit_note(body, one.rms_height, one.rms_slope) for body, one in found.items())
    doubts = [str(note) for note in notes if note is not None]
    if doubts and sum("height_unit" in one.table for one in found.values()) > 1:
        doubts.append(
            "--height-unit held for both files. Where their units differ, write the unit of each into the scene, as "
            "height_unit of its surface."
        )
    return doubts


def own_surfaces_start(kind: str, start: Mapping[str, Any], found: Mapping[str, MeasuredMap]) -> OwnStart:
    """Return values of a first scene of a kind on measured surfaces.

    start : values of the kind's first scene. found : map of each body, by "lower" and "upper".

    Raises
    ------
    InputError : a kind without measured surfaces, or a map that is too small for the contact.
    """
    if kind not in KINDS:
        raise InputError(f"--lower, --upper: not for kind {kind}; allowed: with {', '.join(KINDS)}")
    data = {key: dict(value) if isinstance(value, Mapping) else value for key, value in start.items()}
    for body, one in found.items():
        data[body] = {**data[body], "surface": one.table}
    spacing = max(max(one.spacing) for one in found.values())
    smallest = min(min(one.lengths) for one in found.values())
    if kind == "contact":
        data.pop("shape", None)  # a patch of a larger contact, on cells and area of the maps
        data["contact"] = {"mean_pressure": "20 MPa", "behaviour": "capped"}
        return _on_a_patch(data, found)
    rms_height = math.hypot(*(one.rms_height for one in found.values()))
    data, length = _fitted(kind, data, spacing, smallest, rms_height)
    cells, cell = _mesh(length, spacing)
    reasons = _why_larger_cells(kind, cells, cell, spacing)
    if kind == "wear":
        data["domain"] = {"cells": cells, "lengths": _length(cells * cell)}
    elif kind == "running-in-life":
        data["grid"] = {"shape": [cells, min(cells, _MOST_CELLS_ACROSS)], "spacing": _length(cell)}
        data["wear"] = {"law": data["wear"]["law"] | _slid_in_a_pass(data["speeds"]["slide_roll_ratio"], cells * cell)}
        return _mirrored_where_bent(kind, data, found, reasons)
    else:
        data["grid"] = {"shape": cells, "spacing": _length(cell)}
    if kind == "friction":
        return _mirrored_where_bent(kind, data, found, reasons)
    if kind == "running-in":
        data["speeds"] = {"values": [data["speeds"]["first"]]}
        # over a whole turn friction and particles do not hang on the place where the roughness of both bodies meets
        turn = round(cells / abs(WearScenePart().shift))
        data["cycles"] = {"count": _CYCLES, "averaged": turn, "settled": turn, "coarser_grid": True}
    data["depths"] = {"count": 64, "spacing": _length(cell / 2)}
    return _mirrored_where_bent(kind, data | {"wear": _wear(kind, data, cell)}, found, reasons)


def _slid_in_a_pass(ratio: float, length: float) -> dict[str, Any]:
    """Return the keys of a wear law on the sliding of a place of either body, which crosses the patch at its own speed.

    Parameters
    ----------
    ratio : slide-to-roll ratio, below 2.
    length : of the patch along the motion [m].
    """
    lower, upper = 1 + 0.5 * ratio, 1 - 0.5 * ratio  # over the entrainment speed
    distance = f"{1e6 * length * ratio / lower:.4g} um"
    return {"distance": distance, "upper_over_lower": float(f"{lower / upper:.6g}")}


def _scale_of(body: str, path: str, scale: MapScale) -> MapScale | None:
    """Return the scale of a file that does not say it; None of other files.

    Raises
    ------
    InputError : such a file without a spacing, or in metres by which its slopes are no surface's.
    """
    from bem.surfaces import read_surface
    from bem.surfaces.read import slope_in_metres, states_scale, unit_judged_by_caller

    name = Path(path).name
    if states_scale(path):
        return None
    if scale.spacing is None and scale.height_unit is None:
        raise InputError(
            f"--{body}: {name} does not say how far its points are apart, nor in which unit its heights are; "
            'give --spacing and --height-unit, such as --spacing "0.5 um" --height-unit nm'
        )
    if scale.spacing is None:
        raise InputError(
            f'--{body}: {name} does not say how far its points are apart; give --spacing, such as --spacing "0.5 um"'
        )
    if scale.height_unit is None:
        with unit_judged_by_caller():
            slope = slope_in_metres(read_surface(path, spacing=scale.spacing))
        if slope is not None:
            raise InputError(
                f"--{body}: {name} does not say in which unit its heights are, and in metres they would have an rms "
                f"slope of {slope:.2g}; give --height-unit, such as nm or um"
            )
    return scale


def _read(body: str, path: str, folder: Path, scale: MapScale) -> MeasuredMap:
    """Read a map and choose what its table needs: form removal, and despiking where there are outliers."""
    from bem.surfaces import describe_surface, read_surface
    from bem.surfaces.spikes import SPIKE, spikes_of

    surface = read_surface(path, detrend="curvature", **scale.read_arguments)
    name = Path(path).name
    cells = surface.shape[0] * surface.shape[1]
    missing = float(surface.metadata.get("missing_points", 0) or 0) / cells
    if missing > _MOST_FILLED:
        raise InputError(
            f"--{body}: {name}: {percent(missing)} of the points are missing, so that most of what touches "
            f"would be filled in; allowed: up to {percent(_MOST_FILLED)}; measure again, or cut out a part without "
            "holes in the instrument's program"
        )
    known = path if example_path(path) is not None else os.path.relpath(path, folder)
    table: dict[str, Any] = {"kind": "measured", "path": Path(known).as_posix(), **scale.keys}
    table["detrend"] = "curvature"
    if spikes_of(surface):
        table["despike"] = round(SPIKE)
        surface = read_surface(path, detrend="curvature", despike=SPIKE, **scale.read_arguments)
    source = validate(table | {"path": absolute(path, Path())}, MeasuredSurface)
    slope = describe_surface(surface.heights, surface.spacing).Sdq
    height = float(surface.heights.std())
    return MeasuredMap(surface.shape, surface.spacing, table, height, source=source, rms_slope=slope)


def _common_lengths(maps: Collection[MeasuredMap]) -> tuple[float, float]:
    """Return the side lengths that all maps cover [m]."""
    return min(one.lengths[0] for one in maps), min(one.lengths[1] for one in maps)


def _common_cells(maps: Collection[MeasuredMap]) -> tuple[tuple[int, int], tuple[float, float]]:
    """Return an even number of cells on the common area of maps, and their spacing [m].

    Between the points of the coarser map there is no roughness, so that its spacing is taken where they differ much.
    """
    sides = [[one.spacing[axis] for one in maps] for axis in (0, 1)]
    alike = all(min(own) > _SAME_SPACING * max(own) for own in sides)
    dx, dy = (min(own) if alike else max(own) for own in sides)
    nx, ny = (
        2 * math.floor(length / side / 2 * (1 + 1e-9))
        for length, side in zip(_common_lengths(maps), (dx, dy), strict=True)
    )
    return (nx, ny), (dx, dy)


def _on_a_patch(data: dict[str, Any], found: Mapping[str, MeasuredMap]) -> OwnStart:
    """Return the first scene of a periodic patch as large as the area of the maps.

    Cells of the maps that do not lie within the patch are cut off, so that heights are not interpolated between them.
    Where closing the seams would alter a map, all maps are continued by their mirror images.
    """
    maps = found.values()
    shape, spacing = _common_cells(maps)
    points = [
        math.floor(length / max(one.spacing[axis] for one in maps) * (1 + 1e-9))
        for axis, length in enumerate(_common_lengths(maps))
    ]
    if min(*shape, *points) < _FEWEST_POINTS:
        raise _too_few_points(found, points)
    lengths = shape[0] * spacing[0], shape[1] * spacing[1]
    cut = {}
    for body, one in found.items():
        on_its_cells = all(math.isclose(a, b, rel_tol=1e-9) for a, b in zip(one.spacing, spacing, strict=True))
        if on_its_cells and one.shape != shape and not one.resampled:
            cut[body] = lengths
            data[body]["surface"] = {**data[body]["surface"], "crop": _cells(lengths)}
    grid: dict[str, Any] = {"periodic": True}
    mirror, changes = _mirrors(found, cut, Grid(shape, spacing))
    for body in found if mirror != "none" else ():
        data[body]["surface"] = {**data[body]["surface"], "mirror": mirror}
    whole = tuple(n * (2 if mirror in (axis, "both") else 1) for axis, n in zip("xy", shape, strict=True))
    if len(found) > 1 or any(one.resampled for one in maps):
        grid |= {"shape": list(whole), "spacing": _cells(spacing)}
    reasons: dict[tuple[str, ...], str] = {
        (body, "surface", "mirror"): _why_mirrored(changes, body) for body in found if mirror != "none"
    }
    return OwnStart(data | {"grid": grid}, reasons)


def _mirrors(
    found: Mapping[str, MeasuredMap], cut: Mapping[str, tuple[float, float]], part: Grid
) -> tuple[str, dict[str, float]]:
    """Return the axes along which maps on a part of a grid are mirrored, "none" where seams close well, and by how
    much closing the seams instead would change the heights of each body's map, over their Sq.

    A step where the ends of a map meet is closed by long waves. Beyond `MOST_SEAM_CHANGE` of Sq they are more than a
    tenth of the variance, and the patch is another surface. The mirror image has no step, and the same heights.
    """
    sources = {body: one.source for body, one in found.items() if one.source is not None}
    if len(sources) < len(found) or any(table.mirror != "none" for table in sources.values()):
        return "none", {}
    closed: dict[str, float] = {}
    for mirror in ("none", "x", "y", "both"):
        counts = [n * (2 if mirror in (axis, "both") else 1) for axis, n in zip("xy", part.shape, strict=True)]
        grid = Grid((counts[0], counts[1]), part.spacing, periodic=(True, True))
        changes = {}
        for body, table in sources.items():
            on_grid = map_on(table.model_copy(update={"mirror": mirror, "crop": cut.get(body, table.crop)}), grid)
            changes[body] = on_grid.seam_change / (float(on_grid.heights.std()) or math.inf)
        closed = closed or changes
        if max(changes.values()) <= MOST_SEAM_CHANGE:
            break
    return mirror, closed


def _why_mirrored(changes: Mapping[str, float], body: str) -> str:
    """Return why the map of a body is mirrored: for its own ends, or for those of the other map on the same patch.

    changes : of the heights of each body's map by closing the step instead, over their Sq.
    """
    own, other = changes[body] > MOST_SEAM_CHANGE, max(changes, key=lambda name: changes[name])
    change = told_apart(changes[body if own else other], MOST_SEAM_CHANGE, "%")
    whose = "this map" if own else f"the map of {other}.surface"
    why = (
        f"Chosen because the ends of {whose} do not meet: closing the step would change its heights by {change} of Sq "
        f"(more than {percent(MOST_SEAM_CHANGE)})."
    )
    if own:
        return why
    return (
        f"{why} Mirrored maps fill a larger patch, so that this map (change {percent(changes[body])}) is mirrored, too."
    )


def _why_larger_cells(kind: str, cells: int, cell: float, spacing: float) -> dict[tuple[str, ...], str]:
    """Return the reason for cells [m] that are larger than those of the coarser map [m], by the key of their size."""
    if cell < spacing * (1 + 1e-3):
        return {}
    all_cells = 2 * math.floor(cells * cell / spacing / 2 + 1e-9)
    whole = f"domain.cells = {all_cells}" if kind == "wear" else f"grid.shape = {all_cells}"
    whole += "" if kind == "wear" else f", grid.spacing = {_length(spacing)}"
    why = (
        f"Larger than the points of the maps, {_length(spacing)}, to keep the run short: roughness shorter than two "
        f"cells is left out, slopes are smaller, and sizes of particles follow the cells. Cells of the maps: {whole}."
    )
    return {("domain", "cells") if kind == "wear" else ("grid", "spacing"): why}


def _mirrored_where_bent(
    kind: str, data: dict[str, Any], found: Mapping[str, MeasuredMap], why: Mapping[tuple[str, ...], str]
) -> OwnStart:
    """Return a first scene with those maps mirrored on its cells that closing the seams would alter.

    why : reasons for its other values, by path of the key.
    """
    from bem.scenes.checks import examine

    tables = {body: one.table | {"path": one.source.path} for body, one in found.items() if one.source is not None}
    known = {body: {**data[body], "surface": table} for body, table in tables.items()}
    one_kind = get_kind(kind)
    facts = examine(one_kind.resolved(one_kind.model.model_validate({**data, **known})))
    reasons = dict(why)
    for change, _, surface in facts.worst_surfaces(lambda surface: surface.seams / surface.rms_height):
        table = surface.table
        if change > MOST_SEAM_CHANGE and isinstance(table, MeasuredSurface) and table.mirror == "none":
            body, wraps = surface.body, [axis for axis, on in zip("xy", surface.grid.periodic, strict=True) if on]
            mirror = "both" if len(wraps) > 1 else wraps[0]
            data = data | {body: {**data[body], "surface": {**data[body]["surface"], "mirror": mirror}}}
            reasons[body, "surface", "mirror"] = _why_mirrored({body: change}, body)
    return OwnStart(data, reasons)


def _too_few_points(found: Mapping[str, MeasuredMap], points: Sequence[int]) -> InputError:
    """Return the refusal of maps on whose points no rough contact can be resolved."""
    fewest = f"{_FEWEST_POINTS} x {_FEWEST_POINTS} points or more"
    for body, one in found.items():
        if min(one.shape) < _FEWEST_POINTS:
            return InputError(
                f"--{body}: the map has {one.shape[0]} x {one.shape[1]} points, of which a handful would touch; "
                f"allowed: {fewest}; measure a larger area or with a finer spacing"
            )
    x, y = _common_lengths(found.values())
    return InputError(
        f"--lower, --upper: the maps have {si(x, 'm')} x {si(y, 'm')} in common, {points[0]} x {points[1]} points of "
        f"the coarser one; allowed: {fewest}; measure both on areas of similar size, with similar spacing"
    )


def _half_width(kind: str, data: Mapping[str, Any]) -> float:
    """Half-width of the Hertz contact of a first scene [m]."""
    scene = _without_roughness(kind, data)
    if kind == "wear":
        smooth = scene.smooth_contact()
        assert smooth is not None
        return float(smooth.semi_axes[0])
    if kind in _LINE_CONTACTS:
        contact = scene.contact
        return math.sqrt(4 * max(contact.loads) * contact.radius / (math.pi * contact.width * scene.modulus))
    from bem.scenes.checks.hertz import smooth_contact

    radius = scene.contact.point_radii[0]
    smooth = smooth_contact(scene.lower.build(), scene.upper.build(), (radius, radius), load=max(scene.contact.loads))
    assert smooth is not None
    return float(max(smooth.semi_axes))


def _without_roughness(kind: str, data: Mapping[str, Any]) -> Any:
    """The scene of these values with smooth bodies."""
    bodies = {
        body: {key: value for key, value in data[body].items() if key != "surface"} for body in ("lower", "upper")
    }
    return get_kind(kind).model.model_validate({**data, **bodies})


def _mesh(length: float, spacing: float) -> tuple[int, float]:
    """Cells along each axis and their size [m]: the coarser spacing of the maps, on a length that holds the contact."""
    cells = min(2 * math.floor(length / spacing / 2 + 1e-9), _MOST_CELLS)
    if cells < _FEWEST_CELLS:
        raise InputError(
            f"--lower, --upper: the maps have {cells} points of {si(spacing, 'm')} across the contact of the first "
            f"scene; allowed: {_FEWEST_CELLS} or more: larger maps, or finer ones"
        )
    return cells, max(spacing, length / _MOST_CELLS)


def _fitted(
    kind: str, data: dict[str, Any], spacing: float, smallest: float, rms_height: float
) -> tuple[dict[str, Any], float]:
    """Return the values with a contact that fits the maps, and the length of the mesh [m].

    Rough surfaces touch where the gap of the smooth bodies, x^2 / 2R, is within `_GAP` times Sq beside the Hertz
    contact. Where that is too large for the maps or too small for their cells, radius and load change at the same Hertz
    pressure: half-width in proportion to the radius, load to its square, of a cylinder of the same width to the radius.
    rms_height : Sq of both surfaces together [m].
    """
    scene, line = _without_roughness(kind, data), kind in _LINE_CONTACTS
    half_width, body = _half_width(kind, data), scene.cylinder if kind == "wear" else scene.contact
    radius = body.radius if line else body.ball

    def length(scale: float) -> float:
        return _MARGIN * math.hypot(scale * half_width, math.sqrt(2 * _GAP * scale * radius * rms_height))

    wanted = min(max(length(1.0), 1.1 * _FEWEST_CELLS * spacing), 0.98 * smallest)
    if wanted == length(1.0):
        return data, wanted
    # of (scale a)^2 + 2 gap scale R Sq = (wanted / margin)^2 the positive root
    linear, square = 2 * _GAP * radius * rms_height, half_width**2
    scale = (math.sqrt(linear**2 + 4 * square * (wanted / _MARGIN) ** 2) - linear) / (2 * square)
    smaller = {
        "radius" if line else "ball": f"{_digits(1e3 * scale * radius)} mm",
        "loads": [f"{_digits(scale ** (1 if line else 2) * load)} N" for load in body.loads],
    }
    table = "cylinder" if kind == "wear" else "contact"
    return data | {table: data[table] | smaller}, wanted


def _digits(value: float) -> str:
    """A number, rounded down to two digits."""
    unit = 10.0 ** (math.floor(math.log10(value)) - 1)
    return f"{math.floor(value / unit * (1 + 1e-9)) * unit:.6g}"


def _wear(kind: str, data: Mapping[str, Any], cell: float) -> dict[str, Any]:
    """Archard's law with the particles of the averaged von Mises criterion, and a distance that keeps steps stable."""
    from bem.wear.criterion.local import cell_to_cell_compliance

    scene = _without_roughness(kind, data)
    lower, upper = scene.lower.build(), scene.upper.build()
    most = cell_to_cell_compliance(Grid((32, 32), (cell, cell)), (lower, upper))
    distance = _STEP * most / _WEAR_RATE
    average = max(_SHORTEST_AVERAGE, _CELLS_PER_LENGTH * cell)
    return {
        "criterion": {
            "kind": "archard",
            "specific_wear_rate": f"{1e9 * _WEAR_RATE:.0e} mm^3/(N*m)",
            "distance": f"{float(f'{1e3 * distance:.1g}'):g} mm",
        },
        "particle_criterion": {"kind": "averaged_von_mises", "averaging_length": _length(average)},
    }


def _cells(spacing: Sequence[float]) -> list[str]:
    """Cell sides as a scene writes them, to 12 digits: rounded up to fewer, the grid would reach beyond the maps."""
    return [f"{1e6 * side:.12g} um" for side in spacing]


def _length(value: float) -> str:
    """A length [m] as a scene writes it."""
    return f"{float(f'{1e6 * value:.4g}'):g} um"
