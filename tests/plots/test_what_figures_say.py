"""Figures name their case, mark what is not resolved, and draw nothing where there is nothing."""

from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.figure import Figure

from bem.kinds.contact.figures import _scatter_of_places
from bem.kinds.running_in.record import _STRIP
from bem.notes.contact import LINE_APPROACH
from bem.notes.lubrication import FILM_SPIKE
from bem.plots import draw as drawing
from bem.plots.cases import case_shown, case_words
from bem.plots.compare import short_title
from bem.plots.figures import all_figures
from bem.plots.figures.keys import FIGURES as KEYS
from bem.plots.labels import beyond_ends, colour_ends, in_celsius, key_words, uniform_value
from bem.plots.style import SPIKE_LIMIT, has_unresolved_spike, map_of, mark_spike, spike_in, style
from bem.plots.sweep import fill
from bem.results.arrays import Arrays
from bem.scenes.context import Variable

pytestmark = pytest.mark.internal

X = np.linspace(-1e-5, 1e-5, 40)
RATIO = "rolling.slide_roll_ratio"


def run_of(kind, axes, variables, **more):
    scene, summary = more.get("scene", {}), {"kind": kind, **more.get("summary", {})}
    return SimpleNamespace(
        dataset=Arrays(variables, {"axes": axes}), summary=summary, scene=scene, path=more.get("path")
    )


def friction_run(speed=0.02, load=(5.5,), **summary):
    x = np.linspace(-1e-4, 1e-5, 200)
    pressure = 1e9 * np.sqrt(np.maximum(1 - (x / 1e-5) ** 2, 0))
    count = (len(load), 2, 3)
    return run_of(
        "friction",
        "load model",
        {
            "load": Variable(("load",), np.array(load), "N", "load"),
            "model": Variable(("model",), np.array(["capped", "elastic"]), "1", "model"),
            "speed": Variable(("speed",), np.array([0.001, speed, 0.4]), "m/s", "speed"),
            "shown_speed": Variable((), np.array(speed), "m/s", "speed at which the fields are shown"),
            "film_x": Variable(("film_x",), x, "m", "x"),
            "film_pressure": Variable(("film_x",), pressure, "Pa", "film pressure"),
            "film_thickness": Variable(("film_x",), np.full(200, 1e-7), "m", "film thickness"),
            "contact_load": Variable(("load", "model", "speed"), np.ones(count), "N", "load on contact"),
            "film_load": Variable(("load", "model", "speed"), np.ones(count), "N", "load on the film"),
            "minimum_film": Variable(("load", "model", "speed"), np.full(count, 1e-7), "m", "minimum film"),
        },
        summary=summary,
    )


def drawn_figure(run, name, tmp_path, monkeypatch):
    """The figure that `draw` makes, as a matplotlib object."""
    kept = []
    monkeypatch.setattr("bem.plots.pictures.write", lambda figure, *rest: kept.append(figure) or [])
    drawing.draw(run, all_figures()[name], tmp_path)
    return kept[0]


def test_a_film_says_at_which_speed_and_load_it_is(tmp_path, monkeypatch):
    for speed, load in ((0.02, 5.5), (0.3, 8.0)):
        run = friction_run(speed, (load, 20.0))
        title = drawn_figure(run, "film-pressure", tmp_path, monkeypatch).get_suptitle()
        assert f"{speed:g} m/s" in title
        assert f"{load:g} N" in title
        assert "20 N" not in title
    assert "capped" in drawn_figure(friction_run(), "load-sharing", tmp_path, monkeypatch).get_suptitle()


def test_a_map_of_the_first_of_several_cases_names_it(tmp_path, monkeypatch):
    maps = np.ones((3, 40, 40)) * np.linspace(1, 2, 40)[None, :, None]
    for loads, said in (([1.0, 2.0, 5.0], "1 N"), ([2.5], "")):
        run = run_of(
            "contact",
            "load",
            {
                "load": Variable(("load",), np.array(loads), "N", "load"),
                "x": Variable(("x",), X, "m", "x"),
                "y": Variable(("y",), X, "m", "y"),
                "pressure": Variable(("load", "x", "y"), 1e9 * maps[: len(loads)], "Pa", "contact pressure"),
            },
        )
        assert drawn_figure(run, "pressure-map", tmp_path, monkeypatch).get_suptitle().endswith(said)
        assert bool(case_words(run.dataset)) == bool(said)


