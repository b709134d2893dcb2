"""What stands beside another code in a run of the benchmarks: load-area curves and stresses, as records and as words.

Knows no solver and runs nothing: `peer_curves` and `peer_stresses` measure. Times are processor times [s].
Verified in tests/reports/test_beside_peers.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from statistics import median
from typing import Any, TypeVar


@dataclass(frozen=True)
class CurveBeside:
    """A load-area curve of a peer, and bem's twice: with residuals as small on the same grid, and with an error of the
    area as small on the coarsest grid that has it.

    start : how its loads begin. residual : the largest complementarity of its loads, by the routine that judges bem.
    load_error : of its mean pressures, largest. area_difference, gap_difference : largest of all loads, of counted
        areas and mean gaps from bem's on the same grid, relative.
    area_error : rms over the loads against the limit of fine grids, relative; of its cells without what the steps of
        their edge add, `area_cpu` its times to a tolerance that errors of areas ask for. counted_error : of all its
        cells. Runs that have none knew no other: `area_error` is that, with the times of `cpu`. Of `bem_area_*` nothing
        is known (0 cells) where no grid has an error as small.
    limit_apart : of the limit that its own cells lead to, mean of all loads, relative; None where it has no grid half
        as fine.
    """

    peer: str
    start: str
    cells: int
    cpu: tuple[float, ...]
    residual: float
    load_error: float
    area_difference: float
    gap_difference: float
    bem_digits: int
    bem_residual: float
    bem_cpu: tuple[float, ...]
    area_error: float
    bem_area_cells: int = 0
    bem_area_error: float = 0.0
    bem_area_cpu: tuple[float, ...] = ()
    limit_apart: float | None = None
    counted_error: float | None = None
    area_cpu: tuple[float, ...] = ()

    @property
    def ratio(self) -> float | None:
        """Its time over bem's at equal residual, None where no tolerance of bem's has it."""
        return median(self.cpu) / median(self.bem_cpu) if self.bem_residual <= self.residual else None

    @property
    def area_ratio(self) -> float | None:
        """Its time over bem's at equal error of the area, None where bem does not have it."""
        return median(self.area_cpu or self.cpu) / median(self.bem_area_cpu) if self.bem_area_cells else None


@dataclass(frozen=True)
class StressBeside:
    """Six stresses of a peer below a ball's pressure, and bem's on the same points; and the highest von Mises stress,
    for which bem takes the coarsest grid with an error as small.

    axes : "periodic" or "free". cpu, bem_cpu : whatever depends on the grid is made. kept_cpu, bem_kept_cpu : it was
        made before; `kept_cpu` is empty where the peer keeps nothing. difference : largest of all components and
        points below the surface, over the largest pressure. error, bem_error : largest against the exact stresses, as
        `peer_cases.exact_error` has it.
    mises_error : of the highest von Mises stress, relative; `mises_cpu` is with its stresses. Nothing is known of
        `bem_mises_*` (0 cells) where no grid has an error as small.
    """

    peer: str
    axes: str
    cells: int
    depths: int
    cpu: tuple[float, ...]
    kept_cpu: tuple[float, ...]
    difference: float
    error: float
    bem_error: float
    bem_cpu: tuple[float, ...]
    bem_kept_cpu: tuple[float, ...]
    mises_error: float
    mises_cpu: tuple[float, ...]
    bem_mises_cells: int = 0
    bem_mises_error: float = 0.0
    bem_mises_cpu: tuple[float, ...] = ()

    @property
    def ratio(self) -> float:
        """Its time over bem's, both from nothing."""
        return median(self.cpu) / median(self.bem_cpu)

    @property
    def kept_ratio(self) -> float:
        """Its time over bem's where both keep what they can."""
        return median(self.kept_cpu or self.cpu) / median(self.bem_kept_cpu)

    @property
    def mises_ratio(self) -> float | None:
        """Its time over bem's at equal error of the highest von Mises stress, None where bem does not have it."""
        return median(self.mises_cpu) / median(self.bem_mises_cpu) if self.bem_mises_cells else None


Beside = TypeVar("Beside", CurveBeside, StressBeside)


