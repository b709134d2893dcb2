"""Where a user takes the wrong turn, the message names the right one: files, kinds, elements, materials, oils."""

import re

import pytest
from typer.testing import CliRunner

from bem import InputError, load_scene
from bem.cli import build
from bem.elements.element import MODELS, NOT_MODELLED, TITLES, element_template, load_element
from bem.lubrication.oils.catalogue import find_oil, oil_names
from bem.materials import CATALOGUE
from bem.scenes.kind import get_kind, kind_names


def bem(*words):
    """Exit code and output of a command; the messages of an error made on purpose."""
    done = CliRunner().invoke(build(), [str(word) for word in words])
    if isinstance(done.exception, InputError):
        return done.exception.exit_code, "\n".join(done.exception.messages)
    return done.exit_code, done.output


@pytest.fixture
def bearing(tmp_path):
    path = tmp_path / "nu208.toml"
    path.write_text(element_template("rolling-bearing"))
    return path


@pytest.mark.parametrize("command", [("run",), ("plan",), ("sweep", "--over", "speed=1,2")])
def test_an_element_given_as_a_scene_names_the_right_command(bearing, command):
    code, said = bem(command[0], bearing, *command[1:])
    assert code == 2
    assert f"bem element {bearing}" in said
    with pytest.raises(InputError, match="bem element"):
        load_scene({"element": "gear-pair"})


def test_a_scene_given_as_an_element_names_the_right_command(tmp_path):
    path = tmp_path / "s.toml"
    path.write_text('kind = "contact"\n')
    code, said = bem("element", path)
    assert code == 2
    assert "bem run" in said
    assert "not found" in bem("element", tmp_path / "t.toml")[1]


