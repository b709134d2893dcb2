"""Pictures for the browser: plain values in the unit that is written beside them, errors as bars."""

import json

import numpy as np
import pytest

from bem.app.pictures import (
    curve_names,
    curve_picture,
    figure_picture,
    figures_over,
    is_map,
    layers_of,
    map_names,
    map_picture,
    regimes,
    scaled,
    sections_picture,
    told_pictures,
)
from bem.app.solids import MOST_PARTICLES, PARTICLES, cases_of, field_picture, solid_names, solid_picture
from bem.results.arrays import Arrays
from bem.scenes.context import Variable

pytestmark = pytest.mark.internal

X, Y = np.linspace(-5e-6, 5e-6, 40), np.linspace(-4e-6, 4e-6, 30)
HEIGHTS = 1e-7 * np.sin(2e6 * X)[:, None] * np.cos(1e6 * Y)[None, :]


def test_a_map_is_in_the_units_it_shows_and_turned_as_the_browser_wants():
    picture = map_picture(HEIGHTS, (X, Y), "height", "m")
    json.dumps(picture, allow_nan=False)
    trace = picture["data"][0]
    assert np.shape(trace["z"]) == (30, 40)
    assert trace["colorbar"]["title"]["text"] == "nm"
    np.testing.assert_allclose(np.array(trace["z"]).T, 1e9 * HEIGHTS, rtol=2e-6, atol=1e-12)
    assert picture["layout"]["xaxis"]["title"]["text"].endswith("(µm)")


def test_lone_spikes_do_not_take_the_colours():
    spiked = HEIGHTS.copy()
    spiked[3, 4] = 1e-3
    trace = map_picture(spiked, (X, Y), "height", "m")["data"][0]
    assert trace["zmax"] < 1e-2 * np.nanmax(np.array(trace["z"], dtype=float))


def test_colours_may_reach_the_extremes():
    spiked = HEIGHTS.copy()
    spiked[3, 4] = 1e-3
    picture = map_picture(spiked, (X, Y), "height", "m", whole=True)
    trace = picture["data"][0]
    np.testing.assert_allclose(trace["zmax"], np.nanmax(np.array(trace["z"], dtype=float)), rtol=1e-5)
    assert "end" not in trace["colorbar"]["title"]["text"]


def test_regimes_of_a_stribeck_curve_meet_where_the_load_share_passes_their_limits():
    """Between 1 and 10 mm/s the share falls from 1 to 0 over the logarithm of the speed: 0.9 at 10**0.1 mm/s."""
    summary = {"speed_m_s": [1.0, 1e-3, 1e-2], "contact_load_N": [0.0, 2.0, 0.0], "film_load_N": [2.0, 0.0, 2.0]}
    found = regimes(summary)
    assert [name for *_, name in found] == ["boundary", "mixed", "full film"]
    np.testing.assert_allclose([first for first, *_ in found], [1e-3, 10**-2.9, 10**-2.01], rtol=5e-3)
    np.testing.assert_allclose([last for _, last, _ in found], [10**-2.9, 10**-2.01, 1.0], rtol=5e-3)
    summary["friction"] = [0.01, 0.1, 0.02]
    shapes = figure_picture(summary, "friction", "speed_m_s")["layout"]["shapes"]
    assert [one["label"]["text"] for one in shapes] == ["boundary", "mixed", "full film"]
    assert regimes(summary | {"contact_load_N": [0.0, 0.0, 0.0]}) == []  # all of it is one
    assert regimes({"speed_m_s": [1.0, 2.0]}) == []


def test_a_figure_over_a_varied_key_is_in_the_units_of_both():
    summary = {"over": {"contact.load": "N"}, "contact.load": [1000.0, 2000.0], "approach_m": [1e-6, 2e-6]}
    assert figures_over(summary) == [("approach_m", "contact.load")]
    picture = figure_picture(summary, "approach_m", "contact.load")
    assert picture["data"][0]["x"] == [1.0, 2.0]
    assert picture["layout"]["xaxis"]["title"]["text"] == "load (kN)"
    assert picture["data"][0]["y"] == [1.0, 2.0]
    assert picture["layout"]["yaxis"]["title"]["text"] == "µm"


def test_figures_told_on_the_way_stand_over_steps_or_speeds():
    history = {
        "contact": {"total": 100, "points": [[10, {"residual": 1e-2}], [80, {"residual": 1e-6}]]},
        "speeds": {"total": 5, "points": [[1, {"speed": 0.1, "friction": 0.12}], [2, {"speed": 0.2, "friction": 0.1}]]},
    }
    residual, friction = told_pictures(history)
    json.dumps([residual, friction], allow_nan=False)
    assert (residual["data"][0]["x"], residual["layout"]["yaxis"]["type"]) == ([10, 80], "log")
    assert friction["data"][0]["x"] == [0.1, 0.2]


def test_missing_points_are_gaps_and_large_maps_are_thinned():
    large = np.zeros((1000, 500))
    large[0, 0] = np.nan
    x, y = np.arange(1000) * 1e-6, np.arange(500) * 1e-6
    picture = map_picture(large, (x, y), "height", "m")
    json.dumps(picture, allow_nan=False)
    assert max(np.shape(picture["data"][0]["z"])) <= 384
    assert "every 3rd cell" in picture["layout"]["title"]["text"]


