"""The verification report: every case is there, every picture shows."""

import copy
import dataclasses
import html
import itertools
import re
import shutil
import subprocess

import numpy as np
import pytest

from bem.verification import registry
from reports import (
    builder,
    caught,
    lumped_heat,
    point_film,
    reproduced,
    rolling_waves,
    rough_films,
    starved_point,
    touching_films,
    verification,
)
from reports.experiments import kept, point_table
from reports.prose import prose

FEW = (
    "disc-hertz-soft",
    "harmonic-antiplane-soft",
    "contact-row-plain",
    "bush-peek-wide",
    "oblique-wave",
    "refinement-strip-normal",
)


@pytest.fixture(scope="module")
def few_gates():
    return [gate for gate in registry.gates() if gate.name in FEW]


@pytest.fixture(scope="module")
def page(few_gates):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(registry, "gates", lambda: few_gates)
        patch.setattr(verification, "set_spectra_memory", lambda limit: None)  # tests share the caches of a process
        patch.setattr(verification, "set_stress_memory", lambda limit: None)
        return verification.build()


def test_every_gate_has_a_section_with_figure_and_table(page, few_gates):
    bodies = {section.title: section.body for section in page.sections}
    for gate in few_gates:
        assert "data:image/png" in bodies[gate.name]
        assert "<table>" in bodies[gate.name]
        assert 'class="fail"' not in bodies[gate.name]


def test_line_films_are_shown_with_orders_and_fits(page):
    (body,) = [section.body for section in page.sections if section.title == "Line-contact film"]
    assert "data:image/png" in body
    assert body.count("<tr>") == 61  # twelve loads, five piezoviscous parameters, the head
    assert "Moes" in body
    assert "Dowson" in body


def test_point_films_are_shown_with_orders_and_fits(page):
    (body,) = [section.body for section in page.sections if section.title == "Point-contact film"]
    rows = kept.found("point_table")["contacts"]
    assert "data:image/png" in body
    assert len(rows) == 18  # three loads, two oils, three ellipses
    assert body.count("<tr>") == 2 * (len(rows) + 1)  # central and minimum films, with heads
    assert {(row["ratio"], row["load"], row["oil"]) for row in rows} == set(
        itertools.product(point_table.RATIOS, point_table.LOADS, point_table.OILS)
    )
    assert "Hamrock and Dowson" in body
    assert "Nijenbanning" in body
    surveyed = [row["status"] for row in kept.found("point_films")["contacts"]]
    assert f"{surveyed.count('converged')} converge, {surveyed.count('stalled')} stall" in body


def test_a_point_film_that_stalled_is_shown_as_none(monkeypatch):
    stored = copy.deepcopy(kept.found("point_table"))
    for row in stored["contacts"]:
        row["status"] = ["converged"] * 3
    stored["contacts"][0] |= {"status": ["converged", "converged", "stalled"], "central_bar": None, "minimum_bar": None}
    for row in stored["contacts"][1:]:  # stored ones that stalled have none
        row |= {f"{name}_bar": row[f"{name}_bar"] or 1.0 for name in ("central", "minimum")}
    both = {"point_table": stored, "point_films": kept.found("point_films")}
    monkeypatch.setattr(point_film, "found", both.__getitem__)
    assert point_film.body().count(">stalled<") == 2  # its central and its minimum film


def test_results_say_when_they_were_reproduced(monkeypatch):
    monkeypatch.setattr(reproduced, "words", lambda name: f"reproduced {name}")
    shown = (
        point_film.body()
        + rolling_waves.body()
        + rough_films.body()
        + touching_films.body()
        + lumped_heat.chapter().body
    )
    own = ("point_table", "point_films", "starved_point", "long_ellipse")
    for name in (*own, "waviness_reduction", "rough_films", "touching_films", "lumped_heat"):
        assert f"Result of {name}: reproduced {name}." in shown, name


def test_a_starved_balls_exponent_is_that_of_its_curve():
    assert starved_point.exponent(1.0, 2 ** (-1 / 3)) == pytest.approx(3.0, rel=1e-9)  # its definition
    assert starved_point.exponent(0.5, 0.6) is None  # more than comes in


def test_an_order_of_point_films_is_of_three_converged_grids():
    row = {"status": ["stalled", "converged", "converged"], "central_order": 2.0}
    assert point_film._order(row, "central") is None
    assert point_film._order(row | {"status": ["converged"] * 3}, "central") == 2.0


def test_observed_orders_and_limits_are_those_of_errors_that_fall_by_a_law():
    exact, rate = 2.0, 1.7
    found = point_table._converged(np.array([exact * (1 - 0.01 * 2 ** (-rate * level)) for level in range(3)]))
    assert found[""] == pytest.approx(exact, rel=1e-12)  # only rounding
    assert found["_order"] == pytest.approx(rate, rel=1e-9)  # rounding over differences of 1e-3
    assert found["_errors"] == pytest.approx([-(2 ** (-rate * level)) for level in range(3)], rel=1e-8)
    assert point_table._converged(np.array([1.0, 1.2, 1.1]))["_order"] is None


