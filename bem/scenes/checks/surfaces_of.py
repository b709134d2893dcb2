"""Surfaces of a scene, and the changes that put them onto the grid."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

from bem.grid import FloatArray, Grid
from bem.notes.note import percent
from bem.quantities import si
from bem.scenes import build, maps
from bem.scenes.checks.words import times
from bem.scenes.common import GeneratedSurface, MeasuredSurface
from bem.scenes.context import derive_seed

if TYPE_CHECKING:
    from bem.surfaces import Surface

_CELLS = 1 << 18
"""Larger grids are described by a patch of as many cells: statistics of a plan need no more."""


@dataclass(frozen=True)
class RoughSurface:
    """A rough surface on a scene's grid.

    Attributes
    ----------
    body : "lower" or "upper".
    table : what the scene says.
    made : what it is and what was done to it, in short sentences.
    rms_height, rms_slope, correlation_length : of the heights on the grid [m, 1, m]; the length is where the
        autocorrelation falls to 1/e, nan where it does not within the grid.
    filled : share of a measured map's points that are filled from their neighbours.
    source_points : points of the measured map under the grid along x and y; None where generated.
    source_spacing : their distance [m].
    spikes, kurtosis : points of a measured map that `despike` would remove, or has left, and Sku of the map.
    scaled : what heights were multiplied by to meet `rms_height`.
    seams : rms change of the heights by which the map was made periodic [m].
    """

    body: str
    table: GeneratedSurface | MeasuredSurface
    grid: Grid
    made: tuple[str, ...]
    rms_height: float
    rms_slope: float
    correlation_length: float
    filled: float = 0.0
    source_points: tuple[float, float] | None = None
    source_spacing: tuple[float, float] | None = None
    scaled: float | None = None
    spikes: int = 0
    kurtosis: float = 0.0
    seams: float = 0.0

    @property
    def shortest_wave(self) -> float | None:
        """The shortest wave that the scene asks of a generated surface [m]; None where it leaves it to the mesh."""
        return self.table.cutoff_wavelength if isinstance(self.table, GeneratedSurface) else None

    @property
    def self_affine(self) -> bool:
        """Return True for a generated surface with a self-affine power spectrum."""
        return isinstance(self.table, GeneratedSurface) and self.table.hurst is not None

    @property
    def correlation_lengths(self) -> tuple[float, float]:
        """Along x and y [m]: what the scene asks of an elongated surface, else that of the heights along both."""
        if isinstance(self.table, GeneratedSurface) and self.table.elongation is not None:
            asked = self.table.correlation_lengths
            assert asked is not None
            return asked
        return self.correlation_length, self.correlation_length

    def describe(self) -> str:
        """Rms height, slope and correlation length in words."""
        length = self.correlation_length
        found = "" if math.isnan(length) else f", correlation length {si(length, 'm')}"
        if isinstance(self.table, GeneratedSurface) and self.table.elongation is not None:
            found = f", {_both_lengths(self.correlation_lengths)}"
        return f"Sq {si(self.rms_height, 'm')}, rms slope {self.rms_slope:.2g}{found}"


def rough_surface(body: str, table: build.AnySurface, grid: Grid, seed: int) -> RoughSurface | None:
    """Return the rough surface of a table on a grid; None for a smooth one.

    A generated surface is looked at as if its heights were Gaussian: the slope and the correlation length follow from
    the spectrum, and the moments take many times as long to impose.
    """
    if isinstance(table, GeneratedSurface):
        return _generated(body, table, grid, seed)
    if isinstance(table, MeasuredSurface):
        return _measured(body, table, grid, maps.content_of(table))
    return None


def _both_lengths(lengths: tuple[float, float]) -> str:
    return f"correlation length {si(lengths[0], 'm')} along x, {si(lengths[1], 'm')} along y"


def _described(heights: FloatArray, grid: Grid) -> tuple[float, float, float]:
    from bem.surfaces import describe_surface

    found = describe_surface(heights, grid.spacing, periodic=grid.periodic)
    return found.Sq, found.Sdq, found.autocorrelation_length


def _patch(grid: Grid) -> Grid:
    if grid.cells <= _CELLS:
        return grid
    shrink = math.sqrt(_CELLS / grid.cells)
    nx, ny = (max(min(n, 16), round(n * shrink)) for n in grid.shape)
    return Grid((nx, ny), grid.spacing, periodic=grid.periodic)


@lru_cache(maxsize=64)  # points of a sweep have the same ones
def _generated(body: str, table: GeneratedSurface, grid: Grid, seed: int) -> RoughSurface:
    if table.hurst is not None:
        cutoff = "two cells" if table.cutoff_wavelength is None else si(table.cutoff_wavelength, "m")
        flat = "" if table.rolloff_wavelength is None else f", flat above {si(table.rolloff_wavelength, 'm')}"
        made = f"generated, self-affine with H {table.hurst:g} down to {cutoff}{flat}"
    else:
        assert table.correlation_length is not None
        made = f"generated with correlation length {si(table.correlation_length, 'm')}"
        if table.elongation is not None and table.correlation_lengths is not None:
            made = f"generated with {_both_lengths(table.correlation_lengths)}"
    if (table.skewness, table.kurtosis) != (0.0, 3.0):
        made += f", skewness {table.skewness:g}, kurtosis {table.kurtosis:g}"
    made += _marks_said(table, grid)
    patch, seed = _patch(grid), derive_seed(seed, body) if table.seed is None else table.seed
    # marks of a part of a grid do not repeat with it, so that no whole feeds need lie on it
    marked = grid if patch == grid else Grid(patch.shape, patch.spacing)
    marks = build.marks_of(table, marked, seed)
    if patch != grid and table.correlation_length is not None:
        # the patch may be too small for it; exp(-(r/l)^2) has the slope 2 Sq / l
        length = table.correlation_length
        height, slope, _ = (0.0, 0.0, 0.0) if marks is None else _described(marks, marked)
        both = math.hypot(table.rms_height, height), math.hypot(2 * table.rms_height / length, slope)
        return RoughSurface(body, table, grid, (made,), *both, length)
    plain: dict[str, object] = {"skewness": 0.0, "kurtosis": 3.0, "feed_marks": None, "cross_hatch": None}
    if patch != grid:
        # a part of a self-affine surface has not its long waves, and coarser cells have not its short ones
        coarse = Grid(patch.shape, _divided(grid.lengths, patch.shape), periodic=grid.periodic)
        shortest = table.cutoff_wavelength or 0.0
        plain |= {"drawn_on": None, "cutoff_wavelength": shortest if shortest >= 2 * max(coarse.spacing) else None}
        _, _, length = _described(build.heights_of(table.model_copy(update=plain), coarse, seed), coarse)
        height, slope, _ = (0.0, 0.0, 0.0) if marks is None else _described(marks, marked)
        own = table.rms_height * _slope_of_waves(table, grid)
        return RoughSurface(
            body, table, grid, (made,), math.hypot(table.rms_height, height), math.hypot(own, slope), length
        )
    heights = build.heights_of(table.model_copy(update=plain), patch, seed)
    found = _described(heights, patch) if marks is None else _described(heights + (marks - marks.mean()), marked)
    return RoughSurface(body, table, grid, (made,), *found)


def _divided(lengths: tuple[float, float], shape: tuple[int, int]) -> tuple[float, float]:
    return lengths[0] / shape[0], lengths[1] / shape[1]


def _slope_of_waves(table: GeneratedSurface, grid: Grid) -> float:
    """Rms slope over rms height [1/m] of a self-affine surface: the root of m2 / m0, moments of a power spectrum that
    is even up to the roll-off and falls with k^(-2 - 2H) beyond, from the longest to the shortest wave of the grid."""
    hurst = table.hurst
    assert hurst is not None
    cells = table.drawn_on or grid.shape
    finest = max(_divided(grid.lengths, cells))
    longest, shortest = max(grid.lengths), max(table.cutoff_wavelength or 0.0, 2 * finest)
    rolloff = min(max(table.rolloff_wavelength or longest, shortest), longest)
    low, knee, high = (2 * math.pi / wave for wave in (longest, rolloff, shortest))

    def moment(power: int) -> float:
        even = (knee**power - low**power) / power
        rest = power - 2 - 2 * hurst  # of k, integrated
        falling = math.log(high / knee) if abs(rest) < 1e-9 else (high**rest - knee**rest) / rest
        return even + knee ** (2 + 2 * hurst) * falling

    return math.sqrt(moment(4) / moment(2)) if high > low else 0.0


def _marks_said(table: GeneratedSurface, grid: Grid) -> str:
    """Marks of a tool, in words; of grooves the angle that closes on the grid."""
    if table.feed_marks is not None:
        return f", between feed marks {si(table.feed_marks.feed, 'm')} apart"
    if table.cross_hatch is not None:
        hatch = table.cross_hatch
        drawn = build.drawn_hatch_angle(table, grid)
        asked = "" if abs(drawn - hatch.angle) < 1e-3 else f" (asked for: {math.degrees(hatch.angle):.4g})"
        return (
            f", between grooves {si(hatch.depth, 'm')} deep, {si(hatch.spacing, 'm')} apart, of directions "
            f"{math.degrees(drawn):.4g} deg{asked} from each other"
        )
    return ""


def _measured(body: str, table: MeasuredSurface, grid: Grid, content: str) -> RoughSurface:
    """Made once for a file's content; of one that is not known by its content, each time."""
    return (_described_map if content else _described_map.__wrapped__)(body, table, grid, content)


