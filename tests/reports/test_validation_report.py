"""The validation report: every line has a scene that exists, kept results, and a verdict; the page can be drawn."""

import json

import pytest

from bem.scenes.load import library
from reports import open_choices, validation_values
from reports.experiments import kept
from reports.validation import CHECKS, build, counts, rows
from reports.validation_lines import CHOICES
from reports.validation_rules import film, running_in, tribofilm, wear
from reports.validation_values import (
    BASES,
    STORED,
    clear_minimum,
    criterion_over_archard,
    hertz_pressure,
    particles_per_mm_and_newton,
    signed_difference,
    stored,
)

LINES = [check for checks in CHECKS.values() for check in checks]


def test_every_line_has_its_scene_and_its_kept_run():
    scenes = {check.scene for check in LINES}
    assert scenes <= set(library())
    for scene in scenes:
        assert stored(scene)["status"] == "converged", scene
        assert stored(scene)["scene"] in (scene, "wear-steel-steel", "wear-mesh-convergence"), scene  # renamed since
    assert {path.stem for path in STORED.glob("*.json")} <= set(library())


def test_lines_are_filled_and_a_difference_comes_with_its_reason():
    lines = rows(LINES)
    assert len(lines) > 25
    for item, source, ours, verdict, accepted, remark in lines:
        assert source, item
        assert accepted, item
        assert ours != "not run", item
        assert verdict in counts([]), item
        assert not verdict.startswith("differs") or remark, f"{item}: differs without a reason"
        assert "{quoted}" not in remark, item


def test_lines_on_what_was_put_in_or_cannot_fail_are_marked_and_not_counted():
    for check, line in zip(LINES, rows(LINES), strict=True):
        assert check.basis in ("", *BASES), check.item
        assert (line[3] in BASES) == bool(check.basis), check.item
        assert bool(check.basis) == check.accepted.startswith("nothing: "), check.item
        if check.basis:  # what was chosen by a statement is calibrated and still has to meet it
            holds = {"input": (None,), "by construction": (True,), "calibrated": (None, True)}[check.basis]
            assert check.rule.agrees(check.summary()) in holds, check.item
    found = counts(rows(LINES))
    assert sum(found.values()) == len(LINES)
    uncounted = sum(found[basis] for basis in BASES)
    assert uncounted == sum(bool(check.basis) for check in LINES)


def test_remarks_read_what_they_quote_and_every_experiment_is_read(monkeypatch):
    """A rule quotes if and only if its remark leaves a place for it; no run is kept that no remark reads.

    In place of each experiment the kept result of its scene is given: the same figures, none of them not there.
    """
    runs, read = {run["name"]: run["scene"] for run in validation_values.experiments()}, set()

    def instead(name):
        read.add(name)
        return stored(runs[name])

    for module in (validation_values, film, running_in, tribofilm, wear, open_choices):
        monkeypatch.setattr(module, "experiment", instead)
    for check in LINES:
        check.summary()
        assert bool(check.rule.quoted(stored(check.scene))) == ("{quoted}" in check.remark), check.item
    open_choices.body()
    assert read == set(runs)


def test_an_experiment_that_was_not_run_or_is_stale_is_said_so_in_the_remark(monkeypatch, tmp_path):
    monkeypatch.setattr(validation_values, "EXPERIMENTS", tmp_path)
    check = next(check for check in LINES if check.item.startswith("bare brass disk"))
    ((*_, remark),) = rows([check])
    assert "not run with the cylinder as it is" in remark
    for run in validation_values.experiments():
        kept_result = {**stored(run["scene"]), "scene": run["scene"], "origin": None}
        (tmp_path / f"{run['name']}.json").write_text(json.dumps(kept_result))
    ((*_, remark),) = rows([check])
    assert "(5 of 5 stale)" in remark


def test_the_page_is_drawn():
    page = build()
    body = "".join(section.body for section in page.sections)
    assert body.count("<img") >= 3
    assert "differs" in body
    assert "agrees" in body


def test_chosen_parameters_have_reasons():
    assert len({what for what, _, _ in CHOICES}) == len(CHOICES)
    for what, choice, reason in CHOICES:
        assert choice, what
        assert reason, what


def test_difference_keeps_its_sign_and_is_taken_where_it_is_largest():
    curves = [
        {"load_N": 1.0, "variant": "", "model": "elastic", "friction": [0.10, 0.05, 0.02]},
        {"load_N": 1.0, "variant": "", "model": "uncoupled_elastic", "friction": [0.10, 0.04, 0.021]},
    ]
    assert signed_difference({"curves": curves}, curves[0]) == pytest.approx(-25.0)


