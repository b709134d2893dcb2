"""Colours that say what is there: percentiles for heights, a word on maps of one colour, no bands between depths."""

from itertools import pairwise

import numpy as np
import pytest

from bem.plots.figures.pressure import _one_colour
from bem.plots.figures.subsurface import _drawn_over_depth
from bem.plots.style import along_x, field_axes, height_limit, map_of_heights, named_axes
from bem.scenes.context import Variable

pytestmark = pytest.mark.internal


def test_a_spike_does_not_take_the_colours_of_a_surface():
    from matplotlib.figure import Figure

    heights = np.random.default_rng(5).normal(0, 1e-8, (64, 64))
    calm = height_limit(heights)
    heights[3, 4] = 1e-5
    assert height_limit(heights) == pytest.approx(
        calm, rel=0.05
    )  # one of 4096 heights moves the 99.8th percentile little
    assert height_limit(np.zeros((4, 4))) == 0.0
    spike = np.zeros((64, 64))
    spike[0, 0] = -2e-9
    assert height_limit(spike) == 2e-9
    figure = Figure()
    image = map_of_heights(figure, figure.add_subplot(), np.arange(64) * 1e-6, np.arange(64) * 1e-6, heights)
    low, high = image.get_clim()
    assert high == -low == pytest.approx(1e9 * height_limit(heights))
    assert image.colorbar.extend == "both"


def test_a_pressure_map_of_one_colour_says_so():
    pressure = np.zeros((16, 16))
    pressure[4:12, 4:12] = 2e9
    assert _one_colour(pressure) == "all of the cells in contact are at one pressure, 2 GPa"
    pressure[4:8] *= np.linspace(0.1, 0.9, 16)
    assert _one_colour(pressure) == "50 % of the cells in contact are at one pressure, 2 GPa"
    x = np.linspace(-1, 1, 41)
    assert _one_colour(1e9 * np.sqrt(np.maximum(0.8 - x[:, None] ** 2 - x**2, 0))) == ""
    assert _one_colour(np.zeros((4, 4))) == ""
    three = np.zeros((8, 8))
    three[3, 3:6] = 1e8, 2e8, 1e8  # a third of the contact is the cell of its highest pressure
    assert _one_colour(three) == ""
    line = np.repeat([[0.0], [1e8], [2e8], [1e8], [0.0]], 64, axis=1)
    assert _one_colour(line) == ""


def test_stress_between_depths_is_smooth_and_never_beyond_what_was_computed():
    depth = np.array([0.0, 0.5, 1.0, 3.0, 10.0])
    column = 1 / (1 + (depth - 0.8) ** 2)
    finer, drawn = _drawn_over_depth(depth, np.stack([column, 2 * column], axis=1))
    assert drawn.shape == (finer.size, 2)
    # straight lines between the even depths of the image: half of a step squared times the sharpest curvature
    np.testing.assert_allclose(np.interp(depth, finer, drawn[:, 0]), column, rtol=5e-4)
    assert drawn.max() <= 2 * column.max() * (1 + 1e-14)
    # slopes of straight lines would jump by half of themselves at a computed depth
    slope = np.diff(drawn[:, 0]) / np.diff(finer)
    deep = finer[:-1] > 3
    assert np.abs(np.diff(slope[deep])).max() < 0.1 * np.abs(slope[deep]).max()


@pytest.mark.parametrize(
    ("said", "written"),
    [("x, along rolling", "x, rolling"), ("x, along sliding", "x, sliding"), ("x", "x"),
     ("x, along the flow", "x, along the flow")],
)  # fmt: skip
def test_the_first_axis_of_a_map_is_what_the_results_call_it(said, written):
    """Maps of rolling contacts and of point films had said "sliding"."""
    from matplotlib.figure import Figure

    axes, x = Figure().add_subplot(), np.arange(4) * 1e-6
    with named_axes({"x": Variable(("x",), x, "m", said)}):
        field_axes(axes, x, x)
    assert axes.get_xlabel().startswith(f"{written} ")
    assert along_x() == "x, sliding"


@pytest.mark.parametrize("ratio", [0.25, 0.35, 0.5, 1.0])
def test_labels_along_x_of_a_narrow_map_do_not_overlap(ratio):
    """Those of a long ellipse under a ball lay on each other."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.6, 3.4), layout="constrained")
    axes = figure.subplots(1, 2)[0]
    y = np.linspace(-1.5e-3, 1.5e-3, 61)
    field_axes(axes, np.linspace(-0.6, 0.4, 31) * ratio * 3e-3, y)
    axes.set_xlim(-0.6 * ratio * 3, 0.4 * ratio * 3)
    axes.set_ylim(-1.5, 1.5)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    low, high = axes.get_xlim()
    labels = [one for one in axes.get_xticklabels() if low <= one.get_position()[0] <= high]
    boxes = sorted((one.get_window_extent(canvas.get_renderer()) for one in labels), key=lambda box: box.x0)
    assert len(boxes) > 1
    assert all(left.x1 < right.x0 for left, right in pairwise(boxes))


@pytest.mark.parametrize(("ratio", "words"), [(0.8, 30), (1.2, 45)])
def test_no_title_or_label_of_a_row_of_maps_is_cut(ratio, words):
    """Rows of maps are made lower by their blank rows, in which titles and labels along x stood."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    from bem.plots.pictures import DOTS, settle
    from bem.plots.style import said_above, style

    with style():
        figure = Figure(figsize=(8.4, 3.0), dpi=DOTS, layout="constrained")
        FigureCanvasAgg(figure)
        maps = figure.subplots(1, 5, sharey=True)
        for axes in maps:
            image = axes.imshow(np.eye(8), extent=(0, ratio * 28.8, 0, 28.8), aspect="equal")
            axes.set_title("cycle 1")
            axes.set_xlabel("x (µm)")
        maps[0].set_ylabel("y (µm)")
        figure.colorbar(image, ax=list(maps), label="contact pressure (MPa)")
        said_above(figure, "words " * words)
        settle(figure)
        boxes = [axes.get_tightbbox() for axes in figure.axes]
        above = figure._suptitle.get_window_extent().y0
    assert figure.get_figheight() < 3.0
    assert min(min(box.x0, box.y0, figure.bbox.x1 - box.x1) for box in boxes) > 0
    assert max(box.y1 for box in boxes[:-1]) < above