@lru_cache(maxsize=64)
def _described_map(body: str, table: MeasuredSurface, grid: Grid, content: str) -> RoughSurface:
    found = maps.read_map(table)
    done: tuple[str, ...]
    mirrored = (table.mirror in ("x", "both"), table.mirror in ("y", "both"))
    under = [n / (1 + m) * d for n, d, m in zip(grid.shape, grid.spacing, mirrored, strict=True)]
    points = (under[0] / found.spacing[0], under[1] / found.spacing[1])
    scaled, seams = None, 0.0
    if grid.cells <= maps.MOST_DESCRIBED:
        if table.rms_height is not None:
            plain = table.model_copy(update={"rms_height": None})
            scaled = table.rms_height / float(maps.map_on(plain, grid).heights.std() or math.nan)
        on_grid = maps.map_on(table, grid)
        description, done = _described(on_grid.heights, grid), on_grid.remarks
        seams = on_grid.seam_change
    else:
        description = _described(found.heights, found.grid())
        done = ("Sq, slope and correlation length are those of the map as it was measured",)
    spikes, kurtosis = _outliers(table, found)
    return RoughSurface(
        body,
        table,
        grid,
        (_origin(table, found), *(line.removeprefix(f"{Path(table.path).name}: ") for line in done)),
        *description,
        filled=found.filled_share,
        seams=seams,
        source_points=points,
        source_spacing=found.spacing,
        scaled=scaled,
        spikes=spikes,
        kurtosis=kurtosis,
    )


