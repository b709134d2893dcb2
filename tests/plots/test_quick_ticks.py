"""Ticks looked for once: the same picture by fewer questions, and a matplotlib made differently is left as it is."""

from contextlib import suppress

import pytest
from matplotlib.axis import Axis
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from bem.plots import pictures, quick_ticks
from bem.plots.quick_ticks import ticks_found_once
from bem.plots.style import map_of, style

pytestmark = pytest.mark.internal


def panels(figure):
    """Shared axes, a second scale, a logarithmic one, a map with its bar, and one in space."""
    import numpy as np

    upper, lower = figure.subplots(4, 1)[:2]
    upper.sharex(lower)
    upper.semilogy([1.0, 2.0, 3.0], [1e-12, 1e-3, 1.0])
    lower.plot([1.0, 2.0, 3.0], [1.0, 20000.0, 3.0], label="line")
    lower.twinx().plot([1.0, 2.0, 3.0], [1e-9, 2e-9, 3e-9])
    lower.legend()
    lower.set_title("right", loc="right")
    along = np.linspace(0.0, 1e-3, 12)
    map_of(figure, figure.axes[2], along, along[:6], np.outer(along, along[:6]), "product", "m")
    figure.delaxes(figure.axes[3])
    figure.add_subplot(4, 1, 4, projection="3d").plot([0.0, 1.0], [0.0, 1.0], [0.0, 5.0])


def drawn(folder, name):
    with style():
        figure = Figure(figsize=(5.0, 9.0), dpi=90, layout="constrained")
        FigureCanvasAgg(figure)
        panels(figure)
        pictures.settle(figure)
        (path,) = pictures.write(figure, folder, name, ("png",))
    return path.read_bytes()


@pytest.fixture
def looked(monkeypatch):
    """Axes that looked for their ticks, each time that they did."""
    found, real = [], Axis._update_ticks
    monkeypatch.setattr(Axis, "_update_ticks", lambda self: found.append(self) or real(self))
    return found


def test_a_picture_has_the_bytes_of_one_whose_ticks_are_looked_for_each_time(tmp_path, looked, monkeypatch):
    once = drawn(tmp_path, "once")
    few = len([axis for axis in looked if axis.axes.name == "rectilinear"])
    axes = {axis for axis in looked if axis.axes.name == "rectilinear"}
    looked.clear()
    monkeypatch.setattr(quick_ticks, "_FIND", "no such thing")
    assert drawn(tmp_path, "anew") == once
    many = len([axis for axis in looked if axis.axes.name == "rectilinear"])
    assert few <= 4 * len(axes)  # twice for the layout, once where it brings them, and before a scale is shared
    assert many > 2.5 * few


def test_what_moves_is_looked_for_again(looked):
    figure = Figure(dpi=90)
    FigureCanvasAgg(figure)
    axis = figure.add_subplot().xaxis
    with ticks_found_once():
        first = [tick.get_loc() for tick in axis._update_ticks()]
        assert [tick.get_loc() for tick in axis._update_ticks()] == first
        assert len(looked) == 1
        axis.axes.set_xlim(0.0, 50.0)
        second = [tick.get_loc() for tick in axis._update_ticks()]
        assert len(looked) == 2
        assert max(second) == 50.0 > max(first)
        figure.set_size_inches(1.0, 1.0)
        assert len(axis._update_ticks()) < len(second)
        assert len(looked) == 3


def test_matplotlib_is_as_it_was_after_it():
    before = dict(vars(Axis))
    with suppress(ValueError), ticks_found_once():
        assert dict(vars(Axis)) != before
        raise ValueError
    assert dict(vars(Axis)) == before
