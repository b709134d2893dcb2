"""Pictures of contacts that are not the source's, or of which something failed: nothing measured elsewhere beside them,
no empty axes, no warnings."""

import warnings
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.image import imread

from bem.kinds.contact import figures as contact
from bem.kinds.friction import figures as friction
from bem.kinds.friction import friction_map
from bem.kinds.point_film import figures as point_film
from bem.kinds.running_in import figures as running_in
from bem.kinds.running_in_life import figures as running_in_life
from bem.kinds.surface_temperature.figures import highest_in_words
from bem.kinds.wear import figures as wear
from bem.notes.friction import BOUNDARY_LUBRICATION, POINT_FILM_SCALED
from bem.plots import draw as drawing
from bem.plots.cases import along
from bem.plots.figures import all_figures
from bem.plots.report import with_error
from bem.plots.style import start_at_zero
from bem.plots.sweep import fill
from bem.plots.tables import figure_tables
from bem.scenes.context import Variable

pytestmark = pytest.mark.internal

CURVES = ("stribeck-curve", "load-sharing", "contact-temperatures", "running-in-stribeck", "particle-radius-over-speed")
CYCLES = {"cycles": {"settled": 2}}


def run_of(scene=None, **variables):
    return SimpleNamespace(dataset=xr.Dataset(variables, attrs={"axes": "load"}), scene=scene or CYCLES, summary={})


def drawn(draw, run):
    figure = Figure()
    draw(run, figure)
    return figure


def over_load(radius, **scene):
    return run_of(
        CYCLES | scene, radius=(("load", "cycle"), np.asarray(radius)), load=("load", [1.0, 2.0]), cycle=[1.0, 2.0]
    )


def over_speed(**scene):
    return run_of(CYCLES | scene, speed=[0.01, 1.0], particle_equivalent_radius=("speed", [2e-7, 1e-7]))


def words_of(figure):
    return [text.get_text() for text in figure.axes[0].get_legend().get_texts()]


def test_measurements_of_the_source_stand_beside_its_own_contacts_alone():
    radius = [[2e-7, 1e-7], [2e-7, 3e-7]]
    for draw, run, paper in (
        (wear._over_load, over_load, "paper C, figure 7a"),
        (running_in._radius_over_speed, lambda _, **scene: over_speed(**scene), "paper D, figure 9"),
    ):
        assert any("light scattering" in text for text in words_of(drawn(draw, run(radius, redoes=paper))))
        assert not any("light scattering" in text for text in words_of(drawn(draw, run(radius))))


def test_sizes_of_particles_are_not_drawn_where_none_came_off():
    sized = {kind.name: kind for kind in wear.FIGURES if "radius" in kind.needs}
    assert set(sized) == {"particle-radius-over-cycles", "radius-over-load", "particle-shapes"}
    none, some = over_load(np.full((2, 2), np.nan)), over_load([[np.nan, 1e-7], [np.nan, np.nan]])
    for run in (none, some):  # worn by a law, by pieces
        run.dataset["removed"] = ("x", "y"), np.eye(3)
    for kind in sized.values():
        assert not kind.applies(none)
        assert kind.applies(some)


def test_a_speed_that_failed_is_not_a_number_and_warns_of_nothing():
    run = run_of(speed=[1.0, 0.1], friction=("speed", [np.nan, 0.1]))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        speed, mean, _, _ = along(run, "friction", "speed")
    np.testing.assert_array_equal(speed, [0.1, 1.0])
    np.testing.assert_array_equal(mean, [0.1, np.nan])


def test_one_speed_is_no_curve():
    curves = [kind for kind in (*friction.FIGURES, *running_in.FIGURES) if kind.name in CURVES]
    assert len(curves) == len(CURVES)
    for kind in curves:
        assert not kind.applies(run_of(speed=[0.1], particle_equivalent_radius=[1e-7]))
        assert kind.applies(run_of(speed=[0.1, 1.0], particle_equivalent_radius=("speed", [1e-7, 0.0])))


