"""Damage that a user meets: results of a finished run, a point of a sweep, scene files of another encoding, no name."""

import codecs
import os
import shutil

import pytest
from typer.testing import CliRunner

from bem import InputError, load_scene, run_scene, run_sweep
from bem.cli import build
from bem.elements.element import element_template, load_element
from bem.errors import ResultsError
from bem.results.checkpoint import load_checkpoint, save_checkpoint
from bem.results.export import points_of
from bem.results.read import damaged_files, open_run
from bem.scenes.paths import values_in_file

SCENE = {
    "kind": "contact",
    "name": "small",
    "grid": {"shape": 16, "spacing": "0.5 um", "periodic": True},
    "lower": {"material": "steel-disk", "surface": {"kind": "generated", "rms_height": "0.1 um", "hurst": 0.8}},
    "contact": {"mean_pressure": "20 MPa"},
}


def bem(*words):
    done = CliRunner().invoke(build(), [str(word) for word in words])
    made_on_purpose = isinstance(done.exception, InputError | ResultsError)
    assert done.exception is None or made_on_purpose or isinstance(done.exception, SystemExit)
    return done.exit_code if not made_on_purpose else done.exception.exit_code, done.output + str(done.exception or "")


@pytest.fixture
def finished(tmp_path):
    return run_scene(SCENE, tmp_path / "run", figures=False).path


def empty(path):
    path.write_bytes(b"")


def garble(path):
    path.write_bytes(os.urandom(300))


def flip(path):
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 1
    path.write_bytes(data)


def remove(path):
    path.unlink()


def make_folder(path):
    path.unlink()
    path.mkdir()


@pytest.mark.internal
@pytest.mark.parametrize("damage", [empty, garble, flip, remove, make_folder])
def test_a_finished_run_with_damaged_results_is_not_resumed_as_whole(finished, damage):
    whole = run_scene(SCENE, finished, resume=True, figures=False)
    assert whole.summary["status"] == "converged"
    damage(finished / "results.nc")
    with pytest.raises(ResultsError, match=r"results\.nc.*--overwrite"):
        run_scene(SCENE, finished, resume=True, figures=False)
    code, said = bem("run", finished, "--resume", "--no-figures")
    assert code == 4
    assert "results.nc" in said
    if damage is make_folder:
        assert "move the folder" in said
        (finished / "results.nc").rmdir()
    again = run_scene(SCENE, finished, overwrite=True, figures=False)
    assert damaged_files(again.path) == []
    assert again.dataset["pressure"].shape == (16, 16)


def test_pictures_that_are_gone_do_not_make_a_run_damaged(tmp_path):
    path = run_scene(SCENE, tmp_path / "run").path
    shutil.rmtree(path / "figures")
    (path / "report.html").unlink()
    assert run_scene(SCENE, path, resume=True).summary["status"] == "converged"


@pytest.mark.internal
def test_a_sweep_computes_a_damaged_point_again(tmp_path):
    done = run_sweep(SCENE, ["seed=1,2"], tmp_path / "all", workers=1)
    assert done.computed == 2
    point = min((done.path / "points").iterdir())
    flip(point / "results.nc")
    again = run_sweep(SCENE, ["seed=1,2"], tmp_path / "all", workers=1, resume=True)
    assert again.computed == 1
    assert damaged_files(point) == []


@pytest.mark.internal
@pytest.mark.parametrize("content", [b"", b'kind = "contact', b"\xff\xfe\x00", None])
def test_a_sweep_with_a_damaged_point_is_exported_with_a_message(tmp_path, content):
    folder = run_sweep(SCENE, ["seed=1,2"], tmp_path / "all", workers=1).path
    whole = points_of(folder)
    point = min((folder / "points").iterdir())
    if content is None:
        (point / "scene.toml").unlink()
    else:
        (point / "scene.toml").write_bytes(content)
    found = points_of(folder)
    assert found.csv() == whole.csv()
    (note,) = found.notes
    assert point.name in note
    assert "--resume" in note
    code, said = bem("export", folder, "--csv", "--out", tmp_path / "tables")
    assert code == 0
    assert point.name in said
    assert (tmp_path / "tables" / "all-points.csv").read_text() == whole.csv()


@pytest.mark.parametrize("command", ["run", "sweep"])
def test_an_empty_name_of_a_folder_is_refused(tmp_path, monkeypatch, command):
    monkeypatch.chdir(tmp_path)
    over = ["--over", "seed=1,2"] if command == "sweep" else []
    code, said = bem(command, "hertz-sphere", *over, "--out", "")
    assert code == 2
    assert "--out" in said
    with pytest.raises(InputError, match="empty name"):
        run_scene(SCENE, "") if command == "run" else run_sweep(SCENE, ["seed=1,2"], "")
    assert os.listdir(tmp_path) == []


@pytest.mark.internal
def test_files_in_utf8_may_begin_with_a_byte_order_mark(tmp_path):
    text = 'kind = "contact"\ngrid = {shape = 16, spacing = "0.5 um"}\nlower = {material = "steel-disk"}\n'
    text += 'contact = {load = "1 mN"}\nshape = {kind = "sphere", radius = "1 mm"}\ndescription = "\u00b5"\n'
    path = tmp_path / "marked.toml"
    path.write_bytes(codecs.BOM_UTF8 + text.encode())
    assert load_scene(path).description == "\u00b5"
    for encoding in ("utf-16", "utf-16-be"):
        path.write_bytes((codecs.BOM_UTF16_BE if encoding == "utf-16-be" else b"") + text.encode(encoding))
        with pytest.raises(InputError, match=r"UTF-16; save it in UTF-8"):
            load_scene(path)
    path.write_bytes(codecs.BOM_UTF8 + element_template("gear-pair").encode())
    assert load_element(path).found.contacts
    path.write_bytes(codecs.BOM_UTF8 + b"1 N\n2 N\n")
    assert list(values_in_file(str(path), "--over")) == ["1 N", "2 N"]


@pytest.mark.internal
def test_a_damaged_checkpoint_is_said_once(tmp_path):
    path = tmp_path / "checkpoint.bin"
    save_checkpoint(path, {"a": 1})
    flip(path)
    with pytest.raises(ResultsError) as refused:
        load_checkpoint(path)
    assert str(refused.value).count("checkpoint.bin") == 1
    assert str(refused.value).count("the checkpoint") == 1
    path.unlink()
    path.mkdir()
    with pytest.raises(ResultsError, match="cannot be read"):
        load_checkpoint(path)


def test_a_finished_run_opens_as_before(finished):
    assert open_run(finished).dataset["pressure"].shape == (16, 16)