def test_sections_go_through_the_place():
    picture = sections_picture(HEIGHTS, (X, Y), (10, 20), "height", "m")
    along_x, along_y = picture["data"]
    assert len(along_x["y"]) == 40
    assert along_x["y"][10] == pytest.approx(along_y["y"][20])


def test_curves_have_their_error_bars():
    variables = {
        "speed": Variable(("speed",), np.array([0.001, 0.1]), "m/s", "speed"),
        "load": Variable(("load",), np.array([1.0, 2.0]), "N", "load"),
        "friction": Variable(("load", "speed"), np.array([[0.1, 0.05], [0.12, 0.06]]), "1", "friction"),
        "friction_error": Variable(("load", "speed"), np.full((2, 2), 0.01), "1", "error of friction"),
        "map": Variable(("load", "x", "y"), np.zeros((2, 4, 4)), "Pa", "pressure"),
    }
    arrays = Arrays(variables, {})
    assert curve_names(arrays) == ["friction"]
    picture = curve_picture(arrays, "friction")
    assert [trace["name"] for trace in picture["data"]] == ["load 1 N", "load 2 N"]
    assert picture["data"][0]["error_y"]["array"] == [0.01, 0.01]
    assert picture["layout"]["xaxis"]["type"] == "log"
    assert map_names(arrays) == ["map"]
    assert layers_of(arrays, "map") == ["load 1 N", "load 2 N"]


def test_figures_of_the_summary_are_drawn_over_what_they_run_over():
    summary = {
        "speed_m_s": [0.1, 1.0],
        "friction": [0.1, None],
        "friction_error": [0.01, None],
        "model": ["a", "b"],
        "friction_spread": [0.0, 0.0],
    }
    assert figures_over(summary) == [("friction", "speed_m_s")]
    trace = figure_picture(summary, "friction", "speed_m_s")["data"][0]
    assert trace["y"] == [0.1, None]
    assert trace["error_y"]["array"] == [0.01, None]


def test_areas_and_volumes_are_shown_in_units_of_their_side():
    assert scaled([0.0, 9e-13], "m^2") == (pytest.approx(1e18), "nm²")
    assert scaled([3e-12], "m^2") == (pytest.approx(1e12), "µm²")
    assert scaled([5e-19], "m^3") == (pytest.approx(1e27), "nm³")


def test_a_field_in_space_is_where_it_was_with_depth_downwards():
    depth = np.array([0.0, 1e-6, 3e-6])
    values = 1e6 * (1 + depth[:, None, None] * 1e6 + 0 * X[None, :, None] + 0 * Y[None, None, :])
    picture = field_picture(values, (depth, X, Y), "stress", "Pa")
    json.dumps(picture, allow_nan=False)
    trace = picture["data"][0]
    deepest = np.array(trace["z"]) == -3.0
    assert set(np.array(trace["value"])[deepest]) == {4.0}  # MPa
    assert trace["colorbar"]["title"]["text"] == "MPa"
    large = field_picture(np.ones((10, 200, 200)), (np.arange(10.0), *[np.arange(200.0)] * 2), "stress", "Pa")
    assert len(large["data"][0]["value"]) <= 32_000
    assert "every 4th cell" in large["layout"]["title"]["text"]


