"""Notes as data: what a note is, how notes of several results are one, and that the catalogue's texts can be filled."""

import json
import pickle
import string

import pytest

from bem.notes import OUTSIDE, Level, Note, Reason, Span, as_note, has_code, of_summary, outside, unpacked, without
from bem.notes.accuracy import NoBar, no_error_bar, one_note_per_cause
from bem.notes.catalogue import known_kinds
from bem.notes.checks import HARDNESS_DECIDES
from bem.notes.friction import FRICTION_UNPHYSICAL
from bem.notes.lubrication import (
    FILM_MOLECULAR,
    FILM_NOT_FOUND,
    FILM_SPIKE,
    FLOW_FACTORS_LIMIT,
    OIL_CREATED,
    OIL_TOO_THICK,
)
from bem.notes.merge import merge, without_foreseen
from bem.notes.note import told_apart
from bem.notes.scenes import MAP_ALTERED

pytestmark = pytest.mark.internal


def example(template):
    """Values that fill a template: numbers with a format, else words."""
    fields = [(name, spec) for _, name, spec, _ in string.Formatter().parse(template) if name]
    return {name: ["x"] * 5 if spec == "few" else 1.5 if spec else "x" for name, spec in fields}


@pytest.mark.parametrize("kind", known_kinds().values(), ids=known_kinds())
def test_every_kind_of_the_catalogue_says_what_is_wrong_in_a_line(kind):
    for name, reason in (kind.reasons or {"": Reason(kind.sentence)}).items():
        templates = (reason.headline or kind.headline, reason.sentence, reason.action or kind.action)
        values = {key: value for text in templates for key, value in example(text).items()} | {"reason": name}
        note = kind("there", **values)
        assert note.startswith("there: ")
        assert "{" not in note
        assert note.line.startswith("there: ")
        assert (note.code, note.level, note.where) == (kind.code, reason.level or kind.level, "there")
        assert reason.sentence or reason.action or kind.action or not kind.reasons


def test_a_note_is_a_string_with_numbers_in_their_units():
    note = FLOW_FACTORS_LIMIT("film", thinnest=45e-9, least=1e-7, reason="extrapolated")
    assert isinstance(note, str)
    assert "45 nm" in note
    assert "100 nm" in note
    assert json.loads(json.dumps([note])) == [str(note)]


def test_a_value_beside_its_limit_has_the_digits_that_tell_them_apart():
    """30.16 % beyond 30 % was shown as 30 %."""
    assert told_apart(0.3016, 0.3, "%") == "30.2 %"
    assert told_apart(0.29996, 0.3, "%") == "29.996 %"
    assert told_apart(1.0004, 1.0, "%") == "100.04 %"
    assert told_apart(0.45, 0.3, "%") == "45 %"
    assert told_apart(0.3, 0.3, "%") == "30 %"
    assert told_apart(150.04, 150.0, ".0f") == "150.04"
    assert told_apart(1.00004e6, 1e6, "si Pa") == "1.00004 MPa"
    note = MAP_ALTERED(
        "upper.surface", change=1e-8, share=0.3016, limit=0.3, height=1e-7, action="", reason="seams-large"
    )
    assert "its heights by 30.2 % of Sq" in note
    assert "above 1000 Pa s" in OIL_TOO_THICK(viscosity=Span(1000.4, 2000.0), limit=1000.0)
    assert "is 1000.4 to 2e+03 Pa s" in OIL_TOO_THICK(viscosity=Span(1000.4, 2000.0), limit=1000.0)


def test_what_is_outside_the_model_says_so_first():
    note = FRICTION_UNPHYSICAL("speed 1 m/s", friction=3.2, limit=1.0, reason="drag")
    assert note.startswith(f"speed 1 m/s: {OUTSIDE}Friction 3.2")
    assert outside([note, note, FILM_MOLECULAR(limit=2e-9)]) == (note.headline,)
    assert note.headline.startswith("speed 1 m/s: Friction 3.2 is above any physical bound")


def test_a_note_is_the_same_after_a_checkpoint_and_another_process():
    note = FILM_NOT_FOUND("load 2 N", reason="glass", hertz=Span(2e9, 3e9), glass=1e12)
    for again in (pickle.loads(pickle.dumps(note)), unpacked(json.loads(json.dumps(note.packed())))):
        assert again == note
        assert (again.code, again.level, again.where, again.values) == (note.code, note.level, note.where, note.values)
        assert isinstance(again.values["hertz"], Span)