def test_particles_are_not_drawn_where_none_come_off():
    (kind,) = (each for each in running_in.FIGURES if each.name == "particle-radius-over-speed")
    assert not kind.applies(run_of(speed=[0.1, 1.0], particle_equivalent_radius=("speed", [0.0, 0.0])))


def test_a_scar_deeper_than_the_roughness_is_told_apart():
    x = 1e-6 * np.arange(8)
    before = 1e-8 * np.sin(np.add.outer(np.arange(8), np.arange(8)))
    run = run_of(x=x, y=x, height_before=(("x", "y"), before), height_after=(("x", "y"), before - 1e-6))
    after = drawn(wear._worn_surface, run).axes[1].images[0]
    shown = np.clip(after.get_array(), *after.get_clim())
    assert np.unique(np.round(shown, 6)).size > 10  # 15 different heights, a few cut off at the ends of the scale


def test_a_lone_deep_hole_leaves_the_scale_of_worn_heights_in_their_unit():
    x = 1e-6 * np.arange(30)
    before = 1e-7 * np.sin(np.add.outer(np.arange(30), np.arange(30)))
    after = before.copy()
    after[3, 4] = -2e-6  # micrometres, where all else is told in nanometres
    run = run_of(x=x, y=x, height_before=(("x", "y"), before), height_after=(("x", "y"), after))
    low, high = drawn(wear._worn_surface, run).axes[1].images[0].get_clim()
    assert -101 < low < -90
    assert 90 < high < 101


def test_a_curve_at_one_speed_shows_its_error_bar():
    summary = {"friction": [0.06765], "friction_error": [0.00119], "film_load_N": [985.0], "film_load_N_error": [None]}
    assert with_error("friction", summary) == ("friction coefficient", "0.06765 ± 0.0012")
    assert with_error("film_load_N", summary) == ("film load", "985 N (no error bar)")


def test_a_minimum_of_a_film_extrapolated_in_load_is_not_shown():
    """The ball's film was 204 nm and lambda 1.45 beside a note that they are not to be used, in the long text alone."""
    note = POINT_FILM_SCALED("speed 2 m/s: film", reason="thin", factors="").as_dict()
    summary = {"speed_m_s": [1.0, 2.0], "lambda_ratio": [0.5, 1.45], "lambda_ratio_error": [0.1, None], "notes": [note]}
    (table,) = figure_tables(summary, ["speed_m_s", "lambda_ratio"])
    assert [cells[-1] for cells in table.rows] == ["0.5 ± 0.1", "–"]
    alone = {"minimum_film_whole_nm": [204.2], "minimum_film_whole_nm_error": [None], "notes": [note]}
    assert with_error("minimum_film_whole_nm", alone)[1] == "-"
    assert with_error("minimum_film_whole_nm", alone | {"notes": []})[1] == "204.2 nm (no error bar)"


def test_the_least_load_of_a_film_is_an_upper_bound():
    """In boundary lubrication the row had "5 (0 to 10.5) mN", the least load that the balance looks for."""
    note = BOUNDARY_LUBRICATION(share=1e-5, reason="load").as_dict()
    summary = {"speed_m_s": [1.0, 2.0], "film_load_N": [0.005, 300.0], "film_load_N_error": [0.0055, 2.5]}
    (table,) = figure_tables(summary | {"notes": [note]}, ["speed_m_s", "film_load_N"])
    assert [cells[-1] for cells in table.rows] == ["below 0.005", "300 ± 2.5"]
    alone = {"film_load_N": [0.005], "film_load_N_error": [0.0055], "notes": [note]}
    assert with_error("film_load_N", alone) == ("film load", "below 5 mN")
    assert with_error("film_load_N", alone | {"notes": []})[1] == "5 (0 to 10.5) mN"


def test_force_over_load_of_rolling_is_no_friction_coefficient():
    """Of a contact that sticks in part it is 0.2266 for `friction = 0.3`."""
    rolling = {"kind": "rolling", "traction_coefficient": 0.2266}
    assert with_error("traction_coefficient", rolling)[0] == "traction coefficient, force over load"
    assert with_error("traction_coefficient", rolling | {"kind": "traction"})[0] == "friction coefficient"
    lists = {"kind": "rolling", "load_N": [1.0, 2.0], "traction_coefficient": [0.2, 0.3]}
    (table,) = figure_tables(lists, ["load_N", "traction_coefficient"])
    assert table.head[-1] == "traction coefficient, force over load"