def test_what_the_tests_catch_is_counted_with_each_survivor_and_its_reason(page):
    (shown,) = [section.body for section in page.sections if section.title == "What the tests catch"]
    for entry in caught.outcomes():
        told = entry["result"] == "survived" or "survived_before" in entry
        assert (html.escape(entry["slip"]) in shown) is told
    killed = {"room": "contact", "file": "bem/a.py", "slip": "a", "result": "killed", "processor_s": 2.0}
    survived = killed | {"slip": "b", "result": "survived", "suite": "full", "reason": "gap: no test of b"}
    closed = killed | {"slip": "d", "survived_before": "fast", "by": "tests/test_d.py::test_d"}
    body = caught.body([killed, closed, survived, survived | {"slip": "c", "reason": "equivalent: c is never read"}])
    numbers = r'<td class="number">(\d+)</td>' * 6
    assert re.findall(rf"<td>contact</td>{numbers}", body) == [("4", "2", "1", "1", "1", "0")]
    assert "tests/test_d.py::test_d" in body
    assert "gap: no test of b" in body
    assert ">a<" not in body


def test_waves_that_roll_through_are_shown_with_fits(page):
    (body,) = [section.body for section in page.sections if section.title == "Waves that roll through a film"]
    assert "data:image/png" in body
    # in line contacts, under balls, random surfaces, the heads
    assert body.count("<tr>") == 6 + 7 + 1 + 10 + 1
    assert "Venner" in body


@pytest.fixture(scope="module")
def page_of_a_broken_gate(few_gates):
    """The report of one gate of an unknown family, whose curves are off by one per cent."""
    (gate,) = [gate for gate in few_gates if gate.name == "oblique-wave"]

    def curves():
        return [dataclasses.replace(curve, bem=1.01 * curve.bem) for curve in gate.curves()]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(registry, "gates", lambda: [dataclasses.replace(gate, family="brand_new", curves=curves)])
        patch.setattr(verification, "set_spectra_memory", lambda limit: None)
        patch.setattr(verification, "set_stress_memory", lambda limit: None)
        return verification.build()


def test_rows_that_fail_are_said_first(page_of_a_broken_gate):
    assert "NOT within tolerance" in page_of_a_broken_gate.lead
    assert page_of_a_broken_gate.sections[0].title == "Verdict"
    assert "FAILED" in page_of_a_broken_gate.sections[0].body


def test_every_family_of_gates_is_in_the_report_with_a_title():
    done = [verification._Done(gate, [], []) for gate in registry.gates()]
    shown = [member.gate.name for _, _, members in verification._families(done) for member in members]
    assert sorted(shown) == sorted(gate.name for gate in registry.gates())
    assert {gate.family for gate in registry.gates()} == set(prose("verification")["families"])


def test_a_family_that_nobody_wrote_words_for_is_shown_and_counted(page_of_a_broken_gate):
    assert "brand new" in page_of_a_broken_gate.sections[0].body
    assert [section.title for section in page_of_a_broken_gate.sections if section.title == "oblique-wave"]


def look(browser, html_page, tmp_path):
    """The page as a browser sees it, every picture marked with its width."""
    script = (
        "<script>window.onload = () => document.querySelectorAll('img').forEach("
        "picture => picture.setAttribute('data-width', picture.naturalWidth))</script>"
    )
    path = tmp_path / "page.html"
    path.write_text(html_page.replace("</body>", script + "</body>"), encoding="utf-8")
    done = subprocess.run(
        [
            browser,
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--disable-background-networking",
            f"--user-data-dir={tmp_path / 'profile'}",
            "--virtual-time-budget=10000",
            "--dump-dom",
            path.as_uri(),
        ],
        capture_output=True,
        text=True,
        check=True,
        timeout=120,
    )
    return done.stdout


@pytest.mark.browser
def test_a_browser_shows_every_case_and_no_broken_picture(page, few_gates, tmp_path):
    browser = next((b for b in map(shutil.which, ("chromium", "google-chrome", "chromium-browser")) if b), None)
    if browser is None:
        pytest.skip("no chromium")
    seen = look(browser, builder.render(page, [page]), tmp_path)
    for gate in few_gates:
        assert f'id="{builder.Section(gate.name, "").anchor}"' in seen
    widths = [int(width) for width in re.findall(r'data-width="(\d+)"', seen)]
    assert len(widths) == seen.count("<img ")
    assert len(widths) > len(few_gates)  # and the elastic-plastic one
    assert min(widths) > 500
    # no link inside the page leads nowhere
    assert set(re.findall(r'href="#([^"]+)"', seen)) <= set(re.findall(r'id="([^"]+)"', seen))
