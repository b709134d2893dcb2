"""What the terminal shows of notes: cautions once and at once, what is outside the model beside the status, remarks by
their number."""

import pytest

from bem.cli._terminal import Terminal, show_remarks, show_warnings
from bem.notes.friction import FRICTION_UNPHYSICAL
from bem.notes.lubrication import FILM_NOT_FOUND, FILM_SPIKE, OIL_TOO_THICK, SHEAR_LIMITED
from bem.notes.note import LevelledText

pytestmark = pytest.mark.internal
BEYOND = FRICTION_UNPHYSICAL(friction=3.0, limit=1.0, reason="drag")
REMARK = SHEAR_LIMITED(reason="friction-own-law")


def summary(*notes):
    about = {"scene": "s", "kind": "contact", "status": "converged", "wall_time_s": 1.0}
    beyond = [note.headline for note in notes if note.level == "outside_model"]
    return about | {"notes": [note.as_dict() for note in notes], "outside_model": beyond}


def test_a_caution_is_shown_once_and_a_remark_not(capsys):
    with Terminal() as terminal:
        terminal.note(FILM_SPIKE("film", remedy=""))
        terminal.note(FILM_SPIKE("speed 1 m/s, film", remedy=""))
        terminal.note(OIL_TOO_THICK("oil", viscosity=200.0, limit=150.0))
        terminal.note(OIL_TOO_THICK("oil", viscosity=300.0, limit=150.0))
        terminal.note(REMARK)
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 2
    assert all(line.startswith("bem: caution: ") for line in lines)


def test_another_reason_of_a_code_is_shown_too(capsys):
    with Terminal() as terminal:
        terminal.note(FILM_NOT_FOUND(reason="line"))
        terminal.note(FILM_NOT_FOUND(reason="narrow", nx=32, ny=32))
        terminal.note(FILM_NOT_FOUND(reason="narrow", nx=64, ny=64))
    first, second = capsys.readouterr().err.splitlines()
    assert "take more points" in first
    assert "twice as many cells" in second


def test_what_is_outside_the_model_stands_beside_the_status_alone(capsys):
    with Terminal() as terminal:
        terminal.note(BEYOND)
        terminal.numbers(summary(BEYOND, REMARK, REMARK), ())
    shown = capsys.readouterr()
    assert shown.err == ""
    assert shown.out.count(BEYOND.headline) == 1
    assert "2, in the report and in summary.json" in shown.out


def test_a_run_without_numbers_says_at_its_end_what_is_outside_the_model(capsys):
    with Terminal() as terminal:
        terminal.note(BEYOND)
        assert capsys.readouterr().err == ""
    assert BEYOND.line in capsys.readouterr().err


def test_a_message_on_the_work_is_shown_as_it_is(capsys):
    with Terminal() as terminal:
        terminal.note("2 processes instead of 4")
    assert capsys.readouterr().err == "bem: note: 2 processes instead of 4\n"


def test_a_text_that_begins_with_its_level_has_no_second_one(capsys):
    with Terminal() as terminal:
        terminal.note(LevelledText("remark, 4 of 4 points: It is so."))
    assert capsys.readouterr().err == "bem: remark, 4 of 4 points: It is so.\n"


def test_warnings_of_a_plan_are_lines_and_remarks_a_number(capsys):
    show_warnings([FILM_SPIKE(remedy=""), REMARK], remarks="in the report")
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "1 caution, 1 remark (in the report)"
    assert len(lines) == 2
    show_warnings([BEYOND])
    assert capsys.readouterr().out.splitlines()[0] == "1 outside the model"
    show_warnings([BEYOND, FILM_SPIKE(remedy="")])
    assert capsys.readouterr().out.splitlines()[0] == "1 outside the model, 1 caution"
    show_remarks([FILM_SPIKE(remedy=""), REMARK])
    assert capsys.readouterr().out == f"  {REMARK}\n"
    show_warnings([])
    assert capsys.readouterr().out == ""
