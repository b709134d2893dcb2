"""Error bars beside the figures of a run: in the summary, the dataset, the terminal and the report."""

from types import SimpleNamespace

import numpy as np
import pytest

from bem.campaigns.collect import _figures, outcome_of
from bem.cli._terminal import print_numbers
from bem.kinds.running_in.record import RunningInRecord
from bem.kinds.wear.record import WearRecord
from bem.notes.accuracy import NoBar, named, no_error_bar
from bem.plots.report import with_error
from bem.plots.tables import name_and_unit, origin_table
from bem.runs import run_scene
from bem.scenes.context import PlainContext
from bem.scenes.kind import get_kind
from bem.scenes.load import load_scene
from bem.scenes.records import Figure, Series, described, without_bars

SCENE = {
    "kind": "contact",
    "grid": {"shape": [48, 48], "lengths": ["48 um", "48 um"]},
    "lower": {"material": "steel-disk"},
    "shape": {"kind": "sphere", "radius": "1 mm"},
    "contact": {"load": "0.1 N"},
}


def figures_of(record):
    return {name: item for name, item in described(record).items() if isinstance(item, Figure)}


def outcome(**changes):
    kind = get_kind("contact")
    scene = kind.resolve(load_scene({**SCENE, **changes}))
    context = PlainContext()
    return outcome_of(scene, kind.run(scene, context)), context


@pytest.mark.internal
def test_every_headline_figure_has_its_error():
    found, _ = outcome(outputs={"von_mises": True})
    summary = found.summary
    names = [name for name in get_kind("contact").headline if not name.startswith(("layer_", "interface_"))]
    for name in names:
        if name != "residual" and summary.get(name) is not None:
            assert summary[f"{name}_error"] is not None, name
            assert np.isfinite(summary[f"{name}_error"]), name
    keys = list(summary)
    assert keys.index("approach_m_error") == keys.index("approach_m") + 1
    error = found.variables["approach_error"]
    assert error.units == "m"
    assert float(error.values) == summary["approach_m_error"]
    for name in ("approach_m", "max_von_mises_Pa"):
        parts = {key: value for key, value in summary.items() if key.startswith(f"{name}_error_")}
        assert len(parts) == 2, name
        assert sum(parts.values()) == pytest.approx(summary[f"{name}_error"], rel=1e-6, abs=0), name
    assert float(found.variables["approach_error_grid"].values) == summary["approach_m_error_grid"]


@pytest.mark.internal
def test_the_error_of_a_mean_over_repetitions_has_its_standard_error():
    told = {"load": Figure("N", "load"), "friction": Figure("", "friction", ("speed",)), "area": Figure("m2", "area")}

    def record(load, friction, errors):
        parts = {"grid": {"load": 0.6 * errors["load"]}, "residual": {"load": 0.4 * errors["load"]}}
        values = {"load": load, "friction": np.array(friction), "area": 1.0}
        return SimpleNamespace(**values, errors=errors, error_parts=parts, input_changes={})

    records = [
        record(1.0, [0.1, 0.2], {"load": 0.1, "friction": np.array([0.01, np.nan])}),
        record(3.0, [0.1, 0.4], {"load": 0.3, "friction": np.array([0.03, np.nan])}),
    ]
    found = _figures(told, records, {"load", "friction"}, set())
    # standard deviation of 1 and 3 over the root of two: 1
    assert found["load_N_error"] == pytest.approx(0.2 + 1.0)
    assert found["load_N_spread"] == pytest.approx(np.sqrt(2))
    # each origin apart, and their sum is the error
    apart = [found[f"load_N_error_{origin}"] for origin in ("grid", "residual", "scatter")]
    assert apart == pytest.approx([0.12, 0.08, 1.0])
    assert sum(apart) == pytest.approx(found["load_N_error"])
    assert found["friction_error"] == [pytest.approx(0.02), None]
    assert "area_m2_error" not in found


@pytest.mark.internal
def test_errors_can_be_left_out():
    found, context = outcome(outputs={"errors": False})
    assert not [key for key in found.summary if key.endswith("_error")]
    assert "error bars" not in context.seconds


