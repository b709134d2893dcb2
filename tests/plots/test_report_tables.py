"""Lists of a summary as tables: a row for each speed or case, units in the head, nothing as a paragraph of numbers."""

import json
from types import SimpleNamespace

import pytest

from bem.cli._terminal import print_numbers
from bem.notes.checks import NOT_SETTLED
from bem.plots.report import spelled, status_words, summary_rows, with_error, write_report
from bem.plots.tables import (
    AT_EDGE,
    figure_tables,
    is_place,
    name_and_unit,
    origin_table,
    place_tables,
    summary_of_points,
    window_of,
)
from bem.scenes import get_kind
from bem.scenes.records import UNITS, figures

pytestmark = pytest.mark.internal

SUMMARY = {
    "speed_m_s": [0.01, 0.1, 1.0],
    "friction": [0.1, 0.05, 0.02],
    "friction_spread": [0.01, 1e-12, 0.0],
    "film_load_N": [0.001, 0.002, float("nan")],
    "contact_area_fraction": [0.1, 0.02, 0.0],
    "curves": [
        {"load_N": 5.0, "variant": "", "model": "capped", "friction": [0.1, 0.05, 0.02]},
        {"load_N": 5.0, "variant": "", "model": "uncoupled_elastic", "friction": [0.3, 0.2, 0.1]},
    ],
    "largest_difference": [
        {"load_N": 5.0, "variant": "", "model": "capped", "d_percent": 3.0, "d_percent_spread": 0.5}
    ],
}


def test_a_row_for_each_speed_with_spread_and_unit():
    (table,) = figure_tables(SUMMARY, ["speed_m_s", "friction", "film_load_N", "contact_area_fraction"])
    assert table.head == ("speed (m/s)", "friction coefficient", "film load (mN)", "contact area fraction (%)")
    assert table.rows[0] == ("0.01", "0.1 ± 0.01", "1", "10")
    assert table.rows[1] == ("0.1", "0.05", "2", "2")  # a spread of round-off is none
    assert table.rows[2][2] == "–"


def test_places_of_the_highest_stresses_of_layers_have_one_unit_a_column():
    """Half a cell is not 781.2 nm beside lengths in micrometres; depth 0 may be at the edge of the contact."""
    summary = {
        "layer_material": ["CrN", "Cr"],
        "interface_depth_m": [3e-6, 3.3e-6],
        "layer_max_tension_x_m": [-99.99e-6, -1.06e-4],
        "layer_max_tension_y_m": [781.2e-9, None],
        "layer_max_tension_depth_m": [0.0, 3.0003e-6],
        "interface_max_shear_x_m": [8.75e-6, 11.25e-6],
        "interface_max_shear_y_m": [781.2e-9, 1.172e-5],
    }
    (table,) = place_tables(summary)
    assert table.head == ("stress", "in", "x (µm)", "y (µm)", "depth (µm)")
    assert table.rows == (
        ("max tension", "CrN", "-99.99", "0.7812", "0"),
        ("max tension", "Cr", "-106", "–", "3"),
        ("max shear across the interface", "under CrN", "8.75", "0.7812", "3"),
        ("max shear across the interface", "under Cr", "11.25", "11.72", "3.3"),
    )
    assert AT_EDGE in table.title
    assert all(is_place(name) for name in summary if name.endswith(("_x_m", "_y_m", "max_tension_depth_m")))
    assert not is_place("interface_depth_m")
    deep = summary | {"layer_max_tension_depth_m": [1e-6, 3.0003e-6]}
    assert AT_EDGE not in place_tables(deep)[0].title
    assert place_tables({"layer_material": ["CrN"]}) == []