def test_a_scatter_by_the_oil_stands_beside_a_missing_numerical_error_bar():
    summary = {"friction": 0.04, "friction_error": None, "friction_oil_scatter": 0.006, "notes": []}
    assert with_error("friction", summary)[1] == "0.04 (no numerical error bar), ± 0.006 (oil)"


def test_errors_of_hundreds_are_written_without_a_power_of_ten():
    summary = {"speed_m_s": [1.0, 2.0], "film_load_N": [300.0, 500.0], "film_load_N_error": [114.0, 2.5]}
    (table,) = figure_tables(summary, ["speed_m_s", "film_load_N"])
    assert [cells[-1] for cells in table.rows] == ["300 ± 110", "500 ± 2.5"]
    film = {"film_load_N": 0.3145, "film_load_N_error": 0.114}
    assert with_error("film_load_N", film) == ("film load", "314.5 ± 110 mN")


def test_an_interval_ends_where_what_a_figure_can_be_ends():
    """Areas have no sign, shares are no more than one, friction may be negative; the summary keeps the error."""
    shown = {"worn_depth_nm": "2 (0 to 5) nm", "stick_fraction": "90 (70 to 100) %", "friction": "0.002 ± 0.003"}
    figures = {"worn_depth_nm": 2.0, "stick_fraction": 0.9, "friction": 0.002, "contact_share": [0.05, 0.5]}
    errors = {"worn_depth_nm": 3.0, "stick_fraction": 0.2, "friction": 0.003, "contact_share": [0.1, 0.1]}
    summary = {**figures, **{f"{name}_error": error for name, error in errors.items()}, "speed_m_s": [1.0, 2.0]}
    assert {name: with_error(name, summary)[1] for name in shown} == shown
    (table,) = figure_tables(summary, ["speed_m_s", "contact_share"])
    assert [cells[-1] for cells in table.rows] == ["0.05 (0 to 0.15)", "0.5 ± 0.1"]


def test_an_interval_of_nothing_is_left_out():
    """Full contact was shown as 100 (100 to 100) %."""
    shown = {3e-6: "100 %", 3e-4: "100 (99.97 to 100) %", 3e-2: "100 (97 to 100) %"}
    for error, words in shown.items():
        summary = {"contact_area_fraction": 1.0, "contact_area_fraction_error": error}
        assert with_error("contact_area_fraction", summary)[1] == words
    columns = {"speed_m_s": [1.0, 2.0], "contact_area_fraction": [1.0, 0.5]}
    (table,) = figure_tables(
        columns | {"contact_area_fraction_error": [3e-6, 0.1]}, ["speed_m_s", "contact_area_fraction"]
    )
    assert [cells[-1] for cells in table.rows] == ["100", "50 ± 10"]


def test_sections_of_a_film_show_the_highest_pressure_of_either():
    """The row's limit was set by the first; a bump beside its line was cut."""
    x = y = 1e-6 * (np.arange(9) - 4.0)
    pressure = np.full((9, 9), 0.5e9)
    pressure[4, 7] = 1.0e9
    run = run_of(x=x, y=y, thickness=(("x", "y"), np.full((9, 9), 1e-7)), pressure=(("x", "y"), pressure))
    (kind,) = (each for each in point_film.FIGURES if each.name == "point-film-sections")
    figure = drawn(kind.draw, run)
    limits = {axes.get_ylim() for axes in figure.axes[2:]}
    ((low, high),) = limits
    assert low == 0
    assert 1.0 < high < 1.2