@pytest.mark.internal
def test_figures_are_spelt_with_their_errors():
    summary = {"max_pressure_Pa": 1.2346e9, "max_pressure_Pa_error": 2.34e7, "load_N": 1.0, "approach_m": 3e-9}
    assert with_error("max_pressure_Pa", summary) == ("max pressure", "1.235 ± 0.023 GPa")
    assert with_error("load_N", summary) == ("load", "1 N")
    assert with_error("count", {"count": 10, "count_error": 7.43})[1] == "10 ± 7.4"
    nanometres = {"thickness_m": 313.3e-9, "thickness_m_error": 1.26e-6}
    assert with_error("thickness_m", nanometres)[1] == "0.3133 (0 to 1.57) µm"
    area = {"contact_area_m2": 4.515e-10, "contact_area_m2_error": 1.3e-11}
    assert with_error("contact_area_m2", area)[1] == "451.5 ± 13 µm²"
    volume = {"yielded_volume_m3": 5.697e-16, "yielded_volume_m3_error": 4.1e-17}
    assert with_error("yielded_volume_m3", volume)[1] == "569.7 ± 41 µm³"
    signed = {"pressure_xy": 0.01, "pressure_xy_error": 0.02}  # flow across what drives it, either way
    assert with_error("pressure_xy", signed)[1] == "0.01 ± 0.02"
    assert with_error("approach_m", {**summary, "approach_m_error": None})[1] == "3 nm (no error bar)"
    assert with_error(
        "contact_area_fraction", {"contact_area_fraction": 0.1, "contact_area_fraction_error": 0.002}
    ) == (
        "contact area fraction",
        "10 ± 0.2 %",
    )


def test_the_report_shows_errors_beside_figures(tmp_path):
    run = run_scene(SCENE, tmp_path / "run", figures=True)
    page = (tmp_path / "run" / "report.html").read_text()
    assert "±" in page
    assert "approach m error" not in page
    assert "Where the errors come from" in page
    assert run.summary["approach_m_error"] > 0


@pytest.mark.internal
def test_errors_by_origin_in_a_table():
    summary = {"load_N": 2000.0, "load_N_error": 30.0, "load_N_error_grid": 20.0, "load_N_error_residual": 10.0}
    friction = {"friction": [0.1, 0.2], "friction_error": [0.01, 0.03], "friction_error_grid": [0.01, 0.03]}
    (table,) = origin_table(summary | friction | {"area_m2": 1.0}, ["load_N", "friction", "area_m2"])
    assert table.head == ("figure", "value", "error", "grid", "residual")
    assert table.rows == (
        ("load (kN)", "2", "0.03", "0.02", "0.01"),
        ("friction coefficient, where the error is largest", "0.2", "0.03", "0.03", "–"),
    )
    assert not origin_table({"load_N": 1.0, "load_N_error": 0.1}, ["load_N"])


def test_lists_on_the_terminal_have_their_errors(capsys):
    friction = {"friction": [0.1, 0.2], "friction_error": [0.01, 0.03], "friction_error_grid": [0.01, 0.03]}
    known = {"speed_m_s": [0.5, 1.0], "status": "converged", "wall_time_s": 1.0, "scene": "curve", "kind": "friction"}
    print_numbers(known | friction, ["speed_m_s", "friction"])
    shown = capsys.readouterr().out
    assert "0.1 ± 0.01" in shown
    assert "0.2 ± 0.03" in shown


def test_a_figure_without_an_error_bar_has_the_reason_below_the_table(capsys):
    """The first example of the README had "4.251 GPa (no error bar)", and the reason in the report alone."""
    why = no_error_bar(["max_von_mises"], NoBar.STRESS_OF_CAPPED).as_dict()
    known = {"status": "converged", "wall_time_s": 1.0, "scene": "s", "kind": "contact", "notes": [why]}
    for error, count in ((None, 1), (1e7, 0)):
        print_numbers(known | {"max_von_mises_Pa": 4e9, "max_von_mises_Pa_error": error}, ["max_von_mises_Pa"])
        assert " ".join(capsys.readouterr().out.split()).count(why["text"]) == count


def test_reasons_below_the_table_name_its_rows_alone(capsys):
    """A curve named the friction with the oil of the loaded zone, which no row of the terminal has."""
    notes = [
        no_error_bar(["friction", "loaded_friction"], NoBar.FREE_EDGE).as_dict(),
        no_error_bar(["loaded_contact_load"], NoBar.OF_KIND, why="they are for comparison").as_dict(),
        no_error_bar(["friction, wear and worn surfaces"], NoBar.SINGLE_LOOP).as_dict(),  # the name of no figure
    ]
    known = {"status": "converged", "wall_time_s": 1.0, "scene": "s", "kind": "friction", "notes": notes}
    beside = {"loaded_contact_load_N": 1.0, "loaded_friction": 0.1}
    print_numbers(known | beside | {"friction": 0.1, "friction_error": None}, ["friction"])
    shown = " ".join(capsys.readouterr().out.split())
    assert "No error bars for friction coefficient. The contact reaches" in shown
    assert "loaded zone" not in shown
    assert "comparison" not in shown
    assert "No error bars for friction, wear and worn surfaces. A single loop has none" in shown


WEAR = {
    "kind": "wear",
    "lower": {
        "material": "steel-disk",
        "surface": {"kind": "generated", "rms_height": "50 nm", "correlation_length": "4 um"},
    },
    "upper": {"material": "steel-cylinder"},
    "cylinder": {"radius": "1 mm", "width": "1 mm", "loads": ["5 N"], "hardness": "2 GPa"},
    "domain": {"cells": 24, "half_widths": 3.0},
    "depths": {"count": 8, "spacing": "200 nm"},
    "cycles": {"count": 3, "settled": 2},
}


