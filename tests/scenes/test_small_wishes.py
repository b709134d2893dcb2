"""Keys taken out, names that people guess, checksums of surface files, seams that are no results."""

import hashlib
import shutil

import numpy as np
import pytest

from bem import CATALOGUE, Body, Grid, InputError, Layer, Material, contact_modulus, load_scene, plan_scene, run_scene
from bem.elements.element import element_template, load_element
from bem.scenes.build import heights_of
from bem.scenes.checks import OUTCOME_CHECKS, examine
from bem.scenes.checks.overview import bodies
from bem.scenes.common import MeasuredSurface
from bem.scenes.context import Outcome, Variable
from bem.scenes.form import library_scene, with_value
from bem.scenes.kind import get_kind
from bem.scenes.load import changed_description, dump_scene, library, scene_from_table
from bem.scenes.maps import map_on
from bem.scenes.template import scene_template
from bem.scenes.validate import validate
from bem.surfaces.examples import FOLDER

PAIR = ("lower.surface.path=example/ground-disk.al3d", "upper.surface.path=example/polished-pin.x3p")


def test_a_key_is_taken_out():
    scene = load_scene("rough-contact", ("contact.mean_pressure=", "contact.load=3 N"))
    assert scene.contact.load == 3.0
    assert scene.contact.mean_pressure is None
    assert load_scene("hertz-sphere", ("description=",)).description == ""


@pytest.mark.parametrize(
    ("setting", "words"),
    [
        ("contact.laod=", r"contact.laod=: is not set.*contact.load"),
        ("contact.load.more=", "is not set"),
        ("contact[2]=", "is not set"),
    ],
)
def test_what_is_not_there_cannot_be_taken_out(setting, words):
    with pytest.raises(InputError, match=words):
        load_scene("hertz-sphere", (setting,))


@pytest.mark.internal
def test_entries_of_lists_are_taken_out_and_the_source_stays():
    table = {"kind": "film", "name": "x", "list": [1, 2, 3]}
    from bem.scenes.load import read_table

    assert read_table(table, ("list[1]=",))["list"] == [1, 3]
    assert table["list"] == [1, 2, 3]


@pytest.mark.parametrize(
    ("word", "kind"),
    [("stribeck", "friction"), ("Hertz", "contact"), ("running_in", "running-in"), ("zddp", "tribofilm")],
)
def test_new_takes_names_that_people_guess(word, kind):
    assert scene_template(word) == scene_template(kind)


def test_new_gives_built_in_scenes_and_near_spellings():
    assert "Hertz' point contact" in scene_template("hertz-sphere")
    with pytest.raises(InputError, match='did you mean "stribeck"'):
        scene_template("stribek")


@pytest.mark.parametrize("name", ["traction", "contact", "traction-curve", "hertz-sphere"])
def test_a_new_scene_has_no_description_of_another_case(name, tmp_path):
    (tmp_path / "own.toml").write_text(scene_template(name))
    assert load_scene(tmp_path / "own.toml").description == ""


@pytest.mark.parametrize("name", ["gear-pair", "rolling-bearing", "cam-follower", "piston-ring", "plain-bush"])
def test_a_new_element_has_no_description_of_another_case(name, tmp_path):
    (tmp_path / "own.toml").write_text(element_template(name))
    assert load_element(tmp_path / "own.toml").model.description == ""


def test_a_changed_scene_says_what_it_is_based_on(tmp_path):
    own = load_scene("traction-curve").description
    changed = load_scene("traction-curve", ('oil.grade="ISO VG 220"', "film.points=300"))
    assert "VG 68" not in changed.description
    assert "traction-curve" in changed.description
    assert 'oil.grade="ISO VG 220"; film.points=300' in changed.description
    assert load_scene("traction-curve", ("name=mine", "accuracy=1%")).description == own
    assert load_scene("traction-curve", ('oil.grade="ISO VG 68"',)).description == own  # as it was
    assert load_scene("traction-curve", ("description=mine", "film.points=300")).description == "mine"
    (tmp_path / "run.toml").write_text(dump_scene(changed))
    again = load_scene(tmp_path / "run.toml", ("film.points=400",)).description
    assert again == changed.description.replace("=300", "=400")