def test_panels_over_keys_name_each_unit_once():
    """The summary's key ends in nm, the array beside it is in m."""
    films = Variable(("speed",), np.array([1e-7, 2e-7]), "m", "film at the centre")
    speeds = Variable(("speed",), np.array([0.1, 0.2]), "m/s", "speed")
    figure = Figure()
    fill(figure, {"central_thickness_nm": films, "speed": speeds}, {"speed": "list"}, ("central_thickness_nm",))
    assert figure.axes[0].get_ylabel() == "central film thickness (nm)"


def test_angles_over_keys_are_in_degrees_as_in_tables():
    """The table has contact_angle_deg, the array beside it is in radians."""
    angles = Variable(("lateral",), np.radians([1.5, 30.0]), "rad", "contact angle")
    errors = Variable(("lateral",), np.radians([0.1, 0.2]), "rad", "contact angle")
    shifts = Variable(("lateral",), np.array([0.001, 0.002]), "m", "shift")
    figure = Figure()
    variables = {"contact_angle_deg": angles, "contact_angle_deg_error": errors, "lateral": shifts}
    fill(figure, variables, {"lateral": "list"}, ("contact_angle_deg",))
    (axes,) = figure.axes
    assert axes.get_ylabel() == "contact angle (°)"
    assert axes.lines[0].get_ydata() == pytest.approx([1.5, 30.0])
    ((_, _, (bars,)),) = axes.containers
    assert [float(np.ptp(segment[:, 1])) for segment in bars.get_segments()] == pytest.approx([0.2, 0.4])


def test_panels_over_keys_have_the_error_bars_of_their_points():
    """They were in the table of the sweep and not in its picture; a point without one is drawn bare."""
    films = Variable(("speed",), np.array([1e-7, 2e-7, 3e-7]), "m", "film")
    errors = films.with_values(np.array([1e-9, np.nan, 3e-9]), "m")
    speeds = Variable(("speed",), np.array([0.1, 0.2, 0.3]), "m/s", "speed")
    figure = Figure()
    variables = {"film": films, "film_error": errors, "speed": speeds}
    fill(figure, variables, {"speed": "list"}, ("film",))
    (axes,) = figure.axes
    ((_, _, (bars,)),) = axes.containers
    lengths = [float(np.ptp(segment[:, 1])) for segment in bars.get_segments()]
    assert lengths == pytest.approx([2.0, 0.0, 6.0])  # nm, on both sides


def test_seeds_are_points_at_whole_numbers():
    """A line led from seed to seed, over ticks at 1.5."""
    found = Variable(("seed",), np.array([1e-7, 3e-7, 2e-7]), "m", "approach")
    figure = Figure()
    fill(figure, {"approach": found, "seed": Variable(("seed",), np.arange(1, 4), "1", "seed")}, {"seed": "list"}, ())
    (line,) = figure.axes[0].lines
    assert line.get_linestyle() == "None"
    assert all(tick == round(tick) for tick in figure.axes[0].get_xticks())


def test_the_panel_of_what_was_asked_for_is_left_out():
    """Load over contact.load was the first of four panels."""
    asked = np.array([1.0, 10.0, 100.0])
    variables = {
        "contact.load": Variable(("contact.load",), asked, "N", "load"),
        "load": Variable(("contact.load",), asked * (1 + 1e-9), "N", "load"),
        "approach": Variable(("contact.load",), 1e-7 * asked ** (2 / 3), "m", "approach"),
    }
    figure = Figure()
    fill(figure, variables, {"contact.load": "logarithmic"}, ("load", "approach"))
    assert [axes.get_ylabel().split(" (")[0] for axes in figure.axes] == ["approach"]


def test_the_surface_of_one_body_leaves_no_half_empty():
    heights = np.random.default_rng(3).normal(0, 1e-7, (16, 16))
    x = y = 1e-6 * np.arange(16.0)
    (kind,) = (each for each in contact.FIGURES if each.name == "surface-maps")
    one = run_of(x=x, y=y, lower_height=(("x", "y"), heights))
    both = one.dataset.assign(upper_height=(("x", "y"), heights))
    widths = [drawn(kind.draw, run).get_figwidth() for run in (one, SimpleNamespace(dataset=both, scene=CYCLES))]
    assert widths == [kind.size[0] / 2, kind.size[0]]


