"""Ticks of a figure that is being laid out and drawn, looked for once for each state of their axis.

A layout asks each axis a dozen times where its ticks are, what is written at them and how large that is, and drawing
asks again; in between, most axes have not moved. Here an axis answers from what it found, as long as its limits and its
place on the figure, in dots, are what they were.

Knows matplotlib's inside, nothing of results. Verified in tests/plots/test_quick_ticks.py: pictures have the bytes that
they have without it; a matplotlib made differently is left as it is. Tried with matplotlib 3.11.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from matplotlib.axis import Axis

_FIND, _MEASURE = "_update_ticks", "_get_ticklabel_bboxes"


@contextmanager
def ticks_found_once() -> Iterator[None]:
    """In the block, for figures of which nothing is changed there but places; nothing where matplotlib is made
    differently. An axis in space looks anew: its ticks go with the eye, too."""
    find, measure = (vars(Axis).get(name) for name in (_FIND, _MEASURE))
    if find is None or measure is None:
        yield
        return
    found: dict[Axis, tuple[Any, list[Any]]] = {}
    measured: dict[Axis, tuple[Any, Any]] = {}

    def state(axis: Axis) -> Any:
        low, high = axis.get_view_interval()
        return float(low), float(high), axis.axes.bbox.bounds, axis.axes.figure.dpi

    def quickly_found(axis: Axis) -> Any:
        if axis.axes.name != "rectilinear":
            return find(axis)
        now, (then, ticks) = state(axis), found.get(axis, (None, []))
        if now != then:
            ticks = find(axis)
            found[axis] = (now, ticks)
        return list(ticks)

    def quickly_measured(axis: Axis, ticks: list[Any], renderer: Any = None) -> Any:
        if axis.axes.name != "rectilinear":
            return measure(axis, ticks, renderer)
        now, (then, boxes) = (state(axis), ticks, renderer), measured.get(axis, (None, ([], [])))
        if now != then:
            boxes = measure(axis, ticks, renderer)
            measured[axis] = (now, boxes)
        return tuple(list(some) for some in boxes)

    setattr(Axis, _FIND, quickly_found)
    setattr(Axis, _MEASURE, quickly_measured)
    try:
        yield
    finally:
        setattr(Axis, _FIND, find)
        setattr(Axis, _MEASURE, measure)
