"""The guide as a site: a page for every kind, whose theory, limits and scenes exist; nothing from a network."""

import re

import pytest

from bem.runs import plan_scene
from bem.scenes import library
from bem.scenes.kind import _of_the_package
from reports import guide, site
from reports.builder import render, write_site
from reports.gallery import gallery_scene


@pytest.fixture(scope="module")
def pages():
    return site.pages({"rough-contact": "no run in this test"})


@pytest.mark.parametrize("kind", site.WORDS["kinds"])
def test_what_a_page_names_exists(kind):
    words = site.WORDS["kinds"][kind]
    assert {library()[scene]["kind"] for scene in words["scenes"]} == {kind}
    titles, assumptions = {item[0] for item in guide.THEORY}, {item[0] for item in guide.LIMITS}
    assert set(words["theory"]) <= titles
    assert set(words["limits"]) <= assumptions


def test_every_limit_and_formula_is_on_the_page_of_a_kind():
    for key, known in (("theory", guide.THEORY), ("limits", guide.LIMITS)):
        named = {title for words in site.WORDS["kinds"].values() for title in words[key]}
        assert named == {item[0] for item in known}


@pytest.mark.internal
@pytest.mark.slow
def test_every_kind_has_a_page_with_errors_and_limits_and_nothing_is_from_a_network(pages, tmp_path):
    assert set(site.WORDS["kinds"]) == set(_of_the_package())
    names = {page.name for page in pages}
    assert names >= {"theory", "thesis", "errors", *(f"kind-{kind}" for kind in _of_the_package())}
    for page in pages:
        text = render(page, pages)
        assert not re.search(r'(src|href)="(https?:)?//', text), page.name
        if page.name.startswith("kind-"):
            titles = [section.title for section in page.sections]
            assert titles[0] == "Pictures"
            assert {"Keys", "Figures and their errors", "Theory", "Limits"} <= set(titles)
    assert "no run in this test" in render(next(page for page in pages if page.name == "kind-contact"))
    written = write_site(pages, tmp_path)
    assert written[-1].name == "index.html"
    index = written[-1].read_text("utf-8")
    assert all(f'{page.name}.html"' in index for page in pages)
    # a list of contents is for several sections
    short, long = ((tmp_path / f"{name}.html").read_text("utf-8") for name in ("elements", "start"))
    assert ('class="contents"' in short, 'class="contents"' in long) == (False, True)


def test_curves_over_speed_in_the_guide_have_nine_points_over_their_whole_range(tmp_path):
    names = [name for kind in ("friction", "running-in") for name in site.WORDS["kinds"][kind]["scenes"]]
    full = [name for name in names if len(library()[name]["speeds"].get("values", range(9))) >= 9]
    assert len(full) >= 3
    for name in full:
        scene, _ = plan_scene(gallery_scene(name, tmp_path, reduced=True, speeds=site._SPEEDS))
        whole, _ = plan_scene(gallery_scene(name, tmp_path))
        few, many = scene.speeds.build(), whole.speeds.build()
        assert len(few) == 9
        assert few[0] == pytest.approx(many[0])
        assert few[-1] == pytest.approx(many[-1])