def test_a_minimum_is_clear_when_both_ends_lie_above_it_by_more_than_the_spread():
    spread = {"friction_run_in_spread": [1e-3, 1e-3, 1e-3]}
    assert clear_minimum({"friction_run_in": [0.14, 0.13, 0.14], **spread})
    assert not clear_minimum({"friction_run_in": [0.14, 0.13, 0.1305], **spread})
    assert not clear_minimum({"friction_run_in": [0.12, 0.13, 0.14], **spread})


def test_derived_numbers():
    assert hertz_pressure(5.5) == pytest.approx(0.1297, abs=1e-4)  # 130 MPa, four digits by hand
    # one cubic micrometre in ten pieces while 0.04 N slide 0.3 um: 1e-9 mm^3 / 1.2e-8 N m
    summary = {
        "load_N": [10.0],
        "cell_nm": [100.0],
        "worn_volume_per_cycle_um3": [1.0],
        "particles_per_cycle": [10.0],
    }
    assert criterion_over_archard(summary, 10.0, 350e-7) == pytest.approx(1e-9 / (0.04 * 3e-7) / 350e-7)
    assert particles_per_mm_and_newton(summary, 10.0, 350e-7) == pytest.approx(350e-7 / 1e-10 * 1e-3)


def test_figures_of_others_are_stored_and_the_rigid_limit_of_rolling_holds():
    """Resistance to rolling against quadrature of Reynolds' equation; 2e-4 is its stored mesh error at twice the
    points, M = 0.01 is within 1e-4 of the limit."""
    from reports import independent
    from reports.experiments.independent_figures import rigid_constant, rolling

    page = independent.body()
    assert "Not run" not in page
    assert page.count("agrees") + page.count("differs") + page.count("converges") >= 20  # a verdict to each line
    assert rolling(0.01, 8.0, 500) / (0.01 * 1e-11**1.5) ** 0.5 == pytest.approx(rigid_constant(), rel=5e-4)


def test_moes_asymptotes():
    """His 3 and 1.287 by quadrature, to his digits; films by the solver near them, on a fifth of the stored points."""
    from reports.experiments.film_regimes import film as thickness
    from reports.experiments.film_regimes import rigid_constants

    isoviscous, piezoviscous = rigid_constants()
    assert isoviscous == pytest.approx(3, rel=1e-9)
    assert piezoviscous == pytest.approx(1.287, abs=5e-4)
    found, status = thickness(0.01, 0.0, 400)
    assert status == "converged"
    assert 0.01 * found == pytest.approx(3, rel=5e-3)  # mesh 2e-3 at 400 points
    found, status = thickness(3.0, 50.0, 400)
    assert status == "converged"
    assert found == pytest.approx(piezoviscous * 50 ** (2 / 3), rel=0.02)  # 0.8 % by the load, the rest is the mesh


def test_verdicts_on_figures_of_others_can_fail():
    from reports import independent

    regimes = kept.found("film_regimes")
    before = independent._regimes(regimes).count("agrees")
    regimes["deepest"]["elastic_isoviscous"]["H"] *= 1.2
    regimes["map"][0]["H"] *= 1.2
    assert independent._regimes(regimes).count("agrees") == before - 2
    (curve,) = kept.found("load_share_curves")[:1]
    assert "differs" in independent._load_shares([curve])
    assert "agrees" in independent._load_shares([{**curve, "B": 2.0, "C": 1.0, "largest": 0.01}])
    hard = kept.found("independent_figures")
    stalled = [{**hard["plastic"][0], "status": "stalled"}]
    assert "stalled" in independent._hard_cases(stalled, hard["near_full"])


def test_neglects_are_the_largest_changes_along_a_curve():
    """What did not converge is not compared, and is said."""
    from reports import neglects

    curves = [
        {"name": name, "speeds": [0.1, 1.0, 10.0], "friction": friction, "contact_share": share,
         "minimum_film": film, "status": status}
        for name, friction, share, film, status in (
            ("base", [0.1, 0.05, 0.02], [0.9, 0.5, 0.0], [1e-8, 1e-7, 1e-6], ["converged"] * 3),
            ("less", [0.09, 0.05, 1.0], [0.8, 0.6, 0.9], [1e-8, 0.5e-7, 9.0], ["converged"] * 2 + ["stalled"]),
            ("more", [50.0, 0.05, 0.02], [0.9, 0.5, 0.0], [1e-8, 1e-7, 1e-6], ["converged"] * 3),
        )
    ]  # fmt: skip
    less, more = neglects._lines("bearing", "base", curves)
    assert less[1] == "less (1 speed did not converge)"
    assert less[2:4] == ("-10 %", "0.1 m/s")
    assert less[4:6] == ("-50 %", "1 m/s")
    assert less[6] in ("-0.100", "+0.100")
    assert more[2] == "500 times as much"
    page = neglects.body()
    assert "Not run" not in page
    assert page.count("<tr>") >= 12