def test_the_last_case_is_named_where_the_last_is_kept():
    data = Arrays(
        {
            "load": Variable(("load",), np.array([1.0, 4.0]), "N", "load"),
            "temperature": Variable(("temperature",), np.array([293.15, 353.15]), "K", "temperature"),
            "height_after": Variable(("x", "y"), np.zeros((4, 4)), "m", "height"),
        },
        {"axes": "load temperature"},
    )
    assert case_shown(data, "wear", ["height_after"]) == "4 N, 80 °C"
    assert case_shown(data, "wear", ["load"]) == ""


def pressures(spike):
    """Places over the half-width, and a Hertz pressure [GPa] with a spike of some height before the outlet."""
    x = np.linspace(-2.5, 1.5, 401)
    return x, np.sqrt(np.maximum(1 - x**2, 0)) + spike * np.exp(-(((x - 0.85) / 0.02) ** 2))


@pytest.mark.parametrize("spike", [0.4, 1.0, 20.0])
def test_an_unresolved_spike_leaves_the_pressure_axis_to_the_rest(spike):
    x, pressure = pressures(spike)
    axes = Figure().add_subplot()
    axes.plot(x, pressure)
    mark_spike(axes, x, pressure)
    assert axes.get_ylim()[1] == pytest.approx(SPIKE_LIMIT, rel=0.01)  # the rest reaches 1
    assert len(axes.texts) == 1
    assert axes.texts[0].xy[0] == pytest.approx(0.85, abs=0.02)
    first, peak, last = spike_in(x, pressure)
    assert x[first] < 0.85 < x[last]
    assert x[peak] == pytest.approx(0.85, abs=0.02)


def test_a_pressure_without_a_spike_is_left_as_it_is():
    x, pressure = pressures(0.0)
    assert spike_in(x, pressure) is None
    axes = Figure().add_subplot()
    axes.plot(x, pressure)
    before = axes.get_ylim()
    mark_spike(axes, x, pressure)
    assert axes.get_ylim() == before
    assert not axes.texts


def spike(where):
    return FILM_SPIKE(where, remedy="").as_dict()


def test_a_spike_of_another_case_is_not_this_ones():
    notes = {"notes": [spike(f"{RATIO} 0.01; {RATIO} 0.02")]}
    assert has_unresolved_spike(notes, f"{RATIO} 0.01")
    assert not has_unresolved_spike(notes, f"{RATIO} 0.5")
    assert has_unresolved_spike({"notes": [spike("")]}, f"{RATIO} 0.5")
    assert not has_unresolved_spike({"notes": ["another"]})


def traction_run(cases, notes=()):
    x, pressure = pressures(5.0)
    oil = 343.15 + np.arange(cases)[:, None] + np.zeros_like(x)
    rows = {f"{name}_surface_temperature": oil - 0.5 for name in ("lower", "upper")} | {"oil_temperature": oil}
    variables = {name: Variable((RATIO, "x"), row, "K", "temperature") for name, row in rows.items()}
    variables |= {
        RATIO: Variable((RATIO,), 0.01 * np.arange(cases), "1", RATIO),
        "x": Variable(("x",), x, "1", "x over the Hertz half-width"),
        "pressure": Variable((RATIO, "x"), 1e9 * np.tile(pressure, (cases, 1)), "Pa", "film pressure"),
        "thickness": Variable((RATIO, "x"), np.full((cases, 401), 2e-7), "m", "film thickness"),
        "film_temperature": Variable((RATIO,), oil[:, 0], "K", "oil in the contact, mean by pressure"),
        "film_rise": Variable((RATIO,), oil[:, 0] - 343.15, "K", "that over the cooler body's bulk"),
    }
    scene = {"over": {RATIO: list(0.01 * np.arange(cases))}}
    return run_of("traction", RATIO, variables, scene=scene, summary={"notes": list(notes)})


def test_the_first_films_spike_is_clipped_where_its_own_note_says_so(tmp_path, monkeypatch):
    for note, clipped in ((spike(""), True), (spike(f"{RATIO} 0.02"), False)):
        figure = drawn_figure(traction_run(4, [note]), "rolling-film", tmp_path, monkeypatch)
        assert (figure.axes[0].get_ylim()[1] < 2) == clipped
        assert "slide-to-roll ratio 0" in figure.get_suptitle()