@pytest.mark.internal
def test_an_own_description_is_kept_with_the_changes_behind_it():
    table = {key: item for key, item in library()["hertz-sphere"].items() if key != "description"}
    assert load_scene(table, ("contact.load=7 N",)).description == ""
    own = load_scene(table | {"description": "my ball"}, ("contact.load=7 N",)).description
    assert own == "my ball (changed: contact.load=7 N)"
    assert changed_description(own, ["contact.load=8 N"]) == "my ball (changed: contact.load=8 N)"


@pytest.mark.internal
def test_the_form_of_the_page_marks_a_changed_built_in_scene():
    table = with_value(library_scene("traction-curve"), "oil.grade", "ISO VG 220")
    assert "VG 68" not in table["description"]
    assert "traction-curve" in table["description"]


@pytest.mark.internal
@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("running-in-stribeck", "contact region"),
        ("running-in-ball", "track, which is as wide as the contact"),
        ("wear-steel-steel", ""),  # the track of a cylinder is the whole grid
        ("rough-contact", ""),
    ],
)
def test_a_plan_says_of_which_region_its_roughness_is(name, told):
    """A plan said Sq 226 nm of a surface whose results began with Sq 154.7 nm, that of the contact region."""
    rows = [text for _, text in bodies(examine(plan_scene(name)[0]))]
    assert any(text.startswith("on the whole grid: Sq") for text in rows)
    (found,) = [text for text in rows if text.startswith("results give Sq")] or [""]
    assert (told in found) if told else not found


def test_the_catalogue_knows_near_spellings_and_is_a_body():
    with pytest.raises(KeyError, match='did you mean "silicon-nitride"') as caught:
        CATALOGUE["silicon nitrid"]
    assert isinstance(caught.value, InputError)
    steel = CATALOGUE["steel-52100"]
    assert isinstance(steel, Body)
    assert steel.homogeneous
    assert Body(steel, layer=Layer(CATALOGUE["dlc"], 1e-6)).layer.material == CATALOGUE["dlc"].material
    assert contact_modulus(steel, CATALOGUE["dlc"]) == contact_modulus(steel.material, CATALOGUE["dlc"].material)
    assert all(entry.source for entry in CATALOGUE.values())
    assert all(isinstance(entry.material, Material) for entry in CATALOGUE.values())


@pytest.mark.internal
def test_a_run_keeps_the_checksum_and_a_changed_file_is_refused(tmp_path):
    own = tmp_path / "disk.al3d"
    shutil.copy(FOLDER / "ground-disk.al3d", own)
    scene, _ = plan_scene("measured-surfaces", (f"lower.surface.path={own}", PAIR[1]))
    assert scene.lower.surface.sha256 == hashlib.sha256(own.read_bytes()).hexdigest()
    again = tmp_path / "scene.toml"
    again.write_text(dump_scene(scene))
    assert plan_scene(again)[0] == scene
    own.write_bytes(own.read_bytes()[:-4] + b"\0\0\0\0")
    with pytest.raises(InputError, match=r"lower.surface.*disk.al3d has changed since"):
        load_scene(again)
    assert load_scene(again, ("lower.surface.sha256=",)).lower.surface.sha256 is None


@pytest.mark.internal
def test_periodic_measured_maps_have_no_step():
    scene, _ = plan_scene("measured-surfaces", (*PAIR, "lower.surface.despike=6"))
    notes = []
    from bem.scenes.build import grid_of

    heights = heights_of(scene.lower.surface, grid_of(scene.grid), 1, notes.append)
    across = np.sqrt(np.mean((heights[0] - heights[-1]) ** 2))
    inside = np.sqrt(np.mean(np.diff(heights, axis=0) ** 2))
    assert across < 1.5 * inside
    (seams,) = (note for note in notes if (note.code, note.values.get("reason")) == ("map-altered", "seams"))
    # a remark without its number, and a caution with it, looked like two rules
    share = f"{100 * seams.values['share']:.2g} % of Sq"
    assert seams.headline.endswith(f"Making the map periodic changed its heights by {share}")
    assert "up to 30 % of Sq the map counts as the same" in str(seams)
    assert any((note.code, note.values.get("reason")) == ("map-altered", "spikes") for note in notes)