def test_friction_has_its_scatter_from_the_oil_behind_its_error():
    friction = {
        "speed_m_s": [0.01, 0.1, 1.0],
        "friction": [0.1, 0.05, 0.046],
        "friction_error": [0.002, None, 0.0004],
        "friction_oil_scatter": [2.6e-16, 0.007, 0.012],
    }
    (table,) = figure_tables(friction, list(friction))
    assert table.head == ("speed (m/s)", "friction coefficient")
    assert [row[1] for row in table.rows] == [
        "0.1 ± 0.002 (numerical)",
        "0.05 ± 0.007 (oil)",
        "0.046 ± 0.0004 (numerical), ± 0.012 (oil)",
    ]
    one = {
        "traction_coefficient": 0.046,
        "traction_coefficient_error": 0.0004,
        "traction_coefficient_oil_scatter": 0.012,
    }
    assert with_error("traction_coefficient", one)[1] == "0.046 ± 0.0004 (numerical), ± 0.012 (oil)"
    assert with_error("traction_coefficient", {"traction_coefficient": 0.046})[1] == "0.046"
    swept = summary_of_points({"oil.grade": "1"}, [["a"], ["b"]], [one, one], ["traction_coefficient"])
    (cases,) = figure_tables(swept, [name for name in swept if name != "over"])
    assert [row[1] for row in cases.rows] == ["0.046 ± 0.0004 (numerical), ± 0.012 (oil)"] * 2


def test_a_force_has_its_scatter_from_the_oil_in_its_unit():
    force = {
        "largest_friction_force_N": 0.25,
        "largest_friction_force_N_error": 0.01,
        "largest_friction_force_oil_scatter_N": 0.05,
    }
    shown = "250 ± 10 mN (numerical), ± 50 mN (oil)"
    assert with_error("largest_friction_force_N", force) == ("largest friction force", shown)
    over = {"speed_m_s": [0.1, 1.0]} | {name: [value, 2 * value] for name, value in force.items()}
    (table,) = figure_tables(over, list(over))
    assert table.head == ("speed (m/s)", "largest friction force (mN)")
    assert table.rows[1][1] == "500 ± 20 (numerical), ± 100 (oil)"


def test_a_force_that_is_zero_but_for_rounding_has_the_unit_of_its_error():
    summary = {"speed_m_s": [1.0, 2.0], "force_N": [6e-8, -1e-7], "force_N_error": [0.05, 1.2]}
    (table, *_) = figure_tables(summary, list(summary))
    shown = " ".join([*table.head, *(cell for row in table.rows for cell in row)])
    assert "force (N)" in shown
    assert "± 1.2" in shown


def test_a_figure_below_its_error_is_told_as_on_the_terminal_and_in_tables():
    """A value that is zero but for rounding has its error in readable units; what has no sign begins at zero."""
    shown = dict(
        with_error(name, {name: value, f"{name}_error": error})
        for name, value, error in (
            ("force_across_N", -3.8e-8, 0.13),
            ("interface_max_tension_Pa", 0.3625e6, 6.3e6),
            ("layer_max_tension_Pa", 0.0, 850e3),
            ("lowest_load_N", 1e-6, 3e-6),
            ("mean_contact_traction_Pa", 2.9e3, 8.9e3),
            ("plastic_area_fraction", 0.0, 0.02),
            ("energy_J", 0.0, 0.0),
        )
    )
    assert shown == {
        "force across": "0 ± 130 mN",
        "interface max tension": "0.3625 (0 to 6.66) MPa",
        "layer max tension": "0 (0 to 850) kPa",
        "lowest load of the path": "1 ± 3 µN",
        "mean of pressure less attraction in contact": "2.9 ± 8.9 kPa",
        "plastic area fraction": "0 (0 to 2) %",
        "energy": "0 J",
    }
    swept = {"load_N": [1.0, 2.0], "force_N": [-4.7e-8, 2.0], "force_N_error": [0.71, 0.1]}
    (table,) = figure_tables(swept, list(swept))
    assert [row[1] for row in table.rows] == ["0 ± 0.71", "2 ± 0.1"]


def test_units_of_names_are_those_of_records():
    assert name_and_unit("film_wear_rate_nm_s") == ("film wear rate", "nm/s")
    # `bem element` calls the highest one "contact temperature" and the rise of its surfaces "flash temperature"
    assert name_and_unit("contact_temperature_C")[0] == "surfaces in contact, mean temperature"
    assert name_and_unit("flash_temperature_C")[0] == "surfaces in contact, highest temperature"
    assert name_and_unit("wear_volume_mm3") == ("wear volume", "mm³")
    assert name_and_unit("sedimentation_time_h") == ("sedimentation time", "h")
    assert name_and_unit("worn_volume_per_cycle_um3") == ("worn volume per cycle", "µm³")
    assert name_and_unit("particles_per_mm_and_N") == ("particles per mm and N", "")  # no force
    for unit in UNITS:
        assert unit == "" or name_and_unit(f"figure_{unit}")[1]


