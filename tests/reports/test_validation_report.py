"""The validation report: every line has a scene that exists, kept results, and a verdict; the page can be drawn."""

from bem.scenes.load import library
from reports.validation import CHECKS, STORED, build, rows, stored


def test_every_line_has_its_scene_and_its_kept_run():
    scenes = {check.scene for checks in CHECKS.values() for check in checks}
    assert scenes <= set(library())
    for scene in scenes:
        assert stored(scene)["status"] == "converged", scene
        assert stored(scene)["scene"] in (scene, "wear-steel-steel", "wear-mesh-convergence"), scene  # renamed since
    assert {path.stem for path in STORED.glob("*.json")} <= set(library())


def test_lines_are_filled_and_a_difference_comes_with_its_reason():
    lines = [line for checks in CHECKS.values() for line in rows(checks)]
    assert len(lines) > 25
    for item, source, ours, verdict, remark in lines:
        assert source, item
        assert ours != "not run", item
        assert verdict in ("agrees", "differs", "–")
        assert verdict != "differs" or remark, f"{item}: differs without a reason"


def test_the_page_is_drawn():
    page = build()
    body = "".join(section.body for section in page.sections)
    assert body.count("<img") >= 3
    assert "differs" in body
    assert "agrees" in body
