"""The picture of how full the gap is: what the run holds, over time, and only where oil was carried along."""

from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.figure import Figure

from bem.plots.figures import all_figures
from bem.results.arrays import Arrays
from bem.scenes.context import Variable

pytestmark = pytest.mark.internal


def film_run(*, fraction):
    """A run with an invented film: full but for a band behind the contact."""
    x, time = np.linspace(-4e-4, 4e-4, 81), np.linspace(0, 0.02, 11)
    pressure = np.broadcast_to(np.maximum(1e9 * (1 - (x / 1e-4) ** 2), 0.0), (11, 81))
    filled = np.broadcast_to(np.where(x > 1e-4, 0.25, 1.0), (11, 81))
    variables = {
        "time": Variable(("time",), time, "s", "time"),
        "film_x": Variable(("film_x",), x, "m", "x"),
        "film_pressure": Variable(("time", "film_x"), pressure.copy(), "Pa", "film pressure"),
    }
    if fraction:
        variables["film_fraction"] = Variable(("time", "film_x"), filled.copy(), "1", "share of the gap filled")
    return SimpleNamespace(dataset=Arrays(variables, {}))


def test_filled_share_over_place_and_time():
    kind, figure = all_figures()["film-fraction"], Figure()
    kind.draw(film_run(fraction=True), figure)
    axes, bar = figure.axes
    assert axes.get_xlabel() == "x (µm)"
    assert axes.get_ylabel() == "time (ms)"
    assert bar.get_ylabel() == "share of the gap filled with oil"
    picture = axes.collections[0]
    shown = np.asarray(picture.get_array()).reshape(11, -1)
    assert shown[:, 0].min() == 1.0
    assert shown[:, -1].max() == 0.25
    assert picture.get_clim() == (0.0, 1.0)
    # half the contact's width on either side of it
    assert 150 < axes.get_xlim()[1] < 250


def test_a_film_without_it_has_no_such_figure():
    assert not all_figures()["film-fraction"].fits(film_run(fraction=False))


@pytest.mark.parametrize(("friction", "panels"), [(0.0, 2), (0.05, 3)])
def test_friction_over_time_only_where_surfaces_slide(friction, panels):
    time = np.linspace(0, 0.02, 11)
    drawn = {"speed": 1.0, "minimum_film": 2e-7, "central_film": 3e-7, "friction": friction}
    variables = {name: Variable(("time",), np.full(11, value), "1", name) for name, value in drawn.items()}
    kind, figure = all_figures()["film-over-time"], Figure()
    kind.draw(SimpleNamespace(dataset=Arrays(variables | {"time": Variable(("time",), time, "s", "time")}, {})), figure)
    assert len(figure.axes) == panels
    assert figure.axes[-1].get_xlabel() == "time (ms)"