@pytest.mark.parametrize(("cases", "shown"), [(1, 1), (5, 5), (6, 6), (41, 6)])
def test_every_curve_of_film_temperatures_is_in_the_legend(cases, shown):
    figure = Figure()
    all_figures()["film-temperatures"].draw(traction_run(cases), figure)
    (axes,) = figure.axes
    entries = [text.get_text() for text in axes.get_legend().get_texts()]
    assert sum("oil" in entry for entry in entries) == shown
    assert (f"of {cases} cases" in axes.get_title()) == (shown < cases)


def test_temperatures_over_keys_are_in_celsius_and_keys_have_names():
    figure, (kind,) = Figure(), KEYS
    run = traction_run(4)
    assert kind.applies(run)
    kind.draw(run, figure)
    (axes,) = (axes for axes in figure.axes if "temperature" in axes.get_ylabel())
    assert "°C" in axes.get_ylabel()
    np.testing.assert_allclose(axes.lines[0].get_ydata(), [70.0, 71.0, 72.0, 73.0])
    assert all(each.get_xlabel() == "slide-to-roll ratio" for each in figure.axes)
    still = {"temperature": Variable(("load",), np.array([300.0, 310.0]), "K", "of the oil")}
    still |= {"load": Variable(("load",), np.array([1.0, 2.0]), "N", "load")}
    figure = Figure()
    fill(figure, still, {"load": "list"}, ("temperature",))
    np.testing.assert_allclose(figure.axes[0].lines[0].get_ydata(), [26.85, 36.85])


def test_differences_of_temperature_stay_in_kelvin():
    assert in_celsius(300.0, "K", "oil_temperature")[1] == "°C"
    for name, words in (("film_rise", ""), ("film_temperature_error", ""), ("t", "error of oil in the contact")):
        assert in_celsius(3.0, "K", name, words) == (3.0, "K")
    assert in_celsius(3.0, "Pa", "pressure") == (3.0, "Pa")
    assert key_words("lower.surface.elongation") == "elongation (lower)"
    assert key_words("load", "load of the contact") == "load of the contact"


def mapped(values, **more):
    figure = Figure()
    side = [1e-6 * np.arange(n) for n in values.shape]
    with style():
        return map_of(figure, figure.add_subplot(), *side, values, "pressure", "Pa", **more), figure


def test_a_field_of_one_value_has_one_colour_and_says_so():
    noise = 83.3337e6 * (1 + 1e-6 * np.random.default_rng(1).normal(size=(20, 20)))
    image, figure = mapped(noise)
    assert np.ptp(image.get_array()) == 0
    low, high = image.get_clim()
    assert low < 80
    assert high > 87
    assert "uniform" in figure.axes[1].get_ylabel()
    assert uniform_value(np.full((3, 3), np.nan)) is None
    assert uniform_value(np.zeros((3, 3))) == 0.0
    image, figure = mapped(noise * np.linspace(1, 1.1, 20))
    assert np.ptp(image.get_array()) > 0
    assert "uniform" not in figure.axes[1].get_ylabel()


def test_a_bar_says_where_its_colours_end_and_how_far_values_go():
    values = np.linspace(0, 10e6, 400).reshape(20, 20)
    values[3, 3] = 32e6
    image, figure = mapped(values, ends=(0.0, 13e6))
    assert image.get_clim() == (0.0, 13.0)
    assert image.colorbar.extend == "max"
    assert {"13", "32"} <= set(figure.axes[1].get_ylabel().replace(";", " ").split())
    image, _ = mapped(values)
    assert image.colorbar.extend == "neither"
    assert beyond_ends((-1.0, 1.0), (-3.0, 4.0))[0] == "both"
    assert beyond_ends((0.0, 1.0), (0.0, 1.0)) == ("neither", "")
    smooth = np.linspace(0, 1, 1000)
    assert colour_ends(smooth, 0.2, 99.8) == (0.0, 1.0)
    assert colour_ends(np.append(smooth, 50.0), 0.2, 99.8)[1] < 1.01


@pytest.mark.parametrize("shape", [(300, 2), (3, 200)])
def test_a_map_of_a_few_rows_is_drawn_as_lines(shape):
    values = np.random.default_rng(2).random(shape)
    image, figure = mapped(values)
    assert image is None
    (axes,) = figure.axes
    assert not axes.images
    assert len(axes.lines) == min(shape)
    assert len(axes.lines[0].get_xdata()) == max(shape)
    run = SimpleNamespace(dataset=SimpleNamespace(sizes=dict(zip("xy", shape, strict=True))))
    from bem.plots.figures import wide_enough

    assert not wide_enough(run)


