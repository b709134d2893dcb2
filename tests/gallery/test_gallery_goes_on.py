"""The gallery as a whole: a scene that fails, runs that are there, other sizes, what the page and the exit code say."""

import sys

import pytest

import reports.gallery
from reports.__main__ import main
from reports.builder import Page, Section, write_site
from reports.gallery import page, run_gallery, unfinished

SMALL = ("sinusoid", "hertz-cylinder", "hertz-sphere")


@pytest.fixture
def ran(monkeypatch):
    """Scenes that are run, in order; the second fails in a way nobody thought of."""
    names = []

    class Run:
        def __init__(self, path):
            self.path = path
            self.summary = {"status": "converged", "where": "", "wall_time_s": 1.0}

    def run(scene, folder, **keywords):
        names.append(scene["name"])
        if scene["name"] == "hertz-sphere":
            raise ZeroDivisionError("a bug")
        return Run(folder)

    monkeypatch.setattr(reports.gallery, "run_scene", run)
    monkeypatch.setattr(reports.gallery, "library", lambda: {name: LIBRARY[name] for name in SMALL})
    return names


LIBRARY = reports.gallery.library()


def test_a_scene_that_fails_does_not_stop_the_others(tmp_path, ran):
    said = []
    runs = run_gallery(tmp_path, reduced=True, say=said.append)
    assert sorted(ran) == sorted(SMALL)
    assert runs["hertz-sphere"] == "ZeroDivisionError: a bug"
    assert unfinished(runs) == ["hertz-sphere: ZeroDivisionError: a bug"]
    assert sum("left in all" in words for words in said) == 3
    assert "hertz-sphere failed: ZeroDivisionError: a bug" in said
    words = page(runs, reduced=True).sections[0].body
    assert "2 of 3 scenes converged" in words
    assert "not finished" in words


def test_the_exit_code_says_that_one_failed_and_the_page_is_there(tmp_path, ran, monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["reports", "gallery", "--reduced", "--out", str(tmp_path)])
    with pytest.raises(SystemExit) as end:
        main()
    assert end.value.code == 1
    assert "failed: hertz-sphere: ZeroDivisionError: a bug" in capsys.readouterr().err
    assert "2 of 3 scenes converged" in (tmp_path / "gallery.html").read_text()


def test_finished_runs_are_kept_and_those_of_another_size_replaced(tmp_path, monkeypatch):
    monkeypatch.setattr(reports.gallery, "library", lambda: {"sinusoid": LIBRARY["sinusoid"]})
    first = run_gallery(tmp_path, reduced=True)["sinusoid"]
    said = []
    again = run_gallery(tmp_path, reduced=True, say=said.append)["sinusoid"]
    assert again.summary == first.summary, "wall time and all"
    assert said == ["1 of 1, sinusoid: finished before"]
    (tmp_path / "sinusoid" / "results.nc").write_bytes(b"damaged")
    repaired = run_gallery(tmp_path, reduced=True)["sinusoid"]
    assert repaired.summary["wall_time_s"] != first.summary["wall_time_s"]
    assert repaired.dataset["pressure"].size
    monkeypatch.setattr(reports.gallery, "_reduced", lambda scene: scene | {"grid": scene["grid"] | {"shape": [16, 4]}})
    other = run_gallery(tmp_path, reduced=True)["sinusoid"]
    assert other.scene["grid"]["shape"] == [16, 4]


def test_the_index_keeps_pages_built_before(tmp_path):
    write_site([Page("validation", "Guide & more", "How to.", [Section("A", "<p>a</p>")])], tmp_path)
    write_site([Page("gallery", "Gallery", "All.", [Section("B", "<p>b</p>")])], tmp_path)
    index = (tmp_path / "index.html").read_text()
    assert index.index('href="validation.html">Guide &amp; more<') < index.index('href="gallery.html">Gallery<')
    assert "How to." in index
    assert 'href="validation.html"' in (tmp_path / "gallery.html").read_text()
