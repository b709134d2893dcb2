"""Animations of a figure of which little moves: the rest is drawn once.

Knows nothing of results. Verified in tests/plots/test_animation.py: frames are as if each were drawn anew.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from matplotlib.backends.backend_agg import FigureCanvasAgg
from PIL import Image

if TYPE_CHECKING:
    from matplotlib.figure import Figure


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
    show : changes them to what frame i shows. count : of frames, not less than one.
    path : of the file. dots : per inch. per_second : frames.
    """
    canvas = figure.canvas
    assert isinstance(canvas, FigureCanvasAgg)
    figure.dpi = dots
    show(0)
    if figure.get_layout_engine() is not None:
        figure.draw_without_rendering()
        figure.set_layout_engine("none")
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
        size = canvas.get_width_height(physical=True)
        picture = Image.frombytes("RGBA", size, bytes(canvas.buffer_rgba()))
        frames.append(picture.convert("RGB"))
    frames[0].save(path, format="gif", save_all=True, append_images=frames[1:], duration=int(1000 / per_second), loop=0)