def test_flat_figures_over_keys_and_films_that_are_nowhere_are_not_drawn():
    (kind,) = KEYS
    for spread, drawn in ((0.0, False), (1e-8, False), (0.01, True)):
        run = traction_run(3)
        for name, unit in (("film_temperature", "K"), ("film_rise", "K")):
            flat = Variable((RATIO,), 350.0 * (1 + spread * np.arange(3)), unit, name)
            run.dataset.variables[name] = Arrays({name: flat}, {})[name]
        assert kind.applies(run) == drawn
    films = all_figures()
    empty = SimpleNamespace(
        dataset=Arrays(
            {name: Variable(("x", "y"), np.zeros((9, 9)), "m", name) for name in ("film_map", "wear_rate")}, {}
        )
    )
    assert not films["film-map"].applies(empty)
    assert not films["film-wear-rate"].applies(empty)


@pytest.mark.parametrize(("notes", "drawn"), [((), True), ((LINE_APPROACH(reason="steady").as_dict(),), False)])
def test_approaches_that_cannot_be_compared_are_not_drawn_over_speeds(notes, drawn):
    """Of a rolling line contact the approach is not comparable between speeds; nothing else differs here."""
    key = "contact.rolling_speed"
    variables = {
        key: Variable((key,), np.array([1e-3, 1.0, 1e3]), "m/s", key),
        "approach": Variable((key,), np.array([392e-6, 180e-6, -388e-6]), "m", "approach"),
    }
    summary = {"notes": list(notes)}
    run = run_of("contact", key, variables, scene={"over": {key: [1e-3, 1.0, 1e3]}}, summary=summary)
    (kind,) = KEYS
    assert kind.applies(run) is drawn


def way_run():
    place = 1e-3 * np.linspace(-4, 6, 11)
    rows = {
        "central_thickness": (2e-7, "m"),
        "minimum_thickness": (1e-7, "m"),
        "traction_coefficient": (0.05, "1"),
        "friction_power": (3.0, "W"),
        "hertz_pressure": (1e9, "Pa"),
    }
    variables = {name: Variable(("position",), np.full(11, value), unit, name) for name, (value, unit) in rows.items()}
    variables["position"] = Variable(("position",), place, "m", "place along the way")
    speeds = {"lower_speed": (5 + 500 * place).tolist(), "upper_speed": (5 - 500 * place).tolist()}
    scene = {"along": {"position": place.tolist(), "load": (100.0 + np.arange(11)).tolist(), **speeds}}
    return run_of("traction", "position", variables, scene=scene)


def test_the_way_of_a_gear_has_its_loads_pressures_and_sliding_speed():
    figure = Figure()
    run = way_run()
    all_figures()["along-the-way"].draw(run, figure)
    by_name = {axes.get_ylabel().replace("\n", " "): axes for axes in figure.axes}
    sliding = by_name["sliding speed (m/s)"].lines[0].get_ydata()
    np.testing.assert_allclose(sliding, 1000 * np.asarray(run.scene["along"]["position"]))
    np.testing.assert_allclose(by_name["load (N)"].lines[0].get_ydata(), 100.0 + np.arange(11))
    assert by_name["Hertz pressure (GPa)"].lines[0].get_ydata()[0] == pytest.approx(1.0)
    marks = [line.get_xdata()[0] for line in by_name["film thickness (nm)"].lines if line.get_linestyle() == ":"]
    assert marks == pytest.approx([0.0])  # pure rolling


def test_surfaces_of_gears_are_those_of_pinion_and_wheel():
    """The path of contact of a gear pair, whose lower body is the pinion, had lower and upper surfaces."""
    for marks, names in (({}, {"lower surface", "upper surface"}), ({"A": -4e-3, "B": None}, {"pinion", "wheel"})):
        run = traction_run(3)
        run.scene["along"] = {"marks": marks}
        figure = Figure()
        all_figures()["film-temperatures"].draw(run, figure)
        shown = {text.get_text().split(" (")[0] for text in figure.axes[0].get_legend().get_texts()}
        assert names <= shown