def test_cases_are_told_apart_and_have_the_speed_beside_them():
    capped, other, difference = figure_tables(
        SUMMARY | {"friction": [0.11, 0.05, 0.02]}, ["curves", "largest_difference"]
    )
    assert (capped.title, other.title) == ("curves: 5 N, capped", "curves: 5 N, uncoupled elastic")
    assert other.head == ("speed (m/s)", "friction coefficient")
    assert other.rows[0] == ("0.01", "0.3")
    assert difference.head == ("load (N)", "model", "d (%)")  # no column for a variant without a name
    assert difference.rows == (("5", "capped", "3 ± 0.5"),)


def test_what_tells_rows_apart_comes_first_in_every_table():
    summary = {f"figure_{i}": [1.0 * i, 2.0 * i] for i in range(9)} | {"variant": ["a", "b"], "load_N": [5.0, 5.0]}
    tables = figure_tables(summary, [name for name in summary if name != "variant"])
    assert len(tables) == 2
    assert all(table.head[0] == "variant" and len(table.head) <= 7 for table in tables)
    assert [table.rows[0][0] for table in tables] == ["a", "a"]  # one load for all is no name of a row


def test_converged_cycles_that_have_not_settled_say_both_in_one_line(tmp_path, capsys):
    """The status "converged" stood beside the caution that the wear cycles have not settled."""
    summary = {
        "scene": "s", "kind": "wear", "version": "1", "seed": 1, "wall_time_s": 1.0, "status": "converged",
        "where": "", "outside_model": [], "seconds_by_stage": {},
        "notes": [NOT_SETTLED(drifting="friction by 5 %", window="25, or half of all").as_dict()],
    }  # fmt: skip
    both = "converged (equations solved at every cycle), not settled (surfaces still changing at the last cycle)"
    assert status_words(summary) == both
    print_numbers(summary, [])
    assert f"status  {both}" in capsys.readouterr().out
    (tmp_path / "scene.toml").write_text('kind = "wear"\n')
    run = SimpleNamespace(path=tmp_path, summary=json.loads(json.dumps(summary)), scene={}, dataset=None)
    assert f"{both}</span>" in write_report(run, [], ()).read_text("utf-8")
    assert status_words(summary | {"notes": []}) == "converged"
    assert status_words(summary | {"status": "stalled"}) == "stalled"


def test_the_report_has_no_paragraph_of_numbers(tmp_path):
    summary = SUMMARY | {
        "scene": "s", "kind": "friction", "version": "1", "seed": 1, "wall_time_s": 1.0, "status": "converged",
        "where": "", "notes": ["one", "two", "three"], "outside_model": ["a", "b", "c"], "seconds_by_stage": {},
    }  # fmt: skip
    (tmp_path / "scene.toml").write_text('kind = "friction"\n')
    run = SimpleNamespace(path=tmp_path, summary=json.loads(json.dumps(summary)), scene={}, dataset=None)
    page = write_report(run, [], ("speed_m_s", "friction")).read_text("utf-8")
    assert "<th>speed (m/s)</th><th>friction coefficient</th>" in page
    assert "0.01, 0.1" not in page
    assert "{&#34;" not in page  # no table of the summary as its source text


@pytest.mark.parametrize(
    ("name", "value", "shown"),
    [("depth_m", 9.9996e-7, "1 µm"), ("depth_m", 9.994e-7, "999.4 nm"), ("radius_nm", 999.96, "1 µm")],
)
def test_no_thousand_of_a_unit_is_shown(name, value, shown):
    assert spelled(name, value)[1] == shown


OVER = {
    "over": {"oil.temperature": "K", "contact.behaviour": "1", "contact.load": "N"},
    "oil.temperature": [293.15, 293.15, 313.15, 313.15],
    "contact.behaviour": ["elastic", "capped"] * 2,
    "contact.load": [2000.0] * 4,
    "sliding_traction": [0.1, 0.2, 0.3, 0.4],
    "film_nm": [400.0, 300.0, 200.0, 100.0],
}


