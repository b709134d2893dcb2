"""Rows of a way (`along`): a gear's line of action from a table or a file, each row the contact that it is."""

import math

import numpy as np
import pytest
from matplotlib.figure import Figure

from bem import InputError, load_scene, solve_thermal_line_film
from bem.campaigns.context import Silent
from bem.plots.draw import figure_kind
from bem.runs import run_scene
from bem.runs.sweep import run_sweep
from bem.scenes.checks.plausible import notes_over
from bem.scenes.load import dump_scene

COLUMNS = {
    "position": ["-5 mm", "0 mm", "5 mm"],
    "radius": ["7.2 mm", "8.4 mm", "8.6 mm"],
    "load": ["1.8 kN", "2.8 kN", "1.7 kN"],
    "lower_speed": ["2.1 m/s", "3.3 m/s", "4.5 m/s"],
    "upper_speed": ["4.1 m/s", "3.3 m/s", "2.5 m/s"],
}
GEAR = {
    "kind": "traction",
    "roughness": "0.3 um",
    "lower": {"material": "steel-52100"},
    "upper": {"material": "steel-52100"},
    "roller": {"width": "14 mm"},
    "oil": {"grade": "ISO VG 100", "temperature": "90 degC", "density_law": "dowson_higginson"},
    "film": {"points": 200},
    "along": COLUMNS,
}
FILE = """\
# a comment
position [mm]; radius (mm); load [kN]; lower_speed [m/s]; upper_speed
-5; 7.2; 1.8; 2.1; 4.1 m/s
0; 8.4; 2.8; 3.3; 3.3 m/s  # the pitch point
5; 0.0086 m; 1.7; 4.5; 2.5 m/s
"""


@pytest.fixture(scope="module")
def gear(tmp_path_factory):
    return run_scene(GEAR, tmp_path_factory.mktemp("gear") / "run")


def test_each_row_is_its_contact(gear):
    found = gear.summary
    assert found["status"] == "converged"
    np.testing.assert_allclose(found["position_m"], [-5e-3, 0, 5e-3])
    scene = load_scene(GEAR)
    bodies = (scene.lower.build(), scene.upper.build())
    modulus = 1 / sum((1 - b.material.poissons_ratio**2) / b.material.youngs_modulus for b in bodies)
    row = solve_thermal_line_film(
        load=1.7e3 / 14e-3, radius=8.6e-3, contact_modulus=modulus, speeds=(4.5, 2.5), lubricant=scene.oil.build(),
        bodies=bodies, points=200,
    )  # fmt: skip
    assert found["traction_coefficient"][2] == pytest.approx(row.shear_force / row.film.load, rel=1e-9)
    assert found["friction_power_W"][2] == pytest.approx(14e-3 * row.friction_power, rel=1e-9)
    assert found["lambda_ratio"][2] == pytest.approx(row.minimum_thickness / 0.3e-6, rel=1e-9)
    pressure = math.sqrt(1.7e3 / 14e-3 * modulus / (math.pi * 8.6e-3))
    assert found["hertz_pressure_Pa"][2] == pytest.approx(pressure, rel=1e-9)
    assert (gear.path / "figures" / "along-the-way.png").exists()


@pytest.mark.internal
def test_lambda_is_read_beside_the_minimum_film(gear):
    """A dotted curve on a scale of its own lay upon the central film's."""
    figure = Figure()
    figure_kind(gear, "along-the-way").draw(gear, figure)
    films, (beside,) = figure.axes[0], [axes for axes in figure.axes if axes.get_ylabel().startswith("lambda")]
    assert not beside.lines
    minimum = next(line for line in films.lines if line.get_label() == "minimum").get_ydata()
    share = np.asarray(minimum) / films.get_ylim()[1]
    np.testing.assert_allclose(share * beside.get_ylim()[1], gear.summary["lambda_ratio"], rtol=1e-9)


def test_friction_turns_at_the_pitch_point_and_has_power_on_either_side(gear):
    found = gear.summary
    traction, power = found["traction_coefficient"], found["friction_power_W"]
    assert traction[0] < 0 < traction[2]
    assert abs(traction[1]) < 0.02 * traction[2]
    assert power[1] < 0.2 * min(power[0], power[2])
    # sliding force times sliding speed, all but what rolling takes
    for i, load in ((0, 1.8e3), (2, 1.7e3)):
        assert power[i] == pytest.approx(abs(found["sliding_traction"][i]) * load * 2.0, rel=0.1)
    assert any(note["code"] == "film-thinner-than-roughness" for note in found["notes"])