@pytest.mark.parametrize(
    ("places", "letters"),
    [
        ((-4.0, -1.5, 0.0, 2.5, 6.0), ["A", "B", "C", "D", "E"]),
        ((-4.0, 0.8, 0.0, 1.1, 6.0), ["A", "C", "B D", "E"]),  # near a contact ratio of 2
    ],
)
def test_the_way_of_a_gear_has_its_letters_and_none_lies_on_another(places, letters):
    figure, run = Figure(figsize=(5.5, 10.5)), way_run()
    marks = {name: 1e-3 * place for name, place in zip("ABCDE", places, strict=True)}
    run.scene["along"]["marks"] = marks
    all_figures()["along-the-way"].draw(run, figure)
    figure.draw_without_rendering()
    top = figure.axes[0]
    texts = sorted((text for text in top.texts if text.get_text()), key=lambda text: text.xy[0])
    assert [text.get_text() for text in texts] == letters
    boxes = [text.get_window_extent() for text in texts]
    assert not any(a.overlaps(b) for a, b in pairwise(boxes))
    for axes in figure.axes[:3]:
        lines = {line.get_xdata()[0] for line in axes.lines if line.get_linestyle() == ":"}
        assert sorted(lines) == pytest.approx(sorted({*places, 0.0}))


def test_no_text_of_a_figure_is_smaller_than_eight_points(tmp_path, monkeypatch):
    for run, name in ((friction_run(), "load-sharing"), (traction_run(5), "film-temperatures")):
        figure = drawn_figure(run, name, tmp_path, monkeypatch)
        for axes in figure.axes:
            texts = [*axes.get_xticklabels(), *axes.get_yticklabels(), axes.xaxis.label, axes.title]
            texts += axes.get_legend().get_texts() if axes.get_legend() else []
            assert min(text.get_fontsize() for text in texts if text.get_text()) >= 8


def test_rounding_errors_of_a_component_get_no_panel():
    loads = {"load": Variable(("load",), np.array([1.0, 2.0, 3.0]), "N", "load")}
    force = Variable(("load",), np.array([300.0, 700.0, 1500.0]), "N", "force")
    for across, panels in (([-7e-6, 5e-7, 1e-8], 1), ([-7.0, 5.0, 1.0], 2)):
        figure = Figure()
        side = Variable(("load",), np.array(across), "N", "force across")
        fill(
            figure, loads | {"force_N": force, "force_across_N": side}, {"load": "list"}, ("force_N", "force_across_N")
        )
        assert len(figure.axes) == panels


def test_a_pressure_at_the_hardness_has_no_bar_in_the_figure_of_a_sweep():
    def over_load(values):
        return Variable(("load",), np.array(values), "1", "values")

    figure = Figure()
    pressures = {
        "load": Variable(("load",), np.array([1.0, 2.0, 3.0]), "N", "load"),
        "max_pressure_Pa": over_load([6.5e9, 7e9, 7e9]),
        "max_pressure_Pa_error": over_load([1e8, 5.9e7, 120.0]),
        "plastic_area_fraction": over_load([0.0, 1e-4, 1e-3]),
    }
    fill(figure, pressures, {"load": "list"}, ("max_pressure_Pa",))
    (bars,) = (item for item in figure.axes[0].collections if hasattr(item, "get_segments"))
    heights = [segment[1, 1] - segment[0, 1] for segment in bars.get_segments()]
    assert [height > 0 for height in heights] == [True, False, False]


def test_a_panel_that_leaves_lines_out_says_how_many():
    for count in (8, 12):
        load = Variable(("load",), np.arange(1.0, 3.0), "N", "load")
        ratio = Variable(("ratio",), np.arange(float(count)), "1", "ratio")
        friction = Variable(("load", "ratio"), np.arange(2.0 * count).reshape(2, count), "1", "friction")
        figure = Figure()
        fill(figure, {"load": load, "ratio": ratio, "friction": friction}, dict.fromkeys(("load", "ratio"), "list"), ())
        (axes,) = figure.axes
        assert len(axes.lines) == 8
        assert (f"8 of {count}" in axes.get_title()) == (count > 8)


def points_of(pressure, index):
    """Arrays of a sweep over mean pressure and seed, as its dataset names them."""
    dimensions = ("contact.mean_pressure", "seed")
    area = np.full((3, 2), 0.01)
    return {
        "reduced_pressure": Variable(dimensions, pressure, "1", "nominal pressure"),
        "contact_area_fraction": Variable(dimensions, area, "1", "area"),
        "slope_plasticity_index": Variable(dimensions, index, "1", "plasticity index"),
    }