def test_maps_of_friction_fill_their_figure_however_long_the_patch_is():
    """Of a patch twice as long as wide they were small, one below the other in a wide figure."""
    kind = friction_map.FRICTION_MAP
    for cells in ((16, 16), (32, 16), (64, 16)):
        x, y = (1e-6 * (np.arange(n) - (n - 1) / 2) for n in cells)
        stress = np.full(cells, 1e8)
        stress[::4] = 0.0
        run = run_of(
            x=x, y=y, boundary_stress=(("x", "y"), stress), oil_stress=(("x", "y"), 1e8 - stress),
            shown_speed=0.1, speed=[0.1], boundary_part=("speed", [0.1]), film_part=("speed", [0.1]),
        )  # fmt: skip
        figure = Figure(figsize=kind.size, layout="constrained")
        kind.draw(run, figure)
        figure.draw_without_rendering()
        left = min(axes.get_tightbbox().x0 for axes in figure.axes) / figure.bbox.width
        assert left < 0.1, cells


def test_a_map_without_anything_on_it_is_not_drawn():
    """Oil that carries a thousandth of the friction left half of the figure empty."""
    kind = friction_map.FRICTION_MAP
    x, y = (1e-6 * (np.arange(cells) - (cells - 1) / 2) for cells in (16, 28))
    stress = np.full((16, 28), 1e8)
    shares = {4e-3: "96.2 % of friction\noil between them: 3.8 %,\nat stresses too small to show"}
    shares |= {1e-6: "100.0 % of friction", -1e-4: "100.0 % of friction"}  # it was 100.1 %, and -0.1 % of the oil
    for oil, part, maps in ((1e3, 4e-3, 1), (1e3, 1e-6, 1), (1e3, -1e-4, 1), (1e8, 1e-6, 2)):
        run = run_of(
            x=x, y=y, boundary_stress=(("x", "y"), stress), oil_stress=(("x", "y"), np.full((16, 28), oil)),
            shown_speed=0.1, speed=[0.1], boundary_part=("speed", [0.1]), film_part=("speed", [part]),
        )  # fmt: skip
        figure = Figure(figsize=kind.size, layout="constrained")
        kind.draw(run, figure)
        figure.draw_without_rendering()
        left = min(axes.get_tightbbox().x0 for axes in figure.axes) / figure.bbox.width
        assert left < 0.2  # one high map had a third of the figure empty beside it
        titles = [axes.get_title() for axes in figure.axes if axes.images]
        assert len(titles) == maps
        assert maps == 2 or titles == [f"surfaces in contact:\n{shares[part]}"]
        assert all(axes.title.get_window_extent().x1 <= figure.bbox.x1 for axes in figure.axes)


def test_nothing_worn_is_no_curve_over_cycles():
    kind = next(kind for kind in wear.FIGURES if kind.name == "wear-volume-over-cycles")
    for volume in (0.0, 1e-18):
        run = run_of(volume=(("load", "cycle"), [[0.0, volume]]), load=("load", [1.0]), cycle=[1.0, 2.0])
        assert kind.fits(run) is (volume > 0)


def over_cycles(values):
    return (("load", "cycle"), [values])


def test_figures_of_a_life_have_a_margin_above_their_highest_curve():
    """A load share of one, and a friction that hardly changes, were lines on the upper edge of the axes."""
    run = SimpleNamespace(
        dataset=xr.Dataset(
            {
                name: ("cycle", values)
                for name, values in {
                    "friction_over_cycles": [0.12, 0.12],
                    "boundary_friction_over_cycles": [0.119, 0.12],
                    "contact_share": [1.0, 0.99],
                    "minimum_film_over_cycles": [2e-7, 2e-7],
                    "lambda_over_cycles": [0.3, 0.3],
                }.items()
            }
            | {"cycle": [1.0, 1000.0]}
        )
    )
    kinds = {kind.name: kind for kind in running_in_life.FIGURES}
    for name in ("friction-over-life", "film-over-life"):
        axes = drawn(kinds[name].draw, run).axes
        assert len(axes) == 2
        for one in axes:
            highest = max(line.get_ydata().max() for line in one.lines)
            assert one.get_ylim()[1] == pytest.approx(1.06 * highest)
        shown = [text.get_text() for text in axes[0].get_legend().get_texts()]
        assert len(shown) == sum(len(one.lines) for one in axes)