def test_a_pressure_on_a_mirror_seam_is_said_to_be_one(tmp_path):
    """A slope along x: mirrored, it is a ridge along the seam, which carries all of the load."""
    path = tmp_path / "slope.npz"
    from bem import Surface, write_surface

    x = np.linspace(0, 1, 32)[:, None]
    write_surface(path, Surface(1e-7 * x + 1e-9 * np.cos(9 * np.arange(32)), (1e-6, 1e-6)))
    table = {
        "kind": "contact",
        "grid": {"shape": [64, 32], "spacing": "1 um", "periodic": True},
        "lower": {
            "material": "steel-52100",
            "surface": {"kind": "measured", "path": str(path), "detrend": "none", "mirror": "x"},
        },
        "contact": {"mean_pressure": "10 MPa"},
        "outputs": {"errors": False},
    }
    done = run_scene(table, tmp_path / "run", figures=False)
    assert [note for note in done.summary["notes"] if note["code"] == "pressure-at-seam"]


def test_the_load_beside_a_seam_is_compared_with_its_area_where_cells_share_the_hardness():
    """15 % of the load on 2.5 % of the area stood without a note: many cells have the highest pressure of a cap."""
    table = {
        "kind": "contact",
        "grid": {"shape": 80, "spacing": "0.8 um", "periodic": True},
        "lower": {
            "material": "steel-52100",
            "surface": {"kind": "measured", "path": "example/polished-pin.x3p", "mirror": "x"},
        },
        "contact": {"mean_pressure": "10 MPa", "behaviour": "capped", "hardness": "7 GPa"},
    }
    kind = get_kind("contact")
    facts = examine(kind.resolved(scene_from_table(table)))
    check = OUTCOME_CHECKS["highest_pressure_at_a_seam"]

    def told(ridge_cells):
        pressure = np.zeros((1, 80, 80))
        pressure[0, 10, :40] = 7e9  # the first, and as high as any
        pressure[0, 39:41, :ridge_cells] = 7e9
        variable = Variable(("load", "x", "y"), pressure, "Pa", "contact pressure")
        return list(check(facts, Outcome({}, {"pressure": variable})))

    (note,) = told(4)
    assert (note.values["reason"], note.values["axes"]) == ("load", "x")
    assert note.values["load"] == pytest.approx(8 / 48, rel=1e-12)
    assert note.values["area"] == pytest.approx(2 / 80, rel=1e-12)
    assert told(1) == []


@pytest.mark.parametrize(
    ("mirror", "cells", "reason", "part"),
    [("both", 48, "mirror-cut", "25 % of the map"), ("both", 96, "mirror", "the map"), ("x", 48, "mirror-cut", "50 %")],
)
def test_a_mirrored_map_on_a_grid_as_large_as_the_map_is_cut(tmp_path, mirror, cells, reason, part):
    """The grid of 150 um held a quarter of the map four times, and the note told of the whole map four times."""
    from bem import Surface, write_surface

    path = tmp_path / "map.npz"
    write_surface(path, Surface(1e-8 * np.random.default_rng(0).standard_normal((48, 48)), (1e-6, 1e-6)))
    surface = validate({"kind": "measured", "path": str(path), "mirror": mirror}, MeasuredSurface)
    (note,) = map_on(surface, Grid((cells, cells), (1e-6, 1e-6), periodic=(True, True))).notes[:1]
    assert note.values["reason"] == reason
    assert note.values["part"].startswith(part)


def test_notes_on_seams_lead_to_no_circle(tmp_path):
    """`mirror = "both"` was advised where closing the seams was well, and to leave mirrors out where they were set."""
    from bem import Surface, write_surface

    path = tmp_path / "map.npz"
    write_surface(path, Surface(1e-8 * np.random.default_rng(0).standard_normal((48, 48)), (1e-6, 1e-6)))
    surface = validate({"kind": "measured", "path": str(path)}, MeasuredSurface)
    (note,) = map_on(surface, Grid((48, 48), (1e-6, 1e-6), periodic=(True, True))).notes
    assert note.values["reason"] == "seams"
    assert "mirror" not in str(note)
