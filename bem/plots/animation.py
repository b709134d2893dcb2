"""Animations of a figure of which little moves: the rest is drawn once, and all frames have one palette.

Knows nothing of results. Verified in tests/plots/test_animation.py: frames are as if each were drawn anew.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from numpy.typing import NDArray
from PIL import Image

from bem.plots.pictures import settle

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_COLOURS = 256
"""Colours of a GIF."""


def write_animation(
    figure: Figure,
    moving: Sequence[Any],
    show: Callable[[int], None],
    count: int,
    path: Path,
    *,
    dots: float,
    per_second: float,
) -> None:
    """Write a GIF that begins anew at its end.

    Parameters
    ----------
    figure : with its canvas, of constrained layout or settled.
    moving : artists of its axes that change between frames, titles among them; they are drawn in this order, over what
        does not change, with the spines of their axes over them.
    show : changes them to what frame i shows.
    count : of frames, not less than one.
    path : of the file.
    dots : per inch.
    per_second : frames.
    """
    canvas = figure.canvas
    assert isinstance(canvas, FigureCanvasAgg)
    figure.dpi = dots
    show(0)
    settle(figure)
    spines = [spine for axes in dict.fromkeys(item.axes for item in moving) for spine in axes.spines.values()]
    over = [*moving, *spines]
    for item in over:
        item.set_animated(True)
    canvas.draw()
    rest = canvas.copy_from_bbox(figure.bbox)
    frames = []
    for index in range(count):
        show(index)
        canvas.restore_region(rest)
        for item in over:
            item.draw(canvas.get_renderer())
        frames.append(np.array(canvas.buffer_rgba()).view(np.uint32)[..., 0])  # dots are compared whole
    first, *more = _of_one_palette(np.stack(frames))
    first.save(path, format="gif", save_all=True, append_images=more, duration=int(1000 / per_second), loop=0)


def _of_one_palette(frames: NDArray[np.uint32]) -> list[Any]:
    """Frames (count, rows, columns), of red, green, blue and opacity in a dot, as pictures in the colours that all of
    them together need: looked for once, and in a dot that never changes once."""
    first = frames[0]
    moves = np.zeros(first.shape, np.bool_)
    for frame in frames[1:]:
        moves |= frame != first
    seen = np.concatenate([first.reshape(-1), frames[:, moves].reshape(-1)])
    colours = np.ascontiguousarray(seen.view(np.uint8).reshape(1, -1, 4)[..., :3])
    palette = Image.fromarray(colours).quantize(_COLOURS)
    numbers = np.asarray(palette)[0]
    still = numbers[: first.size].reshape(moves.shape)
    found = []
    for changed in numbers[first.size :].reshape(len(frames), -1):
        shown = still.copy()
        shown[moves] = changed
        picture = Image.fromarray(shown)
        picture.putpalette(palette.getpalette() or [])
        found.append(picture)
    return found
