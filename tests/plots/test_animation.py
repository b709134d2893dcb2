"""What does not move is drawn once, and nobody sees it."""

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image, ImageSequence

from bem.plots.animation import write_animation
from bem.plots.style import style

pytestmark = pytest.mark.internal


def moving_figure(values):
    figure = Figure(figsize=(3.0, 4.0), layout="constrained")
    FigureCanvasAgg(figure)
    above, below = figure.subplots(2, 1)
    image = above.imshow(values[0], vmin=0, vmax=1)
    above.set_ylabel("height")
    (line,) = below.plot(values[0][0])
    below.set_ylim(0, 1)

    def show(index):
        image.set_data(values[index])
        line.set_ydata(values[index][0])
        above.set_title(f"frame {index}")

    return figure, (image, line, above.title), show


def test_frames_are_as_if_each_were_drawn_anew(tmp_path, monkeypatch):
    values = np.random.default_rng(1).random((4, 8, 8))
    drawn, draw = [], Axes.draw
    with style():
        figure, moving, show = moving_figure(values)
        monkeypatch.setattr(Axes, "draw", lambda self, renderer: drawn.append(self) or draw(self, renderer))
        write_animation(figure, moving, show, len(values), tmp_path / "moving.gif", dots=80, per_second=5)
        assert len(drawn) <= 2 * len(figure.axes)  # for the layout, and what does not move
        anew, _, show = moving_figure(values)
        anew.dpi = 80
        show(0)
        anew.draw_without_rendering()
        anew.set_layout_engine("none")
        with Image.open(tmp_path / "moving.gif") as animation:
            assert animation.n_frames == len(values)
            assert animation.info["loop"] == 0
            for index, frame in enumerate(ImageSequence.Iterator(animation)):
                assert frame.info["duration"] == 200
                show(index)
                anew.canvas.draw()
                wanted = np.asarray(anew.canvas.buffer_rgba())[..., :3].astype(float)
                away = np.abs(np.asarray(frame.convert("RGB")) - wanted)
                assert away.mean() < 1.5  # of 255: a GIF has 256 colours
                assert np.percentile(away, 99) < 40


def test_colours_of_all_frames_are_looked_for_once(tmp_path, monkeypatch):
    values = np.random.default_rng(2).random((4, 8, 8))
    looked, look = [], Image.Image.quantize
    monkeypatch.setattr(Image.Image, "quantize", lambda self, *given: looked.append(self.size) or look(self, *given))
    with style():
        figure, moving, show = moving_figure(values)
        for axes in figure.axes[1:]:
            axes.remove()
        write_animation(figure, moving[:1], lambda i: show(i), 4, tmp_path / "moving.gif", dots=80, per_second=5)
    (size,) = looked
    dots = 240 * 320
    assert dots < size[0] * size[1] < 4 * dots  # what does not change is looked at once
    with Image.open(tmp_path / "moving.gif") as animation:
        assert animation.convert("RGB").getpixel((0, 0)) == (255, 255, 255)


def test_a_single_frame_is_a_picture(tmp_path):
    with style():
        figure, moving, show = moving_figure(np.zeros((1, 4, 4)))
        write_animation(figure, moving, show, 1, tmp_path / "still.gif", dots=80, per_second=4)
    with Image.open(tmp_path / "still.gif") as picture:
        assert picture.size == (240, 320)