def test_without_heat_friction_has_its_power_too(tmp_path):
    scene = {key: item for key, item in GEAR.items() if key != "along"} | {
        "thermal": "off",
        "roller": {"radius": "8.6 mm", "width": "14 mm", "load": "1.7 kN"},
        "rolling": {"mean_speed": "3.5 m/s", "slide_roll_ratio": 4 / 7},
    }
    found = run_scene(scene, tmp_path / "run", figures=False).summary
    sliding = found["sliding_traction"] * 1.7e3 * 2.0
    assert sliding < found["friction_power_W"] < 1.1 * sliding
    # pure rolling has that of rolling alone
    rolling = scene | {"rolling": {"mean_speed": "3.5 m/s"}}
    found = run_scene(rolling, tmp_path / "rolling", figures=False).summary
    assert found["friction_power_W"] == pytest.approx(found["traction_coefficient"] * 1.7e3 * 7.0, rel=1e-9)


def test_a_file_is_the_same_table_and_a_run_keeps_it(tmp_path):
    (tmp_path / "gear.csv").write_text(FILE)
    scene = load_scene(GEAR | {"along": {"path": str(tmp_path / "gear.csv")}})
    assert scene.along == load_scene(GEAR).along
    marked = load_scene(GEAR | {"along": {"path": str(tmp_path / "gear.csv"), "marks": {"C": "0 mm"}}})
    assert marked.along.marks.places() == {"C": 0.0}
    assert marked.along.load == scene.along.load
    (tmp_path / "gear.csv").unlink()
    (tmp_path / "scene.toml").write_text(dump_scene(scene))
    assert load_scene(tmp_path / "scene.toml").along == scene.along


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"radius": ["1 mm", "2 mm"]}, "3 of position, 2 of radius, 3 of load"),
        ({"position": ["5 mm", "0 mm", "-5 mm"]}, "positions do not rise"),
        ({"lower_speed": ["0 m/s"] * 3, "upper_speed": ["1 m/s", "0 m/s", "1 m/s"]}, "both surfaces stand still"),
        ({"load": ["1 N", "-1 N", "2 N"]}, r"along\.load\[1\]"),
        ({"load": ["1 N", "1 mm", "2 N"]}, r"along\.load\[1\].*a force"),
        ({"path": "gear.csv"}, "path and columns are given"),
        ({"marks": {"A": "-6 mm"}}, "marks A outside of the positions"),
        ({"marks": {"F": "0 mm"}}, r"along\.marks\.F"),
    ],
)
def test_mistakes_in_columns_are_said(changes, words):
    with pytest.raises(InputError, match=words):
        load_scene(GEAR | {"along": COLUMNS | changes})


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("position [mm], radius [mm]\n1, 2\n2, 3\n", "no column load, lower_speed, upper_speed"),
        (FILE.replace("lower_speed", "lower_sped"), 'a column " ?lower_sped .*lower_speed'),
        (FILE.replace("lower_speed", "upper_speed"), "upper_speed twice"),
        (FILE.replace("2.1; ", ""), "row 1 of .* has 4 values; allowed: 5"),
        ("position\n", "has 0 rows"),
    ],
)
def test_mistakes_in_files_are_said(tmp_path, text, words):
    (tmp_path / "gear.csv").write_text(text)
    with pytest.raises(InputError, match=words):
        load_scene(GEAR | {"along": {"path": str(tmp_path / "gear.csv")}})


def test_what_the_rows_say_is_not_said_twice(tmp_path):
    with pytest.raises(InputError, match="cannot be read"):
        load_scene(GEAR | {"along": {"path": str(tmp_path / "none.csv")}})
    with pytest.raises(InputError, match=r"roller\.radius beside along, whose rows say it"):
        load_scene(GEAR | {"roller": {"radius": "1 mm", "width": "14 mm"}})
    with pytest.raises(InputError, match=r"roller\.hertz_pressure beside along"):
        load_scene(GEAR | {"roller": {"hertz_pressure": "1 GPa", "width": "14 mm"}})


def test_oils_along_a_path_are_at_the_temperature_of_the_first():
    def codes(**over):
        table = {key: list(values) for key, values in over.items()}
        return [note.code for note in notes_over(load_scene(GEAR | ({"over": table} if table else {})))]

    (note,) = notes_over(load_scene(GEAR | {"over": {"oil.base": ["mineral", "pag"]}}))
    assert note.startswith("oil.temperature: All oils are at the flank temperature of the first, 90 degC.")
    assert codes(**{"oil.grade": ["ISO VG 100", "PAO 10"]}) == ["oils-at-one-temperature"]
    assert codes() == []
    assert codes(**{"roughness": ["0.3 um", "0.5 um"]}) == []
    assert codes(**{"oil.base": ["mineral", "pag"], "oil.temperature": ["80 degC", "90 degC"]}) == []


def test_a_sweep_over_oils_along_a_path_says_so(tmp_path):
    told = []

    class Told(Silent):
        def note(self, text):
            told.append(str(text))

    two = {key: values[:2] for key, values in COLUMNS.items()}
    scene = GEAR | {"along": two, "thermal": "off"}
    run_sweep(scene, ["oil.base=mineral,pag"], tmp_path / "sweep", workers=1, watcher=Told())
    assert sum("All oils are at the flank temperature of the first, 90 degC" in text for text in told) == 1