def test_particles_in_space_have_their_sizes_and_places():
    count = MOST_PARTICLES + 5
    sizes = {"length": 4e-7, "width": 2e-7, "thickness": 1e-7}
    rows = {name: np.full((2, count), value) for name, value in sizes.items()}
    rows |= {"x": np.tile(np.linspace(-2e-6, 2e-6, count), (2, 1)), "y": np.zeros((2, count))}
    rows["length"][1, 7] = 8e-7  # the largest one of the second case
    rows["width"][1, -3:] = np.nan  # places that no particle took
    variables = {f"particle_{k}": Variable(("load", "particle"), v, "m", k) for k, v in rows.items()}
    variables["load"] = Variable(("load",), np.array([1.0, 2.0]), "N", "load")
    variables["stress"] = Variable(("load", "depth", "x", "y"), np.ones((2, 3, 4, 4)), "Pa", "stress")
    arrays = Arrays(variables, {})
    assert list(solid_names(arrays)) == ["stress", PARTICLES]
    assert cases_of(arrays, PARTICLES) == cases_of(arrays, "stress") == ["load 1 N", "load 2 N"]
    picture = solid_picture(arrays, PARTICLES, 1)
    json.dumps(picture, allow_nan=False)
    assert f"{MOST_PARTICLES} of {count - 3} particles" in picture["layout"]["title"]["text"]
    trace = picture["data"][0]
    first = {axis: np.array(trace[axis][: len(trace["x"]) // MOST_PARTICLES]) for axis in "xyz"}
    assert [float(np.ptp(first[axis])) for axis in "xyz"] == pytest.approx([0.8, 0.2, 0.1], rel=0.06)  # a rough ball
    assert first["z"].max() == pytest.approx(0.0, abs=1e-6)
    assert first["x"].mean() == pytest.approx(1e6 * rows["x"][1, 7], abs=1e-3)
    assert max(max(trace[axis]) for axis in "ijk") < len(trace["x"])


def test_a_bar_in_the_browser_says_where_its_colours_end():
    spiked = 13e9 * (1 + HEIGHTS / 1e-7) / 2
    spiked[3, 4] = 32e9
    trace = map_picture(spiked, (X, Y), "pressure", "Pa")["data"][0]
    assert trace["zmax"] < 13.1
    assert "32" in trace["colorbar"]["title"]["text"].replace(";", " ").replace("<br>", " ").split()
    calm = map_picture(HEIGHTS, (X, Y), "height", "m")["data"][0]
    assert calm["zmax"] == pytest.approx(1e9 * HEIGHTS.max())


def test_noise_does_not_fill_the_colours_of_the_browser():
    noise = 83.3337e6 * (1 + 1e-6 * np.random.default_rng(3).normal(size=(40, 30)))
    trace = map_picture(noise, (X, Y), "pressure", "Pa")["data"][0]
    assert np.ptp(trace["z"]) == 0
    assert trace["zmin"] < 80 < 87 < trace["zmax"]
    assert "uniform" in trace["colorbar"]["title"]["text"]
    picture = sections_picture(noise, (X, Y), (10, 20), "pressure", "Pa")
    low, high = picture["layout"]["yaxis"]["range"]
    assert low == 0 < 84 < high


def test_a_hairline_map_becomes_lines_in_the_browser():
    x, y = np.arange(300) * 1e-6, np.arange(2) * 1e-6
    picture = map_picture(np.random.default_rng(4).random((300, 2)), (x, y), "pressure", "Pa")
    assert not is_map(picture)
    assert [len(trace["y"]) for trace in picture["data"]] == [300, 300]
    long = map_picture(np.ones((300, 20)) * x[:, None], (x, np.arange(20) * 1e-6), "pressure", "Pa")
    assert is_map(long)
    assert "scaleanchor" not in long["layout"]["yaxis"]


def test_a_film_is_cropped_on_the_page_as_in_its_figure():
    """The mesh reaches 50 half-widths into the inlet, where the gap is thousands of films high."""
    x = np.linspace(-350e-3, 7e-3, 3571)
    pressure = 5e6 * np.sqrt(np.clip(1 - (x / 5e-3) ** 2, 0, None))
    variables = {
        "film_pressure": Variable(("film_x",), pressure, "Pa", "film pressure"),
        "film_thickness": Variable(("film_x",), 2e-6 + x**2 / 12, "m", "film thickness"),
        "film_x": Variable(("film_x",), x, "m", "x on the film's own mesh"),
    }
    arrays = Arrays(variables, {"film_x": variables["film_x"]})
    layout = curve_picture(arrays, "film_thickness")["layout"]
    low, high = layout["xaxis"]["range"]
    assert (low, high) == pytest.approx((-7.5, 7.5), rel=0.02)
    assert layout["xaxis"]["title"]["text"].endswith("(mm)")
    assert layout["yaxis"]["range"] == pytest.approx([0.0, 8.0])
    assert layout["yaxis"]["title"]["text"] == "µm"
    assert curve_picture(arrays, "film_pressure")["layout"]["xaxis"]["range"] == [low, high]
    alone = Arrays({name: item for name, item in variables.items() if name != "film_thickness"}, arrays.coords)
    assert "range" not in curve_picture(alone, "film_pressure")["layout"]["xaxis"]  # kind film is shown whole


def test_the_browser_draws_no_empty_charts_and_names_case_and_temperature():
    variables = {
        "speed": Variable(("speed",), np.array([0.001, 0.1]), "m/s", "speed"),
        "radius": Variable(("speed",), np.full(2, np.nan), "m", "radius of the particles"),
        "worn": Variable(("speed",), np.zeros(2), "m", "depth worn"),
        "oil_temperature": Variable(("speed",), np.array([343.15, 353.15]), "K", "oil in the contact"),
        "iteration": Variable(("iteration",), np.arange(3.0), "1", "iteration"),
        "residual_history": Variable(("iteration",), np.array([1.0, 1e-4, 1e-9]), "1", "residual"),
    }
    arrays = Arrays(variables, {})
    assert curve_names(arrays) == ["oil_temperature", "residual_history"]
    picture = curve_picture(arrays, "oil_temperature", "0.01 m/s, 5.5 N")
    assert picture["data"][0]["y"] == pytest.approx([70.0, 80.0])
    assert picture["layout"]["yaxis"]["title"]["text"] == "°C"
    assert "0.01 m/s, 5.5 N" in picture["layout"]["title"]["text"]
    axis = curve_picture(arrays, "residual_history")["layout"]["yaxis"]
    assert (axis["type"], axis["exponentformat"]) == ("log", "power")
    summary = {"speed_m_s": [0.1, 1.0], "worn_depth_nm": [0.0, 0.0], "radius_nm": [None, None], "friction": [0.1, 0.2]}
    assert figures_over(summary) == [("friction", "speed_m_s")]