def test_a_file_that_is_not_there(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code, said = bem("run", "t.toml")
    assert code == 2
    assert said == "File t.toml not found. `bem scenes` lists the built-in scenes."
    (tmp_path / "bearings.toml").write_text("")
    assert 'did you mean "bearings.toml"?' in bem("plan", "bearing.toml")[1]
    assert 'did you mean "rough-contact"?' in bem("run", "rouhg-contact")[1]
    assert len(bem("run", "nothing-like-it")[1]) < 150
    assert len(bem("scenes", "--show", "foo")[1]) < 150


def test_new_without_a_kind_lists_kinds_and_elements():
    code, said = bem("new")
    assert code == 0
    for name in kind_names():
        assert f"{name} " in said
        assert get_kind(name).title in said
    for name, title in TITLES.items():
        assert f"{name} " in said
        assert title in said
    assert set(TITLES) == set(MODELS)


def test_new_of_an_unknown_word_lists_kinds_and_elements():
    code, said = bem("new", "foo")
    assert code == 2
    assert all(name in said for name in (*kind_names(), *MODELS))
    assert 'did you mean "gear-pair"?' in bem("new", "gear-par")[1]
    assert "bem new contact mine.toml" in bem("new", "mine.toml")[1]


@pytest.mark.parametrize("word", ["bush", "Bushing", "plain bearing", "sleeve_bearing"])
def test_names_of_a_plain_bush_write_one(word):
    assert element_template(word) == element_template("plain-bush")


def test_a_name_of_two_words_gives_a_file_whose_next_command_can_be_typed(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code, said = bem("new", "plain bearing")
    assert code == 0
    assert "next:    bem element plain-bearing.toml" in said
    assert (tmp_path / "plain-bearing.toml").is_file()
    code, said = bem("new", "plain bearing", "my bush.toml")
    assert "bem element 'my bush.toml'" in said


def test_journal_bearings_say_what_is_missing_and_what_can_be_done_instead():
    code, said = bem("new", "journal-bearing")
    assert code == 2
    assert all(part in said for part in ("wedge", "supply", "cavitation", "bem new plain-bush"))


def test_grease_says_what_can_be_done_instead():
    for command in (("new", "grease"), ("oils", "grease"), ("oils", "lithium grease")):
        code, said = bem(*command)
        assert code == 2
        assert "base oil" in said
        assert "[supply]" in said


def test_water_is_an_oil_that_a_scene_takes():
    code, said = bem("oils", "water")
    assert code == 0
    assert "653 uPa s" in said
    water = ("oil.grade=water", "oil.temperature=40 degC")
    wet = load_scene("traction-curve", ["thermal=lumped", *water]).oil.build()
    assert wet.viscosity == pytest.approx(6.53e-4, rel=1e-3)
    with pytest.raises(InputError, match="write grade, a name that `bem oils` lists"):
        load_scene("traction-curve", ["oil.grade=", "oil.name=water"])


def test_a_water_glycol_runs_with_the_coefficient_that_its_message_names():
    oil = ("oil.grade=water-glycol 46", "oil.temperature=40 degC")
    with pytest.raises(InputError, match="3 to 6 1/GPa are usual") as error:
        load_scene("starved-roller", ["thermal=off", *oil])
    key, value = re.search(r'(pressure_viscosity) = "([^"]+)"', str(error.value)).groups()
    assert load_scene("starved-roller", ["thermal=off", *oil, f"oil.{key}={value}"]).oil.build().viscosity > 0
    code, said = bem("oils", "water-glycol 46")
    assert code == 0
    assert f'{key} = "{value}"' in said


@pytest.mark.parametrize("word", NOT_MODELLED)
def test_what_is_not_modelled_has_its_own_answer(word):
    """The words are listed twice, in the command without loading the elements."""
    code, said = bem("new", word)
    assert code == 2
    assert NOT_MODELLED[word] in said


@pytest.mark.parametrize(
    ("word", "name"),
    [("PEEK", "peek"), ("nylon", "pa66"), ("Teflon", "ptfe"), ("pom", "pom"), ("polyamide", "pa66"), ("Delrin", "pom")],
)
def test_materials_are_found_by_common_names(word, name):
    code, said = bem("materials", word)
    assert code == 0
    assert said.startswith(name)


@pytest.mark.internal
def test_every_oil_that_is_listed_is_shown():
    assert oil_names()
    for name in oil_names():
        code, said = bem("oils", name)
        assert code == 0, name
        assert "viscosity" in said, name


def test_a_water_glycol_has_its_viscosity_and_asks_for_its_pressure_coefficient():
    oil = find_oil("water-glycol 46")
    assert oil.viscosity.kinematic(313.15) == pytest.approx(46e-6, rel=1e-9)
    assert "assumed" in oil.viscosity_source
    assert "assumed" not in find_oil("water-glycol 46", viscosity_index=180).viscosity_source


def test_a_material_by_a_part_of_its_name_proposes_all_that_have_it():
    said = bem("materials", "steel")[1]
    proposed = said.partition("?")[0]
    steels = [name for name in CATALOGUE if "steel" in name.split("-")]
    assert len(steels) > 3
    assert all(f'"{name}"' in proposed for name in steels)
    assert proposed.index("steel-52100") < proposed.index('"steel-disk"')
    with pytest.raises(InputError, match='did you mean "steel-52100"'):
        CATALOGUE["steel"]
    with pytest.raises(InputError, match=r'did you mean "steel-disk"[?]'):
        CATALOGUE["steel-disc"]


def test_rollers_need_a_length_and_balls_none(bearing):
    import tomllib

    table = tomllib.loads(bearing.read_text()) | {"name": "mine"}
    with pytest.raises(InputError, match=r'length = "11 mm"'):
        load_element(table | {"rolling": "roller"})
    with pytest.raises(InputError, match="no length"):
        load_element(table | {"length": "11 mm"})


def test_archard_without_a_distance_says_which():
    keys = ["wear.criterion={kind='archard', specific_wear_rate='1e-16 m^2/N'}"]
    with pytest.raises(InputError, match=r"criterion\.distance, the sliding distance that one cycle"):
        load_scene("wear-steel-steel", keys)
    with pytest.raises(InputError, match=r'kind = "archard", specific_wear_rate'):
        load_scene("wear-steel-steel", ["wear.criterion=archard"])
