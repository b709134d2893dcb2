"""Sketches of tasks and kinds of scene in lines, as SVG that follows the colours of the page.

Verified in tests/app/test_starts.py.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

_FLAT = '<path d="M6 42H114"/>'
_ROUGH = '<path d="M6 42l5-3 4 4 6-6 5 5 6-3 5 4 6-6 5 4 6-3 5 4 6-5 5 5 6-4 5 3 6-5 5 5 6-3 5 3 5-3 4 3"/>'
_BALL = '<circle cx="60" cy="20" r="18"/>'
_AXES = '<path d="M20 6V48H108" opacity=".6"/>'


def _line(d: str) -> str:
    """A line in the accent colour."""
    return f'<path class="bem-accent" d="{d}"/>'


def _area(d: str) -> str:
    """An area in the accent colour."""
    return f'<path class="bem-accent bem-filled" d="{d}"/>'


def _dots(places: Sequence[tuple[float, float, float]]) -> str:
    """Filled circles of (x, y, radius)."""
    return "".join(f'<circle class="bem-accent bem-filled" cx="{x}" cy="{y}" r="{r}"/>' for x, y, r in places)


def _gear(x: float, y: float, radius: float, teeth: int) -> str:
    """A wheel with teeth."""
    corners = []
    for number in range(4 * teeth):
        angle, outer = math.pi * (number - 0.5) / (2 * teeth), number % 4 < 2
        length = radius * (1.0 if outer else 0.78)
        corners.append(f"{x + length * math.cos(angle):.1f} {y + length * math.sin(angle):.1f}")
    return f'<path d="M{"L".join(corners)}Z"/><circle cx="{x}" cy="{y}" r="{radius / 4:.1f}"/>'


_ARROW = '<path class="bem-accent" d="M{x} {y}h{l}m-5-4l5 4-5 4"/>'
_SKETCHES = {
    "contact": _ROUGH + _BALL + _line("M48 40h24"),
    "asperities": '<path d="M6 14H114M6 44H114"/>'
    + "".join(f'<path d="M{x} 44a13 28 0 0 1 26 0"/>' for x in (12, 47, 82))
    + _line("M20 16h10M55 16h10M90 16h10"),
    "partial-slip": _FLAT + _BALL + _line("M22 14h16m-5-4l5 4-5 4M98 26h-16m5-4l-5 4 5 4"),
    "rolling": _FLAT
    + '<circle cx="60" cy="23" r="19"/><path d="M60 23v-19"/>'
    + _line("M85 10a29 29 0 0 1 4 20m-5-4l5 5 4-6"),
    "surface-temperature": _ROUGH
    + _BALL
    + _line("M44 52q-3-3 0-6M60 52q-3-3 0-6M76 52q-3-3 0-6")
    + _dots([(60, 39, 3)]),
    "traction": _AXES + _line("M20 48C30 14 44 12 56 14S90 22 108 26"),
    "film": _area("M6 24Q48 40 60 40T108 40V46H6Z") + '<path d="M6 46H114M16 6A52 40 0 0 0 104 6"/>',
    "point-film": '<circle cx="60" cy="28" r="24"/><circle cx="60" cy="28" r="19"/>'
    + _line("M74 16a18 18 0 1 0 0 24")
    + '<circle cx="58" cy="28" r="9"/>',
    "point-film-time": '<circle cx="60" cy="28" r="24"/><circle cx="60" cy="28" r="18"/>'
    + _dots([(48, 28, 5)])
    + _ARROW.format(x=58, y=28, l=20),
    "flow-factors": '<path d="M6 12l8 4 8-5 9 6 9-5 8 4 9-6 9 5 8-4 9 5 8-4 9 4 8-4'
    'M6 46l8-5 8 6 9-5 9 4 8-6 9 6 9-4 8 5 9-6 8 5 9-4 8 5"/>'
    + _ARROW.format(x=20, y=29, l=22)
    + _ARROW.format(x=62, y=29, l=30),
    "friction": _AXES + _line("M24 14C44 14 48 40 64 40S92 32 106 22"),
    "wear": _ROUGH + _dots([(34, 26, 3), (50, 18, 4), (68, 27, 2.5), (82, 16, 3.5)]),
    "running-in": _AXES
    + _line("M24 12C34 34 48 38 106 39")
    + '<path d="M24 24l6 3 5-4 6 6 5-3 7 5 6-3 7 4 7-2 8 2 9-1 8 1 8 0" opacity=".6"/>',
    "running-in-life": _AXES
    + _line("M24 14C34 36 60 30 74 32S98 34 106 20")
    + '<path d="M42 48v-3M64 48v-3M86 48v-3"/>',
    "particles": _dots([(24, 18, 5), (44, 36, 3), (58, 16, 4), (74, 34, 6), (92, 18, 3), (100, 40, 4), (30, 42, 2.5)])
    + '<path d="M6 6H114V50H6Z" opacity=".6"/>',
    "tribofilm": _BALL
    + _area("M14 42q4-6 10 0zM32 42q6-8 14 0zM52 42q6-7 16 0zM76 42q6-9 14 0zM98 42q4-6 10 0z")
    + _FLAT,
    "surfaces": "".join(
        f'<path d="M{8 + 6 * i} {46 - 9 * i}q8-{12 - i} 16-2t16-2 16 2 16-4 16 3" opacity="{1 - 0.15 * i:.2f}"/>'
        for i in range(4)
    ),
    "coating": _area("M6 38H114V44H6Z") + '<path d="M6 38H114M6 44H114"/>' + '<circle cx="60" cy="20" r="18"/>',
    "bearing": '<circle cx="60" cy="28" r="25"/><circle cx="60" cy="28" r="11"/>'
    + _dots([(60 + 18 * math.cos(a), 28 + 18 * math.sin(a), 5) for a in (0.3 + math.pi / 4 * i for i in range(8))]),
    "gear": _gear(41, 28, 22, 9) + _gear(80, 28, 22, 9),
    "cam": '<path d="M46 32a14 14 0 0 0 28 0C74 22 66 14 60 14S46 22 46 32Z"/><circle cx="60" cy="32" r="3"/>'
    + _line("M42 13h36M56 13V3h8v10"),
    "ring": '<path d="M30 4V52M90 4V52M36 52V16h48V52"/>' + _line("M30 24h6M84 24h6M30 34h6M84 34h6M36 24h48M36 34h48"),
    "bush": '<circle cx="60" cy="28" r="25"/><circle cx="60" cy="28" r="19"/><circle cx="60" cy="30" r="17"/>'
    + _line("M46 41a19 19 0 0 0 28 0"),
}


def sketch(name: str) -> str:
    """The sketch of a task or kind as SVG; of one that has none, a rough surface."""
    drawn = _SKETCHES.get(name, _ROUGH)
    return f'<svg viewBox="0 0 120 56" class="bem-sketch" aria-hidden="true" focusable="false">{drawn}</svg>'


def has_sketch(name: str) -> bool:
    """Return True if a task or kind has a sketch of its own."""
    return name in _SKETCHES