def test_a_summary_of_before_has_texts_and_one_of_now_tables():
    note = OIL_CREATED(created=0.5)
    found = of_summary({"notes": ["as it was", f"film: {OUTSIDE}half of it", note.as_dict()]})
    assert [entry["level"] for entry in found] == ["caution", "outside_model", "caution"]
    assert found[1]["where"] == "film"
    assert found[2] == {"code": OIL_CREATED.code, "level": "caution", "text": str(note), "where": ""}


def test_notes_of_several_results_are_one_with_places_and_the_range_of_their_numbers():
    thin, thinner = OIL_CREATED(created=0.5), OIL_CREATED(created=0.7)
    (merged,) = merge([[thin], [thinner], []], lambda at: f"of {at}")
    assert (merged.where, merged.values["created"]) == ("of [0, 1]", Span(0.5, 0.7))
    assert "0.5 to 0.7 times" in merged
    (everywhere,) = merge([[thin], [thin]], lambda at: "unused")
    assert everywhere == thin
    reasons = [FILM_NOT_FOUND(reason="line"), FILM_NOT_FOUND(reason="rigid-spike")]
    assert len(merge([[reasons[0]], [reasons[1]]], str)) == 2
    assert [str(note) for note in merge([["a"], ["a", "b"]], lambda at: f"case {at[0]}")] == ["a", "case 1: b"]


def test_a_caution_before_a_run_gives_way_to_a_caution_from_its_results_but_not_to_a_remark():
    before = HARDNESS_DECIDES(reason="load", ratio=0.7)
    caution, remark = HARDNESS_DECIDES(reason="area", share=0.6), HARDNESS_DECIDES(reason="within-error", cap=1e9)
    assert without_foreseen([before, remark]) == [before, remark]
    assert without_foreseen([before, remark, caution]) == [remark, caution]


def test_notes_of_a_code_that_is_gone_stay_as_they_were():
    packed = OIL_CREATED(created=0.5).packed() | {"code": "gone"}
    old = [unpacked(packed | {"values": {"created": created}}) for created in (0.5, 0.7)]
    (merged,) = merge([[old[0]], [old[1]]], str)
    assert merged == old[0]


def test_code_tells_notes_apart_whatever_their_words():
    notes = (OIL_CREATED(created=0.5), FILM_MOLECULAR("x", limit=2e-9))
    assert has_code(notes, FILM_MOLECULAR)
    assert without(notes, FILM_MOLECULAR) == notes[:1]
    assert not has_code([str(note) for note in notes], FILM_MOLECULAR)
    assert as_note(notes[0]) is notes[0]
    plain = as_note("what a law of yours says")
    assert (type(plain), plain.level, str(plain)) == (Note, Level.CAUTION, "what a law of yours says")


def test_figures_without_error_bars_for_one_cause_have_one_note():
    """The contact, the stresses and the coating each said that the contact reaches a free edge."""
    edge = [no_error_bar([name], NoBar.FREE_EDGE) for name in ("load", "max_von_mises", "load")]
    sharp = no_error_bar(["max_pressure"], NoBar.SHARP_PRESSURE), no_error_bar(["max_von_mises"], NoBar.STRESS_OF_SHARP)
    other = FILM_SPIKE(remedy="")
    assert one_note_per_cause([edge[0], other, *edge[1:]]) == [
        no_error_bar(["load", "max_von_mises"], NoBar.FREE_EDGE),
        other,
    ]
    assert one_note_per_cause(sharp) == [no_error_bar(["max_pressure", "max_von_mises"], NoBar.SHARP_PRESSURE)]
    assert one_note_per_cause(sharp[1:]) == [sharp[1]]
    few = [no_error_bar(["load"], NoBar.EVEN_CELLS, fewest=n) for n in (8, 12)]
    assert one_note_per_cause(few) == few


def test_figures_with_another_oil_volume_without_bars_are_named_in_words():
    """The keys loaded_contact_load and loaded_friction were read as a loaded friction."""
    said = str(no_error_bar(["loaded_contact_load", "loaded_friction"], NoBar.OF_KIND, why="they are for comparison"))
    assert "the friction with the oil of the loaded zone" in said
    assert "loaded friction" not in said