def test_running_in_draws_what_wears_with_a_margin_above_nearly_flat_curves():
    """Axes from zero cut the peaks of a nearly flat curve; roughness, volume and particles were in no picture."""
    run = run_of(
        friction_over_cycles=over_cycles([0.1363, 0.1403, 0.1370]),
        rms_height_over_cycles=over_cycles([2e-7, 1.9e-7, 1.8e-7]),
        volume_over_cycles=over_cycles([1e-18, 2e-18, 3e-18]),
        particles_over_cycles=over_cycles([2.0, 0.0, 1.0]),
        load=("load", [1.0]),
        speed=("speed", [0.1]),
        hardness=("hardness", [1e9]),
        cycle=[1.0, 2.0, 3.0],
    )
    kinds = {kind.name: kind for kind in running_in.FIGURES}
    (friction_axes,) = drawn(kinds["friction-over-cycles"].draw, run).axes
    low, high = friction_axes.get_ylim()  # the range of what changes little, with margins
    assert 0.1303 < low < 0.1363 - 0.0002
    assert 0.1403 + 0.0002 < high < 0.1463
    run.dataset["friction_over_cycles"] = run.dataset["friction_over_cycles"] * [1.0, 0.4, 1.0]
    (friction_axes,) = drawn(kinds["friction-over-cycles"].draw, run).axes
    assert friction_axes.get_ylim()[0] == 0
    assert kinds["wear-over-cycles"].fits(run)
    roughness, volume, particles = drawn(kinds["wear-over-cycles"].draw, run).axes
    for axes, values in ((roughness, [200, 190, 180]), (volume, [0, 1, 3, 6]), (particles, [2, 0, 1])):
        assert axes.lines[0].get_ydata() == pytest.approx(values)
        assert axes.get_ylim() == pytest.approx((0, 1.06 * max(values)))
    assert "(nm)" in roughness.get_ylabel()
    for name, values in (("Sq_initial", [2.1e-7]), ("Sq_over_cycles", [[2.08e-7, 2.05e-7, 2e-7]])):
        dimensions = ("load", "cycle")[: np.ndim(values)]
        run.dataset[name] = (dimensions, values)
    (line,) = drawn(kinds["wear-over-cycles"].draw, run).axes[0].lines
    assert line.get_xdata() == pytest.approx([0, 1, 2, 3])
    assert line.get_ydata() == pytest.approx([210, 208, 205, 200])  # from Sq_initial to Sq_final
    run.dataset["particles_over_cycles"][:] = 0.0  # not sought: an empty panel stood below the others
    rows = drawn(kinds["wear-over-cycles"].draw, run).axes
    assert len(rows) == 2
    assert rows[-1].get_xlabel() == "cycle"
    run.dataset["volume_over_cycles"][:] = 0.0
    assert not kinds["wear-over-cycles"].fits(run)


def test_a_curve_that_lies_on_another_leaves_it_to_be_seen():
    kind = next(kind for kind in friction.FIGURES if kind.name == "stribeck-curve")
    for above, alike in ((0.0005, True), (0.05, False)):
        values = np.array([[0.1, 0.05], [0.1 + above, 0.05 + above]])
        parts = dict.fromkeys(("friction", "boundary_part", "film_part"), (("model", "speed"), values))
        run = run_of(speed=[0.01, 1.0], model=["capped", "elastic"], **parts)
        run.dataset.attrs["axes"] = "model"
        lines = {line.get_label(): line.get_linestyle() for line in drawn(kind.draw, run).axes[0].lines}
        assert lines["capped at the hardness"] == "-"
        assert (lines["elastic"] == "--") is alike  # as matplotlib names any dashes