def beside_of(kind: type[Beside], data: dict[str, Any]) -> Beside:
    """From what `asdict` gave and JSON kept."""
    names = {field.name for field in fields(kind)}
    known: dict[str, Any] = {k: tuple(v) if isinstance(v, list) else v for k, v in data.items() if k in names}
    return kind(**known)


def _ratio(value: float | None) -> str:
    return "not reached" if value is None else f"{value:.1f}"


CURVE_HEADERS: tuple[str, ...] = (
    "peer",
    "its loads begin",
    "cells",
    "its residual",
    "its CPU s",
    "bem's residual",
    "bem's CPU s",
    "ratio",
    "its error of the area, %",
    "of all its cells, %",
    "its CPU s ",
    "bem's, %",
    "bem's cells",
    "bem's CPU s ",
    "ratio ",
    "areas apart",
    "gaps apart",
    "its limit apart",
)


def curve_rows(curves: Sequence[CurveBeside]) -> list[tuple[str, ...]]:
    """Rows of words under `CURVE_HEADERS`: equal residual, then equal error of the area, then how far both agree."""
    rows: list[tuple[str, ...]] = []
    for c in curves:
        known = bool(c.bem_area_cells)
        rows.append(
            (
                *(c.peer, c.start, str(c.cells), f"{c.residual:.1e}", f"{median(c.cpu):.3g}"),
                *(f"{c.bem_residual:.1e}", f"{median(c.bem_cpu):.3g}", _ratio(c.ratio)),
                f"{100 * c.area_error:.2g}" if c.counted_error is not None else "",
                f"{100 * (c.area_error if c.counted_error is None else c.counted_error):.2g}",
                f"{median(c.area_cpu or c.cpu):.3g}",
                f"{100 * c.bem_area_error:.2g}" if known else "",
                str(c.bem_area_cells) if known else "",
                f"{median(c.bem_area_cpu):.3g}" if known else "",
                *(_ratio(c.area_ratio), f"{c.area_difference:.1e}", f"{c.gap_difference:.1e}"),
                "" if c.limit_apart is None else f"{c.limit_apart:+.1e}",
            )
        )
    return rows


STRESS_HEADERS: tuple[str, ...] = (
    "peer",
    "axes",
    "cells",
    "depths",
    "its CPU s",
    "kept",
    "bem's CPU s",
    "kept ",
    "ratio",
    "kept  ",
    "apart / p0",
    "its error / p0",
    "bem's",
)


def stress_rows(stresses: Sequence[StressBeside]) -> list[tuple[str, ...]]:
    """Rows of words under `STRESS_HEADERS`: six components on the same points."""
    return [
        (
            *(s.peer, s.axes, str(s.cells), str(s.depths), f"{median(s.cpu):.3g}"),
            f"{median(s.kept_cpu):.3g}" if s.kept_cpu else "nothing",
            *(f"{median(s.bem_cpu):.3g}", f"{median(s.bem_kept_cpu):.3g}", _ratio(s.ratio), _ratio(s.kept_ratio)),
            *(f"{s.difference:.1e}", f"{s.error:.1e}", f"{s.bem_error:.1e}"),
        )
        for s in stresses
    ]


MISES_HEADERS: tuple[str, ...] = (
    "peer",
    "axes",
    "cells",
    "depths",
    "its error, %",
    "its CPU s",
    "bem's cells",
    "bem's error, %",
    "bem's CPU s",
    "ratio",
)


def mises_rows(stresses: Sequence[StressBeside]) -> list[tuple[str, ...]]:
    """Rows of words under `MISES_HEADERS`: the highest von Mises stress at equal error."""
    return [
        (
            *(s.peer, s.axes, str(s.cells), str(s.depths), f"{100 * s.mises_error:.2g}", f"{median(s.mises_cpu):.3g}"),
            str(s.bem_mises_cells) if s.bem_mises_cells else "",
            f"{100 * s.bem_mises_error:.2g}" if s.bem_mises_cells else "",
            f"{median(s.bem_mises_cpu):.3g}" if s.bem_mises_cells else "",
            _ratio(s.mises_ratio),
        )
        for s in stresses
    ]