def _outliers(table: MeasuredSurface, found: Surface) -> tuple[int, float]:
    """Number of outliers, and the kurtosis Sku."""
    from bem.surfaces.spikes import SPIKE, spikes_of

    about = found.heights - found.heights.mean()
    variance = float((about**2).mean())
    return spikes_of(found, table.despike or SPIKE), float((about**4).mean()) / variance**2 if variance > 0 else 0.0


def _origin(table: MeasuredSurface, found: Surface) -> str:
    """File, instrument, size, and what happened to the map before it met the grid."""
    instrument = found.metadata.get("instrument") or {}
    name = instrument.get("name") if isinstance(instrument, dict) else None
    words = [Path(table.path).name]
    format_name = found.metadata.get("format")
    words.append(f"format {format_name}" if format_name else "")
    words.append(f"instrument {name}" if name else "")
    words.append(f"{found.shape[0]} x {found.shape[1]} points at {times(found.spacing, 'm')}")
    words.append("" if table.detrend == "none" else f"levelled by {table.detrend}")
    words.append("scan lines levelled" if table.level_lines else "")
    words.append(f"{percent(found.filled_share)} filled" if found.filled_share else "")
    words.append("" if table.crop is None else f"cropped to {times(table.crop, 'm')}")
    words.append("" if table.low_pass is None else f"waves under {si(table.low_pass, 'm')} removed")
    words.append("" if table.high_pass is None else f"waves over {si(table.high_pass, 'm')} removed")
    words.append("" if table.rms_height is None else f"scaled to Sq {si(table.rms_height, 'm')}")
    return ", ".join(word for word in words if word)