def test_notes_are_no_column_where_there_are_as_many_as_rows():
    texts = {
        "notes": ["first", "second", "third"],
        "outside_model": ["a", "b", "c"],
        "seconds_by_level": ["d", "e", "f"],
    }
    (table,) = figure_tables(texts | SUMMARY, ["speed_m_s", "friction"])
    assert table.head == ("speed (m/s)", "friction coefficient")
    (table,) = figure_tables(SUMMARY | texts, ["friction", "film_load_N"])
    assert table.head[0] == "speed (m/s)"
    (table,) = figure_tables({"seed": 1, "friction": [0.1, 0.2], "notes": ["x", "y"]}, ["friction"])
    assert table.head == ("friction coefficient",)


def test_varied_keys_say_which_row_it_is_in_every_table():
    (table,) = figure_tables(OVER, ["sliding_traction", "film_nm"])
    assert table.head == ("oil.temperature (°C)", "contact.behaviour", "sliding friction coefficient", "film (nm)")
    assert table.leading == 2
    assert [row[:2] for row in table.rows] == [(t, b) for t in ("20", "40") for b in ("elastic", "capped")]
    old = {key: value for key, value in OVER.items() if key != "over"}  # a run of before units were stored
    (table,) = figure_tables(old, ["sliding_traction"])
    assert table.head == ("oil.temperature", "contact.behaviour", "sliding friction coefficient")
    assert len(figure_tables(OVER, ["sliding_traction", "film_nm"], columns=3)) == 2
    (table,) = figure_tables(
        dict(reversed(OVER.items())), ["film_nm"]
    )  # in the order of `over`, the first key outermost
    assert table.head[:2] == ("oil.temperature (°C)", "contact.behaviour")


def test_a_figure_that_repeats_a_varied_key_is_not_shown_twice():
    summary = {"over": {"oil.temperature": "K"}, "oil.temperature": [293.15, 313.15], "temperature_C": [20.0, 40.0]}
    (table,) = figure_tables(summary | {"friction": [0.1, 0.2]}, ["temperature_C", "friction"])
    assert table.head == ("oil.temperature (°C)", "friction coefficient")


def test_varied_keys_are_named_in_the_titles_of_further_cases():
    cases = [{"oil.temperature": t, "speed_m_s": [0.1, 1.0], "friction": [0.1, 0.05]} for t in (293.15, 313.15)]
    summary = {"over": {"oil.temperature": "K"}, **cases[0], "curves": cases}
    (table,) = figure_tables(summary, ["curves"])
    assert table.title == "curves: oil.temperature 40 °C"
    assert with_error("oil.temperature", summary) == ("oil.temperature", "20 °C")


def test_sizes_of_no_particles_are_a_dash():
    summary = {"speed_m_s": [0.1, 1.0], "particle_equivalent_radius_nm": [0.0, 30.0], "area_mean_length_nm": [0, 0]}
    (table,) = figure_tables(summary, list(summary))
    assert table.rows == (("0.1", "–", "–"), ("1", "30", "–"))
    assert with_error("particle_length_nm", {"particle_length_nm": 0.0, "particle_length_nm_error": None})[1] == "-"
    assert with_error("particles_per_cycle", {"particles_per_cycle": 0.0})[1] == "0"
    # beside a wear law that gives no particles
    law = {"particles_per_cycle": [None], "volume_mean_radius_nm": [0.0], "particles_of": "lower"}
    shown = ["not computed", "not computed", "lower"]
    assert [with_error(name, law)[1] for name in law] == shown


