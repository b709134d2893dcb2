"""Lists of a summary as tables: a row for each speed or case, units in the head, nothing as a paragraph of numbers."""

import json
from types import SimpleNamespace

import pytest

from bem.plots.report import spelled, write_report
from bem.plots.tables import figure_tables, name_and_unit
from bem.scenes.records import UNITS

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
    assert table.head == ("speed (m/s)", "friction", "film load (mN)", "contact area fraction (%)")
    assert table.rows[0] == ("0.01", "0.1 ± 0.01", "1", "10")
    assert table.rows[1] == ("0.1", "0.05", "2", "2")  # a spread of round-off is none
    assert table.rows[2][2] == "–"


def test_units_of_names_are_those_of_records():
    assert name_and_unit("film_wear_rate_nm_s") == ("film wear rate", "nm/s")
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
    assert other.head == ("speed (m/s)", "friction")
    assert other.rows[0] == ("0.01", "0.3")
    assert difference.head == ("load (N)", "model", "d (%)")  # no column for a variant without a name
    assert difference.rows == (("5", "capped", "3 ± 0.5"),)


def test_what_tells_rows_apart_comes_first_in_every_table():
    summary = {f"figure_{i}": [1.0 * i, 2.0 * i] for i in range(9)} | {"variant": ["a", "b"], "load_N": [5.0, 5.0]}
    tables = figure_tables(summary, [name for name in summary if name != "variant"])
    assert len(tables) == 2
    assert all(table.head[0] == "variant" and len(table.head) <= 7 for table in tables)
    assert [table.rows[0][0] for table in tables] == ["a", "a"]  # one load for all is no name of a row


def test_the_report_has_no_paragraph_of_numbers(tmp_path):
    summary = SUMMARY | {
        "scene": "s", "kind": "friction", "version": "1", "seed": 1, "wall_time_s": 1.0, "status": "converged",
        "where": "", "notes": [], "seconds_by_stage": {},
    }  # fmt: skip
    (tmp_path / "scene.toml").write_text('kind = "friction"\n')
    run = SimpleNamespace(path=tmp_path, summary=json.loads(json.dumps(summary)), scene={}, dataset=None)
    page = write_report(run, [], ("speed_m_s", "friction")).read_text("utf-8")
    assert "<th>speed (m/s)</th><th>friction</th>" in page
    assert "0.01, 0.1" not in page
    assert "{&#34;" not in page  # no table of the summary as its source text


@pytest.mark.parametrize(
    ("name", "value", "shown"),
    [("depth_m", 9.9996e-7, "1 µm"), ("depth_m", 9.994e-7, "999.4 nm"), ("radius_nm", 999.96, "1 µm")],
)
def test_no_thousand_of_a_unit_is_shown(name, value, shown):
    assert spelled(name, value)[1] == shown