def test_the_legend_of_a_contact_says_what_its_shares_are_of():
    """Cells counted beside a headline that has its edges between them looked like two answers."""
    kind = next(kind for kind in contact.FIGURES if kind.name == "contact-map")
    state, x = np.zeros((8, 8)), 1e-6 * np.arange(8)
    state[:4] = 1
    for area, words in ((0.5, "share of the cells"), (0.47, "contact area with its edges between cells: 47.000%")):
        run = run_of(x=x, y=x, contact_state=(("x", "y"), state))
        run.summary = {"contact_area_fraction": area}
        (legend,) = drawn(kind.draw, run).legends
        assert words in legend.get_title().get_text()


def test_maps_longer_than_wide_leave_no_half_empty(tmp_path):
    """Of a patch twice as long as wide the top half of its picture was; a size that is asked for stays."""
    asked = {}
    for cells in ((32, 32), (64, 32), (128, 32)):
        x, y = (1e-6 * np.arange(n) for n in cells)
        state = np.zeros(cells)
        state[:4] = 1
        run = run_of(x=x, y=y, contact_state=(("x", "y"), state), pressure=(("x", "y"), 1e9 * state))
        run.summary = {"contact_area_fraction": float(state.mean())}
        del run.dataset.attrs["axes"]
        for name in ("contact-map", "pressure-map"):
            kind = all_figures()[name]
            for size in (None, (5.0, 4.0)):
                (path,) = drawing.draw(run, kind, tmp_path, size=size).paths
                asked[cells, name, size is None] = imread(path)
    for (cells, _, free), picture in asked.items():
        used = np.flatnonzero((picture[..., :3] < 1).any(axis=(1, 2)))
        if free or cells == (32, 32):
            assert used[0] < 0.26 * picture.shape[0]  # of one four times as long, what the bar's words take
            assert (cells == (32, 32)) is (picture.shape[0] == 800)
        else:
            assert picture.shape[:2] == (800, 1000)


def test_pixels_of_pressure_over_cycles_show_the_largest_of_the_cells_around():
    frames = np.maximum(np.random.default_rng(4).normal(size=(3, 9, 7)) - 1.0, 0.0) * 1e6
    frames[:, :2] = 0.0
    run = run_of(pressure_frames=(("frame", "x", "y"), frames), x=np.arange(9.0), y=np.arange(7.0))
    strip, _, highest = running_in._touched_strip(run)
    shown = frames[:, 2:].transpose(0, 2, 1) * 1e-6
    for frame, of in zip(strip, shown, strict=True):
        around = [[of[max(i - 1, 0) : i + 2, max(j - 1, 0) : j + 2].max() for j in range(7)] for i in range(7)]
        assert np.array_equal(frame, around)
    assert highest == shown.max()


@pytest.mark.parametrize(("periodic", "cells"), [("y", [5, 1, 1]), ("both", [5, 2])])
def test_a_particle_across_a_periodic_edge_is_drawn_as_one(periodic, cells):
    removed = np.zeros((7, 8))
    removed[2:5, 0] = removed[[2, 4], 7] = 1e-6  # both ends of a piece lie beyond the edge along y
    removed[[0, 6], 4] = 1e-6  # joined across the edge along x alone
    run = run_of({"domain": {"periodic": periodic}}, removed=(("x", "y"), removed), x=1e-6 * np.arange(7.0))
    run.dataset = run.dataset.assign_coords(y=1e-6 * np.arange(8.0))
    radii = [np.cbrt(3 * number / (4 * np.pi)) * 1e3 for number in cells]  # of cubes of a micrometre
    titles = [axes.get_title() for axes in drawn(wear._shapes, run).axes]
    assert titles == [f"radius {radius:.0f} nm" for radius in radii]