def test_points_of_a_sweep_are_rows_behind_the_swept_keys():
    points = [
        {
            "status": "converged",
            "friction": [0.1, 0.2],
            "friction_error": [0.01, 0.02],
            "speed_m_s": [1.0, 2.0],
            "Sq_nm": 5.0,
        },
        None,
        {
            "status": "stalled",
            "friction": [0.3, 0.4],
            "friction_error": [0.01, 0.02],
            "speed_m_s": [1.0, 2.0],
            "Sq_nm": 6.0,
        },
    ]
    names = ["speed_m_s", "friction", "Sq_nm", "no_such_figure"]
    summary = summary_of_points({"contact.load": "N"}, [(1.0,), (2.0,), (3.0,)], points, names)
    (table,) = figure_tables(summary, [name for name in summary if name != "over"])
    assert table.head == (
        "contact.load (N)",
        "speed (m/s)",
        "result",
        "friction coefficient",
        "Sq of both surfaces (nm)",
    )
    assert table.rows[0] == ("1", "1", "converged", "0.1 ± 0.01", "5")
    assert table.rows[2] == ("2", "–", "failed", "–", "–")
    assert table.rows[4][2:] == ("stalled", "0.4 ± 0.02", "6")


@pytest.mark.parametrize("kind", ["wear", "running-in", "running-in-life", "friction", "flow-factors", "contact"])
def test_every_roughness_says_of_which_region_it_is(kind):
    """`Sq initial` was the roughness of the contact region in two kinds, and of a whole surface in a third."""
    record, regions = get_kind(kind).record, ("contact region", "surface")
    names = [name for name in figures(record) if ("Sq" in name and "over_Sq" not in name) or "worn_depth" in name]
    assert names
    for name in names:
        assert any(region in name_and_unit(name)[0] for region in regions), name
    shown = [name for name in names if name in get_kind(kind).headline]
    meant = {"wear": "contact region", "running-in": "contact region"}.get(kind, "surface")
    # the deepest place, which the error of long wear steps is compared with, is that of the whole surface
    assert all(meant in name_and_unit(name)[0] for name in shown if name != "largest_worn_depth_nm")


def test_a_figure_of_a_life_is_shown_under_one_name():
    summary = {"lower_Sq_final_nm": [1.0, 2.0], "Sq_final_nm": [1.0, 2.0], "speed_m_s": [0.1, 0.2]}
    (table,) = figure_tables(summary, list(summary))
    assert table.head == ("speed (mm/s)", "Sq of the lower surface, final (nm)")


def test_the_hardness_is_named_where_it_is_the_maximum_pressure():
    """It had an error bar of the rounding of its cells: "7 ± 1.2e-07 GPa"."""
    capped = {"max_pressure_Pa": 7e9, "max_pressure_Pa_error": 120.0, "plastic_area_fraction": 1e-3}
    assert with_error("max_pressure_Pa", capped) == ("max pressure", "7 GPa (the hardness)")
    below = {"max_pressure_Pa": 6.9e9, "max_pressure_Pa_error": 2e7, "plastic_area_fraction": 0.0}
    assert with_error("max_pressure_Pa", below) == ("max pressure", "6.9 ± 0.02 GPa")


def test_tables_give_no_error_of_a_pressure_at_the_hardness():
    """Tables of loads said "7 ± 0.059" where a single run says that it is the hardness."""
    capped = {
        "load_N": [1.0, 2.0, 3.0],
        "max_pressure_Pa": [6.5e9, 7e9, 7e9],
        "max_pressure_Pa_error": [1e8, 5.9e7, 120.0],
        "max_pressure_Pa_error_grid": [1e8, 5.9e7, 0.0],
        "plastic_area_fraction": [0.0, 1e-4, 1e-3],
    }
    (table,) = figure_tables(capped, ["load_N", "max_pressure_Pa"])
    assert [row[1] for row in table.rows] == ["6.5 ± 0.1", "7 (the hardness)", "7 (the hardness)"]
    (origins,) = origin_table(capped, ["max_pressure_Pa"])
    assert origins.rows[0][1:] == ("6.5", "0.1", "0.1")
    highest = {name: values[2] for name, values in capped.items()}
    assert origin_table(highest, ["max_pressure_Pa"]) == []


def test_an_error_below_a_millionth_is_left_out():
    assert with_error("load_N", {"load_N": 2.0, "load_N_error": 1.9e-6})[1] == "2 N"
    assert with_error("load_N", {"load_N": 2.0, "load_N_error": 2.1e-6})[1] == "2 ± 2.1e-06 N"