def test_area_over_load_of_a_sweep_has_all_points_and_the_plastic_limit():
    """Area at the hardness: load / (hardness x nominal area) = (p / E* h') (E* h' / H)."""
    pressure = np.outer([1e-3, 1e-2, 1e-1], [1.0, 1.1])
    kind = all_figures()["area-over-load"]
    for index, marked in ((np.full((3, 2), 4.0), False), (np.outer(np.ones(3), [4.0, 5.0]), True)):
        figure = Figure()
        run = run_of("contact", "", points_of(pressure, index))
        assert kind.fits(run)
        kind.draw(run, figure)
        lines = {line.get_label(): line for line in figure.axes[0].lines}
        x, y = lines["plastic limit: load / hardness"].get_data()
        if marked:  # another limit for each point, never more than all of the area
            np.testing.assert_allclose(x, pressure.ravel())
            np.testing.assert_allclose(y, np.minimum(pressure * index, 1.0).ravel(), rtol=1e-12)
        else:
            np.testing.assert_allclose(y, 4.0 * x, rtol=1e-12)
        points = next(item for item in figure.axes[0].containers if item.get_label() == "computed")
        np.testing.assert_allclose(points.lines[0].get_xdata(), pressure.ravel())


def test_every_point_of_area_over_load_has_both_of_its_bars_and_the_legend_says_which():
    """Bars had no name: some had the scatter from place to place in mind, which no bar showed."""
    area = np.array([1e-4, 2e-3, 3e-2])
    found = {
        "reduced_pressure": np.array([1e-4, 1e-3, 1e-2]),
        "contact_area_fraction": area,
        "contact_area_fraction_error": 0.1 * area,
        "contact_spots": np.array([4.0, 25.0, 400.0]),
    }
    figure = Figure()
    variables = {name: Variable(("load",), values, "1", name) for name, values in found.items()}
    all_figures()["area-over-load"].draw(run_of("contact", "", variables), figure)
    bars = {item.get_label(): item.lines[2][0].get_segments() for item in figure.axes[0].containers}
    half = {name: [0.5 * np.ptp(one[:, 1]) for one in each] for name, each in bars.items()}
    np.testing.assert_allclose(half["computed ± numerical error"], 0.1 * area, rtol=1e-12)
    scatter = half["scatter from place to place, by contact spots"]
    np.testing.assert_allclose(scatter, area * [0.25, 0.1, 0.025], rtol=1e-12)
    (legend,) = (one for one in figure.axes[0].get_children() if one.__class__.__name__ == "Legend")
    assert {text.get_text() for text in legend.get_texts()} > set(half)


def test_area_over_load_of_small_areas_has_no_empty_half():
    """Areas of 1e-4 stood below four empty decades up to full contact."""
    small = {"reduced_pressure": np.full(1, 1e-4), "contact_area_fraction": np.full(1, 2e-4)}
    figure = Figure()
    all_figures()["area-over-load"].draw(
        run_of("contact", "", {name: Variable(("load",), values, "1", name) for name, values in small.items()}), figure
    )
    highest = max(float(np.max(line.get_ydata())) for line in figure.axes[0].lines if len(line.get_ydata()))
    assert highest < figure.axes[0].get_ylim()[1] <= 2.1 * highest


def test_the_scatter_of_places_is_seen_beside_the_marker():
    """Its light bar hid behind the marker: the legend named what nobody saw."""
    axes = Figure().add_subplot()
    run = run_of("contact", "load", {"contact_spots": Variable(("load",), np.array([400.0]), "1", "spots")})
    axes.errorbar([0.01], [0.02], fmt="o", markersize=4)
    _scatter_of_places(run, axes, np.array([0.01]), np.array([0.02]), np.array([True]))
    (bars,) = axes.collections
    assert min(bars.get_linewidth()) > 4 + axes.lines[0].get_markeredgewidth()


def test_a_long_title_of_a_comparison_is_whole():
    """It ended in "in the contact region (Hertz' ..."."""
    whole = f"Sq {_STRIP}, unworn"
    assert short_title(whole) == "Sq of the wearing body, the lower one of two, in the contact region, unworn"
    after = short_title(f"Sq {_STRIP}, after each cycle; after the last one it is Sq_final")
    assert after == "Sq of the wearing body, the lower one of two, in the contact region, after each cycle"
    assert short_title("friction (mean)") == "friction (mean)"
    assert short_title("word " * 40).endswith(" ...")
