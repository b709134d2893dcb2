"""Edits of a scene's file from several pages and by hand: none is lost, and a broken file stays as it is."""

from functools import partial

import pytest

from bem import InputError
from bem.app.scene_file import SceneFile
from bem.app.workspace import Workspace
from bem.scenes.form import with_value

pytestmark = pytest.mark.internal

TEXT = 'kind = "contact"\nseed = 3\n\n[contact]\nmean_pressure = "80 MPa"\n'


def typed(key, text):
    return key, partial(with_value, key=key, text=text)


@pytest.fixture
def pages(tmp_path):
    workspace = Workspace(tmp_path)
    workspace.save_scene("own", TEXT)
    found = [SceneFile(workspace, "own") for _ in range(2)]
    for page in found:
        page.read()
    return [*found, workspace.scene_path("own")]


def test_different_keys_changed_in_two_pages_both_stay(pages):
    one, two, _ = pages
    assert one.edit(*typed("contact.mean_pressure", "90 MPa")) is None
    assert two.edit(*typed("seed", "7")) is None
    assert two.table["seed"] == 7
    assert two.table["contact"]["mean_pressure"] == "90 MPa"
    assert one.changed_elsewhere()
    assert not two.changed_elsewhere()
    assert one.read() == two.table


def test_the_same_key_changed_in_two_pages_is_a_conflict(pages):
    one, two, file = pages
    one.edit(*typed("seed", "4"))
    before = file.read_text()
    conflict = two.edit(*typed("seed", "5"))
    assert "seed was changed elsewhere to 4, and here to 5" in conflict.words
    assert file.read_text() == before
    assert two.edit(*typed("seed", "4")) is None  # both mean the same
    one.read()
    one.edit(*typed("seed", "6"))
    assert two.edit(*typed("seed", "5"), mine=True) is None
    assert two.table["seed"] == 5


def test_a_file_broken_by_hand_is_not_written(pages):
    one, _, file = pages
    file.write_text(TEXT + "[contact\n")
    with pytest.raises(InputError, match="not valid TOML"):
        one.edit(*typed("seed", "5"))
    assert file.read_text() == TEXT + "[contact\n"


def test_text_is_written_as_it_is_unless_it_was_changed_elsewhere(pages):
    one, two, file = pages
    text = "# by hand\n" + TEXT + "half = "
    assert one.write(text) is None
    assert file.read_text() == text
    assert two.write(TEXT + "# other\n").words
    assert file.read_text() == text
    assert two.write(TEXT, mine=True) is None
    assert file.read_text() == TEXT