MESHS, SCATTERS = set(without_bars(WearRecord)), set(WearRecord.scatters)


def wear_record(radius):
    """A record of the kind with the same numbers in every figure but the radius."""
    known = described(WearRecord)
    series = {name: np.ones((1,) * len(item.dimensions)) for name, item in known.items() if isinstance(item, Series)}
    values = dict.fromkeys(known, 1.0) | series
    return WearRecord(**{**values, "volume_mean_equivalent_radius": radius})


@pytest.mark.internal
def test_what_follows_the_mesh_has_null_and_says_why():
    found = _figures(figures_of(WearRecord), [wear_record(1e-7)], MESHS, SCATTERS)
    assert found["number_mean_equivalent_radius_nm_error"] is None
    assert found["particles_per_cycle_error"] is None
    assert "volume_mean_equivalent_radius_nm_error" not in found
    assert with_error("particles_per_cycle", found)[1] == "1 (no error bar)"


@pytest.mark.internal
def test_scatter_over_repetitions_is_the_only_bar_of_a_wear_loop():
    records = [wear_record(radius) for radius in (1e-7, 3e-7)]
    found = _figures(figures_of(WearRecord), records, MESHS, SCATTERS)
    assert found["volume_mean_equivalent_radius_nm_error"] == pytest.approx(100.0)
    # a mesh's figure gets no bar by repeating it
    assert found["number_mean_equivalent_radius_nm_error"] is None
    # one repetition that is left tells no scatter
    assert (
        _figures(figures_of(WearRecord), [records[0], None], MESHS, SCATTERS)["volume_mean_equivalent_radius_nm_error"]
        is None
    )


@pytest.mark.internal
@pytest.mark.parametrize("record", [WearRecord, RunningInRecord])
def test_scattering_figures_are_figures_that_have_none_of_the_meshs(record):
    assert set(record.scatters) <= set(figures_of(record)) - set(without_bars(record))


def test_the_run_says_which_figures_follow_the_mesh_and_what_its_bars_are(tmp_path):
    run = run_scene({**WEAR, "repetitions": 2}, tmp_path / "run", figures=True)
    notes = " ".join(note["text"] for note in run.summary["notes"])
    assert "No error bars for" in notes
    assert "They follow the mesh" in notes
    assert "over 2 repetitions alone" in notes
    assert run.summary["number_mean_equivalent_radius_nm_error"] is None
    assert run.summary["Sq_final_nm_error"] == pytest.approx(run.summary["Sq_final_nm_spread"] / np.sqrt(2))
    assert "They follow the mesh" in (tmp_path / "run" / "report.html").read_text()


def test_notes_on_missing_bars_name_figures_as_tables_do():
    """ "number mean radius" and "volume" were names of no row."""
    names = {"number_mean_radius": "nm", "area_mean_length": "nm", "number_above_mean_width": "nm", "friction": ""}
    rows = [name_and_unit(f"{name}_{unit}" if unit else name)[0] for name, unit in names.items()]
    assert named(names) == rows
    assert rows[:2] == ["particle equivalent radius, mean by number", "particle length, mean by area"]
    # of a life, whose surfaces have no contact region
    assert named(["Sq_final", "lower_Sq_final"]) == ["Sq of the lower surface, final"]
    note = no_error_bar(list(names)[:2], NoBar.FEW_PARTICLES)
    assert note.headline == f"No error bars for {rows[0]}; {rows[1]}"


def test_a_mean_volume_without_a_bar_is_said_of_the_numbers_that_follow_from_it():
    from bem.kinds.particles.errors import _of_rows

    note = no_error_bar(["volume"], NoBar.SCATTERED_PARTICLES, count=6, most=3.0)
    (said,) = _of_rows((note,), ("particles_per_mm_and_N",))
    assert said.startswith("No error bars for particles per mm and N. 6 particles: uncertain by more than 3 times")
    assert not list(_of_rows((note,), ()))


@pytest.mark.parametrize("kind", ["wear", "running-in"])
def test_rows_of_a_single_loop_say_that_they_have_no_bar(kind):
    loop = {"kind": kind, "Sq_final_nm": 90.0, "worn_depth_nm": 3.0, "cycles": 4}
    barless = {name: with_error(name, loop)[1].endswith("(no error bar)") for name in loop if name != "kind"}
    assert barless == {"Sq_final_nm": True, "worn_depth_nm": kind == "running-in", "cycles": False}
    assert with_error("Sq_final_nm", loop | {"Sq_final_nm_error": 1.0})[1] == "90 ± 1 nm"
