"""Oils in scenes: by grade and temperature, resolved and run again, swept over temperature, refused in one message."""

import numpy as np
import pytest
import small_scenes
from command_line import run_command

from bem import InputError, Lubricant
from bem.runs import run_scene
from bem.scenes import load_scene
from bem.scenes.checks.overview import oil as described
from bem.scenes.load import dump_scene

FILM = small_scenes.FILM | {
    "cylinder": small_scenes.FILM["cylinder"] | {"load": "55 N"},
    "oil": {"grade": "iso-vg 68", "temperature": "60 C"},
    "motion": {"kind": "table", "times": ["0 s", "5 ms"], "speeds": ["1 m/s", "1 m/s"]},
    "march": {"duration": "5 ms", "steps": 10, "points": 201},
}


def film(**oil):
    return FILM | {"oil": oil}


def test_a_grade_is_its_lubricant_and_stays_itself_when_resolved(tmp_path):
    scene = load_scene(FILM)
    assert scene.oil.build() == Lubricant.of(
        "ISO VG 68", temperature=333.15, shear_law="base_oil", density_law="dowson_higginson"
    )
    text = dump_scene(scene)
    assert 'grade = "ISO VG 68"' in text
    assert "temperature = 333.15" in text
    assert "viscosity =" not in text
    (tmp_path / "again.toml").write_text(text)
    assert load_scene(tmp_path / "again.toml").oil == scene.oil


def test_other_ways_and_figures_of_ones_own():
    points = [["40 C", "68 mm^2/s"], ["100 degC", "8.53 cSt"]]
    own = load_scene(film(viscosities=points, temperature="60 C", density="870 kg/m^3")).oil.build()
    grade = load_scene(film(grade="VG 68", temperature="60 C", pressure_viscosity="18 1/GPa")).oil.build()
    # 8.53 is the grade's viscosity at 100 degrees to three digits
    assert own.viscosity / own.density == pytest.approx(grade.viscosity / grade.density, rel=1e-3)
    assert (own.density, grade.pressure_viscosity) == (870.0, 18e-9)
    plain = load_scene(film(viscosity="20 mPa*s", temperature="60 C", shear_law="newtonian")).oil.build()
    assert (plain.pressure_viscosity, plain.temperature, plain.oil) == (0.0, 333.15, None)
    pao = load_scene(film(grade="VG 68", base="pao", temperature="60 C", viscosity_index=140)).oil.build()
    assert pao.oil.base == "pao"


@pytest.mark.parametrize(
    ("oil", "words"),
    [
        ({"grade": "ISO VG 69", "temperature": "60 C"}, 'oil.grade = "ISO VG 69": no such grade - did you mean'),
        ({"grade": "ISO VG 68"}, 'oil: grade without temperature; allowed: temperature with it, such as "60 degC"'),
        ({"grade": "VG 68", "temperature": "400 C"}, "oils crack above 300 degC"),
        ({"grade": "VG 68", "temperature": "60 C", "viscosity": 0.1}, "grade and viscosity are given"),
        ({"temperature": "60 C"}, "exactly one of grade, viscosities, viscosity"),
        ({"viscosity": 0.1, "base": "pao", "shear_law": "limited"}, "base beside viscosity"),
        ({"grade": "VG 68", "temperature": "60 C", "temperature_law": "vogel"}, "temperature_law beside grade"),
        ({"viscosities": [["40 C", "46 cSt"], ["100 C", "50 cSt"]], "temperature": "60 C"}, "fall with temperature"),
        ({"grade": "water-glycol 46", "temperature": "40 C"}, "pressure-viscosity coefficient"),
        ({"grad": "VG 68"}, 'unknown key - did you mean "grade"'),
        ({"viscosity": "-1 Pa*s"}, "an oil without viscosity makes no film"),
        ({"grade": "VG 68", "temperature": "60 N"}, "is not a temperature"),
    ],
)
def test_mistakes_are_one_message_each(oil, words):
    with pytest.raises(InputError) as caught:
        load_scene(FILM | {"oil": oil})
    assert len(caught.value.messages) == 1
    assert words in caught.value.messages[0]


def test_a_table_over_temperature_is_as_many_single_runs(tmp_path):
    run = run_scene(FILM | {"over": {"oil.temperature": ["40 C", "80 C"]}}, tmp_path / "run", figures=False)
    np.testing.assert_allclose(run.dataset["oil.temperature"], [313.15, 353.15])
    films = run.dataset["minimum_film"].values[:, -1]
    assert films[0] > 2 * films[1], "a film of ISO VG 68 at 80 degrees is far thinner than at 40"
    alone = run_scene(FILM, tmp_path / "one", settings=["oil.temperature=80 C"], figures=False)
    assert alone.dataset["minimum_film"].values[-1] == films[1]


@pytest.mark.internal
def test_the_plan_shows_every_figure_with_its_source():
    rows = described(load_scene(FILM).oil.build())
    names = [row[0] for row in rows]
    assert {"oil", "viscosity", "pressure-viscosity", "density", "heat capacity", "conductivity"} <= set(names)
    assert all(len(row[2]) > 5 for row in rows if row[0] not in ("temperature", "kinematic"))
    given = described(load_scene(film(grade="VG 68", temperature="60 C", density=870.0)).oil.build())
    assert ("density", "870 kg/m^3", "given") in given
    assert described(Lubricant(0.02, density_law="incompressible"))[0] == ("viscosity", "20 mPa s", "given")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("oils",), ("ISO VG 68", "PAO 4", "squalane", "SAE 5W-30", "mm^2/s at 40 degC")),
        (("oils", "vg68", "--temperature", "60 C"), ("24.6 mPa s", "20.62 1/GPa", "table 2.3", "ASTM D341")),
        (("materials",), ("steel-52100", "E (GPa)", "Akchurin")),
        (("materials", "dlc"), ("Young's modulus", "200 GPa", "source")),
        (("plan", "film-start-stop", "--set", 'oil={grade="PAO 40", temperature="40 C"}'), ("PAO 40", "1/GPa")),
    ],
)
def test_commands_show_the_catalogue(arguments, words, tmp_path):
    done = run_command(*arguments, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert all(word in done.stdout for word in words), done.stdout


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("oils", "PAO 5"), 'did you mean "PAO'),
        (("oils", "VG 68", "--temperature", "60 N"), "--temperature"),
        (("materials", "steel"), "did you mean"),
    ],
)
def test_commands_refuse_in_one_line(arguments, words, tmp_path):
    done = run_command(*arguments, cwd=tmp_path)
    assert done.returncode == 2
    assert len(done.stderr.splitlines()) == 1
    assert words in done.stderr