def test_an_area_is_shown_once_and_roughness_before_and_after_in_one_row(tmp_path):
    """Areas counted by cells stood beside the estimates without a word."""
    (tmp_path / "scene.toml").write_text('kind = "contact"\n')
    summary = {
        **{"scene": "s", "kind": "contact", "status": "converged", "where": "", "version": "1", "seed": 1},
        "wall_time_s": 1.0,
        **{"contact_area_fraction": 0.1, "counted_contact_area_fraction": 0.12, "max_pressure_Pa": 1e9},
        **{"Sq_initial_nm": [235.5], "Sq_final_nm": [215.0], "reported_mean": "volume"},
        "particle_equivalent_radius_nm": [300.0],
    }
    run = SimpleNamespace(path=tmp_path, scene={}, summary=summary)
    page = write_report(run, [], ("contact_area_fraction",)).read_text("utf-8")
    assert "10 %" in page
    assert "counted" not in page
    rows = summary_rows(summary, ["Sq_initial_nm", "Sq_final_nm", "particle_equivalent_radius_nm"])
    assert rows == [
        ("Sq of the worn body's contact region, initial and final", "235.5 nm → 215 nm"),
        ("particle equivalent radius, mean by volume", "300 nm"),
    ]


def test_temperatures_of_running_in_are_means_over_cycles():
    """The highest one, a mean, was below that of the last cycle in a caution."""
    summary = {"averaged_cycles": 64, "flash_temperature_C": [288.9], "contact_temperature_C": [200.4]}
    rows = dict(summary_rows(summary, ["flash_temperature_C", "contact_temperature_C"]))
    assert list(rows) == [
        f"surfaces in contact, {which} temperature (mean of the last 64 cycles)" for which in ("highest", "mean")
    ]
    life = dict(summary_rows({"flash_temperature_C": 313.3}, ["flash_temperature_C"]))
    assert list(life) == ["surfaces in contact, highest temperature"]


def test_the_table_of_the_load_share_says_its_formula():
    """The heads b and c are constants of exp(-b lambda^c)."""
    share = {"model": "elastic", "b": 0.6, "c": 0.7, "b_error": 0.01, "c_error": 0.02, "rms": 0.01, "largest": 0.02}
    (table,) = figure_tables({"load_share": [share | {"points": 9}]}, ["load_share"])
    assert "exp(-b Λ^c)" in table.title
    assert {"b", "c"} <= set(table.head)


@pytest.mark.parametrize(
    ("region", "width", "words"),
    [
        ("contact", [27.5, 27.5], " (Hertz' contact, 27.5 µm wide)"),
        ("track", [27.5, 27.5], " (the track, a strip as wide as Hertz' contact, 27.5 µm, over the whole grid)"),
        ("track", [20.0, 27.5], " (the track, a strip as wide as Hertz' contact over the whole grid)"),
        ("track", None, " (the track, which is the whole grid)"),
    ],
)
def test_figures_of_a_track_are_not_said_to_be_of_the_contact(region, width, words):
    """Sq and worn depth of a ball's track were labelled as those of Hertz' circle, whose volume is eight times less."""
    summary = {"contact_region": region, "contact_region_width_um": width}
    assert window_of("Sq_final_nm", summary) == words
    assert window_of("worn_depth_nm", summary) == words
    assert window_of("wear_volume_um3", summary) == ""


def test_figures_without_a_value_have_no_row():
    summary = {"variant": "", "load_N": 500.0, "film_solves": 0}
    assert [name for name, _ in summary_rows(summary, list(summary))] == ["load", "film solves"]


def test_stages_that_ran_side_by_side_are_said_to_be_added_up(tmp_path):
    """Stages of 46 s stood in a report of a run of 30.6 s."""
    (tmp_path / "scene.toml").write_text('kind = "friction"\n')
    pages = []
    for seconds in (46.0, 30.0):
        summary = SUMMARY | {
            "scene": "s", "kind": "friction", "version": "1", "seed": 1, "wall_time_s": 30.6, "status": "converged",
            "where": "", "notes": [], "outside_model": [], "seconds_by_stage": {"cycles": seconds},
        }  # fmt: skip
        run = SimpleNamespace(path=tmp_path, summary=json.loads(json.dumps(summary)), scene={}, dataset=None)
        pages.append("side by side" in write_report(run, [], ("speed_m_s", "friction")).read_text("utf-8"))
    assert pages == [True, False]