@pytest.mark.parametrize(("contact", "touching"), [({"radii": ["5 mm", "20 mm"]}, 1), ({"radius": "5 mm"}, 3)])
def test_a_section_under_a_ball_runs_through_its_middle(contact, touching):
    """The separation under a ball is that of the middle line; spots of another row seemed to float above it."""
    x, y = 1e-6 * (np.arange(6) - 2.5), 1e-6 * (np.arange(4) - 1.5)
    pressure = np.zeros((6, 4))
    pressure[1:4, 0] = pressure[2, 2] = 1e9
    along_x = {name: np.full(6, 1e-7) for name in ("separation", "film_thickness_patch", "film_pressure_patch")}
    flat = (("x", "y"), np.zeros((6, 4)))
    run = run_of(
        {"contact": contact}, x=x, y=y, height=flat, displacement=flat, pressure=(("x", "y"), pressure),
        **{name: (("x",), values) for name, values in along_x.items()},
    )  # fmt: skip
    (kind,) = (each for each in friction.FIGURES if each.name == "film-section")
    (upper, _) = drawn(kind.draw, run).axes
    (spots,) = (line for line in upper.lines if line.get_label() == "in contact")
    assert spots.get_xdata().size == touching
    assert "lower surface, deformed" in {line.get_label() for line in upper.lines}
    peaks = SimpleNamespace(dataset=run.dataset.assign(height=100 * run.dataset["pressure"]), scene=run.scene)
    peaks.dataset["height"].values[:] = np.where(pressure > 0, 4e-7, 0.0)  # above a separation of 0.1 um
    (upper, _) = drawn(kind.draw, peaks).axes
    assert "lower surface, deformed (capped peaks overlap)" in {line.get_label() for line in upper.lines}
    figure = Figure(layout="constrained")
    kind.draw(run, figure)
    figure.draw_without_rendering()
    for axes in figure.axes:
        assert axes.get_legend().get_window_extent().y0 >= axes.get_window_extent().y1


def test_the_highest_temperature_has_the_digits_of_its_scale():
    """It was 50 degC over a scale from 50.000 to 50.021."""
    assert highest_in_words(np.array([[50.0, 50.0213]])) == "50.021"
    assert highest_in_words(np.array([[50.0, 83.4]])) == "83"
    assert highest_in_words(np.array([[50.0, 50.0]])) == "50"


def test_curves_below_zero_are_shown_whole():
    """Friction of rolling surfaces is that of the film on one of them, which may push; its curve was cut at zero."""
    axes = Figure().add_subplot()
    axes.plot([0.0, 1.0, 2.0], [-1e-4, 0.0, 3e-4])
    start_at_zero(axes)
    low, high = axes.get_ylim()
    assert low < -1e-4
    assert high > 3e-4
    other = Figure().add_subplot()
    other.plot([0.0, 1.0], [1e-4, 3e-4])
    start_at_zero(other)
    assert other.get_ylim()[0] == 0


def test_the_legend_of_a_life_is_above_its_curves():
    """It lay in a corner in which curves end."""
    cycle = np.geomspace(1.0, 1e5, 5)
    names = ("friction_over_cycles", "boundary_friction_over_cycles", "contact_share")
    run = run_of(cycle=cycle, **{name: ("cycle", np.linspace(0.05, 0.01, 5)) for name in names})
    (kind,) = (each for each in running_in_life.FIGURES if each.name == "friction-over-life")
    figure = Figure(layout="constrained")
    kind.draw(run, figure)
    figure.draw_without_rendering()
    axes = figure.axes[0]
    assert axes.get_legend().get_window_extent().y0 >= axes.get_window_extent().y1


@pytest.mark.internal
@pytest.mark.parametrize(("length", "aspect"), [(20, 1.0), (400, "auto")])
def test_frames_of_a_long_ellipse_are_stretched(length, aspect):
    """Frames of a bearing's ball, ten times as long as wide, were a finger wide, with labels one on another."""
    frames = np.full((3, 12, length), 1e9)
    run = run_of(
        pressure_frames=(("frame", "x", "y"), frames),
        x=1e-6 * np.arange(12.0),
        y=1e-6 * np.arange(float(length)),
        frame=np.array([1, 5, 20]),
    )
    figure = Figure(figsize=(8, 3), layout="constrained")
    running_in._frames(run, figure)
    maps = [axes for axes in figure.axes if axes.get_title().startswith("cycle")]
    assert [axes.get_aspect() for axes in maps] == [aspect] * 3
